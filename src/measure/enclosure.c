/* SPDX-License-Identifier: MIT
 * Enclosures between planes; see enclosure.h.
 */
#include "measure/enclosure.h"

#include <math.h>
#include <string.h>

#include "field/gradients/cone_leaf.h"
#include "mesh/distance/slopes.h"
#include "scene/primitives/kinds.h"

/* Of gradients, which are found with floats here and there: primitives allow themselves as much. */
static const double ROUNDING = 1e-5;

static double norm_of(const double v[3])
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/* Those whose gradient is a unit vector that turns steadily (cone_ball.h). */
static bool is_turning(const csg_tape_node *leaf)
{
    if (leaf->warp || !csg_op_is_primitive(leaf->op))
        return false;
    switch ((int)csg_op_node_kind(leaf->op)) {
    case CSG_NODE_SPHERE:
    case CSG_NODE_BOX:
    case CSG_NODE_FRUSTUM:
    case CSG_NODE_CAPSULE:
    case CSG_NODE_TORUS:
    case CSG_NODE_PLANE:
    case CSG_NODE_CIRCLE:
    case CSG_NODE_RECTANGLE:
    case CSG_NODE_SLAB:
        return true;
    default:
        return false;
    }
}

/* By how much a field with this gradient at c, which turns by a chord of at most `spread` within
 * the radius, can leave its tangent plane: it turns no faster than spread / (radius (1 - spread)).
 * Where a cone's tip is in the ball the spread is that of all its directions, and says nothing of
 * the rate; it is small for flat cones only. */
static double bend_of(const csg_tape_node *leaf, double spread, double radius)
{
    static const double FLAT_CONE = 4e-3;
    if ((int)csg_op_node_kind(leaf->op) == (int)CSG_NODE_FRUSTUM && spread < FLAT_CONE)
        return spread * radius;
    return 0.5 * spread / (1 - spread) * radius;
}

static bool find_of_leaf(const csg_kernel *kernel, const csg_tape *tape, const double c[3],
                         double radius, float *scratch, csg_enclosure *out)
{
    static const double UNIT = 1e-6, MOST_SPREAD = 0.7;
    const csg_tape_node *leaf = tape->nodes;
    const float at[3] = {(float)c[0], (float)c[1], (float)c[2]};
    float low[CSG_OCTANTS], high[CSG_OCTANTS], x[3][CSG_OCTANTS];
    csg_cone_balls balls = {.count = 0};
    if (tape->count != 1 || !is_turning(leaf) ||
        !csg_cone_add_leaf(&balls, tape, leaf, at, radius) || balls.count != 1)
        return false;
    const csg_cone_ball *ball = &balls.items[0];
    if (!(fabs(norm_of(ball->at) - 1) <= UNIT) || !(ball->spread <= MOST_SPREAD))
        return false;
    for (int axis = 0; axis < 3; axis++)
        for (int o = 0; o < CSG_OCTANTS; o++)
            x[axis][o] = at[axis];
    kernel->intervals(tape, x[0], x[1], x[2], 0, NULL, low, high, scratch);
    double rounding = 0.5 * ((double)high[0] - (double)low[0]) + ROUNDING * radius;
    bool bends = ball->spread > 0, is_concave = csg_op_has(leaf->op, CSG_TRAIT_CONVEX);
    bool is_turned = tape->parameters[leaf->parameters + CSG_LEAF_SIGMA] < 0;
    double bend = bends ? bend_of(leaf, ball->spread, radius) : 0;
    out->value = 0.5 * ((double)high[0] + (double)low[0]);
    out->below = rounding + (is_concave && is_turned ? 0 : bend);
    out->above = rounding + (is_concave && !is_turned ? 0 : bend);
    memcpy(out->slope, ball->at, sizeof out->slope);
    return true;
}

bool csg_enclosure_find(const csg_kernel *kernel, const csg_tape *tape, const double c[3],
                        double half, float *scratch, size_t scratch_floats, csg_enclosure *out)
{
    double radius = half * sqrt(3.0) * (1 + 1e-9);
    csg_gradients gradients;
    csg_vec3 middle = csg_vec3_make(c[0], c[1], c[2]);
    const csg_vec3 point[3] = {middle, middle, middle};
    if (find_of_leaf(kernel, tape, c, radius, scratch, out))
        return isfinite(out->value + out->below + out->above);
    if (!csg_gradients_find(kernel, tape, point, middle, radius, scratch, scratch_floats,
                            &gradients))
        return false;
    bool turns = gradients.stray < gradients.longest;
    double stray = turns ? gradients.stray : gradients.longest;
    memset(out->slope, 0, sizeof out->slope);
    if (turns)
        memcpy(out->slope, gradients.middle, sizeof out->slope);
    out->value = gradients.value;
    out->below = out->above =
        stray * radius + gradients.doubt + ROUNDING * gradients.longest * radius;
    return isfinite(out->value + out->above) && isfinite(norm_of(out->slope));
}
