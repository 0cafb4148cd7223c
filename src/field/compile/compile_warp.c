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
    if (warp->kind == CSG_WARP_TAPER) {
        const double *v = warp->parameters;
        double length = v[CSG_TAPER_HIGH] - v[CSG_TAPER_LOW];
        own[CSG_TAPER_RATE] = (float)(v[CSG_TAPER_RATE] * RADIANS);
        own[CSG_TAPER_X] = (float)((v[CSG_TAPER_X] - 1) / length);
        own[CSG_TAPER_Y] = (float)((v[CSG_TAPER_Y] - 1) / length);
    }
}

/* The angle's and the scales' own rounding moves the image by at most so many units of rounding;
 * both come from z, whose rounding grows by how much they change along the whole way. */
static double taper_magnitude(const double *v, double extent)
{
    double ends = fmax(fabs(v[CSG_TAPER_LOW]), fabs(v[CSG_TAPER_HIGH]));
    double length = v[CSG_TAPER_HIGH] - v[CSG_TAPER_LOW];
    double least = fmin(1, fmin(v[CSG_TAPER_X], v[CSG_TAPER_Y]));
    double grow = fmax(fabs(v[CSG_TAPER_X] - 1), fabs(v[CSG_TAPER_Y] - 1)) / length;
    double reach = v[CSG_TAPER_REACH];
    return (extent + 2 * reach + grow * (ends + length) * reach) / least +
           fabs(v[CSG_TAPER_RATE]) * RADIANS * ends * reach;
}

double csg_warp_magnitude(const csg_warp *warp, double extent)
{
    const double *v = warp->parameters;
    if (warp->kind == CSG_WARP_TWIST) {
        double angle =
            v[CSG_TWIST_RATE] * RADIANS * fmax(fabs(v[CSG_TWIST_LOW]), fabs(v[CSG_TWIST_HIGH]));
        return extent + fabs(angle) * v[CSG_TWIST_REACH];
    }
    if (warp->kind == CSG_WARP_TAPER)
        return taper_magnitude(v, extent);
    return warp->kind == CSG_WARP_BEND ? extent + 4 * v[CSG_BEND_RADIUS] : extent;
}
