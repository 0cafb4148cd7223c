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
#include "mesh/feature_solve.h"

#include <math.h>
#include <string.h>

enum {
    MOST_SHEETS = CSG_FEATURE_MOST_SHEETS,
    MOST_SIDES = CSG_FEATURE_MOST_SIDES,
    STEPS = 6,
    MOST_STARTS = 4
};

/* Cells: how far from the polygon's middle an apex may lie, and what |f| may be there. */
static const double REACH = 3, ZERO = 1e-3;
/* 1 - cos of the angle between sheets next to each other at an apex: 0.8 degrees. */
static const double LEAST_ANGLE = 1e-4;

/* ---- planes ------------------------------------------------------------------------------------
 */

static double dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

csg_plane csg_plane_at(float x, float y, float z, float f, float gx, float gy, float gz)
{
    csg_plane p = {.g = {(double)gx, (double)gy, (double)gz}};
    const double at[3] = {(double)x, (double)y, (double)z};
    p.d = dot(p.g, at) - (double)f;
    return p;
}

/* Solves the symmetric 3 x 3 system m s = b by its adjugate; false where it is all but singular. */
static bool solve3(const double m[3][3], const double b[3], double s[3])
{
    double c[3][3];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
            c[i][j] = m[i1][j1] * m[i2][j2] - m[i1][j2] * m[i2][j1];
        }
    double determinant = dot(m[0], c[0]), trace = m[0][0] + m[1][1] + m[2][2];
    if (!(fabs(determinant) > 1e-7 * trace * trace * trace))
        return false;
    for (int i = 0; i < 3; i++)
        s[i] = (c[0][i] * b[0] + c[1][i] * b[1] + c[2][i] * b[2]) / determinant;
    return true;
}

static bool meet_two(const csg_plane *p, double x[3])
{
    double a = dot(p[0].g, p[0].g), b = dot(p[0].g, p[1].g), c = dot(p[1].g, p[1].g);
    double r0 = p[0].d - dot(p[0].g, x), r1 = p[1].d - dot(p[1].g, x);
    double determinant = a * c - b * b;
    if (!(determinant > 1e-4 * a * c)) /* sin^2 of 0.6 degrees */
        return false;
    double s = (c * r0 - b * r1) / determinant, t = (a * r1 - b * r0) / determinant;
    for (int i = 0; i < 3; i++)
        x[i] += s * p[0].g[i] + t * p[1].g[i];
    return true;
}

bool csg_planes_meet(const csg_plane *planes, int count, double x[3])
{
    if (count == 2)
        return meet_two(planes, x);
    double m[3][3] = {{0}}, b[3] = {0}, s[3];
    for (int k = 0; k < count; k++) {
        double rest = planes[k].d - dot(planes[k].g, x);
        for (int i = 0; i < 3; i++) {
            b[i] += planes[k].g[i] * rest;
            for (int j = 0; j < 3; j++)
                m[i][j] += planes[k].g[i] * planes[k].g[j];
        }
    }
    if (!solve3((const double(*)[3])m, b, s))
        return false;
    for (int i = 0; i < 3; i++)
        x[i] += s[i];
    return true;
}

/* ---- an apex on its way ------------------------------------------------------------------------
 */

/* A polygon, whole or a piece of one, and its sheets. */
typedef struct polygon {
    int sides, sheets;
    double corner[MOST_SIDES][3];
    uint8_t edge[MOST_SIDES], sheet[MOST_SIDES];
    uint16_t creased;
    double middle[3], toward[MOST_SHEETS][3]; /* toward: the mean of a sheet's corners */
    double start[MOST_STARTS][3];             /* where to look for the apex, best first */
    int start_count;
} polygon;

typedef struct apex {
    double at[3];
    csg_plane planes[MOST_SHEETS];
    bool lost;
} apex;

/* The point a little off the apex where a sheet shows itself: along the sheet to its corners. */
static void sheet_point(const polygon *p, const apex *a, int sheet, double off, double out[3])
{
    double way[3], along, length;
    const double *g = a->planes[sheet].g;
    for (int i = 0; i < 3; i++)
        way[i] = p->toward[sheet][i] - a->at[i];
    along = dot(way, g) / fmax(dot(g, g), 1e-30);
    for (int i = 0; i < 3; i++)
        way[i] -= along * g[i];
    length = sqrt(dot(way, way));
    double k = length > 1e-9 * off ? fmin(off, 0.9 * length) / length : 0;
    for (int i = 0; i < 3; i++)
        out[i] = a->at[i] + k * way[i];
}

/* Whether a gradient is that of its sheet and not of another one: a point too near to the crease
 * may lie beyond it, then the plane before stays. */
static bool is_still(const polygon *p, const apex *a, int sheet, const double *g)
{
    double length = sqrt(dot(g, g)), own = 0, other = -2;
    if (!(length > 1e-3) || !p->creased) /* round a tip all sheets are one */
        return length > 1e-3;
    for (int k = 0; k < p->sheets; k++) {
        const double *h = a->planes[k].g;
        double cosine = dot(g, h) / (length * sqrt(dot(h, h)));
        if (k == sheet)
            own = cosine;
        else
            other = fmax(other, cosine);
    }
    return own >= other;
}

/* Asks for all sheets of all starts at once. */
static void sample_sheets(const polygon *p, apex *apexes, double off, bool last,
                          csg_feature_probe *probe)
{
    enum { MOST = MOST_STARTS * MOST_SHEETS };
    float x[MOST] = {0}, y[MOST] = {0}, z[MOST] = {0}, f[MOST], gx[MOST], gy[MOST], gz[MOST];
    float *const g[3] = {gx, gy, gz};
    apex *owner[MOST];
    csg_plane fresh[MOST];
    int sheet[MOST];
    size_t n = 0;
    for (int k = 0; k < p->start_count; k++)
        for (int s = 0; s < p->sheets && !apexes[k].lost; s++, n++) {
            double q[3];
            sheet_point(p, &apexes[k], s, off, q);
            x[n] = (float)q[0], y[n] = (float)q[1], z[n] = (float)q[2];
            owner[n] = &apexes[k];
            sheet[n] = s;
        }
    csg_feature_probe_points(probe, x, y, z, n, f, g);
    /* beyond a cell's edge from the surface a pruned tape knows the sign alone */
    const double band = 0.9 * probe->marching->lattice->cell_size;
    for (size_t i = 0; i < n; i++) {
        csg_plane plane = csg_plane_at(x[i], y[i], z[i], f[i], gx[i], gy[i], gz[i]);
        owner[i]->lost |= f[i] != f[i];
        bool still = fabs((double)f[i]) <= band && is_still(p, owner[i], sheet[i], plane.g);
        fresh[i] = still ? plane : owner[i]->planes[sheet[i]];
        owner[i]->lost |= last && !still;
    }
    for (size_t i = 0; i < n; i++)
        owner[i]->planes[sheet[i]] = fresh[i];
}

/* Twice the area, seen from outside the sheet, of the triangle from x to side s of the polygon. */
static double area_from(const polygon *p, const double *g, int s, const double x[3])
{
    const double *u = p->corner[s], *v = p->corner[(s + 1) % p->sides];
    double e[3], d[3];
    for (int i = 0; i < 3; i++) {
        e[i] = u[i] - x[i];
        d[i] = v[i] - x[i];
    }
    const double cross[3] = {e[1] * d[2] - e[2] * d[1], e[2] * d[0] - e[0] * d[2],
                             e[0] * d[1] - e[1] * d[0]};
    return -dot(cross, g) / sqrt(dot(g, g)); /* g looks inwards */
}

/* Along a straight crease the triangles of the fan all look outwards in an interval: moves the apex
 * to the nearest place in it, a tenth of its length (and not more than of a cell) from its ends. */
static void slide(const polygon *p, apex *a, double cell)
{
    const double *g = a->planes[0].g, *h = a->planes[1].g;
    double d[3] = {g[1] * h[2] - g[2] * h[1], g[2] * h[0] - g[0] * h[2], g[0] * h[1] - g[1] * h[0]};
    double length = sqrt(dot(d, d)), low = -REACH * cell, high = REACH * cell, x[3];
    for (int i = 0; i < 3; i++)
        x[i] = a->at[i] + d[i] / length;
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
    if (!(low < high) || t == 0)
        return;
    for (int i = 0; i < 3; i++)
        a->at[i] += t * d[i] / length;
}

static bool near_polygon(const polygon *p, const apex *a, double cell)
{
    double way[3] = {a->at[0] - p->middle[0], a->at[1] - p->middle[1], a->at[2] - p->middle[2]};
    return dot(way, way) <= REACH * REACH * cell * cell; /* false for NaN */
}

static void improve(const polygon *p, apex *apexes, double cell, csg_feature_probe *probe)
{
    static const double off[STEPS] = {0.3, 0.1, 0.03, 0.01, 0.003, 0.001};
    for (int step = 0; step < STEPS; step++) {
        sample_sheets(p, apexes, off[step] * cell, step >= STEPS - 2, probe);
        for (int k = 0; k < p->start_count; k++) {
            apexes[k].lost = apexes[k].lost ||
                             !csg_planes_meet(apexes[k].planes, p->sheets, apexes[k].at) ||
                             !near_polygon(p, &apexes[k], cell);
            if (!apexes[k].lost && p->start_count > 1 && k == 0 && p->sheets == 2 && step < 2)
                slide(p, &apexes[k], cell);
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
        const double *g = a->planes[s].g, *h = a->planes[(s + 1) % p->sheets].g;
        double one_less = 1 - dot(g, h) / sqrt(dot(g, g) * dot(h, h));
        widest = fmax(widest, one_less);
        if (!(one_less > LEAST_ANGLE))
            return false;
    }
    return p->creased || widest > 0.03; /* a tip: 14 degrees between corners */
}

/* ---- triangles -------------------------------------------------------------------------------
 */

/* A piece of a sheet: the apex and the sheet's corners in their order. */
typedef struct piece {
    const polygon *p;
    const apex *a;
    const csg_cell_tables *tables;
    int count; /* of corners; [0] is the apex */
    int corner[MOST_SIDES + 1];
    double g[3];
} piece;

static void position_of(const piece *q, int i, double out[3])
{
    memcpy(out, i ? q->p->corner[q->corner[i]] : q->a->at, 3 * sizeof *out);
}

static bool looks_out(const piece *q, int i, int j, int k)
{
    double x[3], y[3], z[3], e[3], d[3];
    position_of(q, i, x);
    position_of(q, j, y);
    position_of(q, k, z);
    for (int c = 0; c < 3; c++) {
        e[c] = y[c] - x[c];
        d[c] = z[c] - x[c];
    }
    const double cross[3] = {e[1] * d[2] - e[2] * d[1], e[2] * d[0] - e[0] * d[2],
                             e[0] * d[1] - e[1] * d[0]};
    return dot(cross, q->g) < 0; /* g looks inwards */
}

/* A diagonal in a face of the cell could be the neighbour's too: see tables.c. */
static bool is_in_face(const piece *q, int i, int j)
{
    const polygon *p = q->p;
    return i && j &&
           (q->tables->faces[p->edge[q->corner[i]]] & q->tables->faces[p->edge[q->corner[j]]]) != 0;
}

/* Cuts the polygon first..last of the piece into triangles that all look out, those at the apex
 * preferred. The side first-last is there already. */
static bool cut(const piece *q, int first, int last, csg_feature *out)
{
    if (last - first < 2)
        return true;
    uint8_t before = out->triangle_count;
    for (int middle = last - 1; middle > first; middle--) {
        if ((middle - first > 1 && is_in_face(q, first, middle)) ||
            (last - middle > 1 && is_in_face(q, middle, last)) ||
            !looks_out(q, first, middle, last))
            continue;
        uint8_t *t = out->triangle[out->triangle_count++];
        const int corner[3] = {first, middle, last};
        for (int c = 0; c < 3; c++)
            t[c] = corner[c] ? (uint8_t)q->corner[corner[c]] : CSG_FEATURE_APEX;
        if (cut(q, first, middle, out) && cut(q, middle, last, out))
            return true;
        out->triangle_count = before;
    }
    return false;
}

/* The triangles of all sheets; false where one of them would fold over. */
static bool cut_sheets(const polygon *p, const apex *a, const csg_cell_tables *tables,
                       csg_feature *out)
{
    out->triangle_count = 0;
    if (!p->creased) { /* round a tip: each side with the apex */
        for (int s = 0; s < p->sides; s++) {
            const uint8_t fan[3] = {CSG_FEATURE_APEX, (uint8_t)s, (uint8_t)((s + 1) % p->sides)};
            memcpy(out->triangle[out->triangle_count++], fan, 3);
            if (!(area_from(p, a->planes[s].g, s, a->at) > 0))
                return false;
        }
        return true;
    }
    for (int s = 0; s < p->sides; s++) {
        if (!(p->creased >> s & 1))
            continue;
        piece q = {.p = p, .a = a, .tables = tables, .count = 1};
        int k = (s + 1) % p->sides; /* the run that begins behind this crease */
        memcpy(q.g, a->planes[p->sheet[k]].g, sizeof q.g);
        for (q.corner[q.count++] = k; !(p->creased >> k & 1); q.corner[q.count++] = k)
            k = (k + 1) % p->sides;
        if (!cut(&q, 0, q.count - 1, out))
            return false;
    }
    return true;
}

/* The first start whose apex holds good; NULL: none. */
static const apex *choose(const polygon *p, const apex *apexes, double cell,
                          csg_feature_probe *probe, csg_feature *out)
{
    float x[MOST_STARTS], y[MOST_STARTS], z[MOST_STARTS], f[MOST_STARTS], g[3][MOST_STARTS];
    float *const gradient[3] = {g[0], g[1], g[2]};
    for (int k = 0; k < p->start_count; k++) {
        const double *at = apexes[k].lost ? p->middle : apexes[k].at;
        x[k] = (float)at[0], y[k] = (float)at[1], z[k] = (float)at[2];
    }
    csg_feature_probe_points(probe, x, y, z, (size_t)p->start_count, f, gradient);
    double zero = ZERO * cell + 4 * (double)probe->marching->noise;
    for (int k = 0; k < p->start_count; k++)
        if (!apexes[k].lost && fabs((double)f[k]) <= zero && sheets_differ(p, &apexes[k]) &&
            cut_sheets(p, &apexes[k], probe->marching->tables, out))
            return &apexes[k];
    return NULL;
}

/* ---- polygons ----------------------------------------------------------------------------------
 */

/* Sheets are runs of corners between creases; without creases, round a tip, each corner. */
static bool mark_sheets(const csg_feature_room *room, const csg_found_loop *loop, polygon *p)
{
    *p = (polygon){.sides = loop->side_count};
    int creases = 0, first = 0;
    for (int s = 0; s < p->sides; s++)
        if (loop->crease[s] >= 0) {
            p->creased |= (uint16_t)(1u << s);
            first = creases++ ? first : s + 1;
        }
    if (creases == 1)
        return false;
    int sheet = 0;
    for (int k = 0; k < p->sides; k++) {
        int s = (first + k) % p->sides;
        for (int i = 0; i < 3; i++)
            p->corner[s][i] = (double)room->slots.at[loop->slot[s]][i];
        p->edge[s] = loop->edge[s];
        p->sheet[s] = (uint8_t)sheet;
        sheet += !creases || (p->creased >> s & 1);
    }
    p->sheets = creases ? creases : p->sides;
    return p->sheets <= MOST_SHEETS;
}

static void find_middles(polygon *p)
{
    double count[MOST_SHEETS] = {0};
    memset(p->toward, 0, sizeof p->toward);
    memset(p->middle, 0, sizeof p->middle);
    for (int s = 0; s < p->sides; s++) {
        count[p->sheet[s]]++;
        for (int i = 0; i < 3; i++) {
            p->middle[i] += p->corner[s][i] / p->sides;
            p->toward[p->sheet[s]][i] += p->corner[s][i];
        }
    }
    for (int k = 0; k < p->sheets; k++)
        for (int i = 0; i < 3; i++)
            p->toward[k][i] /= count[k] > 0 ? count[k] : 1;
}

static void add_start(polygon *p, const double at[3])
{
    memcpy(p->start[p->start_count++], at, sizeof p->start[0]);
}

/* On a crease: between the places where it passes into the neighbours, or at one of these. */
static void choose_starts(const csg_feature_room *room, const csg_found_loop *loop, polygon *p)
{
    p->start_count = 0;
    if (p->sheets != 2) {
        add_start(p, p->middle);
        return;
    }
    double at[3][3] = {{0}};
    int n = 1;
    for (int s = 0; s < p->sides; s++) {
        if (!(p->creased >> s & 1))
            continue;
        const csg_segment *segment = &room->segments[loop->crease[s]];
        for (int i = 0; i < 3; i++) {
            at[n][i] = (double)segment->at[i];
            at[0][i] += at[n][i] / 2;
        }
        n++;
    }
    for (int k = 0; k < 3; k++)
        add_start(p, at[k]);
    add_start(p, at[0]); /* the first one slides */
}

/* The tangent planes at the corners in the middle of each run, to begin with. */
static void first_planes(const csg_feature_room *room, const csg_found_loop *loop, const polygon *p,
                         apex *a)
{
    int seen[MOST_SHEETS] = {0}, length[MOST_SHEETS] = {0};
    for (int s = 0; s < p->sides; s++)
        length[p->sheet[s]]++;
    for (int s = 0; s < p->sides; s++) {
        int k = p->sheet[s];
        if (seen[k]++ > length[k] / 2)
            continue;
        const float *at = room->slots.at[loop->slot[s]], *g = room->gradient[loop->slot[s]];
        a->planes[k] = csg_plane_at(at[0], at[1], at[2], 0, g[0], g[1], g[2]);
    }
}

static void place(const polygon *p, const apex *a, csg_feature *out)
{
    for (int i = 0; i < 3; i++)
        out->at[i] = (float)a->at[i];
    for (int k = 0; k < p->sheets; k++) {
        double length = sqrt(dot(a->planes[k].g, a->planes[k].g));
        for (int i = 0; i < 3; i++)
            out->normal[k][i] = (float)(-a->planes[k].g[i] / length) + 0.0f;
    }
}

static void record(const csg_found_loop *loop, const polygon *p, const apex *a, csg_feature *out)
{
    out->cell = loop->cell;
    out->loop = loop->loop;
    out->side_count = (uint8_t)p->sides;
    out->sheet_count = (uint8_t)p->sheets;
    out->creased = p->creased;
    out->flipped = 0;
    out->pattern = loop->pattern;
    out->vertex = 0;
    for (int s = 0; s < p->sides; s++) {
        for (int i = 0; i < 3; i++)
            out->corner[s][i] = (float)p->corner[s][i];
        out->edge[s] = p->edge[s];
        out->sheet[s] = p->sheet[s];
        out->beyond[s] = CSG_FEATURE_NONE;
    }
    place(p, a, out);
}

/* False where the polygon has no apex. */
static bool solve_polygon(const csg_feature_room *room, const csg_found_loop *loop, polygon *p,
                          csg_feature_probe *probe, csg_feature *out)
{
    double cell = probe->marching->lattice->cell_size;
    apex apexes[MOST_STARTS];
    memset(apexes, 0, sizeof apexes);
    find_middles(p);
    choose_starts(room, loop, p);
    for (int k = 0; k < p->start_count; k++) {
        memcpy(apexes[k].at, p->start[k], sizeof apexes[k].at);
        first_planes(room, loop, p, &apexes[k]);
        apexes[k].lost = !csg_planes_meet(apexes[k].planes, p->sheets, apexes[k].at) ||
                         !near_polygon(p, &apexes[k], cell);
    }
    improve(p, apexes, cell, probe);
    const apex *best = choose(p, apexes, cell, probe, out);
    if (best)
        record(loop, p, best, out);
    return best != NULL;
}

bool csg_feature_solve(csg_feature_room *room, const csg_found_loop *loop, csg_feature_probe *probe,
                       csg_memory *memory)
{
    polygon p;
    if (!csg_memory_reserve(memory, (void **)&room->features, &room->capacity, room->count + 1,
                            sizeof(csg_feature)))
        return false;
    bool good = mark_sheets(room, loop, &p);
    if (!p.creased && (!good || !loop->wide))
        return true;
    if (good && solve_polygon(room, loop, &p, probe, &room->features[room->count]))
        room->count++;
    else
        room->smooth += p.creased != 0;
    return true;
}

/* ---- order along a crease ----------------------------------------------------------------------
 */

/* The features before and after one on a crease; false for others. */
static bool neighbours_of(const csg_feature_store *store, const csg_feature *f,
                          const csg_feature *beside[2])
{
    int count = 0;
    for (int s = 0; s < f->side_count; s++)
        if (f->creased >> s & 1) {
            if (f->beyond[s] == CSG_FEATURE_NONE || count == 2)
                return false;
            beside[count++] = &store->features[f->beyond[s]];
        }
    return count == 2 && f->sheet_count == 2;
}

static void restore(const csg_feature *f, polygon *p, apex *a)
{
    *p = (polygon){.sides = f->side_count, .sheets = f->sheet_count, .creased = f->creased};
    for (int s = 0; s < p->sides; s++) {
        p->edge[s] = f->edge[s];
        p->sheet[s] = f->sheet[s];
        for (int i = 0; i < 3; i++)
            p->corner[s][i] = (double)f->corner[s][i];
    }
    find_middles(p);
    for (int k = 0; k < p->sheets; k++)
        a->planes[k] = csg_plane_at(f->at[0], f->at[1], f->at[2], 0, -f->normal[k][0],
                                    -f->normal[k][1], -f->normal[k][2]);
}

bool csg_feature_move(const csg_feature_store *store, uint32_t index, csg_feature_probe *probe,
                      csg_feature *out)
{
    const csg_feature *f = &store->features[index], *beside[2];
    if (!neighbours_of(store, f, beside))
        return false;
    double before[3], after[3], cell = probe->marching->lattice->cell_size;
    polygon p;
    apex a = {0};
    restore(f, &p, &a);
    for (int i = 0; i < 3; i++) {
        before[i] = (double)f->at[i] - (double)beside[0]->at[i];
        after[i] = (double)beside[1]->at[i] - (double)f->at[i];
        a.at[i] = ((double)beside[0]->at[i] + (double)beside[1]->at[i]) / 2;
    }
    if (dot(before, after) > 0)
        return false;
    p.start_count = 1;
    a.lost = !csg_planes_meet(a.planes, 2, a.at) || !near_polygon(&p, &a, cell);
    improve(&p, &a, cell, probe);
    *out = *f;
    if (!choose(&p, &a, cell, probe, out))
        return false;
    place(&p, &a, out);
    return true;
}
