/* SPDX-License-Identifier: MIT
 * Pairs of pieces; see search.h. Of each pair it is known how near what faces each other can be;
 * pairs whose normals do not allow that are dropped. The least bound of all others is a lower
 * bound, points that are shown on the way are the upper one. The pair with the least bound is
 * divided first; one with itself into the pairs of its children with each other and with
 * themselves.
 */
#include "walls/search.h"

#include "clearance/queue.h"

enum { ASK_EVERY = 64, TRIES = 8 /* while the number of pairs doubles */ };

typedef struct search {
    const csg_wall_task *task;
    csg_clear_queue queue;
    double left; /* the least bound of those that were let go */
    csg_wall_shown best;
    uint64_t looked, popped, next_try;
} search;

/* Pairs that are as far apart need not be divided. */
static double enough_of(const search *s)
{
    double apart = s->best.apart;
    return apart < INFINITY ? apart - fmax(s->task->tolerance, s->task->share * apart) : INFINITY;
}

static double low_of(const search *s)
{
    return s->queue.count ? fmin(s->left, s->queue.items[0].key) : s->left;
}

static csg_vec3 line_of(const search *s)
{
    return s->best.apart < INFINITY ? csg_vec3_sub(s->best.at[1], s->best.at[0])
                                    : csg_vec3_make(0, 0, 0);
}

/* False: out of memory. */
static bool consider(search *s, uint32_t a, uint32_t b, double parent_bound)
{
    const csg_wall_source *source = &s->task->source;
    csg_clear_queued item = {.a = a, .b = b};
    double enough = enough_of(s);
    s->looked++;
    item.key = fmax(parent_bound, source->bound(source->user, a, b, line_of(s), enough));
    if (item.key >= enough) {
        s->left = fmin(s->left, item.key);
        return true;
    }
    if (csg_clear_queue_push(&s->queue, s->task->memory, item))
        return true;
    *s->task->out_of_memory = true;
    return false;
}

/* Pairs of what `node` was divided into with itself, or with `other`. */
static bool consider_children(search *s, const csg_clear_queued *top, uint32_t node, uint32_t other)
{
    const csg_wall_source *source = &s->task->source;
    uint32_t first, count;
    if (!source->divide(source->user, node, &first, &count))
        return false;
    for (uint32_t i = first; i < first + count; i++) {
        if (node != other && !consider(s, i, other, top->key))
            return false;
        for (uint32_t k = first; k <= i && node == other; k++)
            if (!consider(s, k, i, top->key))
                return false;
    }
    return true;
}

/* False: out of memory. */
static bool divide(search *s, const csg_clear_queued *top)
{
    const csg_wall_source *source = &s->task->source;
    if (!source->may_see(source->user, top->a, top->b))
        return !*s->task->out_of_memory;
    int which = source->choose(source->user, top->a, top->b);
    if (which < 0) {
        s->left = fmin(s->left, top->key);
        return true;
    }
    return which == 0 ? consider_children(s, top, top->a, top->b)
                      : consider_children(s, top, top->b, top->a);
}

/* False: it was stopped. */
static bool divide_on(search *s)
{
    const csg_wall_task *t = s->task;
    while (s->queue.count && low_of(s) < enough_of(s) && s->looked < t->most_pairs) {
        if (++s->popped % ASK_EVERY == 0 && csg_mesh_should_stop(t->watch))
            return false;
        csg_clear_queued top = csg_clear_queue_pop(&s->queue);
        if (s->popped > s->next_try) {
            s->next_try = s->popped + s->popped / TRIES;
            t->source.show(t->source.user, top.a, top.b, &s->best);
        }
        if (!divide(s, &top) || *t->out_of_memory) {
            s->left = fmin(s->left, top.key);
            return false;
        }
    }
    return true;
}

bool csg_wall_search(const csg_wall_task *task, csg_wall_found *out)
{
    search s = {.task = task, .left = INFINITY, .best.apart = INFINITY};
    bool done = consider(&s, 0, 0, -INFINITY);
    if (!done)
        s.left = -INFINITY; /* of the only pair nothing is known */
    done = done && divide_on(&s) && !*task->out_of_memory;
    out->low = fmin(fmax(low_of(&s), 0), s.best.apart);
    out->best = s.best;
    out->pairs = s.looked;
    csg_clear_queue_release(&s.queue, task->memory);
    return done;
}
