/* SPDX-License-Identifier: MIT
 * Expressions: a table of what echo prints, and the rules of scopes and calls.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "lang/bench_fixture.h"

static void echo_prints_what_openscad_prints(void **state)
{
    static const struct {
        const char *expression, *printed;
    } table[] = {
#define ECHO(expression, printed) {expression, printed},
#include "lang/echo_table.def"
#undef ECHO
    };
    size_t count = sizeof table / sizeof *table, wrong = 0;
    assert_true(count >= 150);
    for (size_t i = 0; i < count; i++) {
        char scene[512], expected[512];
        snprintf(scene, sizeof scene, "echo(%s);", table[i].expression);
        snprintf(expected, sizeof expected, "%s\n", table[i].printed);
        csgm_status status = bench_compile(&b, scene);
        if (status != CSGM_OK || strcmp(b.echo, expected) != 0) {
            print_error("%s -> %s, expected %s%s", table[i].expression, b.echo, expected, b.text);
            wrong++;
        }
    }
    assert_int_equal(wrong, 0);
}

/* A scene and all that it echoes. */
static void check(const char *scene, const char *echo)
{
    csgm_status status = bench_compile(&b, scene);
    if (strcmp(b.echo, echo) != 0 || status != CSGM_OK)
        print_error("%s\n%s%s", scene, b.echo, b.text);
    assert_int_equal(status, CSGM_OK);
    assert_string_equal(b.echo, echo);
}

/* Each row whose handler looks it up in operators.def or steps.def is found there. */
static void blends_of_the_table_are_blends(void **state)
{
    static const struct {
        const char *name, *handler;
    } rows[] = {
#define CSG_FUNCTION(name, handler, fewest, most, parameters, doc) {#name, #handler},
#include "lang/functions/functions.def"
#undef CSG_FUNCTION
    };
    (void)state;
    int tried = 0;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        bool blend = strcmp(rows[i].handler, "blend") == 0;
        if (!blend && strcmp(rows[i].handler, "rule") != 0 && strcmp(rows[i].handler, "step") != 0)
            continue;
        char text[160];
        snprintf(text, sizeof text, "echo(is_undef(%s(%s))); sphere(1);", rows[i].name,
                 blend ? "1" : "");
        assert_int_equal(bench_compile(&b, text), CSGM_OK);
        if (strcmp(b.echo, "false\n") != 0)
            fail_msg("%s() is no %s: %s", rows[i].name, rows[i].handler, b.text);
        tried++;
    }
    assert_true(tried >= 18);
}

static void scopes_are_lexical_and_the_last_assignment_holds(void **state)
{
    check("a = 1; echo(a); a = 2;", "2\n");
    check("x = 1; module m() { x = 2; echo(x); } m(); echo(x);", "2\n1\n");
    check("x = 1; module m() { echo(x); } module n() { x = 5; m(); } n();", "1\n");
    check("x = 1; if (true) { x = x + 1; echo(x); } echo(x);", "2\n1\n");
    check("echo(f(3)); function f(x) = x * y; y = 4;", "12\n");
    check("for (i = [1 : 3]) { j = i * i; echo(j); }", "1\n4\n9\n");
    check("module m(a, b = 2) echo(a, b); m(1); m(b = 5, a = 4); m();", "1, 2\n4, 5\nundef, 2\n");
    check("module m() { module k() echo(\"inner\"); k(); } m();", "\"inner\"\n");
    check("b = 7; module m(a = b) echo(a); module n() { b = 1; m(); } n();", "7\n");
    check("let (a = 1, b = a + 1) echo(b);", "2\n");
    check("{ a = 3; } echo(a);", "3\n");
    check("echo(x = 1, \"y\", z = [1]);", "x = 1, \"y\", z = [1]\n");
}

static void special_variables_are_dynamic(void **state)
{
    check("$x = 1; module m() echo($x); module n() { $x = 2; m(); } n(); m();", "2\n1\n");
    check("module m() echo($x); m($x = 4);", "4\n");
    check("function f() = $x; echo(f($x = 3)); $x = 1; echo(f());", "3\n1\n");
    check("module outer() { $x = 5; children(); } outer() echo($x);", "5\n");
    check("for ($i = [0 : 1]) echo($i);", "0\n1\n");
    check("function f() = $x; echo(let ($x = 9) f());", "9\n");
    check("module m() echo($children); m(); m() cube(); m() { cube(); sphere(); }", "0\n1\n2\n");
    check("module m() { echo(parent_module(0)); k(); } module k() echo(parent_module(1)); m();",
          "\"m\"\n\"m\"\n");
}

static void children_are_chosen_by_index(void **state)
{
    check("module m() { children(1); children([0, 2]); children([0 : 2 : 2]); children(); } "
          "m() { echo(0); echo(1); echo(2); }",
          "1\n0\n2\n0\n2\n0\n1\n2\n");
    check("module a() b() children(0); module b() children(0); a() echo(\"deep\");", "\"deep\"\n");
    check("module m() for (i = [0 : $children - 1]) children(i); m() { echo(\"p\"); *echo(\"q\"); "
          "echo(\"r\"); }",
          "\"p\"\n\"r\"\n");
}

static void functions_recurse_and_tail_calls_are_free(void **state)
{
    check("function fact(n) = n < 2 ? 1 : n * fact(n - 1); echo(fact(10));", "3.6288e+6\n");
    check("function sum(v, i = 0) = i == len(v) ? 0 : v[i] + sum(v, i + 1); echo(sum([1, 2, 3]));",
          "6\n");
    check("function count(n, k = 0) = n == 0 ? k : count(n - 1, k + 1); echo(count(200000));",
          "200000\n");
    check("function odd(n) = n == 0 ? false : even(n - 1); function even(n) = n == 0 ? true : "
          "odd(n - 1); echo(even(100001));",
          "false\n");
    check("function f(n) = let (m = n - 1) n == 0 ? \"end\" : echo(n) f(m); echo(f(2));",
          "2\n1\n\"end\"\n");
    check("f = function (n) n == 0 ? 0 : 1 + f(n - 1); echo(f(50));", "50\n");
    check("function deep(n) = n == 0 ? 0 : 1 + deep(n - 1); echo(deep(9000));", "9000\n");
}

static void control_flow_runs_in_order(void **state)
{
    check("if (1) echo(\"a\"); else echo(\"b\"); if (0) echo(\"c\"); else if (1) echo(\"d\");",
          "\"a\"\n\"d\"\n");
    check("for (i = [0 : 1], j = \"ab\") echo(i, j);", "0, \"a\"\n0, \"b\"\n1, \"a\"\n1, \"b\"\n");
    check("intersection_for (i = [1 : 2]) { echo(i); sphere(i); }", "1\n2\n");
    check("echo(\"before\") echo(\"inside\");", "\"before\"\n\"inside\"\n");
    check("assert(true) echo(1); assert(1 < 2, \"no\");", "1\n");
    check("*echo(1); %echo(2); #echo(3);", "2\n3\n");
    check("x = echo(\"hi\") 3; echo(x);", "\"hi\"\n3\n");
    check("assign (a = 3) echo(a);", "3\n");
}

/* Where OpenSCAD 2021.01 says something else, and this is better. */
static void differences_are_on_purpose(void **state)
{
    check("echo(0x1F, \"\\u{e9}\");", "31, \"\xC3\xA9\"\n");
    check("fs = [for (i = [0 : 2]) function (x) x * i]; echo([for (f = fs) f(1)]);", "[0, 1, 2]\n");
    check("function f(x) = echo(x) x; echo(f(1) + f(2) * f(3));", "1\n2\n3\n7\n");
    check("module m(a, b) echo(a, b); m(echo(\"a\") 1, echo(\"b\") 2);", "\"a\"\n\"b\"\n1, 2\n");
    check("function f(a, b) = a + b; echo(f(1, 2, ), max(1, 2, ), [for (i = [0 : 1]) (each [i])]);",
          "3, 2, [0, 1]\n");
    check("echo(rands(0, 1, 1)[0], rands(0, 1, 1)[0]);", "0.592845, 0.844266\n");
    check("echo(cos(1e22) == cos(1e22), $preview);", "true, false\n");
    assert_int_equal(bench_compile(&b, "x = 10mm;"), CSGM_ERR_SCENE);
    assert_int_equal(bench_compile(&b, "x = nothing(1);"), CSGM_ERR_SCENE);
    assert_int_equal(bench_compile(&b, "if (true) x = 1;"), CSGM_ERR_SYNTAX);
}

/* `next` of a loop may add variables; a function of a variable goes before a named one. */
static void names_are_found_where_openscad_finds_them(void **state)
{
    check("echo([for (i = 0; i < 3; i = i + 1, k = i) is_undef(k) ? -1 : k]);", "[-1, 1, 2]\n");
    check("function f(x) = 1; echo(f(0)); module m(f) echo(f(0)); m(function (x) 2); m(3);",
          "1\n2\n1\n");
    check("module m() { n() echo($children); } module n() children(); m() { echo(1); echo(2); }",
          "2\n");
    check("module m() { echo($parent_modules); if ($parent_modules < 3) m(); } m();", "1\n2\n3\n");
    check("1st = 5; function 2nd(3rd) = 3rd + 1st; echo(2nd(1), 2nd(3rd = 2));", "6, 7\n");
    check("let (a = 1, a = 2) echo(a);", "1\n");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(echo_prints_what_openscad_prints),
        cmocka_unit_test(blends_of_the_table_are_blends),
        cmocka_unit_test(scopes_are_lexical_and_the_last_assignment_holds),
        cmocka_unit_test(special_variables_are_dynamic),
        cmocka_unit_test(children_are_chosen_by_index),
        cmocka_unit_test(functions_recurse_and_tail_calls_are_free),
        cmocka_unit_test(control_flow_runs_in_order),
        cmocka_unit_test(differences_are_on_purpose),
        cmocka_unit_test(names_are_found_where_openscad_finds_them),
    };
    return cmocka_run_group_tests(tests, open_bench, close_bench);
}
