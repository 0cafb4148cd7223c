/* SPDX-License-Identifier: MIT
 * The volume of what two parts have in common.
 */
#ifndef CSG_CLEARANCE_OVERLAP_H
#define CSG_CLEARANCE_OVERLAP_H

#include "clearance/tree.h"

/* Between bounds: of cubes that are inside both for certain, and of those that may be; until these
 * are near each other, or the volume is proven to be no more than `enough`. The trees go on
 * growing. False: it was stopped, or memory was short (*out_of_memory); *out is what is proven by
 * then in any case. */
bool csg_clear_overlap(csg_clear_tree *a, csg_clear_tree *b, double enough, csg_mesh_watch *watch,
                       csgm_interval *out, bool *out_of_memory);

#endif
