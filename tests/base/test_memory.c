/* SPDX-License-Identifier: MIT
 * Memory is counted and limited; arenas hand out aligned room, give all of it back, and return to
 * marks.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/memory.h"
#include "base/random.h"

static uint64_t used(csg_memory *memory)
{
    return atomic_load(&memory->used_bytes);
}

static void test_counts(void **state)
{
    csg_memory memory;
    csg_memory_init(&memory, NULL, 0);
    void *a = csg_memory_alloc(&memory, 100), *b = csg_memory_alloc(&memory, 50);
    assert_int_equal(used(&memory), 150);
    csg_memory_release(&memory, a, 100);
    csg_memory_release(&memory, NULL, 7);
    assert_int_equal(used(&memory), 50);
    csg_memory_release(&memory, b, 50);
    assert_int_equal(used(&memory), 0);
    assert_int_equal(atomic_load(&memory.peak_bytes), 150);
}

static void test_limit(void **state)
{
    csg_memory memory;
    csg_memory_init(&memory, NULL, 1000);
    void *a = csg_memory_alloc(&memory, 600);
    assert_non_null(a);
    assert_null(csg_memory_alloc(&memory, 401));
    assert_int_equal(used(&memory), 600);
    void *b = csg_memory_alloc(&memory, 400);
    assert_non_null(b);
    csg_memory_release(&memory, a, 600);
    csg_memory_release(&memory, b, 400);
    assert_int_equal(used(&memory), 0);
    assert_int_equal(atomic_load(&memory.peak_bytes), 1000);
}

static void *refuse(void *user, size_t size)
{
    *(int *)user += 1;
    return NULL;
}

static void keep(void *user, void *memory, size_t size)
{
}

static bool ends_at_zero(void *user)
{
    int *left = user;
    return (*left)-- <= 0;
}

static void test_end(void **state)
{
    csg_memory memory;
    size_t capacity = 0;
    void *data = NULL;
    int left = 2;
    csg_memory_init(&memory, NULL, 0);
    assert_false(csg_memory_has_ended(&memory));
    csg_memory_end_when(&memory, ends_at_zero, &left);
    void *a = csg_memory_alloc(&memory, 5000), *b = csg_memory_alloc(&memory, 10);
    assert_int_equal(left, 1); /* small blocks are given without asking */
    assert_false(csg_memory_has_ended(&memory));
    assert_null(csg_memory_alloc(&memory, 5000));
    assert_false(csg_memory_reserve(&memory, &data, &capacity, 5000, 1));
    left = 100; /* it stays so */
    assert_true(csg_memory_has_ended(&memory));
    assert_int_equal(used(&memory), 5010);
    csg_memory_end_when(&memory, NULL, NULL);
    assert_true(csg_memory_reserve(&memory, &data, &capacity, 5000, 1));
    csg_memory_release(&memory, data, capacity);
    csg_memory_release(&memory, a, 5000);
    csg_memory_release(&memory, b, 10);
    assert_int_equal(used(&memory), 0);
}

static void test_own_allocator(void **state)
{
    int calls = 0;
    csgm_allocator allocator = {refuse, keep, &calls};
    csg_memory memory;
    csg_memory_init(&memory, &allocator, 0);
    assert_null(csg_memory_alloc(&memory, 10));
    assert_int_equal(calls, 1);
    assert_int_equal(used(&memory), 0);
}

static void test_reserve(void **state)
{
    csg_memory memory;
    csg_memory_init(&memory, NULL, 4000);
    void *data = NULL;
    size_t capacity = 0;
    for (uint32_t i = 0; i < 100; i++) {
        assert_true(csg_memory_reserve(&memory, &data, &capacity, i + 1, sizeof i));
        ((uint32_t *)data)[i] = i;
    }
    for (uint32_t i = 0; i < 100; i++)
        assert_int_equal(((uint32_t *)data)[i], i);
    void *before = data;
    size_t had = capacity;
    assert_false(csg_memory_reserve(&memory, &data, &capacity, 1001, sizeof(uint32_t)));
    assert_false(csg_memory_reserve(&memory, &data, &capacity, SIZE_MAX / 2, sizeof(uint32_t)));
    assert_ptr_equal(data, before); /* nothing changed */
    assert_int_equal(capacity, had);
    csg_memory_release(&memory, data, capacity * sizeof(uint32_t));
    assert_int_equal(used(&memory), 0);
}

/* By half, and by an eighth from four megabytes on. */
static void test_reserve_grows(void **state)
{
    enum { MEGABYTE = 1 << 20 };
    csg_memory memory;
    csg_memory_init(&memory, NULL, 0);
    void *data = NULL;
    size_t capacity = 0;
    assert_true(csg_memory_reserve(&memory, &data, &capacity, 1000, 8));
    assert_int_equal(capacity, 1000);
    assert_true(csg_memory_reserve(&memory, &data, &capacity, 1001, 8));
    assert_int_equal(capacity, 1500);
    assert_true(csg_memory_reserve(&memory, &data, &capacity, MEGABYTE, 8));
    assert_true(csg_memory_reserve(&memory, &data, &capacity, MEGABYTE + 1, 8));
    assert_int_equal(capacity, MEGABYTE + MEGABYTE / 8);
    assert_int_equal(used(&memory), 8 * capacity);
    csg_memory_release(&memory, data, 8 * capacity);
    assert_int_equal(used(&memory), 0);
}

static void test_arena_room(void **state)
{
    csg_memory memory;
    csg_arena arena;
    csg_memory_init(&memory, NULL, 0);
    csg_arena_init(&arena, &memory);
    csg_random random = {1};
    uint8_t *pieces[500];
    size_t sizes[500];
    for (int i = 0; i < 500; i++) { /* none overlaps another */
        sizes[i] = csg_random_below(&random, i % 50 ? 300 : 100000);
        pieces[i] = csg_arena_alloc(&arena, sizes[i]);
        assert_non_null(pieces[i]);
        assert_int_equal((uintptr_t)pieces[i] % 16, 0);
        memset(pieces[i], i & 255, sizes[i]);
    }
    for (int i = 0; i < 500; i++)
        for (size_t k = 0; k < sizes[i]; k++)
            assert_int_equal(pieces[i][k], i & 255);
    csg_arena_reset(&arena);
    assert_int_equal(used(&memory), 0);
    assert_non_null(csg_arena_alloc(&arena, 1)); /* still usable */
    csg_arena_reset(&arena);
}

static void test_arena_text(void **state)
{
    csg_memory memory;
    csg_arena arena;
    csg_memory_init(&memory, NULL, 0);
    csg_arena_init(&arena, &memory);
    assert_string_equal(csg_arena_strndup(&arena, "abcdef", 3), "abc");
    assert_string_equal(csg_arena_strndup(&arena, "", 0), "");
    assert_string_equal(csg_arena_printf(&arena, "%d %s", 42, "x"), "42 x");
    const uint8_t *zeroed = csg_arena_calloc(&arena, 10, 7);
    for (int i = 0; i < 70; i++)
        assert_int_equal(zeroed[i], 0);
    assert_null(csg_arena_calloc(&arena, SIZE_MAX / 2, 3));
    assert_null(csg_arena_alloc(&arena, SIZE_MAX - 4));
    csg_arena_reset(&arena);
    assert_int_equal(used(&memory), 0);
}

static void test_arena_marks(void **state)
{
    csg_memory memory;
    csg_arena arena;
    csg_memory_init(&memory, NULL, 0);
    csg_arena_init(&arena, &memory);
    csg_arena_mark empty = csg_arena_get_mark(&arena);
    char *kept = csg_arena_strndup(&arena, "kept", 4);
    csg_arena_mark mark = csg_arena_get_mark(&arena);
    uint64_t most = 0;
    for (int round = 0; round < 200; round++) {
        for (int i = 0; i < 40; i++)
            assert_non_null(csg_arena_alloc(&arena, 1000));
        csg_arena_release_to(&arena, mark);
        if (round == 2)
            most = used(&memory);
        assert_true(round < 2 || used(&memory) <= most); /* no growth from round to round */
    }
    assert_string_equal(kept, "kept");
    csg_arena_release_to(&arena, empty);
    csg_arena_reset(&arena);
    assert_int_equal(used(&memory), 0);
}

static void test_arena_limit(void **state)
{
    csg_memory memory;
    csg_arena arena;
    csg_memory_init(&memory, NULL, 100000);
    csg_arena_init(&arena, &memory);
    int pieces = 0;
    while (csg_arena_alloc(&arena, 1000))
        pieces++;
    assert_in_range(pieces, 20, 100);
    assert_null(csg_arena_printf(&arena, "%90000d", 1));
    csg_arena_reset(&arena);
    assert_int_equal(used(&memory), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_counts),      cmocka_unit_test(test_limit),
        cmocka_unit_test(test_end),         cmocka_unit_test(test_own_allocator),
        cmocka_unit_test(test_reserve),     cmocka_unit_test(test_reserve_grows),
        cmocka_unit_test(test_arena_room),  cmocka_unit_test(test_arena_text),
        cmocka_unit_test(test_arena_marks), cmocka_unit_test(test_arena_limit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
