/* SPDX-License-Identifier: MIT
 * Warps: maps of space that are not affine. A node below a warp w has its own frame; the warp's
 * field is f(p) = g(w(p)) / L with the Lipschitz constant L of w, which holds everywhere
 * (warps.def). Away from the child's solid a warp may have to put points where they do not belong
 * to stay continuous, so the builder cuts what is outside of the warped solid's box. Definitions in
 * double: warp.c; in float: field/kernels/warp_kernel.c.
 */
#ifndef CSG_SCENE_WARP_H
#define CSG_SCENE_WARP_H

#include <math.h>
#include <stdint.h>

#include "base/geometry.h"
#include "scene/primitives/sizes.h"

enum {
    CSG_WARP_PARAMETERS = 6,
    CSG_MOST_WARPS = 8 /* one below the other */
};

/* Parameters: those given, as in warps.def, then those that csg_warp_settle finds. */
typedef struct csg_warp {
    uint8_t kind; /* csg_warp_kind (scene/warp_kinds.h) */
    double parameters[CSG_WARP_PARAMETERS];
} csg_warp;

/* The parameters given; finite. */
bool csg_warp_check(const csg_warp *warp, csg_refusal *refusal);

/* Fills in what depends on the box of the child's solid. False: the warp cannot be done: the box is
 * infinite or reaches where the map tears; *why says so in one sentence. */
bool csg_warp_settle(csg_warp *warp, csg_box child, const char **why);

/* The larger singular value of [[m, k], [0, 1]], m > 0: no matrix [[A, w], [0, 1]] with |A| <= m and
 * |w| <= k has a larger one. */
static inline double csg_shear_norm(double m, double k)
{
    double sum = m * m + k * k + 1;
    return sqrt((sum + sqrt(fmax(sum * sum - 4 * m * m, 0))) / 2);
}

typedef struct csg_warped {
    csg_vec3 at;        /* w(p) */
    csg_vec3 column[3]; /* dw / dx, dw / dy, dw / dz; one-sided where w has a kink */
} csg_warped;

/* Whether planes with this normal are planes of the child's frame, and *child, their normal there:
 * what is warped reaches no farther along one than the child along the other. */
bool csg_warp_plane(const csg_warp *warp, csg_vec3 n, csg_vec3 *child);

csg_warped csg_warp_at(const csg_warp *warp, csg_vec3 p);
/* 1 / L */
double csg_warp_scale(const csg_warp *warp);
/* Contains every p of which w(p) lies in the child's box, and for a bend every p within the angles
 * of its ends, where the builder cuts; all_round: the rest too. */
csg_box csg_warp_box(const csg_warp *warp, csg_box child, bool all_round);

#endif
