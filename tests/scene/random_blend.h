/* SPDX-License-Identifier: MIT
 * Random blends, apart from random scenes: most tests take scenes as they come, and need not be
 * built again for a row of operators.def.
 */
#ifndef TEST_RANDOM_BLEND_H
#define TEST_RANDOM_BLEND_H

#include "base/random.h"
#include "scene/operators/blend_kinds.h"

csg_blend test_random_blend(csg_random *random, csg_blend_kind kind);

#endif
