/* SPDX-License-Identifier: MIT
 * Tight bounds; see extent.h. Branch and bound along one direction at a time: of every cube it is
 * known how far the solid in it can reach, from the planes that the field is enclosed by, and how
 * far it does. Cubes that cannot reach beyond what is found are dropped; those that can reach
 * farthest are looked at first.
 */
#include "measure/extent.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/pool.h"
#include "measure/graph_field.h"

enum { ASK_EVERY = 256 };

/* Of the planes' own arithmetic, and of products with directions. */
static const double ROUNDING = 1e-12, OF_PRODUCTS = 1e-15;

/* Of points in one cube, from its centre; along: -INFINITY where there is none. */
typedef struct corner {
    double along, at[3];
} corner;

/* One direction. */
typedef struct search {
    const csg_measure_walk *walk;
    csg_measure_worker *worker;
    double d[3], width; /* of unit length, the sum of its components' sizes */
    double tolerance;
    double found, left; /* the solid reaches so far; of what was dropped none reaches farther */
    csg_vec3 at;        /* where it was found */
    uint64_t cubes, most;
    bool out_of_memory;
} search;

typedef struct candidate {
    csg_measure_cube cube;
    double most;
} candidate;

/* A cube of the frontier. */
typedef struct ranked {
    double most;
    size_t index;
} ranked;

typedef struct searches {
    const csg_measure_walk *walk;
    const csg_vec3 *directions;
    double tolerance;
    uint64_t most;
    csg_support_point *out;
    atomic_bool out_of_memory;
} searches;

static double bound_of(const search *s)
{
    csg_box b = s->walk->bounds;
    const double low[3] = {b.min.x, b.min.y, b.min.z}, high[3] = {b.max.x, b.max.y, b.max.z};
    double sum = 0;
    for (int k = 0; k < 3; k++) /* a zero times an infinite end does not occur: bounds are finite */
        sum += s->d[k] > 0 ? s->d[k] * high[k] : s->d[k] * low[k];
    return sum;
}

static double middle_of(const search *s, const csg_measure_cube *q)
{
    return s->d[0] * q->c[0] + s->d[1] * q->c[1] + s->d[2] * q->c[2];
}

static double farthest_of(const search *s, const csg_measure_cube *q)
{
    return middle_of(s, q) + s->width * q->half;
}

/* The point of the cube with value + slope . x >= 0 that is farthest along the direction: from the
 * farthest corner of the cube, coordinates turn back as far as need be, first those that cost least
 * for what they bring. */
static corner reach_of(const search *s, const csg_measure_cube *q, double value,
                       const double slope[3])
{
    corner out;
    double at = value;
    bool turned[3] = {false, false, false};
    for (int k = 0; k < 3; k++) {
        double sign = s->d[k] > 0 || s->d[k] < 0 ? s->d[k] : slope[k];
        out.at[k] = sign >= 0 ? q->half : -q->half;
        at += slope[k] * out.at[k];
    }
    for (int round = 0; round < 3 && !(at >= 0); round++) {
        int best = -1;
        for (int k = 0; k < 3; k++) {
            bool helps = !turned[k] && slope[k] * out.at[k] < 0;
            if (helps && (best < 0 || fabs(s->d[k] * slope[best]) < fabs(s->d[best] * slope[k])))
                best = k;
        }
        if (best < 0)
            break;
        double by = fmin(2 * q->half, -at / fabs(slope[best]));
        out.at[best] += out.at[best] > 0 ? -by : by;
        turned[best] = true;
        at = by < 2 * q->half ? 0 : at + fabs(slope[best]) * by;
    }
    out.along = -INFINITY;
    if (at >= 0)
        out.along =
            middle_of(s, q) + s->d[0] * out.at[0] + s->d[1] * out.at[1] + s->d[2] * out.at[2];
    return out;
}

static const corner NOWHERE = {.along = -INFINITY}, EVERYWHERE = {.along = INFINITY};

/* The same of a formula; sure: of points that are in the solid for certain. Of an intersection that
 * is known of one operand alone, where the others hold all over the cube. EVERYWHERE: all over. */
static corner reach_of_halves(const search *s, const csg_measure_cube *q, const csg_halves *h,
                              bool sure)
{
    corner stack[CSG_HALVES_CODE];
    int top = 0;
    for (int i = 0; i < h->length; i++) {
        if (h->code[i] >= 0) {
            const csg_enclosure *e = &h->planes[h->code[i]];
            double steep = fabs(e->slope[0]) + fabs(e->slope[1]) + fabs(e->slope[2]);
            double room = ROUNDING * (fabs(e->value) + q->half * steep);
            double value = sure ? e->value - e->below - room : e->value + e->above + room;
            bool is_all = sure && value >= q->half * steep;
            stack[top++] = is_all ? EVERYWHERE : reach_of(s, q, value, e->slope);
            continue;
        }
        const corner *a = &stack[top - 2], *b = &stack[top - 1];
        const corner least = a->along <= b->along ? *a : *b, most = a->along <= b->along ? *b : *a;
        if (h->code[i] == CSG_HALVES_UNION)
            stack[--top - 1] = most;
        else
            stack[--top - 1] = !sure || most.along >= INFINITY ? least : NOWHERE;
    }
    return stack[0];
}

static void take_found(search *s, const csg_measure_cube *q, corner found)
{
    if (!(found.along > s->found))
        return;
    s->found = found.along;
    s->at = csg_vec3_make(q->c[0] + found.at[0], q->c[1] + found.at[1], q->c[2] + found.at[2]);
}

/* Of a cube that is inside. */
static corner corner_of(const search *s, const csg_measure_cube *q)
{
    corner out = {.along = farthest_of(s, q)};
    for (int k = 0; k < 3; k++)
        out.at[k] = s->d[k] >= 0 ? q->half : -q->half;
    return out;
}

/* By planes, found by floats. Returns the farthest place that the solid can have in the cube. */
static corner look_at_planes(search *s, csg_measure_cube *q)
{
    csg_halves halves;
    if (!csg_measure_enclose(s->walk, s->worker, q, &halves))
        return corner_of(s, q);
    corner sure = reach_of_halves(s, q, &halves, true);
    take_found(s, q, sure.along >= INFINITY ? corner_of(s, q) : sure);
    const corner most = reach_of_halves(s, q, &halves, false), all = corner_of(s, q);
    return most.along < all.along ? most : all;
}

/* The same by Taylor models, which rounding of floats is no part of: where the field is positive,
 * one of its pieces is. */
static corner look_at_models(search *s, const csg_measure_cube *q)
{
    csg_taylor_pieces f; /* not filled: they are large */
    const double box[3] = {q->half, q->half, q->half};
    double far = 3 * q->half * q->half;
    corner most = NOWHERE;
    if (!csg_graph_field_pieces(&q->tape, q->c, q->half, &f))
        return corner_of(s, q);
    for (int i = 0; i < f.count; i++) {
        const csg_taylor *of = &f.of[i].f;
        double room =
            (csg_taylor_bends(of, box) + of->error + of->quartic * far * far) * (1 + ROUNDING) +
            ROUNDING * (fabs(of->value) + q->half * csg_norm3(of->slope));
        const corner reach = reach_of(s, q, of->value + room, of->slope);
        most = reach.along > most.along ? reach : most;
        if (f.count == 1)
            take_found(s, q, reach_of(s, q, of->value - room, of->slope));
    }
    return most;
}

/* Is all of the cube in the solid? */
static bool is_inside(const csg_measure_cube *q)
{
    csg_taylor_pieces f; /* not filled: they are large */
    if (!csg_graph_field_pieces(&q->tape, q->c, q->half, &f))
        return false;
    for (int i = 0; i < f.count; i++)
        if (!(csg_taylor_least(&f.of[i].f, csg_enclosure_radius(q->half)) > 0))
            return false;
    return true;
}

/* What is known all over a cube leaves its crease open, and what bends. Less than the tolerance
 * behind the farthest place that the solid may have in it there may be one that it has. */
static void probe(search *s, const csg_measure_cube *q, const corner *farthest)
{
    static const double BACK = 0.5, WIDE = 0x1p-6;
    csg_measure_cube at = *q;
    double along = 0;
    at.half = fmin(WIDE * s->tolerance, q->half);
    for (int k = 0; k < 3; k++) {
        double room = q->half - at.half, to = farthest->at[k] - BACK * s->tolerance * s->d[k];
        at.c[k] = q->c[k] + fmin(fmax(to, -room), room);
        along += s->d[k] * at.c[k];
    }
    if (along > s->found && is_inside(&at))
        take_found(s, &at, (corner){.along = along});
}

/* What the cube shows, and how far the solid in it can reach. */
static double look_at(search *s, csg_measure_cube *q)
{
    double most = farthest_of(s, q);
    s->cubes++;
    if (q->state == CSG_CELL_SURFACE) {
        corner farthest = look_at_planes(s, q);
        if (farthest.along > s->found + s->tolerance && q->state == CSG_CELL_SURFACE) {
            const corner by_models = look_at_models(s, q);
            farthest = by_models.along < farthest.along ? by_models : farthest;
        }
        most = fmin(most, farthest.along);
        if (most > s->found + s->tolerance && q->state == CSG_CELL_SURFACE)
            probe(s, q, &farthest);
    }
    if (q->state == CSG_CELL_INSIDE)
        take_found(s, q, corner_of(s, q));
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

static int by_reach(const void *a, const void *b)
{
    const ranked *p = a, *q = b;
    if (p->most < q->most || q->most < p->most)
        return p->most < q->most ? 1 : -1;
    return p->index < q->index ? -1 : 1;
}

/* The frontier's cubes that the surface goes through, the farthest ones first. */
static ranked *rank_frontier(search *s, size_t *count)
{
    const csg_measure_walk *w = s->walk;
    ranked *all = csg_arena_alloc(&s->worker->arena, (w->count + 1) * sizeof *all);
    *count = 0;
    for (size_t i = 0; all && i < w->count; i++)
        if (w->cubes[i].state == CSG_CELL_SURFACE)
            all[(*count)++] = (ranked){farthest_of(s, &w->cubes[i]), i};
    if (all)
        qsort(all, *count, sizeof *all, by_reach);
    s->out_of_memory |= !all;
    return all;
}

static bool search_all(search *s)
{
    const csg_measure_walk *w = s->walk;
    size_t count;
    ranked *all = rank_frontier(s, &count);
    for (size_t i = 0; i < w->count; i++)
        if (w->cubes[i].state == CSG_CELL_INSIDE)
            take_found(s, &w->cubes[i], corner_of(s, &w->cubes[i]));
    for (size_t i = 0; all && i < count; i++) {
        csg_measure_cube cube = w->cubes[all[i].index];
        double most = fmin(all[i].most, bound_of(s));
        bool is_new =
            i == 0 || all[i].most < all[i - 1].most; /* those in a row are all looked at */
        if (is_new && most <= s->found + s->tolerance) {
            s->left = fmax(s->left, most);
            return true;
        }
        most = look_at(s, &cube);
        if (cube.state != CSG_CELL_SURFACE || !(most > s->found + s->tolerance))
            s->left = fmax(s->left, most);
        else if (!descend(s, &cube, most))
            return false;
    }
    return all != NULL;
}

static bool search_one(void *user, uint32_t worker_index, size_t index)
{
    searches *all = user;
    const csg_vec3 d = all->directions[index];
    search s = {.walk = all->walk,
                .worker = &all->walk->workers[worker_index],
                .d = {d.x, d.y, d.z},
                .width = fabs(d.x) + fabs(d.y) + fabs(d.z),
                .tolerance = all->tolerance,
                .found = -INFINITY,
                .left = -INFINITY,
                .most = all->most};
    csg_support_point *out = &all->out[index];
    csg_arena_mark mark = csg_arena_get_mark(&s.worker->arena);
    bool done = search_all(&s), is_oblique = s.width > 1;
    csg_arena_release_to(&s.worker->arena, mark);
    if (s.out_of_memory)
        atomic_store(&all->out_of_memory, true);
    double slack = is_oblique ? OF_PRODUCTS * 8 * s.walk->half : 0;
    double most = done ? fmin(fmax(s.found, s.left), bound_of(&s)) : bound_of(&s);
    out->is_found = s.found > -INFINITY;
    out->low = (out->is_found ? fmin(s.found, most) : -INFINITY) - slack;
    out->high = most + slack;
    out->at = s.at;
    out->cubes = s.cubes;
    return done;
}

csgm_status csg_measure_reaches(csg_measure_walk *walk, const csg_vec3 *directions, size_t count,
                                double tolerance, uint64_t most_cubes, csg_support_point *out)
{
    searches all = {.walk = walk,
                    .directions = directions,
                    .tolerance = tolerance,
                    .most = most_cubes,
                    .out = out};
    for (size_t i = 0; i < count; i++) {
        search s = {.walk = walk, .d = {directions[i].x, directions[i].y, directions[i].z}};
        out[i] = (csg_support_point){.low = -INFINITY, .high = bound_of(&s) + 1e-14 * walk->half};
    }
    if (csg_pool_run(walk->context->pool, count, search_one, NULL, &all))
        return CSGM_OK;
    return atomic_load(&all.out_of_memory) ? csg_context_no_memory(walk->context)
                                           : csg_mesh_why_stopped(walk->watch);
}

csgm_status csg_measure_extents(csg_measure_walk *walk, double tolerance, uint64_t most_cubes,
                                csg_extents *out)
{
    static const csg_vec3 directions[CSG_EXTENTS] = {{-1, 0, 0}, {0, -1, 0}, {0, 0, -1},
                                                     {1, 0, 0},  {0, 1, 0},  {0, 0, 1}};
    const double low[3] = {walk->bounds.min.x, walk->bounds.min.y, walk->bounds.min.z};
    const double high[3] = {walk->bounds.max.x, walk->bounds.max.y, walk->bounds.max.z};
    csg_support_point reaches[CSG_EXTENTS];
    *out = (csg_extents){.is_close = true};
    csg_mesh_take(walk->watch, CSGM_STAGE_MEASURE, 0.2);
    csgm_status status = csg_measure_reaches(walk, directions, CSG_EXTENTS, tolerance,
                                             most_cubes / CSG_EXTENTS, reaches);
    for (int i = 0; i < CSG_EXTENTS; i++) {
        bool is_least = i < 3;
        double most = fmin(reaches[i].high, is_least ? -low[i % 3] : high[i % 3]);
        double least = is_least ? -high[i % 3] : low[i % 3];
        if (reaches[i].is_found)
            least = fmin(reaches[i].low, most);
        out->is_found[i] = reaches[i].is_found;
        out->low[i] = is_least ? -most : least;
        out->high[i] = is_least ? -least : most;
        out->cubes += reaches[i].cubes;
        out->is_close &= out->is_found[i] && out->high[i] - out->low[i] <= 1.001 * tolerance;
    }
    return status;
}
