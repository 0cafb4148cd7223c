/* SPDX-License-Identifier: MIT
 * Points that lie together go down the tree together; what was nearest to some is a good bound for
 * the next.
 */
#include "shape/polyhedra/packet.h"

#include <string.h>

/* Points for which lanes pay, and for which it pays to bring those together that lie together. */
enum { FEWEST = 2, WORTH_ORDER = 3 * CSG_SHAPE_LANES };

/* ---- order ------------------------------------------------------------------------------------
 */

/* Steps of a box along each of its sides, in which points are put in Morton order. */
enum { STEP_BITS = 3, STEPS = 1 << STEP_BITS, CELLS = STEPS * STEPS * STEPS };

static uint32_t spread(uint32_t step)
{
    return (step & 1) | (step & 2) << 2 | (step & 4) << 4;
}

static csg_box box_around(const csg_vec3 *at, size_t count)
{
    csg_box box = {at[0], at[0]};
    for (size_t i = 1; i < count; i++)
        csg_box_extend(&box, at[i]);
    return box;
}

/* Numbers of points, those that lie together one after another. */
static void put_in_order(const csg_vec3 *at, size_t count, uint16_t *order)
{
    uint16_t starts[CELLS + 1] = {0}, cells[CSG_PACKET_MOST];
    csg_box box = box_around(at, count);
    csg_vec3 side = csg_vec3_sub(box.max, box.min);
    double longest = fmax(side.x, fmax(side.y, side.z));
    double per_unit = longest > 0 ? (STEPS - 0x1p-20) / longest : 0;
    for (size_t i = 0; i < count; i++) {
        csg_vec3 p = csg_vec3_scale(csg_vec3_sub(at[i], box.min), per_unit);
        cells[i] = (uint16_t)(spread((uint32_t)p.x) | spread((uint32_t)p.y) << 1 |
                              spread((uint32_t)p.z) << 2);
        starts[cells[i] + 1]++;
    }
    for (size_t cell = 0; cell < CELLS; cell++)
        starts[cell + 1] = (uint16_t)(starts[cell + 1] + starts[cell]);
    for (size_t i = 0; i < count; i++)
        order[starts[cells[i]]++] = (uint16_t)i;
}

/* ---- searching --------------------------------------------------------------------------------
 */

static void keep_hint(const csg_triangle_hit *hit, uint32_t *hint)
{
    if (hit->place != CSG_TREE_NONE)
        *hint = hit->place;
}

/* The last point is in the lanes that are left over. */
static void search_lanes(const csg_tree *tree, const csg_tree_parts *parts,
                         const csg_shape_kernel *kernel, const csg_vec3 *at, const uint16_t *order,
                         size_t count, uint32_t *hint, csg_triangle_hit *out)
{
    csg_vec3 points[CSG_SHAPE_LANES];
    csg_triangle_hit hits[CSG_SHAPE_LANES];
    for (size_t l = 0; l < CSG_SHAPE_LANES; l++)
        points[l] = at[order[l < count ? l : count - 1]];
    kernel->nearest_triangles(tree, parts, points, count, *hint, hits);
    for (size_t l = 0; l < count; l++)
        out[order[l]] = hits[l];
    keep_hint(&hits[count - 1], hint);
}

void csg_packet_search(const csg_tree *tree, const csg_shape_kernel *kernel,
                       const csg_tree_parts *parts, const csg_vec3 *at, size_t count,
                       csg_triangle_hit *out)
{
    uint32_t hint = CSG_TREE_NONE;
    uint16_t order[CSG_PACKET_MOST];
    if (count >= WORTH_ORDER)
        put_in_order(at, count, order);
    for (size_t i = 0; i < count && count < WORTH_ORDER; i++)
        order[i] = (uint16_t)i;
    for (size_t i = 0, used; i < count; i += used) {
        used = count - i < CSG_SHAPE_LANES ? count - i : CSG_SHAPE_LANES;
        if (kernel && used >= FEWEST) {
            search_lanes(tree, parts, kernel, at, order + i, used, &hint, out);
            continue;
        }
        for (size_t k = i; k < i + used; k++) {
            out[order[k]] = csg_tree_nearest_of(tree, parts, at[order[k]], hint);
            keep_hint(&out[order[k]], &hint);
        }
    }
}
