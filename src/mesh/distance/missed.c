/* SPDX-License-Identifier: MIT
 * The walk; see missed.h. Cubes of the frontier in parallel, results joined in their order.
 */
#include "mesh/distance/missed.h"

#include <math.h>
#include <string.h>

#include "base/rank_loop.h"
#include "field/point.h"
#include "grid/octree/octree.h"
#include "mesh/distance/effort.h"
#include "mesh/distance/missed_cube.h"

/* Cubes looked at, of one of the frontier: a share of all, then what it takes up to a limit. They
 * count by what they cost (effort.h). */
enum {
    MOST_POINTS = 4096,
    MOST_FAR = 16384, /* with those that are farther than the error */
    LEAST_CUBES = 1500,
    AGAIN_CUBES = 200000,
    MOST_CUBES = 60000,
    ALL_CUBES = 1000000,
    ALL_AGAIN = 4000000
};

/* Cubes of so many cells or less may be one sheet; their tapes hold so far around them. */
static const double SHEET_CELLS = 8, AROUND_CELLS = 1;
static const double SHARE = 0.2; /* of what is left of the stage, for progress */

/* Cubes that are the stretches of a search: an eighth of a frontier cube's side, so that few of
 * them are near a triangle that has changed. */
enum { STRETCH_DEPTH = 3 };

/* What a frontier cube gave, and where it is. */
typedef struct segment {
    uint32_t worker;
    bool unfinished;
    uint64_t effort;
    size_t first, count;
    size_t first_stretch, stretch_count;
    csg_missed_distances distances;
} segment;

typedef csg_missed_cube cube;
typedef csg_missed_place place;

typedef struct worker {
    csg_missed_field field;
    csg_pruner pruner;
    csg_arena arena;
    csg_missed_point *points;
    size_t count, capacity;
    csg_missed_stretch *stretches;
    size_t stretch_count, stretch_capacity;
    csg_missed_stretch stretch; /* at hand */
    csg_changed_boxes changed;  /* near the frontier cube at hand */
    uint64_t cubes;             /* in it, by their effort */
    size_t near_leaf;           /* of the tree of triangles, where one was near */
    size_t item;                /* the frontier cube */
    segment *segment;
} worker;

typedef struct walk {
    const csg_remesh *remesh;
    csg_octree *octree;
    double error, least, lipschitz; /* least: half an edge that is not divided */
    uint64_t most_cubes;
    size_t scratch_floats;
    worker *workers;
    uint32_t worker_count;
    segment *segments;
    size_t segment_count;
    size_t *again;             /* those that were not finished; NULL = all of them */
    bool keeps;                /* stretches of what is finished */
    const csg_missed *begun;   /* what was found in those that were not finished */
    const csg_missed *before;  /* another mesh's search; NULL: there was none */
    csg_changed_boxes changed; /* around all triangles that it did not have, or had alone */
    atomic_bool out_of_memory;
} walk;

/* ---- the walk -------------------------------------------------------------------------------- */

static void take_distance(csg_missed_distances *all, double distance, csg_vec3 at, double unlisted)
{
    if (distance > all->farthest) {
        all->farthest = distance;
        all->place = at;
    }
    all->unlisted = fmax(all->unlisted, unlisted);
}

static void take_distances(csg_missed_distances *all, const csg_missed_distances *more)
{
    take_distance(all, more->farthest, more->place, more->unlisted);
}

static bool keep(const walk *w, worker *s, csg_vec3 p, double distance, uint32_t triangle)
{
    uint32_t most = distance > w->error ? MOST_FAR : MOST_POINTS;
    bool is_listed = triangle != CSG_CORNER_NONE && s->segment->count < most;
    double unlisted = is_listed ? 0 : distance;
    take_distance(&s->segment->distances, distance, p, unlisted);
    take_distance(&s->stretch.distances, distance, p, unlisted);
    if (!is_listed)
        return true;
    if (!csg_memory_reserve(w->remesh->memory, (void **)&s->points, &s->capacity, s->count + 1,
                            sizeof *s->points))
        return false;
    s->points[s->count++] = (csg_missed_point){{(float)p.x, (float)p.y, (float)p.z}, triangle};
    s->segment->count++;
    return true;
}

typedef enum verdict { SETTLED, DIVIDE, NO_MEMORY } verdict;

static bool may_be_sheet(const walk *w, double half)
{
    return 2 * half <= SHEET_CELLS * w->remesh->cell * 1.01;
}

static bool is_place_near(const walk *w, worker *s, csg_vec3 at, double most)
{
    return csg_triangle_tree_is_near(&w->remesh->tree, at, most, &s->near_leaf);
}

/* All of the cube. */
static bool is_near_mesh(const walk *w, worker *s, const cube *q)
{
    double most = 0.9 * w->error - sqrt(3.0) * q->half;
    return most > 0 && is_place_near(w, s, q->c, most);
}

static double farthest_of_interest(const walk *w)
{
    return 4 * w->error + 4 * w->remesh->cell;
}

/* As far as it matters. Most are near: to look there first costs little. */
static double distance_from_mesh(const walk *w, csg_vec3 p, uint32_t *triangle)
{
    double far = farthest_of_interest(w);
    double distance = csg_triangle_tree_nearest(&w->remesh->tree, p, w->error, triangle);
    if (distance == INFINITY)
        distance = csg_triangle_tree_nearest(&w->remesh->tree, p, far, triangle);
    return fmin(distance, far);
}

static bool is_surface_near(const walk *w, worker *s, cube *q)
{
    if (!q->is_asked)
        q->is_near = q->has_surface && is_place_near(w, s, q->surface.at, w->error);
    q->is_asked = true;
    return q->is_near;
}

/* A sheet that has a place near the mesh. Where it turns at some distance from the mesh it is
 * looked at in cubes of the error: elsewhere along the crease it may be farther. */
static verdict settle_turns(const walk *w, worker *s, const cube *q)
{
    static const double CLOSE = 0.5; /* of the error */
    place places[CSG_MISSED_MOST_TURNS];
    uint32_t triangle, count = q->is_bent ? csg_missed_find_turns(&s->field, q, places) : 0;
    for (uint32_t i = 0; i < count; i++) {
        csg_vec3 p = places[i].at;
        if (is_place_near(w, s, p, CLOSE * w->error) ||
            !csg_missed_is_border(&s->field, q, &places[i]))
            continue;
        if (q->half > w->error)
            return DIVIDE;
        double distance = distance_from_mesh(w, p, &triangle);
        if (!keep(w, s, p, distance, triangle))
            return NO_MEMORY;
    }
    return SETTLED;
}

/* Of those children whose gradients settle() asks about, if there is no other way; most have one
 * tape. */
static void find_contents_of_children(const walk *w, worker *s, cube *children, uint32_t count)
{
    bool asks[CSG_OCTANTS] = {false};
    for (uint32_t i = 0; i < count; i++) {
        cube *q = &children[i];
        q->what = CSG_MISSED_UNKNOWN;
        q->ends = false;
        if (csg_missed_is_empty(&s->field, q) || (q->is_sheet && is_surface_near(w, s, q)))
            continue;
        q->ends = q->half <= w->least || is_near_mesh(w, s, q);
        asks[i] = !q->ends;
    }
    for (uint32_t i = 0; i < count; i++) {
        cube *alike[CSG_OCTANTS];
        uint32_t alike_count = 0;
        for (uint32_t k = i; k < count && asks[i]; k++)
            if (asks[k] && csg_tape_is_same(&children[i].tape, &children[k].tape)) {
                alike[alike_count++] = &children[k];
                asks[k] = k == i;
            }
        if (alike_count)
            csg_missed_find_contents(&s->field, alike, alike_count);
    }
}

/* A sheet that leans too far for one place to speak for it: each eighth of it that the surface goes
 * through has one near the mesh. */
static bool is_sheet_near(const walk *w, worker *s, const cube *q)
{
    cube part = *q;
    cube parts[CSG_OCTANTS];
    float c[3][CSG_OCTANTS];
    part.half = 0.5 * q->half;
    part.around = fmin(q->around, part.half);
    csg_missed_place_children(q, c);
    for (int o = 0; o < CSG_OCTANTS; o++) {
        parts[o] = part;
        parts[o].c = csg_vec3_make((double)c[0][o], (double)c[1][o], (double)c[2][o]);
    }
    csg_missed_find_surfaces(&s->field, q, parts, CSG_OCTANTS);
    bool any = false;
    for (int o = 0; o < CSG_OCTANTS; o++) {
        if (csg_missed_is_empty(&s->field, &parts[o]) ||
            (!parts[o].has_surface && csg_missed_leads_out(&parts[o])))
            continue;
        if (!is_surface_near(w, s, &parts[o]))
            return false;
        any = true;
    }
    return any;
}

/* A place of the surface at hand, how far from the mesh it is. */
static verdict settle(const walk *w, worker *s, cube *q)
{
    uint32_t triangle;
    csg_vec3 p = q->surface.at;
    if (!may_be_sheet(w, q->half))
        return DIVIDE;
    if (csg_missed_is_empty(&s->field, q) || q->what == CSG_MISSED_NOTHING)
        return SETTLED;
    if (q->what == CSG_MISSED_ANYTHING)
        return q->is_sheet && is_sheet_near(w, s, q) ? settle_turns(w, s, q) : DIVIDE;
    if (q->what == CSG_MISSED_UNKNOWN && q->is_sheet && is_surface_near(w, s, q))
        return settle_turns(w, s, q);
    if (!q->has_surface)
        return q->ends ? SETTLED : DIVIDE;
    if (q->what == CSG_MISSED_SHEET && is_surface_near(w, s, q))
        return settle_turns(w, s, q);
    if (!csg_missed_is_border(&s->field, q, &q->surface))
        return q->ends ? SETTLED : DIVIDE;
    double distance = distance_from_mesh(w, p, &triangle);
    return keep(w, s, p, distance, triangle) ? SETTLED : NO_MEMORY;
}

/* The children that a surface may go through, with their tapes. False: out of memory. */
static bool make_children(const walk *w, worker *s, const cube *parent, cube *children,
                          uint32_t *count)
{
    float c[3][CSG_OCTANTS], tau = (float)(2 * w->lipschitz * w->remesh->cell);
    cube child = *parent; /* what is known of all of it holds in its parts */
    child.half = 0.5 * parent->half;
    child.around = fmin(parent->around, child.half);
    csg_missed_place_children(parent, c);
    double reach = (child.half + child.around) * sqrt(3.0) * (1 + 1e-6);
    if (!csg_prune_octants(&s->pruner, &parent->tape, c[0], c[1], c[2], (float)reach))
        return false;
    for (int o = 0; o < CSG_OCTANTS; o++) {
        if (csg_prune_state(&s->pruner, o) != CSG_CELL_SURFACE)
            continue;
        child.c = csg_vec3_make((double)c[0][o], (double)c[1][o], (double)c[2][o]);
        child.path = parent->path << 3 | (unsigned)o;
        if (!csg_prune_shorten(&s->pruner, o, tau, &s->arena, &child.tape))
            return false;
        children[(*count)++] = child;
    }
    return true;
}

/* ---- what is the same as before ----------------------------------------------------------------
 */

/* Whether a triangle that matters in a stretch may be another one now. */
static bool is_changed(const walk *w, const worker *s, const cube *q,
                       const csg_missed_stretch *stretch)
{
    double reach = fmax(w->error, stretch->distances.farthest) * (1 + 1e-6) + q->around;
    return csg_changed_boxes_come_near(&s->changed, q->c, q->half, reach);
}

static void begin_stretch(worker *s, uint64_t path)
{
    s->stretch =
        (csg_missed_stretch){.cube = s->item, .path = path, .first = s->count, .effort = s->cubes};
}

/* Nothing is kept of what is not looked through. */
static bool end_stretch(const walk *w, worker *s)
{
    csg_missed_stretch *own = &s->stretch;
    if (s->segment->unfinished)
        return true;
    if (!csg_memory_reserve(w->remesh->memory, (void **)&s->stretches, &s->stretch_capacity,
                            s->stretch_count + 1, sizeof *own))
        return false;
    own->first -= s->segment->first;
    own->count = s->count - s->segment->first - own->first;
    own->effort = s->cubes - own->effort;
    s->stretches[s->stretch_count++] = *own;
    s->segment->stretch_count++;
    return true;
}

/* A stretch that another search has looked through. */
typedef struct known {
    const csg_missed *in;
    const csg_missed_stretch *stretch; /* NULL: none has */
} known;

static known find_known(const walk *w, const worker *s, const cube *q)
{
    const csg_missed *in = w->begun;
    const csg_missed_stretch *stretch = in ? csg_missed_find_stretch(in, s->item, q->path) : NULL;
    if (stretch || !w->before)
        return (known){in, stretch};
    in = w->before;
    stretch = csg_missed_find_stretch(in, s->item, q->path);
    return (known){in, stretch && !is_changed(w, s, q, stretch) ? stretch : NULL};
}

/* Finds the places that were found before; triangles may have other numbers now. */
static bool find_again(const walk *w, worker *s, known k)
{
    bool done = true;
    begin_stretch(s, k.stretch->path);
    s->stretch.distances = k.stretch->distances;
    take_distances(&s->segment->distances, &k.stretch->distances);
    s->cubes += k.stretch->effort;
    for (size_t i = 0; i < k.stretch->count && done; i++) {
        uint32_t triangle;
        csg_vec3 at = csg_vec3_from_floats(k.in->points[k.stretch->first + i].at);
        double distance = distance_from_mesh(w, at, &triangle);
        done = keep(w, s, at, distance, triangle);
    }
    return done && end_stretch(w, s);
}

/* ---- down the octree ---------------------------------------------------------------------------
 */

static bool divide(const walk *w, worker *s, const cube *parent, int depth);

/* Whether there is enough of the frontier cube's effort left. */
static bool may_take(const walk *w, worker *s, uint64_t effort)
{
    if (s->cubes + effort > w->most_cubes)
        s->segment->unfinished = true;
    return !s->segment->unfinished;
}

static bool look_at_child(const walk *w, worker *s, cube *q, int depth)
{
    enum { DEEPEST = 24 };
    uint64_t effort = csg_effort_of(&q->tape);
    if (depth > DEEPEST)
        s->segment->unfinished = true;
    if (!may_take(w, s, effort))
        return true;
    if (depth == STRETCH_DEPTH)
        begin_stretch(s, q->path);
    s->cubes += effort;
    verdict what = settle(w, s, q);
    bool done = what != NO_MEMORY && (what == SETTLED || divide(w, s, q, depth));
    return done && (depth != STRETCH_DEPTH || end_stretch(w, s));
}

/* Cubes are halved from 16 cells to a fraction of the error: the depth is bounded. */
static bool divide(const walk *w, worker *s, const cube *parent, int depth)
{
    cube children[CSG_OCTANTS];
    known knowns[CSG_OCTANTS] = {{NULL, NULL}};
    uint32_t count = 0, new_count = 0, next = 0;
    csg_arena_mark mark = csg_arena_get_mark(&s->arena);
    bool done = make_children(w, s, parent, children, &count);
    for (uint32_t i = 0; i < count && done; i++) {
        if (depth + 1 == STRETCH_DEPTH)
            knowns[i] = find_known(w, s, &children[i]);
        if (!knowns[i].stretch)
            children[new_count++] = children[i];
    }
    if (done && new_count && may_be_sheet(w, children[0].half)) {
        csg_missed_find_surfaces(&s->field, parent, children, new_count);
        find_contents_of_children(w, s, children, new_count);
    }
    for (uint32_t i = 0; i < count && done && !s->segment->unfinished; i++)
        if (!knowns[i].stretch)
            done = look_at_child(w, s, &children[next++], depth + 1);
        else if (may_take(w, s, knowns[i].stretch->effort))
            done = find_again(w, s, knowns[i]);
    csg_arena_release_to(&s->arena, mark);
    return done;
}

static bool look_at_cube(void *user, uint32_t worker_index, size_t index)
{
    walk *w = user;
    size_t item = w->again ? w->again[index] : index;
    worker *s = &w->workers[worker_index];
    const csg_lattice *lattice = w->remesh->marching->lattice;
    uint32_t at[3];
    cube whole = {.half = CSG_BLOCK_EDGE * lattice->cell_size,
                  .around = AROUND_CELLS * lattice->cell_size,
                  .steepest = INFINITY,
                  .path = 1,
                  .tape = csg_octree_frontier_tape(w->octree, item, at)};
    double c[3];
    for (int axis = 0; axis < 3; axis++)
        c[axis] =
            (double)csg_lattice_coordinate(lattice, axis, (2 * at[axis] + 1) * CSG_BLOCK_EDGE);
    whole.c = csg_vec3_make(c[0], c[1], c[2]);
    s->cubes = 0;
    s->item = item;
    s->segment = &w->segments[item];
    *s->segment =
        (segment){.worker = worker_index, .first = s->count, .first_stretch = s->stretch_count};
    if (!csg_changed_boxes_select(&w->changed, whole.c, whole.half,
                                  whole.around + farthest_of_interest(w), w->remesh->memory,
                                  &s->changed) ||
        !divide(w, s, &whole, 0)) {
        atomic_store(&w->out_of_memory, true);
        return false;
    }
    s->segment->effort = s->cubes;
    if (!w->keeps && !s->segment->unfinished) {
        s->stretch_count = s->segment->first_stretch;
        s->segment->stretch_count = 0;
    }
    return !csg_mesh_should_stop(w->remesh->watch);
}

/* ---- all of it ------------------------------------------------------------------------------- */

static bool begin(walk *w)
{
    const csg_remesh *r = w->remesh;
    w->worker_count = csg_pool_threads(r->context->pool);
    w->scratch_floats = csg_kernel_scratch_floats(r->marching->field->depth);
    w->segment_count = csg_octree_frontier_count(w->octree);
    uint64_t most = ALL_CUBES / (w->segment_count + 1);
    w->most_cubes = most < LEAST_CUBES ? LEAST_CUBES : most > MOST_CUBES ? MOST_CUBES : most;
    w->workers = csg_memory_alloc(r->memory, w->worker_count * sizeof *w->workers);
    w->segments = csg_memory_alloc(r->memory, (w->segment_count + 1) * sizeof *w->segments);
    bool done = w->workers && w->segments;
    for (uint32_t i = 0; w->workers && i < w->worker_count; i++) {
        worker *s = &w->workers[i];
        *s = (worker){0};
        csg_pruner_init(&s->pruner, r->memory, r->marching->kernel,
                        csg_octree_rounding(r->marching->lattice));
        csg_arena_init(&s->arena, r->memory);
        s->field = (csg_missed_field){
            .remesh = r,
            .error = w->error,
            .lipschitz = w->lipschitz,
            .scratch = csg_memory_alloc(r->memory, w->scratch_floats * sizeof(float)),
            .scratch_floats = w->scratch_floats};
        done = done && s->field.scratch;
    }
    return done;
}

static void end(walk *w)
{
    csg_memory *memory = w->remesh->memory;
    for (uint32_t i = 0; w->workers && i < w->worker_count; i++) {
        worker *s = &w->workers[i];
        csg_pruner_release(&s->pruner);
        csg_arena_reset(&s->arena);
        csg_memory_release(memory, s->field.scratch, w->scratch_floats * sizeof(float));
        csg_memory_release(memory, s->points, s->capacity * sizeof *s->points);
        csg_memory_release(memory, s->stretches, s->stretch_capacity * sizeof *s->stretches);
        csg_changed_boxes_release(&s->changed, memory);
    }
    csg_changed_boxes_release(&w->changed, memory);
    csg_memory_release(memory, w->workers, w->worker_count * sizeof *w->workers);
    csg_memory_release(memory, w->segments, (w->segment_count + 1) * sizeof *w->segments);
    csg_octree_destroy(w->octree);
}

static void report_cubes(void *user, size_t done, size_t count)
{
    csg_mesh_report_progress(((const walk *)user)->remesh->watch, (double)done / (double)count);
}

/* The points and stretches of a segment, from the record of a rank, to the worker's. */
static bool take_segment(worker *to, csg_memory *memory, csg_record_reader *reader, size_t record,
                         segment *s)
{
    s->worker = 0;
    s->first = to->count;
    s->first_stretch = to->stretch_count;
    return csg_record_read_behind(memory, reader, record, (void **)&to->points, &to->count,
                                  &to->capacity, s->count, sizeof *to->points) &&
           csg_record_read_behind(memory, reader, record, (void **)&to->stretches,
                                  &to->stretch_count, &to->stretch_capacity, s->stretch_count,
                                  sizeof *to->stretches);
}

/* What each rank has found in its cubes, to all: of a cube its segment, its points, its stretches.
 */
static csgm_status exchange_cubes(walk *w, size_t count, csgm_status own)
{
    csgm_context *context = w->remesh->context;
    csg_memory *memory = &context->memory;
    csg_records records = {0};
    csg_record_reader reader;
    for (size_t i = 0; i < count && own == CSGM_OK; i++) {
        const segment *s = &w->segments[w->again ? w->again[i] : i];
        if (csg_ranks_have(context, i) &&
            (!csg_records_add(memory, &records, s, sizeof *s) ||
             !csg_records_add(memory, &records, w->workers[s->worker].points + s->first,
                              s->count * sizeof(csg_missed_point)) ||
             !csg_records_add(memory, &records, w->workers[s->worker].stretches + s->first_stretch,
                              s->stretch_count * sizeof(csg_missed_stretch))))
            own = csg_context_no_memory(context);
    }
    csgm_status status = csg_ranks_exchange(context, own, count, &records, &reader);
    for (size_t i = 0; i < count && status == CSGM_OK; i++) {
        segment *s = &w->segments[w->again ? w->again[i] : i];
        csg_record_read(&reader, i, s, sizeof *s);
        if (!take_segment(&w->workers[0], memory, &reader, i, s))
            status = csg_context_no_memory(context);
    }
    csg_record_reader_end(memory, &reader);
    return status;
}

static csgm_status look_at_cubes(walk *w, size_t count)
{
    csgm_context *context = w->remesh->context;
    csgm_status status = CSGM_OK;
    csg_mesh_take(w->remesh->watch, CSGM_STAGE_RESHAPE, SHARE);
    if (!csg_ranks_run(context, count, CSG_ITEMS_SMALL, look_at_cube, report_cubes, w))
        status = !atomic_load(&w->out_of_memory) && csg_mesh_should_stop(w->remesh->watch)
                     ? csg_mesh_why_stopped(w->remesh->watch)
                     : csg_context_no_memory(context);
    return csg_ranks_share(context, count, CSG_ITEMS_SMALL) ? exchange_cubes(w, count, status)
                                                            : status;
}

/* Behind those of the cubes before it. */
static bool gather_stretches(const walk *w, const segment *s, csg_missed *out)
{
    size_t needed = out->stretch_count + s->stretch_count;
    if (!csg_memory_reserve(w->remesh->memory, (void **)&out->stretches, &out->stretch_capacity,
                            needed, sizeof *out->stretches))
        return false;
    for (size_t i = 0; i < s->stretch_count; i++) {
        csg_missed_stretch *to = &out->stretches[out->stretch_count + i];
        *to = w->workers[s->worker].stretches[s->first_stretch + i];
        to->first += out->count;
    }
    out->stretch_count = needed;
    return true;
}

static bool gather_points(const walk *w, const segment *s, csg_missed *out)
{
    if (!csg_memory_reserve(w->remesh->memory, (void **)&out->points, &out->capacity,
                            out->count + s->count, sizeof *out->points))
        return false;
    memcpy(out->points + out->count, w->workers[s->worker].points + s->first,
           s->count * sizeof *out->points);
    out->count += s->count;
    return true;
}

static bool gather_segment(const walk *w, const segment *s, csg_missed *out)
{
    take_distances(&out->distances, &s->distances);
    out->unfinished += s->unfinished;
    return (!s->stretch_count || gather_stretches(w, s, out)) &&
           (!s->count || gather_points(w, s, out));
}

static bool gather_segments(const walk *w, csg_missed *out)
{
    for (size_t i = 0; i < w->segment_count; i++)
        if (!gather_segment(w, &w->segments[i], out))
            return false;
    return true;
}

static size_t list_unfinished(const walk *w, size_t *list)
{
    size_t count = 0;
    for (size_t i = 0; i < w->segment_count; i++)
        if (w->segments[i].unfinished)
            list[count++] = i;
    return count;
}

static uint64_t efforts_of(const walk *w, const size_t *list, size_t count)
{
    uint64_t sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += w->segments[list[i]].effort;
    return sum;
}

/* What was found in cubes that were not finished is not looked for twice. */
static csgm_status look_at_unfinished(walk *w, size_t count)
{
    csg_missed begun = {0};
    bool done = true;
    for (size_t i = 0; i < count && done; i++)
        done = gather_segment(w, &w->segments[w->again[i]], &begun);
    w->begun = &begun;
    csgm_status status = done ? look_at_cubes(w, count) : csg_context_no_memory(w->remesh->context);
    w->begun = NULL;
    csg_missed_release(&begun, w->remesh->memory);
    return status;
}

/* Few cubes take much more than the others, and few of those more than their share of what there
 * is: they get what these have left. */
static csgm_status look_again(walk *w)
{
    enum { PASSES = 3 };
    size_t bytes = (w->segment_count + 1) * sizeof *w->again, count = 1;
    uint64_t left = ALL_AGAIN, most = 0;
    csgm_status status = CSGM_OK;
    w->again = csg_memory_alloc(w->remesh->memory, bytes);
    if (!w->again)
        return csg_context_no_memory(w->remesh->context);
    for (int pass = 0; pass < PASSES && count && status == CSGM_OK; pass++) {
        count = list_unfinished(w, w->again);
        uint64_t before = pass ? efforts_of(w, w->again, count) : 0;
        most += left / (count + 1);
        w->most_cubes = most < AGAIN_CUBES ? most : AGAIN_CUBES;
        status = look_at_unfinished(w, count);
        uint64_t more = efforts_of(w, w->again, count) - before;
        left -= more < left ? more : left;
    }
    csg_memory_release(w->remesh->memory, w->again, bytes);
    w->again = NULL;
    return status;
}

/* Where there is no memory to tell what has changed all is looked at again. */
static void compare_with(walk *w, const csg_missed_before *before)
{
    const csg_remesh *r = w->remesh;
    csg_written_triangles now;
    if (!before->missed.stretch_count || !csg_written_triangles_list(r, &now))
        return;
    if (csg_changed_boxes_find(r, &before->triangles, &now, &w->changed))
        w->before = &before->missed;
    csg_written_triangles_release(&now, r->memory);
}

csgm_status csg_missed_find(const csg_remesh *r, double error, const csg_missed_before *before,
                            bool keeps, csg_missed *out)
{
    const csg_marching *m = r->marching;
    walk w = {.remesh = r,
              .error = error,
              .keeps = keeps,
              .least = fmax(0.25 * error, 1e-4 * r->cell),
              .lipschitz = (double)m->field->tape.lipschitz};
    *out = (csg_missed){0};
    const csg_octree_options options = {.prune = true,
                                        .margin = 2 * AROUND_CELLS * r->cell,
                                        .cancelled = csg_mesh_should_stop,
                                        .user = r->watch};
    csgm_status status = csg_octree_create(r->context, m->field, m->lattice, &options, &w.octree);
    if (status != CSGM_OK)
        return status == CSGM_CANCELLED ? csg_mesh_why_stopped(r->watch) : status;
    compare_with(&w, before);
    status = begin(&w) ? look_at_cubes(&w, w.segment_count) : csg_context_no_memory(r->context);
    if (status == CSGM_OK)
        status = look_again(&w);
    if (status == CSGM_OK && !gather_segments(&w, out))
        status = csg_context_no_memory(r->context);
    end(&w);
    if (status != CSGM_OK)
        csg_missed_release(out, r->memory);
    return status;
}
