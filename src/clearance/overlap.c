/* SPDX-License-Identifier: MIT
 * The volume of what two parts have in common; see overlap.h. Cubes of a tree share no more than
 * faces, so what pairs of cubes have in common adds up.
 */
#include "clearance/overlap.h"

#include <math.h>

#include "clearance/between.h"

enum { ASK_EVERY = 64, MOST_DIVIDED = 1 << 11 };

typedef struct shared {
    double volume; /* of what the two cubes have in common */
    uint32_t a, b;
} shared;

typedef struct overlap {
    csg_clear_tree *a, *b;
    shared *heap; /* the largest first */
    size_t count, capacity;
    double sure, stuck; /* volumes: inside both; of cubes that cannot be divided */
    double open;        /* of the others, with the rounding of sums that go up and down */
    bool out_of_memory;
} overlap;

static bool comes_before(const shared *p, const shared *q)
{
    if (p->volume < q->volume || q->volume < p->volume)
        return p->volume > q->volume;
    return p->a != q->a ? p->a < q->a : p->b < q->b;
}

static void push_shared(overlap *o, shared item)
{
    csg_memory *memory = o->a->arena.memory;
    if (!csg_memory_reserve(memory, (void **)&o->heap, &o->capacity, o->count + 1, sizeof item)) {
        o->out_of_memory = true;
        return;
    }
    size_t i = o->count++;
    for (; i > 0 && comes_before(&item, &o->heap[(i - 1) / 2]); i = (i - 1) / 2)
        o->heap[i] = o->heap[(i - 1) / 2];
    o->heap[i] = item;
}

static shared pop_shared(overlap *o)
{
    shared first = o->heap[0], item = o->heap[--o->count];
    size_t i = 0;
    for (size_t child; (child = 2 * i + 1) < o->count; i = child) {
        if (child + 1 < o->count && comes_before(&o->heap[child + 1], &o->heap[child]))
            child++;
        if (!comes_before(&o->heap[child], &item))
            break;
        o->heap[i] = o->heap[child];
    }
    o->heap[i] = item;
    return first;
}

static void consider(overlap *o, uint32_t a, uint32_t b)
{
    csg_vec3 between = csg_clear_offset(o->a, a, o->b, b);
    const double offset[3] = {between.x, between.y, between.z};
    const csg_measure_cube *p = &o->a->nodes[a].cube, *q = &o->b->nodes[b].cube;
    double volume = 1;
    for (int k = 0; k < 3; k++) {
        double side = fmin(p->half, offset[k] + q->half) - fmax(-p->half, offset[k] - q->half);
        volume *= fmax(side, 0);
    }
    if (!(volume > 0))
        return;
    bool together;
    if (csg_clear_between(o->a, a, o->b, b, (csg_vec3){0, 0, 0}, 0, &together) > 0)
        return;
    if (p->state == CSG_CELL_INSIDE && q->state == CSG_CELL_INSIDE) {
        o->sure += volume;
        return;
    }
    o->open += volume;
    push_shared(o, (shared){volume, a, b});
}

static bool is_known(const overlap *o, double enough)
{
    static const double NEAR = 0.02; /* of the volume */
    double open = o->open + o->stuck;
    return open <= NEAR * o->sure || o->sure + open <= enough;
}

bool csg_clear_overlap(csg_clear_tree *a, csg_clear_tree *b, double enough, csg_mesh_watch *watch,
                       csgm_interval *out, bool *out_of_memory)
{
    static const double ROUNDING = 1e-9; /* of sums of 2^16 terms, and of the cubes' sides */
    overlap o = {.a = a, .b = b};
    bool done = true;
    consider(&o, 0, 0);
    for (int n = 0; o.count && n < MOST_DIVIDED && done && !is_known(&o, enough); n++) {
        shared top = pop_shared(&o);
        int which = csg_clear_choose(a, top.a, b, top.b);
        if (n % ASK_EVERY == ASK_EVERY - 1 && csg_mesh_should_stop(watch))
            done = false;
        if (which < 0) {
            o.stuck += top.volume;
            continue;
        }
        o.open -= top.volume;
        csg_clear_tree *tree = which == 0 ? a : b;
        uint32_t node = which == 0 ? top.a : top.b;
        if (!csg_clear_tree_divide(tree, node)) {
            o.out_of_memory = true;
            break;
        }
        uint32_t first = tree->nodes[node].first_child, count = tree->nodes[node].child_count;
        for (uint32_t i = first; i < first + count; i++)
            consider(&o, which == 0 ? i : top.a, which == 0 ? top.b : i);
        if (o.out_of_memory)
            break;
    }
    double most = o.sure + o.stuck;
    for (size_t i = 0; i < o.count; i++)
        most += o.heap[i].volume;
    *out = (csgm_interval){o.sure * (1 - ROUNDING), most * (1 + ROUNDING)};
    if (o.out_of_memory) /* children that found no room were not counted */
        out->high = INFINITY;
    csg_memory_release(a->arena.memory, o.heap, o.capacity * sizeof *o.heap);
    *out_of_memory |= o.out_of_memory;
    return done && !o.out_of_memory;
}
