/* SPDX-License-Identifier: MIT */
#include "mesh/mesh.h"

static bool take(csgm_context *context, void *slot, uint64_t count, size_t element_bytes)
{
    void **array = slot;
    *array = NULL;
    if (!count)
        return true;
    if (count > SIZE_MAX / element_bytes)
        return false;
    *array = csg_memory_alloc(&context->memory, (size_t)count * element_bytes);
    return *array != NULL;
}

csgm_status csg_mesh_create(csgm_context *context, uint64_t vertex_count, uint64_t triangle_count,
                            bool normals, bool colors, csgm_mesh **out)
{
    csgm_mesh *mesh = csg_memory_alloc(&context->memory, sizeof *mesh);
    if (!mesh)
        return csg_context_no_memory(context);
    *mesh = (csgm_mesh){
        .context = context, .vertex_count = vertex_count, .triangle_count = triangle_count};
    if (!take(context, &mesh->positions, vertex_count, 3 * sizeof(float)) ||
        (normals && !take(context, &mesh->normals, vertex_count, 3 * sizeof(float))) ||
        (colors && !take(context, &mesh->colors, vertex_count, 4)) ||
        !take(context, &mesh->indices, triangle_count, 3 * sizeof(uint32_t))) {
        csg_mesh_destroy(mesh);
        return csg_context_no_memory(context);
    }
    *out = mesh;
    return CSGM_OK;
}

void csg_mesh_destroy(csgm_mesh *mesh)
{
    if (!mesh)
        return;
    csg_memory *memory = &mesh->context->memory;
    csg_memory_release(memory, mesh->positions, mesh->vertex_count * 3 * sizeof(float));
    csg_memory_release(memory, mesh->normals, mesh->vertex_count * 3 * sizeof(float));
    csg_memory_release(memory, mesh->colors, mesh->vertex_count * 4);
    csg_memory_release(memory, mesh->indices, mesh->triangle_count * 3 * sizeof(uint32_t));
    csg_memory_release(memory, mesh, sizeof *mesh);
}

csgm_mesh_view csg_mesh_view(const csgm_mesh *mesh)
{
    return (csgm_mesh_view){.origin = mesh->origin,
                            .positions = mesh->positions,
                            .normals = mesh->normals,
                            .colors = mesh->colors,
                            .indices = mesh->indices,
                            .vertex_count = mesh->vertex_count,
                            .triangle_count = mesh->triangle_count};
}
