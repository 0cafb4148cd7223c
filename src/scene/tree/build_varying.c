/* SPDX-License-Identifier: MIT
 * Operators whose blend is round by a radius r(p) that varies (operators.md 19): combine nodes of
 * two operands and the field of r, folded from the left.
 *
 * The round union of two operands that differ by x < r is the larger plus
 * s(x, r) = r - x/2 - sqrt(r^2/2 - x^2/4) >= 0, else the larger alone. By the operands its partial
 * derivatives are >= 0 and sum to 1; by r it is 1 - r / (2 sqrt(r^2/2 - x^2/4)), which falls from
 * 1 - sqrt(1/2) at x = 0 to 0 at x = r. So its constant is that of the operands plus
 * (1 - sqrt(1/2)) times that of r.
 */
#include <string.h>

#include "scene/formula/terms.h"
#include "scene/tree/build_private.h"
#include "scene/tree/check.h"

/* 1 - sqrt(1/2), rounded up. */
#define SHARE 0.2928932188134525

/* Radii below this part of the largest count as that: s has no slope by r at 0. */
#define THINNEST 1e-4

typedef struct varying {
    csg_scene_builder *builder;
    csg_node_kind kind;
    const csg_formula_step *steps; /* of the radius */
    uint32_t count;
    csg_field_domain domain;
    double range[2]; /* of the radius, by intervals */
    double slope;    /* its Lipschitz constant */
    double divisor;  /* of its field, so that the constant of that is at most 1 */
    csg_span where;
} varying;

/* The box in which the solid lies but for what a union adds; all of space where it has no end. */
static csg_box box_of(csg_scene_builder *builder, csg_node_kind kind, const csg_node_id *operands,
                      size_t count)
{
    csg_box box = csg_build_box(builder, operands[0]);
    for (size_t i = 1; i < count && kind != CSG_NODE_DIFFERENCE; i++) {
        csg_box other = csg_build_box(builder, operands[i]);
        box = kind == CSG_NODE_UNION ? csg_box_hull(box, other) : csg_box_intersect(box, other);
    }
    return csg_box_is_finite(box) ? box : csg_box_all();
}

/* False: the radius is no radius, as the problem says. */
static bool check_radius(varying *v)
{
    csg_memory *memory = &v->builder->context->memory;
    csg_box box = v->domain.bounds;
    const double room = 1e-6; /* the quotient's constant is found again, with other roundings */
    v->slope = csg_formula_lipschitz(memory, v->steps, v->count, box) * (1 + room);
    v->divisor = fmax(v->slope, 1);
    if (isnan(v->slope) || !csg_formula_values(memory, v->steps, v->count, box, v->range)) {
        csg_build_no_memory(v->builder);
        return false;
    }
    const char *where = csg_box_is_finite(box) ? "in the box of the solids" : "in all of space";
    if (!isfinite(v->range[0]) || !isfinite(v->range[1]) || !(v->slope <= 1e12))
        csg_check_fail(
            v->builder, CSGM_ERR_SCENE,
            "between what the blend's radius lies, or how steep it is, cannot be told %s", where);
    else if (v->range[0] < -1e-9 * v->range[1] || v->range[1] < 0)
        csg_check_fail(v->builder, CSGM_ERR_SCENE,
                       "the blend's radius may fall to %.4g %s; max(0, ...) keeps it from that",
                       v->range[0], where);
    return v->builder->status == CSGM_OK;
}

/* max(x, y, (x + y) / 2 + r - sqrt(r^2 + max(r^2 - (x - y)^2, 0)) / 2), its mirror image, or that
 * of y's complement; x is `scale` times the first operand, r v->divisor times the third. Written so
 * the root is of no less than the least r^2 in intervals, too, and nothing has a kink where x = y.
 */
static csg_term joint(csg_terms *t, const varying *v, double scale)
{
    csg_term x = csg_term_mul_number(t, csg_formula_apply(t, CSG_FORMULA_X, 0, 0), scale);
    csg_term y = csg_formula_apply(t, CSG_FORMULA_Y, 0, 0);
    csg_term r = csg_term_mul_number(t, csg_formula_apply(t, CSG_FORMULA_Z, 0, 0), v->divisor);
    if (v->range[0] < THINNEST * v->range[1])
        r = csg_term_max_number(t, r, THINNEST * v->range[1]);
    if (v->kind == CSG_NODE_DIFFERENCE)
        y = csg_term_neg(t, y);
    csg_term apart = csg_term_sub(t, x, y), square_of_r = csg_term_square(t, r);
    csg_term inner = csg_term_sub(t, square_of_r, csg_term_square(t, apart));
    csg_term under = csg_term_add(t, square_of_r, csg_term_max_number(t, inner, 0));
    csg_term s = csg_term_sub(t, r, csg_term_mul_number(t, csg_term_sqrt(t, under), 0.5));
    csg_term middle = csg_term_mul_number(t, csg_term_add(t, x, y), 0.5);
    return v->kind == CSG_NODE_UNION
               ? csg_term_max(t, csg_term_max(t, csg_term_add(t, middle, s), x), y)
               : csg_term_min(t, csg_term_min(t, csg_term_sub(t, middle, s), x), y);
}

static csg_node_id radius_field(const varying *v)
{
    csg_scene_builder *builder = v->builder;
    csg_memory *memory = &builder->context->memory;
    size_t bytes = (v->count + 2) * sizeof(csg_formula_step);
    csg_formula_step *steps = csg_memory_alloc(memory, bytes);
    if (!steps)
        return csg_build_no_memory(builder);
    memcpy(steps, v->steps, v->count * sizeof *steps);
    steps[v->count] = (csg_formula_step){.op = CSG_FORMULA_CONSTANT, .constant = 1 / v->divisor};
    steps[v->count + 1] =
        (csg_formula_step){.op = CSG_FORMULA_MUL, .a = v->count - 1, .b = v->count};
    uint32_t count = v->divisor > 1 ? v->count + 2 : v->count;
    csg_node_id node = csg_build_field(builder, steps, count, &v->domain, v->where);
    csg_memory_release(memory, steps, bytes);
    return node;
}

/* Two operands, the first of which was divided by *scale; the node is divided by what *scale is
 * then. */
static csg_node_id join_two(const varying *v, csg_node_id a, csg_node_id b, double *scale)
{
    csg_scene_builder *builder = v->builder;
    csg_memory *memory = &builder->context->memory;
    csg_node_id radius = radius_field(v);
    csg_terms terms;
    if (radius == CSG_NODE_NONE)
        return radius;
    csg_formula_begin(&terms, memory);
    csg_term result = joint(&terms, v, *scale);
    csg_formula_step *steps = NULL;
    size_t bytes = terms.count * sizeof *steps;
    if (result != CSG_FORMULA_NONE)
        steps = csg_memory_alloc(memory, bytes);
    uint32_t count = steps ? csg_formula_collect(&terms, result, steps) : 0;
    *scale += SHARE * v->slope;
    csg_node_id node = count ? csg_build_combine_known(builder, steps, count, *scale,
                                                       (csg_node_id[]){a, b, radius}, 3, v->where)
                             : csg_build_no_memory(builder);
    csg_memory_release(memory, steps, bytes);
    csg_formula_end(&terms);
    return node;
}

/* A union reaches beyond its operands by less than a third of the radius for each; a combine node
 * has no box by itself. */
static csg_node_id bounded(const varying *v, csg_node_id node, csg_box box, size_t count)
{
    if (!csg_box_is_finite(box))
        return node;
    double room = v->kind == CSG_NODE_UNION ? (double)(count - 1) * v->range[1] / 2 : 0;
    double size = csg_box_longest_side(box);
    return csg_build_cut(v->builder, node, csg_box_grow(box, room + 1e-3 * size), v->where);
}

/* The operands that are left when those that add or take nothing are gone; 0: nothing is left of
 * the whole. */
static size_t without_empty(const csg_scene_builder *builder, csg_node_kind kind,
                            const csg_node_id *operands, size_t count, csg_node_id *left)
{
    size_t kept = 0;
    for (size_t i = 0; i < count; i++) {
        bool is_empty = builder->scene->nodes[operands[i]].kind == CSG_NODE_EMPTY;
        if (is_empty && (kind == CSG_NODE_INTERSECTION || (kind == CSG_NODE_DIFFERENCE && i == 0)))
            return 0;
        if (!is_empty)
            left[kept++] = operands[i];
    }
    return kept;
}

static csg_node_id fold(varying *v, csg_node_id *operands, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (csg_build_is_flat(v->builder, operands[i])) {
            csg_check_fail(v->builder, CSGM_ERR_SCENE,
                           "a blend's radius varies between solids, not between figures");
            return CSG_NODE_NONE;
        }
    csg_box box = box_of(v->builder, v->kind, operands, count);
    v->domain = (csg_field_domain){.bounds = box};
    if (csg_box_is_finite(
            box)) /* its sides are no faces of the solids: there the radius has a kink */
        v->domain.bounds = csg_box_grow(box, csg_box_longest_side(box) / 16);
    if (!check_radius(v))
        return CSG_NODE_NONE;
    if (!(v->range[1] > CSG_SMALLEST_LENGTH)) /* as a blend without width */
        return csg_build_operator(v->builder, v->kind, CSG_SHARP, operands, count, v->where);
    if (!csg_build_end_plateaus(v->builder, v->kind, v->range[1], operands, count))
        return CSG_NODE_NONE;
    csg_node_id node = operands[0];
    double scale = 1;
    for (size_t i = 1; i < count && node != CSG_NODE_NONE; i++)
        node = join_two(v, node, operands[i], &scale);
    return node == CSG_NODE_NONE ? node : bounded(v, node, box, count);
}

csg_node_id csg_build_varying(csg_scene_builder *builder, csg_node_kind kind,
                              const csg_formula_step *steps, uint32_t count,
                              const csg_node_id *operands, size_t operand_count, csg_span where)
{
    csg_memory *memory = &builder->context->memory;
    varying v = {.builder = builder, .kind = kind, .steps = steps, .count = count, .where = where};
    if (builder->status != CSGM_OK || !csg_check_field(builder, steps, count, csg_box_all(), 0))
        return CSG_NODE_NONE;
    for (size_t i = 0; i < operand_count; i++)
        if (!csg_build_is_usable(builder, operands[i]))
            return CSG_NODE_NONE;
    size_t bytes = operand_count * sizeof(csg_node_id);
    csg_node_id *left = csg_memory_alloc(memory, bytes);
    if (operand_count && !left)
        return csg_build_no_memory(builder);
    size_t kept = without_empty(builder, kind, operands, operand_count, left);
    csg_node_id node = kept < 2 ? csg_build_operator(builder, kind, CSG_SHARP, left, kept, where)
                                : fold(&v, left, kept);
    csg_memory_release(memory, left, bytes);
    return node;
}
