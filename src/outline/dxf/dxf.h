/* SPDX-License-Identifier: MIT
 * DXF drawings (text form) -> an outline, as import() of OpenSCAD takes them: closed curves are
 * loops, open ones whose ends meet are joined to loops, areas are what an odd number of loops
 * encloses. Drawing units are millimetres whatever the file says of its units (`unit_mm` tells).
 * Beyond OpenSCAD: POLYLINE, SPLINE, SOLID, bulges, mirrored entities (extrusion 0 0 -1), arrays
 * of INSERT, base points of blocks; entities of paper space are left out.
 */
#ifndef CSG_OUTLINE_DXF_H
#define CSG_OUTLINE_DXF_H

#include "outline/input.h"

typedef struct csg_dxf_request {
    const char *text; /* the file's bytes */
    size_t length;
    double tolerance; /* of flattened curves, in mm; > 0 */
    /* How many pieces a whole circle of this radius in the drawing is to have; arcs and ellipses
     * (by their larger radius) have their share, rounded up. NULL: by the tolerance, as splines
     * always are. */
    uint32_t (*fragments)(const void *user, double radius);
    const void *fragments_user;
    const char *layer; /* NULL or "" = all */
    csg_vec2 origin;   /* p becomes (p - origin) scale */
    double scale;      /* 0 = 1 */
    bool center;       /* the middle of the box of what is drawn at the origin */
} csg_dxf_request;

typedef struct csg_dxf_report {
    size_t entities;       /* drawn, those of blocks each time */
    size_t unclosed;       /* runs of lines that were closed by a straight piece, or dropped */
    size_t ignored;        /* entities of kinds that make no area, and broken ones */
    char ignored_kind[24]; /* the first of those */
    size_t unresolved;     /* INSERT of blocks that are not there or nested too deep */
    bool not_found;        /* nothing stands on the layer */
    double unit_mm;        /* $INSUNITS: the size of a unit in mm, 0 = not stated */
    csg_problem problem;
} csg_dxf_report;

/* Loops as of csg_svg_outline (svg.h). CSGM_ERR_FORMAT: binary, or no DXF file. *out is
 * initialised, and empty unless CSGM_OK. */
csgm_status csg_dxf_outline(csg_memory *memory, const csg_dxf_request *request, csg_outline *out,
                            csg_dxf_report *report);

#endif
