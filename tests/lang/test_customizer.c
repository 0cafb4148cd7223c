/* SPDX-License-Identifier: MIT
 * Parameters: which assignments are some, what the comments around them say, parameter sets, what
 * cannot be read, memory. (The program's side of it is in tests/cli/test_params.py; OpenSCAD's own
 * reading of the same comments in tests/data/openscad/customizer.)
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "lang/bench_fixture.h"
#include "lang/parameters/customizer.h"
#include "text/json.h"

static csgm_params *params;

static int close_all(void **state)
{
    csg_params_destroy(params);
    params = NULL;
    return close_bench(state);
}

static csgm_status list(const char *text, const csgm_scene_options *options)
{
    csg_params_destroy(params);
    params = NULL;
    csg_lang_input input = {
        .path = "scene.txt", .text = text, .text_length = strlen(text), .options = options};
    return csg_lang_parameters(&b.context, &input, &params);
}

static const csgm_param *find(const char *name)
{
    for (uint32_t i = 0; i < params->count; i++)
        if (strcmp(params->items[i].name, name) == 0)
            return &params->items[i];
    return NULL;
}

static const csgm_param *hinted(const char *value, const char *hint)
{
    char text[256];
    snprintf(text, sizeof text, "x = %s; //%s\n", value, hint);
    assert_int_equal(list(text, NULL), CSGM_OK);
    assert_non_null(find("x"));
    return find("x");
}

/* ---- which are parameters ------------------------------------------------------------------- */

static void literals_above_the_first_brace(void **state)
{
    (void)state;
    assert_int_equal(list("a = 1; b = \"s\"; c = true; d = [1, -2]; e = -3; f = !true; g = +.5;\n"
                          "h = 1 + 2; i = a; j = undef; k = [0 : 5]; l = [1, \"x\"]; m = [];\n"
                          "n = [[1]]; o = \"{\"; // {\n"
                          "/* { */ p = 1;\n"
                          "q = 1; module z() { }\n"
                          "r = 1;\n",
                          NULL),
                     CSGM_OK);
    static const char *const wanted[] = {"a", "b", "c", "d", "e", "f", "g", "o", "p"};
    assert_int_equal(params->count, sizeof wanted / sizeof *wanted);
    for (uint32_t i = 0; i < params->count; i++)
        assert_string_equal(params->items[i].name, wanted[i]);
    assert_true(find("e")->initial.numbers[0] == -3 && find("g")->initial.numbers[0] == 0.5);
    assert_true(find("d")->initial.number_count == 2 && find("d")->initial.numbers[1] == -2);
    assert_int_equal(find("f")->initial.kind, CSGM_PARAM_BOOLEAN);
    assert_true(find("f")->initial.numbers[0] == 0);
    assert_string_equal(find("o")->initial.text, "{");
}

static void the_last_assignment_counts(void **state)
{
    (void)state;
    assert_int_equal(list("a = 1; // [1:5]\n/* [Two] */\na = 7; // [6:9]\n", NULL), CSGM_OK);
    assert_int_equal(params->count, 1);
    assert_true(params->items[0].initial.numbers[0] == 7 && params->items[0].maximum == 9);
    assert_string_equal(params->items[0].section, "Two");
    assert_int_equal(params->items[0].line, 3);
}

static void sections_and_descriptions(void **state)
{
    (void)state;
    assert_int_equal(list("a = 1;\n"
                          "/* [One] */\n"
                          "//  of b // twice\n"
                          "b = 2;\n"
                          "  // indented: none\n"
                          "c = 3; /* no section */\n"
                          "/* [Two] [Three] */\n"
                          "//\n"
                          "d = 4;\r\n"
                          "// of e\r\n"
                          "e = 5;\r\n"
                          "/* [not\none] */\n"
                          "f = \"/* [Four] */\";\n",
                          NULL),
                     CSGM_OK);
    assert_string_equal(find("a")->section, "Parameters");
    assert_null(find("a")->description);
    assert_string_equal(find("b")->section, "One");
    assert_string_equal(find("b")->description, "of b   twice");
    assert_string_equal(find("c")->section, "One");
    assert_null(find("c")->description);
    assert_string_equal(find("d")->section, "Two-Three");
    assert_null(find("d")->description);
    assert_string_equal(find("e")->description, "of e");
    assert_string_equal(find("f")->section, "Two-Three");
}

/* ---- hints ------------------------------------------------------------------------------------
 */

static void ranges_and_steps(void **state)
{
    const csgm_param *p;
    (void)state;
    p = hinted("5", " [1:10]");
    assert_true(p->minimum == 1 && p->maximum == 10 && isnan(p->step));
    p = hinted("5", "[ -1 : .5 : 1e1 ]  ");
    assert_true(p->minimum == -1 && p->step == 0.5 && p->maximum == 10);
    p = hinted("[1, 2]", "[0:9]");
    assert_true(p->minimum == 0 && p->maximum == 9);
    p = hinted("5", " [100]");
    assert_true(isnan(p->minimum) && p->maximum == 100);
    p = hinted("5", " .5");
    assert_true(p->step == 0.5 && isnan(p->maximum));
    p = hinted("\"abc\"", " 8");
    assert_int_equal(p->length_most, 8);
    p = hinted("\"abc\"", " [8]");
    assert_int_equal(p->length_most, 8);
    p = hinted("true", " [1:5]");
    assert_true(isnan(p->minimum));
}

static void choices(void **state)
{
    const csgm_param *p;
    (void)state;
    p = hinted("10", "[10, 20, x y]");
    assert_int_equal(p->choice_count, 3);
    assert_true(p->choices[1].value.kind == CSGM_PARAM_NUMBER &&
                p->choices[1].value.numbers[0] == 20);
    assert_string_equal(p->choices[1].label, "20");
    assert_string_equal(p->choices[2].value.text, "x y");
    p = hinted("\"S\"", "[S:Small one, \"M:m\":\"a \\\"b\\\"\", 3:three]");
    assert_int_equal(p->choice_count, 3);
    assert_string_equal(p->choices[0].label, "Small one");
    assert_string_equal(p->choices[1].value.text, "M:m");
    assert_string_equal(p->choices[1].label, "a \"b\"");
    assert_string_equal(p->choices[2].value.text, "3");
    p = hinted("1", "[-1:neg, 2.5:half]");
    assert_true(p->choices[0].value.numbers[0] == -1 && p->choices[1].value.numbers[0] == 2.5);
    assert_int_equal(hinted("[1, 2]", "[a, b]")->choice_count, 0);
}

static void what_is_no_hint_says_nothing(void **state)
{
    static const char *const texts[] = {"",       " see [1:2]",  " [1:2] and more", " [1,2",
                                        " []",    " [1,,2]",     " [1:2:3:4]",      " [a:b:c]",
                                        " max 7", " 1:2",        " [\"a]",          " 0x10",
                                        " nan",   " [[1,2],3]",  " [,1]",           " [1,]",
                                        " 1e999", " [1:2] // x", " [a\"b]"};
    (void)state;
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        const csgm_param *p = hinted("5", texts[i]);
        bool odd_word = strcmp(texts[i], " [a\"b]") == 0; /* a word of its own */
        assert_true(isnan(p->minimum) && isnan(p->maximum) && isnan(p->step));
        assert_int_equal(p->choice_count, odd_word ? 1 : 0);
    }
    assert_int_equal(list("a = 1; b = 2; // [1:5]\nc = \"; // [1:2]\";\n", NULL), CSGM_OK);
    assert_true(isnan(find("a")->minimum) && isnan(find("b")->minimum));
    assert_int_equal(find("c")->length_most, 0);
}

static void long_texts_take_linear_time(void **state)
{
    enum { LINES = 100000, ROOM = LINES * 40 };
    char *text = malloc(ROOM);
    size_t used = 0;
    (void)state;
    assert_non_null(text);
    for (int i = 0; i < LINES; i++)
        used += (size_t)snprintf(text + used, ROOM - used, "a%d = %d; // [0:%d]\n", i, i, i + 1);
    assert_int_equal(list(text, NULL), CSGM_OK);
    assert_int_equal(params->count, LINES);
    assert_true(params->items[LINES - 1].maximum == LINES);
    free(text);
}

/* ---- values from outside ------------------------------------------------------------------------
 */

static void overrides_are_told_apart(void **state)
{
    csgm_define defines[] = {{"a", "2 * b"}, {"c", "\"new\""}};
    csgm_scene_options options = {.defines = defines, .define_count = 2};
    (void)state;
    assert_int_equal(list("b = 21; a = 1; c = \"old\"; assert(b > 0);\n", &options), CSGM_OK);
    assert_true(find("a")->is_overridden && find("a")->value.numbers[0] == 42);
    assert_true(find("a")->initial.numbers[0] == 1);
    assert_true(!find("b")->is_overridden && find("b")->value.numbers[0] == 21);
    assert_string_equal(find("c")->value.text, "new");
    assert_string_equal(find("c")->initial.text, "old");
}

static char set_path[] = "/tmp/csgmesh-sets-XXXXXX";

static csgm_status with_set(const char *scene, const char *json, size_t length)
{
    FILE *file = fopen(set_path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(json, 1, length, file), length);
    assert_int_equal(fclose(file), 0);
    csgm_scene_options options = {.parameter_file = set_path, .parameter_set = "s"};
    return list(scene, &options);
}

static const char SCENE[] = "n = 1; s = \"\"; t = false; v = [0]; m = [[1]]; k = n;\n";
static const char SETS[] =
    "{\"x\": [1, {\"parameterSets\": {}}], \"parameterSets\": {\"r\": {\"n\": 9},"
    " \"s\": {\"n\": \" 2.5 \", \"s\": \"a\\\"\\u00e9\\n\", \"t\": 1,"
    " \"v\": [1, -2.5e1, 3], \"m\": [[1, \"q\\\"\"], []], \"k\": 3}},"
    " \"fileFormatVersion\": 1}";

static void a_set_is_applied(void **state)
{
    (void)state;
    if (!csg_json_available())
        skip();
    assert_int_equal(with_set(SCENE, SETS, sizeof SETS - 1), CSGM_OK);
    assert_true(find("n")->value.numbers[0] == 2.5 && find("t")->value.numbers[0] == 1);
    assert_string_equal(find("s")->value.text, "a\"\xC3\xA9\n");
    assert_true(find("v")->value.number_count == 3 && find("v")->value.numbers[1] == -25);
    assert_non_null(strstr(b.text, "the scene computes its value"));
}

/* Whatever is cut off or changed: a finding or a set, never worse. */
static void broken_files_are_findings(void **state)
{
    char text[sizeof SETS];
    (void)state;
    if (!csg_json_available())
        skip();
    for (size_t length = 0; length < sizeof SETS - 1; length++)
        assert_int_not_equal(with_set(SCENE, SETS, length), CSGM_OK);
    for (size_t i = 0; i < sizeof SETS - 1; i++) {
        memcpy(text, SETS, sizeof SETS);
        text[i] ^= 1;
        csgm_status status = with_set(SCENE, text, sizeof SETS - 1);
        assert_true(status == CSGM_OK || status == CSGM_ERR_SYNTAX || status == CSGM_ERR_SCENE);
        assert_true((status == CSGM_OK) == (params != NULL));
    }
}

/* ---- memory -------------------------------------------------------------------------------------
 */

static size_t allocations_left;

static void *scarce(void *user, size_t size_bytes)
{
    (void)user;
    return allocations_left-- > 0 ? malloc(size_bytes) : NULL;
}

static void give_back(void *user, void *memory, size_t size_bytes)
{
    (void)user, (void)size_bytes;
    free(memory);
}

static void the_nth_allocation_fails(void **state)
{
    csgm_allocator allocator = {scarce, give_back, NULL};
    csgm_status status = CSGM_ERR_MEMORY;
    (void)state;
    if (!csg_json_available())
        skip();
    static const char sets[] = "{\"parameterSets\": {\"s\": {\"n\": 3, \"v\": [1, 2]}}}";
    for (size_t n = 0; status != CSGM_OK; n++) {
        bench_close(&b);
        bench_open(&b, &allocator);
        allocations_left = n;
        status = with_set("/* [A] */\n// b\nn = 1; // [1:x, \"2\":y]\ns = \"\"; // 4\nv = [1];\n",
                          sets, sizeof sets - 1);
        assert_true((status == CSGM_OK) == (params != NULL));
        allocations_left = SIZE_MAX;
        csg_params_destroy(params);
        params = NULL;
        assert_true(n < 2000);
    }
}

int main(void)
{
    int file = mkstemp(set_path);
    if (file < 0)
        return 1;
    close(file);
#define TEST(name) cmocka_unit_test_setup_teardown(name, open_bench, close_all)
    const struct CMUnitTest tests[] = {
        TEST(literals_above_the_first_brace),
        TEST(the_last_assignment_counts),
        TEST(sections_and_descriptions),
        TEST(ranges_and_steps),
        TEST(choices),
        TEST(what_is_no_hint_says_nothing),
        TEST(long_texts_take_linear_time),
        TEST(overrides_are_told_apart),
        TEST(a_set_is_applied),
        TEST(broken_files_are_findings),
        TEST(the_nth_allocation_fails),
    };
    int failures = cmocka_run_group_tests(tests, NULL, NULL);
    unlink(set_path);
    return failures;
}
