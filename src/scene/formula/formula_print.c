/* SPDX-License-Identifier: MIT
 * Steps as nested expressions, every operator in parentheses; what is used twice, or nests deep,
 * becomes a variable of a let, so that the text stays as short as the formula.
 */
#include "scene/formula/formula_print.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene/formula/formula.h"

enum { DEEPEST_NESTING = 12 };

typedef struct printer {
    const csg_formula_step *steps;
    uint8_t *named; /* per step */
    const csg_formula_words *words;
    csgm_text_fn *sink;
    void *user;
} printer;

void csg_print_number(csgm_text_fn *sink, void *user, double value)
{
    char text[40];
    for (int digits = 15; digits <= 17; digits++) {
        snprintf(text, sizeof text, "%.*g", digits, value);
        if (strtod(text, NULL) == value)
            break;
    }
    sink(user, text, strlen(text));
}

static void put_text(printer *out, const char *text)
{
    out->sink(out->user, text, strlen(text));
}

static void put_name(printer *out, uint32_t step)
{
    char text[16];
    snprintf(text, sizeof text, "v%u", step);
    put_text(out, text);
}

static const char *sign_of(csg_formula_op op)
{
    switch (op) {
    case CSG_FORMULA_ADD:
        return " + ";
    case CSG_FORMULA_SUB:
        return " - ";
    case CSG_FORMULA_MUL:
        return " * ";
    case CSG_FORMULA_DIV:
        return " / ";
    case CSG_FORMULA_MOD:
        return " % ";
    default:
        return NULL;
    }
}

static void put_operation(printer *out, uint32_t index);

static void put_variable(printer *out, uint32_t number)
{
    char text[32];
    if (out->words->list)
        snprintf(text, sizeof text, "%s[%u]", out->words->list, number);
    put_text(out, out->words->list ? text : out->words->coordinates[number]);
}

static void put_operand(printer *out, uint32_t index)
{
    const csg_formula_step *step = &out->steps[index];
    if (step->op == CSG_FORMULA_CONSTANT) {
        csg_print_number(out->sink, out->user, step->constant);
    } else if (step->op <= CSG_FORMULA_Z) {
        put_variable(out, csg_formula_variable_of(step));
    } else if (out->named[index]) {
        put_name(out, index);
    } else {
        put_operation(out, index);
    }
}

/* Recursion: at most DEEPEST_NESTING, deeper steps have names. */
static void put_operation(printer *out, uint32_t index)
{
    const csg_formula_step *step = &out->steps[index];
    const char *sign = sign_of(step->op);
    if (step->op == CSG_FORMULA_NEG) {
        put_text(out, "(-");
    } else {
        put_text(out, sign ? "" : csg_formula_op_name(step->op));
        put_text(out, "(");
    }
    put_operand(out, step->a);
    if (csg_formula_op_arity(step->op) > 1) {
        put_text(out, sign ? sign : ", ");
        put_operand(out, step->b);
    }
    put_text(out, ")");
}

/* named[] of each step; `uses` and `depth` are work of one uint32_t per step. */
static void choose_names(printer *out, uint32_t count, uint32_t *uses, uint32_t *depth)
{
    memset(uses, 0, count * sizeof *uses);
    for (uint32_t i = 0; i < count; i++) {
        const csg_formula_step *step = &out->steps[i];
        uint32_t arity = csg_formula_op_arity(step->op);
        if (arity > 0)
            uses[step->a]++;
        if (arity > 1)
            uses[step->b]++;
    }
    for (uint32_t i = 0; i < count; i++) {
        const csg_formula_step *step = &out->steps[i];
        uint32_t arity = csg_formula_op_arity(step->op);
        uint32_t a = arity > 0 ? depth[step->a] : 0, b = arity > 1 ? depth[step->b] : 0;
        depth[i] = arity ? 1 + (a > b ? a : b) : 0;
        out->named[i] = arity && (uses[i] > 1 || depth[i] == DEEPEST_NESTING) && i + 1 < count;
        if (out->named[i])
            depth[i] = 0;
    }
}

bool csg_formula_print(csg_memory *memory, const csg_formula_step *steps, uint32_t count,
                       const csg_formula_words *words, csgm_text_fn *sink, void *user)
{
    size_t bytes = count * (2 * sizeof(uint32_t) + 1);
    uint32_t *work = csg_memory_alloc(memory, bytes);
    if (!work)
        return false;
    printer out = {steps, (uint8_t *)(work + 2 * count), words, sink, user};
    choose_names(&out, count, work, work + count);
    put_text(&out, "function (");
    put_text(&out, words->parameters);
    put_text(&out, ") ");
    bool any = false;
    for (uint32_t i = 0; i < count; i++) {
        if (!out.named[i])
            continue;
        put_text(&out, any ? ", " : "let (");
        any = true;
        put_name(&out, i);
        put_text(&out, " = ");
        put_operation(&out, i);
    }
    put_text(&out, any ? ") " : "");
    put_operand(&out, count - 1);
    csg_memory_release(memory, work, bytes);
    return true;
}
