/* SPDX-License-Identifier: MIT
 * Pairs of cubes, one over each part, by a key: a heap. The order is total, so that a search is the
 * same everywhere.
 */
#ifndef CSG_CLEARANCE_QUEUE_H
#define CSG_CLEARANCE_QUEUE_H

#include "base/memory.h"

typedef struct csg_clear_queued {
    double key;
    uint32_t a, b; /* of two with the same key those with the lower numbers come first */
} csg_clear_queued;

typedef struct csg_clear_queue {
    csg_clear_queued *items; /* the least key first, the others in no order */
    size_t count, capacity;
} csg_clear_queue;

/* False: out of memory, and it is not in. */
bool csg_clear_queue_push(csg_clear_queue *queue, csg_memory *memory, csg_clear_queued item);
/* The one of the least key, of a queue that is not empty. */
csg_clear_queued csg_clear_queue_pop(csg_clear_queue *queue);
void csg_clear_queue_release(csg_clear_queue *queue, csg_memory *memory);

#endif
