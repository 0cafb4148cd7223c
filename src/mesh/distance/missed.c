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
#include "mesh/distance/slopes.h"
#include "mesh/plane.h"

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
/* How near a sheet's gradients must be to their middle, of the field's slope. A sheet that leans
 * farther is looked at in eight places; of one that leans less no place is farther from the mesh
 * than others by more than a twentieth. */
static const double SMOOTH = 0.5, CREASED = 0.45, LEANING = 0.2, LEVEL = 0.95;

/* What a frontier cube gave, and where it is. */
typedef struct segment {
    uint32_t worker;
    bool unfinished;
    size_t first, count;
    double farthest, unlisted;
    csg_vec3 place;
} segment;

typedef struct worker {
    csg_pruner pruner;
    csg_arena arena;
    float *scratch;
    csg_missed_point *points;
    size_t count, capacity;
    uint64_t cubes; /* in the frontier cube at hand, by their effort */
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
    size_t *again; /* those that were not finished; NULL = all of them */
    atomic_bool out_of_memory;
} walk;

/* A place of the surface, and the gradient there. */
typedef struct place {
    csg_vec3 at, slope;
} place;

/* What the field's gradients say that there is in a cube. */
typedef enum content { UNKNOWN, NOTHING, SHEET, ANYTHING } content;

/* A cube with the tape that holds in it and around it. */
typedef struct cube {
    csg_vec3 c;
    double half, around, value; /* in the middle, where the cube is small enough for one sheet */
    csg_vec3 slope;             /* there */
    place surface;              /* in the cube or a little around, if there is one */
    csg_tape tape;
    double steepest, doubt; /* how fast the field changes at most along the axes, and its rounding
                               there: in a cube that this one is a part of */
    bool has_surface;
    bool is_sheet;          /* with those around it */
    bool is_bent;           /* where it is one: it may have a crease, or a narrow fillet */
    bool ends;              /* it is not divided */
    bool is_asked, is_near; /* whether that place is near the mesh, and that it is */
    content what;
} cube;

/* ---- the field in a cube --------------------------------------------------------------------- */

/* Values this small are zero. */
static double noise_of(const walk *w)
{
    return 4 * (double)w->remesh->probe.noise;
}

enum { SEEDS = CSG_LANES };

/* Places that go to the surface, and the field where they are. */
typedef struct seeds {
    csg_vec3 at[SEEDS], slope[SEEDS];
    double value[SEEDS];
    uint32_t count, moving[SEEDS], moving_count; /* those that are still on their way */
} seeds;

static void add_seed(seeds *to, csg_vec3 at)
{
    to->moving[to->moving_count++] = to->count;
    to->at[to->count++] = at;
}

/* The field where those are that move. */
static void ask(const walk *w, worker *s, const csg_tape *tape, seeds *of)
{
    float at[3][SEEDS] = {{0}}, f[SEEDS], g[3][SEEDS];
    for (uint32_t k = 0; k < of->moving_count; k++) {
        csg_vec3 p = of->at[of->moving[k]];
        at[0][k] = (float)p.x, at[1][k] = (float)p.y, at[2][k] = (float)p.z;
    }
    w->remesh->probe.marching->kernel->values_and_gradients(tape, at[0], at[1], at[2],
                                                            of->moving_count, f, g[0], g[1], g[2],
                                                            s->scratch, w->scratch_floats);
    for (uint32_t k = 0; k < of->moving_count; k++) {
        of->value[of->moving[k]] = (double)f[k];
        of->slope[of->moving[k]] = csg_vec3_make((double)g[0][k], (double)g[1][k], (double)g[2][k]);
    }
}

/* Seeds that were asked for go to places of the surface that are no farther off along any axis than
 * `reach`, by Newton's steps; is_found: which do. All go at once: a walk over the tape for sixteen
 * places costs what it does for one. */
static void find_surfaces(const walk *w, worker *s, const csg_tape *tape, double reach, seeds *of,
                          bool is_found[SEEDS])
{
    enum { STEPS = 6 };
    double noise = noise_of(w);
    csg_vec3 begin[SEEDS];
    memcpy(begin, of->at, of->count * sizeof *begin);
    for (int step = 0;; step++) {
        uint32_t left = 0;
        for (uint32_t k = 0; k < of->moving_count; k++) {
            uint32_t i = of->moving[k];
            double square = csg_vec3_dot(of->slope[i], of->slope[i]);
            is_found[i] = fabs(of->value[i]) <= noise;
            if (is_found[i] || step == STEPS || !(square > 1e-6))
                continue;
            of->at[i] =
                csg_vec3_sub(of->at[i], csg_vec3_scale(of->slope[i], of->value[i] / square));
            csg_vec3 off = csg_vec3_sub(of->at[i], begin[i]);
            if (fabs(off.x) <= reach && fabs(off.y) <= reach && fabs(off.z) <= reach)
                of->moving[left++] = i;
        }
        of->moving_count = left;
        if (!left)
            return;
        ask(w, s, tape, of);
    }
}

/* How far around its middle a cube's places of the surface may lie. */
static double reach_of(const cube *q)
{
    return q->half + 0.9 * q->around;
}

enum { RINGS = 4 }; /* around a place of the surface, each a quarter of that before it */

/* What is not as deep has no room for a gap, or a wall. */
static double least_depth(const walk *w)
{
    double last = 0.25 * w->error / (1 << 2 * (RINGS - 1));
    return fmax(noise_of(w), last);
}

/* Whether f changes its sign at a place where it is zero: where parts of a solid touch it is zero
 * within, and outside where nothing is left of a wall. A gap, or a wall, as narrow as the last ring
 * would be none. */
static bool is_border(const walk *w, worker *s, const cube *q, const place *at_zero)
{
    enum { WAYS = 6, PLACES = 2 + RINGS * WAYS, PADDED = PLACES + CSG_LANES };
    float at[3][PADDED] = {{0}}, f[PADDED] = {0};
    csg_vec3 p = at_zero->at, uphill = csg_vec3_normalize(at_zero->slope);
    double noise = noise_of(w), reach = 0.25 * w->error;
    for (int i = 0; i < PLACES; i++) {
        int ring = (i - 2) / WAYS, way = (i - 2) % WAYS / 2;
        double step = (i % 2 ? reach : -reach) / (i < 2 ? 1 : 1 << 2 * ring);
        csg_vec3 off = {way == 0 ? step : 0, way == 1 ? step : 0, way == 2 ? step : 0};
        csg_vec3 to = csg_vec3_add(p, i < 2 ? csg_vec3_scale(uphill, step) : off);
        at[0][i] = (float)to.x, at[1][i] = (float)to.y, at[2][i] = (float)to.z;
    }
    w->remesh->probe.marching->kernel->values(&q->tape, at[0], at[1], at[2], PLACES, f, s->scratch,
                                              w->scratch_floats);
    bool inside = false, outside = false;
    for (int i = 0; i < PLACES; i++) {
        inside |= (double)f[i] > noise;
        outside |= (double)f[i] < -noise;
    }
    return inside && outside;
}

/* Whether the field is too far from zero in the middle to be it anywhere in the cube. */
static bool is_far_from_zero(const walk *w, const cube *q)
{
    return fabs(q->value) > q->steepest * q->half + q->doubt + noise_of(w);
}

/* How near all gradients are at least to one direction where the field is zero, of the steepest
 * there. */
static double leaning_of(const csg_gradients *gradients)
{
    double steepest = 0;
    csg_cone cone;
    bool has_level = gradients->has_level;
    const csg_cone_balls *balls = has_level ? &gradients->level : &gradients->balls;
    for (uint32_t i = 0; i < balls->count; i++) {
        const double *g = balls->items[i].at;
        steepest = fmax(steepest, csg_vec3_norm(csg_vec3_make(g[0], g[1], g[2])));
    }
    bool has_axis =
        has_level ? csg_cone_find_axis(balls, &cone) : csg_gradients_find_axis(gradients, &cone);
    return has_axis ? cone.least / steepest : 0;
}

/* ---- the walk -------------------------------------------------------------------------------- */

static bool keep(const walk *w, worker *s, csg_vec3 p, double distance, uint32_t triangle)
{
    if (distance > s->segment->farthest) {
        s->segment->farthest = distance;
        s->segment->place = p;
    }
    uint32_t most = distance > w->error ? MOST_FAR : MOST_POINTS;
    if (triangle == CSG_CORNER_NONE || s->segment->count >= most) {
        s->segment->unlisted = fmax(s->segment->unlisted, distance);
        return true;
    }
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

/* All of the cube. */
static bool is_near_mesh(const walk *w, const cube *q)
{
    double most = 0.9 * w->error - sqrt(3.0) * q->half;
    return most > 0 && csg_triangle_tree_is_near(&w->remesh->tree, q->c, most);
}

/* As far as it matters. Most are near: to look there first costs little. */
static double distance_from_mesh(const walk *w, csg_vec3 p, uint32_t *triangle)
{
    double far = 4 * w->error + 4 * w->remesh->cell;
    double distance = csg_triangle_tree_nearest(&w->remesh->tree, p, w->error, triangle);
    if (distance == INFINITY)
        distance = csg_triangle_tree_nearest(&w->remesh->tree, p, far, triangle);
    return fmin(distance, far);
}

static bool is_surface_near(const walk *w, cube *q)
{
    if (!q->is_asked)
        q->is_near =
            q->has_surface && csg_triangle_tree_is_near(&w->remesh->tree, q->surface.at, w->error);
    q->is_asked = true;
    return q->is_near;
}

/* ---- where a sheet turns -----------------------------------------------------------------------
 * A mesh that cuts off a crease can be within the error of both faces, so near to every place of
 * these that is looked at, and still be farther from the crease.
 */

/* Of a unit gradient, so that planes of different steepness compare. */
static bool find_plane(csg_vec3 at, double value, csg_vec3 gradient, csg_plane *out)
{
    double norm = csg_vec3_norm(gradient);
    if (!(norm > 1e-3))
        return false;
    *out = csg_plane_of(at, value / norm, csg_vec3_scale(gradient, 1 / norm));
    return true;
}

/* Planes of the two faces that turn most from each other, as the cube's corners and its middle
 * show them. */
static bool find_faces(const walk *w, worker *s, const cube *q, csg_plane faces[2])
{
    float at[3][CSG_LANES] = {{0}}, g[3][CSG_LANES], f[CSG_LANES];
    csg_plane planes[CSG_OCTANTS + 1] = {{{0, 0, 0}, 0}};
    uint32_t count = 0;
    double least = 1, step = q->half;
    for (int i = 0; i < CSG_OCTANTS; i++) {
        at[0][i] = (float)(q->c.x + (i & 1 ? step : -step));
        at[1][i] = (float)(q->c.y + (i & 2 ? step : -step));
        at[2][i] = (float)(q->c.z + (i & 4 ? step : -step));
    }
    w->remesh->probe.marching->kernel->values_and_gradients(&q->tape, at[0], at[1], at[2],
                                                            CSG_OCTANTS, f, g[0], g[1], g[2],
                                                            s->scratch, w->scratch_floats);
    count += find_plane(q->c, q->value, q->slope, &planes[count]);
    for (int i = 0; i < CSG_OCTANTS; i++) {
        csg_vec3 p = {(double)at[0][i], (double)at[1][i], (double)at[2][i]};
        csg_vec3 slope = {(double)g[0][i], (double)g[1][i], (double)g[2][i]};
        count += find_plane(p, (double)f[i], slope, &planes[count]);
    }
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t k = 0; k < i; k++) {
            double cosine = csg_vec3_dot(planes[i].g, planes[k].g);
            if (cosine >= least)
                continue;
            least = cosine;
            faces[0] = planes[i];
            faces[1] = planes[k];
        }
    return least < LEVEL;
}

enum { TURNS = 5 };

/* Places where a sheet turns within the cube: along the line in which tangent planes of both faces
 * meet, from there to the surface. */
static uint32_t find_turns(const walk *w, worker *s, const cube *q, place out[TURNS])
{
    static const double LEAST_SQUARE = 0.05; /* of the sine */
    csg_plane faces[2] = {{{0, 0, 0}, 0}};
    csg_vec3 middle = q->c;
    seeds from = {.count = 0};
    bool is_found[SEEDS];
    uint32_t count = 0;
    if (!find_faces(w, s, q, faces) || !csg_planes_meet_in_line(faces, LEAST_SQUARE, &middle))
        return 0;
    csg_vec3 along = csg_vec3_normalize(csg_vec3_cross(faces[0].g, faces[1].g));
    for (int i = 0; i < TURNS; i++) {
        double step = (2.0 * i / (TURNS - 1) - 1) * q->half;
        csg_vec3 at = csg_vec3_add(middle, csg_vec3_scale(along, step));
        csg_vec3 off = csg_vec3_sub(at, q->c);
        if (fmax(fabs(off.x), fmax(fabs(off.y), fabs(off.z))) <= reach_of(q))
            add_seed(&from, at); /* else it is another cube's */
    }
    if (!from.count)
        return 0;
    ask(w, s, &q->tape, &from);
    find_surfaces(w, s, &q->tape, reach_of(q), &from, is_found);
    for (uint32_t i = 0; i < from.count; i++)
        if (is_found[i])
            out[count++] = (place){from.at[i], from.slope[i]};
    return count;
}

static bool has_several_balls(const csg_gradients *gradients)
{
    return (gradients->has_level ? gradients->level.count : gradients->balls.count) > 1;
}

/* What these gradients say that there is in the cube. */
static content content_of(const walk *w, cube *q, const csg_gradients *gradients)
{
    q->steepest = fmin(q->steepest, csg_gradients_steepest(gradients));
    q->doubt = fmax(q->doubt, gradients->doubt);
    if (is_far_from_zero(w, q) || gradients->least > -least_depth(w) ||
        gradients->most < least_depth(w))
        return NOTHING; /* or a face that solids share */
    double leaning = leaning_of(gradients);
    q->is_sheet = leaning >= LEANING;
    q->is_bent = leaning < LEVEL;
    return leaning >= (has_several_balls(gradients) ? CREASED : SMOOTH) ? SHEET : ANYTHING;
}

/* Of cubes in which one tape holds. */
static void find_contents(const walk *w, worker *s, cube *const *cubes, size_t count)
{
    csg_gradients_region all[CSG_OCTANTS] = {0};
    csg_gradients gradients[CSG_OCTANTS], *found[CSG_OCTANTS] = {NULL}; /* not filled: large */
    bool is_known[CSG_OCTANTS];
    for (size_t i = 0; i < count; i++) {
        csg_vec3 c = cubes[i]->c;
        all[i] = (csg_gradients_region){{c, c, c}, c, 0, cubes[i]->half};
        found[i] = &gradients[i];
    }
    csg_gradients_find_each(w->remesh->probe.marching->kernel, &cubes[0]->tape, all, count,
                            s->scratch, w->scratch_floats, found, is_known);
    for (size_t i = 0; i < count; i++)
        cubes[i]->what = is_known[i] ? content_of(w, cubes[i], &gradients[i]) : ANYTHING;
}

/* A sheet that has a place near the mesh. Where it turns at some distance from the mesh it is
 * looked at in cubes of the error: elsewhere along the crease it may be farther. */
static verdict settle_turns(const walk *w, worker *s, const cube *q)
{
    static const double CLOSE = 0.5; /* of the error */
    place places[TURNS];
    uint32_t triangle, count = q->is_bent ? find_turns(w, s, q, places) : 0;
    for (uint32_t i = 0; i < count; i++) {
        csg_vec3 p = places[i].at;
        if (csg_triangle_tree_is_near(&w->remesh->tree, p, CLOSE * w->error) ||
            !is_border(w, s, q, &places[i]))
            continue;
        if (q->half > w->error)
            return DIVIDE;
        double distance = distance_from_mesh(w, p, &triangle);
        if (!keep(w, s, p, distance, triangle))
            return NO_MEMORY;
    }
    return SETTLED;
}

/* Whether its value in the middle is too large for a surface to be in it. */
static bool is_empty(const walk *w, const cube *q)
{
    return fabs(q->value) > w->lipschitz * sqrt(3.0) * q->half + noise_of(w) ||
           is_far_from_zero(w, q);
}

/* Of those children whose gradients settle() asks about, if there is no other way; most have one
 * tape. */
static void find_contents_of_children(const walk *w, worker *s, cube *children, uint32_t count)
{
    bool asks[CSG_OCTANTS] = {false};
    for (uint32_t i = 0; i < count; i++) {
        cube *q = &children[i];
        q->what = UNKNOWN;
        q->ends = false;
        if (is_empty(w, q) || (q->is_sheet && is_surface_near(w, q)))
            continue;
        q->ends = q->half <= w->least || is_near_mesh(w, q);
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
            find_contents(w, s, alike, alike_count);
    }
}

/* A place of the surface at hand, how far from the mesh it is. */
static verdict settle(const walk *w, worker *s, cube *q)
{
    uint32_t triangle;
    csg_vec3 p = q->surface.at;
    if (!may_be_sheet(w, q->half))
        return DIVIDE;
    if (is_empty(w, q) || q->what == NOTHING)
        return SETTLED;
    if (q->what == ANYTHING)
        return DIVIDE;
    if (q->what == UNKNOWN && q->is_sheet && is_surface_near(w, q))
        return settle_turns(w, s, q);
    if (!q->has_surface)
        return q->ends ? SETTLED : DIVIDE;
    if (q->what == SHEET && is_surface_near(w, q))
        return settle_turns(w, s, q);
    if (!is_border(w, s, q, &q->surface))
        return q->ends ? SETTLED : DIVIDE;
    double distance = distance_from_mesh(w, p, &triangle);
    return keep(w, s, p, distance, triangle) ? SETTLED : NO_MEMORY;
}

static void place_children(const cube *parent, float c[3][CSG_OCTANTS])
{
    const double at[3] = {parent->c.x, parent->c.y, parent->c.z};
    for (int axis = 0; axis < 3; axis++)
        for (int o = 0; o < CSG_OCTANTS; o++)
            c[axis][o] = (float)(at[axis] + (o >> axis & 1 ? 0.5 : -0.5) * parent->half);
}

/* The children that a surface may go through, with their tapes. False: out of memory. */
static bool make_children(const walk *w, worker *s, const cube *parent, cube *children,
                          uint32_t *count)
{
    float c[3][CSG_OCTANTS], tau = (float)(2 * w->lipschitz * w->remesh->cell);
    cube child = *parent; /* what is known of all of it holds in its parts */
    child.half = 0.5 * parent->half;
    child.around = fmin(parent->around, child.half);
    place_children(parent, c);
    double reach = (child.half + child.around) * sqrt(3.0) * (1 + 1e-6);
    if (!csg_prune_octants(&s->pruner, &parent->tape, c[0], c[1], c[2], (float)reach))
        return false;
    for (int o = 0; o < CSG_OCTANTS; o++) {
        if (csg_prune_state(&s->pruner, o) != CSG_CELL_SURFACE)
            continue;
        child.c = csg_vec3_make((double)c[0][o], (double)c[1][o], (double)c[2][o]);
        if (!csg_prune_shorten(&s->pruner, o, tau, &s->arena, &child.tape))
            return false;
        children[(*count)++] = child;
    }
    return true;
}

/* The field in the middle of each child, and a place of the surface in it, by the tape that holds
 * in all of them. */
static void find_surfaces_of_children(const walk *w, worker *s, const cube *parent, cube *children,
                                      uint32_t count)
{
    seeds from = {.count = 0};
    bool is_found[SEEDS] = {false};
    for (uint32_t i = 0; i < count; i++)
        add_seed(&from, children[i].c);
    ask(w, s, &parent->tape, &from);
    from.moving_count = 0;
    for (uint32_t i = 0; i < count; i++) {
        children[i].value = from.value[i];
        children[i].slope = from.slope[i];
        if (!is_empty(w, &children[i]))
            from.moving[from.moving_count++] = i;
    }
    find_surfaces(w, s, &parent->tape, reach_of(&children[0]), &from, is_found);
    for (uint32_t i = 0; i < count; i++) {
        children[i].has_surface = is_found[i];
        children[i].is_asked = false;
        children[i].surface = (place){from.at[i], from.slope[i]};
    }
}

/* Cubes are halved from 16 cells to a fraction of the error: the depth is bounded. */
static bool divide(const walk *w, worker *s, const cube *parent, int depth)
{
    enum { DEEPEST = 24 };
    cube children[CSG_OCTANTS];
    uint32_t count = 0;
    csg_arena_mark mark = csg_arena_get_mark(&s->arena);
    bool done = make_children(w, s, parent, children, &count);
    if (done && count && may_be_sheet(w, children[0].half)) {
        find_surfaces_of_children(w, s, parent, children, count);
        find_contents_of_children(w, s, children, count);
    }
    for (uint32_t i = 0; i < count && done; i++) {
        s->cubes += csg_effort_of(&children[i].tape);
        if (s->cubes > w->most_cubes || depth == DEEPEST) {
            s->segment->unfinished = true;
            break;
        }
        verdict what = settle(w, s, &children[i]);
        done = what != NO_MEMORY && (what == SETTLED || divide(w, s, &children[i], depth + 1));
    }
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
                  .tape = csg_octree_frontier_tape(w->octree, item, at)};
    double c[3];
    for (int axis = 0; axis < 3; axis++)
        c[axis] =
            (double)csg_lattice_coordinate(lattice, axis, (2 * at[axis] + 1) * CSG_BLOCK_EDGE);
    whole.c = csg_vec3_make(c[0], c[1], c[2]);
    s->cubes = 0;
    s->segment = &w->segments[item];
    *s->segment = (segment){.worker = worker_index, .first = s->count};
    if (!divide(w, s, &whole, 0)) {
        atomic_store(&w->out_of_memory, true);
        return false;
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
        s->scratch = csg_memory_alloc(r->memory, w->scratch_floats * sizeof(float));
        done = done && s->scratch;
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
        csg_memory_release(memory, s->scratch, w->scratch_floats * sizeof(float));
        csg_memory_release(memory, s->points, s->capacity * sizeof *s->points);
    }
    csg_memory_release(memory, w->workers, w->worker_count * sizeof *w->workers);
    csg_memory_release(memory, w->segments, (w->segment_count + 1) * sizeof *w->segments);
    csg_octree_destroy(w->octree);
}

static void report_cubes(void *user, size_t done, size_t count)
{
    csg_mesh_report_progress(((const walk *)user)->remesh->watch, (double)done / (double)count);
}

/* What each rank has found in its cubes, to all: of a cube its segment, then its points. */
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
                              s->count * sizeof(csg_missed_point))))
            own = csg_context_no_memory(context);
    }
    csgm_status status = csg_ranks_exchange(context, own, count, &records, &reader);
    worker *to = &w->workers[0];
    for (size_t i = 0; i < count && status == CSGM_OK; i++) {
        segment *s = &w->segments[w->again ? w->again[i] : i];
        csg_record_read(&reader, i, s, sizeof *s);
        s->worker = 0;
        s->first = to->count;
        to->count += s->count;
        if (!csg_memory_reserve(memory, (void **)&to->points, &to->capacity, to->count,
                                sizeof *to->points))
            status = csg_context_no_memory(context);
        else
            csg_record_read(&reader, i, to->points + s->first, s->count * sizeof *to->points);
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

/* Few cubes take much more than the others. */
static csgm_status look_again(walk *w)
{
    csg_memory *memory = w->remesh->memory;
    size_t bytes = (w->segment_count + 1) * sizeof *w->again, count = 0;
    w->again = csg_memory_alloc(memory, bytes);
    if (!w->again)
        return csg_context_no_memory(w->remesh->context);
    for (size_t i = 0; i < w->segment_count; i++)
        if (w->segments[i].unfinished)
            w->again[count++] = i;
    uint64_t most = ALL_AGAIN / (count + 1);
    w->most_cubes = most < AGAIN_CUBES ? most : AGAIN_CUBES;
    csgm_status status = look_at_cubes(w, count);
    csg_memory_release(memory, w->again, bytes);
    w->again = NULL;
    return status;
}

static bool gather_segments(const walk *w, csg_missed *out)
{
    for (size_t i = 0; i < w->segment_count; i++) {
        const segment *s = &w->segments[i];
        if (s->farthest > out->farthest) {
            out->farthest = s->farthest;
            out->place = s->place;
        }
        out->unlisted = fmax(out->unlisted, s->unlisted);
        out->unfinished += s->unfinished;
        if (!s->count)
            continue;
        if (!csg_memory_reserve(w->remesh->memory, (void **)&out->points, &out->capacity,
                                out->count + s->count, sizeof *out->points))
            return false;
        memcpy(out->points + out->count, w->workers[s->worker].points + s->first,
               s->count * sizeof *out->points);
        out->count += s->count;
    }
    return true;
}

csgm_status csg_missed_find(const csg_remesh *r, double error, csg_missed *out)
{
    const csg_marching *m = r->marching;
    walk w = {.remesh = r,
              .error = error,
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

void csg_missed_release(csg_missed *missed, csg_memory *memory)
{
    csg_memory_release(memory, missed->points, missed->capacity * sizeof *missed->points);
    *missed = (csg_missed){0};
}
