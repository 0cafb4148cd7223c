/* SPDX-License-Identifier: MIT
 * csg_segment_nearest_of for several points at once, built per instruction set: the lanes are the
 * points, so nothing is compared across them. Operations and their order are those of one point
 * (region_search.c), so are the bits.
 */
#include "shape/lane.h"

/* Numbers of leaves and segments are kept as doubles, which hold them exactly. */
typedef struct search {
    lane x, y;
    lane first; /* leaf where the point's search begins */
    mask is_first_seen;
    lane squared, segment; /* nearest until now */
} search;

/* A point's search begins with its first leaf, so among segments that are as near that leaf's
 * come before those of others, and then what comes first in the list. counts: the points that look
 * into this leaf. */
static inline void search_leaf(const csg_segment_leaf *leaf, double number, const mask *counts,
                               search *s)
{
    const lane none = {0};
    lane squared = none + INFINITY, segment = none;
    for (int k = 0; k < CSG_SEGMENT_LANES; k++) {
        lane px = s->x - leaf->ax[k], py = s->y - leaf->ay[k];
        lane along = px * leaf->ux[k] + py * leaf->uy[k];
        lane left = leaf->ux[k] * py - leaf->uy[k] * px;
        lane before = -along, after = along - leaf->length[k];
        lane beyond = CHOOSE(before > after, before, after);
        beyond = (lane)((beyond > none) & (mask)beyond);
        lane here = left * left + beyond * beyond;
        mask is_nearer = here < squared;
        squared = CHOOSE(is_nearer, here, squared);
        segment = CHOOSE(is_nearer, none + (double)k, segment);
    }
    mask is_first = s->first == none + number;
    mask is_nearer = *counts & ((squared < s->squared) | (is_first & (squared == s->squared)));
    s->squared = CHOOSE(is_nearer, squared, s->squared);
    s->segment = CHOOSE(is_nearer, segment + number * CSG_SEGMENT_LANES, s->segment);
    s->is_first_seen |= is_first;
}

/* ---- nodes ------------------------------------------------------------------------------------
 */

/* As in region_search.c. */
enum { MOST_WAITING = 64 };

/* A node or leaf, and how far its box is from each point; infinite for those that passed over the
 * node above. */
typedef struct waiting {
    lane squared;
    uint32_t child;
} waiting;

static inline void measure_box(const csg_segment_tree *tree, const csg_segment_node *node, int k,
                               const search *s, lane *out)
{
    const lane none = {0};
    lane left = node->x0[k] - s->x, right = s->x - node->x1[k];
    lane below = node->y0[k] - s->y, above = s->y - node->y1[k];
    lane dx = CHOOSE(left > right, left, right), dy = CHOOSE(below > above, below, above);
    dx = (lane)((dx > none) & (mask)dx);
    dy = (lane)((dy > none) & (mask)dy);
    *out = (dx * dx + dy * dy) * CSG_SEGMENT_BOX_SHARE - tree->room;
}

/* The points go down together, and each of them looks into what it would look into by itself
 * (region_search.c), in the same order. */
static void search_node(const csg_segment_tree *tree, uint32_t node, search *s)
{
    waiting stack[MOST_WAITING];
    size_t count = 0;
    stack[count++] = (waiting){s->x * 0, node};
    while (count) {
        waiting at = stack[--count];
        mask counts = at.squared < s->squared;
        if (!is_some_lane(&counts))
            continue;
        uint32_t number = at.child & ~CSG_SEGMENT_LEAF;
        if (at.child & CSG_SEGMENT_LEAF) {
            search_leaf(&tree->leaves[number], number, &counts, s);
            continue;
        }
        for (int k = CSG_SEGMENT_LANES - 1; k >= 0; k--) {
            lane squared;
            measure_box(tree, &tree->nodes[number], k, s, &squared);
            mask is_near = counts & (squared < s->squared);
            if (!is_some_lane(&is_near))
                continue;
            stack[count].squared = CHOOSE(is_near, squared, s->x * 0 + INFINITY);
            stack[count++].child = tree->nodes[number].child[k];
        }
    }
}

static bool has_nodes(csg_segment_list list)
{
    for (uint32_t i = 0; i < list.count; i++)
        if (!(list.items[i] & CSG_SEGMENT_LEAF))
            return true;
    return false;
}

/* The nearest in each point's first leaf. */
static void search_first_leaves(const csg_segment_tree *tree, search *s)
{
    for (int l = 0; l < LANES; l++) {
        csg_segment_hit hit =
            csg_segment_nearest_in_leaf(tree, (uint32_t)s->first[l], s->x[l], s->y[l]);
        s->squared[l] = hit.squared;
        s->segment[l] = hit.segment;
    }
}

static void search_some(const csg_segment_tree *tree, csg_segment_list list, const double *x,
                        const double *y, csg_segment_hit *hits)
{
    search s = {.is_first_seen = {0}};
    double first[LANES];
    for (int l = 0; l < LANES; l++)
        first[l] = csg_segment_first_leaf(tree, x[l], y[l]);
    memcpy(&s.x, x, sizeof s.x);
    memcpy(&s.y, y, sizeof s.y);
    memcpy(&s.first, first, sizeof s.first);
    s.squared = s.first * 0 + INFINITY;
    s.segment = s.first * CSG_SEGMENT_LANES;
    const mask all = s.first == s.first;
    bool is_first_known = has_nodes(list); /* below these a bound saves most of the search */
    if (is_first_known)
        search_first_leaves(tree, &s);
    for (uint32_t i = 0; i < list.count; i++) {
        uint32_t item = list.items[i], number = item & ~CSG_SEGMENT_LEAF;
        if (item & CSG_SEGMENT_LEAF)
            search_leaf(&tree->leaves[number], number, &all, &s);
        else
            search_node(tree, item, &s);
    }
    for (int l = 0; l < LANES; l++) {
        hits[l] = (csg_segment_hit){s.squared[l], (uint32_t)s.segment[l]};
        if (is_first_known || s.is_first_seen[l])
            continue;
        csg_segment_hit own = csg_segment_nearest_in_leaf(tree, (uint32_t)first[l], x[l], y[l]);
        if (own.squared <= hits[l].squared)
            hits[l] = own;
    }
}

void CSG_SHAPE_BUILD(csg_nearest_segments)(const csg_segment_tree *tree, csg_segment_list list,
                                           const double *x, const double *y, csg_segment_hit *hits)
{
    for (int l = 0; l < CSG_SHAPE_LANES; l += LANES)
        search_some(tree, list, x + l, y + l, hits + l);
}
