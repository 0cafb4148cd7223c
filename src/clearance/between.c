/* SPDX-License-Identifier: MIT
 * See between.h. Every direction is a bound; the most that a few promising ones say is taken.
 */
#include "clearance/between.h"

#include <math.h>
#include <string.h>

typedef struct bounding {
    const csg_clear_node *a, *b;
    double offset[3];
    double bound, slack;
} bounding;

static void look_along(bounding *w, const double d[3])
{
    const double back[3] = {-d[0], -d[1], -d[2]};
    double along = d[0] * w->offset[0] + d[1] * w->offset[1] + d[2] * w->offset[2];
    double apart = along - csg_clear_reach(w->a->pieces, w->a->cube.half, d) -
                   csg_clear_reach(w->b->pieces, w->b->cube.half, back);
    w->bound = fmax(w->bound, apart - w->slack);
}

static void look_along_vector(bounding *w, double x, double y, double z)
{
    double length = sqrt(x * x + y * y + z * z);
    const double d[3] = {x / length, y / length, z / length};
    if (length > 0)
        look_along(w, d);
}

static void look_along_normals(bounding *w, const csg_clear_pieces *pieces, double turn)
{
    uint8_t used = 0;
    for (int i = 0; pieces && i < pieces->count; i++)
        used |= pieces->masks[i];
    for (int i = 0; pieces && i < pieces->plane_count; i++) {
        const double *s = pieces->planes[i].slope;
        const double d[3] = {turn * s[0], turn * s[1], turn * s[2]};
        if (used >> i & 1)
            look_along(w, d);
    }
}

double csg_clear_between(const csg_clear_tree *a, uint32_t cube_a, const csg_clear_tree *b,
                         uint32_t cube_b, csg_vec3 line, double enough, bool *overlap)
{
    bounding w = {.a = &a->nodes[cube_a], .b = &b->nodes[cube_b]};
    csg_vec3 offset = csg_clear_offset(a, cube_a, b, cube_b);
    csg_vec3 origin_a = csg_clear_part_origin(a->part), origin_b = csg_clear_part_origin(b->part);
    double reach = w.a->cube.half + w.b->cube.half, widest = -INFINITY, square = 0, between[3];
    memcpy(w.offset, (const double[3]){offset.x, offset.y, offset.z}, sizeof w.offset);
    w.slack = 1e-15 * (csg_vec3_norm(origin_a) + csg_vec3_norm(origin_b) +
                       4 * csg_vec3_norm(offset) + 4 * reach);
    for (int k = 0; k < 3; k++) {
        double gap = fabs(w.offset[k]) - reach;
        widest = fmax(widest, gap);
        between[k] = gap > 0 ? copysign(gap, w.offset[k]) : 0;
        square += gap > 0 ? gap * gap : 0;
    }
    *overlap = widest <= w.slack;
    w.bound = (*overlap ? widest : sqrt(square)) - w.slack;
    if (w.bound >= enough || (!w.a->pieces && !w.b->pieces))
        return w.bound;
    look_along_vector(&w, line.x, line.y, line.z);
    if (w.bound < enough)
        look_along_normals(&w, w.a->pieces, -1);
    if (w.bound < enough)
        look_along_normals(&w, w.b->pieces, 1);
    if (w.bound < enough)
        look_along_vector(&w, w.offset[0], w.offset[1], w.offset[2]);
    if (w.bound < enough)
        look_along_vector(&w, between[0], between[1], between[2]);
    return w.bound;
}
