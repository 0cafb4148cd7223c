/* SPDX-License-Identifier: MIT
 * Mesh -> OFF (Geomview): [C][N]OFF, counts, then x y z [nx ny nz] [r g b a as 0..255], then faces.
 * Written directly: OpenMesh would drop faces at edges of more than two, and takes longer.
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

csgm_status csg_off_write(csg_sink *sink, const csgm_mesh_view *mesh,
                          const csgm_write_options *options)
{
    (void)options; /* OFF is text, Z up as the scene, without units */
    /* no comment that says who wrote it: OpenMesh's reader then finds no triangles */
    csg_sink_format(sink, "%s%sOFF\n%llu %llu 0\n", mesh->colors ? "C" : "",
                    mesh->normals ? "N" : "", (unsigned long long)mesh->vertex_count,
                    (unsigned long long)mesh->triangle_count);
    put_vertices(sink, mesh);
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
    return CSGM_OK;
}
