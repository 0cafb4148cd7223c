/* SPDX-License-Identifier: MIT
 * Operands of operators on fields; see prune_fields.h.
 */
#include "field/prune/prune_fields.h"

#include <math.h>

#include "field/rule_layout.h"
#include "field/turning.h"

/* Comparisons keep this far, relatively, from where the kernels' roundings may decide otherwise. */
static const float ROOM = 1.0f + 0x1p-19f;

typedef struct bounds {
    float low, high;
} bounds;

static bounds bounds_of(const csg_field_ranges *ranges, uint32_t node, int octant)
{
    size_t at = (size_t)node * CSG_OCTANTS + (size_t)octant;
    return (bounds){ranges->low[at], ranges->high[at]};
}

/* ---- of any number of operands ------------------------------------------------------------------
 */

/* Whether the operand changes nothing, whatever the others are. */
static bool is_neutral(const csg_tape_node *op, bounds b)
{
    bool is_union = op->op == CSG_OP_RULE_UNION;
    switch ((csg_blend_kind)op->blend) {
    case CSG_BLEND_SOFT_SUM:
    case CSG_BLEND_SOFT_SET:
        return b.high <= 0;
    case CSG_BLEND_PERLIN:
        return is_union ? b.high <= 0 : b.low >= 1;
    case CSG_BLEND_RICCI:
    case CSG_BLEND_ARC:
    case CSG_BLEND_ARC_SHARP:
        return is_union && b.high <= 0;
    case CSG_BLEND_SCALE_SET: /* by its ratio, where there are two */
    case CSG_BLEND_FIELD_SHARP:
    case CSG_BLEND_EXTERIOR: /* the rest takes no fields */
    case CSG_BLEND_INTERIOR:
    case CSG_BLEND_PROFILE:
#define CSG_BLEND(NAME, name, area, raw, support, excess, smooth, convex, doc)                     \
    case CSG_BLEND_##NAME:
#include "scene/operators/operators.def"
    case CSG_BLEND_ORTHOGONAL:
    case CSG_BLEND_END:
        break;
    }
    return false;
}

/* Of the largest fields' lower ends the highest (mirrored for an intersection). */
static float best_of(const csg_field_ranges *ranges, uint32_t node, int octant, float turn)
{
    const csg_tape_node *nodes = ranges->tape->nodes;
    float best = -INFINITY;
    uint32_t child = node - 1;
    for (uint32_t k = 0; k < nodes[node].arity; k++, child -= nodes[child].size) {
        bounds b = bounds_of(ranges, child, octant);
        best = fmaxf(best, turn > 0 ? b.low : -b.high);
    }
    return best;
}

static bool is_beaten(const csg_tape_node *op, bounds b, float best)
{
    return op->blend == CSG_BLEND_FIELD_SHARP &&
           (op->op == CSG_OP_RULE_UNION ? b.high : -b.low) < best;
}

/* ---- of two ------------------------------------------------------------------------------------
 */

/* The pair lies outside of both zones of sharp operators (operators.md 5.6): then the union is the
 * larger and the intersection the smaller one. */
static bool is_sharp_apart(bounds smaller, bounds larger)
{
    return smaller.high * ROOM <= 2 * larger.low * larger.low &&
           smaller.high * smaller.high * ROOM <= 0.5f * larger.low;
}

/* y is so large beside x that the scale function is x. A turning one's ranges are known only where
 * y is 1 all over, has no gradient, and the angle counts as right. */
static bool is_scale_apart(const csg_tape_node *op, const float *p, float r, bounds x, bounds y)
{
    if (op->blend == CSG_BLEND_TURNING)
        return y.low >= 1 && x.high * (1 + r * (1 + p[CSG_SCALE_OMEGA])) * ROOM <= 1;
    return x.high * (1 + r) * ROOM <= y.low;
}

enum { NEITHER, DROP_X, DROP_Y };

static int drop_of_two(const csg_tape_node *op, const float *p, bounds x, bounds y)
{
    bool is_union = op->op == CSG_OP_RULE_UNION;
    switch ((csg_blend_kind)op->blend) {
    case CSG_BLEND_ARC:
        if (y.high * ROOM <= p[CSG_ARC_B] * x.low)
            return is_union ? DROP_Y : DROP_X;
        if (x.high * ROOM <= p[CSG_ARC_A] * y.low)
            return is_union ? DROP_X : DROP_Y;
        break;
    case CSG_BLEND_ARC_SHARP:
        if (is_sharp_apart(y, x))
            return is_union ? DROP_Y : DROP_X;
        if (is_sharp_apart(x, y))
            return is_union ? DROP_X : DROP_Y;
        return NEITHER;
    case CSG_BLEND_SCALE_SET:
    case CSG_BLEND_END: /* TURNING */
        if (is_scale_apart(op, p, p[CSG_SCALE_R2], x, y))
            return DROP_Y;
        return is_scale_apart(op, p, p[CSG_SCALE_R1], y, x) ? DROP_X : NEITHER;
    case CSG_BLEND_RICCI:
    case CSG_BLEND_SOFT_SUM:
    case CSG_BLEND_SOFT_SET:
    case CSG_BLEND_PERLIN:
    case CSG_BLEND_FIELD_SHARP: /* by is_neutral and is_beaten */
    case CSG_BLEND_EXTERIOR:    /* the rest takes no fields */
    case CSG_BLEND_INTERIOR:
    case CSG_BLEND_PROFILE:
#define CSG_BLEND(NAME, name, area, raw, support, excess, smooth, convex, doc)                     \
    case CSG_BLEND_##NAME:
#include "scene/operators/operators.def"
    case CSG_BLEND_ORTHOGONAL:
        break;
    }
    return NEITHER;
}

/* ---- all of them -------------------------------------------------------------------------------
 */

static void drop(const csg_field_ranges *ranges, uint32_t node, int octant)
{
    ranges->dropped[node] |= (uint8_t)(1 << octant);
}

/* Whether any was dropped. */
static bool drop_operands(const csg_field_ranges *ranges, uint32_t node, int octant)
{
    const csg_tape_node *nodes = ranges->tape->nodes, *op = &nodes[node];
    const float *p = ranges->tape->parameters + op->parameters;
    uint32_t last = node - 1;
    if (op->arity == 2) {
        uint32_t first = last - nodes[last].size;
        int which =
            drop_of_two(op, p, bounds_of(ranges, first, octant), bounds_of(ranges, last, octant));
        if (which != NEITHER) {
            drop(ranges, which == DROP_X ? first : last, octant);
            return true;
        }
    }
    float best = best_of(ranges, node, octant, op->op == CSG_OP_RULE_UNION ? 1.0f : -1.0f);
    uint32_t child = last, left = op->arity;
    for (uint32_t k = 0; k < op->arity; k++, child -= nodes[child].size) {
        bounds b = bounds_of(ranges, child, octant);
        if (left > 1 && (is_neutral(op, b) || is_beaten(op, b, best))) {
            drop(ranges, child, octant);
            left--;
        }
    }
    return left < op->arity;
}

uint8_t csg_prune_fields(csg_field_ranges ranges, uint32_t node)
{
    const csg_tape_node *nodes = ranges.tape->nodes;
    uint32_t child = node - 1;
    uint8_t any = 0;
    for (uint32_t k = 0; k < nodes[node].arity; k++, child -= nodes[child].size)
        ranges.dropped[child] = ranges.dropped[node];
    for (int octant = 0; octant < CSG_OCTANTS && nodes[node].arity > 1; octant++)
        if (!(ranges.dropped[node] >> octant & 1) && drop_operands(&ranges, node, octant))
            any |= (uint8_t)(1 << octant);
    return any;
}

void csg_soften_demand(const csg_tape *tape, const csg_tape_node *node, float *low, float *high)
{
    const float *p = tape->parameters + node->parameters;
    const float rate = p[CSG_SOFTEN_RATE], iso = p[CSG_SOFTEN_ISO], room = 1e-5f;
    float zero = iso - 1, full = iso;
    if (node->blend == CSG_CURVE_STEP || node->blend == CSG_CURVE_CLAMP) {
        full = node->blend == CSG_CURVE_STEP ? 1.0f : 0.5f;
        zero = -full;
    }
    *low = (zero - room) / rate;
    *high = (full + room) / rate;
}

bool csg_prune_is_identity(const csg_tape *tape, const csg_tape_node *op)
{
    const float *delivery = tape->parameters + op->parameters + CSG_RULE_DELIVER;
    if (!csg_op_takes_fields(op->op))
        return op->op != CSG_OP_COMBINE && op->op != CSG_OP_SOFTEN;
    bool normalises = op->blend == CSG_BLEND_SOFT_SET || op->blend == CSG_BLEND_SCALE_SET ||
                      op->blend == CSG_BLEND_TURNING;
    /* A field that is handed on as a field. */
    return !normalises && delivery[CSG_DELIVER_LOW] == 0 && delivery[CSG_DELIVER_SCALE] > 0;
}
