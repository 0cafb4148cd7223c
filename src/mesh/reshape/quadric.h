/* SPDX-License-Identifier: MIT
 * Quadric error metrics (Garland and Heckbert 1997): the weighted sum of squared distances to
 * planes, as a quadratic form in the place.
 */
#ifndef CSG_MESH_RESHAPE_QUADRIC_H
#define CSG_MESH_RESHAPE_QUADRIC_H

#include "base/geometry.h"

/* x' A x + 2 b' x + c. */
typedef struct csg_quadric {
    double xx, xy, xz, yy, yz, zz;
    csg_vec3 b;
    double c;
} csg_quadric;

/* The plane through a point with this unit normal. */
static inline csg_quadric csg_quadric_of_plane(csg_vec3 point, csg_vec3 normal, double weight)
{
    double d = -csg_vec3_dot(normal, point);
    csg_vec3 n = csg_vec3_scale(normal, weight);
    return (csg_quadric){n.x * normal.x, n.x * normal.y, n.x * normal.z,       n.y * normal.y,
                         n.y * normal.z, n.z * normal.z, csg_vec3_scale(n, d), weight * d * d};
}

static inline csg_quadric csg_quadric_add(csg_quadric a, csg_quadric b)
{
    return (csg_quadric){a.xx + b.xx,
                         a.xy + b.xy,
                         a.xz + b.xz,
                         a.yy + b.yy,
                         a.yz + b.yz,
                         a.zz + b.zz,
                         csg_vec3_add(a.b, b.b),
                         a.c + b.c};
}

static inline csg_vec3 csg_quadric_times(const csg_quadric *q, csg_vec3 p)
{
    return csg_vec3_make(q->xx * p.x + q->xy * p.y + q->xz * p.z,
                         q->xy * p.x + q->yy * p.y + q->yz * p.z,
                         q->xz * p.x + q->yz * p.y + q->zz * p.z);
}

/* Never negative: rounding is cut off. */
static inline double csg_quadric_error(const csg_quadric *q, csg_vec3 p)
{
    double error = csg_vec3_dot(p, csg_quadric_times(q, p)) + 2 * csg_vec3_dot(q->b, p) + q->c;
    return error > 0 ? error : 0;
}

/* The place of least error; where a direction is free, the one nearest to `middle`: a millionth of
 * the planes' weight draws there. False: there are no planes. */
static inline bool csg_quadric_least(const csg_quadric *q, csg_vec3 middle, csg_vec3 *out)
{
    double pull = 1e-6 * (q->xx + q->yy + q->zz);
    csg_quadric s = *q;
    s.xx += pull, s.yy += pull, s.zz += pull;
    csg_vec3 right = csg_vec3_scale(csg_vec3_add(csg_quadric_times(q, middle), q->b), -1);
    csg_vec3 rows[3] = {{s.xx, s.xy, s.xz}, {s.xy, s.yy, s.yz}, {s.xz, s.yz, s.zz}};
    csg_vec3 c0 = csg_vec3_cross(rows[1], rows[2]), c1 = csg_vec3_cross(rows[2], rows[0]),
             c2 = csg_vec3_cross(rows[0], rows[1]);
    double determinant = csg_vec3_dot(rows[0], c0);
    if (!(determinant > 0))
        return false;
    /* symmetric: the adjugate's rows are the cross products */
    csg_vec3 step = {csg_vec3_dot(c0, right), csg_vec3_dot(c1, right), csg_vec3_dot(c2, right)};
    *out = csg_vec3_add(middle, csg_vec3_scale(step, 1 / determinant));
    return true;
}

#endif
