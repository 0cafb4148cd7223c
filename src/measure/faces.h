/* SPDX-License-Identifier: MIT
 * A mesh's faces by direction: what overhangs, what has no draft.
 */
#ifndef CSG_MEASURE_FACES_H
#define CSG_MEASURE_FACES_H

#include "base/context.h"
#include "base/geometry.h"
#include "csgmesh/fabrication.h"

/* Options are complete and in range. CSGM_OK, or why not (reported). */
csgm_status csg_faces_of_mesh(csgm_context *context, const csgm_mesh_view *mesh,
                              const csgm_face_options *options, csgm_faces *out);

#endif
