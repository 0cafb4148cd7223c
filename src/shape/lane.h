/* SPDX-License-Identifier: MIT
 * Doubles of several points side by side, as wide as a register of the instruction set that a file
 * is built for. Vector types of gcc and clang: the loops are too short for the compiler to find by
 * itself.
 */
#ifndef CSG_SHAPE_LANE_H
#define CSG_SHAPE_LANE_H

#include "base/four.h"
#include "shape/shape_kernel.h"

enum { LANES = CSG_SHAPE_WIDTH };

typedef double lane __attribute__((vector_size(LANES * sizeof(double))));
typedef int64_t mask __attribute__((vector_size(LANES * sizeof(int64_t)))); /* all ones, or 0 */

/* Not a function: vectors wider than the registers have no settled way to be passed to one. */
#define CHOOSE(is_first, a, b) (lane)(((is_first) & (mask)(a)) | (~(is_first) & (mask)(b)))

/* Whether some lane is set. */
static inline bool is_some_lane(const mask *m)
{
    csg_four_mask fours[sizeof *m / sizeof(csg_four_mask)];
    memcpy(fours, m, sizeof *m);
    for (size_t i = 1; i < sizeof fours / sizeof *fours; i++)
        fours[0] |= fours[i];
    return csg_four_bits(fours[0]) != 0;
}

#endif
