/* SPDX-License-Identifier: MIT
 * The fillet (scene/operators/fillet.h, operators.md 16): golden values (golden_fillet.py), the
 * same bits in any order, what it may exceed its operands by, and where it ends.
 */
#include "golden_rows.h"
#include "random_scene.h"
#include "scene/operators/fillet.h"
#include "scene/primitives/kinds.h"

enum { MOST = 24 };

/* Operands in their order; returns how many have a gradient. */
static uint32_t arrange(const double *values, const double *gradients, uint32_t count,
                        csg_fillet_operand *out)
{
    uint32_t made = 0;
    for (uint32_t k = 0; k < count; k++) {
        csg_fillet_operand o = {.index = k};
        const double *g = &gradients[3 * k];
        if (csg_fillet_set(&o, values[k], g[0], g[1], g[2]))
            made = csg_fillet_insert(out, made, &o);
    }
    return made;
}

static void check_golden(const row *r)
{
    double values[MOST], gradients[3 * MOST], shares[MOST], found[MOST] = {0};
    uint32_t count = (uint32_t)split_numbers(r->fields[2], values);
    assert_int_equal(split_numbers(r->fields[3], gradients), 3 * count);
    assert_int_equal(split_numbers(r->fields[5], shares), count);
    csg_fillet_operand operands[CSG_FILLET_MOST];
    const csg_fillet_ends none = {0};
    assert_int_equal(arrange(values, gradients, count, operands), count);
    csg_fillet_choice best = csg_fillet_solve(number(r->fields[1]), operands, count, &none);
    test_near(operands[0].f + best.excess, number(r->fields[4]), 2e-15);
    for (uint32_t i = 0; i < best.count; i++)
        found[operands[best.at[i]].index] = best.share[i];
    for (uint32_t k = 0; k < count && best.count > 1; k++)
        test_near(found[k], shares[k], 1e-12);
}

static void test_golden(void **state)
{
    for_each("fillet", 42, check_golden);
}

/* Random operands, some of them equal. */
static uint32_t random_operands(csg_random *random, double *values, double *gradients)
{
    uint32_t count = 1 + csg_random_below(random, MOST);
    for (uint32_t k = 0; k < count; k++) {
        csg_vec3 g = test_direction(random);
        bool again = k && csg_random_below(random, 3) == 0;
        values[k] = again ? values[k - 1] : csg_random_uniform(random, -1, 0);
        again = k && csg_random_below(random, 4) == 0;
        for (uint32_t i = 0; i < 3; i++)
            gradients[3 * k + i] = again ? gradients[3 * k - 3 + i] : i ? i == 1 ? g.y : g.z : g.x;
    }
    return count;
}

/* However they are ordered, whatever is out of reach. */
static void test_order(void **state)
{
    csg_random random = {71};
    const csg_fillet_ends none = {0};
    for (int i = 0; i < 4000; i++) {
        double values[2 * MOST], gradients[6 * MOST], r = csg_random_uniform(&random, 0.1, 0.6);
        uint32_t count = random_operands(&random, values, gradients);
        csg_fillet_operand one[CSG_FILLET_MOST], other[CSG_FILLET_MOST];
        uint32_t reach = arrange(values, gradients, count, one);
        csg_fillet_choice first = csg_fillet_solve(r, one, reach, &none);
        for (uint32_t k = 0; k + 1 < count; k++) { /* shuffled */
            uint32_t with = k + csg_random_below(&random, count - k);
            double value = values[k];
            values[k] = values[with];
            values[with] = value;
            for (uint32_t c = 0; c < 3; c++) {
                double g = gradients[3 * k + c];
                gradients[3 * k + c] = gradients[3 * with + c];
                gradients[3 * with + c] = g;
            }
        }
        arrange(values, gradients, count, other);
        csg_fillet_choice second = csg_fillet_solve(r, other, reach, &none);
        assert_int_equal(first.count, second.count);
        assert_memory_equal(&first.excess, &second.excess, sizeof first.excess);
        assert_memory_equal(first.share, second.share, sizeof first.share);
        double top = one[0].f, low[2] = {INFINITY, INFINITY};
        for (uint32_t k = 1; k < reach && k < 3; k++)
            low[k - 1] = top - one[k].f;
        assert_true(first.excess >= 0 && first.excess <= csg_fillet_bound(r, low[0], low[1], 2));
        double least = 2, most = 0;
        for (uint32_t k = 0; k < reach; k++)
            for (uint32_t l = 0; l < k; l++) {
                least = fmin(least, csg_fillet_turn(&one[k], &one[l]));
                most = fmax(most, csg_fillet_turn(&one[k], &one[l]));
            }
        assert_true(first.excess <= csg_fillet_bound(r, low[0], low[1], most) + 1e-15);
        assert_true(reach < 2 || first.excess >= csg_fillet_least(r, low[0], least, most) - 1e-15);
    }
}

/* Operands that lie by 2 r below the largest change no bit. */
static void test_reach(void **state)
{
    csg_random random = {72};
    const csg_fillet_ends none = {0};
    for (int i = 0; i < 4000; i++) {
        double values[MOST], gradients[3 * MOST], r = csg_random_uniform(&random, 0.05, 0.4);
        uint32_t count = random_operands(&random, values, gradients);
        csg_fillet_operand all[CSG_FILLET_MOST];
        uint32_t reach = arrange(values, gradients, count, all), near = 0;
        while (near < reach && all[0].f - all[near].f < 2 * r)
            near++;
        csg_fillet_choice one = csg_fillet_solve(r, all, reach, &none);
        csg_fillet_choice other = csg_fillet_solve(r, all, near, &none);
        assert_memory_equal(&one.excess, &other.excess, sizeof one.excess);
    }
}

/* ---- in scenes -------------------------------------------------------------------------------- */

static csgm_context context;
static csg_scene_builder builder;

static int begin(void **state)
{
    test_context_init(&context);
    return csg_build_begin(&builder, &context) == CSGM_OK ? 0 : -1;
}

static int end(void **state)
{
    csg_build_abandon(&builder);
    test_context_end(&context);
    return 0;
}

static csg_node_id block(csg_vec3 low, csg_vec3 high)
{
    csg_vec3 half = csg_vec3_scale(csg_vec3_sub(high, low), 0.5);
    csg_affine place = csg_affine_translate(csg_vec3_add(low, half));
    return csg_build_transform(
        &builder, &place,
        csg_build_primitive(&builder, CSG_NODE_BOX, (double[]){half.x, half.y, half.z, 0}, NOWHERE),
        NOWHERE);
}

static csgm_scene *united(double r, const csg_node_id *nodes, size_t count)
{
    return test_seal(&builder, csg_build_operator(&builder, CSG_NODE_UNION, csg_blend_fillet(r),
                                                  nodes, count, NOWHERE));
}

static csgm_scene *bracket(void)
{
    csg_node_id nodes[2] = {block((csg_vec3){0, 0, 0}, (csg_vec3){40, 20, 5}),
                            block((csg_vec3){0, 0, 0}, (csg_vec3){5, 20, 40})};
    return united(3, nodes, 2);
}

/* The arc has its radius, the ends are flush, the floor is flat, the box is that of the operands.
 */
static void test_bracket(void **state)
{
    csgm_scene *scene = bracket();
    csg_box box = csg_bounds_of_solid(scene);
    assert_true(box.min.x == 0 && box.min.y == 0 && box.min.z == 0);
    assert_true(box.max.x == 40 && box.max.y == 20 && box.max.z == 40);
    for (double angle = 0.05; angle < 1.55; angle += 0.1) {
        csg_vec3 p = {8 - 3 * cos(angle), 10, 8 - 3 * sin(angle)};
        test_near(test_sample(scene, p).value, 0, 1e-14);
        p.y = 0;
        test_near(test_sample(scene, p).value, 0, 1e-14);
        p.y = -1e-9;
        assert_true(test_sample(scene, p).value < 0);
    }
    for (double x = 0.5; x < 40; x += 0.7) {
        assert_true(test_sample(scene, csg_vec3_make(x, 7, 0)).value == 0);
        test_near(test_sample(scene, csg_vec3_make(x, 7, -0.01)).value, -0.01, 1e-15);
    }
    csg_scene_destroy(scene);
}

/* What does not meet is left as it is; so are faces that continue each other. */
static void test_apart(void **state)
{
    csg_node_id plates[2] = {block((csg_vec3){0, 0, 0}, (csg_vec3){40, 40, 5}),
                             block((csg_vec3){0, 0, 7}, (csg_vec3){40, 40, 12})};
    csgm_scene *scene = united(8, plates, 2);
    csg_random random = {73};
    for (int i = 0; i < 2000; i++) {
        csg_vec3 p = csg_vec3_add(csg_vec3_make(20, 20, 6), test_point(&random, 22));
        double sharp = fmax(fmin(p.z, 5 - p.z), fmin(p.z - 7, 12 - p.z));
        sharp = fmin(sharp, fmin(fmin(p.x, 40 - p.x), fmin(p.y, 40 - p.y)));
        if (fabs(sharp) > 1e-9)
            assert_int_equal(test_sample(scene, p).value > 0, sharp > 0);
    }
    csg_scene_destroy(scene);
    assert_int_equal(csg_build_begin(&builder, &context), CSGM_OK);
    csg_node_id stacked[2] = {block((csg_vec3){0, 0, 0}, (csg_vec3){10, 10, 5}),
                              block((csg_vec3){0, 0, 5}, (csg_vec3){10, 10, 9})};
    scene = united(2, stacked, 2);
    for (int i = 0; i < 2000; i++) {
        csg_vec3 p = csg_vec3_add(csg_vec3_make(5, 5, 5), test_point(&random, 7));
        double whole = fmin(fmin(fmin(p.x, 10 - p.x), fmin(p.y, 10 - p.y)), fmin(p.z, 9 - p.z));
        if (whole < -1e-9)
            assert_true(test_sample(scene, p).value < 0);
    }
    csg_scene_destroy(scene);
}

static csg_node_id rod(double low, double high, double r)
{
    csg_affine place = csg_affine_translate(csg_vec3_make(3, 4, (low + high) / 2));
    return csg_build_transform(&builder, &place,
                               csg_build_primitive(&builder, CSG_NODE_FRUSTUM,
                                                   (double[]){r, r, (high - low) / 2, 0}, NOWHERE),
                               NOWHERE);
}

/* So are cylinders on one axis. */
static void test_one_axis(void **state)
{
    csg_random random = {75};
    csg_node_id rods[2] = {rod(0, 9, 4), rod(8, 15, 4)};
    csgm_scene *scene = united(2, rods, 2);
    for (int i = 0; i < 2000; i++) {
        csg_vec3 p = csg_vec3_add(csg_vec3_make(3, 4, 8), test_point(&random, 9));
        double whole = fmin(fmin(p.z, 15 - p.z), 4 - hypot(p.x - 3, p.y - 4));
        if (whole < -1e-9)
            assert_true(test_sample(scene, p).value < 0);
    }
    csg_scene_destroy(scene);
}

static csg_node_id ball(double x, double y, double z, double r)
{
    csg_affine place = csg_affine_translate(csg_vec3_make(x, y, z));
    return csg_build_transform(
        &builder, &place, csg_build_primitive(&builder, CSG_NODE_SPHERE, (double[]){r}, NOWHERE),
        NOWHERE);
}

/* Balls side by side turn from each other as a groove's faces do, in a ring around their gap. */
static void test_balls_apart(void **state)
{
    csg_random random = {76};
    const double gaps[] = {0.002, 0.02, 0.4, 2};
    for (int i = 0; i < 4; i++) {
        csg_node_id balls[2] = {ball(0, 0, 0, 5), ball(10 + gaps[i], 0, 0, 5)};
        csgm_scene *scene = united(3, balls, 2);
        const double by =
            csg_scene_parameters(scene, &scene->nodes[scene->root])[CSG_FILLET_APART_BY];
        assert_true(by > 0.9 * gaps[i] && by < 1.5 * gaps[i]);
        for (int k = 0; k < 2000; k++) {
            csg_vec3 p = csg_vec3_add(csg_vec3_make(5 + gaps[i] / 2, 0, 0), test_point(&random, 3));
            double other = 5 - csg_vec3_norm(csg_vec3_sub(p, csg_vec3_make(10 + gaps[i], 0, 0)));
            test_near(test_sample(scene, p).value, fmax(5 - csg_vec3_norm(p), other), 1e-12);
        }
        csg_scene_destroy(scene);
        assert_int_equal(csg_build_begin(&builder, &context), CSGM_OK);
    }
    csg_node_id balls[2] = {ball(0, 0, 0, 5), ball(9.9, 0, 0, 5)}; /* these meet */
    csgm_scene *scene = united(3, balls, 2);
    assert_true(test_sample(scene, csg_vec3_make(4.95, 1.5, 0)).value > 0);
    csg_scene_destroy(scene);
}

/* The same of pins on a plate, of which each has its own fillet, in any order; and of bores. */
static void test_pins_apart(void **state)
{
    csg_random random = {77};
    for (int cut = 0; cut < 2; cut++) {
        csgm_scene *scenes[4];
        for (int i = 0; i < 4; i++) {
            csg_node_id plate = block((csg_vec3){-20, -20, -3}, (csg_vec3){30, 30, 0});
            csg_node_id pins[2] = {rod(-9, 9, 4), ball(11.5, 4, 0, 4)}; /* 0.5 apart */
            csg_node_id nodes[3] = {plate, pins[i % 2], pins[1 - i % 2]};
            csg_node_kind kind = cut ? CSG_NODE_DIFFERENCE : CSG_NODE_UNION;
            scenes[i] = test_seal(&builder, csg_build_operator(&builder, kind, csg_blend_fillet(2),
                                                               nodes, i < 2 ? 3 : 2, NOWHERE));
            assert_int_equal(csg_build_begin(&builder, &context), CSGM_OK);
        }
        for (int k = 0; k < 4000; k++) {
            csg_vec3 p = csg_vec3_add(csg_vec3_make(7.2, 4, 0), test_point(&random, 5));
            double both = test_sample(scenes[0], p).value, one = test_sample(scenes[2], p).value;
            double other = test_sample(scenes[3], p).value;
            assert_true(both == test_sample(scenes[1], p).value);
            test_near(both, cut ? fmin(one, other) : fmax(one, other), 1e-12);
        }
        for (int i = 0; i < 4; i++)
            csg_scene_destroy(scenes[i]);
    }
}

/* A third operand beyond a face that two share does not let their blend out of it. */
static void test_ends_by_pairs(void **state)
{
    csg_node_id nodes[3] = {block((csg_vec3){0, 0, 0}, (csg_vec3){40, 20, 5}),
                            block((csg_vec3){0, 0, 0}, (csg_vec3){5, 20, 40}),
                            block((csg_vec3){30, -9, 0}, (csg_vec3){35, 29, 12})};
    csgm_scene *scene = united(3, nodes, 3);
    for (double y = -2; y < 0; y += 0.1)
        assert_true(test_sample(scene, csg_vec3_make(6, y, 6)).value < 0);
    test_near(test_sample(scene, csg_vec3_make(8 - 3 * cos(0.7), 0, 8 - 3 * sin(0.7))).value, 0,
              1e-14);
    csg_scene_destroy(scene);
}

/* Nested fillets of one radius are one operator. */
static void test_flattened(void **state)
{
    const csg_blend blend = csg_blend_fillet(2);
    csg_node_id pair[2] = {block((csg_vec3){0, 0, 0}, (csg_vec3){9, 9, 2}),
                           block((csg_vec3){0, 0, 0}, (csg_vec3){2, 9, 9})};
    csg_node_id both[2] = {csg_build_operator(&builder, CSG_NODE_UNION, blend, pair, 2, NOWHERE),
                           block((csg_vec3){0, 0, 0}, (csg_vec3){9, 2, 9})};
    csgm_scene *scene = united(2, both, 2);
    assert_int_equal(scene->nodes[scene->root].child_count, 3);
    csg_scene_destroy(scene);
}

/* Partial derivatives of random trees add up: moving along the gradient of a scene of half-spaces
 * changes the value as it says. */
static void test_planes_are_exact(void **state)
{
    csg_random random = {74};
    for (int i = 0; i < 200; i++) {
        csg_node_id nodes[4];
        for (int k = 0; k < 4; k++) {
            csg_vec3 n = test_direction(&random);
            nodes[k] = csg_build_primitive(&builder, CSG_NODE_PLANE,
                                           (double[]){n.x, n.y, n.z, -0.2}, NOWHERE);
        }
        csgm_scene *scene = united(csg_random_uniform(&random, 0.2, 1), nodes, 4);
        for (int k = 0; k < 50; k++) {
            const double h = 1e-6;
            csg_vec3 p = test_point(&random, 1), d = csg_vec3_scale(test_direction(&random), h);
            csg_sample at = test_sample(scene, p);
            double up = test_sample(scene, csg_vec3_add(p, d)).value - at.value;
            double down = at.value - test_sample(scene, csg_vec3_sub(p, d)).value;
            assert_true(fabs(up) <= h * (1 + 1e-8)); /* K = 1 */
            if (fabs(up - down) < 1e-4 * h)
                test_near(csg_vec3_dot(at.gradient, d), (up + down) / 2, 1e-3 * h);
        }
        csg_scene_destroy(scene);
        assert_int_equal(csg_build_begin(&builder, &context), CSGM_OK);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_golden),
        cmocka_unit_test(test_order),
        cmocka_unit_test(test_reach),
        cmocka_unit_test_setup_teardown(test_bracket, begin, end),
        cmocka_unit_test_setup_teardown(test_apart, begin, end),
        cmocka_unit_test_setup_teardown(test_one_axis, begin, end),
        cmocka_unit_test_setup_teardown(test_balls_apart, begin, end),
        cmocka_unit_test_setup_teardown(test_pins_apart, begin, end),
        cmocka_unit_test_setup_teardown(test_ends_by_pairs, begin, end),
        cmocka_unit_test_setup_teardown(test_flattened, begin, end),
        cmocka_unit_test_setup_teardown(test_planes_are_exact, begin, end),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
