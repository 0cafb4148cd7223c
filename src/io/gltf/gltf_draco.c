/* SPDX-License-Identifier: MIT
 * The shapes of a glTF compressed with Draco, each a mesh of its own on one grid for all: colours
 * linear, as wide as the wanted bits need.
 */
#include <math.h>

#include "io/color.h"
#include "io/gltf/gltf_compress.h"
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

/* ---- pieces ----------------------------------------------------------------------- */

static void release_piece(csg_memory *memory, csg_gltf_piece *piece)
{
    csg_draco_release(&piece->draco);
    csg_memory_release(memory, piece->owned, piece->owned_bytes);
}

bool csg_gltf_add_piece(csg_gltf_pieces *pieces, csg_gltf_piece piece)
{
    if (!csg_memory_reserve(pieces->memory, (void **)&pieces->pieces, &pieces->room,
                            pieces->count + 1, sizeof *pieces->pieces)) {
        release_piece(pieces->memory, &piece);
        return false;
    }
    pieces->pieces[pieces->count++] = piece;
    pieces->end += csg_gltf_padded(piece.size_bytes);
    return true;
}

void csg_gltf_pieces_release(csg_gltf_pieces *pieces)
{
    for (size_t i = 0; i < pieces->count; i++)
        release_piece(pieces->memory, &pieces->pieces[i]);
    csg_memory_release(pieces->memory, pieces->pieces, pieces->room * sizeof *pieces->pieces);
}

/* ---- shapes ----------------------------------------------------------------------- */

static csgm_mesh_view view_of(const csg_gltf_shape *shape, const csgm_mesh_view *mesh)
{
    csgm_mesh_view view = {.positions = mesh->positions + 3 * shape->first_vertex,
                           .indices = mesh->indices + shape->first_index,
                           .vertex_count = shape->vertex_count,
                           .triangle_count = shape->index_count / 3};
    if (mesh->normals)
        view.normals = mesh->normals + 3 * shape->first_vertex;
    if (shape->look.each_color)
        view.colors = mesh->colors + 4 * shape->first_vertex;
    if (shape->look.each_material)
        view.materials = mesh->materials + 2 * shape->first_vertex;
    return view;
}

static csgm_status encode(csg_sink *sink, const csg_gltf_source *from, const csg_gltf_shape *shape,
                          const csgm_write_options *options, const float grid[4],
                          csg_draco_encoded *out)
{
    extract e = {.memory = &sink->context->memory};
    csgm_mesh_view view = view_of(shape, &from->mesh);
    csgm_status status = CSGM_OK;
    if ((view.colors && !fill_colors(&e, &view, options->draco_color_bits)) ||
        (view.materials && !fill_coordinates(&e, &view)) ||
        (shape->first_vertex && !fill_indices(&e, &view, shape->first_vertex)))
        status = csg_context_no_memory(sink->context);
    if (e.indices)
        view.indices = e.indices;
    csg_draco_mesh source = {.colors = e.colors,
                             .color_bytes = options->draco_color_bits > 8 ? 2 : 1,
                             .coordinates = e.coordinates,
                             .grid = grid};
    if (!status)
        status = csg_write_draco(sink, &view, &source, options, out);
    release_extract(&e);
    return status;
}

static int add_accessor(csg_gltf_document *document, uint64_t count, int component,
                        const char *type)
{
    return csg_gltf_add_accessor(
        document, (csg_gltf_accessor){
                      .view = CSG_GLTF_NONE, .count = count, .component = component, .type = type});
}

static void add_shape(csg_gltf_document *document, const csg_gltf_source *source,
                      const csg_gltf_shape *shape, const csg_draco_encoded *draco, int view)
{
    bool wide = document->options->draco_color_bits > 8;
    uint64_t vertices = draco->vertex_count;
    csg_gltf_mesh mesh = csg_gltf_new_mesh(document, shape);
    mesh.draco_view = view;
    mesh.draco_position = draco->position_id;
    mesh.draco_normal = draco->normal_id;
    mesh.draco_color = draco->color_id;
    mesh.draco_mixing = draco->coordinate_id;
    csg_gltf_accessor position = {.view = CSG_GLTF_NONE,
                                  .count = vertices,
                                  .component = CSG_GLTF_FLOAT,
                                  .type = "VEC3",
                                  .has_range = true};
    for (int k = 0; k < 3; k++) {
        position.min[k] = (double)shape->min[k];
        position.max[k] = (double)shape->max[k];
    }
    mesh.position = csg_gltf_add_accessor(document, position);
    if (source->mesh.normals)
        mesh.normal = add_accessor(document, vertices, CSG_GLTF_FLOAT, "VEC3");
    if (shape->look.each_color) {
        mesh.color = add_accessor(document, vertices,
                                  wide ? CSG_GLTF_UNSIGNED_SHORT : CSG_GLTF_UNSIGNED_BYTE, "VEC4");
        document->accessors[mesh.color].normalized = true;
    }
    if (shape->look.each_material) {
        mesh.mixing = add_accessor(document, vertices, CSG_GLTF_UNSIGNED_SHORT, "VEC2");
        document->accessors[mesh.mixing].normalized = true;
    }
    mesh.indices = add_accessor(
        document, 3 * draco->triangle_count,
        vertices <= UINT16_MAX ? CSG_GLTF_UNSIGNED_SHORT : CSG_GLTF_UNSIGNED_INT, "SCALAR");
    csg_gltf_add_mesh(document, mesh);
}

static csgm_status compress_shape(csg_sink *sink, csg_gltf_document *document,
                                  const csg_gltf_source *source, const csg_gltf_shape *shape,
                                  const float grid[4], csg_gltf_pieces *pieces)
{
    csg_gltf_piece piece = {0};
    csgm_status status = encode(sink, source, shape, document->options, grid, &piece.draco);
    if (status)
        return status;
    piece.bytes = piece.draco.bytes;
    piece.size_bytes = piece.draco.size_bytes;
    int view = csg_gltf_add_view(document,
                                 (csg_gltf_view){.offset = pieces->end, .bytes = piece.size_bytes});
    add_shape(document, source, shape, &piece.draco, view);
    if (!csg_gltf_add_piece(pieces, piece) || document->failed)
        return csg_context_no_memory(sink->context);
    return CSGM_OK;
}

static csgm_status compress_shapes(csg_sink *sink, csg_gltf_document *document,
                                   const csg_gltf_source *source, const csg_rounding *rounding,
                                   csg_gltf_pieces *pieces)
{
    const float grid[4] = {rounding->low[0], rounding->low[1], rounding->low[2], rounding->range};
    csgm_status status = CSGM_OK;
    document->draco = true;
    for (size_t i = 0; i < source->shape_count && !status; i++)
        status = compress_shape(sink, document, source, &source->shapes[i],
                                rounding->is_told ? grid : NULL, pieces);
    document->buffer_bytes = pieces->end;
    if (csg_gltf_is_mixed(source)) {
        document->image_view = csg_gltf_add_view(
            document, (csg_gltf_view){.offset = pieces->end, .bytes = CSG_GLTF_MIXING_BYTES});
        document->buffer_bytes += CSG_GLTF_MIXING_BYTES;
    }
    csg_gltf_add_nodes(document, source, NULL, NULL);
    return status;
}

/* One grid for all shapes, so that faces that met still meet. */
csgm_status csg_gltf_compress_draco(csg_sink *sink, csg_gltf_document *document,
                                    const csg_gltf_source *source, csg_gltf_pieces *pieces)
{
    csgm_mesh_view local = source->mesh;
    local.origin = (csgm_vec3){0, 0, 0}; /* it is where the nodes are */
    csg_rounding grid = csg_rounding_of_draco(&local, document->options->draco_position_bits,
                                              source->shape_count > 1);
    csg_rounded rounded;
    csgm_status status =
        csg_round_mesh(sink->context, &local, &grid, sink->name, "Draco", &rounded);
    if (status)
        return status;
    csg_gltf_source moved = *source;
    moved.mesh = rounded.mesh;
    status = compress_shapes(sink, document, &moved, &grid, pieces);
    csg_rounded_release(sink->context, &rounded);
    return status;
}
