/* SPDX-License-Identifier: MIT
 * Formulas that end before the step that has a kink; see kinks.h.
 */
#include "field/gradients/kinks.h"

#include <string.h>

#include "scene/formula/formula.h"

/* The leaf's place, by itself: parameters of any frame. */
enum { PARAMETERS = CSG_LEAF_OWN_AFFINE + 1 };

typedef struct cut_formula {
    csg_tape tape;
    csg_tape_node node;
    csg_tape_formula formula;
    float parameters[PARAMETERS];
} cut_formula;

/* The values of one slot, as they are before the step. */
static void cut_before(cut_formula *cut, const csg_tape *leaf, uint32_t step, uint32_t slot)
{
    bool is_offset = leaf->nodes->frame == CSG_FRAME_OFFSET;
    size_t own = is_offset ? CSG_LEAF_OWN_OFFSET : CSG_LEAF_OWN_AFFINE;
    cut->tape = *leaf;
    cut->node = *leaf->nodes;
    cut->formula = *csg_tape_formula_of(leaf, leaf->nodes);
    cut->formula.count = step;
    cut->formula.result = slot;
    memcpy(cut->parameters, leaf->parameters + leaf->nodes->parameters, own * sizeof(float));
    cut->parameters[own] = 0;
    cut->parameters[CSG_LEAF_SIGMA] = 1;
    cut->parameters[CSG_LEAF_RAISE] = 0;
    cut->node.parameters = 0;
    cut->tape.nodes = &cut->node;
    cut->tape.parameters = cut->parameters;
    cut->tape.formulas = &cut->formula;
    cut->tape.exact = NULL;
}

void csg_kink_values(const csg_kernel *kernel, const csg_tape *leaf, const csg_kink *kink,
                     const float *x, const float *y, const float *z, size_t count, float *out,
                     float *room, float *scratch, size_t scratch_floats)
{
    const csg_tape_step *step =
        &leaf->steps[csg_tape_formula_of(leaf, leaf->nodes)->first + kink->step];
    cut_formula cut;
    bool has_two = step->op != CSG_FORMULA_ABS;
    const uint32_t slots[2] = {step->a, step->b};
    const uint8_t constant[2] = {CSG_CONSTANT_A, CSG_CONSTANT_B};
    for (size_t i = 0; i < count; i++)
        out[i] = 0;
    for (int k = 0; k < 1 + has_two; k++) {
        bool is_constant = has_two && step->constant == constant[k];
        if (!is_constant) {
            cut_before(&cut, leaf, kink->step, slots[k]);
            kernel->values(&cut.tape, x, y, z, count, room, scratch, scratch_floats);
        }
        for (size_t i = 0; i < count; i++)
            out[i] += (k ? -1.0f : 1.0f) * (is_constant ? step->value : room[i]);
    }
}
