/* SPDX-License-Identifier: MIT
 * Boxes by support functions; see primitive_box.h. {f >= -level} of an exact distance is the solid
 * grown by a ball, which adds level |n|; of a gauge the solid scaled.
 */
#include "scene/primitives/primitive_box.h"

#include <float.h>

#include "scene/primitives/primitive.h"

/* Rows along an axis come out exact; sums of products get room for their rounding. */
static double rounding_room(const double *row, double reach, double shift)
{
    int used = (row[0] != 0) + (row[1] != 0) + (row[2] != 0);
    return used > 1 && isfinite(reach) ? 4 * DBL_EPSILON * (fabs(reach) + fabs(shift)) : 0;
}

csg_box csg_primitive_box(csg_primitive_kind kind, const double *parameters, const csg_affine *map,
                          double level)
{
    double low[3], high[3];
    if (kind == CSG_NODE_EMPTY)
        return csg_box_empty();
    if (kind == CSG_NODE_FIELD)
        return csg_box_all();
    const csg_primitive *primitive = csg_primitive_of(kind);
    bool is_distance = primitive->traits & CSG_TRAIT_OUTSIDE;
    double scale = is_distance ? 1 : 1 + level / primitive->depth(parameters);
    for (int i = 0; i < 3; i++) {
        const double *row = map->m[i];
        csg_vec3 n = csg_vec3_make(row[0], row[1], row[2]);
        double grow = is_distance ? level * csg_vec3_norm(n) : 0;
        double up = primitive->support(parameters, n) * scale + grow;
        double down = primitive->support(parameters, csg_vec3_scale(n, -1)) * scale + grow;
        high[i] = map->t[i] + up + rounding_room(row, up, map->t[i]);
        low[i] = map->t[i] - down - rounding_room(row, down, map->t[i]);
    }
    return (csg_box){{low[0], low[1], low[2]}, {high[0], high[1], high[2]}};
}
