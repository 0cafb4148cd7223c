/* SPDX-License-Identifier: MIT
 * Branch and bound; see maximum.h. A triangle's distance is bounded from above by that of its
 * corners to one triangle of the other mesh, since that is convex, or by a walk over the other mesh
 * (shape/polyhedra/cover.h), which settles most of two close surfaces; what is above the target is
 * cut along the nearest triangle's edges (or halved where the nearest place is on an edge) and its
 * parts looked up anew. Every distance computed at a point is a lower bound.
 *
 * Triangles are taken in the order of their bounds, in batches that double. Within a batch each
 * looks at the lower bound from before the batch and its own finds only, so that results do not
 * depend on which thread did what. A triangle that needs more than its share of cuts hands what is
 * left to the next batch.
 */
#include "diff/maximum.h"

#include <stdlib.h>
#include <string.h>

#include "base/pool.h"

enum {
    RUN = 4096,         /* triangles bounded at a time */
    CUTS_OF_ITEM = 512, /* before the rest is handed on; more where much is handed on */
    STACK = 160,
    LOOK_UP_EVERY = 4096, /* cuts: some milliseconds */
    FIRST_BATCH = 256,
    LAST_BATCH = 1 << 14
};
/* Cuts of one search: minutes; real meshes need a few for each triangle. */
static const uint64_t CUTS_MOST = (uint64_t)1 << 27;
/* Relative width that is aimed at; a little less than the 1 % that is promised. And how near to the
 * tolerance a maximum is settled: nearer, it would take minutes where much is equally far. */
static const double WIDTH = 0.009, NEAR_TOLERANCE = 1e-4;

typedef struct outcome {
    double lower, upper; /* upper: of what needs no more cuts */
    csg_vec3 at;
    csg_piece *left; /* not yet done */
    uint32_t left_count, cuts;
    bool is_found, out_of_memory;
} outcome;

typedef struct engine {
    csg_diff_pair *pair;
    csg_diff_maximum *search;
    const csg_diff_side *side, *other;
    float *bounds;  /* per triangle, rounded up */
    uint64_t *keys; /* of those above the target: the largest bound first, then by number */
    size_t key_count, next_key;
    csg_piece *items, *waiting; /* of this batch; left over from the last */
    size_t item_count, waiting_count, item_room, waiting_room;
    outcome *outcomes;
    uint64_t cuts;
    uint32_t cuts_of_item;
} engine;

/* What needs not be known better, given this lower bound. */
static double target_of(const engine *e, double lower)
{
    double target = fmax(lower * (1 + WIDTH), lower + 0.5 * e->pair->precision);
    double tolerance = e->search->tolerance;
    if (lower <= tolerance) /* on which side of it the maximum lies is the question */
        target = fmin(target, tolerance * (1 + NEAR_TOLERANCE));
    return fmax(target, fmax(tolerance, e->search->floor));
}

/* What is known to be above the tolerance is enough where only the verdict is asked for. */
static bool is_verdict_known(const csg_diff_maximum *search)
{
    return search->verdict_only && search->lower > search->tolerance;
}

/* ---- bounds of whole triangles -------------------------------------------------------------- */

static csg_piece piece_of(const engine *e, size_t triangle)
{
    csg_piece piece;
    piece.count = 3;
    const uint32_t *corners = e->side->chain.corners[triangle];
    double most = -1;
    for (int k = 0; k < 3; k++) {
        piece.corners[k] = e->pair->points[corners[k]];
        if (e->side->distance[corners[k]] > most) {
            most = e->side->distance[corners[k]];
            piece.hint = e->side->nearest[corners[k]];
        }
    }
    return piece;
}

/* By one triangle of the other mesh: the best of those that are nearest to the corners. */
static double bound_by_one(const engine *e, const csg_piece *piece, const uint32_t *corners)
{
    double least = INFINITY;
    uint32_t ignored, last = UINT32_MAX;
    for (int k = 0; k < 3; k++) {
        uint32_t place = e->side->nearest[corners[k]];
        if (place != last)
            least = fmin(least, csg_piece_bound(piece, &e->other->tree.triangles[place], &ignored));
        last = place;
    }
    return least;
}

/* Of triangles that both meshes have it is 0. Where both surfaces lie close together, most others
 * are shown to be within the target without a search. */
static double bound_of(const engine *e, size_t triangle)
{
    csg_piece piece = piece_of(e, triangle);
    const uint32_t *corners = e->side->chain.corners[triangle];
    const csg_tree *tree = &e->other->tree;
    double same = 0.5 * e->pair->precision, bound;
    for (int k = 0; k < 3; k++)
        if (csg_piece_is_within(&piece, &tree->triangles[e->side->nearest[corners[k]]], same))
            return same;
    if (!is_verdict_known(e->search) &&
        csg_triangle_is_covered(tree, e->other->across, piece.corners, piece.hint,
                                target_of(e, e->search->lower), &bound))
        return bound;
    return bound_by_one(e, &piece, corners);
}

static bool bound_run(void *user, uint32_t worker, size_t index)
{
    (void)worker;
    engine *e = user;
    size_t end =
        (index + 1) * RUN < e->side->chain.count ? (index + 1) * RUN : e->side->chain.count;
    for (size_t t = index * RUN; t < end; t++)
        e->bounds[t] = nextafterf((float)bound_of(e, t), INFINITY);
    return !csg_diff_is_cancelled(e->pair);
}

static int compare_keys(const void *left, const void *right)
{
    const uint64_t *a = left, *b = right;
    return (*a > *b) - (*a < *b);
}

/* Positive floats are in the order of their bits. */
static uint64_t key_of(float bound, size_t triangle)
{
    uint32_t bits;
    memcpy(&bits, &bound, sizeof bits);
    return (uint64_t)~bits << 32 | triangle;
}

static void extend_differing(engine *e, size_t triangle)
{
    for (int k = 0; k < 3; k++)
        csg_box_extend(&e->search->differing, csg_diff_corner(e->side, triangle, k));
}

/* Lists what is above the target; the rest is settled. */
static void list_keys(engine *e)
{
    double target = target_of(e, e->search->lower);
    e->search->differing = csg_box_empty();
    for (size_t t = 0; t < e->side->chain.count; t++) {
        double bound = (double)e->bounds[t];
        if (bound > e->pair->precision)
            extend_differing(e, t);
        if (bound > target)
            e->keys[e->key_count++] = key_of(e->bounds[t], t);
        else
            e->search->upper = fmax(e->search->upper, bound);
    }
    qsort(e->keys, e->key_count, sizeof *e->keys, compare_keys);
}

/* ---- one piece ------------------------------------------------------------------------------ */

static bool counts(const engine *e, csg_vec3 p)
{
    return e->search->wanted == CSG_DIFF_ALL_POINTS ||
           csg_diff_is_inside(e->other, p) == (e->search->wanted == CSG_DIFF_POINTS_INSIDE);
}

static void take_lower(const engine *e, outcome *out, double distance, csg_vec3 at)
{
    if (distance <= out->lower || !counts(e, at))
        return;
    out->lower = distance;
    out->at = at;
    out->is_found = true;
}

static csg_triangle_hit look_up(const engine *e, csg_vec3 p, uint32_t hint)
{
    csg_triangle_hit nearest = csg_tree_nearest(&e->other->tree, p, hint);
    nearest.squared = sqrt(nearest.squared);
    return nearest;
}

/* No point of the piece counts: the other surface does not reach it, and its centre does not. */
static bool is_unwanted(const engine *e, csg_vec3 center, double distance, double radius)
{
    return e->search->wanted != CSG_DIFF_ALL_POINTS && distance > radius + e->other->slack &&
           !counts(e, center);
}

/* Puts parts that are not settled on the stack. */
static void queue_parts(const engine *e, outcome *out, const csg_piece *parts, uint32_t count,
                        csg_piece *stack, uint32_t *depth)
{
    uint32_t ignored;
    for (uint32_t i = 0; i < count; i++) {
        csg_piece *part = &stack[*depth];
        *part = parts[i];
        part->bound = fmin(part->bound,
                           csg_piece_bound(part, &e->other->tree.triangles[part->hint], &ignored));
        if (part->bound > target_of(e, out->lower))
            ++*depth;
        else
            out->upper = fmax(out->upper, part->bound);
    }
}

/* Looks the piece up; settles it or cuts it. */
static void work_on(const engine *e, outcome *out, csg_piece piece, csg_piece *stack,
                    uint32_t *depth)
{
    csg_vec3 center = csg_piece_center(&piece);
    csg_triangle_hit nearest = look_up(e, center, piece.hint);
    const csg_tree_triangle *t = &e->other->tree.triangles[nearest.place];
    double radius = csg_piece_radius(&piece, center);
    uint32_t worst = 0;
    piece.hint = nearest.place;
    piece.bound = fmin(piece.bound, fmin(csg_piece_bound(&piece, t, &worst),
                                         nearest.squared + radius * (1 + 0x1p-40)));
    take_lower(e, out, nearest.squared, center);
    if (is_unwanted(e, center, nearest.squared, radius))
        return;
    if (piece.bound > target_of(e, out->lower)) {
        csg_vec3 corner = piece.corners[worst];
        take_lower(e, out, look_up(e, corner, piece.hint).squared, corner);
    }
    csg_piece parts[CSG_PIECE_PARTS];
    if (piece.bound <= target_of(e, out->lower)) {
        out->upper = fmax(out->upper, piece.bound);
        return;
    }
    uint32_t count = csg_piece_divide(&piece, t, center, parts);
    if (count < 2)
        out->upper = fmax(out->upper, piece.bound); /* too small for doubles */
    else
        queue_parts(e, out, parts, count, stack, depth);
}

/* ---- items of a batch ----------------------------------------------------------------------- */

static bool keep_rest(engine *e, outcome *out, const csg_piece *stack, uint32_t depth)
{
    if (!depth)
        return true;
    out->left = csg_memory_alloc(&e->pair->context->memory, depth * sizeof *out->left);
    if (!out->left) {
        out->out_of_memory = true;
        return false;
    }
    memcpy(out->left, stack, depth * sizeof *stack);
    out->left_count = depth;
    return true;
}

static bool work_on_item(void *user, uint32_t worker, size_t index)
{
    (void)worker;
    engine *e = user;
    outcome *out = &e->outcomes[index];
    csg_piece stack[STACK];
    uint32_t depth = 1;
    stack[0] = e->items[index];
    while (depth && out->cuts < e->cuts_of_item && depth + CSG_PIECE_PARTS <= STACK) {
        csg_piece piece = stack[--depth];
        if (piece.bound > target_of(e, out->lower))
            work_on(e, out, piece, stack, &depth);
        else
            out->upper = fmax(out->upper, piece.bound);
        out->cuts++;
        if (out->cuts % LOOK_UP_EVERY == 0 && csg_diff_is_cancelled(e->pair))
            break;
    }
    return keep_rest(e, out, stack, depth) && !csg_diff_is_cancelled(e->pair);
}

/* ---- batches -------------------------------------------------------------------------------- */

static bool reserve(engine *e, csg_piece **pieces, size_t *room, size_t count)
{
    void *data = *pieces;
    bool ok = csg_memory_reserve(&e->pair->context->memory, &data, room, count, sizeof **pieces);
    *pieces = data;
    return ok;
}

/* What was left over, then the next triangles. */
static bool fill_batch(engine *e, size_t size)
{
    double target = target_of(e, e->search->lower);
    csg_piece *swapped = e->items;
    size_t room = e->item_room;
    e->items = e->waiting;
    e->item_room = e->waiting_room;
    e->item_count = e->waiting_count;
    e->waiting = swapped;
    e->waiting_room = room;
    e->waiting_count = 0;
    if (e->item_count > LAST_BATCH && e->cuts_of_item < 1 << 20)
        e->cuts_of_item *= 4; /* else pieces that wait would pile up */
    if (!reserve(e, &e->items, &e->item_room, e->item_count + size))
        return false;
    for (; e->next_key < e->key_count && e->item_count < size; e->next_key++) {
        size_t triangle = (uint32_t)e->keys[e->next_key];
        double bound = (double)e->bounds[triangle];
        if (bound <= target) {
            e->search->upper = fmax(e->search->upper, bound);
            continue;
        }
        csg_piece *piece = &e->items[e->item_count++];
        *piece = piece_of(e, triangle);
        piece->bound = bound;
    }
    return true;
}

static bool join_outcomes(engine *e)
{
    csg_memory *memory = &e->pair->context->memory;
    csg_diff_maximum *search = e->search;
    bool ok = true;
    for (size_t i = 0; i < e->item_count; i++) {
        outcome *out = &e->outcomes[i];
        e->cuts += out->cuts;
        search->upper = fmax(search->upper, out->upper);
        if (out->is_found && out->lower > search->lower) {
            search->lower = out->lower;
            search->at = out->at;
            search->is_found = true;
        }
        ok = ok && reserve(e, &e->waiting, &e->waiting_room, e->waiting_count + out->left_count);
        if (ok && out->left_count)
            memcpy(e->waiting + e->waiting_count, out->left, out->left_count * sizeof *out->left);
        e->waiting_count += ok ? out->left_count : 0;
        csg_memory_release(memory, out->left, out->left_count * sizeof *out->left);
    }
    return ok;
}

static void report_items(void *user, size_t done, size_t count)
{
    csg_diff_tell(((engine *)user)->pair, done, count);
}

/* Batches are of equal work, and triangles that need none of it come last. */
static void report_batches(void *user, size_t done, size_t count)
{
    engine *e = user;
    (void)done;
    (void)count;
    csg_diff_tell(e->pair, e->next_key, e->key_count ? e->key_count : 1);
}

static csgm_status run_batch(engine *e)
{
    csg_memory *memory = &e->pair->context->memory;
    size_t size = (e->item_count + 1) * sizeof *e->outcomes;
    e->outcomes = csg_memory_alloc(memory, size);
    if (!e->outcomes)
        return csg_context_no_memory(e->pair->context);
    for (size_t i = 0; i < e->item_count; i++)
        e->outcomes[i] = (outcome){.lower = e->search->lower};
    bool ran = csg_pool_run(e->pair->context->pool, e->item_count, work_on_item, report_batches, e);
    bool out_of_memory = false;
    for (size_t i = 0; i < e->item_count; i++)
        out_of_memory |= e->outcomes[i].out_of_memory;
    out_of_memory |= !join_outcomes(e);
    csg_memory_release(memory, e->outcomes, size);
    return out_of_memory ? csg_context_no_memory(e->pair->context) : ran ? CSGM_OK : CSGM_CANCELLED;
}

/* Bounds of what will not be looked at any more. */
static void settle_rest(engine *e)
{
    for (size_t i = 0; i < e->waiting_count; i++)
        e->search->upper = fmax(e->search->upper, e->waiting[i].bound);
    for (; e->next_key < e->key_count; e->next_key++)
        e->search->upper =
            fmax(e->search->upper, (double)e->bounds[(uint32_t)e->keys[e->next_key]]);
}

static csgm_status run_batches(engine *e)
{
    csgm_status status = CSGM_OK;
    csg_diff_maximum *search = e->search;
    search->is_refined = true;
    csg_diff_take(e->pair, search->from == 0 ? 0.45 : 0.8);
    for (size_t size = FIRST_BATCH; status == CSGM_OK; size = size < LAST_BATCH ? 2 * size : size) {
        if (is_verdict_known(search) || e->cuts > CUTS_MOST) {
            search->is_refined = e->next_key == e->key_count && !e->waiting_count;
            break;
        }
        if (!fill_batch(e, size))
            return csg_context_no_memory(e->pair->context);
        if (!e->item_count)
            break;
        status = run_batch(e);
    }
    settle_rest(e);
    return status;
}

/* ---- the search ----------------------------------------------------------------------------- */

static void start_from_points(engine *e)
{
    outcome known = {.lower = e->search->lower};
    for (size_t i = 0; i < e->side->point_count; i++) {
        uint32_t point = e->side->points[i];
        take_lower(e, &known, e->side->distance[point], e->pair->points[point]);
    }
    if (!known.is_found)
        return;
    e->search->lower = known.lower;
    e->search->at = known.at;
    e->search->is_found = true;
}

static csgm_status search_maximum(engine *e)
{
    csg_diff_side *side = &e->pair->sides[e->search->from];
    csg_pool *pool = e->pair->context->pool;
    size_t run_count = (side->chain.count + RUN - 1) / RUN;
    e->bounds = csg_arena_alloc(&side->arena, side->chain.count * sizeof *e->bounds);
    e->keys = csg_arena_alloc(&side->arena, side->chain.count * sizeof *e->keys);
    if (!e->bounds || !e->keys)
        return csg_context_no_memory(e->pair->context);
    csg_diff_take(e->pair, 0.05);
    if (!csg_pool_run(pool, run_count, bound_run, report_items, e))
        return CSGM_CANCELLED;
    list_keys(e);
    return run_batches(e);
}

csgm_status csg_diff_find_maximum(csg_diff_pair *pair, csg_diff_maximum *search)
{
    csg_memory *memory = &pair->context->memory;
    engine e = {.pair = pair,
                .search = search,
                .side = &pair->sides[search->from],
                .other = &pair->sides[1 - search->from],
                .cuts_of_item = CUTS_OF_ITEM};
    search->upper = 0;
    start_from_points(&e);
    if (!is_verdict_known(search) && !csg_diff_pair_link(pair))
        return csg_context_no_memory(pair->context);
    csg_arena_mark mark = csg_arena_get_mark(&pair->sides[search->from].arena);
    csgm_status status = search_maximum(&e);
    search->upper = fmax(search->upper, search->lower);
    csg_memory_release(memory, e.items, e.item_room * sizeof *e.items);
    csg_memory_release(memory, e.waiting, e.waiting_room * sizeof *e.waiting);
    csg_arena_release_to(&pair->sides[search->from].arena, mark);
    return status;
}
