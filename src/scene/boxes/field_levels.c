/* SPDX-License-Identifier: MIT
 * Level sets of fields (operators.md 4, 5, 6): {G >= t} lies within the union, or the intersection,
 * of the operands' sets {F >= t'}; see field_levels.h.
 */
#include "scene/boxes/field_levels.h"

#include "base/elementary.h"
#include "scene/operators/blend_kinds.h"
#include "scene/operators/rule.h"
#include "scene/operators/soft.h"

/* Inverses are found to this, on the safe side. */
#define ROOM 1e-12

/* The largest d with P(d) >= field, 0 < field <= 1/2. */
static double inverse_falloff(csg_falloff falloff, double field)
{
    double low = csg_falloff_iso(falloff), high = 1, slope;
    for (int i = 0; i < 60; i++) {
        double middle = (low + high) / 2;
        if (csg_falloff_at(falloff, middle, &slope) >= field)
            low = middle;
        else
            high = middle;
    }
    return high;
}

double csg_soft_level(const csgm_scene *scene, const csg_node *node, double level)
{
    csg_soft soft = csg_scene_soft(scene, node);
    double iso = csg_falloff_iso(soft.falloff);
    double field = 0.5 - level * csg_scene_parameters(scene, node)[CSG_SOFT_LAMBDA];
    if (field >= 0.5) /* the surface is the child's */
        return 0;
    field -= ROOM;
    if (!(field > 0))
        return INFINITY;
    return (inverse_falloff(soft.falloff, field) - iso) * soft.range / (1 - iso);
}

/* t >= 0 with H3(-t) = field, 0 < field <= 1/2. */
static double inverse_step(double field)
{
    double low = 0, high = 1, slope;
    for (int i = 0; i < 60; i++) {
        double middle = (low + high) / 2;
        if (csg_step_at((csg_step){CSG_STEP_POLY, 3}, -middle, &slope) >= field)
            low = middle;
        else
            high = middle;
    }
    return high;
}

/* Where a union of k is at least t, one of the operands is at least this. */
static double union_floor(const csg_rule *rule, double k, double t)
{
    const double *v = rule->parameters;
    double widest;
    switch ((csg_blend_kind)rule->kind) {
    case CSG_BLEND_RICCI:
        return t * csg_pow(k, -1 / v[0]);
    case CSG_BLEND_SOFT_SUM:
    case CSG_BLEND_SOFT_SET:
        return t / k;
    case CSG_BLEND_PERLIN:
        return 1 - csg_pow(1 - t, 1 / k);
    case CSG_BLEND_SCALE_SET:
        widest = v[3] > 0 ? 2 + v[3] : 1;
        return 1 - (1 - t) / csg_scale_top(v[0] * widest, v[1] * widest, v[2] / (v[0] * v[1]));
    case CSG_BLEND_ARC: /* homogeneous: G <= K max */
        return t / rule->k[0];
    case CSG_BLEND_ARC_SHARP: /* the same sets as max at 1/2, and little more below */
        return t >= 0.5 - 2 * ROOM ? t : fmax(t - 0.0366117, t / sqrt(2));
    case CSG_BLEND_FIELD_SHARP:
    case CSG_BLEND_EXTERIOR: /* the rest takes no fields */
    case CSG_BLEND_INTERIOR:
    case CSG_BLEND_PROFILE:
#define CSG_BLEND(NAME, name, area, raw, support, excess, smooth, convex, doc)                     \
    case CSG_BLEND_##NAME:
#include "scene/operators/operators.def"
    case CSG_BLEND_ORTHOGONAL:
    case CSG_BLEND_END:
        break;
    }
    return t;
}

/* Where an intersection is at least t <= 1/2, every operand is at least this. */
static double intersection_floor(const csg_rule *rule, double t)
{
    double most = 1;
    for (uint32_t i = 0; i + 1 < rule->spline.count; i++) { /* a bound of the cubic by its ends */
        double h = rule->spline.angle[i + 1] - rule->spline.angle[i];
        double control[4] = {rule->spline.factor[i],
                             rule->spline.factor[i] + rule->spline.slope[i] * h / 3,
                             rule->spline.factor[i + 1] - rule->spline.slope[i + 1] * h / 3,
                             rule->spline.factor[i + 1]};
        for (int k = 0; k < 4; k++)
            most = fmax(most, control[k]);
    }
    return t / most;
}

double csg_field_level(const csgm_scene *scene, const csg_node *node, uint32_t index, double level)
{
    const csg_rule *rule = csg_scene_rule(scene, node);
    csg_operand operand = csg_scene_operand(scene, node, index);
    double field = 0.5 - level * csg_scene_parameters(scene, node)[CSG_OPERATOR_LAMBDA];
    field -= level > 0 ? ROOM : 0;
    if (!(field > ROOM))
        return INFINITY;
    field = node->kind == CSG_NODE_UNION ? union_floor(rule, node->child_count, field)
                                         : intersection_floor(rule, field);
    /* where all operands are 0 the union is 0, whatever the floor says of small ones */
    field = fmax(field, 4 * ROOM);
    if (field >= 0.5)
        return 0;
    return operand.soft ? fmax(0.5 - field, 0) / operand.slope
                        : inverse_step(fmin(field, 0.5)) / operand.slope;
}

void csg_field_band(const csgm_scene *scene, const csg_node *node, uint32_t index, double *below,
                    double *above)
{
    if (node->kind == CSG_NODE_SOFT) {
        csg_soft soft = csg_scene_soft(scene, node);
        double iso = csg_falloff_iso(soft.falloff);
        *below = soft.range;
        *above = soft.range * iso / (1 - iso);
        return;
    }
    csg_operand operand = csg_scene_operand(scene, node, index);
    *below = *above = (operand.soft ? 0.5 : 1) / operand.slope;
}
