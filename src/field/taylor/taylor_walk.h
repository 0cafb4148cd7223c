/* SPDX-License-Identifier: MIT
 * A walk over a tape that makes Taylor models of it: a stack of operands, as the tape's own
 * evaluation has one. Where an operator is one of several smooth functions, as a blend that begins
 * in the ball, the walk takes one of them, says where that is the field, and the tape is walked
 * once for each: which one it takes is what its script says of that decision.
 */
#ifndef CSG_FIELD_TAYLOR_WALK_H
#define CSG_FIELD_TAYLOR_WALK_H

#include "field/tape.h"
#include "field/taylor/pieces.h"
#include "scene/primitives/smooth.h"

enum {
    CSG_TAYLOR_NODES = 24 /* of a tape; more are not looked at */,
    CSG_TAYLOR_DECISIONS = 4 /* of a walk */,
    CSG_TAYLOR_OPTIONS = 4 /* of a decision */
};

typedef struct csg_taylor_operand {
    csg_taylor f;
    uint32_t node; /* the last of its subtree */
    uint32_t leaf; /* where it is one alone */
    int way;       /* and of its formulas one (scene/primitives/smooth.h) */
    bool is_known, is_leaf;
    bool is_creased; /* its gradient may jump in the ball, from one piece to another */
} csg_taylor_operand;

/* One of a leaf's formulas, and where it holds. */
typedef struct csg_taylor_leaf {
    csg_taylor_operand operand;
    csg_taylor conditions[CSG_SMOOTH_CONDITIONS];
    int condition_count;
} csg_taylor_leaf;

typedef struct csg_taylor_walk {
    const csg_tape *tape;
    const double *c;
    double radius;
    bool has_fillets;
    bool signs[CSG_TAYLOR_NODES]; /* of each node: nothing but its sign matters */
    csg_taylor_leaf leaves[CSG_TAYLOR_NODES][CSG_SMOOTH_WAYS];
    int ways[CSG_TAYLOR_NODES]; /* of each leaf, as far as they are known */
    csg_taylor_operand stack[CSG_TAYLOR_NODES];
    uint32_t top;
    int script[CSG_TAYLOR_DECISIONS], options[CSG_TAYLOR_DECISIONS], decisions;
    csg_taylor_piece *piece; /* the one that is made */
    bool may_decide;
} csg_taylor_walk;

static inline double csg_taylor_walk_least(const csg_taylor_walk *w, const csg_taylor *a)
{
    return csg_taylor_least(a, w->radius);
}

static inline double csg_taylor_walk_most(const csg_taylor_walk *w, const csg_taylor *a)
{
    return csg_taylor_most(a, w->radius);
}

/* With its derivatives, if they are asked for. choice: NULL, or the formula that is asked for. */
bool csg_taylor_walk_leaf(const csg_taylor_walk *w, uint32_t leaf, bool with_slopes,
                          csg_smooth_choice *choice, csg_smooth *out);

/* How far the value of a leaf is off: by its parameters, and by the doubles that are computed with.
 */
double csg_taylor_walk_rounding(const csg_taylor_walk *w, uint32_t leaf);

/* One of the options that are possible somewhere in the ball, by the script if there are several;
 * -1: there is none, or no more decisions may be left open. */
int csg_taylor_walk_choose(csg_taylor_walk *w, const bool *possible, int count);

/* The piece that is made is the field only where this is not negative; off: by floats. */
void csg_taylor_walk_require(csg_taylor_walk *w, const csg_taylor *g, double off);

/* Two that are the same but for rounding, as flush faces are: how far apart, at most. INFINITY:
 * they are not. */
double csg_taylor_walk_apart(const csg_taylor_walk *w, const csg_taylor *d);

/* And their gradients, of third order at most, by no more than sixteen times that over the radius.
 */
void csg_taylor_walk_add_apart(const csg_taylor_walk *w, csg_taylor *f, double apart);

/* What a float makes of a blend's length, if the scene's is not known; values move by no more than
 * it does, gradients' shares by as much of themselves. */
double csg_taylor_walk_length_off(const csg_taylor_walk *w, double length);
void csg_taylor_walk_add_length(const csg_taylor_walk *w, double length, csg_taylor *f);

/* (a + b) / 2 + factor excess. */
csg_taylor csg_taylor_walk_mean(const csg_taylor *a, const csg_taylor *b, double factor,
                                const csg_taylor *excess);

/* Of f, some (a + b) / 2 + g(a - b), g having this slope at the centre: what a and b are off counts
 * by their shares, 1/2 +- slope, where sum and difference alone count both by the larger one. */
void csg_taylor_walk_share(const csg_taylor *a, const csg_taylor *b, double slope, csg_taylor *f);

/* The operators that take all their operands at once. False: the field is not known. */
bool csg_taylor_walk_round(csg_taylor_walk *w, const csg_tape_node *node);
bool csg_taylor_walk_fillet(csg_taylor_walk *w, const csg_tape_node *node, bool signs);

#endif
