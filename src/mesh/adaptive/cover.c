/* SPDX-License-Identifier: MIT
 * Places against triangles; see cover.h.
 */
#include "mesh/adaptive/cover.h"

#include <math.h>

#include "mesh/remesh/triangle.h"

/* Of the tolerance: what is nearer to the triangles needs nobody to speak for it. */
static const double OFF = 0.25;

/* Of a cell, or of the whole brick. */
static bool is_near_side(const csg_bricks *b, const csg_brick *brick, unsigned cell, bool all,
                         csg_vec3 p, double reach)
{
    const double at[3] = {p.x, p.y, p.z};
    for (int axis = 0; axis < 3; axis++) {
        uint32_t low = all ? 0 : cell >> axis & 1, high = all ? CSG_BRICK_EDGE : low + 1;
        if (at[axis] - (double)csg_brick_coordinate(b, brick, axis, low) < reach ||
            (double)csg_brick_coordinate(b, brick, axis, high) - at[axis] < reach)
            return true;
    }
    return false;
}

/* The squared distance of the nearest triangle; of one that is near enough, if there is one. */
static double nearest_of(const csg_brick_triangles *t, uint32_t first, uint32_t end, csg_vec3 at,
                         double near_enough)
{
    double weights[3], least = INFINITY;
    for (uint32_t i = first; i < end && least > near_enough; i++)
        least = fmin(least, csg_triangle_nearest((const csg_vec3 *)t->at[i], at, weights));
    return least;
}

void csg_cover_find(const csg_brick_triangles *t, const csg_bricks *b, const csg_brick *brick,
                    const csg_hunted *hunted, double tolerance, uint8_t cells, csg_cover *out)
{
    double farthest[CSG_BRICK_CELLS], square = tolerance * tolerance;
    out->uncovered = out->off = 0;
    out->unsure_count = 0;
    for (int cell = 0; cell < CSG_BRICK_CELLS; cell++)
        farthest[cell] = OFF * OFF * square;
    for (int i = 0; i < hunted->count; i++) {
        csg_vec3 at = hunted->at[i];
        unsigned cell = hunted->cell[i];
        if (!(cells >> cell & 1))
            continue;
        double near_enough = fmin(farthest[cell], square);
        double least = nearest_of(t, t->first[cell], t->end[cell], at, near_enough);
        if (least > near_enough)
            least = fmin(least, nearest_of(t, 0, t->count, at, near_enough));
        if (least > farthest[cell]) {
            farthest[cell] = least;
            out->farthest[cell] = at;
            out->off |= (uint8_t)(1u << cell);
        }
        if (least <= square)
            continue;
        if (is_near_side(b, brick, cell, cells == CSG_BRICK_ALL_CELLS, at, tolerance))
            out->unsure[out->unsure_count++] = at;
        else
            out->uncovered |= (uint8_t)(1u << cell);
    }
}
