/* SPDX-License-Identifier: MIT
 * combine(): its function is evaluated once, on terms that stand for the fields of its children.
 */
#include "base/scene_codes.h"
#include "lang/modules/formula_call.h"
#include "lang/modules/shapes.h"
#include "scene/operators/combine.h"

enum { FUNCTION, BOUNDS, LIPSCHITZ };

/* Each statement's solid is an operand. How many; 0 after a report. */
static uint32_t take_operands(csg_module_call *call, csg_node_id operands[CSG_COMBINE_MOST])
{
    csg_eval *e = call->e;
    csg_span where = call->statement->where;
    size_t first = e->part_count;
    csg_run_scope(e, call->statement->children, call->frame, false);
    csg_parts_drop_regions(e, first, "combine()");
    size_t count = e->stop ? 0 : e->part_count - first;
    bool fits = count >= 1 && count <= CSG_COMBINE_MOST;
    for (size_t i = 0; fits && i < count; i++) {
        csg_eval_part part = e->parts[first + i];
        operands[i] = part.node;
        if (part.wrapped)
            csg_eval_report(e, CSG_DIAG_UNUSED_BLEND, part.where, NULL,
                            "combine() joins by its function, this blend() is not used");
        if (csg_eval_is_empty(e, part.node)) {
            csg_eval_report(e, CSG_DIAG_BAD_SOLID, where, NULL,
                            "combine(): child %zu is empty, it has no field", i + 1);
            fits = false;
        }
    }
    if (!e->stop && (count < 1 || count > CSG_COMBINE_MOST))
        csg_eval_report(e, CSG_DIAG_BAD_SOLID, where,
                        count ? "unite some of them in a group() { }" : NULL,
                        "combine() takes one to %d children, not %zu", CSG_COMBINE_MOST, count);
    e->part_count = first;
    return fits ? (uint32_t)count : 0;
}

static csg_node_id combined(csg_module_call *call, const csg_node_id *operands, uint32_t count)
{
    csg_eval *e = call->e;
    csg_span where = call->statement->where;
    csg_box box = csg_argument_box(call, BOUNDS);
    double slope = csg_argument_number(call, LIPSCHITZ, 0, CSG_POSITIVE);
    uint32_t step_count = 0;
    size_t bytes = 0;
    if (call->failed)
        return csg_shape_empty(call);
    csg_formula_step *steps = csg_formula_of_function(call, FUNCTION, count, &step_count, &bytes);
    if (!steps || call->failed)
        return csg_shape_empty(call);
    csg_node_id node = csg_shape_done(
        call, csg_build_combine(&e->builder, steps, step_count, slope, operands, count, where));
    csg_memory_release(e->heap.memory, steps, bytes);
    if (node == CSG_NODE_NONE || csg_eval_is_empty(e, node) || !csg_has_argument(call, BOUNDS))
        return node;
    return csg_shape_done(call, csg_build_cut(&e->builder, node, box, where));
}

/* As many parameters as operands, or one that is a list of them, and others only with values of
 * their own. */
static bool takes(const csg_module_call *call, uint32_t count)
{
    if (!csg_argument_is_function(call, FUNCTION, 1))
        return false;
    const csg_arguments *parameters =
        &call->values[FUNCTION].as.function->literal->as.call.arguments;
    uint32_t needed = 0;
    for (uint32_t i = 0; i < parameters->count; i++)
        needed += !parameters->items[i].value;
    if (needed == 1 && !parameters->items[0].value)
        return true;
    for (uint32_t i = count; i < parameters->count; i++)
        if (!parameters->items[i].value)
            return false;
    return parameters->count >= count;
}

csg_node_id csg_module_combine(csg_module_call *call)
{
    static const char *const examples[] = {"1 number, as function (a) a + 1",
                                           "2 numbers, as function (a, b) max(a, b)",
                                           "3 numbers, as function (a, b, c) max(a, b, c)"};
    csg_node_id operands[CSG_COMBINE_MOST];
    uint32_t count = take_operands(call, operands);
    if (count && !takes(call, count)) {
        if (count <= 3)
            csg_argument_error(call, FUNCTION, CSG_DIAG_BAD_TYPE, "it needs a function of %s",
                               examples[count - 1]);
        else
            csg_argument_error(
                call, FUNCTION, CSG_DIAG_BAD_TYPE,
                "it needs a function of %u numbers, or of a list of them, as function "
                "(f) max(f)",
                count);
    }
    return count && !call->failed ? combined(call, operands, count) : csg_shape_empty(call);
}
