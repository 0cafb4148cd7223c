/* SPDX-License-Identifier: MIT
 * Loops that are there twice, dropped in pairs.
 */
#ifndef CSG_SHAPE_TWINS_H
#define CSG_SHAPE_TWINS_H

#include "base/memory.h"
#include "shape/plane/clipper.h"

/* In place; the points are those before the last end. False: out of memory, and nothing changed. */
bool csg_twins_drop(csg_memory *memory, csg_clipper_point *points, uint32_t *ends,
                    size_t *loop_count);

#endif
