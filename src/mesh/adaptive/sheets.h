/* SPDX-License-Identifier: MIT
 * Where sheets of the surface meet: in a point of a face of a cell, in a point within a cell. Each
 * sheet stands in by its tangent plane at a point a little off the place sought, towards its own
 * vertices, where the field is that sheet's alone. Planes meet in a better place, points move
 * closer to it: on plane faces the first meeting is exact, on curved ones the error falls with the
 * square of the distance.
 *
 * Nothing outside the cell is asked, so a place depends on the cell's own tape alone.
 */
#ifndef CSG_MESH_ADAPTIVE_SHEETS_H
#define CSG_MESH_ADAPTIVE_SHEETS_H

#include "field/kernels/kernel.h"

enum { CSG_POLYGON_MOST = 64 /* vertices */, CSG_POLYGON_MOST_SHEETS = 12 };

/* The field in a brick, one thread's. */
typedef struct csg_sheet_probe {
    const csg_kernel *kernel;
    const csg_tape *tape;
    float *scratch;
    size_t scratch_floats;
    double noise; /* of values: rounding */
    double near;  /* how far from where sheets meet a point may be that stands for it */
    uint64_t evaluations;
} csg_sheet_probe;

/* A cell, or a face of one: then low and high are equal on one axis. */
typedef struct csg_cell_box {
    double low[3], high[3], cell;
} csg_cell_box;

typedef struct csg_surface_point {
    csg_vec3 at, gradient;
} csg_surface_point;

/* A face, two points of its border, and, found between them, whether a crease goes through the face
 * and where, as floats: within it, with a margin to its sides. */
typedef struct csg_face_crease {
    csg_cell_box face;
    csg_surface_point ends[2];
    bool is_wedge; /* both points are on one edge of the face, which a wedge pokes through: there is
                      a place always, where its sheets meet, else where the surface is beside the
                      edge */
    bool is_there;
    bool is_torn;   /* what is there does not join the sheets that the points are on: there is a
                       third one between them */
    bool is_smooth; /* no crease: the surface, and its gradient, half way between the points */
    csg_vec3 at, gradient;
} csg_face_crease;

enum { CSG_MOST_FACES = 36 }; /* at once: those of a brick */

void csg_sheets_meet_in_faces(csg_sheet_probe *probe, csg_face_crease *faces, int count);

/* What is between two points of a face's border: a crease, or a bend, and where it is a bend what
 * is between it and either point. */
enum { CSG_BELOW, CSG_BETWEEN, CSG_ABOVE, CSG_SIDE_PARTS };
typedef struct csg_face_side {
    csg_face_crease part[CSG_SIDE_PARTS];
} csg_face_side;

/* The face, ends and is_wedge of CSG_BETWEEN are given. A bend is a place where the surface,
 * curved, is farther than `most` from the straight way between the points (bulges.c). divides:
 * there may be other parts than that. */
void csg_sheets_find_in_faces(csg_sheet_probe *probe, csg_face_side *sides, int count, double most,
                              bool divides);

/* Whether some part joins sheets that do not meet there. */
static inline bool csg_face_side_is_torn(const csg_face_side *side)
{
    return side->part[CSG_BELOW].is_torn || side->part[CSG_BETWEEN].is_torn ||
           side->part[CSG_ABOVE].is_torn;
}

/* A loop on the faces of a cell: vertices on its edges, which have gradients, and within its faces,
 * where crease points have none. */
typedef struct csg_polygon {
    int count, in_faces;
    uint32_t vertex[CSG_POLYGON_MOST];
    uint8_t
        faces[CSG_POLYGON_MOST]; /* of a whole cell: those that a vertex is in, a bit for each */
    csg_surface_point point[CSG_POLYGON_MOST];
    bool is_crease[CSG_POLYGON_MOST];
    bool is_torn; /* some face has one crease where there are two */
} csg_polygon;

static inline int csg_polygon_crease_count(const csg_polygon *polygon)
{
    int count = 0;
    for (int i = 0; i < polygon->count; i++)
        count += polygon->is_crease[i];
    return count;
}

/* How far the gradients of a polygon turn: the least cosine to their mean. */
double csg_polygon_least_cosine(const csg_polygon *polygon);

typedef enum csg_apex_kind {
    CSG_APEX_SMOOTH, /* on the surface, or near it */
    CSG_APEX_CREASE, /* where the sheets meet */
    CSG_APEX_FAILED  /* sheets should meet, but not here: it is only near the surface */
} csg_apex_kind;

/* A polygon in a cell, and, found for it, the point that its triangles meet in, as floats: strictly
 * within the cell, so that the fan around it meets neither itself nor what is in other cells. */
typedef struct csg_apex_search {
    csg_cell_box box;
    const csg_polygon *polygon;
    csg_apex_kind kind;
    csg_vec3 at;
} csg_apex_search;

enum { CSG_MOST_APEXES = 8 }; /* at once; of more, eight by eight */

void csg_polygons_find_apexes(csg_sheet_probe *probe, csg_apex_search *searches, int count);

/* Cosine of 12 degrees: where sheets, or gradients of one polygon, differ by less, there is no
 * crease that must be kept. */
#define CSG_LEAST_CREASE_COSINE 0.978

/* Cosine of the angle between two gradients; 1 where one is 0. */
double csg_gradients_cosine(csg_vec3 a, csg_vec3 b);

#endif
