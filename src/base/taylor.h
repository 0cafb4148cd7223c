/* SPDX-License-Identifier: MIT
 * Taylor models of third order: a function in the cube around 0 whose corners have |x| = radius, as
 * its Taylor polynomial at 0, and how far it may be from that (Makino and Berz 2003). What is off
 * is a constant and a share of |x|^4, since that is how a smooth function leaves its polynomial; so
 * an integral over the cube knows that it is off by little near the middle.
 */
#ifndef CSG_BASE_TAYLOR_H
#define CSG_BASE_TAYLOR_H

#include <stdbool.h>
#include <stdint.h>

/* Second and third derivatives, in the order in which models have them: of these axes. */
enum { CSG_TAYLOR_SECOND = 6, CSG_TAYLOR_THIRD = 10 };
extern const unsigned char csg_taylor_second[3][3], csg_taylor_third[3][3][3];

/* With P the polynomial of these derivatives at 0, f is within error + quartic |x|^4 of P(x), and
 * its gradient within turned + thrice |x|^3 of that of P. */
typedef struct csg_taylor {
    double value, slope[3];
    double bend[CSG_TAYLOR_SECOND]; /* xx, yy, zz, xy, xz, yz */
    double third[CSG_TAYLOR_THIRD]; /* xxx, yyy, zzz, xxy, xxz, xyy, yyz, xzz, yzz, xyz */
    double error, quartic;
    double turned, thrice;
} csg_taylor;

enum { CSG_TAYLOR_MOST = 4 /* functions that become one */ };

/* A function of n <= CSG_TAYLOR_MOST numbers at the functions' values: its value, derivatives (the
 * Hessian's upper triangle by rows; the third ones along any vector are 3 third times the first
 * times the second along it), at least the norms of second and third derivatives there, and at
 * least a 24th of the fourth derivative's norm wherever the functions take it. */
typedef struct csg_taylor_outer {
    double value, slope[CSG_TAYLOR_MOST], bend[CSG_TAYLOR_MOST * (CSG_TAYLOR_MOST + 1) / 2];
    double third, norm, third_norm, fourth;
} csg_taylor_outer;

csg_taylor csg_taylor_constant(double value);

/* a + factor b. */
csg_taylor csg_taylor_sum(const csg_taylor *a, double factor, const csg_taylor *b);
csg_taylor csg_taylor_scaled(const csg_taylor *a, double factor);
csg_taylor csg_taylor_raised(csg_taylor a, double by);

/* How far the function may be from its value in the cube; the range. */
double csg_taylor_reach(const csg_taylor *a, double radius);
static inline double csg_taylor_least(const csg_taylor *a, double radius)
{
    return a->value - csg_taylor_reach(a, radius);
}
static inline double csg_taylor_most(const csg_taylor *a, double radius)
{
    return a->value + csg_taylor_reach(a, radius);
}

/* How far the polynomial's second and third order reach in a box of these half sizes around 0. */
double csg_taylor_bends(const csg_taylor *a, const double half[3]);

/* Its polynomial around x; what is off stays as it is. */
csg_taylor csg_taylor_moved(const csg_taylor *a, const double x[3]);

/* Third derivatives along x, which is how second ones change; second ones times x. */
void csg_taylor_turn(const double third[CSG_TAYLOR_THIRD], const double x[3],
                     double turned[CSG_TAYLOR_SECOND]);
double csg_taylor_third_norm(const csg_taylor *a); /* Frobenius' */
void csg_taylor_multiply(const double bend[CSG_TAYLOR_SECOND], const double x[3], double out[3]);

/* How far gradients in the cube may be from the one at its centre. */
double csg_taylor_stray(const csg_taylor *a, double radius);

/* The norms of the vector of the functions' changes and of its parts, by which an outer function
 * is off: |u(x) - u(0)| <= linear |x| + square |x|^2 / 2 + cubic |x|^3 / 6 + quartic |x|^4 + error,
 * and so of its gradients. */
typedef struct csg_taylor_change {
    double linear, square, cubic, quartic, error, most; /* most: in the cube */
    double turned, thrice;
} csg_taylor_change;
csg_taylor_change csg_taylor_change_of(const csg_taylor *const *u, int count, double radius);

/* No sum of the functions by shares of a unit vector is steeper anywhere in the cube. */
double csg_taylor_steepest(const csg_taylor_change *change, double radius);

/* The outer function of these. */
csg_taylor csg_taylor_compose(const csg_taylor_outer *outer, const csg_taylor *const *u, int count,
                              const csg_taylor_change *change, double radius);

/* False: it may not be smooth in the cube: the norm, the root or the divisor may be 0. */
bool csg_taylor_norm(const csg_taylor *const *u, int count, double radius, csg_taylor *out);
bool csg_taylor_root(const csg_taylor *a, double radius, csg_taylor *out);
bool csg_taylor_inverse(const csg_taylor *a, double radius, csg_taylor *out);
/* |a|^p, p > 0. Where a may be 0 no more is known than how large it is, but of squares. */
bool csg_taylor_power(const csg_taylor *a, double p, double radius, csg_taylor *out);
csg_taylor csg_taylor_product(const csg_taylor *a, const csg_taylor *b, double radius);
csg_taylor csg_taylor_square(const csg_taylor *a, double radius);

#endif
