/* SPDX-License-Identifier: MIT
 * Shapes as formulas, a few dozen steps per side: regions of the plane by the distance to their
 * segments and the parity of a ray's crossings; convex polyhedra by their planes, and outside by
 * the distance to their triangles.
 */
#include "scene/formula/formulate.h"
#include "scene/formula/terms.h"

#include "shape/plane/region.h"
#include "shape/polyhedra/polyhedron.h"

/* ---- regions ----------------------------------------------------------------------------------
 */

/* Squared distance from p to the segment a, b of the plane. */
static csg_term segment_distance(csg_terms *t, csg_vec2 a, csg_vec2 b, const csg_term p[3])
{
    double dx = b.x - a.x, dy = b.y - a.y, square = dx * dx + dy * dy;
    csg_term x = csg_term_sub_number(t, p[0], a.x), y = csg_term_sub_number(t, p[1], a.y);
    csg_term along = csg_term_add(t, csg_term_mul_number(t, x, dx / square),
                                  csg_term_mul_number(t, y, dy / square));
    along = csg_term_clamp(t, along, 0, 1);
    x = csg_term_sub(t, x, csg_term_mul_number(t, along, dx));
    y = csg_term_sub(t, y, csg_term_mul_number(t, along, dy));
    return csg_term_add(t, csg_term_square(t, x), csg_term_square(t, y));
}

/* -1 where the ray from p along +x crosses the segment, else 1. */
static csg_term crossing(csg_terms *t, csg_vec2 a, csg_vec2 b, const csg_term p[3])
{
    if (a.y == b.y)
        return csg_term_number(t, 1);
    csg_term from = csg_term_step(t, csg_term_sub_number(t, p[1], a.y));
    csg_term to = csg_term_step(t, csg_term_sub_number(t, p[1], b.y));
    csg_term height = csg_term_abs(t, csg_term_sub(t, from, to));
    /* where the segment is at the height of p, less p */
    csg_term y =
        csg_term_mul_number(t, csg_term_sub_number(t, p[1], a.y), (b.x - a.x) / (b.y - a.y));
    csg_term right = csg_term_step(t, csg_term_sub(t, csg_term_add_number(t, y, a.x), p[0]));
    return csg_term_number_sub(t, 1, csg_term_mul_number(t, csg_term_mul(t, height, right), 2));
}

static csg_term region(csg_terms *t, const csg_outline *outline, const csg_term p[3])
{
    csg_term least = csg_term_number(t, CSG_FORMULA_FAR), outside = csg_term_number(t, 1);
    for (size_t loop = 0; loop < outline->loop_count; loop++) {
        size_t first = csg_outline_first(outline, loop), end = outline->ends[loop];
        for (size_t i = first; i < end; i++) {
            csg_vec2 a = outline->points[i], b = outline->points[i + 1 < end ? i + 1 : first];
            least = csg_term_min(t, least, segment_distance(t, a, b, p));
            outside = csg_term_mul(t, outside, crossing(t, a, b, p));
        }
    }
    return csg_term_neg(t, csg_term_mul(t, outside, csg_term_sqrt(t, least)));
}

/* ---- convex polyhedra --------------------------------------------------------------------------
 */

typedef struct terms3 {
    csg_term at[3];
} terms3;

static csg_term dot(csg_terms *t, const terms3 *a, csg_vec3 b)
{
    csg_term sum = csg_term_mul_number(t, a->at[0], b.x);
    sum = csg_term_add(t, sum, csg_term_mul_number(t, a->at[1], b.y));
    return csg_term_add(t, sum, csg_term_mul_number(t, a->at[2], b.z));
}

static terms3 minus(csg_terms *t, const csg_term p[3], csg_vec3 a)
{
    return (terms3){{csg_term_sub_number(t, p[0], a.x), csg_term_sub_number(t, p[1], a.y),
                     csg_term_sub_number(t, p[2], a.z)}};
}

/* Squared distance to the edge from a along d, given p - a. */
static csg_term edge_distance(csg_terms *t, const terms3 *from, csg_vec3 d)
{
    double square = csg_vec3_dot(d, d);
    csg_term along = dot(t, from, csg_vec3_scale(d, 1 / square));
    const double parts[3] = {d.x, d.y, d.z};
    csg_term squares = 0;
    along = csg_term_clamp(t, along, 0, 1);
    for (int i = 0; i < 3; i++) {
        csg_term away = csg_term_sub(t, from->at[i], csg_term_mul_number(t, along, parts[i]));
        away = csg_term_square(t, away);
        squares = i ? csg_term_add(t, squares, away) : away;
    }
    return squares;
}

/* *behind: height over the triangle's plane; returns the squared distance to the triangle. */
static csg_term triangle(csg_terms *t, const csg_vec3 corners[3], const csg_term p[3],
                         csg_term *behind)
{
    csg_vec3 normal = csg_vec3_normalize(
        csg_vec3_cross(csg_vec3_sub(corners[1], corners[0]), csg_vec3_sub(corners[2], corners[0])));
    csg_term least = 0, beside = 0;
    for (int k = 0; k < 3; k++) {
        terms3 from = minus(t, p, corners[k]);
        csg_vec3 along = csg_vec3_sub(corners[(k + 1) % 3], corners[k]);
        csg_vec3 out = csg_vec3_normalize(csg_vec3_cross(along, normal));
        csg_term side = dot(t, &from, out), edge = edge_distance(t, &from, along);
        beside = k ? csg_term_max(t, beside, side) : side;
        least = k ? csg_term_min(t, least, edge) : edge;
        if (k == 0)
            *behind = dot(t, &from, normal);
    }
    return csg_term_mix(t, csg_term_square(t, *behind), least, csg_term_step(t, beside));
}

static csg_term polyhedron(csg_terms *t, const csg_triangles *triangles, const csg_term p[3])
{
    csg_term behind = 0, least = 0;
    for (size_t i = 0; i < triangles->count; i++) {
        csg_vec3 corners[3];
        csg_term one = 0, square;
        for (int k = 0; k < 3; k++)
            corners[k] = triangles->points[triangles->corners[i][k]];
        square = triangle(t, corners, p, &one);
        behind = i ? csg_term_max(t, behind, one) : one;
        least = i ? csg_term_min(t, least, square) : square;
    }
    csg_term distance = csg_term_mul(t, csg_term_step(t, behind), csg_term_sqrt(t, least));
    return csg_term_neg(t, csg_term_add(t, csg_term_min_number(t, behind, 0), distance));
}

bool csg_formulate_shape(csg_terms *t, const csg_shape *shape, const csg_term p[3],
                         csg_term *result)
{
    if (shape->kind == CSG_SHAPE_REGION) {
        *result = region(t, csg_region_outline(shape), p);
        return true;
    }
    if (!csg_polyhedron_is_convex(shape))
        return false;
    *result = polyhedron(t, csg_polyhedron_triangles(shape), p);
    return true;
}
