/* SPDX-License-Identifier: MIT
 * Whether a mesh of polyhedra's own triangles is as good as one that is made: closed, not running
 * through itself, and with the solid on the inner side of every triangle; with places as they are
 * in the mesh, rounded to floats.
 */
#ifndef CSG_MESH_OWN_SOUND_H
#define CSG_MESH_OWN_SOUND_H

#include "mesh/mesh.h"
#include "mesh/own/units.h"
#include "mesh/remesh/corners.h"
#include "mesh/watch.h"

/* corners: of the mesh, which has the units' vertices and triangles in their order. CSGM_OK, or as
 * csg_mesh_why_stopped says. */
csgm_status csg_own_is_sound(const csg_own_units *units, const csgm_mesh *mesh,
                             const csg_corners *corners, csg_mesh_watch *watch, bool *sound);

#endif
