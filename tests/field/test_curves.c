/* SPDX-License-Identifier: MIT
 * Tubes along Bezier curves in the kernels: random ones of every temper, in frames of every kind,
 * one bit-equal value on every instruction set, within 1e-5 of the reference and within the slack
 * that pruning allows; gradients; the Lipschitz constant; ranges over cubes; what they are cut
 * into.
 *
 * Arguments: points for each kind (default 100000), a number that is added to the seeds (default
 * 0).
 */
#include "field/compile/compile_curve.h"
#include "field/field_support.h"
#include "field/gradients/cone_curve.h"
#include "scene/primitives/kinds.h"
#include "scene/primitives/primitive.h"

#include <float.h>
#include <stdio.h>
#include <stdlib.h>

/* tools/soak has many more, of other seeds. */
static int point_count = 100000;
static uint64_t seed_of_run = 0;

enum { AT_A_CURVE = TEST_MOST_POINTS };

static csg_affine any_place(csg_random *random, int kind)
{
    double factor = csg_random_uniform(random, 0.4, 2.5);
    if (kind == 0)
        return csg_affine_translate(test_point(random, 1));
    return kind < 3 ? test_random_affine(random, factor, factor, 1)
                    : test_random_affine(random, 0.5, 2, 1);
}

/* A union's error is no larger than its operands'. */
static double slack_of(const csg_tape *tape)
{
    double slack = 0;
    for (uint32_t i = 0; i < tape->count; i++)
        if (csg_op_is_leaf(tape->nodes[i].op))
            slack =
                fmax(slack, (double)tape->parameters[tape->nodes[i].parameters + CSG_LEAF_SLACK]);
    return slack;
}

static void check_builds(const csgm_field *field, const test_points *points, test_results *results)
{
    static test_results other;
    const csg_kernel *kernels[8];
    size_t count = test_kernels(kernels);
    test_evaluate(kernels[0], &field->tape, points, results);
    for (size_t k = 1; k < count; k++) {
        test_evaluate(kernels[k], &field->tape, points, &other);
        test_same_bits(results, &other, points->count, true, kernels[k]->name);
    }
}

static double length_at(const test_subject *s, csg_vec3 p)
{
    double size = csg_vec3_norm(csg_box_size(s->scene->bounds[s->scene->root]));
    return size + csg_vec3_norm(csg_vec3_sub(p, s->field->center));
}

static void check_values(const test_subject *s, const test_points *points,
                         const test_results *results)
{
    double slack = slack_of(&s->field->tape);
    for (size_t i = 0; i < points->count; i++) {
        csg_vec3 p = test_points_in_scene(points, i, s->field);
        csg_sample expected = test_sample(s->scene, p);
        double error = fabs((double)results->value[i] - expected.value);
        double near = 8 * FLT_EPSILON * length_at(s, p);
        if (!(error <= near && near < 1e-5 * length_at(s, p)))
            fail_msg("off by %g, more than %g", error, near);
        if (fabs(expected.value) < 0.1) /* where pruning asks */
            assert_true(error <= slack);
        const double gradient[3] = {(double)results->gradient[0][i],
                                    (double)results->gradient[1][i],
                                    (double)results->gradient[2][i]};
        if (i % 16 || !test_is_smooth(s->scene, p, 1e-3))
            continue;
        test_near(gradient[0], expected.gradient.x, 2e-3);
        test_near(gradient[1], expected.gradient.y, 2e-3);
        test_near(gradient[2], expected.gradient.z, 2e-3);
    }
}

static void check_slopes(const test_subject *s, const test_points *points,
                         const test_results *results)
{
    for (size_t i = 1; i < points->count; i++) {
        csg_vec3 p = test_points_in_scene(points, i, s->field);
        csg_vec3 q = test_points_in_scene(points, i - 1, s->field);
        double distance = csg_vec3_norm(csg_vec3_sub(p, q));
        double difference = fabs((double)results->value[i] - (double)results->value[i - 1]);
        assert_true(difference <=
                    distance + 16 * FLT_EPSILON * fmax(length_at(s, p), length_at(s, q)));
    }
}

/* Eight cubes around the points i to i + 7 hold what the field is in the points near them. */
static void check_ranges(const test_subject *s, const test_points *points,
                         const test_results *results, csg_random *random)
{
    enum { MOST_NODES = 2 * CSG_CURVE_MOST_PIECES };
    static float low[MOST_NODES * CSG_OCTANTS], high[MOST_NODES * CSG_OCTANTS], scratch[1 << 16];
    const csg_tape *tape = &s->field->tape;
    const csg_kernel *kernels[8];
    const csg_kernel *kernel = kernels[test_kernels(kernels) - 1];
    assert_true(tape->count <= MOST_NODES);
    for (size_t i = 0; i + CSG_OCTANTS <= points->count; i += CSG_OCTANTS * 8) {
        float radius = (float)csg_random_uniform(random, 0, 0.5);
        kernel->intervals(tape, points->x + i, points->y + i, points->z + i, radius, NULL, low,
                          high, scratch);
        for (size_t o = 0; o < CSG_OCTANTS; o++) {
            size_t root = (size_t)(tape->count - 1) * CSG_OCTANTS + o;
            assert_true(low[root] <= results->value[i + o] && results->value[i + o] <= high[root]);
            csg_vec3 p = test_points_in_scene(points, i + o, s->field);
            csg_vec3 q = csg_vec3_add(p, csg_vec3_scale(test_direction(random), (double)radius));
            double value = test_sample(s->scene, q).value;
            assert_true((double)low[root] <= value && value <= (double)high[root]);
        }
    }
}

static void fill_points(const test_subject *s, csg_random *random, const csg_affine *place,
                        test_points *points)
{
    test_points_clear(points);
    for (size_t i = 0; i < AT_A_CURVE; i++) {
        csg_vec3 p = csg_affine_point(place, test_point(random, i % 8 ? 1.3 : 5));
        csg_sample at = test_sample(s->scene, p);
        if (i % 4 == 1) /* on the surface */
            p = csg_vec3_sub(p, csg_vec3_scale(at.gradient, at.value));
        if (i % 16 == 2) /* on the skeleton, or nearly */
            p = csg_vec3_add(p, csg_vec3_scale(at.gradient, fmax(-at.value, 0)));
        assert_true(test_points_add(points, csg_vec3_sub(p, s->field->center)));
    }
}

/* Gradients in a ball keep to the cone that is claimed of a leaf whose frame is an offset. claims:
 * by one ball that is followed. */
static void check_cone(const test_subject *s, csg_random *random, uint32_t *claims)
{
    const csg_tape *tape = &s->field->tape;
    const float *parameters = tape->parameters + tape->nodes[0].parameters;
    if (tape->count > 1 || tape->nodes[0].frame != CSG_FRAME_OFFSET)
        return;
    for (int i = 0; i < 32; i++) {
        csg_vec3 p = csg_vec3_add(s->field->center, test_point(random, 1.5));
        double rho = pow(10, csg_random_uniform(random, -4, -0.5)), gradient[3], spread, bend, q[3];
        csg_vec3 from = csg_vec3_sub(p, s->field->center);
        const double at[3] = {from.x, from.y, from.z};
        for (int k = 0; k < 3; k++)
            q[k] = at[k] - (double)parameters[CSG_LEAF_FRAME + k];
        if (!csg_cone_curve(parameters + CSG_LEAF_OWN_OFFSET, q, rho, gradient, &spread, &bend))
            continue;
        csg_vec3 axis = {gradient[0], gradient[1], gradient[2]};
        *claims += isfinite(bend);
        csg_vec3 last = p;
        for (int k = 0; k < 8; k++) {
            double far = rho * cbrt(csg_random_uniform(random, 0, 1));
            csg_vec3 near = csg_vec3_add(p, csg_vec3_scale(test_direction(random), far));
            csg_vec3 at_near = test_sample(s->scene, near).gradient;
            assert_true(csg_vec3_norm(csg_vec3_sub(at_near, axis)) <= spread + 1e-5);
            csg_vec3 change = csg_vec3_sub(at_near, test_sample(s->scene, last).gradient);
            double apart = csg_vec3_norm(csg_vec3_sub(near, last));
            assert_true(csg_vec3_norm(change) <= bend * apart + 1e-5);
            last = near;
        }
    }
}

static void check_kind(csg_primitive_kind kind)
{
    csg_random random = {7000 + (uint64_t)kind + seed_of_run};
    static test_points points;
    static test_results results;
    uint32_t claims = 0;
    for (int i = 0; i < point_count / AT_A_CURVE; i++) {
        double v[CSG_CURVE_MOST * CSG_CURVE_AXES];
        test_subject s;
        csg_primitive_of(kind)->example(&random, v);
        csg_affine place = any_place(&random, i % 4);
        test_subject_begin(&s);
        csg_node_id node = csg_build_primitive(&s.builder, kind, v, NOWHERE);
        test_subject_compile(&s, csg_build_transform(&s.builder, &place, node, NOWHERE));
        fill_points(&s, &random, &place, &points);
        check_builds(s.field, &points, &results);
        check_values(&s, &points, &results);
        check_slopes(&s, &points, &results);
        check_ranges(&s, &points, &results, &random);
        check_cone(&s, &random, &claims);
        test_subject_end(&s);
    }
    assert_true(claims > (uint32_t)(point_count / AT_A_CURVE) / 2);
}

static void test_quadratic(void **state)
{
    check_kind(CSG_NODE_QUADRATIC_TUBE);
}

static void test_cubic(void **state)
{
    check_kind(CSG_NODE_CUBIC_TUBE);
}

/* ---- on the tape --------------------------------------------------------------------------- */

static const double bow[] = {-1, 0, 0, 0.2, 0, 2, 0, 0.2, 1, 0, 0, 0.2};

static uint32_t count_ops(const csg_tape *tape, uint8_t op)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < tape->count; i++)
        count += tape->nodes[i].op == op;
    return count;
}

/* The pieces of a curve are operands of the sharp union around it, and of one of their own below
 * anything else; negated they meet. */
static void test_pieces(void **state)
{
    csg_curve curve = csg_curve_make(CSG_NODE_QUADRATIC_TUBE, bow), pieces[CSG_CURVE_MOST_PIECES];
    uint32_t count = (uint32_t)csg_curve_cut(&curve, pieces);
    assert_in_range(count, 2, 8);
    for (int how = 0; how < 4; how++) {
        test_subject s;
        test_subject_begin(&s);
        csg_blend blend = how == 1 ? csg_blend_round(0.2) : CSG_SHARP;
        csg_node_id tube = csg_build_primitive(&s.builder, CSG_NODE_QUADRATIC_TUBE, bow, NOWHERE);
        csg_node_id ball =
            csg_build_primitive(&s.builder, CSG_NODE_SPHERE, (double[]){1.5}, NOWHERE);
        csg_node_kind kind = how == 2 ? CSG_NODE_DIFFERENCE : CSG_NODE_UNION;
        csg_node_id root = how == 3 ? tube
                                    : csg_build_operator(&s.builder, kind, blend,
                                                         (csg_node_id[]){ball, tube}, 2, NOWHERE);
        test_subject_compile(&s, root);
        const csg_tape *tape = &s.field->tape;
        assert_int_equal(count_ops(tape, CSG_OP_OF(QUADRATIC_TUBE)), count);
        assert_int_equal(count_ops(tape, CSG_OP_UNION), how == 2 ? 0 : 1);
        assert_int_equal(count_ops(tape, CSG_OP_INTERSECTION), how == 2 ? 1 : 0);
        assert_int_equal(tape->nodes[tape->count - 1].size, tape->count);
        test_subject_end(&s);
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
        cmocka_unit_test(test_pieces),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
