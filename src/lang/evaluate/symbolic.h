/* SPDX-License-Identifier: MIT
 * Numbers that stand for a formula: while field() evaluates its function, the coordinates of the
 * point are terms (CSG_VALUE_TERM), and operators and built-in functions build steps instead of
 * computing. A term whose value is known becomes a number again.
 */
#ifndef CSG_LANG_SYMBOLIC_H
#define CSG_LANG_SYMBOLIC_H

#include "lang/evaluate/builtins.h"
#include "scene/formula/formula.h"

static inline bool csg_value_is_scalar(csg_value value)
{
    return value.kind == CSG_VALUE_NUMBER || value.kind == CSG_VALUE_TERM;
}

/* A step on scalars (b: any, for operations of one operand). UNDEF: stopped. */
csg_value csg_symbolic_apply(csg_eval *e, csg_formula_op op, csg_value a, csg_value b,
                             csg_span where);
/* The sum of the products of `count` scalars each. */
csg_value csg_symbolic_dot(csg_eval *e, const csg_value *a, const csg_value *b, uint32_t count,
                           csg_span where);
/* An arithmetic operator on two scalars. */
csg_value csg_symbolic_operator(csg_eval *e, const csg_expression *x, csg_value a, csg_value b);
/* A built-in function with terms among its arguments; false: its own handler does. */
bool csg_symbolic_call(const csg_function_call *call, csg_value *result);
/* Reports what no formula can do when value is a term; true then. */
bool csg_symbolic_refuse(csg_eval *e, csg_value value, csg_span where, const char *what);

#endif
