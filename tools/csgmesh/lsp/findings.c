/* SPDX-License-Identifier: MIT
 * Findings as one types: a thread of its own reads and evaluates the latest text of each document
 * and publishes what is wrong. A newer text cancels the work for an older one, and waits a moment
 * for the next key.
 */
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "lsp/lsp.h"

enum { PATIENCE_MS = 5, KEYS_MOST = 5 };

/* One finding and its notes, as JSON that is being made. */
typedef struct report {
    const lsp_checker *checker;
    const lsp_document *document;
    cli_json *json;
    bool is_open;      /* a finding waits for its notes */
    bool is_elsewhere; /* it is about another file: the note about this one says where */
    csgm_severity severity;
    uint16_t code;
    char message[1400];
    lsp_place begin, end;
    cli_text notes; /* elements of relatedInformation */
    cli_json notes_json;
    bool has_notes;
} report;

static lsp_document *copy_document(const lsp_document *from)
{
    lsp_document *copy = calloc(1, sizeof *copy);
    if (!copy)
        return NULL;
    *copy = (lsp_document){.uri = strdup(from->uri),
                           .path = strdup(from->path),
                           .text = malloc(from->length + 1),
                           .length = from->length,
                           .version = from->version};
    if (copy->uri && copy->path && copy->text) {
        memcpy(copy->text, from->text, from->length + 1);
        return copy;
    }
    lsp_document_free(copy);
    return NULL;
}

/* ---- one text --------------------------------------------------------------------------------- */

/* Lines and columns of bytes -> of the editor. */
static lsp_place convert(const report *r, uint32_t line, uint32_t column)
{
    const char *text = r->document->text, *end = text + r->document->length, *at = text;
    for (uint32_t i = 1; i < line && at < end; i++) {
        const char *next = memchr(at, '\n', (size_t)(end - at));
        at = next ? next + 1 : end;
    }
    uint32_t offset = column > 0 ? column - 1 : 0;
    size_t room = (size_t)(end - at);
    lsp_place place =
        lsp_place_of(at, room, offset < room ? offset : (uint32_t)room, r->checker->is_utf8);
    return (lsp_place){line > 0 ? line - 1 + place.line : 0, place.character};
}

static bool is_here(const report *r, const csgm_diag *diag)
{
    return diag->source_name && strcmp(diag->source_name, r->document->path) == 0;
}

static void put_finding(report *r)
{
    if (!r->is_open)
        return;
    char code[8];
    snprintf(code, sizeof code, "%c%04u", r->severity == CSGM_ERROR ? 'E' : 'W', r->code);
    cli_json_open(r->json, NULL, '{');
    cli_json_open(r->json, "range", '{');
    lsp_put_place(r->json, "start", r->begin);
    lsp_put_place(r->json, "end", r->end);
    cli_json_end(r->json, '}');
    cli_json_count(r->json, "severity", r->severity == CSGM_ERROR ? 1 : 2);
    cli_json_string(r->json, "code", code);
    cli_json_string(r->json, "source", "csgmesh");
    cli_json_string(r->json, "message", r->message);
    cli_json_end(&r->notes_json, ']');
    char *notes = cli_text_close(&r->notes);
    if (notes && r->has_notes)
        cli_json_verbatim(r->json, "relatedInformation", notes);
    free(notes);
    cli_json_end(r->json, '}');
    r->is_open = false;
}

static void put_note(report *r, const csgm_diag *diag)
{
    char *uri = diag->source_name ? lsp_uri_of(diag->source_name) : NULL;
    if (!uri || !diag->line) {
        free(uri);
        return;
    }
    cli_json *json = &r->notes_json;
    bool here = is_here(r, diag);
    lsp_place begin =
        here ? convert(r, diag->line, diag->column) : (lsp_place){diag->line - 1, diag->column - 1};
    cli_json_open(json, NULL, '{');
    cli_json_open(json, "location", '{');
    cli_json_string(json, "uri", uri);
    cli_json_open(json, "range", '{');
    lsp_put_place(json, "start", begin);
    lsp_put_place(json, "end", begin);
    cli_json_end(json, '}');
    cli_json_end(json, '}');
    cli_json_string(json, "message", diag->message);
    cli_json_end(json, '}');
    r->has_notes = true;
    free(uri);
}

static void take_note(report *r, const csgm_diag *diag)
{
    if (!r->is_open)
        return;
    if (r->is_elsewhere && is_here(r, diag)) { /* the include that led there */
        r->begin = convert(r, diag->line, diag->column);
        r->end = convert(r, diag->end_line, diag->end_column);
        r->is_elsewhere = false;
    }
    put_note(r, diag);
}

static void take_finding(void *user, const csgm_diag *diag)
{
    report *r = user;
    if (diag->severity == CSGM_NOTE) {
        take_note(r, diag);
        return;
    }
    put_finding(r);
    bool here = is_here(r, diag);
    r->is_open = cli_text_open(&r->notes) != NULL;
    r->notes_json = cli_json_make(r->notes.out, false);
    if (!r->is_open)
        return;
    cli_json_begin(&r->notes_json, '[');
    r->has_notes = false;
    r->severity = diag->severity;
    r->code = diag->code;
    r->is_elsewhere = !here;
    r->begin = here ? convert(r, diag->line, diag->column) : (lsp_place){0, 0};
    r->end = here ? convert(r, diag->end_line, diag->end_column) : (lsp_place){0, 1};
    if (here || !diag->source_name)
        snprintf(r->message, sizeof r->message, "%s%s%s", diag->message, diag->hint ? "\n" : "",
                 diag->hint ? diag->hint : "");
    else
        snprintf(r->message, sizeof r->message, "%.300s:%u:%u: %s%s%s", diag->source_name,
                 diag->line, diag->column, diag->message, diag->hint ? "\n" : "",
                 diag->hint ? diag->hint : "");
    if (!here && diag->line)
        put_note(r, diag);
}

/* The checker whose thread this is, for the library's question. */
static bool is_cancelled(void *user)
{
    const report *r = user;
    return atomic_load(&r->checker->cancelled);
}

static csgm_status look_at(lsp_checker *checker, report *r)
{
    csgm_context_options options = cli_app_context_options(checker->app);
    csgm_scene_options scene_options = checker->settings->options;
    csgm_context *context;
    csgm_scene *scene;
    options.threads = 1;
    options.on_diag = take_finding;
    options.cancelled = is_cancelled;
    options.user = r;
    scene_options.only_check = true;
    csgm_status status = csgm_context_create(&options, &context);
    if (status != CSGM_OK)
        return status;
    status = csgm_scene_parse(context, r->document->text, r->document->length, r->document->path,
                              &scene_options, &scene);
    csgm_scene_destroy(scene);
    csgm_context_destroy(context);
    put_finding(r);
    return status;
}

static void check_document(lsp_checker *checker, const lsp_document *document)
{
    cli_text text;
    cli_json json;
    if (!lsp_message_open(&text, &json))
        return;
    report r = {.checker = checker, .document = document, .json = &json};
    cli_json_string(&json, "method", "textDocument/publishDiagnostics");
    cli_json_open(&json, "params", '{');
    cli_json_string(&json, "uri", document->uri);
    cli_json_integer(&json, "version", document->version);
    cli_json_open(&json, "diagnostics", '[');
    csgm_status status = look_at(checker, &r);
    cli_json_end(&json, ']');
    cli_json_end(&json, '}');
    pthread_mutex_lock(&checker->mutex);
    bool is_wanted = status != CSGM_CANCELLED && !atomic_load(&checker->cancelled);
    if (is_wanted)
        lsp_message_send(&text, &json);
    else
        free(cli_text_close(&text));
    pthread_mutex_unlock(&checker->mutex);
}

/* ---- the thread -------------------------------------------------------------------------------- */

/* A moment for the next key; true: one came. The mutex is held. */
static bool wait_for_more(lsp_checker *checker)
{
    struct timespec until;
    clock_gettime(CLOCK_REALTIME, &until);
    until.tv_nsec += PATIENCE_MS * 1000000;
    if (until.tv_nsec >= 1000000000) {
        until.tv_nsec -= 1000000000;
        until.tv_sec++;
    }
    return pthread_cond_timedwait(&checker->changed, &checker->mutex, &until) == 0;
}

static void *run_checker(void *user)
{
    lsp_checker *checker = user;
    pthread_mutex_lock(&checker->mutex);
    while (!checker->quits) {
        if (!checker->waiting) {
            pthread_cond_wait(&checker->changed, &checker->mutex);
            continue;
        }
        for (int keys = 0; keys < KEYS_MOST && !checker->quits && wait_for_more(checker);)
            keys++;
        lsp_document *document = checker->waiting;
        if (!document || checker->quits)
            continue;
        checker->waiting = document->next;
        checker->running = document->uri;
        atomic_store(&checker->cancelled, false);
        pthread_mutex_unlock(&checker->mutex);
        check_document(checker, document);
        pthread_mutex_lock(&checker->mutex);
        checker->running = NULL;
        lsp_document_free(document);
    }
    pthread_mutex_unlock(&checker->mutex);
    return NULL;
}

bool lsp_checker_start(lsp_checker *checker, cli_app *app, cli_scene_settings *settings)
{
    *checker = (lsp_checker){.app = app, .settings = settings};
    pthread_mutex_init(&checker->mutex, NULL);
    pthread_cond_init(&checker->changed, NULL);
    checker->is_started = pthread_create(&checker->thread, NULL, run_checker, checker) == 0;
    return checker->is_started;
}

/* Of this document nothing waits or runs any more. The mutex is held. */
static void drop_document(lsp_checker *checker, const char *uri)
{
    for (lsp_document **link = &checker->waiting; *link;) {
        lsp_document *document = *link;
        if (strcmp(document->uri, uri) == 0) {
            *link = document->next;
            lsp_document_free(document);
        } else {
            link = &document->next;
        }
    }
    if (checker->running && strcmp(checker->running, uri) == 0)
        atomic_store(&checker->cancelled, true);
}

void lsp_checker_ask(lsp_checker *checker, const lsp_document *document)
{
    lsp_document *copy = copy_document(document);
    pthread_mutex_lock(&checker->mutex);
    drop_document(checker, document->uri);
    lsp_document **link = &checker->waiting;
    while (*link)
        link = &(*link)->next;
    *link = copy;
    pthread_cond_broadcast(&checker->changed);
    pthread_mutex_unlock(&checker->mutex);
}

void lsp_checker_forget(lsp_checker *checker, const char *uri)
{
    cli_text text;
    cli_json json;
    pthread_mutex_lock(&checker->mutex);
    drop_document(checker, uri);
    pthread_mutex_unlock(&checker->mutex);
    if (!lsp_message_open(&text, &json))
        return;
    cli_json_string(&json, "method", "textDocument/publishDiagnostics");
    cli_json_open(&json, "params", '{');
    cli_json_string(&json, "uri", uri);
    cli_json_open(&json, "diagnostics", '[');
    cli_json_end(&json, ']');
    cli_json_end(&json, '}');
    lsp_message_send(&text, &json);
}

void lsp_checker_stop(lsp_checker *checker)
{
    pthread_mutex_lock(&checker->mutex);
    checker->quits = true;
    atomic_store(&checker->cancelled, true);
    pthread_cond_broadcast(&checker->changed);
    pthread_mutex_unlock(&checker->mutex);
    if (checker->is_started)
        pthread_join(checker->thread, NULL);
    while (checker->waiting) {
        lsp_document *document = checker->waiting;
        checker->waiting = document->next;
        lsp_document_free(document);
    }
    pthread_cond_destroy(&checker->changed);
    pthread_mutex_destroy(&checker->mutex);
}
