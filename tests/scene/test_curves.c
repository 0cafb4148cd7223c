/* SPDX-License-Identifier: MIT
 * Tubes along Bezier curves, seeded random ones of every temper, in double: the
 * nearest ball against many balls along the curve, which are never larger and nearly as large;
 * inside and outside; Lipschitz constant 1; gradients of unit length against central differences;
 * boxes that contain and touch.
 *
 * Arguments: points for each kind (default 100000), a number that is added to the seeds (default
 * 0).
 */
#include "scene_support.h"

#include <stdlib.h>

#include "scene/primitives/curve.h"
#include "scene/primitives/kinds.h"
#include "scene/primitives/primitive_box.h"

/* tools/soak has many more, of other seeds. */
static int point_count = 100000;
static uint64_t seed_of_run = 0;

enum { AT_A_CURVE = 50, BALLS = 400 };

static csg_sample sample_of(csg_primitive_kind kind, const double *v, csg_vec3 p)
{
    return csg_reference_primitive(kind, v, p);
}

/* Balls at equal steps of t, and how fast they move at most. */
typedef struct chain {
    double at[BALLS + 1][CSG_CURVE_AXES], speed;
} chain;

static void fill_chain(const csg_curve *curve, chain *out)
{
    out->speed = 0;
    for (int i = 0; i < curve->degree; i++) {
        double square = 0, grows;
        for (int k = 0; k < 3; k++)
            square += pow(curve->at[i + 1][k] - curve->at[i][k], 2);
        grows = fabs(curve->at[i + 1][CSG_CURVE_RADIUS] - curve->at[i][CSG_CURVE_RADIUS]);
        out->speed = fmax(out->speed, curve->degree * (sqrt(square) + grows));
    }
    for (int i = 0; i <= BALLS; i++)
        csg_curve_at(curve, (double)i / BALLS, out->at[i]);
}

static void check_nearest(const chain *c, csg_vec3 p, double value)
{
    double best = -INFINITY;
    for (int i = 0; i <= BALLS; i++) {
        csg_vec3 ball = {c->at[i][0], c->at[i][1], c->at[i][2]};
        best = fmax(best, c->at[i][CSG_CURVE_RADIUS] - csg_vec3_norm(csg_vec3_sub(p, ball)));
    }
    assert_true(value >= best - 1e-14);
    assert_true(value <= best + c->speed * 0.5 / BALLS + 1e-14);
}

static void check_pair(csg_primitive_kind kind, const double *v, csg_vec3 p, double value,
                       csg_vec3 q)
{
    double distance = csg_vec3_norm(csg_vec3_sub(p, q));
    double difference = fabs(value - sample_of(kind, v, q).value);
    assert_true(difference <= distance * (1 + 1e-12) + 4e-14);
}

/* False where two balls are nearest within a step. */
static bool check_gradient(csg_primitive_kind kind, const double *v, csg_vec3 p, csg_sample s)
{
    const double step = 1e-5;
    double gradient[3] = {s.gradient.x, s.gradient.y, s.gradient.z};
    for (int axis = 0; axis < 3; axis++) {
        csg_vec3 by = {axis == 0 ? step : 0, axis == 1 ? step : 0, axis == 2 ? step : 0};
        double up = sample_of(kind, v, csg_vec3_add(p, by)).value;
        double down = sample_of(kind, v, csg_vec3_sub(p, by)).value;
        if (fabs(up - 2 * s.value + down) > 2e-3 * step)
            return false;
        test_near(gradient[axis], (up - down) / (2 * step), 2e-3);
    }
    test_near(csg_vec3_norm(s.gradient), 1, 1e-12);
    return true;
}

static void check_box(csg_primitive_kind kind, const double *v, const chain *c)
{
    csg_affine place = csg_affine_identity();
    csg_box box = csg_primitive_box(kind, v, &place, 0), balls = csg_box_empty();
    for (int i = 0; i <= BALLS; i++) {
        double r = c->at[i][CSG_CURVE_RADIUS];
        csg_vec3 at = {c->at[i][0], c->at[i][1], c->at[i][2]}, reach = {r, r, r};
        balls = csg_box_hull(balls, (csg_box){csg_vec3_sub(at, reach), csg_vec3_add(at, reach)});
    }
    assert_true(csg_box_contains_box(csg_box_grow(box, 1e-14), balls));
    assert_true(csg_box_contains_box(csg_box_grow(balls, c->speed * 0.5 / BALLS), box));
}

static void check_kind(csg_primitive_kind kind)
{
    csg_random random = {4000 + (uint64_t)kind + seed_of_run};
    int smooth = 0;
    static chain balls;
    for (int i = 0; i < point_count / AT_A_CURVE; i++) {
        double v[CSG_CURVE_MOST * CSG_CURVE_AXES];
        csg_primitive_of(kind)->example(&random, v);
        csg_curve curve = csg_curve_make(kind, v);
        fill_chain(&curve, &balls);
        check_box(kind, v, &balls);
        for (int k = 0; k < AT_A_CURVE; k++) {
            csg_vec3 p = test_point(&random, k % 4 ? 1.3 : 4), q = test_point(&random, 1.3);
            csg_sample s = sample_of(kind, v, p);
            if (k % 8 == 0) /* on the curve: near all that is critical */
                p = csg_vec3_make(balls.at[k][0], balls.at[k][1], balls.at[k][2] + 1e-9 * k);
            if (k % 8 == 0)
                s = sample_of(kind, v, p);
            check_nearest(&balls, p, s.value);
            double near = pow(10, csg_random_uniform(&random, -9, 0));
            check_pair(kind, v, p, s.value, csg_vec3_add(p, csg_vec3_scale(q, near)));
            if (k % 8 == 1)
                smooth += check_gradient(kind, v, p, s);
        }
    }
    assert_true(smooth > point_count / 8 * 0.95);
}

static void test_quadratic(void **state)
{
    check_kind(CSG_NODE_QUADRATIC_TUBE);
}

static void test_cubic(void **state)
{
    check_kind(CSG_NODE_CUBIC_TUBE);
}

/* A cubic that is a quadratic raised, and one cut in two, have its field. */
static void test_same_curve(void **state)
{
    csg_random random = {4100 + seed_of_run};
    for (int i = 0; i < 300; i++) {
        double v[CSG_CURVE_MOST * CSG_CURVE_AXES], up[CSG_CURVE_MOST * CSG_CURVE_AXES];
        csg_primitive_of(CSG_NODE_QUADRATIC_TUBE)->example(&random, v);
        for (int k = 0; k < 4; k++) {
            up[k] = v[k];
            up[4 + k] = v[k] / 3 + v[4 + k] * 2 / 3;
            up[8 + k] = v[8 + k] / 3 + v[4 + k] * 2 / 3;
            up[12 + k] = v[8 + k];
        }
        csg_curve curve = csg_curve_make(CSG_NODE_CUBIC_TUBE, up), half[2];
        csg_curve_halve(&curve, &half[0], &half[1]);
        for (int k = 0; k < 20; k++) {
            csg_vec3 p = test_point(&random, 1.5), to;
            double value = sample_of(CSG_NODE_QUADRATIC_TUBE, v, p).value;
            test_near(sample_of(CSG_NODE_CUBIC_TUBE, up, p).value, value, 1e-13);
            double both =
                fmax(csg_curve_nearest(&half[0], p, &to), csg_curve_nearest(&half[1], p, &to));
            test_near(both, value, 1e-13);
        }
    }
}

/* Straight and even: a capsule. All in one place: a ball. */
static void test_degenerate(void **state)
{
    const double line[] = {0, 0, 0, 0.2, 0, 0, 0.5, 0.3, 0, 0, 1, 0.4};
    const double point_like[] = {1, 2, 3, 0.5, 1, 2, 3, 0.5, 1, 2, 3, 0.5};
    const double capsule[] = {1, 0.2, 0.4}, ball[] = {0.5};
    csg_random random = {4200 + seed_of_run};
    for (int i = 0; i < 2000; i++) {
        csg_vec3 p = test_point(&random, 1.5);
        csg_sample a = sample_of(CSG_NODE_QUADRATIC_TUBE, line, p);
        csg_sample b = sample_of(CSG_NODE_CAPSULE, capsule, p);
        test_near(a.value, b.value, 1e-13);
        test_near_vec3(a.gradient, b.gradient, 1e-6);
        a = sample_of(CSG_NODE_QUADRATIC_TUBE, point_like, csg_vec3_add(p, (csg_vec3){1, 2, 3}));
        test_near(a.value, sample_of(CSG_NODE_SPHERE, ball, p).value, 1e-13);
    }
}

int main(int argc, char **argv)
{
    if (argc > 1)
        point_count = (int)strtol(argv[1], NULL, 10);
    if (argc > 2)
        seed_of_run = strtoull(argv[2], NULL, 10);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_quadratic),
        cmocka_unit_test(test_cubic),
        cmocka_unit_test(test_same_curve),
        cmocka_unit_test(test_degenerate),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
