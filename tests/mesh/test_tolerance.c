/* SPDX-License-Identifier: MIT
 * Meshes within a tolerance: their distance from the true surface both ways, measured without what
 * made them; few triangles where the surface is flat; closed, without self-intersection, the same
 * for any number of threads; colours, parts and creases stay; whatever fails fails cleanly.
 *
 * test_tolerance [SCENES [FIRST]]: so many random scenes, and nothing else where the first is
 * given.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/mesh_codes.h"
#include "mesh/distance/effort.h"
#include "mesh/mesh_support.h"

static unsigned scene_count = 6, first_scene = 0;

static csgm_mesh_options within(double tolerance)
{
    csgm_mesh_options options = mesh_options(0);
    options.tolerance = tolerance;
    return options;
}

static csg_vec3 corner(const mesh_case *c, uint64_t triangle, int k)
{
    return mesh_vertex(c, c->mesh->indices[3 * triangle + (uint64_t)k]);
}

/* ---- distances ---------------------------------------------------------------------------------
 */

static double clamped(double t)
{
    return fmin(1, fmax(0, t));
}

/* By alternating projections on sides and plane: slow and plain. */
static double distance_to_triangle(csg_vec3 p, const csg_vec3 v[3])
{
    double least = INFINITY;
    csg_vec3 n = csg_vec3_cross(csg_vec3_sub(v[1], v[0]), csg_vec3_sub(v[2], v[0]));
    bool within_all = true;
    for (int k = 0; k < 3; k++) {
        csg_vec3 a = v[k], e = csg_vec3_sub(v[(k + 1) % 3], a), d = csg_vec3_sub(p, a);
        double square = csg_vec3_dot(e, e),
               t = clamped(square > 0 ? csg_vec3_dot(d, e) / square : 0);
        least = fmin(least, csg_vec3_norm(csg_vec3_sub(d, csg_vec3_scale(e, t))));
        within_all = within_all && csg_vec3_dot(csg_vec3_cross(e, d), n) >= 0;
    }
    double norm = csg_vec3_norm(n);
    if (within_all && norm > 0)
        least = fabs(csg_vec3_dot(csg_vec3_sub(p, v[0]), n)) / norm;
    return least;
}

static double distance_to_mesh(const mesh_case *c, csg_vec3 p)
{
    double least = INFINITY;
    for (uint64_t t = 0; t < c->mesh->triangle_count; t++) {
        const csg_vec3 v[3] = {corner(c, t, 0), corner(c, t, 1), corner(c, t, 2)};
        least = fmin(least, distance_to_triangle(p, v));
    }
    return least;
}

/* Whether the field changes its sign within `error` of p, by the reference in double. */
static bool is_near_surface(const mesh_case *c, csg_vec3 p, double error)
{
    csg_sample here = test_sample(c->scene, p);
    double norm = csg_vec3_norm(here.gradient);
    bool inside = here.value >= 0;
    enum { TRIES = 20000 }; /* where two sheets meet the other side may be a narrow wedge */
    for (int i = 0; i < TRIES; i++) {
        csg_random random = {(uint64_t)i};
        csg_vec3 way = i < 2 && norm > 0 ? csg_vec3_scale(here.gradient, (i ? 1 : -1) / norm)
                                         : csg_vec3_normalize(test_point(&random, 1));
        csg_vec3 q = csg_vec3_add(p, csg_vec3_scale(way, error * (i % 3 == 2 ? 0.3 : 1)));
        if ((test_sample(c->scene, q).value >= 0) != inside)
            return true;
    }
    return false;
}

static void assert_near_surface(const mesh_case *c, double error, const char *what)
{
    csg_random random = {7};
    uint64_t count = c->mesh->triangle_count;
    uint64_t samples = 8000;
    for (uint64_t i = 0; i < samples; i++) {
        uint64_t t = i < count ? i : csg_random_below(&random, (uint32_t)count);
        double u = csg_random_uniform(&random, 0, 1), w = csg_random_uniform(&random, 0, 1);
        if (u + w > 1)
            u = 1 - u, w = 1 - w;
        csg_vec3 a = corner(c, t, 0), b = corner(c, t, 1), d = corner(c, t, 2);
        csg_vec3 p = csg_vec3_add(a, csg_vec3_add(csg_vec3_scale(csg_vec3_sub(b, a), u),
                                                  csg_vec3_scale(csg_vec3_sub(d, a), w)));
        if (!is_near_surface(c, p, 1.0001 * error))
            fail_msg("%s: %.9g %.9g %.9g of the mesh is not within %g of the surface", what, p.x,
                     p.y, p.z, error);
    }
}

/* Vertices of a mesh of many more cells lie on the surface: all within the error of the mesh. */
static void assert_surface_near(mesh_case *c, uint32_t resolution, double error, const char *what)
{
    csgm_mesh_options options = mesh_options(resolution);
    csgm_mesh *fine;
    options.normals = CSGM_NORMALS_NONE;
    assert_int_equal(csg_mesh_build(&c->context, c->field, &options, &fine, NULL), CSGM_OK);
    uint64_t step = fine->vertex_count / 3000 + 1;
    for (uint64_t i = 0; i < fine->vertex_count; i += step) {
        const float *f = fine->positions + 3 * i;
        csg_vec3 p =
            csg_vec3_add(fine->origin, csg_vec3_make((double)f[0], (double)f[1], (double)f[2]));
        double distance = distance_to_mesh(c, p);
        if (!(distance <= 1.0001 * error))
            fail_msg("%s: %.9g %.9g %.9g of the surface is %g from the mesh, not within %g", what,
                     p.x, p.y, p.z, distance, error);
    }
    csg_mesh_destroy(fine);
}

/* ---- crossings ---------------------------------------------------------------------------------
 */

/* A segment that passes through a triangle's inside, by signs of volumes that are clear of
 * rounding. */
static bool pierces(csg_vec3 p, csg_vec3 q, const csg_vec3 v[3], double scale)
{
    double clear = 1e-9 * scale * scale * scale;
    csg_vec3 n = csg_vec3_cross(csg_vec3_sub(v[1], v[0]), csg_vec3_sub(v[2], v[0]));
    double a = csg_vec3_dot(n, csg_vec3_sub(p, v[0])), b = csg_vec3_dot(n, csg_vec3_sub(q, v[0]));
    if (!((a > clear && b < -clear) || (a < -clear && b > clear)))
        return false;
    csg_vec3 way = csg_vec3_sub(q, p);
    int positive = 0, negative = 0;
    for (int k = 0; k < 3; k++) {
        csg_vec3 s = csg_vec3_sub(v[k], p), e = csg_vec3_sub(v[(k + 1) % 3], p);
        double volume = csg_vec3_dot(way, csg_vec3_cross(s, e));
        positive += volume > clear;
        negative += volume < -clear;
    }
    return positive == 3 || negative == 3;
}

static void assert_no_crossings(const mesh_case *c, const char *what)
{
    uint64_t count = c->mesh->triangle_count;
    double scale = csg_vec3_norm(csg_box_size(c->check.bounds));
    for (uint64_t t = 0; t < count; t++) {
        const csg_vec3 v[3] = {corner(c, t, 0), corner(c, t, 1), corner(c, t, 2)};
        csg_box box = csg_box_empty();
        for (int k = 0; k < 3; k++)
            box = csg_box_hull(box, (csg_box){v[k], v[k]});
        for (uint64_t s = 0; s < count; s++)
            for (int k = 0; k < 3; k++) {
                csg_vec3 p = corner(c, s, k), q = corner(c, s, (k + 1) % 3);
                if ((p.x < box.min.x && q.x < box.min.x) || (p.x > box.max.x && q.x > box.max.x) ||
                    (p.y < box.min.y && q.y < box.min.y) || (p.y > box.max.y && q.y > box.max.y) ||
                    (p.z < box.min.z && q.z < box.min.z) || (p.z > box.max.z && q.z > box.max.z))
                    continue;
                if (pierces(p, q, v, scale))
                    fail_msg("%s: an edge of triangle %llu goes through triangle %llu", what,
                             (unsigned long long)s, (unsigned long long)t);
            }
    }
}

/* ---- plain solids ------------------------------------------------------------------------------
 */

static void test_box(void **state)
{
    mesh_case c;
    mesh_case_begin(&c, 2);
    mesh_case_compile(&c, turned(&c, make_box(&c, 1, 0.7, 0.4), 33, csg_vec3_make(0.6, 0, 0.8)));
    csgm_mesh_options options = within(0.01);
    mesh_build_closed(&c, &options, "box");
    assert_true(c.mesh->triangle_count <= 40); /* a few small facets stay at its edges */
    assert_true(fabs(c.check.volume - 8 * 0.28) < 0.02);
    assert_int_equal(c.findings, 0);
    assert_true(c.stats.max_distance_bound == 0.01);
    mesh_case_end(&c);
}

static void test_ball(void **state)
{
    uint64_t before = 0;
    const double errors[] = {0.03, 0.01, 0.003};
    for (int i = 0; i < 3; i++) {
        mesh_case c;
        mesh_case_begin(&c, 2);
        mesh_case_compile(&c, make_sphere(&c, 1));
        csgm_mesh_options options = within(errors[i]);
        mesh_build_closed(&c, &options, "ball");
        assert_int_equal(c.findings, 0);
        assert_int_equal(c.check.genus, 0);
        assert_near_surface(&c, errors[i], "ball");
        assert_surface_near(&c, 150, errors[i], "ball");
        /* an equilateral triangle with corners on the ball strays by a^2 / 6: its least area */
        double least = 4 * 3.14159 / (6 * errors[i] * 0.433);
        assert_true((double)c.mesh->triangle_count < 3 * least + 20);
        assert_true(c.mesh->triangle_count > before);
        before = c.mesh->triangle_count;
        mesh_case_end(&c);
    }
}

/* A face that two solids share is no surface: not within their union, and not where nothing is left
 * between them. */
static void test_shared_faces(void **state)
{
    for (int cuts = 0; cuts < 2; cuts++) {
        mesh_case c;
        mesh_case_begin(&c, 2);
        csg_node_id body =
            cuts ? moved(&c, make_box(&c, 1, 0.75, 1), 0, 0, 0.5) : make_cylinder(&c, 1, 0.5);
        csg_node_id other = cuts ? make_box(&c, 1, 0.75, 0.5) : make_cylinder(&c, 1, 0.5);
        other = moved(&c, other, 0, 0, 1);
        csg_node_kind kind = cuts ? CSG_NODE_DIFFERENCE : CSG_NODE_UNION;
        mesh_case_compile(&c, joined(&c, kind, SHARP, body, other));
        csgm_mesh_options options = within(0.002);
        mesh_build_closed(&c, &options, cuts ? "half of a bar" : "two halves of a rod");
        assert_int_equal(c.findings, 0);
        assert_near_surface(&c, 0.002, "shared faces");
        assert_true(fabs(c.check.volume - (cuts ? 3 : 2 * 3.14159)) < 0.03);
        mesh_case_end(&c);
    }
}

/* A drilled and rounded plate with two colours. */
static csg_node_id plate(mesh_case *c)
{
    csg_node_id red =
        csg_build_color(&c->builder, (csg_color){1, 0, 0, 1}, make_box(c, 1, 0.6, 0.15), NOWHERE);
    csg_node_id boss = moved(c, make_cylinder(c, 0.3, 0.3), 0.4, 0, 0.2);
    csg_node_id both = joined(c, CSG_NODE_UNION, ROUND(0.1), red, boss);
    return joined(c, CSG_NODE_DIFFERENCE, SHARP, both,
                  moved(c, make_cylinder(c, 0.15, 1), 0.4, 0, 0));
}

static void test_colors(void **state)
{
    mesh_case c;
    mesh_case_begin(&c, 2);
    mesh_case_compile(&c, plate(&c));
    csgm_mesh_options options = within(0.005);
    mesh_build_closed(&c, &options, "plate");
    assert_int_equal(c.check.genus, 1);
    assert_int_equal(c.findings, 0);
    assert_near_surface(&c, 0.005, "plate");
    assert_surface_near(&c, 200, 0.005, "plate");
    assert_no_crossings(&c, "plate");
    assert_non_null(c.mesh->colors);
    bool red = false, other = false;
    for (uint64_t i = 0; i < c.mesh->vertex_count; i++) {
        const uint8_t *rgba = c.mesh->colors + 4 * i;
        red |= rgba[0] > 250 && rgba[1] < 5;
        other |= rgba[1] > 100;
        csg_vec3 at = mesh_vertex(&c, i);
        if (at.x < -0.5)
            assert_true(rgba[0] > 250 && rgba[1] < 5);
    }
    assert_true(red && other);
    mesh_case_end(&c);
}

static void test_same_for_all_threads(void **state)
{
    mesh_case a;
    mesh_case_begin(&a, 1);
    mesh_case_compile(&a, plate(&a));
    csgm_mesh_options options = within(0.01);
    options.improve = true;
    mesh_build_closed(&a, &options, "one thread");
    mesh_assert_same_by(&a, plate, &options, 2, CSGM_ISA_AUTO);
    mesh_assert_same_by(&a, plate, &options, 5, CSGM_ISA_SCALAR);
    mesh_case_end(&a);
}

/* ---- simplifying and improving -----------------------------------------------------------------
 */

static void test_simplify(void **state)
{
    mesh_case c;
    mesh_case_begin(&c, 2);
    mesh_case_compile(&c, plate(&c));
    csgm_mesh_options options = mesh_options(64);
    mesh_build_closed(&c, &options, "before");
    uint64_t before = c.mesh->triangle_count;
    options.simplify_share = 0.2;
    mesh_build_closed(&c, &options, "a fifth");
    assert_int_equal(c.stats.triangles_before, before);
    assert_true(c.mesh->triangle_count <= before / 5 + 2);
    assert_true(c.mesh->triangle_count >= before / 5 - 2);
    assert_near_surface(&c, 2 * fmax(c.stats.distance_allowed, c.stats.max_distance_measured),
                        "a fifth");
    options.simplify_share = 0;
    options.simplify_error = 0.01;
    mesh_build_closed(&c, &options, "by error");
    assert_true(c.mesh->triangle_count < before / 8);
    assert_near_surface(&c, 0.01, "by error");
    mesh_case_end(&c);
}

/* Largest |f| at the triangles' centroids, by the reference. */
static double largest_stray(const mesh_case *c)
{
    double most = 0;
    for (uint64_t t = 0; t < c->mesh->triangle_count; t++) {
        csg_vec3 sum =
            csg_vec3_add(corner(c, t, 0), csg_vec3_add(corner(c, t, 1), corner(c, t, 2)));
        most = fmax(most, fabs(test_sample(c->scene, csg_vec3_scale(sum, 1.0 / 3)).value));
    }
    return most;
}

static csg_node_id two_balls(mesh_case *c)
{
    return joined(c, CSG_NODE_UNION, ROUND(0.3), make_sphere(c, 1),
                  moved(c, make_sphere(c, 0.7), 1.2, 0.2, 0));
}

static csg_node_id drilled(mesh_case *c)
{
    return turned(
        c, joined(c, CSG_NODE_DIFFERENCE, SHARP, make_box(c, 1, 1, 1), make_cylinder(c, 0.6, 2)),
        33, csg_vec3_make(0.6, 0.64, 0.48));
}

/* Slivers go; the surface, its creases and corners stay where they are. */
static void test_improve(void **state)
{
    static const struct {
        const char *name;
        csg_node_id (*make)(mesh_case *);
        double least_angle; /* of all triangles */
    } scenes[] = {{"two balls", two_balls, 20}, {"drilled", drilled, 10}, {"plate", plate, 5}};
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        mesh_case c;
        mesh_case_begin(&c, 2);
        mesh_case_compile(&c, scenes[i].make(&c));
        csgm_mesh_options options = mesh_options(24);
        mesh_build_closed(&c, &options, scenes[i].name);
        csgm_mesh_check before = c.check;
        double stray = largest_stray(&c);
        uint64_t triangles = c.mesh->triangle_count;
        options.improve = true;
        mesh_build_closed(&c, &options, scenes[i].name);
        assert_true(c.mesh->triangle_count <= triangles);
        assert_true(c.mesh->triangle_count > triangles * 3 / 4);
        assert_true(c.check.min_angle_deg >= scenes[i].least_angle);
        assert_true(c.check.max_aspect < before.max_aspect);
        assert_true(fabs(c.check.volume - before.volume) < 3e-3 * before.volume);
        assert_true(largest_stray(&c) <= stray + 1e-6);
        assert_true(mesh_largest_error(&c) < 1e-5);
        assert_int_equal(c.check.genus, before.genus);
        assert_no_crossings(&c, scenes[i].name);
        mesh_case_end(&c);
    }
}

/* ---- what cannot be
 * ------------------------------------------------------------------------------
 */

static void test_cells_too_large(void **state)
{
    mesh_case c;
    mesh_case_begin(&c, 1);
    mesh_case_compile(&c, make_sphere(&c, 1));
    csgm_mesh_options options = mesh_options(5);
    options.tolerance = 1e-4;
    assert_int_equal(mesh_build(&c, &options), CSGM_OK);
    assert_int_equal(c.last_code, CSG_DIAG_NOT_WITHIN);
    assert_true(c.stats.open_places > 0);
    assert_true(isinf(c.stats.max_distance_bound));
    mesh_case_end(&c);
}

/* Long tapes, and shapes, use up what a search may take sooner: a digit of 43 balls under an
 * exterior blend was looked through for hours. */
static void test_effort(void **state)
{
    enum { BALLS = 40, SHAPES = 40 };
    csg_tape_node shapes[SHAPES] = {{.op = CSG_OP_SHAPE}};
    mesh_case c;
    mesh_case_begin(&c, 1);
    csg_node_id all = make_sphere(&c, 1);
    mesh_case_compile(&c, all);
    assert_int_equal(csg_effort_of(&c.field->tape), 1);
    mesh_case_end(&c);
    mesh_case_begin(&c, 1);
    all = make_sphere(&c, 1);
    for (int i = 1; i < BALLS; i++)
        all = joined(&c, CSG_NODE_UNION, ROUND(0.1), all, moved(&c, make_sphere(&c, 1), i, 0, 0));
    mesh_case_compile(&c, all);
    assert_true(csg_effort_of(&c.field->tape) >= BALLS / 16 + 1);
    for (int i = 0; i < SHAPES; i++)
        shapes[i] = shapes[0];
    const csg_tape tape = {.nodes = shapes, .count = SHAPES};
    assert_true(csg_effort_of(&tape) >= 4 * csg_effort_of(&c.field->tape));
    mesh_case_end(&c);
}

static void test_out_of_memory(void **state)
{
    mesh_case c;
    mesh_case_begin(&c, 1);
    mesh_case_compile(&c, plate(&c));
    csgm_mesh_options options = within(0.02);
    mesh_build_closed(&c, &options, "with memory");
    csg_mesh_destroy(c.mesh);
    c.mesh = NULL;
    uint64_t used = atomic_load(&c.context.memory.used_bytes);
    uint64_t peak = atomic_load(&c.context.memory.peak_bytes);
    for (uint64_t part = 1; part < 16; part++) {
        c.context.memory.limit_bytes = used + (peak - used) * part / 16;
        csgm_status status = mesh_build(&c, &options);
        assert_true(status == CSGM_ERR_MEMORY || status == CSGM_OK);
        assert_int_equal(c.last_code, status == CSGM_OK ? 0 : CSG_DIAG_OUT_OF_MEMORY);
        csg_mesh_destroy(c.mesh);
        c.mesh = NULL;
        assert_int_equal(atomic_load(&c.context.memory.used_bytes), used);
    }
    c.context.memory.limit_bytes = 0;
    mesh_case_end(&c);
}

/* ---- random scenes
 * -------------------------------------------------------------------------------
 */

typedef enum outcome { NO_SURFACE, NOT_PROVEN, PROVEN } outcome;

static outcome try_random_scene(unsigned seed)
{
    const double error = 0.05;
    outcome result = NO_SURFACE;
    mesh_case c;
    char what[32];
    csg_random random = {1000 + seed};
    snprintf(what, sizeof what, "scene %u", seed);
    mesh_case_begin(&c, 2);
    mesh_case_compile(&c, test_random_scene(&c.builder, &random, 1 + seed % 9));
    csgm_mesh_options options = within(error);
    if (csg_box_is_finite(c.field->bounds))
        mesh_build_closed(&c, &options, what);
    if (c.mesh && c.mesh->triangle_count) {
        assert_no_crossings(&c, what);
        /* a part thinner than E may be missed, and is told */
        bool good = c.findings == 0 || c.last_code == CSG_DIAG_THIN_PART;
        result = good ? PROVEN : NOT_PROVEN;
        assert_true(good || c.last_code == CSG_DIAG_NOT_WITHIN);
        assert_true(!good || c.stats.max_distance_bound == error);
        assert_true(!good || c.stats.max_distance_measured <= error);
        if (good) {
            assert_near_surface(&c, error, what);
            uint32_t cells = c.stats.cells[0] < 100 ? c.stats.cells[0] : 100;
            assert_surface_near(&c, 3 * cells + 50, error, what);
        }
    }
    mesh_case_end(&c);
    return result;
}

static void test_random_scenes(void **state)
{
    unsigned proven = 0, with_surface = 0;
    for (unsigned seed = first_scene; seed < first_scene + scene_count; seed++) {
        outcome result = try_random_scene(seed);
        with_surface += result != NO_SURFACE;
        proven += result == PROVEN;
    }
    print_message("%u of %u meshes proven\n", proven, with_surface);
    if (first_scene == 0) /* of a few others all may be thin */
        assert_true(proven * 10 >= with_surface * 9);
}

/* A crease that the first mesh cuts off, farther from it than the faces on both sides are. */
static void test_creases_cut_off(void **state)
{
    const unsigned seeds[] = {1018, 1145};
    for (size_t i = 0; i < sizeof seeds / sizeof *seeds; i++)
        assert_int_equal(try_random_scene(seeds[i]), PROVEN);
}

int main(int argc, char **argv)
{
    if (argc > 1)
        scene_count = (unsigned)atoi(argv[1]);
    if (argc > 2) {
        const struct CMUnitTest scenes[] = {cmocka_unit_test(test_random_scenes)};
        first_scene = (unsigned)atoi(argv[2]);
        return cmocka_run_group_tests(scenes, NULL, NULL);
    }
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_box),
        cmocka_unit_test(test_ball),
        cmocka_unit_test(test_shared_faces),
        cmocka_unit_test(test_colors),
        cmocka_unit_test(test_same_for_all_threads),
        cmocka_unit_test(test_simplify),
        cmocka_unit_test(test_improve),
        cmocka_unit_test(test_cells_too_large),
        cmocka_unit_test(test_effort),
        cmocka_unit_test(test_out_of_memory),
        cmocka_unit_test(test_random_scenes),
        cmocka_unit_test(test_creases_cut_off),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
