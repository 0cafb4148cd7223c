/* SPDX-License-Identifier: MIT
 * The kinds of warps and what warps.def says of each. Only who tells warps apart by their names
 * includes this, so that a new row rebuilds little.
 */
#ifndef CSG_SCENE_WARP_KINDS_H
#define CSG_SCENE_WARP_KINDS_H

#include <stdint.h>

typedef enum csg_warp_kind {
#define CSG_WARP(NAME, ...) CSG_WARP_##NAME,
#include "scene/primitives/warps.def"
    CSG_WARP_COUNT
} csg_warp_kind;

enum {
    CSG_WARP_IS_FLAT = 1, /* its field does not depend on z */
    CSG_WARP_IS_CUT = 2   /* needs its child's box, and the builder cuts what lies outside */
};

enum { CSG_TWIST_RATE, CSG_TWIST_LOW, CSG_TWIST_HIGH, CSG_TWIST_REACH };
/* The first three are those of a twist. */
enum { CSG_TAPER_RATE, CSG_TAPER_LOW, CSG_TAPER_HIGH, CSG_TAPER_X, CSG_TAPER_Y, CSG_TAPER_REACH };
enum { CSG_ELBOW_HALF, CSG_ELBOW_COSINE, CSG_ELBOW_SINE };
enum { CSG_BEND_RADIUS, CSG_BEND_NEAREST, CSG_BEND_ANGLE /* radians */ };

const char *csg_warp_name(csg_warp_kind kind);
uint32_t csg_warp_given(csg_warp_kind kind);
unsigned csg_warp_traits(csg_warp_kind kind);

#endif
