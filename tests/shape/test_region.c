/* SPDX-License-Identifier: MIT
 * The field of a region against brute force: distance, sign, gradient, batches, what touches and
 * what is not clean, corners and levels of corners, far and near; every allocation failing once.
 */
#include "outline_support.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "rounds.h"
#include "shape/plane/region.h"
#include "shape/shape_kernel.h"

static csg_memory memory;
static csg_outline outline;
static csg_shape *region;
static csg_random dice;

static int begin(void **state)
{
    csg_memory_init(&memory, NULL, 0);
    csg_outline_init(&outline, &memory);
    region = NULL;
    dice.state = 11;
    return 0;
}

static int end(void **state)
{
    csg_shape_release(region);
    csg_outline_release(&outline);
    assert_int_equal(memory.used_bytes, 0);
    return 0;
}

static void make_region(void)
{
    csg_shape_release(region);
    assert_int_equal(csg_region_create(&memory, &outline, &region), CSGM_OK);
}

static double value_of(double x, double y)
{
    csg_vec3 gradient;
    return csg_shape_sample(region, csg_vec3_make(x, y, 0), &gradient);
}

static void check_at(double x, double y, double extent)
{
    csg_vec3 gradient;
    double value = csg_shape_sample(region, csg_vec3_make(x, y, 7), &gradient);
    double expected = distance_of(&outline, (csg_vec2){x, y}), slack = 1e-14 * (extent + expected);
    assert_true(fabs(fabs(value) - expected) <= slack);
    if (expected > slack)
        assert_int_equal(value > 0, winding_of(&outline, (csg_vec2){x, y}) > 0);
    assert_true(gradient.z == 0);
    assert_true(fabs(hypot(gradient.x, gradient.y) - 1) < 1e-7 || expected < 1e-7 * extent);
    if (expected > 1e-6 * extent) { /* it leads to the nearest point */
        csg_vec2 foot = {x - value * gradient.x, y - value * gradient.y};
        assert_true(distance_of(&outline, foot) <= 1e-13 * (extent + expected));
    }
}

static void check_around(double extent, int count)
{
    for (int i = 0; i < count; i++) {
        double spread = i % 8 ? 1.2 * extent : 100 * extent;
        check_at(csg_random_uniform(&dice, -spread, spread),
                 csg_random_uniform(&dice, -spread, spread), extent);
        csg_vec2 p = outline.points[csg_random_below(&dice, (uint32_t)outline.point_count)];
        double near = extent * pow(10, csg_random_uniform(&dice, -12, -1));
        check_at(p.x + csg_random_uniform(&dice, -near, near),
                 p.y + csg_random_uniform(&dice, -near, near), extent);
        check_at(p.x, csg_random_uniform(&dice, -extent, extent), extent);
        check_at(csg_random_uniform(&dice, -extent, extent), p.y, extent);
        check_at(p.x, p.y, extent);
    }
}

/* ---- against brute force ------------------------------------------------------------------ */

static void squares_are_what_they_are(void **state)
{
    add_rectangle(&outline, -1, -2, 3, 4);
    make_region();
    assert_true(value_of(0, 0) == 1 && value_of(1, 1) == 2 && value_of(-4, -6) == -5);
    assert_true(value_of(-1, 0) == 0 && value_of(3, 4) == 0 && value_of(1, 5) == -1);
    assert_int_equal(region->kind, CSG_SHAPE_REGION);
    assert_true(region->box.min.x == -1 && region->box.max.y == 4);
    assert_true(isinf(region->box.min.z) && isinf(region->box.max.z));
    check_around(4, 2000);
}

static void stars_with_holes(void **state)
{
    for (int round = 0; round < 12; round++) {
        csg_outline_release(&outline);
        int corners = 3 + round * round;
        add_star(&outline, &dice, (csg_vec2){0, 0}, 0.6, 1, corners, false);
        add_star(&outline, &dice, (csg_vec2){0, 0}, 0.2, 0.5, corners, true);
        add_star(&outline, &dice, (csg_vec2){2, 1}, 0.1, 0.9, corners, false);
        make_region();
        check_around(3, 300);
    }
}

static void small_and_large_and_far_off(void **state)
{
    const double scales[] = {1e-100, 1e-9, 1e6, 1e100};
    for (int k = 0; k < 4; k++) {
        csg_outline_release(&outline);
        add_star(&outline, &dice, (csg_vec2){0, 0}, 0.3, 1, 30, false);
        csg_affine map = csg_affine_scale(csg_vec3_make(scales[k], scales[k], 1));
        csg_outline_transform(&outline, &map);
        make_region();
        check_around(scales[k], 300);
    }
    csg_outline_release(&outline);
    add_star(&outline, &dice, (csg_vec2){1e5, -1e5}, 0.3, 1, 30, false);
    make_region();
    for (int i = 0; i < 2000; i++)
        check_at(1e5 + csg_random_uniform(&dice, -2, 2), -1e5 + csg_random_uniform(&dice, -2, 2),
                 1e5);
}

/* Spikes and notches: all kinds of corners, on common levels. */
static void lattice_polygons(void **state)
{
    for (int round = 0; round < 200; round++) {
        csg_outline_release(&outline);
        add_star(&outline, &dice, (csg_vec2){0, 0}, 1, 9, 3 + (int)csg_random_below(&dice, 20),
                 false);
        for (size_t i = 0; i < outline.point_count; i++) {
            outline.points[i].x = nearbyint(outline.points[i].x);
            outline.points[i].y = nearbyint(outline.points[i].y);
        }
        make_region();
        for (int x = -10; x <= 10; x++) {
            for (int y = -10; y <= 10; y++)
                check_at(x, y, 10);
        }
        check_around(10, 30);
    }
}

/* Loops that cross and overlap: the sign is the winding number's all the same. */
static void scribbles(void **state)
{
    for (int round = 0; round < 60; round++) {
        csg_outline_release(&outline);
        add_scribble(&outline, &dice, 3, 3 + round);
        make_region();
        check_around(3, 100);
    }
}

static void what_touches(void **state)
{
    add_rectangle(&outline, 0, 0, 1, 1); /* with a common edge, a common corner */
    add_rectangle(&outline, 1, 0, 2, 1);
    add_rectangle(&outline, 2, 1, 3, 2);
    make_region();
    assert_true(value_of(0.5, 2) == -1 && value_of(1.25, 0.5) == 0.25 && value_of(1, -1) == -1);
    assert_true(value_of(2.5, 0.5) == -0.5 && value_of(2.25, 1.5) == 0.25);
    check_around(3, 2000);
}

/* As in letters: sides of several strokes, and of several letters, lie on one line. */
static void strokes_on_one_line(void **state)
{
    for (int i = 0; i < 5; i++) {
        double left = 0.1 * i, bottom = i % 2 ? 0.3 : -0.7;
        add_rectangle(&outline, left, 0, left + 0.07, 1);
        add_rectangle(&outline, left, bottom - 2, left + 0.03 * (i + 1), bottom - 1);
    }
    make_region();
    assert_true(value_of(0.035, 0.5) > 0 && value_of(0.085, 0) < 0);
    check_around(3, 4000);
}

static void crossings_by_a_rounding_error(void **state)
{
    const csg_vec2 wall[] = {{0, 0}, {9, 0}, {9, 9}, {0, 9}},
                   hole[] = {{1, -1e-9}, {1, 8}, {8, 8}, {8, 1e-9}};
    for (int i = 0; i < 4; i++)
        assert_true(csg_outline_add(&outline, wall[i]));
    assert_true(csg_outline_close(&outline));
    for (int i = 0; i < 4; i++)
        assert_true(csg_outline_add(&outline, hole[i]));
    assert_true(csg_outline_close(&outline));
    make_region();
    assert_true(value_of(4, 3) < -2.9 && value_of(4, -3) < -2.9 && value_of(4, 8.5) > 0);
    check_around(9, 2000);
}

/* ---- laws --------------------------------------------------------------------------------- */

static void make_text_like(int segments)
{
    csg_outline_release(&outline);
    int glyphs = segments / 50 + 1;
    for (int i = 0; i < glyphs; i++) {
        csg_vec2 center = {(i % 40) * 2.2, i / 40 * 2.5};
        add_star(&outline, &dice, center, 0.8, 1, 30, false);
        add_star(&outline, &dice, center, 0.4, 0.5, 20, true);
    }
    make_region();
}

static void differences_stay_below_distances(void **state)
{
    make_text_like(2000);
    for (int i = 0; i < 200000; i++) {
        double x = csg_random_uniform(&dice, -3, 90), y = csg_random_uniform(&dice, -3, 9);
        double near = pow(10, csg_random_uniform(&dice, -6, 1));
        double dx = csg_random_uniform(&dice, -near, near),
               dy = csg_random_uniform(&dice, -near, near);
        assert_true(fabs(value_of(x, y) - value_of(x + dx, y + dy)) <= hypot(dx, dy) + 1e-13);
    }
}

static void batches_are_their_points(void **state)
{
    enum { COUNT = 700 };
    static float x[COUNT], y[COUNT], z[COUNT], out[COUNT], again[COUNT], one, g[4][COUNT];
    make_text_like(1000);
    for (int i = 0; i < COUNT; i++) { /* some of them twice */
        int j = i % 3 ? i : (int)csg_random_below(&dice, (uint32_t)i + 1);
        x[i] = j < i ? x[j] : (float)csg_random_uniform(&dice, -3, 90);
        y[i] = j < i ? y[j] : (float)csg_random_uniform(&dice, -3, 9);
        z[i] = (float)i;
    }
    x[5] = NAN, y[6] = INFINITY, x[7] = -0.0f, x[8] = 0.0f, y[7] = y[8] = 0.5f;
    csg_shape_values(region, NULL, NULL, x, y, z, COUNT, out);
    csg_shape_gradients(region, NULL, NULL, x, y, z, COUNT, again, g[0], g[1], g[2]);
    for (int i = 0; i < COUNT; i++) {
        csg_shape_values(region, NULL, NULL, &x[i], &y[i], &z[i], 1, &one);
        assert_memory_equal(&one, &out[i], sizeof one);
        assert_memory_equal(&again[i], &out[i], sizeof one);
        csg_vec3 gradient;
        double value =
            csg_shape_sample(region, csg_vec3_make((double)x[i], (double)y[i], 0), &gradient);
        assert_true(out[i] == (float)value);
        assert_true(g[0][i] == (float)gradient.x && g[1][i] == (float)gradient.y && g[2][i] == 0);
    }
    assert_true(isinf(out[5]) && out[5] < 0 && isinf(out[6]) && out[6] < 0);
}

/* ---- what matters in a cell ----------------------------------------------------------------- */

static csg_shape_near *make_list(void)
{
    return malloc(sizeof(csg_shape_near) + CSG_SHAPE_MOST_NEAR * sizeof(uint32_t));
}

/* False: nothing is known, as where the limit of the larger cell does not reach the outline. */
static bool narrow(csg_shape_near *list, const csg_shape_near *among, const csg_shape_cell *cell)
{
    list->limit = cell->reach;
    list->count = csg_shape_narrow(region, among, cell, list->items);
    assert_in_range(list->count, among ? 0 : 1, CSG_SHAPE_MOST_NEAR);
    return list->count > 0;
}

/* Every bit as by the whole region, corners and sides of the box among the points. */
static void check_cell(const csg_shape_near *list, const csg_shape_cell *cell)
{
    enum { COUNT = 64 };
    float x[COUNT], y[COUNT], z[COUNT], whole[4][COUNT], own[4][COUNT], values[COUNT];
    for (int i = 0; i < COUNT; i++) {
        double u = csg_random_uniform(&dice, -1, 1), v = csg_random_uniform(&dice, -1, 1);
        u = i % 4 == 0 ? copysign(1, u) : u;
        v = i % 8 < 2 ? copysign(1, v) : v;
        x[i] = (float)(cell->center.x + u * cell->half.x * (1 - 1e-6));
        y[i] = (float)(cell->center.y + v * cell->half.y * (1 - 1e-6));
        z[i] = (float)i;
    }
    csg_shape_gradients(region, NULL, NULL, x, y, z, COUNT, whole[0], whole[1], whole[2], whole[3]);
    csg_shape_gradients(region, NULL, list, x, y, z, COUNT, own[0], own[1], own[2], own[3]);
    csg_shape_values(region, NULL, list, x, y, z, COUNT, values);
    assert_memory_equal(own, whole, sizeof own);
    assert_memory_equal(values, whole[0], sizeof values);
    for (size_t count = 1; count <= COUNT; count += 1 + csg_random_below(&dice, 15)) {
        csg_shape_gradients(region, &csg_shape_kernel_scalar, list, x, y, z, count, own[0], own[1],
                            own[2], own[3]);
        csg_shape_values(region, &csg_shape_kernel_scalar, list, x, y, z, count, values);
        for (int k = 0; k < 4; k++)
            assert_memory_equal(own[k], whole[k], count * sizeof *own[k]);
        assert_memory_equal(values, whole[0], count * sizeof *values);
    }
}

/* Smaller and smaller cells around a place: on the outline, beside it, or anywhere. */
static int check_way_down(double extent)
{
    int checked = 0;
    csg_vec2 p = outline.points[csg_random_below(&dice, (uint32_t)outline.point_count)];
    double half = extent * csg_random_uniform(&dice, 0.05, 0.6), off = csg_random_below(&dice, 3);
    csg_vec3 at = {p.x + off * csg_random_uniform(&dice, -half, half),
                   p.y + off * csg_random_uniform(&dice, -half, half), 5};
    double share = csg_random_uniform(&dice, 0.3, 1);
    csg_shape_near *list = make_list(), *before = make_list();
    for (int level = 0; level < 9; level++, half *= 0.45) {
        csg_vec3 ignored;
        csg_shape_cell cell = {.center = at, .half = {half, share * half, 9}};
        double least = fabs(csg_shape_sample(region, at, &ignored));
        cell.reach = least + (level % 3 ? 3 * half : csg_random_uniform(&dice, 0, half));
        if (level)
            cell.reach = fmin(cell.reach, before->limit);
        if (!narrow(list, level ? before : NULL, &cell))
            break;
        checked++;
        check_cell(list, &cell);
        csg_shape_near *other = before;
        before = list;
        list = other;
        at.x += csg_random_uniform(&dice, -0.5, 0.5) * half;
        at.y += csg_random_uniform(&dice, -0.5, 0.5) * cell.half.y;
    }
    free(list);
    free(before);
    return checked;
}

static void cells_have_what_matters_there(void **state)
{
    int checked = 0;
    for (int round = 0; round < 60; round++) {
        csg_outline_release(&outline);
        int corners = 3 + round * round / 4;
        add_star(&outline, &dice, (csg_vec2){0, 0}, round % 3 ? 0.9 : 0.2, 1, corners, false);
        add_star(&outline, &dice, (csg_vec2){0, 0}, 0.1, 0.3, corners, true);
        add_star(&outline, &dice, (csg_vec2){1, 1}, 0.1, 0.9, 5 + corners / 2, false);
        make_region();
        for (int i = 0; i < ROUNDS(40); i++)
            checked += check_way_down(2);
    }
    make_text_like(3000);
    for (int i = 0; i < ROUNDS(300); i++)
        checked += check_way_down(20);
    assert_true(checked > ROUNDS(15000));
}

/* What csg_shape_beside says of a triangle, tried at random places of it. Returns whether it says
 * that all of it is on the side that is asked for. */
static bool check_beside(csg_vec2 c, double radius, double turn)
{
    csg_vec3 v[3];
    double at[3], corners[3];
    for (int k = 0; k < 3; k++) {
        v[k] = csg_vec3_make(c.x + csg_random_uniform(&dice, -radius, radius),
                             c.y + csg_random_uniform(&dice, -radius, radius), 0);
        at[k] = turn * value_of(v[k].x, v[k].y);
        corners[k] = at[k];
    }
    if (csg_shape_beside(region, v, turn, at) == CSG_BESIDE_UNKNOWN)
        return false;
    for (int k = 0; k < 3; k++)
        assert_true(at[k] <= corners[k] + 1e-12);
    for (int i = 0; i < 40; i++) {
        double s = csg_random_uniform(&dice, 0, 1), t = csg_random_uniform(&dice, 0, 1 - s);
        t = i % 4 ? t : 1 - s;
        double x = s * v[0].x + t * v[1].x + (1 - s - t) * v[2].x;
        double y = s * v[0].y + t * v[1].y + (1 - s - t) * v[2].y;
        double said = s * at[0] + t * at[1] + (1 - s - t) * at[2], is = turn * value_of(x, y);
        if (is < said - 1e-12)
            fail_msg("%g, not %g or more, at (%g, %g), of a triangle within %g", is, said, x, y,
                     radius);
    }
    return at[0] > 0 && at[1] > 0 && at[2] > 0;
}

/* Near outlines of few corners and of many, that cross themselves, that turn to one side. */
static void triangles_beside(void **state)
{
    uint32_t told = 0;
    for (int round = 0; round < ROUNDS(40); round++) {
        csg_outline_release(&outline);
        int corners = 3 + round % 20;
        if (round % 4 == 3)
            add_scribble(&outline, &dice, 1, corners);
        else
            add_star(&outline, &dice, (csg_vec2){0, 0}, round % 4 ? 0.97 : 0.3, 1, corners, false);
        if (round % 4 == 2)
            add_star(&outline, &dice, (csg_vec2){0, 0}, 0.2, 0.21, corners, true);
        for (int i = 0; i < 12 && round % 4 == 1; i++) { /* small ones beside long segments */
            csg_vec2 c = {csg_random_uniform(&dice, -0.8, 0.8), csg_random_uniform(&dice, -1, 1)};
            add_star(&outline, &dice, c, 0.005, 0.01, 4, i % 2);
        }
        make_region();
        for (int i = 0; i < 500; i++) {
            csg_vec2 p = outline.points[csg_random_below(&dice, (uint32_t)outline.point_count)];
            csg_vec2 q = outline.points[csg_random_below(&dice, (uint32_t)outline.point_count)];
            double radius = exp(csg_random_uniform(&dice, -7, -0.5)), off = 2 * radius;
            double share = i % 3 ? 0 : csg_random_uniform(&dice, 0, 1);
            p.x += share * (q.x - p.x) + csg_random_uniform(&dice, -off, off);
            p.y += share * (q.y - p.y) + csg_random_uniform(&dice, -off, off);
            told += check_beside(p, radius, i % 2 ? 1 : -1);
        }
    }
    print_message("%u triangles on one side\n", told);
    assert_true(told > ROUNDS(40) * 100);
}

static void shapes_are_counted_and_named(void **state)
{
    make_text_like(500);
    uint64_t hash = csg_shape_hash(region);
    const csg_outline *kept = csg_region_outline(region);
    assert_int_equal(kept->point_count, outline.point_count);
    assert_memory_equal(kept->points, outline.points, kept->point_count * sizeof *kept->points);
    csg_shape_retain(region);
    csg_shape_release(region);
    make_region();
    assert_true(csg_shape_hash(region) == hash);
    outline.points[3].x = nextafter(outline.points[3].x, 0);
    make_region();
    assert_true(csg_shape_hash(region) != hash);
}

static void nothing_and_nonsense(void **state)
{
    make_region();
    assert_true(csg_box_is_empty(region->box));
    assert_true(isinf(value_of(0, 0)) && value_of(0, 0) < 0);
    add_rectangle(&outline, 0, 0, 1, 1);
    outline.points[2].y = NAN;
    csg_shape *none = NULL;
    assert_int_equal(csg_region_create(&memory, &outline, &none), CSGM_ERR_SCENE);
    outline.points[2].y = -INFINITY;
    assert_int_equal(csg_region_create(&memory, &outline, &none), CSGM_ERR_SCENE);
    assert_null(none);
    for (int i = 0; i < 4; i++) /* no area at all */
        outline.points[i] = (csg_vec2){1, 1 + 1e-200 * i};
    make_region();
    assert_true(value_of(0, 0) < 0);
    for (int i = 0; i < 4; i++) /* there and back */
        outline.points[i] = (csg_vec2){i % 2, 0};
    make_region();
    assert_true(value_of(0.5, 0.5) == -0.5 && value_of(0.5, -0.5) == -0.5);
}

static void every_allocation_may_fail(void **state)
{
    csgm_status status = CSGM_ERR_MEMORY;
    long n = 0;
    add_star(&outline, &dice, (csg_vec2){0, 0}, 0.3, 1, 100, false);
    for (; status; n++) {
        failing_memory f;
        csg_shape *shape = NULL;
        failing_init(&f, n);
        status = csg_region_create(&f.memory, &outline, &shape);
        assert_int_equal(status, f.allocator.left < 0 ? CSGM_ERR_MEMORY : CSGM_OK);
        csg_shape_release(shape);
        assert_int_equal(f.allocator.live, 0);
    }
    assert_true(n > 8);
}

/* ---- speed -------------------------------------------------------------------------------- */

static double nanoseconds_a_point(double spread)
{
    enum { BATCH = 256, ROUNDS = 400 };
    static float x[ROUNDS][BATCH], y[ROUNDS][BATCH], z[BATCH], out[BATCH];
    for (int r = 0; r < ROUNDS; r++) {
        csg_vec2 p = outline.points[csg_random_below(&dice, (uint32_t)outline.point_count)];
        for (int i = 0; i < BATCH; i++) { /* a block's worth of points, all different */
            x[r][i] = (float)(p.x + spread * (i % 16 - 8 + csg_random_uniform(&dice, 0, 0.1)));
            y[r][i] = (float)(p.y + spread * (i / 16 - 8));
        }
    }
    clock_t start = clock();
    for (int r = 0; r < ROUNDS; r++)
        csg_shape_values(region, NULL, NULL, x[r], y[r], z, BATCH, out);
    return (double)(clock() - start) / CLOCKS_PER_SEC * 1e9 / (ROUNDS * BATCH);
}

static void points_are_quick(void **state)
{
    const int sizes[] = {100, 1000, 10000, 100000};
    for (int k = 0; k < 4; k++) {
        clock_t start = clock();
        make_text_like(sizes[k]);
        double seconds = (double)(clock() - start) / CLOCKS_PER_SEC;
        double near = nanoseconds_a_point(0.01), wide = nanoseconds_a_point(0.3);
        print_message("%6d segments: made in %.4f s; %.0f ns per point near, %.0f ns around\n",
                      (int)outline.point_count, seconds, near, wide);
        assert_true(near < 10000 && wide < 10000); /* all segments would be far more */
    }
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, begin, end)
    const struct CMUnitTest tests[] = {
        TEST(squares_are_what_they_are),
        TEST(stars_with_holes),
        TEST(small_and_large_and_far_off),
        TEST(lattice_polygons),
        TEST(scribbles),
        TEST(what_touches),
        TEST(strokes_on_one_line),
        TEST(crossings_by_a_rounding_error),
        TEST(differences_stay_below_distances),
        TEST(batches_are_their_points),
        TEST(cells_have_what_matters_there),
        TEST(triangles_beside),
        TEST(shapes_are_counted_and_named),
        TEST(nothing_and_nonsense),
        TEST(every_allocation_may_fail),
        TEST(points_are_quick),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
