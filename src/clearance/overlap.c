/* SPDX-License-Identifier: MIT
 * The volume of what two parts have in common; see overlap.h. Cubes of a tree share no more than
 * faces, so what pairs of cubes have in common adds up.
 */
#include "clearance/overlap.h"

#include <math.h>

#include "clearance/between.h"
#include "clearance/queue.h"

enum { ASK_EVERY = 64, MOST_DIVIDED = 1 << 11 };

typedef struct overlap {
    csg_clear_tree *a, *b;
    csg_clear_queue queue; /* by less the volume of what the two cubes have in common */
    double sure, stuck;    /* volumes: inside both; of cubes that cannot be divided */
    double open;           /* of the others, with the rounding of sums that go up and down */
    bool out_of_memory;
} overlap;

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
    if (csg_clear_between(o->a, a, o->b, b, NULL, (csg_vec3){0, 0, 0}, 0, &together) > 0)
        return;
    if (p->state == CSG_CELL_INSIDE && q->state == CSG_CELL_INSIDE) {
        o->sure += volume;
        return;
    }
    o->open += volume;
    if (!csg_clear_queue_push(&o->queue, o->a->arena.memory, (csg_clear_queued){-volume, a, b}))
        o->out_of_memory = true;
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
    for (int n = 0; o.queue.count && n < MOST_DIVIDED && done && !is_known(&o, enough); n++) {
        csg_clear_queued top = csg_clear_queue_pop(&o.queue);
        int which = csg_clear_choose(a, top.a, b, top.b);
        if (n % ASK_EVERY == ASK_EVERY - 1 && csg_mesh_should_stop(watch))
            done = false;
        if (which < 0) {
            o.stuck -= top.key;
            continue;
        }
        o.open += top.key;
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
    for (size_t i = 0; i < o.queue.count; i++)
        most -= o.queue.items[i].key;
    *out = (csgm_interval){o.sure * (1 - ROUNDING), most * (1 + ROUNDING)};
    if (o.out_of_memory) /* children that found no room were not counted */
        out->high = INFINITY;
    csg_clear_queue_release(&o.queue, a->arena.memory);
    *out_of_memory |= o.out_of_memory;
    return done && !o.out_of_memory;
}
