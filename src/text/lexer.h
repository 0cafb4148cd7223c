/* SPDX-License-Identifier: MIT
 * Bytes -> tokens. Never fails on any input: what is wrong is reported with its place, and the
 * tokens around it stay usable. The array ends with an END token.
 */
#ifndef CSG_TEXT_LEXER_H
#define CSG_TEXT_LEXER_H

#include "text/source.h"

typedef enum csg_token_kind {
#define CSG_TOKEN(NAME, text) CSG_TOKEN_##NAME,
#include "text/tokens.def"
    CSG_TOKEN_COUNT
} csg_token_kind;

typedef struct csg_token {
    uint8_t kind; /* csg_token_kind */
    uint32_t offset, length;
} csg_token;

typedef struct csg_token_array {
    csg_token *items; /* from the context's memory */
    size_t count, capacity;
} csg_token_array;

/* False when memory ran out (not reported). Release the array in either case. */
bool csg_lex(const csg_sources *sources, uint32_t source, csg_token_array *out);
void csg_tokens_release(csg_memory *memory, csg_token_array *tokens);

/* "';'", "a number": for messages; static storage. */
const char *csg_token_kind_name(csg_token_kind kind);

/* The value of a NUMBER token's text. */
double csg_token_number(const char *text, uint32_t length);
/* The characters of a STRING token (its text with quotes), escapes resolved; NULL: no memory. */
char *csg_token_string(csg_arena *arena, const char *text, uint32_t length, size_t *out_length);

#endif
