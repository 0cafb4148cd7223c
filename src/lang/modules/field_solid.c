/* SPDX-License-Identifier: MIT
 * field(): its function is evaluated once, on a point of terms, and what it gives is the formula.
 * combine() does so with the fields of its children (combine_solid.c).
 */
#include <math.h>

#include "base/scene_codes.h"
#include "lang/evaluate/symbolic.h"
#include "lang/modules/formula_call.h"
#include "scene/formula/formula.h"

/* A list of the first variables: a point's three coordinates, or the fields of operands. */
static csg_value list_of_terms(csg_eval *e, uint32_t count)
{
    csg_vector *point = csg_vector_create(&e->heap, count);
    bool made = point != NULL;
    for (uint32_t axis = 0; axis < count && made; axis++) {
        csg_formula_id id = csg_formula_variable(e->formula, axis);
        point->items[axis] = (csg_value){.kind = CSG_VALUE_TERM, .as.term = id};
        made = id != CSG_FORMULA_NONE;
    }
    if (!made) {
        csg_eval_no_memory(e);
        return csg_value_undef();
    }
    return csg_value_object(point, CSG_VALUE_VECTOR);
}

static csg_value variable(csg_eval *e, uint32_t number)
{
    csg_formula_id id = csg_formula_variable(e->formula, number);
    if (id == CSG_FORMULA_NONE)
        csg_eval_no_memory(e);
    return (csg_value){.kind = CSG_VALUE_TERM, .as.term = id};
}

/* How many parameters have no value of their own. */
static uint32_t required(const csg_arguments *parameters)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < parameters->count; i++)
        count += !parameters->items[i].value;
    return count;
}

/* The function's value at the point of terms, or of as many terms as there are operands: each a
 * parameter, or several in one list. */
static csg_value call_function(csg_module_call *call, const csg_function *function,
                               uint32_t operands)
{
    csg_eval *e = call->e;
    const csg_arguments *parameters = &function->literal->as.call.arguments;
    csg_value result = csg_value_undef();
    csg_frame *frame = csg_frame_create(&e->heap, function->frame, parameters->count);
    if (!frame) {
        csg_eval_no_memory(e);
        return result;
    }
    frame->names = parameters->items;
    bool listed = !operands || (operands > 1 && required(parameters) == 1);
    for (uint32_t i = 0; !listed && i < operands && i < parameters->count; i++)
        frame->values[i] = variable(e, i);
    if (listed)
        frame->values[0] = list_of_terms(e, operands ? operands : 3);
    for (uint32_t i = listed ? 1 : operands; i < parameters->count && !e->stop; i++)
        frame->values[i] = parameters->items[i].value
                               ? csg_evaluate(e, parameters->items[i].value, function->frame)
                               : csg_value_undef();
    if (!e->stop)
        result = csg_evaluate(e, function->literal->as.call.body, frame);
    csg_frame_release(&e->heap, frame);
    return result;
}

/* The steps of the formula, from the heap's memory; NULL after a report. */
static csg_formula_step *make_steps(csg_module_call *call, uint32_t index,
                                    const csg_function *function, uint32_t operands,
                                    csg_formula_builder *builder, uint32_t *count)
{
    csg_eval *e = call->e;
    csg_value value = call_function(call, function, operands);
    csg_formula_id result = CSG_FORMULA_NONE;
    if (value.kind == CSG_VALUE_TERM)
        result = value.as.term;
    else if (value.kind == CSG_VALUE_NUMBER && !e->stop)
        result = csg_formula_constant(builder, value.as.number);
    else if (!e->stop && !e->refused)
        csg_argument_error(call, index, CSG_DIAG_BAD_TYPE,
                           "the function gives %s%s, it must give a number",
                           value.kind == CSG_VALUE_UNDEF ? "" : "a ", csg_value_kind_name(value));
    csg_value_release(&e->heap, value);
    if (result == CSG_FORMULA_NONE || e->stop)
        return NULL;
    csg_formula_step *steps = csg_memory_alloc(e->heap.memory, builder->count * sizeof *steps);
    *count = steps ? csg_formula_collect(builder, result, steps) : 0;
    if (!*count)
        csg_eval_no_memory(e);
    return steps;
}

bool csg_argument_is_function(const csg_module_call *call, uint32_t index, uint32_t least)
{
    csg_value function = call->values[index];
    return function.kind == CSG_VALUE_FUNCTION &&
           function.as.function->literal->as.call.arguments.count >= least;
}

csg_formula_step *csg_formula_of_function(csg_module_call *call, uint32_t index, uint32_t operands,
                                          uint32_t *count, size_t *bytes)
{
    return csg_formula_of_literal(call, index, call->values[index].as.function, operands, count,
                                  bytes);
}

csg_formula_step *csg_formula_of_literal(csg_module_call *call, uint32_t index,
                                         const csg_function *function, uint32_t operands,
                                         uint32_t *count, size_t *bytes)
{
    csg_eval *e = call->e;
    csg_formula_builder builder;
    csg_formula_begin(&builder, e->heap.memory);
    e->formula = &builder;
    e->refused = false;
    csg_formula_step *steps = make_steps(call, index, function, operands, &builder, count);
    e->formula = NULL;
    *bytes = builder.count * sizeof *steps;
    csg_formula_end(&builder);
    return steps;
}

csg_box csg_argument_box(csg_module_call *call, uint32_t index)
{
    csg_box box = csg_box_all();
    csg_value value = call->values[index];
    double low[3], high[3];
    if (!csg_has_argument(call, index) || call->failed)
        return box;
    if (value.kind != CSG_VALUE_VECTOR || value.as.vector->count != 2 ||
        !csg_value_numbers(value.as.vector->items[0], 3, low) ||
        !csg_value_numbers(value.as.vector->items[1], 3, high)) {
        csg_argument_error(call, index, CSG_DIAG_BAD_TYPE, "%s must be [[x, y, z], [x, y, z]]",
                           call->parameters[index].name);
        return box;
    }
    for (int axis = 0; axis < 3; axis++)
        if (!call->failed && !(isfinite(low[axis]) && low[axis] < high[axis]))
            csg_argument_error(call, index, CSG_DIAG_OUT_OF_RANGE,
                               "the box from %g to %g along %c has nothing inside", low[axis],
                               high[axis], "xyz"[axis]);
    return (csg_box){{low[0], low[1], low[2]}, {high[0], high[1], high[2]}};
}

/* What was stated, and no bound says that it holds. */
static void warn_raised(csg_module_call *call, int argument, double stated)
{
    const csgm_scene *scene = call->e->builder.scene;
    double used = scene->formulas[scene->formula_count - 1].lipschitz;
    if (stated > 0 && used > stated * (1 + 1e-9))
        csg_eval_report(call->e, CSG_DIAG_SLOPE_RAISED, call->spans[argument],
                        "proven = true keeps what is stated",
                        "lipschitz = %g could not be proven: %.3g is used, which can be slower and "
                        "less exact",
                        stated, used);
}

csg_node_id csg_module_field(csg_module_call *call)
{
    enum { FUNCTION, BOUNDS, LIPSCHITZ, DOMAIN, PROVEN };
    csg_eval *e = call->e;
    csg_span where = call->statement->where;
    if (!csg_argument_is_function(call, FUNCTION, 1))
        csg_argument_error(call, FUNCTION, CSG_DIAG_BAD_TYPE,
                           "it needs a function of a point, as function (p) 1 - norm(p)");
    bool cut = csg_has_argument(call, BOUNDS);
    const csg_field_domain domain = {.bounds = csg_argument_box(call, cut ? BOUNDS : DOMAIN),
                                     .cut = cut,
                                     .lipschitz =
                                         csg_argument_number(call, LIPSCHITZ, 0, CSG_POSITIVE),
                                     .trusted = csg_argument_boolean(call, PROVEN)};
    csg_node_id node = CSG_NODE_NONE;
    uint32_t count = 0;
    size_t bytes = 0;
    csg_formula_step *steps =
        call->failed ? NULL : csg_formula_of_function(call, FUNCTION, 0, &count, &bytes);
    if (steps && count && !call->failed)
        node = csg_build_field(&e->builder, steps, count, &domain, where);
    else if (!e->stop)
        node = csg_build_empty(&e->builder, where);
    if (steps && count && node != CSG_NODE_NONE)
        warn_raised(call, LIPSCHITZ, domain.lipschitz);
    csg_memory_release(e->heap.memory, steps, bytes);
    return e->stop ? CSG_NODE_NONE : csg_check_node(e, node, where);
}
