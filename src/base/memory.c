/* SPDX-License-Identifier: MIT
 * Counting allocator and arenas; see memory.h.
 */
#include "base/memory.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void *default_alloc(void *user, size_t size_bytes)
{
    (void)user;
    return malloc(size_bytes);
}

static void default_release(void *user, void *memory, size_t size_bytes)
{
    (void)user;
    (void)size_bytes;
    free(memory);
}

void csg_memory_init(csg_memory *memory, const csgm_allocator *allocator, uint64_t limit_bytes)
{
    memory->allocator = (csgm_allocator){default_alloc, default_release, NULL};
    if (allocator && allocator->alloc && allocator->release)
        memory->allocator = *allocator;
    memory->limit_bytes = limit_bytes;
    atomic_init(&memory->used_bytes, 0);
    atomic_init(&memory->peak_bytes, 0);
    atomic_init(&memory->limit_refused, false);
    csg_memory_end_when(memory, NULL, NULL);
}

void csg_memory_end_when(csg_memory *memory, bool (*ends)(void *user), void *user)
{
    memory->ends = ends;
    memory->ends_user = user;
    atomic_init(&memory->has_ended, false);
}

bool csg_memory_has_ended(csg_memory *memory)
{
    if (!memory->ends)
        return false;
    if (!atomic_load(&memory->has_ended) && memory->ends(memory->ends_user))
        atomic_store(&memory->has_ended, true);
    return atomic_load(&memory->has_ended);
}

/* Small blocks are given without asking: a clock costs as much as they do. */
static bool is_too_late(csg_memory *memory, size_t size_bytes)
{
    enum { LARGER = 4096 };
    return size_bytes >= LARGER && csg_memory_has_ended(memory);
}

static void raise_peak(csg_memory *memory, uint64_t used)
{
    uint_fast64_t peak = atomic_load(&memory->peak_bytes);
    while (used > peak && !atomic_compare_exchange_weak(&memory->peak_bytes, &peak, used)) {
    }
}

/* used: with what is asked for. */
static bool is_within_limit(csg_memory *memory, uint64_t used)
{
    bool within = !memory->limit_bytes || used <= memory->limit_bytes;
    if (!within)
        atomic_store(&memory->limit_refused, true);
    return within;
}

bool csg_memory_allows(csg_memory *memory, uint64_t size_bytes)
{
    return is_within_limit(memory, atomic_load(&memory->used_bytes) + size_bytes);
}

void *csg_memory_alloc(csg_memory *memory, size_t size_bytes)
{
    uint64_t used = atomic_fetch_add(&memory->used_bytes, size_bytes) + size_bytes;
    void *pointer = NULL;
    if (!is_too_late(memory, size_bytes) && is_within_limit(memory, used))
        pointer = memory->allocator.alloc(memory->allocator.user, size_bytes);
    if (!pointer) {
        atomic_fetch_sub(&memory->used_bytes, size_bytes);
        return NULL;
    }
    raise_peak(memory, used);
    return pointer;
}

void csg_memory_release(csg_memory *memory, void *pointer, size_t size_bytes)
{
    if (!pointer)
        return;
    memory->allocator.release(memory->allocator.user, pointer, size_bytes);
    atomic_fetch_sub(&memory->used_bytes, size_bytes);
}

/* The C library's own growing moves the pages of large blocks instead of copying them. */
static void *grow_by_default(csg_memory *memory, void *data, size_t before, size_t after)
{
    uint64_t more = after - before, used = atomic_fetch_add(&memory->used_bytes, more) + more;
    void *fresh = NULL;
    if (!is_too_late(memory, after) && is_within_limit(memory, used))
        fresh = realloc(data, after);
    if (fresh)
        raise_peak(memory, used);
    else
        atomic_fetch_sub(&memory->used_bytes, more);
    return fresh;
}

/* A larger block with the same contents in place of `data`; NULL: nothing changed. */
static void *grow(csg_memory *memory, void *data, size_t before, size_t after)
{
    if (memory->allocator.alloc == default_alloc && memory->allocator.release == default_release)
        return grow_by_default(memory, data, before, after);
    void *fresh = csg_memory_alloc(memory, after);
    if (fresh && before)
        memcpy(fresh, data, before);
    if (fresh)
        csg_memory_release(memory, data, before);
    return fresh;
}

/* By half; large arrays by an eighth: what they have too much counts against the limit, and their
 * pages are moved, not copied. */
static size_t larger_than(size_t capacity, size_t element_bytes)
{
    enum { FIRST = 16, LARGE_BYTES = 1 << 22 };
    if (!capacity)
        return FIRST;
    return capacity + capacity / (capacity < LARGE_BYTES / element_bytes ? 2 : 8);
}

bool csg_memory_reserve(csg_memory *memory, void **data, size_t *capacity, size_t needed,
                        size_t element_bytes)
{
    if (needed <= *capacity)
        return true;
    size_t grown = larger_than(*capacity, element_bytes);
    if (grown < needed)
        grown = needed;
    if (grown > SIZE_MAX / element_bytes)
        return false;
    void *fresh = grow(memory, *data, *capacity * element_bytes, grown * element_bytes);
    if (!fresh)
        return false;
    *data = fresh;
    *capacity = grown;
    return true;
}

/* ---- arena ------------------------------------------------------------------------- */

struct csg_arena_block {
    csg_arena_block *next;
    size_t size_bytes; /* with this header */
};

enum { ALIGNMENT = 16, FIRST_BLOCK = 4096, LARGEST_STEP = 1 << 20 };

static uint8_t *block_begin(csg_arena_block *block)
{
    size_t header = (sizeof *block + ALIGNMENT - 1) & ~(size_t)(ALIGNMENT - 1);
    return (uint8_t *)block + header;
}

void csg_arena_init(csg_arena *arena, csg_memory *memory)
{
    *arena = (csg_arena){.memory = memory};
}

static void release_block(csg_arena *arena, csg_arena_block *block)
{
    if (block)
        csg_memory_release(arena->memory, block, block->size_bytes);
}

void csg_arena_reset(csg_arena *arena)
{
    while (arena->blocks) {
        csg_arena_block *next = arena->blocks->next;
        release_block(arena, arena->blocks);
        arena->blocks = next;
    }
    release_block(arena, arena->spare);
    csg_arena_init(arena, arena->memory);
}

static bool add_block(csg_arena *arena, size_t payload)
{
    /* Each block is as large as the one before plus half, so that small arenas stay small. */
    size_t size = arena->blocks ? arena->blocks->size_bytes + arena->blocks->size_bytes / 2
                                : (size_t)FIRST_BLOCK;
    if (size > LARGEST_STEP)
        size = LARGEST_STEP;
    if (payload > SIZE_MAX - 2 * ALIGNMENT)
        return false;
    if (size < payload + 2 * ALIGNMENT)
        size = payload + 2 * ALIGNMENT;
    csg_arena_block *block = arena->spare;
    if (block && block->size_bytes >= payload + 2 * ALIGNMENT) {
        arena->spare = NULL;
    } else {
        block = csg_memory_alloc(arena->memory, size);
        if (!block)
            return false;
        block->size_bytes = size;
    }
    block->next = arena->blocks;
    arena->blocks = block;
    arena->cursor = block_begin(block);
    arena->end = (uint8_t *)block + block->size_bytes;
    return true;
}

size_t csg_arena_bytes(const csg_arena *arena)
{
    size_t bytes = arena->spare ? arena->spare->size_bytes : 0;
    for (const csg_arena_block *block = arena->blocks; block; block = block->next)
        bytes += block->size_bytes;
    return bytes;
}

void *csg_arena_alloc(csg_arena *arena, size_t size_bytes)
{
    if (size_bytes > SIZE_MAX / 2)
        return NULL;
    size_t size = (size_bytes + ALIGNMENT - 1) & ~(size_t)(ALIGNMENT - 1);
    if (!arena->cursor || (size_t)(arena->end - arena->cursor) < size) {
        if (!add_block(arena, size))
            return NULL;
    }
    void *pointer = arena->cursor;
    arena->cursor += size;
    return pointer;
}

void *csg_arena_calloc(csg_arena *arena, size_t count, size_t element_bytes)
{
    if (element_bytes && count > SIZE_MAX / element_bytes)
        return NULL;
    void *pointer = csg_arena_alloc(arena, count * element_bytes);
    if (pointer)
        memset(pointer, 0, count * element_bytes);
    return pointer;
}

char *csg_arena_strndup(csg_arena *arena, const char *text, size_t length)
{
    char *copy = csg_arena_alloc(arena, length + 1);
    if (copy) {
        if (length)
            memcpy(copy, text, length);
        copy[length] = '\0';
    }
    return copy;
}

char *csg_arena_printf(csg_arena *arena, const char *format, ...)
{
    va_list arguments, again;
    va_start(arguments, format);
    va_copy(again, arguments);
    int length = vsnprintf(NULL, 0, format, arguments);
    va_end(arguments);
    char *text = length < 0 ? NULL : csg_arena_alloc(arena, (size_t)length + 1);
    if (text)
        vsnprintf(text, (size_t)length + 1, format, again);
    va_end(again);
    return text;
}

csg_arena_mark csg_arena_get_mark(const csg_arena *arena)
{
    return (csg_arena_mark){arena->blocks, arena->cursor, arena->end};
}

void csg_arena_release_to(csg_arena *arena, csg_arena_mark mark)
{
    while (arena->blocks != mark.block) {
        csg_arena_block *next = arena->blocks->next;
        if (!arena->spare) {
            arena->spare = arena->blocks;
        } else {
            release_block(arena, arena->blocks);
        }
        arena->blocks = next;
    }
    arena->cursor = mark.cursor;
    arena->end = mark.end;
}
