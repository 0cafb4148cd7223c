/* SPDX-License-Identifier: MIT
 * Taylor models of tapes; see tape_taylor.h. A stack of operands, as the tape's own evaluation has
 * one.
 */
#include "field/taylor/tape_taylor.h"

#include <math.h>
#include <string.h>

#include "field/taylor/warp_taylor.h"
#include "scene/operators/blend.h"
#include "scene/operators/blend_kinds.h"
#include "scene/operators/fillet.h"
#include "scene/primitives/curve.h"
#include "scene/primitives/kinds.h"

enum { NODES_MOST = 24 /* of a tape; more are not looked at */ };

typedef struct operand {
    csg_taylor f;
    uint32_t node; /* the last of its subtree */
    uint32_t leaf; /* where it is one alone */
    bool is_known, is_leaf;
} operand;

typedef struct walker {
    const csg_tape *tape;
    const double *c;
    double radius;
    bool has_fillets;
    bool signs[NODES_MOST]; /* of each node: nothing but its sign matters */
    operand stack[NODES_MOST];
    uint32_t top;
} walker;

static double least_of(const walker *w, const csg_taylor *a)
{
    return csg_taylor_least(a, w->radius);
}

static double most_of(const walker *w, const csg_taylor *a)
{
    return csg_taylor_most(a, w->radius);
}

/* ---- leaves ------------------------------------------------------------------------------------
 */

/* Own coordinates; false: a warp on the way is not smooth in the ball. *off: how far the warps'
 * floats put them from where they are. */
static bool place(const walker *w, const csg_tape_node *leaf, bool with_slopes, csg_smooth_leaf *l,
                  double *off)
{
    const float *parameters = w->tape->parameters + leaf->parameters;
    const float *frame = parameters + CSG_LEAF_FRAME;
    bool is_offset = leaf->frame == CSG_FRAME_OFFSET;
    l->radius = w->radius;
    l->with_slopes = with_slopes;
    if (!leaf->warp && !is_offset)
        csg_taylor_place_points(frame, w->c, l);
    else if (!csg_taylor_warped(w->tape, leaf->warp, w->c, l, off))
        return false;
    for (int i = 0; i < 3 && is_offset; i++)
        l->p[i].f.value -= (double)frame[i];
    if (leaf->warp && !is_offset)
        csg_taylor_placed(frame, l);
    const csg_taylor *p[3] = {&l->p[0].f, &l->p[1].f, &l->p[2].f};
    l->own = parameters + (is_offset ? CSG_LEAF_OWN_OFFSET : CSG_LEAF_OWN_AFFINE);
    l->reach = csg_taylor_change_of(p, 3, w->radius).most;
    return true;
}

/* How far the value is off: by the parameters, and by the doubles that are computed with. */
static double rounding_of(const walker *w, const float *parameters)
{
    static const double OF_DOUBLES = 0x1p-26 /* of the slack */, OF_PLACE = 0x1p-44;
    double far = fabs(w->c[0]) + fabs(w->c[1]) + fabs(w->c[2]) + w->radius;
    return (double)parameters[CSG_LEAF_OFF] + (double)parameters[CSG_LEAF_TURNED] * far +
           OF_DOUBLES * (double)parameters[CSG_LEAF_SLACK] + OF_PLACE * far;
}

/* With its derivatives, if they are asked for. */
static bool find_piece(const walker *w, const csg_tape_node *leaf, bool with_slopes,
                       csg_smooth *out)
{
    static const double OF_DIRECTIONS = 1e-6; /* by floats of own parameters */
    const float *parameters = w->tape->parameters + leaf->parameters;
    csg_smooth_leaf l;
    csg_smooth own;
    double off = 0;
    if (!csg_op_is_primitive(leaf->op) || csg_node_is_curve(csg_op_node_kind(leaf->op)) ||
        !place(w, leaf, with_slopes, &l, &off) ||
        !csg_primitive_of(csg_op_node_kind(leaf->op))->smooth(&l, &own))
        return false;
    *out = csg_smooth_line(&l, (double)parameters[CSG_LEAF_RAISE],
                           (double)parameters[CSG_LEAF_SIGMA], &own);
    out->f.error += rounding_of(w, parameters) + off;
    out->f.turned += OF_DIRECTIONS + (double)parameters[CSG_LEAF_TURNED];
    if (leaf->warp) /* as far as what is curved turns by that, twice */
        out->f.turned += OF_DIRECTIONS + 2 * off / w->radius;
    return true;
}

static bool find_leaf(const walker *w, uint32_t index, operand *o)
{
    csg_smooth piece;
    if (!find_piece(w, &w->tape->nodes[index], false, &piece))
        return false;
    o->f = piece.f;
    o->leaf = index;
    o->is_leaf = true;
    return isfinite(o->f.value + o->f.error + o->f.quartic);
}

/* ---- operators of two --------------------------------------------------------------------------
 */

/* Two that are the same but for rounding, as flush faces are: how far apart, at most. INFINITY:
 * they are not. */
static double apart_at_most(const walker *w, const csg_taylor *d)
{
    static const double SAME = 0x1p-16; /* of the radius */
    double most = fabs(d->value) + csg_taylor_reach(d, w->radius);
    return most <= SAME * w->radius ? most : INFINITY;
}

/* And their gradients, by no more than twice that over the radius. */
static void add_apart(const walker *w, csg_taylor *f, double apart)
{
    f->error += apart;
    f->turned += 2 * apart / w->radius;
}

/* Which of two decides all over the ball: 0, 1, or -1, it is not the same everywhere. turn: 1 of a
 * union, -1 of an intersection. Where only the sign matters an operand that is outside of a union
 * decides nowhere. */
static int decider(const walker *w, operand *a, const operand *b, double turn, bool signs)
{
    csg_taylor d = csg_taylor_sum(&a->f, -1, &b->f);
    double apart = apart_at_most(w, &d);
    if (isfinite(apart)) {
        add_apart(w, &a->f, apart);
        return 0;
    }
    if (csg_taylor_reach(&d, w->radius) < fabs(d.value))
        return turn * d.value > 0 ? 0 : 1;
    const csg_taylor *f[2] = {&a->f, &b->f};
    for (int i = 0; i < 2 && signs; i++) {
        bool is_hidden = turn > 0 ? most_of(w, f[i]) < 0 : least_of(w, f[i]) > 0;
        bool is_all = turn > 0 ? least_of(w, f[i]) > 0 : most_of(w, f[i]) < 0;
        if (is_hidden || is_all)
            return is_hidden ? 1 - i : i;
    }
    return -1;
}

/* What a float makes of a blend's length: values move by no more than it does, gradients' shares by
 * as much of themselves. */
static void add_rounding_of(double length, csg_taylor *f)
{
    f->error += 0x1p-24 * length;
    f->turned += 0x1p-22;
}

/* (a + b) / 2 + excess. */
static void take_mean(const csg_taylor *a, const csg_taylor *b, double factor,
                      const csg_taylor *excess, csg_taylor *out)
{
    csg_taylor sum = csg_taylor_sum(a, 1, b);
    sum = csg_taylor_scaled(&sum, 0.5);
    *out = csg_taylor_sum(&sum, factor, excess);
}

/* The blend of a and b of a union, turned: with x = a - b, |x| < support,
 *   parabola   (a + b) / 2 + x^2 / n + n / 16
 *   hyperbola  (a + b) / 2 + sqrt(x^2 + n) / 2
 * (operators.md 2.1). */
static bool blend_two(const walker *w, const csg_tape_node *node, const csg_taylor *a,
                      const csg_taylor *b, double turn, csg_taylor *out)
{
    const float *parameters = w->tape->parameters + node->join_parameters;
    double n = (double)parameters[CSG_OPERATOR_N];
    csg_taylor x = csg_taylor_sum(a, -1, b), excess, constant;
    const csg_taylor *const pair[2] = {&x, &constant};
    switch (node->join_blend) {
    case CSG_BLEND_PARABOLA:
        excess = csg_taylor_square(&x, w->radius);
        excess = csg_taylor_raised(csg_taylor_scaled(&excess, 1 / n), n / 16);
        take_mean(a, b, turn, &excess, out);
        add_rounding_of(n, out);
        return true;
    case CSG_BLEND_HYPERBOLA:
        constant = csg_taylor_constant(sqrt(n));
        if (!csg_taylor_norm(pair, 2, w->radius, &excess))
            return false;
        take_mean(a, b, 0.5 * turn, &excess, out);
        add_rounding_of(sqrt(n), out);
        return true;
    default:
        return false;
    }
}

static bool join_siblings(walker *w, uint32_t index)
{
    const csg_tape_node *node = &w->tape->nodes[index];
    const float *parameters = w->tape->parameters + node->join_parameters;
    operand *a = &w->stack[w->top - 2], *b = a + 1;
    double turn = node->join == CSG_JOIN_UNION ? 1 : -1;
    double support = (double)parameters[CSG_OPERATOR_SUPPORT];
    bool is_sharp = node->join_blend == CSG_BLEND_SHARP, signs = w->signs[index];
    w->top--;
    if (!a->is_known || !b->is_known)
        return false;
    if (is_sharp || (node->join_blend == CSG_BLEND_ORTHOGONAL && signs)) {
        int which = decider(w, a, b, turn, signs);
        if (which == 1)
            *a = *b;
        return which >= 0;
    }
    if (node->join_blend != CSG_BLEND_PARABOLA && node->join_blend != CSG_BLEND_HYPERBOLA)
        return false;
    csg_taylor x = csg_taylor_sum(&a->f, -1, &b->f);
    double reach = csg_taylor_reach(&x, w->radius), apart = fabs(x.value);
    if (apart - reach > support) {
        if (turn * x.value < 0)
            *a = *b;
        return true;
    }
    a->is_leaf = false;
    return apart + reach < support && blend_two(w, node, &a->f, &b->f, turn, &a->f);
}

/* ---- round -------------------------------------------------------------------------------------
 */

static bool are_known(const operand *of, uint32_t count)
{
    bool all = true;
    for (uint32_t i = 0; i < count; i++)
        all = all && of[i].is_known;
    return all;
}

/* Largest first. */
static void sort_operands(const operand *of, uint32_t count, double turn, uint32_t *order)
{
    for (uint32_t i = 0; i < count; i++) {
        uint32_t at = i;
        for (; at > 0 && turn * of[order[at - 1]].f.value < turn * of[i].f.value; at--)
            order[at] = order[at - 1];
        order[at] = i;
    }
}

/* Of m operands that all touch: G = w + mean - sqrt(w^2 / m - mean of (f - mean)^2), turned. */
static bool find_level(const walker *w, const operand *of, const uint32_t *order, uint32_t m,
                       double width, double turn, csg_taylor *out)
{
    csg_taylor mean = csg_taylor_constant(0);
    csg_taylor under = csg_taylor_constant(width * width / m), root;
    if (m == 1) {
        *out = of[order[0]].f;
        return true;
    }
    for (uint32_t i = 0; i < m; i++)
        mean = csg_taylor_sum(&mean, 1.0 / m, &of[order[i]].f);
    for (uint32_t i = 0; i < (m == 2 ? 1 : m); i++) {
        csg_taylor d = csg_taylor_sum(&of[order[i]].f, -1, &mean);
        d = csg_taylor_square(&d, w->radius);
        under = csg_taylor_sum(&under, m == 2 ? -1.0 : -1.0 / m, &d);
    }
    if (!csg_taylor_root(&under, w->radius, &root))
        return false;
    *out = csg_taylor_raised(csg_taylor_sum(&mean, -turn, &root), turn * width);
    add_rounding_of(width, out);
    return true;
}

/* By its operands' values at the centre, those touch that stand first; all over the ball they do if
 * w + f - G > 0 for them and < 0 for all others. */
static bool combine_round(walker *w, const csg_tape_node *node)
{
    operand *of = &w->stack[w->top - node->arity];
    double width = (double)w->tape->parameters[node->parameters + CSG_OPERATOR_N];
    double turn = node->op == CSG_OP_ROUND_UNION ? 1 : -1, sum = 0, squares = 0, level = 0;
    uint32_t order[NODES_MOST], m = 0;
    csg_taylor out;
    if (!are_known(of, node->arity))
        return false;
    sort_operands(of, node->arity, turn, order);
    for (; m < node->arity; m++) {
        double f = turn * of[order[m]].f.value;
        if (m && !(width + f - level > 0))
            break;
        sum += f;
        squares += f * f;
        double mean = sum / (m + 1), rest = width * width - (squares - sum * mean);
        level = width + mean - sqrt(fmax(rest, 0) / (m + 1));
    }
    if (!find_level(w, of, order, m, width, turn, &out))
        return false;
    for (uint32_t i = 0; i < node->arity; i++) {
        csg_taylor d = csg_taylor_sum(&of[order[i]].f, -1, &out);
        double touches = width + turn * d.value, reach = csg_taylor_reach(&d, w->radius);
        if (i < m ? !(touches > reach) && m > 1 : !(touches < -reach))
            return false;
    }
    w->top -= node->arity - 1;
    if (m == 1) {
        of[0] = of[order[0]];
        return true;
    }
    of[0].f = out;
    of[0].is_leaf = false;
    return true;
}

/* ---- fillets -----------------------------------------------------------------------------------
 */

/* 1 - cos of the angle between two unit gradients. False: they are none. */
static bool find_turn(const walker *w, const operand *a, const operand *b, csg_taylor *out)
{
    static const double UNIT = 1e-6, ROUNDING = 0x1p-23 /* of directions by floats */;
    const operand *both[2] = {a, b};
    csg_smooth pieces[2];
    double off = ROUNDING;
    for (int i = 0; i < 2; i++) {
        double square = 0;
        if (!both[i]->is_leaf || !find_piece(w, &w->tape->nodes[both[i]->leaf], true, &pieces[i]))
            return false;
        for (int k = 0; k < 3; k++)
            square += pieces[i].g[k].value * pieces[i].g[k].value;
        if (!(fabs(square - 1) < UNIT))
            return false;
        off += fabs(square - 1);
    }
    *out = csg_taylor_constant(1);
    for (int k = 0; k < 3; k++) {
        csg_taylor p = csg_taylor_product(&pieces[0].g[k], &pieces[1].g[k], w->radius);
        *out = csg_taylor_sum(out, -1, &p);
    }
    out->error += off;
    return true;
}

/* With d the turn and x the difference of two operands, of a union:
 *   (a + b) / 2 + r - sqrt((2 - d) (2 r^2 - x^2 / d)) / 2     where r d > |x|
 * (operators.md 16). */
static bool fillet_two(const walker *w, const csg_taylor *a, const csg_taylor *b,
                       const csg_taylor *d, double r, double turn, csg_taylor *out)
{
    csg_taylor x = csg_taylor_sum(a, -1, b), inverse, under, root;
    csg_taylor rest = csg_taylor_raised(csg_taylor_scaled(d, -1), 2);
    x = csg_taylor_square(&x, w->radius);
    if (!csg_taylor_inverse(d, w->radius, &inverse))
        return false;
    under = csg_taylor_product(&x, &inverse, w->radius);
    under = csg_taylor_raised(csg_taylor_scaled(&under, -1), 2 * r * r);
    under = csg_taylor_product(&rest, &under, w->radius);
    if (!csg_taylor_root(&under, w->radius, &root))
        return false;
    take_mean(a, b, -0.5 * turn, &root, out);
    *out = csg_taylor_raised(*out, turn * r);
    add_rounding_of(r, out);
    return true;
}

/* How far the operand that reaches farthest does so beyond the fillet's plane p. */
static double beyond_of(const walker *w, const operand *of, const uint32_t *which, uint32_t count,
                        uint32_t p)
{
    const csg_tape *tape = w->tape;
    uint32_t number = tape->nodes[of[p].node].join_parameters;
    double most = -INFINITY;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t reaches = tape->nodes[of[which[i]].node].join_parameters;
        most = fmax(most, (double)tape->parameters[reaches + number]);
    }
    return most;
}

/* Of that, by floats. */
static const double BEYOND_ROUNDING = 1e-6;

/* Of the planes at which the fillet ends: none is nearer than its surface (0), one decides (1, in
 * *out), or it is not the same everywhere (-1). */
static int find_end(const walker *w, const csg_tape_node *node, const operand *of,
                    const uint32_t pair[2], double turn, csg_taylor *out)
{
    int ended = 0;
    for (uint32_t p = node->arity - node->planes; p < node->arity; p++) {
        double beyond = beyond_of(w, of, pair, 2, p), rounding = BEYOND_ROUNDING * fabs(beyond);
        if (!isfinite(beyond))
            continue;
        csg_taylor inside = csg_taylor_raised(of[p].f, turn * beyond);
        csg_taylor over = csg_taylor_sum(&inside, -1, out);
        double reach = csg_taylor_reach(&over, w->radius) + rounding;
        if (turn * over.value > reach)
            continue;
        if (!(turn * over.value < -reach))
            return -1;
        *out = inside;
        out->error += rounding;
        ended = 1;
    }
    return ended;
}

/* An operand's face that is flush with a plane at which the fillet ends: all operands are behind
 * the plane, and so is the fillet, which is no less than that operand. So both have its sign,
 * whatever the other operands are. */
static bool is_flush(const walker *w, const csg_tape_node *node, operand *of, const uint32_t *all,
                     double turn)
{
    uint32_t count = node->arity - node->planes;
    for (uint32_t p = count; p < node->arity; p++) {
        double beyond = beyond_of(w, of, all, count, p);
        for (uint32_t k = 0; k < count && isfinite(beyond) && of[p].is_known; k++) {
            if (!of[k].is_known)
                continue;
            csg_taylor d = csg_taylor_sum(&of[k].f, -1, &of[p].f);
            d.value -= turn * beyond;
            double apart = apart_at_most(w, &d);
            if (!isfinite(apart))
                continue;
            of[0] = of[k];
            add_apart(w, &of[0].f, apart + BEYOND_ROUNDING * fabs(beyond));
            return true;
        }
    }
    return false;
}

/* How the two largest operands meet all over the ball. */
typedef enum meeting {
    APART,    /* the larger one is alone */
    FLUSH,    /* as good as one, up to *more */
    BLENDING, /* at the turn *d */
    MIXED
} meeting;

static meeting find_meeting(const walker *w, const operand *a, const operand *b, double r,
                            double turn, csg_taylor *d, double *more)
{
    static const double ROUNDING = 2e-6; /* 1 - cos of an angle that is no more than that */
    csg_taylor x = csg_taylor_sum(&a->f, -1, &b->f);
    double reach = csg_taylor_reach(&x, w->radius), least = turn * x.value - reach;
    if (least > CSG_FILLET_PAIR_REACH * r)
        return APART;
    if (!find_turn(w, a, b, d) || !(most_of(w, d) < CSG_FILLET_FADE))
        return MIXED;
    if (most_of(w, d) < ROUNDING && isfinite(apart_at_most(w, &x))) {
        /* what is added is most where both are equal, r d / 4 and a little */
        *more = apart_at_most(w, &x) + 0.26 * r * most_of(w, d);
        return FLUSH;
    }
    if (least > fmax(r * most_of(w, d), 0))
        return APART;
    return fabs(x.value) + reach < r * least_of(w, d) ? BLENDING : MIXED;
}

/* Where a plane ends the fillet of two it must be above both, or one of them decides again. */
static bool blend_pair(const walker *w, const csg_tape_node *node, const operand *of,
                       const uint32_t pair[2], const csg_taylor *d, double r, double turn,
                       csg_taylor *out)
{
    if (!fillet_two(w, &of[pair[0]].f, &of[pair[1]].f, d, r, turn, out))
        return false;
    int ended = find_end(w, node, of, pair, turn, out);
    for (int i = 0; i < 2 && ended > 0; i++) {
        csg_taylor over = csg_taylor_sum(out, -1, &of[pair[i]].f);
        if (!(turn * over.value > csg_taylor_reach(&over, w->radius)))
            return false;
    }
    return ended >= 0;
}

/* The largest operand alone, or two that blend and no third one near. */
static bool combine_fillet(walker *w, const csg_tape_node *node, bool signs)
{
    const float *parameters = w->tape->parameters + node->parameters;
    operand *of = &w->stack[w->top - node->arity];
    double r = (double)parameters[CSG_OPERATOR_N], more = 0;
    double turn = node->op == CSG_OP_FILLET_UNION ? 1 : -1;
    uint32_t order[NODES_MOST], count = node->arity - node->planes;
    csg_taylor d = {.value = 0}, out = {.value = 0};
    w->top -= node->arity - 1;
    for (uint32_t i = 0; i < count; i++)
        order[i] = i;
    if (signs && is_flush(w, node, of, order, turn))
        return true;
    if (parameters[CSG_FILLET_IS_SKEWED] != 0 || !count || !are_known(of, node->arity))
        return false;
    sort_operands(of, count, turn, order);
    const operand *a = &of[order[0]];
    for (uint32_t i = 2; i < count; i++) {
        csg_taylor x = csg_taylor_sum(&a->f, -1, &of[order[i]].f);
        if (!(turn * x.value - csg_taylor_reach(&x, w->radius) > 2 * r))
            return false;
    }
    meeting how = count > 1 ? find_meeting(w, a, &of[order[1]], r, turn, &d, &more) : APART;
    if (how == MIXED || (how == BLENDING && !blend_pair(w, node, of, order, &d, r, turn, &out)))
        return false;
    of[0] = *a;
    if (how == BLENDING) {
        of[0].f = out;
        of[0].is_leaf = false;
    }
    add_apart(w, &of[0].f, more);
    return true;
}

/* ---- the walk ----------------------------------------------------------------------------------
 */

/* A node's children matter by their signs alone where it does and joins them sharply. */
static void find_signs(walker *w)
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

static bool walk(walker *w)
{
    for (uint32_t i = 0; i < w->tape->count; i++) {
        const csg_tape_node *node = &w->tape->nodes[i];
        bool known = node->op == CSG_OP_UNION || node->op == CSG_OP_INTERSECTION;
        if (csg_op_is_leaf(node->op)) {
            operand *o = &w->stack[w->top++];
            o->is_known = find_leaf(w, i, o); /* a fillet may do without */
            known = o->is_known || w->has_fillets;
        } else if (csg_op_is_round(node->op)) {
            known = combine_round(w, node);
        } else if (csg_op_is_fillet(node->op)) {
            known = combine_fillet(w, node, w->signs[i]);
        }
        if (!known)
            return false;
        w->stack[w->top - 1].node = i;
        if (node->join && !join_siblings(w, i))
            return false;
    }
    return w->top == 1 && w->stack[0].is_known;
}

bool csg_tape_taylor(const csg_tape *tape, const double c[3], double radius, csg_taylor *out)
{
    walker w; /* not filled: it is large */
    if (!tape->count || tape->count > NODES_MOST)
        return false;
    w.tape = tape;
    w.c = c;
    w.radius = radius;
    w.has_fillets = false;
    w.top = 0;
    for (uint32_t i = 0; i < tape->count; i++)
        w.has_fillets |= csg_op_is_fillet(tape->nodes[i].op);
    find_signs(&w);
    if (!walk(&w))
        return false;
    *out = w.stack[0].f;
    return isfinite(out->value + out->error + out->quartic);
}
