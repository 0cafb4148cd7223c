/* SPDX-License-Identifier: MIT
 * combine() of many solids: values and gradients against closed forms, constants that bound the
 * partial derivatives' sizes, and what is refused.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "base/random.h"
#include "lang/bench_failing.h"
#include "lang/bench_fixture.h"
#include "scene/formula/formula.h"
#include "scene/operators/combine.h"
#include "scene/reference.h"

enum { POINTS = 200, MOST = CSG_COMBINE_MOST };

static csg_sample sample(csg_vec3 p)
{
    csgm_status status = CSGM_OK;
    csg_sample s = csg_reference_eval(b.scene, p, &status);
    assert_int_equal(status, CSGM_OK);
    return s;
}

static csg_vec3 centre_of(uint32_t k)
{
    return csg_vec3_make(3 * sin(k), 3 * cos(2 * k), 0.1 * k);
}

/* As many balls of radius 1 to 2 under this formula of f. */
static void compile_balls(const char *formula, uint32_t count, const char *more)
{
    static char text[16384];
    int length = snprintf(text, sizeof text, "combine(function (f) %s%s) {", formula, more);
    for (uint32_t k = 0; k < count; k++) {
        csg_vec3 c = centre_of(k);
        length += snprintf(text + length, sizeof text - (size_t)length,
                           "translate([%.17g, %.17g, %.17g]) sphere(%.17g);", c.x, c.y, c.z,
                           1 + (double)k / MOST);
    }
    snprintf(text + length, sizeof text - (size_t)length, "}");
    if (bench_compile(&b, text) != CSGM_OK)
        print_error("%s\n%s", formula, b.text);
    assert_non_null(b.scene);
}

static double ball(uint32_t k, csg_vec3 p, csg_vec3 *gradient)
{
    csg_vec3 away = csg_vec3_sub(p, centre_of(k));
    double distance = csg_vec3_norm(away);
    *gradient = csg_vec3_scale(away, -1 / distance);
    return 1 + (double)k / MOST - distance;
}

static csg_vec3 random_point(csg_random *random)
{
    double x = csg_random_uniform(random, -6, 6), y = csg_random_uniform(random, -6, 6);
    return csg_vec3_make(x, y, csg_random_uniform(random, -6, 6));
}

/* The root of 1 + the sum of f[i]^2: partial derivatives f[i] over it, sum of sizes at most
 * sqrt(count). */
static void values_are_those_of_the_formula(void **state)
{
    static const char *const sums[] = {"f[0] * f[0] + f[1] * f[1] + f[2] * f[2] + f[3] * f[3]",
                                       " + f[4] * f[4] + f[5] * f[5] + f[6] * f[6]"};
    (void)state;
    csg_random random = {7};
    for (uint32_t count = 4; count <= 7; count += 3) {
        char formula[256];
        snprintf(formula, sizeof formula, "2 - sqrt(1 + %s%s)", sums[0], count > 4 ? sums[1] : "");
        compile_balls(formula, count, "");
        double lambda = b.scene->formulas[0].lipschitz;
        assert_true(lambda >= sqrt(count) && lambda < 1.0001 * sqrt(count));
        for (int n = 0; n < POINTS; n++) {
            csg_vec3 p = random_point(&random), gradient = {0, 0, 0}, own;
            double sum = 1;
            for (uint32_t k = 0; k < count; k++)
                sum += pow(ball(k, p, &own), 2);
            for (uint32_t k = 0; k < count; k++) {
                double f = ball(k, p, &own);
                gradient = csg_vec3_add(gradient, csg_vec3_scale(own, -f / sqrt(sum) / lambda));
            }
            csg_sample s = sample(p);
            assert_true(fabs(s.value - (2 - sqrt(sum)) / lambda) < 1e-12);
            assert_true(csg_vec3_norm(csg_vec3_sub(s.gradient, gradient)) < 1e-12);
        }
    }
}

/* The constant is that of the formula, not the sum of what each operand could do. */
static void constants_are_tight(void **state)
{
    static const struct {
        const char *formula;
        double constant;
    } rows[] = {
        {"(f[0] + f[1] + f[2] + f[3] + f[4]) / 5", 1},
        {"max(f) + 0.1", 1},
        {"f[0] - f[1] + f[2] - f[3] / 2", 3.5},
        {"max(f[0], f[1], f[2]) + min(f[3], f[4]) / 4", 1.25},
        {"f[0] + abs(f[4]) + abs(f[3])", 3},
        {"max(f[0], f[1]) / 2 + (f[4] + sqrt((f[2] - f[3]) * (f[2] - f[3]) + 1)) / 4", 1.25},
    };
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        compile_balls(rows[i].formula, 5, "");
        double got = b.scene->formulas[0].lipschitz;
        if (!(got >= rows[i].constant && got < rows[i].constant * (1 + 1e-9)))
            print_error("%s: %.17g\n", rows[i].formula, got);
        assert_true(got >= rows[i].constant && got < rows[i].constant * (1 + 1e-9));
    }
}

/* Any number up to the most, twelve of them without a sign that is known. */
static void many_are_combined(void **state)
{
    (void)state;
    csg_vec3 p = {0.5, 0.25, -1}, own;
    compile_balls("max(f) / 2 + f[63] / 4", MOST, "");
    double most = -INFINITY;
    for (uint32_t k = 0; k < MOST; k++)
        most = fmax(most, ball(k, p, &own));
    assert_true(fabs(sample(p).value - (most / 2 + ball(MOST - 1, p, &own) / 4)) < 1e-12);
    compile_balls(
        "abs(f[0]) + abs(f[1]) + abs(f[2]) + abs(f[3]) + abs(f[4]) + abs(f[5]) + abs(f[6]) + "
        "abs(f[7]) + abs(f[8]) + abs(f[9]) + abs(f[10]) + abs(f[11]) - 9",
        12, "");
    double got = b.scene->formulas[0].lipschitz;
    assert_true(got >= 12 && got < 12.001);
}

/* Named one by one or in a list: the same. A largest or least is a sharp operator. */
static void forms_are_the_same(void **state)
{
    (void)state;
    const csg_vec3 p = {0.3, -0.2, 1};
    const char *solids = "{ sphere(1); cube(1); sphere(2); cylinder(h = 3, r = 1); }";
    char text[512];
    static const char *const forms[] = {
        "function (a, b, c, d) a / 2 - b / 4 + c * d / (9 + d * d)",
        "function (f) f[0] / 2 - f[1] / 4 + f[2] * f[3] / (9 + f[3] * f[3])",
        "function (f, k = 4) f.x / 2 - f[1] / k + f[2] * f[3] / (9 + f[3] * f[3])"};
    double values[3];
    for (int i = 0; i < 3; i++) {
        snprintf(text, sizeof text, "combine(%s, lipschitz = 3) %s", forms[i], solids);
        assert_int_equal(bench_compile(&b, text), CSGM_OK);
        values[i] = sample(p).value;
    }
    assert_true(values[0] == values[1] && values[0] == values[2]);
    snprintf(text, sizeof text, "combine(function (f) max(f)) %s", solids);
    assert_int_equal(bench_compile(&b, text), CSGM_OK);
    assert_int_equal(b.scene->nodes[b.scene->root].kind, CSG_NODE_UNION);
}

static csgm_status attempt(bench *poor)
{
    static const char scene[] = "combine(function (f) (f[0] + f[1] + f[2] + f[3]) / 4)"
                                "{ sphere(5); sphere(2); sphere(1); sphere(3); }";
    return bench_compile_bytes(poor, scene, sizeof scene - 1, NULL);
}

static void any_allocation_may_fail(void **state)
{
    (void)state;
    assert_true(bench_fail_every(attempt, 80, 12) > 20);
}

static void too_many_are_refused(void **state)
{
    (void)state;
    static char text[4096] = "combine(function (f) max(f) + 1) {";
    for (int k = 0; k <= MOST; k++)
        strcat(text, "sphere(1);");
    strcat(text, "}");
    assert_int_not_equal(bench_compile(&b, text), CSGM_OK);
    assert_non_null(strstr(b.text, "combine() takes one to 64 children, not 65"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(values_are_those_of_the_formula),
        cmocka_unit_test(constants_are_tight),
        cmocka_unit_test(many_are_combined),
        cmocka_unit_test(forms_are_the_same),
        cmocka_unit_test(any_allocation_may_fail),
        cmocka_unit_test(too_many_are_refused),
    };
    return cmocka_run_group_tests(tests, open_bench, close_bench);
}
