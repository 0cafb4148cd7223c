/* SPDX-License-Identifier: MIT
 * Leaves: what their gradients and values are in the region; see slopes.h.
 */
#include <math.h>

#include "field/point.h"
#include "mesh/distance/slopes_private.h"

typedef csg_slopes_operand operand;
typedef csg_slopes_walker walker;

/* Signed distances to convex sets, and 1 - d of a gauge d, are concave, wherever they are asked;
 * not through a warp. */
static bool is_concave(const csg_tape_node *leaf)
{
    return !leaf->warp && csg_op_has(leaf->op, CSG_TRAIT_CONVEX);
}

/* Of a leaf at a corner, or at c behind them. */
static double leaf_value(const walker *w, const csg_tape_node *leaf, uint32_t place)
{
    size_t at = (size_t)(leaf - w->tape->nodes) * w->stride;
    return (double)w->values[at + (place < w->places ? place : w->places - 1)];
}

/* Whether it is a gradient that the leaf has, as far as is known. On a face, to rounding, the
 * kernel's points anywhere. */
static bool is_one_of(const csg_cone_balls *balls, csg_vec3 g)
{
    static const double ROUNDING = 1e-3;
    bool any = false;
    for (uint32_t i = 0; i < balls->count; i++) {
        const csg_cone_ball *ball = &balls->items[i];
        csg_vec3 off = {g.x - ball->at[0], g.y - ball->at[1], g.z - ball->at[2]};
        any |= csg_vec3_norm(off) <= ball->spread + ROUNDING;
    }
    return any;
}

/* The largest value over the triangle, by the tangent plane at the centre, of a concave leaf; of a
 * convex one, which is turned around, the least. Infinite where that is no tangent plane: so near
 * to a face that rounding tells its direction, or with a corner on its other side. */
static double tangent_value(const walker *w, const csg_tape_node *node, const operand *leaf,
                            double turn)
{
    static const double FAR = 1e3; /* of the rounding of a value */
    csg_tape_node alone = *node;
    csg_tape tape = *w->tape;
    alone.join = CSG_JOIN_NONE;
    tape.nodes = &alone;
    tape.count = 1;
    const csg_gradients_region *r = &w->region;
    csg_vec3 slope = csg_tape_gradient_at(w->kernel, &tape, r->c, w->scratch, w->scratch_floats);
    double from_face = leaf->value - (double)w->tape->parameters[node->parameters + CSG_LEAF_RAISE];
    double value = leaf->value + turn * leaf->doubt, most = 0, slack = 1e-5 * w->flat;
    bool is_tangent = fabs(from_face) > FAR * leaf->doubt || is_one_of(&leaf->balls, slope);
    for (uint32_t k = 0; k < CSG_SLOPES_CORNERS; k++) {
        double along = csg_vec3_dot(slope, csg_vec3_sub(r->triangle[k], r->c));
        double beyond = turn * (leaf_value(w, node, k) - value - along);
        is_tangent &= beyond <= 2 * leaf->doubt + slack;
        most = fmax(most, turn * along);
    }
    return is_tangent ? value + turn * (most + slack) : turn * INFINITY;
}

/* How far gradients are at most from some vector. Longer combinations of unit vectors than their
 * hull has are in a ball around these, too; none is farther from 0 than the longest. */
static double radius_of(const operand *leaf)
{
    csg_cone_ball around;
    if (!csg_slopes_exceed_hull(leaf))
        return csg_slopes_ball_around(&leaf->balls).spread;
    return csg_slopes_enclose(&leaf->balls, leaf->longest, &around)
               ? fmin(around.spread, leaf->longest)
               : leaf->longest;
}

/* Gradients turn, or in the end are off the middle of all, however fast they turn. */
static void find_sag(const walker *w, operand *leaf)
{
    double bend = leaf->balls.bend * w->flat;
    bool is_slow = bend < 2 * leaf->balls.items[0].spread;
    leaf->kink = is_slow || !(w->flat > 0) ? 0 : radius_of(leaf) * w->flat;
    leaf->sag = is_slow ? 0.5 * bend * w->flat : 0;
}

/* Over the triangle, from the values at its corners: no farther off than gradients stray from one
 * another, and a concave leaf is nowhere less than there. */
static void find_range(const walker *w, const csg_tape_node *node, operand *leaf)
{
    const csg_cone_ball *balls = leaf->balls.items;
    double stray = 0;
    double slack = (double)w->tape->parameters[node->parameters + CSG_LEAF_SLACK];
    double a = leaf_value(w, node, 0), b = leaf_value(w, node, 1), c = leaf_value(w, node, 2);
    leaf->low = fmin(a, fmin(b, c)) - slack;
    leaf->high = fmax(a, fmax(b, c)) + slack;
    for (uint32_t i = 0; i < leaf->balls.count; i++)
        stray = fmax(stray, i ? 2 * csg_slopes_balls_apart(&balls[0], &balls[i]) : balls[0].spread);
    if (leaf->stretched)
        stray = 2 * fmax(csg_norm3(balls[0].at), leaf->balls.corner);
    double off = leaf->kink > 0 ? stray * w->flat : leaf->sag;
    if (!is_concave(node)) {
        leaf->low -= off;
        leaf->high += off;
        return;
    }
    bool concave = w->tape->parameters[node->parameters + CSG_LEAF_SIGMA] > 0;
    double beyond = concave ? leaf->high + off : leaf->low - off;
    if (leaf->balls.count > 1) {
        double turn = concave ? 1 : -1;
        double tangent = tangent_value(w, node, leaf, turn);
        beyond = concave ? fmin(beyond, tangent) : fmax(beyond, tangent);
    }
    *(concave ? &leaf->high : &leaf->low) = beyond;
}

/* A leaf without a bound of its own. It may have no share in what is there. */
static void take_any(const walker *w, operand *leaf)
{
    double steepest = fmax((double)w->tape->steepest, (double)w->tape->lipschitz);
    leaf->balls.count = 1;
    leaf->balls.has_edges = false;
    leaf->balls.corner = 0;
    leaf->balls.items[0] = (csg_cone_ball){.at = {0, 0, 0}, .spread = steepest};
    leaf->balls.bend = INFINITY;
}

/* Faces that hardly turn, as those of a curve that was cut into segments, are one smooth one. */
static void join_faces(operand *leaf)
{
    static const double NARROW = 0.35; /* of the longest gradient */
    csg_cone_ball one;
    for (uint32_t i = 1; i < leaf->balls.count; i++) /* no such ball holds both: most turn more */
        if (csg_slopes_balls_apart(&leaf->balls.items[0], &leaf->balls.items[i]) >
            2.01 * NARROW * leaf->longest)
            return;
    if (!csg_slopes_enclose(&leaf->balls, leaf->longest, &one) ||
        !(one.spread <= NARROW * leaf->longest))
        return;
    leaf->balls.items[0] = one;
    leaf->balls.bend = INFINITY;
    leaf->balls.count = 1;
    leaf->balls.has_edges = leaf->stretched = leaf->faces = false;
    leaf->balls.corner = 0;
}

bool csg_slopes_push_leaf(walker *w, const csg_tape_node *node)
{
    operand *leaf = &w->stack[w->top++];
    const csg_vec3 at = w->region.c;
    const float c[3] = {(float)at.x, (float)at.y, (float)at.z};
    leaf->balls.count = 0;
    leaf->balls.has_edges = leaf->stretched = false;
    leaf->value = leaf_value(w, node, CSG_SLOPES_CORNERS);
    leaf->doubt =
        (double)w->tape->parameters[node->parameters + CSG_LEAF_SLACK] + 1e-6 * fabs(leaf->value);
    if (!csg_cone_add_leaf(&leaf->balls, w->tape, node, c, w->radius))
        take_any(w, leaf);
    leaf->longest = leaf->balls.corner;
    for (uint32_t i = 0; i < leaf->balls.count; i++) {
        const csg_cone_ball *ball = &leaf->balls.items[i];
        leaf->longest = fmax(leaf->longest, csg_norm3(ball->at) + ball->spread);
    }
    leaf->faces = leaf->balls.count > 1;
    for (uint32_t i = 0; i < leaf->balls.count; i++) /* else the frame, or a warp, stretches */
        leaf->stretched |= leaf->balls.corner > (1 + 1e-4) * csg_norm3(leaf->balls.items[i].at);
    if (leaf->faces && !is_concave(node))
        join_faces(leaf);
    find_sag(w, leaf);
    find_range(w, node, leaf);
    double span = csg_slopes_span(w, leaf);
    leaf->least = leaf->value - span;
    leaf->most = leaf->value + span;
    return true;
}
