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

enum { CSG_SMOOTH_WAYS = 4, CSG_SMOOTH_CONDITIONS = 3 };

/* Of several formulas one, in a ball in which no one holds all over: it is the field, or where
 * `signs` says that this is enough has its sign, wherever no condition is negative; and everywhere
 * one of the ways is. */
typedef struct csg_smooth_choice {
    bool signs;    /* inside and outside matter alone, and what is inside is so in the end */
    bool at_zero;  /* inside and outside of the primitive itself matter alone */
    bool at_level; /* whether the primitive's value is above `level` or below matters alone */
    double level;
    double stretch;  /* out: where at_level, errors of the primitive's own values count so often */
    int way;         /* which one is asked for */
    int ways;        /* out: how many there are */
    bool is_creased; /* out: the field's gradient may jump in the ball, from one of them to another
                      */
    csg_taylor conditions[CSG_SMOOTH_CONDITIONS];
    int condition_count;
} csg_smooth_choice;

/* A leaf in its own frame. */
typedef struct csg_smooth_leaf {
    const double *own; /* parameters as packed */
    csg_smooth p[3];   /* own coordinates */
    double radius;     /* of the ball */
    double reach;      /* own coordinates in the ball are no farther from those at its centre */
    bool with_slopes;
    csg_smooth_choice *choice; /* NULL: one formula has to hold all over the ball */
} csg_smooth_leaf;

/* The `way`th of these that are possible; -1: it is none. */
static inline int csg_smooth_choose(const csg_smooth_leaf *l, const bool *possible, int count)
{
    csg_smooth_choice *c = l->choice;
    int found = -1;
    c->ways = 0;
    for (int i = 0; i < count; i++)
        if (possible[i] && c->ways++ == c->way)
            found = i;
    return found;
}

/* factor g is not negative where the formula holds. */
static inline void csg_smooth_require(const csg_smooth_leaf *l, double factor, const csg_smooth *g)
{
    csg_smooth_choice *c = l->choice;
    if (c->condition_count < CSG_SMOOTH_CONDITIONS)
        c->conditions[c->condition_count++] = csg_taylor_scaled(&g->f, factor);
}

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

/* `round` less that length, or what is above the level where that is. */
bool csg_smooth_round(const csg_smooth_leaf *l, double round, const csg_smooth *const *u, int count,
                      csg_smooth *out);

/* A function of own coordinates that has this value at the ball's centre and is nowhere steeper
 * than 1: no more is known of it. That is enough for a blend in which it has little part. Only of
 * leaves that have a choice. False: derivatives are asked for, or signs, of which this tells none
 * that is of use. */
bool csg_smooth_steepest(const csg_smooth_leaf *l, double value, csg_smooth *out);

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
bool csg_smooth_of_box(const csg_smooth_leaf *l, const double *half, double round, int axes,
                       csg_smooth *out);

/* The distance from the z axis. */
static inline bool csg_smooth_radial(const csg_smooth_leaf *l, csg_smooth *out)
{
    const csg_smooth *const across[2] = {&l->p[0], &l->p[1]};
    return csg_smooth_norm(l, across, 2, out);
}

#endif
