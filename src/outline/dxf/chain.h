/* SPDX-License-Identifier: MIT
 * Open lines whose ends meet -> loops, as drawings in DXF need it.
 */
#ifndef CSG_OUTLINE_CHAIN_H
#define CSG_OUTLINE_CHAIN_H

#include "outline/polylines.h"

/* Closed lines are loops as they are; ends nearer than `tolerance` meet. Where more than two meet,
 * the first in order goes on. What stays open is closed by a straight piece, counted in *unclosed,
 * and dropped where that encloses nothing. *out is initialised already. CSGM_ERR_MEMORY. */
csgm_status csg_chain_lines(const csg_polylines *lines, double tolerance, csg_outline *out,
                            size_t *unclosed);

#endif
