/* SPDX-License-Identifier: MIT
 * What csg_tree_nearest finds, for several points that go down the tree together, built per
 * instruction set: the lanes are the points, so nothing is compared across them. In double,
 * operations and their order are those of one point (tree_nearest.c), so are the bits; in float,
 * only what is certainly not the nearest is passed over.
 */
#include "shape/lane.h"

/* Beside doubles: their floats. Places are kept as doubles, which hold them exactly. */
typedef float narrow __attribute__((vector_size(LANES * sizeof(float))));
typedef int32_t narrow_mask __attribute__((vector_size(LANES * sizeof(int32_t))));

#define POSITIVE(x) (narrow)((narrow_mask)(x) & ((x) > (narrow){0}))

typedef struct search {
    lane x, y, z;
    lane squared, place; /* nearest until now */
    narrow at[3], error, limit;
} search;

/* Whether some lane is set. */
static inline bool is_some(const narrow_mask *m)
{
    csg_four_mask fours[(sizeof *m + sizeof(csg_four_mask) - 1) / sizeof(csg_four_mask)] = {{0}};
    memcpy(fours, m, sizeof *m);
    for (size_t i = 1; i < sizeof fours / sizeof *fours; i++)
        fours[0] |= fours[i];
    return csg_four_bits(fours[0]) != 0;
}

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

/* For the lanes of `counts`; it is farther than what they have from the others. */
__attribute__((always_inline)) static inline void
try_triangle(const csg_tree_triangle *t, double place, const mask *counts, search *s)
{
    const lane none = {0};
    csg_vec3 normal = csg_vec3_cross(t->ab, t->ac);
    double w = csg_vec3_dot(normal, normal);
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

static inline void set_limit(search *s)
{
    s->limit = __builtin_convertvector(s->squared, narrow) * CSG_TREE_SLACK;
}

/* For which points the rectangle around a triangle is near enough: what least_distances in
 * tree_nearest.c is for four triangles. */
static inline bool is_near(const csg_tree_leaf *leaf, uint32_t slot, const search *s,
                           narrow_mask *near)
{
    narrow away[3], sum = {0};
    for (int k = 0; k < 3; k++)
        away[k] = s->at[k] - leaf->center[k][slot];
    for (int e = 0; e < 3; e++) {
        narrow along = away[0] * leaf->axis[e][0][slot] + away[1] * leaf->axis[e][1][slot] +
                       away[2] * leaf->axis[e][2][slot];
        narrow within = e < 2 ? s->error + leaf->half[e][slot] : s->error;
        narrow over = along - within, under = -along - within;
        along = POSITIVE(over) + POSITIVE(under); /* one of them is 0 */
        sum += along * along;
    }
    *near = sum <= s->limit;
    return is_some(near);
}

static inline void try_leaf(const csg_tree *tree, const csg_tree_leaf *leaf, uint32_t hint,
                            search *s)
{
    for (uint32_t slot = 0; slot < leaf->count; slot++) {
        uint32_t place = leaf->first + slot;
        narrow_mask near;
        if (place == hint || !is_near(leaf, slot, s, &near))
            continue;
        const mask counts = __builtin_convertvector(near, mask);
        try_triangle(&tree->triangles[place], (double)place, &counts, s);
        set_limit(s);
    }
}

/* ---- the tree ---------------------------------------------------------------------------------
 */

/* A node or leaf that waits, and how far its box is from each point. */
typedef struct entry {
    narrow squared;
    uint32_t child;
} entry;

/* As in tree_nearest.c, whose 220 leave room for four of each of CSG_SHAPE_MOST_NEAR parts. */
enum { STACK = 256 };

typedef struct waiting {
    entry entries[STACK];
    size_t depth;
} waiting;

static inline void measure_box(const csg_tree_node *node, uint32_t slot, const search *s,
                               narrow *out)
{
    narrow sum = {0};
    for (int k = 0; k < 3; k++) {
        narrow below = node->low[k][slot] - s->at[k], above = s->at[k] - node->high[k][slot];
        narrow outside = POSITIVE(below) + POSITIVE(above); /* one of them is 0 */
        sum += outside * outside;
    }
    *out = sum;
}

/* What decides the order only. */
static inline float rank_of(const narrow *squared)
{
    return (*squared)[0] + (*squared)[LANES - 1];
}

/* Pushes the children below an item that may hold something as near as the limit of some point,
 * the nearest last. */
static inline void push_near(const csg_tree_node *node, const search *s, waiting *w)
{
    size_t bottom = w->depth;
    for (uint32_t slot = 0; slot < 4; slot++) {
        narrow squared;
        measure_box(node, slot, s, &squared);
        narrow_mask near = squared <= s->limit;
        if (!is_some(&near))
            continue;
        size_t at = w->depth++;
        float rank = rank_of(&squared);
        for (; at > bottom && rank_of(&w->entries[at - 1].squared) < rank; at--)
            w->entries[at] = w->entries[at - 1];
        w->entries[at].squared = squared;
        w->entries[at].child = node->children[slot];
    }
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
            narrow_mask near = squared <= s->limit;
            if (!is_some(&near))
                continue;
            float rank = rank_of(&squared);
            nearest = rank < least ? w->depth : nearest;
            least = rank < least ? rank : least;
            w->entries[w->depth].squared = squared;
            w->entries[w->depth++].child = node->children[slot];
        }
    }
    if (w->depth) {
        entry top = w->entries[nearest];
        w->entries[nearest] = w->entries[w->depth - 1];
        w->entries[w->depth - 1] = top;
    }
}

static inline void search_tree(const csg_tree *tree, uint32_t hint, search *s, waiting *w)
{
    while (w->depth) {
        const entry *next = &w->entries[--w->depth];
        narrow_mask near = next->squared <= s->limit;
        if (!is_some(&near))
            continue;
        if (next->child & CSG_TREE_LEAF)
            try_leaf(tree, &tree->leaves[next->child & ~CSG_TREE_LEAF], hint, s);
        else
            push_near(&tree->nodes[next->child], s, w);
    }
}

static void search_some(const csg_tree *tree, const csg_tree_parts *parts, const csg_vec3 *points,
                        uint32_t hint, csg_triangle_hit *hits)
{
    const mask all = ~(mask){0};
    search s;
    waiting w;
    double at[3][LANES];
    float error[LANES];
    for (int l = 0; l < LANES; l++) {
        at[0][l] = points[l].x;
        at[1][l] = points[l].y;
        at[2][l] = points[l].z;
        error[l] = csg_tree_error((float)points[l].x, (float)points[l].y, (float)points[l].z);
    }
    memcpy(&s.x, at[0], sizeof s.x);
    memcpy(&s.y, at[1], sizeof s.y);
    memcpy(&s.z, at[2], sizeof s.z);
    memcpy(&s.error, error, sizeof s.error);
    s.at[0] = __builtin_convertvector(s.x, narrow);
    s.at[1] = __builtin_convertvector(s.y, narrow);
    s.at[2] = __builtin_convertvector(s.z, narrow);
    s.squared = s.x * 0 + parts->most;
    s.place = s.x * 0 + (double)CSG_TREE_NONE;
    if (hint != CSG_TREE_NONE)
        try_triangle(&tree->triangles[hint], (double)hint, &all, &s);
    set_limit(&s);
    w.depth = 0;
    push_items(tree, parts, &s, &w);
    search_tree(tree, hint, &s, &w);
    for (int l = 0; l < LANES; l++)
        hits[l] = (csg_triangle_hit){s.squared[l], (uint32_t)s.place[l], 0};
}

void CSG_SHAPE_BUILD(csg_nearest_triangles)(const csg_tree *tree, const csg_tree_parts *parts,
                                            const csg_vec3 *points, size_t used, uint32_t hint,
                                            csg_triangle_hit *hits)
{
    for (size_t l = 0; l < used; l += LANES) {
        search_some(tree, parts, points + l, hint, hits + l);
        hint = hits[l].place == CSG_TREE_NONE ? hint : hits[l].place;
    }
}
