/* SPDX-License-Identifier: MIT
 * The corner table: random collapses and flips keep a closed oriented manifold of the same genus,
 * and what is no manifold is refused. What a change would cross is found.
 */
#include <stdlib.h>
#include <string.h>

#include "mesh/mesh_support.h"
#include "mesh/remesh/crossing.h"
#include "scene/primitives/kinds.h"

static void inspect(mesh_case *c, const csg_corners *m, csgm_mesh_check *check)
{
    uint32_t *indices = malloc(3 * (size_t)m->live * sizeof *indices);
    size_t n = 0;
    assert_non_null(indices);
    for (uint32_t t = 0; t < m->triangle_count; t++)
        if (csg_corners_is_live(m, t))
            for (uint32_t k = 0; k < 3; k++)
                indices[n++] = m->vertex[3 * t + k];
    csgm_mesh_view view = csg_mesh_view(c->mesh);
    view.indices = indices;
    view.triangle_count = m->live;
    assert_int_equal(n, 3 * (size_t)m->live);
    assert_int_equal(csg_mesh_inspect(&c->context, &view, 0, check), CSGM_OK);
    free(indices);
}

static void assert_sound(mesh_case *c, const csg_corners *m, int64_t euler)
{
    csgm_mesh_check check;
    inspect(c, m, &check);
    assert_int_equal(check.boundary_edges + check.nonmanifold_edges + check.misoriented_edges, 0);
    assert_int_equal(check.nonmanifold_vertices + check.degenerate_triangles, 0);
    assert_int_equal(check.euler, euler);
    for (uint32_t i = 0; i < 3 * m->triangle_count; i++)
        if (csg_corners_is_live(m, i / 3))
            assert_int_equal(m->across[m->across[i]], i);
}

static void test_random_changes(void **state)
{
    for (unsigned seed = 0; seed < 20; seed++) {
        mesh_case c;
        csg_random random = {seed};
        mesh_case_begin(&c, 1);
        csg_node_id ring =
            csg_build_primitive(&c.builder, CSG_NODE_TORUS, (double[]){1, 0.3, 180}, NOWHERE);
        mesh_case_compile(&c, ring);
        csgm_mesh_options options = mesh_options(14);
        mesh_build_closed(&c, &options, "torus");
        csg_corners m;
        assert_int_equal(csg_corners_make(&m, &c.context.memory, c.mesh->indices,
                                          c.mesh->triangle_count, c.mesh->vertex_count),
                         CSG_CORNERS_MADE);
        unsigned collapses = 0, flips = 0;
        for (int i = 0; i < 20000; i++) {
            uint32_t corner = csg_random_below(&random, 3 * m.triangle_count);
            if (!csg_corners_is_live(&m, corner / 3))
                continue;
            if (csg_random_below(&random, 3) && csg_corners_can_flip(&m, corner)) {
                csg_corners_flip(&m, corner);
                flips++;
            } else if (csg_corners_can_collapse(&m, corner)) {
                csg_corners_collapse(&m, corner);
                collapses++;
            }
            if (i % 997 == 0)
                assert_sound(&c, &m, 0);
        }
        assert_sound(&c, &m, 0);
        assert_true(collapses > 50 && flips > 500);
        assert_true(m.live >= 14); /* the least torus has 7 vertices */
        csg_corners_release(&m);
        mesh_case_end(&c);
    }
}

static void test_refused(void **state)
{
    static const uint32_t open[] = {0, 1, 2}, twice[] = {0, 1, 2, 0, 1, 2},
                          index[] = {0, 1, 9, 0, 9, 1};
    static const uint32_t two_fans[] = {0, 1, 2, 0, 3, 1, 0, 2, 3, 1, 3, 2,
                                        0, 4, 5, 0, 6, 4, 0, 5, 6, 4, 6, 5};
    static const uint32_t tetrahedron[] = {0, 1, 2, 0, 3, 1, 0, 2, 3, 1, 3, 2};
    csgm_context context;
    csg_corners m;
    test_context_init(&context);
    assert_int_equal(csg_corners_make(&m, &context.memory, open, 1, 3), CSG_CORNERS_NOT_CLOSED);
    assert_int_equal(csg_corners_make(&m, &context.memory, twice, 2, 3), CSG_CORNERS_NOT_CLOSED);
    assert_int_equal(csg_corners_make(&m, &context.memory, index, 2, 3), CSG_CORNERS_NOT_CLOSED);
    assert_int_equal(csg_corners_make(&m, &context.memory, two_fans, 8, 7), CSG_CORNERS_NOT_CLOSED);
    assert_int_equal(csg_corners_make(&m, &context.memory, tetrahedron, 4, 4), CSG_CORNERS_MADE);
    for (uint32_t c = 0; c < 12; c++) {
        assert_false(csg_corners_can_collapse(&m, c));
        assert_false(csg_corners_can_flip(&m, c));
    }
    csg_corners_release(&m);
    test_context_end(&context);
}

/* A pyramid over a square that is cut from corner 1 to corner 2. What has the other diagonal for a
 * side, below it, shares a corner with either half and lies in both along that side. */
static void test_other_diagonal(void **state)
{
    static const uint32_t pyramid[] = {0, 1, 2, 2, 1, 3, 1, 0, 4, 3, 1, 4, 2, 3, 4, 0, 2, 4};
    static const csg_vec3 at[] = {{0, 0, 0}, {2, -1, 0}, {2, 1, 0}, {4, 0, 0}, {2, 0, 1}};
    static const csg_vec3 below = {2, 0, -1}, beside[] = {{-2, 1, 0}, {-2, -1, 0}};
    const csg_vec3 new[][3] = {
        {at[0], at[3], below}, {at[1], at[2], below}, {at[0], beside[0], beside[1]}};
    static const uint32_t ids[][3] = {{0, 3, 5}, {1, 2, 5}, {0, 6, 7}};
    csgm_context context;
    csg_corners m;
    csg_triangle_tree tree = {.noise = csg_triangle_tree_noise(4)};
    test_context_init(&context);
    assert_int_equal(csg_corners_make(&m, &context.memory, pyramid, 6, 5), CSG_CORNERS_MADE);
    assert_true(csg_triangle_tree_make(&tree, &m, at));
    for (int i = 0; i < 3; i++) {
        csg_crossing_change change = {.at = &new[i],
                                      .vertex = &ids[i],
                                      .count = 1,
                                      .vertices = {CSG_CORNER_NONE, CSG_CORNER_NONE},
                                      .triangles = {CSG_CORNER_NONE, CSG_CORNER_NONE}};
        assert_int_equal(csg_crossing_is_made(&tree, &change, NULL), i == 0);
    }
    csg_triangle_tree_release(&tree);
    csg_corners_release(&m);
    test_context_end(&context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_random_changes),
        cmocka_unit_test(test_refused),
        cmocka_unit_test(test_other_diagonal),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
