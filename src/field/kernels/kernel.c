/* SPDX-License-Identifier: MIT
 * The kernels: a tape over batches of points. This file is built once per instruction set (see
 * meson.build); the loops over points are plain C that the compiler turns into vectors, the
 * formulas are in scene/primitives and scene/operators/blends.h, the leaves in leaf_kernel.c, the
 * joins in joins.h and rule_kernel.c. CSG_KERNEL names the build.
 *
 * Three walks over a tape, all on a stack of slots:
 *   values     a slot is one array
 *   mixed      a slot is a value and several channels that mix in the proportions of the
 *              operators' partial derivatives: gradients (3) or colours (4)
 *   intervals  a slot is a low and a high array of eight lanes
 */
#include "field/kernels/kernel.h"

#include <math.h>
#include <string.h>

#include "base/select.h"
#include "field/kernels/fillet_kernel.h"
#include "field/kernels/formula_kernel.h"
#include "field/kernels/joins.h"
#include "field/kernels/leaf_kernel.h"
#include "field/kernels/rule_kernel.h"
#include "field/kernels/smooth_kernel.h"
#include "field/kernels/warp_kernel.h"
#include "field/rule_layout.h"
#include "field/turning.h"

#define STRING_(a) #a
#define STRING(a) STRING_(a)

/* ---- the round operator: all operands at once (operators.md 12) -------------------------------------------- */

/* G - max for the first m operands, from the sums of u_i = max - f_i and of u_i^2. Never below 0.
 */
static inline float round_excess(float w, float m, float sum, float squares)
{
    float mean = sum / m;
    float rest = w * w - (squares - sum * mean);
    return larger(w - mean - sqrtf(larger(rest, 0) / m), 0);
}

/* Operands are f[k * stride + i]. Turns them into gaps u = max - f (in place), and leaves the
 * largest in top and G - max in excess. For intersections f is negated first. work: another
 * arity * stride floats, and 4 * stride more. */
static void round_solve(float *restrict f, size_t stride, uint32_t arity, int is_union, float w,
                        size_t count, float *restrict top, float *restrict excess,
                        float *restrict work)
{
    for (uint32_t k = 0; k < arity; k++) {
        float *restrict v = f + k * stride;
        if (!is_union)
            for (size_t i = 0; i < count; i++)
                v[i] = -v[i];
        if (k == 0)
            memcpy(top, v, count * sizeof(float));
        else
            for (size_t i = 0; i < count; i++)
                top[i] = larger(top[i], v[i]);
    }
    for (uint32_t k = 0; k < arity; k++) {
        float *restrict v = f + k * stride;
        for (size_t i = 0; i < count; i++)
            v[i] = top[i] - v[i];
    }
    if (arity == 2) { /* what the general walk below gives for two operands, bit for bit */
        for (size_t i = 0; i < count; i++) {
            float u = f[i] + f[stride + i]; /* one of them is 0 */
            excess[i] = w - u > 0 ? round_excess(w, 2.0f, u, u * u) : 0;
        }
        return;
    }
    float *restrict rest = work, *restrict sum = work + arity * stride,
                    *restrict squares = sum + stride, *restrict next = squares + stride,
                    *restrict taken = next + stride;
    for (uint32_t k = 0; k < arity; k++)
        memcpy(rest + k * stride, f + k * stride, count * sizeof(float));
    for (size_t i = 0; i < count; i++)
        sum[i] = squares[i] = excess[i] = 0;
    /* The active prefix: operands by growing gap, until one does not reach G. A lane that has
     * stopped stays: its next gap is no smaller. */
    for (uint32_t m = 1; m <= arity; m++) {
        for (size_t i = 0; i < count; i++) {
            next[i] = INFINITY;
            taken[i] = 0;
        }
        for (uint32_t k = 0; k < arity; k++)
            for (size_t i = 0; i < count; i++)
                next[i] = smaller(next[i], rest[k * stride + i]);
        for (uint32_t k = 0; k < arity; k++)
            for (size_t i = 0; i < count; i++) {
                int hit = (rest[k * stride + i] == next[i]) & (taken[i] == 0);
                rest[k * stride + i] = hit ? INFINITY : rest[k * stride + i];
                taken[i] = hit ? 1.0f : taken[i];
            }
        if (m == 1)
            continue; /* the largest operand itself: gap 0, excess 0 */
        float reached = 0;
        for (size_t i = 0; i < count; i++) {
            int active = w - next[i] > excess[i];
            float u = active ? next[i] : 0;
            sum[i] += u;
            squares[i] += u * u;
            excess[i] = active ? round_excess(w, (float)m, sum[i], squares[i]) : excess[i];
            reached = active ? 1.0f : reached;
        }
        if (reached == 0)
            break;
    }
}

/* ---- walks --------------------------------------------------------------------------------- */

typedef struct slots {
    float *memory;
    size_t stride; /* floats of one array */
} slots;

static float *slot(slots s, size_t index)
{
    return s.memory + index * s.stride;
}

static void combine_round_values(const csg_tape *tape, const csg_tape_node *node, slots s,
                                 size_t first, size_t count, float *work)
{
    float w = tape->parameters[node->parameters + CSG_OPERATOR_N];
    int is_union = node->op == CSG_OP_ROUND_UNION;
    float *top = work, *excess = work + s.stride;
    round_solve(slot(s, first), s.stride, node->arity, is_union, w, count, top, excess,
                work + 2 * s.stride);
    float *out = slot(s, first);
    const float turn = is_union ? 1.0f : -1.0f;
    for (size_t i = 0; i < count; i++)
        out[i] = turn * (top[i] + excess[i]);
}

/* ---- fields combined by a formula -------------------------------------------------------------
 */

static float combine_raise(const csg_tape *tape, const csg_tape_node *node)
{
    return tape->parameters[node->parameters + CSG_LEAF_RAISE];
}

/* Operands that a formula of fewer does not read are the first one. */
static float *operand(slots s, size_t first, uint32_t arity, uint32_t k)
{
    return slot(s, k < arity ? first + k : first);
}

static void combine_values(const csg_tape *tape, const csg_tape_node *node, slots s, size_t first,
                           size_t count, float *work)
{
    const float raise = combine_raise(tape, node);
    const float *a = operand(s, first, node->arity, 0), *b = operand(s, first, node->arity, 1);
    CSG_THIS_FORMULA_KERNEL.values(tape, node, a, b, operand(s, first, node->arity, 2), count,
                                   work);
    float *out = slot(s, first);
    for (size_t i = 0; i < count; i++)
        out[i] = work[i] + raise;
}

/* a = a op b */
static inline void join_siblings(const csg_tape_node *node, const float *parameters, float *a,
                                 const float *b, size_t count)
{
    if (is_of_fields(node->join_blend))
        CSG_THIS_RULE_KERNEL.join(node, parameters, a, b, count);
    else if (is_smooth(node->join_blend))
        CSG_THIS_SMOOTH_KERNEL.values(node, parameters, a, b, count);
    else
        join_values(node, parameters, a, b, count);
}

/* Leaves the result in slot 0; `depth` slots, then the round operator's work. */
static void walk_values(const csg_tape *tape, csg_points p, slots s, uint32_t depth)
{
    size_t top = 0;
    float *work = slot(s, depth);
    csg_warped_points warped;
    warped.warp = 0;
    for (uint32_t n = 0; n < tape->count; n++) {
        const csg_tape_node *node = &tape->nodes[n];
        if (csg_op_is_leaf(node->op)) {
            CSG_THIS_LEAF_KERNEL.values(tape, node, p, slot(s, top++), &warped);
        } else if (csg_op_is_round(node->op)) {
            top -= node->arity;
            combine_round_values(tape, node, s, top++, p.count, work);
        } else if (node->op == CSG_OP_COMBINE) {
            top -= node->arity;
            combine_values(tape, node, s, top++, p.count, work);
        } else if (csg_op_delivers(node->op)) {
            CSG_THIS_RULE_KERNEL.deliver(tape, node, slot(s, top - 1), NULL, NULL, p.count);
        }
        if (node->join) {
            top--;
            join_siblings(node, tape->parameters + node->join_parameters, slot(s, top - 1),
                          slot(s, top), p.count);
        }
    }
}

/* Gradients, colours, or one colour with the gradients that a turning join needs for it. */
typedef struct plan {
    int gradients, colors, first_color;
} plan;

enum { GRADIENT_CHANNELS = 3, COLOR_CHANNELS = 4, MOST_CHANNELS = 4 };

#define GRADIENTS_ONLY ((plan){GRADIENT_CHANNELS, 0, 0})
#define COLORS_ONLY ((plan){0, COLOR_CHANNELS, 0})

static int channels_of(plan wanted)
{
    return wanted.gradients + wanted.colors;
}

/* Slots of a mixed walk: values first (depth of them), then the channels of each. */
static float *channel(slots s, uint32_t depth, size_t index, int c)
{
    return slot(s, depth + index * MOST_CHANNELS + (size_t)c);
}

/* A term of a sum that must not depend on the order of its terms: a multiple of 2^-32 of the size,
 * which doubles add without rounding. */
static inline double grain(double term, double size)
{
    const double large = 0x1.8p20 * size;
    return (term + large) - large;
}

/* Where more than two operands are active, out of their weights. */
static void total_of_many(const float *weights, size_t stride, uint32_t arity, float w,
                          const float *active, float *total, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        double sum = 0;
        for (uint32_t k = 0; k < arity && active[i] > 2; k++)
            sum += grain((double)weights[k * stride + i], (double)w);
        total[i] = active[i] > 2 ? (float)sum : total[i];
    }
}

static void mean_of_many(const float *shares, size_t stride, uint32_t arity, const float *in,
                         size_t in_stride, const float *active, float *mean, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        double sum = 0;
        for (uint32_t k = 0; k < arity && active[i] > 2; k++)
            sum += grain((double)(shares[k * stride + i] * in[k * in_stride + i]), 1);
        mean[i] = (float)sum;
    }
}

static void combine_round_mixed(const csg_tape *tape, const csg_tape_node *node, slots s,
                                uint32_t depth, size_t first, int channels, size_t count,
                                float *work)
{
    float w = tape->parameters[node->parameters + CSG_OPERATOR_N];
    int is_union = node->op == CSG_OP_ROUND_UNION;
    float *top = work, *excess = work + s.stride, *total = work + 2 * s.stride;
    float *active = total + s.stride, *mean = active + s.stride;
    float *gaps = slot(s, first);
    const int many = node->arity > 2;
    round_solve(gaps, s.stride, node->arity, is_union, w, count, top, excess, total);
    for (size_t i = 0; i < count; i++)
        total[i] = active[i] = 0;
    for (uint32_t k = 0; k < node->arity; k++)
        for (size_t i = 0; i < count; i++) {
            float weight = larger(w - gaps[k * s.stride + i] - excess[i], 0);
            gaps[k * s.stride + i] = weight;
            total[i] += weight;
            active[i] += weight > 0 ? 1.0f : 0;
        }
    if (many)
        total_of_many(gaps, s.stride, node->arity, w, active, total, count);
    /* Shares first, so that a lone active operand has exactly 1. */
    for (uint32_t k = 0; k < node->arity; k++)
        for (size_t i = 0; i < count; i++)
            gaps[k * s.stride + i] = quotient(gaps[k * s.stride + i], total[i]);
    for (int c = 0; c < channels; c++) {
        float *out = channel(s, depth, first, c);
        if (many)
            mean_of_many(gaps, s.stride, node->arity, out, MOST_CHANNELS * s.stride, active, mean,
                         count);
        for (size_t i = 0; i < count; i++)
            out[i] = gaps[i] * out[i];
        for (uint32_t k = 1; k < node->arity; k++) {
            const float *in = channel(s, depth, first + k, c);
            for (size_t i = 0; i < count; i++)
                out[i] += gaps[k * s.stride + i] * in[i];
        }
        for (size_t i = 0; many && i < count; i++)
            out[i] = active[i] > 2 ? mean[i] : out[i];
    }
    const float turn = is_union ? 1.0f : -1.0f;
    for (size_t i = 0; i < count; i++)
        gaps[i] = turn * (top[i] + excess[i]);
}

/* Gradients by the chain rule; colours in the proportions of the partial derivatives' sizes. */
static void combine_mixed(const csg_tape *tape, const csg_tape_node *node, slots s, uint32_t depth,
                          size_t first, plan wanted, size_t count, float *work)
{
    const float raise = combine_raise(tape, node);
    float *partial[3] = {work + s.stride, work + 2 * s.stride, work + 3 * s.stride};
    const float *a = operand(s, first, node->arity, 0), *b = operand(s, first, node->arity, 1);
    CSG_THIS_FORMULA_KERNEL.gradients(tape, node, a, b, operand(s, first, node->arity, 2), count,
                                      work, partial[0], partial[1], partial[2]);
    for (int c = 0; c < channels_of(wanted); c++) {
        if (c == wanted.gradients)
            for (size_t i = 0; i < count; i++) {
                float sum = 0;
                for (uint32_t k = 0; k < node->arity; k++)
                    sum += absolute(partial[k][i]);
                for (uint32_t k = 0; k < node->arity; k++)
                    partial[k][i] = sum > 0 ? absolute(partial[k][i]) / sum : k == 0;
            }
        float *out = channel(s, depth, first, c);
        for (size_t i = 0; i < count; i++)
            out[i] = partial[0][i] * out[i];
        for (uint32_t k = 1; k < node->arity; k++) {
            const float *in = channel(s, depth, first + k, c);
            for (size_t i = 0; i < count; i++)
                out[i] += partial[k][i] * in[i];
        }
    }
    float *out = slot(s, first);
    for (size_t i = 0; i < count; i++)
        out[i] = work[i] + raise;
}

/* work: room for a number per operand and plane. */
static fillet_arrays fillet_of(const csg_tape *tape, const csg_tape_node *node, slots s,
                               size_t first, float *work)
{
    const float *own = tape->parameters + node->parameters;
    fillet_numbers(tape, node, (uint32_t *)(void *)work);
    return (fillet_arrays){
        .values = slot(s, first),
        .numbers = (const uint32_t *)(const void *)work,
        .parameters = tape->parameters,
        .stride = s.stride,
        .per = MOST_CHANNELS,
        .operands = node->arity - node->planes,
        .planes = node->planes,
        .turn = csg_op_is_union(node->op) ? 1.0f : -1.0f,
        .radius = (double)own[CSG_OPERATOR_N],
        .to_own = own[CSG_FILLET_IS_SKEWED] > 0 ? own + CSG_FILLET_TO_OWN : NULL,
    };
}

static void leaf_mixed(const csg_tape *tape, const csg_tape_node *node, csg_points p, slots s,
                       uint32_t depth, size_t index, plan wanted, csg_warped_points *warped)
{
    if (wanted.gradients)
        CSG_THIS_LEAF_KERNEL.gradients(tape, node, p, slot(s, index), channel(s, depth, index, 0),
                                       channel(s, depth, index, 1), channel(s, depth, index, 2),
                                       warped);
    else
        CSG_THIS_LEAF_KERNEL.values(tape, node, p, slot(s, index), warped);
    if (!wanted.colors)
        return;
    csg_color color = tape->colors[(uint32_t)tape->parameters[node->parameters + CSG_LEAF_COLOR]];
    const float rgba[COLOR_CHANNELS] = {color.r, color.g, color.b, color.a};
    for (int c = 0; c < wanted.colors; c++) {
        float *out = channel(s, depth, index, wanted.gradients + c);
        for (size_t i = 0; i < p.count; i++)
            out[i] = rgba[wanted.first_color + c];
    }
}

static void deliver_mixed(const csg_tape *tape, const csg_tape_node *node, slots s, uint32_t depth,
                          size_t index, plan wanted, size_t count, float *work)
{
    float *slope = work, *flat = work + s.stride;
    const float *p = tape->parameters + node->parameters;
    p += node->op == CSG_OP_SOFTEN ? 0 : CSG_RULE_DELIVER;
    const float scale = p[CSG_DELIVER_SCALE];
    CSG_THIS_RULE_KERNEL.deliver(tape, node, slot(s, index), slope, flat, count);
    for (int c = 0; c < wanted.gradients; c++) {
        float *restrict out = channel(s, depth, index, c);
        for (size_t i = 0; i < count; i++)
            out[i] = (out[i] * slope[i]) * scale;
    }
    csg_color color = tape->colors[(uint32_t)p[CSG_DELIVER_COLOR]];
    const float rgba[COLOR_CHANNELS] = {color.r, color.g, color.b, color.a};
    for (int c = 0; c < wanted.colors; c++) {
        float *restrict out = channel(s, depth, index, wanted.gradients + c);
        const float end = rgba[wanted.first_color + c];
        for (size_t i = 0; i < count; i++)
            out[i] = flat[i] > 0 ? end : out[i];
    }
}

/* Of fields: gradients by the partial derivatives, colours by the operands' parts. */
static void join_fields_mixed(const csg_tape *tape, const csg_tape_node *node, slots s,
                              uint32_t depth, size_t index, plan wanted, size_t count, float *work)
{
    const float *parameters = tape->parameters + node->join_parameters, *b = slot(s, index + 1);
    float *a = slot(s, index), *by_a = work, *by_b = work + s.stride, *before = work + 2 * s.stride;
    float *ga[MOST_CHANNELS], *gb[MOST_CHANNELS];
    for (int c = 0; c < channels_of(wanted); c++) {
        ga[c] = channel(s, depth, index, c);
        gb[c] = channel(s, depth, index + 1, c);
    }
    memcpy(before, a, count * sizeof *before);
    if (node->join_blend == CSG_BLEND_TURNING) {
        CSG_THIS_RULE_KERNEL.turn(parameters, a, b, ga, gb, by_a, by_b, count);
    } else {
        CSG_THIS_RULE_KERNEL.partials(node, parameters, a, b, by_a, by_b, count);
        CSG_THIS_RULE_KERNEL.join(node, parameters, a, b, count);
    }
    for (int c = 0; c < wanted.gradients; c++)
        combine(ga[c], gb[c], by_a, by_b, count);
    if (wanted.colors)
        CSG_THIS_RULE_KERNEL.shares(node, before, b, by_a, by_b, count);
    for (int c = wanted.gradients; c < channels_of(wanted); c++)
        mix(ga[c], gb[c], by_a, count);
}

static inline void join_mixed(const csg_tape *tape, const csg_tape_node *node, slots s,
                              uint32_t depth, size_t index, plan wanted, size_t count, float *work)
{
    if (is_of_fields(node->join_blend)) {
        join_fields_mixed(tape, node, s, depth, index, wanted, count, work);
        return;
    }
    const float *parameters = tape->parameters + node->join_parameters, *b = slot(s, index + 1);
    float *a = slot(s, index), *share = work, *gain = work + s.stride;
    const int smooth = is_smooth(node->join_blend);
    if (smooth)
        CSG_THIS_SMOOTH_KERNEL.shares(node, parameters, a, b, share, count);
    else
        join_shares(node, parameters, a, b, share, gain, count);
    for (int c = 0; c < wanted.gradients; c++)
        mix(channel(s, depth, index, c), channel(s, depth, index + 1, c), share, count);
    if (wanted.colors && smooth)
        in_proportion(share, count);
    for (int c = wanted.gradients; c < channels_of(wanted); c++)
        mix(channel(s, depth, index, c), channel(s, depth, index + 1, c), share, count);
    if (node->join_blend == CSG_BLEND_ORTHOGONAL)
        for (int c = 0; c < wanted.gradients; c++)
            stretch(channel(s, depth, index, c), gain, count);
    join_siblings(node, parameters, a, b, count);
}

/* Inlined for each plan: with few points the loops over channels are what takes time. */
__attribute__((always_inline)) static inline void walk_mixed(const csg_tape *tape, csg_points p,
                                                             slots s, uint32_t depth, plan wanted)
{
    size_t top = 0;
    float *work = slot(s, depth * (1 + MOST_CHANNELS));
    csg_warped_points warped;
    warped.warp = 0;
    for (uint32_t n = 0; n < tape->count; n++) {
        const csg_tape_node *node = &tape->nodes[n];
        if (csg_op_is_leaf(node->op)) {
            leaf_mixed(tape, node, p, s, depth, top++, wanted, &warped);
        } else if (csg_op_is_round(node->op)) {
            top -= node->arity;
            combine_round_mixed(tape, node, s, depth, top++, channels_of(wanted), p.count, work);
        } else if (csg_op_is_fillet(node->op)) {
            top -= node->arity;
            fillet_arrays arrays = fillet_of(tape, node, s, top, work);
            arrays.channels = channel(s, depth, top++, 0);
            fillet_combine(&arrays, wanted.colors, p.count);
        } else if (node->op == CSG_OP_COMBINE) {
            top -= node->arity;
            combine_mixed(tape, node, s, depth, top++, wanted, p.count, work);
        } else if (csg_op_delivers(node->op)) {
            deliver_mixed(tape, node, s, depth, top - 1, wanted, p.count, work);
        }
        if (node->join) {
            top--;
            join_mixed(tape, node, s, depth, top - 1, wanted, p.count, work);
        }
    }
}

/* Whether a value depends on its operands' gradients. */
static int turns(const csg_tape *tape)
{
    for (uint32_t n = 0; n < tape->count; n++)
        if ((tape->nodes[n].join_blend == CSG_BLEND_TURNING && tape->nodes[n].join) ||
            csg_op_is_fillet(tape->nodes[n].op))
            return 1;
    return 0;
}

/* ---- batches -------------------------------------------------------------------------------- */

static size_t batch_size(uint32_t depth, size_t scratch_floats)
{
    size_t fits = scratch_floats / csg_kernel_arrays(depth) / CSG_LANES * CSG_LANES;
    return fits < CSG_BATCH ? fits : CSG_BATCH;
}

static size_t padded(size_t count)
{
    return (count + CSG_LANES - 1) / CSG_LANES * CSG_LANES;
}

static size_t least(size_t a, size_t b)
{
    return a < b ? a : b;
}

static void values(const csg_tape *tape, const float *x, const float *y, const float *z,
                   size_t count, float *out, float *scratch, size_t scratch_floats)
{
    if (tape->count == 1) { /* most blocks: straight into the result */
        csg_warped_points warped;
        warped.warp = 0;
        CSG_THIS_LEAF_KERNEL.values(tape, tape->nodes, (csg_points){x, y, z, padded(count)}, out,
                                    &warped);
        return;
    }
    uint32_t depth = csg_tape_depth(tape);
    size_t batch = batch_size(depth, scratch_floats);
    slots s = {scratch, batch};
    int turning = tape->turns && turns(tape);
    for (size_t i = 0; i < count; i += batch) {
        size_t n = least(batch, count - i);
        csg_points p = {x + i, y + i, z + i, padded(n)};
        if (turning)
            walk_mixed(tape, p, s, depth, GRADIENTS_ONLY);
        else
            walk_values(tape, p, s, depth);
        memcpy(out + i, slot(s, 0), n * sizeof(float));
    }
}

/* out: for each channel of the plan that is wanted, the first `gradients` of them left out where
 * they are only means. f: values; NULL: not wanted. */
__attribute__((always_inline)) static inline void
mixed(const csg_tape *tape, const float *x, const float *y, const float *z, size_t count, float *f,
      float *const *out, plan wanted, float *scratch, size_t scratch_floats)
{
    uint32_t depth = csg_tape_depth(tape);
    size_t batch = batch_size(depth, scratch_floats);
    slots s = {scratch, batch};
    int first = wanted.colors ? wanted.gradients : 0;
    for (size_t i = 0; i < count; i += batch) {
        size_t n = least(batch, count - i);
        walk_mixed(tape, (csg_points){x + i, y + i, z + i, padded(n)}, s, depth, wanted);
        if (f)
            memcpy(f + i, slot(s, 0), n * sizeof(float));
        for (int c = first; c < channels_of(wanted); c++)
            memcpy(out[c - first] + i, channel(s, depth, 0, c), n * sizeof(float));
    }
}

static void values_and_gradients(const csg_tape *tape, const float *x, const float *y,
                                 const float *z, size_t count, float *f, float *gx, float *gy,
                                 float *gz, float *scratch, size_t scratch_floats)
{
    float *out[GRADIENT_CHANNELS] = {gx, gy, gz};
    mixed(tape, x, y, z, count, f, out, GRADIENTS_ONLY, scratch, scratch_floats);
}

static void gradients(const csg_tape *tape, const float *x, const float *y, const float *z,
                      size_t count, float *gx, float *gy, float *gz, float *scratch,
                      size_t scratch_floats)
{
    values_and_gradients(tape, x, y, z, count, NULL, gx, gy, gz, scratch, scratch_floats);
}

static void colors(const csg_tape *tape, const float *x, const float *y, const float *z,
                   size_t count, float *const rgba[4], float *scratch, size_t scratch_floats)
{
    if (!tape->turns || !turns(tape)) {
        mixed(tape, x, y, z, count, NULL, rgba, COLORS_ONLY, scratch, scratch_floats);
        return;
    }
    for (int c = 0; c < COLOR_CHANNELS; c++)
        mixed(tape, x, y, z, count, NULL, &rgba[c], (plan){GRADIENT_CHANNELS, 1, c}, scratch,
              scratch_floats);
}

/* ---- intervals ------------------------------------------------------------------------------- */

static void combine_intervals(const csg_tape *tape, const csg_tape_node *node, slots lows,
                              slots highs, size_t first)
{
    const float raise = combine_raise(tape, node);
    const float *low[3], *high[3];
    for (uint32_t k = 0; k < 3; k++) {
        low[k] = operand(lows, first, node->arity, k);
        high[k] = operand(highs, first, node->arity, k);
    }
    float *out_low = slot(lows, first), *out_high = slot(highs, first);
    CSG_THIS_FORMULA_KERNEL.box_intervals(tape, node, low, high, out_low, out_high);
    for (int i = 0; i < CSG_OCTANTS; i++) {
        out_low[i] += raise;
        out_high[i] += raise;
    }
}

/* Joins but those of rules are monotone: their values at the operands' ends (operators.md 0). */
static inline void join_intervals(const csg_tape_node *node, const float *parameters, float *a_low,
                                  float *a_high, const float *b_low, const float *b_high)
{
    if (is_of_fields(node->join_blend)) {
        CSG_THIS_RULE_KERNEL.join_intervals(node, parameters, a_low, a_high, b_low, b_high);
    } else if (is_smooth(node->join_blend)) {
        CSG_THIS_SMOOTH_KERNEL.intervals(node, parameters, a_low, a_high, b_low, b_high);
    } else {
        join_values(node, parameters, a_low, b_low, CSG_OCTANTS);
        join_values(node, parameters, a_high, b_high, CSG_OCTANTS);
    }
}

static void intervals(const csg_tape *tape, const float cx[CSG_OCTANTS],
                      const float cy[CSG_OCTANTS], const float cz[CSG_OCTANTS], float radius,
                      const float *turns, float *low, float *high, float *scratch)
{
    uint32_t depth = csg_tape_depth(tape);
    csg_points p = {cx, cy, cz, CSG_OCTANTS};
    slots lows = {scratch, CSG_OCTANTS}, highs = {slot(lows, depth), CSG_OCTANTS};
    float *work = slot(highs, depth);
    size_t top = 0;
    csg_warped_points warped;
    warped.warp = 0;
    for (uint32_t n = 0; n < tape->count; n++) {
        const csg_tape_node *node = &tape->nodes[n];
        if (csg_op_is_leaf(node->op)) {
            CSG_THIS_LEAF_KERNEL.intervals(tape, node, p, radius, slot(lows, top), slot(highs, top),
                                           &warped);
            top++;
        } else if (csg_op_is_round(node->op)) {
            top -= node->arity;
            combine_round_values(tape, node, lows, top, CSG_OCTANTS, work);
            combine_round_values(tape, node, highs, top, CSG_OCTANTS, work);
            top++;
        } else if (csg_op_is_fillet(node->op)) {
            top -= node->arity;
            fillet_arrays arrays = fillet_of(tape, node, lows, top, work);
            const float *of_node = turns ? turns + (size_t)n * 2 * CSG_OCTANTS : NULL;
            fillet_intervals(&arrays, of_node, slot(lows, top), slot(highs, top));
            top++;
        } else if (node->op == CSG_OP_COMBINE) {
            top -= node->arity;
            combine_intervals(tape, node, lows, highs, top++);
        } else if (csg_op_delivers(node->op)) {
            CSG_THIS_RULE_KERNEL.deliver_intervals(tape, node, slot(lows, top - 1),
                                                   slot(highs, top - 1));
        }
        memcpy(low + (size_t)n * CSG_OCTANTS, slot(lows, top - 1), CSG_OCTANTS * sizeof(float));
        memcpy(high + (size_t)n * CSG_OCTANTS, slot(highs, top - 1), CSG_OCTANTS * sizeof(float));
        if (node->join) {
            top--;
            join_intervals(node, tape->parameters + node->join_parameters, slot(lows, top - 1),
                           slot(highs, top - 1), slot(lows, top), slot(highs, top));
        }
    }
}

static void join_alone(const csg_tape *tape, const csg_tape_node *node, float *a, const float *b,
                       size_t count)
{
    join_siblings(node, tape->parameters + node->join_parameters, a, b, count);
}

static void warped(const csg_tape *tape, uint32_t warp, float *x, float *y, float *z, size_t count)
{
    CSG_THIS_WARP_KERNEL.points(tape, warp, x, y, z, count);
}

const csg_kernel CSG_THIS_KERNEL = {
    .name = STRING(CSG_KERNEL),
    .values = values,
    .gradients = gradients,
    .values_and_gradients = values_and_gradients,
    .colors = colors,
    .intervals = intervals,
    .warped = warped,
    .join = join_alone,
    .roots = CSG_THIS_ROOTS,
};
