/* SPDX-License-Identifier: MIT
 * See triangle_tree.h.
 */
#include "mesh/remesh/triangle_tree.h"

#include <math.h>
#include <string.h>

#include "mesh/remesh/triangle.h"

static const csg_triangle_box NOTHING = {{INFINITY, INFINITY, INFINITY},
                                         {-INFINITY, -INFINITY, -INFINITY}};

static void include(csg_triangle_box *box, csg_vec3 p)
{
    const double v[3] = {p.x, p.y, p.z};
    for (int k = 0; k < 3; k++) {
        float low = (float)v[k], high = low;
        if ((double)low > v[k])
            low = nextafterf(low, -INFINITY);
        if ((double)high < v[k])
            high = nextafterf(high, INFINITY);
        box->min[k] = fminf(box->min[k], low);
        box->max[k] = fmaxf(box->max[k], high);
    }
}

csg_triangle_box csg_triangle_box_of(const csg_vec3 v[3])
{
    csg_triangle_box box = NOTHING;
    for (int k = 0; k < 3; k++)
        include(&box, v[k]);
    return box;
}

static csg_triangle_box box_around(const csg_triangle_box *a, const csg_triangle_box *b)
{
    csg_triangle_box box;
    for (int k = 0; k < 3; k++) {
        box.min[k] = fminf(a->min[k], b->min[k]);
        box.max[k] = fmaxf(a->max[k], b->max[k]);
    }
    return box;
}

bool csg_triangle_boxes_overlap(const csg_triangle_box *a, const csg_triangle_box *b)
{
    bool apart = false;
    for (int k = 0; k < 3; k++)
        apart |= a->min[k] > b->max[k] || b->min[k] > a->max[k];
    return !apart;
}

void csg_triangle_tree_corners(const csg_triangle_tree *t, uint32_t triangle, csg_vec3 out[3])
{
    for (uint32_t k = 0; k < 3; k++)
        out[k] = t->at[t->corners->vertex[3 * triangle + k]];
}

static csg_triangle_box box_of_leaf(const csg_triangle_tree *t, size_t leaf)
{
    csg_triangle_box box = NOTHING;
    for (size_t i = leaf * CSG_TRIANGLES_A_LEAF, end = csg_triangle_tree_end(t, leaf); i < end;
         i++) {
        csg_vec3 v[3];
        if (!csg_corners_is_live(t->corners, (uint32_t)i))
            continue;
        csg_triangle_tree_corners(t, (uint32_t)i, v);
        for (int k = 0; k < 3; k++)
            include(&box, v[k]);
    }
    return box;
}

bool csg_triangle_tree_make(csg_triangle_tree *t, const csg_corners *corners, const csg_vec3 *at)
{
    static const double ROUNDING = 1e-7; /* of the whole */
    *t = (csg_triangle_tree){.corners = corners, .at = at, .leaf_count = 1};
    while (t->leaf_count * CSG_TRIANGLES_A_LEAF < corners->triangle_count)
        t->leaf_count *= 2;
    t->nodes = csg_memory_alloc(corners->memory, 2 * t->leaf_count * sizeof *t->nodes);
    if (!t->nodes)
        return false;
    for (size_t i = 0; i < t->leaf_count; i++)
        t->nodes[t->leaf_count + i] = box_of_leaf(t, i);
    for (size_t i = t->leaf_count - 1; i; i--)
        t->nodes[i] = box_around(&t->nodes[2 * i], &t->nodes[2 * i + 1]);
    const csg_triangle_box *all = &t->nodes[1];
    for (int k = 0; k < 3 && all->max[k] >= all->min[k]; k++)
        t->noise = fmax(t->noise, ROUNDING * ((double)all->max[k] - (double)all->min[k]));
    return true;
}

void csg_triangle_tree_release(csg_triangle_tree *t)
{
    if (t->corners)
        csg_memory_release(t->corners->memory, t->nodes, 2 * t->leaf_count * sizeof *t->nodes);
    *t = (csg_triangle_tree){0};
}

void csg_triangle_tree_update(csg_triangle_tree *t, uint32_t triangle)
{
    size_t i = t->leaf_count + triangle / CSG_TRIANGLES_A_LEAF;
    t->nodes[i] = box_of_leaf(t, triangle / CSG_TRIANGLES_A_LEAF);
    for (i /= 2; i; i /= 2) {
        csg_triangle_box box = box_around(&t->nodes[2 * i], &t->nodes[2 * i + 1]);
        if (!memcmp(&box, &t->nodes[i], sizeof box))
            return;
        t->nodes[i] = box;
    }
}

void csg_triangle_tree_update_around(csg_triangle_tree *t, uint32_t vertex)
{
    uint32_t first = t->corners->corner[vertex], c = first;
    do {
        csg_triangle_tree_update(t, c / 3);
        c = csg_corner_swing(t->corners, c);
    } while (c != first);
}

/* ---- the nearest triangle ----------------------------------------------------------------------
 */

static double distance_to_box(const csg_triangle_box *box, csg_vec3 p)
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
static void look_at_leaf(const csg_triangle_tree *t, size_t leaf, csg_vec3 at, double *least,
                         uint32_t *triangle)
{
    for (size_t i = leaf * CSG_TRIANGLES_A_LEAF, end = csg_triangle_tree_end(t, leaf); i < end;
         i++) {
        csg_vec3 v[3];
        if (!csg_corners_is_live(t->corners, (uint32_t)i))
            continue;
        csg_triangle_tree_corners(t, (uint32_t)i, v);
        double weights[3], square = csg_triangle_nearest(v, at, weights);
        if (square < *least) {
            *least = square;
            *triangle = (uint32_t)i;
        }
    }
}

double csg_triangle_tree_nearest(const csg_triangle_tree *t, csg_vec3 at, double most,
                                 uint32_t *triangle)
{
    size_t stack[CSG_TRIANGLE_TREE_STACK], top = 0;
    double least = most * most;
    uint32_t found = CSG_CORNER_NONE;
    stack[top++] = 1;
    while (top) {
        size_t i = stack[--top];
        if (!(distance_to_box(&t->nodes[i], at) < least))
            continue;
        if (i >= t->leaf_count) {
            look_at_leaf(t, i - t->leaf_count, at, &least, &found);
            continue;
        }
        bool near =
            distance_to_box(&t->nodes[2 * i + 1], at) < distance_to_box(&t->nodes[2 * i], at);
        stack[top++] = 2 * i + !near;
        stack[top++] = 2 * i + near;
    }
    if (triangle)
        *triangle = found;
    return found == CSG_CORNER_NONE ? INFINITY : sqrt(least);
}
