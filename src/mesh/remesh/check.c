/* SPDX-License-Identifier: MIT
 * What a change of the mesh must pass; see remesh.h.
 */
#include <math.h>

#include "mesh/remesh/remesh.h"

static float value_at(csg_remesh *r, csg_vec3 at)
{
    float place[1][3], f;
    csg_vec3_to_floats(place[0], at);
    csg_probe_values(&r->probe, (const float(*)[3])place, 1, &f);
    return f;
}

static float value_and_gradient_at(csg_remesh *r, csg_vec3 at, csg_vec3 *gradient)
{
    float place[1][3], g[1][3], f;
    csg_vec3_to_floats(place[0], at);
    csg_probe_values_and_gradients(&r->probe, (const float(*)[3])place, 1, &f, g);
    *gradient = csg_vec3_from_floats(g[0]);
    return f;
}

bool csg_remesh_project(csg_remesh *r, csg_vec3 *at, double reach)
{
    enum { MOST_STEPS = 4 };
    csg_vec3 p = *at;
    for (int step = 0; step < MOST_STEPS; step++) {
        csg_vec3 slope;
        float f = value_and_gradient_at(r, p, &slope);
        if (fabsf(f) <= 2 * r->probe.noise)
            break;
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

bool csg_remesh_come_to_surface(csg_remesh *r, csg_vec3 *at, double reach)
{
    enum { MOST_STEPS = 4 };
    csg_vec3 way, p = *at;
    double f = (double)value_and_gradient_at(r, p, &way);
    double slope = (double)r->probe.marching->field->tape.lipschitz;
    double near = fmax(2 * (double)r->probe.noise, 0x1p-10 * r->error * slope);
    if (fabs(f) <= near)
        return true;
    double square = csg_vec3_dot(way, way);
    for (int step = 0; step < MOST_STEPS && square > 1e-6; step++) {
        p = csg_vec3_sub(p, csg_vec3_scale(way, f / square));
        if (!(csg_vec3_norm(csg_vec3_sub(p, *at)) <= reach))
            return false;
        f = (double)value_at(r, p);
        if (fabs(f) <= near) {
            *at = p;
            return true;
        }
    }
    return csg_remesh_project(r, at, reach);
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

enum { MOST_POINTS = CSG_PROBE_MOST / 2 };

typedef struct bracket {
    float places[2 * MOST_POINTS][3], f[2 * MOST_POINTS]; /* a step outside, then one inside */
    csg_vec3 at[MOST_POINTS], normal[MOST_POINTS];
    size_t count;
} bracket;

/* Centroids of the upright small triangles when each side is cut into `split`. */
static void spread(bracket *b, const csg_vec3 v[3], uint16_t seen, int split)
{
    csg_vec3 normal = csg_vec3_normalize(csg_triangle_cross(v[0], v[1], v[2]));
    for (int i = 0; i < split; i++)
        for (int j = 0; i + j < split; j++) {
            if (seen & csg_bracket_bit(i, j))
                continue;
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
        csg_vec3 way = csg_vec3_scale(b->normal[i], step);
        csg_vec3_to_floats(b->places[2 * i], csg_vec3_add(b->at[i], way));
        csg_vec3_to_floats(b->places[2 * i + 1], csg_vec3_sub(b->at[i], way));
    }
    csg_probe_values(&r->probe, (const float(*)[3])b->places, 2 * b->count, b->f);
    for (size_t i = 0; i < b->count; i++) {
        if (b->f[2 * i] < 0 && b->f[2 * i + 1] >= 0)
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

bool csg_remesh_brackets(csg_remesh *r, const csg_vec3 (*triangles)[3], const uint16_t *seen,
                         size_t count)
{
    enum { MOST_OF_ONE = CSG_BRACKET_MOST_SPLIT * (CSG_BRACKET_MOST_SPLIT + 1) / 2 };
    bracket b;
    b.count = 0;
    for (size_t i = 0; i < count; i++) {
        double longest = csg_triangle_longest_side(triangles[i]);
        if (b.count + MOST_OF_ONE > MOST_POINTS && !are_bracketed(r, &b))
            return false;
        spread(&b, triangles[i], seen ? seen[i] : 0, csg_bracket_split(r, longest * longest));
    }
    return are_bracketed(r, &b);
}
