/* SPDX-License-Identifier: MIT
 * A part of a closed mesh, cut off along edges, as a closed mesh: so a corner table holds it. Each
 * border is closed by a fan of triangles around a vertex more. Where several fans of the part meet
 * in one vertex of its border, each gets a vertex of its own.
 */
#ifndef CSG_MESH_REMESH_CLOSE_H
#define CSG_MESH_REMESH_CLOSE_H

#include "mesh/mesh.h"
#include "mesh/remesh/corners.h"

typedef struct csg_closed_mesh {
    csgm_mesh *mesh;    /* closing triangles first, then those of the part in their order */
    uint32_t closing;   /* triangles */
    uint32_t *original; /* per vertex: the part's; CSG_CORNER_NONE: in the middle of a fan */
    uint8_t *at_border; /* per vertex */
} csg_closed_mesh;

/* CSGM_OK or CSGM_ERR_MEMORY (reported). A part that is none, since an edge has two triangles on
 * one side, comes out as no closed mesh. */
csgm_status csg_mesh_close(const csgm_mesh *part, csg_closed_mesh *out);
void csg_closed_mesh_release(csg_closed_mesh *closed);

#endif
