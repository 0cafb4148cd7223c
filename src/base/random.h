/* SPDX-License-Identifier: MIT
 * Reproducible random numbers (splitmix64, Steele, Lea and Flood 2014).
 */
#ifndef CSG_BASE_RANDOM_H
#define CSG_BASE_RANDOM_H

#include <stdint.h>

typedef struct csg_random {
    uint64_t state; /* any value is a seed */
} csg_random;

static inline uint64_t csg_random_next(csg_random *random)
{
    uint64_t z = (random->state += 0x9E3779B97F4A7C15u);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
}

/* In [low, high). */
static inline double csg_random_uniform(csg_random *random, double low, double high)
{
    return low + (high - low) * ((double)(csg_random_next(random) >> 11) * 0x1p-53);
}

/* In [0, count). */
static inline uint32_t csg_random_below(csg_random *random, uint32_t count)
{
    return (uint32_t)((csg_random_next(random) >> 32) * count >> 32);
}

#endif
