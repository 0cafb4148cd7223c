/* SPDX-License-Identifier: MIT
 * Sharing out, and telling what was made; see rank_loop.h.
 */
#include "base/rank_loop.h"

#include <assert.h>
#include <string.h>

bool csg_ranks_share(const csgm_context *context, size_t count, csg_item_size size)
{
    enum { LEAST_SMALL = 3 /* of each rank */, LEAST_LARGE = 2 /* in all */ };
    const csg_ranks *ranks = context->ranks;
    return ranks &&
           count >= (size == CSG_ITEMS_LARGE ? LEAST_LARGE : (size_t)LEAST_SMALL * ranks->by.count);
}

/* ---- doing -------------------------------------------------------------------------------------
 */

typedef struct share {
    csg_pool_work *work;
    csg_pool_poll *poll;
    void *user;
    size_t first, step;
} share;

static bool do_own(void *user, uint32_t worker, size_t index)
{
    const share *s = user;
    return s->work(s->user, worker, s->first + index * s->step);
}

static void poll_own(void *user, size_t done, size_t count)
{
    const share *s = user;
    s->poll(s->user, done, count);
}

/* How many items of a loop that is shared out are this rank's. */
static size_t share_of(const csg_ranks *ranks, size_t count)
{
    return ranks->by.rank < count ? (count - ranks->by.rank - 1) / ranks->by.count + 1 : 0;
}

bool csg_ranks_run(csgm_context *context, size_t count, csg_item_size size, csg_pool_work *work,
                   csg_pool_poll *poll, void *user)
{
    const csg_ranks *ranks = context->ranks;
    if (!csg_ranks_share(context, count, size))
        return csg_pool_run(context->pool, count, work, poll, user);
    share own = {work, poll, user, ranks->by.rank, ranks->by.count};
    size_t share_count = share_of(ranks, count);
    return csg_pool_run(context->pool, share_count, do_own, poll ? poll_own : NULL, &own);
}

/* ---- telling -----------------------------------------------------------------------------------
 */

bool csg_records_reserve(csg_memory *memory, csg_records *records, size_t count)
{
    return csg_memory_reserve(memory, (void **)&records->bytes, &records->capacity,
                              records->count + count, 1);
}

bool csg_records_add(csg_memory *memory, csg_records *records, const void *bytes, size_t count)
{
    if (!count)
        return true;
    if (!csg_records_reserve(memory, records, count))
        return false;
    memcpy(records->bytes + records->count, bytes, count);
    records->count += count;
    return true;
}

/* Where the records of each rank begin and end. */
static csgm_status find_places(csgm_context *context, csg_record_reader *reader)
{
    const csg_ranks *ranks = context->ranks;
    uint64_t at = 0;
    reader->ranks = ranks->by.count;
    reader->at = csg_memory_alloc(&context->memory, 2 * (size_t)reader->ranks * sizeof *reader->at);
    if (!reader->at)
        return csg_context_no_memory(context);
    reader->end = reader->at + reader->ranks;
    for (uint32_t i = 0; i < reader->ranks; i++) {
        reader->at[i] = at;
        at += reader->pieces.total ? ranks->bytes[i] : 0;
        reader->end[i] = at;
    }
    return CSGM_OK;
}

csgm_status csg_ranks_exchange(csgm_context *context, csgm_status own, size_t count,
                               csg_records *records, csg_record_reader *out)
{
    *out = (csg_record_reader){0};
    context->ranks->items = count;
    context->ranks->work.tasks += own == CSGM_OK ? share_of(context->ranks, count) : 0;
    csgm_status status = csg_ranks_gather(context, own, CSGM_ALL_RANKS, records->bytes,
                                          records->count, &out->pieces);
    context->ranks->items = 0;
    csg_memory_release(&context->memory, records->bytes, records->capacity);
    *records = (csg_records){0};
    if (status == CSGM_OK)
        status = find_places(context, out);
    if (status != CSGM_OK)
        csg_record_reader_end(&context->memory, out);
    return status;
}

void csg_record_read(csg_record_reader *reader, size_t item, void *to, size_t count)
{
    uint64_t *at = &reader->at[item % reader->ranks];
    assert(*at + count <= reader->end[item % reader->ranks]);
    if (count)
        memcpy(to, (const uint8_t *)reader->pieces.bytes + *at, count);
    *at += count;
}

bool csg_record_read_behind(csg_memory *memory, csg_record_reader *reader, size_t item, void **data,
                            size_t *count, size_t *capacity, size_t more, size_t element_bytes)
{
    if (!csg_memory_reserve(memory, data, capacity, *count + more, element_bytes))
        return false;
    if (more)
        csg_record_read(reader, item, (uint8_t *)*data + *count * element_bytes,
                        more * element_bytes);
    *count += more;
    return true;
}

void csg_record_reader_end(csg_memory *memory, csg_record_reader *reader)
{
    csg_memory_release(memory, reader->at, 2 * (size_t)reader->ranks * sizeof *reader->at);
    csg_rank_pieces_release(memory, &reader->pieces);
    *reader = (csg_record_reader){0};
}
