/* SPDX-License-Identifier: MIT
 * The field in double precision: the definition that every kernel answers to.
 */
#ifndef CSG_SCENE_REFERENCE_H
#define CSG_SCENE_REFERENCE_H

#include "scene/scene.h"

typedef struct csg_sample {
    double value;
    csg_vec3 gradient; /* zero at critical points */
} csg_sample;

/* One primitive (no field) in its own frame, parameters as in primitives.def (operators.md 1). */
csg_sample csg_reference_primitive(csg_primitive_kind kind, const double *parameters, csg_vec3 p);

/* f_b(x, n) and its derivative (operators.md 2.1), x >= 0. Not for SHARP and ROUND. */
void csg_reference_blend_function(csg_blend blend, double x, double *value, double *derivative);

/* Union of k >= 1 values: G and its partial derivatives (sections 2.2 and 12). FOLD blends need
 * k = 2. Intersection: -G(-f); difference: -G(-f1, f2, ...). */
double csg_reference_union(csg_blend blend, const double *values, size_t count, double *partials);

/* Whole scene at a point; *status becomes CSGM_ERR_MEMORY when there was no room, else untouched.
 */
csg_sample csg_reference_eval(const csgm_scene *scene, csg_vec3 p, csgm_status *status);

/* The same with the true gradient: for who wants to look at it, not for what must be the kernels'.
 */
csg_sample csg_reference_look(const csgm_scene *scene, csg_vec3 p, csgm_status *status);

/* Scratch for one node at a time. */
typedef struct csg_reference_work {
    csg_formula_dual *steps;   /* room for the longest formula */
    double *values, *partials; /* room for the most operands */
} csg_reference_work;

/* Room for samples of all nodes, to be used for many points. */
typedef struct csg_reference_room {
    csg_vec3 *points;    /* per node, in its own frame */
    csg_sample *samples; /* the same */
    csg_reference_work node;
    void *heap;
    size_t heap_bytes;
} csg_reference_room;

/* False: out of memory, nothing to end. */
bool csg_reference_room_begin(csg_reference_room *room, const csgm_scene *scene);
void csg_reference_room_end(csg_reference_room *room, const csgm_scene *scene);
/* A node at p in its own frame; the nodes below it are those from `first` on. Their samples are in
 * the room then, each at the point that it was asked at. */
csg_sample csg_reference_below(csg_reference_room *room, const csgm_scene *scene, csg_node_id first,
                               csg_node_id node, csg_vec3 p);

/* The gradient of the values around p. What samples have is what operators mix of their operands',
 * and leaves out what fillets and debulge gain as these turn; here, in scenes that have such, it is
 * by central differences of the values (good to some 1e-9), but that of the sample `here` where
 * there is a crease within 1e-6 of the solid's size. The room's samples are others afterwards. */
csg_vec3 csg_reference_true_gradient(csg_reference_room *room, const csgm_scene *scene,
                                     csg_node_id first, csg_node_id node, csg_vec3 p,
                                     csg_sample here);

/* What it takes to ask a node alone, in nodes of which one is a box. */
uint64_t csg_reference_cost(const csgm_scene *scene, const csg_node *node);

/* Whether its value depends on gradients: a fillet's, or a rule's with debulge. */
bool csg_reference_turns(const csgm_scene *scene, const csg_node *node);

/* Where a node at p asks its children. */
csg_vec3 csg_reference_inner_point(const csgm_scene *scene, const csg_node *node, csg_vec3 p);

/* One node at p (in its own frame) from its children's samples there: samples[at[k]] is that of
 * child k. An operand of a union that is known not to matter may be given as -INFINITY. */
csg_sample csg_reference_node(const csgm_scene *scene, const csg_node *node, csg_vec3 p,
                              const csg_sample *samples, const csg_node_id *at,
                              const csg_reference_work *work);

/* Primitives whose value can change the root's there: those not dropped by an operator's support.
 */
uint32_t csg_reference_active_primitives(const csgm_scene *scene, csg_vec3 p, csgm_status *status);

/* The leaf that decides the value there: of operators the operand that counts most, of combinations
 * the one nearest to its surface. CSG_NODE_NONE: no room, with *status. */
csg_node_id csg_reference_deciding_leaf(const csgm_scene *scene, csg_vec3 p, csgm_status *status);

#endif
