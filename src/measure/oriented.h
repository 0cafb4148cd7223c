/* SPDX-License-Identifier: MIT
 * The smallest oriented box that is found: of fields between proven bounds, of meshes exactly.
 */
#ifndef CSG_MEASURE_ORIENTED_H
#define CSG_MEASURE_ORIENTED_H

#include "base/context.h"
#include "csgmesh/fabrication.h"

/* Options are complete and in range. CSGM_OK, or why not (reported); with CSGM_ERR_LIMIT,
 * CSGM_ERR_MEMORY and CSGM_CANCELLED *out has what is proven by then. */
csgm_status csg_oriented_box_of_field(csgm_context *context, const csgm_field *field,
                                      const csgm_measure_options *options, csgm_oriented_box *out);

/* CSGM_ERR_FORMAT (reported): a coordinate is not finite or an index out of range. */
csgm_status csg_oriented_box_of_mesh(csgm_context *context, const csgm_mesh_view *mesh,
                                     const csgm_measure_options *options, csgm_oriented_box *out);

#endif
