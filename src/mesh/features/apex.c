/* SPDX-License-Identifier: MIT
 * Apexes of polygons. The sheets around an apex are the runs of corners between creases; each sheet
 * stands in by its tangent plane at a point a little off the apex towards its corners, where the
 * field is that sheet's alone. Planes meet in a better apex, points move closer to it: on plane
 * faces the first meeting is exact, on curved ones the error falls with the square of the distance.
 *
 * An apex is taken when the field is 0 there, the sheets still differ, and the triangles of its fan
 * look the way their sheet does, so that nothing folds over. It may lie outside the cell: where an
 * edge of the solid runs through cells without a corner inside, a neighbour's polygon reaches
 * there.
 */
#include "mesh/features/apex.h"

#include <math.h>
#include <string.h>

#include "mesh/features/cut.h"

enum { MOST_SHEETS = CSG_FEATURE_MOST_SHEETS, STEPS = 6, MOST = CSG_FEATURE_MOST_WALKS };

typedef csg_feature_polygon polygon;
typedef csg_apex apex;

/* Cells: how far from the polygon's middle an apex may lie, and what |f| may be there. */
static const double REACH = 3, ZERO = 1e-3;
/* 1 - cos of the angle between sheets next to each other at an apex: 0.8 degrees. */
static const double LEAST_ANGLE = 1e-4;
/* Of two planes that meet in a line: sin^2 of 0.6 degrees. */
static const double LEAST_SINE_SQUARE = 1e-4;

/* ---- planes ------------------------------------------------------------------------------------
 */

csg_plane csg_plane_at(float x, float y, float z, float f, float gx, float gy, float gz)
{
    return csg_plane_of(csg_vec3_make((double)x, (double)y, (double)z), (double)f,
                        csg_vec3_make((double)gx, (double)gy, (double)gz));
}

/* Solves the system whose symmetric matrix has the rows m by its adjugate; false where it is all
 * but singular. */
static bool solve3(const csg_vec3 m[3], csg_vec3 b, csg_vec3 *s)
{
    csg_vec3 c[3] = {csg_vec3_cross(m[1], m[2]), csg_vec3_cross(m[2], m[0]),
                     csg_vec3_cross(m[0], m[1])};
    double determinant = csg_vec3_dot(m[0], c[0]), trace = m[0].x + m[1].y + m[2].z;
    if (!(fabs(determinant) > 1e-7 * trace * trace * trace))
        return false;
    *s = csg_vec3_make(csg_vec3_dot(c[0], b) / determinant, csg_vec3_dot(c[1], b) / determinant,
                       csg_vec3_dot(c[2], b) / determinant);
    return true;
}

bool csg_planes_meet(const csg_plane *planes, int count, csg_vec3 *x)
{
    if (count == 2)
        return csg_planes_meet_in_line(planes, LEAST_SINE_SQUARE, x);
    csg_vec3 m[3] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}, b = {0, 0, 0}, s;
    for (int k = 0; k < count; k++) {
        csg_vec3 g = planes[k].g;
        b = csg_vec3_add(b, csg_vec3_scale(g, planes[k].d - csg_vec3_dot(g, *x)));
        m[0] = csg_vec3_add(m[0], csg_vec3_scale(g, g.x));
        m[1] = csg_vec3_add(m[1], csg_vec3_scale(g, g.y));
        m[2] = csg_vec3_add(m[2], csg_vec3_scale(g, g.z));
    }
    if (!solve3(m, b, &s))
        return false;
    *x = csg_vec3_add(*x, s);
    return true;
}

/* ---- an apex on its way ------------------------------------------------------------------------
 */

void csg_feature_find_middles(polygon *p)
{
    double count[MOST_SHEETS] = {0};
    memset(p->toward, 0, sizeof p->toward);
    memset(&p->middle, 0, sizeof p->middle);
    for (int s = 0; s < p->sides; s++) {
        csg_vec3 *toward = &p->toward[p->sheet[s]];
        count[p->sheet[s]]++;
        p->middle = csg_vec3_add(p->middle, csg_vec3_scale(p->corner[s], 1.0 / p->sides));
        *toward = csg_vec3_add(*toward, p->corner[s]);
    }
    for (int k = 0; k < p->sheets; k++)
        p->toward[k] = csg_vec3_scale(p->toward[k], 1 / (count[k] > 0 ? count[k] : 1));
}

/* The point a little off the apex where a sheet shows itself: along the sheet to its corners. */
static csg_vec3 sheet_point(const polygon *p, const apex *a, int sheet, double off)
{
    csg_vec3 g = a->planes[sheet].g, way = csg_vec3_sub(p->toward[sheet], a->at);
    double along = csg_vec3_dot(way, g) / fmax(csg_vec3_dot(g, g), 1e-30);
    way = csg_vec3_sub(way, csg_vec3_scale(g, along));
    double length = csg_vec3_norm(way);
    double k = length > 1e-9 * off ? fmin(off, 0.9 * length) / length : 0;
    return csg_vec3_add(a->at, csg_vec3_scale(way, k));
}

/* Whether a gradient is that of its sheet and not of another one: a point too near to the crease
 * may lie beyond it, then the plane before stays. */
static bool is_still(const polygon *p, const apex *a, int sheet, csg_vec3 g)
{
    double length = csg_vec3_norm(g), own = 0, other = -2;
    if (!(length > 1e-3) || !p->creased) /* round a tip all sheets are one */
        return length > 1e-3;
    for (int k = 0; k < p->sheets; k++) {
        csg_vec3 h = a->planes[k].g;
        double cosine = csg_vec3_dot(g, h) / (length * csg_vec3_norm(h));
        if (k == sheet)
            own = cosine;
        else
            other = fmax(other, cosine);
    }
    return own >= other;
}

/* |f| is below this, times how far off the apex a place is, where it is said to be of a sheet. */
static const double SHOWN = 0.3;

/* Whether |f| can be little enough in some place `off` the apex, where it is at least f in q: it
 * falls no faster than the Lipschitz constant says. */
static bool may_be_around(const csg_feature_probe *probe, const apex *a, csg_vec3 q, double f,
                          double off)
{
    const csg_tape *tape = &probe->marching->field->tape;
    double slack = (double)probe->marching->noise + (double)tape->waver;
    double way = csg_vec3_norm(csg_vec3_sub(q, a->at)) + off;
    return !(f - 1.01 * (double)tape->lipschitz * way - 2 * slack > SHOWN * off);
}

/* A sheet that does not show itself towards its corners may do so elsewhere round the apex: where a
 * corner bends inwards, or lies in another cell. False: it does not. */
static bool look_around(const polygon *p, const apex *a, int sheet, double off,
                        csg_feature_probe *probe, csg_plane *out)
{
    enum { WAYS = 8 };
    float x[WAYS], y[WAYS], z[WAYS], f[WAYS], gx[WAYS], gy[WAYS], gz[WAYS];
    csg_vec3 n = csg_vec3_normalize(a->planes[sheet].g);
    csg_vec3 side = fabs(n.x) < 0.7 ? csg_vec3_make(1, 0, 0) : csg_vec3_make(0, 1, 0);
    csg_vec3 u = csg_vec3_normalize(csg_vec3_cross(n, side)), v = csg_vec3_cross(n, u);
    static const double turn[WAYS][2] = {{1, 0},  {0.7, 0.7},   {0, 1},  {-0.7, 0.7},
                                         {-1, 0}, {-0.7, -0.7}, {0, -1}, {0.7, -0.7}};
    for (int i = 0; i < WAYS; i++) {
        csg_vec3 way = csg_vec3_add(csg_vec3_scale(u, turn[i][0]), csg_vec3_scale(v, turn[i][1]));
        csg_vec3 q = csg_vec3_add(a->at, csg_vec3_scale(way, off));
        x[i] = (float)q.x, y[i] = (float)q.y, z[i] = (float)q.z;
    }
    csg_feature_probe_points(probe, x, y, z, WAYS, f, (float *const[3]){gx, gy, gz});
    double least = SHOWN * off;
    bool found = false;
    for (int i = 0; i < WAYS; i++) {
        csg_plane plane = csg_plane_at(x[i], y[i], z[i], f[i], gx[i], gy[i], gz[i]);
        if (!(fabs((double)f[i]) < least) || !is_still(p, a, sheet, plane.g))
            continue;
        least = fabs((double)f[i]);
        *out = plane;
        found = true;
    }
    return found;
}

/* Asks for all sheets of all apexes at once, but those that are done. */
static void sample_sheets(const csg_apex_walk *walks, int count, double off, bool last,
                          const bool *is_done, csg_feature_probe *probe)
{
    float x[MOST * MOST_SHEETS] = {0}, y[MOST * MOST_SHEETS] = {0}, z[MOST * MOST_SHEETS] = {0};
    float f[MOST * MOST_SHEETS], gx[MOST * MOST_SHEETS], gy[MOST * MOST_SHEETS],
        gz[MOST * MOST_SHEETS];
    float *const g[3] = {gx, gy, gz};
    const csg_apex_walk *walk[MOST * MOST_SHEETS];
    csg_plane fresh[MOST * MOST_SHEETS];
    int sheet[MOST * MOST_SHEETS];
    size_t n = 0;
    for (int k = 0; k < count; k++)
        for (int s = 0; s < walks[k].polygon->sheets && !walks[k].apex->lost && !is_done[k];
             s++, n++) {
            csg_vec3 q = sheet_point(walks[k].polygon, walks[k].apex, s, off);
            x[n] = (float)q.x, y[n] = (float)q.y, z[n] = (float)q.z;
            walk[n] = &walks[k];
            sheet[n] = s;
        }
    csg_feature_probe_points(probe, x, y, z, n, f, g);
    /* beyond a cell's edge from the surface a pruned tape knows the sign alone */
    const double band = 0.9 * probe->marching->lattice->cell_size;
    for (size_t i = 0; i < n; i++) {
        const polygon *p = walk[i]->polygon;
        apex *a = walk[i]->apex;
        csg_plane plane = csg_plane_at(x[i], y[i], z[i], f[i], gx[i], gy[i], gz[i]);
        a->lost |= f[i] != f[i];
        bool still = fabs((double)f[i]) <= band && is_still(p, a, sheet[i], plane.g);
        fresh[i] = still ? plane : a->planes[sheet[i]];
        if (!still && !a->lost && p->creased &&
            may_be_around(probe, a, csg_vec3_make((double)x[i], (double)y[i], (double)z[i]),
                          fmin(fabs((double)f[i]), band), off))
            still = look_around(p, a, sheet[i], off, probe, &fresh[i]);
        a->lost |= last && !still;
    }
    for (size_t i = 0; i < n; i++)
        walk[i]->apex->planes[sheet[i]] = fresh[i];
}

/* Twice the area, seen from outside the sheet, of the triangle from x to side s of the polygon. */
static double area_from(const polygon *p, csg_vec3 g, int s, csg_vec3 x)
{
    csg_vec3 u = csg_vec3_sub(p->corner[s], x);
    csg_vec3 v = csg_vec3_sub(p->corner[(s + 1) % p->sides], x);
    return -csg_vec3_dot(csg_vec3_cross(u, v), g) / csg_vec3_norm(g); /* g looks inwards */
}

/* Along a straight crease the triangles of the fan all look outwards in an interval: moves the apex
 * to the nearest place in it, a tenth of its length (and not more than of a cell) from its ends. */
static void slide(const polygon *p, apex *a, double cell)
{
    csg_vec3 d = csg_vec3_normalize(csg_vec3_cross(a->planes[0].g, a->planes[1].g));
    csg_vec3 x = csg_vec3_add(a->at, d);
    double low = -REACH * cell, high = REACH * cell;
    for (int s = 0; s < p->sides; s++) {
        if (p->creased >> s & 1)
            continue;
        double here = area_from(p, a->planes[p->sheet[s]].g, s, a->at);
        double slope = area_from(p, a->planes[p->sheet[s]].g, s, x) - here;
        if (slope > 0)
            low = fmax(low, -here / slope);
        else if (slope < 0)
            high = fmin(high, -here / slope);
    }
    double margin = 0.1 * fmin(high - low, cell);
    double t = fmin(fmax(0, low + margin), high - margin);
    if (low < high && t != 0)
        a->at = csg_vec3_add(a->at, csg_vec3_scale(d, t));
}

static bool near_polygon(const polygon *p, const apex *a, double cell)
{
    csg_vec3 way = csg_vec3_sub(a->at, p->middle);
    return csg_vec3_dot(way, way) <= REACH * REACH * cell * cell; /* false for NaN */
}

void csg_apex_meet(const polygon *p, apex *a, double cell)
{
    a->lost =
        a->lost || !csg_planes_meet(a->planes, p->sheets, &a->at) || !near_polygon(p, a, cell);
}

/* Cells off the apex, step by step. */
static const double OFF[STEPS] = {0.3, 0.1, 0.03, 0.01, 0.003, 0.001};

/* Whether the sheets have the gradients that they had before: sin^2 of 3e-6. */
static bool are_same(const polygon *p, const apex *before, const apex *now)
{
    static const double MOST_SINE_SQUARE = 1e-11;
    for (int s = 0; s < p->sheets; s++) {
        csg_vec3 g = before->planes[s].g, h = now->planes[s].g, c = csg_vec3_cross(g, h);
        double square = csg_vec3_dot(g, g) * csg_vec3_dot(h, h);
        if (!(csg_vec3_dot(c, c) <= MOST_SINE_SQUARE * square && csg_vec3_dot(g, h) > 0))
            return false;
    }
    return true;
}

/* Plane sheets meet where their planes do, and nothing is gained by steps: where each shows the
 * plane that it began with right beside the apex, as near as the last step looks, that is it. The
 * other apexes stay as they are. */
static void meet_planes(const csg_apex_walk *walks, int count, double cell,
                        csg_feature_probe *probe, bool *is_done)
{
    const double off = OFF[STEPS - 1] * cell;
    apex before[MOST];
    csg_vec3 from[MOST];
    bool is_left_out[MOST] = {false};
    for (int k = 0; k < count; k++) {
        apex *a = walks[k].apex;
        is_left_out[k] = !walks[k].is_plane || a->lost;
        if (is_left_out[k])
            continue;
        before[k] = *a;
        if (walks[k].slides)
            slide(walks[k].polygon, a, cell);
        from[k] = a->at;
    }
    sample_sheets(walks, count, off, true, is_left_out, probe);
    for (int k = 0; k < count; k++) {
        apex *a = walks[k].apex;
        if (is_left_out[k])
            continue;
        csg_apex_meet(walks[k].polygon, a, cell);
        is_done[k] = !a->lost && are_same(walks[k].polygon, &before[k], a) &&
                     csg_vec3_norm(csg_vec3_sub(a->at, from[k])) < off;
        if (!is_done[k])
            *a = before[k];
    }
}

void csg_apexes_improve(const csg_apex_walk *walks, int count, double cell,
                        csg_feature_probe *probe)
{
    bool is_done[MOST] = {false};
    meet_planes(walks, count, cell, probe, is_done);
    for (int step = 0; step < STEPS; step++) {
        sample_sheets(walks, count, OFF[step] * cell, step >= STEPS - 2, is_done, probe);
        for (int k = 0; k < count; k++) {
            const csg_apex_walk *s = &walks[k];
            if (is_done[k])
                continue;
            csg_apex_meet(s->polygon, s->apex, cell);
            if (s->slides && !s->apex->lost && step < 2)
                slide(s->polygon, s->apex, cell);
        }
    }
}

/* ---- is it one? --------------------------------------------------------------------------------
 */

static bool sheets_differ(const polygon *p, const apex *a)
{
    int neighbours = p->sheets == 2 ? 1 : p->sheets;
    double widest = 0;
    for (int s = 0; s < neighbours; s++) {
        csg_vec3 g = a->planes[s].g, h = a->planes[(s + 1) % p->sheets].g;
        double one_less = 1 - csg_vec3_dot(g, h) / sqrt(csg_vec3_dot(g, g) * csg_vec3_dot(h, h));
        widest = fmax(widest, one_less);
        if (!(one_less > LEAST_ANGLE))
            return false;
    }
    return p->creased || widest > 0.03; /* a tip: 14 degrees between corners */
}

/* Inwards, as gradients are, by the area of the polygon: where a field has no gradient, as at a
 * critical point or on the axis of what has been dropped. */
static csg_vec3 polygon_gradient(const csg_feature *f)
{
    csg_vec3 sum = {0, 0, 0}, first = csg_vec3_from_floats(f->side[0].corner), last = {0, 0, 0};
    for (int s = 1; s < f->side_count; s++) {
        csg_vec3 way = csg_vec3_sub(csg_vec3_from_floats(f->side[s].corner), first);
        sum = csg_vec3_add(sum, csg_vec3_cross(way, last)); /* last x way looks outwards */
        last = way;
    }
    return csg_vec3_norm(sum) > 0 ? sum : csg_vec3_make(0, 0, -1);
}

void csg_apex_place(const polygon *p, const apex *a, csg_feature *out)
{
    out->at[0] = (float)a->at.x, out->at[1] = (float)a->at.y, out->at[2] = (float)a->at.z;
    for (int k = 0; k < p->sheets; k++) {
        csg_vec3 g = a->planes[k].g;
        double length = csg_vec3_norm(g); /* adding 0 makes every zero positive */
        if (!(length > 0 && length < INFINITY)) {
            g = polygon_gradient(out);
            length = csg_vec3_norm(g);
        }
        out->normal[k][0] = (float)(-g.x / length) + 0.0f;
        out->normal[k][1] = (float)(-g.y / length) + 0.0f;
        out->normal[k][2] = (float)(-g.z / length) + 0.0f;
    }
}

void csg_apexes_ask(const csg_apex_walk *walks, int count, csg_feature_probe *probe, float *f)
{
    float x[MOST] = {0}, y[MOST] = {0}, z[MOST] = {0}, g[3][MOST];
    for (int k = 0; k < count; k++) {
        const apex *a = walks[k].apex;
        csg_vec3 at = a->lost ? walks[k].polygon->middle : a->at;
        x[k] = (float)at.x, y[k] = (float)at.y, z[k] = (float)at.z;
    }
    csg_feature_probe_points(probe, x, y, z, (size_t)count, f, (float *const[3]){g[0], g[1], g[2]});
}

const apex *csg_apexes_choose(const polygon *p, const apex *apexes, const float *f, int count,
                              const csg_marching *m, csg_feature *out)
{
    double zero = ZERO * m->lattice->cell_size + 4 * (double)m->noise;
    const apex *first = NULL;
    for (int k = 0; k < count; k++) {
        if (apexes[k].lost || !(fabs((double)f[k]) <= zero) || !sheets_differ(p, &apexes[k]))
            continue;
        first = first ? first : &apexes[k];
        csg_apex_place(p, &apexes[k], out);
        bool looks_out = csg_feature_cut(NULL, m->tables, out, out->triangle);
        csg_feature_enter(out, looks_out ? CSG_FEATURE_SOLVED : CSG_FEATURE_FOLDED);
        if (looks_out)
            return &apexes[k];
    }
    if (first && first != &apexes[count - 1])
        csg_apex_place(p, first, out);
    return first;
}

bool csg_apex_find(const polygon *p, apex *a, csg_feature_probe *probe, csg_feature *out)
{
    const csg_marching *m = probe->marching;
    double cell = m->lattice->cell_size;
    const csg_apex_walk walk = {p, a, false, out->is_plane};
    float f;
    csg_apex_meet(p, a, cell);
    csg_apexes_improve(&walk, 1, cell, probe);
    csg_apexes_ask(&walk, 1, probe, &f);
    return csg_apexes_choose(p, a, &f, 1, m, out) != NULL;
}
