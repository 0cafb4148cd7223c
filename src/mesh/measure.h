/* SPDX-License-Identifier: MIT
 * How far the surface is from a finished mesh, measured: against the vertices, which lie on the
 * surface, of a mesh of other cells of the same field. What those find and the mesh's own did not
 * is too small for these.
 */
#ifndef CSG_MESH_MEASURE_H
#define CSG_MESH_MEASURE_H

#include "mesh/remesh.h"

/* A mesh of cells of this size is made and thrown away. CSGM_OK, or why not (reported). */
csgm_status csg_mesh_measure(const csg_remesh *remesh, double cell_size, double *distance);

/* Of work->mesh to goal->against, into goal->measured. */
csgm_status csg_mesh_measure_against(csg_mesh_work *work);

#endif
