/* SPDX-License-Identifier: MIT
 * Meshes of a lattice that follows the shape: seeded random scenes of all families give closed
 * oriented manifolds that do not run through themselves (CGAL), with the same bytes for any number
 * of threads, instruction set, pruned or not; flat faces end in as few triangles as they need; what
 * is small beside something large is found.
 *
 * Arguments: how many random scenes (default 12; four times as many bumps and dents, up to 40), the
 * first one's seed (default 0).
 */
#include "base/mesh_codes.h"
#include "mesh/mesh_support.h"
#include "mesh/uncrossed.h"

#include <stdio.h>
#include <stdlib.h>

static unsigned scene_count = 12, first_seed = 0;

static csgm_mesh_options following(csgm_quality quality)
{
    csgm_mesh_options options = mesh_options(0);
    options.quality = quality;
    return options;
}

/* ---- flat faces --------------------------------------------------------------------------------
 */

static void test_boxes(void **state)
{
    enum { TURNED = 12 };
    csg_random random = {5};
    int exact = 0;
    for (int i = 0; i < 2 + TURNED; i++) {
        mesh_case c;
        mesh_case_begin(&c, 2);
        double x = csg_random_uniform(&random, 0.5, 3), y = csg_random_uniform(&random, 0.5, 3);
        csg_node_id box = make_box(&c, x, y, 1);
        mesh_case_compile(&c, i < 2 ? box : posed_anyhow(&c, box, &random));
        csgm_mesh_options options = following(CSGM_QUALITY_NORMAL);
        mesh_build_closed(&c, &options, "box");
        bool turned_anyhow = i >= 2; /* a few tilted edges keep some small facets */
        assert_true(c.mesh->triangle_count <= (turned_anyhow ? 40 : 12));
        exact += turned_anyhow && c.mesh->triangle_count == 12;
        assert_int_equal(c.check.components, 1);
        assert_int_equal(c.check.euler, 2);
        assert_true(fabs(c.check.volume - 8 * x * y) < 1e-3 * c.check.volume);
        assert_uncrossed(c.mesh, "box");
        mesh_case_end(&c);
    }
    assert_true(2 * exact > TURNED);
}

/* A box without its upper half, whose sides coincide with those that are cut away: what is left
 * between them is not there, but for a skin where 0.7 puts all points of a side on the lattice.
 * Turned, rounding differs from point to point. */
static void test_coincident_walls(void **state)
{
    csg_random random = {12};
    for (int i = 0; i < 16; i++) {
        mesh_case c;
        mesh_case_begin(&c, 2);
        double x = i ? floor(csg_random_uniform(&random, 5, 30)) / 10 : 1, y = 0.7;
        csg_node_id box = moved(&c, make_box(&c, x, y, 1), 0, 0, 0.5);
        csg_node_id upper = moved(&c, make_box(&c, x, y, 0.5), 0, 0, 1);
        csg_node_id lower = joined(&c, CSG_NODE_DIFFERENCE, SHARP, box, upper);
        bool turned_anyhow = i >= 4;
        mesh_case_compile(&c, turned_anyhow ? posed_anyhow(&c, lower, &random) : lower);
        csgm_mesh_options options = following(CSGM_QUALITY_NORMAL);
        mesh_build_closed(&c, &options, "coincident walls");
        assert_true(c.mesh->triangle_count <= 120); /* not half a million */
        assert_int_equal(c.check.components, 1);
        assert_int_equal(c.check.euler, 2);
        assert_true(fabs(c.check.volume - 4 * x * y) < 1e-3 * c.check.volume);
        mesh_case_end(&c);
    }
}

/* ---- what is small -----------------------------------------------------------------------------
 */

/* Balls hardly larger than the tolerance, beside and in a large block, larger ones on it; the cells
 * that refinement begins with are up to thirty times larger than the tolerance. */
static void test_small_parts(void **state)
{
    csg_random random = {9};
    for (int i = 0; i < 24; i++) {
        mesh_case c;
        mesh_case_begin(&c, 2);
        csg_node_id block = make_box(&c, 4, 3, 1);
        double r = csg_random_uniform(&random, 0.0045, 0.05) * (i % 3 == 1 ? 8 : 1);
        double x = csg_random_uniform(&random, -3.5, 3.5),
               y = csg_random_uniform(&random, -2.5, 2.5);
        double z = i % 3 == 0 ? 1 + 3 * r : i % 3 == 1 ? 1.0 : 0.3;
        csg_node_id ball = moved(&c, make_sphere(&c, r), x, y, z);
        bool cut = i % 3 == 2;
        mesh_case_compile(
            &c, joined(&c, cut ? CSG_NODE_DIFFERENCE : CSG_NODE_UNION, SHARP, block, ball));
        csgm_mesh_options options = following(CSGM_QUALITY_NORMAL);
        mesh_build_closed(&c, &options, "a ball beside a block");
        bool apart = i % 3 != 1;
        assert_int_equal(c.check.components, apart ? 2 : 1);
        assert_true(c.mesh->triangle_count > 12);
        mesh_case_end(&c);
    }
}

/* A ball where the corners of bricks meet: no brick has it alone, nor can say that the next one
 * does not. */
static void test_ball_between_bricks(void **state)
{
    mesh_case c;
    mesh_case_begin(&c, 2);
    csg_node_id block = make_box(&c, 4, 3, 1);
    csg_node_id ball = moved(&c, make_sphere(&c, 0.0050906), 1.762113, -2.324512, 1.030544);
    mesh_case_compile(&c, joined(&c, CSG_NODE_UNION, SHARP, block, ball));
    csgm_mesh_options options = following(CSGM_QUALITY_NORMAL);
    mesh_build_closed(&c, &options, "a ball between bricks");
    assert_int_equal(c.check.components, 2);
    mesh_case_end(&c);
}

/* Bumps on a face of a large block, and dents in it, hardly wider than the tolerance: the points
 * between which they lie all say the same without them. */
static void test_bumps_and_dents(void **state)
{
    csg_random random = {11};
    for (unsigned i = 0; i < 4 * scene_count && i < 40; i++) {
        mesh_case c;
        mesh_case_begin(&c, 2);
        bool cut = i % 2;
        double r = csg_random_uniform(&random, 0.0045, 0.04);
        double x = csg_random_uniform(&random, -3.8, 3.8);
        double y = csg_random_uniform(&random, -2.8, 2.8);
        csg_node_id block = make_box(&c, 4, 3, 1);
        csg_node_id small = moved(&c, make_box(&c, r, r, 2 * r), x, y, 1);
        mesh_case_compile(
            &c, joined(&c, cut ? CSG_NODE_DIFFERENCE : CSG_NODE_UNION, SHARP, block, small));
        csgm_mesh_options options = following(CSGM_QUALITY_NORMAL);
        mesh_build_closed(&c, &options, "a bump on a block");
        assert_true(c.mesh->triangle_count >= 18);
        double change = (cut ? -1 : 1) * (c.check.volume - 96);
        assert_true(change > 0);
        mesh_case_end(&c);
    }
}

/* Sheets from two tolerances thick, wherever they lie between the points of large cells: a step
 * that goes further the further it began jumps over them. */
static void test_thin_sheets(void **state)
{
    csg_random random = {23};
    for (unsigned i = 0; i < 2 * scene_count && i < 40; i++) {
        mesh_case c;
        mesh_case_begin(&c, 2);
        double half = csg_random_uniform(&random, 0.008, 0.012);
        double x = csg_random_uniform(&random, 1, 3);
        csg_node_id block = moved(&c, make_box(&c, 1, 1, 1), -3, 0, 0);
        csg_node_id sheet = moved(&c, make_box(&c, half, 1, 1), x, 0, 0);
        mesh_case_compile(&c, joined(&c, CSG_NODE_UNION, SHARP, block, sheet));
        csgm_mesh_options options = following(CSGM_QUALITY_NORMAL);
        mesh_build_closed(&c, &options, "a sheet beside a block");
        assert_int_equal(c.check.components, 2);
        mesh_case_end(&c);
    }
}

/* A slit through a block, thinner than the tolerance: most of it is in the mesh, or it is named. */
static void test_slits(void **state)
{
    const double tolerance = 0x1p-7; /* a 250th of 2, or less */
    csg_random random = {31};
    for (unsigned i = 0; i < scene_count && i < 40; i++) {
        mesh_case c;
        mesh_case_begin(&c, 2);
        double half = 0.5 * tolerance * csg_random_uniform(&random, 0.1, 0.9);
        double x = csg_random_uniform(&random, -0.8, 0.8);
        csg_node_id block = make_box(&c, 1, 1, 0.5);
        csg_node_id slit = moved(&c, make_box(&c, half, 2, 1), x, 0, 0);
        mesh_case_compile(&c, joined(&c, CSG_NODE_DIFFERENCE, SHARP, block, slit));
        csgm_mesh_options options = following(CSGM_QUALITY_DRAFT);
        mesh_build_closed(&c, &options, "a slit in a block");
        bool raised = c.last_code == CSG_DIAG_NOT_WITHIN; /* a second word, on the tolerance */
        bool named = raised ? c.context.diags.warnings == 2 : c.last_code == CSG_DIAG_THIN_PART;
        double taken = 4 - c.check.volume, whole = 2 * half * 2;
        if (taken < 0.9 * whole && !named)
            fail_msg("slit %u, %g thick at %g: lost without a word", i, 2 * half, x);
        mesh_case_end(&c);
    }
}

/* Where solids touch there is nothing thin: the gap beside the place ends, it is not lost. */
static void test_contacts(void **state)
{
    for (unsigned i = 0; i < 3; i++) {
        mesh_case c;
        mesh_case_begin(&c, 2);
        csg_node_id plate = moved(&c, make_box(&c, 2, 2, 0.25), 0, 0, -0.25);
        csg_node_id ball = moved(&c, make_sphere(&c, 0.7), 0, 0, 0.7);
        csg_node_id log = moved(
            &c, turned(&c, make_cylinder(&c, 0.4, 0.8), 90, csg_vec3_make(1, 0, 0)), 0, 0, 0.4);
        csg_node_id other = i == 0   ? ball
                            : i == 1 ? log
                                     : moved(&c, make_box(&c, 1, 1, 1), 0, 0, 1);
        mesh_case_compile(&c, joined(&c, CSG_NODE_UNION, SHARP, plate, other));
        csgm_mesh_options options = following(CSGM_QUALITY_NORMAL);
        mesh_build_closed(&c, &options, "a solid on a plate");
        assert_int_equal(c.context.diags.warnings, 0);
        mesh_case_end(&c);
    }
}

/* Triangles of leaves beside finer ones, and of polygons without a point inside, are as near as all
 * others: nothing has to be said of a blend. */
static void test_within_tolerance(void **state)
{
    csg_random random = {29};
    for (unsigned i = 0; i < scene_count && i < 10; i++) {
        mesh_case c;
        mesh_case_begin(&c, 2);
        csg_node_id rod = posed_anyhow(&c, make_cylinder(&c, 0.4, 2), &random);
        csg_node_id ball = moved(&c, make_sphere(&c, 1), 0.8, 0.1, 0.2);
        mesh_case_compile(&c, joined(&c, CSG_NODE_UNION, ROUND(0.2), rod, ball));
        csgm_mesh_options options = following(CSGM_QUALITY_NORMAL);
        mesh_build_closed(&c, &options, "a rod blended into a ball");
        assert_int_equal(c.context.diags.warnings, 0); /* W0410 */
        mesh_case_end(&c);
    }
}

/* ---- edges that a wedge pokes through ----------------------------------------------------------
 */

/* However a box is turned, its edges and corners are found in large cells: the mesh is exact. */
static void test_tilted_boxes(void **state)
{
    csg_random random = {17};
    for (unsigned i = 0; i < scene_count && i < 8; i++) {
        mesh_case c;
        mesh_case_begin(&c, 2);
        mesh_case_compile(&c, posed_anyhow(&c, make_box(&c, 2, 1.5, 1), &random));
        csgm_mesh_options options = following(CSGM_QUALITY_DRAFT);
        mesh_build_closed(&c, &options, "a tilted box");
        assert_int_equal(c.check.components, 1);
        assert_int_equal(c.check.euler, 2);
        assert_true(fabs(c.check.volume - 24) < 2e-3 * 24);
        assert_uncrossed(c.mesh, "a tilted box");
        mesh_case_end(&c);
    }
}

/* ---- how many ----------------------------------------------------------------------------------
 */

static void test_triangle_count(void **state)
{
    mesh_case c;
    mesh_case_begin(&c, 2);
    mesh_case_compile(&c, joined(&c, CSG_NODE_UNION, SHARP, make_box(&c, 1, 1, 1),
                                 moved(&c, make_sphere(&c, 1), 1, 0.3, 0.2)));
    csgm_mesh_options options = following(CSGM_QUALITY_NORMAL);
    for (uint64_t most = 2000; most >= 125; most /= 4) {
        options.triangles = most;
        mesh_build_closed(&c, &options, "a number of triangles");
        assert_true(c.mesh->triangle_count <= most + 1);
        assert_true(c.mesh->triangle_count > most / 4);
        assert_uncrossed(c.mesh, "a number of triangles");
    }
    mesh_case_end(&c);
}

/* ---- how few -----------------------------------------------------------------------------------
 */

/* Where the surface is curved in one way, sides of large cells get a vertex between: there are half
 * as many triangles to begin with. */
static void test_bulges(void **state)
{
    mesh_case c;
    mesh_case_begin(&c, 2);
    mesh_case_compile(&c, make_cylinder(&c, 20, 50));
    csgm_mesh_options options = following(CSGM_QUALITY_NORMAL);
    mesh_build_closed(&c, &options, "a cylinder");
    assert_true(c.stats.triangles_before < 6000);
    assert_true(fabs(c.check.volume - 40e3 * 3.14159265) < 200 * 3.14159265);
    assert_uncrossed(c.mesh, "a cylinder");
    mesh_case_end(&c);
}

/* A tight rounding is no crease, although its triangles meet at more than 20 degrees: it is thinned
 * out along itself. True creases stay beside it. */
static void test_tight_roundings(void **state)
{
    mesh_case c;
    mesh_case_begin(&c, 2);
    csg_node_id rod = joined(&c, CSG_NODE_INTERSECTION, ROUND(0.5), make_box(&c, 20, 100, 100),
                             make_box(&c, 100, 15, 100));
    rod = joined(&c, CSG_NODE_INTERSECTION, ROUND(0.5), rod, make_half_space(&c, 0, 0, 1, 10));
    mesh_case_compile(
        &c, joined(&c, CSG_NODE_INTERSECTION, SHARP, rod, make_half_space(&c, 0, 0, -1, 10)));
    csgm_mesh_options options = following(CSGM_QUALITY_NORMAL);
    mesh_build_closed(&c, &options, "rounded and sharp edges");
    assert_true(c.mesh->triangle_count < 200);
    assert_uncrossed(c.mesh, "rounded and sharp edges");
    for (uint64_t i = 0; i < c.mesh->vertex_count; i++)
        assert_true(mesh_vertex(&c, i).z > -9.9 || mesh_vertex(&c, i).z < -10 + 1e-5);
    mesh_case_end(&c);
}

/* ---- random scenes -----------------------------------------------------------------------------
 */

static void compile_scene(mesh_case *c, unsigned seed, uint32_t threads)
{
    csg_random random = {seed + 3000};
    test_random_shapes = seed % 3 == 0;
    test_random_rules = seed % 4 == 1;
    mesh_case_begin(c, threads);
    mesh_case_compile(c, test_random_scene(&c->builder, &random, 1 + seed * 7 % 20));
}

static csgm_mesh_options options_of(const mesh_case *c, unsigned seed)
{
    csgm_mesh_options options = following(CSGM_QUALITY_DRAFT);
    if (!csg_box_is_finite(c->field->bounds) && !csg_box_is_empty(c->field->bounds))
        options.bounds = (csgm_box){{-2, -2, -2}, {2, 2, 2}};
    options.features = seed % 5 == 4 ? CSGM_FEATURES_SMOOTH : CSGM_FEATURES_SHARP;
    return options;
}

/* A solid that is empty, that touches the bounds in a point only, or that has no end: what sets the
 * tolerance has no size there, which no integer may be made of. */
static void test_without_size(void **state)
{
    mesh_case c;
    csgm_mesh_options options = following(CSGM_QUALITY_NORMAL);
    mesh_case_begin(&c, 2);
    mesh_case_compile(&c, joined(&c, CSG_NODE_INTERSECTION, SHARP, make_sphere(&c, 1),
                                 moved(&c, make_sphere(&c, 1), 9, 0, 0)));
    assert_int_equal(mesh_build(&c, &options), CSGM_OK);
    assert_int_equal(c.mesh->triangle_count, 0);
    mesh_case_end(&c);

    mesh_case_begin(&c, 2);
    mesh_case_compile(&c, make_box(&c, 1, 1, 1));
    options.bounds = (csgm_box){{1, 1, 1}, {2, 3, 2}};
    assert_int_equal(mesh_build(&c, &options), CSGM_OK);
    assert_int_equal(c.mesh->triangle_count, 0);
    assert_int_equal(c.last_code, CSG_DIAG_NO_SURFACE);
    mesh_case_end(&c);

    mesh_case_begin(&c, 2);
    mesh_case_compile(&c, make_half_space(&c, 0, 0, 1, 0));
    options = following(CSGM_QUALITY_FINE);
    assert_int_equal(mesh_build(&c, &options), CSGM_ERR_SCENE);
    assert_int_equal(c.last_code, CSG_DIAG_UNBOUNDED);
    mesh_case_end(&c);
}

static void test_random_scenes(void **state)
{
    for (unsigned seed = first_seed; seed < first_seed + scene_count; seed++) {
        mesh_case one, other;
        char what[64];
        snprintf(what, sizeof what, "random scene %u", seed);
        compile_scene(&one, seed, 1);
        csgm_mesh_options options = options_of(&one, seed);
        mesh_build_closed(&one, &options, what);
        assert_uncrossed(one.mesh, what);
        compile_scene(&other, seed, 3);
        other.context.isa = csg_cpu_best_isa(CSGM_ISA_SCALAR);
        options.prune = false;
        mesh_build_closed(&other, &options, what);
        mesh_assert_same(one.mesh, other.mesh, what);
        mesh_case_end(&one);
        mesh_case_end(&other);
    }
}

/* ---- in tiles ----------------------------------------------------------------------------------
 */

/* The first of these limits of memory that is enough for a scene: it is the narrower for tiles. */
static uint64_t build_in_little(mesh_case *c, unsigned seed, const csgm_mesh_options *options)
{
    csg_memory *memory = &c->context.memory;
    uint64_t used = atomic_load(&memory->used_bytes);
    for (uint64_t more = 1 << 20; more <= 64 << 20; more += more / 4) {
        memory->limit_bytes = used + more;
        csgm_status status = mesh_build(c, options);
        if (status == CSGM_OK)
            return memory->limit_bytes;
        assert_int_equal(status, CSGM_ERR_MEMORY);
    }
    fail_msg("scene %u takes more than 64 MB", seed);
    return 0;
}

/* Where the memory does not allow the whole mesh before it is thinned out, it is thinned out in
 * tiles: another mesh, closed and within the tolerance like the first. */
static void test_tiles(void **state)
{
    unsigned tiled = 0;
    enum { STEP = 3 };    /* each scene is made up to a dozen times */
    if (scene_count < 12) /* the slow test */
        skip();
    for (unsigned seed = first_seed; seed < first_seed + scene_count; seed += STEP) {
        mesh_case whole, one, other;
        char what[64];
        snprintf(what, sizeof what, "tiles of random scene %u", seed);
        compile_scene(&whole, seed, 2);
        csgm_mesh_options options = options_of(&whole, seed);
        options.quality = CSGM_QUALITY_NORMAL;
        options.tolerance = seed % 4 == 3 ? 0.01 : 0;
        mesh_build_closed(&whole, &options, what);
        compile_scene(&other, seed, 3);
        uint64_t limit = build_in_little(&other, seed, &options);
        compile_scene(&one, seed, 1);
        one.context.memory.limit_bytes = limit;
        one.context.isa = csg_cpu_best_isa(CSGM_ISA_SCALAR);
        options.prune = false;
        mesh_build_closed(&one, &options, what);
        assert_uncrossed(one.mesh, what);
        mesh_assert_same(one.mesh, other.mesh, what);
        if (options.tolerance > 0) /* of a whole cells are divided around places that it missed */
            assert_true(one.stats.triangles_before <= whole.stats.triangles_before);
        else
            assert_int_equal(one.stats.triangles_before, whole.stats.triangles_before);
        if (one.stats.triangles_before == whole.stats.triangles_before)
            assert_int_equal(one.stats.feature_vertices, whole.stats.feature_vertices);
        if (whole.stats.max_distance_measured <= whole.stats.distance_allowed)
            assert_true(one.stats.max_distance_measured <= one.stats.distance_allowed);
        tiled += one.mesh->triangle_count != whole.mesh->triangle_count;
        mesh_case_end(&whole);
        mesh_case_end(&one);
        mesh_case_end(&other);
    }
    assert_true(tiled > 0);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_boxes),           cmocka_unit_test(test_coincident_walls),
        cmocka_unit_test(test_small_parts),     cmocka_unit_test(test_ball_between_bricks),
        cmocka_unit_test(test_bumps_and_dents), cmocka_unit_test(test_tilted_boxes),
        cmocka_unit_test(test_thin_sheets),     cmocka_unit_test(test_within_tolerance),
        cmocka_unit_test(test_slits),           cmocka_unit_test(test_contacts),
        cmocka_unit_test(test_triangle_count),  cmocka_unit_test(test_random_scenes),
        cmocka_unit_test(test_bulges),          cmocka_unit_test(test_tight_roundings),
        cmocka_unit_test(test_without_size),    cmocka_unit_test(test_tiles),
    };
    if (argc > 1)
        scene_count = (unsigned)strtoul(argv[1], NULL, 10);
    if (argc > 2)
        first_seed = (unsigned)strtoul(argv[2], NULL, 10);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
