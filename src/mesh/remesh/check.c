/* SPDX-License-Identifier: MIT
 * What a change of the mesh must pass; see remesh.h.
 */
#include <math.h>

#include "mesh/remesh/remesh.h"

bool csg_remesh_project(csg_remesh *r, csg_vec3 *at, double reach)
{
    enum { MOST_STEPS = 4 };
    csg_vec3 p = *at;
    for (int step = 0; step < MOST_STEPS; step++) {
        float place[1][3], f, g[1][3];
        csg_vec3_to_floats(place[0], p);
        csg_probe_values(&r->probe, (const float(*)[3])place, 1, &f);
        if (fabsf(f) <= 2 * r->probe.noise)
            break;
        csg_probe_gradients(&r->probe, (const float(*)[3])place, 1, g);
        csg_vec3 slope = {(double)g[0][0], (double)g[0][1], (double)g[0][2]};
        double square = csg_vec3_dot(slope, slope);
        if (!(square > 1e-6))
            return false;
        p = csg_vec3_sub(p, csg_vec3_scale(slope, (double)f / square));
        if (!(csg_vec3_norm(csg_vec3_sub(p, *at)) <= reach))
            return false;
    }
    *at = p;
    return true;
}

csg_look_at_vertex csg_remesh_look(csg_remesh *r, csg_vec3 at)
{
    float place[1][3];
    uint8_t color[1][4] = {{0, 0, 0, 0}};
    uint16_t material[1][2] = {{0, 0}};
    csg_vec3_to_floats(place[0], at);
    const csgm_mesh *mesh = r->mesh;
    csg_probe_looks(&r->probe, (const float(*)[3])place, 1, mesh->colors ? color : NULL,
                    mesh->materials ? material : NULL);
    return (csg_look_at_vertex){{color[0][0], color[0][1], color[0][2], color[0][3]},
                                {material[0][0], material[0][1]}};
}

/* ---- the bracket ------------------------------------------------------------------------------
 */

enum { MOST_SPLIT = 3, MOST_POINTS = CSG_PROBE_MOST / 2 };

typedef struct bracket {
    float out[MOST_POINTS][3], in[MOST_POINTS][3];
    csg_vec3 at[MOST_POINTS], normal[MOST_POINTS];
    float f[MOST_POINTS];
    size_t count;
} bracket;

/* Centroids of the upright small triangles when each side is cut into `split`. */
static void spread(bracket *b, const csg_vec3 v[3], csg_vec3 normal, int split)
{
    for (int i = 0; i < split; i++)
        for (int j = 0; i + j < split; j++) {
            double s = (i + 1.0 / 3) / split, t = (j + 1.0 / 3) / split;
            b->at[b->count] =
                csg_vec3_add(v[0], csg_vec3_add(csg_vec3_scale(csg_vec3_sub(v[1], v[0]), s),
                                                csg_vec3_scale(csg_vec3_sub(v[2], v[0]), t)));
            b->normal[b->count++] = normal;
        }
}

/* Keeps the points that no step of this length brackets. */
static void take_step(csg_remesh *r, bracket *b, double step)
{
    size_t left = 0;
    for (size_t i = 0; i < b->count; i++) {
        csg_vec3_to_floats(b->out[i], csg_vec3_add(b->at[i], csg_vec3_scale(b->normal[i], step)));
        csg_vec3_to_floats(b->in[i], csg_vec3_sub(b->at[i], csg_vec3_scale(b->normal[i], step)));
    }
    float f_in[MOST_POINTS];
    csg_probe_values(&r->probe, (const float(*)[3])b->out, b->count, b->f);
    csg_probe_values(&r->probe, (const float(*)[3])b->in, b->count, f_in);
    for (size_t i = 0; i < b->count; i++) {
        if (b->f[i] < 0 && f_in[i] >= 0)
            continue;
        b->at[left] = b->at[i];
        b->normal[left++] = b->normal[i];
    }
    b->count = left;
}

/* Thin walls and narrow gaps need a shorter step: it is tried last. */
static bool are_bracketed(csg_remesh *r, bracket *b)
{
    enum { STEPS = 3 };
    double step = r->error;
    for (int i = 0; i < STEPS && b->count; i++, step /= 4)
        take_step(r, b, step);
    bool all = b->count == 0;
    b->count = 0;
    return all;
}

bool csg_remesh_brackets(csg_remesh *r, const csg_vec3 (*triangles)[3], size_t count)
{
    enum { MOST_OF_ONE = MOST_SPLIT * (MOST_SPLIT + 1) / 2 };
    bracket b;
    b.count = 0;
    for (size_t i = 0; i < count; i++) {
        const csg_vec3 *v = triangles[i];
        int split = (int)fmin(MOST_SPLIT, ceil(csg_triangle_longest_side(v) / (1.5 * r->cell)));
        if (b.count + MOST_OF_ONE > MOST_POINTS && !are_bracketed(r, &b))
            return false;
        spread(&b, v, csg_vec3_normalize(csg_triangle_cross(v[0], v[1], v[2])),
               split < 1 ? 1 : split);
    }
    return are_bracketed(r, &b);
}
