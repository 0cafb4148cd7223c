/* SPDX-License-Identifier: MIT
 * The printed tree: exact text of each kind of node, numbers that read back, depth without
 * recursion, memory. (That the text parses back to the same tree is tested with the parser.)
 */
#include "scene/operators/blend_kinds.h"
#include "scene_fixture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "collected_text.h"
#include "random_scene.h"
#include "scene/formula/formula.h"
#include "scene/operators/soft.h"
#include "scene/primitives/kinds.h"
#include "scene/tree/print.h"
#include "scene/warp_kinds.h"

static void check_text(csg_node_id root, const char *expected)
{
    csgm_scene *scene = test_seal(&builder, root);
    text t = {0};
    assert_int_equal(csg_scene_print(scene, collect, &t), CSGM_OK);
    assert_string_equal(t.data, expected);
    free(t.data);
    csg_scene_destroy(scene);
    assert_int_equal(csg_build_begin(&builder, &context), CSGM_OK);
}

static csg_node_id primitive(csg_primitive_kind kind, double a, double b, double c, double d)
{
    return csg_build_primitive(&builder, kind, (double[]){a, b, c, d}, NOWHERE);
}

static void test_primitives(void **state)
{
    check_text(csg_build_empty(&builder, NOWHERE), "union() {}\n");
    check_text(primitive(CSG_NODE_SPHERE, 0.1, 0, 0, 0), "sphere(r = 0.1);\n");
    check_text(primitive(CSG_NODE_BOX, 1, 2, 3, 0), "cube(size = [2, 4, 6], center = true);\n");
    check_text(primitive(CSG_NODE_BOX, 1, 2, 3, 0.25),
               "cube(size = [2, 4, 6], center = true, round = 0.25);\n");
    check_text(primitive(CSG_NODE_FRUSTUM, 1, 0, 2, 0),
               "cylinder(h = 4, r1 = 1, r2 = 0, center = true);\n");
    check_text(primitive(CSG_NODE_FRUSTUM, 1, 1, 2, 0.5),
               "cylinder(h = 4, r1 = 1, r2 = 1, center = true, round = 0.5, core = true);\n");
    check_text(primitive(CSG_NODE_CAPSULE, 3, 1, 0.5, 0),
               "capsule(p1 = [0, 0, 0], p2 = [0, 0, 3], r1 = 1, r2 = 0.5);\n");
    check_text(primitive(CSG_NODE_TORUS, 2, 0.5, 180, 0), "torus(r = 2, tube = 0.5);\n");
    check_text(primitive(CSG_NODE_TORUS, 2, 0.5, 45, 0),
               "torus(r = 2, tube = 0.5, angle = 90, center = true);\n");
    check_text(primitive(CSG_NODE_ELLIPSOID, 1, 2, 3, 0), "ellipsoid(r = [1, 2, 3]);\n");
    check_text(primitive(CSG_NODE_PLANE, 0, 0, -1, 0.5), "plane(normal = [0, 0, -1], d = 0.5);\n");
    check_text(primitive(CSG_NODE_CIRCLE, 0.5, 0, 0, 0), "circle(r = 0.5);\n");
    check_text(primitive(CSG_NODE_RECTANGLE, 1, 2, 0, 0),
               "square(size = [2, 4], center = true);\n");
    check_text(primitive(CSG_NODE_RECTANGLE, 1, 2, 0.5, 0),
               "square(size = [2, 4], center = true, round = 0.5);\n");
    check_text(primitive(CSG_NODE_SLAB, 3, 0, 0, 0), "slab(h = 3);\n");
}

static void test_tree(void **state)
{
    csg_affine move = csg_affine_translate(csg_vec3_make(1, 2, 1.0 / 3));
    csg_node_id a =
        csg_build_transform(&builder, &move, primitive(CSG_NODE_SPHERE, 1, 0, 0, 0), NOWHERE);
    a = csg_build_color(&builder, (csg_color){1, 0.5f, 0.1f, 1}, a, NOWHERE);
    csg_node_id b[3] = {a, primitive(CSG_NODE_SPHERE, 2, 0, 0, 0),
                        primitive(CSG_NODE_SPHERE, 3, 0, 0, 0)};
    csg_node_id joined = csg_build_operator(
        &builder, CSG_NODE_UNION, (csg_blend){CSG_BLEND_ROUND, 0.5, false}, b, 3, NOWHERE);
    csg_node_id c[2] = {joined, primitive(CSG_NODE_SPHERE, 4, 0, 0, 0)};
    joined = csg_build_operator(&builder, CSG_NODE_DIFFERENCE,
                                (csg_blend){CSG_BLEND_PARABOLA, 0.4, false}, c, 2, NOWHERE);
    csg_node_id d[2] = {joined, primitive(CSG_NODE_SPHERE, 5, 0, 0, 0)};
    check_text(csg_build_operator(&builder, CSG_NODE_INTERSECTION,
                                  (csg_blend){CSG_BLEND_SHARP, 0, false}, d, 2, NOWHERE),
               "intersection() {\n"
               "  difference(blend = parabola(n = 0.4)) {\n"
               "    union(blend = round(r = 0.5)) {\n"
               "      color([1, 0.5, 0.1, 1])\n"
               "        multmatrix([[1, 0, 0, 1], [0, 1, 0, 2], [0, 0, 1, 0.3333333333333333], "
               "[0, 0, 0, 1]])\n"
               "          sphere(r = 1);\n"
               "      sphere(r = 2);\n"
               "      sphere(r = 3);\n"
               "    }\n"
               "    sphere(r = 4);\n"
               "  }\n"
               "  sphere(r = 5);\n"
               "}\n");
}

static void test_plates_and_warps(void **state)
{
    csg_node_id circle = primitive(CSG_NODE_CIRCLE, 1, 0, 0, 0);
    check_text(csg_build_extrude(&builder, circle, 1, 4, NOWHERE),
               "extrude(half = 1.5, middle = 2.5)\n"
               "  circle(r = 1);\n");
    const csg_warp twist = {CSG_WARP_TWIST, {3, -1, 1}};
    csg_node_id solid =
        csg_build_warp(&builder, &twist, primitive(CSG_NODE_BOX, 3, 4, 1, 0), NOWHERE);
    check_text(csg_build_offset(&builder, 0.5, solid, NOWHERE),
               "offset3d(r = 0.5)\n"
               "  intersection(mixed = true) {\n"
               "    warp(\"twist\", [3, -1, 1])\n"
               "      cube(size = [6, 8, 2], center = true);\n"
               "    circle(r = 6.25);\n"
               "  }\n");
    const csg_warp taper = {CSG_WARP_TAPER, {3, -1, 1, 0.5, 2}};
    check_text(csg_build_warp(&builder, &taper, primitive(CSG_NODE_BOX, 3, 4, 1, 0), NOWHERE),
               "intersection(mixed = true) {\n"
               "  warp(\"taper\", [3, -1, 1, 0.5, 2])\n"
               "    cube(size = [6, 8, 2], center = true);\n"
               "  circle(r = 12.5);\n"
               "}\n");
    csg_node_id grown =
        csg_build_offset(&builder, 2, primitive(CSG_NODE_SPHERE, 1, 0, 0, 0), NOWHERE);
    check_text(csg_build_offset(&builder, -2, grown, NOWHERE), "sphere(r = 1);\n");
    const csg_formula_step steps[] = {
        {CSG_FORMULA_X, 0, 0, 0}, {CSG_FORMULA_Y, 0, 0, 0}, {CSG_FORMULA_MAX, 0, 1, 0}};
    csg_node_id pair[2] = {primitive(CSG_NODE_SPHERE, 1, 0, 0, 0),
                           primitive(CSG_NODE_SPHERE, 2, 0, 0, 0)};
    check_text(csg_build_combine(&builder, steps, 3, 2, pair, 2, NOWHERE),
               "combine(function (a, b) max(a, b), lipschitz = 2) {\n"
               "  sphere(r = 1);\n"
               "  sphere(r = 2);\n"
               "}\n");
}

/* Largest and least of operands that are named once are sharp operators, and nothing else is. */
static void test_sharp_formulas(void **state)
{
    const csg_formula_step all[] = {{CSG_FORMULA_X, 0, 0, 0},   {CSG_FORMULA_Y, 0, 0, 0},
                                    {CSG_FORMULA_Z, 0, 0, 0},   {CSG_FORMULA_NEG, 2, 0, 0},
                                    {CSG_FORMULA_MIN, 3, 0, 0}, {CSG_FORMULA_MAX, 1, 4, 0}};
    const csg_formula_step twice[] = {{CSG_FORMULA_X, 0, 0, 0},
                                      {CSG_FORMULA_Y, 0, 0, 0},
                                      {CSG_FORMULA_MAX, 0, 1, 0},
                                      {CSG_FORMULA_MIN, 2, 0, 0}};
    csg_node_id three[3], pair[2], soft[2];
    for (int k = 0; k < 2; k++) {
        pair[k] = primitive(CSG_NODE_SPHERE, k + 1, 0, 0, 0);
        soft[k] = csg_build_soft(&builder, (csg_soft){CSG_FALLOFF_SEXTIC, 2},
                                 primitive(CSG_NODE_SPHERE, k + 1, 0, 0, 0), NOWHERE);
    }
    csg_node_id node = csg_build_combine(&builder, twice, 4, 0, pair, 2, NOWHERE);
    assert_int_equal(builder.scene->nodes[node].kind, CSG_NODE_COMBINE);
    node = csg_build_combine(&builder, twice, 3, 0, soft, 2, NOWHERE);
    assert_int_equal(builder.scene->nodes[node].kind, CSG_NODE_COMBINE);
    for (int k = 0; k < 3; k++)
        three[k] = primitive(CSG_NODE_SPHERE, k + 1, 0, 0, 0);
    check_text(csg_build_combine(&builder, all, 6, 0, three, 3, NOWHERE),
               "union() {\n  sphere(r = 2);\n  difference() {\n    sphere(r = 1);\n"
               "    sphere(r = 3);\n  }\n}\n");
}

static void test_numbers_read_back(void **state)
{
    csg_random random = {3};
    for (int i = 0; i < 500; i++) {
        double r = pow(10, csg_random_uniform(&random, -14, 14)), back;
        csgm_scene *scene = test_seal(&builder, primitive(CSG_NODE_SPHERE, r, 0, 0, 0));
        text t = {0};
        assert_int_equal(csg_scene_print(scene, collect, &t), CSGM_OK);
        assert_int_equal(sscanf(t.data, "sphere(r = %lf);", &back), 1);
        assert_true(back == r);
        free(t.data);
        csg_scene_destroy(scene);
        assert_int_equal(csg_build_begin(&builder, &context), CSGM_OK);
    }
}

static size_t occurrences(const text *in, const char *of)
{
    size_t count = 0, length = strlen(of);
    for (size_t i = 0; i + length <= in->length; i++)
        count += memcmp(in->data + i, of, length) == 0;
    return count;
}

static void test_random_scenes(void **state)
{
    for (uint64_t seed = 0; seed < 40; seed++) {
        csg_random random = {seed};
        csgm_scene *scene =
            test_seal(&builder, test_random_scene(&builder, &random, 1 + (unsigned)seed));
        text t = {0};
        assert_int_equal(csg_scene_print(scene, collect, &t), CSGM_OK);
        size_t primitives = 0, operators = 0, transforms = scene->transform_count;
        for (size_t i = 0; i < scene->node_count; i++) {
            primitives += csg_node_is_primitive(scene->nodes[i].kind);
            operators += csg_node_is_operator(scene->nodes[i].kind);
            if (scene->nodes[i].flags & CSG_FLAG_ENDED) { /* the number of its union says it */
                const csg_node_id *ends = csg_scene_children(scene, &scene->nodes[i]);
                primitives -= scene->nodes[i].child_count - 1;
                operators--;
                for (uint32_t k = 1; k < scene->nodes[i].child_count; k++)
                    transforms -= scene->nodes[ends[k]].kind == CSG_NODE_TRANSFORM;
            }
        }
        assert_int_equal(occurrences(&t, ";"), primitives);
        assert_int_equal(occurrences(&t, "{"), operators);
        assert_int_equal(occurrences(&t, "}"), operators);
        assert_int_equal(occurrences(&t, "multmatrix"), transforms);
        free(t.data);
        csg_scene_destroy(scene);
        assert_int_equal(csg_build_begin(&builder, &context), CSGM_OK);
    }
}

static csgm_scene *deep_scene(int depth)
{
    csg_node_id node = primitive(CSG_NODE_SPHERE, 1, 0, 0, 0);
    for (int i = 0; i < depth; i++) {
        csg_node_id pair[2] = {node, primitive(CSG_NODE_SPHERE, 1, 0, 0, 0)};
        node = csg_build_operator(&builder, i % 2 ? CSG_NODE_UNION : CSG_NODE_INTERSECTION,
                                  (csg_blend){CSG_BLEND_SHARP, 0, false}, pair, 2, NOWHERE);
    }
    return test_seal(&builder, node);
}

static void test_deep_tree(void **state)
{
    enum { DEPTH = 50000 };
    csgm_scene *scene = deep_scene(DEPTH);
    text t = {0};
    assert_int_equal(csg_scene_print(scene, collect, &t), CSGM_OK);
    assert_int_equal(occurrences(&t, "sphere"), DEPTH + 1);
    assert_true(t.length < (size_t)DEPTH * 3 * 110); /* the indentation is capped */
    free(t.data);
    t = (text){0};
    context.memory.limit_bytes = atomic_load(&context.memory.used_bytes) + 1000;
    assert_int_equal(csg_scene_print(scene, collect, &t), CSGM_ERR_MEMORY);
    free(t.data);
    csg_scene_destroy(scene);
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, begin, end)
    const struct CMUnitTest tests[] = {
        TEST(test_primitives),        TEST(test_tree),
        TEST(test_plates_and_warps),  TEST(test_sharp_formulas),
        TEST(test_numbers_read_back), TEST(test_random_scenes),
        TEST(test_deep_tree),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
