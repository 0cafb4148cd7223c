/* SPDX-License-Identifier: MIT
 * Formulas step by step, each over a whole chunk of points before the next; functions.h has the
 * operations. Built once per instruction set, as kernel.c is.
 *
 * A chunk's slots are on the stack: the point's own coordinates first, then the steps' values
 * (compile_formula.c has shared them out). A step never writes a slot that it reads.
 */
#include "field/kernels/formula_kernel.h"

#include "field/kernels/functions.h"
#include "scene/formula/formula.h"

enum {
    VALUE_FLOATS = 16384, /* CSG_FORMULA_SLOTS chunks of CSG_LANES at least */
    GRADIENT_ARRAYS = 4,  /* of a slot: value and derivatives */
    GRADIENT_FLOATS = 32768 + 2 * CSG_BATCH,
    RANGE_LANES = 2 * CSG_OCTANTS /* cubes, then their centres */
};
_Static_assert(CSG_FORMULA_SLOTS *CSG_LANES <= VALUE_FLOATS, "a chunk fits");
_Static_assert(CSG_FORMULA_SLOTS *CSG_LANES *GRADIENT_ARRAYS <= 32768, "a chunk fits");

static size_t chunk_size(size_t floats, size_t slots)
{
    size_t fits = floats / slots / CSG_LANES * CSG_LANES;
    return fits < CSG_BATCH ? fits : CSG_BATCH;
}

/* ---- the point's own coordinates ------------------------------------------------------------- */

/* Row of the frame as m, t: own = m . p + t. */
typedef struct row {
    float m[3], t;
} row;

static row row_of(const csg_tape_node *node, const float *frame, int axis)
{
    row r = {{0, 0, 0}, 0};
    if (node->frame == CSG_FRAME_OFFSET) {
        r.m[axis] = 1.0f;
        r.t = -frame[axis];
    } else {
        memcpy(r.m, frame + 3 * axis, sizeof r.m);
        r.t = frame[9 + axis];
    }
    return r;
}

/* One coordinate of count points, kept in the domain. */
static void own_coordinates(row r, bool offset, int axis, const float *const p[3], float low,
                            float high, float *restrict out, size_t count)
{
    const float *restrict x = p[0], *restrict y = p[1], *restrict z = p[2];
    const float *restrict along = p[axis];
    if (offset)
        for (size_t i = 0; i < count; i++)
            out[i] = smaller(larger(along[i] + r.t, low), high);
    else
        for (size_t i = 0; i < count; i++)
            out[i] =
                smaller(larger(r.m[0] * x[i] + r.m[1] * y[i] + r.m[2] * z[i] + r.t, low), high);
}

static void place_points(const csg_tape *tape, const csg_tape_node *node,
                         const csg_tape_formula *formula, const float *const p[3], float *slots,
                         size_t stride, size_t count)
{
    const float *frame = tape->parameters + node->parameters + CSG_LEAF_FRAME;
    for (int axis = 0; axis < 3; axis++)
        own_coordinates(row_of(node, frame, axis), node->frame == CSG_FRAME_OFFSET, axis, p,
                        formula->low[axis], formula->high[axis], slots + (size_t)axis * stride,
                        count);
}

/* The scale that the operands' values come with. */
static float operand_scale(const csg_tape *tape, const csg_tape_node *node)
{
    return tape->parameters[node->parameters + CSG_LEAF_FRAME];
}

static void place_operands(const csg_tape *tape, const csg_tape_node *node, const float *operands,
                           size_t operand_stride, float *slots, size_t stride, size_t count)
{
    const float scale = operand_scale(tape, node);
    for (uint32_t k = 0; k < node->arity; k++) {
        const float *restrict in = operands + k * operand_stride;
        float *restrict out = slots + k * stride;
        for (size_t i = 0; i < count; i++)
            out[i] = scale * in[i] + 0.0f;
    }
}

/* Keeps to numbers: NaN is far outside. */
static inline float kept(float v)
{
    const float far = (float)CSG_FORMULA_FAR;
    float a = v > -far ? v : -far;
    return a < far ? a : far;
}

/* ---- values -----------------------------------------------------------------------------------
 */

#define EACH_POINT(expression)                                                                     \
    for (size_t i = 0; i < count; i++)                                                             \
    out[i] = (expression)
#define VALUES_0(NAME, name)
#define VALUES_1(NAME, name)                                                                       \
    case CSG_FORMULA_##NAME:                                                                       \
        EACH_POINT(value_##name(a[i], 0));                                                         \
        break;
#define VALUES_2(NAME, name)                                                                       \
    case CSG_FORMULA_##NAME:                                                                       \
        if (step->constant == CSG_CONSTANT_NONE)                                                   \
            EACH_POINT(value_##name(a[i], b[i]));                                                  \
        else if (step->constant == CSG_CONSTANT_B)                                                 \
            EACH_POINT(value_##name(a[i], c));                                                     \
        else                                                                                       \
            EACH_POINT(value_##name(c, b[i]));                                                     \
        break;

static void step_values(const csg_tape_step *step, const float *restrict a, const float *restrict b,
                        float *restrict out, size_t count)
{
    const float c = step->value;
    switch (step->op) {
#define CSG_FORMULA_OP(NAME, name, arity) VALUES_##arity(NAME, name)
#include "scene/formula/formula.def"
#undef CSG_FORMULA_OP
    default:
        break;
    }
}

static void run_values(const csg_tape *tape, const csg_tape_formula *formula, float sigma,
                       float *slots, size_t stride, size_t count, float *restrict out)
{
    const csg_tape_step *steps = tape->steps + formula->first;
    for (uint32_t s = 0; s < formula->count; s++)
        step_values(&steps[s], slots + steps[s].a * stride, slots + steps[s].b * stride,
                    slots + steps[s].out * stride, count);
    const float *restrict result = slots + formula->result * stride;
    for (size_t i = 0; i < count; i++)
        out[i] = sigma * kept(result[i]);
}

static void values(const csg_tape *tape, const csg_tape_node *node, const float *x, const float *y,
                   const float *z, size_t count, float *restrict out)
{
    _Alignas(64) float slots[VALUE_FLOATS];
    const csg_tape_formula *formula = csg_tape_formula_of(tape, node);
    const float sigma = tape->parameters[node->parameters + CSG_LEAF_SIGMA];
    size_t stride = chunk_size(VALUE_FLOATS, formula->slots);
    for (size_t first = 0; first < count; first += stride) {
        size_t n = count - first < stride ? count - first : stride;
        const float *const p[3] = {x + first, y + first, z + first};
        place_points(tape, node, formula, p, slots, stride, n);
        run_values(tape, formula, sigma, slots, stride, n, out + first);
    }
}

static void combined(const csg_tape *tape, const csg_tape_node *node, const float *operands,
                     size_t operand_stride, size_t count, float *restrict out)
{
    _Alignas(64) float slots[VALUE_FLOATS];
    const csg_tape_formula *formula = csg_tape_formula_of(tape, node);
    const float sigma = tape->parameters[node->parameters + CSG_LEAF_SIGMA];
    size_t stride = chunk_size(VALUE_FLOATS, formula->slots);
    for (size_t first = 0; first < count; first += stride) {
        size_t n = count - first < stride ? count - first : stride;
        place_operands(tape, node, operands + first, operand_stride, slots, stride, n);
        run_values(tape, formula, sigma, slots, stride, n, out + first);
    }
}

/* ---- gradients --------------------------------------------------------------------------------
 */

static inline float finite_or_zero(float a)
{
    return absolute(a) <= FLT_MAX ? a : 0;
}

#define EACH_SLOPE(expression)                                                                     \
    for (size_t i = 0; i < count; i++) {                                                           \
        slopes s = (expression);                                                                   \
        out[i] = s.v;                                                                              \
        da[i] = finite_or_zero(s.a);                                                               \
        db[i] = finite_or_zero(s.b);                                                               \
    }
#define SLOPES_0(NAME, name)
#define SLOPES_1(NAME, name)                                                                       \
    case CSG_FORMULA_##NAME:                                                                       \
        EACH_SLOPE(slopes_##name(a[i], 0))                                                         \
        break;
#define SLOPES_2(NAME, name)                                                                       \
    case CSG_FORMULA_##NAME:                                                                       \
        if (step->constant == CSG_CONSTANT_NONE)                                                   \
            EACH_SLOPE(slopes_##name(a[i], b[i]))                                                  \
        else if (step->constant == CSG_CONSTANT_B)                                                 \
            EACH_SLOPE(slopes_##name(a[i], c))                                                     \
        else                                                                                       \
            EACH_SLOPE(slopes_##name(c, b[i]))                                                     \
        break;

static void step_slopes(const csg_tape_step *step, const float *restrict a, const float *restrict b,
                        float *restrict out, float *restrict da, float *restrict db, size_t count)
{
    const float c = step->value;
    switch (step->op) {
#define CSG_FORMULA_OP(NAME, name, arity) SLOPES_##arity(NAME, name)
#include "scene/formula/formula.def"
#undef CSG_FORMULA_OP
    default:
        break;
    }
}

/* out = da * a + db * b */
static void mix(const float *restrict da, const float *restrict a, const float *restrict db,
                const float *restrict b, float *restrict out, size_t count)
{
    for (size_t i = 0; i < count; i++)
        out[i] = da[i] * a[i] + db[i] * b[i];
}

static void multiply(const float *restrict by, const float *restrict a, float *restrict out,
                     size_t count)
{
    for (size_t i = 0; i < count; i++)
        out[i] = by[i] * a[i];
}

/* Array `c` of a slot: 0 its value, 1 to 3 its derivatives. */
static float *part(float *slots, size_t stride, uint32_t slot, int c)
{
    return slots + ((size_t)slot * GRADIENT_ARRAYS + (size_t)c) * stride;
}

static void step_gradients(const csg_tape_step *step, float *slots, size_t stride, float *work,
                           size_t count)
{
    float *da = work, *db = work + CSG_BATCH;
    step_slopes(step, part(slots, stride, step->a, 0), part(slots, stride, step->b, 0),
                part(slots, stride, step->out, 0), da, db, count);
    bool one = csg_formula_op_is_unary(step->op);
    for (int c = 1; c < GRADIENT_ARRAYS; c++) {
        const float *a = part(slots, stride, step->a, c), *b = part(slots, stride, step->b, c);
        float *out = part(slots, stride, step->out, c);
        if (one || step->constant == CSG_CONSTANT_B)
            multiply(da, a, out, count);
        else if (step->constant == CSG_CONSTANT_A)
            multiply(db, b, out, count);
        else
            mix(da, a, db, b, out, count);
    }
}

/* Coordinates and their derivatives: none where the domain ends. */
static void place_duals(const csg_tape *tape, const csg_tape_node *node,
                        const csg_tape_formula *formula, const float *const p[3], float *slots,
                        size_t stride, size_t count)
{
    place_points(tape, node, formula, p, slots, GRADIENT_ARRAYS * stride, count);
    for (uint32_t axis = 0; axis < 3; axis++) {
        const float *restrict own = part(slots, stride, axis, 0);
        const float low = formula->low[axis], high = formula->high[axis];
        for (int c = 1; c < GRADIENT_ARRAYS; c++) {
            const float along = c == (int)axis + 1 ? 1.0f : 0.0f;
            float *restrict out = part(slots, stride, axis, c);
            for (size_t i = 0; i < count; i++)
                out[i] = (own[i] > low) & (own[i] < high) ? along : 0.0f;
        }
    }
}

/* From the own frame back to the tape's. */
static void turn_back(const csg_tape_node *node, const float *parameters, float *const own[3],
                      float *const g[3], size_t count)
{
    const float sigma = parameters[CSG_LEAF_SIGMA];
    const float *restrict gx = own[0], *restrict gy = own[1], *restrict gz = own[2];
    for (int axis = 0; axis < 3; axis++) {
        float column[3] = {0, 0, 0};
        for (int r = 0; r < 3; r++)
            column[r] = row_of(node, parameters + CSG_LEAF_FRAME, r).m[axis];
        float *restrict out = g[axis];
        for (size_t i = 0; i < count; i++)
            out[i] =
                sigma * finite_or_zero(column[0] * gx[i] + column[1] * gy[i] + column[2] * gz[i]);
    }
}

static void gradients(const csg_tape *tape, const csg_tape_node *node, const float *x,
                      const float *y, const float *z, size_t count, float *out, float *gx,
                      float *gy, float *gz)
{
    _Alignas(64) float slots[GRADIENT_FLOATS];
    float *work = slots + GRADIENT_FLOATS - 2 * CSG_BATCH;
    const csg_tape_formula *formula = csg_tape_formula_of(tape, node);
    const csg_tape_step *steps = tape->steps + formula->first;
    const float *parameters = tape->parameters + node->parameters;
    size_t stride = chunk_size(32768, (size_t)formula->slots * GRADIENT_ARRAYS);
    for (size_t first = 0; first < count; first += stride) {
        size_t n = count - first < stride ? count - first : stride;
        const float *const p[3] = {x + first, y + first, z + first};
        place_duals(tape, node, formula, p, slots, stride, n);
        for (uint32_t s = 0; s < formula->count; s++)
            step_gradients(&steps[s], slots, stride, work, n);
        const float *restrict result = part(slots, stride, formula->result, 0);
        for (size_t i = 0; i < n; i++)
            out[first + i] = parameters[CSG_LEAF_SIGMA] * kept(result[i]);
        float *const own[3] = {part(slots, stride, formula->result, 1),
                               part(slots, stride, formula->result, 2),
                               part(slots, stride, formula->result, 3)};
        float *const g[3] = {gx + first, gy + first, gz + first};
        turn_back(node, parameters, own, g, n);
    }
}

static void partials(const csg_tape *tape, const csg_tape_node *node, const float *operands,
                     size_t operand_stride, size_t count, uint32_t group, float *out,
                     float *const partial[3])
{
    _Alignas(64) float slots[GRADIENT_FLOATS];
    float *work = slots + GRADIENT_FLOATS - 2 * CSG_BATCH;
    const csg_tape_formula *formula = csg_tape_formula_of(tape, node);
    const csg_tape_step *steps = tape->steps + formula->first;
    const float sigma = tape->parameters[node->parameters + CSG_LEAF_SIGMA];
    const float scale = operand_scale(tape, node);
    size_t stride = chunk_size(32768, (size_t)formula->slots * GRADIENT_ARRAYS);
    for (size_t first = 0; first < count; first += stride) {
        size_t n = count - first < stride ? count - first : stride;
        place_operands(tape, node, operands + first, operand_stride, slots,
                       GRADIENT_ARRAYS * stride, n);
        for (uint32_t k = 0; k < node->arity; k++)
            for (uint32_t c = 1; c < GRADIENT_ARRAYS; c++) {
                float *restrict along = part(slots, stride, k, (int)c);
                for (size_t i = 0; i < n; i++)
                    along[i] = k == 3 * group + c - 1 ? 1.0f : 0.0f;
            }
        for (uint32_t s = 0; s < formula->count; s++)
            step_gradients(&steps[s], slots, stride, work, n);
        const float *restrict result = part(slots, stride, formula->result, 0);
        for (size_t i = 0; i < n; i++)
            out[first + i] = sigma * kept(result[i]);
        for (int c = 0; c < 3; c++) {
            const float *restrict own = part(slots, stride, formula->result, c + 1);
            for (size_t i = 0; i < n; i++)
                partial[c][first + i] = sigma * finite_or_zero(scale * own[i]);
        }
    }
}

/* ---- intervals --------------------------------------------------------------------------------
 */

typedef struct ranges {
    float low[RANGE_LANES], high[RANGE_LANES];
} ranges;

#define EACH_RANGE(function)                                                                       \
    for (int i = 0; i < RANGE_LANES; i++) {                                                        \
        range r = function((range){a->low[i], a->high[i]}, (range){b->low[i], b->high[i]});        \
        out->low[i] = r.low;                                                                       \
        out->high[i] = r.high;                                                                     \
    }
#define RANGES_0(NAME, name)
#define RANGES_1(NAME, name)                                                                       \
    case CSG_FORMULA_##NAME:                                                                       \
        EACH_RANGE(range_##name)                                                                   \
        break;
#define RANGES_2(NAME, name) RANGES_1(NAME, name)

static void step_ranges(const csg_tape_step *step, const ranges *restrict a,
                        const ranges *restrict b, ranges *restrict out)
{
    if (step->op == CSG_FORMULA_MUL && a == b) {
        EACH_RANGE(range_square)
        return;
    }
    switch (step->op) {
#define CSG_FORMULA_OP(NAME, name, arity) RANGES_##arity(NAME, name)
#include "scene/formula/formula.def"
#undef CSG_FORMULA_OP
    default:
        break;
    }
}

/* Own coordinates over cubes with half edge h around the centres, and of the centres alone; all
 * with room for the rounding of the frame's arithmetic. */
static void place_cubes(row r, const float *const c[3], float h, float low, float high, ranges *out)
{
    float half = h * (absolute(r.m[0]) + absolute(r.m[1]) + absolute(r.m[2]));
    for (int i = 0; i < CSG_OCTANTS; i++) {
        float x = r.m[0] * c[0][i], y = r.m[1] * c[1][i], z = r.m[2] * c[2][i];
        float own = x + y + z + r.t;
        float room = 0x1p-20f * (absolute(x) + absolute(y) + absolute(z) + absolute(r.t) + half);
        float reach = half + room;
        out->low[i] = smaller(larger(own - reach, low), high);
        out->high[i] = smaller(larger(own + reach, low), high);
        out->low[CSG_OCTANTS + i] = smaller(larger(own - room, low), high);
        out->high[CSG_OCTANTS + i] = smaller(larger(own + room, low), high);
    }
}

static const ranges *constant_ranges(float value, ranges *out)
{
    for (int i = 0; i < RANGE_LANES; i++)
        out->low[i] = out->high[i] = value;
    return out;
}

/* The cubes' ranges, met with what the values at the centres and the Lipschitz constant say. A
 * centre's range is as wide as rounding makes it; away from the centre it is hardly wider. */
static void meet(const ranges *result, float sigma, float reach, float *restrict low,
                 float *restrict high)
{
    const float far = (float)CSG_FORMULA_FAR, size = absolute(sigma);
    for (int i = 0; i < CSG_OCTANTS; i++) {
        float bottom = result->low[i], top = result->high[i];
        int known = bottom <= top;
        bottom = kept(known ? bottom : -far);
        top = known ? kept(top) : far;
        float a = result->low[CSG_OCTANTS + i], b = result->high[CSG_OCTANTS + i];
        float slack = 4.0f * (b - a);
        float under = (a - slack) - reach / size, over = (b + slack) + reach / size;
        under = larger(bottom, under);
        over = smaller(top, over);
        int use = (under <= over) & (a <= b) & (absolute(a) < far) & (absolute(b) < far);
        bottom = use ? under : bottom;
        top = use ? over : top;
        low[i] = sigma < 0 ? sigma * top : sigma * bottom;
        high[i] = sigma < 0 ? sigma * bottom : sigma * top;
    }
}

static void run_ranges(const csg_tape *tape, const csg_tape_formula *formula, ranges *slots)
{
    ranges constant;
    const csg_tape_step *steps = tape->steps + formula->first;
    for (uint32_t s = 0; s < formula->count; s++) {
        const csg_tape_step *step = &steps[s];
        const ranges *a = &slots[step->a], *b = &slots[step->b];
        if (step->constant == CSG_CONSTANT_A)
            a = constant_ranges(step->value, &constant);
        else if (step->constant == CSG_CONSTANT_B)
            b = constant_ranges(step->value, &constant);
        step_ranges(step, a, b, &slots[step->out]);
    }
}

static void intervals(const csg_tape *tape, const csg_tape_node *node, const float *cx,
                      const float *cy, const float *cz, float radius, float *low, float *high)
{
    ranges slots[CSG_FORMULA_SLOTS];
    const csg_tape_formula *formula = csg_tape_formula_of(tape, node);
    const float *parameters = tape->parameters + node->parameters;
    const float *const c[3] = {cx, cy, cz};
    const float edge = radius * 0.57735034f; /* just above 1 / sqrt(3) */
    for (int axis = 0; axis < 3; axis++)
        place_cubes(row_of(node, parameters + CSG_LEAF_FRAME, axis), c, edge, formula->low[axis],
                    formula->high[axis], &slots[axis]);
    run_ranges(tape, formula, slots);
    float reach = formula->lipschitz * radius * (1.0f + 0x1p-20f);
    meet(&slots[formula->result], parameters[CSG_LEAF_SIGMA], reach + parameters[CSG_LEAF_SLACK],
         low, high);
}

/* What the formula gets for a value: the frame's scale, nothing else, is applied to it. */
static void box_intervals(const csg_tape *tape, const csg_tape_node *node, const float *low,
                          const float *high, size_t stride, float *out_low, float *out_high)
{
    ranges slots[CSG_FORMULA_SLOTS];
    const csg_tape_formula *formula = csg_tape_formula_of(tape, node);
    const float *parameters = tape->parameters + node->parameters;
    const float sigma = parameters[CSG_LEAF_SIGMA], far = (float)CSG_FORMULA_FAR;
    const float scale = operand_scale(tape, node);
    for (uint32_t k = 0; k < node->arity; k++)
        for (size_t i = 0; i < RANGE_LANES; i++) {
            float a = scale * low[k * stride + i % CSG_OCTANTS];
            float b = scale * high[k * stride + i % CSG_OCTANTS];
            slots[k].low[i] = a - 0x1p-20f * absolute(a);
            slots[k].high[i] = b + 0x1p-20f * absolute(b);
        }
    run_ranges(tape, formula, slots);
    const ranges *result = &slots[formula->result];
    for (int i = 0; i < CSG_OCTANTS; i++) {
        int known = result->low[i] <= result->high[i];
        float bottom = known ? kept(result->low[i]) : -far;
        float top = known ? kept(result->high[i]) : far;
        out_low[i] = sigma < 0 ? sigma * top : sigma * bottom;
        out_high[i] = sigma < 0 ? sigma * bottom : sigma * top;
    }
}

const csg_formula_kernel CSG_THIS_FORMULA_KERNEL = {
    .box_intervals = box_intervals,
    .combined = combined,
    .partials = partials,
    .values = values,
    .gradients = gradients,
    .intervals = intervals,
};
