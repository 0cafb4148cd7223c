/* SPDX-License-Identifier: MIT
 * The evaluator's housekeeping: findings, limits, dynamic variables, names and scopes.
 */
#include "lang/evaluate/evaluator.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/clock.h"
#include "base/mesh_codes.h"
#include "base/scene_codes.h"
#include "outline/letters/text.h"
#include "shape/plane/drawing.h"

/* ---- findings ----------------------------------------------------------------------------------
 */

static bool grow_reported(csg_eval *e)
{
    size_t slots = e->reported_slots ? e->reported_slots * 2 : 64;
    uint64_t *fresh = csg_memory_alloc(&e->context->memory, slots * sizeof *fresh);
    if (!fresh)
        return false;
    memset(fresh, 0, slots * sizeof *fresh);
    for (size_t i = 0; i < e->reported_slots; i++) {
        size_t at = (size_t)(e->reported[i] * 0x9E3779B97F4A7C15u >> 32) & (slots - 1);
        while (e->reported[i] && fresh[at])
            at = (at + 1) & (slots - 1);
        if (e->reported[i])
            fresh[at] = e->reported[i];
    }
    csg_memory_release(&e->context->memory, e->reported, e->reported_slots * sizeof *fresh);
    e->reported = fresh;
    e->reported_slots = slots;
    return true;
}

static uint64_t key_of(csg_diag_code code, csg_span where)
{
    return ((uint64_t)where.source << 32 | where.offset) * 1000 + (uint64_t)code;
}

/* The slot of a key, or the free one where it belongs. The table is never full. */
static size_t slot_of(const csg_eval *e, uint64_t key)
{
    size_t at = (size_t)(key * 0x9E3779B97F4A7C15u >> 32) & (e->reported_slots - 1);
    while (e->reported[at] && e->reported[at] != key)
        at = (at + 1) & (e->reported_slots - 1);
    return at;
}

bool csg_eval_has_told(const csg_eval *e, csg_diag_code code, csg_span where)
{
    return e->reported_slots && e->reported[slot_of(e, key_of(code, where))] != 0;
}

/* True the first time for a code at a place. */
static bool is_news(csg_eval *e, csg_diag_code code, csg_span where)
{
    if (csg_eval_has_told(e, code, where))
        return false;
    if (e->reported_count * 2 >= e->reported_slots && !grow_reported(e)) {
        csg_eval_no_memory(e);
        return false;
    }
    uint64_t key = key_of(code, where);
    e->reported[slot_of(e, key)] = key;
    e->reported_count++;
    return true;
}

static void report(csg_eval *e, csg_diag_code code, csg_span where, const char *hint,
                   const char *format, va_list arguments)
{
    char message[512];
    vsnprintf(message, sizeof message, format, arguments);
    csg_source_report(&e->program->sources, code, where, hint, "%s", message);
    csg_eval_note_calls(e);
}

bool csg_eval_is_lenient(const csg_eval *e, csg_diag_code code, csg_span where)
{
    return csg_source_is_lenient(&e->program->sources, code, where);
}

const char *csg_eval_ignores(const csg_eval *e, csg_diag_code code, csg_span where)
{
    return csg_eval_is_lenient(e, code, where) ? ", this is ignored" : "";
}

void csg_eval_report(csg_eval *e, csg_diag_code code, csg_span where, const char *hint,
                     const char *format, ...)
{
    va_list arguments;
    if (csg_diag_severity(code) == CSGM_ERROR && !csg_eval_is_lenient(e, code, where) &&
        e->status == CSGM_OK)
        e->status = CSGM_ERR_SCENE;
    if (e->stop || !is_news(e, code, where))
        return;
    va_start(arguments, format);
    report(e, code, where, hint, format, arguments);
    va_end(arguments);
}

void csg_eval_no_memory(csg_eval *e)
{
    if (!e->stop)
        e->status = csg_context_no_memory(e->context);
    e->stop = true;
}

void csg_eval_no_memory_at(csg_eval *e, csg_span where)
{
    if (!csg_memory_has_ended(&e->context->memory) || csg_eval_check_time(e, where))
        csg_eval_no_memory(e);
}

void csg_eval_limit(csg_eval *e, csg_diag_code code, csg_span where, const char *hint,
                    const char *format, ...)
{
    va_list arguments;
    if (e->stop)
        return;
    va_start(arguments, format);
    report(e, code, where, hint, format, arguments);
    va_end(arguments);
    e->stop = true;
    e->status = CSGM_ERR_LIMIT;
}

/* ---- limits
 * ---------------------------------------------------------------------------------------- */

bool csg_eval_look_at_limits(csg_eval *e, csg_span where)
{
    enum { LOOK_AT_CLOCK = 4096 };
    const uint64_t most = e->context->limits.eval_steps;
    if (e->steps > most) {
        csg_eval_limit(e, CSG_DIAG_TOO_MANY_STEPS, where,
                       "is there an endless loop? raise the limit with --max-steps",
                       "the evaluation takes more than %llu steps", (unsigned long long)most);
        return false;
    }
    if (e->steps - e->clock_steps >= LOOK_AT_CLOCK && !csg_eval_check_time(e, where))
        return false;
    e->next_look = e->clock_steps + LOOK_AT_CLOCK;
    if (e->next_look > most)
        e->next_look = most + 1; /* no overflow: it is less than the other */
    return true;
}

bool csg_eval_check_time(csg_eval *e, csg_span where)
{
    e->clock_steps = e->steps;
    if (!e->stop && csg_context_is_cancelled(e->context)) {
        e->stop = true;
        e->status = CSGM_CANCELLED;
    }
    if (e->program->deadline_s == 0 || csg_clock_now_s() <= e->program->deadline_s)
        return !e->stop;
    csg_memory_end_when(&e->context->memory, NULL, NULL); /* what is left is to say so */
    csg_eval_limit(e, CSG_DIAG_TIMEOUT, where, NULL, "the evaluation takes more than %g seconds",
                   e->context->limits.timeout_s);
    return !e->stop;
}

void csg_eval_stack_ends(csg_eval *e, csg_span where)
{
    csg_eval_limit(e, CSG_DIAG_TOO_DEEP, where, NULL,
                   "calls and expressions are nested too deeply");
}

bool csg_eval_enter(csg_eval *e, csg_span where)
{
    if (e->stop || !csg_eval_check_stack(e, where))
        return false;
    if (e->depth >= e->context->limits.depth) {
        csg_eval_limit(e, CSG_DIAG_TOO_DEEP, where,
                       "does the recursion end? raise the limit with --max-depth",
                       "more than %u calls are nested", e->context->limits.depth);
        return false;
    }
    e->depth++;
    return true;
}

void csg_eval_leave(csg_eval *e)
{
    e->depth--;
}

void csg_eval_push_trace(csg_eval *e, csg_symbol name, bool module, csg_span where)
{
    if (!csg_memory_reserve(&e->context->memory, (void **)&e->trace, &e->trace_capacity,
                            e->trace_count + 1, sizeof *e->trace)) {
        csg_eval_no_memory(e);
        return;
    }
    e->trace[e->trace_count++] = (csg_trace_entry){name, module, where};
}

/* ---- dynamic variables
 * -------------------------------------------------------------------------------- */

void csg_eval_push_dynamic(csg_eval *e, csg_symbol name, csg_value value)
{
    if (e->stop ||
        !csg_memory_reserve(&e->context->memory, (void **)&e->dynamics, &e->dynamic_capacity,
                            e->dynamic_count + 1, sizeof *e->dynamics)) {
        csg_value_release(&e->heap, value);
        csg_eval_no_memory(e);
        return;
    }
    e->dynamics[e->dynamic_count++] = (csg_dynamic){name, e->dynamic_heads[name], value};
    e->dynamic_heads[name] = (uint32_t)e->dynamic_count;
}

void csg_eval_pop_dynamics(csg_eval *e, size_t count)
{
    while (e->dynamic_count > count) {
        csg_dynamic *top = &e->dynamics[--e->dynamic_count];
        e->dynamic_heads[top->name] = top->hidden;
        csg_value_release(&e->heap, top->value);
    }
}

csg_value csg_eval_dynamic(const csg_eval *e, csg_symbol name)
{
    uint32_t head = e->dynamic_heads[name];
    return head ? e->dynamics[head - 1].value : (csg_value){.kind = CSG_VALUE_UNSET};
}

/* ---- scopes
 * ---------------------------------------------------------------------------------------------- */

/* In the order of first assignment; a value that is used before it is set is not there yet. */
static void assign_variables(csg_eval *e, const csg_scope *scope, csg_frame *frame)
{
    for (uint32_t i = 0; i < scope->variable_count && !e->stop; i++) {
        const csg_assignment *assignment = &scope->variables[i];
        csg_value value = csg_evaluate(e, assignment->value, frame);
        if (e->program->symbols.entries[assignment->name].special)
            csg_eval_push_dynamic(e, assignment->name, value);
        else
            frame->values[i] = value;
    }
}

/* The $variables of a used file hold in the calls into it: they are kept in its frame. */
static void keep_dynamics(csg_eval *e, csg_frame *frame, size_t dynamics)
{
    for (uint32_t i = 0; i < frame->count && !e->stop && e->dynamic_count > dynamics; i++) {
        csg_symbol name = frame->scope->variables[i].name;
        if (!e->program->symbols.entries[name].special)
            continue;
        frame->values[i] = csg_value_retain(csg_eval_dynamic(e, name));
        frame->has_dynamics = true;
    }
    csg_eval_pop_dynamics(e, dynamics);
}

csg_frame *csg_eval_scope(csg_eval *e, const csg_scope *scope, csg_frame *parent)
{
    if (parent && scope->variable_count + scope->function_count + scope->module_count == 0)
        return csg_frame_retain(parent);
    csg_frame *frame = csg_frame_create(&e->heap, parent, scope->variable_count);
    if (!frame) {
        csg_eval_no_memory(e);
        return NULL;
    }
    frame->scope = scope;
    assign_variables(e, scope, frame);
    return frame;
}

csg_frame *csg_eval_file_frame(csg_eval *e, const csg_program_file *file)
{
    csg_frame **frame = &e->file_frames[file->index];
    if (*frame)
        return *frame;
    size_t dynamics = e->dynamic_count;
    *frame = csg_frame_create(&e->heap, NULL, file->scope->variable_count);
    if (!*frame) {
        csg_eval_no_memory(e);
        return NULL;
    }
    (*frame)->scope = file->scope;
    (*frame)->file = file;
    assign_variables(e, file->scope, *frame);
    if (file->index != 0) /* the scene's own $variables hold for all of the run */
        keep_dynamics(e, *frame, dynamics);
    return *frame;
}

/* ---- beginning and end
 * -------------------------------------------------------------------------------------- */

static csg_symbol intern(csg_eval *e, const char *name)
{
    return csg_symbol_intern(&e->program->symbols, name, strlen(name));
}

static bool intern_symbols(csg_eval *e)
{
    const struct {
        csg_symbol *symbol;
        const char *name;
    } table[] = {{&e->symbol_pi, "PI"},
                 {&e->symbol_children_count, "$children"},
                 {&e->symbol_parent_modules, "$parent_modules"},
                 {&e->symbol_fn, "$fn"},
                 {&e->symbol_fa, "$fa"},
                 {&e->symbol_fs, "$fs"},
                 {&e->symbol_round, "round"},
                 {&e->symbol_x, "x"},
                 {&e->symbol_y, "y"},
                 {&e->symbol_z, "z"},
                 {&e->symbol_begin, "begin"},
                 {&e->symbol_step, "step"},
                 {&e->symbol_end, "end"},
                 {&e->symbol_blend, "blend"},
                 {&e->symbol_n, "n"},
                 {&e->symbol_r, "r"},
                 {&e->symbol_children, "children"},
                 {&e->symbol_w, "w"}};
    for (size_t i = 0; i < sizeof table / sizeof *table; i++)
        if (!(*table[i].symbol = intern(e, table[i].name)))
            return false;
    return true;
}

/* The special variables that OpenSCAD always has. */
static void push_constants(csg_eval *e)
{
    static const struct {
        const char *name;
        double value;
    } numbers[] = {{"$fn", 0}, {"$fa", 12}, {"$fs", 2}, {"$t", 0}, {"$vpd", 500}, {"$vpf", 22.5}};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        csg_eval_push_dynamic(e, intern(e, numbers[i].name), csg_value_number(numbers[i].value));
    csg_eval_push_dynamic(e, intern(e, "$preview"), csg_value_boolean(false));
    for (int i = 0; i < 2; i++) {
        csg_vector *vector = csg_vector_create(&e->heap, 3);
        if (!vector) {
            csg_eval_no_memory(e);
            return;
        }
        for (size_t k = 0; k < 3; k++)
            vector->items[k] = csg_value_number(0);
        csg_eval_push_dynamic(e, intern(e, i == 0 ? "$vpr" : "$vpt"),
                              csg_value_object(vector, CSG_VALUE_VECTOR));
    }
}

static bool intern_constants(csg_eval *e)
{
    static const char *const names[] = {"$fa",  "$fs",      "$t",   "$vpd",
                                        "$vpf", "$preview", "$vpr", "$vpt"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (!intern(e, names[i]))
            return false;
    return intern_symbols(e);
}

csgm_status csg_eval_init(csg_eval *e, csg_program *program)
{
    csg_memory *memory = &program->context->memory;
    *e = (csg_eval){.program = program,
                    .context = program->context,
                    .root = CSG_NODE_NONE,
                    .marked = {CSG_NODE_NONE, CSG_NODE_NONE}};
    csg_heap_init(&e->heap, memory, program->context->limits.depth);
    if (intern_constants(e)) { /* no name is interned after this: the table of heads stays */
        e->dynamic_heads =
            csg_arena_calloc(&program->arena, program->symbols.count, sizeof(uint32_t));
        e->dynamic_head_count = program->symbols.count;
    }
    e->file_frames = csg_arena_calloc(&program->arena, program->file_count, sizeof *e->file_frames);
    if (!e->file_frames || !e->dynamic_heads || !csg_eval_make_slots(e)) {
        csg_eval_no_memory(e);
        return e->status;
    }
    e->status = csg_build_begin(&e->builder, program->context);
    if (e->status != CSGM_OK) {
        csg_eval_no_memory(e);
        return e->status;
    }
    push_constants(e);
    return e->status;
}

void csg_eval_reset(csg_eval *e)
{
    csg_memory *memory = &e->context->memory;
    csg_build_abandon(&e->builder);
    csg_drawing_destroy(e->drawing);
    csg_fonts_destroy(e->fonts);
    csg_heap_reset(&e->heap);
    csg_memory_release(memory, e->dynamics, e->dynamic_capacity * sizeof *e->dynamics);
    csg_memory_release(memory, e->spare_list.items,
                       e->spare_list.capacity * sizeof *e->spare_list.items);
    csg_memory_release(memory, e->trace, e->trace_capacity * sizeof *e->trace);
    csg_memory_release(memory, e->parts, e->part_capacity * sizeof *e->parts);
    csg_memory_release(memory, e->marks, e->mark_capacity * sizeof *e->marks);
    csg_memory_release(memory, e->reported, e->reported_slots * sizeof *e->reported);
}
