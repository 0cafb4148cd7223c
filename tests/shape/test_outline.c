/* SPDX-License-Identifier: MIT
 * Loops open and closed, curves within their tolerance, hostile numbers, every allocation failing
 * once.
 */
#include "outline_fixture.h"

static void add(double x, double y)
{
    assert_true(csg_outline_add(&outline, (csg_vec2){x, y}));
}

static void loops_open_and_close(void **state)
{
    add(0, 0);
    add(1, 0);
    assert_true(csg_outline_close(&outline)); /* forgotten */
    assert_int_equal(outline.point_count, 0);
    add(0, 0);
    add(1, 0);
    add(1, 0); /* the same again */
    add(1, 1);
    add(0, 0); /* the first again */
    assert_true(csg_outline_close(&outline));
    assert_int_equal(outline.point_count, 3);
    assert_int_equal(outline.loop_count, 1);
    assert_true(csg_outline_close(&outline)); /* nothing open */
    assert_int_equal(outline.loop_count, 1);
    add(1, 1); /* a new loop may begin where the last one ended */
    add(2, 1);
    add(2, 2);
    assert_true(csg_outline_close(&outline));
    assert_int_equal(csg_outline_first(&outline, 1), 3);
    assert_int_equal(outline.ends[1], 6);
}

static void appending_keeps_what_is_open(void **state)
{
    csg_outline more;
    csg_outline_init(&more, &memory);
    add_rectangle(&more, 0, 0, 1, 2);
    assert_true(csg_outline_add(&more, (csg_vec2){9, 9})); /* not closed: not appended */
    add(5, 5);
    add(6, 5);
    assert_true(csg_outline_append(&outline, &more));
    assert_true(csg_outline_append(&outline, &more));
    assert_int_equal(outline.loop_count, 2);
    assert_int_equal(outline.ends[1], 8);
    add(6, 6);
    assert_true(csg_outline_close(&outline));
    assert_int_equal(outline.ends[2], 11);
    assert_true(outline.points[8].x == 5 && outline.points[8].y == 5);
    csg_outline_release(&more);
}

static void maps_and_boxes(void **state)
{
    assert_true(csg_box_is_empty(csg_outline_box(&outline)));
    add_rectangle(&outline, 0, 0, 1, 2);
    csg_affine map = csg_affine_multiply(csg_affine_translate(csg_vec3_make(10, 20, 30)),
                                         csg_affine_rotate(90, csg_vec3_make(0, 0, 1)));
    csg_outline_transform(&outline, &map);
    csg_box box = csg_outline_box(&outline);
    assert_true(box.min.x == 8 && box.max.x == 10 && box.min.y == 20 && box.max.y == 21);
    assert_true(box.min.z == 0 && box.max.z == 0);
}

/* ---- curves ------------------------------------------------------------------------------- */

static void arcs_keep_their_tolerance(void **state)
{
    csg_random random = {1};
    for (int round = 0; round < 200; round++) {
        double radius = pow(10, csg_random_uniform(&random, -3, 4)),
               tolerance = radius * pow(10, csg_random_uniform(&random, -6, 1)),
               from = csg_random_uniform(&random, -720, 720),
               sweep = csg_random_uniform(&random, -360, 360);
        csg_vec2 center = {csg_random_uniform(&random, -9, 9), csg_random_uniform(&random, -9, 9)};
        outline.point_count = 0;
        assert_true(csg_outline_arc(&outline, center, radius, from, 0, tolerance));
        assert_true(csg_outline_arc(&outline, center, radius, from, sweep, tolerance));
        for (size_t i = 1; i < outline.point_count; i++) {
            csg_vec2 a = outline.points[i - 1], b = outline.points[i];
            double at = hypot(b.x - center.x, b.y - center.y);
            double middle = hypot(0.5 * (a.x + b.x) - center.x, 0.5 * (a.y + b.y) - center.y);
            assert_true(fabs(at - radius) <= 1e-12 * (radius + 9));
            assert_true(middle >= radius - fmin(tolerance, radius) * 1.001 - 1e-12 * radius);
        }
        double angle = (from + sweep) * (3.14159265358979323846 / 180);
        csg_vec2 last = outline.points[outline.point_count - 1];
        assert_true(fabs(last.x - center.x - radius * cos(angle)) <= 1e-11 * (radius + 9));
        assert_true(fabs(last.y - center.y - radius * sin(angle)) <= 1e-11 * (radius + 9));
    }
}

static void circles_close(void **state)
{
    assert_true(csg_outline_arc(&outline, (csg_vec2){1, 2}, 3, 30, 360, 0.01));
    size_t count = outline.point_count;
    assert_true(csg_outline_close(&outline));
    assert_int_equal(outline.point_count, count);
    assert_true(count >= 27 && count <= 40); /* pi / sqrt(2 * 0.01 / 3) = 38.5 */
    csg_outline_release(&outline);
    assert_true(csg_outline_arc(&outline, (csg_vec2){0, 0}, 2, 0, 360, 10));
    assert_int_equal(outline.point_count, 4);
    assert_true(outline.points[0].x == 0 && outline.points[0].y == 2);
    assert_true(outline.points[1].x == -2 && outline.points[1].y == 0);
}

static csg_vec2 cubic_at(const csg_vec2 *p, double t)
{
    double s = 1 - t, b[4] = {s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t};
    csg_vec2 at = {0, 0};
    for (int i = 0; i < 4; i++) {
        at.x += b[i] * p[i].x;
        at.y += b[i] * p[i].y;
    }
    return at;
}

/* Every point of the curve lies near its flat pieces. */
static void check_pieces(const csg_vec2 *p, double tolerance)
{
    for (int k = 0; k <= 300; k++) {
        csg_vec2 at = cubic_at(p, k / 300.0);
        double best = INFINITY;
        for (size_t i = 1; i < outline.point_count; i++) {
            csg_vec2 a = outline.points[i - 1], b = outline.points[i];
            double ux = b.x - a.x, uy = b.y - a.y, px = at.x - a.x, py = at.y - a.y;
            double t = fmin(fmax((px * ux + py * uy) / (ux * ux + uy * uy), 0), 1);
            best = fmin(best, hypot(px - t * ux, py - t * uy));
        }
        assert_true(best <= tolerance * 1.000001);
    }
}

static void beziers_keep_their_tolerance(void **state)
{
    csg_random random = {2};
    for (int round = 0; round < 200; round++) {
        csg_vec2 p[4];
        double tolerance = pow(10, csg_random_uniform(&random, -4, 0));
        for (int i = 0; i < 4; i++)
            p[i] =
                (csg_vec2){csg_random_uniform(&random, -5, 5), csg_random_uniform(&random, -5, 5)};
        outline.point_count = 0;
        assert_true(csg_outline_add(&outline, p[0]));
        assert_true(csg_outline_cubic(&outline, p[0], p[1], p[2], p[3], tolerance));
        assert_true(outline.points[outline.point_count - 1].x == p[3].x);
        check_pieces(p, tolerance);
        csg_vec2 c = p[1]; /* the same quadratic as a cubic */
        p[1] = (csg_vec2){(p[0].x + 2 * c.x) / 3, (p[0].y + 2 * c.y) / 3};
        p[2] = (csg_vec2){(p[3].x + 2 * c.x) / 3, (p[3].y + 2 * c.y) / 3};
        outline.point_count = 0;
        assert_true(csg_outline_add(&outline, p[0]));
        assert_true(csg_outline_quadratic(&outline, p[0], c, p[3], tolerance));
        check_pieces(p, tolerance);
        assert_true(outline.point_count < 300);
    }
}

static void hostile_numbers_end(void **state)
{
    const double bad[] = {0, -1, NAN, INFINITY, -INFINITY, 1e300, -1e300, 1e-300, 1};
    enum { COUNT = sizeof bad / sizeof *bad };
    for (int i = 0; i < COUNT; i++) {
        for (int j = 0; j < COUNT; j++) {
            csg_vec2 p = {bad[i], bad[j]}, q = {bad[j], 1}, o = {0, 0};
            outline.point_count = 0;
            assert_true(csg_outline_arc(&outline, o, bad[i], bad[j], 90, 0.1));
            assert_true(csg_outline_arc(&outline, o, 1, bad[i], bad[j], 0.1));
            assert_true(csg_outline_arc(&outline, o, bad[i], 0, 90, bad[j]));
            assert_true(csg_outline_quadratic(&outline, o, p, q, 0.1));
            assert_true(csg_outline_quadratic(&outline, o, q, p, bad[i]));
            assert_true(csg_outline_cubic(&outline, o, p, q, o, bad[j]));
            assert_true(outline.point_count <= 6 * 4096);
        }
    }
}

/* ---- memory ------------------------------------------------------------------------------- */

static bool make_much(csg_outline *out)
{
    csg_vec2 o = {0, 0}, p = {1, 5}, q = {7, 2};
    for (int i = 0; i < 40; i++) {
        if (!csg_outline_arc(out, o, 1, 0, 300, 0.01) || !csg_outline_cubic(out, o, p, q, p, 0.1) ||
            !csg_outline_quadratic(out, o, p, q, 0.1) || !csg_outline_close(out))
            return false;
    }
    return csg_outline_append(out, out);
}

static void every_allocation_may_fail(void **state)
{
    bool is_done = false;
    long n = 0;
    for (; !is_done; n++) {
        failing_memory f;
        csg_outline poor;
        failing_init(&f, n);
        csg_outline_init(&poor, &f.memory);
        is_done = make_much(&poor);
        assert_int_equal(is_done, f.allocator.left >= 0);
        csg_outline_release(&poor);
        assert_int_equal(f.allocator.live, 0);
    }
    assert_true(n > 8);
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, begin, end)
    const struct CMUnitTest tests[] = {
        TEST(loops_open_and_close), TEST(appending_keeps_what_is_open),
        TEST(maps_and_boxes),       TEST(arcs_keep_their_tolerance),
        TEST(circles_close),        TEST(beziers_keep_their_tolerance),
        TEST(hostile_numbers_end),  TEST(every_allocation_may_fail),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
