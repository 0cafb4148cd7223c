/* SPDX-License-Identifier: MIT
 * Our bounds against interval arithmetic with correct rounding (MPFI), in random boxes of random
 * scenes: every primitive alone, every blend, every rule, and trees of them.
 *
 * The kernel's interval of a cube, in floats, and the formula's range over it, in double, must hold
 * the true value at points of it, which MPFI knows to 25 digits; and from one point to another the
 * true value may change by no more than the formula's bound of its gradient allows. Where MPFI's
 * range over the cube, or over its 64 parts, lies within ours, ours is proven for that cube.
 *
 * Rules and fillets have no such formula: their true value is the reference's in double, give or
 * take 1e-12, and nothing is proven of them. Tubes are left out: formulas have chords of them.
 *
 * Usage: field_test_enclosures [SCENES SEED]: each with 64 boxes.
 */
#include <stdio.h>
#include <stdlib.h>

#include "field/prune_support.h"
#include "field/true_formula.h"
#include "scene/formula/formula_bound.h"
#include "scene/formula/formulate.h"
#include "scene/operators/rule.h"
#include "scene/primitives/kinds.h"
#include "scene/primitives/primitive.h"
#include "scene/random_blend.h"

enum { POINTS = 10, CUBES = 8, PARTS = 4 /* along an edge */ };

static unsigned long scene_count = 100, first_seed = 1;

typedef struct totals {
    uint64_t boxes, of_rules, points, proven, unknown;
    bool seen[256], blended[256];
} totals;

typedef struct subject {
    walk walk;
    true_formula truth;        /* of scenes without rules */
    csg_formula_bound *bounds; /* room for each step; NULL: there is no formula */
    mpfi_t near;               /* the reference's value and what is about it */
    char what[64];
} subject;

/* ---- scenes ---------------------------------------------------------------------------------- */

static csg_node_id placed(csg_scene_builder *builder, csg_random *random, csg_node_id node)
{
    csg_affine place = test_random_affine(random, 0.6, 1.3, 0.4);
    return csg_build_transform(builder, &place, node, NOWHERE);
}

static csg_primitive_kind some_primitive(unsigned long number)
{
    csg_primitive_kind kind;
    do
        kind =
            (csg_primitive_kind)(CSG_NODE_FIRST_PRIMITIVE +
                                 number++ % (CSG_NODE_PRIMITIVES_END - CSG_NODE_FIRST_PRIMITIVE));
    while (csg_primitive_has(kind, CSG_TRAIT_CURVE));
    return kind;
}

static csg_node_id pair(csg_scene_builder *builder, csg_random *random, unsigned long number)
{
    csg_node_id two[2];
    csg_blend blend = test_random_blend(random, (csg_blend_kind)(number / 3 % CSG_BLEND_COUNT));
    csg_node_kind how = number % 3 == 0   ? CSG_NODE_UNION
                        : number % 3 == 1 ? CSG_NODE_DIFFERENCE
                                          : CSG_NODE_INTERSECTION;
    for (int i = 0; i < 2; i++)
        two[i] =
            placed(builder, random,
                   test_random_primitive(builder, random, test_random_solid_kind(random), NULL));
    return csg_build_operator(builder, how, blend, two, 2, NOWHERE);
}

/* Primitives and pairs in turn; every other scene is a tree with rules. */
static csg_node_id random_root(csg_scene_builder *builder, csg_random *random, unsigned long number)
{
    test_random_rules = number % 2 == 1;
    test_random_fillets = number % 4 == 3;
    if (test_random_rules)
        return test_random_scene(builder, random, 2 + csg_random_below(random, 5));
    number /= 2;
    if (number % 2)
        return pair(builder, random, number / 2);
    return placed(builder, random,
                  test_random_primitive(builder, random, some_primitive(number / 2), NULL));
}

/* ---- one box --------------------------------------------------------------------------------- */

/* A stretch of the field's frame, in floats, as one of the scene's. */
static void set_stretch(const subject *s, mpfi_t out, int axis, double low, double high)
{
    csg_vec3 center = s->walk.subject.field->center;
    const double of[3] = {center.x, center.y, center.z};
    mpfi_interv_d(out, low, high);
    mpfi_add_d(out, out, of[axis]);
}

static mpfi_srcptr true_range(subject *s, csg_vec3 low, csg_vec3 high)
{
    set_stretch(s, s->truth.at[0], 0, low.x, high.x);
    set_stretch(s, s->truth.at[1], 1, low.y, high.y);
    set_stretch(s, s->truth.at[2], 2, low.z, high.z);
    return true_formula_run(&s->truth);
}

/* Is all of what MPFI finds in the cube within low..high? */
static bool is_proven(subject *s, cube k, double low, double high, int parts)
{
    double edge = 2 * k.half / parts;
    for (int i = 0; i < parts * parts * parts; i++) {
        csg_vec3 at = {k.center.x - k.half + edge * (i % parts),
                       k.center.y - k.half + edge * (i / parts % parts),
                       k.center.z - k.half + edge * (i / parts / parts)};
        mpfi_srcptr range = true_range(s, at, csg_vec3_add(at, csg_vec3_make(edge, edge, edge)));
        if (mpfi_nan_p(range) || mpfr_cmp_d(&range->left, low) < 0 ||
            mpfr_cmp_d(&range->right, high) > 0)
            return false;
    }
    return true;
}

static void expect_within(const subject *s, mpfi_srcptr value, double low, double high,
                          const char *whose)
{
    if (low <= high && (mpfr_cmp_d(&value->right, low) < 0 || mpfr_cmp_d(&value->left, high) > 0))
        fail_msg("%s: %.17g is not within %s [%.17g, %.17g]", s->what, mpfi_get_d(value), whose,
                 low, high);
}

/* NaN ends: the formula has none. */
static mpfi_srcptr true_value(subject *s, csg_vec3 p)
{
    if (s->bounds)
        return true_range(s, p, p);
    csg_vec3 at = csg_vec3_add(p, s->walk.subject.field->center);
    double value = test_sample(s->walk.subject.scene, at).value;
    double error = 1e-12 * (1 + fabs(value));
    mpfi_interv_d(s->near, value - error, value + error);
    return s->near;
}

/* Four corners, no two of them on an edge, and points between them. */
static csg_vec3 some_point(csg_random *random, cube k, int i)
{
    if (i >= 4)
        return csg_vec3_add(k.center, test_point(random, k.half));
    csg_vec3 way = {i & 1 ? 1 : -1, i & 2 ? 1 : -1, i == 1 || i == 2 ? 1 : -1};
    return csg_vec3_add(k.center, csg_vec3_scale(way, k.half));
}

/* What the formula's double intervals say of the cube: *range of its value, and its slope. */
static double bound_of(const subject *s, cube k, csg_formula_range *range)
{
    csg_vec3 middle = csg_vec3_add(k.center, s->walk.subject.field->center);
    csg_vec3 half = csg_vec3_make(k.half, k.half, k.half);
    csg_box box = {csg_vec3_sub(middle, half), csg_vec3_add(middle, half)};
    double slope = csg_formula_bound_on_box(s->truth.steps, s->truth.count, box, s->bounds);
    *range = s->bounds[s->truth.count - 1].value;
    return slope;
}

static void check_points(subject *s, csg_random *random, cube k, const double kernel[2], totals *t)
{
    csg_formula_range range = {NAN, NAN};
    double slope = s->bounds ? bound_of(s, k, &range) : INFINITY, last = NAN;
    csg_vec3 from = k.center;
    for (int i = 0; i < POINTS; i++) {
        csg_vec3 p = some_point(random, k, i);
        mpfi_srcptr value = true_value(s, p);
        t->unknown += mpfi_nan_p(value) != 0;
        if (mpfi_nan_p(value))
            continue;
        t->points++;
        expect_within(s, value, kernel[0], kernel[1], "the kernel's");
        expect_within(s, value, range.low, range.high, "the formula's");
        double now = mpfi_get_d(value), change = fabs(now - last);
        double most = slope * csg_vec3_norm(csg_vec3_sub(p, from));
        if (change > most * (1 + 1e-12) + 1e-12)
            fail_msg("%s: the value changes by %.17g, %.17g is allowed", s->what, change, most);
        last = now;
        from = p;
    }
}

static void check_boxes(subject *s, csg_random *random, totals *t)
{
    const csg_tape *tape = &s->walk.subject.field->tape;
    for (int i = 0; i < CUBES; i++) {
        cube parent = {test_point(random, i % 4 ? 1 : 3), exp2(-csg_random_uniform(random, 0, 7))};
        prune_children(&s->walk, tape, parent);
        for (int octant = 0; octant < CSG_OCTANTS; octant++) {
            cube k = child_of(parent, octant);
            size_t root = ((size_t)tape->count - 1) * CSG_OCTANTS + (size_t)octant;
            const double kernel[2] = {(double)s->walk.pruner.low[root],
                                      (double)s->walk.pruner.high[root]};
            /* The kernel has the nearest floats. */
            k.center = csg_vec3_make((double)(float)k.center.x, (double)(float)k.center.y,
                                     (double)(float)k.center.z);
            check_points(s, random, k, kernel, t);
            t->boxes++;
            t->of_rules += !s->bounds;
            if (s->bounds)
                t->proven += is_proven(s, k, kernel[0], kernel[1], 1) ||
                             (octant == 0 && is_proven(s, k, kernel[0], kernel[1], PARTS));
        }
    }
}

/* ---- one scene ------------------------------------------------------------------------------- */

static void look_at(const csgm_scene *scene, totals *t)
{
    for (size_t i = 0; i < scene->node_count; i++) {
        t->seen[scene->nodes[i].kind] = true;
        t->blended[scene->nodes[i].blend] |= scene->nodes[i].child_count > 1;
    }
}

static void check_scene(unsigned long seed, totals *t)
{
    static subject s;
    csg_random random = {seed};
    csg_formula_builder terms;
    csg_term result;
    csg_node_id obstacle;
    snprintf(s.what, sizeof s.what, "scene of seed %lu", seed);
    test_subject_begin(&s.walk.subject);
    test_subject_compile(&s.walk.subject, random_root(&s.walk.subject.builder, &random, seed));
    walk_begin(&s.walk, 4);
    csg_formula_begin(&terms, &s.walk.subject.context.memory);
    terms.most = 1u << 20;
    csgm_status status = csg_formulate(s.walk.subject.scene, &terms, &result, &obstacle);
    assert_true(status == CSGM_OK || status == CSGM_ERR_UNSUPPORTED);
    s.bounds = NULL;
    mpfi_init2(s.near, TRUE_BITS);
    if (status == CSGM_OK) {
        true_formula_begin(&s.truth, &terms, result);
        s.bounds = calloc(s.truth.count, sizeof *s.bounds);
        assert_non_null(s.bounds);
    }
    look_at(s.walk.subject.scene, t);
    check_boxes(&s, &random, t);
    if (s.bounds)
        true_formula_end(&s.truth);
    free(s.bounds);
    mpfi_clear(s.near);
    csg_formula_end(&terms);
    walk_end(&s.walk);
}

static void test_random_boxes(void **state)
{
    totals t = {0};
    for (unsigned long i = 0; i < scene_count; i++)
        check_scene(first_seed + i, &t);
    print_message("%llu boxes with a formula, %llu of them proven, %llu with rules; %llu points, "
                  "%llu without a value\n",
                  (unsigned long long)(t.boxes - t.of_rules), (unsigned long long)t.proven,
                  (unsigned long long)t.of_rules, (unsigned long long)t.points,
                  (unsigned long long)t.unknown);
    assert_true(t.proven * 4 > t.boxes - t.of_rules && t.unknown * 10 < t.points);
    if (scene_count < 100)
        return;
    for (csg_primitive_kind kind = CSG_NODE_FIRST_PRIMITIVE; kind < CSG_NODE_PRIMITIVES_END; kind++)
        if (!t.seen[kind] && !csg_primitive_has(kind, CSG_TRAIT_CURVE))
            fail_msg("no %s was tried", csg_node_kind_name(kind));
    for (int blend = 0; blend < CSG_BLEND_END; blend++)
        if (!t.blended[blend] && blend != CSG_BLEND_ORTHOGONAL && blend != CSG_BLEND_PROFILE &&
            blend != CSG_BLEND_FIELD_SHARP)
            fail_msg("no blend of kind %d was tried", blend);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_random_boxes)};
    if (argc == 3) {
        scene_count = strtoul(argv[1], NULL, 10);
        first_seed = strtoul(argv[2], NULL, 10);
    }
    return cmocka_run_group_tests(tests, NULL, NULL);
}
