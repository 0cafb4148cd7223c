/* SPDX-License-Identifier: MIT
 * patch(): the field against the distance from a dense grid of points of the patch, for random
 * patches of all degrees from 1 to 3, and patches with a side that is one point.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/random.h"
#include "lang/bench_failing.h"
#include "lang/bench_fixture.h"
#include "scene/reference.h"

enum { TREES = 9, DENSE = 120, POINTS = 20 };

typedef struct patch {
    uint32_t rows, columns;
    csg_vec3 at[4][4];
    char scene[2048];
} patch;

static double sample(csg_vec3 p)
{
    csgm_status status = CSGM_OK;
    csg_sample s = csg_reference_eval(b.scene, p, &status);
    assert_int_equal(status, CSGM_OK);
    return s.value;
}

static void draw(patch *p, csg_random *random, bool pinched)
{
    p->rows = 2 + csg_random_below(random, 3);
    p->columns = 2 + csg_random_below(random, 3);
    int used = snprintf(p->scene, sizeof p->scene, "patch([");
    for (uint32_t i = 0; i < p->rows; i++)
        for (uint32_t k = 0; k < p->columns; k++) {
            csg_vec3 at = {4.0 * i, 4.0 * k, csg_random_uniform(random, -1.5, 1.5)};
            if (pinched && i == 0)
                at = csg_vec3_make(0, 2, 0);
            p->at[i][k] = at;
            used += snprintf(p->scene + used, sizeof p->scene - (size_t)used,
                             "%s[%.17g, %.17g, %.17g]%s",
                             k   ? ", "
                             : i ? ", ["
                                 : "[",
                             at.x, at.y, at.z, k + 1 == p->columns ? "]" : "");
        }
    snprintf(p->scene + used, sizeof p->scene - (size_t)used, "], 1);");
}

/* Bernstein's polynomials, up to degree 3. */
static double weight(uint32_t count, uint32_t i, double t)
{
    static const double choose[4][4] = {{1}, {1, 1}, {1, 2, 1}, {1, 3, 3, 1}};
    return choose[count - 1][i] * pow(t, i) * pow(1 - t, count - 1 - i);
}

static csg_vec3 place(const patch *p, double u, double v)
{
    csg_vec3 sum = {0, 0, 0};
    for (uint32_t i = 0; i < p->rows; i++)
        for (uint32_t k = 0; k < p->columns; k++)
            sum = csg_vec3_add(
                sum, csg_vec3_scale(p->at[i][k], weight(p->rows, i, u) * weight(p->columns, k, v)));
    return sum;
}

/* To the nearest point of the grid: at most by half a diagonal's square / (2 d) too much. */
static double distance(const patch *p, csg_vec3 q)
{
    double least = INFINITY;
    for (int i = 0; i <= DENSE; i++)
        for (int k = 0; k <= DENSE; k++) {
            csg_vec3 at = place(p, (double)i / DENSE, (double)k / DENSE);
            least = fmin(least, csg_vec3_norm(csg_vec3_sub(q, at)));
        }
    return least;
}

/* Cells of the grid are at most 0.2 long along a side: 0.1 from their corners, so the distance
 * is too large by 0.1^2 / (2 d) and less than 0.012 where it is 0.8. */
static void fields_are_distances(void **state)
{
    (void)state;
    uint32_t compared = 0;
    for (uint64_t n = 0; n < TREES; n++) {
        csg_random random = {n + 1};
        patch p;
        draw(&p, &random, n % 3 == 2);
        csgm_status status = bench_compile_bytes(&b, p.scene, strlen(p.scene), NULL);
        if (status != CSGM_OK)
            print_error("%s\n%s", p.scene, b.text);
        assert_int_equal(status, CSGM_OK);
        for (int i = 0; i < POINTS; i++) {
            csg_vec3 on =
                place(&p, csg_random_uniform(&random, 0, 1), csg_random_uniform(&random, 0, 1));
            csg_vec3 way = csg_vec3_make(csg_random_uniform(&random, -2, 2),
                                         csg_random_uniform(&random, -2, 2),
                                         csg_random_uniform(&random, -2, 2));
            csg_vec3 q = csg_vec3_add(on, way);
            double d = distance(&p, q);
            if (d < 0.8)
                continue;
            compared++;
            assert_true(sample(q) >= 1 - d - 0.0022 && sample(q) <= 1 - d + 0.0022 + 0.012);
        }
    }
    assert_true(compared > TREES * POINTS / 4);
}

static csgm_status attempt(bench *poor)
{
    static const char scene[] = "patch([[[0,0], [4,0]], [[0,4], [4,4,1]]], 1);";
    return bench_compile_bytes(poor, scene, sizeof scene - 1, NULL);
}

static void any_allocation_may_fail(void **state)
{
    (void)state;
    assert_true(bench_fail_every(attempt, 60, 12) > 20);
}

static void what_is_no_patch_is_refused(void **state)
{
    (void)state;
    const struct {
        const char *scene, *message;
    } cases[] = {
        {"patch([[[0,0], [1,0]]], 1);", "2 to 16 rows of 2 to 16"},
        {"patch([[[0,0], [1,0]], [[0,1]]], 1);", "row 1 has 1 points, row 0 has 2"},
        {"patch([[[0,0], [1,0]], [[0,1], 3]], 1);", "points[1][1] is not [x, y, z]"},
        {"patch([[[0,0], [9,0], [0,9]], [[0,9], [99,0], [9,9]]], 1e-3);", "needs a larger radius"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const char *scene = cases[i].scene;
        assert_int_not_equal(bench_compile_bytes(&b, scene, strlen(scene), NULL), CSGM_OK);
        if (!strstr(b.text, cases[i].message))
            print_error("%s\n%s", scene, b.text);
        assert_non_null(strstr(b.text, cases[i].message));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fields_are_distances),
        cmocka_unit_test(any_allocation_may_fail),
        cmocka_unit_test(what_is_no_patch_is_refused),
    };
    return cmocka_run_group_tests(tests, open_bench, close_bench);
}
