/* SPDX-License-Identifier: MIT
 * Gradients through rules; see slopes.h. A gradient of G(a, b) is G_a times one of a plus G_b times
 * one of b, so all are in the sum of two sets: the hulls of an operand's balls times the least and
 * the largest that its partial derivative can be in the region (field/gradients/rule_slopes.h).
 * Those of EXTERIOR and INTERIOR add up to 1, so that theirs are mixtures of pairs, but these are
 * no shares: a gradient may lie beyond both operands'. A combined formula's are found by intervals.
 *
 * Values along a triangle leave what its corners say by the operands' own, times the partial
 * derivatives, and by what G is not linear by: an eighth of its second derivatives times the
 * squares of what operands vary by over the corners, or a fourth of what the partial derivatives
 * vary by, times that.
 */
#include <math.h>

#include "field/gradients/bend_formula.h"
#include "field/gradients/cone_formula.h"
#include "field/gradients/rule_slopes.h"
#include "field/rule_layout.h"
#include "mesh/distance/slopes_private.h"
#include "scene/operators/blend_kinds.h"
#include "scene/operators/rule.h"

typedef csg_slopes_operand operand;
typedef csg_slopes_walker walker;
typedef csg_slopes_range range;
typedef csg_slopes_which which;

enum {
    FEW_BALLS = 4, /* of an operand; each of a pair makes two with each of the other's */
    MOST_OPERANDS = 3
};

static const double ROUNDING = 2e-6; /* of a field's value */
static const which WHICH[] = {CSG_SLOPES_MIDDLE, CSG_SLOPES_LOW, CSG_SLOPES_HIGH, CSG_SLOPES_LEAST,
                              CSG_SLOPES_MOST};

/* ---- sets of gradients -------------------------------------------------------------------------
 */

/* One ball around those whose hull is meant. */
static void gather(csg_cone_balls *balls)
{
    balls->items[0] = csg_slopes_ball_around(balls);
    balls->count = 1;
}

/* Combinations by weights that add up to 1 and more, none of them longer than `longest`, are in the
 * hull of the balls and of these as much longer as the weights can be. False: too many, or no axis.
 */
static bool lengthen(csg_cone_balls *balls, double longest)
{
    double times = 2 * balls->count > FEW_BALLS ? INFINITY : csg_slopes_weight(balls, longest);
    if (!(times < INFINITY))
        return false;
    for (uint32_t i = 0, count = balls->count; i < count; i++) {
        csg_cone_ball *out = &balls->items[balls->count++];
        for (int k = 0; k < 3; k++)
            out->at[k] = times * balls->items[i].at[k];
        out->spread = times * balls->items[i].spread;
    }
    return true;
}

/* An operand's gradients as a few balls whose hull holds them: where these are no hull, of two also
 * longer ones, or one around the axis that they have in common, or else around 0. */
static void make_plain(operand *o)
{
    if (csg_slopes_exceed_hull(o)) {
        csg_cone_ball one;
        if (!lengthen(&o->balls, o->longest)) {
            if (!csg_slopes_enclose(&o->balls, o->longest, &one))
                one = (csg_cone_ball){.at = {0, 0, 0}, .spread = o->longest};
            o->balls.items[0] = one;
            o->balls.count = 1;
        }
        o->balls.corner = 0;
        o->balls.has_edges = o->stretched = o->faces = false;
    } else if (o->balls.count > FEW_BALLS) {
        gather(&o->balls);
    }
}

/* The same of one that is multiplied alone: what is longer than the hull, as where faces meet, is
 * so by weights that add up to more than 1; times a number it is no longer than its longest. */
static void make_alone(operand *o)
{
    if (!csg_slopes_exceed_hull(o) || 2 * o->balls.count > CSG_CONE_MOST)
        make_plain(o);
}

static bool is_nothing(const csg_cone_balls *balls)
{
    double most = 0;
    for (uint32_t i = 0; i < balls->count; i++)
        most = fmax(most, csg_norm3(balls->items[i].at) + balls->items[i].spread);
    return !(most > 0);
}

/* Times what lies in `by`: one ball where that hardly varies, else two. */
static void multiply(csg_cone_balls *balls, range by)
{
    static const double NARROW = 0.3; /* of the largest */
    double size = fmax(fabs(by.low), fabs(by.high)), half = 0.5 * (by.high - by.low);
    csg_cone_balls from = *balls;
    bool is_narrow = 2 * half <= NARROW * size;
    balls->count = 0;
    for (uint32_t i = 0; i < from.count; i++)
        for (int end = 0; end < (is_narrow ? 1 : 2); end++) {
            csg_cone_ball *out = &balls->items[balls->count++];
            double times = is_narrow ? 0.5 * (by.low + by.high) : end ? by.high : by.low;
            for (int k = 0; k < 3; k++)
                out->at[k] = times * from.items[i].at[k];
            out->spread = is_narrow
                              ? size * from.items[i].spread + half * csg_norm3(from.items[i].at)
                              : fabs(times) * from.items[i].spread;
        }
}

/* All sums of pairs. */
static void add(csg_cone_balls *to, csg_cone_balls *other)
{
    if (to->count * other->count > CSG_CONE_MOST)
        gather(to->count > other->count ? to : other);
    if (to->count * other->count > CSG_CONE_MOST)
        gather(to->count > other->count ? to : other);
    csg_cone_balls from = *to;
    to->count = 0;
    for (uint32_t i = 0; i < from.count; i++)
        for (uint32_t j = 0; j < other->count; j++) {
            csg_cone_ball *out = &to->items[to->count++];
            for (int k = 0; k < 3; k++)
                out->at[k] = from.items[i].at[k] + other->items[j].at[k];
            out->spread = from.items[i].spread + other->items[j].spread;
        }
}

static void add_combination(csg_cone_balls *to, const csg_cone_ball *a, const csg_cone_ball *b,
                            double share)
{
    csg_cone_ball *out = &to->items[to->count++];
    for (int k = 0; k < 3; k++)
        out->at[k] = share * a->at[k] + (1 - share) * b->at[k];
    out->spread = fabs(share) * a->spread + fabs(1 - share) * b->spread;
}

/* Those of the least and of the largest share, or where they are near to each other one ball. */
static void combine_pairs(csg_cone_balls *to, const csg_cone_balls *other, range share)
{
    static const double NARROW = 0.3;
    csg_cone_balls from = *to;
    double half = 0.5 * (share.high - share.low);
    to->count = 0;
    for (uint32_t i = 0; i < from.count; i++)
        for (uint32_t j = 0; j < other->count; j++) {
            const csg_cone_ball *a = &from.items[i], *b = &other->items[j];
            add_combination(to, a, b, half > 0.5 * NARROW ? share.low : share.low + half);
            if (half > 0.5 * NARROW)
                add_combination(to, a, b, share.high);
            else
                to->items[to->count - 1].spread += half * csg_slopes_balls_apart(a, b);
        }
}

/* ---- values ------------------------------------------------------------------------------------
 */

/* What an operand can be anywhere in the region. */
static csg_rule_range range_of(const operand *o)
{
    return (csg_rule_range){o->least - o->doubt, o->most + o->doubt};
}

/* By how much its values at the corners of the triangle, moved within the region, can differ. */
static double variation(const walker *w, const operand *o)
{
    const csg_vec3 *v = w->region.triangle;
    double most = 0;
    for (int i = 0; i < 3; i++) {
        csg_vec3 side = csg_vec3_sub(v[(i + 1) % 3], v[i]);
        double length = csg_vec3_norm(side);
        if (csg_slopes_exceed_hull(o))
            most = fmax(most, o->longest * length);
        for (uint32_t k = 0; k < o->balls.count; k++) {
            const csg_cone_ball *ball = &o->balls.items[k];
            const csg_vec3 g = {ball->at[0], ball->at[1], ball->at[2]};
            most = fmax(most, fabs(csg_vec3_dot(g, side)) + ball->spread * length);
        }
    }
    return most;
}

static double size_of(range a)
{
    return fmax(fabs(a.low), fabs(a.high));
}

/* By no more than that values along the triangle leave what the corners say, where only is known
 * between what derivatives are. */
static double parting_of(const range *by, const double *varies, uint32_t count)
{
    double parted = 0;
    for (uint32_t i = 0; i < count; i++)
        parted += 0.25 * (by[i].high - by[i].low) * varies[i];
    return parted;
}

/* How far operands whose own values are off move the result, and by what it is not linear by, which
 * is `parted` at most. bend: sizes of second derivatives, of all pairs; by: of each operand. */
static void find_sag(const operand *of, const range *by, const double *varies, uint32_t count,
                     double bend[MOST_OPERANDS][MOST_OPERANDS], double parted, operand *out)
{
    double kink = 0, sag = 0, bent = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (size_of(by[i]) > 0) {
            kink += size_of(by[i]) * of[i].kink;
            sag += size_of(by[i]) * of[i].sag;
        }
        for (uint32_t k = 0; k < count; k++)
            if (varies[i] > 0 && varies[k] > 0)
                bent += 0.125 * bend[i][k] * varies[i] * varies[k];
    }
    bool is_bent = bent <= parted;
    out->kink = kink + (is_bent ? 0 : parted);
    out->sag = sag + (is_bent ? bent : 0);
}

/* What it is at a corner of the operands' ranges is the least, or the most, but for what an operand
 * with a slope of the other sign can do. */
static void set_values(operand *out, const double at[5], const operand *of, const range *by,
                       uint32_t count)
{
    double fall = 0, fall_all = 0;
    for (uint32_t i = 0; i < count; i++) {
        double against = fmax(0, -by[i].low);
        fall += against * (of[i].high - of[i].low);
        fall_all += against * (of[i].most - of[i].least);
    }
    out->value = at[CSG_SLOPES_MIDDLE];
    out->low = at[CSG_SLOPES_LOW] - fall - out->doubt;
    out->high = at[CSG_SLOPES_HIGH] + fall + out->doubt;
    out->least = at[CSG_SLOPES_LEAST] - fall_all;
    out->most = at[CSG_SLOPES_MOST] + fall_all;
}

/* ---- fields ------------------------------------------------------------------------------------
 */

void csg_slopes_deliver(walker *w, const csg_tape_node *node)
{
    operand *o = &w->stack[w->top - 1];
    csg_curve_slopes slope;
    double at[5];
    csg_deliver_find_slopes(w->tape, node, range_of(o), &slope);
    make_alone(o);
    range by = {slope.least, slope.most};
    double varies = variation(w, o);
    double bend[MOST_OPERANDS][MOST_OPERANDS] = {{slope.bend}};
    find_sag(o, &by, &varies, 1, bend, parting_of(&by, &varies, 1), o);
    for (int k = 0; k < 5; k++)
        at[k] = csg_deliver_value(w->tape, node, csg_slopes_value(o, WHICH[k]));
    multiply(&o->balls, by);
    o->longest *= size_of(by);
    const float *own = w->tape->parameters + node->parameters;
    const float *delivery = node->op == CSG_OP_SOFTEN ? own : own + CSG_RULE_DELIVER;
    double scale = (double)delivery[CSG_DELIVER_SCALE], shift = (double)delivery[CSG_DELIVER_SHIFT];
    o->doubt = size_of(by) * o->doubt + ROUNDING * (fabs(scale) + fabs(shift));
    bool turns = scale < 0;
    o->value = at[CSG_SLOPES_MIDDLE];
    o->low = at[turns ? CSG_SLOPES_HIGH : CSG_SLOPES_LOW] - o->doubt;
    o->high = at[turns ? CSG_SLOPES_LOW : CSG_SLOPES_HIGH] + o->doubt;
    o->least = at[turns ? CSG_SLOPES_MOST : CSG_SLOPES_LEAST];
    o->most = at[turns ? CSG_SLOPES_LEAST : CSG_SLOPES_MOST];
}

/* Whether an operand with such a partial derivative takes part. */
static bool counts(const operand *o, range by)
{
    return size_of(by) > 0 && !is_nothing(&o->balls);
}

/* The gradients of a join: one operand's alone, or sums. */
static void join_gradients(operand *a, operand *b, const range by[2], bool is_sharp, operand *out)
{
    bool is_a = !counts(b, by[1]), is_b = !is_a && !counts(a, by[0]);
    const operand *alone = is_b ? b : a;
    if (is_a || is_b) {
        make_alone(is_b ? b : a);
    } else {
        make_plain(a);
        make_plain(b);
    }
    out->longest = size_of(by[is_b]) * alone->longest;
    out->balls = alone->balls;
    if (is_a || is_b) {
        out->faces = alone->faces;
        out->stretched = alone->stretched;
        multiply(&out->balls, by[is_b]);
    } else if (is_sharp) {
        combine_pairs(&out->balls, &b->balls, by[0]);
        out->longest = fmax(a->longest, b->longest);
    } else {
        multiply(&out->balls, by[0]);
        multiply(&b->balls, by[1]);
        add(&out->balls, &b->balls);
        out->longest += size_of(by[1]) * b->longest;
    }
}

static bool join_fields(walker *w, const csg_tape_node *node)
{
    operand *a = &w->stack[w->top - 2], *b = a + 1;
    csg_join_slopes slopes;
    double at[5];
    if (!csg_join_find_slopes(w->tape, node, range_of(a), range_of(b), &slopes))
        return false;
    const range by[2] = {{slopes.by[0].low, slopes.by[0].high},
                         {slopes.by[1].low, slopes.by[1].high}};
    const double varies[2] = {variation(w, a), variation(w, b)};
    double bend[MOST_OPERANDS][MOST_OPERANDS] = {{slopes.bend[0], slopes.bend[1]},
                                                 {slopes.bend[1], slopes.bend[2]}};
    operand out = {.doubt = size_of(by[0]) * a->doubt + size_of(by[1]) * b->doubt + ROUNDING};
    for (int k = 0; k < 5; k++)
        at[k] = csg_join_value(w->tape, node, csg_slopes_value(a, WHICH[k]),
                               csg_slopes_value(b, WHICH[k]));
    find_sag(a, by, varies, 2, bend, parting_of(by, varies, 2), &out);
    set_values(&out, at, a, by, 2);
    join_gradients(a, b, by, node->join_blend == CSG_BLEND_FIELD_SHARP, &out);
    *a = out;
    w->top--;
    return true;
}

/* ---- lengths -----------------------------------------------------------------------------------
 */

static csg_rule rule_of(const walker *w, const csg_tape_node *node)
{
    const float *own = w->tape->parameters + node->join_parameters;
    csg_rule rule = {.kind = node->join_blend};
    bool is_exterior = node->join_blend == CSG_BLEND_EXTERIOR;
    rule.parameters[0] = (double)own[is_exterior ? CSG_SMOOTH_DELTA : CSG_SMOOTH_EPS];
    rule.parameters[1] = (double)own[CSG_SMOOTH_EPS];
    rule.step.kind = (csg_step_kind)own[CSG_SMOOTH_STEP];
    rule.step.parameter = (double)own[CSG_SMOOTH_DEGREE];
    return rule;
}

static bool join_lengths(walker *w, const csg_tape_node *node)
{
    operand *a = &w->stack[w->top - 2], *b = a + 1;
    const csg_rule rule = rule_of(w, node);
    double turn = node->join == CSG_JOIN_UNION ? 1 : -1, at[5], partials[2], share[2];
    double k = (double)(w->tape->parameters + node->join_parameters)[CSG_SMOOTH_K];
    double reach = csg_slopes_reach(w, a, b), t = turn * (a->value - b->value);
    double support = csg_rule_support(&rule), rounding = 1e-5;
    w->top--;
    csg_rule_bound_share(&rule, k, t - reach - rounding * support, t + reach + rounding * support,
                         share);
    if (share[0] == share[1] && (share[0] == 0 || share[0] == 1)) {
        if (share[0] == 0)
            *a = *b;
        return true;
    }
    const range by[2] = {{share[0] - rounding, share[1] + rounding},
                         {1 - share[1] - rounding, 1 - share[0] + rounding}};
    double parted = 0.25 * (share[1] - share[0]) * csg_slopes_parting(w, a, b);
    make_plain(a);
    make_plain(b);
    operand out = {.doubt = k * fmax(a->doubt, b->doubt) + rounding * support,
                   .longest = k * fmax(a->longest, b->longest)};
    for (int i = 0; i < 5; i++) {
        const double values[2] = {turn * csg_slopes_value(a, WHICH[i]),
                                  turn * csg_slopes_value(b, WHICH[i])};
        at[i] = turn * csg_rule_apply(&rule, true, values, 2, 0, partials);
    }
    set_values(&out, at, a, by, 2);
    double bend[MOST_OPERANDS][MOST_OPERANDS] = {{INFINITY, INFINITY}, {INFINITY, INFINITY}};
    const double varies[2] = {variation(w, a), variation(w, b)};
    find_sag(a, by, varies, 2, bend, parted, &out);
    out.balls = a->balls;
    combine_pairs(&out.balls, &b->balls, by[0]);
    *a = out;
    return true;
}

bool csg_slopes_join_rule(walker *w, const csg_tape_node *node)
{
    bool is_smooth =
        node->join_blend == CSG_BLEND_EXTERIOR || node->join_blend == CSG_BLEND_INTERIOR;
    return is_smooth ? join_lengths(w, node) : join_fields(w, node);
}

/* ---- formulas of operands ----------------------------------------------------------------------
 */

/* The operands as the formula has them: times their scale. */
static csg_cone_box place_operands(const operand *of, uint32_t count, double scale)
{
    csg_cone_box at = {{0, 0, 0}, {0, 0, 0}};
    for (uint32_t k = 0; k < count; k++) {
        csg_rule_range values = range_of(&of[k]);
        double low = scale * values.low, high = scale * values.high;
        at.low[k] = (float)(fmin(low, high) - 1e-6 * fabs(low));
        at.high[k] = (float)(fmax(low, high) + 1e-6 * fabs(high));
    }
    return at;
}

/* What the result can be less and more than at c, where its operands can be so much farther. */
static range change_of(const range *by, double (*farther)[2], uint32_t count)
{
    range all = {0, 0};
    for (uint32_t k = 0; k < count; k++) {
        double low = fmin(by[k].high * farther[k][0], by[k].low * farther[k][1]);
        double high = fmax(by[k].low * farther[k][0], by[k].high * farther[k][1]);
        all.low += fmin(low, 0);
        all.high += fmax(high, 0);
    }
    return all;
}

/* The derivatives of the result by its operands, `times` those of the formula, within what their
 * sizes add up to. False: nothing is known. */
static bool find_shares(const walker *w, const csg_tape_node *node, const csg_cone_box *at,
                        double times, range by[MOST_OPERANDS], bool *has_edges)
{
    static const csg_cone_box UNITS[3] = {
        {{1, 0, 0}, {1, 0, 0}}, {{0, 1, 0}, {0, 1, 0}}, {{0, 0, 1}, {0, 0, 1}}};
    const csg_tape_formula *formula = csg_tape_formula_of(w->tape, node);
    double most = fabs(times) * (double)formula->lipschitz;
    csg_cone_box shares;
    if (!csg_cone_formula(w->tape, formula, at, UNITS, NULL, &shares, has_edges))
        return false;
    for (uint32_t k = 0; k < node->arity; k++) {
        double low = times * (double)shares.low[k], high = times * (double)shares.high[k];
        double room = 1e-6 * fmax(fabs(low), fabs(high));
        by[k] = (range){fmax(fmin(low, high) - room, -most), fmin(fmax(low, high) + room, most)};
    }
    return true;
}

/* Whether the result moves with its first two operands, where both move alike, as blends do that
 * depend on their difference: then their derivatives add up to the same everywhere. *share: that of
 * the first one; sizes add up to `most`. */
static bool find_pair(const walker *w, const csg_tape_node *node, const csg_cone_box *at,
                      double times, const range by[2], double *sum, range *share)
{
    static const csg_cone_box ALIKE[3] = {
        {{1, 0, 0}, {1, 0, 0}}, {{1, 0, 0}, {1, 0, 0}}, {{0, 0, 0}, {0, 0, 0}}};
    static const double SAME = 1e-5;
    const csg_tape_formula *formula = csg_tape_formula_of(w->tape, node);
    csg_cone_box along;
    bool has_edges = false;
    if (node->arity < 2 || !csg_cone_formula(w->tape, formula, at, ALIKE, NULL, &along, &has_edges))
        return false;
    double low = (double)along.low[0], high = (double)along.high[0];
    if (!(low > 0) || high - low > SAME * low)
        return false;
    *sum = 0.5 * times * (low + high);
    double k = fabs(times) * (double)formula->lipschitz / fabs(*sum);
    range first = {by[0].low / *sum, by[0].high / *sum};
    range other = {1 - by[1].high / *sum, 1 - by[1].low / *sum};
    share->low =
        fmax(fmax(fmin(first.low, first.high), fmin(other.low, other.high)), 0.5 - 0.5 * k);
    share->high =
        fmin(fmin(fmax(first.low, first.high), fmax(other.low, other.high)), 0.5 + 0.5 * k);
    share->high = fmax(share->low, share->high) + SAME;
    share->low -= SAME;
    return true;
}

/* The sum of all operands' gradients, of a pair as mixtures. */
static void combine_gradients(operand *of, const range *by, uint32_t count, bool is_pair,
                              double sum, range share)
{
    uint32_t next = 1;
    if (is_pair) {
        combine_pairs(&of[0].balls, &of[1].balls, share);
        multiply(&of[0].balls, (range){sum, sum});
        next = 2;
    } else {
        multiply(&of[0].balls, by[0]);
    }
    for (uint32_t k = next; k < count; k++) {
        multiply(&of[k].balls, by[k]);
        add(&of[0].balls, &of[k].balls);
    }
}

bool csg_slopes_combine(walker *w, const csg_tape_node *node)
{
    const float *own = w->tape->parameters + node->parameters;
    operand *of = &w->stack[w->top - node->arity];
    range by[MOST_OPERANDS], share;
    bool has_edges = false;
    if (node->arity > MOST_OPERANDS)
        return false;
    double scale = (double)own[CSG_LEAF_FRAME], times = scale * (double)own[CSG_LEAF_SIGMA];
    const csg_cone_box at = place_operands(of, node->arity, scale);
    if (!find_shares(w, node, &at, times, by, &has_edges))
        return false;
    double varies[MOST_OPERANDS], near[MOST_OPERANDS][2], far[MOST_OPERANDS][2];
    double bend[MOST_OPERANDS][MOST_OPERANDS] = {{0}}, norm = INFINITY, sum = 0, parted = 0;
    bool is_pair = find_pair(w, node, &at, times, by, &sum, &share);
    operand out = {.longest = 0, .doubt = 0};
    for (uint32_t k = 0; k < node->arity; k++) {
        csg_rule_range all = range_of(&of[k]);
        near[k][0] = of[k].low - of[k].value;
        near[k][1] = of[k].high - of[k].value;
        far[k][0] = all.low - of[k].value;
        far[k][1] = all.high - of[k].value;
        make_plain(&of[k]);
        varies[k] = variation(w, &of[k]);
        out.longest += size_of(by[k]) * of[k].longest;
        out.doubt += size_of(by[k]) * of[k].doubt;
    }
    if (!has_edges && csg_bend_formula(w->tape, csg_tape_formula_of(w->tape, node), &at, &norm))
        norm *= scale * scale * fabs((double)own[CSG_LEAF_SIGMA]);
    for (uint32_t k = 0; k < node->arity;
         k++) /* a quadratic form is no more than it times squares */
        bend[k][k] = norm;
    if (is_pair)
        parted =
            0.25 * fabs(sum) * (share.high - share.low) * csg_slopes_parting(w, &of[0], &of[1]);
    uint32_t rest = is_pair ? 2 : 0;
    parted += parting_of(by + rest, varies + rest, node->arity - rest);
    find_sag(of, by, varies, node->arity, bend, parted, &out);
    combine_gradients(of, by, node->arity, is_pair, sum, share);
    out.balls = of[0].balls;
    out.value = csg_slopes_value_of_node(w, node);
    out.doubt += 1e-6 * (fabs(out.value) + fabs((double)own[CSG_LEAF_RAISE]));
    range over = change_of(by, near, node->arity), all = change_of(by, far, node->arity);
    out.low = out.value + over.low - out.doubt;
    out.high = out.value + over.high + out.doubt;
    out.least = out.value + all.low;
    out.most = out.value + all.high;
    w->top -= node->arity - 1;
    of[0] = out;
    return true;
}
