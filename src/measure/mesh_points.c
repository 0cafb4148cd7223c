/* SPDX-License-Identifier: MIT
 * Vertices of triangles; see mesh_points.h.
 */
#include "measure/mesh_points.h"

#include <math.h>
#include <string.h>

#include "measure/measure.h"

static csgm_status mark_used(csgm_context *context, const csgm_mesh_view *mesh, uint8_t *used)
{
    memset(used, 0, (size_t)mesh->vertex_count);
    for (uint64_t i = 0; i < 3 * mesh->triangle_count; i++) {
        if (mesh->indices[i] >= mesh->vertex_count)
            return csg_measure_refuse_broken(context);
        used[mesh->indices[i]] = 1;
    }
    return CSGM_OK;
}

csgm_status csg_mesh_points_gather(csg_mesh_points *p, csgm_context *context,
                                   const csgm_mesh_view *mesh)
{
    csg_memory *memory = &context->memory;
    size_t flags = (size_t)mesh->vertex_count + 1;
    uint8_t *used = csg_memory_alloc(memory, flags);
    csg_box box = csg_box_empty();
    *p = (csg_mesh_points){.bytes = ((size_t)mesh->vertex_count + 1) * sizeof *p->items};
    p->items = csg_memory_alloc(memory, p->bytes);
    csgm_status status =
        used && p->items ? mark_used(context, mesh, used) : csg_context_no_memory(context);
    for (size_t v = 0; v < mesh->vertex_count && status == CSGM_OK; v++) {
        if (!used[v])
            continue;
        csg_vec3 at = csg_vec3_from_floats(mesh->positions + 3 * v);
        if (!isfinite(at.x + at.y + at.z))
            status = csg_measure_refuse_broken(context);
        p->items[p->count++] = at;
        box = csg_box_hull(box, (csg_box){at, at});
    }
    p->origin = csg_box_center(box);
    for (size_t i = 0; i < p->count && status == CSGM_OK; i++) {
        p->items[i] = csg_vec3_sub(p->items[i], p->origin);
        p->size = fmax(p->size, 2 * csg_vec3_norm(p->items[i]));
    }
    csg_memory_release(memory, used, flags);
    return status;
}

void csg_mesh_points_release(csg_mesh_points *p, csgm_context *context)
{
    csg_memory_release(&context->memory, p->items, p->bytes);
    p->items = NULL;
}
