/* SPDX-License-Identifier: MIT
 * Triangles made in code; distances and winding numbers by the plainest means.
 */
#ifndef CSG_TESTS_SHAPE_SOLID_SUPPORT_H
#define CSG_TESTS_SHAPE_SOLID_SUPPORT_H

#include "shape/outline_support.h"
#include "shape/polyhedra/polyhedron.h"

/* Triangles and what csg_polyhedron_create makes of them. */
typedef struct solid_case {
    csg_memory memory;
    csg_triangles triangles;
    csg_repairs repairs;
    csg_shape *shape;
} solid_case;

static inline void solid_begin(solid_case *c)
{
    csg_memory_init(&c->memory, NULL, 0);
    csg_triangles_init(&c->triangles, &c->memory);
    c->shape = NULL;
}

/* The shape of what was added. */
static inline void solid_make(solid_case *c)
{
    assert_int_equal(csg_polyhedron_create(&c->memory, &c->triangles, &c->repairs, &c->shape),
                     CSGM_OK);
}

static inline void solid_end(solid_case *c)
{
    csg_shape_release(c->shape);
    csg_triangles_release(&c->triangles);
    assert_int_equal(c->memory.used_bytes, 0);
}

/* All of these add to what is there. */
void solid_add_box(csg_triangles *t, csg_vec3 low, csg_vec3 high, bool inwards);
/* Each face cut into n x n squares. */
void solid_add_fine_box(csg_triangles *t, csg_vec3 low, csg_vec3 high, uint32_t n);
/* 2 columns (rows - 1) triangles; radius (1 + bumps * some waves). */
void solid_add_ball(csg_triangles *t, csg_vec3 center, double radius, uint32_t columns,
                    uint32_t rows, double bumps);
void solid_add_copy(csg_triangles *t, const csg_triangles *from);

void solid_remove(csg_triangles *t, size_t triangle);
void solid_flip(csg_triangles *t, size_t triangle);
double solid_volume(const csg_triangles *t);

/* By Voronoi regions (Ericson 5.1.5); over all triangles. */
double solid_distance(const csg_triangles *t, csg_vec3 p);
/* By solid angles (van Oosterom and Strackee 1983). */
double solid_winding(const csg_triangles *t, csg_vec3 p);

csg_vec3 solid_random_point(csg_random *random, double half);

#endif
