/* SPDX-License-Identifier: MIT
 * True gradients (field/kernels/turned_kernel.h): of fillets and of rules with debulge they are
 * what central differences of the field in double say, where those that operators look at are off
 * by degrees; elsewhere they are the same bits; every build has the same.
 */
#include <stdlib.h>
#include <string.h>

#include "field/prune_support.h"
#include "scene/operators/blend_kinds.h"
#include "scene/operators/rule.h"
#include "scene/operators/soft.h"
#include "scene/primitives/kinds.h"

static const double DEGREE = 0.017453292519943295;

/* ---- scenes ------------------------------------------------------------------------------------
 */

static csg_node_id placed(csg_scene_builder *b, csg_node_id node, double tilt, csg_vec3 at)
{
    csg_affine turn = csg_affine_rotate(tilt, csg_vec3_make(1, 0, 0));
    csg_affine all = csg_affine_multiply(csg_affine_translate(at), turn);
    return csg_build_transform(b, &all, node, NOWHERE);
}

static csg_node_id rod(csg_scene_builder *b, double r, double tilt)
{
    csg_node_id node =
        csg_build_capsule(b, csg_vec3_make(0, 0, -9), csg_vec3_make(0, 0, 9), r, r, NOWHERE);
    return placed(b, node, tilt, csg_vec3_make(0, 0, 0));
}

static csg_node_id ball(csg_scene_builder *b, double r, double x, double y)
{
    return placed(b, csg_build_ball(b, r, NOWHERE), 0, csg_vec3_make(x, y, 0));
}

enum { PLATE, CROSSING, TILTED, RING, MILLED, THREE, SQUASHED, NESTED, BULGING, SCENES };

/* off: at least so many degrees are the gradients off that operators look at, somewhere. */
static const struct {
    const char *name;
    double off;
} scenes[SCENES] = {
    {"ball on a plate", 5},         {"crossing rods", 5},
    {"rods at 60 degrees", 5},      {"ring and rod", 5},
    {"ball, drilled", 3},           {"three balls", 2},
    {"crossing rods, squashed", 5}, {"a fillet in another", 3},
    {"debulged rods", 5},
};

static csg_node_id make_scene(csg_scene_builder *b, int which)
{
    csg_blend two = {CSG_BLEND_FILLET, 2, false}, one = {CSG_BLEND_FILLET, 1, false};
    csg_node_id nodes[3];
    csg_affine squash = csg_affine_scale(csg_vec3_make(1, 1.5, 0.8));
    csg_box plate = {{-9, -9, -6}, {9, 9, -4}};
    csg_rule rule = csg_rule_standard(CSG_BLEND_SCALE_SET);
    csg_node_kind how = which == MILLED ? CSG_NODE_DIFFERENCE : CSG_NODE_UNION;
    unsigned count = 2;
    nodes[0] = ball(b, 5, 0, 0);
    nodes[1] = rod(b, 3, 90);
    switch (which) {
    case PLATE:
        nodes[1] = csg_build_block(b, plate, NOWHERE);
        break;
    case CROSSING:
    case SQUASHED:
        nodes[0] = rod(b, 3, 0);
        break;
    case TILTED:
        nodes[0] = rod(b, 3, 30);
        break;
    case RING:
        nodes[0] = csg_build_primitive(b, CSG_NODE_TORUS, (double[]){6, 2, 180}, NOWHERE);
        nodes[1] = rod(b, 1.2, 90);
        two = one;
        break;
    case MILLED:
        nodes[1] = rod(b, 2, 0);
        two = one;
        break;
    case THREE:
        nodes[1] = ball(b, 4, 6, 0);
        nodes[2] = ball(b, 3, 3, 5);
        count = 3;
        break;
    case NESTED:
        nodes[0] = csg_build_operator(b, CSG_NODE_UNION, two, nodes, 2, NOWHERE);
        nodes[1] = rod(b, 2, 0);
        how = CSG_NODE_DIFFERENCE;
        two = one;
        break;
    case BULGING:
        rule.parameters[0] = rule.parameters[1] = 0.5;
        rule.parameters[3] = 0.01;
        two = csg_build_rule(b, &rule);
        nodes[0] = rod(b, 3, 30);
        for (int k = 0; k < 2; k++)
            nodes[k] = csg_build_soft(b, (csg_soft){.range = 8}, nodes[k], NOWHERE);
        break;
    default:
        break;
    }
    csg_node_id all = csg_build_operator(b, how, two, nodes, count, NOWHERE);
    return which == SQUASHED ? csg_build_transform(b, &squash, all, NOWHERE) : all;
}

/* ---- what is true ------------------------------------------------------------------------------
 */

static double at(const csgm_scene *scene, csg_vec3 p)
{
    return test_sample(scene, p).value;
}

/* By central differences; false: the field is not smooth there, steps of two lengths differ. */
static bool true_gradient(const csgm_scene *scene, csg_vec3 p, csg_vec3 *out)
{
    double g[2][3], worst = 0, length = 0;
    for (int axis = 0; axis < 3; axis++)
        for (int k = 0; k < 2; k++) {
            double h = k ? 4e-4 : 1e-4;
            csg_vec3 step = {axis == 0 ? h : 0, axis == 1 ? h : 0, axis == 2 ? h : 0};
            g[k][axis] =
                (at(scene, csg_vec3_add(p, step)) - at(scene, csg_vec3_sub(p, step))) / (2 * h);
            double half = (at(scene, csg_vec3_add(p, step)) - at(scene, p)) / h;
            worst = fmax(worst, fmax(fabs(g[k][axis] - g[0][axis]), fabs(half - g[k][axis]) / 4));
            length = hypot(length, k ? 0 : g[0][axis]);
        }
    *out = csg_vec3_make(g[0][0], g[0][1], g[0][2]);
    return worst < 1e-3 * length && length > 1e-3;
}

static double angle_between(csg_vec3 a, csg_vec3 b)
{
    return atan2(csg_vec3_norm(csg_vec3_cross(a, b)), csg_vec3_dot(a, b)) / DEGREE;
}

static csg_vec3 vector_of(float *const g[3], size_t i)
{
    return csg_vec3_make((double)g[0][i], (double)g[1][i], (double)g[2][i]);
}

typedef struct measured {
    float plain[3][TEST_MOST_POINTS], turned[3][TEST_MOST_POINTS];
} measured;

static void measure(const csg_kernel *kernel, const csg_tape *tape, const test_points *points,
                    measured *out)
{
    size_t floats = csg_kernel_scratch_floats(csg_tape_depth(tape));
    float *scratch = malloc(floats * sizeof *scratch);
    assert_non_null(scratch);
    memset(out, 0, sizeof *out);
    kernel->gradients(tape, points->x, points->y, points->z, points->count, out->plain[0],
                      out->plain[1], out->plain[2], scratch, floats);
    kernel->true_gradients(tape, points->x, points->y, points->z, points->count, out->turned[0],
                           out->turned[1], out->turned[2], scratch, floats);
    free(scratch);
}

/* Near the surface, where the scene blends. */
static void scatter(const csgm_scene *scene, const csgm_field *field, csg_random *random,
                    test_points *points)
{
    test_points_clear(points);
    for (int tries = 0; tries < 4000 && points->count < 300; tries++) {
        csg_vec3 p = test_towards_surface(scene, test_point(random, 8), 12);
        if (fabs(at(scene, p)) < 1e-6 && csg_vec3_norm(p) < 12)
            test_points_add(points, csg_vec3_sub(p, field->center));
    }
    assert_true(points->count > 200);
}

static void test_angles(void **state)
{
    static test_points points;
    static measured all;
    csg_random random = {test_first_seed + 41};
    for (int which = 0; which < SCENES; which++) {
        test_subject s;
        double worst = 0, plain = 0;
        size_t compared = 0;
        test_subject_begin(&s);
        test_subject_compile(&s, make_scene(&s.builder, which));
        scatter(s.scene, s.field, &random, &points);
        measure(csg_kernel_for(csg_cpu_best_isa(CSGM_ISA_AUTO)), &s.field->tape, &points, &all);
        for (size_t i = 0; i < points.count; i++) {
            csg_vec3 truth, p = test_points_in_scene(&points, i, s.field);
            float *const turned[3] = {all.turned[0], all.turned[1], all.turned[2]};
            float *const before[3] = {all.plain[0], all.plain[1], all.plain[2]};
            if (!true_gradient(s.scene, p, &truth))
                continue;
            compared++;
            worst = fmax(worst, angle_between(vector_of(turned, i), truth));
            plain = fmax(plain, angle_between(vector_of(before, i), truth));
        }
        assert_true(compared > points.count * 8 / 10);
        if (!(worst < 0.1) || !(plain > scenes[which].off))
            fail_msg("%s: off by %.4f degrees, by %.3f before", scenes[which].name, worst, plain);
        test_subject_end(&s);
    }
}

/* ---- the same bits -----------------------------------------------------------------------------
 */

static void same(const measured *a, const measured *b, size_t count, const char *what)
{
    for (int k = 0; k < 3; k++)
        for (size_t i = 0; i < count; i++)
            if (memcmp(&a->turned[k][i], &b->turned[k][i], sizeof(float)) &&
                !(a->turned[k][i] == 0 && b->turned[k][i] == 0))
                fail_msg("%s: %a and %a at point %zu", what, (double)a->turned[k][i],
                         (double)b->turned[k][i], i);
}

/* Random trees of fillets and rules: builds, and what is no fillet. */
static void test_builds(void **state)
{
    static test_points points;
    static measured first, other;
    csg_random random = {test_first_seed + 43};
    const csg_kernel *kernels[8];
    size_t kernel_count = test_kernels(kernels), changed = 0;
    for (unsigned i = 0; i < ROUNDS(40) * test_times; i++) {
        test_subject s;
        test_random_fillets = i % 4 != 0;
        test_random_rules = i % 2;
        test_subject_begin(&s);
        test_subject_compile(&s, test_random_scene(&s.builder, &random, 2 + i % 10));
        test_points_clear(&points);
        while (test_points_add(&points, test_point(&random, 1.5)) && points.count < 128) {
        }
        measure(kernels[0], &s.field->tape, &points, &first);
        for (size_t k = 1; k < kernel_count; k++) {
            measure(kernels[k], &s.field->tape, &points, &other);
            same(&first, &other, points.count, kernels[k]->name);
        }
        for (int k = 0; k < 3; k++) {
            int differs = memcmp(first.plain[k], first.turned[k], sizeof first.plain[k]) != 0;
            assert_true(!differs || s.field->tape.turns);
            changed += (size_t)differs;
        }
        test_subject_end(&s);
    }
    test_random_fillets = test_random_rules = false;
    assert_true(changed > ROUNDS(20) * test_times);
}

int main(int argc, char **argv)
{
    test_take_search(argc, argv);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_angles),
        cmocka_unit_test(test_builds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
