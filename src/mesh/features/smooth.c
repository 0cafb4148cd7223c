/* SPDX-License-Identifier: MIT
 * A polygon as marching cubes makes it, its largest triangle divided in three: so the numbers of
 * vertices and triangles are those of a feature.
 */
#include "mesh/features/smooth.h"

#include <string.h>

/* The triangles of marching cubes, in corners of the polygon; how many. */
static unsigned plain_triangles(const csg_feature *f, const csg_cell_tables *tables,
                                uint8_t corner[CSG_CELL_EDGES][3])
{
    const uint8_t *edge = tables->edge[f->pattern];
    uint8_t around[CSG_FEATURE_MOST_SIDES], own[3 * CSG_CELL_EDGES];
    unsigned count = f->side_count - 2u;
    for (int s = 0; s < f->side_count; s++)
        around[s] = f->side[s].edge;
    if (f->joined && csg_cell_cut(around, f->side_count, own))
        edge = own;
    for (int loop = 0; loop < f->loop && !f->joined; loop++)
        edge += 3 * (tables->loop_sides[f->pattern][loop] - 2);
    for (unsigned i = 0; i < 3 * count; i++) {
        uint8_t k = 0;
        while (f->side[k].edge != edge[i])
            k++;
        corner[i / 3][i % 3] = k;
    }
    return count;
}

/* By the square of twice the area. */
static unsigned largest_of(const csg_feature *f, uint8_t corner[CSG_CELL_EDGES][3], unsigned count)
{
    double most = -1;
    unsigned largest = 0;
    for (unsigned t = 0; t < count; t++) {
        csg_vec3 at[3];
        for (int i = 0; i < 3; i++)
            at[i] = csg_vec3_from_floats(f->side[corner[t][i]].corner);
        csg_vec3 n = csg_vec3_cross(csg_vec3_sub(at[1], at[0]), csg_vec3_sub(at[2], at[0]));
        double area = csg_vec3_dot(n, n);
        if (area > most) {
            most = area;
            largest = t;
        }
    }
    return largest;
}

/* One normal for all sheets. */
static void level_normals(csg_feature *f, uint8_t corner)
{
    for (int k = 0; k < f->sheet_count; k++)
        memmove(f->normal[k], f->normal[f->side[corner].sheet], sizeof f->normal[k]);
}

/* Whereabouts in a triangle: nearly at a corner, which lies on the surface; where floats are too
 * coarse for that, further in. */
static const float WEIGHTS[][3] = {{0.998f, 0.001f, 0.001f}, {0.001f, 0.998f, 0.001f},
                                   {0.001f, 0.001f, 0.998f}, {0.98f, 0.01f, 0.01f},
                                   {0.01f, 0.98f, 0.01f},    {0.01f, 0.01f, 0.98f},
                                   {0.8f, 0.1f, 0.1f},       {0.333f, 0.333f, 0.334f}};
enum { WEIGHT_COUNT = sizeof WEIGHTS / sizeof *WEIGHTS };

/* Long loops, of cells with a joined face, have no cut that never meets itself. Seen from a point
 * inside the cell what lies on its faces meets nowhere: a fan from there never does, and nothing
 * else is in such a cell. Attempts go from the middle towards the corners. */
static bool fan_within(csg_feature *f, unsigned attempt)
{
    if (attempt > f->side_count)
        return false;
    for (uint8_t s = 0; s < f->side_count; s++) {
        uint8_t *t = f->triangle[s];
        t[0] = CSG_FEATURE_APEX, t[1] = s, t[2] = (uint8_t)((s + 1) % f->side_count);
    }
    for (int i = 0; i < 3; i++) {
        float sum = 0;
        for (int s = 0; s < f->side_count; s++)
            sum += f->side[s].corner[i];
        f->at[i] = sum / (float)f->side_count;
        if (attempt)
            f->at[i] = 0.5f * (f->at[i] + f->side[attempt - 1].corner[i]);
    }
    level_normals(f, 0);
    return true;
}

bool csg_feature_divide(csg_feature *f, const csg_cell_tables *tables, unsigned attempt)
{
    enum { MOST_CUT = 7 };
    if (f->side_count > MOST_CUT && f->state != CSG_FEATURE_BARE)
        return fan_within(f, attempt);
    uint8_t corner[CSG_CELL_EDGES][3], (*to)[3] = f->triangle;
    unsigned count = plain_triangles(f, tables, corner);
    if (f->state == CSG_FEATURE_BARE || attempt / count >= WEIGHT_COUNT)
        return false;
    unsigned divided = attempt ? attempt % count : largest_of(f, corner, count);
    const uint8_t *d = corner[divided];
    const float *w = WEIGHTS[attempt / count];
    for (unsigned t = 0; t < count; t++)
        if (t != divided)
            memcpy(*to++, corner[t], sizeof *to);
    for (int c = 0; c < 3; c++, to++)
        (*to)[0] = CSG_FEATURE_APEX, (*to)[1] = d[c], (*to)[2] = d[(c + 1) % 3];
    for (int i = 0; i < 3; i++)
        f->at[i] = w[0] * f->side[d[0]].corner[i] + w[1] * f->side[d[1]].corner[i] +
                   w[2] * f->side[d[2]].corner[i];
    level_normals(f, d[w[1] > w[0] ? 1 : w[2] > w[0] ? 2 : 0]);
    return true;
}

void csg_feature_leave_plain(csg_feature *f, const csg_cell_tables *tables)
{
    plain_triangles(f, tables, f->triangle);
}
