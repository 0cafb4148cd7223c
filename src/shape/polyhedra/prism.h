/* SPDX-License-Identifier: MIT
 * The straight extrusion of an outline, as triangles.
 */
#ifndef CSG_SHAPE_PRISM_H
#define CSG_SHAPE_PRISM_H

#include "shape/plane/outline.h"
#include "shape/polyhedra/triangles.h"

/* Between z = low and z = high > low, outward where the outline is clean (shape/plane/polygons.h);
 * *out is initialised and filled on CSGM_OK, else there is nothing to release. As
 * csg_polygons_triangulate fails. */
csgm_status csg_prism(csg_memory *memory, const csg_outline *outline, double low, double high,
                      csg_triangles *out);

#endif
