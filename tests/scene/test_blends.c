/* SPDX-License-Identifier: MIT
 * The laws of every blend on random operands (operators.md 2.2 and 12): partial derivatives are
 * not negative and sum to 1 (so K = 1), monotone, translation, commutative, inert operands change
 * no bit, the excess and the support of operators.def are met and exact.
 */
#include "scene/operators/blend_kinds.h"
#include "scene_support.h"

#include <string.h>

#include "random_blend.h"
#include "random_scene.h"

enum { MOST = 40, ROUNDS = 4000 };

static const double infinity = INFINITY;

/* Operands close enough to blend, some far away, some equal. */
static size_t random_operands(csg_random *random, csg_blend blend, double *values)
{
    size_t count = csg_blend_is_fold(blend.kind) ? 2 : 1 + csg_random_below(random, 8);
    if (blend.kind == CSG_BLEND_ROUND && csg_random_below(random, 10) == 0)
        count = 1 + csg_random_below(random, MOST - 1); /* inert_law adds one */
    double reach = fmin(csg_blend_support(blend), 1) + 0.01;
    for (size_t i = 0; i < count; i++) {
        values[i] = csg_random_uniform(random, -0.7, 0.7) * reach;
        if (i && csg_random_below(random, 8) == 0)
            values[i] = values[csg_random_below(random, (uint32_t)i)];
        if (csg_random_below(random, 8) == 0)
            values[i] *= 10;
    }
    return count;
}

static double united(csg_blend blend, const double *values, size_t count)
{
    double partials[MOST];
    return csg_reference_union(blend, values, count, partials);
}

static double largest(const double *values, size_t count)
{
    double most = values[0];
    for (size_t i = 1; i < count; i++)
        most = fmax(most, values[i]);
    return most;
}

typedef void law(csg_random *random, csg_blend blend, double *values, size_t count);

static void check_law(law *holds)
{
    for (csg_blend_kind kind = CSG_BLEND_SHARP; kind < CSG_BLEND_FILLET; kind++) {
        csg_random random = {10 + (uint64_t)kind};
        for (int i = 0; i < ROUNDS; i++) {
            double values[MOST];
            csg_blend blend = test_random_blend(&random, kind);
            size_t count = random_operands(&random, blend, values);
            holds(&random, blend, values, count);
        }
    }
}

static void convex_law(csg_random *random, csg_blend blend, double *values, size_t count)
{
    double partials[MOST], sum = 0;
    csg_reference_union(blend, values, count, partials);
    for (size_t i = 0; i < count; i++) {
        assert_true(partials[i] >= 0);
        sum += partials[i];
    }
    test_near(sum, 1, 1e-14);
}

static void derivative_law(csg_random *random, csg_blend blend, double *values, size_t count)
{
    const double step = 1e-7;
    double partials[MOST], at = csg_reference_union(blend, values, count, partials);
    for (size_t i = 0; i < count; i++) {
        double held = values[i];
        values[i] = held + step;
        double up = united(blend, values, count) - at;
        values[i] = held - step;
        double down = at - united(blend, values, count);
        values[i] = held;
        if (fabs(up - down) < 1e-3 * step)
            test_near(partials[i], (up + down) / (2 * step), 1e-3);
        else /* a crease: between the one-sided derivatives */
            assert_true(partials[i] <= fmax(up, down) / step + 1e-3 &&
                        partials[i] >= fmin(up, down) / step - 1e-3);
    }
}

static void monotone_law(csg_random *random, csg_blend blend, double *values, size_t count)
{
    double before = united(blend, values, count);
    for (size_t i = 0; i < count; i++)
        if (csg_random_below(random, 2))
            values[i] += csg_random_uniform(random, 0, 0.2);
    assert_true(united(blend, values, count) >= before - 1e-15);
}

static void translation_law(csg_random *random, csg_blend blend, double *values, size_t count)
{
    double before = united(blend, values, count), by = csg_random_uniform(random, -3, 3);
    for (size_t i = 0; i < count; i++)
        values[i] += by;
    test_near(united(blend, values, count), before + by, 1e-14);
}

static void commutative_law(csg_random *random, csg_blend blend, double *values, size_t count)
{
    double before = united(blend, values, count);
    for (size_t i = count; i-- > 1;) {
        size_t j = csg_random_below(random, (uint32_t)i + 1);
        double held = values[i];
        values[i] = values[j];
        values[j] = held;
    }
    test_near(united(blend, values, count), before, blend.kind == CSG_BLEND_ROUND ? 1e-15 : 0);
}

static void excess_law(csg_random *random, csg_blend blend, double *values, size_t count)
{
    double over = united(blend, values, count) - largest(values, count);
    double most = csg_blend_excess(blend, (uint32_t)count);
    assert_true(over >= 0 && over <= most + 1e-15);
    for (size_t i = 0; i < count; i++)
        values[i] = 0;
    test_near(united(blend, values, count), most, 1e-15);
}

/* Same bits with and without an operand that differs by the support or more. */
static void inert_law(csg_random *random, csg_blend blend, double *values, size_t count)
{
    double support = csg_blend_support(blend), most = largest(values, count), partials[MOST];
    if (support == infinity || count < 2)
        return;
    if (csg_blend_is_fold(blend.kind))
        count = 1;
    double without = united(blend, values, count);
    most = largest(values, count);
    values[count] = most - support * csg_random_uniform(random, 1 + 1e-12, 2) - 1e-15;
    double with = csg_reference_union(blend, values, count + 1, partials);
    assert_memory_equal(&with, &without, sizeof with);
    assert_true(partials[count] == 0);
}

/* And just inside the support there is a blend. */
static void support_law(csg_random *random, csg_blend blend, double *values, size_t count)
{
    double support = csg_blend_support(blend);
    if (support == infinity || blend.kind == CSG_BLEND_SHARP)
        return;
    const double pair[2] = {-0.99 * support, 0};
    assert_true(united(blend, pair, 2) > 0);
}

static void scale_law(csg_random *random, csg_blend blend, double *values, size_t count)
{
    double before = united(blend, values, count), by = csg_random_uniform(random, 0.1, 9);
    for (size_t i = 0; i < count; i++)
        values[i] *= by;
    test_near(united(csg_blend_scale(blend, by), values, count), by * before, 1e-13);
}

static void test_convex(void **state)
{
    check_law(convex_law);
}
static void test_derivatives(void **state)
{
    check_law(derivative_law);
}
static void test_monotone(void **state)
{
    check_law(monotone_law);
}
static void test_translation(void **state)
{
    check_law(translation_law);
}
static void test_commutative(void **state)
{
    check_law(commutative_law);
}
static void test_excess(void **state)
{
    check_law(excess_law);
}
static void test_inert(void **state)
{
    check_law(inert_law);
}
static void test_support(void **state)
{
    check_law(support_law);
}
static void test_scale(void **state)
{
    check_law(scale_law);
}

/* G is the largest root of sum max(w + f - G, 0)^2 = w^2. */
static void test_round_definition(void **state)
{
    csg_random random = {99};
    for (int i = 0; i < ROUNDS; i++) {
        double values[MOST], sum = 0;
        csg_blend blend = test_random_blend(&random, CSG_BLEND_ROUND);
        size_t count = random_operands(&random, blend, values);
        double g = united(blend, values, count);
        for (size_t k = 0; k < count; k++) {
            double s = fmax(blend.n + values[k] - g, 0);
            sum += s * s;
        }
        test_near(sum, blend.n * blend.n, 2e-15);
    }
}

static void test_round_many_equal(void **state)
{
    static double values[10000], partials[10000];
    csg_blend blend = {CSG_BLEND_ROUND, 0.5, false};
    double g = csg_reference_union(blend, values, 10000, partials);
    test_near(g, 0.5 * (1 - 1 / 100.0), 1e-14);
    test_near(partials[1234], 1e-4, 1e-15);
}

/* Two half-spaces at a right angle: the fillet is an arc of radius w around (w, w). */
static void test_round_is_circular(void **state)
{
    const csg_blend blend = {CSG_BLEND_ROUND, 0.3, false};
    for (double angle = 0.05; angle < 1.55; angle += 0.1) {
        double x = 0.3 - 0.3 * cos(angle), y = 0.3 - 0.3 * sin(angle);
        const double values[2] = {-x, -y};
        test_near(united(blend, values, 2), 0, 1e-15);
    }
}

static void test_infinite_operands(void **state)
{
    for (csg_blend_kind kind = CSG_BLEND_SHARP; kind < CSG_BLEND_FILLET; kind++) {
        csg_blend blend = {kind, kind == CSG_BLEND_SHARP ? 0 : 0.2, false};
        const double one[2] = {-infinity, 0.25}, none[2] = {-infinity, -infinity};
        assert_true(united(blend, one, 2) == 0.25);
        assert_true(united(blend, none, 2) == -infinity);
    }
}

/* Of f_b' between 0 and the support: what operators.def says of creases and of its growth. */
static void check_slopes(csg_blend blend)
{
    enum { STEPS = 1000 };
    double support = csg_blend_support(blend), end = isinf(support) ? 50 : support;
    double value, slope, first, before, least = 0;
    csg_reference_blend_function(blend, 0, &value, &first);
    before = first;
    for (int i = 1; i < STEPS; i++) {
        csg_reference_blend_function(blend, end * i / STEPS, &value, &slope);
        least = fmin(least, slope - before);
        before = slope;
    }
    bool smooth = fabs(first + 0.5) < 1e-12 && fabs(before) < 0.01;
    assert_int_equal(smooth, csg_blend_is_smooth(blend.kind));
    assert_int_equal(least >= -1e-12, csg_blend_is_convex(blend.kind));
}

static void test_slopes(void **state)
{
    for (csg_blend_kind kind = CSG_BLEND_SHARP; kind < CSG_BLEND_FILLET; kind++)
        if (csg_blend_is_fold(kind))
            check_slopes((csg_blend){kind, csg_blend_raw(kind, 0.7), false});
    assert_false(csg_blend_is_smooth(CSG_BLEND_SHARP));
    assert_false(csg_blend_is_smooth(CSG_BLEND_ORTHOGONAL));
}

static void test_names_and_widths(void **state)
{
    assert_string_equal(csg_blend_name(CSG_BLEND_PARABOLA), "parabola");
    test_near(csg_blend_raw(CSG_BLEND_PARABOLA, 0.5), 2, 0);
    test_near(csg_blend_raw(CSG_BLEND_HYPERBOLA, 0.5), 0.5, 0);
    for (csg_blend_kind kind = CSG_BLEND_ROUND; kind < CSG_BLEND_FILLET; kind++) {
        double support = csg_blend_support((csg_blend){kind, csg_blend_raw(kind, 0.7), false});
        if (support < infinity)
            test_near(support, 0.7, 1e-15);
        else
            test_near(csg_blend_raw(kind, 0.7), 0.7, 0);
        assert_int_equal(csg_blend_is_fold(kind), kind != CSG_BLEND_ROUND);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_convex),
        cmocka_unit_test(test_derivatives),
        cmocka_unit_test(test_monotone),
        cmocka_unit_test(test_translation),
        cmocka_unit_test(test_commutative),
        cmocka_unit_test(test_excess),
        cmocka_unit_test(test_inert),
        cmocka_unit_test(test_support),
        cmocka_unit_test(test_scale),
        cmocka_unit_test(test_round_definition),
        cmocka_unit_test(test_round_many_equal),
        cmocka_unit_test(test_round_is_circular),
        cmocka_unit_test(test_infinite_operands),
        cmocka_unit_test(test_slopes),
        cmocka_unit_test(test_names_and_widths),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
