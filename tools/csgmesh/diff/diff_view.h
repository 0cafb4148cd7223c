/* SPDX-License-Identifier: MIT
 * From where a change is best seen.
 */
#ifndef CLI_DIFF_VIEW_H
#define CLI_DIFF_VIEW_H

#include "diff/diff_drawing.h"

/* Both meshes are drawn small from all around, with what has moved: the usual view, azimuth 35 and
 * elevation 25, stays unless another one from above shows clearly more of it, and none from below
 * is taken unless all from above show less than half as much. Returns the unit vector towards the
 * eye; CSGM_ERR_MEMORY changes nothing. */
csgm_status diff_view_find(const diff_drawing *drawing, csgm_vec3 *toward);

#endif
