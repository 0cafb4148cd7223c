/* SPDX-License-Identifier: MIT
 * Runs are copied to their places, which are known from the counts; see collect.h.
 */
#include "mesh/collect.h"

#include <string.h>

static csgm_status create_mesh(void *user, const csg_mesh_counts *counts)
{
    csg_mesh_collector *c = user;
    csgm_status status = csg_mesh_create(c->context, counts->vertex_count, counts->triangle_count,
                                         counts->normals, counts->colors, &c->mesh);
    if (status != CSGM_OK)
        return status;
    c->mesh->origin = counts->origin;
    c->mesh->split = counts->split;
    c->mesh->equal_cells = true;
    return CSGM_OK;
}

static bool copy_run(void *user, const csg_mesh_run *run)
{
    csgm_mesh *mesh = ((csg_mesh_collector *)user)->mesh;
    size_t v = (size_t)run->first_vertex, vertices = (size_t)run->vertex_count;
    size_t t = (size_t)run->first_triangle, triangles = (size_t)run->triangle_count;
    if (vertices) {
        memcpy(mesh->positions + 3 * v, run->positions, 3 * vertices * sizeof(float));
        if (mesh->normals)
            memcpy(mesh->normals + 3 * v, run->normals, 3 * vertices * sizeof(float));
        if (mesh->colors)
            memcpy(mesh->colors + 4 * v, run->colors, 4 * vertices);
    }
    if (triangles)
        memcpy(mesh->indices + 3 * t, run->indices, 3 * triangles * sizeof(uint32_t));
    return true;
}

csg_mesh_receiver csg_mesh_collector_receiver(csg_mesh_collector *collector)
{
    return (csg_mesh_receiver){.user = collector, .begin = create_mesh, .put = copy_run};
}
