/* SPDX-License-Identifier: MIT
 * Definitions: NAME=EXPRESSION; see overrides.h. Parameter sets are in parameter_set.c.
 */
#include "lang/parameters/overrides.h"

#include <string.h>

#include "base/scene_codes.h"
#include "lang/parameters/assignments.h"
#include "lang/parameters/parameter_set.h"
#include "lang/parse/parser.h"

static bool is_name(const char *text)
{
    size_t i = text[0] == '$';
    for (; text[i]; i++) {
        char c = text[i];
        bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
        if (!letter && !(c >= '0' && c <= '9' && i > 0))
            return false;
    }
    return i > (text[0] == '$');
}

static bool add_assignment(csg_program *program, csg_assignment made)
{
    csg_scope *scope = program->files[0]->scope;
    csg_assignment *place = csg_arena_push(&program->arena, (void **)&scope->variables,
                                           &scope->variable_count, sizeof made);
    if (place)
        *place = made;
    return place && csg_members_add(&program->members, scope->id, CSG_MEMBER_VARIABLE, made.name,
                                    scope->variable_count - 1);
}

/* Replaces the assignment of a name in the scene, or adds one. */
static csgm_status define(csg_program *program, csg_symbol name, csg_expression *value)
{
    const csg_symbol_entry *entry = &program->symbols.entries[name];
    csg_assignment made = {name, value, value->whole};
    char hint[120];
    if (csg_assignment_replace(program, name, value))
        return CSGM_OK;
    if (!entry->special)
        csg_diag_plain(
            &program->context->diags, CSG_DIAG_UNKNOWN_DEFINE, NULL,
            csg_assignment_suggest(program, entry->name, hint, sizeof hint),
            "the scene assigns no variable '%s' at its top level, -D has nothing to replace",
            entry->name);
    return add_assignment(program, made) ? CSGM_OK : csg_context_no_memory(program->context);
}

static csgm_status apply_define(csg_program *program, const csgm_define *given)
{
    uint32_t source;
    const char *expression = given->expression ? given->expression : "";
    if (!given->name || !is_name(given->name)) {
        csg_diag_plain(&program->context->diags, CSG_DIAG_BAD_DEFINE, NULL, "write -D name=value",
                       "'%.60s' is not the name of a variable", given->name ? given->name : "");
        return CSGM_ERR_SYNTAX;
    }
    const char *label = csg_arena_printf(&program->arena, "-D %s", given->name);
    csg_symbol name = csg_symbol_intern(&program->symbols, given->name, strlen(given->name));
    if (!label || !name)
        return csg_context_no_memory(program->context);
    csgm_status status =
        csg_source_add(&program->sources, label, expression, strlen(expression), &source);
    if (status != CSGM_OK)
        return status;
    csg_expression *value = csg_parse_lone_expression(program, source);
    return value ? define(program, name, value) : CSGM_ERR_SYNTAX;
}

csgm_status csg_overrides_apply(csg_program *program, const csgm_scene_options *options)
{
    csgm_status status = CSGM_OK;
    if (options->parameter_file && options->parameter_set)
        status = csg_parameter_set_apply(program, options->parameter_file, options->parameter_set);
    for (size_t i = 0; i < options->define_count; i++) {
        csgm_status one = apply_define(program, &options->defines[i]);
        if (status == CSGM_OK)
            status = one;
    }
    return status;
}
