/* SPDX-License-Identifier: MIT
 * Places of the surface that the judge found near a side of a brick, with none of the brick's own
 * triangles near them: a bump through which a side goes, a drop in a corner. They are held against
 * the triangles of all leaves around.
 */
#ifndef CSG_MESH_ADAPTIVE_UNSURE_H
#define CSG_MESH_ADAPTIVE_UNSURE_H

#include "mesh/adaptive/extraction.h"

/* Places that are held against the mesh. */
typedef struct csg_unsure {
    struct csg_unsure_place *places; /* sorted along x */
    size_t count;
} csg_unsure;

/* Takes them over from the judge, who forgets them. CSGM_OK or why it ends (reported): then there
 * is nothing to end. */
csgm_status csg_unsure_begin(csg_extraction *x, csg_unsure *unsure);
/* Holds them against a mesh, or one part of it after the other. */
void csg_unsure_look(const csg_extraction *x, csg_unsure *unsure, const csgm_mesh *mesh);
/* Wants the leaves divided that hold places away from all of it. True: there are some that can be
 * divided; what it was held against is another one after refinement. */
bool csg_unsure_end(csg_extraction *x, csg_unsure *unsure);

/* Places that somebody else has found, for the next time that they are taken over from the judge.
 * False: out of memory. */
bool csg_unsure_add(csg_extraction *x, const csg_vec3 *places, size_t count);

/* All three, with the triangles of the leaves around the places, before the mesh is made. CSGM_OK
 * or as csg_extract_part. */
csgm_status csg_unsure_check(csg_extraction *x, bool *any);

#endif
