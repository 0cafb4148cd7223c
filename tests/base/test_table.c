/* SPDX-License-Identifier: MIT
 * Tables of numbers: what was put in is found and nothing else, however bad the hashes are and
 * wherever memory runs out; hashes are those that are published.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "base/table.h"

enum { COUNT = 5000 };

static uint64_t key_of(uint32_t i)
{
    return (uint64_t)i * 0x100000000u + i % 7;
}

static uint64_t good_hash(const void *entries, uint32_t number)
{
    return ((const uint64_t *)entries)[number];
}

/* All entries on three slots' ways. */
static uint64_t bad_hash(const void *entries, uint32_t number)
{
    return ((const uint64_t *)entries)[number] % 3;
}

static uint32_t find(const csg_table *table, csg_table_hash *hash, const uint64_t *entries,
                     uint64_t key, size_t *slot)
{
    uint32_t found = csg_table_first(table, hash(&key, 0), slot);
    while (found != CSG_TABLE_NONE && entries[found] != key)
        found = csg_table_next(table, slot);
    return found;
}

static void fill_and_find(csg_table_hash *hash, uint32_t count)
{
    static uint64_t entries[COUNT];
    csg_memory memory;
    csg_table table;
    size_t slot;
    csg_memory_init(&memory, NULL, 0);
    csg_table_init(&table, &memory);
    for (uint32_t i = 0; i < count; i++) {
        assert_true(csg_table_reserve(&table, i + 1, hash, entries));
        assert_true(table.size >= 2 * (size_t)(i + 1));
        assert_int_equal(find(&table, hash, entries, key_of(i), &slot), CSG_TABLE_NONE);
        entries[i] = key_of(i);
        if (i % 2)
            csg_table_put(&table, slot, i);
        else
            csg_table_add(&table, hash(entries, i), i);
    }
    for (uint32_t i = 0; i < count; i++)
        assert_int_equal(find(&table, hash, entries, key_of(i), &slot), i);
    assert_int_equal(find(&table, hash, entries, key_of(count), &slot), CSG_TABLE_NONE);
    csg_table_release(&table);
    assert_int_equal(atomic_load(&memory.used_bytes), 0);
}

static void test_find(void **state)
{
    fill_and_find(good_hash, COUNT);
    fill_and_find(bad_hash, 500);
}

static void test_no_memory(void **state)
{
    uint64_t entries[33] = {0};
    csg_memory memory;
    csg_table table;
    size_t slot;
    csg_memory_init(&memory, NULL, 64 * sizeof(uint32_t));
    csg_table_init(&table, &memory);
    assert_true(csg_table_reserve(&table, 32, NULL, NULL));
    for (uint32_t i = 0; i < 32; i++) {
        entries[i] = key_of(i);
        csg_table_add(&table, good_hash(entries, i), i);
    }
    assert_false(csg_table_reserve(&table, 33, good_hash, entries));
    for (uint32_t i = 0; i < 32; i++)
        assert_int_equal(find(&table, good_hash, entries, key_of(i), &slot), i);
    csg_table_release(&table);
    csg_table_release(&table);
    assert_int_equal(atomic_load(&memory.used_bytes), 0);
}

static void test_hashes(void **state)
{
    assert_true(csg_hash_bytes(CSG_HASH_START, "", 0) == 0xCBF29CE484222325u);
    assert_true(csg_hash_bytes(CSG_HASH_START, "a", 1) == 0xAF63DC4C8601EC8Cu);
    assert_true(csg_hash_bytes(CSG_HASH_START, "foobar", 6) == 0x85944171F73967E8u);
    assert_true(csg_hash_word(csg_hash_word(0, 1), 2) != csg_hash_word(csg_hash_word(0, 2), 1));
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_find),
                                       cmocka_unit_test(test_no_memory),
                                       cmocka_unit_test(test_hashes)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
