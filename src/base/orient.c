/* SPDX-License-Identifier: MIT
 * Signs where double cannot say them; see orient.h.
 */
#include "base/orient.h"

/* ---- sums that lose nothing --------------------------------------------------------------------
 */

enum { MOST_TERMS = 256 };

/* Terms that do not overlap, the largest last. */
typedef struct sum {
    double term[MOST_TERMS];
    int count;
} sum;

/* a + b = *high + *low (Knuth) */
static void add_two(double a, double b, double *high, double *low)
{
    *high = a + b;
    double of_b = *high - a, of_a = *high - of_b;
    *low = (a - of_a) + (b - of_b);
}

static void add(sum *s, double x)
{
    int count = 0;
    for (int i = 0; i < s->count; i++) {
        double low;
        add_two(x, s->term[i], &x, &low);
        if (low != 0)
            s->term[count++] = low;
    }
    if (x != 0 || !count)
        s->term[count++] = x;
    s->count = count;
}

static int sign_of(double x)
{
    return (x > 0) - (x < 0);
}

/* Of a sum: its largest term outweighs the rest. */
static int sign_of_sum(const sum *s)
{
    return s->count ? sign_of(s->term[s->count - 1]) : 0;
}

/* a - b = [0] + [1] */
static void subtract(float a, float b, double out[2])
{
    add_two((double)a, -(double)b, &out[0], &out[1]);
}

/* Adds sign * a * b * c, each of two terms; fma(x, y, -x y) is what x y has lost. */
static void add_product(sum *s, double sign, const double a[2], const double b[2],
                        const double c[2])
{
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2; j++) {
            double ab = a[i] * b[j], lost = fma(a[i], b[j], -ab);
            for (int k = 0; k < 2 && ab != 0; k++) {
                double high = ab * c[k], low = lost * c[k];
                if (c[k] == 0)
                    continue;
                add(s, sign * high);
                add(s, sign * fma(ab, c[k], -high));
                add(s, sign * low);
                add(s, sign * fma(lost, c[k], -low));
            }
        }
}

int csg_orient_space_exactly(const float a[3], const float b[3], const float c[3], const float d[3])
{
    double u[3][2], v[3][2], w[3][2];
    for (int i = 0; i < 3; i++) {
        subtract(b[i], a[i], u[i]);
        subtract(c[i], a[i], v[i]);
        subtract(d[i], a[i], w[i]);
    }
    sum s = {.count = 0};
    for (int i = 0; i < 3; i++) {
        add_product(&s, 1, u[i], v[(i + 1) % 3], w[(i + 2) % 3]);
        add_product(&s, -1, u[i], v[(i + 2) % 3], w[(i + 1) % 3]);
    }
    return sign_of_sum(&s);
}

int csg_orient_along_exactly(const float a[3], const float b[3], const float c[3], int axis)
{
    int i = axis == 2 ? 0 : axis + 1, j = i == 2 ? 0 : i + 1;
    static const double one[2] = {1, 0};
    double u[2][2], v[2][2];
    subtract(b[i], a[i], u[0]);
    subtract(b[j], a[j], u[1]);
    subtract(c[i], a[i], v[0]);
    subtract(c[j], a[j], v[1]);
    sum s = {.count = 0};
    add_product(&s, 1, u[0], v[1], one);
    add_product(&s, -1, u[1], v[0], one);
    return sign_of_sum(&s);
}
