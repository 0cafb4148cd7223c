/* SPDX-License-Identifier: MIT
 * Planes and steps; see sheets.h.
 */
#include "mesh/adaptive/sheets.h"

#include <math.h>
#include <string.h>

#include "base/elementary.h"
#include "mesh/plane.h"

enum { MOST = CSG_POLYGON_MOST_SHEETS, LANES = CSG_LANES, MOST_ASKED = CSG_MOST_APEXES * MOST };
_Static_assert(MOST_ASKED >= 2 * CSG_MOST_FACES && MOST_ASKED % LANES == 0, "all looks fit");

/* Cosine: gradients that differ by 5 degrees may belong to two sheets. */
static const double ONE_SHEET = 0.9962;
/* A sheet whose gradient turned by 60 degrees within a cell is another one. */
static const double ANOTHER_SHEET = 0.5;
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

/* Values and gradients at some points. */
static void ask(csg_sheet_probe *p, const csg_vec3 *at, int count, double *f, csg_vec3 *g)
{
    float x[MOST_ASKED], y[MOST_ASKED], z[MOST_ASKED], v[MOST_ASKED];
    float gx[MOST_ASKED], gy[MOST_ASKED], gz[MOST_ASKED];
    for (int i = 0; i < count || i % LANES; i++) {
        const csg_vec3 *q = &at[i < count ? i : 0];
        x[i] = (float)q->x, y[i] = (float)q->y, z[i] = (float)q->z;
    }
    p->kernel->values_and_gradients(p->tape, x, y, z, (size_t)count, v, gx, gy, gz, p->scratch,
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
static void place_looks(const csg_cell_box *box, const sheets *s, csg_vec3 at, double off,
                        int flat_axis, csg_vec3 *q)
{
    csg_vec3 from = keep_within(box, at, 0);
    for (int k = 0; k < s->count; k++) {
        csg_vec3 way = csg_vec3_sub(s->toward[k], from), n = s->plane[k].g;
        double square = csg_vec3_dot(n, n);
        if (square > 0 && flat_axis < 0)
            way = csg_vec3_sub(way, csg_vec3_scale(n, csg_vec3_dot(way, n) / square));
        double length = csg_vec3_norm(way), step = fmin(off * box->cell, 0.9 * length);
        q[k] = keep_within(
            box, csg_vec3_add(from, csg_vec3_scale(way, length > 0 ? step / length : 0)), 0);
    }
}

/* The planes that were found there, where they are the sheets' own. */
static void take_looks(sheets *s, const csg_vec3 *q, const double *f, csg_vec3 *g, int flat_axis)
{
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
    return (turn){csg_arc_cosine(csg_gradients_cosine(s->plane[0].g, s->plane[1].g)),
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

/* Whether a step was so short that there is nothing to learn from closer by: faces are plane. */
static bool has_arrived(const csg_cell_box *box, int step, csg_vec3 before, csg_vec3 at)
{
    return step > 0 && csg_vec3_norm(csg_vec3_sub(at, before)) < 1e-5 * box->cell;
}

/* Whether a value is that of a place so near to the surface. */
static bool is_within(const csg_sheet_probe *p, double most, double f, double slope)
{
    return fabs(f) <= most * slope + 4 * p->noise;
}

/* The same of a place on it. */
static bool is_zero(const csg_sheet_probe *p, const csg_cell_box *box, double f, double slope)
{
    return is_within(p, ZERO * box->cell, f, slope);
}

/* ---- in a face ---------------------------------------------------------------------------------
 */

/* One face's way to where its two sheets meet. */
typedef struct approach {
    csg_face_crease *face;
    int axis; /* the face's own */
    sheets sheets;
    turn first;
    csg_vec3 at, before;
    bool is_there;
} approach;

/* What of it lies in the face. */
static csg_vec3 gradient_of_end(const approach *a, int end)
{
    csg_vec3 g = a->face->ends[end].gradient;
    *component(&g, a->axis) = 0;
    return g;
}

/* False: there are no two sheets, or they do not meet. */
static bool set_out(approach *a, csg_face_crease *face)
{
    const csg_cell_box *box = &face->face;
    face->is_there = face->is_torn = a->is_there = false;
    a->face = face;
    a->axis = box->low[0] == box->high[0] ? 0 : box->low[1] == box->high[1] ? 1 : 2;
    a->sheets.count = 2;
    for (int k = 0; k < 2; k++) {
        csg_vec3 g = gradient_of_end(a, k);
        a->sheets.plane[k] = csg_plane_of(face->ends[k].at, 0, g);
        a->sheets.from[k] = a->sheets.toward[k] = face->ends[k].at;
    }
    a->first = turn_of(&a->sheets);
    a->at = a->before = csg_vec3_scale(csg_vec3_add(face->ends[0].at, face->ends[1].at), 0.5);
    return csg_gradients_cosine(a->sheets.plane[0].g, a->sheets.plane[1].g) <= ONE_SHEET &&
           meet(a->sheets.plane, 2, &a->at) && way_out(box, a->at) < box->cell;
}

/* Takes what a look showed. False: the sheets do not meet. */
static bool go_on(approach *a, int step, const csg_vec3 *q, const double *f, csg_vec3 *g)
{
    const csg_cell_box *box = &a->face->face;
    a->before = a->at;
    take_looks(&a->sheets, q, f, g, a->axis);
    if (is_curved_only(a->first, turn_of(&a->sheets)) || !meet(a->sheets.plane, 2, &a->at))
        return false;
    a->is_there = step + 1 == STEPS || has_arrived(box, step, a->before, a->at);
    return a->is_there || way_out(box, a->at) < box->cell;
}

/* Whether a sheet is another one near the meeting than where it began. */
static bool has_changed_sheet(const approach *a)
{
    for (int k = 0; k < 2; k++)
        if (csg_gradients_cosine(a->sheets.plane[k].g, gradient_of_end(a, k)) < ANOTHER_SHEET)
            return true;
    return false;
}

/* The place kept within the face. False: it is not in the face, or not a crease's. */
static bool keep_in_face(approach *a)
{
    const csg_cell_box *box = &a->face->face;
    *component(&a->at, a->axis) = box->low[a->axis];
    a->face->at = keep_within(box, a->at, MARGIN * box->cell);
    bool crossed = csg_gradients_cosine(a->sheets.plane[0].g, a->sheets.plane[1].g) <= ONE_SHEET;
    bool within = csg_vec3_norm(csg_vec3_sub(a->face->at, a->at)) <= MARGIN * box->cell;
    a->face->is_torn = crossed && within && has_changed_sheet(a);
    return crossed && within;
}

/* From between the points straight into the face, to where the sign is another one. */
static csg_vec3 step_beside(csg_sheet_probe *p, const csg_face_crease *f)
{
    enum { LOOKS = 6, HALVINGS = 6 };
    const csg_cell_box *face = &f->face;
    csg_vec3 from = csg_vec3_scale(csg_vec3_add(f->ends[0].at, f->ends[1].at), 0.5);
    csg_vec3 way = {0, 0, 0}, g;
    for (int axis = 0; axis < 3; axis++) { /* the one along which neither ends nor face extend */
        double at = *component(&from, axis), low = face->low[axis], high = face->high[axis];
        if (low < high && (at == low || at == high))
            *component(&way, axis) = at == low ? face->cell : -face->cell;
    }
    double least = 0, most = 0, value, first;
    ask(p, &from, 1, &first, &g);
    for (int look = LOOKS; look > 0 && !(most > 0); look--) {
        double part = ldexp(0.9, 1 - look);
        csg_vec3 at = csg_vec3_add(from, csg_vec3_scale(way, part));
        ask(p, &at, 1, &value, &g);
        *((value >= 0) == (first >= 0) ? &least : &most) = part;
    }
    for (int halving = 0; halving < HALVINGS && most > 0; halving++) {
        double part = 0.5 * (least + most);
        csg_vec3 at = csg_vec3_add(from, csg_vec3_scale(way, part));
        ask(p, &at, 1, &value, &g);
        *((value >= 0) == (first >= 0) ? &least : &most) = part;
    }
    return csg_vec3_add(from, csg_vec3_scale(way, most > 0 ? most : 0.5));
}

/* As the mesh has it. */
static csg_vec3 rounded(csg_vec3 at)
{
    float rounded[3];
    csg_vec3_to_floats(rounded, at);
    return csg_vec3_from_floats(rounded);
}

void csg_sheets_meet_in_faces(csg_sheet_probe *p, csg_face_crease *faces, int count)
{
    approach on_way[CSG_MOST_FACES];
    csg_vec3 q[2 * CSG_MOST_FACES], g[2 * CSG_MOST_FACES];
    double f[2 * CSG_MOST_FACES];
    int going = 0, there = 0;
    for (int i = 0; i < count; i++)
        going += set_out(&on_way[going], &faces[i]);
    for (int step = 0; step < STEPS && there < going; step++) {
        int looks = 0, kept = 0;
        for (int i = 0; i < going; i++) {
            approach *a = &on_way[i];
            if (!a->is_there)
                place_looks(&a->face->face, &a->sheets, a->at, OFF[step], a->axis, &q[looks]);
            looks += a->is_there ? 0 : 2;
        }
        ask(p, q, looks, f, g);
        looks = there = 0;
        for (int i = 0; i < going; i++) {
            approach a = on_way[i];
            int own = looks;
            looks += a.is_there ? 0 : 2;
            if (!a.is_there && !go_on(&a, step, &q[own], &f[own], &g[own]))
                continue;
            there += a.is_there;
            on_way[kept++] = a;
        }
        going = kept;
    }
    int kept = 0;
    for (int i = 0; i < going; i++)
        if (keep_in_face(&on_way[i])) {
            q[kept] = on_way[i].face->at;
            on_way[kept++] = on_way[i];
        }
    if (kept)
        ask(p, q, kept, f, g);
    for (int i = 0; i < kept; i++) {
        csg_face_crease *face = on_way[i].face;
        face->is_there = is_zero(p, &face->face, f[i], csg_vec3_norm(face->ends[0].gradient));
    }
    for (int i = 0; i < count; i++) {
        csg_face_crease *face = &faces[i];
        if (face->is_wedge && !face->is_there)
            face->at = keep_within(&face->face, step_beside(p, face), MARGIN * face->face.cell);
        face->is_there |= face->is_wedge;
        face->at = face->is_there ? rounded(face->at) : face->at;
    }
}

/* ---- in a cell ---------------------------------------------------------------------------------
 */

/* Of all vertices, or of those on creases, of which there have to be some. */
static csg_vec3 middle_of(const csg_polygon *polygon, bool of_creases)
{
    csg_vec3 sum = {0, 0, 0};
    int count = 0;
    for (int i = 0; i < polygon->count; i++)
        if (!of_creases || polygon->is_crease[i]) {
            sum = csg_vec3_add(sum, polygon->point[i].at);
            count++;
        }
    return csg_vec3_scale(sum, 1.0 / count);
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

double csg_polygon_least_cosine(const csg_polygon *polygon)
{
    double least = 1;
    csg_vec3 mean = csg_vec3_make(0, 0, 0);
    for (int i = 0; i < polygon->count; i++)
        if (!polygon->is_crease[i])
            mean = csg_vec3_add(mean, csg_vec3_normalize(polygon->point[i].gradient));
    for (int i = 0; i < polygon->count; i++)
        if (!polygon->is_crease[i])
            least = fmin(least, csg_gradients_cosine(polygon->point[i].gradient, mean));
    return least;
}

/* Whether the sheets on both sides of some crease point differ by more than 12 degrees: what is
 * blunter may stay away, where the triangles are near the surface all the same. */
static bool is_sharp(const csg_polygon *polygon)
{
    int n = polygon->count;
    for (int i = 0; i < n; i++)
        if (polygon->is_crease[i] &&
            csg_gradients_cosine(polygon->point[(i + n - 1) % n].gradient,
                                 polygon->point[(i + 1) % n].gradient) < CSG_LEAST_CREASE_COSINE)
            return true;
    return false;
}

/* ---- apexes, step by step ----------------------------------------------------------------------
 */

/* What a search does next: sheets come closer to where they meet; that place is looked at; Newton's
 * steps lead from the middle of the polygon onto the surface. */
typedef enum stage { MEETING, CHECKING, LANDING, FOUND } stage;

typedef struct apex_way {
    csg_apex_search *search;
    stage stage;
    int step; /* of the stage */
    sheets sheets;
    csg_vec3 at, before;
    double slope;
    csg_apex_kind otherwise; /* where there is no meeting */
} apex_way;

/* Onto the surface by Newton's steps from the middle, as far as they stay in the cell: from the
 * middle of the creases, where there are several, so that the fan is near them. */
static void land(apex_way *a)
{
    const csg_cell_box *box = &a->search->box;
    const csg_polygon *polygon = a->search->polygon;
    bool creased = csg_polygon_crease_count(polygon) >= 2;
    a->stage = LANDING;
    a->step = 0;
    a->search->kind = a->otherwise;
    a->at = keep_within(box, middle_of(polygon, creased), MARGIN * box->cell);
}

static void check(apex_way *a, csg_vec3 kept)
{
    a->stage = CHECKING;
    a->at = kept;
}

/* How far a place may be from where sheets met: where these would not meet in the mesh otherwise, a
 * part of the tolerance. */
static double reach_of(const csg_sheet_probe *p, const apex_way *a, double otherwise)
{
    bool would_fail = a->otherwise == CSG_APEX_FAILED && !a->search->polygon->is_torn;
    return would_fail ? fmax(p->near, otherwise) : otherwise;
}

/* The place in which sheets met, kept within the cell. */
static void check_meeting(const csg_sheet_probe *p, apex_way *a)
{
    const csg_cell_box *box = &a->search->box;
    double margin = MARGIN * box->cell;
    csg_vec3 kept = keep_within(box, a->at, margin);
    if (csg_vec3_norm(csg_vec3_sub(kept, a->at)) <= reach_of(p, a, margin))
        check(a, kept);
    else
        land(a);
}

/* Goes on to meet, where there is more to learn and the place is near the cell. */
static void approach_meeting(const csg_sheet_probe *p, apex_way *a)
{
    const csg_cell_box *box = &a->search->box;
    if (a->step == STEPS || has_arrived(box, a->step - 1, a->before, a->at))
        check_meeting(p, a);
    else if (!(way_out(box, a->at) < box->cell))
        land(a);
}

static void set_out_to_meet(const csg_sheet_probe *p, apex_way *a, int creases)
{
    const csg_polygon *polygon = a->search->polygon;
    a->at = middle_of(polygon, true);
    a->stage = MEETING;
    if (is_sharp(polygon))
        a->otherwise = CSG_APEX_FAILED;
    if (gather_sheets(polygon, creases, &a->sheets) &&
        meet(a->sheets.plane, a->sheets.count, &a->at))
        approach_meeting(p, a);
    else
        land(a);
}

/* Around a tip there are no creases: every vertex has a tangent plane of its own. */
static void set_out_to_tip(apex_way *a)
{
    const csg_cell_box *box = &a->search->box;
    const csg_polygon *polygon = a->search->polygon;
    plane planes[CSG_POLYGON_MOST];
    int count = 0;
    for (int i = 0; i < polygon->count; i++)
        if (!polygon->is_crease[i])
            planes[count++] = csg_plane_of(polygon->point[i].at, 0, polygon->point[i].gradient);
    csg_vec3 at = middle_of(polygon, false);
    if (meet_many(planes, count, &at) && !(way_out(box, at) > 0))
        check(a, keep_within(box, at, MARGIN * box->cell));
    else
        land(a);
}

static void set_out_in_cell(const csg_sheet_probe *p, apex_way *a, csg_apex_search *search)
{
    const csg_polygon *polygon = search->polygon;
    int creases = csg_polygon_crease_count(polygon);
    *a = (apex_way){.search = search, .otherwise = CSG_APEX_SMOOTH};
    for (int i = 0; i < polygon->count; i++)
        if (!polygon->is_crease[i])
            a->slope = fmax(a->slope, csg_vec3_norm(polygon->point[i].gradient));
    if (polygon->is_torn)
        a->otherwise = CSG_APEX_FAILED;
    if (creases >= 2)
        set_out_to_meet(p, a, creases);
    else if (csg_polygon_least_cosine(polygon) < CSG_LEAST_CREASE_COSINE)
        set_out_to_tip(a);
    else
        land(a);
}

/* Where the search wants to look: how many places. */
static int place_looks_of(const apex_way *a, csg_vec3 *q)
{
    if (a->stage == MEETING) {
        place_looks(&a->search->box, &a->sheets, a->at, OFF[a->step], -1, q);
        return a->sheets.count;
    }
    *q = a->at;
    return a->stage == FOUND ? 0 : 1;
}

static void take_meeting(const csg_sheet_probe *p, apex_way *a, const csg_vec3 *q, const double *f,
                         csg_vec3 *g)
{
    a->before = a->at;
    take_looks(&a->sheets, q, f, g, -1);
    a->step++;
    if (meet(a->sheets.plane, a->sheets.count, &a->at))
        approach_meeting(p, a);
    else
        land(a);
}

static void take_landing(const csg_sheet_probe *p, apex_way *a, double f, csg_vec3 g)
{
    enum { NEWTON = 3 };
    const csg_cell_box *box = &a->search->box;
    double square = csg_vec3_dot(g, g), reach = 0.5 * box->cell;
    a->stage = FOUND;
    if (!(square > 1e-12) || fabs(f) <= p->noise)
        return;
    csg_vec3 move = csg_vec3_scale(g, -f / square);
    double length = csg_vec3_norm(move);
    if (length > reach)
        move = csg_vec3_scale(move, reach / length);
    a->at = keep_within(box, csg_vec3_add(a->at, move), MARGIN * box->cell);
    if (++a->step < NEWTON)
        a->stage = LANDING;
}

static void take_looks_of(const csg_sheet_probe *p, apex_way *a, const csg_vec3 *q, const double *f,
                          csg_vec3 *g)
{
    if (a->stage == MEETING) {
        take_meeting(p, a, q, f, g);
    } else if (a->stage == LANDING) {
        take_landing(p, a, *f, *g);
    } else if (is_within(p, reach_of(p, a, ZERO * a->search->box.cell), *f, a->slope)) {
        a->stage = FOUND;
        a->search->kind = CSG_APEX_CREASE;
    } else {
        land(a);
    }
}

static void find_some_apexes(csg_sheet_probe *p, csg_apex_search *searches, int count)
{
    apex_way ways[CSG_MOST_APEXES];
    csg_vec3 q[MOST_ASKED], g[MOST_ASKED];
    double f[MOST_ASKED];
    for (int i = 0; i < count; i++)
        set_out_in_cell(p, &ways[i], &searches[i]);
    for (int looks = 1; looks > 0;) {
        int number[CSG_MOST_APEXES];
        looks = 0;
        for (int i = 0; i < count; i++) {
            number[i] = place_looks_of(&ways[i], &q[looks]);
            looks += number[i];
        }
        if (looks)
            ask(p, q, looks, f, g);
        for (int i = 0, first = 0; i < count; first += number[i++])
            if (number[i])
                take_looks_of(p, &ways[i], &q[first], &f[first], &g[first]);
    }
    for (int i = 0; i < count; i++)
        searches[i].at = rounded(ways[i].at);
}

void csg_polygons_find_apexes(csg_sheet_probe *p, csg_apex_search *searches, int count)
{
    for (int done = 0; done < count; done += CSG_MOST_APEXES) {
        int rest = count - done;
        find_some_apexes(p, searches + done, rest < CSG_MOST_APEXES ? rest : CSG_MOST_APEXES);
    }
}
