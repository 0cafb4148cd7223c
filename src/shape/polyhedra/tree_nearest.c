/* SPDX-License-Identifier: MIT
 * The nearest triangle. Boxes are compared in float, triangles in double. A box is passed over only
 * when its distance is above the best by more than all rounding can be: boxes are wider by 2^-22,
 * which is more than rounding p (2^-24 of it; beyond 2 that is small against the distance) and the
 * box, and the feet of triangles lie in their boxes up to 2^-50; float arithmetic errs by 2^-21 and
 * SLACK leaves 2^-18. So whatever the order, the triangle with the least computed distance is seen.
 * SLACK is not larger, since for a point far from a small mesh it decides how much of that is seen.
 */
#include <float.h>

#include "shape/polyhedra/four.h"
#include "shape/polyhedra/tree.h"

static const float SLACK = 1 + 0x1p-18f;

/* ---- one triangle -----------------------------------------------------------------------------
 */

/* The point of a + [0, 1] edge that is nearest to p, given as p - a, as p - it. */
static csg_vec3 from_segment(csg_vec3 ap, csg_vec3 edge)
{
    double along = csg_vec3_dot(ap, edge), length2 = csg_vec3_dot(edge, edge);
    double t = along <= 0 ? 0 : along >= length2 ? 1 : along / length2;
    return csg_vec3_sub(ap, csg_vec3_scale(edge, t));
}

typedef struct offset {
    csg_vec3 vector; /* p - foot */
    double squared;
} offset;

static void take_nearer(offset *best, csg_vec3 vector)
{
    double squared = csg_vec3_dot(vector, vector);
    if (squared < best->squared)
        *best = (offset){vector, squared};
}

/* u and v are barycentric coordinates times w. Outside of just one edge's line the foot is on that
 * edge; outside of two it is on one of them. */
static offset from_edges(const csg_tree_triangle *t, csg_vec3 ap, double u, double v, double w)
{
    offset best = {.squared = INFINITY};
    if (u < 0 || t->is_needle)
        take_nearer(&best, from_segment(ap, t->ac));
    if (v < 0 || t->is_needle)
        take_nearer(&best, from_segment(ap, t->ab));
    if (!(u + v <= w) || t->is_needle)
        take_nearer(&best, from_segment(csg_vec3_sub(ap, t->ab), csg_vec3_sub(t->ac, t->ab)));
    return best;
}

static inline double triangle_squared(const csg_tree_triangle *t, csg_vec3 p)
{
    csg_vec3 ap = csg_vec3_sub(p, t->a), normal = csg_vec3_cross(t->ab, t->ac);
    csg_vec3 side = csg_vec3_cross(normal, ap);
    double w = csg_vec3_dot(normal, normal);
    double u = csg_vec3_dot(side, t->ac), v = -csg_vec3_dot(side, t->ab);
    if (u >= 0 && v >= 0 && u + v <= w && !t->is_needle) {
        double height = csg_vec3_dot(ap, normal);
        return height * height / w;
    }
    return from_edges(t, ap, u, v, w).squared;
}

csg_vec3 csg_triangle_foot(const csg_tree_triangle *t, csg_vec3 p, bool *in_face)
{
    csg_vec3 ap = csg_vec3_sub(p, t->a), normal = csg_vec3_cross(t->ab, t->ac);
    csg_vec3 side = csg_vec3_cross(normal, ap);
    double w = csg_vec3_dot(normal, normal);
    double u = csg_vec3_dot(side, t->ac), v = -csg_vec3_dot(side, t->ab);
    *in_face = u >= 0 && v >= 0 && u + v <= w && !t->is_needle;
    if (*in_face)
        return csg_vec3_sub(p, csg_vec3_scale(normal, csg_vec3_dot(ap, normal) / w));
    return csg_vec3_sub(p, from_edges(t, ap, u, v, w).vector);
}

/* ---- the tree ---------------------------------------------------------------------------------
 */

typedef struct entry {
    float squared; /* to the box */
    uint32_t child;
} entry;

/* Depth of the tree times three; see tree.c. */
enum { STACK = 256 };

static inline csg_four box_distances(const csg_tree_node *node, const float p[3])
{
    csg_four sum = csg_four_all(0);
    for (int k = 0; k < 3; k++) {
        csg_four at = csg_four_all(p[k]);
        /* one of them is 0 */
        csg_four outside = csg_four_positive(csg_four_load(node->low[k]) - at) +
                           csg_four_positive(at - csg_four_load(node->high[k]));
        sum += outside * outside;
    }
    return sum;
}

/* Pushes the children that may hold something as near as the limit, the nearest last. */
static inline size_t push_children(const csg_tree_node *node, const float p[3], float limit,
                                   entry *stack, size_t depth)
{
    csg_four squared = box_distances(node, p);
    size_t bottom = depth;
    for (uint32_t i = 0; i < 4; i++) {
        if (squared[i] > limit)
            continue;
        size_t at = depth++;
        for (; at > bottom && stack[at - 1].squared < squared[i]; at--)
            stack[at] = stack[at - 1];
        stack[at] = (entry){squared[i], node->children[i]};
    }
    return depth;
}

/* Floats that a query needs; `error` is more than positions and products with normals are off. */
typedef struct query {
    float p[3], error, limit;
} query;

/* Squared distances that the triangles of a leaf have at least: from their planes, and along these
 * from their discs. */
static inline csg_four disc_distances(const csg_tree_leaf *leaf, const query *q)
{
    csg_four along2 = csg_four_all(0), height = csg_four_all(0);
    for (int k = 0; k < 3; k++) {
        csg_four away = csg_four_all(q->p[k]) - csg_four_load(leaf->center[k]);
        height += away * csg_four_load(leaf->normal[k]);
        along2 += away * away;
    }
    along2 = along2 * csg_four_all(0.999999f) - height * height;
    csg_four error = csg_four_all(q->error);
    csg_four beside = csg_four_sqrt(csg_four_positive(along2));
    beside = csg_four_positive(beside - (csg_four_load(leaf->radius) + error));
    height = csg_four_positive(csg_four_abs(height) - error);
    return height * height + beside * beside;
}

static inline void try_leaf(const csg_tree *tree, const csg_tree_leaf *leaf, csg_vec3 p, query *q,
                            csg_triangle_hit *best)
{
    csg_four least = disc_distances(leaf, q);
    best->leaves++;
    for (uint32_t i = 0; i < leaf->count; i++) {
        if (least[i] > q->limit)
            continue;
        uint32_t place = leaf->first + i;
        double squared = triangle_squared(&tree->triangles[place], p);
        if (squared < best->squared || (squared == best->squared && place < best->place)) {
            best->squared = squared;
            best->place = place;
            q->limit = (float)squared * SLACK;
        }
    }
}

csg_triangle_hit csg_tree_nearest(const csg_tree *tree, csg_vec3 p, uint32_t hint)
{
    csg_triangle_hit best = {triangle_squared(&tree->triangles[hint], p), hint, 0};
    query q = {.p = {(float)p.x, (float)p.y, (float)p.z}};
    q.error = 0x1p-20f * (1 + fabsf(q.p[0]) + fabsf(q.p[1]) + fabsf(q.p[2]));
    q.limit = (float)best.squared * SLACK;
    entry stack[STACK];
    size_t depth = 0;
    stack[depth++] = (entry){0, 0};
    while (depth) {
        entry next = stack[--depth];
        if (next.squared > q.limit)
            continue;
        if (next.child & CSG_TREE_LEAF)
            try_leaf(tree, &tree->leaves[next.child & ~CSG_TREE_LEAF], p, &q, &best);
        else
            depth = push_children(&tree->nodes[next.child], q.p, q.limit, stack, depth);
    }
    return best;
}

bool csg_tree_within(const csg_tree *tree, csg_vec3 p, double reach, csg_tree_visit *visit,
                     void *user)
{
    uint32_t stack[STACK];
    size_t depth = 0;
    const float at[3] = {(float)p.x, (float)p.y, (float)p.z};
    double squared = reach * reach * (1 + 0x1p-40);
    float limit = (float)squared * SLACK + FLT_MIN;
    stack[depth++] = 0;
    while (depth) {
        uint32_t next = stack[--depth];
        if (next & CSG_TREE_LEAF) {
            const csg_tree_leaf *leaf = &tree->leaves[next & ~CSG_TREE_LEAF];
            for (uint32_t place = leaf->first; place < leaf->first + leaf->count; place++)
                if (triangle_squared(&tree->triangles[place], p) <= squared && !visit(user, place))
                    return false;
            continue;
        }
        csg_four distances = box_distances(&tree->nodes[next], at);
        for (uint32_t i = 0; i < 4; i++)
            if (distances[i] <= limit)
                stack[depth++] = tree->nodes[next].children[i];
    }
    return true;
}
