/* SPDX-License-Identifier: MIT
 * Values forwards, then what is wanted of them backwards, as hull consistency has it (Benhamou,
 * Goualard, Granvilliers & Puget 1999, "Revising hull and box consistency", algorithm HC4-revise).
 * Backwards go the operations that stand behind the kinks of walls, 0.3 - |u|, and of sharp
 * combinations, min(u, v): of |u| in [0.2, 0.4] and u in [-0.1, 0.8] only u in [0.2, 0.4] is left,
 * and the kink is not there.
 */
#include "field/gradients/narrow_formula.h"

#include "field/gradients/formula_slopes.h"

/* Which steps made a step's operands, from 1 on; 0: a coordinate or a constant. */
typedef struct makers {
    uint16_t a, b;
} makers;

/* What is left of *have; false: nothing. Where one of both is not known it stays. */
static bool meet(range *have, range other)
{
    if (!is_known(*have) || !is_known(other))
        return true;
    have->low = larger(have->low, other.low);
    have->high = smaller(have->high, other.high);
    return have->low <= have->high;
}

/* |u| is within v. */
static bool meet_size(range *u, range v)
{
    if (!is_known(v))
        return true;
    bool below = v.low > 0 && u->low > -v.low, above = v.low > 0 && u->high < v.low;
    if (below && above)
        return false;
    return meet(u, (range){below ? v.low : -v.high, above ? -v.low : v.high});
}

/* The operand is v or, where the other one may be it, is not beyond v. */
static bool meet_extreme(uint8_t op, range *u, range v, range other)
{
    bool is_least = op == CSG_FORMULA_MIN;
    bool is_it = is_least ? other.low > v.high : other.high < v.low;
    range out = v;
    if (!is_it && is_least)
        out.high = INFINITY;
    else if (!is_it)
        out.low = -INFINITY;
    return meet(u, out);
}

/* From a step's value to those of its operands that other steps made; NULL: none did. */
static bool narrow_operands(const csg_tape_step *step, range value, range a, range b, range *to_a,
                            range *to_b)
{
    const range v = rounded(value.low, value.high, is_known(value));
    switch (step->op) {
    case CSG_FORMULA_NEG:
        return !to_a || meet(to_a, range_neg(v, v));
    case CSG_FORMULA_ABS:
        return !to_a || meet_size(to_a, v);
    case CSG_FORMULA_ADD:
        return (!to_a || meet(to_a, range_sub(v, b))) && (!to_b || meet(to_b, range_sub(v, a)));
    case CSG_FORMULA_SUB:
        return (!to_a || meet(to_a, range_add(v, b))) && (!to_b || meet(to_b, range_sub(a, v)));
    case CSG_FORMULA_MUL: /* by constants: what is near to zero says nothing of the other one */
        return (!to_a || step->constant != CSG_CONSTANT_B || meet(to_a, range_div(v, b))) &&
               (!to_b || step->constant != CSG_CONSTANT_A || meet(to_b, range_div(v, a)));
    case CSG_FORMULA_MIN:
    case CSG_FORMULA_MAX:
        return (!to_a || meet_extreme(step->op, to_a, v, b)) &&
               (!to_b || meet_extreme(step->op, to_b, v, a));
    default:
        return true;
    }
}

/* Values of all steps, and which steps made their operands. Comes to the step that makes the
 * result, from 1 on. */
static uint16_t find_values(const csg_tape *tape, const csg_tape_formula *formula,
                            const csg_cone_box *at, range *values, makers *from)
{
    range slots[CSG_FORMULA_SLOTS];
    uint16_t maker[CSG_FORMULA_SLOTS] = {0};
    for (int i = 0; i < 3; i++)
        slots[i] = (range){at->low[i], at->high[i]};
    for (uint32_t s = 0; s < formula->count; s++) {
        const csg_tape_step *step = &tape->steps[formula->first + s];
        const range constant = {step->value, step->value};
        bool is_a = step->constant == CSG_CONSTANT_A, is_b = step->constant == CSG_CONSTANT_B;
        range a = is_a ? constant : slots[step->a], b = is_b ? constant : slots[step->b];
        bool is_square = step->op == CSG_FORMULA_MUL && step->a == step->b && !step->constant;
        values[s] = is_square ? range_square(a, a) : value_of(step->op, a, b);
        from[s] = (makers){is_a ? 0 : maker[step->a], is_b ? 0 : maker[step->b]};
        slots[step->out] = values[s];
        maker[step->out] = (uint16_t)(s + 1);
    }
    return maker[formula->result];
}

/* An operand that no step made: a constant or a coordinate. */
static range given(const csg_tape_step *step, int which, uint16_t slot, const csg_cone_box *at)
{
    if (step->constant == which || slot >= 3)
        return (range){step->value, step->value};
    return (range){at->low[slot], at->high[slot]};
}

bool csg_narrow_formula(const csg_tape *tape, const csg_tape_formula *formula,
                        const csg_cone_box *at, range wanted, range values[CSG_NARROW_MOST])
{
    makers from[CSG_NARROW_MOST];
    uint16_t result = find_values(tape, formula, at, values, from);
    if (result && !meet(&values[result - 1], wanted))
        return false;
    for (uint32_t s = result; s-- > 0;) {
        const csg_tape_step *step = &tape->steps[formula->first + s];
        range *a = from[s].a ? &values[from[s].a - 1] : NULL;
        range *b = from[s].b ? &values[from[s].b - 1] : NULL;
        range of_a = a ? *a : given(step, CSG_CONSTANT_A, step->a, at);
        range of_b = b ? *b : given(step, CSG_CONSTANT_B, step->b, at);
        if (!narrow_operands(step, values[s], of_a, of_b, a, b))
            return false;
    }
    return true;
}
