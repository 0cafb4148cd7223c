/* SPDX-License-Identifier: MIT
 * DXF entities -> lines in their own coordinates.
 */
#ifndef CSG_OUTLINE_DXF_ENTITY_H
#define CSG_OUTLINE_DXF_ENTITY_H

#include "outline/dxf/dxf_file.h"
#include "outline/dxf/dxf_request.h"
#include "outline/polylines.h"

/* Adds the lines of entity number `index` of the file (a POLYLINE's vertices are the entities after
 * it, before number `past`) that will be enlarged by `stretch`. *drawn = false: a kind that draws
 * none, or broken. CSGM_ERR_MEMORY or CSGM_ERR_LIMIT. */
csgm_status csg_dxf_draw(const csg_dxf_file *file, size_t index, size_t past,
                         const csg_dxf_request *request, double stretch, csg_polylines *out,
                         bool *drawn);

#endif
