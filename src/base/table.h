/* SPDX-License-Identifier: MIT
 * Numbers found by hashes: open addressing with linear probing, at most half full. As a rule the
 * numbers are places of entries in an array of the caller, who says when two entries are equal:
 *
 *     size_t slot;
 *     uint32_t found = csg_table_first(&table, hash, &slot);
 *     while (found != CSG_TABLE_NONE && !is_equal(&entries[found], key))
 *         found = csg_table_next(&table, &slot);
 *     if (found == CSG_TABLE_NONE)
 *         csg_table_put(&table, slot, fresh);
 *
 * Nothing can be taken out. What is found does not depend on the hash function or on the size, so
 * neither can show in a mesh.
 */
#ifndef CSG_BASE_TABLE_H
#define CSG_BASE_TABLE_H

#include <string.h>

#include "base/memory.h"

#define CSG_TABLE_NONE UINT32_MAX

typedef struct csg_table {
    csg_memory *memory;
    uint32_t *slots; /* CSG_TABLE_NONE = free */
    size_t size;     /* a power of two, or 0 */
} csg_table;

/* The hash of entry `number` of the caller's `entries`. */
typedef uint64_t csg_table_hash(const void *entries, uint32_t number);

static inline void csg_table_init(csg_table *table, csg_memory *memory)
{
    *table = (csg_table){.memory = memory};
}

void csg_table_release(csg_table *table);

bool csg_table_grow(csg_table *table, size_t count, csg_table_hash *hash, const void *entries);

/* Grows by doubling until `count` numbers, at least 1, have room. Those that are there are put anew
 * by their hashes; `hash` may be NULL for a table that is still empty. Searches need room for 1. */
static inline bool csg_table_reserve(csg_table *table, size_t count, csg_table_hash *hash,
                                     const void *entries)
{
    return 2 * count <= table->size || csg_table_grow(table, count, hash, entries);
}

/* Looks first where a number with this hash would be; *slot is where it looks. Hashes need not be
 * well mixed: they are multiplied by 2^64 over the golden ratio (Fibonacci hashing). */
static inline uint32_t csg_table_first(const csg_table *table, uint64_t hash, size_t *slot)
{
    *slot = (size_t)(hash * 0x9E3779B97F4A7C15u >> 32) & (table->size - 1);
    return table->slots[*slot];
}

/* Looks on. CSG_TABLE_NONE: it is not there, and *slot is where to put it. */
static inline uint32_t csg_table_next(const csg_table *table, size_t *slot)
{
    *slot = (*slot + 1) & (table->size - 1);
    return table->slots[*slot];
}

/* At the free slot that a search has ended at, with no csg_table_reserve() between. */
static inline void csg_table_put(csg_table *table, size_t slot, uint32_t number)
{
    table->slots[slot] = number;
}

/* Puts a number that no other is equal to, where there is room for it. */
static inline void csg_table_add(csg_table *table, uint64_t hash, uint32_t number)
{
    size_t slot;
    uint32_t other = csg_table_first(table, hash, &slot);
    while (other != CSG_TABLE_NONE)
        other = csg_table_next(table, &slot);
    csg_table_put(table, slot, number);
}

/* ---- hashes ------------------------------------------------------------------------------- */

#define CSG_HASH_START 0xCBF29CE484222325u

/* FNV-1a (Fowler, Noll, Vo) over bytes; begins with CSG_HASH_START. */
static inline uint64_t csg_hash_bytes(uint64_t hash, const void *bytes, size_t size_bytes)
{
    const uint8_t *at = bytes;
    for (size_t i = 0; i < size_bytes; i++)
        hash = (hash ^ at[i]) * 0x100000001B3u;
    return hash;
}

/* A word more, all of its bits at once; begins with anything. */
static inline uint64_t csg_hash_word(uint64_t hash, uint64_t word)
{
    hash = (hash ^ word) * 0x9E3779B97F4A7C15u;
    return hash ^ hash >> 29;
}

/* More of a text into 128 bits of a digest, which begins with CSG_HASH_START and 0: two texts that
 * come in the same pieces and have the same digest are taken for the same. */
static inline void csg_digest_text(uint64_t digest[2], const char *bytes, size_t length)
{
    digest[0] = csg_hash_bytes(digest[0], bytes, length);
    for (size_t i = 0; i < length; i += sizeof(uint64_t)) {
        uint64_t word = 0;
        memcpy(&word, bytes + i, length - i < sizeof word ? length - i : sizeof word);
        digest[1] = csg_hash_word(digest[1], word);
    }
}

#endif
