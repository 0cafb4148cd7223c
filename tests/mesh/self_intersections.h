/* SPDX-License-Identifier: MIT
 * Pairs of triangles of a mesh that meet in more than the vertices they share, exactly: by CGAL.
 * Two triangles that share no vertex and touch in a point are such a pair.
 */
#ifndef TEST_MESH_SELF_INTERSECTIONS_H
#define TEST_MESH_SELF_INTERSECTIONS_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* How many; the first `room` of them to pairs. -1: the triangles are no oriented 2-manifold. */
long long test_self_intersections(const float *positions, size_t vertex_count,
                                  const uint32_t *indices, size_t triangle_count,
                                  uint32_t (*pairs)[2], size_t room);

#ifdef __cplusplus
}
#endif

#endif
