/* SPDX-License-Identifier: MIT
 * Lists and strings: len, concat, lookup, search, str, chr, ord; what kind a value is; version and
 * parent_module.
 */
#include <math.h>
#include <string.h>

#include "lang/functions.h"
#include "text/utf8.h"

csg_value csg_function_len(const csg_function_call *call)
{
    csg_value value = call->arguments[0];
    if (value.kind == CSG_VALUE_VECTOR)
        return csg_value_number(value.as.vector->count);
    if (value.kind == CSG_VALUE_STRING)
        return csg_value_number((double)value.as.string->characters);
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

/* ---- lookup -------------------------------------------------------------------------------------
 */

csg_value csg_function_lookup(const csg_function_call *call)
{
    if (call->arguments[0].kind != CSG_VALUE_NUMBER)
        return csg_bad_argument(call, 0, "a number to look up");
    if (call->arguments[1].kind != CSG_VALUE_VECTOR || call->arguments[1].as.vector->count == 0)
        return csg_bad_argument(call, 1, "a list of [key, value] pairs");
    const csg_vector *table = call->arguments[1].as.vector;
    double key = call->arguments[0].as.number, row[2];
    double below[2] = {-INFINITY, NAN}, above[2] = {INFINITY, NAN};
    if (!csg_eval_charge(call->e, table->count / 4, call->where))
        return csg_value_undef();
    for (uint32_t i = 0; i < table->count; i++) {
        if (!csg_value_numbers(table->items[i], 2, row))
            return csg_bad_argument(call, 1, "a list of [key, value] pairs of numbers");
        if (row[0] <= key && row[0] > below[0])
            memcpy(below, row, sizeof row);
        if (row[0] >= key && row[0] < above[0])
            memcpy(above, row, sizeof row);
    }
    if (isinf(below[0]) || isinf(above[0]) || below[0] == above[0])
        return csg_value_number(isinf(below[0]) ? above[1] : below[1]);
    double t = (key - below[0]) / (above[0] - below[0]);
    return csg_value_number(above[1] * t + below[1] * (1 - t));
}

/* ---- search
 * --------------------------------------------------------------------------------------- */

typedef struct searching {
    const csg_function_call *call;
    csg_value where;
    double returns; /* matches wanted for each; 0 = all */
    uint32_t column;
} searching;

static bool matches(const searching *s, csg_value what, uint32_t i)
{
    csg_value element = s->where.as.vector->items[i];
    if (csg_value_equal(s->call->e, what, element, s->call->where))
        return true;
    return element.kind == CSG_VALUE_VECTOR && s->column < element.as.vector->count &&
           csg_value_equal(s->call->e, what, element.as.vector->items[s->column], s->call->where);
}

static void find_in_string(const searching *s, const char *character, size_t length,
                           csg_list *found)
{
    enum { BYTES_A_STEP = 16 };
    const csg_string *string = s->where.as.string;
    double index = 0;
    csg_eval_charge(s->call->e, string->length / BYTES_A_STEP + 1, s->call->where);
    for (size_t at = 0; at < string->length && !s->call->e->stop; index++) {
        size_t step = csg_utf8_length(string->text + at, string->length - at);
        step = step ? step : 1;
        if (step == length && memcmp(string->text + at, character, length) == 0)
            csg_list_push(s->call->e, found, csg_value_number(index), s->call->where);
        if (s->returns > 0 && (double)found->count >= s->returns)
            return;
        at += step;
    }
}

static void find_in_vector(const searching *s, csg_value what, csg_list *found)
{
    enum { ELEMENTS_A_STEP = 8 };
    uint32_t count = s->where.as.vector->count;
    csg_eval_charge(s->call->e, count / ELEMENTS_A_STEP + 1, s->call->where);
    for (uint32_t i = 0; i < count && !s->call->e->stop; i++) {
        if (matches(s, what, i))
            csg_list_push(s->call->e, found, csg_value_number(i), s->call->where);
        if (s->returns > 0 && (double)found->count >= s->returns)
            return;
    }
}

/* One match wanted: the index itself, or [] in a list of values; else the list of indices. */
static void add_matches(const searching *s, csg_list *found, csg_list *out, bool keep_misses)
{
    if (s->returns != 1 || (found->count == 0 && keep_misses)) {
        csg_list_push(s->call->e, out, csg_list_finish(s->call->e, found), s->call->where);
        return;
    }
    if (found->count)
        csg_list_push(s->call->e, out, found->items[0], s->call->where);
    csg_memory_release(s->call->e->heap.memory, found->items,
                       found->capacity * sizeof *found->items);
}

static csg_value search_characters(const searching *s, const csg_string *what)
{
    csg_list out = {0};
    for (size_t at = 0; at < what->length && !s->call->e->stop;) {
        csg_list found = {0};
        size_t step = csg_utf8_length(what->text + at, what->length - at);
        step = step ? step : 1;
        if (s->where.kind == CSG_VALUE_STRING) {
            find_in_string(s, what->text + at, step, &found);
        } else {
            csg_value character = csg_eval_string(s->call->e, what->text + at, step);
            find_in_vector(s, character, &found);
            csg_value_release(&s->call->e->heap, character);
        }
        add_matches(s, &found, &out, false);
        at += step;
    }
    return csg_list_finish(s->call->e, &out);
}

csg_value csg_function_search(const csg_function_call *call)
{
    csg_value what = call->arguments[0];
    searching s = {call, call->arguments[1], 1, 0};
    csg_list found = {0};
    if (s.where.kind != CSG_VALUE_VECTOR &&
        !(s.where.kind == CSG_VALUE_STRING && what.kind == CSG_VALUE_STRING))
        return csg_bad_argument(call, 1, "a list (or a string) to search in");
    if (call->count > 2 && call->arguments[2].kind == CSG_VALUE_NUMBER &&
        call->arguments[2].as.number >= 0)
        s.returns = trunc(call->arguments[2].as.number);
    if (call->count > 3 && call->arguments[3].kind == CSG_VALUE_NUMBER &&
        call->arguments[3].as.number >= 0)
        s.column = (uint32_t)fmin(call->arguments[3].as.number, 1e9);
    if (what.kind == CSG_VALUE_NUMBER) {
        find_in_vector(&s, what, &found);
        return csg_list_finish(call->e, &found);
    }
    if (what.kind == CSG_VALUE_STRING)
        return search_characters(&s, what.as.string);
    if (what.kind != CSG_VALUE_VECTOR)
        return csg_bad_argument(call, 0, "a number, a string or a list to search for");
    csg_list out = {0};
    for (uint32_t i = 0; i < what.as.vector->count && !call->e->stop; i++) {
        found = (csg_list){0};
        find_in_vector(&s, what.as.vector->items[i], &found);
        add_matches(&s, &found, &out, true);
    }
    return csg_list_finish(call->e, &out);
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

static void put_characters(const csg_function_call *call, csg_text *text, csg_value codes)
{
    char utf8[4];
    csg_iteration iteration;
    csg_value code;
    if (codes.kind == CSG_VALUE_STRING ||
        !csg_iteration_begin(call->e, &iteration, codes, call->where))
        return;
    while (!text->failed && csg_iteration_next(call->e, &iteration, &code, call->where)) {
        if (code.kind == CSG_VALUE_NUMBER && code.as.number >= 1 && code.as.number <= 0x10FFFF)
            csg_text_put(text, utf8, csg_utf8_encode((uint32_t)code.as.number, utf8));
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

csg_value csg_function_is(const csg_function_call *call)
{
    static const struct {
        const char *name;
        csg_value_kind kind;
    } table[] = {{"is_undef", CSG_VALUE_UNDEF},  {"is_num", CSG_VALUE_NUMBER},
                 {"is_bool", CSG_VALUE_BOOLEAN}, {"is_string", CSG_VALUE_STRING},
                 {"is_list", CSG_VALUE_VECTOR},  {"is_function", CSG_VALUE_FUNCTION},
                 {"is_blend", CSG_VALUE_BLEND}};
    csg_value value = call->arguments[0];
    size_t i = 0;
    while (strcmp(table[i].name, call->name) != 0)
        i++;
    return csg_value_boolean(value.kind == table[i].kind &&
                             !(value.kind == CSG_VALUE_NUMBER && isnan(value.as.number)));
}

/* Files ask for the level of the language, not of this program: that of OpenSCAD 2021.01. */
csg_value csg_function_version(const csg_function_call *call)
{
    static const double level[] = {2021, 1, 0};
    if (strcmp(call->name, "version_num") == 0)
        return csg_value_number(20210100);
    csg_vector *made = csg_vector_create(&call->e->heap, 3);
    if (!made) {
        csg_eval_no_memory(call->e);
        return csg_value_undef();
    }
    for (size_t i = 0; i < 3; i++)
        made->items[i] = csg_value_number(level[i]);
    return csg_value_object(made, CSG_VALUE_VECTOR);
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
    return csg_value_undef();
}
