/* SPDX-License-Identifier: MIT
 * Vectors, boxes and affine maps in double: the arithmetic of scenes and bounds.
 * Boxes are csgm_box: empty when min.x > max.x; sides may be infinite.
 */
#ifndef CSG_BASE_GEOMETRY_H
#define CSG_BASE_GEOMETRY_H

#include <math.h>
#include <stdbool.h>

#include "csgmesh/csgmesh.h"

typedef struct csg_vec2 {
    double x, y;
} csg_vec2;

typedef csgm_vec3 csg_vec3;
typedef csgm_box csg_box;

static inline csg_vec3 csg_vec3_make(double x, double y, double z)
{
    return (csg_vec3){x, y, z};
}
static inline csg_vec3 csg_vec3_add(csg_vec3 a, csg_vec3 b)
{
    return (csg_vec3){a.x + b.x, a.y + b.y, a.z + b.z};
}
static inline csg_vec3 csg_vec3_sub(csg_vec3 a, csg_vec3 b)
{
    return (csg_vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}
static inline csg_vec3 csg_vec3_scale(csg_vec3 a, double s)
{
    return (csg_vec3){a.x * s, a.y * s, a.z * s};
}
static inline double csg_vec3_dot(csg_vec3 a, csg_vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
static inline csg_vec3 csg_vec3_cross(csg_vec3 a, csg_vec3 b)
{
    return (csg_vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
static inline double csg_vec3_norm(csg_vec3 a)
{
    return sqrt(csg_vec3_dot(a, a));
}
/* Of vectors that are arrays, as loops over the axes have them. */
static inline double csg_dot3(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
static inline double csg_norm3(const double v[3])
{
    return sqrt(csg_dot3(v, v));
}
/* a / |a|, or zero when a is zero. */
static inline csg_vec3 csg_vec3_normalize(csg_vec3 a)
{
    double n = csg_vec3_norm(a);
    return n > 0 ? csg_vec3_scale(a, 1 / n) : csg_vec3_make(0, 0, 0);
}

static inline csg_vec3 csg_vec3_from_floats(const float at[3])
{
    return csg_vec3_make((double)at[0], (double)at[1], (double)at[2]);
}

static inline void csg_vec3_to_floats(float out[3], csg_vec3 a)
{
    out[0] = (float)a.x;
    out[1] = (float)a.y;
    out[2] = (float)a.z;
}

/* ---- boxes ------------------------------------------------------------------------- */

csg_box csg_box_empty(void);
csg_box csg_box_all(void); /* the whole of space */
bool csg_box_is_empty(csg_box box);
bool csg_box_is_finite(csg_box box); /* false for the empty box too */
csg_box csg_box_hull(csg_box a, csg_box b);
/* csg_box_hull with a point, without calls of C's library: for millions of points. The box may be
 * empty, with its sides at infinity. */
static inline void csg_box_extend(csg_box *box, csg_vec3 p)
{
    box->min.x = p.x < box->min.x ? p.x : box->min.x;
    box->min.y = p.y < box->min.y ? p.y : box->min.y;
    box->min.z = p.z < box->min.z ? p.z : box->min.z;
    box->max.x = p.x > box->max.x ? p.x : box->max.x;
    box->max.y = p.y > box->max.y ? p.y : box->max.y;
    box->max.z = p.z > box->max.z ? p.z : box->max.z;
}
static inline bool csg_box_holds(csg_box box, csg_vec3 p)
{
    return p.x >= box.min.x && p.x <= box.max.x && p.y >= box.min.y && p.y <= box.max.y &&
           p.z >= box.min.z && p.z <= box.max.z;
}
csg_box csg_box_intersect(csg_box a, csg_box b);
csg_box csg_box_grow(csg_box box, double by); /* empty stays empty; by >= 0, may be infinite */
csg_vec3 csg_box_center(csg_box box);
csg_vec3 csg_box_size(csg_box box);
double csg_box_longest_side(csg_box box); /* 0 of the empty box; infinite where it has no end */
bool csg_box_contains_box(csg_box outer, csg_box inner);
/* b(x) of operators.md 3.1: distance to the nearest face inside, minus the distance to the box
 * outside, -infinity for the empty box. */
double csg_box_field(csg_box box, csg_vec3 p);

/* ---- affine maps: p -> m p + t ------------------------------------------------------ */

typedef struct csg_affine {
    double m[3][3]; /* rows */
    double t[3];
} csg_affine;

csg_affine csg_affine_identity(void);
csg_affine csg_affine_translate(csg_vec3 by);
csg_affine csg_affine_scale(csg_vec3 factors);
/* Right-handed rotation by angle_deg about a unit axis; exact for multiples of 90 degrees
 * about coordinate axes. */
csg_affine csg_affine_rotate(double angle_deg, csg_vec3 axis);
/* Exact for multiples of 90 degrees. */
void csg_sin_cos_deg(double angle_deg, double *sine, double *cosine);
/* Reflection in the plane through the origin with this normal (any length > 0). */
csg_affine csg_affine_mirror(csg_vec3 normal);
/* A rotation that takes +z to the direction of `to` (any length > 0). */
csg_affine csg_affine_z_to(csg_vec3 to);
csg_affine csg_affine_multiply(csg_affine a, csg_affine b); /* first b, then a */
double csg_affine_determinant(csg_affine a);
/* What it does to x and y of points with z = 0; z stays. */
csg_affine csg_affine_of_plane(csg_affine a);
bool csg_affine_invert(csg_affine a, csg_affine *out); /* false when singular */
csg_vec3 csg_affine_point(const csg_affine *a, csg_vec3 p);
csg_vec3 csg_affine_vector(const csg_affine *a, csg_vec3 v);   /* m v */
csg_vec3 csg_affine_covector(const csg_affine *a, csg_vec3 v); /* transpose(m) v */
csg_box csg_affine_box(const csg_affine *a, csg_box box);      /* box of the image */
/* Smallest and largest singular value of m: |m v| lies between them for unit v. */
void csg_affine_singular_values(const csg_affine *a, double *smallest, double *largest);
/* True when m is a rotation or reflection times one factor (within 1e-12 relative). */
bool csg_affine_is_similarity(const csg_affine *a);

#endif
