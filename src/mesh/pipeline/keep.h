/* SPDX-License-Identifier: MIT
 * What a rank has finished, kept in a journal (base/journal.h) for a job that goes on after this
 * one was stopped: slabs that are counted, with their features and doubts, and slabs whose
 * triangles are in the receiver's file. Where context->ranks->keeps is not set nothing is.
 */
#ifndef CSG_MESH_PIPELINE_KEEP_H
#define CSG_MESH_PIPELINE_KEEP_H

#include "mesh/pipeline/output.h"

/* Opens the journal of this rank, and makes it the slabs' keeper; `common` is what all ranks have
 * in common, and what is kept must have. Reports what fails. */
csgm_status csg_mesh_keep_begin(csg_mesh_slabs *slabs, const void *common, size_t bytes);
/* Leaves out the slabs that are made already, once the output has begun and before any is made: the
 * cell that those begin at which are, the stretch's end where none is. */
size_t csg_mesh_keep_skip_made(csg_mesh_output *output, csg_mesh_slabs *slabs);

#endif
