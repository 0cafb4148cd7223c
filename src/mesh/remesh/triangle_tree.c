/* SPDX-License-Identifier: MIT
 * See triangle_tree.h.
 */
#include "mesh/remesh/triangle_tree.h"

#include <math.h>
#include <string.h>

#include "mesh/remesh/triangle.h"

static const csg_triangle_box NOTHING = {{INFINITY, INFINITY, INFINITY},
                                         {-INFINITY, -INFINITY, -INFINITY}};

/* Comparisons and not fminf: that is a call. A float is at most half a step off: one that is
 * rounded inwards is moved by more than that. */
static void include(csg_triangle_box *box, csg_vec3 p)
{
    static const float STEP = 0x1p-23f, LEAST = 0x1p-140f;
    const double v[3] = {p.x, p.y, p.z};
    for (int k = 0; k < 3; k++) {
        float near = (float)v[k], off = (near < 0 ? -near : near) * STEP + LEAST;
        float low = (double)near > v[k] ? near - off : near;
        float high = (double)near < v[k] ? near + off : near;
        box->min[k] = low < box->min[k] ? low : box->min[k];
        box->max[k] = high > box->max[k] ? high : box->max[k];
    }
}

csg_triangle_box csg_triangle_box_nothing(void)
{
    return NOTHING;
}

csg_triangle_box csg_triangle_box_of(const csg_vec3 v[3])
{
    csg_triangle_box box = NOTHING;
    for (int k = 0; k < 3; k++)
        include(&box, v[k]);
    return box;
}

csg_triangle_box csg_triangle_box_around(const csg_triangle_box *a, const csg_triangle_box *b)
{
    csg_triangle_box box;
    for (int k = 0; k < 3; k++) {
        box.min[k] = b->min[k] < a->min[k] ? b->min[k] : a->min[k];
        box.max[k] = b->max[k] > a->max[k] ? b->max[k] : a->max[k];
    }
    return box;
}

static bool contains(const csg_triangle_box *a, const csg_triangle_box *b)
{
    return (a->min[0] <= b->min[0]) & (b->max[0] <= a->max[0]) & (a->min[1] <= b->min[1]) &
           (b->max[1] <= a->max[1]) & (a->min[2] <= b->min[2]) & (b->max[2] <= a->max[2]);
}

void csg_triangle_tree_corners(const csg_triangle_tree *t, uint32_t triangle, csg_vec3 out[3])
{
    for (uint32_t k = 0; k < 3; k++)
        out[k] = t->at[t->corners->vertex[3 * triangle + k]];
}

/* What is known of some triangles. */
typedef struct summary {
    csg_triangle_box box;
    uint32_t facing;
} summary;

static summary of_leaf(const csg_triangle_tree *t, size_t leaf)
{
    summary s = {NOTHING, CSG_FACING_ALL};
    for (size_t i = leaf * CSG_TRIANGLES_A_LEAF, end = csg_triangle_tree_end(t, leaf); i < end;
         i++) {
        csg_vec3 v[3];
        uint32_t triangle = csg_triangle_tree_item(t, i);
        if (!csg_corners_is_live(t->corners, triangle))
            continue;
        csg_triangle_tree_corners(t, triangle, v);
        for (int k = 0; k < 3; k++)
            include(&s.box, v[k]);
        s.facing &= csg_triangle_facing(csg_triangle_cross(v[0], v[1], v[2]));
    }
    return s;
}

static summary of_children(const csg_triangle_tree *t, size_t i)
{
    return (summary){csg_triangle_box_around(&t->nodes[2 * i], &t->nodes[2 * i + 1]),
                     t->facing[2 * i] & t->facing[2 * i + 1]};
}

/* Whether it was another one. */
static bool set_node(csg_triangle_tree *t, size_t i, summary s)
{
    bool same = t->facing[i] == s.facing && !memcmp(&s.box, &t->nodes[i], sizeof s.box);
    t->nodes[i] = s.box;
    t->facing[i] = s.facing;
    return !same;
}

static bool fill(csg_triangle_tree *t)
{
    csg_memory *memory = t->corners->memory;
    t->leaf_count = 1;
    while (t->leaf_count * CSG_TRIANGLES_A_LEAF < t->count)
        t->leaf_count *= 2;
    if (!csg_memory_reserve(memory, (void **)&t->nodes, &t->node_capacity, 2 * t->leaf_count,
                            sizeof *t->nodes) ||
        !csg_memory_reserve(memory, (void **)&t->facing, &t->facing_capacity, 2 * t->leaf_count,
                            sizeof *t->facing))
        return false;
    for (size_t i = 0; i < t->leaf_count; i++)
        set_node(t, t->leaf_count + i, of_leaf(t, i));
    for (size_t i = t->leaf_count - 1; i; i--)
        set_node(t, i, of_children(t, i));
    return true;
}

bool csg_triangle_tree_make(csg_triangle_tree *t, const csg_corners *corners, const csg_vec3 *at)
{
    *t = (csg_triangle_tree){.corners = corners, .at = at, .count = corners->triangle_count};
    if (!fill(t)) {
        csg_triangle_tree_release(t);
        return false;
    }
    const csg_triangle_box *all = &t->nodes[1];
    for (int k = 0; k < 3 && all->max[k] >= all->min[k]; k++)
        t->noise =
            fmax(t->noise, csg_triangle_tree_noise((double)all->max[k] - (double)all->min[k]));
    return true;
}

bool csg_triangle_tree_make_of(csg_triangle_tree *t, const csg_triangle_tree *whole,
                               const csg_corners *corners, const uint32_t *items, uint32_t count,
                               const uint32_t *slots)
{
    t->corners = corners;
    t->at = whole->at;
    t->noise = whole->noise;
    t->items = items;
    t->slots = slots;
    t->count = count;
    return fill(t);
}

void csg_triangle_tree_forget(csg_triangle_tree *t)
{
    csg_memory *memory = t->corners->memory;
    csg_memory_release(memory, t->nodes, t->node_capacity * sizeof *t->nodes);
    csg_memory_release(memory, t->facing, t->facing_capacity * sizeof *t->facing);
    t->nodes = NULL;
    t->facing = NULL;
    t->node_capacity = t->facing_capacity = 0;
}

void csg_triangle_tree_release(csg_triangle_tree *t)
{
    if (t->corners)
        csg_triangle_tree_forget(t);
    *t = (csg_triangle_tree){0};
}

static size_t node_of(const csg_triangle_tree *t, uint32_t triangle)
{
    return t->leaf_count + (t->slots ? t->slots[triangle] : triangle) / CSG_TRIANGLES_A_LEAF;
}

void csg_triangle_tree_update(csg_triangle_tree *t, uint32_t triangle)
{
    size_t i = node_of(t, triangle);
    bool changed = set_node(t, i, of_leaf(t, i - t->leaf_count));
    for (i /= 2; i && changed; i /= 2)
        changed = set_node(t, i, of_children(t, i));
}

void csg_triangle_tree_include(csg_triangle_tree *t, uint32_t triangle)
{
    csg_vec3 v[3];
    csg_triangle_tree_corners(t, triangle, v);
    csg_triangle_box own = csg_triangle_box_of(v);
    uint32_t facing = csg_triangle_facing(csg_triangle_cross(v[0], v[1], v[2]));
    for (size_t i = node_of(t, triangle); i; i /= 2) {
        if (contains(&t->nodes[i], &own) && !(t->facing[i] & ~facing))
            return;
        t->nodes[i] = csg_triangle_box_around(&t->nodes[i], &own);
        t->facing[i] &= facing;
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
        uint32_t item = csg_triangle_tree_item(t, i);
        if (!csg_corners_is_live(t->corners, item))
            continue;
        csg_triangle_tree_corners(t, item, v);
        double weights[3], square = csg_triangle_nearest(v, at, weights);
        if (square < *least) {
            *least = square;
            *triangle = item;
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

/* The square of the distance of the farthest corner. Not of an empty box. */
static double distance_to_corner(const csg_triangle_box *box, csg_vec3 p)
{
    const double v[3] = {p.x, p.y, p.z};
    double square = 0;
    for (int axis = 0; axis < 3; axis++) {
        double below = v[axis] - (double)box->min[axis], above = (double)box->max[axis] - v[axis];
        double d = below > above ? below : above;
        square += d * d;
    }
    return square;
}

static bool is_in_leaf(const csg_triangle_tree *t, size_t node, csg_vec3 at, double least)
{
    uint32_t found = CSG_CORNER_NONE;
    look_at_leaf(t, node - t->leaf_count, at, &least, &found);
    return found != CSG_CORNER_NONE;
}

bool csg_triangle_tree_is_near(const csg_triangle_tree *t, csg_vec3 at, double most, size_t *last)
{
    size_t stack[CSG_TRIANGLE_TREE_STACK], top = 0, hint = *last;
    double least = most * most;
    bool is_hinted = hint >= t->leaf_count && hint < 2 * t->leaf_count;
    if (is_hinted && distance_to_box(&t->nodes[hint], at) < least && is_in_leaf(t, hint, at, least))
        return true;
    if (distance_to_box(&t->nodes[1], at) < least)
        stack[top++] = 1; /* an empty box is infinitely far */
    while (top) {
        size_t i = stack[--top];
        if (i >= t->leaf_count) {
            *last = i;
            if (i != hint && is_in_leaf(t, i, at, least))
                return true;
            continue;
        }
        double first = distance_to_box(&t->nodes[2 * i], at);
        double second = distance_to_box(&t->nodes[2 * i + 1], at);
        if ((first < least && distance_to_corner(&t->nodes[2 * i], at) < least) ||
            (second < least && distance_to_corner(&t->nodes[2 * i + 1], at) < least))
            return true;
        bool nearer = second < first;
        if ((nearer ? first : second) < least)
            stack[top++] = 2 * i + !nearer;
        if ((nearer ? second : first) < least)
            stack[top++] = 2 * i + nearer;
    }
    return false;
}
