/* SPDX-License-Identifier: MIT
 * What of the surface a mesh may have missed: the field's octree is walked again, cube by cube,
 * down to where a cube is near the mesh, or holds one sheet that is near the mesh (all gradients
 * where the field is zero within a cone; a wider one in each of its eight parts), or no surface.
 * What is left is smaller than the error; the places of the surface there are what the mesh must
 * come near to beside its own vertices: tips, thin sheets, drops between the points of the lattice.
 */
#ifndef CSG_MESH_DISTANCE_MISSED_H
#define CSG_MESH_DISTANCE_MISSED_H

#include "mesh/adaptive/seen.h"
#include "mesh/remesh/remesh.h"

/* A place of the surface where it is not one flat sheet, and the triangle that is nearest to it. */
typedef struct csg_missed_point {
    float at[3];
    uint32_t triangle;
} csg_missed_point;

typedef struct csg_missed {
    csg_missed_point *points;
    size_t count, capacity;
    double farthest; /* of all places looked at, from the mesh */
    csg_vec3 place;  /* where that is, field frame */
    double unlisted; /* the same, of those that are not among the points: too far, or too many */
    uint64_t
        unfinished; /* cubes of the octree's frontier that have more in them than is looked at */
} csg_missed;

/* error: what is nearer than that is not missed. CSGM_OK or why it was stopped (reported); the same
 * for any number of threads. */
csgm_status csg_missed_find(const csg_remesh *remesh, double error, csg_missed *out);
/* In place of a search: what the judge of cells saw (adaptive/seen.h), as far as the mesh, which
 * may be a part of one, is within the error of it. CSGM_OK, or why it was stopped (reported): then
 * there is nothing to release. */
csgm_status csg_missed_take_seen(const csg_remesh *remesh, const csg_seen *seen, double error,
                                 csg_missed *out);
void csg_missed_release(csg_missed *missed, csg_memory *memory);

#endif
