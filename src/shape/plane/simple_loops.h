/* SPDX-License-Identifier: MIT
 * Loops that visit no point twice.
 */
#ifndef CSG_SHAPE_SIMPLE_LOOPS_H
#define CSG_SHAPE_SIMPLE_LOOPS_H

#include "base/memory.h"
#include "shape/plane/clipper.h"

/* Gives the parts of a loop between two visits of a point to `take`, as loops of their own;
 * together they go around every place as often as the loop does. Parts of fewer than 3 points have
 * no area and are dropped. False: out of memory, or `take` said so. */
bool csg_simple_loops(csg_memory *memory, const csg_clipper_point *points, size_t count,
                      csg_clipper_take *take, void *user);

#endif
