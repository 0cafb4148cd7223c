/* SPDX-License-Identifier: MIT
 * Built-in functions: a row of functions.def declares its body.
 */
#ifndef CSG_LANG_FUNCTIONS_H
#define CSG_LANG_FUNCTIONS_H

#include "lang/evaluate/builtins.h"

typedef csg_value csg_function_handler(const csg_function_call *call);

#define CSG_FUNCTION(name, handler, fewest, most, parameters, doc)                                 \
    csg_function_handler csg_function_##handler;
#include "lang/functions/functions.def"
#undef CSG_FUNCTION

void csg_functions_intern(csg_symbols *symbols, bool *ok);
/* The value of a call of the function in this row of functions.def. */
csg_value csg_functions_call(csg_eval *e, int row, const csg_expression *x, csg_frame *frame);
/* The value of an expression where a call round(r) means the blend. */
csg_value csg_evaluate_blend(csg_eval *e, const csg_expression *x, csg_frame *frame);

/* Objects under construction: a list of keys and values in turn. Sets an entry (value consumed). */
void csg_record_put(csg_eval *e, csg_list *list, const char *key, csg_value value, csg_span where);
/* The list becomes the object, and is released. */
csg_value csg_record_finish(csg_eval *e, csg_list *list);

/* For a row of functions.def whose handler looks its blend, rule or step up in another table: an
 * error where that has none of the name. */
csg_value csg_no_such_blend(const csg_function_call *call);

#endif
