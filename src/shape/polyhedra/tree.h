/* SPDX-License-Identifier: MIT
 * A tree of boxes over a closed chain of triangles, four children per node: the nearest triangle,
 * and how often a ray crosses the chain. Both are functions of the point alone: the nearest is the
 * least by distance as computed, then by place, whatever was tried first; crossings are exact, by
 * determinants of integers with points on edges moved aside by less than anything (Edelsbrunner and
 * Muecke 1990).
 */
#ifndef CSG_SHAPE_TREE_H
#define CSG_SHAPE_TREE_H

#include "shape/polyhedra/frame.h"
#include "shape/polyhedra/triangles.h"

typedef struct csg_tree_triangle {
    csg_vec3 a, ab, ac; /* frame units; ab and ac are exact */
    uint32_t index;     /* in the chain */
    uint32_t is_needle; /* so thin that the plane is lost in rounding: its edges stand for it */
} csg_tree_triangle;

/* Up to four triangles that follow each other, and for each a rectangle in its plane that holds it:
 * what can be said of its distance in float, for four at once. Axes: along the triangle's longest
 * side, across it, and its normal; half: of the rectangle's sides. */
typedef struct csg_tree_leaf {
    float center[3][4], axis[3][3][4], half[2][4];
    uint32_t first, count;
} csg_tree_leaf;

typedef struct csg_tree_node {
    float low[3][4], high[3][4]; /* boxes of the children, wider by CSG_TREE_PAD */
    uint32_t children[4];        /* a node, or CSG_TREE_LEAF | leaf */
} csg_tree_node;

#define CSG_TREE_PAD 0x1p-22f
#define CSG_TREE_LEAF 0x80000000u

typedef struct csg_tree {
    csg_memory *memory;
    csg_tree_node *nodes; /* the root is the first */
    csg_tree_leaf *leaves;
    csg_tree_triangle *triangles;
    size_t node_count, node_capacity, leaf_count, leaf_capacity, count;
    csg_box box; /* without pad */
} csg_tree;

/* The chain is on the lattice and has at least one triangle. False: out of memory. */
bool csg_tree_make(csg_memory *memory, csg_arena *scratch, const csg_triangles *chain,
                   csg_tree *out);
void csg_tree_release(csg_tree *tree);
/* Turns a triangle over, by its place in the tree. */
void csg_tree_turn(csg_tree *tree, size_t place);

typedef struct csg_triangle_hit {
    double squared;  /* distance */
    uint32_t place;  /* in tree->triangles */
    uint32_t leaves; /* that were looked into: what the search cost */
} csg_triangle_hit;

/* p within 2^60 of the frame. hint: a place to begin with, any will do, a near one is quicker. */
csg_triangle_hit csg_tree_nearest(const csg_tree *tree, csg_vec3 p, uint32_t hint);
/* Parts of the tree: below nodes, or (CSG_TREE_LEAVES_ONLY) in the leaves right below; and the
 * squared distance beyond which nothing is looked for, infinite where everything is. */
typedef struct csg_tree_parts {
    const uint32_t *items;
    uint32_t count;
    double most;
} csg_tree_parts;

/* The same in parts of the tree. hint: in one of them, or CSG_TREE_NONE. The hit is of no triangle,
 * CSG_TREE_NONE, at distance `most` where none is as near. */
csg_triangle_hit csg_tree_nearest_of(const csg_tree *tree, const csg_tree_parts *parts, csg_vec3 p,
                                     uint32_t hint);
#define CSG_TREE_LEAVES_ONLY 0x80000000u
#define CSG_TREE_NONE UINT32_MAX

/* A box or rectangle is passed over only when its squared distance in float is above the best times
 * CSG_TREE_SLACK (tree_nearest.c says why); csg_tree_error: more than positions near a point, and
 * their products with unit vectors, are off in float. */
#define CSG_TREE_SLACK (1 + 0x1p-18f)
static inline float csg_tree_error(float x, float y, float z)
{
    return 0x1p-20f * (1 + fabsf(x) + fabsf(y) + fabsf(z));
}

/* Edge k runs from corner k to the next one. */
typedef enum csg_triangle_part {
    CSG_PART_EDGE_0,
    CSG_PART_EDGE_1,
    CSG_PART_EDGE_2,
    CSG_PART_FACE,
    CSG_PART_CORNER
} csg_triangle_part;

/* The point of a triangle that is nearest to p. */
csg_vec3 csg_triangle_foot(const csg_tree_triangle *triangle, csg_vec3 p, bool *in_face);
/* The squared distance to it. */
double csg_triangle_squared(const csg_tree_triangle *triangle, csg_vec3 p);
/* The foot, and where in the triangle it is. */
csg_vec3 csg_triangle_locate(const csg_tree_triangle *triangle, csg_vec3 p,
                             csg_triangle_part *part);

/* At most `most` parts in which all is that comes within `reach` of the box: of those given (NULL:
 * of the whole tree), at most as many. Returns their number. */
uint32_t csg_tree_narrow(const csg_tree *tree, const uint32_t *among, uint32_t among_count,
                         csg_vec3 center, csg_vec3 half, double reach, uint32_t *out,
                         uint32_t most);

/* Triangles that come within `reach` of p, and perhaps a few more; false as soon as `visit` says
 * so. */
typedef bool csg_tree_visit(void *user, uint32_t place);
bool csg_tree_within(const csg_tree *tree, csg_vec3 p, double reach, csg_tree_visit *visit,
                     void *user);

/* Triangles of leaves that meet the box (frame units): all that meet it, and a few more; false as
 * soon as `visit` says so. */
bool csg_tree_in_box(const csg_tree *tree, csg_box box, csg_tree_visit *visit, void *user);

/* Whether the winding number is 1 behind the middle of a triangle and 0 before it, right beside it.
 */
bool csg_tree_is_clear(const csg_tree *tree, uint32_t place);
/* Which triangles of the group at `first`, a multiple of CSG_TREE_GROUP, are plain, a bit each:
 * they neither cross nor touch others but where they share corners, are no needles and are clear.
 * beside: per place, along each edge, the place of the other of its two triangles, or
 * CSG_TREE_NONE. */
enum { CSG_TREE_GROUP = 16 };
uint32_t csg_tree_plain_group(const csg_tree *tree, uint32_t (*beside)[3], uint32_t first);

/* Chooses which triangles count; NULL: all. */
typedef struct csg_tree_filter {
    const uint32_t *pieces; /* per triangle of the chain */
    const bool *turned;     /* per piece: counts as if turned over */
    uint32_t without;       /* a piece that does not count */
} csg_tree_filter;

/* Winding number of a point on the lattice, in the box. */
int csg_tree_winding(const csg_tree *tree, csg_vec3 p, const csg_tree_filter *filter);
/* Winding at p less winding at q, which differ in x only. */
int csg_tree_winding_step(const csg_tree *tree, csg_vec3 p, csg_vec3 q);
/* Of the line through (y, z) along x: where it crosses the chain, in any order, with the sign by
 * which the winding number falls there in the direction of x. Points on the lattice. */
typedef void csg_tree_crossing_fn(void *user, double x, int sign);
void csg_tree_line_crossings(const csg_tree *tree, double y, double z, csg_tree_crossing_fn *take,
                             void *user);

/* Whether a triangle, of which these are the coordinates along an axis, is beside that range. */
static inline bool csg_tree_is_outside(double a, double b, double c, double low, double high)
{
    return (a < low && b < low && c < low) || (a > high && b > high && c > high);
}

#endif
