/* SPDX-License-Identifier: MIT
 * Numbers: trigonometry in degrees, exact where the result is rational, elementary functions,
 * vectors.
 */
#include <math.h>

#include "base/elementary.h"

#include "lang/functions/functions.h"

/* ---- trigonometry -----------------------------------------------------------------------------
 */

#define DEGREE 0.017453292519943295

/* An angle reduced to one period as OpenSCAD does it: by whole periods taken off at once. Libraries
 * rely on what rounding leaves there: 1.4e-14 degrees beside -90 are 270 exactly, with a cosine of
 * 0. */
static double reduced(double degrees, double period)
{
    bool is_reduced = degrees >= 0 && degrees < period;
    return is_reduced ? degrees : degrees - period * floor(degrees / period);
}

/* Of an angle in [0, 90], by the function that is exact there: exact at 0, 30, 45, 60 and 90. */
static double sine_of_quarter(double a)
{
    if (a == 30)
        return 0.5;
    if (a == 45)
        return 0.70710678118654752440;
    if (a == 60)
        return 0.86602540378443864676;
    return a < 45 ? csg_sin(a * DEGREE) : csg_cos((90 - a) * DEGREE);
}

static double sine(double degrees)
{
    double a = reduced(degrees, 360);
    bool below = a >= 180;
    a -= below ? 180 : 0;
    double value = sine_of_quarter(a > 90 ? 180 - a : a);
    return below && value != 0 ? -value : value;
}

static double cosine(double degrees)
{
    double a = reduced(degrees, 360);
    bool below = a >= 180;
    a -= below ? 180 : 0;
    bool turned = a > 90;
    double value = sine_of_quarter(90 - (turned ? 180 - a : a));
    return below != turned && value != 0 ? -value : value;
}

static double tangent(double degrees)
{
    double a = reduced(degrees, 180);
    if (a == 90)
        return fmod(floor(degrees / 180), 2) == 0 ? INFINITY : -INFINITY;
    bool below = a > 90;
    a = below ? 180 - a : a;
    double value = a == 45 ? 1 : a == 0 ? 0 : sine_of_quarter(a) / sine_of_quarter(90 - a);
    return below && value != 0 ? -value : value;
}

/* A whole number of degrees when that is what the function of it gives back. */
static double rounded_angle(double radians, double (*function)(double), double value)
{
    double degrees = radians / DEGREE, whole = round(degrees);
    return function(whole) == value ? whole : degrees;
}

static double arc_sine(double x)
{
    return rounded_angle(csg_asin(x), sine, x);
}

static double arc_cosine(double x)
{
    return rounded_angle(csg_acos(x), cosine, x);
}

static double arc_tangent(double x)
{
    return rounded_angle(csg_atan(x), tangent, x);
}

csg_value csg_function_atan2(const csg_function_call *call)
{
    for (uint32_t i = 0; i < 2; i++)
        if (call->arguments[i].kind != CSG_VALUE_NUMBER)
            return csg_bad_argument(call, i, "two numbers");
    double y = call->arguments[0].as.number, x = call->arguments[1].as.number;
    double degrees = csg_atan2(y, x) / DEGREE, whole = round(degrees);
    bool exact = fabs(degrees - whole) < 3e-14 * fabs(whole) || y == 0;
    return csg_value_number(exact ? whole : degrees);
}

/* ---- elementary --------------------------------------------------------------------------------
 */

static double sign(double x)
{
    return x > 0 ? 1 : x < 0 ? -1 : 0;
}

/* Functions of one number. */
#define OF_NUMBER(name, function)                                                                  \
    csg_value csg_function_##name(const csg_function_call *call)                                   \
    {                                                                                              \
        if (call->arguments[0].kind != CSG_VALUE_NUMBER)                                           \
            return csg_bad_argument(call, 0, "a number");                                          \
        return csg_value_number(function(call->arguments[0].as.number));                           \
    }

OF_NUMBER(sin, sine)
OF_NUMBER(cos, cosine)
OF_NUMBER(tan, tangent)
OF_NUMBER(asin, arc_sine)
OF_NUMBER(acos, arc_cosine)
OF_NUMBER(atan, arc_tangent)
OF_NUMBER(abs, fabs)
OF_NUMBER(sign, sign)
OF_NUMBER(floor, floor)
OF_NUMBER(ceil, ceil)
OF_NUMBER(sqrt, sqrt)
OF_NUMBER(exp, exp)
OF_NUMBER(ln, log)

csg_value csg_function_pow(const csg_function_call *call)
{
    for (uint32_t i = 0; i < 2; i++)
        if (call->arguments[i].kind != CSG_VALUE_NUMBER)
            return csg_bad_argument(call, i, "two numbers");
    return csg_value_number(csg_pow(call->arguments[0].as.number, call->arguments[1].as.number));
}

csg_value csg_function_log(const csg_function_call *call)
{
    for (uint32_t i = 0; i < call->count; i++)
        if (call->arguments[i].kind != CSG_VALUE_NUMBER)
            return csg_bad_argument(call, i, "a number");
    double x = call->arguments[call->count - 1].as.number;
    return csg_value_number(call->count == 1 ? csg_log10(x)
                                             : csg_log(x) / csg_log(call->arguments[0].as.number));
}

/* Of a list: by the order of values, what has no order does not count. */
static csg_value extreme_of(const csg_function_call *call, const csg_vector *list, bool smallest)
{
    csg_value best = csg_value_undef();
    for (uint32_t i = 0; i < list->count; i++) {
        csg_value item = list->items[i];
        if (i == 0 ||
            csg_value_is_less(call->e, smallest ? item : best, smallest ? best : item, call->where))
            best = item;
    }
    return csg_value_retain(best);
}

static csg_value extreme(const csg_function_call *call, bool smallest)
{
    const csg_value *values = call->arguments;
    if (!csg_eval_charge(call->e, call->count / 8, call->where))
        return csg_value_undef();
    if (call->count == 1 && values[0].kind == CSG_VALUE_VECTOR)
        return values[0].as.vector->count ? extreme_of(call, values[0].as.vector, smallest)
                                          : csg_bad_argument(call, 0, "a list of numbers");
    for (uint32_t i = 0; i < call->count; i++)
        if (values[i].kind != CSG_VALUE_NUMBER)
            return csg_bad_argument(call, i, "numbers");
    double best = values[0].as.number;
    for (uint32_t i = 1; i < call->count; i++)
        if (smallest ? values[i].as.number < best : values[i].as.number > best)
            best = values[i].as.number;
    return csg_value_number(best);
}

csg_value csg_function_min(const csg_function_call *call)
{
    return extreme(call, true);
}

csg_value csg_function_max(const csg_function_call *call)
{
    return extreme(call, false);
}

/* ---- vectors ------------------------------------------------------------------------------------
 */

static bool is_number_list(csg_value value)
{
    if (value.kind != CSG_VALUE_VECTOR)
        return false;
    for (uint32_t i = 0; i < value.as.vector->count; i++)
        if (value.as.vector->items[i].kind != CSG_VALUE_NUMBER)
            return false;
    return true;
}

csg_value csg_function_norm(const csg_function_call *call)
{
    if (!is_number_list(call->arguments[0]))
        return csg_bad_argument(call, 0, "a list of numbers");
    const csg_vector *vector = call->arguments[0].as.vector;
    double sum = 0;
    if (!csg_eval_charge(call->e, vector->count / 8, call->where))
        return csg_value_undef();
    for (uint32_t i = 0; i < vector->count; i++)
        sum += vector->items[i].as.number * vector->items[i].as.number;
    return csg_value_number(sqrt(sum));
}

csg_value csg_function_cross(const csg_function_call *call)
{
    double a[3], b[3];
    if (csg_value_numbers(call->arguments[0], 2, a) && csg_value_numbers(call->arguments[1], 2, b))
        return csg_value_number(a[0] * b[1] - a[1] * b[0]);
    if (!csg_value_numbers(call->arguments[0], 3, a))
        return csg_bad_argument(call, 0, "two vectors of 3 (or 2) numbers");
    if (!csg_value_numbers(call->arguments[1], 3, b))
        return csg_bad_argument(call, 1, "two vectors of 3 (or 2) numbers");
    for (uint32_t i = 0; i < 3; i++)
        if (!isfinite(a[i]) || !isfinite(b[i]))
            return csg_bad_argument(call, isfinite(a[i]) ? 1 : 0, "finite numbers");
    csg_vector *made = csg_vector_create(&call->e->heap, 3);
    if (!made) {
        csg_eval_no_memory(call->e);
        return csg_value_undef();
    }
    for (int i = 0; i < 3; i++)
        made->items[i] =
            csg_value_number(a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3]);
    return csg_value_object(made, CSG_VALUE_VECTOR);
}

csg_value csg_function_dot(const csg_function_call *call)
{
    const csg_value *v = call->arguments;
    for (uint32_t i = 0; i < 2; i++)
        if (!is_number_list(v[i]) || v[i].as.vector->count != v[0].as.vector->count)
            return csg_bad_argument(call, i, "two lists of equally many numbers");
    double sum = 0;
    if (!csg_eval_charge(call->e, v[0].as.vector->count / 8, call->where))
        return csg_value_undef();
    for (uint32_t i = 0; i < v[0].as.vector->count; i++)
        sum += v[0].as.vector->items[i].as.number * v[1].as.vector->items[i].as.number;
    return csg_value_number(sum);
}
