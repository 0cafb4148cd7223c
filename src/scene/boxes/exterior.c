/* SPDX-License-Identifier: MIT
 * Ranges of all nodes outside of the hull of their leaves' boxes; see exterior.h.
 *
 * Let every bounded leaf be below -l outside of its level box. Outside of the hull of all of these
 * boxes each is in (-infinity, -l], one that is subtracted in [l, infinity), and an unbounded one
 * anywhere; operators map ranges to ranges (operators.md 7.2, 7.3, 5.5, 6.7 for those that take
 * fields). If the root's range is negative, the solid lies within the hull. l is doubled until that
 * is so.
 */
#include "scene/boxes/exterior.h"

#include "scene/boxes/level_boxes.h"
#include "scene/operators/blend_kinds.h"
#include "scene/operators/rule.h"
#include "scene/operators/soft.h"
#include "scene/reference.h"

/* Levels are from 2^-FINEST to 2^COARSEST of the longest side of the leaves' hull. */
enum { FINEST = 12, COARSEST = 4 };

/* Values that stand for those without end, in lengths of that side: all fields are 0 or 1 there. */
static const double FAR = 1e6;
/* Of ranges of fields. */
static const double ROUNDING = 1e-9;

typedef struct range {
    double low, high;
} range;

typedef struct search {
    const csgm_scene *scene;
    csg_affine *frames; /* to the root's frame */
    bool *is_placed;    /* no warp stands above */
    double *scales;     /* a length of 1 in the root's frame is so long for the node's values */
    double *levels;
    csg_box *boxes;
    range *ranges;
    double *low, *high, *partials; /* of one operator's operands */
    double far;
} search;

/* Nodes whose operands are not looked at: what is known of them is their own box. */
static bool is_whole(const csg_node *node)
{
    return !node->child_count || node->kind == CSG_NODE_WARP || node->kind == CSG_NODE_COMBINE ||
           (csg_node_is_operator(node->kind) && csg_blend_is_orthogonal(node->blend));
}

static bool begin(search *s, csg_arena *scratch)
{
    size_t count = s->scene->node_count;
    s->frames = csg_arena_calloc(scratch, count, sizeof *s->frames);
    s->is_placed = csg_arena_calloc(scratch, count, sizeof *s->is_placed);
    s->scales = csg_arena_calloc(scratch, count, sizeof *s->scales);
    s->levels = csg_arena_calloc(scratch, count, sizeof *s->levels);
    s->boxes = csg_arena_calloc(scratch, count, sizeof *s->boxes);
    s->ranges = csg_arena_calloc(scratch, count, sizeof *s->ranges);
    s->low = csg_arena_calloc(scratch, 3 * count, sizeof *s->low);
    if (!s->frames || !s->is_placed || !s->scales || !s->levels || !s->boxes || !s->ranges ||
        !s->low)
        return false;
    s->high = s->low + count;
    s->partials = s->high + count;
    return true;
}

static void place_nodes(search *s)
{
    const csgm_scene *scene = s->scene;
    s->frames[scene->root] = csg_affine_identity();
    s->is_placed[scene->root] = true;
    s->scales[scene->root] = 1;
    for (size_t i = scene->node_count; i-- > 0;) {
        const csg_node *node = &scene->nodes[i];
        csg_affine inner = s->frames[i];
        double scale = s->scales[i];
        if (node->kind == CSG_NODE_TRANSFORM) {
            inner = csg_affine_multiply(inner, scene->transforms[node->payload]);
            scale /= scene->scales[node->payload];
        }
        for (uint32_t k = 0; k < node->child_count; k++) {
            csg_node_id child = csg_scene_children(scene, node)[k];
            s->frames[child] = inner;
            s->scales[child] = scale;
            s->is_placed[child] = s->is_placed[i] && !is_whole(node);
        }
    }
}

/* The hull of all that is bounded, at this level. */
static csgm_status find_hull(search *s, double level, csg_box *hull)
{
    const csgm_scene *scene = s->scene;
    *hull = csg_box_empty();
    for (size_t i = 0; i < scene->node_count; i++)
        s->levels[i] = level * s->scales[i];
    csgm_status status = csg_level_boxes(scene, s->levels, s->boxes);
    for (size_t i = 0; i < scene->node_count && status == CSGM_OK; i++) {
        if (!s->is_placed[i] || !is_whole(&scene->nodes[i]) || !csg_box_is_finite(s->boxes[i]))
            continue;
        *hull = csg_box_hull(*hull, csg_affine_box(&s->frames[i], s->boxes[i]));
    }
    return status;
}

/* ---- ranges ----------------------------------------------------------------------------------- */

static range negated(range r)
{
    return (range){-r.high, -r.low};
}

static range whole_range(const search *s, size_t i)
{
    bool is_bounded = csg_box_is_finite(s->boxes[i]) || csg_box_is_empty(s->boxes[i]);
    return (range){-INFINITY, is_bounded ? -s->levels[i] : INFINITY};
}

static double held(const search *s, double f)
{
    return fmax(-s->far, fmin(s->far, f));
}

static range soft_range(const search *s, const csg_node *node, range inner)
{
    csg_soft soft = csg_scene_soft(s->scene, node);
    double lambda = csg_scene_parameters(s->scene, node)[CSG_SOFT_LAMBDA], slope;
    double low = csg_soft_at(soft, held(s, inner.low), &slope) - ROUNDING;
    double high = csg_soft_at(soft, held(s, inner.high), &slope) + ROUNDING;
    return (range){(low - 0.5) / lambda, (high - 0.5) / lambda};
}

static range range_of_fields(const search *s, const csg_node *node)
{
    const csgm_scene *scene = s->scene;
    const double cosines[2] = {-1, 1};
    double lambda = csg_scene_parameters(scene, node)[CSG_OPERATOR_LAMBDA], slope, out[2];
    for (uint32_t k = 0; k < node->child_count; k++) {
        range r = s->ranges[csg_scene_children(scene, node)[k]];
        csg_operand operand = csg_scene_operand(scene, node, k);
        bool subtracted = node->kind == CSG_NODE_DIFFERENCE && k > 0;
        double low = csg_operand_field(operand, held(s, r.low), &slope);
        double high = csg_operand_field(operand, held(s, r.high), &slope);
        s->low[k] = subtracted ? 1 - high : low;
        s->high[k] = subtracted ? 1 - low : high;
    }
    csg_rule_enclose(csg_scene_rule(scene, node), node->kind == CSG_NODE_UNION, s->low, s->high,
                     node->child_count, cosines, s->partials, out);
    return (range){(out[0] - ROUNDING - 0.5) / lambda, (out[1] + ROUNDING - 0.5) / lambda};
}

/* Of values; an intersection is the union of what is negated. Functions of values alone are
 * monotone; the others are between the largest operand and that and their excess, and what INTERIOR
 * takes away is as much. */
static range range_of_values(const search *s, const csg_node *node)
{
    const csgm_scene *scene = s->scene;
    bool is_union = node->kind == CSG_NODE_UNION;
    range out = {-INFINITY, -INFINITY};
    for (uint32_t k = 0; k < node->child_count; k++) {
        range r = s->ranges[csg_scene_children(scene, node)[k]];
        bool subtracted = node->kind == CSG_NODE_DIFFERENCE && k > 0;
        r = is_union || subtracted ? r : negated(r);
        out = (range){fmax(out.low, r.low), fmax(out.high, r.high)};
        s->low[k] = held(s, r.low);
        s->high[k] = held(s, r.high);
    }
    if (node->blend < CSG_BLEND_COUNT && !csg_blend_is_fillet(node->blend)) {
        csg_blend blend = csg_scene_blend(scene, node);
        if (isfinite(out.low))
            out.low = csg_reference_union(blend, s->low, node->child_count, s->partials);
        if (isfinite(out.high))
            out.high = csg_reference_union(blend, s->high, node->child_count, s->partials);
    } else {
        double excess = csg_scene_excess(scene, node);
        out.high += excess;
        out.low -= csg_blend_is_interior(node->blend) ? excess : 0;
    }
    return is_union ? out : negated(out);
}

static range range_of(const search *s, size_t i)
{
    const csgm_scene *scene = s->scene;
    const csg_node *node = &scene->nodes[i];
    if (is_whole(node))
        return whole_range(s, i);
    range inner = s->ranges[csg_scene_children(scene, node)[0]];
    if (node->kind == CSG_NODE_TRANSFORM) {
        double scale = scene->scales[node->payload];
        return (range){scale * inner.low, scale * inner.high};
    }
    if (node->kind == CSG_NODE_COLOR)
        return inner;
    if (node->kind == CSG_NODE_OFFSET) {
        double r = csg_scene_parameters(scene, node)[0];
        return (range){inner.low + r, inner.high + r};
    }
    if (node->kind == CSG_NODE_SOFT)
        return soft_range(s, node, inner);
    return csg_blend_takes_fields(node->blend) ? range_of_fields(s, node)
                                               : range_of_values(s, node);
}

static bool is_outside(const search *s)
{
    for (size_t i = 0; i < s->scene->node_count; i++)
        s->ranges[i] = range_of(s, i);
    return s->ranges[s->scene->root].high < 0;
}

static csgm_status find(search *s, csg_box *out)
{
    csg_box hull;
    csgm_status status = find_hull(s, 0, &hull);
    if (status != CSGM_OK || csg_box_is_empty(hull) || !csg_box_is_finite(hull))
        return status;
    double side = csg_box_longest_side(hull);
    s->far = FAR * side;
    for (int k = -FINEST; k <= COARSEST && side > 0; k++) {
        status = find_hull(s, ldexp(side, k), &hull);
        if (status != CSGM_OK)
            return status;
        if (is_outside(s)) {
            *out = hull;
            break;
        }
    }
    return CSGM_OK;
}

csgm_status csg_exterior_box(const csgm_scene *scene, csg_box *out)
{
    csg_arena scratch;
    csg_arena_init(&scratch, &scene->context->memory);
    search s = {.scene = scene};
    *out = csg_box_all();
    csgm_status status = CSGM_ERR_MEMORY;
    if (begin(&s, &scratch)) {
        place_nodes(&s);
        status = find(&s, out);
    }
    csg_arena_reset(&scratch);
    return status;
}
