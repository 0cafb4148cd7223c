/* SPDX-License-Identifier: MIT
 * Neighbours across an edge of just two triangles must run it in opposite directions. Each patch
 * that such edges connect is walked breadth first; where fewer than half of its triangles disagree
 * with the first they are turned, else the others. A patch that cannot be turned alike (a Moebius
 * strip) keeps a seam, which becomes a hole to fill.
 */
#include <string.h>

#include "shape/polyhedra/repair.h"

typedef struct patches {
    csg_triangles *triangles;
    const csg_triangle_edges *edges;
    uint8_t *turned; /* per triangle: 0, 1 or not yet visited */
    uint32_t *queue;
    size_t begin, end; /* of the patch, in queue */
} patches;

enum { UNSEEN = 2 };

static void visit(patches *p, uint32_t triangle)
{
    for (uint32_t half = 3 * triangle; half < 3 * triangle + 3; half++) {
        const csg_edge *edge = &p->edges->edges[p->edges->of_half[half]];
        if (edge->count != 2)
            continue;
        const uint32_t *halves = p->edges->halves + edge->first;
        uint32_t other = halves[0] == half ? halves[1] : halves[0];
        if (p->turned[other / 3] != UNSEEN)
            continue;
        bool alike = csg_half_from(p->triangles, half) != csg_half_from(p->triangles, other);
        p->turned[other / 3] = p->turned[triangle] ^ !alike;
        p->queue[p->end++] = other / 3;
    }
}

/* Turns the smaller part of the patch in the queue. */
static size_t turn_patch(patches *p)
{
    size_t count = 0, size = p->end - p->begin;
    for (size_t i = p->begin; i < p->end; i++)
        count += p->turned[p->queue[i]];
    uint8_t which = 2 * count <= size;
    for (size_t i = p->begin; i < p->end; i++) {
        uint32_t *corners = p->triangles->corners[p->queue[i]];
        if (p->turned[p->queue[i]] == which) {
            uint32_t corner = corners[1];
            corners[1] = corners[2];
            corners[2] = corner;
        }
    }
    return which ? count : size - count;
}

bool csg_repair_turn(csg_arena *scratch, csg_triangles *triangles, const csg_triangle_edges *edges,
                     size_t *flipped)
{
    csg_arena_mark mark = csg_arena_get_mark(scratch);
    patches p = {.triangles = triangles,
                 .edges = edges,
                 .turned = csg_arena_alloc(scratch, triangles->count),
                 .queue = csg_arena_alloc(scratch, triangles->count * sizeof *p.queue)};
    if (!p.turned || !p.queue)
        return false;
    memset(p.turned, UNSEEN, triangles->count);
    for (uint32_t t = 0; t < triangles->count; t++) {
        if (p.turned[t] != UNSEEN)
            continue;
        p.begin = p.end;
        p.turned[t] = 0;
        p.queue[p.end++] = t;
        for (size_t i = p.begin; i < p.end; i++)
            visit(&p, p.queue[i]);
        *flipped += turn_patch(&p);
    }
    csg_arena_release_to(scratch, mark);
    return true;
}
