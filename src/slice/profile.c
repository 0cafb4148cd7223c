/* SPDX-License-Identifier: MIT
 * Profiles; see profile.h.
 */
#include "slice/profile.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "base/pool.h"
#include "field/cones/cone.h"
#include "field/point.h"

enum {
    STRETCHES = 4, /* in the lowest layer */
    MOST_STRETCHES = 1 << 22,
    ASK_EVERY = 256,   /* cubes, whether to stop */
    CUBES_ACROSS = 512 /* of the smallest, along the longest side, at most */
};

/* What is known of |n_z| to this share of it is known well enough, of a piece that is no higher
 * than a lowest layer or this share of the longest side. */
static const double NARROW = 0.1, LOW = 1.0 / 256;

typedef struct job {
    csg_slice_profile *profile;
    csg_measure_walk walk;
    double lowest, enough; /* |n_z| between which it matters */
    double center_z, least, low;
    int last_level;
    atomic_bool out_of_memory;
} job;

/* ---- stretches ---------------------------------------------------------------------------------
 */

static float float_of(unsigned bits)
{
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

double csg_slice_profile_at(const csg_slice_profile *p, size_t index)
{
    return (double)float_of(atomic_load_explicit(&p->most[index], memory_order_relaxed));
}

/* Bits of floats that are not negative are ordered as these are. */
static void raise_to(atomic_uint *at, float value)
{
    unsigned bits, now = atomic_load_explicit(at, memory_order_relaxed);
    memcpy(&bits, &value, sizeof bits);
    while (bits > now && !atomic_compare_exchange_weak_explicit(
                             at, &now, bits, memory_order_relaxed, memory_order_relaxed))
        ;
}

static size_t stretch_of(const csg_slice_profile *p, double z)
{
    return (size_t)fmin(fmax(floor((z - p->bottom) / p->step), 0), (double)(p->count - 1));
}

/* From z to z in the field's frame, and as far as rounding may be off. */
static void put_level(job *j, double from, double to, double most)
{
    csg_slice_profile *p = j->profile;
    double room = 1e-6 * p->step + 1e-12 * (fabs(from) + fabs(to) + fabs(j->center_z));
    size_t end = stretch_of(p, to + j->center_z + room);
    float value = nextafterf((float)most, INFINITY);
    for (size_t i = stretch_of(p, from + j->center_z - room); i <= end; i++)
        raise_to(&p->most[i], value);
}

/* ---- normals -----------------------------------------------------------------------------------
 */

/* Of a piece of the surface in a cube: its |n_z|, and the heights that it is at. */
typedef struct level {
    double least, most, from, to;
} level;

/* Of vectors within `stray` of one: they turn by an angle whose sine is the quotient of the two. */
static void level_of_ball(const double at[3], double stray, level *out)
{
    double length = csg_norm3(at), sine = fabs(at[2]) / length, turn = stray / length;
    if (!(turn < 1))
        return;
    double cosine = sqrt(fmax(0, 1 - sine * sine)), rest = sqrt(1 - turn * turn);
    out->most = cosine <= turn ? out->most : fmin(out->most, sine * rest + cosine * turn);
    out->least = fmax(out->least, sine * rest - cosine * turn);
}

/* Of a hull of balls: no vector in it is shorter than the climb along the cone's axis. */
static void level_of_hull(const csg_cone_balls *balls, level *out)
{
    csg_cone cone;
    double most = 0;
    if (!csg_cone_find_axis(balls, &cone))
        return;
    for (uint32_t i = 0; i < balls->count; i++)
        most = fmax(most, fabs(balls->items[i].at[2]) + balls->items[i].spread);
    out->most = fmin(out->most, most / cone.least);
}

/* Where the sheet between the enclosure's planes runs through the cube. */
static void heights_of_sheet(const csg_measure_cube *q, const csg_enclosure *e, level *out)
{
    double across = q->half * (fabs(e->slope[0]) + fabs(e->slope[1])) * (1 + 1e-9);
    double low = -e->value - e->above - across, high = -e->value + e->below + across;
    double a = low / e->slope[2], b = high / e->slope[2];
    if (!(isfinite(a) && isfinite(b)))
        return;
    out->from = fmax(out->from, q->c[2] + fmin(a, b));
    out->to = fmin(out->to, q->c[2] + fmax(a, b));
}

/* Of the smooth piece that these nodes are. False: nothing is known. */
static bool look_at_piece(const job *j, const csg_measure_worker *w, const csg_measure_cube *q,
                          const csg_tape *piece, level *out)
{
    const float c[3] = {(float)q->c[0], (float)q->c[1], (float)q->c[2]};
    csg_cone_balls balls = {.count = 0};
    csg_enclosure e;
    *out = (level){.most = 1, .from = q->c[2] - q->half, .to = q->c[2] + q->half};
    bool has_sheet = csg_enclosure_find(j->walk.kernel, piece, q->c, q->half, w->scratch,
                                        j->walk.scratch_floats, &e);
    bool has_hull = piece->count == 1 && csg_cone_add_leaf(&balls, piece, piece->nodes, c,
                                                           csg_enclosure_radius(q->half));
    if (has_sheet && e.stray > 0) {
        level_of_ball(e.slope, e.stray, out);
        heights_of_sheet(q, &e, out);
    }
    if (has_hull)
        level_of_hull(&balls, out);
    out->most = fmin(1, out->most * (1 + CSG_ENCLOSURE_ROUNDING));
    return has_sheet || has_hull;
}

/* ---- pieces ------------------------------------------------------------------------------------
 */

/* An operand on the way through a tape: nodes from `first` on, and its pieces. */
typedef struct operand {
    uint32_t first, piece;
} operand;

/* Of the zero set of a tape each point is on one of these, which sharp operators join. */
typedef struct piece_list {
    csg_tape pieces[CSG_SLOPES_NODES];
    csg_tape_node nodes[CSG_SLOPES_NODES];
    uint32_t count;
    operand stack[CSG_SLOPES_NODES];
    uint32_t top;
} piece_list;

/* Nodes up to `last` become one piece, in the place of those that the operand has. */
static void make_piece(piece_list *l, const csg_tape *tape, const operand *of, uint32_t last,
                       bool with_join)
{
    csg_tape *piece = &l->pieces[of->piece];
    *piece = *tape;
    piece->nodes = l->nodes + of->first;
    piece->count = last - of->first + 1;
    memcpy(l->nodes + of->first, tape->nodes + of->first, piece->count * sizeof *l->nodes);
    if (!with_join)
        l->nodes[last].join = CSG_JOIN_NONE;
    l->count = of->piece + 1;
}

/* The node's own join, to the operand before; a copy of it may have none. */
static void join_pieces(piece_list *l, const csg_tape *tape, uint32_t index)
{
    operand *a = &l->stack[l->top - 2];
    l->top--;
    if (csg_halves_joins_sharply(tape, &tape->nodes[index]))
        return;
    make_piece(l, tape, a, index, true);
}

/* False: an operator that is not known. */
static bool find_pieces(const csg_tape *tape, piece_list *l)
{
    l->count = l->top = 0;
    if (!tape->count || tape->count > CSG_SLOPES_NODES)
        return false;
    for (uint32_t i = 0; i < tape->count; i++) {
        const csg_tape_node *node = &tape->nodes[i];
        uint32_t arity = csg_op_is_leaf(node->op) ? 0 : node->arity;
        if (csg_op_is_leaf(node->op)) {
            l->stack[l->top++] = (operand){i, l->count};
            make_piece(l, tape, &l->stack[l->top - 1], i, false);
        } else if (csg_op_takes_all(node->op) && arity && arity <= l->top) {
            l->top -= arity - 1;
            make_piece(l, tape, &l->stack[l->top - 1], i, false);
        } else if (node->op != CSG_OP_UNION && node->op != CSG_OP_INTERSECTION) {
            return false;
        }
        if (node->join)
            join_pieces(l, tape, i);
    }
    return l->top == 1;
}

/* ---- cubes -------------------------------------------------------------------------------------
 */

/* Puts what is known of the cube's pieces, if that is enough. */
static bool settle(job *j, const csg_measure_worker *w, const csg_measure_cube *q)
{
    level levels[CSG_SLOPES_NODES];
    piece_list list;
    bool is_last = q->level >= j->last_level;
    if (!find_pieces(&q->tape, &list))
        return false;
    for (uint32_t i = 0; i < list.count; i++) {
        level *l = &levels[i];
        if (!look_at_piece(j, w, q, &list.pieces[i], l))
            return false;
        double height = l->to - l->from;
        bool is_steep = l->most <= j->lowest, is_flat = l->least >= j->enough;
        bool is_narrow = l->most - l->least <= NARROW * l->most;
        if (!(l->from > l->to || is_last || is_steep || (is_narrow && height <= j->low) ||
              (is_flat && height <= j->least)))
            return false;
    }
    for (uint32_t i = 0; i < list.count; i++)
        if (levels[i].from <= levels[i].to)
            put_level(j, levels[i].from, levels[i].to, levels[i].most);
    return true;
}

/* Gradients at the cube's centre and corners. */
static void sample(job *j, const csg_measure_worker *w, const csg_measure_cube *q)
{
    float x[3][CSG_LANES], g[3][CSG_LANES];
    double most = 0;
    for (int i = 0; i < CSG_LANES; i++)
        for (int axis = 0; axis < 3; axis++)
            x[axis][i] =
                (float)(q->c[axis] + (i < CSG_OCTANTS ? (i >> axis & 1 ? q->half : -q->half) : 0));
    j->walk.kernel->gradients(&q->tape, x[0], x[1], x[2], CSG_OCTANTS + 1, g[0], g[1], g[2],
                              w->scratch, j->walk.scratch_floats);
    for (int i = 0; i <= CSG_OCTANTS; i++) {
        const double v[3] = {(double)g[0][i], (double)g[1][i], (double)g[2][i]};
        double length = csg_norm3(v);
        most = length > 0 ? fmax(most, fabs(v[2]) / length) : 1;
    }
    put_level(j, q->c[2] - q->half, q->c[2] + q->half, fmin(most, 1));
    atomic_fetch_add(&j->profile->sampled, 1);
}

/* False: out of memory, or it is time to stop. */
static bool descend(job *j, csg_measure_worker *w, const csg_measure_cube *parent, uint64_t *cubes)
{
    csg_measure_cube children[CSG_OCTANTS];
    csg_arena_mark mark = csg_arena_get_mark(&w->arena);
    bool done = csg_measure_divide(&j->walk, w, parent, &w->arena, children);
    if (!done)
        atomic_store(&j->out_of_memory, true);
    for (int o = 0; o < CSG_OCTANTS && done; o++) {
        csg_measure_cube *q = &children[o];
        if (++*cubes % ASK_EVERY == 0 && csg_mesh_should_stop(j->walk.watch))
            done = false;
        else if (q->state != CSG_CELL_SURFACE || settle(j, w, q))
            continue;
        else if (q->level < j->last_level)
            done = descend(j, w, q, cubes);
        else
            sample(j, w, q);
    }
    csg_arena_release_to(&w->arena, mark);
    return done;
}

static bool look_below(void *user, uint32_t worker, size_t index)
{
    job *j = user;
    uint64_t cubes = 0;
    const csg_measure_cube *cube = &j->walk.cubes[index];
    return cube->state != CSG_CELL_SURFACE || descend(j, &j->walk.workers[worker], cube, &cubes);
}

static void tell_progress(void *user, size_t done, size_t count)
{
    const job *j = user;
    csg_mesh_report_progress(j->walk.watch, (double)done / (double)count);
}

static csgm_status walk_cubes(job *j)
{
    csg_measure_walk *w = &j->walk;
    if (csg_pool_run(w->context->pool, w->count, look_below, tell_progress, j))
        return CSGM_OK;
    return atomic_load(&j->out_of_memory) ? csg_context_no_memory(w->context)
                                          : csg_mesh_why_stopped(w->watch);
}

csgm_status csg_slice_profile_find(csg_slice_profile *p, csgm_context *context,
                                   const csgm_field *field, csg_mesh_watch *watch, double least,
                                   double lowest, double enough)
{
    job j = {.profile = p, .lowest = lowest, .enough = enough, .center_z = field->center.z};
    double height = field->bounds.max.z - field->bounds.min.z;
    double longest = csg_box_longest_side(field->bounds);
    j.least = least;
    j.low = fmax(LOW * longest, least);
    double step = least / STRETCHES;
    *p = (csg_slice_profile){.bottom = field->bounds.min.z};
    p->count = (size_t)fmin(fmax(ceil(height / step), 1), MOST_STRETCHES);
    p->step = fmax(height / (double)p->count, DBL_MIN);
    p->most = csg_memory_alloc(&context->memory, p->count * sizeof *p->most);
    if (!p->most)
        return csg_context_no_memory(context);
    for (size_t i = 0; i < p->count; i++)
        atomic_init(&p->most[i], 0);
    csgm_status status = csg_measure_walk_begin(&j.walk, context, field, watch);
    p->edge = 2 * j.walk.half;
    while (j.last_level < CSG_MEASURE_DEEPEST && p->edge > fmax(step, longest / CUBES_ACROSS)) {
        p->edge /= 2;
        j.last_level++;
    }
    if (status == CSGM_OK)
        status = walk_cubes(&j);
    csg_measure_walk_release(&j.walk);
    return status;
}

void csg_slice_profile_release(csg_slice_profile *p, csg_memory *memory)
{
    csg_memory_release(memory, p->most, p->count * sizeof *p->most);
}
