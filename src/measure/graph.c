/* SPDX-License-Identifier: MIT
 * Graphs; see graph.h. Over a patch that shows all of it in the cube odd powers cancel; one that
 * the surface leaves above or below is divided.
 */
#include "measure/graph.h"

#include <math.h>
#include <string.h>

#include "measure/graph_field.h"

/* ---- the solid ----------------------------------------------------------------------------------
 */

typedef struct solid {
    double integrals[CSG_INTEGRALS]; /* in the graph's axes, around the cube's centre */
    double error, open, first, second;
    bool with_moments;
} solid;

/* integrals: around the patch's middle and the cube's. */
static void add_moments(solid *s, const csg_graph_patch *q, double integrals[CSG_INTEGRALS])
{
    const double at[3] = {q->at[0], q->at[1], 0};
    csg_integrals_shift(integrals, at);
    for (int n = 0; n < CSG_INTEGRALS; n++)
        s->integrals[n] += integrals[n];
}

/* Of columns up to the tangent plane, that stays in the cube, and of the bends' volume above the
 * middle of it. About that the first moments of bends are odd but along z, where a half of their
 * square is left; the second moments have them no farther than the plane reaches. */
static void add_whole(const csg_graph_base *g, const csg_graph_patch *q, solid *s)
{
    double h = g->half, area = csg_graph_patch_area(q), z = q->z, line = csg_graph_patch_line(q),
           bend = csg_graph_patch_bend(q);
    double third = csg_graph_patch_third(q), x = q->half[0] * q->half[0] / 3,
           y = q->half[1] * q->half[1] / 3;
    double mean = 0.5 * (q->bend[CSG_GRAPH_XX] * x + q->bend[CSG_GRAPH_YY] * y), climb = 0;
    double to[CSG_INTEGRALS] = {area * (z + h + mean)};
    climb = q->g[0] * q->g[0] * x + q->g[1] * q->g[1] * y;
    to[1] = area * q->g[0] * x;
    to[2] = area * q->g[1] * y;
    to[3] = 0.5 * area * (z * z - h * h + climb + 2 * z * mean);
    to[CSG_INTEGRAL_XX] = area * (z + h) * x;
    to[CSG_INTEGRAL_XX + 1] = area * (z + h) * y;
    to[CSG_INTEGRAL_XX + 2] = area / 3 * (z * z * z + h * h * h + 3 * z * climb + 3 * z * z * mean);
    to[CSG_INTEGRAL_XZ] = area * z * q->g[0] * x;
    to[CSG_INTEGRAL_YZ] = area * z * q->g[1] * y;
    double wide = fmax(q->half[0], q->half[1]) + line + bend + third;
    double first = area * (third * wide + 0.5 * bend * bend);
    s->first += first;
    s->second += area * (bend + third) * wide * wide + 2 * h * first;
    add_moments(s, q, to);
}

/* The same where it leaves the cube. */
static void add_cut(const csg_graph_base *g, const csg_graph_patch *q, double volume, solid *s)
{
    const double wide[3] = {q->half[0], q->half[1], g->half};
    const double slope[3] = {q->g[0], q->g[1], -1};
    double h = g->half, z = fmin(fmax(q->z, -h), h), to[CSG_INTEGRALS];
    double bends = csg_graph_patch_bend(q) + csg_graph_patch_third(q),
           far = csg_graph_patch_line(q) + bends;
    csg_cut_box(wide, q->z, slope, to);
    double more = volume - to[CSG_INTEGRAL_ONE];
    to[CSG_INTEGRAL_ONE] = volume;
    to[3] += more * z;
    to[CSG_INTEGRAL_XX + 2] += more * z * z;
    double reach = fmax(fmax(q->half[0], q->half[1]), fmin(far + fabs(q->z - z), 2 * h));
    double first = 2 * csg_graph_patch_area(q) * bends * reach;
    s->first += first;
    s->second += first * reach + 2 * h * first;
    add_moments(s, q, to);
}

static void add_full(const csg_graph_base *g, const csg_graph_patch *q, solid *s)
{
    double h = g->half, volume = 2 * h * csg_graph_patch_area(q);
    double to[CSG_INTEGRALS] = {volume};
    to[CSG_INTEGRAL_XX] = volume * q->half[0] * q->half[0] / 3;
    to[CSG_INTEGRAL_XX + 1] = volume * q->half[1] * q->half[1] / 3;
    to[CSG_INTEGRAL_XX + 2] = volume * h * h / 3;
    add_moments(s, q, to);
}

/* enough: what may be left open of its volume. */
static void add_patch(const csg_graph_base *g, const csg_graph_patch *q, double enough, int more,
                      solid *s)
{
    double h = g->half,
           reach = csg_graph_patch_line(q) + csg_graph_patch_bend(q) + csg_graph_patch_third(q),
           open = 0;
    if (q->z + reach <= -h)
        return;
    if (q->z - reach >= h) {
        add_full(g, q, s);
        return;
    }
    bool is_cut = !csg_graph_patch_is_whole(g, q, 0);
    double volume = csg_graph_patch_above(q, -h, &open) - csg_graph_patch_above(q, h, &open);
    bool is_done = !more || (open <= enough && (!s->with_moments || more < CSG_GRAPH_HALVED - 1));
    if (is_cut && !is_done) {
        int axis = csg_graph_patch_bent_axis(q);
        for (int side = -1; side <= 1; side += 2) {
            csg_graph_patch half = csg_graph_patch_half(q, axis, side);
            add_patch(g, &half, 0.5 * enough, more - 1, s);
        }
        return;
    }
    s->open += open;
    if (!s->with_moments)
        s->integrals[CSG_INTEGRAL_ONE] += volume;
    else if (is_cut)
        add_cut(g, q, volume, s);
    else
        add_whole(g, q, s);
}

static void fill(void *user, const csg_graph_base *g, const csg_graph_patch *q)
{
    add_full(g, q, user);
}

static double cross(void *user, const csg_graph_base *g, const csg_graph_patch *q,
                    const csg_graph_room *off)
{
    double area = csg_graph_patch_area(q), shown = area;
    if (!csg_graph_patch_is_whole(g, q, off->most))
        shown = csg_graph_patch_shown(
            g, q, csg_graph_patch_bend(q) + csg_graph_patch_third(q) + off->most);
    add_patch(g, q, CSG_GRAPH_SHARE * fmin(area * off->mean, shown * off->most), CSG_GRAPH_HALVED,
              user);
    return shown;
}

/* Over one of the first patches. False: the surface may not be a graph there. */
static bool add_columns(const csg_graph_field *g, const csg_graph_patch *first, double enough,
                        solid *s)
{
    const csg_graph_visitor visitor = {
        .user = s, .enough = enough, .enough_turned = INFINITY, .cross = cross, .fill = fill};
    return csg_graph_field_visit(g, first, &visitor, &s->error);
}

/* Of these integrals, in the field's axes. */
static void turn_back(const csg_graph_base *g, const double from[CSG_INTEGRALS],
                      double to[CSG_INTEGRALS])
{
    static const int AT[3][3] = {{4, 7, 8}, {7, 5, 9}, {8, 9, 6}};
    const double sign[3] = {1, 1, g->turn};
    to[CSG_INTEGRAL_ONE] = from[CSG_INTEGRAL_ONE];
    for (int i = 0; i < 3; i++) {
        to[1 + g->axes[i]] = sign[i] * from[1 + i];
        for (int k = i; k < 3; k++)
            to[AT[g->axes[i]][g->axes[k]]] = sign[i] * sign[k] * from[AT[i][k]];
    }
}

/* ---- the cube ----------------------------------------------------------------------------------
 */

bool csg_graph_find(const csg_taylor_pieces *f, double half, double enough, csg_graph *out)
{
    static const double ROUNDING = 1 + 1e-9;
    csg_graph_field g; /* not filled: it is large */
    solid s = {.with_moments = true};
    csg_graph_field_begin(&g, f, half);
    for (int i = 0; i < CSG_GRAPH_SIDE * CSG_GRAPH_SIDE; i++) {
        csg_graph_patch q = csg_graph_patch_first(half, i);
        if (!add_columns(&g, &q, CSG_GRAPH_LEAST * enough, &s))
            return false;
        out->is_close = !(enough > 0) || s.error + s.open <= enough;
        if (!out->is_close)
            return true;
    }
    turn_back(&g.bases[0], s.integrals, out->integrals);
    out->error = fmin((s.error + s.open) * ROUNDING, 8 * half * half * half);
    out->first = s.first * ROUNDING + out->error * half;
    out->second = s.second * ROUNDING + out->error * half * half;
    return isfinite(out->integrals[CSG_INTEGRAL_ONE] + out->error + out->second);
}

/* ---- its faces ---------------------------------------------------------------------------------
 */

/* The model on the face, as one that does not depend on the axis. */
static csg_taylor on_face(const csg_taylor *f, double at, int axis)
{
    double to[3] = {0};
    to[axis] = at;
    csg_taylor out = csg_taylor_moved(f, to);
    out.slope[axis] = 0;
    for (int i = 0; i < 3; i++) {
        out.bend[csg_taylor_second[axis][i]] = 0;
        for (int k = 0; k < 3; k++)
            out.third[csg_taylor_third[axis][i][k]] = 0;
    }
    return out;
}

enum { FACE_QUARTERED = 3 /* times, at most */ };

/* Of a face: what is in the solid, and how far it may be from that. */
typedef struct part {
    double area, error;
} part;

/* The model around a point in the cube of that half. */
static csg_taylor moved(const csg_taylor *f, const double to[3], double half)
{
    csg_taylor out = csg_taylor_moved(f, to);
    double most = 3 * half * half;
    out.error += out.quartic * most * most;
    out.turned += out.thrice * most * sqrt(most);
    out.quartic = out.thrice = 0;
    return out;
}

/* A csg_graph_part of the square over each piece of its own side, divided by how wide it is along
 * the axis: it is the same everywhere along that, and farthest from the centre at the face. False:
 * the surface may not be a graph there. */
static bool add_square(const csg_taylor_pieces *faces, double half, int axis, double enough,
                       part *sum)
{
    solid s = {.with_moments = false};
    csg_graph_field g; /* not filled: it is large */
    double piece = half / CSG_GRAPH_SIDE;
    csg_graph_field_begin(&g, faces, half);
    if (g.bases[0].axes[2] == axis)
        return false;
    int along = g.bases[0].axes[0] == axis ? 0 : 1;
    for (int i = 0; i < CSG_GRAPH_SIDE; i++) {
        csg_graph_patch q = {.half = {piece, piece}};
        q.at[along] = half;
        q.at[1 - along] = (2 * i + 1) * piece - half;
        if (!add_columns(&g, &q, CSG_GRAPH_LEAST * 2 * piece * enough, &s))
            return false;
    }
    sum->area += s.integrals[CSG_INTEGRAL_ONE] / (2 * piece);
    sum->error += fmin((s.error + s.open) / (2 * piece) * (1 + 1e-9), 4 * half * half);
    return true;
}

/* All of it is inside, or outside, by all pieces. */
static csg_graph_columns state_of_square(const csg_taylor_pieces *faces, double half)
{
    csg_graph_columns state = csg_graph_field_state(&faces->of[0].f, half);
    for (int i = 1; i < faces->count && state != CSG_COLUMNS_CROSSED; i++)
        if (csg_graph_field_state(&faces->of[i].f, half) != state)
            state = CSG_COLUMNS_CROSSED;
    return state;
}

/* One of four parts of the square. whole: half of the cube in which the models hold. */
static void find_quarter(const csg_taylor_pieces *faces, double half, double whole, int axis,
                         int which, csg_taylor_pieces *out)
{
    double to[3] = {0};
    to[(axis + 1) % 3] = which & 1 ? half / 2 : -half / 2;
    to[(axis + 2) % 3] = which & 2 ? half / 2 : -half / 2;
    out->count = faces->count;
    for (int i = 0; i < faces->count; i++) {
        const csg_taylor_piece *of = &faces->of[i];
        out->of[i].f = moved(&of->f, to, whole);
        out->of[i].condition_count = of->condition_count;
        out->of[i].is_partial = of->is_partial;
        for (int n = 0; n < of->condition_count; n++)
            out->of[i].conditions[n] = moved(&of->conditions[n], to, whole);
    }
}

/* Where the surface is nearly parallel to the face, its section bends so much that it is a graph
 * over parts of the face only: those over which it is none are divided. */
static void add_part(const csg_taylor_pieces *faces, double half, double whole, int axis,
                     double enough, int more, part *sum)
{
    double area = 4 * half * half;
    csg_graph_columns state = state_of_square(faces, half);
    if (state != CSG_COLUMNS_CROSSED) {
        sum->area += state == CSG_COLUMNS_FULL ? area : 0;
        return;
    }
    if (add_square(faces, half, axis, enough, sum))
        return;
    if (!more || area <= CSG_GRAPH_LEAST * enough) {
        sum->area += area / 2;
        sum->error += area / 2;
        return;
    }
    for (int i = 0; i < 4; i++) {
        csg_taylor_pieces quarter; /* not filled: they are large */
        find_quarter(faces, half, whole, axis, i, &quarter);
        if (csg_graph_field_keep(&quarter, half / 2))
            add_part(&quarter, half / 2, whole, axis, enough / 4, more - 1, sum);
    }
}

bool csg_graph_section(const csg_taylor_pieces *f, double half, int axis, int side,
                       csg_taylor_pieces *out)
{
    out->count = f->count;
    for (int i = 0; i < f->count; i++) {
        const csg_taylor_piece *of = &f->of[i];
        out->of[i].f = on_face(&of->f, side * half, axis);
        out->of[i].condition_count = of->condition_count;
        out->of[i].is_partial = of->is_partial;
        for (int n = 0; n < of->condition_count; n++)
            out->of[i].conditions[n] = on_face(&of->conditions[n], side * half, axis);
    }
    return csg_graph_field_keep(out, half);
}

bool csg_graph_face(const csg_taylor_pieces *f, double half, int axis, int side, double enough,
                    double *area, double *error)
{
    csg_taylor_pieces faces; /* not filled: they are large */
    part sum = {0, 0};
    if (!csg_graph_section(f, half, axis, side, &faces))
        return false;
    add_part(&faces, half, half, axis, enough, FACE_QUARTERED, &sum);
    *area = sum.area;
    *error = fmin(sum.error, 4 * half * half);
    return isfinite(*area + *error);
}
