/* SPDX-License-Identifier: MIT
 * Handlers of built-in functions; one for each name in the second column of functions.def.
 */
#ifndef CSG_LANG_FUNCTIONS_H
#define CSG_LANG_FUNCTIONS_H

#include "lang/evaluate/evaluator.h"

typedef csg_value csg_function_handler(const csg_function_call *call);

csg_function_handler csg_function_trigonometry, csg_function_atan2, csg_function_number,
    csg_function_pow, csg_function_log, csg_function_extreme, csg_function_norm, csg_function_cross,
    csg_function_dot, csg_function_len, csg_function_concat, csg_function_lookup,
    csg_function_search, csg_function_str, csg_function_chr, csg_function_ord, csg_function_is,
    csg_function_rands, csg_function_version, csg_function_parent_module, csg_function_round,
    csg_function_blend, csg_function_rule, csg_function_arc, csg_function_step,
    csg_function_profile;

#endif
