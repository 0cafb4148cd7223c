/* SPDX-License-Identifier: MIT
 * Every primitive in every kind of frame and every blend, at points chosen to hurt: each build of
 * the kernels gives the scalar build's bits, and those are the reference's values.
 *
 * Accuracy, with L the longest length in the arithmetic (coordinates, offsets, sizes):
 *   value     within 8 ulp of L (3.3 seen), and a primitive's within the slack that pruning allows
 *   gradient  within 1e-3 away from kinks
 */
#include <float.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "field/field_support.h"
#include "scene/operators/blend_kinds.h"
#include "scene/primitives/kinds.h"
#include "scene/primitives/primitive.h"
#include "scene/random_blend.h"

enum frame_kind {
    OFFSET,
    SHIFTED_FAR,
    TURNED,
    SCALED,
    MIRRORED,
    UNEQUAL,
    UNEQUAL_MIRRORED,
    FRAMES
};
static const char *const frame_names[FRAMES] = {
    "offset", "far offset", "turned", "scaled", "mirrored", "unequal", "unequal mirrored"};

static csg_affine make_frame(csg_random *random, enum frame_kind kind)
{
    csg_affine shift = csg_affine_translate(test_point(random, 1));
    csg_affine mirror = csg_affine_mirror(test_direction(random));
    switch (kind) {
    case OFFSET:
        return shift;
    case SHIFTED_FAR:
        return csg_affine_translate(test_point(random, 3000));
    case TURNED:
        return test_random_affine(random, 1, 1, 1);
    case SCALED:
        return test_random_affine(random, 3.7, 3.7, 1);
    case MIRRORED:
        return csg_affine_multiply(shift, mirror);
    case UNEQUAL:
        return test_random_affine(random, 0.3, 3, 1);
    default:
        return csg_affine_multiply(test_random_affine(random, 0.3, 3, 1), mirror);
    }
}

/* ---- points -------------------------------------------------------------------------------- */

/* Own-frame places where formulas change their mind: centres, axes, corners, ends, and the surface.
 */
static void add_special_points(test_points *points, csg_random *random, csg_primitive_kind kind,
                               const double *v, const csg_affine *place, csg_vec3 center)
{
    csg_vec3 own[256];
    size_t n = 0;
    const double along[] = {0, 1e-40, 1e-20, 1e-7, 1e-3, 0.5, 1, 50, 1e6, v[0], v[1], v[2], v[3]};
    for (size_t i = 0; i < sizeof along / sizeof *along; i++)
        for (int axis = 0; axis < 3; axis++) {
            double at[3] = {0, 0, 0};
            at[axis] = i & 1 ? -along[i] : along[i];
            own[n++] = csg_vec3_make(at[0], at[1], at[2]);
        }
    for (int corner = 0; corner < 27; corner++)
        own[n++] = csg_vec3_make(v[0] * (corner % 3 - 1), v[1] * (corner / 3 % 3 - 1),
                                 v[2] * (corner / 9 - 1));
    for (int i = 0; i < 60; i++) { /* on the surface: one step along the gradient */
        csg_vec3 p = test_point(random, 1);
        csg_sample s = csg_reference_primitive(kind, v, p);
        own[n++] = csg_vec3_sub(p, csg_vec3_scale(s.gradient, s.value));
    }
    for (int i = 0; i < 60; i++)
        own[n++] = test_point(random, i < 40 ? 1.5 : i < 50 ? 20 : 1e6);
    for (size_t i = 0; i < n; i++)
        assert_true(test_points_add(points, csg_vec3_sub(csg_affine_point(place, own[i]), center)));
}

/* Zeros of both signs, denormals and huge numbers, all ways. */
static void add_raw_points(test_points *points)
{
    static const double raw[] = {0.0, -0.0, 1e-40, -1e-42, 1e6, -3e6};
    for (int i = 0; i < 6 * 6 * 6; i++)
        assert_true(
            test_points_add(points, csg_vec3_make(raw[i % 6], raw[i / 6 % 6], raw[i / 36])));
}

/* ---- checks -------------------------------------------------------------------------------- */

static void check_intervals(const csg_kernel *kernel, const csg_kernel *scalar,
                            const csg_tape *tape, const test_points *points, const char *what)
{
    enum { MOST_NODES = 256 };
    float low[2][MOST_NODES * CSG_OCTANTS], high[2][MOST_NODES * CSG_OCTANTS];
    static float scratch[1 << 17];
    assert_true(tape->count <= MOST_NODES);
    assert_true(csg_kernel_scratch_floats(csg_tape_depth(tape)) <= 1 << 17);
    for (size_t i = 0; i + CSG_OCTANTS <= points->count; i += CSG_OCTANTS) {
        float radius = (float)(i % 5) * 0.3f;
        scalar->intervals(tape, points->x + i, points->y + i, points->z + i, radius, NULL, low[0],
                          high[0], scratch);
        kernel->intervals(tape, points->x + i, points->y + i, points->z + i, radius, NULL, low[1],
                          high[1], scratch);
        size_t bytes = tape->count * CSG_OCTANTS * sizeof(float);
        if (memcmp(low[0], low[1], bytes) || memcmp(high[0], high[1], bytes))
            fail_msg("%s: intervals differ at point %zu", what, i);
    }
}

/* All builds against the scalar one. */
static void check_builds(const csgm_field *field, const test_points *points, test_results *results,
                         const char *what)
{
    static test_results other;
    const csg_kernel *kernels[8];
    size_t count = test_kernels(kernels);
    test_evaluate(kernels[0], &field->tape, points, results);
    for (size_t k = 1; k < count; k++) {
        char label[160];
        snprintf(label, sizeof label, "%s: %s", what, kernels[k]->name);
        test_evaluate(kernels[k], &field->tape, points, &other);
        test_same_bits(results, &other, points->count, true, label);
        check_intervals(kernels[k], kernels[0], &field->tape, points, label);
    }
}

static double longest(csg_vec3 p)
{
    return fmax(fabs(p.x), fmax(fabs(p.y), fabs(p.z)));
}

static void check_values(const test_subject *subject, const test_points *points,
                         const test_results *results, double size, const char *what)
{
    for (size_t i = 0; i < points->count; i++) {
        csg_vec3 p = test_points_in_scene(points, i, subject->field);
        double expected = test_sample(subject->scene, p).value, value = (double)results->value[i];
        double length = size + longest(csg_vec3_sub(p, subject->field->center));
        double error = fabs(value - expected), most = 8 * (double)FLT_EPSILON * length;
        if (subject->field->tape.turns) { /* gradients are in the values, and less exact */
            most *= 20;
            if (longest(csg_vec3_sub(p, subject->field->center)) > 100 * size ||
                !test_is_smooth(subject->scene, p, 2e-5 * size))
                continue;
        }
        if (!(error <= most))
            fail_msg("%s: at %.9g %.9g %.9g (field frame) %.9g is %g off %.17g", what,
                     (double)points->x[i], (double)points->y[i], (double)points->z[i], value, error,
                     expected);
    }
}

static csg_vec3 gradient_of(const test_results *results, size_t i)
{
    return csg_vec3_make((double)results->gradient[0][i], (double)results->gradient[1][i],
                         (double)results->gradient[2][i]);
}

/* Returns how many points were away from kinks. */
static size_t check_gradients(const test_subject *subject, const test_points *points,
                              const test_results *results, double size, const char *what)
{
    size_t checked = 0;
    for (size_t i = 0; i < points->count; i++) {
        csg_vec3 p = test_points_in_scene(points, i, subject->field);
        csg_vec3 own = csg_vec3_sub(p, subject->field->center);
        if (longest(own) > 100 * size || !test_is_smooth(subject->scene, p, 2e-5 * size))
            continue;
        csg_vec3 expected = test_sample(subject->scene, p).gradient;
        csg_vec3 value = gradient_of(results, i);
        double error = csg_vec3_norm(csg_vec3_sub(value, expected));
        if (!(error <= 1e-3))
            fail_msg("%s: at %.9g %.9g %.9g gradient (%g %g %g) is not (%g %g %g)", what, own.x,
                     own.y, own.z, value.x, value.y, value.z, expected.x, expected.y, expected.z);
        checked++;
    }
    return checked;
}

/* ---- primitives ---------------------------------------------------------------------------- */

/* The slack of a leaf and that of the lattice's extent cover the error of its values. */
static void check_slack(const test_subject *subject, const test_points *points,
                        const test_results *results, const char *what)
{
    const csg_tape *tape = &subject->field->tape;
    double slack = (double)tape->parameters[tape->nodes[0].parameters + CSG_LEAF_SLACK];
    for (size_t i = 0; i < points->count; i++) {
        csg_vec3 p = test_points_in_scene(points, i, subject->field);
        double expected = test_sample(subject->scene, p).value;
        double extent = longest(csg_vec3_sub(p, subject->field->center));
        double allowed = slack + 32 * (double)FLT_EPSILON * extent;
        if (!(fabs((double)results->value[i] - expected) <= allowed))
            fail_msg("%s: error %g of %.9g exceeds the slack %g", what,
                     fabs((double)results->value[i] - expected), expected, allowed);
    }
}

static void check_primitive(csg_random *random, csg_primitive_kind kind, enum frame_kind frame)
{
    static test_points points;
    static test_results results;
    test_subject subject;
    double v[CSG_PRIMITIVE_MOST_PARAMETERS] = {0};
    test_subject_begin(&subject);
    csg_node_id node = test_random_primitive(&subject.builder, random, kind, v);
    csg_affine place = make_frame(random, frame);
    test_subject_compile(&subject, csg_build_transform(&subject.builder, &place, node, NOWHERE));
    test_points_clear(&points);
    add_special_points(&points, random, kind, v, &place, subject.field->center);
    add_raw_points(&points);
    char what[80];
    snprintf(what, sizeof what, "%s, %s (%g %g %g %g)", csg_node_kind_name(kind),
             frame_names[frame], v[0], v[1], v[2], v[3]);
    check_builds(subject.field, &points, &results, what);
    double size =
        4 + (frame == SHIFTED_FAR && !csg_primitive_has(kind, CSG_TRAIT_BOUNDED) ? 3000 : 0);
    check_values(&subject, &points, &results, size, what);
    check_slack(&subject, &points, &results, what);
    check_gradients(&subject, &points, &results, size, what);
    test_subject_end(&subject);
}

/* Tubes are in test_curves.c, gauges (by powers of floats: with more error) in test_rules.c. */
static bool is_tested_here(csg_primitive_kind kind)
{
    return !csg_primitive_has(kind, CSG_TRAIT_CURVE | CSG_TRAIT_GAUGE);
}

static void test_primitives(void **state)
{
    csg_random random = {1};
    for (csg_primitive_kind kind = CSG_NODE_FIRST_PRIMITIVE; kind < CSG_NODE_PRIMITIVES_END; kind++)
        for (int frame = 0; frame < FRAMES; frame++)
            for (int turn = 0; turn < 6 && is_tested_here(kind); turn++)
                check_primitive(&random, kind, (enum frame_kind)frame);
}

/* Needles and pancakes: where the lengths of a primitive differ most. */
static void test_extreme_primitives(void **state)
{
    static const struct {
        csg_primitive_kind kind;
        double v[4];
    } rows[] = {
        {CSG_NODE_ELLIPSOID, {1, 1, 1}},         {CSG_NODE_ELLIPSOID, {1, 0.01, 0.01}},
        {CSG_NODE_ELLIPSOID, {1, 1, 0.01}},      {CSG_NODE_ELLIPSOID, {0.01, 1, 0.3}},
        {CSG_NODE_BOX, {1, 0.001, 1, 0}},        {CSG_NODE_BOX, {0.5, 0.5, 0.5, 0.5}},
        {CSG_NODE_FRUSTUM, {1, 0, 0.001, 0}},    {CSG_NODE_FRUSTUM, {0, 0.001, 1, 0}},
        {CSG_NODE_FRUSTUM, {1, 1, 1, 0.5}},      {CSG_NODE_CAPSULE, {1, 0.999, 0, 0}},
        {CSG_NODE_CAPSULE, {0.01, 1, 0.995, 0}}, {CSG_NODE_CAPSULE, {1, 0.3, 0.3, 0}},
        {CSG_NODE_TORUS, {0.2, 0.7, 180, 0}},    {CSG_NODE_TORUS, {1, 0.001, 90, 0}},
        {CSG_NODE_TORUS, {1, 0.3, 20, 0}},       {CSG_NODE_PLANE, {0.6, 0, 0.8, 0.1}},
    };
    static test_points points;
    static test_results results;
    csg_random random = {2};
    for (size_t r = 0; r < sizeof rows / sizeof *rows; r++) {
        test_subject subject;
        test_subject_begin(&subject);
        csg_affine place = csg_affine_identity();
        test_subject_compile(
            &subject, csg_build_primitive(&subject.builder, rows[r].kind, rows[r].v, NOWHERE));
        test_points_clear(&points);
        add_special_points(&points, &random, rows[r].kind, rows[r].v, &place,
                           subject.field->center);
        add_raw_points(&points);
        char what[80];
        snprintf(what, sizeof what, "extreme %s, row %zu", csg_node_kind_name(rows[r].kind), r);
        check_builds(subject.field, &points, &results, what);
        check_values(&subject, &points, &results, 2, what);
        check_slack(&subject, &points, &results, what);
        check_gradients(&subject, &points, &results, 2, what);
        test_subject_end(&subject);
    }
}

/* ---- blends -------------------------------------------------------------------------------- */

static csg_node_id colored_operand(csg_scene_builder *builder, csg_random *random, unsigned index,
                                   bool twins)
{
    csg_color color = {(float)(index & 1), (float)(index >> 1 & 1), (float)index / 9, 1};
    csg_node_id node;
    csg_affine place;
    if (twins) { /* mirror images and coincident solids: operands that are exactly equal */
        node = csg_build_primitive(builder, CSG_NODE_SPHERE, (double[]){0.5}, NOWHERE);
        place = csg_affine_translate(csg_vec3_make(index % 2 ? 0.25 : -0.25, 0, 0));
    } else {
        csg_primitive_kind kind = CSG_NODE_SPHERE + csg_random_below(random, 7);
        node = test_random_primitive(builder, random, kind, NULL);
        place = test_random_affine(random, 0.6, 1.3, 0.4);
    }
    return csg_build_color(builder, color, csg_build_transform(builder, &place, node, NOWHERE),
                           NOWHERE);
}

static void add_blend_points(test_points *points, csg_random *random)
{
    for (int i = 0; i < 200; i++) {
        csg_vec3 p = test_point(random, 1.2);
        if (i % 4 == 0)
            p.x = 0; /* the twins' plane of symmetry */
        test_points_add(points, p);
    }
    add_raw_points(points);
}

static size_t check_blend(csg_random *random, csg_blend_kind blend, csg_node_kind how,
                          unsigned operands, bool twins)
{
    static test_points points;
    static test_results results;
    test_subject subject;
    csg_node_id nodes[9];
    test_subject_begin(&subject);
    for (unsigned i = 0; i < operands; i++)
        nodes[i] = colored_operand(&subject.builder, random, i, twins);
    test_subject_compile(&subject,
                         csg_build_operator(&subject.builder, how, test_random_blend(random, blend),
                                            nodes, operands, NOWHERE));
    test_points_clear(&points);
    add_blend_points(&points, random);
    char what[80];
    snprintf(what, sizeof what, "%s %s of %u%s", csg_blend_name(blend), csg_node_kind_name(how),
             operands, twins ? " twins" : "");
    check_builds(subject.field, &points, &results, what);
    check_values(&subject, &points, &results, 4, what);
    size_t checked = check_gradients(&subject, &points, &results, 4, what);
    for (size_t i = 0; i < points.count; i++)
        for (int c = 0; c < 4; c++)
            assert_true(results.color[c][i] >= -1e-6f && results.color[c][i] <= 1 + 1e-5f);
    test_subject_end(&subject);
    return checked;
}

static void test_blends(void **state)
{
    csg_random random = {3};
    size_t checked = 0;
    for (csg_blend_kind blend = CSG_BLEND_SHARP; blend < CSG_BLEND_COUNT; blend++)
        for (csg_node_kind how = CSG_NODE_UNION; how <= CSG_NODE_DIFFERENCE; how++)
            for (unsigned operands = 2; operands <= 9; operands++) {
                if (operands > 3 && operands < 9 && blend != CSG_BLEND_ROUND)
                    continue;
                checked += check_blend(&random, blend, how, operands, false);
                checked += check_blend(&random, blend, how, operands, true);
            }
    assert_true(checked > 10000); /* gradients were compared, not only skipped */
}

/* ---- batches ------------------------------------------------------------------------------- */

/* A point's result depends neither on its place in the batch nor on the batch's length. */
static void test_batches(void **state)
{
    enum { MOST = 1040 };
    static const size_t counts[] = {1, 2, 7, 15, 16, 17, 31, 255, 256, 257, 512, 700, 1024};
    static float x[MOST], y[MOST], z[MOST], whole[MOST], part[MOST], scratch[1 << 20];
    csg_random random = {4};
    test_subject subject;
    test_subject_begin(&subject);
    test_subject_compile(&subject, test_random_scene(&subject.builder, &random, 20));
    const csg_tape *tape = &subject.field->tape;
    size_t floats = csg_kernel_scratch_floats(subject.field->depth);
    assert_true(floats <= sizeof scratch / sizeof *scratch);
    for (int i = 0; i < MOST; i++) {
        csg_vec3 p = test_point(&random, 2);
        x[i] = (float)p.x, y[i] = (float)p.y, z[i] = (float)p.z;
    }
    const csg_kernel *kernels[8];
    size_t kernel_count = test_kernels(kernels);
    for (size_t k = 0; k < kernel_count; k++) {
        kernels[k]->values(tape, x, y, z, 1024, whole, scratch, floats);
        for (size_t c = 0; c < sizeof counts / sizeof *counts; c++) {
            size_t first = 1024 - counts[c];
            kernels[k]->values(tape, x + first, y + first, z + first, counts[c], part, scratch,
                               floats);
            assert_memory_equal(part, whole + first, counts[c] * sizeof(float));
        }
        /* The least scratch that is allowed. */
        kernels[k]->values(tape, x, y, z, 1024, part, scratch,
                           csg_kernel_arrays(subject.field->depth) * CSG_LANES);
        assert_memory_equal(part, whole, 1024 * sizeof(float));
    }
    test_subject_end(&subject);
}

/* Random trees: every walk, every build. */
static void test_random_trees(void **state)
{
    static test_points points;
    static test_results results;
    csg_random random = {5};
    for (int i = 0; i < 60; i++) {
        test_subject subject;
        test_random_shapes = i % 2;
        test_random_curves = i % 5 == 3;
        test_subject_begin(&subject);
        test_subject_compile(&subject,
                             test_random_scene(&subject.builder, &random, 1 + (unsigned)i % 12));
        test_points_clear(&points);
        while (test_points_add(&points, test_point(&random, 2)) && points.count < 256) {
        }
        char what[80];
        snprintf(what, sizeof what, "random scene %d", i);
        check_builds(subject.field, &points, &results, what);
        test_subject_end(&subject);
    }
}

/* Kernels have gradients as they are above a warp, the reference as they are below it. */
static bool has_warped_fillet(const csgm_scene *scene)
{
    bool *warped = calloc(scene->node_count, sizeof *warped), found = false;
    for (size_t i = scene->node_count; i-- > 0;) {
        const csg_node *node = &scene->nodes[i];
        found |= warped[i] && csg_node_is_fillet(node);
        for (uint32_t k = 0; k < node->child_count; k++)
            warped[csg_scene_children(scene, node)[k]] = warped[i] || node->kind == CSG_NODE_WARP;
    }
    free(warped);
    return found;
}

/* Trees with fillets, some of them scaled unequally or with empty operands: every build, and the
 * reference's values wherever it is smooth: where a gradient of an operand jumps, rounding decides
 * on which side a point lies. Returns how many points were compared. */
static size_t check_fillets(csg_random *random, unsigned i)
{
    static test_points points;
    static test_results results;
    test_subject subject;
    size_t compared = 0;
    double tolerance = test_random_rules ? 1e-3 : 1e-5; /* steep rules grow rounding */
    char what[80];
    snprintf(what, sizeof what, "fillets %u", i);
    test_subject_begin(&subject);
    test_subject_compile(&subject, test_random_scene(&subject.builder, random, 2 + i % 12));
    test_points_clear(&points);
    while (test_points_add(&points, test_point(random, 2)) && points.count < 256) {
    }
    check_builds(subject.field, &points, &results, what);
    bool warped = has_warped_fillet(subject.scene);
    for (size_t k = 0; k < points.count && !warped; k++) {
        csg_vec3 p = test_points_in_scene(&points, k, subject.field);
        csg_sample expected = test_sample(subject.scene, p);
        double error = fabs((double)results.value[k] - expected.value);
        if (error > tolerance && test_is_smooth(subject.scene, p, 1e-5))
            fail_msg("%s: %.9g instead of %.9g at %.9g %.9g %.9g", what, (double)results.value[k],
                     expected.value, p.x, p.y, p.z);
        compared += error <= tolerance;
    }
    test_subject_end(&subject);
    return compared;
}

static void test_fillets(void **state)
{
    csg_random random = {test_first_seed + 6};
    size_t compared = 0;
    test_random_fillets = true;
    for (unsigned i = 0; i < ROUNDS(60) * test_times; i++) {
        test_random_shapes = i % 3 == 1;
        test_random_curves = i % 5 == 3;
        test_random_rules = i % 4 == 2;
        compared += check_fillets(&random, i);
    }
    test_random_fillets = test_random_shapes = test_random_curves = test_random_rules = false;
    assert_true(compared > ROUNDS(60) * test_times * 250);
}

int main(int argc, char **argv)
{
    test_take_search(argc, argv);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_primitives),   cmocka_unit_test(test_extreme_primitives),
        cmocka_unit_test(test_blends),       cmocka_unit_test(test_batches),
        cmocka_unit_test(test_random_trees), cmocka_unit_test(test_fillets),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
