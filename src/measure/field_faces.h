/* SPDX-License-Identifier: MIT
 * A field's faces by direction: what overhangs, what it stands on, what has no draft.
 */
#ifndef CSG_MEASURE_FIELD_FACES_H
#define CSG_MEASURE_FIELD_FACES_H

#include "base/context.h"
#include "csgmesh/fabrication.h"

/* Options are complete and in range; how: tolerance, most_cubes and the monitor. CSGM_OK, or why
 * not (reported); with CSGM_ERR_LIMIT, CSGM_ERR_MEMORY and CSGM_CANCELLED *out has what is proven
 * by then. */
csgm_status csg_faces_of_field(csgm_context *context, const csgm_field *field,
                               const csgm_face_options *options, const csgm_measure_options *how,
                               csgm_faces *out);

#endif
