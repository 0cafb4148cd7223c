/* SPDX-License-Identifier: MIT
 * Solids made of figures of the plane and of warps; see random_scene.h.
 */
#include "random_scene.h"

static const csg_span nowhere = {.source = UINT32_MAX};

static double uniform(csg_random *random, double low, double high)
{
    return csg_random_uniform(random, low, high);
}

static bool chance(csg_random *random, double probability)
{
    return uniform(random, 0, 1) < probability;
}

/* A rectangle or a disc within [-0.8, 0.8]^2 or, `aside`, at x > 0. */
static csg_node_id figure(csg_scene_builder *builder, csg_random *random, bool aside)
{
    double v[3] = {uniform(random, 0.1, 0.4), uniform(random, 0.1, 0.4), 0};
    bool disc = chance(random, 0.4);
    if (!disc && chance(random, 0.5))
        v[2] = uniform(random, 0, fmin(v[0], v[1]));
    csg_node_id node =
        csg_build_primitive(builder, disc ? CSG_NODE_CIRCLE : CSG_NODE_RECTANGLE, v, nowhere);
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
                                    : (csg_blend_kind)csg_random_below(random, CSG_BLEND_COUNT));
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

static csg_node_id solid(csg_scene_builder *builder, csg_random *random)
{
    csg_node_kind kind = CSG_NODE_SPHERE + csg_random_below(random, 6);
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

csg_node_id test_random_shaped(csg_scene_builder *builder, csg_random *random)
{
    csg_node_id node;
    switch (csg_random_below(random, 7)) {
    case 0:
        return extrusion(builder, random, flat(builder, random, false));
    case 1:
        node = extrusion(builder, random, flat(builder, random, false));
        return csg_build_offset(builder, uniform(random, -0.05, 0.15), node, nowhere);
    case 2:
        return warped(builder, (csg_warp){CSG_WARP_REVOLVE, {0}}, flat(builder, random, true));
    case 3:
        node = warped(builder, random_twist(random), flat(builder, random, false));
        return extrusion(builder, random, node);
    case 4:
        return warped(builder, random_twist(random), solid(builder, random));
    case 5:
        return warped(builder, (csg_warp){CSG_WARP_BEND, {uniform(random, 2.6, 4)}},
                      solid(builder, random));
    default:
        return slice(builder, random);
    }
}
