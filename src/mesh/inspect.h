/* SPDX-License-Identifier: MIT
 * What is a mesh worth: closed, oriented, manifold, how large. Exact counts for any input: open,
 * non-manifold, broken indices.
 *
 * Triangles with an index out of range are left out of everything but their count; triangles that
 * use an index twice are counted and left out of edges, fans, Euler characteristic and components.
 */
#ifndef CSG_MESH_INSPECT_H
#define CSG_MESH_INSPECT_H

#include "base/context.h"
#include "base/geometry.h"

/* *out is written on CSGM_OK only. CSGM_ERR_MEMORY (reported), CSGM_ERR_LIMIT (reported) above
 * 2^32 / 3 triangles and when it takes longer than the context's time limit, CSGM_CANCELLED. Takes
 * about 36 bytes per triangle while it runs. limit_from_s: when what the limit is for has begun, by
 * csg_clock_now_s; 0 = now. */
csgm_status csg_mesh_inspect(csgm_context *context, const csgm_mesh_view *mesh, double limit_from_s,
                             csgm_mesh_check *out);

/* Reports it: CSGM_ERR_LIMIT. */
csgm_status csg_mesh_too_large(csgm_context *context, uint64_t triangle_count);

/* Area, volume and shapes of triangles that come one after the other, in the order in which
 * rounding leaves the same numbers whoever goes through them. */
typedef struct csg_mesh_measures {
    csg_vec3 apex; /* of the tetrahedra whose volumes are summed: small terms, small errors */
    double area, volume;
    double cotangent, aspect; /* the largest of all; of the smallest angle */
    uint64_t triangles, flat; /* flat: without area */
} csg_mesh_measures;

/* box: of all vertices that triangles use. */
csg_mesh_measures csg_mesh_measures_begin(csg_box box);
void csg_mesh_measures_add(csg_mesh_measures *measures, csg_vec3 a, csg_vec3 b, csg_vec3 c);
/* area ... max_aspect, zero_area_triangles and bounds, which are those of box moved by origin. */
void csg_mesh_measures_end(const csg_mesh_measures *measures, csg_box box, csgm_vec3 origin,
                           csgm_mesh_check *check);

#endif
