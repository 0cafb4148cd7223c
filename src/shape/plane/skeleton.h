/* SPDX-License-Identifier: MIT
 * The straight skeleton of a clean outline (Aichholzer, Aurenhammer 1995): all edges move inwards
 * at speed 1, corners run along arcs, edges shrink to nothing and loops meet and are cut in two.
 * In: an outline. Out: the arcs, and when their ends are passed.
 */
#ifndef CSG_SHAPE_SKELETON_H
#define CSG_SHAPE_SKELETON_H

#include "shape/plane/outline.h"

typedef struct csg_skeleton_node {
    csg_vec2 at;
    double time; /* as far the edges have moved */
} csg_skeleton_node;

/* Between the areas that two edges sweep; edge i goes from point i to the next of its loop. */
typedef struct csg_skeleton_arc {
    uint32_t from, to;    /* nodes; time never falls */
    uint32_t left, right; /* edges, seen along the arc */
} csg_skeleton_arc;

typedef struct csg_skeleton {
    csg_memory *memory;
    csg_skeleton_node *nodes; /* the first are the outline's points */
    csg_skeleton_arc *arcs;
    size_t node_count, node_capacity, arc_count, arc_capacity;
} csg_skeleton;

/* *out is filled on CSGM_OK, else empty. CSGM_ERR_MEMORY; CSGM_ERR_LIMIT: it would take more than
 * some seconds (it grows with the square of the points); CSGM_ERR_UNSUPPORTED: rounding led
 * astray. */
csgm_status csg_skeleton_make(const csg_outline *clean, csg_memory *memory, csg_skeleton *out);
void csg_skeleton_release(csg_skeleton *skeleton);

#endif
