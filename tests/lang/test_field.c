/* SPDX-License-Identifier: MIT
 * field(): functions that become formulas, and those that cannot.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "lang/bench_fixture.h"
#include "scene/reference.h"
#include "scene/tree/print.h"

static double value_at(csg_vec3 p)
{
    csgm_status status = CSGM_OK;
    csg_sample sample = csg_reference_eval(b.scene, p, &status);
    assert_int_equal(status, CSGM_OK);
    return sample.value;
}

/* The formula of p, as the value at (0.3, -0.7, 1.1); declarations go before. */
static void check(const char *declarations, const char *formula, double wanted)
{
    char scene[1024];
    snprintf(
        scene, sizeof scene,
        "%s field(function (p) %s, domain = [[0.2, -0.8, 1], [0.4, -0.6, 1.2]], lipschitz = 1000);",
        declarations, formula);
    csgm_status status = bench_compile(&b, scene);
    if (status != CSGM_OK || b.code_count)
        print_error("%s\n%s", scene, b.text);
    assert_int_equal(status, CSGM_OK);
    assert_int_equal(b.code_count, 0);
    double value = value_at(csg_vec3_make(0.3, -0.7, 1.1));
    if (!(fabs(value - wanted) <= 1e-12 * (1 + fabs(wanted))))
        fail_msg("%s: %.17g, expected %.17g", formula, value, wanted);
}

static void test_formulas(void **state)
{
    check("", "p.x", 0.3);
    check("", "p[1] + p.z", 0.4);
    check("", "-p.x - 2", -2.3);
    check("", "2 - p.x * 3 / 2", 2 - 0.45);
    check("", "1 / (p.z + 1)", 1 / 2.1);
    check("", "p.z % 0.25", 0.1);
    check("", "p.y ^ 2 + p.z ^ 3 + p.z ^ -1 + p.z ^ 0.5", 0.49 + 1.331 + 1 / 1.1 + sqrt(1.1));
    check("", "pow(p.z, p.x) + 2 ^ p.x", pow(1.1, 0.3) + pow(2, 0.3));
    check("", "min(p) + max(p) + min(p.x, 0) + max([p.x, 5])", -0.7 + 1.1 + 0 + 5);
    check("", "abs(p.y) + sqrt(p.x) + exp(p.x) + ln(p.x) + log(p.x)",
          0.7 + sqrt(0.3) + exp(0.3) + log(0.3) + log10(0.3));
    check("", "floor(p.y) + ceil(p.y) + round(p.z)", -1 + 0 + 1);
    check("", "sin(90 * p.x) + cos(60 * p.y) + tan(30 * p.z)",
          sin(0.3 * M_PI / 2) + cos(0.7 * M_PI / 3) + tan(1.1 * M_PI / 6));
    check("", "asin(p.x) + acos(p.x) + atan(p.z) + atan2(p.y, p.x)",
          90 + (atan(1.1) + atan2(-0.7, 0.3)) * 180 / M_PI);
}

static void test_vectors(void **state)
{
    double norm = sqrt(0.09 + 0.49 + 1.21);
    check("", "norm(p) + norm([p.x, 4 / 3 * p.x])", norm + 0.5);
    check("", "p * p + dot(p, [1, 2, 3])", norm * norm + 0.3 - 1.4 + 3.3);
    check("", "cross(p, [0, 0, 1]).x + cross([p.x, p.y], [1, 2])", -0.7 + 0.6 + 0.7);
    check("", "let (q = (p - [1, 1, 1]) * 2 / 4) q.x + q[1] * q.z", -0.35 - 0.85 * 0.05);
    check("R = [[0, 1, 0], [1, 0, 0], [0, 0, 2]];",
          "(R * p).x + (p * R).z * 10 + (R * [[p.x], [p.y], [p.z]])[1][0] * 100", -0.7 + 22 + 30);
    check("", "(-p).y + (2 * p).x + (1 / p).z + len(p) + (is_num(p.x) ? 10 : 0)",
          0.7 + 0.6 + 1 / 1.1 + 3 + 10);
}

static void test_programs(void **state)
{
    check("function total(v, i = 0) = i == len(v) ? 0 : v[i] + total(v, i + 1);",
          "total([for (i = [1 : 4]) p.x ^ i])", 0.3 + 0.09 + 0.027 + 0.0081);
    check("f = function (a, b) a * b; k = 3;", "f(p.x, k) + f(2, k)", 6.9);
    check("", "p.x * 0 > 1 ? p.y : p.z", 1.1); /* what is known is no condition on the point */
    check("", "1 + 2", 3);
    assert_int_equal(bench_compile(&b, "d = function (p, r = 2) r - norm(p); field(d);"), CSGM_OK);
    assert_true(fabs(value_at(csg_vec3_make(0, 0, 3)) + 1) < 1e-12);
    assert_true(fabs(csg_scene_lipschitz(b.scene) - 1) < 1e-12);
}

static void test_findings(void **state)
{
    static const struct {
        const char *text;
        int code;
    } rows[] = {
        {"field(function (p) p.x > 0 ? 1 : 2);", 311},
        {"field(function (p) p.x == 0 ? 1 : 2);", 311},
        {"field(function (p) p.x ? 1 : 2);", 311},
        {"field(function (p) !p.x ? 1 : 2);", 311},
        {"field(function (p) p.x && true ? 1 : 2);", 311},
        {"field(function (p) [1, 2][p.x]);", 311},
        {"field(function (p) sign(p.x));", 311},
        {"field(function (p) lookup(p.x, [[0, 1], [1, 2]]));", 311},
        {"field(function (p) rands(0, p.x, 1)[0]);", 311},
        {"field(function (p) p);", 301},
        {"field(function (p) undef);", 301},
        {"field(function () 1);", 301},
        {"field(1);", 301},
        {"field();", 301},
        {"field(function (p) p.x, bounds = 3);", 301},
        {"field(function (p) p.x, bounds = [[0, 0, 0], [1, 0, 1]]);", 302},
        {"field(function (p) p.x, lipschitz = 0);", 302},
        {"field(function (p) sqrt(p.x));", 308},
        {"field(function (p) p.x ^ 2);", 308},
        {"field(function (p) floor(p.x), bounds = [[-1, -1, -1], [1, 1, 1]]);", 308},
        {"field(function (p) p.x * (1 / 0), lipschitz = 1);", 308},
        {"function f(x, n) = n == 0 ? x : f(sin(x * n) + cos(x + n) * x, n - 1);"
         "field(function (p) f(p.x, 30000), lipschitz = 1);",
         910},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        assert_int_not_equal(bench_compile(&b, rows[i].text), CSGM_OK);
        if (!bench_has(&b, rows[i].code))
            fail_msg("%s: no finding %d, but %s", rows[i].text, rows[i].code, b.text);
    }
}

/* ---- printing ----------------------------------------------------------------------------------
 */

typedef struct printed {
    char text[16384];
    size_t length;
} printed;

static void collect(void *user, const char *text, size_t length)
{
    printed *out = user;
    assert_true(out->length + length < sizeof out->text);
    memcpy(out->text + out->length, text, length);
    out->length += length;
    out->text[out->length] = '\0';
}

/* A printed field is the same when it is read and printed again. */
static void test_printing(void **state)
{
    static const char *const scenes[] = {
        "field(function (p) 1 - norm(p));",
        "field(function (p) 0.3 - abs(sin(500 * p.x) * cos(500 * p.y) + sin(500 * p.y)));",
        "scale([1, 2, 3]) field(function (p) let (r = norm([p.x, p.y]) - 1) 0.1 - norm([r, p.z])"
        " + r * 0.01, bounds = [[-2, -2, -1], [2, 2, 1.5]]);",
        "field(function (p) p.z % 3 + p.x ^ 2.5 + p.y ^ 7 + atan2(p.x, -p.y) + max(p) + exp(p.x),"
        " lipschitz = 7.25);",
        "field(function (p) 3 - norm(p), lipschitz = 0.5, proven = true);",
        "field(function (p) 3 - norm(p), lipschitz = 0.5);",
        "gyroid(2, 0.3);",
        "field(function (p) 4);",
        "function deep(x, n) = n == 0 ? x : 1 / (2 + sin(deep(x, n - 1)));"
        "field(function (p) deep(p.x, 60), lipschitz = 1);",
    };
    static printed first, second;
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        first.length = second.length = 0;
        assert_int_equal(bench_compile(&b, scenes[i]), CSGM_OK);
        double value = value_at(csg_vec3_make(0.4, 0.5, 0.6));
        assert_int_equal(csg_scene_print(b.scene, collect, &first), CSGM_OK);
        csgm_status status = bench_compile(&b, first.text);
        if (status != CSGM_OK)
            print_error("%s\n%s", first.text, b.text);
        assert_int_equal(status, CSGM_OK);
        assert_int_equal(csg_scene_print(b.scene, collect, &second), CSGM_OK);
        assert_string_equal(first.text, second.text);
        assert_true(value_at(csg_vec3_make(0.4, 0.5, 0.6)) == value);
    }
}

/* ---- memory that fails
 * --------------------------------------------------------------------------- */

typedef struct failing {
    long left; /* allocations until one fails */
} failing;

static void *allocate(void *user, size_t bytes)
{
    failing *f = user;
    return f->left-- == 0 ? NULL : malloc(bytes);
}

static void release(void *user, void *memory, size_t bytes)
{
    free(memory);
}

static void test_no_memory(void **state)
{
    bench_close(&b);
    bool done = false;
    for (long n = 0; !done; n++) {
        failing f = {n};
        csgm_allocator allocator = {allocate, release, &f};
        bench_open(&b, &allocator);
        csgm_status status =
            bench_compile(&b, "field(function (p) let (q = p * 2) 1 - norm(q) + sin(q.x) / 9,"
                              "bounds = [[-1, -1, -1], [1, 1, 1]]);");
        done = f.left >= 0;
        assert_int_equal(status, done ? CSGM_OK : CSGM_ERR_MEMORY);
        bench_close(&b);
        assert_true(n < 10000);
    }
    bench_open(&b, NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_formulas), cmocka_unit_test(test_vectors),
        cmocka_unit_test(test_programs), cmocka_unit_test(test_findings),
        cmocka_unit_test(test_printing), cmocka_unit_test(test_no_memory),
    };
    return cmocka_run_group_tests(tests, open_bench, close_bench);
}
