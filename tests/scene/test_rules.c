/* SPDX-License-Identifier: MIT
 * What operators.def says of rules, by sampling: monotone where stated, K never exceeded, partial
 * derivatives against central differences, commutative where stated, the operand bit for bit where
 * nothing blends, continuous and G1, enclosures that hold.
 *
 * Arguments: points for each rule (default 400), a number that is added to the seeds (default 0).
 */
#include "scene/operators/blend_kinds.h"
#include "scene/operators/rule.h"
#include "scene_support.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "random_rule.h"
#include "rounds.h"

/* tools/soak has many more, of other seeds. */
static int point_count = 400;
static uint64_t seed_of_run = 0;

enum { RULES = ROUNDS(200), MOST = 5 };

typedef struct sample {
    csg_random *random;
    csg_rule rule;
    bool is_union;
    size_t count;
    double values[MOST];
} sample;

static double uniform(csg_random *random, double low, double high)
{
    return csg_random_uniform(random, low, high);
}

/* Within the ranges of operators.def. */
static csg_rule random_rule(csg_random *random, csg_blend_kind kind)
{
    csg_rule rule = csg_rule_standard(kind);
    double *v = rule.parameters;
    rule.step = test_random_step(random, (test_step_ranges){1, 8, 5});
    if (kind == CSG_BLEND_EXTERIOR) {
        char text[160];
        v[0] = uniform(random, 0.05, 1);
        v[1] = v[0] * uniform(random, 0.1, 1.7);
        if (csg_rule_problem(&rule, text, sizeof text)) /* too wide for the step */
            v[1] = v[0];
        if (rule.step.kind == CSG_STEP_SIGMOID)
            v[1] = fmin(v[1], rule.step.parameter * v[0] / 10.001);
    } else if (kind == CSG_BLEND_INTERIOR) {
        v[0] = uniform(random, 0.05, 1);
    } else if (kind == CSG_BLEND_RICCI) {
        v[0] = uniform(random, 1, 8);
    } else if (kind == CSG_BLEND_SCALE_SET) {
        v[3] = csg_random_below(random, 3) ? 0 : uniform(random, 0.01, 1);
        v[0] = uniform(random, 0.05, v[3] > 0 ? 0.5 : 1);
        v[1] = uniform(random, 0.05, v[3] > 0 ? 0.5 : 1);
        v[2] = v[0] * v[1] * uniform(random, -3, 0.9);
    } else if (kind == CSG_BLEND_ARC) {
        v[0] = uniform(random, 1, 40);
        v[1] = uniform(random, 50, 89);
        test_random_profile(random, &rule, 0.8, 1.15);
    }
    char text[160];
    const char *problem = csg_rule_problem(&rule, text, sizeof text);
    assert_null(problem);
    csg_rule_settle(&rule);
    return rule;
}

/* Fields between 0 and 1, now and then at the ends; lengths that differ by about the support. */
static void random_values(sample *s)
{
    double reach = csg_blend_takes_fields(s->rule.kind) ? 1 : csg_rule_support(&s->rule);
    for (size_t i = 0; i < s->count; i++) {
        s->values[i] = uniform(s->random, 0, fmin(reach, 2));
        if (reach == 1 && csg_random_below(s->random, 20) == 0)
            s->values[i] = csg_random_below(s->random, 3) / 2.0;
    }
}

static double apply(const sample *s, const double *values, double *partials)
{
    return csg_rule_apply(&s->rule, s->is_union, values, s->count, 0.3, partials);
}

typedef void law(sample *s);

static void for_each_rule(law *check)
{
    csg_random random = {20260901 + seed_of_run};
    for (csg_blend_kind kind = CSG_BLEND_EXTERIOR; kind < CSG_BLEND_END; kind++) {
        if (kind == CSG_BLEND_PROFILE)
            continue;
        for (int i = 0; i < RULES; i++) {
            sample s = {.random = &random, .rule = random_rule(&random, kind), .count = 2};
            s.is_union = i % 2 || !csg_blend_takes_fields(kind);
            if (!csg_rule_is_fold(kind))
                s.count = 2 + csg_random_below(&random, MOST - 1);
            for (int k = 0; k < point_count; k++) {
                random_values(&s);
                check(&s);
            }
        }
    }
}

static void failed(const sample *s, const char *what, double a, double b)
{
    char text[400];
    size_t used = (size_t)snprintf(text, sizeof text, "%s %s of %zu:", csg_rule_name(s->rule.kind),
                                   s->is_union ? "union" : "intersection", s->count);
    for (int i = 0; i < CSG_RULE_PARAMETERS; i++)
        used += (size_t)snprintf(text + used, sizeof text - used, " %.10g", s->rule.parameters[i]);
    used += (size_t)snprintf(text + used, sizeof text - used, " %s(%g) at",
                             csg_step_name(s->rule.step.kind), s->rule.step.parameter);
    for (size_t i = 0; i < s->count; i++)
        used += (size_t)snprintf(text + used, sizeof text - used, " %.17g", s->values[i]);
    fail_msg("%s: %s: %.17g, %.17g", text, what, a, b);
}

/* ---- slopes -----------------------------------------------------------------------------------
 */

/* Sums of the partial derivatives' sizes within K; none below 0 where it is monotone. */
static void slope_law(sample *s)
{
    double partials[MOST], ones[MOST] = {1, 1, 1, 1, 1}, total = 0, least = 0;
    apply(s, s->values, partials);
    double k = csg_rule_slope(&s->rule, s->is_union, ones, s->count);
    for (size_t i = 0; i < s->count; i++) {
        total += fabs(partials[i]);
        least = fmin(least, partials[i]);
    }
    if (!(total <= k * (1 + 1e-9)))
        failed(s, "K", total, k);
    bool monotone = s->rule.monotone[!s->is_union] || s->rule.kind == CSG_BLEND_SCALE_SET;
    if (monotone && !(least >= -1e-9))
        failed(s, "monotone", least, 0);
}

static void test_slopes(void **state)
{
    for_each_rule(slope_law);
}

/* Secants between two points: what slopes that are wrong everywhere alike would hide. */
static void secant_law(sample *s)
{
    double other[MOST], partials[MOST], ones[MOST] = {1, 1, 1, 1, 1}, most = 0;
    bool above = true;
    double scale = csg_random_below(s->random, 2) ? 1 : 1e-3;
    for (size_t i = 0; i < s->count; i++) {
        double next = s->values[i] + scale * uniform(s->random, -0.2, 0.4);
        other[i] = csg_blend_takes_fields(s->rule.kind) ? fmin(fmax(next, 0), 1) : next;
        most = fmax(most, fabs(other[i] - s->values[i]));
        above &= other[i] >= s->values[i];
    }
    double a = apply(s, s->values, partials), b = apply(s, other, partials);
    double k = csg_rule_slope(&s->rule, s->is_union, ones, s->count);
    if (!(fabs(b - a) <= k * most * (1 + 1e-9) + 1e-13))
        failed(s, "secant beyond K", fabs(b - a), k * most);
    if (above && s->rule.monotone[!s->is_union] && !(b >= a - 1e-13))
        failed(s, "monotone", a, b);
}

static void test_secants(void **state)
{
    for_each_rule(secant_law);
}

/* Not across a crease, where the two one-sided derivatives differ. */
static void derivative_law(sample *s)
{
    double partials[MOST], room[MOST], values[MOST];
    const double h = 1e-6;
    bool sharp = s->rule.kind == CSG_BLEND_FIELD_SHARP || s->rule.kind == CSG_BLEND_ARC_SHARP;
    bool rough = !csg_blend_takes_fields(s->rule.kind) && s->rule.step.parameter < 2;
    if (csg_random_below(s->random, 5) || sharp || rough)
        return;
    for (size_t i = 0; i < s->count; i++)
        if (csg_blend_takes_fields(s->rule.kind) && !(s->values[i] > 0.02 && s->values[i] < 0.98))
            return;
    apply(s, s->values, partials);
    for (size_t i = 0; i < s->count; i++) {
        double ends[2];
        for (int side = 0; side < 2; side++) {
            memcpy(values, s->values, sizeof values);
            values[i] += side ? h : -h;
            ends[side] = apply(s, values, room);
        }
        double slope = (ends[1] - ends[0]) / (2 * h);
        if (!(fabs(slope - partials[i]) <= 2e-3))
            failed(s, "derivative", slope, partials[i]);
    }
}

static void test_derivatives(void **state)
{
    for_each_rule(derivative_law);
}

/* ---- operands ---------------------------------------------------------------------------------
 */

static bool is_commutative(const csg_rule *rule)
{
    const double *v = rule->parameters;
    switch (rule->kind) {
    case CSG_BLEND_EXTERIOR:
    case CSG_BLEND_INTERIOR:
        return rule->step.kind != CSG_STEP_RISING;
    case CSG_BLEND_SCALE_SET:
        return v[0] == v[1];
    case CSG_BLEND_ARC:
        return v[0] == 90 - v[1] && !rule->spline.count;
    default:
        return true;
    }
}

static void commutative_law(sample *s)
{
    double turned[MOST], partials[MOST];
    csg_rule kept = s->rule;
    if (s->rule.kind == CSG_BLEND_SCALE_SET) {
        s->rule.parameters[1] = s->rule.parameters[0];
        s->rule.parameters[2] = 0;
    }
    if (!is_commutative(&s->rule)) {
        s->rule = kept;
        return;
    }
    for (size_t i = 0; i < s->count; i++)
        turned[i] = s->values[s->count - 1 - i];
    double a = apply(s, s->values, partials), b = apply(s, turned, partials);
    if (!(fabs(a - b) <= 4e-15))
        failed(s, "commutative", a, b);
    s->rule = kept;
}

/* Where eps > delta both of its steps count: 7.2 as printed, of both operands as the larger one. */
static double printed_exterior(const csg_rule *rule, double x, double y)
{
    double delta = rule->parameters[0], eps = rule->parameters[1], t = x - y, slope;
    double g1 = csg_step_at(rule->step, (t + delta) / eps, &slope);
    double g2 = csg_step_at(rule->step, (t - delta) / eps, &slope);
    double p = t * t / (2 * delta) + delta / 2;
    return (x + y + (g1 + g2 - 1) * t + g1 * (1 - g2) * p) / 2;
}

static void test_wide_exterior(void **state)
{
    static const csg_step kinds[] = {{CSG_STEP_POLY, 1},
                                     {CSG_STEP_POLY, 3},
                                     {CSG_STEP_RISING, 2},
                                     {CSG_STEP_RISING2, 2},
                                     {CSG_STEP_BSPLINE, 5}};
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        csg_rule rule = csg_rule_standard(CSG_BLEND_EXTERIOR);
        double partials[2];
        rule.step = kinds[i];
        rule.parameters[0] = 0.2; /* a figure of Li's */
        rule.parameters[1] = 0.25;
        csg_rule_settle(&rule);
        for (double y = -0.7; y < 0.7; y += 0.003) {
            double g = csg_rule_apply(&rule, true, (double[]){0.1, y}, 2, 0, partials);
            test_near(g, printed_exterior(&rule, 0.1, y), 1e-15);
            assert_true(g >= fmax(0.1, y) && g <= fmax(0.1, y) + csg_rule_excess(&rule));
            assert_true(fabs(partials[0]) + fabs(partials[1]) <= rule.k[0]);
        }
    }
}

static void test_commutative(void **state)
{
    for_each_rule(commutative_law);
}

/* "equal" of operators.def. */
static double expected_operand(const sample *s)
{
    const double *x = s->values, *v = s->rule.parameters;
    double most = fmax(x[0], x[1]), least = fmin(x[0], x[1]), factor = 57.29577951308232;
    switch (s->rule.kind) {
    case CSG_BLEND_EXTERIOR:
    case CSG_BLEND_INTERIOR:
        return most - least >= csg_rule_support(&s->rule) ? most : NAN;
    case CSG_BLEND_SCALE_SET:
        if (v[3] > 0)
            return NAN;
        if (s->is_union)
            return NAN; /* only to rounding: 1 - (1 - x) */
        if (least <= 0.5 &&
            ((x[1] > (1 + v[1]) * x[0] * 1.000001) || (x[0] > (1 + v[0]) * x[1] * 1.000001)))
            return least;
        return NAN;
    case CSG_BLEND_ARC: {
        double angle = atan2(x[1], x[0]) * factor;
        if (angle > v[0] - 1e-9 && angle < v[1] + 1e-9)
            return NAN;
        return s->is_union ? (angle < 45 ? x[0] : x[1]) : (angle < 45 ? x[1] : x[0]);
    }
    case CSG_BLEND_ARC_SHARP:
        if (0.5 * least <= most * most && least * least <= 0.5 * most)
            return s->is_union ? most : least;
        return NAN;
    case CSG_BLEND_FIELD_SHARP:
        return s->count == 2 ? (s->is_union ? most : least) : NAN;
    default:
        return NAN;
    }
}

static void operand_law(sample *s)
{
    double partials[MOST], expected = expected_operand(s);
    double value = apply(s, s->values, partials);
    if (!isnan(expected) && value != expected)
        failed(s, "the operand itself", value, expected);
    if (csg_rule_is_fold(s->rule.kind) || !s->is_union)
        return;
    for (size_t i = 1; i < s->count; i++)
        s->values[i] = 0;
    if (s->rule.kind == CSG_BLEND_SOFT_SET)
        s->values[0] /= 2; /* larger fields are normalised alone, too */
    value = apply(s, s->values, partials);
    if (value != s->values[0])
        failed(s, "a lone operand", value, s->values[0]);
}

static void test_operands(void **state)
{
    for_each_rule(operand_law);
}

/* ---- smoothness -------------------------------------------------------------------------------
 */

/* Along a short way the partial derivatives change little: no jump where a zone ends. ARC_SHARP is
 * G1 with a steep second derivative, creased where both operands are 1/2. */
static void smooth_law(sample *s)
{
    double before[MOST], after[MOST], values[MOST];
    const double h = 1e-9;
    const double *v = s->rule.parameters;
    bool lengths = !csg_blend_takes_fields(s->rule.kind);
    if (s->rule.kind == CSG_BLEND_FIELD_SHARP || csg_random_below(s->random, 4) ||
        (lengths && (s->rule.step.kind == CSG_STEP_RISING || s->rule.step.parameter < 2)) ||
        s->rule.kind == CSG_BLEND_SCALE_SET)
        return;
    for (size_t i = 0; i < s->count; i++)
        if (!lengths && !(s->values[i] > 0.05 && s->values[i] < 0.95))
            return;
    if (lengths) /* at an end of the blend, or where the operands are equal */
        s->values[1] =
            s->values[0] + (csg_random_below(s->random, 2) ? csg_rule_support(&s->rule) : 0);
    if (s->rule.kind == CSG_BLEND_ARC) /* at the end of the transition */
        s->values[1] = s->values[0] * tan(v[csg_random_below(s->random, 2)] / 57.29577951308232);
    if (s->rule.kind == CSG_BLEND_ARC_SHARP)
        s->values[1] = 2 * s->values[0] * s->values[0];
    memcpy(values, s->values, sizeof values);
    values[0] += h;
    s->values[0] -= h;
    apply(s, s->values, before);
    apply(s, values, after);
    double room = s->rule.kind == CSG_BLEND_ARC_SHARP ? 2e-2 : 2e-3;
    if (s->rule.kind == CSG_BLEND_ARC_SHARP && fabs(values[0] - 0.5) < 0.02)
        return;
    for (size_t i = 0; i < s->count; i++)
        if (!(fabs(before[i] - after[i]) <= room))
            failed(s, "smooth", before[i], after[i]);
}

static void test_smooth(void **state)
{
    for_each_rule(smooth_law);
}

/* ---- enclosures -------------------------------------------------------------------------------
 */

static void enclosure_law(sample *s)
{
    double low[MOST], high[MOST], partials[MOST], out[2];
    double width = csg_random_below(s->random, 2) ? 0.5 : 0.02;
    double from = uniform(s->random, -1, 1), to = uniform(s->random, from, 1);
    const double cosines[2] = {from, to};
    for (size_t i = 0; i < s->count; i++) {
        low[i] = s->values[i];
        high[i] = low[i] + width * uniform(s->random, 0, 1);
        if (csg_blend_takes_fields(s->rule.kind))
            high[i] = fmin(high[i], 1);
    }
    csg_rule_enclose(&s->rule, s->is_union, low, high, s->count, cosines, partials, out);
    for (int k = 0; k < 6; k++) {
        for (size_t i = 0; i < s->count; i++) {
            double share = k < 4 ? uniform(s->random, 0, 1) : csg_random_below(s->random, 2);
            s->values[i] = low[i] + share * (high[i] - low[i]);
        }
        double value = csg_rule_apply(&s->rule, s->is_union, s->values, s->count,
                                      uniform(s->random, from, to), partials);
        double room = 1e-9 * (1 + fabs(value));
        if (!(value >= out[0] - room && value <= out[1] + room))
            failed(s, "enclosure", value, value < out[0] ? out[0] : out[1]);
    }
    memcpy(s->values, low, sizeof low);
}

static void test_enclosures(void **state)
{
    for_each_rule(enclosure_law);
}

/* ---- names, ranges ----------------------------------------------------------------------------
 */

static void check_problem(csg_rule rule, const char *expected)
{
    char text[160];
    const char *problem = csg_rule_problem(&rule, text, sizeof text);
    assert_int_equal(problem != NULL, expected != NULL);
    if (expected)
        assert_string_equal(problem, expected);
}

static void test_problems(void **state)
{
    csg_rule rule = csg_rule_standard(CSG_BLEND_SCALE_SET);
    rule.parameters[0] = 3;
    check_problem(rule, "r1 must be above 0 and at most 1, not 3");
    rule.parameters[0] = 0.5;
    rule.parameters[2] = 0.3;
    check_problem(rule, "p must be below r1 r2 = 0.25, not 0.3");
    rule = csg_rule_standard(CSG_BLEND_EXTERIOR);
    rule.parameters[1] = 2;
    check_problem(rule, NULL); /* H3 keeps its operands up to 2.0003 (operators.md 7.2) */
    rule.parameters[1] = 2.01;
    check_problem(rule, "eps must be at most 2 for delta = 1 and this step, not 2.01: the union "
                        "would lose some of its operands");
    rule.step = (csg_step){CSG_STEP_POLY, 1};
    check_problem(rule,
                  "eps must be at most 1.769 for delta = 1 and this step, not 2.01: the union "
                  "would lose some of its operands");
    rule.parameters[1] = 0.5;
    rule.step = (csg_step){CSG_STEP_POLY, 2.5};
    check_problem(rule, "the parameter of poly must be a whole number 1 to 8, not 2.5");
    rule = csg_rule_standard(CSG_BLEND_RICCI);
    rule.parameters[0] = NAN;
    check_problem(rule, "n must be 1 to 64, not nan");
    rule = csg_rule_standard(CSG_BLEND_ARC);
    rule.spline.count = 1;
    rule.spline.angle[0] = 80;
    rule.spline.factor[0] = 1;
    check_problem(rule,
                  "the angles of the profile must rise between 15 and 75 degrees, 80 does not");
}

/* Every rule is standard within its own ranges; K of the table is what the tables of operators.md
 * say for the standard step. */
static void test_standards(void **state)
{
    for (csg_blend_kind kind = CSG_BLEND_EXTERIOR; kind < CSG_BLEND_END; kind++) {
        csg_rule rule = csg_rule_standard(kind);
        char text[160];
        assert_null(csg_rule_problem(&rule, text, sizeof text));
        csg_rule_settle(&rule);
        csg_rule twice = csg_rule_scale(&rule, 2);
        bool fields = csg_blend_takes_fields(kind);
        if (kind != CSG_BLEND_PROFILE && !fields)
            test_near(csg_rule_support(&twice), 2 * csg_rule_support(&rule), 1e-12);
        assert_true(csg_blend_is_rule(kind));
    }
}

int main(int argc, char **argv)
{
    if (argc > 1)
        point_count = (int)strtol(argv[1], NULL, 10);
    if (argc > 2)
        seed_of_run = strtoull(argv[2], NULL, 10);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_slopes),      cmocka_unit_test(test_secants),
        cmocka_unit_test(test_derivatives), cmocka_unit_test(test_wide_exterior),
        cmocka_unit_test(test_commutative), cmocka_unit_test(test_operands),
        cmocka_unit_test(test_smooth),      cmocka_unit_test(test_enclosures),
        cmocka_unit_test(test_problems),    cmocka_unit_test(test_standards),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
