/* SPDX-License-Identifier: MIT
 * The only file that names OpenMesh. Its streams are opened here and with nine digits: by path it
 * neither notices write errors nor keeps all bits of a float in OBJ files.
 */
#include "openmesh.h"

#include <fstream>
#include <string>
#include <vector>

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

using mesh_type = OpenMesh::TriMesh_ArrayKernelT<>;

struct openmesh_mesh {
    mesh_type mesh;
    bool has_normals = false;
};

static void silence()
{
    omerr().disable();
    omlog().disable();
    omout().disable();
}

openmesh_mesh *openmesh_build(const float *positions, const float *normals, uint32_t vertex_count,
                              const uint32_t *indices, uint32_t triangle_count,
                              uint32_t *faces_refused)
{
    silence();
    auto *out = new openmesh_mesh;
    std::vector<mesh_type::VertexHandle> handles(vertex_count);
    out->has_normals = normals != nullptr;
    if (normals)
        out->mesh.request_vertex_normals();
    for (size_t i = 0; i < vertex_count; i++) {
        const float *p = positions + 3 * i;
        handles[i] = out->mesh.add_vertex(mesh_type::Point(p[0], p[1], p[2]));
        if (normals) {
            const float *n = normals + 3 * i;
            out->mesh.set_normal(handles[i], mesh_type::Normal(n[0], n[1], n[2]));
        }
    }
    *faces_refused = 0;
    for (size_t i = 0; i < triangle_count; i++) {
        const uint32_t *t = indices + 3 * i;
        if (!out->mesh.add_face(handles[t[0]], handles[t[1]], handles[t[2]]).is_valid())
            ++*faces_refused;
    }
    return out;
}

openmesh_mesh *openmesh_read(const char *path)
{
    silence();
    auto *out = new openmesh_mesh;
    OpenMesh::IO::Options options;
    if (OpenMesh::IO::read_mesh(out->mesh, path, options))
        return out;
    delete out;
    return nullptr;
}

bool openmesh_write(const openmesh_mesh *mesh, const char *path, bool binary)
{
    std::string name(path);
    OpenMesh::IO::Options options;
    if (binary)
        options += OpenMesh::IO::Options::Binary;
    std::string extension = name.substr(name.find_last_of('.'));
    if (mesh->has_normals && extension != ".stl")
        options += OpenMesh::IO::Options::VertexNormal;
    if (extension == ".stl") /* its stream form writes, and says that it did not */
        return OpenMesh::IO::write_mesh(mesh->mesh, name, options, 9);
    std::ofstream stream(path, std::ios::binary);
    bool written = OpenMesh::IO::write_mesh(mesh->mesh, stream, extension, options, 9);
    stream.flush();
    return written && stream.good();
}

void openmesh_destroy(openmesh_mesh *mesh)
{
    delete mesh;
}

uint32_t openmesh_vertices(const openmesh_mesh *mesh)
{
    return static_cast<uint32_t>(mesh->mesh.n_vertices());
}

uint32_t openmesh_triangles(const openmesh_mesh *mesh)
{
    return static_cast<uint32_t>(mesh->mesh.n_faces());
}

void openmesh_corners(const openmesh_mesh *mesh, uint32_t triangle, float *corners)
{
    auto face = mesh->mesh.face_handle(triangle);
    for (auto v = mesh->mesh.cfv_ccwbegin(face); v != mesh->mesh.cfv_ccwend(face); ++v)
        for (size_t k = 0; k < 3; k++)
            *corners++ = mesh->mesh.point(*v)[k];
}
