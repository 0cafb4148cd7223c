/* SPDX-License-Identifier: MIT
 * The only file that names meshoptimizer: order of triangles and vertices, and its codecs, which
 * are those of EXT_meshopt_compression. What KHR_meshopt_compression has beyond them is ours
 * (vertex_stream.h).
 */
#include <meshoptimizer.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>

#include "io/adapter.h"
#include "io/gltf/vertex_stream.h"

bool csg_meshopt_available(void)
{
    return true;
}

/* Those that the extension has; later libraries have others for their defaults. */
static void choose_versions(void)
{
    meshopt_encodeVertexVersion(0);
    meshopt_encodeIndexVersion(1);
}

static pthread_once_t versions_once = PTHREAD_ONCE_INIT;

uint32_t csg_meshopt_order(uint32_t *indices, uint64_t index_count, uint64_t vertex_count,
                           uint32_t *to)
{
    meshopt_optimizeVertexCacheStrip(indices, indices, index_count, vertex_count);
    size_t used = meshopt_optimizeVertexFetchRemap(to, indices, index_count, vertex_count);
    meshopt_remapIndexBuffer(indices, indices, index_count, to);
    return (uint32_t)used;
}

uint64_t csg_meshopt_bound(csg_meshopt_mode mode, uint64_t count, uint64_t stride, uint64_t beyond)
{
    if (mode == CSG_MESHOPT_ATTRIBUTES)
        return meshopt_encodeVertexBufferBound(count, stride);
    return mode == CSG_MESHOPT_TRIANGLES ? meshopt_encodeIndexBufferBound(count, beyond)
                                         : meshopt_encodeIndexSequenceBound(count, beyond);
}

uint64_t csg_meshopt_encode(csg_meshopt_mode mode, const void *data, uint64_t count,
                            uint64_t stride, uint8_t *out, uint64_t room)
{
    pthread_once(&versions_once, choose_versions);
    if (mode == CSG_MESHOPT_ATTRIBUTES)
        return meshopt_encodeVertexBuffer(out, room, data, count, stride);
    return mode == CSG_MESHOPT_TRIANGLES ? meshopt_encodeIndexBuffer(out, room, data, count)
                                         : meshopt_encodeIndexSequence(out, room, data, count);
}

void csg_meshopt_pack_normals(int8_t *out, const float *normals, uint64_t count, int bits)
{
    meshopt_encodeFilterOct(out, count, 4, bits, normals);
}

bool csg_meshopt_decode(const csg_meshopt_view *view, void *out)
{
    int failed = 1;
    if (view->mode == CSG_MESHOPT_ATTRIBUTES && csg_vertex_stream_is_one(view->bytes, view->size))
        failed = !csg_vertex_stream_decode(view->bytes, view->size, view->count, view->stride, out);
    else if (view->mode == CSG_MESHOPT_ATTRIBUTES)
        failed =
            meshopt_decodeVertexBuffer(out, view->count, view->stride, view->bytes, view->size);
    else if (view->mode == CSG_MESHOPT_TRIANGLES)
        failed = meshopt_decodeIndexBuffer(out, view->count, view->stride, view->bytes, view->size);
    else
        failed =
            meshopt_decodeIndexSequence(out, view->count, view->stride, view->bytes, view->size);
    if (failed)
        return false;
    if (view->filter == CSG_MESHOPT_OCTAHEDRAL)
        meshopt_decodeFilterOct(out, view->count, view->stride);
    else if (view->filter == CSG_MESHOPT_QUATERNION)
        meshopt_decodeFilterQuat(out, view->count, view->stride);
    else if (view->filter == CSG_MESHOPT_EXPONENTIAL)
        meshopt_decodeFilterExp(out, view->count, view->stride);
    else if (view->filter == CSG_MESHOPT_COLOR)
        csg_color_filter_decode(out, view->count, view->stride);
    return true;
}
