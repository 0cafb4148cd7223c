/* SPDX-License-Identifier: MIT
 * What the parts of the parser share: the state, and the small steps over tokens.
 */
#ifndef CSG_LANG_PARSER_PRIVATE_H
#define CSG_LANG_PARSER_PRIVATE_H

#include "lang/parse/ast.h"
#include "text/lexer.h"

typedef struct csg_parser {
    csg_program *program;
    const csgm_scene_options *options;
    csg_program_file *file; /* whose scope the statements go to */
    uint32_t source;        /* being read: the file's own, or one that it includes */
    const char *text;
    csg_token_array tokens;
    size_t at;
    uint32_t depth;      /* of nesting, against the stack */
    uint32_t statements; /* begun: now and then the clock is looked at */
    bool stop;           /* memory or a limit: unwind */
    csgm_status status;  /* why */
} csg_parser;

/* How a step ended: false = an error was reported, resynchronise. */
static inline csg_token_kind csg_parser_peek(const csg_parser *parser)
{
    return parser->tokens.items[parser->at].kind;
}
static inline const csg_token *csg_parser_token(const csg_parser *parser)
{
    return &parser->tokens.items[parser->at];
}
static inline csg_span csg_parser_span(const csg_parser *parser)
{
    const csg_token *token = csg_parser_token(parser);
    return (csg_span){parser->source, token->offset, token->length};
}
void csg_parser_next(csg_parser *parser);
bool csg_parser_accept(csg_parser *parser, csg_token_kind kind);
/* Reports "expected ')' ..." when the token is not there. `context`: "after the condition". */
bool csg_parser_expect(csg_parser *parser, csg_token_kind kind, const char *context);
/* The closing bracket of one opened at `open`. */
bool csg_parser_close(csg_parser *parser, csg_token_kind kind, csg_span open);
/* "expected X but found Y" at the current token. */
void csg_parser_unexpected(csg_parser *parser, csg_diag_code code, const char *expected,
                           const char *hint);
/* From the first byte of `from` to the last token read. */
csg_span csg_parser_since(const csg_parser *parser, csg_span from);
bool csg_parser_enter(csg_parser *parser); /* one level deeper; false: too deep, reported */
void csg_parser_leave(csg_parser *parser);
void csg_parser_no_memory(csg_parser *parser);
void *csg_parser_alloc(csg_parser *parser, size_t size_bytes); /* zeroed; NULL stops the parser */
csg_symbol csg_parser_symbol(csg_parser *parser, csg_span name);

csg_expression *csg_parse_expression(csg_parser *parser);
/* "(a, b = 1)" with its parentheses: arguments, or parameters of a definition. */
bool csg_parse_arguments(csg_parser *parser, csg_arguments *out);
/* Of a let and the like: the first assignment of a name holds, the others are told and dropped. */
void csg_parser_drop_doubles(csg_parser *parser, csg_arguments *assignments);
bool csg_parse_parameters(csg_parser *parser, csg_arguments *out);

/* A new scope; NULL stops the parser. */
csg_scope *csg_parser_scope(csg_parser *parser);
/* All statements of the current source. */
void csg_parser_statements(csg_parser *parser, csg_scope *scope);

#endif
