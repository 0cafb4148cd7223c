/* SPDX-License-Identifier: MIT
 * Which cells of a brick are small enough: triangles of their polygons are near the surface, look
 * outwards and meet nowhere, and sheets that should meet in them do.
 */
#ifndef CSG_MESH_ADAPTIVE_JUDGE_H
#define CSG_MESH_ADAPTIVE_JUDGE_H

#include "field/kernels/roots.h"
#include "mesh/adaptive/cover.h"
#include "mesh/adaptive/cut_polygons.h"
#include "mesh/adaptive/judged.h"
#include "mesh/adaptive/polygons.h"

enum { CSG_NO_FACE = 0xFF };

/* One thread's room. */
typedef struct csg_judge_room {
    csg_edges edges;
    float gradient[3][CSG_BLOCK_MOST_EDGES];
    csg_pierced pierced;
    /* Place in `edges`, of those crossed; of pierced ones the lower half's, and the upper's. */
    uint16_t edge[2][CSG_BRICK_SLOTS];
    csg_cell_polygons polygons[CSG_BRICK_CELLS]; /* of crossed cells */
    uint8_t face[CSG_BRICK_SLOTS];               /* place in `faces`, or CSG_NO_FACE */
    csg_face_side faces[CSG_MOST_FACES];         /* that creases are looked for in */
    int face_count;
    csg_cut_polygon pieces[CSG_JUDGED_MOST_APEXES]; /* of the brick's cells, each cell's together */
    int piece_count;
    uint8_t first_piece[CSG_BRICK_CELLS], end_piece[CSG_BRICK_CELLS];
    csg_brick_triangles triangles;
    csg_arena found;  /* what the judge found of bricks that are not joined yet */
    csg_vec3 *unsure; /* places of the surface away from the brick's own triangles, and so near to a
                         side of it that the next brick's may be there (unsure.h) */
    size_t unsure_count, unsure_capacity;
    float *scratch;
    size_t scratch_floats;
    uint64_t evaluations, gradients;
} csg_judge_room;

typedef struct csg_judge {
    csg_memory *memory;
    csg_judge_room *rooms; /* one per worker */
    csg_arena kept;        /* what was found of bricks, each thing once */
    double tolerance;      /* how far triangles may be from the surface */
    double bulge;          /* how far sides of polygons may be, before they get a vertex between */
    bool sharp;            /* look for creases */
    bool tells_seen;       /* keep places for csg_seen_gather */
    float noise;           /* of values */
    csg_plain_polygons plain;
    float end_distance; /* of vertices from lattice points: a part of an edge of the finest */
} csg_judge;

/* A csg_brick_judge; user: a csg_judge. */
bool csg_judge_brick(void *user, uint32_t worker, const csg_bricks *bricks, csg_brick *brick,
                     const float *f);
/* A csg_bricks_joined; user: the same. */
bool csg_judge_joined(void *user, csg_bricks *bricks, size_t first);

/* A csg_brick_tell and a csg_brick_hear; user: the same. */
bool csg_judge_tell(void *user, const csg_brick *brick, csg_records *records);
bool csg_judge_hear(void *user, csg_brick *brick, csg_record_reader *reader, size_t item);

/* ---- shared with the making of triangles ---------------------------------------------------- */

/* Whether a cell is so small that its sheets may fail to meet. */
bool csg_judge_may_fail(const csg_judge *judge, double cell);
/* Whether the pieces of a cell, of that size, are on their own sides of each other: then they do
 * not meet. */
bool csg_judge_are_apart(const csg_judge_room *room, unsigned cell, double size);
/* The probe of a brick; *tape is filled. */
csg_sheet_probe csg_judge_probe(const csg_judge *judge, const csg_bricks *bricks,
                                const csg_brick *brick, csg_judge_room *room, csg_tape *tape);
/* A cell and who answers for its field: a csg_face_is_inside's user. */
typedef struct csg_cell_faces {
    const csg_bricks *bricks;
    const csg_brick *brick;
    const unsigned *at;
    csg_sheet_probe *probe;
    const csg_pierced *pierced;
} csg_cell_faces;

/* The sign of the field there: the same whichever cell asks, fine or coarse. */
bool csg_cell_face_is_inside(void *cell_faces, const csg_face_look *look);

/* Whether there may be several vertices in a face of that size, in cells of the finest: their
 * places are a quarter of it apart (cell_loop.h). */
static inline bool csg_judge_divides_sides(uint32_t face_size)
{
    return face_size >= 2;
}

/* The box of a cell. */
csg_cell_box csg_judge_cell_box(const csg_bricks *bricks, const csg_brick *brick,
                                const unsigned at[3]);

#endif
