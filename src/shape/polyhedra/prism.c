/* SPDX-License-Identifier: MIT
 * See prism.h. Points below come first, those above follow in the same order.
 */
#include "shape/polyhedra/prism.h"

#include "shape/plane/delaunay.h"
#include "shape/plane/polygons.h"

static bool add_level(const csg_outline *outline, double z, csg_triangles *out)
{
    for (size_t i = 0; i < outline->point_count; i++) {
        csg_vec2 p = outline->points[i];
        if (!csg_triangles_add_point(out, csg_vec3_make(p.x, p.y, z)))
            return false;
    }
    return true;
}

static bool add_lids(const uint32_t *indices, size_t count, uint32_t above, csg_triangles *out)
{
    for (size_t i = 0; i + 2 < count; i += 3) {
        uint32_t a = indices[i], b = indices[i + 1], c = indices[i + 2];
        if (!csg_triangles_add(out, a, c, b) ||
            !csg_triangles_add(out, above + a, above + b, above + c))
            return false;
    }
    return true;
}

static bool add_walls(const csg_outline *outline, uint32_t above, csg_triangles *out)
{
    for (size_t loop = 0; loop < outline->loop_count; loop++) {
        uint32_t first = (uint32_t)csg_outline_first(outline, loop), end = outline->ends[loop];
        for (uint32_t i = first; i < end; i++) {
            uint32_t next = i + 1 < end ? i + 1 : first;
            if (!csg_triangles_add(out, i, next, above + next) ||
                !csg_triangles_add(out, i, above + next, above + i))
                return false;
        }
    }
    return true;
}

csgm_status csg_prism(csg_memory *memory, const csg_outline *outline, double low, double high,
                      csg_triangles *out)
{
    uint32_t *indices = NULL, above = (uint32_t)outline->point_count;
    size_t count = 0;
    csgm_status status = csg_polygons_triangulate(outline, memory, &indices, &count);
    if (status != CSGM_OK)
        return status;
    csg_triangles_init(out, memory);
    if (!csg_delaunay_improve(outline, memory, indices, count) || !add_level(outline, low, out) ||
        !add_level(outline, high, out) || !add_lids(indices, count, above, out) ||
        !add_walls(outline, above, out)) {
        csg_triangles_release(out);
        status = CSGM_ERR_MEMORY;
    }
    csg_memory_release(memory, indices, count * sizeof *indices);
    return status;
}
