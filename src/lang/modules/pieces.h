/* SPDX-License-Identifier: MIT
 * A node taken apart for hull, minkowski, projection and resize: the members of its sharp unions,
 * each with its place. A piece whose hull is that of some balls gives them (a cloud): corners are
 * balls of radius 0, a torus is a ring of balls, smooth shapes are points within a tolerance.
 * Prisms along z (extrusions, boxes, cylinders) give a flat cloud and two heights. Whatever else it
 * is gets tessellated.
 */
#ifndef CSG_LANG_PIECES_H
#define CSG_LANG_PIECES_H

#include "lang/modules/shapes.h"

typedef struct csg_piece {
    csg_node_id node;
    csg_affine map; /* from the node's frame */
    double grow;    /* by offsets outside of the map: >= 0 */
} csg_piece;

typedef struct csg_pieces {
    csg_memory *memory;
    csg_piece *items;
    size_t count, capacity;
} csg_pieces;

typedef struct csg_ball {
    csg_vec3 at;
    double radius;
} csg_ball;

typedef struct csg_cloud {
    csg_memory *memory;
    csg_ball *balls;
    size_t count, capacity;
} csg_cloud;

void csg_pieces_init(csg_pieces *pieces, csg_memory *memory);
void csg_pieces_release(csg_pieces *pieces);
void csg_cloud_init(csg_cloud *cloud, csg_memory *memory);
void csg_cloud_release(csg_cloud *cloud);
bool csg_cloud_add(csg_cloud *cloud, csg_vec3 at, double radius);
/* Appends points on the cloud's hull: its farthest in each of many directions, so that the hull of
 * them is within `tolerance` where the cloud's hull is round. flat: directions of the plane. */
bool csg_cloud_spread(const csg_cloud *cloud, double tolerance, bool flat, csg_cloud *out);

/* False: out of memory. */
bool csg_pieces_add(csg_pieces *pieces, csg_piece piece);
/* Appends the node's pieces. False: out of memory. */
bool csg_pieces_collect(const csg_eval *e, csg_node_id node, csg_pieces *pieces);
/* Appends balls that have the piece's hull, within `tolerance`. */
csgm_status csg_piece_cloud(csg_module_call *call, const csg_piece *piece, double tolerance,
                            csg_cloud *out);
bool csg_piece_is_convex(const csg_eval *e, const csg_piece *piece);
/* The piece is a prism along z of a flat figure: appends the pieces of the figure (in the plane),
 * and gives the heights. False: it is not, or (with e->stop) memory ran out. */
bool csg_piece_prism(csg_eval *e, const csg_piece *piece, csg_pieces *figure, double heights[2]);
/* The piece is a ball. */
bool csg_piece_ball(const csg_eval *e, const csg_piece *piece, csg_ball *out);

/* ---- whole nodes (measure.c) ---------------------------------------------------------------- */

/* Is the field below the node the exact distance outside (or inside) of its solid? */
bool csg_distance_is_exact(const csg_eval *e, csg_node_id node, bool outside);
/* Clean polygons of a flat node: its own corners, arcs within 1e-5 of its size. */
csgm_status csg_flat_outline(csg_module_call *call, csg_node_id node, csg_outline *out);
/* Triangles on the surface of a solid, by marching cubes. */
csgm_status csg_solid_triangles(csg_module_call *call, csg_node_id node, csg_triangles *out);
/* The box of the node's solid, tight where its pieces are known, else within a cell of a
 * tessellation. */
csgm_status csg_tight_box(csg_module_call *call, csg_node_id node, csg_box *out);
/* Longest side of the node's box; reports and fails where it is infinite. */
bool csg_finite_size(csg_module_call *call, csg_node_id node, double *out);

/* The hull of the balls as a node; flat: of discs in the plane. */
csg_node_id csg_cloud_hull(csg_module_call *call, const csg_cloud *cloud, double tolerance);
csg_node_id csg_cloud_hull_flat(csg_module_call *call, const csg_cloud *cloud, double tolerance);

#endif
