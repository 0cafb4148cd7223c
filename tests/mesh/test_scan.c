/* SPDX-License-Identifier: MIT
 * Doubtful edges among samples: one at any place of any line is found, and where it is.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "grid/octree/scan.h"

enum { MOST = 9 };

static const size_t EDGES[] = {5, MOST};
static const uint32_t FIRST[3] = {8, 16, 40};
static const float FAR = 5;

static size_t step_of(size_t n, int axis)
{
    return axis == 0 ? 1 : axis == 1 ? n : n * n;
}

/* f falls along a line from both sides to an edge's ends, by more than they are from zero. */
static void put_valley(float *f, size_t n, int axis, size_t begin, size_t at, float sign)
{
    for (size_t i = 0; i < n; i++) {
        size_t away = i < at ? at - i : i > at + 1 ? i - at - 1 : 0;
        f[begin + i * step_of(n, axis)] = sign * (0.3f + 1.2f * (float)away);
    }
}

static void fill(float *f, size_t n, float value)
{
    for (size_t i = 0; i < n * n * n; i++)
        f[i] = value;
}

static void check_line(float *f, size_t n, int axis, const size_t across[2], size_t at, float sign)
{
    csg_scan scan = {.span = 1};
    int u = (axis + 1) % 3, v = (axis + 2) % 3;
    fill(f, n, sign * FAR);
    put_valley(f, n, axis, across[0] * step_of(n, u) + across[1] * step_of(n, v), at, sign);
    csg_scan_values(&scan, f, n, FIRST);
    assert_int_equal(scan.count, 1);
    assert_true(scan.doubt > 0);
    assert_int_equal(scan.axis, axis);
    assert_int_equal(scan.is_inside, sign > 0);
    assert_int_equal(scan.point[axis], FIRST[axis] + at);
    assert_int_equal(scan.point[u], FIRST[u] + across[0]);
    assert_int_equal(scan.point[v], FIRST[v] + across[1]);
}

static void test_one_edge(void **state)
{
    float f[MOST * MOST * MOST];
    (void)state;
    for (size_t k = 0; k < sizeof EDGES / sizeof *EDGES; k++)
        for (int axis = 0; axis < 3; axis++)
            for (size_t line = 0; line < EDGES[k] * EDGES[k]; line++)
                for (size_t at = 0; at + 1 < EDGES[k]; at++) {
                    const size_t across[2] = {line % EDGES[k], line / EDGES[k]};
                    check_line(f, EDGES[k], axis, across, at, line % 2 ? 1.0f : -1.0f);
                }
}

/* A sheet between two planes of samples: an edge of every line. */
static void test_sheet(void **state)
{
    float f[MOST * MOST * MOST];
    (void)state;
    for (int axis = 0; axis < 3; axis++)
        for (size_t at = 0; at + 1 < MOST; at++) {
            csg_scan scan = {.span = 1};
            int u = (axis + 1) % 3, v = (axis + 2) % 3;
            for (size_t line = 0; line < MOST * MOST; line++)
                put_valley(f, MOST, axis,
                           line % MOST * step_of(MOST, u) + line / MOST * step_of(MOST, v), at, -1);
            csg_scan_values(&scan, f, MOST, FIRST);
            assert_int_equal(scan.count, MOST * MOST);
            assert_int_equal(scan.axis, axis);
            assert_int_equal(scan.point[axis], FIRST[axis] + at);
        }
}

/* What crosses the lattice's edges is in the mesh. */
static void test_crossed(void **state)
{
    float f[MOST * MOST * MOST];
    (void)state;
    for (int axis = 0; axis < 3; axis++)
        for (int quarter = 1; quarter < 4 * (MOST - 1); quarter++) {
            csg_scan scan = {.span = 1};
            for (size_t i = 0; i < MOST * MOST * MOST; i++)
                f[i] = (float)(i / step_of(MOST, axis) % MOST) - 0.25f * (float)quarter;
            csg_scan_values(&scan, f, MOST, FIRST);
            assert_int_equal(scan.count, 0);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_one_edge),
        cmocka_unit_test(test_sheet),
        cmocka_unit_test(test_crossed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
