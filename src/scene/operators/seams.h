/* SPDX-License-Identifier: MIT
 * Where two solids of a sharp union lie against each other, its field is 0 within the solid: inside
 * of each it is the distance to that one's own surface, the common face included. Whatever blends
 * with it near that seam takes the face for an edge: an intersection or a difference rounds it, and
 * there is a groove; where the two are cut out of something, a union leaves a fin.
 */
#ifndef CSG_SCENE_SEAMS_H
#define CSG_SCENE_SEAMS_H

#include "scene/operators/joint.h"
#include "scene/reference.h"

/* Where a node's box ends along an axis. */
typedef struct csg_seam_end {
    double at;
    csg_node_id id;
} csg_seam_end;

typedef struct csg_seam_search {
    const csgm_scene *scene;
    csg_reference_room *room;
    const csg_node_id *firsts, *parents; /* per node: the first one below it; the one above it */
    const uint64_t *cost_before;         /* per node, and the end: what all nodes before it take */
    uint64_t work, most_work;            /* done, and what may be */
    csg_seam_end *order;                 /* room for the children of one node, twice */
    bool *is_told;                       /* per node; all false at first */
} csg_seam_search;

/* Gives one joint, CSG_JOINT_GROOVES, of each blended operator that has one. */
void csg_seams_find(csg_seam_search *search, csg_joint_take *take, void *user);

#endif
