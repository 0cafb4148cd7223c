/* SPDX-License-Identifier: MIT
 * What hides between lattice points is found, what does not hide is not.
 * Arguments: poses of each planted part, 8 by default.
 */
#include <stdlib.h>
#include <string.h>

#include "grid/certify/certify.h"
#include "mesh/mesh_support.h"
#include "scene/formula/formula.h"
#include "scene/operators/blend_kinds.h"

static uint32_t pose_count = 8;

/* ---- what hides ----------------------------------------------------------------------------- */

typedef struct lattice_case {
    mesh_case base;
    csg_lattice lattice;
    csg_certify_report report;
} lattice_case;

static void certify(lattice_case *c, csg_node_id root, double cell_size)
{
    mesh_case_compile(&c->base, root);
    assert_true(
        csg_lattice_make(c->base.field->bounds, c->base.field->center, cell_size, 0, &c->lattice));
    csg_certify_options options = {.size = cell_size / 64};
    assert_int_equal(
        csg_certify_run(&c->base.context, c->base.field, &c->lattice, &options, &c->report),
        CSGM_OK);
}

static bool is_doubted(lattice_case *c)
{
    csg_octree_options options = {.prune = true, .scan = true};
    csg_octree *octree;
    csg_certify_place place;
    uint64_t edges;
    csgm_status status;
    assert_int_equal(
        csg_octree_create(&c->base.context, c->base.field, &c->lattice, &options, &octree),
        CSGM_OK);
    assert_int_equal(csg_octree_sample(octree, 0, csg_octree_frontier_count(octree)), CSGM_OK);
    bool found = csg_certify_doubts(&c->base.context, c->base.field, &c->lattice, octree, NULL,
                                    NULL, &place, &edges, &status);
    assert_int_equal(status, CSGM_OK);
    csg_octree_destroy(octree);
    return found;
}

/* Where x < 0.79, as a formula that falls by 40 a length: balls of the whole field are a fortieth
 * of what they could be. */
static csg_node_id steep_half(mesh_case *c)
{
    static const csg_formula_step steps[] = {{.op = CSG_FORMULA_X},
                                             {.op = CSG_FORMULA_CONSTANT, .constant = 0.79},
                                             {.op = CSG_FORMULA_SUB, .a = 1, .b = 0},
                                             {.op = CSG_FORMULA_CONSTANT, .constant = 40},
                                             {.op = CSG_FORMULA_MUL, .a = 2, .b = 3}};
    const csg_field_domain domain = {csg_box_all(), false, 0, false};
    return csg_build_field(&c->builder, steps, 5, &domain, NOWHERE);
}

/* A sheet of this half thickness across z, as steep. */
static csg_node_id steep_sheet(mesh_case *c, double half)
{
    const csg_formula_step steps[] = {{.op = CSG_FORMULA_Z},
                                      {.op = CSG_FORMULA_ABS, .a = 0},
                                      {.op = CSG_FORMULA_CONSTANT, .constant = half},
                                      {.op = CSG_FORMULA_SUB, .a = 2, .b = 1},
                                      {.op = CSG_FORMULA_CONSTANT, .constant = 40},
                                      {.op = CSG_FORMULA_MUL, .a = 3, .b = 4}};
    const csg_field_domain domain = {csg_box_all(), false, 0, false};
    return csg_build_field(&c->builder, steps, 6, &domain, NOWHERE);
}

/* Planted parts, in cells of 1 / 8: a sheet of a tenth of a cell, a ball of radius 0.3, a needle of
 * radius 0.04; a crack of 0.05 in the body, which a steep formula
 * may have cut, as it may have made the sheet. */
enum { SHEET, BALL, NEEDLE, CRACK, PLANTS };

static csg_node_id plant(mesh_case *c, int what, bool steep, csg_random *random, csg_vec3 *middle)
{
    const double h = 0.125;
    csg_node_id body = make_box(c, 0.8, 0.8, 0.8), part;
    if (steep)
        body = joined(c, CSG_NODE_INTERSECTION, SHARP, body, steep_half(c));
    if (what == SHEET && steep)
        part = joined(c, CSG_NODE_INTERSECTION, SHARP, make_box(c, 0.3, 0.3, 0.3),
                      steep_sheet(c, 0.05 * h));
    else if (what == SHEET)
        part = make_box(c, 0.3, 0.3, 0.05 * h);
    else if (what == BALL)
        part = make_sphere(c, 0.3 * h);
    else if (what == NEEDLE)
        part = make_cylinder(c, 0.04 * h, 0.3);
    else
        part = make_box(c, 0.3, 0.3, 0.025 * h);
    part = turned(c, part, csg_random_uniform(random, 0, 360), test_direction(random));
    double far = what == CRACK ? 0 : 2;
    *middle = csg_vec3_add(csg_vec3_make(far, 0, 0), test_point(random, h));
    part = moved(c, part, middle->x, middle->y, middle->z);
    return joined(c, what == CRACK ? CSG_NODE_DIFFERENCE : CSG_NODE_UNION, SHARP, body, part);
}

/* Whether a lattice point lies in the ball at `at`. */
static bool holds_point(const lattice_case *c, csg_vec3 at, double radius)
{
    csg_vec3 p = csg_vec3_sub(csg_vec3_sub(at, c->base.field->center), c->lattice.origin);
    double h = c->lattice.cell_size;
    csg_vec3 near = {h * floor(p.x / h + 0.5), h * floor(p.y / h + 0.5), h * floor(p.z / h + 0.5)};
    return csg_vec3_norm(csg_vec3_sub(p, near)) < radius;
}

static void planted_parts_are_found(void **state)
{
    (void)state;
    uint32_t doubted = 0, hidden = 0;
    for (uint32_t i = 0; i < 2 * pose_count * PLANTS; i++) {
        int what = (int)(i % PLANTS);
        bool steep = i >= pose_count * PLANTS;
        lattice_case c;
        csg_vec3 middle;
        csg_random random = {.state = 1000 + i};
        mesh_case_begin(&c.base, 2);
        certify(&c, plant(&c.base, what, steep, &random, &middle), 0.125);
        const csg_certify_place *place = &c.report.places[0];
        bool is_found = c.report.cells[CSG_CELL_MISSED] > 0;
        if (is_found) {
            csg_vec3 off = csg_vec3_sub(place->at, middle);
            hidden += !steep;
            doubted += !steep && is_doubted(&c); /* of steep ones it doubts too much to look at */
            assert_int_equal(place->kind, CSG_CELL_MISSED);
            assert_int_equal(place->is_gap, what == CRACK);
            assert_true(csg_vec3_norm(off) < 0.45);
            assert_true(place->thickness > 0.02 * 0.125 && place->thickness < 0.8 * 0.125);
        } else if (what != BALL || !holds_point(&c, middle, 0.3 * 0.125)) {
            fail_msg("plant %d, pose %u was not found", what, i / PLANTS);
        }
        mesh_case_end(&c.base);
    }
    assert_true(hidden > 3 * pose_count);
    assert_true(doubted * 10 >= hidden * 8); /* the scan is a scan */
}

/* ---- what does not --------------------------------------------------------------------------- */

static csg_node_id clean_solid(mesh_case *c, int which, csg_random *random)
{
    csg_node_id box = make_box(c, 0.9, 0.7, 0.5), ball = make_sphere(c, 0.7);
    csg_node_id rod = make_cylinder(c, 0.3, 2),
                other = turned(c, make_cylinder(c, 0.3, 2), 90, csg_vec3_make(1, 0, 0));
    switch (which) {
    case 9:
        return joined(c, CSG_NODE_DIFFERENCE, SHARP, box, rod);
    case 10:
        return joined(c, CSG_NODE_UNION, SHARP, rod, other);
    case 11:
        return joined(c, CSG_NODE_INTERSECTION, SHARP, box, ball);
    case 12:
        return joined(c, CSG_NODE_UNION, ROUND(0.2), box, moved(c, ball, 0.8, 0, 0));
    case 13:
        return joined(c, CSG_NODE_UNION, (csg_blend){CSG_BLEND_PARABOLA, 0.8, false}, ball,
                      moved(c, make_sphere(c, 0.5), 0.8, 0, 0));
    case 14:
        return joined(c, CSG_NODE_DIFFERENCE, (csg_blend){CSG_BLEND_CHAMFER, 0.1, false}, box, rod);
    case 15:
        return joined(c, CSG_NODE_INTERSECTION, SHARP, moved(c, box, 0.2, 0, 0), steep_half(c));
    case 16:
        return joined(c, CSG_NODE_INTERSECTION, SHARP, moved(c, ball, 0.4, 0, 0), steep_half(c));
    default:
        return make_any_primitive(c, which < 9 ? which : which - 17, random);
    }
}

static void clean_scenes_are_clean(void **state)
{
    (void)state;
    for (int i = 0; i < 22; i++) {
        lattice_case c;
        csg_random random = {.state = 500 + (uint64_t)i};
        mesh_case_begin(&c.base, 2);
        certify(&c, posed_anyhow(&c.base, clean_solid(&c.base, i, &random), &random), 0.06);
        if (c.report.cells[CSG_CELL_MISSED] || c.report.cells[CSG_CELL_UNRESOLVED])
            fail_msg("scene %d: %llu missed, %llu unresolved", i,
                     (unsigned long long)c.report.cells[CSG_CELL_MISSED],
                     (unsigned long long)c.report.cells[CSG_CELL_UNRESOLVED]);
        assert_true(c.report.cells[CSG_CELL_CERTIFIED] > 0);
        assert_int_equal(c.report.place_count, 0);
        assert_true(c.report.promise < 0.03 * 0.06);
        assert_false(is_doubted(&c));
        mesh_case_end(&c.base);
    }
}

/* ---- walls by formulas ----------------------------------------------------------------------- */

/* 0.3 - |gyroid(8 p)|, whose constant is twice what it climbs where it is 0. */
static csg_node_id gyroid_wall(mesh_case *c)
{
    static const double turn = 8 * 57.29577951308232;
    const csg_formula_step steps[] = {{.op = CSG_FORMULA_X},
                                      {.op = CSG_FORMULA_Y},
                                      {.op = CSG_FORMULA_Z},
                                      {.op = CSG_FORMULA_CONSTANT, .constant = turn},
                                      {.op = CSG_FORMULA_MUL, .a = 0, .b = 3},
                                      {.op = CSG_FORMULA_MUL, .a = 1, .b = 3},
                                      {.op = CSG_FORMULA_MUL, .a = 2, .b = 3},
                                      {.op = CSG_FORMULA_SIN, .a = 4},
                                      {.op = CSG_FORMULA_COS, .a = 5},
                                      {.op = CSG_FORMULA_MUL, .a = 7, .b = 8},
                                      {.op = CSG_FORMULA_SIN, .a = 5},
                                      {.op = CSG_FORMULA_COS, .a = 6},
                                      {.op = CSG_FORMULA_MUL, .a = 10, .b = 11},
                                      {.op = CSG_FORMULA_SIN, .a = 6},
                                      {.op = CSG_FORMULA_COS, .a = 4},
                                      {.op = CSG_FORMULA_MUL, .a = 13, .b = 14},
                                      {.op = CSG_FORMULA_ADD, .a = 9, .b = 12},
                                      {.op = CSG_FORMULA_ADD, .a = 16, .b = 15},
                                      {.op = CSG_FORMULA_ABS, .a = 17},
                                      {.op = CSG_FORMULA_CONSTANT, .constant = 0.3},
                                      {.op = CSG_FORMULA_SUB, .a = 19, .b = 18}};
    const csg_field_domain domain = {csg_box_all(), false, 0, false};
    return csg_build_field(&c->builder, steps, sizeof steps / sizeof *steps, &domain, NOWHERE);
}

/* The middle of the wall, where |u| has its kink, is 3.7 cells from its faces. Cells and groups of
 * them have cones all the same: 39 732 cubes are looked at, 82 109 where formulas keep their
 * constants, and then 230 cells stay unresolved. Creases are the cells that the ball's edges run
 * through, 4743, not all that have such an edge near. */
static void walls_have_cones(void **state)
{
    (void)state;
    lattice_case c;
    mesh_case_begin(&c.base, 2);
    csg_node_id wall = gyroid_wall(&c.base);
    certify(&c, joined(&c.base, CSG_NODE_INTERSECTION, SHARP, make_sphere(&c.base, 0.4), wall),
            1.0 / 128);
    const uint64_t *cells = c.report.cells;
    assert_int_equal(cells[CSG_CELL_MISSED] + cells[CSG_CELL_UNRESOLVED] + cells[CSG_CELL_REFINED],
                     0);
    assert_true(cells[CSG_CELL_CERTIFIED] > 60000);
    assert_true(cells[CSG_CELL_CREASE] > 1000 && cells[CSG_CELL_CREASE] < 6000);
    assert_true(c.report.cubes < 50000);
    mesh_case_end(&c.base);
}

/* ---- the report ------------------------------------------------------------------------------ */

static void reports_do_not_depend_on_threads(void **state)
{
    (void)state;
    csg_certify_report first;
    const csgm_isa isas[] = {CSGM_ISA_SCALAR, CSGM_ISA_AUTO, CSGM_ISA_AUTO};
    for (uint32_t i = 0; i < 3; i++) {
        lattice_case c;
        csg_vec3 middle;
        csg_random random = {.state = 77};
        mesh_case_begin(&c.base, i == 2 ? 3 : 1);
        if (isas[i] == CSGM_ISA_SCALAR)
            c.base.context.isa = CSGM_ISA_SCALAR;
        certify(&c, plant(&c.base, SHEET, false, &random, &middle), 0.125);
        if (i == 0)
            first = c.report;
        assert_memory_equal(first.cells, c.report.cells, sizeof first.cells);
        assert_int_equal(first.place_count, c.report.place_count);
        for (uint32_t k = 0; k < first.place_count; k++) {
            assert_true(first.places[k].at.x == c.report.places[k].at.x);
            assert_true(first.places[k].thickness == c.report.places[k].thickness);
        }
        mesh_case_end(&c.base);
    }
}

static bool stop(void *user)
{
    return ++*(int *)user > 0;
}

static void runs_out_and_stops(void **state)
{
    (void)state;
    int refused = 0, stopped = 0;
    for (uint64_t room = 10000; room < 20000000; room *= 2) {
        lattice_case c;
        csg_vec3 middle;
        csg_random random = {.state = 5};
        mesh_case_begin(&c.base, 1);
        mesh_case_compile(&c.base, plant(&c.base, SHEET, false, &random, &middle));
        assert_true(
            csg_lattice_make(c.base.field->bounds, c.base.field->center, 0.125, 0, &c.lattice));
        csg_memory *memory = &c.base.context.memory;
        int calls = 0;
        csg_certify_options options = {.size = 0.002, .user = &calls};
        options.cancelled = room > 1000000 ? stop : NULL;
        memory->limit_bytes = atomic_load(&memory->used_bytes) + room;
        csgm_status status =
            csg_certify_run(&c.base.context, c.base.field, &c.lattice, &options, &c.report);
        refused += status == CSGM_ERR_MEMORY;
        stopped += status == CSGM_CANCELLED;
        mesh_case_end(&c.base);
    }
    assert_true(refused > 0 && stopped > 0);
}

static bool count_calls(void *user)
{
    ++*(uint64_t *)user;
    return false;
}

/* A block may take minutes: who asks to stop is heard in it, before each of its cubes. */
static void a_block_can_be_stopped(void **state)
{
    (void)state;
    lattice_case c;
    csgm_vec3 middle;
    csg_random random = {.state = 5};
    uint64_t calls = 0;
    mesh_case_begin(&c.base, 1);
    mesh_case_compile(&c.base, plant(&c.base, SHEET, false, &random, &middle));
    assert_true(csg_lattice_make(c.base.field->bounds, c.base.field->center, 0.125, 0, &c.lattice));
    csg_certify_options options = {.size = 0.002, .user = &calls, .cancelled = count_calls};
    assert_int_equal(
        csg_certify_run(&c.base.context, c.base.field, &c.lattice, &options, &c.report), CSGM_OK);
    assert_true(c.report.cubes > 0 && calls > c.report.cubes);
    mesh_case_end(&c.base);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_block_can_be_stopped),
        cmocka_unit_test(planted_parts_are_found),
        cmocka_unit_test(clean_scenes_are_clean),
        cmocka_unit_test(walls_have_cones),
        cmocka_unit_test(reports_do_not_depend_on_threads),
        cmocka_unit_test(runs_out_and_stops),
    };
    if (argc > 1)
        pose_count = (uint32_t)strtoul(argv[1], NULL, 10);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
