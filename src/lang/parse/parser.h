/* SPDX-License-Identifier: MIT
 * Tokens -> tree. A recursive-descent parser with one token of look-ahead; after an error it skips
 * to the end of the statement and goes on, so that one run reports many. What it could not parse
 * is missing from the tree: do not evaluate after an error.
 */
#ifndef CSG_LANG_PARSER_H
#define CSG_LANG_PARSER_H

#include "lang/parse/ast.h"

/* Parses the scene and everything it includes and uses into program->files. Reports errors in
 * context->diags; SYNTAX when there were any, IO when a file could not be read. */
csgm_status csg_parse_program(csg_program *program, uint32_t source,
                              const csgm_scene_options *options);

/* One expression that is the whole text of a source (-D). NULL after a reported error. */
csg_expression *csg_parse_lone_expression(csg_program *program, uint32_t source);

#endif
