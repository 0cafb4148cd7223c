/* SPDX-License-Identifier: MIT
 * From scenes to tapes: signs folded into the leaves, nested sharp operators flattened, frames and
 * blend widths scaled, clipping, depths, and the whole against the reference.
 */
#include <float.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "field/field_support.h"
#include "scene/operators/blend_kinds.h"
#include "scene/primitives/kinds.h"

#define SHARP ((csg_blend){CSG_BLEND_SHARP, 0, false})

static csg_node_id ball(csg_scene_builder *b, double r, double x)
{
    csg_affine place = csg_affine_translate(csg_vec3_make(x, 0, 0));
    return csg_build_transform(b, &place, csg_build_primitive(b, CSG_NODE_SPHERE, &r, NOWHERE),
                               NOWHERE);
}

static csg_node_id two(csg_scene_builder *b, csg_node_kind kind, csg_blend blend, csg_node_id x,
                       csg_node_id y)
{
    return csg_build_operator(b, kind, blend, (csg_node_id[]){x, y}, 2, NOWHERE);
}

static float sigma_of(const csg_tape *tape, uint32_t node)
{
    return tape->parameters[tape->nodes[node].parameters + CSG_LEAF_SIGMA];
}

/* ---- structure ------------------------------------------------------------------------------- */

/* a - (b u (c - d)) = min(a, -b, max(-c, d)): three operands of one intersection, the last a union.
 */
static void test_signs(void **state)
{
    test_subject s;
    test_subject_begin(&s);
    csg_scene_builder *b = &s.builder;
    csg_node_id inner = two(b, CSG_NODE_DIFFERENCE, SHARP, ball(b, 0.5, 0.2), ball(b, 0.4, 0.3));
    csg_node_id minus = two(b, CSG_NODE_UNION, SHARP, ball(b, 0.3, -0.5), inner);
    test_subject_compile(&s, two(b, CSG_NODE_DIFFERENCE, SHARP, ball(b, 1, 0), minus));
    const csg_tape *tape = &s.field->tape;
    static const uint8_t ops[] = {CSG_OP_OF(SPHERE), CSG_OP_OF(SPHERE), CSG_OP_OF(SPHERE),
                                  CSG_OP_OF(SPHERE), CSG_OP_UNION,      CSG_OP_INTERSECTION};
    static const uint8_t joins[] = {CSG_JOIN_NONE,  CSG_JOIN_INTERSECTION, CSG_JOIN_NONE,
                                    CSG_JOIN_UNION, CSG_JOIN_INTERSECTION, CSG_JOIN_NONE};
    static const float sigmas[] = {1, -1, -1, 1};
    static const uint32_t sizes[] = {1, 1, 1, 1, 3, 6};
    assert_int_equal(tape->count, 6);
    for (uint32_t i = 0; i < 6; i++) {
        assert_int_equal(tape->nodes[i].op, ops[i]);
        assert_int_equal(tape->nodes[i].join, joins[i]);
        assert_int_equal(tape->nodes[i].size, sizes[i]);
        if (i < 4)
            assert_true(sigma_of(tape, i) == sigmas[i]);
    }
    assert_int_equal(tape->nodes[4].arity, 2);
    assert_int_equal(tape->nodes[5].arity, 3);
    test_subject_end(&s);
}

/* A transform or a colour between sharp unions does not keep them apart; a blend does. */
static void test_flattening(void **state)
{
    for (int blended = 0; blended < 2; blended++) {
        test_subject s;
        test_subject_begin(&s);
        csg_scene_builder *b = &s.builder;
        csg_blend blend = blended ? (csg_blend){CSG_BLEND_PARABOLA, 0.4, false} : SHARP;
        csg_node_id inner = two(b, CSG_NODE_UNION, blend, ball(b, 1, 0), ball(b, 1, 1));
        csg_affine place = csg_affine_translate(csg_vec3_make(0, 2, 0));
        inner = csg_build_transform(b, &place, inner, NOWHERE);
        inner = csg_build_color(b, (csg_color){1, 0, 0, 1}, inner, NOWHERE);
        test_subject_compile(&s, two(b, CSG_NODE_UNION, SHARP, ball(b, 1, 3), inner));
        assert_int_equal(s.field->tape.count, blended ? 5 : 4);
        assert_int_equal(s.field->tape.nodes[s.field->tape.count - 1].arity, blended ? 2 : 3);
        assert_int_equal(s.field->color_count, 2);
        test_subject_end(&s);
    }
}

/* n of the tape's only operator. */
static double compiled_n(csg_blend blend, const csg_affine *place)
{
    test_subject s;
    test_subject_begin(&s);
    csg_scene_builder *b = &s.builder;
    csg_node_id both = two(b, CSG_NODE_UNION, blend, ball(b, 1, 0), ball(b, 1, 1));
    test_subject_compile(&s, csg_build_transform(b, place, both, NOWHERE));
    const csg_tape *tape = &s.field->tape;
    uint32_t at = tape->nodes[tape->count - 1].parameters;
    double n = (double)tape->parameters[at + CSG_OPERATOR_N];
    double chi = (double)tape->parameters[at + CSG_OPERATOR_SUPPORT];
    double expected = csg_blend_support((csg_blend){blend.kind, n, false});
    assert_true(chi == expected || fabs(chi - expected) <= 1e-6 * expected);
    test_subject_end(&s);
    return n;
}

/* Lengths grow with the scale, areas with its square; unequal scales count with the smallest. */
static void test_scaled_blends(void **state)
{
    csg_affine twice = csg_affine_scale(csg_vec3_make(2, 2, 2));
    csg_affine unequal = csg_affine_scale(csg_vec3_make(2, 0.5, 3));
    test_near(compiled_n((csg_blend){CSG_BLEND_HYPERBOLA, 0.01, false}, &twice), 0.04, 1e-8);
    test_near(compiled_n((csg_blend){CSG_BLEND_RECIPROCAL, 0.01, false}, &unequal), 0.0025, 1e-9);
    test_near(compiled_n((csg_blend){CSG_BLEND_ROUND, 0.1, false}, &twice), 0.2, 1e-7);
    test_near(compiled_n((csg_blend){CSG_BLEND_CHAMFER, 0.1, false}, &unequal), 0.05, 1e-8);
}

static void test_depths(void **state)
{
    static const struct {
        csg_blend_kind blend;
        uint32_t operands, depth;
    } rows[] = {{CSG_BLEND_SHARP, 1, 1},     {CSG_BLEND_SHARP, 2, 2}, {CSG_BLEND_SHARP, 500, 2},
                {CSG_BLEND_PARABOLA, 50, 2}, {CSG_BLEND_ROUND, 2, 2}, {CSG_BLEND_ROUND, 9, 9}};
    for (size_t r = 0; r < sizeof rows / sizeof *rows; r++) {
        test_subject s;
        csg_node_id nodes[500];
        test_subject_begin(&s);
        for (uint32_t i = 0; i < rows[r].operands; i++)
            nodes[i] = ball(&s.builder, 1, i);
        csg_blend blend = {rows[r].blend, rows[r].blend == CSG_BLEND_SHARP ? 0 : 0.1, false};
        test_subject_compile(&s, csg_build_operator(&s.builder, CSG_NODE_UNION, blend, nodes,
                                                    rows[r].operands, NOWHERE));
        assert_int_equal(csg_tape_depth(&s.field->tape), rows[r].depth);
        assert_int_equal(s.field->depth, rows[r].depth);
        assert_int_equal(s.field->primitive_count, rows[r].operands);
        test_subject_end(&s);
    }
}

/* Blends of blends of blends, to the right: a slot per level, no recursion. */
static void test_deep(void **state)
{
    enum { LEVELS = 20000 };
    test_subject s;
    test_subject_begin(&s);
    csg_scene_builder *b = &s.builder;
    csg_node_id node = ball(b, 1, 0);
    for (int i = 1; i < LEVELS; i++)
        node = two(b, i % 2 ? CSG_NODE_UNION : CSG_NODE_DIFFERENCE,
                   (csg_blend){CSG_BLEND_PARABOLA, 1e-4, false}, ball(b, 1, 1e-4 * i), node);
    test_subject_compile(&s, node);
    assert_int_equal(s.field->tape.count, 2 * LEVELS - 1);
    assert_int_equal(s.field->depth, LEVELS);
    float x = 0.3f, y = 0.2f, z = 0.1f, f;
    csg_field_eval(s.field, &x, &y, &z, &f, 1);
    double expected = test_sample(s.scene, csg_vec3_make((double)x, (double)y, (double)z)).value;
    test_near((double)f, expected, 1e-4);
    test_subject_end(&s);
}

/* ---- values ---------------------------------------------------------------------------------- */

static void test_random_scenes(void **state)
{
    csg_random random = {31};
    for (unsigned i = 0; i < 150; i++) {
        enum { COUNT = 150 }; /* more than one batch of csg_field_eval */
        float x[COUNT], y[COUNT], z[COUNT], f[COUNT];
        test_subject s;
        test_random_shapes = i % 2;
        test_subject_begin(&s);
        test_subject_compile(&s, test_random_scene(&s.builder, &random, 1 + i * 11 % 60));
        for (int k = 0; k < COUNT; k++) {
            csg_vec3 p = test_point(&random, k % 3 ? 1.5 : 4);
            x[k] = (float)p.x, y[k] = (float)p.y, z[k] = (float)p.z;
        }
        csg_field_eval(s.field, x, y, z, f, COUNT);
        for (int k = 0; k < COUNT; k++) {
            csg_vec3 p = {(double)x[k], (double)y[k], (double)z[k]};
            double expected = test_sample(s.scene, p).value;
            if (!(fabs((double)f[k] - expected) <= 1e-5 * 4))
                fail_msg("scene %u: %.9g at (%g %g %g), not %.9g", i, (double)f[k], p.x, p.y, p.z,
                         expected);
        }
        test_subject_end(&s);
    }
}

static void test_empty(void **state)
{
    test_subject s;
    test_subject_begin(&s);
    test_subject_compile(&s, csg_build_empty(&s.builder, NOWHERE));
    float zero = 0, f = 1;
    csg_field_eval(s.field, &zero, &zero, &zero, &f, 1);
    assert_true(isinf(f) && f < 0);
    csg_field_eval(s.field, &zero, &zero, &zero, &f, 0);
    test_subject_end(&s);
}

/* ---- clipping -------------------------------------------------------------------------------- */

static void check_clip(csg_random *random, unsigned primitives)
{
    enum { COUNT = 100 };
    float x[COUNT], y[COUNT], z[COUNT], whole[COUNT], cut[COUNT];
    test_subject s;
    test_subject_begin(&s);
    test_subject_compile(&s, test_random_scene(&s.builder, random, primitives));
    csg_box box = {{-0.7, -0.5, -0.9}, {0.4, 0.6, 0.3}};
    csgm_field *clipped;
    assert_int_equal(csg_field_clip(&s.context, s.field, box, &clipped), CSGM_OK);
    assert_true(csg_box_contains_box(csg_box_grow(box, 1e-12), clipped->bounds));
    assert_int_equal(clipped->tape.count, s.field->tape.count + 2);
    assert_int_equal(csg_tape_depth(&clipped->tape), clipped->depth);
    for (int k = 0; k < COUNT; k++) {
        csg_vec3 p = test_point(random, 1.2);
        x[k] = (float)p.x, y[k] = (float)p.y, z[k] = (float)p.z;
    }
    csg_field_eval(s.field, x, y, z, whole, COUNT);
    csg_field_eval(clipped, x, y, z, cut, COUNT);
    for (int k = 0; k < COUNT; k++) {
        csg_vec3 p = {(double)x[k], (double)y[k], (double)z[k]};
        csg_vec3 half = csg_vec3_scale(csg_box_size(box), 0.5);
        double of_box = csg_reference_primitive(CSG_NODE_BOX, (double[]){half.x, half.y, half.z, 0},
                                                csg_vec3_sub(p, csg_box_center(box)))
                            .value;
        test_near((double)cut[k], fmin((double)whole[k], of_box), 4e-6);
    }
    csg_field_destroy(clipped);
    test_subject_end(&s);
}

static void test_clip(void **state)
{
    csg_random random = {32};
    for (unsigned i = 0; i < 40; i++)
        check_clip(&random, 1 + i % 8);
}

/* ---- printing and memory ------------------------------------------------------------------------
 */

typedef struct text {
    char data[4096];
    size_t length;
} text;

static void collect(void *user, const char *piece, size_t length)
{
    text *t = user;
    assert_true(t->length + length < sizeof t->data);
    memcpy(t->data + t->length, piece, length);
    t->length += length;
    t->data[t->length] = '\0';
}

/* One line per node, and the same text each time. */
static void test_print(void **state)
{
    test_subject s;
    test_subject_begin(&s);
    csg_scene_builder *b = &s.builder;
    csg_node_id both = two(b, CSG_NODE_DIFFERENCE, (csg_blend){CSG_BLEND_ROUND, 0.1, false},
                           ball(b, 1, 0), ball(b, 1, 1));
    test_subject_compile(&s, both);
    text first = {.length = 0}, second = {.length = 0};
    assert_int_equal(csg_field_print_tape(s.field, collect, &first), CSGM_OK);
    assert_int_equal(csg_field_print_tape(s.field, collect, &second), CSGM_OK);
    assert_string_equal(first.data, second.data);
    size_t sphere_lines = 0;
    for (const char *at = first.data; (at = strstr(at, "sphere")); at++)
        sphere_lines++;
    assert_int_equal(sphere_lines, 2);
    assert_non_null(strstr(first.data, "round"));
    test_subject_end(&s);
}

typedef struct failing {
    long calls, fail_at;
} failing;

static void *failing_alloc(void *user, size_t size_bytes)
{
    failing *f = user;
    return ++f->calls == f->fail_at ? NULL : malloc(size_bytes);
}

static void failing_release(void *user, void *memory, size_t size_bytes)
{
    free(memory);
}

static void test_each_allocation(void **state)
{
    csg_random random = {33};
    test_subject s;
    test_subject_begin(&s);
    test_subject_compile(&s, test_random_scene(&s.builder, &random, 60));
    uint64_t before = atomic_load(&s.context.memory.used_bytes);
    csg_box box = {{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}};
    csgm_allocator original = s.context.memory.allocator;
    failing f = {0};
    s.context.memory.allocator = (csgm_allocator){failing_alloc, failing_release, &f};
    long n = 1;
    for (bool done = false; !done; n++) {
        f = (failing){.fail_at = n};
        csgm_field *field = NULL, *clipped = NULL;
        csgm_status status = csg_field_compile(&s.context, s.scene, &field);
        if (status == CSGM_OK)
            status = csg_field_clip(&s.context, field, box, &clipped);
        done = f.calls < n;
        assert_int_equal(status, done ? CSGM_OK : CSGM_ERR_MEMORY);
        csg_field_destroy(clipped);
        csg_field_destroy(field);
        assert_int_equal(atomic_load(&s.context.memory.used_bytes), before);
    }
    assert_true(n > 8);
    float x = 0, value = 0;
    f = (failing){.fail_at = 1};
    s.context.memory.allocator = (csgm_allocator){failing_alloc, failing_release, &f};
    csg_field_eval(s.field, &x, &x, &x, &value, 1);
    assert_true(isnan(value)); /* no room is no number */
    s.context.memory.allocator = original;
    test_subject_end(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_signs),         cmocka_unit_test(test_flattening),
        cmocka_unit_test(test_scaled_blends), cmocka_unit_test(test_depths),
        cmocka_unit_test(test_deep),          cmocka_unit_test(test_random_scenes),
        cmocka_unit_test(test_empty),         cmocka_unit_test(test_clip),
        cmocka_unit_test(test_print),         cmocka_unit_test(test_each_allocation),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
