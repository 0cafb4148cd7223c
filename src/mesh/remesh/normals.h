/* SPDX-License-Identifier: MIT
 * Normals for shading. What a viewer mixes between the corners of a triangle has to look like the
 * surface all over it, not at its corners alone: where a large plane triangle ends in a rounding,
 * within the error of it, the field's own normals there would make the plane look bent.
 */
#ifndef CSG_MESH_REMESH_NORMALS_H
#define CSG_MESH_REMESH_NORMALS_H

#include "mesh/remesh/remesh.h"

/* One for each number that corners have, outward, of any length; (0, 0, 0) where there is none.
 * number: per corner. False: stopped, or without memory; the watch knows. */
bool csg_remesh_find_normals(csg_remesh *remesh, const uint32_t *number, uint32_t count,
                             csg_vec3 *normals);

#endif
