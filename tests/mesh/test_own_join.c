/* SPDX-License-Identifier: MIT
 * Polyhedra that sharp operators combine, with each other and with solids that cells are made for:
 * what is taken is closed, meets nowhere (CGAL), lies on its surface and has the solid on its inner
 * side everywhere (by solid angles); every allocation may fail.
 */
#include "mesh/own_support.h"
#include "mesh/uncrossed.h"
#include "rounds.h"
#include "shape/polyhedra/booleans.h"
#include "shape/solid_support.h"

#include <math.h>
#include <stdlib.h>

/* ---- what is joined ----------------------------------------------------------------------------
 */

/* Balls, prisms and boxes, plain, hollow or mirrored, on whole places now and then, so that faces
 * lie in one plane. */
static csg_node_id random_unit(mesh_case *c, csg_random *random)
{
    bool whole = csg_random_uniform(random, 0, 1) < 0.5;
    double kind = csg_random_uniform(random, 0, 1);
    csg_node_id node;
    if (kind < 0.4) {
        node = make_box(c, 1, 0.5, 1.5);
    } else if (kind < 0.6) {
        csg_outline outline;
        csg_outline_init(&outline, &c->context.memory);
        add_rectangle(&outline, -1, -1, 1, 1);
        add_star(&outline, random, (csg_vec2){0, 0}, 0.2, 0.8, 12, true);
        node = csg_build_extrude(&c->builder, region_of(c, &outline), -1, 1, NOWHERE);
    } else {
        node = make_ball(c, csg_vec3_make(0, 0, 0), 1.2, 12, kind < 0.8 ? 0.2 : 0);
    }
    if (!whole)
        node = posed_anyhow(c, node, random);
    csg_vec3 by = solid_random_point(random, 1.5);
    if (whole)
        by = csg_vec3_make(round(by.x), round(by.y), round(by.z));
    return moved(c, node, by.x, by.y, by.z);
}

static csg_node_id random_tree(mesh_case *c, csg_random *random)
{
    static const csg_node_kind KINDS[] = {CSG_NODE_UNION, CSG_NODE_INTERSECTION,
                                          CSG_NODE_DIFFERENCE, CSG_NODE_UNION};
    csg_node_id node = random_unit(c, random);
    int count = 1 + (int)csg_random_uniform(random, 0, 5);
    for (int i = 0; i < count; i++) {
        csg_node_kind kind = KINDS[(int)csg_random_uniform(random, 0, 4)];
        node = joined(c, kind, SHARP, node, random_unit(c, random));
    }
    return node;
}

static void assert_is_solid(mesh_case *c, csg_random *random)
{
    csgm_mesh_view view = csg_mesh_view(c->mesh);
    assert_int_equal(csg_mesh_inspect(&c->context, &view, 0, &c->check), CSGM_OK);
    assert_int_equal(c->check.boundary_edges + c->check.nonmanifold_edges +
                         c->check.misoriented_edges + c->check.nonmanifold_vertices,
                     0);
    assert_uncrossed(c->mesh, "joined");
    if (c->stats.tolerance > 0) {
        assert_true(fabs(mesh_largest_error(c)) < 1.5 * c->stats.tolerance);
        assert_in_range(c->stats.own_triangles, 1, c->mesh->triangle_count - 1);
        assert_winds_beyond(c, random, 2 * c->stats.tolerance);
    } else {
        assert_true(fabs(mesh_largest_error(c)) < 1e-5);
        assert_winds_around(c, random);
    }
}

/* What is taken is the solid: closed, uncrossed, on its surface, with the solid on its inner
 * side. */
static void test_random_joins(void **state)
{
    (void)state;
    enum { SCENES = ROUNDS(200) };
    int own = 0;
    for (unsigned seed = 0; seed < SCENES; seed++) {
        mesh_case c;
        csg_random random = {seed + 1};
        mesh_case_begin(&c, 2);
        mesh_case_compile(&c, random_tree(&c, &random));
        csgm_mesh_options options = plain();
        if (is_taken(&c, &options)) {
            own++;
            assert_is_solid(&c, &random);
        }
        mesh_case_end(&c);
    }
    if (csg_booleans_are_available())
        assert_in_range(own, SCENES * 3 / 5, SCENES);
    else
        assert_true(own < SCENES / 10); /* those that are apart */
}

/* A hole through a box, beside a box in the same plane: no triangle more than the outline needs. */
static void test_joined_faces(void **state)
{
    (void)state;
    if (!csg_booleans_are_available())
        skip();
    mesh_case c;
    mesh_case_begin(&c, 1);
    if (csg_booleans_are_available()) {
        csg_node_id plate = joined(&c, CSG_NODE_UNION, SHARP, make_box(&c, 2, 1, 0.5),
                                   moved(&c, make_box(&c, 1, 1, 0.5), 3, 0, 0));
        mesh_case_compile(
            &c, joined(&c, CSG_NODE_DIFFERENCE, SHARP, plate, make_box(&c, 0.25, 0.25, 2)));
        csgm_mesh_options options = plain();
        mesh_build_closed(&c, &options, "a plate");
        assert_int_equal(c.stats.own_triangles, c.mesh->triangle_count);
        assert_int_equal(c.mesh->vertex_count, 16);
        assert_int_equal(c.mesh->triangle_count, 32);
        assert_int_equal(c.check.genus, 1);
        assert_true(fabs(c.check.volume - (12 - 0.25)) < 1e-6);
    }
    mesh_case_end(&c);
}

/* ---- what is joined with solids that are no polyhedra ------------------------------------------
 */

static csg_node_id random_rest(mesh_case *c, csg_random *random)
{
    csg_node_id node;
    switch ((int)csg_random_uniform(random, 0, 5)) {
    case 0:
        node = make_sphere(c, csg_random_uniform(random, 0.3, 1));
        break;
    case 1:
        node = csg_build_capsule(&c->builder, csg_vec3_make(-2, 0, 0), csg_vec3_make(2, 0.5, 0),
                                 csg_random_uniform(random, 0.2, 0.5), 0.3, NOWHERE);
        break;
    case 2: /* without end: cut far from everything */
        node = csg_build_half_space(&c->builder, csg_vec3_make(0.6, 0, 0.8),
                                    csg_random_uniform(random, -0.5, 0.5), NOWHERE);
        break;
    case 3:
        node = joined(c, CSG_NODE_UNION, ROUND(0.3), make_sphere(c, 0.6),
                      moved(c, make_box(c, 0.3, 0.3, 1), 0.4, 0, 0));
        break;
    default: /* beside these a box is none, either */
        node = joined(c, CSG_NODE_UNION, SHARP, make_box(c, 0.25, 0.5, 2), make_sphere(c, 0.7));
    }
    csg_vec3 by = solid_random_point(random, 1);
    return moved(c, node, by.x, by.y, by.z);
}

/* Bumpy balls and others in one operator, or one within another. */
static csg_node_id mixed_tree(mesh_case *c, csg_random *random)
{
    static const csg_node_kind KINDS[] = {CSG_NODE_DIFFERENCE, CSG_NODE_INTERSECTION,
                                          CSG_NODE_DIFFERENCE, CSG_NODE_UNION};
    csg_node_id nodes[5];
    size_t count = 2 + (size_t)csg_random_uniform(random, 0, 3);
    for (size_t i = 0; i < count; i++)
        nodes[i] =
            i ? random_rest(c, random)
              : make_ball(c, csg_vec3_make(0, 0, 0), 1.2, 16, csg_random_uniform(random, 0, 0.2));
    if (csg_random_uniform(random, 0, 1) < 0.3)
        nodes[0] = joined(c, CSG_NODE_DIFFERENCE, SHARP, random_rest(c, random), nodes[0]);
    csg_node_kind kind = KINDS[(int)csg_random_uniform(random, 0, 4)];
    return csg_build_operator(&c->builder, kind, SHARP, nodes, count, NOWHERE);
}

/* Thousands of operands are left to the cells, without a word. */
static void test_too_many(void **state)
{
    (void)state;
    enum { PAIRS = 2100 };
    mesh_case c;
    mesh_case_begin(&c, 1);
    csg_node_id *nodes = malloc(PAIRS * sizeof *nodes);
    assert_non_null(nodes);
    for (int i = 0; i < PAIRS; i++) {
        csg_node_id ball = make_ball(&c, csg_vec3_make(3 * i, 0, 0), 1, 4, 0);
        nodes[i] = joined(&c, CSG_NODE_DIFFERENCE, SHARP, ball,
                          moved(&c, make_sphere(&c, 0.5), 3 * i, 0, 1));
    }
    mesh_case_compile(&c,
                      csg_build_operator(&c.builder, CSG_NODE_UNION, SHARP, nodes, PAIRS, NOWHERE));
    free(nodes);
    csgm_mesh_options options = plain();
    assert_false(is_taken(&c, &options));
    assert_int_equal(c.findings, 0);
    mesh_case_end(&c);
}

static void test_random_mixtures(void **state)
{
    (void)state;
    enum { SCENES = ROUNDS(25) };
    int own = 0, mixed = 0;
    for (unsigned seed = 0; seed < SCENES; seed++) {
        mesh_case c;
        csg_random random = {seed + 1};
        mesh_case_begin(&c, 2);
        mesh_case_compile(&c, mixed_tree(&c, &random));
        csgm_mesh_options options = plain();
        options.quality = CSGM_QUALITY_DRAFT;
        if (csg_box_is_finite(c.field->bounds) && is_taken(&c, &options)) {
            own++;
            mixed += c.stats.tolerance > 0;
            assert_is_solid(&c, &random);
        }
        mesh_case_end(&c);
    }
    if (csg_booleans_are_available())
        assert_true(own > SCENES / 2 && mixed > SCENES / 3);
    else
        assert_int_equal(own, 0);
}

/* A hole has the normals of its field: those of a cylinder, though its triangles are few. */
static void test_normals_of_rests(void **state)
{
    (void)state;
    if (!csg_booleans_are_available())
        skip();
    mesh_case c;
    mesh_case_begin(&c, 1);
    if (csg_booleans_are_available()) {
        csg_node_id hole = csg_build_capsule(&c.builder, csg_vec3_make(0, 0, -5),
                                             csg_vec3_make(0, 0, 5), 0.5, 0.5, NOWHERE);
        mesh_case_compile(&c, joined(&c, CSG_NODE_DIFFERENCE, SHARP,
                                     make_ball(&c, csg_vec3_make(0, 0, 0), 2, 20, 0), hole));
        csgm_mesh_options options = plain();
        options.normals = CSGM_NORMALS_CREASE;
        assert_true(is_taken(&c, &options));
        int count = 0;
        for (size_t i = 0; i < c.mesh->vertex_count; i++) {
            csg_vec3 n = csg_vec3_from_floats(c.mesh->normals + 3 * i), p = mesh_vertex(&c, i);
            double radius = hypot(p.x, p.y);
            if (fabs(n.z) > 1e-3 || radius > 0.6)
                continue;
            count++;
            assert_true(hypot(n.x + p.x / radius, n.y + p.y / radius) < 1e-2);
        }
        assert_true(count > 20);
    }
    mesh_case_end(&c);
}

/* ---- looks -------------------------------------------------------------------------------------
 */

/* The colour stands below the operators; the first operand is none of triangles. */
static void test_color_below(void **state)
{
    (void)state;
    if (!csg_booleans_are_available())
        skip();
    mesh_case c;
    const csg_color red = {1, 0, 0, 1};
    mesh_case_begin(&c, 1);
    csg_node_id ball = moved(&c, make_ball(&c, csg_vec3_make(0, 0, 0), 1, 16, 0), 0.5, 0, 0);
    csg_node_id sphere = csg_build_color(&c.builder, red, make_sphere(&c, 1), NOWHERE);
    mesh_case_compile(&c, joined(&c, CSG_NODE_DIFFERENCE, SHARP, sphere,
                                 csg_build_color(&c.builder, red, ball, NOWHERE)));
    csgm_mesh_options options = plain();
    assert_true(is_taken(&c, &options));
    assert_non_null(c.mesh->colors);
    for (size_t i = 0; i < c.mesh->vertex_count; i++)
        assert_true(c.mesh->colors[4 * i] == 255 && c.mesh->colors[4 * i + 1] == 0);
    mesh_case_end(&c);
}

/* Units of two colours stay with the cells where a vertex at their border would be of both. */
static void test_joined_looks(void **state)
{
    (void)state;
    for (int same = 0; same < 2; same++) {
        mesh_case c;
        mesh_case_begin(&c, 1);
        csg_node_id a =
            csg_build_color(&c.builder, (csg_color){1, 0, 0, 1}, make_box(&c, 1, 1, 1), NOWHERE);
        csg_node_id b = moved(&c, make_box(&c, 1, 1, 1), 0.5, 0.5, 0.5);
        if (same)
            b = csg_build_color(&c.builder, (csg_color){1, 0, 0, 1}, b, NOWHERE);
        mesh_case_compile(&c, joined(&c, CSG_NODE_UNION, SHARP, a, b));
        csgm_mesh_options options = plain();
        assert_int_equal(is_taken(&c, &options), same && csg_booleans_are_available());
        for (size_t i = 0; c.mesh && i < c.mesh->vertex_count; i++)
            assert_int_equal(c.mesh->colors[4 * i], 255);
        mesh_case_end(&c);
    }
}

static csg_node_id in_color(mesh_case *c, int number, csg_node_id node)
{
    return csg_build_color(&c->builder, (csg_color){(float)(number + 1) / 255, 0, 1, 1}, node,
                           NOWHERE);
}

static csgm_mesh_options with_creases(void)
{
    csgm_mesh_options options = plain();
    options.normals = CSGM_NORMALS_CREASE;
    return options;
}

static void assert_closed_by_places(mesh_case *c)
{
    csgm_mesh_view view = csg_mesh_view(c->mesh);
    assert_int_equal(csg_mesh_inspect(&c->context, &view, 0, &c->check), CSGM_OK);
    assert_int_equal(c->check.boundary_edges + c->check.nonmanifold_edges +
                         c->check.misoriented_edges + c->check.nonmanifold_vertices,
                     0);
}

/* Operand number k is made from its own state of chance. */
static csg_node_id one_operand(mesh_case *c, int k, csg_random random)
{
    csg_node_id node = csg_random_uniform(&random, 0, 1) < 0.5
                           ? make_box(c, 1, 0.7, 1.2)
                           : make_ball(c, csg_vec3_make(0, 0, 0), 1, 12, 0);
    node = posed_anyhow(c, node, &random);
    csg_vec3 by = solid_random_point(&random, 1);
    return in_color(c, k, moved(c, node, by.x, by.y, by.z));
}

static csg_vec3 middle_of(const csgm_mesh *mesh, const uint32_t corners[3])
{
    csg_vec3 sum = {0, 0, 0};
    for (int k = 0; k < 3; k++)
        sum = csg_vec3_add(sum, csg_vec3_from_floats(mesh->positions + 3 * (size_t)corners[k]));
    return csg_vec3_add(mesh->origin, csg_vec3_scale(sum, 1.0 / 3));
}

/* Each triangle that is not thinner than rounding has the one colour of an operand on whose surface
 * it lies. */
static void assert_color_of_operand(const csgm_mesh *mesh, int k, csg_random random)
{
    mesh_case alone;
    mesh_case_begin(&alone, 1);
    mesh_case_compile(&alone, one_operand(&alone, k, random));
    for (size_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *corners = mesh->indices + 3 * t;
        const uint8_t *color = mesh->colors + 4 * (size_t)corners[0];
        for (int i = 1; i < 3; i++)
            assert_memory_equal(mesh->colors + 4 * (size_t)corners[i], color, 4);
        if (color[0] == k + 1)
            assert_true(fabs(test_sample(alone.scene, middle_of(mesh, corners)).value) < 1e-5);
    }
    mesh_case_end(&alone);
}

/* With vertices for each side of a border they are joined. */
static void test_looks_side_by_side(void **state)
{
    enum { SCENES = ROUNDS(40), MOST = 5 };
    static const csg_node_kind KINDS[] = {CSG_NODE_UNION, CSG_NODE_INTERSECTION,
                                          CSG_NODE_DIFFERENCE, CSG_NODE_UNION};
    (void)state;
    if (!csg_booleans_are_available())
        skip();
    csg_random random = {21};
    int taken = 0;
    for (int i = 0; i < SCENES; i++) {
        mesh_case c;
        csg_random states[MOST];
        int count = 2 + (int)csg_random_uniform(&random, 0, MOST - 1);
        csg_node_id root = CSG_NODE_NONE;
        mesh_case_begin(&c, 1);
        for (int k = 0; k < count; k++) {
            csg_node_kind kind = KINDS[(int)csg_random_uniform(&random, 0, 4)];
            states[k] = (csg_random){(uint64_t)(100 * i + k)};
            csg_node_id operand = one_operand(&c, k, states[k]);
            root = k ? joined(&c, kind, SHARP, root, operand) : operand;
        }
        mesh_case_compile(&c, root);
        csgm_mesh_options options = with_creases();
        if (is_taken(&c, &options)) {
            taken++;
            assert_closed_by_places(&c);
            for (int k = 0; k < count; k++)
                assert_color_of_operand(c.mesh, k, states[k]);
        }
        mesh_case_end(&c);
    }
    assert_true(taken > SCENES / 2);
}

/* Two boxes in one plane: beside each other each keeps its side of the border; where they overlap
 * there is no border that anybody has drawn, and cells decide. */
static void test_looks_in_one_plane(void **state)
{
    (void)state;
    for (int overlaps = 0; overlaps < 2; overlaps++) {
        mesh_case c;
        mesh_case_begin(&c, 1);
        csg_node_id a = in_color(&c, 0, make_box(&c, 2, 1, 1));
        csg_node_id b = in_color(&c, 1, moved(&c, make_box(&c, 1, 2, 1), overlaps ? 1 : 3, 0, 0));
        mesh_case_compile(&c, joined(&c, CSG_NODE_UNION, SHARP, a, b));
        csgm_mesh_options options = with_creases();
        assert_int_equal(is_taken(&c, &options), !overlaps && csg_booleans_are_available());
        for (size_t t = 0; c.mesh && t < c.mesh->triangle_count; t++) {
            const uint32_t *corners = c.mesh->indices + 3 * t;
            assert_int_equal(c.mesh->colors[4 * (size_t)corners[0]],
                             1 + (middle_of(c.mesh, corners).x > 2 - 1e-6));
        }
        mesh_case_end(&c);
    }
}

/* A format without colours does not care how they look. */
static void test_looks_that_nobody_asks_for(void **state)
{
    (void)state;
    mesh_case c;
    mesh_case_begin(&c, 1);
    csg_node_id a = in_color(&c, 0, make_box(&c, 1, 1, 1));
    csg_node_id b = in_color(&c, 1, moved(&c, make_box(&c, 1, 2, 1), 1, 0, 0));
    mesh_case_compile(&c, joined(&c, CSG_NODE_UNION, SHARP, a, b));
    csgm_mesh_options options = plain();
    options.colors = false;
    assert_int_equal(is_taken(&c, &options), csg_booleans_are_available());
    if (c.mesh)
        assert_int_equal(c.mesh->triangle_count, 28);
    mesh_case_end(&c);
}

/* ---- the same everywhere, and allocations that fail --------------------------------------------
 */

static csg_node_id one_mixture(mesh_case *c)
{
    csg_random random = {3};
    return joined(c, CSG_NODE_DIFFERENCE, SHARP, make_ball(c, csg_vec3_make(0, 0, 0), 1, 60, 0.2),
                  random_rest(c, &random));
}

static void test_same_bytes(void **state)
{
    (void)state;
    mesh_case c;
    mesh_case_begin(&c, 3);
    mesh_case_compile(&c, one_mixture(&c));
    csgm_mesh_options options = plain();
    options.quality = CSGM_QUALITY_DRAFT;
    assert_int_equal(own_of(&c, &options) > 0, csg_booleans_are_available());
    mesh_assert_same_by(&c, one_mixture, &options, 1, CSGM_ISA_AUTO);
    mesh_assert_same_by(&c, one_mixture, &options, 2, CSGM_ISA_SCALAR);
    mesh_case_end(&c);
}

static csg_node_id without_box(mesh_case *c)
{
    return joined(c, CSG_NODE_DIFFERENCE, SHARP, make_ball(c, csg_vec3_make(0, 0, 0), 1, 8, 0),
                  make_box(c, 2, 0.25, 0.25));
}

static csg_node_id without_ball(mesh_case *c)
{
    return joined(c, CSG_NODE_DIFFERENCE, SHARP, make_ball(c, csg_vec3_make(0, 0, 0), 1, 12, 0),
                  moved(c, make_sphere(c, 0.5), 0, 0, 1));
}

static void test_each_allocation(void **state)
{
    (void)state;
    if (!csg_booleans_are_available())
        skip();
    own_fail_each_allocation(without_box, 0, 1);
    own_fail_each_allocation(without_ball, 0, 9);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_random_joins),
        cmocka_unit_test(test_joined_faces),
        cmocka_unit_test(test_joined_looks),
        cmocka_unit_test(test_random_mixtures),
        cmocka_unit_test(test_too_many),
        cmocka_unit_test(test_color_below),
        cmocka_unit_test(test_normals_of_rests),
        cmocka_unit_test(test_same_bytes),
        cmocka_unit_test(test_each_allocation),
        cmocka_unit_test(test_looks_side_by_side),
        cmocka_unit_test(test_looks_in_one_plane),
        cmocka_unit_test(test_looks_that_nobody_asks_for),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
