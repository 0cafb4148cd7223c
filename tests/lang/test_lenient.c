/* SPDX-License-Identifier: MIT
 * What OpenSCAD only warns of: an error in a strict text, in a lenient one a warning that says what
 * was left out, and the same solid as there.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "lang/bench_folder.h"

static csgm_scene_options by(csgm_leniency leniency)
{
    return (csgm_scene_options){.struct_size = sizeof(csgm_scene_options), .leniency = leniency};
}

typedef struct row {
    const char *text;
    int code;
    const char *said;
    size_t nodes; /* of the scene that is left; 0: not looked at */
} row;

static const row rows[] = {
    {"include <nope.scad>\ncube(1);", 122, "what it defines is missing", 2},
    {"use <nope.scad>\ncube(1);", 122, "what it defines is missing", 2},
    {"nobody() cube(1); cube(1);", 201, "it is left out, with what stands under it", 0},
    {"x = nobody(1); echo(x); cube(1);", 202, "the call counts as undef", 2},
    {"x = 3; y = x(1); echo(y); cube(1);", 202, "the call counts as undef", 2},
    {"loft() square(1); cube(1);", 207, "it is left out", 0},
    {"cube(\"a\");", 301, "the default is taken", 2},
    {"cube([1, 2]);", 301, "the default is taken", 2},
    {"square([1, 2, 3]);", 301, "the default is taken", 0},
    {"sphere(r = true);", 301, "the default is taken", 1},
    {"translate(\"x\") sphere(1);", 301, "the default is taken", 1},
    {"translate([1, 1 / 0, 0]) sphere(1);", 302, "its children stay as they are", 1},
    {"multmatrix(3) sphere(1);", 301, "its children stay as they are", 1},
    {"resize(\"a\") sphere(1);", 301, "the default is taken", 0},
    {"cube([1, 1 / 0, 1]);", 302, "it is left out", 1},
    {"linear_extrude(3) cube(1); cube(1);", 321, "they are left out", 0},
    {"rotate_extrude() translate([-1, 0]) square(2); cube(1);", 330, "it is left out", 0},
    {"import(\"nope.stl\"); cube(1);", 328, "it is left out", 0},
    {"import(5); cube(1);", 301, "it is left out", 0},
    {"text(undef, size = 5); cube(1);", 301, "it is left out", 0},
    {"polygon([[0, 0], [1, 0], [1, 1], [0, 1]], [[0, 1, 2, 3, 9]]);", 327,
     "such corners of the paths are left out", 0},
    {"polygon([[0, 0], [1, 0], [1, 1]], [[0, 1, 2], 3]);", 301, "such paths are left out", 0},
    {"polygon([[0, 0], [1, 0], [1, 1]], 3);", 301, "all points are one path", 0},
    {"polygon([[0, 0], [1, 0], \"x\"]);", 327, "it is left out", 0},
    {"polyhedron([[0,0,0], [1,0,0], [0,1,0], [0,0,1]],"
     "[[0,1,2], [0,3,1], [0,2,3], [1,3,2], [7,8,9]]);",
     327, "names point 7, there are points 0 to 3; it is left out, as are 2 more", 0},
    {"polyhedron([[0,0,0], [1,0,0], [0,1,0], [0,0,1]],"
     "[[0,1,2], [0,3,1], [0,2,3], [1,3,2], 5]);",
     327, "faces[4] is not a list of at least 3 indices of points; it is left out", 0},
    {"sphere(radius = 5);", 204, "no parameter 'radius', this is ignored", 1},
    {"cube(10, 20, 30);", 205, "takes 2 arguments without a name, this is ignored", 1},
    {"module m(a) cube(a); m(1, 2);", 205, "'m' takes 1 argument, this is ignored", 2},
    {"function f(a) = a; cube(f(1, b = 2));", 204, "no parameter 'b', this is ignored", 2},
    {"union(blend = ricci(2, radius = 3)) { sphere(1); sphere(2); }", 204,
     "ricci() takes n, range, this is ignored", 3},
};

static void warnings_say_what_is_left_out(void **state)
{
    const csgm_scene_options lenient = by(CSGM_LENIENT);
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const row *r = &rows[i];
        if (bench_compile_bytes(&b, r->text, strlen(r->text), &lenient) != CSGM_OK ||
            !bench_has(&b, -r->code) || !strstr(b.text, r->said) ||
            (r->nodes && b.scene->node_count != r->nodes))
            fail_msg("%s\n%s%zu nodes", r->text, b.text, b.scene ? b.scene->node_count : 0);
        assert_int_not_equal(bench_compile(&b, r->text), CSGM_OK);
        if (!bench_has(&b, r->code) || strstr(b.text, r->said))
            fail_msg("strict: %s\n%s", r->text, b.text);
    }
}

/* The mistake is in the file that is used, or in the one that uses. */
static void the_file_decides(void **state)
{
    const struct {
        const char *library, *scene;
        csgm_leniency leniency;
        csgm_status status;
    } cases[] = {
        {"lib.scad", "a.txt", CSGM_LENIENT_BY_FILE, CSGM_OK},
        {"lib.CSG", "a.txt", CSGM_LENIENT_BY_FILE, CSGM_OK},
        {"lib.txt", "a.scad", CSGM_LENIENT_BY_FILE, CSGM_ERR_SCENE},
        {"lib.scad", "a.txt", CSGM_STRICT, CSGM_ERR_SCENE},
        {"lib.txt", "a.txt", CSGM_LENIENT, CSGM_OK},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const csgm_scene_options options = by(cases[i].leniency);
        char scene[64];
        snprintf(scene, sizeof scene, "use <%s>\npart();", cases[i].library);
        write_text(cases[i].library, "module part() { nobody(); cube(1); }");
        csgm_status status = bench_load(&b, write_text(cases[i].scene, scene), &options);
        if (status != cases[i].status)
            fail_msg("case %zu: %d\n%s", i, (int)status, b.text);
    }
}

static void other_mistakes_stay_errors(void **state)
{
    const csgm_scene_options lenient = by(CSGM_LENIENT);
    static const char *const texts[] = {"assert(false);", "cube(;", "union(blend = \"a\") cube(1);",
                                        "field(3);"};
    (void)state;
    for (size_t i = 0; i + 1 < sizeof texts / sizeof *texts; i++)
        assert_int_not_equal(bench_compile_bytes(&b, texts[i], strlen(texts[i]), &lenient),
                             CSGM_OK);
    const char *silent = "resize([9]) cube(1);";
    assert_int_equal(bench_compile(&b, silent), CSGM_OK);
    assert_int_equal(b.code_count, 0);
}

/* Each is shown, however many there are. */
static void none_is_summed_up(void **state)
{
    const csgm_scene_options lenient = by(CSGM_LENIENT);
    char text[2048] = "";
    (void)state;
    for (int i = 0; i < 50; i++)
        snprintf(text + strlen(text), sizeof text - strlen(text), "nobody%d();\n", i);
    assert_int_equal(bench_compile_bytes(&b, text, strlen(text), &lenient), CSGM_OK);
    assert_int_equal(b.code_count, 51); /* and that the scene is empty */
    b.context.diags.warnings_as_errors = true;
    assert_int_equal(bench_compile_bytes(&b, text, strlen(text), &lenient), CSGM_ERR_SCENE);
    b.context.diags.warnings_as_errors = false;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(warnings_say_what_is_left_out),
        cmocka_unit_test(the_file_decides),
        cmocka_unit_test(other_mistakes_stay_errors),
        cmocka_unit_test(none_is_summed_up),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
