/* SPDX-License-Identifier: MIT
 * Colours and materials of a mesh whose places are there.
 */
#ifndef CSG_MESH_PIPELINE_PAINT_H
#define CSG_MESH_PIPELINE_PAINT_H

#include "mesh/marching/marching.h"
#include "mesh/mesh.h"
#include "mesh/pipeline/input.h"
#include "mesh/watch.h"

/* Fills in the colours, where the mesh has room for them, and adds materials where the input has
 * any. CSGM_OK or why it was stopped (reported). */
csgm_status csg_mesh_paint(const csg_mesh_input *input, const csg_marching *marching,
                           csg_mesh_watch *watch, csgm_mesh *mesh);

#endif
