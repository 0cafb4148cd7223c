/* SPDX-License-Identifier: MIT
 * A mesh in memory: what csgm_mesh_view looks at, owned.
 */
#ifndef CSG_MESH_MESH_H
#define CSG_MESH_MESH_H

#include "base/context.h"

struct csgm_mesh {
    csgm_context *context;
    csgm_vec3 origin;
    float *positions;  /* 3 * vertex_count */
    float *normals;    /* 3 * vertex_count or NULL */
    uint8_t *colors;   /* 4 * vertex_count or NULL */
    uint32_t *indices; /* 3 * triangle_count */
    uint64_t vertex_count, triangle_count;
    uint16_t *materials; /* 2 * vertex_count or NULL */
    csgm_mesh_part *parts;
    size_t part_count, part_room;
    csg_arena names;  /* of parts, and left_out */
    bool split;       /* csgm_mesh_view.split */
    bool equal_cells; /* csgm_mesh_view.equal_cells */
    bool says_unit;   /* its file did: */
    csgm_unit unit;
    const char *left_out; /* what its file had and the mesh has not; NULL: nothing */
};

/* A channel in 0..1 as a vertex's colour has it. */
static inline uint8_t csg_mesh_color_byte(float channel)
{
    float v = channel * 255.0f + 0.5f;
    return (uint8_t)(v < 0 ? 0 : v > 255 ? 255 : v);
}
/* Metallic or roughness in 0..1 in steps of 1 / 10000: what was mixed of equal parts is equal
 * again. */
static inline uint16_t csg_mesh_material_share(float channel)
{
    float v = channel * 10000.0f + 0.5f;
    return (uint16_t)(v < 0 ? 0 : v > 10000 ? 10000 : v);
}

/* Arrays of these sizes from context->memory, not filled. vertex_count < 2^32; counts may be 0.
 * CSGM_ERR_MEMORY (reported) or CSGM_OK. */
csgm_status csg_mesh_create(csgm_context *context, uint64_t vertex_count, uint64_t triangle_count,
                            bool normals, bool colors, csgm_mesh **out);
void csg_mesh_destroy(csgm_mesh *mesh);
/* An array for the materials of all vertices, not filled. Reports what fails (memory only). */
csgm_status csg_mesh_add_materials(csgm_mesh *mesh);
/* The triangles from here to the next part's first, or to the end; name (may be NULL) is copied.
 * The first part begins with triangle 0. */
csgm_status csg_mesh_add_part(csgm_mesh *mesh, const char *name, uint64_t first_triangle);
csgm_mesh_view csg_mesh_view(const csgm_mesh *mesh);

#endif
