/* SPDX-License-Identifier: MIT
 * Triangles for what is no polyhedron in a scene of polyhedra: operands that cells which follow the
 * shape are made for, each by itself, within the tolerance of the whole.
 */
#ifndef CSG_MESH_PIPELINE_OWN_RESTS_H
#define CSG_MESH_PIPELINE_OWN_RESTS_H

#include "mesh/own/units.h"
#include "mesh/own/write.h"
#include "mesh/pipeline/input.h"
#include "scene/reference.h"

/* What is known of one when it has been meshed. */
typedef struct csg_own_rest {
    csgm_scene *scene;
    csg_box box; /* scene units */
    csg_reference_room room;
} csg_own_rest;

typedef struct csg_own_rests {
    const csg_mesh_input *input;
    csg_own_rest *items;
    size_t count, room;
    double tolerance, started_s;
    csgm_mesh_stats stats; /* of all of them together */
} csg_own_rests;

/* Meshes the units that are rests. A unit stays without a shape where nothing is left of it, or its
 * mesh is no polyhedron. Reports what fails. Release it in any case. */
csgm_status csg_own_rests_mesh(csg_own_rests *rests, csg_own_units *units,
                               const csg_mesh_input *input);
void csg_own_rests_release(csg_own_rests *rests);

/* As csg_own_write_normals asks: the field's normal where a place of the mesh lies on a rest's
 * surface, towards the side that the triangles there face. user: csg_own_rests. */
csg_own_normal_of csg_own_rests_normal;

#endif
