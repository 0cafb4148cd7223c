/* SPDX-License-Identifier: MIT
 * Doubtful edges among samples: one at any place of any line is found, and where it is. What is
 * kept of a block's samples comes back.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/context.h"
#include "grid/octree/block.h"

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

/* Of a plane that cuts the block askew: which signs are those of the values, and the values at both
 * ends of every crossed edge. */
static void put_plane(csg_block *block, csg_block_samples *samples)
{
    block->ends = NULL;
    for (int k = 0; k < MOST; k++)
        for (int j = 0; j < MOST; j++) {
            block->inside[k][j] = 0;
            for (int i = 0; i < MOST; i++) {
                float f = (float)i + 0.5f * (float)j - 0.25f * (float)k - 3.1f;
                samples->values[(k * MOST + j) * MOST + i] = f;
                block->inside[k][j] |= (uint16_t)((f >= 0) << i);
            }
        }
}

static bool is_inside(const csg_block *block, int at)
{
    return block->inside[at / (MOST * MOST)][at / MOST % MOST] >> at % MOST & 1;
}

static void check_ends(const csg_block *block, const csg_block_samples *samples)
{
    float back[CSG_BLOCK_POINTS];
    int crossed = 0;
    csg_block_unpack_ends(block, back);
    for (int axis = 0; axis < 3; axis++)
        for (int at = 0; at < CSG_BLOCK_POINTS; at++) {
            int step = (int)step_of(MOST, axis), other = at + step;
            if (at / step % MOST == MOST - 1 || is_inside(block, at) == is_inside(block, other))
                continue;
            assert_true(back[at] == samples->values[at] && back[other] == samples->values[other]);
            crossed++;
        }
    assert_true(crossed > 100);
}

/* None are kept where one is not known or its sign was changed, if it is beside the surface. */
static void test_ends(void **state)
{
    enum { BESIDE = 3, FAR_AWAY = 8 };
    static csg_block block;
    static csg_block_samples samples;
    csg_memory memory;
    csg_arena arena;
    (void)state;
    csg_memory_init(&memory, NULL, 0);
    csg_arena_init(&arena, &memory);
    put_plane(&block, &samples);
    samples.values[FAR_AWAY] = NAN;
    assert_true(csg_block_keep_ends(&block, &samples, &arena) && block.ends);
    check_ends(&block, &samples);
    put_plane(&block, &samples);
    samples.values[BESIDE] = NAN;
    assert_true(csg_block_keep_ends(&block, &samples, &arena) && !block.ends);
    put_plane(&block, &samples);
    block.inside[0][0] ^= 1 << BESIDE;
    assert_true(csg_block_keep_ends(&block, &samples, &arena) && !block.ends);
    csg_arena_reset(&arena);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_one_edge),
        cmocka_unit_test(test_sheet),
        cmocka_unit_test(test_crossed),
        cmocka_unit_test(test_ends),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
