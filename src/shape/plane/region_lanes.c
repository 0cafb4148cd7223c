/* SPDX-License-Identifier: MIT
 * csg_segment_nearest_of for several points at once, built per instruction set: the lanes are the
 * points, so nothing is compared across them. Operations and their order are those of one point
 * (region_search.c), so are the bits.
 */
#include "shape/shape_kernel.h"

#include <string.h>

enum { LANES = CSG_SHAPE_WIDTH };

/* Vector types of gcc and clang: the loops are too short for the compiler to find by itself.
 * Numbers of leaves and segments are kept as doubles, which hold them exactly. */
typedef double lane __attribute__((vector_size(LANES * sizeof(double))));
typedef int64_t mask __attribute__((vector_size(LANES * sizeof(int64_t)))); /* all ones, or 0 */

/* Not a function: vectors wider than the registers have no settled way to be passed to one. */
#define CHOOSE(is_first, a, b) (lane)(((is_first) & (mask)(a)) | (~(is_first) & (mask)(b)))

typedef struct search {
    lane x, y;
    lane first; /* leaf where the point's search begins */
    mask is_first_seen;
    lane squared, segment; /* nearest until now */
} search;

/* A point's search begins with its first leaf, so among segments that are as near that leaf's
 * come before those of others, and then what comes first in the list. */
static inline void search_leaf(const csg_segment_leaf *leaf, double number, search *s)
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
    mask is_nearer = (squared < s->squared) | (is_first & (squared == s->squared));
    s->squared = CHOOSE(is_nearer, squared, s->squared);
    s->segment = CHOOSE(is_nearer, segment + number * CSG_SEGMENT_LANES, s->segment);
    s->is_first_seen |= is_first;
}

static void search_node(const csg_segment_tree *tree, uint32_t node, search *s)
{
    for (int l = 0; l < LANES; l++) {
        csg_segment_hit best = {s->squared[l], (uint32_t)s->segment[l]};
        csg_segment_nearest_below(tree, node, s->x[l], s->y[l], &best);
        s->squared[l] = best.squared;
        s->segment[l] = best.segment;
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
    bool is_first_known = has_nodes(list); /* below these a bound saves most of the search */
    if (is_first_known)
        search_first_leaves(tree, &s);
    for (uint32_t i = 0; i < list.count; i++) {
        uint32_t item = list.items[i], number = item & ~CSG_SEGMENT_LEAF;
        if (item & CSG_SEGMENT_LEAF)
            search_leaf(&tree->leaves[number], number, &s);
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
