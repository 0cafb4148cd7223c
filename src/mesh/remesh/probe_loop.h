/* SPDX-License-Identifier: MIT
 * Questions to the field that do not depend on each other, on all threads: each has a probe of its
 * own.
 */
#ifndef CSG_MESH_REMESH_PROBE_LOOP_H
#define CSG_MESH_REMESH_PROBE_LOOP_H

#include "mesh/remesh/probe.h"
#include "mesh/watch.h"

/* Asks for what has the numbers from `first` to before `end`, at most `stretch` of them. Any
 * thread; what comes of it must not depend on which. */
typedef void csg_probe_visit(void *user, csg_probe *probe, size_t first, size_t end);

/* Visits all numbers below `count`. marching: as csg_probe_make has it. False: stopped, or without
 * memory; the watch knows. */
bool csg_probe_loop(csg_mesh_watch *watch, const csg_marching *marching, size_t count,
                    size_t stretch, csg_probe_visit *visit, void *user);

#endif
