/* SPDX-License-Identifier: MIT
 * Operators that hand one operand on: which one, and the partial derivatives.
 */
#ifndef CSG_SCENE_CHOICE_H
#define CSG_SCENE_CHOICE_H

#include <stddef.h>

/* The last of the largest. */
static inline size_t csg_largest_of(const double *values, size_t count)
{
    size_t at = 0;
    for (size_t i = 1; i < count; i++)
        if (values[i] >= values[at])
            at = i;
    return at;
}

/* The last of the smallest. */
static inline size_t csg_smallest_of(const double *values, size_t count)
{
    size_t at = 0;
    for (size_t i = 1; i < count; i++)
        if (values[i] <= values[at])
            at = i;
    return at;
}

/* The chosen one's value. */
static inline double csg_choose(const double *values, size_t count, size_t chosen, double *partials)
{
    for (size_t i = 0; i < count; i++)
        partials[i] = i == chosen;
    return values[chosen];
}

#endif
