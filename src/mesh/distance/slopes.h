/* SPDX-License-Identifier: MIT
 * The gradients that a field can have in a ball, through its operators: a few balls of vectors
 * whose convex hull holds them all. Leaves give theirs (field/cones/cone.h). A blend mixes its
 * operands' gradients in shares that depend on the operands' difference alone, and that changes
 * within the ball by no more than the gradients allow: so where two surfaces flow into each other
 * the set shrinks with the ball, and what a sharp operator hides there does not take part at all.
 *
 * And the field's range over a triangle in the ball: that of a leaf from its values at the corners
 * and how far its gradients stray, of convex primitives by their tangent planes, then through the
 * operators, which are monotone. A triangle that ends at a crease has a narrow one.
 *
 * And over the ball: where two solids share a face their union is zero there, but nowhere less, and
 * what is cut off along a face that a solid has already is nowhere more.
 */
#ifndef CSG_MESH_DISTANCE_SLOPES_H
#define CSG_MESH_DISTANCE_SLOPES_H

#include "base/geometry.h"
#include "field/cones/cone.h"
#include "field/kernels/kernel.h"

enum { CSG_SLOPES_NODES = 24 /* of a tape; more are not looked at */ };

typedef struct csg_gradients {
    csg_cone_balls balls;
    double value;       /* of the field, at the centre */
    double low, high;   /* over the triangle */
    double least, most; /* over the ball, but for rounding: nowhere less, nowhere more */
    double longest;     /* of all gradients */
    double stray;       /* no gradient is farther from `middle`; INFINITY: not known */
    double middle[3];
    double doubt; /* rounding of the field's values */
} csg_gradients;

/* Over the ball around c, and over a triangle within it. scratch: as the kernel needs it. False: no
 * bound is known. */
bool csg_gradients_find(const csg_kernel *kernel, const csg_tape *tape, const csg_vec3 triangle[3],
                        csg_vec3 c, double radius, float *scratch, size_t scratch_floats,
                        csg_gradients *out);

/* What a join by a fold gives of two values of a union (of an intersection: turned around), and the
 * share of a. n, chi: the join's parameters. */
double csg_slopes_fold(const csg_tape_node *node, float n, float chi, double a, double b,
                       double *share);
/* A round union of width w of these values. */
double csg_slopes_round(const double *values, uint32_t count, double w);

#endif
