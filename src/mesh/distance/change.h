/* SPDX-License-Identifier: MIT
 * Where a mesh is another one than before: what was found out about the rest of it still holds.
 */
#ifndef CSG_MESH_DISTANCE_CHANGE_H
#define CSG_MESH_DISTANCE_CHANGE_H

#include "mesh/remesh/remesh.h"

/* The triangles of a mesh as it is written, sorted, so that they can be held against those of
 * another one. */
typedef struct csg_written_triangles {
    struct csg_written_triangle *items;
    size_t count;
} csg_written_triangles;

/* Of those that are live. False: out of memory, nothing to release. */
bool csg_written_triangles_list(const csg_remesh *remesh, csg_written_triangles *out);
void csg_written_triangles_release(csg_written_triangles *triangles, csg_memory *memory);

/* Boxes around triangles. */
typedef struct csg_changed_boxes {
    csg_box *items; /* field frame */
    size_t count, capacity;
} csg_changed_boxes;

/* Around those that only one of two meshes of one lattice has. False: out of memory; to be
 * released. */
bool csg_changed_boxes_find(const csg_remesh *remesh, const csg_written_triangles *before,
                            const csg_written_triangles *now, csg_changed_boxes *out);
/* Those that come as near to a cube as `reach`, in place of what is in *out. False: out of memory.
 */
bool csg_changed_boxes_select(const csg_changed_boxes *boxes, csg_vec3 middle, double half,
                              double reach, csg_memory *memory, csg_changed_boxes *out);
/* Whether any of them does. */
bool csg_changed_boxes_come_near(const csg_changed_boxes *boxes, csg_vec3 middle, double half,
                                 double reach);
void csg_changed_boxes_release(csg_changed_boxes *boxes, csg_memory *memory);

#endif
