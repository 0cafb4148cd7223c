// SPDX-License-Identifier: MIT
// The one file that knows CGAL; see self_intersections.h.
#include "mesh/self_intersections.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <iterator>
#include <utility>
#include <vector>

using kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using surface = CGAL::Surface_mesh<kernel::Point_3>;

extern "C" long long test_self_intersections(const float *positions, size_t vertex_count,
                                             const uint32_t *indices, size_t triangle_count,
                                             uint32_t (*pairs)[2], size_t room)
{
    surface mesh;
    std::vector<surface::Vertex_index> vertices;
    for (size_t i = 0; i < vertex_count; i++) {
        const float *p = positions + 3 * i;
        vertices.push_back(
            mesh.add_vertex(kernel::Point_3(double(p[0]), double(p[1]), double(p[2]))));
    }
    for (size_t i = 0; i < triangle_count; i++) {
        const uint32_t *v = indices + 3 * i;
        if (mesh.add_face(vertices[v[0]], vertices[v[1]], vertices[v[2]]) == surface::null_face())
            return -1;
    }
    std::vector<std::pair<surface::Face_index, surface::Face_index>> found;
    CGAL::Polygon_mesh_processing::self_intersections(mesh, std::back_inserter(found));
    for (size_t i = 0; i < room && i < found.size(); i++) {
        pairs[i][0] = found[i].first;
        pairs[i][1] = found[i].second;
    }
    return static_cast<long long>(found.size());
}
