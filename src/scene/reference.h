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
csg_sample csg_reference_primitive(csg_node_kind kind, const double *parameters, csg_vec3 p);

/* f_b(x, n) and its derivative (operators.md 2.1), x >= 0. Not for SHARP and ROUND. */
void csg_reference_blend_function(csg_blend_kind kind, double n, double x, double *value,
                                  double *derivative);

/* Union of k >= 1 values: G and its partial derivatives (sections 2.2 and 12). FOLD blends need
 * k = 2. Intersection: -G(-f); difference: -G(-f1, f2, ...). */
double csg_reference_union(csg_blend blend, const double *values, size_t count, double *partials);

/* Whole scene at a point; *status becomes CSGM_ERR_MEMORY when there was no room, else untouched.
 */
csg_sample csg_reference_eval(const csgm_scene *scene, csg_vec3 p, csgm_status *status);

/* Primitives whose value can change the root's there: those not dropped by an operator's support.
 */
uint32_t csg_reference_active_primitives(const csgm_scene *scene, csg_vec3 p, csgm_status *status);

#endif
