/* SPDX-License-Identifier: MIT
 * Gradients where the field is zero (mesh/distance/slopes.h, `level`), in cubes around places of
 * the surface: in the balls' hull, and told apart on the sides of a wall.
 */
#include <stdlib.h>

#include "mesh/distance/slopes.h"
#include "mesh/mesh_support.h"
#include "scene/operators/blend_kinds.h"

enum { TRIES = 60 };

static csg_gradients gradients_in_cube(const csgm_field *field, csg_vec3 at, double half,
                                       bool *is_known)
{
    size_t floats = csg_kernel_scratch_floats(field->depth);
    float *scratch = malloc(floats * sizeof *scratch);
    assert_non_null(scratch);
    csg_vec3 c = csg_vec3_sub(at, field->center);
    const csg_gradients_region region = {{c, c, c}, c, 0, half};
    csg_gradients found;
    *is_known = csg_gradients_find(csg_kernel_for(CSGM_ISA_AUTO), &field->tape, &region, scratch,
                                   floats, &found);
    free(scratch);
    return found;
}

/* A place of the surface, by Newton's steps of the reference; false: there is none near. */
static bool go_to_surface(const csgm_scene *scene, csg_vec3 *p)
{
    for (int step = 0; step < 20 && fabs(test_sample(scene, *p).value) > 1e-9; step++) {
        csg_vec3 g = test_sample(scene, *p).gradient;
        double square = fmax(csg_vec3_dot(g, g), 1e-12);
        *p = csg_vec3_sub(*p, csg_vec3_scale(g, test_sample(scene, *p).value / square));
    }
    return fabs(test_sample(scene, *p).value) <= 1e-9;
}

/* From random places of the cube to the surface: where they end in it gradients are in the hull of
 * those at zero, which is tried in many directions. Returns how many did. */
static uint32_t try_level(const csgm_scene *scene, csg_random *random, csg_vec3 at, double half,
                          const csg_gradients *found)
{
    uint32_t count = 0;
    for (int i = 0; i < TRIES; i++) {
        csg_vec3 p = csg_vec3_make(at.x + half * csg_random_uniform(random, -1, 1),
                                   at.y + half * csg_random_uniform(random, -1, 1),
                                   at.z + half * csg_random_uniform(random, -1, 1));
        bool is_there = go_to_surface(scene, &p);
        csg_vec3 off = csg_vec3_sub(p, at), g = test_sample(scene, p).gradient;
        if (!is_there || !(fmax(fabs(off.x), fmax(fabs(off.y), fabs(off.z))) <= half))
            continue;
        for (int k = 0; k < TRIES; k++) {
            double beyond = mesh_beyond_hull(&found->level, g, test_direction(random));
            if (beyond > 1e-3)
                fail_msg("a gradient where the field is zero is %g outside, near (%g, %g, %g) "
                         "within %g",
                         beyond, at.x, at.y, at.z, half);
        }
        count++;
    }
    return count;
}

static void slopes_at_zero_hold(void **state)
{
    (void)state;
    csg_random random = {.state = 103};
    uint32_t tried = 0;
    for (int i = 0; i < 24; i++) {
        const csg_node_kind operators[] = {CSG_NODE_UNION, CSG_NODE_DIFFERENCE,
                                           CSG_NODE_INTERSECTION};
        mesh_case c;
        mesh_case_begin(&c, 1);
        double apart = i % 6 < 3 ? 0.7 : 0.05; /* in a wall gradients are nearly opposite */
        csg_affine beside = csg_affine_translate(csg_vec3_scale(test_direction(&random), apart));
        csg_node_id root = csg_build_ball(&c.builder, 1, NOWHERE);
        csg_node_id other = csg_build_ball(&c.builder, 0.8, NOWHERE);
        other = csg_build_transform(&c.builder, &beside, other, NOWHERE);
        csg_blend blend = {CSG_BLEND_ROUND, csg_random_uniform(&random, 0.1, 0.6), false};
        mesh_case_compile(&c, joined(&c, operators[i % 3], blend, root, other));
        for (int k = 0; k < 12; k++) {
            csg_vec3 at = test_point(&random, 1.2);
            double half = exp(csg_random_uniform(&random, -4, -1));
            bool is_known = go_to_surface(c.scene, &at);
            if (!is_known)
                continue;
            csg_gradients found = gradients_in_cube(c.field, at, half, &is_known);
            if (is_known && found.has_level && !found.exceeds)
                tried += try_level(c.scene, &random, at, half, &found);
        }
        mesh_case_end(&c);
    }
    assert_true(tried > 2000);
}

/* A wall of 0.1 between balls, rounded by 0.12 all through: gradients are opposite on its sides,
 * but in a cube in which one side is zero alone these climb outwards. */
static void one_side_of_a_wall_is_a_sheet(void **state)
{
    (void)state;
    mesh_case c;
    mesh_case_begin(&c, 1);
    csg_node_id outer = csg_build_ball(&c.builder, 1, NOWHERE);
    csg_node_id inner = csg_build_ball(&c.builder, 0.9, NOWHERE);
    mesh_case_compile(&c, joined(&c, CSG_NODE_DIFFERENCE, ROUND(0.12), outer, inner));
    csg_cone cone;
    bool is_known;
    csg_gradients found = gradients_in_cube(c.field, csg_vec3_make(0.985, 0, 0), 0.03, &is_known);
    assert_true(is_known && found.has_level);
    assert_false(csg_cone_find_axis(&found.balls, &cone));
    assert_true(csg_cone_find_axis(&found.level, &cone));
    assert_true(cone.axis[0] < -0.99 && cone.least > 0.02);
    mesh_case_end(&c);
}

/* Both may be zero in a cube as large as the wall, but where one is the other has no share left. */
static void sides_of_a_wall_do_not_mix(void **state)
{
    (void)state;
    mesh_case c;
    mesh_case_begin(&c, 1);
    csg_node_id outer = csg_build_ball(&c.builder, 1, NOWHERE);
    csg_node_id inner = csg_build_ball(&c.builder, 0.9, NOWHERE);
    mesh_case_compile(&c, joined(&c, CSG_NODE_DIFFERENCE, ROUND(0.09), outer, inner));
    csg_cone cone;
    bool is_known;
    csg_gradients found = gradients_in_cube(c.field, csg_vec3_make(0.98, 0, 0), 0.025, &is_known);
    assert_true(is_known && found.has_level);
    assert_true(csg_cone_find_axis(&found.level, &cone));
    assert_true(cone.axis[0] < -0.99 && cone.least > 0.9);
    mesh_case_end(&c);
}

enum hollow { BY_ITSELF, BY_ONE_MOVED, BY_ONE_ROUNDED, HOLLOWS };

/* Three solids that flow into each other. how: in what the second one differs from the first. */
static csg_node_id flowing(mesh_case *c, csg_random random, enum hollow how)
{
    static const int SMOOTH[] = {0, 6, 7, 8};
    double width = how == BY_ONE_ROUNDED ? 1.2 : 0.4;
    csg_node_id all[3];
    for (int i = 0; i < 3; i++) {
        all[i] = make_any_primitive(c, SMOOTH[csg_random_below(&random, 4)], &random);
        all[i] = posed_anyhow(c, all[i], &random);
    }
    if (how == BY_ONE_MOVED)
        all[2] = moved(c, all[2], 0.1, 0, 0);
    return csg_build_operator(&c->builder, CSG_NODE_UNION, ROUND(width), all, 3, NOWHERE);
}

/* A solid that is hollowed by itself, moved inwards, or by one that is nearly it. */
static void compile_hollow(mesh_case *c, csg_random random, double wall, enum hollow how)
{
    csg_node_id body = flowing(c, random, BY_ITSELF), hollow = flowing(c, random, how);
    hollow = csg_build_offset(&c->builder, -wall, hollow, NOWHERE);
    mesh_case_compile(c, joined(c, CSG_NODE_DIFFERENCE, ROUND(0.48 * wall), body, hollow));
}

/* Its sides' gradients are known to be opposite where the solids are the same, and nowhere else. */
static void slopes_of_hollow_solids_hold(void **state)
{
    csg_random random = {.state = 104};
    uint32_t tried[HOLLOWS] = {0}, sheets[HOLLOWS] = {0}, cubes[HOLLOWS] = {0};
    for (int i = 0; i < 90; i++) {
        enum hollow how = (enum hollow)(i % HOLLOWS);
        double wall = csg_random_uniform(&random, 0.05, 0.2);
        csg_cone cone;
        mesh_case c;
        mesh_case_begin(&c, 1);
        csg_random_next(&random);
        compile_hollow(&c, random, wall, how);
        for (int k = 0; k < 12; k++) {
            csg_vec3 at = test_point(&random, 1);
            double half = wall * csg_random_uniform(&random, 0.1, 0.6);
            bool is_known = go_to_surface(c.scene, &at);
            if (!is_known)
                continue;
            csg_gradients found = gradients_in_cube(c.field, at, half, &is_known);
            if (!is_known || !found.has_level || found.exceeds)
                continue;
            tried[how] += try_level(c.scene, &random, at, half, &found);
            sheets[how] += csg_cone_find_axis(&found.level, &cone);
            cubes[how]++;
        }
        mesh_case_end(&c);
    }
    for (int i = 0; i < HOLLOWS; i++)
        assert_true(tried[i] > 4000);
    assert_true(3 * sheets[BY_ITSELF] > 2 * cubes[BY_ITSELF]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(slopes_at_zero_hold),
        cmocka_unit_test(one_side_of_a_wall_is_a_sheet),
        cmocka_unit_test(sides_of_a_wall_do_not_mix),
        cmocka_unit_test(slopes_of_hollow_solids_hold),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
