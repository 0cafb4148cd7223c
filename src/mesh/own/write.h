/* SPDX-License-Identifier: MIT
 * Normals for a mesh of polyhedra's own triangles.
 */
#ifndef CSG_MESH_OWN_WRITE_H
#define CSG_MESH_OWN_WRITE_H

#include "base/geometry.h"
#include "mesh/mesh.h"
#include "mesh/remesh/corners.h"

/* Of a sheet at a place of the mesh whose triangles have this normal; false: theirs will do. */
typedef bool csg_own_normal_of(void *user, csg_vec3 place, csg_vec3 face, csg_vec3 *normal);
/* How far apart the two may be. */
#define CSG_OWN_LEAST_COSINE 0.7

/* A copy of the mesh with normals, not painted: what normal_of (NULL: nothing) says, or the means
 * of those of the triangles around a vertex, by their angles there. split: where they turn by more
 * than a crease's angle, or the numbers of their looks (NULL: all are alike) differ, a vertex for
 * each sheet. Reports what fails (memory only). */
csgm_status csg_own_write_normals(csgm_context *context, const csgm_mesh *mesh,
                                  const csg_corners *corners, bool split, const uint32_t *looks,
                                  csg_own_normal_of *normal_of, void *user, csgm_mesh **out);

#endif
