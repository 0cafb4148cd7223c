/* SPDX-License-Identifier: MIT
 * All corners of the polytope, by brute force: every three planes meet in a point, which is a
 * corner if no other plane cuts it off. Infinite sides of the given box are replaced by far ones;
 * a corner out there means that the polytope is unbounded (or might be), none at all that it is
 * empty or lies farther out, and then nothing is claimed. The result is grown by more than the
 * corners' rounding.
 */
#include "scene/boxes/half_spaces.h"

#define FAR 1000.0      /* times the scale: where infinite sides are put */
#define UNBOUNDED 100.0 /* times the scale: corners beyond are not trusted */
#define TOLERANCE 1e-9  /* times the scale: of corners */
#define PARALLEL 1e-12  /* determinant of unit normals below which three planes do not meet */

enum { MOST_PLANES = CSG_MOST_HALF_SPACES + 6 };

csg_half_space csg_half_space_map(csg_half_space h, const csg_affine *inverse)
{
    csg_vec3 normal = csg_affine_covector(inverse, h.normal);
    csg_vec3 shift = csg_vec3_make(inverse->t[0], inverse->t[1], inverse->t[2]);
    double length = csg_vec3_norm(normal), d = h.d - csg_vec3_dot(h.normal, shift);
    return (csg_half_space){csg_vec3_scale(normal, 1 / length), d / length};
}

static double scale_of(const csg_half_space *planes, size_t count, const double *sides)
{
    double scale = 0;
    for (size_t i = 0; i < count; i++)
        scale = fmax(scale, fabs(planes[i].d));
    for (int i = 0; i < 6; i++)
        if (isfinite(sides[i]))
            scale = fmax(scale, fabs(sides[i]));
    return scale;
}

/* False when the planes are (nearly) parallel to one line. */
static bool meet(const csg_half_space *a, const csg_half_space *b, const csg_half_space *c,
                 csg_vec3 *corner)
{
    csg_vec3 bc = csg_vec3_cross(b->normal, c->normal), ca = csg_vec3_cross(c->normal, a->normal),
             ab = csg_vec3_cross(a->normal, b->normal);
    double determinant = csg_vec3_dot(a->normal, bc);
    if (fabs(determinant) < PARALLEL)
        return false;
    csg_vec3 sum = csg_vec3_add(csg_vec3_scale(bc, a->d), csg_vec3_scale(ca, b->d));
    *corner = csg_vec3_scale(csg_vec3_add(sum, csg_vec3_scale(ab, c->d)), 1 / determinant);
    return true;
}

static bool is_corner(const csg_half_space *planes, size_t count, csg_vec3 p, double tolerance)
{
    for (size_t i = 0; i < count; i++)
        if (csg_vec3_dot(planes[i].normal, p) > planes[i].d + tolerance)
            return false;
    return true;
}

static csg_box hull_of_corners(const csg_half_space *planes, size_t count, double tolerance)
{
    csg_box hull = csg_box_empty();
    csg_vec3 p;
    for (size_t i = 0; i < count; i++)
        for (size_t j = 0; j < i; j++)
            for (size_t k = 0; k < j; k++)
                if (meet(&planes[i], &planes[j], &planes[k], &p) &&
                    is_corner(planes, count, p, tolerance))
                    hull = csg_box_hull(hull, (csg_box){p, p});
    return hull;
}

csg_box csg_half_spaces_box(const csg_half_space *half_spaces, size_t count, csg_box box)
{
    csg_half_space planes[MOST_PLANES];
    const double sides[6] = {box.max.x, box.max.y, box.max.z, -box.min.x, -box.min.y, -box.min.z};
    double scale = scale_of(half_spaces, count, sides);
    if (csg_box_is_empty(box) || !(scale > 0) || !isfinite(scale))
        return box;
    for (size_t i = 0; i < count; i++)
        planes[i] = half_spaces[i];
    for (int i = 0; i < 6; i++) {
        double sign = i < 3 ? 1 : -1;
        csg_vec3 normal = {i % 3 == 0 ? sign : 0, i % 3 == 1 ? sign : 0, i % 3 == 2 ? sign : 0};
        planes[count++] = (csg_half_space){normal, isfinite(sides[i]) ? sides[i] : FAR * scale};
    }
    csg_box hull =
        csg_box_grow(hull_of_corners(planes, count, TOLERANCE * scale), TOLERANCE * scale);
    double reach = UNBOUNDED * scale;
    csg_box trusted = {{-reach, -reach, -reach}, {reach, reach, reach}};
    bool known = !csg_box_is_empty(hull) && csg_box_contains_box(trusted, hull);
    return known ? csg_box_intersect(box, hull) : box;
}
