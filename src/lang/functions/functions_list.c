/* SPDX-License-Identifier: MIT
 * Lists and strings: len, concat, str, chr, ord; what kind a value is; version and
 * parent_module.
 */
#include <math.h>
#include <string.h>

#include "base/scene_codes.h"
#include "base/utf8.h"
#include "lang/functions/functions.h"

csg_value csg_function_len(const csg_function_call *call)
{
    csg_value value = call->arguments[0];
    if (value.kind == CSG_VALUE_VECTOR)
        return csg_value_number(value.as.vector->count);
    if (value.kind == CSG_VALUE_STRING)
        return csg_value_number((double)value.as.string->characters);
    if (value.kind == CSG_VALUE_RECORD)
        return csg_value_number(csg_record_count(value));
    return csg_bad_argument(call, 0, "a list or a string");
}

csg_value csg_function_concat(const csg_function_call *call)
{
    csg_list list = {0};
    double total = 0;
    for (uint32_t i = 0; i < call->count; i++)
        total +=
            call->arguments[i].kind == CSG_VALUE_VECTOR ? call->arguments[i].as.vector->count : 1;
    csg_list_reserve(call->e, &list, total, call->where);
    for (uint32_t i = 0; i < call->count; i++) {
        const csg_value *value = &call->arguments[i];
        bool one = value->kind != CSG_VALUE_VECTOR;
        const csg_value *items = one ? value : value->as.vector->items;
        uint32_t count = one ? 1 : value->as.vector->count;
        if (!csg_eval_charge(call->e, count / 4, call->where))
            break;
        for (uint32_t k = 0; k < count; k++)
            list.items[list.count++] = csg_value_retain(items[k]);
    }
    return csg_list_finish(call->e, &list);
}

/* ---- strings
 * ---------------------------------------------------------------------------------------- */

csg_value csg_function_str(const csg_function_call *call)
{
    csg_text text = csg_eval_text(call->e);
    for (uint32_t i = 0; i < call->count; i++)
        csg_text_put_value(&text, call->arguments[i], false, &call->e->program->symbols);
    return csg_eval_text_value(call->e, &text, call->where);
}

/* Recursion goes as deep as vectors nest: csg_vector.depth bounds it. */
static void put_characters(const csg_function_call *call, csg_text *text, csg_value codes)
{
    char utf8[4];
    csg_iteration iteration;
    csg_value code;
    if (codes.kind == CSG_VALUE_STRING || !csg_eval_check_stack(call->e, call->where) ||
        !csg_iteration_begin(call->e, &iteration, codes, call->where))
        return;
    while (!text->failed && csg_iteration_next(call->e, &iteration, &code, call->where)) {
        if (code.kind == CSG_VALUE_NUMBER && code.as.number >= 1 && code.as.number <= 0x10FFFF)
            csg_text_put(text, utf8, csg_utf8_encode((uint32_t)code.as.number, utf8));
        else if (code.kind == CSG_VALUE_VECTOR)
            put_characters(call, text, code);
        csg_value_release(&call->e->heap, code);
    }
}

csg_value csg_function_chr(const csg_function_call *call)
{
    csg_text text = csg_eval_text(call->e);
    for (uint32_t i = 0; i < call->count; i++)
        put_characters(call, &text, call->arguments[i]);
    return csg_eval_text_value(call->e, &text, call->where);
}

csg_value csg_function_ord(const csg_function_call *call)
{
    uint32_t character;
    csg_value value = call->arguments[0];
    if (value.kind != CSG_VALUE_STRING)
        return csg_bad_argument(call, 0, "a string");
    if (csg_utf8_decode(value.as.string->text, value.as.string->length, &character) == 0)
        return csg_value_undef();
    return csg_value_number(character);
}

/* ---- kinds and the rest
 * --------------------------------------------------------------------------------- */

static csg_value is_of_kind(const csg_function_call *call, csg_value_kind kind)
{
    csg_value value = call->arguments[0];
    if (value.kind == CSG_VALUE_RULE)
        return csg_value_boolean(kind == CSG_VALUE_BLEND);
    return csg_value_boolean(value.kind == kind &&
                             !(value.kind == CSG_VALUE_NUMBER && isnan(value.as.number)));
}

#define ASKS_KIND(name, kind)                                                                      \
    csg_value csg_function_##name(const csg_function_call *call)                                   \
    {                                                                                              \
        return is_of_kind(call, kind);                                                             \
    }

ASKS_KIND(is_undef, CSG_VALUE_UNDEF)
ASKS_KIND(is_num, CSG_VALUE_NUMBER)
ASKS_KIND(is_bool, CSG_VALUE_BOOLEAN)
ASKS_KIND(is_string, CSG_VALUE_STRING)
ASKS_KIND(is_list, CSG_VALUE_VECTOR)
ASKS_KIND(is_function, CSG_VALUE_FUNCTION)
ASKS_KIND(is_blend, CSG_VALUE_BLEND)
ASKS_KIND(is_object, CSG_VALUE_RECORD)

/* Files ask for the level of the language, not of this program. */
csg_value csg_function_version(const csg_function_call *call)
{
    uint32_t all = csg_eval_level(call->e);
    const double level[] = {all / 10000, all / 100 % 100, all % 100};
    csg_vector *made = csg_vector_create(&call->e->heap, 3);
    if (!made) {
        csg_eval_no_memory(call->e);
        return csg_value_undef();
    }
    for (size_t i = 0; i < 3; i++)
        made->items[i] = csg_value_number(level[i]);
    return csg_value_object(made, CSG_VALUE_VECTOR);
}

csg_value csg_function_version_num(const csg_function_call *call)
{
    double asked[3] = {0};
    if (call->count == 0)
        return csg_value_number(csg_eval_level(call->e));
    if (!csg_value_numbers(call->arguments[0], 3, asked) &&
        !csg_value_numbers(call->arguments[0], 2, asked))
        return csg_bad_argument(call, 0, "a version such as [2021, 1, 0]");
    return csg_value_number(asked[0] * 10000 + asked[1] * 100 + asked[2]);
}

csg_value csg_function_parent_module(const csg_function_call *call)
{
    csg_eval *e = call->e;
    double level = call->count ? -1 : 1;
    if (call->count && call->arguments[0].kind == CSG_VALUE_NUMBER)
        level = trunc(call->arguments[0].as.number);
    if (level < 0)
        return csg_bad_argument(call, 0, "a level of at least 0");
    for (size_t i = e->trace_count; i > 0; i--)
        if (e->trace[i - 1].module && level-- == 0) {
            const csg_symbol_entry *entry = &e->program->symbols.entries[e->trace[i - 1].name];
            return csg_eval_string(e, entry->name, entry->length);
        }
    csg_eval_report(e, CSG_DIAG_BAD_ARGUMENT, call->where, NULL,
                    "fewer modules are around this, parent_module() is undef");
    return csg_value_undef();
}
