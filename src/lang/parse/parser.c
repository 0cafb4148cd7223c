/* SPDX-License-Identifier: MIT
 * Statements and scopes, and the small steps that all of the parser shares. After an error the
 * rest of the statement is skipped: to a ';' or past a block at the same depth of braces, or up to
 * a keyword that begins a statement at the start of a line.
 */
#include "lang/parse/parser.h"

#include <stdio.h>
#include <string.h>

#include "base/clock.h"
#include "base/mesh_codes.h"
#include "base/scene_codes.h"
#include "lang/parse/hints.h"
#include "lang/parse/loader.h"
#include "lang/parse/parser_private.h"

/* ---- steps over tokens ------------------------------------------------------------------- */

void csg_parser_no_memory(csg_parser *parser)
{
    if (parser->status == CSGM_OK)
        parser->status = csg_context_no_memory(parser->program->context);
    parser->stop = true;
    parser->at = parser->tokens.count - 1;
}

void *csg_parser_alloc(csg_parser *parser, size_t size_bytes)
{
    void *made = csg_arena_calloc(&parser->program->arena, 1, size_bytes);
    if (!made)
        csg_parser_no_memory(parser);
    return made;
}

void csg_parser_next(csg_parser *parser)
{
    if (parser->at + 1 < parser->tokens.count)
        parser->at++;
}

bool csg_parser_accept(csg_parser *parser, csg_token_kind kind)
{
    if (csg_parser_peek(parser) != kind)
        return false;
    csg_parser_next(parser);
    return true;
}

csg_span csg_parser_since(const csg_parser *parser, csg_span from)
{
    const csg_token *last = &parser->tokens.items[parser->at ? parser->at - 1 : 0];
    uint32_t end = last->offset + last->length;
    from.length = end > from.offset ? end - from.offset : from.length;
    return from;
}

csg_symbol csg_parser_symbol(csg_parser *parser, csg_span name)
{
    csg_symbol symbol =
        csg_symbol_intern(&parser->program->symbols, parser->text + name.offset, name.length);
    if (!symbol)
        csg_parser_no_memory(parser);
    return symbol;
}

static bool describe_token(const csg_parser *parser, char *out, size_t size)
{
    const csg_token *token = csg_parser_token(parser);
    bool bare =
        token->kind == CSG_TOKEN_END || token->kind == CSG_TOKEN_STRING || token->length > 40;
    if (bare)
        snprintf(out, size, "%s", csg_token_kind_name(token->kind));
    else
        snprintf(out, size, "'%.*s'", (int)token->length, parser->text + token->offset);
    return token->kind != CSG_TOKEN_BAD; /* the lexer has told about that one */
}

static void report_unexpected(csg_parser *parser, csg_diag_code code, csg_token_kind wanted,
                              const char *expected, const char *hint)
{
    char found[80];
    if (!describe_token(parser, found, sizeof found) || parser->stop)
        return;
    const char *better = csg_parser_hint(parser, wanted);
    csg_source_report(&parser->program->sources, code, csg_parser_span(parser),
                      better ? better : hint, "expected %s but found %s", expected, found);
}

void csg_parser_unexpected(csg_parser *parser, csg_diag_code code, const char *expected,
                           const char *hint)
{
    report_unexpected(parser, code, CSG_TOKEN_END, expected, hint);
}

/* The place right behind the token before the current one. */
static csg_span place_behind(const csg_parser *parser)
{
    const csg_token *last = &parser->tokens.items[parser->at ? parser->at - 1 : 0];
    return (csg_span){parser->source, last->offset + last->length, 1};
}

static bool begins_line(const csg_parser *parser)
{
    const csg_token *token = csg_parser_token(parser);
    if (token->kind == CSG_TOKEN_END)
        return true;
    for (uint32_t i = place_behind(parser).offset; i < token->offset; i++)
        if (parser->text[i] == '\n')
            return true;
    return false;
}

bool csg_parser_expect(csg_parser *parser, csg_token_kind kind, const char *context)
{
    if (csg_parser_accept(parser, kind))
        return true;
    char expected[96];
    snprintf(expected, sizeof expected, "%s %s", csg_token_kind_name(kind), context);
    report_unexpected(parser, CSG_DIAG_EXPECTED, kind, expected, NULL);
    return false;
}

bool csg_parser_close(csg_parser *parser, csg_token_kind kind, csg_span open)
{
    if (csg_parser_accept(parser, kind))
        return true;
    char found[80];
    if (parser->stop || !describe_token(parser, found, sizeof found))
        return false;
    bool cut = begins_line(parser) || csg_parser_peek(parser) == CSG_TOKEN_SEMICOLON;
    csg_span where = cut ? place_behind(parser) : csg_parser_span(parser);
    csg_source_report(&parser->program->sources, CSG_DIAG_UNCLOSED, where,
                      csg_parser_hint(parser, kind), "expected %s but found %s",
                      csg_token_kind_name(kind), found);
    csg_source_note(&parser->program->sources, open, "to close this '%c'",
                    parser->text[open.offset]);
    return false;
}

bool csg_parser_enter(csg_parser *parser)
{
    char here = 0; /* its address tells how much of the stack is used */
    if (parser->stop)
        return false;
    if (parser->depth < parser->program->context->limits.depth &&
        csg_program_has_stack(parser->program, &here)) {
        parser->depth++;
        return true;
    }
    csg_source_report(&parser->program->sources, CSG_DIAG_TOO_DEEP, csg_parser_span(parser),
                      "raise the limit with --max-depth, or nest less",
                      "more than %u levels of nesting", parser->depth);
    parser->stop = true;
    parser->status = CSGM_ERR_LIMIT;
    parser->at = parser->tokens.count - 1;
    return false;
}

void csg_parser_leave(csg_parser *parser)
{
    parser->depth--;
}

/* ---- scopes --------------------------------------------------------------------------------- */

void *csg_arena_push(csg_arena *arena, void **items, uint32_t *count, size_t element_bytes)
{
    if ((*count & (*count - 1)) == 0) {
        if (*count > UINT32_MAX / 4)
            return NULL;
        size_t capacity = *count ? (size_t)*count * 2 : 1;
        void *fresh = csg_arena_alloc(arena, capacity * element_bytes);
        if (!fresh)
            return NULL;
        if (*count)
            memcpy(fresh, *items, *count * element_bytes);
        *items = fresh;
    }
    return (char *)*items + element_bytes * (*count)++;
}

csg_scope *csg_parser_scope(csg_parser *parser)
{
    csg_scope *scope = csg_parser_alloc(parser, sizeof *scope);
    if (scope)
        scope->id = parser->program->scope_count++;
    return scope;
}

static bool add_member(csg_parser *parser, const csg_scope *scope, csg_member_kind kind,
                       csg_symbol name, uint32_t index)
{
    bool added = csg_members_add(&parser->program->members, scope->id, kind, name, index);
    if (!added)
        csg_parser_no_memory(parser);
    return added;
}

/* OpenSCAD's rule: a scene may overwrite what it includes without a word. */
static void warn_second_assignment(csg_parser *parser, const csg_assignment *first, csg_span again)
{
    const csg_sources *sources = &parser->program->sources;
    const csg_source *before = &sources->items[first->where.source];
    const csg_source *now = &sources->items[again.source];
    bool same_file = strcmp(before->name, now->name) == 0;
    bool same_place = same_file && first->where.offset == again.offset; /* included twice */
    bool from_scene = first->where.source == parser->file->source;
    if (same_place || (!same_file && !from_scene))
        return;
    csg_source_report(sources, CSG_DIAG_SECOND_ASSIGNMENT, again, NULL,
                      "'%s' is assigned again; this value holds in the whole scope",
                      csg_symbol_name(&parser->program->symbols, first->name));
    csg_source_note(sources, first->where, "the earlier assignment");
}

static void add_variable(csg_parser *parser, csg_scope *scope, csg_assignment made)
{
    uint32_t known =
        csg_members_find(&parser->program->members, scope->id, CSG_MEMBER_VARIABLE, made.name);
    if (known != UINT32_MAX) {
        warn_second_assignment(parser, &scope->variables[known], made.where);
        scope->variables[known] = made;
        return;
    }
    csg_assignment *place = csg_arena_push(&parser->program->arena, (void **)&scope->variables,
                                           &scope->variable_count, sizeof made);
    if (!place) {
        csg_parser_no_memory(parser);
        return;
    }
    *place = made;
    add_member(parser, scope, CSG_MEMBER_VARIABLE, made.name, scope->variable_count - 1);
}

static void add_definition(csg_parser *parser, csg_scope *scope, csg_member_kind kind,
                           csg_definition *made)
{
    bool module = kind == CSG_MEMBER_MODULE;
    csg_definition ***list = module ? &scope->modules : &scope->functions;
    uint32_t *count = module ? &scope->module_count : &scope->function_count;
    uint32_t known = csg_members_find(&parser->program->members, scope->id, kind, made->name);
    if (known != UINT32_MAX) {
        if ((*list)[known]->where.source == made->where.source) {
            csg_source_report(&parser->program->sources, CSG_DIAG_DUPLICATE_DEFINITION, made->where,
                              NULL, "the %s '%s' is defined again; this definition holds",
                              module ? "module" : "function",
                              csg_symbol_name(&parser->program->symbols, made->name));
            csg_source_note(&parser->program->sources, (*list)[known]->where, "the earlier one");
        }
        (*list)[known] = made;
        return;
    }
    csg_definition **place =
        csg_arena_push(&parser->program->arena, (void **)list, count, sizeof made);
    if (!place) {
        csg_parser_no_memory(parser);
        return;
    }
    *place = made;
    add_member(parser, scope, kind, made->name, *count - 1);
}

static bool add_statement(csg_parser *parser, csg_scope *scope, csg_statement *made)
{
    csg_statement **place = csg_arena_push(&parser->program->arena, (void **)&scope->statements,
                                           &scope->statement_count, sizeof made);
    if (!place) {
        csg_parser_no_memory(parser);
        return false;
    }
    *place = made;
    return true;
}

/* ---- statements ---------------------------------------------------------------------------------
 */

static bool parse_statement(csg_parser *parser, csg_scope *scope);

/* A missing ';' before a new line is told and taken as there. */
static bool expect_semicolon(csg_parser *parser, const char *context)
{
    if (csg_parser_accept(parser, CSG_TOKEN_SEMICOLON))
        return true;
    csg_token_kind kind = csg_parser_peek(parser);
    if (!begins_line(parser) && kind != CSG_TOKEN_CLOSE_CURLY)
        return csg_parser_expect(parser, CSG_TOKEN_SEMICOLON, context);
    if (!parser->stop)
        csg_source_report(&parser->program->sources, CSG_DIAG_EXPECTED, place_behind(parser), NULL,
                          "expected ';' %s", context);
    return true;
}

static bool starts_statement(csg_token_kind kind)
{
    return kind == CSG_TOKEN_MODULE || kind == CSG_TOKEN_FUNCTION || kind == CSG_TOKEN_INCLUDE ||
           kind == CSG_TOKEN_USE || kind == CSG_TOKEN_FOR || kind == CSG_TOKEN_IF ||
           kind == CSG_TOKEN_NAME;
}

/* Brackets that the broken statement has open here. */
static uint32_t count_open(const csg_parser *parser, size_t from)
{
    uint32_t open = 0;
    for (size_t i = from; i < parser->at; i++) {
        csg_token_kind kind = parser->tokens.items[i].kind;
        bool closes = kind == CSG_TOKEN_CLOSE_ROUND || kind == CSG_TOKEN_CLOSE_SQUARE;
        open += kind == CSG_TOKEN_OPEN_ROUND || kind == CSG_TOKEN_OPEN_SQUARE;
        open -= closes && open > 0;
    }
    return open;
}

/* Is this ';' inside brackets, and more follows on its line? As in C's for (i = 0; i < 5; i++) */
static bool is_inside(const csg_parser *parser, uint32_t open)
{
    csg_parser next = *parser;
    next.at++;
    return open > 0 && parser->at + 1 < parser->tokens.count && !begins_line(&next);
}

/* To where a statement may begin. `from`: the token at which the broken one began. */
static void resynchronize(csg_parser *parser, size_t from)
{
    uint32_t braces = 0, open = count_open(parser, from);
    if (parser->at == from && csg_parser_peek(parser) != CSG_TOKEN_CLOSE_CURLY)
        csg_parser_next(parser);
    for (;; csg_parser_next(parser)) {
        csg_token_kind kind = csg_parser_peek(parser);
        if (kind == CSG_TOKEN_END)
            return;
        if (braces == 0 &&
            (kind == CSG_TOKEN_CLOSE_CURLY || (starts_statement(kind) && begins_line(parser))))
            return;
        if (kind == CSG_TOKEN_OPEN_CURLY)
            braces++;
        open += kind == CSG_TOKEN_OPEN_ROUND || kind == CSG_TOKEN_OPEN_SQUARE;
        open -= (kind == CSG_TOKEN_CLOSE_ROUND || kind == CSG_TOKEN_CLOSE_SQUARE) && open > 0;
        bool closes = kind == CSG_TOKEN_CLOSE_CURLY && --braces == 0;
        bool ends = kind == CSG_TOKEN_SEMICOLON && !is_inside(parser, open);
        if (closes || (braces == 0 && ends)) {
            csg_parser_next(parser);
            return;
        }
    }
}

static bool is_late(csg_parser *parser)
{
    const csg_program *program = parser->program;
    if (++parser->statements & 63)
        return false;
    bool cancelled = csg_context_is_cancelled(program->context);
    if (!cancelled && (program->deadline_s == 0 || csg_clock_now_s() < program->deadline_s))
        return false;
    if (!cancelled)
        csg_source_report(&program->sources, CSG_DIAG_TIMEOUT, csg_parser_span(parser), NULL,
                          "parsing takes more than %g seconds", program->context->limits.timeout_s);
    parser->stop = true;
    parser->status = cancelled ? CSGM_CANCELLED : CSGM_ERR_LIMIT;
    parser->at = parser->tokens.count - 1;
    return true;
}

static void parse_or_skip(csg_parser *parser, csg_scope *scope)
{
    size_t from = parser->at;
    if (is_late(parser))
        return;
    if (!parse_statement(parser, scope) && !parser->stop)
        resynchronize(parser, from);
}

/* "{ ... }" into `scope`. */
static bool parse_block(csg_parser *parser, csg_scope *scope)
{
    csg_span open = csg_parser_span(parser);
    csg_parser_next(parser);
    if (!csg_parser_enter(parser))
        return false;
    while (!parser->stop && csg_parser_peek(parser) != CSG_TOKEN_CLOSE_CURLY &&
           csg_parser_peek(parser) != CSG_TOKEN_END)
        parse_or_skip(parser, scope);
    csg_parser_leave(parser);
    return csg_parser_close(parser, CSG_TOKEN_CLOSE_CURLY, open);
}

/* What stands under a call, if or else: ';', one statement or a block, in a scope of its own. */
static csg_scope *parse_children(csg_parser *parser)
{
    csg_scope *scope = csg_parser_scope(parser);
    if (!scope || csg_parser_accept(parser, CSG_TOKEN_SEMICOLON))
        return scope;
    csg_token_kind kind = csg_parser_peek(parser);
    if (kind == CSG_TOKEN_OPEN_CURLY)
        return parse_block(parser, scope) ? scope : NULL;
    if (kind == CSG_TOKEN_CLOSE_CURLY || kind == CSG_TOKEN_END || kind == CSG_TOKEN_MODULE ||
        kind == CSG_TOKEN_FUNCTION || kind == CSG_TOKEN_ELSE || kind == CSG_TOKEN_ASSIGN) {
        csg_source_report(&parser->program->sources, CSG_DIAG_EXPECTED, place_behind(parser),
                          kind == CSG_TOKEN_ASSIGN
                              ? "a module has no '=', it makes a solid: module name() sphere(3);"
                              : NULL,
                          "expected ';', a child or '{'");
        return kind == CSG_TOKEN_ASSIGN ? NULL : scope;
    }
    if (kind == CSG_TOKEN_NAME && parser->tokens.items[parser->at + 1].kind == CSG_TOKEN_ASSIGN)
        csg_source_report(&parser->program->sources, CSG_DIAG_EXPECTED, csg_parser_span(parser),
                          "a variable has one value in its scope: x = condition ? 1 : 2;",
                          "an assignment alone has no effect here, it holds only inside its own "
                          "{ }");
    if (!csg_parser_enter(parser))
        return NULL;
    bool ok = parse_statement(parser, scope);
    csg_parser_leave(parser);
    return ok ? scope : NULL;
}

static bool parse_if(csg_parser *parser, csg_scope *scope, csg_statement *made)
{
    made->kind = CSG_STATEMENT_IF;
    csg_parser_next(parser);
    csg_span open = csg_parser_span(parser);
    if (!csg_parser_expect(parser, CSG_TOKEN_OPEN_ROUND, "after 'if'"))
        return false;
    made->condition = csg_parse_expression(parser);
    if (!made->condition || !csg_parser_close(parser, CSG_TOKEN_CLOSE_ROUND, open))
        return false;
    made->children = parse_children(parser);
    if (!made->children)
        return false;
    if (csg_parser_accept(parser, CSG_TOKEN_ELSE)) {
        made->other = parse_children(parser);
        if (!made->other)
            return false;
    }
    return add_statement(parser, scope, made);
}

/* The modifiers; `*` drops the statement at once. */
static bool parse_modifiers(csg_parser *parser, csg_statement *made)
{
    bool disabled = false;
    for (;; csg_parser_next(parser)) {
        switch (csg_parser_peek(parser)) {
        case CSG_TOKEN_NOT:
            made->root = true;
            break;
        case CSG_TOKEN_HASH:
            made->highlight = true;
            break;
        case CSG_TOKEN_PERCENT:
            made->background = true;
            break;
        case CSG_TOKEN_STAR:
            disabled = true;
            break;
        default:
            return disabled;
        }
    }
}

static bool parse_call(csg_parser *parser, csg_scope *scope)
{
    csg_statement *made = csg_parser_alloc(parser, sizeof *made);
    csg_scope *into = scope;
    if (!made)
        return false;
    if (parse_modifiers(parser, made)) {
        into = csg_parser_scope(parser); /* parsed, and then forgotten */
        if (!into)
            return false;
    }
    made->where = csg_parser_span(parser);
    csg_token_kind kind = csg_parser_peek(parser);
    if (kind == CSG_TOKEN_IF)
        return parse_if(parser, into, made);
    if (kind != CSG_TOKEN_NAME && kind != CSG_TOKEN_FOR && kind != CSG_TOKEN_LET &&
        kind != CSG_TOKEN_ASSERT && kind != CSG_TOKEN_ECHO && kind != CSG_TOKEN_EACH) {
        csg_parser_unexpected(parser, CSG_DIAG_EXPECTED, "a statement",
                              kind == CSG_TOKEN_ELSE ? "there is no 'if' right before it" : NULL);
        return false;
    }
    made->kind = CSG_STATEMENT_CALL;
    made->name = csg_parser_symbol(parser, made->where);
    made->slot = parser->program->slot_count++;
    parser->program->symbols.entries[made->name].called = true;
    csg_parser_next(parser);
    if (csg_parser_peek(parser) != CSG_TOKEN_OPEN_ROUND) {
        csg_parser_unexpected(
            parser, CSG_DIAG_EXPECTED, "'(' or '='",
            "a call is name(...); an assignment is name = value; a comment begins with //");
        return false;
    }
    if (!csg_parse_arguments(parser, &made->arguments))
        return false;
    if (kind == CSG_TOKEN_LET)
        csg_parser_drop_doubles(parser, &made->arguments);
    made->childless = csg_parser_peek(parser) == CSG_TOKEN_SEMICOLON;
    made->children = parse_children(parser);
    return made->children && add_statement(parser, into, made);
}

static bool parse_assignment(csg_parser *parser, csg_scope *scope)
{
    csg_assignment made = {.where = csg_parser_span(parser)};
    made.name = csg_parser_symbol(parser, made.where);
    parser->program->symbols.entries[made.name].variable = true;
    csg_parser_next(parser);
    csg_parser_next(parser);
    made.value = csg_parse_expression(parser);
    if (!made.value || !made.name)
        return false;
    bool ok = expect_semicolon(parser, "after the assignment");
    add_variable(parser, scope, made);
    return ok;
}

static csg_definition *parse_head(csg_parser *parser, const char *what)
{
    csg_definition *made = csg_parser_alloc(parser, sizeof *made);
    csg_parser_next(parser);
    if (!made)
        return NULL;
    made->where = csg_parser_span(parser);
    if (csg_parser_peek(parser) != CSG_TOKEN_NAME) {
        csg_parser_unexpected(parser, CSG_DIAG_EXPECTED, what, NULL);
        return NULL;
    }
    made->name = csg_parser_symbol(parser, made->where);
    csg_parser_next(parser);
    return csg_parse_parameters(parser, &made->parameters) ? made : NULL;
}

static bool parse_function(csg_parser *parser, csg_scope *scope)
{
    csg_definition *made = parse_head(parser, "the function's name");
    if (!made || !csg_parser_expect(parser, CSG_TOKEN_ASSIGN, "and the function's value"))
        return false;
    made->value = csg_parse_expression(parser);
    if (!made->value)
        return false;
    add_definition(parser, scope, CSG_MEMBER_FUNCTION, made);
    return expect_semicolon(parser, "after the function");
}

static bool parse_module(csg_parser *parser, csg_scope *scope)
{
    csg_definition *made = parse_head(parser, "the module's name");
    if (!made)
        return false;
    made->body = parse_children(parser);
    if (!made->body)
        return false;
    add_definition(parser, scope, CSG_MEMBER_MODULE, made);
    return true;
}

static bool parse_include(csg_parser *parser, csg_scope *scope)
{
    bool use = csg_parser_peek(parser) == CSG_TOKEN_USE;
    csg_parser_next(parser);
    csg_span path = csg_parser_span(parser);
    if (csg_parser_peek(parser) != CSG_TOKEN_PATH || path.length <= 2) {
        bool name = csg_parser_peek(parser) == CSG_TOKEN_ASSIGN;
        csg_source_report(&parser->program->sources, CSG_DIAG_BAD_INCLUDE, path,
                          name  ? "this is a word of the language: choose another name"
                          : use ? "write: use <file.txt>"
                                : "write: include <file.txt>",
                          "expected a file name in < >");
        return false;
    }
    csg_parser_next(parser);
    csg_parser_accept(parser, CSG_TOKEN_SEMICOLON);
    if (parser->program->is_alone)
        return true;
    if (use)
        csg_load_use(parser, path);
    else
        csg_load_include(parser, scope, path);
    return true;
}

/* `module wheel(r); { ... }`: the block was to belong to what the ';' ended. */
static void warn_cut_off(csg_parser *parser)
{
    const csg_token *tokens = parser->tokens.items;
    if (parser->at >= 2 && tokens[parser->at - 1].kind == CSG_TOKEN_SEMICOLON &&
        tokens[parser->at - 2].kind == CSG_TOKEN_CLOSE_ROUND)
        csg_source_report(&parser->program->sources, CSG_DIAG_STRAY_BLOCK, csg_parser_span(parser),
                          "is the ';' before it one too many?",
                          "this block stands alone: it belongs to no module or call");
}

static bool parse_statement(csg_parser *parser, csg_scope *scope)
{
    switch (csg_parser_peek(parser)) {
    case CSG_TOKEN_SEMICOLON:
        csg_parser_next(parser);
        return true;
    case CSG_TOKEN_OPEN_CURLY: /* bare braces are no scope of their own, as in OpenSCAD */
        warn_cut_off(parser);
        return parse_block(parser, scope);
    case CSG_TOKEN_MODULE:
        return parse_module(parser, scope);
    case CSG_TOKEN_FUNCTION:
        return parse_function(parser, scope);
    case CSG_TOKEN_INCLUDE:
    case CSG_TOKEN_USE:
        return parse_include(parser, scope);
    case CSG_TOKEN_NAME:
        if (parser->tokens.items[parser->at + 1].kind == CSG_TOKEN_ASSIGN)
            return parse_assignment(parser, scope);
        return parse_call(parser, scope);
    default:
        return parse_call(parser, scope);
    }
}

void csg_parser_statements(csg_parser *parser, csg_scope *scope)
{
    while (!parser->stop && csg_parser_peek(parser) != CSG_TOKEN_END) {
        csg_token_kind kind = csg_parser_peek(parser);
        if (kind == CSG_TOKEN_CLOSE_CURLY) {
            csg_source_report(&parser->program->sources, CSG_DIAG_STRAY_CLOSE,
                              csg_parser_span(parser), NULL,
                              "nothing is open that this '}' closes");
            csg_parser_next(parser);
            continue;
        }
        parse_or_skip(parser, scope);
    }
}

/* ---- whole programs and lone expressions ----------------------------------------------------- */

csgm_status csg_parse_program(csg_program *program, uint32_t source,
                              const csgm_scene_options *options)
{
    uint32_t errors = program->context->diags.errors;
    csg_parser parser = {.program = program, .options = options, .source = source};
    csg_load_scene(&parser);
    if (parser.stop)
        return parser.status;
    if (program->failed_io)
        return CSGM_ERR_IO;
    return program->context->diags.errors > errors ? CSGM_ERR_SYNTAX : CSGM_OK;
}

csg_expression *csg_parse_lone_expression(csg_program *program, uint32_t source)
{
    uint32_t errors = program->context->diags.errors;
    csg_parser parser = {.program = program, .source = source};
    parser.text = program->sources.items[source].text;
    csg_expression *made = NULL;
    if (csg_lex(&program->sources, source, &parser.tokens)) {
        made = csg_parse_expression(&parser);
        if (made && csg_parser_peek(&parser) != CSG_TOKEN_END)
            csg_parser_unexpected(&parser, CSG_DIAG_EXPECTED, "the end of the expression", NULL);
    } else {
        csg_context_no_memory(program->context);
    }
    csg_tokens_release(&program->context->memory, &parser.tokens);
    return program->context->diags.errors > errors || parser.stop ? NULL : made;
}
