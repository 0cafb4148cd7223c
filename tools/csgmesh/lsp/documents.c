/* SPDX-License-Identifier: MIT
 * The texts that the editor has open, and the ways between URIs and paths, places and offsets.
 */
#include <stdlib.h>
#include <string.h>

#include "lsp/lsp.h"

enum { LARGEST_TEXT = 64 << 20 };

/* ---- URIs ------------------------------------------------------------------------------------ */

static int hex_value(char c)
{
    return c >= '0' && c <= '9'   ? c - '0'
           : c >= 'a' && c <= 'f' ? c - 'a' + 10
           : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                  : -1;
}

char *lsp_path_of(const char *uri)
{
    static const char scheme[] = "file://";
    if (strncmp(uri, scheme, sizeof scheme - 1) != 0)
        return strdup(uri);
    const char *from = strchr(uri + sizeof scheme - 1, '/'); /* behind the host */
    char *path = strdup(from ? from : uri), *to = path;
    for (const char *c = path; path && *c; c++) {
        int high = *c == '%' ? hex_value(c[1]) : -1, low = high >= 0 ? hex_value(c[2]) : -1;
        if (low >= 0 && (high || low)) {
            *to++ = (char)(high << 4 | low);
            c += 2;
        } else {
            *to++ = *c;
        }
    }
    if (path)
        *to = '\0';
    return path;
}

char *lsp_uri_of(const char *path)
{
    static const char plain[] =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-._~/";
    char *uri = malloc(3 * strlen(path) + 8), *to = uri;
    if (!uri)
        return NULL;
    if (*path != '/')
        return strcpy(uri, path); /* it was no file */
    to += sprintf(to, "file://");
    for (; *path; path++)
        if (strchr(plain, *path))
            *to++ = *path;
        else
            to += sprintf(to, "%%%02X", (unsigned)(unsigned char)*path);
    *to = '\0';
    return uri;
}

/* ---- places ---------------------------------------------------------------------------------- */

/* Bytes of the character at `text`, and how many units it is for the editor. */
static size_t step(const char *text, size_t room, bool is_utf8, uint32_t *units)
{
    unsigned char c = (unsigned char)*text;
    size_t bytes = c < 0xC2 ? 1 : c < 0xE0 ? 2 : c < 0xF0 ? 3 : c < 0xF5 ? 4 : 1;
    for (size_t i = 1; i < bytes; i++)
        if (i >= room || (text[i] & 0xC0) != 0x80)
            bytes = 1;
    *units = is_utf8 ? (uint32_t)bytes : bytes == 4 ? 2 : 1;
    return bytes;
}

uint32_t lsp_offset_of(const char *text, size_t length, lsp_place place, bool is_utf8)
{
    size_t at = 0;
    for (uint32_t line = 0; line < place.line; line++) {
        const char *end = memchr(text + at, '\n', length - at);
        if (!end)
            return (uint32_t)length;
        at = (size_t)(end - text) + 1;
    }
    for (uint32_t done = 0, units; done < place.character && at < length && text[at] != '\n' &&
                                   !(text[at] == '\r' && at + 1 < length && text[at + 1] == '\n');
         done += units)
        at += step(text + at, length - at, is_utf8, &units);
    return (uint32_t)at;
}

lsp_place lsp_place_of(const char *text, size_t length, uint32_t offset, bool is_utf8)
{
    lsp_place place = {0, 0};
    size_t at = 0;
    offset = offset < length ? offset : (uint32_t)length;
    for (const char *end; (end = memchr(text + at, '\n', offset - at)); place.line++)
        at = (size_t)(end - text) + 1;
    for (uint32_t units; at < offset; place.character += units)
        at += step(text + at, length - at, is_utf8, &units);
    return place;
}

/* ---- members of messages --------------------------------------------------------------------- */

const char *lsp_text(const cli_value *object, const char *key)
{
    const cli_value *value = cli_value_member(object, key);
    return value && value->kind == CSGM_JSON_STRING ? value->text : NULL;
}

int64_t lsp_number(const cli_value *object, const char *key, int64_t otherwise)
{
    const cli_value *value = cli_value_member(object, key);
    return value && value->kind == CSGM_JSON_NUMBER ? strtoll(value->text, NULL, 10) : otherwise;
}

lsp_place lsp_read_place(const cli_value *place)
{
    int64_t line = lsp_number(place, "line", 0), character = lsp_number(place, "character", 0);
    return (lsp_place){line < 0           ? 0
                       : line > INT32_MAX ? INT32_MAX
                                          : (uint32_t)line,
                       character < 0           ? 0
                       : character > INT32_MAX ? INT32_MAX
                                               : (uint32_t)character};
}

void lsp_put_place(cli_json *json, const char *key, lsp_place place)
{
    cli_json_open(json, key, '{');
    cli_json_count(json, "line", place.line);
    cli_json_count(json, "character", place.character);
    cli_json_end(json, '}');
}

void lsp_put_range(lsp_call *call, const char *key, const char *text, size_t length, uint32_t begin,
                   uint32_t end)
{
    bool is_utf8 = call->server->is_utf8;
    cli_json_open(call->json, key, '{');
    lsp_put_place(call->json, "start", lsp_place_of(text, length, begin, is_utf8));
    lsp_put_place(call->json, "end", lsp_place_of(text, length, end, is_utf8));
    cli_json_end(call->json, '}');
}

/* ---- documents ------------------------------------------------------------------------------- */

void lsp_document_free(lsp_document *document)
{
    free(document->uri);
    free(document->path);
    free(document->text);
    free(document);
}

lsp_document *lsp_document_find(lsp_server *server, const char *uri)
{
    lsp_document *document = server->documents;
    while (document && strcmp(document->uri, uri) != 0)
        document = document->next;
    return document;
}

static bool replace(lsp_document *document, uint32_t begin, uint32_t end, const cli_value *text)
{
    size_t added = text->length, rest = document->length - end;
    size_t length = begin + added + rest;
    char *fresh = length <= LARGEST_TEXT ? malloc(length + 1) : NULL;
    if (!fresh)
        return false;
    memcpy(fresh, document->text, begin);
    memcpy(fresh + begin, text->text, added);
    memcpy(fresh + begin + added, document->text + end, rest);
    fresh[length] = '\0';
    free(document->text);
    document->text = fresh;
    document->length = length;
    return true;
}

static void open_document(lsp_server *server, const cli_value *item)
{
    const char *uri = lsp_text(item, "uri");
    const cli_value *text = cli_value_member(item, "text");
    if (!uri || !text || text->kind != CSGM_JSON_STRING)
        return;
    lsp_document *document = lsp_document_find(server, uri);
    if (!document && (document = calloc(1, sizeof *document))) {
        document->uri = strdup(uri);
        document->path = lsp_path_of(uri);
        document->text = calloc(1, 1);
        document->next = server->documents;
        server->documents = document;
    }
    if (!document || !document->uri || !document->path || !document->text) {
        cli_console_say(&server->app->console, CSGM_ERROR, NULL, "out of memory");
        exit(CLI_TROUBLE);
    }
    replace(document, 0, (uint32_t)document->length, text);
    document->version = lsp_number(item, "version", 0);
}

static void change_document(lsp_server *server, lsp_document *document, const cli_value *params)
{
    const cli_value *changes = cli_value_member(params, "contentChanges");
    for (const cli_value *c = changes ? changes->first : NULL; c; c = c->next) {
        const cli_value *range = cli_value_member(c, "range");
        const cli_value *text = cli_value_member(c, "text");
        uint32_t begin = 0, end = (uint32_t)document->length;
        if (range && range->kind == CSGM_JSON_OBJECT) {
            begin =
                lsp_offset_of(document->text, document->length,
                              lsp_read_place(cli_value_member(range, "start")), server->is_utf8);
            end = lsp_offset_of(document->text, document->length,
                                lsp_read_place(cli_value_member(range, "end")), server->is_utf8);
        }
        if (text && text->kind == CSGM_JSON_STRING)
            replace(document, begin, end < begin ? begin : end, text);
    }
    document->version =
        lsp_number(cli_value_member(params, "textDocument"), "version", document->version);
}

static void close_document(lsp_server *server, lsp_document *document)
{
    lsp_document **link = &server->documents;
    while (*link != document)
        link = &(*link)->next;
    *link = document->next;
    csgm_workspace_close(server->workspace, document->path);
    lsp_checker_forget(&server->checker, document->uri);
    lsp_document_free(document);
}

void lsp_document_event(lsp_server *server, const char *method, const cli_value *params)
{
    const cli_value *item = cli_value_member(params, "textDocument");
    const char *uri = lsp_text(item, "uri");
    if (!uri)
        return;
    if (strcmp(method, "textDocument/didOpen") == 0)
        open_document(server, item);
    lsp_document *document = lsp_document_find(server, uri);
    if (!document)
        return;
    if (strcmp(method, "textDocument/didClose") == 0) {
        close_document(server, document);
        return;
    }
    if (strcmp(method, "textDocument/didSave") == 0) { /* others may include it */
        for (lsp_document *d = server->documents; d; d = d->next)
            lsp_checker_ask(&server->checker, d);
        return;
    }
    if (strcmp(method, "textDocument/didChange") == 0)
        change_document(server, document, params);
    csgm_workspace_open(server->workspace, document->path, document->text, document->length);
    lsp_checker_ask(&server->checker, document);
}
