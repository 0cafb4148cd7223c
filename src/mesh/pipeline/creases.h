/* SPDX-License-Identifier: MIT
 * The stage of the pipeline that finds sharp features (features/features.h): between sampling and
 * numbering of a slab's blocks. In a slab that is sampled again they are known.
 */
#ifndef CSG_MESH_PIPELINE_CREASES_H
#define CSG_MESH_PIPELINE_CREASES_H

#include "mesh/pipeline/workers.h"
#include "mesh/watch.h"

typedef struct csg_mesh_creases {
    /* taken */
    csg_mesh_watch *watch;
    csg_mesh_workers *workers;
    bool sharp; /* false: plain marching cubes, and nothing below is done */
    bool split; /* a vertex for each sheet at a crease */
    /* made */
    csg_feature_store store;
    struct csg_found_item *found; /* while those of a slab are looked for */
    csg_mesh_blocks blocks;       /* of that slab */
} csg_mesh_creases;

/* Finds the features of the blocks at hand, or, where they are known, looks them up; adds what they
 * are to the blocks' counts. */
csgm_status csg_mesh_find_features(csg_mesh_creases *creases, csg_mesh_blocks blocks);
/* After the blocks at hand have their numbers, the first time. */
void csg_mesh_number_features(csg_mesh_creases *creases, csg_mesh_blocks blocks);
/* Once all are found, or `own` has ended it (on this rank): joins them, and makes smooth again what
 * cannot be joined. All ranks end alike. */
csgm_status csg_mesh_settle_features(csg_mesh_creases *creases, const csg_octree *octree,
                                     csgm_status own);
void csg_mesh_creases_release(csg_mesh_creases *creases);

#endif
