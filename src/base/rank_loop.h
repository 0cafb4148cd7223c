/* SPDX-License-Identifier: MIT
 * Loops whose items are shared out among ranks (ranks.h), over what all of them have: each rank
 * does some of the items, and what an item has made goes to all, as a record of bytes. So all have
 * again what one process has, whoever has done what. Item i is done by rank i modulo their number,
 * since neighbours cost alike; a loop of few items is done by all, which is sooner done than told.
 */
#ifndef CSG_BASE_RANK_LOOP_H
#define CSG_BASE_RANK_LOOP_H

#include "base/pool.h"
#include "base/ranks.h"

/* What an item costs: some tenths of a millisecond, as an exchange does, or some ten times as much
 * and more. */
typedef enum csg_item_size { CSG_ITEMS_SMALL, CSG_ITEMS_LARGE } csg_item_size;

/* Whether a loop of so many items is shared out. A process alone: never. */
bool csg_ranks_share(const csgm_context *context, size_t count, csg_item_size size);
/* Whether an item of a loop that is shared out is this rank's. */
static inline bool csg_ranks_have(const csgm_context *context, size_t item)
{
    const csgm_communicator *by = &context->ranks->by;
    return item % by->count == by->rank;
}

/* csg_pool_run for the items of [0, count) that this rank does; `poll` counts these. */
bool csg_ranks_run(csgm_context *context, size_t count, csg_item_size size, csg_pool_work *work,
                   csg_pool_poll *poll, void *user);

/* Bytes that this rank's items have made, one item after the other in their order. */
typedef struct csg_records {
    uint8_t *bytes; /* of csg_memory */
    size_t count, capacity;
} csg_records;

/* Room for that much more. False: out of memory. */
bool csg_records_reserve(csg_memory *memory, csg_records *records, size_t count);
/* Appends. False: out of memory. */
bool csg_records_add(csg_memory *memory, csg_records *records, const void *bytes, size_t count);

/* Everybody's records of a loop, read item after item. */
typedef struct csg_record_reader {
    csg_rank_pieces pieces;
    uint64_t *at; /* of each rank: where its next record begins */
    uint64_t *end;
    uint32_t ranks;
} csg_record_reader;

/* How a loop of `count` items, shared out, ends that this rank has ended with `own`, as
 * csg_ranks_agree has it; where all did well *out has the records of all, else nothing. This rank's
 * go. Reports what fails here. */
csgm_status csg_ranks_exchange(csgm_context *context, csgm_status own, size_t count,
                               csg_records *records, csg_record_reader *out);
/* The next bytes of the record of an item; what is read of one item after the other must be what
 * was added. */
void csg_record_read(csg_record_reader *reader, size_t item, void *to, size_t count);
/* So many elements of it, behind those of an array of csg_memory. False: out of memory. */
bool csg_record_read_behind(csg_memory *memory, csg_record_reader *reader, size_t item, void **data,
                            size_t *count, size_t *capacity, size_t more, size_t element_bytes);
void csg_record_reader_end(csg_memory *memory, csg_record_reader *reader);

#endif
