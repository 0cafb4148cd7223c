/* SPDX-License-Identifier: MIT
 * Four floats at once, by the vector types of gcc and clang: loops over a few things are too
 * short for the compiler to find by itself. Each lane is what plain float arithmetic gives.
 */
#ifndef CSG_BASE_FOUR_H
#define CSG_BASE_FOUR_H

#include <math.h>
#include <stdint.h>
#include <string.h>

#ifdef __SSE2__
#include <emmintrin.h>
#elif defined(__wasm_simd128__)
#include <wasm_simd128.h>
#endif

typedef float csg_four __attribute__((vector_size(16)));
typedef int32_t csg_four_mask __attribute__((vector_size(16))); /* per lane: all ones, or 0 */

static inline csg_four csg_four_load(const float at[4])
{
    csg_four v;
    memcpy(&v, at, sizeof v);
    return v;
}
static inline void csg_four_store(csg_four v, float at[4])
{
    memcpy(at, &v, sizeof v);
}
static inline csg_four csg_four_all(float x)
{
    return (csg_four){x, x, x, x};
}
static inline csg_four csg_four_choose(csg_four_mask mask, csg_four a, csg_four b)
{
    return (csg_four)((mask & (csg_four_mask)a) | (~mask & (csg_four_mask)b));
}
/* Bit i: lane i of the mask. */
static inline unsigned csg_four_bits(csg_four_mask mask)
{
#ifdef __SSE2__
    return (unsigned)_mm_movemask_ps((__m128)mask);
#elif defined(__wasm_simd128__)
    return wasm_i32x4_bitmask((v128_t)mask);
#else
    return ((unsigned)mask[0] & 1) | ((unsigned)mask[1] & 2) | ((unsigned)mask[2] & 4) |
           ((unsigned)mask[3] & 8);
#endif
}
static inline csg_four csg_four_smaller(csg_four a, csg_four b)
{
    return csg_four_choose(a < b, a, b);
}
/* x where x > 0, else 0. */
static inline csg_four csg_four_positive(csg_four x)
{
    return (csg_four)((csg_four_mask)x & (x > csg_four_all(0)));
}
static inline csg_four csg_four_abs(csg_four x)
{
    return (csg_four)((csg_four_mask)x &
                      (csg_four_mask){INT32_MAX, INT32_MAX, INT32_MAX, INT32_MAX});
}
static inline csg_four csg_four_sqrt(csg_four x)
{
    return (csg_four){sqrtf(x[0]), sqrtf(x[1]), sqrtf(x[2]), sqrtf(x[3])};
}

#endif
