/* SPDX-License-Identifier: MIT
 * Functions that make blends of more than one parameter (scene/operators/rule.h), and their steps.
 * Arguments come in the order of operators.def or by name.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/scene_codes.h"
#include "lang/functions/functions.h"
#include "scene/operators/blend_kinds.h"
#include "scene/operators/rule.h"
#include "scene/operators/steps.h"

static const char *argument_name(const csg_function_call *call, uint32_t i)
{
    csg_symbol name = call->syntax[i].name;
    return name ? csg_symbol_name(&call->e->program->symbols, name) : NULL;
}

static csg_value complain(const csg_function_call *call, uint32_t i, csg_diag_code code,
                          const char *problem)
{
    csg_span where = i < call->count ? call->syntax[i].value->whole : call->where;
    csg_eval_report(call->e, code, where, NULL, "%s(): %s%s", call->name, problem,
                    csg_eval_is_lenient(call->e, code, where) ? "; the blend is left out" : "");
    return csg_value_undef();
}

/* A number for what the call names `what`; NAN after a report. */
static double number_of(const csg_function_call *call, uint32_t i, const char *what)
{
    char problem[120];
    csg_value value = call->arguments[i];
    if (value.kind == CSG_VALUE_NUMBER && !isnan(value.as.number))
        return value.as.number;
    snprintf(problem, sizeof problem, "%s must be a number, not %s%s", what,
             value.kind == CSG_VALUE_NUMBER ? "" : "a ",
             value.kind == CSG_VALUE_NUMBER ? "nan" : csg_value_kind_name(value));
    complain(call, i, CSG_DIAG_BAD_BLEND, problem);
    return NAN;
}

/* ---- steps ------------------------------------------------------------------------------------
 */

csg_value csg_function_step(const csg_function_call *call)
{
    static const double standard[] = {
#define CSG_STEP(NAME, name, standard, least, most, whole, even, doc) standard,
#include "scene/operators/steps.def"
#undef CSG_STEP
    };
    int kind = 0;
    while (kind < CSG_STEP_COUNT && strcmp(csg_step_name((csg_step_kind)kind), call->name) != 0)
        kind++;
    if (kind == CSG_STEP_COUNT)
        return csg_no_such_blend(call);
    csg_step step = {(csg_step_kind)kind, standard[kind]};
    if (call->count && call->arguments[0].kind != CSG_VALUE_UNDEF)
        step.parameter = number_of(call, 0, "its parameter");
    if (isnan(step.parameter))
        return csg_value_undef();
    csg_rule rule = csg_rule_standard(CSG_BLEND_INTERIOR);
    char text[160];
    rule.step = step;
    const char *problem = csg_rule_problem(&rule, text, sizeof text);
    if (problem)
        return complain(call, 0, CSG_DIAG_OUT_OF_RANGE, problem);
    csg_value made = {.kind = CSG_VALUE_STEP, .blend = (uint8_t)kind};
    made.as.number = step.parameter;
    return made;
}

/* ---- rules of numbers -------------------------------------------------------------------------
 */

static bool take_step(const csg_function_call *call, uint32_t i, csg_rule *rule)
{
    csg_value value = call->arguments[i];
    if (value.kind == CSG_VALUE_STEP) {
        rule->step = (csg_step){(csg_step_kind)value.blend, value.as.number};
        return true;
    }
    complain(call, i, CSG_DIAG_BAD_BLEND,
             "step must be poly(n), bspline(m), rising(n), rising2(n) or sigmoid(alpha)");
    return false;
}

/* The parameter that a name means, or the count. */
static uint32_t find_parameter(const csg_rule *rule, const char *name)
{
    uint32_t count = csg_rule_parameter_count(rule->kind);
    for (uint32_t k = 0; k < count; k++)
        if (strcmp(csg_rule_parameter_of(rule->kind, k).name, name) == 0)
            return k;
    return rule->kind == CSG_BLEND_RICCI && strcmp(name, "p") == 0 ? 0 : count;
}

/* "it takes r1, r2, p, debulge and range" */
static void unknown(const csg_function_call *call, uint32_t i, const csg_rule *rule)
{
    char known[160] = "";
    uint32_t count = csg_rule_parameter_count(rule->kind);
    size_t used = 0;
    for (uint32_t k = 0; k < count && used < sizeof known; k++)
        used += (size_t)snprintf(known + used, sizeof known - used, "%s, ",
                                 csg_rule_parameter_of(rule->kind, k).name);
    csg_eval_report(call->e, CSG_DIAG_UNKNOWN_ARGUMENT, call->syntax[i].where, NULL,
                    "%s() takes %s%s%s", call->name, known,
                    csg_blend_takes_fields(rule->kind) ? "range" : "step",
                    csg_eval_ignores(call->e, CSG_DIAG_UNKNOWN_ARGUMENT, call->syntax[i].where));
}

/* Argument i, whose place in the row is `position` where it has no name. False after a report. */
static bool take_number(const csg_function_call *call, uint32_t i, uint32_t position,
                        csg_rule *rule)
{
    const char *name = argument_name(call, i);
    bool fields = csg_blend_takes_fields(rule->kind);
    uint32_t count = csg_rule_parameter_count(rule->kind);
    uint32_t slot = name ? find_parameter(rule, name) : position;
    if (call->arguments[i].kind == CSG_VALUE_UNDEF)
        return true; /* as if not given; a step that was no step is reported already */
    if (!fields && (name ? strcmp(name, "step") == 0 : slot == count))
        return take_step(call, i, rule);
    if (name && fields && strcmp(name, "range") == 0) {
        rule->range = number_of(call, i, "range");
        if (rule->range > 0 || isnan(rule->range))
            return !isnan(rule->range);
        complain(call, i, CSG_DIAG_OUT_OF_RANGE, "range must be above 0");
        return false;
    }
    if (slot >= count) {
        unknown(call, i, rule);
        return true;
    }
    double value = number_of(call, i, csg_rule_parameter_of(rule->kind, slot).name);
    rule->parameters[slot] = value;
    return !isnan(value);
}

static csg_value finished(const csg_function_call *call, const csg_rule *rule)
{
    char text[160];
    const char *problem = csg_rule_problem(rule, text, sizeof text);
    if (problem)
        return complain(call, call->count, CSG_DIAG_OUT_OF_RANGE, problem);
    csg_value made = csg_rule_value_create(&call->e->heap, rule, NULL);
    if (made.kind == CSG_VALUE_UNDEF)
        csg_eval_no_memory(call->e);
    return made;
}

csg_value csg_function_rule(const csg_function_call *call)
{
    const char *name = strcmp(call->name, "superelliptic") == 0 ? "ricci" : call->name;
    csg_blend_kind kind = CSG_BLEND_EXTERIOR;
    while (kind < CSG_BLEND_END && strcmp(csg_rule_name(kind), name) != 0)
        kind++;
    if (kind == CSG_BLEND_END)
        return csg_no_such_blend(call);
    csg_rule rule = csg_rule_standard(kind);
    uint32_t position = 0;
    for (uint32_t i = 0; i < call->count; i++)
        if (!take_number(call, i, call->syntax[i].name ? 0 : position++, &rule))
            return csg_value_undef();
    return finished(call, &rule);
}

/* ---- arcs -------------------------------------------------------------------------------------
 */

static bool take_point(const csg_function_call *call, uint32_t i, csg_value value, csg_rule *rule)
{
    if (rule->point_count < CSG_RULE_KNOTS &&
        csg_value_numbers(value, 3, rule->points[rule->point_count])) {
        rule->point_count++;
        return true;
    }
    complain(call, i, CSG_DIAG_BAD_BLEND,
             rule->point_count < CSG_RULE_KNOTS ? "a point must be [x, y, z]"
                                                : "it passes through at most 16 points");
    return false;
}

static bool take_through(const csg_function_call *call, uint32_t i, csg_rule *rule)
{
    csg_value list = call->arguments[i];
    if (list.kind != CSG_VALUE_VECTOR) {
        complain(call, i, CSG_DIAG_BAD_BLEND, "through must be a list of points [x, y, z]");
        return false;
    }
    for (uint32_t k = 0; k < list.as.vector->count; k++)
        if (!take_point(call, i, list.as.vector->items[k], rule))
            return false;
    return true;
}

static bool take_profile(const csg_function_call *call, uint32_t i, csg_rule *rule)
{
    csg_value list = call->arguments[i];
    csg_spline *s = &rule->spline;
    bool good = list.kind == CSG_VALUE_VECTOR;
    for (uint32_t k = 0; good && k < list.as.vector->count; k++) {
        double pair[2];
        good = csg_value_numbers(list.as.vector->items[k], 2, pair);
        if (good && s->count == CSG_RULE_KNOTS - 2) {
            complain(call, i, CSG_DIAG_OUT_OF_RANGE, "a profile has at most 16 points");
            return false;
        }
        s->angle[s->count] = good ? pair[0] : 0;
        s->factor[s->count] = good ? pair[1] : 0;
        s->count += good;
    }
    if (!good)
        complain(call, i, CSG_DIAG_BAD_BLEND, "profile must be a list of [angle, factor]");
    return good;
}

/* Points by order; the rest by name. */
static bool take_of_arc(const csg_function_call *call, uint32_t i, csg_rule *rule)
{
    const char *name = argument_name(call, i);
    if (!name || strcmp(name, "p1") == 0 || strcmp(name, "p2") == 0)
        return take_point(call, i, call->arguments[i], rule);
    if (strcmp(name, "through") == 0)
        return take_through(call, i, rule);
    if (strcmp(name, "profile") == 0)
        return take_profile(call, i, rule);
    if (strcmp(name, "angles") != 0)
        return take_number(call, i, 0, rule);
    if (csg_value_numbers(call->arguments[i], 2, rule->parameters))
        return true;
    complain(call, i, CSG_DIAG_BAD_BLEND, "angles must be [angle1, angle2] in degrees");
    return false;
}

static bool is_named(const csg_function_call *call, uint32_t i, const char *name)
{
    const char *given = argument_name(call, i);
    return given && strcmp(given, name) == 0;
}

csg_value csg_function_arc(const csg_function_call *call)
{
    csg_rule rule = csg_rule_standard(CSG_BLEND_ARC);
    uint32_t ends = 0;
    bool angles = false, through = false, done = true;
    for (uint32_t i = 0; i < call->count; i++) {
        angles |= is_named(call, i, "angles") || is_named(call, i, "profile");
        through |= is_named(call, i, "through");
        ends += !call->syntax[i].name || is_named(call, i, "p1") || is_named(call, i, "p2");
    }
    if (ends && ends != 2)
        return complain(call, call->count, CSG_DIAG_BAD_BLEND,
                        "it ends at two points, p1 and p2, or at angles = [a1, a2]");
    if ((ends && angles) || (through && !ends))
        return complain(call, call->count, CSG_DIAG_BAD_BLEND,
                        "points p1, p2 go with through =, angles = with profile =");
    for (uint32_t i = 0; i < call->count && done; i++) /* the two ends come first */
        done = is_named(call, i, "through") || take_of_arc(call, i, &rule);
    for (uint32_t i = 0; i < call->count && done; i++)
        done = !is_named(call, i, "through") || take_of_arc(call, i, &rule);
    return done ? finished(call, &rule) : csg_value_undef();
}

/* ---- profiles ---------------------------------------------------------------------------------
 */

csg_value csg_function_profile(const csg_function_call *call)
{
    csg_value value = call->arguments[0];
    if (value.kind != CSG_VALUE_FUNCTION || value.as.function->literal->as.call.arguments.count < 1)
        return complain(call, 0, CSG_DIAG_BAD_BLEND,
                        "it needs a function of a number, as function (x) max(0, 1 - x) ^ 2 / 4");
    csg_rule rule = csg_rule_standard(CSG_BLEND_PROFILE);
    csg_value made = csg_rule_value_create(&call->e->heap, &rule, value.as.function);
    if (made.kind == CSG_VALUE_UNDEF)
        csg_eval_no_memory(call->e);
    return made;
}
