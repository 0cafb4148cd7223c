/* SPDX-License-Identifier: MIT
 * Elementary functions in sums of two doubles; see elementary.h. The sums are Dekker's (A
 * floating-point technique for extending the available precision, 1971) and Knuth's, some 100 bits
 * in all. Series are Taylor's: their first terms in sums, the rest, which are small, in double.
 *
 * A quick way comes first, which looks up a value nearby and adds what is missing from it in some
 * 65 bits. Where these do not settle the last bit of a double (Ziv, Fast evaluation of elementary
 * mathematical functions with correctly rounded last bit, 1991), once in some hundred times or
 * fewer, the series follow.
 */
#include "base/elementary.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#include "base/elementary_tables.h"

typedef csg_twofold twofold;

static const twofold ONE = {1, 0}, PI = {0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53},
                     LN2 = {0x1.62e42fefa39efp-1, 0x1.abc9e3b39803fp-56},
                     LN10 = {0x1.26bb1bbb55516p+1, -0x1.f48ad494ea3e9p-53};

/* How far the quick ways are off at most: sines and cosines, and as parts of the value arcs, powers
 * of e and logarithms. */
#define ANGLE_ERROR 0x1p-62
#define ARC_ERROR 0x1p-64
#define POWER_ERROR 0x1p-66
#define LOG_ERROR 0x1p-63

/* pi / 2 in four pieces of a double each. */
static const double QUARTER[] = {0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54,
                                 -0x1.f1976b7ed8fbcp-110, 0x1.4cf98e804177dp-164};

/* ---- sums of two ------------------------------------------------------------------------ */

/* |a| >= |b|, or a = 0. */
static twofold sum_of_ordered(double a, double b)
{
    double high = a + b;
    return (twofold){high, b - (high - a)};
}

static twofold sum_of(double a, double b)
{
    double high = a + b, part = high - a;
    return (twofold){high, (a - (high - part)) + (b - part)};
}

/* Exact while nothing overflows or underflows. Not by fma(): without an instruction for it that
 * takes a hundred operations. */
static twofold product_of(double a, double b)
{
    double a_split = 134217729 * a, b_split = 134217729 * b; /* 2^27 + 1 */
    double a_high = a_split - (a_split - a), b_high = b_split - (b_split - b);
    double a_low = a - a_high, b_low = b - b_high, high = a * b;
    return (twofold){high,
                     ((a_high * b_high - high) + a_high * b_low + a_low * b_high) + a_low * b_low};
}

static twofold add(twofold a, twofold b)
{
    twofold high = sum_of(a.high, b.high), low = sum_of(a.low, b.low);
    high = sum_of_ordered(high.high, high.low + low.high);
    return sum_of_ordered(high.high, high.low + low.low);
}

static twofold negative(twofold a)
{
    return (twofold){-a.high, -a.low};
}

static twofold multiply(twofold a, twofold b)
{
    twofold p = product_of(a.high, b.high);
    return sum_of_ordered(p.high, p.low + (a.high * b.low + a.low * b.high));
}

static twofold multiply_by(twofold a, double b)
{
    twofold p = product_of(a.high, b);
    return sum_of_ordered(p.high, p.low + a.low * b);
}

static twofold divide(twofold a, twofold b)
{
    double first = a.high / b.high;
    twofold rest = add(a, negative(multiply_by(b, first)));
    double second = rest.high / b.high;
    rest = add(rest, negative(multiply_by(b, second)));
    twofold quotient = sum_of_ordered(first, second);
    return add(quotient, (twofold){rest.high / b.high, 0});
}

static twofold square_root(twofold a)
{
    if (!(a.high > 0))
        return (twofold){0, 0};
    double root = sqrt(a.high);
    twofold rest = add(a, negative(product_of(root, root)));
    return sum_of_ordered(root, rest.high / (2 * root));
}

/* By a power of two. */
static twofold scaled_by(twofold a, double power)
{
    return (twofold){a.high * power, a.low * power};
}

/* ---- series --------------------------------------------------------------------------- */

/* The sum of x^i factor / (first + step i)!, i from 0 until the factorials end: the terms from
 * `exact` on add less than a unit in the last place to the others, and need no second part. */
static twofold factorial_series(twofold x, int first, int step, int exact, int last)
{
    double rest = 0;
    int n = last;
    for (; n >= exact; n -= step)
        rest = rest * x.high + INVERSE_FACTORIAL[n].high;
    twofold sum = {rest, 0};
    for (; n >= first; n -= step)
        sum = add(multiply(sum, x), INVERSE_FACTORIAL[n]);
    return sum;
}

/* e^x - 1 of x / 2^9, |x| < 0.35, then doubled: e^2a - 1 = 2 (e^a - 1) + (e^a - 1)^2. */
static twofold exp_reduced(twofold x)
{
    enum { HALVINGS = 9 };
    twofold part = scaled_by(x, 1.0 / (1 << HALVINGS));
    twofold less_one = multiply(part, factorial_series(part, 1, 1, 6, 9));
    for (int i = 0; i < HALVINGS; i++)
        less_one = add(scaled_by(less_one, 2), multiply(less_one, less_one));
    return add(ONE, less_one);
}

/* e^x = value 2^exponent, |x| < 800. */
static twofold exp_of(twofold x, int *exponent)
{
    double turns = nearbyint(x.high / LN2.high);
    *exponent = (int)turns;
    return exp_reduced(add(x, negative(multiply_by(LN2, turns))));
}

/* x = m 2^exponent, m from 1 / sqrt 2 to sqrt 2. */
static double normal_part(double x, int *exponent)
{
    double m = frexp(x, exponent);
    if (m >= 0.70710678118654752)
        return m;
    *exponent -= 1;
    return 2 * m;
}

/* Of x > 0, finite: x = m 2^e with m about 1; log m = 2 artanh((m - 1) / (m + 1)). */
static twofold log_of(double x)
{
    enum { EXACT = 10, LAST = 21 }; /* ((sqrt 2 - 1) / (sqrt 2 + 1))^2 is 2^-5.08 */
    int exponent;
    double m = normal_part(x, &exponent);
    twofold s = divide((twofold){m - 1, 0}, sum_of(1, m)), square = multiply(s, s);
    double rest = 0;
    int k = LAST;
    for (; k >= EXACT; k--)
        rest = rest * square.high + 1.0 / (2 * k + 1);
    twofold sum = {rest, 0};
    for (; k >= 0; k--) {
        double odd = 2 * k + 1, inverse = 1 / odd;
        twofold product = product_of(inverse, odd);
        twofold term = {inverse, ((1 - product.high) - product.low) / odd};
        sum = add(multiply(sum, square), term);
    }
    return add(multiply_by(LN2, exponent), scaled_by(multiply(s, sum), 2));
}

/* Sine and cosine of |x| <= pi / 4 and a little more. */
static void sine_and_cosine(twofold x, twofold *sine, twofold *cosine)
{
    twofold square = negative(multiply(x, x));
    /* Signs alternate, so the series run in -x^2. */
    *sine = multiply(x, factorial_series(square, 1, 2, 17, 29));
    *cosine = factorial_series(square, 0, 2, 18, 28);
}

/* x less the nearest multiple of pi / 2, which is `turns` modulo 4. */
static twofold less_quarters(double x, unsigned *turns)
{
    if (fabs(x) > 0x1p42) /* such a step between doubles that any angle does */
        x = fmod(x, 2 * PI.high);
    double count = nearbyint(x / QUARTER[0]);
    *turns = (unsigned)((int64_t)count & 3);
    twofold rest = {x, 0};
    for (int i = 0; i < 4 && count != 0; i++)
        rest = add(rest, negative(product_of(count, QUARTER[i])));
    return rest;
}

/* Sine and cosine, which a turn by quarters changes for each other. */
static void turn_back(unsigned turns, twofold *sine, twofold *cosine)
{
    twofold s = *sine, c = *cosine;
    *sine = turns & 1 ? c : s;
    *cosine = turns & 1 ? s : c;
    if (turns & 2)
        *sine = negative(*sine);
    if (turns == 1 || turns == 2)
        *cosine = negative(*cosine);
}

static void turned(double x, twofold *sine, twofold *cosine)
{
    unsigned turns;
    sine_and_cosine(less_quarters(x, &turns), sine, cosine);
    turn_back(turns, sine, cosine);
}

/* The angle of (x, y), both above 0 and about 1 or less; x or y about 1. An angle in double first,
 * halved twice so that the series is short; then what is missing from it is nearly its tangent. */
static twofold angle_of(twofold y, twofold x)
{
    enum { TERMS = 13 };
    bool is_steep = y.high > x.high;
    double t = is_steep ? x.high / y.high : y.high / x.high;
    for (int i = 0; i < 2; i++)
        t /= 1 + sqrt(1 + t * t);
    double rest = 0;
    for (int k = TERMS; k >= 0; k--)
        rest = 1.0 / (2 * k + 1) - rest * t * t;
    double near = 4 * t * rest;
    near = is_steep ? PI.high / 2 - near : near;
    twofold s, c;
    turned(near, &s, &c);
    twofold across = add(multiply(y, c), negative(multiply(x, s)));
    twofold along = add(multiply(x, c), multiply(y, s));
    return add((twofold){near, 0}, divide(across, along));
}

/* ---- the quick way -------------------------------------------------------------------- */

/* Whether all numbers within `error` of `value` round to the same double. */
static bool is_settled(twofold value, double error)
{
    return value.high + (value.low - error) == value.high + (value.low + error);
}

/* e^x = value 2^exponent, |x| < 800: by the nearest 64th of a power of two. */
static twofold quick_exp(twofold x, int *exponent)
{
    double steps = nearbyint(x.high * (64 / LN2.high));
    twofold rest = add(x, negative(scaled_by(multiply_by(LN2, steps), 0x1p-6)));
    double r = rest.high;
    double tail =
        r * r *
        (1.0 / 2 + r * (1.0 / 6 + r * (1.0 / 24 + r * (1.0 / 120 + r * (1.0 / 720 + r / 5040)))));
    int64_t whole = (int64_t)steps;
    *exponent = (int)(whole >> 6);
    twofold root = ROOT_OF_TWO[whole & 63], grown = product_of(root.high, r);
    grown.low += root.high * (rest.low + tail) + root.low * (1 + r);
    twofold value = sum_of_ordered(root.high, grown.high);
    return sum_of_ordered(value.high, value.low + grown.low);
}

/* log x of x > 0, finite; as exact as 2^-64 of it. */
static twofold quick_log(double x)
{
    int exponent;
    double m = normal_part(x, &exponent);
    int i = (int)nearbyint(64 * m);
    double inverse = nearbyint(65536.0 / i) * 0x1p-10;
    twofold z = product_of(m, inverse);
    z = sum_of(z.high - 1, z.low);
    double r = z.high;
    double tail =
        r * r * r *
        (1.0 / 3 -
         r * (1.0 / 4 -
              r * (1.0 / 5 -
                   r * (1.0 / 6 - r * (1.0 / 7 - r * (1.0 / 8 - r * (1.0 / 9 - r / 10)))))));
    twofold half_square = product_of(-0.5 * r, r);
    half_square.low -= r * z.low;
    twofold rest = add(z, half_square);
    rest = sum_of_ordered(rest.high, rest.low + tail);
    if (exponent == 0)
        return i == 64 ? rest : add(LOG_OF_INVERSE[i - LOG_FIRST], rest);
    return add(add(multiply_by(LN2, exponent), LOG_OF_INVERSE[i - LOG_FIRST]), rest);
}

/* Sine and cosine of |x| <= pi / 4 and a little more, from those of the nearest 32nd; within 2^-64. */
static void quick_sine_and_cosine(twofold x, twofold *sine, twofold *cosine)
{
    double size = fabs(x.high), sign = x.high < 0 ? -1 : 1, steps = nearbyint(32 * size);
    twofold s = SINE[(int)steps], c = COSINE[(int)steps];
    twofold b = sum_of(sign * x.high - steps * 0x1p-5, sign * x.low);
    double square = b.high * b.high;
    double less =
        -b.high * square * (1.0 / 6 - square * (1.0 / 120 - square / 5040)); /* sin b - b */
    double drop =
        -square *
        (1.0 / 2 - square * (1.0 / 24 - square * (1.0 / 720 - square / 40320))); /* cos b - 1 */
    twofold by_c = product_of(c.high, b.high), by_s = product_of(-s.high, b.high);
    by_c.low += c.high * (b.low + less) + c.low * b.high + s.high * drop + s.low;
    by_s.low += -s.high * (b.low + less) - s.low * b.high + c.high * drop + c.low;
    twofold value = sum_of(s.high, by_c.high);
    value = sum_of_ordered(value.high, value.low + by_c.low);
    *sine = (twofold){sign * value.high, sign * value.low};
    value = sum_of(c.high, by_s.high);
    *cosine = sum_of_ordered(value.high, value.low + by_s.low);
}

static void quick_turned(double x, twofold *sine, twofold *cosine)
{
    unsigned turns;
    quick_sine_and_cosine(less_quarters(x, &turns), sine, cosine);
    turn_back(turns, sine, cosine);
}

/* The angle of (x, y), as of angle_of(): from that of the nearest tangent of 32nds. */
static twofold quick_angle(twofold y, twofold x)
{
    bool is_steep = y.high > x.high;
    twofold low = is_steep ? x : y, high = is_steep ? y : x;
    double steps = nearbyint(32 * (low.high / high.high)), tangent = steps * 0x1p-5;
    twofold across = add(low, negative(multiply_by(high, tangent)));
    twofold along = add(high, multiply_by(low, tangent));
    double first = across.high / along.high;
    twofold rest = add(across, negative(multiply_by(along, first)));
    twofold z = sum_of_ordered(first, rest.high / along.high);
    double square = z.high * z.high;
    z.low -= z.high * square *
             (1.0 / 3 - square * (1.0 / 5 - square * (1.0 / 7 - square * (1.0 / 9 - square / 11))));
    twofold angle = add(ARC_TANGENT[(int)steps], z);
    return is_steep ? add((twofold){QUARTER[0], QUARTER[1]}, negative(angle)) : angle;
}

/* ---- what the header offers ----------------------------------------------------------- */

double csg_sin(double x)
{
    if (x == 0)
        return x;
    if (!isfinite(x))
        return x - x;
    twofold sine, cosine;
    quick_turned(x, &sine, &cosine);
    if (!is_settled(sine, ANGLE_ERROR * fmin(1, 2 * fabs(x))))
        turned(x, &sine, &cosine);
    return sine.high;
}

double csg_cos(double x)
{
    if (!isfinite(x))
        return x - x;
    twofold sine, cosine;
    quick_turned(x, &sine, &cosine);
    if (!is_settled(cosine, ANGLE_ERROR))
        turned(x, &sine, &cosine);
    return cosine.high;
}

double csg_tan(double x)
{
    if (!isfinite(x) || x == 0)
        return csg_sin(x);
    twofold sine, cosine;
    quick_turned(x, &sine, &cosine);
    twofold tangent = divide(sine, cosine);
    double error = ANGLE_ERROR * fmin(1, 2 * fabs(x));
    error = fabs(tangent.high) * (error / fabs(sine.high) + ANGLE_ERROR / fabs(cosine.high));
    if (isfinite(error) && is_settled(tangent, 2 * error))
        return tangent.high;
    turned(x, &sine, &cosine);
    return divide(sine, cosine).high;
}

/* The angle of (x, y), as of angle_of(), or with `is_left` of (-x, y), rounded. */
static double rounded_angle(twofold y, twofold x, bool is_left)
{
    twofold angle = quick_angle(y, x);
    double error = ARC_ERROR * angle.high;
    angle = is_left ? add(PI, negative(angle)) : angle;
    if (is_settled(angle, error))
        return angle.high;
    angle = angle_of(y, x);
    return is_left ? add(PI, negative(angle)).high : angle.high;
}

/* sqrt(1 - x^2), |x| <= 1. */
static twofold other_side(double x)
{
    return square_root(multiply(sum_of(1, -x), sum_of(1, x)));
}

double csg_asin(double x)
{
    if (!(fabs(x) <= 1))
        return NAN;
    if (fabs(x) < 0x1p-60)
        return x;
    return copysign(rounded_angle((twofold){fabs(x), 0}, other_side(x), false), x);
}

double csg_acos(double x)
{
    if (!(fabs(x) <= 1))
        return NAN;
    if (x == 1)
        return 0;
    if (fabs(x) < 0x1p-60)
        return PI.high / 2;
    return rounded_angle(other_side(x), (twofold){fabs(x), 0}, x < 0);
}

double csg_atan(double x)
{
    return csg_atan2(x, 1);
}

/* The angle of (x, y), not negative, y not 0, finite, or with `is_left` of (-x, y). */
static double quarter_angle(double y, double x, bool is_left)
{
    int exponent;
    frexp(fmax(x, y), &exponent);
    double small_y = ldexp(y, -exponent), small_x = ldexp(x, -exponent);
    if (small_y <
        0x1p-60) /* the tangent is the angle; by the numbers as they came, which are exact */
        return is_left ? PI.high : y / x;
    if (small_x < 0x1p-60)
        return PI.high / 2;
    return rounded_angle((twofold){small_y, 0}, (twofold){small_x, 0}, is_left);
}

double csg_atan2(double y, double x)
{
    if (isnan(x) || isnan(y))
        return x + y;
    double a = fabs(y), b = fabs(x);
    if (isinf(a) && isinf(b))
        a = b = 1;
    else if (isinf(a))
        a = 1, b = 0;
    else if (isinf(b))
        a = 0, b = 1;
    bool is_left = signbit(x);
    double angle = a == 0 ? (is_left ? PI.high : 0) : quarter_angle(a, b, is_left);
    return copysign(angle, y);
}

double csg_exp(double x)
{
    if (isnan(x))
        return x;
    if (x > 710)
        return INFINITY;
    if (x < -746)
        return 0;
    int exponent;
    twofold value = quick_exp((twofold){x, 0}, &exponent);
    if (!is_settled(value, POWER_ERROR * value.high))
        value = exp_of((twofold){x, 0}, &exponent);
    return ldexp(value.high, exponent);
}

/* log x / by, for the x that have one; -infinity, infinity or NaN for the others. */
static double logarithm(double x, twofold by)
{
    if (isnan(x) || x < 0)
        return NAN;
    if (x == 0)
        return -INFINITY;
    if (isinf(x))
        return x;
    twofold value = quick_log(x);
    if (by.high == 1 && is_settled(value, LOG_ERROR * fabs(value.high)))
        return value.high;
    return divide(log_of(x), by).high;
}

double csg_log(double x)
{
    return logarithm(x, ONE);
}

double csg_log2(double x)
{
    return logarithm(x, LN2);
}

double csg_log10(double x)
{
    return logarithm(x, LN10);
}

/* x^n for 1 <= n <= 64, x > 0 and finite: multiplied out, so that what is exact comes out so. */
static double whole_power(double x, int n, bool is_inverse)
{
    int exponent;
    twofold base = {frexp(x, &exponent), 0}, power = ONE;
    exponent *= n;
    for (; n > 0; n >>= 1) {
        if (n & 1)
            power = multiply(power, base);
        base = multiply(base, base);
    }
    return is_inverse ? ldexp(divide(ONE, power).high, -exponent) : ldexp(power.high, exponent);
}

/* Of another double; x > 0. */
static bool is_square(double x)
{
    int exponent;
    double m = frexp(x, &exponent), root = sqrt(exponent % 2 ? m / 2 : m);
    twofold square = product_of(root, root);
    return square.high == (exponent % 2 ? m / 2 : m) && square.low == 0;
}

/* x^y, x > 0 and finite, y finite and not 0. */
static double power_of(double x, double y)
{
    while (fabs(y) <= 32 && y != floor(y) && is_square(x)) { /* what is exact is found so */
        x = sqrt(x);
        y *= 2;
    }
    if (fabs(y) <= 64 && y == floor(y))
        return whole_power(x, (int)fabs(y), y < 0);
    if (y == 0.5)
        return sqrt(x);
    twofold power = quick_log(x);
    if (power.high * y > 710)
        return INFINITY;
    if (power.high * y < -746)
        return 0;
    power = multiply_by(power, y);
    int exponent;
    twofold value = quick_exp(power, &exponent);
    if (!is_settled(value, (POWER_ERROR + LOG_ERROR * fabs(power.high)) * value.high))
        value = exp_of(multiply_by(log_of(x), y), &exponent);
    return ldexp(value.high, exponent);
}

double csg_pow(double x, double y)
{
    if (y == 0 || x == 1)
        return 1;
    if (isnan(x) || isnan(y))
        return x + y;
    double size = fabs(x);
    if (isinf(y))
        return size == 1 ? 1 : (size > 1) == (y > 0) ? INFINITY : 0;
    bool is_whole = y == floor(y), is_odd = is_whole && fmod(y, 2) != 0;
    double sign = is_odd && signbit(x) ? -1 : 1;
    if (x == 0 || isinf(x))
        return sign * ((x == 0) == (y < 0) ? INFINITY : 0);
    return x < 0 && !is_whole ? NAN : sign * power_of(size, y);
}

double csg_hypot(double x, double y)
{
    x = fabs(x);
    y = fabs(y);
    if (isinf(x) || isinf(y))
        return INFINITY;
    if (isnan(x) || isnan(y))
        return x + y;
    if (x == 0 || y == 0)
        return x + y;
    double most = fmax(x, y);
    int exponent = 0;
    if (most > 0x1p500 || most < 0x1p-400) {
        frexp(most, &exponent);
        x = ldexp(x, -exponent);
        y = ldexp(y, -exponent);
    }
    twofold a = product_of(x, x), b = product_of(y, y), square = sum_of(a.high, b.high);
    square = sum_of_ordered(square.high, square.low + (a.low + b.low));
    double length = square_root(square).high;
    return exponent ? ldexp(length, exponent) : length;
}

/* Twice the arc sine of the half angle's sine, which is halved until the series is short. */
double csg_arc_cosine(double cosine)
{
    enum { HALVINGS = 3, TERMS = 14 };
    cosine = fmin(fmax(cosine, -1), 1);
    double sine = sqrt((1 - cosine) / 2), rest = sqrt((1 + cosine) / 2);
    for (int i = 0; i < HALVINGS; i++) {
        sine /= sqrt(2 * (1 + rest));
        rest = sqrt((1 + rest) / 2);
    }
    double term = sine, sum = sine;
    for (int k = 1; k < TERMS; k++) {
        double odd = 2 * k - 1;
        term *= sine * sine * odd / (odd + 1);
        sum += term / (odd + 2);
    }
    return 2 * (1 << HALVINGS) * sum;
}
