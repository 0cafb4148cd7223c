/* SPDX-License-Identifier: MIT
 * Outlines of flat figures against their fields: what the field calls inside, the outline goes
 * around once, for polygons up to the tolerance and for what is traced up to a cell; areas;
 * trouble. Figures of straight edges that become one outline: the same figure, a true distance.
 */
#include "scene_support.h"

#include <limits.h>
#include <stdlib.h>

#include "failing.h"
#include "rounds.h"
#include "scene/outlines/flatten.h"
#include "scene/outlines/unite.h"
#include "scene/primitives/kinds.h"
#include "scene/tree/figures.h"
#include "scene/warp_kinds.h"
#include "shape/plane/polygons.h"
#include "shape/plane/region.h"

static csgm_context context;
static csg_scene_builder builder;
static csg_outline outline;
static csg_random dice;

static int begin(void **state)
{
    test_context_init(&context);
    csg_outline_init(&outline, &context.memory);
    dice.state = 23;
    return csg_build_begin(&builder, &context) != CSGM_OK;
}

static int end(void **state)
{
    csg_outline_release(&outline);
    csg_build_abandon(&builder);
    test_context_end(&context);
    return 0;
}

/* ---- figures ------------------------------------------------------------------------------ */

static csg_node_id circle(double r)
{
    return csg_build_primitive(&builder, CSG_NODE_CIRCLE, &r, NOWHERE);
}

static csg_node_id rectangle(double x, double y, double round)
{
    return csg_build_primitive(&builder, CSG_NODE_RECTANGLE, (double[]){x, y, round}, NOWHERE);
}

static csg_node_id moved(double x, double y, csg_node_id child)
{
    csg_affine by = csg_affine_translate(csg_vec3_make(x, y, 0));
    return csg_build_transform(&builder, &by, child, NOWHERE);
}

static csg_node_id turned(double angle, csg_node_id child)
{
    csg_affine by = csg_affine_rotate(angle, csg_vec3_make(0, 0, 1));
    return csg_build_transform(&builder, &by, child, NOWHERE);
}

static csg_node_id operate(csg_node_kind kind, double width, csg_node_id a, csg_node_id b,
                           csg_node_id c)
{
    csg_blend blend = width > 0 ? csg_blend_round(width) : CSG_SHARP;
    return csg_build_operator(&builder, kind, blend, (csg_node_id[]){a, b, c},
                              c == CSG_NODE_NONE ? 2 : 3, NOWHERE);
}

static csg_node_id triangle_with_hole(void)
{
    const csg_vec2 points[7] = {{-2, -1}, {2, -1}, {0, 3}, {0, 0}, {-0.5, 1}, {0.5, 1}, {0, 0}};
    csg_outline loops;
    csg_shape *shape;
    csg_outline_init(&loops, &context.memory);
    for (int i = 0; i < 6; i++) {
        assert_true(csg_outline_add(&loops, points[i]));
        if (i % 3 == 2)
            assert_true(csg_outline_close(&loops));
    }
    assert_int_equal(csg_region_create(&context.memory, &loops, &shape), CSGM_OK);
    csg_outline_release(&loops);
    return csg_build_shape(&builder, shape, NOWHERE);
}

/* ---- checks ------------------------------------------------------------------------------- */

static int winding_of(csg_vec2 p)
{
    double turn = 0;
    for (size_t loop = 0, i = 0; loop < outline.loop_count; loop++) {
        size_t first = i;
        for (; i < outline.ends[loop]; i++) {
            csg_vec2 a = outline.points[i],
                     b = outline.points[i + 1 < outline.ends[loop] ? i + 1 : first];
            double ax = a.x - p.x, ay = a.y - p.y, bx = b.x - p.x, by = b.y - p.y;
            turn += atan2(ax * by - ay * bx, ax * bx + ay * by);
        }
    }
    return (int)lrint(turn / (2 * 3.14159265358979323846));
}

static double area(void)
{
    double sum = 0;
    for (size_t loop = 0, i = 0; loop < outline.loop_count; loop++) {
        size_t first = i;
        for (; i < outline.ends[loop]; i++) {
            csg_vec2 a = outline.points[i],
                     b = outline.points[i + 1 < outline.ends[loop] ? i + 1 : first];
            sum += 0.5 * (a.x * b.y - a.y * b.x);
        }
    }
    return sum;
}

/* The field's sign is the outline's wherever |f| > slack. */
static void check(csg_node_id node, double tolerance, double slack, double reach)
{
    csgm_scene *scene;
    csg_outline_release(&outline);
    assert_int_not_equal(node, CSG_NODE_NONE);
    assert_int_equal(csg_flatten(&builder, node, tolerance, &outline), CSGM_OK);
    assert_int_equal(csg_build_snapshot(&builder, node, &scene), CSGM_OK);
    for (int i = 0; i < 1000; i++) {
        csg_vec3 p = test_point(&dice, reach);
        double value = test_sample(scene, p).value;
        if (fabs(value) > slack)
            assert_int_equal(winding_of((csg_vec2){p.x, p.y}), value > 0);
    }
    csg_scene_destroy(scene);
}

/* ---- polygons ----------------------------------------------------------------------------- */

static void leaves(void **state)
{
    check(circle(2), 1e-3, 1.01e-3, 3);
    test_near(area(), 3.14159265358979 * 4, 0.02);
    assert_true(outline.point_count > 90 && outline.point_count < 110);
    check(rectangle(2, 1, 0), 1e-3, 1e-9, 3);
    assert_int_equal(outline.point_count, 4);
    assert_true(area() == 8);
    check(rectangle(2, 1, 0.5), 1e-3, 1.01e-3, 3);
    check(rectangle(1, 1, 1), 1e-3, 1.01e-3, 3);
    check(triangle_with_hole(), 1e-3, 1e-9, 3);
    assert_true(area() == 7.5);
}

static void placed_and_coloured(void **state)
{
    csg_affine mirrored = csg_affine_mirror(csg_vec3_make(1, 2, 0));
    csg_node_id node = csg_build_transform(&builder, &mirrored, triangle_with_hole(), NOWHERE);
    check(csg_build_color(&builder, (csg_color){1, 0, 0, 1}, node, NOWHERE), 1e-3, 1e-9, 4);
    test_near(area(), 7.5, 1e-12);
    csg_affine flat = csg_affine_multiply(csg_affine_rotate(30, csg_vec3_make(0, 0, 1)),
                                          csg_affine_scale(csg_vec3_make(3, 0.5, 1)));
    check(csg_build_transform(&builder, &flat, circle(1), NOWHERE), 1e-4, 1.01e-4, 4);
    test_near(area(), 3.14159265358979 * 1.5, 1e-3);
    assert_true(outline.point_count > 300); /* the tolerance is that of the placed circle */
}

static void nothing_is_empty(void **state)
{
    csg_node_id node = csg_build_empty(&builder, NOWHERE);
    assert_int_equal(csg_flatten(&builder, node, 0.1, &outline), CSGM_OK);
    assert_int_equal(outline.loop_count, 0);
}

/* ---- with the polygon library ------------------------------------------------------------- */

static bool has_polygons(void)
{
    csg_outline none;
    csg_outline_release(&outline);
    assert_int_equal(csg_flatten(&builder, circle(1), 0.1, &outline), CSGM_OK);
    csgm_status status = csg_polygons_clean(&outline, CSG_FILL_NONZERO, &none);
    csg_outline_release(&none);
    csg_outline_release(&outline);
    return status != CSGM_ERR_UNSUPPORTED;
}

static void sharp_operators_and_offsets(void **state)
{
    if (!has_polygons())
        skip();
    csg_node_id cross = operate(CSG_NODE_UNION, 0, rectangle(2, 0.5, 0),
                                turned(90, rectangle(2, 0.5, 0)), moved(1.5, 1.5, circle(0.5)));
    csg_node_id cut = operate(CSG_NODE_DIFFERENCE, 0, cross, moved(1.8, 0, circle(0.4)),
                              moved(-2, 0, rectangle(0.5, 3, 0)));
    check(operate(CSG_NODE_INTERSECTION, 0, cut, circle(2.2), rectangle(3, 1.9, 0.2)), 1e-4,
          1.01e-4, 3);
    check(csg_build_offset(&builder, 0.5, triangle_with_hole(), NOWHERE), 1e-4, 1.01e-4, 4);
    check(csg_build_offset(&builder, -0.2, triangle_with_hole(), NOWHERE), 1e-4, 1.01e-4, 4);
    check(csg_build_offset(&builder, -5, triangle_with_hole(), NOWHERE), 1e-4, 1.01e-4, 4);
    assert_int_equal(outline.loop_count, 0);
}

/* ---- united ------------------------------------------------------------------------------- */

static size_t nodes_below(csg_node_id node, unsigned kind)
{
    csgm_scene *scene;
    size_t count = 0;
    assert_int_equal(csg_build_snapshot(&builder, node, &scene), CSGM_OK);
    for (size_t i = 0; i < scene->node_count; i++)
        count += scene->nodes[i].kind == kind;
    csg_scene_destroy(scene);
    return count;
}

/* The same figure as before, told by the sign wherever |f| > slack of both. */
static csg_node_id united(csg_node_id node)
{
    csgm_scene *before, *after;
    assert_int_equal(csg_build_snapshot(&builder, node, &before), CSGM_OK);
    node = csg_unite(&builder, node);
    assert_int_not_equal(node, CSG_NODE_NONE);
    assert_int_equal(csg_build_snapshot(&builder, node, &after), CSGM_OK);
    for (int i = 0; i < 1000; i++) {
        csg_vec3 p = test_point(&dice, 5);
        double f = test_sample(before, p).value, g = test_sample(after, p).value;
        if (fabs(f) > 1e-7)
            assert_true((f > 0) == (g > 0));
        assert_true(fabs(g) >= fabs(f) - 1e-7); /* a true distance is never less */
    }
    csg_scene_destroy(before);
    csg_scene_destroy(after);
    return node;
}

static csg_node_id straight(int kind)
{
    csg_node_id leaf = kind % 3 ? rectangle(csg_random_uniform(&dice, 0.2, 2),
                                            csg_random_uniform(&dice, 0.2, 2), 0)
                                : triangle_with_hole();
    return moved(csg_random_uniform(&dice, -2, 2), csg_random_uniform(&dice, -2, 2),
                 turned(csg_random_uniform(&dice, 0, 360), leaf));
}

static void straight_figures_unite(void **state)
{
    if (!has_polygons())
        skip();
    static const csg_node_kind kinds[] = {CSG_NODE_UNION, CSG_NODE_DIFFERENCE,
                                          CSG_NODE_INTERSECTION};
    for (int round = 0; round < 60; round++) {
        /* of a kind, and one that is another figure: a curve, a colour, a blend */
        csg_node_id inner = operate(kinds[round % 2], 0, straight(round), straight(1), straight(2));
        csg_node_id mirrored = csg_build_transform(
            &builder, &(csg_affine){.m = {{-1, 0.2, 0}, {0, 1, 0}, {0, 0, 1}}}, inner, NOWHERE);
        csg_node_id all = operate(kinds[round / 2 % 2], 0, straight(0), mirrored, CSG_NODE_NONE);
        csg_node_id node = united(csg_build_color(&builder, (csg_color){1, 0, 0, 1}, all, NOWHERE));
        if (nodes_below(node, CSG_NODE_SHAPE) == 1) { /* else nothing is left of it */
            assert_int_equal(nodes_below(node, CSG_NODE_COLOR), 1);
            assert_int_equal(nodes_below(node, CSG_NODE_RECTANGLE), 0);
        }
        csg_node_id round_one = moved(0.5, 0, circle(1.5));
        csg_node_id operands[4] = {straight(0), straight(1), straight(2), straight(0)};
        int at = round % 4; /* also what a difference begins with */
        operands[at] = round_one;
        node =
            united(csg_build_operator(&builder, kinds[round % 3], CSG_SHARP, operands, 4, NOWHERE));
        assert_int_equal(nodes_below(node, CSG_NODE_CIRCLE), 1);
        if (nodes_below(node, CSG_NODE_RECTANGLE) == 0)
            assert_int_equal(nodes_below(node, CSG_NODE_SHAPE), 1);
    }
}

/* Blends see the fields that they saw; what is painted by itself stays so. */
static void others_stay(void **state)
{
    if (!has_polygons())
        skip();
    csg_node_id pair = operate(CSG_NODE_UNION, 0, straight(1), straight(2), CSG_NODE_NONE);
    csg_node_id blend = united(operate(CSG_NODE_UNION, 0.3, pair, straight(1), CSG_NODE_NONE));
    assert_int_equal(nodes_below(blend, CSG_NODE_RECTANGLE), 3);
    csg_node_id red = csg_build_color(&builder, (csg_color){1, 0, 0, 1}, straight(1), NOWHERE);
    csg_node_id two = united(operate(CSG_NODE_UNION, 0, red, straight(1), CSG_NODE_NONE));
    assert_int_equal(nodes_below(two, CSG_NODE_RECTANGLE), 2);
    csg_node_id round =
        united(operate(CSG_NODE_UNION, 0, rectangle(1, 1, 0.5), rectangle(1, 2, 0.1), straight(1)));
    assert_int_equal(nodes_below(round, CSG_NODE_RECTANGLE), 3);
    csg_node_id nothing = united(
        operate(CSG_NODE_DIFFERENCE, 0, rectangle(1, 1, 0), rectangle(2, 2, 0), CSG_NODE_NONE));
    assert_int_equal(nodes_below(nothing, CSG_NODE_RECTANGLE), 2);
    csg_node_id long_chain = rectangle(3, 3, 0);
    for (int i = 0; i < 3000; i++)
        long_chain = operate(CSG_NODE_DIFFERENCE, 0, long_chain,
                             moved(0.001 * i, 0, rectangle(0.0001, 0.1, 0)), CSG_NODE_NONE);
    assert_int_not_equal(csg_unite(&builder, long_chain), CSG_NODE_NONE);
}

/* ---- traced ------------------------------------------------------------------------------- */

static void blends_are_traced(void **state)
{
    csg_node_id blend = operate(CSG_NODE_UNION, 0.7, circle(1), moved(1.8, 0, circle(0.8)),
                                moved(0, -1.5, rectangle(1, 0.2, 0)));
    check(blend, 1e-3, 0.01, 4);
    assert_int_equal(outline.loop_count, 1);
    csg_node_id ring = operate(CSG_NODE_DIFFERENCE, 0.1, circle(2), circle(1), CSG_NODE_NONE);
    check(ring, 1e-3, 1e-4, 3); /* smooth: far better than a cell */
    assert_int_equal(outline.loop_count, 2);
}

static void slices_are_traced(void **state)
{
    const csg_warp slice = {.kind = CSG_WARP_SLICE};
    csg_affine place = csg_affine_multiply(csg_affine_translate(csg_vec3_make(0, 0, 0.1)),
                                           csg_affine_rotate(90, csg_vec3_make(1, 0, 0)));
    csg_node_id torus =
        csg_build_primitive(&builder, CSG_NODE_TORUS, (double[]){2, 0.5, 180}, NOWHERE);
    csg_node_id node = csg_build_transform(&builder, &place, torus, NOWHERE);
    node = csg_build_warp(&builder, &slice, node, NOWHERE);
    check(node, 1e-3, 1e-3, 4);
    assert_int_equal(outline.loop_count, 2);
    if (has_polygons())
        check(operate(CSG_NODE_UNION, 0, node, moved(0, 0.2, rectangle(2, 0.1, 0)), CSG_NODE_NONE),
              1e-3, 1e-3, 4);
}

/* Two saddles' worth of ways in one cell, and figures much smaller than a cell. */
static void traces_close_at_random(void **state)
{
    for (int round = 0; round < ROUNDS(6); round++) {
        csg_node_id nodes[40];
        for (int k = 0; k < 40; k++)
            nodes[k] = moved(csg_random_uniform(&dice, -3, 3), csg_random_uniform(&dice, -3, 3),
                             circle(csg_random_uniform(&dice, 0.001, 0.6)));
        csg_blend blend = csg_blend_round(0.01);
        check(csg_build_operator(&builder, CSG_NODE_UNION, blend, nodes, 40, NOWHERE), 1e-3, 0.015,
              4);
    }
}

/* ---- what was made before -------------------------------------------------------------------- */

/* Figures that differ in one thing each, but for the first two. */
enum { ALIKE = 9 };

static csg_node_id one_of(int which)
{
    csg_node_id hole = moved(which == 2 ? 0.4 : 0.5, 0, circle(which == 3 ? 0.6 : 0.5));
    csg_node_id grown = csg_build_offset(&builder, which == 4 ? 0.2 : 0.1,
                                         rectangle(2, 1, which == 5 ? 0.25 : 0), NOWHERE);
    csg_node_id shape = which == 6 ? rectangle(1, 1, 0) : triangle_with_hole();
    csg_node_id node =
        operate(which == 7 ? CSG_NODE_UNION : CSG_NODE_DIFFERENCE, 0, grown, hole, CSG_NODE_NONE);
    node = operate(CSG_NODE_UNION, 0, node, moved(3, 1, shape), CSG_NODE_NONE);
    return which == 8 ? node : turned(10, moved(which, 2, node));
}

static void flatten_in_new_builder(int which, double tolerance, csg_outline *out)
{
    csg_scene_builder kept = builder;
    assert_int_equal(csg_build_begin(&builder, &context), CSGM_OK);
    assert_int_equal(csg_flatten(&builder, one_of(which), tolerance, out), CSGM_OK);
    csg_build_abandon(&builder);
    builder = kept;
}

static void check_same(const csg_outline *a, const csg_outline *b)
{
    assert_int_equal(a->point_count, b->point_count);
    assert_int_equal(a->loop_count, b->loop_count);
    assert_memory_equal(a->points, b->points, a->point_count * sizeof *a->points);
    assert_memory_equal(a->ends, b->ends, a->loop_count * sizeof *a->ends);
}

/* Whatever was made before, an outline is what it is in a scene of its own, to the bit. */
static void outlines_that_were_made_before(void **state)
{
    if (!has_polygons())
        skip();
    for (int round = 0; round < 3; round++)
        for (int which = 0; which < ALIKE; which++) {
            csg_outline fresh;
            double tolerance = round == 1 ? 1e-2 : 1e-3;
            flatten_in_new_builder(which, tolerance, &fresh);
            assert_int_equal(csg_flatten(&builder, one_of(which), tolerance, &outline), CSGM_OK);
            check_same(&fresh, &outline);
            csg_outline_release(&fresh);
            csg_outline_release(&outline);
        }
}

static csg_shape *region_of(double x, bool is_split)
{
    const csg_vec2 points[6] = {{0, 0}, {x, 0}, {0, 1}, {5, 5}, {6, 5}, {5, 6}};
    csg_outline loops;
    csg_shape *region = NULL;
    csg_outline_init(&loops, &context.memory);
    for (int i = 0; i < 6; i++) {
        assert_true(csg_outline_add(&loops, points[i]));
        if ((is_split && i == 2) || i == 5)
            assert_true(csg_outline_close(&loops));
    }
    assert_int_equal(csg_figures_region(&builder.figures, &context.memory, &loops, &region),
                     CSGM_OK);
    csg_outline_release(&loops);
    assert_non_null(region);
    return region;
}

static void regions_that_were_made_before(void **state)
{
    csg_shape *a = region_of(1, true), *b = region_of(1, true), *c = region_of(2, true),
              *d = region_of(1, false);
    assert_ptr_equal(a, b);
    assert_ptr_not_equal(a, c);
    assert_ptr_not_equal(a, d);
    csg_shape_release(a);
    csg_shape_release(c);
    csg_shape_release(d);
    csg_build_abandon(&builder);
    assert_int_equal(csg_region_outline(b)->loop_count, 2); /* it outlives the builder */
    csg_shape_release(b);
    assert_int_equal(csg_build_begin(&builder, &context), CSGM_OK);
}

/* Until the context ends, which is after the test. */
static failing f;

/* From here on memory comes from f, all of it until f.left says otherwise. */
static void let_fail(void)
{
    f = (failing){LONG_MAX, 0};
    const csgm_allocator allocator = {failing_alloc, failing_release, &f};
    csg_build_abandon(&builder);
    csg_memory_init(&context.memory, &allocator, 0);
}

static void every_allocation_of_keeping_may_fail(void **state)
{
    if (!has_polygons())
        skip();
    let_fail();
    long n = 0;
    for (bool failed = true; failed; n++) {
        assert_int_equal(csg_build_begin(&builder, &context), CSGM_OK);
        csg_node_id node = one_of(0), other = one_of(0);
        f.left = n;
        csgm_status status = csg_flatten(&builder, node, 1e-3, &outline);
        csg_outline_release(&outline);
        csgm_status again = csg_flatten(&builder, other, 1e-3, &outline);
        failed = f.left < 0;
        f.left = LONG_MAX;
        assert_int_equal(status || again ? CSGM_ERR_MEMORY : CSGM_OK,
                         failed ? CSGM_ERR_MEMORY : CSGM_OK);
        csg_outline_release(&outline);
        csg_build_abandon(&builder);
        assert_int_equal(f.live, 0);
    }
    assert_true(n > 20);
    assert_int_equal(csg_build_begin(&builder, &context), CSGM_OK);
}

/* ---- trouble ------------------------------------------------------------------------------ */

static void solids_are_refused(void **state)
{
    csg_node_id ball = csg_build_primitive(&builder, CSG_NODE_SPHERE, (double[]){1}, NOWHERE);
    assert_int_equal(csg_flatten(&builder, ball, 0.1, &outline), CSGM_ERR_SCENE);
    assert_int_equal(csg_flatten(&builder, CSG_NODE_NONE, 0.1, &outline), CSGM_ERR_SCENE);
    const csg_warp slice = {.kind = CSG_WARP_SLICE};
    csg_node_id half =
        csg_build_primitive(&builder, CSG_NODE_PLANE, (double[]){1, 0, 0, 0}, NOWHERE);
    half = csg_build_warp(&builder, &slice, half, NOWHERE);
    assert_int_equal(csg_flatten(&builder, half, 0.1, &outline), CSGM_ERR_SCENE);
    assert_null(outline.points);
}

static void depth_is_no_matter(void **state)
{
    csg_node_id node = circle(1);
    for (int i = 0; i < 100000; i++) {
        /* a colour and a shear in turns do not fold */
        csg_affine shear = csg_affine_identity();
        shear.m[0][1] = i % 4 ? 1e-6 : -1e-6;
        node = csg_build_transform(&builder, &shear, node, NOWHERE);
        node = csg_build_color(&builder, (csg_color){1, 0, 0, 1}, node, NOWHERE);
    }
    assert_int_equal(csg_flatten(&builder, node, 1e-3, &outline), CSGM_OK);
    test_near(area(), 3.14159265358979, 0.01);
}

static void every_allocation_may_fail(void **state)
{
    bool has = has_polygons();
    let_fail();
    assert_int_equal(csg_build_begin(&builder, &context), CSGM_OK);
    csg_node_id node =
        operate(CSG_NODE_DIFFERENCE, 0.1, circle(2), moved(0, 1, circle(1)), CSG_NODE_NONE);
    if (has)
        node = operate(CSG_NODE_UNION, 0, node, moved(5, 0, triangle_with_hole()),
                       csg_build_offset(&builder, 1, rectangle(1, 2, 0), NOWHERE));
    long before = f.live, n = 0;
    for (csgm_status status = CSGM_ERR_MEMORY; status; n++) {
        f.left = n;
        status = csg_flatten(&builder, node, 1e-3, &outline);
        bool failed = f.left < 0;
        f.left = LONG_MAX;
        assert_int_equal(status, failed ? CSGM_ERR_MEMORY : CSGM_OK);
        csg_outline_release(&outline);
        assert_int_equal(f.live, before);
        builder.status = CSGM_OK; /* a snapshot notes its failure */
    }
    assert_true(n > 10);
}

static void every_allocation_of_uniting_may_fail(void **state)
{
    if (!has_polygons())
        skip();
    let_fail();
    long n = 0;
    for (bool failed = true; failed; n++) {
        assert_int_equal(csg_build_begin(&builder, &context), CSGM_OK);
        csg_node_id pair =
            operate(CSG_NODE_UNION, 0, rectangle(1, 2, 0), rectangle(2, 1, 0), CSG_NODE_NONE);
        csg_node_id node = operate(CSG_NODE_DIFFERENCE, 0, circle(4), pair, triangle_with_hole());
        f.left = n;
        node = csg_unite(&builder, node);
        failed = f.left < 0;
        f.left = LONG_MAX;
        assert_int_equal(node == CSG_NODE_NONE, failed);
        csg_build_abandon(&builder);
        assert_int_equal(f.live, 0);
    }
    assert_true(n > 10);
    assert_int_equal(csg_build_begin(&builder, &context), CSGM_OK);
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, begin, end)
    const struct CMUnitTest tests[] = {
        TEST(leaves),
        TEST(placed_and_coloured),
        TEST(nothing_is_empty),
        TEST(sharp_operators_and_offsets),
        TEST(blends_are_traced),
        TEST(slices_are_traced),
        TEST(traces_close_at_random),
        TEST(outlines_that_were_made_before),
        TEST(regions_that_were_made_before),
        TEST(every_allocation_of_keeping_may_fail),
        TEST(solids_are_refused),
        TEST(depth_is_no_matter),
        TEST(every_allocation_may_fail),
        TEST(straight_figures_unite),
        TEST(others_stay),
        TEST(every_allocation_of_uniting_may_fail),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
