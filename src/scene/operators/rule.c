/* SPDX-License-Identifier: MIT
 * Rules: their tables, what their numbers may be, and the constants found once per rule: K, whether
 * it is monotone, the slopes of a profile's spline.
 */
#include "scene/operators/rule.h"
#include "scene/operators/blend_kinds.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>

#include "base/elementary.h"
#include "scene/operators/rule_private.h"

#define DEGREE 0.017453292519943295

enum { ANGLES = 4096 /* scanned for K */ };
/* What the scan may have missed between its angles. */
#define SCAN_ROOM 1.001
/* A sigmoid's tails beyond delta (operators.md 7.2). */
#define SIGMOID_ROOM (1 + 1e-6)

typedef struct rule_row {
    const char *name, *space;
    bool fold;
} rule_row;

static const rule_row rows[CSG_BLEND_END] = {
#define CSG_RULE(NAME, name, space, fold, interval, demand, lipschitz, equal, doc)                 \
    [CSG_BLEND_##NAME] = {#name, #space, fold},
#include "scene/operators/operators.def"
};

static const struct {
    csg_blend_kind kind;
    csg_rule_parameter parameter;
} parameters[] = {
#define CSG_RULE_PARAMETER(NAME, name, standard, least, open, most, unit, meaning)                 \
    {CSG_BLEND_##NAME, {#name, unit, meaning, standard, least, most, open}},
#include "scene/operators/operators.def"
};
enum { PARAMETER_COUNT = sizeof parameters / sizeof *parameters };

static const struct {
    double least, most;
    bool whole;
} steps[] = {
#define CSG_STEP(NAME, name, standard, least, most, whole, even, doc) {least, most, whole},
#include "scene/operators/steps.def"
#undef CSG_STEP
};

const char *csg_rule_name(uint32_t kind)
{
    assert(csg_blend_is_rule(kind) && kind < CSG_BLEND_END);
    return rows[kind].name;
}

bool csg_rule_is_fold(uint32_t kind)
{
    return rows[kind].fold;
}

uint32_t csg_rule_parameter_count(uint32_t kind)
{
    uint32_t count = 0;
    for (int i = 0; i < PARAMETER_COUNT; i++)
        count += parameters[i].kind == kind;
    return count;
}

csg_rule_parameter csg_rule_parameter_of(uint32_t kind, uint32_t index)
{
    int i = 0;
    while (parameters[i].kind != kind)
        i++;
    return parameters[i + (int)index].parameter;
}

csg_rule csg_rule_standard(uint32_t kind)
{
    csg_rule rule = {.kind = kind, .step = {CSG_STEP_POLY, 3}};
    uint32_t count = csg_rule_parameter_count(kind);
    for (uint32_t i = 0; i < count; i++)
        rule.parameters[i] = csg_rule_parameter_of(kind, i).standard;
    return rule;
}

csg_rule csg_rule_of_fields(void)
{
    csg_rule rule = csg_rule_standard(CSG_BLEND_FIELD_SHARP);
    csg_rule_settle(&rule);
    return rule;
}

/* ---- checks -----------------------------------------------------------------------------------
 */

/* "above 0 and at most 1"; a limit that only keeps numbers finite is named when it is passed. */
static void put_range(char *text, size_t size, double least, bool open, double most, double value)
{
    const double unlimited = 1e15;
    const char *from = open ? "above" : "at least";
    if (most >= unlimited && !(value > most))
        snprintf(text, size, "%s %g", from, least);
    else if (open)
        snprintf(text, size, "%s %g and at most %g", from, least, most);
    else
        snprintf(text, size, "%g to %g", least, most);
}

static const char *out_of_range(char *text, size_t size, const char *name, double value,
                                double least, bool open, double most)
{
    char range[80];
    put_range(range, sizeof range, least, open, most, value);
    snprintf(text, size, "%s must be %s, not %g", name, range, value);
    return text;
}

static bool is_within(double value, double least, bool open, double most)
{
    return (open ? value > least : value >= least) && value <= most;
}

static const char *step_problem(csg_step step, char *text, size_t size)
{
    if ((unsigned)step.kind >= CSG_STEP_COUNT)
        return "there is no such step";
    double least = steps[step.kind].least, most = steps[step.kind].most, value = step.parameter;
    bool whole = steps[step.kind].whole;
    if (is_within(value, least, false, most) && (!whole || value == floor(value)))
        return NULL;
    snprintf(text, size, "the parameter of %s must be %s %g to %g, not %g",
             csg_step_name(step.kind), whole ? "a whole number" : "a number", least, most, value);
    return text;
}

/* Whether a union keeps all of its operands (operators.md 7.2). */
static bool keeps_operands(const csg_rule *rule)
{
    static const double ROUNDING = 1e-14; /* of delta */
    return !csg_rule_is_wide(rule) || csg_rule_scan_exterior(rule).least >= -ROUNDING;
}

/* The largest eps of which that is known, in whole thousandths of delta. */
static double find_widest(const csg_rule *rule)
{
    csg_rule tried = *rule;
    int good = 1000, bad = 4000;
    while (bad - good > 1) {
        int middle = (good + bad) / 2;
        tried.parameters[1] = rule->parameters[0] * middle / 1000;
        *(keeps_operands(&tried) ? &good : &bad) = middle;
    }
    return rule->parameters[0] * good / 1000;
}

static const char *exterior_problem(const csg_rule *rule, char *text, size_t size)
{
    double delta = rule->parameters[0], eps = rule->parameters[1];
    const char *problem = step_problem(rule->step, text, size);
    if (problem)
        return problem;
    if (!keeps_operands(rule)) {
        snprintf(
            text, size,
            "eps must be at most %g for delta = %g and this step, not %g: the union would lose "
            "some of its operands",
            find_widest(rule), delta, eps);
        return text;
    }
    if (rule->step.kind == CSG_STEP_SIGMOID && rule->step.parameter * delta < 10 * eps) {
        snprintf(text, size, "a sigmoid's alpha must be at least 10 eps / delta = %g, not %g",
                 10 * eps / delta, rule->step.parameter);
        return text;
    }
    return NULL;
}

/* The profile as given: angles in degrees, between those of the rule. */
static const char *profile_problem(const csg_rule *rule, char *text, size_t size)
{
    const csg_spline *s = &rule->spline;
    double last = rule->parameters[0];
    if (s->count > CSG_RULE_KNOTS - 2) {
        snprintf(text, size, "a profile has at most %d points", CSG_RULE_KNOTS - 2);
        return text;
    }
    for (uint32_t i = 0; i < s->count; i++) {
        if (!(s->angle[i] > last && s->angle[i] < rule->parameters[1])) {
            snprintf(text, size,
                     "the angles of the profile must rise between %g and %g degrees, %g does not",
                     rule->parameters[0], rule->parameters[1], s->angle[i]);
            return text;
        }
        if (!is_within(s->factor[i], 0, true, 10))
            return out_of_range(text, size, "a factor of the profile", s->factor[i], 0, true, 10);
        last = s->angle[i];
    }
    return NULL;
}

static const char *scale_problem(const csg_rule *rule, char *text, size_t size)
{
    const double *v = rule->parameters;
    if (v[2] >= v[0] * v[1]) {
        snprintf(text, size, "p must be below r1 r2 = %g, not %g", v[0] * v[1], v[2]);
        return text;
    }
    if (v[3] > 0 && fmax(v[0], v[1]) > 0.5)
        return out_of_range(text, size, "with debulge, a range r1 or r2", fmax(v[0], v[1]), 0, true,
                            0.5);
    return NULL;
}

const char *csg_rule_problem(const csg_rule *rule, char *text, size_t size)
{
    const double *v = rule->parameters;
    uint32_t count = csg_rule_parameter_count(rule->kind);
    for (uint32_t i = 0; i < count; i++) {
        csg_rule_parameter p = csg_rule_parameter_of(rule->kind, i);
        if (!is_within(v[i], p.least, p.open, p.most))
            return out_of_range(text, size, p.name, v[i], p.least, p.open, p.most);
    }
    if (!is_within(rule->range, 0, false, 1e15))
        return out_of_range(text, size, "range", rule->range, 0, true, 1e15);
    switch ((csg_blend_kind)rule->kind) {
    case CSG_BLEND_EXTERIOR:
        return exterior_problem(rule, text, size);
    case CSG_BLEND_INTERIOR:
        return step_problem(rule->step, text, size);
    case CSG_BLEND_SCALE_SET:
        return scale_problem(rule, text, size);
    case CSG_BLEND_ARC:
        return profile_problem(rule, text, size);
    case CSG_BLEND_PROFILE: /* its function is looked at where it is made (build_profile.c) */
    case CSG_BLEND_RICCI:
    case CSG_BLEND_SOFT_SUM:
    case CSG_BLEND_SOFT_SET:
    case CSG_BLEND_PERLIN:
    case CSG_BLEND_ARC_SHARP:
    case CSG_BLEND_FIELD_SHARP:
        return NULL; /* each parameter alone */
#define CSG_BLEND(NAME, name, area, raw, support, excess, smooth, convex, doc)                     \
    case CSG_BLEND_##NAME:
#include "scene/operators/operators.def"
    case CSG_BLEND_ORTHOGONAL:
    case CSG_BLEND_END:
        break; /* no rules */
    }
    return "there is no such rule";
}

/* ---- profiles ---------------------------------------------------------------------------------
 */

/* Slopes of the clamped cubic spline: a tridiagonal system, eliminated upwards. */
static void find_slopes(csg_spline *s)
{
    double upper[CSG_RULE_KNOTS], right[CSG_RULE_KNOTS];
    uint32_t last = s->count - 1;
    upper[0] = right[0] = 0;
    for (uint32_t i = 1; i < last; i++) {
        double before = 1 / (s->angle[i] - s->angle[i - 1]);
        double after = 1 / (s->angle[i + 1] - s->angle[i]);
        double sum = 3 * ((s->factor[i] - s->factor[i - 1]) * before * before +
                          (s->factor[i + 1] - s->factor[i]) * after * after);
        double pivot = 2 * (before + after) - before * upper[i - 1];
        upper[i] = after / pivot;
        right[i] = (sum - before * right[i - 1]) / pivot;
    }
    s->slope[0] = s->slope[last] = 0;
    for (uint32_t i = last; i-- > 1;)
        s->slope[i] = right[i] - upper[i] * s->slope[i + 1];
}

/* Radians, and the ends where the factor is 1. */
static void settle_profile(csg_rule *rule)
{
    csg_spline *s = &rule->spline;
    if (!s->count || s->settled)
        return;
    s->settled = true;
    for (uint32_t i = s->count; i-- > 0;) {
        s->degrees[i] = s->angle[i];
        s->angle[i + 1] = s->angle[i] * DEGREE;
        s->factor[i + 1] = s->factor[i];
    }
    s->count += 2;
    s->angle[0] = rule->parameters[0] * DEGREE;
    s->angle[s->count - 1] = rule->parameters[1] * DEGREE;
    s->factor[0] = s->factor[s->count - 1] = 1;
    find_slopes(s);
}

double csg_spline_at(const csg_spline *s, double angle, double *slope)
{
    *slope = 0;
    if (!s->count || !(angle > s->angle[0]) || angle >= s->angle[s->count - 1])
        return 1;
    uint32_t i = 0;
    while (angle >= s->angle[i + 1])
        i++;
    double h = s->angle[i + 1] - s->angle[i], t = (angle - s->angle[i]) / h, z = 1 - t;
    *slope = 6 * t * (t - 1) * (s->factor[i] - s->factor[i + 1]) / h +
             z * (1 - 3 * t) * s->slope[i] + t * (3 * t - 2) * s->slope[i + 1];
    return (1 + 2 * t) * z * z * s->factor[i] + t * z * z * h * s->slope[i] +
           t * t * (3 - 2 * t) * s->factor[i + 1] - t * t * z * h * s->slope[i + 1];
}

/* ---- constants --------------------------------------------------------------------------------
 */

/* ARC is homogeneous: its gradient depends on the angle only. */
static void scan_angles(csg_rule *rule, bool is_union)
{
    double most = 0, least = 1, partials[2];
    for (int i = 0; i <= ANGLES; i++) {
        double angle = 90 * DEGREE * i / ANGLES;
        csg_rule_apply(rule, is_union, (double[]){csg_cos(angle), csg_sin(angle)}, 2, 0, partials);
        most = fmax(most, fabs(partials[0]) + fabs(partials[1]));
        least = fmin(least, fmin(partials[0], partials[1]));
    }
    rule->k[!is_union] = most * SCAN_ROOM;
    rule->monotone[!is_union] = least >= 0;
}

static void settle_arc(csg_rule *rule)
{
    double partials[2];
    settle_profile(rule);
    if (rule->spline.count) {
        scan_angles(rule, true);
        scan_angles(rule, false);
        return;
    }
    rule->k[0] = csg_rule_apply(rule, true, (double[]){0.5, 0.5}, 2, 0, partials) * 2;
    rule->k[1] = 1;
}

/* The largest N_S'(B) (B_1 + B_2) lies where the larger operand is 1 (operators.md 6.6); with
 * debulge the bound of the widest ranges. */
static double scale_k(const csg_rule *rule)
{
    const double *v = rule->parameters;
    double widest = v[3] > 0 ? 2 + v[3] : 1, partials[2], most = 0;
    double m = csg_scale_top(v[0] * widest, v[1] * widest, v[2] / (v[0] * v[1]));
    double bound = (1.5 - m) / (m - 0.5);
    if (v[3] > 0)
        return bound;
    for (int i = 0; i <= 2 * ANGLES; i++) {
        double along = (double)(i % (ANGLES + 1)) / ANGLES, at[2] = {along, along};
        at[i > ANGLES] = 1;
        csg_rule_apply(rule, false, at, 2, 0, partials);
        most = fmax(most, partials[0] + partials[1]);
    }
    return fmin(bound, most * SCAN_ROOM);
}

static void set_both(csg_rule *rule, bool monotone, double k)
{
    rule->monotone[0] = rule->monotone[1] = monotone;
    rule->k[0] = rule->k[1] = k;
}

static void settle_lengths(csg_rule *rule)
{
    const double *v = rule->parameters;
    rule->facts = csg_step_find_facts(rule->step);
    double k = rule->kind == CSG_BLEND_INTERIOR ? rule->facts.interior
                                                : 1 + v[1] / v[0] * rule->facts.exterior;
    rule->most_excess = 0;
    if (csg_rule_is_wide(rule)) {
        csg_exterior_facts found = csg_rule_scan_exterior(rule);
        rule->most_excess = found.most * SCAN_ROOM;
        k = found.k * SCAN_ROOM;
    }
    set_both(rule, false, rule->step.kind == CSG_STEP_SIGMOID ? k * SIGMOID_ROOM : k);
}

void csg_rule_settle(csg_rule *rule)
{
    set_both(rule, true, 0);
    switch ((csg_blend_kind)rule->kind) {
    case CSG_BLEND_EXTERIOR:
    case CSG_BLEND_INTERIOR:
        settle_lengths(rule);
        break;
    case CSG_BLEND_ARC:
        settle_arc(rule);
        break;
    case CSG_BLEND_SCALE_SET:
        set_both(rule, rule->parameters[3] == 0, scale_k(rule));
        break;
    case CSG_BLEND_ARC_SHARP:
        rule->k[0] = sqrt(2);
        rule->k[1] = 4 - 2 * sqrt(2);
        break;
    case CSG_BLEND_FIELD_SHARP:
        set_both(rule, true, 1);
        break;
    case CSG_BLEND_PROFILE: /* a combine node, which has its own */
    case CSG_BLEND_RICCI:
    case CSG_BLEND_SOFT_SUM:
    case CSG_BLEND_SOFT_SET:
    case CSG_BLEND_PERLIN: /* K by the number of operands: csg_rule_slope */
#define CSG_BLEND(NAME, name, area, raw, support, excess, smooth, convex, doc)                     \
    case CSG_BLEND_##NAME:
#include "scene/operators/operators.def"
    case CSG_BLEND_ORTHOGONAL:
    case CSG_BLEND_END:
        break;
    }
}

csg_rule csg_rule_scale(const csg_rule *rule, double factor)
{
    csg_rule scaled = *rule;
    for (uint32_t i = 0; i < 2 && !csg_blend_takes_fields(rule->kind); i++)
        scaled.parameters[i] *= factor;
    scaled.range *= factor;
    return scaled;
}

double csg_rule_support(const csg_rule *rule)
{
    const double *v = rule->parameters;
    double reach = csg_step_reach(rule->step);
    if (csg_blend_takes_fields(rule->kind))
        return INFINITY;
    return rule->kind == CSG_BLEND_INTERIOR ? reach * v[0] : v[0] + reach * v[1];
}

double csg_rule_excess(const csg_rule *rule)
{
    const double *v = rule->parameters;
    if (csg_blend_takes_fields(rule->kind))
        return INFINITY;
    return rule->kind == CSG_BLEND_INTERIOR ? v[0] * fmax(rule->facts.dent[0], rule->facts.dent[1])
                                            : v[0] * fmax(0.25, rule->most_excess);
}

double csg_rule_slope(const csg_rule *rule, bool is_union, const double *slopes, size_t count)
{
    double most = 0, sum = 0, n = rule->parameters[0], power = 0, partials[2];
    for (size_t i = 0; i < count; i++) {
        most = fmax(most, slopes[i]);
        sum += slopes[i];
    }
    for (size_t i = 0; i < count && most > 0; i++)
        power += csg_pow(slopes[i] / most, n);
    switch ((csg_blend_kind)rule->kind) {
    case CSG_BLEND_SOFT_SUM:
    case CSG_BLEND_PERLIN:
        return sum;
    case CSG_BLEND_SOFT_SET:
        return sum * 4 / 3;
    case CSG_BLEND_RICCI: /* Hoelder's inequality on its partial derivatives */
        return is_union ? most * csg_pow(power, 1 / n) : most;
    case CSG_BLEND_ARC: /* convex and homogeneous: grad G(P) . Q <= G(Q) (operators.md 0) */
        if (is_union && count == 2 && !rule->spline.count)
            return csg_rule_apply(rule, true, slopes, 2, 0, partials);
        return most * rule->k[!is_union];
    case CSG_BLEND_ARC_SHARP: /* a point of the unit circle, divided by more than 1 (5.6) */
        return fmin(most * rule->k[!is_union],
                    count == 2 ? csg_hypot(slopes[0], slopes[1]) : INFINITY);
    case CSG_BLEND_EXTERIOR:
    case CSG_BLEND_INTERIOR:
    case CSG_BLEND_PROFILE:
    case CSG_BLEND_SCALE_SET:
    case CSG_BLEND_FIELD_SHARP:
#define CSG_BLEND(NAME, name, area, raw, support, excess, smooth, convex, doc)                     \
    case CSG_BLEND_##NAME:
#include "scene/operators/operators.def"
    case CSG_BLEND_ORTHOGONAL:
    case CSG_BLEND_END:
        break;
    }
    return most * rule->k[!is_union];
}
