/* SPDX-License-Identifier: MIT
 * Mesh -> OFF (Geomview): [C][N]OFF, counts, then x y z [nx ny nz] [r g b a as 0..255], then faces.
 * Written directly: OpenMesh would drop faces at edges of more than two, and takes longer.
 */
#include "io/writers.h"

csgm_status csg_off_write(csg_sink *sink, const csgm_mesh_view *mesh,
                          const csgm_write_options *options)
{
    (void)options; /* OFF is text, Z up as the scene, without units */
    /* no comment that says who wrote it: OpenMesh's reader then finds no triangles */
    csg_sink_format(sink, "%s%sOFF\n%llu %llu 0\n", mesh->colors ? "C" : "",
                    mesh->normals ? "N" : "", (unsigned long long)mesh->vertex_count,
                    (unsigned long long)mesh->triangle_count);
    csg_put_text_mesh(sink, mesh);
    return CSGM_OK;
}
