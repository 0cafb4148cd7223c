/* SPDX-License-Identifier: MIT
 * A fillet among the operators of slopes.h: bounds of two operands whose gradients turn little, or
 * that are too far apart to blend, and of half-spaces.
 */
#include <math.h>
#include <string.h>

#include "field/gradients/cone_fillet.h"
#include "field/point.h"
#include "mesh/distance/slopes_private.h"
#include "scene/operators/blend_kinds.h"
#include "scene/operators/fillet.h"

typedef csg_slopes_operand operand;
typedef csg_slopes_walker walker;
typedef csg_slopes_range range;
typedef csg_slopes_which which;

/* Of an operator at the centre, as the kernel has it: nothing else knows its operands' gradients.
 */
double csg_slopes_value_of_node(const walker *w, const csg_tape_node *node)
{
    csg_tape below = *w->tape;
    csg_tape_node nodes[CSG_SLOPES_NODES];
    memcpy(nodes, node - (node->size - 1), node->size * sizeof *nodes);
    nodes[node->size - 1].join = CSG_JOIN_NONE;
    below.nodes = nodes;
    below.count = node->size;
    return csg_tape_value_at(w->kernel, &below, w->region.c, w->scratch, w->scratch_floats);
}

/* Whether it may have a crease, since some of its operands do not meet: two that do have none. */
static bool may_crease(const walker *w, const csg_tape_node *node)
{
    const csg_tape *tape = w->tape;
    const csg_tape_node *last = node - 1 - node->planes, *first = last - last->size;
    if (!csg_fillet_has_apart(tape, node) || node->arity - node->planes != 2)
        return csg_fillet_has_apart(tape, node);
    float planes_once = tape->parameters[node->parameters + CSG_FILLET_PLANES_ONCE];
    return csg_fillet_rows_apart(tape->parameters, first->join_parameters, last->join_parameters,
                                 (uint32_t)planes_once);
}

/* What a fillet ends at: how far inside of the nearest of its planes operands are at least. */
static double ends_of(const walker *w, const csg_tape_node *node, const operand *planes, which what)
{
    double nearest = INFINITY;
    for (uint32_t p = 0; p < node->planes; p++) {
        const csg_tape_node *child = node - 1 - node->planes, *plane = node - node->planes + p;
        double beyond = -INFINITY;
        for (uint32_t k = node->planes; k < node->arity; k++, child -= child->size)
            beyond =
                fmax(beyond,
                     (double)w->tape->parameters[child->join_parameters + plane->join_parameters]);
        nearest = fmin(nearest, csg_slopes_value(&planes[p], what) + beyond);
    }
    return nearest;
}

/* A fillet grows with its operands and with how far they turn from each other. */
static double fillet_value(const operand *of, which what, uint32_t count, double turn, double r,
                           double d, double end)
{
    double largest = -INFINITY, second = -INFINITY;
    for (uint32_t i = 0; i < count; i++) {
        double value = turn * csg_slopes_value(&of[i], what);
        second = fmax(second, fmin(value, largest));
        largest = fmax(largest, value);
    }
    double x = fmin(largest - second, 2 * r);
    bool pair = count == 2 && d < CSG_FILLET_FADE;
    double excess = pair     ? csg_fillet_of_two(r, x, d).excess
                    : d <= 0 ? 0
                             : csg_fillet_bound(r, x, count > 2 ? x : 2 * r, d);
    return turn * fmax(largest, fmin(largest + excess, end));
}

/* The share of operand a of two, where turn * (a - b) = t. */
static double fillet_share(double r, double t, double d)
{
    double lower = csg_fillet_of_two(r, fmin(fabs(t), 2 * r), d).lower;
    return t > 0 ? 1 - lower : lower;
}

/* Within which difference two operands blend, for r = 1. */
static double fillet_reach(csg_fillet_turns d)
{
    double least = (double)d.least, most = (double)d.most;
    if (most < CSG_FILLET_FADE)
        return most;
    return least < CSG_FILLET_PAIR_REACH ? CSG_FILLET_PAIR_REACH : least * csg_fillet_fade(least);
}

/* Of operand a of two. The lower one's share falls with the difference and grows with the turn. */
static range fillet_shares(const walker *w, const operand *of, double turn, double r,
                           csg_fillet_turns d)
{
    static const double ROUNDING = 1e-5;
    double reach = csg_slopes_reach(w, &of[0], &of[1]);
    double t = turn * (of[0].value - of[1].value), from = t - reach, to = t + reach;
    double blends = r * fillet_reach(d) * (1 + ROUNDING);
    if (from >= blends || to <= -blends)
        return (range){t > 0, t > 0};
    if ((double)d.most >= CSG_FILLET_FADE)
        return (range){0, 1};
    double low = fillet_share(r, from, (double)(from > 0 ? d.most : d.least)) - ROUNDING;
    double high = fillet_share(r, to, (double)(to > 0 ? d.least : d.most)) + ROUNDING;
    return (range){fmax(low, 0), fmin(high, 1)};
}

/* Of a pair with one angle all along F is convex, and its second derivative along a change of the
 * operands' difference x is (2 - d)^2 r^2 / (d root^3) where it blends, root^2 = (2 - d) (2 r^2 -
 * x^2 / d): it grows with x, which is r d at most there. That the angle changes is a part of the
 * gradient of its own, no longer than `stray`: values are off by that times the way to a corner. */
static void find_sag(const walker *w, operand *pair, double parting, double farthest, double r,
                     csg_fillet_turns turns, double stray)
{
    static const double LEAST = 0.02; /* of d: nearly tangent faces hardly blend */
    double d = (double)turns.least, x = fmin(farthest, r * (double)turns.most);
    if (!(d >= LEAST)) {
        pair->kink = INFINITY;
        return;
    }
    double rest = 2 * r * r - fmin(x * x / d, x * r);
    double bend = sqrt(2 - d) * r * r / (d * rest * sqrt(rest));
    pair->kink += stray * w->flat;
    pair->sag += 0.125 * bend * parting * parting;
}

/* Those that blend turn little from each other, or are planes. creases: which of them blend is not
 * told; ends: the planes take part. */
static bool mix_fillet(walker *w, const csg_tape_node *node, range share, csg_fillet_turns d,
                       bool creases, bool ends)
{
    const csg_vec3 at = w->region.c;
    const float c[3] = {(float)at.x, (float)at.y, (float)at.z};
    operand *of = &w->stack[w->top - node->arity];
    uint32_t count = node->arity - node->planes;
    bool is_pair = count == 2 && !creases && !ends && (double)d.most < CSG_FILLET_FADE;
    double stray, apart = 0, farthest = INFINITY;
    double kink = fmax(of[0].kink, of[1].kink), sag = fmax(of[0].sag, of[1].sag);
    double parting = is_pair ? csg_slopes_parting(w, &of[0], &of[1]) : 0;
    if (count == 2) {
        double difference = fabs(of[0].value - of[1].value);
        double reach = csg_slopes_reach(w, &of[0], &of[1]);
        apart = difference - reach;
        farthest = difference + reach;
    }
    if (!csg_fillet_find_stray(w->tape, node, c, w->radius, fmax(apart, 0), &stray))
        return false;
    for (uint32_t k = 1; k < count; k++)
        if (!csg_slopes_mix(&of[0], &of[k], share, count > 2 || creases))
            return false;
    for (uint32_t i = 0; i < of[0].balls.count; i++)
        of[0].balls.items[i].spread += stray;
    of[0].longest += stray;
    if (is_pair) {
        double r = (double)w->tape->parameters[node->parameters + CSG_OPERATOR_N];
        of[0].kink = kink;
        of[0].sag = sag;
        find_sag(w, &of[0], parting, farthest, r, d, stray);
    }
    for (uint32_t p = count; p < node->arity && ends; p++)
        if (!csg_slopes_mix(&of[0], &of[p], (range){0, 1}, true))
            return false;
    return true;
}

bool csg_slopes_join_fillet(walker *w, const csg_tape_node *node)
{
    static const which ends[2][2] = {{CSG_SLOPES_LOW, CSG_SLOPES_HIGH},
                                     {CSG_SLOPES_LEAST, CSG_SLOPES_MOST}};
    const csg_vec3 at = w->region.c;
    const float c[3] = {(float)at.x, (float)at.y, (float)at.z};
    double r = (double)w->tape->parameters[node->parameters + CSG_OPERATOR_N];
    double turn = csg_op_is_union(node->op) ? 1 : -1, doubt = 0, low[2], high[2];
    uint32_t count = node->arity - node->planes;
    operand *of = &w->stack[w->top - node->arity];
    if (count < 2)
        return false;
    csg_fillet_turns d = csg_fillet_find_turns(w->tape, node, c, w->radius);
    range share = count == 2 ? fillet_shares(w, of, turn, r, d) : (range){0, 1};
    bool creases = may_crease(w, node);
    if (creases)
        share = (range){0, 1};
    bool blends = share.low < 1 && share.high > 0;
    if (!blends)
        d = (csg_fillet_turns){0, 0};
    /* A union is least where its operands turn least, but for where the radius fades. */
    bool is_known = count == 2 && (double)d.most < CSG_FILLET_FADE && !creases;
    bool takes_ends = node->planes > 0;
    for (int i = 0; i < 2; i++) {
        which from = ends[i][turn < 0], to = ends[i][turn > 0];
        double start = ends_of(w, node, of + count, from), end = ends_of(w, node, of + count, to);
        low[i] = fillet_value(of, from, count, turn, r, is_known ? (double)d.least : 0, start);
        high[i] = fillet_value(of, to, count, turn, r, (double)d.most, end);
        if (i == 1 && turn > 0 && count == 2) /* of several, some end before others */
            takes_ends &= !(start >= high[i]);
    }
    for (uint32_t i = 0; i < node->arity; i++)
        doubt = fmax(doubt, of[i].doubt);
    if (blends ? !mix_fillet(w, node, share, d, creases, takes_ends)
               : !csg_slopes_mix(&of[0], &of[1], share, true))
        return false;
    w->top -= node->arity - 1;
    of[0].value = csg_slopes_value_of_node(w, node);
    of[0].doubt = doubt + 1e-5 * r;
    of[0].low = fmin(low[0], high[0]) - of[0].doubt;
    of[0].high = fmax(low[0], high[0]) + of[0].doubt;
    of[0].least = fmin(low[1], high[1]);
    of[0].most = fmax(low[1], high[1]);
    return true;
}
