/* SPDX-License-Identifier: MIT
 * Joining vertices that lie at one place: those of a mesh that is split at creases, and those of
 * any mesh whose files keep a vertex for each normal.
 */
#ifndef CSG_MESH_WELD_H
#define CSG_MESH_WELD_H

#include "mesh/mesh.h"

typedef enum csg_weld {
    CSG_WELD_RUNS, /* vertices one after the other with bit-equal positions: csgm_mesh_view.split */
    CSG_WELD_ALL   /* wherever they stand; -0 and 0 are one place */
} csg_weld;

/* to[i]: the first vertex at the place of vertex i, for all i < vertex_count. The number of places.
 * *failed: out of memory (ALL only), not reported. */
uint64_t csg_weld_map(csg_memory *memory, const csgm_mesh_view *mesh, csg_weld how, uint32_t *to,
                      bool *failed);

/* The mesh with one vertex per place: normals, colours and materials are the means of the copies'.
 * Reports what fails (memory only). */
csgm_status csg_weld_runs(csgm_context *context, const csgm_mesh_view *mesh, csgm_mesh **out);

#endif
