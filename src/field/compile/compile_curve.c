/* SPDX-License-Identifier: MIT
 * See compile_curve.h.
 */
#include "field/compile/compile_curve.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "scene/primitives/tube.h"

/* ---- gentle pieces ------------------------------------------------------------------------- */

/* What a search with millions of random points in wilder pieces than these still found wrong: one
 * quadratic at cosines of 0.5, cubics now and then at 0.88 and ratios of 2.5. */
static const double LEAST_COSINE[] = {0.7, 0.9}; /* of the angle between any two sides */
static const double MOST_RATIO[] = {3, 2.0};     /* of their lengths */
enum { DEEPEST = 6 }; /* what turns at once, at a cusp, is never gentle */

static double product(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
}

static bool is_gentle(const csg_curve *c)
{
    double sides[CSG_CURVE_MOST - 1][CSG_CURVE_AXES], least = INFINITY, most = 0, size = 0;
    for (int i = 0; i < c->degree; i++) {
        for (int k = 0; k < CSG_CURVE_AXES; k++)
            sides[i][k] = c->at[i + 1][k] - c->at[i][k];
        double length = sqrt(product(sides[i], sides[i]));
        least = fmin(least, length);
        most = fmax(most, length);
        size = fmax(size, c->at[i][CSG_CURVE_RADIUS]);
    }
    if (most <= 1e-5 * size)
        return true;
    for (int i = 0; i < c->degree; i++)
        for (int j = 0; j < i; j++)
            if (!(product(sides[i], sides[j]) >= LEAST_COSINE[c->degree - 2] *
                                                     sqrt(product(sides[i], sides[i])) *
                                                     sqrt(product(sides[j], sides[j]))))
                return false;
    return most <= MOST_RATIO[c->degree - 2] * least;
}

size_t csg_curve_cut(const csg_curve *curve, csg_curve pieces[CSG_CURVE_MOST_PIECES])
{
    struct {
        csg_curve curve;
        int depth;
    } stack[DEEPEST + 2];
    int waiting = 0;
    size_t count = 0;
    stack[waiting].curve = *curve;
    stack[waiting++].depth = 0;
    while (waiting > 0) {
        csg_curve now = stack[--waiting].curve, low, high;
        int depth = stack[waiting].depth;
        if (depth == DEEPEST || is_gentle(&now)) {
            pieces[count++] = now;
            continue;
        }
        csg_curve_halve(&now, &low, &high);
        stack[waiting].curve = high;
        stack[waiting++].depth = depth + 1;
        stack[waiting].curve = low;
        stack[waiting++].depth = depth + 1;
    }
    return count;
}

/* ---- polynomials --------------------------------------------------------------------------- */

/* Q(s) = powers[0] + powers[1] s + ..., -1 <= s <= 1. */
static void to_powers(const csg_curve *c, double powers[CSG_CURVE_MOST][CSG_CURVE_AXES])
{
    memset(powers, 0, CSG_CURVE_MOST * sizeof *powers);
    for (int k = 0; k < CSG_CURVE_AXES; k++) {
        double p0 = c->at[0][k], p1 = c->at[1][k], p2 = c->at[2][k], p3 = c->at[3][k];
        if (c->degree == 2) {
            powers[0][k] = (p0 + 2 * p1 + p2) / 4;
            powers[1][k] = (p2 - p0) / 2;
            powers[2][k] = (p0 - 2 * p1 + p2) / 4;
        } else {
            powers[0][k] = (p0 + 3 * p1 + 3 * p2 + p3) / 8;
            powers[1][k] = 3 * (p3 + p2 - p1 - p0) / 8;
            powers[2][k] = 3 * (p3 - p2 - p1 + p0) / 8;
            powers[3][k] = (p3 - 3 * p2 + 3 * p1 - p0) / 8;
        }
    }
}

static csg_vec3 vector_of(const double *a)
{
    return csg_vec3_make(a[0], a[1], a[2]);
}

void csg_curve_pack(csg_leaf *l, const csg_curve *piece, const csg_affine *place, bool similar,
                    double k)
{
    double powers[CSG_CURVE_MOST][CSG_CURVE_AXES], *own = l->own, size = 0, radius = 0;
    csg_vec3 q[CSG_CURVE_MOST];
    to_powers(piece, powers);
    csg_vec3 middle = vector_of(powers[0]);
    l->offset = csg_affine_point(place, csg_vec3_scale(middle, k));
    for (int i = 1; i < CSG_CURVE_MOST; i++) {
        q[i] = csg_vec3_scale(vector_of(powers[i]), k);
        if (similar) /* turned here instead of at each point */
            q[i] = csg_affine_vector(place, q[i]);
    }
    for (int i = 0; i <= piece->degree; i++) {
        size = fmax(size, csg_vec3_norm(csg_vec3_sub(vector_of(piece->at[i]), middle)));
        radius = fmax(radius, piece->at[i][CSG_CURVE_RADIUS]);
    }
    if (similar) {
        l->frame = CSG_FRAME_OFFSET;
    } else {
        l->frame = CSG_FRAME_AFFINE;
        l->to_own.t[0] -= middle.x;
        l->to_own.t[1] -= middle.y;
        l->to_own.t[2] -= middle.z;
    }
    for (int i = 1; i < CSG_CURVE_MOST; i++) {
        own[CSG_TUBE_FIRST + 3 * i - 3] = q[i].x;
        own[CSG_TUBE_FIRST + 3 * i - 2] = q[i].y;
        own[CSG_TUBE_FIRST + 3 * i - 1] = q[i].z;
    }
    for (int i = 0; i < CSG_CURVE_MOST; i++)
        own[CSG_TUBE_RADII + i] = powers[i][CSG_CURVE_RADIUS] * k;
    /* Q . Q' */
    own[CSG_TUBE_PRODUCTS] = csg_vec3_dot(q[1], q[1]);
    own[CSG_TUBE_PRODUCTS + 1] = 3 * csg_vec3_dot(q[1], q[2]);
    own[CSG_TUBE_PRODUCTS + 2] = 2 * csg_vec3_dot(q[2], q[2]) + 4 * csg_vec3_dot(q[1], q[3]);
    own[CSG_TUBE_PRODUCTS + 3] = 5 * csg_vec3_dot(q[2], q[3]);
    own[CSG_TUBE_PRODUCTS + 4] = 3 * csg_vec3_dot(q[3], q[3]);
    own[CSG_TUBE_VARIES] = csg_curve_only_radius(piece) == 0;
    l->own_count = CSG_TUBE_OWN;
    l->magnitude = (size + radius) * k;
}
