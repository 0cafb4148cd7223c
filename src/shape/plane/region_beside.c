/* SPDX-License-Identifier: MIT
 * Affine functions below a signed distance; see region_beside.h. The segments that can be nearest
 * to a place of the triangle are as near to its middle as the nearest one and twice its radius.
 */
#include "shape/plane/region_beside.h"

enum { CORNERS = 3, MOST = 64 /* segments */ };

typedef struct beside_walk {
    const csg_segment_tree *tree;
    const csg_segment_sides *sides;
    const csg_vec2 *corners;
    csg_vec2 c;
    double radius;
    uint32_t segments[MOST];
    uint32_t count;
} beside_walk;

static csg_vec2 way_between(csg_vec2 from, csg_vec2 to)
{
    return (csg_vec2){to.x - from.x, to.y - from.y};
}

static double length_of(csg_vec2 v)
{
    return sqrt(v.x * v.x + v.y * v.y);
}

static csg_vec2 direction_of(const csg_segment_tree *tree, uint32_t segment)
{
    const csg_segment_leaf *leaf = &tree->leaves[segment / CSG_SEGMENT_LANES];
    uint32_t k = segment % CSG_SEGMENT_LANES;
    return (csg_vec2){leaf->ux[k], leaf->uy[k]};
}

/* From the nearest point of a segment. */
static csg_vec2 way_from(const csg_segment_tree *tree, uint32_t segment, csg_vec2 p)
{
    const csg_segment_leaf *leaf = &tree->leaves[segment / CSG_SEGMENT_LANES];
    uint32_t k = segment % CSG_SEGMENT_LANES;
    double along = csg_segment_locate(tree, segment, p.x, p.y).along;
    along = fmin(fmax(along, 0), leaf->length[k]);
    return (csg_vec2){p.x - (leaf->ax[k] + along * leaf->ux[k]),
                      p.y - (leaf->ay[k] + along * leaf->uy[k])};
}

static bool take_segment(void *user, uint32_t segment)
{
    beside_walk *w = user;
    if (w->count == MOST)
        return false;
    w->segments[w->count++] = segment;
    return true;
}

/* The tangent plane of the distance from a segment at the middle. */
static double plane_at(const beside_walk *w, csg_vec2 way, double distance, int corner)
{
    csg_vec2 to = way_between(w->c, w->corners[corner]);
    return distance + (way.x * to.x + way.y * to.y) / distance;
}

/* Where no segment meets the triangle: the distance from a segment is convex, so it is nowhere less
 * than its tangent plane at the middle says, and the least of these planes is nowhere less than
 * what is affine between its values at the corners. */
static bool pass_segments(const beside_walk *w, double at[CORNERS])
{
    double least = INFINITY;
    for (int k = 0; k < CORNERS; k++)
        at[k] = INFINITY;
    for (uint32_t i = 0; i < w->count && least > 0; i++) {
        csg_vec2 way = way_from(w->tree, w->segments[i], w->c);
        double distance = length_of(way);
        for (int k = 0; k < CORNERS; k++) {
            double plane = plane_at(w, way, distance, k);
            at[k] = fmin(at[k], plane);
            least = fmin(least, plane);
        }
    }
    return least > 0;
}

/* ---- chains ------------------------------------------------------------------------------------
 */

static bool has(const beside_walk *w, uint32_t segment)
{
    for (uint32_t i = 0; i < w->count; i++)
        if (w->segments[i] == segment)
            return true;
    return false;
}

/* Whether the segments are a chain with the solid on its left, that turns by no more than half a
 * turn, and to one side only: all of them to the left (1) or to the right (-1), or 0. Beside it the
 * solid is a convex set, or what is left by one: the chain ends outside of the ball in which its
 * segments are looked for, and straight ends go on outside of it. */
static int turn_of_chain(const beside_walk *w)
{
    uint32_t first = w->count;
    for (uint32_t i = 0; i < w->count; i++) {
        if (w->sides[w->segments[i]].along != CSG_SIDE_LEFT)
            return 0;
        if (has(w, w->tree->ends[w->segments[i]].previous))
            continue;
        if (first < w->count)
            return 0;
        first = i;
    }
    if (first == w->count)
        return 0;
    uint32_t segment = w->segments[first];
    csg_vec2 begin = direction_of(w->tree, segment), last = begin;
    bool left = true, right = true;
    for (uint32_t i = 1; i < w->count; i++) {
        segment = w->tree->ends[segment].following;
        if (!has(w, segment)) /* others are whole loops */
            return 0;
        csg_vec2 u = direction_of(w->tree, segment);
        double bend = last.x * u.y - last.y * u.x, sum = begin.x * u.y - begin.y * u.x;
        bool goes_on = last.x * u.x + last.y * u.y > 0;
        left &= sum >= 0 && (bend > 0 || (bend == 0 && goes_on));
        right &= sum <= 0 && (bend < 0 || (bend == 0 && goes_on));
        last = u;
    }
    return left ? 1 : right ? -1 : 0;
}

/* The signed distance from a convex set is concave: what its corners say is below it. That of what
 * is left by one is convex: nowhere less than its tangent plane at the middle says, nor than the
 * distance from the line of a segment, which is that plane on the other side. */
static bool go_along_chain(const beside_walk *w, uint32_t nearest, bool is_behind, double turn,
                           double at[CORNERS])
{
    int side = turn_of_chain(w);
    if (!side)
        return false;
    if (side * turn > 0)
        return true;
    csg_vec2 u = direction_of(w->tree, nearest), from = w->tree->ends[nearest].from;
    csg_vec2 way = way_from(w->tree, nearest, w->c);
    for (int k = 0; k < CORNERS; k++) {
        csg_vec2 to = way_between(from, w->corners[k]);
        at[k] = is_behind ? turn * (u.x * to.y - u.y * to.x) : plane_at(w, way, length_of(way), k);
    }
    return true;
}

/* ---- all of them -------------------------------------------------------------------------------
 */

/* On the side that is not asked for: what is asked for is nowhere less than the distance from one
 * segment, turned around, which is concave, and holds across the outline as well. */
static void stay_behind(const beside_walk *w, uint32_t nearest, double at[CORNERS])
{
    for (int k = 0; k < CORNERS; k++)
        at[k] = -length_of(way_from(w->tree, nearest, w->corners[k]));
}

csg_beside csg_region_beside(const csg_segment_tree *tree, const csg_segment_sides *sides,
                             const csg_vec2 corners[3], csg_vec2 c, uint32_t nearest, double value,
                             double turn, double at[3])
{
    beside_walk w = {.tree = tree, .sides = sides, .corners = corners, .c = c};
    double passed[CORNERS];
    for (int k = 0; k < CORNERS; k++)
        w.radius = fmax(w.radius, length_of(way_between(c, corners[k])));
    double reach = (fabs(value) + 2 * w.radius) * (1 + 0x1p-40);
    bool are_all = reach < 1e150 && csg_segment_within(tree, c.x, c.y, reach, take_segment, &w);
    if (are_all && turn * value > 0 && pass_segments(&w, passed)) {
        for (int k = 0; k < CORNERS; k++)
            at[k] = passed[k];
        return CSG_BESIDE_CLOSELY;
    }
    if (are_all && go_along_chain(&w, nearest, !(turn * value > 0), turn, at))
        return CSG_BESIDE_CLOSELY;
    if (turn * value > 0)
        return CSG_BESIDE_UNKNOWN;
    stay_behind(&w, nearest, at);
    return CSG_BESIDE_WEAKLY;
}
