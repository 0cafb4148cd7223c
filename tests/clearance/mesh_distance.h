/* SPDX-License-Identifier: MIT
 * Exact distances of closed meshes, by CGAL.
 */
#ifndef TEST_MESH_DISTANCE_H
#define TEST_MESH_DISTANCE_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A closed mesh in double; it is copied. */
typedef struct distance_mesh distance_mesh;

distance_mesh *distance_mesh_make(const double *positions, size_t vertex_count,
                                  const uint32_t *indices, size_t triangle_count);
void distance_mesh_free(distance_mesh *mesh);

/* Of the solids that they bound: 0 where these meet. nearest: a point of each. */
double distance_of_meshes(const distance_mesh *a, const distance_mesh *b, double nearest[2][3]);
/* Of a point from the solid: negative where it is inside. */
double distance_of_point(const distance_mesh *mesh, const double at[3]);

#ifdef __cplusplus
}
#endif
#endif
