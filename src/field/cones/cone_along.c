/* SPDX-License-Identifier: MIT
 * The derivative along one direction v, in ranges, from the leaves up (v . g of each leaf's balls):
 *
 *   sharp, blends    shares >= 0 that add up to 1: between the least and the largest operand
 *   orthogonal       shares add up to 1 at least and sqrt(2) at most
 *   EXTERIOR,        the partial derivatives add up to 1 (moving both operands by c moves the
 *   INTERIOR         result by c), and their sizes to K at most
 *   sums             sums; products x y: y x' + x y'; 1 - (1 - x)(1 - y) likewise
 *   RICCI, SCALE_SET,  G is homogeneous of degree 1, so its partial derivatives, all >= 0, have
 *   ARC              G_1 x + G_2 y = G (Euler): they add up to G / max at least, which is 1 and
 *                    more for a union, and G / min at most
 *   SOFTEN, N        times the range of the function's slope
 *   COMBINE          the formula's own derivative in ranges (cone_formula.c), and the operands'
 *                    times its partial derivatives
 */
#include "field/cones/cone_along.h"

#include <math.h>

#include "field/gradients/cone_formula.h"
#include "field/gradients/rule_slopes.h"
#include "field/kernels/functions.h"
#include "field/prune/prune.h"
#include "field/rule_layout.h"
#include "field/turning.h"

enum { DEPTH = 64 };

/* Of one operand: its derivative, the size of its gradient, and of a field its value. */
typedef struct slope_range {
    double low, high, most;
    float least_value, largest_value;
} slope_range;

typedef struct stack {
    slope_range items[DEPTH];
    uint32_t top;
} stack;

static double least_of(double a, double b)
{
    return a < b ? a : b;
}

static double largest_of(double a, double b)
{
    return a > b ? a : b;
}

static slope_range leaf_range(const csg_cone_leaves *leaves, uint32_t leaf, const double axis[3])
{
    slope_range r = {.low = INFINITY, .high = -INFINITY};
    uint32_t end = leaf + 1 < leaves->count ? leaves->first[leaf + 1] : leaves->balls.count;
    for (uint32_t i = leaves->first[leaf]; i < end; i++) {
        const csg_cone_ball *b = &leaves->balls.items[i];
        double d = axis[0] * b->at[0] + axis[1] * b->at[1] + axis[2] * b->at[2];
        double norm = sqrt(b->at[0] * b->at[0] + b->at[1] * b->at[1] + b->at[2] * b->at[2]);
        r.low = least_of(r.low, d - b->spread);
        r.high = largest_of(r.high, d + b->spread);
        r.most = largest_of(r.most, norm + b->spread);
    }
    /* where faces meet weights add up to 1 and more: only what all climb is climbed there, too */
    double corner = leaves->corner[leaf];
    r.low = r.low < 0 ? least_of(r.low, -corner) : r.low;
    r.high = r.high > 0 ? largest_of(r.high, corner) : r.high;
    r.most = largest_of(r.most, corner);
    return r;
}

/* Times what lies in low..high. */
static slope_range scale_range(slope_range a, double low, double high)
{
    double corners[4] = {a.low * low, a.low * high, a.high * low, a.high * high};
    slope_range r = a;
    r.low = r.high = corners[0];
    for (int i = 1; i < 4; i++) {
        r.low = least_of(r.low, corners[i]);
        r.high = largest_of(r.high, corners[i]);
    }
    r.most = a.most * largest_of(fabs(low), fabs(high));
    return r;
}

/* Shares >= 0 that add up to from..to. */
static slope_range mix(slope_range a, slope_range b, double from, double to)
{
    slope_range r = a;
    double low = least_of(a.low, b.low), high = largest_of(a.high, b.high);
    r.low = low * (low >= 0 ? from : to);
    r.high = high * (high >= 0 ? to : from);
    r.most = largest_of(a.most, b.most) * to;
    return r;
}

static slope_range sum(slope_range a, slope_range b)
{
    return (slope_range){a.low + b.low, a.high + b.high, a.most + b.most, a.least_value,
                         a.largest_value};
}

/* ---- joins ------------------------------------------------------------------------------------
 */

/* One share in (1 - k) / 2 .. (1 + k) / 2, the other the rest of 1. */
static slope_range mix_smoothly(slope_range a, slope_range b, double k)
{
    double share = (1 + k) / 2;
    slope_range one = sum(scale_range(a, share, share), scale_range(b, 1 - share, 1 - share));
    slope_range other = sum(scale_range(a, 1 - share, 1 - share), scale_range(b, share, share));
    slope_range r = mix(one, other, 1, 1);
    r.most = largest_of(a.most, b.most) * k;
    return r;
}

static slope_range multiply(slope_range a, slope_range b, bool is_union)
{
    /* of a union the complements are multiplied */
    float al = is_union ? 1 - a.largest_value : a.least_value;
    float ah = is_union ? 1 - a.least_value : a.largest_value;
    float bl = is_union ? 1 - b.largest_value : b.least_value;
    float bh = is_union ? 1 - b.least_value : b.largest_value;
    slope_range r =
        sum(scale_range(a, (double)bl, (double)bh), scale_range(b, (double)al, (double)ah));
    r.least_value = is_union ? 1 - ah * bh : al * bl;
    r.largest_value = is_union ? 1 - al * bl : ah * bh;
    return r;
}

static void mix_homogeneous(const csg_tape *tape, const csg_tape_node *node, slope_range *a,
                            slope_range b)
{
    float low = (float)csg_join_value(tape, node, (double)a->least_value, (double)b.least_value);
    float high =
        (float)csg_join_value(tape, node, (double)a->largest_value, (double)b.largest_value);
    double most = (double)larger(a->largest_value, b.largest_value);
    double least = (double)smaller(a->least_value, b.least_value);
    bool grows = node->join == CSG_JOIN_UNION && node->join_blend != CSG_BLEND_SCALE_SET;
    double from = grows ? 1 : most > 0 ? (double)low / most : 0;
    double to = grows ? (least > 0 ? (double)high / least : INFINITY) : 1;
    if (grows) /* each is at most 1 */
        to = least_of(to, 2);
    *a = mix(*a, b, from * (1 - 1e-5), to * (1 + 1e-5));
    a->least_value = low * (1 - 1e-5f);
    a->largest_value = high * (1 + 1e-5f);
}

static bool join_slopes(const csg_tape *tape, const csg_tape_node *node, slope_range *a,
                        slope_range b)
{
    const float *own = tape->parameters + node->join_parameters;
    switch ((csg_blend_kind)node->join_blend) {
    case CSG_BLEND_ORTHOGONAL:
        *a = mix(*a, b, 1, 1.41421357);
        return true;
    case CSG_BLEND_EXTERIOR:
    case CSG_BLEND_INTERIOR:
        *a = mix_smoothly(*a, b, (double)own[CSG_SMOOTH_K]);
        return true;
    case CSG_BLEND_SOFT_SUM:
    case CSG_BLEND_SOFT_SET: {
        slope_range r = sum(*a, b);
        r.least_value = a->least_value + b.least_value;
        r.largest_value = a->largest_value + b.largest_value;
        *a = r;
        return true;
    }
    case CSG_BLEND_PERLIN:
        *a = multiply(*a, b, node->join == CSG_JOIN_UNION);
        return true;
    case CSG_BLEND_FIELD_SHARP: {
        bool is_union = node->join == CSG_JOIN_UNION;
        slope_range r = mix(*a, b, 1, 1);
        r.least_value = is_union ? larger(a->least_value, b.least_value)
                                 : smaller(a->least_value, b.least_value);
        r.largest_value = is_union ? larger(a->largest_value, b.largest_value)
                                   : smaller(a->largest_value, b.largest_value);
        *a = r;
        return true;
    }
    case CSG_BLEND_ARC:
        if (own[CSG_ARC_KNOTS] > 0)
            return false; /* a profile bends it both ways */
        mix_homogeneous(tape, node, a, b);
        return true;
    case CSG_BLEND_RICCI:
    case CSG_BLEND_SCALE_SET:
        mix_homogeneous(tape, node, a, b);
        return true;
#define CSG_BLEND(NAME, name, area, raw, support, excess, smooth, convex, doc)                     \
    case CSG_BLEND_##NAME:
#include "scene/operators/operators.def"
        *a = mix(*a, b, 1, 1);
        return true;
    case CSG_BLEND_ARC_SHARP: /* nothing is known */
    case CSG_BLEND_PROFILE:
    case CSG_BLEND_END: /* TURNING */
        break;
    }
    return false;
}

/* ---- combine ----------------------------------------------------------------------------------
 */

/* The values of the operands of a combine node. False: more than three, or mirrored. */
static bool operands_of(const csg_tape *tape, const csg_tape_node *node, const float *low,
                        const float *high, csg_cone_box *at)
{
    const float *own = tape->parameters + node->parameters;
    const csg_tape_node *child = node - 1;
    *at = (csg_cone_box){{0, 0, 0}, {0, 0, 0}};
    for (uint32_t k = node->arity; k-- > 0; child -= child->size) {
        ptrdiff_t place = (child - tape->nodes) * CSG_OCTANTS;
        float scale = own[CSG_LEAF_FRAME + 4 * k];
        if (k > 2 || scale < 0)
            return false;
        at->low[k] = scale * low[place] - 0x1p-20f * absolute(scale * low[place]);
        at->high[k] = scale * high[place] + 0x1p-20f * absolute(scale * high[place]);
    }
    return true;
}

/* Between which its partial derivatives by the operands lie. */
static bool shares_of(const csg_tape *tape, const csg_tape_node *node, const csg_cone_box *at,
                      csg_cone_box *shares, bool *has_edges)
{
    const csg_cone_box units[3] = {
        {{1, 0, 0}, {1, 0, 0}}, {{0, 1, 0}, {0, 1, 0}}, {{0, 0, 1}, {0, 0, 1}}};
    return csg_cone_formula(tape, csg_tape_formula_of(tape, node), at, units, NULL, shares,
                            has_edges);
}

/* The chain rule twice, from the operands' derivatives on and from the result's by them: each loses
 * what the other keeps. */
static bool combine(const csg_tape *tape, const csg_tape_node *node, const float *low,
                    const float *high, stack *s, bool *has_edges)
{
    const float *own = tape->parameters + node->parameters;
    const csg_tape_formula *formula = csg_tape_formula_of(tape, node);
    csg_cone_box at, seeds[3] = {{{0, 0, 0}, {0, 0, 0}}}, out, shares;
    slope_range all = {.low = 0};
    if (!operands_of(tape, node, low, high, &at) || !shares_of(tape, node, &at, &shares, has_edges))
        return false;
    for (uint32_t k = 0; k < node->arity; k++) {
        const slope_range *operand = &s->items[s->top - node->arity + k];
        float scale = own[CSG_LEAF_FRAME + 4 * k];
        float size = scale * (float)operand->most, room = 0x1p-20f * size;
        seeds[k].low[0] = scale * (float)operand->low - room;
        seeds[k].high[0] = scale * (float)operand->high + room;
        seeds[k].low[1] = -size - room;
        seeds[k].high[1] = size + room;
        slope_range one = {(double)seeds[k].low[0], (double)seeds[k].high[0],
                           (double)seeds[k].high[1], 0, 0};
        all = sum(all, scale_range(one, (double)shares.low[k], (double)shares.high[k]));
    }
    if (!csg_cone_formula(tape, formula, &at, seeds, NULL, &out, has_edges))
        return false;
    s->top -= node->arity;
    double most = largest_of(fabs((double)out.low[1]), fabs((double)out.high[1]));
    slope_range r = {.low = largest_of((double)out.low[0], all.low),
                     .high = least_of((double)out.high[0], all.high),
                     .most = least_of(most, all.most)};
    double sigma = (double)own[CSG_LEAF_SIGMA];
    s->items[s->top++] = scale_range(r, sigma, sigma);
    return true;
}

/* ---- the tape ---------------------------------------------------------------------------------
 */

static bool run_node(const csg_tape *tape, uint32_t n, const float *low, const float *high,
                     stack *s, bool *has_edges)
{
    const csg_tape_node *node = &tape->nodes[n];
    if (csg_op_is_round(node->op) || csg_op_is_fillet(node->op)) { /* leaves are wide enough */
        s->top -= node->arity;
        slope_range r = s->items[s->top];
        for (uint32_t k = 1; k < node->arity; k++)
            r = mix(r, s->items[s->top + k], 1, 1);
        s->items[s->top++] = r;
    } else if (node->op == CSG_OP_COMBINE) {
        if (!combine(tape, node, low, high, s, has_edges))
            return false;
    } else if (csg_op_delivers(node->op)) {
        slope_range *a = &s->items[s->top - 1];
        size_t child = (size_t)(n - 1) * CSG_OCTANTS;
        bool softens = node->op == CSG_OP_SOFTEN;
        csg_rule_range at = {(double)(softens ? low[child] : a->least_value),
                             (double)(softens ? high[child] : a->largest_value)};
        csg_curve_slopes rate;
        csg_deliver_find_slopes(tape, node, at, &rate);
        *a = scale_range(*a, rate.least, rate.most);
    }
    slope_range *made = &s->items[s->top - 1];
    made->least_value = low[(size_t)n * CSG_OCTANTS];
    made->largest_value = high[(size_t)n * CSG_OCTANTS];
    if (!node->join)
        return true;
    s->top--;
    return join_slopes(tape, node, &s->items[s->top - 1], s->items[s->top]);
}

bool csg_cone_along(const csg_tape *tape, const csg_cone_leaves *leaves, const float *low,
                    const float *high, const double axis[3], double *least, double *most,
                    bool *has_edges)
{
    stack s;
    uint32_t leaf = 0;
    s.top = 0;
    s.items[0] = (slope_range){.low = 0};
    for (uint32_t n = 0; n < tape->count; n++) {
        if (csg_op_is_leaf(tape->nodes[n].op)) {
            if (s.top == DEPTH)
                return false;
            s.items[s.top++] = leaf_range(leaves, leaf++, axis);
        }
        if (!run_node(tape, n, low, high, &s, has_edges))
            return false;
    }
    *least = s.items[0].low;
    *most = s.items[0].most;
    return s.top == 1 && *least > 0;
}

/* The leaves below each operand of a combine node that adds half of its gradient at most. */
static void drop_light(const csg_tape *tape, uint32_t n, const float *low, const float *high,
                       const uint32_t *first_leaf, bool *counts)
{
    const csg_tape_node *node = &tape->nodes[n], *child = node - 1;
    csg_cone_box at, shares;
    bool has_edges = false;
    if (!operands_of(tape, node, low, high, &at) ||
        !shares_of(tape, node, &at, &shares, &has_edges))
        return;
    for (uint32_t k = node->arity; k-- > 0; child -= child->size) {
        bool is_light = larger(-shares.low[k], shares.high[k]) <= 0.5f;
        uint32_t end = (uint32_t)(child - tape->nodes) + 1;
        for (uint32_t i = first_leaf[end - child->size]; is_light && i < first_leaf[end]; i++)
            counts[i] = false;
    }
}

bool csg_cone_lighten(const csg_tape *tape, const csg_cone_leaves *leaves, const float *low,
                      const float *high, csg_cone_balls *heavy)
{
    enum { MOST_NODES = 4 * CSG_CONE_MOST };
    uint32_t first_leaf[MOST_NODES + 1], leaf = 0;
    bool counts[CSG_CONE_MOST];
    if (tape->count > MOST_NODES)
        return false;
    for (uint32_t n = 0; n < tape->count; n++) {
        first_leaf[n] = leaf;
        if (csg_op_is_leaf(tape->nodes[n].op))
            counts[leaf++] = true;
        first_leaf[n + 1] = leaf;
        if (tape->nodes[n].op == CSG_OP_COMBINE)
            drop_light(tape, n, low, high, first_leaf, counts);
    }
    heavy->count = 0;
    for (uint32_t i = 0; i < leaf; i++) {
        uint32_t end = i + 1 < leaf ? leaves->first[i + 1] : leaves->balls.count;
        for (uint32_t k = leaves->first[i]; counts[i] && k < end; k++)
            heavy->items[heavy->count++] = leaves->balls.items[k];
    }
    return heavy->count > 0 && heavy->count < leaves->balls.count;
}
