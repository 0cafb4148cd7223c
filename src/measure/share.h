/* SPDX-License-Identifier: MIT
 * What a cube may leave open before it is divided: a share that is the same for all cubes costs the
 * fewest of them, and is made smaller round by round.
 */
#ifndef CSG_MEASURE_SHARE_H
#define CSG_MEASURE_SHARE_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

/* The next share. What is left open falls with its square root where the surface is smooth, slower
 * where less is known of it; cubes become more by its power of 2/3 at most. ratio: of what is
 * wanted to what is open; cubes: of the latest round; left: how many may still be looked at. False:
 * so many are not to be had. */
static inline bool csg_measure_next_share(double *share, double ratio, double cubes, uint64_t left)
{
    static const double LEAST_STEP = 0.25, LARGEST_STEP = 0x1p-12, MARGIN = 0.7;
    double wanted = MARGIN * ratio, step = fmax(fmin(wanted * wanted, LEAST_STEP), LARGEST_STEP);
    double more = (double)left / cubes, affordable = more * sqrt(more);
    if (!(affordable > 1 / LEAST_STEP))
        return false;
    *share *= fmax(step, 1 / affordable);
    return true;
}

#endif
