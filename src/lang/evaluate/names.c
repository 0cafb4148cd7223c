/* SPDX-License-Identifier: MIT
 * Names -> what they stand for: variables through the frames outwards, functions and modules
 * through the scopes of these and the files that they use.
 *
 * Where a name is found depends on its place in the text alone, for the frames that a place sees
 * lie in the text's own order: the same number of frames further out, the same position in that
 * frame. So each use of a name has a slot that keeps both after the first search, and later
 * evaluations go straight there. Three things are not for the text to say, and are searched for
 * every time: a variable that is not set yet where it stands next (then an outer one of its name
 * holds), $variables, and $children. Builds with assertions search always, and compare.
 */
#include "base/mesh_codes.h"
#include "base/scene_codes.h"
#include "lang/evaluate/evaluator.h"

bool csg_eval_make_slots(csg_eval *e)
{
    csg_arena *arena = &e->program->arena;
    uint32_t count = e->program->slot_count;
    e->variable_slots = csg_arena_calloc(arena, count, sizeof *e->variable_slots);
    e->call_slots = csg_arena_calloc(arena, count, sizeof *e->call_slots);
    return e->variable_slots && e->call_slots;
}

/* ---- variables ------------------------------------------------------------------------------- */

/* The position of a name in a frame, UINT32_MAX: it is not there. Of several in one call or let the
 * last one that is set, else the last one. */
static uint32_t place_in_frame(csg_eval *e, const csg_frame *frame, csg_symbol name)
{
    enum { FEW = 8, NAMES_A_STEP = 16 };
    uint32_t place = UINT32_MAX;
    if (frame->names) {
        e->steps += frame->count / NAMES_A_STEP;
        for (uint32_t i = frame->count; i > 0; i--)
            if (frame->names[i - 1].name == name) {
                if (frame->values[i - 1].kind != CSG_VALUE_UNSET)
                    return i - 1;
                place = place == UINT32_MAX ? i - 1 : place;
            }
        return place;
    }
    if (frame->count > FEW)
        return csg_members_find(&e->program->members, frame->scope->id, CSG_MEMBER_VARIABLE, name);
    for (uint32_t i = 0; i < frame->count; i++)
        if (frame->scope->variables[i].name == name)
            place = i;
    return place;
}

/* What stands in the text for a frame: its parameters, or its scope. */
static const void *owner_of(const csg_frame *frame)
{
    return frame->names ? (const void *)frame->names : (const void *)frame->scope;
}

/* Is this position that of the last name of its kind in the frame? Else it holds only as long as
 * that one is not set. */
static bool is_last(const csg_frame *frame, uint32_t place, csg_symbol name)
{
    for (uint32_t i = place + 1; frame->names && i < frame->count; i++)
        if (frame->names[i].name == name)
            return false;
    return true;
}

/* Searches all frames; fills the slot, unless NULL, where the place is for good. */
static const csg_value *search(csg_eval *e, csg_symbol name, const csg_frame *frame,
                               csg_variable_slot *slot)
{
    uint32_t hops = 0;
    uint32_t head = e->program->symbols.entries[name].special ? e->dynamic_heads[name] : 0;
    bool is_special = e->program->symbols.entries[name].special || name == e->symbol_children_count;
    if (head)
        return &e->dynamics[head - 1].value;
    for (const csg_frame *at = frame; at; at = at->parent, hops++) {
        uint32_t place = at->count ? place_in_frame(e, at, name) : UINT32_MAX;
        if (place < at->count && at->values[place].kind != CSG_VALUE_UNSET) {
            if (slot && !is_special && is_last(at, place, name))
                *slot = (csg_variable_slot){owner_of(at), hops, place};
            return &at->values[place];
        }
        if (place < at->count)
            slot = NULL; /* once it is set it will be found here */
        if (name == e->symbol_children_count && at->children)
            return &at->child_count;
    }
    return NULL;
}

const csg_value *csg_eval_lookup(csg_eval *e, csg_symbol name, const csg_frame *frame)
{
    return search(e, name, frame, NULL);
}

const csg_value *csg_eval_search_variable(csg_eval *e, const csg_expression *x,
                                          const csg_frame *frame)
{
    return search(e, x->as.name, frame, &e->variable_slots[x->slot]);
}

bool csg_eval_would_find(csg_eval *e, const csg_expression *x, const csg_frame *frame,
                         const csg_value *found)
{
    uint64_t steps = e->steps;
    bool same = search(e, x->as.name, frame, NULL) == found;
    e->steps = steps;
    return same;
}

csg_value csg_eval_no_variable(csg_eval *e, const csg_expression *x, csg_frame *frame)
{
    char hint[96];
    if (x->as.name == e->symbol_pi)
        return csg_value_number(3.14159265358979323846);
    const char *text = csg_symbol_name(&e->program->symbols, x->as.name);
    bool is_lenient = e->program->sources.items[x->where.source].lenient;
    if (text[0] >= '0' && text[0] <= '9' && !is_lenient) { /* where OpenSCAD knows a variable */
        csg_eval_report(e, CSG_DIAG_BAD_NUMBER, x->where,
                        "numbers have no units, a multiplication needs '*'",
                        "'%s' is not a number, and no variable has this name", text);
        return csg_value_undef();
    }
    csg_eval_report(
        e, CSG_DIAG_UNKNOWN_VARIABLE, x->where,
        csg_suggest(e, CSG_DIAG_UNKNOWN_VARIABLE, x->as.name, frame, x->where, hint, sizeof hint),
        "there is no variable '%s' here, it counts as undef", text);
    return csg_value_undef();
}

/* ---- functions and modules ------------------------------------------------------------------- */

static const csg_definition *find_in_scope(const csg_eval *e, const csg_scope *scope,
                                           csg_member_kind kind, csg_symbol name)
{
    bool module = kind == CSG_MEMBER_MODULE;
    if ((module ? scope->module_count : scope->function_count) == 0)
        return NULL;
    uint32_t index = csg_members_find(&e->program->members, scope->id, kind, name);
    return index == UINT32_MAX ? NULL : module ? scope->modules[index] : scope->functions[index];
}

static bool find_in_used(csg_eval *e, csg_member_kind kind, csg_symbol name,
                         const csg_program_file *file, csg_called *out, csg_call_slot *slot)
{
    for (uint32_t i = file->use_count; i > 0; i--) { /* the last one goes before */
        const csg_definition *found = find_in_scope(e, file->uses[i - 1]->scope, kind, name);
        if (found) {
            out->definition = slot->definition = found;
            slot->file = file->uses[i - 1];
            out->home = csg_eval_file_frame(e, slot->file);
            return out->home != NULL;
        }
    }
    return false;
}

/* Searches all frames, and fills the slot. */
static bool search_called(csg_eval *e, csg_member_kind kind, csg_symbol name, csg_frame *frame,
                          csg_called *out, csg_call_slot *slot)
{
    *out = (csg_called){0};
    *slot = (csg_call_slot){.is_known = true};
    for (csg_frame *at = frame; at; at = at->parent, slot->hops++) {
        out->definition = at->scope ? find_in_scope(e, at->scope, kind, name) : NULL;
        if (out->definition) {
            out->home = at;
            slot->definition = out->definition;
            slot->scope = at->scope;
            return true;
        }
        if (at->file && find_in_used(e, kind, name, at->file, out, slot))
            return true;
    }
    slot->is_known = !e->stop; /* a file that could not be evaluated has no frame */
    return false;
}

bool csg_eval_find_definition(csg_eval *e, csg_member_kind kind, csg_symbol name, csg_frame *frame,
                              csg_called *out)
{
    csg_call_slot slot;
    return search_called(e, kind, name, frame, out, &slot);
}

#ifndef NDEBUG
static bool is_called(csg_eval *e, csg_member_kind kind, csg_symbol name, csg_frame *frame,
                      const csg_called *found)
{
    csg_called again;
    csg_eval_find_definition(e, kind, name, frame, &again);
    return e->stop || (again.definition == found->definition && again.home == found->home);
}
#endif

bool csg_eval_find_called(csg_eval *e, csg_member_kind kind, csg_symbol name, uint32_t number,
                          csg_frame *frame, csg_called *out)
{
    csg_call_slot *slot = &e->call_slots[number];
    if (!slot->is_known)
        return search_called(e, kind, name, frame, out, slot);
    *out = (csg_called){.definition = slot->definition};
    if (slot->file) {
        out->home = csg_eval_file_frame(e, slot->file);
    } else if (slot->definition) {
        out->home = frame;
        for (uint32_t hops = slot->hops; hops > 0 && out->home; hops--)
            out->home = out->home->parent;
        if (!out->home || out->home->scope != slot->scope)
            return search_called(e, kind, name, frame, out, slot);
    }
    assert(is_called(e, kind, name, frame, out));
    return out->home != NULL;
}
