/* SPDX-License-Identifier: MIT
 * Memory of the budget for libraries that release a block without saying how large it is: each
 * block carries its size before it.
 */
#ifndef CSG_BASE_SIZED_BLOCK_H
#define CSG_BASE_SIZED_BLOCK_H

#include <stdint.h>

#include "base/memory.h"

enum { CSG_SIZED_BLOCK_HEAD = 16 }; /* what follows is aligned for everything */

/* NULL: no memory. */
static inline void *csg_sized_block_alloc(csg_memory *memory, size_t size)
{
    size_t *block = size <= SIZE_MAX - CSG_SIZED_BLOCK_HEAD
                        ? csg_memory_alloc(memory, size + CSG_SIZED_BLOCK_HEAD)
                        : NULL;
    if (!block)
        return NULL;
    *block = size + CSG_SIZED_BLOCK_HEAD;
    return (uint8_t *)block + CSG_SIZED_BLOCK_HEAD;
}

/* NULL is allowed. */
static inline void csg_sized_block_release(csg_memory *memory, void *pointer)
{
    if (!pointer)
        return;
    size_t *block = (size_t *)(void *)((uint8_t *)pointer - CSG_SIZED_BLOCK_HEAD);
    csg_memory_release(memory, block, *block);
}

#endif
