/* SPDX-License-Identifier: MIT
 * Lines along outlines and creases: between two neighbouring samples of a picture there is one
 * where only one of them sees the solid, where the surface turns, and where what lies behind
 * begins. How many neighbours of a pixel are parted, across and down, is how long the line in it
 * is; so lines are as smooth as their samples are many.
 */
#ifndef CSG_RENDER_OUTLINE_H
#define CSG_RENDER_OUTLINE_H

#include <stdbool.h>

typedef struct csg_outline_point {
    bool is_hit;
    float at[3],
        normal[3]; /* relative to anything near; unit, outwards. Set where something is hit */
    float pixel;   /* the side of a pixel there */
} csg_outline_point;

/* Cosines between normals, below which there is a crease: of a surface, and of plane triangles,
 * which turn from one to the next where the surface is smooth. */
#define CSG_OUTLINE_CREASE 0.9f
#define CSG_OUTLINE_FACETS 0.77f

bool csg_outline_between(const csg_outline_point *a, const csg_outline_point *b, float crease);

/* How much of a pixel a line covers that is so long, across and down, in pixels. */
float csg_outline_cover(float across, float down);

/* Lays it over the sums of `samples` rays. */
void csg_outline_draw(float line, float samples, float light[3], float *cover);

#endif
