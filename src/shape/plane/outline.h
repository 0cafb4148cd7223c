/* SPDX-License-Identifier: MIT
 * An outline: closed loops of points in the plane, as polygons, fonts, SVG and DXF give them.
 * Loops may run either way, cross, touch and nest; polygons.h makes a clean set of them.
 */
#ifndef CSG_SHAPE_OUTLINE_H
#define CSG_SHAPE_OUTLINE_H

#include <stdint.h>

#include "base/geometry.h"
#include "base/memory.h"

typedef struct csg_outline {
    csg_memory *memory;
    csg_vec2 *points; /* all loops, one after the other; the last point is not the first again */
    uint32_t *ends;   /* per loop: where it ends in points */
    size_t point_count, point_capacity, loop_count, loop_capacity;
} csg_outline;

void csg_outline_init(csg_outline *outline, csg_memory *memory);
void csg_outline_release(csg_outline *outline);
/* Adds to the loop that is open. False: out of memory. */
bool csg_outline_add(csg_outline *outline, csg_vec2 point);
/* Closes the open loop; one of fewer than 3 points is forgotten. */
bool csg_outline_close(csg_outline *outline);
/* Where loop number `loop` begins in points. */
static inline size_t csg_outline_first(const csg_outline *outline, size_t loop)
{
    return loop ? outline->ends[loop - 1] : 0;
}
bool csg_outline_append(csg_outline *outline, const csg_outline *more);
/* x and y of each point through the map (its z row and column are not looked at). */
void csg_outline_transform(csg_outline *outline, const csg_affine *map);
csg_box csg_outline_box(const csg_outline *outline); /* z = 0; empty without points */

/* Flat pieces of curves: the chord stays within `tolerance` of the curve. Points after `from`, up
 * to and with the end. */
bool csg_outline_arc(csg_outline *outline, csg_vec2 center, double radius, double from_deg,
                     double sweep_deg, double tolerance);
/* The same in that many pieces. */
bool csg_outline_arc_in_pieces(csg_outline *outline, csg_vec2 center, double radius,
                               double from_deg, double sweep_deg, int pieces);
bool csg_outline_quadratic(csg_outline *outline, csg_vec2 from, csg_vec2 control, csg_vec2 to,
                           double tolerance);
bool csg_outline_cubic(csg_outline *outline, csg_vec2 from, csg_vec2 control1, csg_vec2 control2,
                       csg_vec2 to, double tolerance);
/* The same in that many pieces. */
bool csg_outline_quadratic_in_pieces(csg_outline *outline, csg_vec2 from, csg_vec2 control,
                                     csg_vec2 to, int pieces);
bool csg_outline_cubic_in_pieces(csg_outline *outline, csg_vec2 from, csg_vec2 control1,
                                 csg_vec2 control2, csg_vec2 to, int pieces);

#endif
