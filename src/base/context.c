/* SPDX-License-Identifier: MIT */
#include "base/context.h"

#include "base/mesh_codes.h"

csgm_status csg_context_no_memory(csgm_context *context)
{
    csg_memory *memory = &context->memory;
    if (atomic_exchange(&memory->limit_refused, false))
        csg_diag_plain(
            &context->diags, CSG_DIAG_OUT_OF_MEMORY, NULL,
            "raise the limit with --max-memory, or mesh more coarsely: --quality draft, or a "
            "lower -r",
            "more memory is needed than the limit of %llu MiB",
            (unsigned long long)(memory->limit_bytes >> 20));
    else
        csg_diag_plain(
            &context->diags, CSG_DIAG_OUT_OF_MEMORY, NULL,
            "mesh more coarsely (--quality draft, or a lower -r), or leave more memory to it",
            "the system has no more memory to give: %llu MiB are in use here",
            (unsigned long long)(atomic_load(&memory->used_bytes) >> 20));
    return CSGM_ERR_MEMORY;
}
