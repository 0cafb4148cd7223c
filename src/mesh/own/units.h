/* SPDX-License-Identifier: MIT
 * Scenes that are polyhedra and nothing else: leaves, boxes, and outlines that are extruded
 * straight, which affine maps place, looks paint and sharp operators combine. Such a solid has
 * triangles of its own: those of its units, where they are so far apart that their boxes do not
 * meet, else those that join.h makes of them.
 */
#ifndef CSG_MESH_OWN_UNITS_H
#define CSG_MESH_OWN_UNITS_H

#include "scene/scene.h"

/* A polyhedron, and what stands above it. */
typedef struct csg_own_unit {
    csg_shape *shape; /* one reference */
    csg_affine place;
    csg_look look;
    csg_node_id node;                      /* whose solid it is */
    csg_box box;                           /* scene units */
    uint32_t first_vertex, first_triangle; /* in one mesh of all units */
} csg_own_unit;

typedef struct csg_own_units {
    csg_memory *memory;
    csg_own_unit *items; /* in the order of the scene */
    size_t count, room;
    uint64_t vertex_count, triangle_count;
    bool are_apart; /* nothing but unions combine them, and their boxes do not meet */
} csg_own_units;

/* count 0: it is not such a scene, or of more vertices than 32 bits can number. CSGM_ERR_MEMORY is
 * not reported. Reset it in any case. */
csgm_status csg_own_units_find(csg_own_units *units, const csgm_scene *scene);
/* One unit in the place of all: a polyhedron, whose reference is taken over, where nothing more
 * moves it. As csg_own_units_find for the rest. */
void csg_own_units_replace(csg_own_units *units, csg_shape *joined);
void csg_own_units_reset(csg_own_units *units);

#endif
