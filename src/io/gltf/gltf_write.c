/* SPDX-License-Identifier: MIT
 * Mesh -> glTF 2.0, as GLB or as JSON with the buffer in base64; optionally compressed with Draco.
 * The buffer is streamed part by part: positions, normals, colours, indices. glTF is Y up and in
 * metres: one node matrix turns, scales and adds the origin, the floats stay those of the mesh.
 * Colours become linear in 16 bits, since 8 linear bits cannot hold 8 bits of sRGB. Normals
 * that are not of unit length (critical points of the field) are made so: the format demands it.
 * Does not handle: buffers of 4 GiB and more (GLB's own limit).
 */
#include <math.h>

#include "io/color.h"
#include "io/gltf/gltf_layout.h"

/* ---- layout ------------------------------------------------------------------------------------
 */

static double metres(csgm_unit unit)
{
    switch (unit) {
    case CSGM_UNIT_MM:
        return 0.001;
    case CSGM_UNIT_CM:
        return 0.01;
    case CSGM_UNIT_IN:
        return 0.0254;
    case CSGM_UNIT_NONE:
    case CSGM_UNIT_M:
        break;
    }
    return 1;
}

void csg_gltf_place(csg_gltf_layout *layout, const csgm_vec3 *origin,
                    const csgm_write_options *options)
{
    double s = metres(options->unit), *m = layout->matrix;
    layout->comment = options->comment;
    memset(m, 0, sizeof layout->matrix);
    m[0] = s;
    m[12] = s * origin->x;
    m[15] = 1;
    if (options->y_up) {
        m[6] = -s;
        m[9] = s;
        m[13] = s * origin->z;
        m[14] = -s * origin->y;
    } else {
        m[5] = m[10] = s;
        m[13] = s * origin->y;
        m[14] = s * origin->z;
    }
}

static void position_range(csg_gltf_part *part, const csgm_mesh_view *mesh)
{
    for (int k = 0; k < 3; k++) {
        part->min[k] = INFINITY;
        part->max[k] = -INFINITY;
    }
    const float *p = mesh->positions + 3 * part->first_vertex;
    for (uint64_t i = 0; i < part->vertex_count; i++, p += 3)
        for (int k = 0; k < 3; k++) {
            part->min[k] = p[k] < part->min[k] ? p[k] : part->min[k];
            part->max[k] = p[k] > part->max[k] ? p[k] : part->max[k];
        }
}

static bool all_opaque(const csg_gltf_part *part, const csgm_mesh_view *mesh)
{
    bool opaque = true;
    uint64_t end = part->first_vertex + part->vertex_count;
    for (uint64_t i = part->first_vertex; mesh->colors && i < end; i++)
        opaque &= mesh->colors[4 * i + 3] == 255;
    return opaque;
}

csg_gltf_layout csg_gltf_measure(const csgm_mesh_view *mesh)
{
    csg_gltf_layout layout = {.vertex_count = mesh->vertex_count,
                              .index_count = 3 * mesh->triangle_count,
                              .normals = mesh->normals,
                              .colors = mesh->colors,
                              .wide_colors = true,
                              .part_count = 1};
    layout.only = (csg_gltf_part){.vertex_count = layout.vertex_count,
                                  .index_count = layout.index_count,
                                  .material = {CSG_MATERIAL_METALLIC, CSG_MATERIAL_ROUGHNESS}};
    /* 65535 itself would be the primitive restart value */
    layout.short_indices = mesh->vertex_count <= UINT16_MAX;
    layout.position_bytes = 12 * mesh->vertex_count;
    layout.normal_bytes = mesh->normals ? 12 * mesh->vertex_count : 0;
    layout.color_bytes = mesh->colors ? 8 * mesh->vertex_count : 0;
    layout.index_bytes = layout.index_count * (layout.short_indices ? 2 : 4);
    layout.buffer_bytes = layout.position_bytes + layout.normal_bytes + layout.color_bytes +
                          ((layout.index_bytes + 3) & ~(uint64_t)3);
    return layout;
}

/* Where metallic and roughness change over a part, they are the coordinates of a vertex in this
 * texture of 2 x 2 pixels: green is roughness, from 0 above to 1 below, and blue is metallic, from
 * 0 at the left to 1 at the right, so that what the viewer interpolates between their centres is
 * the mixture itself. A PNG, padded to four bytes. */
static const uint8_t mixing_texture[] = {
    0x89, 0x50, 0x4E, 0x47, 0x0D, 0x0A, 0x1A, 0x0A, 0x00, 0x00, 0x00, 0x0D, 0x49, 0x48, 0x44,
    0x52, 0x00, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00, 0x02, 0x08, 0x02, 0x00, 0x00, 0x00, 0xFD,
    0xD4, 0x9A, 0x73, 0x00, 0x00, 0x00, 0x0F, 0x49, 0x44, 0x41, 0x54, 0x78, 0xDA, 0x63, 0x60,
    0x00, 0x81, 0xFF, 0x10, 0xF4, 0x1F, 0x00, 0x0F, 0xFE, 0x03, 0xFD, 0x4B, 0x85, 0x65, 0xCA,
    0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4E, 0x44, 0xAE, 0x42, 0x60, 0x82};

/* Parts of one look share a material. */
static void number_materials(csg_gltf_part *parts, uint64_t count)
{
    uint32_t next = 0;
    for (uint64_t i = 0; i < count; i++) {
        csg_gltf_part *p = &parts[i];
        p->material_index = next;
        for (uint64_t k = 0; k < i && p->material_index == next; k++)
            if (parts[k].opaque == p->opaque && parts[k].textured == p->textured &&
                (p->textured || memcmp(parts[k].material, p->material, sizeof p->material) == 0))
                p->material_index = parts[k].material_index;
        next += p->material_index == next;
    }
}

static void measure_part(csg_gltf_layout *layout, csg_gltf_part *out, const csgm_mesh_view *mesh,
                         uint64_t index)
{
    csg_part_stretch part = csg_part_get(mesh, index);
    *out = (csg_gltf_part){.name = part.name,
                           .first_vertex = part.first_vertex,
                           .vertex_count = part.vertex_count,
                           .first_index = 3 * part.first_triangle,
                           .index_count = 3 * part.triangle_count};
    position_range(out, mesh);
    out->opaque = all_opaque(out, mesh);
    out->textured = !csg_part_has_one_material(mesh, &part, out->material);
    layout->textured |= out->textured;
}

/* All of the layout; parts has room for all, those without triangles are left out. */
static csg_gltf_layout measure_parts(csg_gltf_part *parts, const csgm_mesh_view *mesh)
{
    csg_gltf_layout layout = csg_gltf_measure(mesh);
    layout.parts = parts;
    layout.part_count = 0;
    for (uint64_t i = 0; i < csg_part_count(mesh); i++)
        if (!mesh->part_count || mesh->parts[i].triangle_count)
            measure_part(&layout, &parts[layout.part_count++], mesh, i);
    number_materials(parts, layout.part_count);
    if (layout.textured) {
        layout.coordinate_bytes = 4 * mesh->vertex_count;
        layout.image_bytes = sizeof mixing_texture;
        layout.buffer_bytes += layout.coordinate_bytes + layout.image_bytes;
    }
    return layout;
}

/* ---- the buffer's bytes, plain or as base64 -----------------------------------------------------
 */

typedef struct body {
    csg_sink *sink;
    bool base64;
    uint32_t carry; /* bytes waiting for a group of three */
    int carried;
} body;

static void put_group(body *b, int bytes)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    uint32_t group = b->carry << (8 * (3 - bytes));
    uint8_t *at = csg_sink_room(b->sink, 4);
    for (int i = 0; i < 4; i++)
        *at++ = i <= bytes ? (uint8_t)digits[group >> (18 - 6 * i) & 63] : (uint8_t)'=';
    csg_sink_took(b->sink, at);
    b->carry = 0;
    b->carried = 0;
}

static void body_put(body *b, const void *bytes, size_t count)
{
    if (!b->base64) {
        csg_sink_put(b->sink, bytes, count);
        return;
    }
    const uint8_t *byte = bytes;
    for (size_t i = 0; i < count; i++) {
        b->carry = b->carry << 8 | byte[i];
        if (++b->carried == 3)
            put_group(b, 3);
    }
}

static void body_end(body *b)
{
    if (b->carried)
        put_group(b, b->carried);
}

enum { CHUNK = 8192 };

static void put_positions(body *b, const csgm_mesh_view *mesh)
{
    uint8_t chunk[CHUNK + 12], *at = chunk;
    for (uint64_t i = 0; i < mesh->vertex_count; i++) {
        for (uint64_t k = 0; k < 3; k++)
            at = csg_store_f32(at, mesh->positions[3 * i + k]);
        if (at >= chunk + CHUNK) {
            body_put(b, chunk, (size_t)(at - chunk));
            at = chunk;
        }
    }
    body_put(b, chunk, (size_t)(at - chunk));
}

static uint8_t *store_normal(uint8_t *at, const float *n)
{
    float square = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
    float scale = 1;
    if (!(fabsf(square - 1) < 1e-4f)) { /* the format's validator allows 0.7 % of length */
        scale = square > 0 && isfinite(square) ? 1 / sqrtf(square) : 0;
        if (scale == 0 || !isfinite(scale))
            return csg_store_f32(csg_store_f32(csg_store_f32(at, 0), 0), 1);
    }
    for (int k = 0; k < 3; k++)
        at = csg_store_f32(at, n[k] * scale);
    return at;
}

static void put_normals(body *b, const csgm_mesh_view *mesh)
{
    uint8_t chunk[CHUNK + 12], *at = chunk;
    for (uint64_t i = 0; mesh->normals && i < mesh->vertex_count; i++) {
        at = store_normal(at, mesh->normals + 3 * i);
        if (at >= chunk + CHUNK) {
            body_put(b, chunk, (size_t)(at - chunk));
            at = chunk;
        }
    }
    body_put(b, chunk, (size_t)(at - chunk));
}

static void put_colors(body *b, const csgm_mesh_view *mesh)
{
    csg_color_table table = csg_color_table_make(16, true);
    uint8_t chunk[CHUNK + 8], *at = chunk;
    for (uint64_t i = 0; mesh->colors && i < mesh->vertex_count; i++) {
        const uint8_t *color = mesh->colors + 4 * i;
        for (int k = 0; k < 3; k++)
            at = csg_store_u16(at, table.linear[color[k]]);
        at = csg_store_u16(at, table.alpha[color[3]]);
        if (at >= chunk + CHUNK) {
            body_put(b, chunk, (size_t)(at - chunk));
            at = chunk;
        }
    }
    body_put(b, chunk, (size_t)(at - chunk));
}

static void put_coordinates(body *b, const csgm_mesh_view *mesh)
{
    uint8_t chunk[CHUNK + 4], *at = chunk;
    for (uint64_t i = 0; i < 2 * mesh->vertex_count; i++) {
        at = csg_store_u16(at, csg_gltf_coordinate(mesh->materials[i]));
        if (at >= chunk + CHUNK) {
            body_put(b, chunk, (size_t)(at - chunk));
            at = chunk;
        }
    }
    body_put(b, chunk, (size_t)(at - chunk));
}

static void put_indices(body *b, const csgm_mesh_view *mesh, const csg_gltf_part *part, bool narrow)
{
    const uint32_t *indices = mesh->indices + part->first_index;
    uint32_t first = (uint32_t)part->first_vertex;
    uint8_t chunk[CHUNK + 4], *at = chunk;
    for (uint64_t i = 0; i < part->index_count; i++) {
        at = narrow ? csg_store_u16(at, indices[i] - first) : csg_store_u32(at, indices[i] - first);
        if (at >= chunk + CHUNK) {
            body_put(b, chunk, (size_t)(at - chunk));
            at = chunk;
        }
    }
    body_put(b, chunk, (size_t)(at - chunk));
}

static void put_plain_body(body *b, const csg_gltf_layout *layout, const csgm_mesh_view *mesh)
{
    static const uint8_t zeros[4];
    put_positions(b, mesh);
    put_normals(b, mesh);
    put_colors(b, mesh);
    if (layout->textured)
        put_coordinates(b, mesh);
    for (uint64_t i = 0; i < layout->part_count; i++)
        put_indices(b, mesh, csg_gltf_part_at(layout, i), layout->short_indices);
    body_put(b, zeros, (size_t)(-layout->index_bytes & 3));
}

static void put_compressed_body(body *b, const csg_gltf_layout *layout)
{
    static const uint8_t zeros[4];
    for (uint64_t i = 0; i < layout->part_count; i++) {
        const csg_draco_encoded *encoded = &csg_gltf_part_at(layout, i)->draco;
        body_put(b, encoded->bytes, encoded->size_bytes);
        body_put(b, zeros, -encoded->size_bytes & 3);
    }
}

static void put_body(csg_sink *sink, const csg_gltf_layout *layout, const csgm_mesh_view *mesh,
                     bool base64)
{
    body b = {.sink = sink, .base64 = base64};
    if (layout->compressed)
        put_compressed_body(&b, layout);
    else
        put_plain_body(&b, layout, mesh);
    body_put(&b, mixing_texture, layout->image_bytes);
    body_end(&b);
}

/* ---- containers ------------------------------------------------------------------- */

uint64_t csg_glb_bytes(const csg_gltf_layout *layout, size_t json_bytes)
{
    return 12 + 8 + json_bytes + (layout->buffer_bytes ? 8 + layout->buffer_bytes : 0);
}

void csg_glb_json(const csg_gltf_layout *layout, csg_gltf_text *text)
{
    csg_gltf_json(layout, false, text);
    size_t wanted = layout->index_count && !layout->compressed ? (size_t)CSG_GLB_JSON_BYTES : 0;
    wanted = wanted > text->length ? wanted : (text->length + 3) & ~(size_t)3;
    if (text->memory && !text->failed)
        text->failed =
            !csg_memory_reserve(text->memory, (void **)&text->text, &text->capacity, wanted, 1);
    while (!text->failed && text->length < wanted)
        text->text[text->length++] = ' ';
}

uint8_t *csg_glb_put_head(uint8_t *at, const csg_gltf_layout *layout, size_t json_bytes)
{
    memcpy(at, "glTF", 4);
    at = csg_store_u32(at + 4, 2);
    at = csg_store_u32(at, (uint32_t)csg_glb_bytes(layout, json_bytes));
    at = csg_store_u32(at, (uint32_t)json_bytes);
    memcpy(at, "JSON", 4);
    return at + 4;
}

uint8_t *csg_glb_put_body_head(uint8_t *at, const csg_gltf_layout *layout)
{
    if (!layout->buffer_bytes)
        return at;
    at = csg_store_u32(at, (uint32_t)layout->buffer_bytes);
    memcpy(at, "BIN", 4);
    return at + 4;
}

static csgm_status put_glb(csg_sink *sink, const csg_gltf_layout *layout,
                           const csgm_mesh_view *mesh, csg_gltf_text *json)
{
    csg_glb_json(layout, json);
    if (json->failed)
        return csg_context_no_memory(sink->context);
    uint64_t total = csg_glb_bytes(layout, json->length);
    if (total > CSG_GLB_MOST)
        return csg_write_refuse(sink, "write PLY instead, which has no such limit",
                                "GLB files end at 4 GiB, this one would have %llu bytes",
                                (unsigned long long)total);
    uint8_t head[CSG_GLB_HEAD_MOST];
    csg_sink_put(sink, head, (size_t)(csg_glb_put_head(head, layout, json->length) - head));
    csg_sink_put(sink, json->text, json->length);
    csg_sink_put(sink, head, (size_t)(csg_glb_put_body_head(head, layout) - head));
    if (layout->buffer_bytes)
        put_body(sink, layout, mesh, false);
    return CSGM_OK;
}

static csgm_status put_gltf(csg_sink *sink, const csg_gltf_layout *layout,
                            const csgm_mesh_view *mesh, csg_gltf_text *json)
{
    if (layout->buffer_bytes > CSG_GLB_MOST)
        return csg_write_refuse(sink, "write PLY instead, which has no such limit",
                                "glTF buffers end at 4 GiB, this one would have %llu bytes",
                                (unsigned long long)layout->buffer_bytes);
    csg_gltf_json(layout, true, json);
    if (json->failed)
        return csg_context_no_memory(sink->context);
    csg_sink_put(sink, json->text, json->length);
    if (layout->index_count) {
        put_body(sink, layout, mesh, true);
        csg_sink_text(sink, csg_gltf_json_tail);
    }
    csg_sink_text(sink, "\n");
    return CSGM_OK;
}

/* ---- documents -------------------------------------------------------------------- */

typedef csgm_status container_fn(csg_sink *sink, const csg_gltf_layout *layout,
                                 const csgm_mesh_view *mesh, csg_gltf_text *json);

static csgm_status write_parts(csg_sink *sink, csg_gltf_part *parts, const csgm_mesh_view *mesh,
                               const csgm_write_options *options, container_fn *container,
                               csg_gltf_text *json)
{
    csgm_status status = CSGM_OK;
    csg_gltf_layout layout = measure_parts(parts, mesh);
    csg_gltf_place(&layout, &mesh->origin, options);
    if (options->draco)
        status = csg_gltf_compress(sink, &layout, parts, mesh, options);
    if (!status)
        status = container(sink, &layout, mesh, json);
    for (uint64_t i = 0; i < layout.part_count; i++)
        csg_draco_release(&parts[i].draco);
    return status;
}

static csgm_status write_document(csg_sink *sink, const csgm_mesh_view *mesh,
                                  const csgm_write_options *options, container_fn *container)
{
    csg_memory *memory = &sink->context->memory;
    csg_gltf_text json = {.memory = memory};
    csgm_status status;
    if (!mesh->triangle_count) { /* a buffer must not be empty, nor a mesh */
        csg_gltf_layout nothing = {0};
        status = container(sink, &nothing, mesh, &json);
    } else {
        size_t bytes = (size_t)csg_part_count(mesh) * sizeof(csg_gltf_part);
        csg_gltf_part *parts = csg_memory_alloc(memory, bytes);
        status = parts ? write_parts(sink, parts, mesh, options, container, &json)
                       : csg_context_no_memory(sink->context);
        csg_memory_release(memory, parts, bytes);
    }
    csg_memory_release(memory, json.text, json.capacity);
    return status;
}

csgm_status csg_glb_write(csg_sink *sink, const csgm_mesh_view *mesh,
                          const csgm_write_options *options)
{
    return write_document(sink, mesh, options, put_glb);
}

csgm_status csg_gltf_write(csg_sink *sink, const csgm_mesh_view *mesh,
                           const csgm_write_options *options)
{
    return write_document(sink, mesh, options, put_gltf);
}
