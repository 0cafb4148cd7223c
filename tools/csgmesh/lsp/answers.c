/* SPDX-License-Identifier: MIT
 * The requests, one function each; the table is at the end.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "lsp/lsp.h"

/* ---- beginning and end ------------------------------------------------------------------------- */

static bool offers_utf8(const cli_value *params)
{
    const cli_value *general =
        cli_value_member(cli_value_member(params, "capabilities"), "general");
    const cli_value *encodings = cli_value_member(general, "positionEncodings");
    for (const cli_value *e = encodings ? encodings->first : NULL; e; e = e->next)
        if (e->text && strcmp(e->text, "utf-8") == 0)
            return true;
    return false;
}

static bool offers_snippets(const cli_value *params)
{
    static const char *const way[] = {"capabilities", "textDocument", "completion",
                                      "completionItem", "snippetSupport"};
    for (size_t i = 0; i < sizeof way / sizeof *way; i++)
        params = cli_value_member(params, way[i]);
    return params && params->text && strcmp(params->text, "true") == 0;
}

static int initialize(lsp_call *call)
{
    lsp_server *server = call->server;
    server->has_snippets = offers_snippets(call->params);
    server->is_utf8 = server->checker.is_utf8 = offers_utf8(call->params);
    server->is_ready = true;
    cli_json_open(call->json, "result", '{');
    cli_json_open(call->json, "capabilities", '{');
    cli_json_string(call->json, "positionEncoding", server->is_utf8 ? "utf-8" : "utf-16");
    cli_json_verbatim(call->json, "textDocumentSync",
                      "{\"openClose\": true, \"change\": 2, \"save\": true}");
    cli_json_verbatim(call->json, "completionProvider",
                      "{\"triggerCharacters\": [\"$\", \"(\", \"<\", \"/\"]}");
    cli_json_verbatim(call->json, "signatureHelpProvider",
                      "{\"triggerCharacters\": [\"(\", \",\", \"=\"]}");
    static const char *const flags[] = {"hoverProvider",        "definitionProvider",
                                        "referencesProvider",   "documentSymbolProvider",
                                        "foldingRangeProvider", "documentFormattingProvider",
                                        "colorProvider",        "documentHighlightProvider"};
    for (size_t i = 0; i < sizeof flags / sizeof *flags; i++)
        cli_json_bool(call->json, flags[i], true);
    cli_json_verbatim(call->json, "renameProvider", "{\"prepareProvider\": true}");
    cli_json_verbatim(call->json, "codeLensProvider", "{\"resolveProvider\": false}");
    cli_json_end(call->json, '}');
    cli_json_open(call->json, "serverInfo", '{');
    cli_json_string(call->json, "name", "csgmesh");
    cli_json_string(call->json, "version", csgm_version());
    cli_json_end(call->json, '}');
    cli_json_end(call->json, '}');
    return 0;
}

static int shut_down(lsp_call *call)
{
    call->server->is_shut_down = true;
    cli_json_verbatim(call->json, "result", "null");
    return 0;
}

/* ---- names ------------------------------------------------------------------------------------- */

/* Several answers in one list. */
typedef struct listing {
    lsp_call *call;
    uint32_t depth;   /* of symbols that are open */
    bool is_declared; /* references: with the definition */
    bool found;
    uint32_t count;
    const char *new_name;
    const char *path; /* rename: of the file whose edits are being written */
    lsp_place begin, end;
} listing;

/* Modules are classes, as they have parts; so do editors show them. */
static int symbol_kind(csgm_name_kind kind)
{
    enum { CLASS = 5, FUNCTION = 12, VARIABLE = 13 };
    return kind == CSGM_NAME_MODULE ? CLASS : kind == CSGM_NAME_FUNCTION ? FUNCTION : VARIABLE;
}

static void close_symbols(listing *list, uint32_t depth)
{
    for (; list->depth > depth; list->depth--) {
        cli_json_end(list->call->json, ']');
        cli_json_end(list->call->json, '}');
    }
}

static bool take_symbol(void *user, const csgm_name *name)
{
    listing *list = user;
    lsp_call *call = list->call;
    close_symbols(list, name->depth);
    cli_json_open(call->json, NULL, '{');
    cli_json_string(call->json, "name", name->name);
    cli_json_string(call->json, "detail", name->signature);
    cli_json_integer(call->json, "kind", symbol_kind(name->kind));
    lsp_put_range(call, "range", call->text, call->length, name->whole_begin, name->whole_end);
    lsp_put_range(call, "selectionRange", call->text, call->length, name->begin, name->end);
    cli_json_open(call->json, "children", '[');
    list->depth++;
    return true;
}

static int symbols(lsp_call *call)
{
    listing list = {.call = call};
    if (!call->text)
        return LSP_REQUEST_FAILED;
    cli_json_open(call->json, "result", '[');
    csgm_workspace_list(call->server->workspace, call->path, take_symbol, &list);
    close_symbols(&list, 0);
    cli_json_end(call->json, ']');
    return 0;
}

void lsp_put_markdown(cli_json *json, const char *key, const csgm_name *name)
{
    cli_text text;
    if (!cli_text_open(&text))
        return;
    fprintf(text.out, "```csgmesh\n%s\n```\n", name->signature ? name->signature : name->name);
    bool is_comment = name->path != NULL; /* lines of comments stay lines */
    for (const char *c = name->documentation ? name->documentation : ""; *c; c++)
        fprintf(text.out, *c == '\n' && is_comment ? "  \n" : "%c", *c);
    char *words = cli_text_close(&text);
    cli_json_open(json, key, '{');
    cli_json_string(json, "kind", "markdown");
    cli_json_string(json, "value", words ? words : "");
    cli_json_end(json, '}');
    free(words);
}

static bool take_hover(void *user, const csgm_name *name)
{
    listing *list = user;
    cli_json_open(list->call->json, "result", '{');
    lsp_put_markdown(list->call->json, "contents", name);
    cli_json_end(list->call->json, '}');
    list->found = true;
    return false;
}

static int hover(lsp_call *call)
{
    listing list = {.call = call};
    if (call->text)
        csgm_workspace_find(call->server->workspace, call->path, call->offset, take_hover, &list);
    if (!list.found)
        cli_json_verbatim(call->json, "result", "null");
    return 0;
}

/* Of a file, as the editor spells it where it has it open; for the caller to free. */
static char *uri_of(const lsp_server *server, const char *path)
{
    for (const lsp_document *d = server->documents; d; d = d->next)
        if (strcmp(d->path, path) == 0)
            return strdup(d->uri);
    return lsp_uri_of(path);
}

/* Text of a file while a question about another one is answered: the library lends it. */
static void put_location(listing *list, const csgm_name *name)
{
    lsp_call *call = list->call;
    size_t length = 0;
    char *uri = uri_of(call->server, name->path);
    const char *text = csgm_workspace_text(call->server->workspace, name->path, &length);
    if (uri && text) {
        cli_json_open(call->json, NULL, '{');
        cli_json_string(call->json, "uri", uri);
        lsp_put_range(call, "range", text, length, name->begin, name->end);
        cli_json_end(call->json, '}');
    }
    free(uri);
}

static bool take_location(void *user, const csgm_name *name)
{
    listing *list = user;
    if (name->path && list->is_declared)
        put_location(list, name);
    list->is_declared = true;
    return true;
}

static int definition(lsp_call *call)
{
    listing list = {.call = call, .is_declared = true};
    cli_json_open(call->json, "result", '[');
    if (call->text)
        csgm_workspace_find(call->server->workspace, call->path, call->offset, take_location,
                            &list);
    cli_json_end(call->json, ']');
    return 0;
}

static int references(lsp_call *call)
{
    const cli_value *context = cli_value_member(call->params, "context");
    const cli_value *declared = cli_value_member(context, "includeDeclaration");
    listing list = {.call = call};
    list.is_declared = !declared || !declared->text || strcmp(declared->text, "false") != 0;
    cli_json_open(call->json, "result", '[');
    if (call->text)
        csgm_workspace_uses(call->server->workspace, call->path, call->offset, take_location,
                            &list);
    cli_json_end(call->json, ']');
    return 0;
}

static bool take_highlight(void *user, const csgm_name *name)
{
    listing *list = user;
    lsp_call *call = list->call;
    if (!name->path || strcmp(name->path, call->path) != 0)
        return true;
    cli_json_open(call->json, NULL, '{');
    lsp_put_range(call, "range", call->text, call->length, name->begin, name->end);
    cli_json_end(call->json, '}');
    return true;
}

static int highlights(lsp_call *call)
{
    listing list = {.call = call};
    cli_json_open(call->json, "result", '[');
    if (call->text)
        csgm_workspace_uses(call->server->workspace, call->path, call->offset, take_highlight,
                            &list);
    cli_json_end(call->json, ']');
    return 0;
}

/* ---- renaming ---------------------------------------------------------------------------------- */

static bool is_name(const char *text)
{
    static const char *const words[] = {"true", "false", "undef", "module",  "function",
                                        "if",   "else",  "for",   "let",     "assert",
                                        "echo", "each",  "use",   "include", NULL};
    size_t length = text ? cli_name_length(text) : 0;
    const char *dollar = length ? strchr(text + 1, '$') : NULL;
    bool ok = length > 0 && !text[length] && !dollar && !(*text >= '0' && *text <= '9');
    for (size_t i = 0; ok && words[i]; i++)
        ok = strcmp(text, words[i]) != 0;
    return ok;
}

/* Only what a file defines has another name one day. */
static bool take_own(void *user, const csgm_name *name)
{
    listing *list = user;
    list->found = name->path != NULL;
    return false;
}

static bool may_rename(lsp_call *call)
{
    listing list = {.call = call};
    if (call->text)
        csgm_workspace_find(call->server->workspace, call->path, call->offset, take_own, &list);
    snprintf(call->server->problem, sizeof call->server->problem,
             "there is no name here that a scene defines");
    return list.found;
}

static int prepare_rename(lsp_call *call)
{
    if (!may_rename(call)) {
        cli_json_verbatim(call->json, "result", "null");
        return 0;
    }
    uint32_t begin = call->offset;
    while (begin > 0 && cli_name_length(call->text + begin - 1) > 0)
        begin--;
    lsp_put_range(call, "result", call->text, call->length, begin,
                  begin + (uint32_t)cli_name_length(call->text + begin));
    return 0;
}

static bool take_edit(void *user, const csgm_name *name)
{
    listing *list = user;
    lsp_call *call = list->call;
    size_t length = 0;
    if (!name->path || strcmp(name->path, list->path) != 0)
        return true;
    const char *text = csgm_workspace_text(call->server->workspace, name->path, &length);
    if (!text)
        return true;
    cli_json_open(call->json, NULL, '{');
    lsp_put_range(call, "range", text, length, name->begin, name->end);
    cli_json_string(call->json, "newText", list->new_name);
    cli_json_end(call->json, '}');
    return true;
}

/* The files that have a use, each once. */
typedef struct file_list {
    cli_arena *arena;
    cli_list paths;
} file_list;

static bool take_file(void *user, const csgm_name *name)
{
    file_list *files = user;
    for (size_t i = 0; i < files->paths.count; i++)
        if (strcmp(files->paths.items[i], name->path) == 0)
            return true;
    cli_list_add(files->arena, &files->paths, cli_arena_strdup(files->arena, name->path));
    return true;
}

static int rename_name(lsp_call *call)
{
    lsp_server *server = call->server;
    listing list = {.call = call, .new_name = lsp_text(call->params, "newName")};
    file_list files = {call->arena, {0}};
    if (!is_name(list.new_name)) {
        snprintf(server->problem, sizeof server->problem,
                 "a name is made of a-z, A-Z, 0-9 and _, and is no word of the language");
        return LSP_INVALID_PARAMS;
    }
    if (!may_rename(call))
        return LSP_REQUEST_FAILED;
    csgm_workspace_uses(server->workspace, call->path, call->offset, take_file, &files);
    cli_json_open(call->json, "result", '{');
    cli_json_open(call->json, "changes", '{');
    for (size_t i = 0; i < files.paths.count; i++) {
        char *uri = uri_of(server, files.paths.items[i]);
        list.path = files.paths.items[i];
        if (uri) {
            cli_json_open(call->json, uri, '[');
            csgm_workspace_uses(server->workspace, call->path, call->offset, take_edit, &list);
            cli_json_end(call->json, ']');
        }
        free(uri);
    }
    cli_json_end(call->json, '}');
    cli_json_end(call->json, '}');
    return 0;
}

/* ---- calls --------------------------------------------------------------------------------------- */

static uint32_t column_in(const lsp_call *call, const char *line, uint32_t offset)
{
    return lsp_place_of(line, strlen(line), offset, call->server->is_utf8).character;
}

/* As places in the label. */
static void put_parameters(lsp_call *call, const csgm_name *name)
{
    cli_json_open(call->json, "parameters", '[');
    for (uint32_t i = 0; i < name->parameter_count; i++) {
        csgm_text_range range = name->parameters[i];
        cli_json_open(call->json, NULL, '{');
        cli_json_open(call->json, "label", '[');
        cli_json_count(call->json, NULL, column_in(call, name->signature, range.begin));
        cli_json_count(call->json, NULL, column_in(call, name->signature, range.end));
        cli_json_end(call->json, ']');
        cli_json_end(call->json, '}');
    }
    cli_json_end(call->json, ']');
}

static bool take_signature(void *user, const csgm_name *name)
{
    listing *list = user;
    cli_json *json = list->call->json;
    cli_json_open(json, "result", '{');
    cli_json_open(json, "signatures", '[');
    cli_json_open(json, NULL, '{');
    cli_json_string(json, "label", name->signature);
    if (name->documentation)
        lsp_put_markdown(json, "documentation", name);
    put_parameters(list->call, name);
    cli_json_end(json, '}');
    cli_json_end(json, ']');
    list->found = true;
    return false;
}

static int signature(lsp_call *call)
{
    listing list = {.call = call};
    uint32_t parameter = 0;
    if (call->text)
        csgm_workspace_call(call->server->workspace, call->path, call->offset, take_signature,
                            &list, &parameter);
    if (!list.found) {
        cli_json_verbatim(call->json, "result", "null");
        return 0;
    }
    cli_json_count(call->json, "activeSignature", 0);
    cli_json_count(call->json, "activeParameter", parameter < 1000 ? parameter : 1000);
    cli_json_end(call->json, '}');
    return 0;
}

/* ---- the text ---------------------------------------------------------------------------------- */

static bool take_fold(void *user, const csgm_fold *fold)
{
    lsp_call *call = user;
    cli_json_open(call->json, NULL, '{');
    cli_json_count(call->json, "startLine", fold->first_line);
    cli_json_count(call->json, "endLine", fold->last_line);
    if (fold->is_comment)
        cli_json_string(call->json, "kind", "comment");
    cli_json_end(call->json, '}');
    return true;
}

static int folds(lsp_call *call)
{
    cli_json_open(call->json, "result", '[');
    if (call->text)
        csgm_workspace_folds(call->server->workspace, call->path, take_fold, call);
    cli_json_end(call->json, ']');
    return 0;
}

/* One edit from the first to the last line that differ. */
static void take_layout(void *user, const char *text, size_t length)
{
    lsp_call *call = user;
    size_t same = 0, begin = 0, tail = 0, least = length < call->length ? length : call->length;
    while (same < least && text[same] == call->text[same])
        if (text[same++] == '\n')
            begin = same;
    if (same == length && same == call->length)
        return;
    while (tail < least - begin && text[length - 1 - tail] == call->text[call->length - 1 - tail])
        tail++;
    while (tail > 0 && text[length - 1 - tail] != '\n')
        tail--; /* whole lines */
    cli_text made;
    if (!cli_text_open(&made))
        return;
    fwrite(text + begin, 1, length - tail - begin, made.out);
    char *words = cli_text_close(&made);
    cli_json_open(call->json, NULL, '{');
    lsp_put_range(call, "range", call->text, call->length, (uint32_t)begin,
                  (uint32_t)(call->length - tail));
    cli_json_string(call->json, "newText", words ? words : "");
    cli_json_end(call->json, '}');
    free(words);
}

static int format(lsp_call *call)
{
    if (!call->text)
        return LSP_REQUEST_FAILED;
    cli_json_open(call->json, "result", '[');
    csgm_status status = csgm_scene_format(call->server->context, call->text, call->length,
                                           call->path, take_layout, call);
    cli_json_end(call->json, ']');
    return status == CSGM_OK ? 0 : LSP_REQUEST_FAILED;
}

static bool take_color(void *user, const csgm_text_color *color)
{
    lsp_call *call = user;
    cli_json_open(call->json, NULL, '{');
    lsp_put_range(call, "range", call->text, call->length, color->begin, color->end);
    cli_json_open(call->json, "color", '{');
    cli_json_number(call->json, "red", color->red);
    cli_json_number(call->json, "green", color->green);
    cli_json_number(call->json, "blue", color->blue);
    cli_json_number(call->json, "alpha", color->alpha);
    cli_json_end(call->json, '}');
    cli_json_end(call->json, '}');
    return true;
}

static int colors(lsp_call *call)
{
    cli_json_open(call->json, "result", '[');
    if (call->text)
        csgm_workspace_colors(call->server->workspace, call->path, take_color, call);
    cli_json_end(call->json, ']');
    return 0;
}

static unsigned byte_of(const cli_value *color, const char *key)
{
    const cli_value *value = cli_value_member(color, key);
    double share = value && value->text ? strtod(value->text, NULL) : 1;
    return share > 0 ? share < 1 ? (unsigned)lround(255 * share) : 255 : 0;
}

static int present_color(lsp_call *call)
{
    char text[16];
    const cli_value *color = cli_value_member(call->params, "color");
    unsigned alpha = byte_of(color, "alpha");
    int length = snprintf(text, sizeof text, "\"#%02x%02x%02x", byte_of(color, "red"),
                          byte_of(color, "green"), byte_of(color, "blue"));
    if (alpha < 255)
        length += snprintf(text + length, sizeof text - (size_t)length, "%02x", alpha);
    snprintf(text + length, sizeof text - (size_t)length, "\"");
    cli_json_open(call->json, "result", '[');
    cli_json_open(call->json, NULL, '{');
    cli_json_string(call->json, "label", text);
    cli_json_end(call->json, '}');
    cli_json_end(call->json, ']');
    return 0;
}

/* At the first line: the view of this file. */
static int lenses(lsp_call *call)
{
    const char *uri = lsp_text(cli_value_member(call->params, "textDocument"), "uri");
    cli_json_open(call->json, "result", '[');
    if (call->text && uri) {
        cli_json_open(call->json, NULL, '{');
        lsp_put_range(call, "range", call->text, call->length, 0, 0);
        cli_json_open(call->json, "command", '{');
        cli_json_string(call->json, "title", "View");
        cli_json_string(call->json, "command", "csgmesh.view");
        cli_json_open(call->json, "arguments", '[');
        cli_json_string(call->json, NULL, uri);
        cli_json_end(call->json, ']');
        cli_json_end(call->json, '}');
        cli_json_end(call->json, '}');
    }
    cli_json_end(call->json, ']');
    return 0;
}

lsp_answer *lsp_answer_find(const char *method)
{
    static const struct {
        const char *method;
        lsp_answer *answer;
    } table[] = {
        {"initialize", initialize},
        {"shutdown", shut_down},
        {"textDocument/documentSymbol", symbols},
        {"textDocument/hover", hover},
        {"textDocument/definition", definition},
        {"textDocument/references", references},
        {"textDocument/documentHighlight", highlights},
        {"textDocument/prepareRename", prepare_rename},
        {"textDocument/rename", rename_name},
        {"textDocument/completion", lsp_complete},
        {"textDocument/signatureHelp", signature},
        {"textDocument/foldingRange", folds},
        {"textDocument/formatting", format},
        {"textDocument/documentColor", colors},
        {"textDocument/colorPresentation", present_color},
        {"textDocument/codeLens", lenses},
    };
    for (size_t i = 0; i < sizeof table / sizeof *table; i++)
        if (strcmp(table[i].method, method) == 0)
            return table[i].answer;
    return NULL;
}
