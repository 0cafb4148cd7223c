/* SPDX-License-Identifier: MIT
 * Which assignments are parameters, and what stands around them; see customizer.h.
 *
 * The lexer drops comments, so the text itself is looked at: once for its lines, the sections and
 * the line of the first brace, and then at the lines of each parameter.
 */
#include "lang/parameters/customizer.h"

#include <math.h>
#include <string.h>

#include "base/scene_codes.h"
#include "lang/evaluate/evaluator.h"
#include "lang/parse/ast_kinds.h"
#include "text/lexer.h"

typedef struct section {
    uint32_t line;
    const char *name;
} section;

typedef struct survey { /* of the scene's own text */
    csg_arena *arena;   /* of the program */
    const char *text;
    uint32_t length;
    uint32_t *lines; /* offsets of their beginnings */
    uint32_t line_count;
    section *sections;
    uint32_t section_count;
    uint32_t brace_line; /* of the first '{', or past the last */
    bool no_memory;
} survey;

/* ---- literals ------------------------------------------------------------------------------ */

static int literal_kind(const csg_expression *x, int depth)
{
    enum { DEEPEST = 64 };
    if (depth > DEEPEST)
        return -1;
    switch ((csg_expression_kind)x->kind) {
    case CSG_EXPRESSION_NUMBER:
    case CSG_EXPRESSION_BOOLEAN:
    case CSG_EXPRESSION_STRING:
    case CSG_EXPRESSION_UNDEF:
        return x->kind;
    case CSG_EXPRESSION_UNARY: {
        int inner = literal_kind(x->as.pair.left, depth + 1);
        return inner < 0 || x->operation != CSG_TOKEN_NOT ? inner : CSG_EXPRESSION_BOOLEAN;
    }
    case CSG_EXPRESSION_VECTOR:
        for (uint32_t i = 0; i < x->as.list.count; i++)
            if (literal_kind(x->as.list.items[i], depth + 1) < 0)
                return -1;
        return x->kind;
    case CSG_EXPRESSION_RANGE:
        return literal_kind(x->as.range.begin, depth + 1) >= 0 &&
                       literal_kind(x->as.range.end, depth + 1) >= 0 &&
                       (!x->as.range.step || literal_kind(x->as.range.step, depth + 1) >= 0)
                   ? x->kind
                   : -1;
    case CSG_EXPRESSION_NAME:
    case CSG_EXPRESSION_BINARY:
    case CSG_EXPRESSION_CONDITIONAL:
    case CSG_EXPRESSION_INDEX:
    case CSG_EXPRESSION_MEMBER:
    case CSG_EXPRESSION_CALL:
    case CSG_EXPRESSION_FUNCTION:
    case CSG_EXPRESSION_LET:
    case CSG_EXPRESSION_ASSERT:
    case CSG_EXPRESSION_ECHO:
    case CSG_EXPRESSION_FOR:
    case CSG_EXPRESSION_FOR_LOOP:
    case CSG_EXPRESSION_IF:
    case CSG_EXPRESSION_EACH:
        break;
    }
    return -1;
}

int csg_customizer_literal_kind(const csg_expression *expression)
{
    return literal_kind(expression, 0);
}

/* A number with its signs; false for any other literal. */
static bool number_of(const csg_expression *x, double *out)
{
    double sign = 1;
    for (; x->kind == CSG_EXPRESSION_UNARY; x = x->as.pair.left) {
        if (x->operation == CSG_TOKEN_NOT)
            return false;
        sign = x->operation == CSG_TOKEN_MINUS ? -sign : sign;
    }
    *out = x->kind == CSG_EXPRESSION_NUMBER ? sign * x->as.number : 0;
    return x->kind == CSG_EXPRESSION_NUMBER;
}

/* true, !false, !0, !"text": as the language counts truth. */
static bool boolean_of(const csg_expression *x)
{
    bool flip = false;
    for (; x->kind == CSG_EXPRESSION_UNARY; x = x->as.pair.left)
        flip = flip != (x->operation == CSG_TOKEN_NOT);
    bool truth = x->kind == CSG_EXPRESSION_BOOLEAN  ? x->as.boolean
                 : x->kind == CSG_EXPRESSION_NUMBER ? x->as.number != 0
                 : x->kind == CSG_EXPRESSION_STRING ? x->as.string.length > 0
                 : x->kind == CSG_EXPRESSION_VECTOR ? x->as.list.count > 0
                                                    : x->kind == CSG_EXPRESSION_RANGE;
    return truth != flip;
}

/* The kinds of values that a parameter may have; the rest is no parameter. */
static bool take_literal(const csg_expression *x, csg_arena *arena, csgm_param_value *out,
                         bool *no_memory)
{
    int kind = csg_customizer_literal_kind(x);
    size_t count = kind == CSG_EXPRESSION_VECTOR ? x->as.list.count : 1;
    if (kind == CSG_EXPRESSION_STRING) {
        *out = (csgm_param_value){.kind = CSGM_PARAM_STRING};
        if (x->kind != CSG_EXPRESSION_STRING) /* -"text" */
            return false;
        out->text = csg_arena_strndup(arena, x->as.string.text, x->as.string.length);
        *no_memory = *no_memory || !out->text;
        return out->text != NULL;
    }
    bool numeric = kind == CSG_EXPRESSION_NUMBER || kind == CSG_EXPRESSION_BOOLEAN ||
                   (x->kind == CSG_EXPRESSION_VECTOR && count > 0);
    double *numbers = numeric ? csg_arena_calloc(arena, count, sizeof *numbers) : NULL;
    *no_memory = *no_memory || (numeric && !numbers);
    if (!numbers)
        return false;
    *out = (csgm_param_value){kind == CSG_EXPRESSION_VECTOR   ? CSGM_PARAM_VECTOR
                              : kind == CSG_EXPRESSION_NUMBER ? CSGM_PARAM_NUMBER
                                                              : CSGM_PARAM_BOOLEAN,
                              numbers, count, NULL};
    if (kind == CSG_EXPRESSION_BOOLEAN)
        numbers[0] = boolean_of(x);
    else if (kind == CSG_EXPRESSION_NUMBER)
        return number_of(x, numbers);
    for (size_t i = 0; kind == CSG_EXPRESSION_VECTOR && i < count; i++)
        if (!number_of(x->as.list.items[i], &numbers[i]))
            return false;
    return true;
}

/* ---- the text ------------------------------------------------------------------------------- */

static void add_line(survey *s, uint32_t begin)
{
    uint32_t *place = csg_arena_push(s->arena, (void **)&s->lines, &s->line_count, sizeof *place);
    s->no_memory = s->no_memory || !place;
    if (place)
        *place = begin;
}

/* All [names] of a comment on one line, joined by '-'. A comment without any begins nothing. */
static void add_section(survey *s, const char *text, size_t length)
{
    char *name = csg_arena_alloc(s->arena, length + 1);
    size_t used = 0, open = SIZE_MAX;
    bool any = false;
    for (size_t i = 0; name && i < length; i++) {
        if (text[i] == '[' && open == SIZE_MAX)
            open = i + 1;
        if (text[i] != ']' || open == SIZE_MAX)
            continue;
        if (any)
            name[used++] = '-';
        memcpy(name + used, text + open, i - open);
        used += i - open;
        open = SIZE_MAX;
        any = true;
    }
    section *place =
        any ? csg_arena_push(s->arena, (void **)&s->sections, &s->section_count, sizeof *place)
            : NULL;
    s->no_memory = s->no_memory || !name || (any && !place);
    if (!place)
        return;
    name[used] = '\0';
    *place = (section){s->line_count, name};
}

/* From behind the opening; returns the offset behind the closing. */
static uint32_t take_block_comment(survey *s, uint32_t at)
{
    uint32_t begin = at, lines = s->line_count;
    for (; at < s->length; at++) {
        if (s->text[at] == '\n')
            add_line(s, at + 1);
        if (s->text[at] == '*' && at + 1 < s->length && s->text[at + 1] == '/')
            break;
    }
    if (at < s->length && s->line_count == lines)
        add_section(s, s->text + begin, at - begin);
    return at + 2 < s->length ? at + 2 : s->length;
}

static uint32_t skip_string(survey *s, uint32_t at)
{
    for (; at < s->length && s->text[at] != '"'; at++) {
        at += s->text[at] == '\\' && at + 1 < s->length;
        if (s->text[at] == '\n')
            add_line(s, at + 1);
    }
    return at < s->length ? at + 1 : at;
}

static void look_through(survey *s)
{
    add_line(s, 0);
    for (uint32_t at = 0; at < s->length && !s->no_memory;) {
        char c = s->text[at++], next = at < s->length ? s->text[at] : '\0';
        if (c == '\n')
            add_line(s, at);
        else if (c == '"')
            at = skip_string(s, at);
        else if (c == '/' && next == '*')
            at = take_block_comment(s, at + 1);
        else if (c == '{' && !s->brace_line)
            s->brace_line = s->line_count;
        else if (c == '/' && next == '/')
            while (at < s->length && s->text[at] != '\n')
                at++;
    }
    if (!s->brace_line)
        s->brace_line = UINT32_MAX;
}

/* 1-based, by halving. */
static uint32_t line_of(const survey *s, uint32_t offset)
{
    uint32_t low = 0, high = s->line_count;
    while (high - low > 1) {
        uint32_t middle = low + (high - low) / 2;
        if (s->lines[middle] <= offset)
            low = middle;
        else
            high = middle;
    }
    return low + 1;
}

/* Without its end; line is 1-based. */
static const char *text_of_line(const survey *s, uint32_t line, size_t *length)
{
    uint32_t begin = s->lines[line - 1];
    uint32_t end = line < s->line_count ? s->lines[line] - 1 : s->length;
    if (end > begin && s->text[end - 1] == '\r')
        end--;
    *length = end - begin;
    return s->text + begin;
}

/* Behind "//" on the line, unless a second statement stands before it. */
static const char *comment_behind(const survey *s, uint32_t line, size_t *length)
{
    const char *text = text_of_line(s, line, length);
    bool quoted = false;
    int semicolons = 0;
    for (size_t i = 0; i + 1 < *length; i++) {
        if (quoted && text[i] == '\\') {
            i++;
            continue;
        }
        quoted = quoted != (text[i] == '"');
        semicolons += !quoted && text[i] == ';';
        if (semicolons > 1)
            return NULL;
        if (!quoted && text[i] == '/' && text[i + 1] == '/') {
            *length -= i + 2;
            return text + i + 2;
        }
    }
    return NULL;
}

/* A line that begins with "//", its blanks and its slashes gone; NULL: none, or no memory. */
static const char *description_above(survey *s, uint32_t line, csg_arena *arena)
{
    size_t length = 0, used = 0;
    const char *text = line > 1 ? text_of_line(s, line - 1, &length) : NULL;
    if (length < 2 || text[0] != '/' || text[1] != '/')
        return NULL;
    char *made = csg_arena_alloc(arena, length);
    s->no_memory = s->no_memory || !made;
    for (size_t i = 2; made && i < length; i++) {
        bool slashes = text[i] == '/' && i + 1 < length && text[i + 1] == '/';
        i += slashes;
        char c = slashes ? ' ' : text[i];
        if (used > 0 || (c != ' ' && c != '\t'))
            made[used++] = c;
    }
    if (made)
        made[used] = '\0';
    return used > 0 ? made : NULL;
}

static const char *section_at(const survey *s, uint32_t line)
{
    const char *name = "Parameters";
    for (uint32_t i = 0; i < s->section_count && s->sections[i].line < line; i++)
        name = s->sections[i].name;
    return name;
}

/* ---- collecting ------------------------------------------------------------------------------ */

static bool is_parameter(const survey *s, const csg_program *program, const csg_assignment *a,
                         uint32_t *line)
{
    if (a->where.source != program->files[0]->source)
        return false;
    *line = line_of(s, a->where.offset);
    return *line < s->brace_line;
}

static void describe(survey *s, const csg_program *program, const csg_assignment *a, uint32_t line,
                     csgm_params *params)
{
    csgm_param made = {.line = line, .minimum = NAN, .maximum = NAN, .step = NAN};
    size_t length;
    if (!take_literal(a->value, &params->arena, &made.initial, &s->no_memory))
        return;
    const char *heading = section_at(s, line);
    const char *name = csg_symbol_name(&program->symbols, a->name);
    const char *hint = comment_behind(s, line, &length);
    made.name = csg_arena_strndup(&params->arena, name, strlen(name));
    made.section = csg_arena_strndup(&params->arena, heading, strlen(heading));
    made.description = description_above(s, line, &params->arena);
    made.value = made.initial;
    bool good = made.name && made.section &&
                (!hint || csg_customizer_take_hint(&params->arena, hint, length, &made));
    csgm_param *place =
        good ? csg_arena_push(&params->arena, (void **)&params->items, &params->count, sizeof made)
             : NULL;
    s->no_memory = s->no_memory || !place;
    if (place)
        *place = made;
}

csgm_status csg_customizer_collect(csg_program *program, csgm_params *params)
{
    const csg_source *source = &program->sources.items[program->files[0]->source];
    const csg_scope *scope = program->files[0]->scope;
    survey s = {.arena = &program->arena, .text = source->text, .length = source->length};
    uint32_t line;
    look_through(&s);
    for (uint32_t i = 0; i < scope->variable_count && !s.no_memory; i++)
        if (is_parameter(&s, program, &scope->variables[i], &line))
            describe(&s, program, &scope->variables[i], line, params);
    return s.no_memory ? csg_context_no_memory(program->context) : CSGM_OK;
}

/* ---- the values that hold -------------------------------------------------------------------- */

static bool value_from(csg_value value, csg_arena *arena, csgm_param_value *out, bool *no_memory)
{
    if (value.kind == CSG_VALUE_STRING) {
        *out = (csgm_param_value){.kind = CSGM_PARAM_STRING};
        out->text = csg_arena_strndup(arena, value.as.string->text, value.as.string->length);
        *no_memory = *no_memory || !out->text;
        return out->text != NULL;
    }
    bool vector = value.kind == CSG_VALUE_VECTOR && value.as.vector->count > 0;
    size_t count = vector ? value.as.vector->count : 1;
    if (!vector && value.kind != CSG_VALUE_NUMBER && value.kind != CSG_VALUE_BOOLEAN)
        return false;
    double *numbers = csg_arena_calloc(arena, count, sizeof *numbers);
    *no_memory = *no_memory || !numbers;
    for (size_t i = 0; numbers && i < count; i++) {
        csg_value item = vector ? value.as.vector->items[i] : value;
        if (vector && item.kind != CSG_VALUE_NUMBER)
            return false;
        numbers[i] = item.kind == CSG_VALUE_NUMBER ? item.as.number : item.as.boolean;
    }
    *out = (csgm_param_value){vector                           ? CSGM_PARAM_VECTOR
                              : value.kind == CSG_VALUE_NUMBER ? CSGM_PARAM_NUMBER
                                                               : CSGM_PARAM_BOOLEAN,
                              numbers, count, NULL};
    return numbers != NULL;
}

/* An override that computes may use any other variable: so evaluate them all. */
static csgm_status evaluate_values(csg_program *program, csgm_params *params)
{
    csg_eval e;
    bool no_memory = false;
    csgm_status status = csg_eval_init(&e, program);
    csg_frame *frame = status == CSGM_OK ? csg_eval_file_frame(&e, program->files[0]) : NULL;
    for (uint32_t i = 0; frame && !e.stop && i < params->count; i++) {
        csgm_param *param = &params->items[i];
        csg_symbol name = csg_symbol_intern(&program->symbols, param->name, strlen(param->name));
        const csg_value *value = param->is_overridden ? csg_eval_lookup(&e, name, frame) : NULL;
        if (value && !value_from(*value, &params->arena, &param->value, &no_memory) && !no_memory)
            csg_diag_plain(&program->context->diags, CSG_DIAG_PARAMETER_KIND, NULL, NULL,
                           "'%.60s' is set to what no parameter can be: %s", param->name,
                           csg_value_kind_name(*value));
    }
    status = status == CSGM_OK ? e.status : status;
    csg_eval_reset(&e);
    return status == CSGM_OK && no_memory ? csg_context_no_memory(program->context) : status;
}

csgm_status csg_customizer_take_values(csg_program *program, csgm_params *params)
{
    const csg_scope *scope = program->files[0]->scope;
    bool no_memory = false, computed = false;
    uint32_t next = 0;
    for (uint32_t i = 0; i < scope->variable_count && next < params->count; i++) {
        const csg_assignment *a = &scope->variables[i];
        csgm_param *param = &params->items[next];
        if (strcmp(csg_symbol_name(&program->symbols, a->name), param->name) != 0)
            continue; /* both are in the order of the text */
        next++;
        param->is_overridden = a->where.source != program->files[0]->source;
        if (param->is_overridden &&
            !take_literal(a->value, &params->arena, &param->value, &no_memory))
            computed = true;
    }
    if (no_memory)
        return csg_context_no_memory(program->context);
    return computed ? evaluate_values(program, params) : CSGM_OK;
}
