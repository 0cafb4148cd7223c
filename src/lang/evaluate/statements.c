/* SPDX-License-Identifier: MIT
 * Statements -> parts: each leaves its solids on a stack (parts.c).
 */
#include <stdio.h>
#include <string.h>

#include "base/scene_codes.h"
#include "lang/evaluate/builtins.h"
#include "lang/evaluate/marks.h"

/* ---- modules of the scene
 * --------------------------------------------------------------------------- */

static void run_body(csg_eval *e, const csg_definition *module, csg_frame *call,
                     const csg_statement *statement)
{
    size_t first = e->part_count;
    csg_value outer = csg_eval_dynamic(e, e->symbol_parent_modules);
    csg_eval_push_dynamic(
        e, e->symbol_parent_modules,
        csg_value_number(outer.kind == CSG_VALUE_NUMBER ? outer.as.number + 1 : 1));
    if (!e->stop)
        csg_run_scope(e, module->body, call, true);
    csg_node_id node = csg_join_parts(e, first, CSG_NODE_UNION, CSG_SHARP, statement->where);
    if (node != CSG_NODE_NONE)
        csg_push_part(e, csg_part_plain(node));
}

static void run_module(csg_eval *e, const csg_definition *module, csg_frame *home,
                       const csg_statement *statement, csg_frame *frame)
{
    enum { CALL_STEPS = 10 };
    size_t dynamics = e->dynamic_count;
    if (!csg_eval_charge(e, CALL_STEPS, statement->where) || !csg_eval_enter(e, statement->where))
        return;
    csg_frame *call =
        csg_eval_bind(e, &module->parameters, &statement->arguments, home, frame, statement->name);
    if (call && !e->stop) {
        call->children = statement->children;
        call->child_count = csg_value_number(statement->children->statement_count);
        call->children_frame = csg_frame_retain(frame);
        size_t trace = e->trace_count;
        csg_eval_push_trace(e, statement->name, true, statement->where);
        run_body(e, module, call, statement);
        if (!e->stop)
            e->trace_count = trace;
    }
    csg_frame_release(&e->heap, call);
    csg_eval_pop_dynamics(e, dynamics);
    csg_eval_leave(e);
}

/* ---- statements
 * ---------------------------------------------------------------------------------------- */

static void run_unknown(csg_eval *e, const csg_statement *statement, csg_frame *frame)
{
    char hint[96];
    if (!csg_unsupported_report(e, statement->name, statement->where))
        csg_eval_report(e, CSG_DIAG_UNKNOWN_MODULE, statement->where,
                        csg_suggest(e, CSG_DIAG_UNKNOWN_MODULE, statement->name, frame,
                                    statement->where, hint, sizeof hint),
                        "there is no module '%s'%s",
                        csg_symbol_name(&e->program->symbols, statement->name),
                        csg_eval_is_lenient(e, CSG_DIAG_UNKNOWN_MODULE, statement->where)
                            ? "; it is left out, with what stands under it"
                            : "");
    csg_node_id node = e->stop ? CSG_NODE_NONE : csg_build_empty(&e->builder, statement->where);
    node = csg_check_node(e, node, statement->where);
    if (node != CSG_NODE_NONE)
        csg_push_part(e, csg_part_plain(node));
}

static void run_call(csg_eval *e, const csg_statement *statement, csg_frame *frame, bool spread)
{
    csg_called called;
    int row = e->program->symbols.entries[statement->name].module;
    if (csg_eval_find_called(e, CSG_MEMBER_MODULE, statement->name, statement->slot, frame,
                             &called)) {
        run_module(e, called.definition, called.home, statement, frame);
    } else if (row < 0) {
        run_unknown(e, statement, frame);
    } else if (!csg_eval_enter(e, statement->where)) {
        return;
    } else {
        e->program->builtins->run_module(e, row, statement, frame, spread);
        csg_eval_leave(e);
    }
}

static void run_if(csg_eval *e, const csg_statement *statement, csg_frame *frame, bool spread)
{
    csg_value condition = csg_evaluate(e, statement->condition, frame);
    const csg_scope *chosen = csg_value_is_true(condition) ? statement->children : statement->other;
    size_t first = e->part_count;
    csg_value_release(&e->heap, condition);
    if (chosen && csg_eval_enter(e, statement->where)) {
        csg_run_scope(e, chosen, frame, spread);
        csg_eval_leave(e);
    }
    if (!spread && !e->stop)
        csg_join_as_part(e, first, statement->where);
}

/* ! shows this alone: the first one holds. Its place in the scene becomes empty. */
static void make_root(csg_eval *e, const csg_statement *statement, size_t first, size_t first_mark)
{
    csg_node_id node = csg_join_parts(e, first, CSG_NODE_UNION, CSG_SHARP, statement->where);
    if (node == CSG_NODE_NONE)
        return;
    if (e->root != CSG_NODE_NONE) {
        csg_eval_report(e, CSG_DIAG_SEVERAL_ROOTS, statement->where, NULL,
                        "a second '!' modifier; the first one holds");
    } else {
        e->root = node;
        csg_marks_take(e, first_mark, statement->where, e->marked);
    }
    e->mark_count = first_mark;
}

void csg_run_statement(csg_eval *e, const csg_statement *statement, csg_frame *frame, bool spread)
{
    enum { STATEMENT_STEPS = 4 };
    size_t first = e->part_count, first_mark = e->mark_count;
    if (!csg_eval_charge(e, STATEMENT_STEPS, statement->where))
        return;
    if (statement->kind == CSG_STATEMENT_IF)
        run_if(e, statement, frame, spread);
    else
        run_call(e, statement, frame, spread);
    if (statement->background)
        csg_marks_add(e, first, CSGM_MARK_BACKGROUND, statement->where);
    else if (statement->highlight)
        csg_marks_add(e, first, CSGM_MARK_HIGHLIGHT, statement->where);
    if (statement->background && !e->stop)
        e->part_count = first; /* % : left out of the mesh */
    if (statement->root && !e->stop)
        make_root(e, statement, first, first_mark);
}

void csg_run_statements(csg_eval *e, const csg_scope *scope, csg_frame *frame, bool spread)
{
    for (uint32_t i = 0; i < scope->statement_count && !e->stop; i++)
        csg_run_statement(e, scope->statements[i], frame, spread);
}

void csg_run_scope(csg_eval *e, const csg_scope *scope, csg_frame *frame, bool spread)
{
    size_t dynamics = e->dynamic_count;
    csg_frame *inner = csg_eval_scope(e, scope, frame);
    if (inner && !e->stop)
        csg_run_statements(e, scope, inner, spread);
    csg_frame_release(&e->heap, inner);
    csg_eval_pop_dynamics(e, dynamics);
}

csg_node_id csg_eval_run(csg_eval *e)
{
    const csg_program_file *scene = e->program->files[0];
    csg_span whole = {scene->source, 0, 1};
    csg_frame *frame = csg_eval_file_frame(e, scene);
    if (frame && !e->stop)
        csg_run_statements(e, scene->scope, frame, true);
    csg_eval_keep_drawn(e, whole);
    csg_node_id node = csg_join_parts(e, 0, CSG_NODE_UNION, CSG_SHARP, whole);
    if (e->root == CSG_NODE_NONE)
        csg_marks_take(e, 0, whole, e->marked);
    return csg_eval_finish_flat(e, e->root != CSG_NODE_NONE ? e->root : node, whole);
}
