/* SPDX-License-Identifier: MIT
 * textDocument/completion: names with their words, and for editors that take them snippets (LSP
 * 3.17, "Snippet Syntax"): the brackets of a call with what has no default, and what goes on behind
 * it. Where brackets stand already, the name alone is written.
 */
#include <stdlib.h>
#include <string.h>

#include "lsp/lsp.h"

typedef struct completion {
    lsp_call *call;
    bool wants_snippets;
    bool is_ended; /* a semicolon follows */
} completion;

/* What is no plain call. A statement that ends gets its semicolon unless there is one. */
static const struct snippet {
    const char *name, *statement, *value;
    bool ends;
} snippets[] = {
    {"module", "module ${1:name}($2) {\n  $0\n}", NULL, false},
    {"function", "function ${1:name}($2) = $0", "function (${1:x}) $0", true},
    {"include", "include <$0>", NULL, false},
    {"use", "use <$0>", NULL, false},
    {"if", "if (${1:condition}) $0", "if (${1:condition}) $0", false},
    {"for", "for (${1:i} = [${2:0} : ${3:10}]) $0", "for (${1:i} = [${2:0} : ${3:10}]) $0", false},
    {"intersection_for", "intersection_for (${1:i} = [${2:0} : ${3:10}]) $0", NULL, false},
    {"let", "let (${1:name} = ${2:value}) $0", "let (${1:name} = ${2:value}) $0", false},
    {"assert", "assert(${1:condition})", "assert(${1:condition}) $0", true},
    {"echo", "echo($1)", "echo($1) $0", true},
};

static const struct snippet *find_snippet(const csgm_name *name)
{
    for (size_t i = 0; !name->path && i < sizeof snippets / sizeof *snippets; i++)
        if (strcmp(snippets[i].name, name->name) == 0)
            return &snippets[i];
    return NULL;
}

/* As it stands, whatever it means in a snippet. */
static void put_literally(FILE *out, const char *text, size_t length)
{
    for (size_t i = 0; i < length; i++)
        fprintf(out, strchr("$}\\", text[i]) ? "\\%c" : "%c", text[i]);
}

/* Parameters without a default are places to fill in. */
static void put_call(FILE *out, const csgm_name *name)
{
    uint32_t places = 0;
    put_literally(out, name->name, strlen(name->name));
    fputc('(', out);
    for (uint32_t i = 0; i < name->parameter_count; i++) {
        const char *parameter = name->signature + name->parameters[i].begin;
        size_t length = name->parameters[i].end - name->parameters[i].begin;
        if (memchr(parameter, '=', length))
            continue;
        fprintf(out, "%s${%u:", places ? ", " : "", (unsigned)places + 1);
        put_literally(out, parameter, length);
        fputc('}', out);
        places++;
    }
    fputs(name->parameter_count > 0 && places == 0 ? "$1)" : ")", out);
}

/* For the caller to free; NULL: the name alone, or no memory. */
static char *snippet_of(const completion *c, const csgm_name *name)
{
    const struct snippet *special = find_snippet(name);
    const char *body = special ? name->is_value ? special->value : special->statement : NULL;
    bool is_called = name->kind == CSGM_NAME_MODULE || name->kind == CSGM_NAME_FUNCTION;
    cli_text text;
    if ((!body && (!is_called || special)) || !cli_text_open(&text))
        return NULL;
    if (body)
        fputs(body, text.out);
    else
        put_call(text.out, name);
    bool ends = special ? special->ends : name->kind == CSGM_NAME_MODULE && !name->takes_children;
    if (ends && !name->is_value && !c->is_ended)
        fputc(';', text.out);
    if (!body && !ends && !name->is_value)
        fputs(" $0", text.out);
    return cli_text_close(&text);
}

static void put_text(const completion *c, const csgm_name *name, bool is_argument)
{
    cli_json *json = c->call->json;
    char *text = NULL;
    if (is_argument) {
        text = malloc(strlen(name->name) + sizeof " = ");
        if (text)
            sprintf(text, "%s = ", name->name);
    } else if (c->wants_snippets) {
        text = snippet_of(c, name);
        if (text)
            cli_json_integer(json, "insertTextFormat", 2);
    }
    if (text)
        cli_json_string(json, "insertText", text);
    free(text);
}

static bool take_item(void *user, const csgm_name *name)
{
    enum { FUNCTION = 3, VARIABLE = 6, CLASS = 7, PROPERTY = 10, KEYWORD = 14 };
    static const int kinds[] = {[CSGM_NAME_MODULE] = CLASS,
                                [CSGM_NAME_FUNCTION] = FUNCTION,
                                [CSGM_NAME_VARIABLE] = VARIABLE,
                                [CSGM_NAME_PARAMETER] = VARIABLE,
                                [CSGM_NAME_KEYWORD] = KEYWORD};
    const completion *c = user;
    cli_json *json = c->call->json;
    bool is_argument = name->kind == CSGM_NAME_PARAMETER && !name->path;
    cli_json_open(json, NULL, '{');
    cli_json_string(json, "label", name->name);
    cli_json_integer(json, "kind", is_argument ? PROPERTY : kinds[name->kind]);
    if (name->signature)
        cli_json_string(json, "detail", name->signature);
    if (name->documentation)
        lsp_put_markdown(json, "documentation", name);
    put_text(c, name, is_argument);
    if (is_argument)
        cli_json_string(json, "sortText", " ");
    cli_json_end(json, '}');
    return true;
}

/* What stands behind the word at the place, blanks apart. */
static char next_of(const lsp_call *call)
{
    size_t at = call->offset + cli_name_length(call->text + call->offset);
    while (call->text[at] == ' ' || call->text[at] == '\t')
        at++;
    return call->text[at];
}

int lsp_complete(lsp_call *call)
{
    enum { MOST = 400 };
    bool is_complete = true;
    completion c = {.call = call};
    cli_json_open(call->json, "result", '{');
    cli_json_open(call->json, "items", '[');
    if (call->text && !lsp_complete_path(call)) {
        char next = next_of(call);
        c.wants_snippets = call->server->has_snippets && next != '(' && next != '<';
        c.is_ended = next == ';';
        csgm_workspace_complete(call->server->workspace, call->path, call->offset, MOST, take_item,
                                &c, &is_complete);
    }
    cli_json_end(call->json, ']');
    cli_json_bool(call->json, "isIncomplete", !is_complete);
    cli_json_end(call->json, '}');
    return 0;
}
