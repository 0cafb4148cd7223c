/* SPDX-License-Identifier: MIT
 * JSON for the library's customers, names of parts, files that are written only where they change.
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
#include <sys/stat.h>
#include <unistd.h>

#include "csgmesh/csgmesh.h"

typedef struct notes {
    char events[256];
    char place[64];
    int findings, stop_after;
} notes;

static void take_finding(void *user, const csgm_diag *diag)
{
    notes *n = user;
    n->findings++;
    snprintf(n->place, sizeof n->place, "%s:%u:%u", diag->source_name, diag->line, diag->column);
}

static csgm_context *make_context(notes *n)
{
    csgm_context_options options = csgm_context_options_default();
    csgm_context *context;
    *n = (notes){.stop_after = 1000};
    options.on_diag = take_finding;
    options.user = n;
    options.threads = 1;
    assert_int_equal(csgm_context_create(&options, &context), CSGM_OK);
    return context;
}

static bool take_event(void *user, csgm_json_kind kind, const char *text, size_t length)
{
    static const char letters[] = "{[.k\"#w";
    notes *n = user;
    size_t used = strlen(n->events);
    snprintf(n->events + used, sizeof n->events - used, "%c%.*s ", letters[kind],
             kind < CSGM_JSON_KEY ? 0 : (int)length, kind < CSGM_JSON_KEY ? "" : text);
    return --n->stop_after > 0;
}

static csgm_status read_json(csgm_context *context, notes *n, const char *text)
{
    n->events[0] = '\0';
    return csgm_json_read(context, text, strlen(text), "a.json", take_event, n);
}

static void test_json(void **state)
{
    (void)state;
    notes n;
    csgm_context *context = make_context(&n);
    csgm_status status = read_json(context, &n, "{\"a\": [1, \"x\\n\", true], \"b\": {}}");
    if (status == CSGM_ERR_UNSUPPORTED) {
        assert_int_equal(n.findings, 1);
        csgm_context_destroy(context);
        skip();
    }
    assert_int_equal(status, CSGM_OK);
    assert_string_equal(n.events, "{ ka [ #1 \"x\n wtrue . kb { . . ");
    assert_int_equal(read_json(context, &n, "{\"a\":\n  5,}"), CSGM_ERR_SYNTAX);
    assert_int_equal(n.findings, 1);
    assert_string_equal(n.place, "a.json:2:5");
    n.stop_after = 2;
    assert_int_equal(read_json(context, &n, "[1, 2, 3"), CSGM_OK);
    assert_string_equal(n.events, "[ #1 ");
    assert_int_equal(csgm_json_read(NULL, "", 0, NULL, take_event, &n), CSGM_ERR_ARGUMENT);
    assert_int_equal(csgm_json_read(context, NULL, 5, NULL, take_event, &n), CSGM_ERR_ARGUMENT);
    assert_int_equal(csgm_json_read(context, "1", 1, NULL, NULL, &n), CSGM_ERR_ARGUMENT);
    csgm_context_destroy(context);
}

static csgm_field *compile(csgm_context *context, const char *text, csgm_scene **scene)
{
    csgm_field *field;
    assert_int_equal(csgm_scene_parse(context, text, strlen(text), "a.txt", NULL, scene), CSGM_OK);
    assert_int_equal(csgm_field_compile(context, *scene, &field), CSGM_OK);
    return field;
}

static void test_parts(void **state)
{
    (void)state;
    notes n;
    csgm_context *context = make_context(&n);
    csgm_scene *scene;
    const char *name;
    csgm_field *field =
        compile(context, "part(\"lid\") sphere(1); translate([5, 0, 0]) cube(1);", &scene);
    size_t count = 0, named = 0;
    for (; csgm_field_part(field, count, &name); count++)
        named += name && strcmp(name, "lid") == 0;
    assert_int_equal(count, 2);
    assert_int_equal(named, 1);
    csgm_field_destroy(field);
    csgm_scene_destroy(scene);
    field = compile(context, "sphere(1);", &scene);
    assert_true(csgm_field_part(field, 0, &name));
    assert_null(name);
    assert_false(csgm_field_part(field, 1, &name));
    csgm_field_destroy(field);
    csgm_scene_destroy(scene);
    csgm_context_destroy(context);
}

/* The file's inode: another one when it has been written again. */
static ino_t write_ball(csgm_context *context, const char *path, double radius,
                        bool only_if_changed)
{
    char text[64];
    csgm_scene *scene;
    snprintf(text, sizeof text, "sphere(%d / 4);", (int)(4 * radius));
    csgm_field *field = compile(context, text, &scene);
    csgm_mesh_options mesh = csgm_mesh_options_default();
    csgm_write_options options = csgm_write_options_default();
    mesh.resolution = 8;
    options.only_if_changed = only_if_changed;
    options.sync = false;
    struct stat status;
    assert_int_equal(
        csgm_mesh_build_file(context, field, &mesh, path, CSGM_FORMAT_AUTO, &options, NULL, NULL),
        CSGM_OK);
    assert_int_equal(stat(path, &status), 0);
    csgm_field_destroy(field);
    csgm_scene_destroy(scene);
    return status.st_ino;
}

static void test_only_if_changed(void **state)
{
    (void)state;
    static const char *const names[] = {"a.ply", "a.obj"}; /* as a stream, and whole */
    notes n;
    char folder[] = "/tmp/csg-json-XXXXXX", path[64];
    csgm_context *context = make_context(&n);
    assert_non_null(mkdtemp(folder));
    for (size_t i = 0; i < 2; i++) {
        snprintf(path, sizeof path, "%s/%s", folder, names[i]);
        ino_t first = write_ball(context, path, 1, true);
        assert_true(write_ball(context, path, 1, true) == first);
        assert_false(write_ball(context, path, 1, false) == first);
        ino_t second = write_ball(context, path, 1, true);
        assert_false(write_ball(context, path, 2, true) == second);
        assert_int_equal(unlink(path), 0);
    }
    assert_int_equal(rmdir(folder), 0); /* no temporary is left */
    csgm_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_json), cmocka_unit_test(test_parts),
                                       cmocka_unit_test(test_only_if_changed)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
