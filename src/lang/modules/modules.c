/* SPDX-License-Identifier: MIT
 * The table of built-in modules and their arguments; see modules.h.
 */
#include "lang/modules/modules.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* ---- tables ------------------------------------------------------------------------------------
 */

typedef enum module_id {
#define CSG_MODULE(name, handler, children, doc) MODULE_##name,
#include "lang/modules/modules.def"
    MODULE_COUNT
} module_id;

#define csg_module_control NULL

static const struct {
    const char *name;
    csg_module_handler *handler; /* NULL = control flow */
    bool children;
} modules[] = {
#define CSG_MODULE(name, handler, children, doc) {#name, csg_module_##handler, children},
#include "lang/modules/modules.def"
};

enum how { NAMED, POSITIONAL };

static const csg_parameter_row parameters[] = {
#define CSG_PARAMETER(module, name, how, otherwise, unit, range, doc)                              \
    {#name, range, doc, MODULE_##module, how == POSITIONAL},
#include "lang/modules/modules.def"
};

static const struct {
    const char *name, *hint;
} unsupported[] =
    {
#define CSG_UNSUPPORTED(name, hint) {#name, hint},
#include "lang/parse/unsupported.def"
#undef CSG_UNSUPPORTED
},
  unsupported_functions[] = {
#define CSG_UNSUPPORTED(name, hint) {#name, hint},
#include "lang/functions/unsupported_functions.def"
#undef CSG_UNSUPPORTED
};

void csg_modules_intern(csg_symbols *symbols, bool *ok)
{
    const size_t counts[3] = {MODULE_COUNT, sizeof unsupported / sizeof *unsupported,
                              sizeof unsupported_functions / sizeof *unsupported_functions};
    for (int table = 0; table < 3; table++)
        for (size_t i = 0; i < counts[table] && *ok; i++) {
            const char *name = table == 0   ? modules[i].name
                               : table == 1 ? unsupported[i].name
                                            : unsupported_functions[i].name;
            csg_symbol symbol = csg_symbol_intern(symbols, name, strlen(name));
            csg_symbol_entry *entry = &symbols->entries[symbol];
            *ok = symbol != 0;
            if (symbol)
                *(table == 0   ? &entry->module
                  : table == 1 ? &entry->unsupported
                               : &entry->unsupported_function) = (int16_t)i;
        }
}

bool csg_module_is_control(int row)
{
    return modules[row].handler == NULL;
}

bool csg_report_unsupported(csg_eval *e, csg_member_kind kind, csg_symbol name, csg_span where)
{
    const csg_symbol_entry *entry = &e->program->symbols.entries[name];
    bool module = kind == CSG_MEMBER_MODULE;
    int row = module ? entry->unsupported : entry->unsupported_function;
    if (row < 0)
        return false;
    csg_eval_report(e, CSG_DIAG_NOT_SUPPORTED, where,
                    module ? unsupported[row].hint : unsupported_functions[row].hint,
                    "%s() is not supported yet", entry->name);
    return true;
}

/* ---- binding
 * --------------------------------------------------------------------------------------- */

static void find_rows(csg_module_call *call, int module)
{
    enum { COUNT = sizeof parameters / sizeof *parameters };
    size_t first = 0;
    while (first < COUNT && parameters[first].module != module)
        first++;
    call->parameters = parameters + first;
    for (; first < COUNT && parameters[first].module == module; first++)
        call->parameter_count++;
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
    if (facets)
        snprintf(hint, sizeof hint, "did you mean '$%s'?", name);
    for (uint32_t i = 0, at = 0; !facets && i < call->parameter_count && at < sizeof hint; i++)
        at += (uint32_t)snprintf(hint + at, sizeof hint - at, "%s%s", i ? ", " : "it takes ",
                                 call->parameters[i].name);
    csg_eval_report(call->e, CSG_DIAG_UNKNOWN_ARGUMENT, argument->where, hint[0] ? hint : NULL,
                    "%s() has no parameter '%s', this is ignored", call->name, name);
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
    csg_eval_report(call->e, CSG_DIAG_TOO_MANY_ARGUMENTS, argument->where,
                    call->parameter_count && strchr(call->parameters[0].doc, '[')
                        ? "a list stands in square brackets: [1, 2, 3]"
                    : named < call->parameter_count ? "write the others as name = value"
                                                    : NULL,
                    "%s() takes %u argument%s without a name, this is ignored", call->name, named,
                    named == 1 ? "" : "s");
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
            csg_eval_report(call->e, CSG_DIAG_UNKNOWN_ARGUMENT, argument->where, hint,
                            "the language knows no '%s'", name);
            return;
        }
}

static void bind(csg_module_call *call)
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

/* Modules whose children are not where they were: marks among them are not either. */
static bool moves_children(csg_module_handler *handler)
{
    static csg_module_handler *const movers[] = {
        csg_module_projection, csg_module_linear_extrude, csg_module_rotate_extrude,
        csg_module_minkowski,  csg_module_resize,         csg_module_repeat,
        csg_module_twist,      csg_module_bend,           csg_module_extrude,
        csg_module_warp};
    for (size_t i = 0; i < sizeof movers / sizeof *movers; i++)
        if (handler == movers[i])
            return true;
    return false;
}

void csg_run_builtin(csg_eval *e, int row, const csg_statement *statement, csg_frame *frame)
{
    csg_module_call call = {
        .e = e, .name = modules[row].name, .statement = statement, .frame = frame};
    size_t dynamics = e->dynamic_count, first_mark = e->mark_count;
    find_rows(&call, row);
    bind(&call);
    if (!modules[row].children && statement->children->statement_count && !e->stop)
        csg_eval_report(e, CSG_DIAG_CHILDREN_IGNORED, statement->children->statements[0]->where,
                        "is a ';' missing before it?", "%s() takes no children, this is ignored",
                        call.name);
    warn_childless(&call, row);
    csg_node_id node = e->stop ? CSG_NODE_NONE : modules[row].handler(&call);
    if (node != CSG_NODE_NONE && !e->stop)
        csg_push_part(e, csg_part_plain(node));
    if (moves_children(modules[row].handler))
        e->mark_count = first_mark;
    for (uint32_t i = 0; i < call.parameter_count; i++)
        csg_value_release(&e->heap, call.values[i]);
    csg_eval_pop_dynamics(e, dynamics);
}

/* ---- looking at arguments
 * ------------------------------------------------------------------------------ */

void csg_argument_error(csg_module_call *call, uint32_t index, csg_diag_code code,
                        const char *format, ...)
{
    char problem[320], hint[120];
    const csg_parameter_row *row = &call->parameters[index];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(problem, sizeof problem, format, arguments);
    va_end(arguments);
    snprintf(hint, sizeof hint, "%s must be %s", row->name, row->range);
    csg_eval_report(
        call->e, code, csg_has_argument(call, index) ? call->spans[index] : call->statement->where,
        (code == CSG_DIAG_OUT_OF_RANGE || code == CSG_DIAG_EMPTY_SHAPE) && row->range[0] ? hint
                                                                                         : NULL,
        "%s(): %s", call->name, problem);
    call->failed = true;
}

bool csg_has_argument(const csg_module_call *call, uint32_t index)
{
    return call->values[index].kind != CSG_VALUE_UNDEF;
}

static bool in_range(double number, csg_range_kind range)
{
    bool point = range == CSG_NOT_NEGATIVE || range == CSG_SIZE_OR_POINT;
    return isfinite(number) && (range == CSG_ANY || number > 0 || (point && number == 0));
}

/* `what` completes "r is": "-1", "nan". */
static void out_of_range(csg_module_call *call, uint32_t index, double number, csg_range_kind range)
{
    bool above = range == CSG_POSITIVE || range == CSG_SIZE;
    bool nothing = isfinite(number) && (range == CSG_SIZE || range == CSG_SIZE_OR_POINT);
    csg_argument_error(call, index, nothing ? CSG_DIAG_EMPTY_SHAPE : CSG_DIAG_OUT_OF_RANGE,
                       "%s is %g, %s %s", call->parameters[index].name,
                       isnan(number) ? fabs(number) : number,
                       nothing ? "so there is nothing: it must be" : "it must be",
                       !isfinite(number) ? "a finite number"
                       : above           ? "above 0"
                                         : "at least 0");
}

double csg_argument_number(csg_module_call *call, uint32_t index, double otherwise,
                           csg_range_kind range)
{
    csg_value value = call->values[index];
    if (value.kind == CSG_VALUE_UNDEF)
        return otherwise;
    if (value.kind != CSG_VALUE_NUMBER) {
        csg_argument_error(call, index, CSG_DIAG_BAD_TYPE, "%s must be a number, not a %s",
                           call->parameters[index].name, csg_value_kind_name(value));
        return otherwise;
    }
    if (!in_range(value.as.number, range)) {
        out_of_range(call, index, value.as.number, range);
        return otherwise;
    }
    return value.as.number;
}

double csg_argument_rounding(csg_module_call *call, uint32_t index, double smallest_edge)
{
    double round = csg_argument_number(call, index, 0, CSG_NOT_NEGATIVE);
    if (!call->failed && round > smallest_edge / 2)
        csg_argument_error(call, index, CSG_DIAG_OUT_OF_RANGE,
                           "round is %g, more than half the smallest edge, %g", round,
                           smallest_edge / 2);
    return round;
}

bool csg_argument_boolean(const csg_module_call *call, uint32_t index)
{
    return csg_value_is_true(call->values[index]);
}

csg_vec3 csg_argument_vector(csg_module_call *call, uint32_t index, csg_vec3 otherwise, bool spread)
{
    double v[3] = {otherwise.x, otherwise.y, otherwise.z};
    csg_value value = call->values[index];
    if (value.kind == CSG_VALUE_UNDEF)
        return otherwise;
    if (spread && value.kind == CSG_VALUE_NUMBER) {
        v[0] = v[1] = v[2] = value.as.number;
    } else if (!csg_value_numbers(value, 3, v) && !csg_value_numbers(value, 2, v)) {
        csg_argument_error(call, index, CSG_DIAG_BAD_TYPE, "%s must be %s[x, y, z], not a %s%s",
                           call->parameters[index].name, spread ? "a number or " : "",
                           csg_value_kind_name(value),
                           value.kind == CSG_VALUE_VECTOR ? " of something else" : "");
        return otherwise;
    }
    for (int i = 0; i < 3; i++)
        if (!isfinite(v[i])) {
            out_of_range(call, index, v[i], CSG_ANY);
            return otherwise;
        }
    return csg_vec3_make(v[0], v[1], v[2]);
}

csg_blend csg_argument_blend(csg_module_call *call, uint32_t index)
{
    const csg_blend sharp = {CSG_BLEND_SHARP, 0};
    csg_value value = call->values[index];
    if (value.kind == CSG_VALUE_BLEND)
        return (csg_blend){(csg_blend_kind)value.blend, value.as.number};
    if (value.kind == CSG_VALUE_RULE)
        return csg_rule_blend(call, index);
    if (value.kind != CSG_VALUE_UNDEF && value.kind != CSG_VALUE_NUMBER) {
        csg_argument_error(call, index, CSG_DIAG_BAD_BLEND,
                           "blend must be a radius or a blend value such as "
                           "cosine(3), not a %s",
                           csg_value_kind_name(value));
        return sharp;
    }
    double r = csg_argument_number(call, index, 0, CSG_NOT_NEGATIVE);
    return r > 0 ? (csg_blend){CSG_BLEND_ROUND, r} : sharp;
}

csg_node_id csg_module_children(csg_module_call *call)
{
    csg_eval *e = call->e;
    size_t first = e->part_count;
    csg_run_scope(e, call->statement->children, call->frame, true);
    return csg_join_parts(e, first, CSG_NODE_UNION, (csg_blend){CSG_BLEND_SHARP, 0},
                          call->statement->where);
}
