/* SPDX-License-Identifier: MIT
 * Disjoint sets of numbers (union-find with path halving): each number knows a parent in its set,
 * the smallest number of a set is its root. An array begins with each number its own parent.
 */
#ifndef CSG_BASE_SETS_H
#define CSG_BASE_SETS_H

#include <stddef.h>
#include <stdint.h>

static inline void csg_sets_init(uint32_t *parents, size_t count)
{
    for (size_t i = 0; i < count; i++)
        parents[i] = (uint32_t)i;
}

/* The smallest number of the set. */
static inline uint32_t csg_set_root(uint32_t *parents, uint32_t i)
{
    while (parents[i] != i) {
        parents[i] = parents[parents[i]];
        i = parents[i];
    }
    return i;
}

/* Makes the sets of both one. */
static inline void csg_sets_join(uint32_t *parents, uint32_t a, uint32_t b)
{
    a = csg_set_root(parents, a);
    b = csg_set_root(parents, b);
    parents[a < b ? b : a] = a < b ? a : b;
}

#endif
