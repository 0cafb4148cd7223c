/* SPDX-License-Identifier: MIT
 * What is measured, and how closely: as csgm_measure_options says it.
 */
#ifndef CSG_API_MEASURED_H
#define CSG_API_MEASURED_H

#include "csgmesh/csgmesh.h"

/* `own` holds what is given, and defaults. False: an option is out of range. */
bool csg_measure_options_adopt(csgm_measure_options *own, const csgm_measure_options *given);

/* All of it where part is NULL; false: there is none of that name. */
bool csg_measured_mesh(const csgm_mesh_view *mesh, const char *part, csgm_mesh_view *out);

/* Whether something is there to be delivered: all of it, or what was proven before a limit. */
bool csg_measured_so_far(csgm_status status);

#endif
