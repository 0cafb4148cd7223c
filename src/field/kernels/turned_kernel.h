/* SPDX-License-Identifier: MIT
 * What gradients of the walks lack. A fillet's length and the ranges of a turning join depend on
 * the angle between their operands' gradients, and that angle changes from place to place where
 * operands are curved: F = F(f, g), grad F = sum dF/df_i grad f_i + what F gains as the g_i turn.
 * The walks have the first sum alone; here is the rest, by differences of F as the operands have
 * the gradients of places nearby while their values stay. So what noise there is is that of
 * gradients, times the fillet's length. Part of kernel.c, in a file of its own.
 *
 * Differences are of second order: (4 F(h) - F(2 h) - 3 F(0)) / 2 h.
 */
#ifndef CSG_FIELD_TURNED_KERNEL_H
#define CSG_FIELD_TURNED_KERNEL_H

#include <string.h>

#include "base/select.h"
#include "field/kernels/fillet_kernel.h"
#include "field/kernels/rule_kernel.h"
#include "field/kernels/slots.h"

/* Steps are a share of the length over which F changes, but no less than what floats of that place
 * make of the gradients' directions. */
static const float TURNED_STEP = 0x1p-8f, TURNED_STEP_OF_PLACE = 0x1p-12f;
/* Slopes of two steps that differ by more: an operand's gradient jumps between them. F's own are
 * some 1. */
static const float TURNED_JUMP = 0x1p-4f;

/* An operator at the points of a batch where its gradients matter. Its operands are subtrees of the
 * tape: number k has ranges[2 k + 1] nodes from ranges[2 k] on. */
typedef struct turned {
    const csg_tape *tape;
    kernel_slots room; /* for the operands as they are nearby, and walks over these */
    const fillet_arrays *fillet;
    const float *join; /* a turning join's parameters, where it is no fillet */
    uint32_t arity, *ranges;
    size_t count, padded;                       /* of points */
    uint32_t which[CSG_BATCH];                  /* in the batch */
    float place[3][CSG_BATCH], step[CSG_BATCH]; /* step: in the direction of each axis */
    float value[3][CSG_BATCH];                  /* at the place, one and two steps from it */
    float share[3][CSG_BATCH];
} turned;

/* The tape's value is in slot 0, its gradient in the channels behind the `depth` slots. */
static void walk_gradients(const csg_tape *tape, csg_points p, kernel_slots s, uint32_t depth);

/* ---- the room ----------------------------------------------------------------------------------
 */

static inline float *turned_channel(const turned *t, uint32_t operand, uint32_t c)
{
    return slot(t->room, (size_t)operand * GRADIENT_CHANNELS + c);
}

static inline float *turned_value(const turned *t, uint32_t operand)
{
    return slot(t->room, (size_t)t->arity * GRADIENT_CHANNELS + operand);
}

static void turned_begin(turned *t, uint32_t arity)
{
    t->arity = arity;
    t->ranges = (uint32_t *)(void *)slot(t->room, (size_t)arity * (GRADIENT_CHANNELS + 1));
    t->count = 0;
}

static inline kernel_slots turned_walk_room(const turned *t)
{
    return (kernel_slots){slot(t->room, (size_t)t->arity * (GRADIENT_CHANNELS + 2)),
                          t->room.stride};
}

/* Point i of the batch, with a length over which the value changes. */
static void turned_add_point(turned *t, csg_points p, size_t i, float length)
{
    const float at[3] = {p.x[i], p.y[i], p.z[i]};
    float far = absolute(at[0]) + absolute(at[1]) + absolute(at[2]);
    for (int k = 0; k < 3; k++)
        t->place[k][t->count] = at[k];
    t->step[t->count] = larger(TURNED_STEP * length, TURNED_STEP_OF_PLACE * far);
    t->which[t->count++] = (uint32_t)i;
}

/* Fills the last lanes with what is in the first one. */
static void turned_pad(turned *t)
{
    t->padded = (t->count + CSG_LANES - 1) / CSG_LANES * CSG_LANES;
    for (size_t j = t->count; j < t->padded; j++) {
        for (int k = 0; k < 3; k++)
            t->place[k][j] = t->place[k][0];
        t->step[j] = t->step[0];
        t->which[j] = t->which[0];
    }
}

/* ---- values by gradients -----------------------------------------------------------------------
 */

/* Operands' values and, where it is the place itself, their gradients. */
static void turned_gather(const turned *t, uint32_t k, const float *value,
                          const float *const gradient[3])
{
    for (size_t j = 0; j < t->padded; j++)
        turned_value(t, k)[j] = value[t->which[j]];
    for (uint32_t c = 0; c < 3 && gradient; c++)
        for (size_t j = 0; j < t->padded; j++)
            turned_channel(t, k, c)[j] = gradient[c][t->which[j]];
}

static void turned_gather_fillet(const turned *t, int with_gradients)
{
    const fillet_arrays *a = t->fillet;
    for (uint32_t k = 0; k < t->arity; k++) {
        const float *const gradient[3] = {fillet_channel(a, k, 0), fillet_channel(a, k, 1),
                                          fillet_channel(a, k, 2)};
        turned_gather(t, k, a->values + k * a->stride, with_gradients ? gradient : NULL);
    }
}

static void turned_apply_fillet(const turned *t, float *out)
{
    fillet_arrays moved = *t->fillet;
    moved.values = turned_value(t, 0);
    moved.channels = turned_channel(t, 0, 0);
    moved.stride = t->room.stride;
    moved.per = GRADIENT_CHANNELS;
    fillet_combine(&moved, GRADIENT_CHANNELS, 0, t->padded);
    memcpy(out, moved.values, t->padded * sizeof *out);
}

static void turned_apply_join(const turned *t, float *out)
{
    float by_a[CSG_BATCH], by_b[CSG_BATCH];
    float *a[3], *b[3];
    for (uint32_t c = 0; c < 3; c++) {
        a[c] = turned_channel(t, 0, c);
        b[c] = turned_channel(t, 1, c);
    }
    memcpy(out, turned_value(t, 0), t->padded * sizeof *out);
    CSG_THIS_RULE_KERNEL.turn(t->join, out, turned_value(t, 1), a, b, by_a, by_b, t->padded);
}

/* The operands' gradients at these points. Planes, which have none that matters, have no range. */
static void turned_move(const turned *t, csg_points p)
{
    kernel_slots s = turned_walk_room(t);
    for (uint32_t k = 0; k < t->arity; k++) {
        csg_tape operand = *t->tape;
        operand.nodes += t->ranges[2 * k];
        operand.count = t->ranges[2 * k + 1];
        if (!operand.count)
            continue;
        uint32_t depth = csg_tape_depth(&operand);
        walk_gradients(&operand, p, s, depth);
        for (uint32_t c = 0; c < 3; c++)
            memcpy(turned_channel(t, k, c), channel(s, depth, 0, (int)c), p.count * sizeof(float));
    }
}

/* ---- differences -------------------------------------------------------------------------------
 */

static inline float turned_slope(float step, float value, float next, float last)
{
    float first = (next - value) / step, second = (last - next) / step;
    float far = absolute(second - first);
    float level = absolute(second) < absolute(first) ? second : first;
    return far > TURNED_JUMP ? level : 1.5f * first - 0.5f * second;
}

static void turned_difference(turned *t, int axis)
{
    float at[3][CSG_BATCH], step[CSG_BATCH];
    for (int k = 0; k < 3; k++)
        memcpy(at[k], t->place[k], t->padded * sizeof(float));
    for (size_t j = 0; j < t->padded; j++) {
        float from = t->place[axis][j];
        step[j] = (from + t->step[j]) - from; /* what floats make of it */
    }
    for (int k = 1; k <= 2; k++) {
        for (size_t j = 0; j < t->padded; j++)
            at[axis][j] = t->place[axis][j] + (float)k * step[j];
        if (t->fillet) /* of whose operands the first one's value was overwritten */
            turned_gather_fillet(t, 0);
        turned_move(t, (csg_points){at[0], at[1], at[2], t->padded});
        if (t->fillet)
            turned_apply_fillet(t, t->value[k]);
        else
            turned_apply_join(t, t->value[k]);
    }
    for (size_t j = 0; j < t->padded; j++)
        t->share[axis][j] =
            step[j] > 0 ? turned_slope(step[j], t->value[0][j], t->value[1][j], t->value[2][j]) : 0;
}

/* Adds what was found to three channels of the operator's result. */
static void turned_add(const turned *t, float *const out[3])
{
    for (int k = 0; k < 3; k++)
        for (size_t j = 0; j < t->count; j++)
            out[k][t->which[j]] += t->share[k][j];
}

/* ---- operators ---------------------------------------------------------------------------------
 */

/* Before a fillet overwrites its operands. Points where two of them are in reach of each other;
 * false: there is none. */
static int turned_of_fillet(turned *t, const csg_tape_node *node, const fillet_arrays *a,
                            csg_points p)
{
    const csg_tape_node *child = node - 1;
    turned_begin(t, node->arity);
    t->fillet = a;
    for (size_t i = 0; i < p.count; i++) {
        float most = -INFINITY, next = -INFINITY;
        for (uint32_t k = 0; k < a->operands; k++) {
            float v = a->turn * a->values[k * a->stride + i];
            next = larger(next, smaller(most, v));
            most = larger(most, v);
        }
        if (most - next < 2 * (float)a->radius)
            turned_add_point(t, p, i, (float)a->radius);
    }
    if (!t->count)
        return 0;
    for (uint32_t k = node->arity; k-- > 0; child -= child->size) {
        t->ranges[2 * k] = (uint32_t)(child - t->tape->nodes) + 1 - child->size;
        t->ranges[2 * k + 1] = k < a->operands ? child->size : 0;
    }
    turned_pad(t);
    turned_gather_fillet(t, 1);
    turned_apply_fillet(t, t->value[0]);
    for (int axis = 0; axis < 3; axis++)
        turned_difference(t, axis);
    return 1;
}

/* Before a turning join of `node`, the second operand, with its elder siblings, the first one. */
static int turned_of_join(turned *t, const csg_tape_node *node, const float *parameters,
                          const float *const value[2], const float *const gradient[2][3],
                          csg_points p)
{
    const csg_tape_node *elder = node - node->size, *first = elder;
    turned_begin(t, 2);
    t->fillet = NULL;
    t->join = parameters;
    for (size_t i = 0; i < p.count; i++) {
        float slope = 0;
        for (int c = 0; c < 3; c++)
            slope += absolute(gradient[0][c][i]) + absolute(gradient[1][c][i]);
        if (slope > 1e-6f && slope < INFINITY)
            turned_add_point(t, p, i, 1 / slope);
    }
    if (!t->count)
        return 0;
    while (first->join)
        first -= first->size;
    t->ranges[0] = (uint32_t)(first - t->tape->nodes) + 1 - first->size;
    t->ranges[1] = (uint32_t)(elder - t->tape->nodes) + 1 - t->ranges[0];
    t->ranges[2] = (uint32_t)(node - t->tape->nodes) + 1 - node->size;
    t->ranges[3] = node->size;
    turned_pad(t);
    turned_gather(t, 0, value[0], gradient[0]);
    turned_gather(t, 1, value[1], gradient[1]);
    turned_apply_join(t, t->value[0]);
    for (int axis = 0; axis < 3; axis++)
        turned_difference(t, axis);
    return 1;
}

#endif
