/* SPDX-License-Identifier: MIT
 * Values and gradients of formulas in double: forward mode, step by step. The definition that the
 * float kernels answer to.
 */
#include "scene/formula/formula.h"

#include "base/elementary.h"

#define DEGREE 0.017453292519943295

double csg_formula_value(csg_formula_op op, double a, double b)
{
    switch (op) {
    case CSG_FORMULA_NEG:
        return -a;
    case CSG_FORMULA_ABS:
        return fabs(a);
    case CSG_FORMULA_SQRT:
        return sqrt(a);
    case CSG_FORMULA_SIN:
        return csg_sin(fmod(a, 360) * DEGREE);
    case CSG_FORMULA_COS:
        return csg_cos(fmod(a, 360) * DEGREE);
    case CSG_FORMULA_TAN:
        return csg_tan(fmod(a, 180) * DEGREE);
    case CSG_FORMULA_ASIN:
        return csg_asin(a) / DEGREE;
    case CSG_FORMULA_ACOS:
        return csg_acos(a) / DEGREE;
    case CSG_FORMULA_ATAN:
        return csg_atan(a) / DEGREE;
    case CSG_FORMULA_EXP:
        return csg_exp(a);
    case CSG_FORMULA_LN:
        return csg_log(a);
    case CSG_FORMULA_FLOOR:
        return floor(a);
    case CSG_FORMULA_ADD:
        return a + b;
    case CSG_FORMULA_SUB:
        return a - b;
    case CSG_FORMULA_MUL:
        return a * b;
    case CSG_FORMULA_DIV:
        return a / b;
    case CSG_FORMULA_MIN:
        return a < b ? a : b;
    case CSG_FORMULA_MAX:
        return a > b ? a : b;
    case CSG_FORMULA_POW:
        return csg_pow(a, b);
    case CSG_FORMULA_ATAN2:
        return csg_atan2(a, b) / DEGREE;
    case CSG_FORMULA_MOD:
        return fmod(a, b);
    case CSG_FORMULA_CONSTANT: /* these have no operands */
    case CSG_FORMULA_X:
    case CSG_FORMULA_Y:
    case CSG_FORMULA_Z:
    case CSG_FORMULA_OP_COUNT:
        break;
    }
    return NAN;
}

/* Derivatives by the two operands; v is the value. */
static void partials(csg_formula_op op, double a, double b, double v, double *da, double *db)
{
    double square = a * a + b * b;
    *da = *db = 0;
    switch (op) {
    case CSG_FORMULA_NEG:
        *da = -1;
        break;
    case CSG_FORMULA_ABS:
        *da = a < 0 ? -1 : a > 0;
        break;
    case CSG_FORMULA_SQRT:
        *da = 0.5 / v;
        break;
    case CSG_FORMULA_SIN:
        *da = DEGREE * csg_formula_value(CSG_FORMULA_COS, a, 0);
        break;
    case CSG_FORMULA_COS:
        *da = -DEGREE * csg_formula_value(CSG_FORMULA_SIN, a, 0);
        break;
    case CSG_FORMULA_TAN:
        *da = DEGREE * (1 + v * v);
        break;
    case CSG_FORMULA_ASIN:
    case CSG_FORMULA_ACOS:
        *da = (op == CSG_FORMULA_ASIN ? 1 : -1) / (DEGREE * sqrt((1 - a) * (1 + a)));
        break;
    case CSG_FORMULA_ATAN:
        *da = 1 / (DEGREE * (1 + a * a));
        break;
    case CSG_FORMULA_EXP:
        *da = v;
        break;
    case CSG_FORMULA_LN:
        *da = 1 / a;
        break;
    case CSG_FORMULA_ADD:
    case CSG_FORMULA_SUB:
        *da = 1;
        *db = op == CSG_FORMULA_ADD ? 1 : -1;
        break;
    case CSG_FORMULA_MUL:
        *da = b;
        *db = a;
        break;
    case CSG_FORMULA_DIV:
        *da = 1 / b;
        *db = -v / b;
        break;
    case CSG_FORMULA_MIN:
        *da = a < b;
        *db = !(a < b);
        break;
    case CSG_FORMULA_MAX:
        *da = a > b;
        *db = !(a > b);
        break;
    case CSG_FORMULA_POW:
        *da = b * csg_pow(a, b - 1);
        *db = a > 0 ? v * csg_log(a) : 0;
        break;
    case CSG_FORMULA_ATAN2:
        *da = b / (DEGREE * square);
        *db = -a / (DEGREE * square);
        break;
    case CSG_FORMULA_MOD:
        *da = 1;
        *db = -trunc(a / b);
        break;
    case CSG_FORMULA_FLOOR: /* is flat */
    case CSG_FORMULA_CONSTANT:
    case CSG_FORMULA_X:
    case CSG_FORMULA_Y:
    case CSG_FORMULA_Z:
    case CSG_FORMULA_OP_COUNT:
        break;
    }
    *da = isfinite(*da) ? *da : 0;
    *db = isfinite(*db) ? *db : 0;
}

static csg_formula_dual apply(const csg_formula_step *step, csg_formula_dual a, csg_formula_dual b)
{
    double da, db;
    csg_formula_dual out = {.value = csg_formula_value(step->op, a.value, b.value)};
    partials(step->op, a.value, b.value, out.value, &da, &db);
    out.gradient = csg_vec3_scale(a.gradient, da);
    if (csg_formula_op_arity(step->op) > 1)
        out.gradient = csg_vec3_add(out.gradient, csg_vec3_scale(b.gradient, db));
    return out;
}

/* The nearest number of the side; 0 in *moves where it is another one. */
static double clamp(double value, double low, double high, double *moves)
{
    *moves = value >= low && value <= high;
    return value < low ? low : value > high ? high : value;
}

/* axes: the variables of the group, with their gradients; values: all, NULL where it is the only
 * group. */
static csg_formula_dual evaluate_steps(const csg_formula_step *steps, const csg_formula *formula,
                                       const csg_formula_dual axes[3], const double *values,
                                       uint32_t group, csg_formula_dual *work)
{
    steps += formula->first;
    for (uint32_t i = 0; i < formula->count; i++) {
        const csg_formula_step *step = &steps[i];
        if (step->op == CSG_FORMULA_CONSTANT)
            work[i] = (csg_formula_dual){.value = step->constant};
        else if (step->op <= CSG_FORMULA_Z && step->a == group)
            work[i] = axes[step->op - CSG_FORMULA_X];
        else if (step->op <= CSG_FORMULA_Z)
            work[i] = (csg_formula_dual){.value = values[csg_formula_variable_of(step)]};
        else
            work[i] = apply(step, work[step->a], work[step->b]);
    }
    csg_formula_dual out = work[formula->count - 1];
    if (!(out.value > -CSG_FORMULA_FAR))
        return (csg_formula_dual){.value = -CSG_FORMULA_FAR};
    if (out.value > CSG_FORMULA_FAR)
        return (csg_formula_dual){.value = CSG_FORMULA_FAR};
    bool finite = isfinite(out.gradient.x) && isfinite(out.gradient.y) && isfinite(out.gradient.z);
    if (!finite)
        out.gradient = csg_vec3_make(0, 0, 0);
    return out;
}

csg_formula_dual csg_formula_evaluate(const csg_formula_step *steps, const csg_formula *formula,
                                      csg_vec3 p, csg_formula_dual *work)
{
    csg_formula_dual axes[3] = {0};
    csg_box box = formula->bounds;
    axes[0].value = clamp(p.x, box.min.x, box.max.x, &axes[0].gradient.x);
    axes[1].value = clamp(p.y, box.min.y, box.max.y, &axes[1].gradient.y);
    axes[2].value = clamp(p.z, box.min.z, box.max.z, &axes[2].gradient.z);
    return evaluate_steps(steps, formula, axes, NULL, 0, work);
}

csg_formula_dual csg_formula_evaluate_group(const csg_formula_step *steps,
                                            const csg_formula *formula, const double *values,
                                            uint32_t group, csg_formula_dual *work)
{
    csg_formula_dual axes[3] = {{0, {1, 0, 0}}, {0, {0, 1, 0}}, {0, {0, 0, 1}}};
    uint32_t variables = csg_formula_variables(steps + formula->first, formula->count);
    for (uint32_t k = 0; k < 3 && 3 * group + k < variables; k++)
        axes[k].value = values[3 * group + k];
    return evaluate_steps(steps, formula, axes, values, group, work);
}
