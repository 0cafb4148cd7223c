/* SPDX-License-Identifier: MIT
 * Better triangles of the same mesh: vertices move along the surface towards the middle of their
 * neighbours, edges flip, short ones collapse, and every change passes the checks of remesh.h.
 * Creases and corners stay.
 */
#ifndef CSG_MESH_IMPROVE_H
#define CSG_MESH_IMPROVE_H

#include "mesh/remesh.h"

/* CSGM_OK, or why it was stopped (reported). */
csgm_status csg_improve(csg_remesh *remesh);

#endif
