/* SPDX-License-Identifier: MIT
 * How far random scenes reach along the axes and along random directions: the place that is said to
 * be in the solid is, by the reference, and no place that is in it reaches farther than is said.
 */
#include "measure/extent.h"
#include "mesh/mesh_support.h"
#include "mesh/watch.h"
#include "scene/primitives/kinds.h"

enum { DIRECTIONS = 8, PLACES = 300, STEPS = 40, MOST_CUBES = 1 << 12 };

static double tolerance = 1e-4; /* of the longest side */

typedef struct tally {
    uint32_t found, close, places;
} tally;

static csg_vec3 direction_of(csg_random *random, int i)
{
    const csg_vec3 axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    if (i < 6)
        return csg_vec3_scale(axes[i % 3], i < 3 ? 1 : -1);
    csg_vec3 d = csg_vec3_make(csg_random_uniform(random, -1, 1), csg_random_uniform(random, -1, 1),
                               csg_random_uniform(random, 0.1, 1));
    return csg_vec3_scale(d, 1 / csg_vec3_norm(d));
}

/* From a place in the solid to one that reaches farther: steps that leave it are made smaller. */
static csg_vec3 climb(const mesh_case *m, csg_random *random, csg_vec3 p, csg_vec3 d, double step)
{
    for (int i = 0; i < STEPS; i++) {
        csg_vec3 aside =
            csg_vec3_make(csg_random_uniform(random, -1, 1), csg_random_uniform(random, -1, 1),
                          csg_random_uniform(random, -1, 1));
        csg_vec3 to = csg_vec3_add(p, csg_vec3_scale(csg_vec3_add(aside, d), step));
        bool is_better =
            test_sample(m->scene, to).value > 0 && csg_vec3_dot(to, d) > csg_vec3_dot(p, d);
        p = is_better ? to : p;
        step *= is_better ? 1.5 : 0.7;
    }
    return p;
}

static void try_direction(const mesh_case *m, csg_random *random, csg_vec3 d,
                          const csg_support_point *is, tally *seen)
{
    const csg_box b = m->field->bounds;
    double size = csg_box_longest_side(b), rounding = 1e-6 * size;
    csg_vec3 best = csg_vec3_make(0, 0, 0);
    double most = -INFINITY;
    if (is->is_found) {
        csg_vec3 at = csg_vec3_add(is->at, m->field->center);
        double f = test_sample(m->scene, at).value;
        if (f < -rounding)
            fail_msg("f = %g at a place that is said to be in the solid", f);
        seen->found++;
        seen->close += is->high - is->low <= 1.01 * tolerance * size;
    }
    for (int i = 0; i < PLACES; i++) {
        csg_vec3 p = csg_vec3_make(csg_random_uniform(random, b.min.x, b.max.x),
                                   csg_random_uniform(random, b.min.y, b.max.y),
                                   csg_random_uniform(random, b.min.z, b.max.z));
        if (test_sample(m->scene, p).value > 0 && csg_vec3_dot(p, d) > most) {
            most = csg_vec3_dot(p, d);
            best = p;
        }
    }
    if (!(most > -INFINITY))
        return;
    best = csg_vec3_sub(climb(m, random, best, d, 0.05 * size), m->field->center);
    if (csg_vec3_dot(best, d) > is->high + rounding)
        fail_msg("the solid reaches as far as %.9g, said is %.9g .. %.9g", csg_vec3_dot(best, d),
                 is->low, is->high);
    seen->places++;
}

static void try_scene(mesh_case *m, csg_random *random, tally *seen)
{
    csg_vec3 directions[DIRECTIONS];
    csg_support_point reaches[DIRECTIONS];
    csg_mesh_watch watch = {0};
    csg_measure_walk walk;
    const csgm_monitor monitor = {0};
    const csg_box b = m->field->bounds;
    if (!csg_box_is_finite(b) || csg_box_is_empty(b))
        return;
    for (int i = 0; i < DIRECTIONS; i++)
        directions[i] = direction_of(random, i);
    csg_mesh_watch_begin(&watch, &m->context, &monitor, 0);
    assert_int_equal(csg_measure_walk_begin(&walk, &m->context, m->field, &watch), CSGM_OK);
    assert_int_equal(csg_measure_reaches(&walk, directions, DIRECTIONS,
                                         tolerance * csg_box_longest_side(b), MOST_CUBES, reaches),
                     CSGM_OK);
    for (int i = 0; i < DIRECTIONS; i++)
        try_direction(m, random, directions[i], &reaches[i], seen);
    csg_measure_walk_release(&walk);
}

static void reaches_hold(void **state)
{
    tally seen = {0};
    for (uint64_t i = 0; i < ROUNDS(24) * test_times; i++) {
        csg_random random = {.state = 52000 + test_first_seed + i};
        mesh_case m;
        mesh_case_begin(&m, 1);
        csg_node_id root = test_random_mixed(&m.builder, &random, i);
        assert_true(root != CSG_NODE_NONE);
        mesh_case_compile(&m, root);
        if (!test_has_debulge(m.scene))
            try_scene(&m, &random, &seen);
        mesh_case_end(&m);
    }
    assert_true(seen.found > ROUNDS(100) * test_times && seen.places > ROUNDS(100) * test_times);
    assert_true(3 * seen.close > 2 * seen.found);
}

/* Floats are not what keeps tight bounds of blended curved solids from being found. */
static void smooth_ones_are_close(void **state)
{
    tally seen = {0};
    tolerance = 1e-5;
    for (uint64_t i = 0; i < ROUNDS(10) * test_times; i++) {
        csg_random random = {.state = 53000 + test_first_seed + i};
        mesh_case m;
        csg_node_id ids[2];
        mesh_case_begin(&m, 1);
        for (int k = 0; k < 2; k++) {
            double v[CSG_PRIMITIVE_MOST_PARAMETERS];
            for (int n = 0; n < 4; n++)
                v[n] = csg_random_uniform(&random, 0.1, n == 3 ? 0.2 : 1);
            csg_primitive_kind kind = (csg_primitive_kind)CSG_NODE_FRUSTUM;
            csg_node_id id = csg_build_primitive(&m.builder, kind, v, NOWHERE);
            ids[k] = posed_anyhow(&m, id, &random);
        }
        mesh_case_compile(&m, joined(&m, CSG_NODE_UNION, ROUND(0.3), ids[0], ids[1]));
        try_scene(&m, &random, &seen);
        mesh_case_end(&m);
    }
    assert_true(seen.found == DIRECTIONS * ROUNDS(10) * test_times && seen.close == seen.found);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(reaches_hold),
                                       cmocka_unit_test(smooth_ones_are_close)};
    test_take_search(argc, argv);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
