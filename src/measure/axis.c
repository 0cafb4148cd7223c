/* SPDX-License-Identifier: MIT
 * Axes of revolution; see axis.h.
 */
#include "measure/axis.h"

#include <math.h>
#include <string.h>

#include "scene/operators/blend.h"
#include "scene/operators/blend_kinds.h"
#include "scene/operators/fillet.h"
#include "scene/primitives/curve.h"
#include "scene/primitives/kinds.h"

/* How far a leaf is from one that turns about the axis, like CSG_LEAF_OFF and _TURNED. */
typedef struct apart {
    double place, turn;
} apart;

static double square(double x)
{
    return x * x;
}

/* Of the 2 x 2 block by which a leaf's own x and y come from two coordinates: from the nearest one
 * that turns and scales, mirrored or not. */
static double square_of_skew(double a, double b, double c, double d)
{
    return a * d - b * c >= 0 ? (square(a - d) + square(b + c)) / 2
                              : (square(a + d) + square(b - c)) / 2;
}

/* Number i of the leaf's parameters, of its frame, of its own ones. */
static double number_of(const csg_tape *tape, const csg_tape_node *leaf, int i)
{
    return csg_tape_number(tape, leaf->parameters + (uint32_t)i);
}

static double frame_of(const csg_tape *tape, const csg_tape_node *leaf, int i)
{
    return number_of(tape, leaf, CSG_LEAF_FRAME + i);
}

static double own_of(const csg_tape *tape, const csg_tape_node *leaf, int i)
{
    return csg_tape_number(tape, csg_tape_own_at(leaf) + (uint32_t)i);
}

/* A plane has all of its place in its own parameters. */
static apart plane_apart(const csg_tape *tape, const csg_tape_node *leaf, int across, int beside)
{
    return (apart){0,
                   sqrt(square(own_of(tape, leaf, across)) + square(own_of(tape, leaf, beside)))};
}

/* A leaf whose own z axis has to be the axis. */
static apart frame_apart(const csg_tape *tape, const csg_tape_node *leaf, int axis, int across,
                         int beside)
{
    bool is_affine = leaf->frame == CSG_FRAME_AFFINE;
    double m[3][3], t[3], sigma = fabs(number_of(tape, leaf, CSG_LEAF_SIGMA));
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++)
            m[i][k] = is_affine ? frame_of(tape, leaf, 3 * i + k) : i == k;
        t[i] = is_affine ? frame_of(tape, leaf, 9 + i) : -frame_of(tape, leaf, i);
    }
    double turn = square(m[2][across]) + square(m[2][beside]) + square(m[0][axis]) +
                  square(m[1][axis]) +
                  square_of_skew(m[0][across], m[0][beside], m[1][across], m[1][beside]);
    return (apart){sigma * sqrt(square(t[0]) + square(t[1])), sigma * sqrt(turn)};
}

/* How far one is from being round whose floats are. */
static double skew_of(const csg_tape *tape, const csg_tape_node *leaf)
{
    csg_primitive_kind kind = csg_op_node_kind(leaf->op);
    if (kind == (csg_primitive_kind)CSG_NODE_ELLIPSOID)
        return fabs(own_of(tape, leaf, 0) - own_of(tape, leaf, 1));
    return kind == (csg_primitive_kind)CSG_NODE_TORUS && own_of(tape, leaf, 2) > -1 ? INFINITY : 0;
}

/* By the tape's numbers, or the scene's (csg_tape_number). INFINITY: it does not turn. */
static apart find_apart(const csg_tape *tape, const csg_tape_node *leaf, int axis)
{
    static const apart FAR = {INFINITY, INFINITY};
    int across = (axis + 1) % 3, beside = (axis + 2) % 3;
    bool is_affine = leaf->frame == CSG_FRAME_AFFINE;
    if (leaf->warp || !csg_op_is_primitive(leaf->op) ||
        csg_node_is_curve(csg_op_node_kind(leaf->op)))
        return FAR;
    const csg_primitive *primitive = csg_primitive_of(csg_op_node_kind(leaf->op));
    if (primitive->traits & CSG_TRAIT_LINEAR)
        return plane_apart(tape, leaf, across, beside);
    if (!(primitive->mirrors(csg_tape_own(tape, leaf)) & CSG_MIRROR_AROUND))
        return FAR;
    if (primitive->traits & CSG_TRAIT_BALL && !is_affine)
        return (apart){
            fabs(number_of(tape, leaf, CSG_LEAF_SIGMA)) *
                sqrt(square(frame_of(tape, leaf, across)) + square(frame_of(tape, leaf, beside))),
            0};
    apart out = frame_apart(tape, leaf, axis, across, beside);
    out.place += fabs(number_of(tape, leaf, CSG_LEAF_SIGMA)) * skew_of(tape, leaf);
    return out;
}

/* A function of values alone, or a fillet, which turns on angles between gradients in a frame that
 * is no more than turned. */
static bool turns_with_operands(const csg_tape *tape, const csg_tape_node *node)
{
    if (csg_op_is_round(node->op))
        return true;
    if (csg_op_is_fillet(node->op))
        return !(tape->parameters[node->parameters + CSG_FILLET_IS_SKEWED] > 0);
    return (node->op == CSG_OP_UNION || node->op == CSG_OP_INTERSECTION) &&
           node->blend < CSG_BLEND_FILLET;
}

/* What floats may do to a leaf is off and turned. Twice what it is apart has to be no more than
 * that: planes around leaves (halves.c) have room for two of these, and slacks for much more. */
static bool is_about(const csg_tape *tape, int axis)
{
    for (uint32_t i = 0; i < tape->count; i++) {
        const csg_tape_node *node = &tape->nodes[i];
        const float *parameters = tape->parameters + node->parameters;
        if (!csg_op_is_leaf(node->op)) {
            if (!turns_with_operands(tape, node))
                return false;
            continue;
        }
        apart a = find_apart(tape, node, axis);
        if (!isfinite(a.place + a.turn) || 2 * a.place > (double)parameters[CSG_LEAF_OFF] ||
            2 * a.turn > (double)parameters[CSG_LEAF_TURNED])
            return false;
    }
    return true;
}

static void widen(const csg_tape *tape, int axis, float *parameters)
{
    static const double UP = 1 + 0x1p-22; /* no less than that as floats */
    for (uint32_t i = 0; i < tape->count; i++) {
        if (!csg_op_is_leaf(tape->nodes[i].op))
            continue;
        apart a = find_apart(tape, &tape->nodes[i], axis);
        float *of = parameters + tape->nodes[i].parameters;
        if (a.place > 0)
            of[CSG_LEAF_OFF] = (float)(((double)of[CSG_LEAF_OFF] + 2 * a.place) * UP);
        if (a.turn > 0)
            of[CSG_LEAF_TURNED] = (float)(((double)of[CSG_LEAF_TURNED] + 2 * a.turn) * UP);
    }
}

/* The same of what the scene says, where a leaf is off by what doubles make of it. False: one does
 * not turn that its floats say does. */
static bool widen_exact(const csg_tape *tape, int axis, double *exact)
{
    bool all = true;
    for (uint32_t i = 0; i < tape->count; i++) {
        if (!csg_op_is_leaf(tape->nodes[i].op))
            continue;
        apart a = find_apart(tape, &tape->nodes[i], axis);
        double *of = exact + tape->nodes[i].parameters;
        of[CSG_LEAF_OFF] += 2 * a.place;
        of[CSG_LEAF_TURNED] += 2 * a.turn;
        all = all && isfinite(a.place + a.turn);
    }
    return all;
}

/* *exact: with as much more room. False: out of memory. */
static bool find_exact(const csg_tape *tape, size_t parameter_count, int axis, csg_arena *arena,
                       csg_tape_exact *exact)
{
    csg_tape of = *tape;
    of.exact = exact;
    double *parameters = csg_arena_alloc(arena, (parameter_count + 1) * sizeof *parameters);
    if (!parameters)
        return false;
    memcpy(parameters, exact->parameters, parameter_count * sizeof *parameters);
    exact->parameters = widen_exact(&of, axis, parameters) ? parameters : NULL;
    return true;
}

bool csg_axis_find(csg_tape *tape, size_t parameter_count, csg_tape_exact *exact, csg_arena *arena,
                   int *axis)
{
    csg_tape floats = *tape;
    floats.exact = NULL;
    *axis = CSG_AXIS_NONE;
    for (int k = 2; k >= 0 && *axis == CSG_AXIS_NONE && tape->count; k--)
        if (is_about(&floats, k))
            *axis = k;
    if (*axis == CSG_AXIS_NONE)
        return true;
    if (exact && exact->parameters && !find_exact(tape, parameter_count, *axis, arena, exact))
        return false;
    float *parameters = csg_arena_alloc(arena, (parameter_count + 1) * sizeof *parameters);
    if (!parameters)
        return false;
    memcpy(parameters, tape->parameters, parameter_count * sizeof *parameters);
    widen(&floats, *axis, parameters);
    tape->parameters = parameters;
    return true;
}
