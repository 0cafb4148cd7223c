/* SPDX-License-Identifier: MIT
 * The cubes over a part as a tree that grows where a search asks. Cubes that are outside are not
 * kept.
 */
#ifndef CSG_CLEARANCE_TREE_H
#define CSG_CLEARANCE_TREE_H

#include "clearance/part.h"
#include "clearance/support.h"

typedef struct csg_clear_node {
    csg_measure_cube cube;          /* SURFACE or INSIDE */
    const csg_clear_pieces *pieces; /* contain the part in the cube; NULL: all of it may be */
    uint32_t first_child;
    uint8_t child_count;
    bool is_divided;
} csg_clear_node;

typedef struct csg_clear_tree {
    const csg_clear_part *part;
    csg_measure_worker *worker;
    csg_arena arena;       /* tapes and pieces */
    csg_clear_node *nodes; /* 0: the root */
    size_t count, capacity;
} csg_clear_tree;

/* One worker's. False: out of memory; release it in any case. */
bool csg_clear_tree_begin(csg_clear_tree *tree, const csg_clear_part *part, uint32_t worker);
void csg_clear_tree_release(csg_clear_tree *tree);

/* Whether the cube can be divided: the surface goes through it, and it is not too small. */
bool csg_clear_tree_may_divide(const csg_clear_tree *tree, uint32_t node);
/* Its children are there then. Nodes may have moved. False: out of memory. */
bool csg_clear_tree_divide(csg_clear_tree *tree, uint32_t node);

/* ---- cubes of two trees ------------------------------------------------------------------------
 */

/* From the centre of a cube of one tree to that of a cube of the other. */
csg_vec3 csg_clear_offset(const csg_clear_tree *a, uint32_t cube_a, const csg_clear_tree *b,
                          uint32_t cube_b);
/* Which of them is divided next, the larger one if it may be: 0, 1, or -1: neither may. */
int csg_clear_choose(const csg_clear_tree *a, uint32_t cube_a, const csg_clear_tree *b,
                     uint32_t cube_b);

#endif
