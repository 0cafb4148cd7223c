/* SPDX-License-Identifier: MIT
 * Graphs; see graph.h. With z along the axis, turned so that the solid is below, the model's
 * polynomial F falls with z all over the cube, at least as fast as `fall`. Over a square of its
 * face the surface is
 *     z(x, y) = z_0 + g . d + d . Z d / 2 + at most third |d|^3,
 * with F(x_0, y_0, z_0) = 0 and the derivatives of the implicit function, and the field's own
 * surface is no farther from that along z than what the model is off, over `fall`.
 */
#include "measure/graph.h"

#include <math.h>
#include <string.h>

enum { SIDE = 2 /* squares along a side of the face */, CORNERS = 4, MOST_CLIPPED = CORNERS + 1 };

/* The polynomial with its axes in that order. */
typedef struct polynomial {
    double value, s[3], h[3][3];
} polynomial;

typedef struct square {
    double at[2], half;
    double z, g[2], bend[3];   /* xx, yy, xy */
    double norm;               /* of these */
    double tilt[2], metric[3]; /* g - p_0; M */
    double reach;              /* |d . Z d / 2| is no more */
    double error, mean;        /* along z: most, and the mean's bound */
    double beyond;             /* the surface is that close to the linear part */
} square;

typedef struct graph {
    const csg_taylor *f;
    polynomial p;
    double half, fall, third;
    double room;          /* the model is off by no more anywhere in the cube */
    double tangent, bent; /* at least the surface's length along a direction of the face; |H| */
} graph;

/* What the square's columns are. */
typedef enum columns { EMPTY, FULL, CROSSED, UNKNOWN } columns;

static const int AT[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}}; /* in a model's bends */

/* Returns the axis that becomes the last. */
static int order_axes(const csg_taylor *f, polynomial *p)
{
    int up = 0;
    for (int k = 1; k < 3; k++)
        up = fabs(f->slope[k]) > fabs(f->slope[up]) ? k : up;
    const int axes[3] = {(up + 1) % 3, (up + 2) % 3, up};
    double turn = f->slope[up] > 0 ? -1 : 1;
    p->value = f->value;
    for (int i = 0; i < 3; i++) {
        p->s[i] = (i == 2 ? turn : 1) * f->slope[axes[i]];
        for (int k = 0; k < 3; k++)
            p->h[i][k] = ((i == 2) != (k == 2) ? turn : 1) * f->bend[AT[axes[i]][axes[k]]];
    }
    return up;
}

/* Roots are looked for up to twice the half edge. False: F may not fall there. The third derivative
 * of the implicit function of a polynomial of second order, along a unit vector u with q the
 * tangent's length: z_uuu = -3 (F_z)_u z_uu / F_z, |(F_z)_u| <= |H_z| q, |z_uu| <= |H| q^2 / fall.
 */
static bool find_fall(graph *g)
{
    static const double LEAST = 0.25;
    const polynomial *p = &g->p;
    double h = g->half, steep = fabs(p->s[2]), gradient = 0, row = 0, all = 0;
    g->fall = steep - (fabs(p->h[2][0]) + fabs(p->h[2][1]) + 2 * fabs(p->h[2][2])) * h;
    if (!(g->fall > LEAST * steep))
        return false;
    for (int i = 0; i < 3; i++) {
        double most =
            fabs(p->s[i]) + (fabs(p->h[i][0]) + fabs(p->h[i][1])) * h + 2 * fabs(p->h[i][2]) * h;
        gradient += i < 2 ? most * most : 0;
        row += p->h[2][i] * p->h[2][i];
        for (int k = 0; k < 3; k++)
            all += p->h[i][k] * p->h[i][k];
    }
    double tangent = sqrt(1 + gradient / (g->fall * g->fall));
    g->tangent = tangent;
    g->bent = sqrt(all);
    g->third = 0.5 * sqrt(row * all) * tangent * tangent * tangent / (g->fall * g->fall);
    return isfinite(g->third);
}

static double value_at(const polynomial *p, double x, double y, double z)
{
    const double at[3] = {x, y, z};
    double sum = p->value;
    for (int i = 0; i < 3; i++) {
        double row = p->s[i];
        for (int k = 0; k < 3; k++)
            row += 0.5 * p->h[i][k] * at[k];
        sum += row * at[i];
    }
    return sum;
}

/* Over the square at this height: 1, F is more than `room` all over; -1, less than -room; else 0.
 */
static int sign_at(const polynomial *p, const square *q, double z, double room)
{
    double value = value_at(p, q->at[0], q->at[1], z), reach = room;
    for (int i = 0; i < 2; i++) {
        double slope = p->s[i] + p->h[i][0] * q->at[0] + p->h[i][1] * q->at[1] + p->h[i][2] * z;
        reach += fabs(slope) * q->half;
        for (int k = 0; k < 2; k++)
            reach += 0.5 * fabs(p->h[i][k]) * q->half * q->half;
    }
    return value > reach ? 1 : value < -reach ? -1 : 0;
}

/* The implicit function at the square's centre. False: its root is too far. */
static bool expand(const graph *g, square *q)
{
    const polynomial *p = &g->p;
    double x = q->at[0], y = q->at[1], a = p->h[2][2];
    double b = p->s[2] + p->h[2][0] * x + p->h[2][1] * y, c = value_at(p, x, y, 0);
    double under = b * b - 2 * a * c;
    if (!(under > 0))
        return false;
    q->z = 2 * c / (sqrt(under) - b); /* b < 0 */
    if (!(fabs(q->z) < 2 * g->half))
        return false;
    double down = b + a * q->z, second[3];
    for (int i = 0; i < 2; i++)
        q->g[i] = -(p->s[i] + p->h[i][0] * x + p->h[i][1] * y + p->h[i][2] * q->z) / down;
    for (int n = 0; n < 3; n++) {
        int i = n == 1 ? 1 : 0, k = n == 0 ? 0 : 1;
        second[n] =
            p->h[i][k] + p->h[i][2] * q->g[k] + p->h[k][2] * q->g[i] + a * q->g[i] * q->g[k];
        q->bend[n] = -second[n] / down;
    }
    q->norm = sqrt(q->bend[0] * q->bend[0] + q->bend[1] * q->bend[1] + 2 * q->bend[2] * q->bend[2]);
    q->reach = q->norm * q->half * q->half * (1 + 1e-12);
    return true;
}

/* How far the surface may be from the square's parabola along z: by the third derivatives, and by
 * what the model is off. Where that is less than half of the polynomial's own farthest root all
 * over the cube, no root of the field is farther than half as far again, and what the model is off
 * there counts alone. Means over the square: |x|^3 is no more than its largest square times the
 * root of the mean square; that of |d|^3 is at most 0.6223^(3/4) half^3 by the mean of |d|^4. */
static void find_errors(const graph *g, square *q)
{
    static const double MEAN_CUBE = 0.701, MOST_CUBE = 2.8285;
    const csg_taylor *f = g->f;
    double h = q->half, third = g->third * h * h * h;
    double far = fabs(q->z) + (fabs(q->g[0]) + fabs(q->g[1])) * h + q->reach + MOST_CUBE * third;
    double z = g->room < 0.5 * far * g->fall ? fmin(1.5 * far, g->half) : g->half;
    double most = z * z, mean = z * z + 2.0 / 3 * h * h;
    for (int i = 0; i < 2; i++) {
        most += (fabs(q->at[i]) + h) * (fabs(q->at[i]) + h);
        mean += q->at[i] * q->at[i];
    }
    q->error = (f->error + f->cubic * most * sqrt(most)) / g->fall + MOST_CUBE * third;
    q->mean = (f->error + f->cubic * most * sqrt(mean)) / g->fall + MEAN_CUBE * third;
    q->beyond = q->reach + q->error;
}

static columns place(const graph *g, square *q)
{
    if (sign_at(&g->p, q, g->half, g->room) > 0)
        return FULL;
    if (sign_at(&g->p, q, -g->half, g->room) < 0)
        return EMPTY;
    if (!expand(g, q))
        return UNKNOWN;
    find_errors(g, q);
    return CROSSED;
}

/* ---- parts of a square -------------------------------------------------------------------------
 */

typedef struct part {
    double area, line, bent; /* integrals of 1, of the linear part, of that and the bends */
    double tilt;             /* and of tilt_at */
} part;

static double line_at(const square *q, double value, const double at[2])
{
    return value + q->g[0] * at[0] + q->g[1] * at[1];
}

static double bend_at(const square *q, const double at[2])
{
    return 0.5 * (q->bend[0] * at[0] * at[0] + q->bend[1] * at[1] * at[1]) +
           q->bend[2] * at[0] * at[1];
}

/* Half of (p - p_0) . M (p - p_0), see find_tilt. */
static double tilt_at(const square *q, const double at[2])
{
    double x = q->tilt[0] + q->bend[0] * at[0] + q->bend[2] * at[1];
    double y = q->tilt[1] + q->bend[2] * at[0] + q->bend[1] * at[1];
    return 0.5 * (q->metric[0] * x * x + q->metric[1] * y * y) + q->metric[2] * x * y;
}

/* Where value + g . d > 0. */
static part find_part(const square *q, double value)
{
    static const int SIGN[CORNERS][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    double polygon[MOST_CLIPPED][2], values[CORNERS], corners[CORNERS][2];
    int count = 0;
    part sum = {0};
    for (int i = 0; i < CORNERS; i++) {
        for (int k = 0; k < 2; k++)
            corners[i][k] = SIGN[i][k] * q->half;
        values[i] = line_at(q, value, corners[i]);
    }
    for (int i = 0; i < CORNERS; i++) {
        const double *from = corners[i], *to = corners[(i + 1) % CORNERS];
        double a = values[i], b = values[(i + 1) % CORNERS], share = a / (a - b);
        if (a > 0 && count < MOST_CLIPPED)
            memcpy(polygon[count++], from, sizeof polygon[0]);
        if ((a > 0) == (b > 0) || count >= MOST_CLIPPED)
            continue;
        for (int k = 0; k < 2; k++)
            polygon[count][k] = from[k] + share * (to[k] - from[k]);
        count++;
    }
    for (int i = 1; i + 1 < count; i++) {
        const double *t[3] = {polygon[0], polygon[i], polygon[i + 1]};
        double area = 0.5 * ((t[1][0] - t[0][0]) * (t[2][1] - t[0][1]) -
                             (t[1][1] - t[0][1]) * (t[2][0] - t[0][0]));
        sum.area += area;
        for (int n = 0; n < 3; n++) {
            const double *a = t[n], *b = t[(n + 1) % 3];
            const double middle[2] = {0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])};
            double line = line_at(q, value, middle);
            sum.line += area / 3 * line;
            sum.bent += area / 3 * (line + bend_at(q, middle));
            sum.tilt += area / 3 * tilt_at(q, middle);
        }
    }
    return sum;
}

/* The integral of max(z - level, 0), and what the bends leave open of it: with a the linear part
 * and b the bends, max(a + b, 0) is max(a, 0) + b [a > 0] but for max(|b| - |a|, 0), whose integral
 * is that of a tent. */
static double part_above(const square *q, double level, double *open)
{
    double value = q->z - level, line = (fabs(q->g[0]) + fabs(q->g[1])) * q->half;
    double area = 4 * q->half * q->half;
    if (value + line + q->reach <= 0)
        return 0;
    if (value - line - q->reach >= 0)
        return area * (value + (q->bend[0] + q->bend[1]) * q->half * q->half / 6);
    part here = find_part(q, value), more = find_part(q, value + q->reach),
         less = find_part(q, value - q->reach);
    *open += fmax(more.line - 2 * here.line + less.line, 0);
    return here.bent;
}

/* Where the surface may be in the cube, at most; and where it is for certain, at least: `beyond` is
 * negative then. */
static double shown(const graph *g, const square *q, double beyond)
{
    double up = g->half + beyond;
    return fmax(find_part(q, q->z + up).area - find_part(q, q->z - up).area, 0);
}

/* All of the square is seen in the cube. */
static bool is_whole(const graph *g, const square *q)
{
    double line = (fabs(q->g[0]) + fabs(q->g[1])) * q->half + q->beyond;
    return q->z - line > -g->half && q->z + line < g->half;
}

/* ---- the solid ----------------------------------------------------------------------------------
 */

/* How much the plane's half space has above or below that height of the square's columns. */
static double plane_over(const graph *g, const square *q, double turn, double level)
{
    const polynomial *p = &g->p;
    double steep = fabs(p->s[2]);
    double z = (p->value + p->s[0] * q->at[0] + p->s[1] * q->at[1]) / steep;
    double line = (fabs(p->s[0]) + fabs(p->s[1])) / steep * q->half;
    return fmin(fmax(turn * (z - level) + line, 0), 2 * g->half);
}

/* Where the surface is, the solid's columns differ from the half space's by no more than the
 * surfaces do. */
static bool add_columns(const graph *g, square *q, csg_graph *out)
{
    const polynomial *p = &g->p;
    double h = g->half, area = 4 * q->half * q->half, steep = fabs(p->s[2]), open = 0;
    switch (place(g, q)) {
    case EMPTY:
        out->lost += area * plane_over(g, q, 1, -h);
        return true;
    case FULL:
        out->volume += area * 2 * h;
        out->gained += area * plane_over(g, q, -1, h);
        return true;
    case UNKNOWN:
        return false;
    case CROSSED:
        break;
    }
    out->volume += part_above(q, -h, &open) - part_above(q, h, &open);
    double touched = is_whole(g, q) ? area : shown(g, q, q->beyond);
    out->error += fmin(area * q->mean, touched * q->error) + open;
    double reach = q->beyond;
    double middle = q->z - (p->value + p->s[0] * q->at[0] + p->s[1] * q->at[1]) / steep;
    for (int i = 0; i < 2; i++)
        reach += fabs(q->g[i] - p->s[i] / steep) * q->half;
    out->gained += area * fmax(reach + middle, 0);
    out->lost += area * fmax(reach - middle, 0);
    return true;
}

/* ---- the surface -------------------------------------------------------------------------------
 */

/* With p the surface's gradient over the face and p_0 the plane's, the area of a piece of the
 * surface is the integral of A(p) = sqrt(1 + p^2), and what flows through it along the plane's
 * normal that of its tangent at p_0. With M the second derivatives of A there they differ by the
 * integral of (p - p_0) . M (p - p_0) / 2, but for a sixth of the third derivatives, which are
 * 0.859 |p - p_0|^3 at most. */
static void find_tilt(const graph *g, square *q)
{
    double p[2], steep = fabs(g->p.s[2]);
    for (int i = 0; i < 2; i++) {
        p[i] = g->p.s[i] / steep;
        q->tilt[i] = q->g[i] - p[i];
    }
    double whole = 1 + p[0] * p[0] + p[1] * p[1], cube = whole * sqrt(whole);
    q->metric[0] = (whole - p[0] * p[0]) / cube;
    q->metric[1] = (whole - p[1] * p[1]) / cube;
    q->metric[2] = -p[0] * p[1] / cube;
}

/* Over what the square shows of the surface, which is that of the linear part but for strips on its
 * sides. p = -(f_x, f_y) / f_z is off by (1 + |p|) times what the field's gradient is, over f_z; as
 * much as the surface's place makes of the bends; and by the square's third derivatives, half of
 * 6 third |d|^2. M is nowhere longer than 1. */
static void add_excess(const graph *g, const square *q, double *least_sum, double *most_sum)
{
    static const double SIXTH = 0.1432;
    const csg_taylor *f = g->f;
    double h = g->half, half = q->half, turned = f->turned + f->twice * 3 * h * h;
    double off = g->fall > turned ? turned / (g->fall - turned) : INFINITY;
    off = 1.4143 * g->tangent * (off + g->bent * q->error / g->fall);
    off += 6 * g->third * half * half;
    double tilt = find_part(q, q->z + h).tilt - find_part(q, q->z - h).tilt;
    double touched = 4 * half * half, strips = 0;
    if (!is_whole(g, q)) {
        touched = shown(g, q, q->beyond);
        strips = touched - shown(g, q, -q->beyond);
    }
    double most =
        sqrt(q->tilt[0] * q->tilt[0] + q->tilt[1] * q->tilt[1]) + sqrt(2) * q->norm * half;
    double all = most + off, open = 0.5 * all * all * strips;
    open += touched * (SIXTH * all * all * all + (most + 0.5 * off) * off);
    *least_sum += fmax(tilt - open, 0);
    *most_sum += fmin(tilt + open, 0.5 * touched * all * all);
}

/* ---- the cube ----------------------------------------------------------------------------------
 */

static bool begin(graph *g, const csg_taylor *f, double half, int *up)
{
    double most = 3 * half * half;
    *g = (graph){.f = f, .half = half, .room = f->error + f->cubic * most * sqrt(most)};
    *up = order_axes(f, &g->p);
    return find_fall(g);
}

static square square_of(const graph *g, int i)
{
    square q = {.half = g->half / SIDE};
    q.at[0] = (2 * (i % SIDE) + 1) * q.half - g->half;
    q.at[1] = (2 * (i / SIDE) + 1) * q.half - g->half;
    return q;
}

bool csg_graph_find(const csg_taylor *f, double half, csg_graph *out)
{
    graph g;
    int up;
    double whole = 8 * half * half * half;
    out->volume = out->error = out->gained = out->lost = 0;
    if (!begin(&g, f, half, &up))
        return false;
    for (int i = 0; i < SIDE * SIDE; i++) {
        square q = square_of(&g, i);
        if (!add_columns(&g, &q, out))
            return false;
    }
    csg_cut_cube(half, f->value, f->slope, out->plane);
    out->error = fmin(out->error * (1 + 1e-9), whole);
    out->gained = fmin(out->gained * (1 + 1e-9), whole);
    out->lost = fmin(out->lost * (1 + 1e-9), whole);
    return isfinite(out->volume + out->error + out->gained + out->lost);
}

bool csg_graph_excess(const csg_taylor *f, double half, double *least, double *most)
{
    graph g;
    int up;
    *least = *most = 0;
    if (!begin(&g, f, half, &up))
        return false;
    for (int i = 0; i < SIDE * SIDE; i++) {
        square q = square_of(&g, i);
        columns of = place(&g, &q);
        if (of == UNKNOWN)
            return false;
        if (of != CROSSED)
            continue;
        find_tilt(&g, &q);
        add_excess(&g, &q, least, most);
    }
    *least *= 1 - 1e-9;
    *most *= 1 + 1e-9;
    return isfinite(*most);
}

/* The model on the face, as one that does not depend on the axis. */
static csg_taylor on_face(const csg_taylor *f, double at, int axis)
{
    csg_taylor out = *f;
    out.value += (f->slope[axis] + 0.5 * f->bend[AT[axis][axis]] * at) * at;
    for (int k = 0; k < 3; k++)
        out.slope[k] += f->bend[AT[axis][k]] * at;
    out.slope[axis] = 0;
    for (int k = 0; k < 3; k++)
        out.bend[AT[axis][k]] = 0;
    return out;
}

/* A part of the cube's face over each piece of the face's own side, divided by how wide it is along
 * the axis: it is the same everywhere along that, and farthest from the centre at the face. */
bool csg_graph_face(const csg_taylor *f, double half, int axis, int side, double *area,
                    double *error)
{
    const csg_taylor face = on_face(f, side * half, axis);
    csg_graph sum = {.volume = 0};
    graph g;
    int up;
    double piece = half / SIDE, whole = 4 * half * half;
    if (!begin(&g, &face, half, &up) || up == axis)
        return false;
    int along = (up + 1) % 3 == axis ? 0 : 1;
    for (int i = 0; i < SIDE; i++) {
        square q = {.half = piece};
        q.at[along] = half;
        q.at[1 - along] = (2 * i + 1) * piece - half;
        if (!add_columns(&g, &q, &sum))
            return false;
    }
    *area = sum.volume / (2 * piece);
    *error = fmin(sum.error / (2 * piece) * (1 + 1e-9), whole);
    return isfinite(*area + *error);
}
