/* SPDX-License-Identifier: MIT
 * Streams of runs into files; see stream.h. A run becomes bytes in its worker's own buffer and goes
 * out with pwrite; where in the file is what the format's own kind of stream knows (stream_kind.h).
 */
#include "io/stream.h"

#include <errno.h>
#include <fcntl.h>
#include <stdatomic.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/mesh_codes.h"
#include "base/ranks.h"
#include "io/file.h"
#include "io/format_table.h"

typedef struct stream_buffer {
    void *bytes;
    size_t capacity;
} stream_buffer;

struct csg_stream {
    csg_stream_view view; /* first, so that a kind's view is its stream */
    const csg_stream_kind *kind;
    csg_atomic_file file;
    stream_buffer *buffers;       /* one for each worker */
    atomic_uint_fast64_t written; /* bytes so far */
    atomic_int error;             /* errno of the first failed write */
};

static csg_stream *stream_of(csg_stream_view *view)
{
    return (csg_stream *)view;
}

static const csg_format_row *row_of(const char *path, csgm_format format)
{
    return csg_format_find(format == CSGM_FORMAT_AUTO ? csg_format_from_path(path) : format);
}

bool csg_stream_is_possible(const char *path, csgm_format format, double distance,
                            const csgm_write_options *options)
{
    const csg_format_row *row = row_of(path, format);
    if (!row || !row->stream || !row->stream->is_possible(options))
        return false;
    if (csg_format_rounds(row, distance))
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
    if (s->view.options.sync && before >> PORTION_BITS != (before + more) >> PORTION_BITS)
        sync_file_range(s->file.fd, 0, 0, SYNC_FILE_RANGE_WRITE);
#else
    (void)before;
#endif
}

/* The first error is the one that is told. */
static void keep_error(csg_stream *s, int error)
{
    int none = 0;
    atomic_compare_exchange_strong(&s->error, &none, error);
}

bool csg_stream_write_at(csg_stream_view *stream, const void *bytes, uint64_t count, uint64_t at)
{
    csg_stream *s = stream_of(stream);
    const uint8_t *from = bytes;
    while (count) {
        ssize_t written = pwrite(s->file.fd, from, count, (off_t)at);
        if (written < 0 && errno == EINTR)
            continue;
        if (written <= 0) {
            keep_error(s, written < 0 ? errno : EIO);
            return false;
        }
        begin_write_back(s, (uint64_t)written);
        from += written;
        at += (uint64_t)written;
        count -= (uint64_t)written;
    }
    return true;
}

uint8_t *csg_stream_room(csg_stream_view *stream, uint32_t worker, uint64_t bytes)
{
    csg_stream *s = stream_of(stream);
    stream_buffer *self = &s->buffers[worker];
    if (csg_memory_reserve(&stream->context->memory, &self->bytes, &self->capacity, bytes, 1))
        return self->bytes;
    keep_error(s, ENOMEM);
    return NULL;
}

void csg_stream_no_memory(csg_stream_view *stream)
{
    keep_error(stream_of(stream), ENOMEM);
}

bool csg_stream_cut(csg_stream_view *stream, uint64_t size_bytes)
{
    csg_stream *s = stream_of(stream);
    if (ftruncate(s->file.fd, (off_t)size_bytes) == 0)
        return true;
    keep_error(s, errno);
    return false;
}

/* ---- the stream ------------------------------------------------------------------- */

static csgm_status begin_file(void *user, const csg_mesh_counts *counts)
{
    static const float some_floats[1];
    static const uint8_t some_bytes[1];
    csg_stream *s = user;
    s->view.mesh = (csgm_mesh_view){.origin = counts->origin,
                                    .normals = counts->normals ? some_floats : NULL,
                                    .colors = counts->colors ? some_bytes : NULL,
                                    .vertex_count = counts->vertex_count,
                                    .triangle_count = counts->triangle_count};
    return s->kind->begin(&s->view);
}

static bool put_run(void *user, const csg_mesh_run *run)
{
    csg_stream *s = user;
    return s->kind->put(&s->view, run);
}

static void *what_is_seen(void *user, uint64_t *bytes)
{
    const csg_stream *s = user;
    *bytes = s->view.worker_count * s->kind->worker_bytes;
    return s->view.workers;
}

static bool flush_runs(void *user)
{
    csg_stream *s = user;
    if (!s->view.options.sync || fdatasync(s->file.fd) == 0)
        return true;
    keep_error(s, errno);
    return false;
}

csg_mesh_receiver csg_stream_receiver(csg_stream *stream)
{
    return (csg_mesh_receiver){.user = stream,
                               .begin = begin_file,
                               .put = put_run,
                               .seen = what_is_seen,
                               .flush = flush_runs,
                               .wants_corners = stream->kind->wants_corners};
}

static void release(csg_stream *s)
{
    csg_memory *memory = &s->view.context->memory;
    uint32_t count = s->view.worker_count;
    csg_ranks_end_keeping(s->view.context);
    for (uint32_t i = 0; s->buffers && i < count; i++)
        csg_memory_release(memory, s->buffers[i].bytes, s->buffers[i].capacity);
    csg_memory_release(memory, s->buffers, count * sizeof *s->buffers);
    csg_memory_release(memory, s->view.workers, count * s->kind->worker_bytes);
    csg_memory_release(memory, s->view.state, s->kind->state_bytes);
    csg_memory_release(memory, s, sizeof *s);
}

/* NULL for no bytes, too. */
static void *allocate_zeros(csg_memory *memory, size_t bytes)
{
    void *zeros = bytes ? csg_memory_alloc(memory, bytes) : NULL;
    return zeros ? memset(zeros, 0, bytes) : NULL;
}

static csgm_status create(csgm_context *context, const char *path, csgm_format format,
                          const csgm_write_options *options, uint32_t workers, csg_stream **out)
{
    csg_memory *memory = &context->memory;
    csg_stream *s = csg_memory_alloc(memory, sizeof *s);
    if (!s)
        return csg_context_no_memory(context);
    *s = (csg_stream){
        .view = {.context = context, .path = path, .options = *options, .worker_count = workers},
        .kind = row_of(path, format)->stream};
    s->buffers = allocate_zeros(memory, workers * sizeof *s->buffers);
    s->view.workers = allocate_zeros(memory, workers * s->kind->worker_bytes);
    s->view.state = allocate_zeros(memory, s->kind->state_bytes);
    if (!s->buffers || (!s->view.workers && s->kind->worker_bytes) ||
        (!s->view.state && s->kind->state_bytes)) {
        release(s);
        return csg_context_no_memory(context);
    }
    *out = s;
    return CSGM_OK;
}

/* Where the context keeps what is finished, the file is in that folder. */
static csgm_status create_shared(csg_stream *s, csgm_context *context, const char *path)
{
    csg_ranks *ranks = context->ranks;
    ranks->is_begun = false;
    if (!ranks->folder)
        return csg_file_create_shared(&s->file, context, path);
    csg_arena names;
    csg_arena_init(&names, &context->memory);
    const char *kept = csg_arena_printf(&names, "%s/mesh", ranks->folder);
    csgm_status status = kept
                             ? csg_file_create_kept(&s->file, context, path, kept, &ranks->is_begun)
                             : csg_context_no_memory(context);
    csg_arena_reset(&names);
    return status;
}

/* One file for all ranks: the first creates it and tells the others its hidden name. */
static csgm_status open_shared(csg_stream *s, csgm_context *context, const char *path,
                               csgm_status own)
{
    bool first = csg_ranks_is_first(context), is_open = false;
    csg_ranks *ranks = context->ranks;
    if (own == CSGM_OK && first) {
        own = create_shared(s, context, path);
        is_open = own == CSGM_OK;
    }
    const char *name = is_open ? s->file.temporary.name : "";
    csg_rank_pieces names;
    csgm_status status = csg_ranks_gather(context, own, CSGM_ALL_RANKS, name,
                                          is_open ? strlen(name) + 1 : 0, &names);
    if (status == CSGM_OK && !first) {
        status = csg_file_attach(&s->file, context, path, names.bytes, ranks->folder != NULL);
        is_open = status == CSGM_OK;
    }
    csg_rank_pieces_release(&context->memory, &names);
    status = csg_ranks_follow(context, status, &ranks->is_begun);
    if (status != CSGM_OK && is_open)
        csg_file_abandon(&s->file);
    ranks->keeps = status == CSGM_OK && ranks->folder;
    ranks->keeps_synced = ranks->keeps && s->view.options.sync;
    return status;
}

csgm_status csg_stream_create(csgm_context *context, const char *path, csgm_format format,
                              const csgm_write_options *options, uint32_t workers, csg_stream **out)
{
    csg_stream *s = NULL;
    csgm_status status = create(context, path, format, options, workers, &s);
    if (context->ranks)
        status = open_shared(s, context, path, status);
    else if (status == CSGM_OK)
        status = csg_file_create(&s->file, context, path);
    if (status != CSGM_OK) {
        if (s)
            release(s);
        return status;
    }
    s->file.sync = options->sync;
    s->file.only_if_changed = options->only_if_changed;
    s->view.fd = s->file.fd;
    s->view.is_first = csg_ranks_is_first(context);
    *out = s;
    return CSGM_OK;
}

static csgm_status report(csg_stream *s)
{
    int error = atomic_load(&s->error);
    if (!error)
        return CSGM_OK;
    if (error == ENOMEM)
        return csg_context_no_memory(s->view.context);
    csg_diag_plain(&s->view.context->diags, CSG_DIAG_CANNOT_WRITE, s->file.path, NULL,
                   "cannot write: %s", strerror(error));
    return CSGM_ERR_IO;
}

/* What ends the file, by the process that names it; then it is gone. */
static csgm_status complete(csg_stream *s)
{
    if (s->kind->end)
        s->kind->end(&s->view);
    csgm_status status = report(s);
    if (status == CSGM_OK)
        return csg_file_commit(&s->file);
    csg_file_abandon(&s->file);
    return status;
}

/* The first rank sees what the workers of all have seen, once the bytes of all are in the file. */
static csgm_status complete_shared(csg_stream *s)
{
    csgm_context *context = s->view.context;
    bool first = s->view.is_first;
    csgm_status status = report(s);
    if (status == CSGM_OK && !first)
        status = csg_file_flush(&s->file);
    csg_rank_pieces seen;
    status = csg_ranks_gather(context, status, 0, s->view.workers,
                              s->view.worker_count * s->kind->worker_bytes, &seen);
    if (status == CSGM_OK && first) {
        void *own = s->view.workers;
        uint32_t count = s->view.worker_count;
        if (seen.total) {
            s->view.workers = seen.bytes;
            s->view.worker_count = (uint32_t)(seen.total / s->kind->worker_bytes);
        }
        status = complete(s);
        s->view.workers = own;
        s->view.worker_count = count;
        status = csg_ranks_agree(context, status);
    } else {
        if (status == CSGM_OK)
            status = csg_ranks_agree(context, status);
        csg_file_abandon(&s->file);
    }
    csg_rank_pieces_release(&context->memory, &seen);
    return status;
}

csgm_status csg_stream_commit(csg_stream *s)
{
    csgm_status status = s->view.context->ranks ? complete_shared(s) : complete(s);
    release(s);
    return status;
}

csgm_status csg_stream_abandon(csg_stream *s)
{
    csgm_status status = csg_ranks_say_why(s->view.context, report(s));
    csg_file_abandon(&s->file);
    release(s);
    return status;
}
