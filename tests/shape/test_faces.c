/* SPDX-License-Identifier: MIT
 * Where a polyhedron creases: edges of boxes, blunt edges of balls by how narrow their facets are,
 * and the law that gradients keep where nothing is said to crease.
 */
#include "shape/solid_support.h"

#include <string.h>

/* As the search for features asks: 3 degrees, 12, and 23. */
static const double LEAST = 1.37e-3, BLUNT = 0.0219, MOST_TURN = 0.08;

static bool may_crease(const solid_case *c, csg_vec3 at, double radius, double narrow)
{
    const csg_shape_crease crease = {LEAST, BLUNT, narrow, MOST_TURN};
    csg_shape_balls ball = {.center = {at}, .count = 1, .radius = {radius}};
    csg_shape_creases(c->shape, &crease, &ball);
    return ball.may_crease[0];
}

static void test_box(void **state)
{
    solid_case c;
    solid_begin(&c);
    solid_add_fine_box(&c.triangles, csg_vec3_make(-1, -1, -1), csg_vec3_make(1, 1, 1), 8);
    solid_make(&c);
    for (int narrow = 0; narrow < 2; narrow++) {
        assert_false(may_crease(&c, csg_vec3_make(0.1, 0.2, 1), 0.5, narrow));
        assert_false(may_crease(&c, csg_vec3_make(0.1, 0.6, 1.05), 0.39, narrow));
        assert_true(may_crease(&c, csg_vec3_make(0.1, 0.62, 1), 0.39, narrow));
        assert_true(may_crease(&c, csg_vec3_make(1.1, 1.1, 0.3), 0.2, narrow));
    }
    solid_end(&c);
}

/* 6 degrees from facet to facet, which are 0.1 wide. */
static void test_blunt_edges(void **state)
{
    solid_case c;
    solid_begin(&c);
    solid_add_ball(&c.triangles, csg_vec3_make(0, 0, 0), 1, 60, 31, 0);
    solid_make(&c);
    const csg_vec3 at = csg_vec3_make(0.6, 0.8, 0.03);
    assert_true(may_crease(&c, at, 0.12, 0));
    assert_true(may_crease(&c, at, 0.12, 0.08));
    assert_false(may_crease(&c, at, 0.12, 0.15));
    assert_true(may_crease(&c, at, 0.4, 0.15)); /* it turns too far */
    solid_end(&c);
}

/* The same, but two and a half times as long as they are apart. */
static void test_long_blunt_edges(void **state)
{
    solid_case c;
    solid_begin(&c);
    solid_add_ball(&c.triangles, csg_vec3_make(0, 0, 0), 1, 60, 12, 0);
    solid_make(&c);
    assert_true(may_crease(&c, csg_vec3_make(0.6, 0.79, 0.13), 0.08, 0.15));
    assert_false(may_crease(&c, csg_vec3_make(0.6, 0.79, 0.13), 0.08, 0.2));
    solid_end(&c);
}

/* A roof of 8 degrees, in strips 0.1 wide: nothing turns beside its ridge. */
static void test_ridge(void **state)
{
    enum { STRIPS = 20 };
    solid_case c;
    solid_begin(&c);
    csg_triangles *t = &c.triangles;
    solid_add_fine_box(t, csg_vec3_make(-1, -1, -1), csg_vec3_make(1, 1, 0), STRIPS);
    for (size_t i = 0; i < t->point_count; i++)
        if (t->points[i].z > -0.01)
            t->points[i].z = 0.07 * (1 - fabs(t->points[i].x));
    solid_make(&c);
    assert_true(may_crease(&c, csg_vec3_make(0, 0.03, 0.07), 0.12, 0.15));
    assert_false(may_crease(&c, csg_vec3_make(0.5, 0.03, 0.035), 0.12, 0.15));
    solid_end(&c);
}

/* A place in the ball from which the nearest place of the surface is in it too. */
static bool find_gradient(const solid_case *c, csg_random *random, csg_vec3 center, double radius,
                          csg_vec3 *gradient)
{
    csg_vec3 way = solid_random_point(random, radius);
    double f = csg_shape_sample(c->shape, csg_vec3_add(center, way), gradient);
    return csg_vec3_norm(way) + fabs(f) < radius;
}

static void test_gradients_where_nothing_creases(void **state)
{
    static const double RADIUS = 0.15;
    csg_random random = {7};
    solid_case c;
    int smooth = 0, asked = 0;
    solid_begin(&c);
    solid_add_ball(&c.triangles, csg_vec3_make(0, 0, 0), 1, 90, 46, 0.05);
    solid_make(&c);
    for (int i = 0; i < 400; i++) {
        csg_vec3 at = csg_vec3_normalize(solid_random_point(&random, 1)), g[20];
        int count = 0;
        if (may_crease(&c, at, RADIUS, 0.2))
            continue;
        smooth++;
        for (int k = 0; k < 20; k++)
            count += find_gradient(&c, &random, at, RADIUS, &g[count]);
        for (int k = 1; k < count; k++, asked++)
            assert_true(1 - csg_vec3_dot(g[0], g[k]) <= MOST_TURN + 1e-9);
    }
    assert_true(smooth > 20 && smooth < 380);
    assert_true(asked > 100);
    solid_end(&c);
}

/* Balls are told apart alike, one by one or together. */
static void test_together(void **state)
{
    const csg_shape_crease crease = {LEAST, BLUNT, 0.1, MOST_TURN};
    csg_random random = {3};
    csg_shape_balls balls = {.count = CSG_SHAPE_MOST_BALLS};
    solid_case c;
    int creased = 0;
    solid_begin(&c);
    solid_add_fine_box(&c.triangles, csg_vec3_make(-1, -1, -1), csg_vec3_make(1, 1, 1), 32);
    solid_make(&c);
    for (size_t i = 0; i < balls.count; i++) {
        csg_vec3 p = solid_random_point(&random, 1);
        balls.center[i] = csg_vec3_make(1, p.y, p.z);
        balls.radius[i] = i % 2 ? 0.2 : 0.3;
    }
    csg_shape_creases(c.shape, &crease, &balls);
    for (size_t i = 0; i < balls.count; i++) {
        creased += balls.may_crease[i];
        assert_int_equal(balls.may_crease[i],
                         may_crease(&c, balls.center[i], balls.radius[i], crease.narrow));
    }
    assert_true(creased > 5 && creased < 60);
    balls.fewest = 1000000; /* there are fewer facets than that */
    csg_shape_creases(c.shape, &crease, &balls);
    for (size_t i = 0; i < balls.count; i++)
        assert_true(balls.may_crease[i]);
    solid_end(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_box),
        cmocka_unit_test(test_blunt_edges),
        cmocka_unit_test(test_long_blunt_edges),
        cmocka_unit_test(test_ridge),
        cmocka_unit_test(test_gradients_where_nothing_creases),
        cmocka_unit_test(test_together),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
