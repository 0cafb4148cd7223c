/* SPDX-License-Identifier: MIT
 * Fewer triangles within an error: edges are collapsed, cheapest first by quadrics, and every
 * collapse is checked before it is made: against samples of the surface that each triangle answers
 * for, and where these come near the error, or sheets near each other, the triangles against the
 * field (remesh/remesh.h).
 */
#ifndef CSG_MESH_RESHAPE_DECIMATE_H
#define CSG_MESH_RESHAPE_DECIMATE_H

#include "mesh/reshape/decimation.h"
#include "mesh/reshape/far.h"

/* CSGM_OK or why it was stopped (reported). The error may grow from one csg_decimate to the next.
 */
csgm_status csg_decimation_begin(csg_decimation *decimation, csg_remesh *remesh,
                                 const csg_missed *missed, csg_begun_samples *begun);
void csg_decimation_end(csg_decimation *decimation);

enum { CSG_DECIMATE_ALL = 4 /* of triangles: fewer there are never */ };

/* Collapses what remesh->error allows until `least` triangles are left. CSGM_OK, or why it was
 * stopped (reported). */
csgm_status csg_decimate(csg_decimation *decimation, uint32_t least);

/* The same in cubes of space alone, within the box from low to high, of a mesh that is a part of
 * one: what is at its border stays as it is. share: of what is left of the stage, for progress. */
csgm_status csg_decimate_within(csg_decimation *d, csg_vec3 low, csg_vec3 high, double share);

/* The largest distance of a sample to the mesh as it is now, but for those that are farther than
 * the error: these are added to `far`. False: out of memory. */
bool csg_decimation_measure(const csg_decimation *decimation, double error, csg_far_places *far,
                            double *most);

#endif
