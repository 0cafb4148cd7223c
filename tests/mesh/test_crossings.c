/* SPDX-License-Identifier: MIT
 * No mesh runs through itself: seeded random scenes of 1 to 60 primitives, sharp and with all
 * blends, with sharp features and without, against CGAL's exact search; and some of cells that
 * follow the shape, thinned out as drafts. The meshes are closed oriented 2-manifolds too.
 *
 * Arguments: how many scenes (default 30), the first one's seed (default 0). "-v" behind them: goes
 * on after a crossing and tells of each; "thinned": all scenes are thinned out, and nothing else.
 */
#include "base/orient.h"
#include "mesh/features/exact.h"
#include "mesh/mesh_support.h"
#include "mesh/self_intersections.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static unsigned scene_count = 30, first_seed = 0;
static bool goes_on = false, only_thinned = false;

#ifdef HAVE_CGAL

enum { ROOM = 2 };

static void tell_triangle(const csgm_mesh *mesh, uint32_t triangle)
{
    const uint32_t *v = mesh->indices + 3 * (size_t)triangle;
    fprintf(stderr, "  triangle %u:", triangle);
    for (int k = 0; k < 3; k++) {
        const float *p = mesh->positions + 3 * (size_t)v[k];
        fprintf(stderr, " %u (%.9g %.9g %.9g)", v[k], (double)p[0], (double)p[1], (double)p[2]);
    }
    fputc('\n', stderr);
}

static void tell_pair(const csgm_mesh *mesh, const uint32_t pair[2])
{
    for (int k = 0; k < 2; k++)
        tell_triangle(mesh, pair[k]);
}

/* How many pairs cross; tells of the first. */
static long long crossings_of(const csgm_mesh *mesh, const char *what)
{
    uint32_t pairs[ROOM][2];
    long long count = test_self_intersections(mesh->positions, mesh->vertex_count, mesh->indices,
                                              mesh->triangle_count, pairs, ROOM);
    assert_true(count >= 0);
    if (count)
        fprintf(stderr, "%s: %lld crossings of %llu triangles\n", what, count,
                (unsigned long long)mesh->triangle_count);
    for (long long i = 0; i < count && i < ROOM; i++)
        tell_pair(mesh, pairs[i]);
    return count;
}

/* ---- what it finds -----------------------------------------------------------------------------
 */

/* A tetrahedron through another's face, then one that touches it in a point, then one beside it. */
static void test_planted(void **state)
{
    static const uint32_t indices[] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3,
                                       4, 6, 5, 4, 5, 7, 5, 6, 7, 6, 4, 7};
    for (int i = 0; i < 3; i++) {
        float x = i == 0 ? 0.2f : i == 1 ? 0.0f : -0.2f;
        const float positions[] = {0, 0, 0, 0,  4, 0, 0,  0, 4, 4,  0, 0,
                                   x, 1, 1, -2, 1, 2, -2, 2, 1, -2, 1, 1};
        long long count = test_self_intersections(positions, 8, indices, 8, NULL, 0);
        assert_true(i == 2 ? count == 0 : count > 0);
    }
}

/* Coordinates among which much lies on one line or in one plane, or nearly; of kind 3 all do. */
static float draw_coordinate(csg_random *random, int kind, int axis)
{
    if (kind == 3)
        return axis == 2 ? 0.5f : draw_coordinate(random, 0, axis);
    float whole = (float)(int)csg_random_uniform(random, 0, 4.999);
    float fine = ldexpf(whole, -(int)csg_random_uniform(random, 0, 40));
    return kind == 0 ? whole : kind == 1 ? 0.1f * whole + 0.7f : fine;
}

static bool has_area(const csg_exact_triangle *t)
{
    bool any = false;
    for (int axis = 0; axis < 3; axis++)
        any = any || csg_orient_along(t->at[0], t->at[1], t->at[2], axis);
    return any;
}

/* What the mesher asks of two triangles is what CGAL says of them. */
static void test_exact(void **state)
{
    static const uint32_t pairs[3][6] = {
        {0, 1, 2, 3, 4, 5}, {0, 1, 2, 3, 4, 0}, {0, 1, 2, 1, 0, 3}};
    csg_random random = {17};
    unsigned met[3] = {0}, apart[3] = {0};
    for (int i = 0; i < 30000; i++) {
        float positions[6][3];
        const uint32_t *indices = pairs[i % 3];
        csg_exact_triangle t[2];
        for (int v = 0; v < 6; v++)
            for (int axis = 0; axis < 3; axis++)
                positions[v][axis] = draw_coordinate(&random, i / 3 % 4, axis);
        for (int k = 0; k < 6; k++) {
            t[k / 3].vertex[k % 3] = indices[k];
            memcpy(t[k / 3].at[k % 3], positions[indices[k]], sizeof positions[0]);
        }
        if (!has_area(&t[0]) || !has_area(&t[1]))
            continue;
        bool meet = test_self_intersections(positions[0], 6, indices, 2, NULL, 0) > 0;
        (meet ? met : apart)[i % 3]++;
        assert_int_equal(csg_exact_meet(&t[0], &t[1]), meet);
        assert_int_equal(csg_exact_meet(&t[1], &t[0]), meet);
    }
    for (int k = 0; k < 3; k++)
        assert_true(met[k] > 100 && apart[k] > 1000);
}

/* A closed mesh of which one vertex goes too far. */
static void test_pierced(void **state)
{
    mesh_case c;
    mesh_case_begin(&c, 1);
    mesh_case_compile(&c, make_box(&c, 1, 0.7, 0.5));
    csgm_mesh_options options = mesh_options(12);
    mesh_build_closed(&c, &options, "box");
    assert_int_equal(crossings_of(c.mesh, "box"), 0);
    float *p = c.mesh->positions + 3 * (c.mesh->vertex_count / 2);
    for (int axis = 0; axis < 3; axis++)
        p[axis] = -1.5f * p[axis];
    assert_true(test_self_intersections(c.mesh->positions, c.mesh->vertex_count, c.mesh->indices,
                                        c.mesh->triangle_count, NULL, 0) > 0);
    mesh_case_end(&c);
}

/* ---- random scenes -----------------------------------------------------------------------------
 */

static void compile_scene(mesh_case *c, unsigned seed)
{
    csg_random random = {seed + 1000};
    test_random_shapes = seed % 3 == 0;
    test_random_rules = seed % 4 == 1;
    mesh_case_begin(c, 2);
    unsigned primitives = seed % 2 ? 1 + seed * 13 % 60 : 1 + seed % 8;
    mesh_case_compile(c, test_random_scene(&c->builder, &random, primitives));
}

/* Cut by the bounds where it has none of its own. */
static csgm_mesh_options options_of(const mesh_case *c, unsigned seed, csgm_features features)
{
    static const uint32_t resolutions[] = {24, 40, 64};
    csgm_mesh_options options = mesh_options(resolutions[seed % 3]);
    csg_box bounds = c->field->bounds;
    options.features = features;
    if (!csg_box_is_empty(bounds) && !csg_box_is_finite(bounds))
        options.bounds = (csg_box){{-1.5, -1.25, -1.75}, {1.5, 1.75, 1.25}};
    return options;
}

static long long crossings_of_scene(unsigned seed, csgm_features features, bool is_thinned,
                                    uint64_t *triangles)
{
    mesh_case c;
    char what[64];
    const char *how = is_thinned ? ", thinned out" : "";
    snprintf(what, sizeof what, "scene %u%s%s", seed,
             features == CSGM_FEATURES_SHARP ? "" : ", smooth", how);
    compile_scene(&c, seed);
    csgm_mesh_options options = options_of(&c, seed, features);
    if (is_thinned) {
        options.resolution = 0;
        options.quality = CSGM_QUALITY_DRAFT;
    }
    mesh_build_closed(&c, &options, what);
    long long count = crossings_of(c.mesh, what);
    *triangles += c.mesh->triangle_count;
    mesh_case_end(&c);
    return count;
}

static void test_random_scenes(void **state)
{
    uint64_t triangles = 0, bad = 0;
    for (unsigned seed = first_seed; seed < first_seed + scene_count && !only_thinned; seed++) {
        long long sharp = crossings_of_scene(seed, CSGM_FEATURES_SHARP, false, &triangles);
        long long smooth = crossings_of_scene(seed, CSGM_FEATURES_SMOOTH, false, &triangles);
        bad += sharp || smooth;
        if (!goes_on)
            assert_int_equal(bad, 0);
    }
    if (first_seed == 0 && !only_thinned) /* a few others may be small or empty */
        assert_true(triangles > 1000 * (uint64_t)scene_count);
    assert_int_equal(bad, 0);
}

/* Collapses must not run a sheet through another one either. */
static void test_thinned_scenes(void **state)
{
    static const unsigned ONE_OF = 8; /* it takes longer */
    unsigned step = only_thinned ? 1 : ONE_OF;
    uint64_t triangles = 0, bad = 0;
    for (unsigned seed = first_seed; seed < first_seed + scene_count; seed += step) {
        bad += crossings_of_scene(seed, CSGM_FEATURES_SHARP, true, &triangles) > 0;
        if (!goes_on)
            assert_int_equal(bad, 0);
    }
    if (first_seed == 0)
        assert_true(triangles > 100 * (uint64_t)(scene_count / step));
    assert_int_equal(bad, 0);
}

int main(int argc, char **argv)
{
    if (argc > 1)
        scene_count = (unsigned)atoi(argv[1]);
    if (argc > 2)
        first_seed = (unsigned)atoi(argv[2]);
    for (int i = 3; i < argc; i++) {
        goes_on |= !strcmp(argv[i], "-v");
        only_thinned |= !strcmp(argv[i], "thinned");
    }
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_planted),        cmocka_unit_test(test_exact),
        cmocka_unit_test(test_pierced),        cmocka_unit_test(test_random_scenes),
        cmocka_unit_test(test_thinned_scenes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

#else

int main(void)
{
    enum { SKIPPED = 77 };
    puts("built without CGAL (libcgal-dev): skipped");
    return SKIPPED;
}

#endif
