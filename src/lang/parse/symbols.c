/* SPDX-License-Identifier: MIT
 * Interned names and scope members; see symbols.h.
 */
#include "lang/parse/symbols.h"

#include <string.h>

void csg_symbols_init(csg_symbols *symbols, csg_memory *memory, csg_arena *arena)
{
    *symbols = (csg_symbols){.memory = memory, .arena = arena, .table = {.memory = memory}};
}

void csg_symbols_reset(csg_symbols *symbols)
{
    csg_memory_release(symbols->memory, symbols->entries,
                       symbols->capacity * sizeof *symbols->entries);
    csg_table_release(&symbols->table);
    csg_symbols_init(symbols, symbols->memory, symbols->arena);
}

static uint64_t hash_symbol(const void *entries, uint32_t symbol)
{
    return ((const csg_symbol_entry *)entries)[symbol].hash;
}

static csg_symbol append(csg_symbols *symbols, const char *name, size_t length, uint32_t hash)
{
    if (symbols->count >= UINT32_MAX / 2 ||
        !csg_memory_reserve(symbols->memory, (void **)&symbols->entries, &symbols->capacity,
                            symbols->count + 2, sizeof *symbols->entries))
        return 0;
    if (symbols->count == 0)
        symbols->entries[symbols->count++] =
            (csg_symbol_entry){.name = "", .function = -1, .module = -1, .unsupported = -1};
    const char *copy = csg_arena_strndup(symbols->arena, name, length);
    if (!copy)
        return 0;
    symbols->entries[symbols->count] = (csg_symbol_entry){
        .name = copy,
        .length = (uint32_t)length,
        .hash = hash,
        .special = length > 0 && name[0] == '$' && strcmp(copy, "$children") != 0,
        .function = -1,
        .module = -1,
        .unsupported = -1,
    };
    return (csg_symbol)symbols->count++;
}

csg_symbol csg_symbol_intern(csg_symbols *symbols, const char *name, size_t length)
{
    uint32_t hash = (uint32_t)csg_hash_bytes(CSG_HASH_START, name, length);
    if (!csg_table_reserve(&symbols->table, symbols->count + 1, hash_symbol, symbols->entries))
        return 0;
    size_t slot;
    for (csg_symbol symbol = csg_table_first(&symbols->table, hash, &slot);
         symbol != CSG_TABLE_NONE; symbol = csg_table_next(&symbols->table, &slot)) {
        const csg_symbol_entry *entry = &symbols->entries[symbol];
        if (entry->hash == hash && entry->length == length &&
            memcmp(entry->name, name, length) == 0)
            return symbol;
    }
    csg_symbol symbol = append(symbols, name, length, hash);
    if (symbol)
        csg_table_put(&symbols->table, slot, symbol);
    return symbol;
}

uint32_t csg_edit_distance(const char *a, const char *b, uint32_t most)
{
    enum { LONGEST = 40 };
    uint32_t rows[3][LONGEST + 1];
    size_t n = strlen(a), m = strlen(b);
    if (n > LONGEST || m > LONGEST || (n > m ? n - m : m - n) > most)
        return most + 1;
    for (size_t j = 0; j <= m; j++)
        rows[0][j] = (uint32_t)j;
    for (size_t i = 1; i <= n; i++) {
        uint32_t *now = rows[i % 3], *before = rows[(i + 2) % 3], *earlier = rows[(i + 1) % 3];
        now[0] = (uint32_t)i;
        for (size_t j = 1; j <= m; j++) {
            uint32_t best = before[j - 1] + (a[i - 1] != b[j - 1]);
            best = before[j] + 1 < best ? before[j] + 1 : best;
            best = now[j - 1] + 1 < best ? now[j - 1] + 1 : best;
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                best = earlier[j - 2] + 1 < best ? earlier[j - 2] + 1 : best;
            now[j] = best;
        }
    }
    return rows[n % 3][m] > most ? most + 1 : rows[n % 3][m];
}

/* ---- members ----------------------------------------------------------------------------- */

void csg_members_init(csg_members *members, csg_memory *memory)
{
    *members = (csg_members){.memory = memory, .table = {.memory = memory}};
}

void csg_members_reset(csg_members *members)
{
    csg_table_release(&members->table);
    csg_memory_release(members->memory, members->items, members->capacity * sizeof *members->items);
    csg_members_init(members, members->memory);
}

static uint64_t key_of(uint32_t scope, csg_member_kind kind, csg_symbol name)
{
    return (uint64_t)scope << 32 | (uint64_t)name << 2 | (uint64_t)kind;
}

static uint64_t hash_member(const void *items, uint32_t number)
{
    return ((const csg_member *)items)[number].key;
}

bool csg_members_add(csg_members *members, uint32_t scope, csg_member_kind kind, csg_symbol name,
                     uint32_t index)
{
    if (!csg_table_reserve(&members->table, members->count + 1, hash_member, members->items) ||
        !csg_memory_reserve(members->memory, (void **)&members->items, &members->capacity,
                            members->count + 1, sizeof *members->items))
        return false;
    uint64_t key = key_of(scope, kind, name);
    members->items[members->count] = (csg_member){key, index};
    csg_table_add(&members->table, key, (uint32_t)members->count++);
    return true;
}

uint32_t csg_members_find(const csg_members *members, uint32_t scope, csg_member_kind kind,
                          csg_symbol name)
{
    if (members->count == 0)
        return UINT32_MAX;
    size_t slot;
    uint64_t key = key_of(scope, kind, name);
    uint32_t found = csg_table_first(&members->table, key, &slot);
    while (found != CSG_TABLE_NONE && members->items[found].key != key)
        found = csg_table_next(&members->table, &slot);
    return found != CSG_TABLE_NONE ? members->items[found].index : UINT32_MAX;
}
