/* SPDX-License-Identifier: MIT
 * What is asked of whole nodes: is the field an exact distance, polygons of a flat node, triangles
 * and the tight box of a solid; sketches of what is not asked.
 */
#ifndef CSG_SOLID_MEASURE_H
#define CSG_SOLID_MEASURE_H

#include "solid/solid.h"

/* Is the field below the node the exact distance outside (or inside) of its solid? */
bool csg_distance_is_exact(const csg_solid_job *job, csg_node_id node, bool outside);
/* Is it made of distances (tubes and tori count as such), by whatever operators and blends? */
bool csg_distances_are_joined(const csg_solid_job *job, csg_node_id node);
/* How far the surface of a solid moves at most where `by` is added to its field, as sampled, and
 * where; 0: nothing was found. */
typedef struct csg_growth {
    double most;
    csg_vec3 at;
} csg_growth;
csgm_status csg_sample_growth(csg_solid_job *job, csg_node_id node, double by, csg_growth *out);
/* Clean polygons of a flat node: its own corners, arcs within 1e-5 of its size. */
csgm_status csg_flat_outline(csg_solid_job *job, csg_node_id node, csg_outline *out);
/* Triangles on the surface of a solid, by marching cubes: 160 cells along its longest side, or as
 * told. */
csgm_status csg_solid_triangles(csg_solid_job *job, csg_node_id node, csg_triangles *out);
csgm_status csg_solid_triangles_by(csg_solid_job *job, csg_node_id node, uint32_t cells,
                                   csg_triangles *out);
/* The box of the node's solid, tight where its pieces are known, else within a cell of a
 * tessellation. */
csgm_status csg_tight_box(csg_solid_job *job, csg_node_id node, csg_box *out);
/* Where the job only sketches: the box as a solid, or what it covers of the plane. False: it does
 * not, or the box has no volume, so that what it is about may be nothing. */
bool csg_solid_sketch(csg_solid_job *job, csg_box box, csg_node_id *out);
bool csg_solid_sketch_flat(csg_solid_job *job, csg_box box, csg_node_id *out);
/* Longest side of the node's box; reports and fails where it is infinite. */
bool csg_finite_size(csg_solid_job *job, csg_node_id node, double *out);

#endif
