/* SPDX-License-Identifier: MIT
 * Searches in a tree of segments (region_tree.h). What a search does depends on its point alone.
 */
#include "shape/plane/region_tree.h"

#include <string.h>

/* Four children per level, three of which wait: enough for 4^21 leaves. */
enum { MOST_WAITING = 64 };

static uint32_t cell_along(double at, double low, double per_length, uint32_t count)
{
    double cell = (at - low) * per_length;
    return cell < count - 1 ? (cell > 0 ? (uint32_t)cell : 0) : count - 1;
}

static inline double greater(double a, double b)
{
    return a > b ? a : b;
}

static inline double smaller(double a, double b)
{
    return a < b ? a : b;
}

static inline void search_leaf(const csg_segment_tree *tree, uint32_t number, double x, double y,
                               csg_segment_hit *best)
{
    const csg_segment_leaf *leaf = &tree->leaves[number];
    double squared[CSG_SEGMENT_LANES];
    for (int k = 0; k < CSG_SEGMENT_LANES; k++) {
        double px = x - leaf->ax[k], py = y - leaf->ay[k];
        double along = px * leaf->ux[k] + py * leaf->uy[k];
        double left = leaf->ux[k] * py - leaf->uy[k] * px;
        double beyond = greater(greater(-along, along - leaf->length[k]), 0);
        squared[k] = left * left + beyond * beyond;
    }
    double least = smaller(smaller(squared[0], squared[1]), smaller(squared[2], squared[3]));
    if (!(least < best->squared)) /* nearly always */
        return;
    for (uint32_t k = 0; k < CSG_SEGMENT_LANES; k++) {
        if (squared[k] < best->squared)
            *best = (csg_segment_hit){squared[k], number * CSG_SEGMENT_LANES + k};
    }
}

static inline void box_distances(const csg_segment_tree *tree, const csg_segment_node *node,
                                 double x, double y, double *squared)
{
    for (int k = 0; k < CSG_SEGMENT_LANES; k++) {
        double dx = greater(greater(node->x0[k] - x, x - node->x1[k]), 0);
        double dy = greater(greater(node->y0[k] - y, y - node->y1[k]), 0);
        squared[k] = (dx * dx + dy * dy) * CSG_SEGMENT_BOX_SHARE - tree->room;
    }
}

uint32_t csg_segment_first_leaf(const csg_segment_tree *tree, double x, double y)
{
    uint32_t i = cell_along(x, tree->left, tree->per_x, tree->cells_x),
             j = cell_along(y, tree->bottom, tree->per_y, tree->cells_y);
    return tree->nearest_leaf[(size_t)j * tree->cells_x + i];
}

/* What is nearer than *best below a node, leaves in their order but for the first one, which was
 * searched. */
static inline void search_node(const csg_segment_tree *tree, uint32_t node, uint32_t first,
                               double x, double y, csg_segment_hit *best)
{
    struct {
        double squared;
        uint32_t child;
    } waiting[MOST_WAITING];
    for (size_t count = 0;;) {
        double squared[CSG_SEGMENT_LANES];
        const csg_segment_node *here = &tree->nodes[node];
        box_distances(tree, here, x, y, squared);
        for (int k = CSG_SEGMENT_LANES - 1; k >= 0; k--) {
            if (squared[k] < best->squared) {
                waiting[count].squared = squared[k];
                waiting[count++].child = here->child[k];
            }
        }
        for (;;) {
            if (!count)
                return;
            count--;
            if (!(waiting[count].squared < best->squared))
                continue;
            node = waiting[count].child;
            if (!(node & CSG_SEGMENT_LEAF))
                break;
            if (node != (first | CSG_SEGMENT_LEAF))
                search_leaf(tree, node & ~CSG_SEGMENT_LEAF, x, y, best);
        }
    }
}

csg_segment_hit csg_segment_nearest_in_leaf(const csg_segment_tree *tree, uint32_t leaf, double x,
                                            double y)
{
    csg_segment_hit best = {INFINITY, leaf * CSG_SEGMENT_LANES};
    search_leaf(tree, leaf, x, y, &best);
    return best;
}

csg_segment_hit csg_segment_nearest(const csg_segment_tree *tree, double x, double y)
{
    uint32_t first = csg_segment_first_leaf(tree, x, y);
    csg_segment_hit best = {INFINITY, first * CSG_SEGMENT_LANES};
    search_leaf(tree, first, x, y, &best);
    search_node(tree, (uint32_t)tree->node_count - 1, first, x, y, &best);
    return best;
}

/* The same leaf first, and the others in the same order: of segments that are as near it is the
 * same one that is found. */
csg_segment_hit csg_segment_nearest_of(const csg_segment_tree *tree, csg_segment_list list,
                                       double x, double y)
{
    uint32_t first = csg_segment_first_leaf(tree, x, y);
    csg_segment_hit best = {INFINITY, first * CSG_SEGMENT_LANES};
    search_leaf(tree, first, x, y, &best);
    for (uint32_t i = 0; i < list.count; i++) {
        uint32_t item = list.items[i];
        if (!(item & CSG_SEGMENT_LEAF))
            search_node(tree, item, first, x, y, &best);
        else if (item != (first | CSG_SEGMENT_LEAF))
            search_leaf(tree, item & ~CSG_SEGMENT_LEAF, x, y, &best);
    }
    return best;
}

/* ---- lists --------------------------------------------------------------------------------- */

/* A box and how far around it, and around its middle, segments matter: squares. */
typedef struct inquiry {
    double x, y, half_x, half_y, around, around_middle;
} inquiry;

/* No point of the box is farther from the outline than its middle and the way there. Widened by
 * more than the rounding of distances. */
static inquiry inquiry_of(const csg_segment_tree *tree, csg_segment_list among, csg_vec2 center,
                          csg_vec2 half, double reach)
{
    csg_segment_hit hit = among.count ? csg_segment_nearest_of(tree, among, center.x, center.y)
                                      : csg_segment_nearest(tree, center.x, center.y);
    double diagonal = sqrt(half.x * half.x + half.y * half.y), nearest = sqrt(hit.squared);
    double within = fmin(reach, nearest + diagonal);
    double rounding = 0x1p-40 * (fabs(center.x) + fabs(center.y) + diagonal + within);
    double beside = within + rounding, beyond = within + diagonal + rounding;
    return (inquiry){center.x, center.y, half.x, half.y, beside * beside, beyond * beyond};
}

static bool is_leaf_near(const csg_segment_tree *tree, uint32_t number, const inquiry *q)
{
    csg_segment_hit hit = {q->around_middle, UINT32_MAX};
    search_leaf(tree, number, q->x, q->y, &hit);
    return hit.segment != UINT32_MAX;
}

static bool is_box_near(const csg_segment_node *node, int k, const inquiry *q)
{
    double left = node->x0[k] - q->x, right = q->x - node->x1[k];
    double below = node->y0[k] - q->y, above = q->y - node->y1[k];
    double mx = greater(greater(left, right), 0), my = greater(greater(below, above), 0);
    double dx = greater(mx - q->half_x, 0), dy = greater(my - q->half_y, 0);
    return mx * mx + my * my <= q->around_middle && dx * dx + dy * dy <= q->around;
}

static uint32_t near_children(const csg_segment_tree *tree, uint32_t number, const inquiry *q,
                              uint32_t out[CSG_SEGMENT_LANES])
{
    const csg_segment_node *node = &tree->nodes[number];
    uint32_t count = 0;
    for (int k = 0; k < CSG_SEGMENT_LANES; k++) {
        uint32_t child = node->child[k];
        if (is_box_near(node, k, q) &&
            (!(child & CSG_SEGMENT_LEAF) || is_leaf_near(tree, child & ~CSG_SEGMENT_LEAF, q)))
            out[count++] = child;
    }
    return count;
}

/* Puts items in the place of one. */
static uint32_t replace(uint32_t *items, uint32_t count, uint32_t place, const uint32_t *by,
                        uint32_t by_count)
{
    memmove(items + place + by_count, items + place + 1, (count - place - 1) * sizeof *items);
    memcpy(items + place, by, by_count * sizeof *items);
    return count - 1 + by_count;
}

/* Opens nodes as long as there is room, those that were opened last at the end: the list is wide
 * before it is deep. */
uint32_t csg_segment_narrow(const csg_segment_tree *tree, csg_segment_list among, csg_vec2 center,
                            csg_vec2 half, double reach, uint32_t *out, uint32_t most)
{
    inquiry q = inquiry_of(tree, among, center, half, reach);
    uint32_t root = (uint32_t)tree->node_count - 1, count = 0;
    csg_segment_list from = among.count ? among : (csg_segment_list){&root, 1};
    for (uint32_t i = 0; i < from.count; i++)
        if (!(from.items[i] & CSG_SEGMENT_LEAF) ||
            is_leaf_near(tree, from.items[i] & ~CSG_SEGMENT_LEAF, &q))
            out[count++] = from.items[i];
    for (bool opened = true; opened;) {
        opened = false;
        for (uint32_t i = 0; i < count;) {
            uint32_t children[CSG_SEGMENT_LANES], found = 0;
            bool is_leaf = out[i] & CSG_SEGMENT_LEAF;
            if (!is_leaf)
                found = near_children(tree, out[i], &q, children);
            if (is_leaf || count - 1 + found > most) {
                i++;
                continue;
            }
            count = replace(out, count, i, children, found);
            i += found;
            opened = true;
        }
    }
    return count;
}

typedef struct slots {
    uint32_t first, end;
} slots;

/* The segments of a leaf; the last leaf may have fewer than lanes. */
static slots slots_of(const csg_segment_tree *tree, uint32_t child)
{
    uint32_t first = (child & ~CSG_SEGMENT_LEAF) * CSG_SEGMENT_LANES;
    uint32_t end = first + CSG_SEGMENT_LANES;
    return (slots){first, end < tree->segment_count ? end : (uint32_t)tree->segment_count};
}

/* ---- winding ------------------------------------------------------------------------------ */

/* Crossings of the ray from the point to +x. The lower end belongs to a segment, the upper does
 * not. */
static int crossing(const csg_segment_end *s, double x, double y)
{
    bool up = s->from.y <= y && y < s->to.y, down = s->to.y <= y && y < s->from.y;
    if (!(up || down))
        return 0;
    int sign = up ? 1 : -1;
    if (x < s->from.x && x < s->to.x)
        return sign;
    if (x >= s->from.x && x >= s->to.x)
        return 0;
    double ahead = (s->to.x - s->from.x) * (y - s->from.y),
           beside = (s->to.y - s->from.y) * (x - s->from.x);
    return (up ? beside < ahead : beside > ahead) ? sign : 0;
}

int csg_segment_winding(const csg_segment_tree *tree, double x, double y)
{
    uint32_t waiting[MOST_WAITING], count = 0;
    int winding = 0;
    if (tree->segment_count)
        waiting[count++] = (uint32_t)tree->node_count - 1;
    while (count) {
        uint32_t child = waiting[--count];
        if (child & CSG_SEGMENT_LEAF) {
            slots in = slots_of(tree, child);
            for (uint32_t slot = in.first; slot < in.end; slot++)
                winding += crossing(&tree->ends[slot], x, y);
            continue;
        }
        const csg_segment_node *node = &tree->nodes[child];
        for (int k = 0; k < CSG_SEGMENT_LANES; k++) {
            if (node->y0[k] <= y && y < node->y1[k] && x < node->x1[k])
                waiting[count++] = node->child[k];
        }
    }
    return winding;
}

/* ---- neighbourhood ------------------------------------------------------------------------ */

/* Whether a box may hold a point within `reach` of the segment: its box and its line are near. */
static bool is_around(const csg_segment_node *node, int k, csg_vec2 a, csg_vec2 b, double reach)
{
    if (!(node->x0[k] - reach <= fmax(a.x, b.x) && fmin(a.x, b.x) <= node->x1[k] + reach &&
          node->y0[k] - reach <= fmax(a.y, b.y) && fmin(a.y, b.y) <= node->y1[k] + reach))
        return false;
    double ux = b.x - a.x, uy = b.y - a.y;
    double half_x = 0.5 * (node->x1[k] - node->x0[k]) + reach,
           half_y = 0.5 * (node->y1[k] - node->y0[k]) + reach;
    double off = ux * (0.5 * (node->y0[k] + node->y1[k]) - a.y) -
                 uy * (0.5 * (node->x0[k] + node->x1[k]) - a.x);
    return fabs(off) <= fabs(ux) * half_y + fabs(uy) * half_x;
}

void csg_segment_around(const csg_segment_tree *tree, uint32_t of, double reach,
                        csg_segment_visit *visit, void *user)
{
    uint32_t waiting[MOST_WAITING], count = 0;
    csg_vec2 a = tree->ends[of].from, b = tree->ends[of].to;
    waiting[count++] = (uint32_t)tree->node_count - 1;
    while (count) {
        uint32_t child = waiting[--count];
        if (child & CSG_SEGMENT_LEAF) {
            slots in = slots_of(tree, child);
            for (uint32_t slot = in.first; slot < in.end; slot++) {
                if (!visit(user, slot))
                    return;
            }
            continue;
        }
        for (int k = 0; k < CSG_SEGMENT_LANES; k++) {
            if (is_around(&tree->nodes[child], k, a, b, reach))
                waiting[count++] = tree->nodes[child].child[k];
        }
    }
}

static double segment_squared(const csg_segment_tree *tree, uint32_t slot, double x, double y)
{
    csg_segment_place at = csg_segment_locate(tree, slot, x, y);
    double beyond = greater(greater(-at.along, at.along - at.length), 0);
    return at.left * at.left + beyond * beyond;
}

bool csg_segment_within(const csg_segment_tree *tree, double x, double y, double reach,
                        csg_segment_visit *visit, void *user)
{
    uint32_t waiting[MOST_WAITING], count = 0;
    double limit = reach * reach * (1 + 0x1p-40);
    waiting[count++] = (uint32_t)tree->node_count - 1;
    while (count) {
        uint32_t child = waiting[--count];
        if (child & CSG_SEGMENT_LEAF) {
            slots in = slots_of(tree, child);
            for (uint32_t slot = in.first; slot < in.end; slot++)
                if (segment_squared(tree, slot, x, y) <= limit && !visit(user, slot))
                    return false;
            continue;
        }
        double squared[CSG_SEGMENT_LANES];
        box_distances(tree, &tree->nodes[child], x, y, squared);
        for (int k = 0; k < CSG_SEGMENT_LANES; k++)
            if (squared[k] <= limit)
                waiting[count++] = tree->nodes[child].child[k];
    }
    return true;
}
