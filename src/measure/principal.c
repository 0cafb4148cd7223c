/* SPDX-License-Identifier: MIT
 * Eigenvalues and eigenvectors of the matrix in the middle of the bounds, by Jacobi's rotations;
 * see principal.h. All others there are that one and a symmetric matrix of a norm that is known: by
 * Weyl's inequality it moves no eigenvalue by more than the norm, and by Davis and Kahan's sin
 * theta theorem (SIAM J. Numer. Anal. 7, 1970) it turns an eigenvector whose eigenvalue is a gap
 * away from the others by an angle whose sine is at most norm / (gap - norm).
 */
#include "measure/principal.h"

#include <math.h>

enum { SWEEPS = 12 /* each squares what is left off the diagonal */ };

/* What rounding adds to the norm, as a share of the matrix; the residual adds what is left. */
static const double ROUNDING = 0x1p-46;
static const double UNKNOWN_DEG = 90, DEG = 57.295779513082323;

/* The middle of the bounds; the norm of how far they reach from it, as the largest sum of a row. */
static double split(const csgm_interval inertia[6], double middle[3][3])
{
    static const int place[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};
    double norm = 0;
    for (int i = 0; i < 3; i++) {
        double row = 0;
        for (int k = 0; k < 3; k++) {
            csgm_interval of = inertia[place[i][k]];
            middle[i][k] = 0.5 * (of.low + of.high);
            row += fmax(of.high - middle[i][k], middle[i][k] - of.low);
        }
        norm = fmax(norm, row);
    }
    return norm;
}

/* Turns a's rows and columns p and q, and v's columns, so that a[p][q] is 0. */
static void rotate(double a[3][3], double v[3][3], int p, int q)
{
    if (!(fabs(a[p][q]) > 0))
        return;
    double ratio = (a[q][q] - a[p][p]) / (2 * a[p][q]);
    double t = copysign(1, ratio) / (fabs(ratio) + sqrt(ratio * ratio + 1));
    double c = 1 / sqrt(t * t + 1), s = t * c;
    for (int k = 0; k < 3; k++) {
        double x = a[k][p], y = a[k][q];
        a[k][p] = c * x - s * y;
        a[k][q] = s * x + c * y;
    }
    for (int k = 0; k < 3; k++) {
        double x = a[p][k], y = a[q][k];
        a[p][k] = c * x - s * y;
        a[q][k] = s * x + c * y;
        x = v[k][p], y = v[k][q];
        v[k][p] = c * x - s * y;
        v[k][q] = s * x + c * y;
    }
}

/* How far the vectors are from what they should be, in all: |A v - value v|, and their lengths and
 * angles. */
static double residual(double a[3][3], double v[3][3], const double value[3], double size)
{
    double sum = 0;
    for (int n = 0; n < 3; n++) {
        for (int i = 0; i < 3; i++) {
            double off = -value[n] * v[i][n], dot = i == n ? -1 : 0;
            for (int k = 0; k < 3; k++) {
                off += a[i][k] * v[k][n];
                dot += v[k][i] * v[k][n];
            }
            sum += fabs(off) + size * fabs(dot);
        }
    }
    return sum;
}

static void sort(double value[3], int order[3])
{
    for (int i = 0; i < 3; i++)
        order[i] = i;
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < 2 - i; k++)
            if (value[order[k]] > value[order[k + 1]]) {
                int swapped = order[k];
                order[k] = order[k + 1];
                order[k + 1] = swapped;
            }
}

/* Of unit length, its largest component positive. */
static csgm_vec3 axis_of(double v[3][3], int n)
{
    int largest = 0;
    double square = 0;
    for (int k = 0; k < 3; k++) {
        square += v[k][n] * v[k][n];
        if (fabs(v[k][n]) > 1.0000001 * fabs(v[largest][n]))
            largest = k;
    }
    double by = copysign(1 / sqrt(square), v[largest][n]);
    return (csgm_vec3){by * v[0][n] + 0.0, by * v[1][n] + 0.0, by * v[2][n] + 0.0};
}

/* An angle is at most its tangent. */
static double angle_within(double gap, double norm)
{
    double sine = norm / (gap - norm);
    if (!(gap > norm) || !(sine < 1))
        return UNKNOWN_DEG;
    return fmin(sine / sqrt(1 - sine * sine) * DEG * (1 + ROUNDING), UNKNOWN_DEG);
}

static void know_nothing(csgm_measures *m)
{
    for (int n = 0; n < 3; n++) {
        m->moments[n] = (csgm_interval){-INFINITY, INFINITY};
        m->axes[n] = (csgm_vec3){n == 0, n == 1, n == 2};
        m->axis_within[n] = UNKNOWN_DEG;
    }
}

void csg_measure_principal(csgm_measures *m)
{
    double middle[3][3], turned[3][3], v[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, value[3];
    double size = 0, norm = split(m->inertia, middle);
    int order[3];
    know_nothing(m);
    if (!isfinite(norm))
        return;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            turned[i][k] = middle[i][k];
            size = fmax(size, fabs(middle[i][k]));
        }
    for (int sweep = 0; sweep < SWEEPS; sweep++) {
        rotate(turned, v, 0, 1);
        rotate(turned, v, 0, 2);
        rotate(turned, v, 1, 2);
    }
    for (int n = 0; n < 3; n++)
        value[n] = turned[n][n];
    sort(value, order);
    norm += 4 * residual(middle, v, value, size) + ROUNDING * size;
    for (int n = 0; n < 3; n++) {
        double its = value[order[n]];
        double below = n > 0 ? its - value[order[n - 1]] : INFINITY;
        double above = n < 2 ? value[order[n + 1]] - its : INFINITY;
        m->moments[n] = (csgm_interval){fmax(its - norm, 0), its + norm};
        m->axes[n] = axis_of(v, order[n]);
        m->axis_within[n] = angle_within(fmin(below, above), norm);
    }
}
