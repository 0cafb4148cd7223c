/* SPDX-License-Identifier: MIT
 * csgmesh lsp: a language server on standard input and output. One message after the other; what
 * takes long, looking for findings, has a thread of its own. Nonsense is answered with an error and
 * passed over; only the end of the input or `exit` end the program.
 */
#include <malloc.h>
#include <stdlib.h>
#include <string.h>

#include "core/commands.h"
#include "core/options.h"
#include "lsp/lsp.h"

/* Findings of the server's own context are words for an error. */
static void take_problem(void *user, const csgm_diag *diag)
{
    lsp_server *server = user;
    if (diag->severity == CSGM_ERROR)
        snprintf(server->problem, sizeof server->problem, "%.380s", diag->message);
}

static void put_id(cli_json *json, const cli_value *id)
{
    if (id && id->kind == CSGM_JSON_STRING)
        cli_json_string(json, "id", id->text);
    else
        cli_json_verbatim(json, "id", id && id->kind == CSGM_JSON_NUMBER ? id->text : "null");
}

static void send_error(const cli_value *id, int code, const char *words)
{
    cli_text text;
    cli_json json;
    if (!lsp_message_open(&text, &json))
        return;
    put_id(&json, id);
    cli_json_open(&json, "error", '{');
    cli_json_integer(&json, "code", code);
    cli_json_string(&json, "message", words);
    cli_json_end(&json, '}');
    lsp_message_send(&text, &json);
}

/* Fills in what most requests have: the file with its text, and the place in it. */
static void find_place(lsp_call *call)
{
    lsp_server *server = call->server;
    const cli_value *place = cli_value_member(call->params, "position");
    const char *uri = lsp_text(cli_value_member(call->params, "textDocument"), "uri");
    const lsp_document *document = uri ? lsp_document_find(server, uri) : NULL;
    if (document) {
        call->path = document->path;
        call->text = document->text;
        call->length = document->length;
    } else if (uri) { /* a copy: the file may change at any time */
        char *path = lsp_path_of(uri);
        call->path = path ? cli_arena_strdup(call->arena, path) : NULL;
        free(path);
        const char *text =
            call->path ? csgm_workspace_text(server->workspace, call->path, &call->length) : NULL;
        call->text = text ? cli_arena_strndup(call->arena, text, call->length) : NULL;
    }
    if (call->text && place)
        call->offset =
            lsp_offset_of(call->text, call->length, lsp_read_place(place), server->is_utf8);
}

static void answer(lsp_server *server, cli_arena *arena, lsp_answer *handler, const cli_value *id,
                   const cli_value *params)
{
    cli_text text;
    cli_json json;
    lsp_call call = {.server = server, .arena = arena, .params = params, .json = &json};
    snprintf(server->problem, sizeof server->problem, "there is no such file");
    find_place(&call);
    if (!lsp_message_open(&text, &json))
        return;
    put_id(&json, id);
    int problem = handler(&call);
    if (!problem && !arena->failed) {
        lsp_message_send(&text, &json);
        return;
    }
    free(cli_text_close(&text));
    send_error(id, problem ? problem : LSP_INTERNAL_ERROR,
               problem ? server->problem : "out of memory");
}

static void notify(lsp_server *server, const char *method, const cli_value *params)
{
    static const char document[] = "textDocument/did";
    if (strcmp(method, "exit") == 0)
        server->is_over = true;
    else if (server->is_ready && strncmp(method, document, sizeof document - 1) == 0)
        lsp_document_event(server, method, params);
}

static void take_value(lsp_server *server, cli_arena *arena, const cli_value *message)
{
    const cli_value *id = cli_value_member(message, "id");
    const cli_value *params = cli_value_member(message, "params");
    const char *method = lsp_text(message, "method");
    bool is_answer = cli_value_member(message, "result") || cli_value_member(message, "error");
    if (message && message->kind == CSGM_JSON_OBJECT && !method && is_answer)
        return; /* we ask nothing */
    if (!message || message->kind != CSGM_JSON_OBJECT || !method) {
        send_error(id, LSP_INVALID_REQUEST, "a message is an object with a method");
        return;
    }
    if (!id) {
        notify(server, method, params);
        return;
    }
    lsp_answer *handler = lsp_answer_find(method);
    bool begins = strcmp(method, "initialize") == 0;
    if (!server->is_ready && !begins)
        send_error(id, LSP_NOT_INITIALIZED, "initialize comes first");
    else if (server->is_shut_down || (server->is_ready && begins))
        send_error(id, LSP_INVALID_REQUEST,
                   begins ? "initialize comes once" : "the server has been shut down");
    else if (!handler)
        send_error(id, LSP_NO_METHOD, "there is no such method");
    else
        answer(server, arena, handler, id, params);
}

static void take_message(lsp_server *server, const char *text, size_t length)
{
    cli_arena arena = {NULL, false};
    cli_value *message = NULL;
    bool too_deep = false;
    csgm_status status =
        cli_value_parse(server->context, &arena, text, length, "message", &message, &too_deep);
    if (status != CSGM_OK || arena.failed || too_deep)
        send_error(NULL, status == CSGM_OK && arena.failed ? LSP_INTERNAL_ERROR : LSP_PARSE_ERROR,
                   too_deep           ? "more brackets are nested than any message has"
                   : arena.failed     ? "out of memory"
                   : *server->problem ? server->problem
                                      : "not JSON");
    else
        take_value(server, &arena, message);
    cli_arena_reset(&arena);
}

static void serve(lsp_server *server)
{
    lsp_input input = {0};
    while (!server->is_over && lsp_input_fill(&input)) {
        lsp_frame frame = LSP_FRAME_MESSAGE;
        while (frame != LSP_FRAME_MORE && !server->is_over) {
            char *message = NULL;
            size_t length = 0;
            const char *wrong = NULL;
            frame = lsp_input_next(&input, &message, &length, &wrong);
            if (frame == LSP_FRAME_MESSAGE)
                take_message(server, message, length);
            else if (frame == LSP_FRAME_BROKEN)
                send_error(NULL, LSP_PARSE_ERROR, wrong);
            free(message);
        }
    }
    if (!server->is_over && (input.length || input.skip)) /* what the editor's log shows */
        cli_console_say(&server->app->console, CSGM_ERROR, NULL, "the input ends within a message");
    free(input.bytes);
}

/* Each check makes the same objects again: what was freed is kept, as asking the system for it anew
 * would take a third of the time of a check. */
static void keep_memory(void)
{
#ifdef M_ARENA_MAX
    mallopt(M_ARENA_MAX, 1);
    mallopt(M_TRIM_THRESHOLD, 1 << 30);
    mallopt(M_MMAP_THRESHOLD, 32 << 20);
#endif
}

static int open_server(lsp_server *server)
{
    csgm_context_options options = cli_app_context_options(server->app);
    options.threads = 1;
    options.on_diag = take_problem;
    options.user = server;
    csgm_status status = cli_scene_settings_make(server->app, &server->settings);
    if (status == CSGM_OK)
        status = csgm_context_create(&options, &server->context);
    if (status == CSGM_OK)
        status =
            csgm_workspace_create(server->context, &server->settings.options, &server->workspace);
    if (status == CSGM_OK && !lsp_checker_start(&server->checker, server->app, &server->settings))
        status = CSGM_ERR_MEMORY;
    if (status != CSGM_OK && status != CSGM_ERR_ARGUMENT)
        cli_console_say(&server->app->console, CSGM_ERROR, NULL, "cannot start: %s",
                        csgm_status_name(status));
    return cli_exit_status(status);
}

int cli_cmd_lsp(cli_app *app)
{
    lsp_server server = {.app = app};
    if (app->options->operands.count)
        return cli_usage_error(app, "an editor starts it: csgmesh lsp", "lsp takes no scene");
    if (app->options->strict && app->options->lenient)
        return cli_usage_error(app, NULL, "--strict and --lenient say the opposite: give one");
    keep_memory();
    int status = open_server(&server);
    if (status == CLI_DONE) {
        serve(&server);
        lsp_checker_stop(&server.checker);
        status = server.is_shut_down ? CLI_DONE : CLI_INPUT_AT_FAULT; /* as LSP says */
    }
    while (server.documents) {
        lsp_document *document = server.documents;
        server.documents = document->next;
        lsp_document_free(document);
    }
    csgm_workspace_destroy(server.workspace);
    csgm_context_destroy(server.context);
    cli_scene_settings_release(&server.settings);
    return status;
}
