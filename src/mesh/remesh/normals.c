/* SPDX-License-Identifier: MIT
 * Least squares; see normals.h. Of each triangle the surface's normals are asked for at the three
 * points of the rule that is exact for squares (Strang and Fix 1973), and continued to its corners
 * as a linear field would be: where triangles agree, as on a cylinder, a vertex gets the normal of
 * the surface there. Where they do not, it is their mean by areas: the projection of the surface's
 * normals on what triangles can show, with each row of its matrix summed up on the diagonal.
 */
#include "mesh/remesh/normals.h"

#include <string.h>

enum { POINTS = 3, TRIANGLES = CSG_PROBE_MOST / POINTS };

/* Triangles whose points are asked for together. */
typedef struct batch {
    uint32_t triangle[TRIANGLES];
    size_t count;
    float at[POINTS * TRIANGLES][3], gradient[POINTS * TRIANGLES][3];
} batch;

/* Near each corner: two thirds of the way from the middle of the other side. */
static void add_points(batch *b, const csg_vec3 v[3])
{
    csg_vec3 sum = csg_vec3_add(v[0], csg_vec3_add(v[1], v[2]));
    for (int k = 0; k < POINTS; k++) {
        csg_vec3 p = csg_vec3_scale(csg_vec3_add(sum, csg_vec3_scale(v[k], 3)), 1.0 / 6);
        csg_vec3_to_floats(b->at[POINTS * b->count + (size_t)k], p);
    }
}

/* Where the field has no gradient, or that of another sheet, the triangle's own normal will do. */
static csg_vec3 normal_at(const float gradient[3], csg_vec3 own)
{
    static const double SAME_SHEET = 0.5;
    csg_vec3 n = csg_vec3_normalize(csg_vec3_scale(csg_vec3_from_floats(gradient), -1));
    return csg_vec3_dot(n, own) > SAME_SHEET ? n : own;
}

static void add_to_corners(csg_remesh *r, batch *b, const uint32_t *number, csg_vec3 *normals)
{
    csg_probe_true_gradients(&r->probe, (const float(*)[3])b->at, POINTS * b->count, b->gradient);
    for (size_t i = 0; i < b->count; i++) {
        uint32_t t = b->triangle[i];
        csg_vec3 cross =
            csg_triangle_cross(csg_remesh_corner(r, 3 * t), csg_remesh_corner(r, 3 * t + 1),
                               csg_remesh_corner(r, 3 * t + 2));
        csg_vec3 own = csg_vec3_normalize(cross), n[POINTS], mean = {0, 0, 0};
        double area = csg_vec3_norm(cross);
        for (size_t k = 0; k < POINTS; k++) {
            n[k] = normal_at(b->gradient[POINTS * i + k], own);
            mean = csg_vec3_add(mean, csg_vec3_scale(n[k], 1.0 / POINTS));
        }
        for (uint32_t k = 0; k < POINTS; k++) {
            csg_vec3 there = csg_vec3_sub(csg_vec3_scale(n[k], 2), mean);
            csg_vec3 *sum = &normals[number[3 * t + k]];
            *sum = csg_vec3_add(*sum, csg_vec3_scale(there, area));
        }
    }
    b->count = 0;
}

void csg_remesh_find_normals(csg_remesh *r, const uint32_t *number, uint32_t count,
                             csg_vec3 *normals)
{
    batch b;
    b.count = 0;
    memset(normals, 0, count * sizeof *normals);
    for (uint32_t t = 0; t < r->corners.triangle_count; t++) {
        if (!csg_corners_is_live(&r->corners, t))
            continue;
        const csg_vec3 v[3] = {csg_remesh_corner(r, 3 * t), csg_remesh_corner(r, 3 * t + 1),
                               csg_remesh_corner(r, 3 * t + 2)};
        add_points(&b, v);
        b.triangle[b.count++] = t;
        if (b.count == TRIANGLES)
            add_to_corners(r, &b, number, normals);
    }
    if (b.count)
        add_to_corners(r, &b, number, normals);
}
