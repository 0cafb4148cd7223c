/* SPDX-License-Identifier: MIT
 * Least squares; see normals.h. Of each triangle the surface's normals are asked for at the three
 * points of the rule that is exact for squares (Strang and Fix 1973), and continued to its corners
 * as a linear field would be: where triangles agree, as on a cylinder, a vertex gets the normal of
 * the surface there. Where they do not, it is their mean by areas: the projection of the surface's
 * normals on what triangles can show, with each row of its matrix summed up on the diagonal.
 */
#include "mesh/remesh/normals.h"

#include <string.h>

#include "mesh/remesh/probe_loop.h"

enum { POINTS = 3, TRIANGLES = CSG_PROBE_MOST / POINTS };

typedef struct fit {
    const csg_remesh *remesh;
    uint32_t *triangles;       /* those that are live */
    float (*there)[POINTS][3]; /* what each of these says of its corners */
    size_t count;
} fit;

/* Near each corner: two thirds of the way from the middle of the other side. */
static void place_points(const csg_vec3 v[3], float (*at)[3])
{
    csg_vec3 sum = csg_vec3_add(v[0], csg_vec3_add(v[1], v[2]));
    for (int k = 0; k < POINTS; k++)
        csg_vec3_to_floats(at[k],
                           csg_vec3_scale(csg_vec3_add(sum, csg_vec3_scale(v[k], 3)), 1.0 / 6));
}

/* Where the field has no gradient, or that of another sheet, the triangle's own normal will do. */
static csg_vec3 normal_at(const float gradient[3], csg_vec3 own)
{
    static const double SAME_SHEET = 0.5;
    csg_vec3 n = csg_vec3_normalize(csg_vec3_scale(csg_vec3_from_floats(gradient), -1));
    return csg_vec3_dot(n, own) > SAME_SHEET ? n : own;
}

static void continue_to_corners(const csg_vec3 v[3], const float (*gradient)[3],
                                float there[POINTS][3])
{
    csg_vec3 own = csg_vec3_normalize(csg_triangle_cross(v[0], v[1], v[2]));
    csg_vec3 n[POINTS], mean = {0, 0, 0};
    for (int k = 0; k < POINTS; k++) {
        n[k] = normal_at(gradient[k], own);
        mean = csg_vec3_add(mean, csg_vec3_scale(n[k], 1.0 / POINTS));
    }
    for (int k = 0; k < POINTS; k++)
        csg_vec3_to_floats(there[k], csg_vec3_sub(csg_vec3_scale(n[k], 2), mean));
}

static void ask_some(void *user, csg_probe *probe, size_t first, size_t end)
{
    const fit *f = user;
    float at[POINTS * TRIANGLES][3], gradient[POINTS * TRIANGLES][3];
    csg_vec3 v[3];
    for (size_t i = first; i < end; i++) {
        csg_triangle_tree_corners(&f->remesh->tree, f->triangles[i], v);
        place_points(v, at + POINTS * (i - first));
    }
    csg_probe_true_gradients(probe, (const float(*)[3])at, POINTS * (end - first), gradient);
    for (size_t i = first; i < end; i++) {
        csg_triangle_tree_corners(&f->remesh->tree, f->triangles[i], v);
        continue_to_corners(v, (const float(*)[3])(gradient + POINTS * (i - first)), f->there[i]);
    }
}

/* Sums by areas. */
static void add_up(const fit *f, const uint32_t *number, csg_vec3 *normals)
{
    for (size_t i = 0; i < f->count; i++) {
        csg_vec3 v[3];
        csg_triangle_tree_corners(&f->remesh->tree, f->triangles[i], v);
        double area = csg_vec3_norm(csg_triangle_cross(v[0], v[1], v[2]));
        for (size_t k = 0; k < POINTS; k++) {
            csg_vec3 *sum = &normals[number[3 * (size_t)f->triangles[i] + k]];
            csg_vec3 there = csg_vec3_from_floats(f->there[i][k]);
            *sum = csg_vec3_add(*sum, csg_vec3_scale(there, area));
        }
    }
}

bool csg_remesh_find_normals(csg_remesh *r, const uint32_t *number, uint32_t count,
                             csg_vec3 *normals)
{
    const size_t live = r->corners.live;
    fit f = {.remesh = r,
             .triangles = csg_memory_alloc(r->memory, live * sizeof *f.triangles),
             .there = csg_memory_alloc(r->memory, live * sizeof *f.there)};
    bool done = f.triangles && f.there;
    for (uint32_t t = 0; done && t < r->corners.triangle_count; t++)
        if (csg_corners_is_live(&r->corners, t))
            f.triangles[f.count++] = t;
    if (!done)
        csg_mesh_stop_without_memory(r->watch);
    else
        done = csg_probe_loop(r->watch, r->marching, f.count, TRIANGLES, ask_some, &f);
    memset(normals, 0, count * sizeof *normals);
    if (done)
        add_up(&f, number, normals);
    csg_memory_release(r->memory, f.triangles, live * sizeof *f.triangles);
    csg_memory_release(r->memory, f.there, live * sizeof *f.there);
    return done;
}
