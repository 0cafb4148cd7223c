/* SPDX-License-Identifier: MIT
 * Segments from one place of a field's surface to another one that faces it: points that show how
 * thin a wall, or how narrow a gap is.
 */
#ifndef CSG_WALLS_SEGMENT_H
#define CSG_WALLS_SEGMENT_H

#include "walls/search.h"
#include "walls/side.h"

/* From the surface near the point along its normal to the other side, and from there to where both
 * are nearer. Field frame, as all of these. */
void csg_wall_show_from(csg_wall_side *side, csg_vec3 near, csg_wall_shown *best);
/* From the surface near one point to the surface near the other. */
void csg_wall_show_between(csg_wall_side *side, csg_vec3 near, csg_vec3 other,
                           csg_wall_shown *best);

/* What all points so far from there are, proven by the tape's interval. Where memory is short,
 * which is kept in mind, SURFACE. */
csg_cell_state csg_wall_state_at(csg_wall_side *side, csg_vec3 at, double radius);

#endif
