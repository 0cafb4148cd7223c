/* SPDX-License-Identifier: MIT
 * Thinning out in cubes of space: meshes of so many triangles that there are several cubes, the
 * same for any number of threads, closed, and without crossings as CGAL finds them; flat faces come
 * down to the triangles that they need; goals without a proof, and of a number of triangles.
 *
 * test_thinning [SCENES [FIRST]]: so many random scenes.
 */
#include "mesh/mesh_support.h"
#include "mesh/pipeline/build.h"
#include "mesh/uncrossed.h"
#include "rounds.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static unsigned scene_count = 4, first_scene = 0;

static csgm_mesh_options thinned(uint32_t resolution, double error)
{
    csgm_mesh_options options = mesh_options(resolution);
    options.simplify_error = error;
    return options;
}

/* ---- flat faces --------------------------------------------------------------------------------
 */

static void test_boxes(void **state)
{
    /* a cube, a plate, a sheet that is thinner than the error, a needle */
    static const double halves[4][3] = {
        {1, 1, 1}, {1, 0.7, 0.05}, {1, 0.8, 0.012}, {1, 0.04, 0.03}};
    for (int i = 0; i < 4; i++)
        for (int turn = 0; turn < 2; turn++) {
            mesh_case c;
            mesh_case_begin(&c, 2);
            const double *h = halves[i];
            csg_node_id box = make_box(&c, h[0], h[1], h[2]);
            mesh_case_compile(&c, turn ? turned(&c, box, 25, csg_vec3_make(0.8, 0.6, 0)) : box);
            csgm_mesh_options options = thinned(i == 2 ? 96 : 64, 0.02);
            mesh_build_closed(&c, &options, "box");
            assert_true(c.stats.triangles_before > 1000);
            assert_in_range(c.mesh->triangle_count, 12, i == 2 ? 100 : 12);
            double volume = 8 * h[0] * h[1] * h[2];
            /* the turned sheet may lose of its rim what the error allows */
            assert_true(fabs(c.check.volume - volume) < (i == 2 ? 0.1 : 1e-3) * volume);
            assert_true(c.stats.max_distance_measured <= (i == 2 ? 0.02 : 0.002));
            assert_uncrossed(c.mesh, "box");
            mesh_case_end(&c);
        }
}

/* Caps are polygons of the rim's vertices, and nothing stands on them. */
static void test_cylinder(void **state)
{
    mesh_case c;
    mesh_case_begin(&c, 2);
    mesh_case_compile(&c, make_cylinder(&c, 1, 0.6));
    csgm_mesh_options options = thinned(64, 0.01);
    mesh_build_closed(&c, &options, "cylinder");
    for (uint64_t v = 0; v < c.mesh->vertex_count; v++) {
        csg_vec3 p = mesh_vertex(&c, v);
        assert_true(fabs(fabs(p.z) - 0.6) > 1e-4 || hypot(p.x, p.y) > 0.98);
    }
    assert_true(c.mesh->triangle_count < 250);
    assert_uncrossed(c.mesh, "cylinder");
    mesh_case_end(&c);
}

/* ---- cubes and threads -------------------------------------------------------------------------
 */

static csg_node_id many_sided(mesh_case *c)
{
    csg_node_id ball = moved(c, make_sphere(c, 0.8), 0.1, 0.2, 0.35);
    csg_node_id base = joined(c, CSG_NODE_UNION, ROUND(0.2), make_box(c, 1, 0.9, 0.4), ball);
    csg_node_id hole = turned(c, make_cylinder(c, 0.3, 3), 40, csg_vec3_make(0.6, 0.8, 0));
    return joined(c, CSG_NODE_DIFFERENCE, SHARP, base, hole);
}

static void test_same_for_all_threads(void **state)
{
    static const uint32_t threads[] = {3, 7, 2};
    mesh_case a;
    mesh_case_begin(&a, 1);
    mesh_case_compile(&a, many_sided(&a));
    csgm_mesh_options options = thinned(100, 0.004);
    mesh_build_closed(&a, &options, "one thread");
    assert_true(a.stats.triangles_before > 30000); /* several cubes */
    assert_true(a.mesh->triangle_count < a.stats.triangles_before / 10);
    assert_uncrossed(a.mesh, "one thread");
    for (int i = 0; i < ROUNDS(3); i++)
        mesh_assert_same_by(&a, many_sided, &options, threads[i], CSGM_ISA_AUTO);
    mesh_case_end(&a);
}

/* ---- how near ----------------------------------------------------------------------------------
 */

/* Vertices are known to be near, samples of the surface are near the mesh: so should the triangles
 * be between, at random places. */
static void assert_near(const mesh_case *c, double error)
{
    enum { PLACES = 4 };
    csg_random random = {77};
    size_t beyond = 0;
    double most = 0;
    for (uint64_t t = 0; t < c->mesh->triangle_count; t++)
        for (int i = 0; i < PLACES; i++) {
            double a = csg_random_uniform(&random, 0, 1), b = csg_random_uniform(&random, 0, 1 - a);
            csg_vec3 p = {0, 0, 0};
            for (int k = 0; k < 3; k++) {
                csg_vec3 v = mesh_vertex(c, c->mesh->indices[3 * t + (uint64_t)k]);
                p = csg_vec3_add(p, csg_vec3_scale(v, k == 0 ? a : k == 1 ? b : 1 - a - b));
            }
            float x = (float)p.x, y = (float)p.y, z = (float)p.z, f;
            csg_field_eval(c->field, &x, &y, &z, &f, 1);
            beyond += fabs((double)f) > error;
            most = fmax(most, fabs((double)f));
        }
    assert_true(beyond * 500 <= PLACES * c->mesh->triangle_count);
    assert_true(most <= 1.3 * error);
}

static void test_near_surface(void **state)
{
    for (int i = 0; i < 3; i++) {
        mesh_case c;
        mesh_case_begin(&c, 2);
        /* blends; an edge that turns slowly; faces that meet at angles that are hardly a crease */
        csg_node_id node = many_sided(&c);
        if (i == 1)
            node = joined(&c, CSG_NODE_INTERSECTION, SHARP, make_cylinder(&c, 1, 0.3),
                          turned(&c, make_box(&c, 0.95, 2, 0.28), 3, csg_vec3_make(0, 1, 0)));
        if (i == 2)
            node = joined(&c, CSG_NODE_INTERSECTION, SHARP, make_box(&c, 1, 0.9, 0.4),
                          moved(&c, make_sphere(&c, 3), 0.1, 0.2, -2.62));
        mesh_case_compile(&c, node);
        csgm_mesh_options options = thinned(100, 0.004);
        mesh_build_closed(&c, &options, "near");
        assert_near(&c, 0.004);
        mesh_case_end(&c);
    }
}

static void test_random_scenes(void **state)
{
    for (unsigned seed = first_scene; seed < first_scene + scene_count; seed++) {
        mesh_case c;
        char what[32];
        csg_random random = {4000 + seed};
        snprintf(what, sizeof what, "scene %u", seed);
        mesh_case_begin(&c, 2);
        mesh_case_compile(&c, test_random_scene(&c.builder, &random, 1 + seed * 5 % 13));
        if (csg_box_is_finite(c.field->bounds)) {
            csgm_mesh_options options = thinned(64, 0.02);
            mesh_build_closed(&c, &options, what);
            assert_uncrossed(c.mesh, what);
        }
        mesh_case_end(&c);
    }
}

/* ---- goals -------------------------------------------------------------------------------------
 */

static void reach(mesh_case *c, csg_mesh_goal *goal)
{
    csgm_mesh_options options = mesh_options(64);
    csgm_mesh *mesh;
    options.normals = CSGM_NORMALS_NONE;
    csg_mesh_share share = {.amount = 1};
    assert_int_equal(
        csg_mesh_build_field(&c->context, c->field, &options, &share, goal, &mesh, &c->stats),
        CSGM_OK);
    csg_mesh_destroy(c->mesh);
    c->mesh = mesh;
    csgm_mesh_view view = csg_mesh_view(mesh);
    assert_int_equal(csg_mesh_inspect(&c->context, &view, 0, &c->check), CSGM_OK);
    assert_true(!c->check.boundary_edges && !c->check.nonmanifold_edges &&
                !c->check.nonmanifold_vertices && !c->check.misoriented_edges);
    assert_uncrossed(mesh, "goal");
}

static void test_goals(void **state)
{
    mesh_case c;
    mesh_case_begin(&c, 2);
    mesh_case_compile(&c, many_sided(&c));
    csg_mesh_goal sampled = {.error = 0.01, .care = 1, .is_last = true};
    reach(&c, &sampled);
    assert_true(c.mesh->triangle_count < 4000);
    assert_true(sampled.measured > 0 && sampled.measured <= 0.01);
    assert_true(sampled.bound == INFINITY && sampled.open == 0); /* nothing is proven */
    csg_mesh_goal counted = {.triangles = 500, .care = 1, .is_last = true};
    reach(&c, &counted);
    assert_true(c.mesh->triangle_count <= 501 && c.mesh->triangle_count >= 498);
    assert_true(counted.measured > 0 && counted.measured <= counted.allowed);
    assert_false(counted.tight);
    mesh_case_end(&c);
}

int main(int argc, char **argv)
{
    if (argc > 1)
        scene_count = (unsigned)atoi(argv[1]);
    if (argc > 2)
        first_scene = (unsigned)atoi(argv[2]);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_boxes),
        cmocka_unit_test(test_cylinder),
        cmocka_unit_test(test_same_for_all_threads),
        cmocka_unit_test(test_near_surface),
        cmocka_unit_test(test_random_scenes),
        cmocka_unit_test(test_goals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
