/* SPDX-License-Identifier: MIT
 * Meshes for the language: what is read is what was written, trouble is told and not reported, a
 * solid becomes triangles, and these a solid again.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
/* cmocka wants the four above first */
#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "api/services.h"
#include "io/formats.h"
#include "scene/tree/build.h"
#include "shape/polyhedra/polyhedron.h"

static int findings;
static char folder[] = "/tmp/csg-services-XXXXXX";

static void count_finding(void *user, const csgm_diag *diag)
{
    (void)user;
    (void)diag;
    findings++;
}

static csgm_context *make_context(uint64_t memory_bytes)
{
    csgm_context_options options = csgm_context_options_default();
    csgm_context *context;
    options.on_diag = count_finding;
    options.threads = 2;
    options.limits.memory_bytes = memory_bytes;
    findings = 0;
    assert_int_equal(csgm_context_create(&options, &context), CSGM_OK);
    return context;
}

static void write_file(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0);
    assert_int_equal(fclose(file), 0);
}

static const char *path_of(const char *name)
{
    static char path[200];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

static csgm_scene *ball_scene(csgm_context *context, double r)
{
    csg_scene_builder builder;
    csgm_scene *scene;
    assert_int_equal(csg_build_begin(&builder, context), CSGM_OK);
    csg_node_id root = csg_build_ball(&builder, r, (csg_span){0});
    assert_int_equal(csg_build_finish(&builder, root, NULL, 0, &scene), CSGM_OK);
    return scene;
}

static double radius_error(const csg_triangles *triangles, double r)
{
    double worst = 0;
    for (size_t i = 0; i < triangles->point_count; i++)
        worst = fmax(worst, fabs(csg_vec3_norm(triangles->points[i]) - r));
    return worst;
}

static void test_there_and_back(void **state)
{
    csgm_context *context = make_context(1u << 30);
    csgm_scene *scene = ball_scene(context, 2);
    csg_triangles made, read;
    char problem[100] = "?";
    const csg_services *services = csg_api_services();
    assert_int_equal(services->tessellate(context, scene, 40, &made), CSGM_OK);
    assert_true(made.count > 1000 && radius_error(&made, 2) < 1e-4);

    float *positions = malloc(made.point_count * 3 * sizeof *positions);
    for (size_t i = 0; i < made.point_count; i++) {
        positions[3 * i] = (float)made.points[i].x;
        positions[3 * i + 1] = (float)made.points[i].y;
        positions[3 * i + 2] = (float)made.points[i].z;
    }
    csgm_mesh_view view = {.positions = positions,
                           .indices = made.corners[0],
                           .vertex_count = made.point_count,
                           .triangle_count = made.count};
    const char *path = path_of("ball.stl");
    assert_int_equal(csgm_mesh_write(context, &view, path, CSGM_FORMAT_AUTO, NULL), CSGM_OK);
    free(positions);
    assert_int_equal(services->read_mesh(context, path, &read, problem, sizeof problem), CSGM_OK);
    assert_string_equal(problem, "");
    assert_int_equal(read.count, made.count);
    assert_int_equal(read.point_count, made.point_count);
    assert_true(radius_error(&read, 2) < 1e-4);
    assert_int_equal(findings, 0);
    csg_triangles_release(&made);
    csg_triangles_release(&read);
    csg_scene_destroy(scene);
    csgm_context_destroy(context);
}

static void test_trouble(void **state)
{
    csgm_context *context = make_context(1u << 30);
    const csg_services *services = csg_api_services();
    csg_triangles triangles;
    char problem[100];
    struct {
        const char *name, *text, *says;
        csgm_status status;
    } cases[] = {{"none.stl", NULL, "No such file", CSGM_ERR_IO},
                 {"bad.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n", "line ", CSGM_ERR_FORMAT},
                 {"bad.xyz", "what", "", CSGM_ERR_UNSUPPORTED}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const char *path = path_of(cases[i].name);
        if (cases[i].text)
            write_file(path, cases[i].text);
        assert_int_equal(services->read_mesh(context, path, &triangles, problem, sizeof problem),
                         cases[i].status);
        assert_non_null(strstr(problem, cases[i].says));
        assert_true(strlen(problem) > 5 && strchr(problem, '\n') == NULL);
        assert_int_equal(triangles.count, 0);
        assert_true(strlen(problem) < sizeof problem);
    }
    assert_int_equal(services->read_mesh(context, path_of("bad.off"), &triangles, problem, 8),
                     CSGM_ERR_FORMAT);
    assert_int_equal(strlen(problem), 7);
    assert_int_equal(findings, 0);
    csgm_context_destroy(context);
}

static void test_no_surface(void **state)
{
    csgm_context *context = make_context(1u << 30);
    csg_scene_builder builder;
    csgm_scene *scene;
    csg_triangles triangles;
    assert_int_equal(csg_build_begin(&builder, context), CSGM_OK);
    csg_node_id root = csg_build_empty(&builder, (csg_span){0});
    assert_int_equal(csg_build_finish(&builder, root, NULL, 0, &scene), CSGM_OK);
    csg_api_services()->tessellate(context, scene, 40, &triangles);
    assert_int_equal(triangles.count, 0);
    assert_int_equal(findings, 0);
    csg_scene_destroy(scene);
    csgm_context_destroy(context);
}

/* Ball -> triangles -> solid -> triangles again. */
static void test_solid_again(void **state)
{
    csgm_context *context = make_context(1u << 30);
    const csg_services *services = csg_api_services();
    csgm_scene *scene = ball_scene(context, 2), *again;
    csg_triangles made, twice;
    csg_repairs repairs;
    csg_shape *shape;
    csg_scene_builder builder;
    assert_int_equal(services->tessellate(context, scene, 40, &made), CSGM_OK);
    assert_int_equal(csg_polyhedron_create(&context->memory, &made, &repairs, &shape), CSGM_OK);
    csg_repairs nothing = {0};
    assert_memory_equal(&repairs, &nothing, sizeof nothing);
    assert_int_equal(csg_build_begin(&builder, context), CSGM_OK);
    csg_node_id root = csg_build_offset(
        &builder, 0.5, csg_build_shape(&builder, shape, (csg_span){0}), (csg_span){0});
    assert_int_equal(csg_build_finish(&builder, root, NULL, 0, &again), CSGM_OK);
    assert_int_equal(services->tessellate(context, again, 50, &twice), CSGM_OK);
    assert_true(twice.count > 1000 && radius_error(&twice, 2.5) < 0.01);
    assert_int_equal(findings, 0);
    csg_triangles_release(&made);
    csg_triangles_release(&twice);
    csg_scene_destroy(scene);
    csg_scene_destroy(again);
    csgm_context_destroy(context);
}

static void test_out_of_memory(void **state)
{
    bool done = false;
    for (uint64_t limit = 100000; !done; limit += limit / 8) {
        csgm_context *context = make_context(0);
        csgm_scene *scene = ball_scene(context, 2);
        csg_triangles made;
        uint64_t used = context->memory.used_bytes;
        context->memory.limit_bytes = used + limit;
        csgm_status status = csg_api_services()->tessellate(context, scene, 30, &made);
        assert_true(status == CSGM_OK || (status == CSGM_ERR_MEMORY && made.count == 0));
        done = status == CSGM_OK;
        csg_triangles_release(&made);
        assert_int_equal(context->memory.used_bytes, used);
        assert_int_equal(findings, 0);
        csg_scene_destroy(scene);
        csgm_context_destroy(context);
    }
}

static int clean_up(void **state)
{
    static const char *const names[] = {"ball.stl", "bad.off", "bad.xyz"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        unlink(path_of(names[i]));
    return rmdir(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_there_and_back), cmocka_unit_test(test_trouble),
        cmocka_unit_test(test_no_surface),     cmocka_unit_test(test_solid_again),
        cmocka_unit_test(test_out_of_memory),
    };
    if (!mkdtemp(folder))
        return 1;
    return cmocka_run_group_tests(tests, NULL, clean_up);
}
