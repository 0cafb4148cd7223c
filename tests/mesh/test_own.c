/* SPDX-License-Identifier: MIT
 * Polyhedra that go out as their own triangles: placed, painted and turned as the scene says, where
 * they are a sound mesh of the solid; whatever is not, and whatever options ask for cells, is
 * meshed as ever. Seeded random shells say that what is taken has the solid on its inner side
 * everywhere (by solid angles) and meets nowhere (CGAL); every allocation may fail.
 */
#include "mesh/own_support.h"
#include "mesh/pipeline/own.h"
#include "mesh/uncrossed.h"
#include "shape/plane/region.h"
#include "shape/polyhedra/booleans.h"
#include "shape/solid_support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- placed and painted ------------------------------------------------------------------------
 */

/* Each vertex is a vertex of the polyhedron, moved and rounded; nothing else is in the mesh. */
static void test_vertices(void **state)
{
    (void)state;
    for (int mirrored = 0; mirrored < 2; mirrored++) {
        mesh_case c;
        mesh_case_begin(&c, 2);
        csg_affine by = csg_affine_rotate(25, csg_vec3_make(1, 2, 3));
        if (mirrored)
            by = csg_affine_multiply(by, csg_affine_scale(csg_vec3_make(-2, 1, 0.5)));
        csg_node_id ball = make_ball(&c, csg_vec3_make(1, 2, 3), 2, 30, 0.1);
        mesh_case_compile(&c, csg_build_transform(&c.builder, &by, ball, NOWHERE));
        csgm_mesh_options options = plain();
        mesh_build_closed(&c, &options, "a ball");
        const csg_triangles *from = csg_polyhedron_triangles(c.scene->shapes[0]);
        assert_int_equal(c.stats.own_triangles, from->count);
        assert_int_equal(c.mesh->triangle_count, from->count);
        assert_int_equal(c.mesh->vertex_count, from->point_count);
        for (size_t i = 0; i < from->point_count; i++) {
            float at[3];
            csg_vec3_to_floats(at, csg_affine_point(&by, from->points[i]));
            bool found = false;
            for (size_t k = 0; k < c.mesh->vertex_count && !found; k++)
                found = !memcmp(at, c.mesh->positions + 3 * k, sizeof at);
            assert_true(found);
        }
        assert_true(c.check.volume > 0);
        assert_true(c.stats.cell_size == 0 && c.stats.tolerance == 0);
        mesh_case_end(&c);
    }
}

static void test_looks(void **state)
{
    (void)state;
    mesh_case c;
    mesh_case_begin(&c, 1);
    const csg_look inner = {.color = {0, 1, 0, 1},
                            .metallic = 1,
                            .roughness = 0.25f,
                            .has_color = true,
                            .has_material = true};
    const csg_look outer = {.color = {1, 0, 0, 0.5f}, .has_color = true};
    csg_node_id a =
        csg_build_look(&c.builder, &inner, make_ball(&c, csg_vec3_make(0, 0, 0), 1, 8, 0), NOWHERE);
    a = csg_build_look(&c.builder, &outer, a, NOWHERE);
    csg_node_id b = make_ball(&c, csg_vec3_make(3, 0, 0), 1, 8, 0);
    mesh_case_compile(&c, joined(&c, CSG_NODE_UNION, SHARP, a, b));
    csgm_mesh_options options = plain();
    mesh_build_closed(&c, &options, "two balls");
    assert_int_equal(c.stats.own_triangles, c.mesh->triangle_count);
    assert_int_equal(c.check.components, 2);
    static const uint8_t colors[2][4] = {{255, 0, 0, 128}, {199, 199, 204, 255}};
    static const uint16_t materials[2][2] = {{10000, 2500}, {0, 6000}};
    for (size_t i = 0; i < c.mesh->vertex_count; i++) {
        int which = c.mesh->positions[3 * i] > 1.5f;
        assert_memory_equal(c.mesh->colors + 4 * i, colors[which], 4);
        assert_memory_equal(c.mesh->materials + 2 * i, materials[which], 4);
    }
    mesh_case_end(&c);
}

/* A box has three normals at each corner, and 24 vertices, where creases part them. */
static void test_normals(void **state)
{
    (void)state;
    mesh_case c;
    csg_triangles box;
    mesh_case_begin(&c, 1);
    csg_triangles_init(&box, &c.context.memory);
    solid_add_fine_box(&box, csg_vec3_make(0, 0, 0), csg_vec3_make(1, 1, 1), 1);
    mesh_case_compile(&c, shape_of(&c, &box));
    csg_triangles_release(&box);
    csgm_mesh_options options = plain();
    mesh_build_closed(&c, &options, "a box");
    assert_int_equal(c.mesh->vertex_count, 8);
    options.normals = CSGM_NORMALS_CREASE;
    assert_int_equal(own_of(&c, &options), 12);
    assert_int_equal(c.mesh->vertex_count, 24);
    assert_true(c.mesh->split);
    for (size_t i = 0; i < 24; i++) {
        const float *n = c.mesh->normals + 3 * i;
        assert_true(fabsf(n[0]) + fabsf(n[1]) + fabsf(n[2]) == 1);
    }
    options.normals = CSGM_NORMALS_NONE;
    assert_int_equal(own_of(&c, &options), 12);
    assert_null(c.mesh->normals);
    mesh_case_end(&c);
}

/* ---- extruded outlines -------------------------------------------------------------------------
 */

static csg_node_id make_stars(mesh_case *c, csg_random *random, double *area)
{
    csg_outline outline;
    csg_outline_init(&outline, &c->context.memory);
    for (int i = 0; i < 20; i++) {
        csg_vec2 center = {2.1 * (i % 5), 2.1 * (i / 5)};
        add_star(&outline, random, center, 0.7, 1, 30, false);
        add_star(&outline, random, center, 0.2, 0.6, 20, true);
    }
    *area = area_of(&outline);
    return region_of(c, &outline);
}

static void test_extrusions(void **state)
{
    (void)state;
    for (unsigned seed = 0; seed < 12; seed++) {
        mesh_case c;
        csg_random random = {seed + 1};
        double area;
        mesh_case_begin(&c, 2);
        csg_affine turn = csg_affine_rotate(20, csg_vec3_make(0, 0, 1));
        turn.m[2][0] = 5; /* is not looked at in the plane */
        csg_node_id flat =
            csg_build_transform(&c.builder, &turn, make_stars(&c, &random, &area), NOWHERE);
        flat = csg_build_color(&c.builder, (csg_color){1, 0, 0, 1}, flat, NOWHERE);
        csg_node_id node = csg_build_extrude(&c.builder, flat, 1, 3, NOWHERE);
        mesh_case_compile(&c, seed % 3 == 0   ? node
                              : seed % 3 == 1 ? moved(&c, node, 7.3, 1e-3, 0.1)
                                              : posed_anyhow(&c, node, &random));
        csgm_mesh_options options = plain();
        assert_true(is_taken(&c, &options));
        assert_true(fabs(mesh_largest_error(&c)) < 1e-5);
        csgm_mesh_view view = csg_mesh_view(c.mesh);
        assert_int_equal(csg_mesh_inspect(&c.context, &view, 0, &c.check), CSGM_OK);
        assert_true(fabs(c.check.volume - 2 * area) < 1e-4);
        assert_int_equal(c.check.components, 20);
        assert_int_equal(c.check.euler, 0);
        assert_int_equal(c.mesh->colors[0], 255);
        assert_uncrossed(c.mesh, "stars");
        assert_winds_around(&c, &random);
        mesh_case_end(&c);
    }
}

/* Loops that touch leave an edge of four triangles. */
static void test_touching_loops(void **state)
{
    (void)state;
    mesh_case c;
    csg_outline outline;
    mesh_case_begin(&c, 1);
    csg_outline_init(&outline, &c.context.memory);
    add_rectangle(&outline, 0, 0, 1, 1);
    add_rectangle(&outline, 1, 1, 2, 2);
    mesh_case_compile(&c, csg_build_extrude(&c.builder, region_of(&c, &outline), 0, 1, NOWHERE));
    csgm_mesh_options options = plain();
    assert_false(is_taken(&c, &options));
    mesh_case_end(&c);
}

/* ---- options -----------------------------------------------------------------------------------
 */

static void test_options(void **state)
{
    (void)state;
    mesh_case c;
    mesh_case_begin(&c, 1);
    mesh_case_compile(&c, make_ball(&c, csg_vec3_make(0, 0, 0), 1, 10, 0));
    csgm_mesh_options options = plain();
    uint64_t count = own_of(&c, &options);
    assert_true(count > 0);
    options.quality = CSGM_QUALITY_DRAFT;
    assert_int_equal(own_of(&c, &options), count);
    options.bounds = (csg_box){{-2, -2, -2}, {2, 2, 2}}; /* cuts nothing */
    assert_int_equal(own_of(&c, &options), count);
    options.triangles = count;
    assert_int_equal(own_of(&c, &options), count);
    const csgm_mesh_options asked = options;
#define ASSERT_CELLS(member, value)                                                                \
    options = asked;                                                                               \
    options.member = value;                                                                        \
    assert_int_equal(own_of(&c, &options), 0);
    ASSERT_CELLS(triangles, count - 1)
    ASSERT_CELLS(bounds.max.x, 0.5)
    ASSERT_CELLS(resolution, 16)
    ASSERT_CELLS(cell_size, 0.1)
    ASSERT_CELLS(tolerance, 0.1)
    ASSERT_CELLS(simplify_error, 0.1)
    ASSERT_CELLS(simplify_share, 0.5)
    ASSERT_CELLS(improve, true)
    ASSERT_CELLS(certify, true)
    ASSERT_CELLS(features, CSGM_FEATURES_SMOOTH)
#undef ASSERT_CELLS
    mesh_case_end(&c);
}

/* ---- what is no mesh ---------------------------------------------------------------------------
 */

typedef void add_solid(csg_triangles *t);

static void add_cross(csg_triangles *t)
{
    solid_add_ball(t, csg_vec3_make(0, 0, 0), 1, 12, 12, 0);
    solid_add_ball(t, csg_vec3_make(0.5, 0.25, 0), 1, 12, 12, 0);
}
static void add_twice_within(csg_triangles *t)
{
    solid_add_ball(t, csg_vec3_make(0, 0, 0), 1, 12, 12, 0);
    solid_add_ball(t, csg_vec3_make(0, 0, 0), 0.5, 12, 12, 0);
}
static void add_hollow(csg_triangles *t)
{
    solid_add_box(t, csg_vec3_make(-1, -1, -1), csg_vec3_make(1, 1, 1), false);
    solid_add_box(t, csg_vec3_make(-0.5, -0.5, -0.5), csg_vec3_make(0.5, 0.5, 0.5), true);
}
static void add_in_hole(csg_triangles *t)
{
    add_hollow(t);
    solid_add_ball(t, csg_vec3_make(0, 0, 0), 0.25, 12, 12, 0);
}
/* Boxes that share an edge. */
static void add_touching(csg_triangles *t)
{
    solid_add_box(t, csg_vec3_make(0, 0, 0), csg_vec3_make(1, 1, 1), false);
    solid_add_box(t, csg_vec3_make(1, 1, 0), csg_vec3_make(2, 2, 1), false);
}
/* Boxes of which one corner touches a face of the other. */
static void add_leaning(csg_triangles *t)
{
    solid_add_box(t, csg_vec3_make(0, 0, 0), csg_vec3_make(1, 1, 1), false);
    size_t first = t->point_count;
    solid_add_box(t, csg_vec3_make(1, 0.25, 0.25), csg_vec3_make(2, 0.75, 0.75), false);
    for (size_t i = first; i < t->point_count; i++) {
        csg_vec3 p = t->points[i];
        t->points[i].x += 0.5 * (p.y - 0.25) + 0.25 * (p.z - 0.25);
    }
}
/* In floats the shells are one. */
static void add_thin(csg_triangles *t)
{
    solid_add_box(t, csg_vec3_make(10, 10, 10), csg_vec3_make(11, 11, 11), false);
    solid_add_box(t, csg_vec3_make(10 + 1e-7, 10 + 1e-7, 10 + 1e-7),
                  csg_vec3_make(11 - 1e-7, 11 - 1e-7, 11 - 1e-7), true);
}

static void test_soundness(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        add_solid *add;
        bool is_own;
    } rows[] = {
        {"balls that cross", add_cross, false},
        {"a ball in a ball", add_twice_within, false},
        {"a hollow box", add_hollow, true},
        {"a ball in its hole", add_in_hole, true},
        {"boxes at an edge", add_touching, false},
        {"boxes at a corner", add_leaning, false},
        {"a skin that floats cannot hold", add_thin, false},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        mesh_case c;
        csg_triangles triangles;
        mesh_case_begin(&c, 2);
        csg_triangles_init(&triangles, &c.context.memory);
        rows[i].add(&triangles);
        mesh_case_compile(&c, shape_of(&c, &triangles));
        csg_triangles_release(&triangles);
        csgm_mesh_options options = plain();
        if (is_taken(&c, &options) != rows[i].is_own)
            fail_msg("%s: %s", rows[i].name, rows[i].is_own ? "not taken" : "taken");
        if (c.mesh)
            assert_uncrossed(c.mesh, rows[i].name);
        mesh_case_end(&c);
    }
}

/* Blends are none, and what meets has to be joined (csg_booleans). */
static void test_other_scenes(void **state)
{
    (void)state;
    bool can_join = csg_booleans_are_available();
    for (int which = 0; which < 4; which++) {
        mesh_case c;
        mesh_case_begin(&c, 1);
        csg_node_id a = make_ball(&c, csg_vec3_make(0, 0, 0), 1, 8, 0);
        csg_node_id b = which == 0   ? make_ball(&c, csg_vec3_make(1.5, 0, 0), 1, 8, 0)
                        : which == 1 ? moved(&c, make_sphere(&c, 1), 3, 0, 0)
                                     : make_ball(&c, csg_vec3_make(3, 0, 0), 1, 8, 0);
        csg_node_kind kind = which == 2 ? CSG_NODE_DIFFERENCE : CSG_NODE_UNION;
        mesh_case_compile(&c, joined(&c, kind, which == 3 ? ROUND(0.1) : SHARP, a, b));
        csgm_mesh_options options = plain();
        assert_int_equal(is_taken(&c, &options), can_join && (which == 0 || which == 2));
        mesh_case_end(&c);
    }
}

/* ---- random shells -----------------------------------------------------------------------------
 */

static csg_node_id random_shells(mesh_case *c, csg_random *random)
{
    csg_triangles triangles;
    csg_triangles_init(&triangles, &c->context.memory);
    int count = 1 + (int)csg_random_uniform(random, 0, 4);
    for (int i = 0; i < count; i++) {
        csg_vec3 at =
            csg_vec3_make(csg_random_uniform(random, -3, 3), csg_random_uniform(random, -1, 1),
                          csg_random_uniform(random, -1, 1));
        size_t first = triangles.count;
        solid_add_ball(&triangles, at, csg_random_uniform(random, 0.1, 2), 12, 9,
                       csg_random_uniform(random, 0, 0.3));
        for (size_t t = first; i % 2 && t < triangles.count; t++)
            solid_flip(&triangles, t);
    }
    csg_node_id node = shape_of(c, &triangles);
    csg_triangles_release(&triangles);
    csg_affine squeeze = csg_affine_scale(csg_vec3_make(csg_random_uniform(random, 0.5, 2),
                                                        csg_random_uniform(random, 0.001, 2), -1));
    node = csg_build_transform(&c->builder, &squeeze, node, NOWHERE);
    return posed_anyhow(c, node, random);
}

static void test_random_shells(void **state)
{
    (void)state;
    enum { SCENES = 150 };
    int own = 0;
    for (unsigned seed = 0; seed < SCENES; seed++) {
        mesh_case c;
        csg_random random = {seed + 1};
        mesh_case_begin(&c, 2);
        mesh_case_compile(&c, random_shells(&c, &random));
        csgm_mesh_options options = plain();
        if (is_taken(&c, &options)) {
            own++;
            csgm_mesh_view view = csg_mesh_view(c.mesh);
            assert_int_equal(csg_mesh_inspect(&c.context, &view, 0, &c.check), CSGM_OK);
            assert_int_equal(c.check.boundary_edges + c.check.nonmanifold_edges +
                                 c.check.misoriented_edges + c.check.nonmanifold_vertices,
                             0);
            assert_uncrossed(c.mesh, "shells");
            assert_winds_around(&c, &random);
        }
        mesh_case_end(&c);
    }
    assert_in_range(own, SCENES / 5, SCENES * 4 / 5); /* both happen */
}

static csg_node_id one_scene(mesh_case *c)
{
    return make_ball(c, csg_vec3_make(0, 0, 0), 1, 60, 0.2);
}

/* ---- within a tolerance ------------------------------------------------------------------------
 */

static const double SKIN = 0.02, TOLERANCE = 0.05;

/* A ball's skin, much thinner than the tolerance. */
static csg_node_id skin(mesh_case *c)
{
    csg_triangles triangles;
    csg_triangles_init(&triangles, &c->context.memory);
    solid_add_ball(&triangles, csg_vec3_make(0, 0, 0), 2, 48, 24, 0);
    size_t first = triangles.count;
    solid_add_ball(&triangles, csg_vec3_make(0, 0, 0), 2 - SKIN, 48, 24, 0);
    for (size_t t = first; t < triangles.count; t++)
        solid_flip(&triangles, t);
    csg_node_id node = shape_of(c, &triangles);
    csg_triangles_release(&triangles);
    return node;
}

/* Fewer triangles, of which it is proven that they are within the tolerance of the solid's own:
 * both walls keep apart, and no place of them is farther away. */
static void test_thin_walls(void **state)
{
    (void)state;
    enum { PLACES = 1000 };
    mesh_case c;
    csg_triangles own;
    csg_random random = {1};
    mesh_case_begin(&c, 2);
    csg_triangles_init(&own, &c.context.memory);
    mesh_case_compile(&c, skin(&c));
    csgm_mesh_options options = plain();
    options.tolerance = TOLERANCE;
    assert_int_equal(mesh_build(&c, &options), CSGM_OK);
    assert_int_equal(c.stats.open_places, 0);
    assert_true(c.stats.max_distance_bound == TOLERANCE);
    assert_true(c.mesh->triangle_count < c.stats.triangles_before / 2);
    assert_uncrossed(c.mesh, "a thin skin");
    solid_add_ball(&own, csg_vec3_make(0, 0, 0), 2, 48, 24, 0);
    solid_add_ball(&own, csg_vec3_make(0, 0, 0), 2 - SKIN, 48, 24, 0);
    for (int i = 0; i < PLACES; i++) {
        const uint32_t *corners =
            c.mesh->indices +
            3 * (size_t)csg_random_below(&random, (uint32_t)c.mesh->triangle_count);
        double a = csg_random_uniform(&random, 0, 1), b = csg_random_uniform(&random, 0, 1 - a);
        csg_vec3 p = csg_vec3_scale(mesh_vertex(&c, corners[0]), 1 - a - b);
        p = csg_vec3_add(p, csg_vec3_scale(mesh_vertex(&c, corners[1]), a));
        p = csg_vec3_add(p, csg_vec3_scale(mesh_vertex(&c, corners[2]), b));
        assert_true(solid_distance(&own, p) <= TOLERANCE);
    }
    mesh_assert_same_by(&c, skin, &options, 1, CSGM_ISA_SCALAR);
    csg_triangles_release(&own);
    mesh_case_end(&c);
}

static void test_same_bytes(void **state)
{
    (void)state;
    mesh_case c;
    mesh_case_begin(&c, 3);
    mesh_case_compile(&c, one_scene(&c));
    csgm_mesh_options options = plain();
    assert_true(own_of(&c, &options) > 0);
    mesh_assert_same_by(&c, one_scene, &options, 1, CSGM_ISA_AUTO);
    mesh_assert_same_by(&c, one_scene, &options, 2, CSGM_ISA_SCALAR);
    mesh_case_end(&c);
}

/* ---- allocations that fail ----------------------------------------------------------------- */

static csg_node_id small_ball(mesh_case *c)
{
    return make_ball(c, csg_vec3_make(0, 0, 0), 1, 8, 0);
}

static void test_each_allocation(void **state)
{
    (void)state;
    own_fail_each_allocation(small_ball, 0, 1);
    own_fail_each_allocation(small_ball, TOLERANCE, 7);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_vertices),       cmocka_unit_test(test_looks),
        cmocka_unit_test(test_normals),        cmocka_unit_test(test_extrusions),
        cmocka_unit_test(test_touching_loops), cmocka_unit_test(test_options),
        cmocka_unit_test(test_soundness),      cmocka_unit_test(test_other_scenes),
        cmocka_unit_test(test_random_shells),  cmocka_unit_test(test_same_bytes),
        cmocka_unit_test(test_thin_walls),     cmocka_unit_test(test_each_allocation),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
