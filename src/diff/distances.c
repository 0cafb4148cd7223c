/* SPDX-License-Identifier: MIT
 * Points and samples of one mesh, their nearest triangles on the other; see distances.h. Items of
 * work are runs of 1024, each starts its search where the last point's ended; sums are made in the
 * order of the samples.
 *
 * Near the middle of a ball a search sees all of it, for each of a small part's points. So what a
 * costly search found serves the points close to it as well: they are at least so far as the
 * distance between them allows.
 */
#include "diff/distances.h"

#include <stdlib.h>

#include "base/pool.h"

enum {
    RUN = 1024,
    COSTLY = 256 /* leaves of a search; most see some tens */
};
/* Of its distance: how close to a costly search's point others take what it found. Their distance
 * is then up to twice this less than it is. */
static const double CLOSE = 0x1p-12;

static csg_diff_side *other_of(csg_diff_pair *pair, int from)
{
    return &pair->sides[1 - from];
}

static size_t run_count(uint64_t count)
{
    return (size_t)((count + RUN - 1) / RUN);
}

/* ---- one point ------------------------------------------------------------------------------ */

/* The last search of a run. */
typedef struct last_search {
    csg_vec3 at;
    double distance;
    uint32_t place;
    bool is_costly;
} last_search;

/* At most the distance to the nearest triangle, whose place is *place. */
static double distance_from(const csg_tree *tree, csg_vec3 p, last_search *last, uint32_t *place)
{
    double between = last->is_costly ? csg_vec3_norm(csg_vec3_sub(p, last->at)) : INFINITY;
    *place = last->place;
    if (between <= CLOSE * last->distance)
        return last->distance - between;
    csg_triangle_hit nearest = csg_tree_nearest(tree, p, last->place);
    *last = (last_search){p, sqrt(nearest.squared), nearest.place, nearest.leaves >= COSTLY};
    *place = last->place;
    return last->distance;
}

/* ---- points --------------------------------------------------------------------------------- */

typedef struct point_work {
    csg_diff_pair *pair;
    int from;
} point_work;

static bool measure_run(void *user, uint32_t worker, size_t index)
{
    (void)worker;
    const point_work *w = user;
    csg_diff_side *side = &w->pair->sides[w->from];
    const csg_tree *tree = &other_of(w->pair, w->from)->tree;
    size_t end = (index + 1) * RUN < side->point_count ? (index + 1) * RUN : side->point_count;
    last_search last = {.place = 0};
    for (size_t i = index * RUN; i < end; i++) {
        uint32_t point = side->points[i];
        side->distance[point] =
            distance_from(tree, w->pair->points[point], &last, &side->nearest[point]);
    }
    return !csg_diff_is_cancelled(w->pair);
}

static void report_runs(void *user, size_t done, size_t count)
{
    csg_diff_tell(((point_work *)user)->pair, done, count);
}

csgm_status csg_diff_measure_points(csg_diff_pair *pair)
{
    for (int from = 0; from < 2; from++) {
        csg_diff_side *side = &pair->sides[from];
        side->distance = csg_arena_alloc(&side->arena, pair->point_count * sizeof *side->distance);
        side->nearest = csg_arena_alloc(&side->arena, pair->point_count * sizeof *side->nearest);
        if (!side->distance || !side->nearest)
            return csg_context_no_memory(pair->context);
        point_work w = {pair, from};
        csg_diff_take(pair, 0.05);
        if (!csg_pool_run(pair->context->pool, run_count(side->point_count), measure_run,
                          report_runs, &w))
            return CSGM_CANCELLED;
    }
    return CSGM_OK;
}

/* ---- where samples lie ---------------------------------------------------------------------- */

static double area_of(const csg_diff_side *side, size_t triangle)
{
    csg_vec3 a = csg_diff_corner(side, triangle, 0), b = csg_diff_corner(side, triangle, 1),
             c = csg_diff_corner(side, triangle, 2);
    return 0.5 * csg_vec3_norm(csg_vec3_cross(csg_vec3_sub(b, a), csg_vec3_sub(c, a)));
}

bool csg_diff_sampler_make(csg_diff_sampler *sampler, csg_diff_side *side, uint64_t count)
{
    size_t triangles = side->chain.count;
    *sampler = (csg_diff_sampler){side, NULL, count};
    sampler->area_before =
        csg_arena_alloc(&side->arena, (triangles + 1) * sizeof *sampler->area_before);
    if (!sampler->area_before)
        return false;
    double sum = 0;
    for (size_t t = 0; t < triangles; t++) {
        sampler->area_before[t] = sum;
        sum += area_of(side, t);
    }
    sampler->area_before[triangles] = sum;
    return true;
}

static double target_of(const csg_diff_sampler *sampler, uint64_t index)
{
    return ((double)index + 0.5) / (double)sampler->count *
           sampler->area_before[sampler->side->chain.count];
}

size_t csg_diff_sampler_find(const csg_diff_sampler *sampler, uint64_t index)
{
    double target = target_of(sampler, index);
    size_t low = 0, high = sampler->side->chain.count;
    while (high - low > 1) {
        size_t middle = low + (high - low) / 2;
        if (sampler->area_before[middle] <= target)
            low = middle;
        else
            high = middle;
    }
    return low;
}

/* The fraction of index * factor / 2^64. */
static double fraction(uint64_t index, uint64_t factor)
{
    return (double)((index * factor) >> 11) * 0x1p-53;
}

csg_diff_sample csg_diff_sampler_get(const csg_diff_sampler *sampler, uint64_t index, size_t hint)
{
    double target = target_of(sampler, index);
    csg_diff_sample s = {.triangle = hint};
    while (s.triangle + 1 < sampler->side->chain.count &&
           sampler->area_before[s.triangle + 1] <= target)
        s.triangle++;
    /* 1 / p and 1 / p^2, p^3 = p + 1 */
    double u = fraction(index + 1, 0xC13FA9A902A6328Fu),
           v = fraction(index + 1, 0x91E10DA5C79E7B1Du);
    if (u + v > 1) {
        u = 1 - u;
        v = 1 - v;
    }
    csg_vec3 a = csg_diff_corner(sampler->side, s.triangle, 0);
    csg_vec3 ab = csg_vec3_sub(csg_diff_corner(sampler->side, s.triangle, 1), a);
    csg_vec3 ac = csg_vec3_sub(csg_diff_corner(sampler->side, s.triangle, 2), a);
    s.at = csg_vec3_add(a, csg_vec3_add(csg_vec3_scale(ab, u), csg_vec3_scale(ac, v)));
    s.weights[0] = 1 - u - v;
    s.weights[1] = u;
    s.weights[2] = v;
    return s;
}

/* ---- colours -------------------------------------------------------------------------------- */

/* Weights of the corners of a triangle of the tree at its point nearest to p. */
static void weights_at(const csg_tree_triangle *t, csg_vec3 p, double weights[3])
{
    bool in_face;
    csg_vec3 foot = csg_vec3_sub(csg_triangle_foot(t, p, &in_face), t->a);
    csg_vec3 normal = csg_vec3_cross(t->ab, t->ac), side = csg_vec3_cross(normal, foot);
    double w = csg_vec3_dot(normal, normal);
    weights[1] = w > 0 ? csg_vec3_dot(side, t->ac) / w : 0;
    weights[2] = w > 0 ? -csg_vec3_dot(side, t->ab) / w : 0;
    weights[0] = 1 - weights[1] - weights[2];
}

static double mixed(const csgm_mesh_view *view, size_t triangle, const double weights[3],
                    uint32_t channel)
{
    double sum = 0;
    for (size_t k = 0; k < 3; k++)
        sum += weights[k] * view->colors[4 * (size_t)view->indices[3 * triangle + k] + channel];
    return sum;
}

static double color_difference(const csg_diff_pair *pair, int from, const csg_diff_sample *sample,
                               uint32_t place)
{
    const csg_diff_side *side = &pair->sides[from], *other = &pair->sides[1 - from];
    const csg_tree_triangle *t = &other->tree.triangles[place];
    double weights[3], largest = 0;
    weights_at(t, sample->at, weights);
    for (uint32_t channel = 0; channel < 4; channel++)
        largest = fmax(largest, fabs(mixed(side->view, sample->triangle, sample->weights, channel) -
                                     mixed(other->view, t->index, weights, channel)));
    return largest;
}

/* ---- measuring samples ---------------------------------------------------------------------- */

typedef struct sample_work {
    csg_diff_pair *pair;
    int from;
    csg_diff_sampler sampler;
    double *distances;
    float *colors; /* differences, or NULL */
} sample_work;

static bool sample_run(void *user, uint32_t worker, size_t index)
{
    (void)worker;
    sample_work *w = user;
    const csg_tree *tree = &other_of(w->pair, w->from)->tree;
    uint64_t begin = (uint64_t)index * RUN;
    uint64_t end = begin + RUN < w->sampler.count ? begin + RUN : w->sampler.count;
    size_t triangle = csg_diff_sampler_find(&w->sampler, begin);
    last_search last = {.place = 0};
    for (uint64_t i = begin; i < end; i++) {
        csg_diff_sample s = csg_diff_sampler_get(&w->sampler, i, triangle);
        uint32_t place;
        triangle = s.triangle;
        w->distances[i] = distance_from(tree, s.at, &last, &place);
        if (w->colors)
            w->colors[i] = (float)color_difference(w->pair, w->from, &s, place);
    }
    return !csg_diff_is_cancelled(w->pair);
}

static int compare_doubles(const void *left, const void *right)
{
    const double *a = left, *b = right;
    return (*a > *b) - (*a < *b);
}

/* The least distance that is not below this share of the samples. */
static double percentile(const double *sorted, uint64_t count, uint64_t percent)
{
    return sorted[(count * percent + 99) / 100 - 1];
}

static void summarize(sample_work *w, csgm_diff_distance *out, csgm_diff_place *largest)
{
    uint64_t count = w->sampler.count, worst = 0;
    double sum = 0, squares = 0, unit = w->pair->frame.unscale;
    for (uint64_t i = 0; i < count; i++) {
        double d = w->distances[i];
        sum += d;
        squares += d * d;
        worst = d > w->distances[worst] ? i : worst;
    }
    csg_diff_sample s =
        csg_diff_sampler_get(&w->sampler, worst, csg_diff_sampler_find(&w->sampler, worst));
    *largest = (csgm_diff_place){.at = s.at, .distance = w->distances[worst]};
    qsort(w->distances, count, sizeof *w->distances, compare_doubles);
    out->is_sampled = true;
    out->mean = sum / (double)count * unit;
    out->rms = sqrt(squares / (double)count) * unit;
    out->percentile_95 = percentile(w->distances, count, 95) * unit;
    out->percentile_99 = percentile(w->distances, count, 99) * unit;
}

static void summarize_colors(const sample_work *w, csgm_diff_attribute *out)
{
    enum { VISIBLE = 16 };
    uint64_t differing = 0;
    for (uint64_t i = 0; i < w->sampler.count; i++) {
        double d = (double)w->colors[i];
        out->largest = fmax(out->largest, d);
        differing += d > VISIBLE;
    }
    out->is_compared = true;
    out->share = fmax(out->share, (double)differing / (double)w->sampler.count);
}

static void report_samples(void *user, size_t done, size_t count)
{
    csg_diff_tell(((sample_work *)user)->pair, done, count);
}

csgm_status csg_diff_measure_samples(csg_diff_pair *pair, int from, uint64_t count,
                                     csgm_diff_distance *out, csgm_diff_attribute *colors,
                                     csgm_diff_place *largest)
{
    csg_memory *memory = &pair->context->memory;
    csg_diff_side *side = &pair->sides[from];
    sample_work w = {.pair = pair, .from = from};
    csg_arena_mark mark = csg_arena_get_mark(&side->arena);
    size_t size = (size_t)count * (sizeof *w.distances + (colors ? sizeof *w.colors : 0));
    csgm_status status = CSGM_OK;
    w.distances = count > SIZE_MAX / 16 ? NULL : csg_memory_alloc(memory, size);
    if (!w.distances || !csg_diff_sampler_make(&w.sampler, side, count)) {
        status = csg_context_no_memory(pair->context);
    } else {
        w.colors = colors ? (float *)(w.distances + count) : NULL;
        csg_diff_take(pair, 0.3);
        if (!csg_pool_run(pair->context->pool, run_count(count), sample_run, report_samples, &w))
            status = CSGM_CANCELLED;
    }
    if (status == CSGM_OK && colors)
        summarize_colors(&w, colors);
    if (status == CSGM_OK)
        summarize(&w, out, largest);
    csg_memory_release(memory, w.distances, size);
    csg_arena_release_to(&side->arena, mark);
    return status;
}

/* ---- the worst places ----------------------------------------------------------------------- */

/* What has moved far is one change as far around, but no more than a quarter of the whole: so a
 * place stands for its surroundings. */
static bool is_apart(const csg_diff_pair *pair, const csgm_diff_distance *out, csg_vec3 at,
                     double diagonal)
{
    for (uint32_t i = 0; i < out->worst_count; i++) {
        csg_vec3 away = csg_vec3_sub(at, csg_triangle_frame_enter(&pair->frame, out->worst[i].at));
        double moved = out->worst[i].distance * pair->frame.scale;
        double apart = fmax(0.05 * diagonal, fmin(moved, 0.25 * diagonal));
        if (csg_vec3_dot(away, away) < apart * apart)
            return false;
    }
    return true;
}

static csg_vec3 foot_of(const csg_tree *tree, uint32_t place, csg_vec3 p)
{
    bool in_face;
    return csg_triangle_foot(&tree->triangles[place], p, &in_face);
}

void csg_diff_find_worst(const csg_diff_pair *pair, int from, csgm_diff_distance *out)
{
    const csg_diff_side *side = &pair->sides[from];
    double diagonal = csg_vec3_norm(csg_box_size(pair->box)) * pair->frame.scale;
    while (out->worst_count < CSGM_DIFF_WORST_MOST) {
        size_t best = SIZE_MAX;
        double least = pair->precision;
        for (size_t i = 0; i < side->point_count; i++) {
            uint32_t point = side->points[i];
            if (side->distance[point] > least &&
                is_apart(pair, out, pair->points[point], diagonal)) {
                least = side->distance[point];
                best = point;
            }
        }
        if (best == SIZE_MAX)
            return;
        csg_vec3 at = pair->points[best];
        csg_vec3 foot = foot_of(&pair->sides[1 - from].tree, side->nearest[best], at);
        out->worst[out->worst_count++] = (csgm_diff_place){
            csg_triangle_frame_leave(&pair->frame, at),
            csg_triangle_frame_leave(&pair->frame, foot), least * pair->frame.unscale};
    }
}
