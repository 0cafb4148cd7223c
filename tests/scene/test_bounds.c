/* SPDX-License-Identifier: MIT
 * Boxes contain what they must and are as tight as promised: known solids, random trees node by
 * node, and the two-level scheme, whose clamped values must have the plain field's sign everywhere
 * and its value inside the band.
 */
#include "scene/operators/rule.h"
#include "scene/operators/soft.h"
#include "scene_fixture.h"

#include <stdlib.h>
#include <string.h>

#include "random_blend.h"
#include "random_scene.h"
#include "scene/boxes/exterior.h"
#include "scene/boxes/level_boxes.h"
#include "scene/formula/formula.h"
#include "scene/operators/combine.h"
#include "scene/primitives/kinds.h"
#include "scene/warp_kinds.h"

static const csg_blend sharp = {CSG_BLEND_SHARP, 0, false};

static csg_node_id primitive(csg_primitive_kind kind, double a, double b, double c, double d)
{
    return csg_build_primitive(&builder, kind, (double[]){a, b, c, d}, NOWHERE);
}

static csg_node_id sphere(double x, double y, double z, double r)
{
    csg_affine move = csg_affine_translate(csg_vec3_make(x, y, z));
    return csg_build_transform(&builder, &move, primitive(CSG_NODE_SPHERE, r, 0, 0, 0), NOWHERE);
}

static csg_node_id turned(double angle_deg, csg_vec3 axis, csg_node_id node)
{
    csg_affine turn = csg_affine_rotate(angle_deg, csg_vec3_normalize(axis));
    return csg_build_transform(&builder, &turn, node, NOWHERE);
}

static csg_node_id build_operator(csg_node_kind kind, csg_blend blend, csg_node_id a, csg_node_id b)
{
    return csg_build_operator(&builder, kind, blend, (csg_node_id[]){a, b}, 2, NOWHERE);
}

static void check_near_box(csg_box box, csg_box expected, double tolerance)
{
    test_near_vec3(box.min, expected.min, tolerance);
    test_near_vec3(box.max, expected.max, tolerance);
}

static void check_bounds(csg_node_id root, csg_box expected)
{
    csgm_scene *scene = test_seal(&builder, root);
    check_near_box(csg_bounds_of_solid(scene), expected, 1e-14);
    csg_scene_destroy(scene);
    assert_int_equal(csg_build_begin(&builder, &context), CSGM_OK);
}

static csg_box cube(double half)
{
    return (csg_box){{-half, -half, -half}, {half, half, half}};
}

/* ---- known solids ------------------------------------------------------------------------ */

static void test_primitives(void **state)
{
    csg_vec3 up = {0, 0, 1}, oblique = {1, 2, 3};
    check_bounds(primitive(CSG_NODE_SPHERE, 2, 0, 0, 0), cube(2));
    check_bounds(turned(33, oblique, primitive(CSG_NODE_SPHERE, 2, 0, 0, 0)), cube(2));
    check_bounds(primitive(CSG_NODE_BOX, 1, 2, 3, 0.5), (csg_box){{-1, -2, -3}, {1, 2, 3}});
    double diagonal = sqrt(2) * 0.5 + 0.5; /* of a rounded square */
    check_bounds(turned(45, up, primitive(CSG_NODE_BOX, 1, 1, 1, 0.5)),
                 (csg_box){{-diagonal, -diagonal, -1}, {diagonal, diagonal, 1}});
    check_bounds(primitive(CSG_NODE_FRUSTUM, 2, 1, 3, 0.25),
                 (csg_box){{-2.25, -2.25, -3.25}, {2.25, 2.25, 3.25}});
    check_bounds(turned(90, csg_vec3_make(0, 1, 0), primitive(CSG_NODE_FRUSTUM, 2, 1, 3, 0)),
                 (csg_box){{-3, -2, -2}, {3, 2, 2}});
    check_bounds(primitive(CSG_NODE_CAPSULE, 3, 2, 0.5, 0), (csg_box){{-2, -2, -2}, {2, 2, 3.5}});
    check_bounds(primitive(CSG_NODE_TORUS, 2, 0.5, 180, 0),
                 (csg_box){{-2.5, -2.5, -0.5}, {2.5, 2.5, 0.5}});
    check_bounds(primitive(CSG_NODE_TORUS, 2, 0.5, 30, 0),
                 (csg_box){{sqrt(3) - 0.5, -1.5, -0.5}, {2.5, 1.5, 0.5}});
    check_bounds(turned(90, up, primitive(CSG_NODE_ELLIPSOID, 1, 2, 3, 0)),
                 (csg_box){{-2, -1, -3}, {2, 1, 3}});
}

static void test_half_spaces(void **state)
{
    csg_box all = csg_box_all(), low = all;
    low.max.z = 0.25;
    csgm_scene *scene = test_seal(&builder, primitive(CSG_NODE_PLANE, 0, 0, 1, 0.25));
    assert_true(csg_box_contains_box(low, csg_bounds_of_solid(scene)) &&
                csg_box_contains_box(csg_bounds_of_solid(scene), low));
    csg_scene_destroy(scene);
    assert_int_equal(csg_build_begin(&builder, &context), CSGM_OK);
    scene = test_seal(&builder, primitive(CSG_NODE_PLANE, 0.6, 0, 0.8, 0.25));
    assert_true(csg_box_contains_box(csg_bounds_of_solid(scene), all));
    csg_scene_destroy(scene);
    assert_int_equal(csg_build_begin(&builder, &context), CSGM_OK);
    csg_box cut = cube(1);
    cut.max.z = 0.25;
    check_bounds(build_operator(CSG_NODE_INTERSECTION, sharp, sphere(0, 0, 0, 1),
                                primitive(CSG_NODE_PLANE, 0, 0, 1, 0.25)),
                 cut);
    check_bounds(build_operator(CSG_NODE_INTERSECTION, (csg_blend){CSG_BLEND_COSINE, 0.5, false},
                                primitive(CSG_NODE_PLANE, 0, 0, 1, 0.25), sphere(0, 0, 0, 1)),
                 cut);
    check_bounds(build_operator(
                     CSG_NODE_DIFFERENCE, sharp, sphere(0, 0, 0, 1),
                     turned(90, csg_vec3_make(1, 0, 0), primitive(CSG_NODE_PLANE, 0, 1, 0, -0.25))),
                 (csg_box){{-1, -1, -0.25}, {1, 1, 1}});
    check_bounds(build_operator(CSG_NODE_INTERSECTION, sharp, sphere(0, 0, 0, 1),
                                primitive(CSG_NODE_PLANE, 0.6, 0, 0.8, 0.25)),
                 cube(1));
}

static csgm_scene *octahedron(csg_node_kind kind, unsigned faces)
{
    csg_node_id planes[9];
    double third = sqrt(1.0 / 3);
    size_t count = 0;
    if (kind == CSG_NODE_DIFFERENCE)
        planes[count++] = sphere(0, 0, 0, 9);
    for (unsigned i = 0; i < faces; i++) {
        double out = kind == CSG_NODE_DIFFERENCE ? -third : third;
        planes[count++] = primitive(CSG_NODE_PLANE, i & 1 ? out : -out, i & 2 ? out : -out,
                                    i & 4 ? out : -out, kind == CSG_NODE_DIFFERENCE ? -1 : 1);
    }
    csg_node_id node = csg_build_operator(&builder, kind, sharp, planes, count, NOWHERE);
    csg_affine move = csg_affine_translate(csg_vec3_make(10, 0, 0));
    return test_seal(&builder, csg_build_transform(&builder, &move, node, NOWHERE));
}

/* Oblique planes bound a solid together; all but one of an octahedron's do too, half of them not.
 */
static void test_polytopes(void **state)
{
    double reach = sqrt(3);
    csg_box expected = {{10 - reach, -reach, -reach}, {10 + reach, reach, reach}};
    for (csg_node_kind kind = CSG_NODE_INTERSECTION; kind <= CSG_NODE_DIFFERENCE; kind++) {
        csgm_scene *scene = octahedron(kind, 8);
        check_near_box(csg_bounds_of_solid(scene), expected, 1e-7);
        csg_scene_destroy(scene);
        assert_int_equal(csg_build_begin(&builder, &context), CSGM_OK);
    }
    csgm_scene *scene = octahedron(CSG_NODE_INTERSECTION, 7);
    assert_true(csg_box_is_finite(csg_bounds_of_solid(scene)));
    assert_true(csg_box_contains_box(csg_bounds_of_solid(scene), expected));
    csg_scene_destroy(scene);
    assert_int_equal(csg_build_begin(&builder, &context), CSGM_OK);
    scene = octahedron(CSG_NODE_INTERSECTION, 4);
    assert_true(csg_box_contains_box(csg_bounds_of_solid(scene), csg_box_all()));
    csg_scene_destroy(scene);
    assert_int_equal(csg_build_begin(&builder, &context), CSGM_OK);
    csg_node_id above = primitive(CSG_NODE_PLANE, 0, -1, 0, -1);
    csg_node_id below = primitive(CSG_NODE_PLANE, -1e-5, 1, 0, 0); /* only where x > 1e5 */
    scene = test_seal(&builder, build_operator(CSG_NODE_INTERSECTION, sharp, above, below));
    csg_vec3 far_out = {1e6, 5, 0};
    assert_true(test_sample(scene, far_out).value > 0);
    assert_true(csg_box_contains_box(csg_bounds_of_solid(scene), (csg_box){far_out, far_out}));
    csg_scene_destroy(scene);
}

static void test_blended_unions_grow_only_near(void **state)
{
    const csg_blend round = {CSG_BLEND_ROUND, 0.5, false};
    check_bounds(build_operator(CSG_NODE_UNION, round, sphere(-3, 0, 0, 1), sphere(3, 0, 0, 1)),
                 (csg_box){{-4, -1, -1}, {4, 1, 1}});
    double excess = 0.5 * (1 - sqrt(0.5));
    csg_node_id same =
        build_operator(CSG_NODE_UNION, round, sphere(0, 0, 0, 1), sphere(0, 0, 0, 1));
    check_bounds(same, cube(1 + excess));
    check_bounds(build_operator(CSG_NODE_UNION, (csg_blend){CSG_BLEND_HYPERBOLA, 0.04, false},
                                sphere(0, 0, 0, 1), sphere(0, 0, 0, 1)),
                 cube(1.1));
}

/* However long the chain of blends, the solid grows by less than one support. */
static void test_long_chains_stay_tight(void **state)
{
    enum { LENGTH = 2000 };
    static csg_node_id balls[LENGTH];
    csg_random random = {11};
    for (csg_blend_kind kind = CSG_BLEND_ROUND; kind < CSG_BLEND_COUNT; kind++) {
        csg_blend blend = test_random_blend(&random, kind);
        double grown = fmin(csg_blend_support(blend), csg_blend_excess(blend, LENGTH));
        for (int i = 0; i < LENGTH; i++)
            balls[i] = sphere(i, 0, 0, 0.6);
        csg_node_id all =
            csg_build_operator(&builder, CSG_NODE_UNION, blend, balls, LENGTH, NOWHERE);
        csgm_scene *scene = test_seal(&builder, all);
        if (csg_bounds_of_solid(scene).max.z > 0.6 + grown + 1e-9)
            fail_msg("%s: %g beyond %g", csg_blend_name(kind), csg_bounds_of_solid(scene).max.z,
                     0.6 + grown);
        csg_scene_destroy(scene);
        assert_int_equal(csg_build_begin(&builder, &context), CSGM_OK);
    }
}

static void test_ancestors_cut(void **state)
{
    csg_node_id both =
        build_operator(CSG_NODE_UNION, sharp, sphere(0, 5, 0, 1), sphere(1, 0, 0, 1));
    check_bounds(
        build_operator(CSG_NODE_INTERSECTION, sharp, both, primitive(CSG_NODE_BOX, 1, 9, 3, 0)),
        (csg_box){{-1, -1, -1}, {1, 6, 1}});
    both = build_operator(CSG_NODE_UNION, sharp, sphere(0, 5, 0, 1), sphere(1, 0, 0, 1));
    check_bounds(
        build_operator(CSG_NODE_INTERSECTION, sharp, both, primitive(CSG_NODE_BOX, 2, 3, 9, 0)),
        (csg_box){{0, -1, -1}, {2, 1, 1}}); /* the far ball is gone, its hull too */
    csg_node_id apart =
        build_operator(CSG_NODE_INTERSECTION, sharp, sphere(0, 0, 0, 1), sphere(3, 0, 0, 1));
    csgm_scene *scene = test_seal(&builder, apart);
    assert_true(csg_box_is_empty(csg_bounds_of_solid(scene)));
    csg_scene_destroy(scene);
}

/* A turned group is as tight as its turned parts. */
static void test_turned_groups(void **state)
{
    csg_node_id both =
        build_operator(CSG_NODE_UNION, sharp, sphere(-2, 0, 0, 1), sphere(2, 0, 0, 1));
    double reach = sqrt(2) + 1;
    check_bounds(turned(45, csg_vec3_make(0, 0, 1), both),
                 (csg_box){{-reach, -reach, -1}, {reach, reach, 1}});
}

/* ---- values of nodes, with or without clamping to S-bounds ------------------------------- */

typedef struct valuer {
    const csgm_scene *scene;
    const csg_node_bounds *clamp; /* NULL = plain */
    const csg_box *contain;       /* per node: must contain where the value is >= 0; or NULL */
    const csg_sample *samples;    /* of the reference, for what looks at gradients */
} valuer;

/* Bounds change gradients, so the operands of such operators are not clamped either. */
static bool looks_at_gradients(const csgm_scene *scene, const csg_node *node)
{
    const csg_rule *rule = csg_scene_rule(scene, node);
    return csg_node_is_fillet(node) ||
           (rule && rule->kind == CSG_BLEND_SCALE_SET && rule->parameters[3] > 0);
}

static double operate_fields(const csg_node *node, const csgm_scene *scene, double *values)
{
    double partials[64], slope;
    for (uint32_t k = 0; k < node->child_count; k++) {
        values[k] = csg_operand_field(csg_scene_operand(scene, node, k), values[k], &slope);
        if (node->kind == CSG_NODE_DIFFERENCE && k > 0)
            values[k] = 1 - values[k];
    }
    double value = csg_rule_apply(csg_scene_rule(scene, node), node->kind == CSG_NODE_UNION, values,
                                  node->child_count, 0, partials);
    return (value - 0.5) / csg_scene_parameters(scene, node)[CSG_OPERATOR_LAMBDA];
}

static double operate(const csg_node *node, const csgm_scene *scene, double *values)
{
    double partials[64];
    const csg_rule *rule = csg_scene_rule(scene, node);
    if (rule && csg_blend_takes_fields(rule->kind))
        return operate_fields(node, scene, values);
    double first = node->kind == CSG_NODE_UNION ? 1 : -1;
    double rest = node->kind == CSG_NODE_INTERSECTION ? -1 : 1;
    for (uint32_t k = 0; k < node->child_count; k++)
        values[k] *= k ? rest : first;
    if (rule)
        return first * csg_rule_apply(rule, true, values, node->child_count, 0, partials);
    return first *
           csg_reference_union(csg_scene_blend(scene, node), values, node->child_count, partials);
}

static double formula_value(const valuer *v, const csg_node *node, const double *values)
{
    csg_formula_dual work[128];
    double at[CSG_COMBINE_MOST] = {0};
    const csg_formula *formula = &v->scene->formulas[node->payload];
    memcpy(at, values, node->child_count * sizeof *at);
    return csg_formula_evaluate_group(v->scene->steps, formula, at, 0, work).value /
           formula->lipschitz;
}

static double value_of(const valuer *v, csg_node_id id, csg_vec3 p)
{
    const csgm_scene *scene = v->scene;
    const csg_node *node = &scene->nodes[id];
    double values[64], scale = 1, value;
    csg_vec3 inner = p;
    assert_true(node->child_count <= 64);
    if (node->kind == CSG_NODE_TRANSFORM) {
        inner = csg_affine_point(&scene->inverses[node->payload], p);
        scale = scene->scales[node->payload];
    } else if (node->kind == CSG_NODE_WARP) {
        inner = csg_warp_at(&scene->warps[node->payload], p).at;
        scale = csg_warp_scale(&scene->warps[node->payload]);
    }
    bool looks = looks_at_gradients(scene, node);
    valuer below = {scene, looks ? NULL : v->clamp, v->contain, v->samples};
    for (uint32_t k = 0; k < node->child_count; k++)
        values[k] = scale * value_of(&below, csg_scene_children(scene, node)[k], inner);
    if (looks)
        value = v->samples[id].value;
    else if (csg_node_is_operator(node->kind))
        value = operate(node, scene, values);
    else if (node->kind == CSG_NODE_OFFSET)
        value = values[0] + csg_scene_parameters(scene, node)[0];
    else if (node->kind == CSG_NODE_SOFT)
        value = (csg_soft_at(csg_scene_soft(scene, node), values[0], &scale) - 0.5) /
                csg_scene_parameters(scene, node)[CSG_SOFT_LAMBDA];
    else if (node->child_count)
        value = values[0];
    else
        value = csg_reference_primitive(node->kind, csg_scene_parameters(scene, node), p).value;
    if (v->clamp && isfinite(v->clamp[id].below))
        value = fmin(value, csg_box_field(v->clamp[id].clamp_box, p) - v->clamp[id].below);
    if (node->kind == CSG_NODE_COMBINE)
        value = formula_value(v, node, values);
    bool bend = node->kind == CSG_NODE_WARP && scene->warps[node->payload].kind == CSG_WARP_BEND;
    if (v->contain && value >= 0 && !bend) /* behind its ends the builder cuts */
        assert_true(csg_box_contains_box(v->contain[id], (csg_box){p, p}));
    return value;
}

/* The root's value at p; room: for the reference's samples. */
static double value_at(valuer v, csg_reference_room *room, csg_vec3 p)
{
    csg_reference_below(room, v.scene, 0, v.scene->root, p);
    v.samples = room->samples;
    return value_of(&v, v.scene->root, p);
}

static csgm_scene *random_scene(uint64_t seed, csg_random *random)
{
    *random = (csg_random){seed};
    test_random_shapes = seed % 2;
    test_random_rules = seed % 3 == 1;
    test_random_curves = seed % 5 == 2;
    test_random_fillets = seed % 7 == 3;
    csg_build_abandon(&builder);
    assert_int_equal(csg_build_begin(&builder, &context), CSGM_OK);
    return test_seal(&builder, test_random_scene(&builder, random, 1 + (unsigned)seed % 60));
}

static void test_random_trees_are_contained(void **state)
{
    uint64_t inside = 0;
    for (uint64_t n = 0, seed = test_first_seed + 1000; n < ROUNDS(150) * test_times; n++, seed++) {
        csg_random random;
        csgm_scene *scene = random_scene(seed, &random);
        csg_box box = csg_bounds_of_solid(scene);
        /* blends without an end may join what is soft everywhere */
        assert_true(test_random_rules || csg_box_is_finite(box) || csg_box_is_empty(box));
        valuer plain = {scene, NULL, scene->bounds, NULL};
        csg_reference_room room;
        assert_true(csg_reference_room_begin(&room, scene));
        for (int i = 0; i < 400; i++) {
            csg_vec3 p = test_point(&random, i % 4 ? 1.2 : 4);
            double value = value_at(plain, &room, p);
            test_near(value, test_sample(scene, p).value, 1e-13);
            inside += value >= 0;
        }
        csg_reference_room_end(&room, scene);
        csg_scene_destroy(scene);
    }
    assert_true(inside > ROUNDS(5000));
}

/* Found from what leaves are far away, soft ones and rules too: nothing is solid beyond it. */
static void test_nothing_is_beyond_the_exterior_box(void **state)
{
    int found = 0, beyond = 0, rescued = 0;
    for (uint64_t n = 0, seed = test_first_seed + 3001; n < ROUNDS(133) * test_times;
         n++, seed += 3) { /* with rules */
        csg_random random;
        csgm_scene *scene = random_scene(seed, &random);
        csg_box box;
        assert_int_equal(csg_exterior_box(scene, &box), CSGM_OK);
        bool is_found = csg_box_is_finite(box);
        found += is_found;
        for (int i = 0; i < 300 && is_found; i++) {
            csg_vec3 p = test_point(&random, i % 3 == 0 ? 100 : i % 3 == 1 ? 6 : 2);
            bool is_outside = !csg_box_contains_box(box, (csg_box){p, p});
            beyond += is_outside;
            assert_true(!is_outside || test_sample(scene, p).value < 0);
        }
        csg_box all = csg_box_all();
        assert_int_equal(csg_level_box_of_root(scene, &all), CSGM_OK);
        rescued += is_found && !csg_box_is_finite(all) && !csg_box_is_empty(all);
        csg_scene_destroy(scene);
    }
    assert_true(found > ROUNDS(60) && beyond > ROUNDS(10000) && rescued > ROUNDS(15));
}

/* Walking outwards from solid points must not leave the box before the solid: boxes that are
 * wrong by little show here. */
static void test_surface_is_contained(void **state)
{
    for (uint64_t n = 0, seed = test_first_seed + 2000; n < ROUNDS(100) * test_times; n++, seed++) {
        csg_random random;
        csgm_scene *scene = random_scene(seed, &random);
        csg_box box = csg_box_grow(csg_bounds_of_solid(scene), 1e-12);
        for (int i = 0; i < 40; i++) {
            csg_vec3 p = test_point(&random, 1.5), along = test_direction(&random);
            if (test_sample(scene, p).value < 0)
                continue;
            for (int step = 0; step < 60; step++) {
                csg_sample s = test_sample(scene, p);
                assert_true(s.value < 0 || csg_box_contains_box(box, (csg_box){p, p}));
                p = csg_vec3_add(p, csg_vec3_scale(along, fabs(s.value) + 1e-9));
            }
        }
        csg_scene_destroy(scene);
    }
}

static void check_band(const csgm_scene *scene, csg_random *random, double delta)
{
    csg_node_bounds *bounds = calloc(scene->node_count, sizeof *bounds);
    assert_non_null(bounds);
    assert_int_equal(csg_bounds_compute(scene, delta, bounds), CSGM_OK);
    valuer plain = {scene, NULL, NULL, NULL}, clamped = {scene, bounds, NULL, NULL};
    csg_reference_room room;
    assert_true(csg_reference_room_begin(&room, scene));
    for (int i = 0; i < 300; i++) {
        csg_vec3 p = test_point(random, i % 3 ? 1.2 : 3);
        double value = value_at(plain, &room, p), cut = value_at(clamped, &room, p);
        if (value > delta)
            assert_true(cut >= delta - 1e-12);
        else if (value >= -delta)
            test_near(cut, value, 1e-12);
        else
            assert_true(cut < -delta + 1e-12);
    }
    csg_reference_room_end(&room, scene);
    free(bounds);
}

static void test_band_is_exact(void **state)
{
    for (uint64_t n = 0, seed = test_first_seed + 3000; n < ROUNDS(100) * test_times; n++, seed++) {
        csg_random random;
        csgm_scene *scene = random_scene(seed, &random);
        check_band(scene, &random, 0);
        check_band(scene, &random, 0.02);
        check_band(scene, &random, 0.3);
        csg_scene_destroy(scene);
    }
}

/* The worked example of the field's literature: (A & B) U C minus a capsule, band 0.01. */
static void test_worked_example(void **state)
{
    csg_node_id cut = build_operator(CSG_NODE_INTERSECTION, sharp, sphere(-0.3, 0, 0, 0.7),
                                     sphere(0.4, 0, 0, 0.8));
    csg_affine move = csg_affine_translate(csg_vec3_make(0.2, 0.9, 0));
    csg_node_id box =
        csg_build_transform(&builder, &move, primitive(CSG_NODE_BOX, 0.5, 0.3, 0.4, 0), NOWHERE);
    csg_node_id both =
        build_operator(CSG_NODE_UNION, (csg_blend){CSG_BLEND_PARABOLA, 1.2, false}, cut, box);
    csg_node_id bar = csg_build_capsule(&builder, csg_vec3_make(0, -1, 0),
                                        csg_vec3_make(0, 1.5, 0.2), 0.2, 0.2, NOWHERE);
    csgm_scene *scene =
        test_seal(&builder, build_operator(CSG_NODE_DIFFERENCE,
                                           (csg_blend){CSG_BLEND_COSINE, 0.4, false}, both, bar));
    csg_node_bounds b[16];
    assert_true(scene->node_count <= 16);
    assert_int_equal(csg_bounds_compute(scene, 0.01, b), CSGM_OK);
    const csg_node *root = &scene->nodes[scene->root];
    csg_node_id u = csg_scene_children(scene, root)[0], d = csg_scene_children(scene, root)[1];
    csg_node_id i = csg_scene_children(scene, &scene->nodes[u])[0];
    csg_node_id a = csg_scene_children(scene, &scene->nodes[i])[0];
    csg_box whole = {{-0.485, -0.71, -0.71}, {0.71, 1.21, 0.71}};
    check_near_box(b[scene->root].level_box, whole, 1e-9);
    check_near_box(b[scene->root].clamp_box, whole, 1e-9);
    check_near_box(b[u].clamp_box, whole, 1e-9);
    test_near(b[u].above, 0.21944, 5e-6);
    test_near(b[a].below, 0.31, 1e-12);
    check_near_box(b[i].level_box, (csg_box){{-0.71, -1.01, -1.01}, {0.71, 1.01, 1.01}}, 1e-9);
    check_near_box(b[a].level_box, (csg_box){{-1.31, -1.01, -1.01}, {0.71, 1.01, 1.01}}, 1e-9);
    check_near_box(b[a].clamp_box, (csg_box){{-1.01444, -1.01, -1.01}, {0.71, 1.01, 1.01}}, 5e-6);
    check_near_box(b[d].clamp_box,
                   (csg_box){{-0.41944, -0.93944, -0.41944}, {0.41944, 1.43944, 0.61944}}, 5e-6);
    test_near(test_sample(scene, csg_vec3_make(0.3, 0, 0)).value, 0.0515010606481, 1e-12);
    test_near(test_sample(scene, csg_vec3_make(2, 2, 2)).value, -2.21133443875, 1e-11);
    csg_scene_destroy(scene);
}

int main(int argc, char **argv)
{
    test_take_search(argc, argv);
#define TEST(name) cmocka_unit_test_setup_teardown(name, begin, end)
    const struct CMUnitTest tests[] = {
        TEST(test_primitives),
        TEST(test_half_spaces),
        TEST(test_polytopes),
        TEST(test_blended_unions_grow_only_near),
        TEST(test_long_chains_stay_tight),
        TEST(test_ancestors_cut),
        TEST(test_turned_groups),
        TEST(test_random_trees_are_contained),
        TEST(test_nothing_is_beyond_the_exterior_box),
        TEST(test_surface_is_contained),
        TEST(test_band_is_exact),
        TEST(test_worked_example),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
