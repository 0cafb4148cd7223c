/* SPDX-License-Identifier: MIT
 * Functions of the scene language as formulas: what field() and combine() share.
 */
#ifndef CSG_LANG_FORMULA_CALL_H
#define CSG_LANG_FORMULA_CALL_H

#include "lang/modules/modules.h"

/* Whether the argument is a function of at least `least` parameters. */
bool csg_argument_is_function(const csg_module_call *call, uint32_t index, uint32_t least);
/* The formula of the function: its first parameter is a point of terms (operands = 0), or its first
 * `operands` parameters are x, y, z in order. Memory is from the heap: *bytes. NULL after a report.
 */
csg_formula_step *csg_formula_of_function(csg_module_call *call, uint32_t index, uint32_t operands,
                                          uint32_t *count, size_t *bytes);
/* The same for a function that is not itself the argument. */
csg_formula_step *csg_formula_of_literal(csg_module_call *call, uint32_t index,
                                         const csg_function *function, uint32_t operands,
                                         uint32_t *count, size_t *bytes);
/* [[x, y, z], [x, y, z]], or all of space when it was not given. */
csg_box csg_argument_box(csg_module_call *call, uint32_t index);

#endif
