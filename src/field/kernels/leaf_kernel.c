/* SPDX-License-Identifier: MIT
 * Leaves of a tape over batches of points: primitives by the formulas in their own files
 * (scene/primitives), expression fields, shapes, each in its frame and below its warps; and their
 * ranges over cubes. Built once per instruction set, see kernel.c.
 */
#include "field/kernels/leaf_kernel.h"

#include <string.h>

#include "field/kernels/curve_kernel.h"
#include "field/kernels/formula_kernel.h"
#include "field/kernels/frames.h"
#include "field/kernels/soft_formulas.h"
#include "field/kernels/warp_kernel.h"
#include "scene/primitives/every_primitive.h"
#include "shape/shape_kernel.h"

#define CSG_THIS_SHAPE_KERNEL CSG_CONCATENATE(csg_shape_kernel_, CSG_KERNEL)
extern const csg_shape_kernel CSG_THIS_SHAPE_KERNEL;

/* ---- leaves ---------------------------------------------------------------------------- */

/* Local copies of the parameters: the compiler then knows that no store changes them. */
#define VALUE_LOOPS(NAME, name)                                                                    \
    static void name##_values(const csg_tape_node *node, const float *parameters, csg_points p,    \
                              float *restrict out)                                                 \
    {                                                                                              \
        float own[CSG_##NAME##_OWN], frame[12];                                                    \
        const float sigma = parameters[CSG_LEAF_SIGMA];                                            \
        point g;                                                                                   \
        if (node->frame == CSG_FRAME_OFFSET) {                                                     \
            memcpy(frame, parameters + CSG_LEAF_FRAME, 3 * sizeof(float));                         \
            memcpy(own, parameters + CSG_LEAF_OWN_OFFSET, sizeof own);                             \
            for (size_t i = 0; i < p.count; i++)                                                   \
                out[i] = sigma *                                                                   \
                         csg_##name##_value(own, offset_frame(frame, p.x[i], p.y[i], p.z[i]), &g); \
        } else {                                                                                   \
            memcpy(frame, parameters + CSG_LEAF_FRAME, sizeof frame);                              \
            memcpy(own, parameters + CSG_LEAF_OWN_AFFINE, sizeof own);                             \
            for (size_t i = 0; i < p.count; i++)                                                   \
                out[i] = sigma *                                                                   \
                         csg_##name##_value(own, affine_frame(frame, p.x[i], p.y[i], p.z[i]), &g); \
        }                                                                                          \
    }
#define CSG_PRIMITIVE(NAME, name, ...) VALUE_LOOPS(NAME, name)
#define CSG_CURVE_PRIMITIVE(...)
#include "scene/primitives/primitives.def"

#define GRADIENT_LOOPS(NAME, name)                                                                 \
    static void name##_gradients(const csg_tape_node *node, const float *parameters, csg_points p, \
                                 float *restrict out, float *restrict gx, float *restrict gy,      \
                                 float *restrict gz)                                               \
    {                                                                                              \
        float own[CSG_##NAME##_OWN], frame[12];                                                    \
        const float sigma = parameters[CSG_LEAF_SIGMA];                                            \
        point g;                                                                                   \
        if (node->frame == CSG_FRAME_OFFSET) {                                                     \
            memcpy(frame, parameters + CSG_LEAF_FRAME, 3 * sizeof(float));                         \
            memcpy(own, parameters + CSG_LEAF_OWN_OFFSET, sizeof own);                             \
            for (size_t i = 0; i < p.count; i++) {                                                 \
                out[i] = sigma *                                                                   \
                         csg_##name##_value(own, offset_frame(frame, p.x[i], p.y[i], p.z[i]), &g); \
                gx[i] = sigma * g.x;                                                               \
                gy[i] = sigma * g.y;                                                               \
                gz[i] = sigma * g.z;                                                               \
            }                                                                                      \
        } else {                                                                                   \
            memcpy(frame, parameters + CSG_LEAF_FRAME, sizeof frame);                              \
            memcpy(own, parameters + CSG_LEAF_OWN_AFFINE, sizeof own);                             \
            for (size_t i = 0; i < p.count; i++) {                                                 \
                out[i] = sigma *                                                                   \
                         csg_##name##_value(own, affine_frame(frame, p.x[i], p.y[i], p.z[i]), &g); \
                g = affine_back(frame, g);                                                         \
                gx[i] = sigma * g.x;                                                               \
                gy[i] = sigma * g.y;                                                               \
                gz[i] = sigma * g.z;                                                               \
            }                                                                                      \
        }                                                                                          \
    }
#define CSG_PRIMITIVE(NAME, name, ...) GRADIENT_LOOPS(NAME, name)
#define CSG_CURVE_PRIMITIVE(...)
#include "scene/primitives/primitives.def"

/* ---- shapes: through the frame, then out of the vector code -----------------------------------
 */

static inline point in_frame(const csg_tape_node *node, const float *frame, csg_points p, size_t i)
{
    return node->frame == CSG_FRAME_OFFSET ? offset_frame(frame, p.x[i], p.y[i], p.z[i])
                                           : affine_frame(frame, p.x[i], p.y[i], p.z[i]);
}

/* p.count <= CSG_BATCH */
static void shape_values(const csg_tape *tape, const csg_tape_node *node, csg_points p, float *out)
{
    const float *parameters = tape->parameters + node->parameters;
    float x[CSG_BATCH], y[CSG_BATCH], z[CSG_BATCH];
    x[0] = y[0] = z[0] = 0; /* set also where there are no points */
    for (size_t i = 0; i < p.count; i++) {
        point q = in_frame(node, parameters + CSG_LEAF_FRAME, p, i);
        x[i] = q.x;
        y[i] = q.y;
        z[i] = q.z;
    }
    csg_shape_values(csg_tape_shape(tape, node), &CSG_THIS_SHAPE_KERNEL, node->near, x, y, z,
                     p.count, out);
    for (size_t i = 0; i < p.count; i++)
        out[i] *= parameters[CSG_LEAF_SIGMA];
}

static void shape_gradients(const csg_tape *tape, const csg_tape_node *node, csg_points p,
                            float *out, float *gx, float *gy, float *gz)
{
    const float *parameters = tape->parameters + node->parameters;
    const float sigma = parameters[CSG_LEAF_SIGMA];
    float x[CSG_BATCH], y[CSG_BATCH], z[CSG_BATCH];
    x[0] = y[0] = z[0] = 0; /* set also where there are no points */
    for (size_t i = 0; i < p.count; i++) {
        point q = in_frame(node, parameters + CSG_LEAF_FRAME, p, i);
        x[i] = q.x;
        y[i] = q.y;
        z[i] = q.z;
    }
    csg_shape_gradients(csg_tape_shape(tape, node), &CSG_THIS_SHAPE_KERNEL, node->near, x, y, z,
                        p.count, out, gx, gy, gz);
    for (size_t i = 0; i < p.count; i++) {
        point g = {gx[i], gy[i], gz[i]};
        if (node->frame == CSG_FRAME_AFFINE)
            g = affine_back(parameters + CSG_LEAF_FRAME, g);
        out[i] *= sigma;
        gx[i] = sigma * g.x;
        gy[i] = sigma * g.y;
        gz[i] = sigma * g.z;
    }
}

/* ---- any leaf ----------------------------------------------------------------------------------
 */

/* In the frame below the warps. */
static void own_values(const csg_tape *tape, const csg_tape_node *node, csg_points p, float *out)
{
    const float *parameters = tape->parameters + node->parameters;
    switch (node->op) {
#define CSG_PRIMITIVE(NAME, name, ...)                                                             \
    case CSG_OP_OF(NAME):                                                                          \
        name##_values(node, parameters, p, out);                                                   \
        break;
#define CSG_CURVE_PRIMITIVE(NAME, ...)                                                             \
    case CSG_OP_OF(NAME):                                                                          \
        CSG_THIS_CURVE_KERNEL.values(node, parameters, p, out);                                    \
        break;
#include "scene/primitives/primitives.def"
    case CSG_OP_FIELD:
        CSG_THIS_FORMULA_KERNEL.values(tape, node, p.x, p.y, p.z, p.count, out);
        break;
    case CSG_OP_SHAPE:
        shape_values(tape, node, p, out);
        break;
    default: /* EMPTY */
        for (size_t i = 0; i < p.count; i++)
            out[i] = parameters[CSG_LEAF_SIGMA] * -INFINITY;
    }
}

/* A part of a batch; out may be the batch's own array. */
static csg_points part_of(csg_points p, size_t from, size_t most)
{
    size_t left = p.count - from;
    return (csg_points){p.x + from, p.y + from, p.z + from, left < most ? left : most};
}

/* Points in the frame of what the leaf's warp makes of them. */
static csg_points below_warp(const csg_tape *tape, const csg_tape_node *node, csg_points p,
                             csg_warped_points *warped)
{
    if (warped->warp != node->warp) {
        memcpy(warped->x, p.x, p.count * sizeof *p.x);
        memcpy(warped->y, p.y, p.count * sizeof *p.y);
        memcpy(warped->z, p.z, p.count * sizeof *p.z);
        CSG_THIS_WARP_KERNEL.points(tape, node->warp, warped->x, warped->y, warped->z, p.count);
        warped->warp = node->warp;
    }
    return (csg_points){warped->x, warped->y, warped->z, p.count};
}

/* Leaves that do more than run a formula over the points: in parts, with room of their own. */
static int is_indirect(const csg_tape_node *node)
{
    return node->warp != 0 || node->op == CSG_OP_SHAPE;
}

static void leaf_values(const csg_tape *tape, const csg_tape_node *node, csg_points p, float *out,
                        csg_warped_points *warped)
{
    const float raise = tape->parameters[node->parameters + CSG_LEAF_RAISE];
    if (!is_indirect(node))
        own_values(tape, node, p, out);
    for (size_t i = 0; i < p.count && is_indirect(node); i += CSG_BATCH) {
        csg_points part = part_of(p, i, CSG_BATCH);
        if (node->warp && p.count > CSG_BATCH)
            warped->warp = 0; /* those are of another part */
        own_values(tape, node, node->warp ? below_warp(tape, node, part, warped) : part, out + i);
    }
    if (raise != 0)
        for (size_t i = 0; i < p.count; i++)
            out[i] += raise;
}

static void own_gradients(const csg_tape *tape, const csg_tape_node *node, csg_points p, float *out,
                          float *gx, float *gy, float *gz)
{
    const float *parameters = tape->parameters + node->parameters;
    switch (node->op) {
#define CSG_PRIMITIVE(NAME, name, ...)                                                             \
    case CSG_OP_OF(NAME):                                                                          \
        name##_gradients(node, parameters, p, out, gx, gy, gz);                                    \
        break;
#define CSG_CURVE_PRIMITIVE(NAME, ...)                                                             \
    case CSG_OP_OF(NAME):                                                                          \
        CSG_THIS_CURVE_KERNEL.gradients(node, parameters, p, out, gx, gy, gz);                     \
        break;
#include "scene/primitives/primitives.def"
    case CSG_OP_FIELD:
        CSG_THIS_FORMULA_KERNEL.gradients(tape, node, p.x, p.y, p.z, p.count, out, gx, gy, gz);
        break;
    case CSG_OP_SHAPE:
        shape_gradients(tape, node, p, out, gx, gy, gz);
        break;
    default:
        own_values(tape, node, p, out);
        for (size_t i = 0; i < p.count; i++)
            gx[i] = gy[i] = gz[i] = 0;
    }
}

static void warped_gradients(const csg_tape *tape, const csg_tape_node *node, csg_points p,
                             float *out, float *gx, float *gy, float *gz, csg_warped_points *warped)
{
    own_gradients(tape, node, below_warp(tape, node, p, warped), out, gx, gy, gz);
    CSG_THIS_WARP_KERNEL.gradients(tape, node->warp, p.x, p.y, p.z, p.count, gx, gy, gz,
                                   &warped->slopes);
}

/* Walks for gradients go by batches: p.count <= CSG_BATCH. */
static void leaf_gradients(const csg_tape *tape, const csg_tape_node *node, csg_points p,
                           float *out, float *gx, float *gy, float *gz, csg_warped_points *warped)
{
    const float raise = tape->parameters[node->parameters + CSG_LEAF_RAISE];
    if (node->warp)
        warped_gradients(tape, node, p, out, gx, gy, gz, warped);
    else
        own_gradients(tape, node, p, out, gx, gy, gz);
    if (raise != 0)
        for (size_t i = 0; i < p.count; i++)
            out[i] += raise;
}

/* ---- intervals ------------------------------------------------------------------------------- */

/* Primitives whose value falls with |x|, |y| and |z| in a frame that is not turned: over a cube
 * they are largest at its point nearest to their centre and smallest at the farthest. */
static int falls_outwards(const csg_tape_node *node, const float *own)
{
    if (node->frame != CSG_FRAME_OFFSET || node->warp)
        return 0;
    switch (node->op) {
#define CSG_PRIMITIVE(NAME, name, ...)                                                             \
    case CSG_OP_OF(NAME):                                                                          \
        return csg_##name##_falls_outwards(own);
#define CSG_CURVE_PRIMITIVE(...)
#include "scene/primitives/primitives.def"
    }
    return 0; /* curves, fields, shapes */
}

/* The coordinates nearest to and farthest from t within `half` of c. */
static void near_and_far(const float *c, float t, float half, float *near, float *far)
{
    for (int o = 0; o < CSG_OCTANTS; o++) {
        float d = c[o] - t, side = sign_of(d);
        near[o] = t + side * larger(absolute(d) - half, 0);
        far[o] = t + side * (absolute(d) + half);
    }
}

static void falling_interval(const csg_tape *tape, const csg_tape_node *node, csg_points p,
                             float half, float *restrict low, float *restrict high)
{
    csg_warped_points *none = NULL; /* such a leaf has no warp */
    const float *parameters = tape->parameters + node->parameters, *t = parameters + CSG_LEAF_FRAME;
    float near[3][CSG_OCTANTS], far[3][CSG_OCTANTS], a[CSG_OCTANTS], b[CSG_OCTANTS];
    near_and_far(p.x, t[0], half, near[0], far[0]);
    near_and_far(p.y, t[1], half, near[1], far[1]);
    near_and_far(p.z, t[2], half, near[2], far[2]);
    leaf_values(tape, node, (csg_points){near[0], near[1], near[2], CSG_OCTANTS}, a, none);
    leaf_values(tape, node, (csg_points){far[0], far[1], far[2], CSG_OCTANTS}, b, none);
    float slack = parameters[CSG_LEAF_SLACK];
    for (int o = 0; o < CSG_OCTANTS; o++) {
        low[o] = smaller(a[o], b[o]) - slack;
        high[o] = larger(a[o], b[o]) + slack;
    }
}

static void leaf_interval(const csg_tape *tape, const csg_tape_node *node, csg_points p,
                          float radius, float *restrict low, float *restrict high,
                          csg_warped_points *warped)
{
    const float *parameters = tape->parameters + node->parameters;
    if (node->op == CSG_OP_FIELD && !node->warp) {
        CSG_THIS_FORMULA_KERNEL.intervals(tape, node, p.x, p.y, p.z, radius, low, high);
        for (int o = 0; o < CSG_OCTANTS; o++) {
            low[o] += parameters[CSG_LEAF_RAISE];
            high[o] += parameters[CSG_LEAF_RAISE];
        }
        return;
    }
    const float half = radius * 0.57735034f; /* of the cube's edge: 1 / sqrt 3, rounded up */
    if (falls_outwards(node, parameters + CSG_LEAF_OWN_OFFSET)) {
        falling_interval(tape, node, p, half, low, high);
        return;
    }
    leaf_values(tape, node, p, low, warped);
    float slope = 1.0f; /* the leaf's Lipschitz constant */
    if (node->op == CSG_OP_FIELD)
        slope = larger(csg_tape_formula_of(tape, node)->lipschitz, 1.0f);
    float reach = slope * radius * (1.0f + 0x1p-20f) + parameters[CSG_LEAF_SLACK];
    for (int o = 0; o < CSG_OCTANTS; o++) {
        high[o] = low[o] + reach;
        low[o] = low[o] - reach;
    }
}

const csg_leaf_kernel CSG_THIS_LEAF_KERNEL = {
    .values = leaf_values,
    .gradients = leaf_gradients,
    .intervals = leaf_interval,
};
