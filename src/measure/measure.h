/* SPDX-License-Identifier: MIT
 * Mass properties and tight bounds: of fields between proven bounds, of closed meshes exactly.
 */
#ifndef CSG_MEASURE_MEASURE_H
#define CSG_MEASURE_MEASURE_H

#include "base/context.h"
#include "base/geometry.h"

/* Options are complete and in range. CSGM_OK, or why not (reported); with CSGM_ERR_LIMIT,
 * CSGM_ERR_MEMORY and CSGM_CANCELLED *out has what is proven by then. */
csgm_status csg_measure_field(csgm_context *context, const csgm_field *field,
                              const csgm_measure_options *options, csgm_measures *out);

/* CSGM_ERR_FORMAT (reported) where the mesh is not closed. */
csgm_status csg_measure_mesh(csgm_context *context, const csgm_mesh_view *mesh,
                             const csgm_measure_options *options, csgm_measures *out);

/* CSGM_ERR_SCENE (reported): nothing is there to be measured; what there is reaches to infinity. */
csgm_status csg_measure_refuse_empty(csgm_context *context);
csgm_status csg_measure_check_bounds(csgm_context *context, csg_box bounds);
/* CSGM_ERR_FORMAT (reported): a coordinate is not finite or an index out of range. */
csgm_status csg_measure_refuse_broken(csgm_context *context);

#endif
