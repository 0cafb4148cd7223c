/* SPDX-License-Identifier: MIT
 * Signs of determinants against integers of 128 bits, also where points lie on a line, in a plane
 * or next to it. (tests/mesh/test_crossings.c asks CGAL about floats of very different sizes.)
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/orient.h"
#include "base/random.h"

__extension__ typedef __int128 wide;

enum { CASES = 100000 };

static int sign_of(wide x)
{
    return (x > 0) - (x < 0);
}

static int32_t draw(csg_random *random, int bits)
{
    return (int32_t)csg_random_below(random, 1u << bits) - (1 << (bits - 1));
}

static void test_plane(void **state)
{
    csg_random random = {3};
    for (int i = 0; i < CASES; i++) {
        int64_t v[6];
        for (int k = 0; k < 6; k++)
            v[k] = draw(&random, 30);
        if (i % 2) { /* nearly on a line */
            v[4] = v[0] + 2 * (v[2] - v[0]) + csg_random_below(&random, 2);
            v[5] = v[1] + 2 * (v[3] - v[1]);
        }
        int64_t det = (v[2] - v[0]) * (v[5] - v[1]) - (v[3] - v[1]) * (v[4] - v[0]);
        csg_vec2 a = {(double)v[0], (double)v[1]}, b = {(double)v[2], (double)v[3]},
                 c = {(double)v[4], (double)v[5]};
        assert_int_equal(csg_orient_plane(a, b, c), sign_of(det));
    }
}

/* p: four points, each a whole number of steps; the last one is a + s (b - a) + t (c - a), moved by
 * a step or by none. */
static void draw_points(csg_random *random, bool flat, int64_t p[4][3])
{
    for (int k = 0; k < 4; k++)
        for (int axis = 0; axis < 3; axis++)
            p[k][axis] = draw(random, flat ? 20 : 23);
    int64_t s = draw(random, 2), t = draw(random, 2);
    for (int axis = 0; axis < 3 && flat; axis++)
        p[3][axis] = p[0][axis] + s * (p[1][axis] - p[0][axis]) + t * (p[2][axis] - p[0][axis]);
    if (flat)
        p[3][csg_random_below(random, 3)] += csg_random_below(random, 2);
}

static void test_space(void **state)
{
    csg_random random = {5};
    int seen[3] = {0, 0, 0};
    for (int i = 0; i < CASES; i++) {
        int64_t p[4][3];
        float at[4][3];
        wide e[3][3];
        draw_points(&random, i % 2, p);
        for (int k = 0; k < 4; k++)
            for (int axis = 0; axis < 3; axis++) {
                at[k][axis] = (float)p[k][axis]; /* exact: at most 24 bits */
                if (k)
                    e[k - 1][axis] = p[k][axis] - p[0][axis];
            }
        wide det = e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) -
                   e[0][1] * (e[1][0] * e[2][2] - e[1][2] * e[2][0]) +
                   e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0]);
        int sign = csg_orient_space(at[0], at[1], at[2], at[3]);
        assert_int_equal(sign, sign_of(det));
        assert_int_equal(csg_orient_space_exactly(at[0], at[1], at[2], at[3]), sign);
        seen[sign + 1]++;
        for (int axis = 0; axis < 3; axis++) {
            int j = (axis + 1) % 3, k = (axis + 2) % 3;
            int turn = csg_orient_along(at[0], at[1], at[3], axis);
            assert_int_equal(turn, sign_of(e[0][j] * e[2][k] - e[0][k] * e[2][j]));
            assert_int_equal(csg_orient_along_exactly(at[0], at[1], at[3], axis), turn);
        }
    }
    assert_true(seen[0] > CASES / 5 && seen[1] > CASES / 10 && seen[2] > CASES / 5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_plane), cmocka_unit_test(test_space)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
