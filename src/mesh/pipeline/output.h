/* SPDX-License-Identifier: MIT
 * Where vertices and triangles go: to their places in the mesh's arrays, or, run by run, through a
 * buffer of the worker's to a receiver.
 */
#ifndef CSG_MESH_PIPELINE_OUTPUT_H
#define CSG_MESH_PIPELINE_OUTPUT_H

#include "mesh/mesh.h"
#include "mesh/pipeline/slabs.h"
#include "mesh/run.h"

typedef struct csg_mesh_output {
    /* taken */
    csg_mesh_watch *watch;
    csg_mesh_workers *workers;
    const csg_mesh_creases *creases;
    const csg_mesh_input *input;
    const csg_mesh_receiver *receiver; /* NULL: a mesh is made */
    /* made */
    csg_mesh_blocks blocks; /* at hand */
    csg_mesh_counts counts; /* of the whole mesh */
    csg_cell_sum before;    /* what other ranks have made before this one's */
    csgm_mesh *mesh;        /* NULL when a receiver takes it; the caller's */
} csg_mesh_output;

/* Once all is counted: tells the counts to the receiver, or makes the mesh's arrays. */
csgm_status csg_mesh_begin_output(csg_mesh_output *output, const csg_mesh_slabs *slabs);
/* Vertices and triangles of all slabs, from the last to the first. */
csgm_status csg_mesh_make_slabs(csg_mesh_output *output, csg_mesh_slabs *slabs);

#endif
