/* SPDX-License-Identifier: MIT
 * Planes and steps; see sheets.h.
 */
#include "mesh/adaptive/sheets.h"

#include <math.h>
#include <string.h>

#include "mesh/plane.h"

enum { MOST = CSG_POLYGON_MOST_SHEETS, LANES = CSG_LANES };

/* Cosines: gradients that differ by 5 degrees may belong to two sheets; those of one polygon that
 * differ by 12 in all may go round a tip. */
static const double ONE_SHEET = 0.9962, ONE_POLYGON = 0.978;
/* Radians: two sheets whose angle would fall below 2 degrees where they meet are one. */
static const double LEAST_TURN = 0.035;
/* Of a cell: how far from its sides a place is kept; how far off the sheets are looked at; what |f|
 * may be there. */
static const double MARGIN = 0x1p-9, ZERO = 2e-3;
static const double OFF[] = {0.25, 0.08, 0.02, 0.005, 0.001};
enum { STEPS = sizeof OFF / sizeof *OFF };
/* Of two sheets that meet: sin^2 of 0.2 degrees. */
static const double LEAST_SINE_SQUARE = 1e-5;

typedef csg_plane plane;

double csg_gradients_cosine(csg_vec3 a, csg_vec3 b)
{
    double length = sqrt(csg_vec3_dot(a, a) * csg_vec3_dot(b, b));
    return length > 1e-150 ? csg_vec3_dot(a, b) / length : 1; /* whatever the unit */
}

/* Values and gradients at a few points. */
static void ask(csg_sheet_probe *p, const csg_vec3 *at, int count, double *f, csg_vec3 *g)
{
    float x[LANES], y[LANES], z[LANES], v[LANES], gx[LANES], gy[LANES], gz[LANES];
    for (int i = 0; i < LANES; i++) {
        const csg_vec3 *q = &at[i < count ? i : 0];
        x[i] = (float)q->x, y[i] = (float)q->y, z[i] = (float)q->z;
    }
    p->kernel->values(p->tape, x, y, z, (size_t)count, v, p->scratch, p->scratch_floats);
    p->kernel->gradients(p->tape, x, y, z, (size_t)count, gx, gy, gz, p->scratch,
                         p->scratch_floats);
    p->evaluations += (uint64_t)count;
    for (int i = 0; i < count; i++) {
        f[i] = (double)v[i];
        g[i] = csg_vec3_make((double)gx[i], (double)gy[i], (double)gz[i]);
    }
}

static double *component(csg_vec3 *v, int axis)
{
    return axis == 0 ? &v->x : axis == 1 ? &v->y : &v->z;
}

/* The nearest place in the box, `margin` from its sides where it has a width. */
static csg_vec3 keep_within(const csg_cell_box *box, csg_vec3 at, double margin)
{
    for (int axis = 0; axis < 3; axis++) {
        double *x = component(&at, axis), m = box->high[axis] > box->low[axis] ? margin : 0;
        *x = fmin(fmax(*x, box->low[axis] + m), box->high[axis] - m);
    }
    return at;
}

static double way_out(const csg_cell_box *box, csg_vec3 at)
{
    csg_vec3 kept = keep_within(box, at, 0), off = csg_vec3_sub(at, kept);
    return csg_vec3_norm(off);
}

/* ---- planes meet -------------------------------------------------------------------------------
 */

/* Least squares, drawn a little to where x was: what the planes leave open stays (Lindstrom 2000
 * cuts small singular values off instead). */
static bool meet_many(const plane *p, int count, csg_vec3 *x)
{
    csg_vec3 m[3] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}, b = {0, 0, 0};
    for (int k = 0; k < count; k++) {
        double n = csg_vec3_norm(p[k].g);
        if (!(n > 1e-6))
            continue;
        csg_vec3 g = csg_vec3_scale(p[k].g, 1 / n);
        double r = p[k].d / n - csg_vec3_dot(g, *x);
        b = csg_vec3_add(b, csg_vec3_scale(g, r));
        m[0] = csg_vec3_add(m[0], csg_vec3_scale(g, g.x));
        m[1] = csg_vec3_add(m[1], csg_vec3_scale(g, g.y));
        m[2] = csg_vec3_add(m[2], csg_vec3_scale(g, g.z));
    }
    double draw = 1e-6 * count;
    m[0].x += draw, m[1].y += draw, m[2].z += draw;
    csg_vec3 c[3] = {csg_vec3_cross(m[1], m[2]), csg_vec3_cross(m[2], m[0]),
                     csg_vec3_cross(m[0], m[1])};
    double determinant = csg_vec3_dot(m[0], c[0]);
    if (!(determinant > 0))
        return false;
    csg_vec3 s = csg_vec3_scale(
        csg_vec3_make(csg_vec3_dot(c[0], b), csg_vec3_dot(c[1], b), csg_vec3_dot(c[2], b)),
        1 / determinant);
    *x = csg_vec3_add(*x, s);
    return csg_vec3_dot(s, s) < INFINITY;
}

static bool meet(const plane *planes, int count, csg_vec3 *x)
{
    return count == 2 ? csg_planes_meet_in_line(planes, LEAST_SINE_SQUARE, x)
                      : meet_many(planes, count, x);
}

/* ---- coming closer -----------------------------------------------------------------------------
 */

/* The sheets around a place: a plane each, and where its vertices are. */
typedef struct sheets {
    int count;
    plane plane[MOST];
    csg_vec3 from[MOST]; /* where the plane was found */
    csg_vec3 toward[MOST];
} sheets;

/* A gradient that is more like another sheet's than its own was found beyond a crease. */
static bool is_own(const sheets *s, int sheet, csg_vec3 g)
{
    double own = csg_gradients_cosine(g, s->plane[sheet].g);
    if (!(csg_vec3_dot(g, g) > 1e-12))
        return false;
    for (int k = 0; k < s->count; k++)
        if (k != sheet && csg_gradients_cosine(g, s->plane[k].g) > own)
            return false;
    return true;
}

/* A point of each sheet, `off` from the place towards its vertices. */
static void look(csg_sheet_probe *p, const csg_cell_box *box, sheets *s, csg_vec3 at, double off,
                 int flat_axis)
{
    csg_vec3 q[MOST], g[MOST], from = keep_within(box, at, 0);
    double f[MOST];
    q[0] = from;
    for (int k = 0; k < s->count; k++) {
        csg_vec3 way = csg_vec3_sub(s->toward[k], from), n = s->plane[k].g;
        double square = csg_vec3_dot(n, n);
        if (square > 0 && flat_axis < 0)
            way = csg_vec3_sub(way, csg_vec3_scale(n, csg_vec3_dot(way, n) / square));
        double length = csg_vec3_norm(way), step = fmin(off * box->cell, 0.9 * length);
        q[k] = keep_within(
            box, csg_vec3_add(from, csg_vec3_scale(way, length > 0 ? step / length : 0)), 0);
    }
    ask(p, q, s->count, f, g);
    for (int k = 0; k < s->count; k++) {
        if (flat_axis >= 0)
            *component(&g[k], flat_axis) = 0;
        if (!is_own(s, k, g[k]))
            continue;
        s->plane[k] = csg_plane_of(q[k], f[k], g[k]);
        s->from[k] = q[k];
    }
}

/* By how much the gradients of two sheets differ, in radians, and how far apart they were found. */
typedef struct turn {
    double angle, distance;
} turn;

static turn turn_of(const sheets *s)
{
    double cosine = csg_gradients_cosine(s->plane[0].g, s->plane[1].g);
    return (turn){acos(fmin(fmax(cosine, -1), 1)),
                  csg_vec3_norm(csg_vec3_sub(s->from[1], s->from[0]))};
}

/* Whether two sheets are one that is curved: the angle falls with the distance, and nothing of it
 * would be left where they meet. */
static bool is_curved_only(turn before, turn now)
{
    double nearer = before.distance - now.distance;
    return nearer > 0.1 * before.distance &&
           now.angle - (before.angle - now.angle) * now.distance / nearer < LEAST_TURN;
}

/* Moves `at` to where the sheets meet. False: they do not, near the box. */
static bool come_closer(csg_sheet_probe *p, const csg_cell_box *box, sheets *s, csg_vec3 *at,
                        int flat_axis)
{
    if (!meet(s->plane, s->count, at))
        return false;
    turn first = turn_of(s);
    for (int step = 0; step < STEPS; step++) {
        csg_vec3 before = *at;
        if (!(way_out(box, *at) < box->cell))
            return false;
        look(p, box, s, *at, OFF[step], flat_axis);
        if (flat_axis >= 0 && is_curved_only(first, turn_of(s)))
            return false;
        if (!meet(s->plane, s->count, at))
            return false;
        csg_vec3 moved = csg_vec3_sub(*at, before);
        if (step > 0 && csg_vec3_norm(moved) < 1e-5 * box->cell)
            break; /* plane faces: there is nothing to learn from closer by */
    }
    return true;
}

static bool is_zero(csg_sheet_probe *p, const csg_cell_box *box, csg_vec3 at, double slope)
{
    double f;
    csg_vec3 g;
    ask(p, &at, 1, &f, &g);
    return fabs(f) <= ZERO * box->cell * slope + 4 * p->noise;
}

/* ---- in a face ---------------------------------------------------------------------------------
 */

bool csg_sheets_meet_in_face(csg_sheet_probe *p, const csg_cell_box *face,
                             const csg_surface_point ends[2], csg_vec3 *out)
{
    sheets s = {.count = 2};
    int axis = face->low[0] == face->high[0] ? 0 : face->low[1] == face->high[1] ? 1 : 2;
    for (int k = 0; k < 2; k++) {
        csg_vec3 g = ends[k].gradient;
        *component(&g, axis) = 0;
        s.plane[k] = csg_plane_of(ends[k].at, 0, g);
        s.from[k] = s.toward[k] = ends[k].at;
    }
    double slope = csg_vec3_norm(ends[0].gradient);
    if (csg_gradients_cosine(s.plane[0].g, s.plane[1].g) > ONE_SHEET)
        return false;
    csg_vec3 at = csg_vec3_scale(csg_vec3_add(ends[0].at, ends[1].at), 0.5);
    if (!come_closer(p, face, &s, &at, axis) ||
        csg_gradients_cosine(s.plane[0].g, s.plane[1].g) > ONE_SHEET)
        return false;
    *component(&at, axis) = face->low[axis];
    csg_vec3 kept = keep_within(face, at, MARGIN * face->cell);
    if (csg_vec3_norm(csg_vec3_sub(kept, at)) > MARGIN * face->cell ||
        !is_zero(p, face, kept, slope))
        return false;
    *out = kept;
    return true;
}

/* From between the points straight into the face, to where the sign is another one. */
static csg_vec3 step_beside(csg_sheet_probe *p, const csg_cell_box *face,
                            const csg_surface_point ends[2])
{
    enum { LOOKS = 6, HALVINGS = 6 };
    csg_vec3 from = csg_vec3_scale(csg_vec3_add(ends[0].at, ends[1].at), 0.5), way = {0, 0, 0}, g;
    for (int axis = 0; axis < 3; axis++) { /* the one along which neither ends nor face extend */
        double at = *component(&from, axis), low = face->low[axis], high = face->high[axis];
        if (low < high && (at == low || at == high))
            *component(&way, axis) = at == low ? face->cell : -face->cell;
    }
    double least = 0, most = 0, f, first;
    ask(p, &from, 1, &first, &g);
    for (int look = LOOKS; look > 0 && !(most > 0); look--) {
        double part = ldexp(0.9, 1 - look);
        csg_vec3 at = csg_vec3_add(from, csg_vec3_scale(way, part));
        ask(p, &at, 1, &f, &g);
        *((f >= 0) == (first >= 0) ? &least : &most) = part;
    }
    for (int halving = 0; halving < HALVINGS && most > 0; halving++) {
        double part = 0.5 * (least + most);
        csg_vec3 at = csg_vec3_add(from, csg_vec3_scale(way, part));
        ask(p, &at, 1, &f, &g);
        *((f >= 0) == (first >= 0) ? &least : &most) = part;
    }
    return csg_vec3_add(from, csg_vec3_scale(way, most > 0 ? most : 0.5));
}

csg_vec3 csg_wedge_in_face(csg_sheet_probe *p, const csg_cell_box *face,
                           const csg_surface_point ends[2])
{
    csg_vec3 at;
    if (csg_sheets_meet_in_face(p, face, ends, &at))
        return at;
    return keep_within(face, step_beside(p, face, ends), MARGIN * face->cell);
}

/* ---- in a cell ---------------------------------------------------------------------------------
 */

static csg_vec3 middle_of(const csg_polygon *polygon)
{
    csg_vec3 sum = {0, 0, 0};
    for (int i = 0; i < polygon->count; i++)
        sum = csg_vec3_add(sum, polygon->point[i].at);
    return csg_vec3_scale(sum, 1.0 / polygon->count);
}

/* Runs of vertices between crease points. False: too many. */
static bool gather_sheets(const csg_polygon *polygon, int creases, sheets *s)
{
    int n = polygon->count, first = 0, members[MOST] = {0};
    while (!polygon->is_crease[first])
        first++;
    s->count = creases;
    if (creases > MOST)
        return false;
    memset(s->toward, 0, sizeof s->toward);
    int sheet = -1;
    for (int i = 0; i < n; i++) {
        int v = (first + i) % n;
        if (polygon->is_crease[v]) {
            sheet++;
            continue;
        }
        s->toward[sheet] = csg_vec3_add(s->toward[sheet], polygon->point[v].at);
        members[sheet]++;
    }
    int seen[MOST] = {0};
    sheet = -1;
    for (int i = 0; i < n; i++) {
        int v = (first + i) % n;
        if (polygon->is_crease[v])
            sheet++;
        else if (seen[sheet]++ == members[sheet] / 2)
            s->plane[sheet] = csg_plane_of(polygon->point[v].at, 0, polygon->point[v].gradient);
    }
    for (int k = 0; k < creases; k++) {
        if (!members[k])
            return false;
        s->toward[k] = csg_vec3_scale(s->toward[k], 1.0 / members[k]);
    }
    return true;
}

/* Onto the surface by Newton's steps from the middle, as far as they stay in the cell. */
static csg_vec3 onto_surface(csg_sheet_probe *p, const csg_cell_box *box, csg_vec3 at)
{
    enum { NEWTON = 3 };
    at = keep_within(box, at, MARGIN * box->cell);
    for (int step = 0; step < NEWTON; step++) {
        double f;
        csg_vec3 g;
        ask(p, &at, 1, &f, &g);
        double square = csg_vec3_dot(g, g), reach = 0.5 * box->cell;
        if (!(square > 1e-12) || fabs(f) <= p->noise)
            break;
        csg_vec3 move = csg_vec3_scale(g, -f / square);
        double length = csg_vec3_norm(move);
        if (length > reach)
            move = csg_vec3_scale(move, reach / length);
        at = keep_within(box, csg_vec3_add(at, move), MARGIN * box->cell);
    }
    return at;
}

/* How far the gradients of a polygon turn: the least cosine to their mean. */
static double least_cosine(const csg_polygon *polygon, csg_vec3 *mean)
{
    double least = 1;
    *mean = csg_vec3_make(0, 0, 0);
    for (int i = 0; i < polygon->count; i++)
        if (!polygon->is_crease[i])
            *mean = csg_vec3_add(*mean, csg_vec3_normalize(polygon->point[i].gradient));
    for (int i = 0; i < polygon->count; i++)
        if (!polygon->is_crease[i])
            least = fmin(least, csg_gradients_cosine(polygon->point[i].gradient, *mean));
    return least;
}

/* Around a tip there are no creases: every vertex has a tangent plane of its own. */
static bool find_tip(csg_sheet_probe *p, const csg_cell_box *box, const csg_polygon *polygon,
                     double slope, csg_vec3 *at)
{
    plane planes[CSG_POLYGON_MOST];
    int count = 0;
    for (int i = 0; i < polygon->count; i++)
        if (!polygon->is_crease[i])
            planes[count++] = csg_plane_of(polygon->point[i].at, 0, polygon->point[i].gradient);
    if (!meet_many(planes, count, at) || way_out(box, *at) > 0)
        return false;
    csg_vec3 kept = keep_within(box, *at, MARGIN * box->cell);
    *at = kept;
    return is_zero(p, box, kept, slope);
}

/* Whether the sheets on both sides of some crease point differ by more than 12 degrees: what is
 * blunter may stay away, where the triangles are near the surface all the same. */
static bool is_sharp(const csg_polygon *polygon)
{
    int n = polygon->count;
    for (int i = 0; i < n; i++)
        if (polygon->is_crease[i] &&
            csg_gradients_cosine(polygon->point[(i + n - 1) % n].gradient,
                                 polygon->point[(i + 1) % n].gradient) < ONE_POLYGON)
            return true;
    return false;
}

csg_apex_kind csg_polygon_find_apex(csg_sheet_probe *p, const csg_cell_box *box,
                                    const csg_polygon *polygon, csg_vec3 *out)
{
    csg_vec3 middle = middle_of(polygon), mean, at = middle;
    int creases = 0;
    double slope = 0;
    for (int i = 0; i < polygon->count; i++) {
        creases += polygon->is_crease[i];
        if (!polygon->is_crease[i])
            slope = fmax(slope, csg_vec3_norm(polygon->point[i].gradient));
    }
    if (creases >= 2) {
        sheets s;
        csg_vec3 sum = {0, 0, 0};
        for (int i = 0; i < polygon->count; i++)
            if (polygon->is_crease[i])
                sum = csg_vec3_add(sum, polygon->point[i].at);
        at = csg_vec3_scale(sum, 1.0 / creases);
        if (gather_sheets(polygon, creases, &s) && come_closer(p, box, &s, &at, -1)) {
            csg_vec3 kept = keep_within(box, at, MARGIN * box->cell);
            if (csg_vec3_norm(csg_vec3_sub(kept, at)) <= MARGIN * box->cell &&
                is_zero(p, box, kept, slope)) {
                *out = kept;
                return CSG_APEX_CREASE;
            }
        }
        *out = onto_surface(p, box, middle);
        return is_sharp(polygon) ? CSG_APEX_FAILED : CSG_APEX_SMOOTH;
    }
    bool turns = least_cosine(polygon, &mean) < ONE_POLYGON;
    if (turns && find_tip(p, box, polygon, slope, &at)) {
        *out = at;
        return CSG_APEX_CREASE;
    }
    *out = onto_surface(p, box, middle);
    return CSG_APEX_SMOOTH;
}
