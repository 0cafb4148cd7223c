/* SPDX-License-Identifier: MIT
 * The kernels: a tape over batches of points. This file is built once per instruction set (see
 * meson.build); the loops over points are plain C that the compiler turns into vectors, the
 * formulas are in formulas.h, the leaves in leaf_kernel.c. CSG_KERNEL names the build.
 *
 * Three walks over a tape, all on a stack of slots:
 *   values     a slot is one array
 *   mixed      a slot is a value and several channels that mix in the proportions of the
 *              operators' partial derivatives: gradients (3) or colours (4)
 *   intervals  a slot is a low and a high array of eight lanes
 */
#include "field/kernel.h"

#include <string.h>

#include "field/formula_kernel.h"
#include "field/formulas.h"
#include "field/leaf_kernel.h"

#define STRING_(a) #a
#define STRING(a) STRING_(a)

/* ---- joins: two operands ----------------------------------------------------------------- */

#define EACH_FOLD(X)                                                                               \
    X(HYPERBOLA, hyperbola)                                                                        \
    X(RECIPROCAL, reciprocal)                                                                      \
    X(OVERBLEND, overblend) X(COSINE, cosine) X(PARABOLA, parabola) X(CHAMFER, chamfer)

/* The intersection of a and b, raised by n, whose gradients are at right angles. Away from the edge
 * the smaller one, bit for bit. */
static inline float orthogonal(float n, float a, float b)
{
    float u = a - n, v = b - n;
    float edge = n - sqrtf(u * u + v * v);
    return (u < 0) & (v < 0) ? edge : smaller(a, b);
}

/* a = a op b. */
static void join_values(const csg_tape_node *node, const float *parameters, float *restrict a,
                        const float *restrict b, size_t count)
{
    const float n = parameters[CSG_OPERATOR_N], chi = parameters[CSG_OPERATOR_SUPPORT];
    const int is_union = node->join == CSG_JOIN_UNION;
    switch (node->join_blend) {
#define CASE(NAME, name)                                                                           \
    case CSG_BLEND_##NAME:                                                                         \
        if (is_union)                                                                              \
            for (size_t i = 0; i < count; i++)                                                     \
                a[i] = larger(a[i], b[i]) + blend_##name(n, chi, absolute(a[i] - b[i])).value;     \
        else                                                                                       \
            for (size_t i = 0; i < count; i++)                                                     \
                a[i] = smaller(a[i], b[i]) - blend_##name(n, chi, absolute(a[i] - b[i])).value;    \
        break;
        EACH_FOLD(CASE)
#undef CASE
    case CSG_BLEND_ORTHOGONAL:
        for (size_t i = 0; i < count; i++)
            a[i] = is_union ? -orthogonal(-n, -a[i], -b[i]) : orthogonal(n, a[i], b[i]);
        break;
    default: /* SHARP */
        if (is_union)
            for (size_t i = 0; i < count; i++)
                a[i] = larger(a[i], b[i]);
        else
            for (size_t i = 0; i < count; i++)
                a[i] = smaller(a[i], b[i]);
    }
}

/* share[i] of operand a in the derivative; b has the rest. Changes neither. Where the partial
 * derivatives do not add up to 1, at an orthogonal edge, gain[i] is their sum. */
static void join_shares(const csg_tape_node *node, const float *parameters, const float *restrict a,
                        const float *restrict b, float *restrict share, float *restrict gain,
                        size_t count)
{
    const float n = parameters[CSG_OPERATOR_N], chi = parameters[CSG_OPERATOR_SUPPORT];
    const float turn = node->join == CSG_JOIN_UNION ? 1.0f : -1.0f;
    switch (node->join_blend) {
#define CASE(NAME, name)                                                                           \
    case CSG_BLEND_##NAME:                                                                         \
        for (size_t i = 0; i < count; i++) {                                                       \
            float slope = blend_##name(n, chi, absolute(a[i] - b[i])).slope;                       \
            share[i] = turn * a[i] > turn * b[i] ? 1.0f + slope : -slope;                          \
        }                                                                                          \
        break;
        EACH_FOLD(CASE)
#undef CASE
    case CSG_BLEND_ORTHOGONAL:
        for (size_t i = 0; i < count; i++) {
            float u = turn * (a[i] - n), v = turn * (b[i] - n); /* edge where both are positive */
            int edge = (u > 0) & (v > 0);
            float sum = u + v;
            share[i] = edge ? u / sum : u > v ? 1.0f : 0.0f;
            gain[i] = edge ? sum / sqrtf(u * u + v * v) : 1.0f;
        }
        break;
    default:
        for (size_t i = 0; i < count; i++)
            share[i] = turn * a[i] > turn * b[i] ? 1.0f : 0.0f;
    }
}

/* ---- the round operator: all operands at once -------------------------------------------- */

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

/* Leaves the result in slot 0; `depth` slots, then the round operator's work. */
static void walk_values(const csg_tape *tape, csg_points p, slots s, uint32_t depth)
{
    size_t top = 0;
    float *work = slot(s, depth);
    for (uint32_t n = 0; n < tape->count; n++) {
        const csg_tape_node *node = &tape->nodes[n];
        if (csg_op_is_leaf(node->op)) {
            CSG_THIS_LEAF_KERNEL.values(tape, node, p, slot(s, top++));
        } else if (csg_op_is_round(node->op)) {
            top -= node->arity;
            combine_round_values(tape, node, s, top++, p.count, work);
        } else if (node->op == CSG_OP_COMBINE) {
            top -= node->arity;
            combine_values(tape, node, s, top++, p.count, work);
        }
        if (node->join) {
            top--;
            join_values(node, tape->parameters + node->join_parameters, slot(s, top - 1),
                        slot(s, top), p.count);
        }
    }
}

enum { GRADIENT_CHANNELS = 3, COLOR_CHANNELS = 4, MOST_CHANNELS = 4 };

/* Slots of a mixed walk: values first (depth of them), then the channels of each. */
static float *channel(slots s, uint32_t depth, size_t index, int c)
{
    return slot(s, depth + index * MOST_CHANNELS + (size_t)c);
}

static void mix(float *restrict a, const float *restrict b, const float *restrict share,
                size_t count)
{
    for (size_t i = 0; i < count; i++)
        a[i] = share[i] * a[i] + (1.0f - share[i]) * b[i];
}

static void stretch(float *restrict a, const float *restrict gain, size_t count)
{
    for (size_t i = 0; i < count; i++)
        a[i] *= gain[i];
}

static void combine_round_mixed(const csg_tape *tape, const csg_tape_node *node, slots s,
                                uint32_t depth, size_t first, int channels, size_t count,
                                float *work)
{
    float w = tape->parameters[node->parameters + CSG_OPERATOR_N];
    int is_union = node->op == CSG_OP_ROUND_UNION;
    float *top = work, *excess = work + s.stride, *total = work + 2 * s.stride;
    float *gaps = slot(s, first);
    round_solve(gaps, s.stride, node->arity, is_union, w, count, top, excess, total);
    for (size_t i = 0; i < count; i++)
        total[i] = 0;
    for (uint32_t k = 0; k < node->arity; k++)
        for (size_t i = 0; i < count; i++) {
            float weight = larger(w - gaps[k * s.stride + i] - excess[i], 0);
            gaps[k * s.stride + i] = weight;
            total[i] += weight;
        }
    /* Shares first, so that a lone active operand has exactly 1. */
    for (uint32_t k = 0; k < node->arity; k++)
        for (size_t i = 0; i < count; i++)
            gaps[k * s.stride + i] = quotient(gaps[k * s.stride + i], total[i]);
    for (int c = 0; c < channels; c++) {
        float *out = channel(s, depth, first, c);
        for (size_t i = 0; i < count; i++)
            out[i] = gaps[i] * out[i];
        for (uint32_t k = 1; k < node->arity; k++) {
            const float *in = channel(s, depth, first + k, c);
            for (size_t i = 0; i < count; i++)
                out[i] += gaps[k * s.stride + i] * in[i];
        }
    }
    const float turn = is_union ? 1.0f : -1.0f;
    for (size_t i = 0; i < count; i++)
        gaps[i] = turn * (top[i] + excess[i]);
}

/* Gradients by the chain rule; colours in the proportions of the partial derivatives' sizes. */
static void combine_mixed(const csg_tape *tape, const csg_tape_node *node, slots s, uint32_t depth,
                          size_t first, int channels, size_t count, float *work)
{
    const float raise = combine_raise(tape, node);
    float *partial[3] = {work + s.stride, work + 2 * s.stride, work + 3 * s.stride};
    const float *a = operand(s, first, node->arity, 0), *b = operand(s, first, node->arity, 1);
    CSG_THIS_FORMULA_KERNEL.gradients(tape, node, a, b, operand(s, first, node->arity, 2), count,
                                      work, partial[0], partial[1], partial[2]);
    if (channels == COLOR_CHANNELS)
        for (size_t i = 0; i < count; i++) {
            float sum = 0;
            for (uint32_t k = 0; k < node->arity; k++)
                sum += absolute(partial[k][i]);
            for (uint32_t k = 0; k < node->arity; k++)
                partial[k][i] = sum > 0 ? absolute(partial[k][i]) / sum : k == 0;
        }
    for (int c = 0; c < channels; c++) {
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

static void leaf_mixed(const csg_tape *tape, const csg_tape_node *node, csg_points p, slots s,
                       uint32_t depth, size_t index, int channels)
{
    if (channels == GRADIENT_CHANNELS) {
        CSG_THIS_LEAF_KERNEL.gradients(tape, node, p, slot(s, index), channel(s, depth, index, 0),
                                       channel(s, depth, index, 1), channel(s, depth, index, 2));
        return;
    }
    CSG_THIS_LEAF_KERNEL.values(tape, node, p, slot(s, index));
    csg_color color = tape->colors[(uint32_t)tape->parameters[node->parameters + CSG_LEAF_COLOR]];
    const float rgba[COLOR_CHANNELS] = {color.r, color.g, color.b, color.a};
    for (int c = 0; c < COLOR_CHANNELS; c++) {
        float *out = channel(s, depth, index, c);
        for (size_t i = 0; i < p.count; i++)
            out[i] = rgba[c];
    }
}

static void walk_mixed(const csg_tape *tape, csg_points p, slots s, uint32_t depth, int channels)
{
    size_t top = 0;
    float *work = slot(s, depth * (1 + MOST_CHANNELS));
    for (uint32_t n = 0; n < tape->count; n++) {
        const csg_tape_node *node = &tape->nodes[n];
        if (csg_op_is_leaf(node->op)) {
            leaf_mixed(tape, node, p, s, depth, top++, channels);
        } else if (csg_op_is_round(node->op)) {
            top -= node->arity;
            combine_round_mixed(tape, node, s, depth, top++, channels, p.count, work);
        } else if (node->op == CSG_OP_COMBINE) {
            top -= node->arity;
            combine_mixed(tape, node, s, depth, top++, channels, p.count, work);
        }
        if (node->join) {
            top--;
            const float *parameters = tape->parameters + node->join_parameters;
            float *gain = work + s.stride;
            join_shares(node, parameters, slot(s, top - 1), slot(s, top), work, gain, p.count);
            for (int c = 0; c < channels; c++)
                mix(channel(s, depth, top - 1, c), channel(s, depth, top, c), work, p.count);
            if (node->join_blend == CSG_BLEND_ORTHOGONAL && channels == GRADIENT_CHANNELS)
                for (int c = 0; c < channels; c++)
                    stretch(channel(s, depth, top - 1, c), gain, p.count);
            join_values(node, parameters, slot(s, top - 1), slot(s, top), p.count);
        }
    }
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
        CSG_THIS_LEAF_KERNEL.values(tape, tape->nodes, (csg_points){x, y, z, padded(count)}, out);
        return;
    }
    uint32_t depth = csg_tape_depth(tape);
    size_t batch = batch_size(depth, scratch_floats);
    slots s = {scratch, batch};
    for (size_t i = 0; i < count; i += batch) {
        size_t n = least(batch, count - i);
        walk_values(tape, (csg_points){x + i, y + i, z + i, padded(n)}, s, depth);
        memcpy(out + i, slot(s, 0), n * sizeof(float));
    }
}

static void mixed(const csg_tape *tape, const float *x, const float *y, const float *z,
                  size_t count, float *const *out, int channels, float *scratch,
                  size_t scratch_floats)
{
    uint32_t depth = csg_tape_depth(tape);
    size_t batch = batch_size(depth, scratch_floats);
    slots s = {scratch, batch};
    for (size_t i = 0; i < count; i += batch) {
        size_t n = least(batch, count - i);
        walk_mixed(tape, (csg_points){x + i, y + i, z + i, padded(n)}, s, depth, channels);
        for (int c = 0; c < channels; c++)
            memcpy(out[c] + i, channel(s, depth, 0, c), n * sizeof(float));
    }
}

static void gradients(const csg_tape *tape, const float *x, const float *y, const float *z,
                      size_t count, float *gx, float *gy, float *gz, float *scratch,
                      size_t scratch_floats)
{
    float *out[GRADIENT_CHANNELS] = {gx, gy, gz};
    mixed(tape, x, y, z, count, out, GRADIENT_CHANNELS, scratch, scratch_floats);
}

static void colors(const csg_tape *tape, const float *x, const float *y, const float *z,
                   size_t count, float *const rgba[4], float *scratch, size_t scratch_floats)
{
    mixed(tape, x, y, z, count, rgba, COLOR_CHANNELS, scratch, scratch_floats);
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

/* Operators but these are monotone: its value at the operands' ends (operators.md 0). */
static void intervals(const csg_tape *tape, const float cx[CSG_OCTANTS],
                      const float cy[CSG_OCTANTS], const float cz[CSG_OCTANTS], float radius,
                      float *low, float *high, float *scratch)
{
    uint32_t depth = csg_tape_depth(tape);
    csg_points p = {cx, cy, cz, CSG_OCTANTS};
    slots lows = {scratch, CSG_OCTANTS}, highs = {slot(lows, depth), CSG_OCTANTS};
    float *work = slot(highs, depth);
    size_t top = 0;
    for (uint32_t n = 0; n < tape->count; n++) {
        const csg_tape_node *node = &tape->nodes[n];
        if (csg_op_is_leaf(node->op)) {
            CSG_THIS_LEAF_KERNEL.intervals(tape, node, p, radius, slot(lows, top),
                                           slot(highs, top));
            top++;
        } else if (csg_op_is_round(node->op)) {
            top -= node->arity;
            combine_round_values(tape, node, lows, top, CSG_OCTANTS, work);
            combine_round_values(tape, node, highs, top, CSG_OCTANTS, work);
            top++;
        } else if (node->op == CSG_OP_COMBINE) {
            top -= node->arity;
            combine_intervals(tape, node, lows, highs, top++);
        }
        memcpy(low + (size_t)n * CSG_OCTANTS, slot(lows, top - 1), CSG_OCTANTS * sizeof(float));
        memcpy(high + (size_t)n * CSG_OCTANTS, slot(highs, top - 1), CSG_OCTANTS * sizeof(float));
        if (node->join) {
            top--;
            const float *parameters = tape->parameters + node->join_parameters;
            join_values(node, parameters, slot(lows, top - 1), slot(lows, top), CSG_OCTANTS);
            join_values(node, parameters, slot(highs, top - 1), slot(highs, top), CSG_OCTANTS);
        }
    }
}

const csg_kernel CSG_THIS_KERNEL = {
    .name = STRING(CSG_KERNEL),
    .values = values,
    .gradients = gradients,
    .colors = colors,
    .intervals = intervals,
    .roots = CSG_THIS_ROOTS,
};
