/* SPDX-License-Identifier: MIT
 * Blends that one length describes.
 */
#ifndef CSG_SCENE_BLENDS_H
#define CSG_SCENE_BLENDS_H

#include <math.h>

#include "base/select.h"

/* ---- blend functions f_b(x, n) and their slopes, x = |a - b| (operators.md 2.1) ------- */

typedef struct blended {
    float value, slope;
} blended;

/* sin and cos on [0, 1.31]: Taylor polynomials, error below 2e-7. */
static inline float sine(float a)
{
    float s = a * a;
    return a *
           (1.0f + s * (-1.0f / 6 + s * (1.0f / 120 + s * (-1.0f / 5040 + s * (1.0f / 362880)))));
}
static inline float cosine(float a)
{
    float s = a * a;
    return 1.0f + s * (-0.5f + s * (1.0f / 24 + s * (-1.0f / 720 +
                                                     s * (1.0f / 40320 + s * (-1.0f / 3628800)))));
}

static inline blended blend_hyperbola(float n, float chi, float x)
{
    float root = sqrtf(x * x + n);
    return (blended){n / (2.0f * (root + x)), 0.5f * (x / root - 1.0f)};
}
static inline blended blend_reciprocal(float n, float chi, float x)
{
    float k = x + sqrtf(2.0f * n);
    return (blended){n / k, -n / (k * k)};
}
/* Functions 3 and 4 are one: 2 n sin^2(u / 2), slope -sin u, with u = (chi - x) / n. */
static inline blended blend_cosine(float n, float chi, float x)
{
    float half = larger(chi - x, 0) / (2.0f * n);
    float s = sine(half);
    return (blended){2.0f * n * (s * s), -2.0f * s * cosine(half)};
}
static inline blended blend_overblend(float n, float chi, float x)
{
    return blend_cosine(n, chi, x);
}
static inline blended blend_parabola(float n, float chi, float x)
{
    float y = larger(chi - x, 0) / n;
    return (blended){n * (y * y), -2.0f * y};
}
static inline blended blend_chamfer(float n, float chi, float x)
{
    float rest = chi - x;
    return (blended){rest > 0 ? 0.5f * rest : 0, rest > 0 ? -0.5f : 0};
}
static inline blended blend_sharp(float n, float chi, float x)
{
    return (blended){0, 0};
}

/* ---- the round n-ary union (operators.md 12) ------------------------------------------- */

/* G - max for the first m operands, from the sums of u_i = max - f_i and of u_i^2. Never below 0.
 */
static inline float round_excess(float w, float m, float sum, float squares)
{
    float mean = sum / m;
    float rest = w * w - (squares - sum * mean);
    return larger(w - mean - sqrtf(larger(rest, 0) / m), 0);
}

#endif
