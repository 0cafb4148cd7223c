/* SPDX-License-Identifier: MIT */
#include "mesh/mesh.h"

#include <string.h>

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
    csg_arena_init(&mesh->names, &context->memory);
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
    csg_memory_release(memory, mesh->materials, mesh->vertex_count * 2 * sizeof(uint16_t));
    csg_memory_release(memory, mesh->parts, mesh->part_room * sizeof *mesh->parts);
    csg_arena_reset(&mesh->names);
    csg_memory_release(memory, mesh, sizeof *mesh);
}

csgm_status csg_mesh_add_materials(csgm_mesh *mesh)
{
    return take(mesh->context, &mesh->materials, mesh->vertex_count, 2 * sizeof(uint16_t))
               ? CSGM_OK
               : csg_context_no_memory(mesh->context);
}

csgm_status csg_mesh_add_part(csgm_mesh *mesh, const char *name, uint64_t first_triangle)
{
    char *copy = name ? csg_arena_strndup(&mesh->names, name, strlen(name)) : NULL;
    if ((name && !copy) ||
        !csg_memory_reserve(&mesh->context->memory, (void **)&mesh->parts, &mesh->part_room,
                            mesh->part_count + 1, sizeof *mesh->parts))
        return csg_context_no_memory(mesh->context);
    if (mesh->part_count) {
        csgm_mesh_part *last = &mesh->parts[mesh->part_count - 1];
        last->triangle_count = first_triangle - last->first_triangle;
    }
    mesh->parts[mesh->part_count++] =
        (csgm_mesh_part){copy, first_triangle, mesh->triangle_count - first_triangle};
    return CSGM_OK;
}

csgm_mesh_view csg_mesh_view(const csgm_mesh *mesh)
{
    return (csgm_mesh_view){.origin = mesh->origin,
                            .positions = mesh->positions,
                            .normals = mesh->normals,
                            .colors = mesh->colors,
                            .indices = mesh->indices,
                            .vertex_count = mesh->vertex_count,
                            .triangle_count = mesh->triangle_count,
                            .parts = mesh->parts,
                            .part_count = mesh->part_count,
                            .materials = mesh->materials,
                            .split = mesh->split,
                            .equal_cells = mesh->equal_cells};
}
