/* SPDX-License-Identifier: MIT
 * The segments of an outline in a tree of boxes: nearest segment, and winding number of a point.
 *
 * Segments stand in the order of the outline, four to a leaf, four to a node: what follows one
 * another along a loop lies together, so nothing needs sorting but the loops themselves (along a
 * Z-order curve). A grid of cells knows for each cell the leaf nearest to its centre; it gives a
 * search its first bound, which is nearly the last one.
 */
#ifndef CSG_SHAPE_REGION_TREE_H
#define CSG_SHAPE_REGION_TREE_H

#include "shape/plane/outline.h"

enum { CSG_SEGMENT_LANES = 4 };

/* From a along the unit vector u; the inside is on the left. Spare lanes repeat the last one. */
typedef struct csg_segment_leaf {
    double ax[CSG_SEGMENT_LANES], ay[CSG_SEGMENT_LANES];
    double ux[CSG_SEGMENT_LANES], uy[CSG_SEGMENT_LANES];
    double length[CSG_SEGMENT_LANES];
} csg_segment_leaf;

typedef struct csg_segment_node {
    double x0[CSG_SEGMENT_LANES], y0[CSG_SEGMENT_LANES]; /* spare lanes: an empty box */
    double x1[CSG_SEGMENT_LANES], y1[CSG_SEGMENT_LANES];
    uint32_t child[CSG_SEGMENT_LANES]; /* a node, or a leaf + CSG_SEGMENT_LEAF */
} csg_segment_node;

#define CSG_SEGMENT_LEAF 0x80000000u

typedef struct csg_segment_end {
    csg_vec2 from, to;            /* as in the outline, to the bit */
    uint32_t previous, following; /* segments before and after it in its loop */
} csg_segment_end;

typedef struct csg_segment_tree {
    csg_memory *memory;
    csg_segment_leaf *leaves;
    csg_segment_node *nodes; /* the root last */
    csg_segment_end *ends;   /* per segment */
    uint32_t *nearest_leaf;  /* per cell */
    size_t segment_count, leaf_count, node_count;
    size_t segment_capacity, node_capacity, cell_capacity;
    uint32_t cells_x, cells_y;
    double left, bottom, per_x, per_y; /* cells a length */
    double room; /* added to squared distances of boxes: CSG_SEGMENT_BOX_SHARE */
    csg_box box;
} csg_segment_tree;

/* A box is nearer than a segment in it by more than the rounding of both: its squared distance
 * times this, less `room`. Else who asks a list of leaves, without boxes, would find another
 * segment than who asks the tree. Rounding is relative to the distance and the segment's length, d
 * + l, of squares (d + l)^2 2^-50; 2 d l 2^-50 <= d^2 2^-40 + l^2 2^-60. */
#define CSG_SEGMENT_BOX_SHARE (1 - 0x1p-40)

typedef struct csg_segment_hit {
    double squared;   /* distance */
    uint32_t segment; /* of several that are as near, always the same one */
} csg_segment_hit;

/* Coordinates are finite and below 1e150. False: out of memory. */
bool csg_segment_tree_init(csg_segment_tree *tree, csg_memory *memory, const csg_outline *outline);
void csg_segment_tree_release(csg_segment_tree *tree);

/* x, y finite; at least one segment. */
csg_segment_hit csg_segment_nearest(const csg_segment_tree *tree, double x, double y);

/* Leaves and nodes of the tree, as csg_segment_node.child has them, in the order of their segments.
 */
typedef struct csg_segment_list {
    const uint32_t *items;
    uint32_t count;
} csg_segment_list;

/* What of a list (count 0: of the tree) can be nearest to a point of the box, for points that are
 * within `reach` of it: up to `most` items, so that csg_segment_nearest_of finds for these points
 * what csg_segment_nearest does, to the bit. */
uint32_t csg_segment_narrow(const csg_segment_tree *tree, csg_segment_list among, csg_vec2 center,
                            csg_vec2 half, double reach, uint32_t *out, uint32_t most);
csg_segment_hit csg_segment_nearest_of(const csg_segment_tree *tree, csg_segment_list list,
                                       double x, double y);
/* Its parts, for searches of several points at once (region_lanes.c). A search begins with this
 * leaf, and what stands in it is found before what is as near elsewhere. */
uint32_t csg_segment_first_leaf(const csg_segment_tree *tree, double x, double y);
csg_segment_hit csg_segment_nearest_in_leaf(const csg_segment_tree *tree, uint32_t leaf, double x,
                                            double y);
/* How often the loops go around the point. A corner belongs to one of its segments only, so no
 * point sees it twice; between 2 ulp of a segment to either side the answer is that of one side. */
int csg_segment_winding(const csg_segment_tree *tree, double x, double y);

/* Segments that may come within `reach` of segment number `of` are given to `visit` until it says
 * false. */
typedef bool csg_segment_visit(void *user, uint32_t segment);
void csg_segment_around(const csg_segment_tree *tree, uint32_t of, double reach,
                        csg_segment_visit *visit, void *user);

/* Segments that come within `reach` of the point, and perhaps a few more; false as soon as `visit`
 * says so. */
bool csg_segment_within(const csg_segment_tree *tree, double x, double y, double reach,
                        csg_segment_visit *visit, void *user);

/* Position of the point along the segment and to its left. */
typedef struct csg_segment_place {
    double along, left, length;
} csg_segment_place;

static inline csg_segment_place csg_segment_locate(const csg_segment_tree *tree, uint32_t segment,
                                                   double x, double y)
{
    const csg_segment_leaf *leaf = &tree->leaves[segment / CSG_SEGMENT_LANES];
    uint32_t k = segment % CSG_SEGMENT_LANES;
    double px = x - leaf->ax[k], py = y - leaf->ay[k];
    return (csg_segment_place){.along = px * leaf->ux[k] + py * leaf->uy[k],
                               .left = leaf->ux[k] * py - leaf->uy[k] * px,
                               .length = leaf->length[k]};
}

#endif
