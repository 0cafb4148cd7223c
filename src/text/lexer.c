/* SPDX-License-Identifier: MIT
 * The lexer; see lexer.h. One pass, one character of look-ahead except for punctuation of two.
 * Broken UTF-8 is reported once per file: an error in code, a warning in strings and in comments,
 * where old files have Latin-1.
 */
#include "text/lexer.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/elementary.h"
#include "base/scene_codes.h"
#include "base/utf8.h"

typedef enum place { IN_CODE, IN_STRING, IN_COMMENT } place;

typedef struct lexer {
    const csg_sources *sources;
    csg_memory *memory;
    csg_token_array *out;
    const char *text;
    uint32_t source, length, at;
    bool told_code, told_string, told_comment, told_nul;
    uint32_t counted, quotes; /* how many quotes stand at `counted` and behind; 0, 0: not known */
} lexer;

static const struct {
    const char *text;
    uint8_t length, kind;
} punctuation[] = {
#define CSG_PUNCTUATION(NAME, text) {text, sizeof(text) - 1, CSG_TOKEN_##NAME},
#include "text/tokens.def"
};

static const struct {
    const char *text;
    uint8_t length, kind;
} keywords[] = {
#define CSG_KEYWORD(NAME, text) {text, sizeof(text) - 1, CSG_TOKEN_##NAME},
#include "text/tokens.def"
};

const char *csg_token_kind_name(csg_token_kind kind)
{
    static const char *const names[] = {
#define CSG_TOKEN(NAME, text) text,
#define CSG_KEYWORD(NAME, text) "'" text "'",
#define CSG_PUNCTUATION(NAME, text) "'" text "'",
#include "text/tokens.def"
    };
    return names[kind];
}

/* ---- characters ------------------------------------------------------------------------- */

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}
static bool is_name_start(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '$';
}
static bool is_name(char c)
{
    return (is_name_start(c) && c != '$') || is_digit(c);
}
static int hex_value(char c)
{
    return is_digit(c)            ? c - '0'
           : c >= 'a' && c <= 'f' ? c - 'a' + 10
           : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                  : -1;
}

static char peek(const lexer *l, uint32_t ahead)
{
    return ahead < l->length - l->at ? l->text[l->at + ahead] : '\0';
}

static csg_span span(const lexer *l, uint32_t from, uint32_t to)
{
    return (csg_span){l->source, from, to - from};
}

static void bad_utf8(lexer *l, place in)
{
    bool *told = in == IN_CODE     ? &l->told_code
                 : in == IN_STRING ? &l->told_string
                                   : &l->told_comment;
    if (!*told)
        csg_source_report(l->sources, in == IN_CODE ? CSG_DIAG_BAD_UTF8 : CSG_DIAG_COMMENT_UTF8,
                          span(l, l->at, l->at + 1), "save the file as UTF-8",
                          "byte 0x%02X is not part of a UTF-8 character%s",
                          (unsigned)(unsigned char)l->text[l->at],
                          in == IN_STRING ? ", it is read as Latin-1" : "");
    *told = true;
}

static void nul_byte(lexer *l)
{
    if (!l->told_nul)
        csg_source_report(l->sources, CSG_DIAG_NUL_BYTE, span(l, l->at, l->at + 1), NULL,
                          "the text holds a NUL byte");
    l->told_nul = true;
}

/* Over one character, whatever it is. */
static void skip_character(lexer *l, place in)
{
    size_t length = csg_utf8_length(l->text + l->at, l->length - l->at);
    if (l->text[l->at] == '\0')
        nul_byte(l);
    if (length == 0)
        bad_utf8(l, in);
    l->at += length ? (uint32_t)length : 1;
}

static bool push_token(lexer *l, csg_token_kind kind, uint32_t from)
{
    csg_token_array *out = l->out;
    if (!csg_memory_reserve(l->memory, (void **)&out->items, &out->capacity, out->count + 1,
                            sizeof *out->items))
        return false;
    out->items[out->count++] = (csg_token){(uint8_t)kind, from, l->at - from};
    return true;
}

/* ---- what is skipped --------------------------------------------------------------------- */

static void skip_block_comment(lexer *l)
{
    uint32_t from = l->at;
    for (l->at += 2; l->at < l->length; skip_character(l, IN_COMMENT))
        if (peek(l, 0) == '*' && peek(l, 1) == '/') {
            l->at += 2;
            return;
        }
    csg_source_report(l->sources, CSG_DIAG_UNTERMINATED_COMMENT, span(l, from, from + 2),
                      "close it with '*/'", "this comment never ends");
}

/* Bytes of white space. Text from web pages has no-break spaces, in UTF-8 or in Latin-1. */
static uint32_t space_length(const lexer *l)
{
    char c = peek(l, 0);
    if (c == '\xC2' && peek(l, 1) == '\xA0')
        return 2;
    return c == ' ' || (c >= '\t' && c <= '\r') || c == '\xA0' ? 1 : 0;
}

static void skip_space(lexer *l)
{
    for (;;) {
        char c = peek(l, 0);
        uint32_t space = space_length(l);
        if (space) {
            l->at += space;
        } else if (c == '/' && peek(l, 1) == '/') {
            while (l->at < l->length && l->text[l->at] != '\n')
                skip_character(l, IN_COMMENT);
        } else if (c == '/' && peek(l, 1) == '*') {
            skip_block_comment(l);
        } else {
            return;
        }
    }
}

/* ---- strings ----------------------------------------------------------------------------- */

/* Reads the escape after a backslash at text[0]: its bytes after the backslash, 0 when unknown. */
static uint32_t read_escape(const char *text, uint32_t room, uint32_t *character)
{
    static const char plain[][2] = {
        {'n', '\n'}, {'t', '\t'}, {'r', '\r'}, {'"', '"'}, {'\\', '\\'}};
    char kind = room ? text[0] : '\0';
    for (size_t i = 0; i < sizeof plain / sizeof *plain; i++)
        if (kind == plain[i][0]) {
            *character = (unsigned char)plain[i][1];
            return 1;
        }
    bool braces = kind == 'u' && room > 1 && text[1] == '{';
    uint32_t most = braces ? 6 : kind == 'x' ? 2 : kind == 'u' ? 4 : kind == 'U' ? 6 : 0;
    uint32_t begin = braces ? 2 : 1, digits = 0, value = 0;
    while (digits < most && begin + digits < room && hex_value(text[begin + digits]) >= 0)
        value = value << 4 | (uint32_t)hex_value(text[begin + digits++]);
    char utf8[4];
    bool complete = braces ? digits > 0 && begin + digits < room && text[begin + digits] == '}'
                           : most > 0 && digits == most;
    if (kind == 'x' && value == 0) /* OpenSCAD's way to keep NUL out of strings */
        value = ' ';
    if (!complete || (kind == 'x' && value > 0x7F) || csg_utf8_encode(value, utf8) == 0)
        return 0;
    *character = value;
    return begin + digits + (braces ? 1 : 0);
}

static void lex_escape(lexer *l)
{
    uint32_t character,
        length = read_escape(l->text + l->at + 1, l->length - l->at - 1, &character);
    if (length) {
        l->at += 1 + length;
        return;
    }
    uint32_t next = l->at + 1;
    bool shown = next < l->length && l->text[next] > ' ' && l->text[next] < 0x7F;
    csg_source_report(
        l->sources, CSG_DIAG_BAD_ESCAPE, span(l, l->at, next + (shown ? 1 : 0)),
        "known are \\n \\t \\r \\\" \\\\ \\xHH \\uHHHH \\u{H...}; a backslash itself is \\\\",
        "unknown escape in a string, the backslash is left out");
    l->at++;
}

/* How many quotes that no backslash hides stand here and behind. Each byte is looked at once. */
static uint32_t count_quotes(lexer *l)
{
    uint32_t passed = 0;
    uint32_t end = l->counted ? l->at : l->length;
    for (uint32_t i = l->counted ? l->counted : l->at; i < end; i++) {
        if (l->text[i] == '\\')
            i++;
        else if (l->text[i] == '"')
            passed++;
    }
    l->quotes = l->counted ? l->quotes - passed : passed;
    l->counted = l->at;
    return l->quotes;
}

/* At a line's end inside a string. OpenSCAD lets strings go on, without the line break. But when
 * the quotes behind pair up, it is the closing one that was forgotten. */
static bool goes_on(lexer *l, uint32_t from)
{
    if (count_quotes(l) % 2 == 0)
        return false;
    csg_source_report(l->sources, CSG_DIAG_STRING_OVER_LINES, span(l, from, from + 1),
                      "write \\n for a line break, str(\"one\", \"two\") for a long text",
                      "this string goes on over the end of the line; the break is left out");
    return true;
}

static bool lex_string(lexer *l)
{
    uint32_t from = l->at++;
    bool over_lines = false;
    while (l->at < l->length && l->text[l->at] != '"') {
        if (l->text[l->at] == '\n' && !over_lines) {
            over_lines = goes_on(l, from);
            if (!over_lines)
                break;
        }
        if (l->text[l->at] == '\\')
            lex_escape(l);
        else
            skip_character(l, IN_STRING);
    }
    if (peek(l, 0) == '"') {
        l->at++;
        return push_token(l, CSG_TOKEN_STRING, from);
    }
    csg_source_report(l->sources, CSG_DIAG_UNTERMINATED_STRING, span(l, from, from + 1),
                      "close it with '\"' on the same line", "this string never ends");
    return push_token(l, CSG_TOKEN_BAD, from);
}

char *csg_token_string(csg_arena *arena, const char *text, uint32_t length, size_t *out_length)
{
    char *out = csg_arena_alloc(arena, 2 * (size_t)length + 4); /* Latin-1 grows to two bytes */
    size_t written = 0;
    if (!out)
        return NULL;
    uint32_t end = length > 1 && text[length - 1] == '"' ? length - 1 : length;
    for (uint32_t i = 1; i < end;) {
        uint32_t character, escape = 0;
        if (text[i] == '\\')
            escape = read_escape(text + i + 1, end - i - 1, &character);
        if (escape) {
            written += csg_utf8_encode(character, out + written);
            i += 1 + escape;
        } else if (text[i] == '\\' || text[i] == '\n') { /* told about */
            i++;
        } else {
            size_t step = csg_utf8_length(text + i, end - i);
            if (step == 0)
                written += csg_utf8_encode((unsigned char)text[i++], out + written);
            for (size_t k = 0; k < step; k++)
                out[written++] = text[i++];
        }
    }
    out[written] = '\0';
    *out_length = written;
    return out;
}

/* ---- numbers ----------------------------------------------------------------------------- */

static void skip_digits(lexer *l)
{
    while (is_digit(peek(l, 0)))
        l->at++;
}

static void skip_exponent(lexer *l)
{
    uint32_t sign = peek(l, 1) == '+' || peek(l, 1) == '-' ? 1 : 0;
    if ((peek(l, 0) == 'e' || peek(l, 0) == 'E') && is_digit(peek(l, 1 + sign))) {
        l->at += 1 + sign;
        skip_digits(l);
    }
}

static bool lex_name(lexer *l);

/* As in OpenSCAD, the longer one holds: 2d and 3rd_part are names, 2e3 is a number. */
static bool is_name_longer(const lexer *l, uint32_t from)
{
    uint32_t end = from;
    while (end < l->length && is_name(l->text[end]))
        end++;
    return end > l->at;
}

static void check_finite(const lexer *l, uint32_t from)
{
    if (isinf(csg_token_number(l->text + from, l->at - from)))
        csg_source_report(l->sources, CSG_DIAG_BAD_NUMBER, span(l, from, l->at),
                          "infinity is 1 / 0", "this number is too large");
}

static bool lex_number(lexer *l)
{
    uint32_t from = l->at;
    if (peek(l, 0) == '0' && (peek(l, 1) == 'x' || peek(l, 1) == 'X') &&
        hex_value(peek(l, 2)) >= 0) {
        for (l->at += 2; hex_value(peek(l, 0)) >= 0;)
            l->at++;
    } else {
        skip_digits(l);
        if (peek(l, 0) == '.') {
            l->at++;
            skip_digits(l);
        }
        skip_exponent(l);
    }
    if (is_name_longer(l, from)) {
        l->at = from;
        return lex_name(l);
    }
    bool broken = is_name(peek(l, 0)) || (peek(l, 0) == '.' && is_digit(peek(l, 1)));
    if (broken) {
        while (is_name(peek(l, 0)) || peek(l, 0) == '.')
            l->at++;
        csg_source_report(l->sources, CSG_DIAG_BAD_NUMBER, span(l, from, l->at),
                          "a name begins with a letter, a multiplication needs '*', "
                          "a decimal point is '.'",
                          "'%.*s' is not a number", (int)(l->at - from < 60 ? l->at - from : 60),
                          l->text + from);
    } else {
        check_finite(l, from);
    }
    return push_token(l, CSG_TOKEN_NUMBER, from);
}

/* "e-12" at `text`: its value, at most MOST either way, which is beyond all doubles. */
static int read_exponent(const char *text, uint32_t length)
{
    enum { MOST = 100000000 };
    uint32_t i = 1;
    bool negative = i < length && text[i] == '-';
    int value = 0;
    if (i < length && (text[i] == '-' || text[i] == '+'))
        i++;
    for (; i < length && is_digit(text[i]) && value < MOST; i++)
        value = value * 10 + (text[i] - '0');
    value = value < MOST ? value : MOST;
    return negative ? -value : value;
}

/* A number with more digits than anyone means: correct to a few units in the last place. */
static double long_number(const char *text, uint32_t length)
{
    double value = 0;
    int scale = 0;
    uint32_t i = 0;
    for (bool point = false; i < length && (is_digit(text[i]) || text[i] == '.'); i++) {
        if (text[i] == '.') {
            point = true;
        } else if (value < 1e300) {
            value = value * 10 + (text[i] - '0');
            scale -= point ? 1 : 0;
        } else {
            scale += point ? 0 : 1;
        }
    }
    if (i < length && (text[i] == 'e' || text[i] == 'E'))
        scale += read_exponent(text + i, length - i);
    int half = scale / 2; /* in two steps: one alone may leave the range of doubles */
    return value * csg_pow(10, half) * csg_pow(10, scale - half);
}

double csg_token_number(const char *text, uint32_t length)
{
    char buffer[64];
    if (length > 2 && text[0] == '0' && (text[1] == 'x' || text[1] == 'X')) {
        double value = 0;
        for (uint32_t i = 2; i < length && hex_value(text[i]) >= 0; i++)
            value = value * 16 + hex_value(text[i]);
        return value;
    }
    if (length >= sizeof buffer)
        return long_number(text, length);
    memcpy(buffer, text, length);
    buffer[length] = '\0';
    return strtod(buffer, NULL);
}

/* ---- the rest ----------------------------------------------------------------------------- */

/* After include and use: "<path>" on the same line is one token. */
static bool lex_path(lexer *l)
{
    uint32_t from = l->at;
    while (peek(l, 0) == ' ' || peek(l, 0) == '\t')
        l->at++;
    uint32_t open = l->at;
    if (peek(l, 0) == '<')
        while (l->at < l->length && l->text[l->at] != '>' && l->text[l->at] != '\n')
            skip_character(l, IN_CODE);
    if (peek(l, 0) != '>') {
        l->at = from;
        return true;
    }
    l->at++;
    return push_token(l, CSG_TOKEN_PATH, open);
}

static bool lex_name(lexer *l)
{
    uint32_t from = l->at++;
    while (is_name(peek(l, 0)))
        l->at++;
    csg_token_kind kind = CSG_TOKEN_NAME;
    for (size_t i = 0; i < sizeof keywords / sizeof *keywords; i++)
        if (keywords[i].length == l->at - from &&
            memcmp(keywords[i].text, l->text + from, l->at - from) == 0)
            kind = keywords[i].kind;
    if (!push_token(l, kind, from))
        return false;
    return kind == CSG_TOKEN_INCLUDE || kind == CSG_TOKEN_USE ? lex_path(l) : true;
}

static const char *hint_for_character(uint32_t character)
{
    static const struct {
        uint32_t first, last;
        const char *hint;
    } table[] = {
        {'\'', '\'', "strings stand in straight double quotes: \"text\""},
        {'`', '`', "strings stand in straight double quotes: \"text\""},
        {0x2018, 0x201F, "strings stand in straight double quotes: \"text\""},
        {0xAB, 0xAB, "strings stand in straight double quotes: \"text\""},
        {0xBB, 0xBB, "strings stand in straight double quotes: \"text\""},
        {0x2010, 0x2015, "the minus sign is '-'"},
        {0x2212, 0x2212, "the minus sign is '-'"},
        {0xD7, 0xD7, "multiplication is '*'"},
        {0xB7, 0xB7, "multiplication is '*'"},
        {0xF7, 0xF7, "division is '/'"},
        {0xB2, 0xB3, "a power is x ^ 2"},
        {0xB0, 0xB0, "angles are in degrees, without a sign"},
        {0x2264, 0x2264, "less or equal is '<='"},
        {0x2265, 0x2265, "greater or equal is '>='"},
        {0x2260, 0x2260, "not equal is '!='"},
        {0x2000, 0x200F, "it is an invisible character, from a word processor or web page"},
        {0xFEFF, 0xFEFF, "it is an invisible character, from a word processor or web page"},
        {0xFF01, 0xFF5E, "it is a wide character: type the plain one"},
        {'\\', '\\', "division is '/'"},
        {0xC0, 0x24F, "names are made of a-z, A-Z, 0-9 and _"},
        {0x370, 0x1FFF, "names are made of a-z, A-Z, 0-9 and _"},
        {0x3040, 0xD7FF, "names are made of a-z, A-Z, 0-9 and _"},
    };
    for (size_t i = 0; i < sizeof table / sizeof *table; i++)
        if (character >= table[i].first && character <= table[i].last)
            return table[i].hint;
    return NULL;
}

static bool lex_strange(lexer *l)
{
    uint32_t from = l->at, character = 0;
    uint32_t length = (uint32_t)csg_utf8_decode(l->text + l->at, l->length - l->at, &character);
    if (length && character >= 0x20 && character != 0x7F)
        csg_source_report(l->sources, CSG_DIAG_BAD_CHARACTER, span(l, from, from + length),
                          hint_for_character(character), "'%.*s' does not belong here", (int)length,
                          l->text + from);
    else if (length && character)
        csg_source_report(l->sources, CSG_DIAG_BAD_CHARACTER, span(l, from, from + 1), NULL,
                          "control character 0x%02X", (unsigned)character);
    if (length == 0 || character == 0)
        skip_character(l, IN_CODE);
    else
        l->at += length;
    return push_token(l, CSG_TOKEN_BAD, from);
}

static bool lex_punctuation(lexer *l)
{
    for (size_t i = 0; i < sizeof punctuation / sizeof *punctuation; i++)
        if (punctuation[i].length <= l->length - l->at &&
            memcmp(punctuation[i].text, l->text + l->at, punctuation[i].length) == 0) {
            uint32_t from = l->at;
            l->at += punctuation[i].length;
            return push_token(l, punctuation[i].kind, from);
        }
    return lex_strange(l);
}

bool csg_lex(const csg_sources *sources, uint32_t source, csg_token_array *out)
{
    const csg_source *text = &sources->items[source];
    lexer l = {.sources = sources,
               .memory = &sources->context->memory,
               .out = out,
               .text = text->text,
               .source = source,
               .length = text->length};
    if (l.length >= 3 && memcmp(l.text, "\xEF\xBB\xBF", 3) == 0)
        l.at = 3;
    bool ok = true;
    for (skip_space(&l); ok && l.at < l.length; skip_space(&l)) {
        char c = peek(&l, 0);
        if (is_name_start(c))
            ok = lex_name(&l);
        else if (is_digit(c) || (c == '.' && is_digit(peek(&l, 1))))
            ok = lex_number(&l);
        else if (c == '"')
            ok = lex_string(&l);
        else
            ok = lex_punctuation(&l);
    }
    return ok && push_token(&l, CSG_TOKEN_END, l.length);
}

void csg_tokens_release(csg_memory *memory, csg_token_array *tokens)
{
    csg_memory_release(memory, tokens->items, tokens->capacity * sizeof *tokens->items);
    *tokens = (csg_token_array){0};
}
