/* SPDX-License-Identifier: MIT
 * The area of a graph beside its flow; see graph.h.
 */
#include "measure/graph.h"

#include <math.h>

#include "base/geometry.h"
#include "measure/enclosure.h"
#include "measure/graph_field.h"

/* The plane's gradient over the face; of A(p) = sqrt(1 + p^2) there its value. */
typedef struct level {
    double p[2], whole;
} level;

/* With p the surface's gradient over the face and p_0 the plane's, the area of a piece of the
 * surface is the integral of A(p), and what flows through it along the plane's normal that of its
 * tangent at p_0: with d = p - p_0 and c = p_0 . d / A(p_0), A - A_0 - c is
 * (d^2 - c^2) / (A + A_0 + c). */
static double excess_at(const csg_graph_patch *q, const level *l, const double at[2])
{
    double x = at[0], y = at[1], d[2];
    d[0] =
        q->g[0] - l->p[0] +
        (q->bend[CSG_GRAPH_XX] + 0.5 * q->third[CSG_GRAPH_XXX] * x + q->third[CSG_GRAPH_XXY] * y) *
            x +
        (q->bend[CSG_GRAPH_XY] + 0.5 * q->third[CSG_GRAPH_XYY] * y) * y;
    d[1] =
        q->g[1] - l->p[1] +
        (q->bend[CSG_GRAPH_YY] + 0.5 * q->third[CSG_GRAPH_YYY] * y + q->third[CSG_GRAPH_XYY] * x) *
            y +
        (q->bend[CSG_GRAPH_XY] + 0.5 * q->third[CSG_GRAPH_XXY] * x) * x;
    double p = l->p[0] + d[0], r = l->p[1] + d[1];
    double c = (l->p[0] * d[0] + l->p[1] * d[1]) / l->whole, square = d[0] * d[0] + d[1] * d[1];
    return (square - c * c) / (sqrt(1 + p * p + r * r) + l->whole + c);
}

/* How the gradient turns over the patch: at most along each axis and how that changes; from p_0. */
typedef struct tilt {
    double turn[2], change[2], all;
    double first, most; /* |p - p_0| at the middle, and at most */
} tilt;

static tilt tilt_of(const csg_graph_patch *q, const level *l)
{
    const double *b = q->bend, *t = q->third, x = q->half[0], y = q->half[1];
    const double bend[2][2] = {{b[CSG_GRAPH_XX], b[CSG_GRAPH_XY]},
                               {b[CSG_GRAPH_XY], b[CSG_GRAPH_YY]}};
    const double third[2][2][2] = {
        {{t[CSG_GRAPH_XXX], t[CSG_GRAPH_XXY]}, {t[CSG_GRAPH_XXY], t[CSG_GRAPH_XYY]}},
        {{t[CSG_GRAPH_XXY], t[CSG_GRAPH_XYY]}, {t[CSG_GRAPH_XYY], t[CSG_GRAPH_YYY]}}};
    tilt out = {.first = sqrt((q->g[0] - l->p[0]) * (q->g[0] - l->p[0]) +
                              (q->g[1] - l->p[1]) * (q->g[1] - l->p[1]))};
    out.most = out.first;
    for (int i = 0; i < 2; i++) {
        double square = 0;
        for (int k = 0; k < 2; k++) {
            double most = fabs(bend[i][k]) + fabs(third[i][k][0]) * x + fabs(third[i][k][1]) * y;
            square += most * most;
        }
        out.turn[i] = sqrt(square);
        out.change[i] = sqrt(third[i][i][0] * third[i][i][0] + third[i][i][1] * third[i][i][1]);
        out.most += out.turn[i] * q->half[i];
    }
    out.all = sqrt(t[CSG_GRAPH_XXX] * t[CSG_GRAPH_XXX] +
                   3 * (t[CSG_GRAPH_XXY] * t[CSG_GRAPH_XXY] + t[CSG_GRAPH_XYY] * t[CSG_GRAPH_XYY]) +
                   t[CSG_GRAPH_YYY] * t[CSG_GRAPH_YYY]);
    return out;
}

/* A's second, third and fourth derivatives are no more than 1, 0.859 and 3. */
static const double A_THIRD = 0.859, A_FOURTH = 3;

/* By the rule of Gauss with two points along either axis, which errs by h^4 / 270 times the fourth
 * derivative along it. */
static double excess_of_whole(const csg_graph_patch *q, const level *l, const tilt *t, double *open)
{
    static const double POINT = 0.57735026918962576; /* sqrt(1/3) */
    double area = csg_graph_patch_area(q), sum = 0;
    for (int i = 0; i < 4; i++) {
        const double at[2] = {(i & 1 ? POINT : -POINT) * q->half[0],
                              (i & 2 ? POINT : -POINT) * q->half[1]};
        sum += 0.25 * area * excess_at(q, l, at);
    }
    for (int i = 0; i < 2; i++) {
        double h = q->half[i] * q->half[i], n = t->turn[i] * t->turn[i], c = t->change[i];
        *open += area * h * h / 270 * (A_FOURTH * n * n + 6 * A_THIRD * n * c + 3 * c * c);
    }
    return sum;
}

/* Where the linear part is above `value`. */
static double excess_of_part(const csg_graph_patch *q, const level *l, double value)
{
    const csg_graph_rule rule = csg_graph_patch_rule(q, value);
    double sum = 0;
    for (int i = 0; i < rule.count; i++)
        sum += rule.weight[i] * excess_at(q, l, rule.at[i]);
    return sum;
}

/* What is open of a patch that is cut: it is taken for that of the linear part but for strips on
 * its sides. */
static double excess_of_cut(const csg_graph_base *g, const csg_graph_patch *q, const level *l,
                            const tilt *t, double beyond, double *touched, double *open)
{
    double far = q->half[0] * q->half[0] + q->half[1] * q->half[1], h = g->half;
    double n = sqrt(t->turn[0] * t->turn[0] + t->turn[1] * t->turn[1]);
    *touched = csg_graph_patch_shown(g, q, beyond);
    double strips = *touched - csg_graph_patch_shown(g, q, -beyond);
    *open = *touched / 3 * far * sqrt(far) * (A_THIRD * n * n * n + 3 * n * t->all);
    *open += 0.5 * t->most * t->most * strips;
    return excess_of_part(q, l, q->z + h) - excess_of_part(q, l, q->z - h);
}

/* Of a patch: the excess of its polynomial, what is open of that for its being cut, how far the
 * surface's own may be from it, and what it is at most. */
typedef struct share {
    double sum, open, off, most;
} share;

/* Over what the patch shows of the surface. enough: what may be left open for its being cut. */
static void add_excess(const csg_graph_base *g, const csg_graph_patch *q, const level *l,
                       const csg_graph_room *off, double enough, int more, share *to)
{
    double bends = csg_graph_patch_bend(q) + csg_graph_patch_third(q), beyond = bends + off->most,
           reach = csg_graph_patch_line(q) + beyond;
    double h = g->half, touched = csg_graph_patch_area(q), open = 0, sum;
    if (q->z + reach <= -h || q->z - reach >= h)
        return;
    const tilt t = tilt_of(q, l);
    if (csg_graph_patch_is_whole(g, q, off->most))
        sum = excess_of_whole(q, l, &t, &open);
    else
        sum = excess_of_cut(g, q, l, &t, beyond, &touched, &open);
    if (open > enough && more) {
        int axis = csg_graph_patch_bent_axis(q);
        for (int side = -1; side <= 1; side += 2) {
            csg_graph_patch half = csg_graph_patch_half(q, axis, side);
            add_excess(g, &half, l, off, 0.5 * enough, more - 1, to);
        }
        return;
    }
    double all = t.most + off->turned;
    to->sum += sum;
    to->open += open;
    to->off += touched * (t.most + 0.5 * off->turned) * off->turned;
    to->most += 0.5 * touched * all * all;
}

typedef struct excess {
    level plane;
    double sums[2];
} excess;

/* With e how far p is off, A errs by |p - p_0| |e| + |e|^2 / 2 at most, as A's second derivatives
 * are no more than 1. Over all of a first patch that is no more than by the means of the squares of
 * e and of |p - p_0|, which is `first` and what p turns by along |d|; |d|^2 is 2/3 half^2 in the
 * mean. */
static double off_of_first(const csg_graph_patch *q, const tilt *t, const csg_graph_room *off)
{
    static const double ROOT_SECOND = 0.8165;
    double turn = sqrt(t->turn[0] * t->turn[0] + t->turn[1] * t->turn[1]);
    return csg_graph_patch_area(q) * off->turned_rms *
           (t->first + ROOT_SECOND * turn * q->half[0] + 0.5 * off->turned_rms);
}

static double cross(void *user, const csg_graph_base *g, const csg_graph_patch *q,
                    const csg_graph_room *off)
{
    excess *e = user;
    const tilt t = tilt_of(q, &e->plane);
    double area = csg_graph_patch_area(q), first = g->half / CSG_GRAPH_SIDE,
           most = area * t.most * off->turned;
    bool is_first = q->half[0] == first && q->half[1] == first;
    share s = {.sum = 0};
    if (is_first)
        most = fmin(most, off_of_first(q, &t, off));
    add_excess(g, q, &e->plane, off, CSG_GRAPH_SHARE * most, CSG_GRAPH_HALVED, &s);
    double open = s.open + (is_first ? fmin(s.off, off_of_first(q, &t, off)) : s.off);
    e->sums[0] += fmax(s.sum - open, 0);
    e->sums[1] += fmin(s.sum + open, s.most);
    return 0;
}

bool csg_graph_excess(const csg_taylor_pieces *f, const double slope[3], double half, double enough,
                      double *least, double *most)
{
    csg_graph_field g; /* not filled: it is large */
    excess e = {.sums = {0}};
    const csg_graph_visitor visitor = {
        .user = &e, .enough = INFINITY, .enough_turned = CSG_GRAPH_LEAST * enough, .cross = cross};
    double ignored;
    csg_graph_field_begin(&g, f, half);
    const int *axes = g.bases[0].axes;
    double steep = -g.bases[0].turn * slope[axes[2]], *p = e.plane.p;
    if (!(steep > 0))
        return false;
    for (int k = 0; k < 2; k++)
        p[k] = slope[axes[k]] / steep;
    e.plane.whole = sqrt(1 + p[0] * p[0] + p[1] * p[1]);
    for (int i = 0; i < CSG_GRAPH_SIDE * CSG_GRAPH_SIDE; i++) {
        csg_graph_patch q = csg_graph_patch_first(half, i);
        if (!csg_graph_field_visit(&g, &q, &visitor, &ignored))
            return false;
    }
    *least = e.sums[0] * (1 - 1e-9);
    *most = e.sums[1] * (1 + 1e-9);
    return isfinite(*most);
}

/* The field's surface is part of those of its pieces. */
double csg_graph_spread_most(const csg_taylor_pieces *f, double half, double stray_most)
{
    double radius = csg_enclosure_radius(half), sum = 0;
    for (int i = 0; i < f->count; i++) {
        const csg_taylor *of = &f->of[i].f;
        double length = csg_norm3(of->slope), stray = csg_taylor_stray(of, radius);
        if (fabs(of->value) > csg_taylor_reach(of, radius))
            continue;
        if (!(stray < stray_most * length))
            return INFINITY;
        double seen = fabs(of->slope[0]) + fabs(of->slope[1]) + fabs(of->slope[2]);
        sum += seen / sqrt(length * length - stray * stray) * (1 + 1e-9);
    }
    return sum;
}

double csg_graph_area_most(const csg_taylor_pieces *f, double half, double stray_most)
{
    return 4 * half * half * csg_graph_spread_most(f, half, stray_most) * (1 + 1e-9);
}
