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
#include "field/kernels/round_kernel.h"
#include "field/kernels/rule_kernel.h"
#include "field/kernels/slots.h"
#include "field/kernels/smooth_kernel.h"
#include "field/kernels/turned_kernel.h"
#include "field/kernels/warp_kernel.h"
#include "field/rule_layout.h"
#include "field/turning.h"

#define STRING_(a) #a
#define STRING(a) STRING_(a)

/* ---- walks --------------------------------------------------------------------------------- */

static void combine_round_values(const csg_tape *tape, const csg_tape_node *node, kernel_slots s,
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

static void combine_values(const csg_tape *tape, const csg_tape_node *node, kernel_slots s,
                           size_t first, size_t count, float *work)
{
    const float raise = combine_raise(tape, node);
    CSG_THIS_FORMULA_KERNEL.combined(tape, node, slot(s, first), s.stride, count, work);
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
static void walk_values(const csg_tape *tape, csg_points p, kernel_slots s, uint32_t depth)
{
    size_t top = 0;
    float *work = slot(s, depth);
    csg_warped_points warped;
    csg_warped_points_begin(&warped);
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

/* Gradients, colours, or one colour with the gradients that a turning join needs for it. With twice
 * the gradients: those that operators see, and behind them the true ones (turned_kernel.h). */
typedef struct plan {
    int gradients, colors, first_color;
} plan;

#define GRADIENTS_ONLY ((plan){GRADIENT_CHANNELS, 0, 0})
#define TRUE_GRADIENTS ((plan){2 * GRADIENT_CHANNELS, 0, 0})
#define COLORS_ONLY ((plan){0, COLOR_CHANNELS, 0})

static int has_true_ones(plan wanted)
{
    return wanted.gradients > GRADIENT_CHANNELS;
}

static int channels_of(plan wanted)
{
    return wanted.gradients + wanted.colors;
}

static void combine_round_mixed(const csg_tape *tape, const csg_tape_node *node, kernel_slots s,
                                uint32_t depth, size_t first, int channels, size_t count,
                                float *work)
{
    float w = tape->parameters[node->parameters + CSG_OPERATOR_N];
    int is_union = node->op == CSG_OP_ROUND_UNION;
    float *top = work, *excess = work + s.stride, *total = work + 2 * s.stride;
    float *active = total + s.stride, *mean = active + s.stride;
    float *gaps = slot(s, first);
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
    const int many = is_any_above(active, 2, count);
    if (many)
        total_of_many(gaps, s.stride, node->arity, w, active, total, count);
    /* Shares first, so that a lone active operand has exactly 1. */
    for (uint32_t k = 0; k < node->arity; k++)
        for (size_t i = 0; i < count; i++)
            gaps[k * s.stride + i] = quotient(gaps[k * s.stride + i], total[i]);
    for (int c = 0; c < channels; c++) {
        float *out = channel(s, depth, first, c);
        if (many)
            mean_of_many(gaps, s.stride, node->arity, out, MOST_CHANNELS * s.stride, mean, count);
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
/* A channel's share of up to three operands, which are number `from` and later ones. */
static void mix_channel(kernel_slots s, uint32_t depth, size_t first, uint32_t from, uint32_t arity,
                        int c, float *const partial[3], size_t count)
{
    float *out = channel(s, depth, first, c);
    for (uint32_t k = from; k < arity && k < from + 3; k++) {
        const float *in = channel(s, depth, first + k, c), *by = partial[k - from];
        for (size_t i = 0; i < count; i++)
            out[i] = k ? out[i] + by[i] * in[i] : by[i] * in[i];
    }
}

/* Colours mix in the proportions of the partial derivatives; where all are 0 they are the first's.
 */
static void take_shares(const csg_tape *tape, const csg_tape_node *node, kernel_slots s,
                        size_t first, uint32_t from, size_t count, float *work,
                        float *const partial[3])
{
    float *sum = work + 4 * s.stride;
    uint32_t here = node->arity - from < 3 ? node->arity - from : 3;
    if (from == 0)
        for (uint32_t at = 0; at < node->arity; at += 3) {
            if (at > 0) /* and the first ones again, below */
                CSG_THIS_FORMULA_KERNEL.partials(tape, node, slot(s, first), s.stride, count,
                                                 at / 3, work, partial);
            for (uint32_t k = 0; k < 3 && at + k < node->arity; k++)
                for (size_t i = 0; i < count; i++)
                    sum[i] = (at + k ? sum[i] : 0) + absolute(partial[k][i]);
        }
    if (from == 0 && node->arity > 3)
        CSG_THIS_FORMULA_KERNEL.partials(tape, node, slot(s, first), s.stride, count, 0, work,
                                         partial);
    for (size_t i = 0; i < count; i++)
        for (uint32_t k = 0; k < here; k++)
            partial[k][i] = sum[i] > 0 ? absolute(partial[k][i]) / sum[i] : from + k == 0;
}

static void combine_mixed(const csg_tape *tape, const csg_tape_node *node, kernel_slots s,
                          uint32_t depth, size_t first, plan wanted, size_t count, float *work)
{
    const float raise = combine_raise(tape, node);
    float *partial[3] = {work + s.stride, work + 2 * s.stride, work + 3 * s.stride};
    for (uint32_t from = 0; from < node->arity; from += 3) {
        CSG_THIS_FORMULA_KERNEL.partials(tape, node, slot(s, first), s.stride, count, from / 3,
                                         work, partial);
        for (int c = 0; c < channels_of(wanted); c++) {
            if (c == wanted.gradients)
                take_shares(tape, node, s, first, from, count, work, partial);
            mix_channel(s, depth, first, from, node->arity, c, partial, count);
        }
    }
    float *out = slot(s, first);
    for (size_t i = 0; i < count; i++)
        out[i] = work[i] + raise;
}

/* work: room for a number per operand and plane. */
static fillet_arrays fillet_of(const csg_tape *tape, const csg_tape_node *node, kernel_slots s,
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
        .has_apart = own[CSG_FILLET_HAS_APART] > 0,
        .own_number = (uint32_t)own[CSG_FILLET_PLANES_ONCE],
    };
}

static void leaf_mixed(const csg_tape *tape, const csg_tape_node *node, csg_points p,
                       kernel_slots s, uint32_t depth, size_t index, plan wanted,
                       csg_warped_points *warped)
{
    if (wanted.gradients)
        CSG_THIS_LEAF_KERNEL.gradients(tape, node, p, slot(s, index), channel(s, depth, index, 0),
                                       channel(s, depth, index, 1), channel(s, depth, index, 2),
                                       warped);
    else
        CSG_THIS_LEAF_KERNEL.values(tape, node, p, slot(s, index), warped);
    for (int c = GRADIENT_CHANNELS; c < wanted.gradients; c++)
        memcpy(channel(s, depth, index, c), channel(s, depth, index, c - GRADIENT_CHANNELS),
               p.count * sizeof(float));
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

static void deliver_mixed(const csg_tape *tape, const csg_tape_node *node, kernel_slots s,
                          uint32_t depth, size_t index, plan wanted, size_t count, float *work)
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
static void join_fields_mixed(const csg_tape *tape, const csg_tape_node *node, kernel_slots s,
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

static inline void join_mixed(const csg_tape *tape, const csg_tape_node *node, kernel_slots s,
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
    for (int c = wanted.gradients; c < channels_of(wanted) && !node->is_plane; c++)
        mix(channel(s, depth, index, c), channel(s, depth, index + 1, c), share, count);
    if (node->join_blend == CSG_BLEND_ORTHOGONAL)
        for (int c = 0; c < wanted.gradients; c++)
            stretch(channel(s, depth, index, c), gain, count);
    join_siblings(node, parameters, a, b, count);
}

/* The true gradient's channels of a result. */
static void add_turned(const turned *turn, kernel_slots s, uint32_t depth, size_t index)
{
    float *const out[3] = {channel(s, depth, index, GRADIENT_CHANNELS),
                           channel(s, depth, index, GRADIENT_CHANNELS + 1),
                           channel(s, depth, index, GRADIENT_CHANNELS + 2)};
    turned_add(turn, out);
}

static inline void fillet_mixed(const csg_tape *tape, const csg_tape_node *node, csg_points p,
                                kernel_slots s, uint32_t depth, size_t index, plan wanted,
                                float *work, turned *turn)
{
    fillet_arrays arrays = fillet_of(tape, node, s, index, work);
    arrays.channels = channel(s, depth, index, 0);
    int gains = has_true_ones(wanted) && turned_of_fillet(turn, node, &arrays, p);
    fillet_combine(&arrays, wanted.gradients, wanted.colors, p.count);
    if (gains)
        add_turned(turn, s, depth, index);
}

static void turned_join_mixed(const csg_tape *tape, const csg_tape_node *node, csg_points p,
                              kernel_slots s, uint32_t depth, size_t index, plan wanted,
                              float *work, turned *turn)
{
    const float *const values[2] = {slot(s, index), slot(s, index + 1)};
    const float *const gradients[2][3] = {
        {channel(s, depth, index, 0), channel(s, depth, index, 1), channel(s, depth, index, 2)},
        {channel(s, depth, index + 1, 0), channel(s, depth, index + 1, 1),
         channel(s, depth, index + 1, 2)},
    };
    const float *parameters = tape->parameters + node->join_parameters;
    int gains = turned_of_join(turn, node, parameters, values, gradients, p);
    join_mixed(tape, node, s, depth, index, wanted, p.count, work);
    if (gains)
        add_turned(turn, s, depth, index);
}

/* Inlined for each plan: with few points the loops over channels are what takes time. turn: for
 * true gradients. The last node's join is not this tape's own. */
__attribute__((always_inline)) static inline void walk_mixed(const csg_tape *tape, csg_points p,
                                                             kernel_slots s, uint32_t depth,
                                                             plan wanted, turned *turn)
{
    size_t top = 0;
    float *work = slot(s, depth * (1 + MOST_CHANNELS));
    csg_warped_points warped;
    csg_warped_points_begin(&warped);
    for (uint32_t n = 0; n < tape->count; n++) {
        const csg_tape_node *node = &tape->nodes[n];
        if (csg_op_is_leaf(node->op)) {
            leaf_mixed(tape, node, p, s, depth, top++, wanted, &warped);
        } else if (csg_op_is_round(node->op)) {
            top -= node->arity;
            combine_round_mixed(tape, node, s, depth, top++, channels_of(wanted), p.count, work);
        } else if (csg_op_is_fillet(node->op)) {
            top -= node->arity;
            fillet_mixed(tape, node, p, s, depth, top++, wanted, work, turn);
        } else if (node->op == CSG_OP_COMBINE) {
            top -= node->arity;
            combine_mixed(tape, node, s, depth, top++, wanted, p.count, work);
        } else if (csg_op_delivers(node->op)) {
            deliver_mixed(tape, node, s, depth, top - 1, wanted, p.count, work);
        }
        if (node->join && top > 1) {
            top--;
            if (has_true_ones(wanted) && node->join_blend == CSG_BLEND_TURNING)
                turned_join_mixed(tape, node, p, s, depth, top - 1, wanted, work, turn);
            else
                join_mixed(tape, node, s, depth, top - 1, wanted, p.count, work);
        }
    }
}

static void walk_gradients(const csg_tape *tape, csg_points p, kernel_slots s, uint32_t depth)
{
    walk_mixed(tape, p, s, depth, GRADIENTS_ONLY, NULL);
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

static size_t padded(size_t count)
{
    return (count + CSG_VECTOR - 1) / CSG_VECTOR * CSG_VECTOR;
}

static size_t least(size_t a, size_t b)
{
    return a < b ? a : b;
}

static size_t batch_size(uint32_t depth, size_t scratch_floats)
{
    size_t fits = scratch_floats / csg_kernel_arrays(depth) / CSG_LANES * CSG_LANES;
    return least(fits, CSG_BATCH);
}

/* Arrays no longer than the points need: those of a few points then lie in the innermost cache side
 * by side, where arrays that are a power of two apart would drive each other out of it. */
static kernel_slots slots_for(size_t count, uint32_t depth, float *scratch, size_t scratch_floats)
{
    return (kernel_slots){scratch, least(batch_size(depth, scratch_floats), padded(count))};
}

static void values(const csg_tape *tape, const float *x, const float *y, const float *z,
                   size_t count, float *out, float *scratch, size_t scratch_floats)
{
    if (tape->count == 1) { /* most blocks: straight into the result */
        csg_warped_points warped;
        csg_warped_points_begin(&warped);
        CSG_THIS_LEAF_KERNEL.values(tape, tape->nodes, (csg_points){x, y, z, padded(count)}, out,
                                    &warped);
        return;
    }
    uint32_t depth = csg_tape_depth(tape);
    kernel_slots s = slots_for(count, depth, scratch, scratch_floats);
    int turning = tape->turns && turns(tape);
    for (size_t i = 0; i < count; i += s.stride) {
        size_t n = least(s.stride, count - i);
        csg_points p = {x + i, y + i, z + i, padded(n)};
        if (turning)
            walk_gradients(tape, p, s, depth);
        else
            walk_values(tape, p, s, depth);
        memcpy(out + i, slot(s, 0), n * sizeof(float));
    }
}

/* out: for each channel of the plan that is wanted, those before them left out where they are only
 * means. f: values; NULL: not wanted. turn: for true gradients. */
__attribute__((always_inline)) static inline void
mixed(const csg_tape *tape, const float *x, const float *y, const float *z, size_t count, float *f,
      float *const *out, plan wanted, kernel_slots s, uint32_t depth, turned *turn)
{
    int first = wanted.colors ? wanted.gradients : wanted.gradients - GRADIENT_CHANNELS;
    for (size_t i = 0; i < count; i += s.stride) {
        size_t n = least(s.stride, count - i);
        walk_mixed(tape, (csg_points){x + i, y + i, z + i, padded(n)}, s, depth, wanted, turn);
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
    uint32_t depth = csg_tape_depth(tape);
    kernel_slots s = slots_for(count, depth, scratch, scratch_floats);
    mixed(tape, x, y, z, count, f, out, GRADIENTS_ONLY, s, depth, NULL);
}

static void gradients(const csg_tape *tape, const float *x, const float *y, const float *z,
                      size_t count, float *gx, float *gy, float *gz, float *scratch,
                      size_t scratch_floats)
{
    values_and_gradients(tape, x, y, z, count, NULL, gx, gy, gz, scratch, scratch_floats);
}

/* A third of the scratch is for the walk, the rest for what it asks of places nearby. */
static void true_gradients(const csg_tape *tape, const float *x, const float *y, const float *z,
                           size_t count, float *gx, float *gy, float *gz, float *scratch,
                           size_t scratch_floats)
{
    float *out[GRADIENT_CHANNELS] = {gx, gy, gz};
    uint32_t depth = csg_tape_depth(tape);
    if (!tape->turns || !turns(tape)) {
        gradients(tape, x, y, z, count, gx, gy, gz, scratch, scratch_floats);
        return;
    }
    kernel_slots s = {scratch, batch_size(depth, scratch_floats / CSG_KERNEL_WALKS)};
    kernel_slots room = {slot(s, csg_kernel_arrays(depth)), s.stride};
    turned turn; /* not filled: it is large */
    turn.tape = tape;
    turn.room = room;
    mixed(tape, x, y, z, count, NULL, out, TRUE_GRADIENTS, s, depth, &turn);
}

static void colors(const csg_tape *tape, const float *x, const float *y, const float *z,
                   size_t count, float *const rgba[4], float *scratch, size_t scratch_floats)
{
    uint32_t depth = csg_tape_depth(tape);
    kernel_slots s = slots_for(count, depth, scratch, scratch_floats);
    if (!tape->turns || !turns(tape)) {
        mixed(tape, x, y, z, count, NULL, rgba, COLORS_ONLY, s, depth, NULL);
        return;
    }
    for (int c = 0; c < COLOR_CHANNELS; c++)
        mixed(tape, x, y, z, count, NULL, &rgba[c], (plan){GRADIENT_CHANNELS, 1, c}, s, depth,
              NULL);
}

/* ---- intervals ------------------------------------------------------------------------------- */

static void combine_intervals(const csg_tape *tape, const csg_tape_node *node, kernel_slots lows,
                              kernel_slots highs, size_t first)
{
    const float raise = combine_raise(tape, node);
    float *out_low = slot(lows, first), *out_high = slot(highs, first);
    CSG_THIS_FORMULA_KERNEL.box_intervals(tape, node, slot(lows, first), slot(highs, first),
                                          lows.stride, out_low, out_high);
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
    kernel_slots lows = {scratch, CSG_OCTANTS}, highs = {slot(lows, depth), CSG_OCTANTS};
    float *work = slot(highs, depth);
    size_t top = 0;
    csg_warped_points warped;
    csg_warped_points_begin(&warped);
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

static void leaves(const csg_tape *tape, const float *x, const float *y, const float *z,
                   size_t count, float *out)
{
    csg_points p = {x, y, z, count};
    csg_warped_points warped;
    csg_warped_points_begin(&warped);
    for (uint32_t n = 0; n < tape->count; n++)
        if (csg_op_is_leaf(tape->nodes[n].op))
            CSG_THIS_LEAF_KERNEL.values(tape, &tape->nodes[n], p, out + count * n, &warped);
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
    .true_gradients = true_gradients,
    .colors = colors,
    .intervals = intervals,
    .leaves = leaves,
    .warped = warped,
    .join = join_alone,
    .roots = CSG_THIS_ROOTS,
};
