/* SPDX-License-Identifier: MIT
 * Mesh -> STL: triangles with their own corners, binary (80 bytes of header that must not begin
 * with "solid", a count, 50 bytes per triangle) or ASCII. STL holds floats only, so what comes here
 * has no origin (rounding.h); it has no vertex normals and no colours. Written directly: OpenMesh
 * takes several times as long (README.md).
 */
#include <math.h>
#include <stdio.h>

#include "base/mesh_codes.h"
#include "io/writers.h"

typedef struct facet {
    float normal[3];
    float corner[3][3];
} facet;

/* Normal by the right-hand rule in double; zero for a triangle without area. */
static void face_normal(facet *f)
{
    double u[3], v[3];
    for (int k = 0; k < 3; k++) {
        u[k] = (double)f->corner[1][k] - (double)f->corner[0][k];
        v[k] = (double)f->corner[2][k] - (double)f->corner[0][k];
    }
    double n[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int k = 0; k < 3; k++)
        f->normal[k] = length > 0 && isfinite(length) ? (float)(n[k] / length) : 0;
}

static void load_facet(facet *f, const csgm_mesh_view *mesh, uint64_t triangle)
{
    for (int c = 0; c < 3; c++) {
        uint64_t vertex = mesh->indices[3 * triangle + (uint64_t)c];
        memcpy(f->corner[c], mesh->positions + 3 * vertex, sizeof f->corner[c]);
    }
    face_normal(f);
}

csgm_status csg_stl_check(csgm_context *context, const char *file, const csgm_mesh_view *mesh)
{
    if (mesh->triangle_count <= UINT32_MAX)
        return CSGM_OK;
    csg_diag_plain(&context->diags, CSG_DIAG_FORMAT_LIMIT, file, "write PLY instead",
                   "binary STL counts triangles up to 4294967295, the mesh has %llu",
                   (unsigned long long)mesh->triangle_count);
    return CSGM_ERR_UNSUPPORTED;
}

void csg_stl_pack_head(uint8_t head[CSG_STL_HEAD_BYTES], uint64_t triangle_count)
{
    memset(head, 0, CSG_STL_HEAD_BYTES);
    snprintf((char *)head, CSG_STL_HEAD_BYTES - 4, "%s binary STL", CSG_WRITTEN_BY);
    csg_store_u32(head + CSG_STL_HEAD_BYTES - 4, (uint32_t)triangle_count);
}

static uint8_t *pack_facet(uint8_t *at, const facet *f)
{
    for (int k = 0; k < 3; k++)
        at = csg_store_f32(at, f->normal[k]);
    for (int k = 0; k < 9; k++)
        at = csg_store_f32(at, f->corner[k / 3][k % 3]);
    return csg_store_u16(at, 0);
}

void csg_stl_pack_corners(uint8_t *at, const float *corners, uint64_t count)
{
    facet f;
    for (uint64_t i = 0; i < count; i++, corners += 9) {
        memcpy(f.corner, corners, sizeof f.corner);
        face_normal(&f);
        at = pack_facet(at, &f);
    }
}

static void put_binary(csg_sink *sink, const csgm_mesh_view *mesh)
{
    uint8_t head[CSG_STL_HEAD_BYTES];
    csg_stl_pack_head(head, mesh->triangle_count);
    csg_sink_put(sink, head, sizeof head);
    facet f;
    for (uint64_t i = 0; i < mesh->triangle_count; i++) {
        load_facet(&f, mesh, i);
        csg_sink_took(sink, pack_facet(csg_sink_room(sink, CSG_STL_FACET_BYTES), &f));
    }
}

static char *put_triple(char *at, const char *word, const float *value)
{
    size_t length = strlen(word);
    memcpy(at, word, length);
    at += length;
    for (int k = 0; k < 3; k++) {
        *at++ = ' ';
        at = csg_number_put_float(at, value[k]);
    }
    *at++ = '\n';
    return at;
}

static void put_ascii(csg_sink *sink, const csgm_mesh_view *mesh)
{
    facet f;
    csg_sink_text(sink, "solid csgmesh\n");
    for (uint64_t i = 0; i < mesh->triangle_count; i++) {
        load_facet(&f, mesh, i);
        char *at = (char *)csg_sink_room(sink, 1024);
        at = put_triple(at, "facet normal", f.normal);
        csg_sink_took(sink, at);
        csg_sink_text(sink, "outer loop\n");
        at = (char *)csg_sink_room(sink, 1024);
        for (int c = 0; c < 3; c++)
            at = put_triple(at, "vertex", f.corner[c]);
        csg_sink_took(sink, at);
        csg_sink_text(sink, "endloop\nendfacet\n");
    }
    csg_sink_text(sink, "endsolid csgmesh\n");
}

csgm_status csg_stl_write(csg_sink *sink, const csgm_mesh_view *mesh,
                          const csgm_write_options *options)
{
    csgm_status status = options->ascii ? CSGM_OK : csg_stl_check(sink->context, sink->name, mesh);
    if (status != CSGM_OK)
        return status;
    if (options->ascii)
        put_ascii(sink, mesh);
    else
        put_binary(sink, mesh);
    return CSGM_OK;
}
