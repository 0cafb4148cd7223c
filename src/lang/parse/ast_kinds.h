/* SPDX-License-Identifier: MIT
 * The kinds of expressions, apart from the tree (ast.h): only who walks expressions needs to know
 * them, so a row of ast.def rebuilds little.
 */
#ifndef CSG_LANG_AST_KINDS_H
#define CSG_LANG_AST_KINDS_H

typedef enum csg_expression_kind {
#define CSG_EXPRESSION(NAME, text) CSG_EXPRESSION_##NAME,
#include "lang/parse/ast.def"
#undef CSG_EXPRESSION
} csg_expression_kind;

#endif
