/* SPDX-License-Identifier: MIT
 * Cut cubes; see cut.h. The cube's six faces are clipped and joined, as fans of triangles, with a
 * point of the plane: tetrahedra over the cut itself are flat, and nobody has to find it.
 */
#include "measure/cut.h"

#include <math.h>
#include <string.h>

enum { FACES = 6, CORNERS = 8, MOST_CLIPPED = 5 };

/* Counter-clockwise from outside; bit k of a corner's number: coordinate k is +half. */
static const unsigned char FACE[FACES][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                             {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};

static double tetrahedron(const double *q, const double *a, const double *b, const double *c)
{
    double u[3], v[3], w[3];
    for (int k = 0; k < 3; k++) {
        u[k] = a[k] - q[k];
        v[k] = b[k] - q[k];
        w[k] = c[k] - q[k];
    }
    return (u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2]) +
            u[2] * (v[0] * w[1] - v[1] * w[0])) /
           6;
}

/* Over a tetrahedron of volume V with the corners p_0 .. p_3 and their sum s: the integral of x_k
 * is V s_k / 4, that of x_i x_k is V (s_i s_k + sum of p_i p_k) / 20. */
void csg_integrals_add_tetrahedron(double out[CSG_INTEGRALS], const double *q, const double *a,
                                   const double *b, const double *c)
{
    static const int AXES[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};
    double volume = tetrahedron(q, a, b, c), sum[3];
    out[CSG_INTEGRAL_ONE] += volume;
    for (int k = 0; k < 3; k++) {
        sum[k] = q[k] + a[k] + b[k] + c[k];
        out[CSG_INTEGRAL_X + k] += volume * sum[k] / 4;
    }
    for (int n = 0; n < 6; n++) {
        int i = AXES[n][0], k = AXES[n][1];
        double products = q[i] * q[k] + a[i] * a[k] + b[i] * b[k] + c[i] * c[k];
        out[CSG_INTEGRAL_XX + n] += volume * (sum[i] * sum[k] + products) / 20;
    }
}

void csg_integrals_shift(double m[CSG_INTEGRALS], const double c[3])
{
    double v = m[CSG_INTEGRAL_ONE];
    const double first[3] = {m[1], m[2], m[3]};
    for (int k = 0; k < 3; k++) {
        m[CSG_INTEGRAL_X + k] += c[k] * v;
        m[CSG_INTEGRAL_XX + k] += 2 * c[k] * first[k] + c[k] * c[k] * v;
    }
    m[CSG_INTEGRAL_XY] += c[0] * first[1] + c[1] * first[0] + c[0] * c[1] * v;
    m[CSG_INTEGRAL_XZ] += c[0] * first[2] + c[2] * first[0] + c[0] * c[2] * v;
    m[CSG_INTEGRAL_YZ] += c[1] * first[2] + c[2] * first[1] + c[1] * c[2] * v;
}

void csg_integrals_of_cube(double half, double out[CSG_INTEGRALS])
{
    double volume = 8 * half * half * half;
    memset(out, 0, CSG_INTEGRALS * sizeof *out);
    out[CSG_INTEGRAL_ONE] = volume;
    for (int k = 0; k < 3; k++)
        out[CSG_INTEGRAL_XX + k] = volume * half * half / 3;
}

/* The face's part on the positive side. */
static int clip(const unsigned char face[4], double (*corners)[3], const double *values,
                double (*out)[3])
{
    int count = 0;
    for (int i = 0; i < 4; i++) {
        int from = face[i], to = face[(i + 1) % 4];
        double a = values[from], b = values[to];
        if (a >= 0)
            memcpy(out[count++], corners[from], sizeof *out);
        if ((a >= 0) == (b >= 0))
            continue;
        double share = a / (a - b);
        for (int k = 0; k < 3; k++)
            out[count][k] = corners[from][k] + share * (corners[to][k] - corners[from][k]);
        count++;
    }
    return count;
}

double csg_cut_cube(double half, double value, const double slope[3], double out[CSG_INTEGRALS])
{
    double corners[CORNERS][3], values[CORNERS], sum[CSG_INTEGRALS] = {0}, q[3];
    double square = slope[0] * slope[0] + slope[1] * slope[1] + slope[2] * slope[2];
    double whole = 8 * half * half * half;
    double reach = half * (fabs(slope[0]) + fabs(slope[1]) + fabs(slope[2]));
    if (out)
        memset(out, 0, CSG_INTEGRALS * sizeof *out);
    if (!(value >= -reach)) /* nor where it is no number */
        return 0;
    if (value >= reach) {
        if (out)
            csg_integrals_of_cube(half, out);
        return whole;
    }
    for (int i = 0; i < CORNERS; i++) {
        values[i] = value;
        for (int k = 0; k < 3; k++) {
            corners[i][k] = i >> k & 1 ? half : -half;
            values[i] += slope[k] * corners[i][k];
        }
    }
    for (int k = 0; k < 3; k++)
        q[k] = -value / square * slope[k];
    for (int f = 0; f < FACES; f++) {
        double polygon[MOST_CLIPPED + 1][3];
        int count = clip(FACE[f], corners, values, polygon);
        for (int i = 1; i + 1 < count; i++) {
            if (out)
                csg_integrals_add_tetrahedron(sum, q, polygon[0], polygon[i], polygon[i + 1]);
            else
                sum[0] += tetrahedron(q, polygon[0], polygon[i], polygon[i + 1]);
        }
    }
    if (out)
        memcpy(out, sum, sizeof sum);
    return fmin(fmax(sum[0], 0), whole);
}

/* A cube of edges 2, stretched. */
double csg_cut_box(const double half[3], double value, const double slope[3],
                   double out[CSG_INTEGRALS])
{
    static const int FIRST[] = {0, 1, 2, 0, 0, 1}, SECOND[] = {0, 1, 2, 1, 2, 2};
    const double along[3] = {slope[0] * half[0], slope[1] * half[1], slope[2] * half[2]};
    double whole = half[0] * half[1] * half[2];
    csg_cut_cube(1, value, along, out);
    out[CSG_INTEGRAL_ONE] *= whole;
    for (int k = 0; k < 3; k++)
        out[CSG_INTEGRAL_X + k] *= whole * half[k];
    for (int n = 0; n < 6; n++)
        out[CSG_INTEGRAL_XX + n] *= whole * half[FIRST[n]] * half[SECOND[n]];
    return out[CSG_INTEGRAL_ONE];
}
