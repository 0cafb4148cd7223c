/* SPDX-License-Identifier: MIT
 * Loops shared out among ranks, which are threads here: whoever has done an item, all have what it
 * has made; where one fails, or has come to another loop, all end, and nothing is exchanged any
 * more.
 */
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/context.h"
#include "base/random.h"
#include "base/rank_loop.h"

enum { MOST_RANKS = 5, MOST_ITEMS = 200, LONGEST = 40 };

typedef struct table {
    pthread_barrier_t barrier;
    uint32_t count;
    const void *own[MOST_RANKS];
    int exchanges;
} table;

typedef struct rank {
    table *table;
    uint32_t index;
    uint64_t seed;
    size_t items;
    csg_item_size size;
    csgm_status own; /* how its loop ends */
    /* what came of it */
    csgm_status status, again; /* again: of an exchange after it */
    uint8_t done[MOST_ITEMS];
    uint64_t sums[MOST_ITEMS];
    uint64_t tasks;
    uint32_t errors;
} rank;

static bool gather(void *user, uint32_t to, const void *own, const uint64_t *bytes, void *all)
{
    rank *r = user;
    table *t = r->table;
    (void)to;
    t->own[r->index] = own;
    pthread_barrier_wait(&t->barrier);
    uint8_t *at = all;
    for (uint32_t i = 0; i < t->count; i++) {
        if (bytes[i])
            memcpy(at, t->own[i], bytes[i]);
        at += bytes[i];
    }
    if (r->index == 0)
        t->exchanges++;
    pthread_barrier_wait(&t->barrier);
    return true;
}

/* What an item makes: some bytes, of some none. */
static size_t make(uint64_t seed, size_t item, uint8_t out[LONGEST])
{
    csg_random random = (csg_random){seed + item};
    size_t count = csg_random_below(&random, LONGEST);
    for (size_t i = 0; i < count; i++)
        out[i] = (uint8_t)csg_random_below(&random, 256);
    return count;
}

static uint64_t sum(const uint8_t *bytes, size_t count)
{
    uint64_t hash = count;
    for (size_t i = 0; i < count; i++)
        hash = hash * 31 + bytes[i];
    return hash;
}

static bool do_item(void *user, uint32_t worker, size_t item)
{
    rank *r = user;
    uint8_t bytes[LONGEST];
    (void)worker;
    r->done[item]++;
    r->sums[item] = sum(bytes, make(r->seed, item, bytes));
    return true;
}

static void count_error(void *user, const csgm_diag *diag)
{
    rank *r = user;
    r->errors += diag->severity == CSGM_ERROR;
}

/* A record is its length, then its bytes in two readings. */
static void share_and_tell(rank *r, csgm_context *context)
{
    csg_records records = {0};
    csg_record_reader reader;
    uint8_t bytes[LONGEST];
    for (size_t i = 0; i < r->items; i++) {
        if (!csg_ranks_have(context, i))
            continue;
        uint32_t count = (uint32_t)make(r->seed, i, bytes);
        assert_true(csg_records_add(&context->memory, &records, &count, sizeof count));
        assert_true(csg_records_add(&context->memory, &records, bytes, count));
    }
    r->status = csg_ranks_exchange(context, r->own, r->items, &records, &reader);
    for (size_t i = 0; i < r->items && r->status == CSGM_OK; i++) {
        uint32_t count;
        csg_record_read(&reader, i, &count, sizeof count);
        csg_record_read(&reader, i, bytes, count / 2);
        csg_record_read(&reader, i, bytes + count / 2, count - count / 2);
        r->sums[i] = sum(bytes, count);
    }
    csg_record_reader_end(&context->memory, &reader);
    r->again = csg_ranks_agree(context, CSGM_OK);
}

static void *live(void *user)
{
    rank *r = user;
    csgm_context context = {.diags = {.on_diag = count_error, .user = r}};
    csg_memory_init(&context.memory, NULL, 0);
    const csgm_communicator by = {.struct_size = sizeof by,
                                  .rank = r->index,
                                  .count = r->table->count,
                                  .gather = gather,
                                  .user = r};
    context.pool = csg_pool_create(&context.memory, 1 + r->index % 2);
    if (!context.pool || csg_ranks_join(&context, &by) != CSGM_OK)
        abort();
    csg_ranks_begin_mesh(&context);
    bool shares = csg_ranks_share(&context, r->items, r->size);
    if (!csg_ranks_run(&context, r->items, r->size, do_item, NULL, r))
        abort();
    if (shares)
        share_and_tell(r, &context);
    r->tasks = context.ranks->work.tasks;
    csg_ranks_leave(&context);
    csg_pool_destroy(context.pool);
    if (context.memory.used_bytes)
        abort();
    return NULL;
}

static void run_all(rank *ranks, uint32_t count, table *t)
{
    pthread_t threads[MOST_RANKS];
    t->count = count;
    pthread_barrier_init(&t->barrier, NULL, count);
    for (uint32_t i = 0; i < count; i++) {
        ranks[i].table = t;
        ranks[i].index = i;
        assert_int_equal(pthread_create(&threads[i], NULL, live, &ranks[i]), 0);
    }
    for (uint32_t i = 0; i < count; i++)
        pthread_join(threads[i], NULL);
    pthread_barrier_destroy(&t->barrier);
}

static void test_all_have_all(void **state)
{
    csg_random random = (csg_random){20261128};
    (void)state;
    for (int round = 0; round < 60; round++) {
        static rank ranks[MOST_RANKS];
        table t = {.exchanges = 0};
        uint32_t count = 2 + (uint32_t)csg_random_below(&random, MOST_RANKS - 1);
        size_t items = csg_random_below(&random, MOST_ITEMS);
        csg_item_size size = round % 2 ? CSG_ITEMS_SMALL : CSG_ITEMS_LARGE;
        memset(ranks, 0, sizeof ranks);
        for (uint32_t i = 0; i < count; i++)
            ranks[i] = (rank){.seed = (uint64_t)round * 1000, .items = items, .size = size};
        run_all(ranks, count, &t);
        bool shared = items >= (size == CSG_ITEMS_LARGE ? 2 : 3 * (size_t)count);
        assert_int_equal(t.exchanges > 0, shared);
        uint64_t tasks = 0;
        for (size_t k = 0; k < items; k++) {
            uint32_t done = 0;
            for (uint32_t i = 0; i < count; i++) {
                uint8_t bytes[LONGEST];
                done += ranks[i].done[k];
                assert_int_equal(ranks[i].sums[k], sum(bytes, make(ranks[i].seed, k, bytes)));
            }
            assert_int_equal(done, shared ? 1 : count);
        }
        for (uint32_t i = 0; i < count; i++) {
            assert_int_equal(ranks[i].status, CSGM_OK);
            tasks += ranks[i].tasks;
        }
        assert_int_equal(tasks, shared ? items : 0);
    }
}

static void test_one_fails(void **state)
{
    (void)state;
    for (uint32_t weak = 0; weak < 3; weak++) {
        rank ranks[3];
        table t = {.exchanges = 0};
        for (uint32_t i = 0; i < 3; i++)
            ranks[i] = (rank){.items = 20, .own = i == weak ? CSGM_ERR_MEMORY : CSGM_OK};
        run_all(ranks, 3, &t);
        assert_int_equal(t.exchanges, 1); /* words, and nothing after them */
        for (uint32_t i = 0; i < 3; i++) {
            assert_int_equal(ranks[i].status, CSGM_ERR_MEMORY);
            assert_int_equal(ranks[i].again, CSGM_ERR_MEMORY);
        }
    }
}

static void test_other_loop(void **state)
{
    rank ranks[3];
    table t = {.exchanges = 0};
    (void)state;
    for (uint32_t i = 0; i < 3; i++)
        ranks[i] = (rank){.items = i == 1 ? 31 : 30};
    run_all(ranks, 3, &t);
    for (uint32_t i = 0; i < 3; i++) {
        assert_int_equal(ranks[i].status, CSGM_ERR_INTERNAL);
        assert_int_equal(ranks[i].again, CSGM_ERR_INTERNAL);
        assert_int_equal(ranks[i].errors, i == 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_all_have_all),
        cmocka_unit_test(test_one_fails),
        cmocka_unit_test(test_other_loop),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
