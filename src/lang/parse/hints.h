/* SPDX-License-Identifier: MIT
 * What to write instead: advice for the parser's findings, and for names that nothing defines.
 */
#ifndef CSG_LANG_HINTS_H
#define CSG_LANG_HINTS_H

#include "lang/parse/parser_private.h"

typedef enum csg_habit_kind {
    CSG_HABIT_WORD,
    CSG_HABIT_BETWEEN,
    CSG_HABIT_MODULE,
    CSG_HABIT_FUNCTION,
    CSG_HABIT_VARIABLE
} csg_habit_kind;

/* The advice of habits.def, or NULL; static storage. */
const char *csg_habit_hint(csg_habit_kind kind, const char *word, size_t length);
/* For a parser that finds its current token unexpected; `expected` END: nothing in particular.
 * NULL: none. */
const char *csg_parser_hint(const csg_parser *parser, csg_token_kind expected);

#endif
