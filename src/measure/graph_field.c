/* SPDX-License-Identifier: MIT
 * Graphs of fields in pieces; see graph_field.h. The height of the surface in the cube, from its
 * bottom to its top, is that of a piece which is the field there: so one that is not the field
 * anywhere on its own surface, or at the bottom or top where it has none, counts for nothing.
 */
#include "measure/graph_field.h"

#include <math.h>
#include <string.h>

enum { HALVED_MOST = 6 };

/* A patch by the surfaces of all pieces. */
typedef struct choice {
    csg_graph_patch q[CSG_TAYLOR_PIECES];
    csg_graph_columns of[CSG_TAYLOR_PIECES];
} choice;

typedef struct visit {
    const csg_graph_field *g;
    const csg_graph_visitor *visitor;
    csg_graph_room off[CSG_TAYLOR_PIECES]; /* of the first patch */
    double errors[CSG_TAYLOR_PIECES], more;
} visit;

static double half_of(const csg_graph_field *g)
{
    return g->bases[0].half;
}

/* ---- where a piece is the field ----------------------------------------------------------------
 */

/* How far second and third order reach in a box around the polynomial's centre. */
static double bends_in_box(const csg_taylor *p, const double half[3])
{
    double reach = 0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            reach += 0.5 * fabs(p->bend[csg_taylor_second[i][j]]) * half[i] * half[j];
            for (int k = 0; k < 3; k++)
                reach +=
                    fabs(p->third[csg_taylor_third[i][j][k]]) / 6 * half[i] * half[j] * half[k];
        }
    return reach;
}

/* The heights that the piece's surface has over the patch, no farther than the cube's. */
static void find_heights(const visit *v, const choice *c, int i, double *low, double *high)
{
    const csg_graph_patch *q = &c->q[i];
    double h = half_of(v->g), reach = 0;
    *low = c->of[i] == CSG_COLUMNS_FULL ? h : -h;
    *high = c->of[i] == CSG_COLUMNS_EMPTY ? -h : h;
    if (c->of[i] != CSG_COLUMNS_CROSSED)
        return;
    reach = csg_graph_patch_line(q) + csg_graph_patch_bend(q) + csg_graph_patch_third(q) +
            v->off[i].most;
    *low = fmin(fmax(q->z - reach, -h), h);
    *high = fmin(fmax(q->z + reach, -h), h);
}

/* Is the condition negative all over the piece's surface? change: how much it changes along the
 * face's axes, to which what it does is added. */
static bool is_violated(const visit *v, const choice *c, int i, const csg_taylor *condition,
                        double change[2])
{
    const csg_graph_patch *q = &c->q[i];
    double h = half_of(v->g), low, high, most = 3 * h * h;
    find_heights(v, c, i, &low, &high);
    bool is_whole = c->of[i] == CSG_COLUMNS_CROSSED && low > -h && high < h;
    const double at[3] = {q->at[0], q->at[1], is_whole ? q->z : 0.5 * (low + high)};
    const double box[3] = {q->half[0], q->half[1], 0.5 * (high - low)};
    const csg_taylor p = csg_taylor_moved(condition, at);
    double reach = bends_in_box(&p, box) + p.error + p.quartic * most * most;
    if (is_whole)
        reach += fabs(p.slope[2]) *
                 (csg_graph_patch_bend(q) + csg_graph_patch_third(q) + v->off[i].most);
    else
        reach += fabs(p.slope[2]) * box[2];
    for (int k = 0; k < 2; k++) {
        double along = fabs(p.slope[k] + (is_whole ? p.slope[2] * q->g[k] : 0)) * q->half[k];
        change[k] += along;
        reach += along;
    }
    return p.value + reach < 0;
}

/* Of the pieces `alive` those that may be the field somewhere. */
static uint32_t find_alive(const visit *v, const choice *c, uint32_t alive, double change[2])
{
    change[0] = change[1] = 0;
    for (int i = 0; i < v->g->count; i++)
        for (int n = 0; n < v->g->condition_count[i] && alive >> i & 1; n++)
            if (is_violated(v, c, i, &v->g->conditions[i][n], change))
                alive &= ~(1u << i);
    return alive;
}

/* ---- which one is taken ------------------------------------------------------------------------
 */

/* How far two surfaces are apart over the patch, as polynomials; *tilt: their gradients. */
static double apart_of(const csg_graph_patch *a, const csg_graph_patch *b, double *tilt)
{
    csg_graph_patch d = *a;
    double sum = 0, change[2][2];
    d.z -= b->z;
    for (int k = 0; k < 2; k++)
        d.g[k] -= b->g[k];
    for (int k = 0; k < 3; k++)
        d.bend[k] -= b->bend[k];
    for (int k = 0; k < 4; k++)
        d.third[k] -= b->third[k];
    double x = d.half[0], y = d.half[1];
    const double *bend = d.bend, *t = d.third;
    change[0][0] = fabs(bend[CSG_GRAPH_XX]) + fabs(t[CSG_GRAPH_XXX]) * x / 2;
    change[0][1] = fabs(bend[CSG_GRAPH_XY]) + fabs(t[CSG_GRAPH_XXY]) * x + fabs(t[2]) * y / 2;
    change[1][0] = fabs(bend[CSG_GRAPH_XY]) + fabs(t[CSG_GRAPH_XXY]) * x / 2 + fabs(t[2]) * y;
    change[1][1] = fabs(bend[CSG_GRAPH_YY]) + fabs(t[CSG_GRAPH_YYY]) * y / 2;
    for (int k = 0; k < 2; k++) {
        double most = fabs(d.g[k]) + change[k][0] * x + change[k][1] * y;
        sum += most * most;
    }
    *tilt = sqrt(sum);
    return fabs(d.z) + csg_graph_patch_line(&d) + csg_graph_patch_bend(&d) +
           csg_graph_patch_third(&d);
}

/* How far the surface may be from piece i's, where any of `alive` may be it. *apart: of that, what
 * the polynomials differ by. */
static csg_graph_room room_of(const visit *v, const choice *c, uint32_t alive, int i, double *apart)
{
    csg_graph_room off = v->off[i];
    double low, high;
    *apart = 0;
    find_heights(v, c, i, &low, &high);
    for (int k = 0; k < v->g->count; k++) {
        double tilt = 0, between = 0, from, to;
        if (k == i || !(alive >> k & 1))
            continue;
        if (c->of[k] == CSG_COLUMNS_CROSSED) {
            between = apart_of(&c->q[i], &c->q[k], &tilt);
            off.most = fmax(off.most, between + v->off[k].most);
            off.turned = fmax(off.turned, tilt + v->off[k].turned);
        } else {
            find_heights(v, c, k, &from, &to);
            between = fmax(high - from, to - low);
            off.most = fmax(off.most, between);
        }
        *apart = fmax(*apart, between);
    }
    return off;
}

static void take(visit *v, const choice *c, int i, const csg_graph_room *off)
{
    const csg_graph_base *base = &v->g->bases[i];
    if (c->of[i] == CSG_COLUMNS_FULL && v->visitor->fill)
        v->visitor->fill(v->visitor->user, base, &c->q[i]);
    if (c->of[i] != CSG_COLUMNS_CROSSED)
        return;
    double shown = v->visitor->cross(v->visitor->user, base, &c->q[i], off);
    v->errors[i] += shown * v->off[i].most;
    v->more += shown * (off->most - v->off[i].most);
}

static choice half_of_choice(const visit *v, const choice *c, int axis, int side)
{
    choice out = *c;
    for (int i = 0; i < v->g->count; i++)
        out.q[i] = csg_graph_patch_half(&c->q[i], axis, side);
    return out;
}

static bool look(visit *v, const choice *c, uint32_t alive, int more)
{
    double change[2], apart = 0;
    int taken = -1;
    uint32_t all = alive, bits = 0;
    bool is_known = true;
    if (alive & (alive - 1))
        all = alive = find_alive(v, c, alive, change);
    for (int i = 0; i < v->g->count; i++) {
        if (!(alive >> i & 1))
            continue;
        bits |= 1u << c->of[i];
        if (taken < 0 || (c->of[i] == CSG_COLUMNS_CROSSED && c->of[taken] != CSG_COLUMNS_CROSSED))
            taken = i;
    }
    if (taken < 0)
        return false;
    is_known = !(bits >> CSG_COLUMNS_UNKNOWN & 1) && c->of[taken] == CSG_COLUMNS_CROSSED;
    if (!(bits >> CSG_COLUMNS_UNKNOWN & 1) && !(bits & (bits - 1)) && !is_known) {
        take(v, c, taken, &v->off[taken]);
        return true;
    }
    if (is_known) {
        csg_graph_room off = room_of(v, c, all, taken, &apart);
        if (apart <= CSG_GRAPH_SHARE * v->off[taken].mean || !more) {
            take(v, c, taken, &off);
            return true;
        }
    }
    if (!more || !(alive & (alive - 1)))
        return false;
    int axis = change[1] > change[0];
    for (int side = -1; side <= 1; side += 2) {
        choice half = half_of_choice(v, c, axis, side);
        if (!look(v, &half, alive, more - 1))
            return false;
    }
    return true;
}

bool csg_graph_field_visit(const csg_graph_field *g, const csg_graph_patch *first,
                           const csg_graph_visitor *visitor, double *error)
{
    visit v = {.g = g, .visitor = visitor};
    choice c;
    for (int i = 0; i < g->count; i++) {
        c.q[i] = *first;
        c.of[i] = csg_graph_patch_place(&g->bases[i], &c.q[i], &v.off[i]);
    }
    if (!look(&v, &c, (1u << g->count) - 1, HALVED_MOST))
        return false;
    for (int i = 0; i < g->count; i++)
        if (v.errors[i] > 0)
            *error += fmin(v.errors[i], csg_graph_patch_area(first) * v.off[i].mean);
    *error += v.more;
    return true;
}

/* ---- the axes ----------------------------------------------------------------------------------
 */

bool csg_graph_field_begin(csg_graph_field *g, const csg_taylor_pieces *f, double half)
{
    double slope[3] = {0};
    g->count = f->count;
    for (int i = 0; i < f->count; i++)
        for (int k = 0; k < 3; k++)
            slope[k] += f->of[i].f.slope[k];
    for (int i = 0; i < f->count; i++) {
        const csg_taylor_piece *piece = &f->of[i];
        if (!csg_graph_patch_begin(&g->bases[i], &piece->f, slope, half))
            return false;
        g->condition_count[i] = piece->condition_count;
        for (int n = 0; n < piece->condition_count; n++)
            g->conditions[i][n] = csg_graph_patch_turned(&g->bases[i], &piece->conditions[n]);
    }
    return true;
}
