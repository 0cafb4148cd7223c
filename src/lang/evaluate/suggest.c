/* SPDX-License-Identifier: MIT
 * "did you mean 'sphere'?": advice for a name that nothing defines. What people from other programs
 * call it (habits.def), the same name in another role, or the nearest name by edit distance.
 */
#include <stdio.h>
#include <string.h>

#include "base/scene_codes.h"
#include "lang/evaluate/evaluator.h"
#include "lang/parse/hints.h"

typedef struct search {
    const char *wanted, *best;
    uint32_t distance; /* of best */
} search;

static void consider(search *s, const char *name)
{
    uint32_t distance = s->distance ? csg_edit_distance(s->wanted, name, s->distance - 1) : 1;
    if (distance < s->distance) { /* never when it is 0 */
        s->distance = distance;
        s->best = name;
    }
}

static void consider_scope(csg_eval *e, search *s, const csg_scope *scope, csg_member_kind kind)
{
    enum { MOST = 2000 };
    const csg_symbols *symbols = &e->program->symbols;
    for (uint32_t i = 0; kind == CSG_MEMBER_VARIABLE && i < scope->variable_count && i < MOST; i++)
        consider(s, csg_symbol_name(symbols, scope->variables[i].name));
    for (uint32_t i = 0; kind == CSG_MEMBER_FUNCTION && i < scope->function_count && i < MOST; i++)
        consider(s, csg_symbol_name(symbols, scope->functions[i]->name));
    for (uint32_t i = 0; kind == CSG_MEMBER_MODULE && i < scope->module_count && i < MOST; i++)
        consider(s, csg_symbol_name(symbols, scope->modules[i]->name));
}

static void consider_frame(csg_eval *e, search *s, const csg_frame *frame, csg_member_kind kind)
{
    if (frame->scope)
        consider_scope(e, s, frame->scope, kind);
    for (uint32_t i = 0; frame->file && kind != CSG_MEMBER_VARIABLE && i < frame->file->use_count;
         i++)
        consider_scope(e, s, frame->file->uses[i]->scope, kind);
    for (uint32_t i = 0; frame->names && kind == CSG_MEMBER_VARIABLE && i < frame->count; i++)
        consider(s, csg_symbol_name(&e->program->symbols, frame->names[i].name));
}

static bool is_same_but_case(const char *a, const char *b)
{
    for (; *a && *b; a++, b++)
        if ((*a | 0x20) != (*b | 0x20))
            return false;
    return *a == *b;
}

static void consider_builtins(csg_eval *e, search *s, csg_member_kind kind)
{
    for (size_t i = 1; kind != CSG_MEMBER_VARIABLE && i < e->program->symbols.count; i++) {
        const csg_symbol_entry *entry = &e->program->symbols.entries[i];
        bool there = (kind == CSG_MEMBER_FUNCTION ? entry->function : entry->module) >= 0;
        if (there && is_same_but_case(s->wanted, entry->name)) {
            s->best = entry->name;
            s->distance = 0;
        } else if (there) {
            consider(s, entry->name);
        }
    }
}

/* A module called like a function, and the other way round. */
static const char *hint_of_role(csg_eval *e, csg_member_kind kind, csg_symbol name,
                                csg_frame *frame)
{
    const csg_symbol_entry *entry = &e->program->symbols.entries[name];
    csg_called called;
    if (kind == CSG_MEMBER_VARIABLE)
        return NULL;
    csg_member_kind other = kind == CSG_MEMBER_MODULE ? CSG_MEMBER_FUNCTION : CSG_MEMBER_MODULE;
    bool there = (other == CSG_MEMBER_FUNCTION ? entry->function : entry->module) >= 0 ||
                 csg_eval_find_definition(e, other, name, frame, &called);
    if (there)
        return other == CSG_MEMBER_FUNCTION
                   ? "it is a function: it gives a value, as in x = name(...), and makes no solid"
                   : "it is a module: it makes a solid and gives no value";
    const csg_value *variable = csg_eval_lookup(e, name, frame);
    if (!variable)
        return NULL;
    return kind == CSG_MEMBER_MODULE ? "it is a variable; a solid with a name is a module: module "
                                       "name() sphere(3);"
                                     : "it is a variable; a multiplication needs '*'";
}

static const char *nearest_name(csg_eval *e, csg_member_kind kind, const char *wanted,
                                const csg_frame *frame)
{
    search s = {.wanted = wanted};
    size_t length = strlen(s.wanted);
    s.distance = length <= 3 ? 2 : length <= 5 ? 3 : 4; /* one more than is allowed */
    for (const csg_frame *at = frame; at; at = at->parent)
        consider_frame(e, &s, at, kind);
    consider_builtins(e, &s, kind);
    return !s.best || strcmp(s.best, s.wanted) == 0 || length < 2 ? NULL : s.best;
}

const char *csg_suggest(csg_eval *e, csg_diag_code code, csg_symbol name, csg_frame *frame,
                        csg_span where, char *buffer, size_t size)
{
    bool module = code == CSG_DIAG_UNKNOWN_MODULE, function = code == CSG_DIAG_UNKNOWN_FUNCTION;
    csg_member_kind kind = module     ? CSG_MEMBER_MODULE
                           : function ? CSG_MEMBER_FUNCTION
                                      : CSG_MEMBER_VARIABLE;
    if (csg_eval_has_told(e, code, where) ||
        !csg_source_is_shown(&e->program->sources, code, where))
        return NULL; /* nobody will see it: the search is not for loops */
    const csg_symbol_entry *entry = &e->program->symbols.entries[name];
    const char *hint = hint_of_role(e, kind, name, frame);
    if (!hint)
        hint = csg_habit_hint(module     ? CSG_HABIT_MODULE
                              : function ? CSG_HABIT_FUNCTION
                                         : CSG_HABIT_VARIABLE,
                              entry->name, entry->length);
    if (hint)
        return hint;
    const char *best = nearest_name(e, kind, entry->name, frame);
    if (!best)
        return NULL;
    snprintf(buffer, size, "did you mean '%s'?", best);
    return buffer;
}
