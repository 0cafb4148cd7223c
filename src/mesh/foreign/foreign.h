/* SPDX-License-Identifier: MIT
 * Meshes that others made and that no field stands behind: mended, thinned out, smoothed, improved,
 * part by part. Names, colours and materials stay; normals are made anew where there were any.
 */
#ifndef CSG_MESH_FOREIGN_FOREIGN_H
#define CSG_MESH_FOREIGN_FOREIGN_H

#include "mesh/foreign/halfedges.h"
#include "mesh/mesh.h"
#include "mesh/watch.h"

/* What to do, in scene units; all zero: mending alone. */
typedef struct csg_foreign_goals {
    double within;   /* > 0 */
    double share;    /* > 0, < 1: so many of each part's triangles */
    uint32_t smooth; /* rounds */
    double improve;  /* > 0: as of csg_halfedge_goals */
    bool tells;      /* what was mended, and what was left as it is, is a warning */
} csg_foreign_goals;

/* The watch is in the stage and has the share that this shall have of it. Indices are in range and
 * positions finite. Every failure is reported but CSGM_CANCELLED. */
csgm_status csg_foreign_reshape(csg_mesh_watch *watch, const csgm_mesh_view *mesh,
                                const csg_foreign_goals *goals, csgm_mesh **out);

#endif
