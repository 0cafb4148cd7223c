/* SPDX-License-Identifier: MIT
 * Solids made of figures of the plane and of warps; see random_scene.h.
 */
#include "random_blend.h"
#include "random_scene.h"
#include "scene/formula/formula.h"
#include "scene/operators/blend_kinds.h"
#include "scene/primitives/kinds.h"
#include "scene/warp_kinds.h"
#include "shape/plane/region.h"

static const csg_span nowhere = {.source = UINT32_MAX};

static double uniform(csg_random *random, double low, double high)
{
    return csg_random_uniform(random, low, high);
}

static bool chance(csg_random *random, double probability)
{
    return uniform(random, 0, 1) < probability;
}

bool test_random_outlines = false;

/* A star of up to some hundred segments, its radii between inner and outer. */
static csg_node_id star(csg_scene_builder *builder, csg_random *random)
{
    enum { MOST = 400 };
    csg_memory *memory = &builder->context->memory;
    csg_vec2 points[MOST];
    uint32_t count = 3 + csg_random_below(random, chance(random, 0.5) ? 20 : MOST - 3);
    double inner = uniform(random, 0.05, 0.35);
    for (uint32_t i = 0; i < count; i++) {
        double angle = 6.283185307179586 * (double)i / (double)count;
        double radius = uniform(random, inner, 0.4);
        points[i] = (csg_vec2){radius * cos(angle), radius * sin(angle)};
    }
    uint32_t end = count;
    csg_outline outline = {
        .memory = memory, .points = points, .ends = &end, .point_count = count, .loop_count = 1};
    csg_shape *shape;
    if (csg_region_create(memory, &outline, &shape) != CSGM_OK)
        return CSG_NODE_NONE;
    return csg_build_shape(builder, shape, nowhere);
}

/* A rectangle or a disc within [-0.8, 0.8]^2 or, `aside`, at x > 0. */
static csg_node_id figure(csg_scene_builder *builder, csg_random *random, bool aside)
{
    double v[3] = {uniform(random, 0.1, 0.4), uniform(random, 0.1, 0.4), 0};
    bool disc = chance(random, 0.4);
    if (!disc && chance(random, 0.5))
        v[2] = uniform(random, 0, fmin(v[0], v[1]));
    csg_node_id node =
        test_random_outlines
            ? star(builder, random)
            : csg_build_primitive(builder, disc ? CSG_NODE_CIRCLE : CSG_NODE_RECTANGLE, v, nowhere);
    double angle = aside ? 0 : uniform(random, -180, 180);
    csg_affine place = csg_affine_rotate(angle, csg_vec3_make(0, 0, 1));
    if (chance(random, 0.3))
        place = csg_affine_multiply(
            place,
            csg_affine_scale(csg_vec3_make(uniform(random, 0.6, 1), uniform(random, 0.6, 1), 1)));
    place.t[0] = aside ? uniform(random, 0.45, 0.8) : uniform(random, -0.3, 0.3);
    place.t[1] = uniform(random, -0.3, 0.3);
    return csg_build_transform(builder, &place, node, nowhere);
}

/* One to three figures, joined, blended or not. */
static csg_node_id flat(csg_scene_builder *builder, csg_random *random, bool aside)
{
    csg_node_id figures[3];
    unsigned count = 1 + csg_random_below(random, 3);
    for (unsigned i = 0; i < count; i++)
        figures[i] = figure(builder, random, aside);
    csg_node_kind kind = chance(random, 0.7) ? CSG_NODE_UNION : CSG_NODE_DIFFERENCE;
    csg_blend blend = test_random_blend(
        random, chance(random, 0.5) ? CSG_BLEND_SHARP
                                    : (csg_blend_kind)csg_random_below(random, CSG_BLEND_FILLET));
    csg_node_id node = csg_build_operator(builder, kind, blend, figures, count, nowhere);
    return chance(random, 0.2)
               ? csg_build_offset(builder, uniform(random, -0.05, 0.1), node, nowhere)
               : node;
}

static csg_node_id extrusion(csg_scene_builder *builder, csg_random *random, csg_node_id node)
{
    double low = uniform(random, -0.6, 0);
    return csg_build_extrude(builder, node, low, low + uniform(random, 0.2, 0.9), nowhere);
}

static csg_node_id warped(csg_scene_builder *builder, csg_warp warp, csg_node_id node)
{
    return csg_build_warp(builder, &warp, node, nowhere);
}

static csg_warp random_twist(csg_random *random)
{
    return (csg_warp){
        CSG_WARP_TWIST,
        {uniform(random, -120, 120), uniform(random, -0.8, -0.2), uniform(random, 0, 1)}};
}

static csg_warp random_taper(csg_random *random)
{
    return (csg_warp){CSG_WARP_TAPER,
                      {uniform(random, -120, 120), uniform(random, -0.8, -0.2),
                       uniform(random, 0, 1), uniform(random, 0.3, 2), uniform(random, 0.3, 2)}};
}

static csg_warp random_twist_or_taper(csg_random *random)
{
    return chance(random, 0.5) ? random_twist(random) : random_taper(random);
}

static csg_node_id solid(csg_scene_builder *builder, csg_random *random)
{
    csg_primitive_kind kind = test_random_solid_kind(random);
    return test_random_primitive(builder, random, kind, NULL);
}

/* A plate in the plane z = 0 of some solid. */
static csg_node_id slice(csg_scene_builder *builder, csg_random *random)
{
    csg_node_id node = solid(builder, random);
    csg_affine place = test_random_affine(random, 0.8, 1.2, 0.1);
    node = csg_build_transform(builder, &place, node, nowhere);
    return extrusion(builder, random, warped(builder, (csg_warp){CSG_WARP_SLICE, {0}}, node));
}

typedef struct terms {
    csg_formula_builder builder;
} terms;

static csg_formula_id apply(terms *t, csg_formula_op op, csg_formula_id a, csg_formula_id b)
{
    return csg_formula_apply(&t->builder, op, a, b);
}

/* A smooth maximum of two, (a + b + sqrt((a - b)^2 + e)) / 2, or of three a maximum less a part of
 * the third: steep, not monotone, or both. */
static csg_formula_id random_formula(terms *t, csg_random *random, bool three)
{
    csg_formula_id a = apply(t, CSG_FORMULA_X, 0, 0), b = apply(t, CSG_FORMULA_Y, 0, 0);
    if (three) {
        csg_formula_id c = apply(t, CSG_FORMULA_Z, 0, 0);
        csg_formula_id part = csg_formula_constant(&t->builder, uniform(random, 0.2, 0.6));
        csg_formula_id less = apply(t, CSG_FORMULA_MUL, part, apply(t, CSG_FORMULA_ABS, c, c));
        return apply(t, CSG_FORMULA_SUB, apply(t, CSG_FORMULA_MAX, a, b), less);
    }
    csg_formula_id d = apply(t, CSG_FORMULA_SUB, a, b);
    csg_formula_id e = csg_formula_constant(&t->builder, uniform(random, 0.001, 0.02));
    csg_formula_id under = apply(t, CSG_FORMULA_ADD, apply(t, CSG_FORMULA_MUL, d, d), e);
    csg_formula_id sum = apply(t, CSG_FORMULA_ADD, apply(t, CSG_FORMULA_ADD, a, b),
                               apply(t, CSG_FORMULA_SQRT, under, under));
    return apply(t, CSG_FORMULA_MUL, csg_formula_constant(&t->builder, 0.5), sum);
}

enum { MOST_COMBINED = 8 };

/* Of four and more: (sum of all + sqrt(e + sum of squares of neighbours' differences) + a maximum
 * of a first and a last) / count; steep by several, not monotone. */
static csg_formula_id random_wide_formula(terms *t, csg_random *random, uint32_t count)
{
    csg_formula_id v[MOST_COMBINED];
    csg_formula_id under = csg_formula_constant(&t->builder, uniform(random, 0.001, 0.02));
    for (uint32_t k = 0; k < count; k++)
        v[k] = csg_formula_variable(&t->builder, k);
    csg_formula_id sum = apply(t, CSG_FORMULA_MAX, v[0], v[count - 1]);
    for (uint32_t k = 0; k < count; k++) {
        csg_formula_id d = apply(t, CSG_FORMULA_SUB, v[k], v[(k + 1) % count]);
        under = apply(t, CSG_FORMULA_ADD, under, apply(t, CSG_FORMULA_MUL, d, d));
        sum = apply(t, CSG_FORMULA_ADD, sum, v[k]);
    }
    sum = apply(t, CSG_FORMULA_ADD, sum, apply(t, CSG_FORMULA_SQRT, under, under));
    return apply(t, CSG_FORMULA_MUL, csg_formula_constant(&t->builder, 1.0 / count), sum);
}

/* Solids to combine, each placed anyhow. */
static void make_operands(csg_scene_builder *builder, csg_random *random, uint32_t count,
                          csg_node_id *operands)
{
    for (uint32_t k = 0; k < count; k++) {
        csg_affine place = test_random_affine(random, 0.6, 1.2, 0.3);
        operands[k] = csg_build_transform(builder, &place, solid(builder, random), nowhere);
    }
}

static csg_node_id combined_wide(csg_scene_builder *builder, csg_random *random)
{
    terms t;
    csg_formula_step steps[128];
    csg_node_id operands[MOST_COMBINED];
    uint32_t count = 4 + csg_random_below(random, MOST_COMBINED - 3);
    make_operands(builder, random, count, operands);
    csg_formula_begin(&t.builder, &builder->context->memory);
    csg_formula_id result = random_wide_formula(&t, random, count);
    uint32_t step_count = csg_formula_collect(&t.builder, result, steps);
    csg_formula_end(&t.builder);
    double half[4] = {1.2, 1.2, 1.2, 0};
    csg_node_id cut[2] = {
        csg_build_combine(builder, steps, step_count, 0, operands, count, nowhere),
        csg_build_primitive(builder, CSG_NODE_BOX, half, nowhere)};
    return csg_build_operator(builder, CSG_NODE_INTERSECTION,
                              (csg_blend){CSG_BLEND_SHARP, 0, false}, cut, 2, nowhere);
}

static csg_node_id combined(csg_scene_builder *builder, csg_random *random)
{
    terms t;
    csg_formula_step steps[64];
    bool three = chance(random, 0.4);
    csg_node_id operands[3];
    make_operands(builder, random, 3, operands);
    csg_formula_begin(&t.builder, &builder->context->memory);
    csg_formula_id result = random_formula(&t, random, three);
    uint32_t count = csg_formula_collect(&t.builder, result, steps);
    csg_formula_end(&t.builder);
    csg_node_id node =
        csg_build_combine(builder, steps, count, 0, operands, three ? 3 : 2, nowhere);
    if (!three)
        return node;
    double half[4] = {1.2, 1.2, 1.2, 0}; /* of |c| no trend is known, and so no box */
    csg_node_id cut[2] = {node, csg_build_primitive(builder, CSG_NODE_BOX, half, nowhere)};
    return csg_build_operator(builder, CSG_NODE_INTERSECTION,
                              (csg_blend){CSG_BLEND_SHARP, 0, false}, cut, 2, nowhere);
}

/* Its straight ends are cut: random solids are finite. */
static csg_node_id elbow(csg_scene_builder *builder, csg_random *random, csg_node_id figure)
{
    const csg_warp warp = {CSG_WARP_ELBOW, {uniform(random, 5, 85)}};
    const csg_box room = {{-1.5, -1.5, -3}, {3, 1.5, 3}};
    csg_node_id node = warped(builder, warp, figure);
    return node == CSG_NODE_NONE ? node : csg_build_cut(builder, node, room, nowhere);
}

csg_node_id test_random_shaped(csg_scene_builder *builder, csg_random *random)
{
    csg_node_id node;
    switch (csg_random_below(random, 8)) {
    case 0:
        return extrusion(builder, random, flat(builder, random, false));
    case 1:
        node = extrusion(builder, random, flat(builder, random, false));
        return csg_build_offset(builder, uniform(random, -0.05, 0.15), node, nowhere);
    case 2:
        node = flat(builder, random, true);
        return csg_random_below(random, 2)
                   ? elbow(builder, random, node)
                   : warped(builder, (csg_warp){CSG_WARP_REVOLVE, {0}}, node);
    case 3:
        node = warped(builder, random_twist_or_taper(random), flat(builder, random, false));
        return extrusion(builder, random, node);
    case 4:
        return warped(builder, random_twist_or_taper(random), solid(builder, random));
    case 5:
        return warped(builder, (csg_warp){CSG_WARP_BEND, {uniform(random, 2.6, 4)}},
                      solid(builder, random));
    case 6:
        return csg_random_below(random, 2) ? combined_wide(builder, random)
                                           : combined(builder, random);
    default:
        return slice(builder, random);
    }
}
