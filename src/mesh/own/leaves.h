/* SPDX-License-Identifier: MIT
 * Leaves of a scene that are polyhedra: shapes of triangles, sharp boxes, outlines that are
 * extruded straight.
 */
#ifndef CSG_MESH_OWN_LEAVES_H
#define CSG_MESH_OWN_LEAVES_H

#include "scene/scene.h"

typedef enum csg_own_leaf_kind {
    CSG_OWN_LEAF_NONE, /* it is no such leaf */
    CSG_OWN_LEAF_BOX,
    CSG_OWN_LEAF_SHAPE /* explicit triangles or segments */
} csg_own_leaf_kind;

/* What stands above a node. */
typedef struct csg_own_way {
    csg_affine place;
    csg_look look;
} csg_own_way;

/* Of the children of a transform or a colour; every other node adds nothing. */
csg_own_way csg_own_way_below(const csgm_scene *scene, const csg_node *node, csg_own_way way);

csg_own_leaf_kind csg_own_leaf_kind_of(const csgm_scene *scene, const csg_node *node);
typedef struct csg_own_leaf {
    csg_shape *shape; /* one reference */
    csg_own_way way;  /* of the shape */
} csg_own_leaf;

/* Such a leaf below this way. leaf->shape is NULL where an outline cannot be cut into triangles.
 * CSGM_ERR_MEMORY is not reported. */
csgm_status csg_own_leaf_make(const csgm_scene *scene, const csg_node *node, const csg_own_way *way,
                              csg_own_leaf *leaf);

#endif
