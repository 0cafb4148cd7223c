/* SPDX-License-Identifier: MIT
 * Any bytes -> a .vm tape -> a formula -> its bound on a box and its values there. Refusals name a
 * line or the whole; the formula is in order; its slope between two points is within the bound.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fuzz/fuzz.h"
#include "scene/formula/formula.h"
#include "scene/formula/vm.h"

static void check_bound(csg_memory *memory, const csg_formula_step *steps, uint32_t count)
{
    const csg_box box = {{-1, -2, -1}, {2, 1, 1}};
    const csg_vec3 a = {0.3, -0.7, 0.4}, b = {0.30001, -0.70002, 0.4};
    csg_formula formula = {.count = count, .bounds = box};
    csg_formula_dual *work = malloc(count * sizeof *work);
    if (!work)
        abort();
    double slope = csg_formula_lipschitz(memory, steps, count, box);
    double at_a = csg_formula_evaluate(steps, &formula, a, work).value;
    double at_b = csg_formula_evaluate(steps, &formula, b, work).value;
    double change = fabs(at_a - at_b), distance = csg_vec3_norm(csg_vec3_sub(a, b));
    double rounding = 1e-9 * (1 + fabs(at_a) + fabs(at_b));
    if (slope < 1e6 && fabs(at_a) < 1e6 && fabs(at_b) < 1e6 &&
        change > slope * distance * 1.001 + rounding)
        fuzz_fail("steeper than its bound", "", 0);
    free(work);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    csgm_context context;
    csg_terms terms;
    csg_term result;
    csg_vm_problem problem;
    fuzz_context_init(&context);
    csg_formula_begin(&terms, &context.memory);
    terms.most = 2000;
    csgm_status status = csg_vm_read(&terms, (const char *)data, size, &result, &problem);
    if (status == CSGM_ERR_FORMAT && !problem.text[0])
        fuzz_fail("refused without a word", "", 0);
    csg_formula_step *steps = malloc((terms.count + 1) * sizeof *steps);
    if (!steps)
        abort();
    uint32_t count = status == CSGM_OK ? csg_formula_collect(&terms, result, steps) : 0;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t arity = csg_formula_op_arity(steps[i].op);
        if ((arity > 0 && steps[i].a >= i) || (arity > 1 && steps[i].b >= i))
            fuzz_fail("an operand below its user", "", 0);
    }
    if (count)
        check_bound(&context.memory, steps, count);
    free(steps);
    csg_formula_end(&terms);
    fuzz_context_close(&context);
    return 0;
}
