/* SPDX-License-Identifier: MIT
 * In place of manifold.cc where the library is absent.
 */
#include "shape/polyhedra/manifold.h"

bool csg_manifold_is_available(void)
{
    return false;
}

csgm_status csg_manifold_run(const csg_manifold_step *steps, size_t count, double tolerance,
                             const csg_manifold_caller *caller)
{
    return CSGM_ERR_UNSUPPORTED;
}
