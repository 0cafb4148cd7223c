/* SPDX-License-Identifier: MIT
 * Mesh -> glTF 2.0, as GLB or as JSON with the buffer in base64; optionally compressed with Draco.
 * The buffer is streamed part by part: positions, normals, colours, indices. glTF is Y up and in
 * metres: one node matrix turns, scales and adds the origin, the floats stay those of the mesh.
 * Colours become linear in 16 bits, since 8 linear bits cannot hold 8 bits of sRGB. Normals
 * that are not of unit length (critical points of the field) are made so: the format demands it.
 * Does not handle: buffers of 4 GiB and more (GLB's own limit), several meshes.
 */
#include <math.h>

#include "io/color.h"
#include "io/gltf_layout.h"

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

static void position_range(csg_gltf_layout *layout, const csgm_mesh_view *mesh)
{
    for (int k = 0; k < 3; k++) {
        layout->min[k] = INFINITY;
        layout->max[k] = -INFINITY;
    }
    for (uint64_t i = 0; i < mesh->vertex_count; i++)
        for (uint64_t k = 0; k < 3; k++) {
            float p = mesh->positions[3 * i + k];
            layout->min[k] = p < layout->min[k] ? p : layout->min[k];
            layout->max[k] = p > layout->max[k] ? p : layout->max[k];
        }
}

static bool all_opaque(const csgm_mesh_view *mesh)
{
    bool opaque = true;
    for (uint64_t i = 0; mesh->colors && i < mesh->vertex_count; i++)
        opaque &= mesh->colors[4 * i + 3] == 255;
    return opaque;
}

csg_gltf_layout csg_gltf_measure(const csgm_mesh_view *mesh)
{
    csg_gltf_layout layout = {.vertex_count = mesh->vertex_count,
                              .index_count = 3 * mesh->triangle_count,
                              .normals = mesh->normals,
                              .colors = mesh->colors,
                              .wide_colors = true};
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

static void put_indices(body *b, const csgm_mesh_view *mesh, bool narrow)
{
    uint8_t chunk[CHUNK + 4], *at = chunk;
    for (uint64_t i = 0; i < 3 * mesh->triangle_count; i++) {
        at = narrow ? csg_store_u16(at, mesh->indices[i]) : csg_store_u32(at, mesh->indices[i]);
        if (at >= chunk + CHUNK) {
            body_put(b, chunk, (size_t)(at - chunk));
            at = chunk;
        }
    }
    if (narrow && mesh->triangle_count % 2)
        at = csg_store_u16(at, 0);
    body_put(b, chunk, (size_t)(at - chunk));
}

static void put_body(csg_sink *sink, const csg_gltf_layout *layout, const csgm_mesh_view *mesh,
                     bool base64)
{
    static const uint8_t zeros[4];
    body b = {.sink = sink, .base64 = base64};
    if (layout->draco) {
        body_put(&b, layout->draco->bytes, layout->draco->size_bytes);
        body_put(&b, zeros, layout->buffer_bytes - layout->draco->size_bytes);
    } else {
        put_positions(&b, mesh);
        put_normals(&b, mesh);
        put_colors(&b, mesh);
        put_indices(&b, mesh, layout->short_indices);
    }
    body_end(&b);
}

/* ---- containers ------------------------------------------------------------------- */

uint64_t csg_glb_bytes(const csg_gltf_layout *layout, size_t json_bytes)
{
    return 12 + 8 + json_bytes + (layout->buffer_bytes ? 8 + layout->buffer_bytes : 0);
}

size_t csg_glb_json(const csg_gltf_layout *layout, char *text)
{
    size_t length = csg_gltf_json(layout, false, text);
    size_t wanted = layout->index_count && !layout->draco ? (size_t)CSG_GLB_JSON_BYTES : length;
    while (length < wanted || length % 4)
        text[length++] = ' ';
    return length;
}

uint8_t *csg_glb_put_head(uint8_t *at, const csg_gltf_layout *layout, const char *json,
                          size_t json_bytes)
{
    memcpy(at, "glTF", 4);
    at = csg_store_u32(at + 4, 2);
    at = csg_store_u32(at, (uint32_t)csg_glb_bytes(layout, json_bytes));
    at = csg_store_u32(at, (uint32_t)json_bytes);
    memcpy(at, "JSON", 4);
    memcpy(at + 4, json, json_bytes);
    at += 4 + json_bytes;
    if (!layout->buffer_bytes)
        return at;
    at = csg_store_u32(at, (uint32_t)layout->buffer_bytes);
    memcpy(at, "BIN", 4);
    return at + 4;
}

static csgm_status put_glb(csg_sink *sink, const csg_gltf_layout *layout,
                           const csgm_mesh_view *mesh)
{
    char json[CSG_GLTF_JSON_MOST + 4];
    size_t length = csg_glb_json(layout, json);
    uint64_t total = csg_glb_bytes(layout, length);
    if (total > CSG_GLB_MOST)
        return csg_write_refuse(sink, "write PLY instead, which has no such limit",
                                "GLB files end at 4 GiB, this one would have %llu bytes",
                                (unsigned long long)total);
    csg_sink_took(sink, csg_glb_put_head(csg_sink_room(sink, length + CSG_GLB_HEAD_MOST), layout,
                                         json, length));
    if (!layout->buffer_bytes)
        return CSGM_OK;
    put_body(sink, layout, mesh, false);
    return CSGM_OK;
}

static csgm_status put_gltf(csg_sink *sink, const csg_gltf_layout *layout,
                            const csgm_mesh_view *mesh)
{
    char json[CSG_GLTF_JSON_MOST];
    if (layout->buffer_bytes > CSG_GLB_MOST)
        return csg_write_refuse(sink, "write PLY instead, which has no such limit",
                                "glTF buffers end at 4 GiB, this one would have %llu bytes",
                                (unsigned long long)layout->buffer_bytes);
    csg_sink_put(sink, json, csg_gltf_json(layout, true, json));
    if (layout->index_count) {
        put_body(sink, layout, mesh, true);
        csg_sink_text(sink, csg_gltf_json_tail);
    }
    csg_sink_text(sink, "\n");
    return CSGM_OK;
}

/* ---- Draco ------------------------------------------------------------------------ */

typedef csgm_status container_fn(csg_sink *sink, const csg_gltf_layout *layout,
                                 const csgm_mesh_view *mesh);

/* Linear colours for the encoder, of one byte when that holds the wanted bits. */
static void *linear_colors(csg_sink *sink, const csgm_mesh_view *mesh, uint32_t bits, size_t *bytes)
{
    bool wide = bits > 8;
    *bytes = (size_t)mesh->vertex_count * (wide ? 8 : 4);
    uint8_t *colors = csg_memory_alloc(&sink->context->memory, *bytes);
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

static csgm_status write_compressed(csg_sink *sink, csg_gltf_layout *layout,
                                    const csgm_mesh_view *mesh, const csgm_write_options *options,
                                    container_fn *container)
{
    size_t color_bytes = 0;
    void *colors = NULL;
    layout->wide_colors = options->draco_color_bits > 8;
    if (mesh->colors) {
        colors = linear_colors(sink, mesh, options->draco_color_bits, &color_bytes);
        if (!colors)
            return csg_context_no_memory(sink->context);
    }
    csg_draco_mesh source = {.colors = colors, .color_bytes = layout->wide_colors ? 2 : 1};
    csg_draco_encoded encoded;
    csgm_status status = csg_write_draco(sink, mesh, &source, options, &encoded);
    csg_memory_release(&sink->context->memory, colors, color_bytes);
    if (status)
        return status;
    layout->draco = &encoded;
    layout->vertex_count = encoded.vertex_count;
    layout->index_count = 3 * encoded.triangle_count;
    layout->short_indices = encoded.vertex_count <= UINT16_MAX;
    layout->buffer_bytes = ((uint64_t)encoded.size_bytes + 3) & ~(uint64_t)3;
    status = container(sink, layout, mesh);
    csg_draco_release(&encoded);
    return status;
}

static csgm_status write_document(csg_sink *sink, const csgm_mesh_view *mesh,
                                  const csgm_write_options *options, container_fn *container)
{
    csg_gltf_layout layout = csg_gltf_measure(mesh);
    if (!mesh->triangle_count) { /* a buffer must not be empty, nor a mesh */
        layout = (csg_gltf_layout){0};
        return container(sink, &layout, mesh);
    }
    position_range(&layout, mesh);
    layout.opaque = all_opaque(mesh);
    csg_gltf_place(&layout, &mesh->origin, options);
    if (options->draco)
        return write_compressed(sink, &layout, mesh, options, container);
    return container(sink, &layout, mesh);
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
