/* SPDX-License-Identifier: MIT
 * No point of a box is farther from the surface than its middle and half the diagonal, so what lies
 * farther from the box is nearest to none of its points. Any triangle gives a bound for the middle,
 * and one that is not far a good one. Points whose list would be long are searched in halves.
 */
#include "shape/polyhedra/packet.h"

#include <string.h>

enum {
    FEWEST = 4,    /* points for which a list pays */
    PER_POINT = 8, /* leaves: more of them do not pay */
    WAITING = 64   /* halvings of a count */
};

typedef struct parts {
    const csg_tree *tree;
    const uint32_t *items; /* NULL: the whole tree */
    uint32_t count;
} parts;

static csg_triangle_hit search_one(const parts *p, csg_vec3 at, uint32_t *hint)
{
    csg_triangle_hit hit;
    if (p->items)
        hit = csg_tree_nearest_of(p->tree, p->items, p->count, at, *hint);
    else
        hit = csg_tree_nearest(p->tree, at, *hint == CSG_TREE_NO_HINT ? 0 : *hint);
    *hint = hit.place;
    return hit;
}

static csg_box box_around(const csg_vec3 *at, size_t count)
{
    csg_box box = {at[0], at[0]};
    for (size_t i = 1; i < count; i++) {
        csg_vec3 p = at[i];
        box.min.x = p.x < box.min.x ? p.x : box.min.x;
        box.min.y = p.y < box.min.y ? p.y : box.min.y;
        box.min.z = p.z < box.min.z ? p.z : box.min.z;
        box.max.x = p.x > box.max.x ? p.x : box.max.x;
        box.max.y = p.y > box.max.y ? p.y : box.max.y;
        box.max.z = p.z > box.max.z ? p.z : box.max.z;
    }
    return box;
}

/* False: there are too many. *hint becomes a triangle that is not far from the points. */
static bool gather_leaves(const parts *p, const csg_vec3 *at, size_t count, uint32_t *hint,
                          csg_tree_leaves *out)
{
    /* more than the rounding of what is added, in units of the frame */
    static const double RELATIVE = 0x1p-30, ABSOLUTE = 0x1p-36;
    static const uint32_t ROOT = 0;
    const uint32_t *items = p->items ? p->items : &ROOT;
    uint32_t item_count = p->items ? p->count : 1;
    csg_box box = box_around(at, count);
    csg_vec3 center = csg_box_center(box);
    csg_vec3 half = csg_vec3_scale(csg_vec3_sub(box.max, box.min), 0.5);
    csg_triangle_hit near = csg_tree_some_near(p->tree, items, item_count, center);
    double reach = (sqrt(near.squared) + csg_vec3_norm(half)) * (1 + RELATIVE) + ABSOLUTE;
    size_t most = count * PER_POINT;
    most = most < CSG_TREE_MOST_LEAVES ? most : CSG_TREE_MOST_LEAVES;
    *hint = near.place;
    return csg_tree_gather(p->tree, items, item_count, center, half, reach, (uint32_t)most, out);
}

/* The last point is in the lanes that are left over. */
static void search_lanes(const csg_tree *tree, const csg_shape_kernel *kernel,
                         const csg_tree_leaves *leaves, const csg_vec3 *at, size_t count,
                         uint32_t *hint, csg_triangle_hit *out)
{
    csg_vec3 points[CSG_SHAPE_LANES];
    csg_triangle_hit hits[CSG_SHAPE_LANES];
    for (size_t i = 0; i < count; i += CSG_SHAPE_LANES) {
        size_t used = count - i < CSG_SHAPE_LANES ? count - i : CSG_SHAPE_LANES;
        for (size_t l = 0; l < CSG_SHAPE_LANES; l++)
            points[l] = at[l < used ? i + l : count - 1];
        kernel->nearest_triangles(tree, leaves, points, used, *hint, hits);
        memcpy(out + i, hits, used * sizeof *hits);
        *hint = hits[used - 1].place;
    }
}

void csg_packet_search(const csg_tree *tree, const csg_shape_kernel *kernel, const uint32_t *items,
                       uint32_t item_count, const csg_vec3 *at, size_t count, csg_triangle_hit *out)
{
    const parts p = {tree, items, item_count};
    csg_tree_leaves leaves;
    uint32_t hint = CSG_TREE_NO_HINT;
    size_t ends[WAITING + 1], waiting = 0, first = 0;
    for (ends[waiting++] = count; waiting;) {
        size_t end = ends[waiting - 1], part = end - first;
        bool is_packet = kernel && part >= FEWEST;
        if (is_packet && gather_leaves(&p, at + first, part, &hint, &leaves)) {
            search_lanes(tree, kernel, &leaves, at + first, part, &hint, out + first);
        } else if (is_packet && part >= 2 * (size_t)CSG_SHAPE_LANES) {
            ends[waiting++] = first + part / 2;
            continue;
        } else {
            for (size_t i = first; i < end; i++)
                out[i] = search_one(&p, at[i], &hint);
        }
        first = end;
        waiting--;
    }
}
