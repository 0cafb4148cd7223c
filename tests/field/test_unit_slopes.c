/* SPDX-License-Identifier: MIT
 * Leaves divided by their Lipschitz constants (field/unit_slopes.h): the same signs everywhere,
 * bounds over cells that hold every value, and a field that is left alone where more than its signs
 * is looked at.
 */
#include <math.h>
#include <string.h>

#include "field/cones/near_slopes.h"
#include "field/field_support.h"
#include "field/unit_slopes.h"
#include "scene/formula/formula.h"
#include "scene/operators/blend_kinds.h"
#include "scene/random_formula.h"

static const csg_blend SHARP = {0};

typedef struct made {
    test_subject subject;
    csg_arena arena;
    csgm_field evened;
} made;

static csg_node_id formula_of(made *m, csg_random *random, unsigned turn)
{
    static csg_formula_step steps[TEST_MOST_STEPS];
    uint32_t count =
        test_random_formula(&m->subject.context.memory, random, 1 + turn % 24, turn % 3 > 0, steps);
    csg_box box = {{-2, -1.5, -2}, {1.5, 2, 2}};
    const csg_field_domain domain = {box, turn % 2, turn % 3 ? 0 : 1e4, true};
    csg_node_id field = csg_build_field(&m->subject.builder, steps, count, &domain, NOWHERE);
    if (field == CSG_NODE_NONE)
        fail_msg("formula %u: %s", turn, m->subject.builder.problem);
    csg_affine place =
        turn % 4 ? test_random_affine(random, turn % 4 == 1 ? 1 : 0.4, turn % 4 == 1 ? 1 : 2.5, 1)
                 : csg_affine_translate(test_point(random, 1));
    return csg_build_transform(&m->subject.builder, &place, field, NOWHERE);
}

/* A ball with one formula cut out of it, beside another one within a box. */
static void make(made *m, csg_random *random, unsigned turn, csg_blend blend)
{
    test_subject_begin(&m->subject);
    csg_scene_builder *b = &m->subject.builder;
    csg_node_id first[] = {csg_build_ball(b, 1.5, NOWHERE), formula_of(m, random, turn)};
    csg_node_id cut = csg_build_operator(b, CSG_NODE_DIFFERENCE, SHARP, first, 2, NOWHERE);
    csg_node_id second[] = {csg_build_ball(b, 1, NOWHERE), formula_of(m, random, turn + 7)};
    csg_node_id kept = csg_build_operator(b, CSG_NODE_INTERSECTION, SHARP, second, 2, NOWHERE);
    csg_node_id both[] = {cut, kept};
    test_subject_compile(&m->subject,
                         csg_build_operator(b, CSG_NODE_UNION, blend, both, 2, NOWHERE));
    csg_arena_init(&m->arena, &m->subject.context.memory);
    assert_true(csg_field_with_unit_slopes(m->subject.field, &m->arena, &m->evened));
}

static void end(made *m)
{
    csg_arena_reset(&m->arena);
    test_subject_end(&m->subject);
}

static bool is_left_alone(const made *m)
{
    return m->evened.tape.parameters == m->subject.field->tape.parameters;
}

static int sign_of(float value)
{
    return (value > 0) - (value < 0);
}

static size_t compare_signs(const made *m, csg_random *random)
{
    static test_points points;
    static test_results is, was;
    const csg_kernel *kernels[8];
    size_t compared = 0;
    test_kernels(kernels);
    test_points_clear(&points);
    while (test_points_add(&points, test_point(random, 2)))
        continue;
    test_evaluate(kernels[0], &m->subject.field->tape, &points, &was);
    test_evaluate(kernels[0], &m->evened.tape, &points, &is);
    for (size_t i = 0; i < points.count; i++) {
        assert_int_equal(sign_of(was.value[i]), sign_of(is.value[i]));
        assert_true(fabsf(is.value[i]) <= fabsf(was.value[i]) * (1 + 1e-6f));
        compared += is.value[i] != was.value[i];
    }
    return compared;
}

/* In a cube, no value leaves the bounds that are told for it. */
static void check_bounds(const made *m, csg_random *random)
{
    enum { POINTS = 40, MOST_NODES = 16 };
    static float scratch[1 << 16];
    const csg_kernel *kernels[8];
    const csg_tape *tape = &m->evened.tape;
    float low[MOST_NODES * CSG_OCTANTS], high[MOST_NODES * CSG_OCTANTS], c[3][CSG_OCTANTS];
    float half = (float)csg_random_uniform(random, 1e-3, 0.5);
    test_kernels(kernels);
    assert_true(tape->count <= MOST_NODES);
    for (int o = 0; o < CSG_OCTANTS; o++)
        for (int axis = 0; axis < 3; axis++)
            c[axis][o] = (float)csg_random_uniform(random, -2, 2);
    kernels[0]->intervals(tape, c[0], c[1], c[2], half * 1.7320511f, NULL, low, high, scratch);
    for (size_t o = 0; o < CSG_OCTANTS; o++) {
        float at[3][POINTS], f[POINTS];
        for (int i = 0; i < POINTS; i++)
            for (int axis = 0; axis < 3; axis++)
                at[axis][i] = c[axis][o] + half * (float)csg_random_uniform(random, -1, 1);
        kernels[0]->values(tape, at[0], at[1], at[2], POINTS, f, scratch, 1 << 16);
        float l = low[(tape->count - 1) * CSG_OCTANTS + o],
              h = high[(tape->count - 1) * CSG_OCTANTS + o];
        for (int i = 0; i < POINTS; i++)
            assert_true(f[i] >= l - 1e-5f && f[i] <= h + 1e-5f);
        /* and a ball that is free of the surface is */
        for (int i = 1; i < POINTS; i++) {
            double x = (double)(at[0][i] - at[0][0]), y = (double)(at[1][i] - at[1][0]),
                   z = (double)(at[2][i] - at[2][0]);
            double way = sqrt(x * x + y * y + z * z) * (double)tape->lipschitz;
            assert_true(fabs((double)(f[i] - f[0])) <= way * (1 + 1e-4) + 1e-5);
        }
    }
}

/* Near a place formulas are divided by what they climb there: the same signs, no steeper than 1. */
static size_t check_near(const made *m, csg_random *random)
{
    enum { POINTS = 40 };
    static float scratch[1 << 16], parameters[1 << 12];
    const csg_kernel *kernels[8];
    const csg_tape *whole = &m->evened.tape;
    csg_tape near = *whole;
    float half = (float)csg_random_uniform(random, 1e-2, 0.5), c[3], at[3][POINTS];
    float was[POINTS], is[POINTS];
    size_t larger = 0, bytes = m->evened.parameter_count * sizeof *parameters;
    test_kernels(kernels);
    if (!csg_tape_has_near_slopes(whole))
        return 0;
    assert_true(bytes <= sizeof parameters);
    memcpy(parameters, whole->parameters, bytes);
    near.parameters = parameters;
    for (int axis = 0; axis < 3; axis++) {
        c[axis] = (float)csg_random_uniform(random, -1, 1);
        for (int i = 0; i < POINTS; i++)
            at[axis][i] = c[axis] + half * (float)csg_random_uniform(random, -1, 1);
    }
    csg_tape_set_near_slopes(whole, c, (double)half, parameters);
    kernels[0]->values(whole, at[0], at[1], at[2], POINTS, was, scratch, 1 << 16);
    kernels[0]->values(&near, at[0], at[1], at[2], POINTS, is, scratch, 1 << 16);
    for (int i = 0; i < POINTS; i++) {
        double x = (double)(at[0][i] - at[0][0]), y = (double)(at[1][i] - at[1][0]),
               z = (double)(at[2][i] - at[2][0]);
        assert_int_equal(sign_of(was[i]), sign_of(is[i]));
        assert_true(fabs((double)(is[i] - is[0])) <=
                    sqrt(x * x + y * y + z * z) * (1 + 1e-4) + 1e-4);
        larger += fabsf(is[i]) > 1.2f * fabsf(was[i]);
    }
    return larger;
}

static void near_slopes_hold(void **state)
{
    size_t larger = 0;
    for (unsigned turn = 0; turn < 120; turn++) {
        csg_random random = {.state = 4500 + turn};
        made m;
        make(&m, &random, turn, SHARP);
        for (int i = 0; i < 20; i++)
            larger += check_near(&m, &random);
        end(&m);
        make(&m, &random, turn, (csg_blend){CSG_BLEND_ROUND, 0.2, false});
        assert_false(csg_tape_has_near_slopes(&m.evened.tape));
        end(&m);
    }
    assert_true(larger > 5000);
}

static void signs_and_bounds_hold(void **state)
{
    size_t changed = 0, compared = 0;
    for (unsigned turn = 0; turn < 120; turn++) {
        csg_random random = {.state = 4100 + turn};
        made m;
        make(&m, &random, turn, SHARP);
        bool is_steep = m.subject.field->tape.lipschitz > 1 + 0x1p-20f;
        assert_true(is_left_alone(&m) != is_steep);
        if (is_steep) {
            changed++;
            assert_true(m.evened.tape.lipschitz < 1.00001f && m.evened.tape.lipschitz >= 1);
            compared += compare_signs(&m, &random);
            check_bounds(&m, &random);
        }
        end(&m);
    }
    assert_true(changed > 60 && compared > 10000);
}

/* A blend looks at values. */
static void blends_are_left_alone(void **state)
{
    for (unsigned turn = 0; turn < 12; turn++) {
        csg_random random = {.state = 4300 + turn};
        made m;
        make(&m, &random, turn, (csg_blend){CSG_BLEND_ROUND, 0.2, false});
        assert_true(is_left_alone(&m));
        end(&m);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(near_slopes_hold),
        cmocka_unit_test(signs_and_bounds_hold),
        cmocka_unit_test(blends_are_left_alone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
