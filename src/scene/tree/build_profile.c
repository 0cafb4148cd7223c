/* SPDX-License-Identifier: MIT
 * Blends whose profile is a formula g: max(f1, f2) + g(|f1 - f2|). What is known of g is found by
 * interval arithmetic; the operator itself is a combine node.
 */
#include "scene/formula/terms.h"
#include "scene/operators/blend_kinds.h"
#include "scene/operators/rule.h"
#include "scene/tree/build_private.h"
#include "scene/tree/check.h"

#include <string.h>

enum { PARTS = 512, HALVINGS = 48 };
/* Differences of fields beyond this are not looked at. */
#define FARTHEST 1e15
/* Intervals are widened even where they are 0. */
#define NOTHING 1e-290

typedef struct analysis {
    csg_memory *memory;
    const csg_formula_step *steps;
    uint32_t count;
    bool failed; /* out of memory */
} analysis;

static bool is_zero_beyond(analysis *a, double x)
{
    double value[2], slope[2];
    if (!csg_formula_ranges(a->memory, a->steps, a->count, x, FARTHEST, value, slope)) {
        a->failed = true;
        return false;
    }
    return fabs(value[0]) <= NOTHING && fabs(value[1]) <= NOTHING;
}

/* The smallest x from which on g is seen to be 0. */
static double find_support(analysis *a)
{
    double low = 0, high = 1e-6;
    while (high < FARTHEST && !is_zero_beyond(a, high)) {
        low = high;
        high *= 2;
    }
    if (high >= FARTHEST)
        return INFINITY;
    for (int i = 0; i < HALVINGS; i++) {
        double middle = (low + high) / 2;
        if (is_zero_beyond(a, middle))
            high = middle;
        else
            low = middle;
    }
    return high;
}

/* Over [low, high] in parts; widens *p. */
static void look(analysis *a, double low, double high, uint32_t parts, csg_profile *p)
{
    for (uint32_t i = 0; i < parts && !a->failed; i++) {
        double value[2], slope[2], width = (high - low) / parts;
        a->failed =
            !csg_formula_ranges(a->memory, a->steps, a->count, low + width * i,
                                i + 1 == parts ? high : low + width * (i + 1), value, slope);
        p->value[0] = fmin(p->value[0], value[0]);
        p->value[1] = fmax(p->value[1], value[1]);
        p->slope[0] = fmin(p->slope[0], fabs(slope[0]) > NOTHING ? slope[0] : 0);
        p->slope[1] = fmax(p->slope[1], fabs(slope[1]) > NOTHING ? slope[1] : 0);
    }
}

static csg_profile analyse(analysis *a)
{
    csg_profile p = {.support = find_support(a)};
    if (isfinite(p.support)) {
        look(a, 0, p.support, PARTS, &p);
        return p;
    }
    double from = 0; /* in parts that grow, and the rest at once */
    for (double to = 1e-3; to < FARTHEST; from = to, to *= 2)
        look(a, from, to, 8, &p);
    look(a, from, FARTHEST, 1, &p);
    return p;
}

/* The largest |1 + d| + |d|. */
static double constant_of(const csg_profile *p)
{
    double most = 1;
    for (int i = 0; i < 2; i++)
        most = fmax(most, fabs(1 + p->slope[i]) + fabs(p->slope[i]));
    return most;
}

csg_blend csg_build_profile(csg_scene_builder *builder, const csg_formula_step *steps,
                            uint32_t count, csg_profile *out)
{
    const csg_blend none = CSG_SHARP;
    const csg_box all = csg_box_all();
    if (builder->status != CSGM_OK || !csg_check_field(builder, steps, count, all, 0))
        return none;
    analysis a = {&builder->context->memory, steps, count, false};
    *out = analyse(&a);
    double k = constant_of(out);
    if (a.failed) {
        csg_build_no_memory(builder);
        return none;
    }
    if (!(k <= 1e12)) {
        csg_check_fail(builder, CSGM_ERR_SCENE,
                       "how steep the profile gets for large x cannot be told; "
                       "let it end, as max(0, 1 - x) ^ 2 does");
        return none;
    }
    csg_formula formula = {.count = count, .lipschitz = k, .bounds = all, .profile = *out};
    if (!csg_build_append_formula(builder, steps, &formula))
        return none;
    csg_rule rule = csg_rule_standard(CSG_BLEND_PROFILE);
    rule.profile = (uint32_t)builder->scene->formula_count - 1;
    return csg_build_rule(builder, &rule);
}

/* g at the term t, which stands for its x. */
static csg_term profile_at(csg_terms *terms, const csg_formula_step *steps, uint32_t count,
                           csg_term t, csg_term *made)
{
    for (uint32_t i = 0; i < count; i++) {
        const csg_formula_step *s = &steps[i];
        if (s->op == CSG_FORMULA_CONSTANT)
            made[i] = csg_formula_constant(terms, s->constant);
        else if (s->op <= CSG_FORMULA_Z)
            made[i] = s->op == CSG_FORMULA_X ? t : csg_formula_constant(terms, 0);
        else
            made[i] = csg_term_of(terms, s->op, made[s->a],
                                  csg_formula_op_is_unary(s->op) ? made[s->a] : made[s->b]);
        if (made[i] == CSG_FORMULA_NONE)
            return CSG_FORMULA_NONE;
    }
    return made[count - 1];
}

/* max(x, y) + g(|x - y|), min(x, y) - g(|x - y|), or that of y's complement. */
static csg_term joint(csg_terms *terms, csg_node_kind kind, const csg_formula_step *steps,
                      uint32_t count, csg_term *made)
{
    csg_term x = csg_formula_apply(terms, CSG_FORMULA_X, 0, 0);
    csg_term y = csg_formula_apply(terms, CSG_FORMULA_Y, 0, 0);
    if (kind == CSG_NODE_DIFFERENCE)
        y = csg_term_neg(terms, y);
    csg_term t = csg_term_abs(terms, csg_term_sub(terms, x, y));
    csg_term g = t == CSG_FORMULA_NONE ? t : profile_at(terms, steps, count, t, made);
    return kind == CSG_NODE_UNION ? csg_term_add(terms, csg_term_max(terms, x, y), g)
                                  : csg_term_sub(terms, csg_term_min(terms, x, y), g);
}

/* Behind the node's own formula: what print.c writes. */
static bool append_profile(csg_scene_builder *builder, csg_formula profile)
{
    csg_memory *memory = &builder->context->memory;
    size_t bytes = profile.count * sizeof(csg_formula_step);
    csg_formula_step *steps = csg_memory_alloc(memory, bytes); /* the scene's may move */
    if (!steps) {
        csg_build_no_memory(builder);
        return false;
    }
    memcpy(steps, builder->scene->steps + profile.first, bytes);
    bool done = csg_build_append_formula(builder, steps, &profile);
    csg_memory_release(memory, steps, bytes);
    return done;
}

static csg_node_id combined(csg_scene_builder *builder, csg_node_kind kind, csg_terms *terms,
                            csg_term result, csg_formula profile, const csg_node_id *operands,
                            csg_span where)
{
    csg_memory *memory = &builder->context->memory;
    csg_formula_step *steps = csg_memory_alloc(memory, terms->count * sizeof *steps);
    uint32_t count = steps ? csg_formula_collect(terms, result, steps) : 0;
    csg_node_id node = count ? csg_build_combine_known(builder, steps, count, profile.lipschitz,
                                                       operands, 2, where)
                             : csg_build_no_memory(builder);
    csg_memory_release(memory, steps, terms->count * sizeof *steps);
    if (node == CSG_NODE_NONE)
        return node;
    csgm_scene *scene = builder->scene;
    csg_formula *made = &scene->formulas[scene->nodes[node].payload];
    scene->nodes[node].blend = CSG_BLEND_PROFILE;
    made->profile = profile.profile;
    made->joins = (uint8_t)kind;
    return append_profile(builder, profile) ? node : CSG_NODE_NONE;
}

csg_node_id csg_build_profiled(csg_scene_builder *builder, csg_node_kind kind, csg_blend blend,
                               csg_node_id a, csg_node_id b, csg_span where)
{
    csg_memory *memory = &builder->context->memory;
    csgm_scene *scene = builder->scene;
    csg_formula profile = scene->formulas[scene->rules[(size_t)blend.n].profile];
    csg_term *made = csg_memory_alloc(memory, profile.count * sizeof *made);
    csg_terms terms;
    csg_formula_begin(&terms, memory);
    csg_term result = made ? joint(&terms, kind, scene->steps + profile.first, profile.count, made)
                           : CSG_FORMULA_NONE;
    csg_node_id node = CSG_NODE_NONE;
    if (result != CSG_FORMULA_NONE)
        node = combined(builder, kind, &terms, result, profile, (csg_node_id[]){a, b}, where);
    else if (terms.too_long)
        csg_check_fail(builder, CSGM_ERR_SCENE, "the profile has too many operations");
    else
        csg_build_no_memory(builder);
    csg_formula_end(&terms);
    csg_memory_release(memory, made, profile.count * sizeof *made);
    return node;
}
