/* SPDX-License-Identifier: MIT
 * What a mesh was made from, to be looked at: cubes of the octree, blocks or cells, and features,
 * each a box in scene coordinates with a colour. A context that has a survey fills it with every
 * mesh that is built in it; without one a build pays for a test of a pointer.
 */
#ifndef CSG_MESH_PIPELINE_SURVEY_H
#define CSG_MESH_PIPELINE_SURVEY_H

#include "grid/adaptive/bricks.h"
#include "mesh/mesh.h"
#include "mesh/pipeline/workers.h"

typedef enum csg_survey_kind {
    CSG_SURVEY_OCTREE,   /* cubes: by the length of their tapes, blue to yellow, as blocks are */
    CSG_SURVEY_BLOCKS,   /* of equal cells: 8^3 of them; else single cells of any size */
    CSG_SURVEY_FEATURES, /* by their state: with an apex green, folded orange, given up red, bare
                            grey; cubes of a quarter cell about the apex or the polygon's middle */
    CSG_SURVEY_KINDS
} csg_survey_kind;

typedef struct csg_survey_box {
    csg_vec3 min;
    double size;
    uint8_t color[3];
    uint8_t kind;
} csg_survey_box;

struct csg_survey {
    csgm_context *context;
    csg_survey_box *boxes;
    size_t count, capacity;
    bool failed; /* out of memory; sticky */
};

/* NULL = out of memory, reported. */
csg_survey *csg_survey_create(csgm_context *context);
void csg_survey_destroy(csg_survey *survey); /* NULL is a no-op */

/* Of equal cells: once the octree is walked and features are settled, and then each slab. */
void csg_survey_octree(csg_survey *survey, const csg_mesh_input *input, const csg_octree *octree);
void csg_survey_features(csg_survey *survey, const csg_mesh_input *input,
                         const csg_feature_store *store);
void csg_survey_blocks(csg_survey *survey, const csg_mesh_input *input, csg_mesh_blocks blocks);
/* Of cells that follow the shape, whose lattice this is: bricks with divided cells as the octree,
 * leaves that the surface crosses as blocks. */
void csg_survey_bricks(csg_survey *survey, csg_vec3 center, const csg_bricks *bricks);

/* A mesh with a part for each kind: frames of boxes, features as cubes. Reports what fails. */
csgm_status csg_survey_mesh(const csg_survey *survey, csgm_mesh **out);

#endif
