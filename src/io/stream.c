/* SPDX-License-Identifier: MIT
 * Streams of runs into files; see stream.h. A run becomes bytes in its worker's own buffer and goes
 * out with pwrite. Positions' range and opacity, which a GLB's head needs, are gathered on the way
 * and the head is written last.
 */
#include "io/stream.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdatomic.h>
#include <sys/stat.h>
#include <unistd.h>

#include "io/color.h"
#include "io/file.h"
#include "io/gltf/gltf_layout.h"

typedef struct worker {
    uint8_t *bytes;
    size_t capacity;
    float min[3], max[3];
    bool opaque;
} worker;

struct csg_stream {
    csgm_context *context;
    csgm_format format;
    csgm_write_options options;
    csg_file file;
    csgm_mesh_view view; /* counts, origin, and which arrays there are (pointers without meaning) */
    uint64_t vertices_at, faces_at; /* PLY: places in the file */
    csg_gltf_layout layout;         /* GLB */
    csg_color_table colors;
    worker *workers;
    uint32_t worker_count;
    atomic_uint_fast64_t written; /* bytes so far */
    atomic_int error;             /* errno of the first failed write */
};

bool csg_stream_is_possible(const char *path, csgm_format format, const csgm_write_options *options)
{
    if (format == CSGM_FORMAT_AUTO)
        format = csg_format_from_path(path);
    bool is_binary = (format == CSGM_FORMAT_PLY || format == CSGM_FORMAT_STL) && !options->ascii;
    if (!is_binary && !(format == CSGM_FORMAT_GLB && !options->draco))
        return false;
    struct stat target;
    return stat(path, &target) != 0 ? errno == ENOENT : S_ISREG(target.st_mode);
}

/* ---- bytes to their place --------------------------------------------------------- */

/* Every 16 MiB the disk is told to begin: it then writes while we mesh, and the sync at the end is
 * short. (After every run it costs more than it gains; tests/bench/log.md.) */
static void begin_write_back(csg_stream *s, uint64_t more)
{
    enum { PORTION_BITS = 24 };
    uint64_t before = atomic_fetch_add(&s->written, more);
#ifdef __linux__
    if (s->options.sync && before >> PORTION_BITS != (before + more) >> PORTION_BITS)
        sync_file_range(s->file.fd, 0, 0, SYNC_FILE_RANGE_WRITE);
#else
    (void)before;
#endif
}

static bool write_at(csg_stream *s, const void *bytes, uint64_t count, uint64_t at)
{
    const uint8_t *from = bytes;
    while (count) {
        ssize_t written = pwrite(s->file.fd, from, count, (off_t)at);
        if (written < 0 && errno == EINTR)
            continue;
        if (written <= 0) {
            int none = 0;
            atomic_compare_exchange_strong(&s->error, &none, written < 0 ? errno : EIO);
            return false;
        }
        begin_write_back(s, (uint64_t)written);
        from += written;
        at += (uint64_t)written;
        count -= (uint64_t)written;
    }
    return true;
}

static uint8_t *room(csg_stream *s, worker *self, uint64_t bytes)
{
    if (csg_memory_reserve(&s->context->memory, (void **)&self->bytes, &self->capacity, bytes, 1))
        return self->bytes;
    int none = 0;
    atomic_compare_exchange_strong(&s->error, &none, ENOMEM);
    return NULL;
}

/* ---- PLY -------------------------------------------------------------------------- */

static csgm_status begin_ply(csg_stream *s)
{
    csg_sink sink;
    csgm_status status = csg_ply_check(s->context, s->file.path, &s->view);
    if (status == CSGM_OK)
        status = csg_sink_open(&sink, s->context, s->file.fd, s->file.path);
    if (status != CSGM_OK)
        return status;
    csg_ply_put_header(&sink, &s->view, &s->options);
    s->vertices_at = sink.length; /* far shorter than the sink's buffer */
    s->faces_at = s->vertices_at + s->view.vertex_count * csg_ply_vertex_bytes(&s->view);
    return csg_sink_close(&sink);
}

/* The run as a mesh of its own. */
static csgm_mesh_view view_of(const csg_stream *s, const csg_mesh_run *run)
{
    return (csgm_mesh_view){.origin = s->view.origin,
                            .positions = run->positions,
                            .normals = run->normals,
                            .colors = run->colors,
                            .indices = run->indices,
                            .vertex_count = run->vertex_count,
                            .triangle_count = run->triangle_count};
}

static bool put_ply(csg_stream *s, worker *self, const csg_mesh_run *run)
{
    csgm_mesh_view view = view_of(s, run);
    uint64_t stride = csg_ply_vertex_bytes(&s->view);
    uint64_t vertex_bytes = run->vertex_count * stride;
    uint64_t face_bytes = run->triangle_count * CSG_PLY_FACE_BYTES;
    uint8_t *bytes = room(s, self, vertex_bytes > face_bytes ? vertex_bytes : face_bytes);
    if (!bytes)
        return false;
    csg_ply_pack_vertices(bytes, &view, 0, run->vertex_count);
    if (!write_at(s, bytes, vertex_bytes, s->vertices_at + run->first_vertex * stride))
        return false;
    csg_ply_pack_faces(bytes, run->indices, run->triangle_count);
    return write_at(s, bytes, face_bytes, s->faces_at + run->first_triangle * CSG_PLY_FACE_BYTES);
}

/* ---- STL
 * ----------------------------------------------------------------------------------------- */

static csgm_status begin_stl(csg_stream *s)
{
    uint8_t head[CSG_STL_HEAD_BYTES];
    csgm_status status = csg_stl_check(s->context, s->file.path, &s->view);
    csg_stl_pack_head(head, s->view.triangle_count);
    if (status == CSGM_OK)
        write_at(s, head, sizeof head, 0);
    return status;
}

static bool put_stl(csg_stream *s, worker *self, const csg_mesh_run *run)
{
    uint64_t count = run->triangle_count * CSG_STL_FACET_BYTES;
    uint8_t *bytes = room(s, self, count);
    if (!bytes)
        return false;
    csg_stl_pack_corners(bytes, &s->view.origin, run->corners, run->triangle_count);
    return write_at(s, bytes, count,
                    CSG_STL_HEAD_BYTES + run->first_triangle * CSG_STL_FACET_BYTES);
}

/* ---- GLB -------------------------------------------------------------------------- */

static csgm_status begin_glb(csg_stream *s)
{
    s->layout = csg_gltf_measure(&s->view);
    s->colors = csg_color_table_make(16, true);
    csg_gltf_place(&s->layout, &s->view.origin, &s->options);
    uint64_t total = csg_glb_bytes(&s->layout, CSG_GLB_JSON_BYTES);
    if (total <= CSG_GLB_MOST)
        return CSGM_OK;
    csg_diag_plain(&s->context->diags, CSG_DIAG_FORMAT_LIMIT, s->file.path,
                   "write PLY instead, which has no such limit",
                   "GLB files end at 4 GiB, this one would have %llu bytes",
                   (unsigned long long)total);
    return CSGM_ERR_UNSUPPORTED;
}

static void widen(worker *self, const csg_mesh_run *run)
{
    const float *p = run->positions;
    for (uint64_t i = 0; i < run->vertex_count; i++, p += 3)
        for (int k = 0; k < 3; k++) {
            self->min[k] = p[k] < self->min[k] ? p[k] : self->min[k];
            self->max[k] = p[k] > self->max[k] ? p[k] : self->max[k];
        }
    for (uint64_t i = 0; run->colors && i < run->vertex_count; i++)
        self->opaque &= run->colors[4 * i + 3] == 255;
}

static bool put_glb_colors(csg_stream *s, worker *self, const csg_mesh_run *run, uint64_t at)
{
    uint8_t *bytes = room(s, self, 8 * run->vertex_count), *end = bytes;
    if (!bytes)
        return false;
    for (uint64_t i = 0; i < 4 * run->vertex_count; i++) {
        const uint16_t *curve = i % 4 == 3 ? s->colors.alpha : s->colors.linear;
        end = csg_store_u16(end, curve[run->colors[i]]);
    }
    return write_at(s, bytes, 8 * run->vertex_count, at + 8 * run->first_vertex);
}

/* Few vertices have 16-bit indices. The bytes that pad the buffer stay zero. */
static bool put_glb_indices(csg_stream *s, worker *self, const csg_mesh_run *run, uint64_t at)
{
    uint64_t count = 3 * run->triangle_count, first = 3 * run->first_triangle;
    if (!s->layout.short_indices)
        return write_at(s, run->indices, 4 * count, at + 4 * first);
    uint8_t *bytes = room(s, self, 2 * count), *end = bytes;
    if (!bytes)
        return false;
    for (uint64_t i = 0; i < count; i++)
        end = csg_store_u16(end, run->indices[i]);
    return write_at(s, bytes, 2 * count, at + 2 * first);
}

static bool put_glb(csg_stream *s, worker *self, const csg_mesh_run *run)
{
    const csg_gltf_layout *layout = &s->layout;
    uint64_t at = 4096;
    widen(self, run);
    if (!write_at(s, run->positions, 12 * run->vertex_count, at + 12 * run->first_vertex))
        return false;
    at += layout->position_bytes;
    if (run->normals &&
        !write_at(s, run->normals, 12 * run->vertex_count, at + 12 * run->first_vertex))
        return false;
    at += layout->normal_bytes;
    if (run->colors && !put_glb_colors(s, self, run, at))
        return false;
    return put_glb_indices(s, self, run, at + layout->color_bytes);
}

static bool end_glb(csg_stream *s)
{
    csg_gltf_layout *layout = &s->layout;
    char text[CSG_GLTF_JSON_MOST];
    csg_gltf_text json = {.text = text, .capacity = sizeof text};
    uint8_t head[CSG_GLTF_JSON_MOST + CSG_GLB_HEAD_MOST];
    if (!s->view.triangle_count) /* a buffer must not be empty, nor a mesh */
        *layout = (csg_gltf_layout){0};
    csg_gltf_part *part = &layout->only;
    part->opaque = true;
    for (int k = 0; k < 3; k++) {
        part->min[k] = INFINITY;
        part->max[k] = -INFINITY;
        for (uint32_t i = 0; i < s->worker_count; i++) {
            part->min[k] = fminf(part->min[k], s->workers[i].min[k]);
            part->max[k] = fmaxf(part->max[k], s->workers[i].max[k]);
        }
    }
    for (uint32_t i = 0; i < s->worker_count; i++)
        part->opaque &= s->workers[i].opaque;
    csg_glb_json(layout, &json);
    uint8_t *end = csg_glb_put_head(head, layout, json.length);
    memcpy(end, json.text, json.length);
    end = csg_glb_put_body_head(end + json.length, layout);
    uint64_t total = csg_glb_bytes(layout, json.length);
    if (ftruncate(s->file.fd, (off_t)total) != 0) {
        atomic_store(&s->error, errno);
        return false;
    }
    return write_at(s, head, (uint64_t)(end - head), 0);
}

/* ---- the stream ------------------------------------------------------------------- */

static csgm_status begin(void *user, const csg_mesh_counts *counts)
{
    static const float some_floats[1];
    static const uint8_t some_bytes[1];
    csg_stream *s = user;
    s->view = (csgm_mesh_view){.origin = counts->origin,
                               .normals = counts->normals ? some_floats : NULL,
                               .colors = counts->colors ? some_bytes : NULL,
                               .vertex_count = counts->vertex_count,
                               .triangle_count = counts->triangle_count};
    return s->format == CSGM_FORMAT_PLY   ? begin_ply(s)
           : s->format == CSGM_FORMAT_STL ? begin_stl(s)
                                          : begin_glb(s);
}

static bool put(void *user, const csg_mesh_run *run)
{
    csg_stream *s = user;
    worker *self = &s->workers[run->worker];
    return s->format == CSGM_FORMAT_PLY   ? put_ply(s, self, run)
           : s->format == CSGM_FORMAT_STL ? put_stl(s, self, run)
                                          : put_glb(s, self, run);
}

csg_mesh_receiver csg_stream_receiver(csg_stream *stream)
{
    return (csg_mesh_receiver){.user = stream,
                               .begin = begin,
                               .put = put,
                               .wants_corners = stream->format == CSGM_FORMAT_STL};
}

static void release(csg_stream *s)
{
    csg_memory *memory = &s->context->memory;
    for (uint32_t i = 0; s->workers && i < s->worker_count; i++)
        csg_memory_release(memory, s->workers[i].bytes, s->workers[i].capacity);
    csg_memory_release(memory, s->workers, s->worker_count * sizeof(worker));
    csg_memory_release(memory, s, sizeof *s);
}

csgm_status csg_stream_create(csgm_context *context, const char *path, csgm_format format,
                              const csgm_write_options *options, uint32_t workers, csg_stream **out)
{
    csg_stream *s = csg_memory_alloc(&context->memory, sizeof *s);
    if (!s)
        return csg_context_no_memory(context);
    *s = (csg_stream){.context = context,
                      .format = format == CSGM_FORMAT_AUTO ? csg_format_from_path(path) : format,
                      .options = *options,
                      .worker_count = workers};
    s->workers = csg_memory_alloc(&context->memory, workers * sizeof(worker));
    if (!s->workers) {
        release(s);
        return csg_context_no_memory(context);
    }
    for (uint32_t i = 0; i < workers; i++)
        s->workers[i] = (worker){.min = {INFINITY, INFINITY, INFINITY},
                                 .max = {-INFINITY, -INFINITY, -INFINITY},
                                 .opaque = true};
    csgm_status status = csg_file_create(&s->file, context, path);
    s->file.sync = options->sync;
    s->file.only_if_changed = options->only_if_changed;
    if (status != CSGM_OK)
        release(s);
    else
        *out = s;
    return status;
}

static csgm_status report(csg_stream *s)
{
    int error = atomic_load(&s->error);
    if (!error)
        return CSGM_OK;
    if (error == ENOMEM)
        return csg_context_no_memory(s->context);
    csg_diag_plain(&s->context->diags, CSG_DIAG_CANNOT_WRITE, s->file.path, NULL,
                   "cannot write: %s", strerror(error));
    return CSGM_ERR_IO;
}

csgm_status csg_stream_commit(csg_stream *s)
{
    if (s->format == CSGM_FORMAT_GLB)
        end_glb(s);
    csgm_status status = report(s);
    if (status == CSGM_OK)
        status = csg_file_commit(&s->file);
    else
        csg_file_abandon(&s->file);
    release(s);
    return status;
}

void csg_stream_abandon(csg_stream *s)
{
    if (!s)
        return;
    report(s);
    csg_file_abandon(&s->file);
    release(s);
}
