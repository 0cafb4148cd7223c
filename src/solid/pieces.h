/* SPDX-License-Identifier: MIT
 * A node taken apart for hull, minkowski, projection and resize: the members of its sharp unions,
 * each with its place. A piece whose hull is that of some balls gives them (a cloud): corners are
 * balls of radius 0, a torus is a ring of balls, smooth shapes are points within a tolerance.
 * Prisms along z (extrusions, boxes, cylinders) give a flat cloud and two heights. Whatever else it
 * is gets tessellated.
 */
#ifndef CSG_SOLID_PIECES_H
#define CSG_SOLID_PIECES_H

#include "solid/solid.h"

typedef struct csg_solid_piece {
    csg_node_id node;
    csg_affine map; /* from the node's frame */
    double grow;    /* by offsets outside of the map: >= 0 */
} csg_solid_piece;

typedef struct csg_solid_pieces {
    csg_memory *memory;
    csg_solid_piece *items;
    size_t count, capacity;
} csg_solid_pieces;

typedef struct csg_ball {
    csg_vec3 at;
    double radius;
} csg_ball;

typedef struct csg_cloud {
    csg_memory *memory;
    csg_ball *balls;
    size_t count, capacity;
} csg_cloud;

/* How much longer lengths become; 0 when the map is no similarity. */
double csg_map_factor(const csg_affine *map);
/* Its largest singular value: what a tolerance is compared with. */
double csg_map_stretch(const csg_affine *map);
/* Of a flat piece the plane part alone is a similarity or not. */
csg_affine csg_map_of_plane(csg_affine map);
/* half its height and the middle. */
void csg_piece_slab(const csgm_scene *scene, const csg_node *node, double *half, double *middle);

void csg_pieces_init(csg_solid_pieces *pieces, csg_memory *memory);
void csg_pieces_release(csg_solid_pieces *pieces);
void csg_cloud_init(csg_cloud *cloud, csg_memory *memory);
void csg_cloud_release(csg_cloud *cloud);
bool csg_cloud_add(csg_cloud *cloud, csg_vec3 at, double radius);
/* Appends points on the cloud's hull: its farthest in each of many directions, so that the hull of
 * them is within `tolerance` where the cloud's hull is round. flat: directions of the plane. */
bool csg_cloud_spread(const csg_cloud *cloud, double tolerance, bool flat, csg_cloud *out);

/* False: out of memory. */
bool csg_pieces_add(csg_solid_pieces *pieces, csg_solid_piece piece);
/* Appends the node's pieces. False: out of memory. */
bool csg_pieces_collect(const csgm_scene *scene, csg_node_id node, csg_solid_pieces *pieces);
/* Appends balls that have the piece's hull, within `tolerance`. */
csgm_status csg_piece_cloud(csg_solid_job *job, const csg_solid_piece *piece, double tolerance,
                            csg_cloud *out);
bool csg_piece_is_convex(const csg_solid_job *job, const csg_solid_piece *piece);
/* The piece is a prism along z of a flat figure: appends the pieces of the figure (in the plane),
 * and gives the heights. False: it is not, or (with job->stop) memory ran out. */
bool csg_piece_prism(csg_solid_job *job, const csg_solid_piece *piece, csg_solid_pieces *figure,
                     double heights[2]);
/* A copy of a piece in the common frame. */
csg_node_id csg_piece_placed(csg_solid_job *job, const csg_solid_piece *piece);
/* The piece is a ball. */
bool csg_piece_ball(const csgm_scene *scene, const csg_solid_piece *piece, csg_ball *out);

typedef struct csg_clouds {
    csg_memory *memory;
    csg_cloud *items;
    size_t count, capacity;
} csg_clouds;

enum { CSG_MOST_CONVEX_PIECES = 3000 };

void csg_clouds_init(csg_clouds *clouds, csg_memory *memory);
void csg_clouds_release(csg_clouds *clouds);
/* Appends clouds whose hulls' union is the piece (convex_pieces.c says how nearly). CSGM_ERR_LIMIT:
 * there are too many. */
csgm_status csg_piece_convex_clouds(csg_solid_job *job, const csg_solid_piece *piece, double within,
                                    csg_clouds *out);

/* The hull of the balls as a node; flat: of discs in the plane. */
csg_node_id csg_cloud_hull(csg_solid_job *job, const csg_cloud *cloud, double tolerance);
csg_node_id csg_cloud_hull_flat(csg_solid_job *job, const csg_cloud *cloud, double tolerance);

#endif
