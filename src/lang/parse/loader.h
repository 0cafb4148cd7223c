/* SPDX-License-Identifier: MIT
 * Files behind include and use: where they are looked for, who may ask for them (no cycles), and
 * the list of dependencies in order of first reading.
 */
#ifndef CSG_LANG_LOADER_H
#define CSG_LANG_LOADER_H

#include "lang/parse/parser_private.h"

/* Parses the statements of the file named by a PATH token into `scope`. */
void csg_load_include(csg_parser *parser, csg_scope *scope, csg_span path);
/* Parses the file on its own (once) and adds it to the parser's file's uses. */
void csg_load_use(csg_parser *parser, csg_span path);

/* Counts a file among the scene's dependencies, once; `path` stays valid as long as the program.
 * False without memory. */
bool csg_program_depend(csg_program *program, const char *path);

/* A new scope; NULL stops the parser. */
csg_scope *csg_parser_scope(csg_parser *parser);
/* All statements of the current source. */
void csg_parser_statements(csg_parser *parser, csg_scope *scope);

/* Is there room on the stack between `here` (the address of a local) and its end? */
static inline bool csg_stack_has_room(uintptr_t stack_end, const void *here)
{
    enum { MARGIN = 64 << 10 }; /* for the deepest calls below a check */
    return (uintptr_t)here > stack_end + MARGIN;
}

#endif
