/* SPDX-License-Identifier: MIT
 * What pruning promises, on random scenes and random cells, and on pairs of operands built to sit
 * exactly on the threshold of dropping one:
 *   intervals  contain the value, in float and in double, of every point of the cube
 *   states     OUTSIDE and INSIDE are true of every point
 *   shorter    tapes give the same bits where |f| <= tau (values, gradients, colours), and the same
 *              sign elsewhere; also when they are shortened again in smaller and smaller cells
 */
#include <stdio.h>
#include <string.h>

#include "field/prune_support.h"
#include "scene/operators/blend_kinds.h"
#include "scene/primitives/kinds.h"
#include "scene/random_blend.h"

/* Ways down from random cubes around places up to `spread` from the middle, in a subject that is
 * begun and has this root; adds what was seen to the totals. */
static void walk_through(walk *w, csg_node_id root, csg_random *random, double spread, double most,
                         const char *what, walk *totals)
{
    test_subject_compile(&w->subject, root);
    walk_begin(w, 2 * spread + 1);
    for (int turn = 0; turn < 3; turn++) {
        cube at = {test_point(random, spread), csg_random_uniform(random, 0.05, most)};
        double tau = at.half * pow(2, -csg_random_uniform(random, 1, 8)) + 2 * w->rounding;
        descend(w, random, at, tau, what);
    }
    totals->cells += w->cells, totals->outside += w->outside, totals->inside += w->inside;
    totals->shortened += w->shortened, totals->in_band += w->in_band;
    walk_end(w);
}

static void test_random_scenes(void **state)
{
    walk totals = {0};
    csg_random random = {test_first_seed + 21};
    for (unsigned i = 0; i < ROUNDS(150) * test_times; i++) {
        walk w = {0};
        char what[48];
        snprintf(what, sizeof what, "random scene %u", i);
        test_random_shapes = i % 2;
        test_random_curves = i % 5 == 3;
        test_subject_begin(&w.subject);
        csg_node_id root = test_random_scene(&w.subject.builder, &random, 1 + i * 7 % 50);
        walk_through(&w, root, &random, 1, 1.5, what, &totals);
    }
    /* Enough of everything was seen for the checks to mean something. */
    assert_true(totals.cells > ROUNDS(3000) && totals.outside > ROUNDS(300) &&
                totals.inside > ROUNDS(100));
    assert_true(totals.shortened > ROUNDS(400) && totals.in_band > ROUNDS(10000));
}

/* Outlines of many segments, extruded, turned about an axis, below warps: only those segments that
 * can be nearest are asked. */
static void test_outlines(void **state)
{
    walk totals = {0};
    csg_random random = {test_first_seed + 27};
    test_random_outlines = true;
    for (unsigned i = 0; i < ROUNDS(200) * test_times; i++) {
        walk w = {0};
        char what[48];
        snprintf(what, sizeof what, "outline %u", i);
        test_subject_begin(&w.subject);
        csg_node_id root = test_random_shaped(&w.subject.builder, &random);
        walk_through(&w, root, &random, 0.5, 0.8, what, &totals);
    }
    test_random_outlines = false;
    assert_true(totals.cells > ROUNDS(2000) && totals.shortened > ROUNDS(300) &&
                totals.in_band > ROUNDS(4000));
}

/* Extrusions that an offset has made larger: beside their edges the distance to the figure matters
 * however far within the band's other side it is. Figures are what two turned squares share. */
static void test_raised_extrusions(void **state)
{
    walk totals = {0};
    csg_random random = {test_first_seed + 29};
    for (unsigned i = 0; i < ROUNDS(300) * test_times; i++) {
        walk w = {0};
        char what[48];
        csg_node_id squares[2];
        snprintf(what, sizeof what, "raised extrusion %u", i);
        test_subject_begin(&w.subject);
        csg_scene_builder *builder = &w.subject.builder;
        for (int k = 0; k < 2; k++) {
            csg_affine turn =
                csg_affine_rotate(csg_random_uniform(&random, -180, 180), csg_vec3_make(0, 0, 1));
            turn.t[0] = csg_random_uniform(&random, -0.2, 0.2);
            squares[k] =
                csg_build_primitive(builder, CSG_NODE_RECTANGLE, (double[]){0.2, 0.2, 0}, NOWHERE);
            squares[k] = csg_build_transform(builder, &turn, squares[k], NOWHERE);
        }
        csg_node_id root =
            csg_build_operator(builder, CSG_NODE_INTERSECTION, CSG_SHARP, squares, 2, NOWHERE);
        root = csg_build_extrude(builder, root, -0.2, 0.2, NOWHERE);
        root = csg_build_offset(builder, csg_random_uniform(&random, 0.1, 0.2), root, NOWHERE);
        walk_through(&w, root, &random, 0.5, 0.3, what, &totals);
    }
    assert_true(totals.cells > ROUNDS(2000) && totals.shortened > ROUNDS(300) &&
                totals.in_band > ROUNDS(4000));
}

/* Trees of fillets, whose values depend on gradients and may jump. */
static void test_random_fillet_scenes(void **state)
{
    walk totals = {0};
    csg_random random = {test_first_seed + 23};
    test_random_fillets = true;
    for (unsigned i = 0; i < ROUNDS(150) * test_times; i++) {
        walk w = {0};
        char what[48];
        snprintf(what, sizeof what, "random fillets %u", i);
        test_random_shapes = i % 3 == 1;
        test_random_curves = i % 5 == 3;
        test_random_rules = i % 4 == 2;
        test_subject_begin(&w.subject);
        csg_node_id root = test_random_scene(&w.subject.builder, &random, 2 + i * 7 % 20);
        walk_through(&w, root, &random, 1, 1.5, what, &totals);
    }
    test_random_fillets = test_random_shapes = test_random_curves = test_random_rules = false;
    assert_true(totals.cells > ROUNDS(3000) && totals.shortened > ROUNDS(400) &&
                totals.in_band > ROUNDS(10000));
}

/* A cross of two bars, or two blocks with a gap between them; a ball in the middle of the first,
 * never within 2 r of it, asks for the evaluation of any number of operands. Both are equal to the
 * last bit on diagonal planes, or in the middle of the gap, where they face each other. */
static void two_blocks(test_subject *s, csg_node_kind how, double apart, unsigned count)
{
    static const double bars[2][4] = {{1, 0.6, 0.6, 0}, {0.6, 1, 0.6, 0}};
    static const double block[4] = {0.6, 0.6, 0.6, 0};
    csg_node_id nodes[3];
    test_subject_begin(s);
    csg_scene_builder *builder = &s->builder;
    for (unsigned k = 0; k < count; k++) {
        csg_color color = {(float)k * 0.5f, 0.5f, 1, 1};
        csg_affine place = csg_affine_translate(csg_vec3_make(k == 1 ? apart : -apart, 0, 0));
        csg_node_id node =
            k == 2
                ? csg_build_primitive(builder, CSG_NODE_SPHERE, (double[]){0.1}, NOWHERE)
                : csg_build_primitive(builder, CSG_NODE_BOX, apart > 0 ? block : bars[k], NOWHERE);
        nodes[k] = csg_build_color(builder, color,
                                   csg_build_transform(builder, &place, node, NOWHERE), NOWHERE);
    }
    csg_blend blend = {CSG_BLEND_FILLET, 0.2, false};
    test_subject_compile(s, csg_build_operator(builder, how, blend, nodes, count, NOWHERE));
}

/* Two operands are evaluated on their own; more of them, in another way, have the same bits. */
static void test_pairs_of_fillets(void **state)
{
    static test_points points;
    static test_results pair, three;
    csg_random random = {test_first_seed + 24};
    for (unsigned i = 0; i < ROUNDS(60) * test_times; i++) {
        test_subject s[2];
        csg_node_kind how = i % 3 ? CSG_NODE_UNION : CSG_NODE_DIFFERENCE;
        double apart = i % 3 == 2 ? 0.7 : 0;
        for (unsigned k = 0; k < 2; k++)
            two_blocks(&s[k], how, apart, 2 + k);
        test_points_clear(&points);
        while (points.count < 256) {
            csg_vec3 p = test_point(&random, how == CSG_NODE_UNION ? 1.3 : 0.2);
            bool equal = points.count % 3 == 0;
            p.y = equal && apart == 0 ? copysign(p.x, p.y) : p.y;
            p.x = equal && apart > 0 ? 0 : p.x;
            if (how == CSG_NODE_DIFFERENCE) /* where the first bar is not in the second */
                p.x += copysign(0.8, p.x);
            test_points_add(&points, p);
        }
        const csg_kernel *kernel = csg_kernel_for(csg_cpu_best_isa(CSGM_ISA_AUTO));
        test_evaluate(kernel, &s[0].field->tape, &points, &pair);
        test_evaluate(kernel, &s[1].field->tape, &points, &three);
        test_same_bits(&pair, &three, points.count, false, csg_node_kind_name(how));
        test_subject_end(&s[0]);
        test_subject_end(&s[1]);
    }
}

/* Balls that a plane cuts off with a rounded rim, in a blend that ends at a plane itself: `lower`
 * than theirs, or at theirs. */
static csg_node_id cut_balls(csg_scene_builder *b, csg_random *random, double lower)
{
    const csg_blend sharp = {0}, soft = {CSG_BLEND_ROUND, 0.3, false};
    const csg_vec3 up = {0, 0, 1};
    csg_node_id balls[3], both[2];
    for (int i = 0; i < 3; i++) {
        csg_affine place = csg_affine_translate(
            csg_vec3_make(1.2 * i - 1.2, csg_random_uniform(random, -0.2, 0.2), 0));
        both[0] = csg_build_transform(b, &place, csg_build_ball(b, 0.7, NOWHERE), NOWHERE);
        both[1] = csg_build_half_space(b, up, 0.4, NOWHERE);
        balls[i] = csg_build_operator(b, CSG_NODE_INTERSECTION, soft, both, 2, NOWHERE);
    }
    both[0] = csg_build_operator(b, CSG_NODE_UNION, soft, balls, 3, NOWHERE);
    both[1] = csg_build_half_space(b, up, 0.4 - lower, NOWHERE);
    return csg_build_operator(b, CSG_NODE_INTERSECTION, sharp, both, 2, NOWHERE);
}

/* Where one ball is left that ends at the plane anyhow, the plane at which the blend ends is not
 * asked; one that is lower is. */
static void test_ends_of_blends(void **state)
{
    for (int k = 0; k < 4; k++) {
        csg_random random = {test_first_seed + 28};
        walk w = {0};
        test_subject_begin(&w.subject);
        csg_node_id root = cut_balls(&w.subject.builder, &random, k < 2 ? 0 : 0.01);
        if (k % 2) { /* turned around */
            csg_node_id both[] = {csg_build_ball(&w.subject.builder, 5, NOWHERE), root};
            root = csg_build_operator(&w.subject.builder, CSG_NODE_DIFFERENCE, (csg_blend){0}, both,
                                      2, NOWHERE);
        }
        test_subject_compile(&w.subject, root);
        walk_begin(&w, 4);
        csg_vec3 c = csg_vec3_sub(csg_vec3_make(1.2, 0, 0.39), w.subject.field->center);
        const cube at = {c, 0.05};
        csg_tape tape;
        prune_children(&w, &w.subject.field->tape, at);
        assert_true(csg_prune_shorten(&w.pruner, 7, 0.1f, &w.arena, &tape));
        assert_int_equal(tape.count, k < 2 ? 3 : 5);
        for (int i = 0; i < 20; i++)
            descend(&w, &random, (cube){test_point(&random, 1.5), 0.5}, 0.05, "ends of blends");
        walk_end(&w);
    }
}

/* ---- on the threshold
 * ------------------------------------------------------------------------------ */

/* Two spheres on a line through the cell with their fields' difference at one point of the cell
 * exactly the support, up to rounding: the farther one may or may not be dropped, and must not be
 * where that would change a bit. */
static void check_threshold(csg_random *random, csg_blend_kind kind, csg_node_kind how,
                            walk *totals)
{
    walk w = {0};
    csg_blend blend = test_random_blend(random, kind);
    double chi = csg_blend_support(blend), half = csg_random_uniform(random, 0.01, 0.2);
    csg_vec3 center = test_point(random, 1), along = test_point(random, 1);
    along = csg_vec3_scale(
        csg_vec3_make(copysign(1, along.x), copysign(1, along.y), copysign(1, along.z)),
        1 / sqrt(3.0));
    double radius = half * sqrt(3.0), r[2], distance[2], turn = how == CSG_NODE_UNION ? 1 : -1;
    /* At the cell's corner towards the second sphere: values `f` and f - chi (mirrored for an
     * intersection), within a few ulp. */
    double f = csg_random_uniform(random, -1, 1) * half;
    double value[2] = {f, f - turn * chi + csg_random_uniform(random, -4, 4) * 1e-7};
    csg_vec3 end = csg_vec3_add(center, csg_vec3_scale(along, radius));
    csg_node_id nodes[2];
    test_subject_begin(&w.subject);
    for (int k = 0; k < 2; k++) {
        r[k] = csg_random_uniform(random, 0.5, 2) + fmax(value[k], 0);
        distance[k] = r[k] - value[k];
        csg_vec3 at = csg_vec3_add(end, csg_vec3_scale(along, k ? distance[k] : -distance[k]));
        csg_affine place = csg_affine_translate(at);
        nodes[k] = csg_build_transform(
            &w.subject.builder, &place,
            csg_build_primitive(&w.subject.builder, CSG_NODE_SPHERE, &r[k], NOWHERE), NOWHERE);
    }
    test_subject_compile(&w.subject,
                         csg_build_operator(&w.subject.builder, how, blend, nodes, 2, NOWHERE));
    walk_begin(&w, 8);
    /* The cell's child 0 is the cube of the construction. */
    csg_vec3 own = csg_vec3_sub(center, w.subject.field->center);
    cube at = {csg_vec3_add(own, csg_vec3_make(half, half, half)), 2 * half};
    prune_children(&w, &w.subject.field->tape, at);
    double tau = 3 * half;
    csg_tape shorter;
    assert_true(csg_prune_shorten(&w.pruner, 0, (float)tau, &w.arena, &shorter));
    static test_points points;
    static test_results full, other;
    test_points_clear(&points);
    for (int i = 0; i < 256; i++) { /* in the cube, most of them at its corner */
        csg_vec3 p = csg_vec3_scale(along, radius * (1 - pow(2, -i / 8.0)));
        p = csg_vec3_add(p, test_point(random, 0.1 * radius * pow(2, -i / 8.0)));
        p = csg_vec3_make(fmin(fmax(p.x, -half), half), fmin(fmax(p.y, -half), half),
                          fmin(fmax(p.z, -half), half));
        test_points_add(&points, csg_vec3_add(own, p));
    }
    test_evaluate(w.kernel, &w.subject.field->tape, &points, &full);
    test_evaluate(w.kernel, &shorter, &points, &other);
    char what[64];
    snprintf(what, sizeof what, "threshold, %s %s", csg_blend_name(kind), csg_node_kind_name(how));
    size_t kept = keep_band(&full, &other, points.count, tau, what);
    test_same_bits(&full, &other, kept, false, what);
    totals->cells++;
    totals->shortened += shorter.count < w.subject.field->tape.count;
    totals->in_band += kept;
    walk_end(&w);
}

static void test_threshold(void **state)
{
    static const csg_blend_kind kinds[] = {
        CSG_BLEND_SHARP,    CSG_BLEND_ROUND,   CSG_BLEND_OVERBLEND, CSG_BLEND_COSINE,
        CSG_BLEND_PARABOLA, CSG_BLEND_CHAMFER, CSG_BLEND_FILLET};
    csg_random random = {22};
    walk totals = {0};
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++)
        for (int i = 0; i < 250; i++)
            check_threshold(&random, kinds[k], i % 2 ? CSG_NODE_UNION : CSG_NODE_INTERSECTION,
                            &totals);
    assert_true(totals.in_band > 100000);
}

/* ---- what pruning is for
 * ------------------------------------------------------------------------------ */

/* In a cell that one of a thousand balls reaches, its tape is that ball. */
static void test_one_of_many(void **state)
{
    walk w = {0};
    csg_node_id nodes[1000];
    test_subject_begin(&w.subject);
    for (int i = 0; i < 1000; i++) {
        csg_affine place = csg_affine_translate(csg_vec3_make(i % 10, i / 10 % 10, i / 100));
        nodes[i] = csg_build_transform(
            &w.subject.builder, &place,
            csg_build_primitive(&w.subject.builder, CSG_NODE_SPHERE, (double[]){0.3}, NOWHERE),
            NOWHERE);
    }
    test_subject_compile(&w.subject, csg_build_operator(&w.subject.builder, CSG_NODE_UNION,
                                                        (csg_blend){CSG_BLEND_ROUND, 0.1, false},
                                                        nodes, 1000, NOWHERE));
    walk_begin(&w, 10);
    cube at = {csg_vec3_make(0.5, 0.5, 0.5), 0.2}; /* field frame: the centre is (4.5, 4.5, 4.5) */
    prune_children(&w, &w.subject.field->tape, at);
    csg_tape shorter;
    assert_int_equal(csg_prune_state(&w.pruner, 0), CSG_CELL_SURFACE);
    assert_true(csg_prune_shorten(&w.pruner, 0, 0.05f, &w.arena, &shorter));
    assert_int_equal(shorter.count, 1);
    walk_end(&w);
}

int main(int argc, char **argv)
{
    test_take_search(argc, argv);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_random_scenes),        cmocka_unit_test(test_outlines),
        cmocka_unit_test(test_random_fillet_scenes), cmocka_unit_test(test_threshold),
        cmocka_unit_test(test_raised_extrusions),    cmocka_unit_test(test_one_of_many),
        cmocka_unit_test(test_pairs_of_fillets),     cmocka_unit_test(test_ends_of_blends),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
