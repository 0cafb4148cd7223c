/* SPDX-License-Identifier: MIT */
#include "base/context.h"

#include "base/mesh_codes.h"

csgm_status csg_context_no_memory(csgm_context *context)
{
    uint64_t limit = context->memory.limit_bytes;
    csg_diag_plain(&context->diags, CSG_DIAG_OUT_OF_MEMORY, NULL,
                   limit ? "raise the limit with --max-memory, or lower the resolution" : NULL,
                   limit ? "more memory is needed than the limit of %llu MiB" : "out of memory",
                   (unsigned long long)(limit >> 20));
    return CSGM_ERR_MEMORY;
}
