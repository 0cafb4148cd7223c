/* SPDX-License-Identifier: MIT
 * What a tolerance is worth: a mesh within E, proven, has at most a tenth of the triangles of a
 * mesh of equal cells as near to the surface. For with ten times as many and more the latter still
 * has points that are farther than E: where |f| is larger, the field's slope being at most 1.
 *
 * test_tolerance_mug SCENE E
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "csgmesh/csgmesh.h"

static const char *scene_path;
static double error;

/* Largest |f| at the triangles' centroids. */
static double largest_stray(const csgm_field *field, const csgm_mesh *mesh)
{
    enum { BATCH = 256 };
    csgm_mesh_view v = csgm_mesh_get_view(mesh);
    double most = 0;
    for (uint64_t first = 0; first < v.triangle_count; first += BATCH) {
        float x[BATCH], y[BATCH], z[BATCH], f[BATCH];
        size_t n = v.triangle_count - first < BATCH ? (size_t)(v.triangle_count - first) : BATCH;
        for (size_t i = 0; i < n; i++) {
            double at[3] = {v.origin.x, v.origin.y, v.origin.z};
            for (size_t k = 0; k < 9; k++) {
                size_t vertex = v.indices[3 * (first + i) + k / 3];
                at[k % 3] += (double)v.positions[3 * vertex + k % 3] / 3;
            }
            x[i] = (float)at[0];
            y[i] = (float)at[1];
            z[i] = (float)at[2];
        }
        csgm_field_eval(field, x, y, z, f, n);
        for (size_t i = 0; i < n; i++)
            most = fmax(most, fabs((double)f[i]));
    }
    return most;
}

static csgm_mesh *mesh_of(csgm_context *context, const csgm_field *field,
                          const csgm_mesh_options *options, csgm_mesh_stats *stats, uint64_t *count)
{
    csgm_mesh *mesh;
    assert_int_equal(csgm_mesh_build(context, field, options, &mesh, stats), CSGM_OK);
    *count = csgm_mesh_get_view(mesh).triangle_count;
    return mesh;
}

static void a_tenth_of_the_triangles(void **state)
{
    csgm_context *context;
    csgm_scene *scene;
    csgm_field *field;
    csgm_mesh_stats stats = csgm_mesh_stats_default();
    uint64_t few, many;
    (void)state;
    assert_int_equal(csgm_context_create(NULL, &context), CSGM_OK);
    assert_int_equal(csgm_scene_load(context, scene_path, NULL, &scene), CSGM_OK);
    assert_true(csgm_scene_get_info(scene).lipschitz <= 1);
    assert_int_equal(csgm_field_compile(context, scene, &field), CSGM_OK);

    csgm_mesh_options options = csgm_mesh_options_default();
    options.normals = CSGM_NORMALS_NONE;
    options.tolerance = error;
    csgm_mesh *mesh = mesh_of(context, field, &options, &stats, &few);
    print_message("cells of %g, %llu triangles, bound %g, measured %g, open %llu\n",
                  stats.cell_size, (unsigned long long)few, stats.max_distance_bound,
                  stats.max_distance_measured, (unsigned long long)stats.open_places);
    assert_true(stats.max_distance_bound == error);
    assert_true(stats.max_distance_measured <= error);
    assert_true(largest_stray(field, mesh) <= error);
    csgm_mesh_destroy(mesh);

    options.tolerance = 0;
    options.resolution = 64;
    csgm_mesh_destroy(mesh_of(context, field, &options, NULL, &many));
    options.resolution =
        (uint32_t)ceil(options.resolution * sqrt(10.1 * (double)few / (double)many));
    mesh = mesh_of(context, field, &options, NULL, &many);
    double stray = largest_stray(field, mesh);
    print_message("%llu triangles within %g; with %llu of -r %u there are places %g away\n",
                  (unsigned long long)few, error, (unsigned long long)many, options.resolution,
                  stray);
    assert_true(many >= 10 * few);
    assert_true(stray > error);
    csgm_mesh_destroy(mesh);

    csgm_field_destroy(field);
    csgm_scene_destroy(scene);
    csgm_context_destroy(context);
}

int main(int argc, char **argv)
{
    if (argc != 3)
        return 2;
    scene_path = argv[1];
    error = strtod(argv[2], NULL);
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_tenth_of_the_triangles)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
