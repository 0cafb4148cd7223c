/* SPDX-License-Identifier: MIT
 * What a set of loops would cost the sweep of clipper.cc, measured before it begins: its time grows
 * with the edges that are cut by one horizontal line, over all heights of points (beams.c), and
 * with the edges that cross, touch or run along each other (crossings.c). Honest drawings have few.
 */
#ifndef CSG_SHAPE_CROSSINGS_H
#define CSG_SHAPE_CROSSINGS_H

#include "base/memory.h"
#include "shape/plane/clipper.h"

/* Each about two seconds of Clipper's time on one core of 2020: 20 ns an edge in a beam; 4 us a
 * crossing where all that is enclosed comes out (EVEN_ODD), 1 us where most of it vanishes. */
enum {
    CSG_MOST_EDGES_IN_BEAMS = 100000000,
    CSG_MOST_CROSSINGS = 500000,
    CSG_MOST_CROSSINGS_NONZERO = 2000000
};

/* Coordinates are within 2^31 of zero. CSGM_ERR_LIMIT: too many edges in beams. *turned: there are
 * far fewer with x in place of y. */
csgm_status csg_beams_check(csg_memory *memory, const csg_clipper_loops *loops, bool *turned);
/* CSGM_ERR_LIMIT: more than those crossings. */
csgm_status csg_crossings_check(csg_memory *memory, const csg_clipper_loops *loops, csg_fill fill);

#endif
