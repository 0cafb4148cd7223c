/* SPDX-License-Identifier: MIT
 * The steps by which handlers look at their arguments; see modules.h.
 */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/scene_codes.h"
#include "lang/modules/modules.h"

static const char DEFAULT_TAKEN[] = "the default is taken";

/* What becomes of a call that fails: most make nothing, these give their children as they are. */
static const char *loss_of(const csg_module_call *call)
{
    static const char *const names[] = {"translate", "rotate", "scale",    "mirror", "multmatrix",
                                        "color",     "part",   "material", "resize"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strcmp(call->name, names[i]) == 0)
            return "its children stay as they are";
    return "it is left out";
}

static bool report(csg_module_call *call, uint32_t index, csg_diag_code code, const char *instead,
                   const char *format, va_list arguments)
{
    char problem[320], hint[120];
    const csg_parameter_row *row = &call->parameters[index];
    csg_span where = csg_has_argument(call, index) ? call->spans[index] : call->statement->where;
    bool is_lenient = csg_eval_is_lenient(call->e, code, where);
    vsnprintf(problem, sizeof problem, format, arguments);
    snprintf(hint, sizeof hint, "%s must be %s", row->name, row->range);
    csg_eval_report(
        call->e, code, where,
        (code == CSG_DIAG_OUT_OF_RANGE || code == CSG_DIAG_EMPTY_SHAPE) && row->range[0] ? hint
                                                                                         : NULL,
        "%s(): %s%s%s", call->name, problem, is_lenient ? "; " : "", is_lenient ? instead : "");
    return is_lenient;
}

void csg_argument_error(csg_module_call *call, uint32_t index, csg_diag_code code,
                        const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    report(call, index, code, loss_of(call), format, arguments);
    va_end(arguments);
    call->failed = true;
}

bool csg_argument_mishap(csg_module_call *call, uint32_t index, csg_diag_code code,
                         const char *instead, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    bool goes_on = report(call, index, code, instead, format, arguments);
    va_end(arguments);
    call->failed = call->failed || !goes_on;
    return goes_on;
}

bool csg_has_argument(const csg_module_call *call, uint32_t index)
{
    return call->values[index].kind != CSG_VALUE_UNDEF;
}

static bool in_range(double number, csg_range_kind range)
{
    bool point = range == CSG_NOT_NEGATIVE || range == CSG_SIZE_OR_POINT;
    return isfinite(number) && (range == CSG_ANY || number > 0 || (point && number == 0));
}

/* `what` completes "r is": "-1", "nan". */
static void out_of_range(csg_module_call *call, uint32_t index, double number, csg_range_kind range)
{
    bool above = range == CSG_POSITIVE || range == CSG_SIZE;
    bool nothing = isfinite(number) && (range == CSG_SIZE || range == CSG_SIZE_OR_POINT);
    csg_argument_error(call, index, nothing ? CSG_DIAG_EMPTY_SHAPE : CSG_DIAG_OUT_OF_RANGE,
                       "%s is %g, %s %s", call->parameters[index].name,
                       isnan(number) ? fabs(number) : number,
                       nothing ? "so there is nothing: it must be" : "it must be",
                       !isfinite(number) ? "a finite number"
                       : above           ? "above 0"
                                         : "at least 0");
}

double csg_argument_number(csg_module_call *call, uint32_t index, double otherwise,
                           csg_range_kind range)
{
    csg_value value = call->values[index];
    if (value.kind == CSG_VALUE_UNDEF)
        return otherwise;
    if (value.kind != CSG_VALUE_NUMBER) {
        csg_argument_mishap(call, index, CSG_DIAG_BAD_TYPE, DEFAULT_TAKEN,
                            "%s must be a number, not a %s", call->parameters[index].name,
                            csg_value_kind_name(value));
        return otherwise;
    }
    if (!in_range(value.as.number, range)) {
        out_of_range(call, index, value.as.number, range);
        return otherwise;
    }
    return value.as.number;
}

double csg_argument_rounding(csg_module_call *call, uint32_t index, double smallest_edge)
{
    double round = csg_argument_number(call, index, 0, CSG_NOT_NEGATIVE);
    if (!call->failed && round > smallest_edge / 2)
        csg_argument_error(call, index, CSG_DIAG_OUT_OF_RANGE,
                           "round is %g, more than half the smallest edge, %g", round,
                           smallest_edge / 2);
    return round;
}

bool csg_argument_boolean(const csg_module_call *call, uint32_t index)
{
    return csg_value_is_true(call->values[index]);
}

csg_vec3 csg_argument_vector(csg_module_call *call, uint32_t index, csg_vec3 otherwise, bool spread)
{
    double v[3] = {otherwise.x, otherwise.y, otherwise.z};
    csg_value value = call->values[index];
    if (value.kind == CSG_VALUE_UNDEF)
        return otherwise;
    if (spread && value.kind == CSG_VALUE_NUMBER) {
        v[0] = v[1] = v[2] = value.as.number;
    } else if (!csg_value_numbers(value, 3, v) && !csg_value_numbers(value, 2, v)) {
        csg_argument_mishap(call, index, CSG_DIAG_BAD_TYPE, DEFAULT_TAKEN,
                            "%s must be %s[x, y, z], not a %s%s", call->parameters[index].name,
                            spread ? "a number or " : "", csg_value_kind_name(value),
                            value.kind == CSG_VALUE_VECTOR ? " of something else" : "");
        return otherwise;
    }
    for (int i = 0; i < 3; i++)
        if (!isfinite(v[i])) {
            out_of_range(call, index, v[i], CSG_ANY);
            return otherwise;
        }
    return csg_vec3_make(v[0], v[1], v[2]);
}

csg_blend csg_argument_blend(csg_module_call *call, uint32_t index)
{
    const csg_blend sharp = CSG_SHARP;
    csg_value value = call->values[index];
    if (value.kind == CSG_VALUE_BLEND)
        return (csg_blend){value.blend, value.as.number, false};
    if (value.kind == CSG_VALUE_RULE)
        return csg_rule_blend(call, index);
    if (value.kind != CSG_VALUE_UNDEF && value.kind != CSG_VALUE_NUMBER) {
        csg_argument_error(call, index, CSG_DIAG_BAD_BLEND,
                           "blend must be a radius or a blend value such as "
                           "cosine(3), not a %s%s",
                           csg_value_kind_name(value),
                           value.kind == CSG_VALUE_FUNCTION
                               ? ": a radius that varies, function (p) ..., is for the blend of "
                                 "union, intersection and difference"
                               : "");
        return sharp;
    }
    double r = csg_argument_number(call, index, 0, CSG_NOT_NEGATIVE);
    return r > 0 ? csg_blend_number(r) : sharp;
}

csg_node_id csg_module_children(csg_module_call *call)
{
    csg_eval *e = call->e;
    size_t first = e->part_count;
    csg_run_scope(e, call->statement->children, call->frame, true);
    return csg_join_parts(e, first, CSG_NODE_UNION, CSG_SHARP, call->statement->where);
}
