/* SPDX-License-Identifier: MIT
 * Argument check shared by the mesh and file halves of the public interface.
 */
#ifndef CSG_API_VIEW_H
#define CSG_API_VIEW_H

#include "csgmesh/csgmesh.h"

/* Arrays are there where counts say so; indices are not looked at. */
static inline bool csg_view_is_sound(const csgm_mesh_view *mesh)
{
    return mesh && mesh->vertex_count <= UINT32_MAX && (mesh->positions || !mesh->vertex_count) &&
           (mesh->indices || !mesh->triangle_count);
}

#endif
