/* SPDX-License-Identifier: MIT
 * What the builder makes of nodes: the shape of the sealed tree, refused parameters, limits, very
 * deep trees, and every allocation failing once.
 */
#include "scene/operators/blend_kinds.h"
#include "scene_support.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "random_scene.h"
#include "scene/primitives/kinds.h"

typedef struct fixture {
    csgm_context context;
    csg_scene_builder builder;
} fixture;

static fixture f;

static int begin(void **state)
{
    test_context_init(&f.context);
    return csg_build_begin(&f.builder, &f.context) != CSGM_OK;
}

static int end(void **state)
{
    csg_build_abandon(&f.builder);
    test_context_end(&f.context);
    return 0;
}

static csg_node_id sphere(double r)
{
    return csg_build_primitive(&f.builder, CSG_NODE_SPHERE, &r, NOWHERE);
}

static csg_node_id empty(void)
{
    return csg_build_empty(&f.builder, NOWHERE);
}

static csg_node_id operate(csg_node_kind kind, csg_blend blend, csg_node_id a, csg_node_id b,
                           csg_node_id c)
{
    const csg_node_id children[3] = {a, b, c};
    size_t count = c == CSG_NODE_NONE ? 2 : 3;
    return csg_build_operator(&f.builder, kind, blend, children, count, NOWHERE);
}

static const csg_blend sharp = {CSG_BLEND_SHARP, 0, false}, rounded = {CSG_BLEND_ROUND, 0.5, false},
                       cosine = {CSG_BLEND_COSINE, 0.5, false};

/* "union(sphere, sphere)" of a small scene; primitives with their first parameter. */
static void describe(const csgm_scene *scene, csg_node_id id, char *text, size_t size)
{
    const csg_node *node = &scene->nodes[id];
    size_t length = strlen(text);
    snprintf(text + length, size - length, "%s", csg_node_kind_name(node->kind));
    length = strlen(text);
    if (csg_node_is_primitive(node->kind))
        snprintf(text + length, size - length, " %g", csg_scene_parameters(scene, node)[0]);
    if (csg_node_is_operator(node->kind) && node->blend)
        snprintf(text + length, size - length, " %s", csg_blend_name(node->blend));
    for (uint32_t k = 0; k < node->child_count; k++) {
        strcat(text, k ? ", " : "(");
        describe(scene, csg_scene_children(scene, node)[k], text, size);
    }
    strcat(text, node->child_count ? ")" : "");
}

static void check_order(const csgm_scene *scene)
{
    uint8_t *parents = calloc(scene->node_count, 1);
    assert_non_null(parents);
    assert_true(scene->root == scene->node_count - 1);
    for (size_t i = 0; i < scene->node_count; i++) {
        for (uint32_t k = 0; k < scene->nodes[i].child_count; k++) {
            csg_node_id child = csg_scene_children(scene, &scene->nodes[i])[k];
            assert_true(child < i);
            assert_int_equal(parents[child]++, 0);
        }
    }
    for (size_t i = 0; i + 1 < scene->node_count; i++)
        assert_int_equal(parents[i], 1); /* nothing unreachable is kept */
    free(parents);
}

static void check_tree(csg_node_id root, const char *expected)
{
    char text[512] = "";
    csgm_scene *scene = test_seal(&f.builder, root);
    check_order(scene);
    describe(scene, scene->root, text, sizeof text);
    assert_string_equal(text, expected);
    csg_scene_destroy(scene);
}

/* ---- simplification ---------------------------------------------------------------------- */

static void test_sharp_unions_flatten(void **state)
{
    csg_node_id inner = operate(CSG_NODE_UNION, sharp, sphere(1), sphere(2), CSG_NODE_NONE);
    csg_node_id more = operate(CSG_NODE_UNION, sharp, sphere(3), inner, sphere(4));
    check_tree(operate(CSG_NODE_UNION, sharp, more, sphere(5), CSG_NODE_NONE),
               "union(sphere 3, sphere 1, sphere 2, sphere 4, sphere 5)");
}

static void test_sharp_intersections_flatten(void **state)
{
    csg_node_id inner = operate(CSG_NODE_INTERSECTION, sharp, sphere(1), sphere(2), CSG_NODE_NONE);
    csg_node_id outer = operate(CSG_NODE_INTERSECTION, sharp, sphere(3), inner, CSG_NODE_NONE);
    check_tree(operate(CSG_NODE_UNION, sharp, sphere(4), outer, CSG_NODE_NONE),
               "union(sphere 4, intersection(sphere 3, sphere 1, sphere 2))");
}

static void test_round_unions_stay(void **state)
{
    csg_node_id inner = operate(CSG_NODE_UNION, rounded, sphere(1), sphere(2), sphere(3));
    csg_node_id sharper = operate(CSG_NODE_UNION, sharp, inner, sphere(4), CSG_NODE_NONE);
    check_tree(operate(CSG_NODE_UNION, rounded, sharper, sphere(5), CSG_NODE_NONE),
               "union round(union(union round(sphere 1, sphere 2, sphere 3), sphere 4), sphere 5)");
}

static void test_folds_become_chains(void **state)
{
    csg_node_id a = operate(CSG_NODE_UNION, cosine, sphere(1), sphere(2), sphere(3));
    csg_node_id b = operate(CSG_NODE_DIFFERENCE, cosine, a, sphere(4), sphere(5));
    check_tree(b, "difference cosine(difference cosine(union cosine(union cosine(sphere 1, sphere "
                  "2), sphere 3), sphere 4), sphere 5)");
}

static void test_differences_stay_whole(void **state)
{
    csg_node_id a = operate(CSG_NODE_DIFFERENCE, sharp, sphere(1), sphere(2), sphere(3));
    check_tree(operate(CSG_NODE_DIFFERENCE, rounded, a, sphere(4), sphere(5)),
               "difference round(difference(sphere 1, sphere 2, sphere 3), sphere 4, sphere 5)");
}

static void test_single_operands_vanish(void **state)
{
    csg_node_id a = sphere(1);
    for (csg_node_kind kind = CSG_NODE_UNION; kind <= CSG_NODE_DIFFERENCE; kind++)
        assert_int_equal(csg_build_operator(&f.builder, kind, cosine, &a, 1, NOWHERE), a);
    check_tree(a, "sphere 1");
}

static void test_empty_operands(void **state)
{
    csg_node_id a = operate(CSG_NODE_UNION, rounded, empty(), sphere(1), empty());
    csg_node_id b = operate(CSG_NODE_DIFFERENCE, sharp, a, empty(), empty());
    csg_node_id gone = operate(CSG_NODE_INTERSECTION, sharp, sphere(2), empty(), CSG_NODE_NONE);
    csg_node_id too = operate(CSG_NODE_DIFFERENCE, cosine, empty(), sphere(3), CSG_NODE_NONE);
    csg_affine move = csg_affine_translate(csg_vec3_make(1, 2, 3));
    too = csg_build_transform(&f.builder, &move, too, NOWHERE);
    too = csg_build_color(&f.builder, (csg_color){1, 1, 1, 1}, too, NOWHERE);
    check_tree(operate(CSG_NODE_UNION, cosine, gone, b, too), "sphere 1");
}

static void test_empty_scene(void **state)
{
    csg_node_id none = csg_build_operator(&f.builder, CSG_NODE_UNION, sharp, NULL, 0, NOWHERE);
    csgm_scene *scene =
        test_seal(&f.builder, operate(CSG_NODE_UNION, sharp, none, empty(), CSG_NODE_NONE));
    assert_int_equal(scene->node_count, 1);
    assert_int_equal(scene->nodes[0].kind, CSG_NODE_EMPTY);
    assert_true(csg_box_is_empty(csg_bounds_of_solid(scene)));
    assert_true(test_sample(scene, csg_vec3_make(0, 0, 0)).value == -INFINITY);
    csg_scene_destroy(scene);
}

static void test_transforms_fold(void **state)
{
    csg_affine a = csg_affine_translate(csg_vec3_make(1, 2, 3));
    csg_affine b = csg_affine_scale(csg_vec3_make(2, 2, 2));
    csg_node_id node = csg_build_transform(&f.builder, &b, sphere(1), NOWHERE);
    node = csg_build_color(&f.builder, (csg_color){1, 0, 0, 1}, node, NOWHERE);
    node = csg_build_transform(&f.builder, &a, node, NOWHERE);
    node = csg_build_color(&f.builder, (csg_color){0, 1, 0, 1}, node, NOWHERE);
    csgm_scene *scene = test_seal(&f.builder, node);
    assert_int_equal(scene->node_count, 3);
    assert_int_equal(scene->nodes[2].kind, CSG_NODE_COLOR);
    assert_true(scene->looks[0].color.g == 1); /* the outermost */
    test_near(scene->scales[0], 2, 1e-15);
    csg_vec3 p = {1, 2, 4};
    test_near(test_sample(scene, p).value, 1, 1e-15);
    test_near_vec3(csg_affine_point(&scene->inverses[0], p), csg_vec3_make(0, 0, 0.5), 1e-15);
    csg_scene_destroy(scene);
}

static void test_turn_and_back_vanishes(void **state)
{
    csg_node_id node = sphere(1);
    for (int i = 0; i < 2; i++) {
        csg_affine turn = csg_affine_rotate(i ? -33.7 : 33.7, csg_vec3_make(0, 0, 1));
        node = csg_build_transform(&f.builder, &turn, node, NOWHERE);
    }
    check_tree(node, "sphere 1");
}

static void test_capsules(void **state)
{
    csg_vec3 a = {1, 2, 3}, b = {1, 2, 5}, c = {4, 2, 3};
    csg_node_id upright = csg_build_capsule(&f.builder, a, b, 0.5, 0.25, NOWHERE);
    csg_node_id swallowed = csg_build_capsule(&f.builder, a, c, 0.5, 3.5, NOWHERE);
    csg_node_id lying = csg_build_capsule(&f.builder, a, c, 0.5, 0.25, NOWHERE);
    csgm_scene *scene =
        test_seal(&f.builder, operate(CSG_NODE_UNION, sharp, upright, swallowed, lying));
    assert_int_equal(scene->nodes[0].kind, CSG_NODE_CAPSULE);
    test_near(scene->transforms[0].m[0][0], 1, 0); /* not turned */
    assert_int_equal(scene->nodes[2].kind, CSG_NODE_SPHERE);
    test_near_vec3(csg_vec3_make(scene->transforms[1].t[0], scene->transforms[1].t[1],
                                 scene->transforms[1].t[2]),
                   c, 0);
    csg_vec3 end = csg_affine_point(&scene->transforms[2], csg_vec3_make(0, 0, 3));
    test_near_vec3(end, c, 1e-14);
    csg_scene_destroy(scene);
}

static void test_dependencies_are_copied(void **state)
{
    char name[] = "a.txt";
    const char *names[2] = {name, "b.txt"};
    csgm_scene *scene;
    assert_int_equal(csg_build_finish(&f.builder, sphere(1), names, 2, &scene), CSGM_OK);
    name[0] = 'x';
    assert_int_equal(scene->dependency_count, 2);
    assert_string_equal(scene->dependencies[0], "a.txt");
    assert_string_equal(scene->dependencies[1], "b.txt");
    csg_scene_destroy(scene);
}

/* ---- refusals ------------------------------------------------------------------------------ */

static void check_refused(csgm_status status)
{
    assert_int_equal(f.builder.status, status);
    size_t length = strlen(f.builder.problem);
    assert_true(length > 10 && f.builder.problem[length - 1] != '.');
    csgm_scene *scene = NULL;
    assert_int_equal(csg_build_finish(&f.builder, 0, NULL, 0, &scene), status);
    assert_null(scene);
    csg_build_abandon(&f.builder);
    assert_int_equal(csg_build_begin(&f.builder, &f.context), CSGM_OK);
}

static void test_bad_parameters(void **state)
{
    const double bad[] = {NAN, INFINITY, -INFINITY, -1, 1e300, -1e-300};
    const struct {
        csg_primitive_kind kind;
        double v[4];
    } good[] = {
        {CSG_NODE_SPHERE, {1}},           {CSG_NODE_BOX, {1, 2, 3, 0.5}},
        {CSG_NODE_FRUSTUM, {1, 2, 3, 0}}, {CSG_NODE_CAPSULE, {3, 1, 2}},
        {CSG_NODE_TORUS, {2, 1, 90}},     {CSG_NODE_ELLIPSOID, {1, 2, 3}},
    };
    for (size_t g = 0; g < sizeof good / sizeof *good; g++) {
        uint32_t count = csg_primitive_parameter_count(good[g].kind);
        assert_true(csg_build_primitive(&f.builder, good[g].kind, good[g].v, NOWHERE) !=
                    CSG_NODE_NONE);
        for (uint32_t i = 0; i < count; i++) {
            for (size_t b = 0; b < sizeof bad / sizeof *bad; b++) {
                double v[4];
                memcpy(v, good[g].v, sizeof v);
                v[i] = bad[b];
                assert_true(csg_build_primitive(&f.builder, good[g].kind, v, NOWHERE) ==
                            CSG_NODE_NONE);
                check_refused(CSGM_ERR_SCENE);
            }
        }
    }
}

static void test_bad_combinations(void **state)
{
    const struct {
        csg_primitive_kind kind;
        double v[4];
        const char *problem;
    } rows[] = {
        {CSG_NODE_SPHERE, {0}, "the radius must be positive"},
        {CSG_NODE_SPHERE, {1e-200}, "the radius is smaller than 1e-15"},
        {CSG_NODE_BOX, {1, 0, 1, 0}, "the size must be positive"},
        {CSG_NODE_BOX, {1, 2, 3, 1.01}, "the rounding radius is more than half the smallest side"},
        {CSG_NODE_FRUSTUM, {0, 0, 1, 0}, "one of the two radii must be positive"},
        {CSG_NODE_FRUSTUM, {1, 0, 0, 0}, "the height must be positive"},
        {CSG_NODE_CAPSULE, {1, 1, 2}, "one end of the capsule swallows the other"},
        {CSG_NODE_TORUS, {1, 1, 0}, "the angle must be above 0 and at most 360 degrees"},
        {CSG_NODE_TORUS, {1, 1, 180.5}, "the angle must be above 0 and at most 360 degrees"},
        {CSG_NODE_PLANE, {0, 0, 0, 1}, "the normal must not be zero"},
        {CSG_NODE_PLANE, {0, NAN, 1, 1}, "the normal is not a finite number"},
        {CSG_NODE_PLANE, {0, 0, 1, INFINITY}, "the distance is not a finite number"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        assert_true(csg_build_primitive(&f.builder, rows[i].kind, rows[i].v, NOWHERE) ==
                    CSG_NODE_NONE);
        assert_string_equal(f.builder.problem, rows[i].problem);
        assert_true(sphere(1) == CSG_NODE_NONE); /* the first failure stays */
        check_refused(CSGM_ERR_SCENE);
    }
}

static void test_bad_matrices(void **state)
{
    csg_affine rows[6];
    for (int i = 0; i < 6; i++)
        rows[i] = csg_affine_identity();
    rows[0].m[1][2] = NAN;
    rows[1].t[0] = INFINITY;
    rows[2].m[2][2] = 0;
    rows[3] = csg_affine_scale(csg_vec3_make(1e-200, 1e-200, 1e-200));
    rows[4].m[0][1] = rows[4].m[1][0] = 1; /* flattens x and y onto one line */
    rows[5].m[0][0] = 1e200;
    for (int i = 0; i < 6; i++) {
        assert_true(csg_build_transform(&f.builder, &rows[i], sphere(1), NOWHERE) == CSG_NODE_NONE);
        check_refused(CSGM_ERR_SCENE);
    }
    csg_affine shrink = csg_affine_scale(csg_vec3_make(1e-9, 1e-9, 1e-9));
    csg_node_id node = sphere(1);
    for (int i = 0; i < 2; i++) /* each is fine, both together are not */
        node = csg_build_transform(&f.builder, &shrink, node, NOWHERE);
    check_refused(CSGM_ERR_SCENE);
}

static void test_bad_blends_and_colors(void **state)
{
    const double widths[] = {NAN, -1, INFINITY, 1e300};
    for (size_t i = 0; i < sizeof widths / sizeof *widths; i++) {
        csg_blend blend = {CSG_BLEND_ROUND, widths[i], false};
        operate(CSG_NODE_UNION, blend, sphere(1), sphere(2), CSG_NODE_NONE);
        check_refused(CSGM_ERR_SCENE);
    }
    csg_build_color(&f.builder, (csg_color){0, 0, 1.5f, 1}, sphere(1), NOWHERE);
    check_refused(CSGM_ERR_SCENE);
    csg_build_color(&f.builder, (csg_color){0, 0, NAN, 1}, sphere(1), NOWHERE);
    check_refused(CSGM_ERR_SCENE);
    csg_blend none = {CSG_BLEND_ROUND, 0, false};
    check_tree(operate(CSG_NODE_UNION, none, sphere(1), sphere(2), CSG_NODE_NONE),
               "union(sphere 1, sphere 2)");
}

static void test_misuse(void **state)
{
    operate(CSG_NODE_UNION, sharp, sphere(1), 77, CSG_NODE_NONE);
    check_refused(CSGM_ERR_ARGUMENT);
    csg_node_id twice = sphere(1);
    csg_node_id root = operate(CSG_NODE_UNION, sharp, twice, twice, CSG_NODE_NONE);
    csgm_scene *scene = NULL;
    assert_int_equal(csg_build_finish(&f.builder, root, NULL, 0, &scene), CSGM_ERR_INTERNAL);
    assert_null(scene);
}

static void test_node_limit(void **state)
{
    f.context.limits.scene_nodes = 3;
    csg_node_id a = sphere(1), b = sphere(2);
    assert_true(operate(CSG_NODE_UNION, sharp, a, b, CSG_NODE_NONE) != CSG_NODE_NONE);
    assert_true(sphere(3) == CSG_NODE_NONE);
    assert_string_equal(f.builder.problem, "the scene has more than 3 solids");
    check_refused(CSGM_ERR_LIMIT);
}

/* ---- size ---------------------------------------------------------------------------------- */

static void test_deep_trees(void **state)
{
    enum { DEPTH = 200000 };
    csg_affine move = csg_affine_rotate(1, csg_vec3_make(0, 0, 1));
    csg_node_id node = sphere(1);
    for (int i = 0; i < DEPTH; i++) {
        node = operate(i % 2 ? CSG_NODE_UNION : CSG_NODE_DIFFERENCE, rounded, node, sphere(0.1),
                       CSG_NODE_NONE);
        if (i % 16 == 0)
            node = csg_build_transform(&f.builder, &move, node, NOWHERE);
    }
    csgm_scene *scene = test_seal(&f.builder, node);
    check_order(scene);
    assert_true(scene->node_count > 2 * DEPTH);
    assert_true(isfinite(test_sample(scene, csg_vec3_make(3, 0, 0)).value));
    csgm_status status = CSGM_OK;
    assert_true(csg_reference_active_primitives(scene, csg_vec3_make(3, 0, 0), &status) > 0);
    csg_scene_destroy(scene);
}

static void test_long_sharp_chain_is_flat(void **state)
{
    enum { LENGTH = 100000 };
    csg_node_id node = sphere(1);
    for (int i = 0; i < LENGTH; i++)
        node = operate(CSG_NODE_UNION, sharp, node, sphere(2), CSG_NODE_NONE);
    csgm_scene *scene = test_seal(&f.builder, node);
    assert_int_equal(scene->node_count, LENGTH + 2);
    assert_int_equal(scene->nodes[scene->root].child_count, LENGTH + 1);
    csg_scene_destroy(scene);
}

/* ---- memory -------------------------------------------------------------------------------- */

typedef struct failing {
    uint32_t left; /* allocations until one fails */
    bool failed;
} countdown;

static void *failing_alloc(void *user, size_t size)
{
    countdown *self = user;
    if (self->left-- == 0) {
        self->failed = true;
        return NULL;
    }
    return malloc(size);
}

static void failing_release(void *user, void *memory, size_t size)
{
    free(memory);
}

static csgm_status build_random(csgm_context *context)
{
    csg_scene_builder builder;
    csg_random random = {5};
    csgm_scene *scene = NULL;
    const char *names[1] = {"a.txt"};
    csgm_status status = csg_build_begin(&builder, context);
    if (status != CSGM_OK)
        return status;
    csg_node_id root = test_random_scene(&builder, &random, 30);
    status = csg_build_finish(&builder, root, names, 1, &scene);
    assert_true((status == CSGM_OK) == (scene != NULL));
    assert_string_equal(builder.problem, "");
    csg_build_abandon(&builder);
    csg_scene_destroy(scene);
    return status;
}

static void test_every_allocation_fails(void **state)
{
    uint32_t failures = 0;
    for (bool done = false; !done; failures++) {
        countdown memory = {failures, false};
        csgm_allocator allocator = {failing_alloc, failing_release, &memory};
        csgm_context context = {0};
        csg_memory_init(&context.memory, &allocator, 0);
        csgm_status status = build_random(&context);
        assert_int_equal(status, memory.failed ? CSGM_ERR_MEMORY : CSGM_OK);
        test_context_end(&context);
        done = !memory.failed;
    }
    assert_true(failures > 50);
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, begin, end)
    const struct CMUnitTest tests[] = {
        TEST(test_sharp_unions_flatten),
        TEST(test_sharp_intersections_flatten),
        TEST(test_round_unions_stay),
        TEST(test_folds_become_chains),
        TEST(test_differences_stay_whole),
        TEST(test_single_operands_vanish),
        TEST(test_empty_operands),
        TEST(test_empty_scene),
        TEST(test_transforms_fold),
        TEST(test_turn_and_back_vanishes),
        TEST(test_capsules),
        TEST(test_dependencies_are_copied),
        TEST(test_bad_parameters),
        TEST(test_bad_combinations),
        TEST(test_bad_matrices),
        TEST(test_bad_blends_and_colors),
        TEST(test_misuse),
        TEST(test_node_limit),
        TEST(test_deep_trees),
        TEST(test_long_sharp_chain_is_flat),
        TEST(test_every_allocation_fails),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
