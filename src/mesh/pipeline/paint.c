/* SPDX-License-Identifier: MIT
 * The field is asked at each vertex; see paint.h.
 */
#include "mesh/pipeline/paint.h"

#include "mesh/remesh/probe_loop.h"

typedef struct painting {
    csgm_mesh *mesh;
    csg_vec3 shift;
} painting;

static void paint_some(void *user, csg_probe *probe, size_t first, size_t end)
{
    const painting *p = user;
    csgm_mesh *mesh = p->mesh;
    float at[CSG_PROBE_MOST][3];
    for (size_t i = first; i < end; i++)
        csg_vec3_to_floats(at[i - first],
                           csg_vec3_sub(csg_vec3_from_floats(mesh->positions + 3 * i), p->shift));
    csg_probe_looks(probe, (const float(*)[3])at, end - first,
                    mesh->colors ? (uint8_t(*)[4])(mesh->colors + 4 * first) : NULL,
                    mesh->materials ? (uint16_t(*)[2])(mesh->materials + 2 * first) : NULL);
}

csgm_status csg_mesh_paint(const csg_mesh_input *input, const csg_marching *marching,
                           csg_mesh_watch *watch, csgm_mesh *mesh)
{
    csgm_status status = csg_mesh_gets_materials(input) ? csg_mesh_add_materials(mesh) : CSGM_OK;
    if (status != CSGM_OK || (!mesh->colors && !mesh->materials))
        return status;
    painting p = {mesh, marching->shift};
    return csg_probe_loop(watch, marching, mesh->vertex_count, CSG_PROBE_MOST, paint_some, &p)
               ? CSGM_OK
               : csg_mesh_why_stopped(watch);
}
