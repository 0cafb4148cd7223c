/* SPDX-License-Identifier: MIT
 * Meshes made in code, to be compared: balls of latitudes and longitudes, boxes, any positions.
 */
#ifndef CSG_TESTS_DIFF_SHAPES_H
#define CSG_TESTS_DIFF_SHAPES_H

#include "csgmesh/csgmesh.h"

typedef struct diff_shape {
    float *positions;
    uint32_t *indices;
    uint64_t vertex_count, triangle_count;
} diff_shape;

/* 2 * columns * (rows - 1) triangles. */
diff_shape diff_ball(uint32_t columns, uint32_t rows, double radius, csgm_vec3 center);
/* 12 * n * n triangles: each face a grid of n squares. */
diff_shape diff_box(csgm_vec3 low, csgm_vec3 high, uint32_t n);
void diff_shape_append(diff_shape *to, const diff_shape *more);
/* Another order of triangles and vertices, and of the corners of triangles. */
void diff_shape_shuffle(diff_shape *shape, uint64_t seed);
/* Corners of triangles that are vertices of their own. */
void diff_shape_loosen(diff_shape *shape);
void diff_shape_release(diff_shape *shape);
csgm_mesh_view diff_view(const diff_shape *shape);

#endif
