/* SPDX-License-Identifier: MIT
 * Taylor models; see taylor.h. All is of doubles: their rounding, some hundred units in the last
 * place of the lengths that take part, is added once, where a model begins (ROUNDING of
 * field/taylor).
 */
#include "base/taylor.h"

#include <math.h>

enum { XX, YY, ZZ, XY, XZ, YZ, SECOND };

csg_taylor csg_taylor_constant(double value)
{
    return (csg_taylor){.value = value};
}

csg_taylor csg_taylor_sum(const csg_taylor *a, double factor, const csg_taylor *b)
{
    csg_taylor out = {.value = a->value + factor * b->value,
                      .error = a->error + fabs(factor) * b->error,
                      .cubic = a->cubic + fabs(factor) * b->cubic,
                      .turned = a->turned + fabs(factor) * b->turned,
                      .twice = a->twice + fabs(factor) * b->twice};
    for (int k = 0; k < 3; k++)
        out.slope[k] = a->slope[k] + factor * b->slope[k];
    for (int n = 0; n < SECOND; n++)
        out.bend[n] = a->bend[n] + factor * b->bend[n];
    return out;
}

csg_taylor csg_taylor_scaled(const csg_taylor *a, double factor)
{
    const csg_taylor none = {.value = 0};
    return csg_taylor_sum(&none, factor, a);
}

csg_taylor csg_taylor_raised(csg_taylor a, double by)
{
    a.value += by;
    return a;
}

static double square_of(const double v[3])
{
    return v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
}

/* Frobenius', no less than the largest eigenvalue's size. */
static double square_of_bend(const double b[SECOND])
{
    return b[XX] * b[XX] + b[YY] * b[YY] + b[ZZ] * b[ZZ] +
           2 * (b[XY] * b[XY] + b[XZ] * b[XZ] + b[YZ] * b[YZ]);
}

double csg_taylor_reach(const csg_taylor *a, double r)
{
    double bend = sqrt(square_of_bend(a->bend));
    return ((sqrt(square_of(a->slope)) + (0.5 * bend + a->cubic * r) * r) * r + a->error) *
           (1 + 1e-12);
}

/* By the largest row sum where that is less: the bends of a ball are the same in two directions. */
double csg_taylor_stray(const csg_taylor *a, double r)
{
    const double *b = a->bend;
    double rows[3] = {fabs(b[XX]) + fabs(b[XY]) + fabs(b[XZ]),
                      fabs(b[XY]) + fabs(b[YY]) + fabs(b[YZ]),
                      fabs(b[XZ]) + fabs(b[YZ]) + fabs(b[ZZ])};
    double norm = fmin(sqrt(square_of_bend(b)), fmax(rows[0], fmax(rows[1], rows[2])));
    return ((norm + a->twice * r) * r + a->turned) * (1 + 1e-12);
}

/* ---- functions of functions --------------------------------------------------------------------
 */

/* The norm of the matrix of slopes: the square root of the largest row sum of S S^T, which is 1
 * where they are unit vectors at right angles. */
static double norm_of_slopes(const csg_taylor *const *u, int count)
{
    double most = 0;
    for (int i = 0; i < count; i++) {
        double sum = 0;
        for (int j = 0; j < count; j++)
            sum += fabs(u[i]->slope[0] * u[j]->slope[0] + u[i]->slope[1] * u[j]->slope[1] +
                        u[i]->slope[2] * u[j]->slope[2]);
        most = fmax(most, sum);
    }
    return sqrt(most);
}

csg_taylor_change csg_taylor_change_of(const csg_taylor *const *u, int count, double r)
{
    csg_taylor_change c = {.linear = norm_of_slopes(u, count)};
    for (int i = 0; i < count; i++) {
        c.square += square_of_bend(u[i]->bend);
        c.cubic += u[i]->cubic * u[i]->cubic;
        c.error += u[i]->error * u[i]->error;
        c.turned += u[i]->turned * u[i]->turned;
        c.twice += u[i]->twice * u[i]->twice;
    }
    c.turned = sqrt(c.turned);
    c.twice = sqrt(c.twice);
    c.square = sqrt(c.square);
    c.cubic = sqrt(c.cubic);
    c.error = sqrt(c.error);
    c.most = ((c.linear + (0.5 * c.square + c.cubic * r) * r) * r + c.error) * (1 + 1e-12);
    return c;
}

/* With d = S x + q the functions' change, |S x| <= linear |x| and |q| <= (square / 2 + cubic |x|)
 * |x|^2 + error, the outer function is
 *     value + slope . d + d . bend d / 2 + at most sixth |d|^3,
 * of which the polynomial has slope . (S x + half the bends) + S x . bend S x / 2. What is off:
 *     slope . (what q is beyond the bends)
 *     + norm (2 |S x| |q| + |q|^2) / 2 + sixth (linear |x| + |q|)^3,
 * each power of |x| above the third bounded by the third and the radius, and what the constants
 * are in taken together as a constant. */
static void find_remainder(const csg_taylor_outer *o, const csg_taylor *const *u, int count,
                           const csg_taylor_change *c, double r, csg_taylor *out)
{
    double bent = 0.5 * c->square + c->cubic * r; /* |q| <= bent |x|^2 + error */
    double whole = c->linear + bent * r;          /* |d| <= whole |x| + error */
    double q = bent * r * r, d = whole * r, e = c->error;
    for (int i = 0; i < count; i++) {
        out->cubic += fabs(o->slope[i]) * u[i]->cubic;
        out->error += fabs(o->slope[i]) * u[i]->error;
    }
    out->cubic += o->norm * bent * (c->linear + 0.5 * bent * r) + o->sixth * whole * whole * whole;
    out->error += o->norm * e * (c->linear * r + q + 0.5 * e) +
                  o->sixth * e * (3 * d * d + 3 * d * e + e * e);
    out->cubic *= 1 + 1e-12;
    out->error *= 1 + 1e-12;
}

/* The gradient is (slope + bend d + at most 3 sixth |d|^2) . (S + w), |w| <= square |x| + twice
 * |x|^2 + turned; what is off from slope . (S + the bends' x) + S^T bend S x, power by power as
 * above. */
static void find_turn(const csg_taylor_outer *o, const csg_taylor *const *u, int count,
                      const csg_taylor_change *c, double r, csg_taylor *out)
{
    double bent = 0.5 * c->square + c->cubic * r, whole = c->linear + bent * r, e = c->error;
    double w = c->square + c->twice * r, third = 3 * o->sixth * (c->linear + w * r + c->turned);
    for (int i = 0; i < count; i++) {
        out->twice += fabs(o->slope[i]) * u[i]->twice;
        out->turned += fabs(o->slope[i]) * u[i]->turned;
    }
    out->twice += o->norm * (bent * c->linear + whole * w) + third * whole * whole;
    out->turned += o->norm * (e * c->linear + whole * r * c->turned + e * (w * r + c->turned)) +
                   third * (2 * whole * r + e) * e;
    out->twice *= 1 + 1e-12;
    out->turned *= 1 + 1e-12;
}

csg_taylor csg_taylor_compose(const csg_taylor_outer *o, const csg_taylor *const *u, int count,
                              const csg_taylor_change *change, double r)
{
    static const int ROW[SECOND] = {0, 1, 2, 0, 0, 1}, COLUMN[SECOND] = {0, 1, 2, 1, 2, 2};
    csg_taylor out = {.value = o->value};
    const double *bend = o->bend;
    for (int i = 0; i < count; i++) {
        for (int k = 0; k < 3; k++)
            out.slope[k] += o->slope[i] * u[i]->slope[k];
        for (int n = 0; n < SECOND; n++)
            out.bend[n] += o->slope[i] * u[i]->bend[n];
        for (int j = i; j < count; j++, bend++) {
            const double *a = u[i]->slope, *b = u[j]->slope;
            double share = i == j ? 0.5 * *bend : *bend;
            for (int n = 0; n < SECOND; n++)
                out.bend[n] += share * (a[ROW[n]] * b[COLUMN[n]] + a[COLUMN[n]] * b[ROW[n]]);
        }
    }
    find_remainder(o, u, count, change, r, &out);
    find_turn(o, u, count, change, r, &out);
    return out;
}

/* Along a line the length d of a vector that makes the angle of cosine c with it has d''' = -3 c
 * (1 - c^2) / d^2, which is 2 / sqrt(3) / d^2 at most; a symmetric form is nowhere larger than on
 * some one direction. */
bool csg_taylor_norm(const csg_taylor *const *u, int count, double r, csg_taylor *out)
{
    static const double SIXTH = 0.19245008972987526 * (1 + 1e-12); /* 1 / (3 sqrt(3)) */
    csg_taylor_outer o = {.value = 0};
    double square = 0;
    int at = 0;
    if (count > CSG_TAYLOR_MOST)
        return false;
    csg_taylor_change change = csg_taylor_change_of(u, count, r);
    for (int i = 0; i < count; i++)
        square += u[i]->value * u[i]->value;
    double length = sqrt(square), least = length - change.most;
    if (!(least > 0.05 * length)) /* nearer, nothing is told by third derivatives */
        return false;
    o.value = length;
    for (int i = 0; i < count; i++)
        o.slope[i] = u[i]->value / length;
    for (int i = 0; i < count; i++)
        for (int j = i; j < count; j++)
            o.bend[at++] = ((i == j) - o.slope[i] * o.slope[j]) / length;
    o.norm = count > 1 ? 1 / length : 0;
    o.sixth = count > 1 ? SIXTH / (least * least) : 0;
    *out = csg_taylor_compose(&o, u, count, &change, r);
    return true;
}

static csg_taylor of_one(double value, double slope, double bend, double sixth, const csg_taylor *a,
                         const csg_taylor_change *change, double r)
{
    const csg_taylor_outer o = {
        .value = value, .slope = {slope}, .bend = {bend}, .norm = fabs(bend), .sixth = sixth};
    return csg_taylor_compose(&o, &a, 1, change, r);
}

bool csg_taylor_root(const csg_taylor *a, double r, csg_taylor *out)
{
    csg_taylor_change change = csg_taylor_change_of(&a, 1, r);
    double least = a->value - change.most, root = sqrt(a->value);
    if (!(least > 0.02 * a->value))
        return false;
    *out = of_one(root, 0.5 / root, -0.25 / (root * a->value),
                  0.0625 / (least * least * sqrt(least)), a, &change, r);
    return true;
}

bool csg_taylor_inverse(const csg_taylor *a, double r, csg_taylor *out)
{
    csg_taylor_change change = csg_taylor_change_of(&a, 1, r);
    double v = a->value, least = fabs(v) - change.most;
    if (!(least > 0.1 * fabs(v)))
        return false;
    *out = of_one(1 / v, -1 / (v * v), 2 / (v * v * v), 1 / (least * least * least * least), a,
                  &change, r);
    return true;
}

csg_taylor csg_taylor_product(const csg_taylor *a, const csg_taylor *b, double r)
{
    const csg_taylor *const u[2] = {a, b};
    const csg_taylor_outer o = {
        .value = a->value * b->value, .slope = {b->value, a->value}, .bend = {0, 1, 0}, .norm = 1};
    csg_taylor_change change = csg_taylor_change_of(u, 2, r);
    return csg_taylor_compose(&o, u, 2, &change, r);
}

csg_taylor csg_taylor_square(const csg_taylor *a, double r)
{
    csg_taylor_change change = csg_taylor_change_of(&a, 1, r);
    return of_one(a->value * a->value, 2 * a->value, 2, 0, a, &change, r);
}
