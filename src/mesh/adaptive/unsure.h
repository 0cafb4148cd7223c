/* SPDX-License-Identifier: MIT
 * Places of the surface that the judge found near a side of a brick, with none of the brick's own
 * triangles near them: a bump through which a side goes, a drop in a corner. They are held against
 * the whole mesh when it is there.
 */
#ifndef CSG_MESH_ADAPTIVE_UNSURE_H
#define CSG_MESH_ADAPTIVE_UNSURE_H

#include "mesh/adaptive/extraction.h"

/* Wants the leaves divided that hold such places away from x->mesh, and forgets all of them. *any:
 * there are some that can be divided; the mesh is to be made again after refinement. CSGM_OK or
 * CSGM_ERR_MEMORY (reported). */
csgm_status csg_unsure_check(csg_extraction *x, bool *any);

#endif
