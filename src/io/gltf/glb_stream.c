/* SPDX-License-Identifier: MIT
 * Runs of a mesh to their places in a plain GLB. The buffer begins at byte 4096 whatever the JSON
 * says; positions' range and opacity, which the JSON needs, are gathered on the way, and the head
 * is written last.
 */
#include <math.h>

#include "base/mesh_codes.h"
#include "io/color.h"
#include "io/gltf/gltf_layout.h"
#include "io/stream_kind.h"

typedef struct glb_stream {
    csg_gltf_layout layout;
    csg_color_table colors;
} glb_stream;

/* What a worker has seen. All zero: nothing yet. */
typedef struct glb_worker {
    float min[3], max[3];
    bool has_seen, translucent;
} glb_worker;

static bool is_plain(const csgm_write_options *options)
{
    return !options->draco;
}

static csgm_status begin_file(csg_stream_view *s)
{
    glb_stream *glb = s->state;
    glb->layout = csg_gltf_measure(&s->mesh);
    glb->colors = csg_color_table_make(16, true);
    csg_gltf_place(&glb->layout, &s->mesh.origin, &s->options);
    uint64_t total = csg_glb_bytes(&glb->layout, CSG_GLB_JSON_BYTES);
    if (total <= CSG_GLB_MOST)
        return CSGM_OK;
    csg_diag_plain(&s->context->diags, CSG_DIAG_FORMAT_LIMIT, s->path,
                   "write PLY instead, which has no such limit",
                   "GLB files end at 4 GiB, this one would have %llu bytes",
                   (unsigned long long)total);
    return CSGM_ERR_UNSUPPORTED;
}

static void widen(glb_worker *self, const csg_mesh_run *run)
{
    const float *p = run->positions;
    for (int k = 0; k < 3 && !self->has_seen; k++) {
        self->min[k] = INFINITY;
        self->max[k] = -INFINITY;
    }
    self->has_seen = true;
    for (uint64_t i = 0; i < run->vertex_count; i++, p += 3)
        for (int k = 0; k < 3; k++) {
            self->min[k] = p[k] < self->min[k] ? p[k] : self->min[k];
            self->max[k] = p[k] > self->max[k] ? p[k] : self->max[k];
        }
    for (uint64_t i = 0; run->colors && i < run->vertex_count; i++)
        self->translucent |= run->colors[4 * i + 3] != 255;
}

static bool put_colors(csg_stream_view *s, const csg_mesh_run *run, uint64_t at)
{
    const glb_stream *glb = s->state;
    uint8_t *bytes = csg_stream_room(s, run->worker, 8 * run->vertex_count), *end = bytes;
    if (!bytes)
        return false;
    for (uint64_t i = 0; i < 4 * run->vertex_count; i++) {
        const uint16_t *curve = i % 4 == 3 ? glb->colors.alpha : glb->colors.linear;
        end = csg_store_u16(end, curve[run->colors[i]]);
    }
    return csg_stream_write_at(s, bytes, 8 * run->vertex_count, at + 8 * run->first_vertex);
}

/* Few vertices have 16-bit indices. The bytes that pad the buffer stay zero. */
static bool put_indices(csg_stream_view *s, const csg_mesh_run *run, uint64_t at)
{
    const glb_stream *glb = s->state;
    uint64_t count = 3 * run->triangle_count, first = 3 * run->first_triangle;
    if (!glb->layout.short_indices)
        return csg_stream_write_at(s, run->indices, 4 * count, at + 4 * first);
    uint8_t *bytes = csg_stream_room(s, run->worker, 2 * count), *end = bytes;
    if (!bytes)
        return false;
    for (uint64_t i = 0; i < count; i++)
        end = csg_store_u16(end, run->indices[i]);
    return csg_stream_write_at(s, bytes, 2 * count, at + 2 * first);
}

static bool put_run(csg_stream_view *s, const csg_mesh_run *run)
{
    const glb_stream *glb = s->state;
    const csg_gltf_layout *layout = &glb->layout;
    uint64_t at = 4096;
    widen((glb_worker *)s->workers + run->worker, run);
    if (!csg_stream_write_at(s, run->positions, 12 * run->vertex_count,
                             at + 12 * run->first_vertex))
        return false;
    at += layout->position_bytes;
    if (run->normals &&
        !csg_stream_write_at(s, run->normals, 12 * run->vertex_count, at + 12 * run->first_vertex))
        return false;
    at += layout->normal_bytes;
    if (run->colors && !put_colors(s, run, at))
        return false;
    return put_indices(s, run, at + layout->color_bytes);
}

/* What all workers have seen. */
static void gather(const csg_stream_view *s, csg_gltf_part *part)
{
    const glb_worker *workers = s->workers;
    part->opaque = true;
    for (int k = 0; k < 3; k++) {
        part->min[k] = INFINITY;
        part->max[k] = -INFINITY;
    }
    for (uint32_t i = 0; i < s->worker_count; i++) {
        part->opaque &= !workers[i].translucent;
        for (int k = 0; k < 3 && workers[i].has_seen; k++) {
            part->min[k] = fminf(part->min[k], workers[i].min[k]);
            part->max[k] = fmaxf(part->max[k], workers[i].max[k]);
        }
    }
}

static bool end_file(csg_stream_view *s)
{
    glb_stream *glb = s->state;
    csg_gltf_layout *layout = &glb->layout;
    char text[CSG_GLTF_JSON_MOST];
    csg_gltf_text json = {.text = text, .capacity = sizeof text};
    uint8_t head[CSG_GLTF_JSON_MOST + CSG_GLB_HEAD_MOST];
    if (!s->mesh.triangle_count) /* a buffer must not be empty, nor a mesh */
        *layout = (csg_gltf_layout){0};
    gather(s, &layout->only);
    csg_glb_json(layout, &json);
    uint8_t *end = csg_glb_put_head(head, layout, json.length);
    memcpy(end, json.text, json.length);
    end = csg_glb_put_body_head(end + json.length, layout);
    return csg_stream_cut(s, csg_glb_bytes(layout, json.length)) &&
           csg_stream_write_at(s, head, (uint64_t)(end - head), 0);
}

const csg_stream_kind csg_glb_stream = {.state_bytes = sizeof(glb_stream),
                                        .worker_bytes = sizeof(glb_worker),
                                        .is_possible = is_plain,
                                        .begin = begin_file,
                                        .put = put_run,
                                        .end = end_file};
