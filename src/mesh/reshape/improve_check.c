/* SPDX-License-Identifier: MIT
 * What a change of improving must pass; see improver.h.
 */
#include <math.h>
#include <stdlib.h>

#include "mesh/reshape/improver.h"

/* ---- the surface ------------------------------------------------------------------------------
 */

bool csg_improver_measure(csg_improver *m)
{
    csg_remesh *r = m->remesh;
    size_t count = r->corners.triangle_count, n = 0;
    float *values = csg_memory_alloc(r->memory, count * sizeof *values);
    if (!values)
        return false;
    csg_remesh_values_at_centroids(r, NULL, values);
    for (uint32_t t = 0; t < count; t++)
        if (csg_corners_is_live(&r->corners, t))
            values[n++] = fabsf(values[t]);
    m->allowed = csg_remesh_common_value(values, n);
    csg_memory_release(r->memory, values, count * sizeof *values);
    return true;
}

/* How far triangles stray from the surface, and how much they face as it does. */
typedef struct fit {
    double stray, facing;
} fit;

enum { POINTS = 4 /* of a triangle: its middle, and those of its sides */ };

static fit fit_of(csg_remesh *r, const csg_vec3 (*triangles)[3], uint32_t count)
{
    float at[CSG_PROBE_MOST][3], f[CSG_PROBE_MOST], g[CSG_PATCH_MOST][3];
    fit result = {0, 1};
    _Static_assert((int)POINTS * (int)CSG_PATCH_MOST <= (int)CSG_PROBE_MOST, "in one call");
    for (uint32_t i = 0; i < count; i++) { /* the middles first: their gradients are asked */
        const csg_vec3 *v = triangles[i];
        csg_vec3_to_floats(at[i],
                           csg_vec3_scale(csg_vec3_add(v[0], csg_vec3_add(v[1], v[2])), 1.0 / 3));
        for (uint32_t k = 0; k < 3; k++)
            csg_vec3_to_floats(at[count + 3 * i + k],
                               csg_vec3_scale(csg_vec3_add(v[k], v[(k + 1) % 3]), 0.5));
    }
    csg_probe_values(&r->probe, (const float(*)[3])at, POINTS * (size_t)count, f);
    csg_probe_gradients(&r->probe, (const float(*)[3])at, count, g);
    for (uint32_t i = 0; i < POINTS * count; i++)
        result.stray = fmax(result.stray, fabs((double)f[i]));
    for (uint32_t i = 0; i < count; i++) {
        const csg_vec3 *v = triangles[i];
        csg_vec3 normal = csg_vec3_normalize(csg_triangle_cross(v[0], v[1], v[2]));
        csg_vec3 out =
            csg_vec3_normalize(csg_vec3_make(-(double)g[i][0], -(double)g[i][1], -(double)g[i][2]));
        if (csg_vec3_dot(out, out) > 0.5)
            result.facing = fmin(result.facing, csg_vec3_dot(normal, out));
    }
    return result;
}

/* ---- the whole --------------------------------------------------------------------------------
 */

bool csg_patch_is_sound(csg_improver *m)
{
    static const double FACING = 0.7;
    csg_remesh *r = m->remesh;
    csg_patch *p = &m->patch;
    fit now = fit_of(r, (const csg_vec3(*)[3])p->now, p->now_count);
    fit then = fit_of(r, (const csg_vec3(*)[3])p->then, p->then_count);
    if (then.facing < fmin(FACING, now.facing) || then.facing <= 0.1 ||
        then.stray > fmax(m->allowed, now.stray) + 2 * (double)r->probe.noise)
        return false;
    if (m->thinned && !csg_remesh_brackets(r, (const csg_vec3(*)[3])p->then, NULL, p->then_count))
        return false;
    const csg_crossing_change change = {.at = (const csg_vec3(*)[3])p->then,
                                        .vertex = (const uint32_t(*)[3])p->vertex,
                                        .count = p->then_count,
                                        .vertices = {p->vertices[0], p->vertices[1]},
                                        .triangles = {p->triangles[0], p->triangles[1]}};
    return !csg_crossing_is_made(&r->tree, &change, NULL);
}

bool csg_improve_looks_alike(csg_improver *m, uint32_t vertex, csg_vec3 at,
                             csg_look_at_vertex *look)
{
    enum { COLOR_STEP = 4, MATERIAL_STEP = 200 };
    csg_remesh *r = m->remesh;
    if (!r->looks)
        return true;
    *look = csg_remesh_look(r, at);
    if (!m->thinned) /* a vertex per cell: each has its own, wherever it is */
        return true;
    for (int c = 0; c < 4; c++)
        if (abs(look->color[c] - r->looks[vertex].color[c]) > COLOR_STEP)
            return false;
    for (int c = 0; c < 2; c++)
        if (abs(look->material[c] - r->looks[vertex].material[c]) > MATERIAL_STEP)
            return false;
    return true;
}
