/* SPDX-License-Identifier: MIT
 * Processes that make one mesh together: the public face of base/ranks.h.
 */
#include <string.h>

#include "api/options.h"
#include "base/ranks.h"

csgm_communicator csgm_communicator_default(void)
{
    return (csgm_communicator){.struct_size = sizeof(csgm_communicator), .count = 1};
}

csgm_rank_work csgm_rank_work_default(void)
{
    return (csgm_rank_work){.struct_size = sizeof(csgm_rank_work)};
}

void csg_ranks_begin_mesh(csgm_context *context)
{
    if (context->ranks)
        context->ranks->work = csgm_rank_work_default();
}

csgm_status csgm_context_join(csgm_context *context, const csgm_communicator *communicator)
{
    csgm_communicator own = csgm_communicator_default();
    if (!context || !csg_options_adopt(&own, sizeof own, communicator))
        return CSGM_ERR_ARGUMENT;
    if (!own.count || own.count > CSGM_RANKS_MOST || own.rank >= own.count ||
        (own.count > 1 && !own.gather))
        return CSGM_ERR_ARGUMENT;
    csg_ranks_leave(context);
    return own.count > 1 ? csg_ranks_join(context, &own) : CSGM_OK;
}

csgm_status csgm_context_keep(csgm_context *context, const char *folder)
{
    csg_ranks *ranks = context ? context->ranks : NULL;
    if (!ranks || (folder && !folder[0]))
        return CSGM_ERR_ARGUMENT;
    csg_memory_release(&context->memory, ranks->folder, ranks->folder_bytes);
    ranks->folder = NULL;
    ranks->folder_bytes = folder ? strlen(folder) + 1 : 0;
    if (!folder)
        return CSGM_OK;
    ranks->folder = csg_memory_alloc(&context->memory, ranks->folder_bytes);
    if (!ranks->folder)
        return csg_context_no_memory(context);
    memcpy(ranks->folder, folder, ranks->folder_bytes);
    return CSGM_OK;
}

csgm_status csgm_context_rank_work(const csgm_context *context, csgm_rank_work *out)
{
    if (!context || !out || !csg_struct_is_known(out, sizeof *out))
        return CSGM_ERR_ARGUMENT;
    csgm_rank_work made = context->ranks ? context->ranks->work : csgm_rank_work_default();
    csg_struct_deliver(out, &made);
    return CSGM_OK;
}
