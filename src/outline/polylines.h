/* SPDX-License-Identifier: MIT
 * Lines as drawings have them: open or closed runs of points, two points or more each.
 */
#ifndef CSG_OUTLINE_POLYLINES_H
#define CSG_OUTLINE_POLYLINES_H

#include "outline/input.h"

typedef struct csg_polyline {
    size_t first, count; /* in points; a closed one does not repeat its first point */
    bool closed;
} csg_polyline;

typedef struct csg_polylines {
    csg_memory *memory;
    csg_vec2 *points;
    csg_polyline *items;
    size_t point_count, point_capacity, count, capacity;
    csg_outline pen; /* the one being drawn: only its open loop is used */
} csg_polylines;

void csg_polylines_init(csg_polylines *lines, csg_memory *memory);
void csg_polylines_release(csg_polylines *lines);
/* Forgets the lines, keeps the memory. */
void csg_polylines_clear(csg_polylines *lines);
/* Makes what the pen drew a line, unless that is one point; the pen is empty then. CSGM_ERR_MEMORY,
 * or CSGM_ERR_LIMIT above CSG_INPUT_MOST_POINTS. */
csgm_status csg_polylines_finish(csg_polylines *lines, bool closed);
void csg_polylines_transform(csg_polylines *lines, size_t first_line, const csg_affine *map);

/* ---- strokes ------------------------------------------------------------------------- */

typedef enum csg_cap { CSG_CAP_BUTT, CSG_CAP_ROUND, CSG_CAP_SQUARE } csg_cap;
typedef enum csg_line_join {
    CSG_LINE_JOIN_MITER,
    CSG_LINE_JOIN_ROUND,
    CSG_LINE_JOIN_BEVEL
} csg_line_join;

typedef struct csg_stroke {
    double width;
    csg_cap cap;
    csg_line_join join;
    double miter_limit; /* of SVG: longer miters are bevelled */
    double tolerance;
} csg_stroke;

/* Adds loops that cover an open line drawn with a pen of this width; they overlap, all run
 * counter-clockwise, and their union (fill nonzero) is the stroke. False: out of memory. */
bool csg_stroke_line(const csg_stroke *stroke, const csg_vec2 *points, size_t count,
                     csg_outline *out);

#endif
