/* SPDX-License-Identifier: MIT
 * Solids that make meshers leak: touching ones, faces that coincide or run through lattice points,
 * cut by the bounds, tiny, thin, empty, and far from the origin.
 */
#include "base/mesh_codes.h"
#include "mesh/mesh_support.h"
#include "scene/primitives/kinds.h"

#include <stdio.h>

#define PI 3.14159265358979323846

/* ---- touching -------------------------------------------------------------------------------- */

static csg_node_id cube_at(mesh_case *c, double x, double y, double z)
{
    return moved(c, make_box(c, 0.5, 0.5, 0.5), x, y, z);
}

typedef csg_node_id make_fn(mesh_case *c);

static csg_node_id cubes_at_edge(mesh_case *c)
{
    return joined(c, CSG_NODE_UNION, SHARP, cube_at(c, 0.5, 0.5, 0.5), cube_at(c, -0.5, -0.5, 0.5));
}
static csg_node_id cubes_at_corner(mesh_case *c)
{
    return joined(c, CSG_NODE_UNION, SHARP, cube_at(c, 0.5, 0.5, 0.5),
                  cube_at(c, -0.5, -0.5, -0.5));
}
static csg_node_id cubes_at_face(mesh_case *c)
{
    return joined(c, CSG_NODE_UNION, SHARP, cube_at(c, 0.5, 0, 0), cube_at(c, -0.5, 0, 0));
}
static csg_node_id spheres_touching(mesh_case *c)
{
    return joined(c, CSG_NODE_UNION, SHARP, moved(c, make_sphere(c, 0.5), 0.5, 0, 0),
                  moved(c, make_sphere(c, 0.5), -0.5, 0, 0));
}
/* One ball inside the other, removed, with a common point. */
static csg_node_id hollow_touching(mesh_case *c)
{
    return joined(c, CSG_NODE_DIFFERENCE, SHARP, make_sphere(c, 1),
                  moved(c, make_sphere(c, 0.5), 0.5, 0, 0));
}
static csg_node_id notch_with_common_faces(mesh_case *c)
{
    return joined(c, CSG_NODE_DIFFERENCE, SHARP, make_box(c, 1, 1, 1), cube_at(c, 0.5, 0.5, 0.5));
}
/* The solid between two coincident faces: nothing. */
static csg_node_id cube_minus_itself(mesh_case *c)
{
    return joined(c, CSG_NODE_DIFFERENCE, SHARP, make_box(c, 1, 1, 1), make_box(c, 1, 1, 1));
}
/* Two cubes that share a face, met: a square without volume. */
static csg_node_id square(mesh_case *c)
{
    return joined(c, CSG_NODE_INTERSECTION, SHARP, cube_at(c, 0.5, 0, 0), cube_at(c, -0.5, 0, 0));
}
static csg_node_id twice(mesh_case *c)
{
    return joined(c, CSG_NODE_UNION, SHARP, make_sphere(c, 1), make_sphere(c, 1));
}
static csg_node_id rounded_common_faces(mesh_case *c)
{
    return joined(c, CSG_NODE_UNION, ROUND(0.2), cube_at(c, 0.5, 0, 0), cube_at(c, -0.5, 0, 0));
}
static csg_node_id checkerboard(mesh_case *c)
{
    csg_node_id cubes[32];
    int n = 0;
    for (int i = 0; i < 64; i++)
        if (((i & 3) + (i >> 2 & 3) + (i >> 4)) % 2 == 0)
            cubes[n++] = cube_at(c, i & 3, i >> 2 & 3, i >> 4);
    return csg_build_operator(&c->builder, CSG_NODE_UNION, SHARP, cubes, (size_t)n, NOWHERE);
}
static csg_node_id cone_on_its_tip(mesh_case *c)
{
    csg_node_id up =
        csg_build_primitive(&c->builder, CSG_NODE_FRUSTUM, (double[]){0, 0.5, 0.5, 0}, NOWHERE);
    csg_node_id down =
        csg_build_primitive(&c->builder, CSG_NODE_FRUSTUM, (double[]){0.5, 0, 0.5, 0}, NOWHERE);
    return joined(c, CSG_NODE_UNION, SHARP, moved(c, up, 0, 0, 0.5), moved(c, down, 0, 0, -0.5));
}
static csg_node_id thin_plate(mesh_case *c)
{
    return turned(c, make_box(c, 1, 1, 0.004), 31, csg_vec3_make(0.6, 0.8, 0));
}
static csg_node_id spindle_torus(mesh_case *c)
{
    return csg_build_primitive(&c->builder, CSG_NODE_TORUS, (double[]){0.5, 0.5, 180}, NOWHERE);
}

static const struct {
    const char *name;
    make_fn *make;
    double volume; /* < 0: not known or not reached at this resolution */
} touching[] = {
    {"cubes at an edge", cubes_at_edge, 2},
    {"cubes at a corner", cubes_at_corner, 2},
    {"cubes at a face", cubes_at_face, 2},
    {"spheres at a point", spheres_touching, PI / 3},
    {"hollow at a point", hollow_touching, 4 * PI / 3 * 0.875},
    {"notch", notch_with_common_faces, 7},
    {"cube minus itself", cube_minus_itself, -1},
    {"square", square, -1},
    {"sphere twice", twice, 4 * PI / 3},
    {"rounded cubes at a face", rounded_common_faces, -1},
    {"checkerboard", checkerboard, 32},
    {"cone on its tip", cone_on_its_tip, 2 * PI / 12},
    {"thin plate", thin_plate, -1},
    {"spindle torus", spindle_torus, -1},
};

/* Bounds around [-1.5, 1.5]^3 and more whose lattice has points on all multiples of h (`on`), or
 * halfway between them. */
static csg_box lattice_bounds(double h, bool on)
{
    double half = ceil(4.2 / h) * h - (on ? 0.5 * h : 0);
    return (csg_box){{-half, -half, -half}, {half, half, half}};
}

static void check_touching(size_t i, csgm_mesh_options options, const char *how)
{
    mesh_case c;
    char what[96];
    snprintf(what, sizeof what, "%s, %s", touching[i].name, how);
    mesh_case_begin(&c, 2);
    mesh_case_compile(&c, touching[i].make(&c));
    mesh_build_closed(&c, &options, what);
    double volume = touching[i].volume, tolerance = 2.5 * c.stats.cell_size * volume;
    if (volume > 0 && !(fabs(c.check.volume - volume) < tolerance))
        fail_msg("%s: volume %g, not %g", what, c.check.volume, volume);
    mesh_case_end(&c);
}

static void test_touching(void **state)
{
    static const uint32_t resolutions[] = {7, 16, 33, 64};
    for (size_t i = 0; i < sizeof touching / sizeof *touching; i++) {
        for (size_t r = 0; r < sizeof resolutions / sizeof *resolutions; r++)
            check_touching(i, mesh_options(resolutions[r]), "own bounds");
        csgm_mesh_options options = mesh_options(0);
        for (int k = 0; k < 2; k++) {
            options.cell_size = 0.125; /* faces on lattice points: every sample exact */
            options.bounds = lattice_bounds(options.cell_size, k == 0);
            check_touching(i, options, k ? "faces between points" : "faces on points");
        }
    }
}

/* ---- cut by the bounds -------------------------------------------------------------------------
 */

static void test_capped(void **state)
{
    mesh_case c;
    mesh_case_begin(&c, 2);
    mesh_case_compile(&c, make_sphere(&c, 1));
    csgm_mesh_options options = mesh_options(100);
    options.bounds = (csg_box){{-2, -2, 0}, {2, 2, 2}};
    mesh_build_closed(&c, &options, "half a ball");
    test_near(c.check.volume, 2 * PI / 3, 0.01 * 2 * PI / 3);
    test_near(c.check.bounds.min.z, 0, 1e-6);
    assert_int_equal(c.last_code, CSG_DIAG_CUT_BY_BOUNDS);
    options.bounds = (csg_box){{-0.25, -0.5, -0.4}, {0.25, 0.5, 0.3}};
    mesh_build_closed(&c, &options, "a box out of a ball");
    test_near(c.check.volume, 0.5 * 1 * 0.7, 0.01 * 0.35);
    assert_int_equal(c.check.euler, 2);
    options.bounds = (csg_box){{-2, -2, -2}, {2, 2, 2}};
    mesh_build_closed(&c, &options, "all of the ball");
    assert_int_equal(c.findings, 0);
    mesh_case_end(&c);
}

static void test_capped_half_space(void **state)
{
    mesh_case c;
    mesh_case_begin(&c, 2);
    mesh_case_compile(&c, make_half_space(&c, 0.6, 0, 0.8, 0.1));
    csgm_mesh_options options = mesh_options(64);
    assert_int_equal(mesh_build(&c, &options), CSGM_ERR_SCENE);
    assert_null(c.mesh);
    assert_int_equal(c.last_code, CSG_DIAG_UNBOUNDED);
    options.bounds = (csg_box){{-1, -1, -1}, {1, 1, 1}};
    mesh_build_closed(&c, &options, "half-space");
    /* the plane cuts the upright sides only: 0.6 x + 0.8 z = 0.1 at x = -1 and 1 */
    test_near(c.check.volume, 4 * (1 + 0.125), 0.04);
    assert_int_equal(c.check.euler, 2);
    mesh_case_end(&c);
}

static void test_bad_bounds(void **state)
{
    mesh_case c;
    mesh_case_begin(&c, 1);
    mesh_case_compile(&c, make_sphere(&c, 1));
    csgm_mesh_options options = mesh_options(32);
    options.bounds = (csg_box){{-1, -1, -INFINITY}, {1, 1, 1}};
    assert_int_equal(mesh_build(&c, &options), CSGM_ERR_ARGUMENT);
    assert_int_equal(c.last_code, CSG_DIAG_BAD_BOUNDS);
    options.bounds = csg_box_empty();
    options.resolution = UINT32_MAX;
    assert_int_equal(mesh_build(&c, &options), CSGM_ERR_LIMIT);
    assert_int_equal(c.last_code, CSG_DIAG_TOO_FINE);
    options.cell_size = 1e-9;
    assert_int_equal(mesh_build(&c, &options), CSGM_ERR_LIMIT);
    assert_null(c.mesh);
    mesh_case_end(&c);
}

/* ---- tiny, thin, empty
 * ---------------------------------------------------------------------------- */

/* Smaller than a cell: there or not there, but closed; and found with cells of its own size. */
static void test_tiny(void **state)
{
    mesh_case c;
    mesh_case_begin(&c, 2);
    csg_node_id dust[3] = {make_sphere(&c, 1), moved(&c, make_sphere(&c, 0.01), 1.5, 0, 0),
                           moved(&c, make_box(&c, 0.003, 0.2, 0.003), -1.5, 0.4, 0.7)};
    mesh_case_compile(&c, csg_build_operator(&c.builder, CSG_NODE_UNION, SHARP, dust, 3, NOWHERE));
    for (uint32_t resolution = 8; resolution <= 64; resolution += 7) {
        csgm_mesh_options options = mesh_options(resolution);
        mesh_build_closed(&c, &options, "dust");
        assert_in_range(c.check.components, 1, 3);
    }
    csgm_mesh_options options = mesh_options(64);
    options.bounds = (csg_box){{1.48, -0.02, -0.02}, {1.52, 0.02, 0.02}};
    mesh_build_closed(&c, &options, "a grain");
    test_near(c.check.volume, 4 * PI / 3 * 1e-6, 1e-8);
    mesh_case_end(&c);
}

static void test_no_surface(void **state)
{
    mesh_case c;
    mesh_case_begin(&c, 2);
    mesh_case_compile(&c, make_sphere(&c, 1));
    csgm_mesh_options options = mesh_options(32);
    options.bounds = (csg_box){{5, 5, 5}, {6, 6, 6}};
    mesh_build_closed(&c, &options, "nothing there");
    assert_int_equal(c.mesh->vertex_count, 0);
    assert_int_equal(c.mesh->triangle_count, 0);
    assert_int_equal(c.last_code, CSG_DIAG_NO_SURFACE);
    mesh_case_end(&c);
}

static void test_empty_scene(void **state)
{
    mesh_case c;
    mesh_case_begin(&c, 2);
    mesh_case_compile(&c, csg_build_empty(&c.builder, NOWHERE));
    csgm_mesh_options options = mesh_options(32);
    mesh_build_closed(&c, &options, "empty");
    assert_int_equal(c.mesh->triangle_count, 0);
    options.bounds = (csg_box){{-1, -1, -1}, {1, 1, 1}};
    mesh_build_closed(&c, &options, "empty in bounds");
    assert_int_equal(c.mesh->triangle_count, 0);
    mesh_case_end(&c);
}

/* All of space, cut by the bounds: a box. */
static void test_all_of_space(void **state)
{
    mesh_case c;
    mesh_case_begin(&c, 2);
    csg_node_id all = joined(&c, CSG_NODE_UNION, SHARP, make_half_space(&c, 0, 0, 1, 1),
                             make_half_space(&c, 0, 0, -1, 1));
    mesh_case_compile(&c, all);
    csgm_mesh_options options = mesh_options(32);
    options.bounds = (csg_box){{-1, -2, -3}, {1, 2, 3}};
    mesh_build_closed(&c, &options, "space");
    test_near(c.check.volume, 48, 0.5);
    assert_int_equal(c.check.euler, 2);
    mesh_case_end(&c);
}

/* ---- far away and out of scale
 * ---------------------------------------------------------------------- */

static void check_far(double distance, double size)
{
    mesh_case c;
    char what[64];
    snprintf(what, sizeof what, "%g at %g", size, distance);
    mesh_case_begin(&c, 2);
    csg_node_id ring =
        csg_build_primitive(&c.builder, CSG_NODE_TORUS, (double[]){size, 0.3 * size, 180}, NOWHERE);
    csg_node_id ball = moved(&c, make_sphere(&c, 0.4 * size), size, 0, 0);
    csg_node_id both = joined(&c, CSG_NODE_UNION, ROUND(0.2 * size), ring, ball);
    mesh_case_compile(&c, moved(&c, both, distance, -distance, 0.5 * distance));
    csgm_mesh_options options = mesh_options(64);
    mesh_build_closed(&c, &options, what);
    assert_int_equal(c.check.euler, 0);
    double unit = 2 * PI * PI * 0.09 * size * size * size;
    assert_true(c.check.volume > unit && c.check.volume < 1.2 * unit);
    double error = mesh_largest_error(&c);
    /* Positions are floats around the mesh's origin, and doubles end somewhere too. */
    double allowed = 1e-5 * 2.6 * size + 8 * 0x1p-52 * distance;
    if (!(error < allowed) && csg_vec3_norm(c.mesh->origin) > 0)
        fail_msg("%s: a vertex is %g off", what, error);
    mesh_case_end(&c);
}

static void test_far(void **state)
{
    check_far(1e6, 1);
    check_far(1e9, 1);
    check_far(0, 1e6);
    check_far(0, 1e-6);
    check_far(1000, 1e-3);
    check_far(100, 1);
}

/* Two balls a million radii apart: each smaller than a cell, or alone. */
static void test_far_apart(void **state)
{
    mesh_case c;
    mesh_case_begin(&c, 2);
    mesh_case_compile(&c, joined(&c, CSG_NODE_UNION, ROUND(0.1), make_sphere(&c, 1),
                                 moved(&c, make_sphere(&c, 1), 1e6, 0, 0)));
    csgm_mesh_options options = mesh_options(128);
    mesh_build_closed(&c, &options, "far apart");
    options.bounds = (csg_box){{1e6 - 1.1, -1.1, -1.1}, {1e6 + 1.1, 1.1, 1.1}};
    mesh_build_closed(&c, &options, "the far one");
    assert_int_equal(c.check.euler, 2);
    test_near(c.check.volume, 4 * PI / 3, 0.3);
    mesh_case_end(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_touching),
        cmocka_unit_test(test_capped),
        cmocka_unit_test(test_capped_half_space),
        cmocka_unit_test(test_bad_bounds),
        cmocka_unit_test(test_tiny),
        cmocka_unit_test(test_no_surface),
        cmocka_unit_test(test_empty_scene),
        cmocka_unit_test(test_all_of_space),
        cmocka_unit_test(test_far),
        cmocka_unit_test(test_far_apart),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
