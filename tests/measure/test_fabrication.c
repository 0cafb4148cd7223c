/* SPDX-License-Identifier: MIT
 * Oriented boxes and faces by direction: closed forms, random rotations, what is refused.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
/* cmocka wants the four above first */
#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/geometry.h"
#include "base/random.h"
#include "csgmesh/fabrication.h"

typedef struct solid {
    csgm_context *context;
    csgm_scene *scene;
    csgm_field *field;
} solid;

static void open_solid(solid *s, const char *text, uint32_t threads)
{
    csgm_context_options options = csgm_context_options_default();
    options.threads = threads;
    assert_int_equal(csgm_context_create(&options, &s->context), CSGM_OK);
    assert_int_equal(csgm_scene_parse(s->context, text, strlen(text), "test", NULL, &s->scene),
                     CSGM_OK);
    assert_int_equal(csgm_field_compile(s->context, s->scene, &s->field), CSGM_OK);
}

static void close_solid(solid *s)
{
    csgm_field_destroy(s->field);
    csgm_scene_destroy(s->scene);
    csgm_context_destroy(s->context);
}

static void assert_near(double value, double wanted, double within)
{
    assert_true(fabs(value - wanted) <= within);
}

static csgm_oriented_box box_of(const char *text, double tolerance, uint32_t threads)
{
    solid s;
    csgm_oriented_box box = csgm_oriented_box_default();
    csgm_measure_options options = csgm_measure_options_default();
    options.tolerance = tolerance;
    open_solid(&s, text, threads);
    assert_int_equal(csgm_oriented_box_of_field(s.context, s.field, &options, &box), CSGM_OK);
    close_solid(&s);
    return box;
}

static void assert_sound(const csgm_oriented_box *box)
{
    double volume[2] = {1, 1};
    for (int k = 0; k < 3; k++) {
        assert_near(csg_vec3_norm(box->axes[k]), 1, 1e-14);
        assert_near(csg_vec3_dot(box->axes[k], box->axes[(k + 1) % 3]), 0, 1e-14);
        assert_true(box->edges[k].low <= box->edges[k].high);
        assert_true(box->ends[k].low <= box->ends[k].high);
        assert_true(box->ends[k].high <= box->ends[3 + k].low);
        volume[0] *= box->edges[k].low;
        volume[1] *= box->edges[k].high;
    }
    assert_true(box->volume.low <= volume[0] && volume[1] <= box->volume.high);
}

/* ---- scenes ------------------------------------------------------------------------------------
 */

static void test_closed_forms(void **state)
{
    static const struct {
        const char *text;
        double edges[3];
    } rows[] = {
        {"cube([10, 20, 30]);", {30, 20, 10}},
        {"rotate([20, 30, 40]) cube([10, 20, 30]);", {30, 20, 10}},
        {"sphere(5);", {10, 10, 10}},
        {"rotate([10, 50, 0]) cylinder(h = 30, r = 5);", {30, 10, 10}},
        /* edges of a regular tetrahedron are diagonals of the faces of its smallest box */
        {"rotate([25, 65, 10]) polyhedron(points = [[1, 1, 1], [1, -1, -1], [-1, 1, -1],"
         " [-1, -1, 1]], faces = [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]);",
         {2, 2, 2}},
    };
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        csgm_oriented_box box = box_of(rows[i].text, 1e-3, 1);
        double volume = rows[i].edges[0] * rows[i].edges[1] * rows[i].edges[2];
        assert_sound(&box);
        assert_true(box.is_reached);
        assert_true(box.cubes > 0);
        assert_true(box.volume.high >= volume * (1 - 1e-9));
        assert_true(box.volume.low <= volume * 1.02);
        for (int k = 0; k < 3; k++) {
            assert_true(box.edges[k].high >= rows[i].edges[k] * (1 - 0.01));
            assert_true(box.edges[k].low <= rows[i].edges[k] * 1.02);
            assert_true(box.edges[k].high - box.edges[k].low <= 0.2);
        }
    }
}

/* What is claimed of the ends, of a solid whose reach along any direction is known. */
static void test_ends_hold_the_reach(void **state)
{
    csg_random dice = {7};
    (void)state;
    for (int i = 0; i < 6; i++) {
        double at[2][3], r[2];
        char text[256];
        for (int b = 0; b < 2; b++) {
            for (int k = 0; k < 3; k++)
                at[b][k] = csg_random_uniform(&dice, -10, 10);
            r[b] = csg_random_uniform(&dice, 1, 5);
        }
        snprintf(text, sizeof text,
                 "translate([%.17g, %.17g, %.17g]) sphere(%.17g);"
                 "translate([%.17g, %.17g, %.17g]) sphere(%.17g);",
                 at[0][0], at[0][1], at[0][2], r[0], at[1][0], at[1][1], at[1][2], r[1]);
        csgm_oriented_box box = box_of(text, 1e-3, 1);
        assert_sound(&box);
        for (int n = 0; n < 6; n++) {
            csgm_vec3 a = box.axes[n % 3];
            double turn = n < 3 ? -1 : 1, most = -INFINITY;
            for (int b = 0; b < 2; b++)
                most = fmax(most, turn * (a.x * at[b][0] + a.y * at[b][1] + a.z * at[b][2]) + r[b]);
            assert_true(box.ends[n].low - 1e-9 <= turn * most);
            assert_true(box.ends[n].high + 1e-9 >= turn * most);
        }
        /* along the line between the centres it is as large as this, or smaller still */
        double apart = csg_vec3_norm(
            csg_vec3_make(at[1][0] - at[0][0], at[1][1] - at[0][1], at[1][2] - at[0][2]));
        double across = 2 * fmax(r[0], r[1]);
        double along = fmax(across, apart + r[0] + r[1]);
        assert_true(box.volume.low <= along * across * across * 1.001);
    }
}

static void test_same_for_any_threads(void **state)
{
    static const char text[] = "rotate([33, 11, 57]) { cube([3, 4, 9]); torus(4, 1); }";
    csgm_oriented_box one = box_of(text, 1e-3, 1), three = box_of(text, 1e-3, 3);
    (void)state;
    assert_memory_equal(one.axes, three.axes, sizeof one.axes);
    assert_memory_equal(one.ends, three.ends, sizeof one.ends);
    assert_int_equal(one.cubes, three.cubes);
}

static void test_what_is_refused(void **state)
{
    solid s;
    csgm_oriented_box box = csgm_oriented_box_default();
    csgm_measure_options options = csgm_measure_options_default();
    (void)state;
    open_solid(&s, "plane([0, 0, 1]);", 1);
    assert_int_equal(csgm_oriented_box_of_field(s.context, s.field, NULL, &box), CSGM_ERR_SCENE);
    assert_int_equal(csgm_oriented_box_of_field(s.context, NULL, NULL, &box), CSGM_ERR_ARGUMENT);
    assert_int_equal(csgm_oriented_box_of_field(s.context, s.field, NULL, NULL), CSGM_ERR_ARGUMENT);
    options.part = "lid";
    assert_int_equal(csgm_oriented_box_of_field(s.context, s.field, &options, &box),
                     CSGM_ERR_ARGUMENT);
    close_solid(&s);
}

/* ---- meshes ------------------------------------------------------------------------------------
 */

enum { CORNERS = 8, SIDES = 12 };

static const uint32_t BOX_SIDES[3 * SIDES] = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                              2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};

/* A box around the origin, turned. */
static csgm_mesh_view box_mesh(float *positions, csg_affine turn, csg_vec3 size)
{
    for (int i = 0; i < CORNERS; i++) {
        csg_vec3 p = {i & 1 ? size.x / 2 : -size.x / 2, i & 2 ? size.y / 2 : -size.y / 2,
                      i & 4 ? size.z / 2 : -size.z / 2};
        csg_vec3_to_floats(positions + 3 * i, csg_affine_point(&turn, p));
    }
    return (csgm_mesh_view){.positions = positions,
                            .indices = BOX_SIDES,
                            .vertex_count = CORNERS,
                            .triangle_count = SIDES};
}

static csgm_context *open_context(void)
{
    csgm_context *context = NULL;
    csgm_context_options options = csgm_context_options_default();
    options.threads = 1;
    assert_int_equal(csgm_context_create(&options, &context), CSGM_OK);
    return context;
}

static void test_turned_meshes(void **state)
{
    csg_random dice = {3};
    csgm_context *context = open_context();
    (void)state;
    for (int i = 0; i < 12; i++) {
        float positions[3 * CORNERS];
        csg_vec3 axis = {csg_random_uniform(&dice, -1, 1), csg_random_uniform(&dice, -1, 1),
                         csg_random_uniform(&dice, -1, 1)};
        csg_affine turn =
            csg_affine_rotate(csg_random_uniform(&dice, 0, 360), csg_vec3_normalize(axis));
        csgm_mesh_view mesh = box_mesh(positions, turn, csg_vec3_make(1, 2, 3 + i));
        csgm_oriented_box box = csgm_oriented_box_default();
        assert_int_equal(csgm_oriented_box_of_mesh(context, &mesh, NULL, &box), CSGM_OK);
        assert_sound(&box);
        assert_near(box.volume.low, 2.0 * (3 + i), 1e-5 * (3 + i));
        assert_near(box.edges[0].low, 3 + i, 1e-5 * (3 + i));
        for (int v = 0; v < CORNERS; v++)
            for (int k = 0; k < 3; k++) {
                double at = csg_vec3_dot(box.axes[k], csg_vec3_from_floats(positions + 3 * v));
                assert_true(box.ends[k].low <= at && at <= box.ends[3 + k].high);
            }
    }
    csgm_context_destroy(context);
}

static void test_overhangs_of_a_turned_box(void **state)
{
    csgm_context *context = open_context();
    (void)state;
    for (int deg = 0; deg < 90; deg += 10) { /* around y: the side of 6 goes from below to beside */
        float positions[3 * CORNERS];
        csgm_mesh_view mesh = box_mesh(positions, csg_affine_rotate(deg, csg_vec3_make(0, 1, 0)),
                                       csg_vec3_make(2, 3, 4));
        csgm_face_options options = csgm_face_options_default();
        csgm_faces faces = csgm_faces_default();
        options.overhang_deg = 45;
        options.draft_deg = 25;
        assert_int_equal(csgm_faces_of_mesh(context, &mesh, &options, &faces), CSGM_OK);
        double overhang = deg < 45 ? 6 : 12, rests = deg ? 0 : 6;
        double steep = 16 + (deg < 25 ? 24 : deg > 65 ? 12 : 0);
        assert_near(faces.area.low, 52, 1e-4);
        assert_near(faces.overhang.low, overhang, 1e-4);
        assert_near(faces.overhang.high, overhang, 1e-4);
        assert_near(faces.resting.high, rests, 1e-4);
        assert_near(faces.steep.low, steep, 1e-4);
        assert_int_equal(faces.overhang_triangles, 2);
    }
    csgm_context_destroy(context);
}

static void test_an_angle_that_rounding_leaves_open(void **state)
{
    float positions[3 * CORNERS];
    csgm_context *context = open_context();
    csgm_mesh_view mesh = box_mesh(positions, csg_affine_identity(), csg_vec3_make(2, 3, 4));
    csgm_face_options options = csgm_face_options_default();
    csgm_faces faces = csgm_faces_default();
    (void)state;
    options.up = csg_vec3_make(5, 0, 5); /* two sides look down by just 45 degrees */
    assert_int_equal(csgm_faces_of_mesh(context, &mesh, &options, &faces), CSGM_OK);
    assert_true(faces.overhang.low <= 1e-9);
    assert_true(faces.overhang.high >= 6 + 12);
    options.up = csg_vec3_make(0, 0, 0);
    assert_int_equal(csgm_faces_of_mesh(context, &mesh, &options, &faces), CSGM_ERR_ARGUMENT);
    options = csgm_face_options_default();
    options.overhang_deg = 90;
    assert_int_equal(csgm_faces_of_mesh(context, &mesh, &options, &faces), CSGM_ERR_ARGUMENT);
    mesh.triangle_count = 0;
    assert_int_equal(csgm_faces_of_mesh(context, &mesh, NULL, &faces), CSGM_ERR_SCENE);
    mesh.triangle_count = SIDES;
    mesh.vertex_count = CORNERS - 1;
    assert_int_equal(csgm_faces_of_mesh(context, &mesh, NULL, &faces), CSGM_ERR_FORMAT);
    csgm_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_closed_forms),
        cmocka_unit_test(test_ends_hold_the_reach),
        cmocka_unit_test(test_same_for_any_threads),
        cmocka_unit_test(test_what_is_refused),
        cmocka_unit_test(test_turned_meshes),
        cmocka_unit_test(test_overhangs_of_a_turned_box),
        cmocka_unit_test(test_an_angle_that_rounding_leaves_open),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
