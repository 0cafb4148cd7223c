/* SPDX-License-Identifier: MIT
 * Smooth pieces; see smooth.h.
 */
#include "scene/primitives/smooth.h"

csg_smooth csg_smooth_sum(const csg_smooth_leaf *l, const csg_smooth *a, double factor,
                          const csg_smooth *b)
{
    csg_smooth out;
    out.f = csg_taylor_sum(&a->f, factor, &b->f);
    for (int k = 0; k < 3 && l->with_slopes; k++)
        out.g[k] = csg_taylor_sum(&a->g[k], factor, &b->g[k]);
    return out;
}

csg_smooth csg_smooth_scaled(const csg_smooth_leaf *l, double factor, const csg_smooth *a)
{
    csg_smooth out;
    out.f = csg_taylor_scaled(&a->f, factor);
    for (int k = 0; k < 3 && l->with_slopes; k++)
        out.g[k] = csg_taylor_scaled(&a->g[k], factor);
    return out;
}

/* The derivatives of |u| are those of u along the unit vector. */
static bool find_slopes(const csg_smooth_leaf *l, const csg_smooth *const *u, int count,
                        csg_smooth *out)
{
    csg_taylor inverse;
    if (!csg_taylor_inverse(&out->f, l->radius, &inverse))
        return false;
    for (int k = 0; k < 3; k++)
        out->g[k] = csg_taylor_constant(0);
    for (int i = 0; i < count; i++) {
        csg_taylor along = csg_taylor_product(&u[i]->f, &inverse, l->radius);
        for (int k = 0; k < 3; k++) {
            csg_taylor part = csg_taylor_product(&along, &u[i]->g[k], l->radius);
            out->g[k] = csg_taylor_sum(&out->g[k], 1, &part);
        }
    }
    return true;
}

bool csg_smooth_norm(const csg_smooth_leaf *l, const csg_smooth *const *u, int count,
                     csg_smooth *out)
{
    const csg_taylor *f[CSG_TAYLOR_MOST];
    for (int i = 0; i < count; i++)
        f[i] = &u[i]->f;
    return csg_taylor_norm(f, count, l->radius, &out->f) &&
           (!l->with_slopes || find_slopes(l, u, count, out));
}

/* With N the length and t the one at which the level is: t - N is positive where t^2 - N^2 is,
 * which is a polynomial of second order where the vector is linear, as N is not. (t^2 - N^2) / 2 t
 * is as steep at the level; elsewhere (t + N) / 2 t times t - N, and so are errors. */
static bool take_square(const csg_smooth_leaf *l, double t, const csg_smooth *const *u, int count,
                        csg_smooth *out)
{
    static const double SHARE = 0.6; /* of t: in a larger ball gradients turn too far for a graph */
    csg_taylor sum = csg_taylor_constant(-t * t);
    if (!(l->reach < SHARE * t))
        return false;
    for (int i = 0; i < count; i++) {
        csg_taylor square = csg_taylor_square(&u[i]->f, l->radius);
        sum = csg_taylor_sum(&sum, 1, &square);
    }
    double most = csg_taylor_most(&sum, l->radius) + t * t;
    l->choice->stretch = fmax(0.5 + 0.5 * sqrt(most) / t, 1) * (1 + 1e-12);
    out->f = csg_taylor_raised(csg_taylor_scaled(&sum, -0.5 / t), l->choice->level);
    return true;
}

bool csg_smooth_round(const csg_smooth_leaf *l, double round, const csg_smooth *const *u, int count,
                      csg_smooth *out)
{
    csg_smooth distance;
    if (l->choice && l->choice->at_level && !l->with_slopes &&
        take_square(l, round - l->choice->level, u, count, out))
        return true;
    if (!csg_smooth_norm(l, u, count, &distance))
        return false;
    *out = csg_smooth_line(l, round, -1, &distance);
    return true;
}

bool csg_smooth_steepest(const csg_smooth_leaf *l, double value, csg_smooth *out)
{
    const csg_taylor *const p[3] = {&l->p[0].f, &l->p[1].f, &l->p[2].f};
    if (!l->choice || l->choice->signs || l->with_slopes)
        return false;
    csg_taylor_change change = csg_taylor_change_of(p, 3, l->radius);
    l->choice->is_creased = true;
    out->f = csg_taylor_constant(value);
    out->f.error = change.most;
    out->f.turned = csg_taylor_steepest(&change, l->radius);
    return true;
}

/* ---- boxes -------------------------------------------------------------------------------------
 */

/* round less the distance from a face, an edge or a corner: where these coordinates are out. */
static bool round_of_box(const csg_smooth_leaf *l, const csg_smooth *const *out_there, int outside,
                         double round, csg_smooth *out)
{
    if (outside > 1)
        return csg_smooth_round(l, round, out_there, outside, out);
    *out = csg_smooth_line(l, round, -1, out_there[0]);
    return true;
}

/* About an edge or a corner of n faces: the distance is the largest of u . over, u being the unit
 * vectors without a negative component, inside as well as outside. From the vector v of components
 * MIDDLE these are no farther than sqrt(1 - 2 MIDDLE + n MIDDLE^2), as their components' sum is 1
 * at least, so as a function of `over` the distance leaves v . over no faster than that. MIDDLE is
 * not 1 / n, where that is least: directions, which areas need, are known closer with a longer v.
 */
static bool round_of_fan(const csg_smooth_leaf *l, const csg_smooth *const *faces, int count,
                         double value, csg_smooth *out)
{
    static const double MIDDLE = 0.7;
    const csg_taylor *over[3];
    double most = sqrt(1 - 2 * MIDDLE + count * MIDDLE * MIDDLE) * (1 + 1e-12);
    if (l->choice->signs || l->with_slopes)
        return false;
    out->f = csg_taylor_constant(0);
    for (int i = 0; i < count; i++) {
        over[i] = &faces[i]->f;
        out->f = csg_taylor_sum(&out->f, -MIDDLE, over[i]);
    }
    csg_taylor_change change = csg_taylor_change_of(over, count, l->radius);
    l->choice->is_creased = true;
    out->f.value = value;
    out->f.error += most * change.most;
    out->f.turned += most * csg_taylor_steepest(&change, l->radius);
    return true;
}

/* Inside, and about an edge, where one of two faces is the nearer one or the edge is: where a face
 * is, the other one is no farther out, and not out at all. */
static bool choose_nearer_face(const csg_smooth_leaf *l, const csg_smooth *const faces[2],
                               double round, double value, csg_smooth *out)
{
    enum { EDGE = 2, WAYS };
    csg_smooth over_other = csg_smooth_sum(l, faces[0], -1, faces[1]);
    bool may_be_out[2], possible[WAYS];
    for (int i = 0; i < 2; i++)
        may_be_out[i] = !csg_smooth_is_negative(l, faces[i]);
    possible[0] = !csg_smooth_is_negative(l, &over_other) && !csg_smooth_is_positive(l, faces[1]);
    possible[1] = !csg_smooth_is_positive(l, &over_other) && !csg_smooth_is_positive(l, faces[0]);
    possible[EDGE] = may_be_out[0] && may_be_out[1];
    int way = csg_smooth_choose(l, possible, WAYS);
    if (way < 0)
        return false;
    l->choice->is_creased = true;
    if (way == EDGE) {
        for (int i = 0; i < 2; i++)
            csg_smooth_require(l, 1, faces[i]);
        return round_of_box(l, faces, 2, round, out) || round_of_fan(l, faces, 2, value, out);
    }
    csg_smooth_require(l, way ? -1 : 1, &over_other);
    if (may_be_out[1 - way])
        csg_smooth_require(l, -1, faces[1 - way]);
    return round_of_box(l, &faces[way], 1, round, out);
}

/* Of an axis' two planes: the distance out of the box from the one that is nearer at the ball's
 * centre, and from the other one. */
typedef struct box_axis {
    csg_smooth over, other;
    bool is_nearer; /* all over the ball */
    bool is_inside; /* it is between both all over the ball */
} box_axis;

static box_axis find_axis(const csg_smooth_leaf *l, double half, const csg_smooth *p)
{
    double side = p->f.value < 0 ? -1 : 1;
    box_axis a;
    a.over = csg_smooth_line(l, -half, side, p);
    a.other = csg_smooth_line(l, -half, -side, p);
    a.is_nearer = csg_smooth_is_positive(l, p) || csg_smooth_is_negative(l, p);
    a.is_inside = csg_smooth_is_negative(l, &a.over) && csg_smooth_is_negative(l, &a.other);
    return a;
}

/* Its faces are nowhere in the ball as near as that one. */
static bool is_behind(const csg_smooth_leaf *l, const box_axis *a, const csg_smooth *face)
{
    return a->is_inside && csg_smooth_is_above(l, face, &a->over) &&
           (a->is_nearer || csg_smooth_is_above(l, face, &a->other));
}

/* Which coordinates are out is open for one or two of them. Where only the sign matters a face
 * alone stands for the inside, too. */
static bool choose_of_box(const csg_smooth_leaf *l, const box_axis *of, int axes, double round,
                          csg_smooth *out)
{
    enum { OPEN_MOST = 2 };
    const csg_smooth *out_there[3], *open[OPEN_MOST];
    bool possible[1 << OPEN_MOST];
    int outside = 0, open_count = 0;
    for (int i = 0; i < axes; i++) {
        if (csg_smooth_is_positive(l, &of[i].over))
            out_there[outside++] = &of[i].over;
        else if (csg_smooth_is_negative(l, &of[i].over))
            continue;
        else if (open_count == OPEN_MOST)
            return false;
        else
            open[open_count++] = &of[i].over;
    }
    for (int i = 0; i < 1 << open_count; i++)
        possible[i] = i || outside;
    int way = csg_smooth_choose(l, possible, 1 << open_count);
    if (way < 0)
        return false;
    bool is_alone = !outside && !(way & (way - 1));
    for (int i = 0; i < open_count; i++) {
        bool is_out = way >> i & 1;
        if (is_out)
            out_there[outside++] = open[i];
        if (!is_out || !is_alone)
            csg_smooth_require(l, is_out ? 1 : -1, open[i]);
    }
    return round_of_box(l, out_there, outside, round, out);
}

/* A face where one coordinate is farther out than the others, which are inside; an edge or a corner
 * where two or three are out; else, if there is a choice, what may be either. value: the box's at
 * the ball's centre. */
static bool find_of_box(const csg_smooth_leaf *l, const box_axis *of, int axes, int widest,
                        double round, double value, csg_smooth *out)
{
    const csg_smooth *out_there[3], *near[3];
    int outside = 0, inside = 0, near_count = 0;
    bool is_told = true; /* which of an axis' faces it is, where one is near */
    for (int i = 0; i < axes; i++) {
        inside += of[i].is_inside;
        if (!of[i].is_inside && !of[i].is_nearer)
            return false;
        if (csg_smooth_is_positive(l, &of[i].over))
            out_there[outside++] = &of[i].over;
        if (i != widest && is_behind(l, &of[i], &of[widest].over))
            continue;
        near[near_count++] = &of[i].over;
        is_told = is_told && of[i].is_nearer;
    }
    if (near_count == 1 && is_told)
        return round_of_box(l, near, 1, round, out);
    if (outside >= 2 && outside + inside == axes)
        return round_of_box(l, out_there, outside, round, out);
    if (!l->choice)
        return false;
    if (outside || l->choice->signs)
        return choose_of_box(l, of, axes, round, out);
    if (!is_told)
        return false;
    return near_count == 2 ? choose_nearer_face(l, near, round, value, out)
                           : round_of_fan(l, near, near_count, value, out);
}

bool csg_smooth_of_box(const csg_smooth_leaf *l, const double *half, double round, int axes,
                       csg_smooth *out)
{
    box_axis of[3];
    double square = 0, farthest = -INFINITY;
    int widest = 0;
    for (int i = 0; i < axes; i++) {
        of[i] = find_axis(l, (double)half[i], &l->p[i]);
        double over = of[i].over.f.value;
        square += over > 0 ? over * over : 0;
        if (over > farthest) {
            farthest = over;
            widest = i;
        }
    }
    double value = round - (square > 0 ? sqrt(square) : farthest);
    return find_of_box(l, of, axes, widest, round, value, out) ||
           csg_smooth_steepest(l, value, out);
}
