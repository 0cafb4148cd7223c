/* SPDX-License-Identifier: MIT
 * A mesh while its triangles are made better: what improve.c (passes, moving, flipping),
 * improve_collapse.c and improve_check.c (what every change must pass) share.
 */
#ifndef CSG_MESH_RESHAPE_IMPROVER_H
#define CSG_MESH_RESHAPE_IMPROVER_H

#include "mesh/remesh/remesh.h"

enum { CSG_PATCH_MOST = CSG_CORNERS_MOST_VALENCE };

/* Triangles around a place, as they are and as they would be. */
typedef struct csg_patch {
    csg_vec3 now[CSG_PATCH_MOST][3], then[CSG_PATCH_MOST][3];
    uint32_t vertex[CSG_PATCH_MOST][3]; /* of those to come */
    uint32_t now_count, then_count;
    uint32_t vertices[2], triangles[2]; /* whose place they take: see remesh/crossing.h */
} csg_patch;

typedef struct csg_improver {
    csg_remesh *remesh;
    bool thinned;
    double allowed; /* |f| that is common in this mesh */
    csg_patch patch;
} csg_improver;

/* |f| at centroids that only a fiftieth exceeds. False: out of memory. */
bool csg_improver_measure(csg_improver *improver);
/* All but shape: the patch may take its place. */
bool csg_patch_is_sound(csg_improver *improver);
/* Whether a vertex may take the colour and material of another place, *look: where triangles are
 * large, only if it has them already. */
bool csg_improve_looks_alike(csg_improver *improver, uint32_t vertex, csg_vec3 at,
                             csg_look_at_vertex *look);

/* The edge that starts at this corner. */
bool csg_improve_collapse(csg_improver *improver, uint32_t corner);

#endif
