/* SPDX-License-Identifier: MIT
 * Bezier patches as skeletons: balls around all points of a tensor-product patch.
 *
 * The patch becomes triangles between points of a grid, two sheets of them so close together that
 * they are a thin polyhedron, whose distance is exact; grown by the radius it is the solid. How far
 * triangles are from the patch is bounded by its second derivatives (D. Filip, R. Magedson, R.
 * Markot, Surface algorithms using bounds on derivatives, CAGD 3 (1986)):
 * (M_uu / n^2 + 2 M_uv / (n m) + M_vv / m^2) / 8 for n x m cells.
 */
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "solid/measure.h"
#include "solid/operations.h"

/* Of the radius: how far triangles may be from the patch, and half the thickness. */
#define TOLERANCE 2e-3
#define HALF 1e-4

enum { MOST_CELLS = 320, CELL_STEPS = 1600 };

typedef struct grid {
    csg_triangles triangles; /* points: (n + 1) (m + 1) of one sheet, then as many of the other */
    uint32_t n, m;
    csg_vec3 *normals; /* of the first sheet's points */
    bool ok;
} grid;

static csg_vec3 control(const csg_bezier_patch *p, uint32_t i, uint32_t k)
{
    return p->points[i * p->columns + k];
}

/* The largest |P(i + a + b) - P(i + a) - P(i + b) + P(i)|, a and b steps by rows and columns. */
static double second_difference(const csg_bezier_patch *p, const uint32_t a[2], const uint32_t b[2])
{
    double most = 0;
    for (uint32_t i = 0; i + a[0] + b[0] < p->rows; i++)
        for (uint32_t k = 0; k + a[1] + b[1] < p->columns; k++) {
            csg_vec3 one = csg_vec3_sub(control(p, i + a[0] + b[0], k + a[1] + b[1]),
                                        control(p, i + a[0], k + a[1]));
            csg_vec3 two = csg_vec3_sub(control(p, i + b[0], k + b[1]), control(p, i, k));
            most = fmax(most, csg_vec3_norm(csg_vec3_sub(one, two)));
        }
    return most;
}

/* Cells along rows and columns; 0: too many. Both directions get half of the tolerance, the mixed
 * derivative counted in each by 2 u v <= u^2 + v^2. */
static bool count_cells(const csg_bezier_patch *p, double tolerance, uint32_t cells[2])
{
    const uint32_t row[2] = {1, 0}, column[2] = {0, 1};
    double u = p->rows - 1, v = p->columns - 1;
    double mixed = u * v * second_difference(p, row, column);
    double m[2] = {u * (u - 1) * second_difference(p, row, row) + mixed,
                   v * (v - 1) * second_difference(p, column, column) + mixed};
    for (int i = 0; i < 2; i++) {
        double n = ceil(sqrt(m[i] / (4 * tolerance)));
        if (!(n <= MOST_CELLS))
            return false;
        cells[i] = (uint32_t)fmax(n, 1);
    }
    return true;
}

/* By de Casteljau, in place. */
static csg_vec3 bezier(csg_vec3 *c, uint32_t count, double t)
{
    for (uint32_t left = count - 1; left > 0; left--)
        for (uint32_t i = 0; i < left; i++)
            c[i] = csg_vec3_add(csg_vec3_scale(c[i], 1 - t), csg_vec3_scale(c[i + 1], t));
    return c[0];
}

static csg_vec3 patch_at(const csg_bezier_patch *p, double u, double v)
{
    csg_vec3 across[CSG_PATCH_MOST], along[CSG_PATCH_MOST];
    for (uint32_t i = 0; i < p->rows; i++) {
        for (uint32_t k = 0; k < p->columns; k++)
            along[k] = control(p, i, k);
        across[i] = bezier(along, p->columns, v);
    }
    return bezier(across, p->rows, u);
}

static uint32_t index_of(const grid *g, uint32_t i, uint32_t k)
{
    return i * (g->m + 1) + k;
}

static void add_normal(grid *g, uint32_t a, uint32_t b, uint32_t c)
{
    const csg_vec3 *p = g->triangles.points;
    csg_vec3 normal = csg_vec3_cross(csg_vec3_sub(p[b], p[a]), csg_vec3_sub(p[c], p[a]));
    const uint32_t corners[3] = {a, b, c};
    for (int i = 0; i < 3; i++)
        g->normals[corners[i]] = csg_vec3_add(g->normals[corners[i]], normal);
}

/* The points of both sheets, half a thickness along the normal and against it. */
static void add_points(grid *g, const csg_bezier_patch *p, double half)
{
    uint32_t count = (g->n + 1) * (g->m + 1);
    for (uint32_t i = 0; i <= g->n && g->ok; i++)
        for (uint32_t k = 0; k <= g->m && g->ok; k++)
            g->ok = csg_triangles_add_point(&g->triangles,
                                            patch_at(p, (double)i / g->n, (double)k / g->m));
    for (uint32_t i = 0; i < g->n && g->ok; i++)
        for (uint32_t k = 0; k < g->m; k++) {
            add_normal(g, index_of(g, i, k), index_of(g, i + 1, k), index_of(g, i + 1, k + 1));
            add_normal(g, index_of(g, i, k), index_of(g, i + 1, k + 1), index_of(g, i, k + 1));
        }
    for (uint32_t i = 0; i < count && g->ok; i++) {
        csg_vec3 by = csg_vec3_scale(csg_vec3_normalize(g->normals[i]), half);
        csg_vec3 at = g->triangles.points[i];
        g->triangles.points[i] = csg_vec3_add(at, by);
        g->ok = csg_triangles_add_point(&g->triangles, csg_vec3_sub(at, by));
    }
}

static void add_quad(grid *g, uint32_t a, uint32_t b, uint32_t c, uint32_t d)
{
    g->ok = g->ok && csg_triangles_add(&g->triangles, a, b, c) &&
            csg_triangles_add(&g->triangles, a, c, d);
}

/* Both sheets and what joins their rims. */
static void add_faces(grid *g)
{
    uint32_t other = (g->n + 1) * (g->m + 1);
    for (uint32_t i = 0; i < g->n; i++)
        for (uint32_t k = 0; k < g->m; k++) {
            uint32_t a = index_of(g, i, k), b = index_of(g, i + 1, k);
            uint32_t c = index_of(g, i + 1, k + 1), d = index_of(g, i, k + 1);
            add_quad(g, a, b, c, d);
            g->ok = g->ok && /* the same diagonal */
                    csg_triangles_add(&g->triangles, other + a, other + c, other + b) &&
                    csg_triangles_add(&g->triangles, other + a, other + d, other + c);
        }
    for (uint32_t i = 0; i < g->n; i++) {
        uint32_t a = index_of(g, i, 0), b = index_of(g, i + 1, 0);
        uint32_t c = index_of(g, i, g->m), d = index_of(g, i + 1, g->m);
        add_quad(g, a, other + a, other + b, b);
        add_quad(g, d, other + d, other + c, c);
    }
    for (uint32_t k = 0; k < g->m; k++) {
        uint32_t a = index_of(g, 0, k), b = index_of(g, 0, k + 1);
        uint32_t c = index_of(g, g->n, k), d = index_of(g, g->n, k + 1);
        add_quad(g, b, other + b, other + a, a);
        add_quad(g, c, other + c, other + d, d);
    }
}

bool csg_solid_patch_fits(const csg_bezier_patch *patch, double r)
{
    uint32_t cells[2];
    return count_cells(patch, TOLERANCE * r, cells);
}

csg_node_id csg_solid_patch(csg_solid_job *job, const csg_bezier_patch *patch, double r)
{
    uint32_t cells[2] = {1, 1};
    grid g = {.ok = true};
    count_cells(patch, TOLERANCE * r, cells);
    g.n = cells[0];
    g.m = cells[1];
    size_t bytes = (size_t)(g.n + 1) * (g.m + 1) * sizeof *g.normals;
    if (!csg_solid_charge(job, (uint64_t)g.n * g.m * CELL_STEPS))
        return CSG_NODE_NONE;
    g.normals = csg_memory_alloc(job->memory, bytes);
    if (g.normals)
        memset(g.normals, 0, bytes);
    csg_triangles_init(&g.triangles, job->memory);
    g.ok = g.normals != NULL;
    add_points(&g, patch, HALF * r);
    add_faces(&g);
    csg_memory_release(job->memory, g.normals, bytes);
    if (!g.ok) {
        csg_triangles_release(&g.triangles);
        csg_solid_no_memory(job);
        return CSG_NODE_NONE;
    }
    csg_node_id node = csg_solid_of_triangles(job, &g.triangles, NULL);
    return node == CSG_NODE_NONE ? node : csg_solid_grown(job, node, r - HALF * r);
}
