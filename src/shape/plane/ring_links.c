/* SPDX-License-Identifier: MIT
 * Linking the points of an outline to rings (csg_rings_link of rings.h).
 *
 * At a place where several corners meet, what comes in goes on along the first way out that one
 * finds turning clockwise: between the two there is only solid. So a hole that touches the ring
 * around it becomes part of that ring, and a solid that hangs together at a point only becomes two
 * rings.
 */
#include <stdlib.h>

#include "shape/plane/rings.h"

/* More corners at one place are left as they are: the pairing takes the square of their number. */
enum { MOST_AT_ONE_PLACE = 1024 };

static bool is_left_of(csg_vec2 a, csg_vec2 b)
{
    return a.x < b.x || (a.x == b.x && a.y < b.y);
}

static int compare_starts(const void *left, const void *right)
{
    const csg_ring_start *a = left, *b = right;
    return is_left_of(a->at, b->at)   ? -1
           : is_left_of(b->at, a->at) ? 1
                                      : (a->corner > b->corner) - (a->corner < b->corner);
}

static void link_loop(csg_rings *rings, size_t first, size_t end)
{
    for (size_t i = first; i < end; i++) {
        rings->corners[i] = (csg_ring_corner){
            .point = (uint32_t)i,
            .previous = (uint32_t)(i > first ? i - 1 : end - 1),
            .next = (uint32_t)(i + 1 < end ? i + 1 : first),
        };
    }
}

/* ---- places of several corners ------------------------------------------------------------ */

/* Whether, turning clockwise from the direction of `from`, one finds p before q. */
static bool comes_before(csg_vec2 at, csg_vec2 from, csg_vec2 p, csg_vec2 q)
{
    int turn_p = csg_orient_plane(at, from, p), turn_q = csg_orient_plane(at, from, q);
    bool late_p = turn_p > 0, late_q = turn_q > 0; /* by more than half a turn */
    double along_p = (p.x - at.x) * (from.x - at.x) + (p.y - at.y) * (from.y - at.y);
    double along_q = (q.x - at.x) * (from.x - at.x) + (q.y - at.y) * (from.y - at.y);
    /* straight back is half a turn, straight on a whole one: nothing lies between */
    int class_p = turn_p ? (late_p ? 2 : 0) : along_p < 0 ? 1 : 3;
    int class_q = turn_q ? (late_q ? 2 : 0) : along_q < 0 ? 1 : 3;
    return class_p != class_q ? class_p < class_q : csg_orient_plane(at, p, q) < 0;
}

/* The corner among group[from...] whose way out is the first for what comes in at `in`. */
static size_t first_way_out(const csg_rings *rings, const csg_ring_start *group, size_t from,
                            size_t count, uint32_t in, const uint32_t *ways)
{
    csg_vec2 at = group[0].at, before = csg_ring_at(rings, rings->corners[in].previous);
    size_t best = from;
    for (size_t k = from + 1; k < count; k++) {
        if (comes_before(at, before, csg_ring_at(rings, ways[k]), csg_ring_at(rings, ways[best])))
            best = k;
    }
    return best;
}

static void relink(csg_rings *rings, const csg_ring_start *group, size_t count)
{
    uint32_t ways[MOST_AT_ONE_PLACE]; /* out; those before k are taken */
    for (size_t k = 0; k < count; k++)
        ways[k] = rings->corners[group[k].corner].next;
    for (size_t k = 0; k < count; k++) {
        uint32_t in = group[k].corner;
        size_t best = first_way_out(rings, group, k, count, in, ways);
        uint32_t out = ways[best];
        ways[best] = ways[k];
        ways[k] = out;
    }
    for (size_t k = 0; k < count; k++) {
        rings->corners[group[k].corner].next = ways[k];
        rings->corners[ways[k]].previous = group[k].corner;
    }
}

/* `sorted` holds all corners by their places. */
static void relink_places(csg_rings *rings, const csg_ring_start *sorted, size_t count)
{
    for (size_t first = 0, end; first < count; first = end) {
        for (end = first + 1; end < count && !is_left_of(sorted[first].at, sorted[end].at); end++)
            rings->corners[sorted[end].corner].point = sorted[first].corner;
        if (end - first > 1 && end - first <= MOST_AT_ONE_PLACE)
            relink(rings, sorted + first, end - first);
    }
}

/* ---- rings and holes ---------------------------------------------------------------------- */

/* Twice the area, from the start; its leftmost corner. is_joined marks what was seen. */
static double survey(csg_rings *rings, uint32_t start, csg_ring_start *leftmost, size_t *count)
{
    csg_vec2 o = csg_ring_at(rings, start);
    double area = 0;
    uint32_t i = start;
    *leftmost = (csg_ring_start){o, start};
    *count = 0;
    do {
        uint32_t next = rings->corners[i].next;
        csg_vec2 a = csg_ring_at(rings, i), b = csg_ring_at(rings, next);
        area += (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
        if (is_left_of(a, leftmost->at))
            *leftmost = (csg_ring_start){a, i};
        rings->corners[i].is_joined = true;
        ++*count;
        i = next;
    } while (i != start);
    return area;
}

static void mark(csg_rings *rings, uint32_t start, bool is_joined)
{
    uint32_t i = start;
    do {
        rings->corners[i].is_joined = is_joined;
        i = rings->corners[i].next;
    } while (i != start);
}

/* What goes there and back only bounds nothing. */
static void collect(csg_rings *rings, csg_ring_start *starts, size_t *ring_count,
                    size_t *hole_count)
{
    size_t count = rings->corner_count, first_hole = count;
    *ring_count = 0;
    for (uint32_t i = 0; i < rings->corner_count; i++) {
        csg_ring_start start;
        size_t corners;
        if (rings->corners[i].is_joined)
            continue;
        double area = survey(rings, i, &start, &corners);
        if (corners < 3)
            continue;
        if (area >= 0)
            starts[(*ring_count)++] = start;
        else
            starts[--first_hole] = start;
    }
    *hole_count = count - first_hole;
    for (size_t k = 0; k < *hole_count; k++)
        starts[*ring_count + k] = starts[first_hole + k];
}

void csg_rings_link(csg_rings *rings, csg_ring_start *starts, size_t *ring_count,
                    size_t *hole_count)
{
    const csg_outline *outline = rings->outline;
    size_t count = csg_outline_first(outline, outline->loop_count);
    rings->corner_count = (uint32_t)count;
    for (size_t loop = 0; loop < outline->loop_count; loop++)
        link_loop(rings, csg_outline_first(outline, loop), outline->ends[loop]);
    for (size_t i = 0; i < count; i++)
        starts[i] = (csg_ring_start){outline->points[i], (uint32_t)i};
    qsort(starts, count, sizeof *starts, compare_starts);
    relink_places(rings, starts, count);
    collect(rings, starts, ring_count, hole_count);
    for (size_t i = 0; i < *hole_count; i++)
        mark(rings, starts[*ring_count + i].corner, false);
    qsort(starts + *ring_count, *hole_count, sizeof *starts, compare_starts);
}
