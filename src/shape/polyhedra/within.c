/* SPDX-License-Identifier: MIT
 * Depth first; see within.h. The distance to one triangle is a convex function of the point, so
 * what it is at the corners bounds it all over a piece; what is above the limit is cut along the
 * nearest triangle's edges, or halved, and its parts looked up anew. Every centre and corner that
 * is looked up may be the place that is too far away.
 */
#include "shape/polyhedra/within.h"

enum { STACK = 160 };

static double distance_at(csg_within_search *search, csg_vec3 p)
{
    csg_triangle_hit hit = csg_tree_nearest(search->tree, p, search->hint);
    search->hint = hit.place;
    return sqrt(hit.squared);
}

/* The same for one piece; CSG_WITHIN_OPEN: it is to be divided at `center`, by the triangle in its
 * hint. */
static csg_within settle(csg_within_search *search, csg_piece *piece, csg_vec3 *center)
{
    uint32_t worst = 0;
    *center = search->beyond = csg_piece_center(piece);
    search->hint = piece->hint;
    double nearest = distance_at(search, *center);
    piece->hint = search->hint;
    if (nearest > search->limit)
        return CSG_WITHIN_BEYOND;
    double bound = csg_piece_bound(piece, &search->tree->triangles[piece->hint], &worst);
    double radius = csg_piece_radius(piece, *center);
    if (fmin(bound, nearest + radius * (1 + 0x1p-40)) <= search->limit)
        return CSG_WITHIN;
    search->beyond = piece->corners[worst];
    return distance_at(search, search->beyond) > search->limit ? CSG_WITHIN_BEYOND
                                                               : CSG_WITHIN_OPEN;
}

csg_within csg_triangle_is_within(csg_within_search *search, const csg_vec3 v[3], uint64_t most)
{
    csg_piece stack[STACK];
    uint32_t depth = 1;
    stack[0] = (csg_piece){.corners = {v[0], v[1], v[2]}, .count = 3, .hint = search->hint};
    most += search->pieces;
    while (depth) {
        csg_piece piece = stack[--depth];
        csg_vec3 center;
        csg_within what = settle(search, &piece, &center);
        search->pieces++;
        if (what == CSG_WITHIN)
            continue;
        if (what == CSG_WITHIN_BEYOND || search->pieces >= most || depth + CSG_PIECE_PARTS > STACK)
            return what;
        uint32_t count =
            csg_piece_divide(&piece, &search->tree->triangles[piece.hint], center, stack + depth);
        if (count < 2)
            return CSG_WITHIN_OPEN; /* too small for doubles */
        depth += count;
    }
    return CSG_WITHIN;
}
