/* SPDX-License-Identifier: MIT
 * Taylor models of tapes; see tape_taylor.h and taylor_walk.h: leaves, operators of two, and the
 * walk.
 */
#include "field/taylor/tape_taylor.h"

#include <math.h>
#include <string.h>

#include "base/geometry.h"
#include "field/taylor/taylor_walk.h"
#include "scene/operators/blend.h"
#include "scene/operators/blend_kinds.h"

/* One of its formulas; *ways: how many there are. */
static bool find_leaf(const csg_taylor_walk *w, uint32_t index, int way, int *ways,
                      csg_taylor_leaf *out)
{
    csg_smooth_choice choice = {.way = way};
    csg_smooth piece;
    csg_taylor_operand *o = &out->operand;
    *o = (csg_taylor_operand){.is_known = false};
    if (!csg_taylor_walk_leaf(w, index, false, w->may_decide ? &choice : NULL, &piece))
        return false;
    *ways = w->may_decide ? choice.ways : 1;
    *o = (csg_taylor_operand){.f = piece.f,
                              .leaf = index,
                              .way = way,
                              .is_known = true,
                              .is_leaf = true,
                              .is_creased = w->may_decide && choice.is_creased};
    out->condition_count = w->may_decide ? choice.condition_count : 0;
    for (int i = 0; i < out->condition_count; i++) {
        out->conditions[i] = choice.conditions[i];
        out->conditions[i].error += csg_taylor_walk_rounding(w, index);
    }
    return isfinite(o->f.value + o->f.error + o->f.quartic);
}

/* All of them; none, where one is not known. */
static void find_ways(csg_taylor_walk *w, uint32_t index)
{
    int ways = 1, found = 0;
    while (found < ways && ways <= CSG_SMOOTH_WAYS &&
           find_leaf(w, index, found, &ways, &w->leaves[index][found]))
        found++;
    w->ways[index] = found == ways ? ways : 0;
    if (found < ways)
        w->leaves[index][0].operand = (csg_taylor_operand){.is_known = false};
}

/* ---- operators of two --------------------------------------------------------------------------
 */

/* How far the gradients of two that differ by this are apart. */
static double turn_between(const csg_taylor_walk *w, const csg_taylor *d)
{
    return csg_norm3(d->slope) + csg_taylor_stray(d, w->radius);
}

/* So little that columns of both (measure/graph_field.h) tell more than planes that meet in a
 * crease. */
static bool are_tangent(const csg_taylor_walk *w, const csg_taylor *a, const csg_taylor *d)
{
    static const double MOST = 0.25; /* of the gradient */
    return turn_between(w, d) < MOST * csg_norm3(a->slope);
}

/* Two whose polynomials differ by less than what both are off: in no smaller ball would they be
 * told apart, as where one face has been computed in two ways. */
static bool are_same(const csg_taylor_walk *w, const csg_taylor *a, const csg_taylor *d)
{
    double r = w->radius, off = d->error + d->quartic * r * r * r * r;
    return fabs(d->value) + csg_taylor_reach(d, r) <= 2 * off && are_tangent(w, a, d);
}

/* Which of two decides: 0, 1, or -1, it is not the same everywhere and may not be left open. turn:
 * 1 of a union, -1 of an intersection. Where only the sign matters an operand that is outside of a
 * union decides nowhere. */
static int decider(csg_taylor_walk *w, csg_taylor_operand *a, const csg_taylor_operand *b,
                   double turn, bool signs)
{
    csg_taylor d = csg_taylor_sum(&a->f, -1, &b->f);
    double apart = csg_taylor_walk_apart(w, &d);
    if (isfinite(apart)) {
        csg_taylor_walk_add_apart(w, &a->f, apart);
        return 0;
    }
    if (are_same(w, &a->f, &d)) {
        a->f.error += fabs(d.value) + csg_taylor_reach(&d, w->radius);
        a->f.turned += turn_between(w, &d);
        return 0;
    }
    if (csg_taylor_reach(&d, w->radius) < fabs(d.value))
        return turn * d.value > 0 ? 0 : 1;
    const csg_taylor *f[2] = {&a->f, &b->f};
    for (int i = 0; i < 2 && signs; i++) {
        double least = csg_taylor_walk_least(w, f[i]), most = csg_taylor_walk_most(w, f[i]);
        bool is_hidden = turn > 0 ? most < 0 : least > 0;
        bool is_all = turn > 0 ? least > 0 : most < 0;
        if (is_hidden || is_all)
            return is_hidden ? 1 - i : i;
    }
    return -1;
}

/* The blend of a and b of a union, turned: with x = a - b, |x| < support,
 *   parabola   (a + b) / 2 + x^2 / n + n / 16
 *   hyperbola  (a + b) / 2 + sqrt(x^2 + n) / 2
 * (operators.md 2.1). */
static bool blend_two(const csg_taylor_walk *w, const csg_tape_node *node, const csg_taylor *a,
                      const csg_taylor *b, double turn, csg_taylor *out)
{
    double n = csg_tape_number(w->tape, node->join_parameters + CSG_OPERATOR_N);
    csg_taylor x = csg_taylor_sum(a, -1, b), excess, constant;
    const csg_taylor *const pair[2] = {&x, &constant};
    switch (node->join_blend) {
    case CSG_BLEND_PARABOLA:
        excess = csg_taylor_square(&x, w->radius);
        excess = csg_taylor_raised(csg_taylor_scaled(&excess, 1 / n), n / 16);
        *out = csg_taylor_walk_mean(a, b, turn, &excess);
        csg_taylor_walk_share(a, b, 2 * turn * x.value / n, out);
        csg_taylor_walk_add_length(w, n, out);
        return true;
    case CSG_BLEND_HYPERBOLA:
        constant = csg_taylor_constant(sqrt(n));
        if (!csg_taylor_norm(pair, 2, w->radius, &excess))
            return false;
        *out = csg_taylor_walk_mean(a, b, 0.5 * turn, &excess);
        csg_taylor_walk_share(a, b, 0.5 * turn * x.value / excess.value, out);
        csg_taylor_walk_add_length(w, sqrt(n), out);
        return true;
    default:
        return false;
    }
}

/* Where |x| is less than the support both count, else the larger one alone. */
static bool join_smoothly(csg_taylor_walk *w, const csg_tape_node *node, csg_taylor_operand *a,
                          const csg_taylor_operand *b, double turn)
{
    enum { FIRST, SECOND, BOTH, WAYS };
    double support = (double)w->tape->parameters[node->join_parameters + CSG_OPERATOR_SUPPORT];
    csg_taylor x = csg_taylor_sum(&a->f, -1, &b->f), inside[2];
    bool possible[WAYS] = {false, false, true};
    for (int i = 0; i < 2; i++) { /* where the other operand is near enough to count */
        inside[i] = csg_taylor_raised(csg_taylor_scaled(&x, i ? turn : -turn), support);
        possible[i] = !(csg_taylor_walk_least(w, &inside[i]) > 0);
        possible[BOTH] &= csg_taylor_walk_most(w, &inside[i]) > 0;
    }
    int way = csg_taylor_walk_choose(w, possible, WAYS);
    double off = 0x1p-23 * support;
    if (way < 0)
        return false;
    for (int i = 0; i < 2 && way == BOTH; i++)
        if (possible[i])
            csg_taylor_walk_require(w, &inside[i], off);
    if (way != BOTH) {
        csg_taylor beyond = csg_taylor_scaled(&inside[way], -1);
        if (possible[BOTH] || possible[1 - way])
            csg_taylor_walk_require(w, &beyond, off);
        if (way == SECOND)
            *a = *b;
        return true;
    }
    const csg_taylor first = a->f;
    a->is_leaf = false;
    a->is_creased |= b->is_creased;
    return blend_two(w, node, &first, &b->f, turn, &a->f);
}

/* One of two that each are the larger one somewhere; where the sign alone matters none, if they
 * meet in a crease. */
static bool decide(csg_taylor_walk *w, csg_taylor_operand *a, const csg_taylor_operand *b,
                   double turn, bool signs)
{
    static const bool BOTH[2] = {true, true};
    csg_taylor over = csg_taylor_sum(&a->f, -1, &b->f);
    if (signs && !are_tangent(w, &a->f, &over))
        return false;
    int which = csg_taylor_walk_choose(w, BOTH, 2);
    if (which < 0)
        return false;
    over = csg_taylor_scaled(&over, which ? -turn : turn);
    csg_taylor_walk_require(w, &over, 0);
    if (which)
        *a = *b;
    a->is_creased = true;
    return true;
}

static bool join_siblings(csg_taylor_walk *w, uint32_t index)
{
    const csg_tape_node *node = &w->tape->nodes[index];
    csg_taylor_operand *a = &w->stack[w->top - 2], *b = a + 1;
    double turn = node->join == CSG_JOIN_UNION ? 1 : -1;
    bool is_sharp = node->join_blend == CSG_BLEND_SHARP, signs = w->signs[index];
    w->top--;
    if (!a->is_known || !b->is_known)
        return false;
    if (is_sharp || (node->join_blend == CSG_BLEND_ORTHOGONAL && signs)) {
        int which = decider(w, a, b, turn, signs);
        if (which == 1)
            *a = *b;
        return which >= 0 || decide(w, a, b, turn, signs);
    }
    return (node->join_blend == CSG_BLEND_PARABOLA || node->join_blend == CSG_BLEND_HYPERBOLA) &&
           join_smoothly(w, node, a, b, turn);
}

/* ---- decisions ---------------------------------------------------------------------------------
 */

static bool push_leaf(csg_taylor_walk *w, uint32_t index)
{
    static const bool ALL[CSG_SMOOTH_WAYS] = {true, true, true, true};
    int way = w->ways[index] > 1 ? csg_taylor_walk_choose(w, ALL, w->ways[index]) : 0;
    if (way < 0)
        return false;
    const csg_taylor_leaf *leaf = &w->leaves[index][way];
    w->stack[w->top++] = leaf->operand;
    for (int i = 0; i < leaf->condition_count && leaf->operand.is_known; i++)
        csg_taylor_walk_require(w, &leaf->conditions[i], 0);
    return leaf->operand.is_known || w->has_fillets; /* a fillet may do without */
}

/* The script of the next piece. False: that was the last. */
static bool advance(csg_taylor_walk *w)
{
    for (int i = w->decisions - 1; i >= 0; i--) {
        if (++w->script[i] < w->options[i])
            return true;
        w->script[i] = 0;
    }
    return false;
}

/* ---- the walk ----------------------------------------------------------------------------------
 */

/* A node's children matter by their signs alone where it does and joins them sharply. */
static void find_signs(csg_taylor_walk *w)
{
    const csg_tape_node *nodes = w->tape->nodes;
    memset(w->signs, 0, sizeof w->signs);
    w->signs[w->tape->count - 1] = true;
    for (uint32_t i = w->tape->count; i-- > 0;) {
        if (!w->signs[i] || (nodes[i].op != CSG_OP_UNION && nodes[i].op != CSG_OP_INTERSECTION))
            continue;
        bool all = true;
        uint32_t end = i + 1 - nodes[i].size;
        for (uint32_t k = i; k > end; k -= nodes[k - 1].size) {
            const csg_tape_node *child = &nodes[k - 1];
            bool is_sharp = child->join_blend == CSG_BLEND_SHARP;
            if (child->join && child->join_blend == CSG_BLEND_ORTHOGONAL) {
                float n = w->tape->parameters[child->join_parameters + CSG_OPERATOR_N];
                is_sharp = !(n > 0) && !(n < 0);
            }
            all = all && (!child->join || is_sharp);
        }
        for (uint32_t k = i; k > end && all; k -= nodes[k - 1].size)
            w->signs[k - 1] = true;
    }
}

static bool walk(csg_taylor_walk *w)
{
    w->top = 0;
    w->decisions = 0;
    w->piece->condition_count = 0;
    w->piece->is_partial = false;
    for (uint32_t i = 0; i < w->tape->count; i++) {
        const csg_tape_node *node = &w->tape->nodes[i];
        bool known = node->op == CSG_OP_UNION || node->op == CSG_OP_INTERSECTION;
        if (csg_op_is_leaf(node->op)) {
            known = push_leaf(w, i);
        } else if (csg_op_is_round(node->op)) {
            known = csg_taylor_walk_round(w, node);
        } else if (csg_op_is_fillet(node->op)) {
            known = csg_taylor_walk_fillet(w, node, w->signs[i]);
        }
        if (!known)
            return false;
        w->stack[w->top - 1].node = i;
        if (node->join && !join_siblings(w, i))
            return false;
    }
    w->piece->f = w->stack[0].f;
    const csg_taylor *f = &w->piece->f;
    return w->top == 1 && w->stack[0].is_known && isfinite(f->value + f->error + f->quartic);
}

/* False: a leaf has no model that has to have one. */
static bool begin(csg_taylor_walk *w, const csg_tape *tape, const double c[3], double radius)
{
    if (!tape->count || tape->count > CSG_TAYLOR_NODES)
        return false;
    w->tape = tape;
    w->c = c;
    w->radius = radius;
    w->has_fillets = false;
    memset(w->script, 0, sizeof w->script);
    for (uint32_t i = 0; i < tape->count; i++)
        w->has_fillets |= csg_op_is_fillet(tape->nodes[i].op);
    find_signs(w);
    for (uint32_t i = 0; i < tape->count; i++) {
        if (!csg_op_is_leaf(tape->nodes[i].op))
            continue;
        find_ways(w, i);
        if (!w->ways[i] && !w->has_fillets)
            return false;
    }
    return true;
}

bool csg_tape_taylor(const csg_tape *tape, const double c[3], double radius, csg_taylor *out)
{
    csg_taylor_walk w; /* not filled: it is large, as is the piece */
    csg_taylor_piece piece;
    w.may_decide = false;
    w.piece = &piece;
    if (!begin(&w, tape, c, radius) || !walk(&w))
        return false;
    *out = piece.f;
    return true;
}

bool csg_tape_taylor_pieces(const csg_tape *tape, const double c[3], double radius,
                            csg_taylor_pieces *out)
{
    csg_taylor_walk w;
    w.may_decide = true;
    out->count = 0;
    if (!begin(&w, tape, c, radius))
        return false;
    do {
        if (out->count == CSG_TAYLOR_PIECES)
            return false;
        w.piece = &out->of[out->count++];
        if (!walk(&w))
            return false;
    } while (advance(&w));
    return true;
}
