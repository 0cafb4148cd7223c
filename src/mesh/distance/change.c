/* SPDX-License-Identifier: MIT
 * Two sorted lists of triangles; see change.h.
 */
#include "mesh/distance/change.h"

#include <stdlib.h>
#include <string.h>

/* As floats, which the arrays of a mesh are: triangles are the same when their bytes are. */
typedef struct csg_written_triangle {
    float at[3][3];
} written;

static int compare_written(const void *a, const void *b)
{
    return memcmp(a, b, sizeof(written));
}

bool csg_written_triangles_list(const csg_remesh *r, csg_written_triangles *out)
{
    const csg_corners *m = &r->corners;
    size_t n = 0;
    *out = (csg_written_triangles){.count = m->live};
    out->items = csg_memory_alloc(r->memory, out->count * sizeof *out->items);
    if (!out->items)
        return false;
    for (uint32_t t = 0; t < m->triangle_count; t++) {
        if (!csg_corners_is_live(m, t))
            continue;
        for (uint32_t k = 0; k < 3; k++)
            csg_vec3_to_floats(out->items[n].at[k],
                               csg_vec3_add(csg_remesh_corner(r, 3 * t + k), r->marching->shift));
        n++;
    }
    qsort(out->items, n, sizeof *out->items, compare_written);
    return true;
}

void csg_written_triangles_release(csg_written_triangles *triangles, csg_memory *memory)
{
    csg_memory_release(memory, triangles->items, triangles->count * sizeof *triangles->items);
    *triangles = (csg_written_triangles){0};
}

static csg_box box_of(const csg_remesh *r, const written *triangle)
{
    csg_box box = csg_box_empty();
    for (int k = 0; k < 3; k++)
        csg_box_extend(&box,
                       csg_vec3_sub(csg_vec3_from_floats(triangle->at[k]), r->marching->shift));
    return box;
}

bool csg_changed_boxes_find(const csg_remesh *r, const csg_written_triangles *before,
                            const csg_written_triangles *now, csg_changed_boxes *out)
{
    size_t i = 0, k = 0;
    *out = (csg_changed_boxes){0};
    while (i < before->count || k < now->count) {
        const written *old = i < before->count ? &before->items[i] : NULL;
        const written *new = k < now->count ? &now->items[k] : NULL;
        int order = !old ? 1 : !new ? -1 : compare_written(old, new);
        i += order <= 0;
        k += order >= 0;
        if (!order)
            continue;
        if (!csg_memory_reserve(r->memory, (void **)&out->items, &out->capacity, out->count + 1,
                                sizeof *out->items))
            return false;
        out->items[out->count++] = box_of(r, order < 0 ? old : new);
    }
    return true;
}

static bool comes_near(const csg_box *box, csg_vec3 c, double by)
{
    return box->min.x <= c.x + by && box->max.x >= c.x - by && box->min.y <= c.y + by &&
           box->max.y >= c.y - by && box->min.z <= c.z + by && box->max.z >= c.z - by;
}

bool csg_changed_boxes_select(const csg_changed_boxes *boxes, csg_vec3 middle, double half,
                              double reach, csg_memory *memory, csg_changed_boxes *out)
{
    out->count = 0;
    for (size_t i = 0; i < boxes->count; i++) {
        if (!comes_near(&boxes->items[i], middle, half + reach))
            continue;
        if (!csg_memory_reserve(memory, (void **)&out->items, &out->capacity, out->count + 1,
                                sizeof *out->items))
            return false;
        out->items[out->count++] = boxes->items[i];
    }
    return true;
}

bool csg_changed_boxes_come_near(const csg_changed_boxes *boxes, csg_vec3 middle, double half,
                                 double reach)
{
    for (size_t i = 0; i < boxes->count; i++)
        if (comes_near(&boxes->items[i], middle, half + reach))
            return true;
    return false;
}

void csg_changed_boxes_release(csg_changed_boxes *boxes, csg_memory *memory)
{
    csg_memory_release(memory, boxes->items, boxes->capacity * sizeof *boxes->items);
    *boxes = (csg_changed_boxes){0};
}
