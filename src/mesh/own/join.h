/* SPDX-License-Identifier: MIT
 * Units that meet, joined to one: the solid that the scene's operators make of them.
 */
#ifndef CSG_MESH_OWN_JOIN_H
#define CSG_MESH_OWN_JOIN_H

#include "mesh/own/units.h"
#include "mesh/watch.h"

/* Nothing is done where they are apart. units->count is 0 afterwards where they cannot be joined:
 * without the library, where nothing is left of the solid or a unit has no triangles or is no
 * closed manifold, and where it would take more memory than there may be. CSGM_OK, or as
 * csg_mesh_why_stopped says. */
csgm_status csg_own_join(csg_own_units *units, const csgm_scene *scene, csg_mesh_watch *watch);

#endif
