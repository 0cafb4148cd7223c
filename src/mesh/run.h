/* SPDX-License-Identifier: MIT
 * A mesh that is handed on in pieces, as it is made: the counts first, then runs of consecutive
 * vertices and triangles from any worker in any order.
 */
#ifndef CSG_MESH_RUN_H
#define CSG_MESH_RUN_H

#include "base/context.h"
#include "base/geometry.h"

typedef struct csg_mesh_counts {
    uint64_t vertex_count, triangle_count;
    bool normals, colors;
    bool split; /* vertices have copies, one after the other, where normals differ */
    csgm_vec3 origin;
    csg_box bounds; /* around all vertices, but for rounding; in the mesh's frame */
} csg_mesh_counts;

typedef struct csg_mesh_run {
    uint32_t worker;
    uint64_t first_vertex, vertex_count, first_triangle, triangle_count;
    const float *positions, *normals; /* of first_vertex; normals and colors may be NULL */
    const uint8_t *colors;
    const uint32_t *indices; /* of first_triangle; numbers of the whole mesh */
    const float *corners; /* of first_triangle: 9 floats per triangle; then nothing of the above */
    /* Where they are wanted: as indices, but copies of a vertex that is split are all the first. */
    const uint32_t *joined;
} csg_mesh_run;

typedef struct csg_mesh_receiver {
    void *user;
    /* Once, on the calling thread, before any run. Anything but CSGM_OK (reported) ends the build.
     */
    csgm_status (*begin)(void *user, const csg_mesh_counts *counts);
    /* Any worker. False ends the build; the receiver remembers why. */
    bool (*put)(void *user, const csg_mesh_run *run);
    /* For one that is to go on later with what it has: what it has seen of all runs, *bytes of it
     * (none: 0), to be read, or to be written before the first run. NULL: it has nothing. */
    void *(*seen)(void *user, uint64_t *bytes);
    /* All runs until now are where they stay. False: as put. */
    bool (*flush)(void *user);
    bool wants_corners; /* runs of loose triangles instead of vertices and indices */
    bool wants_joined;
} csg_mesh_receiver;

#endif
