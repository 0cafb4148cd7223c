/* SPDX-License-Identifier: MIT
 * Mass properties and tight bounds: of fields between proven bounds, of closed meshes exactly.
 */
#ifndef CSG_MEASURE_MEASURE_H
#define CSG_MEASURE_MEASURE_H

#include "base/context.h"

/* Options are complete and in range. CSGM_OK, or why not (reported); with CSGM_ERR_LIMIT,
 * CSGM_ERR_MEMORY and CSGM_CANCELLED *out has what is proven by then. */
csgm_status csg_measure_field(csgm_context *context, const csgm_field *field,
                              const csgm_measure_options *options, csgm_measures *out);

/* CSGM_ERR_FORMAT (reported) where the mesh is not closed. */
csgm_status csg_measure_mesh(csgm_context *context, const csgm_mesh_view *mesh,
                             const csgm_measure_options *options, csgm_measures *out);

#endif
