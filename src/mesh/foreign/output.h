/* SPDX-License-Identifier: MIT
 * Reshaped parts -> one mesh: vertices where place, look and normal are the same.
 */
#ifndef CSG_MESH_FOREIGN_OUTPUT_H
#define CSG_MESH_FOREIGN_OUTPUT_H

#include "mesh/foreign/piece.h"

typedef struct csg_foreign_output {
    csgm_context *context;
    csgm_mesh_view source;
    float *positions, *normals;
    csg_corner_look *looks;
    uint32_t *indices;
    size_t vertex_count, triangle_count, vertex_room, normal_room, look_room, index_room;
    bool split, jumps; /* a place has several normals; several looks */
} csg_foreign_output;

void csg_foreign_output_init(csg_foreign_output *output, csgm_context *context,
                             const csgm_mesh_view *source);
void csg_foreign_output_release(csg_foreign_output *output);
/* false: out of memory, or of numbers for vertices. */
bool csg_foreign_output_add(csg_foreign_output *output, const csg_foreign_piece *piece);
/* Triangles of the source as they are. */
bool csg_foreign_output_copy(csg_foreign_output *output, csg_arena *scratch,
                             uint64_t first_triangle, uint64_t triangle_count);
/* Without parts. Reports what fails. */
csgm_status csg_foreign_output_finish(csg_foreign_output *output, csgm_mesh **out);

#endif
