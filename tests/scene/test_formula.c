/* SPDX-License-Identifier: MIT
 * Formulas: building, values, gradients, Lipschitz constants that nothing refutes, and fields as
 * nodes of a scene.
 */
#include <string.h>

#include "scene/operators/blend_kinds.h"
#include "scene/random_formula.h"
#include "scene/scene_support.h"

static csg_formula_dual evaluate(const csg_formula_step *steps, uint32_t count, csg_box box,
                                 csg_vec3 p)
{
    static csg_formula_dual work[TEST_MOST_STEPS];
    csg_formula formula = {.count = count, .lipschitz = 1, .bounds = box};
    return csg_formula_evaluate(steps, &formula, p, work);
}

/* ---- building ------------------------------------------------------------------------------ */

typedef struct bench {
    csgm_context context;
    csg_formula_builder builder;
    csg_formula_id x, y, z;
} bench;

static void bench_begin(bench *b)
{
    test_context_init(&b->context);
    csg_formula_begin(&b->builder, &b->context.memory);
    b->x = csg_formula_apply(&b->builder, CSG_FORMULA_X, 0, 0);
    b->y = csg_formula_apply(&b->builder, CSG_FORMULA_Y, 0, 0);
    b->z = csg_formula_apply(&b->builder, CSG_FORMULA_Z, 0, 0);
}

static void bench_end(bench *b)
{
    csg_formula_end(&b->builder);
    test_context_end(&b->context);
}

static csg_formula_id constant(bench *b, double value)
{
    return csg_formula_constant(&b->builder, value);
}

static csg_formula_id apply(bench *b, csg_formula_op op, csg_formula_id left, csg_formula_id right)
{
    return csg_formula_apply(&b->builder, op, left, right);
}

static void test_simplification(void **state)
{
    bench b;
    bench_begin(&b);
    csg_formula_id two = constant(&b, 2), three = constant(&b, 3);
    assert_int_equal(apply(&b, CSG_FORMULA_ADD, two, three), constant(&b, 5));
    csg_formula_id doubled = apply(&b, CSG_FORMULA_MUL, two, b.x);
    assert_int_equal(apply(&b, CSG_FORMULA_MUL, doubled, three),
                     apply(&b, CSG_FORMULA_MUL, b.x, constant(&b, 6)));
    assert_int_equal(apply(&b, CSG_FORMULA_DIV, doubled, two), b.x);
    assert_int_equal(apply(&b, CSG_FORMULA_SUB, apply(&b, CSG_FORMULA_ADD, b.x, two), two), b.x);
    assert_int_equal(apply(&b, CSG_FORMULA_SUB, b.y, b.y), constant(&b, 0));
    assert_int_equal(apply(&b, CSG_FORMULA_MUL, b.x, b.y), apply(&b, CSG_FORMULA_MUL, b.y, b.x));
    assert_int_not_equal(apply(&b, CSG_FORMULA_SUB, b.x, b.y),
                         apply(&b, CSG_FORMULA_SUB, b.y, b.x));
    csg_formula_id square = apply(&b, CSG_FORMULA_MUL, b.x, b.x);
    assert_int_equal(apply(&b, CSG_FORMULA_POW, b.x, three),
                     apply(&b, CSG_FORMULA_MUL, b.x, square));
    assert_int_equal(apply(&b, CSG_FORMULA_POW, b.x, two), square);
    assert_int_equal(apply(&b, CSG_FORMULA_POW, b.x, constant(&b, 0.5)),
                     apply(&b, CSG_FORMULA_SQRT, b.x, 0));
    csg_formula_id negative = apply(&b, CSG_FORMULA_NEG, b.x, 0);
    assert_int_equal(apply(&b, CSG_FORMULA_NEG, negative, 0), b.x);
    assert_int_equal(apply(&b, CSG_FORMULA_ABS, negative, 0), apply(&b, CSG_FORMULA_ABS, b.x, 0));
    csg_formula_step steps[8];
    assert_int_equal(csg_formula_collect(&b.builder, square, steps), 2);
    assert_int_equal(steps[1].op, CSG_FORMULA_MUL);
    bench_end(&b);
}

static void test_values(void **state)
{
    static const struct {
        csg_formula_op op;
        double a, b, value;
    } rows[] = {
        {CSG_FORMULA_NEG, 2, 0, -2},
        {CSG_FORMULA_ABS, -2, 0, 2},
        {CSG_FORMULA_SQRT, 9, 0, 3},
        {CSG_FORMULA_SIN, 30, 0, 0.5},
        {CSG_FORMULA_COS, 420, 0, 0.5},
        {CSG_FORMULA_TAN, 45, 0, 1},
        {CSG_FORMULA_ASIN, 0.5, 0, 30},
        {CSG_FORMULA_ACOS, 0, 0, 90},
        {CSG_FORMULA_ATAN, 1, 0, 45},
        {CSG_FORMULA_EXP, 0, 0, 1},
        {CSG_FORMULA_LN, 1, 0, 0},
        {CSG_FORMULA_FLOOR, -1.5, 0, -2},
        {CSG_FORMULA_ADD, 2, 3, 5},
        {CSG_FORMULA_SUB, 2, 3, -1},
        {CSG_FORMULA_MUL, 2, 3, 6},
        {CSG_FORMULA_DIV, 3, 2, 1.5},
        {CSG_FORMULA_MIN, 2, 3, 2},
        {CSG_FORMULA_MAX, 2, 3, 3},
        {CSG_FORMULA_POW, 2, 1.5, M_SQRT2 * 2},
        {CSG_FORMULA_ATAN2, 1, -1, 135},
        {CSG_FORMULA_MOD, -5, 3, -2},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        test_near(csg_formula_value(rows[i].op, rows[i].a, rows[i].b), rows[i].value, 1e-13);
}

/* ---- gradients ------------------------------------------------------------------------------ */

/* Central differences, where those of two sizes agree: away from kinks and jumps. */
static void test_gradients(void **state)
{
    csgm_context context;
    test_context_init(&context);
    csg_random random = {11};
    static csg_formula_step steps[TEST_MOST_STEPS];
    size_t checked = 0;
    for (int turn = 0; turn < 400; turn++) {
        uint32_t count =
            test_random_formula(&context.memory, &random, 1 + (unsigned)turn % 20, turn % 2, steps);
        for (int i = 0; i < 10; i++) {
            csg_vec3 p = test_point(&random, 2), along = test_direction(&random);
            csg_formula_dual at = evaluate(steps, count, csg_box_all(), p);
            double slope[2];
            for (int k = 0; k < 2; k++) {
                double h = k ? 1e-5 : 4e-5;
                csg_vec3 step = csg_vec3_scale(along, h);
                double up = evaluate(steps, count, csg_box_all(), csg_vec3_add(p, step)).value;
                double down = evaluate(steps, count, csg_box_all(), csg_vec3_sub(p, step)).value;
                slope[k] = (up - down) / (2 * h);
            }
            double expected = csg_vec3_dot(at.gradient, along), size = 1 + fabs(expected);
            if (fabs(slope[0] - slope[1]) > 1e-6 * size)
                continue;
            test_near(slope[1], expected, 1e-5 * size);
            checked++;
        }
    }
    assert_true(checked > 3000);
    test_context_end(&context);
}

/* ---- Lipschitz constants ----------------------------------------------------------------------
 */

static csg_vec3 point_in(csg_random *random, csg_box box)
{
    return csg_vec3_make(csg_random_uniform(random, box.min.x, box.max.x),
                         csg_random_uniform(random, box.min.y, box.max.y),
                         csg_random_uniform(random, box.min.z, box.max.z));
}

static void test_lipschitz_holds(void **state)
{
    csgm_context context;
    test_context_init(&context);
    csg_random random = {12};
    static csg_formula_step steps[TEST_MOST_STEPS];
    csg_box box = {{-2, -1.5, -1}, {1, 1.5, 2}};
    size_t finite = 0;
    double used = 0; /* of the constants, on average */
    for (int turn = 0; turn < 300; turn++) {
        uint32_t count =
            test_random_formula(&context.memory, &random, 1 + (unsigned)turn % 16, true, steps);
        double lambda = csg_formula_lipschitz(&context.memory, steps, count, box);
        double steepest = 0;
        for (int i = 0; i < 500; i++) {
            csg_vec3 p = point_in(&random, box), q = point_in(&random, box);
            if (i % 2) /* near each other, and outside of the box: there it holds too */
                q = csg_vec3_add(p, test_point(&random, i % 4 == 1 ? 1e-3 : 2));
            double rise =
                evaluate(steps, count, box, p).value - evaluate(steps, count, box, q).value;
            double distance = csg_vec3_norm(csg_vec3_sub(p, q));
            if (!(fabs(rise) <= lambda * distance * (1 + 1e-9) + 1e-9))
                fail_msg("formula %d: %g over %g refutes %g", turn, rise, distance, lambda);
            steepest = fmax(steepest, fabs(rise) / distance);
        }
        finite += isfinite(lambda);
        used += isfinite(lambda) && lambda > 0 ? steepest / lambda : 0;
    }
    assert_true(finite > 290);
    assert_true(used / (double)finite > 0.4);
    test_context_end(&context);
}

static double lipschitz(bench *b, csg_formula_id id, csg_box box)
{
    csg_formula_step steps[64];
    uint32_t count = csg_formula_collect(&b->builder, id, steps);
    return csg_formula_lipschitz(&b->context.memory, steps, count, box);
}

static csg_formula_id length(bench *b, csg_formula_id u, csg_formula_id v)
{
    return apply(
        b, CSG_FORMULA_SQRT,
        apply(b, CSG_FORMULA_ADD, apply(b, CSG_FORMULA_MUL, u, u), apply(b, CSG_FORMULA_MUL, v, v)),
        0);
}

/* What is known by hand: distances have 1, on all of space and where they have kinks. */
static void test_lipschitz_of_distances(void **state)
{
    bench b;
    bench_begin(&b);
    csg_box box = {{-2, -2, -2}, {2, 2, 2}};
    csg_formula_id rho = length(&b, b.x, b.y);
    csg_formula_id ball = length(&b, rho, b.z);
    csg_formula_id ring = length(&b, apply(&b, CSG_FORMULA_SUB, rho, constant(&b, 1)), b.z);
    csg_formula_id both = apply(&b, CSG_FORMULA_MAX, ball, apply(&b, CSG_FORMULA_ABS, b.x, 0));
    const csg_formula_id distances[] = {rho, ball, ring, both};
    for (int i = 0; i < 4; i++) {
        test_near(lipschitz(&b, distances[i], csg_box_all()), 1, 1e-12);
        test_near(lipschitz(&b, distances[i], box), 1, 1e-12);
    }
    csg_formula_id square = apply(&b, CSG_FORMULA_MUL, b.x, b.x);
    test_near(lipschitz(&b, square, box), 4, 0.1);
    assert_true(isinf(lipschitz(&b, square, csg_box_all())));
    assert_true(isinf(lipschitz(&b, apply(&b, CSG_FORMULA_FLOOR, b.x, 0), box)));
    assert_true(isinf(lipschitz(&b, apply(&b, CSG_FORMULA_SQRT, b.x, 0), box)));
    assert_true(isinf(lipschitz(&b, apply(&b, CSG_FORMULA_DIV, constant(&b, 1), b.x), box)));
    assert_true(lipschitz(&b, constant(&b, 7), box) == 0);
    bench_end(&b);
}

/* ---- nodes ------------------------------------------------------------------------------------
 */

typedef struct scene_bench {
    csgm_context context;
    csg_scene_builder builder;
} scene_bench;

static void scene_begin(scene_bench *s)
{
    test_context_init(&s->context);
    assert_int_equal(csg_build_begin(&s->builder, &s->context), CSGM_OK);
}

/* x^2 + 1/2 <= 1, steps by hand */
static const csg_formula_step slab[] = {{.op = CSG_FORMULA_X},
                                        {.op = CSG_FORMULA_MUL, .a = 0, .b = 0},
                                        {.op = CSG_FORMULA_CONSTANT, .constant = 0.5},
                                        {.op = CSG_FORMULA_SUB, .a = 2, .b = 1}};

static void test_field_node(void **state)
{
    scene_bench s;
    scene_begin(&s);
    csg_box box = {{-1, -2, -3}, {1, 2, 4}};
    csg_node_id cut = csg_build_field(&s.builder, slab, 4, box, true, 0, NOWHERE);
    csg_node_id loose = csg_build_field(&s.builder, slab, 4, box, false, 5, NOWHERE);
    csg_affine shift = csg_affine_translate(csg_vec3_make(10, 0, 0));
    loose = csg_build_transform(&s.builder, &shift, loose, NOWHERE);
    csg_node_id root = csg_build_operator(&s.builder, CSG_NODE_UNION, (csg_blend){0},
                                          (csg_node_id[]){cut, loose}, 2, NOWHERE);
    csgm_scene *scene = test_seal(&s.builder, root);
    assert_int_equal(scene->formula_count, 2);
    assert_int_equal(scene->step_count, 8);
    test_near(csg_scene_lipschitz(scene), 5, 0);
    test_near(test_sample(scene, csg_vec3_make(10.5, 0, 0)).value, 0.25, 1e-15);
    test_near_vec3(test_sample(scene, csg_vec3_make(10.5, 0, 0)).gradient, csg_vec3_make(-1, 0, 0),
                   1e-15);
    /* outside of its bounds a field is what it is at their side */
    test_near(test_sample(scene, csg_vec3_make(14, 0, 0)).value, -0.5, 1e-15);
    csg_scene_destroy(scene);
    test_context_end(&s.context);
}

static void test_field_bounds(void **state)
{
    scene_bench s;
    scene_begin(&s);
    csg_box box = {{-1, -2, -3}, {1, 2, 4}};
    csgm_scene *scene =
        test_seal(&s.builder, csg_build_field(&s.builder, slab, 4, box, true, 0, NOWHERE));
    csg_box bounds = csg_bounds_of_solid(scene);
    test_near_vec3(bounds.min, box.min, 1e-12);
    test_near_vec3(bounds.max, box.max, 1e-12);
    test_near(csg_scene_lipschitz(scene), 2, 0.05);
    csg_scene_destroy(scene);
    test_context_end(&s.context);
}

static void refuse(const csg_formula_step *steps, uint32_t count, csg_box box, double lambda,
                   const char *problem)
{
    scene_bench s;
    scene_begin(&s);
    assert_int_equal(csg_build_field(&s.builder, steps, count, box, true, lambda, NOWHERE),
                     CSG_NODE_NONE);
    assert_int_equal(s.builder.status, CSGM_ERR_SCENE);
    if (!strstr(s.builder.problem, problem))
        fail_msg("'%s' does not say '%s'", s.builder.problem, problem);
    csg_build_abandon(&s.builder);
    test_context_end(&s.context);
}

static void test_refused(void **state)
{
    csg_box box = {{-1, -1, -1}, {1, 1, 1}}, flat = {{-1, -1, 1}, {1, 1, 1}};
    const csg_formula_step infinite[] = {{.op = CSG_FORMULA_CONSTANT, .constant = INFINITY}};
    const csg_formula_step early[] = {{.op = CSG_FORMULA_NEG, .a = 0}};
    refuse(slab, 4, csg_box_all(), 0, "give bounds");
    refuse(slab, 4, flat, 0, "bounds are empty");
    refuse(slab, 4, box, -1, "lipschitz must be");
    refuse(slab, 4, box, INFINITY, "lipschitz must be");
    refuse(infinite, 1, box, 0, "not finite");
    refuse(early, 1, box, 0, "not finite");
    refuse(slab, 0, box, 0, "more than");
    const csg_formula_step steep[] = {{.op = CSG_FORMULA_X}, {.op = CSG_FORMULA_FLOOR, .a = 0}};
    refuse(steep, 2, box, 0, "give lipschitz");
}

/* A sum that needs all of its many summands at once. */
static void test_too_wide(void **state)
{
    enum { SUMMANDS = 600 };
    static csg_formula_step steps[2 * SUMMANDS + 2];
    uint32_t count = 1;
    steps[0] = (csg_formula_step){.op = CSG_FORMULA_X};
    for (uint32_t i = 0; i < SUMMANDS; i++, count++)
        steps[count] = (csg_formula_step){.op = CSG_FORMULA_SIN, .a = i ? count - 1 : 0};
    uint32_t sum = count - 1;
    for (uint32_t i = 1; i < SUMMANDS; i++, count++) {
        steps[count] = (csg_formula_step){.op = CSG_FORMULA_ADD, .a = sum, .b = SUMMANDS - i};
        sum = count;
    }
    refuse(steps, count, (csg_box){{-1, -1, -1}, {1, 1, 1}}, 1, "intermediate values");
}

/* Without a value a point is far outside. */
static void test_no_value(void **state)
{
    const csg_formula_step root[] = {{.op = CSG_FORMULA_X}, {.op = CSG_FORMULA_SQRT, .a = 0}};
    csg_formula_dual at = evaluate(root, 2, csg_box_all(), csg_vec3_make(-1, 0, 0));
    assert_true(at.value == -CSG_FORMULA_FAR);
    assert_true(csg_vec3_norm(at.gradient) == 0);
    at = evaluate(root, 2, csg_box_all(), csg_vec3_make(0, 0, 0));
    assert_true(at.value == 0 && csg_vec3_norm(at.gradient) == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_simplification),
        cmocka_unit_test(test_values),
        cmocka_unit_test(test_gradients),
        cmocka_unit_test(test_lipschitz_holds),
        cmocka_unit_test(test_lipschitz_of_distances),
        cmocka_unit_test(test_field_node),
        cmocka_unit_test(test_field_bounds),
        cmocka_unit_test(test_refused),
        cmocka_unit_test(test_too_wide),
        cmocka_unit_test(test_no_value),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
