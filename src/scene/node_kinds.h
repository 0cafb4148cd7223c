/* SPDX-License-Identifier: MIT
 * The kinds of nodes (scene.h).
 */
#ifndef CSG_SCENE_NODE_KINDS_H
#define CSG_SCENE_NODE_KINDS_H

#include <stdbool.h>

/* Those of primitives stand behind the others (scene/primitives/kinds.h). */
typedef enum csg_node_kind {
    CSG_NODE_EMPTY,
    CSG_NODE_FIELD,
    CSG_NODE_SHAPE,
    CSG_NODE_TRANSFORM,
    CSG_NODE_COLOR,
    CSG_NODE_OFFSET,
    CSG_NODE_WARP,
    CSG_NODE_COMBINE,
    CSG_NODE_SOFT,
    CSG_NODE_UNION,
    CSG_NODE_INTERSECTION,
    CSG_NODE_DIFFERENCE,
    CSG_NODE_FIRST_PRIMITIVE
} csg_node_kind;

/* Of a primitive, as scene/primitives/kinds.h has them. */
typedef unsigned csg_primitive_kind;

/* A row of primitives.def. */
static inline bool csg_node_is_named_primitive(csg_node_kind kind)
{
    return kind >= CSG_NODE_FIRST_PRIMITIVE;
}
/* A leaf that is a solid: a field or a shape too. */
static inline bool csg_node_is_primitive(csg_node_kind kind)
{
    return kind == CSG_NODE_FIELD || kind == CSG_NODE_SHAPE || csg_node_is_named_primitive(kind);
}
static inline bool csg_node_is_operator(csg_node_kind kind)
{
    return kind >= CSG_NODE_UNION && kind <= CSG_NODE_DIFFERENCE;
}

#endif
