/* SPDX-License-Identifier: MIT
 * A proof for meshes that began with the triangles of polyhedra: those are the surface, so that no
 * point is farther from it than E is a question of one mesh and another (shape/polyhedra/within.h),
 * however thin walls and gaps are, and the field is not asked.
 *
 * The surface is the polyhedra's own but for what floats and joining them have rounded, which is
 * less than CSG_BEGUN_ROUNDED times the noise of the field; that much of E is set aside, and so is
 * what distances are rounded by.
 */
#ifndef CSG_MESH_DISTANCE_BEGUN_H
#define CSG_MESH_DISTANCE_BEGUN_H

#include "mesh/remesh/remesh.h"
#include "shape/polyhedra/tree.h"

typedef struct csg_begun {
    csg_triangle_frame frame;
    csg_tree tree;
    double slack; /* scene units: distances to the surface are known so exactly */
} csg_begun;

typedef struct csg_begun_proof {
    uint64_t pieces; /* looked at */
    uint64_t open;   /* triangles with a place that is too far away, or is not known to be near */
    csg_vec3 place;  /* of the first of these, field frame */
} csg_begun_proof;

/* Of the mesh that remesh began with. Without triangles where these are no polyhedra's, or too
 * small or too large to be looked at. CSGM_OK or CSGM_ERR_MEMORY (reported). */
csgm_status csg_begun_make(const csg_remesh *remesh, csg_begun *out);
void csg_begun_release(csg_begun *begun);

/* Whether what this proof leaves open is so: else rounding is not small against E. */
bool csg_begun_is_decisive(const csg_begun *begun, double error);

/* pending, a byte per triangle: in, whether it is to be looked at; out, whether it stayed open.
 * CSGM_OK or why it was stopped. The same for any number of threads. */
csgm_status csg_begun_check(const csg_begun *begun, const csg_remesh *remesh, double error,
                            uint8_t *pending, csg_begun_proof *out);

#endif
