/* SPDX-License-Identifier: MIT
 * See borders.h.
 */
#include "mesh/own/borders.h"

#include <math.h>

#include "shape/polyhedra/edges.h"

/* Beside a border, in shares of its triangle. How far from a unit's face a place on it may be: in
 * shares of the border's length, and of the place, which was rounded to floats. */
static const double BESIDE = 1.0 / 16, NEAR = 1e-4, ROUNDING = 0x1p-21;

typedef struct borders {
    const csg_own_units *units;
    const csg_marked_triangles *joined;
} borders;

static csg_vec3 corner_of(const borders *b, uint32_t half, uint32_t step)
{
    const csg_triangles *triangles = &b->joined->triangles;
    return triangles->points[triangles->corners[half / 3][(half % 3 + step) % 3]];
}

static csg_vec3 normal_of(const borders *b, uint32_t half)
{
    csg_vec3 a = corner_of(b, half, 0);
    return csg_vec3_normalize(csg_vec3_cross(csg_vec3_sub(corner_of(b, half, 1), a),
                                             csg_vec3_sub(corner_of(b, half, 2), a)));
}

/* From the middle of the half-edge a little into its triangle. */
static csg_vec3 place_beside(const borders *b, uint32_t half)
{
    csg_vec3 middle =
        csg_vec3_scale(csg_vec3_add(corner_of(b, half, 0), corner_of(b, half, 1)), 0.5);
    return csg_vec3_add(middle,
                        csg_vec3_scale(csg_vec3_sub(corner_of(b, half, 2), middle), BESIDE));
}

/* Whether a unit of this look has a face there, across that normal. */
static bool has_face(const borders *b, uint32_t look, csg_vec3 at, csg_vec3 normal, double near)
{
    for (size_t i = 0; i < b->units->count; i++) {
        const csg_own_unit *unit = &b->units->items[i];
        csg_affine back;
        if (unit->look != look ||
            !csg_box_contains_box(csg_box_grow(unit->box, near), (csg_box){at, at}) ||
            !csg_affine_invert(unit->place, &back))
            continue;
        csg_vec3 out = csg_affine_point(&back, csg_vec3_add(at, csg_vec3_scale(normal, near)));
        csg_vec3 in = csg_affine_point(&back, csg_vec3_sub(at, csg_vec3_scale(normal, near)));
        csg_vec3 ignored;
        if ((csg_shape_sample(unit->shape, out, &ignored) > 0) !=
            (csg_shape_sample(unit->shape, in, &ignored) > 0))
            return true;
    }
    return false;
}

static bool is_clear(const borders *b, uint32_t one, uint32_t other)
{
    static const double SAME_PLANE = 1 - 1e-6;
    uint32_t look = b->joined->marks[one / 3], beyond = b->joined->marks[other / 3];
    csg_vec3 normal = normal_of(b, one);
    if (look == beyond || csg_vec3_dot(normal, normal_of(b, other)) < SAME_PLANE)
        return true;
    csg_vec3 from = corner_of(b, one, 0);
    double near = fmax(NEAR * csg_vec3_norm(csg_vec3_sub(corner_of(b, one, 1), from)),
                       ROUNDING * csg_vec3_norm(from));
    return !has_face(b, beyond, place_beside(b, one), normal, near) ||
           !has_face(b, look, place_beside(b, other), normal, near);
}

bool csg_own_borders_are_clear(const csg_own_units *units, const csg_marked_triangles *joined,
                               bool *clear)
{
    const borders b = {units, joined};
    csg_triangle_edges edges;
    csg_arena scratch;
    csg_arena_init(&scratch, units->memory);
    bool made = csg_edges_make(&scratch, &joined->triangles, &edges);
    *clear = true;
    for (size_t i = 0; made && *clear && i < edges.count; i++) {
        const csg_edge *edge = &edges.edges[i];
        if (edge->count == 2)
            *clear = is_clear(&b, edges.halves[edge->first], edges.halves[edge->first + 1]);
    }
    csg_arena_reset(&scratch);
    return made;
}
