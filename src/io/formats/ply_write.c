/* SPDX-License-Identifier: MIT
 * Mesh -> PLY (Turk 1994), binary little endian or ASCII: x y z [nx ny nz] [red green blue alpha],
 * then faces as lists of three. Coordinates are float, or double when the mesh has an origin.
 * Written directly: OpenMesh takes several times as long (README.md).
 */
#include "base/mesh_codes.h"
#include "io/writers.h"

/* A comment ends where its line does. */
static void put_comment(csg_sink *sink, const char *comment)
{
    char line[256];
    size_t length = 0;
    for (; comment[length] && length + 1 < sizeof line; length++)
        line[length] = (unsigned char)comment[length] < ' ' ? ' ' : comment[length];
    line[length] = 0;
    csg_sink_format(sink, "comment %s\n", line);
}

void csg_ply_put_header(csg_sink *sink, const csgm_mesh_view *mesh,
                        const csgm_write_options *options)
{
    const char *real = csg_view_is_offset(mesh) ? "double" : "float";
    csg_sink_format(sink, "ply\nformat %s 1.0\ncomment %s\n",
                    options->ascii ? "ascii" : "binary_little_endian", CSG_WRITTEN_BY);
    if (options->comment)
        put_comment(sink, options->comment);
    csg_sink_format(sink, "element vertex %llu\n", (unsigned long long)mesh->vertex_count);
    csg_sink_format(sink, "property %s x\nproperty %s y\nproperty %s z\n", real, real, real);
    if (mesh->normals)
        csg_sink_text(sink, "property float nx\nproperty float ny\nproperty float nz\n");
    if (mesh->colors)
        csg_sink_text(sink, "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                            "property uchar alpha\n");
    csg_sink_format(sink, "element face %llu\nproperty list uchar int vertex_indices\nend_header\n",
                    (unsigned long long)mesh->triangle_count);
}

/* ---- binary ----------------------------------------------------------------------- */

size_t csg_ply_vertex_bytes(const csgm_mesh_view *mesh)
{
    return (csg_view_is_offset(mesh) ? 24u : 12u) + (mesh->normals ? 12u : 0u) +
           (mesh->colors ? 4u : 0u);
}

void csg_ply_pack_vertices(uint8_t *at, const csgm_mesh_view *mesh, uint64_t first, uint64_t count)
{
    bool offset = csg_view_is_offset(mesh);
    for (uint64_t i = first; i < first + count; i++) {
        for (int k = 0; k < 3; k++)
            at = offset ? csg_store_f64(at, csg_view_coordinate(mesh, i, k))
                        : csg_store_f32(at, mesh->positions[3 * i + (uint64_t)k]);
        for (uint64_t k = 0; mesh->normals && k < 3; k++)
            at = csg_store_f32(at, mesh->normals[3 * i + k]);
        if (mesh->colors) {
            memcpy(at, mesh->colors + 4 * i, 4);
            at += 4;
        }
    }
}

void csg_ply_pack_faces(uint8_t *at, const uint32_t *indices, uint64_t count)
{
    for (uint64_t i = 0; i < count; i++, indices += 3) {
        *at++ = 3;
        for (int k = 0; k < 3; k++)
            at = csg_store_u32(at, indices[k]);
    }
}

static void put_binary(csg_sink *sink, const csgm_mesh_view *mesh)
{
    enum { CHUNK = 256 };
    size_t stride = csg_ply_vertex_bytes(mesh);
    for (uint64_t i = 0; i < mesh->vertex_count; i += CHUNK) {
        uint64_t count = mesh->vertex_count - i < CHUNK ? mesh->vertex_count - i : CHUNK;
        uint8_t *at = csg_sink_room(sink, CHUNK * stride);
        csg_ply_pack_vertices(at, mesh, i, count);
        csg_sink_took(sink, at + count * stride);
    }
    for (uint64_t i = 0; i < mesh->triangle_count; i += CHUNK) {
        uint64_t count = mesh->triangle_count - i < CHUNK ? mesh->triangle_count - i : CHUNK;
        uint8_t *at = csg_sink_room(sink, CHUNK * CSG_PLY_FACE_BYTES);
        csg_ply_pack_faces(at, mesh->indices + 3 * i, count);
        csg_sink_took(sink, at + count * CSG_PLY_FACE_BYTES);
    }
}

csgm_status csg_ply_check(csgm_context *context, const char *file, const csgm_mesh_view *mesh)
{
    if (mesh->vertex_count <= INT32_MAX)
        return CSGM_OK;
    csg_diag_plain(&context->diags, CSG_DIAG_FORMAT_LIMIT, file,
                   "mesh more coarsely, or write OBJ instead",
                   "PLY counts vertices up to 2147483647, the mesh has %llu",
                   (unsigned long long)mesh->vertex_count);
    return CSGM_ERR_UNSUPPORTED;
}

csgm_status csg_ply_write(csg_sink *sink, const csgm_mesh_view *mesh,
                          const csgm_write_options *options)
{
    csgm_status status = csg_ply_check(sink->context, sink->name, mesh);
    if (status != CSGM_OK)
        return status;
    csg_ply_put_header(sink, mesh, options);
    if (options->ascii) {
        csg_put_text_mesh(sink, mesh);
    } else {
        put_binary(sink, mesh);
    }
    return CSGM_OK;
}
