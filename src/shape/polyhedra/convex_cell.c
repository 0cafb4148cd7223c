/* SPDX-License-Identifier: MIT
 * Facets and convex cells cut by planes; see convex_cell.h.
 */
#include "shape/polyhedra/convex_cell.h"

#include <math.h>
#include <stdlib.h>

#include "base/elementary.h"

csg_cut_plane csg_cut_plane_turned(const csg_cut_plane *plane)
{
    return (csg_cut_plane){csg_vec3_scale(plane->normal, -1), -plane->offset};
}

static double height(const csg_cut_plane *plane, csg_vec3 p)
{
    return csg_vec3_dot(plane->normal, p) - plane->offset;
}

/* ---- facets ---------------------------------------------------------------------------------- */

/* Twice its area, along its normal. */
static csg_vec3 area_of(const csg_facet *facet)
{
    csg_vec3 sum = csg_vec3_make(0, 0, 0);
    for (size_t i = 1; i + 1 < facet->count; i++)
        sum =
            csg_vec3_add(sum, csg_vec3_cross(csg_vec3_sub(facet->points[i], facet->points[0]),
                                             csg_vec3_sub(facet->points[i + 1], facet->points[0])));
    return sum;
}

bool csg_facet_find_plane(csg_facet *facet, double slack)
{
    csg_vec3 area = area_of(facet);
    double size = csg_vec3_norm(area), longest = 0, sum = 0;
    for (size_t i = 0; i < facet->count; i++) {
        csg_vec3 side = csg_vec3_sub(facet->points[(i + 1) % facet->count], facet->points[i]);
        longest = fmax(longest, csg_vec3_norm(side));
    }
    if (!(size > slack * longest))
        return false;
    facet->plane.normal = csg_vec3_scale(area, 1 / size);
    for (size_t i = 0; i < facet->count; i++)
        sum += csg_vec3_dot(facet->plane.normal, facet->points[i]);
    facet->plane.offset = sum / (double)facet->count;
    return true;
}

void csg_facet_reach(const csg_facet *facet, const csg_cut_plane *plane, double *low, double *high)
{
    *low = INFINITY;
    *high = -INFINITY;
    for (size_t i = 0; i < facet->count; i++) {
        double h = height(plane, facet->points[i]);
        *low = fmin(*low, h);
        *high = fmax(*high, h);
    }
}

/* What of a facet that the plane cuts lies on one side (-1: behind). */
static void clip(const csg_facet *facet, const csg_cut_plane *plane, double side, double slack,
                 csg_facet *out)
{
    out->count = 0;
    for (size_t i = 0; i < facet->count; i++) {
        csg_vec3 a = facet->points[i], b = facet->points[(i + 1) % facet->count];
        double from = side * height(plane, a), to = side * height(plane, b);
        if (from >= -slack)
            out->points[out->count++] = a;
        if ((from < -slack && to > slack) || (from > slack && to < -slack))
            out->points[out->count++] =
                csg_vec3_add(a, csg_vec3_scale(csg_vec3_sub(b, a), from / (from - to)));
    }
}

bool csg_facet_split(csg_arena *arena, const csg_facet *facet, const csg_cut_plane *plane,
                     double slack, csg_facet parts[2])
{
    double low, high;
    csg_facet_reach(facet, plane, &low, &high);
    parts[0] = parts[1] = *facet;
    if (low >= -slack || high <= slack) {
        parts[0].count = low < -slack ? facet->count : 0;
        parts[1].count = high > slack ? facet->count : 0;
        return true;
    }
    for (int k = 0; k < 2; k++) {
        parts[k].points = csg_arena_calloc(arena, facet->count + 2, sizeof *parts[k].points);
        if (!parts[k].points)
            return false;
        clip(facet, plane, k == 0 ? -1 : 1, slack, &parts[k]);
    }
    return true;
}

/* ---- cells ----------------------------------------------------------------------------------- */

bool csg_convex_cell_begin(csg_convex_cell *cell, csg_arena *arena, csg_box box, double slack)
{
    const csg_vec3 ends[2] = {box.min, box.max};
    *cell = (csg_convex_cell){.arena = arena, .slack = slack, .count = 6};
    cell->facets = csg_arena_calloc(arena, 6, sizeof *cell->facets);
    for (int i = 0; i < 6 && cell->facets; i++) {
        int axis = i / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
        csg_facet *facet = &cell->facets[i];
        facet->points = csg_arena_calloc(arena, 4, sizeof *facet->points);
        if (!facet->points)
            return false;
        facet->count = 4;
        for (int k = 0; k < 4; k++) {
            double *p = &facet->points[k].x;
            int turn = i % 2 ? k : 3 - k; /* counter-clockwise from outside */
            p[axis] = (&ends[i % 2].x)[axis];
            p[u] = (&ends[turn == 1 || turn == 2].x)[u];
            p[v] = (&ends[turn >= 2].x)[v];
        }
        if (!csg_facet_find_plane(facet, slack))
            cell->count = 0;
    }
    return cell->facets != NULL;
}

typedef struct around { /* a corner of a facet by its angle */
    csg_vec3 at;
    double angle;
} around;

static int by_angle(const void *a, const void *b)
{
    double x = ((const around *)a)->angle, y = ((const around *)b)->angle;
    return x < y ? -1 : x > y;
}

/* Corners that lie in the plane, each once; room: as many as there are. */
static size_t corners_in(const csg_convex_cell *cell, const csg_cut_plane *plane, around *out)
{
    size_t count = 0;
    for (size_t i = 0; i < cell->count; i++)
        for (size_t k = 0; k < cell->facets[i].count; k++) {
            csg_vec3 p = cell->facets[i].points[k];
            bool is_new = fabs(height(plane, p)) <= 2 * cell->slack;
            for (size_t j = 0; j < count && is_new; j++)
                is_new = csg_vec3_norm(csg_vec3_sub(out[j].at, p)) > 2 * cell->slack;
            if (is_new)
                out[count++].at = p;
        }
    return count;
}

/* The facet where a plane has cut. */
static bool cover(csg_convex_cell *cell, const csg_cut_plane *by)
{
    size_t room = 1, count;
    for (size_t i = 0; i < cell->count; i++)
        room += cell->facets[i].count;
    around *found = csg_arena_calloc(cell->arena, room, sizeof *found);
    if (!found)
        return false;
    count = corners_in(cell, by, found);
    if (count < 3)
        return true;
    csg_vec3 middle = csg_vec3_make(0, 0, 0), u, v;
    for (size_t i = 0; i < count; i++)
        middle = csg_vec3_add(middle, csg_vec3_scale(found[i].at, 1 / (double)count));
    u = csg_vec3_normalize(csg_vec3_sub(found[0].at, middle));
    v = csg_vec3_cross(by->normal, u);
    for (size_t i = 0; i < count; i++) {
        csg_vec3 d = csg_vec3_sub(found[i].at, middle);
        found[i].angle = csg_atan2(csg_vec3_dot(d, v), csg_vec3_dot(d, u));
    }
    qsort(found, count, sizeof *found, by_angle);
    csg_facet *facet = &cell->facets[cell->count];
    *facet = (csg_facet){.plane = *by, .count = count};
    facet->points = csg_arena_calloc(cell->arena, count, sizeof *facet->points);
    for (size_t i = 0; i < count && facet->points; i++)
        facet->points[i] = found[i].at;
    cell->count += facet->points != NULL;
    return facet->points;
}

bool csg_convex_cell_cut(csg_convex_cell *cell, const csg_cut_plane *by)
{
    bool is_cut = false;
    double low, high;
    for (size_t i = 0; i < cell->count && !is_cut; i++) {
        csg_facet_reach(&cell->facets[i], by, &low, &high);
        is_cut = high > cell->slack;
    }
    if (!is_cut)
        return true;
    csg_facet *kept = csg_arena_calloc(cell->arena, cell->count + 1, sizeof *kept);
    size_t count = 0;
    if (!kept)
        return false;
    for (size_t i = 0; i < cell->count; i++) {
        csg_facet parts[2];
        if (!csg_facet_split(cell->arena, &cell->facets[i], by, cell->slack, parts))
            return false;
        if (parts[0].count >= 3)
            kept[count++] = parts[0];
    }
    cell->facets = kept;
    cell->count = count;
    return count < 3 || cover(cell, by);
}

/* Volume over area: a third of the radius of a ball that touches all facets. */
static double thickness(const csg_convex_cell *cell)
{
    double volume = 0, area = 0;
    csg_vec3 origin = cell->facets[0].points[0];
    for (size_t i = 0; i < cell->count; i++) {
        csg_vec3 twice = area_of(&cell->facets[i]);
        area += csg_vec3_norm(twice) / 2;
        volume += csg_vec3_dot(twice, csg_vec3_sub(cell->facets[i].points[0], origin)) / 6;
    }
    return area > 0 ? volume / area : 0;
}

bool csg_convex_cell_corners(const csg_convex_cell *cell, csg_vec3 **out, size_t *count)
{
    const double thin = 2; /* slacks */
    size_t room = 1;
    *count = 0;
    for (size_t i = 0; i < cell->count; i++)
        room += cell->facets[i].count;
    *out = csg_arena_calloc(cell->arena, room, sizeof **out);
    if (!*out || cell->count < 4 || thickness(cell) < thin * cell->slack)
        return *out;
    for (size_t i = 0; i < cell->count; i++)
        for (size_t k = 0; k < cell->facets[i].count; k++) {
            csg_vec3 p = cell->facets[i].points[k];
            bool is_new = true;
            for (size_t j = 0; j < *count && is_new; j++)
                is_new = csg_vec3_norm(csg_vec3_sub((*out)[j], p)) > 2 * cell->slack;
            if (is_new)
                (*out)[(*count)++] = p;
        }
    return true;
}
