/* SPDX-License-Identifier: MIT
 * Faces with many corners: every triangle on the face's side, and together its area.
 */
#include "shape/solid_support.h"

static csg_memory memory;

static csg_vec3 normal_of(const csg_triangles *t, size_t i)
{
    csg_vec3 a = t->points[t->corners[i][0]];
    return csg_vec3_cross(csg_vec3_sub(t->points[t->corners[i][1]], a),
                          csg_vec3_sub(t->points[t->corners[i][2]], a));
}

/* Turned into space, either way round; `area` of the polygon. */
static void check_face(const double (*flat)[2], uint32_t count, double area)
{
    static const csg_vec3 across[][2] = {
        {{1, 0, 0}, {0, 1, 0}}, {{0, 1, 0}, {0, 0, 1}},      {{0, 0, 1}, {1, 0, 0}},
        {{0, 1, 0}, {1, 0, 0}}, {{0.6, 0.8, 0}, {0, 0, -1}}, {{0.6, 0, 0.8}, {0.8, 0, -0.6}}};
    for (size_t k = 0; k < sizeof across / sizeof *across; k++) {
        csg_triangles t;
        uint32_t corners[64];
        csg_triangles_init(&t, &memory);
        for (uint32_t i = 0; i < count; i++) {
            csg_vec3 p = csg_vec3_add(csg_vec3_scale(across[k][0], flat[i][0]),
                                      csg_vec3_scale(across[k][1], flat[i][1]));
            assert_true(csg_triangles_add_point(&t, p));
            corners[i] = i;
        }
        assert_true(csg_triangles_add_face(&t, corners, count));
        assert_int_equal(t.count, count - 2);
        csg_vec3 up = csg_vec3_cross(across[k][0], across[k][1]);
        double sum = 0;
        for (size_t i = 0; i < t.count; i++) {
            double part = csg_vec3_dot(normal_of(&t, i), up) / 2;
            assert_true(part > -1e-12);
            sum += part;
        }
        assert_true(fabs(sum - area) < 1e-9);
        csg_triangles_release(&t);
        assert_int_equal(memory.used_bytes, 0);
    }
}

static double polygon_area(const double (*flat)[2], uint32_t count)
{
    double sum = 0;
    for (uint32_t i = 0, j = count - 1; i < count; j = i++)
        sum += flat[j][0] * flat[i][1] - flat[i][0] * flat[j][1];
    return sum / 2;
}

static void test_faces(void **state)
{
    static const double square[][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    static const double arrow[][2] = {{0, 0}, {2, -1}, {1, 0}, {2, 1}};
    static const double letter_l[][2] = {{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}};
    static const double comb[][2] = {{0, 0}, {7, 0}, {7, 3}, {6, 3}, {6, 1}, {5, 1},
                                     {5, 3}, {4, 3}, {4, 1}, {3, 1}, {3, 3}, {2, 3},
                                     {2, 1}, {1, 1}, {1, 3}, {0, 3}};
    static const double on_line[][2] = {{0, 0}, {1, 0}, {2, 0}, {2, 2}, {1, 2}, {0, 2}, {0, 1}};
    /* an outline with a hole, joined by a bridge that is run both ways */
    static const double bridged[][2] = {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0},
                                        {1, 1}, {1, 3}, {3, 3}, {3, 1}, {1, 1}};
    check_face(square, 4, 1);
    check_face(arrow, 4, polygon_area(arrow, 4));
    check_face(letter_l, 6, 5);
    check_face(comb, 16, polygon_area(comb, 16));
    check_face(on_line, 7, 4);
    check_face(bridged, 10, 12);
}

/* Of two diagonals the one that OpenSCAD takes, whatever corner is the first. */
static void test_quad_that_is_not_flat(void **state)
{
    (void)state;
    const csg_vec3 quads[][4] = {{{0, 0, 0}, {3, 0, 1}, {5, 5, 0}, {0, 3, 1}},   /* 1 to 3 */
                                 {{-2, -2, 1}, {3, 0, 0}, {4, 4, 1}, {0, 3, 0}}, /* 1 to 3 */
                                 {{1, 1, 9}, {4, 0, 0}, {3, 3, 0}, {0, 4, 0}}};  /* 0 to 2 */
    const uint32_t ends[] = {1, 1, 0};
    for (size_t q = 0; q < sizeof quads / sizeof *quads; q++)
        for (uint32_t turn = 0; turn < 4; turn++) {
            csg_triangles t;
            uint32_t corners[4], shared[4] = {0};
            csg_triangles_init(&t, &memory);
            for (uint32_t i = 0; i < 4; i++) {
                assert_true(csg_triangles_add_point(&t, quads[q][i]));
                corners[i] = (i + turn) % 4;
            }
            assert_true(csg_triangles_add_face(&t, corners, 4));
            assert_int_equal(t.count, 2);
            for (size_t i = 0; i < 6; i++)
                shared[t.corners[i / 3][i % 3]]++;
            assert_int_equal(shared[ends[q]], 2);
            assert_int_equal(shared[ends[q] + 2], 2);
            csg_triangles_release(&t);
        }
}

static void test_random_stars(void **state)
{
    csg_random random = {31};
    for (int k = 0; k < 100; k++) {
        double flat[40][2];
        uint32_t count = 4 + csg_random_below(&random, 36);
        for (uint32_t i = 0; i < count; i++) {
            double r = csg_random_uniform(&random, 0.3, 1.5), a = 2 * M_PI * i / count;
            flat[i][0] = r * cos(a);
            flat[i][1] = r * sin(a);
        }
        check_face((const double(*)[2])flat, count, polygon_area((const double(*)[2])flat, count));
    }
}

/* No plane, no area, one point again and again: triangles all the same. */
static void test_bad_faces(void **state)
{
    csg_random random = {32};
    for (int kind = 0; kind < 3; kind++) {
        csg_triangles t;
        uint32_t corners[50];
        csg_triangles_init(&t, &memory);
        for (uint32_t i = 0; i < 50; i++) {
            csg_vec3 p = solid_random_point(&random, 1);
            if (kind == 1)
                p = csg_vec3_make(p.x, 0, 0);
            assert_true(csg_triangles_add_point(&t, p));
            corners[i] = kind == 2 ? 7 : i;
        }
        assert_true(csg_triangles_add_face(&t, corners, 50));
        assert_int_equal(t.count, 48);
        csg_triangles_release(&t);
    }
}

/* A comb of 40 000 corners is no matter of minutes. */
static void test_large_face(void **state)
{
    enum { TEETH = 10000 };
    csg_triangles t;
    csg_triangles_init(&t, &memory);
    uint32_t *corners = csg_memory_alloc(&memory, 4 * TEETH * sizeof *corners);
    for (uint32_t i = 0; i < TEETH; i++) {
        csg_triangles_add_point(&t, csg_vec3_make(i, 1, 0));
        csg_triangles_add_point(&t, csg_vec3_make(i, 0, 0));
        csg_triangles_add_point(&t, csg_vec3_make(i + 0.5, 0, 0));
        csg_triangles_add_point(&t, csg_vec3_make(i + 0.5, 1, 0));
    }
    for (uint32_t i = 0; i < 4 * TEETH; i++)
        corners[i] = i;
    assert_true(csg_triangles_add_face(&t, corners, 4 * TEETH));
    assert_int_equal(t.count, 4 * TEETH - 2);
    csg_memory_release(&memory, corners, 4 * TEETH * sizeof *corners);
    csg_triangles_release(&t);
    assert_int_equal(memory.used_bytes, 0);
}

static void test_every_allocation_fails(void **state)
{
    bool done = false;
    for (long n = 0; !done; n++) {
        failing_memory f;
        csg_triangles t;
        static const uint32_t corners[4] = {0, 1, 2, 3};
        failing_init(&f, n);
        csg_triangles_init(&t, &f.memory);
        done = csg_triangles_add_point(&t, csg_vec3_make(0, 0, 0)) &&
               csg_triangles_add_point(&t, csg_vec3_make(2, -1, 0)) &&
               csg_triangles_add_point(&t, csg_vec3_make(1, 0, 0)) &&
               csg_triangles_add_point(&t, csg_vec3_make(2, 1, 0)) &&
               csg_triangles_add_face(&t, corners, 4);
        csg_triangles_release(&t);
        assert_int_equal(f.memory.used_bytes, 0);
        assert_true(n < 10);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_faces),        cmocka_unit_test(test_quad_that_is_not_flat),
        cmocka_unit_test(test_random_stars), cmocka_unit_test(test_bad_faces),
        cmocka_unit_test(test_large_face),   cmocka_unit_test(test_every_allocation_fails),
    };
    csg_memory_init(&memory, NULL, 0);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
