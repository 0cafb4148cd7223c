/* SPDX-License-Identifier: MIT
 * Two views -> a pair of sides; see side.h. Points of both meshes are welded by one open-addressed
 * table over the bits of their coordinates, so equal points have equal numbers whichever mesh they
 * are from.
 */
#include "diff/side.h"

#include <string.h>

#include "base/mesh_codes.h"
#include "base/places.h"
#include "base/pool.h"
#include "base/trace.h"
#include "mesh/inspect.h"
#include "mesh/view.h"

/* ---- coordinates ---------------------------------------------------------------------------- */

csg_vec3 csg_diff_turned(csg_diff_turn turn, csg_vec3 p)
{
    switch (turn) {
    case CSG_DIFF_Y_UP_TO_Z_UP:
        return csg_vec3_make(p.x, -p.z, p.y);
    case CSG_DIFF_Z_UP_TO_Y_UP:
        return csg_vec3_make(p.x, p.z, -p.y);
    case CSG_DIFF_AS_IT_IS:
        break;
    }
    return p;
}

static csg_vec3 view_vertex(const csgm_mesh_view *view, uint64_t vertex)
{
    const float *p = view->positions + 3 * vertex;
    return csg_vec3_make(view->origin.x + (double)p[0], view->origin.y + (double)p[1],
                         view->origin.z + (double)p[2]);
}

csg_vec3 csg_diff_vertex(const csg_diff_side *side, uint64_t vertex)
{
    return csg_diff_turned(side->turn, view_vertex(side->view, vertex));
}

static csg_box turned_box(csg_diff_turn turn, csg_box box)
{
    if (csg_box_is_empty(box))
        return box;
    csg_vec3 p = csg_diff_turned(turn, box.min), q = csg_diff_turned(turn, box.max);
    return csg_box_hull((csg_box){csg_vec3_make(fmin(p.x, q.x), fmin(p.y, q.y), fmin(p.z, q.z)),
                                  csg_vec3_make(fmin(p.x, q.x), fmin(p.y, q.y), fmin(p.z, q.z))},
                        (csg_box){csg_vec3_make(fmax(p.x, q.x), fmax(p.y, q.y), fmax(p.z, q.z)),
                                  csg_vec3_make(fmax(p.x, q.x), fmax(p.y, q.y), fmax(p.z, q.z))});
}

/* ---- checks --------------------------------------------------------------------------------- */

static csgm_status refuse(csgm_context *context, const char *what)
{
    csg_diag_plain(&context->diags, CSG_DIAG_BAD_MESH, NULL, NULL, "cannot compare: %s", what);
    return CSGM_ERR_ARGUMENT;
}

static csgm_status check_view(csgm_context *context, const csgm_mesh_view *view)
{
    if (!csg_all_finite(view->positions, 3 * view->vertex_count))
        return refuse(context, "a coordinate is not a finite number");
    if (!csg_view_is_in_range(view))
        return refuse(context, "an index of a triangle is out of range");
    if (view->triangle_count > UINT32_MAX / 3) {
        csg_diag_plain(&context->diags, CSG_DIAG_MESH_TOO_LARGE, NULL, NULL,
                       "a mesh of %llu triangles is too large to be compared",
                       (unsigned long long)view->triangle_count);
        return CSGM_ERR_LIMIT;
    }
    return CSGM_OK;
}

/* ---- welding -------------------------------------------------------------------------------- */

typedef struct welding {
    csg_vec3 *points;
    size_t count;
    csg_table table;
} welding;

static uint32_t weld(welding *w, csg_vec3 p)
{
    size_t slot;
    uint32_t found = csg_place_find(&w->table, w->points, p, &slot);
    if (found != CSG_TABLE_NONE)
        return found;
    w->points[w->count] = csg_vec3_add(p, csg_vec3_make(0, 0, 0)); /* -0 becomes 0 */
    csg_table_put(&w->table, slot, (uint32_t)w->count);
    return (uint32_t)w->count++;
}

static bool weld_side(welding *w, csg_diff_side *side)
{
    const csgm_mesh_view *view = side->view;
    side->point_of =
        csg_arena_alloc(&side->arena, (size_t)view->vertex_count * sizeof *side->point_of);
    side->chain.corners =
        csg_arena_alloc(&side->arena, (size_t)view->triangle_count * sizeof *side->chain.corners);
    if (!side->point_of || !side->chain.corners)
        return false;
    for (uint64_t v = 0; v < view->vertex_count; v++)
        side->point_of[v] = weld(w, csg_diff_vertex(side, v));
    for (uint64_t i = 0; i < 3 * view->triangle_count; i++)
        side->chain.corners[i / 3][i % 3] = side->point_of[view->indices[i]];
    side->chain.count = (size_t)view->triangle_count;
    return true;
}

static bool weld_pair(csg_diff_pair *pair)
{
    size_t most = (size_t)(pair->sides[0].view->vertex_count + pair->sides[1].view->vertex_count);
    welding w = {.points = csg_arena_alloc(&pair->arena, most * sizeof *w.points)};
    csg_table_init(&w.table, &pair->context->memory);
    bool ok = w.points && csg_table_reserve(&w.table, most + 1, NULL, NULL);
    for (int i = 0; i < 2 && ok; i++)
        ok = weld_side(&w, &pair->sides[i]);
    csg_table_release(&w.table);
    pair->points = w.points;
    pair->point_count = w.count;
    return ok;
}

/* Lists the points that triangles use. */
static bool list_points(csg_diff_pair *pair, csg_diff_side *side)
{
    uint8_t *seen = csg_arena_calloc(&side->arena, pair->point_count + 1, 1);
    side->points = csg_arena_alloc(&side->arena, pair->point_count * sizeof *side->points);
    if (!seen || !side->points)
        return false;
    for (size_t t = 0; t < side->chain.count; t++)
        for (int k = 0; k < 3; k++) {
            uint32_t point = side->chain.corners[t][k];
            if (!seen[point])
                side->points[side->point_count++] = point;
            seen[point] = 1;
        }
    return true;
}

static csg_box box_of_side(const csg_diff_pair *pair, const csg_diff_side *side)
{
    csg_box box = csg_box_empty();
    for (size_t i = 0; i < side->point_count; i++)
        csg_box_extend(&box, pair->points[side->points[i]]);
    return box;
}

/* ---- the frame ------------------------------------------------------------------------------ */

static double largest_coordinate(csg_box box)
{
    return fmax(
        fmax(fmax(fabs(box.min.x), fabs(box.max.x)), fmax(fabs(box.min.y), fabs(box.max.y))),
        fmax(fabs(box.min.z), fabs(box.max.z)));
}

/* Points into the frame, onto its lattice. */
static void enter_frame(csg_diff_pair *pair)
{
    pair->box =
        csg_box_hull(box_of_side(pair, &pair->sides[0]), box_of_side(pair, &pair->sides[1]));
    pair->frame = (csg_triangle_frame){{0, 0, 0}, 1, 1};
    if (csg_box_is_empty(pair->box))
        return;
    if (!csg_triangle_frame_make(pair->box, &pair->frame))
        pair->frame.center = csg_box_center(pair->box); /* all at one place */
    bool is_exact = true;
    for (size_t i = 0; i < pair->point_count; i++) {
        csg_vec3 p =
            csg_triangle_frame_round_point(csg_triangle_frame_enter(&pair->frame, pair->points[i]));
        csg_vec3 back = csg_triangle_frame_leave(&pair->frame, p);
        is_exact = is_exact && memcmp(&back, &pair->points[i], sizeof back) == 0;
        pair->points[i] = p;
    }
    double rounding = is_exact ? 0 : 0x1p-38;
    for (int i = 0; i < 2; i++)
        pair->sides[i].slack = rounding;
    pair->precision = 0x1p-23 * largest_coordinate(pair->box) * pair->frame.scale;
}

void csg_diff_take(csg_diff_pair *pair, double part)
{
    csg_diff_progress *p = &pair->progress;
    p->before += p->share;
    p->share = part * (1 - p->before);
}

void csg_diff_tell(csg_diff_pair *pair, size_t done, size_t count)
{
    enum { REPORTS_PER_SECOND = 20 };
    csg_diff_progress *p = &pair->progress;
    double now = csg_clock_now_s();
    if (!pair->monitor->progress || now - p->last_report_s < 1.0 / REPORTS_PER_SECOND)
        return;
    p->last_report_s = now;
    p->told = fmax(p->told, p->before + p->share * ((double)done / (double)count));
    pair->monitor->progress(pair->monitor->user, CSGM_STAGE_COMPARE, p->told);
}

csgm_status csg_diff_pair_make(csg_diff_pair *pair, csgm_context *context, const csgm_mesh_view *a,
                               const csgm_mesh_view *b, bool may_turn_b)
{
    CSG_ZONE(context, "weld");
    static const csgm_monitor nobody;
    *pair = (csg_diff_pair){.context = context, .monitor = &nobody};
    csg_arena_init(&pair->arena, &context->memory);
    for (int i = 0; i < 2; i++) {
        pair->sides[i] = (csg_diff_side){.view = i ? b : a};
        csg_arena_init(&pair->sides[i].arena, &context->memory);
        csgm_status status = check_view(context, pair->sides[i].view);
        if (status != CSGM_OK)
            return status;
    }
    if (may_turn_b)
        pair->sides[1].turn = csg_diff_find_turn(a, b);
    if (!weld_pair(pair) || !list_points(pair, &pair->sides[0]) ||
        !list_points(pair, &pair->sides[1]))
        return csg_context_no_memory(context);
    enter_frame(pair);
    for (int i = 0; i < 2; i++) {
        csg_triangles *chain = &pair->sides[i].chain;
        chain->memory = &context->memory;
        chain->points = pair->points;
        chain->point_count = pair->point_count;
    }
    return CSGM_OK;
}

void csg_diff_pair_release(csg_diff_pair *pair)
{
    for (int i = 0; i < 2; i++) {
        csg_diff_side *side = &pair->sides[i];
        if (side->tree.memory)
            csg_tree_release(&side->tree);
        if (side->arena.memory)
            csg_arena_reset(&side->arena);
    }
    csg_arena_reset(&pair->arena);
}

/* ---- trees and figures ---------------------------------------------------------------------- */

static csgm_status make_tree(csg_diff_pair *pair, csg_diff_side *side)
{
    if (!csg_tree_make(&pair->context->memory, &side->arena, &side->chain, &side->tree))
        return CSGM_ERR_MEMORY;
    side->slack += csg_piece_slack(&side->tree);
    return CSGM_OK;
}

/* The figures of the welded mesh: every vertex is named by the first of its place. */
static csgm_status inspect(csg_diff_pair *pair, csg_diff_side *side)
{
    const csgm_mesh_view *view = side->view;
    csg_arena_mark mark = csg_arena_get_mark(&side->arena);
    uint32_t *first = csg_arena_alloc(&side->arena, pair->point_count * sizeof *first);
    uint32_t *indices =
        csg_arena_alloc(&side->arena, 3 * (size_t)view->triangle_count * sizeof *indices);
    if (!first || !indices)
        return CSGM_ERR_MEMORY;
    for (uint64_t v = view->vertex_count; v-- > 0;)
        first[side->point_of[v]] = (uint32_t)v;
    for (uint64_t i = 0; i < 3 * view->triangle_count; i++)
        indices[i] = first[side->point_of[view->indices[i]]];
    csgm_mesh_view welded = {.origin = view->origin,
                             .positions = view->positions,
                             .indices = indices,
                             .vertex_count = view->vertex_count,
                             .triangle_count = view->triangle_count};
    csgm_status status = csg_mesh_inspect(pair->context, &welded, 0, &side->check);
    csg_arena_release_to(&side->arena, mark);
    side->check.bounds = turned_box(side->turn, side->check.bounds);
    return status;
}

/* Every edge as often forwards as backwards. An edge is the sum of hashes of its ends, counted with
 * its direction: the sum over a closed chain is 0 (and, but for one in 2^64, of no other). */
static bool is_closed(const csg_diff_side *side)
{
    uint64_t sum = 0;
    for (size_t t = 0; t < side->chain.count; t++)
        for (int k = 0; k < 3; k++) {
            uint64_t a = side->chain.corners[t][k], b = side->chain.corners[t][(k + 1) % 3];
            csg_vec3 key = {(double)(a < b ? a : b), (double)(a < b ? b : a), 1};
            sum += a < b ? csg_place_hash(key) : a > b ? 0 - csg_place_hash(key) : 0;
        }
    return sum == 0 && side->chain.count > 0;
}

typedef struct preparation {
    csg_diff_pair *pair;
    bool with_trees;
    csgm_status status[2];
} preparation;

static bool inspect_side(void *user, uint32_t worker, size_t index)
{
    (void)worker;
    preparation *p = user;
    csg_diff_side *side = &p->pair->sides[index];
    side->is_closed = is_closed(side);
    p->status[index] = csg_diff_is_cancelled(p->pair) ? CSGM_CANCELLED : inspect(p->pair, side);
    return p->status[index] == CSGM_OK;
}

static bool plant_side(void *user, uint32_t worker, size_t index)
{
    (void)worker;
    preparation *p = user;
    csg_diff_side *side = &p->pair->sides[index];
    if (p->with_trees && side->chain.count)
        p->status[index] = make_tree(p->pair, side);
    return p->status[index] == CSGM_OK;
}

static bool is_cancelled(void *pair)
{
    return csg_diff_is_cancelled(pair);
}

static void report_sides(void *user, size_t done, size_t count)
{
    csg_diff_tell(((preparation *)user)->pair, done, count);
}

csgm_status csg_diff_pair_prepare(csg_diff_pair *pair, bool with_trees)
{
    CSG_ZONE(pair->context, "trees");
    preparation p = {pair, with_trees, {CSGM_OK, CSGM_OK}};
    csg_diff_take(pair, 0.05);
    csg_memory *memory = &pair->context->memory;
    csg_pool *pool = pair->context->pool;
    bool good = csg_pool_run(pool, 2, inspect_side, report_sides, &p);
    csg_diff_take(pair, 0.05);
    csg_memory_end_when(memory, is_cancelled,
                        pair); /* trees of millions of triangles take a while */
    good = good && csg_pool_run(pool, 2, plant_side, report_sides, &p);
    csg_memory_end_when(memory, NULL, NULL);
    if (good)
        return CSGM_OK;
    if (csg_diff_is_cancelled(pair))
        return CSGM_CANCELLED;
    return p.status[0] == CSGM_ERR_LIMIT || p.status[1] == CSGM_ERR_LIMIT
               ? CSGM_ERR_LIMIT
               : csg_context_no_memory(pair->context);
}

static bool link_side(void *user, uint32_t worker, size_t index)
{
    (void)worker;
    csg_diff_side *side = &((csg_diff_pair *)user)->sides[index];
    if (side->across)
        return true;
    side->across = csg_arena_alloc(&side->arena, side->tree.count * sizeof *side->across);
    return side->across && csg_across_make(&side->arena, &side->chain, &side->tree, side->across);
}

bool csg_diff_pair_link(csg_diff_pair *pair)
{
    return csg_pool_run(pair->context->pool, 2, link_side, NULL, pair);
}

bool csg_diff_is_inside(const csg_diff_side *side, csg_vec3 p)
{
    csg_box box = side->tree.box;
    if (!(p.x >= box.min.x && p.x <= box.max.x && p.y >= box.min.y && p.y <= box.max.y &&
          p.z >= box.min.z && p.z <= box.max.z))
        return false;
    return csg_tree_winding(&side->tree, csg_triangle_frame_round_point(p), NULL) != 0;
}

/* ---- which axis is up ----------------------------------------------------------------------- */

enum { FEATURES = 15 };

/* Bounds, and the first and second moments of the area. */
static void features_of(const csgm_mesh_view *view, csg_diff_turn turn, double *out)
{
    csg_diff_side side = {.view = view, .turn = turn};
    csg_box box = csg_box_empty();
    double area = 0, moments[9] = {0};
    for (uint64_t t = 0; t < view->triangle_count; t++) {
        csg_vec3 p[3];
        for (uint64_t k = 0; k < 3; k++)
            p[k] = csg_diff_vertex(&side, view->indices[3 * t + k]);
        double a =
            csg_vec3_norm(csg_vec3_cross(csg_vec3_sub(p[1], p[0]), csg_vec3_sub(p[2], p[0])));
        csg_vec3 c = csg_vec3_scale(csg_vec3_add(p[0], csg_vec3_add(p[1], p[2])), 1.0 / 3);
        const double terms[9] = {c.x,       c.y,       c.z,       c.x * c.x, c.y * c.y,
                                 c.z * c.z, c.x * c.y, c.y * c.z, c.z * c.x};
        for (int k = 0; k < 3; k++)
            box = csg_box_hull(box, (csg_box){p[k], p[k]});
        for (int k = 0; k < 9; k++)
            moments[k] += a * terms[k];
        area += a;
    }
    memcpy(out, &box, 6 * sizeof *out);
    for (int k = 0; k < 9; k++) {
        double mean = area > 0 ? moments[k] / area : 0;
        out[6 + k] = k < 3 ? mean : copysign(sqrt(fabs(mean)), mean);
    }
}

csg_diff_turn csg_diff_find_turn(const csgm_mesh_view *a, const csgm_mesh_view *b)
{
    double wanted[FEATURES], least = INFINITY;
    csg_diff_turn best = CSG_DIFF_AS_IT_IS;
    features_of(a, CSG_DIFF_AS_IT_IS, wanted);
    for (int turn = CSG_DIFF_AS_IT_IS; turn <= CSG_DIFF_Z_UP_TO_Y_UP; turn++) {
        double found[FEATURES], sum = 0;
        features_of(b, (csg_diff_turn)turn, found);
        for (int k = 0; k < FEATURES; k++)
            sum += (found[k] - wanted[k]) * (found[k] - wanted[k]);
        if (sum < least * (1 - 1e-6)) {
            least = sum;
            best = (csg_diff_turn)turn;
        }
    }
    return best;
}
