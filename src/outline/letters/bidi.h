/* SPDX-License-Identifier: MIT
 * Which characters run from right to left: the bidirectional algorithm of Unicode (UAX #9) by
 * FriBidi. Without it texts that run in one direction only.
 */
#ifndef CSG_OUTLINE_BIDI_H
#define CSG_OUTLINE_BIDI_H

#include "outline/input.h"

enum { CSG_BIDI_MOST_LEVEL = 126 };

typedef enum csg_bidi_base {
    CSG_BIDI_BY_TEXT, /* as its first character with a direction runs */
    CSG_BIDI_LTR,
    CSG_BIDI_RTL
} csg_bidi_base;

/* levels[i]: the embedding level of character i, at most CSG_BIDI_MOST_LEVEL; odd ones run from
 * right to left. The text is one line. CSGM_ERR_UNSUPPORTED: without FriBidi, and the text runs in
 * both directions. */
csgm_status csg_bidi_levels(csg_arena *scratch, const uint32_t *characters, size_t count,
                            csg_bidi_base base, int *levels, csg_problem *problem);

#endif
