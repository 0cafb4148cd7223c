/* SPDX-License-Identifier: MIT
 * The tree of boxes; see remesh_nearest.h.
 */
#include "mesh/remesh_nearest.h"

#include <math.h>

#include "mesh/decimate_private.h"

enum { LEAF = 4 /* triangles */, DEEPEST = 40 };

static csg_nearest_box box_of_leaf(const csg_remesh *r, size_t leaf)
{
    csg_nearest_box box = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    for (size_t i = leaf * LEAF; i < (leaf + 1) * LEAF && i < r->corners.triangle_count; i++)
        for (uint32_t k = 0; k < 3 && csg_corners_is_live(&r->corners, (uint32_t)i); k++) {
            csg_vec3 p = csg_remesh_corner(r, 3 * (uint32_t)i + k);
            const float v[3] = {(float)p.x, (float)p.y, (float)p.z};
            for (int axis = 0; axis < 3; axis++) {
                box.min[axis] = fminf(box.min[axis], v[axis]);
                box.max[axis] = fmaxf(box.max[axis], v[axis]);
            }
        }
    return box;
}

static csg_nearest_box join(const csg_nearest_box *a, const csg_nearest_box *b)
{
    csg_nearest_box box;
    for (int axis = 0; axis < 3; axis++) {
        box.min[axis] = fminf(a->min[axis], b->min[axis]);
        box.max[axis] = fmaxf(a->max[axis], b->max[axis]);
    }
    return box;
}

bool csg_nearest_make(csg_nearest *n, const csg_remesh *remesh)
{
    *n = (csg_nearest){.remesh = remesh, .leaf_count = 1};
    while (n->leaf_count * LEAF < remesh->corners.triangle_count)
        n->leaf_count *= 2;
    n->nodes = csg_memory_alloc(remesh->memory, 2 * n->leaf_count * sizeof *n->nodes);
    if (!n->nodes)
        return false;
    for (size_t i = 0; i < n->leaf_count; i++)
        n->nodes[n->leaf_count + i] = box_of_leaf(remesh, i);
    for (size_t i = n->leaf_count - 1; i; i--)
        n->nodes[i] = join(&n->nodes[2 * i], &n->nodes[2 * i + 1]);
    return true;
}

void csg_nearest_release(csg_nearest *n)
{
    if (n->remesh)
        csg_memory_release(n->remesh->memory, n->nodes, 2 * n->leaf_count * sizeof *n->nodes);
    *n = (csg_nearest){0};
}

static double distance_to_box(const csg_nearest_box *box, csg_vec3 p)
{
    const double v[3] = {p.x, p.y, p.z};
    double square = 0;
    for (int axis = 0; axis < 3; axis++) {
        double below = (double)box->min[axis] - v[axis], above = v[axis] - (double)box->max[axis];
        double d = below > above ? below : above;
        square += d > 0 ? d * d : 0;
    }
    return square;
}

/* The nearest of a leaf's triangles, if it is nearer than *least. */
static void look_at_leaf(const csg_nearest *n, size_t leaf, csg_vec3 at, double *least,
                         uint32_t *triangle)
{
    const csg_remesh *r = n->remesh;
    for (size_t i = leaf * LEAF; i < (leaf + 1) * LEAF && i < r->corners.triangle_count; i++) {
        uint32_t t = (uint32_t)i;
        if (!csg_corners_is_live(&r->corners, t))
            continue;
        const csg_vec3 v[3] = {csg_remesh_corner(r, 3 * t), csg_remesh_corner(r, 3 * t + 1),
                               csg_remesh_corner(r, 3 * t + 2)};
        double weights[3], square = csg_nearest_on_triangle(v, at, weights);
        if (square < *least) {
            *least = square;
            *triangle = t;
        }
    }
}

double csg_nearest_distance(const csg_nearest *n, csg_vec3 at, double most, uint32_t *triangle)
{
    size_t stack[2 * DEEPEST], top = 0;
    double least = most * most;
    uint32_t found = CSG_CORNER_NONE;
    stack[top++] = 1;
    while (top) {
        size_t i = stack[--top];
        if (!(distance_to_box(&n->nodes[i], at) < least))
            continue;
        if (i >= n->leaf_count) {
            look_at_leaf(n, i - n->leaf_count, at, &least, &found);
            continue;
        }
        bool near =
            distance_to_box(&n->nodes[2 * i + 1], at) < distance_to_box(&n->nodes[2 * i], at);
        stack[top++] = 2 * i + !near;
        stack[top++] = 2 * i + near;
    }
    if (triangle)
        *triangle = found;
    return found == CSG_CORNER_NONE ? INFINITY : sqrt(least);
}
