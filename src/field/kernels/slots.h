/* SPDX-License-Identifier: MIT
 * The arrays that walks over tapes work on, a stack of slots. Part of kernel.c, in a file of its
 * own.
 */
#ifndef CSG_FIELD_SLOTS_H
#define CSG_FIELD_SLOTS_H

#include <stddef.h>
#include <stdint.h>

typedef struct kernel_slots {
    float *memory;
    size_t stride; /* floats of one array */
} kernel_slots;

static inline float *slot(kernel_slots s, size_t index)
{
    return s.memory + index * s.stride;
}

enum { GRADIENT_CHANNELS = 3, COLOR_CHANNELS = 4, MOST_CHANNELS = 2 * GRADIENT_CHANNELS };

/* Slots of a mixed walk: values first (depth of them), then the channels of each. */
static inline float *channel(kernel_slots s, uint32_t depth, size_t index, int c)
{
    return slot(s, depth + index * MOST_CHANNELS + (size_t)c);
}

#endif
