/* SPDX-License-Identifier: MIT
 * Convex hulls and triangles of outlines made by hand and at random: with holes, islands in them,
 * holes that touch, corners on straight edges; every allocation failing once.
 */
#include "outline_fixture.h"

#include <stdlib.h>
#include <time.h>

#include "base/orient.h"
#include "shape/plane/delaunay.h"
#include "shape/plane/polygons.h"

static void add_loop(const double (*points)[2], int count)
{
    for (int i = 0; i < count; i++)
        assert_true(csg_outline_add(&outline, (csg_vec2){points[i][0], points[i][1]}));
    assert_true(csg_outline_close(&outline));
}
#define ADD_LOOP(...)                                                                              \
    do {                                                                                           \
        const double points[][2] = {__VA_ARGS__};                                                  \
        add_loop(points, sizeof points / sizeof *points);                                          \
    } while (0)

/* The smallest sine of an angle between two edges at a corner of counter-clockwise triangles. */
static double thinnest(const uint32_t *indices, size_t count)
{
    double least = 1;
    for (size_t i = 0; i < count; i++) {
        const uint32_t *t = indices + i / 3 * 3;
        csg_vec2 p = outline.points[indices[i]], a = outline.points[t[(i + 1) % 3]],
                 b = outline.points[t[(i + 2) % 3]];
        double ax = a.x - p.x, ay = a.y - p.y, bx = b.x - p.x, by = b.y - p.y;
        least = fmin(least, (ax * by - ay * bx) / (hypot(ax, ay) * hypot(bx, by)));
    }
    return least;
}

/* Also as fat ones as can be, of the same edges. */
static size_t triangulate(double slack)
{
    uint32_t *indices;
    size_t count;
    assert_int_equal(csg_polygons_triangulate(&outline, &memory, &indices, &count), CSGM_OK);
    check_triangles(&outline, indices, count, slack);
    double before = thinnest(indices, count);
    assert_true(csg_delaunay_improve(&outline, &memory, indices, count));
    check_triangles(&outline, indices, count, slack);
    assert_true(thinnest(indices, count) >= before - 1e-9);
    csg_memory_release(&memory, indices, count * sizeof *indices);
    return count / 3;
}

/* ---- hull --------------------------------------------------------------------------------- */

static void hulls_hold_all_points(void **state)
{
    csg_random random = {4};
    for (int round = 0; round < 100; round++) {
        csg_outline hull;
        csg_outline_release(&outline);
        for (int loops = 1 + round % 3; loops > 0; loops--)
            add_scribble(&outline, &random, 3, 3 + (int)csg_random_below(&random, 60));
        for (size_t i = 0; round % 2 && i < outline.point_count; i++) { /* many on one line */
            outline.points[i].x = nearbyint(outline.points[i].x);
            outline.points[i].y = nearbyint(outline.points[i].y);
        }
        assert_int_equal(csg_polygons_hull(&outline, &hull), CSGM_OK);
        if (hull.loop_count) {
            for (size_t i = 0; i < hull.point_count; i++) {
                csg_vec2 a = hull.points[i], b = hull.points[(i + 1) % hull.point_count];
                for (size_t j = 0; j < outline.point_count; j++)
                    assert_true(csg_orient_plane(a, b, outline.points[j]) >= 0);
                assert_int_equal(csg_orient_plane(a, b, hull.points[(i + 2) % hull.point_count]),
                                 1);
            }
        }
        assert_true(hull.loop_count || round % 2);
        csg_outline_release(&hull);
    }
}

static void hulls_of_lines_are_empty(void **state)
{
    csg_outline hull;
    assert_int_equal(csg_polygons_hull(&outline, &hull), CSGM_OK);
    assert_int_equal(hull.loop_count, 0);
    ADD_LOOP({0, 0}, {1, 1}, {3, 3}, {2, 2}, {0, 0}, {3, 3});
    assert_int_equal(csg_polygons_hull(&outline, &hull), CSGM_OK);
    assert_int_equal(hull.loop_count, 0);
    assert_int_equal(hull.point_count, 0);
    csg_outline_release(&hull);
    outline.points[1].x = NAN;
    assert_int_equal(csg_polygons_hull(&outline, &hull), CSGM_ERR_SCENE);
}

/* ---- triangles ---------------------------------------------------------------------------- */

static void nothing_has_no_triangles(void **state)
{
    assert_int_equal(triangulate(0), 0);
}

static void holes_and_islands(void **state)
{
    add_rectangle(&outline, 0, 0, 10, 10);
    assert_int_equal(triangulate(0), 2);
    ADD_LOOP({1, 1}, {1, 9}, {9, 9}, {9, 1});
    assert_int_equal(triangulate(0), 8);
    add_rectangle(&outline, 2, 2, 8, 8); /* an island */
    ADD_LOOP({3, 3}, {3, 4}, {4, 4}, {4, 3});
    ADD_LOOP({5, 5}, {5, 7}, {7, 6});
    ADD_LOOP({5, 3}, {5, 4}, {7, 4}, {7, 3});
    assert_int_equal(triangulate(0), 8 + 2 + 4 + 4 + 3 + 2 * 3);
}

/* A strip of corners on two lines: each is joined to those across from it. */
static void triangles_become_fat(void **state)
{
    enum { COUNT = 200 };
    uint32_t *indices;
    size_t count;
    for (int i = 0; i < COUNT; i++)
        assert_true(csg_outline_add(&outline, (csg_vec2){i, 0.001 * i * (i - COUNT)}));
    for (int i = COUNT; i-- > 0;)
        assert_true(csg_outline_add(&outline, (csg_vec2){i, 1 + 0.001 * i * (i - COUNT)}));
    assert_true(csg_outline_close(&outline));
    assert_int_equal(csg_polygons_triangulate(&outline, &memory, &indices, &count), CSGM_OK);
    assert_true(csg_delaunay_improve(&outline, &memory, indices, count));
    check_triangles(&outline, indices, count, 0);
    assert_true(thinnest(indices, count) > 0.5);
    csg_memory_release(&memory, indices, count * sizeof *indices);
}

static void straight_corners_stay(void **state)
{
    ADD_LOOP({0, 0}, {1, 0}, {2, 0}, {3, 0}, {3, 1}, {3, 2}, {2, 2}, {0, 2}, {0, 1});
    ADD_LOOP({1, 0.5}, {1, 1}, {1, 1.5}, {2, 1.5}, {2, 1}, {2, 0.5});
    assert_int_equal(triangulate(0), 15);
}

/* The ray to the left from the hole's leftmost corner meets an edge at its end; on the same line to
 * the right of that corner there are others, nearer, but behind the hole. */
static void a_hole_between_corners_of_its_height(void **state)
{
    ADD_LOOP({0, 7}, {2, 7}, {2, 6}, {1, 6}, {1, 3}, {0, 3}, {0, 0}, {5, 0}, {5, 1}, {8, 1}, {8, 3},
             {13, 3}, {13, 4}, {8, 4}, {8, 7}, {10, 7}, {10, 9}, {5, 9}, {5, 11}, {4, 11}, {4, 7},
             {3, 7}, {3, 9}, {0, 9});
    ADD_LOOP({6, 2}, {6, 3}, {5, 3}, {5, 4}, {7, 4}, {7, 2});
    assert_int_equal(triangulate(0), 30);
}

static void loops_that_touch(void **state)
{
    /* a hole whose leftmost corner is a corner of the ring, one that touches an edge, one that
       touches another hole */
    ADD_LOOP({0, 0}, {8, 0}, {8, 8}, {0, 8}, {0, 4});
    ADD_LOOP({0, 4}, {2, 5}, {2, 3});
    ADD_LOOP({3, 0}, {4, 2}, {5, 1});
    ADD_LOOP({4, 2}, {3, 6}, {5, 6});
    assert_int_equal(triangulate(0), 14); /* of 8 + 6 corners and a cut; one is flat */
    csg_outline_release(&outline);
    /* two squares that touch at a corner, as one loop and as two */
    ADD_LOOP({0, 0}, {2, 0}, {2, 2}, {4, 2}, {4, 4}, {2, 4}, {2, 2}, {0, 2});
    add_rectangle(&outline, 4, 4, 6, 6);
    assert_int_equal(triangulate(0), 6);
}

/* Star-shaped loops in each cell of a board, holes in them, islands in those. */
static void add_board(csg_random *random, int side, int corners)
{
    for (int i = 0; i < side; i++) {
        for (int j = 0; j < side; j++) {
            csg_vec2 center = {i * 2.1, j * 2.1};
            add_star(&outline, random, center, 0.7, 1, corners, false);
            add_star(&outline, random, center, 0.35, 0.6, corners, true);
            add_star(&outline, random, center, 0.1, 0.3, corners, false);
        }
    }
}

static void boards_of_stars(void **state)
{
    csg_random random = {5};
    for (int round = 0; round < 20; round++) {
        csg_outline_release(&outline);
        add_board(&random, 1 + round % 4, 3 + 4 * round);
        triangulate(0);
    }
}

/* One square with many holes, given in any order. */
static void add_sieve(csg_random *random, int side, int corners)
{
    add_rectangle(&outline, -2, -2, side * 2.1, side * 2.1);
    for (int k = 0; k < side * side; k++) {
        int at = k * 37 % (side * side);
        csg_vec2 center = {at % side * 2.1, at / side * 2.1};
        add_star(&outline, random, center, 0.2, 1, corners, true);
    }
}

static void sieves(void **state)
{
    csg_random random = {6};
    for (int side = 1; side < 12; side++) {
        csg_outline_release(&outline);
        add_sieve(&random, side, 3 + (int)csg_random_below(&random, 20));
        size_t holes = (size_t)(side * side);
        assert_int_equal(triangulate(0), outline.point_count + 2 * holes - 2);
    }
}

static void twenty_thousand_points_are_quick(void **state)
{
    csg_random random = {7};
    add_sieve(&random, 25, 32);
    clock_t start = clock();
    triangulate(0);
    csg_outline_release(&outline);
    add_star(&outline, &random, (csg_vec2){0, 0}, 0.999, 1, 20000, false);
    triangulate(0);
    double seconds = (double)(clock() - start) / CLOCKS_PER_SEC;
    print_message("2 x 20 000 points: %.2f s\n", seconds);
    assert_true(seconds <
                20); /* quadratic would be minutes; sanitizers and busy machines slow it */
}

/* What is not clean still has the right edges; area may be turned over. */
static void scribbles_keep_their_edges(void **state)
{
    csg_random random = {8};
    for (int round = 0; round < 200; round++) {
        csg_outline_release(&outline);
        add_scribble(&outline, &random, 3, 3 + (int)csg_random_below(&random, 40));
        add_scribble(&outline, &random, 2, 3 + (int)csg_random_below(&random, 40));
        for (size_t i = 0; round % 2 && i < outline.point_count; i++) {
            outline.points[i].x = nearbyint(outline.points[i].x);
            outline.points[i].y = nearbyint(outline.points[i].y);
        }
        triangulate(INFINITY);
    }
}

static void every_allocation_may_fail(void **state)
{
    csg_random random = {9};
    add_board(&random, 2, 6);
    csgm_status status = CSGM_ERR_MEMORY;
    long n = 0;
    for (; status; n++) {
        failing_memory f;
        uint32_t *indices;
        size_t count;
        failing_init(&f, n);
        status = csg_polygons_triangulate(&outline, &f.memory, &indices, &count);
        assert_int_equal(status, f.allocator.left < 0 ? CSGM_ERR_MEMORY : CSGM_OK);
        csg_memory_release(&f.memory, indices, count * sizeof *indices);
        assert_int_equal(f.allocator.live, 0);
    }
    assert_true(n > 4);
    for (status = CSGM_ERR_MEMORY, n = 0; status; n++) {
        failing_memory f;
        csg_outline hull, copy = outline;
        failing_init(&f, n);
        copy.memory = &f.memory;
        status = csg_polygons_hull(&copy, &hull);
        assert_int_equal(status, f.allocator.left < 0 ? CSGM_ERR_MEMORY : CSGM_OK);
        csg_outline_release(&hull);
        assert_int_equal(f.allocator.live, 0);
    }
    assert_true(n > 2);
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, begin, end)
    const struct CMUnitTest tests[] = {
        TEST(hulls_hold_all_points),
        TEST(hulls_of_lines_are_empty),
        TEST(nothing_has_no_triangles),
        TEST(holes_and_islands),
        TEST(triangles_become_fat),
        TEST(straight_corners_stay),
        TEST(a_hole_between_corners_of_its_height),
        TEST(loops_that_touch),
        TEST(boards_of_stars),
        TEST(sieves),
        TEST(twenty_thousand_points_are_quick),
        TEST(scribbles_keep_their_edges),
        TEST(every_allocation_may_fail),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
