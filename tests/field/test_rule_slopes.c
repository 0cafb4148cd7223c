/* SPDX-License-Identifier: MIT
 * What derivatives of rules can be over ranges (field/gradients/rule_slopes.h,
 * csg_rule_bound_share) against the reference's at random places of these, and that bounds a fifth
 * nearer to their middle would not hold.
 */
#include <math.h>
#include <string.h>

#include "field/compile/compile_rule.h"
#include "field/field_support.h"
#include "field/gradients/rule_slopes.h"
#include "rounds.h"
#include "scene/operators/blend_kinds.h"
#include "scene/operators/rule.h"
#include "scene/random_rule.h"

enum { PLACES = 40, BOXES = ROUNDS(700), PARAMETERS = CSG_RULE_MOST_PARAMETERS };

static const double WITHIN = 0.8; /* of a bound */

/* How near places came to the bounds: how often beyond WITHIN. */
typedef struct nearness {
    uint32_t slopes, bends, known_bends;
} nearness;

static double uniform(csg_random *random, double low, double high)
{
    return csg_random_uniform(random, low, high);
}

static csg_rule_range random_range(csg_random *random, double low, double high)
{
    double half = 0.5 * (high - low) * exp(uniform(random, -7, 0));
    double middle = uniform(random, low, high);
    return (csg_rule_range){fmax(low, middle - half), fmin(high, middle + half)};
}

/* Ends as often as what is between. */
static double place_in(csg_random *random, csg_rule_range r)
{
    double along = uniform(random, -0.5, 1.5);
    return r.low + (r.high - r.low) * fmin(fmax(along, 0), 1);
}

static void check_slope(double slope, csg_rule_range bound, double room, nearness *near,
                        const char *what)
{
    double middle = 0.5 * (bound.low + bound.high), half = 0.5 * (bound.high - bound.low);
    if (!(slope >= bound.low - room && slope <= bound.high + room))
        fail_msg("%s: a slope of %.9g, not %.9g to %.9g", what, slope, bound.low, bound.high);
    near->slopes += fabs(slope - middle) > WITHIN * half + room;
}

static void check_bend(double size, double bound, double room, nearness *near, const char *what)
{
    if (!(bound < INFINITY))
        return;
    if (size > bound * (1 + room) + room)
        fail_msg("%s: a second derivative of %g, not %g", what, size, bound);
    near->known_bends++;
    near->bends += size > WITHIN * bound + room;
}

/* ---- joins -------------------------------------------------------------------------------------
 */

typedef struct subject {
    csg_rule rule;
    bool is_union;
    float parameters[PARAMETERS];
    csg_tape_node node; /* the operator; as a child its join, too */
    csg_tape tape;
} subject;

static csg_rule random_rule(csg_random *random, csg_blend_kind kind)
{
    csg_rule rule = csg_rule_standard(kind);
    double *v = rule.parameters;
    if (kind == CSG_BLEND_RICCI) {
        v[0] = (double[]){1, 2, 3, 6, uniform(random, 1, 12)}[csg_random_below(random, 5)];
    } else if (kind == CSG_BLEND_SCALE_SET) {
        v[0] = uniform(random, 0.05, 1);
        v[1] = uniform(random, 0.05, 1);
        v[2] = v[0] * v[1] * uniform(random, -2, 0.9);
    } else if (kind == CSG_BLEND_ARC) {
        v[0] = uniform(random, 2, 44);
        v[1] = uniform(random, 46, 88);
        test_random_profile(random, &rule, 0.93, 1.07);
    }
    return rule;
}

static void make_subject(csg_random *random, csg_blend_kind kind, bool is_union, subject *s)
{
    uint32_t tape_kind;
    memset(s->parameters, 0, sizeof s->parameters);
    s->rule = random_rule(random, kind);
    s->is_union = is_union;
    csg_rule_settle(&s->rule);
    csg_rule_pack(&s->rule, is_union, 1, INFINITY, &tape_kind, s->parameters);
    csg_deliver_pack(CSG_FORM_FIELD, false, 1, 0, s->parameters + CSG_RULE_DELIVER);
    s->node = (csg_tape_node){.op = is_union ? CSG_OP_RULE_UNION : CSG_OP_RULE_INTERSECTION,
                              .join = is_union ? CSG_JOIN_UNION : CSG_JOIN_INTERSECTION,
                              .blend = (uint8_t)tape_kind,
                              .join_blend = (uint8_t)tape_kind,
                              .arity = 2};
    s->tape = (csg_tape){.nodes = &s->node, .parameters = s->parameters, .count = 1};
}

/* Partial derivatives of the whole operator, N and all. */
static void partials_at(const subject *s, double x, double y, double partials[2])
{
    csg_rule_apply(&s->rule, s->is_union, (double[]){x, y}, 2, 0, partials);
}

/* Of N(G): N' G_i, and N'' G_i G_k + N' G_ik. */
static void try_box(const subject *s, csg_random *random, nearness *near, const char *what)
{
    static const double STEP = 1e-6;
    static const double NOTHING = 1e-6; /* at 0 itself derivatives are a convention */
    csg_rule_range x = random_range(random, 0, 1), y = random_range(random, 0, 1);
    csg_join_slopes join;
    csg_curve_slopes after;
    assert_true(csg_join_find_slopes(&s->tape, &s->node, x, y, &join));
    /* N of what the join makes, which rises but for a profile */
    double least = INFINITY, most = -INFINITY;
    for (int i = 0; i < 4; i++) {
        double g =
            csg_join_value(&s->tape, &s->node, i & 1 ? x.high : x.low, i & 2 ? y.high : y.low);
        least = fmin(least, g);
        most = fmax(most, g);
    }
    csg_deliver_find_slopes(&s->tape, &s->node, (csg_rule_range){least - 1e-6, most + 1e-6},
                            &after);
    if (s->node.blend != CSG_BLEND_SCALE_SET && s->node.blend != CSG_BLEND_SOFT_SET)
        after = (csg_curve_slopes){1, 1, 0}; /* the reference does not cut off at 1 */
    for (int i = 0; i < PLACES; i++) {
        double at[2] = {fmax(NOTHING, place_in(random, x)), fmax(NOTHING, place_in(random, y))};
        double partials[2], beside[2];
        partials_at(s, at[0], at[1], partials);
        for (int k = 0; k < 2; k++) {
            csg_rule_range bound = {
                fmin(join.by[k].low * after.least, join.by[k].low * after.most),
                fmax(join.by[k].high * after.least, join.by[k].high * after.most)};
            check_slope(partials[k], bound, 2e-4, near, what);
            /* not where it may be beyond an end, or at a crease */
            double other[2] = {at[0], at[1]};
            other[k] += STEP;
            if (!(other[k] <= (k ? y.high : x.high)))
                continue;
            partials_at(s, other[0], other[1], beside);
            for (int m = 0; m < 2; m++) {
                double slopes = fmax(fabs(join.by[k].low), fabs(join.by[k].high)) *
                                fmax(fabs(join.by[m].low), fabs(join.by[m].high));
                double most_bend = after.bend * slopes + after.most * join.bend[k + m];
                check_bend(fabs(beside[m] - partials[m]) / STEP, most_bend, 2e-3, near, what);
            }
        }
    }
}

/* Kinds of which second derivatives are known (but 0). */
static bool is_curved(csg_blend_kind kind)
{
    return kind == CSG_BLEND_RICCI || kind == CSG_BLEND_PERLIN || kind == CSG_BLEND_SCALE_SET ||
           kind == CSG_BLEND_ARC || kind == CSG_BLEND_SOFT_SET;
}

static void slopes_of_joins_hold(void **state)
{
    (void)state;
    static const struct {
        csg_blend_kind kind;
        const char *name;
    } rules[] = {
#define CSG_RULE(NAME, name, space, fold, interval, demand, lipschitz, equal, doc)                 \
    {CSG_BLEND_##NAME, #name},
#include "scene/operators/operators.def"
    };
    csg_random random = {.state = 71};
    for (size_t r = 0; r < sizeof rules / sizeof *rules; r++) {
        csg_blend_kind kind = rules[r].kind;
        if (!csg_blend_takes_fields(kind))
            continue;
        for (int is_union = 0; is_union < 2; is_union++) {
            nearness near = {0, 0, 0};
            if (csg_rule_works_on_complements(kind, is_union))
                continue; /* the same join again */
            for (int i = 0; i < BOXES; i++) {
                subject s;
                make_subject(&random, kind, is_union, &s);
                try_box(&s, &random, &near, rules[r].name);
            }
            if (kind != CSG_BLEND_SOFT_SUM && near.slopes == 0)
                fail_msg("%s: no slope is near its bound", rules[r].name);
            if (is_curved(kind) && near.bends == 0)
                fail_msg("%s: of %u no second derivative is near its bound", rules[r].name,
                         near.known_bends);
        }
    }
}

/* ---- functions of one value --------------------------------------------------------------------
 */

/* The derivative in double of a soft node or of N. */
typedef double slope_at(const void *what, double at);

static double soft_slope(const void *what, double at)
{
    double slope;
    csg_soft_at(*(const csg_soft *)what, at, &slope);
    return slope;
}

static double operand_slope(const void *what, double at)
{
    double slope;
    csg_operand_field(*(const csg_operand *)what, at, &slope);
    return slope;
}

static double sum_slope(const void *what, double at)
{
    double slope;
    (void)what;
    csg_normalise_soft(at, &slope);
    return slope;
}

static double scale_slope(const void *what, double at)
{
    double slope;
    csg_normalise_scale(at, *(const double *)what, &slope);
    return slope;
}

static void try_range(const csg_tape *tape, csg_rule_range at, slope_at *slope, const void *what,
                      csg_random *random, nearness *near, const char *name)
{
    static const double STEP = 1e-6;
    csg_curve_slopes found;
    csg_deliver_find_slopes(tape, tape->nodes, at, &found);
    for (int i = 0; i < PLACES; i++) {
        double v = place_in(random, at), by = slope(what, v);
        check_slope(by, (csg_rule_range){found.least, found.most}, 2e-4, near, name);
        if (v + STEP <= at.high)
            check_bend(fabs(slope(what, v + STEP) - by) / STEP, found.bend, 2e-3, near, name);
    }
}

static void slopes_of_deliveries_hold(void **state)
{
    (void)state;
    enum { CURVES = CSG_FALLOFF_COUNT + 2, KINDS = CURVES + 3 };
    nearness near[KINDS] = {{0}};
    csg_random random = {.state = 72};
    for (int i = 0; i < KINDS * BOXES; i++) {
        float parameters[PARAMETERS] = {0};
        int kind = i % KINDS;
        bool softens = kind < CURVES;
        csg_tape_node node = {.op = softens ? CSG_OP_SOFTEN : CSG_OP_RULE_UNION, .arity = 1};
        csg_tape tape = {.nodes = &node, .parameters = parameters, .count = 1};
        csg_soft soft = {(csg_falloff)kind, uniform(&random, 0.3, 3)};
        csg_operand operand = {uniform(&random, 0.3, 3), kind == CSG_FALLOFF_COUNT};
        csg_deliver_pack(CSG_FORM_VALUE, false, 1, 0,
                         parameters + (softens ? 0 : CSG_RULE_DELIVER));
        csg_rule_range at = random_range(&random, softens ? -3 : 0, softens ? 3 : 1);
        if (kind < CSG_FALLOFF_COUNT) {
            node.blend = csg_soften_pack_soft(soft, 1, parameters);
            try_range(&tape, at, soft_slope, &soft, &random, &near[kind], "soft");
        } else if (softens) {
            node.blend = csg_soften_pack_operand(operand, 1, parameters);
            try_range(&tape, at, operand_slope, &operand, &random, &near[kind], "an operand");
        } else if (kind == CURVES) {
            node.blend = CSG_BLEND_SOFT_SET;
            try_range(&tape, at, sum_slope, NULL, &random, &near[kind], "N_A");
        } else { /* with and without turning, by a right angle */
            csg_rule rule = random_rule(&random, CSG_BLEND_SCALE_SET);
            const double *v = rule.parameters;
            uint32_t tape_kind;
            rule.parameters[3] = kind == CURVES + 1 ? 0 : 0.1;
            csg_rule_settle(&rule);
            csg_rule_pack(&rule, false, 1, INFINITY, &tape_kind, parameters);
            node.blend = (uint8_t)tape_kind;
            double s = v[3] > 0 ? 1.1 : 1;
            double top = csg_scale_top(v[0] * s, v[1] * s, v[2] / (v[0] * v[1]));
            try_range(&tape, at, scale_slope, &top, &random, &near[kind], "N_S");
        }
    }
    for (int k = 0; k < KINDS; k++)
        if (!near[k].slopes || (!near[k].bends && k != CSG_FALLOFF_COUNT))
            fail_msg("kind %d: %u slopes and %u bends near their bounds", k, near[k].slopes,
                     near[k].bends);
}

/* ---- lengths -----------------------------------------------------------------------------------
 */

static void shares_hold(void **state)
{
    (void)state;
    const test_step_ranges ranges = {10, 8, 6};
    csg_random random = {.state = 73};
    nearness near[2] = {{0}};
    char problem[160];
    for (int i = 0; i < 4 * BOXES; i++) {
        csg_rule rule = csg_rule_standard(i % 2 ? CSG_BLEND_EXTERIOR : CSG_BLEND_INTERIOR);
        rule.step = test_random_step(&random, ranges);
        rule.parameters[0] = uniform(&random, 0.2, 2);
        rule.parameters[1] = rule.parameters[0] * uniform(&random, 0.1, 1.3);
        if (csg_rule_problem(&rule, problem, sizeof problem))
            rule.parameters[1] = rule.parameters[0];
        csg_rule_settle(&rule);
        csg_rule_range t = random_range(&random, -4, 4);
        double share[2], partials[2];
        csg_rule_bound_share(&rule, rule.k[0], t.low, t.high, share);
        for (int k = 0; k < PLACES; k++) {
            double lead = place_in(&random, t), y = uniform(&random, -1, 1);
            csg_rule_apply(&rule, true, (double[]){y + lead, y}, 2, 0, partials);
            check_slope(partials[0], (csg_rule_range){share[0], share[1]}, 1e-6, &near[i % 2],
                        csg_rule_name(rule.kind));
        }
    }
    assert_true(near[0].slopes > 1000 && near[1].slopes > 1000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(slopes_of_joins_hold),
        cmocka_unit_test(slopes_of_deliveries_hold),
        cmocka_unit_test(shares_hold),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
