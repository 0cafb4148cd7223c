/* SPDX-License-Identifier: MIT
 * What there is of the surface in a cube of the search for missed parts (missed.h): places of it,
 * by Newton's steps, and what the field's gradients say of all of it.
 */
#ifndef CSG_MESH_DISTANCE_MISSED_CUBE_H
#define CSG_MESH_DISTANCE_MISSED_CUBE_H

#include "mesh/remesh/remesh.h"

enum { CSG_MISSED_TURNS = 5 /* along a line */, CSG_MISSED_MOST_TURNS = 2 * CSG_MISSED_TURNS };

/* What is asked, and room of one worker's. */
typedef struct csg_missed_field {
    const csg_remesh *remesh;
    double error, lipschitz;
    float *scratch;
    size_t scratch_floats;
} csg_missed_field;

/* A place of the surface, and the gradient there. */
typedef struct csg_missed_place {
    csg_vec3 at, slope;
} csg_missed_place;

/* What the field's gradients say that there is in a cube. */
typedef enum csg_missed_content {
    CSG_MISSED_UNKNOWN,
    CSG_MISSED_NOTHING,
    CSG_MISSED_SHEET,
    CSG_MISSED_ANYTHING
} csg_missed_content;

/* A cube with the tape that holds in it and around it. */
typedef struct csg_missed_cube {
    csg_vec3 c;
    double half, around, value; /* in the middle, where the cube is small enough for one sheet */
    csg_vec3 slope;             /* there */
    csg_missed_place surface;   /* in the cube or a little around, if there is one */
    csg_tape tape;
    double steepest, doubt; /* how fast the field changes at most along the axes, and its rounding
                               there: in a cube that this one is a part of */
    bool has_surface;
    bool is_sheet;          /* with those around it */
    bool is_bent;           /* where it is one: it may have a crease, or a narrow fillet */
    bool ends;              /* it is not divided */
    bool is_asked, is_near; /* whether that place is near the mesh, and that it is */
    csg_missed_content what;
    uint64_t path; /* of octants from a cube of the octree's frontier, behind a 1 */
} csg_missed_cube;

/* Whether its value in the middle is too large for a surface to be in it. */
bool csg_missed_is_empty(const csg_missed_field *w, const csg_missed_cube *q);
void csg_missed_place_children(const csg_missed_cube *parent, float c[3][CSG_OCTANTS]);
/* The field in the middle of each child, and a place of the surface in it, by the tape that holds
 * in all of them. */
void csg_missed_find_surfaces(const csg_missed_field *w, const csg_missed_cube *parent,
                              csg_missed_cube *children, uint32_t count);
/* Whether the way from a cube's middle to the surface leads out of it. */
bool csg_missed_leads_out(const csg_missed_cube *q);
/* Of up to CSG_OCTANTS cubes in which one tape holds. */
void csg_missed_find_contents(const csg_missed_field *w, csg_missed_cube *const *cubes,
                              size_t count);
/* Places where a sheet turns within the cube: along the line in which tangent planes of both faces
 * meet, from there to the surface. The seam in which solids touch is such a line, too. */
uint32_t csg_missed_find_turns(const csg_missed_field *w, const csg_missed_cube *q,
                               csg_missed_place out[CSG_MISSED_MOST_TURNS]);
/* Whether f changes its sign at a place where it is zero: where parts of a solid touch it is zero
 * within, and outside where nothing is left of a wall. A gap, or a wall, as narrow as the last ring
 * would be none. */
bool csg_missed_is_border(const csg_missed_field *w, const csg_missed_cube *q,
                          const csg_missed_place *at_zero);

#endif
