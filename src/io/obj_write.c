/* SPDX-License-Identifier: MIT
 * Mesh -> Wavefront OBJ: v (with r g b in 0..1 appended, a common extension, only when the mesh has
 * colours), vn, "o name" before the faces of a part, and f with vertex and normal of the same
 * number. Numbers are the shortest that read back as the same float. Written directly: OpenMesh
 * takes several times as long (README.md).
 */
#include "io/writers.h"

static void put_vertices(csg_sink *sink, const csgm_mesh_view *mesh)
{
    bool offset = csg_view_is_offset(mesh);
    for (uint64_t i = 0; i < mesh->vertex_count; i++) {
        char *at = (char *)csg_sink_room(sink, 2 + 6 * (CSG_NUMBER_MOST + 1));
        *at++ = 'v';
        for (int k = 0; k < 3; k++) {
            *at++ = ' ';
            at = csg_put_coordinate(at, mesh, i, k, offset);
        }
        for (uint64_t k = 0; mesh->colors && k < 3; k++) {
            *at++ = ' ';
            at = csg_number_put_float(at, (float)mesh->colors[4 * i + k] / 255.0f);
        }
        *at++ = '\n';
        csg_sink_took(sink, at);
    }
}

static void put_normals(csg_sink *sink, const csgm_mesh_view *mesh)
{
    for (uint64_t i = 0; i < mesh->vertex_count; i++) {
        char *at = (char *)csg_sink_room(sink, 3 + 3 * (CSG_NUMBER_MOST + 1));
        *at++ = 'v';
        *at++ = 'n';
        for (uint64_t k = 0; k < 3; k++) {
            *at++ = ' ';
            at = csg_number_put_float(at, mesh->normals[3 * i + k]);
        }
        *at++ = '\n';
        csg_sink_took(sink, at);
    }
}

/* A name ends with its line; control characters become spaces. The first part needs no line where
 * it has no name. */
static void put_part_name(csg_sink *sink, const csgm_mesh_view *mesh, uint64_t index)
{
    const char *name = mesh->parts[index].name;
    if (!name || !*name) {
        if (index)
            csg_sink_format(sink, "o part%llu\n", (unsigned long long)index + 1);
        return;
    }
    csg_sink_text(sink, "o ");
    for (; *name; name++) {
        char plain = (unsigned char)*name < ' ' ? ' ' : *name;
        csg_sink_put(sink, &plain, 1);
    }
    csg_sink_text(sink, "\n");
}

static void put_faces(csg_sink *sink, const csgm_mesh_view *mesh, uint64_t first, uint64_t count)
{
    for (uint64_t i = first; i < first + count; i++) {
        char *at = (char *)csg_sink_room(sink, 2 + 6 * (CSG_NUMBER_MOST + 2));
        *at++ = 'f';
        for (uint64_t k = 0; k < 3; k++) {
            *at++ = ' ';
            char *number = at;
            at = csg_number_put_u64(at, (uint64_t)mesh->indices[3 * i + k] + 1);
            size_t length = (size_t)(at - number);
            if (!mesh->normals)
                continue;
            *at++ = '/';
            *at++ = '/';
            memcpy(at, number, length);
            at += length;
        }
        *at++ = '\n';
        csg_sink_took(sink, at);
    }
}

csgm_status csg_obj_write(csg_sink *sink, const csgm_mesh_view *mesh,
                          const csgm_write_options *options)
{
    (void)options; /* OBJ is text, Z up as the scene, without units */
    csg_sink_format(sink, "# %s\n", CSG_WRITTEN_BY);
    put_vertices(sink, mesh);
    if (mesh->normals)
        put_normals(sink, mesh);
    if (!mesh->part_count)
        put_faces(sink, mesh, 0, mesh->triangle_count);
    for (uint64_t i = 0; i < mesh->part_count; i++) {
        put_part_name(sink, mesh, i);
        put_faces(sink, mesh, mesh->parts[i].first_triangle, mesh->parts[i].triangle_count);
    }
    return CSGM_OK;
}
