/* SPDX-License-Identifier: MIT
 * Where the time goes. A zone is a stretch of one thread's work with a name; zones are kept in
 * buffers of their threads and printed as Chrome's trace events. A trace outlives contexts and may
 * be shared by many: each takes as many lanes as it has threads and gives them back, so that
 * a thousand short contexts on four threads fill four lanes and not a thousand.
 *
 * Without a trace nothing is allocated and a zone costs one branch. With one, a zone costs four
 * readings of clocks and no lock: a lane belongs to one thread. Memory is bounded: zones that find
 * no room are counted and left out, whole, so that what is printed still nests.
 */
#ifndef CSG_BASE_TRACE_H
#define CSG_BASE_TRACE_H

#include "base/context.h"

csgm_status csg_trace_create(const csgm_allocator *allocator, uint64_t memory_bytes,
                             csgm_trace **out);
void csg_trace_destroy(csgm_trace *trace);
/* Nobody may be at work in a zone; what is still open is left out. */
void csg_trace_print(csgm_trace *trace, csgm_text_fn *sink, void *user);
uint64_t csg_trace_dropped(const csgm_trace *trace);

/* The lanes of a context with so many threads. NULL: no memory. */
csg_trace_lanes *csg_trace_enter(csgm_trace *trace, uint32_t threads);
/* Its threads have ended; zones still open end here. NULL is a no-op. */
void csg_trace_leave(csg_trace_lanes *lanes);

/* The three below are for the context's calling thread (worker 0) alone. name is static; the note
 * (may be NULL) is copied. Deeper than 64 levels zones are left out. */
void csg_trace_begin(csg_trace_lanes *lanes, const char *name, const char *note);
void csg_trace_count(csg_trace_lanes *lanes, const char *name, uint64_t count);
void csg_trace_end(csg_trace_lanes *lanes);

/* What one worker did of a parallel loop, named as the zone that the loop runs in. */
typedef struct csg_trace_loop {
    const char *name;
    uint64_t start_ns, thread_ns;
} csg_trace_loop;

const char *csg_trace_open_name(const csg_trace_lanes *lanes); /* "" outside of zones */
csg_trace_loop csg_trace_loop_begin(const char *name);
void csg_trace_loop_end(csg_trace_lanes *lanes, uint32_t worker, const csg_trace_loop *loop,
                        uint64_t items);

static inline csg_trace_lanes *csg_zone_begin(csg_trace_lanes *lanes, const char *name)
{
    if (__builtin_expect(lanes != NULL, 0))
        csg_trace_begin(lanes, name, NULL);
    return lanes;
}

static inline void csg_zone_end(csg_trace_lanes *const *lanes)
{
    if (__builtin_expect(*lanes != NULL, 0))
        csg_trace_end(*lanes);
}

/* A count of the innermost open zone: the first four stay. */
static inline void csg_zone_count(const csgm_context *context, const char *name, uint64_t count)
{
    if (__builtin_expect(context->trace != NULL, 0))
        csg_trace_count(context->trace, name, count);
}

/* A zone from here to the end of the braces around it, whichever way they are left. One in each
 * pair of braces, on the calling thread. */
#define CSG_ZONE(context, name)                                                                    \
    csg_trace_lanes *csg_zone_of_these_braces __attribute__((cleanup(csg_zone_end), unused)) =     \
        csg_zone_begin((context)->trace, name)

#endif
