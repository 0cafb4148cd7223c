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

/* *out is written on CSGM_OK only. CSGM_ERR_MEMORY (reported), CSGM_ERR_LIMIT (reported) above
 * 2^32 / 3 triangles. Takes about 36 bytes per triangle while it runs. */
csgm_status csg_mesh_inspect(csgm_context *context, const csgm_mesh_view *mesh,
                             csgm_mesh_check *out);

#endif
