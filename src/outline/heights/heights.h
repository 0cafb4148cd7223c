/* SPDX-License-Identifier: MIT
 * Height fields, as surface() of OpenSCAD takes them: a table of numbers in text, or the grays of a
 * PNG image; and the solid between one and a flat base.
 */
#ifndef CSG_OUTLINE_HEIGHTS_H
#define CSG_OUTLINE_HEIGHTS_H

#include "outline/input.h"
#include "shape/polyhedra/triangles.h"

typedef struct csg_heights {
    csg_memory *memory;
    size_t columns, rows;
    double *values; /* row by row, y upwards: values[row * columns + column] at (column, row) */
    double lowest;  /* of the values that the file gives */
    size_t missing; /* places that a short row left out; they are 0 */
} csg_heights;

/* Most values of one field. */
#define CSG_HEIGHTS_MOST ((size_t)16 << 20)

/* Numbers between blanks, a row per line, the first line at y = 0; lines that begin with # are
 * comments, and so is what follows one. CSGM_ERR_FORMAT: what is no number, no rows. */
csgm_status csg_heights_from_text(csg_memory *memory, const char *text, size_t length,
                                  csg_heights *out, csg_problem *problem);
/* 0 for black to 100 for white, of 0.2126 R + 0.7152 G + 0.0722 B; alpha is not looked at; the
 * picture's lowest line is at y = 0. `invert`: 100 / 255 minus that, as OpenSCAD 2021.01 does. */
csgm_status csg_heights_from_png(csg_memory *memory, const void *data, size_t size, bool invert,
                                 csg_heights *out, csg_problem *problem);
/* By the first bytes: an image or a table. */
csgm_status csg_heights_from_bytes(csg_memory *memory, const csg_bytes *bytes, bool invert,
                                   csg_heights *out, csg_problem *problem);
void csg_heights_release(csg_heights *heights);

/* The closed solid of OpenSCAD: a cell is four triangles around its centre, which is as high as the
 * mean of its corners; the base lies 1 below the lowest value, or at 0 where that is lower.
 * `center` moves the middle to x = y = 0. CSGM_ERR_SCENE: fewer than two columns or rows. */
csgm_status csg_heights_solid(const csg_heights *heights, bool center, csg_triangles *out,
                              csg_problem *problem);

#endif
