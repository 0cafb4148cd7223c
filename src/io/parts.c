/* SPDX-License-Identifier: MIT
 * Parts of a mesh; see parts.h.
 */
#include "io/parts.h"

#include <string.h>

csg_part_stretch csg_part_get(const csgm_mesh_view *mesh, uint64_t index)
{
    csg_part_stretch out = {.vertex_count = mesh->vertex_count,
                            .triangle_count = mesh->triangle_count};
    if (!mesh->part_count)
        return out;
    const csgm_mesh_part *part = &mesh->parts[index];
    out.name = part->name;
    if (mesh->part_count == 1)
        return out;
    out.first_triangle = part->first_triangle;
    out.triangle_count = part->triangle_count;
    uint32_t low = UINT32_MAX, high = 0;
    const uint32_t *corners = mesh->indices + 3 * part->first_triangle;
    for (uint64_t i = 0; i < 3 * part->triangle_count; i++) {
        low = corners[i] < low ? corners[i] : low;
        high = corners[i] > high ? corners[i] : high;
    }
    out.first_vertex = part->triangle_count ? low : 0;
    out.vertex_count = part->triangle_count ? (uint64_t)high - low + 1 : 0;
    return out;
}

bool csg_part_has_one_material(const csgm_mesh_view *mesh, const csg_part_stretch *part,
                               uint16_t pair[2])
{
    pair[0] = CSG_MATERIAL_METALLIC;
    pair[1] = CSG_MATERIAL_ROUGHNESS;
    if (!mesh->materials || !part->vertex_count)
        return true;
    const uint16_t *at = mesh->materials + 2 * part->first_vertex;
    memcpy(pair, at, 2 * sizeof *at);
    for (uint64_t i = 1; i < part->vertex_count; i++)
        if (memcmp(at, at + 2 * i, 2 * sizeof *at) != 0)
            return false;
    return true;
}
