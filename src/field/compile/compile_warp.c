/* SPDX-License-Identifier: MIT
 * A warp on its way into the tape.
 */
#include "field/kernels/warp_kernel.h"
#include "scene/warp_kinds.h"

#define RADIANS (3.14159265358979323846 / 180)

void csg_warp_pack(const csg_warp *warp, float own[CSG_WARP_PARAMETERS])
{
    for (int i = 0; i < CSG_WARP_PARAMETERS; i++)
        own[i] = (float)warp->parameters[i];
    if (warp->kind == CSG_WARP_TWIST)
        own[CSG_TWIST_RATE] = (float)(warp->parameters[CSG_TWIST_RATE] * RADIANS);
}

double csg_warp_magnitude(const csg_warp *warp, double extent)
{
    const double *v = warp->parameters;
    if (warp->kind == CSG_WARP_TWIST) {
        double angle =
            v[CSG_TWIST_RATE] * RADIANS * fmax(fabs(v[CSG_TWIST_LOW]), fabs(v[CSG_TWIST_HIGH]));
        return extent + fabs(angle) * v[CSG_TWIST_REACH];
    }
    return warp->kind == CSG_WARP_BEND ? extent + 4 * v[CSG_BEND_RADIUS] : extent;
}
