/* SPDX-License-Identifier: MIT
 * A drawing: outlines in layers, each with a name, a colour, both or neither
 * (scene/outlines/draw_layers.h makes it of a flat figure). Layers may overlap.
 */
#ifndef CSG_SHAPE_DRAWING_H
#define CSG_SHAPE_DRAWING_H

#include "shape/plane/outline.h"

typedef struct csg_drawn_layer {
    const char *name; /* NULL: none. Owned by the drawing's arena */
    bool has_color;
    float color[4];      /* red, green, blue, alpha: 0..1, sRGB */
    csg_outline outline; /* clean: outer loops counter-clockwise, holes clockwise */
} csg_drawn_layer;

typedef struct csg_drawing {
    csg_memory *memory;
    csg_arena arena;
    csg_drawn_layer *layers;
    size_t count, capacity;
} csg_drawing;

/* NULL: out of memory. */
csg_drawing *csg_drawing_create(csg_memory *memory);
void csg_drawing_destroy(csg_drawing *drawing);

#endif
