/* SPDX-License-Identifier: MIT
 * The tree of boxes and the test of two triangles; see crossing.h.
 */
#include "mesh/crossing.h"

#include <math.h>
#include <string.h>

#include "mesh/decimate_private.h"

enum { LEAF = 4 /* triangles */, DEEPEST = 32 };

/* ---- the tree ----------------------------------------------------------------------------------
 */

static const csg_crossing_box NOTHING = {{INFINITY, INFINITY, INFINITY},
                                         {-INFINITY, -INFINITY, -INFINITY}};

static void include(csg_crossing_box *box, csg_vec3 p)
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

static csg_crossing_box box_of(const csg_vec3 v[3])
{
    csg_crossing_box box = NOTHING;
    for (int k = 0; k < 3; k++)
        include(&box, v[k]);
    return box;
}

static csg_crossing_box join(const csg_crossing_box *a, const csg_crossing_box *b)
{
    csg_crossing_box box;
    for (int k = 0; k < 3; k++) {
        box.min[k] = fminf(a->min[k], b->min[k]);
        box.max[k] = fmaxf(a->max[k], b->max[k]);
    }
    return box;
}

static bool overlap(const csg_crossing_box *a, const csg_crossing_box *b)
{
    bool apart = false;
    for (int k = 0; k < 3; k++)
        apart |= a->min[k] > b->max[k] || b->min[k] > a->max[k];
    return !apart;
}

static void places_of(const csg_crossing *t, uint32_t triangle, csg_vec3 out[3])
{
    for (uint32_t k = 0; k < 3; k++)
        out[k] = t->at[t->corners->vertex[3 * triangle + k]];
}

static csg_crossing_box box_of_leaf(const csg_crossing *t, size_t leaf)
{
    csg_crossing_box box = NOTHING;
    for (size_t i = leaf * LEAF; i < (leaf + 1) * LEAF && i < t->corners->triangle_count; i++) {
        csg_vec3 v[3];
        if (!csg_corners_is_live(t->corners, (uint32_t)i))
            continue;
        places_of(t, (uint32_t)i, v);
        for (int k = 0; k < 3; k++)
            include(&box, v[k]);
    }
    return box;
}

bool csg_crossing_make(csg_crossing *t, const csg_corners *corners, const csg_vec3 *at)
{
    static const double NOISE = 1e-7; /* of the whole: rounding of vertices to floats */
    *t = (csg_crossing){.corners = corners, .at = at, .leaf_count = 1};
    while (t->leaf_count * LEAF < corners->triangle_count)
        t->leaf_count *= 2;
    t->nodes = csg_memory_alloc(corners->memory, 2 * t->leaf_count * sizeof *t->nodes);
    if (!t->nodes)
        return false;
    for (size_t i = 0; i < t->leaf_count; i++)
        t->nodes[t->leaf_count + i] = box_of_leaf(t, i);
    for (size_t i = t->leaf_count - 1; i; i--)
        t->nodes[i] = join(&t->nodes[2 * i], &t->nodes[2 * i + 1]);
    const csg_crossing_box *all = &t->nodes[1];
    for (int k = 0; k < 3 && all->max[k] >= all->min[k]; k++)
        t->clear = fmax(t->clear, NOISE * ((double)all->max[k] - (double)all->min[k]));
    return true;
}

void csg_crossing_release(csg_crossing *t)
{
    if (t->corners)
        csg_memory_release(t->corners->memory, t->nodes, 2 * t->leaf_count * sizeof *t->nodes);
    *t = (csg_crossing){0};
}

void csg_crossing_update(csg_crossing *t, uint32_t triangle)
{
    size_t i = t->leaf_count + triangle / LEAF;
    t->nodes[i] = box_of_leaf(t, triangle / LEAF);
    for (i /= 2; i; i /= 2) {
        csg_crossing_box box = join(&t->nodes[2 * i], &t->nodes[2 * i + 1]);
        if (!memcmp(&box, &t->nodes[i], sizeof box))
            return;
        t->nodes[i] = box;
    }
}

void csg_crossing_update_around(csg_crossing *t, uint32_t vertex)
{
    uint32_t first = t->corners->corner[vertex], c = first;
    do {
        csg_crossing_update(t, c / 3);
        c = csg_corner_swing(t->corners, c);
    } while (c != first);
}

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

static bool stays(const csg_crossing *t, const csg_crossing_change *c, uint32_t triangle)
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

static bool crosses_leaf(const csg_crossing *t, const csg_crossing_change *c, size_t one,
                         const csg_crossing_box *box, size_t leaf)
{
    for (size_t i = leaf * LEAF; i < (leaf + 1) * LEAF && i < t->corners->triangle_count; i++) {
        csg_vec3 v[3];
        if (!stays(t, c, (uint32_t)i))
            continue;
        places_of(t, (uint32_t)i, v);
        csg_crossing_box other = box_of(v);
        if (overlap(box, &other) &&
            cross(c->at[one], c->vertex[one], v, t->corners->vertex + 3 * i, t->clear))
            return true;
    }
    return false;
}

static bool crosses_rest(const csg_crossing *t, const csg_crossing_change *c, size_t one)
{
    size_t stack[2 * DEEPEST], top = 0;
    csg_crossing_box box = box_of(c->at[one]);
    stack[top++] = 1;
    while (top) {
        size_t i = stack[--top];
        if (!overlap(&box, &t->nodes[i]))
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

bool csg_crossing_is_made(const csg_crossing *t, const csg_crossing_change *c)
{
    for (size_t i = 0; i < c->count; i++) {
        for (size_t k = i + 1; k < c->count; k++)
            if (cross(c->at[i], c->vertex[i], c->at[k], c->vertex[k], t->clear))
                return true;
        if (crosses_rest(t, c, i))
            return true;
    }
    return false;
}
