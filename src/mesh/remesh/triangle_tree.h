/* SPDX-License-Identifier: MIT
 * A tree of boxes over the triangles of a mesh that is being changed, in the order of their
 * numbers. Marching cubes numbers them block by block in Morton order, and what replaces a triangle
 * lies where it was: so the tree stays good without being rebuilt, boxes are only filled in again.
 */
#ifndef CSG_MESH_REMESH_TRIANGLE_TREE_H
#define CSG_MESH_REMESH_TRIANGLE_TREE_H

#include "base/geometry.h"
#include "mesh/remesh/corners.h"

enum {
    CSG_TRIANGLES_A_LEAF = 4,
    CSG_TRIANGLE_TREE_STACK = 64 /* one child waits a level, and there are 31 at most */
};

typedef struct csg_triangle_box {
    float min[3], max[3]; /* rounded outwards; min > max: nothing there */
} csg_triangle_box;

/* Over places that may change; it tells of them as they are. */
typedef struct csg_triangle_tree {
    const csg_corners *corners;
    const csg_vec3 *at;
    csg_triangle_box *nodes; /* a heap: the children of i are 2 i and 2 i + 1 */
    uint32_t *facing;        /* per node: the directions along which all of its triangles face */
    size_t leaf_count;       /* a power of two */
    size_t node_capacity, facing_capacity;
    const uint32_t *items; /* its triangles, in order; NULL: all of them */
    const uint32_t *slots; /* where a triangle stands in items; NULL with these */
    uint32_t count;        /* of triangles */
    double noise;          /* of places, rounded to floats as vertices are */
} csg_triangle_tree;

/* That of a mesh with this longest side. */
static inline double csg_triangle_tree_noise(double extent)
{
    static const double ROUNDING = 1e-7;
    return ROUNDING * extent;
}

/* False: out of memory, nothing to release. */
bool csg_triangle_tree_make(csg_triangle_tree *tree, const csg_corners *corners,
                            const csg_vec3 *at);
/* Over some of the triangles of `whole`, in a tree that is {0} or was made before: its memory is
 * used again. Only those that slots tells of may change. False: out of memory; to be released. */
bool csg_triangle_tree_make_of(csg_triangle_tree *tree, const csg_triangle_tree *whole,
                               const csg_corners *corners, const uint32_t *items, uint32_t count,
                               const uint32_t *slots);
void csg_triangle_tree_release(csg_triangle_tree *tree);

/* Keeps nothing but where places and corners are, and the noise: nothing is found until it is made
 * again. */
void csg_triangle_tree_forget(csg_triangle_tree *tree);

/* After a triangle has changed, or is gone. */
void csg_triangle_tree_update(csg_triangle_tree *tree, uint32_t triangle);
void csg_triangle_tree_update_around(csg_triangle_tree *tree, uint32_t vertex);

/* The same of one that is still there, in less time: boxes do not get smaller, and directions do
 * not come back. */
void csg_triangle_tree_include(csg_triangle_tree *tree, uint32_t triangle);

/* Behind the last triangle of a leaf. */
static inline size_t csg_triangle_tree_end(const csg_triangle_tree *tree, size_t leaf)
{
    size_t end = (leaf + 1) * CSG_TRIANGLES_A_LEAF;
    return end < tree->count ? end : tree->count;
}
static inline uint32_t csg_triangle_tree_item(const csg_triangle_tree *tree, size_t i)
{
    return tree->items ? tree->items[i] : (uint32_t)i;
}

csg_triangle_box csg_triangle_box_nothing(void);
csg_triangle_box csg_triangle_box_of(const csg_vec3 triangle[3]);
csg_triangle_box csg_triangle_box_around(const csg_triangle_box *a, const csg_triangle_box *b);
static inline bool csg_triangle_boxes_overlap(const csg_triangle_box *a, const csg_triangle_box *b)
{
    return (a->min[0] <= b->max[0]) & (b->min[0] <= a->max[0]) & (a->min[1] <= b->max[1]) &
           (b->min[1] <= a->max[1]) & (a->min[2] <= b->max[2]) & (b->min[2] <= a->max[2]);
}
void csg_triangle_tree_corners(const csg_triangle_tree *tree, uint32_t triangle, csg_vec3 out[3]);

/* The distance of the nearest triangle, INFINITY where it is `most` or more. triangle may be NULL.
 * Any thread. */
double csg_triangle_tree_nearest(const csg_triangle_tree *tree, csg_vec3 at, double most,
                                 uint32_t *triangle);
/* Whether some triangle is nearer than `most`, without looking for the nearest. Any thread. *last:
 * of a caller that asks for places one beside the other, in the beginning 0; where it looks first.
 */
bool csg_triangle_tree_is_near(const csg_triangle_tree *tree, csg_vec3 at, double most,
                               size_t *last);

#endif
