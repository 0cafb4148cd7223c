/* SPDX-License-Identifier: MIT
 * Formulas: building, values, gradients, Lipschitz constants that nothing refutes, and fields as
 * nodes of a scene.
 */
#include <string.h>

#include "rounds.h"
#include "scene/formula/formula.h"
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
    for (int turn = 0; turn < ROUNDS(300); turn++) {
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
    assert_true(finite > ROUNDS(290));
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

/* ---- stated constants -------------------------------------------------------------------------
 */

static csg_slope_trial try_constant(bench *b, csg_formula_id id, csg_box box, double stated)
{
    csg_formula_step steps[64];
    uint32_t count = csg_formula_collect(&b->builder, id, steps);
    return csg_formula_try_lipschitz(&b->context.memory, steps, count, box, stated);
}

static void check_refuted(bench *b, csg_formula_id id, csg_box box, double stated, double slope)
{
    csg_slope_trial trial = try_constant(b, id, box, stated);
    assert_int_equal(trial.verdict, CSG_SLOPE_REFUTED);
    test_near(trial.slope, slope, 0.01 * slope);
    assert_true(csg_box_contains_box(box, (csg_box){trial.place, trial.place}));
}

/* a * sin(200 x), which changes by 200 a pi / 180. */
static csg_formula_id waves(bench *b, double a)
{
    csg_formula_id angle = apply(b, CSG_FORMULA_MUL, b->x, constant(b, 200));
    return apply(b, CSG_FORMULA_MUL, constant(b, a), apply(b, CSG_FORMULA_SIN, angle, 0));
}

static void test_stated_constants(void **state)
{
    const double one_degree = M_PI / 180;
    bench b;
    bench_begin(&b);
    csg_box box = {{-2, -2, -2}, {2, 2, 2}}, all = csg_box_all();
    csg_formula_id ball = length(&b, length(&b, b.x, b.y), b.z);
    csg_formula_id square = apply(&b, CSG_FORMULA_MUL, b.x, b.x);
    csg_formula_id steep = apply(&b, CSG_FORMULA_MUL, ball, constant(&b, 100));
    csg_formula_id wavy = apply(&b, CSG_FORMULA_SUB, waves(&b, 3), ball);
    assert_int_equal(try_constant(&b, ball, box, 1).verdict, CSG_SLOPE_PROVEN);
    assert_int_equal(try_constant(&b, ball, all, 1).verdict, CSG_SLOPE_PROVEN);
    assert_int_equal(try_constant(&b, square, box, 4.5).verdict, CSG_SLOPE_PROVEN);
    assert_int_equal(try_constant(&b, wavy, box, 12).verdict, CSG_SLOPE_PROVEN);
    check_refuted(&b, square, box, 3, 4);
    check_refuted(&b, steep, box, 1, 100);
    check_refuted(&b, steep, box, 99.9, 100);
    check_refuted(&b, wavy, box, 1, 1 + 600 * one_degree);
    /* all of space is not what a scene looks at */
    csg_slope_trial trial = try_constant(&b, steep, all, 1);
    assert_int_equal(trial.verdict, CSG_SLOPE_UNDECIDED);
    test_near(trial.bound, 100, 1e-9);
    trial = try_constant(&b, square, all, 1);
    assert_true(trial.verdict == CSG_SLOPE_UNDECIDED && isinf(trial.bound));
    /* by less than rounding */
    trial = try_constant(&b, square, box, 4);
    assert_true(trial.verdict == CSG_SLOPE_PROVEN || trial.bound < 4.1);
    assert_int_equal(try_constant(&b, steep, box, 100 * (1 - 1e-8)).verdict, CSG_SLOPE_UNDECIDED);
    bench_end(&b);
}

/* min(x, max(x, 100 x)) is x, though derivatives at 0 say 100; |x| - |x| + x has kinks that cancel.
 */
static void test_kinks_refute_nothing(void **state)
{
    bench b;
    bench_begin(&b);
    csg_box box = {{-1, -1, -1}, {1, 1, 1}};
    csg_formula_id steep = apply(&b, CSG_FORMULA_MUL, b.x, constant(&b, 100));
    csg_formula_id most = apply(&b, CSG_FORMULA_MAX, b.x, steep);
    csg_slope_trial trial = try_constant(&b, apply(&b, CSG_FORMULA_MIN, b.x, most), box, 1);
    assert_int_not_equal(trial.verdict, CSG_SLOPE_REFUTED);
    /* where intervals know nothing, the rest is looked at all the same */
    csg_formula_id floor = apply(&b, CSG_FORMULA_FLOOR, b.y, 0);
    trial = try_constant(&b, apply(&b, CSG_FORMULA_ADD, floor, b.x), box, 1);
    assert_true(trial.verdict == CSG_SLOPE_UNDECIDED && isinf(trial.bound));
    check_refuted(&b, apply(&b, CSG_FORMULA_ADD, floor, steep), box, 1, 100);
    bench_end(&b);
}

/* A constant that was found is proven; seven tenths of it are proven only where nothing is steeper,
 * and refuted only where something is. */
static void test_stated_constants_of_random(void **state)
{
    csgm_context context;
    test_context_init(&context);
    csg_random random = {13};
    static csg_formula_step steps[TEST_MOST_STEPS];
    csg_box box = {{-2, -1.5, -1}, {1, 1.5, 2}};
    size_t verdicts[3] = {0};
    for (int turn = 0; turn < ROUNDS(100); turn++) {
        uint32_t count =
            test_random_formula(&context.memory, &random, 1 + (unsigned)turn % 16, true, steps);
        double lambda = csg_formula_lipschitz(&context.memory, steps, count, box), steepest = 0;
        if (!isfinite(lambda) || lambda == 0)
            continue;
        csg_slope_trial trial =
            csg_formula_try_lipschitz(&context.memory, steps, count, box, lambda);
        assert_int_equal(trial.verdict, CSG_SLOPE_PROVEN);
        double stated = 0.7 * lambda;
        trial = csg_formula_try_lipschitz(&context.memory, steps, count, box, stated);
        verdicts[trial.verdict]++;
        for (int i = 0; i < 500; i++) {
            csg_vec3 p = point_in(&random, box), q = point_in(&random, box);
            double rise =
                evaluate(steps, count, box, p).value - evaluate(steps, count, box, q).value;
            steepest = fmax(steepest, fabs(rise) / csg_vec3_norm(csg_vec3_sub(p, q)));
        }
        double known = trial.verdict == CSG_SLOPE_PROVEN      ? stated
                       : trial.verdict == CSG_SLOPE_UNDECIDED ? trial.bound
                                                              : lambda;
        assert_true(steepest <= known * (1 + 1e-6));
        if (trial.verdict == CSG_SLOPE_REFUTED)
            assert_true(trial.slope > stated && trial.slope <= lambda * (1 + 1e-6));
    }
    print_message("undecided %zu, proven %zu, refuted %zu\n", verdicts[0], verdicts[1],
                  verdicts[2]);
    assert_true(verdicts[CSG_SLOPE_REFUTED] > ROUNDS(40));
    test_context_end(&context);
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
    csg_node_id cut =
        csg_build_field(&s.builder, slab, 4, &(csg_field_domain){box, true, 0, false}, NOWHERE);
    csg_node_id loose =
        csg_build_field(&s.builder, slab, 4, &(csg_field_domain){box, false, 5, true}, NOWHERE);
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
        test_seal(&s.builder, csg_build_field(&s.builder, slab, 4,
                                              &(csg_field_domain){box, true, 0, false}, NOWHERE));
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
    const csg_field_domain domain = {box, true, lambda, false};
    assert_int_equal(csg_build_field(&s.builder, steps, count, &domain, NOWHERE), CSG_NODE_NONE);
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

static double constant_of_field(const csg_formula_step *steps, uint32_t count,
                                csg_field_domain domain)
{
    scene_bench s;
    scene_begin(&s);
    csgm_scene *scene =
        test_seal(&s.builder, csg_build_field(&s.builder, steps, count, &domain, NOWHERE));
    double lambda = csg_scene_lipschitz(scene);
    csg_scene_destroy(scene);
    test_context_end(&s.context);
    return lambda;
}

static void test_stated_constants_of_nodes(void **state)
{
    const csg_formula_step line[] = {{.op = CSG_FORMULA_X}},
                           jumps[] = {{.op = CSG_FORMULA_X}, {.op = CSG_FORMULA_FLOOR, .a = 0}};
    csg_box box = {{-1, -1, -1}, {1, 1, 1}}, all = csg_box_all();
    refuse(slab, 4, box, 1, "lipschitz = 1 is too small: at [");
    refuse(line, 1, box, 0.5, "the function changes by 1 along one unit of length");
    test_near(constant_of_field(line, 1, (csg_field_domain){box, true, 3, false}), 3, 0);
    test_near(constant_of_field(line, 1, (csg_field_domain){all, false, 0.5, false}), 1, 1e-12);
    test_near(constant_of_field(line, 1, (csg_field_domain){all, false, 0.5, true}), 0.5, 0);
    test_near(constant_of_field(slab, 4, (csg_field_domain){all, false, 7, false}), 7, 0);
    test_near(constant_of_field(jumps, 2, (csg_field_domain){box, true, 9, false}), 9, 0);
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
        cmocka_unit_test(test_stated_constants),
        cmocka_unit_test(test_kinks_refute_nothing),
        cmocka_unit_test(test_stated_constants_of_random),
        cmocka_unit_test(test_field_node),
        cmocka_unit_test(test_field_bounds),
        cmocka_unit_test(test_refused),
        cmocka_unit_test(test_stated_constants_of_nodes),
        cmocka_unit_test(test_too_wide),
        cmocka_unit_test(test_no_value),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
