/* SPDX-License-Identifier: MIT
 * SVG -> an outline in millimetres, y upwards, as import() of OpenSCAD 2021.01 takes it: closed
 * paths and shapes are areas, whatever their colours; open lines are areas where their stroke is (1
 * wide, with square ends, unless they say otherwise). A width or height without a unit has `dpi`
 * pixels to the inch, px and other units have 96; the lower edge of the page is at y = 0; a file
 * without width, height and viewBox has 1 unit = 1 mm and y = 0 at its top. Where OpenSCAD is at
 * odds with SVG, SVG is followed: fill-rule (nonzero unless it says evenodd), the corner of a
 * viewBox, display="none", units in shapes, use, symbol, nested svg; and an open path with a fill
 * and stroke="none" is an area. Classes and style sheets, text, images, clipping and masks are left
 * out, and counted.
 */
#ifndef CSG_OUTLINE_SVG_H
#define CSG_OUTLINE_SVG_H

#include "outline/input.h"

typedef struct csg_svg_request {
    const char *text; /* the file's bytes */
    size_t length;
    double tolerance;  /* of flattened curves, in mm; > 0 */
    double dpi;        /* <= 0: 72 */
    bool center;       /* the middle of the box of what is drawn at the origin */
    const char *id;    /* only the element with this id; NULL or "" = all */
    const char *layer; /* only groups with this inkscape:label or id; NULL or "" = all */
} csg_svg_request;

typedef struct csg_svg_report {
    size_t shapes;     /* drawn */
    size_t texts;      /* text elements, left out: to be made paths in the drawing program */
    size_t images;     /* left out */
    size_t clips;      /* clip-path, mask, left out: the whole shape is drawn */
    size_t sheets;     /* style elements: what they hide or fill is not known */
    size_t unresolved; /* use of what is not in the file or too deep */
    size_t broken;     /* paths and transforms with a mistake; drawn as far as they are right */
    size_t unknown;    /* elements of other names */
    bool not_found;    /* no element with the id or layer */
    csg_problem problem;
} csg_svg_report;

/* Loops run counter-clockwise around what is inside and may overlap: csg_polygons_clean(NONZERO)
 * is their union. Needs the library of polygons.h. CSGM_ERR_FORMAT: broken, or not an SVG file.
 * *out is initialised, and empty unless CSGM_OK. */
csgm_status csg_svg_outline(csg_memory *memory, const csg_svg_request *request, csg_outline *out,
                            csg_svg_report *report);

#endif
