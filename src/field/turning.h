/* SPDX-License-Identifier: MIT
 * A kind of blend that only tapes have; apart from rule_layout.h, so that a row of operators.def
 * rebuilds little. Who only asks for it: csg_blend_turns() of compile_rule.h.
 */
#ifndef CSG_FIELD_TURNING_H
#define CSG_FIELD_TURNING_H

#include "scene/operators/blend_kinds.h"

/* A SCALE_SET that turns with the gradients' angle: the blend of such operators and their joins. A
 * tape that has one is evaluated with its gradients. */
enum { CSG_BLEND_TURNING = CSG_BLEND_END };

#endif
