/* SPDX-License-Identifier: MIT
 * Enclosures between planes; see enclosure.h.
 */
#include "measure/enclosure.h"

#include <math.h>
#include <string.h>

#include "field/gradients/cone_leaf.h"
#include "mesh/distance/slopes.h"
#include "scene/operators/blend.h"

/* Of a tape of one node, with how far floats may be off. */
static void value_at(const csg_kernel *kernel, const csg_tape *tape, const float at[3],
                     float *scratch, double *value, double *doubt)
{
    float low[CSG_OCTANTS], high[CSG_OCTANTS], x[3][CSG_OCTANTS];
    for (int axis = 0; axis < 3; axis++)
        for (int o = 0; o < CSG_OCTANTS; o++)
            x[axis][o] = at[axis];
    kernel->intervals(tape, x[0], x[1], x[2], 0, NULL, low, high, scratch);
    *value = 0.5 * ((double)high[0] + (double)low[0]);
    *doubt = 0.5 * ((double)high[0] - (double)low[0]);
}

static bool find_of_leaf(const csg_kernel *kernel, const csg_tape *tape, const double c[3],
                         double radius, float *scratch, csg_enclosure *out)
{
    const csg_tape_node *leaf = tape->nodes;
    const float at[3] = {(float)c[0], (float)c[1], (float)c[2]};
    csg_cone_balls balls = {.count = 0};
    double doubt;
    if (tape->count != 1 || leaf->warp || !csg_op_has(leaf->op, CSG_TRAIT_STEADY) ||
        !csg_cone_add_leaf(&balls, tape, leaf, at, radius) || balls.count != 1)
        return false;
    const csg_cone_ball *ball = &balls.items[0];
    value_at(kernel, tape, at, scratch, &out->value, &doubt);
    double rounding = doubt + CSG_ENCLOSURE_ROUNDING * radius;
    out->below = out->above = rounding + 0.5 * ball->spread * radius;
    out->stray = ball->spread + CSG_ENCLOSURE_ROUNDING;
    memcpy(out->slope, ball->at, sizeof out->slope);
    return true;
}

/* A formula whose second derivatives are bounded. */
static bool find_of_formula(const csg_kernel *kernel, const csg_tape *tape, const double c[3],
                            double radius, csg_enclosure *out, float *scratch)
{
    const float at[3] = {(float)c[0], (float)c[1], (float)c[2]};
    csg_cone_ball g;
    double bend, value, doubt;
    if (tape->count != 1 || !csg_cone_find_bend(tape, tape->nodes, at, radius, &g, &bend))
        return false;
    value_at(kernel, tape, at, scratch, &value, &doubt);
    double spread = g.spread + CSG_ENCLOSURE_ROUNDING * csg_norm3(g.at);
    out->value = value;
    out->below = out->above = doubt + (spread + 0.5 * bend * radius) * radius;
    out->stray = spread + bend * radius;
    out->bend = bend;
    memcpy(out->slope, g.at, sizeof out->slope);
    return true;
}

/* A leaf whose gradient is a unit vector that does not jump anywhere in the ball. */
static bool is_smooth_leaf(const csg_tape *tape, const csg_tape_node *leaf, const float c[3],
                           double radius)
{
    static const double UNIT = 2e-7;
    csg_cone_balls balls = {.count = 0};
    return !leaf->warp && csg_op_is_primitive(leaf->op) &&
           csg_cone_add_leaf(&balls, tape, leaf, c, radius) && balls.count == 1 &&
           fabs(csg_norm3(balls.items[0].at) - 1) <= UNIT;
}

/* Fillets turn on their operands' gradients, so their fields jump where these do, and then no
 * gradient bounds them. */
static bool may_jump(const csg_tape *tape, const double c[3], double radius)
{
    const float at[3] = {(float)c[0], (float)c[1], (float)c[2]};
    bool has_fillet = false;
    for (uint32_t i = 0; i < tape->count; i++)
        has_fillet |= csg_op_is_fillet(tape->nodes[i].op);
    for (uint32_t i = 0; i < tape->count && has_fillet; i++) {
        const csg_tape_node *node = &tape->nodes[i];
        bool joins = node->op == CSG_OP_UNION || node->op == CSG_OP_INTERSECTION ||
                     csg_op_is_round(node->op) || csg_op_is_fillet(node->op);
        if ((node->join && !csg_blend_is_smooth(node->join_blend)) ||
            !(joins || (csg_op_is_leaf(node->op) && is_smooth_leaf(tape, node, at, radius))))
            return true;
    }
    return false;
}

bool csg_enclosure_find(const csg_kernel *kernel, const csg_tape *tape, const double c[3],
                        double half, float *scratch, size_t scratch_floats, csg_enclosure *out)
{
    double radius = csg_enclosure_radius(half);
    csg_gradients gradients;
    const csg_vec3 at = csg_vec3_make(c[0], c[1], c[2]);
    const csg_gradients_region cube = {{at, at, at}, at, 0, radius / sqrt(3.0)};
    out->bend = 0;
    out->is_convex = false;
    if (find_of_leaf(kernel, tape, c, radius, scratch, out) ||
        find_of_formula(kernel, tape, c, radius, out, scratch))
        return isfinite(out->value + out->below + out->above);
    if (may_jump(tape, c, radius) ||
        !csg_gradients_find(kernel, tape, &cube, scratch, scratch_floats, &gradients))
        return false;
    bool turns = gradients.stray < gradients.longest;
    double stray = turns ? gradients.stray : gradients.longest;
    memset(out->slope, 0, sizeof out->slope);
    if (turns)
        memcpy(out->slope, gradients.middle, sizeof out->slope);
    out->value = gradients.value;
    out->stray = stray + CSG_ENCLOSURE_ROUNDING * gradients.longest;
    out->below = out->above =
        stray * radius + gradients.doubt + CSG_ENCLOSURE_ROUNDING * gradients.longest * radius;
    return isfinite(out->value + out->above) && isfinite(csg_norm3(out->slope));
}
