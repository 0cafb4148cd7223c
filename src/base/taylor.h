/* SPDX-License-Identifier: MIT
 * Taylor models of second order: a function in the ball |x| <= radius as its Taylor polynomial at
 * 0, and how far it may be from that (Makino and Berz 2003). What is off is a constant and a share
 * of |x|^3, since that is how a smooth function leaves its polynomial; so an integral over the ball
 * knows that it is off by little near the middle.
 */
#ifndef CSG_BASE_TAYLOR_H
#define CSG_BASE_TAYLOR_H

#include <stdbool.h>
#include <stdint.h>

/* |f(x) - (value + slope . x + x . bend x / 2)| <= error + cubic |x|^3, and its gradient is within
 * turned + twice |x|^2 of slope + bend x. */
typedef struct csg_taylor {
    double value, slope[3];
    double bend[6]; /* xx, yy, zz, xy, xz, yz */
    double error, cubic;
    double turned, twice;
} csg_taylor;

enum { CSG_TAYLOR_MOST = 4 /* functions that become one */ };

/* A function of n <= CSG_TAYLOR_MOST numbers at the functions' values: its value, derivatives (the
 * Hessian's upper triangle by rows), at least the Hessian's norm there, and at least a sixth of the
 * third derivative's norm wherever the functions take it. */
typedef struct csg_taylor_outer {
    double value, slope[CSG_TAYLOR_MOST], bend[CSG_TAYLOR_MOST * (CSG_TAYLOR_MOST + 1) / 2];
    double norm, sixth;
} csg_taylor_outer;

csg_taylor csg_taylor_constant(double value);

/* a + factor b. */
csg_taylor csg_taylor_sum(const csg_taylor *a, double factor, const csg_taylor *b);
csg_taylor csg_taylor_scaled(const csg_taylor *a, double factor);
csg_taylor csg_taylor_raised(csg_taylor a, double by);

/* How far the function may be from its value in the ball; the range. */
double csg_taylor_reach(const csg_taylor *a, double radius);
static inline double csg_taylor_least(const csg_taylor *a, double radius)
{
    return a->value - csg_taylor_reach(a, radius);
}
static inline double csg_taylor_most(const csg_taylor *a, double radius)
{
    return a->value + csg_taylor_reach(a, radius);
}

/* How far gradients in the ball may be from the one at its centre. */
double csg_taylor_stray(const csg_taylor *a, double radius);

/* The norms of the vector of the functions' changes and of its parts, by which an outer function
 * is off: |u(x) - u(0)| <= linear |x| + square |x|^2 / 2 + cubic |x|^3 + error, and so of its
 * gradients. */
typedef struct csg_taylor_change {
    double linear, square, cubic, error, most; /* most: in the ball */
    double turned, twice;
} csg_taylor_change;
csg_taylor_change csg_taylor_change_of(const csg_taylor *const *u, int count, double radius);

/* The outer function of these. */
csg_taylor csg_taylor_compose(const csg_taylor_outer *outer, const csg_taylor *const *u, int count,
                              const csg_taylor_change *change, double radius);

/* False: it may not be smooth in the ball: the norm, the root or the divisor may be 0. */
bool csg_taylor_norm(const csg_taylor *const *u, int count, double radius, csg_taylor *out);
bool csg_taylor_root(const csg_taylor *a, double radius, csg_taylor *out);
bool csg_taylor_inverse(const csg_taylor *a, double radius, csg_taylor *out);
csg_taylor csg_taylor_product(const csg_taylor *a, const csg_taylor *b, double radius);
csg_taylor csg_taylor_square(const csg_taylor *a, double radius);

#endif
