/* SPDX-License-Identifier: MIT
 * Sharp features: solids with edges in random poses have apexes on their true edges and corners and
 * flat faces; what cannot have them is counted; copies at creases join again; hard places stay
 * closed. (Crossing triangles are test_crossings.c's, with CGAL.)
 *
 * Argument: how many poses of each solid (default 4).
 */
#include "mesh/mesh_support.h"
#include "scene/formula/formula.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "mesh/weld.h"
#include "scene/primitives/kinds.h"

static unsigned pose_count = 4;

enum { RESOLUTION = 64 };

/* ---- solids ------------------------------------------------------------------------------------
 */

static csg_node_id primitive(mesh_case *c, csg_primitive_kind kind, const double *parameters)
{
    return csg_build_primitive(&c->builder, kind, parameters, csg_span_nowhere());
}

static csg_node_id cube(mesh_case *c)
{
    return primitive(c, CSG_NODE_BOX, (const double[]){1, 1, 1, 0});
}

static csg_node_id plane(mesh_case *c, double x, double y, double z)
{
    double k = 1 / sqrt(3);
    return primitive(c, CSG_NODE_PLANE, (const double[]){k * x, k * y, k * z, 0.7});
}

static csg_node_id tetrahedron(mesh_case *c)
{
    csg_node_id sides[] = {plane(c, 1, 1, 1), plane(c, -1, -1, 1), plane(c, -1, 1, -1),
                           plane(c, 1, -1, -1)};
    return csg_build_operator(&c->builder, CSG_NODE_INTERSECTION, CSG_SHARP, sides, 4,
                              csg_span_nowhere());
}

static csg_node_id cylinder(mesh_case *c)
{
    return primitive(c, CSG_NODE_FRUSTUM, (const double[]){1, 1, 1, 0});
}

static csg_node_id cone(mesh_case *c)
{
    return primitive(c, CSG_NODE_FRUSTUM, (const double[]){1, 0, 1, 0});
}

static csg_node_id drilled(mesh_case *c)
{
    csg_node_id parts[] = {
        primitive(c, CSG_NODE_BOX, (const double[]){1, 1, 0.4, 0}),
        primitive(c, CSG_NODE_FRUSTUM, (const double[]){0.5, 0.5, 1, 0}),
    };
    return csg_build_operator(&c->builder, CSG_NODE_DIFFERENCE, CSG_SHARP, parts, 2,
                              csg_span_nowhere());
}

/* Six teeth on a wheel: at their feet corners that bend inwards, and often lie outside the cell
 * whose polygon they belong to, beyond one or two of its faces. */
static csg_node_id cog(mesh_case *c)
{
    csg_node_id parts[4] = {primitive(c, CSG_NODE_FRUSTUM, (const double[]){0.8, 0.8, 0.3, 0})};
    for (int i = 0; i < 3; i++) {
        csg_affine turn = csg_affine_rotate(60 * i, csg_vec3_make(0, 0, 1));
        csg_node_id bar = primitive(c, CSG_NODE_BOX, (const double[]){1.1, 0.13, 0.3, 0});
        parts[i + 1] = csg_build_transform(&c->builder, &turn, bar, csg_span_nowhere());
    }
    return csg_build_operator(&c->builder, CSG_NODE_UNION, CSG_SHARP, parts, 4, csg_span_nowhere());
}

typedef struct solid {
    const char *name;
    csg_node_id (*make)(mesh_case *c);
    double volume;       /* 0: faces are curved, chords cut it */
    double volume_error; /* relative */
    double smooth_share; /* of polygons on creases that may stay smooth */
} solid;

static const solid solids[] = {
    {"cube", cube, 8, 1e-6, 0},
    {"tetrahedron", tetrahedron, 8 * 1.7320508075688772 * 0.7 * 0.7 * 0.7, 1e-4, 0.02},
    {"cylinder", cylinder, 0, 0, 0},
    {"cone", cone, 0, 0, 0.05},
    {"drilled plate", drilled, 0, 0, 0},
    {"cog", cog, 0, 0, 0},
};

static csg_node_id posed(mesh_case *c, csg_node_id child, csg_random *random)
{
    double axis[3], length = 0;
    for (int i = 0; i < 3; i++) {
        axis[i] = csg_random_uniform(random, -1, 1);
        length += axis[i] * axis[i];
    }
    csg_vec3 u = {axis[0] / sqrt(length), axis[1] / sqrt(length), axis[2] / sqrt(length)};
    csg_affine place = csg_affine_rotate(csg_random_uniform(random, 0, 360), u);
    place.t[0] = csg_random_uniform(random, -1, 1);
    place.t[1] = csg_random_uniform(random, -1, 1);
    place.t[2] = csg_random_uniform(random, -1, 1);
    return csg_build_transform(&c->builder, &place, child, csg_span_nowhere());
}

/* ---- what is asked of them ---------------------------------------------------------------------
 */

/* Vertices of the mesh that are off the surface by more than this much of a cell; apexes are
 * vertices like others. */
static void check_vertices(const mesh_case *c, const char *what)
{
    double most = 3e-3 * c->stats.cell_size;
    for (uint64_t i = 0; i < c->mesh->vertex_count; i++) {
        double f = fabs(test_sample(c->scene, mesh_vertex(c, i)).value);
        if (!(f <= most))
            fail_msg("%s: vertex %llu is %g cells off", what, (unsigned long long)i,
                     f / c->stats.cell_size);
    }
}

/* Middles of triangles: on plane faces these lie on the surface, except where a crease is cut. */
static void check_faces(const mesh_case *c, double share, const char *what)
{
    uint64_t off = 0;
    for (uint64_t t = 0; t < c->mesh->triangle_count; t++) {
        csg_vec3 sum = {0, 0, 0};
        for (int k = 0; k < 3; k++)
            sum = csg_vec3_add(sum, mesh_vertex(c, c->mesh->indices[3 * t + (uint64_t)k]));
        double f = test_sample(c->scene, csg_vec3_scale(sum, 1.0 / 3)).value;
        off += fabs(f) <= 1e-3 * c->stats.cell_size ? 0 : 1;
    }
    uint64_t allowed = (uint64_t)(share * 8 * (double)(c->stats.feature_vertices + 1));
    if (off > allowed)
        fail_msg("%s: %llu of %llu triangles are off the surface, %llu may be", what,
                 (unsigned long long)off, (unsigned long long)c->mesh->triangle_count,
                 (unsigned long long)allowed);
}

static void check_pose(const solid *s, uint64_t seed)
{
    mesh_case c;
    char what[64];
    csg_random random = {seed};
    snprintf(what, sizeof what, "%s, pose %llu", s->name, (unsigned long long)seed);
    mesh_case_begin(&c, 2);
    csg_node_id root = s->make(&c);
    mesh_case_compile(&c, posed(&c, root, &random));
    csgm_mesh_options options = mesh_options(RESOLUTION);
    mesh_build_closed(&c, &options, what);
    assert_true(c.stats.feature_vertices > 100);
    if ((double)c.stats.smooth_features > s->smooth_share * (double)c.stats.feature_vertices)
        fail_msg("%s: %llu polygons stay smooth beside %llu apexes", what,
                 (unsigned long long)c.stats.smooth_features,
                 (unsigned long long)c.stats.feature_vertices);
    check_vertices(&c, what);
    if (s->volume > 0) {
        check_faces(&c, s->smooth_share, what);
        if (!(fabs(c.check.volume / s->volume - 1) <= s->volume_error))
            fail_msg("%s: volume %.12g, not %.12g", what, c.check.volume, s->volume);
    }
    mesh_case_end(&c);
}

static void test_poses(void **state)
{
    for (size_t i = 0; i < sizeof solids / sizeof *solids; i++)
        for (unsigned pose = 0; pose < pose_count; pose++)
            check_pose(&solids[i], 500 + pose);
}

/* ---- smooth solids have none -------------------------------------------------------------------
 */

static csg_node_id blended(mesh_case *c)
{
    csg_node_id parts[] = {
        primitive(c, CSG_NODE_SPHERE, (const double[]){1}),
        primitive(c, CSG_NODE_TORUS, (const double[]){1.2, 0.3, 180}),
    };
    return csg_build_operator(&c->builder, CSG_NODE_UNION, csg_blend_round(0.3), parts, 2,
                              csg_span_nowhere());
}

static void test_smooth_solids(void **state)
{
    for (uint32_t resolution = 12; resolution <= 96; resolution *= 2) {
        mesh_case c;
        mesh_case_begin(&c, 2);
        mesh_case_compile(&c, blended(&c));
        csgm_mesh_options options = mesh_options(resolution);
        mesh_build_closed(&c, &options, "blended");
        assert_int_equal(c.stats.feature_vertices, 0);
        mesh_case_end(&c);
    }
}

/* ---- normals split at creases ------------------------------------------------------------------
 */

static void test_split(void **state)
{
    mesh_case joined, split;
    csgm_mesh_options options = mesh_options(24);
    mesh_case_begin(&joined, 2);
    mesh_case_compile(&joined, drilled(&joined));
    mesh_build_closed(&joined, &options, "joined");
    options.normals = CSGM_NORMALS_CREASE;
    mesh_case_begin(&split, 2);
    mesh_case_compile(&split, drilled(&split));
    assert_int_equal(mesh_build(&split, &options), CSGM_OK);
    assert_true(split.mesh->split);
    assert_true(split.mesh->vertex_count > joined.mesh->vertex_count);

    csgm_mesh_view view = csg_mesh_view(split.mesh);
    csgm_mesh *welded;
    assert_int_equal(csg_weld_runs(&split.context, &view, &welded), CSGM_OK);
    assert_int_equal(welded->vertex_count, joined.mesh->vertex_count);
    assert_memory_equal(welded->positions, joined.mesh->positions,
                        joined.mesh->vertex_count * 3 * sizeof(float));
    assert_memory_equal(welded->indices, joined.mesh->indices,
                        joined.mesh->triangle_count * 3 * sizeof(uint32_t));
    csg_mesh_destroy(welded);

    /* corners of a triangle agree with it: flat faces shade flat */
    for (uint64_t t = 0; t < split.mesh->triangle_count; t++)
        for (int k = 0; k < 3; k++) {
            uint32_t a = split.mesh->indices[3 * t + (uint64_t)k];
            csg_vec3 p = mesh_vertex(&split, a);
            double level = fabs(fabs(p.z) - 0.4);
            const float *n = split.mesh->normals + 3 * (uint64_t)a;
            if (level > 1e-4 || fabs((double)n[2]) < 0.5)
                continue;
            assert_true(fabs((double)n[2]) > 0.9999);
        }
    mesh_case_end(&joined);
    mesh_case_end(&split);
}

/* ---- beads of tips -----------------------------------------------------------------------------
 */

/* Balls of about half a cell, one lattice point in most that show: none is taken for a bead. */
static uint64_t pieces_of_balls(csgm_features features)
{
    enum { BALLS = 64 };
    mesh_case c;
    csg_random random = {77};
    csg_node_id balls[BALLS];
    mesh_case_begin(&c, 2);
    for (int i = 0; i < BALLS; i++) {
        csg_affine place = csg_affine_identity();
        place.t[0] = (i & 3) * 0.5 + csg_random_uniform(&random, -0.1, 0.1);
        place.t[1] = (i >> 2 & 3) * 0.5 + csg_random_uniform(&random, -0.1, 0.1);
        place.t[2] = (i >> 4) * 0.5 + csg_random_uniform(&random, -0.1, 0.1);
        balls[i] = csg_build_transform(&c.builder, &place,
                                       primitive(&c, CSG_NODE_SPHERE, (const double[]){0.03}),
                                       csg_span_nowhere());
    }
    mesh_case_compile(&c, csg_build_operator(&c.builder, CSG_NODE_UNION, CSG_SHARP, balls, BALLS,
                                             csg_span_nowhere()));
    csgm_mesh_options options = mesh_options(32);
    options.features = features;
    mesh_build_closed(&c, &options, "balls");
    uint64_t pieces = c.check.components;
    mesh_case_end(&c);
    return pieces;
}

static void test_balls_are_no_beads(void **state)
{
    uint64_t pieces = pieces_of_balls(CSGM_FEATURES_SMOOTH);
    assert_true(pieces > 4);
    assert_int_equal(pieces_of_balls(CSGM_FEATURES_SHARP), pieces);
}

/* ---- no crease without cause -------------------------------------------------------------------
 */

/* How often the field is asked for 64 balls whose surfaces are `gap` apart, and what it finds. */
static uint64_t evaluations_of_balls(csgm_features features, double gap, uint64_t *apexes)
{
    enum { BALLS = 64 };
    mesh_case c;
    csg_node_id balls[BALLS];
    mesh_case_begin(&c, 2);
    for (int i = 0; i < BALLS; i++) {
        csg_affine place = csg_affine_identity();
        place.t[0] = (i & 3) * 0.5, place.t[1] = (i >> 2 & 3) * 0.5, place.t[2] = (i >> 4) * 0.5;
        balls[i] = csg_build_transform(
            &c.builder, &place, primitive(&c, CSG_NODE_SPHERE, (const double[]){(0.5 - gap) / 2}),
            csg_span_nowhere());
    }
    mesh_case_compile(&c, csg_build_operator(&c.builder, CSG_NODE_UNION, CSG_SHARP, balls, BALLS,
                                             csg_span_nowhere()));
    csgm_mesh_options options = mesh_options(RESOLUTION);
    options.features = features;
    mesh_build_closed(&c, &options, "balls");
    *apexes = c.stats.feature_vertices;
    uint64_t evaluations = c.stats.point_evaluations;
    mesh_case_end(&c);
    return evaluations;
}

/* Balls that share blocks and come no nearer than three cells cost nothing but a look at cells;
 * those that run into each other have their creases. */
static void test_balls_apart(void **state)
{
    uint64_t apexes;
    uint64_t smooth = evaluations_of_balls(CSGM_FEATURES_SMOOTH, 0.12, &apexes);
    uint64_t sharp = evaluations_of_balls(CSGM_FEATURES_SHARP, 0.12, &apexes);
    assert_int_equal(apexes, 0);
    assert_true(sharp < smooth + smooth / 10);
    evaluations_of_balls(CSGM_FEATURES_SHARP, -0.1, &apexes);
    assert_true(apexes > 1000);
}

/* ---- smooth on demand --------------------------------------------------------------------------
 */

static void test_features_off(void **state)
{
    mesh_case c;
    mesh_case_begin(&c, 1);
    mesh_case_compile(&c, cube(&c));
    csgm_mesh_options options = mesh_options(20);
    options.features = CSGM_FEATURES_SMOOTH;
    mesh_build_closed(&c, &options, "smooth cube");
    assert_int_equal(c.stats.feature_vertices, 0);
    assert_true(c.check.volume < 8 * (1 - 1e-3));
    mesh_case_end(&c);
}

/* ---- what it costs -----------------------------------------------------------------------------
 */

/* Where sheets are plane no segment is halved ten times, and no apex is taken nearer step by step:
 * for each vertex on an edge of a turned box 128.9 points are asked more than without, roots of all
 * vertices around among them; 138.0 if apexes were, 151 if all segments were halved, too. */
static void test_plane_sheets_ask_little(void **state)
{
    static const double MOST = 133;
    mesh_case c;
    mesh_case_begin(&c, 1);
    csg_node_id box = make_box(&c, 0.9, 0.7, 0.5);
    mesh_case_compile(&c, turned(&c, box, 31, csg_vec3_make(1, 2, 3)));
    csgm_mesh_options options = mesh_options(64);
    mesh_build_closed(&c, &options, "sharp");
    csgm_mesh_stats sharp = c.stats;
    options.features = CSGM_FEATURES_SMOOTH;
    mesh_build_closed(&c, &options, "smooth");
    uint64_t more = sharp.point_evaluations - c.stats.point_evaluations;
    assert_true(sharp.feature_vertices > 500);
    assert_true((double)more < MOST * (double)sharp.feature_vertices);
    mesh_case_end(&c);
}

/* A ball's part within 0.3 of where a formula is 0: |sin 8x cos 8y + sin 8y cos 8z + sin 8z cos
 * 8x|. */
static csg_node_id make_gyroid_wall(mesh_case *c)
{
    const csg_formula_step steps[] = {
        {.op = CSG_FORMULA_CONSTANT, .constant = 3 * 180 / 3.14159265},
        {.op = CSG_FORMULA_X},
        {.op = CSG_FORMULA_MUL, .a = 1, .b = 0},
        {.op = CSG_FORMULA_SIN, .a = 2},
        {.op = CSG_FORMULA_COS, .a = 2},
        {.op = CSG_FORMULA_Y},
        {.op = CSG_FORMULA_MUL, .a = 5, .b = 0},
        {.op = CSG_FORMULA_SIN, .a = 6},
        {.op = CSG_FORMULA_COS, .a = 6},
        {.op = CSG_FORMULA_Z},
        {.op = CSG_FORMULA_MUL, .a = 9, .b = 0},
        {.op = CSG_FORMULA_SIN, .a = 10},
        {.op = CSG_FORMULA_COS, .a = 10},
        {.op = CSG_FORMULA_MUL, .a = 3, .b = 8},
        {.op = CSG_FORMULA_MUL, .a = 7, .b = 12},
        {.op = CSG_FORMULA_MUL, .a = 11, .b = 4},
        {.op = CSG_FORMULA_ADD, .a = 13, .b = 14},
        {.op = CSG_FORMULA_ADD, .a = 16, .b = 15},
        {.op = CSG_FORMULA_ABS, .a = 17},
        {.op = CSG_FORMULA_CONSTANT, .constant = 0.3},
        {.op = CSG_FORMULA_SUB, .a = 19, .b = 18}};
    const csg_field_domain domain = {csg_box_all(), false, 0, false};
    csg_node_id wall =
        csg_build_field(&c->builder, steps, sizeof steps / sizeof *steps, &domain, NOWHERE);
    return joined(c, CSG_NODE_INTERSECTION, SHARP, make_sphere(c, 1), wall);
}

/* The middle of the wall, where the gradient jumps, is in every other block; but in few cells that
 * the surface passes, of which no polygon is asked for jumps: 7.54 points are asked more for each
 * vertex than without features, roots among them; 9.54 if all cells of such blocks were looked at.
 */
static void test_kinks_beside_the_surface(void **state)
{
    static const double MOST = 8.3;
    mesh_case c;
    mesh_case_begin(&c, 1);
    mesh_case_compile(&c, make_gyroid_wall(&c));
    csgm_mesh_options options = mesh_options(160);
    mesh_build_closed(&c, &options, "sharp");
    csgm_mesh_stats sharp = c.stats;
    options.features = CSGM_FEATURES_SMOOTH;
    mesh_build_closed(&c, &options, "smooth");
    uint64_t more = sharp.point_evaluations - c.stats.point_evaluations;
    assert_true(sharp.feature_vertices > 1000);
    assert_true((double)more < MOST * (double)c.mesh->vertex_count);
    mesh_case_end(&c);
}

int main(int argc, char **argv)
{
    if (argc > 1)
        pose_count = (unsigned)strtoul(argv[1], NULL, 10);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_poses),
        cmocka_unit_test(test_smooth_solids),
        cmocka_unit_test(test_split),
        cmocka_unit_test(test_balls_are_no_beads),
        cmocka_unit_test(test_balls_apart),
        cmocka_unit_test(test_features_off),
        cmocka_unit_test(test_plane_sheets_ask_little),
        cmocka_unit_test(test_kinks_beside_the_surface),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
