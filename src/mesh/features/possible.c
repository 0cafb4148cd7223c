/* SPDX-License-Identifier: MIT
 * A tape -> whether its surface may have creases in a ball; see possible.h.
 *
 * Blends whose value depends on their operands' differences only are as smooth at every level as at
 * zero (operators.md 1, 12), so creases are those of sharp operators and of the leaves, where a
 * leaf is not smooth: at its edges, and where more than one of its points is nearest. Of these
 * places only such count as the surface can reach: where f = 0 an operand of a union is at least
 * minus the widths of the blends, one of an intersection at most their sum.
 *
 * Where all operators are sharp and all leaves primitives, formulas or shapes, cells are told
 * apart: the field is that of one leaf at a time, and turns into that of another only where both
 * are near zero.
 *
 * A fillet much finer than a cell looks like a crease. Whether it is taken for one must not depend
 * on what pruning has left, so only blends as wide as a cell pass here.
 */
#include "mesh/features/possible.h"

#include <math.h>
#include <string.h>

#include "grid/octree/octree.h"
#include "mesh/features/facets.h"
#include "mesh/features/formulas.h"
#include "scene/operators/blend_kinds.h"

enum { PART_CELLS = CSG_PART_EDGE * CSG_PART_EDGE * CSG_PART_EDGE };

typedef struct ball {
    float at[3], radius;
} ball;

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

/* still: formulas do not crease. */
static bool leaf_may_crease(const csg_tape *tape, const csg_tape_node *node, ball at, csg_band b,
                            bool still)
{
    if (node->op == CSG_OP_FIELD && still)
        return false;
    const float *parameters = tape->parameters + node->parameters;
    bool offset = node->frame == CSG_FRAME_OFFSET;
    /* frames stretch lengths by at most 1 / sigma */
    float stretch = offset ? 1.0f : 1.0f / fabsf(parameters[CSG_LEAF_SIGMA]);
    float reach = 1.01f * at.radius * fmaxf(stretch, 1.0f), q[3];
    csg_feature_to_own(node, parameters + CSG_LEAF_FRAME, at.at, q);
    return node->warp ||
           may_crease(node->op, csg_tape_own(tape, node), q, reach, own_band(b, parameters));
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
            (node->planes || csg_fillet_has_apart(tape, node) ||
             !widen(tape, CSG_BLEND_FILLET, node->parameters, csg_op_is_union(node->op), cell, b)))
            return false; /* it ends in an edge, or two meet in one */
        if (node->op == CSG_OP_COMBINE || csg_op_delivers(node->op))
            return false;
    }
    return true;
}

static bool tape_may_crease(const csg_tape *tape, const csg_tape_node *nodes, uint32_t count,
                            ball at, float cell, bool still)
{
    csg_band b = {0, 0};
    if (!find_band(tape, nodes, count, cell, &b))
        return true;
    for (uint32_t i = 0; i < count; i++)
        if (csg_op_is_leaf(nodes[i].op) && leaf_may_crease(tape, &nodes[i], at, b, still))
            return true;
    return false;
}

/* Of one part of the block: the ball around it. */
static ball ball_of(const csg_feature_probe *probe, int octant, float cell)
{
    ball at = {.radius = CSG_FEATURE_HALF_DIAGONAL * CSG_PART_EDGE * cell};
    for (int axis = 0; axis < 3; axis++)
        at.at[axis] = probe->line[axis][CSG_PART_EDGE * (octant >> axis & 1) + CSG_PART_EDGE / 2];
    return at;
}

static bool parts_may_crease(const csg_feature_probe *probe, const csg_block_part *parts,
                             unsigned still)
{
    const csg_tape *tape = &probe->marching->field->tape;
    float cell = (float)probe->marching->lattice->cell_size;
    for (int octant = 0; octant < CSG_OCTANTS; octant++) {
        const csg_block_part *part = &parts[octant];
        if (part->state == CSG_CELL_SURFACE &&
            tape_may_crease(tape, part->nodes, part->node_count, ball_of(probe, octant, cell), cell,
                            still >> octant & 1))
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

/* ---- cells -----------------------------------------------------------------------------------
 */

enum { MOST_NEAR = 4 };

/* A leaf that may be what the field is in a cell, and its value at the centre. */
typedef struct near_leaf {
    const csg_tape_node *node;
    float f;
} near_leaf;

/* Cells of one part of a block that the surface passes: their centres, and what leaves may be what
 * the field is there. */
typedef struct part_cells {
    size_t count;
    uint16_t cell[PART_CELLS];
    float x[PART_CELLS], y[PART_CELLS], z[PART_CELLS], f[PART_CELLS];
    uint8_t leaves[PART_CELLS];
    near_leaf near[PART_CELLS][MOST_NEAR];
    bool is_lone[PART_CELLS]; /* a formula is the field, where it has no kink */
    csg_cell_look looks[PART_CELLS];
} part_cells;

static float middle(const float *line, int i)
{
    return 0.5f * (line[i] + line[i + 1]);
}

static void gather_cells(const csg_feature_probe *probe, int octant, part_cells *cells)
{
    enum { P = CSG_PART_EDGE };
    int low[3];
    for (int axis = 0; axis < 3; axis++)
        low[axis] = (octant >> axis & 1) * P;
    cells->count = 0;
    for (int row = 0; row < P * P; row++) {
        int j = low[1] + row % P, k = low[2] + row / P;
        unsigned mixed = csg_cell_rows_of(probe->block, j, k).mixed;
        for (int i = low[0]; i < low[0] + P; i++) {
            if (!(mixed >> i & 1))
                continue;
            size_t n = cells->count++;
            cells->cell[n] = (uint16_t)((k * CSG_BLOCK_EDGE + j) * CSG_BLOCK_EDGE + i);
            cells->x[n] = middle(probe->line[0], i);
            cells->y[n] = middle(probe->line[1], j);
            cells->z[n] = middle(probe->line[2], k);
            cells->leaves[n] = 0;
            cells->is_lone[n] = false;
            cells->looks[n] = CSG_LOOK_NOTHING;
        }
    }
}

/* Whether at each point the field is the value of one primitive, formula or shape. */
static bool is_one_at_a_time(const csg_block_part *part)
{
    for (uint32_t i = 0; i < part->node_count; i++) {
        const csg_tape_node *node = &part->nodes[i];
        bool is_sharp = node->join == CSG_JOIN_NONE || node->join_blend == CSG_BLEND_SHARP;
        bool is_known = !node->warp && (csg_op_is_primitive(node->op) || node->op == CSG_OP_FIELD ||
                                        node->op == CSG_OP_SHAPE);
        bool is_operator = node->op == CSG_OP_UNION || node->op == CSG_OP_INTERSECTION;
        if (!is_sharp || !(is_known || is_operator))
            return false;
    }
    return true;
}

/* The way from a ball's centre to that of a cell. False: the leaf is no ball, or it is stretched,
 * or too near. */
static bool find_way(const csg_tape *tape, const csg_tape_node *node, const ball *at, float way[3],
                     float *length)
{
    if (!csg_op_has(node->op, CSG_TRAIT_BALL) || node->frame != CSG_FRAME_OFFSET)
        return false;
    csg_feature_to_own(node, tape->parameters + node->parameters + CSG_LEAF_FRAME, at->at, way);
    *length = sqrtf(way[0] * way[0] + way[1] * way[1] + way[2] * way[2]);
    return *length > 1.01f * at->radius;
}

/* Whether two leaves may have the same value somewhere in a cell. What lies between them changes by
 * the difference of their gradients at the centre and, farther away, by how much these turn: of a
 * ball's distance by 1 / (distance from its centre). */
static bool may_cross(const csg_tape *tape, const near_leaf *a, const near_leaf *b, const ball *at,
                      float slack)
{
    const near_leaf *leaf[2] = {a, b};
    float way[2][3], length[2], sigma[2], turn = 0, square = 0;
    for (int k = 0; k < 2; k++) {
        if (!find_way(tape, leaf[k]->node, at, way[k], &length[k]))
            return true;
        sigma[k] = tape->parameters[leaf[k]->node->parameters + CSG_LEAF_SIGMA];
        turn += fabsf(sigma[k]) / (length[k] - at->radius);
    }
    for (int i = 0; i < 3; i++) {
        float apart = sigma[0] * way[0][i] / length[0] - sigma[1] * way[1][i] / length[1];
        square += apart * apart;
    }
    float most = (sqrtf(square) + 0.5f * turn * at->radius) * at->radius;
    return !(fabsf(a->f - b->f) > 1.01f * most + 2 * slack);
}

/* Takes one more leaf that may be the field in a cell. Whether it may turn into that of another. */
static bool add_near(const csg_tape *tape, part_cells *cells, size_t i, near_leaf leaf,
                     const ball *at, float slack)
{
    if (cells->leaves[i] == MOST_NEAR)
        return true;
    for (int k = 0; k < cells->leaves[i]; k++)
        if (may_cross(tape, &cells->near[i][k], &leaf, at, slack))
            return true;
    cells->near[i][cells->leaves[i]++] = leaf;
    return false;
}

/* Values of one leaf at the cells' centres. One that is alone is what the field is in all of them.
 */
static void find_values(csg_feature_probe *probe, const csg_tape *leaf, bool is_alone,
                        part_cells *cells)
{
    if (is_alone) {
        memset(cells->f, 0, sizeof cells->f);
        return;
    }
    probe->marching->kernel->values(leaf, cells->x, cells->y, cells->z, cells->count, cells->f,
                                    probe->scratch, probe->scratch_floats);
    probe->evaluations += cells->count;
}

/* A part of the block. */
typedef struct part_look {
    const csg_block_part *part;
    bool still;                         /* formulas do not crease in it */
    const csg_block_formulas *formulas; /* of the block */
} part_look;

/* The only formula of a part, if others stand beside it. NULL: there is none. */
static const csg_tape_node *formula_among(const csg_block_part *part)
{
    const csg_tape_node *found = NULL;
    uint32_t formulas = 0, others = 0;
    for (uint32_t i = 0; i < part->node_count; i++) {
        bool is_formula = part->nodes[i].op == CSG_OP_FIELD;
        found = is_formula ? &part->nodes[i] : found;
        formulas += is_formula;
        others += !is_formula && csg_op_is_leaf(part->nodes[i].op);
    }
    return formulas == 1 && others ? found : NULL;
}

/* Where the field is a formula's at both ends of a segment and all other leaves are farther from
 * zero than that gets on it, they stay on the sides of it on which they are: the field is the
 * formula's all along. Other leaves are as steep as distances. */
static void find_lone(csg_feature_probe *probe, const part_look *look, part_cells *cells)
{
    const csg_tape_node *formula = formula_among(look->part);
    csg_tape_node alone;
    if (!formula)
        return;
    csg_tape tape = csg_feature_leaf_alone(probe, formula, &alone);
    const csg_formula_pieces *pieces = csg_feature_pieces_of(look->formulas, &tape);
    if (!pieces)
        return;
    float cell = (float)probe->marching->lattice->cell_size;
    float climb = 1.01f * CSG_FEATURE_HALF_DIAGONAL * cell + probe->marching->noise + tape.waver;
    float least = climb + (float)csg_feature_formula_sag(probe, &tape, pieces);
    for (size_t i = 0; i < cells->count; i++)
        cells->is_lone[i] = true;
    for (uint32_t k = 0; k < look->part->node_count; k++) {
        const csg_tape_node *node = &look->part->nodes[k];
        if (node == formula || !csg_op_is_leaf(node->op))
            continue;
        tape = csg_feature_leaf_alone(probe, node, &alone);
        find_values(probe, &tape, false, cells);
        for (size_t i = 0; i < cells->count; i++)
            cells->is_lone[i] = cells->is_lone[i] && fabsf(cells->f[i]) > least;
    }
}

/* What one leaf, alone on its tape, may have in cells where its own value may be within -off..off.
 */
static void look_at_leaf(csg_feature_probe *probe, const part_look *look, const csg_tape *leaf,
                         float off, const part_cells *cells, csg_cell_look *looks)
{
    const csg_tape_node *node = leaf->nodes;
    const csg_formula_cells all = {cells->cell, cells->x, cells->y, cells->z, cells->count};
    float cell = (float)probe->marching->lattice->cell_size;
    csg_shape_balls balls;
    if (node->op == CSG_OP_FIELD && !look->still) {
        csg_feature_look_at_formula(probe, leaf, csg_feature_pieces_of(look->formulas, leaf), &all,
                                    looks);
        return;
    }
    if (node->op == CSG_OP_SHAPE)
        csg_feature_find_facets(leaf, node, cell, cells->x, cells->y, cells->z, cells->count,
                                &balls);
    for (size_t i = 0; i < cells->count; i++) {
        ball at = {{cells->x[i], cells->y[i], cells->z[i]}, CSG_FEATURE_HALF_DIAGONAL * cell};
        bool any = node->op == CSG_OP_SHAPE
                       ? balls.may_crease[i]
                       : leaf_may_crease(leaf, node, at, (csg_band){-off, off}, look->still);
        looks[i] = any ? CSG_LOOK_ALL : CSG_LOOK_NOTHING;
    }
}

/* A segment of a polygon runs between two points of the surface in one cell, so that no point of it
 * is farther than half a diagonal from one of them, and f there no farther from zero than it can
 * climb on that way; the leaf that f is has come from there, and not more from the cell's centre.
 */
static void count_leaf(csg_feature_probe *probe, const part_look *look, const csg_tape_node *node,
                       part_cells *cells)
{
    csg_tape_node alone;
    csg_tape tape = csg_feature_leaf_alone(probe, node, &alone);
    csg_cell_look looks[PART_CELLS];
    float cell = (float)probe->marching->lattice->cell_size;
    float slack = probe->marching->noise + tape.waver;
    float off = 1.01f * CSG_FEATURE_HALF_DIAGONAL * cell * tape.lipschitz + slack;
    float reach =
        off + 1.01f * CSG_FEATURE_HALF_DIAGONAL * cell * fmaxf(tape.steepest, 1.0f) + slack;
    bool is_formula = node->op == CSG_OP_FIELD;
    find_values(probe, &tape, look->part->node_count == 1, cells);
    look_at_leaf(probe, look, &tape, off, cells, looks);
    for (size_t i = 0; i < cells->count; i++) {
        if (cells->looks[i] == CSG_LOOK_ALL || !(fabsf(cells->f[i]) <= reach) ||
            (cells->is_lone[i] && !is_formula))
            continue;
        ball at = {{cells->x[i], cells->y[i], cells->z[i]}, CSG_FEATURE_HALF_DIAGONAL * cell};
        near_leaf leaf = {node, cells->f[i]};
        if (add_near(&tape, cells, i, leaf, &at, slack))
            cells->looks[i] = CSG_LOOK_ALL;
        else if (looks[i] > cells->looks[i])
            cells->looks[i] = looks[i];
    }
}

static bool mark_part(csg_feature_probe *probe, int octant, const part_look *look,
                      csg_possible_cells *possible)
{
    const csg_block_part *part = look->part;
    part_cells cells;
    bool any = false, all = !is_one_at_a_time(part);
    gather_cells(probe, octant, &cells);
    for (size_t i = cells.count; i % CSG_LANES; i++)
        cells.x[i] = cells.x[0], cells.y[i] = cells.y[0], cells.z[i] = cells.z[0];
    if (!all && cells.count)
        find_lone(probe, look, &cells);
    for (uint32_t i = 0; i < part->node_count && !all && cells.count; i++)
        if (csg_op_is_leaf(part->nodes[i].op))
            count_leaf(probe, look, &part->nodes[i], &cells);
    for (size_t i = 0; i < cells.count; i++) {
        csg_cell_look what = all ? CSG_LOOK_ALL : cells.looks[i];
        int row = cells.cell[i] / CSG_BLOCK_EDGE, column = cells.cell[i] % CSG_BLOCK_EDGE;
        possible->any[row] |= (uint8_t)((what != CSG_LOOK_NOTHING) << column);
        possible->tips[row] |= (uint8_t)((what == CSG_LOOK_TIPS) << column);
        any = any || what != CSG_LOOK_NOTHING;
    }
    return any;
}

static bool mark_parts(csg_feature_probe *probe, const csg_block_part *parts,
                       const csg_block_formulas *formulas, unsigned still,
                       csg_possible_cells *possible)
{
    bool any = false;
    for (int octant = 0; octant < CSG_OCTANTS; octant++) {
        const part_look look = {&parts[octant], still >> octant & 1, formulas};
        if (look.part->state == CSG_CELL_SURFACE)
            any = mark_part(probe, octant, &look, possible) || any;
    }
    return any;
}

/* ---- the whole ------------------------------------------------------------------------------- */

/* A sharp operand that is in the block's tape but far away would have smooth thin parts looked at
 * that a shorter tape leaves alone; so whatever the octree has dropped, parts are asked. */
bool csg_feature_find_possible(csg_feature_probe *probe, csg_possible_cells *possible)
{
    const csg_block *block = probe->block;
    const csg_block_part whole = {block->nodes, block->node_count, CSG_CELL_SURFACE};
    const csg_block_formulas formulas = csg_feature_find_formulas(probe);
    unsigned still = csg_feature_find_still_parts(probe, &formulas, !is_one_at_a_time(&whole));
    memset(possible, 0, sizeof *possible);
    if (block->parts)
        return parts_may_crease(probe, block->parts, still) &&
               mark_parts(probe, block->parts, &formulas, still, possible);
    csg_block_part parts[CSG_OCTANTS];
    for (int octant = 0; octant < CSG_OCTANTS; octant++)
        parts[octant] = whole;
    if (!parts_may_crease(probe, parts, still))
        return false;
    csg_feature_around_begin(probe->around, probe->memory, probe->marching);
    csg_arena_mark mark = csg_arena_get_mark(&probe->around->arena);
    bool done = split(probe, parts); /* without memory the run ends */
    bool any = !done || (parts_may_crease(probe, parts, still) &&
                         mark_parts(probe, parts, &formulas, still, possible));
    probe->around->out_of_memory |= !done;
    csg_arena_release_to(&probe->around->arena, mark);
    return any;
}
