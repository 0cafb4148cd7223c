/* SPDX-License-Identifier: MIT
 * What # and % mark for pictures: solids in the scene's frame, whatever stands around them; and the
 * scene itself is the same with # as without.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "lang/bench_fixture.h"
#include "scene/collected_text.h"
#include "scene/reference.h"
#include "scene/tree/print.h"

/* Its field at a point; NAN: nothing is marked so. */
static double mark_at(csgm_mark kind, double x, double y, double z)
{
    csgm_status status = CSGM_OK;
    if (!b.scene->marked[kind])
        return NAN;
    double value = csg_reference_eval(b.scene->marked[kind], csg_vec3_make(x, y, z), &status).value;
    assert_int_equal(status, CSGM_OK);
    return value;
}

static void compile(const char *scene)
{
    csgm_status status = bench_compile(&b, scene);
    if (status != CSGM_OK)
        print_error("%s\n%s", scene, b.text);
    assert_int_equal(status, CSGM_OK);
}

static void expect(const char *scene, csgm_mark kind, double x, double y, double z, double f)
{
    compile(scene);
    double value = mark_at(kind, x, y, z);
    if (!(fabs(value - f) < 1e-9) && !(isnan(value) && isnan(f)))
        fail_msg("%s: %.17g, expected %.17g", scene, value, f);
}

static void marks_stand_where_the_scene_has_them(void **state)
{
    (void)state;
    expect("#sphere(2);", CSGM_MARK_HIGHLIGHT, 0, 0, 0, 2);
    expect("sphere(2);", CSGM_MARK_HIGHLIGHT, 0, 0, 0, NAN);
    expect("#sphere(2);", CSGM_MARK_BACKGROUND, 0, 0, 0, NAN);
    expect("translate([5, 0, 0]) { cube(1); %translate([0, 1, 0]) sphere(2); }",
           CSGM_MARK_BACKGROUND, 5, 1, 0, 2);
    expect("difference() { cube(9); rotate([0, 0, 90]) translate([3, 0, 0]) #sphere(2); }",
           CSGM_MARK_HIGHLIGHT, 0, 3, 0, 2);
    expect("module m() { scale(2) children(); } translate([1, 0, 0]) m() #sphere(1);",
           CSGM_MARK_HIGHLIGHT, 1, 0, 0, 2);
    expect("for (i = [0 : 3]) translate([10 * i, 0, 0]) #color(\"red\") sphere(2);",
           CSGM_MARK_HIGHLIGHT, 30, 0, 0, 2);
    expect("#translate([3, 0, 0]) #sphere(1); %sphere(2);", CSGM_MARK_HIGHLIGHT, 3, 0, 0, 1);
    expect("translate([4, 0, 0]) %sphere(2);", CSGM_MARK_BACKGROUND, 4, 0, 0, 2);
}

static void one_alone_has_its_own_marks(void **state)
{
    (void)state;
    const char *scene = "#sphere(9); translate([5, 0, 0]) !union() { cube(1); #sphere(2); }";
    expect(scene, CSGM_MARK_HIGHLIGHT, 0, 0, 0, 2);
    expect("!cube(1); #sphere(2);", CSGM_MARK_HIGHLIGHT, 0, 0, 0, NAN);
    expect("!#sphere(2); cube(1);", CSGM_MARK_HIGHLIGHT, 0, 0, 0, 2);
}

static void figures(void **state)
{
    (void)state;
    expect("circle(1); translate([3, 0, 7]) %circle(2);", CSGM_MARK_BACKGROUND, 3, 0, 0, 0.5);
    expect("cube(1); linear_extrude(3) { circle(1); #square(2); }", CSGM_MARK_HIGHLIGHT, 0, 0, 0,
           NAN);
    expect("cube(1); rotate([90, 0, 0]) rotate_extrude() %translate([2, 0]) circle(1);",
           CSGM_MARK_BACKGROUND, 0, 0, 0, NAN);
}

static text printed(const char *scene)
{
    text t = {0};
    compile(scene);
    assert_int_equal(csg_scene_print(b.scene, collect, &t), CSGM_OK);
    return t;
}

/* A # at a place, and a blank there. */
static void the_scene_is_the_same(void **state)
{
    static const char *const scenes[] = {
        "translate([0, 0, 5]) rotate([0, 0, 30]) { #translate([1, 2, 3]) sphere(5); cube(2); }",
        "color(\"red\") translate([1, 0, 0]) #color(\"blue\") cube(1); sphere(1);",
        "union(blend = 0.5) { #sphere(1); #translate([1, 0, 0]) sphere(1); }",
        "difference() { cube(4); #cylinder(h = 9, r = 1); }",
        "part(\"a\") #material(metallic = 1) sphere(1);",
        "linear_extrude(2) #translate([1, 1]) square(3);",
        "hull() { #sphere(1); translate([3, 0, 0]) #sphere(2); }",
        "!rotate([9, 0, 0]) #translate([1, 1, 1]) sphere(3); cube(1);",
        "repeat([5, 0, 0], 3) #translate([1, 0, 0]) sphere(1);",
        "soft(range = 2) #sphere(1);",
    };
    (void)state;
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        char plain[256];
        strcpy(plain, scenes[i]);
        for (char *at = plain; (at = strchr(at, '#'));)
            *at = ' ';
        text with = printed(scenes[i]), without = printed(plain);
        assert_string_equal(with.data, without.data);
        free(with.data);
        free(without.data);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(marks_stand_where_the_scene_has_them),
        cmocka_unit_test(one_alone_has_its_own_marks),
        cmocka_unit_test(figures),
        cmocka_unit_test(the_scene_is_the_same),
    };
    return cmocka_run_group_tests(tests, open_bench, close_bench);
}
