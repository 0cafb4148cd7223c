/* SPDX-License-Identifier: MIT
 * Small triangles in rounds, each of half the size of that before it; see steps.h.
 */
#include "mesh/distance/steps.h"

#include <math.h>

/* Looked at in a piece before it is found to be too intricate: to cut it, so that gradients stray
 * less, is cheaper. In one round, of all pieces. */
enum { MOST_PARTS = 96, MOST_ITEMS = 512, CORNERS = 3, FIRST_PLACES = 2 * CORNERS };

/* A small triangle to be cut, at a corner of a grid over its piece whose lines are as far apart as
 * its sides are long. */
typedef struct part {
    float inside[CORNERS]; /* the value at each corner, turned around on the outer side */
    int16_t i, k, turn;    /* turn: 1 or -1, the way to the other two corners */
    uint16_t side;         /* twice its piece's number, and one more on the outer side */
} part;

typedef struct parts {
    part items[MOST_ITEMS];
    uint32_t count;
} parts;

/* The corners' plane, a step away from it. */
typedef struct frame {
    csg_vec3 origin, first, second;
} frame;

typedef struct settling {
    const csg_kernel *kernel;
    const csg_touching *field;
    double slack;
    float *scratch;
    size_t scratch_floats;
    csg_steps *pieces;
    frame frames[2 * CSG_OCTANTS];               /* of each side */
    uint32_t part_counts[CSG_OCTANTS];           /* of each piece */
    float enough[CSG_OCTANTS], few[CSG_OCTANTS]; /* of a value: more settles a part of this round,
                                                    less no part */
    float at[3][MOST_ITEMS * CORNERS + CSG_LANES], values[MOST_ITEMS * CORNERS + CSG_LANES];
    size_t places;
} settling;

/* A place of the grid. */
static void add_place(settling *s, const part *of, int i, int k, double edge)
{
    const frame *f = &s->frames[of->side];
    double a = i * edge, b = k * edge;
    size_t n = s->places++;
    s->at[0][n] = (float)(f->origin.x + a * f->first.x + b * f->second.x);
    s->at[1][n] = (float)(f->origin.y + a * f->first.y + b * f->second.y);
    s->at[2][n] = (float)(f->origin.z + a * f->first.z + b * f->second.z);
}

/* The middles of its sides, each opposite to a corner. edge: half the length of these. */
static void add_middles(settling *s, const part *of, double edge)
{
    add_place(s, of, 2 * of->i + of->turn, 2 * of->k + of->turn, edge);
    add_place(s, of, 2 * of->i, 2 * of->k + of->turn, edge);
    add_place(s, of, 2 * of->i + of->turn, 2 * of->k, edge);
}

static void ask(settling *s)
{
    for (size_t n = s->places; n % CSG_LANES; n++) /* shapes are asked for copies once */
        for (int axis = 0; axis < 3; axis++)
            s->at[axis][n] = s->at[axis][0];
    csg_touching_values(s->field, s->kernel, s->at[0], s->at[1], s->at[2], s->places, s->values,
                        s->scratch, s->scratch_floats);
}

/* No value, no proof. */
static float inside_of(float value, bool is_outer)
{
    float inside = is_outer ? -value : value;
    return inside == inside ? inside : -INFINITY;
}

static void fail(csg_steps *piece, double excess)
{
    piece->excess = piece->fails && piece->excess > excess ? piece->excess : excess;
    piece->fails = true;
}

/* A small triangle of which nothing is known but its corners. */
static inline void look_at(settling *s, const part *small, parts *next)
{
    uint32_t of = small->side / 2;
    float least = small->inside[0] < small->inside[1] ? small->inside[0] : small->inside[1];
    least = small->inside[2] < least ? small->inside[2] : least;
    if (least > s->enough[of])
        return;
    csg_steps *piece = &s->pieces[of];
    double value = (double)least - s->slack;
    if (!(least > s->few[of]))
        fail(piece, value > 0 ? csg_steps_off(piece, CSG_STEPS_MOST_CUTS) / value : INFINITY);
    else if (next->count == MOST_ITEMS || s->part_counts[of]++ == MOST_PARTS)
        fail(piece, 1);
    else
        next->items[next->count++] = *small;
}

/* The four parts of one, by the values in the middles of its sides. */
static void look_at_quarters(settling *s, const part *whole, const float *values, parts *next)
{
    bool is_outer = whole->side & 1;
    const float *at = whole->inside;
    const float a = inside_of(values[0], is_outer), b = inside_of(values[1], is_outer),
                c = inside_of(values[2], is_outer);
    int16_t t = whole->turn, i = (int16_t)(2 * whole->i), k = (int16_t)(2 * whole->k);
    const part quarters[] = {
        {{at[0], c, b}, i, k, t, whole->side},
        {{c, at[1], a}, (int16_t)(i + t), k, t, whole->side},
        {{b, a, at[2]}, i, (int16_t)(k + t), t, whole->side},
        {{a, b, c}, (int16_t)(i + t), (int16_t)(k + t), (int16_t)-t, whole->side},
    };
    for (int q = 0; q < 4; q++)
        look_at(s, &quarters[q], next);
}

/* Both sides of the pieces, at their corners and in the middles of their sides. */
static void begin(settling *s, size_t count, parts *out)
{
    s->places = out->count = 0;
    for (uint32_t i = 0; i < 2 * count; i++) {
        const csg_steps *piece = &s->pieces[i / 2];
        csg_vec3 step = i % 2 ? csg_vec3_scale(piece->step, -1) : piece->step;
        s->frames[i] =
            (frame){csg_vec3_add(piece->at[0], step), csg_vec3_sub(piece->at[1], piece->at[0]),
                    csg_vec3_sub(piece->at[2], piece->at[0])};
        part *whole = &out->items[out->count++];
        *whole = (part){.turn = 1, .side = (uint16_t)i};
        add_place(s, whole, 0, 0, 1);
        add_place(s, whole, 1, 0, 1);
        add_place(s, whole, 0, 1, 1);
        add_middles(s, whole, 0.5);
    }
    ask(s);
    for (uint32_t i = 0; i < out->count; i++)
        for (uint32_t k = 0; k < CORNERS; k++)
            out->items[i].inside[k] = inside_of(s->values[i * FIRST_PLACES + k], i % 2);
}

/* What values settle parts of so many cuts of their piece's sides. */
static void set_limits(settling *s, size_t count, double cuts)
{
    for (size_t i = 0; i < count; i++) {
        const csg_steps *piece = &s->pieces[i];
        s->enough[i] = (float)((csg_steps_off(piece, cuts) + s->slack) * (1 + 1e-6));
        s->few[i] = (float)(csg_steps_off(piece, CSG_STEPS_MOST_CUTS) + s->slack);
    }
}

/* Asks for the middles of the sides of parts whose pieces do not fail. */
static void go_on(settling *s, parts *now, double edge)
{
    uint32_t left = 0;
    s->places = 0;
    for (uint32_t i = 0; i < now->count; i++) {
        if (s->pieces[now->items[i].side / 2].fails)
            continue;
        now->items[left] = now->items[i];
        add_middles(s, &now->items[left++], edge);
    }
    now->count = left;
    if (left)
        ask(s);
}

void csg_steps_settle(const csg_kernel *kernel, const csg_touching *field, double slack,
                      float *scratch, size_t scratch_floats, csg_steps *pieces, size_t count)
{
    settling s; /* not filled, as lists are not: they are large */
    parts lists[2], *now = &lists[0], *next = &lists[1];
    s.kernel = kernel;
    s.field = field;
    s.slack = slack;
    s.scratch = scratch;
    s.scratch_floats = scratch_floats;
    s.pieces = pieces;
    for (size_t i = 0; i < count; i++) {
        pieces[i].fails = false;
        s.part_counts[i] = 0;
    }
    begin(&s, count, now);
    size_t stride = FIRST_PLACES, first = CORNERS;
    for (double cuts = 2; now->count; cuts *= 2) {
        set_limits(&s, count, cuts);
        next->count = 0;
        for (uint32_t i = 0; i < now->count; i++)
            look_at_quarters(&s, &now->items[i], s.values + i * stride + first, next);
        parts *last = now;
        now = next;
        next = last;
        go_on(&s, now, 0.5 / cuts);
        stride = CORNERS;
        first = 0;
    }
}
