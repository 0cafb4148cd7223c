/* SPDX-License-Identifier: MIT
 * Cuts from holes to the rings around them (after Eberly, Triangulation by Ear Clipping, 2002).
 *
 * A ray from the hole's leftmost corner to the left first meets an edge that goes down. From the
 * corner one sees an end of that edge, or else some corner in the triangle of corner, meeting point
 * and end: the one whose direction is nearest to the ray's. All questions are asked of
 * csg_orient_plane. Where holes are joined from left to right, what the ray meets is joined
 * already.
 */
#include "shape/plane/rings.h"

static bool is_same(csg_vec2 a, csg_vec2 b)
{
    return a.x == b.x && a.y == b.y;
}

bool csg_ring_sees(const csg_rings *rings, uint32_t corner, csg_vec2 q)
{
    const csg_ring_corner *c = &rings->corners[corner];
    csg_vec2 before = csg_ring_at(rings, c->previous), at = csg_ring_at(rings, corner),
             after = csg_ring_at(rings, c->next);
    if (csg_orient_plane(before, at, after) >= 0)
        return csg_orient_plane(at, after, q) > 0 && csg_orient_plane(at, q, before) > 0;
    return !(csg_orient_plane(at, before, q) >= 0 && csg_orient_plane(at, q, after) >= 0);
}

/* The corner where the edge begins that the ray from `from` to the left meets first. */
static uint32_t first_met(const csg_rings *rings, csg_vec2 from)
{
    uint32_t best = CSG_CORNER_NONE;
    double best_x = -INFINITY;
    for (uint32_t i = 0; i < rings->corner_count; i++) {
        const csg_ring_corner *c = &rings->corners[i];
        if (!c->is_joined)
            continue;
        csg_vec2 p = csg_ring_at(rings, i), q = csg_ring_at(rings, c->next);
        if (!(p.y > q.y && p.y >= from.y && from.y >= q.y) || csg_orient_plane(p, q, from) < 0)
            continue;
        double x = p.x + (from.y - p.y) / (q.y - p.y) * (q.x - p.x);
        if (x > best_x || best == CSG_CORNER_NONE) {
            best_x = x;
            best = i;
        }
    }
    return best;
}

typedef struct view {       /* from a hole's corner */
    csg_vec2 from, onwards; /* onwards: the hole's next corner */
    csg_vec2 p, q;          /* the edge that the ray meets, going down */
    int side;               /* 1: the triangle goes up to p, -1: down to q */
} view;

/* Where the edge ends on the ray, the triangle is a stretch of the ray: not what lies behind it. */
static bool is_in_triangle(const view *v, csg_vec2 end, csg_vec2 r)
{
    double up = v->side * (r.y - v->from.y);
    return up >= 0 && r.x <= v->from.x && csg_orient_plane(v->p, v->q, r) >= 0 &&
           v->side * csg_orient_plane(v->from, end, r) >= 0;
}

static bool sees(const csg_rings *rings, const view *v, uint32_t corner)
{
    bool is_here = is_same(csg_ring_at(rings, corner), v->from);
    return csg_ring_sees(rings, corner, is_here ? v->onwards : v->from);
}

static double distance_to(const view *v, csg_vec2 r)
{
    return fabs(r.x - v->from.x) + fabs(r.y - v->from.y);
}

/* Whether r is nearer in direction to the ray, or nearer in the same direction, than `best`. */
static bool is_nearer(const view *v, csg_vec2 best, csg_vec2 r, bool also_same)
{
    int turn = v->side * csg_orient_plane(v->from, best, r);
    double gain = distance_to(v, best) - distance_to(v, r);
    return turn > 0 || (turn == 0 && (gain > 0 || (gain == 0 && also_same)));
}

/* The corner to cut to: the edge's end, unless something stands before it. */
static uint32_t visible_corner(const csg_rings *rings, const view *v, uint32_t end)
{
    csg_vec2 end_at = csg_ring_at(rings, end);
    uint32_t best = end;
    bool is_sure = sees(rings, v, end);
    for (uint32_t i = 0; i < rings->corner_count; i++) {
        csg_vec2 r = csg_ring_at(rings, i);
        if (!rings->corners[i].is_joined || !is_in_triangle(v, end_at, r) ||
            !is_nearer(v, csg_ring_at(rings, best), r, !is_sure) || !sees(rings, v, i))
            continue;
        best = i;
        is_sure = true;
    }
    return best;
}

static uint32_t add_double(csg_rings *rings, uint32_t corner)
{
    rings->corners[rings->corner_count] = rings->corners[corner];
    return rings->corner_count++;
}

/* ring -> hole ... hole's double -> ring's double -> ... */
static void cut(csg_rings *rings, uint32_t ring, uint32_t hole)
{
    uint32_t ring2 = add_double(rings, ring), hole2 = add_double(rings, hole);
    csg_ring_corner *c = rings->corners;
    c[c[ring2].next].previous = ring2;
    c[c[hole2].previous].next = hole2;
    c[ring].next = hole;
    c[hole].previous = ring;
    c[hole2].next = ring2;
    c[ring2].previous = hole2;
}

bool csg_ring_join(csg_rings *rings, uint32_t hole)
{
    csg_ring_corner *c = rings->corners;
    view v = {.from = csg_ring_at(rings, hole), .onwards = csg_ring_at(rings, c[hole].next)};
    uint32_t edge = first_met(rings, v.from);
    if (edge == CSG_CORNER_NONE)
        return false;
    v.p = csg_ring_at(rings, edge);
    v.q = csg_ring_at(rings, c[edge].next);
    v.side = v.p.y - v.from.y <= v.from.y - v.q.y ? 1 : -1;
    uint32_t to = visible_corner(rings, &v, v.side > 0 ? edge : c[edge].next);
    uint32_t i = hole;
    do {
        c[i].is_joined = true;
        i = c[i].next;
    } while (i != hole);
    cut(rings, to, hole);
    return true;
}
