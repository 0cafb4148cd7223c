/* SPDX-License-Identifier: MIT
 * Support functions; see primitive_box.h. {f >= -level} of an exact distance is the solid grown by
 * a ball, which adds level |n|.
 */
#include "scene/primitives/primitive_box.h"

#include <assert.h>
#include <float.h>

#include "scene/primitives/curve.h"

static double torus_support(const double *v, csg_vec3 n)
{
    double across = hypot(n.x, n.y);
    csg_affine turn = csg_affine_rotate(v[2], csg_vec3_make(0, 0, 1));
    double cosine = turn.m[0][0], sine = turn.m[1][0];
    bool on_arc = v[2] >= 180 || sine * n.x - cosine * fabs(n.y) >= 0;
    double reach = on_arc ? across : cosine * n.x + sine * fabs(n.y);
    return v[0] * reach + v[1] * csg_vec3_norm(n);
}

/* Bounded only along the plane's own normal, as nearly as it can be told. */
static double plane_support(const double *v, csg_vec3 n)
{
    csg_vec3 normal = csg_vec3_make(v[0], v[1], v[2]);
    double along = csg_vec3_dot(n, normal), across = csg_vec3_norm(csg_vec3_cross(n, normal));
    return along > 0 && across <= 2 * DBL_EPSILON * along ? along * v[3] : INFINITY;
}

/* Flat figures reach everywhere along z, slabs everywhere else. */
static double circle_support(const double *v, csg_vec3 n)
{
    return n.z == 0 ? v[0] * hypot(n.x, n.y) : INFINITY;
}

static double rectangle_support(const double *v, csg_vec3 n)
{
    if (n.z != 0)
        return INFINITY;
    return fabs(n.x) * (v[0] - v[2]) + fabs(n.y) * (v[1] - v[2]) + v[2] * hypot(n.x, n.y);
}

static double slab_support(const double *v, csg_vec3 n)
{
    return n.x == 0 && n.y == 0 ? v[0] * fabs(n.z) : INFINITY;
}

/* Largest x u + y w where |u|^p + |w|^p <= 1 (Hoelder). */
static double dual_norm(double x, double y, double p)
{
    double most = fmax(fabs(x), fabs(y)), q = p / (p - 1);
    if (p == 1 || most == 0)
        return most;
    return most * pow(pow(fabs(x) / most, q) + pow(fabs(y) / most, q), 1 / q);
}

double csg_primitive_support(csg_node_kind kind, const double *v, csg_vec3 n)
{
    double length = csg_vec3_norm(n), across;
    csg_curve curve;
    switch (kind) {
    case CSG_NODE_SPHERE:
        return v[0] * length;
    case CSG_NODE_BOX:
        return fabs(n.x) * (v[0] - v[3]) + fabs(n.y) * (v[1] - v[3]) + fabs(n.z) * (v[2] - v[3]) +
               v[3] * length;
    case CSG_NODE_FRUSTUM:
        across = hypot(n.x, n.y);
        return fmax(v[0] * across - v[2] * n.z, v[1] * across + v[2] * n.z) + v[3] * length;
    case CSG_NODE_CAPSULE:
        return fmax(v[1] * length, v[2] * length + v[0] * n.z);
    case CSG_NODE_TORUS:
        return torus_support(v, n);
    case CSG_NODE_ELLIPSOID:
        return csg_vec3_norm(csg_vec3_make(v[0] * n.x, v[1] * n.y, v[2] * n.z));
    case CSG_NODE_PLANE:
        return plane_support(v, n);
    case CSG_NODE_CIRCLE:
        return circle_support(v, n);
    case CSG_NODE_RECTANGLE:
        return rectangle_support(v, n);
    case CSG_NODE_SLAB:
        return slab_support(v, n);
    case CSG_NODE_FIELD: /* a formula may be inside anywhere */
        return INFINITY;
    case CSG_NODE_SUPERELLIPSOID:
        across = dual_norm(v[0] * n.x, v[1] * n.y, v[3]);
        return dual_norm(across, v[2] * n.z, v[4]) * (1 + 16 * DBL_EPSILON);
    case CSG_NODE_QUADRATIC_TUBE:
    case CSG_NODE_CUBIC_TUBE:
        curve = csg_curve_make(kind, v);
        return csg_curve_support(&curve, n, length);
    default:
        assert(kind == CSG_NODE_EMPTY);
        return -INFINITY;
    }
}

/* Rows along an axis come out exact; sums of products get room for their rounding. */
static double rounding_room(const double *row, double reach, double shift)
{
    int used = (row[0] != 0) + (row[1] != 0) + (row[2] != 0);
    return used > 1 && isfinite(reach) ? 4 * DBL_EPSILON * (fabs(reach) + fabs(shift)) : 0;
}

csg_box csg_primitive_box(csg_node_kind kind, const double *parameters, const csg_affine *map,
                          double level)
{
    double low[3], high[3];
    if (kind == CSG_NODE_EMPTY)
        return csg_box_empty();
    if (kind == CSG_NODE_FIELD)
        return csg_box_all();
    for (int i = 0; i < 3; i++) {
        const double *row = map->m[i];
        csg_vec3 n = csg_vec3_make(row[0], row[1], row[2]);
        double length = csg_vec3_norm(n), grow = level * length, up, down;
        if (kind == CSG_NODE_SPHERE) { /* large scenes are made of them */
            up = down = parameters[0] * length + grow;
        } else {
            up = csg_primitive_support(kind, parameters, n) + grow;
            down = csg_primitive_support(kind, parameters, csg_vec3_scale(n, -1)) + grow;
            if (kind ==
                CSG_NODE_SUPERELLIPSOID) /* no distance: {f >= -level} is the scaled solid */
                up = down = (up - grow) * (1 + level * parameters[5]);
        }
        high[i] = map->t[i] + up + rounding_room(row, up, map->t[i]);
        low[i] = map->t[i] - down - rounding_room(row, down, map->t[i]);
    }
    return (csg_box){{low[0], low[1], low[2]}, {high[0], high[1], high[2]}};
}
