/* SPDX-License-Identifier: MIT
 * The sign from the nearest part of an outline; see region_sign.h.
 *
 * The way from a point to its nearest point on the outline meets nothing else, so a point is inside
 * if what lies beside its nearest part is. That holds all along a segment to which nothing else
 * comes close, once it holds at one place: there the winding numbers of both sides are asked. It
 * holds around a corner of two such segments, and of nothing else. What is not so sure (loops that
 * touch, zero-width necks, crossings by a rounding error) is left to the winding number.
 */
#include "shape/plane/region_sign.h"

/* Nearer than this part of the extent counts as touching: far above rounding, far below the grid of
 * polygons.h. */
static const double touching = 1e-13;

/* A segment near which so many others are is not worth the search. */
enum { MOST_NEIGHBOURS = 4096 };

typedef struct inquiry {
    const csg_segment_tree *tree;
    uint32_t segment, asked;
    double reach;
    bool is_clear;
} inquiry;

static double distance_to(const csg_segment_tree *tree, uint32_t segment, csg_vec2 p)
{
    csg_segment_place at = csg_segment_locate(tree, segment, p.x, p.y);
    double beyond = fmax(fmax(-at.along, at.along - at.length), 0);
    return sqrt(at.left * at.left + beyond * beyond);
}

static bool is_apart(const csg_segment_tree *tree, uint32_t segment, csg_vec2 a, csg_vec2 b)
{
    double left_a = csg_segment_locate(tree, segment, a.x, a.y).left;
    double left_b = csg_segment_locate(tree, segment, b.x, b.y).left;
    return (left_a > 0 && left_b > 0) || (left_a < 0 && left_b < 0);
}

/* Whether both places are beyond the same end of the segment, along it: so are two strokes of a
 * letter that lie on one line. */
static bool is_beyond(const inquiry *in, uint32_t segment, csg_vec2 a, csg_vec2 b)
{
    csg_segment_place at_a = csg_segment_locate(in->tree, segment, a.x, a.y);
    csg_segment_place at_b = csg_segment_locate(in->tree, segment, b.x, b.y);
    return fmax(at_a.along, at_b.along) < -in->reach ||
           fmin(at_a.along, at_b.along) > at_a.length + in->reach;
}

/* Whether the segments keep their distance; where they share a corner, their other ends do. */
static bool is_clear_of(const inquiry *in, uint32_t other)
{
    const csg_segment_tree *tree = in->tree;
    const csg_segment_end *s = &tree->ends[in->segment], *o = &tree->ends[other];
    bool is_next = s->following == other, is_previous = s->previous == other;
    if (is_next && is_previous) /* there and back */
        return false;
    bool is_near = (!is_next && distance_to(tree, in->segment, o->from) <= in->reach) ||
                   (!is_previous && distance_to(tree, in->segment, o->to) <= in->reach) ||
                   (!is_previous && distance_to(tree, other, s->from) <= in->reach) ||
                   (!is_next && distance_to(tree, other, s->to) <= in->reach);
    if (is_near || is_next || is_previous)
        return !is_near;
    return is_apart(tree, in->segment, o->from, o->to) || is_apart(tree, other, s->from, s->to) ||
           is_beyond(in, in->segment, o->from, o->to) || is_beyond(in, other, s->from, s->to);
}

static bool ask(void *user, uint32_t other)
{
    inquiry *in = user;
    if (other == in->segment)
        return true;
    in->is_clear = ++in->asked <= MOST_NEIGHBOURS && is_clear_of(in, other);
    return in->is_clear;
}

/* Inside to the left of the segment's middle and outside to the right. */
static bool is_boundary(const csg_segment_tree *tree, uint32_t segment, double reach)
{
    const csg_segment_end *s = &tree->ends[segment];
    csg_segment_leaf *leaf = &tree->leaves[segment / CSG_SEGMENT_LANES];
    double nx = -leaf->uy[segment % CSG_SEGMENT_LANES] * reach * 0.5,
           ny = leaf->ux[segment % CSG_SEGMENT_LANES] * reach * 0.5;
    double x = 0.5 * (s->from.x + s->to.x), y = 0.5 * (s->from.y + s->to.y);
    return csg_segment_winding(tree, x + nx, y + ny) > 0 &&
           csg_segment_winding(tree, x - nx, y - ny) <= 0;
}

/* At turns of less than a right angle the side of either segment is right beyond the corner too,
 * and does not depend on which way a nearly straight corner turns. */
static csg_side side_at_corner(const csg_segment_tree *tree, const csg_segment_sides *sides,
                               uint32_t before, uint32_t after)
{
    if (sides[before].along != CSG_SIDE_LEFT || sides[after].along != CSG_SIDE_LEFT)
        return CSG_SIDE_ASK;
    csg_vec2 a = tree->ends[before].from, b = tree->ends[before].to, c = tree->ends[after].to;
    double ux = b.x - a.x, uy = b.y - a.y, vx = c.x - b.x, vy = c.y - b.y;
    if (ux * vx + uy * vy > 0)
        return CSG_SIDE_LEFT;
    return ux * vy - uy * vx > 0 ? CSG_SIDE_OUTSIDE : CSG_SIDE_INSIDE;
}

void csg_region_sides(const csg_segment_tree *tree, csg_segment_sides *sides)
{
    double extent = fmax(fmax(fabs(tree->box.min.x), fabs(tree->box.max.x)),
                         fmax(fabs(tree->box.min.y), fabs(tree->box.max.y)));
    double reach = touching * extent;
    for (uint32_t i = 0; i < tree->segment_count; i++) {
        inquiry in = {.tree = tree, .segment = i, .reach = reach, .is_clear = true};
        csg_segment_around(tree, i, reach, ask, &in);
        bool is_sure = in.is_clear && is_boundary(tree, i, reach);
        sides[i].along = is_sure ? CSG_SIDE_LEFT : CSG_SIDE_ASK;
    }
    for (uint32_t i = 0; i < tree->segment_count; i++) {
        const csg_segment_end *s = &tree->ends[i];
        sides[i].from = (uint8_t)side_at_corner(tree, sides, s->previous, i);
        sides[i].to = (uint8_t)side_at_corner(tree, sides, i, s->following);
    }
}
