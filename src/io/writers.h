/* SPDX-License-Identifier: MIT
 * What every writer is, and what writers share. A writer gets a checked mesh (finite positions,
 * indices in range) and checked options, and puts bytes into a sink whose errors others report; it
 * fails only, with a diagnostic of its own, where the format cannot hold the mesh.
 */
#ifndef CSG_IO_WRITERS_H
#define CSG_IO_WRITERS_H

#include "io/formats/stl.h"
#include "io/sink.h"

/* The program and its version, as files name who made them. */
#define CSG_TEXT_OF(number) CSG_TEXT_OF_(number)
#define CSG_TEXT_OF_(number) #number
#define CSG_WRITTEN_BY                                                                             \
    "csgmesh " CSG_TEXT_OF(CSGM_VERSION_MAJOR) "." CSG_TEXT_OF(                                    \
        CSGM_VERSION_MINOR) "." CSG_TEXT_OF(CSGM_VERSION_PATCH)

typedef csgm_status csg_write_fn(csg_sink *sink, const csgm_mesh_view *mesh,
                                 const csgm_write_options *options);

/* One for each row of formats.def; those exist that the row says. */
#define CSG_FORMAT(ID, name, ...) csg_write_fn csg_##name##_write;
#include "io/formats.def"

/* Vertices and triangles as lines of numbers: ASCII PLY and OFF. */
void csg_put_text_mesh(csg_sink *sink, const csgm_mesh_view *mesh);

/* Binary PLY in pieces. The header looks at counts, the origin and which arrays there are. */
enum { CSG_PLY_FACE_BYTES = 1 + 3 * 4 };
csgm_status csg_ply_check(csgm_context *context, const char *file, const csgm_mesh_view *mesh);
void csg_ply_put_header(csg_sink *sink, const csgm_mesh_view *mesh,
                        const csgm_write_options *options);
size_t csg_ply_vertex_bytes(const csgm_mesh_view *mesh);
void csg_ply_pack_vertices(uint8_t *at, const csgm_mesh_view *mesh, uint64_t first, uint64_t count);
void csg_ply_pack_faces(uint8_t *at, const uint32_t *indices, uint64_t count);

/* Binary STL in pieces: 9 floats per triangle. */
csgm_status csg_stl_check(csgm_context *context, const char *file, const csgm_mesh_view *mesh);
void csg_stl_pack_head(uint8_t head[CSG_STL_HEAD_BYTES], uint64_t triangle_count);
void csg_stl_pack_corners(uint8_t *at, const float *corners, uint64_t count);

/* Reports why this mesh cannot be written in this format. */
csgm_status csg_write_refuse(csg_sink *sink, const char *hint, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Compresses the mesh with the colours of `colors` (its other fields are not looked at); reports
 * what goes wrong and what is lost. Release `out` when CSGM_OK. */
csgm_status csg_write_draco(csg_sink *sink, const csgm_mesh_view *mesh,
                            const csg_draco_mesh *colors, const csgm_write_options *options,
                            csg_draco_encoded *out);

/* True when positions need more than the floats of the mesh: formats that can, write doubles. */
static inline bool csg_view_is_offset(const csgm_mesh_view *mesh)
{
    return mesh->origin.x != 0 || mesh->origin.y != 0 || mesh->origin.z != 0;
}

static inline double csg_view_coordinate(const csgm_mesh_view *mesh, uint64_t vertex, int axis)
{
    const double *origin = &mesh->origin.x;
    return origin[axis] + (double)mesh->positions[3 * vertex + (uint64_t)axis];
}

/* The coordinate as text, as wide as it needs to be. Returns its end. */
static inline char *csg_put_coordinate(char *at, const csgm_mesh_view *mesh, uint64_t vertex,
                                       int axis, bool offset)
{
    return offset ? csg_number_put_double(at, csg_view_coordinate(mesh, vertex, axis))
                  : csg_number_put_float(at, mesh->positions[3 * vertex + (uint64_t)axis]);
}

#endif
