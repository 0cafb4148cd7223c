/* SPDX-License-Identifier: MIT
 * Patches; see graph_patch.h.
 */
#include "measure/graph_patch.h"

#include <math.h>
#include <string.h>

enum { CORNERS = 4 };

static void order_axes(csg_graph_base *g, const double slope[3])
{
    int up = 0;
    for (int k = 1; k < 3; k++)
        up = fabs(slope[k]) > fabs(slope[up]) ? k : up;
    g->turn = slope[up] > 0 ? -1 : 1;
    for (int i = 0; i < 3; i++)
        g->axes[i] = (up + 1 + i) % 3;
}

csg_taylor csg_graph_patch_turned(const csg_graph_base *g, const csg_taylor *f)
{
    const double sign[3] = {1, 1, g->turn};
    const int *axes = g->axes;
    csg_taylor p = *f;
    for (int i = 0; i < 3; i++) {
        p.slope[i] = sign[i] * f->slope[axes[i]];
        for (int j = i; j < 3; j++) {
            p.bend[csg_taylor_second[i][j]] =
                sign[i] * sign[j] * f->bend[csg_taylor_second[axes[i]][axes[j]]];
            for (int k = j; k < 3; k++)
                p.third[csg_taylor_third[i][j][k]] =
                    sign[i] * sign[j] * sign[k] *
                    f->third[csg_taylor_third[axes[i]][axes[j]][axes[k]]];
        }
    }
    return p;
}

/* Of the polynomial in a box. */
typedef struct fall {
    double least;                /* how fast it falls with z, at least */
    double across[2];            /* its gradient over the face, at most */
    double bent, face, side, up; /* |H|, H the second derivatives; of the face's axes alone; of z
                                    with them; |H_zz| */
    double third;
} fall;

static double square_of(double x)
{
    return x * x;
}

/* p: around the middle of the box. */
static fall fall_in(const csg_taylor *p, const double wide[3])
{
    fall out;
    double bend[CSG_TAYLOR_SECOND], third[CSG_TAYLOR_THIRD], turned[CSG_TAYLOR_SECOND];
    double mean[CSG_TAYLOR_SECOND], change[3], squares[CSG_TAYLOR_SECOND];
    for (int n = 0; n < CSG_TAYLOR_THIRD; n++)
        third[n] = fabs(p->third[n]);
    csg_taylor_turn(third, wide, turned);
    for (int n = 0; n < CSG_TAYLOR_SECOND; n++) {
        bend[n] = fabs(p->bend[n]);
        mean[n] = bend[n] + 0.5 * turned[n];
        squares[n] = square_of(bend[n] + turned[n]);
    }
    csg_taylor_multiply(mean, wide, change);
    out.least = -p->slope[2] - change[2];
    for (int i = 0; i < 2; i++)
        out.across[i] = fabs(p->slope[i]) + change[i];
    const unsigned char(*at)[3] = csg_taylor_second;
    double face = squares[at[0][0]] + 2 * squares[at[0][1]] + squares[at[1][1]];
    double side = squares[at[0][2]] + squares[at[1][2]], up = squares[at[2][2]];
    out.bent = sqrt(face + 2 * side + up);
    out.face = sqrt(face);
    out.side = sqrt(side);
    out.up = sqrt(up);
    out.third = csg_taylor_third_norm(p);
    return out;
}

/* How steep the surface is over the face, at most, and at least its length along a direction of it.
 */
static double climb_of(const fall *f)
{
    return sqrt(f->across[0] * f->across[0] + f->across[1] * f->across[1]) / f->least;
}

static double tangent_of(const fall *f)
{
    double climb = climb_of(f);
    return sqrt(1 + climb * climb);
}

/* A 24th of the implicit function's fourth derivatives, at most: along a unit vector of the face,
 * with w = (it, climb) the tangent and q its length, |z_2| <= |H(w, w)| / fall,
 * |z_3| <= (|T| q^3 + 3 |H(w, e_z)| |z_2|) / fall and
 * |z_4| <= (6 |T| q^2 |z_2| + 3 |H_zz| |z_2|^2 + 4 |H(w, e_z)| |z_3|) / fall, T the third ones.
 * Where the surface hardly climbs and z is an axis of H, H(w, e_z) is nearly 0. */
static double fourth_of(const fall *f)
{
    double climb = climb_of(f), q = tangent_of(f), along = f->side + f->up * climb;
    double z2 = (f->face + (f->side + along) * climb) / f->least;
    double z3 = (f->third * q * q * q + 3 * along * z2) / f->least;
    double z4 = (6 * f->third * q * q * z2 + 3 * f->up * z2 * z2 + 4 * along * z3) / f->least;
    return z4 / 24;
}

/* How far it is from p's value over the patch, up to that height above and below. */
static double reach_in(const csg_taylor *p, const csg_graph_patch *q, double height)
{
    const double box[3] = {q->half[0], q->half[1], height};
    double reach = csg_taylor_bends(p, box);
    for (int i = 0; i < 3; i++)
        reach += fabs(p->slope[i]) * box[i];
    return reach;
}

/* Of p on the axis of z. */
static double value_above(const csg_taylor *p, double z)
{
    double bend = p->bend[csg_taylor_second[2][2]], third = p->third[csg_taylor_third[2][2][2]];
    return p->value + (p->slope[2] + (0.5 * bend + third / 6 * z) * z) * z;
}

/* Over the patch at this height: 1, F is more than `room` all over; -1, less than -room; else 0. p:
 * around the patch's middle. */
static int sign_at(const csg_taylor *p, const csg_graph_patch *q, double room, double z)
{
    const double up[3] = {0, 0, z};
    const csg_taylor at = csg_taylor_moved(p, up);
    double reach = room + reach_in(&at, q, 0);
    return at.value > reach ? 1 : at.value < -reach ? -1 : 0;
}

/* The derivatives of the implicit function where F is p. */
static void find_derivatives(const csg_taylor *p, csg_graph_patch *q)
{
    static const int OF[4][3] = {{0, 0, 0}, {0, 0, 1}, {0, 1, 1}, {1, 1, 1}};
    double along[2][CSG_TAYLOR_SECOND], times[2][2][3];
    const double *b = p->bend;
    double down = p->slope[2], zz = b[csg_taylor_second[2][2]], across[2], second[2][2];
    for (int i = 0; i < 2; i++)
        q->g[i] = -p->slope[i] / down;
    for (int i = 0; i < 2; i++)
        across[i] = b[csg_taylor_second[i][2]] + zz * q->g[i];
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < 2; k++)
            second[i][k] = -(b[csg_taylor_second[i][k]] + b[csg_taylor_second[i][2]] * q->g[k] +
                             across[k] * q->g[i]) /
                           down;
    const double w[2][3] = {{1, 0, q->g[0]}, {0, 1, q->g[1]}}; /* the tangents */
    for (int i = 0; i < 2; i++) {
        csg_taylor_turn(p->third, w[i], along[i]);
        for (int k = i; k < 2; k++)
            csg_taylor_multiply(along[i], w[k], times[i][k]);
    }
    q->bend[CSG_GRAPH_XX] = second[0][0];
    q->bend[CSG_GRAPH_YY] = second[1][1];
    q->bend[CSG_GRAPH_XY] = second[0][1];
    for (int n = 0; n < 4; n++) {
        int i = OF[n][0], j = OF[n][1], k = OF[n][2];
        double third = times[i][j][k] + times[i][j][2] * q->g[k]; /* T(w_i, w_j, w_k) */
        q->third[n] = -(third + second[i][j] * across[k] + second[i][k] * across[j] +
                        second[j][k] * across[i]) /
                      down;
    }
}

/* The implicit function at the patch's middle, of p, which becomes the polynomial around the root.
 * False: there is no root. *rest: of the polynomial. */
static bool expand(csg_taylor *p, csg_graph_patch *q, double *rest)
{
    enum { STEPS = 3 };
    double a = p->bend[csg_taylor_second[2][2]], b = p->slope[2], c = p->value;
    double t = p->third[csg_taylor_third[2][2][2]], under = b * b - 2 * a * c;
    if (!(under > 0 && b < 0))
        return false;
    double z = 2 * c / (sqrt(under) - b);
    for (int n = 0; n <= STEPS; n++) {
        *rest = c + (b + (0.5 * a + t / 6 * z) * z) * z;
        z -= n < STEPS ? *rest / (b + (a + 0.5 * t * z) * z) : 0;
    }
    const double up[3] = {0, 0, z};
    q->z = z;
    *p = csg_taylor_moved(p, up);
    find_derivatives(p, q);
    return isfinite(z);
}

/* ---- parts of a patch --------------------------------------------------------------------------
 */

double csg_graph_patch_area(const csg_graph_patch *q)
{
    return 4 * q->half[0] * q->half[1];
}

/* How far the polynomial's parts reach. */
double csg_graph_patch_line(const csg_graph_patch *q)
{
    return fabs(q->g[0]) * q->half[0] + fabs(q->g[1]) * q->half[1];
}

double csg_graph_patch_bend(const csg_graph_patch *q)
{
    double x = q->half[0], y = q->half[1];
    return (0.5 * (fabs(q->bend[CSG_GRAPH_XX]) * x * x + fabs(q->bend[CSG_GRAPH_YY]) * y * y) +
            fabs(q->bend[CSG_GRAPH_XY]) * x * y) *
           (1 + 1e-12);
}

double csg_graph_patch_third(const csg_graph_patch *q)
{
    double x = q->half[0], y = q->half[1];
    return ((fabs(q->third[CSG_GRAPH_XXX]) * x + 3 * fabs(q->third[CSG_GRAPH_XXY]) * y) * x * x +
            (fabs(q->third[CSG_GRAPH_YYY]) * y + 3 * fabs(q->third[CSG_GRAPH_XYY]) * x) * y * y) /
           6 * (1 + 1e-12);
}

static double line_at(const csg_graph_patch *q, double value, const double at[2])
{
    return value + q->g[0] * at[0] + q->g[1] * at[1];
}

static double bend_at(const csg_graph_patch *q, const double at[2])
{
    return 0.5 * (q->bend[CSG_GRAPH_XX] * at[0] * at[0] + q->bend[CSG_GRAPH_YY] * at[1] * at[1]) +
           q->bend[CSG_GRAPH_XY] * at[0] * at[1];
}

/* Of one half of it, along that axis. */
csg_graph_patch csg_graph_patch_half(const csg_graph_patch *q, int axis, int side)
{
    static const int THIRD[2][3] = {
        {CSG_GRAPH_XXX, CSG_GRAPH_XXY, CSG_GRAPH_XYY},
        {CSG_GRAPH_YYY, CSG_GRAPH_XYY, CSG_GRAPH_XXY}}; /* by how often across */
    static const int SECOND[2][3] = {{CSG_GRAPH_XX, CSG_GRAPH_XY, CSG_GRAPH_YY},
                                     {CSG_GRAPH_YY, CSG_GRAPH_XY, CSG_GRAPH_XX}};
    const int *third = THIRD[axis], *second = SECOND[axis];
    double d = side * 0.5 * q->half[axis];
    csg_graph_patch out = *q;
    out.half[axis] *= 0.5;
    out.at[axis] += d;
    out.z += (q->g[axis] + (0.5 * q->bend[second[0]] + q->third[third[0]] / 6 * d) * d) * d;
    out.g[axis] += (q->bend[second[0]] + 0.5 * q->third[third[0]] * d) * d;
    out.g[1 - axis] += (q->bend[second[1]] + 0.5 * q->third[third[1]] * d) * d;
    for (int n = 0; n < 3; n++)
        out.bend[second[n]] += q->third[third[n]] * d;
    return out;
}

/* The axis along which it bends more. */
int csg_graph_patch_bent_axis(const csg_graph_patch *q)
{
    double across = fabs(q->bend[CSG_GRAPH_XY]) * q->half[0] * q->half[1];
    double x = fabs(q->bend[CSG_GRAPH_XX]) * q->half[0] * q->half[0];
    double y = fabs(q->bend[CSG_GRAPH_YY]) * q->half[1] * q->half[1];
    return x == y && across > x ? q->half[1] > q->half[0] : y > x;
}

/* Where value + g . d > 0. Returns its corners. */
static int clip(const csg_graph_patch *q, double value, double polygon[CSG_GRAPH_CLIPPED][2])
{
    static const int SIGN[CORNERS][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    double values[CORNERS], corners[CORNERS][2];
    int count = 0;
    for (int i = 0; i < CORNERS; i++) {
        for (int k = 0; k < 2; k++)
            corners[i][k] = SIGN[i][k] * q->half[k];
        values[i] = line_at(q, value, corners[i]);
    }
    for (int i = 0; i < CORNERS; i++) {
        const double *from = corners[i], *to = corners[(i + 1) % CORNERS];
        double a = values[i], b = values[(i + 1) % CORNERS], share = a / (a - b);
        if (a > 0 && count < CSG_GRAPH_CLIPPED)
            memcpy(polygon[count++], from, sizeof polygon[0]);
        if ((a > 0) == (b > 0) || count >= CSG_GRAPH_CLIPPED)
            continue;
        for (int k = 0; k < 2; k++)
            polygon[count][k] = from[k] + share * (to[k] - from[k]);
        count++;
    }
    return count;
}

static double triangle_area(const double *a, const double *b, const double *c)
{
    return 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
}

csg_graph_rule csg_graph_patch_rule(const csg_graph_patch *q, double value)
{
    double polygon[CSG_GRAPH_CLIPPED][2];
    int count = clip(q, value, polygon);
    csg_graph_rule rule;
    rule.count = 0;
    for (int i = 1; i + 1 < count; i++) {
        const double *t[3] = {polygon[0], polygon[i], polygon[i + 1]};
        double area = triangle_area(t[0], t[1], t[2]);
        for (int n = 0; n < 3; n++) {
            const double *a = t[n], *b = t[(n + 1) % 3];
            rule.at[rule.count][0] = 0.5 * (a[0] + b[0]);
            rule.at[rule.count][1] = 0.5 * (a[1] + b[1]);
            rule.weight[rule.count++] = area / 3;
        }
    }
    return rule;
}

/* With u >= v >= 0 and X, Y in [-1, 1]: where s + u X + v Y > 0, as the second and third difference
 * of squares and cubes; `of_narrow` is the inner difference, over v. */
typedef struct ramp {
    double s, u, v, area;
} ramp;

static ramp ramp_of(const csg_graph_patch *q, double value)
{
    double a = fabs(q->g[0]) * q->half[0], b = fabs(q->g[1]) * q->half[1];
    return (ramp){.s = value, .u = fmax(a, b), .v = fmin(a, b), .area = csg_graph_patch_area(q)};
}

static double of_narrow_squares(double t, double v)
{
    return t >= v ? 4 * t : t > -v ? (t + v) * (t + v) / v : 0;
}

static double of_narrow_cubes(double t, double v)
{
    return t >= v ? 6 * t * t + 2 * v * v : t > -v ? (t + v) * (t + v) * (t + v) / v : 0;
}

/* The part's share of the patch's area. */
static double area_of_part(const ramp *r)
{
    if (fabs(r->s) >= r->u + r->v)
        return r->s > 0 ? r->area : 0;
    return r->area / (8 * r->u) *
           (of_narrow_squares(r->s + r->u, r->v) - of_narrow_squares(r->s - r->u, r->v));
}

/* The integral of the linear part over it. */
static double line_of_part(const ramp *r)
{
    if (fabs(r->s) >= r->u + r->v)
        return r->s > 0 ? r->area * r->s : 0;
    return r->area / (24 * r->u) *
           (of_narrow_cubes(r->s + r->u, r->v) - of_narrow_cubes(r->s - r->u, r->v));
}

static double bend_of_part(const csg_graph_patch *q, double value)
{
    const csg_graph_rule rule = csg_graph_patch_rule(q, value);
    double sum = 0;
    for (int i = 0; i < rule.count; i++)
        sum += rule.weight[i] * bend_at(q, rule.at[i]);
    return sum;
}

/* The integral of max(z - level, 0), and what is open of it: with a the linear part, b the bends
 * and t more, max(a + b + t, 0) is max(a, 0) + b [a > 0] but for t and for max(|b| - |a|, 0), whose
 * integral is that of a tent. */
double csg_graph_patch_above(const csg_graph_patch *q, double level, double *open)
{
    double value = q->z - level, line = csg_graph_patch_line(q), bend = csg_graph_patch_bend(q),
           third = csg_graph_patch_third(q);
    double reach = bend + third, x = q->half[0], y = q->half[1];
    if (value + line + reach <= 0)
        return 0;
    if (value - line - reach >= 0)
        return csg_graph_patch_area(q) *
               (value + (q->bend[CSG_GRAPH_XX] * x * x + q->bend[CSG_GRAPH_YY] * y * y) / 6);
    const ramp here = ramp_of(q, value), more = ramp_of(q, value + reach),
               less = ramp_of(q, value - reach);
    double sum = line_of_part(&here);
    *open +=
        fmax(line_of_part(&more) - 2 * sum + line_of_part(&less), 0) + third * area_of_part(&more);
    return sum + bend_of_part(q, value);
}

/* Where the surface may be in the cube, at most; and where it is for certain, at least: `beyond` is
 * negative then. */
double csg_graph_patch_shown(const csg_graph_base *g, const csg_graph_patch *q, double beyond)
{
    double up = g->half + beyond;
    const ramp above_bottom = ramp_of(q, q->z + up), above_top = ramp_of(q, q->z - up);
    return fmax(area_of_part(&above_bottom) - area_of_part(&above_top), 0);
}

/* All of it is seen in the cube, up to `more`. */
bool csg_graph_patch_is_whole(const csg_graph_base *g, const csg_graph_patch *q, double more)
{
    double reach =
        csg_graph_patch_line(q) + csg_graph_patch_bend(q) + csg_graph_patch_third(q) + more;
    return q->z - reach > -g->half && q->z + reach < g->half;
}

/* ---- what columns are --------------------------------------------------------------------------
 */

/* How far the polynomial's surface may be from the patch's height. */
static double reach_of(const csg_graph_patch *q)
{
    return csg_graph_patch_line(q) + csg_graph_patch_bend(q) + csg_graph_patch_third(q);
}

/* How far the surface may be from one of the first patches, where the polynomial falls like f: by
 * the fourth derivatives, and by what the model is off. Where that is less than half of the
 * polynomial's own farthest root all over the cube, no root of the field is farther than half as
 * far again, and what the model is off there counts alone. Means over a square: |x|^4 is no more
 * than its largest square times the mean of |x|^2, |x|^6 and |x|^8 no more than that times the
 * largest square once or twice more; those of |d|^4, |d|^6 and |d|^8 are 0.6223, 0.6858 and 0.8432
 * times half^4 and so on. p = -(f_x, f_y) / f_z is off by (1 + |p|) times what the field's gradient
 * is, over f_z; as much as the surface's place makes of the bends; and by the fourth derivatives.
 */
static csg_graph_room room_of(const csg_graph_base *g, const csg_graph_patch *q, const fall *f,
                              double off)
{
    static const double MEAN = 0.6223, MOST = 4, MOST_CUBE = 2.8285;
    static const double ROOT_SIXTH = 0.8282, ROOT_EIGHTH = 0.9183;
    const csg_taylor *of = g->f;
    csg_graph_room out;
    double h = q->half[0], cube = h * h * h, fourth = fourth_of(f), whole = fourth * cube * h;
    double far = fabs(q->z) + reach_of(q) + MOST * whole + off;
    double z = g->room < 0.5 * far * f->least ? fmin(1.5 * far, g->half) : g->half;
    double most = z * z, mean = z * z + 2.0 / 3 * h * h;
    for (int i = 0; i < 2; i++) {
        most += (fabs(q->at[i]) + h) * (fabs(q->at[i]) + h);
        mean += q->at[i] * q->at[i];
    }
    double root = sqrt(most), root_mean = sqrt(mean);
    out.most = (of->error + of->quartic * most * most) / f->least + MOST * whole + off;
    out.mean = (of->error + of->quartic * most * mean) / f->least + MEAN * whole + off;
    double rms =
        (of->error + of->quartic * most * root * root_mean) / f->least + ROOT_EIGHTH * whole + off;
    double turned = of->turned + of->thrice * most * root;
    double turned_rms = of->turned + of->thrice * most * root_mean, left = f->least - turned;
    double place = f->bent / f->least, steep = 1.4143 * tangent_of(f);
    out.turned = left > 0
                     ? steep * (turned / left + place * out.most) + MOST_CUBE * 4 * fourth * cube
                     : INFINITY;
    out.turned_rms =
        left > 0 ? steep * (turned_rms / left + place * rms) + ROOT_SIXTH * 4 * fourth * cube
                 : INFINITY;
    return out;
}

/* Does the polynomial fall from the cube to these heights? p: around the patch's middle. */
static bool falls_to(const csg_graph_base *g, const csg_taylor *p, const csg_graph_patch *q,
                     double low, double high)
{
    double bottom = fmin(low, -g->half), top = fmax(high, g->half);
    const double up[3] = {0, 0, 0.5 * (bottom + top)};
    const double wide[3] = {q->half[0], q->half[1], 0.5 * (top - bottom)};
    double change = 0, slope = p->slope[2];
    for (int i = 0; i < 3; i++) {
        double turned = 0, along = p->third[csg_taylor_third[i][2][2]] * up[2];
        double own = p->bend[csg_taylor_second[i][2]] + along;
        for (int k = 0; k < 3; k++)
            turned += fabs(p->third[csg_taylor_third[i][k][2]]) * wide[k];
        change += (fabs(own) + 0.5 * turned) * wide[i];
        slope += i == 2 ? (own - 0.5 * along) * up[2] : 0;
    }
    return slope + change < 0;
}

/* Where the surface is about the root, which p is around. A box around it is made higher until the
 * polynomial's surface cannot leave it but through its sides, and the field's is in it, too. False:
 * it cannot. */
static bool find_room(const csg_graph_base *g, const csg_taylor *p, const csg_graph_patch *q,
                      double rest, double *high, csg_graph_room *out)
{
    enum { TRIES = 3 };
    static const double MORE = 1.1, LEAST = 0x1p-6, HIGHEST = 4, CLOSE = 1e-6;
    double needed = reach_of(q);
    for (int n = 0; n < TRIES; n++) {
        *high = MORE * needed + LEAST * g->half;
        const double wide[3] = {q->half[0], q->half[1], *high};
        const fall f = fall_in(p, wide);
        if (!(f.least > 0 && *high < HIGHEST * g->half))
            return false;
        double off = fabs(rest) / f.least;
        *out = room_of(g, q, &f, off);
        needed = (f.across[0] * q->half[0] + f.across[1] * q->half[1] + g->room) / f.least + off;
        if (needed <= *high)
            return off < CLOSE * g->half && isfinite(out->most);
    }
    return false;
}

csg_graph_columns csg_graph_patch_place(const csg_graph_base *g, csg_graph_patch *q,
                                        csg_graph_room *off)
{
    const double at[3] = {q->at[0], q->at[1], 0};
    const csg_taylor p = csg_taylor_moved(&g->p, at);
    csg_taylor root = p;
    double rest, high, line = fabs(p.slope[0]) * q->half[0] + fabs(p.slope[1]) * q->half[1];
    if (fabs(p.value) > line && fabs(p.value) > reach_in(&p, q, g->half) + g->room)
        return p.value > 0 ? CSG_COLUMNS_FULL : CSG_COLUMNS_EMPTY;
    if (!falls_to(g, &p, q, 0, 0))
        return CSG_COLUMNS_UNKNOWN;
    if (p.value > 0 && value_above(&p, g->half) > 0 && sign_at(&p, q, g->room, g->half) > 0)
        return CSG_COLUMNS_FULL;
    if (p.value < 0 && value_above(&p, -g->half) < 0 && sign_at(&p, q, g->room, -g->half) < 0)
        return CSG_COLUMNS_EMPTY;
    return expand(&root, q, &rest) && find_room(g, &root, q, rest, &high, off) &&
                   (fabs(q->z) + high <= g->half || falls_to(g, &p, q, q->z - high, q->z + high))
               ? CSG_COLUMNS_CROSSED
               : CSG_COLUMNS_UNKNOWN;
}

void csg_graph_patch_turn(csg_graph_base *g, const csg_taylor *f, const double slope[3],
                          double half)
{
    double most = 3 * half * half;
    g->f = f;
    g->half = half;
    g->room = f->error + f->quartic * most * most;
    order_axes(g, slope);
    g->p = csg_graph_patch_turned(g, f);
}

csg_graph_patch csg_graph_patch_first(double half, int i)
{
    double of = half / CSG_GRAPH_SIDE;
    return (csg_graph_patch){.at = {(2 * (i % CSG_GRAPH_SIDE) + 1) * of - half,
                                    (2 * (i / CSG_GRAPH_SIDE) + 1) * of - half},
                             .half = {of, of}};
}
