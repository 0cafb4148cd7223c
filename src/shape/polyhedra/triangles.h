/* SPDX-License-Identifier: MIT
 * Triangles as files, hulls and heights give them: points and triples of indices, nothing promised.
 */
#ifndef CSG_SHAPE_TRIANGLES_H
#define CSG_SHAPE_TRIANGLES_H

#include <stdint.h>

#include "base/geometry.h"
#include "base/memory.h"

/* csg_box_hull with a point, without calls of C's library: for millions of points. The box may be
 * empty, with its sides at infinity. */
static inline void csg_box_extend(csg_box *box, csg_vec3 p)
{
    box->min.x = p.x < box->min.x ? p.x : box->min.x;
    box->min.y = p.y < box->min.y ? p.y : box->min.y;
    box->min.z = p.z < box->min.z ? p.z : box->min.z;
    box->max.x = p.x > box->max.x ? p.x : box->max.x;
    box->max.y = p.y > box->max.y ? p.y : box->max.y;
    box->max.z = p.z > box->max.z ? p.z : box->max.z;
}

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
