/* SPDX-License-Identifier: MIT
 * The public interface as a C program uses it: broken contracts are refused, long calls can be
 * watched and stopped, memory is balanced, and any allocation may fail.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "counting.h"
#include "csgmesh/csgmesh.h"

static const char scene_text[] = "union(blend = 0.3) {\n"
                                 "  sphere(r = 1);\n"
                                 "  translate([0.8, 0, 0]) color(\"red\") cube(0.9);\n"
                                 "}\n";

typedef struct findings {
    int errors, warnings;
    uint16_t last_code;
} findings;

static void count_finding(void *user, const csgm_diag *diag)
{
    findings *found = user;
    found->errors += diag->severity == CSGM_ERROR;
    found->warnings += diag->severity == CSGM_WARNING;
    found->last_code = diag->code;
    assert_non_null(diag->message);
}

/* ---- the whole way ------------------------------------------------------------------------ */

typedef struct run {
    csgm_context *context;
    csgm_scene *scene;
    csgm_field *field;
    csgm_mesh *mesh, *cells;
    csgm_mesh_check check;
} run;

static csgm_status go(run *r, const csgm_context_options *options, const char *text,
                      const csgm_mesh_options *mesh_options)
{
    *r = (run){0};
    csgm_status status = csgm_context_create(options, &r->context);
    if (status == CSGM_OK)
        status = csgm_scene_parse(r->context, text, strlen(text), "test", NULL, &r->scene);
    if (status == CSGM_OK)
        status = csgm_field_compile(r->context, r->scene, &r->field);
    if (status == CSGM_OK)
        status = csgm_survey_begin(r->context);
    if (status == CSGM_OK)
        status = csgm_mesh_build(r->context, r->field, mesh_options, &r->mesh, NULL);
    if (status == CSGM_OK)
        status = csgm_survey_end(r->context, &r->cells);
    if (status == CSGM_OK) {
        csgm_mesh_view view = csgm_mesh_get_view(r->mesh);
        status = csgm_mesh_inspect(r->context, &view, &r->check);
        for (int f = CSGM_FORMAT_OBJ; f < CSGM_FORMAT_COUNT && status == CSGM_OK; f++)
            if (csgm_format_available((csgm_format)f, false))
                status = csgm_mesh_write(r->context, &view, "/dev/null", (csgm_format)f, NULL);
    }
    return status;
}

static void end(run *r)
{
    csgm_mesh_destroy(r->mesh);
    csgm_mesh_destroy(r->cells);
    csgm_field_destroy(r->field);
    csgm_scene_destroy(r->scene);
    csgm_context_destroy(r->context);
}

static csgm_mesh_options coarse(void)
{
    csgm_mesh_options options = csgm_mesh_options_default();
    options.resolution = 24;
    return options;
}

static void test_the_whole_way(void **state)
{
    csgm_mesh_options options = coarse();
    run r;
    assert_int_equal(go(&r, NULL, scene_text, &options), CSGM_OK);
    assert_int_equal(r.check.boundary_edges + r.check.nonmanifold_edges +
                         r.check.misoriented_edges + r.check.nonmanifold_vertices,
                     0);
    assert_int_equal(r.check.components, 1);
    csgm_mesh_view view = csgm_mesh_get_view(r.mesh);
    assert_non_null(view.normals);
    assert_non_null(view.colors);
    assert_true(csgm_mesh_max_abs_field(r.scene, &view, NULL) < 1e-4);
    csgm_scene_info info = csgm_scene_get_info(r.scene);
    assert_int_equal(info.primitive_count, 2);
    assert_int_equal(info.operator_count, 1);
    assert_true(info.has_colors);
    end(&r);
}

static void test_survey(void **state)
{
    static const char *const names[] = {"octree", "blocks", "features"};
    csgm_mesh_options options = coarse();
    csgm_mesh *cells = NULL;
    run r;
    assert_int_equal(csgm_survey_begin(NULL), CSGM_ERR_ARGUMENT);
    assert_int_equal(csgm_survey_end(NULL, &cells), CSGM_ERR_ARGUMENT);
    assert_int_equal(go(&r, NULL, scene_text, &options), CSGM_OK);
    csgm_mesh_view view = csgm_mesh_get_view(r.cells);
    assert_int_equal(view.part_count, 3);
    for (int i = 0; i < 3; i++)
        assert_string_equal(view.parts[i].name, names[i]);
    assert_true(view.triangle_count % 12 == 0 && view.triangle_count > 1000);
    assert_int_equal(csgm_survey_end(r.context, &cells), CSGM_ERR_ARGUMENT);
    assert_int_equal(csgm_survey_begin(r.context), CSGM_OK);
    assert_int_equal(csgm_survey_begin(r.context), CSGM_ERR_ARGUMENT);
    end(&r); /* and what was begun */
}

static void test_field_agrees_with_the_reference(void **state)
{
    csgm_mesh_options options = coarse();
    run r;
    assert_int_equal(go(&r, NULL, scene_text, &options), CSGM_OK);
    enum { COUNT = 1000 };
    float x[COUNT], y[COUNT], z[COUNT], value[COUNT];
    for (int i = 0; i < COUNT; i++) {
        x[i] = (float)(i % 10) / 4 - 1;
        y[i] = (float)(i / 10 % 10) / 4 - 1;
        z[i] = (float)(i / 100) / 4 - 1;
    }
    csgm_field_eval(r.field, x, y, z, value, COUNT);
    for (int i = 0; i < COUNT; i++) {
        csgm_vec3 gradient;
        double exact = csgm_scene_eval(r.scene, (csgm_vec3){x[i], y[i], z[i]}, &gradient);
        assert_true(fabs(value[i] - exact) < 1e-5);
        assert_true(hypot(hypot(gradient.x, gradient.y), gradient.z) < 1 + 1e-9);
    }
    end(&r);
}

/* ---- contracts ---------------------------------------------------------------------------- */

static void test_destroy_of_nothing(void **state)
{
    csgm_context_destroy(NULL);
    csgm_scene_destroy(NULL);
    csgm_field_destroy(NULL);
    csgm_mesh_destroy(NULL);
}

static void test_options_not_made_by_default(void **state)
{
    csgm_context_options options = csgm_context_options_default();
    csgm_context *context = (csgm_context *)&options;
    options.struct_size--;
    assert_int_equal(csgm_context_create(&options, &context), CSGM_ERR_ARGUMENT);
    assert_null(context);
    options = csgm_context_options_default();
    options.allocator.alloc = counting_alloc; /* and no release */
    assert_int_equal(csgm_context_create(&options, &context), CSGM_ERR_ARGUMENT);
    assert_int_equal(csgm_context_create(NULL, NULL), CSGM_ERR_ARGUMENT);

    csgm_mesh_options mesh_options = coarse();
    mesh_options.struct_size = 0;
    run r;
    assert_int_equal(go(&r, NULL, scene_text, &mesh_options), CSGM_ERR_ARGUMENT);
    assert_null(r.mesh);
    end(&r);
    mesh_options = coarse(); /* two goals of thinning out */
    mesh_options.simplify_error = 0.1;
    mesh_options.simplify_share = 0.5;
    assert_int_equal(go(&r, NULL, scene_text, &mesh_options), CSGM_ERR_ARGUMENT);
    assert_null(r.mesh);
    end(&r);
}

/* The sizes that a struct may have: its own, and a shorter one that another release had. Members
 * behind it have their defaults, whatever lies there. */
static void test_options_of_other_versions(void **state)
{
    csgm_mesh_options options = csgm_mesh_options_default();
    const uint32_t own = options.struct_size;
    const uint32_t refused[] = {0, 8, own - 1, own + 1, own + 8, 0x5A5A5A58, UINT32_MAX};
    run r;
    for (size_t i = 0; i < sizeof refused / sizeof *refused; i++) {
        options = coarse();
        options.struct_size = refused[i];
        assert_int_equal(go(&r, NULL, scene_text, &options), CSGM_ERR_ARGUMENT);
        assert_null(r.mesh);
        end(&r);
    }
    uint64_t triangles;
    options = coarse();
    assert_int_equal(go(&r, NULL, scene_text, &options), CSGM_OK);
    triangles = csgm_mesh_get_view(r.mesh).triangle_count;
    end(&r);
    const uint32_t shorter = offsetof(csgm_mesh_options, tolerance);
    assert_true(shorter < own);
    memset((char *)&options + shorter, 0xFF, own - shorter); /* beyond the caller's struct */
    options.struct_size = shorter;
    assert_int_equal(go(&r, NULL, scene_text, &options), CSGM_OK);
    assert_int_equal(csgm_mesh_get_view(r.mesh).triangle_count, triangles);
    end(&r);
}

/* Within the tolerance of another solid: of its mesh, and of none where there is no size. */
static void test_tolerance_of_a_quality(void **state)
{
    const csgm_box box = {{-1, 0, 0}, {1, 1, 1}}; /* its longest side is 2 */
    csgm_box endless = box, none = csgm_mesh_options_default().bounds,
             point = {{1, 1, 1}, {1, 1, 1}};
    run r;
    (void)state;
    endless.max.x = INFINITY;
    assert_true(csgm_quality_tolerance(CSGM_QUALITY_DRAFT, box) == 0x1p-7);
    assert_true(csgm_quality_tolerance(CSGM_QUALITY_NORMAL, box) == 0x1p-9);
    assert_true(csgm_quality_tolerance(CSGM_QUALITY_FINE, box) == 0x1p-11);
    assert_true(csgm_quality_tolerance((csgm_quality)99, box) == 0);
    assert_true(csgm_quality_tolerance(CSGM_QUALITY_DRAFT, endless) == 0);
    assert_true(csgm_quality_tolerance(CSGM_QUALITY_DRAFT, none) == 0);
    assert_true(csgm_quality_tolerance(CSGM_QUALITY_DRAFT, point) == 0);
    csgm_mesh_options options = csgm_mesh_options_default();
    options.quality = CSGM_QUALITY_DRAFT;
    assert_int_equal(go(&r, NULL, "sphere(1);", &options), CSGM_OK);
    uint64_t own = csgm_mesh_get_view(r.mesh).triangle_count;
    end(&r);
    options.simplify_error = csgm_quality_tolerance(CSGM_QUALITY_DRAFT, box);
    assert_int_equal(go(&r, NULL, "sphere(1);", &options), CSGM_OK);
    assert_int_equal(csgm_mesh_get_view(r.mesh).triangle_count, own);
    end(&r);
}

/* Few enough triangles, and no cluster is larger than a cell. */
static void test_clusters(void **state)
{
    enum { MOST = 500 };
    run r;
    csgm_mesh_options options = coarse();
    options.resolution = 40;
    assert_int_equal(go(&r, NULL, scene_text, &options), CSGM_OK);
    csgm_mesh_view view = csgm_mesh_get_view(r.mesh);
    csgm_mesh_check check;
    assert_int_equal(csgm_mesh_inspect(r.context, &view, &check), CSGM_OK);
    assert_true(view.triangle_count > 4 * MOST);
    uint32_t *cluster_of = malloc(view.vertex_count * sizeof *cluster_of), count;
    double cell;
    assert_int_equal(
        csgm_mesh_cluster(r.context, &view, check.bounds, MOST, cluster_of, &count, &cell),
        CSGM_OK);
    uint64_t left = 0;
    for (uint64_t t = 0; t < view.triangle_count; t++) {
        uint32_t c[3];
        for (int k = 0; k < 3; k++)
            c[k] = cluster_of[view.indices[3 * t + (uint64_t)k]];
        left += c[0] != c[1] && c[1] != c[2] && c[2] != c[0];
    }
    assert_in_range(left, MOST / 4, MOST);
    for (uint64_t i = 0; i < view.vertex_count; i++) {
        assert_true(cluster_of[i] < count);
        for (uint64_t k = i + 1; k < view.vertex_count && k < i + 50; k++)
            for (int axis = 0; axis < 3 && cluster_of[i] == cluster_of[k]; axis++)
                assert_true(fabs((double)view.positions[3 * i + (uint64_t)axis] -
                                 (double)view.positions[3 * k + (uint64_t)axis]) <= cell * 1.0001);
    }
    assert_int_equal(csgm_mesh_cluster(r.context, &view, check.bounds, view.triangle_count,
                                       cluster_of, &count, &cell),
                     CSGM_OK);
    assert_true(cell == 0 && count == view.vertex_count && cluster_of[count - 1] == count - 1);
    static const uint32_t outside[3] = {0, 1, UINT32_MAX};
    view.indices = outside;
    view.triangle_count = 1;
    assert_int_equal(
        csgm_mesh_cluster(r.context, &view, check.bounds, 0, cluster_of, &count, &cell),
        CSGM_ERR_ARGUMENT);
    free(cluster_of);
    end(&r);
}

static void test_params(void **state)
{
    static const char text[] = "// how wide\nwidth = 3; // [1:5]\ncube(width);\n";
    csgm_define define = {"width", "4"};
    csgm_scene_options options = csgm_scene_options_default();
    csgm_context *context;
    csgm_params *params;
    (void)state;
    options.defines = &define;
    options.define_count = 1;
    assert_int_equal(csgm_context_create(NULL, &context), CSGM_OK);
    assert_int_equal(csgm_params_parse(context, text, sizeof text - 1, "a.txt", &options, &params),
                     CSGM_OK);
    const csgm_param *param = csgm_params_get(params, 0);
    assert_non_null(param);
    assert_null(csgm_params_get(params, 1));
    assert_string_equal(param->name, "width");
    assert_string_equal(param->description, "how wide");
    assert_true(param->initial.numbers[0] == 3 && param->value.numbers[0] == 4);
    assert_true(param->minimum == 1 && param->maximum == 5 && isnan(param->step));
    csgm_params_destroy(params);
    assert_int_equal(csgm_params_load(context, "/nowhere/a.txt", NULL, &params), CSGM_ERR_IO);
    assert_null(params);
    options.parameter_set = "a set of no file";
    assert_int_equal(csgm_params_parse(context, text, sizeof text - 1, "a", &options, &params),
                     CSGM_ERR_ARGUMENT);
    assert_int_equal(csgm_params_parse(context, text, sizeof text - 1, "a", NULL, NULL),
                     CSGM_ERR_ARGUMENT);
    assert_int_equal(csgm_params_parse(NULL, text, sizeof text - 1, "a", NULL, &params),
                     CSGM_ERR_ARGUMENT);
    csgm_params_destroy(NULL);
    csgm_context_destroy(context);
}

/* Only checked: findings and statuses as ever, and no scene. */
static void test_only_check(void **state)
{
    (void)state;
    const char good[] = "hull() { sphere(1); cube(3); }", bad[] = "hull() { torus(-1); }";
    csgm_context *context;
    csgm_scene *scene = NULL;
    csgm_scene_options options = csgm_scene_options_default();
    options.only_check = true;
    assert_int_equal(csgm_context_create(NULL, &context), CSGM_OK);
    assert_int_equal(csgm_scene_parse(context, good, strlen(good), "t", &options, &scene), CSGM_OK);
    assert_null(scene);
    assert_int_equal(csgm_scene_parse(context, bad, strlen(bad), "t", &options, &scene),
                     CSGM_ERR_SCENE);
    assert_null(scene);
    csgm_context_destroy(context);
}

static void test_null_arguments(void **state)
{
    csgm_context *context;
    assert_int_equal(csgm_context_create(NULL, &context), CSGM_OK);
    csgm_scene *scene = NULL;
    csgm_field *field = NULL;
    csgm_mesh *mesh = NULL;
    assert_int_equal(csgm_scene_parse(NULL, "", 0, "t", NULL, &scene), CSGM_ERR_ARGUMENT);
    assert_int_equal(csgm_scene_parse(context, NULL, 1, "t", NULL, &scene), CSGM_ERR_ARGUMENT);
    assert_int_equal(csgm_scene_parse(context, "", 0, "t", NULL, NULL), CSGM_ERR_ARGUMENT);
    assert_int_equal(csgm_scene_load(context, NULL, NULL, &scene), CSGM_ERR_ARGUMENT);
    assert_int_equal(csgm_field_compile(context, NULL, &field), CSGM_ERR_ARGUMENT);
    assert_int_equal(csgm_mesh_build(context, NULL, NULL, &mesh, NULL), CSGM_ERR_ARGUMENT);
    assert_int_equal(csgm_mesh_read(context, NULL, CSGM_FORMAT_PLY, &mesh), CSGM_ERR_ARGUMENT);
    csgm_mesh_view view = {.vertex_count = 3};
    csgm_mesh_check check;
    assert_int_equal(csgm_mesh_inspect(context, &view, &check), CSGM_ERR_ARGUMENT);
    assert_int_equal(csgm_mesh_write(context, &view, "/dev/null", CSGM_FORMAT_PLY, NULL),
                     CSGM_ERR_ARGUMENT);
    assert_int_equal(csgm_format_from_name(NULL), CSGM_FORMAT_AUTO);
    assert_int_equal(csgm_format_from_path(NULL), CSGM_FORMAT_AUTO);
    assert_null(scene);
    assert_null(mesh);
    csgm_context_destroy(context);
}

static void test_names(void **state)
{
    assert_string_equal(csgm_version(), PROJECT_VERSION);
    assert_string_equal(csgm_status_name(CSGM_ERR_SYNTAX), "ERR_SYNTAX");
    assert_string_equal(csgm_status_name((csgm_status)999), "unknown");
    for (int f = CSGM_FORMAT_OBJ; f < CSGM_FORMAT_COUNT; f++)
        assert_int_equal(csgm_format_from_name(csgm_format_name((csgm_format)f)), f);
}

static void test_findings_reach_the_caller(void **state)
{
    findings found = {0};
    csgm_context_options options = csgm_context_options_default();
    options.on_diag = count_finding;
    options.user = &found;
    run r;
    assert_int_equal(go(&r, &options, "sphere(r = );\n", NULL), CSGM_ERR_SYNTAX);
    assert_true(found.errors > 0);
    assert_null(r.scene);
    end(&r);
    found = (findings){0};
    assert_int_equal(go(&r, &options, "nosuchsolid();\n", NULL), CSGM_ERR_SCENE);
    assert_int_equal(found.errors, 1);
    end(&r);
}

/* ---- watching and stopping ------------------------------------------------------------------ */

typedef struct watch {
    int calls, looks, stop_at;
    double last;
    csgm_stage stage;
    bool fell;
} watch;

static void on_progress(void *user, csgm_stage stage, double fraction)
{
    watch *w = user;
    w->fell = w->fell || (stage == w->stage && w->calls && fraction < w->last);
    w->calls++;
    w->last = fraction;
    w->stage = stage;
}

static bool on_look(void *user)
{
    watch *w = user;
    int looks = __atomic_add_fetch(&w->looks, 1, __ATOMIC_RELAXED);
    return w->stop_at && looks >= w->stop_at;
}

/* resolution 0: cells follow the shape */
static void cancel_anywhere(uint32_t resolution)
{
    watch w = {0};
    csgm_mesh_options options = csgm_mesh_options_default();
    options.resolution = resolution;
    options.monitor = (csgm_monitor){on_progress, on_look, &w};
    run r;
    assert_int_equal(go(&r, NULL, scene_text, &options), CSGM_OK);
    assert_true(w.looks > 10);
    assert_false(w.fell);
    end(&r);
    int all = w.looks;
    for (int stop_at = 1; stop_at <= all; stop_at += 1 + all / 20) {
        w = (watch){.stop_at = stop_at};
        counting memory = {0};
        csgm_context_options context_options = csgm_context_options_default();
        context_options.allocator = (csgm_allocator){counting_alloc, counting_release, &memory};
        csgm_status status = go(&r, &context_options, scene_text, &options);
        assert_true(status == CSGM_CANCELLED || (w.looks < stop_at && status == CSGM_OK));
        assert_true(status == CSGM_OK || r.mesh == NULL);
        end(&r);
        assert_int_equal(memory.bytes, 0);
    }
}

static void test_cancel(void **state)
{
    cancel_anywhere(128);
    cancel_anywhere(0);
}

/* ---- memory ---------------------------------------------------------------------------------- */

static void test_any_allocation_may_fail(void **state)
{
    counting memory = {0};
    findings found = {0};
    csgm_context_options options = csgm_context_options_default();
    options.allocator = (csgm_allocator){counting_alloc, counting_release, &memory};
    options.threads = 1;
    options.on_diag = count_finding;
    options.user = &found;
    csgm_mesh_options mesh_options = coarse();
    run r;
    assert_int_equal(go(&r, &options, scene_text, &mesh_options), CSGM_OK);
    end(&r);
    assert_int_equal(memory.bytes, 0);
    assert_int_equal(memory.blocks, 0);
    int64_t calls = memory.calls;
    assert_true(calls > 10);
    for (int64_t fail_at = 1; fail_at <= calls; fail_at++) {
        memory = (counting){.fail_at = fail_at};
        found = (findings){0};
        csgm_status status = go(&r, &options, scene_text, &mesh_options);
        assert_int_equal(status, CSGM_ERR_MEMORY);
        assert_int_equal(found.errors, fail_at == 1 ? 0 : 1); /* 1: the context itself */
        end(&r);
        assert_int_equal(memory.bytes, 0);
        assert_int_equal(memory.blocks, 0);
    }
}

static void test_memory_limit(void **state)
{
    findings found = {0};
    csgm_context_options options = csgm_context_options_default();
    options.limits.memory_bytes = 1 << 20;
    options.on_diag = count_finding;
    options.user = &found;
    csgm_mesh_options mesh_options = csgm_mesh_options_default();
    mesh_options.resolution = 512;
    run r;
    assert_int_equal(go(&r, &options, scene_text, &mesh_options), CSGM_ERR_MEMORY);
    assert_int_equal(found.errors, 1);
    uint64_t peak;
    csgm_context_memory(r.context, &peak);
    assert_true(peak <= 1 << 20);
    end(&r);
}

/* ---- files that are looked for ------------------------------------------------------------ */

typedef struct looked {
    char found[256], missing[512]; /* paths, each behind a blank */
} looked;

static void note_file(void *user, const char *path, bool is_there)
{
    looked *l = user;
    char *list = is_there ? l->found : l->missing;
    size_t size = is_there ? sizeof l->found : sizeof l->missing, length = strlen(list);
    snprintf(list + length, size - length, " %s", path);
}

/* What is there and what is not, of a scene that is refused as well. */
static void test_files_are_told(void **state)
{
    char folder[] = "/tmp/csgmesh-files-XXXXXX", scene_path[64], part_path[64];
    static const char part[] = "size = 3;\n";
    const char *dirs[] = {"/no/such/folder"};
    (void)state;
    assert_non_null(mkdtemp(folder));
    snprintf(scene_path, sizeof scene_path, "%s/scene.txt", folder);
    snprintf(part_path, sizeof part_path, "%s/part.txt", folder);
    FILE *file = fopen(scene_path, "w");
    assert_non_null(file);
    fputs("include <part.txt>\ninclude <none.txt>\ncube(size);\n", file);
    fclose(file);
    file = fopen(part_path, "w");
    assert_non_null(file);
    fputs(part, file);
    fclose(file);

    looked l = {.found = ""};
    csgm_context *context;
    csgm_scene *scene;
    csgm_context_options options = csgm_context_options_default();
    csgm_scene_options scene_options = csgm_scene_options_default();
    options.on_file = note_file;
    options.user = &l;
    scene_options.include_dirs = dirs;
    scene_options.include_dir_count = 1;
    assert_int_equal(csgm_context_create(&options, &context), CSGM_OK);
    assert_int_not_equal(csgm_scene_load(context, scene_path, &scene_options, &scene), CSGM_OK);
    assert_non_null(strstr(l.found, scene_path));
    assert_non_null(strstr(l.found, part_path));
    assert_null(strstr(l.found, "none.txt"));
    assert_non_null(strstr(l.missing, "/none.txt"));
    assert_non_null(strstr(l.missing, "/no/such/folder/none.txt"));
    csgm_context_destroy(context);
    remove(scene_path);
    remove(part_path);
    rmdir(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_whole_way),
        cmocka_unit_test(test_survey),
        cmocka_unit_test(test_field_agrees_with_the_reference),
        cmocka_unit_test(test_destroy_of_nothing),
        cmocka_unit_test(test_options_not_made_by_default),
        cmocka_unit_test(test_options_of_other_versions),
        cmocka_unit_test(test_tolerance_of_a_quality),
        cmocka_unit_test(test_clusters),
        cmocka_unit_test(test_params),
        cmocka_unit_test(test_only_check),
        cmocka_unit_test(test_null_arguments),
        cmocka_unit_test(test_names),
        cmocka_unit_test(test_findings_reach_the_caller),
        cmocka_unit_test(test_cancel),
        cmocka_unit_test(test_any_allocation_may_fail),
        cmocka_unit_test(test_memory_limit),
        cmocka_unit_test(test_files_are_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
