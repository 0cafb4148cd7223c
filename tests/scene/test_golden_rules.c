/* SPDX-License-Identifier: MIT
 * golden.csv: smooth unit steps and the two smooth maxima, field functions and gauges, arcs of
 * ellipses with and without profiles, sharp arcs, Ricci's, Hsu's and Perlin's operators, bulge
 * elimination; computed with 40 digits.
 */
#include "golden_rows.h"
#include "scene/operators/blend_kinds.h"
#include "scene/operators/rule.h"
#include "scene/operators/soft.h"
#include "scene/primitives/kinds.h"

#include "scene/primitives/primitive.h"

static const double tolerance = 1e-12;

static double golden_number(const char *text)
{
    return number(text); /* "1 (clamped)" too */
}

static bool is_number(const char *text)
{
    char *end;
    strtod(text, &end);
    return end != text;
}

/* "H3", "R2", "R2sq", "S10" */
static csg_step step_of(const char *text)
{
    csg_step step = {CSG_STEP_POLY, atof(text + 1)};
    if (text[0] == 'S')
        step.kind = CSG_STEP_SIGMOID;
    if (text[0] == 'R')
        step.kind = strstr(text, "sq") ? CSG_STEP_RISING2 : CSG_STEP_RISING;
    return step;
}

static csg_rule settled(csg_rule rule)
{
    char text[160];
    const char *problem = csg_rule_problem(&rule, text, sizeof text);
    assert_null(problem);
    csg_rule_settle(&rule);
    return rule;
}

static void check_step(const row *r)
{
    double slope, value = csg_step_at(step_of(r->fields[1]), number(r->fields[2]), &slope);
    test_near(value, number(r->fields[3]), tolerance);
    if (is_number(r->fields[4]))
        test_near(slope, number(r->fields[4]), tolerance);
}

/* With x = t and y = 0: 2 G - t = S. */
static void check_absolute(const row *r)
{
    csg_rule rule = csg_rule_standard(CSG_BLEND_EXTERIOR);
    double t = number(r->fields[4]), partials[2];
    rule.step = step_of(r->fields[1]);
    rule.parameters[0] = number(r->fields[2]);
    rule.parameters[1] = number(r->fields[3]);
    rule = settled(rule);
    double g = csg_rule_apply(&rule, true, (double[]){t, 0}, 2, 0, partials);
    test_near(2 * g - t, number(r->fields[5]), tolerance);
    if (is_number(r->fields[6]))
        test_near(2 * partials[0] - 1, number(r->fields[6]), tolerance);
}

/* Columns from `first`: x, y, G, dG/dx, dG/dy of a union, an intersection or a difference. */
static void check_lengths(const row *r, const csg_rule *rule, int first)
{
    double a = r->fields[1][0] == 'U' ? 1 : -1, b = r->fields[1][0] == 'I' ? -1 : 1, partials[2];
    double values[2] = {a * number(r->fields[first]), b * number(r->fields[first + 1])};
    double g = a * csg_rule_apply(rule, true, values, 2, 0, partials);
    test_near(g, number(r->fields[first + 2]), tolerance);
    test_near(a * a * partials[0], number(r->fields[first + 3]), tolerance);
    test_near(a * b * partials[1], number(r->fields[first + 4]), tolerance);
}

static void check_exterior(const row *r)
{
    csg_rule rule = csg_rule_standard(CSG_BLEND_EXTERIOR);
    rule.step = step_of(r->fields[2]);
    rule.parameters[0] = number(r->fields[3]);
    rule.parameters[1] = number(r->fields[4]);
    rule = settled(rule);
    check_lengths(r, &rule, 5);
}

static void check_interior(const row *r)
{
    csg_rule rule = csg_rule_standard(CSG_BLEND_INTERIOR);
    rule.step = step_of(r->fields[2]);
    rule.parameters[0] = number(r->fields[3]);
    rule = settled(rule);
    check_lengths(r, &rule, 4);
}

static void test_steps(void **state)
{
    for_each("step", 140, check_step);
    for_each("sabs", 45, check_absolute);
    for_each("ext", 48, check_exterior);
    for_each("int", 48, check_interior);
}

static void check_falloff(const row *r)
{
    int kind = 0;
    while (strcmp(csg_falloff_name((csg_falloff)kind), r->fields[1]) != 0)
        assert_true(++kind < CSG_FALLOFF_COUNT);
    double slope, value = csg_falloff_at((csg_falloff)kind, number(r->fields[2]), &slope);
    test_near(value, number(r->fields[3]), tolerance);
    if (is_number(r->fields[4]))
        test_near(slope, number(r->fields[4]), tolerance);
}

/* Exponent p, inner exponent q. */
static void check_gauge(const row *r)
{
    double v[6] = {0.7, 1.1, 0.4, number(r->fields[2]), number(r->fields[1]), 1};
    csg_refusal refusal = {0};
    assert_true(csg_primitive_of(CSG_NODE_SUPERELLIPSOID)->check(&refusal, v)); /* finds v[5] */
    csg_sample sample = csg_reference_primitive(CSG_NODE_SUPERELLIPSOID, v, point(r->fields[3]));
    test_near(1 - v[5] * sample.value, number(r->fields[4]), tolerance);
    test_near_vec3(csg_vec3_scale(sample.gradient, -v[5]), point(r->fields[5]), tolerance);
}

static void test_fields(void **state)
{
    for_each("field", 36, check_falloff);
    for_each("gauge", 15, check_gauge);
}

/* ---- arcs -------------------------------------------------------------------------------------
 */

static const double degrees = 57.295779513082320877;

static void check_fields(const csg_rule *rule, bool is_union, bool subtracts, const row *r,
                         int first)
{
    double values[2] = {number(r->fields[first]), number(r->fields[first + 1])}, partials[2];
    values[1] = subtracts ? 1 - values[1] : values[1];
    double g = csg_rule_apply(rule, is_union, values, 2, 0, partials);
    test_near(g, number(r->fields[first + 2]), tolerance);
    for (int i = 0; i < 2; i++)
        if (is_number(r->fields[first + 3 + i]))
            test_near(subtracts && i ? -partials[i] : partials[i], number(r->fields[first + 3 + i]),
                      tolerance);
}

static csg_rule arc_of(double tan1, double cot2)
{
    csg_rule rule = csg_rule_standard(CSG_BLEND_ARC);
    rule.parameters[0] = atan(tan1) * degrees;
    rule.parameters[1] = 90 - atan(cot2) * degrees;
    return settled(rule);
}

static void check_arc_union(const row *r)
{
    csg_rule rule = arc_of(number(r->fields[2]), number(r->fields[1]));
    check_fields(&rule, true, false, r, 3);
}

static void check_arc_intersection(const row *r)
{
    csg_rule rule = arc_of(1 / number(r->fields[2]), 1 / number(r->fields[3]));
    check_fields(&rule, false, r->fields[1][0] == 'D', r, 4);
}

/* The three points are (f1, f2) = (.46, .30), (.40, .42), (.28, .47). */
static void check_profile(const row *r)
{
    static const double at[3][2] = {{.46, .30}, {.40, .42}, {.28, .47}};
    csg_rule plain = arc_of(0.3, 0.2), rule = plain;
    double partials[2], slope;
    rule.spline.count = 3;
    for (int i = 0; i < 3; i++) {
        rule.spline.angle[i] = atan2(at[i][1], at[i][0]) * degrees;
        rule.spline.factor[i] = 0.5 / csg_rule_apply(&plain, true, at[i], 2, 0, partials);
    }
    rule = settled(rule);
    double theta = number(r->fields[4]), value = number(r->fields[5]);
    if (strncmp(r->fields[1], "knot", 4) == 0) {
        int knot = atoi(r->fields[1] + 5);
        test_near(rule.spline.angle[knot], theta, tolerance);
        test_near(rule.spline.factor[knot], value, tolerance);
        test_near(csg_spline_at(&rule.spline, theta, &slope), value, tolerance);
    } else {
        double values[2] = {number(r->fields[2]), number(r->fields[3])};
        test_near(csg_rule_apply(&rule, true, values, 2, 0, partials), value, tolerance);
    }
}

static void check_sharp(const row *r)
{
    csg_rule rule = settled(csg_rule_standard(CSG_BLEND_ARC_SHARP));
    check_fields(&rule, r->fields[1][0] == 'U', r->fields[1][0] == 'D', r, 2);
}

static void test_arcs(void **state)
{
    for_each("ghat_union", 40, check_arc_union);
    for_each("ghat_inter", 48, check_arc_intersection);
    for_each("gfinal", 15, check_profile);
    for_each("sharp", 33, check_sharp);
}

/* ---- sets of soft objects ---------------------------------------------------------------------
 */

static size_t read_values(const char *text, double *values)
{
    size_t count = 0;
    char *end;
    for (text++; *text; text = *end ? end + 1 : end) {
        values[count++] = strtod(text, &end);
        if (*end == ')')
            break;
    }
    return count;
}

static double applied(csg_blend_kind kind, double n, bool is_union, const double *values,
                      size_t count)
{
    csg_rule rule = csg_rule_standard(kind);
    double partials[8];
    if (kind == CSG_BLEND_RICCI)
        rule.parameters[0] = n;
    rule = settled(rule);
    return csg_rule_apply(&rule, is_union, values, count, 0, partials);
}

static void check_ricci(const row *r)
{
    double values[8], n = number(r->fields[1]);
    size_t count = read_values(r->fields[2], values);
    test_near(applied(CSG_BLEND_RICCI, n, true, values, count), number(r->fields[3]), tolerance);
    test_near(applied(CSG_BLEND_RICCI, n, false, values, count), number(r->fields[4]), tolerance);
}

static void check_sets(const row *r)
{
    double values[8], others[8];
    size_t count = read_values(r->fields[1], values);
    for (size_t i = 0; i < count; i++)
        others[i] = i ? 1 - values[i] : values[i];
    for (int family = 0; family < 2; family++) {
        csg_blend_kind kind = family ? CSG_BLEND_PERLIN : CSG_BLEND_SOFT_SET;
        char **expected = (char **)r->fields + 2 + 3 * family;
        test_near(applied(kind, 0, true, values, count), number(expected[0]), tolerance);
        test_near(applied(kind, 0, false, values, count), number(expected[1]), tolerance);
        test_near(applied(kind, 0, false, others, count), number(expected[2]), tolerance);
    }
}

static csg_rule scale_of(const row *r)
{
    csg_rule rule = csg_rule_standard(CSG_BLEND_SCALE_SET);
    for (int i = 0; i < 3; i++)
        rule.parameters[i] = number(r->fields[1 + i]);
    return settled(rule);
}

/* B is what the intersection is normalised from; below 1/2 it is the intersection. */
static void check_scale_function(const row *r)
{
    csg_rule rule = scale_of(r);
    const double *v = rule.parameters;
    double values[2] = {number(r->fields[4]), number(r->fields[5])}, partials[2], slope;
    double m = csg_scale_top(v[0], v[1], v[2] / (v[0] * v[1])), b = number(r->fields[6]);
    double expected = csg_normalise_scale(b, m, &slope);
    test_near(csg_rule_apply(&rule, false, values, 2, 0, partials), expected, tolerance);
    for (int i = 0; i < 2; i++)
        if (is_number(r->fields[7 + i]))
            test_near(partials[i], slope * number(r->fields[7 + i]), tolerance);
}

static void check_scale_operators(const row *r)
{
    csg_rule rule = scale_of(r);
    const double *v = rule.parameters;
    double x = number(r->fields[5]), y = number(r->fields[6]), partials[2];
    test_near(csg_scale_top(v[0], v[1], v[2] / (v[0] * v[1])), number(r->fields[4]), tolerance);
    test_near(csg_rule_apply(&rule, true, (double[]){x, y}, 2, 0, partials), number(r->fields[7]),
              tolerance);
    test_near(csg_rule_apply(&rule, false, (double[]){x, y}, 2, 0, partials), number(r->fields[8]),
              tolerance);
    test_near(csg_rule_apply(&rule, false, (double[]){x, 1 - y}, 2, 0, partials),
              number(r->fields[9]), tolerance);
}

static void check_normalised(const row *r)
{
    double slope, u = number(r->fields[1]);
    test_near(csg_normalise_soft(u, &slope), number(r->fields[2]), tolerance);
    test_near(csg_normalise_scale(u, 0.85, &slope), golden_number(r->fields[3]), tolerance);
}

/* r' = r (1 - cos + omega): the operator with debulge is the one with ranges r'. */
static void check_debulge(const row *r)
{
    csg_vec3 a = point(r->fields[1]), b = point(r->fields[2]);
    double lengths = csg_vec3_norm(a) * csg_vec3_norm(b), partials[2];
    double cosine = lengths > 0 ? csg_vec3_dot(a, b) / lengths : 0, turned = number(r->fields[6]);
    test_near(cosine, number(r->fields[5]), tolerance);
    csg_rule rule = csg_rule_standard(CSG_BLEND_SCALE_SET), plain = rule;
    rule.parameters[0] = rule.parameters[1] = number(r->fields[3]);
    rule.parameters[3] = number(r->fields[4]);
    plain.parameters[0] = plain.parameters[1] = turned;
    rule = settled(rule);
    plain = settled(plain);
    if (rule.parameters[3] == 0) /* none asked for */
        return;
    for (int i = 0; i < 20; i++) {
        double values[2] = {0.05 * i, 0.7 - 0.02 * i};
        test_near(csg_rule_apply(&rule, i % 2, values, 2, cosine, partials),
                  csg_rule_apply(&plain, i % 2, values, 2, 0, partials), tolerance);
    }
}

static void test_sets(void **state)
{
    for_each("ricci", 20, check_ricci);
    for_each("soft", 9, check_sets);
    for_each("scaleB", 45, check_scale_function);
    for_each("scaleops", 40, check_scale_operators);
    for_each("norm", 11, check_normalised);
    for_each("bulge", 8, check_debulge);
}

/* ---- constants --------------------------------------------------------------------------------
 */

/* Tables of operators.md 6.6 and 7.1. */
static void test_constants(void **state)
{
    csg_step_facts h3 = csg_step_find_facts((csg_step){CSG_STEP_POLY, 3});
    csg_step_facts r1 = csg_step_find_facts((csg_step){CSG_STEP_RISING, 1});
    csg_step_facts s10 = csg_step_find_facts((csg_step){CSG_STEP_SIGMOID, 10});
    test_near(h3.interior, 41.0 / 32, 1e-9);
    test_near(h3.dent[0], .059103930636, 1e-9);
    test_near(h3.dent_at[0], .255633, 1e-5);
    test_near(h3.exterior, .038650586746, 1e-9);
    test_near(h3.bump[1], .01944, 1e-9);
    test_near(r1.interior, 2.570796326794897, 1e-9);
    test_near(r1.dent[1], .191467438058, 1e-9);
    test_near(r1.exterior, .129064783, 1e-8);
    test_near(r1.bump[1], .115050480, 1e-8);
    test_near(s10.interior, 1.199678640257, 1e-9);
    test_near(s10.dent[0], .0278464542761, 1e-9);
    static const double rows[][5] = {{.25, .25, 0, 1.226245, 1},
                                     {.5, .5, 0, 1.470885, 1},
                                     {.3, .8, .5, 1.519060, 1},
                                     {1, 1, -2, 1.763257, 1}};
    for (int i = 0; i < 4; i++) {
        csg_rule rule = csg_rule_standard(CSG_BLEND_SCALE_SET);
        rule.parameters[0] = rows[i][0];
        rule.parameters[1] = rows[i][1];
        rule.parameters[2] = rows[i][2] * rows[i][0] * rows[i][1];
        rule = settled(rule);
        test_near(rule.k[0], rows[i][3], 0.002 * rows[i][3]);
    }
    test_near(arc_of(0.3, 0.3).k[0], 1 / (.3 + .7 / sqrt(2)), 1e-12);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_steps), cmocka_unit_test(test_fields),    cmocka_unit_test(test_arcs),
        cmocka_unit_test(test_sets),  cmocka_unit_test(test_constants),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
