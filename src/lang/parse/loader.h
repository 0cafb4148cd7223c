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

/* Parses the parser's source as the scene, into files[0] of the program. */
void csg_load_scene(csg_parser *parser);

#endif
