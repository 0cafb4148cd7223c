/* SPDX-License-Identifier: MIT
 * A receiver that makes one mesh in memory of the runs that come, for those who look at them on
 * their way.
 */
#ifndef CSG_MESH_COLLECT_H
#define CSG_MESH_COLLECT_H

#include "mesh/mesh.h"
#include "mesh/run.h"

typedef struct csg_mesh_collector {
    csgm_context *context;
    csgm_mesh *mesh; /* from the receiver's begin on: of its caller */
} csg_mesh_collector;

csg_mesh_receiver csg_mesh_collector_receiver(csg_mesh_collector *collector);

#endif
