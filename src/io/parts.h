/* SPDX-License-Identifier: MIT
 * The parts of a mesh as writers see them: with the stretch of vertices that their triangles use.
 */
#ifndef CSG_IO_PARTS_H
#define CSG_IO_PARTS_H

#include "csgmesh/csgmesh.h"

typedef struct csg_part_stretch {
    const char *name; /* NULL = without */
    uint64_t first_vertex, vertex_count, first_triangle, triangle_count;
} csg_part_stretch;

/* At least 1. */
static inline uint64_t csg_part_count(const csgm_mesh_view *mesh)
{
    return mesh->part_count ? mesh->part_count : 1;
}

/* Looks at the part's indices. The only part of a mesh has all vertices, used or not. */
csg_part_stretch csg_part_get(const csgm_mesh_view *mesh, uint64_t index);

/* True when one pair of metallic and roughness, stored in `pair`, holds for all these vertices. */
bool csg_part_has_one_material(const csgm_mesh_view *mesh, const csg_part_stretch *part,
                               uint16_t pair[2]);

/* What a vertex of a mesh without materials has, and what 1 is. */
enum { CSG_MATERIAL_METALLIC = 0, CSG_MATERIAL_ROUGHNESS = 6000, CSG_MATERIAL_ONE = 10000 };

#endif
