/* SPDX-License-Identifier: MIT
 * The files of all primitives, as primitives.def lists them.
 */
#ifndef CSG_SCENE_EVERY_PRIMITIVE_H
#define CSG_SCENE_EVERY_PRIMITIVE_H

#include "scene/primitives/kinds.h"

#define CSG_PRIMITIVE_FILES
#include "scene/primitives/primitives.def"
#undef CSG_PRIMITIVE_FILES

#endif
