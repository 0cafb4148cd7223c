/* SPDX-License-Identifier: MIT
 * A figure swept along a path.
 */
#ifndef CSG_SOLID_ALONG_H
#define CSG_SOLID_ALONG_H

#include "solid/path.h"
#include "solid/solid.h"

/* The figure moves across the path with its frames; at the ends it stops square to it. EMPTY with
 * found->fault where the figure does not fit the path; `flat` is consumed and not empty. */
csg_node_id csg_solid_along(csg_solid_job *job, csg_node_id flat, const csg_path *path,
                            csg_path_finding *found);

#endif
