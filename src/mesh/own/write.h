/* SPDX-License-Identifier: MIT
 * Normals for a mesh of polyhedra's own triangles.
 */
#ifndef CSG_MESH_OWN_WRITE_H
#define CSG_MESH_OWN_WRITE_H

#include "mesh/mesh.h"
#include "mesh/remesh/corners.h"

/* A copy of the mesh with normals: the means of those of the triangles around a vertex, by their
 * angles there. split: where they turn by more than a crease's angle, a vertex for each sheet.
 * Reports what fails (memory only). */
csgm_status csg_own_write_normals(csgm_context *context, const csgm_mesh *mesh,
                                  const csg_corners *corners, bool split, csgm_mesh **out);

#endif
