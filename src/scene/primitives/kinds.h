/* SPDX-License-Identifier: MIT
 * The kinds of primitives, in the order of primitives.def, as kinds of nodes (scene/node_kinds.h)
 * and as operators of the tape (field/tape.h). Only who tells primitives apart by their names
 * includes this, so that a new row rebuilds little.
 */
#ifndef CSG_SCENE_KINDS_H
#define CSG_SCENE_KINDS_H

#include <stdint.h>

#include "scene/node_kinds.h"

enum {
    CSG_NODE_BEFORE_PRIMITIVES = CSG_NODE_FIRST_PRIMITIVE - 1,
#define CSG_PRIMITIVE(NAME, ...) CSG_NODE_##NAME,
#include "scene/primitives/primitives.def"
    CSG_NODE_PRIMITIVES_END
};
_Static_assert((int)CSG_NODE_PRIMITIVES_END <= UINT8_MAX, "kinds of nodes are bytes");

#endif
