/* SPDX-License-Identifier: MIT
 * Building nodes whose value is a formula of their operands' values.
 */
#include <math.h>

#include "scene/formula/formula.h"
#include "scene/operators/combine.h"
#include "scene/tree/build_private.h"
#include "scene/tree/check.h"

static bool check_combine(csg_scene_builder *builder, const csg_formula_step *steps, uint32_t count,
                          double slope, const csg_node_id *children, size_t child_count)
{
    csg_box all = csg_box_all();
    if (builder->status != CSGM_OK || !csg_check_field(builder, steps, count, all, slope))
        return false;
    if (child_count < 1 || child_count > CSG_COMBINE_MOST) {
        csg_check_fail(builder, CSGM_ERR_SCENE, "it combines one to %d solids, not %zu",
                       CSG_COMBINE_MOST, child_count);
        return false;
    }
    for (size_t i = 0; i < child_count; i++)
        if (!csg_build_is_usable(builder, children[i]))
            return false;
    return true;
}

csg_node_id csg_build_combine_known(csg_scene_builder *builder, const csg_formula_step *steps,
                                    uint32_t count, double slope, const csg_node_id *children,
                                    size_t child_count, csg_span where)
{
    csg_formula formula = {.count = count, .lipschitz = fmax(slope, 1), .bounds = csg_box_all()};
    if (!check_combine(builder, steps, count, slope, children, child_count))
        return CSG_NODE_NONE;
    if (!csg_build_reserve_node(builder) || !csg_build_reserve_children(builder, child_count) ||
        !csg_build_append_formula(builder, steps, &formula))
        return CSG_NODE_NONE;
    csg_node node = {.kind = CSG_NODE_COMBINE,
                     .payload = (uint32_t)builder->scene->formula_count - 1,
                     .where = where};
    return csg_build_append(builder, node, children, child_count);
}

/* ---- what sharp operators say ------------------------------------------------------------------
 * A largest or least of operands, each of which is named once, is a union or an intersection, and
 * min(a, -b) a difference: the same values, and all that is known of those (pruning, cones, their
 * planes) holds.
 */

typedef struct sharp_formula {
    csg_scene_builder *builder; /* NULL: it is only looked at */
    const csg_formula_step *steps;
    const csg_node_id *children;
    size_t child_count;
    uint32_t named[CSG_COMBINE_MOST]; /* how often */
    csg_span where;
    bool is_sharp;
} sharp_formula;

static csg_node_id sharpen(sharp_formula *f, uint32_t at);

/* Of two operands; of a least one of them may be negated. */
static csg_node_id sharpen_pair(sharp_formula *f, const csg_formula_step *step)
{
    uint32_t of[2] = {step->a, step->b};
    csg_node_kind kind = CSG_NODE_UNION;
    if (step->op == CSG_FORMULA_MIN) {
        bool first = f->steps[of[0]].op == CSG_FORMULA_NEG;
        uint32_t kept = of[first ? 1 : 0], other = of[first ? 0 : 1];
        bool cuts = f->steps[other].op == CSG_FORMULA_NEG;
        kind = cuts ? CSG_NODE_DIFFERENCE : CSG_NODE_INTERSECTION;
        of[0] = kept;
        of[1] = cuts ? f->steps[other].a : other;
    }
    csg_node_id made[2];
    for (int k = 0; k < 2; k++) {
        made[k] = sharpen(f, of[k]);
        if (!f->is_sharp || (f->builder && made[k] == CSG_NODE_NONE))
            return CSG_NODE_NONE;
    }
    return f->builder ? csg_build_operator(f->builder, kind, CSG_SHARP, made, 2, f->where)
                      : CSG_NODE_NONE;
}

/* The node of a step. Not sharp: another operation, or an operand a second time. */
static csg_node_id sharpen(sharp_formula *f, uint32_t at)
{
    const csg_formula_step *step = &f->steps[at];
    if (step->op == CSG_FORMULA_MAX || step->op == CSG_FORMULA_MIN)
        return sharpen_pair(f, step);
    bool is_operand = step->op >= CSG_FORMULA_X && step->op <= CSG_FORMULA_Z;
    size_t child = is_operand ? csg_formula_variable_of(step) : f->child_count;
    f->is_sharp = child < f->child_count && f->named[child]++ == 0;
    return f->is_sharp ? f->children[child] : CSG_NODE_NONE;
}

/* Whether all operands are named, none of which is soft: operators compare the fields of these. */
static bool is_sharp(sharp_formula *f, const csgm_scene *scene, uint32_t count)
{
    f->is_sharp = true;
    (void)sharpen(f, count - 1);
    for (size_t i = 0; i < f->child_count && f->is_sharp; i++)
        f->is_sharp = f->named[i] == 1 && !(scene->nodes[f->children[i]].flags & CSG_FLAG_SOFT);
    return f->is_sharp && f->child_count > 1;
}

/* Which values the operands take together is not known, so that nothing refutes a slope. */
csg_node_id csg_build_combine(csg_scene_builder *builder, const csg_formula_step *steps,
                              uint32_t count, double slope, const csg_node_id *children,
                              size_t child_count, csg_span where)
{
    if (!check_combine(builder, steps, count, slope, children, child_count))
        return CSG_NODE_NONE;
    double bound = csg_formula_partials_sum(&builder->context->memory, steps, count);
    if (isnan(bound))
        return csg_build_no_memory(builder);
    bool told = bound <= 1e12;
    if (!told && slope == 0) {
        csg_check_fail(builder, CSGM_ERR_SCENE,
                       "how steep the formula gets cannot be told; give lipschitz =");
        return CSG_NODE_NONE;
    }
    sharp_formula sharp = {
        .steps = steps, .children = children, .child_count = child_count, .where = where};
    if (slope <= 1 && is_sharp(&sharp, builder->scene, count)) {
        sharp = (sharp_formula){builder, steps, children, child_count, {0}, where, true};
        return sharpen(&sharp, count - 1);
    }
    if (told && bound > slope * (1 + 1e-9)) /* rounding of a constant that it gave before */
        slope = bound;
    return csg_build_combine_known(builder, steps, count, slope, children, child_count, where);
}
