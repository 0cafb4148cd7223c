/* SPDX-License-Identifier: MIT
 * Points of closed contours that may go, and those that must stay.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
/* cmocka wants the four above first */
#include <cmocka.h>

#include <math.h>

#include "slice/thin.h"

enum { MOST = 400 };

/* A crossing of an upright edge of length 1 that begins at a whole y, or of a level one. */
static csg_slice_point upright(double x, double y)
{
    return (csg_slice_point){
        .x = x, .y = y, .low = floor(y) + 0.01, .high = floor(y) + 0.99, .axis = 1};
}

static csg_slice_point level(double x, double y)
{
    return (csg_slice_point){
        .x = x, .y = y, .low = floor(x) + 0.01, .high = floor(x) + 0.99, .axis = 0};
}

/* The square from 0.5 to n + 0.5 with a corner in each of its cells at the corners. */
static size_t make_square(csg_slice_point *p, int n)
{
    static const csg_slice_point none;
    size_t count = 0;
    const double side[4][2] = {{0.5, 0.5}, {n + 0.5, 0.5}, {n + 0.5, n + 0.5}, {0.5, n + 0.5}};
    for (int s = 0; s < 4; s++) {
        p[count] = none;
        p[count].axis = -1;
        p[count].x = side[s][0];
        p[count++].y = side[s][1];
        for (int i = 1; i <= n; i++) {
            double at = s < 2 ? i : n + 1 - i;
            p[count++] = s % 2 ? level(side[s][0], at) : upright(at, side[s][1]);
        }
    }
    return count;
}

static void straight_sides_have_two_points(void **state)
{
    csg_slice_point p[MOST];
    size_t count = make_square(p, 20);
    assert_int_equal(count, 84);
    assert_int_equal(csg_slice_thin(p, count, 1e-3), 4);
    for (size_t i = 0; i < count; i++)
        assert_int_equal(p[i].stays, i % 21 == 0);
}

static void pinned_points_stay(void **state)
{
    csg_slice_point p[MOST];
    size_t count = make_square(p, 20);
    p[5].is_pinned = p[6].is_pinned = true;
    assert_int_equal(csg_slice_thin(p, count, 1e-3), 6);
    assert_true(p[5].stays && p[6].stays);
}

/* One side swings by 0.02: to within that it is straight, closer it is not. */
static void no_farther_than_asked(void **state)
{
    csg_slice_point p[MOST];
    size_t count = make_square(p, 20);
    for (size_t i = 1; i <= 20; i++)
        p[i].y += 0.02 * sin((double)i);
    assert_int_equal(csg_slice_thin(p, count, 0.021), 4);
    size_t fine = csg_slice_thin(p, count, 0.005);
    assert_true(fine > 10);
    size_t from = 0;
    for (size_t i = 1; i <= 21; i++) { /* all that went is within the distance of its chord */
        if (!p[i].stays)
            continue;
        double x = p[i].x - p[from].x, y = p[i].y - p[from].y, length = sqrt(x * x + y * y);
        for (size_t k = from + 1; k < i; k++)
            assert_true(fabs(x * (p[k].y - p[from].y) - y * (p[k].x - p[from].x)) / length <=
                        0.005 + 1e-12);
        from = i;
    }
}

/* A chord may not leave the edges that its points crossed, as near as it would be: two of them end
 * at y = 1, between a dip and a rise. */
static void through_the_same_edges(void **state)
{
    csg_slice_point p[MOST];
    size_t count = make_square(p, 20);
    for (size_t i = 1; i <= 20; i++) {
        double y = i % 2 ? 0.98 : 1.02;
        p[i] = upright((double)i, y);
    }
    assert_true(csg_slice_thin(p, count, 10) > 4);
    for (size_t i = 2; i <= 19; i++)
        assert_true(p[i].stays || p[i - 1].stays || p[i + 1].stays);
}

static void what_is_small_stays_whole(void **state)
{
    csg_slice_point p[4] = {upright(1, 0.9), level(1.1, 1), upright(1, 1.1), level(0.9, 1)};
    assert_true(csg_slice_thin(p, 4, 10) >= 3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(straight_sides_have_two_points), cmocka_unit_test(pinned_points_stay),
        cmocka_unit_test(no_farther_than_asked),          cmocka_unit_test(through_the_same_edges),
        cmocka_unit_test(what_is_small_stays_whole),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
