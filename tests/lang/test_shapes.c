/* SPDX-License-Identifier: MIT
 * Figures, extrusions, hulls, sums and deformations: volume by a grid of the scene's field, and the
 * extent of what is inside, against closed forms or what OpenSCAD 2021.01 gives with $fn = 96
 * (marked so).
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "lang/bench_failing.h"
#include "lang/bench_fixture.h"
#include "scene/boxes/bounds.h"
#include "scene/reference.h"

#define PI 3.14159265358979323846

typedef struct solid {
    const char *scene;
    double volume;
    csg_box box; /* of the solid */
} solid;

typedef struct measured {
    double volume, cell;
    csg_box box; /* of points inside */
} measured;

/* Cells that the surface cuts count by how deep their middle lies. */
static measured measure(int cells)
{
    csg_box box = csg_bounds_of_solid(b.scene);
    measured m = {.cell = csg_box_longest_side(box) / cells, .box = csg_box_empty()};
    assert_true(csg_box_is_finite(box));
    for (double x = box.min.x - 0.69 * m.cell; x < box.max.x + m.cell; x += m.cell)
        for (double y = box.min.y - 0.63 * m.cell; y < box.max.y + m.cell; y += m.cell)
            for (double z = box.min.z - 0.59 * m.cell; z < box.max.z + m.cell; z += m.cell) {
                csgm_status status = CSGM_OK;
                csg_vec3 p = {x, y, z};
                csg_sample sample = csg_reference_eval(b.scene, p, &status);
                double slope = csg_vec3_norm(sample.gradient);
                double part = sample.value / (slope > 0.01 ? slope : 1) / m.cell + 0.5;
                m.volume += fmin(fmax(part, 0), 1) * m.cell * m.cell * m.cell;
                if (sample.value >= 0)
                    m.box = csg_box_hull(m.box, (csg_box){p, p});
            }
    return m;
}

static double farthest_side(csg_box a, csg_box c)
{
    const double *p = &a.min.x, *q = &c.min.x;
    double most = 0;
    for (int i = 0; i < 6; i++)
        most = fmax(most, fabs(p[i] - q[i]));
    return most;
}

static void compile(const char *scene, const csgm_scene_options *options)
{
    csgm_status status = bench_compile_bytes(&b, scene, strlen(scene), options);
    if (status != CSGM_OK)
        print_error("%s\n%s", scene, b.text);
    assert_int_equal(status, CSGM_OK);
}

static void check(const solid *wanted, int cells, const csgm_scene_options *options)
{
    compile(wanted->scene, options);
    measured m = measure(cells);
    bool right = fabs(m.volume - wanted->volume) <= 0.012 * wanted->volume &&
                 farthest_side(m.box, wanted->box) <= 2 * m.cell;
    if (!right)
        print_error("%s\nvolume %g, expected %g; %g %g %g .. %g %g %g, cell %g\n%s", wanted->scene,
                    m.volume, wanted->volume, m.box.min.x, m.box.min.y, m.box.min.z, m.box.max.x,
                    m.box.max.y, m.box.max.z, m.cell, b.text);
    assert_true(right);
}

static void check_all(const solid *solids, size_t count)
{
    for (size_t i = 0; i < count; i++)
        check(&solids[i], 40, NULL);
}

#define CHECK_ALL(solids) check_all(solids, sizeof(solids) / sizeof *(solids))

/* ---- figures -----------------------------------------------------------------------------------
 */

static void figures_have_their_areas(void **state)
{
    (void)state;
    const solid solids[] = {
        {"linear_extrude(4) circle(5);", 100 * PI, {{-5, -5, 0}, {5, 5, 4}}},
        {"linear_extrude(4) circle(d = 5);", 25 * PI, {{-2.5, -2.5, 0}, {2.5, 2.5, 4}}},
        {"linear_extrude(4) square([4, 2], center = true);", 32, {{-2, -1, 0}, {2, 1, 4}}},
        {"linear_extrude(4) square(3);", 36, {{0, 0, 0}, {3, 3, 4}}},
        {"linear_extrude(3) square([6, 4], round = 1);", 3 * (24 - 4 + PI), {{0, 0, 0}, {6, 4, 3}}},
        {"linear_extrude(4) polygon([[0,0], [4,0], [4,3], [2,1], [0,3]]);",
         32,
         {{0, 0, 0}, {4, 3, 4}}},
        {"linear_extrude(4) polygon([[0,0], [10,0], [10,10], [0,10], [2,2], [8,2], [8,8], [2,8]],"
         " paths = [[0,1,2,3], [4,5,6,7]]);",
         256,
         {{0, 0, 0}, {10, 10, 4}}},
        {"linear_extrude(2) polygon([[0,0], [4,4], [4,0], [0,4]]);", 16, {{0, 0, 0}, {4, 4, 2}}},
        {"linear_extrude(2) fill() difference() { square(9); translate([1, 1]) difference() {"
         " square(7); translate([2, 2]) square(1); } }",
         162,
         {{0, 0, 0}, {9, 9, 2}}},
        {"linear_extrude(2) fill() difference() { square(9); translate([1, 1]) square(7);"
         " translate([-1, 4]) square([5, 1]); }", /* the slit opens what would be a hole */
         62,
         {{0, 0, 0}, {9, 9, 2}}},
        {"linear_extrude(5) intersection() { circle(5); square(6); }",
         125 * PI / 4,
         {{0, 0, 0}, {5, 5, 5}}},
        {"linear_extrude(5) rotate(90) square([6, 3]);", 90, {{-3, 0, 0}, {0, 6, 5}}},
        {"linear_extrude(5) mirror([1, 1, 0]) square([6, 3]);", 90, {{-3, -6, 0}, {0, 0, 5}}},
        {"linear_extrude(5) scale([2, 0.5]) circle(3);", 45 * PI, {{-6, -1.5, 0}, {6, 1.5, 5}}},
        {"linear_extrude(5) resize([10, 4]) circle(3);", 50 * PI, {{-5, -2, 0}, {5, 2, 5}}},
        {"linear_extrude(5) resize([12, 0], auto = true) square([3, 2]);",
         480,
         {{0, 0, 0}, {12, 8, 5}}},
    };
    CHECK_ALL(solids);
}

/* As high as the outline is far: over corners that point inwards there are cones, or where it is
 * straight the planes of the edges. */
static void roofs_follow_the_distance(void **state)
{
    (void)state;
    const solid solids[] = {
        {"roof() square(10);", 500.0 / 3, {{0, 0, 0}, {10, 10, 5}}},
        {"roof(\"straight\") translate([1, 2]) square([20, 10]);",
         1250.0 / 3,
         {{1, 2, 0}, {21, 12, 5}}},
        {"roof(method = \"voronoi\", convexity = 3) circle(5);",
         125 * PI / 3,
         {{-5, -5, 0}, {5, 5, 5}}},
        {"scale([1, 1, 5]) roof(\"straight\") { square([30, 7]); square([11, 20]); }",
         5 * 726.8333,
         {{0, 0, 0}, {30, 20, 27.5}}},
        {"scale([1, 1, 5]) roof(\"straight\") difference() {\n"
         "square(20); translate([5, 5]) square(8); }",
         5 * 517.3333,
         {{0, 0, 0}, {20, 20, 17.5}}},
        {"scale([1, 1, 9]) roof(\"straight\") difference() { circle(10); circle(6); }",
         9 * 64 * PI,
         {{-10, -10, 0}, {10, 10, 18}}},
        {"roof() difference() { square(20); translate([5, 5]) square([20, 10]); }",
         304.678, /* summed over 400 x 400 points */
         {{0, 0, 0}, {20, 20, 2.92893}}},
        {"roof() { circle(5); translate([6, 0]) circle(5); }", /* distances to the union's outline
                                                                */
         254.099,                                              /* summed over 900 x 900 points */
         {{-5, -5, 0}, {11, 5, 5}}},
    };
    CHECK_ALL(solids);
}

static void offsets_round_and_cut_corners(void **state)
{
    (void)state;
    const solid solids[] = {
        {"linear_extrude(3) offset(r = 1) square([4, 6]);",
         3 * (24 + 20 + PI),
         {{-1, -1, 0}, {5, 7, 3}}},
        {"linear_extrude(3) offset(delta = 1) square([4, 6]);", 144, {{-1, -1, 0}, {5, 7, 3}}},
        {"linear_extrude(3) offset(delta = 1, chamfer = true) square([4, 6]);", /* OpenSCAD */
         141.94,
         {{-1, -1, 0}, {5, 7, 3}}},
        {"linear_extrude(3) offset(r = -1) square([4, 6]);", 24, {{1, 1, 0}, {3, 5, 3}}},
        /* in and out again rounds what stands out, out and in what lies inside */
        {"linear_extrude(3) offset(r = 1) offset(r = -1) square([4, 6]);",
         3 * (24 - 4 + PI),
         {{0, 0, 0}, {4, 6, 3}}},
        {"linear_extrude(3) offset(r = -1) offset(r = 1) union() { square([8, 6]);"
         " translate([3, 3]) square([3, 8]); }",
         3 * (63 + 2 * (1 - PI / 4)),
         {{0, 0, 0}, {8, 11, 3}}},
        {"linear_extrude(3) offset(r = -1) difference() { square(10, center = true); circle(2); }",
         3 * (64 - 9 * PI),
         {{-4, -4, 0}, {4, 4, 3}}},
    };
    CHECK_ALL(solids);
}

/* ---- extrusions --------------------------------------------------------------------------------
 */

static void extrusions_follow_openscad(void **state)
{
    (void)state;
    const solid solids[] = {
        {"linear_extrude() square(50);", 250000, {{0, 0, 0}, {50, 50, 100}}},
        {"linear_extrude(height = 10, center = true) circle(3);",
         90 * PI,
         {{-3, -3, -5}, {3, 3, 5}}},
        {"linear_extrude(10, scale = 0.5) circle(3);", 52.5 * PI, {{-3, -3, 0}, {3, 3, 10}}},
        {"linear_extrude(10, scale = 0) square(6, center = true);", 120, {{-3, -3, 0}, {3, 3, 10}}},
        {"linear_extrude(10, scale = [1, 2]) square(4, center = true);",
         240,
         {{-2, -4, 0}, {2, 4, 10}}},
        {"linear_extrude(10, scale = 2) translate([3, 0]) square(2);",
         280.0 / 3,
         {{3, 0, 0}, {10, 4, 10}}},
        {"linear_extrude(10, twist = 90) square([6, 2], center = true);",
         120,
         {{-3.16, -3.16, 0}, {3.16, 3.16, 10}}},
        {"linear_extrude(10, twist = 180, scale = 0.5) square([6, 3], center = true);",
         105,
         {{-3.13, -2.8, 0}, {3.13, 2.8, 10}}},
        {"linear_extrude(10, twist = -90, scale = [0.5, 2]) translate([1, 0]) circle(1);",
         10 * PI * 13 / 12,
         {{-0.5, -1, 0}, {2, 4, 10}}},
        {"linear_extrude(v = [3, 0, 4]) square(4);", 64, {{0, 0, 0}, {7, 4, 4}}},
        {"rotate_extrude() translate([5, 0]) circle(2);", 40 * PI * PI, {{-7, -7, -2}, {7, 7, 2}}},
        {"rotate_extrude() square([5, 3]);", 75 * PI, {{-5, -5, 0}, {5, 5, 3}}},
        {"rotate_extrude(angle = 90) translate([5, 0]) square([2, 3]);",
         18 * PI,
         {{0, 0, 0}, {7, 7, 3}}},
        {"rotate_extrude(angle = 270) translate([5, 0]) square([2, 3]);",
         54 * PI,
         {{-7, -7, 0}, {7, 7, 3}}},
        {"rotate_extrude(angle = -90) translate([5, 0]) square([2, 3]);",
         18 * PI,
         {{0, -7, 0}, {7, 0, 3}}},
        {"rotate_extrude(angle = 90) translate([-7, 0]) square([2, 3]);",
         18 * PI,
         {{-7, -7, 0}, {0, 0, 3}}},
        {"rotate_extrude() intersection() { circle(5); translate([0, -6]) square([6, 12]); }",
         500 * PI / 3,
         {{-5, -5, -5}, {5, 5, 5}}},
    };
    CHECK_ALL(solids);
}

/* A whole turn of a figure on the axis has no hole there, however it is shrunk. */
static void the_axis_is_no_surface(void **state)
{
    (void)state;
    const solid shrunk = {
        "offset3d(-1) rotate_extrude() square([5, 6]);", 64 * PI, {{-4, -4, 1}, {4, 4, 5}}};
    check(&shrunk, 40, NULL);
}

/* A twist turns clockwise on the way up, from where the figure stands at the bottom. */
static void a_twist_turns_clockwise(void **state)
{
    (void)state;
    const char *const scenes[] = {
        "linear_extrude(10, twist = 90) translate([4, 0]) circle(1);",
        "translate([0, 0, 5]) linear_extrude(10, twist = 90, center = true) translate([4, 0]) "
        "circle(1);",
        "linear_extrude(10, twist = 90, scale = 1.0001) translate([4, 0]) circle(1);",
    };
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        compile(scenes[i], NULL);
        csgm_status status = CSGM_OK;
        assert_true(csg_reference_eval(b.scene, csg_vec3_make(4, 0, 0.1), &status).value > 0);
        assert_true(csg_reference_eval(b.scene, csg_vec3_make(0, -4, 9.9), &status).value > 0);
        assert_true(csg_reference_eval(b.scene, csg_vec3_make(0, 4, 9.9), &status).value < 0);
    }
}

/* ---- hulls and sums ----------------------------------------------------------------------------
 */

static void hulls_are_convex(void **state)
{
    (void)state;
    const solid solids[] = {
        {"hull() { sphere(2); translate([6, 0, 0]) sphere(2); }",
         24 * PI + 32 * PI / 3,
         {{-2, -2, -2}, {8, 2, 2}}},
        {"hull() { sphere(1); translate([6, 0, 0]) sphere(1); translate([0, 6, 0]) sphere(1); }",
         36 + PI / 2 * (12 + sqrt(72)) + 4 * PI / 3,
         {{-1, -1, -1}, {7, 7, 1}}},
        {"hull() for (i = [0 : 3]) rotate(90 * i) translate([5, 5, 0]) sphere(1);",
         200 + PI / 2 * 40 + 4 * PI / 3,
         {{-6, -6, -1}, {6, 6, 1}}},
        {"hull() { cube(2); translate([6, 4, 3]) cube(1); }",
         31.33, /* OpenSCAD */
         {{0, 0, 0}, {7, 5, 4}}},
        {"hull() { cylinder(h = 2, r = 3); translate([8, 0, 0]) cylinder(h = 2, r = 3); }",
         96 + 18 * PI,
         {{-3, -3, 0}, {11, 3, 2}}},
        {"hull() { cylinder(h = 2, r = 3); translate([0, 0, 8]) cylinder(h = 2, r = 1); }",
         165.4, /* OpenSCAD */
         {{-3, -3, 0}, {3, 3, 10}}},
        {"linear_extrude(10) hull() { circle(2); translate([8, 0]) circle(2); }",
         10 * (32 + 4 * PI),
         {{-2, -2, 0}, {10, 2, 10}}},
        {"linear_extrude(10) hull() { circle(2); translate([8, 0]) circle(1); }",
         320.4, /* OpenSCAD */
         {{-2, -2, 0}, {9, 2, 10}}},
        {"hull() { rotate_extrude() translate([5, 0]) circle(1); }",
         2 * PI * 25 + PI * PI * 5 + 4 * PI / 3,
         {{-6, -6, -1}, {6, 6, 1}}},
    };
    CHECK_ALL(solids);
}

static void sums_grow_solids(void **state)
{
    (void)state;
    const double cube = 48, faces = 88, edges = 12;
    const solid solids[] = {
        {"minkowski() { cube([6, 4, 2]); sphere(1); }",
         cube + faces + PI * edges + 4 * PI / 3,
         {{-1, -1, -1}, {7, 5, 3}}},
        {"minkowski() { cube([6, 4, 2]); cylinder(h = 1, r = 1); }",
         3 * (24 + 20 + PI),
         {{-1, -1, 0}, {7, 5, 3}}},
        {"minkowski() { cube([6, 4, 2]); cube(1); }", 7 * 5 * 3, {{0, 0, 0}, {7, 5, 3}}},
        {"minkowski() { cylinder(h = 4, r = 3); cylinder(h = 1, r = 1); }",
         80 * PI,
         {{-4, -4, 0}, {4, 4, 5}}},
        {"minkowski() { linear_extrude(3) difference() { square(10); translate([3, 3]) square(10);"
         " } cylinder(h = 1, r = 1); }",
         4 * (51 + 40 + 5 * PI / 4 - 1),
         {{-1, -1, 0}, {11, 11, 4}}},
        {"linear_extrude(10) minkowski() { polygon([[0,0], [6,0], [3,5]]); square(2, center = "
         "true);"
         " }",
         10 * (15 + 2 * 6 + 2 * 5 + 4),
         {{-1, -1, 0}, {7, 6, 10}}},
        {"linear_extrude(10) minkowski() { difference() { square(10); translate([3, 3]) square(10);"
         " } square(1); }",
         10 * (121 - 49),
         {{0, 0, 0}, {11, 11, 10}}},
    };
    CHECK_ALL(solids);
}

/* Volumes: the first by hand, the torus by a finer mesh, the others as OpenSCAD has them. */
static void sums_of_hollow_solids(void **state)
{
    (void)state;
    const solid solids[] = {
        {"minkowski() { linear_extrude(2) difference() { square(10); translate([2, 2]) square(6); "
         "} "
         "linear_extrude(1) difference() { square(3); translate([1, 1]) square(1); } }",
         3 * (169 - 9),
         {{0, 0, 0}, {13, 13, 3}}},
        {"module l(a, b, h) linear_extrude(h) polygon([[0, 0], [a, 0], [a, 2], [2, 2], [2, b], "
         "[0, b]]); minkowski() { l(10, 8, 3); rotate([90, 0, 0]) l(4, 5, 2); }",
         676,
         {{0, -2, 0}, {14, 8, 8}}},
        {"minkowski() { polyhedron([[0,0,0], [4,0,0], [4,4,0], [0,4,0], [2,2,1], [2,2,5]], "
         "[[0,1,4], "
         "[1,2,4], [2,3,4], [3,0,4], [1,0,5], [2,1,5], [3,2,5], [0,3,5]]); rotate([90, 0, 0]) "
         "linear_extrude(1) polygon([[0, 0], [3, 0], [3, 2], [2, 2], [2, 3], [0, 3]]); }",
         176.28,
         {{0, -1, 0}, {7, 4, 8}}},
        {"minkowski() { torus(10, 3); cube(2); }", 3797, {{-13, -13, -3}, {15, 15, 5}}},
    };
    CHECK_ALL(solids);
}

static void projections_are_flat(void **state)
{
    (void)state;
    const solid solids[] = {
        {"linear_extrude(2) projection() rotate([90, 0, 0]) cylinder(h = 6, r = 2);",
         48,
         {{-2, -6, 0}, {2, 0, 2}}},
        {"linear_extrude(2) projection() sphere(3);", 18 * PI, {{-3, -3, 0}, {3, 3, 2}}},
        {"linear_extrude(2) projection(cut = true) translate([0, 0, 3]) sphere(5);",
         32 * PI,
         {{-4, -4, 0}, {4, 4, 2}}},
        {"linear_extrude(2) projection() polyhedron([[0,0,0], [4,0,0], [4,4,0], [0,4,0], [0,0,3],"
         " [4,0,3], [4,4,3], [0,4,3]], [[0,1,2,3], [4,5,1,0], [7,6,5,4], [5,6,2,1], [6,7,3,2],"
         " [7,4,0,3]]);",
         32,
         {{0, 0, 0}, {4, 4, 2}}},
    };
    CHECK_ALL(solids);
}

/* ---- deformations ------------------------------------------------------------------------------
 */

static void deformations_keep_their_promise(void **state)
{
    (void)state;
    const solid solids[] = {
        {"resize([10, 8, 6]) sphere(2);", 80 * PI, {{-5, -4, -3}, {5, 4, 3}}},
        {"resize([10, 0, 0], auto = [false, true, false]) cube([5, 2, 1]);",
         40,
         {{0, 0, 0}, {10, 4, 1}}},
        {"resize([0, 0, 9]) rotate([0, 90, 0]) cylinder(h = 4, r = 2);",
         36 * PI,
         {{0, -2, -4.5}, {4, 2, 4.5}}},
        {"offset3d(1) cube([6, 4, 2]);", 48 + 88 + 12 * PI + 4 * PI / 3, {{-1, -1, -1}, {7, 5, 3}}},
        {"offset3d(-1) cube([6, 4, 4]);", 16, {{1, 1, 1}, {5, 3, 3}}},
        {"shell(1) sphere(5);", 4 * PI / 3 * 61, {{-5, -5, -5}, {5, 5, 5}}},
        {"repeat([3, 4, 0], [3, 2]) cube(2);", 48, {{0, 0, 0}, {8, 6, 2}}},
        {"repeat([3, 0, 3], 2) cube(2);", 32, {{0, 0, 0}, {5, 2, 5}}},
        {"twist(9) translate([-3, -1, 0]) cube([6, 2, 10]);",
         120,
         {{-3.16, -3.16, 0}, {3.16, 3.16, 10}}},
        {"bend(10) translate([-8, -1, -1]) cube([16, 2, 2]);",
         64,
         {{-11 * sin(0.8), -1, -1}, {11 * sin(0.8), 1, 10 - 9 * cos(0.8)}}},
        {"tube([[0,0,0], [6,0,0], [6,6,0]], 1);",
         41.6, /* OpenSCAD, as two cylinders and balls */
         {{-1, -1, -1}, {7, 7, 1}}},
    };
    CHECK_ALL(solids);
}

static void curves_are_swept(void **state)
{
    (void)state;
    const solid solids[] = {
        {"tube([[0,0,0], [5,10,0], [10,0,0]], 1, 2);", /* length 14.789 */
         14.789 * PI + 4 * PI / 3,
         {{-0.9, -0.5, -1}, {10.9, 6, 1}}},
        {"spline([[5,0,0], [0,5,0], [-5,0,0], [0,-5,0]], 1, closed = true);",
         93.385, /* length 29.725 */
         {{-6, -6, -1}, {6, 6, 1}}},
    };
    for (size_t i = 0; i < 2; i++) {
        compile(solids[i].scene, NULL);
        measured m = measure(48);
        if (fabs(m.volume - solids[i].volume) > 0.04 * solids[i].volume)
            print_error("%s: %g, expected %g\n", solids[i].scene, m.volume, solids[i].volume);
        assert_true(fabs(m.volume - solids[i].volume) <= 0.04 * solids[i].volume);
        assert_true(farthest_side(m.box, solids[i].box) <= 2 * m.cell);
    }
}

/* The wall takes about its thickness times the area of the surface. */
static void periodic_surfaces_are_walls(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        double area; /* of one cell of edge 1 */
    } kinds[] = {{"gyroid", 3.09}, {"schwarz_p", 2.35}, {"diamond", 3.84}};
    for (size_t i = 0; i < 3; i++) {
        char scene[160];
        snprintf(scene, sizeof scene, "intersection() { cube(10); %s(10, thickness = 0.5); }",
                 kinds[i].name);
        compile(scene, NULL);
        measured m = measure(60);
        double wanted = kinds[i].area * 100 * 0.5;
        if (fabs(m.volume - wanted) > 0.1 * wanted)
            print_error("%s: %g, expected %g\n", kinds[i].name, m.volume, wanted);
        assert_true(fabs(m.volume - wanted) <= 0.1 * wanted);
    }
}

/* ---- facets ------------------------------------------------------------------------------------
 */

static double ngon(double n)
{
    return n / 2 * sin(2 * PI / n);
}

static void a_small_fn_makes_polygons(void **state)
{
    (void)state;
    const double h6 = sqrt(3) / 2;
    const solid solids[] = {
        {"cylinder(h = 5, r = 3, $fn = 6);", 45 * ngon(6), {{-3, -3 * h6, 0}, {3, 3 * h6, 5}}},
        {"cylinder(h = 6, r1 = 3, r2 = 0, $fn = 4);", 36, {{-3, -3, 0}, {3, 3, 6}}},
        {"linear_extrude(2) circle(4, $fn = 3);", 32 * ngon(3), {{-2, -4 * h6, 0}, {4, 4 * h6, 2}}},
        {"sphere(4, $fn = 8);",
         206.7, /* OpenSCAD */
         {{-4 * 0.92388, -4 * 0.92388, -4 * 0.92388}, {4 * 0.92388, 4 * 0.92388, 4 * 0.92388}}},
        {"rotate_extrude($fn = 6) translate([4, 0]) square(2);",
         2 * (36 - 16) * ngon(6),
         {{-6, -6 * h6, 0}, {6, 6 * h6, 2}}},
        {"rotate_extrude($fn = 8, angle = 90) translate([4, 0]) square(2);",
         2 * (36 - 16) * ngon(8) / 4,
         {{0, 0, 0}, {6, 6, 2}}},
        /* a box of edges 6, rounded */
        {"rotate(45) cylinder(h = 6, r = sqrt(18), round = 1, $fn = 4);",
         64 + 96 + 12 * PI + 4 * PI / 3,
         {{-3, -3, 0}, {3, 3, 6}}},
    };
    CHECK_ALL(solids);
}

static void exact_facets_follow_fa_and_fs(void **state)
{
    (void)state;
    csgm_scene_options options = {.struct_size = sizeof options, .facets = CSGM_FACETS_EXACT};
    const solid solids[] = {
        /* 5 edges at least; 2 pi r / 2 of length 2 else, of 12 degrees at most */
        {"cylinder(h = 2, r = 1);", 2 * ngon(5), {{-0.809, -0.951, 0}, {1, 0.951, 2}}},
        {"cylinder(h = 2, r = 4);", 32 * ngon(13), {{-3.88, -3.97, 0}, {4, 3.97, 2}}},
        {"cylinder(h = 2, r = 40);", 3200 * ngon(30), {{-40, -39.8, 0}, {40, 39.8, 2}}},
        {"cylinder(h = 2, r = 4, $fn = 32);", 32 * ngon(32), {{-4, -4, 0}, {4, 4, 2}}},
        {"linear_extrude(2) offset(r = 1, $fn = 4) square(4);",
         2 * (16 + 16 + ngon(4)),
         {{-1, -1, 0}, {5, 5, 2}}},
    };
    for (size_t i = 0; i < sizeof solids / sizeof *solids; i++)
        check(&solids[i], 40, &options);
}

/* ---- messages ----------------------------------------------------------------------------------
 */

static void check_code(const char *scene, int code)
{
    bench_compile(&b, scene);
    if (!bench_has(&b, code))
        print_error("%s: expected %d\n%s", scene, code, b.text);
    assert_true(bench_has(&b, code));
}

static void what_cannot_be_is_told(void **state)
{
    (void)state;
    check_code("circle(5);", -322);
    check_code("union() { cube(1); circle(1); }", -320);
    check_code("linear_extrude(2) { circle(1); cube(1); }", -320);
    check_code("linear_extrude(2) cube(1);", 321);
    check_code("projection() circle(1);", 321);
    check_code("linear_extrude(2) rotate([90, 0, 0]) square(2);", -323);
    check_code("linear_extrude(2) rotate([30, 0, 0]) square(2);", -323);
    check_code("linear_extrude(2) polygon([]);", -325);
    check_code("linear_extrude(2) polygon([[0, 0], [1, 0], 3]);", 327);
    check_code("linear_extrude(2) polygon([[0, 0], [1, 0], [1, 1]], [[0, 1, 3]]);", 327);
    check_code("polyhedron([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 7]]);", 327);
    check_code("polyhedron([[0,0,0], [4,0,0], [0,4,0], [0,0,4]], [[0,1,2], [0,3,1], [0,2,3]]);",
               -324);
    check_code("import(\"no such file.stl\");", 328);
    check_code("rotate_extrude() circle(3);", 330);
    check_code("rotate_extrude(angle = 0) translate([4, 0]) circle(3);", -325);
    check_code("hull() plane();", 331);
    check_code("linear_extrude(0) circle(1);", -325);
    check_code("scale([1, 0, 1]) cube(1);", -303);
    check_code("tube([[0, 0, 0]], 1);", 301);
    check_code("tube([[0, 0, 0], [1, 0, 0], [1, 1, 0]], 1, 3);", 327);
}

/* What files do that were made for OpenSCAD: at most a warning, and the solid that it makes. */
static void real_files_run(void **state)
{
    (void)state;
    const struct {
        const char *scene;
        int code; /* of the warning, or 0 */
        double volume;
    } rows[] = {
        {"cube(2); translate([5, 0, 0]) cube([1, 0, 1]);", -325, 8},
        {"cube(2); cylinder(h = 0, r = 1); cylinder(h = 3, r1 = -1, r2 = 1); sphere(0);", -325, 8},
        {"difference() { cube(2); cylinder(h = 5, r = 0); }", -325, 8},
        {"cube(2); linear_extrude(-1) circle(4);", -325, 8},
        {"cube(2); scale([1, 1, 0]) cube(5);", -303, 8},
        {"color([255, 0, 0]) cube(2);", -306, 8},
        {"color(\"no colour\", 2) cube(2);", -306, 8},
        {"rotate(90, [0, 0, 0]) cube(2);", 0, 8},
        {"multmatrix([[2, 0, 0], [0, 1, 0], [0, 0, 1], [1e-17, 0, 0, 1]]) cube(2);", 0, 16},
        {"multmatrix([[2, 0, 0], [0, 1, 0], [0, 0, 1], [1, 0, 0, 1]]) cube(2);", -307, 16},
        {"cube(2); hull() intersection() { cube(1); translate([-1, 0, 0]) cube(1); }", 0, 8},
        {"cube(2); linear_extrude(2, scale = [0.5, 1]) intersection() { square(1); "
         "translate([9, 9]) square(1); }",
         -325, 8},
        {"cube(2); minkowski() { sphere(1); intersection() { cube(1); translate([5, 0, 0]) "
         "cube(1); "
         "} }",
         -325, 8},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        compile(rows[i].scene, NULL);
        if (rows[i].code ? !bench_has(&b, rows[i].code) : b.code_count != 0)
            print_error("%s: expected %d\n%s", rows[i].scene, rows[i].code, b.text);
        assert_true(rows[i].code ? bench_has(&b, rows[i].code) : b.code_count == 0);
        check(&(solid){rows[i].scene, rows[i].volume, {{0, 0, 0}, {rows[i].volume / 4, 2, 2}}}, 40,
              NULL);
    }
}

static void flat_transforms_keep_the_plane(void **state)
{
    (void)state;
    compile("linear_extrude(2) translate([1, 2, 9]) square(2);", NULL);
    assert_int_equal(b.code_count, 0);
    compile("linear_extrude(2) rotate([180, 0, 0]) square(2);", NULL);
    assert_int_equal(b.code_count, 0);
    const solid mirrored = {
        "linear_extrude(2) rotate([180, 0, 0]) square([4, 2]);", 16, {{0, -2, 0}, {4, 0, 2}}};
    check(&mirrored, 40, NULL);
}

/* ---- memory ------------------------------------------------------------------------------------
 */

static csgm_status compile_all_shapes(bench *poor)
{
    static const char scene[] =
        "linear_extrude(3, twist = 20, scale = 0.5) offset(r = -0.2) union() { square(3);"
        " polygon([[0,0], [4,1], [1,4]]); }\n"
        "rotate_extrude(angle = 40) square([2, 1]); sphere(2, $fn = 5); cylinder(2, 1, 0, $fn = "
        "4);\n"
        "hull() { cube(1); translate([2, 0, 0]) sphere(1); cylinder(h = 1, r = 1, $fn = 3); }\n"
        "minkowski() { cube(1); polyhedron([[0,0,0], [1,0,0], [0,1,0], [0,0,1]], [[0,1,2], [0,3,1],"
        " [0,2,3], [1,3,2]]); }\n"
        "linear_extrude(1) projection() rotate([20, 0, 0]) cube(2);\n"
        "translate([9, 0, 0]) { #cube(1); %union() { sphere(1); cube(2); } #circle(1); }\n"
        "shell(0.1) resize([1, 2, 3]) repeat([2, 0, 0], 2) tube([[0,0,0], [1,0,0]], 0.5);\n"
        "offset3d(1) superellipsoid([9, 3, 3], 4);\n";
    return bench_compile(poor, scene);
}

/* The gauge of a superellipsoid moves its farthest end by the longest semi-axis over the shortest,
 * scale by its factor; blends and edges of distances are not told of. */
static void offsets_of_bounds_are_told(void **state)
{
    static const struct {
        const char *scene;
        bool told;
    } rows[] = {
        {"offset3d(2) superellipsoid([9, 3, 3], 4);", true},
        {"shell(0.5) superellipsoid([6, 3, 3], 4);", true},
        {"offset3d(2) superellipsoid([3.3, 3, 3], 2);", false},
        {"offset3d(-1) scale([1, 2.5, 1]) cube(9);", true},
        {"offset3d(1) scale([1, 1.1, 1]) cube(9);", false},
        {"offset3d(0) scale([1, 2.5, 1]) cube(9);", false},
        {"linear_extrude(2) offset3d(1) scale([3, 1]) circle(2);", true},
        {"offset3d(1) scale(3) ellipsoid([1, 2, 5]);", false},
        {"shell(1) difference(blend = 1) { cube(9); sphere(5); }", false},
    };
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        assert_int_equal(bench_compile(&b, rows[i].scene), CSGM_OK);
        if (bench_has(&b, -348) != rows[i].told)
            fail_msg("W0348 %s: %s", rows[i].told ? "is missing" : "came", rows[i].scene);
    }
}

static void every_allocation_may_fail(void **state)
{
    (void)state;
    assert_true(bench_fail_every(compile_all_shapes, 100, 60) > 100);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(figures_have_their_areas),
        cmocka_unit_test(roofs_follow_the_distance),
        cmocka_unit_test(offsets_round_and_cut_corners),
        cmocka_unit_test(extrusions_follow_openscad),
        cmocka_unit_test(the_axis_is_no_surface),
        cmocka_unit_test(a_twist_turns_clockwise),
        cmocka_unit_test(hulls_are_convex),
        cmocka_unit_test(sums_grow_solids),
        cmocka_unit_test(sums_of_hollow_solids),
        cmocka_unit_test(projections_are_flat),
        cmocka_unit_test(deformations_keep_their_promise),
        cmocka_unit_test(curves_are_swept),
        cmocka_unit_test(periodic_surfaces_are_walls),
        cmocka_unit_test(a_small_fn_makes_polygons),
        cmocka_unit_test(exact_facets_follow_fa_and_fs),
        cmocka_unit_test(what_cannot_be_is_told),
        cmocka_unit_test(offsets_of_bounds_are_told),
        cmocka_unit_test(real_files_run),
        cmocka_unit_test(flat_transforms_keep_the_plane),
        cmocka_unit_test(every_allocation_may_fail),
    };
    return cmocka_run_group_tests(tests, open_bench, close_bench);
}
