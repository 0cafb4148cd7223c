/* SPDX-License-Identifier: MIT
 * Formulas: where their gradients neither jump nor turn so fast that it would look like a jump,
 * told by second derivatives.
 */
#ifndef CSG_MESH_FEATURES_FORMULAS_H
#define CSG_MESH_FEATURES_FORMULAS_H

#include "field/gradients/bend_formula.h"
#include "mesh/features/probe.h"

/* Of the cube in which parts of a block are: sqrt(3) / 2, rounded up, of its diagonal, in edges. */
static const float CSG_FEATURE_HALF_DIAGONAL = 0.8661f;

/* A tape for one leaf; `alone` is its node. */
csg_tape csg_feature_leaf_alone(const csg_feature_probe *probe, const csg_tape_node *leaf,
                                csg_tape_node *alone);

/* What a cell may have, in the order of what there is to look for. */
typedef enum csg_cell_look { CSG_LOOK_NOTHING, CSG_LOOK_TIPS, CSG_LOOK_ALL } csg_cell_look;

/* The formulas of a block, each between its kinks in it. */
typedef struct csg_block_formulas {
    unsigned count;
    struct {
        uint32_t parameters; /* of the leaf */
        bool is_known;
        csg_formula_pieces pieces;
    } items[4]; /* nothing is known of others */
} csg_block_formulas;

csg_block_formulas csg_feature_find_formulas(const csg_feature_probe *probe);

/* In which of the block's parts, a bit each, no gradient of a formula jumps or turns by much: in
 * all of them, where there are none. by_parts: of parts it is asked where it is not so of the
 * whole. */
unsigned csg_feature_find_still_parts(csg_feature_probe *probe, const csg_block_formulas *formulas,
                                      bool by_parts);

/* What is known of one that is alone on its tape; NULL: nothing. */
const csg_formula_pieces *csg_feature_pieces_of(const csg_block_formulas *formulas,
                                                const csg_tape *leaf);

/* How far from zero the formula can be on a segment between two of its zeros in a cell without
 * kinks: by what its gradient turns. */
double csg_feature_formula_sag(const csg_feature_probe *probe, const csg_tape *leaf,
                               const csg_formula_pieces *pieces);

/* The cells of a part of the block: at most CSG_PART_EDGE cubed, by their middles, with room for
 * whole vectors behind. */
typedef struct csg_formula_cells {
    const uint16_t *cell; /* z, y, x in the block */
    const float *x, *y, *z;
    size_t count;
} csg_formula_cells;

/* What is to be looked for in cells where all is one formula. */
void csg_feature_look_at_formula(csg_feature_probe *probe, const csg_tape *leaf,
                                 const csg_formula_pieces *pieces, const csg_formula_cells *cells,
                                 csg_cell_look *looks);

#endif
