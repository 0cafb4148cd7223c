/* SPDX-License-Identifier: MIT
 * Principal moments and axes of known ones: random matrices of known eigenvalues and eigenvectors,
 * moved within their bounds, are held; the nearer two moments are, the less of the axes is known.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
/* cmocka wants the four above first */
#include <cmocka.h>

#include <math.h>

#include "base/geometry.h"
#include "base/random.h"
#include "measure/principal.h"

enum { MATRICES = 20000 };
static const double DEG = 57.295779513082323;
static const int ROW[6] = {0, 1, 2, 0, 0, 1}, COLUMN[6] = {0, 1, 2, 1, 2, 2};

static void random_axes(csg_random *random, csg_vec3 axes[3])
{
    csg_vec3 a, b;
    do {
        a = csg_vec3_make(csg_random_uniform(random, -1, 1), csg_random_uniform(random, -1, 1),
                          csg_random_uniform(random, -1, 1));
        b = csg_vec3_make(csg_random_uniform(random, -1, 1), csg_random_uniform(random, -1, 1),
                          csg_random_uniform(random, -1, 1));
    } while (csg_vec3_norm(csg_vec3_cross(a, b)) < 0.1);
    axes[0] = csg_vec3_normalize(a);
    axes[2] = csg_vec3_normalize(csg_vec3_cross(a, b));
    axes[1] = csg_vec3_cross(axes[2], axes[0]);
}

static double component(csg_vec3 v, int k)
{
    return k == 0 ? v.x : k == 1 ? v.y : v.z;
}

/* The components of the matrix with these eigenvalues, each anywhere between bounds of a width. */
static void bounds_of(csg_random *random, const csg_vec3 axes[3], const double moments[3],
                      double width, csgm_interval inertia[6])
{
    for (int n = 0; n < 6; n++) {
        double value = 0;
        for (int k = 0; k < 3; k++)
            value += moments[k] * component(axes[k], ROW[n]) * component(axes[k], COLUMN[n]);
        double share = csg_random_uniform(random, 0, 1);
        inertia[n] = (csgm_interval){value - share * width, value + (1 - share) * width};
    }
}

static void test_known_ones_are_held(void **state)
{
    csg_random random = {811};
    uint32_t told = 0, near = 0;
    for (int i = 0; i < MATRICES; i++) {
        csg_vec3 axes[3];
        csgm_measures m = csgm_measures_default();
        double size = ldexp(1, (int)csg_random_uniform(&random, -30, 30)), moments[3];
        random_axes(&random, axes);
        moments[0] = size * csg_random_uniform(&random, 0.1, 1);
        for (int k = 1; k < 3; k++)
            moments[k] = moments[k - 1] + size * ldexp(1, -(int)csg_random_uniform(&random, 0, 40));
        double width = size * ldexp(1, -(int)csg_random_uniform(&random, 5, 45));
        bounds_of(&random, axes, moments, width, m.inertia);
        csg_measure_principal(&m);
        for (int k = 0; k < 3; k++) {
            double cosine = fabs(csg_vec3_dot(m.axes[k], axes[k]));
            double sine = csg_vec3_norm(csg_vec3_cross(m.axes[k], axes[k]));
            assert_true(m.moments[k].low <= moments[k] * (1 + 0x1p-50));
            assert_true(m.moments[k].high >= moments[k] * (1 - 0x1p-50));
            assert_true(m.moments[k].high - m.moments[k].low <= 6 * width + 1e-12 * size);
            assert_true(atan2(sine, cosine) * DEG <= m.axis_within[k] + 1e-13);
            assert_true(fabs(csg_vec3_norm(m.axes[k]) - 1) < 1e-15);
            told += m.axis_within[k] < 90;
            near += m.axis_within[k] < 0.01;
        }
    }
    assert_true(told > MATRICES && told < 3 * MATRICES);
    assert_true(near > MATRICES / 10);
}

static void test_unknown(void **state)
{
    csgm_measures m = csgm_measures_default();
    for (int n = 0; n < 6; n++)
        m.inertia[n] = (csgm_interval){n < 3 ? 1 : -0.0, n < 3 ? 1 : 0};
    csg_measure_principal(&m);
    for (int k = 0; k < 3; k++) {
        assert_true(m.moments[k].low <= 1 && m.moments[k].high >= 1);
        assert_true(m.axis_within[k] >= 90);
    }
    m.inertia[4].high = INFINITY;
    csg_measure_principal(&m);
    for (int k = 0; k < 3; k++)
        assert_true(isinf(m.moments[k].low) && isinf(m.moments[k].high) && m.axis_within[k] >= 90);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_known_ones_are_held),
        cmocka_unit_test(test_unknown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
