/* SPDX-License-Identifier: MIT
 * Convex pieces of a triangle, for the search of the largest distance to another mesh: how far a
 * piece can be from a triangle of that, and how it is cut so that this is better known.
 */
#ifndef CSG_SHAPE_PIECE_H
#define CSG_SHAPE_PIECE_H

#include "shape/polyhedra/tree.h"

enum { CSG_PIECE_CORNERS = 12, CSG_PIECE_PARTS = 4 };

typedef struct csg_piece {
    csg_vec3 corners[CSG_PIECE_CORNERS];
    uint32_t count; /* at least 3 */
    uint32_t hint;  /* a triangle of the other mesh, by its place */
    double bound;   /* no point of the piece is farther from the other mesh */
} csg_piece;

csg_vec3 csg_piece_center(const csg_piece *piece);
/* Of the ball around the centre that holds it. */
double csg_piece_radius(const csg_piece *piece, csg_vec3 center);
/* The distance to a triangle is a convex function of the point, so its maximum over the piece is at
 * a corner: an upper bound of the distance to the whole mesh. */
double csg_piece_bound(const csg_piece *piece, const csg_tree_triangle *triangle, uint32_t *corner);
/* Whether that is at most `enough`. */
bool csg_piece_is_within(const csg_piece *piece, const csg_tree_triangle *triangle, double enough);

/* How exactly distances to a tree's triangles are computed, frame units. */
double csg_piece_slack(const csg_tree *tree);

/* Parts that together are the piece, with its bound and hint: at most CSG_PIECE_PARTS. By the edges
 * of the triangle that is nearest to `center`, in the piece; where that is nearest beside its face,
 * and where it would not help, across the longest extent. Less than 2: too small to be cut. */
uint32_t csg_piece_divide(const csg_piece *piece, const csg_tree_triangle *triangle,
                          csg_vec3 center, csg_piece *parts);
/* Parts that together are the piece, their bound not set: at most CSG_PIECE_PARTS. Across its
 * longest extent; 1: too small to be cut. */
uint32_t csg_piece_halve(const csg_piece *piece, csg_piece *parts);
/* By the planes on the edges of `triangle` and at right angles to it; the part that projects into
 * the triangle is the last. 0: it would not get much smaller. */
uint32_t csg_piece_cut(const csg_piece *piece, const csg_tree_triangle *triangle, csg_piece *parts);

#endif
