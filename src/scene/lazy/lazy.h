/* SPDX-License-Identifier: MIT
 * Lazy evaluation in double precision (Nguyen & van de Wetering; operators.md 3): a sealed scene ->
 * values and gradients at points, with as few nodes evaluated as boxes allow, and counts of them.
 *
 * Each node's value is cut by what its box says: v = min(op(children), c), where the bound c is
 * known without evaluating the node. An operand whose bound lies below the best of its siblings by
 * the blend's support cannot change the result, and is left out. What is left out never changes a
 * bit: with `lazy` off the same values come out of all nodes.
 *
 * Sharp unions become binary trees grouped by their operands' boxes (lazy_tree.c), nested ones and
 * coloured ones together; so does what is sharply subtracted. Everything else keeps its order.
 *
 * Counts, as in the paper: a leaf is one node, and so is each join of two operands: an operator of
 * k operands counts k - 1, or where operands were left out one less than were evaluated, but at
 * least 1. Transforms, colours, offsets and warps belong to what is below them and count nothing.
 */
#ifndef CSG_SCENE_LAZY_H
#define CSG_SCENE_LAZY_H

#include "scene/reference.h"

typedef enum csg_lazy_bounds {
    /* No boxes: the plain field, and nothing can be left out. */
    CSG_LAZY_NO_BOUNDS,
    /* Each node's own box (section 3.3, eq. (14) of the paper): the solid is that of the scene
     * except below soft blends, where small parts may blend less (3.2). */
    CSG_LAZY_OWN_BOXES,
    /* Cameron's S-bounds, shared up and down the tree to a fixed point, as the paper has them.
     * Signs may be wrong at the mouths of holes and near soft blends (3.5): for comparison. */
    CSG_LAZY_SHARED_BOXES,
    /* The exact two-level scheme of section 3.5: the plain field's sign everywhere, and its value
     * wherever that lies in [-band, band]. */
    CSG_LAZY_EXACT
} csg_lazy_bounds;

typedef struct csg_lazy_options {
    bool lazy; /* false: all nodes are evaluated */
    csg_lazy_bounds bounds;
    /* For CSG_LAZY_EXACT; >= 0. Sphere tracing needs a band above its hit tolerance, and so do
     * exact gradients at hits. */
    double band;
    /* Also leaves out what the ancestors cannot see: below a union what is less than its best
     * operand so far, below a difference what is deeper than its first operand, and so on. The
     * paper has only the rules within one operator. Changes no bit either. */
    bool demand;
} csg_lazy_options;

/* Lazy, exact, with this band and with demand. */
csg_lazy_options csg_lazy_options_default(double band);

typedef struct csg_lazy_counts {
    uint64_t top_level; /* calls of csg_lazy_eval */
    uint64_t total;     /* nodes evaluated in them */
} csg_lazy_counts;

typedef struct csg_lazy csg_lazy;

/* Uses the scene (and its context) until csg_lazy_destroy. CSGM_ERR_MEMORY when there is no room,
 * reported. */
csgm_status csg_lazy_create(const csgm_scene *scene, const csg_lazy_options *options,
                            csg_lazy **out);
void csg_lazy_destroy(csg_lazy *lazy); /* NULL is a no-op */

/* Nodes that an evaluation of everything counts. */
uint64_t csg_lazy_node_count(const csg_lazy *lazy);
/* The field's Lipschitz constant, for steps of |value| / lambda. */
double csg_lazy_lipschitz(const csg_lazy *lazy);

/* Bytes of scratch that csg_lazy_eval needs, aligned to 16; one per thread, nothing is kept in it.
 */
size_t csg_lazy_scratch_bytes(const csg_lazy *lazy);
/* Value and gradient at p. Where a bound cuts the value, the gradient is the bound's. Adds to
 * *counts unless that is NULL. Cannot fail; any number of threads may evaluate at once. */
csg_sample csg_lazy_eval(const csg_lazy *lazy, csg_vec3 p, void *scratch, csg_lazy_counts *counts);

#endif
