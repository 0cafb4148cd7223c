/* SPDX-License-Identifier: MIT
 * Control flow among statements: for, intersection_for, let, echo, assert, children.
 */
#include <math.h>

#include "base/scene_codes.h"
#include "lang/modules/modules.h"

static const csg_blend sharp = {.kind = 0};

/* ---- for
 * ----------------------------------------------------------------------------------------- */

typedef struct looping {
    const csg_statement *statement;
    bool intersect; /* each round is one part */
} looping;

static void run_round(csg_eval *e, const looping *l, csg_frame *frame)
{
    size_t first = e->part_count;
    csg_run_scope(e, l->statement->children, frame, true);
    if (l->intersect && !e->stop)
        csg_join_as_part(e, first, l->statement->where);
}

/* The k-th variable and those behind it. */
static void run_for(csg_eval *e, const looping *l, uint32_t k, csg_frame *frame)
{
    const csg_arguments *variables = &l->statement->arguments;
    if (k == variables->count) {
        run_round(e, l, frame);
        return;
    }
    csg_iteration iteration;
    const csg_argument *variable = &variables->items[k];
    csg_value element, over = csg_evaluate(e, variable->value, frame);
    size_t dynamics = e->dynamic_count;
    bool special = variable->name && e->program->symbols.entries[variable->name].special;
    bool begun = csg_iteration_begin(e, &iteration, over, variable->where);
    while (begun && csg_iteration_next(e, &iteration, &element, variable->where)) {
        csg_frame *inner = csg_frame_create(&e->heap, frame, 1);
        if (!inner) {
            csg_eval_no_memory(e);
            break;
        }
        inner->names = variable;
        if (special)
            csg_eval_push_dynamic(e, variable->name, element);
        else
            inner->values[0] = element;
        run_for(e, l, k + 1, inner);
        csg_frame_release(&e->heap, inner);
        csg_eval_pop_dynamics(e, dynamics);
    }
    csg_value_release(&e->heap, over);
}

bool csg_control_for(csg_eval *e, const csg_statement *statement, csg_frame *frame)
{
    const looping l = {statement, false};
    if (statement->arguments.count)
        run_for(e, &l, 0, frame);
    return true;
}

bool csg_control_intersection_for(csg_eval *e, const csg_statement *statement, csg_frame *frame)
{
    const looping l = {statement, true};
    size_t first = e->part_count;
    if (statement->arguments.count)
        run_for(e, &l, 0, frame);
    csg_node_id node = csg_join_parts(e, first, CSG_NODE_INTERSECTION, sharp, statement->where);
    if (node != CSG_NODE_NONE)
        csg_push_part(e, csg_part_plain(node));
    return true;
}

/* ---- let, echo, assert
 * -------------------------------------------------------------------------------- */

bool csg_control_let(csg_eval *e, const csg_statement *statement, csg_frame *frame)
{
    size_t dynamics = e->dynamic_count;
    csg_frame *inner = csg_eval_let(e, &statement->arguments, frame);
    if (inner && !e->stop)
        csg_run_scope(e, statement->children, inner, true);
    csg_frame_release(&e->heap, inner);
    csg_eval_pop_dynamics(e, dynamics);
    return true;
}

bool csg_control_echo(csg_eval *e, const csg_statement *statement, csg_frame *frame)
{
    csg_eval_echo(e, &statement->arguments, frame);
    csg_run_scope(e, statement->children, frame, true);
    return statement->children->statement_count > 0;
}

bool csg_control_assert(csg_eval *e, const csg_statement *statement, csg_frame *frame)
{
    if (csg_eval_assert(e, &statement->arguments, frame, statement->where))
        csg_run_scope(e, statement->children, frame, true);
    return statement->children->statement_count > 0;
}

/* ---- children
 * ------------------------------------------------------------------------------------------- */

typedef struct family { /* what stands under the call of the module we are in */
    const csg_scope *scope;
    csg_frame *frame; /* entered */
    const csg_statement *asking;
} family;

static void run_child(csg_eval *e, const family *f, double index)
{
    if (index >= 0 && index < f->scope->statement_count)
        csg_run_statement(e, f->scope->statements[(size_t)index], f->frame, true);
    else
        csg_eval_report(e, CSG_DIAG_CHILD_INDEX, f->asking->where, NULL,
                        "there is no child %g, this call has %u", index, f->scope->statement_count);
}

static void run_chosen(csg_eval *e, const family *f, csg_value index)
{
    csg_iteration iteration;
    csg_value element;
    if (index.kind == CSG_VALUE_NUMBER) {
        run_child(e, f, trunc(index.as.number));
        return;
    }
    if (index.kind != CSG_VALUE_VECTOR && index.kind != CSG_VALUE_RANGE) {
        csg_eval_report(e, CSG_DIAG_CHILD_INDEX, f->asking->where, NULL,
                        "an index of children is a number, a list or a range, not a %s",
                        csg_value_kind_name(index));
        return;
    }
    bool begun = csg_iteration_begin(e, &iteration, index, f->asking->where);
    while (begun && csg_iteration_next(e, &iteration, &element, f->asking->where)) {
        if (element.kind == CSG_VALUE_NUMBER)
            run_child(e, f, trunc(element.as.number));
        else
            csg_eval_report(e, CSG_DIAG_CHILD_INDEX, f->asking->where, NULL,
                            "an index of children is a number, not a %s",
                            csg_value_kind_name(element));
        csg_value_release(&e->heap, element);
    }
}

static void run_family(csg_eval *e, family *f, csg_value index, bool all)
{
    size_t dynamics = e->dynamic_count;
    csg_frame *outer = f->frame;
    f->frame = csg_eval_scope(e, f->scope, outer);
    if (f->frame && !e->stop) {
        if (all)
            csg_run_statements(e, f->scope, f->frame, true);
        else
            run_chosen(e, f, index);
    }
    csg_frame_release(&e->heap, f->frame);
    csg_eval_pop_dynamics(e, dynamics);
}

static void run_children(csg_eval *e, const csg_statement *statement, csg_frame *frame, bool one)
{
    const csg_frame *module = frame;
    while (module && !module->children)
        module = module->parent;
    if (!module) {
        csg_eval_report(e, CSG_DIAG_CHILDREN_OUTSIDE, statement->where, NULL,
                        "children() has a meaning only inside a module");
        return;
    }
    size_t dynamics = e->dynamic_count;
    csg_value index = one ? csg_value_number(0) : csg_value_undef();
    bool given = one;
    for (uint32_t i = 0; i < statement->arguments.count && !e->stop; i++) {
        const csg_argument *argument = &statement->arguments.items[i];
        csg_value value = csg_evaluate(e, argument->value, frame);
        if (argument->name && e->program->symbols.entries[argument->name].special) {
            csg_eval_push_dynamic(e, argument->name, value);
            continue;
        }
        csg_value_release(&e->heap, index);
        index = value;
        given = true;
    }
    family f = {module->children, module->children_frame, statement};
    if (!e->stop)
        run_family(e, &f, index, !given);
    csg_value_release(&e->heap, index);
    csg_eval_pop_dynamics(e, dynamics);
}

bool csg_control_children(csg_eval *e, const csg_statement *statement, csg_frame *frame)
{
    run_children(e, statement, frame, false);
    return true;
}

bool csg_control_child(csg_eval *e, const csg_statement *statement, csg_frame *frame)
{
    run_children(e, statement, frame, true);
    return true;
}
