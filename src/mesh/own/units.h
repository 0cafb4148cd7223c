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

/* In place of the number of a look: there are several, or (of a solid without leaves) none. */
#define CSG_OWN_SEVERAL_LOOKS UINT32_MAX
#define CSG_OWN_NO_LOOK (UINT32_MAX - 1)

/* A polyhedron, and what stands above it. */
typedef struct csg_own_unit {
    csg_shape *shape; /* one reference; NULL: a rest, until it is meshed */
    csg_affine place;
    uint32_t look;                         /* its number among the looks of all */
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
    bool are_apart; /* nothing but unions combine them, and their boxes do not meet */
    csg_look *looks;
    size_t look_count, look_room;
    uint32_t *triangle_looks; /* of units that were joined: a number for each triangle; else NULL */
    size_t triangle_look_room;
} csg_own_units;

/* count 0: it is not such a scene, of more vertices than 32 bits can number, or of so few triangles
 * that cells are as good for what is beside them. CSGM_ERR_MEMORY is not reported. Reset it in any
 * case. */
csgm_status csg_own_units_find(csg_own_units *units, const csgm_scene *scene);
/* A rest has its triangles now, as a polyhedron whose reference is taken over, where nothing more
 * moves it. */
void csg_own_units_give(csg_own_unit *unit, csg_shape *shape);
/* One unit in the place of all, with the numbers of its triangles' looks, which are taken over with
 * their room; as csg_own_units_find for the rest. */
void csg_own_units_replace(csg_own_units *units, csg_shape *joined, uint32_t *triangle_looks,
                           size_t room);
/* Nobody asks how they look: all are alike. */
void csg_own_units_forget_looks(csg_own_units *units);
/* Each unit has one look. */
bool csg_own_units_have_looks(const csg_own_units *units);
void csg_own_units_reset(csg_own_units *units);

#endif
