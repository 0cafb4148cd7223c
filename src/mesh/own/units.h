/* SPDX-License-Identifier: MIT
 * Scenes of polyhedra: leaves (leaves.h) that affine maps place, looks paint and sharp operators
 * combine. Such a solid has triangles of its own: those of its units, where they are so far apart
 * that their boxes do not meet, else those that join.h makes of them. Beside polyhedra there may be
 * other operands; they become units, too, and their triangles are made by cells
 * (pipeline/own_rests.h).
 */
#ifndef CSG_MESH_OWN_UNITS_H
#define CSG_MESH_OWN_UNITS_H

#include "scene/scene.h"
#include "scene/tree/excerpt.h"

/* A polyhedron, and what stands above it. */
typedef struct csg_own_unit {
    csg_shape *shape; /* one reference; NULL: a rest, until it is meshed */
    csg_affine place;
    csg_look look;
    csg_node_id node;                      /* whose solid it is, or one operand of which */
    csg_box box;                           /* scene units */
    uint32_t first_vertex, first_triangle; /* in one mesh of all units */
    /* Of a rest: operands of one operator that are no polyhedra, which this sharp operator takes
     * together. */
    csg_node_kind kind;
    bool is_operand; /* of `node`, an operator; else it is that node */
    size_t first_member, member_count;
} csg_own_unit;

typedef struct csg_own_units {
    csg_memory *memory;
    csg_own_unit *items; /* by their nodes, ascending */
    size_t count, room;
    csg_excerpt_item *members; /* of rests */
    size_t member_count, member_room, rest_count;
    uint64_t vertex_count, triangle_count;
    bool are_apart;  /* nothing but unions combine them, and their boxes do not meet */
    bool look_alike; /* all leaves of the scene do: */
    csg_look look;
} csg_own_units;

/* count 0: it is not such a scene, of more vertices than 32 bits can number, or of so few triangles
 * that cells are as good for what is beside them. CSGM_ERR_MEMORY is not reported. Reset it in any
 * case. */
csgm_status csg_own_units_find(csg_own_units *units, const csgm_scene *scene);
/* A rest has its triangles now, as a polyhedron whose reference is taken over, where nothing more
 * moves it. */
void csg_own_units_give(csg_own_unit *unit, csg_shape *shape);
/* One unit in the place of all; as csg_own_units_find for the rest. */
void csg_own_units_replace(csg_own_units *units, csg_shape *joined);
void csg_own_units_reset(csg_own_units *units);

#endif
