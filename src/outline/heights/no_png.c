/* SPDX-License-Identifier: MIT
 * Instead of png.c where libpng is missing.
 */
#include "outline/heights/heights.h"

csgm_status csg_heights_from_png(csg_memory *memory, const void *data, size_t size, bool invert,
                                 csg_heights *out, csg_problem *problem)
{
    (void)data, (void)size, (void)invert;
    *out = (csg_heights){.memory = memory};
    return csg_problem_set(problem, CSGM_ERR_UNSUPPORTED,
                           "this build cannot read PNG images (made without libpng)");
}
