/* SPDX-License-Identifier: MIT
 * Names as small numbers, and the map from (scope, kind, name) to what a scope defines.
 * Built-in names are interned first, and their entries say which row of which table they are.
 */
#ifndef CSG_LANG_SYMBOLS_H
#define CSG_LANG_SYMBOLS_H

#include "base/table.h"

typedef uint32_t csg_symbol; /* 0 = no name */

typedef struct csg_symbol_entry {
    const char *name; /* terminated */
    uint32_t length, hash;
    bool special;        /* begins with '$': dynamic scope; not $children, which is lexical */
    int16_t function;    /* row in functions.def, -1 = none */
    int16_t module;      /* row in modules.def, -1 = none */
    int16_t unsupported; /* row in unsupported_modules.def, -1 = none */
    bool variable;       /* the text gives it a value somewhere */
    bool called;         /* a statement calls it */
} csg_symbol_entry;

typedef struct csg_symbols {
    csg_memory *memory;
    csg_arena *arena;
    csg_symbol_entry *entries; /* entries[0] is the empty name */
    size_t count, capacity;
    csg_table table; /* of the entries but for the first */
} csg_symbols;

void csg_symbols_init(csg_symbols *symbols, csg_memory *memory, csg_arena *arena);
void csg_symbols_reset(csg_symbols *symbols);
/* 0 when memory ran out. */
csg_symbol csg_symbol_intern(csg_symbols *symbols, const char *name, size_t length);
static inline const char *csg_symbol_name(const csg_symbols *symbols, csg_symbol symbol)
{
    return symbols->entries[symbol].name;
}

/* Damerau's edit distance (adjacent swaps count one), at most `most` + 1. */
uint32_t csg_edit_distance(const char *a, const char *b, uint32_t most);

/* ---- members of scopes ------------------------------------------------------------------ */

typedef enum csg_member_kind {
    CSG_MEMBER_VARIABLE,
    CSG_MEMBER_FUNCTION,
    CSG_MEMBER_MODULE
} csg_member_kind;

typedef struct csg_member {
    uint64_t key;
    uint32_t index;
} csg_member;

typedef struct csg_members {
    csg_memory *memory;
    csg_member *items;
    size_t count, capacity;
    csg_table table; /* of the items */
} csg_members;

void csg_members_init(csg_members *members, csg_memory *memory);
void csg_members_reset(csg_members *members);
/* False when memory ran out. The name must not be there yet. */
bool csg_members_add(csg_members *members, uint32_t scope, csg_member_kind kind, csg_symbol name,
                     uint32_t index);
/* UINT32_MAX = not there. */
uint32_t csg_members_find(const csg_members *members, uint32_t scope, csg_member_kind kind,
                          csg_symbol name);

#endif
