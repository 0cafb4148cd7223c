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

#endif
