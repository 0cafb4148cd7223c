/* SPDX-License-Identifier: MIT
 * What every layer shares for one user: memory, findings, limits, workers.
 */
#ifndef CSG_BASE_CONTEXT_H
#define CSG_BASE_CONTEXT_H

#include <errno.h>

#include "base/diagnostics.h"
#include "base/memory.h"

typedef struct csg_pool csg_pool;
typedef struct csg_trace_lanes csg_trace_lanes;
typedef struct csg_survey csg_survey;
typedef struct csg_held_file csg_held_file;
typedef struct csg_ranks csg_ranks;

struct csgm_context {
    csg_memory memory;
    csg_diag_sink diags;
    csgm_limits limits;
    csgm_text_fn *on_echo;         /* NULL = dropped */
    bool (*cancelled)(void *user); /* NULL = nobody asks to stop */
    void *cancel_user;
    csgm_file_fn *on_file; /* NULL = nobody follows files */
    void *file_user;
    void *user;
    csgm_isa isa;           /* never AUTO */
    csg_pool *pool;         /* threads = 1: still a pool, of the caller alone */
    bool holds_files;       /* files get their names all at once (io/file.h) */
    csg_held_file *held;    /* those that wait for that, the last first */
    csg_trace_lanes *trace; /* NULL = nobody wants to know where the time goes (trace.h) */
    csg_survey *survey;     /* NULL = nor what meshes are made from (mesh/pipeline/survey.h) */
    csg_ranks *ranks;       /* NULL = this process is alone (ranks.h) */
};

/* Has the caller said that this context's calls shall stop? On any thread. */
static inline bool csg_context_is_cancelled(const csgm_context *context)
{
    return context->cancelled && context->cancelled(context->cancel_user);
}

/* A file was looked for; errno stays what it is. */
static inline void csg_context_tell_file(const csgm_context *context, const char *path,
                                         bool is_there)
{
    int error = errno;
    if (context->on_file)
        context->on_file(context->file_user, path, is_there);
    errno = error;
}

/* Reports CSG_DIAG_OUT_OF_MEMORY and returns CSGM_ERR_MEMORY; where memory was refused since it was
 * time to end (csg_memory_end_when), says that instead and returns CSGM_ERR_LIMIT, or
 * CSGM_CANCELLED, and memory is to be had again. */
csgm_status csg_context_no_memory(csgm_context *context);
/* The same before it is refused: so many bytes are certain to be needed, more than the limit. */
csgm_status csg_context_needs_memory(csgm_context *context, uint64_t needed_bytes);

#endif
