/* SPDX-License-Identifier: MIT
 * What OpenSCAD has besides 2021.01, and what it reads off files: bit operators, objects, import()
 * of JSON, measures of letters and of drawings, the level of the language.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "lang/bench_failing.h"
#include "lang/bench_folder.h"

/* Echoes of a scene that stands in the folder. */
static void check(const char *scene, const char *echo)
{
    write_text("scene.scad", scene);
    csgm_status status = bench_load(&b, path_of("scene.scad"), NULL);
    if (status != CSGM_OK || strcmp(b.echo, echo) != 0)
        print_error("%s\n%s%s", scene, b.echo, b.text);
    assert_int_equal(status, CSGM_OK);
    assert_string_equal(b.echo, echo);
}

/* Calls with arguments that warn (W0210) and have no value. */
static void check_refused(const char *const *calls, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        char scene[128];
        snprintf(scene, sizeof scene, "echo(%s);", calls[i]);
        check(scene, "undef\n");
        assert_true(bench_has(&b, -210));
    }
}

static void bits_are_those_of_whole_numbers(void **state)
{
    (void)state;
    check("echo(6 & 3, 6 | 3, 1 << 4, 256 >> 3, ~5);", "2, 7, 16, 32, -6\n");
    check("echo(-8 >> 1, -1 & 255, 6.9 & 3, -2.5 | 0);", "-4, 255, 2, -2\n");
    check("echo(1 | 2 == 3, 1 + 1 << 2, 1 << 2 & 4, 6 & 3 | 8, !~0, -~3);",
          "true, 8, 4, 10, false, 4\n");
    check("echo(1 << 62, 1 << 63, undef & 1);", "4.61169e+18, -9.22337e+18, undef\n");
    assert_int_equal(b.code_count, 1); /* an empty scene */
    static const char *const refused[] = {"true & 1", "1 << 64", "1 >> -1",
                                          "1e19 | 1", "~\"a\"",  "(0/0) & 1"};
    for (size_t i = 0; i < sizeof refused / sizeof *refused; i++) {
        char scene[64];
        snprintf(scene, sizeof scene, "echo(%s);", refused[i]);
        check(scene, "undef\n");
        assert_true(bench_has(&b, -209));
    }
    assert_int_equal(bench_compile(&b, "field(function (p) p.x & 1);"), CSGM_ERR_SCENE);
    assert_true(bench_has(&b, 311));
}

static void objects_have_entries(void **state)
{
    (void)state;
    check("o = object(a = 1, b = \"x\", c = [1, 2]);\n"
          "echo(o, o.a, o[\"b\"], o.none, o[\"none\"], o[0], len(o), is_object(o), is_list(o));",
          "{ a = 1; b = \"x\"; c = [1, 2]; }, 1, \"x\", undef, undef, undef, 3, true, false\n");
    check("o = object(a = 1, b = 2); for (k = o) echo(k, o[k]); echo([for (k = o) o[k]]);",
          "\"a\", 1\n\"b\", 2\n[1, 2]\n");
    check("o = object(a = 1, b = 2); p = object(o, [[\"a\", 5], [\"b\"], [\"d\", o]], e = true);\n"
          "echo(p, p.d.b, has_key(p, \"b\"), has_key(p, \"d\"));",
          "{ a = 5; d = { a = 1; b = 2; }; e = true; }, 2, false, true\n");
    check(
        "o = object(a = 1); echo(o == object(a = 1), o == object(a = 2), o == [\"a\", 1], object() "
        "? 1 : 0, str(o));",
        "true, false, false, 0, \"{ a = 1; }\"\n");
    static const char *const refused[] = {"object(3)",          "object([3])",
                                          "object([[1, 2]])",   "object([[\"a\", 1, 2]])",
                                          "has_key([], \"a\")", "has_key(object(), 3)"};
    check_refused(refused, sizeof refused / sizeof *refused);
    /* the last reference goes, with what it holds */
    check("x = [for (i = [1 : 1000]) object(a = [i], b = object(c = str(i)))]; echo(x[9].b.c);",
          "\"10\"\n");
}

static void json_is_a_value(void **state)
{
    (void)state;
    write_text("a.json", "{\"b\": [1, 2.5e1, {\"x\": null}], \"a\": \"t\\u00e9\", \"t\": true}");
    check("d = import(\"a.json\"); echo(d, d.b[1], import(file = \"a.json\") == d);",
          "{ a = \"t\xC3\xA9\"; b = [1, 25, { x = undef; }]; t = true; }, 25, true\n");
    write_text("n.json", "-3");
    check("echo(import(\"n.json\"));", "-3\n");
    static const char *const broken[] = {"", "{", "[1,", "[1] 2", "{\"a\": 1, \"a\": 2}", "nul"};
    for (size_t i = 0; i < sizeof broken / sizeof *broken; i++) {
        write_text("x.json", broken[i]);
        write_text("scene.scad", "echo(import(\"x.json\"));");
        assert_int_equal(bench_load(&b, path_of("scene.scad"), NULL), CSGM_ERR_SCENE);
        assert_true(bench_has(&b, 329));
        assert_string_equal(b.echo, "undef\n");
    }
    static char deep[1000];
    memset(deep, '[', sizeof deep - 1);
    write_text("x.json", deep);
    assert_int_equal(bench_load(&b, path_of("scene.scad"), NULL), CSGM_ERR_SCENE);
    assert_non_null(strstr(b.text, "too deeply"));
    assert_int_equal(bench_compile(&b, "x = import(\"nope.json\");"), CSGM_ERR_SCENE);
    assert_true(bench_has(&b, 328));
}

/* Pairs of a code and a value, with blanks for line ends. */
static void write_dxf(const char *entities)
{
    char text[4096];
    snprintf(text, sizeof text, "0 SECTION 2 ENTITIES %s 0 ENDSEC 0 EOF ", entities);
    for (char *c = text; *c; c++)
        *c = *c == ' ' ? '\n' : *c;
    write_text("a.dxf", text);
}

static void drawings_are_measured(void **state)
{
    (void)state;
    write_dxf("0 DIMENSION 8 0 1 width 70 0 13 1 23 2 14 11 24 5 50 0 "
              "0 DIMENSION 8 0 1 slant 70 1 13 0 23 0 14 3 24 4 "
              "0 DIMENSION 8 0 1 round 70 4 10 1 20 1 15 4 25 5 "
              "0 DIMENSION 8 b 1 turn 70 2 10 1 20 0 15 0 25 0 13 0 23 0 14 0 24 1 "
              "0 DIMENSION 8 0 1 place 70 70 13 7 23 8 "
              "0 DIMENSION 8 0 1 other 70 5 "
              "0 LINE 8 c 10 0 20 0 11 4 21 4 0 LINE 8 c 10 0 20 2 11 4 21 2 "
              "0 LINE 8 p 10 0 20 0 11 4 21 0 0 LINE 8 p 10 0 20 2 11 4 21 2");
    check(
        "f = \"a.dxf\"; echo(dxf_dim(file = f), dxf_dim(file = f, name = \"slant\"),\n"
        "dxf_dim(file = f, name = \"round\", scale = 2), dxf_dim(file = f, name = \"turn\"),\n"
        "dxf_dim(file = f, name = \"place\", origin = [1, 0]), dxf_dim(file = f, layer = \"b\"),\n"
        "dxf_cross(file = f, layer = \"c\"), dxf_cross(file = f, layer = \"c\", origin = [1, 1]));",
        "10, 5, 10, 90, 6, 90, [2, 2], [1, 1]\n");
    static const char *const refused[] = {"dxf_dim(file = \"a.dxf\", name = \"none\")",
                                          "dxf_dim(file = \"a.dxf\", name = \"other\")",
                                          "dxf_dim()", "dxf_cross(file = \"a.dxf\", layer = \"p\")",
                                          "dxf_cross(file = \"a.dxf\", layer = \"none\")"};
    check_refused(refused, sizeof refused / sizeof *refused);
    check("import_dxf(\"a.dxf\", layer = \"c\"); dxf_linear_extrude(file = \"a.dxf\", height = 2);",
          "");
}

static void letters_are_measured(void **state)
{
    (void)state;
    check("a = textmetrics(\"Ag\", size = 10, halign = \"center\"); b = textmetrics(\"Ag\");\n"
          "echo(abs(a.size.x - b.size.x) < 1e-9, a.offset.x == -a.advance.x / 2, a.descent < 0,\n"
          "b.position.y == b.descent, b.offset, a.ascent > 9);",
          "true, true, true, true, [0, 0], true\n");
    check("m = fontmetrics(size = 20); n = fontmetrics(10);\n"
          "echo(m.nominal.ascent == 2 * n.nominal.ascent, m.max.descent < 0, m.interline > 20,\n"
          "is_string(m.font.family), is_string(m.font.style));",
          "true, true, true, true, true\n");
    assert_int_equal(bench_compile(&b, "echo(textmetrics(3));"), CSGM_ERR_SCENE);
}

static void the_level_can_be_set(void **state)
{
    csgm_scene_options old = {.struct_size = sizeof old, .openscad_version = 20210100};
    static const char scene[] =
        "echo(version(), version_num() == 20210100, version_num([2019, 5]));";
    (void)state;
    assert_int_equal(bench_compile_bytes(&b, scene, strlen(scene), &old), CSGM_OK);
    assert_string_equal(b.echo, "[2021, 1, 0], true, 2.01905e+7\n");
    check("assert(version_num() > 20230000);", "");
}

static void ranges_that_begin_above_their_end(void **state)
{
    csgm_scene_options old = {.struct_size = sizeof old, .openscad_version = 20250200};
    static const char scene[] = "n = 0; echo([for (i = [0 : n - 1]) i], [3 : 1][0]);\n"
                                "for (i = [1 : -1]) echo(i); echo([for (i = [0 : n]) i]);";
    (void)state;
    check(scene, "[], 3\n[0]\n");
    assert_int_equal(b.code_count, 3); /* of those that say so themselves, and an empty scene's */
    assert_true(b.codes[0] == -211 && b.codes[1] == -211 && b.codes[2] != -211);
    assert_int_equal(bench_compile_bytes(&b, scene, strlen(scene), &old), CSGM_OK);
    assert_string_equal(b.echo, "[-1, 0], 1\n-1\n0\n1\n[0]\n");
    old.openscad_version = 20250300;
    assert_int_equal(bench_compile_bytes(&b, scene, strlen(scene), &old), CSGM_OK);
    assert_string_equal(b.echo, "[], 3\n[0]\n");
}

/* What a used file assigns to a special variable holds in it, but undef only where there is none.
 */
static void files_say_that_there_is_a_variable(void **state)
{
    csgm_scene_options old = {.struct_size = sizeof old, .openscad_version = 20210100};
    (void)state;
    write_text("used.scad", "$given = undef; $own = 1;\n"
                            "function given() = [$given, $own];\n"
                            "module with(x) { $given = x; $own = x; children(); }\n");
    write_text("scene.scad", "use <used.scad>\n"
                             "echo(given()); with(3) { echo(given()); with(4) echo(given()); }\n"
                             "echo(given($given = 5, $own = 5));");
    assert_int_equal(bench_load(&b, path_of("scene.scad"), NULL), CSGM_OK);
    assert_string_equal(b.echo, "[undef, 1]\n[3, 1]\n[4, 1]\n[5, 5]\n");
    assert_int_equal(bench_load(&b, path_of("scene.scad"), &old), CSGM_OK);
    assert_string_equal(b.echo, "[undef, 1]\n[undef, 1]\n[undef, 1]\n[5, 5]\n");
}

static csgm_status load_poor_scene(bench *poor)
{
    return bench_load(poor, path_of("poor.scad"), NULL);
}

static void every_allocation_may_fail(void **state)
{
    static const char scene[] =
        "o = object(object(a = [1]), [[\"b\", 2], [\"a\"]], c = str(3));\n"
        "x = [for (k = o) [k, o[k]]]; d = import(\"a.json\");\n"
        "y = [for (i = [1 : 40]) [for (j = [1 : 40]) j]]; /* no small values */\n"
        "cube(len(x)); fill() square(2);";
    (void)state;
    write_text("a.json", "{\"b\": [1, {\"x\": \"y\"}], \"a\": 1}");
    write_text("poor.scad", scene);
    assert_true(bench_fail_every(load_poor_scene, 400, 20) > 100);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bits_are_those_of_whole_numbers),
        cmocka_unit_test(objects_have_entries),
        cmocka_unit_test(json_is_a_value),
        cmocka_unit_test(drawings_are_measured),
        cmocka_unit_test(letters_are_measured),
        cmocka_unit_test(the_level_can_be_set),
        cmocka_unit_test(ranges_that_begin_above_their_end),
        cmocka_unit_test(files_say_that_there_is_a_variable),
        cmocka_unit_test(every_allocation_may_fail),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
