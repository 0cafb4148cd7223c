/* SPDX-License-Identifier: MIT
 * A mesh as lines of numbers, as ASCII PLY and OFF both have it: x y z [nx ny nz] [r g b a as
 * 0..255] for each vertex, then 3 and the vertices of each triangle.
 */
#include "io/writers.h"

static void put_vertices(csg_sink *sink, const csgm_mesh_view *mesh)
{
    bool offset = csg_view_is_offset(mesh);
    for (uint64_t i = 0; i < mesh->vertex_count; i++) {
        char *at = (char *)csg_sink_room(sink, 10 * (CSG_NUMBER_MOST + 1));
        for (int k = 0; k < 3; k++) {
            at = csg_put_coordinate(at, mesh, i, k, offset);
            *at++ = ' ';
        }
        for (uint64_t k = 0; mesh->normals && k < 3; k++) {
            at = csg_number_put_float(at, mesh->normals[3 * i + k]);
            *at++ = ' ';
        }
        for (uint64_t k = 0; mesh->colors && k < 4; k++) {
            at = csg_number_put_u64(at, mesh->colors[4 * i + k]);
            *at++ = ' ';
        }
        at[-1] = '\n';
        csg_sink_took(sink, at);
    }
}

static void put_faces(csg_sink *sink, const csgm_mesh_view *mesh)
{
    for (uint64_t i = 0; i < mesh->triangle_count; i++) {
        char *at = (char *)csg_sink_room(sink, 4 * (CSG_NUMBER_MOST + 1));
        *at++ = '3';
        for (uint64_t k = 0; k < 3; k++) {
            *at++ = ' ';
            at = csg_number_put_u64(at, mesh->indices[3 * i + k]);
        }
        *at++ = '\n';
        csg_sink_took(sink, at);
    }
}

void csg_put_text_mesh(csg_sink *sink, const csgm_mesh_view *mesh)
{
    put_vertices(sink, mesh);
    put_faces(sink, mesh);
}
