/* SPDX-License-Identifier: MIT
 * Traces of the public interface: checks the arguments and calls base.
 */
#include "base/trace.h"

csgm_status csgm_trace_create(const csgm_allocator *allocator, uint64_t memory_bytes,
                              csgm_trace **out)
{
    static const uint64_t USUAL_BYTES = 64 << 20;
    if (!out)
        return CSGM_ERR_ARGUMENT;
    *out = NULL;
    if (allocator && !allocator->alloc != !allocator->release)
        return CSGM_ERR_ARGUMENT;
    return csg_trace_create(allocator, memory_bytes ? memory_bytes : USUAL_BYTES, out);
}

void csgm_trace_destroy(csgm_trace *trace)
{
    csg_trace_destroy(trace);
}

void csgm_trace_begin(csgm_context *context, const char *name, const char *note)
{
    if (context && context->trace && name)
        csg_trace_begin(context->trace, name, note);
}

void csgm_trace_end(csgm_context *context)
{
    if (context && context->trace)
        csg_trace_end(context->trace);
}

csgm_status csgm_trace_print(csgm_trace *trace, csgm_text_fn *sink, void *user)
{
    if (!trace || !sink)
        return CSGM_ERR_ARGUMENT;
    csg_trace_print(trace, sink, user);
    return CSGM_OK;
}

uint64_t csgm_trace_dropped(const csgm_trace *trace)
{
    return csg_trace_dropped(trace);
}
