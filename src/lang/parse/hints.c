/* SPDX-License-Identifier: MIT
 * Advice by the tokens around a mistake: most mistakes of syntax are right in some other language.
 * Looks at a few tokens only, so that a text full of mistakes costs no more than its length.
 */
#include "lang/parse/hints.h"

#include <string.h>

static const struct {
    const char *word, *hint;
    size_t length;
    csg_habit_kind kind;
} habits[] = {
#define CSG_HABIT(kind, word, hint) {word, hint, sizeof(word) - 1, CSG_HABIT_##kind},
#include "lang/parse/habits.def"
#undef CSG_HABIT
};

const char *csg_habit_hint(csg_habit_kind kind, const char *word, size_t length)
{
    for (size_t i = 0; i < sizeof habits / sizeof *habits; i++)
        if (habits[i].kind == kind && habits[i].length == length &&
            memcmp(habits[i].word, word, length) == 0)
            return habits[i].hint;
    return NULL;
}

/* The token `offset` places from the current one; END beyond both ends. */
static csg_token token(const csg_parser *parser, int offset)
{
    size_t at = parser->at + (size_t)offset;
    if (offset < 0 && (size_t)-offset > parser->at)
        return (csg_token){.kind = CSG_TOKEN_END};
    return at < parser->tokens.count ? parser->tokens.items[at]
                                     : (csg_token){.kind = CSG_TOKEN_END};
}

static csg_token_kind kind_at(const csg_parser *parser, int offset)
{
    return token(parser, offset).kind;
}

static bool is_word(const csg_parser *parser, int offset, const char *word)
{
    csg_token t = token(parser, offset);
    return t.kind == CSG_TOKEN_NAME && t.length == strlen(word) &&
           memcmp(parser->text + t.offset, word, t.length) == 0;
}

static bool ends_value(csg_token_kind kind)
{
    return kind == CSG_TOKEN_NAME || kind == CSG_TOKEN_NUMBER || kind == CSG_TOKEN_STRING ||
           kind == CSG_TOKEN_CLOSE_ROUND || kind == CSG_TOKEN_CLOSE_SQUARE ||
           kind == CSG_TOKEN_TRUE || kind == CSG_TOKEN_FALSE || kind == CSG_TOKEN_UNDEF;
}

static bool begins_value(csg_token_kind kind)
{
    return kind == CSG_TOKEN_NAME || kind == CSG_TOKEN_NUMBER || kind == CSG_TOKEN_STRING ||
           kind == CSG_TOKEN_OPEN_SQUARE || kind == CSG_TOKEN_TRUE || kind == CSG_TOKEN_FALSE ||
           kind == CSG_TOKEN_UNDEF;
}

/* Where the bracket around the current token was opened, as an offset; 0 = not found near by. */
static int opening(const csg_parser *parser)
{
    enum { FAR = -200 };
    int depth = 0;
    for (int i = -1; i > FAR && kind_at(parser, i) != CSG_TOKEN_END; i--) {
        csg_token_kind kind = kind_at(parser, i);
        if (kind == CSG_TOKEN_CLOSE_ROUND || kind == CSG_TOKEN_CLOSE_SQUARE)
            depth++;
        if ((kind == CSG_TOKEN_OPEN_ROUND || kind == CSG_TOKEN_OPEN_SQUARE) && depth-- == 0)
            return i;
    }
    return 0;
}

/* `i++`, `i += 1`, `a <> b`: two signs that are one elsewhere. */
static const char *hint_for_pair(csg_token_kind left, csg_token_kind right)
{
    static const struct {
        uint8_t left, right;
        const char *hint;
    } pairs[] = {
        {CSG_TOKEN_PLUS, CSG_TOKEN_PLUS, "variables never change: write i + 1 where it is wanted"},
        {CSG_TOKEN_MINUS, CSG_TOKEN_MINUS,
         "variables never change: write i - 1 where it is wanted"},
        {CSG_TOKEN_PLUS, CSG_TOKEN_ASSIGN,
         "variables never change: give the new value a name of its own, b = a + 1;"},
        {CSG_TOKEN_MINUS, CSG_TOKEN_ASSIGN,
         "variables never change: give the new value a name of its own, b = a - 1;"},
        {CSG_TOKEN_STAR, CSG_TOKEN_ASSIGN,
         "variables never change: give the new value a name of its own, b = a * 2;"},
        {CSG_TOKEN_SLASH, CSG_TOKEN_ASSIGN,
         "variables never change: give the new value a name of its own, b = a / 2;"},
        {CSG_TOKEN_COLON, CSG_TOKEN_ASSIGN, "an assignment is name = value;"},
        {CSG_TOKEN_ASSIGN, CSG_TOKEN_LESS, "less or equal is '<='"},
        {CSG_TOKEN_ASSIGN, CSG_TOKEN_GREATER,
         "greater or equal is '>='; a function is function (x) 2 * x"},
        {CSG_TOKEN_LESS, CSG_TOKEN_GREATER, "not equal is '!='"},
        {CSG_TOKEN_STAR, CSG_TOKEN_STAR, "a power is 2 ^ 3, or pow(2, 3)"},
        {CSG_TOKEN_EQUAL, CSG_TOKEN_ASSIGN, "'==' compares"},
        {CSG_TOKEN_NOT_EQUAL, CSG_TOKEN_ASSIGN, "not equal is '!='"},
        {CSG_TOKEN_DOT, CSG_TOKEN_DOT, "a range is [0 : 5]"},
    };
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++)
        if (pairs[i].left == left && pairs[i].right == right)
            return pairs[i].hint;
    return NULL;
}

/* A keyword, and then something else than its '('. */
static const char *hint_for_keyword(csg_token_kind keyword, csg_token_kind found)
{
    if (found == CSG_TOKEN_ASSIGN &&
        (keyword == CSG_TOKEN_FOR || keyword == CSG_TOKEN_IF || keyword == CSG_TOKEN_LET ||
         keyword == CSG_TOKEN_ECHO || keyword == CSG_TOKEN_ASSERT || keyword == CSG_TOKEN_EACH))
        return "this is a word of the language: choose another name";
    switch (keyword) {
    case CSG_TOKEN_FOR:
        return "a loop is for (i = [0 : 5]) ...";
    case CSG_TOKEN_IF:
        return "the condition stands in round brackets: if (a > b) ...";
    case CSG_TOKEN_LET:
        return "an assignment needs no 'let': name = value;";
    case CSG_TOKEN_ECHO:
    case CSG_TOKEN_ASSERT:
        return "what it is about stands in round brackets: echo(\"text\");";
    default:
        return NULL;
    }
}

/* A name, and then something else than '(' or '='. */
static const char *hint_for_name(const csg_parser *parser)
{
    csg_token name = token(parser, -1);
    csg_token_kind found = kind_at(parser, 0);
    const char *habit = csg_habit_hint(CSG_HABIT_WORD, parser->text + name.offset, name.length);
    if (habit)
        return habit;
    if (kind_at(parser, -2) == CSG_TOKEN_HASH && found == CSG_TOKEN_NAME)
        return "a comment begins with //, not with #";
    if (found == CSG_TOKEN_EQUAL)
        return "'=' assigns, '==' compares";
    if (found == CSG_TOKEN_OPEN_SQUARE)
        return is_word(parser, -1, "children") ? "the first child is children(0)"
                                               : "arguments stand in round brackets: name(...)";
    if (found == CSG_TOKEN_OPEN_CURLY)
        return "round brackets are needed, also with nothing in them: name() { ... }";
    if (found == CSG_TOKEN_SEMICOLON)
        return "a call has round brackets, also with nothing in them: name();";
    if (found == CSG_TOKEN_MINUS && kind_at(parser, 1) == CSG_TOKEN_NAME)
        return "names have no '-' in them: write name_of_two_words";
    return NULL;
}

/* What closes a bracket is not there. */
static const char *hint_inside(const csg_parser *parser, csg_token_kind expected)
{
    csg_token_kind found = kind_at(parser, 0);
    int open = opening(parser);
    bool loop = open != 0 && kind_at(parser, open - 1) == CSG_TOKEN_FOR;
    bool named = open != 0 && (kind_at(parser, -2) == CSG_TOKEN_COMMA || open == -2);
    if (found == CSG_TOKEN_SEMICOLON && loop)
        return "a loop is for (i = [0 : 5]) ...; only lists have [for (i = 0; i < 5; i = i + 1) i]";
    if (found == CSG_TOKEN_SEMICOLON && expected == CSG_TOKEN_CLOSE_SQUARE)
        return "elements are separated by ','";
    if (found == CSG_TOKEN_COLON)
        return named ? "an argument with its name is name = value"
                     : "a range stands in square brackets: [0 : 5]";
    if (found == CSG_TOKEN_ASSIGN)
        return "'=' assigns, '==' compares";
    if (begins_value(found) && ends_value(kind_at(parser, -1)))
        return "is a ',' or an operator missing before it?";
    return NULL;
}

/* Nothing of the language begins so. */
static const char *hint_for_statement(csg_token_kind before, csg_token_kind found)
{
    bool behind_solid = before == CSG_TOKEN_CLOSE_ROUND || before == CSG_TOKEN_CLOSE_CURLY ||
                        before == CSG_TOKEN_SEMICOLON;
    if ((found == CSG_TOKEN_PLUS || found == CSG_TOKEN_MINUS) && behind_solid)
        return "solids are joined by union() { ... } and cut by difference() { ... }";
    if (found == CSG_TOKEN_CLOSE_ROUND || found == CSG_TOKEN_CLOSE_SQUARE)
        return "is there one bracket too many?";
    if (found == CSG_TOKEN_INCLUDE || found == CSG_TOKEN_USE || found == CSG_TOKEN_MODULE)
        return before == CSG_TOKEN_HASH ? "write it without '#': include <file.txt>"
                                        : "this is a word of the language: choose another name";
    return NULL;
}

static const char *hint_for_expected(csg_token_kind expected, csg_token_kind before)
{
    switch (expected) {
    case CSG_TOKEN_COLON:
        return "a choice has two sides: condition ? this : that";
    case CSG_TOKEN_ASSIGN:
        return "a function is one expression: function double(x) = 2 * x;";
    case CSG_TOKEN_OPEN_ROUND:
        return before == CSG_TOKEN_NAME ? "also without parameters it is: module name() { ... }"
                                        : NULL;
    default:
        return NULL;
    }
}

const char *csg_parser_hint(const csg_parser *parser, csg_token_kind expected)
{
    csg_token now = token(parser, 0);
    csg_token_kind before = kind_at(parser, -1), found = now.kind;
    const char *hint = hint_for_pair(found, kind_at(parser, 1));
    if (!hint)
        hint = hint_for_pair(before, found);
    if (!hint && found != CSG_TOKEN_END) /* `i++)` */
        hint = hint_for_pair(kind_at(parser, -2), before);
    if (!hint) /* `if x > 5`: this x is no sign of multiplication */
        hint = hint_for_keyword(before, found);
    if (!hint && found == CSG_TOKEN_NAME)
        hint = csg_habit_hint(CSG_HABIT_BETWEEN, parser->text + now.offset, now.length);
    if (!hint && is_word(parser, -1, "not"))
        hint = "logical not is '!'";
    if (!hint)
        hint = hint_for_expected(expected, before);
    if (!hint && (expected == CSG_TOKEN_CLOSE_ROUND || expected == CSG_TOKEN_CLOSE_SQUARE))
        return hint_inside(parser, expected);
    if (!hint && begins_value(found) && ends_value(before) && expected == CSG_TOKEN_SEMICOLON)
        hint = "is an operator missing before it?";
    if (!hint && before == CSG_TOKEN_NAME && expected == CSG_TOKEN_END)
        hint = hint_for_name(parser);
    return hint ? hint : hint_for_statement(before, found);
}
