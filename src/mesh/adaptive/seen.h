/* SPDX-License-Identifier: MIT
 * What the judge saw of the surface away from his triangles, by less than the tolerance: a place of
 * each cell at most. Whoever thins the mesh out has to stay near them, too: its vertices alone do
 * not tell how far the surface rises above them.
 */
#ifndef CSG_MESH_ADAPTIVE_SEEN_H
#define CSG_MESH_ADAPTIVE_SEEN_H

#include "grid/adaptive/bricks.h"

typedef struct csg_seen {
    float (*at)[3]; /* field frame */
    size_t count, capacity;
} csg_seen;

/* Those of all bricks, in their order, in place of what was gathered before. Those of cells that
 * were divided afterwards are places of the surface all the same. False: out of memory. */
bool csg_seen_gather(csg_seen *seen, const csg_bricks *bricks, csg_memory *memory);
void csg_seen_release(csg_seen *seen, csg_memory *memory);

#endif
