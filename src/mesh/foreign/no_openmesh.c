/* SPDX-License-Identifier: MIT
 * A build without OpenMesh; see halfedges.h.
 */
#include "mesh/foreign/halfedges.h"

bool csg_halfedges_available(void)
{
    return false;
}

csg_halfedge_result csg_halfedges_reshape(csg_halfedge_mesh *mesh, const csg_halfedge_goals *goals,
                                          const csg_halfedge_watch *watch)
{
    return CSG_HALFEDGES_REFUSED;
}
