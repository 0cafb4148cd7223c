/* SPDX-License-Identifier: MIT
 * The round operator: all operands at once (operators.md 12). Part of kernel.c, in a file of its
 * own.
 */
#ifndef CSG_FIELD_ROUND_KERNEL_H
#define CSG_FIELD_ROUND_KERNEL_H

#include <math.h>
#include <string.h>

#include "base/select.h"
#include "field/kernels/batch.h"

/* G - max for the first m operands, from the sums of u_i = max - f_i and of u_i^2. Never below 0.
 */
static inline float round_excess(float w, float m, float sum, float squares)
{
    float mean = sum / m;
    float rest = w * w - (squares - sum * mean);
    return larger(w - mean - sqrtf(larger(rest, 0) / m), 0);
}

/* Operands are f[k * stride + i]. Turns them into gaps u = max - f (in place), and leaves the
 * largest in top and G - max in excess. For intersections f is negated first. work: another
 * arity * stride floats, and 4 * stride more. */
static void round_solve(float *restrict f, size_t stride, uint32_t arity, int is_union, float w,
                        size_t count, float *restrict top, float *restrict excess,
                        float *restrict work)
{
    for (uint32_t k = 0; k < arity; k++) {
        float *restrict v = f + k * stride;
        if (!is_union)
            for (size_t i = 0; i < count; i++)
                v[i] = -v[i];
        if (k == 0)
            memcpy(top, v, count * sizeof(float));
        else
            for (size_t i = 0; i < count; i++)
                top[i] = larger(top[i], v[i]);
    }
    for (uint32_t k = 0; k < arity; k++) {
        float *restrict v = f + k * stride;
        for (size_t i = 0; i < count; i++)
            v[i] = top[i] - v[i];
    }
    if (arity == 2) { /* what the general walk below gives for two operands, bit for bit */
        for (size_t i = 0; i < count; i++) {
            float u = f[i] + f[stride + i]; /* one of them is 0 */
            excess[i] = w - u > 0 ? round_excess(w, 2.0f, u, u * u) : 0;
        }
        return;
    }
    float *restrict rest = work, *restrict sum = work + arity * stride,
                    *restrict squares = sum + stride, *restrict next = squares + stride,
                    *restrict taken = next + stride;
    uint32_t left = 0; /* operands that are active somewhere: gaps of others never reach w */
    for (uint32_t k = 0; k < arity; k++) {
        const float *restrict v = f + k * stride;
        float reaches = 0;
        for (size_t i = 0; i < count; i++)
            reaches = w - v[i] > 0 ? 1.0f : reaches;
        if (reaches > 0)
            memcpy(rest + left++ * stride, v, count * sizeof(float));
    }
    for (size_t i = 0; i < count; i++)
        sum[i] = squares[i] = excess[i] = 0;
    /* The active prefix: operands by growing gap, until one does not reach G. A lane that has
     * stopped stays: its next gap is no smaller. */
    for (uint32_t m = 1; m <= left; m++) {
        for (size_t i = 0; i < count; i++) {
            next[i] = INFINITY;
            taken[i] = 0;
        }
        for (uint32_t k = 0; k < left; k++)
            for (size_t i = 0; i < count; i++)
                next[i] = smaller(next[i], rest[k * stride + i]);
        for (uint32_t k = 0; k < left; k++)
            for (size_t i = 0; i < count; i++) {
                int hit = (rest[k * stride + i] == next[i]) & (taken[i] == 0);
                rest[k * stride + i] = hit ? INFINITY : rest[k * stride + i];
                taken[i] = hit ? 1.0f : taken[i];
            }
        if (m == 1)
            continue; /* the largest operand itself: gap 0, excess 0 */
        float reached = 0;
        for (size_t i = 0; i < count; i++) {
            int active = w - next[i] > excess[i];
            float u = active ? next[i] : 0;
            sum[i] += u;
            squares[i] += u * u;
            excess[i] = active ? round_excess(w, (float)m, sum[i], squares[i]) : excess[i];
            reached = active ? 1.0f : reached;
        }
        if (reached == 0)
            break;
    }
}

/* A term of a sum that must not depend on the order of its terms: a multiple of 2^-32 of the size,
 * which doubles add without rounding. */
static inline double grain(double term, double size)
{
    const double large = 0x1.8p20 * size;
    return (term + large) - large;
}

/* Where more than two operands are active, out of their weights. */
static void total_of_many(const float *weights, size_t stride, uint32_t arity, float w,
                          const float *active, float *total, size_t count)
{
    double sum[CSG_BATCH];
    for (size_t i = 0; i < count; i++)
        sum[i] = 0;
    for (uint32_t k = 0; k < arity; k++)
        for (size_t i = 0; i < count; i++)
            sum[i] += grain((double)weights[k * stride + i], (double)w);
    for (size_t i = 0; i < count; i++)
        total[i] = active[i] > 2 ? (float)sum[i] : total[i];
}

/* The same of a channel. */
static void mean_of_many(const float *shares, size_t stride, uint32_t arity, const float *in,
                         size_t in_stride, float *mean, size_t count)
{
    double sum[CSG_BATCH];
    for (size_t i = 0; i < count; i++)
        sum[i] = 0;
    for (uint32_t k = 0; k < arity; k++)
        for (size_t i = 0; i < count; i++)
            sum[i] += grain((double)(shares[k * stride + i] * in[k * in_stride + i]), 1);
    for (size_t i = 0; i < count; i++)
        mean[i] = (float)sum[i];
}

static int is_any_above(const float *array, float most, size_t count)
{
    float found = 0;
    for (size_t i = 0; i < count; i++)
        found = array[i] > most ? 1.0f : found;
    return found > 0;
}

#endif
