/* SPDX-License-Identifier: MIT
 * See warp_taylor.h. All maps here have the constant 1 but for their frames, so that what one of
 * them is off goes on as it is.
 */
#include "field/taylor/warp_taylor.h"

#include <math.h>
#include <string.h>

#include "field/gradients/cone_warp.h"
#include "scene/warp_kinds.h"

/* Of a number of the frame, of a cosine or a sine: half a unit in the last place, and as much for
 * what doubles do. */
static const double ROUNDING = 0x1p-23;

void csg_taylor_place_points(const double frame[12], const double c[3], csg_smooth_leaf *l)
{
    for (int i = 0; i < 3; i++) {
        csg_smooth *p = &l->p[i];
        p->f = csg_taylor_constant(frame[9 + i]);
        for (int k = 0; k < 3; k++) {
            p->f.slope[k] = frame[3 * i + k];
            p->f.value += p->f.slope[k] * c[k];
        }
        for (int k = 0; k < 3 && l->with_slopes; k++)
            p->g[k] = csg_taylor_constant(p->f.slope[k]);
    }
}

void csg_taylor_placed(const double frame[12], csg_smooth_leaf *l)
{
    csg_smooth p[3];
    memcpy(p, l->p, sizeof p);
    for (int i = 0; i < 3; i++) {
        csg_smooth sum = csg_smooth_scaled(l, frame[3 * i], &p[0]);
        for (int k = 1; k < 3; k++)
            sum = csg_smooth_sum(l, &sum, frame[3 * i + k], &p[k]);
        l->p[i] = csg_smooth_line(l, frame[9 + i], 1, &sum);
    }
}

static double size_of(const csg_smooth_leaf *l)
{
    double size = 0;
    for (int k = 0; k < 3; k++)
        size += fabs(l->p[k].f.value) + csg_taylor_reach(&l->p[k].f, l->radius);
    return size;
}

static csg_smooth nothing(void)
{
    const csg_smooth none = {.f = {.value = 0}};
    return none;
}

static bool pass_revolve(const float *own, csg_smooth_leaf *l)
{
    csg_smooth rho;
    if (!csg_smooth_radial(l, &rho))
        return false;
    l->p[0] = rho;
    l->p[1] = l->p[2];
    l->p[2] = nothing();
    return true;
}

static bool pass_slice(const float *own, csg_smooth_leaf *l)
{
    l->p[2] = nothing();
    return true;
}

/* Within the arc's angle as a revolution, beside it by the direction of the nearer end. */
static bool pass_elbow(const float *own, csg_smooth_leaf *l)
{
    double c = (double)own[CSG_ELBOW_COSINE], s = (double)own[CSG_ELBOW_SINE];
    csg_smooth along_x = csg_smooth_scaled(l, s, &l->p[0]);
    csg_smooth above = csg_smooth_sum(l, &along_x, -c, &l->p[1]); /* > 0: within, where y > 0 */
    csg_smooth below = csg_smooth_sum(l, &along_x, c, &l->p[1]);
    if (csg_smooth_is_positive(l, &above) && csg_smooth_is_positive(l, &below))
        return pass_revolve(own, l);
    double side = l->p[1].f.value < 0 ? -1 : 1;
    const csg_smooth *beyond = side > 0 ? &above : &below;
    csg_smooth y = csg_smooth_scaled(l, side, &l->p[1]);
    if (!csg_smooth_is_negative(l, beyond) || !csg_smooth_is_positive(l, &y))
        return false;
    csg_smooth part = csg_smooth_scaled(l, c, &l->p[0]);
    l->p[0] = csg_smooth_sum(l, &part, s, &y);
    l->p[1] = l->p[2];
    l->p[2] = nothing();
    return true;
}

static bool pass(const csg_tape_warp *warp, csg_smooth_leaf *l)
{
    switch ((csg_warp_kind)warp->kind) {
    case CSG_WARP_REVOLVE:
        return pass_revolve(warp->own, l);
    case CSG_WARP_SLICE:
        return pass_slice(warp->own, l);
    case CSG_WARP_ELBOW:
        return pass_elbow(warp->own, l);
    case CSG_WARP_TWIST: /* no Taylor models of their sines and angles */
    case CSG_WARP_TAPER:
    case CSG_WARP_BEND:
    case CSG_WARP_COUNT:
        break;
    }
    return false;
}

bool csg_taylor_warped(const csg_tape *tape, uint32_t warp, const double c[3], csg_smooth_leaf *l,
                       double *off)
{
    const csg_tape_warp *way[CSG_MOST_WARPS];
    uint32_t count = 0;
    *off = 0;
    for (int i = 0; i < 3; i++) {
        csg_smooth *p = &l->p[i];
        p->f = csg_taylor_constant(c[i]);
        p->f.slope[i] = 1;
        for (int k = 0; k < 3 && l->with_slopes; k++)
            p->g[k] = csg_taylor_constant(i == k);
    }
    for (uint32_t w = warp; w; w = tape->warps[w - 1].outer)
        way[count++] = &tape->warps[w - 1];
    while (count-- > 0) { /* the outermost first */
        double before = size_of(l), norm = csg_cone_norm(way[count]->frame);
        double frame[12];
        for (int i = 0; i < 12; i++)
            frame[i] = (double)way[count]->frame[i];
        csg_taylor_placed(frame, l);
        *off = *off * norm + ROUNDING * (3 * norm * before + 2 * size_of(l));
        if (!pass(way[count], l))
            return false;
    }
    return true;
}
