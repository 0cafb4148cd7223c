/* SPDX-License-Identifier: MIT
 * Graphs of fields in pieces; see graph_field.h. Each piece falls along the axis in its own column,
 * and the field is continuous. The height of the surface in the cube, from its bottom to its top,
 * is that of a piece which is the field there: so one that is not the field anywhere on its own
 * surface, or at the bottom or top where it has none, counts for nothing.
 */
#include "measure/graph_field.h"

#include <math.h>
#include <string.h>

#include "measure/enclosure.h"

enum {
    HALVED_MOST = 6,
    LOOKS_MOST = 32 /* at parts of a first patch */
};

/* A patch by the surfaces of all pieces. */
typedef struct choice {
    csg_graph_patch q[CSG_TAYLOR_PIECES];
    csg_graph_columns of[CSG_TAYLOR_PIECES];
    csg_graph_patch where[CSG_TAYLOR_PIECES][CSG_TAYLOR_CONDITIONS];
} choice;

typedef struct visit {
    const csg_graph_field *g;
    const csg_graph_visitor *visitor;
    csg_graph_room off[CSG_TAYLOR_PIECES]; /* of the first patch */
    double rooms[CSG_TAYLOR_PIECES][CSG_TAYLOR_CONDITIONS];
    double steep[CSG_TAYLOR_PIECES][CSG_TAYLOR_CONDITIONS];
    double errors[CSG_TAYLOR_PIECES], more;
    double area; /* of the first patch */
    int looks;
} visit;

static double half_of(const csg_graph_field *g)
{
    return g->bases[0].half;
}

/* ---- where a piece is the field ----------------------------------------------------------------
 */

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

/* A condition along the piece's surface, or along the bottom or the top where it has none: to
 * second order, and how far it may be from that; and how steep it is along z in the cube. */
static void find_where(visit *v, choice *c, int i, int n)
{
    const csg_graph_patch *q = &c->q[i];
    const csg_taylor *condition = &v->g->conditions[i][n];
    csg_graph_patch *out = &c->where[i][n];
    double h = half_of(v->g), most = 3 * h * h, line = csg_graph_patch_line(q);
    double rest = csg_graph_patch_bend(q) + csg_graph_patch_third(q) + v->off[i].most;
    bool is_crossed = c->of[i] == CSG_COLUMNS_CROSSED;
    if (!is_crossed)
        line = rest = 0;
    const double at[3] = {q->at[0], q->at[1],
                          is_crossed                      ? q->z
                          : c->of[i] == CSG_COLUMNS_FULL  ? h
                          : c->of[i] == CSG_COLUMNS_EMPTY ? -h
                                                          : 0};
    const double box[3] = {q->half[0], q->half[1], line + rest};
    const csg_taylor p = csg_taylor_moved(condition, at);
    const double *b = p.bend, zz = b[csg_taylor_second[2][2]], sz = p.slope[2];
    double z[2] = {0, 0}, bends[3] = {0, 0, 0};
    if (is_crossed) {
        memcpy(z, q->g, sizeof z);
        memcpy(bends, q->bend, sizeof bends);
    }
    *out = (csg_graph_patch){.at = {q->at[0], q->at[1]},
                             .half = {q->half[0], q->half[1]},
                             .z = p.value,
                             .g = {p.slope[0] + sz * z[0], p.slope[1] + sz * z[1]}};
    for (int k = 0; k < 2; k++)
        out->bend[k] = b[csg_taylor_second[k][k]] + 2 * b[csg_taylor_second[k][2]] * z[k] +
                       zz * z[k] * z[k] + sz * bends[k];
    out->bend[CSG_GRAPH_XY] = b[csg_taylor_second[0][1]] + b[csg_taylor_second[0][2]] * z[1] +
                              b[csg_taylor_second[1][2]] * z[0] + zz * z[0] * z[1] +
                              sz * bends[CSG_GRAPH_XY];
    double across =
        fabs(b[csg_taylor_second[0][2]]) * box[0] + fabs(b[csg_taylor_second[1][2]]) * box[1];
    csg_taylor thirds = p;
    memset(thirds.bend, 0, sizeof thirds.bend);
    double bent = is_crossed ? csg_graph_patch_third(q) + v->off[i].most : 0;
    v->rooms[i][n] = condition->error + condition->quartic * most * most +
                     csg_taylor_bends(&thirds, box) + fabs(sz) * bent +
                     (across + fabs(zz) * (line + 0.5 * rest)) * rest;
    const double wide[3] = {h, h, fmax(h, fabs(at[CSG_GRAPH_XYY])) + h};
    v->steep[i][n] = fabs(sz);
    for (int k = 0; k < 3; k++) {
        v->steep[i][n] += fabs(b[csg_taylor_second[k][2]]) * wide[k];
        for (int j = 0; j < 3; j++)
            v->steep[i][n] += 0.5 * fabs(p.third[csg_taylor_third[j][k][2]]) * wide[k] * wide[j];
    }
}

/* How far from that surface the heights in the cube are that belong to it. */
static double beyond_of(const visit *v, const choice *c, int i)
{
    const csg_graph_patch *q = &c->q[i];
    double h = half_of(v->g), reach = 0;
    if (c->of[i] != CSG_COLUMNS_CROSSED)
        return c->of[i] == CSG_COLUMNS_UNKNOWN ? h : 0;
    reach = csg_graph_patch_line(q) + csg_graph_patch_bend(q) + csg_graph_patch_third(q) +
            v->off[i].most;
    return fmax(fabs(q->z) + reach - h, 0);
}

/* Is the condition negative wherever the piece's surface is? change: how much it changes along the
 * face's axes, to which what it does is added. */
static bool is_violated(const visit *v, const choice *c, int i, int n, double beyond,
                        double change[2])
{
    const csg_graph_patch *w = &c->where[i][n];
    for (int k = 0; k < 2; k++)
        change[k] += fabs(w->g[k]) * w->half[k];
    return w->z + csg_graph_patch_line(w) + csg_graph_patch_bend(w) + v->rooms[i][n] +
               v->steep[i][n] * beyond <
           0;
}

/* Of the pieces `alive` those that may be the field somewhere. */
static uint32_t find_alive(const visit *v, const choice *c, uint32_t alive, double change[2])
{
    for (int i = 0; i < v->g->count; i++) {
        double beyond = alive >> i & 1 ? beyond_of(v, c, i) : 0;
        for (int n = 0; n < v->g->condition_count[i] && alive >> i & 1; n++)
            if (is_violated(v, c, i, n, beyond, change))
                alive &= ~(1u << i);
    }
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
    change[0][1] =
        fabs(bend[CSG_GRAPH_XY]) + fabs(t[CSG_GRAPH_XXY]) * x + fabs(t[CSG_GRAPH_XYY]) * y / 2;
    change[1][0] =
        fabs(bend[CSG_GRAPH_XY]) + fabs(t[CSG_GRAPH_XXY]) * x / 2 + fabs(t[CSG_GRAPH_XYY]) * y;
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
            off.turned_rms = INFINITY;
        } else {
            find_heights(v, c, k, &from, &to);
            between = fmax(high - from, to - low);
            off.turned_rms = INFINITY;
            off.most = fmax(off.most, between);
        }
        *apart = fmax(*apart, between);
    }
    return off;
}

/* Where another one of the pieces `alive` is the surface, that is as far from piece i's as the two
 * polynomials are and as the other one is off: of all of them the means over the first patch count,
 * which one piece's own room says nothing of. */
static void take(visit *v, const choice *c, uint32_t alive, int i, const csg_graph_room *off,
                 double apart)
{
    const csg_graph_base *base = &v->g->bases[i];
    if (c->of[i] == CSG_COLUMNS_FULL && v->visitor->fill)
        v->visitor->fill(v->visitor->user, base, &c->q[i]);
    if (c->of[i] != CSG_COLUMNS_CROSSED)
        return;
    double shown = v->visitor->cross(v->visitor->user, base, &c->q[i], off);
    for (int k = 0; k < v->g->count; k++)
        v->errors[k] += alive >> k & 1 ? shown * v->off[k].most : 0;
    v->more += shown * apart;
}

/* Parts of a patch share by the roots of their areas: they stand side by side along lines. */
static bool is_enough(const visit *v, const choice *c, int i, const csg_graph_room *off,
                      double apart)
{
    double area = csg_graph_patch_area(&c->q[i]), share = sqrt(area / v->area);
    return apart <= CSG_GRAPH_SHARE * v->off[i].mean ||
           (apart * area <= v->visitor->enough * share &&
            (off->turned - v->off[i].turned) * area <= v->visitor->enough_turned * share);
}

/* Of the pieces `alive`. */
static void halve(const visit *v, const choice *c, uint32_t alive, int axis, int side, choice *out)
{
    for (int i = 0; i < v->g->count; i++) {
        if (!(alive >> i & 1))
            continue;
        out->of[i] = c->of[i];
        out->q[i] = csg_graph_patch_half(&c->q[i], axis, side);
        for (int n = 0; n < v->g->condition_count[i]; n++)
            out->where[i][n] = csg_graph_patch_half(&c->where[i][n], axis, side);
    }
}

/* At a patch that may be one of the pieces `alive`, which may be halved `more` times. False: it is
 * not told what is there. */
static bool look(visit *v, const choice *c, uint32_t alive, int more)
{
    double change[2] = {0, 0}, apart = 0;
    int taken = -1;
    uint32_t bits = 0;
    if (++v->looks > LOOKS_MOST)
        more = 0;
    if (alive & (alive - 1))
        alive = find_alive(v, c, alive, change);
    for (int i = 0; i < v->g->count; i++) {
        if (!(alive >> i & 1))
            continue;
        bits |= 1u << c->of[i];
        if (taken < 0 || (c->of[i] == CSG_COLUMNS_CROSSED && c->of[taken] != CSG_COLUMNS_CROSSED))
            taken = i;
    }
    if (taken < 0)
        return false;
    if (bits == 1u << CSG_COLUMNS_EMPTY || bits == 1u << CSG_COLUMNS_FULL) {
        take(v, c, alive, taken, &v->off[taken], 0);
        return true;
    }
    if (!(bits >> CSG_COLUMNS_UNKNOWN & 1) && c->of[taken] == CSG_COLUMNS_CROSSED) {
        csg_graph_room off = room_of(v, c, alive, taken, &apart);
        if (is_enough(v, c, taken, &off, apart) || !more) {
            take(v, c, alive, taken, &off, apart);
            return true;
        }
    }
    if (!more || !(alive & (alive - 1)))
        return false;
    int axis = change[1] > change[0];
    for (int side = -1; side <= 1; side += 2) {
        choice half; /* not filled: it is large */
        halve(v, c, alive, axis, side, &half);
        if (!look(v, &half, alive, more - 1))
            return false;
    }
    return true;
}

bool csg_graph_field_visit(const csg_graph_field *g, const csg_graph_patch *first,
                           const csg_graph_visitor *visitor, double *error)
{
    visit v; /* not filled: it is large, as is the choice */
    choice c;
    v.g = g;
    v.visitor = visitor;
    v.looks = 0;
    v.area = csg_graph_patch_area(first);
    v.more = 0;
    for (int i = 0; i < g->count; i++) {
        c.q[i] = *first;
        c.of[i] = g->of[i];
        v.off[i] = (csg_graph_room){.most = 0};
        if (c.of[i] == CSG_COLUMNS_CROSSED)
            c.of[i] = csg_graph_patch_place(&g->bases[i], &c.q[i], &v.off[i]);
        v.errors[i] = 0;
        for (int n = 0; n < g->condition_count[i] && g->count > 1; n++)
            find_where(&v, &c, i, n);
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

csg_graph_columns csg_graph_field_state(const csg_taylor *f, double half)
{
    const double box[3] = {half, half, half};
    double most = 3 * half * half,
           reach = csg_taylor_bends(f, box) + f->error + f->quartic * most * most;
    for (int k = 0; k < 3; k++)
        reach += fabs(f->slope[k]) * half;
    return f->value > reach    ? CSG_COLUMNS_FULL
           : f->value < -reach ? CSG_COLUMNS_EMPTY
                               : CSG_COLUMNS_CROSSED;
}

/* False: the piece is the field nowhere in the cube. */
static bool keep_conditions(csg_taylor_piece *piece, double half)
{
    int kept = 0;
    for (int n = 0; n < piece->condition_count; n++) {
        csg_graph_columns state = csg_graph_field_state(&piece->conditions[n], half);
        if (state == CSG_COLUMNS_EMPTY)
            return false;
        if (state == CSG_COLUMNS_FULL)
            continue;
        if (kept < n)
            piece->conditions[kept] = piece->conditions[n];
        kept++;
    }
    piece->condition_count = kept;
    return true;
}

bool csg_graph_field_keep(csg_taylor_pieces *f, double half)
{
    int kept = 0;
    for (int i = 0; i < f->count; i++) {
        if (!keep_conditions(&f->of[i], half))
            continue;
        if (kept < i)
            f->of[kept] = f->of[i];
        kept++;
    }
    f->count = kept;
    return kept > 0;
}

bool csg_graph_field_pieces(const csg_tape *tape, const double c[3], double half,
                            csg_taylor_pieces *out)
{
    return csg_tape_taylor_pieces(tape, c, csg_enclosure_radius(half), out) &&
           csg_graph_field_keep(out, half);
}

void csg_graph_field_begin(csg_graph_field *g, const csg_taylor_pieces *f, double half)
{
    double slope[3] = {0};
    g->count = f->count;
    for (int i = 0; i < f->count; i++) {
        g->of[i] = f->count > 1 ? csg_graph_field_state(&f->of[i].f, half) : CSG_COLUMNS_CROSSED;
        for (int k = 0; k < 3 && g->of[i] == CSG_COLUMNS_CROSSED; k++)
            slope[k] += f->of[i].f.slope[k];
    }
    for (int i = 0; i < f->count; i++) {
        const csg_taylor_piece *piece = &f->of[i];
        csg_graph_patch_turn(&g->bases[i], &piece->f, slope, half);
        g->condition_count[i] = piece->condition_count;
        for (int n = 0; n < piece->condition_count; n++)
            g->conditions[i][n] = csg_graph_patch_turned(&g->bases[i], &piece->conditions[n]);
    }
}
