/* SPDX-License-Identifier: MIT
 * Whatever a context is at, its `cancelled` ends it: with CSGM_CANCELLED, without a finding, and
 * the context goes on afterwards. Many points give what single ones give. A context that rests
 * works.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
/* cmocka wants the four above first */
#include <cmocka.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "csgmesh/csgmesh.h"

typedef struct watcher {
    atomic_int asked, left; /* how often it says no; negative: always */
    int findings;
} watcher;

static bool is_cancelled(void *user)
{
    watcher *w = user;
    atomic_fetch_add(&w->asked, 1);
    int left = atomic_load(&w->left);
    return left == 0 || (left > 0 && atomic_fetch_sub(&w->left, 1) <= 1);
}

static void count_finding(void *user, const csgm_diag *diag)
{
    watcher *w = user;
    w->findings++;
    print_message("%s\n", diag->message);
}

static csgm_context *make_context(watcher *w, uint32_t threads)
{
    csgm_context_options options = csgm_context_options_default();
    csgm_context *context;
    *w = (watcher){.left = -1};
    options.on_diag = count_finding;
    options.cancelled = is_cancelled;
    options.user = w;
    options.threads = threads;
    assert_int_equal(csgm_context_create(&options, &context), CSGM_OK);
    return context;
}

static csgm_scene *parse(csgm_context *context, const char *text)
{
    csgm_scene *scene;
    assert_int_equal(csgm_scene_parse(context, text, strlen(text), "a.txt", NULL, &scene), CSGM_OK);
    return scene;
}

/* It is asked, and from the first, the third or the thirtieth time on it says yes. */
static void assert_scene_stops(csgm_context *context, watcher *w, const char *text)
{
    static const int after[] = {0, 3, 30};
    for (size_t i = 0; i < sizeof after / sizeof *after; i++) {
        csgm_scene *scene;
        atomic_store(&w->left, after[i]);
        assert_int_equal(csgm_scene_parse(context, text, strlen(text), "a.txt", NULL, &scene),
                         CSGM_CANCELLED);
        assert_null(scene);
        assert_int_equal(w->findings, 0);
    }
    atomic_store(&w->left, -1);
    csgm_scene_destroy(parse(context, "sphere(1);"));
}

static void test_scenes(void **state)
{
    watcher w;
    csgm_context *context = make_context(&w, 2);
    assert_scene_stops(context, &w,
                       "for (i = [0 : 99999]) for (j = [0 : 99999]) if (i < 0) sphere(i);");
    assert_scene_stops(context, &w,
                       "x = [for (i = [0 : 999]) for (j = [0 : 9999]) i + j]; cube(len(x));");
    assert_scene_stops(context, &w, "function f(x) = x > 9e7 ? 1 : f(x + 1); sphere(f(0));");
    /* a tessellation below */
    assert_scene_stops(context, &w,
                       "hull() difference() { sphere(9); cube(9); }"
                       "for (i = [0 : 99999]) for (j = [0 : 99999]) if (i < 0) sphere(i);");
    char *many = malloc(1 << 20), *at = many;
    for (int i = 0; i < 5000; i++)
        at += sprintf(at, "a%d = %d;\n", i, i);
    sprintf(at, "sphere(1);");
    assert_scene_stops(context, &w, many); /* while it is parsed */
    free(many);
    csgm_context_destroy(context);
}

static void test_meshes_and_pictures(void **state)
{
    watcher w;
    csgm_context *context = make_context(&w, 2);
    csgm_scene *scene = parse(context, "union(blend = 1) { sphere(5); cube(6); }");
    csgm_field *field;
    csgm_mesh *mesh, *none;
    csgm_image *image;
    csgm_diff *diff;
    assert_int_equal(csgm_field_compile(context, scene, &field), CSGM_OK);
    assert_int_equal(csgm_mesh_build(context, field, NULL, &mesh, NULL), CSGM_OK);
    csgm_mesh_view view = csgm_mesh_get_view(mesh);
    atomic_store(&w.left, 5);
    assert_int_equal(csgm_mesh_build(context, field, NULL, &none, NULL), CSGM_CANCELLED);
    assert_null(none);
    assert_int_equal(csgm_render_scene(context, field, NULL, &image, NULL), CSGM_CANCELLED);
    assert_int_equal(csgm_render_mesh(context, &view, NULL, &image, NULL), CSGM_CANCELLED);
    assert_int_equal(csgm_mesh_build_file(context, field, NULL, "cancelled.ply", CSGM_FORMAT_AUTO,
                                          NULL, NULL, NULL),
                     CSGM_CANCELLED);
    assert_int_not_equal(access("cancelled.ply", F_OK), 0);
    float *moved = malloc(view.vertex_count * 3 * sizeof(float));
    for (size_t i = 0; i < view.vertex_count * 3; i++)
        moved[i] = view.positions[i] * 1.01F;
    csgm_mesh_view other = view;
    other.positions = moved;
    assert_int_equal(csgm_diff_meshes(context, &view, &other, NULL, &diff), CSGM_CANCELLED);
    assert_int_equal(w.findings, 0);
    atomic_store(&w.left, -1);
    assert_int_equal(csgm_diff_meshes(context, &view, &other, NULL, &diff), CSGM_OK);
    csgm_diff_destroy(diff);
    free(moved);
    csgm_mesh_destroy(mesh);
    csgm_field_destroy(field);
    csgm_scene_destroy(scene);
    csgm_context_destroy(context);
}

/* Readers, by themselves and below import(). */
static void test_readers(void **state)
{
    static const char *const names[] = {"cancel.obj",  "cancel.ply", "cancel.stl", "cancel.off",
                                        "cancel.gltf", "cancel.3mf", "cancel.amf"};
    watcher w;
    csgm_context *context = make_context(&w, 2);
    csgm_scene *scene = parse(context, "sphere(5);");
    csgm_field *field;
    csgm_mesh *mesh, *read;
    csgm_mesh_options options = csgm_mesh_options_default();
    options.resolution = 48;
    assert_int_equal(csgm_field_compile(context, scene, &field), CSGM_OK);
    assert_int_equal(csgm_mesh_build(context, field, &options, &mesh, NULL), CSGM_OK);
    csgm_mesh_view view = csgm_mesh_get_view(mesh);
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        char text[64];
        csgm_format format = csgm_format_from_path(names[i]);
        if (!csgm_format_available(format, true) || !csgm_format_available(format, false))
            continue;
        assert_int_equal(csgm_mesh_write(context, &view, names[i], format, NULL), CSGM_OK);
        atomic_store(&w.left, 2);
        atomic_store(&w.asked, 0);
        csgm_status status = csgm_mesh_read(context, names[i], format, &read);
        print_message("%s: asked %d times\n", names[i], w.asked);
        assert_int_equal(status, CSGM_CANCELLED);
        assert_null(read);
        snprintf(text, sizeof text, "import(\"%s\");", names[i]);
        assert_scene_stops(context, &w, text);
        unlink(names[i]);
    }
    assert_int_equal(w.findings, 0);
    csgm_mesh_destroy(mesh);
    csgm_field_destroy(field);
    csgm_scene_destroy(scene);
    csgm_context_destroy(context);
}

/* Parses with these options, and is cancelled at half of the questions and at the last of them. */
static void assert_stops_late(csgm_context *context, watcher *w, const char *text,
                              const csgm_scene_options *options, int least)
{
    csgm_scene *scene;
    atomic_store(&w->left, -1);
    atomic_store(&w->asked, 0);
    assert_int_equal(csgm_scene_parse(context, text, strlen(text), "a.txt", options, &scene),
                     CSGM_OK);
    csgm_scene_destroy(scene);
    int asked = atomic_load(&w->asked);
    print_message("asked %d times\n", asked);
    assert_true(asked >= least);
    for (int left = asked / 2; left < asked; left += asked - asked / 2 - 1) {
        atomic_store(&w->left, left);
        assert_int_equal(csgm_scene_parse(context, text, strlen(text), "a.txt", options, &scene),
                         CSGM_CANCELLED);
        assert_null(scene);
    }
    atomic_store(&w->left, -1);
}

/* The layers of a flat scene, traced where a blend is; and an import that is mended: a comb of
 * open triangles, whose reading asks three times and whose mending does it often. */
static void test_drawings_and_repairs(void **state)
{
    enum { TEETH = 700 };
    watcher w;
    csgm_context *context = make_context(&w, 1);
    csgm_scene_options options = csgm_scene_options_default();
    options.flat = CSGM_FLAT_DRAWING;
    if (csgm_format_available(CSGM_FORMAT_STL, false))
        assert_stops_late(context, &w, "union(blend = 1) { circle(5); square(6); }", &options,
                          1000);
    FILE *file = fopen("comb.off", "w");
    assert_non_null(file);
    fprintf(file, "OFF\n%d %d 0\n", 4 * TEETH, 3 * TEETH);
    for (int i = 0; i < TEETH; i++)
        fprintf(file, "%d 0 0\n%d 1 0\n%d 0 1\n%d.5 0 0\n", i, i, i, i);
    for (int i = 0; i < 4 * TEETH; i += 4) /* a tetrahedron without its last side */
        fprintf(file, "3 %d %d %d\n3 %d %d %d\n3 %d %d %d\n", i, i + 1, i + 3, i + 1, i + 2, i + 3,
                i + 2, i, i + 3);
    fclose(file);
    assert_stops_late(context, &w, "import(\"comb.off\");", NULL, TEETH);
    unlink("comb.off");
    csgm_context_destroy(context);
}

/* Wherever meshes whose cells follow the shape are: also where creases are taken back that are none
 * (the tight rounding), on one thread, so that every run asks the same. */
static void test_adaptive_meshes(void **state)
{
    enum { TRIED = 24 };
    watcher w;
    csgm_context *context = make_context(&w, 1);
    csgm_scene *scene =
        parse(context, "difference(blend = 0.4) { cube([9, 8, 7]); sphere(r = 5); }");
    csgm_field *field;
    csgm_mesh *mesh;
    csgm_mesh_options options = csgm_mesh_options_default();
    options.quality = CSGM_QUALITY_DRAFT;
    assert_int_equal(csgm_field_compile(context, scene, &field), CSGM_OK);
    atomic_store(&w.asked, 0);
    assert_int_equal(csgm_mesh_build(context, field, &options, &mesh, NULL), CSGM_OK);
    csgm_mesh_destroy(mesh);
    int asked = atomic_load(&w.asked);
    print_message("asked %d times\n", asked);
    for (int i = 0; i < TRIED; i++) { /* the later ones are nearer to each other */
        int late = asked - 1 - (i < 16 ? i : (i - 15) * (asked - 17) / (TRIED - 15));
        atomic_store(&w.left, late);
        assert_int_equal(csgm_mesh_build(context, field, &options, &mesh, NULL), CSGM_CANCELLED);
        assert_null(mesh);
    }
    assert_int_equal(w.findings, 0);
    csgm_field_destroy(field);
    csgm_scene_destroy(scene);
    csgm_context_destroy(context);
}

static void test_points(void **state)
{
    enum { COUNT = 1000 };
    static double points[3 * COUNT], values[COUNT], gradients[3 * COUNT], again[COUNT];
    watcher w;
    for (uint32_t threads = 1; threads <= 4; threads += 3) {
        csgm_context *context = make_context(&w, threads);
        csgm_scene *scene =
            parse(context, "difference(blend = 1) { sphere(5); rotate(30) cube(6); }");
        for (int i = 0; i < 3 * COUNT; i++)
            points[i] = (i * 7919 % 1601) / 100.0 - 8;
        assert_int_equal(csgm_scene_eval_points(context, scene, points, COUNT, values, gradients),
                         CSGM_OK);
        csgm_context_rest(context); /* its workers are started again */
        csgm_context_rest(context);
        assert_int_equal(csgm_scene_eval_points(context, scene, points, COUNT, again, NULL),
                         CSGM_OK);
        for (int i = 0; i < COUNT; i++) {
            csgm_vec3 gradient;
            csgm_vec3 at = {points[3 * i], points[3 * i + 1], points[3 * i + 2]};
            double value = csgm_scene_eval(scene, at, &gradient);
            assert_memory_equal(&value, values + i, sizeof value);
            assert_memory_equal(&value, again + i, sizeof value);
            assert_memory_equal(&gradient, gradients + 3 * i, sizeof gradient);
        }
        assert_int_equal(csgm_scene_eval_points(context, scene, NULL, 0, NULL, NULL), CSGM_OK);
        assert_int_equal(csgm_scene_eval_points(context, scene, NULL, 1, values, NULL),
                         CSGM_ERR_ARGUMENT);
        atomic_store(&w.left, 3);
        assert_int_equal(csgm_scene_eval_points(context, scene, points, COUNT, values, NULL),
                         CSGM_CANCELLED);
        assert_int_equal(w.findings, 0);
        csgm_scene_destroy(scene);
        csgm_context_destroy(context);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_scenes),          cmocka_unit_test(test_meshes_and_pictures),
        cmocka_unit_test(test_readers),         cmocka_unit_test(test_drawings_and_repairs),
        cmocka_unit_test(test_adaptive_meshes), cmocka_unit_test(test_points),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
