/* SPDX-License-Identifier: MIT
 * What is set from outside the scene: a parameter set (-p, -P), then definitions (-D) over it. Each
 * replaces an assignment at the scene's top level before anything is evaluated.
 */
#ifndef CSG_LANG_OVERRIDES_H
#define CSG_LANG_OVERRIDES_H

#include "lang/parse/ast.h"

/* Call after csg_parse_program; goes on after a fault, to report all of them. */
csgm_status csg_overrides_apply(csg_program *program, const csgm_scene_options *options);

/* Replaces the value of the assignment of a name; false: the scene has none. */
bool csg_override_variable(csg_program *program, csg_symbol name, csg_expression *value);
/* The assignment of a name at the scene's top level, or NULL. */
csg_assignment *csg_override_find(csg_program *program, csg_symbol name);
/* "did you mean 'x'?" for a name that the scene does not assign, or NULL. */
const char *csg_override_suggest(const csg_program *program, const char *name, char *buffer,
                                 size_t size);

#endif
