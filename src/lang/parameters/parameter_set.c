/* SPDX-License-Identifier: MIT
 * JSON events -> the members of one set -> assignments; see parameter_set.h.
 *
 * A value is text, whatever its type: what the scene assigns says how it is read, as in OpenSCAD. A
 * string takes it as it stands, a boolean true or false, anything else a literal of its own kind.
 * JSON's own numbers, booleans and arrays are taken too.
 */
#include "lang/parameters/parameter_set.h"

#include <stdio.h>
#include <string.h>

#include "base/mesh_codes.h"
#include "base/scene_codes.h"
#include "lang/parameters/assignments.h"
#include "lang/parameters/customizer.h"
#include "lang/parse/ast_kinds.h"
#include "lang/parse/parser.h"
#include "text/json.h"

enum {
    DEEPEST = 32,           /* brackets in the file; sets need 3, a matrix in one 5 */
    LARGEST = 16 << 20,     /* bytes of the file */
    MOST_MEMBERS = 1 << 20, /* of one set */
    ROOT = 1,
    SETS = 2,
    SET = 3 /* depths */
};

typedef struct member {
    const char *name, *text;
    csg_json_kind kind; /* ARRAY: the text is a vector of the language; OBJECT: not usable */
} member;

typedef struct reader {
    csg_program *program;
    const char *wanted;
    int depth;
    bool in_sets, in_wanted; /* the innermost key of ROOT, of SETS */
    bool found, has_sets;
    bool no_memory, too_deep, too_many, not_sets;
    const char **names; /* of all sets */
    uint32_t name_count;
    member *members;
    uint32_t member_count;
    const char *key; /* in the wanted set */
    char *array;     /* the array being put together, in the language's words */
    size_t array_length, array_capacity;
} reader;

static bool fail_memory(reader *r)
{
    r->no_memory = true;
    return false;
}

/* ---- reading --------------------------------------------------------------------------- */

static bool append(reader *r, const char *text, size_t length)
{
    if (!csg_memory_reserve(&r->program->context->memory, (void **)&r->array, &r->array_capacity,
                            r->array_length + length + 1, 1))
        return fail_memory(r);
    memcpy(r->array + r->array_length, text, length);
    r->array_length += length;
    return true;
}

/* A string in the language's quotes. */
static bool append_string(reader *r, const char *text, size_t length)
{
    bool good = append(r, "\"", 1);
    for (size_t i = 0; i < length && good; i++) {
        const char *escaped = text[i] == '"'    ? "\\\""
                              : text[i] == '\\' ? "\\\\"
                              : text[i] == '\n' ? "\\n"
                              : text[i] == '\t' ? "\\t"
                              : text[i] == '\r' ? "\\r"
                                                : NULL;
        good = escaped ? append(r, escaped, 2) : append(r, &text[i], 1);
    }
    return good && append(r, "\"", 1);
}

static bool add_member(reader *r, csg_json_kind kind, const char *text, size_t length)
{
    csg_arena *arena = &r->program->arena;
    if (r->member_count >= MOST_MEMBERS) {
        r->too_many = true;
        return false;
    }
    const char *copy = csg_arena_strndup(arena, text, length);
    member *place =
        copy ? csg_arena_push(arena, (void **)&r->members, &r->member_count, sizeof *place) : NULL;
    if (!place)
        return fail_memory(r);
    *place = (member){r->key, copy, kind};
    return true;
}

static bool open_bracket(reader *r, csg_json_kind kind)
{
    if (r->depth >= DEEPEST) {
        r->too_deep = true;
        return false;
    }
    bool is_object = kind == CSG_JSON_OBJECT;
    r->depth++;
    if (r->depth == ROOT || (r->depth == SETS && r->in_sets) || (r->depth == SET && r->in_sets)) {
        r->not_sets = !is_object;
        r->has_sets = r->has_sets || r->depth == SETS;
        return is_object;
    }
    if (!r->in_wanted)
        return true;
    if (r->depth == SET + 1 && is_object)
        return add_member(r, CSG_JSON_OBJECT, "", 0);
    return append(r, "[", 1);
}

static bool close_bracket(reader *r)
{
    r->depth--;
    if (r->depth == ROOT)
        r->in_sets = false;
    if (r->depth == SETS)
        r->in_wanted = false;
    if (!r->in_wanted || r->depth < SET || !r->array_length)
        return true;
    if (r->array[r->array_length - 1] == ' ')
        r->array_length -= 2; /* the comma after the last element */
    if (!append(r, "]", 1))
        return false;
    if (r->depth > SET)
        return append(r, ", ", 2);
    size_t length = r->array_length;
    r->array_length = 0;
    return add_member(r, CSG_JSON_ARRAY, r->array, length);
}

static bool take_key(reader *r, const char *text, size_t length)
{
    csg_arena *arena = &r->program->arena;
    const char *copy = csg_arena_strndup(arena, text, length);
    if (!copy)
        return fail_memory(r);
    if (r->depth == ROOT)
        r->in_sets = strcmp(copy, "parameterSets") == 0;
    if (r->depth == SET)
        r->key = copy;
    if (r->depth != SETS || !r->in_sets)
        return true;
    r->in_wanted = strcmp(copy, r->wanted) == 0;
    r->found = r->found || r->in_wanted;
    const char **place =
        csg_arena_push(arena, (void **)&r->names, &r->name_count, sizeof *r->names);
    if (!place)
        return fail_memory(r);
    *place = copy;
    return true;
}

static bool take_event(void *user, csg_json_kind kind, const char *text, size_t length)
{
    reader *r = user;
    if (kind == CSG_JSON_OBJECT || kind == CSG_JSON_ARRAY)
        return open_bracket(r, kind);
    if (kind == CSG_JSON_END)
        return close_bracket(r);
    if (kind == CSG_JSON_KEY)
        return take_key(r, text, length);
    if (r->depth < SET && r->in_sets) { /* "parameterSets": 5 */
        r->not_sets = true;
        return false;
    }
    if (!r->in_wanted)
        return true;
    if (r->depth == SET)
        return add_member(r, kind, text, length);
    if (!r->array_length) /* in an object, which is refused as a whole */
        return true;
    return (kind == CSG_JSON_STRING ? append_string(r, text, length) : append(r, text, length)) &&
           append(r, ", ", 2);
}

/* ---- findings -------------------------------------------------------------------------- */

static csgm_status refuse_file(reader *r, const csg_source *source, uint32_t index,
                               csg_json_outcome outcome, const csg_json_error *error)
{
    csg_sources *sources = &r->program->sources;
    csg_diag_sink *diags = &r->program->context->diags;
    if (outcome == CSG_JSON_NO_MEMORY || r->no_memory)
        return csg_context_no_memory(r->program->context);
    if (outcome == CSG_JSON_BROKEN) {
        uint32_t offset = error->offset < source->length ? (uint32_t)error->offset : source->length;
        csg_source_report(sources, CSG_DIAG_PARAMETER_FILE, (csg_span){index, offset, 1}, NULL,
                          "not JSON: %s", error->text);
        return CSGM_ERR_SYNTAX;
    }
    if (r->too_deep || r->too_many) {
        csg_diag_plain(diags, CSG_DIAG_PARAMETER_FILE, source->name, NULL,
                       r->too_deep ? "more than %d brackets are nested"
                                   : "a set of more than %d parameters",
                       r->too_deep ? (int)DEEPEST : (int)MOST_MEMBERS);
        return CSGM_ERR_LIMIT;
    }
    csg_diag_plain(diags, CSG_DIAG_PARAMETER_FILE, source->name,
                   "it is written {\"parameterSets\": {\"small\": {\"radius\": \"5\"}}}",
                   "the file holds no parameter sets");
    return CSGM_ERR_SYNTAX;
}

/* "did you mean 'x'? " and the names there are. */
static csgm_status refuse_set(const reader *r, const char *file)
{
    enum { MOST = 10 };
    char hint[400];
    const char *nearest = NULL;
    size_t length = strlen(r->wanted);
    uint32_t least = length <= 2 ? 2 : length <= 5 ? 3 : 4; /* one more than is near */
    for (uint32_t i = 0; i < r->name_count; i++) {
        uint32_t distance = csg_edit_distance(r->wanted, r->names[i], least - 1);
        if (distance < least) {
            least = distance;
            nearest = r->names[i];
        }
    }
    int used = snprintf(hint, sizeof hint, "%s%.60s%sit has ", nearest ? "did you mean '" : "",
                        nearest ? nearest : "", nearest ? "'? " : "");
    for (uint32_t i = 0; i < r->name_count && i < MOST && used < 300; i++)
        used += snprintf(hint + used, sizeof hint - (size_t)used, "%s'%.60s'", i ? ", " : "",
                         r->names[i]);
    if (r->name_count > MOST || used >= 300)
        snprintf(hint + used, sizeof hint - (size_t)used, " and more, %u in all", r->name_count);
    if (!r->name_count)
        snprintf(hint, sizeof hint, "it has none");
    csg_diag_plain(&r->program->context->diags, CSG_DIAG_UNKNOWN_PARAMETER_SET, file, hint,
                   "there is no parameter set '%.60s'", r->wanted);
    return CSGM_ERR_SCENE;
}

static void warn_unknown(const reader *r, const char *file, const char *name)
{
    char hint[120];
    csg_diag_plain(&r->program->context->diags, CSG_DIAG_UNKNOWN_PARAMETER, file,
                   csg_assignment_suggest(r->program, name, hint, sizeof hint),
                   "the scene assigns no variable '%.60s' of the parameter set '%.60s'", name,
                   r->wanted);
}

static void warn_computed(const reader *r, const char *file, const member *m)
{
    csg_diag_plain(&r->program->context->diags, CSG_DIAG_PARAMETER_KIND, file,
                   "-D replaces what is computed, too",
                   "'%.60s' of the parameter set '%.60s' is ignored: the scene computes its value",
                   m->name, r->wanted);
}

static void warn_kind(const reader *r, const char *file, const member *m, const char *wanted)
{
    csg_diag_plain(&r->program->context->diags, CSG_DIAG_PARAMETER_KIND, file, NULL,
                   "'%.60s' of the parameter set '%.60s' is ignored: the scene wants %s, not "
                   "'%.60s'",
                   m->name, r->wanted, wanted, m->text);
}

/* ---- applying -------------------------------------------------------------------------- */

static csg_expression *make_literal(csg_program *program, csg_expression literal)
{
    csg_expression *made = csg_arena_alloc(&program->arena, sizeof *made);
    literal.where = literal.whole = csg_span_nowhere();
    if (made)
        *made = literal;
    else
        csg_context_no_memory(program->context);
    return made;
}

/* NULL: not a boolean, or no memory (reported). */
static csg_expression *make_boolean(csg_program *program, const char *text)
{
    bool truth = strcmp(text, "true") == 0 || strcmp(text, "1") == 0;
    if (!truth && strcmp(text, "false") != 0 && strcmp(text, "0") != 0)
        return NULL;
    return make_literal(program,
                        (csg_expression){.kind = CSG_EXPRESSION_BOOLEAN, .as.boolean = truth});
}

/* NULL after a reported error, or when it is no literal of this kind. */
static csg_expression *parse_value(const reader *r, const char *file, const member *m, int kind)
{
    csg_program *program = r->program;
    uint32_t source;
    const char *label =
        csg_arena_printf(&program->arena, "%s, '%s' of '%s'", file, m->name, r->wanted);
    if (!label) {
        csg_context_no_memory(program->context);
        return NULL;
    }
    if (csg_source_add(&program->sources, label, m->text, strlen(m->text), &source) != CSGM_OK)
        return NULL;
    csg_expression *value = csg_parse_lone_expression(program, source);
    return value && csg_customizer_literal_kind(value) == kind ? value : NULL;
}

static csgm_status apply_member(const reader *r, const char *file, const member *m)
{
    static const char *const wishes[] = {
        [CSG_EXPRESSION_NUMBER] = "a number", [CSG_EXPRESSION_BOOLEAN] = "true or false",
        [CSG_EXPRESSION_STRING] = "a string", [CSG_EXPRESSION_VECTOR] = "a vector",
        [CSG_EXPRESSION_RANGE] = "a range",   [CSG_EXPRESSION_UNDEF] = "undef"};
    csg_program *program = r->program;
    csg_symbol name = csg_symbol_intern(&program->symbols, m->name, strlen(m->name));
    if (!name)
        return csg_context_no_memory(program->context);
    csg_assignment *known = csg_assignment_find(program, name);
    if (!known) {
        warn_unknown(r, file, m->name);
        return CSGM_OK;
    }
    int kind = csg_customizer_literal_kind(known->value);
    uint32_t errors = program->context->diags.errors;
    csg_expression *value = NULL;
    bool plain = m->kind != CSG_JSON_ARRAY && m->kind != CSG_JSON_OBJECT;
    if (kind == CSG_EXPRESSION_STRING && plain)
        value = make_literal(program, (csg_expression){.kind = CSG_EXPRESSION_STRING,
                                                       .as.string = {m->text, strlen(m->text)}});
    else if (kind == CSG_EXPRESSION_BOOLEAN && plain)
        value = make_boolean(program, m->text);
    else if (kind >= 0 && kind != CSG_EXPRESSION_STRING && kind != CSG_EXPRESSION_BOOLEAN &&
             m->kind != CSG_JSON_OBJECT)
        value = parse_value(r, file, m, kind);
    if (value)
        csg_assignment_replace(program, name, value);
    else if (program->context->diags.errors > errors)
        return CSGM_ERR_SYNTAX;
    else if (kind < 0)
        warn_computed(r, file, m);
    else
        warn_kind(r, file, m, wishes[kind]);
    return CSGM_OK;
}

static csgm_status read_file(csg_program *program, const char *file, uint32_t *index)
{
    csg_source_request request = {file, csg_span_nowhere(), false, NULL};
    csgm_status status = csg_source_read(&program->sources, &request, index);
    if (status != CSGM_OK)
        return status;
    const csg_source *source = &program->sources.items[*index];
    if (source->length > LARGEST) {
        csg_diag_plain(&program->context->diags, CSG_DIAG_FILE_TOO_LARGE, file, NULL,
                       "a parameter file of more than 16 MiB");
        return CSGM_ERR_LIMIT;
    }
    const char **place = csg_arena_push(&program->arena, (void **)&program->dependencies,
                                        &program->dependency_count, sizeof *place);
    if (!place)
        return csg_context_no_memory(program->context);
    *place = source->name;
    return CSGM_OK;
}

csgm_status csg_parameter_set_apply(csg_program *program, const char *file, const char *name)
{
    reader r = {.program = program, .wanted = name};
    csg_json_error error;
    uint32_t index;
    if (!csg_json_available()) {
        csg_diag_plain(&program->context->diags, CSG_DIAG_NO_LIBRARY, file,
                       "install nlohmann-json and build csgmesh again",
                       "this csgmesh was built without the library that reads parameter sets");
        return CSGM_ERR_UNSUPPORTED;
    }
    csgm_status status = read_file(program, file, &index);
    if (status != CSGM_OK)
        return status;
    const csg_source source = program->sources.items[index];
    csg_json_outcome outcome = csg_json_read(source.text, source.length, take_event, &r, &error);
    csg_memory_release(&program->context->memory, r.array, r.array_capacity);
    if (outcome != CSG_JSON_DONE || !r.has_sets)
        return refuse_file(&r, &source, index, outcome, &error);
    if (!r.found)
        return refuse_set(&r, file);
    for (uint32_t i = 0; i < r.member_count; i++) {
        csgm_status one = apply_member(&r, file, &r.members[i]);
        status = status == CSGM_OK ? one : status;
    }
    return status;
}
