/* SPDX-License-Identifier: MIT
 * Mesh -> PLY (Turk 1994), binary little endian or ASCII: x y z [nx ny nz] [red green blue alpha],
 * then faces as lists of three. Coordinates are float, or double when the mesh has an origin.
 * Written directly: OpenMesh takes seven times as long for the same bytes.
 */
#include "io/writers.h"

static void put_header(csg_sink *sink, const csgm_mesh_view *mesh, bool ascii)
{
    const char *real = csg_view_is_offset(mesh) ? "double" : "float";
    csg_sink_format(sink, "ply\nformat %s 1.0\ncomment %s\nelement vertex %llu\n",
                    ascii ? "ascii" : "binary_little_endian", CSG_WRITTEN_BY,
                    (unsigned long long)mesh->vertex_count);
    csg_sink_format(sink, "property %s x\nproperty %s y\nproperty %s z\n", real, real, real);
    if (mesh->normals)
        csg_sink_text(sink, "property float nx\nproperty float ny\nproperty float nz\n");
    if (mesh->colors)
        csg_sink_text(sink, "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                            "property uchar alpha\n");
    csg_sink_format(sink, "element face %llu\nproperty list uchar int vertex_indices\nend_header\n",
                    (unsigned long long)mesh->triangle_count);
}

/* ---- binary -------------------------------------------------------------------------------- */

static void put_binary_vertices(csg_sink *sink, const csgm_mesh_view *mesh)
{
    enum { VERTEX_MOST = 3 * 8 + 3 * 4 + 4 };
    bool offset = csg_view_is_offset(mesh);
    const float *position = mesh->positions, *normal = mesh->normals;
    const uint8_t *color = mesh->colors;
    for (uint64_t i = 0; i < mesh->vertex_count; i++, position += 3) {
        uint8_t *at = csg_sink_room(sink, VERTEX_MOST);
        for (int k = 0; k < 3; k++)
            at = offset ? csg_store_f64(at, csg_view_coordinate(mesh, i, k))
                        : csg_store_f32(at, position[k]);
        for (int k = 0; normal && k < 3; k++)
            at = csg_store_f32(at, normal[3 * i + (uint64_t)k]);
        if (color) {
            memcpy(at, color + 4 * i, 4);
            at += 4;
        }
        csg_sink_took(sink, at);
    }
}

static void put_binary_faces(csg_sink *sink, const csgm_mesh_view *mesh)
{
    const uint32_t *corner = mesh->indices;
    for (uint64_t i = 0; i < mesh->triangle_count; i++, corner += 3) {
        uint8_t *at = csg_sink_room(sink, 1 + 3 * 4);
        *at++ = 3;
        for (int k = 0; k < 3; k++)
            at = csg_store_u32(at, corner[k]);
        csg_sink_took(sink, at);
    }
}

/* ---- ASCII --------------------------------------------------------------------------------- */

static void put_ascii_vertices(csg_sink *sink, const csgm_mesh_view *mesh)
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

static void put_ascii_faces(csg_sink *sink, const csgm_mesh_view *mesh)
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

csgm_status csg_ply_write(csg_sink *sink, const csgm_mesh_view *mesh,
                          const csgm_write_options *options)
{
    if (mesh->vertex_count > INT32_MAX)
        return csg_write_refuse(sink, "lower the resolution",
                                "PLY counts vertices up to 2147483647, the mesh has %llu",
                                (unsigned long long)mesh->vertex_count);
    put_header(sink, mesh, options->ascii);
    if (options->ascii) {
        put_ascii_vertices(sink, mesh);
        put_ascii_faces(sink, mesh);
    } else {
        put_binary_vertices(sink, mesh);
        put_binary_faces(sink, mesh);
    }
    return CSGM_OK;
}
