/* SPDX-License-Identifier: MIT
 * Sectors around an apex; see fan.h. Seen along one direction each triangle of a fan is a sector,
 * turned counter-clockwise by less than half a circle. Where each begins at the vertex at which
 * another ends they are the steps of a walk around the apex, and if that goes round once no two
 * sectors have more in common than a side; what lies above different points of the view cannot
 * meet.
 */
#include "mesh/features/fan.h"

#include <math.h>

#include "base/geometry.h"

enum { MOST = 16 /* triangles */ };

/* Of the volume that two sides of a triangle and the view span, as a part of the product of their
 * lengths: rounding is some 1e-15 of it. */
static const double MARGIN = 1e-6;

/* From the apex to the other corners of a triangle, counter-clockwise. */
typedef struct sector {
    csg_vec3 from, to;
    uint32_t first, last; /* their vertices: corners of the feature at hand, or apexes */
} sector;

#define OF_APEX 0x80000000u

typedef struct fan {
    const csg_feature_store *store;
    const csg_marching *marching;
    const csg_feature *f; /* whose apex it is around */
    csg_vec3 apex;
    sector sectors[MOST];
    int count;
} fan;

static csg_vec3 place_of(const fan *q, const float *at)
{
    float shifted[3];
    csg_marching_shift(q->marching, at, shifted);
    return csg_vec3_from_floats(shifted);
}

/* A corner of a triangle of g, which is beyond side s of the feature at hand, or is this feature
 * itself. False: it is none that both have. */
static bool find_corner(const fan *q, const csg_feature *g, int s, uint8_t corner, uint32_t *vertex,
                        csg_vec3 *way)
{
    const csg_feature *apex = corner == CSG_FEATURE_APEX ? g
                              : corner >= CSG_FEATURE_BEYOND
                                  ? &q->store->features[g->side[corner - CSG_FEATURE_BEYOND].beyond]
                                  : NULL;
    int own = corner;
    if (g != q->f && !apex) {
        int t = q->f->side[s].beyond_side;
        if (corner != t && corner != (t + 1) % g->side_count)
            return false;
        own = corner == t ? (s + 1) % q->f->side_count : s;
    }
    *vertex = apex ? OF_APEX | (uint32_t)(apex - q->store->features) : (uint32_t)own;
    *way = csg_vec3_sub(place_of(q, apex ? apex->at : q->f->side[own].corner), q->apex);
    return true;
}

/* Adds those triangles of g that have `apex` as a corner. False: that is too much to tell. */
static bool add_triangles(fan *q, const csg_feature *g, int s, uint8_t apex)
{
    for (int k = 0; k < csg_feature_triangle_count(g); k++) {
        const uint8_t *t = g->triangle[k];
        int c = 0;
        while (c < 3 && t[c] != apex)
            c++;
        if (c == 3)
            continue;
        if (q->count == MOST)
            return false;
        sector *to = &q->sectors[q->count++];
        if (!find_corner(q, g, s, t[(c + 1) % 3], &to->first, &to->from) ||
            !find_corner(q, g, s, t[(c + 2) % 3], &to->last, &to->to))
            return false;
    }
    return true;
}

/* Others may have triangles at the apex from before a side was given up, until they are cut again.
 */
static bool collect(fan *q)
{
    const csg_feature *f = q->f;
    if (!add_triangles(q, f, 0, CSG_FEATURE_APEX))
        return false;
    for (int s = 0; s < f->side_count; s++)
        if (f->side[s].beyond != CSG_FEATURE_NONE &&
            !add_triangles(q, &q->store->features[f->side[s].beyond], s,
                           (uint8_t)(CSG_FEATURE_BEYOND + f->side[s].beyond_side)))
            return false;
    return q->count >= 3;
}

/* The sum of the triangles' normals. */
static csg_vec3 view_of(const fan *q)
{
    csg_vec3 sum = {0, 0, 0};
    for (int i = 0; i < q->count; i++)
        sum = csg_vec3_add(
            sum, csg_vec3_normalize(csg_vec3_cross(q->sectors[i].from, q->sectors[i].to)));
    return sum;
}

/* Whether all sectors are seen from one side, and how often they go round. */
static bool find_rounds(const fan *q, int *rounds)
{
    csg_vec3 view = view_of(q);
    csg_vec3 axis = fabs(view.x) < fabs(view.y) ? csg_vec3_make(1, 0, 0) : csg_vec3_make(0, 1, 0);
    csg_vec3 across = csg_vec3_cross(view, axis);
    double least = MARGIN * MARGIN * csg_vec3_dot(view, view);
    *rounds = 0;
    for (int i = 0; i < q->count; i++) {
        const sector *s = &q->sectors[i];
        double turn = csg_vec3_dot(csg_vec3_cross(s->from, s->to), view);
        double square = csg_vec3_dot(s->from, s->from) * csg_vec3_dot(s->to, s->to);
        if (!(turn > 0 && turn * turn > least * square))
            return false;
        *rounds += csg_vec3_dot(s->from, across) < 0 && csg_vec3_dot(s->to, across) >= 0;
    }
    return true;
}

/* Whether they are one walk: each step behind the one before, until the first. */
static bool is_one_walk(const fan *q)
{
    int at = 0, steps = 0;
    do {
        int next = 0;
        while (next < q->count && q->sectors[next].first != q->sectors[at].last)
            next++;
        if (next == q->count)
            return false;
        at = next;
    } while (++steps < q->count && at != 0);
    return steps == q->count && at == 0;
}

bool csg_fan_is_clear(const csg_feature_store *store, const csg_marching *marching,
                      uint32_t feature)
{
    fan q;
    int rounds;
    q.store = store;
    q.marching = marching;
    q.f = &store->features[feature];
    q.apex = place_of(&q, q.f->at);
    q.count = 0;
    return collect(&q) && find_rounds(&q, &rounds) && rounds == 1 && is_one_walk(&q);
}
