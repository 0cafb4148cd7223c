/* SPDX-License-Identifier: MIT
 * Boxes, affine maps, their inverses and singular values, on seeded random matrices and on the
 * cases that must come out exact.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/geometry.h"
#include "base/random.h"

static void near(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%.17g is not within %g of %.17g", value, tolerance, expected);
}

static csg_vec3 random_point(csg_random *random, double reach)
{
    return csg_vec3_make(csg_random_uniform(random, -reach, reach),
                         csg_random_uniform(random, -reach, reach),
                         csg_random_uniform(random, -reach, reach));
}

static csg_affine random_affine(csg_random *random)
{
    csg_affine a;
    for (int i = 0; i < 3; i++) {
        a.t[i] = csg_random_uniform(random, -3, 3);
        for (int j = 0; j < 3; j++)
            a.m[i][j] = csg_random_uniform(random, -1, 1);
    }
    return a;
}

static void near_vec3(csg_vec3 value, csg_vec3 expected, double tolerance)
{
    near(value.x, expected.x, tolerance);
    near(value.y, expected.y, tolerance);
    near(value.z, expected.z, tolerance);
}

/* ---- boxes ------------------------------------------------------------------------------ */

static void test_empty_and_all(void **state)
{
    csg_box empty = csg_box_empty(), all = csg_box_all(), one = {{0, 0, 0}, {1, 2, 3}};
    assert_true(csg_box_is_empty(empty) && !csg_box_is_empty(all) && !csg_box_is_empty(one));
    assert_false(csg_box_is_finite(empty));
    assert_false(csg_box_is_finite(all));
    assert_true(csg_box_is_finite(one));
    assert_true(csg_box_contains_box(all, one) && csg_box_contains_box(one, empty));
    assert_false(csg_box_contains_box(one, all));
    near_vec3(csg_box_hull(one, empty).min, one.min, 0);
    near_vec3(csg_box_hull(empty, one).max, one.max, 0);
    assert_true(csg_box_is_empty(csg_box_grow(empty, 10)));
    assert_true(csg_box_is_empty(csg_box_grow(empty, INFINITY)));
    assert_true(csg_box_contains_box(csg_box_grow(one, INFINITY), all));
    csg_box apart = {{2, 0, 0}, {3, 1, 1}};
    assert_true(csg_box_is_empty(csg_box_intersect(one, apart)));
    near_vec3(csg_box_size(empty), csg_vec3_make(0, 0, 0), 0);
    near(csg_box_longest_side(one), 3, 0);
    near(csg_box_longest_side(empty), 0, 0);
    assert_true(isinf(csg_box_longest_side(all)));
    near_vec3(csg_box_center(one), csg_vec3_make(0.5, 1, 1.5), 0);
    csg_box nan = {{NAN, 0, 0}, {1, 1, 1}};
    assert_true(csg_box_is_empty(nan));
}

/* b(x) of the paper's table. */
static void test_box_field(void **state)
{
    csg_box box = {{0, 0, 0}, {1, 2, 3}};
    near(csg_box_field(box, csg_vec3_make(0.5, 0.5, 0.5)), 0.5, 0);
    near(csg_box_field(box, csg_vec3_make(0.25, 1, 1.5)), 0.25, 0);
    near(csg_box_field(box, csg_vec3_make(2, 1, 1)), -1, 0);
    near(csg_box_field(box, csg_vec3_make(2, 3, 1)), -1.414213562373, 1e-12);
    near(csg_box_field(box, csg_vec3_make(-1, -2, 5)), -3, 0);
    near(csg_box_field(box, csg_vec3_make(1, 2, 3)), 0, 0);
    assert_true(csg_box_field(csg_box_empty(), csg_vec3_make(0, 0, 0)) == -INFINITY);
    assert_true(csg_box_field(csg_box_all(), csg_vec3_make(0, 0, 0)) == INFINITY);
}

static void test_box_of_image(void **state)
{
    csg_random random = {1};
    for (int i = 0; i < 300; i++) {
        csg_affine a = random_affine(&random);
        csg_vec3 p = random_point(&random, 1), half = {0.5, 0.25, 1};
        csg_box box = {csg_vec3_sub(p, half), csg_vec3_add(p, half)}, image, seen;
        image = csg_affine_box(&a, box);
        seen = csg_box_empty();
        for (int corner = 0; corner < 8; corner++) {
            csg_vec3 c = {corner & 1 ? box.min.x : box.max.x, corner & 2 ? box.min.y : box.max.y,
                          corner & 4 ? box.min.z : box.max.z};
            csg_vec3 q = csg_affine_point(&a, c);
            seen = csg_box_hull(seen, (csg_box){q, q});
        }
        near_vec3(image.min, seen.min, 1e-14);
        near_vec3(image.max, seen.max, 1e-14);
    }
}

static void test_box_of_infinite_image(void **state)
{
    csg_box slab = csg_box_all();
    slab.max.z = 1;
    csg_affine turn = csg_affine_rotate(90, csg_vec3_make(1, 0, 0)); /* z to -y */
    csg_box image = csg_affine_box(&turn, slab);
    assert_true(image.min.y == -1 && image.max.y == INFINITY);
    assert_true(image.min.x == -INFINITY && image.max.z == INFINITY);
    turn = csg_affine_rotate(30, csg_vec3_make(1, 0, 0));
    assert_true(csg_box_contains_box(csg_affine_box(&turn, slab), csg_box_all()));
    assert_true(csg_box_is_empty(csg_affine_box(&turn, csg_box_empty())));
}

/* ---- maps ------------------------------------------------------------------------------- */

static void test_quarter_turns_are_exact(void **state)
{
    const csg_vec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int axis = 0; axis < 3; axis++) {
        for (int quarter = -9; quarter <= 9; quarter++) {
            csg_affine a = csg_affine_rotate(90.0 * quarter, axes[axis]);
            for (int i = 0; i < 3; i++)
                for (int j = 0; j < 3; j++)
                    assert_true(a.m[i][j] == 0 || fabs(a.m[i][j]) == 1);
        }
    }
    csg_affine a = csg_affine_rotate(90, axes[2]);
    near_vec3(csg_affine_point(&a, csg_vec3_make(1, 0, 0)), csg_vec3_make(0, 1, 0), 0);
    a = csg_affine_rotate(90, axes[0]);
    near_vec3(csg_affine_point(&a, csg_vec3_make(0, 1, 0)), csg_vec3_make(0, 0, 1), 0);
    a = csg_affine_rotate(-30, axes[1]);
    near_vec3(csg_affine_point(&a, csg_vec3_make(1, 0, 0)), csg_vec3_make(sqrt(0.75), 0, 0.5),
              1e-15);
}

static void test_mirror_and_z_to(void **state)
{
    csg_random random = {2};
    csg_affine flip = csg_affine_mirror(csg_vec3_make(3, 0, 0));
    near_vec3(csg_affine_point(&flip, csg_vec3_make(1, 2, 3)), csg_vec3_make(-1, 2, 3), 0);
    for (int i = 0; i < 100; i++) {
        csg_vec3 to = random_point(&random, 2);
        csg_affine a = csg_affine_z_to(to);
        near_vec3(csg_affine_vector(&a, csg_vec3_make(0, 0, 1)), csg_vec3_normalize(to), 1e-15);
        near(csg_affine_determinant(a), 1, 1e-14);
        assert_true(csg_affine_is_similarity(&a));
    }
    csg_affine down = csg_affine_z_to(csg_vec3_make(0, 0, -2));
    near_vec3(csg_affine_vector(&down, csg_vec3_make(0, 0, 1)), csg_vec3_make(0, 0, -1), 0);
}

static void test_inverse(void **state)
{
    csg_random random = {3};
    for (int i = 0; i < 300; i++) {
        csg_affine a = random_affine(&random), inverse;
        if (fabs(csg_affine_determinant(a)) < 0.01)
            continue;
        assert_true(csg_affine_invert(a, &inverse));
        csg_vec3 p = random_point(&random, 2), q = csg_affine_point(&a, p);
        near_vec3(csg_affine_point(&inverse, q), p, 1e-12);
        csg_affine both = csg_affine_multiply(a, inverse);
        near_vec3(csg_affine_point(&both, p), p, 1e-12);
        csg_vec3 n = random_point(&random, 1); /* transpose */
        near(csg_vec3_dot(csg_affine_covector(&a, n), p), csg_vec3_dot(n, csg_affine_vector(&a, p)),
             1e-14);
    }
    csg_affine flat = csg_affine_scale(csg_vec3_make(1, 0, 1)), inverse;
    assert_false(csg_affine_invert(flat, &inverse));
    flat.m[1][1] = NAN;
    assert_false(csg_affine_invert(flat, &inverse));
}

static void test_singular_values(void **state)
{
    csg_random random = {4};
    for (int i = 0; i < 300; i++) {
        double s[3];
        for (int k = 0; k < 3; k++)
            s[k] = pow(10, csg_random_uniform(&random, -6, 6));
        csg_affine a = csg_affine_scale(csg_vec3_make(s[0], s[1], s[2]));
        csg_affine u = csg_affine_z_to(random_point(&random, 1));
        csg_affine v = csg_affine_z_to(random_point(&random, 1));
        a = csg_affine_multiply(u, csg_affine_multiply(a, v));
        double smallest, largest, least = fmin(s[0], fmin(s[1], s[2]));
        double most = fmax(s[0], fmax(s[1], s[2]));
        csg_affine_singular_values(&a, &smallest, &largest);
        near(largest, most, 1e-13 * most);
        near(smallest, least, 1e-13 * most);
    }
}

static void test_singular_values_bound_lengths(void **state)
{
    csg_random random = {5};
    for (int i = 0; i < 300; i++) {
        csg_affine a = random_affine(&random);
        double smallest, largest;
        csg_affine_singular_values(&a, &smallest, &largest);
        for (int k = 0; k < 50; k++) {
            csg_vec3 v = csg_vec3_normalize(random_point(&random, 1));
            double length = csg_vec3_norm(csg_affine_vector(&a, v));
            assert_true(length >= smallest - 1e-14 && length <= largest + 1e-14);
        }
    }
}

static void test_similarity(void **state)
{
    csg_affine turn = csg_affine_rotate(33, csg_vec3_normalize(csg_vec3_make(1, 2, 3)));
    csg_affine grow = csg_affine_scale(csg_vec3_make(2, 2, -2));
    csg_affine stretch = csg_affine_scale(csg_vec3_make(2, 2, 2.001));
    grow = csg_affine_multiply(turn, grow);
    stretch = csg_affine_multiply(turn, stretch);
    assert_true(csg_affine_is_similarity(&grow));
    assert_false(csg_affine_is_similarity(&stretch));
}

static void test_normalize_zero(void **state)
{
    near_vec3(csg_vec3_normalize(csg_vec3_make(0, 0, 0)), csg_vec3_make(0, 0, 0), 0);
    near_vec3(csg_vec3_cross(csg_vec3_make(1, 0, 0), csg_vec3_make(0, 1, 0)),
              csg_vec3_make(0, 0, 1), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_empty_and_all),
        cmocka_unit_test(test_box_field),
        cmocka_unit_test(test_box_of_image),
        cmocka_unit_test(test_box_of_infinite_image),
        cmocka_unit_test(test_quarter_turns_are_exact),
        cmocka_unit_test(test_mirror_and_z_to),
        cmocka_unit_test(test_inverse),
        cmocka_unit_test(test_singular_values),
        cmocka_unit_test(test_singular_values_bound_lengths),
        cmocka_unit_test(test_similarity),
        cmocka_unit_test(test_normalize_zero),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
