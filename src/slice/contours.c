/* SPDX-License-Identifier: MIT
 * Contours of one layer; see contours.h.
 */
#include "slice/contours.h"

#include <math.h>
#include <string.h>

#include "field/point.h"

enum { CORNERS = 4, NOTHING = -1 };

struct csg_slice_square {
    uint32_t x, y, edge; /* in steps */
    uint32_t tape, plane;
    uint32_t first, count; /* of its crossings, into of_squares */
    bool inside[CORNERS];  /* bit 0 of a corner's number: x, bit 1: y */
    bool is_smooth, has_corner;
    bool is_taken; /* by a corner of a square beside it */
    double corner[2];
};

struct csg_slice_crossing {
    uint32_t x, y, length; /* of its edge, from the end that comes first; in steps */
    uint32_t squares[2];   /* before and behind it, along the axis that it does not run along */
    uint32_t tape;         /* of the smaller square */
    uint32_t next, via;    /* the crossing that comes after it, the square between them */
    bool runs_along_y, is_low_inside, is_done, is_pinned;
    double at[2];
    float slope[2]; /* of the field, where a square is not smooth */
};

/* Where the layer runs: at each level through the lower or the upper half of cubes. */
typedef struct layer_path {
    csg_slice_contours *of;
    float z;
    bool upper[CSG_SLICE_DEEPEST + 1];
} layer_path;

bool csg_slice_contours_init(csg_slice_contours *c, csg_slice_cubes *cubes)
{
    *c = (csg_slice_contours){.cubes = cubes, .memory = &cubes->plan->context->memory};
    c->edges = csg_memory_alloc(c->memory, sizeof *c->edges);
    return c->edges;
}

void csg_slice_contours_release(csg_slice_contours *c)
{
    csg_memory *memory = c->memory;
    csg_memory_release(memory, c->squares, c->square_capacity * sizeof *c->squares);
    csg_memory_release(memory, c->crossings, c->crossing_capacity * sizeof *c->crossings);
    csg_memory_release(memory, c->of_squares, c->of_squares_capacity * sizeof *c->of_squares);
    csg_memory_release(memory, c->loop, c->loop_capacity * sizeof *c->loop);
    csg_memory_release(memory, c->edges, sizeof *c->edges);
}

/* ---- squares and their signs -------------------------------------------------------------------
 */

static uint32_t child_of(const layer_path *path, const csg_slice_cube *cube, int level, int x,
                         int y)
{
    return cube->first + (uint32_t)(x | y << 1 | path->upper[level] << 2);
}

static bool list_squares(const layer_path *path, uint32_t index, int level, uint32_t x, uint32_t y)
{
    csg_slice_contours *c = path->of;
    csg_slice_cube *cube = &c->cubes->cubes[index];
    uint32_t edge = 1u << (c->cubes->plan->levels - level);
    if (cube->kind == CSG_SLICE_EMPTY)
        return true;
    if (cube->kind == CSG_SLICE_SPLIT) {
        for (uint32_t o = 0; o < CORNERS; o++)
            if (!list_squares(path, child_of(path, cube, level, o & 1, (int)(o >> 1)), level + 1,
                              x + (o & 1) * edge / 2, y + (o >> 1) * edge / 2))
                return false;
        return true;
    }
    if (!csg_memory_reserve(c->memory, (void **)&c->squares, &c->square_capacity,
                            c->square_count + 1, sizeof *c->squares))
        return false;
    cube->square = (uint32_t)c->square_count;
    c->squares[c->square_count++] =
        (csg_slice_square){.x = x,
                           .y = y,
                           .edge = edge,
                           .tape = cube->tape,
                           .plane = cube->kind == CSG_SLICE_SMOOTH ? cube->first : 0,
                           .is_smooth = cube->kind == CSG_SLICE_SMOOTH};
    return true;
}

/* Corners whose signs are asked of the field, of squares with one tape. */
typedef struct corner_batch {
    float x[3][CSG_BATCH], f[CSG_BATCH];
    bool *inside[CSG_BATCH];
    uint32_t tape;
    size_t count;
} corner_batch;

static void ask_corners(csg_slice_contours *c, corner_batch *b)
{
    for (size_t i = b->count; i % CSG_LANES; i++)
        b->x[0][i] = b->x[0][0], b->x[1][i] = b->x[1][0];
    if (b->count)
        c->cubes->plan->kernel->values(&c->cubes->tapes[b->tape], b->x[0], b->x[1], b->x[2],
                                       b->count, b->f, c->cubes->scratch, c->cubes->scratch_floats);
    for (size_t i = 0; i < b->count; i++)
        *b->inside[i] = b->f[i] >= 0;
    b->count = 0;
}

/* Where the square's plane leaves no doubt it is not. */
static void find_signs(csg_slice_contours *c, float z)
{
    const csg_slice_plan *plan = c->cubes->plan;
    corner_batch batch = {.count = 0};
    for (size_t i = 0; i < CSG_BATCH; i++)
        batch.x[2][i] = z;
    for (size_t i = 0; i < c->square_count; i++) {
        csg_slice_square *s = &c->squares[i];
        const csg_slice_plane *plane = s->plane ? &c->cubes->planes[s->plane - 1] : NULL;
        if (s->tape != batch.tape || batch.count + CORNERS > CSG_BATCH)
            ask_corners(c, &batch);
        batch.tape = s->tape;
        for (uint32_t o = 0; o < CORNERS; o++) {
            float x = csg_slice_place(plan, 0, s->x + (o & 1) * s->edge);
            float y = csg_slice_place(plan, 1, s->y + (o >> 1) * s->edge);
            double value = plane ? plane->constant + (double)plane->slope[0] * (double)x +
                                       (double)plane->slope[1] * (double)y +
                                       (double)plane->slope[2] * (double)z
                                 : 0;
            s->inside[o] = value > 0;
            if (plane && fabs(value) > (double)plane->room)
                continue;
            batch.x[0][batch.count] = x;
            batch.x[1][batch.count] = y;
            batch.inside[batch.count++] = &s->inside[o];
        }
    }
    ask_corners(c, &batch);
}

/* ---- crossings ---------------------------------------------------------------------------------
 */

/* Squares a and b share an edge, b behind a along the axis. */
static bool add_crossing(csg_slice_contours *c, uint32_t a, uint32_t b, int axis)
{
    bool is_first = c->squares[a].edge <= c->squares[b].edge;
    csg_slice_square *s = &c->squares[is_first ? a : b];
    int low = !is_first ? 0 : axis ? 2 : 1;
    int high = low + (axis ? 1 : 2);
    if (s->inside[low] == s->inside[high])
        return true;
    if (!csg_memory_reserve(c->memory, (void **)&c->crossings, &c->crossing_capacity,
                            c->crossing_count + 1, sizeof *c->crossings))
        return false;
    c->squares[a].count++;
    c->squares[b].count++;
    c->crossings[c->crossing_count++] = (csg_slice_crossing){.x = s->x + (low & 1 ? s->edge : 0),
                                                             .y = s->y + (low & 2 ? s->edge : 0),
                                                             .length = s->edge,
                                                             .squares = {a, b},
                                                             .tape = s->tape,
                                                             .runs_along_y = !axis,
                                                             .is_low_inside = s->inside[low]};
    return true;
}

/* Cubes a and b, of these levels, share a side or a part of one. */
static bool cross_border(const layer_path *path, uint32_t a, int level_a, uint32_t b, int level_b,
                         int axis)
{
    const csg_slice_cube *first = &path->of->cubes->cubes[a], *second = &path->of->cubes->cubes[b];
    bool splits_a = first->kind == CSG_SLICE_SPLIT, splits_b = second->kind == CSG_SLICE_SPLIT;
    if (first->kind == CSG_SLICE_EMPTY || second->kind == CSG_SLICE_EMPTY)
        return true;
    if (!splits_a && !splits_b)
        return add_crossing(path->of, first->square, second->square, axis);
    for (int half = 0; half < 2; half++) {
        uint32_t child_a = a, child_b = b;
        if (splits_a)
            child_a = child_of(path, first, level_a, axis ? half : 1, axis ? 1 : half);
        if (splits_b)
            child_b = child_of(path, second, level_b, axis ? half : 0, axis ? 0 : half);
        if (!cross_border(path, child_a, level_a + splits_a, child_b, level_b + splits_b, axis))
            return false;
    }
    return true;
}

static bool list_crossings(const layer_path *path, uint32_t index, int level)
{
    const csg_slice_cube *cube = &path->of->cubes->cubes[index];
    bool done = true;
    if (cube->kind != CSG_SLICE_SPLIT)
        return true;
    for (int o = 0; o < CORNERS && done; o++)
        done = list_crossings(path, child_of(path, cube, level, o & 1, o >> 1), level + 1);
    for (int k = 0; k < 2 && done; k++)
        done = cross_border(path, child_of(path, cube, level, 0, k), level + 1,
                            child_of(path, cube, level, 1, k), level + 1, 0) &&
               cross_border(path, child_of(path, cube, level, k, 0), level + 1,
                            child_of(path, cube, level, k, 1), level + 1, 1);
    return done;
}

/* Crossings keep off the ends of their edges by this many steps, so that no two coincide. */
static const double OFF_ENDS = 0.01;

static void place_crossings(csg_slice_contours *c, size_t from, size_t to, float z)
{
    const csg_slice_plan *plan = c->cubes->plan;
    csg_edges *e = c->edges;
    e->count = (uint32_t)(to - from);
    e->end_distance = 0;
    e->has_ends = false;
    for (size_t i = from; i < to; i++) {
        const csg_slice_crossing *p = &c->crossings[i];
        size_t k = i - from;
        bool along_y = p->runs_along_y;
        e->ax[k] = csg_slice_place(plan, 0, p->x);
        e->ay[k] = csg_slice_place(plan, 1, p->y);
        e->az[k] = z;
        e->dx[k] = along_y ? 0 : csg_slice_place(plan, 0, (double)p->x + p->length) - e->ax[k];
        e->dy[k] = along_y ? csg_slice_place(plan, 1, (double)p->y + p->length) - e->ay[k] : 0;
        e->dz[k] = 0;
    }
    plan->kernel->roots(&c->cubes->tapes[c->crossings[from].tape], e, plan->rounding / 32,
                        c->cubes->scratch, c->cubes->scratch_floats);
    for (size_t i = from; i < to; i++) {
        csg_slice_crossing *p = &c->crossings[i];
        size_t k = i - from;
        double off = OFF_ENDS / p->length, t = fmin(fmax((double)e->t[k], off), 1 - off);
        p->at[0] = (double)e->ax[k] + t * (double)e->dx[k];
        p->at[1] = (double)e->ay[k] + t * (double)e->dy[k];
    }
}

/* Each by the smaller square's tape, those beside each other at once. */
static void find_places(csg_slice_contours *c, float z)
{
    for (size_t from = 0, to; from < c->crossing_count; from = to) {
        for (to = from; to < c->crossing_count && to - from < CSG_BLOCK_MOST_EDGES &&
                        c->crossings[to].tape == c->crossings[from].tape;)
            to++;
        place_crossings(c, from, to, z);
    }
}

static bool needs_slope(const csg_slice_contours *c, const csg_slice_crossing *p)
{
    return !c->squares[p->squares[0]].is_smooth || !c->squares[p->squares[1]].is_smooth;
}

static void find_slopes(csg_slice_contours *c, float z)
{
    const csg_slice_plan *plan = c->cubes->plan;
    float x[3][CSG_BATCH], g[3][CSG_BATCH];
    uint32_t which[CSG_BATCH];
    for (size_t i = 0; i < CSG_BATCH; i++)
        x[2][i] = z;
    for (size_t from = 0, to; from < c->crossing_count; from = to) {
        uint32_t tape = c->crossings[from].tape;
        size_t n = 0;
        for (to = from; to < c->crossing_count && n < CSG_BATCH && c->crossings[to].tape == tape;
             to++)
            if (needs_slope(c, &c->crossings[to])) {
                x[0][n] = (float)c->crossings[to].at[0];
                x[1][n] = (float)c->crossings[to].at[1];
                which[n++] = (uint32_t)to;
            }
        for (size_t i = n; i % CSG_LANES; i++)
            x[0][i] = x[0][0], x[1][i] = x[1][0];
        if (n)
            plan->kernel->gradients(&c->cubes->tapes[tape], x[0], x[1], x[2], n, g[0], g[1], g[2],
                                    c->cubes->scratch, c->cubes->scratch_floats);
        for (size_t i = 0; i < n; i++)
            for (int axis = 0; axis < 2; axis++)
                c->crossings[which[i]].slope[axis] = g[axis][i];
    }
}

/* ---- chords ------------------------------------------------------------------------------------
 */

/* How far around the square the crossing is, counter-clockwise, of 4. */
static double around(const csg_slice_plan *plan, const csg_slice_crossing *p, uint32_t square,
                     const csg_slice_square *s)
{
    bool is_behind = p->squares[1] == square; /* so the edge is before the square */
    int axis = p->runs_along_y;
    double from = (double)csg_slice_place(plan, axis, axis ? s->y : s->x);
    double share = (p->at[axis] - from) / (s->edge * plan->step);
    if (p->runs_along_y)
        return is_behind ? 4 - share : 1 + share;
    return is_behind ? share : 3 - share;
}

/* Whether the way around the square leaves the solid there: a chord begins. */
static bool begins(const csg_slice_crossing *p, uint32_t square)
{
    bool is_behind = p->squares[1] == square;
    return p->is_low_inside == (p->runs_along_y ? !is_behind : is_behind);
}

static void link_chord(csg_slice_contours *c, uint32_t from, uint32_t to, uint32_t square)
{
    c->crossings[from].next = to;
    c->crossings[from].via = square;
}

static void sort_around(csg_slice_contours *c, uint32_t square)
{
    const csg_slice_square *s = &c->squares[square];
    uint32_t *list = c->of_squares + s->first;
    for (uint32_t i = 1; i < s->count; i++) {
        uint32_t one = list[i], k = i;
        double at = around(c->cubes->plan, &c->crossings[one], square, s);
        for (; k && around(c->cubes->plan, &c->crossings[list[k - 1]], square, s) > at; k--)
            list[k] = list[k - 1];
        list[k] = one;
    }
}

/* Are all on one side? Then a chord from the last to the first would run over the others. */
static bool are_on_one_side(const csg_slice_contours *c, uint32_t square)
{
    const csg_slice_square *s = &c->squares[square];
    const csg_slice_crossing *first = &c->crossings[c->of_squares[s->first]];
    for (uint32_t i = 1; i < s->count; i++) {
        const csg_slice_crossing *p = &c->crossings[c->of_squares[s->first + i]];
        if (p->runs_along_y != first->runs_along_y ||
            (p->squares[1] == square) != (first->squares[1] == square))
            return false;
    }
    return true;
}

/* More than two: the solid's pieces in the square are one where its middle is inside. */
static bool link_many(const layer_path *path, uint32_t square)
{
    csg_slice_contours *c = path->of;
    const csg_slice_plan *plan = c->cubes->plan;
    const csg_slice_square *s = &c->squares[square];
    const uint32_t *list = c->of_squares + s->first;
    csg_vec3 middle = {(double)csg_slice_place(plan, 0, s->x + 0.5 * s->edge),
                       (double)csg_slice_place(plan, 1, s->y + 0.5 * s->edge), (double)path->z};
    sort_around(c, square);
    bool joins = csg_tape_value_at(plan->kernel, &c->cubes->tapes[s->tape], middle,
                                   c->cubes->scratch, c->cubes->scratch_floats) >= 0;
    if (are_on_one_side(c, square))
        joins = begins(&c->crossings[list[0]], square);
    for (uint32_t i = 0; i < s->count; i++) {
        uint32_t to = list[(i + (joins ? 1 : s->count - 1)) % s->count];
        c->crossings[list[i]].is_pinned = true;
        if (!begins(&c->crossings[list[i]], square))
            continue;
        if (begins(&c->crossings[to], square))
            return false;
        link_chord(c, list[i], to, square);
    }
    return true;
}

static bool is_inside(const csg_slice_plan *plan, const csg_slice_square *s, const double at[2])
{
    double off = OFF_ENDS * plan->step;
    for (int axis = 0; axis < 2; axis++) {
        double from = axis ? s->y : s->x;
        if (!(at[axis] > (double)csg_slice_place(plan, axis, from) + off &&
              at[axis] < (double)csg_slice_place(plan, axis, from + s->edge) - off))
            return false;
    }
    return true;
}

/* The square of this place, if it is as large as s; NULL: it is not. */
static csg_slice_square *square_at(const layer_path *path, const csg_slice_square *s, uint32_t x,
                                   uint32_t y)
{
    csg_slice_contours *c = path->of;
    const csg_slice_cube *cube = c->cubes->cubes;
    uint32_t edge = 1u << c->cubes->plan->levels;
    if (x >= edge || y >= edge)
        return NULL;
    for (int level = 0; cube->kind == CSG_SLICE_SPLIT; level++) {
        edge /= 2;
        cube = &c->cubes->cubes[child_of(path, cube, level, (x & edge) != 0, (y & edge) != 0)];
    }
    bool is_one = cube->kind != CSG_SLICE_EMPTY && edge == s->edge;
    return is_one ? &c->squares[cube->square] : NULL;
}

/* Does the way from a crossing to the corner lead through the inside of the side towards it? */
static bool leads_through(const csg_slice_plan *plan, const csg_slice_square *s, int axis,
                          bool is_above, const csg_slice_crossing *from, const double corner[2])
{
    double side = (double)csg_slice_place(plan, axis,
                                          (double)(axis ? s->y : s->x) + (is_above ? s->edge : 0));
    double share = (side - from->at[axis]) / (corner[axis] - from->at[axis]);
    double across = from->at[!axis] + share * (corner[!axis] - from->at[!axis]);
    double low = (double)csg_slice_place(plan, !axis, axis ? s->x : s->y),
           high = (double)csg_slice_place(plan, !axis, (double)(axis ? s->x : s->y) + s->edge);
    double off = OFF_ENDS * plan->step;
    return share > 0 && share < 1 && across > low + off && across < high - off;
}

/* A tip that reaches through a side: it may have the square behind that side, if nothing else is in
 * it. */
static bool take_square_beside(const layer_path *path, const csg_slice_square *s,
                               const csg_slice_crossing *p, const csg_slice_crossing *q,
                               const double corner[2])
{
    const csg_slice_plan *plan = path->of->cubes->plan;
    for (int side = 0; side < 4; side++) {
        int axis = side & 1;
        bool is_above = side >> 1;
        uint32_t by = is_above ? s->edge : 0u - s->edge;
        csg_slice_square *n = square_at(path, s, s->x + (axis ? 0 : by), s->y + (axis ? by : 0));
        if (n && !n->count && !n->is_taken && is_inside(plan, n, corner) &&
            leads_through(plan, s, axis, is_above, p, corner) &&
            leads_through(plan, s, axis, is_above, q, corner)) {
            n->is_taken = true;
            return true;
        }
    }
    return false;
}

/* Where the tangents of a chord's ends meet, if that is a corner within the square. */
static void find_corner(const layer_path *path, csg_slice_square *s, const csg_slice_crossing *p,
                        const csg_slice_crossing *q)
{
    /* Blunter, it is as good without, and sharper, tangents say little of where they meet. */
    static const double BLUNT = 0.985, SHARP = -0.995;
    double a[2] = {(double)p->slope[0], (double)p->slope[1]};
    double b[2] = {(double)q->slope[0], (double)q->slope[1]};
    double length = sqrt((a[0] * a[0] + a[1] * a[1]) * (b[0] * b[0] + b[1] * b[1]));
    double cosine = (a[0] * b[0] + a[1] * b[1]) / length;
    double sine = a[0] * b[1] - a[1] * b[0];
    if (!(cosine < BLUNT && cosine > SHARP))
        return;
    double at_a = a[0] * p->at[0] + a[1] * p->at[1], at_b = b[0] * q->at[0] + b[1] * q->at[1];
    double corner[2] = {(at_a * b[1] - at_b * a[1]) / sine, (at_b * a[0] - at_a * b[0]) / sine};
    s->has_corner =
        is_inside(path->of->cubes->plan, s, corner) || take_square_beside(path, s, p, q, corner);
    memcpy(s->corner, corner, sizeof corner);
}

static bool link_square(const layer_path *path, uint32_t square)
{
    csg_slice_contours *c = path->of;
    csg_slice_square *s = &c->squares[square];
    const uint32_t *list = c->of_squares + s->first;
    if (s->count % 2)
        return false;
    if (s->count > 2)
        return link_many(path, square);
    if (!s->count)
        return true;
    bool turned = !begins(&c->crossings[list[0]], square);
    uint32_t from = list[turned], to = list[!turned];
    if (!begins(&c->crossings[from], square) || begins(&c->crossings[to], square))
        return false;
    link_chord(c, from, to, square);
    if (!s->is_smooth)
        find_corner(path, s, &c->crossings[from], &c->crossings[to]);
    return true;
}

/* False: out of memory, or a square has crossings that do not alternate. */
static bool link_crossings(const layer_path *path)
{
    csg_slice_contours *c = path->of;
    if (!csg_memory_reserve(c->memory, (void **)&c->of_squares, &c->of_squares_capacity,
                            2 * c->crossing_count, sizeof *c->of_squares))
        return false;
    uint32_t first = 0;
    for (size_t i = 0; i < c->square_count; i++) {
        c->squares[i].first = first;
        first += c->squares[i].count;
        c->squares[i].count = 0;
    }
    for (size_t i = 0; i < c->crossing_count; i++)
        for (int side = 0; side < 2; side++) {
            csg_slice_square *s = &c->squares[c->crossings[i].squares[side]];
            c->of_squares[s->first + s->count++] = (uint32_t)i;
        }
    for (size_t i = 0; i < c->square_count; i++)
        if (!link_square(path, (uint32_t)i)) {
            c->is_open = true;
            return false;
        }
    return true;
}

/* ---- loops -------------------------------------------------------------------------------------
 */

static csg_slice_point point_of(const csg_slice_contours *c, const csg_slice_crossing *p)
{
    const csg_slice_plan *plan = c->cubes->plan;
    int axis = p->runs_along_y;
    uint32_t from = axis ? p->y : p->x;
    double off = OFF_ENDS * plan->step;
    return (csg_slice_point){.x = p->at[0],
                             .y = p->at[1],
                             .low = (double)csg_slice_place(plan, axis, from) + off,
                             .high = (double)csg_slice_place(plan, axis, (double)from + p->length) -
                                     off,
                             .axis = (signed char)axis,
                             .is_pinned = p->is_pinned};
}

static bool add_point(csg_slice_contours *c, size_t *count, const csg_slice_point *point)
{
    if (!csg_memory_reserve(c->memory, (void **)&c->loop, &c->loop_capacity, *count + 1,
                            sizeof *c->loop))
        return false;
    c->loop[(*count)++] = *point;
    return true;
}

static bool gather_loop(csg_slice_contours *c, uint32_t from, size_t *count)
{
    *count = 0;
    for (uint32_t i = from; !c->crossings[i].is_done; i = c->crossings[i].next) {
        csg_slice_crossing *p = &c->crossings[i];
        const csg_slice_square *s = &c->squares[p->via];
        csg_slice_point point = point_of(c, p);
        csg_slice_point corner = {.x = s->corner[0], .y = s->corner[1], .axis = NOTHING};
        p->is_done = true;
        if (!add_point(c, count, &point) || (s->has_corner && !add_point(c, count, &corner)))
            return false;
    }
    return true;
}

static bool put_loops(csg_slice_contours *c, csg_outline *out)
{
    const csg_slice_plan *plan = c->cubes->plan;
    /* What the squares leave of the tolerance: chords stray by a small part of it. */
    double distance = 0.25 * plan->tolerance;
    csg_vec3 center = plan->field->center;
    for (size_t i = 0; i < c->crossing_count; i++) {
        size_t count;
        if (c->crossings[i].is_done)
            continue;
        if (!gather_loop(c, (uint32_t)i, &count))
            return false;
        c->points += count;
        csg_slice_thin(c->loop, count, distance);
        for (size_t k = 0; k < count; k++) {
            csg_vec2 at = {c->loop[k].x + center.x, c->loop[k].y + center.y};
            if (c->loop[k].stays && !csg_outline_add(out, at))
                return false;
        }
        if (!csg_outline_close(out))
            return false;
    }
    return true;
}

static layer_path path_of(csg_slice_contours *c, size_t layer)
{
    const csg_slice_plan *plan = c->cubes->plan;
    layer_path path = {.of = c, .z = (float)plan->z[layer]};
    uint32_t at = 0, edge = 1u << plan->levels;
    for (int level = 0; level < plan->levels; level++) {
        edge /= 2;
        path.upper[level] = !(plan->z[layer] < plan->corner[2] + (at + edge) * plan->step);
        at += path.upper[level] ? edge : 0;
    }
    return path;
}

bool csg_slice_contours_make(csg_slice_contours *c, size_t layer, csg_outline *out)
{
    layer_path path = path_of(c, layer);
    c->square_count = c->crossing_count = 0;
    if (!list_squares(&path, 0, 0, 0, 0))
        return false;
    find_signs(c, path.z);
    if (!list_crossings(&path, 0, 0))
        return false;
    find_places(c, path.z);
    find_slopes(c, path.z);
    return !c->crossing_count || (link_crossings(&path) && put_loops(c, out));
}
