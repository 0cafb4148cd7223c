/* SPDX-License-Identifier: MIT
 * Points, steps and signs; see hunt.h.
 */
#include "mesh/adaptive/hunt.h"

#include <math.h>

#include "field/cones/cone.h"

enum {
    E = CSG_BRICK_EDGE,
    HALVES = 2 * E + 1, /* points along an edge, those of the brick included */
    POINTS = HALVES * HALVES * HALVES,
    PADDED = (POINTS + CSG_LANES - 1) / CSG_LANES * CSG_LANES
};

/* A step goes further than to where a field of constant slope would be 0, so that its end lies
 * beyond the surface and not on it: by a part of the tolerance, so as not to jump over what is
 * thin; and from where that was too short, since the slope is another one, by a part of the way. */
static const double BEYOND_SURFACE = 0.5;
static const float BEYOND_WAY = 1.25f;

/* Of the tolerance: how deep a place must lie in what was missed. */
static const double DEPTH = 0.05, CREASE_DEPTH = 0.6;

/* Towards a place of the surface, at most. */
enum { STEPS = 24 };

/* Points half way between, then those of them that are near the surface. */
typedef struct hunt {
    int count;
    float line[3][HALVES];
    float x[PADDED], y[PADDED], z[PADDED], f[PADDED], g[3][PADDED];
    float from[3][PADDED], before[PADDED]; /* where a step began, and the value there */
    float band;    /* beyond it only signs are exact: no step begins there */
    float least;   /* a value that is nearer to 0 shows nothing */
    uint8_t cells; /* that are searched */
} hunt;

/* What the cone of the gradients says of a brick. */
typedef enum brick_kind {
    ONE_SHEET,
    ONE_CREASE, /* sheets that are all climbed in one direction: only their edges can lie between */
    ANYTHING
} brick_kind;

static brick_kind kind_of(const csg_bricks *b, const csg_brick *brick)
{
    csg_tape tape = csg_bricks_short_tape(b, brick);
    csg_cone cone;
    float c[3];
    double half = 0.5 * E * csg_bricks_cell(b, brick->level) * b->lattice->cell_size;
    for (int axis = 0; axis < 3; axis++)
        c[axis] = 0.5f * (csg_brick_coordinate(b, brick, axis, 0) +
                          csg_brick_coordinate(b, brick, axis, E));
    if (!csg_cone_find(NULL, &tape, c, sqrt(3.0) * half * (1 + 1e-6), &cone))
        return ANYTHING;
    return cone.is_crease ? ONE_CREASE : ONE_SHEET;
}

static void place_lines(hunt *h, const csg_bricks *b, const csg_brick *brick)
{
    for (int axis = 0; axis < 3; axis++)
        for (uint32_t i = 0; i < HALVES; i++) {
            float at = csg_brick_coordinate(b, brick, axis, i / 2);
            h->line[axis][i] =
                i % 2 ? 0.5f * (at + csg_brick_coordinate(b, brick, axis, i / 2 + 1)) : at;
        }
}

static void place_point(hunt *h, int i, int point)
{
    h->x[i] = h->line[0][point % HALVES];
    h->y[i] = h->line[1][point / HALVES % HALVES];
    h->z[i] = h->line[2][point / (HALVES * HALVES)];
}

/* The place of a point half way between among the brick's own; -1: it is none of them. */
static int own_point(int point)
{
    const int half[3] = {point % HALVES, point / HALVES % HALVES, point / (HALVES * HALVES)};
    if (half[0] % 2 || half[1] % 2 || half[2] % 2)
        return -1;
    return half[0] / 2 + (E + 1) * (half[1] / 2 + (E + 1) * (half[2] / 2));
}

/* The cells that a point half way between is in. */
static uint8_t cells_of(int point)
{
    const int half[3] = {point % HALVES, point / HALVES % HALVES, point / (HALVES * HALVES)};
    return csg_brick_cells_at(half, half);
}

static void fill_lanes(hunt *h)
{
    for (int i = h->count; i % CSG_LANES; i++)
        h->x[i] = h->x[0], h->y[i] = h->y[0], h->z[i] = h->z[0];
}

static void ask(csg_sheet_probe *p, hunt *h)
{
    fill_lanes(h);
    p->kernel->values(p->tape, h->x, h->y, h->z, (size_t)h->count, h->f, p->scratch,
                      p->scratch_floats);
    p->evaluations += (uint64_t)h->count;
}

/* Values at the points of the cells searched: at the brick's own they are known. */
static void ask_between(csg_sheet_probe *p, hunt *h, const float *own)
{
    h->count = 0;
    for (int point = 0; point < POINTS; point++)
        if (own_point(point) < 0 && cells_of(point) & h->cells)
            place_point(h, h->count++, point);
    ask(p, h);
    for (int point = POINTS - 1, from = h->count; point >= 0; point--)
        h->f[point] = !(cells_of(point) & h->cells) ? INFINITY
                      : own_point(point) < 0        ? h->f[--from]
                                                    : own[own_point(point)];
    h->count = POINTS;
}

/* Keeps the points whose cube, half a cell wide, the surface may come into: there is none in the
 * cubes of the others. */
static void keep_near(hunt *h, const csg_bricks *b, const csg_brick *brick)
{
    double cell = csg_bricks_cell(b, brick->level) * b->lattice->cell_size;
    float reach =
        (float)(0.25 * sqrt(3.0) * (1 + 0x1p-10) * cell * (double)b->field->tape.lipschitz);
    h->count = 0;
    for (int point = 0; point < POINTS; point++) {
        if (!(fabsf(h->f[point]) < reach) || !(cells_of(point) & h->cells))
            continue;
        place_point(h, h->count, point);
        h->f[h->count++] = h->f[point];
    }
}

/* The sign of the brick's own point. */
static bool own_sign(const csg_brick *brick, const int half[3])
{
    return brick->inside[half[2] / 2][half[1] / 2] >> (half[0] / 2) & 1;
}

/* Whether a point between the brick's own has another sign than all corners of the edge, face or
 * cell that it is the middle of. */
static bool differs(const csg_brick *brick, const int half[3], bool sign)
{
    for (int c = 0; c < 8; c++) {
        int corner[3];
        for (int axis = 0; axis < 3; axis++)
            corner[axis] = half[axis] + (half[axis] % 2 ? (c >> axis & 1 ? 1 : -1) : 0);
        if (own_sign(brick, corner) == sign)
            return false;
    }
    unsigned from[3], to[3]; /* a pierced edge shows it */
    for (int axis = 0; axis < 3; axis++) {
        from[axis] = (unsigned)half[axis] / 2;
        to[axis] = from[axis] + (unsigned)half[axis] % 2;
    }
    return !csg_brick_is_pierced(brick, from, to);
}

static uint8_t differs_between(const hunt *h, const csg_brick *brick)
{
    unsigned cells = 0;
    for (int p = 0; p < POINTS; p++) {
        const int half[3] = {p % HALVES, p / HALVES % HALVES, p / (HALVES * HALVES)};
        bool is_asked = own_point(p) < 0 && cells_of(p) & h->cells;
        if (is_asked && fabsf(h->f[p]) > h->least && differs(brick, half, h->f[p] >= 0))
            cells |= cells_of(p);
    }
    return (uint8_t)(cells & h->cells);
}

/* Moves every point across the surface that it is near, as far as that lies in the brick: `way`
 * times as far as that is, and `beyond` further. */
static void step_across(hunt *h, float way, float beyond)
{
    for (int i = 0; i < h->count; i++) {
        float square = h->g[0][i] * h->g[0][i] + h->g[1][i] * h->g[1][i] + h->g[2][i] * h->g[2][i];
        bool known = square > 1e-12f && fabsf(h->f[i]) <= h->band;
        float further = h->f[i] < 0 ? -beyond * sqrtf(square) : beyond * sqrtf(square);
        float step = known ? -(way * h->f[i] + further) / square : 0;
        float *at[3] = {&h->x[i], &h->y[i], &h->z[i]};
        h->before[i] = h->f[i];
        for (int axis = 0; axis < 3; axis++) {
            float to = *at[axis] + step * h->g[axis][i];
            h->from[axis][i] = *at[axis];
            to = to > h->line[axis][0] ? to : h->line[axis][0];
            *at[axis] = to < h->line[axis][HALVES - 1] ? to : h->line[axis][HALVES - 1];
        }
    }
}

/* The cell that a point lies in. */
static void cell_of(const hunt *h, int i, unsigned cell[3])
{
    const float at[3] = {h->x[i], h->y[i], h->z[i]};
    for (int axis = 0; axis < 3; axis++) {
        cell[axis] = 0;
        while (cell[axis] + 1 < E && at[axis] > h->line[axis][2 * (cell[axis] + 1)])
            cell[axis]++;
    }
}

/* Whether a point has the other sign than all corners of its cell. */
static bool differs_in_cell(const hunt *h, const csg_brick *brick, int i)
{
    unsigned cell[3];
    cell_of(h, i, cell);
    const unsigned end[3] = {cell[0] + 1, cell[1] + 1, cell[2] + 1};
    return fabsf(h->f[i]) > h->least &&
           csg_brick_pattern(brick, cell[0], cell[1], cell[2]) == (h->f[i] >= 0 ? 0u : 0xFFu) &&
           !csg_brick_is_pierced(brick, cell, end);
}

/* Steps that crossed the surface: points with values of different signs. */
typedef struct crossings {
    int count;
    float from[3][PADDED], to[3][PADDED], before[PADDED], after[PADDED];
} crossings;

/* Beyond the band only signs are the same for a tape and a shorter one. */
static float within_band(const hunt *h, float f)
{
    return f > h->band ? h->band : f < -h->band ? -h->band : f;
}

/* Takes the steps that crossed the surface; the others are where they began again. */
static void take_crossings(hunt *h, crossings *c)
{
    float *at[3] = {h->x, h->y, h->z};
    int kept = 0;
    for (int i = 0; i < h->count; i++) {
        bool crossed = (h->before[i] >= 0) != (h->f[i] >= 0);
        for (int axis = 0; axis < 3; axis++) {
            if (crossed) {
                c->from[axis][c->count] = h->from[axis][i];
                c->to[axis][c->count] = at[axis][i];
            } else {
                at[axis][kept] = h->from[axis][i];
                h->g[axis][kept] = h->g[axis][i];
            }
        }
        if (crossed) {
            c->before[c->count] = h->before[i];
            c->after[c->count++] = within_band(h, h->f[i]);
        } else {
            h->f[kept++] = h->before[i];
        }
    }
    h->count = kept;
}

static double distance_between(const float a[3], const float b[3])
{
    return csg_vec3_norm(csg_vec3_sub(csg_vec3_from_floats(a), csg_vec3_from_floats(b)));
}

/* Whether the surface, between both ends of a crossing, is no farther than `near` from a place
 * between them: by the lesser slope of both parts, since that of the whole field may be steeper by
 * far; or since all of the way is so short. */
static bool is_near_enough(const crossings *c, int i, const float at[3], double f, double near)
{
    const float from[3] = {c->from[0][i], c->from[1][i], c->from[2][i]};
    const float to[3] = {c->to[0][i], c->to[1][i], c->to[2][i]};
    double before = fabs((double)c->before[i] - f) / fmax(distance_between(from, at), 1e-30);
    double after = fabs((double)c->after[i] - f) / fmax(distance_between(at, to), 1e-30);
    return fabs(f) <= near * fmin(before, after) || distance_between(from, to) <= near;
}

/* One step closer for each crossing: by the secant, or, every other time, by halves, since the
 * field has kinks. Those that are near enough to the surface are put into `out`, the others stay.
 */
static void come_closer(csg_sheet_probe *p, hunt *h, crossings *c, bool halve, double near,
                        csg_hunted *out)
{
    int kept = 0, n = c->count, padded = (n + CSG_LANES - 1) / CSG_LANES * CSG_LANES;
    float *at[3] = {h->x, h->y, h->z};
    for (int i = 0; i < padded; i++) {
        int k = i < n ? i : 0;
        float t = halve ? 0.5f : c->before[k] / (c->before[k] - c->after[k]);
        for (int axis = 0; axis < 3; axis++)
            at[axis][i] = c->from[axis][k] + t * (c->to[axis][k] - c->from[axis][k]);
    }
    p->kernel->values(p->tape, h->x, h->y, h->z, (size_t)n, h->f, p->scratch, p->scratch_floats);
    p->evaluations += (uint64_t)n;
    for (int i = 0; i < n; i++) {
        h->f[i] = within_band(h, h->f[i]);
        const float place[3] = {h->x[i], h->y[i], h->z[i]};
        if (is_near_enough(c, i, place, (double)h->f[i], near)) {
            unsigned cell[3];
            cell_of(h, i, cell);
            out->at[out->count] = csg_vec3_make((double)h->x[i], (double)h->y[i], (double)h->z[i]);
            out->cell[out->count++] = (uint8_t)csg_brick_cell(cell[0], cell[1], cell[2]);
            continue;
        }
        bool first = (h->f[i] >= 0) == (c->before[i] >= 0);
        float before = first ? h->f[i] : c->before[i], after = first ? c->after[i] : h->f[i];
        for (int axis = 0; axis < 3; axis++) {
            float from = c->from[axis][i], to = c->to[axis][i];
            c->from[axis][kept] = first ? at[axis][i] : from;
            c->to[axis][kept] = first ? to : at[axis][i];
        }
        c->before[kept] = before;
        c->after[kept++] = after;
    }
    c->count = kept;
}

/* Where steps end in what their cells do not show. */
static uint8_t differs_at_ends(const hunt *h, const csg_brick *brick)
{
    unsigned cells = 0;
    for (int i = 0; i < h->count; i++)
        if (differs_in_cell(h, brick, i)) {
            unsigned cell[3];
            cell_of(h, i, cell);
            cells |= 1u << csg_brick_cell(cell[0], cell[1], cell[2]);
        }
    return (uint8_t)(cells & h->cells);
}

/* The same of all steps across the surface; `c`: those that crossed it. */
static uint8_t differs_across(csg_sheet_probe *p, hunt *h, const csg_brick *brick, double tolerance,
                              crossings *c)
{
    uint8_t cells = 0;
    fill_lanes(h);
    p->kernel->gradients(p->tape, h->x, h->y, h->z, (size_t)h->count, h->g[0], h->g[1], h->g[2],
                         p->scratch, p->scratch_floats);
    for (int again = 0; again < 2 && h->count; again++) {
        step_across(h, again ? BEYOND_WAY : 1, again ? 0 : (float)(BEYOND_SURFACE * tolerance));
        ask(p, h);
        cells |= differs_at_ends(h, brick);
        take_crossings(h, c);
    }
    return cells;
}

uint8_t csg_hunt(csg_sheet_probe *p, const csg_bricks *b, const csg_brick *brick, double tolerance,
                 const float *f, uint8_t cells, csg_hunted *out)
{
    hunt h;
    crossings c;
    out->count = c.count = 0;
    h.cells = cells;
    brick_kind kind = kind_of(b, brick);
    if (kind == ONE_SHEET)
        return 0;
    h.least = (float)((kind == ONE_CREASE ? CREASE_DEPTH : DEPTH) * tolerance *
                      (double)b->field->tape.lipschitz);
    h.band = csg_bricks_band(b, brick->level);
    place_lines(&h, b, brick);
    ask_between(p, &h, f);
    h.cells &= (uint8_t)~differs_between(&h, brick);
    keep_near(&h, b, brick);
    if (h.count)
        h.cells &= (uint8_t)~differs_across(p, &h, brick, tolerance, &c);
    if (kind == ANYTHING && h.cells)
        h.cells &= (uint8_t)~csg_hunt_leaves(p, b, brick, tolerance, h.cells, out);
    for (int step = 0; step < STEPS && c.count && h.cells; step++)
        come_closer(p, &h, &c, step % 2 == 1, DEPTH * tolerance, out);
    return (uint8_t)(cells & ~h.cells);
}
