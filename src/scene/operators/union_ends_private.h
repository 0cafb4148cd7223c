/* SPDX-License-Identifier: MIT
 * What the search of a union's ends is made of (union_ends.c): which ends there may be
 * (union_normals.c) and how far the operands reach towards each (union_reaches.c).
 */
#ifndef CSG_SCENE_UNION_ENDS_PRIVATE_H
#define CSG_SCENE_UNION_ENDS_PRIVATE_H

#include "scene/operators/union_ends.h"

enum {
    CSG_END_SIDES = 6, /* both of each axis: +x, -x, +y, ... */
    CSG_END_MOST_AXES = 8
};

/* What is nearer than this share to an end lies at it. */
#define CSG_AT_END 1e-9
static inline double csg_near_end(double at)
{
    return CSG_AT_END * (1 + fabs(at));
}

/* How far a node reaches along a normal or off an axis, and whether a face of it is there: a plane
 * one, or a cylinder's around the axis. */
typedef struct csg_end_reach {
    double at;
    bool has_face;
} csg_end_reach;

/* What is known of a union whose ends were found; of each side of its box. */
typedef struct csg_sides {
    double over[CSG_END_SIDES]; /* how far it may lie beyond it */
    bool has_face[CSG_END_SIDES];
} csg_sides;

typedef struct csg_end_search {
    const csgm_scene *scene;
    csg_arena *scratch;
    csg_node_id root;  /* the union */
    csg_node_id *seen; /* it and what is looked at below it, parents before children */
    size_t seen_count;
    /* per node; filled in for those seen */
    csg_affine *to_own; /* from the union's frame */
    bool *is_placed;    /* to_own is known: no warp stands between */
    csg_vec3 *normals;
    csg_end_reach *reaches;
    /* per node, from the leaves up */
    bool *is_loose;    /* its box may be too small */
    uint32_t *settled; /* 1 + its place among `sides` */
    csg_sides *sides;
    size_t sides_count;
    /* those found: the union's own axes come first, those of shapes' faces last */
    csg_vec3 *found;
    size_t found_count, found_capacity, axes_count; /* the latter: not of shapes' faces */
    csg_fillet_end axes[CSG_END_MOST_AXES];
    size_t axis_count;
    /* of the union at hand */
    csg_fillet_end *made;
    double *reached, *flush;
    size_t made_capacity, reached_capacity, flush_capacity;
} csg_end_search;

/* A union that a blend makes larger reaches as far as its box: who asks sees no farther. */
static inline bool csg_union_adds(const csg_node *node)
{
    return node->kind == CSG_NODE_UNION && !csg_blend_is_sharp(node->blend);
}

/* The farther one, and whether one that is as far has a face. */
csg_end_reach csg_farther_end_reach(csg_end_reach a, csg_end_reach b);
double csg_box_reach(csg_box box, csg_vec3 n);

/* Fills in found, to_own and is_placed. False: no memory. */
bool csg_end_find_normals(csg_end_search *s);
/* Fills in axes; after the normals. */
void csg_end_find_axes(csg_end_search *s);
/* Whether the node is turned about that axis; *scale: of its lengths in the union's frame. */
bool csg_end_is_about(const csg_end_search *s, size_t i, const csg_fillet_end *axis, double *scale);
/* Of a primitive that is: whether its side is a face about its axis. */
bool csg_end_has_side(const csg_node *node);

/* Fill in reaches: along a normal of the union's frame, and off an axis in it. */
void csg_end_find_reaches(csg_end_search *s, csg_vec3 n);
void csg_end_find_off(csg_end_search *s, const csg_fillet_end *axis);

#endif
