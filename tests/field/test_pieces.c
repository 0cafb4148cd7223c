/* SPDX-License-Identifier: MIT
 * Formulas between their kinks (csg_cone_find_pieces(), csg_kink_values()): what is zero at a kink
 * changes no faster than is said, and where it cannot be zero gradients turn no faster.
 *
 * Usage: field_test_pieces [FORMULAS SEED]
 */
#include <math.h>
#include <stdlib.h>

#include "field/field_support.h"
#include "field/gradients/cone_leaf.h"
#include "field/gradients/kinks.h"
#include "scene/random_formula.h"

enum { BALLS = 40, PAIRS = 16, PLACES = 2 * PAIRS + 1, ROOM = PLACES + CSG_LANES };

static unsigned long formula_count = 400, first_seed = 1;

typedef struct totals {
    unsigned known, with_kinks, bends, kinks;
} totals;

/* Pairs of places in a ball, and its middle. */
typedef struct places {
    float x[ROOM], y[ROOM], z[ROOM];
} places;

static csg_vec3 place_of(const places *p, int i)
{
    return csg_vec3_make((double)p->x[i], (double)p->y[i], (double)p->z[i]);
}

static places places_in(csg_random *random, const float c[3], double radius)
{
    places p;
    for (int i = 0; i < ROOM; i++) {
        csg_vec3 way = csg_vec3_scale(test_direction(random), 0.999 * radius);
        double share = i < PLACES - 1 ? csg_random_uniform(random, 0, 1) : 0;
        p.x[i] = c[0] + (float)(share * way.x);
        p.y[i] = c[1] + (float)(share * way.y);
        p.z[i] = c[2] + (float)(share * way.z);
    }
    return p;
}

/* Whether what is zero at the kink is that nowhere in the ball. */
static bool check_kink(const csg_kernel *kernel, const csg_tape *tape, const csg_kink *kink,
                       const places *p, double radius, float *scratch, size_t floats, totals *t)
{
    float value[ROOM], room[ROOM];
    double rounding = 0x1p-18 * kink->size;
    csg_kink_values(kernel, tape, kink, p->x, p->y, p->z, PLACES, value, room, scratch, floats);
    for (int i = 0; i < 2 * PAIRS; i += 2) {
        double apart = csg_vec3_norm(csg_vec3_sub(place_of(p, i), place_of(p, i + 1)));
        double change = fabs((double)value[i] - (double)value[i + 1]);
        if (!(change <= kink->slope * apart + rounding))
            fail_msg("a kink's value changes by %g on %g, at most %g is said", change, apart,
                     kink->slope);
        t->kinks++;
    }
    return fabs((double)value[PLACES - 1]) > kink->slope * radius + rounding;
}

static void check_bend(const csg_kernel *kernel, const csg_tape *tape, double bend, const places *p,
                       float *scratch, size_t floats, totals *t)
{
    float g[3][ROOM];
    kernel->gradients(tape, p->x, p->y, p->z, PLACES, g[0], g[1], g[2], scratch, floats);
    for (int i = 0; i < 2 * PAIRS; i += 2) {
        double apart = csg_vec3_norm(csg_vec3_sub(place_of(p, i), place_of(p, i + 1)));
        csg_vec3 a = csg_vec3_make((double)g[0][i], (double)g[1][i], (double)g[2][i]);
        csg_vec3 b = csg_vec3_make((double)g[0][i + 1], (double)g[1][i + 1], (double)g[2][i + 1]);
        double turn = csg_vec3_norm(csg_vec3_sub(a, b));
        double rounding = 1e-4 * (1 + csg_vec3_norm(a) + csg_vec3_norm(b));
        if (!(turn <= bend * apart + rounding))
            fail_msg("a gradient turns by %g on %g, at most %g is said", turn, apart, bend);
        t->bends++;
    }
}

static void check_formula(const test_subject *s, const csg_kernel *kernel, csg_random *random,
                          totals *t)
{
    const csg_tape *tape = &s->field->tape;
    size_t floats = csg_kernel_scratch_floats(s->field->depth);
    float *scratch = malloc(floats * sizeof *scratch);
    assert_non_null(scratch);
    for (int ball = 0; ball < BALLS; ball++) {
        csg_vec3 at = test_point(random, 1);
        const float c[3] = {(float)at.x, (float)at.y, (float)at.z};
        double radius = pow(2, csg_random_uniform(random, -7, -1));
        csg_formula_pieces pieces;
        if (!csg_cone_find_pieces(tape, tape->nodes, c, radius, &pieces))
            continue;
        places p = places_in(random, c, radius);
        bool has_none = true;
        for (uint32_t k = 0; k < pieces.kink_count; k++)
            has_none = check_kink(kernel, tape, &pieces.kinks[k], &p, radius, scratch, floats, t) &&
                       has_none;
        if (has_none)
            check_bend(kernel, tape, pieces.bend, &p, scratch, floats, t);
        t->known++;
        t->with_kinks += pieces.kink_count > 0;
    }
    free(scratch);
}

/* Placed so that its frame turns and stretches every other time; a ball where there is none. */
static csg_node_id make_formula(test_subject *s, csg_random *random, unsigned long turn)
{
    static csg_formula_step steps[TEST_MOST_STEPS];
    uint32_t count = test_random_formula(&s->context.memory, random, 1 + (unsigned)turn % 24,
                                         turn % 3 > 0, steps);
    const csg_field_domain domain = {{{-3, -3, -3}, {3, 3, 3}}, false, 1e6, false};
    csg_node_id field = csg_build_field(&s->builder, steps, count, &domain, NOWHERE);
    csg_affine place = turn % 2 ? test_random_affine(random, 0.6, 1.8, 0.3)
                                : csg_affine_translate(test_point(random, 0.3));
    return field == CSG_NODE_NONE ? csg_build_ball(&s->builder, 1, NOWHERE)
                                  : csg_build_transform(&s->builder, &place, field, NOWHERE);
}

static void test_random_formulas(void **state)
{
    const csg_kernel *kernels[8];
    totals t = {0, 0, 0, 0};
    size_t kernel_count = test_kernels(kernels);
    for (unsigned long i = 0; i < formula_count; i++) {
        test_subject s;
        csg_random random = {first_seed + i};
        test_subject_begin(&s);
        test_subject_compile(&s, make_formula(&s, &random, first_seed + i));
        if (s.field->tape.count == 1 && s.field->tape.nodes->op == CSG_OP_FIELD)
            check_formula(&s, kernels[i % kernel_count], &random, &t);
        test_subject_end(&s);
    }
    print_message("%u balls, %u with kinks; %u pairs of gradients, %u of values\n", t.known,
                  t.with_kinks, t.bends, t.kinks);
    assert_true(t.known > 4 * formula_count && t.with_kinks > formula_count / 2);
    assert_true(t.bends > 50 * formula_count && t.kinks > 10 * formula_count);
}

int main(int argc, char **argv)
{
    if (argc > 2) {
        formula_count = strtoul(argv[1], NULL, 10);
        first_seed = strtoul(argv[2], NULL, 10);
    }
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_random_formulas)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
