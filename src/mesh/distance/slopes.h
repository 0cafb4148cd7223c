/* SPDX-License-Identifier: MIT
 * The gradients that a field can have in a region, through its operators: a few balls of vectors
 * whose convex hull holds them all. Leaves give theirs (field/cones/cone.h). A blend mixes its
 * operands' gradients in shares that depend on the operands' difference alone, and that changes
 * within the region by no more than the gradients allow: so where two surfaces flow into each other
 * the set shrinks with the region, and what a sharp operator hides there does not take part at all.
 * Rules and formulas of operands (slopes_rule.c) add their operands' gradients times what partial
 * derivatives can be in the region, which their values there tell.
 * Leaves are asked in a ball around the region; how far operands part from each other in it is told
 * by its extent along their gradients' difference, which along a straight fillet is none.
 *
 * And how far values at a place x = sum l_i v_i of a triangle may be from sum l_i f(v_i), which its
 * corners say. Of a leaf whose gradients differ by at most bend d over a distance of d that is
 * bend r^2 / 2, r being how far corners are from some point: it is the sum of
 * l_i (f(v_i) - f(x) - g(x) (v_i - x)), and that of l_i |v_i - x|^2 is at most r^2. However fast
 * they turn it is no more than r times how far they are from any vector g_0: in the same sum with
 * g_0 for g(x) no term is more than that times l_i |v_i - x|. An operator
 * whose shares add up to 1 hands on the most of its operands', and adds what it is not linear by:
 * with h the difference of two operands, which varies over the corners by no more than their
 * gradients' difference along the triangle lets it, half of its second derivative times the square
 * of half of that, or a quarter of that where only shares between 0 and 1 are known. Triangles that
 * are n times smaller, along the same sides, are off by kink / n + sag / n^2.
 *
 * And the field's range over a triangle in the region: that of a leaf from its values at the
 * corners and how far its gradients stray, of convex primitives by their tangent planes, then
 * through the operators, which are monotone. A triangle that ends at a crease has a narrow one.
 *
 * And over the region: where two solids share a face their union is zero there, but nowhere less,
 * and what is cut off along a face that a solid has already is nowhere more.
 */
#ifndef CSG_MESH_DISTANCE_SLOPES_H
#define CSG_MESH_DISTANCE_SLOPES_H

#include "base/geometry.h"
#include "field/cones/cone.h"
#include "field/kernels/kernel.h"
#include "mesh/distance/touching.h"

enum { CSG_SLOPES_NODES = 128 /* of a tape; more are not looked at */ };

/* What is within `around` of the convex hull of a triangle and a point c, or in a cube of that half
 * edge along the axes around a place that is. */
typedef struct csg_gradients_region {
    csg_vec3 triangle[3], c;
    double around, half;
} csg_gradients_region;

typedef struct csg_gradients {
    csg_cone_balls balls; /* of all gradients */
    csg_cone_balls level; /* if has_level: of those where the field is zero, which may be fewer */
    bool has_level;
    double value;       /* of the field, at c */
    double low, high;   /* over the triangle */
    double least, most; /* over the region, but for rounding: nowhere less, nowhere more */
    double longest;     /* of all gradients */
    bool exceeds;     /* they may be combinations of the balls with weights of more than 1 in all */
    double stray;     /* no gradient is farther from `middle`; INFINITY: not known */
    double across;    /* the same, of their parts along the triangle */
    double kink, sag; /* how far values over the triangle, or over it moved within the region, may
                         be from what its corners say; kink is INFINITY where that is not known */
    double middle[3];
    double doubt;                 /* rounding of the field's values */
    csg_cone cone;                /* the axis of `balls`, if it was looked for on the way */
    bool is_axis_known, has_axis; /* that it was, and that there is one */
} csg_gradients;

/* scratch: as the kernel needs it. False: no bound is known. */
bool csg_gradients_find(const csg_kernel *kernel, const csg_tape *tape,
                        const csg_gradients_region *region, float *scratch, size_t scratch_floats,
                        csg_gradients *out);

/* The same of up to CSG_OCTANTS regions in which one tape holds, and what stands for it: values of
 * leaves are asked for all at once. is_known: of which a bound is known. */
void csg_gradients_find_each(const csg_kernel *kernel, const csg_touching *field,
                             const csg_gradients_region *regions, size_t count, float *scratch,
                             size_t scratch_floats, csg_gradients *const *out, bool *is_known);

/* The direction that all gradients have in common (csg_cone_find_axis of the balls). */
bool csg_gradients_find_axis(const csg_gradients *gradients, csg_cone *out);

/* What the field changes by at most along a way, of the longest of its parts along the axes: the
 * largest sum of a gradient's absolute parts. INFINITY: not known. */
double csg_gradients_steepest(const csg_gradients *gradients);

/* What a join by a fold gives of two values of a union (of an intersection: turned around), and the
 * share of a. n, chi: the join's parameters. */
double csg_slopes_fold(const csg_tape_node *node, float n, float chi, double a, double b,
                       double *share);
/* A round union of width w of these values. */
double csg_slopes_round(const double *values, uint32_t count, double w);

#endif
