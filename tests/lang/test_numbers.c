/* SPDX-License-Identifier: MIT
 * Numbers as blends: solids that meet are rounded, end flush, and others stay as they are.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "base/random.h"
#include "lang/bench_fixture.h"
#include "scene/boxes/bounds.h"
#include "scene/reference.h"

enum { POINTS = 2000 };

static double value_at(csg_vec3 p)
{
    csgm_status status = CSGM_OK;
    csg_sample sample = csg_reference_eval(b.scene, p, &status);
    assert_int_equal(status, CSGM_OK);
    return sample.value;
}

static void compile(const char *text)
{
    csgm_status status = bench_compile(&b, text);
    if (status != CSGM_OK)
        print_error("%s\n%s", text, b.text);
    assert_int_equal(status, CSGM_OK);
}

static csg_vec3 random_point(csg_random *random, csg_box box)
{
    return csg_vec3_make(csg_random_uniform(random, box.min.x, box.max.x),
                         csg_random_uniform(random, box.min.y, box.max.y),
                         csg_random_uniform(random, box.min.z, box.max.z));
}

/* The field of one scene, or only its sign, is that of the other. */
static void check_alike(const char *scene, const char *other, csg_box box, bool only_sign)
{
    double first[POINTS];
    for (int turn = 0; turn < 2; turn++) {
        csg_random random = {7};
        compile(turn ? other : scene);
        for (int i = 0; i < POINTS; i++) {
            double value = value_at(random_point(&random, box));
            bool same = only_sign ? (value > 0) == (first[i] > 0) : value == first[i];
            if (turn && !same)
                print_error("%s\n%s\n%d: %.17g %.17g\n", scene, other, i, first[i], value);
            assert_true(!turn || same);
            first[i] = value;
        }
    }
}

static const csg_box around = {{-10, -10, -10}, {50, 50, 50}};

/* /work/shared/cases/box2.txt, turned too: a quarter circle in the corner, nothing elsewhere. */
static void a_bracket_keeps_its_faces(void **state)
{
    (void)state;
    static const char *const turns[] = {"", "rotate([0, 0, 30]) ", "rotate([20, 30, 40]) "};
    for (int t = 0; t < 3; t++) {
        char scene[300], wanted[600];
        snprintf(scene, sizeof scene,
                 "%sunion(blend = 3) { cube([40, 20, 5]); cube([5, 20, 40]); }", turns[t]);
        snprintf(wanted, sizeof wanted,
                 "%s{ cube([40, 20, 5]); cube([5, 20, 40]); difference() { translate([5, 0, 5]) "
                 "cube([3, 20, 3]); translate([8, -1, 8]) rotate([-90, 0, 0]) cylinder(h = 22, r = "
                 "3); } }",
                 turns[t]);
        check_alike(scene, wanted, around, true);
    }
    compile("union(blend = 3) { cube([40, 20, 5]); cube([5, 20, 40]); }");
    csg_box box = csg_bounds_of_solid(b.scene);
    assert_true(box.min.x == 0 && box.min.y == 0 && box.min.z == 0);
    assert_true(box.max.x == 40 && box.max.y == 20 && box.max.z == 40);
}

/* In the plane, and around an axis that two cylinders have in common. */
static void figures_and_cylinders_end_flush(void **state)
{
    (void)state;
    const csg_box box = {{-12, -12, -2}, {12, 12, 22}};
    check_alike("linear_extrude(5) union(blend = 2) { square([9, 3]); square([3, 9]); }",
                "linear_extrude(5) difference() { union() { square([9, 3]); square([3, 9]); "
                "translate([3, 3]) square(2); } translate([5, 5]) circle(2); }",
                box, true);
    check_alike(
        "union(blend = 3) { cylinder(h = 12, r = 8); translate([0, 0, 8]) cylinder(h = 12, r "
        "= 8); }",
        "cylinder(h = 20, r = 8);", box, true);
    check_alike(
        "rotate([0, 90, 0]) union(blend = 3) { cylinder(h = 8, r = 6); cylinder(h = 12, r = "
        "6); }",
        "rotate([0, 90, 0]) cylinder(h = 12, r = 6);", box, true);
}

/* Without a face that would have to stay flat: no flats, no edges. */
static void curved_solids_stay_soft(void **state)
{
    (void)state;
#define BALLS "sphere(10); translate([1, 0, 0]) sphere(10);"
#define TUBE "capsule([0, 0, 0], [0, 12, 0], 4); "
    check_alike("union(blend = 6) {" BALLS "}", "union(blend = round(6)) {" BALLS "}", around,
                false);
    check_alike("union(blend = 6) {" TUBE "torus(r = 9, tube = 5); }",
                "union(blend = round(6)) {" TUBE "torus(r = 9, tube = 5); }", around, false);
    /* the cylinder's cap lies within what swells */
#define CAPPED " translate([0, 0, -5]) cylinder(h = 16, r = 4); }"
    check_alike("union(blend = 4) { union(blend = 6) {" BALLS "}" CAPPED,
                "union(blend = round(4)) { union(blend = round(6)) {" BALLS "}" CAPPED, around,
                false);
#undef BALLS
#undef TUBE
#undef CAPPED
}

/* Caps of what is turned, twisted or bent are faces, and so are sides that go round an axis. */
static void what_is_warped_ends_flush(void **state)
{
    (void)state;
    const csg_box box = {{-14, -14, -14}, {26, 26, 26}};
#define TURN "rotate([20, 30, 40]) "
    check_alike(TURN "union(blend = 3) { rotate_extrude() square([8, 12]); cylinder(h = 20, r = "
                     "8); }",
                TURN "cylinder(h = 20, r = 8);", box, true);
    check_alike(TURN "union(blend = 3) { rotate_extrude() square([8, 12]); rotate_extrude() "
                     "square([8, 15]); }",
                TURN "cylinder(h = 15, r = 8);", box, true);
#define TWISTED                                                                                    \
    "union(blend = 3) { linear_extrude(20, twist = 90) square(10, center = true); cylinder(h = "   \
    "20, r = 5.2); }"
    check_alike(TURN TWISTED,
                TURN "intersection() { " TWISTED " translate([-30, -30, 0]) cube([60, 60, 20]); }",
                box, true);
#undef TURN
#undef TWISTED
}

/* As OpenSCAD's files make half a ball, and a post with a round head. */
static void cut_and_rounded_solids_end_flush(void **state)
{
    (void)state;
    const csg_box box = {{-16, -16, -16}, {16, 16, 21}};
#define HALF                                                                                       \
    "union(blend = 3) { difference() { sphere(15); translate([-20, -20, -40]) cube(40); } "        \
    "cylinder(h = 20, r = 5); }"
    check_alike("rotate([20, 30, 40]) " HALF,
                "rotate([20, 30, 40]) intersection() { " HALF
                " translate([-20, -20, 0]) cube(40); }",
                box, true);
#undef HALF
    check_alike("union(blend = 3) { cylinder(h = 20, r = 5); sphere(5); translate([0, 0, 20]) "
                "torus(r = 3, tube = 2); }",
                "intersection() { union(blend = round(3)) { cylinder(h = 20, r = 5); sphere(5); "
                "translate([0, 0, 20]) torus(r = 3, tube = 2); } translate([0, 0, -30]) "
                "cylinder(h = 60, r = 5); }",
                box, true);
}

static void what_does_not_meet_does_not_blend(void **state)
{
    (void)state;
    check_alike("union(blend = 8) { cube([40, 40, 5]); translate([0, 0, 7]) cube([40, 40, 5]); }",
                "union() { cube([40, 40, 5]); translate([0, 0, 7]) cube([40, 40, 5]); }", around,
                false);
    check_alike(
        "union(blend = 2) { sphere(9); translate([9, 0, 0]) sphere(5); translate([16, 0, 0]) "
        "sphere(1.9); }",
        "union() { union(blend = 2) { sphere(9); translate([9, 0, 0]) sphere(5); } "
        "translate([16, 0, 0]) sphere(1.9); }",
        around, false);
    check_alike(
        "difference(blend = 3) { cube(40); translate([20, 20, 6]) sphere(4); translate([20, "
        "20, 40]) sphere(9); translate([18, 20, 6]) sphere(4); }",
        "difference() { difference(blend = round(3)) { cube(40); translate([20, 20, 40]) "
        "sphere(9); } union(blend = 3) { translate([20, 20, 6]) sphere(4); translate([18, 20, "
        "6]) sphere(4); } }",
        around, false);
    check_alike("intersection(blend = 2) { cube(20); sphere(22); }",
                "intersection(blend = round(2)) { cube(20); sphere(22); }", around, false);
}

static void the_order_does_not_matter(void **state)
{
    (void)state;
#define A "cube([30, 20, 5]);"
#define B "translate([3, 4, 0]) cylinder(h = 30, r = 3);"
#define C "translate([3, 4, 25]) cube([20, 9, 5]);"
#define D "translate([40, 0, 0]) sphere(6);"
    check_alike("union(blend = 3) {" A B C D "}", "union(blend = 3) {" D C B A "}", around, false);
    check_alike("union(blend = 3) {" A B C D "}", "union(blend = 3) {" B D A C "}", around, false);
#undef A
#undef B
#undef C
#undef D
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_bracket_keeps_its_faces),
        cmocka_unit_test(figures_and_cylinders_end_flush),
        cmocka_unit_test(curved_solids_stay_soft),
        cmocka_unit_test(what_is_warped_ends_flush),
        cmocka_unit_test(cut_and_rounded_solids_end_flush),
        cmocka_unit_test(what_does_not_meet_does_not_blend),
        cmocka_unit_test(the_order_does_not_matter),
    };
    return cmocka_run_group_tests(tests, open_bench, close_bench);
}
