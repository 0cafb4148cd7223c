/* SPDX-License-Identifier: MIT
 * The words of a finding, golden; counting, the cap, warnings as errors, snprintf's rules.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <string.h>

#include "base/context.h"

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
} heard;

static void hear(void *user, const csgm_diag *diag)
{
    heard *h = user;
    h->count++;
    h->last = *diag;
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

static void test_cap(void **state)
{
    heard h = {0};
    csg_diag_sink sink = {.on_diag = hear, .user = &h};
    for (int i = 0; i < CSG_DIAG_MOST + 5; i++) {
        csg_diag_plain(&sink, CSG_DIAG_OUT_OF_MEMORY, NULL, NULL, "%d", i);
        csg_diag_plain(&sink, CSG_DIAG_NOTE, NULL, NULL, "a note");
    }
    assert_int_equal(h.count, 2 * CSG_DIAG_MOST);
    assert_int_equal(sink.errors, CSG_DIAG_MOST + 5);
    assert_int_equal(sink.dropped, 5);
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
        cmocka_unit_test(test_small_buffers),
        cmocka_unit_test(test_severity_comes_from_the_table),
        cmocka_unit_test(test_cap),
        cmocka_unit_test(test_out_of_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
