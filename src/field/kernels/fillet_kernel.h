/* SPDX-License-Identifier: MIT
 * The fillet operator: all operands at once, with their gradients, and behind them the planes at
 * which a union ends (scene/operators/fillet.h, operators.md 16). Part of kernel.c, in a file of
 * its own.
 *
 * A point at a time, in double: what comes out depends on the operands in reach alone, not on which
 * others pruning has left, nor on their order.
 */
#ifndef CSG_FIELD_FILLET_KERNEL_H
#define CSG_FIELD_FILLET_KERNEL_H

#include <math.h>

#include "base/select.h"
#include "field/kernels/batch.h"
#include "field/kernels/fillet_pair.h"
#include "scene/operators/fillet.h"

/* The operator's arrays: value k is values[k * stride + i], its channels are channels[(k * per +
 * c) * stride + i], of which the first three are its gradient. Planes follow the operands: number
 * numbers[operands + p] of those that the operator had once; an operand reaches beyond it by
 * parameters[numbers[operand] + number]. */
typedef struct fillet_arrays {
    float *values, *channels;
    const uint32_t *numbers;
    const float *parameters;
    size_t stride;
    uint32_t per, operands, planes;
    float turn; /* -1: an intersection, the union of what is negated */
    double radius;
    const float *to_own; /* where angles are other ones in the fillet's own frame, else NULL */
    bool has_apart;      /* some operands do not meet */
    uint32_t own_number; /* where in an operand's row that is */
} fillet_arrays;

/* Where the operator's children, the last of which is the node before it, have their numbers. */
static void fillet_numbers(const csg_tape *tape, const csg_tape_node *node, uint32_t *numbers)
{
    const csg_tape_node *child = node - 1;
    bool is_asked = node->planes || tape->parameters[node->parameters + CSG_FILLET_HAS_APART] > 0;
    for (uint32_t k = node->arity; k-- > 0 && is_asked; child -= child->size)
        numbers[k] = child->join_parameters;
}

static inline float *fillet_channel(const fillet_arrays *a, uint32_t operand, uint32_t channel)
{
    return a->channels + ((size_t)operand * a->per + channel) * a->stride;
}

/* How the operands mix at a point: nothing but the first where the count is 1. Where it is ended,
 * the gradient is that of a plane. */
typedef struct fillet_mix {
    float value, share[3];
    uint32_t at[3], count, plane;
    int is_ended;
} fillet_mix;

typedef struct fillet_place {
    const fillet_arrays *arrays;
    size_t i;
} fillet_place;

static double fillet_inside(const void *user, const csg_fillet_operand *operands,
                            const csg_fillet_choice *subset, uint32_t *plane)
{
    const fillet_place *place = user;
    const fillet_arrays *a = place->arrays;
    double least = INFINITY;
    for (uint32_t p = a->operands; p < a->operands + a->planes; p++) {
        float beyond = -INFINITY;
        for (uint32_t k = 0; k < subset->count; k++)
            beyond = larger(
                beyond, a->parameters[a->numbers[operands[subset->at[k]].index] + a->numbers[p]]);
        double inside = (double)(a->turn * a->values[p * a->stride + place->i]) + (double)beyond;
        *plane = inside < least ? p : *plane;
        least = inside < least ? inside : least;
    }
    return least;
}

static bool fillet_are_apart(const fillet_arrays *a, uint32_t one, uint32_t other)
{
    return csg_fillet_rows_apart(a->parameters, a->numbers[one], a->numbers[other], a->own_number);
}

static bool fillet_apart(const void *user, const csg_fillet_operand *a, const csg_fillet_operand *b)
{
    const fillet_place *place = user;
    return fillet_are_apart(place->arrays, a->index, b->index);
}

static fillet_mix fillet_largest(const fillet_arrays *a, size_t i)
{
    fillet_mix mix = {.value = a->turn * a->values[i], .share = {1, 0, 0}, .count = 1};
    for (uint32_t k = 1; k < a->operands; k++) {
        float v = a->turn * a->values[k * a->stride + i];
        mix.at[0] = v > mix.value ? k : mix.at[0];
        mix.value = v > mix.value ? v : mix.value;
    }
    return mix;
}

/* Operands within reach of the largest, in the order of fillet.h; returns how many. */
static uint32_t fillet_gather(const fillet_arrays *a, size_t i, float largest,
                              csg_fillet_operand reach[CSG_FILLET_MOST])
{
    uint32_t count = 0;
    for (uint32_t k = 0; k < a->operands; k++) {
        double v = (double)(a->turn * a->values[k * a->stride + i]);
        csg_fillet_operand made = {.index = k};
        double x = (double)fillet_channel(a, k, 0)[i], y = (double)fillet_channel(a, k, 1)[i],
               z = (double)fillet_channel(a, k, 2)[i];
        fillet_into_own(a->to_own, &x, &y, &z);
        if ((double)largest - v < 2 * a->radius &&
            csg_fillet_set(&made, v, (double)a->turn * x, (double)a->turn * y, (double)a->turn * z))
            count = csg_fillet_insert(reach, count, &made);
    }
    return count;
}

static fillet_mix fillet_at(const fillet_arrays *a, size_t i)
{
    csg_fillet_operand reach[CSG_FILLET_MOST];
    fillet_mix mix = fillet_largest(a, i);
    uint32_t count = fillet_gather(a, i, mix.value, reach);
    if (!count)
        return mix;
    fillet_place place = {a, i};
    csg_fillet_ends ends = {.inside = a->planes ? fillet_inside : NULL,
                            .user = &place,
                            .apart = a->has_apart ? fillet_apart : NULL};
    csg_fillet_choice best = csg_fillet_solve(a->radius, reach, count, &ends);
    double level = reach[0].f + best.excess;
    if (!(level > (double)mix.value)) {
        if ((float)reach[0].f == mix.value) /* of equal ones the first in order */
            mix.at[0] = reach[0].index;
        return mix;
    }
    mix.value = (float)level;
    mix.count = best.count;
    mix.is_ended = best.is_ended;
    mix.plane = best.plane;
    float rest = 1;
    for (uint32_t k = best.count; k-- > 0;) {
        mix.at[k] = reach[best.at[k]].index;
        mix.share[k] = k ? (float)best.share[k] : rest;
        rest -= mix.share[k];
    }
    return mix;
}

static float fillet_mean(const fillet_arrays *a, const fillet_mix *mix, uint32_t channel, size_t i)
{
    float out = fillet_channel(a, mix->at[0], channel)[i];
    if (mix->count > 1)
        out = mix->share[0] * out + mix->share[1] * fillet_channel(a, mix->at[1], channel)[i];
    if (mix->count > 2)
        out += mix->share[2] * fillet_channel(a, mix->at[2], channel)[i];
    return out;
}

/* How far the operand that reaches farthest does so beyond the plane. */
static float fillet_beyond(const fillet_arrays *a, uint32_t plane)
{
    float most = -INFINITY;
    for (uint32_t k = 0; k < a->operands; k++)
        most = larger(most, a->parameters[a->numbers[k] + a->numbers[plane]]);
    return most;
}

/* Shares of a pair's operands, value by value; those of points where they are equal as fillet_at
 * has them. */
static void fillet_pair_shares(const fillet_arrays *a, size_t count, const fillet_pairs *pairs,
                               float *restrict value, float *restrict shares[2],
                               float *restrict plane)
{
    const float *first = a->values, *second = a->values + a->stride;
    for (size_t i = 0; i < count; i++) {
        float v = a->turn * first[i], w = a->turn * second[i];
        double level = pairs->largest[i] + pairs->excess[i];
        bool blends = (pairs->excess[i] > 0) & (level > pairs->largest[i]);
        float lower = blends ? pairs->lower[i] : 0, higher = 1.0f - lower;
        value[i] = blends ? (float)level : larger(w, v);
        shares[0][i] = w > v ? lower : higher;
        shares[1][i] = w > v ? higher : lower;
        plane[i] = blends ? pairs->plane[i] : 0;
    }
    for (size_t i = 0; i < count; i++)
        if (first[i] == second[i]) {
            fillet_mix mix = fillet_at(a, i);
            value[i] = mix.value;
            plane[i] = mix.is_ended ? (float)mix.plane : 0;
            shares[0][i] = shares[1][i] = 0;
            for (uint32_t k = 0; k < mix.count; k++)
                shares[mix.at[k]][i] = mix.share[k];
        }
}

/* As fillet_combine, of two operands. */
static void fillet_combine_pair(const fillet_arrays *a, int slopes, int colors, size_t count)
{
    fillet_pairs pairs;
    float value[CSG_BATCH], first[CSG_BATCH], second[CSG_BATCH], plane[CSG_BATCH];
    float *shares[2] = {first, second};
    const float *const gradients[2][3] = {
        {fillet_channel(a, 0, 0), fillet_channel(a, 0, 1), fillet_channel(a, 0, 2)},
        {fillet_channel(a, 1, 0), fillet_channel(a, 1, 1), fillet_channel(a, 1, 2)},
    };
    if (a->to_own) /* a loop of its own: few are skewed */
        fillet_pairs_blend(a->to_own, a->turn, a->radius, a->values, a->values + a->stride,
                           gradients, count, &pairs);
    else
        fillet_pairs_blend(NULL, a->turn, a->radius, a->values, a->values + a->stride, gradients,
                           count, &pairs);
    if (a->has_apart && fillet_are_apart(a, 0, 1))
        for (size_t i = 0; i < count; i++)
            pairs.excess[i] = 0;
    for (size_t i = 0; i < count; i++) {
        pairs.end[i] = INFINITY;
        pairs.plane[i] = 0;
    }
    for (uint32_t p = 2; p < 2 + a->planes; p++)
        fillet_pairs_meet(a->turn, (float)p, fillet_beyond(a, p), a->values + p * a->stride, count,
                          &pairs);
    if (a->planes)
        fillet_pairs_end(count, &pairs);
    fillet_pair_shares(a, count, &pairs, value, shares, plane);
    for (uint32_t c = 0; c < (uint32_t)(slopes + colors); c++) {
        float *restrict u = fillet_channel(a, 0, c);
        const float *restrict v = fillet_channel(a, 1, c);
        for (size_t i = 0; i < count; i++) {
            float both = first[i] * u[i] + second[i] * v[i];
            both = second[i] == 0 ? u[i] : both;
            u[i] = first[i] == 0 ? v[i] : both;
        }
        for (uint32_t p = 2; p < 2 + a->planes && c < (uint32_t)slopes; p++) {
            const float *restrict end = fillet_channel(a, p, c);
            for (size_t i = 0; i < count; i++)
                u[i] = plane[i] == (float)p ? end[i] : u[i];
        }
    }
    for (size_t i = 0; i < count; i++)
        a->values[i] = a->turn * value[i];
}

/* The result takes the place of the first operand: value, `slopes` channels, where it ends those
 * of the plane, and `colors` more. */
static void fillet_combine(const fillet_arrays *a, int slopes, int colors, size_t count)
{
    if (a->operands == 2) {
        fillet_combine_pair(a, slopes, colors, count);
        return;
    }
    for (size_t i = 0; i < count; i++) {
        fillet_mix mix = fillet_at(a, i);
        for (uint32_t c = 0; c < (uint32_t)(slopes + colors); c++)
            fillet_channel(a, 0, c)[i] = mix.is_ended && c < (uint32_t)slopes
                                             ? fillet_channel(a, mix.plane, c)[i]
                                             : fillet_mean(a, &mix, c, i);
        a->values[i] = a->turn * mix.value;
    }
}

static float fillet_least_beyond(const fillet_arrays *a, uint32_t plane)
{
    float least = INFINITY;
    for (uint32_t k = 0; k < a->operands; k++)
        least = smaller(least, a->parameters[a->numbers[k] + a->numbers[plane]]);
    return least;
}

/* The three largest of the operands' ends in cube o. */
static void fillet_three(const fillet_arrays *a, const float *ends, size_t o, float most[3])
{
    most[0] = most[1] = most[2] = -INFINITY;
    for (uint32_t k = 0; k < a->operands; k++) {
        float v = a->turn * ends[k * a->stride + o];
        for (int place = 0; place < 3; place++)
            if (v > most[place]) {
                float next = most[place];
                most[place] = v;
                v = next;
            }
    }
}

/* What the operands' ranges allow, for eight cubes; low and high: a slot per operand and plane, the
 * result in the first. turns: least and most 1 - cos of the operands' angles for each cube; NULL:
 * any. */
static void fillet_intervals(const fillet_arrays *a, const float *turns, float *low, float *high)
{
    const float turn = a->turn;
    float *lower = turn > 0 ? low : high, *upper = turn > 0 ? high : low;
    for (size_t o = 0; o < CSG_OCTANTS; o++) {
        float most[3], least[3], end = INFINITY, first_end = INFINITY;
        fillet_three(a, upper, o, most);
        fillet_three(a, lower, o, least);
        for (uint32_t p = a->operands; p < a->operands + a->planes; p++) {
            end = smaller(end, turn * upper[p * a->stride + o] + fillet_beyond(a, p));
            first_end =
                smaller(first_end, turn * lower[p * a->stride + o] + fillet_least_beyond(a, p));
        }
        double from = turns ? (double)turns[2 * o] : 0, to = turns ? (double)turns[2 * o + 1] : 2;
        double bound = csg_fillet_bound(a->radius, (double)most[0] - (double)most[1],
                                        (double)most[0] - (double)most[2], to);
        double sure = csg_fillet_least(a->radius, (double)least[0] - (double)least[1], from, to);
        sure = a->has_apart ? 0 : sure;
        float top = bound > 0 ? most[0] + (float)(bound + 1e-6 * a->radius) : most[0];
        float bottom = sure > 0 ? least[0] + (float)(sure - 1e-6 * a->radius) : least[0];
        lower[o] = turn * larger(least[0], smaller(bottom, first_end));
        upper[o] = turn * larger(most[0], smaller(top, end));
    }
}

#endif
