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
    const csg_motion *motion; /* of b, or NULL */
    double moved[3];          /* offset at its other end */
    double bend;              /* no point of b is farther from its chord */
} bounding;

/* Of a way: both ends of all chords are beyond the plane, so the chords are, and the way is near
 * them. */
static void look_along(bounding *w, const double d[3])
{
    double back[3] = {-d[0], -d[1], -d[2]};
    double from = csg_clear_reach(w->a->pieces, w->a->cube.half, d) + w->slack + w->bend;
    double apart =
        csg_dot3(d, w->offset) - from - csg_clear_reach(w->b->pieces, w->b->cube.half, back);
    if (w->motion && apart > w->bound) {
        const csg_vec3 turned =
            csg_affine_covector(&w->motion->back, csg_vec3_make(back[0], back[1], back[2]));
        const double there[3] = {turned.x, turned.y, turned.z};
        apart = fmin(apart, csg_dot3(d, w->moved) - from -
                                csg_clear_reach(w->b->pieces, w->b->cube.half, there));
    }
    w->bound = fmax(w->bound, apart);
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

/* Cubes alone: b's may come nearer by as much as it moves. Returns that. */
static double begin_motion(bounding *w, const csg_motion *motion, csg_vec3 origin_b)
{
    const double *c = w->b->cube.c;
    csg_vec3 center = csg_vec3_add(origin_b, csg_vec3_make(c[0], c[1], c[2]));
    csg_vec3 by = csg_vec3_sub(csg_affine_point(&motion->back, center), center);
    double most = csg_motion_most(motion, center, sqrt(3) * w->b->cube.half);
    w->motion = motion;
    w->bend = motion->bend * most + motion->slack;
    memcpy(w->moved,
           (const double[]){w->offset[0] + by.x, w->offset[1] + by.y, w->offset[2] + by.z},
           sizeof w->moved);
    return most;
}

/* From where b passes nearest on its chord, and from its other end. */
static void look_across_way(bounding *w)
{
    double way[3], square, share;
    for (int k = 0; k < 3; k++)
        way[k] = w->moved[k] - w->offset[k];
    square = csg_dot3(way, way);
    share = square > 0 ? -csg_dot3(way, w->offset) / square : 0;
    share = fmin(fmax(share, 0), 1);
    look_along_vector(w, w->offset[0] + share * way[0], w->offset[1] + share * way[1],
                      w->offset[2] + share * way[2]);
    look_along_vector(w, w->moved[0], w->moved[1], w->moved[2]);
}

double csg_clear_between(const csg_clear_tree *a, uint32_t cube_a, const csg_clear_tree *b,
                         uint32_t cube_b, const csg_motion *motion, csg_vec3 line, double enough,
                         bool *overlap)
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
    if (motion)
        w.bound -= begin_motion(&w, motion, origin_b);
    if (w.bound >= enough || (!motion && !w.a->pieces && !w.b->pieces))
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
    if (motion && w.bound < enough)
        look_across_way(&w);
    return w.bound;
}
