/* SPDX-License-Identifier: MIT
 * Joining vertices that lie at one place: those of a mesh that is split at creases, and those of
 * any mesh whose files keep a vertex for each normal.
 */
#ifndef CSG_MESH_WELD_H
#define CSG_MESH_WELD_H

#include "mesh/mesh.h"

typedef enum csg_weld {
    CSG_WELD_RUNS, /* vertices one after the other with bit-equal positions: csgm_mesh_view.split */
    CSG_WELD_PARTS, /* wherever they stand; -0 and 0 are one place */
    CSG_WELD_ALL    /* the same, and those of several parts: RUNS and PARTS leave these apart */
} csg_weld;

/* to[i]: the first vertex at the place of vertex i, for all i < vertex_count. The number of places.
 * *failed: out of memory, not reported. */
uint64_t csg_weld_map(csg_memory *memory, const csgm_mesh_view *mesh, csg_weld how, uint32_t *to,
                      bool *failed);

/* part_of[i]: the part whose triangles use vertex i, or CSG_NO_PART, as of what a crease has left
 * without any. */
#define CSG_NO_PART UINT32_MAX
void csg_weld_parts_of(const csgm_mesh_view *mesh, uint32_t *part_of);

/* The mesh with one vertex per place: normals, colours and materials are the means of the copies'.
 * Reports what fails (memory only). */
csgm_status csg_weld_runs(csgm_context *context, const csgm_mesh_view *mesh, csgm_mesh **out);

#endif
