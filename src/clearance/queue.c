/* SPDX-License-Identifier: MIT
 * A binary heap; see queue.h.
 */
#include "clearance/queue.h"

static bool comes_before(const csg_clear_queued *p, const csg_clear_queued *q)
{
    if (p->key < q->key || q->key < p->key)
        return p->key < q->key;
    return p->a != q->a ? p->a < q->a : p->b < q->b;
}

bool csg_clear_queue_push(csg_clear_queue *q, csg_memory *memory, csg_clear_queued item)
{
    if (!csg_memory_reserve(memory, (void **)&q->items, &q->capacity, q->count + 1, sizeof item))
        return false;
    size_t i = q->count++;
    for (; i > 0 && comes_before(&item, &q->items[(i - 1) / 2]); i = (i - 1) / 2)
        q->items[i] = q->items[(i - 1) / 2];
    q->items[i] = item;
    return true;
}

csg_clear_queued csg_clear_queue_pop(csg_clear_queue *q)
{
    csg_clear_queued first = q->items[0], item = q->items[--q->count];
    size_t i = 0;
    for (size_t child; (child = 2 * i + 1) < q->count; i = child) {
        if (child + 1 < q->count && comes_before(&q->items[child + 1], &q->items[child]))
            child++;
        if (!comes_before(&q->items[child], &item))
            break;
        q->items[i] = q->items[child];
    }
    q->items[i] = item;
    return first;
}

void csg_clear_queue_release(csg_clear_queue *q, csg_memory *memory)
{
    csg_memory_release(memory, q->items, q->capacity * sizeof *q->items);
    *q = (csg_clear_queue){0};
}
