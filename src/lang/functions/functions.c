/* SPDX-License-Identifier: MIT
 * Calls of built-in functions: the table, the count of arguments, suggestions for unknown names;
 * and the functions that make blend values.
 */
#include "lang/functions/functions.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/scene_codes.h"
#include "lang/evaluate/symbolic.h"
#include "scene/operators/blend_kinds.h"

typedef struct row {
    const char *name;
    csg_function_handler *handler;
    uint32_t fewest, most;
    const char *parameters;
} row;

static const row rows[] = {
#define CSG_FUNCTION(name, handler, fewest, most, parameters, doc)                                 \
    {#name, csg_function_##handler, fewest, most, parameters},
#include "lang/functions/functions.def"
#undef CSG_FUNCTION
};

enum row_index {
#define CSG_FUNCTION(name, handler, fewest, most, parameters, doc) ROW_##name,
#include "lang/functions/functions.def"
#undef CSG_FUNCTION
    ROW_COUNT
};

/* Every blend and rule has a row here by its own name, or it could not be called. */
enum {
#define CSG_FUNCTION(name, handler, fewest, most, parameters, doc) FUNCTION_##name,
#include "lang/functions/functions.def"
#undef CSG_FUNCTION
};
#define CSG_FOLD(NAME, name, area, raw, support, excess, smooth, convex, doc)                      \
    _Static_assert(FUNCTION_##name >= 0, "a row of functions.def");
#define CSG_RULE(NAME, name, space, fold, interval, demand, lipschitz, equal, doc)                 \
    _Static_assert(FUNCTION_##name >= 0, "a row of functions.def");
#define CSG_RULE_INNER(NAME, name, space, fold, interval, demand, lipschitz, equal, doc)
#include "lang/parse/ast_kinds.h"
#include "scene/operators/operators.def"

void csg_functions_intern(csg_symbols *symbols, bool *ok)
{
    for (size_t i = 0; i < ROW_COUNT && *ok; i++) {
        csg_symbol symbol = csg_symbol_intern(symbols, rows[i].name, strlen(rows[i].name));
        *ok = symbol != 0;
        if (symbol)
            symbols->entries[symbol].function = (int16_t)i;
    }
}

static csg_value call_row(const row *r, const csg_function_call *call)
{
    if (call->count < r->fewest || call->count > r->most) {
        csg_eval_report(call->e, CSG_DIAG_BAD_ARGUMENT, call->where, NULL,
                        "%s(%s) does not take %u argument%s; it counts as undef", r->name,
                        r->parameters, call->count, call->count == 1 ? "" : "s");
        return csg_value_undef();
    }
    csg_value result = csg_value_undef();
    if (call->e->formula && csg_symbolic_call(call, &result))
        return result;
    return r->handler(call);
}

/* is_undef(name) asks whether there is such a variable, so a name that nobody knows is no finding.
 */
static csg_value evaluate_argument(csg_eval *e, int index, const csg_expression *x,
                                   csg_frame *frame)
{
    bool is_asked = index == ROW_is_undef && x->kind == CSG_EXPRESSION_NAME;
    if (is_asked && !csg_eval_find_variable(e, x, frame))
        return x->as.name == e->symbol_pi ? csg_value_number(1) : csg_value_undef();
    return csg_evaluate(e, x, frame);
}

csg_value csg_functions_call(csg_eval *e, int index, const csg_expression *x, csg_frame *frame)
{
    enum { FEW = 6 };
    csg_value few[FEW], *values = few, result = csg_value_undef();
    const csg_arguments *arguments = &x->as.call.arguments;
    size_t bytes = arguments->count * sizeof *values;
    uint32_t done = 0;
    if (arguments->count > FEW)
        values = csg_memory_alloc(e->heap.memory, bytes);
    if (!values) {
        csg_eval_no_memory(e);
        return result;
    }
    for (; done < arguments->count && !e->stop; done++)
        values[done] = evaluate_argument(e, index, arguments->items[done].value, frame);
    csg_function_call call = {e, rows[index].name, x->where, arguments->items, values, done};
    if (!e->stop)
        result = call_row(&rows[index], &call);
    while (done > 0)
        csg_value_release(&e->heap, values[--done]);
    if (values != few)
        csg_memory_release(e->heap.memory, values, bytes);
    return result;
}

/* ---- blends
 * ------------------------------------------------------------------------------------------ */

static csg_value make_blend(const csg_function_call *call, csg_blend_kind kind, double n)
{
    if (!(n >= 0) || isinf(n)) {
        csg_span where = call->syntax[0].value->whole;
        csg_eval_report(call->e, CSG_DIAG_OUT_OF_RANGE, where, NULL,
                        "%s() needs a finite number of at least 0, not %g%s", call->name, n,
                        csg_eval_is_lenient(call->e, CSG_DIAG_OUT_OF_RANGE, where)
                            ? "; the blend is left out"
                            : "");
        n = 0;
    }
    csg_value made = {.kind = CSG_VALUE_BLEND, .blend = (uint8_t)(n > 0 ? kind : CSG_BLEND_SHARP)};
    made.as.number = n;
    return made;
}

/* The one argument of a blend; NAN after a report. */
static double blend_number(const csg_function_call *call)
{
    if (call->arguments[0].kind == CSG_VALUE_NUMBER)
        return call->arguments[0].as.number;
    csg_eval_report(call->e, CSG_DIAG_BAD_BLEND, call->syntax[0].value->whole, NULL,
                    "%s() needs a number, not a %s", call->name,
                    csg_value_kind_name(call->arguments[0]));
    return NAN;
}

csg_value csg_no_such_blend(const csg_function_call *call)
{
    csg_eval_report(call->e, CSG_DIAG_BAD_BLEND, call->where, NULL,
                    "%s() has no row in the table of blends", call->name);
    return csg_value_undef();
}

/* Only fillet() has a second parameter, which it can be asked for and does not have. */
static void refuse_second(const csg_function_call *call)
{
    csg_symbol name = call->syntax[1].name;
    const char *text = name ? csg_symbol_name(&call->e->program->symbols, name) : "";
    bool is_g2 = strcmp(text, "g2") == 0;
    if (is_g2 && !csg_value_is_true(call->arguments[1]))
        return;
    csg_eval_report(
        call->e, is_g2 ? CSG_DIAG_BAD_BLEND : CSG_DIAG_UNKNOWN_ARGUMENT, call->syntax[1].where,
        is_g2 ? "exterior(r / 2, r / 2, step = poly(3)) has a continuous curvature" : NULL,
        is_g2 ? "fillet() has no g2: its profile is an arc of a circle, whose curvature "
                "begins and ends with a step"
              : "fillet() takes the radius r alone");
}

csg_value csg_function_blend(const csg_function_call *call)
{
    int kind = CSG_BLEND_COUNT - 1;
    while (kind > 0 && strcmp(csg_blend_name((uint32_t)kind), call->name) != 0)
        kind--;
    if (kind == 0) /* a row here without one in operators.def must not pass for a sharp blend */
        return csg_no_such_blend(call);
    if (call->count > 1)
        refuse_second(call);
    double value = blend_number(call);
    bool raw = call->syntax[0].name == call->e->symbol_n;
    if (call->arguments[0].kind != CSG_VALUE_NUMBER)
        return csg_value_undef();
    bool radius = kind == CSG_BLEND_FILLET && call->syntax[0].name == call->e->symbol_r;
    if (call->syntax[0].name && !raw && !radius && call->syntax[0].name != call->e->symbol_w)
        csg_eval_report(call->e, CSG_DIAG_UNKNOWN_ARGUMENT, call->syntax[0].where, NULL,
                        "%s() takes the width w or the raw parameter n", call->name);
    return make_blend(call, kind, raw ? value : csg_blend_raw((uint32_t)kind, value));
}

csg_value csg_function_round(const csg_function_call *call)
{
    bool number = call->arguments[0].kind == CSG_VALUE_NUMBER;
    if (call->syntax[0].name == call->e->symbol_r) {
        double radius = blend_number(call);
        return number ? make_blend(call, CSG_BLEND_ROUND, radius) : csg_value_undef();
    }
    return number ? csg_value_number(round(call->arguments[0].as.number))
                  : csg_bad_argument(call, 0, "a number");
}

/* round(x) with one positional argument, and no function of the scene in its place. */
static bool is_round_call(csg_eval *e, const csg_expression *x, csg_frame *frame)
{
    csg_called called;
    return x->kind == CSG_EXPRESSION_CALL && x->as.call.callee->kind == CSG_EXPRESSION_NAME &&
           x->as.call.callee->as.name == e->symbol_round && x->as.call.arguments.count == 1 &&
           !x->as.call.arguments.items[0].name &&
           !csg_eval_find_called(e, CSG_MEMBER_FUNCTION, e->symbol_round, x->as.call.callee->slot,
                                 frame, &called);
}

csg_value csg_evaluate_blend(csg_eval *e, const csg_expression *x, csg_frame *frame)
{
    while (x->kind == CSG_EXPRESSION_CONDITIONAL) {
        csg_value condition = csg_evaluate(e, x->as.branch.condition, frame);
        x = csg_value_is_true(condition) ? x->as.branch.then : x->as.branch.other;
        csg_value_release(&e->heap, condition);
    }
    if (!is_round_call(e, x, frame))
        return csg_evaluate(e, x, frame);
    csg_value value = csg_evaluate(e, x->as.call.arguments.items[0].value, frame);
    bool blends =
        value.kind == CSG_VALUE_NUMBER && value.as.number > 0 && isfinite(value.as.number);
    if (blends) { /* whatever else it is, is told of as the argument of a module */
        value.kind = CSG_VALUE_BLEND;
        value.blend = CSG_BLEND_ROUND;
    }
    return value;
}
