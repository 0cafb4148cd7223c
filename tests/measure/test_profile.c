/* SPDX-License-Identifier: MIT
 * Solids of revolution: about which axis they are found to turn, closed forms of what is measured
 * by their profiles, and random ones beside the same solid with a cube far away from it, which is
 * measured by cubes.
 */
#include "measure/solid.h"

#include <math.h>
#include <stdio.h>

#include "base/random.h"
#include "field/tape.h"
#include "measure/axis.h"
#include "rounds.h"
#include "scene/random_scene.h"

static int axis_of(const solid *s)
{
    int axis;
    csg_arena arena;
    csg_tape tape = s->field->tape;
    csg_arena_init(&arena, &s->field->context->memory);
    assert_true(csg_axis_find(&tape, s->field->parameter_count, NULL, &arena, &axis));
    csg_arena_reset(&arena);
    return axis;
}

/* ---- axes --------------------------------------------------------------------------------------
 */

typedef struct turning {
    const char *text;
    int axis;
} turning;

static void test_axes(void **state)
{
    static const turning SCENES[] = {
        {"cylinder(h = 10, r1 = 3, r2 = 2);", 2},
        {"translate([1, 2, 3]) cylinder(h = 10, r = 3, round = 1);", 2},
        {"rotate([0, 90, 0]) cylinder(h = 10, r1 = 3, r2 = 2);", 0},
        {"rotate([90, 0, 0]) torus(r = 5, tube = 1);", 1},
        {"scale([2, 2, 1]) sphere(3);", 2},
        {"union(blend = 2) { sphere(4); translate([0, 9, 0]) sphere(5); }", 1},
        {"capsule([-3, 0, 0], [5, 0, 0], 2);", 0},
        {"intersection() { sphere(5); plane([1, 0, 0], 2); }", 0},
        {"difference(blend = 1) { cylinder(h = 10, r = 5); sphere(3); }", 2},
        {"union(blend = fillet(1)) { cylinder(h = 10, r = 2); cylinder(h = 2, r = 6); }", 2},
        /* these do not */
        {"cube(5);", CSG_AXIS_NONE},
        {"torus(r = 5, tube = 1, angle = 200);", CSG_AXIS_NONE},
        {"ellipsoid([3, 4, 5]);", CSG_AXIS_NONE},
        {"union() { cylinder(h = 10, r = 3); translate([0.001, 0, 8]) cylinder(h = 9, r = 2); }",
         CSG_AXIS_NONE},
        {"rotate([0, 30, 0]) cylinder(h = 10, r = 3);", CSG_AXIS_NONE},
        {"intersection() { sphere(5); plane([1, 0.001, 0], 2); }", CSG_AXIS_NONE},
        {"twist(20) cylinder(h = 10, r = 3);", CSG_AXIS_NONE},
        {"union() { sphere(5); translate([7, 0, 0]) sphere(3); translate([0, 7, 0]) sphere(3); }",
         CSG_AXIS_NONE},
    };
    for (size_t i = 0; i < sizeof SCENES / sizeof *SCENES; i++) {
        solid s;
        assert_int_equal(open_solid(&s, csgm_context_options_default(), SCENES[i].text), CSGM_OK);
        if (axis_of(&s) != SCENES[i].axis)
            fail_msg("%s turns about %d", SCENES[i].text, axis_of(&s));
        close_solid(&s);
    }
}

/* ---- closed forms ------------------------------------------------------------------------------
 */

static const double PI = 3.14159265358979324;

static csgm_measures measures_of(const char *text, double tolerance, uint64_t most_cubes)
{
    solid s;
    csgm_measure_options how = csgm_measure_options_default();
    csgm_measures m = csgm_measures_default();
    how.tolerance = tolerance;
    how.most_cubes = most_cubes;
    assert_int_equal(open_solid(&s, csgm_context_options_default(), text), CSGM_OK);
    assert_int_equal(csgm_measure_field(s.context, s.field, &how, &m), CSGM_OK);
    close_solid(&s);
    return m;
}

typedef struct closed_form {
    const char *text;
    double volume, area, x, z; /* times pi, but for the centroid */
    double zz;                 /* inertia about z, times pi */
} closed_form;

static void test_closed_forms(void **state)
{
    const closed_form SOLIDS[] = {
        {"cylinder(h = 10, r = 3);", 90, 78, 0, 5, 405},
        {"translate([7, 0, -5]) cylinder(h = 10, r = 3);", 90, 78, 7, 0, 405},
        {"cylinder(h = 4, r1 = 3, r2 = 0);", 12, 24, 0, 1, 0.3 * 12 * 9},
        {"torus(r = 5, tube = 1);", 10 * PI, 20 * PI, 0, 0, 10 * PI * 25.75},
        {"difference() { sphere(5); sphere(4); }", 4.0 / 3 * 61, 164, 0, 0,
         8.0 / 15 * (3125 - 1024)},
        {"ellipsoid([5, 5, 2]);", 200.0 / 3, 0, 0, 0, 0.4 * 200.0 / 3 * 25},
        {"capsule([0, 0, -3], [0, 0, 3], 2);", 24 + 32.0 / 3, 40, 0, 0,
         24 * 2 + 0.4 * 32.0 / 3 * 4},
        {"union() { cylinder(h = 2, r = 5); translate([0, 0, 1]) cylinder(h = 9, r = 1); }", 58,
         2 * 25 + 20 + 16, 0, (50.0 * 1 + 8 * 6) / 58, 50 * 12.5 + 8 * 0.5},
    };
    for (size_t i = 0; i < sizeof SOLIDS / sizeof *SOLIDS; i++) {
        const closed_form *f = &SOLIDS[i];
        csgm_measures m = measures_of(f->text, 1e-4, 1 << 20);
        assert_holds(m.volume, PI * f->volume);
        assert_true(m.volume.high - m.volume.low <= 1e-4 * m.volume.high);
        if (f->area > 0)
            assert_holds(m.area, PI * f->area);
        assert_true(m.area.high - m.area.low <= 1e-3 * m.area.high);
        assert_holds(m.centroid[0], f->x);
        assert_holds(m.centroid[1], 0);
        assert_holds(m.centroid[2], f->z);
        assert_holds(m.inertia[2], PI * f->zz);
        assert_holds(m.inertia[3], 0);
        assert_true(m.inertia[2].high - m.inertia[2].low <= 1e-3 * m.inertia[2].high);
        assert_true(m.cubes < 8000); /* squares, and cubes for the bounds */
    }
}

/* As closely as doubles say, though no float is such a number. */
static void test_numbers_that_are_no_floats(void **state)
{
    csgm_measures m =
        measures_of("translate([0, 0, 0.1]) cylinder(h = 10.1, r = 3.3);", 1e-9, 1 << 14);
    assert_holds(m.volume, PI * 3.3 * 3.3 * 10.1);
    assert_holds(m.area, PI * 2 * 3.3 * (3.3 + 10.1));
    assert_holds(m.centroid[2], 0.1 + 10.1 / 2);
    assert_true(m.volume.high - m.volume.low <= 1e-9 * m.volume.high);
}

/* ---- random solids -----------------------------------------------------------------------------
 */

static int put_leaf(csg_random *random, char *to, size_t size)
{
    double z = csg_random_uniform(random, -4, 4), a = csg_random_uniform(random, 0.6, 4),
           b = csg_random_uniform(random, 0.3, 3);
    switch (csg_random_below(random, 6)) {
    case 0:
        return snprintf(to, size, "translate([0, 0, %.3f]) sphere(%.3f);", z, a);
    case 1:
        return snprintf(to, size,
                        "translate([0, 0, %.3f]) cylinder(h = %.3f, r1 = %.3f, r2 = %.3f);", z, a,
                        b, a);
    case 2:
        return snprintf(to, size,
                        "translate([0, 0, %.3f]) cylinder(h = %.3f, r = %.3f, round = %.3f);", z, a,
                        b, 0.4 * fmin(a / 2, b));
    case 3:
        return snprintf(to, size, "translate([0, 0, %.3f]) torus(r = %.3f, tube = %.3f);", z, a + 1,
                        0.4 * b);
    case 4:
        return snprintf(to, size, "translate([0, 0, %.3f]) ellipsoid([%.3f, %.3f, %.3f]);", z, a, a,
                        b);
    default:
        return snprintf(to, size, "capsule([0, 0, %.3f], [0, 0, %.3f], %.3f, %.3f);", z, z + 3, b,
                        1.1 * b);
    }
}

/* Some of these in operators with blends, two levels of them. */
static void put_scene(csg_random *random, char *to, size_t size)
{
    static const char *const OPERATORS[] = {"union", "difference", "union"};
    static const char *const BLENDS[] = {"", "blend = 0.7", "blend = 2", "blend = parabola(1.5)",
                                         "blend = fillet(0.5)"};
    int at = snprintf(to, size, "%s(%s) { union(%s) { ", OPERATORS[csg_random_below(random, 3)],
                      BLENDS[csg_random_below(random, 3)], BLENDS[csg_random_below(random, 5)]);
    for (uint64_t i = 0; i < 2 + csg_random_below(random, 2); i++)
        at += put_leaf(random, to + at, size - (size_t)at);
    at += snprintf(to + at, size - (size_t)at, " } ");
    at += put_leaf(random, to + at, size - (size_t)at);
    snprintf(to + at, size - (size_t)at, " }");
}

static void assert_meet(const char *text, const char *what, csgm_interval a, csgm_interval b)
{
    if (a.low > b.high || b.low > a.high)
        fail_msg("%s: the %s is within %.9g .. %.9g by its profile and %.9g .. %.9g otherwise",
                 text, what, a.low, a.high, b.low, b.high);
}

static csgm_interval lessened(csgm_interval a, double by)
{
    return (csgm_interval){a.low - by, a.high - by};
}

static bool is_empty(const char *text)
{
    solid s;
    csgm_measure_options how = csgm_measure_options_default();
    csgm_measures m = csgm_measures_default();
    how.tolerance = 0.1;
    how.most_cubes = 1 << 12;
    assert_int_equal(open_solid(&s, csgm_context_options_default(), text), CSGM_OK);
    csgm_status status = csgm_measure_field(s.context, s.field, &how, &m);
    close_solid(&s);
    return status != CSGM_OK || !(m.volume.low > 0.1);
}

static void test_against_cubes(void **state)
{
    enum { MOST = 1 << 14 };
    static const double TOLERANCE = 1e-3;
    int tried = 0;
    for (uint64_t i = 0; i < ROUNDS(12 * test_times); i++) {
        csg_random random = {.state = 77000 + test_first_seed + i};
        char text[1500], beside[1600];
        put_scene(&random, text, sizeof text);
        if (is_empty(text))
            continue;
        snprintf(beside, sizeof beside, "%s translate([30, 0, 0]) cube(1);", text);
        csgm_measures a = measures_of(text, TOLERANCE, MOST),
                      b = measures_of(beside, 3 * TOLERANCE, MOST),
                      c = measures_of(text, 0.01 * TOLERANCE, MOST);
        assert_meet(text, "volume", a.volume, lessened(b.volume, 1));
        assert_meet(text, "area", a.area, lessened(b.area, 6));
        assert_meet(text, "volume, closer,", a.volume, c.volume);
        assert_meet(text, "area, closer,", a.area, c.area);
        assert_meet(text, "inertia, closer,", a.inertia[2], c.inertia[2]);
        assert_meet(text, "height, closer,", a.centroid[2], c.centroid[2]);
        tried++;
    }
    assert_true(tried >= (int)ROUNDS(6 * test_times));
}

static void check_refused(const csgm_measures *m, bool done)
{
    assert_holds(m->volume, 61 * 4.0 / 3 * PI);
    assert_holds(m->area, 164 * PI);
}

static void test_any_allocation_may_fail(void **state)
{
    csgm_measure_options how = csgm_measure_options_default();
    how.tolerance = 0.05;
    assert_true(
        measure_with_refusals("difference() { sphere(5); sphere(4); }", how, check_refused) > 5);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_axes), cmocka_unit_test(test_closed_forms),
        cmocka_unit_test(test_numbers_that_are_no_floats), cmocka_unit_test(test_against_cubes),
        cmocka_unit_test(test_any_allocation_may_fail)};
    test_take_search(argc, argv);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
