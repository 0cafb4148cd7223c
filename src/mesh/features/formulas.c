/* SPDX-License-Identifier: MIT
 * Second derivatives of formulas, of a block as a whole, then of its parts, then of the pieces
 * between kinks; see formulas.h.
 */
#include "mesh/features/formulas.h"

#include <math.h>

#include "field/gradients/cone_leaf.h"
#include "field/gradients/kinks.h"
#include "mesh/features/facets.h"

enum {
    P = CSG_PART_EDGE,
    PART_CELLS = P * P * P,
    PADDED = (PART_CELLS + CSG_LANES - 1) / CSG_LANES * CSG_LANES,
    MOST_FORMULAS =
        sizeof((csg_block_formulas *)0)->items / sizeof *((csg_block_formulas *)0)->items
};

static const double DIAGONAL = 2 * (double)CSG_FEATURE_HALF_DIAGONAL;
/* Gradients in float, rounded. */
static const double SHORTER = 0.9999;

/* What is asked about a cube, half: of its edge, is asked about a ball, unless the frame keeps its
 * axes. */
static double radius_of(const csg_tape_node *node, double half)
{
    return node->frame == CSG_FRAME_OFFSET ? half : half * DIAGONAL;
}

/* Whether a gradient turns by little in a cell, as seen from the shortest that it can be. */
static bool turns_little(double bend, double cell, double shortest)
{
    return bend * cell * DIAGONAL < CSG_FEATURE_MOST_TURN * shortest;
}

csg_tape csg_feature_leaf_alone(const csg_feature_probe *probe, const csg_tape_node *leaf,
                                csg_tape_node *alone)
{
    csg_tape tape = probe->marching->field->tape;
    *alone = *leaf;
    alone->join = CSG_JOIN_NONE;
    tape.nodes = alone;
    tape.count = 1;
    return tape;
}

static void middle_of_block(const csg_feature_probe *probe, float middle[3])
{
    for (int axis = 0; axis < 3; axis++)
        middle[axis] = probe->line[axis][CSG_BLOCK_EDGE / 2];
}

csg_block_formulas csg_feature_find_formulas(const csg_feature_probe *probe)
{
    static const double WIDER = 1.0001; /* rounded, so that points of the lattice are within */
    const csg_block *block = probe->block;
    double half = 0.5 * WIDER * CSG_BLOCK_EDGE * probe->marching->lattice->cell_size;
    csg_block_formulas out = {.count = 0};
    float middle[3];
    middle_of_block(probe, middle);
    for (uint32_t i = 0; i < block->node_count && out.count < MOST_FORMULAS; i++) {
        const csg_tape_node *node = &block->nodes[i];
        if (node->op != CSG_OP_FIELD)
            continue;
        out.items[out.count].parameters = node->parameters;
        out.items[out.count].is_known =
            csg_cone_find_pieces(&probe->marching->field->tape, node, middle, radius_of(node, half),
                                 &out.items[out.count].pieces);
        out.count++;
    }
    return out;
}

const csg_formula_pieces *csg_feature_pieces_of(const csg_block_formulas *formulas,
                                                const csg_tape *leaf)
{
    for (unsigned i = 0; i < formulas->count; i++)
        if (formulas->items[i].parameters == leaf->nodes->parameters && formulas->items[i].is_known)
            return &formulas->items[i].pieces;
    return NULL;
}

/* ---- the block and its parts -------------------------------------------------------------------
 */

/* At one point. */
static double gradient_at(csg_feature_probe *probe, const csg_tape *leaf, const float at[3])
{
    float x[CSG_LANES], y[CSG_LANES], z[CSG_LANES], g[3][CSG_LANES];
    for (int i = 0; i < CSG_LANES; i++)
        x[i] = at[0], y[i] = at[1], z[i] = at[2];
    probe->marching->kernel->gradients(leaf, x, y, z, 1, g[0], g[1], g[2], probe->scratch,
                                       probe->scratch_floats);
    probe->evaluations++;
    const double all[3] = {(double)g[0][0], (double)g[1][0], (double)g[2][0]};
    return SHORTER * csg_norm3(all);
}

/* Of the block as a whole. */
static bool is_still_all_over(csg_feature_probe *probe, const csg_block_formulas *formulas,
                              const csg_tape_node *node)
{
    double cell = probe->marching->lattice->cell_size, half = 0.5 * CSG_BLOCK_EDGE * cell;
    csg_tape_node alone;
    csg_tape leaf = csg_feature_leaf_alone(probe, node, &alone);
    const csg_formula_pieces *pieces = csg_feature_pieces_of(formulas, &leaf);
    float middle[3];
    if (!pieces || pieces->kink_count)
        return false;
    middle_of_block(probe, middle);
    return turns_little(pieces->bend, cell,
                        gradient_at(probe, &leaf, middle) - pieces->bend * half * DIAGONAL);
}

/* Whether second derivatives, all over a cube, keep a formula's gradient from turning by much in a
 * cell. half: of the cube's edge. */
static bool is_still(const csg_tape *tape, const csg_tape_node *node, const float at[3],
                     double half, double cell)
{
    csg_cone_ball g;
    double bend;
    if (!csg_cone_find_bend(tape, node, at, radius_of(node, half), &g, &bend))
        return false;
    return turns_little(bend, cell, csg_norm3(g.at) - g.spread - bend * half * DIAGONAL);
}

static bool are_still(const csg_feature_probe *probe, int octant)
{
    const csg_block *block = probe->block;
    double cell = probe->marching->lattice->cell_size;
    float middle[3];
    for (int axis = 0; axis < 3; axis++)
        middle[axis] = probe->line[axis][P * (octant >> axis & 1) + P / 2];
    for (uint32_t i = 0; i < block->node_count; i++)
        if (block->nodes[i].op == CSG_OP_FIELD &&
            !is_still(&probe->marching->field->tape, &block->nodes[i], middle, 0.5 * P * cell,
                      cell))
            return false;
    return true;
}

/* Whether the surface passes a part of a block. */
static bool is_passed(const csg_block *block, int octant)
{
    unsigned columns = (1u << P) - 1;
    for (int row = 0; row < P * P; row++) {
        int j = (octant >> 1 & 1) * P + row % P, k = (octant >> 2 & 1) * P + row / P;
        if (csg_cell_rows_of(block, j, k).mixed >> (octant & 1) * P & columns)
            return true;
    }
    return false;
}

unsigned csg_feature_find_still_parts(csg_feature_probe *probe, const csg_block_formulas *formulas,
                                      bool by_parts)
{
    const csg_block *block = probe->block;
    bool all = true;
    unsigned still = 0;
    for (uint32_t i = 0; i < block->node_count && all; i++)
        all = block->nodes[i].op != CSG_OP_FIELD ||
              is_still_all_over(probe, formulas, &block->nodes[i]);
    if (all)
        return (1u << CSG_OCTANTS) - 1;
    for (int octant = 0; octant < CSG_OCTANTS && by_parts; octant++)
        if (is_passed(block, octant) && are_still(probe, octant))
            still |= 1u << octant;
    return still;
}

/* ---- cells -------------------------------------------------------------------------------------
 */

/* A chord of length l is off its curve by at most bend l^2 / 8; vertices are roots to 2^-14 of
 * their edge. */
double csg_feature_formula_sag(const csg_feature_probe *probe, const csg_tape *leaf,
                               const csg_formula_pieces *pieces)
{
    static const double ROOT = 0x1p-12;
    double cell = probe->marching->lattice->cell_size, chord = cell * DIAGONAL;
    double lipschitz = (double)csg_tape_formula_of(leaf, leaf->nodes)->lipschitz;
    return 1.01 * pieces->bend * chord * chord / 8 + ROOT * lipschitz * cell +
           (double)(probe->marching->noise + leaf->waver);
}

/* If the cell has no kink; middle: the length of the gradient at its middle, turn: by how much
 * others in it are apart from that at most. Then no two are by an angle at which a tip is looked
 * for. A bracket around a jump is a thousandth of a segment: what turns by less than fifty of the
 * jump's three degrees in the cell has none that would be found. */
static csg_cell_look look_for(double turn, double middle)
{
    static const double SINE = 0.22; /* of half of 25 degrees, rounded up to as many */
    static const double MOST = 20;
    if (turn < SINE * middle)
        return CSG_LOOK_NOTHING;
    return 2 * turn < MOST * (middle - turn) ? CSG_LOOK_TIPS : CSG_LOOK_ALL;
}

/* Where what is zero at a kink can become that on half of the diagonal. */
static void take_kink(csg_feature_probe *probe, const csg_tape *leaf, const csg_kink *kink,
                      const csg_formula_cells *cells, csg_cell_look *looks)
{
    static const double ROUNDING = 0x1p-18; /* of operands */
    float value[PADDED], room[PADDED];
    double cell = probe->marching->lattice->cell_size;
    double reach = 0.501 * DIAGONAL * cell * kink->slope + ROUNDING * kink->size;
    csg_kink_values(probe->marching->kernel, leaf, kink, cells->x, cells->y, cells->z, cells->count,
                    value, room, probe->scratch, probe->scratch_floats);
    probe->evaluations += cells->count;
    for (size_t i = 0; i < cells->count; i++)
        if (!(fabs((double)value[i]) > reach))
            looks[i] = CSG_LOOK_ALL;
}

/* In a cell without a kink the gradient differs from that at its middle by what it turns on half of
 * the diagonal. */
void csg_feature_look_at_formula(csg_feature_probe *probe, const csg_tape *leaf,
                                 const csg_formula_pieces *pieces, const csg_formula_cells *cells,
                                 csg_cell_look *looks)
{
    float g[3][PADDED];
    double cell = probe->marching->lattice->cell_size;
    for (size_t i = 0; i < cells->count; i++)
        looks[i] = CSG_LOOK_ALL;
    if (!pieces || !cells->count)
        return;
    probe->marching->kernel->gradients(leaf, cells->x, cells->y, cells->z, cells->count, g[0], g[1],
                                       g[2], probe->scratch, probe->scratch_floats);
    probe->evaluations += cells->count;
    for (size_t i = 0; i < cells->count; i++) {
        const double at[3] = {(double)g[0][i], (double)g[1][i], (double)g[2][i]};
        looks[i] = look_for(0.501 * DIAGONAL * cell * pieces->bend, SHORTER * csg_norm3(at));
    }
    for (uint32_t k = 0; k < pieces->kink_count; k++)
        take_kink(probe, leaf, &pieces->kinks[k], cells, looks);
}
