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

enum { SWELLS = -340, FILLS = -341, CUTS = -342, MISSES = -304 };

#define BRACKET "union(blend = round(3)) { cube([40, 20, 5]); cube([5, 20, 40]); }"

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
    check("linear_extrude(5) union(blend = round(2)) { square([20, 5]); square([5, 20]); }",
          SWELLS);
    /* each ends where the next one does, side by side */
    check("union(blend = round(2)) { cube(9); translate([9, 1, 1]) cube([9, 7, 8]); }", SWELLS);
}

static void no_swelling_where_there_is_none(void **state)
{
    check("union(blend = fillet(3)) { cube([40, 20, 5]); cube([5, 20, 40]); }", 0);
    check("union() { cube([40, 20, 5]); cube([5, 20, 40]); }", 0);
    check("union(blend = round(3)) { cube([40, 20, 5]); translate([5, 5, 2]) cube([5, 9, 40]); }",
          0);
    check("intersection() { cube([90, 20, 90]); " BRACKET " }", 0);             /* cut off */
    check("union() { translate([-5, -5, -5]) cube(60); " BRACKET " }", 0);      /* covered */
    check("difference() { translate([-5, -5, -5]) cube(60); " BRACKET " }", 0); /* cut out */
    check("linear_extrude(2) union(blend = round(3)) { circle(10); translate([5, 0]) circle(10); }",
          0);
    check("linear_extrude(5) union(blend = round(3)) { translate([0, 1]) square([10, 9]); "
          "translate([9, 0]) square([10, 9.5]); }",
          0);
    /* balls end in one plane, too, but have no faces */
    check("union(blend = round(2)) { sphere(5); translate([6, 0, 0]) sphere(5); }", 0);
    check("union(blend = round(0.1)) for (i = [0 : 40]) translate([i / 8, 0, 0]) sphere(2);", 0);
    check("rotate_extrude() translate([9, 0]) union(blend = round(2)) { square([20, 5]); "
          "square([5, 20]); }",
          0);
}

static void filled_gaps_are_told(void **state)
{
    check("union(blend = round(8)) { cube([40, 40, 5]); translate([0, 0, 7]) cube([40, 40, 5]); }",
          FILLS);
    assert_non_null(strstr(b.text, "fills the gap of 2 between its solids around z = 6"));
    assert_non_null(strstr(b.text, "blend = fillet(8) keeps gaps open"));
    check("union(blend = fillet(8)) { cube([40, 40, 5]); translate([0, 0, 7]) cube([40, 40, 5]); }",
          MISSES);
    assert_non_null(strstr(b.text, "its solids are 2 apart"));
    assert_non_null(strstr(b.text, "blend = round(8) joins what does not meet"));
    check("union(blend = fillet(4)) { sphere(5); translate([11, 0, 0]) sphere(5); }", MISSES);
    check("union(blend = fillet(4)) { sphere(5); translate([9, 0, 0]) sphere(5); }", 0);
    check("union(blend = 8) { cube([40, 40, 5]); translate([0, 0, 7]) cube([40, 40, 5]); }",
          MISSES);
    check("union(blend = round(3)) { cube([40, 40, 5]); translate([0, 0, 7]) cube([40, 40, 5]); }",
          0);
    /* faces that are apart by rounding */
    check("union(blend = round(1)) for (i = [0 : 9]) translate([i * 10.1, i, 0]) cube([10.1, 8, 5 "
          "+ i]);",
          SWELLS);
    /* balls that grow together are what blends are for */
    check("union(blend = round(4)) { sphere(5); translate([11, 0, 0]) sphere(5); }", 0);
}

static void blends_of_nothing_are_told(void **state)
{
    check("union(blend = round(2)) { sphere(5); translate([500, 0, 0]) sphere(2); }", MISSES);
    assert_non_null(strstr(b.text, "the blend joins nothing: its solids are 493 apart"));
    /* far away, and yet it acts: the field of what is stretched rises slowly */
    check("union(blend = round(1)) { scale([1, 1, 100]) sphere(1); translate([0, 0, 210]) "
          "scale([1, 1, 100]) sphere(1); }",
          0);
    check("union(blend = round(2)) { sphere(5); translate([8, 0, 0]) sphere(2); translate([500, 0, "
          "0]) "
          "sphere(2); }",
          0);
}

static void cuts_that_blend_nothing_are_told(void **state)
{
    check("difference(blend = round(1)) { cube(20); translate([50, 0, 0]) sphere(5); }", MISSES);
    assert_non_null(strstr(b.text, "joins nothing: its solids' surfaces are 25 apart"));
    /* a cavity: nothing meets; a hole does, and so do two cavities */
    check("difference(blend = round(1)) { cube(60, center = true); sphere(5); }", MISSES);
    assert_non_null(strstr(b.text, "are 21.3 apart")); /* of the ball's box, by its half diagonal */
    check(
        "difference(blend = round(1)) { cube(60, center = true); cylinder(h = 90, r = 5, center = "
        "true); }",
        0);
    check("difference(blend = round(1)) { cube(60, center = true); sphere(5); translate([4, 0, 0]) "
          "sphere(5); }",
          0);
    check("difference(blend = round(1)) { cube(60, center = true); translate([24, 0, 0]) "
          "sphere(5); }",
          0);
    check("intersection(blend = round(1)) { sphere(50); cube(9, center = true); }", MISSES);
    check("intersection(blend = round(1)) { sphere(5); cube(9, center = true); }", 0);
    check("intersection(blend = round(1)) { plane([0, 0, 1], 90); cube(9, center = true); }",
          MISSES);
    check("difference(blend = round(1)) { cube(20); translate([50, 0, 0]) sphere(5); translate([9, "
          "9, 18]) "
          "sphere(5); }",
          0);
    check("intersection() { cube(90, center = true); intersection(blend = round(1)) { plane([0, "
          "-1, 0], "
          "-25); plane([1, 1, 0], 3); } }",
          0);
    /* what is stretched: its field rises slowly, and blends where its surface is far */
    check("difference(blend = round(1)) { scale([1, 1, 100]) sphere(1); translate([0, 0, 210]) "
          "scale([1, 1, 100]) sphere(1); }",
          0);
}

#define PLATES "union() { cube([20, 20, 5]); translate([0, 0, 5]) cube([20, 20, 5]); }"
#define HOLE "translate([10, 10, -1]) cylinder(h = 30, r = 4);"

static void cut_seams_are_told(void **state)
{
    check("difference(blend = round(1)) { " PLATES HOLE " }", CUTS);
    assert_non_null(strstr(b.text, "cuts a groove of 0.9 along the face at z = 5"));
    check("difference(blend = fillet(1)) { color(\"red\") " PLATES HOLE " }", CUTS);
    check("rotate([30, 40, 50]) intersection(blend = round(1)) { cube(9); translate([1, 2, "
          "1]) " PLATES " }",
          CUTS);
    /* halves that mirror each other, and a joint of flat figures */
    check("difference(blend = round(1)) { for (s = [0, 1]) mirror([0, 0, s]) linear_extrude(9, "
          "twist = "
          "20) square(20, center = true); " HOLE " }",
          CUTS);
    check(
        "linear_extrude(5) difference(blend = round(1)) { union() { square(10); translate([10, 0]) "
        "square(10); } translate([10, 5]) circle(2); }",
        CUTS);
    /* what lies between the seam and the blend does not matter where it does nothing */
    check("difference(blend = round(1)) { union(blend = round(2)) { difference() { " PLATES
          " translate([18, 18, -1]) cube(20); } translate([3, 1, 9]) cube([12, 1, 5]); } " HOLE
          " }",
          CUTS);
    /* of many holes the last one */
    check("difference(blend = round(1)) { " PLATES
          " for (i = [0 : 6]) translate([2 + 2.5 * i, 15, i]) "
          "cylinder(h = 1, r = 1); " HOLE " }",
          CUTS);
    check("union(blend = round(1)) { difference() { cube(30); translate([5, 5, 5]) cube([10, 20, "
          "30]); "
          "translate([15, 5, 5]) cube([10, 20, 30]); } translate([15, 15, 2]) cylinder(h = 20, r "
          "= 3); }",
          CUTS);
    assert_non_null(strstr(b.text, "leaves a fin of"));
}

static void no_seam_where_there_is_none(void **state)
{
    check("difference() { " PLATES HOLE " }", 0);
    check("difference(blend = round(1)) { union() { cube([20, 20, 6]); translate([0, 0, 5]) "
          "cube([20, 20, "
          "5]); } " HOLE " }",
          0);
    /* the blend fills the seam, another solid covers it, the hole stays away from it */
    check("difference(blend = round(1)) { union(blend = round(1)) { cube([20, 20, 5]); "
          "translate([1, 1, "
          "5]) cube([18, 18, 5]); } " HOLE " }",
          0);
    check("difference(blend = round(1)) { union() { " PLATES
          " translate([1, 1, 1]) cube([18, 18, 8]); } " HOLE " }",
          0);
    check("difference(blend = round(1)) { " PLATES
          " translate([10, 10, 7]) cylinder(h = 30, r = 4); }",
          0);
    check("difference(blend = round(1)) { " PLATES " translate([10, 10, 7]) sphere(2); }", CUTS);
    check("difference(blend = round(1)) { " PLATES
          " translate([40, 10, -1]) cylinder(h = 30, r = 4); }",
          MISSES);
    /* cut off, or not seen since something else is there */
    check("intersection() { cube([20, 20, 4]); difference(blend = round(1)) { " PLATES HOLE " } }",
          0);
    check("union() { difference(blend = round(1)) { " PLATES HOLE
          " } translate([3, 3, 3]) cube([14, 14, "
          "4]); }",
          0);
    /* balls that touch in a point have no face in common */
    check("difference(blend = round(1)) { union() { sphere(5); translate([10, 0, 0]) sphere(5); } "
          "translate([5, 0, -9]) cylinder(h = 18, r = 1); }",
          0);
    /* two pockets side by side */
    check("difference(blend = round(1)) { cube(30); translate([5, 5, 5]) cube([10, 20, 30]); "
          "translate([15, 5, 5]) cube([10, 20, 30]); }",
          0);
}

/* Two random boxes on each other with a hole through both: the field is below 0 on the seam by the
 * hole's wall, wherever it is told. */
static void seams_are_cut_where_it_is_told(void **state)
{
    csg_random random = {43};
    int told = 0;
    for (int i = 0; i < 100; i++) {
        double w[6], x, y, z;
        char text[400];
        for (int k = 0; k < 6; k++)
            w[k] = csg_random_uniform(&random, 6, 12);
        snprintf(text, sizeof text,
                 "difference(blend = round(%.17g)) { union() { cube([%.17g, %.17g, %.17g]); "
                 "translate([0, 0, %.17g]) cube([%.17g, 7, 8]); } "
                 "translate([3, 3, -9]) cylinder(h = 99, r = %.17g); }",
                 w[0] / 20, w[1], w[2], w[3], w[3], w[4], w[5] / 8);
        assert_int_equal(bench_compile(&b, text), CSGM_OK);
        const char *at = strstr(b.text, ", at [");
        if (!bench_has(&b, CUTS) || !at)
            fail_msg("%s: %s", text, b.text);
        assert_int_equal(sscanf(at, ", at [%lf, %lf, %lf]", &x, &y, &z), 3);
        csgm_status status = CSGM_OK;
        for (int k = -1; k <= 1; k++) {
            csg_vec3 p = csg_vec3_make(x, y, w[3] + k * w[0] / 40);
            double value = csg_reference_eval(b.scene, p, &status).value;
            assert_true(k == 0 ? value < 0 : value > 0);
        }
        told++;
    }
    assert_int_equal(told, 100);
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
        snprintf(
            text, sizeof text,
            "union(blend = round(%.17g)) { cube([%.17g, %.17g, %.17g]); translate([%.17g, 1, 0]) "
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

/* A hundred by a hundred cubes that touch, and as many holes: each pair is looked at once, until
 * the work is too much. */
static void very_many_seams_are_not_all_looked_at(void **state)
{
    bench_compile(
        &b, "difference(blend = round(0.1)) { for (x = [0 : 99], y = [0 : 99]) translate([x, y, "
            "0]) cube(1); for (x = [0 : 99]) translate([x, 50, -1]) cylinder(h = 3, r = "
            "0.2); }");
    check("for (x = [0 : 50]) translate([30 * x, 0, 0]) difference(blend = round(1)) { " PLATES HOLE
          " }",
          CUTS);
}

/* The work is bounded. */
static void very_many_blends_are_not_all_looked_at(void **state)
{
    assert_int_equal(bench_compile(&b, "for (i = [1 : 20000]) translate([0, 0, 90 * i]) " BRACKET),
                     CSGM_OK);
    assert_true(bench_has(&b, SWELLS));
    /* one that takes long to ask is not asked */
    check("union(blend = round(1)) for (k = [0 : 63]) translate([3 * k, 0, 0]) union() for (i = [0 "
          ": 300]) "
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
        cmocka_unit_test(cuts_that_blend_nothing_are_told),
        cmocka_unit_test(cut_seams_are_told),
        cmocka_unit_test(no_seam_where_there_is_none),
        cmocka_unit_test(seams_are_cut_where_it_is_told),
        cmocka_unit_test(very_many_seams_are_not_all_looked_at),
        cmocka_unit_test(swelling_is_as_large_as_the_field_says),
        cmocka_unit_test(very_many_blends_are_not_all_looked_at),
    };
    return cmocka_run_group_tests(tests, open_bench, close_bench);
}
