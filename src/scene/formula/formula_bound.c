/* SPDX-License-Identifier: MIT
 * Formulas over a box: each step's value, the three components of its gradient and the gradient's
 * length as intervals, rounded outwards.
 *
 * Three rules know more than interval arithmetic: u * u is no product of strangers, the root of a
 * sum of squares is smooth enough at 0, and a minimum has the gradient of one of its operands.
 */
#include <float.h>
#include <string.h>

#include "base/elementary.h"

#include "scene/formula/formula_bound.h"

#define DEGREE 0.017453292519943295

enum { MOST_SQUARES = 8 /* under one root */ };

typedef csg_formula_range range;
typedef csg_formula_bound bound;

static range unknown(void)
{
    return (range){NAN, NAN};
}

static bool is_known(range a)
{
    return a.low <= a.high;
}

/* Room for the rounding of the operation (libm functions: a few units in the last place). */
static range widen(double low, double high)
{
    if (!(low <= high))
        return unknown();
    return (range){low - 4 * DBL_EPSILON * fabs(low) - DBL_MIN,
                   high + 4 * DBL_EPSILON * fabs(high) + DBL_MIN};
}

static bool holds(range a, double value)
{
    return a.low <= value && value <= a.high;
}

static bool is_zero(range a)
{
    return a.low == 0 && a.high == 0;
}

static double largest(range a)
{
    return is_known(a) ? fmax(fabs(a.low), fabs(a.high)) : INFINITY;
}

static range intersect(range a, range b)
{
    range both = {fmax(a.low, b.low), fmin(a.high, b.high)};
    return !is_known(a) ? b : is_known(both) ? both : b;
}

static range hull(range a, range b)
{
    if (!is_known(a) || !is_known(b))
        return unknown();
    return (range){fmin(a.low, b.low), fmax(a.high, b.high)};
}

static range negative(range a)
{
    return (range){-a.high, -a.low};
}

static range sum(range a, range b)
{
    if (is_zero(a) || is_zero(b))
        return is_zero(a) ? b : a;
    return widen(a.low + b.low, a.high + b.high);
}

/* Infinity times zero leaves nothing known. */
static range product(range a, range b)
{
    const double corners[4] = {a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high};
    double low = corners[0], high = corners[0];
    if (is_zero(a) || is_zero(b))
        return (range){0, 0};
    for (int i = 0; i < 4; i++) {
        if (isnan(corners[i]))
            return unknown();
        low = fmin(low, corners[i]);
        high = fmax(high, corners[i]);
    }
    return widen(low, high);
}

static range scaled(range a, double factor)
{
    return product(a, (range){factor, factor});
}

static range absolute(range a)
{
    if (!is_known(a))
        return a;
    return (range){holds(a, 0) ? 0 : fmin(fabs(a.low), fabs(a.high)), largest(a)};
}

static range square(range a)
{
    range b = absolute(a);
    range out = widen(b.low * b.low, b.high * b.high);
    out.low = out.low < 0 ? 0 : out.low;
    return out;
}

static range reciprocal(range a)
{
    if (!is_known(a) || holds(a, 0))
        return unknown();
    return widen(1 / a.high, 1 / a.low);
}

/* f(low), f(high) of a rising function on its domain. */
static range rising(csg_formula_op op, range a, double from, double to)
{
    if (!(a.low >= from && a.high <= to))
        return unknown();
    return widen(csg_formula_value(op, a.low, 0), csg_formula_value(op, a.high, 0));
}

static range square_root(range a)
{
    range out = rising(CSG_FORMULA_SQRT, a, 0, INFINITY);
    out.low = out.low < 0 ? 0 : out.low;
    return out;
}

/* Does a hold offset + k period for some whole k? */
static bool meets(range a, double offset, double period)
{
    double room = 8 * DBL_EPSILON * (largest(a) + period);
    return floor((a.high + room - offset) / period) >= ceil((a.low - room - offset) / period);
}

/* sin(a + shift): shift 90 gives the cosine. */
static range sine(range a, double shift)
{
    if (!is_known(a) || !isfinite(a.low) || !isfinite(a.high))
        return is_known(a) ? (range){-1, 1} : a;
    csg_formula_op op = shift == 0 ? CSG_FORMULA_SIN : CSG_FORMULA_COS;
    double one = csg_formula_value(op, a.low, 0), other = csg_formula_value(op, a.high, 0);
    double room = 4 * DBL_EPSILON * (1 + DEGREE * largest(a));
    double low = meets(a, -90 - shift, 360) ? -1 : fmin(one, other) - room;
    double high = meets(a, 90 - shift, 360) ? 1 : fmax(one, other) + room;
    return (range){low, high};
}

static range power(range a, range b)
{
    if (!(a.low >= 0) || !is_known(b))
        return unknown();
    const double corners[4] = {csg_pow(a.low, b.low), csg_pow(a.low, b.high),
                               csg_pow(a.high, b.low), csg_pow(a.high, b.high)};
    double low = corners[0], high = corners[0];
    for (int i = 1; i < 4; i++) {
        low = fmin(low, corners[i]);
        high = fmax(high, corners[i]);
    }
    if (holds(a, 1)) {
        low = fmin(low, 1);
        high = fmax(high, 1);
    }
    return widen(low, high);
}

/* Angles of the points of a box that does not meet the cut along -x, else all of them. */
static range angle(range y, range x)
{
    if (!is_known(x) || !is_known(y))
        return unknown();
    if (x.low <= 0 && holds(y, 0))
        return (range){-180, 180};
    const double xs[2] = {x.low, x.high}, ys[2] = {y.low, y.high};
    double low = INFINITY, high = -INFINITY;
    for (int i = 0; i < 4; i++) {
        double corner = csg_formula_value(CSG_FORMULA_ATAN2, ys[i & 1], xs[i >> 1]);
        low = fmin(low, corner);
        high = fmax(high, corner);
    }
    return widen(low, high);
}

/* The quotient's whole part where it is one for the whole range, else NaN. */
static double whole_quotient(range a, range b)
{
    if (!is_known(a) || !is_known(b) || b.low != b.high)
        return NAN;
    double one = trunc(a.low / b.low), other = trunc(a.high / b.low);
    return one == other ? one : NAN;
}

static range remainder_of(range a, range b)
{
    double whole = whole_quotient(a, b), most = largest(b);
    if (!isnan(whole))
        return sum(a, scaled(b, -whole));
    if (!is_known(a) || !is_known(b))
        return unknown();
    return (range){a.low < 0 ? -most : 0, a.high > 0 ? most : 0};
}

/* ---- steps -------------------------------------------------------------------------------------
 */

static range value_of(csg_formula_op op, range a, range b)
{
    switch (op) {
    case CSG_FORMULA_NEG:
        return negative(a);
    case CSG_FORMULA_ABS:
        return absolute(a);
    case CSG_FORMULA_SQRT:
        return square_root(a);
    case CSG_FORMULA_SIN:
        return sine(a, 0);
    case CSG_FORMULA_COS:
        return sine(a, 90);
    case CSG_FORMULA_TAN:
        return meets(a, 90, 180) ? unknown() : rising(op, a, -INFINITY, INFINITY);
    case CSG_FORMULA_ASIN:
        return rising(op, a, -1, 1);
    case CSG_FORMULA_ACOS:
        return sum((range){90, 90}, negative(rising(CSG_FORMULA_ASIN, a, -1, 1)));
    case CSG_FORMULA_ATAN:
    case CSG_FORMULA_EXP:
    case CSG_FORMULA_FLOOR:
        return rising(op, a, -INFINITY, INFINITY);
    case CSG_FORMULA_LN:
        return rising(op, a, 0, INFINITY);
    case CSG_FORMULA_ADD:
        return sum(a, b);
    case CSG_FORMULA_SUB:
        return sum(a, negative(b));
    case CSG_FORMULA_MUL:
        return product(a, b);
    case CSG_FORMULA_DIV:
        return product(a, reciprocal(b));
    case CSG_FORMULA_MIN:
        return is_known(hull(a, b)) ? (range){fmin(a.low, b.low), fmin(a.high, b.high)} : unknown();
    case CSG_FORMULA_MAX:
        return is_known(hull(a, b)) ? (range){fmax(a.low, b.low), fmax(a.high, b.high)} : unknown();
    case CSG_FORMULA_POW:
        return power(a, b);
    case CSG_FORMULA_ATAN2:
        return angle(a, b);
    case CSG_FORMULA_MOD:
        return remainder_of(a, b);
    case CSG_FORMULA_CONSTANT: /* these have no operands */
    case CSG_FORMULA_X:
    case CSG_FORMULA_Y:
    case CSG_FORMULA_Z:
    case CSG_FORMULA_OP_COUNT:
        break;
    }
    return unknown();
}

static range exactly(double value)
{
    return isnan(value) ? unknown() : (range){value, value};
}

/* Derivatives by the two operands over ranges of them. */
static void partials(csg_formula_op op, range a, range b, range v, range *da, range *db)
{
    const range one = {1, 1};
    range distance;
    *da = one, *db = (range){0, 0};
    switch (op) {
    case CSG_FORMULA_NEG:
        *da = negative(one);
        break;
    case CSG_FORMULA_ABS:
        *da = (range){a.low <= 0 ? -1 : 1, a.high >= 0 ? 1 : -1};
        break;
    case CSG_FORMULA_SQRT:
        *da = v.low > 0 ? scaled(reciprocal(v), 0.5) : unknown();
        break;
    case CSG_FORMULA_SIN:
        *da = scaled(sine(a, 90), DEGREE);
        break;
    case CSG_FORMULA_COS:
        *da = scaled(sine(a, 0), -DEGREE);
        break;
    case CSG_FORMULA_TAN:
        *da = scaled(sum(one, square(v)), DEGREE);
        break;
    case CSG_FORMULA_ASIN:
    case CSG_FORMULA_ACOS:
        distance = square_root(sum(one, negative(square(a))));
        *da = scaled(reciprocal(distance), (op == CSG_FORMULA_ASIN ? 1 : -1) / DEGREE);
        break;
    case CSG_FORMULA_ATAN:
        *da = scaled(reciprocal(sum(one, square(a))), 1 / DEGREE);
        break;
    case CSG_FORMULA_EXP:
        *da = v;
        break;
    case CSG_FORMULA_LN:
        *da = reciprocal(a);
        break;
    case CSG_FORMULA_FLOOR:
        *da = v.low <= a.low && v.high - v.low < 0.5 ? (range){0, 0} : unknown();
        break;
    case CSG_FORMULA_ADD:
        *db = one;
        break;
    case CSG_FORMULA_SUB:
        *db = negative(one);
        break;
    case CSG_FORMULA_MUL:
        *da = b;
        *db = a;
        break;
    case CSG_FORMULA_DIV:
        *da = reciprocal(b);
        *db = negative(product(v, *da));
        break;
    case CSG_FORMULA_POW:
        *da = product(b, power(a, sum(b, negative(one))));
        *db = a.low > 0 ? product(v, rising(CSG_FORMULA_LN, a, 0, INFINITY)) : unknown();
        break;
    case CSG_FORMULA_ATAN2:
        distance = scaled(sum(square(a), square(b)), DEGREE);
        *da = product(b, reciprocal(distance));
        *db = negative(product(a, reciprocal(distance)));
        if (b.low <= 0 && holds(a, 0)) /* the cut */
            *da = *db = unknown();
        break;
    case CSG_FORMULA_MOD:
        *db = exactly(-whole_quotient(a, b));
        *da = is_known(*db) ? one : unknown();
        break;
    case CSG_FORMULA_MIN: /* extreme() takes these */
    case CSG_FORMULA_MAX:
    case CSG_FORMULA_CONSTANT: /* these have no operands */
    case CSG_FORMULA_X:
    case CSG_FORMULA_Y:
    case CSG_FORMULA_Z:
    case CSG_FORMULA_OP_COUNT:
        *da = *db = unknown();
    }
}

static double length_of(const range gradient[3])
{
    double squares = 0;
    for (int i = 0; i < 3; i++)
        squares += largest(gradient[i]) * largest(gradient[i]);
    return sqrt(squares) * (1 + 4 * DBL_EPSILON);
}

/* An infinite factor of nothing is nothing. */
static double times(double a, double b)
{
    return a == 0 || b == 0 ? 0 : a * b;
}

static bound chain(csg_formula_op op, bound a, bound b, bool square_of_a)
{
    range da, db;
    bound out = {.value = square_of_a ? square(a.value) : value_of(op, a.value, b.value)};
    partials(op, a.value, b.value, out.value, &da, &db);
    if (square_of_a) {
        da = scaled(a.value, 2);
        db = (range){0, 0};
    }
    for (int i = 0; i < 3; i++)
        out.gradient[i] = sum(product(da, a.gradient[i]), product(db, b.gradient[i]));
    double length = times(largest(da), a.length) + times(largest(db), b.length);
    out.length = fmin(length * (1 + 4 * DBL_EPSILON), length_of(out.gradient));
    return out;
}

/* One of the operands, or a mixture of them where both are possible. */
static bound extreme(csg_formula_op op, bound a, bound b)
{
    bool minimum = op == CSG_FORMULA_MIN;
    if (minimum ? a.value.high < b.value.low : a.value.low > b.value.high)
        return a;
    if (minimum ? b.value.high < a.value.low : b.value.low > a.value.high)
        return b;
    bound out = {.value = value_of(op, a.value, b.value), .length = fmax(a.length, b.length)};
    for (int i = 0; i < 3; i++)
        out.gradient[i] = hull(a.gradient[i], b.gradient[i]);
    return out;
}

/* ---- the root of a sum of squares --------------------------------------------------------------
 */

/* The u_i of sqrt(u_0 * u_0 + u_1 * u_1 + ...), constants >= 0 left out; 0: it is something else.
 */
static uint32_t squares_under(const csg_formula_step *steps, uint32_t root, uint32_t *out)
{
    uint32_t waiting[MOST_SQUARES + 1] = {steps[root].a}, top = 1, count = 0;
    while (top) {
        const csg_formula_step *step = &steps[waiting[--top]];
        if (step->op == CSG_FORMULA_CONSTANT && step->constant >= 0)
            continue;
        if (step->op == CSG_FORMULA_MUL && step->a == step->b && count < MOST_SQUARES) {
            out[count++] = step->a;
        } else if (step->op == CSG_FORMULA_ADD && top + 2 <= MOST_SQUARES) {
            waiting[top++] = step->a;
            waiting[top++] = step->b;
        } else {
            return 0;
        }
    }
    return count;
}

static bool share_an_axis(const bound *a, const bound *b)
{
    for (int i = 0; i < 3; i++)
        if (!is_zero(a->gradient[i]) && !is_zero(b->gradient[i]))
            return true;
    return false;
}

/* grad h = J^T c with unit c, so |grad h|^2 is at most the largest eigenvalue of J J^T: its largest
 * row sum, where gradients along different axes are orthogonal. */
static double length_under_root(const bound *bounds, const uint32_t *squares, uint32_t count)
{
    double most = 0;
    for (uint32_t i = 0; i < count; i++) {
        double row = 0;
        for (uint32_t j = 0; j < count; j++)
            if (i == j || share_an_axis(&bounds[squares[i]], &bounds[squares[j]]))
                row += times(bounds[squares[i]].length, bounds[squares[j]].length);
        most = fmax(most, row);
    }
    return sqrt(most) * (1 + 4 * DBL_EPSILON);
}

static bound root_of_squares(const bound *bounds, range under, const uint32_t *squares,
                             uint32_t count)
{
    bound out = {.value = square_root((range){fmax(under.low, 0), under.high})};
    range inverse = out.value.low > 0 ? reciprocal(out.value) : unknown();
    double most[3] = {0};
    for (uint32_t k = 0; k < count; k++) {
        const bound *u = &bounds[squares[k]];
        range share = intersect(product(u->value, inverse), (range){-1, 1});
        for (int i = 0; i < 3; i++) {
            out.gradient[i] = sum(out.gradient[i], product(share, u->gradient[i]));
            most[i] += largest(u->gradient[i]) * largest(u->gradient[i]);
        }
    }
    for (int i = 0; i < 3; i++) { /* Cauchy and Schwarz */
        double limit = sqrt(most[i]) * (1 + 4 * DBL_EPSILON);
        out.gradient[i] = intersect(out.gradient[i], (range){-limit, limit});
    }
    out.length = fmin(length_under_root(bounds, squares, count), length_of(out.gradient));
    return out;
}

/* ---- boxes -------------------------------------------------------------------------------------
 */

/* ---- runs -------------------------------------------------------------------------------------
 */

/* What the variables are, and along which three directions their derivatives are taken; along
 * others than x, y and z lengths mean nothing. */
typedef struct space {
    const range *axes;      /* of each variable; NULL: all numbers */
    const double *along[3]; /* a number per variable; NULL: the unit directions of this group */
    uint32_t group;
} space;

static bound variable_in(const space *in, uint32_t number)
{
    const range all = {-INFINITY, INFINITY};
    bound out = {.value = in->axes ? in->axes[number] : all, .length = 1};
    for (uint32_t k = 0; k < 3; k++)
        out.gradient[k] =
            exactly(in->along[k] ? in->along[k][number] : number == 3 * in->group + k);
    return out;
}

static double bound_in(const csg_formula_step *steps, uint32_t count, const space *in,
                       bound *bounds)
{
    uint32_t squares[MOST_SQUARES];
    for (uint32_t i = 0; i < count; i++) {
        const csg_formula_step *step = &steps[i];
        uint32_t square_count = step->op == CSG_FORMULA_SQRT ? squares_under(steps, i, squares) : 0;
        if (step->op == CSG_FORMULA_CONSTANT) {
            bounds[i] = (bound){.value = exactly(step->constant)};
        } else if (step->op <= CSG_FORMULA_Z) {
            bounds[i] = variable_in(in, csg_formula_variable_of(step));
        } else if (square_count) {
            bounds[i] = root_of_squares(bounds, bounds[step->a].value, squares, square_count);
        } else if (step->op == CSG_FORMULA_MIN || step->op == CSG_FORMULA_MAX) {
            bounds[i] = extreme(step->op, bounds[step->a], bounds[step->b]);
        } else {
            bool square_of_a = step->op == CSG_FORMULA_MUL && step->a == step->b;
            bounds[i] = chain(step->op, bounds[step->a], bounds[step->b], square_of_a);
        }
    }
    double length = is_known(bounds[count - 1].value) ? bounds[count - 1].length : INFINITY;
    return isnan(length) ? INFINITY : length;
}

double csg_formula_bound_on_box(const csg_formula_step *steps, uint32_t count, csg_box box,
                                csg_formula_bound *bounds)
{
    const range axes[3] = {{box.min.x, box.max.x}, {box.min.y, box.max.y}, {box.min.z, box.max.z}};
    return bound_in(steps, count, &(space){.axes = axes}, bounds);
}

/* ---- of as many variables as there are --------------------------------------------------------
 */

/* The derivative by each variable anywhere, unknown where nothing is. */
static void slopes_of_all(const csg_formula_step *steps, uint32_t count, uint32_t variables,
                          bound *bounds, range *slopes)
{
    for (uint32_t first = 0; first < variables; first += 3) {
        bound_in(steps, count, &(space){.group = first / 3}, bounds);
        const bound *result = &bounds[count - 1];
        for (uint32_t k = 0; k < 3 && first + k < variables; k++)
            slopes[first + k] = is_known(result->value) ? result->gradient[k] : unknown();
    }
}

/* Room for the rounding of 0; of the sum of sizes it is less than the last bit. */
#define NO_SLOPE 1e-290

/* The largest derivative along directions of +-1 for each variable: the signs that are known, and
 * all that the first `open` of the others can have, three at a time; the rest count by themselves.
 * Along a direction what is the same for all operands, as of max(a, b), is seen to cancel. */
static double steepest_along_signs(const csg_formula_step *steps, uint32_t count,
                                   uint32_t variables, const range *slopes, double *signs,
                                   bound *bounds)
{
    enum { MOST_OPEN = 10 };
    uint32_t open[MOST_OPEN], open_count = 0;
    double most = 0, rest = 0;
    for (uint32_t v = 0; v < variables; v++) {
        bool rises = slopes[v].low >= -NO_SLOPE, falls = slopes[v].high <= NO_SLOPE;
        bool known = rises || falls;
        signs[v] = falls ? -1 : 1;
        if (known)
            continue;
        if (open_count < MOST_OPEN) {
            open[open_count++] = v;
        } else {
            signs[v] = 0;
            rest += largest(slopes[v]);
        }
    }
    /* f and -f are as steep: where no sign is known the first stays as it is */
    uint32_t fixed = open_count == variables && open_count > 0;
    for (uint32_t mask = 0; mask < 1u << (open_count - fixed); mask += 3) {
        space in = {.group = 0};
        for (uint32_t k = 0; k < 3; k++) {
            double *along = signs + k * variables;
            memmove(along, signs, (k > 0) * variables * sizeof *signs);
            for (uint32_t i = fixed; i < open_count; i++)
                along[open[i]] = (mask + k) >> (i - fixed) & 1 ? -1 : 1;
            in.along[k] = along;
        }
        bound_in(steps, count, &in, bounds);
        for (uint32_t k = 0; k < 3; k++)
            most = fmax(most, largest(bounds[count - 1].gradient[k]));
        if (!is_known(bounds[count - 1].value))
            most = INFINITY;
    }
    return most + rest;
}

double csg_formula_partials_sum(csg_memory *memory, const csg_formula_step *steps, uint32_t count)
{
    uint32_t variables = csg_formula_variables(steps, count);
    size_t bytes = count * sizeof(bound) + variables * (sizeof(range) + 3 * sizeof(double));
    bound *bounds = csg_memory_alloc(memory, bytes);
    if (!bounds)
        return NAN;
    range *slopes = (range *)(bounds + count);
    double *signs = (double *)(slopes + variables);
    slopes_of_all(steps, count, variables, bounds, slopes);
    double most = steepest_along_signs(steps, count, variables, slopes, signs, bounds);
    csg_memory_release(memory, bounds, bytes);
    return isnan(most) ? INFINITY : most * (1 + 8 * DBL_EPSILON);
}

bool csg_formula_ranges(csg_memory *memory, const csg_formula_step *steps, uint32_t count,
                        double low, double high, double value[2], double slope[2])
{
    const csg_box box = {{low, 0, 0}, {high, 0, 0}};
    bound *bounds = csg_memory_alloc(memory, count * sizeof *bounds);
    if (!bounds)
        return false;
    csg_formula_bound_on_box(steps, count, box, bounds);
    const bound result = bounds[count - 1];
    csg_memory_release(memory, bounds, count * sizeof *bounds);
    bool known = is_known(result.value), smooth = known && is_known(result.gradient[0]);
    value[0] = known ? result.value.low : -INFINITY;
    value[1] = known ? result.value.high : INFINITY;
    slope[0] = smooth ? result.gradient[0].low : -INFINITY;
    slope[1] = smooth ? result.gradient[0].high : INFINITY;
    return true;
}

void csg_formula_trends(csg_memory *memory, const csg_formula_step *steps, uint32_t count,
                        uint32_t variables, int *trends)
{
    const double rounding = 1e-12; /* of slopes that are 0 */
    size_t bytes = count * sizeof(bound) + variables * sizeof(range);
    bound *bounds = csg_memory_alloc(memory, bytes);
    memset(trends, 0, variables * sizeof *trends);
    if (!bounds)
        return;
    range *slopes = (range *)(bounds + count);
    slopes_of_all(steps, count, variables, bounds, slopes);
    for (uint32_t v = 0; v < variables; v++)
        trends[v] = slopes[v].low >= -rounding ? 1 : slopes[v].high <= rounding ? -1 : 0;
    csg_memory_release(memory, bounds, bytes);
}
