/* SPDX-License-Identifier: MIT
 * Seeded random scenes of 1 to 60 primitives with all operators and blends: every mesh is a closed
 * oriented 2-manifold, and the same bytes come out with and without pruning, from 1, 2 and 5
 * threads, from every instruction set, and in runs.
 *
 * Arguments: how many scenes (default 60), largest resolution (default 40), the first one's seed
 * (default 0); with one more, every scene mixes all families of operators.
 */
#include "mesh/mesh_support.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static unsigned scene_count = 60, largest_resolution = 40, first_seed = 0;
static bool all_rules = false;

static uint32_t resolution_of(unsigned seed)
{
    return 12 + seed * 7 % (largest_resolution - 11);
}

/* Some scenes are cut by bounds of their own; unbounded ones must be. */
static csgm_mesh_options options_of(const mesh_case *c, unsigned seed)
{
    csgm_mesh_options options = mesh_options(resolution_of(seed));
    csg_box bounds = c->field->bounds;
    bool is_bounded = csg_box_is_empty(bounds) || csg_box_is_finite(bounds);
    if (seed % 5 == 4 || !is_bounded)
        options.bounds = (csg_box){{-0.9, -1.1, -0.7}, {0.8, 0.9, 1.2}};
    return options;
}

static void compile_scene(mesh_case *c, unsigned seed, uint32_t threads)
{
    csg_random random = {1000 + seed};
    test_random_shapes = seed % 2;
    test_random_rules = all_rules || seed % 3 == 1;
    test_random_curves = seed % 10 == 2; /* costly ones */
    mesh_case_begin(c, threads);
    unsigned primitives = 1 + seed * 13 % 60;
    mesh_case_compile(c, test_random_scene(&c->builder, &random, primitives));
}

/* The mesh of that scene made some other way. */
static void compare(const mesh_case *first, unsigned seed, uint32_t threads, csgm_isa isa,
                    bool prune)
{
    mesh_case c;
    char what[96];
    snprintf(what, sizeof what, "scene %u: %u threads, %s, %s", seed, threads, csg_isa_name(isa),
             prune ? "pruned" : "not pruned");
    compile_scene(&c, seed, threads);
    c.context.isa = isa;
    csgm_mesh_options options = options_of(&c, seed);
    options.prune = prune;
    if (mesh_build(&c, &options) != CSGM_OK)
        fail_msg("%s: no mesh", what);
    mesh_assert_same(first->mesh, c.mesh, what);
    mesh_case_end(&c);
}

/* ---- the same mesh in runs
 * ----------------------------------------------------------------------- */

typedef struct collector {
    csgm_context *context;
    csgm_mesh *mesh;
} collector;

static csgm_status collect_begin(void *user, const csg_mesh_counts *counts)
{
    collector *k = user;
    assert_null(k->mesh);
    csgm_status status = csg_mesh_create(k->context, counts->vertex_count, counts->triangle_count,
                                         counts->normals, counts->colors, &k->mesh);
    if (status == CSGM_OK)
        k->mesh->origin = counts->origin;
    return status;
}

static bool collect_run(void *user, const csg_mesh_run *run)
{
    csgm_mesh *mesh = ((collector *)user)->mesh;
    size_t v = run->first_vertex, t = run->first_triangle;
    if (v + run->vertex_count > mesh->vertex_count ||
        t + run->triangle_count > mesh->triangle_count)
        return false;
    memcpy(mesh->positions + 3 * v, run->positions, 12 * run->vertex_count);
    memcpy(mesh->indices + 3 * t, run->indices, 12 * run->triangle_count);
    if (mesh->normals)
        memcpy(mesh->normals + 3 * v, run->normals, 12 * run->vertex_count);
    if (mesh->colors)
        memcpy(mesh->colors + 4 * v, run->colors, 4 * run->vertex_count);
    return true;
}

static void compare_runs(const mesh_case *first, unsigned seed, uint32_t threads)
{
    mesh_case c;
    char what[64];
    snprintf(what, sizeof what, "scene %u in runs, %u threads", seed, threads);
    compile_scene(&c, seed, threads);
    csgm_mesh_options options = options_of(&c, seed);
    collector k = {.context = &c.context};
    csg_mesh_receiver receiver = {.user = &k, .begin = collect_begin, .put = collect_run};
    csg_mesh_counts counts;
    assert_int_equal(csg_mesh_stream(&c.context, c.field, &options, &receiver, &counts, &c.stats),
                     CSGM_OK);
    assert_int_equal(counts.triangle_count, first->mesh->triangle_count);
    if (first->mesh->triangle_count)
        mesh_assert_same(first->mesh, k.mesh, what);
    csg_mesh_destroy(k.mesh);
    mesh_case_end(&c);
}

/* With sanitizers the threads that race and the ways that differ once each: the bytes of these very
 * scenes from all of them are compared by the build without. */
#if defined(__SANITIZE_ADDRESS__)
static const bool every_way = false;
#else
static const bool every_way = true;
#endif

/* ---- all of it
 * -------------------------------------------------------------------------------------- */

static void test_random_scenes(void **state)
{
    unsigned with_surface = 0, with_colors = 0;
    for (unsigned seed = first_seed; seed < first_seed + scene_count; seed++) {
        mesh_case c;
        char what[32];
        snprintf(what, sizeof what, "scene %u", seed);
        compile_scene(&c, seed, 1);
        csgm_mesh_options options = options_of(&c, seed);
        mesh_build_closed(&c, &options, what);
        with_surface += c.mesh->triangle_count > 0;
        with_colors += c.mesh->colors != NULL;
        csgm_isa best = c.context.isa;
        compare(&c, seed, 1, best, false);
        compare(&c, seed, 5, best, true);
        if (every_way) {
            compare(&c, seed, 2, best, true);
            compare(&c, seed, 5, best, false);
        }
        for (csgm_isa isa = CSGM_ISA_SCALAR; isa <= CSGM_ISA_SIMD128; isa++)
            if (csg_cpu_best_isa(isa) == isa && isa != best)
                compare(&c, seed, 1, isa, seed % 2 == 0);
        compare_runs(&c, seed, 1 + seed % 3);
        mesh_case_end(&c);
    }
    /* of the scenes that are always the same; a few others may all be bare or empty */
    if (first_seed == 0)
        assert_true(with_surface > scene_count * 3 / 4 && with_colors > scene_count / 4);
}

/* Sub-cell dust: to the mesher, white noise. */
static void test_noise(void **state)
{
    for (unsigned seed = first_seed; seed < first_seed + scene_count / 4; seed++) {
        mesh_case c;
        csg_random random = {seed};
        csg_node_id dust[400];
        mesh_case_begin(&c, 2);
        for (int i = 0; i < 400; i++) {
            csg_vec3 at = test_point(&random, 1);
            double r = csg_random_uniform(&random, 0.04, 0.12);
            dust[i] = moved(&c, make_sphere(&c, r), at.x, at.y, at.z);
        }
        mesh_case_compile(
            &c, csg_build_operator(&c.builder, CSG_NODE_UNION, SHARP, dust, 400, NOWHERE));
        csgm_mesh_options options = mesh_options(15 + seed % 10);
        mesh_build_closed(&c, &options, "noise");
        assert_true(c.check.components > 1 && c.check.volume > 0);
        mesh_case_end(&c);
    }
}

int main(int argc, char **argv)
{
    if (argc > 1)
        scene_count = (unsigned)atoi(argv[1]);
    if (argc > 2)
        largest_resolution = (unsigned)atoi(argv[2]);
    if (argc > 3)
        first_seed = (unsigned)strtoul(argv[3], NULL, 10);
    all_rules = argc > 4;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_random_scenes),
        cmocka_unit_test(test_noise),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
