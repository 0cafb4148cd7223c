/* SPDX-License-Identifier: MIT
 * Parameters of soft nodes and rules; see compile_rule.h.
 */
#include "field/compile/compile_rule.h"

#include <math.h>

#include "base/elementary.h"
#include "field/rule_layout.h"
#include "field/turning.h"
#include "scene/operators/soft.h"
#include "scene/operators/steps.h"

#define RADIANS (3.14159265358979323846 / 180)

bool csg_blend_turns(uint32_t kind)
{
    return kind == CSG_BLEND_TURNING;
}

bool csg_rule_works_on_complements(uint32_t kind, bool is_union)
{
    switch ((csg_blend_kind)kind) {
    case CSG_BLEND_SCALE_SET: /* made of an intersection */
        return is_union;
    case CSG_BLEND_SOFT_SUM: /* sums are made of a union */
    case CSG_BLEND_SOFT_SET:
        return !is_union;
    case CSG_BLEND_EXTERIOR:
    case CSG_BLEND_INTERIOR:
    case CSG_BLEND_PROFILE:
    case CSG_BLEND_RICCI:
    case CSG_BLEND_PERLIN:
    case CSG_BLEND_ARC:
    case CSG_BLEND_ARC_SHARP:
    case CSG_BLEND_FIELD_SHARP: /* has a formula of each */
#define CSG_BLEND(NAME, name, area, raw, support, excess, smooth, convex, doc)                     \
    case CSG_BLEND_##NAME:
#include "scene/operators/operators.def"
    case CSG_BLEND_ORTHOGONAL:
    case CSG_BLEND_END:
        break;
    }
    return false;
}

void csg_deliver_pack(csg_form form, bool flip, double scale, double shift,
                      float values[CSG_DELIVER_PARAMETERS])
{
    bool is_value = form == CSG_FORM_VALUE, turned = flip != (form == CSG_FORM_COMPLEMENT);
    double sign = (is_value ? flip : turned) ? -1 : 1;
    values[CSG_DELIVER_SCALE] = (float)(is_value ? sign * scale : sign);
    values[CSG_DELIVER_LEVEL] = is_value ? 0.5f : turned ? 1.0f : 0.0f;
    values[CSG_DELIVER_SHIFT] = is_value ? (float)shift : 0.0f;
    values[CSG_DELIVER_LOW] = is_value ? -INFINITY : 0.0f;
    values[CSG_DELIVER_HIGH] = is_value ? INFINITY : 1.0f;
    values[CSG_DELIVER_COLOR] = 0; /* known when the operands are written */
}

csg_tape_curve csg_soften_pack_soft(csg_soft soft, double factor,
                                    float values[CSG_SOFTEN_PARAMETERS])
{
    double iso = csg_falloff_iso(soft.falloff);
    values[CSG_SOFTEN_RATE] = (float)((1 - iso) / (soft.range * factor));
    values[CSG_SOFTEN_ISO] = (float)iso;
    return (csg_tape_curve)soft.falloff;
}

csg_tape_curve csg_soften_pack_operand(csg_operand operand, double factor,
                                       float values[CSG_SOFTEN_PARAMETERS])
{
    values[CSG_SOFTEN_RATE] = (float)(operand.slope / factor);
    values[CSG_SOFTEN_ISO] = 0;
    return operand.soft ? CSG_CURVE_CLAMP : CSG_CURVE_STEP;
}

/* N_S reaches 1 at m; a hair before, so that the rounding of B cannot miss it. */
static void pack_scale(const csg_rule *rule, float *values, uint32_t *kind)
{
    double r1 = rule->parameters[0], r2 = rule->parameters[1];
    double kappa = rule->parameters[2] / (r1 * r2), omega = rule->parameters[3];
    double s = omega > 0 ? 1 + omega : 1, m = csg_scale_top(r1 * s, r2 * s, kappa);
    values[CSG_SCALE_R1] = (float)r1;
    values[CSG_SCALE_R2] = (float)r2;
    values[CSG_SCALE_KAPPA] = (float)kappa;
    values[CSG_SCALE_LIFT] = (float)(r1 * r2 / (r1 + r2 + sqrt(2 * r1 * r2 * (1 - kappa))));
    values[CSG_SCALE_TOP] = (float)(m * (1 - CSG_SCALE_HAIR));
    values[CSG_SCALE_BEND] = (float)((1 - m) / ((m - 0.5) * (m - 0.5)));
    values[CSG_SCALE_OMEGA] = (float)omega;
    if (omega > 0)
        *kind = CSG_BLEND_TURNING;
}

static size_t pack_arc(const csg_rule *rule, bool is_union, float *values)
{
    values[CSG_ARC_A] = (float)csg_tan((90 - rule->parameters[1]) * RADIANS);
    values[CSG_ARC_B] = (float)csg_tan(rule->parameters[0] * RADIANS);
    values[CSG_ARC_MONOTONE] = rule->monotone[is_union ? 0 : 1];
    const csg_spline *spline = &rule->spline;
    uint32_t stretches = spline->count ? spline->count - 1 : 0;
    values[CSG_ARC_KNOTS] = (float)spline->count;
    for (uint32_t i = 0; i < stretches; i++) {
        float *stretch = values + CSG_ARC_STRETCHES + i * CSG_STRETCH_PARAMETERS;
        double width = spline->angle[i + 1] - spline->angle[i];
        stretch[CSG_STRETCH_ANGLE] = (float)spline->angle[i];
        stretch[CSG_STRETCH_INVERSE] = (float)(1 / width);
        stretch[CSG_STRETCH_FACTOR] = (float)spline->factor[i];
        stretch[CSG_STRETCH_RISE] = (float)(spline->factor[i + 1] - spline->factor[i]);
        stretch[CSG_STRETCH_SLOPE] = (float)(width * spline->slope[i]);
        stretch[CSG_STRETCH_NEXT_SLOPE] = (float)(width * spline->slope[i + 1]);
    }
    size_t count = CSG_ARC_STRETCHES + stretches * CSG_STRETCH_PARAMETERS;
    return count > CSG_SCALE_OMEGA ? count : CSG_SCALE_OMEGA + 1;
}

static void pack_smooth(const csg_rule *rule, double factor, float *values)
{
    csg_rule scaled = csg_rule_scale(rule, factor);
    const csg_step_facts *facts = &rule->facts;
    bool exterior = rule->kind == CSG_BLEND_EXTERIOR;
    values[CSG_SMOOTH_STEP] = (float)rule->step.kind;
    values[CSG_SMOOTH_DEGREE] = (float)rule->step.parameter;
    values[CSG_SMOOTH_DELTA] = exterior ? (float)scaled.parameters[0] : 0;
    values[CSG_SMOOTH_EPS] = (float)scaled.parameters[exterior ? 1 : 0];
    values[CSG_SMOOTH_REACH] = (float)csg_step_reach(rule->step);
    values[CSG_SMOOTH_EVEN] = rule->step.kind != CSG_STEP_RISING;
    values[CSG_SMOOTH_K] = (float)fmax(rule->k[0], rule->k[1]);
    for (int side = 0; side < 2; side++) {
        values[CSG_SMOOTH_DENT + side] = (float)facts->dent[side];
        values[CSG_SMOOTH_DENT_AT + side] = (float)facts->dent_at[side];
        values[CSG_SMOOTH_BUMP + side] = (float)facts->bump[side];
        values[CSG_SMOOTH_BUMP_AT + side] = (float)facts->bump_at[side];
    }
}

size_t csg_rule_pack(const csg_rule *rule, bool is_union, double factor, double support,
                     uint32_t *kind, float values[CSG_RULE_MOST_PARAMETERS])
{
    *kind = rule->kind;
    values[CSG_OPERATOR_N] = 0;
    values[CSG_OPERATOR_SUPPORT] = (float)(support * factor);
    switch ((csg_blend_kind)rule->kind) {
    case CSG_BLEND_EXTERIOR:
    case CSG_BLEND_INTERIOR:
        pack_smooth(rule, factor, values);
        return CSG_SMOOTH_PARAMETERS;
    case CSG_BLEND_RICCI:
        values[CSG_RICCI_EXPONENT] = (float)rule->parameters[0];
        return CSG_SCALE_OMEGA + 1;
    case CSG_BLEND_SCALE_SET:
        pack_scale(rule, values, kind);
        return CSG_SCALE_OMEGA + 1;
    case CSG_BLEND_ARC:
        return pack_arc(rule, is_union, values);
    case CSG_BLEND_SOFT_SUM:
    case CSG_BLEND_SOFT_SET:
    case CSG_BLEND_PERLIN:
    case CSG_BLEND_ARC_SHARP:
    case CSG_BLEND_FIELD_SHARP:
    case CSG_BLEND_PROFILE:
#define CSG_BLEND(NAME, name, area, raw, support, excess, smooth, convex, doc)                     \
    case CSG_BLEND_##NAME:
#include "scene/operators/operators.def"
    case CSG_BLEND_ORTHOGONAL:
    case CSG_BLEND_END:
        break; /* none of its own; kernels read the scale function's wherever there is none */
    }
    return CSG_SCALE_OMEGA + 1;
}
