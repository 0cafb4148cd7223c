/* SPDX-License-Identifier: MIT
 * What the mesh tests share: from a scene made by hand to an inspected mesh, in a context with
 * workers, that must give all its memory back.
 */
#ifndef TEST_MESH_SUPPORT_H
#define TEST_MESH_SUPPORT_H

#include "base/pool.h"
#include "field/cones/cone.h"
#include "field/kernels/dispatch.h"
#include "mesh/inspect.h"
#include "mesh/pipeline/parts.h"
#include "scene/operators/blend.h"
#include "scene/random_scene.h"
#include "scene/scene_support.h"

typedef struct mesh_case {
    csgm_context context;
    csg_scene_builder builder;
    csgm_scene *scene;
    csgm_field *field;
    csgm_mesh *mesh; /* of the last mesh_build */
    csgm_mesh_stats stats;
    csgm_mesh_check check;
    int findings;
    uint16_t last_code; /* of the last finding, 0 = none */
} mesh_case;

void mesh_case_begin(mesh_case *c, uint32_t threads);
void mesh_case_compile(mesh_case *c, csg_node_id root);
void mesh_case_end(mesh_case *c);

/* The defaults of the public interface, at another resolution. */
csgm_mesh_options mesh_options(uint32_t resolution);

/* A second call replaces the mesh of the first. */
csgm_status mesh_build(mesh_case *c, const csgm_mesh_options *options);
/* Must succeed; fills check, and the mesh must be a closed oriented 2-manifold without unused
 * vertices, with unit normals. */
void mesh_build_closed(mesh_case *c, const csgm_mesh_options *options, const char *what);

/* Vertex in the scene's frame. */
csg_vec3 mesh_vertex(const mesh_case *c, uint64_t i);
/* Largest |f| of the reference over the vertices. */
double mesh_largest_error(const mesh_case *c);
void mesh_assert_same(const csgm_mesh *a, const csgm_mesh *b, const char *what);
/* The mesh of the same scene by so many threads and, unless it is AUTO, that instruction set. */
void mesh_assert_same_by(const mesh_case *a, csg_node_id make(mesh_case *c),
                         const csgm_mesh_options *options, uint32_t threads, csgm_isa isa);

/* By how much a gradient is farther along u than the balls' hull is. */
double mesh_beyond_hull(const csg_cone_balls *balls, csg_vec3 g, csg_vec3 u);

/* ---- scenes in short ----------------------------------------------------------------------- */

csg_node_id make_sphere(mesh_case *c, double r);
csg_node_id make_box(mesh_case *c, double hx, double hy, double hz);
csg_node_id make_cylinder(mesh_case *c, double r, double half_height);
csg_node_id make_half_space(mesh_case *c, double nx, double ny, double nz, double d);
/* One of nine sorts of primitives (kind modulo 9) in random sizes, odd kinds without rounding. */
csg_node_id make_any_primitive(mesh_case *c, int kind, csg_random *random);
csg_node_id moved(mesh_case *c, csg_node_id node, double x, double y, double z);
csg_node_id turned(mesh_case *c, csg_node_id node, double angle_deg, csg_vec3 axis);
/* Turned and moved by chance, at most 0.5 along each axis. */
csg_node_id posed_anyhow(mesh_case *c, csg_node_id node, csg_random *random);
csg_node_id joined(mesh_case *c, csg_node_kind kind, csg_blend blend, csg_node_id a, csg_node_id b);

#define SHARP CSG_SHARP
#define ROUND(w) round_blend(w)
csg_blend round_blend(double width);

#endif
