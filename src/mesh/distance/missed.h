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
#include "mesh/distance/change.h"

/* A place of the surface where it is not one flat sheet, and the triangle that is nearest to it. */
typedef struct csg_missed_point {
    float at[3];
    uint32_t triangle;
} csg_missed_point;

/* How far places of the surface are from the mesh. */
typedef struct csg_missed_distances {
    double farthest;
    csg_vec3 place;  /* where that is, field frame */
    double unlisted; /* the farthest of those that are not among the points: too far, or too many */
} csg_missed_distances;

/* A small cube that was looked through, for a search with another mesh that is the same around it:
 * what is found there depends on no triangle that is farther than the error, and than the farthest
 * of its places.
 */
typedef struct csg_missed_stretch {
    uint64_t cube, path; /* of the octree's frontier; the octants from there, behind a 1 */
    size_t first, count; /* of the points */
    uint64_t effort;
    csg_missed_distances distances;
} csg_missed_stretch;

typedef struct csg_missed {
    csg_missed_point *points;
    size_t count, capacity;
    csg_missed_stretch *stretches; /* by cube, then by path */
    size_t stretch_count, stretch_capacity;
    csg_missed_distances distances; /* of all places looked at */
    uint64_t
        unfinished; /* cubes of the octree's frontier that have more in them than is looked at */
} csg_missed;

/* A search, and the mesh that it was made with. */
typedef struct csg_missed_before {
    csg_missed missed;
    csg_written_triangles triangles;
} csg_missed_before;

/* error: what is nearer than that is not missed. CSGM_OK or why it was stopped (reported); the same
 * for any number of threads. before: a search with another mesh of the same field and lattice, and
 * the same error, which is not made again where the mesh is the same; empty: there was none. keeps:
 * *out has the stretches for csg_missed_keep(), which take some MB. */
csgm_status csg_missed_find(const csg_remesh *remesh, double error, const csg_missed_before *before,
                            bool keeps, csg_missed *out);
/* What it found in a cube; NULL: nothing is known of that. */
const csg_missed_stretch *csg_missed_find_stretch(const csg_missed *missed, uint64_t cube,
                                                  uint64_t path);
/* Keeps a search, which is taken over, in place of that before; nothing where there is no memory
 * for it. */
void csg_missed_keep(const csg_remesh *remesh, csg_missed *missed, csg_missed_before *before);
void csg_missed_before_release(csg_missed_before *before, csg_memory *memory);
/* In place of a search: what the judge of cells saw (adaptive/seen.h), as far as the mesh, which
 * may be a part of one, is within the error of it. CSGM_OK, or why it was stopped (reported): then
 * there is nothing to release. */
csgm_status csg_missed_take_seen(const csg_remesh *remesh, const csg_seen *seen, double error,
                                 csg_missed *out);
void csg_missed_release(csg_missed *missed, csg_memory *memory);

#endif
