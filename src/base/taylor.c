/* SPDX-License-Identifier: MIT
 * Taylor models; see taylor.h. All is of doubles: their rounding, some hundred units in the last
 * place of the lengths that take part, is added once, where a model begins (ROUNDING of
 * field/taylor).
 */
#include "base/taylor.h"

#include <math.h>

#include "base/elementary.h"
#include "base/geometry.h"

enum { XX, YY, ZZ, XY, XZ, YZ };
enum { XXX, YYY, ZZZ, XXY, XXZ, XYY, YYZ, XZZ, YZZ, XYZ };

const unsigned char csg_taylor_second[3][3] = {{XX, XY, XZ}, {XY, YY, YZ}, {XZ, YZ, ZZ}};
const unsigned char csg_taylor_third[3][3][3] = {
    {{XXX, XXY, XXZ}, {XXY, XYY, XYZ}, {XXZ, XYZ, XZZ}},
    {{XXY, XYY, XYZ}, {XYY, YYY, YYZ}, {XYZ, YYZ, YZZ}},
    {{XXZ, XYZ, XZZ}, {XYZ, YYZ, YZZ}, {XZZ, YZZ, ZZZ}},
};

csg_taylor csg_taylor_constant(double value)
{
    return (csg_taylor){.value = value};
}

csg_taylor csg_taylor_sum(const csg_taylor *a, double factor, const csg_taylor *b)
{
    double size = fabs(factor);
    csg_taylor out;
    out.value = a->value + factor * b->value;
    for (int k = 0; k < 3; k++)
        out.slope[k] = a->slope[k] + factor * b->slope[k];
    for (int n = 0; n < CSG_TAYLOR_SECOND; n++)
        out.bend[n] = a->bend[n] + factor * b->bend[n];
    for (int n = 0; n < CSG_TAYLOR_THIRD; n++)
        out.third[n] = a->third[n] + factor * b->third[n];
    out.error = a->error + size * b->error;
    out.quartic = a->quartic + size * b->quartic;
    out.turned = a->turned + size * b->turned;
    out.thrice = a->thrice + size * b->thrice;
    return out;
}

csg_taylor csg_taylor_scaled(const csg_taylor *a, double factor)
{
    double size = fabs(factor);
    csg_taylor out;
    out.value = factor * a->value;
    for (int k = 0; k < 3; k++)
        out.slope[k] = factor * a->slope[k];
    for (int n = 0; n < CSG_TAYLOR_SECOND; n++)
        out.bend[n] = factor * a->bend[n];
    for (int n = 0; n < CSG_TAYLOR_THIRD; n++)
        out.third[n] = factor * a->third[n];
    out.error = size * a->error;
    out.quartic = size * a->quartic;
    out.turned = size * a->turned;
    out.thrice = size * a->thrice;
    return out;
}

void csg_taylor_turn(const double t[CSG_TAYLOR_THIRD], const double x[3],
                     double turned[CSG_TAYLOR_SECOND])
{
    turned[XX] = t[XXX] * x[0] + t[XXY] * x[1] + t[XXZ] * x[2];
    turned[YY] = t[XYY] * x[0] + t[YYY] * x[1] + t[YYZ] * x[2];
    turned[ZZ] = t[XZZ] * x[0] + t[YZZ] * x[1] + t[ZZZ] * x[2];
    turned[XY] = t[XXY] * x[0] + t[XYY] * x[1] + t[XYZ] * x[2];
    turned[XZ] = t[XXZ] * x[0] + t[XYZ] * x[1] + t[XZZ] * x[2];
    turned[YZ] = t[XYZ] * x[0] + t[YYZ] * x[1] + t[YZZ] * x[2];
}

void csg_taylor_multiply(const double b[CSG_TAYLOR_SECOND], const double x[3], double out[3])
{
    out[0] = b[XX] * x[0] + b[XY] * x[1] + b[XZ] * x[2];
    out[1] = b[XY] * x[0] + b[YY] * x[1] + b[YZ] * x[2];
    out[2] = b[XZ] * x[0] + b[YZ] * x[1] + b[ZZ] * x[2];
}

csg_taylor csg_taylor_moved(const csg_taylor *a, const double x[3])
{
    csg_taylor out = *a;
    double turned[CSG_TAYLOR_SECOND], first[3], second[3];
    csg_taylor_turn(a->third, x, turned);
    csg_taylor_multiply(a->bend, x, first);
    csg_taylor_multiply(turned, x, second);
    for (int n = 0; n < CSG_TAYLOR_SECOND; n++)
        out.bend[n] += turned[n];
    for (int i = 0; i < 3; i++) {
        out.slope[i] += first[i] + 0.5 * second[i];
        out.value += (a->slope[i] + 0.5 * first[i] + second[i] / 6) * x[i];
    }
    return out;
}

csg_taylor csg_taylor_raised(csg_taylor a, double by)
{
    a.value += by;
    return a;
}

/* Frobenius', no less than the largest eigenvalue's size. */
static double square_of_bend(const double b[CSG_TAYLOR_SECOND])
{
    return b[XX] * b[XX] + b[YY] * b[YY] + b[ZZ] * b[ZZ] +
           2 * (b[XY] * b[XY] + b[XZ] * b[XZ] + b[YZ] * b[YZ]);
}

static double square_of_third(const double t[CSG_TAYLOR_THIRD])
{
    return t[XXX] * t[XXX] + t[YYY] * t[YYY] + t[ZZZ] * t[ZZZ] + 6 * t[XYZ] * t[XYZ] +
           3 * (t[XXY] * t[XXY] + t[XXZ] * t[XXZ] + t[XYY] * t[XYY] + t[YYZ] * t[YYZ] +
                t[XZZ] * t[XZZ] + t[YZZ] * t[YZZ]);
}

double csg_taylor_third_norm(const csg_taylor *a)
{
    return sqrt(square_of_third(a->third));
}

double csg_taylor_bends(const csg_taylor *a, const double half[3])
{
    double b[CSG_TAYLOR_SECOND], t[CSG_TAYLOR_THIRD], along[CSG_TAYLOR_SECOND], first[3], second[3],
        reach = 0;
    for (int n = 0; n < CSG_TAYLOR_SECOND; n++)
        b[n] = fabs(a->bend[n]);
    for (int n = 0; n < CSG_TAYLOR_THIRD; n++)
        t[n] = fabs(a->third[n]);
    csg_taylor_turn(t, half, along);
    csg_taylor_multiply(b, half, first);
    csg_taylor_multiply(along, half, second);
    for (int i = 0; i < 3; i++)
        reach += (0.5 * first[i] + second[i] / 6) * half[i];
    return reach * (1 + 1e-12);
}

/* Half an edge of the cube. */
static double half_of(double r)
{
    static const double OF_RADIUS = 0.57735026918962576; /* sqrt(1/3) */
    return OF_RADIUS * r * (1 + 1e-12);
}

double csg_taylor_reach(const csg_taylor *a, double r)
{
    double half = half_of(r), square = r * r;
    const double box[3] = {half, half, half};
    double line = (fabs(a->slope[0]) + fabs(a->slope[1]) + fabs(a->slope[2])) * half;
    return (line + csg_taylor_bends(a, box) + a->quartic * square * square + a->error) *
           (1 + 1e-12);
}

/* Of bends by their norm, or by how far each row reaches, which is less where they are along an
 * axis; the norm by the largest row sum where that is less: the bends of a ball are the same in two
 * directions. */
double csg_taylor_stray(const csg_taylor *a, double r)
{
    const double *b = a->bend;
    double rows[3] = {fabs(b[XX]) + fabs(b[XY]) + fabs(b[XZ]),
                      fabs(b[XY]) + fabs(b[YY]) + fabs(b[YZ]),
                      fabs(b[XZ]) + fabs(b[YZ]) + fabs(b[ZZ])};
    double norm = fmin(sqrt(square_of_bend(b)), fmax(rows[0], fmax(rows[1], rows[2])));
    double bend = fmin(norm * r, csg_norm3(rows) * half_of(r));
    double third = 0.5 * csg_taylor_third_norm(a);
    return (bend + (third + a->thrice * r) * r * r + a->turned) * (1 + 1e-12);
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
    double reaches = 0;
    for (int i = 0; i < count; i++) {
        double reach = csg_taylor_reach(u[i], r);
        reaches += reach * reach;
        c.square += square_of_bend(u[i]->bend);
        c.cubic += square_of_third(u[i]->third);
        c.quartic += u[i]->quartic * u[i]->quartic;
        c.error += u[i]->error * u[i]->error;
        c.turned += u[i]->turned * u[i]->turned;
        c.thrice += u[i]->thrice * u[i]->thrice;
    }
    c.square = sqrt(c.square);
    c.cubic = sqrt(c.cubic);
    c.quartic = sqrt(c.quartic);
    c.error = sqrt(c.error);
    c.turned = sqrt(c.turned);
    c.thrice = sqrt(c.thrice);
    double rest = 0.5 * c.square + (c.cubic / 6 + c.quartic * r) * r;
    c.most = fmin(sqrt(reaches), (c.linear + rest * r) * r + c.error) * (1 + 1e-12);
    return c;
}

double csg_taylor_steepest(const csg_taylor_change *c, double r)
{
    return (c->linear + (c->square + (0.5 * c->cubic + c->thrice * r) * r) * r + c->turned) *
           (1 + 1e-12);
}

/* With d = l + b + t the functions' change at |x| = r, l and b its first and second order, the
 * outer function is
 *     value + slope . d + bend(d, d) / 2 + third(d, d, d) / 6 + at most fourth |d|^4,
 * of which the polynomial has slope . d up to third order, bend(l, l) / 2 + bend(l, b) and
 * third(l, l, l) / 6. What is off beside slope . (what the functions are off): with q = b + t
 *     norm (|l| |t| + |q|^2 / 2) + third_norm |q| (3 |l|^2 + 3 |l| |q| + |q|^2) / 6 + fourth |d|^4.
 */
static double remainder_of(const csg_taylor_outer *o, const csg_taylor_change *c, double r,
                           double error)
{
    double l = c->linear * r, t = (c->cubic / 6 + c->quartic * r) * r * r * r + error;
    double q = 0.5 * c->square * r * r + t, d = l + q;
    return o->norm * (l * t + 0.5 * q * q) + o->third_norm / 6 * q * (3 * l * d + q * q) +
           o->fourth * d * d * d * d;
}

/* The gradient is (slope + bend d + third(d, d) / 2 + at most 4 fourth |d|^3) . (S + s + w), with S
 * the slopes, s what they turn by at first order and w the rest. */
static double turn_of(const csg_taylor_outer *o, const csg_taylor_change *c, double r, double error,
                      double turned)
{
    double l = c->linear * r, t = (c->cubic / 6 + c->quartic * r) * r * r * r + error;
    double q = 0.5 * c->square * r * r + t, d = l + q;
    double s = c->square * r, w = (0.5 * c->cubic + c->thrice * r) * r * r + turned;
    return o->norm * (t * c->linear + q * s + d * w) +
           0.5 * o->third_norm * (q * (2 * l + q) * c->linear + d * d * (s + w)) +
           4 * o->fourth * d * d * d * (c->linear + s + w);
}

/* What is off beside the functions' own, with their constants and without, and the same of the
 * gradient: without them every term has a fourth power of r at least, or a third, so at |x| it is
 * no more than that share of it. What the constants add grows with r. */
static void add_remainder(double without, double with, double turn_without, double turn_with,
                          double r, csg_taylor *out)
{
    static const double ROUNDING = 1e-14 /* of differences */, MORE = 1 + 1e-12;
    double cube = r * r * r;
    out->quartic = (out->quartic + without / (cube * r)) * MORE;
    out->thrice = (out->thrice + turn_without / cube) * MORE;
    out->error = (out->error + fmax(with - without, 0) + ROUNDING * without) * MORE;
    out->turned =
        (out->turned + fmax(turn_with - turn_without, 0) + ROUNDING * turn_without) * MORE;
}

static void find_remainder(const csg_taylor_outer *o, const csg_taylor *const *u, int count,
                           const csg_taylor_change *c, double r, csg_taylor *out)
{
    for (int i = 0; i < count; i++) {
        double slope = fabs(o->slope[i]);
        out->quartic += slope * u[i]->quartic;
        out->error += slope * u[i]->error;
        out->thrice += slope * u[i]->thrice;
        out->turned += slope * u[i]->turned;
    }
    add_remainder(remainder_of(o, c, r, 0), remainder_of(o, c, r, c->error), turn_of(o, c, r, 0, 0),
                  turn_of(o, c, r, c->error, c->turned), r, out);
}

/* The third derivatives of factor (l . x) (x . b x) / 2. */
static void add_product(double factor, const double l[3], const double b[CSG_TAYLOR_SECOND],
                        double t[CSG_TAYLOR_THIRD])
{
    double x = factor * l[0], y = factor * l[1], z = factor * l[2];
    t[XXX] += 3 * x * b[XX];
    t[YYY] += 3 * y * b[YY];
    t[ZZZ] += 3 * z * b[ZZ];
    t[XXY] += y * b[XX] + 2 * x * b[XY];
    t[XXZ] += z * b[XX] + 2 * x * b[XZ];
    t[XYY] += x * b[YY] + 2 * y * b[XY];
    t[YYZ] += z * b[YY] + 2 * y * b[YZ];
    t[XZZ] += x * b[ZZ] + 2 * z * b[XZ];
    t[YZZ] += y * b[ZZ] + 2 * z * b[YZ];
    t[XYZ] += x * b[YZ] + y * b[XZ] + z * b[XY];
}

/* What the outer function's bends make of the functions' slopes, bend(l, l), and of these and
 * their bends, bend(l, b). */
static void add_bends(const csg_taylor_outer *o, const csg_taylor *const *u, int count,
                      double own[CSG_TAYLOR_SECOND], double third[CSG_TAYLOR_THIRD])
{
    static const int ROW[] = {0, 1, 2, 0, 0, 1}, COLUMN[] = {0, 1, 2, 1, 2, 2};
    const double *bend = o->bend;
    for (int i = 0; i < count; i++)
        for (int j = i; j < count; j++, bend++) {
            const double *a = u[i]->slope, *b = u[j]->slope;
            double share = i == j ? 0.5 * *bend : *bend;
            for (int n = 0; n < CSG_TAYLOR_SECOND; n++)
                own[n] += share * (a[ROW[n]] * b[COLUMN[n]] + a[COLUMN[n]] * b[ROW[n]]);
            add_product(*bend, a, u[j]->bend, third);
            if (i != j)
                add_product(*bend, b, u[i]->bend, third);
        }
}

csg_taylor csg_taylor_compose(const csg_taylor_outer *o, const csg_taylor *const *u, int count,
                              const csg_taylor_change *change, double r)
{
    csg_taylor out = {.value = o->value};
    double own[CSG_TAYLOR_SECOND] = {0};
    for (int i = 0; i < count; i++) {
        for (int k = 0; k < 3; k++)
            out.slope[k] += o->slope[i] * u[i]->slope[k];
        for (int n = 0; n < CSG_TAYLOR_SECOND; n++)
            out.bend[n] += o->slope[i] * u[i]->bend[n];
        for (int n = 0; n < CSG_TAYLOR_THIRD; n++)
            out.third[n] += o->slope[i] * u[i]->third[n];
    }
    add_bends(o, u, count, own, out.third);
    add_product(o->third, out.slope, own, out.third);
    for (int n = 0; n < CSG_TAYLOR_SECOND; n++)
        out.bend[n] += own[n];
    find_remainder(o, u, count, change, r, &out);
    return out;
}

/* Along a line the length d of a vector that makes the angle of cosine c with it, s^2 = 1 - c^2,
 * has the derivatives d_1 = c, d_2 = s^2 / d, d_3 = -3 d_1 d_2 / d, 2 / sqrt(3) / d^2 at most, and
 * d_4 = s^2 (12 - 15 s^2) / d^3, 3 / d^3 at most; a symmetric form is nowhere larger than on some
 * one direction. */
bool csg_taylor_norm(const csg_taylor *const *u, int count, double r, csg_taylor *out)
{
    static const double THIRD = 1.1547005383792517 * (1 + 1e-12), FOURTH = 0.125;
    csg_taylor_outer o = {.value = 0};
    double square = 0;
    int at = 0;
    if (count > CSG_TAYLOR_MOST)
        return false;
    csg_taylor_change change = csg_taylor_change_of(u, count, r);
    for (int i = 0; i < count; i++)
        square += u[i]->value * u[i]->value;
    double length = sqrt(square), least = length - change.most;
    if (!(least > 0.05 * length)) /* nearer, nothing is told by fourth derivatives */
        return false;
    o.value = length;
    for (int i = 0; i < count; i++)
        o.slope[i] = u[i]->value / length;
    if (count > 1) {
        for (int i = 0; i < count; i++)
            for (int j = i; j < count; j++)
                o.bend[at++] = ((i == j) - o.slope[i] * o.slope[j]) / length;
        o.norm = 1 / length;
        o.third = -1 / length;
        o.third_norm = THIRD / square;
        o.fourth = FOURTH / (least * least * least);
    }
    *out = csg_taylor_compose(&o, u, count, &change, r);
    return true;
}

bool csg_taylor_root(const csg_taylor *a, double r, csg_taylor *out)
{
    csg_taylor_change change = csg_taylor_change_of(&a, 1, r);
    double v = a->value, least = v - change.most, root = sqrt(v);
    if (!(least > 0.02 * v))
        return false;
    const csg_taylor_outer o = {.value = root,
                                .slope = {0.5 / root},
                                .bend = {-0.25 / (root * v)},
                                .third = -1 / root,
                                .norm = 0.25 / (root * v),
                                .third_norm = 0.375 / (root * v * v),
                                .fourth = 0.0390625 / (least * least * least * sqrt(least))};
    *out = csg_taylor_compose(&o, &a, 1, &change, r);
    return true;
}

bool csg_taylor_inverse(const csg_taylor *a, double r, csg_taylor *out)
{
    csg_taylor_change change = csg_taylor_change_of(&a, 1, r);
    double v = a->value, square = v * v, least = fabs(v) - change.most;
    if (!(least > 0.1 * fabs(v)))
        return false;
    const csg_taylor_outer o = {.value = 1 / v,
                                .slope = {-1 / square},
                                .bend = {2 / (square * v)},
                                .third = v,
                                .norm = 2 / fabs(square * v),
                                .third_norm = 6 / (square * square),
                                .fourth = 1 / (least * least * least * least * least)};
    *out = csg_taylor_compose(&o, &a, 1, &change, r);
    return true;
}

/* With l, s, t what a factor changes by: its first order, its second, and the rest. Of the product
 * the polynomial has l_a l_b, l_a s_b and s_a l_b. */
typedef struct parts {
    double l, s, t;                   /* at most, at |x| = r */
    double turn_l, turn_s, turn_rest; /* and their gradients */
} parts;

static parts parts_of(const csg_taylor *a, double r, double error, double turned)
{
    double linear = csg_norm3(a->slope), square = sqrt(square_of_bend(a->bend)),
           cubic = csg_taylor_third_norm(a);
    return (parts){.l = linear * r,
                   .s = 0.5 * square * r * r,
                   .t = (cubic / 6 + a->quartic * r) * r * r * r + error,
                   .turn_l = linear,
                   .turn_s = square * r,
                   .turn_rest = (0.5 * cubic + a->thrice * r) * r * r + turned};
}

static double rest_of_product(const parts *a, const parts *b)
{
    return a->l * b->t + a->t * b->l + (a->s + a->t) * (b->s + b->t);
}

static double turn_of_product(const parts *a, const parts *b)
{
    return a->turn_l * b->t + a->l * b->turn_rest + b->turn_l * a->t + b->l * a->turn_rest +
           (a->turn_s + a->turn_rest) * (b->s + b->t) + (a->s + a->t) * (b->turn_s + b->turn_rest);
}

csg_taylor csg_taylor_product(const csg_taylor *a, const csg_taylor *b, double r)
{
    static const int ROW[] = {0, 1, 2, 0, 0, 1}, COLUMN[] = {0, 1, 2, 1, 2, 2};
    csg_taylor first = csg_taylor_scaled(a, b->value);
    csg_taylor out = csg_taylor_sum(&first, a->value, b);
    out.value = a->value * b->value;
    for (int n = 0; n < CSG_TAYLOR_SECOND; n++)
        out.bend[n] +=
            a->slope[ROW[n]] * b->slope[COLUMN[n]] + a->slope[COLUMN[n]] * b->slope[ROW[n]];
    add_product(1, a->slope, b->bend, out.third);
    add_product(1, b->slope, a->bend, out.third);
    const parts pa = parts_of(a, r, 0, 0), pb = parts_of(b, r, 0, 0),
                qa = parts_of(a, r, a->error, a->turned), qb = parts_of(b, r, b->error, b->turned);
    add_remainder(rest_of_product(&pa, &pb), rest_of_product(&qa, &qb), turn_of_product(&pa, &pb),
                  turn_of_product(&qa, &qb), r, &out);
    return out;
}

csg_taylor csg_taylor_square(const csg_taylor *a, double r)
{
    const csg_taylor_outer o = {
        .value = a->value * a->value, .slope = {2 * a->value}, .bend = {2}, .norm = 2};
    csg_taylor_change change = csg_taylor_change_of(&a, 1, r);
    return csg_taylor_compose(&o, &a, 1, &change, r);
}

/* Between 0 and the largest power in the cube. */
static csg_taylor power_near_zero(const csg_taylor *a, const csg_taylor_change *c, double p,
                                  double r)
{
    double most = fabs(a->value) + c->most, slope = csg_taylor_steepest(c, r);
    double half = 0.5 * csg_pow(most, p) * (1 + 1e-12);
    return (csg_taylor){
        .value = half, .error = half, .turned = p * csg_pow(most, p - 1) * slope * (1 + 1e-12)};
}

bool csg_taylor_power(const csg_taylor *a, double p, double r, csg_taylor *out)
{
    const csg_taylor turned = csg_taylor_scaled(a, a->value < 0 ? -1 : 1);
    const csg_taylor *of = &turned;
    csg_taylor_change change = csg_taylor_change_of(&of, 1, r);
    double v = turned.value, least = v - change.most, most = v + change.most;
    if (p == 2 || p == 4) {
        csg_taylor square = csg_taylor_square(a, r);
        *out = p == 2 ? square : csg_taylor_square(&square, r);
        return true;
    }
    if (!(least > 0.1 * v)) {
        *out = power_near_zero(a, &change, p, r);
        return p >= 1;
    }
    double top = csg_pow(v, p), slope = p * top / v, bend = (p - 1) * slope / v;
    double third = (p - 2) * bend / v, fourth = fabs(p * (p - 1) * (p - 2) * (p - 3)) / 24;
    const csg_taylor_outer o = {.value = top,
                                .slope = {slope},
                                .bend = {bend},
                                .third = (p - 2) / (3 * p * top),
                                .norm = fabs(bend),
                                .third_norm = fabs(third),
                                .fourth = fourth * csg_pow(p < 4 ? least : most, p - 4)};
    *out = csg_taylor_compose(&o, &of, 1, &change, r);
    return true;
}
