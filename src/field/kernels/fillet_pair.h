/* SPDX-License-Identifier: MIT
 * A fillet of two operands, which is what pruning leaves of nearly all: a batch at a time, in loops
 * that become vectors. The same bits as fillet_at of fillet_kernel.h, which answers where two
 * operands are equal and their gradients say which comes first. Part of fillet_kernel.h, in a file
 * of its own.
 */
#ifndef CSG_FIELD_FILLET_PAIR_H
#define CSG_FIELD_FILLET_PAIR_H

#include <math.h>

#include "field/kernels/batch.h"
#include "scene/operators/fillet.h"

/* For each point the larger operand, what the fillet adds to it (0: it does not blend), the share
 * of the lower one, and the plane where it ends, 0 where it does not. */
typedef struct fillet_pairs {
    double largest[CSG_BATCH], excess[CSG_BATCH], end[CSG_BATCH];
    float lower[CSG_BATCH], plane[CSG_BATCH];
} fillet_pairs;

/* A gradient in the fillet's own frame, whose rows are in m; NULL: angles are the same there. */
static inline void fillet_into_own(const float *m, double *x, double *y, double *z)
{
    if (!m)
        return;
    double u = *x, v = *y, w = *z;
    *x = (double)m[0] * u + (double)m[1] * v + (double)m[2] * w;
    *y = (double)m[3] * u + (double)m[4] * v + (double)m[5] * w;
    *z = (double)m[6] * u + (double)m[7] * v + (double)m[8] * w;
}

static inline bool fillet_set_one(csg_fillet_operand *o, const float *m, float turn,
                                  const float *const g[3], size_t i)
{
    double sign = (double)turn, x = (double)g[0][i], y = (double)g[1][i], z = (double)g[2][i];
    fillet_into_own(m, &x, &y, &z);
    return csg_fillet_set(o, 0, sign * x, sign * y, sign * z);
}

/* 1 - cos of the angle between two gradients; 0, where nothing blends, if one is missing. */
static inline double fillet_turn_of(const float *m, float turn, const float *const a[3],
                                    const float *const b[3], size_t i)
{
    csg_fillet_operand p, q;
    bool both = fillet_set_one(&p, m, turn, a, i) & fillet_set_one(&q, m, turn, b, i);
    double d = csg_fillet_turn(&p, &q);
    return both ? d : 0;
}

/* gradients: of both operands. */
static inline void fillet_pairs_blend(const float *to_own, float turn, double radius,
                                      const float *restrict first, const float *restrict second,
                                      const float *const gradients[2][3], size_t count,
                                      fillet_pairs *restrict out)
{
    for (size_t i = 0; i < count; i++) {
        double a = (double)(turn * first[i]), b = (double)(turn * second[i]);
        double d = fillet_turn_of(to_own, turn, gradients[0], gradients[1], i);
        double top = b > a ? b : a, x = b > a ? b - a : a - b;
        csg_fillet_pair made = csg_fillet_of_two(radius, x, d);
        out->largest[i] = top;
        out->excess[i] = made.excess;
        out->lower[i] = (float)made.lower;
    }
}

/* The nearest of the planes that hold both operands, number `plane`, beyond which both reach by
 * `beyond` at most. */
static void fillet_pairs_meet(float turn, float plane, float beyond, const float *restrict values,
                              size_t count, fillet_pairs *restrict out)
{
    for (size_t i = 0; i < count; i++) {
        double inside = (double)(turn * values[i]) + (double)beyond;
        out->plane[i] = inside < out->end[i] ? plane : out->plane[i];
        out->end[i] = inside < out->end[i] ? inside : out->end[i];
    }
}

/* Cuts what is added where the nearest plane is. */
static void fillet_pairs_end(size_t count, fillet_pairs *restrict out)
{
    for (size_t i = 0; i < count; i++) {
        double end = out->end[i] - out->largest[i];
        bool is_ended = end < out->excess[i];
        double excess = is_ended ? end : out->excess[i];
        out->plane[i] = is_ended ? out->plane[i] : 0;
        out->excess[i] = excess;
    }
}

#endif
