/* SPDX-License-Identifier: MIT
 * Parts that touch, as the tape has them; see touching.h.
 */
#include "mesh/distance/touching.h"

#include <math.h>
#include <string.h>

#include "field/gradients/cone_leaf.h"
#include "scene/operators/blend.h"
#include "scene/operators/blend_kinds.h"
#include "scene/primitives/curve.h"

/* ---- the plane ---------------------------------------------------------------------------------
 */

/* A leaf that is linear in the ball, as a half-space is, or a slab near one of its faces. */
typedef struct flat_leaf {
    csg_vec3 slope;
    double value; /* at the tape's origin */
    double slack; /* rounding of a value */
} flat_leaf;

static bool find_flat(const csg_kernel *kernel, const csg_tape *tape, const csg_tape_node *node,
                      csg_vec3 c, double radius, flat_leaf *out)
{
    static const double LEAST = 1e-3, TURNS = 1e-12; /* of a gradient */
    const float at[3] = {(float)c.x, (float)c.y, (float)c.z};
    float places[3][CSG_OCTANTS], values[CSG_OCTANTS];
    csg_cone_balls balls = {.count = 0};
    csg_tape alone = *tape;
    if (!csg_cone_add_leaf(&balls, tape, node, at, radius) || balls.count != 1 ||
        balls.items[0].spread > TURNS)
        return false;
    alone.nodes = node;
    alone.count = 1;
    for (int axis = 0; axis < 3; axis++)
        for (int i = 0; i < CSG_OCTANTS; i++)
            places[axis][i] = at[axis];
    kernel->leaves(&alone, places[0], places[1], places[2], CSG_OCTANTS, values);
    const double *g = balls.items[0].at;
    csg_vec3 rounded = {(double)at[0], (double)at[1], (double)at[2]};
    out->slope = csg_vec3_make(g[0], g[1], g[2]);
    out->value = (double)values[0] - csg_vec3_dot(out->slope, rounded);
    out->slack = (double)tape->parameters[node->parameters + CSG_LEAF_SLACK];
    return csg_vec3_norm(out->slope) > LEAST;
}

/* Whether these are one plane from both sides, but for rounding. */
static bool are_opposite(const flat_leaf *a, const flat_leaf *b, csg_vec3 c, double radius)
{
    csg_vec3 slope = csg_vec3_add(a->slope, b->slope);
    double off = fabs(a->value + b->value + csg_vec3_dot(slope, c));
    return off + csg_vec3_norm(slope) * radius <= 2 * (a->slack + b->slack);
}

/* ---- the same in the plane ---------------------------------------------------------------------
 */

/* Two parts of a tape that are compared, and where. */
typedef struct comparison {
    const csg_tape *tape;
    const flat_leaf *plane; /* NULL: all over the ball */
    csg_vec3 c;
    double radius;
} comparison;

/* Rows of a frame: a map of places. */
typedef struct map {
    csg_vec3 row[3];
    double by[3];
} map;

static map map_of_frame(const float *frame, bool is_offset)
{
    map m;
    for (int i = 0; i < 3; i++) {
        const float *row = frame + 3 * i;
        m.row[i] = is_offset ? csg_vec3_make(i == 0, i == 1, i == 2)
                             : csg_vec3_make((double)row[0], (double)row[1], (double)row[2]);
        m.by[i] = is_offset ? -(double)frame[i] : (double)frame[9 + i];
    }
    return m;
}

/* How far apart the first `rows` coordinates are that two maps give places of the plane in the
 * ball: what their difference has of the plane's own value counts for nothing there. */
static double maps_apart(const comparison *of, const map *a, const map *b, int rows)
{
    double sum = 0;
    for (int i = 0; i < rows; i++) {
        csg_vec3 row = csg_vec3_sub(a->row[i], b->row[i]);
        double by = a->by[i] - b->by[i];
        if (of->plane) {
            csg_vec3 slope = of->plane->slope;
            double share = csg_vec3_dot(row, slope) / csg_vec3_dot(slope, slope);
            row = csg_vec3_sub(row, csg_vec3_scale(slope, share));
            by -= share * of->plane->value;
        }
        sum += fabs(by + csg_vec3_dot(row, of->c)) + csg_vec3_norm(row) * of->radius;
    }
    return sum;
}

static double longest_row(const map *m)
{
    return fmax(csg_vec3_norm(m->row[0]), fmax(csg_vec3_norm(m->row[1]), csg_vec3_norm(m->row[2])));
}

/* The same of places that come to two outermost warps that are the same, which see the plane, in
 * lengths of the tape's frame; leaves stand below other warps, if any, that are the same and in the
 * same frames. INFINITY: not known. */
static double warps_apart(const comparison *of, uint32_t a, uint32_t b)
{
    while (a != b) {
        if (!a || !b)
            return INFINITY;
        const csg_tape_warp *p = &of->tape->warps[a - 1], *q = &of->tape->warps[b - 1];
        if (p->kind != q->kind || memcmp(p->own, q->own, sizeof p->own) != 0)
            return INFINITY;
        if (!p->outer && !q->outer) {
            map m = map_of_frame(p->frame, false), n = map_of_frame(q->frame, false);
            return maps_apart(of, &m, &n, 3) / longest_row(&m);
        }
        if (memcmp(p->frame, q->frame, sizeof p->frame) != 0)
            return INFINITY;
        a = p->outer;
        b = q->outer;
    }
    return 0;
}

/* Whether two leaves are the same in their own frames; *rows: how many coordinates they look at. */
static bool are_same_leaves(const csg_tape *tape, const csg_tape_node *a, const csg_tape_node *b,
                            int *rows)
{
    *rows = 3;
    if (a->op == CSG_OP_SHAPE) {
        const csg_shape *shape = csg_tape_shape(tape, a), *other = csg_tape_shape(tape, b);
        *rows = shape->kind == CSG_SHAPE_REGION ? 2 : 3;
        return shape == other ||
               (shape->kind == other->kind && csg_shape_hash(shape) == csg_shape_hash(other));
    }
    if (!csg_op_is_primitive(a->op) || csg_node_is_curve(csg_op_node_kind(a->op)))
        return false;
    const csg_primitive *primitive = csg_primitive_of(csg_op_node_kind(a->op));
    *rows = csg_op_has(a->op, CSG_TRAIT_FLAT) ? 2 : 3;
    return memcmp(csg_tape_own(tape, a), csg_tape_own(tape, b),
                  (size_t)primitive->own_count * sizeof(float)) == 0;
}

/* By how much the values of two leaves differ. INFINITY: they are not the same. */
static double leaves_apart(const comparison *of, const csg_tape_node *a, const csg_tape_node *b)
{
    const float *p = of->tape->parameters + a->parameters;
    const float *q = of->tape->parameters + b->parameters;
    int rows;
    if (p[CSG_LEAF_SIGMA] != q[CSG_LEAF_SIGMA] || p[CSG_LEAF_RAISE] != q[CSG_LEAF_RAISE] ||
        !are_same_leaves(of->tape, a, b, &rows))
        return INFINITY;
    map m = map_of_frame(p + CSG_LEAF_FRAME, a->frame == CSG_FRAME_OFFSET);
    map n = map_of_frame(q + CSG_LEAF_FRAME, b->frame == CSG_FRAME_OFFSET);
    if (!a->warp && !b->warp)
        return fabs((double)p[CSG_LEAF_SIGMA]) * maps_apart(of, &m, &n, rows);
    for (int i = 0; i < rows; i++)
        if (m.by[i] != n.by[i] || csg_vec3_norm(csg_vec3_sub(m.row[i], n.row[i])) > 0)
            return INFINITY;
    double steepest = fmax((double)of->tape->steepest, (double)of->tape->lipschitz);
    return steepest * warps_apart(of, a->warp, b->warp);
}

static bool are_same_operators(const csg_tape *tape, const csg_tape_node *a, const csg_tape_node *b)
{
    bool is_known = csg_op_is_round(a->op) || a->op == CSG_OP_UNION || a->op == CSG_OP_INTERSECTION;
    return is_known && a->arity == b->arity && a->blend == b->blend &&
           !csg_blend_is_rule(a->blend) &&
           memcmp(tape->parameters + a->parameters, tape->parameters + b->parameters,
                  CSG_OPERATOR_PARAMETERS * sizeof(float)) == 0;
}

/* By how much two parts of as many nodes differ. INFINITY: they are not the same. Operators hand on
 * no more than the most of their operands. */
static double parts_apart(const comparison *of, const csg_tape_node *a, const csg_tape_node *b,
                          uint32_t count)
{
    double most = 0;
    for (uint32_t i = 0; i < count && most < INFINITY; i++) {
        const csg_tape_node *p = &a[i], *q = &b[i];
        if (p->op != q->op || p->join != q->join || p->join_blend != q->join_blend ||
            p->size != q->size)
            return INFINITY;
        if (csg_op_is_leaf(p->op))
            most = fmax(most, leaves_apart(of, p, q));
        else if (!are_same_operators(of->tape, p, q))
            return INFINITY;
    }
    return most;
}

/* ---- the pattern ------------------------------------------------------------------------------ */

/* Part number i of the operator at the end of the tape: a part cut off by a leaf, both as they are.
 */
typedef struct cut_part {
    const csg_tape_node *nodes, *cut;
    uint32_t count;
} cut_part;

static bool is_sharp(uint8_t blend)
{
    return blend == CSG_BLEND_SHARP;
}

/* Of the subtree that ends with `root`: an operator of this kind, of a part and a leaf. */
static bool find_cut(const csg_tape_node *root, csg_op op, csg_join join, cut_part *out)
{
    if (root->op != op || root->arity != 2 || !is_sharp(root->blend) || root->size < 3)
        return false;
    *out = (cut_part){root - (root->size - 1), root - 1, root->size - 2};
    return csg_op_is_leaf(out->cut->op) && out->cut->join == join &&
           is_sharp(out->cut->join_blend) && out->cut[-1].size == out->count &&
           out->cut[-1].join == CSG_JOIN_NONE;
}

static bool find_cuts(const csg_tape *tape, cut_part parts[2])
{
    const csg_tape_node *root = tape->count ? &tape->nodes[tape->count - 1] : NULL;
    bool is_union = root && root->op == CSG_OP_UNION;
    if (!root || (!is_union && root->op != CSG_OP_INTERSECTION) || root->arity != 2 ||
        !is_sharp(root->blend))
        return false;
    csg_op op = is_union ? CSG_OP_INTERSECTION : CSG_OP_UNION;
    csg_join join = is_union ? CSG_JOIN_INTERSECTION : CSG_JOIN_UNION;
    const csg_tape_node *second = root - 1;
    if (second->join == CSG_JOIN_NONE || !is_sharp(second->join_blend) ||
        second->size + 1 >= tape->count)
        return false;
    return find_cut(second, op, join, &parts[1]) &&
           find_cut(second - second->size, op, join, &parts[0]) && parts[0].count == parts[1].count;
}

csg_touching csg_touching_none(const csg_tape *tape)
{
    csg_touching none = {.tape = tape, .is_there = false};
    return none;
}

csg_touching csg_touching_find(const csg_kernel *kernel, const csg_tape *tape, csg_vec3 c,
                               double radius)
{
    csg_touching t = csg_touching_none(tape);
    cut_part parts[2];
    flat_leaf cuts[2];
    if (!find_cuts(tape, parts) || !find_flat(kernel, tape, parts[0].cut, c, radius, &cuts[0]) ||
        !find_flat(kernel, tape, parts[1].cut, c, radius, &cuts[1]) ||
        !are_opposite(&cuts[0], &cuts[1], c, radius))
        return t;
    const comparison of = {tape, &cuts[0], c, radius};
    double apart = parts_apart(&of, parts[0].nodes, parts[1].nodes, parts[0].count);
    double slack = cuts[0].slack + cuts[1].slack, turn = 1;
    if (!(apart <= 4 * slack))
        return t;
    for (int i = 0; i < 2; i++) {
        t.halves[i] = *tape;
        t.halves[i].nodes = parts[i].nodes;
        t.halves[i].count = parts[i].count;
    }
    if (tape->nodes[tape->count - 1].op == CSG_OP_INTERSECTION)
        turn = -1;
    t.slope = csg_vec3_scale(cuts[0].slope, turn);
    t.value = turn * cuts[0].value;
    t.doubt = apart + 4 * slack; /* and the planes need not be one, to rounding */
    t.is_there = true;
    return t;
}

/* ---- values ----------------------------------------------------------------------------------- */

static bool is_second(const csg_touching *t, float x, float y, float z)
{
    return csg_touching_side(t, csg_vec3_make((double)x, (double)y, (double)z)) < 0;
}

void csg_touching_values(const csg_touching *t, const csg_kernel *kernel, const float *x,
                         const float *y, const float *z, size_t count, float *out, float *scratch,
                         size_t scratch_floats)
{
    enum { BATCH = 8 * CSG_LANES };
    if (!t->is_there) {
        kernel->values(t->tape, x, y, z, count, out, scratch, scratch_floats);
        return;
    }
    kernel->values(&t->halves[0], x, y, z, count, out, scratch, scratch_floats);
    for (size_t i = 0; i < count; i += BATCH) {
        float other[BATCH];
        size_t some = count - i < BATCH ? count - i : BATCH;
        kernel->values(&t->halves[1], x + i, y + i, z + i, some, other, scratch, scratch_floats);
        for (size_t k = 0; k < some; k++)
            if (is_second(t, x[i + k], y[i + k], z[i + k]))
                out[i + k] = other[k];
    }
}

void csg_touching_values_and_gradients(const csg_touching *t, const csg_kernel *kernel,
                                       const float *x, const float *y, const float *z, size_t count,
                                       float *out, float *gx, float *gy, float *gz, float *scratch,
                                       size_t scratch_floats)
{
    const csg_tape *first = t->is_there ? &t->halves[0] : t->tape;
    kernel->values_and_gradients(first, x, y, z, count, out, gx, gy, gz, scratch, scratch_floats);
    for (size_t i = 0; t->is_there && i < count; i += CSG_LANES) {
        float f[CSG_LANES], g[3][CSG_LANES];
        size_t some = count - i < CSG_LANES ? count - i : CSG_LANES;
        kernel->values_and_gradients(&t->halves[1], x + i, y + i, z + i, some, f, g[0], g[1], g[2],
                                     scratch, scratch_floats);
        for (size_t k = 0; k < some; k++) {
            if (!is_second(t, x[i + k], y[i + k], z[i + k]))
                continue;
            out[i + k] = f[k];
            gx[i + k] = g[0][k];
            gy[i + k] = g[1][k];
            gz[i + k] = g[2][k];
        }
    }
}
