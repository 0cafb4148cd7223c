/* SPDX-License-Identifier: MIT
 * golden.csv: blend functions, binary operators, sphere sweeps (polylines, Bezier curves and
 * B-splines among them), half-space, box, cylinder and the round n-ary union, computed with 40
 * digits (a table's name, then its columns). The primitives are built, placed and evaluated as
 * scenes.
 */
#include "golden_rows.h"
#include "scene/operators/blend_kinds.h"
#include "scene/primitives/kinds.h"

static const double tolerance = 1e-12;

/* Blend function k of the papers. */
static csg_blend_kind blend_of(const char *k)
{
    static const csg_blend_kind functions[] = {CSG_BLEND_HYPERBOLA, CSG_BLEND_RECIPROCAL,
                                               CSG_BLEND_OVERBLEND, CSG_BLEND_COSINE,
                                               CSG_BLEND_PARABOLA,  CSG_BLEND_CHAMFER};
    return functions[atoi(k) - 1];
}

static void check_function(const row *r)
{
    double value, derivative;
    csg_blend blend = {blend_of(r->fields[1]), number(r->fields[3]), false};
    csg_reference_blend_function(blend, number(r->fields[2]), &value, &derivative);
    test_near(value, number(r->fields[4]), tolerance);
    test_near(derivative, number(r->fields[5]), tolerance);
}

static void test_blend_functions(void **state)
{
    for_each("fb", 48, check_function);
}

static void check_operator(const row *r)
{
    char kind = r->fields[1][0];
    csg_blend blend = {blend_of(r->fields[2]), number(r->fields[5]), false};
    double first = kind == 'U' ? 1 : -1, second = kind == 'I' ? -1 : 1, outer = first;
    double values[2] = {first * number(r->fields[3]), second * number(r->fields[4])}, partials[2];
    double value = outer * csg_reference_union(blend, values, 2, partials);
    test_near(value, number(r->fields[6]), tolerance);
    test_near(outer * first * partials[0], number(r->fields[7]), tolerance);
    test_near(outer * second * partials[1], number(r->fields[8]), tolerance);
}

static void test_operators(void **state)
{
    for_each("dekkers", 54, check_operator);
}

static void check_round(const row *r)
{
    double values[8], expected[8], partials[8];
    int count = split_numbers(r->fields[2], values);
    csg_blend blend = {CSG_BLEND_ROUND, number(r->fields[1]), false};
    test_near(csg_reference_union(blend, values, (size_t)count, partials), number(r->fields[3]),
              tolerance);
    assert_int_equal(split_numbers(r->fields[4], expected), count);
    for (int i = 0; i < count; i++)
        test_near(partials[i], expected[i], tolerance);
}

static void test_round(void **state)
{
    for_each("round", 10, check_round);
}

/* "quadratic Bezier (x,y,z)(x,y,z)(x,y,z)" or cubic, four points. */
static csg_node_id build_curve(csg_scene_builder *builder, const char *text, double radius)
{
    csg_primitive_kind kind = *text == 'q' ? CSG_NODE_QUADRATIC_TUBE : CSG_NODE_CUBIC_TUBE;
    double v[16];
    int points = kind == CSG_NODE_QUADRATIC_TUBE ? 3 : 4;
    for (int i = 0; i < points; i++) {
        text = strchr(text + 1, '(');
        assert_int_equal(sscanf(text, "(%lf,%lf,%lf)", &v[4 * i], &v[4 * i + 1], &v[4 * i + 2]), 3);
        v[4 * i + 3] = radius;
    }
    assert_null(strchr(text + 1, '('));
    return csg_build_primitive(builder, kind, v, NOWHERE);
}

/* Quadratic tube through a, towards b, to c. */
static csg_node_id build_bend(csg_scene_builder *builder, csg_vec3 a, csg_vec3 b, csg_vec3 c,
                              double r)
{
    const double v[] = {a.x, a.y, a.z, r, b.x, b.y, b.z, r, c.x, c.y, c.z, r};
    return csg_build_primitive(builder, CSG_NODE_QUADRATIC_TUBE, v, NOWHERE);
}

/* The rows of polylines and of B-splines have the same four control points. */
static csg_node_id build_chain(csg_scene_builder *builder, bool curved, double r)
{
    static const csg_vec3 p[] = {{-1, 0, 0}, {0, 1, 0.2}, {0.8, -0.3, 0.1}, {1.2, 0.4, -0.6}};
    const csg_vec3 middle = csg_vec3_scale(csg_vec3_add(p[1], p[2]), 0.5);
    csg_node_id links[3];
    size_t count = 0;
    if (curved) { /* operators.md, section 1.1: clamped ends, pieces join in the middles */
        links[count++] = build_bend(builder, p[0], p[1], middle, r);
        links[count++] = build_bend(builder, middle, p[2], p[3], r);
    } else {
        for (; count < 3; count++)
            links[count] = csg_build_capsule(builder, p[count], p[count + 1], r, r, NOWHERE);
    }
    return csg_build_operator(builder, CSG_NODE_UNION, (csg_blend){0}, links, count, NOWHERE);
}

static csg_node_id build(csg_scene_builder *builder, const char *text, const char *radius)
{
    csg_vec3 a, b, h;
    double r = radius ? number(radius) : 0, big;
    csg_node_id node;
    csg_affine place = csg_affine_identity();
    if (strstr(text, "Bezier"))
        return build_curve(builder, text, r);
    if (strcmp(text, "polyline (-1,0,0)(0,1,0.2)(0.8,-0.3,0.1)(1.2,0.4,-0.6)") == 0)
        return build_chain(builder, false, r);
    if (strncmp(text, "quadratic B-spline, clamped ends", 32) == 0)
        return build_chain(builder, true, r);
    if (sscanf(text, "sphere m=(%lf,%lf,%lf)", &a.x, &a.y, &a.z) == 3) {
        node = csg_build_primitive(builder, CSG_NODE_SPHERE, &r, NOWHERE);
    } else if (sscanf(text, "capsule m1=(%lf,%lf,%lf) m2=(%lf,%lf,%lf)", &a.x, &a.y, &a.z, &b.x,
                      &b.y, &b.z) == 6) {
        return csg_build_capsule(builder, a, b, r, r, NOWHERE);
    } else if (sscanf(text, "torus m=(%lf,%lf,%lf) axis=(%lf,%lf,%lf) R=%lf", &a.x, &a.y, &a.z,
                      &b.x, &b.y, &b.z, &big) == 7) {
        node = csg_build_primitive(builder, CSG_NODE_TORUS, (double[]){big, r, 180}, NOWHERE);
        place = csg_affine_z_to(b);
    } else if (sscanf(text, "half-space c=(%lf,%lf,%lf) n=(%lf,%lf,%lf)", &a.x, &a.y, &a.z, &b.x,
                      &b.y, &b.z) == 6) {
        return csg_build_primitive(builder, CSG_NODE_PLANE,
                                   (double[]){b.x, b.y, b.z, csg_vec3_dot(a, b)}, NOWHERE);
    } else if (sscanf(text, "box c=(%lf,%lf,%lf) h=(%lf,%lf,%lf)", &a.x, &a.y, &a.z, &h.x, &h.y,
                      &h.z) == 6) {
        node = csg_build_primitive(builder, CSG_NODE_BOX, (double[]){h.x, h.y, h.z, 0}, NOWHERE);
    } else {
        assert_string_equal(text, "cylinder (0,0,-0.5)-(0,0,0.5) r=0.4");
        a = csg_vec3_make(0, 0, 0);
        node =
            csg_build_primitive(builder, CSG_NODE_FRUSTUM, (double[]){0.4, 0.4, 0.5, 0}, NOWHERE);
    }
    place.t[0] = a.x;
    place.t[1] = a.y;
    place.t[2] = a.z;
    return csg_build_transform(builder, &place, node, NOWHERE);
}

static void check_solid(const char *text, const char *radius, const char *at, const char *value,
                        const char *gradient)
{
    csgm_context context;
    csg_scene_builder builder;
    test_context_init(&context);
    assert_int_equal(csg_build_begin(&builder, &context), CSGM_OK);
    csgm_scene *scene = test_seal(&builder, build(&builder, text, radius));
    csg_sample sample = test_sample(scene, point(at));
    test_near(sample.value, number(value), tolerance);
    test_near_vec3(sample.gradient, point(gradient), tolerance);
    csg_scene_destroy(scene);
    test_context_end(&context);
}

static void check_sweep(const row *r)
{
    check_solid(r->fields[1], r->fields[2], r->fields[3], r->fields[4], r->fields[5]);
}

static void test_sweeps(void **state)
{
    for_each("prims", 56, check_sweep);
}

static void check_exact(const row *r)
{
    check_solid(r->fields[1], NULL, r->fields[2], r->fields[3], r->fields[4]);
}

static void test_exact(void **state)
{
    for_each("exact", 24, check_exact);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_blend_functions), cmocka_unit_test(test_operators),
        cmocka_unit_test(test_round),           cmocka_unit_test(test_sweeps),
        cmocka_unit_test(test_exact),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
