/* SPDX-License-Identifier: MIT
 * The thinnest wall and the narrowest gap of a solid, between proven bounds.
 */
#ifndef CSG_WALLS_WALLS_H
#define CSG_WALLS_WALLS_H

#include "base/context.h"
#include "csgmesh/fabrication.h"

/* Options are complete and in range. CSGM_OK, or why not (reported); with CSGM_ERR_LIMIT,
 * CSGM_ERR_MEMORY and CSGM_CANCELLED *out has what is proven by then. */
csgm_status csg_walls_of_field(csgm_context *context, const csgm_field *field,
                               const csgm_wall_options *options, csgm_walls *out);

#endif
