/* SPDX-License-Identifier: MIT
 * Blends and rules as kinds: the rows of operators.def. blend.h has their facts, blends.h the
 * formulas of those that one length describes, rule.h the rules.
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

#endif
