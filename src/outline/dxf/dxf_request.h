/* SPDX-License-Identifier: MIT
 * What is asked of a DXF drawing, and what is told of it; see dxf.h.
 */
#ifndef CSG_OUTLINE_DXF_REQUEST_H
#define CSG_OUTLINE_DXF_REQUEST_H

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

#endif
