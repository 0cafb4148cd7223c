/* SPDX-License-Identifier: MIT
 * Runs of a mesh to their places in a plain GLB. The buffer begins at byte 4096 whatever the JSON
 * says; positions' range and the look, which the JSON needs, are gathered on the way, and the head
 * is written last. Colours stand at the buffer's end: where all are one, they are cut off.
 */
#include <math.h>

#include "base/mesh_codes.h"
#include "io/color.h"
#include "io/gltf/gltf_plan.h"
#include "io/stream_kind.h"

typedef struct glb_stream {
    csg_gltf_shape shape;
    csg_gltf_sections sections;
    csg_color_table colors;
} glb_stream;

/* What a worker has seen. All zero: nothing yet. */
typedef struct glb_worker {
    float min[3], max[3];
    uint8_t color[4]; /* the first */
    bool has_seen, translucent, each_color;
} glb_worker;

/* The head must not reach the buffer's place: without names and metadata it has 2 KiB at most. */
static bool is_plain(const csgm_write_options *options)
{
    enum { METADATA_MOST = 1024 };
    size_t bytes = options->comment ? strlen(options->comment) : 0;
    for (size_t i = 0; i < options->metadata_count; i++)
        bytes += strlen(options->metadata[i]) + 8;
    return !options->draco && !options->meshopt && options->uv == CSGM_UV_NONE &&
           !options->level_count && bytes < METADATA_MOST;
}

/* The shape that a stream is, as the tables of the document see it. */
static csg_gltf_source source_of(const csg_stream_view *s, csg_gltf_shape *shape,
                                 csg_gltf_show *show)
{
    *show = (csg_gltf_show){.shift = s->mesh.origin};
    return (csg_gltf_source){
        .mesh = s->mesh, .shapes = shape, .shows = show, .shape_count = 1, .show_count = 1};
}

static csgm_status begin_file(csg_stream_view *s)
{
    glb_stream *glb = s->state;
    csg_gltf_show show;
    csg_gltf_source source = source_of(s, &glb->shape, &show);
    glb->shape = (csg_gltf_shape){.vertex_count = s->mesh.vertex_count,
                                  .index_count = 3 * s->mesh.triangle_count,
                                  .look = csg_look_plain()};
    glb->shape.look.is_colored = glb->shape.look.each_color = s->mesh.colors;
    glb->sections = csg_gltf_place_sections(&source);
    glb->colors = csg_color_table_make(16, true);
    uint64_t total = 4096 + glb->sections.end;
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
    if (!self->has_seen && run->colors && run->vertex_count)
        memcpy(self->color, run->colors, 4);
    self->has_seen |= run->vertex_count > 0;
    for (uint64_t i = 0; i < run->vertex_count; i++, p += 3)
        for (int k = 0; k < 3; k++) {
            self->min[k] = p[k] < self->min[k] ? p[k] : self->min[k];
            self->max[k] = p[k] > self->max[k] ? p[k] : self->max[k];
        }
    for (uint64_t i = 0; run->colors && i < run->vertex_count; i++) {
        self->translucent |= run->colors[4 * i + 3] != 255;
        self->each_color |= memcmp(self->color, run->colors + 4 * i, 4) != 0;
    }
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
    if (!csg_gltf_is_short(&glb->shape))
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
    const csg_gltf_sections *sections = &glb->sections;
    uint64_t at = 4096;
    widen((glb_worker *)s->workers + run->worker, run);
    if (!csg_stream_write_at(s, run->positions, 12 * run->vertex_count,
                             at + 12 * run->first_vertex))
        return false;
    if (run->normals && !csg_stream_write_at(s, run->normals, 12 * run->vertex_count,
                                             at + sections->normals + 12 * run->first_vertex))
        return false;
    if (run->colors && !put_colors(s, run, at + sections->colors))
        return false;
    return put_indices(s, run, at + sections->indices);
}

/* What all workers have seen. */
static void gather(const csg_stream_view *s, csg_gltf_shape *shape)
{
    const glb_worker *workers = s->workers, *first = NULL;
    csg_part_look *look = &shape->look;
    look->each_color = false;
    for (int k = 0; k < 3; k++) {
        shape->min[k] = INFINITY;
        shape->max[k] = -INFINITY;
    }
    for (uint32_t i = 0; i < s->worker_count; i++) {
        const glb_worker *worker = &workers[i];
        if (!worker->has_seen)
            continue;
        first = first ? first : worker;
        look->is_opaque &= !worker->translucent;
        look->each_color |= worker->each_color || memcmp(worker->color, first->color, 4) != 0;
        for (int k = 0; k < 3; k++) {
            shape->min[k] = fminf(shape->min[k], worker->min[k]);
            shape->max[k] = fmaxf(shape->max[k], worker->max[k]);
        }
    }
    if (look->is_colored && !look->each_color && first)
        memcpy(look->color, first->color, 4);
}

static bool put_document(csg_stream_view *s, csg_gltf_document *document)
{
    csg_gltf_text json = {.memory = &s->context->memory};
    uint8_t head[CSG_GLB_HEAD_MOST];
    csg_glb_json(document, &json);
    bool done = !json.failed && !document->failed;
    if (done) {
        size_t begin = (size_t)(csg_glb_put_head(head, document, json.length) - head);
        size_t body = (size_t)(csg_glb_put_body_head(head + begin, document) - head) - begin;
        done = csg_stream_cut(s, csg_glb_bytes(document, json.length)) &&
               csg_stream_write_at(s, head, begin, 0) &&
               csg_stream_write_at(s, json.text, json.length, begin) &&
               csg_stream_write_at(s, head + begin, body, begin + json.length);
    } else {
        csg_stream_no_memory(s);
    }
    csg_memory_release(json.memory, json.text, json.capacity);
    return done;
}

static bool end_file(csg_stream_view *s)
{
    glb_stream *glb = s->state;
    csg_gltf_show show;
    csg_gltf_source source = source_of(s, &glb->shape, &show);
    csg_gltf_document document;
    csg_gltf_document_init(&document, &s->context->memory, &s->options);
    if (s->mesh.triangle_count) { /* a buffer must not be empty, nor a mesh */
        gather(s, &glb->shape);
        glb->sections = csg_gltf_place_sections(&source);
        csg_gltf_plan(&document, &source, &glb->sections);
    }
    bool done = put_document(s, &document);
    csg_gltf_document_release(&document);
    return done;
}

const csg_stream_kind csg_glb_stream = {.state_bytes = sizeof(glb_stream),
                                        .worker_bytes = sizeof(glb_worker),
                                        .is_possible = is_plain,
                                        .begin = begin_file,
                                        .put = put_run,
                                        .end = end_file};
