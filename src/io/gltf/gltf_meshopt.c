/* SPDX-License-Identifier: MIT
 * The shapes of a glTF compressed by meshoptimizer (EXT_ or KHR_meshopt_compression): positions as
 * whole numbers on one grid for all (KHR_mesh_quantization; nodes scale them back), normals in two
 * bytes, triangles and vertices in an order that caches and codecs like. A view for each array of
 * each shape.
 */
#include <assert.h>
#include <math.h>

#include "io/color.h"
#include "io/gltf/gltf_compress.h"
#include "io/gltf/vertex_stream.h"
#include "io/rounding.h"

typedef struct meshopt {
    csg_sink *sink;
    csg_memory *memory;
    csg_gltf_document *document;
    const csg_gltf_source *source;
    csg_gltf_pieces *pieces;
    const csg_rounding *grid;
    csg_color_table colors;
    const csg_gltf_shape *shape; /* being compressed */
    uint32_t *indices;           /* its own, in their new order */
    uint32_t *to;                /* each of its vertices' new number; NO_VERTEX: none */
    uint32_t used;               /* vertices that have one */
} meshopt;

#define NO_VERTEX UINT32_MAX

static csgm_status no_memory(const meshopt *m)
{
    return csg_context_no_memory(m->sink->context);
}

/* ---- views -----------------------------------------------------------------------------------
 */

typedef struct packing {
    csg_meshopt_mode mode;
    const char *filter; /* NULL = none */
    const void *data;
    uint64_t count, stride; /* of the data */
    uint64_t beyond;        /* INDICES and TRIANGLES: all values are below it */
    uint32_t file_stride;   /* of the view: indices may be shorter there */
    uint32_t target;
} packing;

static const char *word_of(csg_meshopt_mode mode)
{
    return mode == CSG_MESHOPT_ATTRIBUTES  ? "ATTRIBUTES"
           : mode == CSG_MESHOPT_TRIANGLES ? "TRIANGLES"
                                           : "INDICES";
}

/* Those that only KHR_meshopt_compression has take less. */
static bool is_of_version_one(const meshopt *m, const packing *p)
{
    return m->document->khr && p->mode == CSG_MESHOPT_ATTRIBUTES;
}

static uint64_t packed_bytes(const meshopt *m, const packing *p, uint8_t *out, uint64_t room)
{
    if (is_of_version_one(m, p))
        return csg_vertex_stream_encode(p->data, p->count, p->stride, out);
    return csg_meshopt_encode(p->mode, p->data, p->count, p->stride, out, room);
}

/* A view and its piece of the buffer. NONE: out of memory. */
static int pack(meshopt *m, const packing *p)
{
    uint64_t room = is_of_version_one(m, p)
                        ? csg_vertex_stream_bound(p->count, p->stride)
                        : csg_meshopt_bound(p->mode, p->count, p->stride, p->beyond);
    csg_gltf_piece piece = {.owned = csg_memory_alloc(m->memory, room), .owned_bytes = room};
    if (!piece.owned)
        return CSG_GLTF_NONE;
    piece.bytes = piece.owned;
    piece.size_bytes = packed_bytes(m, p, piece.owned, room);
    assert(piece.size_bytes > 0); /* the bound is one */
    csg_gltf_view view = {.offset = m->document->unpacked_bytes,
                          .bytes = p->count * p->file_stride,
                          .stride = p->mode == CSG_MESHOPT_ATTRIBUTES ? p->file_stride : 0,
                          .target = p->target,
                          .mode = word_of(p->mode),
                          .filter = p->filter,
                          .packed_offset = m->pieces->end,
                          .packed_bytes = piece.size_bytes,
                          .packed_count = p->count,
                          .packed_stride = p->file_stride};
    m->document->unpacked_bytes += csg_gltf_padded(view.bytes);
    int number = csg_gltf_add_view(m->document, view);
    return csg_gltf_add_piece(m->pieces, piece) && !m->document->failed ? number : CSG_GLTF_NONE;
}

/* An array of vertices, and its accessor. */
static int pack_vertices(meshopt *m, const void *data, uint32_t stride, const char *filter,
                         csg_gltf_accessor accessor)
{
    packing p = {.mode = CSG_MESHOPT_ATTRIBUTES,
                 .filter = filter,
                 .data = data,
                 .count = m->used,
                 .stride = stride,
                 .file_stride = stride,
                 .target = CSG_GLTF_VERTICES};
    accessor.count = m->used;
    accessor.view = pack(m, &p);
    return accessor.view < 0 ? CSG_GLTF_NONE : csg_gltf_add_accessor(m->document, accessor);
}

/* ---- arrays of vertices ----------------------------------------------------------------------
 */

/* Calls put for each vertex that is kept with its number before and its place in an array of
 * `bytes` a vertex, and packs the array. NONE: out of memory. */
typedef void put_fn(const meshopt *m, uint64_t vertex, void *at);

static int pack_array(meshopt *m, uint32_t bytes, put_fn *put, csg_gltf_accessor accessor)
{
    size_t size = (size_t)m->used * bytes;
    uint8_t *array = csg_memory_alloc(m->memory, size);
    if (!array)
        return CSG_GLTF_NONE;
    memset(array, 0, size);
    for (uint64_t i = 0; i < m->shape->vertex_count; i++)
        if (m->to[i] != NO_VERTEX)
            put(m, m->shape->first_vertex + i, array + (size_t)m->to[i] * bytes);
    int number = pack_vertices(m, array, bytes, NULL, accessor);
    csg_memory_release(m->memory, array, size);
    return number;
}

static uint16_t on_grid(const csg_rounding *grid, float value, int axis)
{
    return (uint16_t)csg_rounding_number(grid, axis, value); /* of 16 bits at most */
}

static void put_position(const meshopt *m, uint64_t vertex, void *at)
{
    uint16_t position[4] = {0};
    for (int k = 0; k < 3; k++)
        position[k] = on_grid(m->grid, m->source->mesh.positions[3 * vertex + (uint64_t)k], k);
    memcpy(at, position, sizeof position);
}

/* As with Draco: 8 bits, where no more are asked for. */
static bool has_wide_colors(const meshopt *m)
{
    return m->document->options->draco_color_bits > 8;
}

static void put_color(const meshopt *m, uint64_t vertex, void *at)
{
    uint16_t color[4];
    uint8_t narrow[4];
    for (uint64_t k = 0; k < 4; k++) {
        uint8_t byte = m->source->mesh.colors[4 * vertex + k];
        color[k] = k < 3 ? m->colors.linear[byte] : m->colors.alpha[byte];
    }
    for (int k = 0; k < 4; k++)
        narrow[k] = (uint8_t)color[k];
    memcpy(at, has_wide_colors(m) ? (const void *)color : narrow, has_wide_colors(m) ? 8 : 4);
}

static void put_mixing(const meshopt *m, uint64_t vertex, void *at)
{
    const uint16_t *from = m->source->mesh.materials + 2 * vertex;
    uint16_t pair[2] = {(uint16_t)csg_gltf_coordinate(from[0]),
                        (uint16_t)csg_gltf_coordinate(from[1])};
    memcpy(at, pair, sizeof pair);
}

static void put_uv(const meshopt *m, uint64_t vertex, void *at)
{
    memcpy(at, m->source->uv + 2 * vertex, 2 * sizeof(float));
}

static int pack_positions(meshopt *m)
{
    csg_gltf_accessor a = {.component = CSG_GLTF_UNSIGNED_SHORT, .type = "VEC3", .has_range = true};
    const csg_gltf_shape *shape = m->shape;
    for (int k = 0; k < 3; k++) {
        a.min[k] = INFINITY;
        a.max[k] = -INFINITY;
    }
    for (uint64_t i = 0; i < shape->vertex_count; i++)
        for (int k = 0; k < 3 && m->to[i] != NO_VERTEX; k++) {
            uint64_t at = 3 * (shape->first_vertex + i) + (uint64_t)k;
            double value = on_grid(m->grid, m->source->mesh.positions[at], k);
            a.min[k] = fmin(a.min[k], value);
            a.max[k] = fmax(a.max[k], value);
        }
    return pack_array(m, 8, put_position, a);
}

/* What the octahedral filter makes of them comes to within half a degree. */
static int pack_normals(meshopt *m)
{
    const float *normals = m->source->mesh.normals + 3 * m->shape->first_vertex;
    size_t wide_bytes = (size_t)m->used * 4 * sizeof(float), bytes = (size_t)m->used * 4;
    float *wide = csg_memory_alloc(m->memory, wide_bytes);
    int8_t *packed = csg_memory_alloc(m->memory, bytes);
    int number = CSG_GLTF_NONE;
    if (wide && packed) {
        for (uint64_t i = 0; i < m->shape->vertex_count; i++) {
            if (m->to[i] == NO_VERTEX)
                continue;
            float *at = wide + 4 * (size_t)m->to[i];
            csg_gltf_unit_normal(normals + 3 * i, at);
            at[3] = 0;
        }
        csg_meshopt_pack_normals(packed, wide, m->used, 8);
        number = pack_vertices(
            m, packed, 4, "OCTAHEDRAL",
            (csg_gltf_accessor){.component = CSG_GLTF_BYTE, .normalized = true, .type = "VEC3"});
    }
    csg_memory_release(m->memory, wide, wide_bytes);
    csg_memory_release(m->memory, packed, bytes);
    return number;
}

/* ---- indices ---------------------------------------------------------------------------------
 */

static int pack_indices(meshopt *m, csg_meshopt_mode mode, const uint32_t *values, uint64_t count,
                        uint32_t bytes, uint32_t target)
{
    uint64_t beyond = 0;
    for (uint64_t i = 0; i < count; i++)
        beyond = values[i] >= beyond ? (uint64_t)values[i] + 1 : beyond;
    packing p = {.mode = mode,
                 .data = values,
                 .count = count,
                 .stride = 4,
                 .beyond = beyond,
                 .file_stride = bytes,
                 .target = target};
    int view = pack(m, &p);
    if (view < 0)
        return CSG_GLTF_NONE;
    return csg_gltf_add_accessor(
        m->document, (csg_gltf_accessor){.view = view,
                                         .component = bytes == 2 ? CSG_GLTF_UNSIGNED_SHORT
                                                                 : CSG_GLTF_UNSIGNED_INT,
                                         .count = count,
                                         .type = "SCALAR"});
}

/* The codec may turn triangles so that another corner comes first: what merges name are places
 * among the indices as they are read. */
static bool read_back(const meshopt *m, const csg_gltf_mesh *mesh, uint32_t *indices)
{
    const csg_gltf_view *view = &m->document->views[m->document->accessors[mesh->indices].view];
    const csg_gltf_piece *piece = &m->pieces->pieces[m->pieces->count - 1];
    csg_meshopt_view packed = {.mode = CSG_MESHOPT_TRIANGLES,
                               .count = view->packed_count,
                               .stride = 4,
                               .bytes = piece->bytes,
                               .size = piece->size_bytes};
    return csg_meshopt_decode(&packed, indices);
}

static bool pack_merges(meshopt *m, csg_gltf_mesh *mesh, uint32_t *places, uint32_t *values,
                        uint32_t *from)
{
    const csg_gltf_shape *shape = m->shape;
    uint64_t count = 0;
    uint32_t bytes = m->used <= UINT16_MAX ? 2 : 4;
    if (!read_back(m, mesh, m->indices))
        return false;
    for (uint32_t i = 0; i < shape->vertex_count; i++)
        if (m->to[i] != NO_VERTEX)
            from[m->to[i]] = i;
    for (uint64_t i = 0; i < shape->index_count; i++) {
        uint32_t old = from[m->indices[i]] + (uint32_t)shape->first_vertex;
        uint32_t first = m->source->merge_to[old] - (uint32_t)shape->first_vertex;
        if (m->to[first] == m->indices[i])
            continue;
        places[count] = (uint32_t)i;
        values[count++] = m->to[first];
    }
    mesh->merge_places = pack_indices(m, CSG_MESHOPT_INDICES, places, count,
                                      (uint32_t)csg_gltf_place_bytes(shape), 0);
    mesh->merge_values = pack_indices(m, CSG_MESHOPT_INDICES, values, count, bytes, 0);
    if (mesh->merge_places < 0 || mesh->merge_values < 0)
        return false;
    csg_gltf_accessor all = m->document->accessors[mesh->indices];
    all.sparse_count = count;
    all.sparse_places = mesh->merge_places;
    all.sparse_values = mesh->merge_values;
    mesh->manifold = csg_gltf_add_accessor(m->document, all);
    return true;
}

/* A vertex that only stands for others is used by no triangle where its own were all left out: then
 * nothing can name it. */
static bool merges_are_used(const meshopt *m)
{
    const csg_gltf_shape *shape = m->shape;
    for (uint64_t i = 0; i < shape->vertex_count; i++)
        if (m->to[i] != NO_VERTEX &&
            m->to[m->source->merge_to[shape->first_vertex + i] - shape->first_vertex] == NO_VERTEX)
            return false;
    return true;
}

static bool add_merges(meshopt *m, csg_gltf_mesh *mesh)
{
    const csg_gltf_shape *shape = m->shape;
    if (!shape->merge_count || !merges_are_used(m))
        return true;
    size_t bytes = (size_t)shape->merge_count * sizeof(uint32_t);
    size_t from_bytes = (size_t)m->used * sizeof(uint32_t);
    uint32_t *places = csg_memory_alloc(m->memory, bytes);
    uint32_t *values = csg_memory_alloc(m->memory, bytes);
    uint32_t *from = csg_memory_alloc(m->memory, from_bytes);
    bool good = places && values && from && pack_merges(m, mesh, places, values, from);
    csg_memory_release(m->memory, places, bytes);
    csg_memory_release(m->memory, values, bytes);
    csg_memory_release(m->memory, from, from_bytes);
    return good;
}

/* ---- shapes ----------------------------------------------------------------------- */

static bool add_arrays(meshopt *m, csg_gltf_mesh *mesh)
{
    const csg_part_look *look = &m->shape->look;
    const csg_gltf_accessor color = {.component = has_wide_colors(m) ? CSG_GLTF_UNSIGNED_SHORT
                                                                     : CSG_GLTF_UNSIGNED_BYTE,
                                     .normalized = true,
                                     .type = "VEC4"};
    const csg_gltf_accessor mixing = {
        .component = CSG_GLTF_UNSIGNED_SHORT, .normalized = true, .type = "VEC2"};
    const csg_gltf_accessor uv = {.component = CSG_GLTF_FLOAT, .type = "VEC2"};
    mesh->indices = pack_indices(m, CSG_MESHOPT_TRIANGLES, m->indices, m->shape->index_count,
                                 m->used <= UINT16_MAX ? 2 : 4, CSG_GLTF_INDICES);
    bool good = mesh->indices >= 0 && add_merges(m, mesh);
    if (good)
        good = (mesh->position = pack_positions(m)) >= 0;
    if (good && m->source->mesh.normals)
        good = (mesh->normal = pack_normals(m)) >= 0;
    if (good && look->each_color)
        good = (mesh->color = pack_array(m, has_wide_colors(m) ? 8 : 4, put_color, color)) >= 0;
    if (good && look->each_material)
        good = (mesh->mixing = pack_array(m, 4, put_mixing, mixing)) >= 0;
    if (good && m->source->uv)
        good = (mesh->uv = pack_array(m, 8, put_uv, uv)) >= 0;
    return good;
}

static csgm_status compress_shape(meshopt *m)
{
    const csg_gltf_shape *shape = m->shape;
    size_t index_bytes = (size_t)shape->index_count * sizeof *m->indices;
    size_t to_bytes = (size_t)shape->vertex_count * sizeof *m->to;
    csgm_status status = CSGM_OK;
    m->indices = csg_memory_alloc(m->memory, index_bytes);
    m->to = csg_memory_alloc(m->memory, to_bytes);
    bool good = m->indices && m->to;
    if (good) {
        for (uint64_t i = 0; i < shape->index_count; i++)
            m->indices[i] =
                m->source->mesh.indices[shape->first_index + i] - (uint32_t)shape->first_vertex;
        m->used = csg_meshopt_order(m->indices, shape->index_count, shape->vertex_count, m->to);
        csg_gltf_mesh mesh = csg_gltf_new_mesh(m->document, shape);
        good = add_arrays(m, &mesh);
        csg_gltf_add_mesh(m->document, mesh);
    }
    if (!good || m->document->failed)
        status = no_memory(m);
    csg_memory_release(m->memory, m->indices, index_bytes);
    csg_memory_release(m->memory, m->to, to_bytes);
    return status;
}

/* Nodes scale the whole numbers back. */
static csgm_status add_nodes(meshopt *m)
{
    size_t count = m->source->shape_count;
    double *scales = csg_memory_alloc(m->memory, count * sizeof *scales);
    csgm_vec3 *shifts = csg_memory_alloc(m->memory, count * sizeof *shifts);
    const csg_rounding *grid = m->grid;
    bool good = scales && shifts;
    for (size_t i = 0; good && i < count; i++) {
        scales[i] = grid->range > 0 ? (double)grid->range / (double)grid->most : 1;
        shifts[i] = (csgm_vec3){(double)grid->low[0], (double)grid->low[1], (double)grid->low[2]};
    }
    if (good)
        csg_gltf_add_nodes(m->document, m->source, scales, shifts);
    csg_memory_release(m->memory, scales, count * sizeof *scales);
    csg_memory_release(m->memory, shifts, count * sizeof *shifts);
    return good && !m->document->failed ? CSGM_OK : no_memory(m);
}

static csgm_status compress_all(meshopt *m)
{
    csgm_status status = CSGM_OK;
    m->document->meshopt = m->document->quantized = true;
    m->document->khr = m->document->options->meshopt_khr;
    for (size_t i = 0; i < m->source->shape_count && !status; i++) {
        m->shape = &m->source->shapes[i];
        status = compress_shape(m);
    }
    m->document->buffer_bytes = m->pieces->end;
    if (csg_gltf_is_mixed(m->source)) {
        m->document->image_view = csg_gltf_add_view(
            m->document, (csg_gltf_view){.offset = m->pieces->end, .bytes = CSG_GLTF_MIXING_BYTES});
        m->document->buffer_bytes += CSG_GLTF_MIXING_BYTES;
    }
    return status ? status : add_nodes(m);
}

/* One grid for all shapes, so that faces that met still meet. */
csgm_status csg_gltf_compress_meshopt(csg_sink *sink, csg_gltf_document *document,
                                      const csg_gltf_source *source, csg_gltf_pieces *pieces)
{
    const csgm_write_options *options = document->options;
    csgm_mesh_view local = source->mesh;
    local.origin = (csgm_vec3){0, 0, 0}; /* it is where the nodes are */
    csg_rounding grid = csg_rounding_of_draco(&local, options->draco_position_bits, false);
    csg_rounded rounded;
    csgm_status status =
        csg_round_mesh(sink->context, &local, &grid, sink->name, "quantised glTF", &rounded);
    if (status)
        return status;
    csg_gltf_source moved = *source; /* to grid points */
    moved.mesh = rounded.mesh;
    meshopt m = {
        .sink = sink,
        .memory = &sink->context->memory,
        .document = document,
        .source = &moved,
        .pieces = pieces,
        .grid = &grid,
        .colors = csg_color_table_make(options->draco_color_bits, options->draco_color_bits > 8)};
    status = compress_all(&m);
    csg_rounded_release(sink->context, &rounded);
    return status;
}
