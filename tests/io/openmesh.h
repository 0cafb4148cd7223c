/* SPDX-License-Identifier: MIT
 * OpenMesh as somebody else's reader and writer of the same formats: an independent opinion for the
 * tests and the other side of the benchmark. Only openmesh.cc names it.
 */
#ifndef CSG_TESTS_IO_OPENMESH_H
#define CSG_TESTS_IO_OPENMESH_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct openmesh_mesh openmesh_mesh;

/* Builds its half-edges from our arrays; normals may be NULL. faces_refused: those it did not take.
 */
openmesh_mesh *openmesh_build(const float *positions, const float *normals, uint32_t vertex_count,
                              const uint32_t *indices, uint32_t triangle_count,
                              uint32_t *faces_refused);
openmesh_mesh *openmesh_read(const char *path); /* NULL when it cannot */
/* Format by extension; as binary where the format can be. */
bool openmesh_write(const openmesh_mesh *mesh, const char *path, bool binary);
void openmesh_destroy(openmesh_mesh *mesh);

uint32_t openmesh_vertices(const openmesh_mesh *mesh);
uint32_t openmesh_triangles(const openmesh_mesh *mesh);
/* Corner positions of one triangle, 9 numbers. */
void openmesh_corners(const openmesh_mesh *mesh, uint32_t triangle, float *corners);

#ifdef __cplusplus
}
#endif
#endif
