/* SPDX-License-Identifier: MIT
 * Sharp features of polyhedra: between facets larger than cells each edge is one, between those of
 * a scan none but the sharp ones; whatever machine and pruning.
 */
#include "mesh/own_support.h"

#include "shape/solid_support.h"

/* A ball whose facets turn by 3.3 degrees around its axis. */
static uint64_t features_of_ball(uint32_t resolution)
{
    mesh_case c;
    mesh_case_begin(&c, 2);
    mesh_case_compile(&c, make_ball(&c, csg_vec3_make(0, 0, 0), 1, 110, 0));
    csgm_mesh_options options = mesh_options(resolution);
    mesh_build_closed(&c, &options, "a ball of facets");
    uint64_t found = c.stats.feature_vertices;
    mesh_case_end(&c);
    return found;
}

static void test_facets_of_a_scan(void **state)
{
    assert_int_equal(features_of_ball(64), 0); /* 1.8 cells wide */
    assert_true(features_of_ball(128) > 1000); /* 3.6 */
}

/* A box with fine facets, whose top is a vault of 40 strips, 1.6 cells wide, that turn by 4
 * degrees.
 */
static csg_node_id make_vault(mesh_case *c)
{
    csg_triangles t;
    csg_triangles_init(&t, &c->context.memory);
    solid_add_fine_box(&t, csg_vec3_make(-1, -1, -1), csg_vec3_make(1, 1, 1), 40);
    for (size_t i = 0; i < t.point_count; i++)
        if (t.points[i].z > 0.99)
            t.points[i].z = 1 - 0.7 * t.points[i].x * t.points[i].x;
    csg_node_id node = shape_of(c, &t);
    csg_triangles_release(&t);
    return node;
}

/* The edges of the box are some 670 cells long, those between strips 2000. */
static void test_sharp_edges_of_a_scan(void **state)
{
    mesh_case c;
    mesh_case_begin(&c, 2);
    mesh_case_compile(&c, make_vault(&c));
    csgm_mesh_options options = mesh_options(64);
    mesh_build_closed(&c, &options, "a vault");
    assert_true(c.stats.feature_vertices > 600 && c.stats.feature_vertices < 1000);
    mesh_case_end(&c);
}

static csg_node_id make_vault_and_ball(mesh_case *c)
{
    csg_node_id parts[2] = {make_vault(c),
                            make_ball(c, csg_vec3_make(0.9, 0.5, 0.3), 0.8, 90, 0.02)};
    return csg_build_operator(&c->builder, CSG_NODE_UNION, CSG_SHARP, parts, 2, csg_span_nowhere());
}

static void test_whatever_machine_and_pruning(void **state)
{
    mesh_case c;
    csgm_mesh_options options = mesh_options(64);
    mesh_case_begin(&c, 2);
    mesh_case_compile(&c, make_vault_and_ball(&c));
    mesh_build_closed(&c, &options, "a vault and a ball");
    assert_true(c.stats.feature_vertices > 500);
    mesh_assert_same_by(&c, make_vault_and_ball, &options, 1, CSGM_ISA_SCALAR);
    options.prune = false;
    mesh_assert_same_by(&c, make_vault_and_ball, &options, 3, CSGM_ISA_AUTO);
    mesh_case_end(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_facets_of_a_scan),
        cmocka_unit_test(test_sharp_edges_of_a_scan),
        cmocka_unit_test(test_whatever_machine_and_pruning),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
