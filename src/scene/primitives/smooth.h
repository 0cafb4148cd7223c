/* SPDX-License-Identifier: MIT
 * A primitive's field in a ball where it is smooth, as a Taylor model (base/taylor.h): where one
 * formula holds, that of the nearest face, edge, corner or axis. The primitives' own files say
 * which it is. All is in the coordinates in which the ball is; the primitive's own are linear
 * functions of them.
 */
#ifndef CSG_SCENE_SMOOTH_H
#define CSG_SCENE_SMOOTH_H

#include <math.h>

#include "base/taylor.h"

/* A function and, where they are asked for, its derivatives; else g holds nothing. */
typedef struct csg_smooth {
    csg_taylor f, g[3];
} csg_smooth;

/* A leaf in its own frame. */
typedef struct csg_smooth_leaf {
    const float *own; /* parameters as packed */
    csg_smooth p[3];  /* own coordinates */
    double radius;    /* of the ball */
    double reach;     /* own coordinates in the ball are no farther from those at its centre */
    bool with_slopes;
} csg_smooth_leaf;

csg_smooth csg_smooth_sum(const csg_smooth_leaf *l, const csg_smooth *a, double factor,
                          const csg_smooth *b);
csg_smooth csg_smooth_scaled(const csg_smooth_leaf *l, double factor, const csg_smooth *a);
/* by + factor a. */
static inline csg_smooth csg_smooth_line(const csg_smooth_leaf *l, double by, double factor,
                                         const csg_smooth *a)
{
    csg_smooth out = csg_smooth_scaled(l, factor, a);
    out.f.value += by;
    return out;
}

/* The length of the vector of these. False: it may be 0 in the ball. */
bool csg_smooth_norm(const csg_smooth_leaf *l, const csg_smooth *const *u, int count,
                     csg_smooth *out);

static inline bool csg_smooth_is_positive(const csg_smooth_leaf *l, const csg_smooth *a)
{
    return csg_taylor_least(&a->f, l->radius) > 0;
}
static inline bool csg_smooth_is_negative(const csg_smooth_leaf *l, const csg_smooth *a)
{
    return csg_taylor_most(&a->f, l->radius) < 0;
}
/* Is a larger than b all over the ball? */
static inline bool csg_smooth_is_above(const csg_smooth_leaf *l, const csg_smooth *a,
                                       const csg_smooth *b)
{
    csg_taylor d = csg_taylor_sum(&a->f, -1, &b->f);
    return csg_taylor_least(&d, l->radius) > 0;
}

/* round less the distance from a box over the first `axes` axes with these half sizes. */
bool csg_smooth_of_box(const csg_smooth_leaf *l, const float *half, double round, int axes,
                       csg_smooth *out);

/* The distance from the z axis. */
static inline bool csg_smooth_radial(const csg_smooth_leaf *l, csg_smooth *out)
{
    const csg_smooth *const across[2] = {&l->p[0], &l->p[1]};
    return csg_smooth_norm(l, across, 2, out);
}

#endif
