/* SPDX-License-Identifier: MIT
 * Placing and packing primitives; see compile_leaf.h. The order of `own` is that of formulas.h.
 */
#include "field/compile/compile_leaf.h"

#include <float.h>
#include <string.h>

#include "field/compile/compile_curve.h"
#include "field/kernels/formulas.h"

static void own_of_frustum(csg_leaf *l, const double *p, double k)
{
    double r1 = p[0] * k, r2 = p[1] * k, h = p[2] * k;
    double length = hypot(2 * h, r1 - r2);
    double own[] = {r1,       (r1 + r2) / 2, h, 2 * h / length, (r1 - r2) / length, length,
                    p[3] * k, (r2 - r1) / 2};
    memcpy(l->own, own, sizeof own);
    l->own_count = OWN_FRUSTUM;
    l->magnitude = hypot(fmax(r1, r2), h) + p[3] * k;
}

static void own_of_capsule(csg_leaf *l, const double *p, double k)
{
    double h = p[0] * k, r1 = p[1] * k, r2 = p[2] * k;
    double s = (r1 - r2) / h;
    double own[] = {h, 1 / h, r1, r2 - r1, s / sqrt(1 - s * s)};
    memcpy(l->own, own, sizeof own);
    l->own_count = OWN_CAPSULE;
    l->magnitude = h + fmax(r1, r2);
}

static void own_of_torus(csg_leaf *l, const double *p, double k)
{
    double half = p[2] * (3.14159265358979323846 / 180);
    bool whole = p[2] >= 180;
    double own[] = {p[0] * k, p[1] * k, whole ? -1 : cos(half), whole ? 0 : sin(half)};
    memcpy(l->own, own, sizeof own);
    l->own_count = OWN_TORUS;
    l->magnitude = own[0] + own[1];
}

/* formulas.h wants the smallest semi-axis last: turn the frame's rows. */
static void own_of_ellipsoid(csg_leaf *l, const double *p, double k)
{
    int last = p[0] < p[1] ? (p[0] < p[2] ? 0 : 2) : (p[1] < p[2] ? 1 : 2);
    int order[3] = {(last + 1) % 3, (last + 2) % 3, last};
    csg_affine turned = l->to_own;
    for (int i = 0; i < 3; i++) {
        memcpy(turned.m[i], l->to_own.m[order[i]], sizeof turned.m[i]);
        turned.t[i] = l->to_own.t[order[i]];
        l->own[i] = p[order[i]] * k;
    }
    l->to_own = turned;
    if (last != 2)
        l->frame = CSG_FRAME_AFFINE;
    double z = l->own[2];
    l->own[3] = (l->own[0] / z) * (l->own[0] / z);
    l->own[4] = (l->own[1] / z) * (l->own[1] / z);
    l->own[5] = 0;
    l->own_count = OWN_ELLIPSOID;
    l->magnitude = fmax(l->own[0], l->own[1]);
}

/* A plane stays a plane under every map: sigma, place and scale all go into n and d. */
static void own_of_plane(csg_leaf *l, const double *p, double factor)
{
    csg_vec3 n = {p[0], p[1], p[2]};
    csg_vec3 b = {l->to_own.t[0], l->to_own.t[1], l->to_own.t[2]};
    csg_vec3 normal = csg_vec3_scale(csg_affine_covector(&l->to_own, n), factor);
    l->own[0] = normal.x;
    l->own[1] = normal.y;
    l->own[2] = normal.z;
    l->own[3] = factor * (p[3] - csg_vec3_dot(n, b));
    l->own_count = OWN_PLANE;
    l->frame = CSG_FRAME_OFFSET;
    l->offset = csg_vec3_make(0, 0, 0);
    l->sigma = l->sigma < 0 ? -1 : 1;
    l->magnitude = fabs(l->own[3]);
}

static void own_of_rectangle(csg_leaf *l, const double *p, double k)
{
    double own[] = {(p[0] - p[2]) * k, (p[1] - p[2]) * k, p[2] * k};
    memcpy(l->own, own, sizeof own);
    l->own_count = OWN_RECTANGLE;
    l->magnitude = k * hypot(p[0], p[1]);
}

static void own_of_superellipsoid(csg_leaf *l, const double *p, double k)
{
    for (int i = 0; i < 5; i++)
        l->own[i] = i < 3 ? p[i] * k : p[i];
    l->own[5] = k / p[5];
    l->own_count = OWN_SUPERELLIPSOID;
    l->magnitude = fmax(p[0], fmax(p[1], p[2])) * k + l->own[5];
}

static void own_parameters(csg_leaf *l, csg_node_kind kind, const double *p, double k,
                           double factor)
{
    switch (kind) {
    case CSG_NODE_SPHERE:
    case CSG_NODE_CIRCLE:
    case CSG_NODE_SLAB:
        l->own[0] = p[0] * k;
        l->own_count = OWN_SPHERE;
        l->magnitude = l->own[0];
        break;
    case CSG_NODE_BOX:
        for (int i = 0; i < 3; i++)
            l->own[i] = (p[i] - p[3]) * k;
        l->own[3] = p[3] * k;
        l->own_count = OWN_BOX;
        l->magnitude = k * sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
        break;
    case CSG_NODE_FRUSTUM:
        own_of_frustum(l, p, k);
        break;
    case CSG_NODE_CAPSULE:
        own_of_capsule(l, p, k);
        break;
    case CSG_NODE_TORUS:
        own_of_torus(l, p, k);
        break;
    case CSG_NODE_ELLIPSOID:
        own_of_ellipsoid(l, p, k);
        break;
    case CSG_NODE_SUPERELLIPSOID:
        own_of_superellipsoid(l, p, k);
        break;
    case CSG_NODE_RECTANGLE:
        own_of_rectangle(l, p, k);
        break;
    default:
        own_of_plane(l, p, factor);
    }
}

static bool is_turned(const csg_affine *place)
{
    bool turned = false;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            turned |= fabs(place->m[i][j] - (i == j)) > 1e-15;
    return turned;
}

void csg_leaf_place(csg_leaf *l, const csg_affine *place)
{
    l->frame = is_turned(place) ? CSG_FRAME_AFFINE : CSG_FRAME_OFFSET;
    l->offset = csg_vec3_make(place->t[0], place->t[1], place->t[2]);
    csg_affine_invert(*place, &l->to_own); /* build.h admits only invertible maps */
}

void csg_leaf_primitive(csg_leaf *l, const csg_affine *at, double factor, bool negate,
                        csg_node_kind kind, const double *p)
{
    csg_affine place = *at;
    double smallest, largest, k = 1;
    csg_affine_singular_values(&place, &smallest, &largest);
    bool similar = largest - smallest <= 1e-12 * largest && kind != CSG_NODE_PLANE;
    if (similar) {
        k = smallest;
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                place.m[i][j] /= k;
    }
    l->op = (uint8_t)(CSG_OP_SPHERE + (kind - CSG_NODE_SPHERE));
    csg_leaf_place(l, &place);
    if (similar && kind == CSG_NODE_SPHERE)
        l->frame = CSG_FRAME_OFFSET;
    l->sigma = (negate ? -1 : 1) * (similar ? factor / k : factor);
    if (csg_node_is_curve(kind)) {
        csg_curve piece = csg_curve_make(kind, p);
        csg_curve_pack(l, &piece, &place, similar, k);
    } else {
        own_parameters(l, kind, p, k, factor);
    }
    /* Lengths as the scene sees them: an own-frame value is multiplied by sigma at the end. */
    l->magnitude = l->magnitude * fabs(l->sigma) + csg_vec3_norm(l->offset);
}

/* The rounding error of a value is a few units in the last place of the lengths in it. */
static double rounding_of(double magnitude)
{
    return 32 * (double)FLT_EPSILON * magnitude;
}

size_t csg_leaf_pack(const csg_leaf *l, uint32_t color, float values[CSG_LEAF_MOST_PARAMETERS])
{
    size_t count = CSG_LEAF_FRAME;
    values[CSG_LEAF_SIGMA] = (float)l->sigma;
    values[CSG_LEAF_RAISE] = (float)l->raise;
    values[CSG_LEAF_SLACK] = (float)rounding_of(l->magnitude + fabs(l->raise));
    values[CSG_LEAF_COLOR] = (float)color;
    if (l->frame == CSG_FRAME_OFFSET) {
        values[count++] = (float)l->offset.x;
        values[count++] = (float)l->offset.y;
        values[count++] = (float)l->offset.z;
    } else {
        for (int i = 0; i < 9; i++)
            values[count++] = (float)l->to_own.m[i / 3][i % 3];
        for (int i = 0; i < 3; i++)
            values[count++] = (float)l->to_own.t[i];
    }
    for (int i = 0; i < l->own_count; i++)
        values[count++] = (float)l->own[i];
    return count;
}
