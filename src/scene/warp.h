/* SPDX-License-Identifier: MIT
 * Warps: maps of space that are not affine. A node below a warp w has its own frame; the warp's
 * field is f(p) = s v(p) g(w(p)), where v >= 0 is the warp's local stretch and s <= 1 makes the
 * Lipschitz constant hold (stated for each kind in warps.def, computed by csg_warp_scale from the
 * child's box). Definitions in double: scene/reference_warps.c; in float: field/warps.h.
 */
#ifndef CSG_SCENE_WARP_H
#define CSG_SCENE_WARP_H

#include <stdint.h>

#include "base/geometry.h"

typedef enum csg_warp_kind {
#define CSG_WARP(NAME, name, count, doc) CSG_WARP_##NAME,
#include "scene/warps.def"
#undef CSG_WARP
    CSG_WARP_COUNT
} csg_warp_kind;

enum { CSG_WARP_PARAMETERS = 6 };

typedef struct csg_warp {
    uint8_t kind; /* csg_warp_kind */
    double parameters[CSG_WARP_PARAMETERS];
} csg_warp;

const char *csg_warp_name(csg_warp_kind kind);
uint32_t csg_warp_parameter_count(csg_warp_kind kind);

typedef struct csg_warped {
    csg_vec3 at;      /* w(p) */
    double stretch;   /* v(p) */
    double column[3][3]; /* column[i] = dw / dp_i */
    csg_vec3 slope;   /* gradient of v */
} csg_warped;

csg_warped csg_warp_at(const csg_warp *warp, csg_vec3 p);
/* s for a child whose solid lies in this box. 0: there is none (the box is infinite where it must
 * not be, or reaches where the map tears). */
double csg_warp_scale(const csg_warp *warp, csg_box child);
/* Contains every p with w(p) in the child's box. */
csg_box csg_warp_box(const csg_warp *warp, csg_box child);

#endif
