/* SPDX-License-Identifier: MIT
 * Boxes and affine maps; see geometry.h.
 */
#include "base/geometry.h"

#include <string.h>

#include "base/elementary.h"

csg_box csg_box_empty(void)
{
    return (csg_box){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
}

csg_box csg_box_all(void)
{
    return (csg_box){{-INFINITY, -INFINITY, -INFINITY}, {INFINITY, INFINITY, INFINITY}};
}

bool csg_box_is_empty(csg_box box)
{
    return !(box.min.x <= box.max.x && box.min.y <= box.max.y && box.min.z <= box.max.z);
}

bool csg_box_is_finite(csg_box box)
{
    return !csg_box_is_empty(box) && isfinite(box.min.x) && isfinite(box.min.y) &&
           isfinite(box.min.z) && isfinite(box.max.x) && isfinite(box.max.y) && isfinite(box.max.z);
}

csg_box csg_box_hull(csg_box a, csg_box b)
{
    if (csg_box_is_empty(a))
        return b;
    if (csg_box_is_empty(b))
        return a;
    return (csg_box){{fmin(a.min.x, b.min.x), fmin(a.min.y, b.min.y), fmin(a.min.z, b.min.z)},
                     {fmax(a.max.x, b.max.x), fmax(a.max.y, b.max.y), fmax(a.max.z, b.max.z)}};
}

csg_box csg_box_intersect(csg_box a, csg_box b)
{
    csg_box box = {{fmax(a.min.x, b.min.x), fmax(a.min.y, b.min.y), fmax(a.min.z, b.min.z)},
                   {fmin(a.max.x, b.max.x), fmin(a.max.y, b.max.y), fmin(a.max.z, b.max.z)}};
    return csg_box_is_empty(box) ? csg_box_empty() : box;
}

csg_box csg_box_grow(csg_box box, double by)
{
    if (csg_box_is_empty(box))
        return box;
    return (csg_box){{box.min.x - by, box.min.y - by, box.min.z - by},
                     {box.max.x + by, box.max.y + by, box.max.z + by}};
}

csg_vec3 csg_box_center(csg_box box)
{
    return csg_vec3_scale(csg_vec3_add(box.min, box.max), 0.5);
}

csg_vec3 csg_box_size(csg_box box)
{
    if (csg_box_is_empty(box))
        return csg_vec3_make(0, 0, 0);
    return csg_vec3_sub(box.max, box.min);
}

double csg_box_longest_side(csg_box box)
{
    csg_vec3 size = csg_box_size(box);
    return fmax(size.x, fmax(size.y, size.z));
}

bool csg_box_contains_box(csg_box outer, csg_box inner)
{
    return csg_box_is_empty(inner) || (outer.min.x <= inner.min.x && outer.min.y <= inner.min.y &&
                                       outer.min.z <= inner.min.z && outer.max.x >= inner.max.x &&
                                       outer.max.y >= inner.max.y && outer.max.z >= inner.max.z);
}

double csg_box_field(csg_box box, csg_vec3 p)
{
    if (csg_box_is_empty(box))
        return -INFINITY;
    double q[3] = {fmax(box.min.x - p.x, p.x - box.max.x), fmax(box.min.y - p.y, p.y - box.max.y),
                   fmax(box.min.z - p.z, p.z - box.max.z)};
    double nearest_face = fmax(q[0], fmax(q[1], q[2]));
    if (nearest_face <= 0)
        return -nearest_face;
    double sum = 0;
    for (int i = 0; i < 3; i++)
        sum += q[i] > 0 ? q[i] * q[i] : 0;
    return -sqrt(sum);
}

/* ---- affine maps -------------------------------------------------------------------- */

csg_affine csg_affine_identity(void)
{
    return csg_affine_scale(csg_vec3_make(1, 1, 1));
}

csg_affine csg_affine_translate(csg_vec3 by)
{
    csg_affine a = csg_affine_identity();
    a.t[0] = by.x;
    a.t[1] = by.y;
    a.t[2] = by.z;
    return a;
}

csg_affine csg_affine_scale(csg_vec3 factors)
{
    return (csg_affine){.m = {{factors.x, 0, 0}, {0, factors.y, 0}, {0, 0, factors.z}}};
}

/* Quarter turns come out exact, so that turned solids keep exact faces. */
void csg_sin_cos_deg(double angle_deg, double *s, double *c)
{
    double turn = fmod(angle_deg, 360);
    if (turn < 0)
        turn += 360;
    if (turn == 0 || turn == 90 || turn == 180 || turn == 270) {
        int quarter = (int)(turn / 90);
        *s = (double[]){0, 1, 0, -1}[quarter];
        *c = (double[]){1, 0, -1, 0}[quarter];
        return;
    }
    double radians = turn * (3.14159265358979323846 / 180);
    *s = csg_sin(radians);
    *c = csg_cos(radians);
}

csg_affine csg_affine_rotate(double angle_deg, csg_vec3 axis)
{
    double s, c;
    csg_sin_cos_deg(angle_deg, &s, &c);
    double k = 1 - c, x = axis.x, y = axis.y, z = axis.z;
    return (csg_affine){.m = {{c + k * x * x, k * x * y - s * z, k * x * z + s * y},
                              {k * x * y + s * z, c + k * y * y, k * y * z - s * x},
                              {k * x * z - s * y, k * y * z + s * x, c + k * z * z}}};
}

csg_affine csg_affine_mirror(csg_vec3 normal)
{
    csg_vec3 n = csg_vec3_normalize(normal);
    double v[3] = {n.x, n.y, n.z};
    csg_affine a = csg_affine_identity();
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            a.m[i][j] -= 2 * v[i] * v[j];
    return a;
}

csg_affine csg_affine_z_to(csg_vec3 to)
{
    csg_vec3 w = csg_vec3_normalize(to);
    csg_vec3 helper = fabs(w.x) < 0.9 ? csg_vec3_make(1, 0, 0) : csg_vec3_make(0, 1, 0);
    csg_vec3 u = csg_vec3_normalize(csg_vec3_cross(helper, w));
    csg_vec3 v = csg_vec3_cross(w, u);
    return (csg_affine){.m = {{u.x, v.x, w.x}, {u.y, v.y, w.y}, {u.z, v.z, w.z}}};
}

csg_affine csg_affine_multiply(csg_affine a, csg_affine b)
{
    csg_affine r;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            r.m[i][j] = a.m[i][0] * b.m[0][j] + a.m[i][1] * b.m[1][j] + a.m[i][2] * b.m[2][j];
        r.t[i] = a.m[i][0] * b.t[0] + a.m[i][1] * b.t[1] + a.m[i][2] * b.t[2] + a.t[i];
    }
    return r;
}

csg_affine csg_affine_of_plane(csg_affine a)
{
    a.m[0][2] = a.m[1][2] = a.m[2][0] = a.m[2][1] = a.t[2] = 0;
    a.m[2][2] = 1;
    return a;
}

double csg_affine_determinant(csg_affine a)
{
    return a.m[0][0] * (a.m[1][1] * a.m[2][2] - a.m[1][2] * a.m[2][1]) -
           a.m[0][1] * (a.m[1][0] * a.m[2][2] - a.m[1][2] * a.m[2][0]) +
           a.m[0][2] * (a.m[1][0] * a.m[2][1] - a.m[1][1] * a.m[2][0]);
}

/* Most maps of large scenes: worth a way of their own where the general one costs much. */
static bool is_translation(const csg_affine *a)
{
    return a->m[0][0] == 1 && a->m[1][1] == 1 && a->m[2][2] == 1 && a->m[0][1] == 0 &&
           a->m[0][2] == 0 && a->m[1][0] == 0 && a->m[1][2] == 0 && a->m[2][0] == 0 &&
           a->m[2][1] == 0;
}

bool csg_affine_invert(csg_affine a, csg_affine *out)
{
    if (is_translation(&a)) {
        *out = csg_affine_translate(csg_vec3_make(-a.t[0], -a.t[1], -a.t[2]));
        return true;
    }
    double determinant = csg_affine_determinant(a);
    if (determinant == 0 || !isfinite(determinant))
        return false;
    csg_affine r;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
            r.m[j][i] = (a.m[i1][j1] * a.m[i2][j2] - a.m[i1][j2] * a.m[i2][j1]) / determinant;
            if (!isfinite(r.m[j][i]))
                return false;
        }
    }
    for (int i = 0; i < 3; i++)
        r.t[i] = -(r.m[i][0] * a.t[0] + r.m[i][1] * a.t[1] + r.m[i][2] * a.t[2]);
    *out = r;
    return true;
}

csg_vec3 csg_affine_vector(const csg_affine *a, csg_vec3 v)
{
    return csg_vec3_make(a->m[0][0] * v.x + a->m[0][1] * v.y + a->m[0][2] * v.z,
                         a->m[1][0] * v.x + a->m[1][1] * v.y + a->m[1][2] * v.z,
                         a->m[2][0] * v.x + a->m[2][1] * v.y + a->m[2][2] * v.z);
}

csg_vec3 csg_affine_point(const csg_affine *a, csg_vec3 p)
{
    return csg_vec3_add(csg_affine_vector(a, p), csg_vec3_make(a->t[0], a->t[1], a->t[2]));
}

csg_vec3 csg_affine_covector(const csg_affine *a, csg_vec3 v)
{
    return csg_vec3_make(a->m[0][0] * v.x + a->m[1][0] * v.y + a->m[2][0] * v.z,
                         a->m[0][1] * v.x + a->m[1][1] * v.y + a->m[2][1] * v.z,
                         a->m[0][2] * v.x + a->m[1][2] * v.y + a->m[2][2] * v.z);
}

csg_box csg_affine_box(const csg_affine *a, csg_box box)
{
    if (csg_box_is_empty(box))
        return box;
    double low[3] = {box.min.x, box.min.y, box.min.z}, high[3] = {box.max.x, box.max.y, box.max.z};
    double out[2][3];
    for (int i = 0; i < 3; i++) {
        out[0][i] = out[1][i] = a->t[i];
        for (int j = 0; j < 3; j++) {
            if (a->m[i][j] == 0) /* 0 * infinity adds nothing */
                continue;
            double p = a->m[i][j] * low[j], q = a->m[i][j] * high[j];
            out[0][i] += fmin(p, q);
            out[1][i] += fmax(p, q);
        }
    }
    return (csg_box){{out[0][0], out[0][1], out[0][2]}, {out[1][0], out[1][1], out[1][2]}};
}

void csg_affine_singular_values(const csg_affine *a, double *smallest, double *largest)
{
    if (is_translation(a)) {
        *smallest = *largest = 1;
        return;
    }
    /* One-sided Jacobi: orthogonalise the columns, their lengths are the singular values. */
    double c[3][3];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            c[j][i] = a->m[i][j];
    for (int sweep = 0; sweep < 30; sweep++) {
        double off = 0;
        for (int p = 0; p < 2; p++) {
            for (int q = p + 1; q < 3; q++) {
                double pp = 0, qq = 0, pq = 0;
                for (int i = 0; i < 3; i++) {
                    pp += c[p][i] * c[p][i];
                    qq += c[q][i] * c[q][i];
                    pq += c[p][i] * c[q][i];
                }
                if (fabs(pq) <= 1e-16 * sqrt(pp * qq))
                    continue;
                off = fmax(off, fabs(pq));
                double tau = (qq - pp) / (2 * pq);
                double t = (tau >= 0 ? 1 : -1) / (fabs(tau) + sqrt(1 + tau * tau));
                double cosine = 1 / sqrt(1 + t * t), sine = cosine * t;
                for (int i = 0; i < 3; i++) {
                    double x = c[p][i], y = c[q][i];
                    c[p][i] = cosine * x - sine * y;
                    c[q][i] = sine * x + cosine * y;
                }
            }
        }
        if (off == 0)
            break;
    }
    *smallest = INFINITY;
    *largest = 0;
    for (int j = 0; j < 3; j++) {
        double length = sqrt(c[j][0] * c[j][0] + c[j][1] * c[j][1] + c[j][2] * c[j][2]);
        *smallest = fmin(*smallest, length);
        *largest = fmax(*largest, length);
    }
}

bool csg_affine_is_similarity(const csg_affine *a)
{
    double smallest, largest;
    csg_affine_singular_values(a, &smallest, &largest);
    return largest - smallest <= 1e-12 * largest;
}
