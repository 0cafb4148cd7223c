/* SPDX-License-Identifier: MIT
 * The nearest triangle of a tree: the least of all of them, and the same one wherever the search
 * begins; for points beside, within and far from small, large and thin meshes.
 */
#include "shape/polyhedra/tree.h"
#include "shape/solid_support.h"

static csg_vec3 on_lattice(csg_vec3 p)
{
    return csg_vec3_make(csg_triangle_frame_round(p.x), csg_triangle_frame_round(p.y),
                         csg_triangle_frame_round(p.z));
}

static double squared_to(const csg_tree *tree, uint32_t place, csg_vec3 p)
{
    bool in_face;
    csg_vec3 away = csg_vec3_sub(p, csg_triangle_foot(&tree->triangles[place], p, &in_face));
    return csg_vec3_dot(away, away);
}

static void check(const csg_tree *tree, csg_vec3 p, csg_random *random)
{
    csg_triangle_hit found = csg_tree_nearest(tree, p, 0);
    /* the foot is rounded as p is */
    double error = 1e-14 * (1 + csg_vec3_norm(p)) * sqrt(found.squared) + 1e-10 * found.squared;
    assert_true(fabs(squared_to(tree, found.place, p) - found.squared) <= error);
    for (uint32_t place = 0; place < tree->count; place++)
        assert_true(squared_to(tree, place, p) >= found.squared - error);
    for (int i = 0; i < 3; i++) {
        uint32_t hint = csg_random_below(random, (uint32_t)tree->count);
        csg_triangle_hit again = csg_tree_nearest(tree, p, hint);
        assert_true(again.squared == found.squared && again.place == found.place);
    }
}

static csg_vec3 random_direction(csg_random *random)
{
    return csg_vec3_normalize(solid_random_point(random, 1));
}

/* A mesh of this size about a centre that is within the frame. */
static void check_mesh(csg_random *random, double size, uint32_t columns, uint32_t rows)
{
    solid_case c;
    csg_tree tree;
    csg_arena scratch;
    solid_begin(&c);
    csg_vec3 center = solid_random_point(random, 1 - size);
    solid_add_ball(&c.triangles, center, size / 2, columns, rows,
                   csg_random_below(random, 2) ? 0.5 : 0);
    for (size_t i = 0; i < c.triangles.point_count; i++)
        c.triangles.points[i] = on_lattice(c.triangles.points[i]);
    csg_arena_init(&scratch, &c.memory);
    assert_true(csg_tree_make(&c.memory, &scratch, &c.triangles, &tree));
    csg_arena_reset(&scratch);
    for (int i = 0; i < 60; i++) {
        double away = i % 3 == 0   ? size * csg_random_uniform(random, 0, 2)
                      : i % 3 == 1 ? csg_random_uniform(random, 0, 2)
                                   : csg_random_uniform(random, 1, 2) * ldexp(1, 3 * (i / 3 % 9));
        check(&tree, csg_vec3_add(center, csg_vec3_scale(random_direction(random), away)), random);
    }
    csg_tree_release(&tree);
    csg_triangles_release(&c.triangles);
    assert_int_equal(c.memory.used_bytes, 0);
}

static void test_nearest(void **state)
{
    csg_random random = {1};
    for (int round = 0; round < 12; round++)
        for (int size = 0; size < 4; size++)
            check_mesh(&random, ldexp(0.9, -4 * size), 3 + csg_random_below(&random, 30),
                       3 + csg_random_below(&random, 20));
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_nearest)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
