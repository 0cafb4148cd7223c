/* SPDX-License-Identifier: MIT
 * The vertices that a mesh's triangles have.
 */
#ifndef CSG_MEASURE_MESH_POINTS_H
#define CSG_MEASURE_MESH_POINTS_H

#include "base/context.h"
#include "base/geometry.h"

typedef struct csg_mesh_points {
    csg_vec3 *items; /* each once, in the order of the vertices, from `origin` */
    size_t count, bytes;
    csg_vec3 origin; /* the middle of their box, in the mesh's own coordinates */
    double size;     /* twice the largest distance from there */
} csg_mesh_points;

/* CSGM_ERR_FORMAT (reported): a coordinate is not finite or an index out of range. Release it in
 * any case. */
csgm_status csg_mesh_points_gather(csg_mesh_points *points, csgm_context *context,
                                   const csgm_mesh_view *mesh);
void csg_mesh_points_release(csg_mesh_points *points, csgm_context *context);

#endif
