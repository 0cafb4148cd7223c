/* SPDX-License-Identifier: MIT
 * DXF drawings (text form) -> an outline, as import() of OpenSCAD takes them: closed curves are
 * loops, open ones whose ends meet are joined to loops, areas are what an odd number of loops
 * encloses. Drawing units are millimetres whatever the file says of its units (`unit_mm` tells).
 * Beyond OpenSCAD: POLYLINE, SPLINE, SOLID, bulges, mirrored entities (extrusion 0 0 -1), arrays
 * of INSERT, base points of blocks; entities of paper space are left out.
 */
#ifndef CSG_OUTLINE_DXF_H
#define CSG_OUTLINE_DXF_H

#include "outline/dxf/dxf_request.h"

/* Loops as of csg_svg_outline (svg.h). CSGM_ERR_FORMAT: binary, or no DXF file. *out is
 * initialised, and empty unless CSGM_OK. */
csgm_status csg_dxf_outline(csg_memory *memory, const csg_dxf_request *request, csg_outline *out,
                            csg_dxf_report *report);

#endif
