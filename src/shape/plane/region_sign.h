/* SPDX-License-Identifier: MIT
 * Which sides of an outline's parts are known to be inside, so that the nearest part tells the
 * sign.
 */
#ifndef CSG_SHAPE_REGION_SIGN_H
#define CSG_SHAPE_REGION_SIGN_H

#include "shape/plane/region_tree.h"

typedef enum csg_side {
    CSG_SIDE_ASK,    /* the winding number must be asked */
    CSG_SIDE_LEFT,   /* inside is what is on the segment's left */
    CSG_SIDE_INSIDE, /* all that is nearest to this corner is inside */
    CSG_SIDE_OUTSIDE
} csg_side;

typedef struct csg_segment_sides {
    uint8_t along, from, to; /* csg_side: nearest between the ends; nearest to an end */
} csg_segment_sides;

/* Fills `sides`, one per segment. */
void csg_region_sides(const csg_segment_tree *tree, csg_segment_sides *sides);

#endif
