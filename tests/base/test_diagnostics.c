/* SPDX-License-Identifier: MIT
 * The words of a finding, golden; counting, the cap, warnings as errors, snprintf's rules.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdio.h>
#include <string.h>

#include "base/context.h"
#include "base/mesh_codes.h"
#include "base/scene_codes.h"

static const char line[] = "  sphere(r = -1);";

static csgm_diag finding(void)
{
    return (csgm_diag){.severity = CSGM_ERROR,
                       .code = 107,
                       .source_name = "part.txt",
                       .line = 4,
                       .column = 10,
                       .length = 6,
                       .message = "the radius must be positive",
                       .hint = "sizes are lengths",
                       .source_line = line,
                       .source_line_length = sizeof line - 1};
}

static void check_format(const csgm_diag *diag, const char *expected)
{
    char buffer[512];
    size_t length = csgm_diag_format(diag, buffer, sizeof buffer);
    assert_string_equal(buffer, expected);
    assert_int_equal(length, strlen(expected));
}

static void test_error(void **state)
{
    csgm_diag diag = finding();
    check_format(&diag, "part.txt:4:10: error E0107: the radius must be positive\n"
                        "  sphere(r = -1);\n"
                        "         ^~~~~~\n"
                        "hint: sizes are lengths\n");
}

static void test_plainer_ones(void **state)
{
    csgm_diag diag = finding();
    diag.severity = CSGM_WARNING;
    diag.hint = NULL;
    diag.length = 0;
    check_format(&diag, "part.txt:4:10: warning W0107: the radius must be positive\n"
                        "  sphere(r = -1);\n"
                        "         ^\n");
    diag.severity = CSGM_NOTE;
    diag.source_line = NULL;
    check_format(&diag, "part.txt:4:10: note: the radius must be positive\n");
    diag = (csgm_diag){.severity = CSGM_ERROR, .code = 901, .message = "out of memory"};
    check_format(&diag, "csgmesh: error E0901: out of memory\n");
    diag.source_name = "a.ply";
    check_format(&diag, "a.ply: error E0901: out of memory\n");
}

/* The caret stands under the byte that a screen shows there: tabs stay tabs, a letter of several
 * bytes is one column. */
static void test_caret_under_tabs_and_utf8(void **state)
{
    static const char text[] = "\t\"\xC3\xA4\" x";
    csgm_diag diag = finding();
    diag.hint = NULL;
    diag.source_line = text;
    diag.source_line_length = sizeof text - 1;
    diag.column = 7;
    diag.length = 99; /* cut at the end of the line */
    check_format(&diag, "part.txt:4:7: error E0107: the radius must be positive\n"
                        "\t\"\xC3\xA4\" x\n"
                        "\t    ^\n");
}

/* A wide character takes two columns, one that combines none. */
static void test_caret_under_wide_characters(void **state)
{
    static const char text[] = "\xE6\xBC\xA2 e\xCC\x81 \xE6\xBC\xA2\xE5\xAD\x97;";
    csgm_diag diag = finding();
    diag.hint = NULL;
    diag.source_line = text;
    diag.source_line_length = sizeof text - 1;
    diag.column = 9;
    diag.length = 6;
    check_format(&diag, "part.txt:4:9: error E0107: the radius must be positive\n"
                        "\xE6\xBC\xA2 e\xCC\x81 \xE6\xBC\xA2\xE5\xAD\x97;\n"
                        "     ^~~~\n");
}

/* Nothing of a scene can command the terminal, or turn the direction of its text. */
static void test_control_characters(void **state)
{
    static const char text[] = "a\x1B[31m\xE2\x80\xAE\xFF\x01 b";
    csgm_diag diag = finding();
    diag.hint = NULL;
    diag.source_line = text;
    diag.source_line_length = sizeof text - 1;
    diag.column = sizeof text - 1;
    diag.length = 1;
    check_format(&diag, "part.txt:4:13: error E0107: the radius must be positive\n"
                        "a\xEF\xBF\xBD[31m\xEF\xBF\xBD\xEF\xBF\xBD\xEF\xBF\xBD b\n"
                        "          ^\n");
}

/* Of a long line, what stands around the caret; whole characters. */
static void test_long_lines(void **state)
{
    enum { LENGTH = 3000 };
    char text[LENGTH], shown[4096];
    csgm_diag diag = finding();
    for (size_t i = 0; i < LENGTH; i += 3)
        memcpy(text + i, "\xE6\xBC\xA2", 3);
    diag.hint = NULL;
    diag.source_line = text;
    diag.source_line_length = LENGTH;
    diag.length = 3;
    for (uint32_t at = 0; at < LENGTH; at += 3) {
        diag.column = at + 1;
        size_t length = csgm_diag_format(&diag, shown, sizeof shown);
        assert_true(length < sizeof shown);
        const char *line_begin = strchr(shown, '\n') + 1,
                   *caret_line = strchr(line_begin, '\n') + 1;
        size_t bytes = (size_t)(caret_line - 1 - line_begin);
        bool left = strncmp(line_begin, "...", 3) == 0;
        bool right = strncmp(caret_line - 4, "...", 3) == 0;
        assert_true(left == (at > 105) && right == (at < LENGTH - 105)); /* 70 columns */
        assert_true(bytes <= 3 + 210 + 3);
        assert_int_equal((bytes - 3 * (size_t)left - 3 * (size_t)right) % 3, 0);
        size_t before = left ? 3 + 70 : at / 3 * 2;
        assert_int_equal(strspn(caret_line, " "), before);
        assert_string_equal(caret_line + before, "^~\n");
    }
    diag.source_line_length = 240; /* 160 columns: all of it */
    diag.column = 1;
    csgm_diag_format(&diag, shown, sizeof shown);
    assert_null(strstr(shown, "..."));
}

static void test_small_buffers(void **state)
{
    csgm_diag diag = finding();
    char whole[512], part[512];
    size_t needed = csgm_diag_format(&diag, whole, sizeof whole);
    assert_int_equal(csgm_diag_format(&diag, NULL, 0), needed);
    for (size_t size = 1; size <= needed + 1; size++) {
        memset(part, '#', sizeof part);
        assert_int_equal(csgm_diag_format(&diag, part, size), needed);
        assert_int_equal(strlen(part), size - 1);
        assert_memory_equal(part, whole, size - 1);
        assert_int_equal(part[size], '#');
    }
}

typedef struct heard {
    int count;
    csgm_diag last;
    char message[600];
} heard;

static void hear(void *user, const csgm_diag *diag)
{
    heard *h = user;
    h->count++;
    h->last = *diag;
    snprintf(h->message, sizeof h->message, "%s", diag->message ? diag->message : "");
}

static void test_severity_comes_from_the_table(void **state)
{
    heard h = {0};
    csg_diag_sink sink = {.on_diag = hear, .user = &h};
    csg_diag_report(&sink, CSG_DIAG_EMPTY_SOLID, (csgm_diag){.message = "x"});
    assert_int_equal(h.last.severity, CSGM_WARNING);
    assert_int_equal(h.last.code, CSG_DIAG_EMPTY_SOLID);
    assert_true(sink.warnings == 1 && sink.errors == 0);
    sink.warnings_as_errors = true;
    csg_diag_report(&sink, CSG_DIAG_EMPTY_SOLID, (csgm_diag){.message = "x"});
    assert_int_equal(h.last.severity, CSGM_ERROR);
    assert_true(sink.warnings == 1 && sink.errors == 1);
    assert_non_null(csg_diag_summary(CSG_DIAG_OUT_OF_MEMORY));
    assert_null(csg_diag_summary((csg_diag_code)9999));
}

/* Two findings of one number: this does not compile. */
static const char *name_of(int number)
{
    switch (number) {
#define CSG_DIAG(name, number, severity, summary)                                                  \
    case number:                                                                                   \
        return #name;
#include "base/mesh_codes.def"
#include "base/scene_codes.def"
#undef CSG_DIAG
    default:
        return NULL;
    }
}

static void test_numbers_are_unique(void **state)
{
    assert_string_equal(name_of(901), "OUT_OF_MEMORY");
    assert_null(name_of(999));
}

static void test_errors_are_shown(void **state)
{
    heard h = {0};
    csg_diag_sink sink = {.on_diag = hear, .user = &h};
    for (int i = 0; i < CSG_DIAG_ERRORS_MOST + 5; i++) {
        csg_diag_plain(&sink, CSG_DIAG_OUT_OF_MEMORY, NULL, "a hint", "%d", i);
        csg_diag_plain(&sink, CSG_DIAG_NOTE, NULL, NULL, "a note");
    }
    assert_int_equal(h.count, CSG_DIAG_ERRORS_MOST + CSG_DIAG_ERRORS_IN_FULL);
    assert_int_equal(sink.errors, CSG_DIAG_ERRORS_MOST + 5);
    csg_diag_sum_up(&sink);
    assert_string_equal(h.message, "and 5 more errors");
}

static void test_warnings_alike_are_summed_up(void **state)
{
    heard h = {0};
    csg_diag_sink sink = {.on_diag = hear, .user = &h};
    for (int i = 0; i < 30; i++) {
        csg_diag_plain(&sink, CSG_DIAG_UNKNOWN_VARIABLE, "a.txt", NULL, "%d", i);
        csg_diag_plain(&sink, CSG_DIAG_UNKNOWN_VARIABLE, "b.txt", NULL, "%d", i);
        csg_diag_plain(&sink, CSG_DIAG_BAD_RANGE, "a.txt", NULL, "%d", i);
    }
    assert_int_equal(h.count, 3 * CSG_DIAG_WARNINGS_ALIKE);
    assert_int_equal(sink.warnings, 90);
    csg_diag_plain(&sink, CSG_DIAG_UNKNOWN_MODULE, "a.txt", NULL, "an error is never lost");
    assert_int_equal(h.count, 3 * CSG_DIAG_WARNINGS_ALIKE + 1);
    for (int i = 0; i < 30; i++)
        csg_diag_plain(&sink, CSG_DIAG_THIN_PART, "a.txt", NULL, "nor what a mesh lacks");
    assert_int_equal(h.count, 3 * CSG_DIAG_WARNINGS_ALIKE + 31);
    csg_diag_sum_up(&sink);
    assert_int_equal(h.count, 3 * CSG_DIAG_WARNINGS_ALIKE + 34);
    assert_non_null(strstr(h.message, "and 25 more like W0211 in a.txt: "));
    csg_diag_sum_up(&sink); /* nothing is told twice */
    assert_int_equal(h.count, 3 * CSG_DIAG_WARNINGS_ALIKE + 34);
}

static void test_many_kinds_and_files(void **state)
{
    heard h = {0};
    csg_diag_sink sink = {.on_diag = hear, .user = &h};
    char name[300];
    for (int i = 0; i < 2 * CSG_DIAG_GROUPS_MOST; i++) {
        snprintf(name, sizeof name, "%0200d.txt", i);
        csg_diag_plain(&sink, CSG_DIAG_UNKNOWN_VARIABLE, name, NULL, "%d", i);
    }
    assert_int_equal(h.count, CSG_DIAG_WARNINGS_MOST);
    assert_int_equal(sink.warnings, 2 * CSG_DIAG_GROUPS_MOST);
    csg_diag_sum_up(&sink);
    assert_int_equal(h.count,
                     CSG_DIAG_WARNINGS_MOST + (CSG_DIAG_GROUPS_MOST - CSG_DIAG_WARNINGS_MOST) + 1);
    snprintf(name, sizeof name, "and %d more warnings of other kinds", CSG_DIAG_GROUPS_MOST);
    assert_string_equal(h.message, name);
}

static void test_libraries_are_one_line(void **state)
{
    heard h = {0};
    csg_diag_sink sink = {.on_diag = hear, .user = &h};
    for (int i = 0; i < 3; i++)
        csg_diag_report(&sink, CSG_DIAG_UNKNOWN_VARIABLE,
                        (csgm_diag){.source_name = "x.scad", .library = i ? "BOSL2" : "MCAD"});
    assert_int_equal(h.count, 0);
    csg_diag_report(&sink, CSG_DIAG_UNKNOWN_MODULE, (csgm_diag){.library = "MCAD"});
    assert_int_equal(h.count, 1);
    csg_diag_sum_up(&sink);
    assert_int_equal(h.count, 2);
    assert_string_equal(h.message, "3 warnings inside libraries are not shown (MCAD 1, BOSL2 2); "
                                   "-Wlibraries shows them");
    sink.library_warnings = true;
    csg_diag_report(&sink, CSG_DIAG_UNKNOWN_VARIABLE, (csgm_diag){.library = "MCAD"});
    assert_int_equal(h.count, 3);
    csg_diag_sum_up(&(csg_diag_sink){.warnings_more = 1, .errors_more = 1}); /* nobody listens */
}

static void test_out_of_memory(void **state)
{
    heard h = {0};
    csgm_context context = {.diags = {.on_diag = hear, .user = &h}};
    csg_memory_init(&context.memory, NULL, 64 << 20);
    assert_int_equal(csg_context_no_memory(&context), CSGM_ERR_MEMORY);
    assert_int_equal(h.last.code, CSG_DIAG_OUT_OF_MEMORY);
    csg_diag_sink silent = {0};
    csg_diag_plain(&silent, CSG_DIAG_OUT_OF_MEMORY, NULL, NULL, "nobody listens");
    assert_int_equal(silent.errors, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_error),
        cmocka_unit_test(test_plainer_ones),
        cmocka_unit_test(test_caret_under_tabs_and_utf8),
        cmocka_unit_test(test_caret_under_wide_characters),
        cmocka_unit_test(test_control_characters),
        cmocka_unit_test(test_long_lines),
        cmocka_unit_test(test_small_buffers),
        cmocka_unit_test(test_severity_comes_from_the_table),
        cmocka_unit_test(test_numbers_are_unique),
        cmocka_unit_test(test_errors_are_shown),
        cmocka_unit_test(test_warnings_alike_are_summed_up),
        cmocka_unit_test(test_many_kinds_and_files),
        cmocka_unit_test(test_libraries_are_one_line),
        cmocka_unit_test(test_out_of_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
