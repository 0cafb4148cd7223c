/* SPDX-License-Identifier: MIT
 * Whether the cells of a brick are small enough: each has one polygon, whose triangles are near the
 * surface and look outwards, and sheets that should meet in it do.
 */
#ifndef CSG_MESH_ADAPTIVE_JUDGE_H
#define CSG_MESH_ADAPTIVE_JUDGE_H

#include "field/kernels/roots.h"
#include "mesh/adaptive/polygons.h"
#include "mesh/adaptive/sheets.h"
#include "mesh/marching/tables.h"

enum { CSG_BRICK_SLOTS = 3 * CSG_BRICK_POINTS };

/* One thread's room; slots of edges and faces: axis * CSG_BRICK_POINTS + lower (lowest) point. */
typedef struct csg_judge_room {
    csg_edges edges;
    float gradient[3][CSG_BLOCK_MOST_EDGES];
    uint16_t edge[CSG_BRICK_SLOTS]; /* place in `edges`, of those crossed */
    uint8_t face[CSG_BRICK_SLOTS];  /* csg_face_state */
    csg_vec3 crease[CSG_BRICK_SLOTS];
    float *scratch;
    size_t scratch_floats;
    uint64_t evaluations, gradients;
} csg_judge_room;

typedef struct csg_judge {
    const csg_cell_tables *tables;
    csg_judge_room *rooms; /* one per worker */
    double tolerance;      /* how far triangles may be from the surface */
    bool sharp;            /* look for creases */
    float noise;           /* of values */
    float end_distance;    /* of vertices from lattice points: a part of an edge of the finest */
} csg_judge;

/* A csg_brick_judge; user: a csg_judge. */
bool csg_judge_brick(void *user, uint32_t worker, const csg_bricks *bricks, csg_brick *brick);

/* ---- shared with the making of triangles ---------------------------------------------------- */

/* Roots along edges that are collected, and gradients there; edges of level `level`. */
void csg_judge_solve_edges(const csg_judge *judge, const csg_bricks *bricks, const csg_brick *brick,
                           csg_judge_room *room);
/* The probe of a brick; *tape is filled. */
csg_sheet_probe csg_judge_probe(const csg_judge *judge, const csg_bricks *bricks,
                                const csg_brick *brick, csg_judge_room *room, csg_tape *tape);
/* Appends an edge of the brick to room->edges. */
void csg_judge_add_edge(csg_judge_room *room, const csg_bricks *bricks, const csg_brick *brick,
                        int axis, const unsigned low[3]);

/* A cell and who answers for its field: a csg_face_is_inside's user. */
typedef struct csg_cell_faces {
    const csg_bricks *bricks;
    const csg_brick *brick;
    const unsigned *at;
    csg_sheet_probe *probe;
} csg_cell_faces;

/* The sign of the field there: the same whichever cell asks, fine or coarse. */
bool csg_cell_face_is_inside(void *cell_faces, unsigned face);

/* The box of a cell. */
csg_cell_box csg_judge_cell_box(const csg_bricks *bricks, const csg_brick *brick,
                                const unsigned at[3]);

/* The largest distance from the surface, as |f| over the slope, at points of the triangles that the
 * polygon is cut into: around an apex, or, apex NULL, as `cut` says (three corners per triangle,
 * two triangles fewer than corners). INFINITY: a triangle looks inwards. */
double csg_polygon_distance(csg_sheet_probe *probe, const csg_polygon *polygon,
                            const csg_vec3 *apex, const uint8_t *cut, double least_length);

#endif
