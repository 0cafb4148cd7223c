/* SPDX-License-Identifier: MIT
 * One pair of parts; see search.h. The candidates are pairs of cubes, one over each part, that may
 * hold points of them. Along a direction d the parts in such a pair are at least
 *   min d . b - max d . a
 * from each other, which is exact where both are plane and d is their normal; where it is negative,
 * what they have in common is no thicker along d. The least over all candidates is a lower bound of
 * the gap, points found on the way are the upper one. The candidate with the least bound is divided
 * first. Two cubes that are inside for certain and overlap prove that the parts interfere.
 *
 * Cubes that are inside matter where they overlap others alone: of parts that have no point in
 * common the nearest points are on both surfaces.
 *
 * The same search looks for the gap on the way from the pose before (motion.h).
 */
#include "clearance/search.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "clearance/between.h"
#include "clearance/overlap.h"
#include "clearance/places.h"
#include "clearance/queue.h"

enum {
    ASK_EVERY = 64,
    TRIES = 8 /* while the number of candidates doubles */,
    LATE = 64,
    ROUNDS = 4,
    FINEST = 16 /* of T */
};
/* Of what may be looked at: for how far apart they are, once that they are is known. */
enum { SHARE_DECIDED = 4, SHARE_NEARLY = 16 };
static const double NEARLY = 0.9;
/* Likewise for ways: to find out, and once it is known that they stay apart. */
enum { SHARE_WAY = 4, SHARE_WAY_DECIDED = 32 };

typedef struct search {
    const csg_clear_task *task;
    csg_clear_tree a, b;
    csg_clear_queue queue; /* candidates, by their bounds */
    double left;           /* the least bound of those that were let go */
    double left_size;
    double high; /* nearest are so far apart */
    csg_vec3 nearest[2], inside;
    const csg_motion *motion; /* of b: the gap on the way is looked for */
    double goal;              /* then: as much of it is enough */
    bool interferes;
    uint64_t looked, popped, next_try;
    bool out_of_memory;
} search;

/* ---- the candidates ----------------------------------------------------------------------------
 */

static void let_go(search *s, const csg_clear_queued *item)
{
    s->left = fmin(s->left, item->key);
    if (item->key <= 0) {
        double a = s->a.nodes[item->a].cube.half, b = s->b.nodes[item->b].cube.half;
        s->left_size = fmax(s->left_size, 2 * fmin(a, b));
    }
}

/* ---- points ------------------------------------------------------------------------------------
 */

static csg_vec3 center_of(const csg_clear_tree *t, uint32_t node)
{
    const double *c = t->nodes[node].cube.c;
    return csg_vec3_add(csg_clear_part_origin(t->part), csg_vec3_make(c[0], c[1], c[2]));
}

static void found_common(search *s, csg_vec3 at)
{
    s->interferes = true;
    s->inside = at;
}

static void take_nearest(search *s, csg_vec3 a, csg_vec3 b)
{
    double apart = csg_vec3_norm(csg_vec3_sub(b, a));
    if (apart < s->high) {
        s->high = apart;
        s->nearest[0] = a;
        s->nearest[1] = b;
    }
}

/* From one surface to the other and back. */
static void try_nearest(search *s, csg_vec3 from)
{
    const csg_clear_task *t = s->task;
    csg_vec3 p[2];
    const csg_clear_part *parts[2] = {t->a, t->b};
    double last = INFINITY;
    for (int i = 0; i < 2 * ROUNDS && !s->interferes; i++) {
        int side = i % 2;
        if (!csg_clear_settle(parts[side], t->worker, i ? p[1 - side] : from, &p[side],
                              &s->out_of_memory))
            return;
        if (csg_clear_is_inside(parts[1 - side], t->worker, p[side], &s->out_of_memory))
            found_common(s, p[side]);
        else if (i)
            take_nearest(s, p[0], p[1]);
        if (i && side) {
            double apart = csg_vec3_norm(csg_vec3_sub(p[1], p[0]));
            if (apart > last - t->tolerance / 8)
                return;
            last = apart;
        }
    }
}

static void try_common(search *s, const csg_clear_queued *top)
{
    const csg_clear_task *t = s->task;
    const csg_measure_cube *a = &s->a.nodes[top->a].cube, *b = &s->b.nodes[top->b].cube;
    csg_vec3 from = a->half < b->half ? center_of(&s->a, top->a) : center_of(&s->b, top->b), found;
    if (csg_clear_find_common(t->a, t->b, t->worker, from, fmin(a->half, b->half), &found,
                              &s->out_of_memory))
        found_common(s, found);
}

static void try_points(search *s, const csg_clear_queued *top)
{
    bool overlap = top->key <= 0;
    if (s->popped < s->next_try)
        return;
    s->next_try = s->popped + 1 + s->popped / TRIES;
    if (overlap)
        try_common(s, top);
    if (!s->interferes && s->high > fmax(top->key, 0) + 0.25 * s->task->tolerance)
        try_nearest(s, center_of(&s->a, top->a));
}

/* ---- the search --------------------------------------------------------------------------------
 */

/* Candidates that are as far apart need not be divided: the gap is known by the others, or on which
 * side of min_gap it is. */
static double enough_of(const search *s)
{
    const csg_clear_task *t = s->task;
    if (s->motion)
        return s->goal;
    double enough = s->high < INFINITY ? s->high - csg_clear_room(t, s->high) : INFINITY;
    if (t->min_gap > enough && t->min_gap <= s->high)
        enough = fmin(t->min_gap, s->high - t->tolerance / FINEST);
    return fmin(enough, t->enough);
}

/* Two cubes that are inside and overlap: the middle of what they have in common. */
static csg_vec3 middle_of(const search *s, uint32_t a, uint32_t b)
{
    csg_vec3 p = center_of(&s->a, a), q = center_of(&s->b, b);
    double ha = s->a.nodes[a].cube.half, hb = s->b.nodes[b].cube.half;
    const double pa[3] = {p.x, p.y, p.z}, pb[3] = {q.x, q.y, q.z};
    double m[3];
    for (int k = 0; k < 3; k++)
        m[k] = 0.5 * (fmax(pa[k] - ha, pb[k] - hb) + fmin(pa[k] + ha, pb[k] + hb));
    return csg_vec3_make(m[0], m[1], m[2]);
}

/* False: out of memory. */
static bool consider(search *s, uint32_t a, uint32_t b, double parent_bound)
{
    bool overlap;
    double enough = enough_of(s);
    csg_clear_queued item = {.a = a, .b = b};
    csg_vec3 along =
        s->high < INFINITY ? csg_vec3_sub(s->nearest[1], s->nearest[0]) : (csg_vec3){0, 0, 0};
    s->looked++;
    item.key = fmax(parent_bound,
                    csg_clear_between(&s->a, a, &s->b, b, s->motion, along, enough, &overlap));
    bool in_a = s->a.nodes[a].cube.state == CSG_CELL_INSIDE,
         in_b = s->b.nodes[b].cube.state == CSG_CELL_INSIDE;
    if ((in_a || in_b) && (!overlap || s->motion)) /* surfaces are the first to meet on a way */
        return true;
    if (in_a && in_b) {
        csg_vec3 middle = middle_of(s, a, b);
        if (csg_clear_is_inside(s->task->a, s->task->worker, middle, &s->out_of_memory) &&
            csg_clear_is_inside(s->task->b, s->task->worker, middle, &s->out_of_memory)) {
            found_common(s, middle);
            return true;
        }
        let_go(s, &item); /* they touch, or nearly */
        return !s->out_of_memory;
    }
    if (item.key > 0 && item.key >= enough) {
        let_go(s, &item);
        return true;
    }
    bool done = csg_clear_queue_push(&s->queue, s->a.arena.memory, item);
    s->out_of_memory |= !done;
    return done;
}

static bool divide(search *s, const csg_clear_queued *top)
{
    int which = csg_clear_choose(&s->a, top->a, &s->b, top->b);
    csg_clear_tree *tree = which == 0 ? &s->a : &s->b;
    uint32_t node = which == 0 ? top->a : top->b;
    if (which < 0) {
        let_go(s, top);
        return true;
    }
    if (!csg_clear_tree_divide(tree, node)) {
        s->out_of_memory = true;
        return false;
    }
    uint32_t first = tree->nodes[node].first_child, count = tree->nodes[node].child_count;
    for (uint32_t i = first; i < first + count && !s->interferes; i++)
        if (!consider(s, which == 0 ? i : top->a, which == 0 ? top->b : i, top->key))
            return false;
    return true;
}

static double low_of(const search *s)
{
    return s->queue.count ? fmin(s->left, s->queue.items[0].key) : s->left;
}

static bool is_known(const search *s)
{
    const csg_clear_task *t = s->task;
    double low = low_of(s);
    bool straddles = t->min_gap > 0 && low < t->min_gap && t->min_gap <= s->high;
    bool is_decided = low > 0 && !straddles;
    if (is_decided && low >= t->enough)
        return true;
    /* of a later pose it is enough that they are apart: it may be told as the worst then */
    bool is_nearly = low >= NEARLY * s->high || t->enough < INFINITY;
    uint64_t share = is_nearly ? SHARE_NEARLY : SHARE_DECIDED;
    if (is_decided && s->looked >= t->most_pairs / share)
        return true;
    if (straddles)
        return low >= s->high - t->tolerance / FINEST;
    return (s->high <= t->tolerance && low >= -t->tolerance) || low >= enough_of(s);
}

/* False: it was stopped. */
static bool divide_on(search *s)
{
    const csg_clear_task *t = s->task;
    while (s->queue.count && !s->interferes && !is_known(s) && s->looked < t->most_pairs) {
        if (++s->popped % ASK_EVERY == 0 && csg_mesh_should_stop(t->watch))
            return false;
        try_points(s, &s->queue.items[0]);
        if (s->out_of_memory)
            return false;
        if (s->interferes || is_known(s))
            return true;
        csg_clear_queued top = csg_clear_queue_pop(&s->queue);
        if (!divide(s, &top)) {
            let_go(s, &top);
            return false;
        }
        if (s->out_of_memory)
            return false;
    }
    return true;
}

static bool tell(search *s, csgm_clear_pair *out)
{
    const csg_clear_task *t = s->task;
    bool done = true;
    double low = low_of(s);
    out->pairs = s->looked;
    if (s->interferes) {
        out->state = CSGM_CLEAR_INTERFERING;
        out->gap = (csgm_interval){0, 0};
        out->inside = s->inside;
        done = csg_clear_overlap(&s->a, &s->b, t->enough_volume, t->watch, &out->volume,
                                 &s->out_of_memory);
        return done;
    }
    out->gap = (csgm_interval){fmin(fmax(low, 0), s->high), s->high};
    out->nearest[0] = s->nearest[0];
    out->nearest[1] = s->nearest[1];
    if (low > 0)
        out->state = CSGM_CLEAR_APART;
    else if (low >= -t->tolerance && s->high <= t->tolerance)
        out->state = CSGM_CLEAR_TOUCHING;
    else
        out->state = CSGM_CLEAR_UNDECIDED;
    if (out->state == CSGM_CLEAR_UNDECIDED) {
        for (size_t i = 0; i < s->queue.count; i++)
            let_go(s, &s->queue.items[i]);
        out->size = s->left_size;
    }
    return done;
}

/* ---- on the way to the pose before ------------------------------------------------------------
 * Parts that are apart at its end are apart all the way, unless points of their surfaces meet: the
 * same search, with bounds that hold all the way.
 */

/* Of the nearest points even their own way leaves no room: no bound will show it. */
static bool is_hopeless(const search *s)
{
    const csg_clear_task *t = s->task;
    if (!(s->high < INFINITY))
        return false;
    csg_vec3 from = s->nearest[1], to = csg_affine_point(&s->motion->back, from);
    csg_vec3 way = csg_vec3_sub(to, from), out = csg_vec3_sub(s->nearest[0], from);
    double square = csg_vec3_dot(way, way);
    double share = square > 0 ? fmin(fmax(csg_vec3_dot(out, way) / square, 0), 1) : 0;
    csg_vec3 left = csg_vec3_sub(out, csg_vec3_scale(way, share));
    return csg_vec3_norm(left) - s->motion->bend * sqrt(square) <= t->min_gap;
}

static bool is_way_known(const search *s)
{
    const csg_clear_task *t = s->task;
    double low = low_of(s);
    if (low >= s->goal)
        return true;
    return s->looked >=
           t->most_pairs / (low > 0 && low >= t->min_gap ? SHARE_WAY_DECIDED : SHARE_WAY);
}

/* gap: at its end, > 0. Uses the trees of `at_end`, which goes on having them. False: stopped, or
 * out of memory. */
static bool look_along_way(search *at_end, double gap, csgm_clear_pair *out)
{
    const csg_clear_task *t = at_end->task;
    search s = {.task = t,
                .a = at_end->a,
                .b = at_end->b,
                .left = INFINITY,
                .high = at_end->high,
                .nearest = {at_end->nearest[0], at_end->nearest[1]},
                .motion = t->motion,
                .goal = fmax(0.5 * gap, t->min_gap)};
    bool done = true;
    if (is_hopeless(&s))
        return true;
    done = consider(&s, 0, 0, -INFINITY);
    while (done && s.queue.count && !is_way_known(&s)) {
        if (++s.popped % ASK_EVERY == 0 && csg_mesh_should_stop(t->watch))
            done = false;
        csg_clear_queued top = csg_clear_queue_pop(&s.queue);
        done = done && divide(&s, &top);
    }
    if (done)
        out->gap_between = fmin(fmax(low_of(&s), 0), gap);
    out->pairs += s.looked;
    at_end->out_of_memory |= s.out_of_memory;
    at_end->a = s.a;
    at_end->b = s.b;
    csg_clear_queue_release(&s.queue, s.a.arena.memory);
    return done && !s.out_of_memory;
}

bool csg_clear_search(const csg_clear_task *task, csgm_clear_pair *out, bool *out_of_memory)
{
    search s = {.task = task, .left = INFINITY, .high = INFINITY};
    if (task->enough < INFINITY) /* bounds alone will do as a rule */
        s.next_try = LATE;
    if (!task->a->is_open || !task->b->is_open) {
        out->gap = (csgm_interval){INFINITY, INFINITY};
        out->gap_between = INFINITY;
        return true;
    }
    out->gap_between = 0;
    bool done = csg_clear_tree_begin(&s.a, task->a, task->worker) &&
                csg_clear_tree_begin(&s.b, task->b, task->worker);
    s.out_of_memory = !done;
    if (done && s.a.count && s.b.count && task->apart > 0) {
        done = look_along_way(&s, task->apart, out);
    } else if (done && s.a.count && s.b.count) {
        done = consider(&s, 0, 0, -INFINITY);
        if (!done)
            s.left = -INFINITY; /* of the only candidate nothing is known */
        done = done && divide_on(&s);
        done = tell(&s, out) && done && !s.out_of_memory;
        if (done && task->motion && out->state == CSGM_CLEAR_APART)
            done = look_along_way(&s, out->gap.low, out);
    } else if (done) {
        out->gap = (csgm_interval){INFINITY, INFINITY};
        out->gap_between = INFINITY;
    } else {
        out->state = CSGM_CLEAR_UNDECIDED;
        out->gap = (csgm_interval){0, INFINITY};
    }
    *out_of_memory |= s.out_of_memory;
    csg_clear_queue_release(&s.queue, &task->a->walk.context->memory);
    csg_clear_tree_release(&s.a);
    csg_clear_tree_release(&s.b);
    return done;
}
