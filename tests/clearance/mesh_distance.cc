// SPDX-License-Identifier: MIT
// The one file here that knows CGAL; see mesh_distance.h.
#include "mesh_distance.h"

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>

#include <cmath>
#include <vector>

using kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using surface = CGAL::Surface_mesh<kernel::Point_3>;
using primitive = CGAL::AABB_face_graph_triangle_primitive<surface>;
using tree = CGAL::AABB_tree<CGAL::AABB_traits<kernel, primitive>>;
using side_of = CGAL::Side_of_triangle_mesh<surface, kernel>;

struct distance_mesh {
    surface mesh;
    std::vector<kernel::Triangle_3> triangles; // in the order of faces
    tree boxes;
    side_of *side = nullptr;
};

distance_mesh *distance_mesh_make(const double *positions, size_t vertex_count,
                                  const uint32_t *indices, size_t triangle_count)
{
    auto *m = new distance_mesh;
    std::vector<surface::Vertex_index> vertices;
    for (size_t i = 0; i < vertex_count; i++)
        vertices.push_back(m->mesh.add_vertex(
            kernel::Point_3(positions[3 * i], positions[3 * i + 1], positions[3 * i + 2])));
    for (size_t i = 0; i < triangle_count; i++) {
        const uint32_t *v = indices + 3 * i;
        if (m->mesh.add_face(vertices[v[0]], vertices[v[1]], vertices[v[2]]) ==
            surface::null_face()) {
            delete m;
            return nullptr;
        }
        m->triangles.emplace_back(m->mesh.point(vertices[v[0]]), m->mesh.point(vertices[v[1]]),
                                  m->mesh.point(vertices[v[2]]));
    }
    m->boxes.insert(faces(m->mesh).first, faces(m->mesh).second, m->mesh);
    m->boxes.build();
    m->boxes.accelerate_distance_queries();
    m->side = new side_of(m->mesh);
    return m;
}

void distance_mesh_free(distance_mesh *m)
{
    if (m)
        delete m->side;
    delete m;
}

static void put_point(double out[3], const kernel::Point_3 &p)
{
    for (int k = 0; k < 3; k++)
        out[k] = p[k];
}

// Every triangle of a that could be nearer is compared with those of b in its box, grown by the
// least distance so far.
double distance_of_meshes(const distance_mesh *a, const distance_mesh *b, double nearest[2][3])
{
    double least = INFINITY;
    for (auto v : a->mesh.vertices()) {
        kernel::Point_3 p = a->mesh.point(v), q = b->boxes.closest_point(p);
        double d = std::sqrt(CGAL::squared_distance(p, q));
        if (d < least) {
            least = d;
            put_point(nearest[0], p);
            put_point(nearest[1], q);
        }
    }
    if ((*b->side)(*a->mesh.points().begin()) != CGAL::ON_UNBOUNDED_SIDE ||
        (*a->side)(*b->mesh.points().begin()) != CGAL::ON_UNBOUNDED_SIDE)
        return 0;
    for (const auto &t : a->triangles) {
        kernel::Point_3 c = CGAL::centroid(t);
        double radius = 0;
        for (int i = 0; i < 3; i++)
            radius = std::max(radius, std::sqrt(CGAL::squared_distance(c, t[i])));
        if (std::sqrt(b->boxes.squared_distance(c)) - radius >= least)
            continue;
        CGAL::Bbox_3 box = t.bbox();
        kernel::Iso_cuboid_3 grown(box.xmin() - least, box.ymin() - least, box.zmin() - least,
                                   box.xmax() + least, box.ymax() + least, box.zmax() + least);
        std::vector<tree::Primitive_id> near;
        b->boxes.all_intersected_primitives(grown, std::back_inserter(near));
        for (auto face : near)
            least = std::min(least, std::sqrt(CGAL::squared_distance(t, b->triangles[face])));
        if (!(least > 0))
            return 0;
    }
    return least;
}

double distance_of_point(const distance_mesh *m, const double at[3])
{
    kernel::Point_3 p(at[0], at[1], at[2]);
    double d = std::sqrt(m->boxes.squared_distance(p));
    return (*m->side)(p) == CGAL::ON_BOUNDED_SIDE ? -d : d;
}
