/* SPDX-License-Identifier: MIT
 * The basic shapes and paths of SVG -> lines in the element's own coordinates.
 */
#ifndef CSG_OUTLINE_SVG_SHAPE_H
#define CSG_OUTLINE_SVG_SHAPE_H

#include "outline/polylines.h"
#include "outline/svg/xml.h"

typedef struct csg_svg_viewport {
    double width, height; /* what percentages are of */
} csg_svg_viewport;

/* Of path, rect, circle, ellipse, polygon, polyline, line. */
bool csg_svg_is_shape(const char *name);
/* Adds the lines of such an element; *broken counts its mistakes. CSGM_ERR_MEMORY, CSGM_ERR_LIMIT.
 */
csgm_status csg_svg_shape_lines(const csg_xml *xml, uint32_t element,
                                const csg_svg_viewport *viewport, double tolerance,
                                csg_polylines *out, size_t *broken);

#endif
