/* SPDX-License-Identifier: MIT
 * Normals, colours and materials of the same triangles, and the names of parts.
 */
#ifndef CSG_DIFF_ATTRIBUTES_H
#define CSG_DIFF_ATTRIBUTES_H

#include "diff/match.h"

void csg_diff_compare_normals(const csg_diff_pair *pair, const csg_diff_match *match,
                              csgm_diff_attribute *out);
/* With metallic and roughness. Where one mesh has no colours, all differ. */
void csg_diff_compare_colors(const csg_diff_pair *pair, const csg_diff_match *match,
                             csgm_diff_attribute *out);
/* CSGM_ERR_MEMORY is reported. */
csgm_status csg_diff_compare_names(csg_diff_pair *pair, bool in_any_order,
                                   csgm_diff_attribute *out);

#endif
