/* SPDX-License-Identifier: MIT
 * The figures of meshes that go by are those of the same meshes in memory: of seeded random scenes,
 * with sharp and split edges, as loose triangles, by several threads and in slabs; and of meshes by
 * hand, in runs that are cut anywhere. What is no closed manifold is said to be none. Sums have the
 * same digits in any order.
 */
#include "mesh/mesh_support.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "mesh/figures/figures.h"
#include "mesh/figures/measures.h"
#include "mesh/small_meshes.h"

/* ---- runs that go nowhere ------------------------------------------------------------------ */

static csgm_status begin_nothing(void *user, const csg_mesh_counts *counts)
{
    *(csg_mesh_counts *)user = *counts;
    return CSGM_OK;
}

static bool put_nothing(void *user, const csg_mesh_run *run)
{
    return run->joined != NULL;
}

static void assert_same_topology(const csgm_mesh_check *a, const csgm_mesh_check *b,
                                 const char *what)
{
    if (a->euler != b->euler || a->components != b->components || a->genus != b->genus ||
        a->unused_vertices != b->unused_vertices ||
        a->zero_area_triangles != b->zero_area_triangles || b->boundary_edges ||
        b->nonmanifold_edges || b->misoriented_edges || b->nonmanifold_vertices)
        fail_msg("%s: another topology: euler %lld and %lld, components %llu and %llu", what,
                 (long long)a->euler, (long long)b->euler, (unsigned long long)a->components,
                 (unsigned long long)b->components);
}

/* Angles come of the same formula, so they are the same; so are the bounds. */
static void assert_same_figures(const csgm_mesh_check *a, const csgm_mesh_check *b,
                                const char *what)
{
    assert_same_topology(a, b, what);
    if (memcmp(&a->bounds, &b->bounds, sizeof a->bounds) != 0)
        fail_msg("%s: other bounds", what);
    if (!(fabs(a->area - b->area) <= 1e-12 * a->area) ||
        !(fabs(a->volume - b->volume) <= 1e-12 * fabs(a->volume) + 1e-15))
        fail_msg("%s: area %.17g and %.17g, volume %.17g and %.17g", what, a->area, b->area,
                 a->volume, b->volume);
    if (!(fabs(a->min_angle_deg - b->min_angle_deg) <= 1e-9 * (1 + a->min_angle_deg)))
        fail_msg("%s: angle %.17g and %.17g", what, a->min_angle_deg, b->min_angle_deg);
}

/* ---- random scenes --------------------------------------------------------------------------- */

static void compile_scene(mesh_case *c, unsigned seed, uint32_t threads)
{
    csg_random random = {7000 + seed};
    test_random_shapes = seed % 2;
    test_random_rules = seed % 3 == 1;
    test_random_curves = false;
    mesh_case_begin(c, threads);
    mesh_case_compile(c, test_random_scene(&c->builder, &random, 1 + seed * 13 % 40));
}

static csgm_mesh_options options_of(unsigned seed)
{
    csgm_mesh_options options = mesh_options(20 + seed * 11 % 45);
    options.bounds = (csg_box){{-0.9, -1.1, -0.7}, {0.8, 0.9, 1.2}};
    options.features = seed % 4 == 3 ? CSGM_FEATURES_SMOOTH : CSGM_FEATURES_SHARP;
    options.normals = seed % 3 == 0 ? CSGM_NORMALS_CREASE : CSGM_NORMALS_VERTEX;
    return options;
}

/* Streams that scene, with a memory limit so that it is in slabs. False: it is too narrow. */
static bool stream(unsigned seed, uint32_t threads, bool corners, uint64_t limit_bytes,
                   csgm_mesh_check *out)
{
    mesh_case c;
    csg_mesh_counts counts;
    csg_mesh_figures *figures;
    compile_scene(&c, seed, threads);
    csgm_mesh_options options = options_of(seed);
    if (corners)
        options.normals = CSGM_NORMALS_VERTEX;
    csg_mesh_receiver nobody = {
        .user = &counts, .begin = begin_nothing, .put = put_nothing, .wants_corners = corners};
    assert_true(csg_mesh_figures_make(&c.context, &nobody, threads, &figures));
    csg_mesh_receiver receiver = csg_mesh_figures_receiver(figures);
    c.context.memory.limit_bytes =
        limit_bytes ? atomic_load(&c.context.memory.used_bytes) + limit_bytes : 0;
    csgm_status status = csg_mesh_stream(&c.context, c.field, &options, &receiver, NULL, &c.stats);
    c.context.memory.limit_bytes = 0;
    bool is_known = status == CSGM_OK && csg_mesh_figures_get(figures, out);
    csg_mesh_figures_destroy(figures);
    mesh_case_end(&c);
    return is_known;
}

static void test_random_scenes(void **state)
{
#if defined(__SANITIZE_ADDRESS__)
    enum { SCENES = 4 };
#else
    enum { SCENES = 16 };
#endif
    unsigned narrow = 0;
    for (unsigned seed = 0; seed < SCENES; seed++) {
        mesh_case c;
        csgm_mesh_check first, other;
        char what[64];
        compile_scene(&c, seed, 2);
        csgm_mesh_options options = options_of(seed);
        assert_int_equal(mesh_build(&c, &options), CSGM_OK);
        csgm_mesh_view view = csg_mesh_view(c.mesh);
        assert_int_equal(csg_mesh_inspect(&c.context, &view, 0, &c.check), CSGM_OK);
        snprintf(what, sizeof what, "scene %u", seed);
        assert_true(stream(seed, 1, false, 0, &first));
        assert_same_figures(&c.check, &first, what);
        assert_true(stream(seed, 3, false, 0, &other));
        assert_memory_equal(&first, &other, sizeof first); /* to the last digit */
        if (options.normals == CSGM_NORMALS_VERTEX) {
            assert_true(stream(seed, 2, true, 0, &other));
            assert_memory_equal(&first, &other, sizeof first);
        }
        if (stream(seed, 2, false, 12000000, &other)) {
            assert_memory_equal(&first, &other, sizeof first);
            narrow++;
        }
        mesh_case_end(&c);
    }
    assert_true(narrow > SCENES / 2);
}

/* ---- meshes by hand ---------------------------------------------------------------------------- */

typedef struct soup {
    const float *positions;
    const uint32_t *indices;
    size_t vertices, triangles;
} soup;

/* In runs of so many triangles each, which have as large a share of the vertices, in an order by
 * chance. */
static bool look_at(const soup *s, size_t runs, csg_random *random, csgm_mesh_check *out)
{
    csgm_context context = {0};
    csg_mesh_counts counts = {.vertex_count = s->vertices,
                              .triangle_count = s->triangles,
                              .bounds = {{-2, -2, -2}, {2, 2, 2}}};
    csg_mesh_counts told;
    csg_mesh_receiver nobody = {.user = &told, .begin = begin_nothing, .put = put_nothing};
    csg_mesh_figures *figures;
    size_t order[16] = {0};
    csg_memory_init(&context.memory, NULL, 0);
    assert_true(csg_mesh_figures_make(&context, &nobody, 2, &figures));
    csg_mesh_receiver receiver = csg_mesh_figures_receiver(figures);
    assert_int_equal(receiver.begin(receiver.user, &counts), CSGM_OK);
    assert_int_equal(told.triangle_count, s->triangles);
    for (size_t i = 0; i < runs; i++) {
        size_t j = (size_t)(csg_random_next(random) % (i + 1));
        order[i] = order[j];
        order[j] = i;
    }
    for (size_t i = 0; i < runs; i++) {
        size_t v = order[i] * s->vertices / runs, v_end = (order[i] + 1) * s->vertices / runs;
        size_t t = order[i] * s->triangles / runs, t_end = (order[i] + 1) * s->triangles / runs;
        csg_mesh_run run = {.worker = (uint32_t)(i % 2),
                            .first_vertex = v,
                            .vertex_count = v_end - v,
                            .first_triangle = t,
                            .triangle_count = t_end - t,
                            .positions = s->positions + 3 * v,
                            .indices = s->indices + 3 * t,
                            .joined = s->indices + 3 * t};
        assert_true(receiver.put(receiver.user, &run));
    }
    bool is_known = csg_mesh_figures_get(figures, out);
    csg_mesh_figures_destroy(figures);
    assert_int_equal(atomic_load(&context.memory.used_bytes), 0);
    return is_known;
}

/* Also in runs that bring vertices which they do not use. */
static void test_cube_in_runs(void **state)
{
    csg_random random = {1};
    for (int i = 0; i < 300; i++) {
        const soup cube = {cube_positions, cube_indices, 8, 12};
        csgm_mesh_check check;
        size_t runs = 1 + (size_t)i % 4;
        assert_true(look_at(&cube, runs, &random, &check));
        assert_int_equal(check.unused_vertices, 0);
        assert_int_equal(check.euler, 2);
        assert_int_equal(check.components, 1);
        assert_int_equal(check.genus, 0);
        assert_true(check.area == 6 || fabs(check.area - 6) < 1e-15 * 6);
        assert_true(fabs(check.volume - 1) < 1e-15);
        assert_true(fabs(check.min_angle_deg - 45) < 1e-9);
        assert_true(check.bounds.max.z == 1 && check.bounds.min.x == 0);
    }
}

static void assert_irregular(const soup *s)
{
    csg_random random = {2};
    csgm_mesh_check check;
    for (size_t runs = 1; runs <= 4; runs++)
        for (int i = 0; i < 20; i++)
            assert_false(look_at(s, runs, &random, &check));
}

static void test_what_is_no_manifold(void **state)
{
    uint32_t indices[24];
    float positions[21];
    /* a hole */
    assert_irregular(&(soup){tetra_positions, tetra_indices, 4, 3});
    /* a triangle that is turned round */
    memcpy(indices, tetra_indices, sizeof tetra_indices);
    indices[0] = 1, indices[1] = 2, indices[2] = 0;
    assert_irregular(&(soup){tetra_positions, indices, 4, 4});
    /* one that uses a vertex twice */
    memcpy(indices, tetra_indices, sizeof tetra_indices);
    indices[12] = 0, indices[13] = 0, indices[14] = 1;
    assert_irregular(&(soup){tetra_positions, indices, 4, 5});
    /* two tetrahedra with a vertex in common */
    small_touching_tetrahedra(positions, indices);
    assert_irregular(&(soup){positions, indices, 7, 8});
    /* with an edge in common */
    const float edge[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, -1, 0, 0, 0, -1};
    const uint32_t second[] = {0, 1, 4, 5};
    for (int i = 0; i < 12; i++)
        indices[12 + i] = second[tetra_indices[i]];
    assert_irregular(&(soup){edge, indices, 6, 8});
    /* the same triangles twice */
    memcpy(indices + 12, tetra_indices, sizeof tetra_indices);
    assert_irregular(&(soup){tetra_positions, indices, 4, 8});
}

/* ---- sums --------------------------------------------------------------------------------------- */

/* Against sums in long double, and the same bits backwards, and by two who add up. */
static void test_sums(void **state)
{
    enum { COUNT = 5000 };
    static float at[COUNT][9];
    csg_random random = {3};
    csg_box box = {{-1, -1, -1}, {1, 1, 1}};
    csg_mesh_measures all = csg_mesh_measures_begin(box), back = all, halves[2] = {all, all};
    csgm_mesh_check check[3] = {{0}};
    long double area = 0, volume = 0;
    for (int i = 0; i < COUNT; i++) {
        double size = pow(10, csg_random_uniform(&random, -6, 0)) / 2;
        csg_vec3 p = test_point(&random, 0.5);
        for (int k = 0; k < 9; k++)
            at[i][k] = (float)((k % 3 == 0   ? p.x
                                : k % 3 == 1 ? p.y
                                             : p.z) +
                               size * csg_random_uniform(&random, -1, 1));
    }
    for (int i = 0; i < COUNT; i++) {
        const float *a = at[i], *b = a + 3, *c = a + 6, *z = at[COUNT - 1 - i];
        long double u[3], v[3], n[3];
        for (int k = 0; k < 3; k++) {
            u[k] = (long double)b[k] - a[k];
            v[k] = (long double)c[k] - b[k];
        }
        for (int k = 0; k < 3; k++)
            n[k] = u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3];
        area += sqrtl(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) / 2;
        volume += (a[0] * n[0] + a[1] * n[1] + a[2] * n[2]) / 6;
        csg_mesh_measures_put(&all, a, b, c);
        csg_mesh_measures_put(&back, z, z + 3, z + 6);
        csg_mesh_measures_put(&halves[i * 7 % 2], a, b, c);
    }
    csg_mesh_measures_add(&halves[0], &halves[1]);
    csg_mesh_measures_end(&all, box, (csgm_vec3){0, 0, 0}, &check[0]);
    csg_mesh_measures_end(&back, box, (csgm_vec3){0, 0, 0}, &check[1]);
    csg_mesh_measures_end(&halves[0], box, (csgm_vec3){0, 0, 0}, &check[2]);
    assert_memory_equal(&check[0], &check[1], sizeof check[0]);
    assert_memory_equal(&check[0], &check[2], sizeof check[0]);
    assert_true(fabsl(area - (long double)check[0].area) <= 1e-15L * area);
    assert_true(fabsl(volume - (long double)check[0].volume) <= 1e-15L * area);
}

static void test_no_numbers(void **state)
{
    const float a[] = {0, 0, 0}, b[] = {1, 0, 0}, nan[] = {NAN, 0, 0};
    csgm_mesh_check check = {0};
    csg_box box = {{0, 0, 0}, {1, 1, 1}};
    csg_mesh_measures measures = csg_mesh_measures_begin(box);
    csg_mesh_measures_put(&measures, a, b, nan);
    csg_mesh_measures_end(&measures, box, (csgm_vec3){0, 0, 0}, &check);
    assert_true(isnan(check.area) && isnan(check.volume));
    assert_int_equal(check.zero_area_triangles, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_random_scenes),       cmocka_unit_test(test_cube_in_runs),
        cmocka_unit_test(test_what_is_no_manifold), cmocka_unit_test(test_sums),
        cmocka_unit_test(test_no_numbers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
