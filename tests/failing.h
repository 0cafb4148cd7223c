/* SPDX-License-Identifier: MIT
 * An allocator that fails from its n-th call on, and counts what is not given back.
 */
#ifndef TEST_FAILING_H
#define TEST_FAILING_H

#include <stdatomic.h>
#include <stdlib.h>

typedef struct failing {
    /* threads of one pool share them */
    atomic_long left; /* allocations before the one that fails; negative once one has */
    atomic_long live;
} failing;

static inline void *failing_alloc(void *user, size_t size)
{
    failing *f = user;
    void *memory = f->left-- > 0 ? malloc(size) : NULL;
    f->live += memory != NULL;
    return memory;
}

static inline void failing_release(void *user, void *memory, size_t size)
{
    (void)size;
    ((failing *)user)->live--;
    free(memory);
}

#endif
