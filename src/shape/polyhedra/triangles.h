/* SPDX-License-Identifier: MIT
 * Triangles as files, hulls and heights give them: points and triples of indices, nothing promised.
 */
#ifndef CSG_SHAPE_TRIANGLES_H
#define CSG_SHAPE_TRIANGLES_H

#include <stdint.h>

#include "base/geometry.h"
#include "base/memory.h"

typedef struct csg_triangles {
    csg_memory *memory;
    csg_vec3 *points;
    uint32_t (*corners)[3];
    size_t point_count, point_capacity, count, capacity;
} csg_triangles;

void csg_triangles_init(csg_triangles *triangles, csg_memory *memory);
void csg_triangles_release(csg_triangles *triangles);
bool csg_triangles_add_point(csg_triangles *triangles, csg_vec3 point);
bool csg_triangles_add(csg_triangles *triangles, uint32_t a, uint32_t b, uint32_t c);
/* A polygon of `count` >= 3 corners; not flat or not convex ones are cut so that no triangle turns
 * over where that can be. Corners that are out of range: false is for memory, so check before. */
bool csg_triangles_add_face(csg_triangles *triangles, const uint32_t *corners, size_t count);
csg_box csg_triangles_box(const csg_triangles *triangles);

#endif
