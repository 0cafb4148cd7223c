/* SPDX-License-Identifier: MIT
 * Blends and rules as kinds: the rows of operators.def, and the facts of those that one length
 * describes. blends.h has their formulas, rule.h the rules.
 */
#ifndef CSG_SCENE_BLEND_KINDS_H
#define CSG_SCENE_BLEND_KINDS_H

#include "scene/operators/blend.h"

/* Blends that one length describes; those that stand before FILLET are functions of values alone.
 */
typedef enum csg_blend_kind {
#define CSG_BLEND(NAME, name, area, raw, support, excess, smooth, convex, doc) CSG_BLEND_##NAME,
#include "scene/operators/operators.def"
    CSG_BLEND_COUNT,
    /* Intersection of fields with gradients at right angles, as of an extrusion's outline and its
     * ends: where both are negative -sqrt(a^2 + b^2), so that exact distances give an exact
     * distance. Made by csg_build_extrude only, not in the language. */
    CSG_BLEND_ORTHOGONAL = CSG_BLEND_COUNT,
#define CSG_RULE(NAME, name, space, fold, interval, demand, lipschitz, equal, doc) CSG_BLEND_##NAME,
#include "scene/operators/operators.def"
    CSG_BLEND_END
} csg_blend_kind;

static inline bool csg_blend_is_rule(csg_blend_kind kind)
{
    return kind > CSG_BLEND_ORTHOGONAL;
}
/* Whether it acts on fields in [0, 1] and gives a soft node. */
static inline bool csg_blend_takes_fields(csg_blend_kind kind)
{
    return kind > CSG_BLEND_PROFILE;
}

/* Whether its value depends on its operands' gradients, too: no formula of values says it. */
static inline bool csg_blend_is_fillet(csg_blend_kind kind)
{
    return kind == CSG_BLEND_FILLET;
}

const char *csg_blend_name(csg_blend_kind kind); /* as in the scene language */
/* n for the language's width w (operators.md 13). */
double csg_blend_raw(csg_blend_kind kind, double width);
/* chi: operands that differ by this or more do not blend; INFINITY for some, and for rules
 * (csg_scene_support). */
double csg_blend_support(csg_blend blend);
/* Largest value of G - max over `operands` operands; INFINITY for rules (csg_scene_excess). */
double csg_blend_excess(csg_blend blend, uint32_t operands);
bool csg_blend_is_fold(csg_blend_kind kind);
/* smooth and convex of operators.def; false for ORTHOGONAL and for rules. */
bool csg_blend_is_smooth(csg_blend_kind kind);
bool csg_blend_is_convex(csg_blend_kind kind);
/* The blend as a solid scaled by `factor` needs it: areas grow with its square. Rules stay as they
 * are (csg_rule_scale). */
csg_blend csg_blend_scale(csg_blend blend, double factor);

#endif
