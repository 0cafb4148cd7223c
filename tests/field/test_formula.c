/* SPDX-License-Identifier: MIT
 * Expression fields on tapes: the float functions against libm, their ranges against samples, and
 * whole formulas in every kind of frame: every build of the kernels the same bits, those near the
 * reference, and bounds over cells that hold every value.
 */
#include <float.h>
#include <stdio.h>
#include <string.h>

#include "field/field_support.h"
#include "field/kernels/functions.h"
#include "rounds.h"
#include "scene/formula/formula.h"
#include "scene/operators/blend_kinds.h"
#include "scene/random_formula.h"

/* ---- functions ------------------------------------------------------------------------------ */

static double ulp_of(double value)
{
    float f = fabsf((float)value);
    return fmax((double)(nextafterf(f, INFINITY) - f), 0x1p-149);
}

typedef struct accuracy {
    const char *name;
    float (*value)(float, float);
    double (*exact)(double);
    double low, high;
    double ulp, absolute; /* either will do */
} accuracy;

static void test_accuracy(void **state)
{
    static const accuracy rows[] = {
        {"sin", value_sin, sin, -10, 10, 2, 0},
        {"sin", value_sin, sin, -1e4, 1e4, 4, 1e-7},
        {"cos", value_cos, cos, -10, 10, 2, 1e-10},
        {"cos", value_cos, cos, -1e4, 1e4, 4, 1e-7},
        {"tan", value_tan, tan, -1.5, 1.5, 4, 0},
        {"exp", value_exp, exp, -103, 88.7, 2, 0},
        {"exp", value_exp, exp, -1, 1, 1.5, 0},
        {"ln", value_ln, log, 1e-39, 1e-37, 1, 0},
        {"ln", value_ln, log, 1e-3, 3, 1.5, 0},
        {"ln", value_ln, log, 3, 1e30, 1, 0},
        {"asin", value_asin, asin, -1, 1, 3, 0},
        {"acos", value_acos, acos, -1, 1, 3, 1e-10},
        {"atan", value_atan, atan, -50, 50, 3, 0},
        {"floor", value_floor, floor, -1e3, 1e3, 0, 0},
        {"floor", value_floor, floor, -1e8, 1e8, 0, 0},
    };
    csg_random random = {21};
    for (size_t r = 0; r < sizeof rows / sizeof *rows; r++)
        for (int i = 0; i < 100000; i++) {
            float x = (float)csg_random_uniform(&random, rows[r].low, rows[r].high);
            double exact = rows[r].exact((double)x);
            double error = fabs((double)rows[r].value(x, 0) - exact);
            if (!(error <= fmax(rows[r].ulp * ulp_of(exact), rows[r].absolute)))
                fail_msg("%s(%.9g): %g off, %g ulp", rows[r].name, (double)x, error,
                         error / ulp_of(exact));
        }
}

static void test_accuracy_of_two(void **state)
{
    csg_random random = {22};
    for (int i = 0; i < 200000; i++) {
        float x = (float)csg_random_uniform(&random, -3, 3);
        float y = (float)csg_random_uniform(&random, -3, 3);
        double angle = atan2((double)y, (double)x);
        test_near((double)value_atan2(y, x), angle, 3 * ulp_of(angle));
        double power = pow(fabs((double)x), (double)y);
        test_near((double)value_pow(absolute(x), y), power, power * 2e-6);
        double rest = fmod((double)x, (double)y), apart = fabs((double)value_mod(x, y) - rest);
        double size = fabs((double)y); /* next to a multiple either side is right */
        assert_true(apart <= 1e-6 * fabs((double)x) || fabs(apart - size) <= 1e-6 * (size + 3));
    }
}

static void test_special_values(void **state)
{
    assert_true(value_exp(200, 0) == INFINITY && value_exp(-200, 0) == 0);
    assert_true(value_exp(INFINITY, 0) == INFINITY && value_exp(-INFINITY, 0) == 0);
    assert_true(value_ln(0, 0) == -INFINITY && value_ln(INFINITY, 0) == INFINITY);
    assert_true(isnan(value_ln(-1, 0)) && isnan(value_exp(NAN, 0)) && isnan(value_ln(NAN, 0)));
    assert_true(isnan(value_sin(INFINITY, 0)) && isnan(value_cos(NAN, 0)));
    assert_true(isnan(value_tan(-INFINITY, 0)) && isnan(value_atan2(NAN, 1)));
    assert_true(isnan(value_asin(1.1f, 0)) && isnan(value_acos(-1.1f, 0)));
    assert_true(value_pow(0, 2.5f) == 0 && value_pow(0, 0) == 1 && isnan(value_pow(-1, 0.5f)));
    assert_true(value_atan2(0, 0) == 0 && value_floor(-0.5f, 0) == -1);
    assert_true(value_floor(3e9f, 0) == 3e9f && value_floor(-1e30f, 0) == -1e30f);
    for (float x = 1e4f; x < 1e38f; x *= 3.7f)
        assert_true(absolute(value_sin(x, 0)) <= 1.0000002f);
}

/* ---- ranges -----------------------------------------------------------------------------------
 */

typedef struct operation {
    const char *name;
    float (*value)(float, float);
    range (*bound)(range, range);
} operation;

static const operation operations[] = {
#define NAMED_0(name)
#define NAMED_1(name) {#name, value_##name, range_##name},
#define NAMED_2(name) NAMED_1(name)
#define CSG_FORMULA_OP(NAME, name, arity) NAMED_##arity(name)
#include "scene/formula/formula.def"
#undef CSG_FORMULA_OP
};

/* Of many sizes, sometimes one number, sometimes with a round end. */
static range random_range(csg_random *random)
{
    double size = pow(10, csg_random_uniform(random, -3, 3));
    double middle = csg_random_uniform(random, -size, size);
    double half = size * pow(10, csg_random_uniform(random, -4, 0.3));
    range r = {(float)(middle - half), (float)(middle + half)};
    unsigned kind = csg_random_below(random, 8);
    if (kind == 0)
        r.high = r.low;
    else if (kind == 1)
        r.low = 0, r.high = absolute(r.high);
    else if (kind == 2)
        r.low = -1, r.high = larger(r.high, -0.5f);
    return r;
}

static float sample(csg_random *random, range r)
{
    unsigned kind = csg_random_below(random, 8);
    float x = (float)csg_random_uniform(random, (double)r.low, (double)r.high);
    return kind == 0 ? r.low : kind == 1 ? r.high : smaller(larger(x, r.low), r.high);
}

static void test_ranges(void **state)
{
    csg_random random = {23};
    for (size_t o = 0; o < sizeof operations / sizeof *operations; o++) {
        const operation *op = &operations[o];
        size_t known = 0;
        for (int i = 0; i < 20000; i++) {
            range a = random_range(&random), b = random_range(&random);
            range bound = op->bound(a, b);
            known += is_known(bound) ? 1 : 0;
            for (int k = 0; k < 20; k++) {
                float x = sample(&random, a), y = sample(&random, b), v = op->value(x, y);
                bool holds = !is_known(bound) || (bound.low <= v && v <= bound.high);
                if (!holds)
                    fail_msg("%s(%.9g, %.9g) = %.9g is not in [%.9g, %.9g]", op->name, (double)x,
                             (double)y, (double)v, (double)bound.low, (double)bound.high);
            }
        }
        assert_true(known > 1500);
        range nothing = op->bound((range){NAN, NAN}, (range){1, 2});
        assert_false(is_known(nothing));
    }
}

static void test_square_range(void **state)
{
    range s = range_square((range){-2, 1}, (range){-2, 1});
    assert_true(s.low == 0 && s.high >= 4 && s.high < 4.00001f);
}

/* ---- whole formulas ---------------------------------------------------------------------------
 */

static csg_affine make_frame(csg_random *random, int kind)
{
    csg_affine shift = csg_affine_translate(test_point(random, 1));
    if (kind == 0)
        return shift;
    if (kind == 1)
        return test_random_affine(random, 1, 1, 1);
    if (kind == 2)
        return test_random_affine(random, 0.4, 2.5, 1);
    return csg_affine_multiply(shift, csg_affine_mirror(test_direction(random)));
}

/* A ball minus (or cut by) a placed formula, its bounds [-2, 2]^3 or so. */
static csg_node_id random_scene(test_subject *subject, csg_random *random, int turn)
{
    static csg_formula_step steps[TEST_MOST_STEPS];
    csg_scene_builder *builder = &subject->builder;
    uint32_t count = test_random_formula(&subject->context.memory, random, 1 + (unsigned)turn % 24,
                                         turn % 3 > 0, steps);
    csg_box box = {{-2, -1.5, -2}, {1.5, 2, 2}};
    const csg_field_domain domain = {box, turn % 2, turn % 3 ? 0 : 1e4, true};
    csg_node_id field = csg_build_field(builder, steps, count, &domain, NOWHERE);
    if (field == CSG_NODE_NONE)
        fail_msg("formula %d: %s", turn, builder->problem);
    csg_affine place = make_frame(random, turn / 2 % 4);
    field = csg_build_transform(builder, &place, field, NOWHERE);
    csg_node_id ball = csg_build_ball(builder, 1.5, NOWHERE);
    if (turn % 5 == 0)
        return field;
    csg_blend blend = turn % 5 == 1   ? (csg_blend){CSG_BLEND_ROUND, 0.3, false}
                      : turn % 5 == 2 ? (csg_blend){CSG_BLEND_PARABOLA, 0.3, false}
                                      : (csg_blend){0};
    return csg_build_operator(builder, turn % 5 == 3 ? CSG_NODE_DIFFERENCE : CSG_NODE_INTERSECTION,
                              blend, (csg_node_id[]){ball, field}, 2, NOWHERE);
}

static void add_points(test_points *points, csg_random *random)
{
    static const double raw[] = {0.0, -0.0, 1e-40, 1e6, -3e15};
    test_points_clear(points);
    for (int i = 0; i < 125; i++)
        test_points_add(points, csg_vec3_make(raw[i % 5], raw[i / 5 % 5], raw[i / 25]));
    while (points->count < 504)
        test_points_add(points, test_point(random, points->count < 450 ? 2 : 20));
}

static void check_intervals(const test_subject *subject, const csg_kernel *kernel,
                            const csg_kernel *scalar, csg_random *random, size_t *tight)
{
    enum { MOST_NODES = 8, POINTS = 40 };
    static float scratch[1 << 16];
    const csg_tape *tape = &subject->field->tape;
    float low[2][MOST_NODES * CSG_OCTANTS], high[2][MOST_NODES * CSG_OCTANTS];
    float half = (float)pow(10, csg_random_uniform(random, -4, 0.3)), c[3][CSG_OCTANTS];
    for (int o = 0; o < CSG_OCTANTS; o++)
        for (int axis = 0; axis < 3; axis++)
            c[axis][o] = (float)csg_random_uniform(random, -2, 2);
    float radius = half * 1.7320511f;
    kernel->intervals(tape, c[0], c[1], c[2], radius, NULL, low[0], high[0], scratch);
    scalar->intervals(tape, c[0], c[1], c[2], radius, NULL, low[1], high[1], scratch);
    size_t bytes = tape->count * CSG_OCTANTS * sizeof(float);
    assert_memory_equal(low[0], low[1], bytes);
    assert_memory_equal(high[0], high[1], bytes);
    size_t root = (tape->count - 1) * CSG_OCTANTS;
    for (int o = 0; o < CSG_OCTANTS; o++) {
        float x[48], y[48], z[48], f[48];
        for (int i = 0; i < POINTS; i++) {
            x[i] = c[0][o] + half * (float)csg_random_uniform(random, -1, 1);
            y[i] = c[1][o] + half * (float)csg_random_uniform(random, -1, 1);
            z[i] = c[2][o] + half * (float)csg_random_uniform(random, -1, 1);
        }
        for (int i = POINTS; i < 48; i++)
            x[i] = y[i] = z[i] = 0;
        kernel->values(tape, x, y, z, POINTS, f, scratch, 1 << 16);
        float l = low[0][root + (size_t)o], h = high[0][root + (size_t)o];
        float slack = 1e-5f * (1 + absolute(f[0])); /* of the operators: prune.h */
        for (int i = 0; i < POINTS; i++)
            if (!(f[i] >= l - slack && f[i] <= h + slack))
                fail_msg("%.9g is not in [%.9g, %.9g], half edge %g", (double)f[i], (double)l,
                         (double)h, (double)half);
        *tight += h - l < 100 * half ? 1 : 0;
    }
}

/* A value's error grows with what its formula multiplies; where the reference moves by little for
 * a change of the point by float rounding, the float is as near. */
static size_t check_values(const test_subject *subject, const test_points *points,
                           const test_results *results)
{
    size_t checked = 0;
    double lambda = fmin((double)subject->field->tape.lipschitz, 1e3);
    for (size_t i = 125; i < 450; i++) {
        csg_vec3 p = test_points_in_scene(points, i, subject->field);
        double expected = test_sample(subject->scene, p).value;
        double shifted =
            test_sample(subject->scene, csg_vec3_add(p, csg_vec3_make(1e-6, -1e-6, 1e-6))).value;
        if (fabs(shifted - expected) > 1e-4 * (1 + lambda)) /* a jump */
            continue;
        double error = fabs((double)results->value[i] - expected);
        if (!(error <= 3e-5 * (1 + lambda + fabs(expected))))
            fail_msg("%.9g is %g off %.9g, lambda %g", (double)results->value[i], error, expected,
                     lambda);
        checked++;
    }
    return checked;
}

static size_t check_gradients(const test_subject *subject, const test_points *points,
                              const test_results *results)
{
    size_t checked = 0;
    for (size_t i = 125; i < 450; i++) {
        csg_vec3 p = test_points_in_scene(points, i, subject->field);
        if (!test_is_smooth(subject->scene, p, 1e-5))
            continue;
        csg_vec3 expected = test_sample(subject->scene, p).gradient;
        csg_vec3 found = {(double)results->gradient[0][i], (double)results->gradient[1][i],
                          (double)results->gradient[2][i]};
        double error = csg_vec3_norm(csg_vec3_sub(found, expected));
        if (!(error <= 2e-3 * (1 + csg_vec3_norm(expected))))
            fail_msg("gradient (%g %g %g), not (%g %g %g)", found.x, found.y, found.z, expected.x,
                     expected.y, expected.z);
        checked++;
    }
    return checked;
}

static void test_formulas(void **state)
{
    static test_points points;
    static test_results results, other;
    const csg_kernel *kernels[8];
    size_t kernel_count = test_kernels(kernels), values = 0, gradients = 0, tight = 0;
    csg_random random = {24};
    for (int turn = 0; turn < ROUNDS(240); turn++) {
        test_subject subject;
        test_subject_begin(&subject);
        test_subject_compile(&subject, random_scene(&subject, &random, turn));
        add_points(&points, &random);
        test_evaluate(kernels[0], &subject.field->tape, &points, &results);
        for (size_t k = 1; k < kernel_count; k++) {
            char what[64];
            snprintf(what, sizeof what, "formula %d: %s", turn, kernels[k]->name);
            test_evaluate(kernels[k], &subject.field->tape, &points, &other);
            test_same_bits(&results, &other, points.count, true, what);
            check_intervals(&subject, kernels[k], kernels[0], &random, &tight);
        }
        for (size_t i = 0; i < points.count; i++)
            assert_true(isfinite(results.value[i]) && isfinite(results.gradient[0][i]));
        if (turn % 3) { /* no jumps */
            values += check_values(&subject, &points, &results);
            gradients += check_gradients(&subject, &points, &results);
        }
        test_subject_end(&subject);
    }
    assert_true(values > ROUNDS(40000) && gradients > ROUNDS(15000));
    assert_true(tight > ROUNDS(1000));
}

/* A formula that does not look at the point is the same everywhere. */
static void test_constant(void **state)
{
    static test_points points;
    static test_results results;
    const csg_kernel *kernels[8];
    const csg_formula_step steps[] = {{.op = CSG_FORMULA_CONSTANT, .constant = 0.75}};
    test_subject subject;
    const csg_field_domain everywhere = {csg_box_all(), false, 1, false};
    test_subject_begin(&subject);
    csg_node_id node = csg_build_field(&subject.builder, steps, 1, &everywhere, NOWHERE);
    test_subject_compile(&subject, node);
    csg_random random = {25};
    add_points(&points, &random);
    test_kernels(kernels);
    test_evaluate(kernels[0], &subject.field->tape, &points, &results);
    for (size_t i = 0; i < points.count; i++)
        assert_true(results.value[i] == 0.75f && results.gradient[0][i] == 0);
    test_subject_end(&subject);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_accuracy),       cmocka_unit_test(test_accuracy_of_two),
        cmocka_unit_test(test_special_values), cmocka_unit_test(test_ranges),
        cmocka_unit_test(test_square_range),   cmocka_unit_test(test_formulas),
        cmocka_unit_test(test_constant),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
