/* SPDX-License-Identifier: MIT
 * Walls and gaps by the C interface: closed forms, random voids, solids that touch, limits.
 * Arguments: how many random solids, 4; a seed.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
/* cmocka wants the four above first */
#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/geometry.h"
#include "base/random.h"
#include "csgmesh/fabrication.h"

static csgm_status find(const char *text, csgm_wall_options options, uint32_t threads,
                        csgm_walls *out)
{
    csgm_context *context = NULL;
    csgm_scene *scene = NULL;
    csgm_field *field = NULL;
    csgm_context_options how = csgm_context_options_default();
    how.threads = threads;
    *out = csgm_walls_default();
    assert_int_equal(csgm_context_create(&how, &context), CSGM_OK);
    assert_int_equal(csgm_scene_parse(context, text, strlen(text), "test", NULL, &scene), CSGM_OK);
    assert_int_equal(csgm_field_compile(context, scene, &field), CSGM_OK);
    csgm_status status = csgm_walls_of_field(context, field, &options, out);
    csgm_field_destroy(field);
    csgm_scene_destroy(scene);
    csgm_context_destroy(context);
    return status;
}

static csgm_wall_options options_to(double tolerance)
{
    csgm_wall_options options = csgm_wall_options_default();
    options.tolerance = tolerance;
    options.most_pairs = 1 << 19;
    return options;
}

/* wanted: INFINITY where there is none. */
static void assert_span(const csgm_span *span, double wanted, double within)
{
    assert_true(span->length.low <= wanted);
    assert_true(span->length.high >= wanted * (1 - 1e-5) - 1e-5);
    if (wanted >= INFINITY) {
        assert_true(span->length.low >= INFINITY);
        assert_false(span->is_shown);
        return;
    }
    assert_true(span->length.low >= wanted - within);
    assert_true(span->length.high <= wanted + within);
    assert_true(span->is_shown);
    double apart = csg_vec3_norm(csg_vec3_sub(span->at[1], span->at[0]));
    assert_true(fabs(apart - span->length.high) <= 1e-9 * apart);
}

static void test_closed_forms(void **state)
{
    static const struct {
        const char *text;
        double wall, gap, within;
    } rows[] = {
        {"cube([10, 20, 30]);", 10, INFINITY, 0.5},
        {"sphere(5);", 10, INFINITY, 0.5},
        {"difference() { cube([10, 20, 30]); translate([1, 1, 2]) cube([8, 18, 40]); }", 1, 8, 0.6},
        /* two plates: the gap between them is outside */
        {"rotate([20, 30, 40]) { cube([10, 10, 2]); translate([0, 0, 3]) cube([10, 10, 1]); }", 1,
         1, 0.2},
        /* a groove with an edge at its bottom: the wall is below the edge */
        {"difference() { cube([20, 20, 5]); translate([10, -1, 6]) rotate([0, 45, 0])"
         " cube([4, 30, 4], center = true); }",
         5 + 1 - 2.8284271247461903, INFINITY, 0.3},
        /* solids that share a face have neither gap nor wall there */
        {"cube(10); translate([10, 0, 0]) cube(10);", 10, INFINITY, 0.5},
        {"cube(10); translate([2, 2, 10]) cube(5);", 5, INFINITY, 0.3},
    };
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        csgm_walls walls;
        assert_int_equal(find(rows[i].text, options_to(0.01), 1, &walls), CSGM_OK);
        assert_span(&walls.wall, rows[i].wall, rows[i].within);
        if (rows[i].gap < INFINITY)
            assert_span(&walls.gap, rows[i].gap, rows[i].within);
        else
            assert_false(walls.gap.is_shown);
    }
}

static uint32_t solids = 4;
static uint64_t seed = 12;

/* Two balls are cut out of a cube: what is left is thinnest between them, or before a face. */
static void test_random_voids(void **state)
{
    csg_random dice = {seed};
    (void)state;
    for (uint32_t i = 0; i < solids; i++) {
        csg_vec3 at[2];
        double r[2], thin = 20, narrow = INFINITY;
        char text[320];
        csgm_walls walls;
        do {
            for (int b = 0; b < 2; b++) {
                double x = csg_random_uniform(&dice, 5, 15), y = csg_random_uniform(&dice, 5, 15);
                at[b] = csg_vec3_make(x, y, csg_random_uniform(&dice, 5, 15));
                r[b] = csg_random_uniform(&dice, 1, 4);
            }
        } while (csg_vec3_norm(csg_vec3_sub(at[1], at[0])) < r[0] + r[1] + 0.5);
        thin = csg_vec3_norm(csg_vec3_sub(at[1], at[0])) - r[0] - r[1];
        for (int b = 0; b < 2; b++) {
            const double c[3] = {at[b].x, at[b].y, at[b].z};
            narrow = fmin(narrow, 2 * r[b]);
            for (int k = 0; k < 3; k++)
                thin = fmin(thin, fmin(c[k], 20 - c[k]) - r[b]);
        }
        snprintf(text, sizeof text,
                 "difference() { cube(20); translate([%.17g, %.17g, %.17g]) sphere(%.17g);"
                 " translate([%.17g, %.17g, %.17g]) sphere(%.17g); }",
                 at[0].x, at[0].y, at[0].z, r[0], at[1].x, at[1].y, at[1].z, r[1]);
        assert_int_equal(find(text, options_to(0.01), 1, &walls), CSGM_OK);
        assert_span(&walls.wall, thin, 0.25);
        assert_span(&walls.gap, narrow, 0.25);
    }
}

static void test_knives_and_angles(void **state)
{
    static const char text[] = /* 20 degrees */
        "difference() { cube([20, 4, 10]); rotate([0, -20, 0]) translate([-5, -1, -20])"
        " cube([40, 6, 20]); }";
    csgm_wall_options options = options_to(0.01);
    csgm_walls walls;
    (void)state;
    assert_int_equal(find(text, options, 1, &walls), CSGM_OK);
    assert_true(walls.wall.length.high < 4);
    options.angle_deg = 5;
    options.finest = 0.5;
    assert_int_equal(find(text, options, 1, &walls), CSGM_OK);
    assert_true(walls.wall.length.low <= 4 && walls.wall.length.low > 3);
}

static void test_same_for_any_threads(void **state)
{
    static const char text[] = "difference() { cube(20); translate([6, 7, 8]) sphere(4); }";
    csgm_walls one, two;
    (void)state;
    assert_int_equal(find(text, options_to(0.01), 1, &one), CSGM_OK);
    assert_int_equal(find(text, options_to(0.01), 2, &two), CSGM_OK);
    assert_int_equal(one.pairs, two.pairs);
    assert_memory_equal(&one.wall.length, &two.wall.length, sizeof one.wall.length);
    assert_memory_equal(one.wall.at, two.wall.at, sizeof one.wall.at);
    assert_memory_equal(one.gap.at, two.gap.at, sizeof one.gap.at);
}

static void test_limits_and_refusals(void **state)
{
    csgm_wall_options options = options_to(1e-6);
    csgm_walls walls;
    (void)state;
    options.most_pairs = 2000;
    assert_int_equal(find("torus(8, 2);", options, 1, &walls), CSGM_OK);
    assert_false(walls.is_reached);
    assert_true(walls.wall.length.low <= 4 && walls.wall.length.high >= 4 - 1e-3);
    assert_int_equal(find("plane([0, 0, 1]);", options, 1, &walls), CSGM_ERR_SCENE);
    options.angle_deg = 41;
    assert_int_equal(find("cube(1);", options, 1, &walls), CSGM_ERR_ARGUMENT);
    options = options_to(-1);
    assert_int_equal(find("cube(1);", options, 1, &walls), CSGM_ERR_ARGUMENT);
    options = options_to(0.01);
    options.part = "lid";
    assert_int_equal(find("cube(1);", options, 1, &walls), CSGM_ERR_ARGUMENT);
    assert_int_equal(find("part(\"lid\") cube(1); part(\"box\") translate([3, 0, 0]) cube(5);",
                          options, 1, &walls),
                     CSGM_OK);
    assert_span(&walls.wall, 1, 0.05);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_closed_forms),        cmocka_unit_test(test_random_voids),
        cmocka_unit_test(test_knives_and_angles),   cmocka_unit_test(test_same_for_any_threads),
        cmocka_unit_test(test_limits_and_refusals),
    };
    if (argc > 1)
        solids = (uint32_t)strtoul(argv[1], NULL, 10);
    if (argc > 2)
        seed = strtoull(argv[2], NULL, 10);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
