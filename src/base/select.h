/* SPDX-License-Identifier: MIT
 * Choices between floats without branches: what the formulas of kernels are made of, so that the
 * compiler turns their loops into vectors.
 */
#ifndef CSG_BASE_SELECT_H
#define CSG_BASE_SELECT_H

static inline float larger(float a, float b)
{
    return a > b ? a : b;
}
static inline float smaller(float a, float b)
{
    return a < b ? a : b;
}
static inline float absolute(float a)
{
    return a < 0 ? -a : a;
}
static inline float sign_of(float a)
{
    return a < 0 ? -1.0f : 1.0f;
}
/* a / b, or 0 where b is 0: gradients at critical points. */
static inline float quotient(float a, float b)
{
    return b > 0 ? a / b : 0;
}

#endif
