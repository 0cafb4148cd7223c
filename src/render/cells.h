/* SPDX-License-Identifier: MIT
 * Where the surface may be: an octree whose leaves have tapes of their own, for rays to walk
 * through. Two kinds of tapes, both by field/prune/prune.h:
 *
 *   near  of a leaf. In the leaf's cube it has the field's sign everywhere and its bits next to the
 *         surface; elsewhere it is some field without other zeros: what sphere tracing needs.
 *   wide  of the cells of one level, as large as `reach`. In the cube and around it, up to reach
 *         from it along each axis, it has the field's bits where |f| <= lambda * reach and its sign
 *         elsewhere: what ambient occlusion and soft shadows look at.
 *
 * Levels are made one after the other by all threads; cells stand in the order of their parents.
 */
#ifndef CSG_RENDER_CELLS_H
#define CSG_RENDER_CELLS_H

#include "field/field.h"
#include "field/prune/prune.h"

typedef struct csg_ray_cell {
    float center[3], half;
    uint32_t child[CSG_OCTANTS];     /* by octant; 0 = none */
    uint32_t wide;                   /* at the wide level and below: the cell with the wide tape */
    uint32_t near_count, wide_count; /* of nodes of tapes */
    bool is_leaf, has_surface;       /* has_surface: a leaf of near tape is in it */
    const csg_tape_node *near_nodes, *wide_nodes;
} csg_ray_cell;

typedef struct csg_ray_cells_options {
    bool wide;      /* whether wide tapes are wanted; else reach is 0 */
    float band;     /* |f| up to which near tapes have the field's bits */
    int most_level; /* cells need not be smaller than 2^-most_level of the whole */
    bool (*cancelled)(void *user);
    void *user;
} csg_ray_cells_options;

typedef struct csg_ray_cells {
    csgm_context *context;
    const csgm_field *field;
    csg_ray_cell *cells; /* cells[0] is the root */
    size_t count, capacity;
    int wide_level;
    float reach, rounding;
    uint64_t interval_evaluations, primitive_evaluations;
    csg_arena *arenas; /* of tapes, one per worker */
    uint32_t worker_count;
} csg_ray_cells;

/* box: finite, around the solid, relative to the field's centre. CSGM_CANCELLED, or CSGM_ERR_MEMORY
 * (reported). */
csgm_status csg_ray_cells_create(csgm_context *context, const csgm_field *field, csg_box box,
                                 const csg_ray_cells_options *options, csg_ray_cells *out);
void csg_ray_cells_release(csg_ray_cells *cells);

/* A cell's cube is looked at by a little more than itself, so that no ray slips between cells. */
#define CSG_RAY_CELL_OVERLAP 0x1p-12f

#endif
