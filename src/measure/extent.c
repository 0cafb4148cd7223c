/* SPDX-License-Identifier: MIT
 * Tight bounds; see extent.h. Branch and bound along one direction at a time: of every cube it is
 * known how far the solid in it can reach, from the planes that the field is enclosed by, and how
 * far it does. Cubes that cannot reach beyond what is found are dropped; those that can reach
 * farthest are looked at first.
 */
#include "measure/extent.h"

#include <math.h>
#include <string.h>

#include "base/pool.h"

enum { ASK_EVERY = 256 };

/* One direction. */
typedef struct search {
    const csg_measure_walk *walk;
    csg_measure_worker *worker;
    int axis;
    double turn; /* 1: how large the coordinate is; -1: how small, of what is turned around */
    double tolerance;
    double found, left; /* the solid reaches so far; of what was dropped none reaches farther */
    uint64_t cubes, most;
    bool out_of_memory;
} search;

typedef struct candidate {
    csg_measure_cube cube;
    double most;
} candidate;

typedef struct searches {
    const csg_measure_walk *walk;
    double tolerance;
    uint64_t most;
    csg_extents *out;
    uint64_t cubes[CSG_EXTENTS];
    atomic_bool out_of_memory;
} searches;

static double bound_of(const search *s)
{
    csg_box b = s->walk->bounds;
    const double low[3] = {b.min.x, b.min.y, b.min.z}, high[3] = {b.max.x, b.max.y, b.max.z};
    return s->turn > 0 ? high[s->axis] : -low[s->axis];
}

/* The largest coordinate in the cube of a point with value + slope . x >= 0; -INFINITY: none. */
static double reach_of(const search *s, const csg_measure_cube *q, double value,
                       const double slope[3])
{
    double along = s->turn * slope[s->axis], rest = value, middle = s->turn * q->c[s->axis];
    for (int k = 0; k < 3; k++)
        rest += k == s->axis ? 0 : fabs(slope[k]) * q->half;
    if (rest + along * q->half >= 0)
        return middle + q->half;
    if (along >= 0 || !(rest + fabs(along) * q->half >= 0))
        return -INFINITY;
    return middle + fmin(fmax(-rest / along, -q->half), q->half);
}

/* The same of a formula; sure: of points that are in the solid for certain. Of an intersection that
 * is known of one operand alone, where the others hold all over the cube. */
static double reach_of_halves(const search *s, const csg_measure_cube *q, const csg_halves *h,
                              bool sure)
{
    static const double ROUNDING = 1e-12; /* of the planes' own arithmetic */
    double stack[CSG_HALVES_CODE], full = s->turn * q->c[s->axis] + q->half;
    int top = 0;
    for (int i = 0; i < h->length; i++) {
        if (h->code[i] >= 0) {
            const csg_enclosure *e = &h->planes[h->code[i]];
            double steep = fabs(e->slope[0]) + fabs(e->slope[1]) + fabs(e->slope[2]);
            double room = ROUNDING * (fabs(e->value) + q->half * steep);
            double value = sure ? e->value - e->below - room : e->value + e->above + room;
            bool is_all = sure && value >= q->half * steep;
            stack[top++] = is_all ? INFINITY : reach_of(s, q, value, e->slope);
            continue;
        }
        double a = stack[top - 2], b = stack[top - 1], least = fmin(a, b), most = fmax(a, b);
        if (h->code[i] == CSG_HALVES_UNION)
            stack[--top - 1] = most;
        else
            stack[--top - 1] = !sure || most >= INFINITY ? least : -INFINITY;
    }
    return fmin(stack[0], full);
}

/* What the cube shows, and how far the solid in it can reach. */
static double look_at(search *s, csg_measure_cube *q)
{
    csg_halves halves;
    double most = s->turn * q->c[s->axis] + q->half;
    s->cubes++;
    if (q->state == CSG_CELL_SURFACE && csg_measure_enclose(s->walk, s->worker, q, &halves)) {
        s->found = fmax(s->found, reach_of_halves(s, q, &halves, true));
        most = fmin(most, reach_of_halves(s, q, &halves, false));
    }
    if (q->state == CSG_CELL_INSIDE)
        s->found = fmax(s->found, most);
    if (q->state == CSG_CELL_OUTSIDE)
        most = -INFINITY;
    return fmin(most, bound_of(s));
}

static void sort(candidate *items, int count)
{
    for (int i = 1; i < count; i++) {
        candidate item = items[i];
        int k = i;
        for (; k > 0 && items[k - 1].most < item.most; k--)
            items[k] = items[k - 1];
        items[k] = item;
    }
}

/* False: out of memory, or it is time to stop. */
static bool descend(search *s, const csg_measure_cube *parent, double parent_most)
{
    csg_measure_cube children[CSG_OCTANTS];
    candidate items[CSG_OCTANTS];
    int count = 0;
    csg_arena_mark mark = csg_arena_get_mark(&s->worker->arena);
    bool done = csg_measure_divide(s->walk, s->worker, parent, &s->worker->arena, children);
    s->out_of_memory |= !done;
    for (int o = 0; o < CSG_OCTANTS && done; o++) {
        if (children[o].state == CSG_CELL_OUTSIDE)
            continue;
        double most = fmin(look_at(s, &children[o]), parent_most);
        if (children[o].state == CSG_CELL_SURFACE && most > -INFINITY)
            items[count++] = (candidate){children[o], most};
        if (s->cubes % ASK_EVERY == 0 && csg_mesh_should_stop(s->walk->watch))
            done = false;
    }
    sort(items, count);
    for (int i = 0; i < count && done; i++) {
        bool is_last = items[i].cube.level >= CSG_MEASURE_DEEPEST || s->cubes >= s->most;
        if (items[i].most <= s->found + s->tolerance || is_last)
            s->left = fmax(s->left, items[i].most);
        else
            done = descend(s, &items[i].cube, items[i].most);
    }
    csg_arena_release_to(&s->worker->arena, mark);
    return done;
}

/* All cubes of the frontier, the farthest ones first: in layers of their own order. */
static bool search_all(search *s)
{
    const csg_measure_walk *w = s->walk;
    for (size_t i = 0; i < w->count; i++)
        if (w->cubes[i].state == CSG_CELL_INSIDE)
            s->found = fmax(s->found, s->turn * w->cubes[i].c[s->axis] + w->cubes[i].half);
    for (double layer = INFINITY;;) {
        double next = -INFINITY;
        for (size_t i = 0; i < w->count; i++) {
            double most = s->turn * w->cubes[i].c[s->axis] + w->cubes[i].half;
            if (w->cubes[i].state == CSG_CELL_SURFACE && most < layer)
                next = fmax(next, most);
        }
        layer = next;
        if (!(layer > -INFINITY))
            return true;
        if (fmin(layer, bound_of(s)) <= s->found + s->tolerance) {
            s->left = fmax(s->left, fmin(layer, bound_of(s)));
            return true;
        }
        for (size_t i = 0; i < w->count; i++) {
            csg_measure_cube cube = w->cubes[i];
            double at = s->turn * cube.c[s->axis] + cube.half;
            if (cube.state != CSG_CELL_SURFACE || at < layer || at > layer)
                continue;
            double most = look_at(s, &cube);
            if (cube.state == CSG_CELL_SURFACE && most > s->found + s->tolerance) {
                if (!descend(s, &cube, most))
                    return false;
            } else {
                s->left = fmax(s->left, most);
            }
        }
    }
}

static bool search_one(void *user, uint32_t worker_index, size_t index)
{
    searches *all = user;
    search s = {.walk = all->walk,
                .worker = &all->walk->workers[worker_index],
                .axis = (int)index % 3,
                .turn = index < 3 ? -1 : 1,
                .tolerance = all->tolerance,
                .found = -INFINITY,
                .left = -INFINITY,
                .most = all->most};
    csg_extents *out = all->out;
    bool done = search_all(&s);
    if (s.out_of_memory)
        atomic_store(&all->out_of_memory, true);
    all->cubes[index] = s.cubes;
    double most = done ? fmin(fmax(s.found, s.left), bound_of(&s)) : bound_of(&s);
    out->is_found[index] = s.found > -INFINITY;
    double least = out->is_found[index] ? fmin(s.found, most) : -most;
    out->low[index] = s.turn > 0 ? least : -most;
    out->high[index] = s.turn > 0 ? most : -least;
    return done;
}

csgm_status csg_measure_extents(csg_measure_walk *walk, double tolerance, uint64_t most_cubes,
                                csg_extents *out)
{
    searches all = {
        .walk = walk, .tolerance = tolerance, .most = most_cubes / CSG_EXTENTS, .out = out};
    const double low[3] = {walk->bounds.min.x, walk->bounds.min.y, walk->bounds.min.z};
    const double high[3] = {walk->bounds.max.x, walk->bounds.max.y, walk->bounds.max.z};
    csgm_status status = CSGM_OK;
    *out = (csg_extents){.is_close = true};
    for (int i = 0; i < CSG_EXTENTS; i++) {
        out->low[i] = low[i % 3];
        out->high[i] = high[i % 3];
    }
    csg_mesh_take(walk->watch, CSGM_STAGE_MEASURE, 0.2);
    if (!csg_pool_run(walk->context->pool, CSG_EXTENTS, search_one, NULL, &all))
        status = atomic_load(&all.out_of_memory) ? csg_context_no_memory(walk->context)
                                                 : csg_mesh_why_stopped(walk->watch);
    for (int i = 0; i < CSG_EXTENTS; i++) {
        out->cubes += all.cubes[i];
        out->is_close &= out->is_found[i] && out->high[i] - out->low[i] <= 1.001 * tolerance;
    }
    return status;
}
