/* SPDX-License-Identifier: MIT
 * Blends that fold two operands by one length: everything that the computer needs to know of one
 * beyond its row in operators.def (CSG_FOLD) stands here together. Each adds f_b(x, n) >= 0 to the
 * larger of two operands that differ by x >= 0 (operators.md 2.1); a blend `name` has
 *
 *   name_double  f_b and its slope by x in double: the definition, asked for x < chi only
 *   name_float   the same in float for the kernels, for any x; chi is the support. No branches,
 *                only + - * / sqrtf and choices (base/select.h): then loops over it become vectors
 *                and every instruction set gives the same bits. From chi on exactly 0.
 *   name_term    f_b as steps of a formula, for the exchange with other programs (formulate.h); x
 *                is at most chi already
 *
 * Those who use them paste these names together from the rows, so a row without one of its three
 * functions does not compile.
 */
#ifndef CSG_SCENE_BLENDS_H
#define CSG_SCENE_BLENDS_H

#include <math.h>

#include "base/elementary.h"
#include "base/select.h"
#include "scene/formula/terms.h"

/* f_b and its derivative by x. */
typedef struct csg_blended {
    double value, slope;
} csg_blended;

typedef struct blended {
    float value, slope;
} blended;

#define BLEND_PI 3.14159265358979323846

/* ---- hyperbola: blend function 1 --------------------------------------------------------------
 */

static inline csg_blended hyperbola_double(double n, double x)
{
    double root = sqrt(x * x + n);
    return (csg_blended){n / (2 * (root + x)), (x / root - 1) / 2};
}
static inline blended hyperbola_float(float n, float chi, float x)
{
    float root = sqrtf(x * x + n);
    return (blended){n / (2.0f * (root + x)), 0.5f * (x / root - 1.0f)};
}
static inline csg_term hyperbola_term(csg_terms *t, double n, csg_term x)
{
    csg_term root = csg_term_sqrt(t, csg_term_add_number(t, csg_term_square(t, x), n));
    return csg_term_div(t, csg_term_number(t, n / 2), csg_term_add(t, root, x));
}

/* ---- reciprocal: blend function 2 -------------------------------------------------------------
 */

static inline csg_blended reciprocal_double(double n, double x)
{
    double root = x + sqrt(2 * n);
    return (csg_blended){n / root, -n / (root * root)};
}
static inline blended reciprocal_float(float n, float chi, float x)
{
    float k = x + sqrtf(2.0f * n);
    return (blended){n / k, -n / (k * k)};
}
static inline csg_term reciprocal_term(csg_terms *t, double n, csg_term x)
{
    return csg_term_div(t, csg_term_number(t, n), csg_term_add_number(t, x, sqrt(2 * n)));
}

/* ---- overblend and cosine: blend functions 3 and 4 --------------------------------------------
 * n (1 + cos a), a growing with x / n, is 2 n sin(u / 2)^2 with u = pi - a, which keeps its digits
 * at the end; the slope is -sin u = -sin a.
 */

/* sin and cos on [0, 1.31]: Taylor polynomials, error below 2e-7. */
static inline float blend_sine(float a)
{
    float s = a * a;
    return a *
           (1.0f + s * (-1.0f / 6 + s * (1.0f / 120 + s * (-1.0f / 5040 + s * (1.0f / 362880)))));
}
static inline float blend_cosine(float a)
{
    float s = a * a;
    return 1.0f + s * (-0.5f + s * (1.0f / 24 + s * (-1.0f / 720 +
                                                     s * (1.0f / 40320 + s * (-1.0f / 3628800)))));
}

/* Functions 3 and 4 are one, u = (chi - x) / n. */
static inline blended arch_float(float n, float chi, float x)
{
    float half = larger(chi - x, 0) / (2.0f * n);
    float s = blend_sine(half);
    return (blended){2.0f * n * (s * s), -2.0f * s * blend_cosine(half)};
}
/* u = end - x / n; formulas count angles in degrees. */
static inline csg_term arch_term(csg_terms *t, double n, csg_term x, double end)
{
    const double degrees = 180 / BLEND_PI;
    csg_term half = csg_term_mul_number(t, x, -1 / n * degrees / 2);
    csg_term sine = csg_term_sin(t, csg_term_add_number(t, half, end * degrees / 2));
    return csg_term_mul_number(t, csg_term_square(t, sine), 2 * n);
}

static inline csg_blended overblend_double(double n, double x)
{
    double angle = BLEND_PI / 6 + x / n, half = csg_sin((BLEND_PI - angle) / 2);
    return (csg_blended){2 * n * half * half, -csg_sin(angle)};
}
static inline blended overblend_float(float n, float chi, float x)
{
    return arch_float(n, chi, x);
}
static inline csg_term overblend_term(csg_terms *t, double n, csg_term x)
{
    return arch_term(t, n, x, BLEND_PI - BLEND_PI / 6);
}

static inline csg_blended cosine_double(double n, double x)
{
    double half = (BLEND_PI / 6 - x / n) / 2;
    return (csg_blended){2 * n * csg_sin(half) * csg_sin(half), -csg_sin(2 * half)};
}
static inline blended cosine_float(float n, float chi, float x)
{
    return arch_float(n, chi, x);
}
static inline csg_term cosine_term(csg_terms *t, double n, csg_term x)
{
    return arch_term(t, n, x, BLEND_PI / 6);
}

/* ---- parabola: blend function 5 ---------------------------------------------------------------
 */

static inline csg_blended parabola_double(double n, double x)
{
    double root = x / n - 0.25;
    return (csg_blended){n * root * root, 2 * root};
}
static inline blended parabola_float(float n, float chi, float x)
{
    float y = larger(chi - x, 0) / n;
    return (blended){n * (y * y), -2.0f * y};
}
static inline csg_term parabola_term(csg_terms *t, double n, csg_term x)
{
    csg_term root = csg_term_sub_number(t, csg_term_mul_number(t, x, 1 / n), 0.25);
    return csg_term_mul_number(t, csg_term_square(t, root), n);
}

/* ---- chamfer: blend function 6 ----------------------------------------------------------------
 */

static inline csg_blended chamfer_double(double n, double x)
{
    return (csg_blended){n - x / 2, -0.5};
}
static inline blended chamfer_float(float n, float chi, float x)
{
    float rest = chi - x;
    return (blended){rest > 0 ? 0.5f * rest : 0, rest > 0 ? -0.5f : 0};
}
static inline csg_term chamfer_term(csg_terms *t, double n, csg_term x)
{
    return csg_term_number_sub(t, n, csg_term_mul_number(t, x, 0.5));
}

#endif
