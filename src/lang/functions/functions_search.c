/* SPDX-License-Identifier: MIT
 * search() and lookup() with the corners that OpenSCAD 2021.01 gives them: a string looks for its
 * characters one by one, in the texts' first characters where it searches a list; a table that is
 * no list is empty; rows of a lookup that are no pairs of numbers are passed over.
 */
#include <math.h>
#include <string.h>

#include "base/scene_codes.h"
#include "base/utf8.h"
#include "lang/functions/functions.h"

/* ---- lookup -----------------------------------------------------------------------------------
 */

csg_value csg_function_lookup(const csg_function_call *call)
{
    if (call->arguments[0].kind != CSG_VALUE_NUMBER || !isfinite(call->arguments[0].as.number))
        return csg_bad_argument(call, 0, "a finite number to look up");
    if (call->arguments[1].kind != CSG_VALUE_VECTOR || call->arguments[1].as.vector->count == 0)
        return csg_bad_argument(call, 1, "a list of [key, value] pairs");
    const csg_vector *table = call->arguments[1].as.vector;
    double key = call->arguments[0].as.number, row[2];
    double below[2] = {-INFINITY, NAN}, above[2] = {INFINITY, NAN};
    if (!csg_value_numbers(table->items[0], 2, row))
        return csg_bad_argument(call, 1, "a list of [key, value] pairs of numbers");
    if (!csg_eval_charge(call->e, table->count / 4, call->where))
        return csg_value_undef();
    for (uint32_t i = 0; i < table->count; i++) {
        if (!csg_value_numbers(table->items[i], 2, row))
            continue;
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

static bool is_enough(const searching *s, const csg_list *found)
{
    return s->returns > 0 && (double)found->count >= s->returns;
}

static bool matches(const searching *s, csg_value what, csg_value element)
{
    if (s->column == 0 && csg_value_equal(s->call->e, what, element, s->call->where))
        return true;
    return element.kind == CSG_VALUE_VECTOR && s->column < element.as.vector->count &&
           csg_value_equal(s->call->e, what, element.as.vector->items[s->column], s->call->where);
}

static void find_value(const searching *s, csg_value what, csg_list *found)
{
    enum { ELEMENTS_A_STEP = 8 };
    if (s->where.kind != CSG_VALUE_VECTOR)
        return;
    const csg_vector *table = s->where.as.vector;
    csg_eval_charge(s->call->e, table->count / ELEMENTS_A_STEP + 1, s->call->where);
    for (uint32_t i = 0; i < table->count && !s->call->e->stop && !is_enough(s, found); i++)
        if (matches(s, what, table->items[i]))
            csg_list_push(s->call->e, found, csg_value_number(i), s->call->where);
}

static void find_in_string(const searching *s, const char *character, size_t length,
                           csg_list *found)
{
    enum { BYTES_A_STEP = 16 };
    const csg_string *string = s->where.as.string;
    double index = 0;
    csg_eval_charge(s->call->e, string->length / BYTES_A_STEP + 1, s->call->where);
    for (size_t at = 0; at < string->length && !s->call->e->stop && !is_enough(s, found); index++) {
        size_t step = csg_utf8_length(string->text + at, string->length - at);
        step = step ? step : 1;
        if (step == length && memcmp(string->text + at, character, length) == 0)
            csg_list_push(s->call->e, found, csg_value_number(index), s->call->where);
        at += step;
    }
}

/* Does the value's text begin with this character? */
static bool begins_with(csg_eval *e, csg_value value, const char *character, size_t length)
{
    if (value.kind == CSG_VALUE_STRING)
        return value.as.string->length >= length &&
               memcmp(value.as.string->text, character, length) == 0;
    csg_text text = csg_eval_text(e);
    csg_text_put_value(&text, value, false, &e->program->symbols);
    bool begins = text.length >= length && memcmp(text.data, character, length) == 0;
    csg_text_reset(&text);
    return begins;
}

/* False: a row of the table is too short (reported), the search has no result. */
static bool find_in_rows(const searching *s, const char *character, size_t length, csg_list *found)
{
    csg_eval *e = s->call->e;
    const csg_vector *table = s->where.as.vector;
    for (uint32_t i = 0; i < table->count && !is_enough(s, found); i++) {
        const csg_value row = table->items[i];
        if (!csg_eval_charge(e, 1, s->call->where))
            return false;
        if (row.kind != CSG_VALUE_VECTOR || row.as.vector->count <= s->column) {
            csg_eval_report(
                e, CSG_DIAG_BAD_ARGUMENT, s->call->syntax[1].value->whole,
                "a list of strings is searched with a list: search([\"name\"], names)",
                "a string searches in rows of at least %u elements, element %u is none; nothing "
                "is found",
                s->column + 1, i);
            return false;
        }
        if (begins_with(e, row.as.vector->items[s->column], character, length))
            csg_list_push(e, found, csg_value_number(i), s->call->where);
    }
    return true;
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
    bool usable = true;
    for (size_t at = 0; at < what->length && usable && !s->call->e->stop;) {
        csg_list found = {0};
        const char *character = what->text + at;
        size_t step = csg_utf8_length(character, what->length - at);
        step = step ? step : 1;
        if (s->where.kind == CSG_VALUE_STRING)
            find_in_string(s, character, step, &found);
        else if (s->where.kind == CSG_VALUE_VECTOR)
            usable = find_in_rows(s, character, step, &found);
        add_matches(s, &found, &out, false);
        at += step;
    }
    csg_value made = csg_list_finish(s->call->e, &out);
    if (usable || s->call->e->stop)
        return made;
    csg_value_release(&s->call->e->heap, made);
    return csg_list_finish(s->call->e, &(csg_list){0});
}

static double whole_number(const csg_function_call *call, uint32_t index, double otherwise)
{
    if (index >= call->count)
        return otherwise;
    if (call->arguments[index].kind != CSG_VALUE_NUMBER || !(call->arguments[index].as.number > 0))
        return 0;
    return fmin(trunc(call->arguments[index].as.number), 1e9);
}

csg_value csg_function_search(const csg_function_call *call)
{
    csg_value what = call->arguments[0];
    searching s = {call, call->arguments[1], whole_number(call, 2, 1),
                   (uint32_t)whole_number(call, 3, 0)};
    csg_list found = {0}, out = {0};
    if (what.kind == CSG_VALUE_STRING)
        return search_characters(&s, what.as.string);
    if (what.kind == CSG_VALUE_NUMBER) {
        find_value(&s, what, &found);
        return csg_list_finish(call->e, &found);
    }
    if (what.kind != CSG_VALUE_VECTOR)
        return csg_bad_argument(call, 0, "a number, a string or a list to search for");
    if (s.where.kind != CSG_VALUE_VECTOR)
        csg_bad_argument(call, 1, "a list to search in");
    for (uint32_t i = 0; i < what.as.vector->count && !call->e->stop; i++) {
        found = (csg_list){0};
        find_value(&s, what.as.vector->items[i], &found);
        add_matches(&s, &found, &out, true);
    }
    return csg_list_finish(call->e, &out);
}
