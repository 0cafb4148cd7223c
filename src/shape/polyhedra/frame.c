/* SPDX-License-Identifier: MIT
 * A box's frame; see frame.h. The centre is a multiple of the step too, so that what has few bits
 * (coordinates from files of floats, millimetres) comes out as it went in.
 */
#include "shape/polyhedra/frame.h"

bool csg_triangle_frame_make(csg_box box, csg_triangle_frame *out)
{
    double half = 0.5 * csg_box_longest_side(box);
    if (!(half > 1e-150 && half < 1e150))
        return false;
    int exponent;
    frexp(half, &exponent);
    double scale = ldexp(1, -exponent), step = ldexp(1, exponent - 39);
    csg_vec3 center = csg_box_center(box);
    *out =
        (csg_triangle_frame){.center = {rint(center.x / step) * step, rint(center.y / step) * step,
                                        rint(center.z / step) * step},
                             .scale = scale,
                             .unscale = 1 / scale};
    return true;
}
