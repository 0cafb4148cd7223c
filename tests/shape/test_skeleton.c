/* SPDX-License-Identifier: MIT
 * Straight skeletons against Clipper: where the edges have moved in by t, what is left is the
 * outline shrunk by t with sharp corners.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>

#include <cmocka.h>

#include "shape/outline_fixture.h"
#include "shape/outline_support.h"
#include "shape/plane/polygons.h"
#include "shape/plane/skeleton.h"

static double turn(csg_vec2 a, csg_vec2 b, csg_vec2 c)
{
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/* Of a triangle with the heights 0, b and c, the share that is higher than t. */
static double share_above(double b, double c, double t)
{
    if (b <= t && c <= t)
        return 0;
    if (b > t && c > t)
        return 1 - t * t / (b * c);
    double high = fmax(b, c), low = fmin(b, c);
    return (1 - t / high) * (high - t) / (high - low);
}

/* A fan over each face, from where its edge begins: arc by arc, in any order. */
static double area_above(const csg_outline *figure, const csg_skeleton *s, double t)
{
    double sum = 0;
    for (size_t i = 0; i < s->arc_count; i++) {
        const csg_skeleton_node *a = &s->nodes[s->arcs[i].from], *b = &s->nodes[s->arcs[i].to];
        double share = share_above(a->time, b->time, t);
        sum += share * turn(figure->points[s->arcs[i].left], a->at, b->at) / 2;
        sum -= share * turn(figure->points[s->arcs[i].right], a->at, b->at) / 2;
    }
    return sum;
}

static double highest(const csg_skeleton *s)
{
    double most = 0;
    for (size_t i = 0; i < s->node_count; i++)
        most = fmax(most, s->nodes[i].time);
    return most;
}

/* Arcs lead upwards, each node lies in the planes of both edges of its arcs. */
static void check_arcs(const csg_outline *figure, const csg_skeleton *s, double slack)
{
    size_t loop = 0;
    uint32_t *next = malloc(figure->point_count * sizeof *next);
    assert_non_null(next);
    for (size_t i = 0; i < figure->point_count; i++) {
        loop += i == figure->ends[loop];
        next[i] = (uint32_t)(i + 1 < figure->ends[loop] ? i + 1 : csg_outline_first(figure, loop));
    }
    for (size_t i = 0; i < s->arc_count; i++) {
        const csg_skeleton_arc *arc = &s->arcs[i];
        assert_true(s->nodes[arc->from].time <= s->nodes[arc->to].time + slack);
        for (int side = 0; side < 4; side++) {
            uint32_t edge = side & 1 ? arc->left : arc->right;
            const csg_skeleton_node *n = &s->nodes[side & 2 ? arc->from : arc->to];
            csg_vec2 p = figure->points[edge], q = figure->points[next[edge]];
            double far = turn(p, q, n->at) / hypot(q.x - p.x, q.y - p.y);
            assert_true(fabs(far - n->time) < slack);
        }
    }
    free(next);
}

enum { STEPS = 24 };

/* Step by step: in one long step the miter of a sharp corner would run through what it meets, and
 * out behind it. */
static void check_skeleton(const csg_outline *figure, double slack)
{
    csg_skeleton s;
    assert_int_equal(csg_skeleton_make(figure, &memory, &s), CSGM_OK);
    check_arcs(figure, &s, slack);
    double top = highest(&s), whole = area_of(figure);
    assert_true(fabs(area_above(figure, &s, 0) - whole) < slack * whole);
    csg_outline left;
    assert_int_equal(csg_polygons_clean(figure, CSG_FILL_NONZERO, &left), CSGM_OK);
    for (int i = 1; i <= STEPS; i++) {
        csg_outline next;
        double step = top / (STEPS + 0.5), t = step * i, area = area_above(figure, &s, t);
        assert_int_equal(csg_polygons_offset(&left, -step, CSG_CORNER_MITER, 0.01, &next), CSGM_OK);
        csg_outline_release(&left);
        left = next;
        if (!(fabs(area - area_of(&left)) < slack * whole))
            print_error("%zu points in %zu loops, %g of %g: %.9g, Clipper %.9g\n",
                        figure->point_count, figure->loop_count, t, top, area, area_of(&left));
        assert_true(fabs(area - area_of(&left)) < slack * whole);
    }
    csg_outline_release(&left);
    csg_skeleton_release(&s);
}

/* What the loops enclose, checked; the fixture's outline is empty again. */
static void check_loops(csg_fill fill, double slack)
{
    csg_outline clean;
    assert_int_equal(csg_polygons_clean(&outline, fill, &clean), CSGM_OK);
    check_skeleton(&clean, slack);
    csg_outline_release(&clean);
    csg_outline_release(&outline);
    csg_outline_init(&outline, &memory);
}

/* Events at different times, holes. */
static void random_figures(void **state)
{
    csg_random random = {17};
    (void)state;
    for (int i = 0; i < 60; i++) {
        int corners = 4 + (int)csg_random_below(&random, 16);
        add_star(&outline, &random, (csg_vec2){0, 0}, 7, 10, corners, false);
        for (int k = 0; k < i % 4; k++) {
            const csg_vec2 at = {2.5 * cos(k * 2.1), 2.5 * sin(k * 2.1)};
            add_star(&outline, &random, at, 1, 2, 4 + (int)csg_random_below(&random, 6), true);
        }
        check_loops(CSG_FILL_EVEN_ODD, 1e-6);
    }
}

/* Events that come together: edges in a lattice, ridges, corners that meet corners. */
static void figures_in_a_lattice(void **state)
{
    csg_random random = {5};
    (void)state;
    for (int i = 0; i < 60; i++) {
        for (int k = 0; k < 1 + i % 5; k++) {
            double x = csg_random_below(&random, 12), y = csg_random_below(&random, 12);
            add_rectangle(&outline, x, y, x + 1 + csg_random_below(&random, 9),
                          y + 1 + csg_random_below(&random, 9));
        }
        check_loops(CSG_FILL_NONZERO, 1e-6);
    }
    for (int teeth = 3; teeth < 13; teeth++) { /* all at once */
        for (int i = 0; i < 2 * teeth; i++) {
            double angle = 3.14159265358979 * i / teeth, radius = i % 2 ? 3 : 8;
            assert_true(
                csg_outline_add(&outline, (csg_vec2){radius * cos(angle), radius * sin(angle)}));
        }
        assert_true(csg_outline_close(&outline));
        check_loops(CSG_FILL_NONZERO, 1e-6);
    }
}

/* Holes that touch the border, or each other in a corner. */
static void loops_touch(void **state)
{
    (void)state;
    add_rectangle(&outline, 0, 0, 20, 20);
    const csg_vec2 hole[] = {{10, 0}, {5, 8}, {15, 8}};
    for (int i = 0; i < 3; i++)
        assert_true(csg_outline_add(&outline, hole[i]));
    assert_true(csg_outline_close(&outline));
    check_loops(CSG_FILL_EVEN_ODD, 1e-6);
    add_rectangle(&outline, 0, 0, 20, 20);
    add_rectangle(&outline, 5, 5, 10, 10);
    add_rectangle(&outline, 10, 10, 15, 15);
    check_loops(CSG_FILL_EVEN_ODD, 1e-6);
    add_rectangle(&outline, 0, 0, 10, 10);
    add_rectangle(&outline, 10, 10, 20, 20);
    check_loops(CSG_FILL_NONZERO, 1e-6);
}

static void nothing_and_much(void **state)
{
    csg_random random = {3};
    csg_skeleton s;
    (void)state;
    assert_int_equal(csg_skeleton_make(&outline, &memory, &s), CSGM_OK);
    assert_int_equal(s.arc_count, 0);
    add_star(&outline, &random, (csg_vec2){0, 0}, 9, 10, 60000, false);
    assert_int_equal(csg_skeleton_make(&outline, &memory, &s), CSGM_ERR_LIMIT);
}

static void the_memory_ends(void **state)
{
    csg_random random = {9};
    (void)state;
    add_star(&outline, &random, (csg_vec2){0, 0}, 5, 10, 20, false);
    csgm_status status = CSGM_ERR_MEMORY;
    for (long n = 0; status != CSGM_OK; n++) {
        failing_memory f;
        csg_skeleton s;
        failing_init(&f, n);
        status = csg_skeleton_make(&outline, &f.memory, &s);
        assert_true(status == (f.allocator.left < 0 ? CSGM_ERR_MEMORY : CSGM_OK));
        csg_skeleton_release(&s);
        assert_int_equal(f.memory.used_bytes, 0);
        assert_true(n < 100);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(random_figures, begin, end),
        cmocka_unit_test_setup_teardown(figures_in_a_lattice, begin, end),
        cmocka_unit_test_setup_teardown(loops_touch, begin, end),
        cmocka_unit_test_setup_teardown(nothing_and_much, begin, end),
        cmocka_unit_test_setup_teardown(the_memory_ends, begin, end),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
