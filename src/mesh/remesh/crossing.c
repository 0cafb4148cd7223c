/* SPDX-License-Identifier: MIT
 * Two triangles, and one against all; see crossing.h.
 */
#include "mesh/remesh/crossing.h"

#include <math.h>

/* ---- two triangles -----------------------------------------------------------------------------
 */

/* Whether the segment p q meets the triangle; `clear` < 0: only if it is well inside. */
static bool pierces(csg_vec3 p, csg_vec3 q, const csg_vec3 v[3], double clear)
{
    csg_vec3 n = csg_vec3_cross(csg_vec3_sub(v[1], v[0]), csg_vec3_sub(v[2], v[0]));
    double norm = csg_vec3_norm(n);
    double a = csg_vec3_dot(n, csg_vec3_sub(p, v[0])), b = csg_vec3_dot(n, csg_vec3_sub(q, v[0]));
    if (!(norm > 0) || fmin(a, b) > clear * norm || fmax(a, b) < -clear * norm || a == b)
        return false;
    csg_vec3 way = csg_vec3_sub(q, p);
    csg_vec3 at = csg_vec3_add(p, csg_vec3_scale(way, fmin(1, fmax(0, a / (a - b)))));
    for (int k = 0; k < 3; k++) {
        csg_vec3 side = csg_vec3_sub(v[(k + 1) % 3], v[k]);
        double within = csg_vec3_dot(n, csg_vec3_cross(side, csg_vec3_sub(at, v[k])));
        if (within < -clear * norm * csg_vec3_norm(side))
            return false;
    }
    return true;
}

/* Corners in common: their places in each; -1 at the end. */
static int common_corners(const uint32_t a[3], const uint32_t b[3], int in_a[3], int in_b[3])
{
    int count = 0;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            if (a[i] == b[k] && count < 3) {
                in_a[count] = i;
                in_b[count++] = k;
            }
    return count;
}

static bool cross(const csg_vec3 a[3], const uint32_t a_ids[3], const csg_vec3 b[3],
                  const uint32_t b_ids[3], double clear)
{
    int in_a[3], in_b[3], common = common_corners(a_ids, b_ids, in_a, in_b);
    if (common >= 2)
        return false; /* at an edge: they would have to lie in one another */
    if (common == 1) {
        int i = in_a[0], k = in_b[0];
        return pierces(a[(i + 1) % 3], a[(i + 2) % 3], b, -clear) ||
               pierces(b[(k + 1) % 3], b[(k + 2) % 3], a, -clear);
    }
    for (int k = 0; k < 3; k++)
        if (pierces(a[k], a[(k + 1) % 3], b, clear) || pierces(b[k], b[(k + 1) % 3], a, clear))
            return true;
    return false;
}

/* ---- all of them -------------------------------------------------------------------------------
 */

static bool stays(const csg_triangle_tree *t, const csg_crossing_change *c, uint32_t triangle)
{
    if (!csg_corners_is_live(t->corners, triangle) || triangle == c->triangles[0] ||
        triangle == c->triangles[1])
        return false;
    const uint32_t *v = t->corners->vertex + 3 * (size_t)triangle;
    for (int k = 0; k < 3; k++)
        if (v[k] == c->vertices[0] || v[k] == c->vertices[1])
            return false;
    return true;
}

static bool crosses_leaf(const csg_triangle_tree *t, const csg_crossing_change *c, size_t one,
                         const csg_triangle_box *box, size_t leaf)
{
    for (size_t i = leaf * CSG_TRIANGLES_A_LEAF, end = csg_triangle_tree_end(t, leaf); i < end;
         i++) {
        csg_vec3 v[3];
        if (!stays(t, c, (uint32_t)i))
            continue;
        csg_triangle_tree_corners(t, (uint32_t)i, v);
        csg_triangle_box other = csg_triangle_box_of(v);
        if (csg_triangle_boxes_overlap(box, &other) &&
            cross(c->at[one], c->vertex[one], v, t->corners->vertex + 3 * i, t->noise))
            return true;
    }
    return false;
}

static bool crosses_rest(const csg_triangle_tree *t, const csg_crossing_change *c, size_t one)
{
    size_t stack[CSG_TRIANGLE_TREE_STACK], top = 0;
    csg_triangle_box box = csg_triangle_box_of(c->at[one]);
    stack[top++] = 1;
    while (top) {
        size_t i = stack[--top];
        if (!csg_triangle_boxes_overlap(&box, &t->nodes[i]))
            continue;
        if (i >= t->leaf_count) {
            if (crosses_leaf(t, c, one, &box, i - t->leaf_count))
                return true;
            continue;
        }
        stack[top++] = 2 * i + 1;
        stack[top++] = 2 * i;
    }
    return false;
}

bool csg_crossing_is_made(const csg_triangle_tree *t, const csg_crossing_change *c)
{
    for (size_t i = 0; i < c->count; i++) {
        for (size_t k = i + 1; k < c->count; k++)
            if (cross(c->at[i], c->vertex[i], c->at[k], c->vertex[k], t->noise))
                return true;
        if (crosses_rest(t, c, i))
            return true;
    }
    return false;
}
