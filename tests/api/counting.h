/* SPDX-License-Identifier: MIT
 * An allocator that counts, and fails on purpose.
 */
#ifndef TESTS_API_COUNTING_H
#define TESTS_API_COUNTING_H

#include <stdint.h>
#include <stdlib.h>

typedef struct counting {
    int64_t bytes, blocks;  /* in use */
    int64_t calls, fail_at; /* the call of this number returns NULL; 0 = none */
} counting;

static inline void *counting_alloc(void *user, size_t size_bytes)
{
    counting *c = user;
    int64_t call = __atomic_add_fetch(&c->calls, 1, __ATOMIC_RELAXED);
    if (call == c->fail_at)
        return NULL;
    __atomic_add_fetch(&c->bytes, (int64_t)size_bytes, __ATOMIC_RELAXED);
    __atomic_add_fetch(&c->blocks, 1, __ATOMIC_RELAXED);
    return malloc(size_bytes);
}

static inline void counting_release(void *user, void *memory, size_t size_bytes)
{
    counting *c = user;
    __atomic_add_fetch(&c->bytes, -(int64_t)size_bytes, __ATOMIC_RELAXED);
    __atomic_add_fetch(&c->blocks, -1, __ATOMIC_RELAXED);
    free(memory);
}

#endif
