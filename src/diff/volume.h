/* SPDX-License-Identifier: MIT
 * The volumes that only one of two closed meshes holds.
 */
#ifndef CSG_DIFF_VOLUME_H
#define CSG_DIFF_VOLUME_H

#include "diff/side.h"

/* `differing` (frame units) holds every triangle of either mesh that is not on the other: outside
 * of it the solids are the same. rays: about so many are cast. CSGM_ERR_MEMORY is reported. */
csgm_status csg_diff_measure_volume(csg_diff_pair *pair, csg_box differing, uint64_t rays,
                                    csgm_diff_volume *out);

#endif
