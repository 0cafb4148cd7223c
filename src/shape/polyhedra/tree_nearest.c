/* SPDX-License-Identifier: MIT
 * The nearest triangle. Boxes are compared in float, triangles in double. A box is passed over only
 * when its distance is above the best by more than all rounding can be: boxes are wider by 2^-22,
 * which is more than rounding p (2^-24 of it; beyond 2 that is small against the distance) and the
 * box, and the feet of triangles lie in their boxes up to 2^-50; float arithmetic errs by 2^-21 and
 * CSG_TREE_SLACK leaves 2^-18. So whatever the order, the triangle with the least computed distance
 * is seen. CSG_TREE_SLACK is not larger, since for a point far from a small mesh it decides how
 * much of that is seen.
 */
#include <float.h>

#include "base/four.h"
#include "shape/polyhedra/tree.h"

/* ---- one triangle -----------------------------------------------------------------------------
 */

typedef struct offset {
    csg_vec3 vector; /* p - foot */
    double squared;
    csg_triangle_part part;
} offset;

/* The point of a + [0, 1] edge that is nearest to p, given as p - a. */
static void try_segment(offset *best, csg_vec3 ap, csg_vec3 edge, csg_triangle_part part)
{
    double along = csg_vec3_dot(ap, edge), length2 = csg_vec3_dot(edge, edge);
    double t = along <= 0 ? 0 : along >= length2 ? 1 : along / length2;
    csg_vec3 vector = csg_vec3_sub(ap, csg_vec3_scale(edge, t));
    double squared = csg_vec3_dot(vector, vector);
    if (squared < best->squared)
        *best = (offset){vector, squared, t > 0 && t < 1 ? part : CSG_PART_CORNER};
}

/* u and v are barycentric coordinates times w. Outside of just one edge's line the foot is on that
 * edge; outside of two it is on one of them. */
static offset from_edges(const csg_tree_triangle *t, csg_vec3 ap, double u, double v, double w)
{
    offset best = {.squared = INFINITY};
    if (u < 0 || t->is_needle)
        try_segment(&best, ap, t->ac, CSG_PART_EDGE_2);
    if (v < 0 || t->is_needle)
        try_segment(&best, ap, t->ab, CSG_PART_EDGE_0);
    if (!(u + v <= w) || t->is_needle)
        try_segment(&best, csg_vec3_sub(ap, t->ab), csg_vec3_sub(t->ac, t->ab), CSG_PART_EDGE_1);
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

double csg_triangle_squared(const csg_tree_triangle *t, csg_vec3 p)
{
    return triangle_squared(t, p);
}

csg_vec3 csg_triangle_locate(const csg_tree_triangle *t, csg_vec3 p, csg_triangle_part *part)
{
    csg_vec3 ap = csg_vec3_sub(p, t->a), normal = csg_vec3_cross(t->ab, t->ac);
    csg_vec3 side = csg_vec3_cross(normal, ap);
    double w = csg_vec3_dot(normal, normal);
    double u = csg_vec3_dot(side, t->ac), v = -csg_vec3_dot(side, t->ab);
    *part = CSG_PART_FACE;
    if (u >= 0 && v >= 0 && u + v <= w && !t->is_needle)
        return csg_vec3_sub(p, csg_vec3_scale(normal, csg_vec3_dot(ap, normal) / w));
    offset beside = from_edges(t, ap, u, v, w);
    *part = beside.part;
    return csg_vec3_sub(p, beside.vector);
}

csg_vec3 csg_triangle_foot(const csg_tree_triangle *t, csg_vec3 p, bool *in_face)
{
    csg_triangle_part part;
    csg_vec3 foot = csg_triangle_locate(t, p, &part);
    *in_face = part == CSG_PART_FACE;
    return foot;
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
static inline size_t push_near(const csg_tree_node *node, csg_four squared, float limit,
                               entry *stack, size_t depth)
{
    size_t bottom = depth;
    for (unsigned near = csg_four_bits(squared <= csg_four_all(limit)); near; near &= near - 1) {
        unsigned i = (unsigned)__builtin_ctz(near);
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

/* Squared distances that the triangles of a leaf have at least: those from their rectangles. */
static inline csg_four least_distances(const csg_tree_leaf *leaf, const query *q)
{
    csg_four away[3], error = csg_four_all(q->error), sum = csg_four_all(0);
    for (int k = 0; k < 3; k++)
        away[k] = csg_four_all(q->p[k]) - csg_four_load(leaf->center[k]);
    for (int e = 0; e < 3; e++) {
        csg_four along = away[0] * csg_four_load(leaf->axis[e][0]) +
                         away[1] * csg_four_load(leaf->axis[e][1]) +
                         away[2] * csg_four_load(leaf->axis[e][2]);
        csg_four within = e < 2 ? csg_four_load(leaf->half[e]) + error : error;
        along = csg_four_positive(csg_four_abs(along) - within);
        sum += along * along;
    }
    return sum;
}

static inline void try_leaf(const csg_tree *tree, const csg_tree_leaf *leaf, csg_vec3 p, query *q,
                            csg_triangle_hit *best)
{
    csg_four least = least_distances(leaf, q);
    unsigned near = csg_four_bits(least <= csg_four_all(q->limit)) & ((1u << leaf->count) - 1);
    best->leaves++;
    for (; near; near &= near - 1) {
        unsigned i = (unsigned)__builtin_ctz(near);
        uint32_t place = leaf->first + i;
        if (least[i] > q->limit || place == best->place)
            continue;
        double squared = triangle_squared(&tree->triangles[place], p);
        if (squared < best->squared || (squared == best->squared && place < best->place)) {
            best->squared = squared;
            best->place = place;
            q->limit = (float)squared * CSG_TREE_SLACK;
        }
    }
}

/* Of what the stack holds. */
static inline void search(const csg_tree *tree, csg_vec3 p, entry *stack, size_t depth, query *q,
                          csg_triangle_hit *best)
{
    while (depth) {
        entry next = stack[--depth];
        if (next.squared > q->limit)
            continue;
        if (next.child & CSG_TREE_LEAF) {
            try_leaf(tree, &tree->leaves[next.child & ~CSG_TREE_LEAF], p, q, best);
            continue;
        }
        const csg_tree_node *node = &tree->nodes[next.child];
        depth = push_near(node, box_distances(node, q->p), q->limit, stack, depth);
    }
}

static query query_of(csg_vec3 p, double squared)
{
    query q = {.p = {(float)p.x, (float)p.y, (float)p.z}, .limit = (float)squared * CSG_TREE_SLACK};
    q.error = csg_tree_error(q.p[0], q.p[1], q.p[2]);
    return q;
}

csg_triangle_hit csg_tree_nearest(const csg_tree *tree, csg_vec3 p, uint32_t hint)
{
    csg_triangle_hit best = {triangle_squared(&tree->triangles[hint], p), hint, 0};
    query q = query_of(p, best.squared);
    entry stack[STACK];
    stack[0] = (entry){0, 0};
    search(tree, p, stack, 1, &q, &best);
    return best;
}

/* ---- parts of the tree ------------------------------------------------------------------------
 */

/* Per child, all ones where it is a leaf. */
static inline csg_four_mask leaf_mask(const csg_tree_node *node)
{
    csg_four_mask children;
    memcpy(&children, node->children, sizeof children);
    return children >> 31;
}

/* Of the children that count as below an item; infinite for the others. */
static inline csg_four item_distances(const csg_tree_node *node, uint32_t item, const float p[3])
{
    csg_four squared = box_distances(node, p);
    if (!(item & CSG_TREE_LEAVES_ONLY))
        return squared;
    csg_four_mask is_leaf = leaf_mask(node);
    return (csg_four)(((csg_four_mask)squared & is_leaf) |
                      ((csg_four_mask)csg_four_all(INFINITY) & ~is_leaf));
}

static inline const csg_tree_node *node_of(const csg_tree *tree, uint32_t item)
{
    return &tree->nodes[item & ~CSG_TREE_LEAVES_ONLY];
}

/* A leaf to begin with: down the boxes that are nearest. */
static const csg_tree_leaf *near_leaf(const csg_tree *tree, const uint32_t *items, uint32_t count,
                                      const float p[3])
{
    uint32_t child = 0, next = items[0];
    for (float least = INFINITY; !(child & CSG_TREE_LEAF); least = INFINITY) {
        for (uint32_t i = 0; i < count; i++) {
            uint32_t item = child ? child : items[i];
            const csg_tree_node *node = node_of(tree, item);
            csg_four squared = item_distances(node, item, p);
            unsigned near = csg_four_bits(squared < csg_four_all(least));
            for (; near; near &= near - 1) {
                unsigned k = (unsigned)__builtin_ctz(near);
                if (squared[k] < least) {
                    least = squared[k];
                    next = node->children[k];
                }
            }
        }
        child = next;
        count = 1;
    }
    return &tree->leaves[child & ~CSG_TREE_LEAF];
}

csg_triangle_hit csg_tree_nearest_of(const csg_tree *tree, const csg_tree_parts *parts, csg_vec3 p,
                                     uint32_t hint)
{
    csg_triangle_hit best = {parts->most, CSG_TREE_NONE, 0};
    double at_hint = hint == CSG_TREE_NONE ? INFINITY : triangle_squared(&tree->triangles[hint], p);
    if (at_hint <= best.squared && hint != CSG_TREE_NONE)
        best = (csg_triangle_hit){at_hint, hint, 0};
    query q = query_of(p, best.squared);
    if (best.squared == INFINITY)
        try_leaf(tree, near_leaf(tree, parts->items, parts->count, q.p), p, &q, &best);
    entry stack[STACK];
    for (uint32_t i = 0; i < parts->count; i++) {
        uint32_t item = parts->items[i];
        const csg_tree_node *node = node_of(tree, item);
        size_t depth = push_near(node, item_distances(node, item, q.p), q.limit, stack, 0);
        search(tree, p, stack, depth, &q, &best);
    }
    return best;
}

/* A box, wider by more than its own rounding; the limit is a square. */
typedef struct inquiry {
    float low[3], high[3], limit;
} inquiry;

/* Per child, all ones where its box comes near. */
static inline csg_four_mask comes_near(const csg_tree_node *node, const inquiry *q)
{
    csg_four sum = csg_four_all(0);
    for (int k = 0; k < 3; k++) {
        csg_four outside =
            csg_four_positive(csg_four_load(node->low[k]) - csg_four_all(q->high[k])) +
            csg_four_positive(csg_four_all(q->low[k]) - csg_four_load(node->high[k]));
        sum += outside * outside;
    }
    return sum <= csg_four_all(q->limit);
}

static inquiry inquiry_of(csg_vec3 center, csg_vec3 half, double reach)
{
    const double c[3] = {center.x, center.y, center.z}, h[3] = {half.x, half.y, half.z};
    inquiry q = {.limit = (float)(reach * reach) * CSG_TREE_SLACK + FLT_MIN};
    for (int k = 0; k < 3; k++) {
        double more = 0x1p-20 * (1 + fabs(c[k]) + h[k]);
        q.low[k] = (float)(c[k] - h[k] - more);
        q.high[k] = (float)(c[k] + h[k] + more);
    }
    return q;
}

/* Items in place of one: its near children, the leaves among them by the item itself. */
static uint32_t open_item(const csg_tree *tree, uint32_t item, const inquiry *q, uint32_t out[5])
{
    const csg_tree_node *node = node_of(tree, item);
    unsigned near = csg_four_bits(comes_near(node, q)), is_leaf = csg_four_bits(leaf_mask(node));
    uint32_t count = 0;
    if (near & is_leaf)
        out[count++] = item | CSG_TREE_LEAVES_ONLY;
    near = item & CSG_TREE_LEAVES_ONLY ? 0 : near & ~is_leaf;
    for (; near; near &= near - 1)
        out[count++] = node->children[__builtin_ctz(near)];
    return count;
}

/* Opens items from the largest to smaller ones until there are too many. */
uint32_t csg_tree_narrow(const csg_tree *tree, const uint32_t *among, uint32_t among_count,
                         csg_vec3 center, csg_vec3 half, double reach, uint32_t *out, uint32_t most)
{
    enum { QUEUE = 256 };
    uint32_t queue[QUEUE] = {0}, first = 0, end = 1, done = 0;
    inquiry q = inquiry_of(center, half, reach);
    if (among) {
        memcpy(queue, among, among_count * sizeof *among);
        end = among_count;
    }
    for (; first < end; first++) {
        uint32_t opened[5], count = open_item(tree, queue[first], &q, opened);
        bool is_last = count == 1 && opened[0] & CSG_TREE_LEAVES_ONLY;
        if (is_last || done + (end - first - 1) + count > most || end + count > QUEUE) {
            out[done++] = is_last ? opened[0] : queue[first];
            continue;
        }
        for (uint32_t i = 0; i < count; i++)
            queue[end++] = opened[i];
    }
    return done;
}

bool csg_tree_within(const csg_tree *tree, csg_vec3 p, double reach, csg_tree_visit *visit,
                     void *user)
{
    uint32_t stack[STACK];
    size_t depth = 0;
    const float at[3] = {(float)p.x, (float)p.y, (float)p.z};
    double squared = reach * reach * (1 + 0x1p-40);
    float limit = (float)squared * CSG_TREE_SLACK + FLT_MIN;
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
