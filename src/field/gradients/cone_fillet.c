/* SPDX-License-Identifier: MIT
 * Turns of a fillet's operands; see cone_fillet.h.
 *
 * The gradient of F for two operands is a convex combination of theirs plus dF/dc grad c, c =
 * g_1 . g_2, which is 0 for planes. With d = 1 - c, |dF/dc| = (r^2 - x^2 / d^2) / (2 sqrt((2 - d)
 * (2 r^2 - x^2 / d))) and |grad c| <= (k_1 + k_2) sqrt(d (2 - d)), k the largest curvature of a field:
 * the product grows with d and falls with the difference x of the operands. Where a primitive's
 * gradient turns by a chord of s within rho, it turns no faster than s / (rho (1 - s)) there
 * (cone_ball.h, "turning").
 */
#include "field/gradients/cone_fillet.h"

#include <math.h>

#include "field/gradients/cone_leaf.h"
#include "scene/operators/fillet.h"

enum { MOST_OPERANDS = 8 };

static const csg_fillet_turns any_turn = {0, 2};

/* Then cones of gradients, which are the scene's, say nothing of its angles. */
static bool is_skewed(const csg_tape *tape, const csg_tape_node *node)
{
    return tape->parameters[node->parameters + CSG_FILLET_IS_SKEWED] > 0;
}

/* A unit vector within `spread` of `at`. */
static bool unit_ball(const csg_cone_ball *ball, csg_cone_ball *out)
{
    static const double ROUNDING = 1e-5;
    double length =
        sqrt(ball->at[0] * ball->at[0] + ball->at[1] * ball->at[1] + ball->at[2] * ball->at[2]);
    if (!(length > 1e-6) || !(ball->spread < length))
        return false;
    for (int k = 0; k < 3; k++)
        out->at[k] = ball->at[k] / length;
    out->spread = 2 * ball->spread / length + ROUNDING;
    return true;
}

/* 1 - cos between vectors of the two. */
static csg_fillet_turns between(const csg_cone_ball *a, const csg_cone_ball *b)
{
    double square = 0;
    for (int k = 0; k < 3; k++)
        square += (a->at[k] - b->at[k]) * (a->at[k] - b->at[k]);
    double chord = sqrt(square), room = a->spread + b->spread;
    double least = fmax(chord - room, 0), most = fmin(chord + room, 2);
    return (csg_fillet_turns){(float)(least * least / 2), (float)(most * most / 2)};
}

/* One leaf's gradients. */
typedef struct turning {
    csg_cone_balls balls;
    bool is_joined; /* combinations of the balls' vectors, of unit length again, are among them */
} turning;

static bool find_turning(const csg_tape *tape, const csg_tape_node *leaf, const float c[3],
                         double radius, turning *out)
{
    out->balls.count = 0;
    out->balls.has_edges = false;
    if (!csg_op_is_leaf(leaf->op) || !csg_cone_add_leaf(&out->balls, tape, leaf, c, radius) ||
        !out->balls.count)
        return false;
    out->is_joined = out->balls.count > 1;
    for (uint32_t i = 0; i < out->balls.count; i++)
        if (!unit_ball(&out->balls.items[i], &out->balls.items[i]))
            return false;
    return true;
}

/* Between faces of one leaf, gradients are combinations w_1 n_1 + ... of unit length, w >= 0: their
 * products with another vector are at least the least of the faces', or where that is below 0,
 * sqrt(3) times that. */
static csg_fillet_turns turn_between(const turning *a, const turning *b)
{
    csg_fillet_turns all = {2, 0};
    for (uint32_t i = 0; i < a->balls.count; i++)
        for (uint32_t k = 0; k < b->balls.count; k++) {
            csg_fillet_turns one = between(&a->balls.items[i], &b->balls.items[k]);
            all.least = fminf(all.least, one.least);
            all.most = fmaxf(all.most, one.most);
        }
    if (!a->is_joined && !b->is_joined)
        return all;
    bool both = a->is_joined && b->is_joined;
    float beyond = both ? 3.0f : 1.7320509f;
    all.most = all.most > 1 ? fminf(1 + beyond * (all.most - 1), 2) : all.most;
    all.least = 0; /* a combination may be anything between */
    return all;
}

csg_fillet_turns csg_fillet_find_turns(const csg_tape *tape, const csg_tape_node *node,
                                       const float c[3], double radius)
{
    turning found[MOST_OPERANDS];
    uint32_t count = node->arity - node->planes;
    const csg_tape_node *child = node - 1 - node->planes;
    csg_fillet_turns all = {2, 0};
    if (count > MOST_OPERANDS || is_skewed(tape, node))
        return any_turn;
    for (uint32_t k = 0; k < count; k++, child -= child->size) {
        if (!find_turning(tape, child, c, radius, &found[k]))
            return any_turn;
        for (uint32_t i = 0; i < k; i++) {
            csg_fillet_turns one = turn_between(&found[i], &found[k]);
            all.least = fminf(all.least, one.least);
            all.most = fmaxf(all.most, one.most);
        }
    }
    return count > 1 ? all : any_turn;
}

/* Largest curvature of the leaf's field in the ball. False: none is known. */
static bool find_bend(const csg_tape *tape, const csg_tape_node *leaf, const float c[3],
                      double radius, double *bend)
{
    csg_cone_balls balls = {.count = 0};
    bool turns = csg_op_is_primitive(leaf->op) && !csg_op_has(leaf->op, CSG_TRAIT_CURVE);
    if (!turns || leaf->warp || !csg_cone_add_leaf(&balls, tape, leaf, c, radius) ||
        balls.count != 1)
        return false;
    const double *g = balls.items[0].at;
    double length = sqrt(g[0] * g[0] + g[1] * g[1] + g[2] * g[2]);
    if (!(balls.items[0].spread < length))
        return false;
    double s = balls.items[0].spread / length; /* of unit vectors */
    *bend = s / (radius * (1 - s));
    return true;
}

bool csg_fillet_find_stray(const csg_tape *tape, const csg_tape_node *node, const float c[3],
                           double radius, double apart, double *stray)
{
    const csg_tape_node *child = node - 1 - node->planes;
    uint32_t count = node->arity - node->planes;
    double bends = 0, r = (double)tape->parameters[node->parameters + CSG_OPERATOR_N];
    if (is_skewed(tape, node))
        return false;
    for (uint32_t k = 0; k < count; k++, child -= child->size) {
        double bend;
        if (!csg_op_is_leaf(child->op) || !find_bend(tape, child, c, radius, &bend))
            return false;
        bends += bend;
    }
    double d = (double)csg_fillet_find_turns(tape, node, c, radius).most;
    double x = fmin(apart / r, d), part = 1 - (d > 0 ? x * x / (d * d) : 1);
    *stray =
        bends > 0 && part > 0 ? bends * r / 2 * sqrt(d / 2) * part / sqrt(1 - x * x / (2 * d)) : 0;
    return bends == 0 || (count == 2 && d < CSG_FILLET_FADE);
}
