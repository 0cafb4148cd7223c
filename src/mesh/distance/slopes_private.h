/* SPDX-License-Identifier: MIT
 * What the files of slopes share; see slopes.h.
 */
#ifndef CSG_MESH_DISTANCE_SLOPES_PRIVATE_H
#define CSG_MESH_DISTANCE_SLOPES_PRIVATE_H

#include "mesh/distance/slopes.h"

enum { CSG_SLOPES_CORNERS = 3 /* of a triangle */ };

/* What one operand can be in the region. */
typedef struct csg_slopes_operand {
    double value, doubt; /* at c; rounding */
    double low, high;    /* over the triangle */
    double least, most;  /* over the region, but for rounding */
    csg_cone_balls balls;
    double kink, sag; /* as in csg_gradients */
    double longest;   /* gradient */
    bool stretched;   /* shares may add up to more than 1, or corners' gradients are longer than
                         faces' */
    bool faces;       /* gradients between the balls may be as long as these: where faces meet */
} csg_slopes_operand;

/* The tape's nodes that are an operand. */
typedef struct csg_slopes_nodes {
    uint32_t first, end;
} csg_slopes_nodes;

typedef struct csg_slopes_walker {
    const csg_kernel *kernel;
    const csg_tape *tape;
    csg_gradients_region region;
    csg_vec3 normal;     /* of the triangle */
    double radius, flat; /* of the ball around c that holds the region; the triangle */
    const float *values; /* of node number i from i times the stride on, at so many places */
    size_t stride;
    uint32_t places; /* the triangle's corners, but where these are all c, and c */
    float *scratch;
    size_t scratch_floats;
    csg_slopes_operand stack[CSG_SLOPES_NODES];
    csg_slopes_nodes nodes[CSG_SLOPES_NODES]; /* of each operand on the stack */
    uint32_t top;
    csg_slopes_operand level; /* the field's gradients where it is zero, if has_level */
    bool has_level;
} csg_slopes_walker;

typedef struct csg_slopes_range {
    double low, high;
} csg_slopes_range;

/* Which of an operand's values. */
typedef enum csg_slopes_which {
    CSG_SLOPES_MIDDLE,
    CSG_SLOPES_LOW,
    CSG_SLOPES_HIGH,
    CSG_SLOPES_LEAST,
    CSG_SLOPES_MOST
} csg_slopes_which;

double csg_slopes_value(const csg_slopes_operand *o, csg_slopes_which what);
/* By how much the difference of two operands can change within the region. Between faces' normals a
 * unit vector is at most 1 / cos(phi / 4) as far from any other as one of these, where they are phi
 * apart: at most sqrt(2), for a disc without thickness. */
double csg_slopes_change(const csg_slopes_walker *w, const csg_slopes_operand *a,
                         const csg_slopes_operand *b);
/* The same of their sum. */
double csg_slopes_change_of_sum(const csg_slopes_walker *w, const csg_slopes_operand *a,
                                const csg_slopes_operand *b);
/* Whether two on the stack add up to a constant wherever the tape holds. */
bool csg_slopes_are_opposite(const csg_slopes_walker *w, const csg_slopes_operand *a,
                             const csg_slopes_operand *b);
/* As csg_slopes_change(), from c, with rounding. */
double csg_slopes_reach(const csg_slopes_walker *w, const csg_slopes_operand *a,
                        const csg_slopes_operand *b);
/* a becomes the mixture with b, in any of the shares of a; the value is the caller's. Where both
 * have a share, so is kink: it is INFINITY. False: no bound is known. */
bool csg_slopes_mix(csg_slopes_operand *a, const csg_slopes_operand *b, csg_slopes_range share,
                    bool is_sharp);
/* A leaf, on top of the stack. */
bool csg_slopes_push_leaf(csg_slopes_walker *w, const csg_tape_node *node);
/* Of a round operator, whose operands are on the stack. False: no bound is known. */
bool csg_slopes_join_round(csg_slopes_walker *w, const csg_tape_node *node);
/* Of a fillet, whose operands, planes last, are on the stack. False: no bound is known. */
bool csg_slopes_join_fillet(csg_slopes_walker *w, const csg_tape_node *node);
/* A rule, of the two operands on top of the stack: lengths, or fields. False: no bound is known. */
bool csg_slopes_join_rule(csg_slopes_walker *w, const csg_tape_node *node);
/* What a soft node, or an operator on fields, makes of the operand on top. */
void csg_slopes_deliver(csg_slopes_walker *w, const csg_tape_node *node);
/* Of a formula of its operands, which are on the stack. False: as above. */
bool csg_slopes_combine(csg_slopes_walker *w, const csg_tape_node *node);

/* A ball around all gradients, around the axis that they have in common. False: none is known. */
bool csg_slopes_enclose_around(const csg_cone_balls *balls, const csg_cone *axis, double longest,
                               csg_cone_ball *out);
/* The same of any; false also where they have no axis in common. */
bool csg_slopes_enclose(const csg_cone_balls *balls, double longest, csg_cone_ball *out);
/* One around the balls, and so around their hull. */
csg_cone_ball csg_slopes_ball_around(const csg_cone_balls *balls);
/* Combinations of the balls' vectors, none longer than that: their weights add up to no more.
 * INFINITY: not known. */
double csg_slopes_weight(const csg_cone_balls *balls, double longest);
/* Whether gradients need not be in the hull of the balls. */
static inline bool csg_slopes_exceed_hull(const csg_slopes_operand *o)
{
    return o->stretched || o->faces || o->balls.has_edges;
}
static inline double csg_slopes_balls_apart(const csg_cone_ball *a, const csg_cone_ball *b)
{
    const double d[3] = {a->at[0] - b->at[0], a->at[1] - b->at[1], a->at[2] - b->at[2]};
    return csg_norm3(d) + a->spread + b->spread;
}

/* How far gradients in the hulls of two sets can be from each other. */
double csg_slopes_sets_apart(const csg_cone_balls *a, const csg_cone_balls *b);

/* How far apart the differences of two operands can be at any two corners of the triangle. */
double csg_slopes_parting(const csg_slopes_walker *w, const csg_slopes_operand *a,
                          const csg_slopes_operand *b);
/* How much an operand can change from c within the region. */
double csg_slopes_span(const csg_slopes_walker *w, const csg_slopes_operand *o);
/* The value at c of what a node is the root of. */
double csg_slopes_value_of_node(const csg_slopes_walker *w, const csg_tape_node *node);

#endif
