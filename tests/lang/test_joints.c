/* SPDX-License-Identifier: MIT
 * Warnings about blends that swell, fill gaps or join nothing: where they come and where not, and
 * that the swelling they tell of is the one that the field has.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/random.h"
#include "lang/support.h"
#include "scene/reference.h"

static bench b;

enum { SWELLS = -340, FILLS = -341, MISSES = -304 };

#define BRACKET "union(blend = 3) { cube([40, 20, 5]); cube([5, 20, 40]); }"

static void check(const char *text, int code)
{
    if (bench_compile(&b, text) != CSGM_OK)
        fail_msg("%s: %s", text, b.text);
    if (b.code_count != (code != 0) || (code && !bench_has(&b, code)))
        fail_msg("%s: not just %d, but %s", text, code, b.text);
}

static void swelling_looks_like_this(void **state)
{
    check(BRACKET, SWELLS);
    assert_string_equal(
        b.text, "scene.txt:1:1: warning W0340: the blend swells by 0.879 beyond the face at "
                "x = 0, which its solids have in common\n" BRACKET "\n"
                "^~~~~\n"
                "hint: blend = fillet(3) ends flush with it\n");
}

static void swelling_is_told_where_it_is_seen(void **state)
{
    check("rotate([30, 40, 50]) translate([1, 2, 3]) " BRACKET, SWELLS);
    check("difference() { " BRACKET " translate([20, 10, -50]) cylinder(h = 100, r = 2); }",
          SWELLS);
    check("union(blend = overblend(3)) { cube([40, 20, 5]); cube([5, 20, 40]); }", SWELLS);
    check("linear_extrude(5) union(blend = 2) { square([20, 5]); square([5, 20]); }", SWELLS);
    /* each ends where the next one does, side by side */
    check("union(blend = 2) { cube(9); translate([9, 1, 1]) cube([9, 7, 8]); }", SWELLS);
}

static void no_swelling_where_there_is_none(void **state)
{
    check("union(blend = fillet(3)) { cube([40, 20, 5]); cube([5, 20, 40]); }", 0);
    check("union() { cube([40, 20, 5]); cube([5, 20, 40]); }", 0);
    check("union(blend = 3) { cube([40, 20, 5]); translate([5, 5, 2]) cube([5, 9, 40]); }", 0);
    check("intersection() { cube([90, 20, 90]); " BRACKET " }", 0);             /* cut off */
    check("union() { translate([-5, -5, -5]) cube(60); " BRACKET " }", 0);      /* covered */
    check("difference() { translate([-5, -5, -5]) cube(60); " BRACKET " }", 0); /* cut out */
    check("linear_extrude(2) union(blend = 3) { circle(10); translate([5, 0]) circle(10); }", 0);
    check("linear_extrude(5) union(blend = 3) { translate([0, 1]) square([10, 9]); "
          "translate([9, 0]) square([10, 9.5]); }",
          0);
    /* balls end in one plane, too, but have no faces */
    check("union(blend = 2) { sphere(5); translate([6, 0, 0]) sphere(5); }", 0);
    check("union(blend = 0.1) for (i = [0 : 40]) translate([i / 8, 0, 0]) sphere(2);", 0);
    check(
        "rotate_extrude() translate([9, 0]) union(blend = 2) { square([20, 5]); square([5, 20]); }",
        0);
}

static void filled_gaps_are_told(void **state)
{
    check("union(blend = 8) { cube([40, 40, 5]); translate([0, 0, 7]) cube([40, 40, 5]); }", FILLS);
    assert_non_null(strstr(b.text, "fills the gap of 2 between its solids around z = 6"));
    assert_non_null(strstr(b.text, "blend = fillet(8) keeps gaps open"));
    check("union(blend = fillet(8)) { cube([40, 40, 5]); translate([0, 0, 7]) cube([40, 40, 5]); }",
          0);
    check("union(blend = 3) { cube([40, 40, 5]); translate([0, 0, 7]) cube([40, 40, 5]); }", 0);
    /* faces that are apart by rounding */
    check("union(blend = 1) for (i = [0 : 9]) translate([i * 10.1, i, 0]) cube([10.1, 8, 5 + i]);",
          SWELLS);
    /* balls that grow together are what blends are for */
    check("union(blend = 4) { sphere(5); translate([11, 0, 0]) sphere(5); }", 0);
}

static void blends_of_nothing_are_told(void **state)
{
    check("union(blend = 2) { sphere(5); translate([500, 0, 0]) sphere(2); }", MISSES);
    assert_non_null(strstr(b.text, "the blend joins nothing: its solids are 493 apart"));
    /* far away, and yet it acts: the field of what is stretched rises slowly */
    check("union(blend = 1) { scale([1, 1, 100]) sphere(1); translate([0, 0, 210]) "
          "scale([1, 1, 100]) sphere(1); }",
          0);
    check("union(blend = 2) { sphere(5); translate([8, 0, 0]) sphere(2); translate([500, 0, 0]) "
          "sphere(2); }",
          0);
}

/* Two random boxes that share the plane z = 0: it is told by how much the field is inside there,
 * where they overlap, and nothing where they are apart by more than the blend sees. */
static void swelling_is_as_large_as_the_field_says(void **state)
{
    csg_random random = {41};
    int told = 0;
    for (int i = 0; i < 200; i++) {
        double w[8];
        char text[400], by[40];
        for (int k = 0; k < 8; k++)
            w[k] = csg_random_uniform(&random, 4, 12);
        snprintf(text, sizeof text,
                 "union(blend = %.17g) { cube([%.17g, %.17g, %.17g]); translate([%.17g, 1, 0]) "
                 "cube([%.17g, %.17g, %.17g]); }",
                 w[0] / 3, w[1], w[2], w[3], w[4], w[5], w[6], w[7]);
        assert_int_equal(bench_compile(&b, text), CSGM_OK);
        if (!(w[4] < w[1]))
            continue;
        csgm_status status = CSGM_OK;
        double y = 0.5 * (1 + fmin(w[2], 1 + w[6]));
        csg_vec3 middle = csg_vec3_make(0.5 * (w[4] + fmin(w[1], w[4] + w[5])), y, 0);
        double inside = csg_reference_eval(b.scene, middle, &status).value;
        assert_true(bench_has(&b, SWELLS) && inside > 0);
        snprintf(by, sizeof by, "swells by %.3g beyond", w[0] / 3 * (1 - sqrt(0.5)));
        if (!strstr(b.text, by))
            fail_msg("%s: not %s, but %s", text, by, b.text);
        told++;
    }
    assert_in_range(told, 60, 200);
}

/* The work is bounded. */
static void very_many_blends_are_not_all_looked_at(void **state)
{
    assert_int_equal(bench_compile(&b, "for (i = [1 : 20000]) translate([0, 0, 90 * i]) " BRACKET),
                     CSGM_OK);
    assert_true(bench_has(&b, SWELLS));
    /* one that takes long to ask is not asked */
    check(
        "union(blend = 1) for (k = [0 : 63]) translate([3 * k, 0, 0]) union() for (i = [0 : 300]) "
        "translate([rands(0, 0.5, 1)[0], i * 0.001, 0]) cube([3.5, 10, 10]);",
        0);
}

static int open_bench(void **state)
{
    bench_open(&b, NULL);
    return 0;
}

static int close_bench(void **state)
{
    bench_close(&b);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(swelling_looks_like_this),
        cmocka_unit_test(swelling_is_told_where_it_is_seen),
        cmocka_unit_test(no_swelling_where_there_is_none),
        cmocka_unit_test(filled_gaps_are_told),
        cmocka_unit_test(blends_of_nothing_are_told),
        cmocka_unit_test(swelling_is_as_large_as_the_field_says),
        cmocka_unit_test(very_many_blends_are_not_all_looked_at),
    };
    return cmocka_run_group_tests(tests, open_bench, close_bench);
}
