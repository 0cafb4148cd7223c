/* SPDX-License-Identifier: MIT
 * Calls of solids, transforms, operators and blends: the field of the scene at chosen points.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "lang/bench_fixture.h"
#include "scene/reference.h"
#include "scene/tree/print.h"

static double value_at(double x, double y, double z)
{
    csgm_status status = CSGM_OK;
    csg_sample sample = csg_reference_eval(b.scene, csg_vec3_make(x, y, z), &status);
    assert_int_equal(status, CSGM_OK);
    return sample.value;
}

/* The scene compiles without a finding, and its field has this value here. */
static void check(const char *scene, double x, double y, double z, double wanted)
{
    csgm_status status = bench_compile(&b, scene);
    if (status != CSGM_OK || b.code_count)
        print_error("%s\n%s", scene, b.text);
    assert_int_equal(status, CSGM_OK);
    assert_int_equal(b.code_count, 0);
    double value = value_at(x, y, z);
    if (fabs(value - wanted) > 1e-9)
        print_error("%s at %g %g %g: %.17g, expected %.17g\n", scene, x, y, z, value, wanted);
    assert_true(fabs(value - wanted) <= 1e-9 || value == wanted);
}

/* Both scenes have the same field at points all around. */
static void check_same(const char *scene, const char *other)
{
    double first[64];
    for (int round = 0; round < 2; round++) {
        const char *text = round ? other : scene;
        csgm_status status = bench_compile(&b, text);
        if (status != CSGM_OK)
            print_error("%s\n%s", text, b.text);
        assert_int_equal(status, CSGM_OK);
        for (int i = 0; i < 64; i++) {
            double value =
                value_at((i & 3) * 1.7 - 2.1, (i >> 2 & 3) * 1.3 - 1.9, (i >> 4) * 1.9 - 2.7);
            if (round && !(fabs(value - first[i]) < 1e-12 || value == first[i]))
                print_error("%s != %s: %g %g\n", scene, other, first[i], value);
            assert_true(!round || fabs(value - first[i]) < 1e-12 || value == first[i]);
            first[i] = value;
        }
    }
}

static void solids_have_their_sizes(void **state)
{
    (void)state;
    check("sphere(5);", 7, 0, 0, -2);
    check("sphere(d = 8);", 0, 0, 0, 4);
    check("sphere();", 0, 0, 3, -2);
    check("cube(2);", 1, 1, 3, -1);
    check("cube();", 0.5, 0.5, 0.5, 0.5);
    check("cube([2, 4, 6], center = true);", 0, 0, 0, 1);
    check("cube([2, 4, 6], true);", 0, 3, 0, -1);
    check("cube(10, round = 2);", 5, 5, 11, -1);
    check("cube(10, round = 2);", 0, 0, 5, 2 - sqrt(8));
    check("cylinder(h = 10, r = 3);", 5, 0, 5, -2);
    check("cylinder(10, d = 6);", 0, 0, 12, -2);
    check("cylinder(h = 4, r = 3, center = true);", 0, 0, 3, -1);
    check("cylinder();", 0, 0, 0.5, 0.5);
    check("cylinder(10, 5);", 2, 0, 11, -sqrt(2)); /* r1 = 5, r2 = 1, as in OpenSCAD */
    check("cylinder(h = 10, r1 = 5, r2 = 0);", 0, 0, 12, -2);
    check("cylinder(h = 10, d1 = 10, d2 = 0);", 0, 0, 12, -2);
    check("cylinder(h = 10, r = 4, round = 1);", 4, 0, 10, 1 - sqrt(2));
    check("cylinder(h = 10, r = 2, round = 2);", 0, 0, 11, -1);
    check("capsule([0, 0, 0], [10, 0, 0], 2);", 5, 3, 0, -1);
    check("capsule(p2 = [10, 0, 0], r = 2);", 13, 0, 0, -1);
    check("capsule([0, 0, 0], [10, 0, 0], 1, 3);", 15, 0, 0, -2);
    check("torus(10, 2);", 10, 0, 0, 2);
    check("torus(r = 10, tube = 2, angle = 90);", 0, 10, 0, 2);
    check("torus(r = 10, tube = 2, angle = 90);", 10, -3, 0, -1);
    check("torus(r = 10, tube = 2, angle = -90);", 10, 3, 0, -1);
    check("torus(r = 10, tube = 2, angle = 180, center = true);", 0, 13, 0, -1);
    check("torus(r = 10, tube = 2, angle = 180, center = true);", -3, -10, 0, -1);
    check("ellipsoid([1, 2, 3]);", 0, 0, 5, -2);
    check("ellipsoid(2);", 3, 0, 0, -1);
    check("plane([0, 0, 2], 3);", 7, 8, 5, -2);
    check("plane();", 0, 0, -1, 1);
    check("sphere(r = undef);", 0, 0, 0, 1);
}

static void a_rounded_cone_keeps_its_outside(void **state)
{
    (void)state;
    /* the slanted side of the sharp cone is the side of the rounded one */
    check("cylinder(h = 10, r1 = 6, r2 = 1, round = 0.5);", 3.5, 0, 5, 0);
    check("cylinder(h = 10, r1 = 6, r2 = 1, round = 0.5);", 0, 0, 10.25, -0.25);
}

static void transforms_are_those_of_openscad(void **state)
{
    (void)state;
    check("translate([3, 0, 0]) sphere(1);", 3, 0, 0, 1);
    check("translate([3, 1]) sphere(1);", 3, 1, 2, -1);
    check("rotate(90) translate([5, 0, 0]) sphere(1);", 0, 5, 0, 1);
    check("rotate([90, 0, 0]) translate([0, 5, 0]) sphere(1);", 0, 0, 5, 1);
    check("rotate([90, 0, 90]) translate([0, 0, 5]) sphere(1);", 5, 0, 0, 1);
    check("rotate(a = 90, v = [0, 1, 0]) translate([0, 0, 5]) sphere(1);", 5, 0, 0, 1);
    check("scale(2) sphere(1);", 0, 0, 0, 2);
    check("scale([1, 2, 3]) sphere(1);", 0, 0, 3, 0);
    check("mirror([1, 0, 0]) translate([4, 0, 0]) sphere(1);", -4, 0, 0, 1);
    check("mirror([0, 0, 0]) translate([4, 0, 0]) sphere(1);", 4, 0, 0, 1);
    check("multmatrix([[1, 0, 0, 5], [0, 1, 0, 6], [0, 0, 1, 7], [0, 0, 0, 1]]) sphere(1);", 5, 6,
          7, 1);
    check("multmatrix([[0, -1, 0, 0], [1, 0, 0, 0], [0, 0, 1, 0]]) translate([5, 0, 0]) sphere(1);",
          0, 5, 0, 1);
    check("translate([1, 0, 0]) { sphere(1); translate([4, 0, 0]) sphere(1); }", 5, 0, 0, 1);
    check("group() render(convexity = 4) sphere(2);", 0, 0, 0, 2);
}

static void operators_mean_what_they_say(void **state)
{
    (void)state;
    check("difference() { cube(10, center = true); sphere(3); }", 0, 0, 0, -3);
    check("intersection() { cube(10, center = true); sphere(3); }", 4, 0, 0, -1);
    check("union() { sphere(1); translate([5, 0, 0]) sphere(1); }", 5, 0, 0, 1);
    check_same("difference() { sphere(5); cube(3); translate([-2, 0, 0]) sphere(2); }",
               "difference() { sphere(5); union() { cube(3); translate([-2, 0, 0]) sphere(2); } }");
    check_same("sphere(1); translate([3, 0, 0]) cube(1);",
               "union() { sphere(1); translate([3, 0, 0]) cube(1); }");
    /* children of a for loop are one child of a difference or intersection */
    check_same(
        "intersection() { for (i = [0, 3]) translate([i, 0, 0]) sphere(2); sphere(3); }",
        "intersection() { union() { sphere(2); translate([3, 0, 0]) sphere(2); } sphere(3); }");
    check_same("difference() { for (i = [0, 3]) translate([i, 0, 0]) sphere(2); cube(1); }",
               "difference() { union() { sphere(2); translate([3, 0, 0]) sphere(2); } cube(1); }");
    check_same("intersection_for (i = [0, 1]) translate([i, 0, 0]) sphere(2);",
               "intersection() { sphere(2); translate([1, 0, 0]) sphere(2); }");
    check_same("difference() { echo(); sphere(2); cube(1); }",
               "difference() { sphere(2); cube(1); }");
    check_same("!translate([1, 0, 0]) sphere(2); cube(9);", "translate([1, 0, 0]) sphere(2);");
    check_same("translate([9, 9, 9]) !sphere(2);", "sphere(2);");
    check_same("difference() { sphere(3); %cube(2); *cube(9); #sphere(1); }",
               "difference() { sphere(3); sphere(1); }");
    assert_int_equal(bench_compile(&b, "difference() { if (false) sphere(2); cube(1); }"), CSGM_OK);
    assert_int_equal(b.scene->nodes[b.scene->root].kind, CSG_NODE_EMPTY);
    assert_true(bench_has(&b, -390));
}

static void blends_reach_their_operators(void **state)
{
    (void)state;
    /* two half-spaces at a right angle: the fillet of radius r passes at r (sqrt 2 - 1) of the edge
     */
    const double at = 2 - 2 / sqrt(2);
    check("union(blend = 2) { plane([1, 0, 0], 0); plane([0, 1, 0], 0); }", at, at, 0, 0);
    check("union(blend = round(2)) { plane([1, 0, 0], 0); plane([0, 1, 0], 0); }", at, at, 0, 0);
    check_same("union(blend = round(2.5)) { sphere(2); translate([2, 0, 0]) sphere(2); }",
               "union(blend = round(r = 2.5)) { sphere(2); translate([2, 0, 0]) sphere(2); }");
    check_same(
        "f = round(r = 2.5); union(blend = f) { sphere(2); translate([2, 0, 0]) sphere(2); }",
        "union(blend = round(r = 2.5)) { sphere(2); translate([2, 0, 0]) sphere(2); }");
    check_same("a = true; union(blend = a ? round(2.5) : 0) { sphere(2); translate([2, 0, 0]) "
               "sphere(2); }",
               "union(blend = round(r = 2.5)) { sphere(2); translate([2, 0, 0]) sphere(2); }");
    check_same("union(blend = chamfer(2)) { sphere(2); translate([2, 0, 0]) sphere(2); }",
               "union(blend = chamfer(n = 1)) { sphere(2); translate([2, 0, 0]) sphere(2); }");
    check_same("union(blend = parabola(w = 2)) { sphere(2); translate([2, 0, 0]) sphere(2); }",
               "union(blend = parabola(n = 8)) { sphere(2); translate([2, 0, 0]) sphere(2); }");
    check_same("union(blend = cosine(0)) { sphere(2); translate([2, 0, 0]) sphere(2); }",
               "union() { sphere(2); translate([2, 0, 0]) sphere(2); }");
    /* for and children() give a union all their solids to blend */
    check_same("union(blend = 1) for (i = [0, 2]) translate([i, 0, 0]) sphere(2);",
               "union(blend = 1) { sphere(2); translate([2, 0, 0]) sphere(2); }");
    check_same("module soft() union(blend = 1) children(); soft() { sphere(2); translate([2, 0, "
               "0]) sphere(2); }",
               "union(blend = 1) { sphere(2); translate([2, 0, 0]) sphere(2); }");
}

static void wrapped_children_bring_their_own_blend(void **state)
{
    (void)state;
    check_same(
        "union(blend = 1) { sphere(2); blend(0) cube(3); translate([0, 2, 0]) sphere(2); }",
        "union() { union(blend = 1) { sphere(2); translate([0, 2, 0]) sphere(2); } cube(3); }");
    check_same(
        "difference() { sphere(3); blend(cosine(1)) cube(3); cube([1, 1, 9], center = true); }",
        "difference(blend = cosine(1)) { difference() { sphere(3); cube([1, 1, 9], center = true); "
        "} "
        "cube(3); }");
    check_same("union() { blend(1) sphere(2); blend(1) cube(3); }",
               "union(blend = 1) { sphere(2); cube(3); }");
    check_same("union() { blend(1) cube(3); sphere(2); }",
               "union(blend = 1) { sphere(2); cube(3); }");
    check_same("sphere(2); blend(1) cube(3);", "union(blend = 1) { sphere(2); cube(3); }");
    assert_int_equal(bench_compile(&b, "difference() { blend(1) sphere(2); cube(3); }"), CSGM_OK);
    assert_true(bench_has(&b, -304));
}

/* A union grows by its blend within the region, what is cut shrinks there. */
static void blends_are_bounded_by_regions(void **state)
{
    (void)state;
    check_same("union(blend = 1) { sphere(2); blend_within() cube(9); cube(3); }",
               "union() { union() { sphere(2); cube(3); } intersection() { union(blend = 1) { "
               "sphere(2); cube(3); } cube(9); } }");
    check_same("difference(blend = 1) { sphere(2); cube(3); blend_within(0.5) cube(9); }",
               "difference() { difference() { sphere(2); cube(3); } difference(blend = 0.5) { "
               "cube(9); difference(blend = 1) { sphere(2); cube(3); } } }");
    check_same("intersection(blend = 1) { blend_within() cube(9); sphere(2); cube(3); }",
               "difference() { intersection() { sphere(2); cube(3); } difference() { cube(9); "
               "intersection(blend = 1) { sphere(2); cube(3); } } }");
    /* several regions, solids of loops, children with blends of their own */
    check_same("union(blend = 1) { for (x = [0, 2]) translate([x, 0, 0]) sphere(2); "
               "blend_within(border = 1) cube(3); blend_within() cube(1); }",
               "module two(b) union(blend = b) { sphere(2); translate([2, 0, 0]) sphere(2); } "
               "union() { two(0); intersection(blend = 1) { two(1); cube(3); } intersection() { "
               "two(1); cube(1); } }");
    check_same("union() { sphere(2); blend(1) cube(3); blend_within() cube(9); }",
               "union() { sphere(2); cube(3); intersection() { union(blend = 1) { sphere(2); "
               "cube(3); } cube(9); } }");
    /* two half-spaces at a right angle, as in the test of blends: rounded for z > 0 only */
    const double at = 2 - 2 / sqrt(2), planes = -at;
    const char *corner = "union(blend = 2) { plane([1, 0, 0], 0); plane([0, 1, 0], 0); "
                         "blend_within() plane([0, 0, -1], 0); }";
    check(corner, at, at, 5, 0);
    check(corner, at, at, -5, planes);
    static const char *const without_use[] = {
        "union() { sphere(2); cube(3); blend_within() cube(9); }",
        "union(blend = 1) { sphere(2); blend_within() cube(9); }",
        "sphere(2); translate([1, 0, 0]) blend_within() cube(9);",
        "combine(function (a, b) max(a, b)) { sphere(2); cube(3); blend_within() cube(9); }",
        "minkowski() { sphere(2); cube(3); blend_within() cube(9); }",
    };
    for (size_t i = 0; i < sizeof without_use / sizeof *without_use; i++) {
        assert_int_equal(bench_compile(&b, without_use[i]), CSGM_OK);
        assert_true(bench_has(&b, -304));
    }
    assert_int_equal(bench_compile(&b, "union(blend = 1) { sphere(2); cube(3); "
                                       "blend_within(-1) cube(9); }"),
                     CSGM_ERR_SCENE);
}

static void colors_are_read(void **state)
{
    static const struct {
        const char *call;
        float r, g, b, a;
    } table[] = {{"color(\"teal\")", 0, 128 / 255.f, 128 / 255.f, 1},
                 {"color(\"Teal\", 0.5)", 0, 128 / 255.f, 128 / 255.f, 0.5f},
                 {"color(\"#f80\")", 1, 136 / 255.f, 0, 1},
                 {"color(\"#FF880040\")", 1, 136 / 255.f, 0, 64 / 255.f},
                 {"color([0.25, 0.5, 1])", 0.25f, 0.5f, 1, 1},
                 {"color(c = [0.25, 0.5, 1, 0], alpha = 1)", 0.25f, 0.5f, 1, 1},
                 {"color(\"rebeccapurple\")", 102 / 255.f, 51 / 255.f, 153 / 255.f, 1}};
    (void)state;
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        char scene[128];
        snprintf(scene, sizeof scene, "%s sphere(1);", table[i].call);
        assert_int_equal(bench_compile(&b, scene), CSGM_OK);
        assert_int_equal(b.scene->look_count, 1);
        const csg_color *c = &b.scene->looks[0].color;
        assert_true(c->r == table[i].r && c->g == table[i].g && c->b == table[i].b &&
                    c->a == table[i].a);
    }
    assert_int_equal(bench_compile(&b, "color() sphere(1);"), CSGM_OK);
    assert_int_equal(b.scene->look_count, 0);
}

static void the_mug_of_the_manual_compiles(void **state)
{
    (void)state;
    check("height = 90;  radius = 40;  wall = 3;\n"
          "fillet = cosine(8);\n"
          "module handle() translate([radius, 0, height / 2]) rotate([90, 0, 0]) torus(r = 24, "
          "tube = 5);\n"
          "difference(blend = 2) {\n"
          "  union(blend = fillet) {\n"
          "    cylinder(h = height, r = radius);\n"
          "    color(\"teal\") handle();\n"
          "  }\n"
          "  translate([0, 0, wall]) cylinder(h = height, r = radius - wall);\n"
          "}\n",
          64, 0, 45, 5);
}

/* ---- the printed scene is the same scene --------------------------------------------- */

typedef struct printed {
    char text[16384];
    size_t length;
} printed;

static void collect(void *user, const char *text, size_t length)
{
    printed *p = user;
    assert_true(p->length + length < sizeof p->text);
    memcpy(p->text + p->length, text, length);
    p->length += length;
    p->text[p->length] = '\0';
}

static void printed_scenes_parse_back(void **state)
{
    static const char *const scenes[] = {
        "sphere(2);",
        "cube([1, 2, 3], round = 0.25);",
        "cylinder(h = 10, r1 = 6, r2 = 1, round = 0.5);",
        "cylinder(h = 46, r1 = 14.5, r2 = 12, round = 2);",
        "cylinder(h = 10, r = 4, round = 1, center = true);",
        "torus(10, 2, 75);",
        "capsule([1, 2, 3], [4, 4, 4], 1, 0.5);",
        "plane([1, 2, 3], 4);",
        "difference(blend = 2) { union(blend = cosine(3)) { sphere(4); color(\"teal\") cube(5); "
        "blend(1) ellipsoid([1, 2, 3]); } rotate([10, 20, 30]) scale([1, 2, 3]) cylinder(9, 1, 2); "
        "}",
        "intersection(blend = hyperbola(0.3)) { sphere(4); translate([1, 0, 0]) sphere(4); "
        "cube(3); }",
        "intersection() { sphere(4); }",
    };
    static printed first, second;
    (void)state;
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        first.length = second.length = 0;
        assert_int_equal(bench_compile(&b, scenes[i]), CSGM_OK);
        assert_int_equal(csg_scene_print(b.scene, collect, &first), CSGM_OK);
        csgm_status status = bench_compile(&b, first.text);
        if (status != CSGM_OK || b.code_count)
            print_error("%s%s", first.text, b.text);
        assert_int_equal(status, CSGM_OK);
        assert_int_equal(b.code_count, 0);
        assert_int_equal(csg_scene_print(b.scene, collect, &second), CSGM_OK);
        assert_string_equal(first.text, second.text);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(solids_have_their_sizes),
        cmocka_unit_test(a_rounded_cone_keeps_its_outside),
        cmocka_unit_test(transforms_are_those_of_openscad),
        cmocka_unit_test(operators_mean_what_they_say),
        cmocka_unit_test(blends_reach_their_operators),
        cmocka_unit_test(wrapped_children_bring_their_own_blend),
        cmocka_unit_test(blends_are_bounded_by_regions),
        cmocka_unit_test(colors_are_read),
        cmocka_unit_test(the_mug_of_the_manual_compiles),
        cmocka_unit_test(printed_scenes_parse_back),
    };
    return cmocka_run_group_tests(tests, open_bench, close_bench);
}
