/* SPDX-License-Identifier: MIT
 * Names and numbers of blends, read out of operators.def.
 */
#include "scene/operators/blend_kinds.h"

#include <assert.h>
#include <math.h>

#include "scene/operators/rule.h"

typedef struct blend_row {
    const char *name;
    double raw, support, excess;
    bool area, fold, smooth, convex;
} blend_row;

static const blend_row blends[CSG_BLEND_COUNT] = {
#define CSG_BLEND(NAME, name, area, raw, support, excess, smooth, convex, doc)                     \
    [CSG_BLEND_##NAME] = {#name, raw, support, excess, area, false, smooth, convex},
#define CSG_FOLD(NAME, name, area, raw, support, excess, smooth, convex, doc)                      \
    [CSG_BLEND_##NAME] = {#name, raw, support, excess, area, true, smooth, convex},
#include "scene/operators/operators.def"
};

csg_blend csg_blend_number(double radius)
{
    return (csg_blend){CSG_BLEND_ROUND, radius, true};
}

csg_blend csg_blend_round(double width)
{
    return (csg_blend){CSG_BLEND_ROUND, width, false};
}

csg_blend csg_blend_fillet(double radius)
{
    return (csg_blend){CSG_BLEND_FILLET, radius, false};
}

bool csg_blend_is_round(uint32_t kind)
{
    return kind == CSG_BLEND_ROUND;
}

bool csg_blend_is_profile(uint32_t kind)
{
    return kind == CSG_BLEND_PROFILE;
}

bool csg_blend_is_interior(uint32_t kind)
{
    return kind == CSG_BLEND_INTERIOR;
}

bool csg_blend_is_orthogonal(uint32_t kind)
{
    return kind == CSG_BLEND_ORTHOGONAL;
}

bool csg_blend_is_rule(uint32_t kind)
{
    return kind > CSG_BLEND_ORTHOGONAL;
}

bool csg_blend_takes_fields(uint32_t kind)
{
    return kind > CSG_BLEND_PROFILE;
}

bool csg_blend_is_fillet(uint32_t kind)
{
    return kind == CSG_BLEND_FILLET;
}

const char *csg_blend_name(uint32_t kind)
{
    assert(kind < CSG_BLEND_END);
    if (csg_blend_is_rule(kind))
        return csg_rule_name(kind);
    return kind == CSG_BLEND_ORTHOGONAL ? "orthogonal" : blends[kind].name;
}

double csg_blend_raw(uint32_t kind, double width)
{
    assert(kind < CSG_BLEND_COUNT);
    return blends[kind].raw * width;
}

double csg_blend_support(csg_blend blend)
{
    if (blend.kind == CSG_BLEND_SHARP || blend.kind == CSG_BLEND_ORTHOGONAL)
        return 0;
    if (csg_blend_is_rule(blend.kind))
        return INFINITY;
    return blends[blend.kind].support * blend.n;
}

double csg_blend_excess(csg_blend blend, uint32_t operands)
{
    if (blend.kind == CSG_BLEND_SHARP || blend.kind == CSG_BLEND_ORTHOGONAL || operands < 2)
        return 0;
    if (csg_blend_is_rule(blend.kind))
        return INFINITY;
    if (blend.kind == CSG_BLEND_ROUND)
        return blend.n * (1 - 1 / sqrt((double)operands));
    if (blend.kind == CSG_BLEND_FILLET && operands > 2)
        return blend.n;
    double two = blends[blend.kind].excess * (blends[blend.kind].area ? sqrt(blend.n) : blend.n);
    return two * (operands - 1); /* each step of the fold exceeds the one before by that much */
}

bool csg_blend_is_fold(uint32_t kind)
{
    return csg_blend_is_rule(kind) ? csg_rule_is_fold(kind) : blends[kind].fold;
}

bool csg_blend_is_smooth(uint32_t kind)
{
    return kind < CSG_BLEND_COUNT && blends[kind].smooth;
}

bool csg_blend_is_convex(uint32_t kind)
{
    return kind < CSG_BLEND_COUNT && blends[kind].convex;
}

csg_blend csg_blend_scale(csg_blend blend, double factor)
{
    if (csg_blend_is_rule(blend.kind))
        return blend;
    bool area = blend.kind < CSG_BLEND_COUNT && blends[blend.kind].area;
    blend.n *= area ? factor * factor : factor;
    return blend;
}
