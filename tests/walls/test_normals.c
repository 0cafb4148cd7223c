/* SPDX-License-Identifier: MIT
 * Cones of normals: what is said to be apart is, of random combinations; and what is seen at once.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
/* cmocka wants the four above first */
#include <cmocka.h>

#include <math.h>

#include "base/random.h"
#include "walls/normals.h"

enum { MOST = 4, SETS = 400, SAMPLES = 60 };

static csg_vec3 random_direction(csg_random *dice)
{
    csg_vec3 v;
    do {
        double x = csg_random_uniform(dice, -1, 1), y = csg_random_uniform(dice, -1, 1);
        v = csg_vec3_make(x, y, csg_random_uniform(dice, -1, 1));
    } while (!(csg_vec3_norm(v) > 0.1 && csg_vec3_norm(v) < 1));
    return csg_vec3_normalize(v);
}

static csg_wall_normals random_normals(csg_random *dice, csg_wall_cap caps[MOST])
{
    csg_vec3 around = random_direction(dice);
    double spread = csg_random_uniform(dice, 0, 1.5);
    csg_wall_normals n = {1 + csg_random_below(dice, MOST), caps};
    for (uint32_t i = 0; i < n.count; i++) {
        csg_vec3 off = csg_vec3_scale(random_direction(dice), spread);
        csg_vec3 at = csg_vec3_normalize(csg_vec3_add(around, off));
        caps[i] = (csg_wall_cap){{at.x, at.y, at.z}, csg_random_uniform(dice, 0, 0.3)};
    }
    return n;
}

/* Some combination of some vectors in the caps. */
static csg_vec3 random_member(csg_random *dice, const csg_wall_normals *n)
{
    csg_vec3 sum = {0, 0, 0};
    for (uint32_t i = 0; i < n->count; i++) {
        const csg_wall_cap *cap = &n->caps[i];
        csg_vec3 off = csg_vec3_scale(random_direction(dice), cap->sine * 0.999);
        csg_vec3 one = csg_vec3_normalize(
            csg_vec3_add(csg_vec3_make(cap->at[0], cap->at[1], cap->at[2]), off));
        sum = csg_vec3_add(sum, csg_vec3_scale(one, csg_random_uniform(dice, 0, 1)));
    }
    return csg_vec3_normalize(sum);
}

static void test_what_is_apart_is(void **state)
{
    csg_random dice = {5};
    int apart = 0;
    (void)state;
    for (int set = 0; set < SETS; set++) {
        csg_wall_cap caps[MOST];
        csg_wall_normals n = random_normals(&dice, caps);
        csg_wall_angles angles = csg_wall_angles_make(0.1, csg_random_uniform(&dice, 1, 60));
        csg_vec3 v = random_direction(&dice);
        const double d[3] = {v.x, v.y, v.z};
        if (!csg_wall_is_apart(&n, d, angles.other))
            continue;
        apart++;
        for (int i = 0; i < SAMPLES; i++)
            assert_true(csg_vec3_dot(random_member(&dice, &n), v) < angles.other.cosine);
        assert_false(csg_wall_has_near(&n, v, angles.other));
    }
    assert_true(apart > SETS / 4); /* most that are apart are seen to be */
}

static void test_what_cannot_oppose_does_not(void **state)
{
    csg_random dice = {6};
    int sure = 0;
    (void)state;
    for (int set = 0; set < SETS; set++) {
        csg_wall_cap caps[2][MOST];
        csg_wall_normals a = random_normals(&dice, caps[0]), b = random_normals(&dice, caps[1]);
        csg_wall_angles angles = csg_wall_angles_make(0.1, 30);
        if (csg_wall_may_oppose(&a, &b, &angles))
            continue;
        sure++;
        for (int i = 0; i < SAMPLES; i++) /* the angle between them and 180 degrees: 30.1 */
            assert_true(csg_vec3_dot(random_member(&dice, &a), random_member(&dice, &b)) >
                        -cos(30.1 * 3.14159265358979323846 / 180));
    }
    assert_true(sure > SETS / 20);
}

static void test_edges_and_corners(void **state)
{
    static const csg_wall_cap box[] = {{{1, 0, 0}, 1e-5}, {{0, 1, 0}, 1e-5}, {{0, 0, 1}, 1e-5}};
    static const csg_wall_cap sharp[] = {{{0.98, 0.198997, 0}, 1e-5}, {{-0.98, 0.198997, 0}, 1e-5}};
    static const double middle[3] = {0, 1, 0};
    const csg_wall_normals corner = {3, box}, edge = {2, sharp}, any = {0, NULL};
    csg_wall_angles angles = csg_wall_angles_make(0.1, 30);
    (void)state;
    assert_false(csg_wall_may_oppose(&corner, &corner, &angles));
    assert_true(csg_wall_may_oppose(&edge, &edge, &angles)); /* a knife of 23 degrees */
    assert_true(csg_wall_may_oppose(&any, &corner, &angles));
    assert_true(csg_wall_has_near(&edge, csg_vec3_make(0, 1, 0), angles.one)); /* between them */
    assert_false(csg_wall_is_apart(&edge, middle, angles.one));
    assert_false(csg_wall_is_apart(&any, middle, angles.one));
    csg_wall_line far = csg_wall_line_make(csg_vec3_make(0, 0, 10), 1, &angles);
    assert_true(far.is_known);
    assert_true(fabs(far.d[2] - 1) < 1e-12);
    assert_false(csg_wall_line_make(csg_vec3_make(0, 0, 1), 1.5, &angles).is_known);
    assert_false(csg_wall_line_make(csg_vec3_make(0, 0, 0), 1, &angles).is_known);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_what_is_apart_is),
        cmocka_unit_test(test_what_cannot_oppose_does_not),
        cmocka_unit_test(test_edges_and_corners),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
