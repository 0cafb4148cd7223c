/* SPDX-License-Identifier: MIT
 * What mesh/distance/minorant.h says of a triangle, tried at random places of it and on its sides,
 * in random scenes of every family. Arguments: TIMES and SEED of tests/scene/random_scene.h.
 */
#include <stdlib.h>

#include "mesh/distance/minorant.h"
#include "mesh/mesh_support.h"
#include "scene/random_scene.h"

enum { TRIES = 60, SCENES = 160, TRIANGLES = 150 };

typedef struct tally {
    uint32_t known, sided, told; /* on one side at all places tried, and said to be so */
} tally;

/* On a side now and then. */
static csg_vec3 place_on(const csg_vec3 v[3], csg_random *random)
{
    double s = csg_random_uniform(random, 0, 1), t = csg_random_uniform(random, 0, 1 - s);
    if (csg_random_uniform(random, 0, 1) < 0.3)
        t = 1 - s;
    csg_vec3 p = csg_vec3_add(csg_vec3_scale(v[0], s), csg_vec3_scale(v[1], t));
    return csg_vec3_add(p, csg_vec3_scale(v[2], 1 - s - t));
}

static void try_triangle(const mesh_case *c, csg_random *random, csg_vec3 at, double radius,
                         double turn, tally *sum)
{
    const csg_touching field = csg_touching_none(&c->field->tape);
    csg_sided_triangle one = {.turn = turn};
    csg_vec3 v[3];
    double least, lowest = INFINITY;
    for (int k = 0; k < 3; k++) {
        double length = radius * csg_random_uniform(random, 0.05, 1);
        v[k] = csg_vec3_add(at, csg_vec3_scale(test_direction(random), length));
        one.at[k] = csg_vec3_sub(v[k], c->field->center);
    }
    csg_minorants_find(csg_kernel_for(CSGM_ISA_AUTO), &field, &one, 1, &least);
    for (int i = 0; i < TRIES; i++) {
        csg_vec3 p = place_on(v, random);
        double value = turn * test_sample(c->scene, p).value;
        lowest = fmin(lowest, value);
        if (value < least - 1e-4)
            fail_msg("%g times the field is %g, not %g, at (%g, %g, %g), of a triangle within %g",
                     turn, value, least, p.x, p.y, p.z, radius);
    }
    sum->known += least > -INFINITY;
    sum->sided += lowest > 0;
    sum->told += least > 0;
}

static void search(tally *sum, uint64_t seed, bool has_outlines)
{
    csg_random random = {.state = seed};
    for (uint32_t i = 0; i < ROUNDS(SCENES) * test_times; i++) {
        mesh_case c;
        mesh_case_begin(&c, 1);
        test_random_outlines = has_outlines;
        csg_node_id root = has_outlines ? test_random_shaped(&c.builder, &random)
                                        : test_random_mixed(&c.builder, &random, i);
        if (root == CSG_NODE_NONE) {
            csg_build_abandon(&c.builder);
            c.scene = NULL;
            mesh_case_end(&c);
            continue;
        }
        mesh_case_compile(&c, root);
        for (int k = 0; k < TRIANGLES; k++) {
            csg_vec3 at = test_point(&random, 1.6);
            double radius = exp(csg_random_uniform(&random, -5, -0.5));
            csg_sample s = test_sample(c.scene, at);
            if (k % 4 && csg_vec3_norm(s.gradient) > 0.1)
                at = csg_vec3_sub(at, csg_vec3_scale(s.gradient, s.value));
            try_triangle(&c, &random, at, radius, k % 2 ? 1 : -1, sum);
        }
        mesh_case_end(&c);
    }
}

static void minorants_are_below(void **state)
{
    (void)state;
    tally all = {0};
    search(&all, 4001 + test_first_seed * 100, false);
    print_message("%u known, %u on one side, %u told\n", all.known, all.sided, all.told);
    assert_true(all.known * 2 > all.sided);
    assert_true(all.told * 3 > all.sided);
}

static void minorants_of_outlines_are_below(void **state)
{
    (void)state;
    tally all = {0};
    search(&all, 4002 + test_first_seed * 100, true);
    print_message("%u known, %u on one side, %u told\n", all.known, all.sided, all.told);
    assert_true(all.told * 3 > all.sided);
}

int main(int argc, char **argv)
{
    test_take_search(argc, argv);
    const struct CMUnitTest tests[] = {cmocka_unit_test(minorants_are_below),
                                       cmocka_unit_test(minorants_of_outlines_are_below)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
