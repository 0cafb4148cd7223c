/* SPDX-License-Identifier: MIT
 * The table of built-in modules, and how the arguments of a call find their parameters; see
 * modules.h.
 */
#include "lang/modules/modules.h"

#include <pthread.h>
#include <stdio.h>
#include <string.h>

#include "base/scene_codes.h"

/* ---- tables ------------------------------------------------------------------------------------
 */

typedef enum module_id {
#define CSG_MODULE(name, handler, children, doc) MODULE_##name,
#define CSG_CONTROL(name, handler, children, doc) MODULE_##name,
#include "lang/modules/modules.def"
    MODULE_COUNT
} module_id;

static const struct {
    const char *name;
    csg_module_handler *handler; /* or */
    csg_control_handler *control;
    uint8_t children; /* as modules.def says */
} modules[] = {
#define CSG_MODULE(name, handler, children, doc) {#name, csg_module_##handler, NULL, children},
#define CSG_CONTROL(name, handler, children, doc) {#name, NULL, csg_control_##handler, children},
#include "lang/modules/modules.def"
};

/* Names that OpenSCAD has given up, and still takes. */
static const struct {
    const char *old;
    module_id module;
} aliases[] = {
#define CSG_ALIAS(old, name) {#old, MODULE_##name},
#include "lang/modules/modules.def"
};

enum how { NAMED, POSITIONAL };

static const csg_parameter_row parameters[] = {
#define CSG_PARAMETER(module, name, how, otherwise, unit, range, doc)                              \
    {#name, range, doc, MODULE_##module, how == POSITIONAL},
#include "lang/modules/modules.def"
};

void csg_modules_intern(csg_symbols *symbols, bool *ok)
{
    for (size_t i = 0; i < MODULE_COUNT && *ok; i++) {
        csg_symbol symbol = csg_symbol_intern(symbols, modules[i].name, strlen(modules[i].name));
        *ok = symbol != 0;
        if (symbol)
            symbols->entries[symbol].module = (int16_t)i;
    }
    for (size_t i = 0; i < sizeof aliases / sizeof *aliases && *ok; i++) {
        csg_symbol symbol = csg_symbol_intern(symbols, aliases[i].old, strlen(aliases[i].old));
        *ok = symbol != 0;
        if (symbol)
            symbols->entries[symbol].module = (int16_t)aliases[i].module;
    }
}

/* ---- binding
 * --------------------------------------------------------------------------------------- */

/* The rows of a module stand side by side; found once for all. */
typedef struct parameter_range {
    uint16_t first, count;
} parameter_range;

static parameter_range ranges[MODULE_COUNT];
static pthread_once_t ranges_once = PTHREAD_ONCE_INIT;

static void find_ranges(void)
{
    enum { COUNT = sizeof parameters / sizeof *parameters };
    for (size_t i = 0; i < COUNT; i++) {
        parameter_range *range = &ranges[parameters[i].module];
        if (range->count++ == 0)
            range->first = (uint16_t)i;
    }
}

static void find_rows(csg_module_call *call, int module)
{
    pthread_once(&ranges_once, find_ranges);
    call->parameters = parameters + ranges[module].first;
    call->parameter_count = ranges[module].count;
}

/* The parameter that is called so elsewhere (its text begins with that word: "radius at both
 * ends"), or that is one letter away; of several the one with the shortest name. NULL: none. */
static const char *meant_parameter(const csg_module_call *call, const char *name)
{
    const char *best = NULL;
    size_t length = strlen(name);
    for (uint32_t i = 0; i < call->parameter_count; i++) {
        const csg_parameter_row *row = &call->parameters[i];
        bool is_word = strncmp(row->doc, name, length) == 0 &&
                       (row->doc[length] == '\0' || strchr(" ,;:", row->doc[length]));
        bool is_near = length > 2 && csg_edit_distance(name, row->name, 1) == 1;
        if ((is_word || is_near) && (!best || strlen(row->name) < strlen(best)))
            best = row->name;
    }
    return best;
}

static void warn_unknown(csg_module_call *call, const csg_argument *argument)
{
    const csg_symbols *symbols = &call->e->program->symbols;
    char hint[160] = "";
    if (argument->name == call->e->symbol_blend) {
        csg_eval_report(call->e, CSG_DIAG_UNUSED_BLEND, argument->where,
                        "union, intersection and difference take blend",
                        "%s() joins nothing, its blend is not used", call->name);
        return;
    }
    const char *name = csg_symbol_name(symbols, argument->name);
    bool facets = strcmp(name, "fn") == 0 || strcmp(name, "fa") == 0 || strcmp(name, "fs") == 0;
    const char *meant = meant_parameter(call, name);
    uint32_t at = 0;
    if (facets)
        snprintf(hint, sizeof hint, "did you mean '$%s'?", name);
    else if (meant)
        at = (uint32_t)snprintf(hint, sizeof hint, "did you mean '%s'? ", meant);
    for (uint32_t i = 0; !facets && i < call->parameter_count && at < sizeof hint; i++)
        at += (uint32_t)snprintf(hint + at, sizeof hint - at, "%s%s", i ? ", " : "it takes ",
                                 call->parameters[i].name);
    csg_eval_report(call->e, CSG_DIAG_UNKNOWN_ARGUMENT, argument->where, hint[0] ? hint : NULL,
                    "%s() has no parameter '%s'%s", call->name, name,
                    csg_eval_ignores(call->e, CSG_DIAG_UNKNOWN_ARGUMENT, argument->where));
}

/* The parameter an argument goes to; parameter_count when there is none (reported). */
static uint32_t find_slot(csg_module_call *call, const csg_argument *argument, uint32_t *position)
{
    uint32_t slot = 0, named = 0;
    if (argument->name) {
        const char *name = csg_symbol_name(&call->e->program->symbols, argument->name);
        while (slot < call->parameter_count && strcmp(call->parameters[slot].name, name) != 0)
            slot++;
        if (slot == call->parameter_count)
            warn_unknown(call, argument);
        return slot;
    }
    slot = (*position)++;
    if (slot < call->parameter_count && call->parameters[slot].positional)
        return slot;
    while (named < call->parameter_count && call->parameters[named].positional)
        named++;
    char list[100];
    snprintf(list, sizeof list, "a list stands in square brackets: %.40s([1, 2, 3])", call->name);
    csg_eval_report(call->e, CSG_DIAG_TOO_MANY_ARGUMENTS, argument->where,
                    call->parameter_count && strchr(call->parameters[0].doc, '[') ? list
                    : named < call->parameter_count ? "write the others as name = value"
                                                    : NULL,
                    "%s() takes %u argument%s without a name%s", call->name, named,
                    named == 1 ? "" : "s",
                    csg_eval_ignores(call->e, CSG_DIAG_TOO_MANY_ARGUMENTS, argument->where));
    return call->parameter_count;
}

/* A special variable of this name may be meant for the children: only what looks like a slip. */
static void warn_misspelt(const csg_module_call *call, const csg_argument *argument)
{
    static const char *const known[] = {"$fn", "$fa", "$fs"};
    const csg_eval *e = call->e;
    const char *name = csg_symbol_name(&e->program->symbols, argument->name);
    char hint[32];
    if (csg_eval_dynamic(e, argument->name).kind != CSG_VALUE_UNSET)
        return;
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (csg_edit_distance(name, known[i], 1) == 1) {
            snprintf(hint, sizeof hint, "did you mean '%s'?", known[i]);
            csg_eval_report(call->e, CSG_DIAG_MISSPELT_SPECIAL, argument->where, hint,
                            "the language knows no '%s'", name);
            return;
        }
}

static void bind_arguments(csg_module_call *call)
{
    csg_eval *e = call->e;
    const csg_arguments *arguments = &call->statement->arguments;
    uint32_t position = 0;
    for (uint32_t i = 0; i < arguments->count && !e->stop; i++) {
        const csg_argument *argument = &arguments->items[i];
        if (argument->name && e->program->symbols.entries[argument->name].special) {
            warn_misspelt(call, argument);
            csg_eval_push_dynamic(e, argument->name, csg_evaluate(e, argument->value, call->frame));
            continue;
        }
        uint32_t slot = find_slot(call, argument, &position);
        bool blend =
            slot < call->parameter_count && strcmp(call->parameters[slot].name, "blend") == 0;
        csg_value value = blend ? csg_evaluate_blend(e, argument->value, call->frame)
                                : csg_evaluate(e, argument->value, call->frame);
        if (slot == call->parameter_count) {
            csg_value_release(&e->heap, value);
            continue;
        }
        if (call->values[slot].kind != CSG_VALUE_UNDEF)
            csg_eval_report(e, CSG_DIAG_DUPLICATE_ARGUMENT, argument->where,
                            argument->name ? NULL : "a decimal number has a point: 2.5",
                            "%s() gets '%s' twice, the last one holds", call->name,
                            call->parameters[slot].name);
        csg_value_release(&e->heap, call->values[slot]);
        call->values[slot] = value;
        call->spans[slot] = argument->value->whole;
    }
}

void csg_module_call_of_function(csg_module_call *call, const csg_function_call *from,
                                 const char *module, uint32_t skipped)
{
    int row = 0;
    uint32_t position = 0;
    while (row < MODULE_COUNT && strcmp(modules[row].name, module) != 0)
        row++;
    find_rows(call, row);
    call->parameters += skipped;
    call->parameter_count -= skipped;
    for (uint32_t i = 0; i < from->count; i++) {
        const csg_argument *argument = &from->syntax[i];
        uint32_t slot = find_slot(call, argument, &position);
        if (slot == call->parameter_count)
            continue;
        call->values[slot] = from->arguments[i];
        call->spans[slot] = argument->value->whole;
    }
}

/* `translate([1, 2, 3]); sphere(1);`: groups may be empty, a transform of nothing is a mistake. */
static void warn_childless(const csg_module_call *call, int row)
{
    static const char *const transforms[] = {"translate", "rotate", "scale", "mirror", "color"};
    if (!modules[row].children || !call->statement->childless)
        return;
    for (size_t i = 0; i < sizeof transforms / sizeof *transforms; i++)
        if (strcmp(call->name, transforms[i]) == 0)
            csg_eval_report(call->e, CSG_DIAG_NO_CHILDREN, call->statement->where,
                            "is the ';' behind it one too many?", "%s() has no solid to act on",
                            call->name);
}

/* Does it ask for more of its children's solids than their boxes and whether they are flat? */
static bool asks_of_children(int row)
{
    static const module_id passing[] = {
        MODULE_translate, MODULE_rotate, MODULE_scale, MODULE_mirror,       MODULE_multmatrix,
        MODULE_color,     MODULE_part,   MODULE_union, MODULE_intersection, MODULE_difference,
        MODULE_material,  MODULE_group,  MODULE_hull,  MODULE_minkowski,    MODULE_render};
    for (size_t i = 0; i < sizeof passing / sizeof *passing; i++)
        if (row == (int)passing[i])
            return false;
    return modules[row].children;
}

static void run_module(csg_eval *e, int row, const csg_statement *statement, csg_frame *frame)
{
    csg_module_call call = {
        .e = e, .name = modules[row].name, .statement = statement, .frame = frame};
    size_t dynamics = e->dynamic_count, first_mark = e->mark_count;
    find_rows(&call, row);
    bind_arguments(&call);
    if (!modules[row].children && statement->children->statement_count && !e->stop)
        csg_eval_report(e, CSG_DIAG_CHILDREN_IGNORED, statement->children->statements[0]->where,
                        "is a ';' missing before it?", "%s() takes no children, this is ignored",
                        call.name);
    warn_childless(&call, row);
    bool asks = asks_of_children(row);
    e->asking += asks;
    csg_node_id node = e->stop ? CSG_NODE_NONE : modules[row].handler(&call);
    e->asking -= asks;
    if (node != CSG_NODE_NONE && !e->stop)
        csg_push_part(e, csg_part_plain(node));
    if (modules[row].children == 2)
        e->mark_count = first_mark;
    for (uint32_t i = 0; i < call.parameter_count; i++)
        csg_value_release(&e->heap, call.values[i]);
    csg_eval_pop_dynamics(e, dynamics);
}

static void run_control(csg_eval *e, int row, const csg_statement *statement, csg_frame *frame,
                        bool spread)
{
    size_t first = e->part_count;
    bool solid = modules[row].control(e, statement, frame);
    if (!spread && solid && !e->stop)
        csg_join_as_part(e, first, statement->where);
}

void csg_modules_run(csg_eval *e, int row, const csg_statement *statement, csg_frame *frame,
                     bool spread)
{
    if (modules[row].control)
        run_control(e, row, statement, frame, spread);
    else
        run_module(e, row, statement, frame);
}
