/* SPDX-License-Identifier: MIT
 * Mesh -> glTF 2.0, as GLB or as JSON with the buffer in base64; optionally compressed. The buffer
 * is streamed section by section (gltf_plan.h says in which order). Colours become linear in 16
 * bits, since 8 linear bits cannot hold 8 bits of sRGB. Normals that are not of unit length
 * (critical points of the field) are made so: the format demands it. Does not handle: buffers of 4
 * GiB and more (GLB's own limit).
 */
#include <math.h>

#include "io/color.h"
#include "io/gltf/gltf_compress.h"
#include "io/gltf/gltf_source.h"

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

static void put_chunk(body *b, const uint8_t *chunk, const uint8_t *end)
{
    if (end > chunk)
        body_put(b, chunk, (size_t)(end - chunk));
}

static void put_positions(body *b, const csgm_mesh_view *mesh)
{
    uint8_t chunk[CHUNK + 12], *at = chunk;
    for (uint64_t i = 0; i < mesh->vertex_count; i++) {
        for (uint64_t k = 0; k < 3; k++)
            at = csg_store_f32(at, mesh->positions[3 * i + k]);
        if (at >= chunk + CHUNK) {
            put_chunk(b, chunk, at);
            at = chunk;
        }
    }
    put_chunk(b, chunk, at);
}

static void put_normals(body *b, const csgm_mesh_view *mesh)
{
    uint8_t chunk[CHUNK + 12], *at = chunk;
    for (uint64_t i = 0; mesh->normals && i < mesh->vertex_count; i++) {
        float normal[3];
        csg_gltf_unit_normal(mesh->normals + 3 * i, normal);
        for (int k = 0; k < 3; k++)
            at = csg_store_f32(at, normal[k]);
        if (at >= chunk + CHUNK) {
            put_chunk(b, chunk, at);
            at = chunk;
        }
    }
    put_chunk(b, chunk, at);
}

static void put_colors(body *b, const csgm_mesh_view *mesh, const csg_gltf_shape *shape)
{
    csg_color_table table = csg_color_table_make(16, true);
    uint8_t chunk[CHUNK + 8], *at = chunk;
    uint64_t count = shape->vertex_count;
    if (!shape->look.each_color)
        return;
    for (uint64_t i = 0; i < count; i++) {
        const uint8_t *color = mesh->colors + 4 * (shape->first_vertex + i);
        for (int k = 0; k < 3; k++)
            at = csg_store_u16(at, table.linear[color[k]]);
        at = csg_store_u16(at, table.alpha[color[3]]);
        if (at >= chunk + CHUNK) {
            put_chunk(b, chunk, at);
            at = chunk;
        }
    }
    put_chunk(b, chunk, at);
}

static void put_mixing(body *b, const csgm_mesh_view *mesh, const csg_gltf_shape *shape)
{
    uint8_t chunk[CHUNK + 4], *at = chunk;
    uint64_t count = 2 * shape->vertex_count;
    if (!shape->look.each_material)
        return;
    for (uint64_t i = 0; i < count; i++) {
        at = csg_store_u16(at, csg_gltf_coordinate(mesh->materials[2 * shape->first_vertex + i]));
        if (at >= chunk + CHUNK) {
            put_chunk(b, chunk, at);
            at = chunk;
        }
    }
    put_chunk(b, chunk, at);
}

static void put_uv(body *b, const csg_gltf_source *source)
{
    uint8_t number[4];
    for (uint64_t i = 0; source->uv && i < 2 * source->mesh.vertex_count; i++) {
        csg_store_f32(number, source->uv[i]);
        body_put(b, number, sizeof number);
    }
}

static void put_padding(body *b, uint64_t bytes)
{
    static const uint8_t zeros[4];
    body_put(b, zeros, -bytes & 3);
}

static void put_number(body *b, uint64_t value, uint64_t bytes)
{
    uint8_t number[4];
    if (bytes == 2)
        csg_store_u16(number, (uint32_t)value);
    else
        csg_store_u32(number, (uint32_t)value);
    body_put(b, number, bytes);
}

static void put_indices(body *b, const csgm_mesh_view *mesh, const csg_gltf_shape *shape)
{
    const uint32_t *indices = mesh->indices + shape->first_index;
    uint32_t first = (uint32_t)shape->first_vertex;
    bool narrow = csg_gltf_is_short(shape);
    uint8_t chunk[CHUNK + 4], *at = chunk;
    for (uint64_t i = 0; i < shape->index_count; i++) {
        at = narrow ? csg_store_u16(at, indices[i] - first) : csg_store_u32(at, indices[i] - first);
        if (at >= chunk + CHUNK) {
            put_chunk(b, chunk, at);
            at = chunk;
        }
    }
    put_chunk(b, chunk, at);
    put_padding(b, shape->index_count * (narrow ? 2 : 4));
}

/* First where the indices are that are merged, then what they become. */
static void put_merges(body *b, const csg_gltf_source *source, const csg_gltf_shape *shape)
{
    const uint32_t *indices = source->mesh.indices + shape->first_index;
    const uint32_t *to = source->merge_to;
    uint64_t place = csg_gltf_place_bytes(shape), value = csg_gltf_is_short(shape) ? 2 : 4;
    uint64_t count = shape->merge_count ? shape->index_count : 0;
    for (uint64_t i = 0; i < count; i++)
        if (to[indices[i]] != indices[i])
            put_number(b, i, place);
    put_padding(b, shape->merge_count * place);
    for (uint64_t i = 0; i < count; i++)
        if (to[indices[i]] != indices[i])
            put_number(b, to[indices[i]] - shape->first_vertex, value);
    put_padding(b, shape->merge_count * value);
}

static void put_plain_body(body *b, const csg_gltf_source *source)
{
    const csgm_mesh_view *mesh = &source->mesh;
    const csg_gltf_shape *shapes = source->shapes;
    size_t count = source->shape_count;
    put_positions(b, mesh);
    put_normals(b, mesh);
    for (size_t i = 0; i < count; i++)
        put_indices(b, mesh, &shapes[i]);
    for (size_t i = 0; i < count; i++)
        put_merges(b, source, &shapes[i]);
    for (size_t i = 0; i < count; i++)
        put_colors(b, mesh, &shapes[i]);
    for (size_t i = 0; i < count; i++)
        put_mixing(b, mesh, &shapes[i]);
    put_uv(b, source);
}

/* What is written: a document, and either the pieces of a compressed buffer or the source. */
typedef struct writing {
    csg_gltf_document document;
    csg_gltf_source source;
    csg_gltf_pieces pieces;
    csg_gltf_text json;
} writing;

static void put_body(csg_sink *sink, const writing *w, bool base64)
{
    body b = {.sink = sink, .base64 = base64};
    for (size_t i = 0; i < w->pieces.count; i++) {
        body_put(&b, w->pieces.pieces[i].bytes, w->pieces.pieces[i].size_bytes);
        put_padding(&b, w->pieces.pieces[i].size_bytes);
    }
    if (!w->pieces.count)
        put_plain_body(&b, &w->source);
    if (w->document.image_view >= 0)
        body_put(&b, csg_gltf_mixing_texture, CSG_GLTF_MIXING_BYTES);
    body_end(&b);
}

/* ---- containers ------------------------------------------------------------------- */

uint64_t csg_glb_bytes(const csg_gltf_document *document, size_t json_bytes)
{
    return 12 + 8 + json_bytes + (document->buffer_bytes ? 8 + document->buffer_bytes : 0);
}

void csg_glb_json(const csg_gltf_document *document, csg_gltf_text *text)
{
    csg_gltf_json(document, false, text);
    bool plain = document->buffer_bytes && !document->draco && !document->meshopt;
    size_t wanted = plain ? (size_t)CSG_GLB_JSON_BYTES : 0;
    wanted = wanted > text->length ? wanted : (text->length + 3) & ~(size_t)3;
    if (text->memory && !text->failed)
        text->failed =
            !csg_memory_reserve(text->memory, (void **)&text->text, &text->capacity, wanted, 1);
    while (!text->failed && text->length < wanted)
        text->text[text->length++] = ' ';
}

uint8_t *csg_glb_put_head(uint8_t *at, const csg_gltf_document *document, size_t json_bytes)
{
    memcpy(at, "glTF", 4);
    at = csg_store_u32(at + 4, 2);
    at = csg_store_u32(at, (uint32_t)csg_glb_bytes(document, json_bytes));
    at = csg_store_u32(at, (uint32_t)json_bytes);
    memcpy(at, "JSON", 4);
    return at + 4;
}

uint8_t *csg_glb_put_body_head(uint8_t *at, const csg_gltf_document *document)
{
    if (!document->buffer_bytes)
        return at;
    at = csg_store_u32(at, (uint32_t)document->buffer_bytes);
    memcpy(at, "BIN", 4);
    return at + 4;
}

static csgm_status put_glb(csg_sink *sink, writing *w)
{
    csg_gltf_document *document = &w->document;
    csg_glb_json(document, &w->json);
    if (w->json.failed)
        return csg_context_no_memory(sink->context);
    uint64_t total = csg_glb_bytes(document, w->json.length);
    if (total > CSG_GLB_MOST)
        return csg_write_refuse(sink, "write PLY instead, which has no such limit",
                                "GLB files end at 4 GiB, this one would have %llu bytes",
                                (unsigned long long)total);
    uint8_t head[CSG_GLB_HEAD_MOST];
    csg_sink_put(sink, head, (size_t)(csg_glb_put_head(head, document, w->json.length) - head));
    csg_sink_put(sink, w->json.text, w->json.length);
    csg_sink_put(sink, head, (size_t)(csg_glb_put_body_head(head, document) - head));
    if (document->buffer_bytes)
        put_body(sink, w, false);
    return CSGM_OK;
}

static csgm_status put_gltf(csg_sink *sink, writing *w)
{
    csg_gltf_document *document = &w->document;
    if (document->buffer_bytes > CSG_GLB_MOST)
        return csg_write_refuse(sink, "write PLY instead, which has no such limit",
                                "glTF buffers end at 4 GiB, this one would have %llu bytes",
                                (unsigned long long)document->buffer_bytes);
    csg_gltf_json(document, true, &w->json);
    if (w->json.failed)
        return csg_context_no_memory(sink->context);
    csg_sink_put(sink, w->json.text, w->json.length);
    if (document->buffer_bytes) {
        put_body(sink, w, true);
        csg_sink_text(sink, "\"");
        w->json.length = 0;
        csg_gltf_json_tail(document, &w->json);
        csg_sink_put(sink, w->json.text, w->json.length);
    }
    csg_sink_text(sink, "\n");
    return CSGM_OK;
}

/* ---- documents -------------------------------------------------------------------- */

typedef csgm_status container_fn(csg_sink *sink, writing *w);

static csgm_status fill_document(csg_sink *sink, writing *w)
{
    w->document.has_uv = w->source.uv;
    csg_gltf_sections sections = csg_gltf_place_sections(&w->source);
    csgm_status status = CSGM_OK;
    if (w->document.options->draco)
        status = csg_gltf_compress_draco(sink, &w->document, &w->source, &w->pieces);
    else if (w->document.options->meshopt)
        status = csg_gltf_compress_meshopt(sink, &w->document, &w->source, &w->pieces);
    else
        csg_gltf_plan(&w->document, &w->source, &sections);
    return !status && w->document.failed ? csg_context_no_memory(sink->context) : status;
}

static csgm_status write_document(csg_sink *sink, const csgm_mesh_view *mesh,
                                  const csgm_write_options *options, container_fn *container)
{
    csg_memory *memory = &sink->context->memory;
    writing w = {.json = {.memory = memory}, .pieces = {.memory = memory}};
    csgm_status status = CSGM_OK;
    csg_gltf_document_init(&w.document, memory, options);
    if (mesh->triangle_count) { /* a buffer must not be empty, nor a mesh */
        status = csg_gltf_source_make(sink->context, mesh, options, &w.source);
        if (!status)
            status = fill_document(sink, &w);
    }
    if (!status)
        status = container(sink, &w);
    csg_memory_release(memory, w.json.text, w.json.capacity);
    csg_gltf_pieces_release(&w.pieces);
    csg_gltf_source_release(&w.source);
    csg_gltf_document_release(&w.document);
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
