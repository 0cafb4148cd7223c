/* SPDX-License-Identifier: MIT
 * Meshes as the page holds them: coordinates of 16 bits in the box of both, and few enough
 * triangles.
 */
#ifndef CLI_DIFF_THIN_H
#define CLI_DIFF_THIN_H

#include "diff/diff_drawing.h"

typedef struct diff_thin {
    uint32_t vertex_count;
    uint64_t triangle_count;
    uint16_t *positions; /* 3 per vertex: 0 is the box's lower corner, 65535 its upper */
    uint16_t *heat;      /* 1 a vertex: distance, 65535 is the largest; NULL: not measured */
    uint8_t *colors;     /* 3 per vertex; NULL: none */
    uint32_t *indices;
    double cell; /* vertices were joined within cells of this size; 0: all are there */
} diff_thin;

/* False: out of memory. Release it either way. */
bool diff_thin_make(const diff_drawing *drawing, int side, uint64_t most_triangles, diff_thin *out);
void diff_thin_release(diff_thin *thin);

#endif
