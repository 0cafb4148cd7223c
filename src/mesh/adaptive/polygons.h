/* SPDX-License-Identifier: MIT
 * The polygons of a cell whose edges and faces may be divided: faces decide, as in cubical marching
 * squares (Ho, Wu, Chen, Chuang and Ouhyoung 2005). A face is a cycle of four points, of up to
 * eight where its edges are divided; a divided face is four such faces. Each run of inside points
 * of a cycle is cut off by its own segment; where there are several, and the face is inside between
 * them, too, the runs of outside points between them are. Both cells at a face see the same
 * cycles, so segments match at every border of levels, and around a cell they close to loops.
 *
 * Where an edge is divided and only its middle differs, two faces of a cell cut that run off
 * between the same two vertices. Such a loop of two is left out: the triangles beyond its faces
 * meet in that edge directly. A side that cuts off the point of a pierced edge has a vertex of its
 * own in the face, always, so that no two such sides are one.
 */
#ifndef CSG_MESH_ADAPTIVE_POLYGONS_H
#define CSG_MESH_ADAPTIVE_POLYGONS_H

#include "grid/adaptive/shell.h"

enum {
    CSG_LOCAL_PLACES = 125, /* 5 x 5 x 5 quarters of a cell */
    CSG_CELL_MOST_SEGMENTS = 96,
    CSG_CELL_MOST_POLYGONS = 16,
    /* of a cell without divided edges: */
    CSG_PLAIN_MOST_SEGMENTS = 12,
    CSG_PLAIN_MOST_POLYGONS = 4
};

/* A side of a polygon: from the vertex on one edge to that on another, through a face. Edges, whole
 * or halves, and faces, whole or quarters, are named by their middles: x + 5 y + 25 z in quarters
 * of the cell. */
typedef struct csg_polygon_side {
    uint8_t from, to, face;
    uint8_t crease;  /* a place in the face for a vertex between both: of pierced sides their own */
    bool along_edge; /* both on the halves of one edge that finer leaves divide: it runs in it */
    bool pierced;    /* both on the halves of a pierced edge */
    bool alone;      /* no other segment is in that face */
} csg_polygon_side;

/* Polygons follow one another; counter-clockwise seen from outside the solid. */
typedef struct csg_cell_polygons {
    uint8_t count;
    uint8_t first[CSG_CELL_MOST_POLYGONS + 1];
    csg_polygon_side side[CSG_CELL_MOST_SEGMENTS];
} csg_cell_polygons;

/* Where a face of the cell, or a quarter of one, that has several runs of inside points is looked
 * at: in its middle; or, where a run is the point of a pierced edge, half way from there to the
 * middle of another run of its sign (then count is not 0). Points are those of csg_shell_cell, in
 * the order of their bits. */
typedef struct csg_face_look {
    unsigned face;
    int count;
    uint8_t point[8][3];
    double weight[8]; /* together 1 */
} csg_face_look;

/* Whether the place is inside. */
typedef bool csg_face_is_inside(void *user, const csg_face_look *look);

/* The polygons of cells without divided edges, by the signs of their corners, where no face has to
 * be looked at: nearly all cells are such. */
typedef struct csg_plain_polygons {
    struct {
        bool is_known;
        uint8_t count, first[CSG_PLAIN_MOST_POLYGONS + 1];
        csg_polygon_side side[CSG_PLAIN_MOST_SEGMENTS];
    } of[256];
} csg_plain_polygons;

void csg_plain_polygons_fill(csg_plain_polygons *plain);

void csg_cell_polygons_make(csg_cell_polygons *polygons, const csg_plain_polygons *plain,
                            const csg_shell_cell *cell, csg_face_is_inside *is_inside, void *user);

/* Whether some side that cuts off the point of a pierced edge is in a face with others, which its
 * vertex may lie beyond. */
bool csg_cell_polygons_are_mixed(const csg_cell_polygons *polygons);

/* The place of a middle in quarters of the cell. */
static inline void csg_local_place(unsigned place, unsigned out[3])
{
    out[0] = place % 5, out[1] = place / 5 % 5, out[2] = place / 25;
}

/* The faces of a cell that a middle is in: bit 2 axis + upper. */
static inline uint8_t csg_local_faces(unsigned place)
{
    unsigned q[3], faces = 0;
    csg_local_place(place, q);
    for (unsigned axis = 0; axis < 3; axis++)
        faces |= (q[axis] == 0 ? 1u : q[axis] == 4 ? 2u : 0u) << (2 * axis);
    return (uint8_t)faces;
}

/* Of three parts from the lower of a side's ends, whichever cell asks, to the upper: the k-th along
 * the side. */
static inline unsigned csg_side_part(const csg_polygon_side *side, unsigned k)
{
    return side->from < side->to ? k : 2 - k;
}

/* The number that csg_cell_tables gives an edge of a cell, by its middle. */
static inline uint8_t csg_local_edge(unsigned place)
{
    unsigned q[3];
    csg_local_place(place, q);
    unsigned axis = q[0] == 2 ? 0 : q[1] == 2 ? 1 : 2;
    unsigned u = axis == 0 ? q[1] / 4 : q[0] / 4, v = axis == 2 ? q[1] / 4 : q[2] / 4;
    return (uint8_t)(4 * axis + u + 2 * v);
}

#endif
