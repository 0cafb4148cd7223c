/* SPDX-License-Identifier: MIT
 * Shapes: which edges between facets are creases. The facets of a scan that are as small as cells,
 * and turn as little as a smooth surface may, are one: their blunt edges are none (shape.h).
 */
#ifndef CSG_MESH_FEATURES_FACETS_H
#define CSG_MESH_FEATURES_FACETS_H

#include "mesh/features/probe.h"

/* By how much a gradient may turn in a cell, as a part of its length: by 23 degrees, less than
 * where a tip is looked for (25). The shortest bracket around a jump is 512 times as short, and
 * from end to end of it a formula's gradient turns by less than a jump's three degrees. */
static const double CSG_FEATURE_MOST_TURN = 0.4;
/* The same as 1 - cos. */
#define CSG_FEATURE_MOST_BEND (0.5 * CSG_FEATURE_MOST_TURN * CSG_FEATURE_MOST_TURN)

/* A point of the tape's frame in a leaf's own. */
static inline void csg_feature_to_own(const csg_tape_node *node, const float *frame,
                                      const float at[3], float q[3])
{
    for (int i = 0; i < 3; i++)
        q[i] = node->frame == CSG_FRAME_OFFSET ? at[i] - frame[i]
                                               : frame[3 * i] * at[0] + frame[3 * i + 1] * at[1] +
                                                     frame[3 * i + 2] * at[2] + frame[9 + i];
}

/* Whether the shape of a leaf may crease in cells, by their middles: at most CSG_SHAPE_MOST_BALLS.
 * Where it is said not to, csg_feature_drop_facets would drop all that jumps. */
void csg_feature_find_facets(const csg_tape *tape, const csg_tape_node *leaf, float cell,
                             const float *x, const float *y, const float *z, size_t count,
                             csg_shape_balls *balls);

/* Segments that jump from one facet of a shape to the next, and not at a crease, are active no
 * more. */
void csg_feature_drop_facets(csg_feature_room *room, csg_feature_probe *probe);

#endif
