/* SPDX-License-Identifier: MIT
 * Lazy evaluation: what is left out changes no bit, the exact scheme has the plain field's sign
 * everywhere and its value in the band, counts are those of the worked example, and the cases in
 * which plainer boxes go wrong do so here too.
 */
#include "scene/operators/rule.h"
#include "scene/operators/soft.h"
#include "scene_fixture.h"

#include <stdlib.h>

#include "random_blend.h"
#include "random_scene.h"
#include "rounds.h"
#include "scene/formula/formula.h"
#include "scene/lazy/lazy_private.h"
#include "scene/primitives/kinds.h"

static const csg_blend sharp = {CSG_BLEND_SHARP, 0, false};

static csg_node_id primitive(csg_primitive_kind kind, double a, double b, double c, double d)
{
    return csg_build_primitive(&builder, kind, (double[]){a, b, c, d}, NOWHERE);
}

static csg_node_id moved(double x, double y, double z, csg_node_id node)
{
    csg_affine move = csg_affine_translate(csg_vec3_make(x, y, z));
    return csg_build_transform(&builder, &move, node, NOWHERE);
}

static csg_node_id sphere(double x, double y, double z, double r)
{
    return moved(x, y, z, primitive(CSG_NODE_SPHERE, r, 0, 0, 0));
}

static csg_node_id capsule(csg_vec3 from, csg_vec3 to, double r)
{
    return csg_build_capsule(&builder, from, to, r, r, NOWHERE);
}

static csg_node_id build_operator(csg_node_kind kind, csg_blend blend, csg_node_id a, csg_node_id b)
{
    return csg_build_operator(&builder, kind, blend, (csg_node_id[]){a, b}, 2, NOWHERE);
}

/* ---- an evaluator with its scratch --------------------------------------------------------- */

typedef struct evaluator {
    csg_lazy *lazy;
    void *scratch;
    csg_lazy_counts counts;
} evaluator;

static evaluator evaluator_with(const csgm_scene *scene, csg_lazy_options options)
{
    evaluator e = {0};
    assert_int_equal(csg_lazy_create(scene, &options, &e.lazy), CSGM_OK);
    e.scratch = malloc(csg_lazy_scratch_bytes(e.lazy));
    assert_non_null(e.scratch);
    return e;
}

/* By the paper's rules alone. */
static evaluator evaluator_of(const csgm_scene *scene, bool lazy, csg_lazy_bounds bounds,
                              double band)
{
    return evaluator_with(scene, (csg_lazy_options){lazy, bounds, band, false});
}

static void evaluator_end(evaluator *e)
{
    csg_lazy_destroy(e->lazy);
    free(e->scratch);
}

static csg_sample sample(evaluator *e, csg_vec3 p)
{
    return csg_lazy_eval(e->lazy, p, e->scratch, &e->counts);
}

static double value_with(const csgm_scene *scene, csg_lazy_bounds bounds, double band, csg_vec3 p)
{
    evaluator e = evaluator_of(scene, true, bounds, band);
    double value = sample(&e, p).value;
    evaluator_end(&e);
    return value;
}

/* ---- the worked example -------------------------------------------------------------------- */

/* ((A & B) U C) \ D of operators.md's vectors, A.17. */
static csgm_scene *worked_example(void)
{
    csg_node_id cut = build_operator(CSG_NODE_INTERSECTION, sharp, sphere(-0.3, 0, 0, 0.7),
                                     sphere(0.4, 0, 0, 0.8));
    csg_node_id box = moved(0.2, 0.9, 0, primitive(CSG_NODE_BOX, 0.5, 0.3, 0.4, 0));
    csg_node_id both =
        build_operator(CSG_NODE_UNION, (csg_blend){CSG_BLEND_PARABOLA, 1.2, false}, cut, box);
    csg_node_id bar = capsule(csg_vec3_make(0, -1, 0), csg_vec3_make(0, 1.5, 0.2), 0.2);
    return test_seal(
        &builder,
        build_operator(CSG_NODE_DIFFERENCE, (csg_blend){CSG_BLEND_COSINE, 0.4, false}, both, bar));
}

typedef struct named_nodes {
    csg_node_id r, u, i, a, b, c, d;
} named_nodes;

static named_nodes name_nodes(const csgm_scene *tree)
{
    named_nodes n = {.r = tree->root};
    const csg_node_id *of_r = csg_scene_children(tree, &tree->nodes[n.r]);
    n.u = of_r[0], n.d = of_r[1];
    const csg_node_id *of_u = csg_scene_children(tree, &tree->nodes[n.u]);
    n.i = of_u[0], n.c = of_u[1];
    const csg_node_id *of_i = csg_scene_children(tree, &tree->nodes[n.i]);
    n.a = of_i[0], n.b = of_i[1];
    return n;
}

static void check_box(const csg_lazy *lazy, csg_node_id node, csg_box expected)
{
    assert_true(lazy->bounds[node].is_known);
    test_near_vec3(lazy->bounds[node].box.min, expected.min, 5e-6);
    test_near_vec3(lazy->bounds[node].box.max, expected.max, 5e-6);
}

static void test_boxes_of_the_worked_example(void **state)
{
    csgm_scene *scene = worked_example();
    evaluator own = evaluator_of(scene, true, CSG_LAZY_OWN_BOXES, 0);
    named_nodes n = name_nodes(&own.lazy->tree);
    csg_box all = {{-0.7, -1, -1}, {1, 1.5, 1}};
    check_box(own.lazy, n.r, all);
    check_box(own.lazy, n.u, all);
    check_box(own.lazy, n.i, (csg_box){{-0.4, -0.7, -0.7}, {0.4, 0.7, 0.7}});
    check_box(own.lazy, n.a, (csg_box){{-1, -0.7, -0.7}, {0.4, 0.7, 0.7}});
    check_box(own.lazy, n.b, (csg_box){{-0.4, -0.8, -0.8}, {1.2, 0.8, 0.8}});
    check_box(own.lazy, n.c, (csg_box){{-0.3, 0.6, -0.4}, {0.7, 1.2, 0.4}});
    check_box(own.lazy, n.d, (csg_box){{-0.2, -1.2, -0.2}, {0.2, 1.7, 0.4}});
    evaluator_end(&own);
    evaluator exact = evaluator_of(scene, true, CSG_LAZY_EXACT, 0.01);
    all = (csg_box){{-0.485, -0.71, -0.71}, {0.71, 1.21, 0.71}};
    check_box(exact.lazy, n.r, all);
    check_box(exact.lazy, n.u, all);
    check_box(exact.lazy, n.i, (csg_box){{-0.71, -1.01, -1.01}, {0.71, 1.01, 1.01}});
    check_box(exact.lazy, n.a, (csg_box){{-1.01444, -1.01, -1.01}, {0.71, 1.01, 1.01}});
    check_box(exact.lazy, n.b, (csg_box){{-0.71, -1.11, -1.11}, {1.23944, 1.11, 1.11}});
    check_box(exact.lazy, n.c, (csg_box){{-0.61, 0.29, -0.71}, {1.01, 1.51, 0.71}});
    check_box(exact.lazy, n.d,
              (csg_box){{-0.41944, -0.93944, -0.41944}, {0.41944, 1.43944, 0.61944}});
    test_near(exact.lazy->bounds[n.i].below, 0.31, 1e-12);
    test_near(exact.lazy->bounds[n.d].below, 0.21944, 5e-6);
    evaluator_end(&exact);
    csg_scene_destroy(scene);
}

typedef struct worked_row {
    csg_vec3 p;
    double value;
    unsigned evaluated;
} worked_row;

static const worked_row worked_rows[] = {
    {{0, 0.45, 0}, -0.0843694276898, 6},
    {{0.05, 0.55, 0.2}, -0.11096751215, 7},
    {{0.5, 0.5, 0}, -0.0795632075437, 6},
    {{-0.35, 0.3, 0.1}, -0.0164523155615, 7},
    {{0.3, 0, 0}, 0.0515010606481, 6},
    {{0.05, 0.62, -0.3}, 0.0543914367337, 7},
    {{2, 2, 2}, -2.21133443875, 6},
    {{0, -0.3, 0.5}, 0.044101876413, 6},
    {{0.7, 0.9, 0}, 0, 3},
    {{0.2, 0.55, 0.35}, -0.0193728864059, 7},
    {{-0.9, -0.9, -0.9}, -1.01934053987, 5},
    {{0.1, -0.1, 1.2}, -0.568857754045, 5},
};

static void test_counts_of_the_worked_example(void **state)
{
    csgm_scene *scene = worked_example();
    evaluator exact = evaluator_of(scene, true, CSG_LAZY_EXACT, 0.01);
    evaluator all = evaluator_of(scene, false, CSG_LAZY_EXACT, 0.01);
    assert_int_equal(csg_lazy_node_count(exact.lazy), 7);
    for (size_t i = 0; i < sizeof worked_rows / sizeof *worked_rows; i++) {
        const worked_row *row = &worked_rows[i];
        test_near(test_sample(scene, row->p).value, row->value, 1e-11);
        test_near(value_with(scene, CSG_LAZY_OWN_BOXES, 0, row->p), row->value, 1e-11);
        uint64_t before = exact.counts.total;
        test_near(sample(&exact, row->p).value, row->value, 1e-11);
        if (exact.counts.total - before != row->evaluated)
            fail_msg("row %zu: %u nodes, expected %u", i, (unsigned)(exact.counts.total - before),
                     row->evaluated);
        sample(&all, row->p);
        assert_int_equal(exact.counts.top_level, i + 1);
        assert_int_equal(all.counts.total, 7 * (i + 1));
    }
    evaluator_end(&exact);
    evaluator_end(&all);
    csg_scene_destroy(scene);
}

/* ---- where plainer boxes go wrong ------------------------------------------------------------ */

/* A ball far below the surface of a box, blended with it where it is cut to the ball's box. */
static void test_shared_boxes_blend_too_much(void **state)
{
    csg_blend soft = {CSG_BLEND_PARABOLA, 1.2, false};
    csgm_scene *scene =
        test_seal(&builder, build_operator(CSG_NODE_INTERSECTION, soft, sphere(0, 0, 0, 0.1),
                                           primitive(CSG_NODE_BOX, 5, 5, 5, 0)));
    csg_vec3 p = {0.09, 0, 0};
    test_near(test_sample(scene, p).value, 0.01, 1e-15);
    test_near(value_with(scene, CSG_LAZY_SHARED_BOXES, 0, p), -0.065, 1e-15);
    test_near(value_with(scene, CSG_LAZY_EXACT, 0.02, p), 0.01, 1e-15);
    csg_scene_destroy(scene);
}

/* Two balls that nearly touch have no common part, but a field that blends with a third. */
static void test_own_boxes_blend_too_little(void **state)
{
    csg_node_id none =
        build_operator(CSG_NODE_INTERSECTION, sharp, sphere(0, 0, 0, 1), sphere(2.02, 0, 0, 1));
    csg_blend soft = {CSG_BLEND_PARABOLA, 1.2, false};
    csgm_scene *scene =
        test_seal(&builder, build_operator(CSG_NODE_UNION, soft, none, sphere(1.01, 0.3, 0, 0.25)));
    csg_vec3 p = {1.01, 0.03, 0};
    double plain = test_sample(scene, p).value;
    test_near(plain, 0.0599, 1e-4);
    test_near(value_with(scene, CSG_LAZY_OWN_BOXES, 0, p), -0.02, 1e-12);
    test_near(value_with(scene, CSG_LAZY_EXACT, 0.1, p), plain, 1e-15);
    assert_true(value_with(scene, CSG_LAZY_EXACT, 0, p) >= 0);
    csg_scene_destroy(scene);
}

/* A bore through a ball's box: sharing shuts its mouth with a skin without thickness. */
static void test_shared_boxes_shut_holes(void **state)
{
    csg_node_id block = primitive(CSG_NODE_BOX, 1, 1, 1, 0);
    csg_node_id bore = primitive(CSG_NODE_FRUSTUM, 0.5, 0.5, 3, 0);
    csgm_scene *scene =
        test_seal(&builder, build_operator(CSG_NODE_DIFFERENCE, sharp, block, bore));
    csg_vec3 mouth = {0, 0, 1};
    test_near(test_sample(scene, mouth).value, -0.5, 0);
    test_near(value_with(scene, CSG_LAZY_SHARED_BOXES, 0, mouth), 0, 0);
    test_near(value_with(scene, CSG_LAZY_OWN_BOXES, 0, mouth), -0.5, 0);
    assert_true(value_with(scene, CSG_LAZY_EXACT, 0.02, mouth) <= -0.02);
    csg_scene_destroy(scene);
}

/* ---- random trees ---------------------------------------------------------------------------- */

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

static bool is_same_number(double a, double b)
{
    return a == b || (isnan(a) && isnan(b));
}

enum { PAPER, DEMAND, CHECKED = 60 };

/* Adds the nodes evaluated per node of a full evaluation, without and with demand. */
static void check_laziness(const csgm_scene *scene, csg_random *random, csg_lazy_bounds bounds,
                           double parts[2])
{
    double band = csg_random_below(random, 3) * 0.01;
    evaluator lazy[2], all = evaluator_of(scene, false, bounds, band);
    for (int way = PAPER; way <= DEMAND; way++)
        lazy[way] = evaluator_with(scene, (csg_lazy_options){true, bounds, band, way == DEMAND});
    for (int i = 0; i < CHECKED; i++) {
        csg_vec3 p = test_point(random, i % 3 ? 1.2 : 4);
        double expected = sample(&all, p).value;
        for (int way = PAPER; way <= DEMAND; way++) {
            double value = sample(&lazy[way], p).value;
            if (!is_same_number(value, expected))
                fail_msg("bounds %d, band %g, way %d: %.17g is not %.17g", (int)bounds, band, way,
                         value, expected);
        }
    }
    assert_int_equal(all.counts.total, CHECKED * csg_lazy_node_count(all.lazy));
    assert_true(lazy[PAPER].counts.total <= all.counts.total);
    for (int way = PAPER; way <= DEMAND; way++) {
        parts[way] += (double)lazy[way].counts.total / (double)all.counts.total;
        evaluator_end(&lazy[way]);
    }
    evaluator_end(&all);
}

static void test_laziness_changes_no_bit(void **state)
{
    enum { TREES = ROUNDS(300) };
    double parts[4][2] = {{0}}, filleted[4][2] = {{0}};
    unsigned trees = 0;
    for (uint64_t seed = 5000; seed < 5000 + TREES; seed++) {
        csg_random random;
        csgm_scene *scene = random_scene(seed, &random);
        bool has_fillet = test_waver(scene) > 0; /* all of its operands are asked for */
        for (csg_lazy_bounds bounds = CSG_LAZY_NO_BOUNDS; bounds <= CSG_LAZY_EXACT; bounds++)
            check_laziness(scene, &random, bounds, (has_fillet ? filleted : parts)[bounds]);
        trees += !has_fillet;
        csg_scene_destroy(scene);
    }
    for (csg_lazy_bounds bounds = CSG_LAZY_NO_BOUNDS; bounds <= CSG_LAZY_EXACT; bounds++)
        print_message("bounds %d: %.2f of all nodes by the paper's rules, %.2f with demand\n",
                      (int)bounds, parts[bounds][PAPER] / trees, parts[bounds][DEMAND] / trees);
    assert_true(trees > 0.8 * TREES && trees < TREES);
    assert_true(parts[CSG_LAZY_OWN_BOXES][PAPER] < 0.6 * trees);
    assert_true(parts[CSG_LAZY_EXACT][PAPER] < 0.7 * trees);
    assert_true(parts[CSG_LAZY_EXACT][DEMAND] < 0.95 * parts[CSG_LAZY_EXACT][PAPER]);
}

/* Returns the largest difference inside the band. */
static double check_exactness(const csgm_scene *scene, csg_random *random, double band)
{
    evaluator e = evaluator_with(scene, csg_lazy_options_default(band));
    double worst = 0;
    for (int i = 0; i < 100; i++) {
        csg_vec3 p = test_point(random, i % 3 ? 1.2 : 3);
        csg_sample plain = test_sample(scene, p), cut = sample(&e, p);
        if ((plain.value >= 0) != (cut.value >= 0) && fabs(plain.value) > 1e-15)
            fail_msg("%.17g has the sign of %.17g", cut.value, plain.value);
        if (fabs(plain.value) > band)
            continue;
        worst = fmax(worst, fabs(cut.value - plain.value));
        if (fabs(plain.value) < band * 0.999)
            test_near_vec3(cut.gradient, plain.gradient, 1e-12);
    }
    evaluator_end(&e);
    return worst;
}

static void test_exact_scheme_is_exact(void **state)
{
    double worst = 0;
    for (uint64_t seed = 6000; seed < 6000 + ROUNDS(300); seed++) {
        csg_random random;
        csgm_scene *scene = random_scene(seed, &random);
        worst = fmax(worst, check_exactness(scene, &random, 0));
        worst = fmax(worst, check_exactness(scene, &random, 0.02));
        worst = fmax(worst, check_exactness(scene, &random, 0.3));
        csg_scene_destroy(scene);
    }
    print_message("worst in the band: %g\n", worst);
    assert_true(worst <= 1e-15); /* some rounding of coordinates up to 4 */
}

static csg_node_id random_ball(csg_random *random)
{
    csg_vec3 c = test_point(random, 1);
    csg_node_id ball = sphere(c.x, c.y, c.z, csg_random_uniform(random, 0.2, 0.7));
    if (csg_random_below(random, 3) == 0)
        ball = csg_build_soft(&builder, (csg_soft){CSG_FALLOFF_CUBIC, 0.5}, ball, NOWHERE);
    return ball;
}

/* Rules of all kinds with their standard parameters over balls and sharp unions, soft ones among
 * them. */
static csg_node_id rule_tree(csg_random *random, unsigned depth)
{
    if (!depth)
        return random_ball(random);
    csg_node_kind kind = CSG_NODE_UNION + csg_random_below(random, 3);
    csg_blend blend = sharp;
    uint32_t pick = csg_random_below(random, CSG_BLEND_END + 4);
    csg_rule rule = {0};
    if (pick > CSG_BLEND_ORTHOGONAL && pick < CSG_BLEND_FIELD_SHARP && pick != CSG_BLEND_PROFILE) {
        rule = csg_rule_standard(pick);
        rule.range = csg_blend_takes_fields(pick) ? 0.3 : 0;
        for (int i = 0; i < 2 && !csg_blend_takes_fields(pick); i++)
            rule.parameters[i] *= 0.4;
        if (pick == CSG_BLEND_SCALE_SET && depth % 2)
            rule.parameters[3] = 0.3; /* debulge */
        blend = csg_build_rule(&builder, &rule);
    } else if (pick < CSG_BLEND_FILLET) {
        blend = test_random_blend(random, pick);
    }
    csg_node_id first = rule_tree(random, depth - 1);
    return build_operator(kind, blend, first, rule_tree(random, depth - 1));
}

static void test_rules_are_exact_too(void **state)
{
    enum { RULED = ROUNDS(200) };
    double parts[2] = {0}, worst = 0;
    for (uint64_t seed = 9000; seed < 9000 + RULED; seed++) {
        csg_random random = {seed};
        csg_build_abandon(&builder);
        assert_int_equal(csg_build_begin(&builder, &context), CSGM_OK);
        csgm_scene *scene = test_seal(&builder, rule_tree(&random, 1 + (unsigned)seed % 5));
        check_laziness(scene, &random, CSG_LAZY_EXACT, parts);
        check_laziness(scene, &random, CSG_LAZY_OWN_BOXES, parts);
        worst = fmax(worst, check_exactness(scene, &random, 0));
        worst = fmax(worst, check_exactness(scene, &random, 0.02));
        worst = fmax(worst, check_exactness(scene, &random, 0.3));
        csg_scene_destroy(scene);
    }
    print_message("worst in the band: %g; %.2f, with demand %.2f of all nodes\n", worst,
                  parts[PAPER] / (2 * RULED), parts[DEMAND] / (2 * RULED));
    assert_true(worst <= 1e-15);
}

/* A steep formula, 3 (0.5 - z), cut by balls and cutting them. */
static csg_node_id steep_field(void)
{
    const csg_formula_step steps[] = {{CSG_FORMULA_CONSTANT, 0, 0, 0.5},
                                      {CSG_FORMULA_Z, 0, 0, 0},
                                      {CSG_FORMULA_SUB, 0, 1, 0},
                                      {CSG_FORMULA_CONSTANT, 0, 0, 3},
                                      {CSG_FORMULA_MUL, 2, 3, 0}};
    const csg_field_domain everywhere = {csg_box_all(), false, 3, false};
    return csg_build_field(&builder, steps, 5, &everywhere, NOWHERE);
}

static void test_steep_fields(void **state)
{
    csg_blend soft = {CSG_BLEND_PARABOLA, 0.8, false};
    csg_node_id cut =
        build_operator(CSG_NODE_INTERSECTION, soft, sphere(0, 0, 0, 1), steep_field());
    csg_node_id bitten =
        build_operator(CSG_NODE_DIFFERENCE, sharp, sphere(1.5, 0, 0.4, 0.9), steep_field());
    csgm_scene *scene = test_seal(&builder, build_operator(CSG_NODE_UNION, soft, cut, bitten));
    csg_random random = {12};
    double parts[2] = {0};
    for (int i = 0; i < 10; i++) {
        check_laziness(scene, &random, CSG_LAZY_EXACT, parts);
        assert_true(check_exactness(scene, &random, i * 0.03) <= 1e-15);
    }
    evaluator e = evaluator_of(scene, true, CSG_LAZY_EXACT, 0);
    test_near(csg_lazy_lipschitz(e.lazy), 3, 0);
    assert_true(parts[PAPER] < 10);
    evaluator_end(&e);
    csg_scene_destroy(scene);
}

static void test_fields_keep_their_constants(void **state)
{
    for (uint64_t seed = 7000; seed < 7000 + ROUNDS(100); seed++) {
        csg_random random;
        csgm_scene *scene = random_scene(seed, &random);
        evaluator e = evaluator_of(scene, true, CSG_LAZY_OWN_BOXES, 0);
        double waver = test_waver(scene);
        for (int i = 0; i < 60; i++) {
            csg_vec3 p = test_point(&random, 2), q = test_point(&random, 2);
            double distance = csg_vec3_norm(csg_vec3_sub(p, q));
            double change = fabs(sample(&e, p).value - sample(&e, q).value);
            assert_true(change <= csg_lazy_lipschitz(e.lazy) * distance * (1 + 1e-9) + waver);
        }
        evaluator_end(&e);
        csg_scene_destroy(scene);
    }
}

/* ---- joins ----------------------------------------------------------------------------------- */

enum { BALLS = 5000 };

static csgm_scene *many_balls(csg_random *random, csg_node_kind kind, csg_blend blend)
{
    static csg_node_id balls[BALLS];
    for (int i = 0; i < BALLS; i++) {
        csg_vec3 c = test_point(random, 20);
        balls[i] = sphere(c.x, c.y, c.z, csg_random_uniform(random, 0.1, 1));
    }
    if (kind == CSG_NODE_DIFFERENCE)
        balls[0] = primitive(CSG_NODE_BOX, 20, 20, 20, 0);
    return test_seal(&builder, csg_build_operator(&builder, kind, blend, balls, BALLS, NOWHERE));
}

static void check_many(csg_node_kind kind, csg_blend blend, double most_per_point)
{
    csg_random random = {77};
    csgm_scene *scene = many_balls(&random, kind, blend);
    evaluator e = evaluator_of(scene, true, CSG_LAZY_EXACT, 0.01);
    assert_int_equal(csg_lazy_node_count(e.lazy), 2 * BALLS - 1);
    assert_true(e.lazy->depth < 60 || blend.kind != CSG_BLEND_SHARP);
    enum { POINTS = 100 };
    for (int i = 0; i < POINTS; i++) {
        csg_vec3 p = test_point(&random, 22);
        double plain = test_sample(scene, p).value, value = sample(&e, p).value;
        assert_true((plain >= 0) == (value >= 0));
        if (fabs(plain) < 0.01)
            test_near(value, plain, 1e-14); /* of coordinates up to 40 */
    }
    double per_point = (double)e.counts.total / POINTS;
    print_message("%s of %d %s: %.1f nodes per point\n", csg_node_kind_name(kind), BALLS,
                  csg_blend_name(blend.kind), per_point);
    assert_true(per_point < most_per_point);
    evaluator_end(&e);
    csg_scene_destroy(scene);
    assert_int_equal(csg_build_begin(&builder, &context), CSGM_OK);
}

static void test_long_operators_are_grouped(void **state)
{
    check_many(CSG_NODE_UNION, sharp, 200);
    check_many(CSG_NODE_DIFFERENCE, sharp, 200);
    check_many(CSG_NODE_UNION, (csg_blend){CSG_BLEND_ROUND, 0.1, false}, 200);
}

/* Colours do not stand between unions, and nested ones are grouped together. */
static void test_coloured_unions_are_one(void **state)
{
    csg_node_id groups[8];
    for (int g = 0; g < 8; g++) {
        csg_node_id balls[8];
        for (int i = 0; i < 8; i++)
            balls[i] = sphere(i, 100 * (g % 2) + g, 0, 0.1);
        groups[g] = csg_build_operator(&builder, CSG_NODE_UNION, sharp, balls, 8, NOWHERE);
        groups[g] = csg_build_color(&builder, (csg_color){1, 0, 0, 1}, groups[g], NOWHERE);
    }
    csg_node_id all = csg_build_operator(&builder, CSG_NODE_UNION, sharp, groups, 8, NOWHERE);
    csgm_scene *scene = test_seal(&builder, all);
    evaluator e = evaluator_of(scene, true, CSG_LAZY_EXACT, 0.01);
    assert_int_equal(csg_lazy_node_count(e.lazy), 127);
    const csgm_scene *tree = &e.lazy->tree;
    const csg_node_id *sides = csg_scene_children(tree, &tree->nodes[tree->root]);
    csg_box a = e.lazy->bounds[sides[0]].box, b = e.lazy->bounds[sides[1]].box;
    assert_true(fmin(a.max.y, b.max.y) < 10 && fmax(a.min.y, b.min.y) > 90);
    csg_vec3 p = {3, 104.95, 0.2};
    test_near(sample(&e, p).value, test_sample(scene, p).value, 0);
    assert_true(e.counts.total < 25);
    evaluator_end(&e);
    csg_scene_destroy(scene);
}

static void test_small_scenes(void **state)
{
    csgm_scene *scene = test_seal(&builder, CSG_NODE_NONE);
    evaluator e = evaluator_of(scene, true, CSG_LAZY_EXACT, 0.01);
    assert_true(sample(&e, (csg_vec3){0, 0, 0}).value == -INFINITY);
    assert_int_equal(e.counts.total, 1);
    evaluator_end(&e);
    csg_scene_destroy(scene);
    assert_int_equal(csg_build_begin(&builder, &context), CSGM_OK);
    scene = test_seal(&builder, sphere(1, 2, 3, 0.5));
    e = evaluator_of(scene, true, CSG_LAZY_EXACT, 0.01);
    csg_sample s = sample(&e, (csg_vec3){1, 2, 3.5});
    test_near(s.value, 0, 1e-15);
    test_near_vec3(s.gradient, (csg_vec3){0, 0, -1}, 1e-15);
    assert_int_equal(csg_lazy_node_count(e.lazy), 1);
    assert_int_equal(e.counts.total, 1);
    evaluator_end(&e);
    csg_scene_destroy(scene);
}

/* However deep the tree is: balls blended one after another. */
static void test_deep_trees(void **state)
{
    csg_node_id chain = sphere(0, 0, 0, 0.6);
    for (int i = 1; i < 5000; i++)
        chain = build_operator(CSG_NODE_UNION, (csg_blend){CSG_BLEND_PARABOLA, 0.4, false}, chain,
                               sphere(i, 0, 0, 0.6));
    csgm_scene *scene = test_seal(&builder, chain);
    evaluator e = evaluator_of(scene, true, CSG_LAZY_OWN_BOXES, 0);
    csg_vec3 p = {4998.4, 0.5, 0};
    test_near(sample(&e, p).value, test_sample(scene, p).value, 1e-12);
    assert_int_equal(csg_lazy_node_count(e.lazy), 2 * 5000 - 1);
    evaluator_end(&e);
    csg_scene_destroy(scene);
}

/* ---- memory ---------------------------------------------------------------------------------- */

typedef struct failing_memory {
    unsigned left; /* allocations that still work */
} failing_memory;

static void *allocate_or_fail(void *user, size_t size_bytes)
{
    failing_memory *f = user;
    return f->left-- ? malloc(size_bytes) : (f->left = 0, NULL);
}

static void release(void *user, void *pointer, size_t size_bytes)
{
    free(pointer);
}

static void test_memory_runs_out(void **state)
{
    csg_random random;
    csgm_scene *scene = random_scene(8059, &random);
    csg_memory kept = context.memory;
    unsigned works = 0;
    for (unsigned left = 0; !works && left < 200; left++) {
        failing_memory failing = {left};
        context.memory.allocator =
            (csgm_allocator){.alloc = allocate_or_fail, .release = release, .user = &failing};
        csg_lazy_options options = csg_lazy_options_default(0.01);
        csg_lazy *lazy = NULL;
        csgm_status status = csg_lazy_create(scene, &options, &lazy);
        assert_true(status == CSGM_OK || (status == CSGM_ERR_MEMORY && !lazy));
        works = status == CSGM_OK ? left : 0;
        csg_lazy_destroy(lazy);
        assert_int_equal(atomic_load(&context.memory.used_bytes), atomic_load(&kept.used_bytes));
    }
    assert_true(works > 5);
    context.memory.allocator = kept.allocator;
    csg_scene_destroy(scene);
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, begin, end)
    const struct CMUnitTest tests[] = {
        TEST(test_boxes_of_the_worked_example),
        TEST(test_counts_of_the_worked_example),
        TEST(test_shared_boxes_blend_too_much),
        TEST(test_own_boxes_blend_too_little),
        TEST(test_shared_boxes_shut_holes),
        TEST(test_laziness_changes_no_bit),
        TEST(test_exact_scheme_is_exact),
        TEST(test_rules_are_exact_too),
        TEST(test_steep_fields),
        TEST(test_fields_keep_their_constants),
        TEST(test_long_operators_are_grouped),
        TEST(test_coloured_unions_are_one),
        TEST(test_small_scenes),
        TEST(test_deep_trees),
        TEST(test_memory_runs_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
