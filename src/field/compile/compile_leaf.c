/* SPDX-License-Identifier: MIT
 * Placing and packing primitives; see compile_leaf.h.
 */
#include "field/compile/compile_leaf.h"

#include <float.h>

#include "field/compile/compile_curve.h"

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
                        csg_primitive_kind kind, const double *p)
{
    csg_affine place = *at;
    const csg_primitive *primitive = csg_primitive_of(kind);
    double smallest, largest, k = 1;
    csg_affine_singular_values(&place, &smallest, &largest);
    bool similar = largest - smallest <= 1e-12 * largest && !(primitive->traits & CSG_TRAIT_LINEAR);
    if (similar) {
        k = smallest;
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                place.m[i][j] /= k;
    }
    l->op = csg_op_of_primitive(kind);
    csg_leaf_place(l, &place);
    if (similar && primitive->traits & CSG_TRAIT_BALL)
        l->frame = CSG_FRAME_OFFSET;
    l->sigma = (negate ? -1 : 1) * (similar ? factor / k : factor);
    if (csg_node_is_curve(kind)) {
        csg_curve piece = csg_curve_make(kind, p);
        csg_curve_pack(l, &piece, &place, similar, k);
    } else {
        primitive->pack(l, p, k);
        l->own_count = primitive->own_count;
    }
    l->own_magnitude = l->magnitude;
    /* Lengths as the scene sees them: an own-frame value is multiplied by sigma at the end. */
    l->magnitude = l->magnitude * fabs(l->sigma) + csg_vec3_norm(l->offset);
}

/* Doubles have some units in the last place of their own. */
static const double OF_DOUBLES = 0x1p-46;

/* The rounding error of a value is a few units in the last place of the lengths in it. */
static double rounding_of(double magnitude)
{
    return 32 * (double)FLT_EPSILON * magnitude;
}

static double rounding_in(double value)
{
    return fabs(value - (double)(float)value);
}

static double norm_of_rounding(const double *values, int count)
{
    double square = 0;
    for (int i = 0; i < count; i++)
        square += rounding_in(values[i]) * rounding_in(values[i]);
    return sqrt(square);
}

/* What floats make of the parameters (tape.h, off and turned). An own one, be it a length or a
 * direction's part, moves values by its relative error times the leaf's lengths; those of a plane
 * are its normal. */
static void find_rounding(const csg_leaf *l, const double *doubles, float *off, float *turned)
{
    static const double UP = 1 + 1e-6;
    bool is_plane = csg_op_has(l->op, CSG_TRAIT_LINEAR);
    double size = fabs(l->sigma), here = rounding_in(l->raise), along = 0;
    if (l->frame == CSG_FRAME_OFFSET) {
        here += size * norm_of_rounding((double[]){l->offset.x, l->offset.y, l->offset.z}, 3);
    } else {
        here += size * norm_of_rounding(l->to_own.t, 3);
        along += size * norm_of_rounding(&l->to_own.m[0][0], 9);
    }
    here += rounding_in(l->sigma) * l->own_magnitude;
    if (is_plane)
        along += size * norm_of_rounding(l->own, 3);
    for (int i = is_plane ? 3 : 0; i < l->own_count; i++)
        if (rounding_in(l->own[i]) > 0)
            here += size * rounding_in(l->own[i]) / fabs(l->own[i]) * l->own_magnitude;
    *off = (float)((here + doubles[CSG_LEAF_OFF]) * UP);
    *turned = (float)((along + doubles[CSG_LEAF_TURNED]) * UP);
}

size_t csg_leaf_numbers(const csg_leaf *l, double values[CSG_LEAF_MOST_PARAMETERS])
{
    size_t count = CSG_LEAF_FRAME;
    values[CSG_LEAF_SIGMA] = l->sigma;
    values[CSG_LEAF_RAISE] = l->raise;
    values[CSG_LEAF_SLACK] = rounding_of(l->magnitude + fabs(l->raise));
    values[CSG_LEAF_COLOR] = 0;
    values[CSG_LEAF_OFF] = OF_DOUBLES * (l->magnitude + fabs(l->raise));
    values[CSG_LEAF_TURNED] = OF_DOUBLES * fabs(l->sigma);
    if (l->frame == CSG_FRAME_OFFSET) {
        values[count++] = l->offset.x;
        values[count++] = l->offset.y;
        values[count++] = l->offset.z;
    } else {
        for (int i = 0; i < 9; i++)
            values[count++] = l->to_own.m[i / 3][i % 3];
        for (int i = 0; i < 3; i++)
            values[count++] = l->to_own.t[i];
    }
    for (int i = 0; i < l->own_count; i++)
        values[count++] = l->own[i];
    return count;
}

size_t csg_leaf_pack(const csg_leaf *l, uint32_t color, float values[CSG_LEAF_MOST_PARAMETERS])
{
    double numbers[CSG_LEAF_MOST_PARAMETERS];
    size_t count = csg_leaf_numbers(l, numbers);
    for (size_t i = 0; i < count; i++)
        values[i] = (float)numbers[i];
    values[CSG_LEAF_COLOR] = (float)color;
    find_rounding(l, numbers, &values[CSG_LEAF_OFF], &values[CSG_LEAF_TURNED]);
    return count;
}
