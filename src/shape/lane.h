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

/* Beside them: floats of as many points as a register holds, two for each double but where that is
 * more than are asked for at once. */
enum { WIDE = 2 * LANES < CSG_SHAPE_LANES ? 2 * LANES : CSG_SHAPE_LANES };

typedef float narrow __attribute__((vector_size(WIDE * sizeof(float))));
typedef int32_t narrow_mask __attribute__((vector_size(WIDE * sizeof(int32_t))));

/* The larger of both, the second where they are alike or one is no number; and a bit for each lane
 * that is set. Where the compiler does not find the one instruction that these are, it is told. */
#ifdef __AVX__
#include <immintrin.h>
#define LARGER(a, b) (narrow) _mm256_max_ps((__m256)(a), (__m256)(b))
#define BITS_OF(m) (unsigned)_mm256_movemask_ps((__m256)(m))
#elif defined(__SSE2__)
#define LARGER(a, b) (narrow) _mm_max_ps((__m128)(a), (__m128)(b))
#define BITS_OF(m) csg_four_bits((csg_four_mask)(m))
#else
#define LARGER(a, b) (narrow)((((a) > (b)) & (narrow_mask)(a)) | (~((a) > (b)) & (narrow_mask)(b)))
#define BITS_OF(m) csg_four_bits((csg_four_mask)(m))
#endif
#define POSITIVE(x) LARGER(x, (narrow){0})
#define SIZE_OF(x) (narrow)((narrow_mask)(x) & ((narrow_mask){0} + INT32_MAX))

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
