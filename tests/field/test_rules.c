/* SPDX-License-Identifier: MIT
 * The operators of the literature, every row of operators.def under union, intersection and
 * difference, in float:
 *   every build of the kernels gives the scalar one's bits: values, gradients, colours, intervals
 *   values within 1e-5 of the reference in units of the field (of the operands' size for operators
 *   on lengths), gradients within 1e-3 away from kinks
 *   intervals hold every value, shorter tapes give the same bits
 * Operands are half-spaces, whose fields run through all pairs in [0, 1], and random solids.
 */
#include <stdio.h>
#include <string.h>

#include "field/prune_support.h"
#include "scene/operators/rule.h"
#include "scene/operators/soft.h"
#include "scene/primitives/kinds.h"
#include "scene/random_blend.h"

static const csg_blend_kind kinds[] = {
#define CSG_RULE(NAME, name, space, fold, interval, demand, lipschitz, equal, doc) CSG_BLEND_##NAME,
#include "scene/operators/operators.def"
};
static const char *const names[] = {
#define CSG_RULE(NAME, name, space, fold, interval, demand, lipschitz, equal, doc) #name,
#include "rounds.h"
#include "scene/operators/operators.def"
};
enum { KINDS = sizeof kinds / sizeof *kinds };

/* A row that is a combine node on the tape. */
static bool is_combined(size_t row)
{
    return strcmp(names[row], "profile") == 0;
}

static double uniform(csg_random *random, double low, double high)
{
    return csg_random_uniform(random, low, high);
}

static csg_step random_step(csg_random *random)
{
    csg_step step = {csg_random_below(random, CSG_STEP_COUNT), 0};
    switch (step.kind) {
    case CSG_STEP_POLY:
    case CSG_STEP_BSPLINE:
        step.parameter = 1 + csg_random_below(random, 8);
        break;
    case CSG_STEP_SIGMOID:
        step.parameter = uniform(random, 10, 60);
        break;
    default:
        step.parameter = 1 + csg_random_below(random, 6);
    }
    return step;
}

static void random_profile(csg_random *random, csg_rule *rule)
{
    uint32_t count = csg_random_below(random, 5);
    double first = rule->parameters[0], last = rule->parameters[1];
    for (uint32_t i = 0; i < count; i++) {
        rule->spline.angle[i] =
            first + (last - first) * (i + uniform(random, 0.3, 1)) / (count + 1);
        rule->spline.factor[i] = uniform(random, 0.93, 1.07);
    }
    rule->spline.count = count;
}

/* turning: with bulge elimination. */
static csg_rule random_rule(csg_random *random, csg_blend_kind kind, bool turning)
{
    csg_rule rule = csg_rule_standard(kind);
    double *v = rule.parameters;
    char text[160];
    switch ((int)kind) {
    case CSG_BLEND_EXTERIOR:
        v[0] = uniform(random, 0.05, 0.5);
        rule.step = random_step(random);
        v[1] = v[0] * uniform(random, 0.1, 1.7);
        if (csg_rule_problem(&rule, text, sizeof text)) /* too wide for the step */
            v[1] = v[0];
        break;
    case CSG_BLEND_INTERIOR:
        v[0] = uniform(random, 0.05, 0.5);
        rule.step = random_step(random);
        break;
    case CSG_BLEND_RICCI:
        v[0] = (double[]){1, 2, 3, 7, uniform(random, 1, 20)}[csg_random_below(random, 5)];
        break;
    case CSG_BLEND_SCALE_SET:
        v[0] = uniform(random, 0.05, turning ? 0.5 : 1);
        v[1] = csg_random_below(random, 2) ? v[0] : uniform(random, 0.05, turning ? 0.5 : 1);
        v[2] = v[0] * v[1] *
               (double[]){0, 0.9, -2, uniform(random, -1, 0.9)}[csg_random_below(random, 4)];
        v[3] = turning ? uniform(random, 0.01, 0.2) : 0;
        break;
    case CSG_BLEND_ARC:
        v[0] = uniform(random, 2, 44);
        v[1] = uniform(random, 46, 88);
        random_profile(random, &rule);
        break;
    default:
        break;
    }
    return rule;
}

static csg_node_kind random_operator(csg_random *random)
{
    return CSG_NODE_UNION + csg_random_below(random, 3);
}

/* ---- fields all over [0, 1] ---------------------------------------------------------------------
 */

static csg_node_id slope_along(csg_scene_builder *builder, int axis)
{
    double v[4] = {0};
    v[axis] = -1; /* f = the coordinate */
    csg_color color = {axis == 0, axis == 1, axis == 2, 1};
    return csg_build_color(builder, color, csg_build_primitive(builder, CSG_NODE_PLANE, v, NOWHERE),
                           NOWHERE);
}

/* Everywhere, at the ends, on the diagonal, near the axes. */
static void add_field_points(test_points *points, csg_random *random, double reach)
{
    test_points_clear(points);
    static const double special[] = {-1, 1, 0, -0.5, 0.5, -0.999, 0.9999, 3, -4};
    for (int i = 0; i < 81; i++)
        test_points_add(points, csg_vec3_make(special[i % 9] * reach, special[i / 9] * reach, 0.1));
    while (points->count < TEST_MOST_POINTS) {
        csg_vec3 p = test_point(random, reach);
        if (points->count % 5 == 0)
            p.y = p.x;
        if (points->count % 5 == 1)
            p.y = p.x * uniform(random, 0.99, 1.01);
        if (points->count % 5 == 2)
            p.x = -reach * (1 - pow(10, uniform(random, -4, 0)));
        test_points_add(points, p);
    }
}

static void check_intervals(const test_subject *s, const test_points *points, const char *what)
{
    enum { MOST_NODES = 64, INSIDE = 12 };
    const csg_kernel *kernels[8];
    size_t count = test_kernels(kernels), nodes = s->field->tape.count;
    static float low[8][MOST_NODES * CSG_OCTANTS], high[8][MOST_NODES * CSG_OCTANTS];
    static float scratch[1 << 16];
    static test_points inside;
    static test_results values;
    csg_random random = {points->count};
    assert_true(nodes <= MOST_NODES);
    for (size_t i = 0; i + CSG_OCTANTS <= points->count; i += CSG_OCTANTS) {
        double half = pow(10, uniform(&random, -3, 0)), radius = half * sqrt(3.0) * (1 + 1e-6);
        for (size_t k = 0; k < count; k++) {
            kernels[k]->intervals(&s->field->tape, points->x + i, points->y + i, points->z + i,
                                  (float)radius, NULL, low[k], high[k], scratch);
            if (memcmp(low[0], low[k], nodes * CSG_OCTANTS * sizeof(float)) ||
                memcmp(high[0], high[k], nodes * CSG_OCTANTS * sizeof(float)))
                fail_msg("%s: %s has other intervals", what, kernels[k]->name);
        }
        test_points_clear(&inside);
        for (int j = 0; j < CSG_OCTANTS * INSIDE; j++) {
            size_t o = i + (size_t)j % CSG_OCTANTS;
            csg_vec3 c = {(double)points->x[o], (double)points->y[o], (double)points->z[o]};
            csg_vec3 way = test_point(&random, half);
            if (j / CSG_OCTANTS < 4) /* corners */
                way = csg_vec3_make(copysign(half, way.x), copysign(half, way.y),
                                    copysign(half, way.z));
            test_points_add(&inside, csg_vec3_add(c, way));
        }
        test_evaluate(kernels[count - 1], &s->field->tape, &inside, &values);
        for (size_t j = 0; j < inside.count; j++) {
            size_t root = (nodes - 1) * CSG_OCTANTS + j % CSG_OCTANTS;
            double exact = test_sample(s->scene, test_points_in_scene(&inside, j, s->field)).value;
            /* The reference may differ by the rounding that pruning allows for. */
            double room = 1e-6 * (1 + fabs(exact));
            if (!(low[0][root] <= values.value[j] && values.value[j] <= high[0][root] &&
                  (double)low[0][root] - room <= exact && exact <= (double)high[0][root] + room))
                fail_msg("%s: %.9g (exactly %.9g) is not in [%.9g, %.9g]", what,
                         (double)values.value[j], exact, (double)low[0][root],
                         (double)high[0][root]);
        }
    }
}

static void check_bits(const test_subject *s, const test_points *points, test_results *results,
                       const char *what)
{
    static test_results other;
    const csg_kernel *kernels[8];
    size_t count = test_kernels(kernels);
    test_evaluate(kernels[0], &s->field->tape, points, results);
    for (size_t k = 1; k < count; k++) {
        char label[200];
        snprintf(label, sizeof label, "%s: %s", what, kernels[k]->name);
        test_evaluate(kernels[k], &s->field->tape, points, &other);
        test_same_bits(results, &other, points->count, true, label);
    }
}

/* Returns the number of points where gradients were compared. */
static size_t check_values(const test_subject *s, const test_points *points,
                           const test_results *results, double unit, const char *what)
{
    size_t compared = 0;
    for (size_t i = 0; i < points->count; i++) {
        csg_vec3 p = test_points_in_scene(points, i, s->field);
        csg_sample expected = test_sample(s->scene, p);
        double error = fabs((double)results->value[i] - expected.value) * unit;
        if (!(error <= 1e-5))
            fail_msg("%s: %.9g instead of %.9g at %.9g %.9g %.9g (error %g)", what,
                     (double)results->value[i], expected.value, p.x, p.y, p.z, error);
        for (int c = 0; c < 4; c++)
            assert_true(results->color[c][i] >= -1e-6f && results->color[c][i] <= 1 + 1e-5f);
        if (!test_is_smooth(s->scene, p, 1e-5))
            continue;
        csg_vec3 g = {(double)results->gradient[0][i], (double)results->gradient[1][i],
                      (double)results->gradient[2][i]};
        double off = csg_vec3_norm(csg_vec3_sub(g, expected.gradient));
        if (!(off <= 1e-3))
            fail_msg("%s: gradient %g %g %g instead of %g %g %g at %.9g %.9g %.9g", what, g.x, g.y,
                     g.z, expected.gradient.x, expected.gradient.y, expected.gradient.z, p.x, p.y,
                     p.z);
        compared++;
    }
    return compared;
}

static size_t check_rule(csg_random *random, size_t row, csg_node_kind how, bool turning)
{
    static test_points points;
    static test_results results;
    test_subject s;
    csg_node_id nodes[3];
    char what[160];
    csg_rule rule = random_rule(random, kinds[row], turning);
    bool fields = csg_blend_takes_fields(rule.kind);
    rule.range = 1;
    test_subject_begin(&s);
    size_t operands = 2 + csg_random_below(random, 2);
    for (size_t i = 0; i < operands; i++)
        nodes[i] = slope_along(&s.builder, (int)i);
    csg_blend blend = csg_build_rule(&s.builder, &rule);
    test_subject_compile(&s, csg_build_operator(&s.builder, how, blend, nodes, operands, NOWHERE));
    snprintf(what, sizeof what, "%s %s of %zu (%g %g %g %g; %s %g; %u)", names[row],
             csg_node_kind_name(how), operands, rule.parameters[0], rule.parameters[1],
             rule.parameters[2], rule.parameters[3], csg_step_name(rule.step.kind),
             rule.step.parameter, rule.spline.count);
    double lambda = fields ? csg_scene_softness(s.scene, s.scene->root) : 1;
    add_field_points(&points, random, 1);
    check_bits(&s, &points, &results, what);
    size_t compared = check_values(&s, &points, &results, lambda, what);
    check_intervals(&s, &points, what);
    test_subject_end(&s);
    return compared;
}

static void test_each_rule(void **state)
{
    csg_random random = {51};
    for (size_t row = 0; row < KINDS; row++) {
        if (is_combined(row))
            continue;
        size_t compared = 0;
        for (csg_node_kind how = CSG_NODE_UNION; how <= CSG_NODE_DIFFERENCE; how++)
            for (int i = 0; i < 10; i++)
                compared += check_rule(&random, row, how, false);
        assert_true(compared > 3000);
    }
    for (int i = 0; i < 20; i++)
        check_rule(&random, CSG_BLEND_SCALE_SET - CSG_BLEND_ORTHOGONAL - 1,
                   random_operator(&random), true);
}

/* ---- random trees
 * --------------------------------------------------------------------------------
 */

static csg_node_id random_operand(csg_scene_builder *builder, csg_random *random)
{
    csg_primitive_kind kind = test_random_solid_kind(random);
    bool super = csg_random_below(random, 8) == 0;
    double v[6] = {uniform(random, 0.2, 0.6), uniform(random, 0.2, 0.6), uniform(random, 0.2, 0.6),
                   uniform(random, 1, 5),     uniform(random, 1, 5),     1};
    csg_node_id node = super ? csg_build_primitive(builder, CSG_NODE_SUPERELLIPSOID, v, NOWHERE)
                             : test_random_primitive(builder, random, kind, NULL);
    double factor = uniform(random, 0.7, 1.3);
    csg_affine place = csg_random_below(random, 2) ? test_random_affine(random, factor, factor, 0.8)
                                                   : test_random_affine(random, 0.6, 1.3, 0.8);
    csg_color color = {(float)uniform(random, 0, 1), (float)uniform(random, 0, 1),
                       (float)uniform(random, 0, 1), 1};
    node = csg_build_color(builder, color, csg_build_transform(builder, &place, node, NOWHERE),
                           NOWHERE);
    if (csg_random_below(random, 3) == 0)
        return node;
    csg_soft soft = {csg_random_below(random, CSG_FALLOFF_COUNT), uniform(random, 0.1, 0.5)};
    return csg_build_soft(builder, soft, node, NOWHERE);
}

static csg_blend random_blend(csg_scene_builder *builder, csg_random *random, bool turning)
{
    if (csg_random_below(random, 4) == 0)
        return test_random_blend(random, csg_random_below(random, CSG_BLEND_FILLET));
    size_t row = csg_random_below(random, KINDS);
    csg_blend_kind kind = kinds[row];
    if (kind == CSG_BLEND_FIELD_SHARP || is_combined(row))
        return (csg_blend){CSG_BLEND_SHARP, 0, false}; /* the builder makes them */
    csg_rule rule = random_rule(random, kind, turning && csg_random_below(random, 2));
    rule.range = uniform(random, 0.1, 0.4);
    return csg_build_rule(builder, &rule);
}

static csg_node_id random_tree(csg_scene_builder *builder, csg_random *random, unsigned leaves,
                               bool turning)
{
    enum { MOST = 48 };
    csg_node_id pool[MOST], group[4];
    unsigned count = leaves < MOST ? leaves : MOST;
    for (unsigned i = 0; i < count; i++)
        pool[i] = random_operand(builder, random);
    while (count > 1) {
        unsigned size = 2 + csg_random_below(random, 3);
        size = size > count ? count : size;
        for (unsigned i = 0; i < size; i++) {
            unsigned pick = csg_random_below(random, count);
            group[i] = pool[pick];
            pool[pick] = pool[--count];
        }
        csg_node_kind how = csg_random_below(random, 3) ? CSG_NODE_UNION : random_operator(random);
        csg_node_id joined = csg_build_operator(
            builder, how, random_blend(builder, random, turning), group, size, NOWHERE);
        csg_affine place = test_random_affine(random, 0.8, 1.1, 0.1);
        if (csg_random_below(random, 3) == 0)
            joined = csg_build_transform(builder, &place, joined, NOWHERE);
        if (csg_random_below(random, 5) == 0)
            joined = csg_build_offset(builder, uniform(random, -0.05, 0.05), joined, NOWHERE);
        pool[count++] = joined;
    }
    return pool[0];
}

static void prune_trees(uint64_t seed, unsigned count, bool turning, walk *totals)
{
    csg_random random = {seed};
    for (unsigned i = 0; i < count; i++) {
        walk w = {0};
        char what[60];
        snprintf(what, sizeof what, "%s tree %u", turning ? "turning" : "random", i);
        test_subject_begin(&w.subject);
        csg_node_id root = random_tree(&w.subject.builder, &random, 2 + i * 5 % 24, turning);
        test_subject_compile(&w.subject, root);
        walk_begin(&w, 3);
        for (int turn = 0; turn < 4; turn++) {
            cube at = {test_point(&random, 1), uniform(&random, 0.05, 1.5)};
            double tau = at.half * pow(2, -uniform(&random, 1, 8)) + 2 * w.rounding;
            descend(&w, &random, at, tau * w.subject.field->tape.lipschitz, what);
        }
        totals->cells += w.cells, totals->outside += w.outside, totals->inside += w.inside;
        totals->shortened += w.shortened, totals->in_band += w.in_band;
        walk_end(&w);
    }
}

static void test_pruned_trees(void **state)
{
    walk totals = {0};
    prune_trees(52, ROUNDS(120), false, &totals);
    assert_true(totals.cells > ROUNDS(2000) && totals.outside > ROUNDS(300) &&
                totals.shortened > ROUNDS(200));
    assert_true(totals.in_band > ROUNDS(5000));
}

static void test_turning_trees(void **state)
{
    walk totals = {0};
    prune_trees(53, ROUNDS(60), true, &totals);
    assert_true(totals.cells > ROUNDS(800) && totals.shortened > ROUNDS(60));
}

/* Values and bits of the same trees. */
static void test_values_of_trees(void **state)
{
    static test_points points;
    static test_results results;
    csg_random random = {54};
    for (unsigned i = 0; i < ROUNDS(80); i++) {
        test_subject s;
        char what[40];
        snprintf(what, sizeof what, "tree %u", i);
        test_subject_begin(&s);
        test_subject_compile(&s, random_tree(&s.builder, &random, 2 + i % 12, i % 4 == 0));
        test_points_clear(&points);
        while (points.count < 256)
            test_points_add(&points, test_point(&random, 1.2));
        check_bits(&s, &points, &results, what);
        if (i % 4)
            check_values(&s, &points, &results, 0.2 / (double)s.field->tape.lipschitz, what);
        test_subject_end(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_each_rule),
        cmocka_unit_test(test_pruned_trees),
        cmocka_unit_test(test_turning_trees),
        cmocka_unit_test(test_values_of_trees),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
