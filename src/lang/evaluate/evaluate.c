/* SPDX-License-Identifier: MIT
 * Expressions -> values. A call, let or choice in tail position does not nest: the loop in
 * csg_evaluate goes on with the new expression and frame, so tail recursion needs no stack.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/scene_codes.h"
#include "lang/evaluate/builtins.h"
#include "lang/evaluate/symbolic.h"
#include "lang/parse/ast_kinds.h"
#include "text/lexer.h"

/* ---- calls
 * ------------------------------------------------------------------------------------------ */

static uint32_t find_parameter(const csg_arguments *parameters, csg_symbol name)
{
    uint32_t i = 0;
    while (i < parameters->count && parameters->items[i].name != name)
        i++;
    return i;
}

static void warn_argument(csg_eval *e, const csg_argument *argument, csg_diag_code code,
                          const csg_arguments *parameters, csg_symbol callee)
{
    const csg_symbols *symbols = &e->program->symbols;
    const char *name = callee ? csg_symbol_name(symbols, callee) : "the function";
    char hint[160] = "";
    for (uint32_t i = 0, at = 0; i < parameters->count && at < sizeof hint; i++)
        at += (uint32_t)snprintf(hint + at, sizeof hint - at, "%s%s", i ? ", " : "it takes ",
                                 csg_symbol_name(symbols, parameters->items[i].name));
    if (code == CSG_DIAG_TOO_MANY_ARGUMENTS)
        csg_eval_report(e, code, argument->where, NULL, "'%s' takes %u argument%s%s", name,
                        parameters->count, parameters->count == 1 ? "" : "s",
                        csg_eval_ignores(e, code, argument->where));
    else if (code == CSG_DIAG_DUPLICATE_ARGUMENT)
        csg_eval_report(e, code, argument->where, NULL, "'%s' gets an argument twice", name);
    else
        csg_eval_report(
            e, code, argument->where, hint[0] ? hint : NULL, "'%s' has no parameter '%s'%s", name,
            csg_symbol_name(symbols, argument->name), csg_eval_ignores(e, code, argument->where));
}

static void bind_arguments(csg_eval *e, const csg_arguments *parameters,
                           const csg_arguments *arguments, csg_frame *frame, csg_frame *caller,
                           csg_symbol name, csg_list *pending)
{
    enum { NAMES_A_STEP = 16 };
    uint32_t position = 0;
    e->steps += ((uint64_t)arguments->count + 1) * parameters->count / NAMES_A_STEP;
    for (uint32_t i = 0; i < arguments->count && !e->stop; i++) {
        const csg_argument *argument = &arguments->items[i];
        uint32_t slot = argument->name ? find_parameter(parameters, argument->name) : position++;
        csg_value value = csg_evaluate(e, argument->value, caller);
        if (slot < parameters->count) {
            if (frame->values[slot].kind != CSG_VALUE_UNSET)
                warn_argument(e, argument, CSG_DIAG_DUPLICATE_ARGUMENT, parameters, name);
            csg_value_release(&e->heap, frame->values[slot]);
            frame->values[slot] = value;
        } else if (argument->name && e->program->symbols.entries[argument->name].special) {
            csg_list_push(e, pending, csg_value_number(argument->name), argument->where);
            csg_list_push(e, pending, value, argument->where);
        } else {
            csg_value_release(&e->heap, value);
            warn_argument(e, argument,
                          argument->name ? CSG_DIAG_UNKNOWN_ARGUMENT : CSG_DIAG_TOO_MANY_ARGUMENTS,
                          parameters, name);
        }
    }
}

/* A call into a used file: the $variables that the file assigns hold in it. One that it assigns
 * undef hides nothing: newer files say so that there is such a name, for their callers to give a
 * value; to 2021.01 it was a value like any other. */
static void push_file_dynamics(csg_eval *e, const csg_frame *home, const csg_frame *caller)
{
    if (!home || !home->has_dynamics)
        return;
    bool hides_all = csg_eval_level(e) <= 20210100;
    while (caller && caller->parent)
        caller = caller->parent;
    for (uint32_t i = 0; caller != home && i < home->count && !e->stop; i++) {
        csg_symbol name = home->scope->variables[i].name;
        bool hides = hides_all || home->values[i].kind != CSG_VALUE_UNDEF ||
                     csg_eval_dynamic(e, name).kind == CSG_VALUE_UNSET;
        if (e->program->symbols.entries[name].special && hides)
            csg_eval_push_dynamic(e, name, csg_value_retain(home->values[i]));
    }
}

csg_frame *csg_eval_bind(csg_eval *e, const csg_arguments *parameters,
                         const csg_arguments *arguments, csg_frame *home, csg_frame *caller,
                         csg_symbol name)
{
    csg_list pending = {0};
    csg_frame *frame = csg_frame_create(&e->heap, home, parameters->count);
    if (!frame) {
        csg_eval_no_memory(e);
        return NULL;
    }
    frame->names = parameters->items;
    bind_arguments(e, parameters, arguments, frame, caller, name, &pending);
    push_file_dynamics(e, home, caller);
    for (uint32_t i = 0; i < parameters->count && !e->stop; i++)
        if (frame->values[i].kind == CSG_VALUE_UNSET)
            frame->values[i] = parameters->items[i].value
                                   ? csg_evaluate(e, parameters->items[i].value, home)
                                   : csg_value_undef();
    for (size_t i = 0; i + 1 < pending.count && !e->stop; i += 2)
        csg_eval_push_dynamic(e, (csg_symbol)pending.items[i].as.number, pending.items[i + 1]);
    for (uint32_t i = 0; i < parameters->count && !e->stop; i++)
        if (e->program->symbols.entries[parameters->items[i].name].special)
            csg_eval_push_dynamic(e, parameters->items[i].name, csg_value_retain(frame->values[i]));
    csg_memory_release(e->heap.memory, pending.items, pending.capacity * sizeof *pending.items);
    return frame;
}

csg_frame *csg_eval_let(csg_eval *e, const csg_arguments *assignments, csg_frame *parent)
{
    csg_frame *frame = csg_frame_create(&e->heap, parent, assignments->count);
    if (!frame) {
        csg_eval_no_memory(e);
        return NULL;
    }
    frame->names = assignments->items;
    for (uint32_t i = 0; i < assignments->count && !e->stop; i++) {
        csg_symbol name = assignments->items[i].name;
        csg_value value = csg_evaluate(e, assignments->items[i].value, frame);
        if (name && e->program->symbols.entries[name].special)
            csg_eval_push_dynamic(e, name, value);
        else
            frame->values[i] = value;
    }
    return frame;
}

/* What a call goes to. */
typedef struct target {
    const csg_arguments *parameters;
    const csg_expression *body;
    csg_frame *home; /* retained */
    csg_symbol name;
    int builtin; /* row, or -1 */
} target;

static bool to_literal(csg_value value, target *out)
{
    if (value.kind != CSG_VALUE_FUNCTION)
        return false;
    const csg_function *function = value.as.function;
    out->parameters = &function->literal->as.call.arguments;
    out->body = function->literal->as.call.body;
    out->home = csg_frame_retain(function->frame);
    return true;
}

/* A variable that holds a function, in this frame or further out. */
static bool find_literal(csg_eval *e, const csg_expression *name, const csg_frame *frame,
                         target *out)
{
    const csg_value *found = csg_eval_find_variable(e, name, frame);
    return found && to_literal(*found, out);
}

static const char *loss_of_call(const csg_eval *e, csg_span where)
{
    return csg_eval_is_lenient(e, CSG_DIAG_UNKNOWN_FUNCTION, where) ? "; the call counts as undef"
                                                                    : "";
}

static bool find_target(csg_eval *e, const csg_expression *call, csg_frame *frame, target *out)
{
    const csg_expression *callee = call->as.call.callee;
    csg_called called;
    char hint[96];
    *out = (target){.builtin = -1};
    if (callee->kind != CSG_EXPRESSION_NAME) {
        csg_value value = csg_evaluate(e, callee, frame);
        bool found = to_literal(value, out);
        if (!found)
            csg_eval_report(e, CSG_DIAG_UNKNOWN_FUNCTION, callee->whole,
                            callee->kind == CSG_EXPRESSION_MEMBER
                                ? "a function stands in front of its arguments: len(v), not v.len()"
                            : value.kind == CSG_VALUE_NUMBER ? "a multiplication needs '*'"
                                                             : NULL,
                            "only a function can be called, this is %s%s%s",
                            value.kind == CSG_VALUE_UNDEF ? "" : "a ", csg_value_kind_name(value),
                            loss_of_call(e, callee->whole));
        csg_value_release(&e->heap, value);
        return found;
    }
    out->name = callee->as.name;
    if (e->program->symbols.entries[out->name].variable && find_literal(e, callee, frame, out))
        return true; /* as in OpenSCAD, a variable's function goes before a named one */
    if (csg_eval_find_called(e, CSG_MEMBER_FUNCTION, out->name, callee->slot, frame, &called)) {
        out->parameters = &called.definition->parameters;
        out->body = called.definition->value;
        out->home = csg_frame_retain(called.home);
        return true;
    }
    out->builtin = e->program->symbols.entries[out->name].function;
    if (out->builtin < 0 && !e->stop)
        csg_eval_report(e, CSG_DIAG_UNKNOWN_FUNCTION, callee->where,
                        csg_suggest(e, CSG_DIAG_UNKNOWN_FUNCTION, out->name, frame, callee->where,
                                    hint, sizeof hint),
                        "there is no function '%s'%s",
                        csg_symbol_name(&e->program->symbols, out->name),
                        loss_of_call(e, callee->where));
    return out->builtin >= 0;
}

/* ---- literals, vectors, indices
 * ------------------------------------------------------------------------ */

enum { BYTES_A_STEP = 64 }; /* that are copied or scanned */

csg_value csg_eval_string(csg_eval *e, const char *text, size_t length)
{
    csg_string *made = csg_string_create(&e->heap, text, length);
    if (!made) {
        csg_eval_no_memory(e);
        return csg_value_undef();
    }
    return csg_value_object(made, CSG_VALUE_STRING);
}

uint32_t csg_eval_level(const csg_eval *e)
{
    enum { NEWEST = 20260101 };
    const csgm_scene_options *options = e->program->options;
    return options && options->openscad_version ? options->openscad_version : NEWEST;
}

static bool is_literal(const csg_expression *x)
{
    return x->kind == CSG_EXPRESSION_NUMBER ||
           (x->kind == CSG_EXPRESSION_UNARY && x->as.pair.left->kind == CSG_EXPRESSION_NUMBER);
}

/* [3 : 1] counts from 1 to 3 in OpenSCAD 2021.01, which calls that deprecated; newer ones have no
 * elements there, so that [0 : len(list) - 1] is right for empty lists, too. */
static void turn_backward_range(csg_eval *e, const csg_expression *x, csg_value *begin,
                                csg_value *end)
{
    enum { EMPTY_SINCE = 20250300 };
    const char *hint = "a range that counts down is [a : -1 : b]";
    if (csg_eval_level(e) < EMPTY_SINCE) {
        csg_value swap = *begin;
        *begin = *end;
        *end = swap;
        csg_eval_report(e, CSG_DIAG_BAD_RANGE, x->where, hint,
                        "the range begins above its end; it is taken the other way round");
    } else if (is_literal(x->as.range.begin) && is_literal(x->as.range.end)) {
        csg_eval_report(e, CSG_DIAG_BAD_RANGE, x->where, hint,
                        "the range begins above its end: it has no elements");
    }
}

static csg_value evaluate_range(csg_eval *e, const csg_expression *x, csg_frame *frame)
{
    csg_value begin = csg_evaluate(e, x->as.range.begin, frame);
    csg_value step =
        x->as.range.step ? csg_evaluate(e, x->as.range.step, frame) : csg_value_number(1);
    csg_value end = csg_evaluate(e, x->as.range.end, frame);
    bool numbers = begin.kind == CSG_VALUE_NUMBER && step.kind == CSG_VALUE_NUMBER &&
                   end.kind == CSG_VALUE_NUMBER;
    csg_value made = csg_value_undef();
    if (numbers && !x->as.range.step && begin.as.number > end.as.number)
        turn_backward_range(e, x, &begin, &end);
    if (numbers)
        made = csg_range_create(&e->heap, begin.as.number, step.as.number, end.as.number);
    if (numbers && made.kind == CSG_VALUE_UNDEF)
        csg_eval_no_memory(e);
    csg_value_release(&e->heap, begin);
    csg_value_release(&e->heap, step);
    csg_value_release(&e->heap, end);
    return made;
}

static csg_value character_at(csg_eval *e, const csg_string *string, double index, csg_span where)
{
    if (!(index >= 0) || index >= (double)string->characters)
        return csg_value_undef();
    size_t from = (size_t)index, to = from + 1;
    if (string->characters != string->length) {
        if (!csg_eval_charge(e, from / BYTES_A_STEP, where))
            return csg_value_undef();
        size_t skip = from + 1;
        for (from = 0; skip > 0; from++)
            skip -= ((unsigned char)string->text[from] & 0xC0) != 0x80;
        from--;
        for (to = from + 1; ((unsigned char)string->text[to] & 0xC0) == 0x80;)
            to++;
    }
    return csg_eval_string(e, string->text + from, to - from);
}

/* Its search costs steps: an object may have many entries. */
static csg_value entry_at(csg_eval *e, csg_value record, const char *key, size_t length,
                          csg_span where)
{
    enum { KEYS_A_STEP = 16 };
    uint32_t count = csg_record_count(record);
    if (!csg_eval_charge(e, count / KEYS_A_STEP, where))
        return csg_value_undef();
    uint32_t i = csg_record_find(record, key, length);
    return i < count ? csg_value_retain(record.as.vector->items[2 * i + 1]) : csg_value_undef();
}

static csg_value element_at(csg_eval *e, csg_value object, csg_value index, csg_span where)
{
    double i = index.kind == CSG_VALUE_NUMBER ? trunc(index.as.number) : -1;
    if (object.kind == CSG_VALUE_VECTOR && i >= 0 && i < object.as.vector->count)
        return csg_value_retain(object.as.vector->items[(size_t)i]);
    if (object.kind == CSG_VALUE_RECORD && index.kind == CSG_VALUE_STRING)
        return entry_at(e, object, index.as.string->text, index.as.string->length, where);
    if (object.kind == CSG_VALUE_STRING)
        return character_at(e, object.as.string, i, where);
    if (object.kind == CSG_VALUE_RANGE && i >= 0 && i < 3) {
        const csg_range *range = object.as.range;
        return csg_value_number(i == 0 ? range->begin : i == 1 ? range->step : range->end);
    }
    return csg_value_undef();
}

static csg_value evaluate_member(csg_eval *e, const csg_expression *x, csg_frame *frame)
{
    csg_value object = csg_evaluate(e, x->as.member.object, frame), result = csg_value_undef();
    csg_symbol name = x->as.member.name;
    if (object.kind == CSG_VALUE_VECTOR) {
        double index = name == e->symbol_x   ? 0
                       : name == e->symbol_y ? 1
                       : name == e->symbol_z ? 2
                                             : -1;
        result = element_at(e, object, csg_value_number(index), x->where);
    } else if (object.kind == CSG_VALUE_RECORD) {
        const csg_symbol_entry *key = &e->program->symbols.entries[name];
        result = entry_at(e, object, key->name, key->length, x->where);
    } else if (object.kind == CSG_VALUE_RANGE) {
        double index = name == e->symbol_begin  ? 0
                       : name == e->symbol_step ? 1
                       : name == e->symbol_end  ? 2
                                                : -1;
        result = element_at(e, object, csg_value_number(index), x->where);
    }
    csg_value_release(&e->heap, object);
    return result;
}

/* ---- operators
 * --------------------------------------------------------------------------------------------- */

/* Of two numbers; false: csg_eval_binary has to see to it. */
static inline bool combine_numbers(uint8_t operation, double a, double b, csg_value *out)
{
    switch (operation) {
    case CSG_TOKEN_PLUS:
        *out = csg_value_number(a + b);
        return true;
    case CSG_TOKEN_MINUS:
        *out = csg_value_number(a - b);
        return true;
    case CSG_TOKEN_STAR:
        *out = csg_value_number(a * b);
        return true;
    case CSG_TOKEN_SLASH:
        *out = csg_value_number(a / b);
        return true;
    case CSG_TOKEN_LESS:
        *out = csg_value_boolean(a < b);
        return true;
    case CSG_TOKEN_LESS_EQUAL:
        *out = csg_value_boolean(a <= b);
        return true;
    case CSG_TOKEN_GREATER:
        *out = csg_value_boolean(a > b);
        return true;
    case CSG_TOKEN_GREATER_EQUAL:
        *out = csg_value_boolean(a >= b);
        return true;
    case CSG_TOKEN_EQUAL:
        *out = csg_value_boolean(a == b);
        return true;
    case CSG_TOKEN_NOT_EQUAL:
        *out = csg_value_boolean(a != b);
        return true;
    default:
        return false;
    }
}

static csg_value evaluate_binary(csg_eval *e, const csg_expression *x, csg_frame *frame)
{
    csg_value left = csg_evaluate(e, x->as.pair.left, frame), result;
    if (x->operation == CSG_TOKEN_AND || x->operation == CSG_TOKEN_OR) {
        csg_symbolic_refuse(e, left, x->where, "a condition");
        bool decided = csg_value_is_true(left) == (x->operation == CSG_TOKEN_OR);
        csg_value_release(&e->heap, left);
        if (decided || e->stop)
            return csg_value_boolean(x->operation == CSG_TOKEN_OR);
        csg_value right = csg_evaluate(e, x->as.pair.right, frame);
        bool truth = csg_value_is_true(right);
        csg_value_release(&e->heap, right);
        return csg_value_boolean(truth);
    }
    csg_value right = csg_evaluate(e, x->as.pair.right, frame);
    if (left.kind == CSG_VALUE_NUMBER && right.kind == CSG_VALUE_NUMBER &&
        combine_numbers(x->operation, left.as.number, right.as.number, &result))
        return result;
    result = csg_eval_binary(e, x, left, right);
    csg_value_release(&e->heap, left);
    csg_value_release(&e->heap, right);
    return result;
}

static csg_value evaluate_unary(csg_eval *e, const csg_expression *x, csg_frame *frame)
{
    csg_value operand = csg_evaluate(e, x->as.pair.left, frame);
    csg_value result = csg_eval_unary(e, x, operand);
    csg_value_release(&e->heap, operand);
    return result;
}

static csg_value evaluate_index(csg_eval *e, const csg_expression *x, csg_frame *frame)
{
    csg_value object = csg_evaluate(e, x->as.pair.left, frame);
    csg_value index = csg_evaluate(e, x->as.pair.right, frame);
    csg_symbolic_refuse(e, index, x->where, "an index");
    csg_value result = element_at(e, object, index, x->where);
    csg_value_release(&e->heap, object);
    csg_value_release(&e->heap, index);
    return result;
}

static csg_value evaluate_name(csg_eval *e, const csg_expression *x, csg_frame *frame)
{
    const csg_value *found = csg_eval_find_variable(e, x, frame);
    return found ? csg_value_retain(*found) : csg_eval_no_variable(e, x, frame);
}

/* Every kind that ends here: those without a tail. */
static csg_value evaluate_plain(csg_eval *e, const csg_expression *x, csg_frame *frame)
{
    csg_value made;
    switch ((csg_expression_kind)x->kind) {
    case CSG_EXPRESSION_NUMBER:
        return csg_value_number(x->as.number);
    case CSG_EXPRESSION_BOOLEAN:
        return csg_value_boolean(x->as.boolean);
    case CSG_EXPRESSION_STRING:
        if (!csg_eval_charge(e, x->as.string.length / BYTES_A_STEP, x->where))
            return csg_value_undef();
        return csg_eval_string(e, x->as.string.text, x->as.string.length);
    case CSG_EXPRESSION_NAME:
        return evaluate_name(e, x, frame);
    case CSG_EXPRESSION_UNARY:
        return evaluate_unary(e, x, frame);
    case CSG_EXPRESSION_BINARY:
        return evaluate_binary(e, x, frame);
    case CSG_EXPRESSION_INDEX:
        return evaluate_index(e, x, frame);
    case CSG_EXPRESSION_MEMBER:
        return evaluate_member(e, x, frame);
    case CSG_EXPRESSION_VECTOR:
        return csg_eval_vector(e, x, frame);
    case CSG_EXPRESSION_RANGE:
        return evaluate_range(e, x, frame);
    case CSG_EXPRESSION_FUNCTION:
        made = csg_function_create(&e->heap, x, frame);
        if (made.kind == CSG_VALUE_UNDEF)
            csg_eval_no_memory(e);
        return made;
    case CSG_EXPRESSION_UNDEF:
    case CSG_EXPRESSION_CONDITIONAL:
    case CSG_EXPRESSION_CALL:
    case CSG_EXPRESSION_LET:
    case CSG_EXPRESSION_ASSERT:
    case CSG_EXPRESSION_ECHO:
    case CSG_EXPRESSION_FOR:
    case CSG_EXPRESSION_FOR_LOOP:
    case CSG_EXPRESSION_IF:
    case CSG_EXPRESSION_EACH:
        break;
    }
    return csg_value_undef();
}

/* ---- the loop
 * --------------------------------------------------------------------------------------------- */

typedef struct position {    /* where an evaluation is */
    const csg_expression *x; /* NULL: undef */
    csg_frame *frame;
    bool owned;  /* the frame is ours to release */
    bool called; /* a call is on the trace */
} position;

static void replace_frame(csg_eval *e, position *at, csg_frame *fresh)
{
    if (at->owned)
        csg_frame_release(&e->heap, at->frame);
    at->frame = fresh;
    at->owned = fresh != NULL;
}

/* Steps into a user's function. */
static void step_into(csg_eval *e, position *at, const target *to)
{
    enum { CALL_STEPS = 10 };
    const csg_expression *call = at->x;
    at->x = NULL;
    if (!at->called) {
        if (!csg_eval_enter(e, call->where))
            return;
        csg_eval_push_trace(e, to->name, false, call->where);
        at->called = true;
        if (e->stop)
            return;
    } else {
        e->trace[e->trace_count - 1] = (csg_trace_entry){to->name, false, call->where};
    }
    csg_frame *fresh =
        csg_eval_bind(e, to->parameters, &call->as.call.arguments, to->home, at->frame, to->name);
    replace_frame(e, at, fresh);
    if (fresh && csg_eval_charge(e, CALL_STEPS, call->where))
        at->x = to->body;
}

/* A call of a built-in is finished here (true), one of a user's function is stepped into. */
static bool evaluate_call(csg_eval *e, position *at, csg_value *result)
{
    target to;
    if (!find_target(e, at->x, at->frame, &to))
        return true;
    if (to.builtin >= 0) {
        *result = e->program->builtins->call_function(e, to.builtin, at->x, at->frame);
        return true;
    }
    csg_frame *home = to.home;
    step_into(e, at, &to);
    csg_frame_release(&e->heap, home);
    return at->x == NULL;
}

static void choose(csg_eval *e, position *at)
{
    csg_value condition = csg_evaluate(e, at->x->as.branch.condition, at->frame);
    csg_symbolic_refuse(e, condition, at->x->where, "a condition");
    at->x = csg_value_is_true(condition) ? at->x->as.branch.then : at->x->as.branch.other;
    csg_value_release(&e->heap, condition);
}

static void step_over(csg_eval *e, position *at)
{
    const csg_expression *x = at->x;
    if (x->kind == CSG_EXPRESSION_LET)
        replace_frame(e, at, csg_eval_let(e, &x->as.call.arguments, at->frame));
    else if (x->kind == CSG_EXPRESSION_ECHO)
        csg_eval_echo(e, &x->as.call.arguments, at->frame);
    else
        csg_eval_assert(e, &x->as.call.arguments, at->frame, x->where);
    at->x = x->as.call.body;
}

/* Calls, lets and choices, one after the other as long as one is the tail of the one before. */
static csg_value evaluate_tails(csg_eval *e, const csg_expression *x, csg_frame *frame)
{
    csg_value result = csg_value_undef();
    position at = {x, frame, false, false};
    size_t dynamics = e->dynamic_count, trace = e->trace_count;
    bool done = false;
    while (!done && at.x && csg_eval_charge(e, 1, at.x->where)) {
        switch ((csg_expression_kind)at.x->kind) {
        case CSG_EXPRESSION_CONDITIONAL:
            choose(e, &at);
            break;
        case CSG_EXPRESSION_LET:
        case CSG_EXPRESSION_ASSERT:
        case CSG_EXPRESSION_ECHO:
            step_over(e, &at);
            break;
        case CSG_EXPRESSION_CALL:
            done = evaluate_call(e, &at, &result);
            break;
        case CSG_EXPRESSION_NUMBER:
        case CSG_EXPRESSION_BOOLEAN:
        case CSG_EXPRESSION_UNDEF:
        case CSG_EXPRESSION_STRING:
        case CSG_EXPRESSION_NAME:
        case CSG_EXPRESSION_UNARY:
        case CSG_EXPRESSION_BINARY:
        case CSG_EXPRESSION_INDEX:
        case CSG_EXPRESSION_MEMBER:
        case CSG_EXPRESSION_VECTOR:
        case CSG_EXPRESSION_RANGE:
        case CSG_EXPRESSION_FUNCTION:
        case CSG_EXPRESSION_FOR:
        case CSG_EXPRESSION_FOR_LOOP:
        case CSG_EXPRESSION_IF:
        case CSG_EXPRESSION_EACH:
            result = evaluate_plain(e, at.x, at.frame);
            done = true;
            break;
        }
    }
    if (at.owned)
        csg_frame_release(&e->heap, at.frame);
    if (e->dynamic_count > dynamics)
        csg_eval_pop_dynamics(e, dynamics);
    if (at.called) {
        csg_eval_leave(e);
        e->trace_count = trace;
    }
    return result;
}

csg_value csg_evaluate(csg_eval *e, const csg_expression *x, csg_frame *frame)
{
    switch ((csg_expression_kind)x->kind) {
    case CSG_EXPRESSION_NUMBER:
        return csg_value_number(x->as.number);
    case CSG_EXPRESSION_NAME:
        return csg_eval_charge(e, 1, x->where) ? evaluate_name(e, x, frame) : csg_value_undef();
    case CSG_EXPRESSION_CONDITIONAL:
    case CSG_EXPRESSION_LET:
    case CSG_EXPRESSION_ASSERT:
    case CSG_EXPRESSION_ECHO:
    case CSG_EXPRESSION_CALL:
        return csg_eval_check_stack(e, x->where) ? evaluate_tails(e, x, frame) : csg_value_undef();
    case CSG_EXPRESSION_BOOLEAN:
    case CSG_EXPRESSION_UNDEF:
    case CSG_EXPRESSION_STRING:
    case CSG_EXPRESSION_UNARY:
    case CSG_EXPRESSION_BINARY:
    case CSG_EXPRESSION_INDEX:
    case CSG_EXPRESSION_MEMBER:
    case CSG_EXPRESSION_VECTOR:
    case CSG_EXPRESSION_RANGE:
    case CSG_EXPRESSION_FUNCTION:
    case CSG_EXPRESSION_FOR:
    case CSG_EXPRESSION_FOR_LOOP:
    case CSG_EXPRESSION_IF:
    case CSG_EXPRESSION_EACH:
        break;
    }
    if (!csg_eval_check_stack(e, x->where) || !csg_eval_charge(e, 1, x->where))
        return csg_value_undef();
    return evaluate_plain(e, x, frame);
}
