/* SPDX-License-Identifier: MIT
 * A whole scene as one formula of x, y and z, in double: the same field as scene/reference.c, up
 * to rounding, but for tubes along curves, which become chords within 1e-4 of the largest radius.
 * Choices become steep steps, iterations are written out. Solids bounded by triangles can be
 * written only where they are convex.
 */
#ifndef CSG_SCENE_FORMULATE_H
#define CSG_SCENE_FORMULATE_H

#include "scene/formula/step.h"
#include "scene/scene.h"

/* The result's step in `terms`, which was begun. CSGM_ERR_UNSUPPORTED: *obstacle is a node that no
 * formula is known for; CSGM_ERR_LIMIT: more steps than terms->most; CSGM_ERR_MEMORY. */
csgm_status csg_formulate(const csgm_scene *scene, csg_terms *terms, csg_term *result,
                          csg_node_id *obstacle);

/* ---- parts of it ----------------------------------------------------------------------------- */

/* A primitive at the point p (three terms). */
csg_term csg_formulate_primitive(csg_terms *t, csg_primitive_kind kind, const double *v,
                                 const csg_term p[3]);
/* A shape; false: not convex. */
bool csg_formulate_shape(csg_terms *t, const csg_shape *shape, const csg_term p[3],
                         csg_term *result);
/* csg_reference_union. `values` is changed. */
csg_term csg_formulate_union(csg_terms *t, csg_blend blend, csg_term *values, size_t count);

#endif
