/* SPDX-License-Identifier: MIT
 * What the evaluator calls and later rooms define: built-in functions (functions/) and modules
 * (modules/), by the row of their table. Names that are known but not supported yet.
 */
#ifndef CSG_LANG_BUILTINS_H
#define CSG_LANG_BUILTINS_H

#include "lang/evaluate/evaluator.h"

typedef struct csg_builtins {
    /* The value of a call of the function in this row. */
    csg_value (*call_function)(csg_eval *e, int row, const csg_expression *x, csg_frame *frame);
    /* Runs the module in this row: parts go on the stack, several only where they may spread. */
    void (*run_module)(csg_eval *e, int row, const csg_statement *statement, csg_frame *frame,
                       bool spread);
} csg_builtins;

/* ---- calls of functions ---------------------------------------------------------------------- */

typedef struct csg_function_call {
    csg_eval *e;
    const char *name;
    csg_span where;
    const csg_argument *syntax; /* as written: names and places */
    const csg_value *arguments; /* borrowed */
    uint32_t count;
} csg_function_call;

/* Warns that an argument cannot be used; UNDEF. */
csg_value csg_bad_argument(const csg_function_call *call, uint32_t index, const char *wanted);

/* ---- what is not supported ------------------------------------------------------------------- */

void csg_unsupported_intern(csg_symbols *symbols, bool *ok);
/* Reports the name of a module that is known but not supported yet; false: it is not known. */
bool csg_unsupported_report(csg_eval *e, csg_symbol name, csg_span where);

#endif
