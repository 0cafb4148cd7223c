/* SPDX-License-Identifier: MIT
 * What the files of the lazy evaluator share; see lazy.h.
 */
#ifndef CSG_SCENE_LAZY_PRIVATE_H
#define CSG_SCENE_LAZY_PRIVATE_H

#include "scene/lazy/lazy.h"

/* A node's bound in its own frame: value <= lambda b_box - below. */
typedef struct csg_lazy_bound {
    csg_box box;
    double lambda, below;
    bool is_known;
} csg_lazy_bound;

struct csg_lazy {
    csgm_context *context;
    csg_arena arena;
    bool lazy, demand;
    csgm_scene tree; /* the scene with joins; only nodes and children are its own, in arena */
    csg_lazy_bound *bounds; /* per node */
    double *
        supports; /* per operator: operands that far below the best do not matter; NAN: not known */
    csg_node_id *identity;  /* 0, 1, 2, ... as many as a node has operands */
    size_t depth, slots;    /* most frames and samples at once */
    size_t operands, steps; /* most of a node, of a formula */
    double lipschitz;
};

/* Whether it is an operator that rises with each operand and is at least the largest of its union
 * (reference.c), also after rounding, and that leaves a result as it is where an operand is outside
 * the support. */
bool csg_lazy_is_plain(const csg_node *node);

/* Fills lazy->tree from the scene: joins of two instead of long sharp unions. */
csgm_status csg_lazy_grow_tree(csg_lazy *lazy, const csgm_scene *scene);

/* Fills lazy->bounds. */
csgm_status csg_lazy_find_bounds(csg_lazy *lazy, const csg_lazy_options *options);

#endif
