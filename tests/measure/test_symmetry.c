/* SPDX-License-Identifier: MIT
 * Which symmetries are found, that the fields of random scenes have those that are found, and that
 * what is measured by them is right.
 */
#include "measure/solid.h"

#include <math.h>
#include <stdio.h>

#include "base/random.h"
#include "field/tape.h"
#include "measure/symmetry.h"
#include "rounds.h"

static csg_symmetries symmetries_of(const solid *s)
{
    csg_symmetries out;
    csg_arena arena;
    csg_tape tape = s->field->tape;
    csg_arena_init(&arena, &s->field->context->memory);
    assert_true(csg_symmetries_find(&tape, s->field->parameter_count, &arena, &out));
    csg_arena_reset(&arena);
    return out;
}

/* ---- how many there are ------------------------------------------------------------------------
 */

typedef struct counted {
    const char *text;
    int count; /* without the identity */
} counted;

static void test_counts(void **state)
{
    static const counted SCENES[] = {
        {"sphere(10);", 47},
        {"translate([1, 2, 3]) cube(10);", 47},
        {"cube([10, 10, 20]);", 15},
        {"cube([10, 20, 30]);", 7},
        {"cylinder(h = 10, r = 3);", 15},
        {"cylinder(h = 10, r1 = 3, r2 = 2);", 7},
        {"rotate([90, 0, 0]) cylinder(h = 10, r1 = 3, r2 = 2);", 7},
        {"capsule([0, 0, 0], [0, 0, 9], 2);", 7},
        {"torus(r = 10, tube = 2);", 15},
        {"torus(r = 10, tube = 2, angle = 90);", 3},
        {"ellipsoid([5, 5, 3]);", 15},
        {"ellipsoid([3, 4, 5]);", 7},
        /* operands in another order, of sharp and round operators */
        {"for (s = [-1, 1]) translate([5 * s, 0, 0]) sphere(2);", 15},
        {"union(blend = 3) for (s = [-1, 1]) translate([5 * s, 0, 0]) sphere(6);", 15},
        {"difference(blend = 1) { cylinder(h = 10, r = 20); for (i = [0 : 5]) rotate(60 * i) "
         "translate([12, 0, -1]) cylinder(h = 12, r = 3); }",
         7},
        {"difference() { cylinder(h = 10, r = 20); for (i = [0 : 3]) rotate(90 * i) "
         "translate([12, 0, -1]) cylinder(h = 12, r = 3); }",
         15},
        /* no more than the order allows: the first two of three are folded before the third */
        {"union(blend = parabola(3)) for (s = [-1, 0, 1]) translate([5 * s, 0, 0]) sphere(3);", 7},
        /* fillets, with planes at which they end */
        {"union(blend = fillet(2)) { cylinder(h = 10, r = 5); translate([0, 0, 6]) "
         "torus(r = 5, tube = 1.5); }",
         7},
        /* nearly, in the same box */
        {"difference() { cube([40, 10, 12], center = true); translate([-10, 0, 0]) sphere(2); "
         "translate([10, 0, 0]) sphere(2.0001); }",
         3},
        {"difference() { cube([40, 10, 12], center = true); translate([-10, 0, 0]) sphere(2); "
         "translate([10.0001, 0, 0]) sphere(2); }",
         3},
        {"difference(blend = 0.5) { cube([40, 10, 12], center = true); translate([-10, 0, 0]) "
         "sphere(2); "
         "translate([10, 0, 0]) sphere(2); }",
         7},
        /* nearly */
        {"sphere(5); translate([20, 0, 0]) sphere(5.0001);", 7},
        {"sphere(5); translate([20, 0.001, 0]) sphere(5);", 3},
        {"for (i = [0 : 3]) rotate(90 * i) translate([20, 0, 0]) rotate([22, 0, 0]) "
         "cylinder(h = 9, r = 2);",
         3},
        {"union() { rotate([7, 11, 13]) cube([3, 4, 5]); cube([1, 2, 3]); }", 0},
        {"linear_extrude(height = 10, twist = 40) square(4, center = true);", 0},
    };
    for (size_t i = 0; i < sizeof SCENES / sizeof *SCENES; i++) {
        solid s;
        if (open_solid(&s, csgm_context_options_default(), SCENES[i].text) != CSGM_OK)
            fail_msg("%s: it is not compiled", SCENES[i].text);
        int count = symmetries_of(&s).count;
        if (count != SCENES[i].count)
            fail_msg("%s: %d symmetries, not %d", SCENES[i].text, count, SCENES[i].count);
        close_solid(&s);
    }
}

/* ---- that the field has them -------------------------------------------------------------------
 */

enum { TEXT = 8192 };

typedef struct text {
    char of[TEXT];
    size_t length;
} text;

static void add(text *t, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    t->length += (size_t)vsnprintf(t->of + t->length, TEXT - t->length, format, arguments);
    va_end(arguments);
    assert_true(t->length < TEXT);
}

static double length(csg_random *random)
{
    return 0.125 * (1 + csg_random_below(random, 24));
}

static void add_leaf(text *t, csg_random *random)
{
    double a = length(random), b = length(random), c = length(random);
    add(t, "translate([%g, %g, %g]) ", length(random), length(random), -length(random));
    if (csg_random_below(random, 2))
        add(t, "rotate([%u, 0, %u]) ", 30 * csg_random_below(random, 12),
            csg_random_below(random, 90));
    switch (csg_random_below(random, 6)) {
    case 0:
        add(t, "cube([%g, %g, %g], center = true);\n", a, b, a);
        break;
    case 1:
        add(t, "cylinder(h = %g, r1 = %g, r2 = %g);\n", a, b, csg_random_below(random, 2) ? b : c);
        break;
    case 2:
        add(t, "torus(r = %g, tube = %g, angle = %u);\n", a + b, b,
            csg_random_below(random, 2) ? 360 : 100);
        break;
    case 3:
        add(t, "capsule([0, 0, 0], [%g, 0, 0], %g);\n", a, b);
        break;
    case 4:
        add(t, "ellipsoid([%g, %g, %g]);\n", a, a, b);
        break;
    default:
        add(t, "sphere(%g);\n", a);
    }
}

static void add_operator(text *t, csg_random *random)
{
    static const char *const OPERATORS[] = {"union()",
                                            "union(blend = 0.5)",
                                            "union(blend = hyperbola(0.5))",
                                            "union(blend = fillet(0.4))",
                                            "difference(blend = 0.3)",
                                            "intersection()"};
    add(t, "%s {\n", OPERATORS[csg_random_below(random, sizeof OPERATORS / sizeof *OPERATORS)]);
}

static void add_map(text *t, const csg_symmetry *g)
{
    add(t, "multmatrix([");
    for (int i = 0; i < 3; i++) {
        double row[3] = {0, 0, 0};
        row[g->axes[i]] = g->sign[i];
        add(t, "[%g, %g, %g, 0], ", row[0], row[1], row[2]);
    }
    add(t, "[0, 0, 0, 1]]) ");
}

static csg_symmetry random_map(csg_random *random)
{
    static const int ORDERS[][3] = {{0, 1, 2}, {1, 0, 2}, {0, 2, 1},
                                    {2, 1, 0}, {1, 2, 0}, {2, 0, 1}};
    csg_symmetry g;
    memcpy(g.axes, ORDERS[csg_random_below(random, 6)], sizeof g.axes);
    for (int i = 0; i < 3; i++)
        g.sign[i] = csg_random_below(random, 2) ? 1 : -1;
    return g;
}

/* First a, then b. */
static csg_symmetry after(const csg_symmetry *a, const csg_symmetry *b)
{
    csg_symmetry out;
    for (int i = 0; i < 3; i++) {
        out.axes[i] = a->axes[b->axes[i]];
        out.sign[i] = b->sign[i] * a->sign[b->axes[i]];
    }
    return out;
}

static bool is_identity(const csg_symmetry *g)
{
    const double x[3] = {1, 2, 3};
    return csg_symmetry_keeps(g, x);
}

/* A thing and its images by a map's powers, and now and then something that spoils it. */
static void write_scene(text *t, csg_random *random, const csg_symmetry *g)
{
    csg_symmetry power = *g;
    uint32_t leaves = 1 + csg_random_below(random, 3);
    t->length = 0;
    add(t, "module thing() ");
    add_operator(t, random);
    for (uint32_t i = 0; i < leaves; i++)
        add_leaf(t, random);
    add(t, "}\n");
    add_operator(t, random);
    add(t, "thing();\n");
    for (; !is_identity(&power); power = after(&power, g)) {
        add_map(t, &power);
        add(t, "thing();\n");
    }
    if (!csg_random_below(random, 4))
        add_leaf(t, random);
    add(t, "}\n");
}

static void check_symmetry(const solid *s, const char *of, const csg_symmetry *g,
                           csg_random *random)
{
    const csg_vec3 center = s->field->center;
    for (int i = 0; i < 50; i++) {
        double from[3], to[3];
        for (int k = 0; k < 3; k++)
            from[k] = csg_random_uniform(random, -8, 8);
        csg_symmetry_map(g, from, to);
        double f = csgm_scene_eval(
            s->scene, csg_vec3_add(center, csg_vec3_make(from[0], from[1], from[2])), NULL);
        double image = csgm_scene_eval(
            s->scene, csg_vec3_add(center, csg_vec3_make(to[0], to[1], to[2])), NULL);
        if (fabs(f - image) > 1e-5)
            fail_msg("%s\n%g at %g,%g,%g, %g at %g,%g,%g from its centre", of, f, from[0], from[1],
                     from[2], image, to[0], to[1], to[2]);
    }
}

static void test_fields_have_them(void **state)
{
    csg_random random = {77};
    int found = 0;
    for (int n = 0; n < 1000; n++) {
        const csg_symmetry g = random_map(&random);
        text t;
        solid s;
        write_scene(&t, &random, &g);
        assert_int_equal(open_solid(&s, csgm_context_options_default(), t.of), CSGM_OK);
        const csg_symmetries all = symmetries_of(&s);
        for (int i = 0; i < all.count; i++)
            check_symmetry(&s, t.of, &all.of[i], &random);
        found += all.count > 0;
        close_solid(&s);
    }
    assert_true(found > 250);
}

/* ---- measured by them --------------------------------------------------------------------------
 */

/* Balls that a map makes of one, whose measures have closed forms. */
static void test_orbits(void **state)
{
    static const double AT[3] = {2, -4.5, 7}, R = 1, VOLUME = 4.1887902047863905;
    csg_random random = {78};
    for (int n = 0; n < ROUNDS(150); n++) {
        const csg_symmetry g = random_map(&random);
        csg_symmetry power = g;
        double at[3], middle[3] = {0}, moments[3][3] = {{0}};
        int count = 0;
        text t = {.length = 0};
        for (bool more = true; more; power = after(&power, &g), count++) {
            csg_symmetry_map(&power, AT, at);
            add(&t, "translate([%g, %g, %g]) sphere(%g);\n", at[0], at[1], at[2], R);
            for (int i = 0; i < 3; i++) {
                middle[i] += at[i];
                for (int k = 0; k < 3; k++)
                    moments[i][k] += at[i] * at[k];
            }
            more = !is_identity(&power);
        }
        solid s;
        csgm_measure_options options = csgm_measure_options_default();
        csgm_measures m = csgm_measures_default();
        options.tolerance = 0.02;
        assert_int_equal(open_solid(&s, csgm_context_options_default(), t.of), CSGM_OK);
        assert_true(symmetries_of(&s).count >= count - 1);
        assert_int_equal(csgm_measure_field(s.context, s.field, &options, &m), CSGM_OK);
        assert_true(m.is_reached);
        assert_holds(m.volume, count * VOLUME);
        assert_holds(m.area, count * 3 * VOLUME / R);
        double of[3][3], ball = 0.2 * R * R * count * VOLUME;
        for (int i = 0; i < 3; i++) {
            assert_holds(m.centroid[i], middle[i] / count);
            for (int k = 0; k < 3; k++)
                of[i][k] = VOLUME * (moments[i][k] - middle[i] * middle[k] / count);
            of[i][i] += ball;
        }
        for (int i = 0; i < 3; i++)
            assert_holds(m.inertia[i], of[(i + 1) % 3][(i + 1) % 3] + of[(i + 2) % 3][(i + 2) % 3]);
        assert_holds(m.inertia[3], -of[0][1]);
        assert_holds(m.inertia[4], -of[0][2]);
        assert_holds(m.inertia[5], -of[1][2]);
        close_solid(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_counts),
        cmocka_unit_test(test_fields_have_them),
        cmocka_unit_test(test_orbits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
