/* SPDX-License-Identifier: MIT
 * Smooth pieces; see piece.h.
 */
#include "scene/primitives/piece.h"

csg_piece csg_piece_sum(const csg_piece_leaf *l, const csg_piece *a, double factor,
                        const csg_piece *b)
{
    csg_piece out = {.f = csg_taylor_sum(&a->f, factor, &b->f)};
    for (int k = 0; k < 3 && l->with_slopes; k++)
        out.g[k] = csg_taylor_sum(&a->g[k], factor, &b->g[k]);
    return out;
}

/* The derivatives of |u| are those of u along the unit vector. */
static bool find_slopes(const csg_piece_leaf *l, const csg_piece *const *u, int count,
                        csg_piece *out)
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

bool csg_piece_norm(const csg_piece_leaf *l, const csg_piece *const *u, int count, csg_piece *out)
{
    const csg_taylor *f[CSG_TAYLOR_MOST];
    for (int i = 0; i < count; i++)
        f[i] = &u[i]->f;
    return csg_taylor_norm(f, count, l->radius, &out->f) &&
           (!l->with_slopes || find_slopes(l, u, count, out));
}

/* A face where one coordinate is farther out than the others, which are inside; an edge or a corner
 * where two or three are out. */
bool csg_piece_of_box(const csg_piece_leaf *l, const float *half, double round, int axes,
                      csg_piece *out)
{
    csg_piece over[3], distance;
    const csg_piece *out_there[3];
    int outside = 0, inside = 0, widest = 0;
    for (int i = 0; i < axes; i++) {
        double side = l->p[i].f.value < 0 ? -1 : 1;
        csg_piece other = csg_piece_line(l, -(double)half[i], -side, &l->p[i]);
        over[i] = csg_piece_line(l, -(double)half[i], side, &l->p[i]);
        if (over[i].f.value > over[widest].f.value)
            widest = i;
        if (csg_piece_is_negative(l, &over[i]) && csg_piece_is_negative(l, &other))
            inside++;
        else if (!csg_piece_is_positive(l, &l->p[i]) && !csg_piece_is_negative(l, &l->p[i]))
            return false; /* either face may be the nearer one */
        else if (csg_piece_is_positive(l, &over[i]))
            out_there[outside++] = &over[i];
    }
    bool is_face = inside >= axes - 1;
    for (int i = 0; i < axes && is_face; i++)
        is_face = i == widest || csg_piece_is_above(l, &over[widest], &over[i]);
    is_face = is_face && (csg_piece_is_positive(l, &l->p[widest]) ||
                          csg_piece_is_negative(l, &l->p[widest]));
    if (is_face) {
        *out = csg_piece_line(l, round, -1, &over[widest]);
        return true;
    }
    if (outside < 2 || outside + inside < axes || !csg_piece_norm(l, out_there, outside, &distance))
        return false;
    *out = csg_piece_line(l, round, -1, &distance);
    return true;
}
