/* SPDX-License-Identifier: MIT
 * How findings look (golden text), recovery of the parser, include and use, -D, files that cannot
 * be read.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include "lang/bench_folder.h"

/* ---- golden text ----------------------------------------------------------------------- */

static void a_misspelt_name_looks_like_this(void **state)
{
    (void)state;
    assert_int_equal(bench_compile(&b, "union() {\n\tshpere(3);\n}\n"), CSGM_ERR_SCENE);
    assert_string_equal(b.text, "scene.txt:2:2: error E0201: there is no module 'shpere'\n"
                                "\tshpere(3);\n"
                                "\t^~~~~~\n"
                                "hint: did you mean 'sphere'?\n");
}

static void a_call_trace_looks_like_this(void **state)
{
    (void)state;
    bench_compile(&b, "module ball(r) torus(r);\nmodule pair(r) ball(-r);\npair(2);\n");
    assert_string_equal(b.text,
                        "scene.txt:1:22: error E0302: torus(): r is -2, it must be above 0\n"
                        "module ball(r) torus(r);\n"
                        "                     ^\n"
                        "hint: r must be > 0\n"
                        "scene.txt:2:16: note: in the call of module 'ball'\n"
                        "module pair(r) ball(-r);\n"
                        "               ^~~~\n"
                        "scene.txt:3:1: note: in the call of module 'pair'\n"
                        "pair(2);\n"
                        "^~~~\n");
}

static void an_unclosed_bracket_shows_both_places(void **state)
{
    (void)state;
    assert_int_equal(bench_compile(&b, "cube([1, 2);\n"), CSGM_ERR_SYNTAX);
    assert_string_equal(b.text, "scene.txt:1:11: error E0109: expected ']' but found ')'\n"
                                "cube([1, 2);\n"
                                "          ^\n"
                                "scene.txt:1:6: note: to close this '['\n"
                                "cube([1, 2);\n"
                                "     ^\n");
}

static void a_repeated_mistake_is_told_once(void **state)
{
    (void)state;
    bench_compile(&b, "for (i = [1 : 1000]) torus(-i);");
    assert_int_equal(b.code_count, 1);
    bench_compile(&b, "for (i = [1 : 1000]) translate([i, 0, 0]) sphere(oops);");
    assert_int_equal(b.code_count, 1);
}

static void warnings_can_be_errors(void **state)
{
    (void)state;
    b.context.diags.warnings_as_errors = true;
    assert_int_equal(bench_compile(&b, "sphere(oops);"), CSGM_ERR_SCENE);
    assert_true(bench_has(&b, 203));
    assert_int_equal(bench_compile(&b, "a = 1; a = 2; sphere(a);"), CSGM_ERR_SYNTAX);
    assert_int_equal(bench_compile(&b, "*sphere(1);"), CSGM_ERR_SCENE);
    assert_true(bench_has(&b, 390));
    b.context.diags.warnings_as_errors = false;
    assert_int_equal(bench_compile(&b, "sphere(oops);"), CSGM_OK);
}

static void echoes_and_findings_keep_their_order(void **state)
{
    char *at;
    (void)state;
    assert_int_equal(
        bench_compile(&b, "for (i = [1 : 3000]) echo(i, \"padding padding\"); sphere(1);"),
        CSGM_OK);
    at = b.echo;
    for (int i = 1; i <= 2000; i++) { /* what the bench keeps */
        char line[64];
        snprintf(line, sizeof line, "%d, \"padding padding\"\n", i);
        assert_memory_equal(at, line, strlen(line));
        at += strlen(line);
    }
    assert_int_equal(
        bench_compile(&b, "echo([for (i = [1 : 8000]) i]); echo(\"last\"); sphere(1);"), CSGM_OK);
    assert_string_equal(b.echo + b.echo_length - 7, "\"last\"\n");
    assert_true(b.echo_length > 30000);
}

/* ---- recovery -------------------------------------------------------------------------------- */

static void the_parser_finds_independent_mistakes(void **state)
{
    static const int wanted[] = {107, 109, 108, 110, 113, 107};
    (void)state;
    assert_int_equal(bench_compile(&b, "a = 1\n"
                                       "b = [1, 2;\n"
                                       "c = * 3;\n"
                                       "}\n"
                                       "include foo;\n"
                                       "module (x) { cube(); }\n"
                                       "sphere(1);\n"),
                     CSGM_ERR_SYNTAX);
    assert_int_equal(b.code_count, 6);
    assert_memory_equal(b.codes, wanted, sizeof wanted);
}

static void mistakes_inside_blocks_do_not_spill(void **state)
{
    (void)state;
    bench_compile(
        &b, "module m() {\n  x = ;\n  cube(1);\n  y = 2 3;\n}\nmodule n() { sphere(; }\nm();");
    assert_int_equal(b.code_count, 3);
    assert_null(strstr(b.text, "E0110"));
}

static void every_error_is_shown(void **state)
{
    char scene[4096] = "";
    (void)state;
    for (int i = 0; i < 60; i++)
        strcat(scene, "x = ;\n");
    assert_int_equal(bench_compile(&b, scene), CSGM_ERR_SYNTAX);
    assert_int_equal(b.code_count, 60);
    assert_int_equal(b.context.diags.errors, 60);
}

/* ---- include and use
 * ----------------------------------------------------------------------------- */

static void include_and_use_differ(void **state)
{
    (void)state;
    write_text("lib.txt",
               "size = 3; function twice(x) = 2 * x * size; module ball() { echo(\"ball\", size);"
               " sphere(size); } echo(\"lib\");");
    write_text("main1.txt", "include <lib.txt>\necho(size, twice(1)); ball();");
    assert_int_equal(bench_load(&b, path_of("main1.txt"), NULL), CSGM_OK);
    assert_string_equal(b.echo, "\"lib\"\n3, 6\n\"ball\", 3\n");
    write_text("main2.txt", "use <lib.txt>\nsize = 9; echo(size, twice(1)); ball();");
    assert_int_equal(bench_load(&b, path_of("main2.txt"), NULL), CSGM_OK);
    assert_string_equal(b.echo, "9, 6\n\"ball\", 3\n");
    write_text("main3.txt", "include <lib.txt>\nsize = 5; ball();");
    assert_int_equal(bench_load(&b, path_of("main3.txt"), NULL), CSGM_OK);
    assert_string_equal(b.echo, "\"lib\"\n\"ball\", 5\n");
    assert_int_equal(b.code_count, 0); /* overwriting what is included is no mistake */
}

static void dependencies_are_in_order_of_reading(void **state)
{
    (void)state;
    write_text("a.txt", "include <c.txt>\n");
    write_text("b.txt", "include <c.txt>\n");
    write_text("c.txt", "k = 1;\n");
    write_text("main.txt", "include <a.txt>\ninclude <b.txt>\nsphere(k);");
    assert_int_equal(bench_load(&b, path_of("main.txt"), NULL), CSGM_OK);
    assert_int_equal(b.scene->dependency_count, 4);
    assert_string_equal(b.scene->dependencies[0], path_of("main.txt"));
    assert_string_equal(b.scene->dependencies[1], path_of("a.txt"));
    assert_string_equal(b.scene->dependencies[2], path_of("c.txt"));
    assert_string_equal(b.scene->dependencies[3], path_of("b.txt"));
}

static void folders_are_searched_in_order(void **state)
{
    char text[128], inc[128];
    const char *dirs[] = {"", inc}; /* an empty name is the current folder, and not the end */
    (void)state;
    csgm_scene_options options = {
        .struct_size = sizeof options, .include_dirs = dirs, .include_dir_count = 2};
    snprintf(inc, sizeof inc, "%s", path_of("inc"));
    mkdir(inc, 0700);
    mkdir(path_of("env"), 0700);
    write_text("inc/only_inc.txt", "echo(\"inc\");");
    write_text("env/only_inc.txt", "echo(\"wrong\");");
    write_text("env/only_env.txt", "echo(\"env\");");
    write_text("main.txt", "include <only_inc.txt>\ninclude <only_env.txt>\nsphere(1);");
    snprintf(text, sizeof text, "/nonexistent:%s", path_of("env"));
    setenv("CSGMESH_PATH", text, 1);
    assert_int_equal(bench_load(&b, path_of("main.txt"), &options), CSGM_OK);
    unsetenv("CSGMESH_PATH");
    assert_string_equal(b.echo, "\"inc\"\n\"env\"\n");
    setenv("OPENSCADPATH", text, 1);
    assert_int_equal(bench_load(&b, path_of("main.txt"), &options), CSGM_OK);
    unsetenv("OPENSCADPATH");
    mkdir(path_of(".local"), 0700);
    mkdir(path_of(".local/share"), 0700);
    mkdir(path_of(".local/share/OpenSCAD"), 0700);
    mkdir(path_of(".local/share/OpenSCAD/libraries"), 0700);
    write_text(".local/share/OpenSCAD/libraries/only_home.txt", "echo(\"home\");");
    write_text("at_home.txt", "include <only_home.txt>\nsphere(1);");
    const char *home = getenv("HOME");
    char kept[1024];
    snprintf(kept, sizeof kept, "%s", home ? home : "");
    snprintf(text, sizeof text, "%s", path_of("."));
    setenv("HOME", text, 1);
    assert_int_equal(bench_load(&b, path_of("at_home.txt"), NULL), CSGM_OK);
    assert_string_equal(b.echo, "\"home\"\n");
    setenv("HOME", kept, 1);
    assert_int_equal(bench_load(&b, path_of("main.txt"), NULL), CSGM_ERR_IO);
    assert_true(bench_has(&b, 122));
}

static void cycles_are_told_with_their_way(void **state)
{
    (void)state;
    write_text("x.txt", "include <y.txt>\n");
    write_text("y.txt", "include <x.txt>\n");
    assert_int_not_equal(bench_load(&b, path_of("x.txt"), NULL), CSGM_OK);
    assert_true(bench_has(&b, 123));
    assert_non_null(strstr(b.text, "note: included from here"));
}

static void doubling_includes_end(void **state)
{
    char name[32], text[64];
    (void)state;
    for (int i = 0; i < 40; i++) {
        snprintf(name, sizeof name, "d%d.txt", i);
        snprintf(text, sizeof text, "include <d%d.txt>\ninclude <d%d.txt>\n", i + 1, i + 1);
        write_text(name, text);
    }
    write_text("d40.txt", "x = 1;");
    assert_int_equal(bench_load(&b, path_of("d0.txt"), NULL), CSGM_ERR_LIMIT);
    assert_true(bench_has(&b, 909));
}

/* ---- -D
 * ---------------------------------------------------------------------------------------------- */

static void check_define(const char *scene, csgm_define define, csgm_status wanted,
                         const char *echo)
{
    csgm_scene_options options = {
        .struct_size = sizeof options, .defines = &define, .define_count = 1};
    csgm_status status = bench_compile_bytes(&b, scene, strlen(scene), &options);
    if (status != wanted || strcmp(b.echo, echo) != 0)
        print_error("%s with %s=%s: %s%s\n", scene, define.name, define.expression, b.echo, b.text);
    assert_int_equal(status, wanted);
    assert_string_equal(b.echo, echo);
}

static void defines_replace_top_level_assignments(void **state)
{
    (void)state;
    const char *scene = "a = 1; b = a + 1; echo(a, b); sphere(1);";
    check_define(scene, (csgm_define){"a", "5"}, CSGM_OK, "5, 6\n");
    check_define(scene, (csgm_define){"b", "[a, \"x\"]"}, CSGM_OK, "1, [1, \"x\"]\n");
    assert_int_equal(b.code_count, 0);
    check_define("echo($fn); sphere(1);", (csgm_define){"$fn", "50"}, CSGM_OK, "50\n");
    assert_int_equal(b.code_count, 0);
    check_define("echo(c); sphere(1);", (csgm_define){"c", "7"}, CSGM_OK, "7\n");
    assert_true(bench_has(&b, -213));
    check_define(scene, (csgm_define){"a", "1 +"}, CSGM_ERR_SYNTAX, "");
    assert_non_null(strstr(b.text, "-D a:1:4: error E0108"));
    check_define(scene, (csgm_define){"a", "1; b = 2"}, CSGM_ERR_SYNTAX, "");
    check_define(scene, (csgm_define){"a", ""}, CSGM_ERR_SYNTAX, "");
    check_define(scene, (csgm_define){"2a", "1"}, CSGM_ERR_SYNTAX, "");
    check_define(scene, (csgm_define){"", "1"}, CSGM_ERR_SYNTAX, "");
    assert_true(bench_has(&b, 214));
}

/* ---- files that are no scenes
 * -------------------------------------------------------------------------- */

static void check_unreadable(const char *path, csgm_status status, int code)
{
    assert_int_equal(bench_load(&b, path, NULL), status);
    assert_int_equal(b.code_count, 1);
    assert_int_equal(b.codes[0], code);
}

static void what_is_no_text_is_told_once(void **state)
{
    char noise[4096];
    (void)state;
    for (size_t i = 0; i < sizeof noise; i++)
        noise[i] = (char)(i * 2654435761u >> 13);
    write_file("noise.bin", noise, sizeof noise);
    write_file("utf16.txt", "\xFF\xFEs\0p\0h\0e\0r\0e\0(\0)\0;\0", 20);
    write_text("empty.txt", "");
    check_unreadable(path_of("noise.bin"), CSGM_ERR_SYNTAX, 112);
    check_unreadable(path_of("utf16.txt"), CSGM_ERR_SYNTAX, 112);
    assert_non_null(strstr(b.text, "UTF-16"));
    check_unreadable(folder, CSGM_ERR_IO, 121);
    check_unreadable(path_of("missing.txt"), CSGM_ERR_IO, 121);
    check_unreadable(path_of("empty.txt/x"), CSGM_ERR_IO, 121);
    check_unreadable("/dev/zero", CSGM_ERR_LIMIT, 908);
    assert_int_equal(bench_load(&b, path_of("empty.txt"), NULL), CSGM_OK);
    assert_true(bench_has(&b, -390));
}

static void strange_bytes_have_a_place(void **state)
{
    (void)state;
    assert_int_equal(bench_compile_bytes(&b, "sphere(1);\ncube\0(2);", 20, NULL), CSGM_ERR_SYNTAX);
    assert_non_null(strstr(b.text, "scene.txt:2:5: error E0102"));
    assert_int_equal(bench_compile(&b, "echo(\"\xE9\"); sphere(1);"), CSGM_OK);
    assert_non_null(strstr(b.text, "scene.txt:1:7: warning W0114"));
    assert_string_equal(b.echo, "\"\xC3\xA9\"\n");
    assert_int_equal(bench_compile(&b, "sphere(\xE9);"), CSGM_ERR_SYNTAX);
    assert_non_null(strstr(b.text, "scene.txt:1:8: error E0103"));
    assert_int_equal(bench_compile(&b, "sphere(\xC2\xA0 1 )\xA0;\xC2\xA0"), CSGM_OK);
    assert_int_equal(b.code_count, 0);
    /* Shift JIS: nearly every byte of it is broken UTF-8 */
    assert_int_equal(bench_compile(&b, "// \x83v\x83\x8A\x83\x93\x83^\x81[\nsphere(1);"), CSGM_OK);
    assert_int_equal(bench_compile(&b, "// 5 mm\xB2\nsphere(1);"), CSGM_OK);
    assert_true(bench_has(&b, -114));
    assert_int_equal(bench_compile(&b, "\xEF\xBB\xBFsphere(1);"), CSGM_OK);
    assert_int_equal(b.code_count, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_misspelt_name_looks_like_this),
        cmocka_unit_test(a_call_trace_looks_like_this),
        cmocka_unit_test(an_unclosed_bracket_shows_both_places),
        cmocka_unit_test(a_repeated_mistake_is_told_once),
        cmocka_unit_test(warnings_can_be_errors),
        cmocka_unit_test(echoes_and_findings_keep_their_order),
        cmocka_unit_test(the_parser_finds_independent_mistakes),
        cmocka_unit_test(mistakes_inside_blocks_do_not_spill),
        cmocka_unit_test(every_error_is_shown),
        cmocka_unit_test(include_and_use_differ),
        cmocka_unit_test(dependencies_are_in_order_of_reading),
        cmocka_unit_test(folders_are_searched_in_order),
        cmocka_unit_test(cycles_are_told_with_their_way),
        cmocka_unit_test(doubling_includes_end),
        cmocka_unit_test(defines_replace_top_level_assignments),
        cmocka_unit_test(what_is_no_text_is_told_once),
        cmocka_unit_test(strange_bytes_have_a_place),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
