/* SPDX-License-Identifier: MIT
 * Outlines through the adapter of clipper.h: put on a grid of whole numbers, and back.
 *
 * The grid's step is a power of two and its origin one of its points, so what is on it once stays
 * where it is. Operands reach at most 2^30 steps from the origin: below that Clipper needs no
 * arithmetic wider than 64 bits. Clipper takes its memory from the heap, past csg_memory: what it
 * will need at least is measured against the limit beforehand.
 */
#include "shape/plane/polygons.h"

#include "base/elementary.h"
#include "shape/plane/clipper.h"
#include "shape/plane/crossings.h"
#include "shape/plane/offset_loops.h"
#include "shape/plane/simple_loops.h"
#include "shape/plane/twins.h"

enum { MOST_POINTS = 1 << 24, CLIPPER_BYTES_PER_POINT = 400 };

typedef struct grid {
    double step, steps; /* a step's length, and steps a length */
    csg_vec2 origin;
} grid;

typedef struct whole_loops { /* loops on the grid */
    csg_memory *memory;
    csg_clipper_point *points;
    uint32_t *ends;
    size_t point_count, loop_count, point_capacity, loop_capacity;
} whole_loops;

/* ---- the grid ----------------------------------------------------------------------------- */

static bool is_finite(const csg_outline *outline)
{
    for (size_t i = 0; i < outline->point_count; i++) {
        if (!isfinite(outline->points[i].x) || !isfinite(outline->points[i].y))
            return false;
    }
    return true;
}

/* How far the box reaches from zero. */
static double reach_of(csg_box box)
{
    return fmax(fmax(fabs(box.min.x), fabs(box.max.x)), fmax(fabs(box.min.y), fabs(box.max.y)));
}

/* For all that lies within `margin` of the box. False: there is no such grid. */
static bool make_grid(csg_box box, double margin, grid *out)
{
    if (csg_box_is_empty(box)) {
        *out = (grid){.step = 1, .steps = 1};
        return true;
    }
    double half = 0.5 * fmax(box.max.x - box.min.x, box.max.y - box.min.y) + margin;
    half = fmax(half, 0x1p-24 * reach_of(box)); /* a double has no finer steps there */
    half = fmax(half, 1e-200);
    if (!(half < 1e300))
        return false;
    int exponent;
    frexp(half, &exponent); /* half < 2^exponent */
    out->step = ldexp(1, exponent - 29);
    out->steps = ldexp(1, 29 - exponent);
    out->origin.x = nearbyint((0.5 * box.min.x + 0.5 * box.max.x) * out->steps) * out->step;
    out->origin.y = nearbyint((0.5 * box.min.y + 0.5 * box.max.y) * out->steps) * out->step;
    return isfinite(out->origin.x) && isfinite(out->origin.y);
}

static csg_clipper_point to_grid(const grid *g, csg_vec2 p)
{
    return (csg_clipper_point){(int64_t)nearbyint((p.x - g->origin.x) * g->steps),
                               (int64_t)nearbyint((p.y - g->origin.y) * g->steps)};
}

static csg_vec2 from_grid(const grid *g, csg_clipper_point p)
{
    return (csg_vec2){g->origin.x + (double)p.x * g->step, g->origin.y + (double)p.y * g->step};
}

/* ---- loops on the grid -------------------------------------------------------------------- */

static void whole_release(whole_loops *loops)
{
    csg_memory_release(loops->memory, loops->points, loops->point_capacity * sizeof *loops->points);
    csg_memory_release(loops->memory, loops->ends, loops->loop_capacity * sizeof *loops->ends);
}

static bool whole_reserve(whole_loops *loops, size_t points, size_t loop_count)
{
    void *data = loops->points, *ends = loops->ends;
    bool is_room =
        points <= MOST_POINTS && csg_memory_reserve(loops->memory, &data, &loops->point_capacity,
                                                    points, sizeof *loops->points);
    loops->points = data;
    is_room = is_room && csg_memory_reserve(loops->memory, &ends, &loops->loop_capacity, loop_count,
                                            sizeof *loops->ends);
    loops->ends = ends;
    return is_room;
}

static bool whole_append(whole_loops *loops, const grid *g, const csg_outline *outline)
{
    size_t closed = csg_outline_first(outline, outline->loop_count);
    if (!whole_reserve(loops, loops->point_count + closed, loops->loop_count + outline->loop_count))
        return false;
    for (size_t loop = 0; loop < outline->loop_count; loop++)
        loops->ends[loops->loop_count + loop] =
            (uint32_t)(loops->point_count + outline->ends[loop]);
    for (size_t i = 0; i < closed; i++)
        loops->points[loops->point_count + i] = to_grid(g, outline->points[i]);
    loops->point_count += closed;
    loops->loop_count += outline->loop_count;
    return true;
}

static bool whole_append_whole(whole_loops *loops, const whole_loops *more)
{
    size_t before = loops->point_count;
    if (!whole_reserve(loops, before + more->point_count, loops->loop_count + more->loop_count))
        return false;
    for (size_t i = 0; i < more->point_count; i++)
        loops->points[loops->point_count++] = more->points[i];
    for (size_t loop = 0; loop < more->loop_count; loop++)
        loops->ends[loops->loop_count++] = (uint32_t)before + more->ends[loop];
    return true;
}

static csg_clipper_loops whole_view(const whole_loops *loops)
{
    return (csg_clipper_loops){loops->points, loops->ends, loops->loop_count};
}

typedef struct result {
    const grid *grid;
    csg_outline *outline;
    bool turned; /* points come a quarter turn later */
} result;

static bool take_simple(void *user, const csg_clipper_point *points, size_t count)
{
    const result *r = user;
    for (size_t i = 0; i < count; i++) {
        csg_clipper_point p = points[i];
        if (r->turned)
            p = (csg_clipper_point){p.y, -p.x};
        if (!csg_outline_add(r->outline, from_grid(r->grid, p)))
            return false;
    }
    return csg_outline_close(r->outline);
}

static bool take_loop(void *user, const csg_clipper_point *points, size_t count)
{
    const result *r = user;
    return csg_simple_loops(r->outline->memory, points, count, take_simple, user);
}

/* Whether the limit leaves room for what Clipper makes of so many points. */
static bool has_room(csg_memory *memory, double points)
{
    double bytes = points * CLIPPER_BYTES_PER_POINT + (double)atomic_load(&memory->used_bytes);
    return points <= MOST_POINTS && (!memory->limit_bytes || bytes <= (double)memory->limit_bytes);
}

static csgm_status settle(csgm_status status, csg_outline *out)
{
    if (status)
        csg_outline_release(out);
    return status;
}

/* ---- set operations ----------------------------------------------------------------------- */

static void turn_quarter(whole_loops *loops)
{
    for (size_t i = 0; i < loops->point_count; i++)
        loops->points[i] = (csg_clipper_point){-loops->points[i].y, loops->points[i].x};
}

/* Whether Clipper would be done soon; it cannot be stopped. All the loops, in one list. */
static csgm_status check_work(const whole_loops *loops, csg_fill fill, bool *turned)
{
    csg_clipper_loops view = whole_view(loops);
    csgm_status status = csg_beams_check(loops->memory, &view, turned);
    return status ? status : csg_crossings_check(loops->memory, &view, fill);
}

static csgm_status check_both(const whole_loops *a, const whole_loops *b, csg_fill fill,
                              bool *turned)
{
    whole_loops both = {.memory = a->memory};
    csgm_status status = CSGM_ERR_MEMORY;
    if (!b->loop_count)
        return check_work(a, fill, turned);
    if (whole_append_whole(&both, a) && whole_append_whole(&both, b))
        status = check_work(&both, fill, turned);
    whole_release(&both);
    return status;
}

/* May turn the operands. */
static csgm_status combine(csg_polygons_op op, csg_fill fill, const grid *g, whole_loops *a,
                           whole_loops *b, csg_outline *out)
{
    result r = {.grid = g, .outline = out};
    if (!has_room(out->memory, (double)(a->point_count + b->point_count)))
        return CSGM_ERR_MEMORY;
    csgm_status status = check_both(a, b, fill, &r.turned);
    if (status)
        return status;
    if (r.turned) {
        turn_quarter(a);
        turn_quarter(b);
    }
    csg_clipper_loops left = whole_view(a), right = whole_view(b);
    return settle(csg_clipper_combine(op, fill, &left, &right, take_loop, &r), out);
}

static bool drop_twins(whole_loops *loops)
{
    if (!csg_twins_drop(loops->memory, loops->points, loops->ends, &loops->loop_count))
        return false;
    loops->point_count = loops->loop_count ? loops->ends[loops->loop_count - 1] : 0;
    return true;
}

static csgm_status combine_loops(csg_polygons_op op, csg_fill fill, const csg_outline *a,
                                 const csg_outline *b, csg_outline *out)
{
    whole_loops left = {.memory = a->memory}, right = {.memory = a->memory};
    grid g;
    csg_outline_init(out, a->memory);
    if (!is_finite(a) || !is_finite(b) ||
        !make_grid(csg_box_hull(csg_outline_box(a), csg_outline_box(b)), 0, &g))
        return CSGM_ERR_SCENE;
    csgm_status status = CSGM_ERR_MEMORY;
    if (whole_append(&left, &g, a) && whole_append(&right, &g, b) &&
        (fill == CSG_FILL_NONZERO || drop_twins(&left)))
        status = combine(op, fill, &g, &left, &right, out);
    whole_release(&left);
    whole_release(&right);
    return status;
}

csgm_status csg_polygons_clean(const csg_outline *in, csg_fill fill, csg_outline *out)
{
    csg_outline none;
    csg_outline_init(&none, in->memory);
    return combine_loops(CSG_POLYGONS_UNION, fill, in, &none, out);
}

csgm_status csg_polygons_check(const csg_outline *in)
{
    whole_loops loops = {.memory = in->memory};
    grid g;
    if (!is_finite(in) || !make_grid(csg_outline_box(in), 0, &g))
        return CSGM_ERR_SCENE;
    csgm_status status = CSGM_ERR_MEMORY;
    if (whole_append(&loops, &g, in)) {
        csg_clipper_loops view = whole_view(&loops);
        status = csg_crossings_check(loops.memory, &view, CSG_FILL_EVEN_ODD);
    }
    whole_release(&loops);
    return status;
}

csgm_status csg_polygons_combine(csg_polygons_op op, const csg_outline *a, const csg_outline *b,
                                 csg_outline *out)
{
    return combine_loops(op, CSG_FILL_NONZERO, a, b, out);
}

/* ---- offset ------------------------------------------------------------------------------- */

/* Points that the corners will have: an arc each, as far as the outline turns there. */
static double offset_points(const csg_outline *outline, double sagitta)
{
    double count = 0, step = 2 * csg_acos(1 - fmin(sagitta, 1));
    for (size_t loop = 0; loop < outline->loop_count; loop++) {
        size_t first = csg_outline_first(outline, loop), end = outline->ends[loop];
        for (size_t i = first; i < end; i++) {
            csg_vec2 a = outline->points[i > first ? i - 1 : end - 1], b = outline->points[i],
                     c = outline->points[i + 1 < end ? i + 1 : first];
            double ux = b.x - a.x, uy = b.y - a.y, vx = c.x - b.x, vy = c.y - b.y;
            count += 2 + fabs(csg_atan2(ux * vy - uy * vx, ux * vx + uy * vy)) / step;
        }
    }
    return count;
}

static bool add_raw(void *user, double x, double y)
{
    whole_loops *loops = user;
    const double most = 0x1p31 - 2;
    if (!whole_reserve(loops, loops->point_count + 1, loops->loop_count))
        return false;
    loops->points[loops->point_count++] = (csg_clipper_point){(int64_t)fmin(fmax(x, -most), most),
                                                              (int64_t)fmin(fmax(y, -most), most)};
    return true;
}

/* There is room for it: as many loops as before. */
static void close_raw(void *user)
{
    whole_loops *loops = user;
    loops->ends[loops->loop_count++] = (uint32_t)loops->point_count;
}

/* Points that became one on the grid. */
static void drop_repeats(whole_loops *loops)
{
    size_t at = 0, first = 0;
    for (size_t loop = 0; loop < loops->loop_count; loop++) {
        size_t end = loops->ends[loop];
        csg_clipper_point begin = loops->points[first];
        for (size_t i = first; i < end; i++) {
            csg_clipper_point p = loops->points[i],
                              next = i + 1 < end ? loops->points[i + 1] : begin;
            if (p.x != next.x || p.y != next.y)
                loops->points[at++] = p;
        }
        first = end;
        loops->ends[loop] = (uint32_t)at;
    }
    loops->point_count = at;
}

static csgm_status check_offset(const whole_loops *loops, double by, csg_corner corner,
                                double sagitta)
{
    whole_loops raw = {.memory = loops->memory};
    csg_clipper_loops view = whole_view(loops);
    csg_offset_sink sink = {add_raw, close_raw, &raw};
    csgm_status status = CSGM_ERR_MEMORY;
    bool turned;
    if (whole_reserve(&raw, loops->point_count, loops->loop_count) &&
        csg_offset_loops(&view, by, corner, 2 * csg_acos(1 - fmin(sagitta, 1)), sink))
        status = check_work(&raw, CSG_FILL_NONZERO, &turned);
    whole_release(&raw);
    return status;
}

static csgm_status offset_whole(const whole_loops *loops, double by, csg_corner corner,
                                double sagitta, result *r)
{
    csgm_status status = check_offset(loops, by * r->grid->steps, corner, sagitta);
    if (status)
        return status;
    csg_clipper_loops view = whole_view(loops);
    return settle(csg_clipper_offset(&view, by * r->grid->steps, corner,
                                     sagitta * fabs(by) * r->grid->steps, take_loop, r),
                  r->outline);
}

static csgm_status offset_clean(const csg_outline *clean, double by, csg_corner corner,
                                double tolerance, csg_outline *out)
{
    double sagitta = fmax(tolerance / fabs(by), 1e-6);
    whole_loops loops = {.memory = clean->memory};
    grid g;
    result r = {.grid = &g, .outline = out};
    if (!make_grid(csg_outline_box(clean), fabs(by), &g))
        return CSGM_ERR_SCENE;
    csgm_status status = CSGM_ERR_MEMORY;
    if (has_room(clean->memory, corner == CSG_CORNER_ROUND ? offset_points(clean, sagitta)
                                                           : 3 * (double)clean->point_count) &&
        whole_append(&loops, &g, clean)) {
        drop_repeats(&loops);
        status = offset_whole(&loops, by, corner, sagitta, &r);
    }
    whole_release(&loops);
    return status;
}

csgm_status csg_polygons_offset(const csg_outline *in, double by, csg_corner corner,
                                double tolerance, csg_outline *out)
{
    csg_outline clean;
    csg_outline_init(out, in->memory);
    if (!isfinite(by))
        return CSGM_ERR_SCENE;
    csgm_status status = csg_polygons_clean(in, CSG_FILL_NONZERO, &clean);
    if (status)
        return status;
    if (by == 0) {
        *out = clean;
        return CSGM_OK;
    }
    status = offset_clean(&clean, by, corner, tolerance, out);
    csg_outline_release(&clean);
    return status;
}

/* ---- Minkowski sum ------------------------------------------------------------------------ */

static csg_clipper_point sum(csg_clipper_point a, csg_clipper_point b)
{
    return (csg_clipper_point){a.x + b.x, a.y + b.y};
}

/* The convex loop swept along a segment: each of its edges moves to that end of the segment that
 * lies farther outwards of it; where that end changes, the segment itself is an edge. */
static void sweep_along(whole_loops *out, const whole_loops *convex, csg_clipper_point from,
                        csg_clipper_point to)
{
    size_t count = convex->point_count;
    int64_t dx = to.x - from.x, dy = to.y - from.y;
    csg_clipper_point before = from;
    for (size_t k = 0; k <= count; k++) { /* edge k runs from corner k; the last one first */
        size_t j = k ? k - 1 : count - 1;
        csg_clipper_point p = convex->points[j], q = convex->points[j + 1 < count ? j + 1 : 0];
        bool is_far = dx * (q.y - p.y) - dy * (q.x - p.x) > 0;
        csg_clipper_point end = is_far ? to : from;
        if (k && (end.x != before.x || end.y != before.y))
            out->points[out->point_count++] = sum(p, before);
        if (k)
            out->points[out->point_count++] = sum(p, end);
        before = end;
    }
    out->ends[out->loop_count++] = (uint32_t)out->point_count;
}

/* The sum is `a` moved by one point of the convex loop, and that loop swept along a's edges. */
static bool sweep_all(whole_loops *out, const whole_loops *a, const whole_loops *convex)
{
    size_t points = a->point_count * (convex->point_count + 3);
    if (!whole_reserve(out, points, a->point_count + a->loop_count))
        return false;
    for (size_t loop = 0, i = 0; loop < a->loop_count; loop++) {
        for (; i < a->ends[loop]; i++)
            out->points[out->point_count++] = sum(a->points[i], convex->points[0]);
        out->ends[out->loop_count++] = (uint32_t)out->point_count;
    }
    for (size_t loop = 0, first = 0; loop < a->loop_count; first = a->ends[loop++]) {
        for (size_t i = first, end = a->ends[loop]; i < end; i++)
            sweep_along(out, convex, a->points[i], a->points[i + 1 < end ? i + 1 : first]);
    }
    return true;
}

/* The hull of the outline's points as vectors in steps of the grid: strictly convex after the
 * rounding too, which sweep_along needs. */
static csgm_status convex_steps(const csg_outline *outline, const grid *g, csg_outline *out)
{
    const csg_affine to_steps = csg_affine_scale(csg_vec3_make(g->steps, g->steps, 1));
    csg_outline rounded;
    csg_outline_init(out, outline->memory);
    csg_outline_init(&rounded, outline->memory);
    if (!csg_outline_append(&rounded, outline)) {
        csg_outline_release(&rounded);
        return CSGM_ERR_MEMORY;
    }
    csg_outline_transform(&rounded, &to_steps);
    for (size_t i = 0; i < rounded.point_count; i++) {
        rounded.points[i].x = nearbyint(rounded.points[i].x);
        rounded.points[i].y = nearbyint(rounded.points[i].y);
    }
    csgm_status status = csg_polygons_hull(&rounded, out);
    csg_outline_release(&rounded);
    return status;
}

/* What is thinner than the grid adds nothing but `a` at one of its points. */
static bool append_convex(whole_loops *loops, const csg_outline *steps, csg_vec2 otherwise,
                          const grid *about_zero)
{
    static const grid unit = {.step = 1, .steps = 1};
    if (steps->loop_count)
        return whole_append(loops, &unit, steps);
    if (!whole_reserve(loops, 1, 1))
        return false;
    loops->points[loops->point_count++] = to_grid(about_zero, otherwise);
    loops->ends[loops->loop_count++] = 1;
    return true;
}

static csgm_status sum_on_grid(const csg_outline *a, const csg_outline *b, const grid *g,
                               csg_outline *out)
{
    whole_loops left = {.memory = a->memory}, right = left, swept = left, none = left;
    const grid about_zero = {.step = g->step, .steps = g->steps};
    csg_outline convex;
    csgm_status status = convex_steps(b, g, &convex);
    if (status)
        return status;
    status = CSGM_ERR_MEMORY;
    if (whole_append(&left, g, a) && append_convex(&right, &convex, b->points[0], &about_zero) &&
        sweep_all(&swept, &left, &right))
        status = combine(CSG_POLYGONS_UNION, CSG_FILL_NONZERO, g, &swept, &none, out);
    whole_release(&left);
    whole_release(&right);
    whole_release(&swept);
    csg_outline_release(&convex);
    return status;
}

csgm_status csg_polygons_minkowski(const csg_outline *a, const csg_outline *b, csg_outline *out)
{
    grid g;
    csg_outline_init(out, a->memory);
    if (!is_finite(a) || !is_finite(b))
        return CSGM_ERR_SCENE;
    if (!a->loop_count || !b->loop_count)
        return CSGM_OK;
    if (!make_grid(csg_outline_box(a), reach_of(csg_outline_box(b)), &g))
        return CSGM_ERR_SCENE;
    return sum_on_grid(a, b, &g, out);
}
