/* SPDX-License-Identifier: MIT
 * Exchanges between ranks; see ranks.h.
 */
#include "base/ranks.h"

#include <string.h>

#include "base/mesh_codes.h"

csgm_status csg_ranks_join(csgm_context *context, const csgm_communicator *communicator)
{
    csg_ranks *ranks = csg_memory_alloc(&context->memory, sizeof *ranks);
    if (!ranks)
        return csg_context_no_memory(context);
    size_t count = communicator->count;
    *ranks = (csg_ranks){.by = *communicator,
                         .words = csg_memory_alloc(&context->memory, count * sizeof *ranks->words),
                         .bytes = csg_memory_alloc(&context->memory, count * sizeof *ranks->bytes),
                         .work = {.struct_size = sizeof(csgm_rank_work)}};
    context->ranks = ranks;
    context->diags.errors_only = communicator->rank > 0;
    if (ranks->words && ranks->bytes)
        return CSGM_OK;
    csg_ranks_leave(context);
    return csg_context_no_memory(context);
}

void csg_ranks_leave(csgm_context *context)
{
    csg_ranks *ranks = context->ranks;
    if (!ranks)
        return;
    size_t count = ranks->by.count;
    csg_ranks_end_keeping(context);
    csg_memory_release(&context->memory, ranks->folder, ranks->folder_bytes);
    csg_memory_release(&context->memory, ranks->words, count * sizeof *ranks->words);
    csg_memory_release(&context->memory, ranks->bytes, count * sizeof *ranks->bytes);
    csg_memory_release(&context->memory, ranks, sizeof *ranks);
    context->ranks = NULL;
    context->diags.errors_only = false;
}

void csg_ranks_end_keeping(csgm_context *context)
{
    csg_ranks *ranks = context->ranks;
    if (!ranks)
        return;
    csg_journal_close(&ranks->journal);
    ranks->keeps = false;
}

void csg_ranks_begin_mesh(csgm_context *context)
{
    csg_ranks *ranks = context->ranks;
    if (!ranks)
        return;
    ranks->work = (csgm_rank_work){.struct_size = sizeof ranks->work};
    ranks->is_over = false;
    ranks->over = CSGM_OK;
}

/* From now on all are on their way out. */
static csgm_status end_mesh(csg_ranks *ranks, csgm_status why)
{
    ranks->is_over = true;
    ranks->over = why;
    return why;
}

/* Bytes of all ranks to those that want them; ranks->bytes says how many. */
static csgm_status exchange(csgm_context *context, uint32_t to, const void *piece, void *place)
{
    csg_ranks *ranks = context->ranks;
    const csgm_communicator *by = &ranks->by;
    if (!by->gather(by->user, to, piece, ranks->bytes, place)) {
        csg_diag_plain(&context->diags, CSG_DIAG_RANKS_FAILED, NULL, NULL,
                       "rank %u could not exchange bytes with the others", (unsigned)by->rank);
        return end_mesh(ranks, CSGM_ERR_IO);
    }
    for (uint32_t i = 0; place && i < by->count; i++)
        ranks->work.received_bytes += i != by->rank ? ranks->bytes[i] : 0;
    return CSGM_OK;
}

/* Whether all are at the end of the same loop. What they make is compared before, so this says that
 * something has not come out alike on all. */
static csgm_status compare_loops(csgm_context *context)
{
    const csg_ranks *ranks = context->ranks;
    for (uint32_t i = 1; i < ranks->by.count; i++) {
        if (ranks->words[i].items == ranks->words[0].items)
            continue;
        if (csg_ranks_is_first(context))
            csg_diag_plain(&context->diags, CSG_DIAG_RANKS_FAILED, NULL, NULL,
                           "rank %u has come to another mesh than rank 0", (unsigned)i);
        return CSGM_ERR_INTERNAL;
    }
    return CSGM_OK;
}

/* Everybody's word; CSGM_OK where no rank has failed. */
static csgm_status speak(csgm_context *context, csgm_status own, uint64_t bytes)
{
    csg_ranks *ranks = context->ranks;
    const csg_rank_word word = {.status = (uint64_t)own, .bytes = bytes, .items = ranks->items};
    if (ranks->is_over)
        return own != CSGM_OK ? own : ranks->over;
    for (uint32_t i = 0; i < ranks->by.count; i++)
        ranks->bytes[i] = sizeof word;
    csgm_status status = exchange(context, CSGM_ALL_RANKS, &word, ranks->words);
    for (uint32_t i = 0; i < ranks->by.count && status == CSGM_OK; i++)
        status = (csgm_status)ranks->words[i].status;
    if (status == CSGM_OK)
        status = compare_loops(context);
    if (status != CSGM_OK)
        end_mesh(ranks, status);
    return own != CSGM_OK ? own : status;
}

csgm_status csg_ranks_agree(csgm_context *context, csgm_status own)
{
    return context->ranks ? speak(context, own, 0) : own;
}

csgm_status csg_ranks_say_why(csgm_context *context, csgm_status own)
{
    if (context->ranks)
        context->ranks->is_over = false;
    return csg_ranks_agree(context, own);
}

/* How many bytes all have said to have. */
static uint64_t total_of(csg_ranks *ranks)
{
    uint64_t total = 0;
    for (uint32_t i = 0; i < ranks->by.count; i++)
        total += ranks->bytes[i] = ranks->words[i].bytes;
    return total;
}

csgm_status csg_ranks_gather_into(csgm_context *context, csgm_status own, uint32_t to,
                                  const void *piece, uint64_t bytes, void *place)
{
    csgm_status status = speak(context, own, bytes);
    if (status != CSGM_OK || !total_of(context->ranks))
        return status;
    return exchange(context, to, piece, place);
}

csgm_status csg_ranks_gather(csgm_context *context, csgm_status own, uint32_t to, const void *piece,
                             uint64_t bytes, csg_rank_pieces *out)
{
    csg_ranks *ranks = context->ranks;
    *out = (csg_rank_pieces){0};
    csgm_status status = speak(context, own, bytes);
    if (status != CSGM_OK)
        return status;
    uint64_t total = total_of(ranks);
    if (!total)
        return CSGM_OK;
    if (to == CSGM_ALL_RANKS || to == ranks->by.rank) {
        *out = (csg_rank_pieces){csg_memory_alloc(&context->memory, (size_t)total), total};
        status = out->bytes ? CSGM_OK : csg_context_no_memory(context);
    }
    status = speak(context, status, bytes); /* some may have no room for it */
    if (status == CSGM_OK) {
        total_of(ranks);
        status = exchange(context, to, piece, out->bytes);
    }
    if (status != CSGM_OK)
        csg_rank_pieces_release(&context->memory, out);
    return status;
}

csgm_status csg_ranks_follow(csgm_context *context, csgm_status own, bool *what)
{
    if (!context->ranks)
        return own;
    const bool said = *what;
    return csg_ranks_gather_into(context, own, CSGM_ALL_RANKS, &said,
                                 csg_ranks_is_first(context) ? sizeof said : 0, what);
}

void csg_rank_pieces_release(csg_memory *memory, csg_rank_pieces *pieces)
{
    csg_memory_release(memory, pieces->bytes, pieces->bytes ? (size_t)pieces->total : 0);
    *pieces = (csg_rank_pieces){0};
}
