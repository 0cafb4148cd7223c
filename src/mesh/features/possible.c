/* SPDX-License-Identifier: MIT
 * A tape -> whether its surface may have creases in a ball; see possible.h.
 *
 * Blends whose value depends on their operands' differences only are as smooth at every level as at
 * zero (operators.md 1, 12), so creases are those of sharp operators and of the leaves, where a
 * leaf is not smooth: at its edges, and where more than one of its points is nearest. Of these
 * places only such count as the surface can reach: where f = 0 an operand of a union is at least
 * minus the widths of the blends, one of an intersection at most their sum.
 *
 * A fillet much finer than a cell looks like a crease. Whether it is taken for one must not depend
 * on what pruning has left, so only blends as wide as a cell pass here.
 */
#include "mesh/features/possible.h"

#include <math.h>

#include "grid/octree/octree.h"
#include "scene/operators/blend_kinds.h"

typedef struct ball {
    float at[3], radius;
} ball;

static void to_own(const csg_tape_node *node, const float *frame, const float at[3], float q[3])
{
    for (int i = 0; i < 3; i++)
        q[i] = node->frame == CSG_FRAME_OFFSET ? at[i] - frame[i]
                                               : frame[3 * i] * at[0] + frame[3 * i + 1] * at[1] +
                                                     frame[3 * i + 2] * at[2] + frame[9 + i];
}

/* b in the leaf's own values: f = sigma own + raise. */
static csg_band own_band(csg_band b, const float *parameters)
{
    float sigma = parameters[CSG_LEAF_SIGMA], raise = parameters[CSG_LEAF_RAISE];
    float low = (b.low - raise) / sigma, high = (b.high - raise) / sigma;
    return sigma > 0 ? (csg_band){low, high} : (csg_band){high, low};
}

/* Of a leaf that is no primitive, a field or a shape, nothing is known. */
static bool may_crease(uint8_t op, const float *own, const float q[3], float reach, csg_band b)
{
    return !csg_op_is_primitive(op) ||
           csg_primitive_of(csg_op_node_kind(op))->may_crease(own, q, reach, b);
}

static bool leaf_may_crease(const csg_tape *tape, const csg_tape_node *node, ball at, csg_band b)
{
    const float *parameters = tape->parameters + node->parameters;
    bool offset = node->frame == CSG_FRAME_OFFSET;
    const float *own = parameters + (offset ? CSG_LEAF_OWN_OFFSET : CSG_LEAF_OWN_AFFINE);
    /* frames stretch lengths by at most 1 / sigma */
    float stretch = offset ? 1.0f : 1.0f / fabsf(parameters[CSG_LEAF_SIGMA]);
    float reach = 1.01f * at.radius * fmaxf(stretch, 1.0f), q[3];
    to_own(node, parameters + CSG_LEAF_FRAME, at.at, q);
    return node->warp || may_crease(node->op, own, q, reach, own_band(b, parameters));
}

/* Takes the blend's width to the band. False: it is not smooth, or finer than a cell. */
static bool widen(const csg_tape *tape, uint8_t kind, uint32_t at, bool is_union, float cell,
                  csg_band *b)
{
    float n = tape->parameters[at + CSG_OPERATOR_N];
    float support = tape->parameters[at + CSG_OPERATOR_SUPPORT];
    if (!csg_blend_is_smooth(kind) || !(n >= cell && support >= cell))
        return false;
    *(is_union ? &b->low : &b->high) += is_union ? -support : support;
    return true;
}

/* False: something in the tape may be sharp. Else the widest band any leaf can have. */
static bool find_band(const csg_tape *tape, const csg_tape_node *nodes, uint32_t count, float cell,
                      csg_band *b)
{
    for (uint32_t i = 0; i < count; i++) {
        const csg_tape_node *node = &nodes[i];
        if (node->join != CSG_JOIN_NONE && !widen(tape, node->join_blend, node->join_parameters,
                                                  node->join == CSG_JOIN_UNION, cell, b))
            return false;
        if (csg_op_is_round(node->op) &&
            !widen(tape, CSG_BLEND_ROUND, node->parameters, csg_op_is_union(node->op), cell, b))
            return false;
        if (csg_op_is_fillet(node->op) &&
            (node->planes ||
             !widen(tape, CSG_BLEND_FILLET, node->parameters, csg_op_is_union(node->op), cell, b)))
            return false; /* it ends in an edge */
        if (node->op == CSG_OP_COMBINE || csg_op_delivers(node->op))
            return false;
    }
    return true;
}

static bool tape_may_crease(const csg_tape *tape, const csg_tape_node *nodes, uint32_t count,
                            ball at, float cell)
{
    csg_band b = {0, 0};
    if (!find_band(tape, nodes, count, cell, &b))
        return true;
    for (uint32_t i = 0; i < count; i++)
        if (csg_op_is_leaf(nodes[i].op) && leaf_may_crease(tape, &nodes[i], at, b))
            return true;
    return false;
}

/* Of one part of the block: the ball around it. */
static ball ball_of(const csg_feature_probe *probe, int octant, float cell)
{
    ball at = {.radius = 0.8661f * CSG_PART_EDGE * cell}; /* sqrt(3) / 2 */
    for (int axis = 0; axis < 3; axis++)
        at.at[axis] = probe->line[axis][CSG_PART_EDGE * (octant >> axis & 1) + CSG_PART_EDGE / 2];
    return at;
}

static bool parts_may_crease(const csg_feature_probe *probe, const csg_block_part *parts)
{
    const csg_tape *tape = &probe->marching->field->tape;
    float cell = (float)probe->marching->lattice->cell_size;
    for (int octant = 0; octant < CSG_OCTANTS; octant++) {
        const csg_block_part *part = &parts[octant];
        if (part->state == CSG_CELL_SURFACE && tape_may_crease(tape, part->nodes, part->node_count,
                                                               ball_of(probe, octant, cell), cell))
            return true;
    }
    return false;
}

/* The parts that a block of a long tape would have. */
static bool split(const csg_feature_probe *probe, csg_block_part parts[CSG_OCTANTS])
{
    csg_tape tape = probe->marching->field->tape;
    tape.nodes = probe->block->nodes;
    tape.count = probe->block->node_count;
    return csg_octree_split(&probe->around->pruner, probe->marching->lattice, 0, probe->block->at,
                            &tape, &probe->around->arena, parts);
}

/* A sharp operand that is in the block's tape but far away would have smooth thin parts looked at
 * that a shorter tape leaves alone; so whatever the octree has dropped, parts are asked. */
bool csg_feature_is_possible(const csg_feature_probe *probe)
{
    const csg_block *block = probe->block;
    if (block->parts)
        return parts_may_crease(probe, block->parts);
    csg_block_part parts[CSG_OCTANTS];
    for (int octant = 0; octant < CSG_OCTANTS; octant++)
        parts[octant] = (csg_block_part){block->nodes, block->node_count, CSG_CELL_SURFACE};
    if (!parts_may_crease(probe, parts))
        return false;
    csg_feature_around_begin(probe->around, probe->memory, probe->marching);
    csg_arena_mark mark = csg_arena_get_mark(&probe->around->arena);
    bool done = split(probe, parts);
    bool possible = !done || parts_may_crease(probe, parts);
    probe->around->out_of_memory |= !done;
    csg_arena_release_to(&probe->around->arena, mark);
    return possible;
}
