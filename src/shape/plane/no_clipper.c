/* SPDX-License-Identifier: MIT
 * In place of clipper.cc where the library is absent.
 */
#include "shape/plane/clipper.h"

bool csg_clipper_available(void)
{
    return false;
}

csgm_status csg_clipper_combine(csg_polygons_op op, csg_fill fill, const csg_clipper_loops *a,
                                const csg_clipper_loops *b, csg_clipper_take *take, void *user)
{
    return CSGM_ERR_UNSUPPORTED;
}

csgm_status csg_clipper_offset(const csg_clipper_loops *in, double by, csg_corner corner,
                               double arc_tolerance, csg_clipper_take *take, void *user)
{
    return CSGM_ERR_UNSUPPORTED;
}
