/* SPDX-License-Identifier: MIT
 * Equality and order of values, as OpenSCAD 2021.01 has them: values of different kinds are never
 * equal and have no order; vectors are ordered by their first difference, ranges by begin, step and
 * number of elements. Recursion goes as deep as vectors nest: csg_vector.depth bounds it.
 */
#include <string.h>

#include "lang/evaluate/rule_value.h"
#include "lang/evaluate/symbolic.h"
#include "text/lexer.h"

static bool equal_vectors(csg_eval *e, const csg_vector *a, const csg_vector *b, csg_span where)
{
    if (a->count != b->count)
        return false;
    for (uint32_t i = 0; i < a->count; i++)
        if (!csg_value_equal(e, a->items[i], b->items[i], where))
            return false;
    return true;
}

/* With the same elements; all ranges without elements are equal. */
static bool equal_ranges(const csg_range *a, const csg_range *b)
{
    double count = csg_range_count(a);
    return count == csg_range_count(b) &&
           (count == 0 || (a->begin == b->begin && a->step == b->step));
}

bool csg_value_equal(csg_eval *e, csg_value left, csg_value right, csg_span where)
{
    if (left.kind != right.kind || !csg_eval_charge(e, 1, where))
        return false;
    switch ((csg_value_kind)left.kind) {
    case CSG_VALUE_NUMBER:
        return left.as.number == right.as.number;
    case CSG_VALUE_BOOLEAN:
        return left.as.boolean == right.as.boolean;
    case CSG_VALUE_RULE:
        return left.as.rule->function == right.as.rule->function &&
               left.as.rule->rule.range == right.as.rule->rule.range &&
               csg_rule_is_same(&left.as.rule->rule, &right.as.rule->rule);
    case CSG_VALUE_STEP:
    case CSG_VALUE_BLEND:
        return left.blend == right.blend && left.as.number == right.as.number;
    case CSG_VALUE_STRING:
        return left.as.string->length == right.as.string->length &&
               memcmp(left.as.string->text, right.as.string->text, left.as.string->length) == 0;
    case CSG_VALUE_VECTOR:
    case CSG_VALUE_RECORD:
        return equal_vectors(e, left.as.vector, right.as.vector, where);
    case CSG_VALUE_RANGE:
        return equal_ranges(left.as.range, right.as.range);
    case CSG_VALUE_FUNCTION:
        return left.as.function == right.as.function;
    case CSG_VALUE_UNDEF:
    case CSG_VALUE_TERM:
    case CSG_VALUE_UNSET:
    case CSG_VALUE_FRAME:
        break;
    }
    return true;
}

/* ---- order ------------------------------------------------------------------------------------
 */

typedef enum order {
    LESS = -1,
    SAME,
    GREATER,
    UNORDERED, /* nan among numbers: every comparison is false */
    INCOMPARABLE
} order;

static order order_of(csg_eval *e, csg_value left, csg_value right, csg_span where);

static order order_numbers(double a, double b)
{
    return a < b ? LESS : a > b ? GREATER : a == b ? SAME : UNORDERED;
}

static order order_vectors(csg_eval *e, const csg_vector *a, const csg_vector *b, csg_span where)
{
    uint32_t common = a->count < b->count ? a->count : b->count;
    for (uint32_t i = 0; i < common; i++) {
        order first = order_of(e, a->items[i], b->items[i], where);
        if (first != SAME && first != UNORDERED)
            return first;
    }
    return order_numbers(a->count, b->count);
}

static order order_ranges(const csg_range *a, const csg_range *b)
{
    double a_count = csg_range_count(a), b_count = csg_range_count(b);
    if (a_count == 0 || b_count == 0)
        return order_numbers(a_count > 0, b_count > 0);
    order first = order_numbers(a->begin, b->begin);
    if (first == SAME)
        first = order_numbers(a->step, b->step);
    return first == SAME ? order_numbers(a_count, b_count) : first;
}

static order order_of(csg_eval *e, csg_value left, csg_value right, csg_span where)
{
    if (left.kind != right.kind || !csg_eval_charge(e, 1, where))
        return INCOMPARABLE;
    switch ((csg_value_kind)left.kind) {
    case CSG_VALUE_NUMBER:
        return order_numbers(left.as.number, right.as.number);
    case CSG_VALUE_BOOLEAN:
        return order_numbers(left.as.boolean, right.as.boolean);
    case CSG_VALUE_STRING:
        return order_numbers((double)strcmp(left.as.string->text, right.as.string->text), 0);
    case CSG_VALUE_VECTOR:
        return order_vectors(e, left.as.vector, right.as.vector, where);
    case CSG_VALUE_RANGE:
        return order_ranges(left.as.range, right.as.range);
    case CSG_VALUE_UNDEF:
    case CSG_VALUE_RECORD:
    case CSG_VALUE_BLEND:
    case CSG_VALUE_TERM:
    case CSG_VALUE_STEP:
    case CSG_VALUE_UNSET:
    case CSG_VALUE_FUNCTION:
    case CSG_VALUE_RULE:
    case CSG_VALUE_FRAME:
        break;
    }
    return INCOMPARABLE;
}

bool csg_value_is_less(csg_eval *e, csg_value left, csg_value right, csg_span where)
{
    return order_of(e, left, right, where) == LESS;
}

csg_value csg_eval_compare(csg_eval *e, const csg_expression *x, csg_value left, csg_value right)
{
    order found = order_of(e, left, right, x->where);
    if (found == INCOMPARABLE)
        return csg_eval_no_operation(e, x, left, right);
    switch (x->operation) {
    case CSG_TOKEN_LESS:
        return csg_value_boolean(found == LESS);
    case CSG_TOKEN_LESS_EQUAL:
        return csg_value_boolean(found == LESS || found == SAME);
    case CSG_TOKEN_GREATER:
        return csg_value_boolean(found == GREATER);
    default:
        return csg_value_boolean(found == GREATER || found == SAME);
    }
}
