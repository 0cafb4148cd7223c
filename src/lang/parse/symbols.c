/* SPDX-License-Identifier: MIT
 * Interned names and scope members; see symbols.h. Two open-addressing tables at half load.
 */
#include "lang/parse/symbols.h"

#include <string.h>

static uint32_t hash_of(const char *text, size_t length)
{
    uint32_t hash = 2166136261u; /* FNV-1a */
    for (size_t i = 0; i < length; i++)
        hash = (hash ^ (unsigned char)text[i]) * 16777619u;
    return hash;
}

void csg_symbols_init(csg_symbols *symbols, csg_memory *memory, csg_arena *arena)
{
    *symbols = (csg_symbols){.memory = memory, .arena = arena};
}

void csg_symbols_reset(csg_symbols *symbols)
{
    csg_memory_release(symbols->memory, symbols->entries,
                       symbols->capacity * sizeof *symbols->entries);
    csg_memory_release(symbols->memory, symbols->slots,
                       symbols->slot_count * sizeof *symbols->slots);
    csg_symbols_init(symbols, symbols->memory, symbols->arena);
}

static void place(csg_symbols *symbols, csg_symbol symbol)
{
    size_t mask = symbols->slot_count - 1, at = symbols->entries[symbol].hash & mask;
    while (symbols->slots[at])
        at = (at + 1) & mask;
    symbols->slots[at] = symbol;
}

static bool grow_slots(csg_symbols *symbols)
{
    size_t count = symbols->slot_count ? symbols->slot_count * 2 : 1024;
    csg_symbol *slots = csg_memory_alloc(symbols->memory, count * sizeof *slots);
    if (!slots)
        return false;
    memset(slots, 0, count * sizeof *slots);
    csg_memory_release(symbols->memory, symbols->slots, symbols->slot_count * sizeof *slots);
    symbols->slots = slots;
    symbols->slot_count = count;
    for (size_t i = 1; i < symbols->count; i++)
        place(symbols, (csg_symbol)i);
    return true;
}

static csg_symbol append(csg_symbols *symbols, const char *name, size_t length, uint32_t hash)
{
    if (symbols->count >= UINT32_MAX / 2 ||
        !csg_memory_reserve(symbols->memory, (void **)&symbols->entries, &symbols->capacity,
                            symbols->count + 2, sizeof *symbols->entries))
        return 0;
    if (symbols->count == 0)
        symbols->entries[symbols->count++] =
            (csg_symbol_entry){"", 0, 0, false, -1, -1, -1, -1, false};
    const char *copy = csg_arena_strndup(symbols->arena, name, length);
    if (!copy)
        return 0;
    symbols->entries[symbols->count] =
        (csg_symbol_entry){copy, (uint32_t)length,
                           hash, length > 0 && name[0] == '$' && strcmp(copy, "$children") != 0,
                           -1,   -1,
                           -1,   -1,
                           false};
    return (csg_symbol)symbols->count++;
}

csg_symbol csg_symbol_intern(csg_symbols *symbols, const char *name, size_t length)
{
    uint32_t hash = hash_of(name, length);
    if (symbols->count * 2 >= symbols->slot_count && !grow_slots(symbols))
        return 0;
    size_t mask = symbols->slot_count - 1;
    for (size_t at = hash & mask; symbols->slots[at]; at = (at + 1) & mask) {
        const csg_symbol_entry *entry = &symbols->entries[symbols->slots[at]];
        if (entry->hash == hash && entry->length == length &&
            memcmp(entry->name, name, length) == 0)
            return symbols->slots[at];
    }
    csg_symbol symbol = append(symbols, name, length, hash);
    if (symbol)
        place(symbols, symbol);
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
    *members = (csg_members){.memory = memory};
}

void csg_members_reset(csg_members *members)
{
    csg_memory_release(members->memory, members->slots,
                       members->slot_count * sizeof *members->slots);
    csg_members_init(members, members->memory);
}

static uint64_t key_of(uint32_t scope, csg_member_kind kind, csg_symbol name)
{
    return ((uint64_t)scope << 32 | (uint64_t)name << 2 | (uint64_t)kind) + 1;
}

static size_t slot_of(const csg_members *members, uint64_t key)
{
    uint64_t hash = key * 0x9E3779B97F4A7C15u;
    size_t mask = members->slot_count - 1, at = (size_t)(hash >> 32) & mask;
    while (members->slots[at].key && members->slots[at].key != key)
        at = (at + 1) & mask;
    return at;
}

static bool grow_members(csg_members *members)
{
    csg_members grown = {.memory = members->memory, .count = members->count};
    grown.slot_count = members->slot_count ? members->slot_count * 2 : 256;
    grown.slots = csg_memory_alloc(members->memory, grown.slot_count * sizeof *grown.slots);
    if (!grown.slots)
        return false;
    memset(grown.slots, 0, grown.slot_count * sizeof *grown.slots);
    for (size_t i = 0; i < members->slot_count; i++)
        if (members->slots[i].key)
            grown.slots[slot_of(&grown, members->slots[i].key)] = members->slots[i];
    csg_members_reset(members);
    *members = grown;
    return true;
}

bool csg_members_add(csg_members *members, uint32_t scope, csg_member_kind kind, csg_symbol name,
                     uint32_t index)
{
    if (members->count * 2 >= members->slot_count && !grow_members(members))
        return false;
    uint64_t key = key_of(scope, kind, name);
    members->slots[slot_of(members, key)] = (csg_member){key, index};
    members->count++;
    return true;
}

uint32_t csg_members_find(const csg_members *members, uint32_t scope, csg_member_kind kind,
                          csg_symbol name)
{
    if (members->slot_count == 0)
        return UINT32_MAX;
    const csg_member *member = &members->slots[slot_of(members, key_of(scope, kind, name))];
    return member->key ? member->index : UINT32_MAX;
}
