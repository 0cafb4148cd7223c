/* SPDX-License-Identifier: MIT
 * What is printed of a scene parses back to the same tree, to the last bit: scenes of every module,
 * random trees of every kind of node, and solids mended from random triangles.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "lang/bench_fixture.h"
#include "scene/collected_text.h"
#include "scene/formula/formula.h"
#include "scene/random_scene.h"
#include "scene/tree/build.h"
#include "scene/tree/print.h"
#include "shape/polyhedra/polyhedron.h"

static text print(const csgm_scene *scene)
{
    text t = {0};
    assert_int_equal(csg_scene_print(scene, collect, &t), CSGM_OK);
    return t;
}

/* ---- equal trees ---------------------------------------------------------------------------- */

static void check_bits(const void *a, const void *c, size_t bytes, const char *what)
{
    if (bytes && memcmp(a, c, bytes) != 0)
        fail_msg("%s differ", what);
}

/* Of doubles and what is made of them: no padding; -0 and 0 are told apart. */
static void check_arrays(const csgm_scene *a, const csgm_scene *c)
{
#define CHECK(array, count)                                                                        \
    assert_int_equal(a->count, c->count);                                                          \
    check_bits(a->array, c->array, a->count * sizeof *a->array, #array)
    for (size_t i = 0; i < a->parameter_count && i < c->parameter_count; i++)
        if (memcmp(&a->parameters[i], &c->parameters[i], 8) != 0)
            print_error("parameter %zu of %zu: %.17g, %.17g\n", i, a->parameter_count,
                        a->parameters[i], c->parameters[i]);
    CHECK(parameters, parameter_count);
    CHECK(transforms, transform_count);
    CHECK(children, child_count);
#undef CHECK
}

static void check_formulas(const csgm_scene *a, const csgm_scene *c)
{
    assert_int_equal(a->formula_count, c->formula_count);
    assert_int_equal(a->step_count, c->step_count);
    for (size_t i = 0; i < a->formula_count; i++) {
        const csg_formula *f = &a->formulas[i], *g = &c->formulas[i];
        assert_int_equal(f->count, g->count);
        assert_true(f->lipschitz == g->lipschitz);
        check_bits(&f->bounds, &g->bounds, sizeof f->bounds, "bounds of formulas");
    }
    for (size_t i = 0; i < a->step_count; i++) {
        const csg_formula_step *s = &a->steps[i], *t = &c->steps[i];
        assert_int_equal(s->op, t->op);
        assert_true(s->constant == t->constant);
        assert_true(csg_formula_op_arity(s->op) < 1 || s->a == t->a);
        assert_true(csg_formula_op_arity(s->op) < 2 || s->b == t->b);
    }
}

static void check_same(const csgm_scene *a, const csgm_scene *c)
{
    assert_int_equal(a->node_count, c->node_count);
    for (size_t i = 0; i < a->node_count; i++) {
        const csg_node *n = &a->nodes[i], *m = &c->nodes[i];
        assert_int_equal(n->kind, m->kind);
        assert_int_equal(n->blend, m->blend);
        assert_int_equal(n->flags, m->flags);
        assert_int_equal(n->warps, m->warps);
        assert_int_equal(n->child_count, m->child_count);
    }
    check_arrays(a, c);
    check_formulas(a, c);
    assert_int_equal(a->warp_count, c->warp_count);
    for (size_t i = 0; i < a->warp_count; i++) {
        assert_int_equal(a->warps[i].kind, c->warps[i].kind);
        check_bits(a->warps[i].parameters, c->warps[i].parameters, sizeof c->warps[i].parameters,
                   "warps");
    }
    assert_int_equal(a->shape_count, c->shape_count);
    for (size_t i = 0; i < a->shape_count; i++)
        assert_true(csg_shape_hash(a->shapes[i]) == csg_shape_hash(c->shapes[i]));
    assert_int_equal(a->look_count, c->look_count);
    for (size_t i = 0; i < a->look_count; i++) {
        const csg_look *l = &a->looks[i], *k = &c->looks[i];
        assert_true(l->has_color == k->has_color && l->has_material == k->has_material);
        assert_true(!l->part == !k->part);
        assert_true(l->color.r == k->color.r && l->color.a == k->color.a);
        assert_true(!l->has_material ||
                    (l->metallic == k->metallic && l->roughness == k->roughness));
    }
}

/* Findings, but for those about what blends and offsets of random solids do. */
static int count_findings(void)
{
    int count = 0;
    for (int i = 0; i < b.code_count; i++)
        count +=
            b.codes[i] != -304 && b.codes[i] != -340 && b.codes[i] != -341 && b.codes[i] != -348;
    return count;
}

/* `scene` is taken over. */
static void check_parses_back(csgm_scene *scene)
{
    text first = print(scene);
    csgm_status status = bench_compile(&b, first.data);
    if (status != CSGM_OK || count_findings())
        print_error("%.4000s\n%s", first.data, b.text);
    assert_int_equal(status, CSGM_OK);
    assert_int_equal(count_findings(), 0);
    text second = print(b.scene);
    size_t at = 0;
    while (first.data[at] && first.data[at] == second.data[at])
        at++;
    if (first.data[at] != second.data[at])
        print_error("%.600s\n!=\n%.600s", first.data + (at < 300 ? 0 : at - 300),
                    second.data + (at < 300 ? 0 : at - 300));
    assert_true(strcmp(first.data, second.data) == 0);
    check_same(scene, b.scene);
    free(first.data);
    free(second.data);
    csg_scene_destroy(scene);
}

/* ---- tests ---------------------------------------------------------------------------------- */

static void scenes_of_every_module_parse_back(void **state)
{
    static const char *const scenes[] = {
        "linear_extrude(5) circle(3);",
        "linear_extrude(5, center = true) square([1, 1/3], round = 0.1);",
        "linear_extrude(5, twist = 70) square(3);",
        "linear_extrude(5, scale = 0.5) polygon([[0, 0], [4, 0], [2, 3]]);",
        "linear_extrude(1) polygon([[0, 0], [9, 0], [9, 9], [0, 9], [1, 1], [2, 1], [2, 2]], "
        "[[0, 1, 2, 3], [4, 5, 6]]);",
        "linear_extrude(2) offset(0.3) offset(-0.1) square(4);",
        "rotate_extrude() translate([3, 0]) circle(1);",
        "rotate_extrude(angle = 77) translate([3, 0]) square(1);",
        "linear_extrude(1) projection(cut = true) rotate([10, 20, 30]) cube(3, center = true);",
        "slab(3);",
        "difference(mixed = true) { sphere(4); circle(1); rotate(30) square(1/7); }",
        "union(mixed = true, blend = cosine(1)) { circle(1); sphere(4); }",
        "offset3d(1/3) offset3d(1/3) cube(2);",
        "offset3d(1) offset3d(-1) cube(2);",
        "shell(0.1) rotate([1, 2, 3]) cylinder(3, 2, 1);",
        "twist(17) translate([0, 1/3, 0]) cube([2, 3, 5]);",
        "twist(17, low = 0, high = 1) twist(-3) cube([2, 3, 5]);",
        "bend(7) cube([9, 1/3, 1], center = true);",
        "bend(7) color(\"red\") union(blend = 0.1) { cube([9, 1, 1], center = true); sphere(1); }",
        "polyhedron([[0, 0, 0], [1.1, 0, 0], [0, 1.3, 0], [0, 0, 1.7]], "
        "[[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]);",
        /* turned over, a quad, and a point that is not used */
        "polyhedron([[9, 9, 9], [0, 0, 1/3], [1/7, 0, 0], [1, 1, 0], [0, 1, 0], [0.5, 0.4, 3]], "
        "[[4, 3, 2, 1], [1, 2, 5], [2, 3, 5], [3, 4, 5], [4, 1, 5]]);",
        "hull() { sphere(1); translate([3, 0.1, 0.2]) rotate([5, 6, 7]) cube(1); }",
        "combine(function (a, b) max(a, b) + 0.1 * exp(-abs(a - b))) { sphere(1); cube(1); }",
        "combine(function (a) a + 0.1 * sin(100 * a)) sphere(1);",
        "combine(function (f) (f[0] + f[1] + max(f) - abs(f[4])) / 3) { sphere(1); cube(1); "
        "sphere(2); "
        "cube(2); cylinder(h = 2, r = 1); }",
        "combine(function (a, b, c, d) a / 2 - b / 4 + c / 8 + sin(d)) { sphere(1); cube(1); "
        "sphere(2); "
        "cube(2); }",
        "combine(function (a, b, c) a - max(b, c) / 2, lipschitz = 1.5) { sphere(2); circle(1); "
        "cube(1); }",
        "combine(function (a, b) min(a, b), bounds = [[-1, -1, -1], [1, 1, 1/3]]) { sphere(1); "
        "plane(); }",
        "part(\"a \\\"lid\\\"\") material(0.3, 0.1) color(\"teal\", 0.3) sphere(1); "
        "material(roughness = 1) cube(1); part(\"b\") sphere(3);",
        "union(blend = exterior(1/3, 0.1, step = rising(3))) { sphere(2); cube(2); }",
        "difference(blend = interior(eps = 1/3, step = sigmoid(1/0.07))) { sphere(2); cube(2); }",
        "union(blend = ricci(3)) { soft() sphere(1/3); soft(0.3, \"cubic\") cube(1); }",
        "intersection(blend = scale_set(1/3, 0.4, -0.1, debulge = 0.01)) { sphere(1); cube(1); }",
        "union(blend = soft_set()) { union() { soft() sphere(1); soft() sphere(1/3); } cube(1); }",
        "union(blend = arc([0.2, -0.97, 0.1], [1, 1, 0.2], through = [[1, 0.3, 0]])) { sphere(1); "
        "translate([0.5, 0.5, 0]) cube(1, center = true); }",
        "difference(blend = arc(angles = [100/7, 80], profile = [[100/3, 0.97], [50, 1.05]])) { "
        "sphere(1); cube(1); }",
        "union(blend = profile(function (x) max(0, 1/3 - x) ^ 2 / 4 * 3)) { sphere(1); cube(1); "
        "sphere(2); }",
        "soft(0.1) superellipsoid([1, 2, 1/3], 3.3); superellipsoid(1, e1 = 0.3, e2 = 1.1);",
        "gyroid(3); minkowski() { cube(1); cylinder(1, 1, 1); }",
    };
    (void)state;
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        csgm_status status = bench_compile(&b, scenes[i]);
        if (status != CSGM_OK)
            print_error("%s\n%s", scenes[i], b.text);
        assert_int_equal(status, CSGM_OK);
        csgm_scene *scene = b.scene;
        b.scene = NULL;
        check_parses_back(scene);
    }
}

static csgm_scene *sealed(csg_scene_builder *builder, csg_node_id root)
{
    csgm_scene *scene = NULL;
    csgm_status status = csg_build_finish(builder, root, NULL, 0, &scene);
    if (status != CSGM_OK)
        print_error("%s\n", builder->problem);
    assert_int_equal(status, CSGM_OK);
    csg_build_abandon(builder);
    return scene;
}

static void random_scenes_parse_back(void **state)
{
    (void)state;
    test_random_shapes = true;
    for (uint64_t seed = 0; seed < 400; seed++) {
        csg_random random = {seed};
        csg_scene_builder builder;
        test_random_rules = seed % 2;
        assert_int_equal(csg_build_begin(&builder, &b.context), CSGM_OK);
        csg_node_id root = test_random_scene(&builder, &random, 1 + (unsigned)seed % 20);
        csgm_scene *scene = sealed(&builder, root);
        /* a figure that is the whole scene would become a plate */
        if (scene->nodes[scene->root].flags & CSG_FLAG_FLAT ||
            scene->nodes[scene->root].kind == CSG_NODE_EMPTY)
            csg_scene_destroy(scene);
        else
            check_parses_back(scene);
    }
    test_random_shapes = test_random_rules = false;
}

/* A few boxes and tetrahedra with corners that are no short numbers, some faces turned over, left
 * out or given twice. */
static void add_soup(csg_random *random, csg_triangles *out)
{
    static const uint32_t sides[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    unsigned solids = 1 + csg_random_below(random, 4), faults = csg_random_below(random, 3);
    for (unsigned s = 0; s < solids; s++) {
        uint32_t first = (uint32_t)out->point_count;
        for (int i = 0; i < 4; i++)
            assert_true(csg_triangles_add_point(
                out, csg_vec3_make(csg_random_uniform(random, -1, 1) * (s ? 1 : 10),
                                   csg_random_uniform(random, -1, 1) / 3,
                                   csg_random_uniform(random, -1, 1) * 7)));
        for (int i = 0; i < 4; i++) {
            bool turned = faults && csg_random_below(random, 4) == 0;
            if (faults > 1 && csg_random_below(random, 9) == 0)
                continue;
            assert_true(csg_triangles_add(out, first + sides[i][0],
                                          first + sides[i][turned ? 2 : 1],
                                          first + sides[i][turned ? 1 : 2]));
            if (faults > 1 && csg_random_below(random, 9) == 0)
                assert_true(csg_triangles_add(out, first + sides[i][0], first + sides[i][1],
                                              first + sides[i][2]));
        }
    }
}

static void mended_solids_parse_back(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 400; seed++) {
        csg_random random = {seed};
        csg_triangles soup;
        csg_shape *shape = NULL;
        csg_scene_builder builder;
        csg_triangles_init(&soup, &b.context.memory);
        add_soup(&random, &soup);
        csgm_status status = csg_polyhedron_create(&b.context.memory, &soup, NULL, &shape);
        csg_triangles_release(&soup);
        if (status == CSGM_ERR_SCENE)
            continue;
        assert_int_equal(status, CSGM_OK);
        assert_int_equal(csg_build_begin(&builder, &b.context), CSGM_OK);
        csg_node_id root = csg_build_shape(&builder, shape, (csg_span){.source = UINT32_MAX});
        check_parses_back(sealed(&builder, root));
    }
}

static void what_is_no_node_is_refused(void **state)
{
    static const struct {
        const char *scene;
        int code;
    } rows[] = {
        {"slab(0);", 302},
        {"slab([1]);", 301},
        {"extrude(1) sphere(1);", 321},
        {"extrude(-1) circle(1);", 302},
        {"warp(\"fold\") sphere(1);", 301},
        {"warp(\"twist\", [1, 2]) sphere(1);", 301},
        {"warp(\"bend\", [0]) sphere(1);", 308},
        {"linear_extrude(1) polygon([[0, 0], [0, 0], [1, 1]], clean = true);", -325},
        {"combine(function (a) a) { sphere(1); cube(1); }", 301},
        {"combine(function (a) a);", 308},
        {"combine(function (a) a) { sphere(1); cube(1); plane(); slab(); }", 301},
        {"combine(function (a, b) a) { sphere(1); cube(1); plane(); slab(); }", 301},
        {"combine(function (f) f[0] + f[4]) { sphere(1); cube(1); plane(); slab(); }", 301},
        {"combine(3) sphere(1);", 301},
        {"combine(function (a) \"a\") sphere(1);", 301},
        {"combine(function (a) a * a) sphere(1);", 308},
        {"combine(function (a) a > 0 ? a : 0) sphere(1);", 311},
        {"combine(function (a, b) a) { sphere(1); intersection() { union() {} cube(1); } }", 308},
        {"combine(function (a) a, bounds = 3) sphere(1);", 301},
    };
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        bench_compile(&b, rows[i].scene);
        if (!bench_has(&b, rows[i].code))
            print_error("%s\n%s", rows[i].scene, b.text);
        assert_true(bench_has(&b, rows[i].code));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(scenes_of_every_module_parse_back),
        cmocka_unit_test(random_scenes_parse_back),
        cmocka_unit_test(mended_solids_parse_back),
        cmocka_unit_test(what_is_no_node_is_refused),
    };
    return cmocka_run_group_tests(tests, open_bench, close_bench);
}
