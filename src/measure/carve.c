/* SPDX-License-Identifier: MIT
 * Carved cubes; see carve.h. The cube is six tetrahedra around a diagonal; one that a plane crosses
 * is cut into tetrahedra of either side, until the formula is decided.
 */
#include "measure/carve.h"

#include <math.h>
#include <string.h>

enum { MOST_PIECES = 1500 /* of one cube: more would not be worth it, nor within the rounding */ };

typedef struct carving {
    const csg_halves *halves;
    double values[CSG_HALVES_MOST]; /* at the cube's centre, moved to this side */
    double sum[CSG_INTEGRALS];
    int pieces;
} carving;

typedef struct corner {
    double at[3];
} corner;

static double value_at(const carving *c, int plane, const corner *p)
{
    const double *slope = c->halves->planes[plane].slope;
    return c->values[plane] + slope[0] * p->at[0] + slope[1] * p->at[1] + slope[2] * p->at[2];
}

static double determinant(const corner t[4])
{
    double u[3], v[3], w[3];
    for (int k = 0; k < 3; k++) {
        u[k] = t[1].at[k] - t[0].at[k];
        v[k] = t[2].at[k] - t[0].at[k];
        w[k] = t[3].at[k] - t[0].at[k];
    }
    return u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2]) +
           u[2] * (v[0] * w[1] - v[1] * w[0]);
}

static void add(carving *c, const corner t[4])
{
    bool is_turned = determinant(t) < 0;
    csg_integrals_add_tetrahedron(c->sum, t[0].at, t[1].at, t[is_turned ? 3 : 2].at,
                                  t[is_turned ? 2 : 3].at);
}

static corner crossing(const corner *p, double a, const corner *q, double b)
{
    corner x;
    double share = a / (a - b);
    for (int k = 0; k < 3; k++)
        x.at[k] = p->at[k] + share * (q->at[k] - p->at[k]);
    return x;
}

static bool carve(carving *c, const corner t[4], const csg_truth known[CSG_HALVES_MOST]);

/* A prism between two triangles. */
static bool carve_prism(carving *c, const corner a[3], const corner b[3],
                        const csg_truth known[CSG_HALVES_MOST])
{
    const corner first[4] = {a[0], a[1], a[2], b[0]}, second[4] = {a[1], a[2], b[0], b[1]},
                 third[4] = {a[2], b[0], b[1], b[2]};
    return carve(c, first, known) && carve(c, second, known) && carve(c, third, known);
}

/* Both sides of a plane that crosses the tetrahedron. */
static bool split(carving *c, const corner t[4], const double values[4], int plane,
                  const csg_truth known[CSG_HALVES_MOST])
{
    corner sorted[4]; /* those inside, then the others */
    double v[4];
    int in = 0, count = 0;
    csg_truth yes[CSG_HALVES_MOST], no[CSG_HALVES_MOST];
    for (int side = 0; side < 2; side++)
        for (int i = 0; i < 4; i++)
            if ((values[i] >= 0) == (side == 0)) {
                sorted[count] = t[i];
                v[count++] = values[i];
                in += side == 0;
            }
    memcpy(yes, known, sizeof yes);
    memcpy(no, known, sizeof no);
    yes[plane] = CSG_TRUTH_YES;
    no[plane] = CSG_TRUTH_NO;
    if (in == 2) {
        corner x[2][2];
        for (int i = 0; i < 2; i++)
            for (int k = 0; k < 2; k++)
                x[i][k] = crossing(&sorted[i], v[i], &sorted[2 + k], v[2 + k]);
        const corner a[3] = {sorted[0], x[0][0], x[0][1]}, b[3] = {sorted[1], x[1][0], x[1][1]};
        const corner e[3] = {sorted[2], x[0][0], x[1][0]}, f[3] = {sorted[3], x[0][1], x[1][1]};
        return carve_prism(c, a, b, yes) && carve_prism(c, e, f, no);
    }
    int tip = in == 1 ? 0 : 3, base = in == 1 ? 1 : 0;
    corner x[3];
    for (int i = 0; i < 3; i++)
        x[i] = in == 1 ? crossing(&sorted[tip], v[tip], &sorted[base + i], v[base + i])
                       : crossing(&sorted[base + i], v[base + i], &sorted[tip], v[tip]);
    const corner top[4] = {sorted[tip], x[0], x[1], x[2]};
    return carve(c, top, in == 1 ? yes : no) &&
           carve_prism(c, x, &sorted[base], in == 1 ? no : yes);
}

/* False: too many pieces. */
static bool carve(carving *c, const corner t[4], const csg_truth known[CSG_HALVES_MOST])
{
    csg_truth here[CSG_HALVES_MOST];
    double crossed[4] = {0};
    int plane = -1;
    if (++c->pieces > MOST_PIECES)
        return false;
    for (int i = 0; i < c->halves->plane_count; i++) {
        double values[4];
        int in = 0;
        here[i] = known[i];
        if (known[i] != CSG_TRUTH_OPEN)
            continue;
        for (int k = 0; k < 4; k++) {
            values[k] = value_at(c, i, &t[k]);
            in += values[k] >= 0;
        }
        here[i] = in == 4 ? CSG_TRUTH_YES : in == 0 ? CSG_TRUTH_NO : CSG_TRUTH_OPEN;
        if (here[i] == CSG_TRUTH_OPEN && plane < 0) {
            plane = i;
            memcpy(crossed, values, sizeof crossed);
        }
    }
    csg_truth holds = csg_halves_evaluate(c->halves, here);
    if (holds == CSG_TRUTH_YES)
        add(c, t);
    return holds != CSG_TRUTH_OPEN || split(c, t, crossed, plane, here);
}

/* The tetrahedra of each order of the axes, from one corner to the opposite one. */
static bool carve_cube(carving *c, double half)
{
    static const int AXES[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2},
                                   {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    csg_truth known[CSG_HALVES_MOST];
    for (int i = 0; i < CSG_HALVES_MOST; i++)
        known[i] = CSG_TRUTH_OPEN;
    for (int n = 0; n < 6; n++) {
        corner t[4] = {{{-half, -half, -half}}};
        for (int i = 1; i < 4; i++) {
            t[i] = t[i - 1];
            t[i].at[AXES[n][i - 1]] = half;
        }
        if (!carve(c, t, known))
            return false;
    }
    return true;
}

double csg_carve(const csg_halves *h, double half, csg_carve_side side, double out[CSG_INTEGRALS])
{
    carving c = {.halves = h};
    double whole = 8 * half * half * half;
    for (int i = 0; i < h->plane_count; i++)
        c.values[i] = h->planes[i].value +
                      (side == CSG_CARVE_MOST ? h->planes[i].above : -h->planes[i].below);
    if (h->length == 1)
        return csg_cut_cube(half, c.values[0], h->planes[0].slope, out);
    bool done = carve_cube(&c, half);
    if (!done)
        memset(c.sum, 0, sizeof c.sum);
    if (out)
        memcpy(out, c.sum, sizeof c.sum);
    if (!done)
        return side == CSG_CARVE_MOST ? whole : 0;
    return fmin(fmax(c.sum[CSG_INTEGRAL_ONE], 0), whole);
}
