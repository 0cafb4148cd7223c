/* SPDX-License-Identifier: MIT
 * Runs of loose triangles to their places in a binary STL.
 */
#include "io/stream_kind.h"
#include "io/writers.h"

static bool is_binary(const csgm_write_options *options)
{
    return !options->ascii;
}

static csgm_status put_head(csg_stream_view *s)
{
    uint8_t head[CSG_STL_HEAD_BYTES];
    if (csg_view_is_offset(&s->mesh))
        return CSGM_ERR_INTERNAL; /* corners would be written without the mesh's origin */
    csgm_status status = csg_stl_check(s->context, s->path, &s->mesh);
    csg_stl_pack_head(head, s->mesh.triangle_count);
    if (status == CSGM_OK && s->is_first)
        csg_stream_write_at(s, head, sizeof head, 0);
    return status;
}

static bool put_run(csg_stream_view *s, const csg_mesh_run *run)
{
    uint64_t count = run->triangle_count * CSG_STL_FACET_BYTES;
    uint8_t *bytes = csg_stream_room(s, run->worker, count);
    if (!bytes)
        return false;
    csg_stl_pack_corners(bytes, run->corners, run->triangle_count);
    return csg_stream_write_at(s, bytes, count,
                               CSG_STL_HEAD_BYTES + run->first_triangle * CSG_STL_FACET_BYTES);
}

const csg_stream_kind csg_stl_stream = {
    .wants_corners = true, .is_possible = is_binary, .begin = put_head, .put = put_run};
