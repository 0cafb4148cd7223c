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
};

/* Arrays of these sizes from context->memory, not filled. vertex_count < 2^32; counts may be 0.
 * CSGM_ERR_MEMORY (reported) or CSGM_OK. */
csgm_status csg_mesh_create(csgm_context *context, uint64_t vertex_count, uint64_t triangle_count,
                            bool normals, bool colors, csgm_mesh **out);
void csg_mesh_destroy(csgm_mesh *mesh);
csgm_mesh_view csg_mesh_view(const csgm_mesh *mesh);

#endif
