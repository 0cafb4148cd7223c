/* SPDX-License-Identifier: MIT
 * Values and expressions as text, in OpenSCAD's format: numbers with six significant digits,
 * plain notation from 1e-5 up to below 1e6, else with an exponent of no padding: 1e+6, 2.5e-7.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "lang/evaluate/rule_value.h"
#include "lang/evaluate/value.h"
#include "lang/parse/ast_kinds.h"
#include "scene/operators/steps.h"
#include "text/lexer.h"

void csg_text_put(csg_text *text, const char *data, size_t length)
{
    if (text->failed)
        return;
    size_t most = text->most ? text->most : CSG_LONGEST_STRING;
    text->too_long = length > most || text->length + length > most;
    if (text->too_long || !csg_memory_reserve(text->memory, (void **)&text->data, &text->capacity,
                                              text->length + length, 1)) {
        text->failed = true;
        return;
    }
    if (length)
        memcpy(text->data + text->length, data, length);
    text->length += length;
}

void csg_text_put_string(csg_text *text, const char *data)
{
    csg_text_put(text, data, strlen(data));
}

void csg_text_reset(csg_text *text)
{
    csg_memory_release(text->memory, text->data, text->capacity);
    *text = (csg_text){.memory = text->memory};
}

/* ---- numbers -------------------------------------------------------------------------------- */

/* Digits without the point, no zeros at the end; the point stands after the first `point`. */
static void put_plain(csg_text *text, const char *digits, int count, int point)
{
    if (point <= 0) {
        csg_text_put_string(text, "0.");
        csg_text_put(text, "00000", (size_t)-point);
        csg_text_put(text, digits, (size_t)count);
        return;
    }
    csg_text_put(text, digits, (size_t)(count < point ? count : point));
    if (count > point) {
        csg_text_put(text, ".", 1);
        csg_text_put(text, digits + point, (size_t)(count - point));
    } else {
        csg_text_put(text, "00000", (size_t)(point - count));
    }
}

static void put_exponent(csg_text *text, const char *digits, int count, int exponent)
{
    char tail[16];
    csg_text_put(text, digits, 1);
    if (count > 1) {
        csg_text_put(text, ".", 1);
        csg_text_put(text, digits + 1, (size_t)count - 1);
    }
    snprintf(tail, sizeof tail, "e%+d", exponent);
    csg_text_put_string(text, tail);
}

/* The six significant digits of a positive number, and its decimal exponent. A tie goes up, as in
 * OpenSCAD (printf's goes to the even digit), so the digits are rounded here. */
static int round_digits(double number, char digits[8])
{
    char exact[48]; /* d.(25 digits)e+xxx: a tie ends at the seventh digit */
    int exponent, last = 5;
    snprintf(exact, sizeof exact, "%.25e", number);
    exponent = (int)strtol(exact + 28, NULL, 10);
    digits[0] = exact[0];
    memcpy(digits + 1, exact + 2, 5);
    if (exact[7] < '5')
        return exponent;
    while (last >= 0 && digits[last] == '9')
        digits[last--] = '0';
    if (last >= 0) {
        digits[last]++;
        return exponent;
    }
    digits[0] = '1'; /* 9.999995 */
    return exponent + 1;
}

void csg_text_put_number(csg_text *text, double number)
{
    char whole[16], digits[8];
    int count = 6;
    if (isnan(number) || isinf(number)) {
        csg_text_put_string(text, isnan(number) ? "nan" : number < 0 ? "-inf" : "inf");
        return;
    }
    if (number == 0) {
        csg_text_put(text, "0", 1);
        return;
    }
    if (fabs(number) < 1e6 && number == trunc(number)) { /* by far the most */
        csg_text_put(text, whole, (size_t)snprintf(whole, sizeof whole, "%d", (int)number));
        return;
    }
    int exponent = round_digits(fabs(number), digits);
    while (count > 1 && digits[count - 1] == '0')
        count--;
    if (number < 0)
        csg_text_put(text, "-", 1);
    if (exponent >= -5 && exponent < 6)
        put_plain(text, digits, count, exponent + 1);
    else
        put_exponent(text, digits, count, exponent);
}

/* ---- values -----------------------------------------------------------------------------------
 */

static void put_range(csg_text *text, const csg_range *range)
{
    csg_text_put(text, "[", 1);
    csg_text_put_number(text, range->begin);
    csg_text_put(text, " : ", 3);
    csg_text_put_number(text, range->step);
    csg_text_put(text, " : ", 3);
    csg_text_put_number(text, range->end);
    csg_text_put(text, "]", 1);
}

static void put_vector(csg_text *text, const csg_vector *vector, const csg_symbols *symbols)
{
    csg_text_put(text, "[", 1);
    for (uint32_t i = 0; i < vector->count && !text->failed; i++) {
        if (i)
            csg_text_put(text, ", ", 2);
        csg_text_put_value(text, vector->items[i], true, symbols);
    }
    csg_text_put(text, "]", 1);
}

static void put_record(csg_text *text, const csg_vector *entries, const csg_symbols *symbols)
{
    csg_text_put(text, "{ ", 2);
    for (uint32_t i = 0; i + 1 < entries->count && !text->failed; i += 2) {
        csg_text_put_value(text, entries->items[i], false, symbols);
        csg_text_put(text, " = ", 3);
        csg_text_put_value(text, entries->items[i + 1], true, symbols);
        csg_text_put(text, "; ", 2);
    }
    csg_text_put(text, "}", 1);
}

static void put_blend(csg_text *text, csg_value value)
{
    csg_text_put_string(text, csg_blend_name(value.blend));
    csg_text_put(text, "(", 1);
    double width = value.as.number / csg_blend_raw(value.blend, 1);
    csg_text_put_number(text, width);
    csg_text_put(text, ")", 1);
}

static void put_step(csg_text *text, csg_step step)
{
    csg_text_put_string(text, csg_step_name(step.kind));
    csg_text_put(text, "(", 1);
    csg_text_put_number(text, step.parameter);
    csg_text_put(text, ")", 1);
}

static void put_sink(void *user, const char *bytes, size_t length)
{
    csg_text_put(user, bytes, length);
}

static void put_rule(csg_text *text, const csg_rule_value *value, const csg_symbols *symbols)
{
    if (!value->function) {
        csg_rule_print(&value->rule, value->rule.range, put_sink, text);
        return;
    }
    csg_text_put_string(text, "profile(");
    csg_text_put_expression(text, value->function->literal, symbols);
    csg_text_put(text, ")", 1);
}

void csg_text_put_value(csg_text *text, csg_value value, bool quoted, const csg_symbols *symbols)
{
    switch ((csg_value_kind)value.kind) {
    case CSG_VALUE_NUMBER:
        csg_text_put_number(text, value.as.number);
        break;
    case CSG_VALUE_BOOLEAN:
        csg_text_put_string(text, value.as.boolean ? "true" : "false");
        break;
    case CSG_VALUE_STRING:
        if (quoted)
            csg_text_put(text, "\"", 1);
        csg_text_put(text, value.as.string->text, value.as.string->length);
        if (quoted)
            csg_text_put(text, "\"", 1);
        break;
    case CSG_VALUE_VECTOR:
        put_vector(text, value.as.vector, symbols);
        break;
    case CSG_VALUE_RECORD:
        put_record(text, value.as.vector, symbols);
        break;
    case CSG_VALUE_RANGE:
        put_range(text, value.as.range);
        break;
    case CSG_VALUE_FUNCTION:
        csg_text_put_expression(text, value.as.function->literal, symbols);
        break;
    case CSG_VALUE_BLEND:
        put_blend(text, value);
        break;
    case CSG_VALUE_STEP:
        put_step(text, (csg_step){(csg_step_kind)value.blend, value.as.number});
        break;
    case CSG_VALUE_RULE:
        put_rule(text, value.as.rule, symbols);
        break;
    case CSG_VALUE_TERM:
        csg_text_put_string(text, "formula");
        break;
    case CSG_VALUE_UNDEF:
    case CSG_VALUE_UNSET:
    case CSG_VALUE_FRAME:
        csg_text_put_string(text, "undef");
        break;
    }
}

/* ---- expressions -------------------------------------------------------------------------------
 */

static void put_arguments(csg_text *text, const csg_arguments *arguments,
                          const csg_symbols *symbols)
{
    for (uint32_t i = 0; i < arguments->count; i++) {
        const csg_argument *argument = &arguments->items[i];
        if (i)
            csg_text_put(text, ", ", 2);
        if (argument->name)
            csg_text_put_string(text, csg_symbol_name(symbols, argument->name));
        if (argument->name && argument->value)
            csg_text_put(text, " = ", 3);
        if (argument->value)
            csg_text_put_expression(text, argument->value, symbols);
    }
}

static void put_enclosed(csg_text *text, const csg_expression *e, const csg_symbols *symbols)
{
    csg_text_put(text, "(", 1);
    csg_text_put_expression(text, e, symbols);
    csg_text_put(text, ")", 1);
}

static bool is_generator(const csg_expression *e)
{
    while (e->kind == CSG_EXPRESSION_LET)
        e = e->as.call.body;
    return e->kind == CSG_EXPRESSION_FOR || e->kind == CSG_EXPRESSION_FOR_LOOP ||
           e->kind == CSG_EXPRESSION_IF || e->kind == CSG_EXPRESSION_EACH;
}

static void put_call(csg_text *text, const char *name, const csg_expression *call,
                     const csg_symbols *symbols)
{
    csg_text_put_string(text, name);
    csg_text_put(text, "(", 1);
    put_arguments(text, &call->as.call.arguments, symbols);
    csg_text_put(text, ")", 1);
    if (!call->as.call.body)
        return;
    csg_text_put(text, " ", 1);
    if (call->kind == CSG_EXPRESSION_LET && is_generator(call->as.call.body))
        put_enclosed(text, call->as.call.body, symbols);
    else
        csg_text_put_expression(text, call->as.call.body, symbols);
}

/* Several variables are loops in each other. */
static void put_for(csg_text *text, const csg_expression *e, const csg_symbols *symbols)
{
    const csg_arguments *variables = &e->as.call.arguments;
    for (uint32_t i = 0; i < variables->count; i++) {
        const csg_arguments one = {variables->items + i, 1};
        csg_text_put_string(text, i ? "(for(" : "for(");
        put_arguments(text, &one, symbols);
        csg_text_put_string(text, ") ");
    }
    put_enclosed(text, e->as.call.body, symbols);
    for (uint32_t i = 1; i < variables->count; i++)
        csg_text_put(text, ")", 1);
}

static void put_string(csg_text *text, const char *data, size_t length)
{
    static const char special[] = "\n\t\r\"\\", letters[] = "ntr\"\\";
    csg_text_put(text, "\"", 1);
    for (size_t i = 0; i < length; i++) {
        const char *found = data[i] ? strchr(special, data[i]) : NULL;
        if (found)
            csg_text_put(text, "\\", 1);
        csg_text_put(text, found ? &letters[found - special] : &data[i], 1);
    }
    csg_text_put(text, "\"", 1);
}

static void put_operator(csg_text *text, const csg_expression *e, const csg_symbols *symbols)
{
    const char *quoted = csg_token_kind_name(e->operation); /* "'+'" */
    size_t length = strlen(quoted) - 2;
    if (e->kind == CSG_EXPRESSION_UNARY) {
        csg_text_put(text, quoted + 1, length);
        csg_text_put_expression(text, e->as.pair.left, symbols);
        return;
    }
    csg_text_put(text, "(", 1);
    csg_text_put_expression(text, e->as.pair.left, symbols);
    csg_text_put(text, " ", 1);
    csg_text_put(text, quoted + 1, length);
    csg_text_put(text, " ", 1);
    csg_text_put_expression(text, e->as.pair.right, symbols);
    csg_text_put(text, ")", 1);
}

static void put_branch(csg_text *text, const csg_expression *e, const csg_symbols *symbols)
{
    bool conditional = e->kind == CSG_EXPRESSION_CONDITIONAL;
    csg_text_put_string(text, conditional ? "(" : "if(");
    csg_text_put_expression(text, e->as.branch.condition, symbols);
    csg_text_put_string(text, conditional ? " ? " : ") (");
    csg_text_put_expression(text, e->as.branch.then, symbols);
    if (e->as.branch.other) {
        csg_text_put_string(text, conditional ? " : " : ") else (");
        csg_text_put_expression(text, e->as.branch.other, symbols);
    }
    csg_text_put(text, ")", 1);
}

static void put_list(csg_text *text, const csg_expression *e, const csg_symbols *symbols)
{
    csg_text_put(text, "[", 1);
    for (uint32_t i = 0; i < e->as.list.count && !text->failed; i++) {
        if (i)
            csg_text_put(text, ", ", 2);
        csg_text_put_expression(text, e->as.list.items[i], symbols);
    }
    csg_text_put(text, "]", 1);
}

static void put_range_expression(csg_text *text, const csg_expression *e,
                                 const csg_symbols *symbols)
{
    csg_text_put(text, "[", 1);
    csg_text_put_expression(text, e->as.range.begin, symbols);
    if (e->as.range.step) {
        csg_text_put(text, " : ", 3);
        csg_text_put_expression(text, e->as.range.step, symbols);
    }
    csg_text_put(text, " : ", 3);
    csg_text_put_expression(text, e->as.range.end, symbols);
    csg_text_put(text, "]", 1);
}

static void put_loop(csg_text *text, const csg_expression *e, const csg_symbols *symbols)
{
    csg_text_put_string(text, "for(");
    put_arguments(text, &e->as.loop.first, symbols);
    csg_text_put_string(text, ";");
    csg_text_put_expression(text, e->as.loop.condition, symbols);
    csg_text_put_string(text, ";");
    put_arguments(text, &e->as.loop.next, symbols);
    csg_text_put_string(text, ") ");
    csg_text_put_expression(text, e->as.loop.body, symbols);
}

void csg_text_put_expression(csg_text *text, const csg_expression *e, const csg_symbols *symbols)
{
    if (text->failed)
        return;
    switch ((csg_expression_kind)e->kind) {
    case CSG_EXPRESSION_UNARY:
    case CSG_EXPRESSION_BINARY:
        put_operator(text, e, symbols);
        break;
    case CSG_EXPRESSION_CONDITIONAL:
    case CSG_EXPRESSION_IF:
        put_branch(text, e, symbols);
        break;
    case CSG_EXPRESSION_INDEX:
        csg_text_put_expression(text, e->as.pair.left, symbols);
        csg_text_put(text, "[", 1);
        csg_text_put_expression(text, e->as.pair.right, symbols);
        csg_text_put(text, "]", 1);
        break;
    case CSG_EXPRESSION_MEMBER:
        csg_text_put_expression(text, e->as.member.object, symbols);
        csg_text_put(text, ".", 1);
        csg_text_put_string(text, csg_symbol_name(symbols, e->as.member.name));
        break;
    case CSG_EXPRESSION_CALL:
        if (e->as.call.callee->kind == CSG_EXPRESSION_NAME)
            csg_text_put_expression(text, e->as.call.callee, symbols);
        else
            put_enclosed(text, e->as.call.callee, symbols);
        put_call(text, "", e, symbols);
        break;
    case CSG_EXPRESSION_FUNCTION:
        put_call(text, "function", e, symbols);
        break;
    case CSG_EXPRESSION_LET:
        put_call(text, "let", e, symbols);
        break;
    case CSG_EXPRESSION_ASSERT:
        put_call(text, "assert", e, symbols);
        break;
    case CSG_EXPRESSION_ECHO:
        put_call(text, "echo", e, symbols);
        break;
    case CSG_EXPRESSION_FOR:
        put_for(text, e, symbols);
        break;
    case CSG_EXPRESSION_FOR_LOOP:
        put_loop(text, e, symbols);
        break;
    case CSG_EXPRESSION_EACH:
        csg_text_put_string(text, "each ");
        put_enclosed(text, e->as.inner, symbols);
        break;
    case CSG_EXPRESSION_VECTOR:
        put_list(text, e, symbols);
        break;
    case CSG_EXPRESSION_RANGE:
        put_range_expression(text, e, symbols);
        break;
    case CSG_EXPRESSION_NUMBER:
        csg_text_put_number(text, e->as.number);
        break;
    case CSG_EXPRESSION_BOOLEAN:
        csg_text_put_string(text, e->as.boolean ? "true" : "false");
        break;
    case CSG_EXPRESSION_STRING:
        put_string(text, e->as.string.text, e->as.string.length);
        break;
    case CSG_EXPRESSION_NAME:
        csg_text_put_string(text, csg_symbol_name(symbols, e->as.name));
        break;
    case CSG_EXPRESSION_UNDEF:
        csg_text_put_string(text, "undef");
        break;
    }
}
