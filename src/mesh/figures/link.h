/* SPDX-License-Identifier: MIT
 * The link of a vertex: for each of its triangles the edge across from it, in the triangle's
 * direction. A mesh is a closed oriented 2-manifold exactly if each link is one circle: then each
 * edge at the vertex is used twice, once in each direction, and its triangles are one fan.
 */
#ifndef CSG_MESH_FIGURES_LINK_H
#define CSG_MESH_FIGURES_LINK_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct csg_link_arc {
    uint32_t from, to; /* vertices */
} csg_link_arc;

/* Whether arcs, at least one, are one circle that passes each vertex once. Changes their order. */
static inline bool csg_link_is_circle(csg_link_arc *arcs, size_t count)
{
    for (size_t done = 1; done < count; done++) {
        size_t next = 0, found = 0;
        for (size_t i = done; i < count; i++) {
            bool follows = arcs[i].from == arcs[done - 1].to;
            next = follows ? i : next;
            found += follows;
        }
        if (found != 1 || arcs[done - 1].to == arcs[0].from)
            return false;
        csg_link_arc arc = arcs[next];
        arcs[next] = arcs[done];
        arcs[done] = arc;
    }
    return arcs[count - 1].to == arcs[0].from;
}

/* Where a circle goes on from a vertex, and whose circle that is. */
typedef struct csg_link_mark {
    uint32_t of, to;
} csg_link_mark;

/* The same, and arcs keep their order. marks: one for each number that arcs have, none of which is
 * of this vertex yet. */
static inline bool csg_link_is_circle_of(uint32_t vertex, const csg_link_arc *arcs, size_t count,
                                         csg_link_mark *marks)
{
    bool is_simple = true;
    for (size_t i = 0; i < count; i++) {
        is_simple &= marks[arcs[i].from].of != vertex;
        marks[arcs[i].from] = (csg_link_mark){vertex, arcs[i].to};
    }
    uint32_t at = arcs[0].from;
    size_t steps = 0;
    do {
        is_simple &= marks[at].of == vertex;
        at = marks[at].to;
        steps++;
    } while (is_simple && at != arcs[0].from && steps < count);
    return is_simple && at == arcs[0].from && steps == count;
}

#endif
