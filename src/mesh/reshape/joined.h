/* SPDX-License-Identifier: MIT
 * A mesh that is made tile by tile: each is thinned out by itself within its cube, its border left
 * as it is, and put behind those before it. What is left of the seams goes when all are there: with
 * the samples of all tiles, so the distance is that to the surface, and not to another mesh.
 */
#ifndef CSG_MESH_RESHAPE_JOINED_H
#define CSG_MESH_RESHAPE_JOINED_H

#include "base/table.h"
#include "mesh/reshape/decimation.h"

/* A vertex on a seam. */
typedef struct csg_tile_seam {
    uint64_t place; /* what the tiles that have it know it by */
    uint32_t number;
} csg_tile_seam;

typedef struct csg_joined {
    csgm_context *context;
    float *positions;
    uint8_t *colors;     /* as the tiles have them */
    uint16_t *materials; /* likewise */
    uint8_t *kinds;      /* csg_vertex_kind */
    uint32_t *indices;
    size_t position_room, color_room, material_room, kind_room, index_room;
    size_t vertex_count, index_count;
    bool has_colors, has_materials;
    csg_tile_seam *seam;
    size_t seam_count, seam_room;
    csg_table seam_index;
    csg_begun_samples samples;
    uint64_t begun;   /* triangles before anything was thinned out */
    uint64_t creases; /* vertices on creases, corners and tips, likewise */
} csg_joined;

/* A tile. */
typedef struct csg_tile_mesh {
    csgm_mesh *mesh;        /* open at its border; with all that vertices have */
    const uint64_t *places; /* per vertex; 0: it is not at the border */
    const uint8_t *creases; /* per vertex */
    const csg_seen *seen;   /* by the judge, of the whole mesh; NULL: nobody was asked */
    csg_vec3 low, high;     /* its cube, field frame; low.x > high.x: it is not thinned out */
    double error, farthest; /* as csg_remesh and csg_decimation have them */
    double share;           /* of what is left of the stage, for progress */
} csg_tile_mesh;

/* colors, materials: whether the tiles have them. */
void csg_joined_begin(csg_joined *joined, csgm_context *context, bool colors, bool materials);
void csg_joined_end(csg_joined *joined);
/* Thins the tile out and puts it behind the others. CSGM_OK or why it was stopped (reported). */
csgm_status csg_joined_add(csg_joined *joined, const csg_tile_mesh *tile,
                           const csg_marching *marching, csg_mesh_watch *watch);
/* All of them as a mesh, whose origin is still to be set; only kinds and samples stay. CSGM_OK or
 * CSGM_ERR_MEMORY (reported). */
csgm_status csg_joined_write(csg_joined *joined, csgm_mesh **out);

#endif
