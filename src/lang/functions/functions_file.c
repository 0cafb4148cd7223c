/* SPDX-License-Identifier: MIT
 * Values from files: import() of JSON, and what dxf_dim() and dxf_cross() read off drawings.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/scene_codes.h"
#include "lang/evaluate/files.h"
#include "lang/functions/functions.h"
#include "outline/dxf/dxf_measure.h"
#include "text/folders.h"
#include "text/json.h"
#include "text/lexer.h"

enum { BYTES_A_STEP = 64 }; /* that are read */

/* ---- arguments ------------------------------------------------------------------------------- */

/* The argument of this name, or the n-th without one; the call's count: there is none. */
static uint32_t find_argument(const csg_function_call *call, const char *name, uint32_t n)
{
    const csg_symbols *symbols = &call->e->program->symbols;
    uint32_t unnamed = call->count;
    for (uint32_t i = 0, k = 0; i < call->count; i++) {
        csg_symbol symbol = call->syntax[i].name;
        if (symbol && strcmp(csg_symbol_name(symbols, symbol), name) == 0)
            return i;
        if (!symbol && k++ == n)
            unnamed = i;
    }
    return unnamed;
}

/* NULL: none, or no string. */
static const char *text_argument(const csg_function_call *call, const char *name, uint32_t n)
{
    uint32_t i = find_argument(call, name, n);
    return i < call->count && call->arguments[i].kind == CSG_VALUE_STRING
               ? call->arguments[i].as.string->text
               : NULL;
}

/* The bytes of the file that the call names; false, told: there are none. */
static bool read_bytes(const csg_function_call *call, csg_bytes *out)
{
    csg_eval *e = call->e;
    csg_problem problem = {""};
    const char *name = text_argument(call, "file", 0);
    if (!name) {
        csg_bad_argument(call, find_argument(call, "file", 0), "the name of a file");
        return false;
    }
    const char *path = csg_file_find(e, name, call->where);
    if (!path) {
        if (!e->stop)
            csg_eval_report(e, CSG_DIAG_IMPORT_NOT_FOUND, call->where, CSG_FOLDERS_IN_WORDS,
                            "%s(): there is no file '%.200s'%s", call->name, name,
                            csg_eval_is_lenient(e, CSG_DIAG_IMPORT_NOT_FOUND, call->where)
                                ? "; the call counts as undef"
                                : "");
        return false;
    }
    csgm_status status = csg_bytes_read(e->heap.memory, path, out, &problem);
    if (status == CSGM_ERR_MEMORY)
        csg_eval_no_memory(e);
    else if (status != CSGM_OK)
        csg_eval_report(e, CSG_DIAG_BAD_IMPORT, call->where, NULL, "%s(): '%.120s': %s", call->name,
                        path, problem.text);
    if (status != CSGM_OK)
        return false;
    if (csg_eval_charge(e, out->size / BYTES_A_STEP, call->where))
        return true;
    csg_bytes_release(out);
    return false;
}

/* ---- JSON ------------------------------------------------------------------------------------ */

enum { DEEPEST = 64 };

typedef struct json_reader {
    const csg_function_call *call;
    csg_list open[DEEPEST + 1]; /* the brackets that are open; [0] takes the result */
    bool is_object[DEEPEST + 1];
    int depth;
    const char *problem; /* beyond what the library finds */
} json_reader;

static int by_key(const void *left, const void *right)
{
    const csg_string *a = ((const csg_value *)left)->as.string,
                     *b = ((const csg_value *)right)->as.string;
    int order = memcmp(a->text, b->text, a->length < b->length ? a->length : b->length);
    return order ? order : (a->length > b->length) - (a->length < b->length);
}

/* As OpenSCAD has them, entries are in the order of their keys. False: one stands twice. */
static bool sort_entries(csg_list *list)
{
    if (list->count)
        qsort(list->items, list->count / 2, 2 * sizeof *list->items, by_key);
    for (size_t i = 2; i < list->count; i += 2)
        if (by_key(&list->items[i - 2], &list->items[i]) == 0)
            return false;
    return true;
}

static csg_value value_of_word(const char *text)
{
    return *text == 't' || *text == 'f' ? csg_value_boolean(*text == 't') : csg_value_undef();
}

static csg_value value_of_number(const char *text, size_t length)
{
    bool negative = length && *text == '-';
    double value = csg_token_number(text + negative, (uint32_t)(length - negative));
    return csg_value_number(negative ? -value : value);
}

static bool take_json(void *user, csg_json_kind kind, const char *text, size_t length)
{
    json_reader *r = user;
    csg_eval *e = r->call->e;
    csg_value value = csg_value_undef();
    if (!csg_eval_charge(e, 2, r->call->where))
        return false;
    switch (kind) {
    case CSG_JSON_OBJECT:
    case CSG_JSON_ARRAY:
        if (r->depth == DEEPEST)
            r->problem = "brackets are nested too deeply";
        if (r->problem)
            return false;
        r->open[++r->depth] = (csg_list){0};
        r->is_object[r->depth] = kind == CSG_JSON_OBJECT;
        return true;
    case CSG_JSON_END:
        if (r->is_object[r->depth] && !sort_entries(&r->open[r->depth]))
            r->problem = "a name stands twice in an object";
        if (r->problem)
            return false;
        value = r->is_object[r->depth] ? csg_record_finish(e, &r->open[r->depth])
                                       : csg_list_finish(e, &r->open[r->depth]);
        r->depth--;
        break;
    case CSG_JSON_KEY:
    case CSG_JSON_STRING:
        value = csg_eval_string(e, text, length);
        break;
    case CSG_JSON_NUMBER:
        value = value_of_number(text, length);
        break;
    case CSG_JSON_WORD:
        value = value_of_word(text);
        break;
    }
    csg_list_push(e, &r->open[r->depth], value, r->call->where);
    return !e->stop;
}

csg_value csg_function_import(const csg_function_call *call)
{
    csg_eval *e = call->e;
    csg_bytes bytes;
    csg_json_error error = {0, ""};
    json_reader r = {.call = call};
    csg_value result = csg_value_undef();
    if (!read_bytes(call, &bytes))
        return result;
    csg_json_outcome outcome = CSG_JSON_BROKEN;
    if (csg_json_available())
        outcome = csg_json_read(bytes.data, bytes.size, take_json, &r, &error);
    csg_bytes_release(&bytes);
    for (; r.depth > 0; r.depth--) /* what a broken file left open */
        csg_value_release(&e->heap, csg_list_finish(e, &r.open[r.depth]));
    csg_value all = csg_list_finish(e, &r.open[0]);
    if (outcome == CSG_JSON_NO_MEMORY)
        csg_eval_no_memory(e);
    else if (outcome != CSG_JSON_DONE && !e->stop)
        csg_eval_report(e, CSG_DIAG_BAD_IMPORT, call->where, NULL,
                        "%s(): the file is no JSON: %.160s; the call counts as undef", call->name,
                        !csg_json_available() ? "this build has no library for it"
                        : r.problem           ? r.problem
                                              : error.text);
    else if (all.kind == CSG_VALUE_VECTOR && all.as.vector->count == 1)
        result = csg_value_retain(all.as.vector->items[0]);
    csg_value_release(&e->heap, all);
    return result;
}

/* ---- DXF ------------------------------------------------------------------------------------- */

static bool read_drawing(const csg_function_call *call, csg_bytes *bytes, csg_dxf_request *out)
{
    double origin[2] = {0, 0};
    uint32_t at = find_argument(call, "origin", 2), factor = find_argument(call, "scale", 3);
    if (!read_bytes(call, bytes))
        return false;
    *out = (csg_dxf_request){.text = bytes->data,
                             .length = bytes->size,
                             .tolerance = 0.002,
                             .layer = text_argument(call, "layer", 1)};
    if (at < call->count && csg_value_numbers(call->arguments[at], 2, origin))
        out->origin = (csg_vec2){origin[0], origin[1]};
    if (factor < call->count && call->arguments[factor].kind == CSG_VALUE_NUMBER &&
        isfinite(call->arguments[factor].as.number))
        out->scale = call->arguments[factor].as.number;
    return true;
}

static void tell_failure(const csg_function_call *call, csgm_status status,
                         const csg_problem *problem)
{
    if (status == CSGM_ERR_MEMORY)
        csg_eval_no_memory(call->e);
    else
        csg_eval_report(call->e, CSG_DIAG_BAD_ARGUMENT, call->where, NULL,
                        "%s(): %s; the call counts as undef", call->name, problem->text);
}

csg_value csg_function_dxf_dim(const csg_function_call *call)
{
    csg_bytes bytes;
    csg_dxf_request request;
    csg_problem problem = {""};
    double value = 0;
    if (!read_drawing(call, &bytes, &request))
        return csg_value_undef();
    csgm_status status = csg_dxf_dimension(call->e->heap.memory, &request,
                                           text_argument(call, "name", 4), &value, &problem);
    csg_bytes_release(&bytes);
    if (status == CSGM_OK)
        return csg_value_number(value);
    tell_failure(call, status, &problem);
    return csg_value_undef();
}

csg_value csg_function_dxf_cross(const csg_function_call *call)
{
    csg_eval *e = call->e;
    csg_bytes bytes;
    csg_dxf_request request;
    csg_problem problem = {""};
    csg_vec2 at = {0, 0};
    if (!read_drawing(call, &bytes, &request))
        return csg_value_undef();
    csgm_status status = csg_dxf_crossing(e->heap.memory, &request, &at, &problem);
    csg_bytes_release(&bytes);
    if (status != CSGM_OK) {
        tell_failure(call, status, &problem);
        return csg_value_undef();
    }
    csg_list list = {0};
    csg_list_push(e, &list, csg_value_number(at.x), call->where);
    csg_list_push(e, &list, csg_value_number(at.y), call->where);
    return csg_list_finish(e, &list);
}
