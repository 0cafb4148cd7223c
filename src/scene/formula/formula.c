/* SPDX-License-Identifier: MIT
 * Building formulas: constants fold, equal steps become one, chains of constant factors and
 * summands join; and the walk that puts a finished one in order.
 */
#include "scene/formula/formula.h"

#include <assert.h>
#include <string.h>

#include "base/elementary.h"

static const struct {
    const char *name;
    uint32_t arity;
} ops[CSG_FORMULA_OP_COUNT] = {
#define CSG_FORMULA_OP(NAME, name, arity) {#name, arity},
#include "scene/formula/formula.def"
#undef CSG_FORMULA_OP
};

const char *csg_formula_op_name(csg_formula_op op)
{
    assert(op < CSG_FORMULA_OP_COUNT);
    return ops[op].name;
}

uint32_t csg_formula_op_arity(csg_formula_op op)
{
    assert(op < CSG_FORMULA_OP_COUNT);
    return ops[op].arity;
}

void csg_formula_begin(csg_formula_builder *builder, csg_memory *memory)
{
    *builder = (csg_formula_builder){
        .memory = memory, .table = {.memory = memory}, .most = CSG_LONGEST_FORMULA};
}

void csg_formula_end(csg_formula_builder *builder)
{
    csg_memory_release(builder->memory, builder->steps, builder->capacity * sizeof *builder->steps);
    csg_table_release(&builder->table);
    *builder = (csg_formula_builder){.memory = builder->memory, .table = builder->table};
}

/* ---- equal steps are one -------------------------------------------------------------------- */

static uint64_t hash_step(const void *steps, uint32_t number)
{
    const csg_formula_step *step = (const csg_formula_step *)steps + number;
    uint64_t bits;
    memcpy(&bits, &step->constant, sizeof bits);
    return csg_hash_word(csg_hash_word(csg_hash_word(step->op, step->a), step->b), bits);
}

static bool same_step(const csg_formula_step *a, const csg_formula_step *b)
{
    return a->op == b->op && a->a == b->a && a->b == b->b &&
           !memcmp(&a->constant, &b->constant, sizeof a->constant);
}

/* The number of this step, or CSG_TABLE_NONE and the slot to put one at. */
static uint32_t find_step(const csg_formula_builder *builder, const csg_formula_step *step,
                          size_t *slot)
{
    uint32_t known = csg_table_first(&builder->table, hash_step(step, 0), slot);
    while (known != CSG_TABLE_NONE && !same_step(&builder->steps[known], step))
        known = csg_table_next(&builder->table, slot);
    return known;
}

static csg_formula_id append(csg_formula_builder *builder, csg_formula_step step)
{
    if (!csg_table_reserve(&builder->table, builder->count + 1, hash_step, builder->steps))
        return CSG_FORMULA_NONE;
    size_t slot;
    uint32_t known = find_step(builder, &step, &slot);
    if (known != CSG_TABLE_NONE)
        return known;
    if (builder->count >= builder->most) {
        builder->too_long = true;
        return CSG_FORMULA_NONE;
    }
    void *steps = builder->steps;
    if (!csg_memory_reserve(builder->memory, &steps, &builder->capacity, builder->count + 1,
                            sizeof step))
        return CSG_FORMULA_NONE;
    builder->steps = steps;
    builder->steps[builder->count] = step;
    csg_table_put(&builder->table, slot, (uint32_t)builder->count);
    return (uint32_t)builder->count++;
}

csg_formula_id csg_formula_constant(csg_formula_builder *builder, double value)
{
    return append(builder, (csg_formula_step){.op = CSG_FORMULA_CONSTANT, .constant = value});
}

csg_formula_id csg_formula_variable(csg_formula_builder *builder, uint32_t number)
{
    return append(builder,
                  (csg_formula_step){.op = (uint8_t)(CSG_FORMULA_X + number % 3), .a = number / 3});
}

uint32_t csg_formula_variables(const csg_formula_step *steps, uint32_t count)
{
    uint32_t most = 3;
    for (uint32_t i = 0; i < count; i++)
        if (steps[i].op != CSG_FORMULA_CONSTANT && steps[i].op <= CSG_FORMULA_Z &&
            csg_formula_variable_of(&steps[i]) >= most)
            most = csg_formula_variable_of(&steps[i]) + 1;
    return most;
}

/* ---- simplification -------------------------------------------------------------------------- */

static bool is_constant(const csg_formula_builder *builder, csg_formula_id id)
{
    return builder->steps[id].op == CSG_FORMULA_CONSTANT;
}

/* u op c: joins c with the constant that u ends in. The sum of two sums, the product of two
 * products; what it changes is the last bit. */
static csg_formula_id apply_constant(csg_formula_builder *builder, csg_formula_op op,
                                     csg_formula_id u, double c)
{
    const csg_formula_step inner = builder->steps[u];
    bool chain = inner.op == op && is_constant(builder, inner.b);
    double last = chain ? builder->steps[inner.b].constant : 0;
    if (chain) {
        u = inner.a;
        c = op == CSG_FORMULA_ADD ? last + c : last * c;
    }
    if (op == CSG_FORMULA_ADD ? c == 0 : c == 1)
        return u;
    if (op == CSG_FORMULA_MUL && c == 0)
        return csg_formula_constant(builder, 0);
    csg_formula_id constant = csg_formula_constant(builder, c);
    if (constant == CSG_FORMULA_NONE)
        return constant;
    return append(builder, (csg_formula_step){.op = (uint8_t)op, .a = u, .b = constant});
}

/* u^n, n > 0 and whole, by squaring. */
static csg_formula_id whole_power(csg_formula_builder *builder, csg_formula_id u, unsigned n)
{
    csg_formula_id power = CSG_FORMULA_NONE;
    while (u != CSG_FORMULA_NONE) {
        bool first = power == CSG_FORMULA_NONE;
        if (n & 1)
            power = first ? u : csg_formula_apply(builder, CSG_FORMULA_MUL, power, u);
        n >>= 1;
        if (n == 0 || (!first && power == CSG_FORMULA_NONE))
            return power;
        u = csg_formula_apply(builder, CSG_FORMULA_MUL, u, u);
    }
    return CSG_FORMULA_NONE;
}

static csg_formula_id constant_power(csg_formula_builder *builder, csg_formula_id u,
                                     csg_formula_id exponent)
{
    enum { LARGEST_WHOLE = 64 };
    double n = builder->steps[exponent].constant;
    if (n == 0.5)
        return csg_formula_apply(builder, CSG_FORMULA_SQRT, u, 0);
    if (n == 0)
        return csg_formula_constant(builder, 1);
    if (n != floor(n) || fabs(n) > LARGEST_WHOLE)
        return append(builder, (csg_formula_step){CSG_FORMULA_POW, u, exponent, 0});
    csg_formula_id power = whole_power(builder, u, (unsigned)fabs(n));
    if (n > 0 || power == CSG_FORMULA_NONE)
        return power;
    csg_formula_id one = csg_formula_constant(builder, 1);
    if (one == CSG_FORMULA_NONE)
        return one;
    return csg_formula_apply(builder, CSG_FORMULA_DIV, one, power);
}

/* Neither operand is NONE, and not both are constants. */
static csg_formula_id apply_binary(csg_formula_builder *builder, csg_formula_op op,
                                   csg_formula_id a, csg_formula_id b)
{
    bool left = is_constant(builder, a), right = is_constant(builder, b);
    double constant = builder->steps[left ? a : b].constant; /* where one is */
    csg_formula_id other = left ? b : a;
    if (op == CSG_FORMULA_SUB && a == b)
        return csg_formula_constant(builder, 0);
    if ((op == CSG_FORMULA_ADD || op == CSG_FORMULA_MUL) && (left || right))
        return apply_constant(builder, op, other, constant);
    if (op == CSG_FORMULA_SUB && right)
        return apply_constant(builder, CSG_FORMULA_ADD, a, -constant);
    if (op == CSG_FORMULA_DIV && right && constant != 0)
        return apply_constant(builder, CSG_FORMULA_MUL, a, 1 / constant);
    if (op == CSG_FORMULA_SUB && left && constant == 0)
        return csg_formula_apply(builder, CSG_FORMULA_NEG, b, 0);
    if (op == CSG_FORMULA_POW && right)
        return constant_power(builder, a, b);
    if (op == CSG_FORMULA_POW && left) { /* c^u, c > 0 */
        if (!(constant > 0))
            return append(builder, (csg_formula_step){(uint8_t)op, a, b, 0});
        csg_formula_id scaled = apply_constant(builder, CSG_FORMULA_MUL, b, csg_log(constant));
        return scaled == CSG_FORMULA_NONE ? scaled
                                          : csg_formula_apply(builder, CSG_FORMULA_EXP, scaled, 0);
    }
    csg_formula_step step = {(uint8_t)op, a, b, 0}, mirrored = {(uint8_t)op, b, a, 0};
    bool commutes = op == CSG_FORMULA_ADD || op == CSG_FORMULA_MUL || op == CSG_FORMULA_MIN ||
                    op == CSG_FORMULA_MAX;
    if (commutes && left)
        return append(builder, mirrored);
    size_t slot;
    uint32_t known = commutes ? find_step(builder, &mirrored, &slot) : CSG_TABLE_NONE;
    return known != CSG_TABLE_NONE ? known : append(builder, step);
}

csg_formula_id csg_formula_apply(csg_formula_builder *builder, csg_formula_op op, csg_formula_id a,
                                 csg_formula_id b)
{
    uint32_t arity = csg_formula_op_arity(op);
    if (arity == 0)
        return append(builder, (csg_formula_step){.op = (uint8_t)op});
    if (is_constant(builder, a) && (arity == 1 || is_constant(builder, b)))
        return csg_formula_constant(builder,
                                    csg_formula_value(op, builder->steps[a].constant,
                                                      arity == 1 ? 0 : builder->steps[b].constant));
    if (arity == 2)
        return apply_binary(builder, op, a, b);
    const csg_formula_step inner = builder->steps[a];
    if (op == CSG_FORMULA_NEG && inner.op == CSG_FORMULA_NEG)
        return inner.a;
    if (op == CSG_FORMULA_ABS && inner.op == CSG_FORMULA_NEG)
        a = inner.a;
    return append(builder, (csg_formula_step){.op = (uint8_t)op, .a = a});
}

/* ---- the finished formula ----------------------------------------------------------------------
 */

/* A walk from the result with an explicit stack, operands first. order[i]: new place + 1; the
 * stack is in `waiting`. */
static uint32_t collect(const csg_formula_builder *builder, csg_formula_id result,
                        csg_formula_step *out, uint32_t *order, uint32_t *waiting)
{
    uint32_t count = 0;
    size_t top = 0;
    waiting[top++] = result;
    while (top) {
        uint32_t id = waiting[top - 1];
        csg_formula_step step = builder->steps[id];
        uint32_t arity = csg_formula_op_arity(step.op);
        if (order[id]) {
            top--;
        } else if (arity > 0 && !order[step.a]) {
            waiting[top++] = step.a;
        } else if (arity > 1 && !order[step.b]) {
            waiting[top++] = step.b;
        } else {
            if (arity > 0)
                step.a = order[step.a] - 1;
            step.b = arity > 1 ? order[step.b] - 1 : 0;
            out[count] = step;
            order[id] = ++count;
            top--;
        }
    }
    return count;
}

uint32_t csg_formula_collect(const csg_formula_builder *builder, csg_formula_id result,
                             csg_formula_step *out)
{
    size_t bytes = 2 * builder->count * sizeof(uint32_t); /* a path is no longer than all steps */
    uint32_t *order = csg_memory_alloc(builder->memory, bytes);
    if (!order)
        return 0;
    memset(order, 0, bytes);
    uint32_t count = collect(builder, result, out, order, order + builder->count);
    csg_memory_release(builder->memory, order, bytes);
    return count;
}

bool csg_formula_width(csg_memory *memory, const csg_formula_step *steps, uint32_t count,
                       uint32_t *out)
{
    uint32_t *readers = csg_memory_alloc(memory, count * sizeof *readers);
    if (!readers)
        return false;
    memset(readers, 0, count * sizeof *readers);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t arity = csg_formula_op_arity(steps[i].op);
        if (arity > 0)
            readers[steps[i].a]++;
        if (arity > 1)
            readers[steps[i].b]++;
    }
    uint32_t live = csg_formula_variables(steps, count), most = live;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t arity = csg_formula_op_arity(steps[i].op);
        if (!arity)
            continue;
        most = ++live > most ? live : most;
        live -= --readers[steps[i].a] == 0 && steps[steps[i].a].op > CSG_FORMULA_Z;
        if (arity > 1)
            live -= --readers[steps[i].b] == 0 && steps[steps[i].b].op > CSG_FORMULA_Z;
    }
    *out = most;
    csg_memory_release(memory, readers, count * sizeof *readers);
    return true;
}
