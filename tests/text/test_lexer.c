/* SPDX-License-Identifier: MIT
 * Bytes to tokens, and places of findings.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "base/utf8.h"
#include "text/lexer.h"

static csgm_context context;
static csg_arena arena;
static csg_sources sources;
static csg_token_array tokens;
static struct {
    int code;
    uint32_t line, column, length;
    char source_line[128];
} found[8];
static int found_count;

static void on_diag(void *user, const csgm_diag *diag)
{
    (void)user;
    if (found_count == 8)
        return;
    found[found_count].code = diag->code;
    found[found_count].line = diag->line;
    found[found_count].column = diag->column;
    found[found_count].length = diag->length;
    snprintf(found[found_count].source_line, sizeof found[0].source_line, "%.*s",
             (int)diag->source_line_length, diag->source_line ? diag->source_line : "");
    found_count++;
}

static void lex_bytes(const char *text, size_t length)
{
    uint32_t source;
    found_count = 0;
    context.diags = (csg_diag_sink){.on_diag = on_diag};
    csg_tokens_release(&context.memory, &tokens);
    csg_sources_reset(&sources);
    assert_int_equal(csg_source_add(&sources, "t.txt", text, length, &source), CSGM_OK);
    assert_true(csg_lex(&sources, source, &tokens));
    assert_int_equal(tokens.items[tokens.count - 1].kind, CSG_TOKEN_END);
}

static void lex(const char *text)
{
    lex_bytes(text, strlen(text));
}

static void check_kinds(const char *text, const csg_token_kind *kinds, size_t count)
{
    lex(text);
    assert_int_equal(tokens.count, count + 1);
    for (size_t i = 0; i < count; i++)
        assert_int_equal(tokens.items[i].kind, kinds[i]);
}

#define KINDS(text, ...)                                                                           \
    check_kinds(text, (const csg_token_kind[]){__VA_ARGS__},                                       \
                sizeof((const csg_token_kind[]){__VA_ARGS__}) / sizeof(csg_token_kind))

static void tokens_are_told_apart(void **state)
{
    (void)state;
    KINDS("a<=b", CSG_TOKEN_NAME, CSG_TOKEN_LESS_EQUAL, CSG_TOKEN_NAME);
    KINDS("a< =b", CSG_TOKEN_NAME, CSG_TOKEN_LESS, CSG_TOKEN_ASSIGN, CSG_TOKEN_NAME);
    KINDS("forx for", CSG_TOKEN_NAME, CSG_TOKEN_FOR);
    KINDS("$fn=1.5e3;", CSG_TOKEN_NAME, CSG_TOKEN_ASSIGN, CSG_TOKEN_NUMBER, CSG_TOKEN_SEMICOLON);
    KINDS("v.x .5 5.", CSG_TOKEN_NAME, CSG_TOKEN_DOT, CSG_TOKEN_NAME, CSG_TOKEN_NUMBER,
          CSG_TOKEN_NUMBER);
    KINDS("a/b//c\n/*d*/e", CSG_TOKEN_NAME, CSG_TOKEN_SLASH, CSG_TOKEN_NAME, CSG_TOKEN_NAME);
    KINDS("include <a/b.txt> use<c>", CSG_TOKEN_INCLUDE, CSG_TOKEN_PATH, CSG_TOKEN_USE,
          CSG_TOKEN_PATH);
    KINDS("include = 3 < 4", CSG_TOKEN_INCLUDE, CSG_TOKEN_ASSIGN, CSG_TOKEN_NUMBER, CSG_TOKEN_LESS,
          CSG_TOKEN_NUMBER);
    KINDS("\"a\\\"b\" undef", CSG_TOKEN_STRING, CSG_TOKEN_UNDEF);
    KINDS("!=&&||!^%#*", CSG_TOKEN_NOT_EQUAL, CSG_TOKEN_AND, CSG_TOKEN_OR, CSG_TOKEN_NOT,
          CSG_TOKEN_CARET, CSG_TOKEN_PERCENT, CSG_TOKEN_HASH, CSG_TOKEN_STAR);
    lex("");
    assert_int_equal(tokens.count, 1);
}

static double number(const char *text)
{
    return csg_token_number(text, (uint32_t)strlen(text));
}

static void numbers_have_their_values(void **state)
{
    char longest[500];
    (void)state;
    assert_true(number("0.1") == 0.1);
    assert_true(number("1e-3") == 1e-3);
    assert_true(number("0x1F") == 31);
    assert_true(number("12345678901234567890") == 12345678901234567890.0);
    memset(longest, '0', sizeof longest);
    memcpy(longest, "0.", 2);
    memcpy(longest + 490, "25e490", 7);
    assert_true(number(longest) > 24.999999 && number(longest) < 25.000001);
    memset(longest + 102, '3', 300); /* 0.00..0033..33: more digits than a double's exponent */
    strcpy(longest + 402, "");
    assert_true(number(longest) > 3.3e-101 && number(longest) < 3.4e-101);
    memset(longest, '1', 100);
    strcpy(longest + 100, "e99999999999999999999");
    assert_true(number(longest) == INFINITY);
    strcpy(longest + 100, "e-99999999999999999999");
    assert_true(number(longest) == 0);
}

static void strings_resolve_their_escapes(void **state)
{
    static const struct {
        const char *written, *meant;
    } table[] = {{"\"\"", ""},
                 {"\"a\\nb\\t\\\\\\\"\"", "a\nb\t\\\""},
                 {"\"\\x41\\u00e9\\U01F600\"", "A\xC3\xA9\xF0\x9F\x98\x80"},
                 {"\"\\u{e9}\\u{1F600}\"", "\xC3\xA9\xF0\x9F\x98\x80"},
                 {"\"\\x00\"", " "}};
    (void)state;
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        size_t length;
        lex(table[i].written);
        assert_int_equal(found_count, 0);
        const char *text =
            csg_token_string(&arena, table[i].written, (uint32_t)strlen(table[i].written), &length);
        assert_string_equal(text, table[i].meant);
        assert_int_equal(length, strlen(table[i].meant));
    }
}

/* What is told about and left out: the backslash of an unknown escape, the break of a line. */
static void strings_lose_what_has_no_meaning(void **state)
{
    static const struct {
        const char *written, *meant;
    } table[] = {{"\"a\\qb\"", "aqb"}, {"\"\\x80\"", "x80"}, {"\"a\nb\"", "ab"}};
    (void)state;
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        size_t length;
        lex(table[i].written);
        assert_int_equal(found_count, 1);
        assert_string_equal(
            csg_token_string(&arena, table[i].written, (uint32_t)strlen(table[i].written), &length),
            table[i].meant);
    }
}

static void names_may_begin_with_digits(void **state)
{
    static const char *const names[] = {"2d", "3rd_part", "1e", "2e3x", "0xyz", "10mm"};
    static const char *const numbers[] = {"2", "1e5", "0x1F", "5.", "1.5e+3"};
    (void)state;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        lex(names[i]);
        assert_int_equal(found_count, 0);
        assert_int_equal(tokens.count, 2);
        assert_int_equal(tokens.items[0].kind, CSG_TOKEN_NAME);
    }
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        lex(numbers[i]);
        assert_int_equal(tokens.count, 2);
        assert_int_equal(tokens.items[0].kind, CSG_TOKEN_NUMBER);
    }
}

static void check_found(const char *text, int code, uint32_t line, uint32_t column)
{
    lex(text);
    assert_int_equal(found_count, 1);
    assert_int_equal(found[0].code, code);
    assert_int_equal(found[0].line, line);
    assert_int_equal(found[0].column, column);
}

static void mistakes_have_places(void **state)
{
    (void)state;
    check_found("a = 1;\n  b @ 2;", 101, 2, 5);
    check_found("x\n\"abc\ny", 104, 2, 1);
    check_found("x /* y\nz", 105, 1, 3);
    check_found("\"a\\q\"", 106, 1, 3);
    check_found("\"\\u12\"", 106, 1, 2);
    check_found("\"\\u{110000}\"", 106, 1, 2);
    check_found("x = 1.2abc;", 111, 1, 5);
    assert_int_equal(found[0].length, 6);
    assert_string_equal(found[0].source_line, "x = 1.2abc;");
    check_found("x = 1e400;", 111, 1, 5);
    check_found("x = \"a\nb\"; y = \"c\";", 117, 1, 5);
    check_found("x = \"a;\ny = \"c\";", 104, 1, 5);
    check_found("a\r\n\xC3", 103, 2, 1);
    assert_string_equal(found[0].source_line, "\xC3");
    check_found("// \xE9\n", 114, 1, 4);
    lex_bytes("a\0b", 3);
    assert_int_equal(found[0].code, 102);
    assert_int_equal(tokens.count, 4); /* a, a broken token, b, the end */
}

static void utf8_is_checked(void **state)
{
    uint32_t c;
    char out[4];
    (void)state;
    assert_int_equal(csg_utf8_decode("\xE2\x82\xAC", 3, &c), 3);
    assert_int_equal(c, 0x20AC);
    assert_int_equal(csg_utf8_decode("\xE2\x82\xAC", 2, &c), 0);
    assert_int_equal(csg_utf8_decode("\xC0\x80", 2, &c), 0);         /* overlong */
    assert_int_equal(csg_utf8_decode("\xED\xA0\x80", 3, &c), 0);     /* surrogate */
    assert_int_equal(csg_utf8_decode("\xF4\x90\x80\x80", 4, &c), 0); /* beyond U+10FFFF */
    assert_int_equal(csg_utf8_decode("\x80", 1, &c), 0);
    assert_int_equal(csg_utf8_encode(0xD800, out), 0);
    for (uint32_t i = 1; i < 0x110000; i += i < 0x900 ? 1 : 97) {
        size_t length = csg_utf8_encode(i, out);
        if (length == 0)
            continue;
        assert_int_equal(csg_utf8_decode(out, length, &c), length);
        assert_int_equal(c, i);
    }
    assert_int_equal(csg_utf8_count("a\xC3\xA9\xFFz", 5), 4);
}

static int setup(void **state)
{
    (void)state;
    csg_memory_init(&context.memory, NULL, 0);
    csg_arena_init(&arena, &context.memory);
    csg_sources_init(&sources, &context, &arena);
    return 0;
}

static int teardown(void **state)
{
    (void)state;
    csg_tokens_release(&context.memory, &tokens);
    csg_sources_reset(&sources);
    csg_arena_reset(&arena);
    return atomic_load(&context.memory.used_bytes) != 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tokens_are_told_apart),
        cmocka_unit_test(numbers_have_their_values),
        cmocka_unit_test(strings_resolve_their_escapes),
        cmocka_unit_test(strings_lose_what_has_no_meaning),
        cmocka_unit_test(names_may_begin_with_digits),
        cmocka_unit_test(mistakes_have_places),
        cmocka_unit_test(utf8_is_checked),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
