/* SPDX-License-Identifier: MIT
 * Unary and binary operators on values, as OpenSCAD defines them: element by element on vectors,
 * * is the dot, matrix-vector and matrix-matrix product, undef where an operation has no meaning
 * (with a warning, unless an operand is undef: then something else went wrong before).
 */
#include <math.h>
#include <string.h>

#include "base/elementary.h"
#include "base/scene_codes.h"
#include "lang/evaluate/symbolic.h"
#include "scene/formula/formula.h"
#include "text/lexer.h"

csg_value csg_eval_no_operation(csg_eval *e, const csg_expression *x, csg_value left,
                                csg_value right)
{
    const char *sign = csg_token_kind_name(x->operation);
    if (left.kind != CSG_VALUE_UNDEF && right.kind != CSG_VALUE_UNDEF)
        csg_eval_report(e, CSG_DIAG_BAD_OPERANDS, x->where, NULL,
                        "there is no %.*s of %s and %s, it counts as undef", (int)strlen(sign),
                        sign, csg_value_kind_name(left), csg_value_kind_name(right));
    return csg_value_undef();
}

static csg_value scalars(csg_eval *e, const csg_expression *x, csg_value a, csg_value b)
{
    if (a.kind == CSG_VALUE_TERM || b.kind == CSG_VALUE_TERM)
        return csg_symbolic_operator(e, x, a, b);
    switch (x->operation) {
    case CSG_TOKEN_PLUS:
        return csg_value_number(a.as.number + b.as.number);
    case CSG_TOKEN_MINUS:
        return csg_value_number(a.as.number - b.as.number);
    case CSG_TOKEN_STAR:
        return csg_value_number(a.as.number * b.as.number);
    case CSG_TOKEN_SLASH:
        return csg_value_number(a.as.number / b.as.number);
    case CSG_TOKEN_PERCENT:
        return csg_value_number(fmod(a.as.number, b.as.number));
    default:
        return csg_value_number(csg_pow(a.as.number, b.as.number));
    }
}

static csg_vector *make_vector(csg_eval *e, const csg_expression *x, size_t count)
{
    if (!csg_eval_charge(e, count / 8 + 1, x->where))
        return NULL;
    csg_vector *made = csg_vector_create(&e->heap, count);
    if (!made)
        csg_eval_no_memory(e);
    return made;
}

/* ---- element by element -----------------------------------------------------------------------
 */

/* Recursion goes as deep as vectors nest: csg_vector.depth bounds it. */
static csg_value add_values(csg_eval *e, const csg_expression *x, csg_value left, csg_value right)
{
    if (csg_value_is_scalar(left) && csg_value_is_scalar(right))
        return scalars(e, x, left, right);
    if (left.kind != CSG_VALUE_VECTOR || right.kind != CSG_VALUE_VECTOR)
        return csg_eval_no_operation(e, x, left, right);
    const csg_vector *a = left.as.vector, *b = right.as.vector;
    size_t count = a->count < b->count ? a->count : b->count;
    csg_vector *made = make_vector(e, x, count);
    for (size_t i = 0; made && i < count && !e->stop; i++)
        csg_vector_set(made, i, add_values(e, x, a->items[i], b->items[i]));
    return made ? csg_value_object(made, CSG_VALUE_VECTOR) : csg_value_undef();
}

/* vector * number, number * vector, vector / number, number / vector. */
static csg_value scale(csg_eval *e, const csg_expression *x, csg_value value, csg_value by,
                       bool number_first)
{
    if (csg_value_is_scalar(value))
        return number_first ? scalars(e, x, by, value) : scalars(e, x, value, by);
    if (value.kind != CSG_VALUE_VECTOR)
        return number_first ? csg_eval_no_operation(e, x, by, value)
                            : csg_eval_no_operation(e, x, value, by);
    const csg_vector *vector = value.as.vector;
    csg_vector *made = make_vector(e, x, vector->count);
    for (size_t i = 0; made && i < vector->count && !e->stop; i++)
        csg_vector_set(made, i, scale(e, x, vector->items[i], by, number_first));
    return made ? csg_value_object(made, CSG_VALUE_VECTOR) : csg_value_undef();
}

/* ---- products
 * ------------------------------------------------------------------------------------ */

static bool all_numbers(const csg_vector *vector)
{
    for (uint32_t i = 0; i < vector->count; i++)
        if (!csg_value_is_scalar(vector->items[i]))
            return false;
    return true;
}

static bool any_terms(const csg_vector *vector)
{
    for (uint32_t i = 0; i < vector->count; i++)
        if (vector->items[i].kind == CSG_VALUE_TERM)
            return true;
    return false;
}

/* Rows of numbers, all of one length. */
static bool is_matrix(csg_value value, uint32_t *columns)
{
    if (value.kind != CSG_VALUE_VECTOR || value.as.vector->count == 0)
        return false;
    const csg_vector *rows = value.as.vector;
    for (uint32_t i = 0; i < rows->count; i++) {
        if (rows->items[i].kind != CSG_VALUE_VECTOR || !all_numbers(rows->items[i].as.vector))
            return false;
        if (i == 0)
            *columns = rows->items[i].as.vector->count;
        else if (rows->items[i].as.vector->count != *columns)
            return false;
    }
    return true;
}

static csg_value dot(csg_eval *e, const csg_expression *x, const csg_vector *a, const csg_vector *b)
{
    double sum = 0;
    if (e->formula && (any_terms(a) || any_terms(b)))
        return csg_symbolic_dot(e, a->items, b->items, a->count, x->where);
    for (uint32_t i = 0; i < a->count; i++)
        sum += a->items[i].as.number * b->items[i].as.number;
    return csg_value_number(sum);
}

static csg_value matrix_vector(csg_eval *e, const csg_expression *x, const csg_vector *matrix,
                               const csg_vector *vector)
{
    csg_vector *made = make_vector(e, x, matrix->count);
    if (!made || !csg_eval_charge(e, (uint64_t)matrix->count * vector->count / 8, x->where))
        return csg_value_undef();
    for (uint32_t i = 0; i < matrix->count; i++)
        made->items[i] = dot(e, x, matrix->items[i].as.vector, vector);
    return csg_value_object(made, CSG_VALUE_VECTOR);
}

/* One element of the next, where there may be terms. */
static csg_value column_sum(csg_eval *e, const csg_expression *x, const csg_vector *vector,
                            const csg_vector *matrix, uint32_t column)
{
    csg_value sum = csg_value_number(0);
    for (uint32_t i = 0; i < vector->count && !e->stop; i++) {
        const csg_value *element = &matrix->items[i].as.vector->items[column];
        csg_value one = csg_symbolic_dot(e, &vector->items[i], element, 1, x->where);
        if (!e->stop)
            sum = csg_symbolic_apply(e, CSG_FORMULA_ADD, sum, one, x->where);
    }
    return sum;
}

/* Row vector times matrix: the sum of the rows, weighted. */
static csg_value vector_matrix(csg_eval *e, const csg_expression *x, const csg_vector *vector,
                               const csg_vector *matrix, uint32_t columns)
{
    csg_vector *made = make_vector(e, x, columns);
    if (!made || !csg_eval_charge(e, (uint64_t)vector->count * columns / 8, x->where))
        return csg_value_undef();
    for (uint32_t j = 0; j < columns && !e->stop; j++) {
        if (e->formula) {
            made->items[j] = column_sum(e, x, vector, matrix, j);
            continue;
        }
        double sum = 0;
        for (uint32_t i = 0; i < vector->count; i++)
            sum += vector->items[i].as.number * matrix->items[i].as.vector->items[j].as.number;
        made->items[j] = csg_value_number(sum);
    }
    return csg_value_object(made, CSG_VALUE_VECTOR);
}

static csg_value matrix_matrix(csg_eval *e, const csg_expression *x, const csg_vector *left,
                               const csg_vector *right, uint32_t columns)
{
    csg_vector *made = make_vector(e, x, left->count);
    for (uint32_t i = 0; made && i < left->count && !e->stop; i++)
        csg_vector_set(made, i, vector_matrix(e, x, left->items[i].as.vector, right, columns));
    return made ? csg_value_object(made, CSG_VALUE_VECTOR) : csg_value_undef();
}

static csg_value product(csg_eval *e, const csg_expression *x, csg_value left, csg_value right)
{
    uint32_t left_columns = 0, right_columns = 0;
    const csg_vector *a = left.as.vector, *b = right.as.vector;
    bool left_matrix = is_matrix(left, &left_columns),
         right_matrix = is_matrix(right, &right_columns);
    if (a->count == 0 || b->count == 0)
        return csg_eval_no_operation(e, x, left, right);
    if (!left_matrix && !right_matrix && all_numbers(a) && all_numbers(b) && a->count == b->count)
        return dot(e, x, a, b);
    if (left_matrix && !right_matrix && all_numbers(b) && left_columns == b->count)
        return matrix_vector(e, x, a, b);
    if (!left_matrix && right_matrix && all_numbers(a) && a->count == b->count)
        return vector_matrix(e, x, a, b, right_columns);
    if (left_matrix && right_matrix && left_columns == b->count)
        return matrix_matrix(e, x, a, b, right_columns);
    return csg_eval_no_operation(e, x, left, right);
}

static csg_value multiply(csg_eval *e, const csg_expression *x, csg_value left, csg_value right)
{
    if (csg_value_is_scalar(left) && (csg_value_is_scalar(right) || right.kind == CSG_VALUE_VECTOR))
        return scale(e, x, right, left, true);
    if (left.kind == CSG_VALUE_VECTOR && csg_value_is_scalar(right))
        return scale(e, x, left, right, false);
    if (left.kind == CSG_VALUE_VECTOR && right.kind == CSG_VALUE_VECTOR &&
        x->operation == CSG_TOKEN_STAR)
        return product(e, x, left, right);
    return csg_eval_no_operation(e, x, left, right);
}

/* ---- bits ------------------------------------------------------------------------------------- */

/* The whole number that a value is, cut towards 0. */
static bool to_whole(csg_value value, int64_t *out)
{
    const double most = 9223372036854775808.0; /* 2^63 */
    if (value.kind != CSG_VALUE_NUMBER || !(fabs(value.as.number) < most))
        return false;
    *out = (int64_t)value.as.number;
    return true;
}

static csg_value no_bits(csg_eval *e, const csg_expression *x, const char *problem)
{
    const char *sign = csg_token_kind_name(x->operation);
    csg_eval_report(e, CSG_DIAG_BAD_OPERANDS, x->where,
                    x->operation == CSG_TOKEN_BIT_AND   ? "logical and is '&&'"
                    : x->operation == CSG_TOKEN_BIT_OR  ? "logical or is '||'"
                    : x->operation == CSG_TOKEN_BIT_NOT ? "logical not is '!'"
                                                        : NULL,
                    "%.*s needs %s, it counts as undef", (int)strlen(sign), sign, problem);
    return csg_value_undef();
}

/* Of 64-bit integers in two's complement, as in OpenSCAD. */
static csg_value combine_bits(csg_eval *e, const csg_expression *x, csg_value left, csg_value right)
{
    int64_t a, b;
    if (left.kind == CSG_VALUE_UNDEF || right.kind == CSG_VALUE_UNDEF)
        return csg_value_undef();
    if (csg_symbolic_refuse(e, left, x->where, "an operation on bits") ||
        csg_symbolic_refuse(e, right, x->where, "an operation on bits"))
        return csg_value_undef();
    if (!to_whole(left, &a) || !to_whole(right, &b))
        return no_bits(e, x, "two numbers between -2^63 and 2^63");
    if (x->operation == CSG_TOKEN_BIT_AND)
        return csg_value_number((double)(a & b));
    if (x->operation == CSG_TOKEN_BIT_OR)
        return csg_value_number((double)(a | b));
    if (b < 0 || b > 63)
        return no_bits(e, x, "a number of places from 0 to 63");
    if (x->operation == CSG_TOKEN_SHIFT_LEFT)
        return csg_value_number((double)(int64_t)((uint64_t)a << b));
    return csg_value_number((double)(a >= 0 ? a >> b : ~(~a >> b)));
}

static csg_value invert_bits(csg_eval *e, const csg_expression *x, csg_value operand)
{
    int64_t a;
    if (operand.kind == CSG_VALUE_UNDEF ||
        csg_symbolic_refuse(e, operand, x->where, "an operation on bits"))
        return csg_value_undef();
    return to_whole(operand, &a) ? csg_value_number((double)~a)
                                 : no_bits(e, x, "a number between -2^63 and 2^63");
}

/* ---- entry
 * ---------------------------------------------------------------------------------------------- */

static bool is_refused(csg_eval *e, const csg_expression *x, csg_value left, csg_value right)
{
    return csg_symbolic_refuse(e, left, x->where, "a comparison") ||
           csg_symbolic_refuse(e, right, x->where, "a comparison");
}

csg_value csg_eval_binary(csg_eval *e, const csg_expression *x, csg_value left, csg_value right)
{
    bool both = csg_value_is_scalar(left) && csg_value_is_scalar(right);
    if (e->stop)
        return csg_value_undef();
    switch (x->operation) {
    case CSG_TOKEN_EQUAL:
    case CSG_TOKEN_NOT_EQUAL:
        if (is_refused(e, x, left, right))
            return csg_value_undef();
        return csg_value_boolean(csg_value_equal(e, left, right, x->where) ==
                                 (x->operation == CSG_TOKEN_EQUAL));
    case CSG_TOKEN_LESS:
    case CSG_TOKEN_LESS_EQUAL:
    case CSG_TOKEN_GREATER:
    case CSG_TOKEN_GREATER_EQUAL:
        if (is_refused(e, x, left, right))
            return csg_value_undef();
        return csg_eval_compare(e, x, left, right);
    case CSG_TOKEN_PLUS:
    case CSG_TOKEN_MINUS:
        return add_values(e, x, left, right);
    case CSG_TOKEN_BIT_AND:
    case CSG_TOKEN_BIT_OR:
    case CSG_TOKEN_SHIFT_LEFT:
    case CSG_TOKEN_SHIFT_RIGHT:
        return combine_bits(e, x, left, right);
    case CSG_TOKEN_STAR:
    case CSG_TOKEN_SLASH:
        return both ? scalars(e, x, left, right) : multiply(e, x, left, right);
    default:
        return both ? scalars(e, x, left, right) : csg_eval_no_operation(e, x, left, right);
    }
}

static csg_value negate(csg_eval *e, const csg_expression *x, csg_value operand)
{
    if (operand.kind == CSG_VALUE_NUMBER)
        return csg_value_number(-operand.as.number);
    if (operand.kind == CSG_VALUE_TERM)
        return csg_symbolic_apply(e, CSG_FORMULA_NEG, operand, operand, x->where);
    if (operand.kind == CSG_VALUE_VECTOR) {
        const csg_vector *vector = operand.as.vector;
        csg_vector *made = make_vector(e, x, vector->count);
        for (size_t i = 0; made && i < vector->count && !e->stop; i++)
            csg_vector_set(made, i, negate(e, x, vector->items[i]));
        return made ? csg_value_object(made, CSG_VALUE_VECTOR) : csg_value_undef();
    }
    if (operand.kind != CSG_VALUE_UNDEF)
        csg_eval_report(e, CSG_DIAG_BAD_OPERANDS, x->where, NULL,
                        "there is no negative of a %s, it counts as undef",
                        csg_value_kind_name(operand));
    return csg_value_undef();
}

csg_value csg_eval_unary(csg_eval *e, const csg_expression *x, csg_value operand)
{
    csg_symbolic_refuse(e, x->operation == CSG_TOKEN_NOT ? operand : csg_value_undef(), x->where,
                        "a condition");
    if (x->operation == CSG_TOKEN_NOT)
        return csg_value_boolean(!csg_value_is_true(operand));
    if (x->operation == CSG_TOKEN_BIT_NOT)
        return invert_bits(e, x, operand);
    if (x->operation == CSG_TOKEN_MINUS)
        return negate(e, x, operand);
    return csg_value_retain(operand);
}
