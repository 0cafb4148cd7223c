/* SPDX-License-Identifier: MIT
 * What csg_tree_nearest finds, for several points that go down the tree together, built per
 * instruction set: the lanes are the points, so nothing is compared across them. In double,
 * operations and their order are those of one point (tree_nearest.c), so are the bits; in float,
 * only what is certainly not the nearest is passed over. A register holds twice as many floats as
 * doubles: so many points share the way down, and each half of them looks at triangles for itself.
 * What does not depend on what was found before (four boxes, four rectangles) is computed before
 * anything is decided, so that few branches wait for it.
 */
#include "shape/lane.h"

enum { PARTS = WIDE / LANES };

/* Those points that share a register of doubles. */
typedef struct some_points {
    lane x, y, z;
    lane squared, place; /* nearest until now */
} some_points;

typedef struct search {
    some_points part[PARTS];
    narrow at[3], error, limit;
} search;

/* ---- one triangle -----------------------------------------------------------------------------
 */

typedef struct vector {
    lane x, y, z;
} vector;

#define DOT(a, b) ((a).x * (b).x + (a).y * (b).y + (a).z * (b).z)

/* The least of *best and the squared distance from a + [0, 1] edge, where it counts; ap = p - a. */
static inline void try_segment(lane *best, const vector *ap, csg_vec3 edge, const mask *counts)
{
    const lane none = {0};
    double length2 = csg_vec3_dot(edge, edge);
    lane along = DOT(*ap, edge);
    mask is_before = along <= none, is_after = along >= none + length2;
    lane t = along / length2;
    t = CHOOSE(is_before, none, CHOOSE(is_after, none + 1, t));
    vector v = {ap->x - edge.x * t, ap->y - edge.y * t, ap->z - edge.z * t};
    lane squared = DOT(v, v);
    mask is_nearer = *counts & (squared < *best);
    *best = CHOOSE(is_nearer, squared, *best);
}

/* For the lanes of `counts`; it is farther than what they have from the others. w: the square of
 * the normal, ab x ac. */
__attribute__((always_inline)) static inline void try_triangle(const csg_tree_triangle *t,
                                                               csg_vec3 normal, double w,
                                                               double place, const mask *counts,
                                                               some_points *s)
{
    const lane none = {0};
    vector ap = {s->x - t->a.x, s->y - t->a.y, s->z - t->a.z};
    vector side = {normal.y * ap.z - normal.z * ap.y, normal.z * ap.x - normal.x * ap.z,
                   normal.x * ap.y - normal.y * ap.x};
    lane u = DOT(side, t->ac), v = -DOT(side, t->ab);
    mask is_needle = (mask){0} - (int64_t)(t->is_needle != 0);
    mask beyond[3] = {*counts & ((u < none) | is_needle), *counts & ((v < none) | is_needle),
                      *counts & (~(u + v <= none + w) | is_needle)};
    lane height = DOT(ap, normal);
    lane squared = height * height / w;
    mask is_beside = beyond[0] | beyond[1] | beyond[2];
    if (is_some_lane(&is_beside)) {
        lane beside = none + INFINITY;
        vector bp = {ap.x - t->ab.x, ap.y - t->ab.y, ap.z - t->ab.z};
        if (is_some_lane(&beyond[0]))
            try_segment(&beside, &ap, t->ac, &beyond[0]);
        if (is_some_lane(&beyond[1]))
            try_segment(&beside, &ap, t->ab, &beyond[1]);
        if (is_some_lane(&beyond[2]))
            try_segment(&beside, &bp, csg_vec3_sub(t->ac, t->ab), &beyond[2]);
        squared = CHOOSE(is_beside, beside, squared);
    }
    mask is_nearer =
        *counts & ((squared < s->squared) | ((squared == s->squared) & (none + place < s->place)));
    s->squared = CHOOSE(is_nearer, squared, s->squared);
    s->place = CHOOSE(is_nearer, none + place, s->place);
}

/* ---- leaves -----------------------------------------------------------------------------------
 */

enum { FOUR = 4, EACH = (1 << LANES) - 1 };

/* Both halves of floats in a register. By memory they would be waited for. */
static inline void set_limit(search *s)
{
    typedef float some_floats __attribute__((vector_size(LANES * sizeof(float))));
    some_floats first = __builtin_convertvector(s->part[0].squared, some_floats);
#if defined(__AVX512F__)
    s->limit = first * CSG_TREE_SLACK;
#else
    some_floats last = __builtin_convertvector(s->part[1].squared, some_floats);
#if defined(__AVX__)
    s->limit = __builtin_shufflevector(first, last, 0, 1, 2, 3, 4, 5, 6, 7) * CSG_TREE_SLACK;
#else
    s->limit = __builtin_shufflevector(first, last, 0, 1, 2, 3) * CSG_TREE_SLACK;
#endif
#endif
}

/* For the points of `bits`, a bit each. */
static inline void try_place(const csg_tree *tree, uint32_t place, unsigned bits, search *s)
{
    const csg_tree_triangle *t = &tree->triangles[place];
    csg_vec3 normal = csg_vec3_cross(t->ab, t->ac);
    double w = csg_vec3_dot(normal, normal);
    mask each;
    for (int l = 0; l < LANES; l++)
        each[l] = 1 << l;
    for (int k = 0; k < PARTS; k++) {
        unsigned of = bits >> k * LANES & EACH;
        mask counts = (((mask){0} + (int64_t)of) & each) != 0;
        if (of)
            try_triangle(t, normal, w, (double)place, &counts, &s->part[k]);
    }
    set_limit(s);
}

/* From the rectangle around a triangle: what least_distances in tree_nearest.c is for four
 * triangles. */
static inline void measure_rectangle(const csg_tree_leaf *leaf, uint32_t slot, const search *s,
                                     narrow *out)
{
    narrow away[3], sum = {0};
    for (int k = 0; k < 3; k++)
        away[k] = s->at[k] - leaf->center[k][slot];
    for (int e = 0; e < 3; e++) {
        narrow along = away[0] * leaf->axis[e][0][slot] + away[1] * leaf->axis[e][1][slot] +
                       away[2] * leaf->axis[e][2][slot];
        narrow within = e < 2 ? s->error + leaf->half[e][slot] : s->error;
        along = POSITIVE(SIZE_OF(along) - within);
        sum += along * along;
    }
    *out = sum;
}

static inline unsigned near_bits(const narrow *squared, const search *s)
{
    return BITS_OF(*squared <= s->limit);
}

/* What decides the order only. */
static inline float rank_of(const narrow *squared)
{
    return (*squared)[0] + (*squared)[WIDE - 1];
}

static inline void try_leaf(const csg_tree *tree, const csg_tree_leaf *leaf, uint32_t hint,
                            search *s)
{
    narrow squared[FOUR];
    unsigned near = 0;
    for (uint32_t slot = 0; slot < FOUR; slot++)
        measure_rectangle(leaf, slot, s, &squared[slot]);
    for (uint32_t slot = 0; slot < FOUR; slot++)
        near |= (unsigned)(near_bits(&squared[slot], s) != 0) << slot;
    near &= (1u << leaf->count) - 1;
    for (; near; near &= near - 1) {
        uint32_t slot = (uint32_t)__builtin_ctz(near);
        unsigned bits = near_bits(&squared[slot], s);
        if (bits && leaf->first + slot != hint)
            try_place(tree, leaf->first + slot, bits, s);
    }
}

/* ---- the tree ---------------------------------------------------------------------------------
 */

/* As in tree_nearest.c, whose 220 leave room for four of each of CSG_SHAPE_MOST_NEAR parts. */
enum { STACK = 256 };

/* Nodes and leaves that wait, and how far their boxes are from each point. */
typedef struct waiting {
    narrow squared[STACK];
    uint32_t child[STACK];
    size_t depth;
} waiting;

static inline void push_child(waiting *w, const narrow *squared, uint32_t child)
{
    w->squared[w->depth] = *squared;
    w->child[w->depth++] = child;
}

static inline void measure_box(const csg_tree_node *node, uint32_t slot, const search *s,
                               narrow *out)
{
    narrow sum = {0};
    for (int k = 0; k < 3; k++) {
        narrow below = node->low[k][slot] - s->at[k], above = s->at[k] - node->high[k][slot];
        narrow outside = POSITIVE(LARGER(below, above));
        sum += outside * outside;
    }
    *out = sum;
}

/* Pushes the children below an item that may hold something as near as the limit of some point,
 * the nearest last. */
static inline void push_near(const csg_tree_node *node, const search *s, waiting *w)
{
    narrow squared[FOUR];
    float rank[FOUR];
    unsigned near = 0, order[FOUR];
    size_t count = 0;
    for (uint32_t slot = 0; slot < FOUR; slot++)
        measure_box(node, slot, s, &squared[slot]);
    for (uint32_t slot = 0; slot < FOUR; slot++)
        near |= (unsigned)(near_bits(&squared[slot], s) != 0) << slot;
    for (; near; near &= near - 1) {
        unsigned slot = (unsigned)__builtin_ctz(near);
        size_t at = count++;
        rank[slot] = rank_of(&squared[slot]);
        for (; at > 0 && rank[order[at - 1]] < rank[slot]; at--)
            order[at] = order[at - 1];
        order[at] = slot;
    }
    for (size_t i = 0; i < count; i++)
        push_child(w, &squared[order[i]], node->children[order[i]]);
}

/* Pushes what may be near enough of all items, and brings the nearest to the top: once it has been
 * looked into, most of the others are too far away. */
static inline void push_items(const csg_tree *tree, const csg_tree_parts *parts, const search *s,
                              waiting *w)
{
    const uint32_t *items = parts->items;
    size_t nearest = 0;
    float least = INFINITY;
    for (uint32_t i = 0; i < parts->count; i++) {
        const csg_tree_node *node = &tree->nodes[items[i] & ~CSG_TREE_LEAVES_ONLY];
        for (uint32_t slot = 0; slot < 4; slot++) {
            if (items[i] & CSG_TREE_LEAVES_ONLY && !(node->children[slot] & CSG_TREE_LEAF))
                continue;
            narrow squared;
            measure_box(node, slot, s, &squared);
            if (!near_bits(&squared, s))
                continue;
            float rank = rank_of(&squared);
            nearest = rank < least ? w->depth : nearest;
            least = rank < least ? rank : least;
            push_child(w, &squared, node->children[slot]);
        }
    }
    if (w->depth) {
        narrow squared = w->squared[nearest];
        uint32_t child = w->child[nearest];
        w->squared[nearest] = w->squared[w->depth - 1];
        w->child[nearest] = w->child[w->depth - 1];
        w->squared[w->depth - 1] = squared;
        w->child[w->depth - 1] = child;
    }
}

static inline void search_tree(const csg_tree *tree, uint32_t hint, search *s, waiting *w)
{
    while (w->depth) {
        uint32_t child = w->child[--w->depth];
        if (!near_bits(&w->squared[w->depth], s))
            continue;
        if (child & CSG_TREE_LEAF)
            try_leaf(tree, &tree->leaves[child & ~CSG_TREE_LEAF], hint, s);
        else
            push_near(&tree->nodes[child], s, w);
    }
}

/* A point of each lane; the lanes beyond `used` look for nothing. */
static void enter_points(const csg_vec3 *points, size_t used, double most, search *s)
{
    double at[3][WIDE], squared[WIDE];
    float floats[3][WIDE], error[WIDE];
    for (size_t l = 0; l < WIDE; l++) {
        const csg_vec3 p = points[l < used ? l : used - 1];
        const double of[3] = {p.x, p.y, p.z};
        for (int axis = 0; axis < 3; axis++) {
            at[axis][l] = of[axis];
            floats[axis][l] = (float)of[axis];
        }
        error[l] = csg_tree_error(floats[0][l], floats[1][l], floats[2][l]);
        squared[l] = l < used ? most : -1;
    }
    for (int k = 0; k < PARTS; k++) {
        some_points *part = &s->part[k];
        memcpy(&part->x, at[0] + k * LANES, sizeof part->x);
        memcpy(&part->y, at[1] + k * LANES, sizeof part->y);
        memcpy(&part->z, at[2] + k * LANES, sizeof part->z);
        memcpy(&part->squared, squared + k * LANES, sizeof part->squared);
        part->place = (lane){0} + (double)CSG_TREE_NONE;
    }
    for (int axis = 0; axis < 3; axis++)
        memcpy(&s->at[axis], floats[axis], sizeof s->at[axis]);
    memcpy(&s->error, error, sizeof s->error);
}

static void search_some(const csg_tree *tree, const csg_tree_parts *parts, const csg_vec3 *points,
                        size_t used, uint32_t hint, csg_triangle_hit *hits)
{
    search s;
    waiting w;
    enter_points(points, used, parts->most, &s);
    if (hint != CSG_TREE_NONE)
        try_place(tree, hint, (1u << used) - 1, &s);
    set_limit(&s);
    w.depth = 0;
    push_items(tree, parts, &s, &w);
    search_tree(tree, hint, &s, &w);
    for (size_t l = 0; l < used; l++) {
        const some_points *part = &s.part[l / LANES];
        hits[l] = (csg_triangle_hit){part->squared[l % LANES], (uint32_t)part->place[l % LANES], 0};
    }
}

void CSG_SHAPE_BUILD(csg_nearest_triangles)(const csg_tree *tree, const csg_tree_parts *parts,
                                            const csg_vec3 *points, size_t used, uint32_t hint,
                                            csg_triangle_hit *hits)
{
    for (size_t l = 0; l < used; l += WIDE) {
        size_t some = used - l < WIDE ? used - l : WIDE;
        search_some(tree, parts, points + l, some, hint, hits + l);
        uint32_t last = hits[l + some - 1].place;
        hint = last == CSG_TREE_NONE ? hint : last;
    }
}
