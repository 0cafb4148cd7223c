/* SPDX-License-Identifier: MIT
 * The operations of expression fields on floats, angles in radians: values, partial derivatives
 * and ranges, each written once, without branches, for the batch loops of formula_kernel.c.
 *
 * Only + - * / sqrt, comparisons, selections, conversions and integer operations on the bits: each
 * exactly rounded, so every instruction set gives the same bits. Polynomials are minimax fits
 * (Remez) after a reduction of the argument in parts with trailing zeros (Cody and Waite, "Software
 * Manual for the Elementary Functions", 1980), so that the multiples of them are exact.
 *
 * Errors: sin, cos 1e-7 for |x| <= 1e4 (beyond, only |f| <= 1 holds), exp and ln 2 ulp, atan2 3e-7.
 * A range holds every float that the value function gives for operands in their ranges; NaN ends:
 * nothing is known, not even that there is a value.
 */
#ifndef CSG_FIELD_FUNCTIONS_H
#define CSG_FIELD_FUNCTIONS_H

#include <float.h>
#include <stdint.h>
#include <string.h>

#include "base/select.h"

/* ---- helpers ------------------------------------------------------------------------------- */

static inline uint32_t bits_of(float a)
{
    uint32_t bits;
    memcpy(&bits, &a, sizeof bits);
    return bits;
}

static inline float from_bits(uint32_t bits)
{
    float a;
    memcpy(&a, &bits, sizeof a);
    return a;
}

/* Adding and taking away 1.5 * 2^23 rounds to the nearest whole number, |a| < 2^22. */
static inline float nearest(float a)
{
    const float magic = 12582912.0f;
    return (a + magic) - magic;
}

/* Where the conversion to an integer is defined and useful; NaN becomes the lower end. */
static inline float within(float a, float low, float high)
{
    float b = a > low ? a : low;
    return b < high ? b : high;
}

/* Towards zero; from 2^23 on every float is whole. (No conversion to integers: gcc 12 does not
 * vectorise one next to a choice.) */
static inline float truncated(float a)
{
    const float whole_from = 8388608.0f;
    float size = absolute(a);
    float n = (size + whole_from) - whole_from;
    n = n > size ? n - 1.0f : n;
    n = size < whole_from ? n : size;
    return a < 0 ? -n : n;
}

/* ---- values ---------------------------------------------------------------------------------
 */

/* Quarter turns away from the nearest multiple of a quarter, kept within what the polynomials
 * take also where the reduction has lost all digits. */
static inline float reduce_quarter(float a, int32_t *quarter)
{
    float k = nearest(within(a * 0x1.45f306p-1f, -4e6f, 4e6f));
    *quarter = (int32_t)k;
    float r = a - k * 0x1.92p+0f;
    r = r - k * 0x1.fb4p-12f;
    r = r - k * 0x1.444p-24f;
    r = r - k * 0x1.68c234p-39f;
    return within(r, -0.8f, 0.8f);
}

static inline float sine_near_zero(float r)
{
    float s = r * r;
    return r + r * (s * (-0.1666665423f + s * (0.008332131732f + s * -0.0001951087138f)));
}

static inline float cosine_near_zero(float r)
{
    float s = r * r;
    float rest = s * s * (0.04166664566f + s * (-0.001388730635f + s * 2.443124119e-05f));
    return 1.0f - (0.5f * s - rest);
}

/* sin(a + turn quarters) */
static inline float wave(float a, int32_t turn)
{
    int32_t quarter;
    float r = reduce_quarter(a, &quarter);
    quarter += turn;
    float s = sine_near_zero(r), c = cosine_near_zero(r);
    float f = quarter & 1 ? c : s;
    f = from_bits(bits_of(f) ^ (uint32_t)(quarter & 2) << 30);
    return absolute(a) <= FLT_MAX ? f : NAN;
}

/* Both in [-pi, pi]; octants by |y| <= |x| and signs. */
static inline float angle_of(float y, float x)
{
    const float pi = 3.14159265358979f;
    float ax = absolute(x), ay = absolute(y);
    float most = larger(ax, ay), least = smaller(ax, ay);
    float t = quotient(least, most), s = t * t;
    float p =
        -0.08419448242f +
        s * (0.0582343747f + s * (-0.03145553563f + s * (0.0110643559f + s * -0.001827194722f)));
    p = -0.3333330186f + s * (0.1999863853f + s * (-0.1426524456f + s * (0.1095757221f + s * p)));
    float a = t + t * (s * p);
    a = ay > ax ? 0.5f * pi - a : a;
    a = x < 0 ? pi - a : a;
    a = y < 0 ? -a : a;
    return (x == x) & (y == y) ? a : NAN;
}

static inline float value_neg(float a, float b)
{
    return -a;
}
static inline float value_abs(float a, float b)
{
    return absolute(a);
}
static inline float value_sqrt(float a, float b)
{
    return sqrtf(a);
}
static inline float value_sin(float a, float b)
{
    return wave(a, 0);
}
static inline float value_cos(float a, float b)
{
    return wave(a, 1);
}
static inline float value_tan(float a, float b)
{
    int32_t quarter;
    float r = reduce_quarter(a, &quarter);
    float s = sine_near_zero(r), c = cosine_near_zero(r);
    float over = quarter & 1 ? -c : s, under = quarter & 1 ? s : c;
    return absolute(a) <= FLT_MAX ? over / under : NAN;
}
static inline float value_asin(float a, float b)
{
    return angle_of(a, sqrtf((1.0f - a) * (1.0f + a)));
}
static inline float value_acos(float a, float b)
{
    return angle_of(sqrtf((1.0f - a) * (1.0f + a)), a);
}
static inline float value_atan(float a, float b)
{
    return angle_of(a, 1.0f);
}

/* e^r by its polynomial, times 2^k in two factors, so that denormals round once. */
static inline float value_exp(float a, float b)
{
    float x = within(a, -110.0f, 90.0f);
    float k = nearest(x * 0x1.715476p+0f);
    float r = x - k * 0x1.62ep-1f;
    r = r - k * 0x1.0bfbe8p-15f;
    float p =
        0.5000000101f +
        r * (0.1666651289f + r * (0.0416661872f + r * (0.008369598194f + r * 0.001395172265f)));
    float e = 1.0f + (r + r * r * p);
    int32_t whole = (int32_t)k, half = whole >> 1;
    float first = from_bits((uint32_t)(half + 127) << 23);
    float second = from_bits((uint32_t)(whole - half + 127) << 23);
    float v = e * first * second;
    return a == a ? v : NAN;
}

/* ln(2^k (1 + x)), 1 + x between the roots of 1/2 and 2. */
static inline float value_ln(float a, float b)
{
    int tiny = a < FLT_MIN;
    float scaled = tiny ? a * 0x1p24f : a;
    uint32_t bits = bits_of(scaled);
    int32_t k = (int32_t)(bits - 0x3f3504f3u) >> 23;
    float x = from_bits(bits - ((uint32_t)k << 23)) - 1.0f;
    float e = (float)k - (tiny ? 24.0f : 0.0f);
    float p =
        -0.1662455412f +
        x * (0.1418119164f + x * (-0.1312875386f + x * (0.1288164907f + x * -0.07859615637f)));
    p = 0.3333331673f + x * (-0.250008104f + x * (0.2000228629f + x * p));
    float s = x * x;
    float v = (x + (s * (x * p) - 0.5f * s)) + e * 0x1.0bfbe8p-15f + e * 0x1.62ep-1f;
    v = a > 0 ? v : a == 0 ? -INFINITY : NAN;
    return a > FLT_MAX ? a : v;
}
static inline float value_floor(float a, float b)
{
    float t = truncated(a);
    return t > a ? t - 1.0f : t;
}
static inline float value_add(float a, float b)
{
    return a + b;
}
static inline float value_sub(float a, float b)
{
    return a - b;
}
static inline float value_mul(float a, float b)
{
    return a * b;
}
static inline float value_div(float a, float b)
{
    return a / b;
}
static inline float value_min(float a, float b)
{
    return smaller(a, b);
}
static inline float value_max(float a, float b)
{
    return larger(a, b);
}
/* Whole exponents are products long before; a < 0 has no value here. */
static inline float value_pow(float a, float b)
{
    float v = value_exp(b * value_ln(a, 0), 0);
    v = a == 0 ? (b > 0 ? 0.0f : INFINITY) : v;
    return b == 0 ? 1.0f : v;
}
static inline float value_atan2(float a, float b)
{
    return angle_of(a, b);
}
static inline float value_mod(float a, float b)
{
    return a - truncated(a / b) * b;
}

/* ---- partial derivatives --------------------------------------------------------------------
 */

typedef struct slopes {
    float v, a, b;
} slopes;

static inline slopes slopes_neg(float a, float b)
{
    return (slopes){-a, -1.0f, 0};
}
static inline slopes slopes_abs(float a, float b)
{
    float up = a > 0 ? 1.0f : 0.0f, down = a < 0 ? 1.0f : 0.0f;
    return (slopes){absolute(a), up - down, 0};
}
static inline slopes slopes_sqrt(float a, float b)
{
    float v = sqrtf(a);
    return (slopes){v, quotient(0.5f, v), 0};
}
static inline slopes slopes_sin(float a, float b)
{
    return (slopes){value_sin(a, 0), value_cos(a, 0), 0};
}
static inline slopes slopes_cos(float a, float b)
{
    return (slopes){value_cos(a, 0), -value_sin(a, 0), 0};
}
static inline slopes slopes_tan(float a, float b)
{
    float v = value_tan(a, 0);
    return (slopes){v, 1.0f + v * v, 0};
}
static inline slopes slopes_asin(float a, float b)
{
    return (slopes){value_asin(a, 0), quotient(1.0f, sqrtf((1.0f - a) * (1.0f + a))), 0};
}
static inline slopes slopes_acos(float a, float b)
{
    return (slopes){value_acos(a, 0), quotient(-1.0f, sqrtf((1.0f - a) * (1.0f + a))), 0};
}
static inline slopes slopes_atan(float a, float b)
{
    return (slopes){value_atan(a, 0), 1.0f / (1.0f + a * a), 0};
}
static inline slopes slopes_exp(float a, float b)
{
    float v = value_exp(a, 0);
    return (slopes){v, v, 0};
}
static inline slopes slopes_ln(float a, float b)
{
    return (slopes){value_ln(a, 0), quotient(1.0f, a), 0};
}
static inline slopes slopes_floor(float a, float b)
{
    return (slopes){value_floor(a, 0), 0, 0};
}
static inline slopes slopes_add(float a, float b)
{
    return (slopes){a + b, 1.0f, 1.0f};
}
static inline slopes slopes_sub(float a, float b)
{
    return (slopes){a - b, 1.0f, -1.0f};
}
static inline slopes slopes_mul(float a, float b)
{
    return (slopes){a * b, b, a};
}
static inline slopes slopes_div(float a, float b)
{
    float v = a / b;
    return (slopes){v, 1.0f / b, -v / b};
}
static inline slopes slopes_min(float a, float b)
{
    float first = a < b ? 1.0f : 0.0f;
    return (slopes){smaller(a, b), first, 1.0f - first};
}
static inline slopes slopes_max(float a, float b)
{
    float first = a > b ? 1.0f : 0.0f;
    return (slopes){larger(a, b), first, 1.0f - first};
}
static inline slopes slopes_pow(float a, float b)
{
    float v = value_pow(a, b);
    float log = a > 0 ? value_ln(a, 0) : 0.0f;
    return (slopes){v, b * value_pow(a, b - 1.0f), v * log};
}
static inline slopes slopes_atan2(float a, float b)
{
    float square = a * a + b * b;
    return (slopes){angle_of(a, b), b / square, -a / square};
}
static inline slopes slopes_mod(float a, float b)
{
    float whole = truncated(a / b);
    return (slopes){a - whole * b, 1.0f, -whole};
}

/* ---- ranges ---------------------------------------------------------------------------------
 */

typedef struct range {
    float low, high;
} range;

/* Of the value functions, relative and absolute. */
#define FUNCTION_ERROR 0x1p-21f

/* The ends moved outwards, or NaN unless `sound`. */
static inline range settle(float low, float high, float relative, float least, int sound)
{
    float l = low - (absolute(low) * relative + least);
    float h = high + (absolute(high) * relative + least);
    int known = sound & (low <= high);
    return (range){known ? l : NAN, known ? h : NAN};
}

/* Operations that round once. */
static inline range rounded(float low, float high, int sound)
{
    return settle(low, high, 0x1p-23f, FLT_MIN, sound);
}

static inline int is_known(range a)
{
    return a.low <= a.high;
}

static inline range range_neg(range a, range b)
{
    return (range){-a.high, -a.low};
}
static inline range range_abs(range a, range b)
{
    float low = larger(larger(a.low, -a.high), 0), high = larger(-a.low, a.high);
    return (range){is_known(a) ? low : NAN, is_known(a) ? high : NAN};
}
static inline range range_sqrt(range a, range b)
{
    return rounded(sqrtf(larger(a.low, 0)), sqrtf(larger(a.high, 0)), is_known(a) & (a.low >= 0));
}

/* Does a hold some (4 k + quarter) * pi / 2? */
static inline int meets(range a, float quarter)
{
    float low = a.low * 0x1.45f306p-3f - 0.25f * quarter;
    float high = a.high * 0x1.45f306p-3f - 0.25f * quarter;
    float room = 0x1p-20f * (absolute(low) + absolute(high) + 1.0f);
    return value_floor(high + room, 0) >= low - room;
}

static inline range range_wave(range a, int32_t turn)
{
    const float far = 1e4f;
    float one = wave(a.low, turn), other = wave(a.high, turn);
    float least = smaller(one, other), most = larger(one, other);
    int lost = (a.high - a.low > 6.2831853f) | (a.low < -far) | (a.high > far);
    float bottom = lost | meets(a, 3.0f - (float)turn) ? -1.0f : least;
    float top = lost | meets(a, 1.0f - (float)turn) ? 1.0f : most;
    int sound = is_known(a) & (a.low >= -FLT_MAX) & (a.high <= FLT_MAX);
    return settle(bottom, top, 0, FUNCTION_ERROR, sound);
}
static inline range range_sin(range a, range b)
{
    return range_wave(a, 0);
}
static inline range range_cos(range a, range b)
{
    return range_wave(a, 1);
}
static inline range range_tan(range a, range b)
{
    int pole = meets(a, 1.0f) | meets(a, 3.0f);
    int sound = is_known(a) & !pole & (a.low > -1e4f) & (a.high < 1e4f);
    float low = value_tan(a.low, 0), high = value_tan(a.high, 0);
    float steep = larger(low * low, high * high); /* the argument's own rounding */
    return settle(low, high, FUNCTION_ERROR, FUNCTION_ERROR * (1.0f + steep), sound);
}
static inline range range_asin(range a, range b)
{
    int sound = is_known(a) & (a.low >= -1.0f) & (a.high <= 1.0f);
    return settle(value_asin(a.low, 0), value_asin(a.high, 0), 0, 4 * FUNCTION_ERROR, sound);
}
static inline range range_acos(range a, range b)
{
    int sound = is_known(a) & (a.low >= -1.0f) & (a.high <= 1.0f);
    return settle(value_acos(a.high, 0), value_acos(a.low, 0), 0, 4 * FUNCTION_ERROR, sound);
}
static inline range range_atan(range a, range b)
{
    return settle(value_atan(a.low, 0), value_atan(a.high, 0), 0, 2 * FUNCTION_ERROR, is_known(a));
}
static inline range range_exp(range a, range b)
{
    return settle(value_exp(a.low, 0), value_exp(a.high, 0), FUNCTION_ERROR, FLT_MIN, is_known(a));
}
static inline range range_ln(range a, range b)
{
    return settle(value_ln(a.low, 0), value_ln(a.high, 0), FUNCTION_ERROR, FLT_MIN,
                  is_known(a) & (a.low >= 0));
}
static inline range range_floor(range a, range b)
{
    return rounded(value_floor(a.low, 0), value_floor(a.high, 0), is_known(a));
}
static inline range range_add(range a, range b)
{
    return rounded(a.low + b.low, a.high + b.high, is_known(a) & is_known(b));
}
static inline range range_sub(range a, range b)
{
    return rounded(a.low - b.high, a.high - b.low, is_known(a) & is_known(b));
}

/* Of four corners; infinity times zero, or of both signs, leaves nothing known. */
static inline range range_of(float p, float q, float r, float s, int sound)
{
    float sum = (p + q) + (r + s);
    return rounded(smaller(smaller(p, q), smaller(r, s)), larger(larger(p, q), larger(r, s)),
                   sound & (sum == sum));
}
static inline range range_mul(range a, range b)
{
    return range_of(a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high,
                    is_known(a) & is_known(b));
}
/* u * u */
static inline range range_square(range a, range b)
{
    range c = range_abs(a, a);
    range d = rounded(c.low * c.low, c.high * c.high, is_known(a));
    return (range){d.low < 0 ? 0 : d.low, d.high};
}
static inline range range_div(range a, range b)
{
    return range_of(a.low / b.low, a.low / b.high, a.high / b.low, a.high / b.high,
                    is_known(a) & is_known(b) & ((b.low > 0) | (b.high < 0)));
}
static inline range range_min(range a, range b)
{
    int known = is_known(a) & is_known(b);
    float low = smaller(a.low, b.low), high = smaller(a.high, b.high);
    return (range){known ? low : NAN, known ? high : NAN};
}
static inline range range_max(range a, range b)
{
    int known = is_known(a) & is_known(b);
    float low = larger(a.low, b.low), high = larger(a.high, b.high);
    return (range){known ? low : NAN, known ? high : NAN};
}
/* exp(b ln a); for a = 0 the same with ln a = -inf, unless b can be 0. */
static inline range range_pow(range a, range b)
{
    int sound = (a.low > 0) | ((a.low == 0) & (b.low > 0));
    range log = range_ln(a, a);
    log.low = a.low == 0 ? -200.0f * quotient(1.0f, b.low) - 200.0f : log.low;
    range v = range_exp(range_mul(b, log), b);
    float low = a.low == 0 ? smaller(v.low, 0) : v.low;
    return settle(low, v.high, 0, 0, sound);
}
static inline range range_atan2(range a, range b)
{
    const float pi = 3.1415927f;
    float p = angle_of(a.low, b.low), q = angle_of(a.low, b.high);
    float r = angle_of(a.high, b.low), s = angle_of(a.high, b.high);
    int all = (b.low <= 0) & (a.low <= 0) & (a.high >= 0);
    float low = smaller(smaller(p, q), smaller(r, s)), high = larger(larger(p, q), larger(r, s));
    return settle(all ? -pi : low, all ? pi : high, 0, 2 * FUNCTION_ERROR,
                  is_known(a) & is_known(b));
}
static inline range range_mod(range a, range b)
{
    float first = truncated(a.low / b.low), last = truncated(a.high / b.low);
    float most = larger(absolute(b.low), absolute(b.high));
    float length = larger(absolute(a.low), absolute(a.high));
    int whole = (b.low == b.high) & (first == last);
    float low = whole ? a.low - first * b.low : a.low < 0 ? -most : 0;
    float high = whole ? a.high - first * b.low : a.high > 0 ? most : 0;
    int sound = is_known(a) & is_known(b) & ((b.low > 0) | (b.high < 0));
    sound &= length <= 1e30f * smaller(absolute(b.low), absolute(b.high));
    return settle(low, high, 0, 0x1p-21f * (length + most), sound);
}

#endif
