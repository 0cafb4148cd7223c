/* SPDX-License-Identifier: MIT
 * What scenes read off a DXF drawing as numbers: its dimensions, and where two lines cross.
 */
#ifndef CSG_OUTLINE_DXF_MEASURE_H
#define CSG_OUTLINE_DXF_MEASURE_H

#include "outline/dxf/dxf_request.h"

/* Of both: layer, origin and scale of the request count. CSGM_ERR_SCENE: there is none, as the
 * problem says; others as of csg_dxf_outline (dxf.h). */

/* The measure of the dimension with this text; name NULL or "": of the first one. Lengths by their
 * points, whatever text stands there; angles in degrees. */
csgm_status csg_dxf_dimension(csg_memory *memory, const csg_dxf_request *request, const char *name,
                              double *out, csg_problem *problem);
/* Where the first two LINE entities cross, or would. */
csgm_status csg_dxf_crossing(csg_memory *memory, const csg_dxf_request *request, csg_vec2 *out,
                             csg_problem *problem);

#endif
