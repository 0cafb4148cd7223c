/* SPDX-License-Identifier: MIT
 * Building the tree of segments; see region_tree.h. Searches: region_search.c.
 */
#include "shape/plane/region_tree.h"

#include <stdlib.h>

enum { LEAST_CELLS = 16, MOST_CELLS = 1 << 16, CELLS_PER_SEGMENT = 4 };

/* ---- order of the loops ------------------------------------------------------------------- */

typedef struct loop_key {
    uint32_t key, loop;
} loop_key;

static uint32_t spread(uint32_t bits) /* 16 bits to the even places */
{
    bits = (bits | bits << 8) & 0x00ff00ffu;
    bits = (bits | bits << 4) & 0x0f0f0f0fu;
    bits = (bits | bits << 2) & 0x33333333u;
    return (bits | bits << 1) & 0x55555555u;
}

static uint32_t quantize(double at, double low, double high)
{
    double part = high > low ? (at - low) / (high - low) : 0;
    return (uint32_t)(fmin(fmax(part, 0), 1) * 65535);
}

/* Z-order of the loops' first points: loops are small, or few. */
static void make_keys(loop_key *keys, const csg_outline *outline, csg_box box)
{
    for (size_t loop = 0; loop < outline->loop_count; loop++) {
        csg_vec2 p = outline->points[csg_outline_first(outline, loop)];
        keys[loop] = (loop_key){spread(quantize(p.x, box.min.x, box.max.x)) |
                                    spread(quantize(p.y, box.min.y, box.max.y)) << 1,
                                (uint32_t)loop};
    }
}

static int compare_keys(const void *left, const void *right)
{
    const loop_key *a = left, *b = right;
    return a->key != b->key ? (a->key > b->key) - (a->key < b->key)
                            : (a->loop > b->loop) - (a->loop < b->loop);
}

/* ---- segments ----------------------------------------------------------------------------- */

static double length_of(csg_vec2 a, csg_vec2 b)
{
    double x = b.x - a.x, y = b.y - a.y;
    return sqrt(x * x + y * y);
}

static void set_lane(csg_segment_tree *tree, size_t slot, csg_vec2 a, csg_vec2 b)
{
    csg_segment_leaf *leaf = &tree->leaves[slot / CSG_SEGMENT_LANES];
    size_t k = slot % CSG_SEGMENT_LANES;
    double length = length_of(a, b);
    leaf->ax[k] = a.x;
    leaf->ay[k] = a.y;
    leaf->ux[k] = (b.x - a.x) / length;
    leaf->uy[k] = (b.y - a.y) / length;
    leaf->length[k] = length;
}

/* Segments too short to have a direction are left out: their ends are one point. */
static void add_loop(csg_segment_tree *tree, const csg_outline *outline, size_t loop)
{
    size_t first = csg_outline_first(outline, loop), end = outline->ends[loop];
    size_t begin = tree->segment_count;
    csg_vec2 from = outline->points[first];
    for (size_t i = first + 1; i <= end; i++) {
        csg_vec2 to = outline->points[i < end ? i : first];
        if (!(length_of(from, to) > 1e-150))
            continue;
        size_t slot = tree->segment_count++;
        tree->ends[slot] = (csg_segment_end){from, to, (uint32_t)slot - 1, (uint32_t)slot + 1};
        set_lane(tree, slot, from, to);
        from = to;
    }
    if (tree->segment_count > begin) {
        tree->ends[begin].previous = (uint32_t)tree->segment_count - 1;
        tree->ends[tree->segment_count - 1].following = (uint32_t)begin;
    }
}

static void fill_spare_lanes(csg_segment_tree *tree)
{
    size_t last = tree->segment_count - 1;
    tree->leaf_count = last / CSG_SEGMENT_LANES + 1;
    for (size_t slot = last + 1; slot < tree->leaf_count * CSG_SEGMENT_LANES; slot++)
        set_lane(tree, slot, tree->ends[last].from, tree->ends[last].to);
}

/* ---- nodes -------------------------------------------------------------------------------- */

static csg_box leaf_box(const csg_segment_tree *tree, size_t leaf)
{
    csg_box box = csg_box_empty();
    for (size_t slot = leaf * CSG_SEGMENT_LANES;
         slot < tree->segment_count && slot < (leaf + 1) * CSG_SEGMENT_LANES; slot++) {
        csg_vec2 a = tree->ends[slot].from, b = tree->ends[slot].to;
        box = csg_box_hull(box, (csg_box){{fmin(a.x, b.x), fmin(a.y, b.y), 0},
                                          {fmax(a.x, b.x), fmax(a.y, b.y), 0}});
    }
    return box;
}

static csg_box node_box(const csg_segment_node *node)
{
    csg_box box = csg_box_empty();
    for (int k = 0; k < CSG_SEGMENT_LANES; k++)
        box = csg_box_hull(box,
                           (csg_box){{node->x0[k], node->y0[k], 0}, {node->x1[k], node->y1[k], 0}});
    return box;
}

/* A node above `count` things from number `first` on. */
static void add_node(csg_segment_tree *tree, size_t first, size_t count, bool are_leaves)
{
    csg_segment_node *node = &tree->nodes[tree->node_count++];
    for (size_t k = 0; k < CSG_SEGMENT_LANES; k++) {
        csg_box box = csg_box_empty();
        if (k < count)
            box = are_leaves ? leaf_box(tree, first + k) : node_box(&tree->nodes[first + k]);
        node->x0[k] = box.min.x;
        node->y0[k] = box.min.y;
        node->x1[k] = box.max.x;
        node->y1[k] = box.max.y;
        node->child[k] =
            (uint32_t)(first + (k < count ? k : 0)) | (are_leaves ? CSG_SEGMENT_LEAF : 0);
    }
}

static void add_level(csg_segment_tree *tree, size_t first, size_t count, bool are_leaves)
{
    for (size_t i = 0; i < count; i += CSG_SEGMENT_LANES) {
        size_t here = count - i < CSG_SEGMENT_LANES ? count - i : CSG_SEGMENT_LANES;
        add_node(tree, first + i, here, are_leaves);
    }
}

static void add_nodes(csg_segment_tree *tree)
{
    add_level(tree, 0, tree->leaf_count, true);
    for (size_t first = 0; tree->node_count - first > 1;) {
        size_t end = tree->node_count;
        add_level(tree, first, end - first, false);
        first = end;
    }
    tree->box = node_box(&tree->nodes[tree->node_count - 1]);
}

/* ---- cells -------------------------------------------------------------------------------- */

static void shape_cells(csg_segment_tree *tree, size_t cells)
{
    double width = tree->box.max.x - tree->box.min.x, height = tree->box.max.y - tree->box.min.y;
    double side = sqrt(width * height / (double)cells);
    tree->cells_x = side > 0 ? (uint32_t)fmin(fmax(width / side, 1), (double)cells) : 1;
    tree->cells_y = (uint32_t)(cells / tree->cells_x);
    tree->room = 0x1p-48 * (width * width + height * height);
    tree->left = tree->box.min.x;
    tree->bottom = tree->box.min.y;
    tree->per_x = width > 0 ? tree->cells_x / width : 0;
    tree->per_y = height > 0 ? tree->cells_y / height : 0;
}

/* Each search starts from what its neighbour found. */
static void fill_cells(csg_segment_tree *tree)
{
    for (size_t i = 0; i < (size_t)tree->cells_x * tree->cells_y; i++)
        tree->nearest_leaf[i] = 0;
    for (uint32_t j = 0; j < tree->cells_y; j++) {
        for (uint32_t i = 0; i < tree->cells_x; i++) {
            uint32_t *cell = &tree->nearest_leaf[(size_t)j * tree->cells_x + i];
            double x = tree->per_x > 0 ? tree->left + (i + 0.5) / tree->per_x : tree->left;
            double y = tree->per_y > 0 ? tree->bottom + (j + 0.5) / tree->per_y : tree->bottom;
            *cell = i ? cell[-1] : 0;
            *cell = csg_segment_nearest(tree, x, y).segment / CSG_SEGMENT_LANES;
        }
    }
}

/* ---- all ---------------------------------------------------------------------------------- */

static bool allocate(csg_segment_tree *tree, size_t segments)
{
    csg_memory *memory = tree->memory;
    size_t leaves = (segments + CSG_SEGMENT_LANES - 1) / CSG_SEGMENT_LANES;
    size_t cells = CELLS_PER_SEGMENT * segments;
    tree->segment_capacity = leaves * CSG_SEGMENT_LANES;
    tree->node_capacity = leaves / 3 + 34; /* a quarter, and a quarter of that, rounded up */
    tree->cell_capacity = cells > MOST_CELLS    ? MOST_CELLS
                          : cells < LEAST_CELLS ? LEAST_CELLS
                                                : cells;
    tree->leaves = csg_memory_alloc(memory, leaves * sizeof *tree->leaves);
    tree->ends = csg_memory_alloc(memory, tree->segment_capacity * sizeof *tree->ends);
    tree->nodes = csg_memory_alloc(memory, tree->node_capacity * sizeof *tree->nodes);
    tree->nearest_leaf = csg_memory_alloc(memory, tree->cell_capacity * sizeof *tree->nearest_leaf);
    return tree->leaves && tree->ends && tree->nodes && tree->nearest_leaf;
}

void csg_segment_tree_release(csg_segment_tree *tree)
{
    csg_memory *memory = tree->memory;
    size_t leaves = tree->segment_capacity / CSG_SEGMENT_LANES;
    csg_memory_release(memory, tree->leaves, leaves * sizeof *tree->leaves);
    csg_memory_release(memory, tree->ends, tree->segment_capacity * sizeof *tree->ends);
    csg_memory_release(memory, tree->nodes, tree->node_capacity * sizeof *tree->nodes);
    csg_memory_release(memory, tree->nearest_leaf,
                       tree->cell_capacity * sizeof *tree->nearest_leaf);
    *tree = (csg_segment_tree){.memory = memory};
}

static bool add_segments(csg_segment_tree *tree, const csg_outline *outline)
{
    size_t bytes = outline->loop_count * sizeof(loop_key);
    loop_key *keys = csg_memory_alloc(tree->memory, bytes);
    if (!keys)
        return false;
    make_keys(keys, outline, csg_outline_box(outline));
    qsort(keys, outline->loop_count, sizeof *keys, compare_keys);
    for (size_t i = 0; i < outline->loop_count; i++)
        add_loop(tree, outline, keys[i].loop);
    csg_memory_release(tree->memory, keys, bytes);
    return true;
}

bool csg_segment_tree_init(csg_segment_tree *tree, csg_memory *memory, const csg_outline *outline)
{
    *tree = (csg_segment_tree){.memory = memory, .box = csg_box_empty()};
    size_t segments = csg_outline_first(outline, outline->loop_count);
    if (!segments)
        return true;
    if (segments >= CSG_SEGMENT_LEAF || !allocate(tree, segments) || !add_segments(tree, outline)) {
        csg_segment_tree_release(tree);
        return false;
    }
    if (!tree->segment_count) { /* nothing but one point */
        csg_segment_tree_release(tree);
        return true;
    }
    fill_spare_lanes(tree);
    add_nodes(tree);
    shape_cells(tree, tree->cell_capacity);
    fill_cells(tree);
    return true;
}
