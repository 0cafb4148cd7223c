/* SPDX-License-Identifier: MIT
 * The loops that Clipper makes of an outline before it cleans the result of an offset: each edge
 * moved outwards, with what joins them. Made to count where they will cross (crossings.h).
 */
#ifndef CSG_SHAPE_OFFSET_LOOPS_H
#define CSG_SHAPE_OFFSET_LOOPS_H

#include "shape/plane/clipper.h"

/* Gets one loop after the other, point by point. */
typedef struct csg_offset_sink {
    bool (*add)(void *user, double x, double y); /* false: no more room */
    void (*close)(void *user);
    void *user;
} csg_offset_sink;

/* `by` in steps; round corners turn by `turn` radians per point, other corners get one (MITER) or
 * two points. False: the sink had no more room. */
bool csg_offset_loops(const csg_clipper_loops *loops, double by, csg_corner corner, double turn,
                      csg_offset_sink sink);

#endif
