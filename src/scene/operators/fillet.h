/* SPDX-License-Identifier: MIT
 * The fillet: the union of k operands as a ball of radius r that rolls along all of them leaves it
 * (operators.md 16). Operands are values f_i (f > 0 inside) with unit gradients g_i; F is the level
 * at which the ball rests: the smallest G for which some |s| <= r has -g_i . s >= r + f_i - G for
 * all i. That is the largest over all subsets of one, two or three operands, each taken as if all
 * of it were touched, with multipliers >= 0.
 *
 * How far two faces turn from each other is d = 1 - cos = |g_1 - g_2|^2 / 2: 0 where one continues
 * the other, 1 at a right angle, 2 where they look at each other. All is in double, also where
 * kernels use it: the same bits for the reference, for every instruction set, and whether or not
 * operands out of reach have been dropped.
 */
#ifndef CSG_SCENE_FILLET_H
#define CSG_SCENE_FILLET_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

/* Operands that blend at one point: the largest of those in reach. */
enum { CSG_FILLET_MOST = 16 };

/* Where the radius fades, since solids that do not meet stay apart: from CSG_FILLET_FADE on, and
 * gone CSG_FILLET_FADES later. */
#define CSG_FILLET_FADE 1.7
#define CSG_FILLET_FADES 0.25
/* The largest excess of two operands over the larger one (where d is 1.71), and the largest
 * difference at which two blend (d = 1.71 too), for r = 1, rounded up. Of more operands: 1 and 2.
 */
#define CSG_FILLET_PAIR_EXCESS 0.6199
#define CSG_FILLET_PAIR_REACH 1.7037

/* Below this the normals of three operands lie in one plane, and pairs say all. */
#define CSG_FILLET_FLAT 1e-9

static inline double csg_fillet_larger(double a, double b)
{
    return a > b ? a : b;
}

static inline double csg_fillet_smaller(double a, double b)
{
    return a < b ? a : b;
}

/* What is left of the radius. */
static inline double csg_fillet_fade(double d)
{
    double t = (d - CSG_FILLET_FADE) / CSG_FILLET_FADES;
    t = csg_fillet_smaller(csg_fillet_larger(t, 0), 1);
    return 1 - t * t * (3 - 2 * t);
}

/* What two operands that differ by x >= 0 add to the larger one, and the share of the lower one in
 * the gradient. */
typedef struct csg_fillet_pair {
    double excess, lower;
} csg_fillet_pair;

static inline csg_fillet_pair csg_fillet_of_two(double radius, double x, double d)
{
    double r = radius * csg_fillet_fade(d), gap = r * d - x;
    bool blends = gap > 0; /* so d > 0 */
    double turn = blends ? d : 1;
    double root = sqrt(csg_fillet_larger((2 - turn) * (2 * r * r - x * x / turn), 0));
    double excess = gap * gap / (turn * (2 * r - x + root));
    double lower = 0.5 - (2 - turn) * x / (2 * turn * root);
    blends = blends & (root > 0);
    return (csg_fillet_pair){blends ? excess : 0, blends ? csg_fillet_larger(lower, 0) : 0};
}

/* An operand at a point; `index`: which one it is. */
typedef struct csg_fillet_operand {
    double f, g[3];
    float length; /* of the gradient before it was made a unit vector */
    uint32_t index;
} csg_fillet_operand;

/* The subset that decides, in the order of the operands given, and by how much it exceeds the
 * largest operand; shares of the gradient, which add up to 1. */
typedef struct csg_fillet_choice {
    double excess, share[3];
    uint32_t at[3], count;
    bool is_ended; /* at a plane that holds the subset: the gradient is the plane's */
    uint32_t plane;
} csg_fillet_choice;

/* How far inside of the nearest of those half-spaces that hold all of a subset the point is, and
 * which it is: what a ball fills that rolls along some operands lies in the convex hull of these
 * (union_ends.h). */
typedef struct csg_fillet_ends {
    double (*inside)(const void *user, const csg_fillet_operand *operands,
                     const csg_fillet_choice *subset, uint32_t *plane);
    const void *user;
    /* Whether the solids of two operands do not meet: then they do not blend (apart.h). */
    bool (*apart)(const void *user, const csg_fillet_operand *a, const csg_fillet_operand *b);
} csg_fillet_ends;

static inline double csg_fillet_turn(const csg_fillet_operand *a, const csg_fillet_operand *b)
{
    double x = a->g[0] - b->g[0], y = a->g[1] - b->g[1], z = a->g[2] - b->g[2];
    return 0.5 * (x * x + y * y + z * z);
}

/* Makes the gradient (x, y, z) of a value that of an operand; false: it has none, and does not
 * blend. What is shorter than 1e-6 is the rounding of floats: a field may be flat (below a taper,
 * say), and its direction would be any. */
static inline bool csg_fillet_set(csg_fillet_operand *o, double f, double x, double y, double z)
{
    double square = x * x + y * y + z * z, length = sqrt(square);
    bool is_there = square > 1e-12 && square < 1e24;
    double inverse = is_there ? 1 / length : 0;
    o->f = f;
    o->g[0] = x * inverse;
    o->g[1] = y * inverse;
    o->g[2] = z * inverse;
    o->length = (float)length;
    return is_there;
}

/* The order that does not depend on that of the operands: larger ones first, equal ones by their
 * gradients. */
static inline bool csg_fillet_precedes(const csg_fillet_operand *a, const csg_fillet_operand *b)
{
    if (a->f != b->f)
        return a->f > b->f;
    for (int i = 0; i < 3; i++)
        if (a->g[i] != b->g[i])
            return a->g[i] > b->g[i];
    return a->length > b->length;
}

/* Puts an operand into its place among the `count` largest; returns how many there are then. */
static inline uint32_t csg_fillet_insert(csg_fillet_operand *operands, uint32_t count,
                                         const csg_fillet_operand *made)
{
    uint32_t at = count;
    if (count == CSG_FILLET_MOST) {
        if (!csg_fillet_precedes(made, &operands[count - 1]))
            return count;
        at = count - 1;
    }
    uint32_t after = at + 1;
    for (; at > 0 && csg_fillet_precedes(made, &operands[at - 1]); at--)
        operands[at] = operands[at - 1];
    operands[at] = *made;
    return after > count ? after : count;
}

/* Three planes touched at once: (b - G)^T C^-1 (b - G) = r^2 with b_i = r + f_i and C the cosines,
 * the smaller root G, with C^-1 (b - G) >= 0. False: they are not, or lie in one plane. */
static inline bool csg_fillet_of_three(double radius, const csg_fillet_operand *o,
                                       const uint32_t at[3], double *excess, double share[3])
{
    const csg_fillet_operand *p = &o[at[0]], *q = &o[at[1]], *s = &o[at[2]];
    double dpq = csg_fillet_turn(p, q), dps = csg_fillet_turn(p, s), dqs = csg_fillet_turn(q, s);
    double r = radius * csg_fillet_fade(csg_fillet_larger(dpq, csg_fillet_larger(dps, dqs)));
    double a = 1 - dpq, b = 1 - dps, c = 1 - dqs;
    double det = 1 + 2 * a * b * c - a * a - b * b - c * c;
    if (!(det >= CSG_FILLET_FLAT) || !(r > 0))
        return false;
    /* the adjugate of C, on u = f - f_0 and on 1 */
    double u1 = q->f - p->f, u2 = s->f - p->f;
    double m01 = b * c - a, m02 = a * c - b, m12 = a * b - c;
    double m00 = 1 - c * c, m11 = 1 - b * b, m22 = 1 - a * a;
    double of_u[3] = {m01 * u1 + m02 * u2, m11 * u1 + m12 * u2, m12 * u1 + m22 * u2};
    double of_1[3] = {m00 + m01 + m02, m01 + m11 + m12, m02 + m12 + m22};
    double alpha = of_1[0] + of_1[1] + of_1[2], beta = of_u[0] + of_u[1] + of_u[2];
    double gamma = u1 * of_u[1] + u2 * of_u[2] - r * r * det, under = beta * beta - alpha * gamma;
    if (!(under >= 0) || !(alpha > 0))
        return false;
    double y = (sqrt(under) - beta) / alpha, sum = 0; /* r + f_0 - G */
    for (int i = 0; i < 3; i++) {
        share[i] = of_u[i] + y * of_1[i];
        if (!(share[i] >= 0))
            return false;
        sum += share[i];
    }
    for (int i = 0; i < 3; i++)
        share[i] /= sum;
    *excess = p->f - o[0].f + (r - y);
    return sum > 0;
}

/* Takes a subset that reaches higher than the best so far, once it is cut where it ends. */
static inline void csg_fillet_take(csg_fillet_choice *best, const csg_fillet_operand *o,
                                   csg_fillet_choice made, const csg_fillet_ends *ends)
{
    if (!(made.excess > best->excess))
        return;
    if (ends->inside) {
        double end = ends->inside(ends->user, o, &made, &made.plane) - o[0].f;
        made.is_ended = end < made.excess;
        made.excess = made.is_ended ? end : made.excess;
    }
    if (made.excess > best->excess)
        *best = made;
}

static inline bool csg_fillet_are_apart(const csg_fillet_ends *ends, const csg_fillet_operand *a,
                                        const csg_fillet_operand *b)
{
    return ends->apart && ends->apart(ends->user, a, b);
}

/* Of operands in their order (csg_fillet_insert), the first of which is the largest of all. */
static inline csg_fillet_choice csg_fillet_solve(double r, const csg_fillet_operand *o,
                                                 uint32_t count, const csg_fillet_ends *ends)
{
    csg_fillet_choice best = {.share = {1, 0, 0}, .count = 1};
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t k = i + 1; k < count; k++) {
            csg_fillet_choice made = {.at = {i, k, 0}, .count = 2};
            if (csg_fillet_are_apart(ends, &o[i], &o[k]))
                continue;
            csg_fillet_pair pair =
                csg_fillet_of_two(r, o[i].f - o[k].f, csg_fillet_turn(&o[i], &o[k]));
            made.excess = o[i].f - o[0].f + pair.excess;
            made.share[0] = 1 - pair.lower;
            made.share[1] = pair.lower;
            csg_fillet_take(&best, o, made, ends);
        }
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t k = i + 1; k < count; k++)
            for (uint32_t l = k + 1; l < count; l++) {
                csg_fillet_choice made = {.at = {i, k, l}, .count = 3};
                bool apart = csg_fillet_are_apart(ends, &o[i], &o[k]) ||
                             csg_fillet_are_apart(ends, &o[i], &o[l]) ||
                             csg_fillet_are_apart(ends, &o[k], &o[l]);
                if (!apart && csg_fillet_of_three(r, o, made.at, &made.excess, made.share))
                    csg_fillet_take(&best, o, made, ends);
            }
    return best;
}

/* How far a fillet can exceed the largest operand: `second` and `third` are how far the second and
 * the third largest lie below it, `turn` is the largest d of two of them. For fixed normals F is
 * convex in the values; of three whose cosines are c at least, a convex combination of the normals
 * is at least sqrt((1 + 2 c) / 3) long. */
static inline double csg_fillet_bound(double r, double second, double third, double turn)
{
    double pair = 1 - second / (CSG_FILLET_PAIR_REACH * r), most = r, short_square;
    pair = CSG_FILLET_PAIR_EXCESS * r * csg_fillet_larger(pair, 0);
    if (turn < CSG_FILLET_FADE) {
        pair = csg_fillet_of_two(r, second < 2 * r ? second : 2 * r, turn).excess;
        short_square = csg_fillet_larger((3 - 2 * turn) / 3, 0);
        most = csg_fillet_larger(r * (1 - sqrt(short_square)), pair);
    }
    return pair + (most - pair) * csg_fillet_larger(1 - third / (2 * r), 0);
}

/* And by how much it does so at least, where all turns of two are `least` to `most`. */
static inline double csg_fillet_least(double r, double second, double least, double most)
{
    bool is_known = most < CSG_FILLET_FADE && second < 2 * r;
    return is_known ? csg_fillet_of_two(r, second, least).excess : 0;
}

#endif
