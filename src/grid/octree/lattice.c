/* SPDX-License-Identifier: MIT */
#include "grid/octree/lattice.h"

#include <float.h>
#include <math.h>

bool csg_lattice_make(csg_box bounds, csg_vec3 center, double cell_size, uint32_t resolution,
                      csg_lattice *out)
{
    csg_vec3 size = csg_box_size(bounds), middle = csg_box_center(bounds);
    double sides[3] = {size.x, size.y, size.z};
    double longest = fmax(sides[0], fmax(sides[1], sides[2]));
    double h = cell_size > 0 ? cell_size : longest / resolution;
    if (!(h > 0) || !isfinite(h) || !isfinite(longest))
        return false;
    double origin[3] = {middle.x - center.x, middle.y - center.y, middle.z - center.z};
    for (int axis = 0; axis < 3; axis++) {
        /* A side of a whole number of cells must not gain one by rounding. */
        double cells = ceil(sides[axis] / h - 1e-6) + 3;
        if (!(cells <= CSG_LATTICE_MOST_CELLS))
            return false;
        out->cells[axis] = (uint32_t)cells;
        out->blocks[axis] = (out->cells[axis] + CSG_BLOCK_EDGE - 1) / CSG_BLOCK_EDGE;
        origin[axis] -= 0.5 * cells * h;
    }
    out->origin = csg_vec3_make(origin[0], origin[1], origin[2]);
    out->cell_size = h;
    return true;
}

/* Whether the highest set bit of a is lower than that of b. */
static bool is_shorter(uint32_t a, uint32_t b)
{
    return a < b && a < (a ^ b);
}

int csg_lattice_compare_morton(const uint32_t a[3], const uint32_t b[3])
{
    int deciding = 0;
    uint32_t most = 0;
    for (int axis = 0; axis < 3; axis++) {
        uint32_t differ = a[axis] ^ b[axis];
        if (!is_shorter(differ, most)) {
            deciding = axis;
            most = differ;
        }
    }
    return a[deciding] < b[deciding] ? -1 : a[deciding] > b[deciding];
}

float csg_lattice_ball_radius(const csg_lattice *lattice, double margin, uint32_t half)
{
    double reach = half * lattice->cell_size + margin;
    return (float)(reach * (sqrt(3.0) * (1 + 4 * (double)FLT_EPSILON)));
}

double csg_lattice_extent(const csg_lattice *lattice)
{
    double most = 0;
    const double origin[3] = {lattice->origin.x, lattice->origin.y, lattice->origin.z};
    for (int axis = 0; axis < 3; axis++) {
        double end = origin[axis] + lattice->cells[axis] * lattice->cell_size;
        most = fmax(most, fmax(fabs(origin[axis]), fabs(end)));
    }
    return most;
}
