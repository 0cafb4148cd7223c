/* SPDX-License-Identifier: MIT
 * The field is asked at each vertex; see paint.h.
 */
#include "mesh/pipeline/paint.h"

#include "mesh/remesh/probe.h"

csgm_status csg_mesh_paint(const csg_mesh_input *input, const csg_marching *marching,
                           csgm_mesh *mesh)
{
    csgm_status status = csg_mesh_gets_materials(input) ? csg_mesh_add_materials(mesh) : CSGM_OK;
    if (status != CSGM_OK || (!mesh->colors && !mesh->materials))
        return status;
    csg_probe probe;
    if (!csg_probe_make(&probe, marching, &input->context->memory))
        return csg_context_no_memory(input->context);
    float at[CSG_PROBE_MOST][3];
    for (uint64_t first = 0; first < mesh->vertex_count; first += CSG_PROBE_MOST) {
        size_t count = (size_t)(mesh->vertex_count - first);
        count = count < CSG_PROBE_MOST ? count : CSG_PROBE_MOST;
        for (size_t i = 0; i < count; i++)
            csg_vec3_to_floats(at[i],
                               csg_vec3_sub(csg_vec3_from_floats(mesh->positions + 3 * (first + i)),
                                            marching->shift));
        csg_probe_looks(&probe, (const float(*)[3])at, count,
                        mesh->colors ? (uint8_t(*)[4])(mesh->colors + 4 * first) : NULL,
                        mesh->materials ? (uint16_t(*)[2])(mesh->materials + 2 * first) : NULL);
    }
    csg_probe_release(&probe);
    return CSGM_OK;
}
