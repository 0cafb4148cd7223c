/* SPDX-License-Identifier: MIT
 * Polyhedra whose own triangles are the mesh: scenes of them, and what is asked of the mesh.
 */
#ifndef OWN_SUPPORT_H
#define OWN_SUPPORT_H

#include "mesh/mesh_support.h"
#include "shape/outline_support.h"
#include "shape/polyhedra/polyhedron.h"

csg_node_id shape_of(mesh_case *c, const csg_triangles *triangles);
csg_node_id make_ball(mesh_case *c, csg_vec3 center, double radius, uint32_t columns, double bumps);
/* A flat node; the outline is released. */
csg_node_id region_of(mesh_case *c, csg_outline *outline);
csgm_mesh_options plain(void);
/* Whether they are taken; if not, nothing is meshed. */
bool is_taken(mesh_case *c, const csgm_mesh_options *options);
uint64_t own_of(mesh_case *c, const csgm_mesh_options *options);
/* Where the solid is, the mesh winds around once, elsewhere never, but for places so near to its
 * surface. */
void assert_winds_beyond(const mesh_case *c, csg_random *random, double near);
void assert_winds_around(const mesh_case *c, csg_random *random);

/* Of the scene's mesh, with normals parted by creases, and within a tolerance (0: as it is): each
 * allocation, or one of `step`, fails once; it says so once, and nothing is left behind. */
void own_fail_each_allocation(csg_node_id make(mesh_case *c), double tolerance, long step);

#endif
