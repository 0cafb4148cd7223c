/* SPDX-License-Identifier: MIT
 * The stages in their order; see adaptive.h.
 */
#include "mesh/pipeline/adaptive.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "base/clock.h"
#include "base/elementary.h"
#include "base/mesh_codes.h"
#include "base/pool.h"
#include "base/trace.h"
#include "field/unit_slopes.h"
#include "mesh/adaptive/borders.h"
#include "mesh/adaptive/extract.h"
#include "mesh/adaptive/seen.h"
#include "mesh/adaptive/unsure.h"
#include "mesh/pipeline/adaptive_tiles.h"
#include "mesh/pipeline/certify.h"
#include "mesh/pipeline/paint.h"
#include "mesh/pipeline/survey.h"
#include "mesh/pipeline/workers.h"

/* Cells along the longest side that refinement begins with, at least; how much of the tolerance
 * triangles may use before they are thinned out, and sides of their polygons before a vertex is put
 * between: with fewer of these, cells fail for their triangles, with more, they have too many. */
enum { FIRST_CELLS = 24, LEAST_LEVELS = 3 };
/* Cells along the longest side of the lattice that looks for what is missed. */
enum { COMPARED_CELLS = 128 };
static const double SHARE_OF_CELLS = 0.8, SHARE_OF_SIDES = 0.6;
/* Bricks that a tolerance may take: what needs more of them gets twice the tolerance. A sheet that
 * is hardly thicker than the tolerance and lies across the cells takes the square of its length. */
enum { MOST_BRICKS = 1 << 19 };
/* How often cells are divided around what the mesh has missed, before all are made smaller. */
enum { MOST_LOOKS = 2 };

typedef struct adaptive {
    csgm_field field; /* of leaves no steeper than distances: what is near is judged by values */
    csg_arena tapes;  /* what of it differs */
    csg_mesh_input input;
    csg_mesh_watch watch;
    csg_mesh_workers workers;
    csg_lattice lattice; /* the finest */
    csg_bricks bricks;
    csg_judge judge;
    csg_extraction extraction;
    csg_mesh_goal *goal;
    uint64_t own_triangles; /* that it began with */
    csg_joined joined;      /* what the goal has of tiles */
    csg_seen seen;          /* what it has of the judge's places */
    double refined_s;
    bool is_too_fine; /* the tolerance takes too many bricks */
} adaptive;

/* ---- the lattice -------------------------------------------------------------------------------
 */

/* What cells are made for. */
static double cells_error(const csg_mesh_goal *goal)
{
    return goal->finer * goal->error;
}

/* The largest power of two that is at most this, which is finite and above 0. */
static double power_below(double size)
{
    return ldexp(1, (int)floor(csg_log2(size)));
}

/* Cells and origin at absolute places that powers of two have, a third, a fifth and a seventh off
 * them: whatever the level, faces at such places, and diagonals between them, keep a distance from
 * lattice points. So an edit at one end of a part moves no cell at the other. */
static csgm_status make_lattice(adaptive *a, uint32_t *coarse_levels)
{
    const csg_box bounds = a->input.bounds;
    const csg_box within = csg_mesh_box_within(bounds, a->input.field->bounds);
    double longest = csg_box_longest_side(within);
    csg_vec3 center = a->input.field->center, size = csg_box_size(within);
    double first = power_below(longest / FIRST_CELLS);
    double cell = fmin(power_below(cells_error(a->goal)) / 2, ldexp(first, -LEAST_LEVELS));
    const double low[3] = {bounds.min.x, bounds.min.y, bounds.min.z};
    const double high[3] = {bounds.max.x, bounds.max.y, bounds.max.z};
    const double middle[3] = {center.x, center.y, center.z};
    static const double share[3] = {1.0 / 3, 1.0 / 5, 1.0 / 7};
    double origin[3], step = CSG_BRICK_EDGE * first;
    for (int axis = 0; axis < 3; axis++) {
        double shift = share[axis] * first, margin = 0.25 * first;
        double begin = floor((low[axis] - margin - shift) / step) * step + shift;
        double cells = ceil((high[axis] + margin - begin) / step) * (step / cell);
        if (!(cells <= CSG_LATTICE_MOST_CELLS)) {
            csg_diag_plain(
                &a->input.context->diags, CSG_DIAG_TOO_FINE, NULL,
                a->input.options->simplify_error > 0 ? "raise the error of --simplify, or give -r"
                                                     : "give smaller --bounds, or -r",
                "a tolerance of %g over %g x %g x %g would take more than %d cells along "
                "a side",
                a->goal->error, size.x, size.y, size.z, CSG_LATTICE_MOST_CELLS);
            return CSGM_ERR_LIMIT;
        }
        a->lattice.cells[axis] = (uint32_t)cells;
        a->lattice.blocks[axis] = (uint32_t)cells / CSG_BLOCK_EDGE;
        origin[axis] = begin - middle[axis];
    }
    a->lattice.origin = csg_vec3_make(origin[0], origin[1], origin[2]);
    a->lattice.cell_size = cell;
    *coarse_levels = (uint32_t)lround(csg_log2(first / cell));
    return CSGM_OK;
}

/* ---- refinement --------------------------------------------------------------------------------
 */

static csgm_status create_judge(adaptive *a)
{
    csg_memory *memory = &a->input.context->memory;
    const csg_marching *m = &a->workers.marching;
    a->judge = (csg_judge){.memory = memory,
                           .tolerance = SHARE_OF_CELLS * cells_error(a->goal),
                           .bulge = SHARE_OF_SIDES * cells_error(a->goal),
                           .sharp = a->goal->sharp,
                           .tells_seen = !a->goal->proves, /* a proof looks for itself */
                           .noise = m->noise,
                           .end_distance = (float)fmin(
                               fmax(4 * (double)m->unit / a->lattice.cell_size, 0x1p-10), 0.25)};
    csg_plain_polygons_fill(&a->judge.plain);
    csg_arena_init(&a->judge.kept, memory);
    a->judge.rooms = csg_memory_alloc(memory, a->workers.count * sizeof(csg_judge_room));
    if (!a->judge.rooms)
        return csg_context_no_memory(a->input.context);
    memset(a->judge.rooms, 0, a->workers.count * sizeof(csg_judge_room));
    for (uint32_t i = 0; i < a->workers.count; i++) {
        a->judge.rooms[i].scratch = a->workers.each[i].scratch;
        a->judge.rooms[i].scratch_floats = a->workers.scratch_floats;
        csg_arena_init(&a->judge.rooms[i].found, memory);
    }
    return CSGM_OK;
}

/* A csg_brick_judge for what has its triangles already: the largest cells will do to ask the field
 * in. */
static bool want_nothing(void *user, uint32_t worker, const csg_bricks *bricks, csg_brick *brick,
                         const float *f)
{
    (void)user, (void)worker, (void)bricks, (void)f;
    brick->wanted = 0;
    return true;
}

static csgm_status why_stopped(void *watch)
{
    return csg_mesh_why_stopped(watch);
}

/* Until every border is simple, and near the surface. */
static csgm_status refine(adaptive *a)
{
    csgm_status status = CSGM_OK;
    for (bool any = true; any && status == CSGM_OK;) {
        status = csg_bricks_refine(&a->bricks);
        if (a->goal->is_own)
            break;
        if (status == CSGM_OK)
            status = csg_borders_check_simple(&a->extraction, &any);
        if (status == CSGM_OK && !any)
            status = csg_borders_check_near(&a->extraction, &any);
    }
    a->is_too_fine = status == CSGM_ERR_LIMIT && a->bricks.count > MOST_BRICKS;
    return status;
}

/* ---- bounds ------------------------------------------------------------------------------------ */

csg_box csg_mesh_box_within(csg_box bounds, csg_box solid)
{
    csg_box within = csg_box_intersect(bounds, solid);
    double longest = csg_box_longest_side(within);
    return longest > 0 && isfinite(longest) ? within : bounds;
}

double csg_mesh_quality_tolerance(csgm_quality quality, csg_box bounds)
{
    static const double shares[] = {
        [CSGM_QUALITY_NORMAL] = 1000, [CSGM_QUALITY_DRAFT] = 250, [CSGM_QUALITY_FINE] = 4000};
    double longest = csg_box_longest_side(bounds);
    return longest > 0 && isfinite(longest) ? power_below(longest / shares[quality]) : 0;
}

/* Whether a vertex lies on one of the planes that cut the solid. */
static bool touches_bounds(const adaptive *a)
{
    const csgm_mesh *mesh = a->extraction.mesh;
    csg_box inner = csg_box_grow(a->input.bounds, -a->lattice.cell_size);
    for (uint64_t v = 0; v < mesh->vertex_count; v++) {
        csg_vec3 at = csg_vec3_add(csg_vec3_from_floats(mesh->positions + 3 * v), mesh->origin);
        if (!csg_box_contains_box(inner, (csg_box){at, at}))
            return true;
    }
    return false;
}

/* ---- all of it --------------------------------------------------------------------------------- */

static csgm_status walk(adaptive *a)
{
    uint32_t levels;
    csgm_context *context = a->input.context;
    csgm_status status = make_lattice(a, &levels);
    if (status == CSGM_OK)
        status = csg_mesh_workers_create(&a->workers, &a->input);
    if (status == CSGM_OK)
        status = create_judge(a);
    if (status != CSGM_OK)
        return status;
    csg_bricks_options options = {.prune = a->input.options->prune,
                                  .most = MOST_BRICKS,
                                  .judge = a->goal->is_own ? want_nothing : csg_judge_brick,
                                  .joined = a->goal->is_own ? NULL : csg_judge_joined,
                                  .tell = a->goal->is_own ? NULL : csg_judge_tell,
                                  .hear = a->goal->is_own ? NULL : csg_judge_hear,
                                  .judge_user = &a->judge,
                                  .progress = csg_mesh_report_progress,
                                  .cancelled = csg_mesh_should_stop,
                                  .why = why_stopped,
                                  .user = &a->watch};
    status = csg_bricks_create(context, a->input.field, &a->lattice, &options, &a->bricks);
    if (status != CSGM_OK)
        return status;
    a->bricks.options.coarse = a->bricks.finest - levels;
    a->workers.marching.bricks = &a->bricks;
    a->extraction = (csg_extraction){.context = context,
                                     .mesh = a->extraction.mesh,
                                     .watch = &a->watch,
                                     .bricks = &a->bricks,
                                     .judge = &a->judge,
                                     .farthest = cells_error(a->goal),
                                     .shift = a->workers.marching.shift,
                                     .colors = csg_mesh_gets_colors(&a->input)};
    status = refine(a);
    a->refined_s = csg_clock_now_s();
    return status;
}

static void count_blocks(const csg_bricks *bricks, uint64_t blocks[CSGM_LEVELS_MOST])
{
    for (size_t i = 0; i < bricks->count; i++) {
        const csg_brick *brick = &bricks->items[i];
        if (brick->crossed & ~brick->divided && brick->level >= bricks->options.coarse)
            blocks[brick->level - bricks->options.coarse]++;
    }
}

static void fill_stats(const adaptive *a, csgm_mesh_stats *stats)
{
    const csg_bricks_stats *s = &a->bricks.stats;
    bool has_cells = !a->goal->is_own;
    *stats = (csgm_mesh_stats){
        .octree_s = a->refined_s - a->watch.started_s,
        .mesh_s = csg_clock_now_s() - a->refined_s,
        .cell_size = has_cells ? a->lattice.cell_size : 0,
        .tolerance = has_cells ? a->goal->error : 0,
        .own_triangles_before = a->own_triangles,
        .cell_coarsest =
            csg_bricks_cell(&a->bricks, a->bricks.options.coarse) * a->lattice.cell_size,
        .cells = {a->lattice.cells[0], a->lattice.cells[1], a->lattice.cells[2]},
        .cells_visited = s->visited,
        .pruned_outside = s->pruned_outside,
        .pruned_inside = s->pruned_inside,
        .leaf_blocks = s->sampled,
        .point_evaluations = s->point_evaluations,
        .interval_evaluations = s->interval_evaluations,
        .primitive_evaluations = s->primitive_evaluations,
        .memory_peak_bytes = atomic_load(&a->input.context->memory.peak_bytes),
        .feature_vertices = a->extraction.creases,
        .smooth_features = a->extraction.smooth,
    };
    for (uint32_t i = 0; a->judge.rooms && i < a->workers.count; i++) {
        stats->point_evaluations += a->judge.rooms[i].evaluations;
        stats->gradient_evaluations += a->judge.rooms[i].gradients;
    }
    if (has_cells)
        count_blocks(&a->bricks, stats->blocks);
}

static void end_room(csg_judge_room *room, csg_memory *memory)
{
    csg_arena_reset(&room->found);
    csg_memory_release(memory, room->unsure, room->unsure_capacity * sizeof *room->unsure);
}

static void release(adaptive *a)
{
    csg_missed_before_release(&a->goal->before, &a->input.context->memory);
    csg_far_places_release(&a->goal->away, &a->input.context->memory);
    a->goal->joined = NULL;
    a->goal->seen = NULL;
    csg_joined_end(&a->joined);
    csg_seen_release(&a->seen, &a->input.context->memory);
    csg_bricks_destroy(&a->bricks);
    csg_arena_reset(&a->judge.kept);
    for (uint32_t i = 0; a->judge.rooms && i < a->workers.count; i++)
        end_room(&a->judge.rooms[i], &a->input.context->memory);
    csg_memory_release(&a->input.context->memory, a->judge.rooms,
                       a->workers.count * sizeof(csg_judge_room));
    csg_mesh_workers_release(&a->workers);
    csg_mesh_input_release(&a->input);
    csg_arena_reset(&a->tapes);
}

static void warn_of_result(const adaptive *a)
{
    const csg_mesh_fineness tolerance = {
        "a tolerance",
        a->goal->error,
        {"the solid may lie outside the bounds, or be thinner than the tolerance",
         "it may lie outside the bounds, or be thinner than the tolerance"}};
    bool is_empty = !a->extraction.mesh->triangle_count;
    csg_mesh_warn_of_result(&a->input, &tolerance, is_empty,
                            !is_empty && a->input.clipped && touches_bounds(a));
}

/* The mesh as a whole, where no place asks for smaller cells. *any: as csg_unsure_check. */
static csgm_status extract_whole(csg_extraction *x, bool *any)
{
    csgm_status status = csg_unsure_check(x, any);
    return status == CSGM_OK && !*any ? csg_extract(x) : status;
}

static csgm_status paint_whole(adaptive *a)
{
    csgm_mesh *mesh = a->extraction.mesh;
    mesh->origin = csg_mesh_origin_of(&a->input);
    return csg_mesh_paint(&a->input, &a->workers.marching, &a->watch, mesh);
}

/* What the judge has kept of bricks is for the extraction alone: half of what the lattice takes and
 * more, which thinning out has better use for. */
static void forget_findings(adaptive *a)
{
    for (size_t i = 0; i < a->bricks.count; i++)
        a->bricks.items[i].judged = NULL;
    csg_arena_reset(&a->judge.kept);
}

/* All tiles as one mesh, for which there is twice the room without what the judge has kept. */
static csgm_status write_tiles(adaptive *a)
{
    csg_extraction *x = &a->extraction;
    forget_findings(a);
    csgm_status status = csg_joined_write(&a->joined, &x->mesh);
    if (status == CSGM_OK)
        x->mesh->origin = csg_mesh_origin_of(&a->input);
    x->creases = a->joined.creases;
    return status;
}

static void forget_mesh(csg_extraction *x)
{
    csg_mesh_destroy(x->mesh);
    x->mesh = NULL;
    x->creases = x->smooth = 0;
}

/* Until every place of the surface that was found is near the mesh: hardly ever twice. Where the
 * memory is narrow, the mesh is made and thinned out in tiles. */
static csgm_status extract(adaptive *a)
{
    csg_extraction *x = &a->extraction;
    const csg_memory *memory = &a->input.context->memory;
    a->goal->seen = a->judge.tells_seen ? &a->seen : NULL;
    for (;;) {
        bool any = false;
        if (!csg_unsure_add(x, a->goal->away.at, a->goal->away.count) ||
            (a->goal->seen && !csg_seen_gather(&a->seen, &a->bricks, &a->input.context->memory)))
            return csg_context_no_memory(a->input.context);
        size_t tile = csg_mesh_tile_bricks(&a->bricks, a->goal, memory->limit_bytes);
        a->goal->joined = tile ? &a->joined : NULL;
        csgm_status status =
            tile ? csg_mesh_make_tiles(&a->input, &a->workers.marching, a->goal, x, tile, &any)
                 : extract_whole(x, &any);
        if (status == CSGM_OK && !any)
            return tile ? write_tiles(a) : paint_whole(a);
        forget_mesh(x);
        if (status == CSGM_OK)
            status = refine(a);
        if (status != CSGM_OK)
            return status;
    }
}

/* The mesh of the cells, thinned out. What the judge has kept stays while they may have to be
 * divided once more; those of tiles have nothing left of it. */
static csgm_status extract_and_reshape(adaptive *a, bool looks_closer)
{
    csg_mesh_goal *goal = a->goal;
    csgm_mesh **mesh = &a->extraction.mesh;
    a->watch.stage = CSGM_STAGE_MESH;
    csgm_status status = goal->is_own ? CSGM_OK : extract(a);
    goal->looks_closer = looks_closer && !goal->joined;
    if (status == CSGM_OK && !goal->is_own && !goal->looks_closer)
        forget_findings(a);
    if (status == CSGM_OK && (*mesh)->triangle_count)
        status = csg_mesh_reshape(goal, mesh, &a->workers.marching, &a->watch);
    return status;
}

/* Divides the cells around what a mesh that is to be proven has missed, and makes another one. */
static csgm_status make_closer_mesh(adaptive *a)
{
    csg_mesh_goal *goal = a->goal;
    csgm_status status = extract_and_reshape(a, goal->proves && !goal->is_last);
    for (int i = 1; status == CSGM_OK && goal->cell_size > 0 && goal->looks_closer; i++) {
        goal->cell_size = goal->measured = 0;
        forget_mesh(&a->extraction);
        status = extract_and_reshape(a, i < MOST_LOOKS);
    }
    return status;
}

static csgm_status make_mesh(adaptive *a)
{
    csgm_status status = walk(a);
    if (status == CSGM_OK)
        status = make_closer_mesh(a);
    if (status != CSGM_OK || a->goal->is_own || a->goal->cell_size > 0)
        return status;
    if (a->input.context->survey)
        csg_survey_bricks(a->input.context->survey, a->input.field->center, &a->bricks);
    return csg_mesh_look_for_lost(&a->input, &a->bricks, cells_error(a->goal),
                                  a->goal->error > a->goal->asked, &a->watch);
}

/* The goal's mesh of polyhedra, where it has one, in place of one of cells. */
static void take_own(adaptive *a)
{
    csg_mesh_goal *goal = a->goal;
    goal->is_own = goal->own != NULL;
    a->extraction.mesh = goal->own;
    a->own_triangles = goal->own ? goal->own->triangle_count : 0;
    goal->own = NULL;
}

/* With the tolerance of the goal; *is_too_fine: it takes too many bricks, nothing was made. */
static csgm_status build_within(csgm_context *context, const csgm_field *field,
                                const csgm_mesh_options *options, const csg_mesh_share *share,
                                csg_mesh_goal *goal, csgm_mesh **out, csgm_mesh_stats *stats,
                                bool *is_too_fine)
{
    csgm_mesh_options base = *options;
    base.resolution = COMPARED_CELLS;
    base.features = CSGM_FEATURES_SMOOTH;
    *is_too_fine = false;
    adaptive a = {.input = {.context = context, .options = &base, .share = share}, .goal = goal};
    csg_arena_init(&a.tapes, &context->memory);
    if (!csg_field_with_unit_slopes(field, &a.tapes, &a.field)) {
        csg_arena_reset(&a.tapes);
        return csg_context_no_memory(context);
    }
    a.input.field = &a.field;
    take_own(&a);
    csg_joined_begin(&a.joined, context, csg_mesh_gets_colors(&a.input),
                     csg_mesh_gets_materials(&a.input));
    csg_mesh_input_watch(&a.input, goal->started_s, &a.watch);
    csgm_status status = csg_mesh_input_complete(&a.input);
    a.refined_s = csg_clock_now_s();
    if (status == CSGM_OK && csg_box_is_empty(a.input.bounds))
        status = csg_mesh_create(context, 0, 0, goal->normals != CSGM_NORMALS_NONE, false,
                                 &a.extraction.mesh);
    else if (status == CSGM_OK)
        status = make_mesh(&a);
    if (status == CSGM_OK && !(goal->cell_size > 0))
        warn_of_result(&a);
    if (status == CSGM_OK && stats)
        fill_stats(&a, stats);
    csgm_mesh *mesh = a.extraction.mesh;
    *is_too_fine = a.is_too_fine;
    release(&a);
    if (status == CSGM_OK)
        *out = mesh;
    else
        csg_mesh_destroy(mesh);
    return status;
}

csgm_status csg_mesh_build_adaptive(csgm_context *context, const csgm_field *field,
                                    const csgm_mesh_options *options, const csg_mesh_share *share,
                                    csg_mesh_goal *goal, csgm_mesh **out, csgm_mesh_stats *stats)
{
    CSG_ZONE(context, "adaptive build");
    bool is_too_fine;
    csgm_status status =
        build_within(context, field, options, share, goal, out, stats, &is_too_fine);
    while (is_too_fine) { /* ends: the largest cells are few */
        if (goal->finer < 1)
            goal->finer = fmin(2 * goal->finer, 1);
        else
            goal->error *= 2;
        status = build_within(context, field, options, share, goal, out, stats, &is_too_fine);
    }
    return status;
}
