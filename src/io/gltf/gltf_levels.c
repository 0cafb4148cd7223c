/* SPDX-License-Identifier: MIT
 * Parts of a mesh, and of the coarser meshes that are its lower levels of detail, as shapes of one
 * mesh; see gltf_source.h.
 */
#include "base/mesh_codes.h"
#include "io/gltf/gltf_source.h"

static void add_part(csg_gltf_source *source, const csgm_mesh_view *mesh, uint64_t index,
                     uint32_t level, uint64_t first_vertex, uint64_t first_triangle)
{
    csg_part_stretch part = csg_part_get(mesh, index);
    csg_gltf_shape *shape = &source->shapes[source->shape_count];
    *shape = (csg_gltf_shape){.name = part.name,
                              .first_vertex = first_vertex + part.first_vertex,
                              .vertex_count = part.vertex_count,
                              .first_index = 3 * (first_triangle + part.first_triangle),
                              .index_count = 3 * part.triangle_count,
                              .look = csg_look_of(mesh, &part)};
    source->shows[source->show_count++] = (csg_gltf_show){
        .shape = source->shape_count++, .name = part.name, .shift = mesh->origin, .level = level};
}

/* Those without triangles are left out. */
static void add_parts(csg_gltf_source *source, const csgm_mesh_view *mesh, uint32_t level,
                      uint64_t first_vertex, uint64_t first_triangle)
{
    for (uint64_t i = 0; i < csg_part_count(mesh); i++)
        if (!mesh->part_count || mesh->parts[i].triangle_count)
            add_part(source, mesh, i, level, first_vertex, first_triangle);
}

static const csgm_mesh_view *level_at(const csgm_mesh_view *mesh, const csgm_write_options *options,
                                      size_t level)
{
    return level ? &options->levels[level - 1].mesh : mesh;
}

/* ---- one mesh of several --------------------------------------------------------- */

static bool have_same_arrays(const csgm_mesh_view *a, const csgm_mesh_view *b)
{
    return !a->normals == !b->normals && !a->colors == !b->colors &&
           !a->materials == !b->materials && a->split == b->split && b->triangle_count;
}

static void *joined(csg_gltf_source *out, const csgm_mesh_view *mesh,
                    const csgm_write_options *options, size_t bytes,
                    const void *(*array)(const csgm_mesh_view *mesh))
{
    uint8_t *all = csg_arena_alloc(&out->arena, (size_t)out->mesh.vertex_count * bytes);
    size_t at = 0;
    for (size_t i = 0; all && i <= options->level_count; i++) {
        const csgm_mesh_view *level = level_at(mesh, options, i);
        memcpy(all + at, array(level), (size_t)level->vertex_count * bytes);
        at += (size_t)level->vertex_count * bytes;
    }
    return all;
}

static const void *positions_of(const csgm_mesh_view *mesh)
{
    return mesh->positions;
}

static const void *normals_of(const csgm_mesh_view *mesh)
{
    return mesh->normals;
}

static const void *colors_of(const csgm_mesh_view *mesh)
{
    return mesh->colors;
}

static const void *materials_of(const csgm_mesh_view *mesh)
{
    return mesh->materials;
}

static bool join_levels(csg_gltf_source *out, const csgm_mesh_view *mesh,
                        const csgm_write_options *options)
{
    csgm_mesh_view *all = &out->mesh;
    for (size_t i = 0; i < options->level_count; i++) {
        all->vertex_count += options->levels[i].mesh.vertex_count;
        all->triangle_count += options->levels[i].mesh.triangle_count;
    }
    all->positions = joined(out, mesh, options, 3 * sizeof(float), positions_of);
    if (mesh->normals)
        all->normals = joined(out, mesh, options, 3 * sizeof(float), normals_of);
    if (mesh->colors)
        all->colors = joined(out, mesh, options, 4, colors_of);
    if (mesh->materials)
        all->materials = joined(out, mesh, options, 2 * sizeof(uint16_t), materials_of);
    uint32_t *indices =
        csg_arena_alloc(&out->arena, (size_t)all->triangle_count * 3 * sizeof *indices);
    all->indices = indices;
    uint64_t vertices = 0, triangles = 0;
    for (size_t i = 0; indices && i <= options->level_count; i++) {
        const csgm_mesh_view *level = level_at(mesh, options, i);
        for (uint64_t k = 0; k < 3 * level->triangle_count; k++)
            indices[3 * triangles + k] = level->indices[k] + (uint32_t)vertices;
        add_parts(out, level, (uint32_t)i, vertices, triangles);
        vertices += level->vertex_count;
        triangles += level->triangle_count;
    }
    return indices && all->positions && !mesh->normals == !all->normals &&
           !mesh->colors == !all->colors && !mesh->materials == !all->materials;
}

static csgm_status refuse(csgm_context *context, const char *what)
{
    csg_diag_plain(&context->diags, CSG_DIAG_BAD_WRITE_OPTION, NULL, NULL, "%s", what);
    return CSGM_ERR_ARGUMENT;
}

csgm_status csg_gltf_take_levels(csgm_context *context, const csgm_mesh_view *mesh,
                                 const csgm_write_options *options, csg_gltf_source *out)
{
    uint64_t vertices = mesh->vertex_count;
    size_t count = (size_t)csg_part_count(mesh);
    for (size_t i = 0; i < options->level_count; i++) {
        const csgm_mesh_view *level = &options->levels[i].mesh;
        if (!have_same_arrays(mesh, level))
            return refuse(context, "a level of detail does not have the arrays of the first one");
        vertices += level->vertex_count;
        count += (size_t)csg_part_count(level);
    }
    if (vertices > UINT32_MAX)
        return refuse(context, "the levels of detail have too many vertices in all");
    out->shapes = csg_arena_alloc(&out->arena, count * sizeof *out->shapes);
    out->shows = csg_arena_alloc(&out->arena, count * sizeof *out->shows);
    if (!out->shapes || !out->shows)
        return csg_context_no_memory(context);
    if (!options->level_count) {
        add_parts(out, mesh, 0, 0, 0);
        return CSGM_OK;
    }
    return join_levels(out, mesh, options) ? CSGM_OK : csg_context_no_memory(context);
}
