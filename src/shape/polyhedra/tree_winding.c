/* SPDX-License-Identifier: MIT
 * Winding numbers by rays along x. Seen along x a triangle is crossed when the point lies on the
 * same side of its three edges; the point is thought to be moved by (e^3, e, e^2) with e smaller
 * than anything, so it never lies on an edge. Where the crossing is follows from a 3 x 3
 * determinant. Signs come from double arithmetic where its error cannot change them, else from
 * integers of 128 bits; so every edge is seen alike by both of its triangles, and the sum over a
 * closed chain is a whole winding number, whichever way the ray goes.
 */
#include "shape/polyhedra/tree.h"

typedef struct side {
    double value, size; /* twice a signed area seen along x, with an error below 2^-51 size */
    csg_vec3 a, b;      /* the edge's ends, relative to the point */
    int sign;
} side;

static csg_int128 exact_side(csg_vec3 a, csg_vec3 b)
{
    csg_int128 ay = csg_triangle_frame_steps(a.y), az = csg_triangle_frame_steps(a.z);
    csg_int128 by = csg_triangle_frame_steps(b.y), bz = csg_triangle_frame_steps(b.z);
    return ay * bz - az * by;
}

/* On the edge: what moving the point to y + e, then to z + e^2, makes of it. 0: the edge lies along
 * the ray, its triangle is seen from its rim. */
static int sign_when_moved(csg_vec3 a, csg_vec3 b)
{
    double by_y = a.z - b.z, by_z = b.y - a.y;
    double first = by_y != 0 ? by_y : by_z;
    return (first > 0) - (first < 0);
}

static inline side side_of(csg_vec3 a, csg_vec3 b)
{
    double left = a.y * b.z, right = a.z * b.y;
    side s = {left - right, fabs(left) + fabs(right), a, b, 0};
    if (fabs(s.value) > 0x1p-51 * s.size) {
        s.sign = s.value > 0 ? 1 : -1;
        return s;
    }
    csg_int128 exact = exact_side(a, b);
    s.sign = exact ? (exact > 0) - (exact < 0) : sign_when_moved(a, b);
    return s;
}

/* Sign of (x of the crossing - x of the point) times the triangle's area seen along x. `dx` is
 * added to the corners' x. A point in the plane counts as behind it. */
static bool is_beyond(const side *ab, const side *bc, const side *ca, double dx)
{
    double ax = ab->a.x + dx, bx = bc->a.x + dx, cx = ca->a.x + dx; /* exact */
    double value = ax * bc->value + bx * ca->value + cx * ab->value;
    double size = fabs(ax) * bc->size + fabs(bx) * ca->size + fabs(cx) * ab->size;
    if (fabs(value) > 0x1p-48 * size)
        return (value > 0) == (ab->sign > 0);
    csg_int128 exact = csg_triangle_frame_steps(ax) * exact_side(bc->a, bc->b) +
                       csg_triangle_frame_steps(bx) * exact_side(ca->a, ca->b) +
                       csg_triangle_frame_steps(cx) * exact_side(ab->a, ab->b);
    return exact != 0 && (exact > 0) == (ab->sign > 0);
}

/* What the triangle adds between the point and the point `length` (>= 0, may be infinite) further
 * along x. */
static inline int crossing(const csg_tree_triangle *t, csg_vec3 p, double length)
{
    csg_vec3 a = csg_vec3_sub(t->a, p), b = csg_vec3_add(a, t->ab), c = csg_vec3_add(a, t->ac);
    side ab = side_of(a, b);
    if (ab.sign == 0)
        return 0;
    side bc = side_of(b, c);
    if (bc.sign != ab.sign)
        return 0;
    side ca = side_of(c, a);
    if (ca.sign != ab.sign || !is_beyond(&ab, &bc, &ca, 0))
        return 0;
    return isfinite(length) && is_beyond(&ab, &bc, &ca, -length) ? 0 : ab.sign;
}

enum { STACK = 256 };

typedef struct ray {
    csg_vec3 p;
    double length;
    float y, z, low, high; /* what a box must contain, and the stretch of x it must meet */
    const csg_tree_filter *filter;
} ray;

static inline size_t push_met(const csg_tree_node *node, const ray *r, uint32_t *stack,
                              size_t depth)
{
    uint32_t met[4];
    for (int i = 0; i < 4; i++)
        met[i] = (uint32_t)((node->low[1][i] <= r->y) & (node->high[1][i] >= r->y) &
                            (node->low[2][i] <= r->z) & (node->high[2][i] >= r->z) &
                            (node->low[0][i] <= r->high) & (node->high[0][i] >= r->low));
    for (int i = 0; i < 4; i++)
        if (met[i])
            stack[depth++] = node->children[i];
    return depth;
}

static int leaf_crossings(const csg_tree *tree, const csg_tree_leaf *leaf, const ray *r)
{
    int sum = 0;
    for (uint32_t place = leaf->first; place < leaf->first + leaf->count; place++) {
        const csg_tree_triangle *t = &tree->triangles[place];
        if (!r->filter) {
            sum += crossing(t, r->p, r->length);
            continue;
        }
        uint32_t piece = r->filter->pieces[t->index];
        if (piece != r->filter->without)
            sum += crossing(t, r->p, r->length) * (r->filter->turned[piece] ? -1 : 1);
    }
    return sum;
}

static int count_crossings(const csg_tree *tree, const ray *r)
{
    uint32_t stack[STACK];
    size_t depth = 0;
    int sum = 0;
    stack[depth++] = 0;
    while (depth) {
        uint32_t child = stack[--depth];
        if (child & CSG_TREE_LEAF)
            sum += leaf_crossings(tree, &tree->leaves[child & ~CSG_TREE_LEAF], r);
        else
            depth = push_met(&tree->nodes[child], r, stack, depth);
    }
    return sum;
}

static ray make_ray(csg_vec3 p, double length, const csg_tree_filter *filter)
{
    return (ray){p, length, (float)p.y, (float)p.z, (float)p.x, (float)(p.x + length), filter};
}

int csg_tree_winding(const csg_tree *tree, csg_vec3 p, const csg_tree_filter *filter)
{
    ray r;
    if (p.x + p.x >= tree->box.min.x + tree->box.max.x) {
        r = make_ray(p, INFINITY, filter);
        return count_crossings(tree, &r);
    }
    /* from a point before everything, where the winding number is 0 */
    double before = tree->box.min.x - 1;
    r = make_ray(csg_vec3_make(before, p.y, p.z), p.x - before, filter);
    return -count_crossings(tree, &r);
}

int csg_tree_winding_step(const csg_tree *tree, csg_vec3 p, csg_vec3 q)
{
    bool forward = p.x <= q.x;
    ray r = make_ray(forward ? p : q, forward ? q.x - p.x : p.x - q.x, NULL);
    int sum = count_crossings(tree, &r);
    return forward ? sum : -sum;
}

/* ---- whole lines ------------------------------------------------------------------------------
 */

/* 0: not crossed. */
static int line_crossing(const csg_tree_triangle *t, csg_vec3 p, double *x)
{
    csg_vec3 a = csg_vec3_sub(t->a, p), b = csg_vec3_add(a, t->ab), c = csg_vec3_add(a, t->ac);
    side ab = side_of(a, b), bc = side_of(b, c), ca = side_of(c, a);
    if (ab.sign == 0 || bc.sign != ab.sign || ca.sign != ab.sign)
        return 0;
    double low = fmin(a.x, fmin(b.x, c.x)), high = fmax(a.x, fmax(b.x, c.x));
    double sum = ab.value + bc.value + ca.value;
    double at = sum != 0 ? (a.x * bc.value + b.x * ca.value + c.x * ab.value) / sum : low;
    *x = p.x + fmin(fmax(at, low), high);
    return ab.sign;
}

void csg_tree_line_crossings(const csg_tree *tree, double y, double z, csg_tree_crossing_fn *take,
                             void *user)
{
    ray r = make_ray(csg_vec3_make(0, y, z), 0, NULL);
    uint32_t stack[STACK];
    size_t depth = 0;
    r.low = -INFINITY;
    r.high = INFINITY;
    stack[depth++] = 0;
    while (depth) {
        uint32_t child = stack[--depth];
        if (!(child & CSG_TREE_LEAF)) {
            depth = push_met(&tree->nodes[child], &r, stack, depth);
            continue;
        }
        const csg_tree_leaf *leaf = &tree->leaves[child & ~CSG_TREE_LEAF];
        for (uint32_t place = leaf->first; place < leaf->first + leaf->count; place++) {
            double x;
            int sign = line_crossing(&tree->triangles[place], r.p, &x);
            if (sign)
                take(user, x, sign);
        }
    }
}
