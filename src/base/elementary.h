/* SPDX-License-Identifier: MIT
 * Sines, logarithms, powers: the elementary functions with the same bits everywhere. Those of C
 * libraries differ in the last bit from one to the next, from version to version (hypot in glibc
 * 2.35), and in glibc from processor to processor, with fused multiply-adds and without. Where such
 * a bit decides how many facets a circle has, or on which side of a plane a point lies, a mesh has
 * other bytes. These use additions, multiplications, divisions and square roots alone, which IEEE
 * 754 defines to the last bit, in twice the precision of a double: so they are the true value,
 * rounded, but for one argument in 2^30 or fewer, and where they are below 2^-1022.
 *
 * They take NaN, infinities, zeros and what is outside the domain as C's do; errno is left alone.
 * tools/check_house.py keeps C's own out of src/. sqrt(), fma(), fmod(), floor() and their like are
 * exact and stay C's. Kernels have their own, in single precision (field/kernels).
 */
#ifndef CSG_BASE_ELEMENTARY_H
#define CSG_BASE_ELEMENTARY_H

#ifdef __cplusplus
extern "C" {
#endif

/* Radians; true to the last bit up to 2^40 turns or so, beyond that some number of [-1, 1]. */
double csg_sin(double x);
double csg_cos(double x);
double csg_tan(double x);

double csg_asin(double x);
double csg_acos(double x);
double csg_atan(double x);
double csg_atan2(double y, double x);

double csg_exp(double x);
double csg_log(double x);
double csg_log2(double x);
double csg_log10(double x);
double csg_pow(double x, double y);

/* The length of (x, y), without overflow on the way. */
double csg_hypot(double x, double y);

/* The angle, 0 to pi, that has this cosine; what is beyond -1 or 1 counts as that. Within 2e-15,
 * the same bits everywhere too, and twice as fast as csg_acos. */
double csg_arc_cosine(double cosine);

#ifdef __cplusplus
}
#endif

#endif
