/* SPDX-License-Identifier: MIT
 * What several processes that make one mesh tell each other (csgmesh/ranks.h). Each stage ends with
 * an exchange that begins with everybody's status: where one has failed all stop there, and later
 * exchanges of the same mesh say so at once, so that nobody waits for somebody who is gone. What is
 * called by one rank is called by all, in one order; a rank that fails on the way goes to the end,
 * and meets the others in their next exchange, whichever it is.
 */
#ifndef CSG_BASE_RANKS_H
#define CSG_BASE_RANKS_H

#include "base/context.h"
#include "base/journal.h"
#include "csgmesh/ranks.h"

/* What a rank says at the begin of an exchange. */
typedef struct csg_rank_word {
    uint64_t status, bytes;
    uint64_t items; /* of the loop whose records are exchanged (rank_loop.h); else 0 */
} csg_rank_word;

typedef struct csg_ranks {
    csgm_communicator by;
    csg_rank_word *words; /* one for each rank, of the exchange at hand */
    uint64_t *bytes;      /* of each rank in it */
    uint64_t items; /* the same, of the exchange at hand: ranks that differ have gone astray */
    csgm_rank_work work;
    /* One has failed, or an exchange has, and all know it: of this mesh nothing is exchanged any
     * more, since some are on their way out and others are not there yet. */
    bool is_over;
    csgm_status over; /* how it has ended */
    /* What a later job can go on with (csgm_context_keep). */
    char *folder; /* where: NULL, nothing is kept */
    size_t folder_bytes;
    bool keeps;          /* of the mesh at hand: its file is in the folder */
    bool is_begun;       /* and was there before */
    bool keeps_synced;   /* each record is on the disk before work goes on */
    csg_journal journal; /* of the mesh at hand: what this rank has finished of it */
} csg_ranks;

/* The pieces of all ranks, one after the other. */
typedef struct csg_rank_pieces {
    void *bytes; /* of csg_memory; NULL for none, and where they did not come */
    uint64_t total;
} csg_rank_pieces;

/* context->ranks, made of a communicator that was checked. Reports what fails. */
csgm_status csg_ranks_join(csgm_context *context, const csgm_communicator *communicator);
void csg_ranks_leave(csgm_context *context);

static inline bool csg_ranks_is_first(const csgm_context *context)
{
    return !context->ranks || context->ranks->by.rank == 0;
}

/* Another mesh begins: nothing of it has failed, and no rank has done anything. */
void csg_ranks_begin_mesh(csgm_context *context);
/* The mesh at hand is done with. */
void csg_ranks_end_keeping(csgm_context *context);

/* How a stage ends that this rank has ended with `own`: CSGM_OK where all did; else `own`, or, not
 * reported here, what the first rank says that has failed. A process alone: `own`. */
csgm_status csg_ranks_agree(csgm_context *context, csgm_status own);
/* The same where all come to, whatever has failed before: why it was, if it is known only now. */
csgm_status csg_ranks_say_why(csgm_context *context, csgm_status own);
/* As csg_ranks_agree, and the pieces of all come to rank `to` or to all (CSGM_ALL_RANKS). Only with
 * ranks. */
csgm_status csg_ranks_gather(csgm_context *context, csgm_status own, uint32_t to, const void *piece,
                             uint64_t bytes, csg_rank_pieces *out);
/* The same into a place that has room for them all (NULL where none arrive): how many there are is
 * known. */
csgm_status csg_ranks_gather_into(csgm_context *context, csgm_status own, uint32_t to,
                                  const void *piece, uint64_t bytes, void *place);
/* All do what the first rank says. */
csgm_status csg_ranks_follow(csgm_context *context, csgm_status own, bool *what);
void csg_rank_pieces_release(csg_memory *memory, csg_rank_pieces *pieces);

#endif
