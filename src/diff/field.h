/* SPDX-License-Identifier: MIT
 * A mesh against the exact surface of a scene, by the scene's field in double precision.
 */
#ifndef CSG_DIFF_FIELD_H
#define CSG_DIFF_FIELD_H

#include "diff/side.h"

/* Side `from` against `scene`, whose mesh the other side is (it is turned with it). Some of
 * `samples` points for the mean. CSGM_ERR_MEMORY is reported. */
csgm_status csg_diff_measure_field(csg_diff_pair *pair, int from, const csgm_scene *scene,
                                   uint64_t samples, csgm_diff_field *out);

#endif
