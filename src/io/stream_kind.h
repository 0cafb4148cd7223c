/* SPDX-License-Identifier: MIT
 * What a format does to be filled from all sides (stream.h), for the files that do so. The stream
 * owns the file, the memory and the workers; a kind knows where a run's bytes belong.
 */
#ifndef CSG_IO_STREAM_KIND_H
#define CSG_IO_STREAM_KIND_H

#include "base/context.h"
#include "mesh/run.h"

/* What a kind sees of a stream. */
typedef struct csg_stream_view {
    csgm_context *context;
    const char *path; /* for diagnostics */
    bool is_first;    /* this process writes what belongs to no run */
    int fd;           /* for what is put at the file's begin before any run */
    csgm_write_options options;
    csgm_mesh_view mesh; /* counts, origin, and which arrays there are (pointers without meaning) */
    void *state;         /* of the kind: state_bytes, zero at first, for all runs */
    void *workers;       /* worker_bytes for each of worker_count, zero at first */
    uint32_t worker_count;
} csg_stream_view;

typedef struct csg_stream_kind {
    size_t state_bytes, worker_bytes;
    bool wants_corners; /* csg_mesh_run.corners */
    /* Whether these options give a file that can be filled so. */
    bool (*is_possible)(const csgm_write_options *options);
    /* The counts are known; no run has come. Reports what fails. */
    csgm_status (*begin)(csg_stream_view *stream);
    /* From any thread: false = it failed, and csg_stream_write_at or csg_stream_room knows why. */
    bool (*put)(csg_stream_view *stream, const csg_mesh_run *run);
    /* All runs have come; NULL = nothing is left to do. */
    bool (*end)(csg_stream_view *stream);
} csg_stream_kind;

/* One for each row of formats.def; those exist that the row says. */
#define CSG_FORMAT(ID, name, ...) extern const csg_stream_kind csg_##name##_stream;
#include "io/formats.def"

bool csg_stream_write_at(csg_stream_view *stream, const void *bytes, uint64_t count, uint64_t at);
/* The worker's own buffer for at least so many bytes; NULL = out of memory. */
uint8_t *csg_stream_room(csg_stream_view *stream, uint32_t worker, uint64_t bytes);
/* Memory has run out. */
void csg_stream_no_memory(csg_stream_view *stream);
/* The file ends after so many bytes; those never written are zero. */
bool csg_stream_cut(csg_stream_view *stream, uint64_t size_bytes);

#endif
