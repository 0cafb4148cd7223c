/* SPDX-License-Identifier: MIT
 * Bezier curves of balls, the skeletons of QUADRATIC_TUBE and CUBIC_TUBE: control points in four
 * dimensions, where the fourth is the radius. The solid is the union of the balls Q(t), r(t) for
 * 0 <= t <= 1, its field f(p) = max r(t) - |p - Q(t)|: the largest of fields with Lipschitz
 * constant 1, hence 1 itself, and outside the exact distance, whatever the radius does.
 */
#ifndef CSG_SCENE_CURVE_H
#define CSG_SCENE_CURVE_H

#include "scene/primitives/primitive.h"

enum { CSG_CURVE_MOST = 4, CSG_CURVE_AXES = 4, CSG_CURVE_RADIUS = 3 };

typedef struct csg_curve {
    double at[CSG_CURVE_MOST][CSG_CURVE_AXES]; /* x y z r of degree + 1 control points */
    int degree;                                /* 2 or 3 */
} csg_curve;

static inline bool csg_node_is_curve(csg_primitive_kind kind)
{
    return csg_primitive_has(kind, CSG_TRAIT_CURVE);
}

/* kind: of a curve; parameters as in primitives.def, which are those of `at`, one after the other.
 */
csg_curve csg_curve_make(csg_primitive_kind kind, const double *parameters);
/* De Casteljau: both halves. */
void csg_curve_halve(const csg_curve *curve, csg_curve *low, csg_curve *high);
/* x y z r at t. */
void csg_curve_at(const csg_curve *curve, double t, double out[CSG_CURVE_AXES]);
/* Largest n . p of the solid, |n| = length. */
double csg_curve_support(const csg_curve *curve, csg_vec3 n, double length);
/* The radius that is the same all along; 0 where it changes. */
double csg_curve_only_radius(const csg_curve *curve);
/* Chords of equal parts within which curve and radius stay `within` of the chords' capsules. */
double csg_curve_chords(const csg_curve *curve, double within);

/* The largest r - |p - Q|, to the last bits; *to: that Q - p. */
double csg_curve_nearest(const csg_curve *curve, csg_vec3 p, csg_vec3 *to);

#endif
