/* SPDX-License-Identifier: MIT
 * Formula -> tape: angles become radians (their factors fold into the formula's own), constants
 * become part of the step that uses them, and steps share slots: a slot is free once its last
 * reader is done.
 */
#include "field/compile/compile_formula.h"

#include <string.h>

#include "scene/formula/formula.h"

static const double degree = 0.017453292519943295;

static csg_formula_id scaled(csg_formula_builder *builder, csg_formula_id u, double factor)
{
    csg_formula_id by = csg_formula_constant(builder, factor);
    return u == CSG_FORMULA_NONE || by == CSG_FORMULA_NONE
               ? CSG_FORMULA_NONE
               : csg_formula_apply(builder, CSG_FORMULA_MUL, u, by);
}

/* One step with its angles in radians. */
static csg_formula_id in_radians(csg_formula_builder *builder, const csg_formula_step *step,
                                 csg_formula_id a, csg_formula_id b)
{
    switch (step->op) {
    case CSG_FORMULA_CONSTANT:
        return csg_formula_constant(builder, step->constant);
    case CSG_FORMULA_SIN:
    case CSG_FORMULA_COS:
    case CSG_FORMULA_TAN:
        a = scaled(builder, a, degree);
        return a == CSG_FORMULA_NONE ? a : csg_formula_apply(builder, step->op, a, 0);
    case CSG_FORMULA_ASIN:
    case CSG_FORMULA_ACOS:
    case CSG_FORMULA_ATAN:
    case CSG_FORMULA_ATAN2:
        return scaled(builder, csg_formula_apply(builder, step->op, a, b), 1 / degree);
    default:
        return csg_formula_apply(builder, step->op, a, b);
    }
}

static csg_formula_id convert(csg_formula_builder *builder, const csg_formula_step *steps,
                              uint32_t count, csg_formula_id *ids)
{
    builder->most = 4 * (size_t)CSG_LONGEST_FORMULA;
    for (uint32_t i = 0; i < count; i++) {
        const csg_formula_step *step = &steps[i];
        if (step->op != CSG_FORMULA_CONSTANT && step->op <= CSG_FORMULA_Z)
            ids[i] = csg_formula_variable(builder, csg_formula_variable_of(step));
        else
            ids[i] = in_radians(builder, step, i ? ids[step->a] : 0, i ? ids[step->b] : 0);
        if (ids[i] == CSG_FORMULA_NONE)
            return CSG_FORMULA_NONE;
    }
    return ids[count - 1];
}

/* ---- slots ------------------------------------------------------------------------------------
 */

enum { AXES = 3 };

typedef struct slots {
    uint32_t *readers; /* per step: how many are still to come */
    uint16_t *of;      /* per step */
    uint16_t *vacant;
    uint32_t vacant_count, used;
} slots;

static void drop_reader(slots *s, const csg_formula_step *steps, uint32_t step)
{
    if (--s->readers[step] == 0 && steps[step].op > CSG_FORMULA_Z)
        s->vacant[s->vacant_count++] = s->of[step];
}

static csg_tape_step write_step(slots *s, const csg_formula_step *steps, uint32_t index)
{
    const csg_formula_step *step = &steps[index];
    bool binary = csg_formula_op_arity(step->op) > 1;
    csg_tape_step out = {.op = step->op, .a = s->of[step->a]};
    out.b = binary ? s->of[step->b] : out.a;
    if (steps[step->a].op == CSG_FORMULA_CONSTANT) {
        out.constant = CSG_CONSTANT_A;
        out.value = (float)steps[step->a].constant;
        out.a = out.b;
    } else if (binary && steps[step->b].op == CSG_FORMULA_CONSTANT) {
        out.constant = CSG_CONSTANT_B;
        out.value = (float)steps[step->b].constant;
        out.b = out.a;
    }
    out.out = s->vacant_count ? s->vacant[--s->vacant_count] : (uint16_t)s->used++;
    s->of[index] = out.out;
    drop_reader(s, steps, step->a);
    if (binary)
        drop_reader(s, steps, step->b);
    return out;
}

static void count_readers(slots *s, const csg_formula_step *steps, uint32_t count)
{
    memset(s->readers, 0, count * sizeof *s->readers);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t arity = csg_formula_op_arity(steps[i].op);
        if (arity > 0)
            s->readers[steps[i].a]++;
        if (arity > 1)
            s->readers[steps[i].b]++;
    }
}

/* Writes at most count steps; returns how many. */
static size_t share_slots(slots *s, const csg_formula_step *steps, uint32_t count,
                          csg_tape_step *out)
{
    size_t written = 0;
    count_readers(s, steps, count);
    s->used = csg_formula_variables(steps, count);
    for (uint32_t i = 0; i < count; i++) {
        if (steps[i].op > CSG_FORMULA_Z)
            out[written++] = write_step(s, steps, i);
        else if (steps[i].op != CSG_FORMULA_CONSTANT)
            s->of[i] = (uint16_t)csg_formula_variable_of(&steps[i]);
    }
    return written;
}

/* A formula without a variable: 0 x + c. */
static size_t write_constant(csg_tape_step *out, double value)
{
    out[0] = (csg_tape_step){
        .op = CSG_FORMULA_MUL, .constant = CSG_CONSTANT_B, .out = AXES, .a = 0, .b = 0};
    out[1] = (csg_tape_step){.op = CSG_FORMULA_ADD,
                             .constant = CSG_CONSTANT_B,
                             .out = AXES + 1,
                             .a = AXES,
                             .b = AXES,
                             .value = (float)value};
    return 2;
}

static bool write_steps(csg_memory *memory, const csg_formula_step *steps, uint32_t count,
                        csg_tape_step *out, csg_tape_formula *compiled)
{
    if (count == 1 && steps[0].op == CSG_FORMULA_CONSTANT) {
        compiled->count = (uint32_t)write_constant(out, steps[0].constant);
        compiled->slots = AXES + 2;
        compiled->result = AXES + 1;
        return true;
    }
    size_t bytes = count * (sizeof(uint32_t) + 2 * sizeof(uint16_t));
    uint32_t *work = csg_memory_alloc(memory, bytes);
    if (!work)
        return false;
    slots s = {.readers = work, .of = (uint16_t *)(work + count)};
    memset(s.of, 0, count * sizeof *s.of);
    s.vacant = s.of + count;
    compiled->count = (uint32_t)share_slots(&s, steps, count, out);
    compiled->slots = s.used;
    compiled->result = s.of[count - 1];
    csg_memory_release(memory, work, bytes);
    return true;
}

static void set_domain(const csg_formula *formula, csg_tape_formula *compiled)
{
    const double low[3] = {formula->bounds.min.x, formula->bounds.min.y, formula->bounds.min.z};
    const double high[3] = {formula->bounds.max.x, formula->bounds.max.y, formula->bounds.max.z};
    for (int axis = 0; axis < 3; axis++) {
        compiled->low[axis] = (float)low[axis];
        compiled->high[axis] = (float)high[axis];
    }
    compiled->lipschitz = (float)(formula->lipschitz * (1 + 1e-7));
}

bool csg_formula_compile(csg_memory *memory, const csg_formula_step *steps,
                         const csg_formula *formula, csg_tape_step **out, size_t *count,
                         size_t *capacity, csg_tape_formula *compiled)
{
    csg_formula_builder builder;
    csg_formula_begin(&builder, memory);
    size_t id_bytes = formula->count * sizeof(csg_formula_id);
    csg_formula_id *ids = csg_memory_alloc(memory, id_bytes);
    csg_formula_id result = CSG_FORMULA_NONE;
    if (ids)
        result = convert(&builder, steps + formula->first, formula->count, ids);
    csg_memory_release(memory, ids, id_bytes);
    size_t ordered_bytes = (builder.count + 1) * sizeof(csg_formula_step);
    csg_formula_step *ordered = NULL;
    if (result != CSG_FORMULA_NONE)
        ordered = csg_memory_alloc(memory, ordered_bytes);
    uint32_t ordered_count = ordered ? csg_formula_collect(&builder, result, ordered) : 0;
    void *grown = *out;
    bool done = ordered_count > 0 && csg_memory_reserve(memory, &grown, capacity,
                                                        *count + ordered_count + 1, sizeof **out);
    *out = grown;
    if (done) {
        compiled->first = (uint32_t)*count;
        set_domain(formula, compiled);
        done = write_steps(memory, ordered, ordered_count, *out + *count, compiled);
        *count += done ? compiled->count : 0;
    }
    csg_memory_release(memory, ordered, ordered_bytes);
    csg_formula_end(&builder);
    return done;
}
