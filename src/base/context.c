/* SPDX-License-Identifier: MIT */
#include "base/context.h"

#include <sys/resource.h>

#include "base/mesh_codes.h"

/* Memory has ended, and nobody has said so yet. */
static csgm_status say_why_ended(csgm_context *context)
{
    csg_memory_end_when(&context->memory, NULL, NULL);
    if (csg_context_is_cancelled(context))
        return CSGM_CANCELLED;
    csg_diag_plain(&context->diags, CSG_DIAG_TIMEOUT, NULL, NULL, "this takes more than %g seconds",
                   context->limits.timeout_s);
    return CSGM_ERR_LIMIT;
}

/* What the system lets this process have at most, where the program or a shell has said so; 0: as
 * much as there is. */
static uint64_t process_limit_bytes(void)
{
    struct rlimit limit;
    return getrlimit(RLIMIT_DATA, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY ? limit.rlim_cur
                                                                                  : 0;
}

csgm_status csg_context_needs_memory(csgm_context *context, uint64_t needed_bytes)
{
    static const uint64_t MIB = 1 << 20;
    csg_diag_plain(&context->diags, CSG_DIAG_OUT_OF_MEMORY, NULL,
                   "raise the limit with --max-memory; a scene takes less with --quality draft, "
                   "and equal cells (-r) go to one PLY, STL or GLB file while they are made",
                   "at least %llu MiB of memory are needed, more than the limit of %llu MiB",
                   (unsigned long long)((needed_bytes + MIB - 1) / MIB),
                   (unsigned long long)(context->memory.limit_bytes / MIB));
    return CSGM_ERR_MEMORY;
}

csgm_status csg_context_no_memory(csgm_context *context)
{
    csg_memory *memory = &context->memory;
    if (csg_memory_has_ended(memory))
        return say_why_ended(context);
    if (atomic_exchange(&memory->limit_refused, false))
        csg_diag_plain(
            &context->diags, CSG_DIAG_OUT_OF_MEMORY, NULL,
            "raise the limit with --max-memory; a scene takes less with --quality draft, or with a "
            "lower -r",
            "more memory is needed than the limit of %llu MiB",
            (unsigned long long)(memory->limit_bytes >> 20));
    else if (process_limit_bytes())
        csg_diag_plain(&context->diags, CSG_DIAG_OUT_OF_MEMORY, NULL,
                       "raise the limit with --max-memory, or that of the shell (ulimit -d)",
                       "more memory is needed, with what libraries take, than the %llu MiB that "
                       "the process may have",
                       (unsigned long long)(process_limit_bytes() >> 20));
    else
        csg_diag_plain(
            &context->diags, CSG_DIAG_OUT_OF_MEMORY, NULL,
            "mesh more coarsely (--quality draft, or a lower -r), or leave more memory to it",
            "the system has no more memory to give: %llu MiB are in use here",
            (unsigned long long)(atomic_load(&memory->used_bytes) >> 20));
    return CSGM_ERR_MEMORY;
}
