/* SPDX-License-Identifier: MIT
 * Keeps large outlines from Clipper, whose time grows with the square of what lies on each other:
 * the readers are what is looked at. The linker's --wrap puts this in the place of
 * csg_polygons_clean.
 */
#include "shape/plane/polygons.h"

enum { MOST_POINTS = 1500 };

csgm_status __wrap_csg_polygons_clean(const csg_outline *in, csg_fill fill, csg_outline *out);
csgm_status __real_csg_polygons_clean(const csg_outline *in, csg_fill fill, csg_outline *out);

csgm_status __wrap_csg_polygons_clean(const csg_outline *in, csg_fill fill, csg_outline *out)
{
    if (in->point_count <= MOST_POINTS)
        return __real_csg_polygons_clean(in, fill, out);
    csg_outline_init(out, in->memory);
    if (csg_outline_append(out, in))
        return CSGM_OK;
    csg_outline_release(out);
    return CSGM_ERR_MEMORY;
}
