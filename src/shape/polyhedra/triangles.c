/* SPDX-License-Identifier: MIT
 * Growing lists of triangles; polygons are cut by ears, seen along the axis that their Newell
 * normal is closest to. The search for ears has a budget: a polygon that uses it up (thousands of
 * notches) gets a fan for the rest, which bounds the same solid.
 */
#include "shape/polyhedra/triangles.h"

#include <string.h>

void csg_triangles_init(csg_triangles *triangles, csg_memory *memory)
{
    *triangles = (csg_triangles){.memory = memory};
}

void csg_triangles_release(csg_triangles *triangles)
{
    csg_memory_release(triangles->memory, triangles->points,
                       triangles->point_capacity * sizeof *triangles->points);
    csg_memory_release(triangles->memory, triangles->corners,
                       triangles->capacity * sizeof *triangles->corners);
    *triangles = (csg_triangles){.memory = triangles->memory};
}

bool csg_triangles_add_point(csg_triangles *triangles, csg_vec3 point)
{
    void *data = triangles->points;
    if (!csg_memory_reserve(triangles->memory, &data, &triangles->point_capacity,
                            triangles->point_count + 1, sizeof *triangles->points))
        return false;
    triangles->points = data;
    triangles->points[triangles->point_count++] = point;
    return true;
}

static bool reserve(csg_triangles *triangles, size_t more)
{
    void *data = triangles->corners;
    bool ok = csg_memory_reserve(triangles->memory, &data, &triangles->capacity,
                                 triangles->count + more, sizeof *triangles->corners);
    triangles->corners = data;
    return ok;
}

/* Room is there. */
static void append_corners(csg_triangles *triangles, uint32_t a, uint32_t b, uint32_t c)
{
    uint32_t *corners = triangles->corners[triangles->count++];
    corners[0] = a;
    corners[1] = b;
    corners[2] = c;
}

bool csg_triangles_add(csg_triangles *triangles, uint32_t a, uint32_t b, uint32_t c)
{
    if (!reserve(triangles, 1))
        return false;
    append_corners(triangles, a, b, c);
    return true;
}

csg_box csg_triangles_box(const csg_triangles *triangles)
{
    csg_box box = csg_box_empty();
    for (size_t i = 0; i < triangles->point_count; i++)
        csg_box_extend(&box, triangles->points[i]);
    return box;
}

/* ---- polygons ------------------------------------------------------------------------------- */

typedef struct flat_point {
    double x, y;
} flat_point;

/* A ring of the corners that are left: indices into the face. */
typedef struct ring {
    const uint32_t *corners;
    flat_point *points;
    uint32_t *next, *previous;
    size_t count, budget;
    uint32_t at;
} ring;

static csg_vec3 newell_normal(const csg_triangles *triangles, const uint32_t *corners, size_t count)
{
    csg_vec3 first = triangles->points[corners[0]], sum = {0, 0, 0};
    for (size_t i = 1; i + 1 < count; i++)
        sum = csg_vec3_add(sum,
                           csg_vec3_cross(csg_vec3_sub(triangles->points[corners[i]], first),
                                          csg_vec3_sub(triangles->points[corners[i + 1]], first)));
    return sum;
}

/* Seen from the normal's side, so that the face runs counter-clockwise. */
static flat_point flatten(csg_vec3 p, csg_vec3 normal)
{
    double x = fabs(normal.x), y = fabs(normal.y), z = fabs(normal.z);
    flat_point flat = z >= x && z >= y ? (flat_point){p.x, p.y}
                      : y >= x         ? (flat_point){p.z, p.x}
                                       : (flat_point){p.y, p.z};
    double along = z >= x && z >= y ? normal.z : y >= x ? normal.y : normal.x;
    if (along < 0)
        flat.x = -flat.x;
    return flat;
}

static double turn(flat_point a, flat_point b, flat_point c)
{
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

static bool is_same(flat_point p, flat_point q)
{
    return p.x == q.x && p.y == q.y;
}

static bool is_ear(ring *r, uint32_t tip)
{
    uint32_t before = r->previous[tip], after = r->next[tip];
    flat_point a = r->points[before], b = r->points[tip], c = r->points[after];
    if (!(turn(a, b, c) > 0))
        return false;
    for (uint32_t i = r->next[after]; i != before; i = r->next[i]) {
        flat_point p = r->points[i];
        /* a corner again, where a bridge to a hole is run both ways */
        bool is_corner = is_same(p, a) || is_same(p, b) || is_same(p, c);
        r->budget -= r->budget > 0;
        if (!is_corner && turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0)
            return false;
    }
    return true;
}

static void clip(csg_triangles *triangles, ring *r, uint32_t tip)
{
    uint32_t before = r->previous[tip], after = r->next[tip];
    append_corners(triangles, r->corners[before], r->corners[tip], r->corners[after]);
    r->next[before] = after;
    r->previous[after] = before;
    r->count--;
    r->at = after;
}

static void clip_all(csg_triangles *triangles, ring *r)
{
    while (r->count > 3) {
        uint32_t tip = r->at;
        size_t tried = 0;
        while (tried < r->count && r->budget && !is_ear(r, tip)) {
            tip = r->next[tip];
            tried++;
        }
        clip(triangles, r, tip);
    }
    clip(triangles, r, r->at);
}

static bool is_convex(const ring *r)
{
    double area = 0; /* a loop that goes round twice turns left everywhere too: one sweep from the
                        first corner tells them apart */
    for (uint32_t i = 0; i < r->count; i++) {
        uint32_t j = r->next[i];
        double step = turn(r->points[0], r->points[i], r->points[j]);
        if (!(turn(r->points[i], r->points[j], r->points[r->next[j]]) > 0) || step < 0)
            return false;
        area += step;
    }
    return area > 0;
}

/* Which diagonal of a quad that is not flat: the circle rule, as OpenSCAD has it. The first one has
 * the corners 1 and 3 opposite to it: their angles, together, are then at most 180 degrees. */
static bool takes_second_diagonal(const flat_point *p)
{
    double sum[2][2]; /* of either corner's angle: cosine and sine, times the edges' lengths */
    for (uint32_t i = 0; i < 2; i++) {
        flat_point tip = p[1 + 2 * i], a = p[2 * i], b = p[2 - 2 * i];
        sum[i][0] = (a.x - tip.x) * (b.x - tip.x) + (a.y - tip.y) * (b.y - tip.y);
        sum[i][1] = turn(tip, b, a);
    }
    return sum[0][1] * sum[1][0] + sum[0][0] * sum[1][1] < 0;
}

static void add_fan(csg_triangles *triangles, const uint32_t *corners, size_t count)
{
    for (size_t i = 1; i + 1 < count; i++)
        append_corners(triangles, corners[0], corners[i], corners[i + 1]);
}

bool csg_triangles_add_face(csg_triangles *triangles, const uint32_t *corners, size_t count)
{
    if (!reserve(triangles, count - 2))
        return false;
    if (count == 3) {
        add_fan(triangles, corners, count);
        return true;
    }
    size_t size = count * (sizeof(flat_point) + 2 * sizeof(uint32_t));
    flat_point *points = csg_memory_alloc(triangles->memory, size);
    if (!points)
        return false;
    uint32_t *links = (uint32_t *)(points + count);
    ring r = {corners, points, links, links + count, count, 64 * count + 50000000, 0};
    csg_vec3 normal = newell_normal(triangles, corners, count);
    for (uint32_t i = 0; i < count; i++) {
        points[i] = flatten(triangles->points[corners[i]], normal);
        r.next[i] = i + 1 < count ? i + 1 : 0;
        r.previous[i] = i ? i - 1 : (uint32_t)count - 1;
    }
    if (is_convex(&r) && count == 4 && takes_second_diagonal(points))
        add_fan(triangles, (const uint32_t[4]){corners[1], corners[2], corners[3], corners[0]}, 4);
    else if (is_convex(&r))
        add_fan(triangles, corners, count);
    else
        clip_all(triangles, &r);
    csg_memory_release(triangles->memory, points, size);
    return true;
}
