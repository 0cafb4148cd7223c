/* SPDX-License-Identifier: MIT
 * Better triangles of the same surface: short edges collapse, edges flip, vertices move along the
 * surface towards the middle of their neighbours, those of straight creases along these. Corners
 * stay. Every change makes the worst triangle around it better, or leaves all of them good; none
 * strays farther from the surface than the mesh did there or does elsewhere, faces another way than
 * the surface, or crosses the rest.
 */
#ifndef CSG_MESH_RESHAPE_IMPROVE_H
#define CSG_MESH_RESHAPE_IMPROVE_H

#include "mesh/remesh/remesh.h"

/* thinned: remesh->error is an error that all triangles must keep; else they are to stray no
 * farther than those that marching cubes made. CSGM_OK, or why it was stopped (reported). */
csgm_status csg_improve(csg_remesh *remesh, bool thinned);

#endif
