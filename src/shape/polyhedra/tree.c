/* SPDX-License-Identifier: MIT
 * Building the tree: ranges of triangles are split where the surface area heuristic says (16 bins
 * along the longest side of their centres), twice in a row to make nodes of four. Ranges that do
 * not split well, or lie too deep, are halved, so the depth is bounded.
 */
#include "shape/polyhedra/tree.h"

enum { LEAF_MOST = 4, BINS = 16, DEPTH_MOST = 40 };

typedef struct bounds {
    float low[3], high[3];
} bounds;

typedef struct item {
    bounds box;
    uint32_t index;
} item;

typedef struct range {
    uint32_t first, count;
    uint32_t depth;
    bounds box;
} range;

typedef struct builder {
    csg_tree *tree;
    item *items;
} builder;

static const bounds NOTHING = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};

static void extend(bounds *box, const bounds *by)
{
    for (int k = 0; k < 3; k++) {
        box->low[k] = by->low[k] < box->low[k] ? by->low[k] : box->low[k];
        box->high[k] = by->high[k] > box->high[k] ? by->high[k] : box->high[k];
    }
}

static float half_area(const bounds *box)
{
    float x = box->high[0] - box->low[0], y = box->high[1] - box->low[1],
          z = box->high[2] - box->low[2];
    return x >= 0 ? x * y + y * z + z * x : 0;
}

/* Twice the centre: enough to compare. */
static float center2(const item *it, int axis)
{
    return it->box.low[axis] + it->box.high[axis];
}

static bounds bounds_of(const item *items, size_t count)
{
    bounds box = NOTHING;
    for (size_t i = 0; i < count; i++)
        extend(&box, &items[i].box);
    return box;
}

/* ---- splitting --------------------------------------------------------------------------------
 */

typedef struct binning {
    int axis;
    float low, per_unit;
} binning;

static int bin_of(const binning *b, const item *it)
{
    int bin = (int)((center2(it, b->axis) - b->low) * b->per_unit);
    return bin < BINS - 1 ? bin : BINS - 1;
}

/* False: all centres are at one place, as far as floats tell. */
static bool choose_axis(const item *items, size_t count, binning *out)
{
    float low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (size_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++) {
            float c = center2(&items[i], k);
            low[k] = c < low[k] ? c : low[k];
            high[k] = c > high[k] ? c : high[k];
        }
    out->axis = 0;
    for (int k = 1; k < 3; k++)
        if (high[k] - low[k] > high[out->axis] - low[out->axis])
            out->axis = k;
    float length = high[out->axis] - low[out->axis];
    out->low = low[out->axis];
    out->per_unit = (float)BINS / length;
    return length > 1e-30f;
}

/* The last bin of the lower part with the least sum of area times count; -1: none is in use. */
static int choose_bin(const bounds *boxes, const uint32_t *counts)
{
    float above[BINS];
    bounds box = NOTHING;
    uint32_t count = 0;
    for (int i = BINS - 1; i > 0; i--) {
        extend(&box, &boxes[i]);
        count += counts[i];
        above[i] = half_area(&box) * (float)count;
    }
    box = NOTHING;
    uint32_t below = 0;
    float least = INFINITY;
    int best = -1;
    for (int i = 0; i + 1 < BINS; i++) {
        extend(&box, &boxes[i]);
        below += counts[i];
        count -= counts[i + 1];
        float cost = half_area(&box) * (float)below + above[i + 1];
        if (below && count + counts[i + 1] && cost < least) {
            least = cost;
            best = i;
        }
    }
    return best;
}

static uint32_t partition(item *items, uint32_t count, const binning *b, int last)
{
    uint32_t low = 0, high = count;
    while (low < high) {
        if (bin_of(b, &items[low]) <= last) {
            low++;
            continue;
        }
        item swapped = items[low];
        items[low] = items[--high];
        items[high] = swapped;
    }
    return low;
}

/* Triangles in the lower part; in between for ranges that no plane divides. */
static uint32_t split_at(builder *b, const range *r)
{
    item *items = b->items + r->first;
    binning bins;
    if (r->depth >= DEPTH_MOST || !choose_axis(items, r->count, &bins))
        return r->count / 2;
    bounds boxes[BINS];
    uint32_t counts[BINS] = {0};
    for (int i = 0; i < BINS; i++)
        boxes[i] = NOTHING;
    for (uint32_t i = 0; i < r->count; i++) {
        int bin = bin_of(&bins, &items[i]);
        extend(&boxes[bin], &items[i].box);
        counts[bin]++;
    }
    int last = choose_bin(boxes, counts);
    uint32_t lower = last < 0 ? 0 : partition(items, r->count, &bins, last);
    return lower == 0 || lower == r->count ? r->count / 2 : lower;
}

static void split(builder *b, const range *r, range *lower, range *upper)
{
    uint32_t count = split_at(b, r);
    *lower = (range){r->first, count, r->depth + 1, bounds_of(b->items + r->first, count)};
    *upper = (range){r->first + count, r->count - count, r->depth + 1,
                     bounds_of(b->items + r->first + count, r->count - count)};
}

/* Up to four parts: the largest is split while there is one that should be. */
static uint32_t split_to_four(builder *b, const range *whole, range parts[4])
{
    uint32_t count = 1;
    parts[0] = *whole;
    while (count < 4) {
        int widest = -1;
        for (uint32_t i = 0; i < count; i++)
            if (parts[i].count > LEAF_MOST &&
                (widest < 0 || half_area(&parts[i].box) > half_area(&parts[widest].box)))
                widest = (int)i;
        if (widest < 0)
            break;
        range r = parts[widest];
        split(b, &r, &parts[widest], &parts[count++]);
    }
    return count;
}

/* ---- nodes ------------------------------------------------------------------------------------
 */

static void set_child(csg_tree_node *node, uint32_t slot, const bounds *box, uint32_t child)
{
    for (int k = 0; k < 3; k++) {
        node->low[k][slot] = box->low[k] - CSG_TREE_PAD;
        node->high[k][slot] = box->high[k] + CSG_TREE_PAD;
    }
    node->children[slot] = child;
}

static bool add_leaf(csg_tree *tree, const range *r)
{
    void *leaves = tree->leaves;
    bool ok = csg_memory_reserve(tree->memory, &leaves, &tree->leaf_capacity, tree->leaf_count + 1,
                                 sizeof *tree->leaves);
    tree->leaves = leaves;
    if (ok)
        tree->leaves[tree->leaf_count++] = (csg_tree_leaf){.first = r->first, .count = r->count};
    return ok;
}

static bool add_node(csg_tree *tree)
{
    void *nodes = tree->nodes;
    bool ok = csg_memory_reserve(tree->memory, &nodes, &tree->node_capacity, tree->node_count + 1,
                                 sizeof *tree->nodes);
    tree->nodes = nodes;
    tree->node_count += ok;
    return ok;
}

/* Slots without a triangle get a box that is nowhere. */
static void clear_node(csg_tree_node *node)
{
    static const bounds NOWHERE = {{0x1p62f, 0x1p62f, 0x1p62f}, {-0x1p62f, -0x1p62f, -0x1p62f}};
    for (uint32_t slot = 0; slot < 4; slot++)
        set_child(node, slot, &NOWHERE, CSG_TREE_LEAF);
}

typedef struct task {
    range r;
    uint32_t node;
} task;

/* A node leaves at most three more tasks than it takes, and depth is bounded by that of halving. */
enum { TASKS_MOST = 3 * (DEPTH_MOST + 32) + 4 };

static bool build_nodes(builder *b, const range *whole)
{
    enum { NODES_PER_QUESTION = 1024 };
    csg_tree *tree = b->tree;
    task tasks[TASKS_MOST];
    size_t left = 0;
    tasks[left++] = (task){*whole, 0};
    if (!add_node(tree))
        return false;
    while (left) {
        task t = tasks[--left];
        if (tree->node_count % NODES_PER_QUESTION == 0 && csg_memory_has_ended(tree->memory))
            return false;
        range parts[4];
        uint32_t count = split_to_four(b, &t.r, parts);
        clear_node(&tree->nodes[t.node]);
        for (uint32_t i = 0; i < count; i++) {
            bool is_leaf = parts[i].count <= LEAF_MOST;
            uint32_t child =
                is_leaf ? CSG_TREE_LEAF | (uint32_t)tree->leaf_count : (uint32_t)tree->node_count;
            if (!(is_leaf ? add_leaf(tree, &parts[i]) : add_node(tree)))
                return false;
            if (!is_leaf)
                tasks[left++] = (task){parts[i], child};
            set_child(&tree->nodes[t.node], i, &parts[i].box, child);
        }
    }
    return true;
}

/* ---- triangles --------------------------------------------------------------------------------
 */

/* Thinner than 2^-26 of its longest side. */
static bool is_needle(const csg_tree_triangle *t)
{
    csg_vec3 bc = csg_vec3_sub(t->ac, t->ab), normal = csg_vec3_cross(t->ab, t->ac);
    double longest =
        fmax(csg_vec3_dot(bc, bc), fmax(csg_vec3_dot(t->ab, t->ab), csg_vec3_dot(t->ac, t->ac)));
    return !(csg_vec3_dot(normal, normal) > 0x1p-52 * longest * longest);
}

static csg_vec3 longest_side(const csg_tree_triangle *t)
{
    csg_vec3 bc = csg_vec3_sub(t->ac, t->ab), side = t->ab;
    side = csg_vec3_dot(t->ac, t->ac) > csg_vec3_dot(side, side) ? t->ac : side;
    return csg_vec3_dot(bc, bc) > csg_vec3_dot(side, side) ? bc : side;
}

/* Axes at right angles. Those across a needle may be any: it has no width in them. */
static void find_axes(const csg_tree_triangle *t, csg_vec3 axis[3])
{
    axis[0] = csg_vec3_normalize(longest_side(t));
    csg_vec3 normal = csg_vec3_cross(t->ab, t->ac);
    if (t->is_needle) {
        bool is_x = fabs(axis[0].x) > 0.7;
        normal = csg_vec3_cross(axis[0], csg_vec3_make(is_x ? 0 : 1, is_x ? 1 : 0, 0));
    }
    axis[2] = csg_vec3_normalize(normal);
    axis[1] = csg_vec3_cross(axis[2], axis[0]);
}

static void set_rectangle(csg_tree_leaf *leaf, uint32_t slot, const csg_tree_triangle *t)
{
    csg_vec3 axis[3], center = t->a;
    find_axes(t, axis);
    for (int e = 0; e < 2; e++) {
        double b = csg_vec3_dot(axis[e], t->ab), c = csg_vec3_dot(axis[e], t->ac);
        double low = fmin(0, fmin(b, c)), high = fmax(0, fmax(b, c));
        center = csg_vec3_add(center, csg_vec3_scale(axis[e], 0.5 * (low + high)));
        leaf->half[e][slot] = (float)(0.5 * (high - low)) * 1.000001f;
    }
    for (int e = 0; e < 3; e++) {
        leaf->axis[e][0][slot] = (float)axis[e].x;
        leaf->axis[e][1][slot] = (float)axis[e].y;
        leaf->axis[e][2][slot] = (float)axis[e].z;
    }
    leaf->center[0][slot] = (float)center.x;
    leaf->center[1][slot] = (float)center.y;
    leaf->center[2][slot] = (float)center.z;
}

static void set_rectangles(csg_tree *tree)
{
    for (size_t i = 0; i < tree->leaf_count; i++) {
        csg_tree_leaf *leaf = &tree->leaves[i];
        for (uint32_t slot = 0; slot < leaf->count; slot++)
            set_rectangle(leaf, slot, &tree->triangles[leaf->first + slot]);
    }
}

static void place_triangles(builder *b, const csg_triangles *chain)
{
    csg_tree *tree = b->tree;
    tree->box = csg_box_empty();
    for (size_t i = 0; i < tree->count; i++) {
        const uint32_t *corners = chain->corners[b->items[i].index];
        csg_vec3 p = chain->points[corners[0]], q = chain->points[corners[1]],
                 r = chain->points[corners[2]];
        csg_tree_triangle *t = &tree->triangles[i];
        *t = (csg_tree_triangle){
            .a = p, .ab = csg_vec3_sub(q, p), .ac = csg_vec3_sub(r, p), .index = b->items[i].index};
        t->is_needle = is_needle(t);
        csg_box_extend(&tree->box, p);
        csg_box_extend(&tree->box, q);
        csg_box_extend(&tree->box, r);
    }
}

static void fill_items(const csg_triangles *chain, item *items)
{
    for (size_t t = 0; t < chain->count; t++) {
        items[t] = (item){NOTHING, (uint32_t)t};
        for (int k = 0; k < 3; k++) {
            csg_vec3 p = chain->points[chain->corners[t][k]];
            bounds at = {{(float)p.x, (float)p.y, (float)p.z},
                         {(float)p.x, (float)p.y, (float)p.z}};
            extend(&items[t].box, &at);
        }
    }
}

bool csg_tree_make(csg_memory *memory, csg_arena *scratch, const csg_triangles *chain,
                   csg_tree *out)
{
    *out = (csg_tree){.memory = memory, .count = chain->count};
    csg_arena_mark mark = csg_arena_get_mark(scratch);
    builder b = {out, csg_arena_alloc(scratch, chain->count * sizeof *b.items)};
    out->triangles = csg_memory_alloc(memory, chain->count * sizeof *out->triangles);
    if (b.items && out->triangles) {
        fill_items(chain, b.items);
        range whole = {0, (uint32_t)chain->count, 0, bounds_of(b.items, chain->count)};
        if (build_nodes(&b, &whole)) {
            place_triangles(&b, chain);
            set_rectangles(out);
            csg_arena_release_to(scratch, mark);
            return true;
        }
    }
    csg_tree_release(out);
    return false;
}

void csg_tree_release(csg_tree *tree)
{
    csg_memory_release(tree->memory, tree->nodes, tree->node_capacity * sizeof *tree->nodes);
    csg_memory_release(tree->memory, tree->leaves, tree->leaf_capacity * sizeof *tree->leaves);
    csg_memory_release(tree->memory, tree->triangles, tree->count * sizeof *tree->triangles);
    tree->nodes = NULL;
    tree->leaves = NULL;
    tree->triangles = NULL;
}

void csg_tree_turn(csg_tree *tree, size_t place)
{
    csg_tree_triangle *t = &tree->triangles[place];
    csg_vec3 ab = t->ab;
    t->ab = t->ac;
    t->ac = ab;
}
