/* SPDX-License-Identifier: MIT
 * A direction for all leaves of a tape; see cone.h. The best one points to the point of the convex
 * hull of the leaves' gradients that is nearest to zero; Frank and Wolfe's steps come near to it,
 * and what they find is then checked, so it need not be the best.
 */
#include "field/cones/cone.h"

#include <math.h>

#include "field/cones/cone_along.h"
#include "field/gradients/cone_fillet.h"
#include "field/point.h"

static const double ROOT3 = 1.7320508075688774;
static const double ENOUGH = 0.97; /* of the corners of a box */

/* The ball that reaches least far along w, and how far. */
static uint32_t worst_of(const csg_cone_balls *balls, const double w[3], double *reach)
{
    uint32_t worst = 0;
    double norm = csg_norm3(w);
    *reach = INFINITY;
    for (uint32_t i = 0; i < balls->count; i++) {
        double d = csg_dot3(w, balls->items[i].at) - norm * balls->items[i].spread;
        if (d < *reach) {
            *reach = d;
            worst = i;
        }
    }
    return worst;
}

/* w moves towards the vector of the ball that is nearest to the other side, as far as it gets
 * shorter by that. False: it hardly does. */
static bool step_towards(double w[3], const csg_cone_ball *ball)
{
    double point[3], to[3], norm = csg_norm3(w);
    for (int k = 0; k < 3; k++) {
        point[k] = ball->at[k] - (norm > 0 ? w[k] / norm : 0) * ball->spread;
        to[k] = point[k] - w[k];
    }
    double square = csg_dot3(to, to), share = square > 0 ? -csg_dot3(w, to) / square : 0;
    share = share < 0 ? 0 : share > 1 ? 1 : share;
    for (int k = 0; k < 3; k++)
        w[k] += share * to[k];
    return share > 1e-6;
}

/* w is never shorter than what the best axis reaches: `share` of that is enough. */
static bool find_axis(const csg_cone_balls *balls, double share, csg_cone *out)
{
    enum { STEPS = 12 };
    double w[3] = {0, 0, 0}, best = 0;
    for (uint32_t i = 0; i < balls->count; i++)
        for (int k = 0; k < 3; k++)
            w[k] += balls->items[i].at[k] / balls->count;
    for (int step = 0; step < STEPS; step++) {
        double reach, norm = csg_norm3(w);
        if (!(norm > 1e-6))
            break;
        uint32_t worst = worst_of(balls, w, &reach);
        if (reach / norm > best) {
            best = reach / norm;
            for (int k = 0; k < 3; k++)
                out->axis[k] = w[k] / norm;
        }
        if (balls->count == 1 || best > share * norm || !step_towards(w, &balls->items[worst]))
            break;
    }
    out->least = best;
    return best > 0;
}

bool csg_cone_find_axis(const csg_cone_balls *balls, csg_cone *out)
{
    return find_axis(balls, 1, out);
}

/* Operators whose gradient is such a combination. */
static bool operator_combines(const csg_tape_node *node)
{
    switch ((csg_op)node->op) {
    case CSG_OP_UNION:
    case CSG_OP_INTERSECTION:
    case CSG_OP_ROUND_UNION:
    case CSG_OP_ROUND_INTERSECTION:
        return !csg_blend_is_rule(node->blend);
    case CSG_OP_FIELD:
    case CSG_OP_SHAPE:
    case CSG_OP_FILLET_UNION:
    case CSG_OP_FILLET_INTERSECTION:
    case CSG_OP_COMBINE:
    case CSG_OP_SOFTEN:
    case CSG_OP_RULE_UNION:
    case CSG_OP_RULE_INTERSECTION:
    case CSG_OP_EMPTY:
    case CSG_OP_FIRST_PRIMITIVE:
        break;
    }
    return false;
}

static bool is_sharp(const csg_tape_node *node)
{
    return node->arity > 1 &&
           (csg_blend_is_sharp(node->blend) || csg_blend_is_orthogonal(node->blend));
}

/* A fillet's gradient strays from the combinations of its operands': as if theirs were so much
 * wider. */
static bool widen_operands(const csg_tape *tape, uint32_t n, const float c[3], double radius,
                           csg_cone_leaves *leaves)
{
    const csg_tape_node *node = &tape->nodes[n];
    double stray;
    if (node->size != node->arity + 1 || !csg_fillet_find_stray(tape, node, c, radius, 0, &stray))
        return false;
    for (uint32_t i = leaves->first[leaves->count - node->arity]; i < leaves->balls.count; i++)
        leaves->balls.items[i].spread += stray;
    return true;
}

/* Whether the field is everywhere, with its gradient, that of one of the leaves. */
static bool is_of_leaves(const csg_tape *tape)
{
    bool all = true;
    for (uint32_t i = 0; i < tape->count && all; i++) {
        const csg_tape_node *node = &tape->nodes[i];
        all = csg_op_is_leaf(node->op) ||
              ((node->op == CSG_OP_UNION || node->op == CSG_OP_INTERSECTION) &&
               csg_blend_is_sharp(node->blend));
    }
    return all;
}

/* Whether all leaves heed a region's cube. */
static bool is_of_formulas(const csg_tape *tape)
{
    bool all = true;
    for (uint32_t i = 0; i < tape->count && all; i++) {
        const csg_tape_node *node = &tape->nodes[i];
        all = !csg_op_is_leaf(node->op) || (node->op == CSG_OP_FIELD && !node->warp);
    }
    return all;
}

/* Of each leaf; false: one has no bound. */
static bool find_leaves(const csg_tape *tape, const csg_cone_region *region,
                        csg_cone_leaves *leaves, csg_cone *out, bool *is_simple)
{
    for (uint32_t i = 0; i < tape->count; i++) {
        const csg_tape_node *node = &tape->nodes[i];
        if (csg_op_is_leaf(node->op)) {
            if (leaves->count >= CSG_CONE_MOST)
                return false;
            leaves->first[leaves->count] = leaves->balls.count;
            if (!csg_cone_add_leaf_in(&leaves->balls, tape, node, region))
                return false;
            leaves->corner[leaves->count++] = leaves->balls.corner;
        } else if (csg_op_is_fillet(node->op)) {
            if (!widen_operands(tape, i, region->c, region->radius, leaves))
                return false;
            out->is_crease |= node->planes > 0 || csg_fillet_has_apart(tape, node);
        } else {
            *is_simple = *is_simple && operator_combines(node);
            out->is_crease |= is_sharp(node);
        }
    }
    return leaves->balls.count > 0;
}

/* Leaves that are within the band somewhere. */
static uint32_t count_present(const csg_cone_leaves *leaves)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < leaves->count; i++) {
        uint32_t end = i + 1 < leaves->count ? leaves->first[i + 1] : leaves->balls.count;
        count += end > leaves->first[i];
    }
    return count;
}

/* Of the gradients of all leaves. */
static double largest_of(const csg_cone_leaves *leaves)
{
    double most = 0;
    for (uint32_t i = 0; i < leaves->balls.count; i++) {
        const csg_cone_ball *ball = &leaves->balls.items[i];
        most = fmax(most, csg_norm3(ball->at) + ball->spread);
    }
    for (uint32_t i = 0; i < leaves->count; i++)
        most = fmax(most, leaves->corner[i]);
    return most;
}

/* What the shares of operators that combine add up to at most: of two at right angles sqrt(2). */
static double most_shares(const csg_tape *tape)
{
    double most = 1;
    for (uint32_t i = 0; i < tape->count; i++) {
        const csg_tape_node *node = &tape->nodes[i];
        bool is_orthogonal = !csg_op_is_leaf(node->op) && csg_blend_is_orthogonal(node->blend);
        for (uint32_t k = 1; is_orthogonal && k < node->arity; k++)
            most *= 1.41421357;
    }
    return most;
}

/* Takes the axis if the field climbs faster along it than along the best so far. */
static void try_axis(const csg_pruner *room, const csg_tape *tape, const csg_cone_leaves *leaves,
                     const double axis[3], csg_cone *best)
{
    csg_cone made = {.is_crease = best->is_crease};
    if (!csg_cone_along(tape, leaves, room->low, room->high, axis, &made.least, &made.most,
                        &made.is_crease))
        return;
    best->is_crease = made.is_crease;
    if (!(made.least > best->least))
        return;
    best->least = made.least;
    best->most = made.most;
    for (int k = 0; k < 3; k++)
        best->axis[k] = axis[k];
}

/* The steepest of three directions: the one that suits all leaves, where there is one, the gradient
 * at the centre, and what suits those leaves that are heeded. */
static bool find_along(csg_pruner *room, const csg_tape *tape, const float c[3], double radius,
                       const csg_cone_leaves *leaves, csg_cone *out)
{
    /* cubes around the ball, which they are given by the balls around them */
    float reach = (float)(radius * 1.7320508 * (1 + 1e-6));
    csg_cone by;
    csg_cone_balls heavy;
    if (!room)
        return false;
    out->out_of_memory = !csg_prune_cube(room, tape, c, reach);
    if (out->out_of_memory)
        return false;
    out->least = 0;
    if (csg_cone_find_axis(&leaves->balls, &by))
        try_axis(room, tape, leaves, by.axis, out);
    csg_vec3 w = csg_tape_gradient_at(room->kernel, tape, csg_vec3_from_floats(c), room->scratch,
                                      room->scratch_capacity);
    double norm = csg_vec3_norm(w);
    const double up[3] = {w.x / norm, w.y / norm, w.z / norm};
    if (norm > 1e-6)
        try_axis(room, tape, leaves, up, out);
    if (csg_cone_lighten(tape, leaves, room->low, room->high, &heavy) &&
        csg_cone_find_axis(&heavy, &by))
        try_axis(room, tape, leaves, by.axis, out);
    return out->least > 0;
}

/* The axis for the balls' directions: of two solids one may be a formula that climbs far slower. */
static bool find_axis_of_directions(const csg_cone_balls *balls, double share, csg_cone *out)
{
    csg_cone_balls unit = {.count = balls->count};
    for (uint32_t i = 0; i < balls->count; i++) {
        const csg_cone_ball *ball = &balls->items[i];
        double norm = csg_norm3(ball->at);
        if (!(norm > ball->spread && norm > 1e-6))
            return false;
        for (int k = 0; k < 3; k++)
            unit.items[i].at[k] = ball->at[k] / norm;
        unit.items[i].spread = ball->spread / norm;
    }
    if (!find_axis(&unit, share, out))
        return false;
    worst_of(balls, out->axis, &out->least);
    return true;
}

/* How the gradients lean away from the axis. Vectors in a ball are no worse than all of its worst
 * at once; what they combine to, with weights >= 0, is no worse than they are. */
static void find_lean(const csg_cone_balls *balls, csg_cone *cone)
{
    cone->steep = cone->lean = 0;
    for (uint32_t i = 0; i < balls->count; i++) {
        const csg_cone_ball *ball = &balls->items[i];
        double sum = fabs(ball->at[0]) + fabs(ball->at[1]) + fabs(ball->at[2]);
        double climb = csg_dot3(cone->axis, ball->at) - ball->spread;
        cone->steep = fmax(cone->steep, (csg_norm3(ball->at) + ball->spread) / climb);
        cone->lean = fmax(cone->lean, (sum + ROOT3 * ball->spread) / climb);
    }
}

bool csg_cone_find_in(csg_pruner *room, const csg_tape *tape, const csg_cone_region *region,
                      csg_cone *out)
{
    csg_cone_leaves leaves;
    csg_cone_region of_leaves = *region;
    bool is_simple = true, by_leaves = is_of_leaves(tape);
    leaves.count = leaves.balls.count = 0;
    leaves.balls.has_edges = out->is_crease = out->out_of_memory = false;
    out->most = INFINITY;
    out->fills_cube = by_leaves && region->half < INFINITY && is_of_formulas(tape);
    if (!by_leaves)
        of_leaves.band = INFINITY;
    if (!find_leaves(tape, &of_leaves, &leaves, out, &is_simple))
        return false;
    if (by_leaves) /* where one of them is alone there is no edge between them */
        out->is_crease = out->is_crease && count_present(&leaves) > 1;
    out->is_crease |= leaves.balls.has_edges;
    if (!is_simple) {
        bool found = find_along(room, tape, region->c, region->radius, &leaves, out);
        out->steep = found ? out->most / out->least : INFINITY;
        out->lean = ROOT3 * out->steep;
        return found;
    }
    out->most = most_shares(tape) * largest_of(&leaves);
    if (!find_axis_of_directions(&leaves.balls, out->fills_cube ? ENOUGH : 1, out))
        return false;
    find_lean(&leaves.balls, out);
    return true;
}

bool csg_cone_find(csg_pruner *room, const csg_tape *tape, const float c[3], double radius,
                   csg_cone *out)
{
    const csg_cone_region ball = {{c[0], c[1], c[2]}, radius, INFINITY, INFINITY};
    csg_cone_leaves leaves;
    bool is_simple = true;
    leaves.count = leaves.balls.count = 0;
    leaves.balls.has_edges = out->is_crease = out->out_of_memory = false;
    out->most = INFINITY;
    if (!find_leaves(tape, &ball, &leaves, out, &is_simple))
        return false;
    out->is_crease |= leaves.balls.has_edges;
    if (!is_simple)
        return find_along(room, tape, c, radius, &leaves, out);
    out->most = most_shares(tape) * largest_of(&leaves);
    return csg_cone_find_axis(&leaves.balls, out);
}
