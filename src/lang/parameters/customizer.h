/* SPDX-License-Identifier: MIT
 * The parameters that a scene offers, by the rules of OpenSCAD's customizer: literal assignments at
 * the top level of the scene's own file that stand above the line of its first '{', with what the
 * comments around them say.
 */
#ifndef CSG_LANG_CUSTOMIZER_H
#define CSG_LANG_CUSTOMIZER_H

#include "lang/parse/ast.h"

struct csgm_params {
    csgm_context *context;
    csg_arena arena; /* holds all */
    csgm_param *items;
    uint32_t count;
};

/* NUMBER, BOOLEAN, STRING, UNDEF, VECTOR or RANGE (csg_expression_kind) for a literal of that kind
 * (signs and '!' before literals count as such), -1 for what is computed. */
int csg_customizer_literal_kind(const csg_expression *expression);

/* Fills params with what the text says; before overrides. */
csgm_status csg_customizer_collect(csg_program *program, csgm_params *params);
/* Then, after overrides, with the values that hold; evaluates the scene's variables if one of those
 * is computed. */
csgm_status csg_customizer_take_values(csg_program *program, csgm_params *params);

/* What the comment behind an assignment, without its slashes, says: limits, step, choices (by the
 * kind of param->initial). A comment that is no such hint says nothing. False: no memory. */
bool csg_customizer_take_hint(csg_arena *arena, const char *text, size_t length, csgm_param *param);

#endif
