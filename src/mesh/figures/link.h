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

#endif
