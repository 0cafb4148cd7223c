/* SPDX-License-Identifier: MIT
 * The assignments at the scene's top level, for what is set from outside.
 */
#ifndef CSG_LANG_ASSIGNMENTS_H
#define CSG_LANG_ASSIGNMENTS_H

#include "lang/parse/ast.h"

/* Replaces the value of the assignment of a name; false: the scene has none. */
bool csg_assignment_replace(csg_program *program, csg_symbol name, csg_expression *value);
/* The assignment of a name at the scene's top level, or NULL. */
csg_assignment *csg_assignment_find(csg_program *program, csg_symbol name);
/* "did you mean 'x'?" for a name that the scene does not assign, or NULL. */
const char *csg_assignment_suggest(const csg_program *program, const char *name, char *buffer,
                                   size_t size);

#endif
