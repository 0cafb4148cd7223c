/* SPDX-License-Identifier: MIT
 * The pool runs every item once whatever the number of threads, stops when work says so, polls on
 * the calling thread only, and gives its memory back.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <pthread.h>
#include <stdatomic.h>
#include <string.h>

#include "base/pool.h"

enum { ITEMS = 5000, MOST_THREADS = 8 };

typedef struct job {
    uint8_t times[ITEMS];
    uint64_t results[ITEMS];
    atomic_uint per_worker[MOST_THREADS];
    atomic_uint begun;
    size_t stop_at; /* item that returns false */
    pthread_t caller;
    size_t polls, last_done;
} job;

static job j;

static bool work(void *user, uint32_t worker, size_t index)
{
    job *self = user;
    self->times[index]++;
    self->results[index] = (uint64_t)index * index;
    atomic_fetch_add(&self->per_worker[worker], 1);
    atomic_fetch_add(&self->begun, 1);
    return index != self->stop_at;
}

static void poll(void *user, size_t done, size_t count)
{
    job *self = user;
    assert_true(pthread_equal(pthread_self(), self->caller));
    assert_int_equal(count, ITEMS);
    assert_true(done >= self->last_done && done <= count);
    self->last_done = done;
    self->polls++;
}

static void reset(void)
{
    memset(&j, 0, sizeof j);
    j.stop_at = SIZE_MAX;
    j.caller = pthread_self();
}

static void test_every_item_once(void **state)
{
    csg_memory memory;
    csg_memory_init(&memory, NULL, 0);
    for (uint32_t threads = 1; threads <= MOST_THREADS; threads++) {
        csg_pool *pool = csg_pool_create(&memory, threads);
        assert_non_null(pool);
        assert_in_range(csg_pool_threads(pool), 1, threads);
        for (int round = 0; round < 20; round++) { /* the pool is used again */
            reset();
            assert_true(csg_pool_run(pool, ITEMS, work, poll, &j));
            assert_int_equal(j.polls, j.per_worker[0]);
            for (size_t i = 0; i < ITEMS; i++) {
                assert_int_equal(j.times[i], 1);
                assert_int_equal(j.results[i], i * i);
            }
            for (uint32_t k = csg_pool_threads(pool); k < MOST_THREADS; k++)
                assert_int_equal(j.per_worker[k], 0);
        }
        csg_pool_destroy(pool);
        assert_int_equal(atomic_load(&memory.used_bytes), 0);
    }
}

static void test_rest(void **state)
{
    csg_memory memory;
    csg_memory_init(&memory, NULL, 0);
    csg_pool *pool = csg_pool_create(&memory, 4);
    uint32_t threads = csg_pool_threads(pool);
    for (int round = 0; round < 5; round++) {
        csg_pool_rest(pool);
        csg_pool_rest(pool); /* nobody is there to be ended */
        for (int run = 0; run < 3; run++) {
            reset();
            assert_true(csg_pool_run(pool, ITEMS, work, NULL, &j));
            for (size_t i = 0; i < ITEMS; i++)
                assert_int_equal(j.times[i], 1);
            for (uint32_t k = threads; k < MOST_THREADS; k++)
                assert_int_equal(j.per_worker[k], 0);
        }
        assert_int_equal(csg_pool_threads(pool), threads);
    }
    csg_pool_rest(pool);
    csg_pool_destroy(pool);
    assert_int_equal(atomic_load(&memory.used_bytes), 0);
}

static void test_few_items(void **state)
{
    csg_memory memory;
    csg_memory_init(&memory, NULL, 0);
    csg_pool *pool = csg_pool_create(&memory, 4);
    reset();
    assert_true(csg_pool_run(pool, 0, work, NULL, &j));
    assert_int_equal(j.begun, 0);
    assert_true(csg_pool_run(pool, 1, work, NULL, &j));
    assert_int_equal(j.begun, 1);
    assert_int_equal(j.per_worker[0], 1); /* not worth waking anyone */
    csg_pool_destroy(pool);
}

static void test_stop(void **state)
{
    csg_memory memory;
    csg_memory_init(&memory, NULL, 0);
    for (uint32_t threads = 1; threads <= 4; threads += 3) {
        csg_pool *pool = csg_pool_create(&memory, threads);
        reset();
        j.stop_at = 10;
        assert_false(csg_pool_run(pool, ITEMS, work, NULL, &j));
        assert_true(j.begun < ITEMS);
        for (size_t i = 0; i <= 10; i++)
            assert_int_equal(j.times[i], 1); /* claimed in order */
        if (threads == 1)
            assert_int_equal(j.begun, 11);
        reset();
        assert_true(csg_pool_run(pool, ITEMS, work, NULL, &j)); /* none of it is left over */
        assert_int_equal(j.begun, ITEMS);
        csg_pool_destroy(pool);
    }
}

static void test_no_memory(void **state)
{
    csg_memory memory;
    csg_memory_init(&memory, NULL, 16);
    assert_null(csg_pool_create(&memory, 2));
    assert_int_equal(atomic_load(&memory.used_bytes), 0);
    csg_pool_destroy(NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_item_once), cmocka_unit_test(test_rest),
        cmocka_unit_test(test_few_items),       cmocka_unit_test(test_stop),
        cmocka_unit_test(test_no_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
