/* SPDX-License-Identifier: MIT
 * Input that means harm: every scene ends within its limits with a finding; an allocator that
 * fails at the n-th call; mutated and random bytes.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/random.h"
#include "failing.h"
#include "lang/bench_fixture.h"
#include "rounds.h"

static void check_limit(const char *scene, int code)
{
    csgm_status status = bench_compile(&b, scene);
    if (status != CSGM_ERR_LIMIT || !bench_has(&b, code) || b.code_count != 1)
        print_error("%.200s\n%.2000s", scene, b.text);
    assert_int_equal(status, CSGM_ERR_LIMIT);
    assert_int_equal(b.code_count, 1);
    assert_int_equal(b.codes[0], code);
}

static void loops_and_recursion_end(void **state)
{
    (void)state;
    b.context.limits.eval_steps = 1000000;
    check_limit("for (i = [0 : 1e9]) sphere(1);", 904);
    check_limit("for (i = [0 : 1000], j = [0 : 1000], k = [0 : 1000]) let (a = 1) {}", 904);
    check_limit("x = [for (i = 0; true; i = i + 1) 0];", 904);
    check_limit("x = [for (i = [0 : 1e-9 : 1]) 0];", 904);
    assert_int_equal(bench_compile(&b, "x = [for (i = [0 : 0 : 1]) 0];"), CSGM_OK);
    assert_non_null(strstr(b.text, "W0211"));
    check_limit("function f(n) = f(n + 1); x = f(0);", 904);
    check_limit("function f(n) = 1 + f(n + 1); x = f(0);", 903);
    check_limit("f = function (n) 1 + f(n + 1); x = f(0);", 903);
    check_limit("function f(n) = 1 + g(n); function g(n) = 1 + f(n); x = f(0);", 903);
    check_limit("module a() b(); module b() a(); a();", 903);
    check_limit("module a() { a(); a(); } a();", 903);
    check_limit("module a() { children(); a() children(); } a() sphere(1);", 904);
    check_limit("module a(n) if (n > 0) { a(n - 1); a(n - 1); } a(60);", 904);
    check_limit("function f(n) = n == 0 ? 1 : f(n - 1) + f(n - 1); x = f(60);", 904);
    check_limit("function f(v, n) = n == 0 ? v : f([v, v], n - 1); x = f(1, 40); y = x == x;", 904);
    check_limit("function f(v) = f([v]); x = f(1);", 903);
    check_limit("x = rands(0, 1, 1e9);", 906);
    check_limit("a = [for (i = [0 : 90000]) i]; for (i = [0 : 90000]) echo(a);", 904);
    check_limit("function f(s, n) = n == 0 ? s : f(str(s, s), n - 1); a = f(\"ab\", 14); "
                "x = search(a, a);",
                904);
    check_limit("function f(s, n) = n == 0 ? s : f(str(s, s), n - 1); a = f(\"\\u{e9}\", 14); "
                "x = [for (i = [0 : len(a) - 1]) a[i]];",
                904);
    check_limit("function f(s, n) = n == 0 ? s : f(str(s, s), n - 1); a = f(\"ab\", 14); "
                "for (i = [0 : 90000]) if (len(str(a)) < 0) sphere(1);",
                904);
    b.context.limits.eval_steps = 1000000000;
    check_limit("function f(s) = f(str(s, s)); x = f(\"ab\");", 907);
    check_limit("function f(v, n) = n == 0 ? v : f([v, v], n - 1); s = str(f(1, 40));", 907);
    check_limit("function f(v) = f(concat(v, v)); x = f([1]);", 906);
    b.context.limits.scene_nodes = 1000;
    check_limit("for (i = [0 : 2000]) translate([i, 0, 0]) sphere(1);", 905);
    b.context.limits.scene_nodes = 4000000;
    b.context.limits.timeout_s = 0.05;
    check_limit("function f(n) = f(n + 1); x = f(0);", 902);
    b.context.limits.timeout_s = 0;
}

/* `before` + count times `open` + `middle` + count times `close` */
static char *repeat(const char *before, const char *open, const char *middle, const char *close,
                    size_t count)
{
    char *text =
        malloc(strlen(before) + strlen(middle) + count * (strlen(open) + strlen(close)) + 1);
    assert_non_null(text);
    char *at = stpcpy(text, before);
    for (size_t i = 0; i < count; i++)
        at = stpcpy(at, open);
    at = stpcpy(at, middle);
    for (size_t i = 0; i < count; i++)
        at = stpcpy(at, close);
    return text;
}

static void nesting_ends(void **state)
{
    static const struct {
        const char *before, *open, *middle, *close;
    } deep[] = {{"x = ", "(", "1", ");"},
                {"x = ", "[", "", "];"},
                {"x = ", "-", "1;", ""},
                {"x = ", "!", "1;", ""},
                {"x = ", "1 ? ", "1;", ""},
                {"x = ", "2 ^ ", "1;", ""},
                {"", "{", "", "}"},
                {"", "union() ", "sphere();", ""},
                {"", "if (1) ", "sphere();", ""},
                {"x = [", "for (i = 1) ", "1];", ""},
                {"x = [", "each ", "1];", ""},
                {"x = ", "let (a = 1) ", "1;", ""},
                {"x = ", "f(", "1", ")"},
                {"x = ", "function (a) ", "1;", ""},
                {"", "module m() {", "", "}"},
                {"x = [", "(for (i = 1) ", "1", ")];"}};
    (void)state;
    for (size_t i = 0; i < sizeof deep / sizeof *deep; i++) {
        char *text = repeat(deep[i].before, deep[i].open, deep[i].middle, deep[i].close, 100000);
        check_limit(text, 903);
        free(text);
        text = repeat(deep[i].before, deep[i].open, deep[i].middle, deep[i].close, 4000);
        bench_compile(&b, text); /* whatever it means, it comes back */
        free(text);
    }
}

static void long_chains_are_no_nesting(void **state)
{
    (void)state;
    char *text = repeat("x = 1", " + 1", "; echo(x); sphere(1);", "", 100000);
    assert_int_equal(bench_compile(&b, text), CSGM_OK);
    assert_string_equal(b.echo, "100001\n");
    free(text);
    text = repeat("x = [[1]]", "[0]", "; sphere(1);", "", 50000);
    assert_int_equal(bench_compile(&b, text), CSGM_OK);
    free(text);
    text = repeat("", "translate([0, 0, 1]) ", "sphere(1);", "", 9000);
    assert_int_equal(bench_compile(&b, text), CSGM_OK);
    free(text);
}

/* ---- memory that runs out ---------------------------------------------------------------------
 */

static const char rich[] =
    "// everything once\n"
    "$fn = 40; r = 3; n = 5; v = [for (i = [0 : n]) if (i != 2) each [i, i * r]];\n"
    "function f(x, y = 2) = let (z = x + y) z > 3 ? str(z, v) : f(x + 1, y = y);\n"
    "g = function (a) [a, concat(v, [a, \"t\"]), \"s\"[0]];\n"
    "module wheel(r, h = 1) { difference(blend = cosine(0.2)) { cylinder(r = r, h = h, round = "
    "0.1);"
    " translate([0, 0, -1]) cylinder(r = r / 2, h = h + 2); blend(0.3) children(); } }\n"
    "echo(f(0), g(1), search(\"a\", \"banana\", 0), lookup(1, [[0, 1], [2, 3]]));\n"
    "for (k = [0 : 2]) translate([k * 9, 0, 0]) #wheel(r) { %capsule([1, 0, 0], [2, 0, 0], 1); "
    "sphere(0.5); cube([1, 2, 3], center = "
    "true); }\n"
    "intersection_for (a = [0, 40]) rotate([a, 0, a]) color(\"teal\") cube(4, round = 0.5);\n"
    "union(blend = 0.5) { torus(5, 1, 200); capsule([0, 0, 0], [3, 0, 0], 1, 0.5); ellipsoid([1, "
    "2, 3]); }\n"
    "shpere(oops); x = 1; x = 2; assert(r == 3); echo(rands(0, 1, 3), chr([65 : 70]));\n";

static void every_allocation_may_fail(void **state)
{
    static bench poor;
    failing f = {0};
    const csgm_allocator allocator = {failing_alloc, failing_release, &f};
    long n = 0, failures = 0;
    (void)state;
    bench_open(&poor, &allocator);
    for (;; n += n < 600 ? 1 : n / 50) {
        f.left = n;
        csgm_status status = bench_compile(&poor, rich);
        bool failed = f.left < 0;
        if (!failed) {
            assert_int_equal(status, CSGM_ERR_SCENE); /* shpere */
            break;
        }
        assert_int_equal(status, CSGM_ERR_MEMORY);
        assert_true(bench_has(&poor, 901));
        assert_int_equal(f.live, 0);
        failures++;
    }
    bench_close(&poor);
    assert_true(failures > 100);
}

static void the_memory_limit_holds(void **state)
{
    (void)state;
    b.context.memory.limit_bytes = 20 << 20;
    assert_int_equal(bench_compile(&b, "function f(v) = f(concat(v, v)); x = f([1]);"),
                     CSGM_ERR_MEMORY);
    assert_true(bench_has(&b, 901));
    b.context.memory.limit_bytes = 0;
}

/* What lists of one length have left is there for those of another: 28 rounds take what the largest
 * of them does, not the sum of all. */
static void the_dead_make_room(void **state)
{
    (void)state;
    b.context.memory.limit_bytes = 40 << 20;
    assert_int_equal(
        bench_compile(&b, "function made(n, k) = len([for (i = [1 : n]) [for (j = [1 : k]) j]]);"
                          "x = [for (k = [1 : 28]) made(20000, k)]; cube(x[0]);"),
        CSGM_OK);
    b.context.memory.limit_bytes = 0;
}

/* ---- noise
 * ------------------------------------------------------------------------------------------ */

static void mutate(csg_random *random, char *text, size_t *length)
{
    static const char *const snippets[] = {"(",          ")",     "{",           "}",
                                           "[",          "]",     ";",           ",",
                                           "\"",         "/*",    "for",         "let",
                                           "=",          "==",    "function",    "module m()",
                                           "children()", "each ", "undef",       "1e999",
                                           "-",          "$fn",   "include <x>", "!",
                                           "\\",         "?:"};
    size_t at = csg_random_below(random, (uint32_t)*length);
    switch (csg_random_below(random, 4)) {
    case 0:
        text[at] = (char)csg_random_next(random);
        break;
    case 1: { /* cut */
        size_t cut = csg_random_below(random, 20);
        cut = cut < *length - at ? cut : *length - at - 1;
        memmove(text + at, text + at + cut, *length - at - cut);
        *length -= cut;
        break;
    }
    default: {
        const char *snippet =
            snippets[csg_random_below(random, sizeof snippets / sizeof *snippets)];
        size_t size = strlen(snippet);
        memmove(text + at + size, text + at, *length - at);
        memcpy(text + at, snippet, size);
        *length += size;
    }
    }
}

static void noise_never_crashes(void **state)
{
    csg_random random = {20240607};
    size_t rounds = 0, understood = 0;
    (void)state;
    b.context.limits.eval_steps = 200000;
    b.context.limits.scene_nodes = 10000;
    for (; rounds < ROUNDS(3000); rounds++) {
        char text[4096];
        size_t length = sizeof rich - 1;
        memcpy(text, rich, length);
        for (uint32_t k = 1 + csg_random_below(&random, 6); k > 0; k--)
            mutate(&random, text, &length);
        if (rounds % 16 == 0)
            for (size_t i = 0; i < length; i++)
                text[i] = (char)(rounds % 32 ? 32 + csg_random_below(&random, 95)
                                             : csg_random_next(&random));
        csgm_status status = bench_compile_bytes(&b, text, length, NULL);
        understood += status == CSGM_OK || status == CSGM_ERR_SCENE;
        assert_true(status == CSGM_OK || b.code_count > 0);
    }
    assert_true(understood > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(loops_and_recursion_end),    cmocka_unit_test(nesting_ends),
        cmocka_unit_test(long_chains_are_no_nesting), cmocka_unit_test(every_allocation_may_fail),
        cmocka_unit_test(the_memory_limit_holds),     cmocka_unit_test(the_dead_make_room),
        cmocka_unit_test(noise_never_crashes),
    };
    return cmocka_run_group_tests(tests, open_bench, close_bench);
}
