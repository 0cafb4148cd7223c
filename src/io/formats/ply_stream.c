/* SPDX-License-Identifier: MIT
 * Runs of a mesh to their places in a binary PLY: the header's length is known from the counts, and
 * vertices and faces are of fixed size.
 */
#include "io/stream_kind.h"
#include "io/writers.h"

typedef struct ply_stream {
    uint64_t vertices_at, faces_at; /* places in the file */
} ply_stream;

static bool is_binary(const csgm_write_options *options)
{
    return !options->ascii;
}

static csgm_status put_header(csg_stream_view *s)
{
    ply_stream *ply = s->state;
    csg_sink sink;
    csgm_status status = csg_ply_check(s->context, s->path, &s->mesh);
    if (status == CSGM_OK)
        status = csg_sink_open(&sink, s->context, s->fd, s->path);
    if (status != CSGM_OK)
        return status;
    csg_ply_put_header(&sink, &s->mesh, &s->options);
    ply->vertices_at = sink.length; /* far shorter than the sink's buffer */
    ply->faces_at = ply->vertices_at + s->mesh.vertex_count * csg_ply_vertex_bytes(&s->mesh);
    if (s->is_first)
        return csg_sink_close(&sink);
    csg_sink_discard(&sink);
    return CSGM_OK;
}

/* The run as a mesh of its own. */
static csgm_mesh_view mesh_of(const csg_stream_view *s, const csg_mesh_run *run)
{
    return (csgm_mesh_view){.origin = s->mesh.origin,
                            .positions = run->positions,
                            .normals = run->normals,
                            .colors = run->colors,
                            .indices = run->indices,
                            .vertex_count = run->vertex_count,
                            .triangle_count = run->triangle_count};
}

static bool put_run(csg_stream_view *s, const csg_mesh_run *run)
{
    const ply_stream *ply = s->state;
    csgm_mesh_view mesh = mesh_of(s, run);
    uint64_t stride = csg_ply_vertex_bytes(&s->mesh);
    uint64_t vertex_bytes = run->vertex_count * stride;
    uint64_t face_bytes = run->triangle_count * CSG_PLY_FACE_BYTES;
    uint8_t *bytes =
        csg_stream_room(s, run->worker, vertex_bytes > face_bytes ? vertex_bytes : face_bytes);
    if (!bytes)
        return false;
    csg_ply_pack_vertices(bytes, &mesh, 0, run->vertex_count);
    if (!csg_stream_write_at(s, bytes, vertex_bytes, ply->vertices_at + run->first_vertex * stride))
        return false;
    csg_ply_pack_faces(bytes, run->indices, run->triangle_count);
    return csg_stream_write_at(s, bytes, face_bytes,
                               ply->faces_at + run->first_triangle * CSG_PLY_FACE_BYTES);
}

const csg_stream_kind csg_ply_stream = {.state_bytes = sizeof(ply_stream),
                                        .is_possible = is_binary,
                                        .begin = put_header,
                                        .put = put_run};
