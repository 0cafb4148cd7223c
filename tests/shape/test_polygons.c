/* SPDX-License-Identifier: MIT
 * Set operations, offsets and Minkowski sums against winding numbers and distances at random
 * points; their results are clean and have triangles; bad coordinates, limits, failing allocations.
 */
#include "outline_support.h"

#include <stdlib.h>

#include "shape/plane/polygons.h"

static csg_memory memory;
static csg_outline a, b, out;
static csg_random dice;

static int begin(void **state)
{
    csg_memory_init(&memory, NULL, 0);
    csg_outline_init(&a, &memory);
    csg_outline_init(&b, &memory);
    csg_outline_init(&out, &memory);
    dice.state = 17;
    return 0;
}

static void forget(void)
{
    csg_outline_release(&a);
    csg_outline_release(&b);
    csg_outline_release(&out);
}

static int end(void **state)
{
    forget();
    assert_int_equal(memory.used_bytes, 0);
    return 0;
}

static csg_vec2 any_point(double extent)
{
    return (csg_vec2){csg_random_uniform(&dice, -extent, extent),
                      csg_random_uniform(&dice, -extent, extent)};
}

/* Winding numbers 0 and 1 only, and triangles that fill it. */
static void check_clean(double extent)
{
    uint32_t *indices;
    size_t count;
    for (int i = 0; i < 200; i++) {
        csg_vec2 p = any_point(extent);
        if (distance_of(&out, p) > 1e-7 * extent) {
            int winding = winding_of(&out, p);
            assert_true(winding == 0 || winding == 1);
        }
    }
    assert_int_equal(csg_polygons_triangulate(&out, &memory, &indices, &count), CSGM_OK);
    check_triangles(&out, indices, count, 1e-6 * extent * extent);
    csg_memory_release(&memory, indices, count * sizeof *indices);
}

/* ---- set operations ----------------------------------------------------------------------- */

static void cleaning_follows_the_rule(void **state)
{
    for (int round = 0; round < 100; round++) {
        forget();
        for (int loops = 1 + round % 3; loops > 0; loops--)
            add_scribble(&a, &dice, 3, 3 + (int)csg_random_below(&dice, 30));
        csg_fill fill = round % 2 ? CSG_FILL_EVEN_ODD : CSG_FILL_NONZERO;
        assert_int_equal(csg_polygons_clean(&a, fill, &out), CSGM_OK);
        for (int i = 0; i < 300; i++) {
            csg_vec2 p = any_point(3.2);
            int winding = winding_of(&a, p);
            if (distance_of(&a, p) > 1e-7)
                assert_int_equal(winding_of(&out, p),
                                 fill == CSG_FILL_EVEN_ODD ? winding & 1 : winding != 0);
        }
        check_clean(3);
    }
}

/* Many corners at the same heights, holes that touch. */
static void rectangles_on_a_grid(void **state)
{
    for (int round = 0; round < 2000; round++) {
        forget();
        for (int i = 12 + round % 50; i > 0; i--) {
            double x = csg_random_below(&dice, 14), y = csg_random_below(&dice, 14);
            double length = 1 + csg_random_below(&dice, 6), width = 1 + csg_random_below(&dice, 2);
            bool high = csg_random_below(&dice, 2);
            add_rectangle(&a, x, y, x + (high ? width : length), y + (high ? length : width));
        }
        uint32_t *indices;
        size_t count;
        assert_int_equal(csg_polygons_clean(&a, CSG_FILL_NONZERO, &out), CSGM_OK);
        assert_int_equal(csg_polygons_triangulate(&out, &memory, &indices, &count), CSGM_OK);
        check_triangles(&out, indices, count, 1e-6);
        csg_memory_release(&memory, indices, count * sizeof *indices);
    }
}

static bool combined(csg_polygons_op op, bool in_a, bool in_b)
{
    return op == CSG_POLYGONS_UNION          ? in_a || in_b
           : op == CSG_POLYGONS_INTERSECTION ? in_a && in_b
                                             : in_a && !in_b;
}

static void operators_are_what_they_say(void **state)
{
    for (int round = 0; round < 90; round++) {
        forget();
        csg_polygons_op op = (csg_polygons_op)(round % 3);
        int corners = 3 + (int)csg_random_below(&dice, 40);
        add_star(&a, &dice, (csg_vec2){0, 0}, 1, 2, corners, false);
        add_star(&a, &dice, (csg_vec2){0, 0}, 0.3, 0.8, corners, true);
        add_star(&b, &dice, any_point(1), 0.5, 2, corners, false);
        assert_int_equal(csg_polygons_combine(op, &a, &b, &out), CSGM_OK);
        for (int i = 0; i < 300; i++) {
            csg_vec2 p = any_point(3.2);
            if (distance_of(&a, p) > 1e-7 && distance_of(&b, p) > 1e-7)
                assert_int_equal(winding_of(&out, p),
                                 combined(op, winding_of(&a, p) > 0, winding_of(&b, p) > 0));
        }
        check_clean(3);
    }
}

static void plain_numbers_stay(void **state)
{
    add_rectangle(&a, 0, 0, 10, 10);
    add_rectangle(&b, 2.5, 3, 7, 20.75);
    assert_int_equal(csg_polygons_combine(CSG_POLYGONS_DIFFERENCE, &a, &b, &out), CSGM_OK);
    assert_int_equal(out.point_count, 8);
    assert_true(area_of(&out) == 100 - 4.5 * 7);
    for (size_t i = 0; i < out.point_count; i++)
        assert_true(out.points[i].x * 2 == round(out.points[i].x * 2));
    csg_outline again;
    assert_int_equal(csg_polygons_clean(&out, CSG_FILL_NONZERO, &again), CSGM_OK);
    assert_true(area_of(&again) == area_of(&out));
    csg_outline_release(&again);
}

static void nothing_is_neutral(void **state)
{
    assert_int_equal(csg_polygons_clean(&a, CSG_FILL_NONZERO, &out), CSGM_OK);
    assert_int_equal(out.loop_count, 0);
    add_rectangle(&a, 1e9, 1e9, 1e9 + 1, 1e9 + 2);
    assert_int_equal(csg_polygons_combine(CSG_POLYGONS_UNION, &a, &b, &out), CSGM_OK);
    csg_vec3 size = csg_box_size(csg_outline_box(&out));
    assert_true(out.point_count == 4 && size.x == 1 && size.y == 2);
    csg_outline_release(&out);
    assert_int_equal(csg_polygons_combine(CSG_POLYGONS_INTERSECTION, &a, &b, &out), CSGM_OK);
    assert_int_equal(out.loop_count, 0);
    assert_int_equal(csg_polygons_minkowski(&a, &b, &out), CSGM_OK);
    assert_int_equal(out.loop_count, 0);
    assert_int_equal(csg_polygons_minkowski(&b, &a, &out), CSGM_OK);
    assert_int_equal(out.loop_count, 0);
}

/* ---- offset ------------------------------------------------------------------------------- */

static void round_offsets_are_distances(void **state)
{
    for (int round = 0; round < 60; round++) {
        forget();
        double by = csg_random_uniform(&dice, -0.5, 0.8), tolerance = 1e-3;
        add_star(&a, &dice, (csg_vec2){0, 0}, 1, 2, 3 + round, false);
        add_star(&a, &dice, (csg_vec2){0, 0}, 0.3, 0.8, 3 + round, true);
        assert_int_equal(csg_polygons_offset(&a, by, CSG_CORNER_ROUND, tolerance, &out), CSGM_OK);
        for (int i = 0; i < 300; i++) {
            csg_vec2 p = any_point(3);
            double field = distance_of(&a, p) * (winding_of(&a, p) > 0 ? 1 : -1) + by;
            if (fabs(field) > tolerance + 1e-7)
                assert_int_equal(winding_of(&out, p), field > 0);
        }
        check_clean(3);
    }
}

static void corners_of_a_square(void **state)
{
    add_rectangle(&a, -1, -1, 1, 1);
    assert_int_equal(csg_polygons_offset(&a, 0.5, CSG_CORNER_MITER, 0.01, &out), CSGM_OK);
    assert_true(fabs(area_of(&out) - 9) < 1e-6 && out.point_count == 4);
    csg_outline_release(&out);
    assert_int_equal(csg_polygons_offset(&a, 0.5, CSG_CORNER_CHAMFER, 0.01, &out), CSGM_OK);
    double cut = 0.5 * (sqrt(2) - 1); /* of the miter's diagonal: legs cut * sqrt(2) */
    assert_true(fabs(area_of(&out) - (9 - 4 * cut * cut)) < 1e-6 && out.point_count == 8);
    csg_outline_release(&out);
    assert_int_equal(csg_polygons_offset(&a, 0.5, CSG_CORNER_ROUND, 1e-4, &out), CSGM_OK);
    assert_true(fabs(area_of(&out) - (8 + 3.14159265358979 * 0.25)) < 1e-3);
    csg_outline_release(&out);
    assert_int_equal(csg_polygons_offset(&a, -0.25, CSG_CORNER_MITER, 0.01, &out), CSGM_OK);
    assert_true(fabs(area_of(&out) - 2.25) < 1e-6);
    csg_outline_release(&out);
    assert_int_equal(csg_polygons_offset(&a, -1.25, CSG_CORNER_ROUND, 0.01, &out), CSGM_OK);
    assert_int_equal(out.loop_count, 0);
    assert_int_equal(csg_polygons_offset(&a, 0, CSG_CORNER_ROUND, 0.01, &out), CSGM_OK);
    assert_true(area_of(&out) == 4);
}

static void tiny_tolerances_are_bounded(void **state)
{
    const double tolerances[] = {0, -1, NAN, 1e-300};
    for (int i = 0; i < 4; i++) {
        csg_outline_release(&out);
        csg_outline_release(&a);
        add_rectangle(&a, -1, -1, 1, 1);
        assert_int_equal(csg_polygons_offset(&a, 3, CSG_CORNER_ROUND, tolerances[i], &out),
                         CSGM_OK);
        assert_true(out.point_count > 500 && out.point_count < 5000);
    }
}

/* ---- Minkowski sum ------------------------------------------------------------------------ */

static void sums_hold_what_they_should(void **state)
{
    for (int round = 0; round < 60; round++) {
        forget();
        csg_outline convex;
        add_star(&a, &dice, (csg_vec2){0.2, 0}, 1, 2, 3 + round, false);
        if (round % 3)
            add_star(&a, &dice, (csg_vec2){0.2, 0}, 0.3, 0.8, 3 + round, true);
        add_scribble(&b, &dice, round % 2 ? 0.3 : 5, 3 + (int)csg_random_below(&dice, 12));
        assert_int_equal(csg_polygons_minkowski(&a, &b, &out), CSGM_OK);
        assert_int_equal(csg_polygons_hull(&b, &convex), CSGM_OK);
        for (int i = 0; i < 300; i++) {
            /* p is in the sum if and only if p - convex meets a: look at random points of it */
            csg_vec2 p = any_point(8);
            bool meets = false;
            for (int k = 0; k < 60 && !meets; k++) {
                csg_vec2 q = any_point(5);
                meets = winding_of(&convex, q) > 0 &&
                        winding_of(&a, (csg_vec2){p.x - q.x, p.y - q.y}) > 0;
            }
            if (meets)
                assert_int_equal(winding_of(&out, p), 1);
        }
        csg_outline_release(&convex);
        check_clean(8);
    }
}

/* Area of the sum of convex loops: both areas and twice the mixed one; of a square, the width. */
static void sums_with_a_square_have_their_area(void **state)
{
    for (int round = 0; round < 50; round++) {
        csg_outline hull;
        forget();
        add_scribble(&a, &dice, 2, 3 + round);
        assert_int_equal(csg_polygons_hull(&a, &hull), CSGM_OK);
        add_rectangle(&b, 3, 4, 3.5, 4.25);
        csg_box box = csg_outline_box(&hull);
        assert_int_equal(csg_polygons_minkowski(&hull, &b, &out), CSGM_OK);
        double expected =
            area_of(&hull) + 0.125 + 0.25 * (box.max.x - box.min.x) + 0.5 * (box.max.y - box.min.y);
        assert_true(fabs(area_of(&out) - expected) < 1e-6);
        assert_true(fabs(csg_outline_box(&out).min.x - box.min.x - 3) < 1e-7);
        csg_outline_release(&hull);
    }
}

static void what_is_smaller_than_the_other_adds_up(void **state)
{
    add_rectangle(&a, 0, 0, 1, 1); /* wholly inside of the other's place */
    add_rectangle(&b, -5, -5, 5, 5);
    assert_int_equal(csg_polygons_minkowski(&a, &b, &out), CSGM_OK);
    assert_true(out.loop_count == 1 && fabs(area_of(&out) - 121) < 1e-6);
}

/* ---- trouble ------------------------------------------------------------------------------ */

static void bad_coordinates_are_refused(void **state)
{
    add_rectangle(&a, 0, 0, 1, 1);
    add_rectangle(&b, 0, 0, 1, 1);
    b.points[1].x = NAN;
    assert_int_equal(csg_polygons_clean(&b, CSG_FILL_NONZERO, &out), CSGM_ERR_SCENE);
    assert_int_equal(csg_polygons_combine(CSG_POLYGONS_UNION, &a, &b, &out), CSGM_ERR_SCENE);
    assert_int_equal(csg_polygons_offset(&b, 1, CSG_CORNER_ROUND, 1, &out), CSGM_ERR_SCENE);
    assert_int_equal(csg_polygons_offset(&a, NAN, CSG_CORNER_ROUND, 1, &out), CSGM_ERR_SCENE);
    assert_int_equal(csg_polygons_offset(&a, 1e305, CSG_CORNER_ROUND, 1, &out), CSGM_ERR_SCENE);
    assert_int_equal(csg_polygons_minkowski(&a, &b, &out), CSGM_ERR_SCENE);
    assert_int_equal(csg_polygons_minkowski(&b, &a, &out), CSGM_ERR_SCENE);
    b.points[1].x = 1e308;
    b.points[2].x = -1e308;
    assert_int_equal(csg_polygons_clean(&b, CSG_FILL_NONZERO, &out), CSGM_ERR_SCENE);
    assert_int_equal(out.point_count, 0);
}

static void hostile_sizes_end(void **state)
{
    const double sizes[] = {1e-300, 1e-30, 1e30, 1e150, 1e290};
    for (int i = 0; i < 5; i++) {
        for (int j = 0; j < 5; j++) {
            forget();
            add_rectangle(&a, 0, 0, sizes[i], sizes[j]);
            add_rectangle(&b, -sizes[j], -sizes[j], sizes[j], sizes[i]);
            csgm_status status = csg_polygons_offset(&a, sizes[j], CSG_CORNER_MITER, 0.1, &out);
            assert_true(status == CSGM_OK || status == CSGM_ERR_SCENE);
            csg_outline_release(&out);
            status = csg_polygons_minkowski(&a, &b, &out);
            assert_true(status == CSGM_OK || status == CSGM_ERR_SCENE);
            csg_outline_release(&out);
            status = csg_polygons_combine(CSG_POLYGONS_DIFFERENCE, &a, &b, &out);
            assert_true(status == CSGM_OK || status == CSGM_ERR_SCENE);
        }
    }
}

static void the_limit_holds_for_the_library_too(void **state)
{
    add_star(&a, &dice, (csg_vec2){0, 0}, 1, 2, 10000, false);
    memory.limit_bytes = memory.used_bytes + 1000000;
    assert_int_equal(csg_polygons_clean(&a, CSG_FILL_NONZERO, &out), CSGM_ERR_MEMORY);
    memory.limit_bytes = 0;
    assert_int_equal(csg_polygons_clean(&a, CSG_FILL_NONZERO, &out), CSGM_OK);
}

static csgm_status call_function(int which, const csg_outline *left, const csg_outline *right)
{
    switch (which) {
    case 0:
        return csg_polygons_clean(left, CSG_FILL_NONZERO, &out);
    case 1:
        return csg_polygons_combine(CSG_POLYGONS_UNION, left, right, &out);
    case 2:
        return csg_polygons_offset(left, 0.5, CSG_CORNER_ROUND, 0.001, &out);
    default:
        return csg_polygons_minkowski(left, right, &out);
    }
}

static void every_allocation_may_fail(void **state)
{
    add_star(&a, &dice, (csg_vec2){0, 0}, 1, 2, 40, false);
    add_star(&b, &dice, (csg_vec2){0, 1}, 1, 2, 40, false);
    for (int which = 0; which < 4; which++) {
        csgm_status status = CSGM_ERR_MEMORY;
        long n = 0;
        for (; status; n++) {
            failing_memory f;
            csg_outline left = a, right = b;
            failing_init(&f, n);
            left.memory = right.memory = &f.memory;
            status = call_function(which, &left, &right);
            assert_int_equal(status, f.allocator.left < 0 ? CSGM_ERR_MEMORY : CSGM_OK);
            assert_true(!status || !out.points);
            csg_outline_release(&out);
            assert_int_equal(f.allocator.live, 0);
        }
        assert_true(n > 4);
    }
}

/* ---- limits -------------------------------------------------------------------------------
 */

static void add_circle(csg_outline *outline, int corners, csg_vec2 center, double radius,
                       double turn)
{
    for (int i = 0; i < corners; i++) {
        double angle = turn + 2 * M_PI * i / corners;
        assert_true(csg_outline_add(
            outline, (csg_vec2){center.x + radius * cos(angle), center.y + radius * sin(angle)}));
    }
    assert_true(csg_outline_close(outline));
}

static void loops_drawn_twice_cancel_out(void **state)
{
    for (int k = 0; k < 64; k++) /* as often as a drawing's block is inserted at one place */
        add_circle(&a, 2250, (csg_vec2){0, 0}, 100, 0);
    assert_int_equal(csg_polygons_clean(&a, CSG_FILL_EVEN_ODD, &out), CSGM_OK);
    assert_int_equal(out.loop_count, 0);
    add_circle(&a, 2250, (csg_vec2){0, 0}, 100, 0);
    assert_int_equal(csg_polygons_clean(&a, CSG_FILL_EVEN_ODD, &out), CSGM_OK);
    assert_int_equal(out.loop_count, 1);
    assert_true(area_of(&out) > 31000);
}

static void tangles_are_refused(void **state)
{
    for (int k = 0; k < 4001; k++) /* a star: each edge crosses nearly all others */
        assert_true(csg_outline_add(
            &a, (csg_vec2){cos(2 * M_PI * k * 2000 / 4001), sin(2 * M_PI * k * 2000 / 4001)}));
    assert_true(csg_outline_close(&a));
    assert_int_equal(csg_polygons_check(&a), CSGM_ERR_LIMIT);
    assert_int_equal(csg_polygons_clean(&a, CSG_FILL_EVEN_ODD, &out), CSGM_ERR_LIMIT);
    assert_int_equal(csg_polygons_clean(&a, CSG_FILL_NONZERO, &out), CSGM_ERR_LIMIT);
    assert_int_equal(csg_polygons_offset(&a, 1, CSG_CORNER_ROUND, 0.01, &out), CSGM_ERR_LIMIT);
}

static void offsets_that_would_cross_too_often_are_refused(void **state)
{
    add_star(&a, &dice, (csg_vec2){0, 0}, 1, 1.5, 10000, false);
    assert_int_equal(csg_polygons_offset(&a, 0.001, CSG_CORNER_MITER, 0, &out), CSGM_OK);
    csg_outline_release(&out);
    assert_int_equal(csg_polygons_offset(&a, 0.5, CSG_CORNER_ROUND, 1e-3, &out), CSGM_ERR_LIMIT);
}

/* 10000 teeth side by side, which a sweep along the other axis makes short work of: one in x,
 * one in y; the result is where it belongs. */
static void combs_are_cleaned(void **state)
{
    enum { TEETH = 10000 };
    for (int way = 0; way < 2; way++) {
        forget();
        for (int k = 0; k < TEETH; k++) {
            double low = 0.001 * (k % 331), high = 1000 + 0.001 * (k % 173);
            csg_vec2 p = {k, low}, q = {k + 0.5, high};
            assert_true(csg_outline_add(&a, way ? (csg_vec2){-p.y, p.x} : p));
            assert_true(csg_outline_add(&a, way ? (csg_vec2){-q.y, q.x} : q));
        }
        csg_vec2 ends[2] = {{TEETH, -1}, {0, -1}};
        for (int k = 0; k < 2; k++)
            assert_true(csg_outline_add(&a, way ? (csg_vec2){-ends[k].y, ends[k].x} : ends[k]));
        assert_true(csg_outline_close(&a));
        assert_int_equal(csg_polygons_clean(&a, CSG_FILL_NONZERO, &out), CSGM_OK);
        assert_int_equal(out.loop_count, 1);
        assert_true(fabs(area_of(&out) - fabs(area_of(&a))) < 1);
        csg_box box = csg_outline_box(&out), whole = csg_outline_box(&a);
        assert_true(fabs(box.min.x - whole.min.x) < 1e-3 && fabs(box.max.x - whole.max.x) < 1e-3);
        assert_true(fabs(box.min.y - whole.min.y) < 1e-3 && fabs(box.max.y - whole.max.y) < 1e-3);
    }
}

/* Honest and large. */
static void many_circles_are_united(void **state)
{
    for (int k = 0; k < 2000; k++)
        add_circle(&a, 100, (csg_vec2){1.5 * (k % 45), 1.5 * (k / 45)}, 1, 0);
    assert_int_equal(csg_polygons_clean(&a, CSG_FILL_NONZERO, &out), CSGM_OK);
    assert_true(area_of(&out) > 4000);
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, begin, end)
    const struct CMUnitTest tests[] = {
        TEST(cleaning_follows_the_rule),
        TEST(rectangles_on_a_grid),
        TEST(operators_are_what_they_say),
        TEST(plain_numbers_stay),
        TEST(nothing_is_neutral),
        TEST(round_offsets_are_distances),
        TEST(corners_of_a_square),
        TEST(tiny_tolerances_are_bounded),
        TEST(sums_hold_what_they_should),
        TEST(sums_with_a_square_have_their_area),
        TEST(what_is_smaller_than_the_other_adds_up),
        TEST(bad_coordinates_are_refused),
        TEST(hostile_sizes_end),
        TEST(the_limit_holds_for_the_library_too),
        TEST(loops_drawn_twice_cancel_out),
        TEST(tangles_are_refused),
        TEST(offsets_that_would_cross_too_often_are_refused),
        TEST(combs_are_cleaned),
        TEST(many_circles_are_united),
        TEST(every_allocation_may_fail),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
