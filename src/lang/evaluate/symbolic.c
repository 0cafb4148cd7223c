/* SPDX-License-Identifier: MIT
 * Operators and built-in functions on terms; see symbolic.h.
 */
#include "lang/evaluate/symbolic.h"

#include <math.h>
#include <string.h>

#include "base/mesh_codes.h"
#include "base/scene_codes.h"
#include "scene/formula/formula.h"
#include "text/lexer.h"

static const char hint[] =
    "a formula is made of + - * / % ^, abs min max floor sqrt pow exp ln sin "
    "cos tan asin acos atan atan2 norm dot cross";

static csg_value term_value(csg_eval *e, csg_formula_id id, csg_span where)
{
    if (id == CSG_FORMULA_NONE) {
        if (e->formula->too_long)
            csg_eval_limit(e, CSG_DIAG_FORMULA_TOO_LONG, where, NULL,
                           "a formula can have %d operations, this one has more",
                           CSG_LONGEST_FORMULA);
        else
            csg_eval_no_memory(e);
        return csg_value_undef();
    }
    const csg_formula_step *step = &e->formula->steps[id];
    if (step->op == CSG_FORMULA_CONSTANT)
        return csg_value_number(step->constant);
    return (csg_value){.kind = CSG_VALUE_TERM, .as.term = id};
}

static csg_formula_id id_of(csg_eval *e, csg_value scalar)
{
    return scalar.kind == CSG_VALUE_TERM ? scalar.as.term
                                         : csg_formula_constant(e->formula, scalar.as.number);
}

csg_value csg_symbolic_apply(csg_eval *e, csg_formula_op op, csg_value a, csg_value b,
                             csg_span where)
{
    if (e->stop || !csg_eval_charge(e, 1, where))
        return csg_value_undef();
    csg_formula_id left = id_of(e, a), right = 0;
    if (csg_formula_op_arity(op) > 1)
        right = id_of(e, b);
    bool made = left != CSG_FORMULA_NONE && right != CSG_FORMULA_NONE;
    return term_value(e, made ? csg_formula_apply(e->formula, op, left, right) : CSG_FORMULA_NONE,
                      where);
}

csg_value csg_symbolic_dot(csg_eval *e, const csg_value *a, const csg_value *b, uint32_t count,
                           csg_span where)
{
    csg_value sum = csg_value_number(0);
    for (uint32_t i = 0; i < count && !e->stop; i++) {
        csg_value product = csg_symbolic_apply(e, CSG_FORMULA_MUL, a[i], b[i], where);
        if (!e->stop)
            sum = csg_symbolic_apply(e, CSG_FORMULA_ADD, sum, product, where);
    }
    return sum;
}

csg_value csg_symbolic_operator(csg_eval *e, const csg_expression *x, csg_value a, csg_value b)
{
    static const struct {
        csg_token_kind token;
        csg_formula_op op;
    } table[] = {{CSG_TOKEN_PLUS, CSG_FORMULA_ADD},    {CSG_TOKEN_MINUS, CSG_FORMULA_SUB},
                 {CSG_TOKEN_STAR, CSG_FORMULA_MUL},    {CSG_TOKEN_SLASH, CSG_FORMULA_DIV},
                 {CSG_TOKEN_PERCENT, CSG_FORMULA_MOD}, {CSG_TOKEN_CARET, CSG_FORMULA_POW}};
    size_t i = 0;
    while (table[i].token != (csg_token_kind)x->operation)
        i++;
    return csg_symbolic_apply(e, table[i].op, a, b, x->where);
}

bool csg_symbolic_refuse(csg_eval *e, csg_value value, csg_span where, const char *what)
{
    if (value.kind != CSG_VALUE_TERM)
        return false;
    e->refused = true;
    csg_eval_report(e, CSG_DIAG_NOT_A_FORMULA, where, hint,
                    "%s cannot depend on the point in the function of field()", what);
    return true;
}

/* ---- built-in functions ------------------------------------------------------------------------
 */

/* Vectors nest as deep as csg_vector.depth says, which is bounded. */
static bool has_terms(csg_value value)
{
    if (value.kind != CSG_VALUE_VECTOR)
        return value.kind == CSG_VALUE_TERM;
    for (uint32_t i = 0; i < value.as.vector->count; i++)
        if (has_terms(value.as.vector->items[i]))
            return true;
    return false;
}

static bool are_scalars(const csg_value *values, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        if (!csg_value_is_scalar(values[i]))
            return false;
    return true;
}

/* The elements of a vector of scalars; NULL: it is none. */
static const csg_value *scalars_of(csg_value value, uint32_t *count)
{
    if (value.kind != CSG_VALUE_VECTOR)
        return NULL;
    *count = value.as.vector->count;
    return are_scalars(value.as.vector->items, *count) ? value.as.vector->items : NULL;
}

static csg_value extreme(const csg_function_call *call, csg_formula_op op)
{
    const csg_value *values = call->arguments;
    uint32_t count = call->count;
    if (count == 1 && values[0].kind == CSG_VALUE_VECTOR)
        values = scalars_of(values[0], &count);
    if (!values || !count || !are_scalars(values, count))
        return csg_bad_argument(call, 0, "numbers");
    csg_value best = values[0];
    for (uint32_t i = 1; i < count && !call->e->stop; i++)
        best = csg_symbolic_apply(call->e, op, best, values[i], call->where);
    return best;
}

static csg_value cross(const csg_function_call *call)
{
    csg_eval *e = call->e;
    uint32_t m = 0, n = 0;
    const csg_value *a = scalars_of(call->arguments[0], &m);
    const csg_value *b = scalars_of(call->arguments[1], &n);
    if (!a || !b || m != n || (m != 2 && m != 3))
        return csg_bad_argument(call, 0, "two vectors of 3 (or 2) numbers");
    csg_vector *made = csg_vector_create(&e->heap, 3);
    if (!made) {
        csg_eval_no_memory(e);
        return csg_value_undef();
    }
    csg_value last = csg_value_undef();
    for (uint32_t i = m == 2 ? 2 : 0; i < 3 && !e->stop; i++) {
        uint32_t j = (i + 1) % 3, k = (i + 2) % 3;
        csg_value one = csg_symbolic_apply(e, CSG_FORMULA_MUL, a[j], b[k], call->where);
        csg_value other = csg_symbolic_apply(e, CSG_FORMULA_MUL, a[k], b[j], call->where);
        if (!e->stop)
            made->items[i] = last = csg_symbolic_apply(e, CSG_FORMULA_SUB, one, other, call->where);
    }
    csg_value all = csg_value_object(made, CSG_VALUE_VECTOR);
    if (m == 3)
        return all;
    csg_value_release(&e->heap, all);
    return last;
}

static csg_value product_sum(const csg_function_call *call, csg_value left, csg_value right)
{
    uint32_t m = 0, n = 0;
    const csg_value *a = scalars_of(left, &m), *b = scalars_of(right, &n);
    if (!a || !b || m != n)
        return csg_bad_argument(call, 0, "lists of equally many numbers");
    return csg_symbolic_dot(call->e, a, b, m, call->where);
}

static csg_value norm(const csg_function_call *call)
{
    csg_value squares = product_sum(call, call->arguments[0], call->arguments[0]);
    return csg_value_is_scalar(squares)
               ? csg_symbolic_apply(call->e, CSG_FORMULA_SQRT, squares, squares, call->where)
               : squares;
}

/* What is another function of one operation: -floor(-x), floor(x + 1/2), ln(x) / ln(10). */
static csg_value composed(const csg_function_call *call, csg_value x)
{
    csg_eval *e = call->e;
    csg_span where = call->where;
    const csg_value half = csg_value_number(0.5), ten = csg_value_number(2.302585092994045684);
    if (call->name[0] == 'c') {
        x = csg_symbolic_apply(e, CSG_FORMULA_NEG, x, x, where);
        x = e->stop ? x : csg_symbolic_apply(e, CSG_FORMULA_FLOOR, x, x, where);
        return e->stop ? x : csg_symbolic_apply(e, CSG_FORMULA_NEG, x, x, where);
    }
    if (call->name[0] == 'r') {
        x = csg_symbolic_apply(e, CSG_FORMULA_ADD, x, half, where);
        return e->stop ? x : csg_symbolic_apply(e, CSG_FORMULA_FLOOR, x, x, where);
    }
    x = csg_symbolic_apply(e, CSG_FORMULA_LN, x, x, where);
    return e->stop ? x : csg_symbolic_apply(e, CSG_FORMULA_DIV, x, ten, where);
}

static bool is_named(const csg_function_call *call, const char *const *names)
{
    while (*names && strcmp(*names, call->name) != 0)
        names++;
    return *names != NULL;
}

/* The operation of that name that takes as many arguments, or none (COUNT). */
static csg_formula_op operation_of(const csg_function_call *call)
{
    csg_formula_op op = CSG_FORMULA_ABS;
    while (op < CSG_FORMULA_OP_COUNT && (strcmp(csg_formula_op_name(op), call->name) != 0 ||
                                         csg_formula_op_arity(op) != call->count))
        op++;
    bool sign = (op >= CSG_FORMULA_ADD && op <= CSG_FORMULA_DIV) || op == CSG_FORMULA_MOD;
    return sign ? CSG_FORMULA_OP_COUNT : op;
}

static void refuse_call(const csg_function_call *call)
{
    call->e->refused = true;
    csg_eval_report(call->e, CSG_DIAG_NOT_A_FORMULA, call->where, hint,
                    "%s() cannot take the point in the function of field()", call->name);
}

bool csg_symbolic_call(const csg_function_call *call, csg_value *result)
{
    static const char *const blind[] = {"len",         "concat",    "is_undef",
                                        "is_bool",     "is_string", "is_list",
                                        "is_function", "is_blend",  NULL};
    static const char *const compositions[] = {"ceil", "round", "log", NULL};
    bool any = false;
    if (is_named(call, blind))
        return false;
    for (uint32_t i = 0; i < call->count && !any; i++) {
        csg_value argument = call->arguments[i];
        uint32_t size = argument.kind == CSG_VALUE_VECTOR ? argument.as.vector->count : 0;
        any = csg_eval_charge(call->e, size / 8, call->where) && has_terms(argument);
    }
    if (!any)
        return false;
    const csg_value *values = call->arguments;
    bool scalars = are_scalars(values, call->count);
    csg_formula_op op = operation_of(call);
    if (strcmp(call->name, "is_num") == 0)
        *result = csg_value_boolean(values[0].kind == CSG_VALUE_TERM);
    else if (strcmp(call->name, "min") == 0 || strcmp(call->name, "max") == 0)
        *result = extreme(call, call->name[1] == 'i' ? CSG_FORMULA_MIN : CSG_FORMULA_MAX);
    else if (strcmp(call->name, "norm") == 0)
        *result = norm(call);
    else if (strcmp(call->name, "dot") == 0)
        *result = product_sum(call, values[0], values[1]);
    else if (strcmp(call->name, "cross") == 0)
        *result = cross(call);
    else if (is_named(call, compositions) && scalars)
        *result = composed(call, values[0]);
    else if (op < CSG_FORMULA_OP_COUNT && scalars)
        *result = csg_symbolic_apply(call->e, op, values[0], values[call->count - 1], call->where);
    else
        refuse_call(call);
    return true;
}
