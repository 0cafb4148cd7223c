/* SPDX-License-Identifier: MIT
 * Memory with a budget: every byte of a context goes through one csg_memory, which counts and
 * refuses above its limit. Arenas take blocks from it; one object, one arena.
 * Every function that allocates can fail: NULL or false means "out of memory", nothing changed.
 */
#ifndef CSG_BASE_MEMORY_H
#define CSG_BASE_MEMORY_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "csgmesh/csgmesh.h"

typedef struct csg_memory {
    csgm_allocator allocator;
    uint64_t limit_bytes; /* 0 = none */
    atomic_uint_fast64_t used_bytes, peak_bytes;
    atomic_bool limit_refused; /* something that the system might have given; for messages */
    bool (*ends)(void *user);  /* csg_memory_end_when */
    void *ends_user;
    atomic_bool has_ended;
} csg_memory;

void csg_memory_init(csg_memory *memory, const csgm_allocator *allocator, uint64_t limit_bytes);

/* size_bytes must be > 0. Thread safe. */
void *csg_memory_alloc(csg_memory *memory, size_t size_bytes);
/* Would the limit allow so many bytes that others allocate? Else it is noted as refused. */
bool csg_memory_allows(csg_memory *memory, uint64_t size_bytes);
/* Until it is called again, with NULL: larger blocks are refused once `ends` says so, which any
 * thread that allocates asks. So what allocates while it works ends soon after it should (a time
 * limit, the caller's wish), although it knows nothing of either. */
void csg_memory_end_when(csg_memory *memory, bool (*ends)(void *user), void *user);
/* Asks `ends`: for long work that allocates nothing. Once true it stays so. */
bool csg_memory_has_ended(csg_memory *memory);
/* size_bytes as allocated; NULL is a no-op. */
void csg_memory_release(csg_memory *memory, void *pointer, size_t size_bytes);

/* Makes room for at least `needed` elements in an array owned by the caller, which grows by half,
 * or by an eighth once it has four megabytes: *data and *capacity are replaced together. */
bool csg_memory_reserve(csg_memory *memory, void **data, size_t *capacity, size_t needed,
                        size_t element_bytes);

/* ---- arena: allocate many, release all at once ------------------------------------- */

typedef struct csg_arena_block csg_arena_block;

typedef struct csg_arena {
    csg_memory *memory;
    csg_arena_block *blocks; /* newest first */
    uint8_t *cursor, *end;
    csg_arena_block *spare; /* one block kept by csg_arena_release_to */
} csg_arena;

/* A place in an arena to return to. */
typedef struct csg_arena_mark {
    csg_arena_block *block;
    uint8_t *cursor, *end;
} csg_arena_mark;

void csg_arena_init(csg_arena *arena, csg_memory *memory);
void csg_arena_reset(csg_arena *arena); /* gives every block back; the arena stays usable */

/* What it has taken. */
size_t csg_arena_bytes(const csg_arena *arena);

/* Not zeroed. size_bytes may be 0. Aligned to 16. */
void *csg_arena_alloc(csg_arena *arena, size_t size_bytes);
void *csg_arena_calloc(csg_arena *arena, size_t count,
                       size_t element_bytes); /* zeroed, overflow checked */
/* A terminated copy. */
char *csg_arena_strndup(csg_arena *arena, const char *text, size_t length);
/* A terminated formatted string. */
char *csg_arena_printf(csg_arena *arena, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

csg_arena_mark csg_arena_get_mark(const csg_arena *arena);
void csg_arena_release_to(csg_arena *arena, csg_arena_mark mark);

#endif
