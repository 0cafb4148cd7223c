/* SPDX-License-Identifier: MIT
 * What repair tells of triangles as people publish them.
 */
#ifndef CSG_SHAPE_REPAIRS_H
#define CSG_SHAPE_REPAIRS_H

#include <stdbool.h>
#include <stddef.h>

/* What was wrong with the triangles and is mended now. */
typedef struct csg_repairs {
    size_t welded;        /* points that lay on another */
    size_t degenerate;    /* triangles without area, or of loose flat sheets; left out */
    size_t duplicate;     /* the same triangle again, left out */
    size_t flipped;       /* triangles turned over */
    size_t holes, filled; /* loops of boundary edges, and triangles that fill them */
    size_t nonmanifold;   /* edges of more than two triangles */
    bool inside_out;      /* the whole was turned over */
    bool overlapping;     /* some places are inside more than once (a hint of self-intersection) */
} csg_repairs;

/* Is there anything that its owner should know? Points that lay on another are no fault. */
bool csg_repairs_are_any(const csg_repairs *repairs);
/* "3 holes filled, 2 triangles turned over"; as far as it fits. */
void csg_repairs_describe(const csg_repairs *repairs, char *text, size_t size);

#endif
