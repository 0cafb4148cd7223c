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

/* round less the distance from a face, an edge or a corner: where these coordinates are out. */
static bool round_of_box(const csg_smooth_leaf *l, const csg_smooth *const *out_there, int outside,
                         double round, csg_smooth *out)
{
    csg_smooth distance;
    if (outside == 1) {
        *out = csg_smooth_line(l, round, -1, out_there[0]);
        return true;
    }
    if (!csg_smooth_norm(l, out_there, outside, &distance))
        return false;
    *out = csg_smooth_line(l, round, -1, &distance);
    return true;
}

/* Which coordinates are out is open for one or two of them. Where only the sign matters a face
 * alone stands for the inside, too. */
static bool choose_of_box(const csg_smooth_leaf *l, const csg_smooth *over, int axes, double round,
                          csg_smooth *out)
{
    enum { OPEN_MOST = 2 };
    const csg_smooth *out_there[3], *open[OPEN_MOST];
    bool possible[1 << OPEN_MOST];
    int outside = 0, open_count = 0;
    for (int i = 0; i < axes; i++) {
        if (csg_smooth_is_positive(l, &over[i]))
            out_there[outside++] = &over[i];
        else if (csg_smooth_is_negative(l, &over[i]))
            continue;
        else if (open_count == OPEN_MOST)
            return false;
        else
            open[open_count++] = &over[i];
    }
    if (!outside && !l->choice->signs)
        return false;
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
 * where two or three are out. */
bool csg_smooth_of_box(const csg_smooth_leaf *l, const float *half, double round, int axes,
                       csg_smooth *out)
{
    csg_smooth over[3];
    const csg_smooth *out_there[3];
    int outside = 0, inside = 0, widest = 0;
    for (int i = 0; i < axes; i++) {
        double side = l->p[i].f.value < 0 ? -1 : 1;
        csg_smooth other = csg_smooth_line(l, -(double)half[i], -side, &l->p[i]);
        over[i] = csg_smooth_line(l, -(double)half[i], side, &l->p[i]);
        if (over[i].f.value > over[widest].f.value)
            widest = i;
        if (csg_smooth_is_negative(l, &over[i]) && csg_smooth_is_negative(l, &other))
            inside++;
        else if (!csg_smooth_is_positive(l, &l->p[i]) && !csg_smooth_is_negative(l, &l->p[i]))
            return false; /* either face may be the nearer one */
        else if (csg_smooth_is_positive(l, &over[i]))
            out_there[outside++] = &over[i];
    }
    bool is_face = inside >= axes - 1;
    for (int i = 0; i < axes && is_face; i++)
        is_face = i == widest || csg_smooth_is_above(l, &over[widest], &over[i]);
    is_face = is_face && (csg_smooth_is_positive(l, &l->p[widest]) ||
                          csg_smooth_is_negative(l, &l->p[widest]));
    if (is_face) {
        *out = csg_smooth_line(l, round, -1, &over[widest]);
        return true;
    }
    if (outside >= 2 && outside + inside == axes)
        return round_of_box(l, out_there, outside, round, out);
    return l->choice && choose_of_box(l, over, axes, round, out);
}
