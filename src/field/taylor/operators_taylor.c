/* SPDX-License-Identifier: MIT
 * Taylor models of operators that take all their operands at once; see taylor_walk.h.
 */
#include <math.h>

#include "base/geometry.h"
#include "field/taylor/taylor_walk.h"
#include "scene/operators/blend.h"
#include "scene/operators/fillet.h"

/* ---- round -------------------------------------------------------------------------------------
 */

static bool are_known(const csg_taylor_operand *of, uint32_t count)
{
    bool all = true;
    for (uint32_t i = 0; i < count; i++)
        all = all && of[i].is_known;
    return all;
}

/* Largest first. */
static void sort_operands(const csg_taylor_operand *of, uint32_t count, double turn,
                          uint32_t *order)
{
    for (uint32_t i = 0; i < count; i++) {
        uint32_t at = i;
        for (; at > 0 && turn * of[order[at - 1]].f.value < turn * of[i].f.value; at--)
            order[at] = order[at - 1];
        order[at] = i;
    }
}

/* Of two that both touch, with d half their difference: G = w + mean - sqrt(w^2 / 2 - d^2), turned.
 */
static bool find_level_of_two(const csg_taylor_walk *w, const csg_taylor *a, const csg_taylor *b,
                              double width, double turn, csg_taylor *out)
{
    csg_taylor under = csg_taylor_constant(width * width / 2), root;
    csg_taylor d = csg_taylor_sum(a, -1, b);
    d = csg_taylor_scaled(&d, 0.5);
    const csg_taylor square = csg_taylor_square(&d, w->radius);
    under = csg_taylor_sum(&under, -1, &square);
    if (!csg_taylor_root(&under, w->radius, &root))
        return false;
    *out = csg_taylor_walk_mean(a, b, -turn, &root);
    csg_taylor_walk_share(a, b, 0.5 * turn * d.value / root.value, out);
    *out = csg_taylor_raised(*out, turn * width);
    csg_taylor_walk_add_length(w, width, out);
    return true;
}

/* Of m operands that all touch: G = w + mean - sqrt(w^2 / m - mean of (f - mean)^2), turned. */
static bool find_level(const csg_taylor_walk *w, const csg_taylor_operand *of,
                       const uint32_t *order, uint32_t m, double width, double turn,
                       csg_taylor *out)
{
    csg_taylor mean = csg_taylor_constant(0);
    csg_taylor under = csg_taylor_constant(width * width / m), root;
    if (m == 1) {
        *out = of[order[0]].f;
        return true;
    }
    if (m == 2)
        return find_level_of_two(w, &of[order[0]].f, &of[order[1]].f, width, turn, out);
    for (uint32_t i = 0; i < m; i++)
        mean = csg_taylor_sum(&mean, 1.0 / m, &of[order[i]].f);
    for (uint32_t i = 0; i < m; i++) {
        csg_taylor d = csg_taylor_sum(&of[order[i]].f, -1, &mean);
        d = csg_taylor_square(&d, w->radius);
        under = csg_taylor_sum(&under, -1.0 / m, &d);
    }
    if (!csg_taylor_root(&under, w->radius, &root))
        return false;
    *out = csg_taylor_raised(csg_taylor_sum(&mean, -turn, &root), turn * width);
    csg_taylor_walk_add_length(w, width, out);
    return true;
}

/* How far operand i is from touching a level, at least and at most, of a union. */
typedef struct touch {
    csg_taylor over; /* w + f - G */
    double reach;
} touch;

static touch find_touch(const csg_taylor_walk *w, const csg_taylor_operand *of,
                        const csg_taylor *level, double width, double turn)
{
    touch t;
    t.over = csg_taylor_sum(&of->f, -1, level);
    t.over = csg_taylor_raised(csg_taylor_scaled(&t.over, turn), width);
    t.reach = csg_taylor_reach(&t.over, w->radius);
    return t;
}

/* The first m in this order touch their level all over the ball. */
static bool all_touch(const csg_taylor_walk *w, const csg_taylor_operand *of, const uint32_t *order,
                      uint32_t m, double width, double turn, csg_taylor *level)
{
    bool all = find_level(w, of, order, m, width, turn, level);
    for (uint32_t i = 0; i < m && m > 1 && all; i++) {
        touch t = find_touch(w, &of[order[i]], level, width, turn);
        all = t.over.value > t.reach;
    }
    return all;
}

/* Where m operands that touch blend to 0, w + f of them are not negative and the sum of their
 * squares is w^2, so that their own sum is between w and sqrt(m) w. Where it is more all over the
 * ball the blend is positive, where it is less negative: *out. False: it may be zero. */
static bool find_sign(const csg_taylor_walk *w, const csg_taylor_operand *of, const uint32_t *order,
                      uint32_t m, double width, double turn, csg_taylor *out)
{
    csg_taylor sum = csg_taylor_constant(m * width);
    for (uint32_t i = 0; i < m; i++)
        sum = csg_taylor_sum(&sum, turn, &of[order[i]].f);
    double slack = 1e-6 * m * width;
    if (csg_taylor_walk_least(w, &sum) > sqrt(m) * width + slack)
        *out = csg_taylor_constant(turn * width);
    else if (csg_taylor_walk_most(w, &sum) < width - slack)
        *out = csg_taylor_constant(-turn * width);
    else
        return false;
    return true;
}

/* How many touch at the centre. */
static uint32_t count_touching(const csg_taylor_operand *of, const uint32_t *order, uint32_t count,
                               double width, double turn)
{
    double sum = 0, squares = 0, level = 0;
    uint32_t m = 0;
    for (; m < count; m++) {
        double f = turn * of[order[m]].f.value;
        if (m && !(width + f - level > 0))
            break;
        sum += f;
        squares += f * f;
        double mean = sum / (m + 1), rest = width * width - (squares - sum * mean);
        level = width + mean - sqrt(fmax(rest, 0) / (m + 1));
    }
    return m;
}

enum { OPEN_MOST = 2 /* operands of which it is open whether they touch */ };

/* G is where the sum of (w + f_i - G)_+^2 is w^2, so it grows with every operand that is added, and
 * would be larger were all squares counted. So an operand that some others' level is out of reach
 * of never touches, and one that is above the level of all that may touch, all counted, always
 * does. The others do or do not: at each point the set that agrees with its own level is the one.
 */
static bool combine_round(csg_taylor_walk *w, const csg_tape_node *node)
{
    csg_taylor_operand *of = &w->stack[w->top - node->arity];
    double width = csg_tape_number(w->tape, node->parameters + CSG_OPERATOR_N);
    double turn = node->op == CSG_OP_ROUND_UNION ? 1 : -1,
           off = 2 * csg_taylor_walk_length_off(w, width);
    uint32_t order[CSG_TAYLOR_NODES], may[CSG_TAYLOR_NODES], open[OPEN_MOST], m,
        may_count = 0, count = 0, open_count = 0;
    csg_taylor level, most;
    sort_operands(of, node->arity, turn, order);
    for (m = count_touching(of, order, node->arity, width, turn);
         m > 1 && !all_touch(w, of, order, m, width, turn, &level); m--)
        continue;
    if (m == 1)
        level = of[order[0]].f;
    for (uint32_t i = 0; i < node->arity; i++) {
        touch t = find_touch(w, &of[order[i]], &level, width, turn);
        if (i < m || !(t.over.value < -t.reach))
            may[may_count++] = order[i];
    }
    uint32_t in[CSG_TAYLOR_NODES];
    bool has_most = may_count > m && find_level(w, of, may, may_count, width, turn, &most);
    for (uint32_t i = 0; i < may_count; i++) {
        bool is_in = may_count == m;
        if (has_most) {
            touch t = find_touch(w, &of[may[i]], &most, width, turn);
            is_in = t.over.value > t.reach;
        }
        if (is_in)
            in[count++] = may[i];
        else if (open_count == OPEN_MOST)
            return false;
        else
            open[open_count++] = may[i];
    }
    bool possible[1 << OPEN_MOST];
    for (uint32_t i = 0; i < 1u << open_count; i++)
        possible[i] = i || count;
    int which = csg_taylor_walk_choose(w, possible, 1 << open_count);
    if (which < 0)
        return false;
    for (uint32_t i = 0; i < open_count; i++)
        if (which >> i & 1)
            in[count++] = open[i];
    bool is_nowhere_zero = false;
    if (!find_level(w, of, in, count, width, turn, &level)) {
        is_nowhere_zero =
            w->signs[node - w->tape->nodes] && find_sign(w, of, in, count, width, turn, &level);
        if (!is_nowhere_zero)
            return false;
    }
    for (uint32_t i = 0; i < open_count; i++) {
        bool is_in = which >> i & 1;
        const csg_taylor *from = is_nowhere_zero ? &of[order[0]].f : &level;
        if (is_nowhere_zero && (!is_in || open[i] == order[0]))
            continue; /* what is known of levels is that they are above the largest */
        touch t = find_touch(w, &of[open[i]], from, width, turn);
        csg_taylor g = csg_taylor_scaled(&t.over, is_in ? 1 : -1);
        csg_taylor_walk_require(w, &g, off);
    }
    if (count == 1) {
        of[0] = of[in[0]];
    } else {
        bool is_creased = false;
        for (uint32_t i = 0; i < count; i++)
            is_creased |= of[in[i]].is_creased;
        of[0].f = level;
        of[0].is_leaf = false;
        of[0].is_creased = is_creased;
    }
    return true;
}

/* Half of the sum of these squares less w^2, over w, turned: with what is known of w. */
static csg_taylor half_sum_of_squares(const csg_taylor_walk *w, const csg_taylor *over,
                                      uint32_t count, double width, double turn)
{
    const double of_length = csg_taylor_walk_length_off(w, 1), of_shares = 4 * of_length;
    csg_taylor sum = csg_taylor_constant(-width * width);
    double most = 2 * width, shares = 0;
    for (uint32_t i = 0; i < count; i++) {
        csg_taylor square = csg_taylor_square(&over[i], w->radius);
        double largest = csg_taylor_walk_most(w, &over[i]);
        sum = csg_taylor_sum(&sum, 1, &square);
        most += largest * (1 + largest / width);
        shares += 1 + largest / width;
    }
    sum = csg_taylor_scaled(&sum, 0.5 * turn / width);
    sum.error += of_length * most;
    sum.turned += of_shares * shares;
    return sum;
}

/* Where nothing but its sign matters: G is positive where the sum of (w + f_i)_+^2 is more than
 * w^2, which is smoother than G is: of planes a polynomial of second order. False: too many
 * operands may count or not. */
static bool combine_signs(csg_taylor_walk *w, const csg_tape_node *node)
{
    csg_taylor_operand *of = &w->stack[w->top - node->arity];
    double width = csg_tape_number(w->tape, node->parameters + CSG_OPERATOR_N);
    double turn = node->op == CSG_OP_ROUND_UNION ? 1 : -1,
           off = 2 * csg_taylor_walk_length_off(w, width);
    csg_taylor over[CSG_TAYLOR_NODES], open[OPEN_MOST];
    uint32_t open_at[OPEN_MOST], open_count = 0, count = 0, only = 0;
    bool is_creased = false, possible[1 << OPEN_MOST] = {true, true, true, true};
    for (uint32_t i = 0; i < node->arity; i++) {
        csg_taylor above = csg_taylor_raised(csg_taylor_scaled(&of[i].f, turn), width);
        double reach = csg_taylor_reach(&above, w->radius);
        if (above.value < -reach)
            continue;
        if (above.value > reach) {
            over[count++] = above;
            only = i;
            is_creased |= of[i].is_creased;
        } else if (open_count == OPEN_MOST) {
            return false;
        } else {
            open_at[open_count] = i;
            open[open_count++] = above;
        }
    }
    int which = csg_taylor_walk_choose(w, possible, 1 << open_count);
    if (which < 0)
        return false;
    for (uint32_t i = 0; i < open_count; i++) {
        bool is_in = which >> i & 1;
        csg_taylor condition = csg_taylor_scaled(&open[i], is_in ? 1 : -1);
        csg_taylor_walk_require(w, &condition, off);
        if (!is_in)
            continue;
        over[count++] = open[i];
        only = open_at[i];
        is_creased |= of[open_at[i]].is_creased;
    }
    if (count == 1) {
        of[0] = of[only];
        return true;
    }
    of[0].f = count ? half_sum_of_squares(w, over, count, width, turn)
                    : csg_taylor_constant(-turn * width);
    of[0].is_known = true;
    of[0].is_leaf = false;
    of[0].is_creased = is_creased;
    return true;
}

/* Where sums of squares are closer to their polynomials. G is off by the fourth power of how far
 * gradients are apart, over w^3, and they by the square of what operands bend, over w, so that it
 * is they at edges and G where one surface goes on from another. Along the normal they bend, as G
 * does not: in a ball that is not small beside w they are no graph. */
static bool prefers_squares(const csg_taylor_walk *w, const csg_tape_node *node)
{
    static const double SMALL = 0.6;
    const csg_taylor_operand *of = &w->stack[w->top - node->arity];
    double width = csg_tape_number(w->tape, node->parameters + CSG_OPERATOR_N);
    double turn = node->op == CSG_OP_ROUND_UNION ? 1 : -1, apart = 0, bent = 0;
    uint32_t may[CSG_TAYLOR_NODES], count = 0;
    if (!(w->radius < SMALL * width))
        return false;
    for (uint32_t i = 0; i < node->arity; i++)
        if (turn * of[i].f.value + width + csg_taylor_reach(&of[i].f, w->radius) > 0)
            may[count++] = i;
    for (uint32_t i = 0; i < count; i++) {
        const csg_taylor *a = &of[may[i]].f;
        double square = 0;
        for (int n = 0; n < CSG_TAYLOR_SECOND; n++)
            square += (n < 3 ? 1 : 2) * a->bend[n] * a->bend[n];
        bent = fmax(bent, square);
        for (uint32_t k = 0; k < i; k++) {
            const double *b = of[may[k]].f.slope;
            const double d[3] = {a->slope[0] - b[0], a->slope[1] - b[1], a->slope[2] - b[2]};
            apart = fmax(apart, csg_dot3(d, d));
        }
    }
    return sqrt(bent) * width < apart || count < 2;
}

bool csg_taylor_walk_round(csg_taylor_walk *w, const csg_tape_node *node)
{
    bool signs = w->signs[node - w->tape->nodes] && prefers_squares(w, node);
    if (!are_known(&w->stack[w->top - node->arity], node->arity) ||
        !(signs ? combine_signs(w, node) : combine_round(w, node)))
        return false;
    w->top -= node->arity - 1;
    return true;
}

/* ---- fillets -----------------------------------------------------------------------------------
 */

/* 1 - cos of the angle between two unit gradients. False: they are none. */
static bool find_turn(const csg_taylor_walk *w, const csg_taylor_operand *a,
                      const csg_taylor_operand *b, csg_taylor *out)
{
    static const double UNIT = 1e-6, ROUNDING = 0x1p-23 /* of directions by floats */;
    const csg_taylor_operand *both[2] = {a, b};
    csg_smooth pieces[2];
    double off = ROUNDING;
    for (int i = 0; i < 2; i++) {
        double square = 0;
        csg_smooth_choice choice = {.way = both[i]->way};
        if (!both[i]->is_leaf || !csg_taylor_walk_leaf(w, both[i]->leaf, true,
                                                       w->may_decide ? &choice : NULL, &pieces[i]))
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
static bool fillet_two(const csg_taylor_walk *w, const csg_taylor *a, const csg_taylor *b,
                       const csg_taylor *d, double r, double turn, csg_taylor *out)
{
    csg_taylor difference = csg_taylor_sum(a, -1, b), inverse, under, root;
    csg_taylor rest = csg_taylor_raised(csg_taylor_scaled(d, -1), 2);
    csg_taylor square = csg_taylor_square(&difference, w->radius);
    if (!csg_taylor_inverse(d, w->radius, &inverse))
        return false;
    under = csg_taylor_product(&square, &inverse, w->radius);
    under = csg_taylor_raised(csg_taylor_scaled(&under, -1), 2 * r * r);
    under = csg_taylor_product(&rest, &under, w->radius);
    if (!csg_taylor_root(&under, w->radius, &root))
        return false;
    *out = csg_taylor_walk_mean(a, b, -0.5 * turn, &root);
    csg_taylor_walk_share(
        a, b, 0.5 * turn * rest.value * inverse.value * difference.value / root.value, out);
    *out = csg_taylor_raised(*out, turn * r);
    csg_taylor_walk_add_length(w, r, out);
    return true;
}

/* Where nothing but its sign matters: with s = (a + b) / 2 + r positive all over the cube a fillet
 * has the sign of
 *   d s^2 + (2 - d) (x^2 - 2 d r^2) / 4
 * over 2 d s, which of planes is a polynomial of second order. False: s may be negative. */
static bool fillet_sign(const csg_taylor_walk *w, const csg_taylor *a, const csg_taylor *b,
                        const csg_taylor *d, double r, double turn, csg_taylor *out)
{
    const double of_length = csg_taylor_walk_length_off(w, 1), of_shares = 4 * of_length;
    csg_taylor s = csg_taylor_sum(a, 1, b), x = csg_taylor_sum(a, -1, b);
    s = csg_taylor_raised(csg_taylor_scaled(&s, 0.5 * turn), r);
    double most_s = csg_taylor_walk_most(w, &s), most_d = csg_taylor_walk_most(w, d);
    if (!(csg_taylor_walk_least(w, &s) > 0) || !(d->value > 0))
        return false;
    const csg_taylor rest = csg_taylor_raised(csg_taylor_scaled(d, -1), 2);
    csg_taylor squares = csg_taylor_square(&s, w->radius), under = csg_taylor_square(&x, w->radius);
    squares = csg_taylor_product(&squares, d, w->radius);
    under = csg_taylor_sum(&under, -2 * r * r, d);
    under = csg_taylor_product(&under, &rest, w->radius);
    double scale = 0.5 / (d->value * s.value);
    *out = csg_taylor_sum(&squares, 0.25, &under);
    *out = csg_taylor_scaled(out, turn * scale);
    out->error += of_length * r * scale * most_d * 2 * (most_s + r);
    out->turned += of_shares * scale * 2 * (most_d * r + (most_s + r) * r * csg_norm3(d->slope));
    return true;
}

/* How far the operand that reaches farthest does so beyond the fillet's plane p. */
static double beyond_of(const csg_taylor_walk *w, const csg_taylor_operand *of,
                        const uint32_t *which, uint32_t count, uint32_t p)
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
static int find_end(const csg_taylor_walk *w, const csg_tape_node *node,
                    const csg_taylor_operand *of, const uint32_t pair[2], double turn,
                    csg_taylor *out)
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
static bool is_flush(const csg_taylor_walk *w, const csg_tape_node *node, csg_taylor_operand *of,
                     const uint32_t *all, double turn)
{
    uint32_t count = node->arity - node->planes;
    for (uint32_t p = count; p < node->arity; p++) {
        double beyond = beyond_of(w, of, all, count, p);
        for (uint32_t k = 0; k < count && isfinite(beyond) && of[p].is_known; k++) {
            if (!of[k].is_known)
                continue;
            csg_taylor d = csg_taylor_sum(&of[k].f, -1, &of[p].f);
            d.value -= turn * beyond;
            double apart = csg_taylor_walk_apart(w, &d);
            if (!isfinite(apart))
                continue;
            of[0] = of[k];
            csg_taylor_walk_add_apart(w, &of[0].f, apart + BEYOND_ROUNDING * fabs(beyond));
            return true;
        }
    }
    return false;
}

/* How the two largest operands meet. */
typedef enum meeting {
    FIRST,    /* it is alone */
    SECOND,   /* it is */
    BLENDING, /* at the turn *d */
    FLUSH,    /* as good as one, up to *more */
    UNKNOWN
} meeting;

static meeting find_meeting(csg_taylor_walk *w, const csg_taylor_operand *a,
                            const csg_taylor_operand *b, double r, double turn, csg_taylor *d,
                            double *more)
{
    static const double ROUNDING = 2e-6; /* 1 - cos of an angle that is no more than that */
    csg_taylor x = csg_taylor_sum(&a->f, -1, &b->f), inside[2];
    if (turn * x.value - csg_taylor_reach(&x, w->radius) > CSG_FILLET_PAIR_REACH * r)
        return FIRST;
    if (!find_turn(w, a, b, d) || !(csg_taylor_walk_most(w, d) < CSG_FILLET_FADE))
        return UNKNOWN;
    bool is_creased =
        a->is_creased || b->is_creased; /* so the turn may jump, and with it a fillet */
    if (!is_creased && csg_taylor_walk_most(w, d) < ROUNDING &&
        isfinite(csg_taylor_walk_apart(w, &x))) {
        /* what is added is most where both are equal, r d / 4 and a little */
        *more = csg_taylor_walk_apart(w, &x) + 0.26 * r * csg_taylor_walk_most(w, d);
        return FLUSH;
    }
    bool possible[] = {false, false, true};
    for (int i = 0; i < 2; i++) { /* r d - x, r d + x: where the other one is near enough */
        inside[i] = csg_taylor_scaled(&x, i ? turn : -turn);
        inside[i] = csg_taylor_sum(&inside[i], r, d);
        possible[i] = !(csg_taylor_walk_least(w, &inside[i]) > 0);
        possible[BLENDING] &= csg_taylor_walk_most(w, &inside[i]) > 0;
    }
    if (is_creased && possible[BLENDING])
        return UNKNOWN;
    int way = csg_taylor_walk_choose(w, possible, 3);
    double off = 0x1p-22 * r;
    for (int i = 0; i < 2 && way == BLENDING; i++)
        if (possible[i])
            csg_taylor_walk_require(w, &inside[i], off);
    if (way == FIRST || way == SECOND) {
        csg_taylor beyond = csg_taylor_scaled(&inside[way], -1);
        if (possible[BLENDING] || possible[1 - way])
            csg_taylor_walk_require(w, &beyond, off);
    }
    return way < 0 ? UNKNOWN : (meeting)way;
}

/* Solids that do not meet do not blend. */
static bool do_meet(const csg_taylor_walk *w, const csg_tape_node *node,
                    const csg_taylor_operand *a, const csg_taylor_operand *b)
{
    const csg_tape *tape = w->tape;
    float planes_once = tape->parameters[node->parameters + CSG_FILLET_PLANES_ONCE];
    return !csg_fillet_has_apart(tape, node) ||
           !csg_fillet_rows_apart(tape->parameters, tape->nodes[a->node].join_parameters,
                                  tape->nodes[b->node].join_parameters, (uint32_t)planes_once);
}

static bool is_larger(const csg_taylor_walk *w, const csg_taylor *a, const csg_taylor *b,
                      double turn)
{
    csg_taylor over = csg_taylor_sum(a, -1, b);
    return turn * over.value > csg_taylor_reach(&over, w->radius);
}

/* Where a plane ends the fillet of two it must be above both, or one of them decides again. */
static bool blend_pair(const csg_taylor_walk *w, const csg_tape_node *node,
                       const csg_taylor_operand *of, const uint32_t pair[2], const csg_taylor *d,
                       double r, double turn, bool signs, csg_taylor *out)
{
    const csg_taylor *a = &of[pair[0]].f, *b = &of[pair[1]].f;
    if (!(signs && fillet_sign(w, a, b, d, r, turn, out)) && !fillet_two(w, a, b, d, r, turn, out))
        return false;
    int ended = find_end(w, node, of, pair, turn, out);
    for (int i = 0; i < 2 && ended > 0; i++)
        if (!is_larger(w, out, &of[pair[i]].f, turn))
            return false;
    return ended >= 0;
}

/* The largest operand alone, or two that blend and no third one near. */
bool csg_taylor_walk_fillet(csg_taylor_walk *w, const csg_tape_node *node, bool signs)
{
    const float *parameters = w->tape->parameters + node->parameters;
    csg_taylor_operand *of = &w->stack[w->top - node->arity];
    double r = csg_tape_number(w->tape, node->parameters + CSG_OPERATOR_N), more = 0;
    double turn = node->op == CSG_OP_FILLET_UNION ? 1 : -1;
    uint32_t order[CSG_TAYLOR_NODES], count = node->arity - node->planes;
    csg_taylor d = {.value = 0}, out = {.value = 0};
    w->top -= node->arity - 1;
    for (uint32_t i = 0; i < count; i++)
        order[i] = i;
    if (signs && is_flush(w, node, of, order, turn))
        return true;
    if (parameters[CSG_FILLET_IS_SKEWED] != 0 || !count || !are_known(of, node->arity))
        return false;
    sort_operands(of, count, turn, order);
    const csg_taylor_operand *a = &of[order[0]];
    for (uint32_t i = 2; i < count; i++) {
        csg_taylor x = csg_taylor_sum(&a->f, -1, &of[order[i]].f);
        if (!(turn * x.value - csg_taylor_reach(&x, w->radius) > 2 * r))
            return false;
    }
    meeting how = FIRST;
    if (count > 1 && do_meet(w, node, a, &of[order[1]]))
        how = find_meeting(w, a, &of[order[1]], r, turn, &d, &more);
    else if (count > 1) /* the larger one, with a crease between them */
        how = is_larger(w, &a->f, &of[order[1]].f, turn) ? FIRST : UNKNOWN;
    if (how == UNKNOWN ||
        (how == BLENDING && !blend_pair(w, node, of, order, &d, r, turn, signs, &out)))
        return false;
    of[0] = how == SECOND ? of[order[1]] : *a;
    if (how == BLENDING) {
        of[0].f = out;
        of[0].is_leaf = false;
    }
    csg_taylor_walk_add_apart(w, &of[0].f, more);
    return true;
}
