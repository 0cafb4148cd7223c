/* SPDX-License-Identifier: MIT
 * Soft solids under blends of lengths: a soft solid far away changes nothing, one nearby blends by
 * its own field, whose plateau ends beside it; fields stay Lipschitz, and what is printed means the
 * same.
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
#include "scene/reference.h"

enum { POINTS = 40, ROUNDS = 12 };

static double value_at(csg_vec3 p)
{
    csgm_status status = CSGM_OK;
    double value = csg_reference_eval(b.scene, p, &status).value;
    assert_int_equal(status, CSGM_OK);
    return value;
}

static void compile(const char *format, ...)
{
    char text[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    csgm_status status = bench_compile(&b, text);
    if (status != CSGM_OK)
        print_error("%s\n%s", text, b.text);
    assert_int_equal(status, CSGM_OK);
}

static csg_vec3 random_point(csg_random *random, double size)
{
    double x = csg_random_uniform(random, -size, size), y = csg_random_uniform(random, -size, size);
    return csg_vec3_make(x, y, csg_random_uniform(random, -size, size));
}

static const char *const soft_solids[] = {
    "soft() sphere(2);",
    "union(blend = soft_sum()) { soft() sphere(2); translate([2, 0, 0]) soft() sphere(1.5); }",
    "difference(blend = arc(angles = [20, 70])) { soft(1) cube(4, center = true); soft() "
    "sphere(1.5); }",
    "color(\"red\") rotate(20) scale(1.5) { soft(0.5) cube(3, center = true); translate([3, 0, 0]) "
    "soft() sphere(1); }",
};
enum { SOLIDS = sizeof soft_solids / sizeof *soft_solids };

/* All reach beyond the plateaus of the solids above. */
static const char *const blends[] = {
    "fillet(6)",
    "round(5)",
    "overblend(7)",
    "cosine(8)",
    "parabola(9)",
    "chamfer(6)",
    "exterior(delta = 5, eps = 2)",
    "interior(eps = 6)",
    "profile(function (x) max(0, 6 - x) / 4)",
    "function (p) 4 + p.x / 1000",
};
enum { BLENDS = sizeof blends / sizeof *blends };

/* 500 away: the ball alone, up to the constant of a radius that varies. */
static void what_is_far_away_changes_nothing(void **state)
{
    (void)state;
    csg_random random = {1};
    for (size_t i = 0; i < BLENDS; i++)
        for (size_t k = 0; k < SOLIDS; k++) {
            bool is_union = (i + k) % 2;
            compile("%s(blend = %s) { sphere(5); translate([500, 0, 0]) { %s } }",
                    is_union ? "union" : "difference", blends[i], soft_solids[k]);
            for (int n = 0; n < POINTS; n++) {
                csg_vec3 p = random_point(&random, 6);
                double f = 5 - csg_vec3_norm(p), got = value_at(p);
                if (got != f && i < BLENDS - 1)
                    print_error("%s %s %d: %.17g %.17g\n", blends[i], soft_solids[k], is_union, got,
                                f);
                assert_true(got == f || (i == BLENDS - 1 && fabs(got - f) < 1e-3 * fabs(f)));
            }
        }
}

/* Nor does a figure of the plane. */
static void figures_far_away_change_nothing(void **state)
{
    static const char *const figures[] = {
        "soft() circle(2);",
        "union(blend = soft_sum()) { soft() circle(2); translate([2, 0]) soft() circle(1.5); }",
        "union() { square(1); translate([0, 90]) scale(2) { soft() circle(2); circle(1); } }",
    };
    (void)state;
    csg_random random = {4};
    for (size_t i = 0; i + 1 < BLENDS; i++) /* radii vary between solids alone */
        for (size_t k = 0; k < sizeof figures / sizeof *figures; k++) {
            compile("linear_extrude(100, center = true) %s(blend = %s) { circle(5); "
                    "translate([500, 0]) { %s } }",
                    (i + k) % 2 ? "union" : "difference", blends[i], figures[k]);
            for (int n = 0; n < POINTS; n++) {
                csg_vec3 p = random_point(&random, 6);
                assert_true(fabs(value_at(p) - (5 - sqrt(p.x * p.x + p.y * p.y))) < 1e-14);
            }
        }
}

/* A ball beside another ball that is soft: parabola(9) in closed form, wherever the soft field is
 * above its plateau. */
static void what_is_near_blends_by_its_own_field(void **state)
{
    (void)state;
    csg_random random = {2};
    const double w = 9, plateau = 1 / 1.5834297477400001; /* radius 2, its influence 4 */
    uint32_t above = 0;
    compile("union(blend = parabola(9)) { sphere(5); translate([6, 0, 0]) soft() sphere(2); }");
    for (int n = 0; n < 200 * POINTS; n++) {
        csg_vec3 p = random_point(&random, 11);
        double a = 5 - csg_vec3_norm(p),
               d = csg_vec3_norm(csg_vec3_sub(p, csg_vec3_make(6, 0, 0))) / 4;
        double q = d * d, field = d < 1 ? 1 - q * q * q * 4 / 9 + q * q * 17 / 9 - q * 22 / 9 : 0;
        double soft = (field - 0.5) * 4 * plateau, x = fabs(a - soft);
        double blended = fmax(a, soft) + (x < w ? (w - x) * (w - x) / (4 * w) : 0);
        if (field > 0.001) {
            assert_true(fabs(value_at(p) - blended) < 1e-9);
            above++;
        } else {
            assert_true(value_at(p) <= blended + 1e-9); /* without an end it would be more */
        }
    }
    assert_true(above > 2 * POINTS);
    /* 7 beside its box: what 2 of 9 are left to blend, where the plateau gave 1.66 */
    assert_true(fabs(value_at(csg_vec3_make(-5, 0, 0)) - 4 / 36.0) < 0.01);
}

static void fields_stay_lipschitz(void **state)
{
    (void)state;
    csg_random random = {3};
    for (int round = 0; round < ROUNDS; round++) {
        size_t blend = 1 + csg_random_below(&random, 5); /* K = 1, all values monotone */
        compile("%s(blend = %s) { sphere(5); translate([%g, 0, 0]) { %s } translate([0, %g, 0]) { "
                "%s } }",
                round % 2 ? "union" : "difference", blends[blend],
                csg_random_uniform(&random, 3, 9), soft_solids[csg_random_below(&random, SOLIDS)],
                csg_random_uniform(&random, 3, 30), soft_solids[csg_random_below(&random, SOLIDS)]);
        for (int n = 0; n < 10 * POINTS; n++) {
            csg_vec3 p = random_point(&random, 20);
            csg_vec3 q = csg_vec3_add(p, random_point(&random, n % 2 ? 0.1 : 5));
            double apart = csg_vec3_norm(csg_vec3_sub(p, q));
            assert_true(fabs(value_at(p) - value_at(q)) <= apart * (1 + 1e-12) + 1e-12);
        }
    }
}

/* A sharp operator below a rule takes the fields of soft solids; they are divided by the largest of
 * their slopes. */
static void sharp_fields_stay_lipschitz(void **state)
{
    (void)state;
    csg_random random = {4};
    compile(
        "union(blend = soft_set()) { union() { soft() sphere(2); translate([3, 0, 0]) soft(0.3) "
        "sphere(1); } translate([0, 3, 0]) soft() sphere(1); }");
    double steepest = 0;
    for (int n = 0; n < 100 * POINTS; n++) {
        csg_vec3 p = random_point(&random, 5);
        csg_vec3 q = csg_vec3_add(p, random_point(&random, 0.1));
        double apart = csg_vec3_norm(csg_vec3_sub(p, q));
        steepest = fmax(steepest, fabs(value_at(p) - value_at(q)) / apart);
    }
    assert_true(steepest > 0.3 && steepest <= 1);
}

/* Where no blend reaches the plateau, nothing is put into the tree. */
static void what_is_not_needed_is_not_made(void **state)
{
    (void)state;
    compile("union(blend = 1) { sphere(5); translate([6, 0, 0]) soft() sphere(2); }");
    size_t nodes = b.scene->node_count;
    compile("union(blend = 2) { sphere(5); translate([6, 0, 0]) soft() sphere(2); }");
    assert_true(b.scene->node_count > nodes);
    compile("union(blend = ricci(2)) { sphere(5); translate([6, 0, 0]) soft() sphere(2); }");
    assert_true(b.scene->node_count == nodes);
    compile("intersection(blend = 4) { sphere(5); translate([6, 0, 0]) soft() sphere(2); }");
    assert_true(b.scene->node_count == nodes);
}

static csgm_status attempt(bench *poor)
{
    static const char scene[] = "union(blend = 4) { sphere(5); soft() sphere(2); }";
    return bench_compile_bytes(poor, scene, sizeof scene - 1, NULL);
}

static void any_allocation_may_fail(void **state)
{
    (void)state;
    assert_true(bench_fail_every(attempt, 80, 12) > 20);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_far_away_changes_nothing),
        cmocka_unit_test(figures_far_away_change_nothing),
        cmocka_unit_test(what_is_near_blends_by_its_own_field),
        cmocka_unit_test(fields_stay_lipschitz),
        cmocka_unit_test(sharp_fields_stay_lipschitz),
        cmocka_unit_test(what_is_not_needed_is_not_made),
        cmocka_unit_test(any_allocation_may_fail),
    };
    return cmocka_run_group_tests(tests, open_bench, close_bench);
}
