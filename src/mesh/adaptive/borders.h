/* SPDX-License-Identifier: MIT
 * Leaves beside finer ones: their polygons are known only when these are. Where they are not what
 * they should be, the leaf wants to be divided. Of bricks that were checked only those are again
 * that new ones touch.
 */
#ifndef CSG_MESH_ADAPTIVE_BORDERS_H
#define CSG_MESH_ADAPTIVE_BORDERS_H

#include "mesh/adaptive/extraction.h"

/* Those whose several polygons may not keep apart, or that touch a pierced edge of finer ones;
 * *any: there are some. CSGM_OK or why it was stopped (reported). */
csgm_status csg_borders_check_simple(csg_extraction *extraction, bool *any);

/* The same of those whose triangles are too far from the surface, or from each other; all are
 * simple. */
csgm_status csg_borders_check_near(csg_extraction *extraction, bool *any);

#endif
