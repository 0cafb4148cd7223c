/* SPDX-License-Identifier: MIT
 * Joins: a child's value merges with that of its elder siblings. Sharp ones and the blends of one
 * length, and how channels mix; rule_kernel.c and smooth_kernel.c have the other kinds. Part of
 * kernel.c, in a file of its own.
 */
#ifndef CSG_FIELD_JOINS_H
#define CSG_FIELD_JOINS_H

#include <string.h>

#include "field/kernels/batch.h"
#include "scene/operators/blend_kinds.h"
#include "scene/operators/blends.h"

/* The intersection of a and b, raised by n, whose gradients are at right angles. Away from the edge
 * the smaller one, bit for bit. */
static inline float orthogonal(float n, float a, float b)
{
    float u = a - n, v = b - n;
    float edge = n - sqrtf(u * u + v * v);
    return (u < 0) & (v < 0) ? edge : smaller(a, b);
}

/* a = a op b. */
static void join_values(const csg_tape_node *node, const float *parameters, float *restrict a,
                        const float *restrict b, size_t count)
{
    const float n = parameters[CSG_OPERATOR_N], chi = parameters[CSG_OPERATOR_SUPPORT];
    const int is_union = node->join == CSG_JOIN_UNION;
    switch ((csg_blend_kind)node->join_blend) {
#define CSG_FOLD(NAME, name, area, raw, support, excess, smooth, convex, doc)                      \
    case CSG_BLEND_##NAME:                                                                         \
        if (is_union)                                                                              \
            for (size_t i = 0; i < count; i++)                                                     \
                a[i] = larger(a[i], b[i]) + name##_float(n, chi, absolute(a[i] - b[i])).value;     \
        else                                                                                       \
            for (size_t i = 0; i < count; i++)                                                     \
                a[i] = smaller(a[i], b[i]) - name##_float(n, chi, absolute(a[i] - b[i])).value;    \
        break;
#include "scene/operators/operators.def"
    case CSG_BLEND_ORTHOGONAL:
        for (size_t i = 0; i < count; i++)
            a[i] = is_union ? -orthogonal(-n, -a[i], -b[i]) : orthogonal(n, a[i], b[i]);
        break;
    case CSG_BLEND_SHARP:
        if (is_union)
            for (size_t i = 0; i < count; i++)
                a[i] = larger(a[i], b[i]);
        else
            for (size_t i = 0; i < count; i++)
                a[i] = smaller(a[i], b[i]);
        break;
#define CSG_RULE(NAME, name, space, fold, interval, demand, lipschitz, equal, doc)                 \
    case CSG_BLEND_##NAME:
#include "scene/operators/operators.def"
    case CSG_BLEND_ROUND:
    case CSG_BLEND_FILLET:
    case CSG_BLEND_END:
        break; /* joined elsewhere */
    }
}

/* share[i] of operand a in the derivative; b has the rest. Changes neither. Where the partial
 * derivatives do not add up to 1, at an orthogonal edge, gain[i] is their sum. */
static void join_shares(const csg_tape_node *node, const float *parameters, const float *restrict a,
                        const float *restrict b, float *restrict share, float *restrict gain,
                        size_t count)
{
    const float n = parameters[CSG_OPERATOR_N], chi = parameters[CSG_OPERATOR_SUPPORT];
    const float turn = node->join == CSG_JOIN_UNION ? 1.0f : -1.0f;
    switch ((csg_blend_kind)node->join_blend) {
#define CSG_FOLD(NAME, name, area, raw, support, excess, smooth, convex, doc)                      \
    case CSG_BLEND_##NAME:                                                                         \
        for (size_t i = 0; i < count; i++) {                                                       \
            float slope = name##_float(n, chi, absolute(a[i] - b[i])).slope;                       \
            share[i] = turn * a[i] > turn * b[i] ? 1.0f + slope : -slope;                          \
        }                                                                                          \
        break;
#include "scene/operators/operators.def"
    case CSG_BLEND_ORTHOGONAL:
        for (size_t i = 0; i < count; i++) {
            float u = turn * (a[i] - n), v = turn * (b[i] - n); /* edge where both are positive */
            int edge = (u > 0) & (v > 0);
            float sum = u + v;
            share[i] = edge ? u / sum : u > v ? 1.0f : 0.0f;
            gain[i] = edge ? sum / sqrtf(u * u + v * v) : 1.0f;
        }
        break;
    case CSG_BLEND_SHARP:
        for (size_t i = 0; i < count; i++)
            share[i] = turn * a[i] > turn * b[i] ? 1.0f : 0.0f;
        break;
#define CSG_RULE(NAME, name, space, fold, interval, demand, lipschitz, equal, doc)                 \
    case CSG_BLEND_##NAME:
#include "scene/operators/operators.def"
    case CSG_BLEND_ROUND:
    case CSG_BLEND_FILLET:
    case CSG_BLEND_END:
        break; /* joined elsewhere */
    }
}

static void mix(float *restrict a, const float *restrict b, const float *restrict share,
                size_t count)
{
    for (size_t i = 0; i < count; i++)
        a[i] = share[i] * a[i] + (1.0f - share[i]) * b[i];
}

static void stretch(float *restrict a, const float *restrict gain, size_t count)
{
    for (size_t i = 0; i < count; i++)
        a[i] *= gain[i];
}

/* ---- all kinds --------------------------------------------------------------------------------
 */

static int is_smooth(uint8_t blend)
{
    return blend == CSG_BLEND_EXTERIOR || blend == CSG_BLEND_INTERIOR;
}

static int is_of_fields(uint8_t blend)
{
    return csg_blend_takes_fields(blend);
}

/* a = by_a a + by_b b */
static void combine(float *restrict a, const float *restrict b, const float *restrict by_a,
                    const float *restrict by_b, size_t count)
{
    for (size_t i = 0; i < count; i++)
        a[i] = by_a[i] * a[i] + by_b[i] * b[i];
}

/* As colours need shares: in the proportions of their sizes, where one lies outside of 0..1. */
static void in_proportion(float *share, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        float first = absolute(share[i]), second = absolute(1.0f - share[i]);
        share[i] = first / (first + second);
    }
}

#endif
