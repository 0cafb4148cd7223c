/* SPDX-License-Identifier: MIT
 * Hulls: of boxes, balls and clouds; what has no volume is refused; the same every time.
 */
#include "shape/solid_support.h"

#include <string.h>

#include "shape/polyhedra/hull.h"

enum { MOST = 2000 };

static csg_memory memory;

static csgm_status hull(const csg_vec3 *points, size_t count, csg_triangles *out)
{
    csgm_status status = csg_hull(&memory, points, count, out);
    if (status != CSGM_OK)
        assert_true(out->count == 0 && memory.used_bytes == 0);
    return status;
}

/* Closed, outward, and no point is outside. */
static void check(const csg_vec3 *points, size_t count, csg_triangles *out, double size)
{
    csg_repairs repairs;
    csg_shape *shape;
    assert_int_equal(csg_polyhedron_create(&memory, out, &repairs, &shape), CSGM_OK);
    assert_true(repairs.flipped == 0 && repairs.holes == 0 && !repairs.inside_out);
    assert_true(csg_polyhedron_is_convex(shape));
    for (size_t i = 0; i < count; i++) {
        csg_vec3 gradient;
        assert_true(csg_shape_sample(shape, points[i], &gradient) > -1e-9 * size);
    }
    csg_shape_release(shape);
    csg_triangles_release(out);
    assert_int_equal(memory.used_bytes, 0);
}

static void test_box(void **state)
{
    csg_vec3 points[100];
    csg_triangles out;
    csg_random random = {21};
    for (int i = 0; i < 100; i++)
        points[i] = solid_random_point(&random, 1);
    for (int i = 0; i < 8; i++)
        points[40 + i] = csg_vec3_make(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
    assert_int_equal(hull(points, 100, &out), CSGM_OK);
    assert_int_equal(out.count, 12);
    assert_int_equal(out.point_count, 8);
    for (int i = 0; i < 8; i++) /* exactly, in the order of the input */
        assert_memory_equal(&out.points[i], &points[40 + i], sizeof *points);
    assert_true(fabs(solid_volume(&out) - 8) < 1e-12);
    check(points, 100, &out, 1);
}

static void test_clouds(void **state)
{
    static const double sizes[] = {1, 1e-30, 1e30, 1e100};
    static csg_vec3 points[MOST];
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
        csg_random random = {22 + k};
        csg_triangles out;
        for (int i = 0; i < MOST; i++) {
            points[i] = csg_vec3_scale(solid_random_point(&random, 1), sizes[k]);
            if (i % 2) /* on a ball, and some twice */
                points[i] = csg_vec3_scale(csg_vec3_normalize(points[i]), sizes[k]);
            if (i % 10 == 9)
                points[i] = points[i - 2];
        }
        assert_int_equal(hull(points, MOST, &out), CSGM_OK);
        check(points, MOST, &out, sizes[k]);
    }
}

/* Points of a lattice: many in every plane. */
static void test_lattice(void **state)
{
    static csg_vec3 points[1000];
    csg_triangles out;
    for (int i = 0; i < 1000; i++)
        points[i] = csg_vec3_make(0.1 * (i % 10), 0.1 * (i / 10 % 10), 0.1 * (i / 100));
    assert_int_equal(hull(points, 1000, &out), CSGM_OK);
    assert_true(fabs(solid_volume(&out) - 0.729) < 1e-9);
    check(points, 1000, &out, 1);
}

static void test_same_every_time(void **state)
{
    static csg_vec3 points[MOST];
    csg_random random = {23};
    csg_triangles out[2];
    for (int i = 0; i < MOST; i++)
        points[i] = csg_vec3_normalize(solid_random_point(&random, 1));
    for (int k = 0; k < 2; k++)
        assert_int_equal(csg_hull(&memory, points, MOST, &out[k]), CSGM_OK);
    assert_int_equal(out[0].count, out[1].count);
    assert_memory_equal(out[0].corners, out[1].corners, out[0].count * sizeof *out[0].corners);
    for (int k = 0; k < 2; k++)
        csg_triangles_release(&out[k]);
}

static void test_refused(void **state)
{
    csg_triangles out;
    csg_random random = {24};
    for (int kind = 0; kind < 7; kind++) {
        csg_vec3 points[50];
        for (int i = 0; i < 50; i++) {
            csg_vec3 p = solid_random_point(&random, 1);
            points[i] = kind == 0   ? csg_vec3_make(p.x, p.y, 0.5)
                        : kind == 1 ? csg_vec3_make(p.x, 2 * p.x, 3 * p.x)
                        : kind == 2 ? csg_vec3_make(1, 2, 3)
                        : kind == 3 ? csg_vec3_make(p.x, p.y, 0.3 * p.x + 0.7 * p.y)
                                    : p;
        }
        if (kind == 4)
            points[20].y = NAN;
        if (kind == 5)
            points[20].y = INFINITY;
        assert_int_equal(hull(points, kind == 6 ? 3 : 50, &out), CSGM_ERR_SCENE);
    }
    assert_int_equal(hull(NULL, 0, &out), CSGM_ERR_SCENE);
}

static void test_every_allocation_fails(void **state)
{
    csg_vec3 points[60];
    csg_random random = {25};
    for (int i = 0; i < 60; i++)
        points[i] = solid_random_point(&random, 1);
    csgm_status status = CSGM_ERR_MEMORY;
    for (long n = 0; status != CSGM_OK; n++) {
        failing_memory f;
        csg_triangles out;
        failing_init(&f, n);
        status = csg_hull(&f.memory, points, 60, &out);
        assert_true(status == CSGM_OK || status == CSGM_ERR_MEMORY);
        csg_triangles_release(&out);
        assert_int_equal(f.memory.used_bytes, 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_box),     cmocka_unit_test(test_clouds),
        cmocka_unit_test(test_lattice), cmocka_unit_test(test_same_every_time),
        cmocka_unit_test(test_refused), cmocka_unit_test(test_every_allocation_fails),
    };
    csg_memory_init(&memory, NULL, 0);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
