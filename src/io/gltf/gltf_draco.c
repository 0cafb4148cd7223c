/* SPDX-License-Identifier: MIT
 * The parts of a glTF compressed with Draco, each a mesh of its own on one grid for all: colours
 * linear, as wide as the wanted bits need.
 */
#include <math.h>

#include "io/color.h"
#include "io/gltf/gltf_layout.h"
#include "io/rounding.h"

/* What the encoder gets of a part: its own arrays, from memory. */
typedef struct extract {
    csg_memory *memory;
    void *colors; /* linear, of one byte when that holds the wanted bits */
    uint16_t *coordinates;
    uint32_t *indices; /* from the part's first vertex on; NULL = the mesh's own */
    size_t color_bytes, coordinate_bytes, index_bytes;
} extract;

static bool fill_colors(extract *e, const csgm_mesh_view *mesh, uint32_t bits)
{
    bool wide = bits > 8;
    e->color_bytes = (size_t)mesh->vertex_count * (wide ? 8 : 4);
    uint8_t *colors = e->colors = csg_memory_alloc(e->memory, e->color_bytes);
    csg_color_table table = csg_color_table_make(bits, wide);
    for (uint64_t i = 0; colors && i < 4 * mesh->vertex_count; i++) {
        const uint16_t *curve = i % 4 == 3 ? table.alpha : table.linear;
        uint16_t value = curve[mesh->colors[i]];
        if (wide)
            memcpy(colors + 2 * i, &value, 2);
        else
            colors[i] = (uint8_t)value;
    }
    return colors;
}

static bool fill_coordinates(extract *e, const csgm_mesh_view *mesh)
{
    e->coordinate_bytes = (size_t)mesh->vertex_count * 2 * sizeof *e->coordinates;
    e->coordinates = csg_memory_alloc(e->memory, e->coordinate_bytes);
    for (uint64_t i = 0; e->coordinates && i < 2 * mesh->vertex_count; i++)
        e->coordinates[i] = (uint16_t)csg_gltf_coordinate(mesh->materials[i]);
    return e->coordinates;
}

static bool fill_indices(extract *e, const csgm_mesh_view *mesh, uint64_t first)
{
    e->index_bytes = (size_t)mesh->triangle_count * 3 * sizeof *e->indices;
    e->indices = csg_memory_alloc(e->memory, e->index_bytes);
    for (uint64_t i = 0; e->indices && i < 3 * mesh->triangle_count; i++)
        e->indices[i] = mesh->indices[i] - (uint32_t)first;
    return e->indices;
}

static void release_extract(extract *e)
{
    csg_memory_release(e->memory, e->colors, e->color_bytes);
    csg_memory_release(e->memory, e->coordinates, e->coordinate_bytes);
    csg_memory_release(e->memory, e->indices, e->index_bytes);
}

static csgm_mesh_view view_of(const csg_gltf_part *part, const csgm_mesh_view *mesh)
{
    csgm_mesh_view view = {.origin = mesh->origin,
                           .positions = mesh->positions + 3 * part->first_vertex,
                           .indices = mesh->indices + part->first_index,
                           .vertex_count = part->vertex_count,
                           .triangle_count = part->index_count / 3};
    if (mesh->normals)
        view.normals = mesh->normals + 3 * part->first_vertex;
    if (mesh->colors)
        view.colors = mesh->colors + 4 * part->first_vertex;
    if (mesh->materials)
        view.materials = mesh->materials + 2 * part->first_vertex;
    return view;
}

static csgm_status compress_part(csg_sink *sink, const csg_gltf_layout *layout, csg_gltf_part *part,
                                 const csgm_mesh_view *mesh, const csgm_write_options *options,
                                 const float grid[4])
{
    extract e = {.memory = &sink->context->memory};
    csgm_mesh_view view = view_of(part, mesh);
    csgm_status status = CSGM_OK;
    if ((view.colors && !fill_colors(&e, &view, options->draco_color_bits)) ||
        (part->textured && !fill_coordinates(&e, &view)) ||
        (part->first_vertex && !fill_indices(&e, &view, part->first_vertex)))
        status = csg_context_no_memory(sink->context);
    if (e.indices)
        view.indices = e.indices;
    csg_draco_mesh source = {.colors = e.colors,
                             .color_bytes = layout->wide_colors ? 2 : 1,
                             .coordinates = e.coordinates,
                             .grid = grid};
    if (!status)
        status = csg_write_draco(sink, &view, &source, options, &part->draco);
    release_extract(&e);
    part->vertex_count = part->draco.vertex_count;
    part->index_count = 3 * part->draco.triangle_count;
    return status;
}

static csgm_status compress_parts(csg_sink *sink, csg_gltf_layout *layout, csg_gltf_part *parts,
                                  const csgm_mesh_view *mesh, const csgm_write_options *options,
                                  const csg_rounding *rounding)
{
    const float grid[4] = {rounding->low[0], rounding->low[1], rounding->low[2], rounding->range};
    csgm_status status = CSGM_OK;
    layout->compressed = layout->short_indices = true;
    layout->wide_colors = options->draco_color_bits > 8;
    layout->buffer_bytes = layout->image_bytes;
    for (uint64_t i = 0; i < layout->part_count && !status; i++) {
        parts[i].draco_at = layout->buffer_bytes - layout->image_bytes;
        status =
            compress_part(sink, layout, &parts[i], mesh, options, rounding->is_told ? grid : NULL);
        layout->buffer_bytes += ((uint64_t)parts[i].draco.size_bytes + 3) & ~(uint64_t)3;
        layout->short_indices &= parts[i].vertex_count <= UINT16_MAX;
    }
    return status;
}

/* One grid for all parts, so that faces that met still meet. */
csgm_status csg_gltf_compress(csg_sink *sink, csg_gltf_layout *layout, csg_gltf_part *parts,
                              const csgm_mesh_view *mesh, const csgm_write_options *options)
{
    csgm_mesh_view local = *mesh;
    local.origin = (csgm_vec3){0, 0, 0}; /* it is in the node's matrix */
    csg_rounding grid =
        csg_rounding_of_draco(&local, options->draco_position_bits, layout->part_count > 1);
    csg_rounded rounded;
    csgm_status status =
        csg_round_mesh(sink->context, &local, &grid, sink->name, "Draco", &rounded);
    if (status)
        return status;
    status = compress_parts(sink, layout, parts, &rounded.mesh, options, &grid);
    csg_rounded_release(sink->context, &rounded);
    return status;
}
