/* SPDX-License-Identifier: MIT
 * Statements -> parts -> nodes. Each statement leaves its solids as parts on a stack; the operator
 * around it joins what lies above its mark.
 */
#include <stdio.h>
#include <string.h>

#include "lang/evaluate/marks.h"
#include "lang/modules/shapes.h"

/* ---- parts -------------------------------------------------------------------------------------
 */

void csg_push_part(csg_eval *e, csg_part part)
{
    if (e->stop)
        return;
    if (csg_memory_reserve(&e->context->memory, (void **)&e->parts, &e->part_capacity,
                           e->part_count + 1, sizeof *e->parts))
        e->parts[e->part_count++] = part;
    else
        csg_eval_no_memory(e);
}

/* The builder's first failure is sticky; a bad solid is told and built on without it. */
csg_node_id csg_check_node(csg_eval *e, csg_node_id node, csg_span where)
{
    csg_scene_builder *builder = &e->builder;
    if (node != CSG_NODE_NONE || e->stop)
        return node;
    if (builder->status == CSGM_ERR_MEMORY) {
        csg_eval_no_memory(e);
    } else if (builder->status == CSGM_ERR_LIMIT) {
        csg_eval_limit(e, CSG_DIAG_TOO_MANY_NODES, where, "raise the limit with --max-nodes", "%s",
                       builder->problem);
    } else {
        csg_eval_report(e, CSG_DIAG_BAD_SOLID, where, NULL, "%s", builder->problem);
        builder->status = CSGM_OK;
        builder->problem[0] = '\0';
        node = csg_build_empty(builder, where);
        if (node == CSG_NODE_NONE)
            csg_eval_no_memory(e);
    }
    return node;
}

/* Moves the nodes of plain parts to the front, in order; the number of them. */
static size_t gather(csg_part *parts, size_t count, csg_node_id *out)
{
    size_t plain = 0;
    for (size_t i = 0; i < count; i++)
        if (!parts[i].wrapped || i == 0)
            out[plain++] = parts[i].node;
    return plain;
}

static csg_node_id join_wrapped(csg_eval *e, csg_part *parts, size_t count, csg_node_id node,
                                csg_node_kind kind, csg_span where)
{
    for (size_t i = 1; i < count && node != CSG_NODE_NONE; i++) {
        if (!parts[i].wrapped)
            continue;
        csg_node_id pair[2] = {node, parts[i].node};
        node = csg_check_node(
            e, csg_build_operator(&e->builder, kind, parts[i].blend, pair, 2, where), where);
    }
    return node;
}

/* The first part is what the others join. In a union or intersection a first part that is wrapped
 * goes behind the first that is not, so that its blend is used. */
static void put_plain_first(csg_eval *e, csg_part *parts, size_t count, csg_node_kind kind)
{
    size_t i = 0;
    if (count == 0 || !parts[0].wrapped)
        return;
    if (kind == CSG_NODE_DIFFERENCE || count == 1) {
        csg_eval_report(
            e, CSG_DIAG_UNUSED_BLEND, parts[0].where, NULL,
            count == 1 ? "there is nothing that this blend() could join with"
                       : "the first child of a difference joins nothing, its blend() is not used");
        return;
    }
    while (i < count && parts[i].wrapped)
        i++;
    if (i < count) {
        csg_part plain = parts[i];
        memmove(parts + 1, parts, i * sizeof *parts);
        parts[0] = plain;
    }
}

csg_node_id csg_join_parts(csg_eval *e, size_t first, csg_node_kind kind, csg_blend blend,
                           csg_span where)
{
    if (!e->stop)
        csg_shape_keep_alike(e, first, where);
    return csg_join_mixed_parts(e, first, kind, blend, where);
}

csg_node_id csg_join_mixed_parts(csg_eval *e, size_t first, csg_node_kind kind, csg_blend blend,
                                 csg_span where)
{
    if (e->stop)
        return CSG_NODE_NONE;
    size_t count = e->part_count - first, bytes = (count ? count : 1) * sizeof(csg_node_id);
    csg_part *parts = count ? e->parts + first : NULL;
    put_plain_first(e, parts, count, kind);
    csg_node_id node = CSG_NODE_NONE, *children = csg_memory_alloc(&e->context->memory, bytes);
    if (children) {
        size_t plain = gather(parts, count, children);
        node = csg_check_node(
            e, csg_build_operator(&e->builder, kind, blend, children, plain, where), where);
        node = join_wrapped(e, parts, count, node, kind, where);
    } else {
        csg_eval_no_memory(e);
    }
    csg_memory_release(&e->context->memory, children, bytes);
    e->part_count = first;
    return node;
}

void csg_join_as_part(csg_eval *e, size_t first, csg_span where)
{
    if (e->part_count == first + 1)
        return;
    csg_node_id node =
        csg_join_parts(e, first, CSG_NODE_UNION, (csg_blend){CSG_BLEND_SHARP, 0}, where);
    if (node != CSG_NODE_NONE)
        csg_push_part(e, csg_part_plain(node));
}

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
    csg_node_id node =
        csg_join_parts(e, first, CSG_NODE_UNION, (csg_blend){CSG_BLEND_SHARP, 0}, statement->where);
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
    if (!csg_report_unsupported(e, CSG_MEMBER_MODULE, statement->name, statement->where))
        csg_eval_report(e, CSG_DIAG_UNKNOWN_MODULE, statement->where,
                        csg_suggest(e, CSG_DIAG_UNKNOWN_MODULE, statement->name, frame,
                                    statement->where, hint, sizeof hint),
                        "there is no module '%s'",
                        csg_symbol_name(&e->program->symbols, statement->name));
    csg_node_id node = e->stop ? CSG_NODE_NONE : csg_build_empty(&e->builder, statement->where);
    node = csg_check_node(e, node, statement->where);
    if (node != CSG_NODE_NONE)
        csg_push_part(e, csg_part_plain(node));
}

static void run_call(csg_eval *e, const csg_statement *statement, csg_frame *frame, bool spread)
{
    csg_frame *home;
    const csg_definition *module;
    int row = e->program->symbols.entries[statement->name].module;
    if (csg_eval_find_definition(e, CSG_MEMBER_MODULE, statement->name, frame, &home, &module)) {
        run_module(e, module, home, statement, frame);
    } else if (row < 0) {
        run_unknown(e, statement, frame);
    } else if (!csg_eval_enter(e, statement->where)) {
        return;
    } else {
        if (csg_module_is_control(row))
            csg_run_control(e, statement, frame, spread);
        else
            csg_run_builtin(e, row, statement, frame);
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
    csg_node_id node =
        csg_join_parts(e, first, CSG_NODE_UNION, (csg_blend){CSG_BLEND_SHARP, 0}, statement->where);
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
        csg_marks_add(e, first, CSG_MARK_BACKGROUND, statement->where);
    else if (statement->highlight)
        csg_marks_add(e, first, CSG_MARK_HIGHLIGHT, statement->where);
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
    const csg_file *scene = e->program->files[0];
    csg_span whole = {scene->source, 0, 1};
    csg_frame *frame = csg_eval_file_frame(e, scene);
    if (frame && !e->stop)
        csg_run_statements(e, scene->scope, frame, true);
    csg_node_id node = csg_join_parts(e, 0, CSG_NODE_UNION, (csg_blend){CSG_BLEND_SHARP, 0}, whole);
    if (e->root == CSG_NODE_NONE)
        csg_marks_take(e, 0, whole, e->marked);
    return csg_shape_of_scene(e, e->root != CSG_NODE_NONE ? e->root : node, whole);
}
