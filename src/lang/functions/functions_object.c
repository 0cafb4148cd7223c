/* SPDX-License-Identifier: MIT
 * Objects: values by names (CSG_VALUE_RECORD), made by object(), by JSON files, and by functions
 * that have several things to tell. As in OpenSCAD's snapshots, but for functions in them that take
 * `this`.
 */
#include <string.h>

#include "lang/functions/functions.h"

/* Puts an entry (consumed) in its place; a list of keys and values in turn. */
static void set_entry(csg_eval *e, csg_list *list, csg_value key, csg_value value, csg_span where)
{
    enum { KEYS_A_STEP = 16 };
    const csg_string *name = key.as.string;
    size_t i = 0;
    csg_eval_charge(e, list->count / 2 / KEYS_A_STEP, where);
    for (; i < list->count; i += 2) {
        const csg_string *known = list->items[i].as.string;
        if (known->length == name->length && memcmp(known->text, name->text, name->length) == 0)
            break;
    }
    if (i < list->count) {
        csg_value_release(&e->heap, key);
        csg_value_release(&e->heap, list->items[i + 1]);
        list->items[i + 1] = value;
        return;
    }
    csg_list_reserve(e, list, 2, where); /* both or none */
    csg_list_push(e, list, key, where);
    csg_list_push(e, list, value, where);
}

static void delete_entry(csg_eval *e, csg_list *list, const csg_string *name)
{
    for (size_t i = 0; i < list->count; i += 2) {
        const csg_string *known = list->items[i].as.string;
        if (known->length != name->length || memcmp(known->text, name->text, name->length) != 0)
            continue;
        csg_value_release(&e->heap, list->items[i]);
        csg_value_release(&e->heap, list->items[i + 1]);
        memmove(list->items + i, list->items + i + 2, (list->count - i - 2) * sizeof *list->items);
        list->count -= 2;
        return;
    }
}

csg_value csg_record_finish(csg_eval *e, csg_list *list)
{
    csg_value made = csg_list_finish(e, list);
    if (made.kind != CSG_VALUE_VECTOR)
        return made;
    made.kind = CSG_VALUE_RECORD;
    made.as.vector->object.kind = CSG_VALUE_RECORD;
    return made;
}

void csg_record_put(csg_eval *e, csg_list *list, const char *key, csg_value value, csg_span where)
{
    csg_value name = csg_eval_string(e, key, strlen(key));
    if (e->stop)
        csg_value_release(&e->heap, value);
    else
        set_entry(e, list, name, value, where);
}

static void take_all(const csg_function_call *call, csg_list *list, const csg_vector *entries)
{
    for (uint32_t i = 0; i + 1 < entries->count && !call->e->stop; i += 2)
        set_entry(call->e, list, csg_value_retain(entries->items[i]),
                  csg_value_retain(entries->items[i + 1]), call->where);
}

/* [key, value] sets, [key] deletes; false: it is neither. */
static bool take_entry(const csg_function_call *call, csg_list *list, csg_value entry)
{
    const csg_vector *pair = entry.kind == CSG_VALUE_VECTOR ? entry.as.vector : NULL;
    if (!pair || pair->count < 1 || pair->count > 2 || pair->items[0].kind != CSG_VALUE_STRING)
        return false;
    if (pair->count == 1)
        delete_entry(call->e, list, pair->items[0].as.string);
    else
        set_entry(call->e, list, csg_value_retain(pair->items[0]), csg_value_retain(pair->items[1]),
                  call->where);
    return true;
}

/* An argument without a name; false: it is neither an object nor a list of entries. */
static bool take_unnamed(const csg_function_call *call, csg_list *list, csg_value value)
{
    if (value.kind == CSG_VALUE_RECORD) {
        take_all(call, list, value.as.vector);
        return true;
    }
    if (value.kind != CSG_VALUE_VECTOR)
        return false;
    for (uint32_t i = 0; i < value.as.vector->count && !call->e->stop; i++)
        if (!take_entry(call, list, value.as.vector->items[i]))
            return false;
    return true;
}

csg_value csg_function_object(const csg_function_call *call)
{
    csg_eval *e = call->e;
    csg_list list = {0};
    uint32_t i = 0;
    for (bool good = true; i < call->count && good && !e->stop; i += good) {
        csg_symbol name = call->syntax[i].name;
        if (name)
            csg_record_put(e, &list, csg_symbol_name(&e->program->symbols, name),
                           csg_value_retain(call->arguments[i]), call->where);
        else
            good = take_unnamed(call, &list, call->arguments[i]);
    }
    csg_value made = csg_record_finish(e, &list);
    if (i == call->count || e->stop)
        return made;
    csg_value_release(&e->heap, made);
    return csg_bad_argument(call, i,
                            "name = value, an object, or a list of [name, value] and [name]");
}

csg_value csg_function_has_key(const csg_function_call *call)
{
    csg_value record = call->arguments[0], key = call->arguments[1];
    if (record.kind != CSG_VALUE_RECORD)
        return csg_bad_argument(call, 0, "an object");
    if (key.kind != CSG_VALUE_STRING)
        return csg_bad_argument(call, 1, "the name of an entry");
    return csg_value_boolean(csg_record_find(record, key.as.string->text, key.as.string->length) <
                             csg_record_count(record));
}
