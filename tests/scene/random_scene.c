/* SPDX-License-Identifier: MIT
 * See random_scene.h. Leaves are placed first, then groups of two to five of what there is are
 * joined until one solid is left.
 */
#include "random_scene.h"

#include <stdlib.h>
#include <string.h>

#include "random_blend.h"
#include "random_rule.h"
#include "scene/operators/rule.h"
#include "scene/operators/soft.h"
#include "scene/primitives/kinds.h"
#include "scene/primitives/primitive.h"
#include "scene/warp_kinds.h"

enum { MOST_OPERANDS = 5, MOST_LEAVES = 1024 };

static const csg_span nowhere = {.source = UINT32_MAX};

static double uniform(csg_random *random, double low, double high)
{
    return csg_random_uniform(random, low, high);
}

static bool chance(csg_random *random, double probability)
{
    return uniform(random, 0, 1) < probability;
}

static csg_vec3 random_direction(csg_random *random)
{
    for (;;) {
        csg_vec3 v = {uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1)};
        double length = csg_vec3_norm(v);
        if (length > 0.1 && length < 1)
            return csg_vec3_normalize(v);
    }
}

csg_affine test_random_affine(csg_random *random, double low, double high, double shift)
{
    csg_vec3 axis = random_direction(random);
    csg_affine turn = csg_affine_rotate(uniform(random, -180, 180), axis);
    csg_vec3 factors = {uniform(random, low, high), uniform(random, low, high),
                        uniform(random, low, high)};
    csg_affine a = csg_affine_multiply(turn, csg_affine_scale(factors));
    for (int i = 0; i < 3; i++)
        a.t[i] = uniform(random, -shift, shift);
    return a;
}

void test_random_parameters(csg_random *random, csg_primitive_kind kind, double *v)
{
    csg_primitive_of(kind)->example(random, v);
}

csg_node_id test_random_primitive(csg_scene_builder *builder, csg_random *random,
                                  csg_primitive_kind kind, double *parameters)
{
    double v[CSG_PRIMITIVE_MOST_PARAMETERS] = {0};
    test_random_parameters(random, kind, v);
    if (parameters)
        memcpy(parameters, v, csg_primitive_parameter_count(kind) * sizeof *v);
    return csg_build_primitive(builder, kind, v, nowhere);
}

csg_primitive_kind test_random_solid_kind(csg_random *random)
{
    csg_node_kind kinds[32];
    const unsigned wanted = CSG_TRAIT_BOUNDED | CSG_TRAIT_OUTSIDE;
    const unsigned others = CSG_TRAIT_FLAT | CSG_TRAIT_CURVE;
    uint32_t count = 0;
    for (csg_primitive_kind kind = CSG_NODE_FIRST_PRIMITIVE; kind < CSG_NODE_PRIMITIVES_END; kind++)
        if ((csg_primitive_of(kind)->traits & (wanted | others)) == wanted)
            kinds[count++] = kind;
    return kinds[csg_random_below(random, count)];
}

csg_blend test_random_blend(csg_random *random, csg_blend_kind kind)
{
    if (kind == CSG_BLEND_SHARP)
        return (csg_blend){CSG_BLEND_SHARP, 0, false};
    if (isinf(csg_blend_support((csg_blend){kind, 1, false}))) /* an area */
        return (csg_blend){kind, uniform(random, 0.0005, 0.01), false};
    double width = csg_blend_raw(kind, uniform(random, 0.03, 0.35));
    bool is_number = kind == CSG_BLEND_ROUND && (uint32_t)(width * 1e6) % 2; /* every other one */
    return (csg_blend){kind, width, is_number};
}

bool test_random_rules = false;
bool test_has_debulge(const csgm_scene *scene)
{
    for (size_t i = 0; i < scene->rule_count; i++)
        if (scene->rules[i].kind == CSG_BLEND_SCALE_SET && scene->rules[i].parameters[3] > 0)
            return true;
    return false;
}

static double own_waver(const csgm_scene *scene, const csg_node *node, double below)
{
    const csg_rule *rule = csg_scene_rule(scene, node);
    if (below > 0 && (node->kind == CSG_NODE_SOFT || node->kind == CSG_NODE_COMBINE ||
                      (rule && csg_blend_takes_fields(rule->kind))))
        return INFINITY;
    if (node->kind == CSG_NODE_TRANSFORM)
        return below * scene->scales[node->payload];
    if (node->kind == CSG_NODE_WARP)
        return below * csg_warp_scale(&scene->warps[node->payload]);
    if (csg_node_is_fillet(node))
        return below + csg_blend_excess(csg_scene_blend(scene, node), node->child_count);
    return rule ? below * pow(fmax(rule->k[0], rule->k[1]), node->child_count - 1) : below;
}

double test_waver(const csgm_scene *scene)
{
    double *waver = calloc(scene->node_count, sizeof *waver), root;
    for (size_t i = 0; i < scene->node_count; i++) {
        const csg_node *node = &scene->nodes[i];
        double below = 0;
        for (uint32_t k = 0; k < node->child_count; k++)
            below = fmax(below, waver[csg_scene_children(scene, node)[k]]);
        waver[i] = own_waver(scene, node, below);
    }
    root = waver[scene->root];
    free(waver);
    return root;
}

unsigned test_times = 1;
uint64_t test_first_seed = 0;

void test_take_search(int argc, char **argv)
{
    static const uint64_t APART =
        60000; /* a multiple of every period in which seeds decide about scenes */
    if (argc > 1)
        test_times = (unsigned)atoi(argv[1]);
    if (argc > 2)
        test_first_seed = APART * strtoull(argv[2], NULL, 10);
}

/* A rule of this kind with random parameters, not settled. */
static csg_rule random_rule(csg_random *random, csg_blend_kind kind)
{
    csg_rule rule = csg_rule_standard(kind);
    double *v = rule.parameters;
    if (csg_blend_takes_fields(kind)) /* what is soft may have no size that is known */
        rule.range = uniform(random, 0.1, 0.6);
    if (!csg_blend_takes_fields(kind))
        rule.step = test_random_step(random, (test_step_ranges){12, 6, 4});
    if (kind == CSG_BLEND_EXTERIOR) {
        v[0] = uniform(random, 0.02, 0.2);
        char text[160];
        v[1] = v[0] * uniform(random, 0.1, 1.7);
        if (csg_rule_problem(&rule, text, sizeof text)) /* too wide for the step */
            v[1] = v[0];
    } else if (kind == CSG_BLEND_INTERIOR) {
        v[0] = uniform(random, 0.03, 0.35);
    } else if (kind == CSG_BLEND_RICCI) {
        v[0] = uniform(random, 1, 6);
    } else if (kind == CSG_BLEND_SCALE_SET) {
        v[3] = chance(random, 0.7) ? 0 : uniform(random, 0.05, 0.5);
        v[0] = uniform(random, 0.1, 0.5);
        v[1] = uniform(random, 0.1, 0.5);
        v[2] = v[0] * v[1] * uniform(random, -2, 0.9);
    } else if (kind == CSG_BLEND_ARC) {
        v[0] = uniform(random, 2, 40);
        v[1] = uniform(random, 50, 88);
        test_random_profile(random, &rule, 0.85, 1.1);
    }
    return rule;
}

/* Of every kind that the language has, a profile not among them. */
static csg_blend any_rule(csg_scene_builder *builder, csg_random *random)
{
    csg_blend_kind kind = CSG_BLEND_PROFILE;
    while (kind == CSG_BLEND_PROFILE || kind == CSG_BLEND_FIELD_SHARP)
        kind = CSG_BLEND_EXTERIOR + csg_random_below(random, CSG_BLEND_END - CSG_BLEND_EXTERIOR);
    csg_rule rule = random_rule(random, kind);
    return csg_build_rule(builder, &rule);
}

static csg_blend any_blend(csg_scene_builder *builder, csg_random *random)
{
    csg_blend_kind kind = CSG_BLEND_SHARP;
    if (test_random_rules && chance(random, 0.35))
        return any_rule(builder, random);
    if (chance(random, 0.75))
        kind = (csg_blend_kind)csg_random_below(random, CSG_BLEND_FILLET);
    if (test_random_fillets && chance(random, 0.6))
        kind = CSG_BLEND_FILLET;
    return test_random_blend(random, kind);
}

static csg_node_kind any_operator(csg_random *random)
{
    double x = uniform(random, 0, 1);
    return x < 0.6 ? CSG_NODE_UNION : x < 0.85 ? CSG_NODE_DIFFERENCE : CSG_NODE_INTERSECTION;
}

static csg_node_id colored(csg_scene_builder *builder, csg_random *random, csg_node_id node)
{
    if (node == CSG_NODE_NONE || !chance(random, 0.2))
        return node;
    csg_color color = {(float)uniform(random, 0, 1), (float)uniform(random, 0, 1),
                       (float)uniform(random, 0, 1), 1};
    return csg_build_color(builder, color, node, nowhere);
}

bool test_random_shapes = false;

bool test_random_curves = false;
bool test_random_fillets = false;

static csg_node_id random_tube(csg_scene_builder *builder, csg_random *random)
{
    csg_primitive_kind kind = chance(random, 0.3) ? CSG_NODE_QUADRATIC_TUBE : CSG_NODE_CUBIC_TUBE;
    return test_random_primitive(builder, random, kind, NULL);
}

/* A bounded primitive somewhere, one in eight of them cut by a half-space. */
static csg_node_id random_leaf(csg_scene_builder *builder, csg_random *random)
{
    csg_primitive_kind kind = test_random_solid_kind(random);
    bool shaped = test_random_shapes && chance(random, 0.25);
    if (test_random_rules && chance(random, 0.1))
        kind = CSG_NODE_SUPERELLIPSOID;
    csg_node_id node = shaped ? test_random_shaped(builder, random)
                              : test_random_primitive(builder, random, kind, NULL);
    if (test_random_curves && chance(random, 0.12))
        node = random_tube(builder, random);
    if (test_random_rules && chance(random, 0.35)) {
        csg_soft soft = {(csg_falloff)csg_random_below(random, CSG_FALLOFF_COUNT),
                         uniform(random, 0.15, 0.6)};
        node = csg_build_soft(builder, soft, node, nowhere);
    }
    if (chance(random, 0.125)) {
        csg_node_id cut[2] = {node, test_random_primitive(builder, random, CSG_NODE_PLANE, NULL)};
        csg_node_kind how = chance(random, 0.5) ? CSG_NODE_INTERSECTION : CSG_NODE_DIFFERENCE;
        node = csg_build_operator(builder, how, any_blend(builder, random), cut, 2, nowhere);
    }
    bool equal = chance(random, 0.5);
    double factor = uniform(random, 0.7, 1.3);
    csg_affine place = equal ? test_random_affine(random, factor, factor, 0.8)
                             : test_random_affine(random, 0.5, 1.4, 0.8);
    return colored(builder, random, csg_build_transform(builder, &place, node, nowhere));
}

csg_node_id test_random_scene(csg_scene_builder *builder, csg_random *random, unsigned primitives)
{
    csg_node_id pool[MOST_LEAVES], group[MOST_OPERANDS];
    unsigned count = primitives < 1 ? 1 : primitives > MOST_LEAVES ? MOST_LEAVES : primitives;
    for (unsigned i = 0; i < count; i++)
        pool[i] = random_leaf(builder, random);
    while (count > 1) {
        unsigned size = 2 + csg_random_below(random, MOST_OPERANDS - 1);
        if (size > count)
            size = count;
        for (unsigned i = 0; i < size; i++) {
            unsigned pick = csg_random_below(random, count);
            group[i] = pool[pick];
            pool[pick] = pool[--count];
        }
        csg_node_kind kind = count ? any_operator(random) : CSG_NODE_UNION;
        csg_node_id joined =
            csg_build_operator(builder, kind, any_blend(builder, random), group, size, nowhere);
        if (chance(random, 0.3)) {
            csg_affine place = test_random_affine(random, 0.75, 1.05, 0.15);
            joined = csg_build_transform(builder, &place, joined, nowhere);
        }
        pool[count++] = colored(builder, random, joined);
    }
    return pool[0];
}

csg_node_id test_random_mixed(csg_scene_builder *builder, csg_random *random, uint64_t i)
{
    test_random_shapes = i % 3 == 1;
    test_random_rules = i % 6 == 2;
    test_random_fillets = i % 6 == 5;
    test_random_curves = i % 12 == 3;
    return test_random_scene(builder, random, 1 + (unsigned)(i % 5));
}
