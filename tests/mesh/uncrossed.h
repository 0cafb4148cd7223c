/* SPDX-License-Identifier: MIT
 * Asserting that a mesh does not run through itself, where CGAL is there to say so.
 */
#ifndef TEST_MESH_UNCROSSED_H
#define TEST_MESH_UNCROSSED_H

#include "mesh/mesh.h"
#include "mesh/self_intersections.h"

static inline void assert_uncrossed(const csgm_mesh *mesh, const char *what)
{
#ifdef HAVE_CGAL
    long long count = test_self_intersections(mesh->positions, mesh->vertex_count, mesh->indices,
                                              mesh->triangle_count, NULL, 0);
    if (count)
        fail_msg("%s: %lld crossings of %llu triangles", what, count,
                 (unsigned long long)mesh->triangle_count);
#else
    (void)mesh;
    (void)what;
#endif
}

#endif
