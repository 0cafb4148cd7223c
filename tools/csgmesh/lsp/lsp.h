/* SPDX-License-Identifier: MIT
 * The language server: messages in, answers out, one thread that looks for findings meanwhile.
 */
#ifndef CLI_LSP_LSP_H
#define CLI_LSP_LSP_H

#include <pthread.h>
#include <stdatomic.h>

#include "core/cli.h"
#include "core/json.h"
#include "core/json_tree.h"
#include "core/textfile.h"
#include "csgmesh/editing.h"

/* ---- transport: frames of JSON-RPC on standard input and output ---------------------------------- */

typedef struct lsp_input {
    char *bytes;
    size_t length, capacity;
    size_t skip;  /* bytes of a message that is too large, still to come */
    bool is_lost; /* in a header that is too long */
} lsp_input;

typedef enum lsp_frame { LSP_FRAME_MORE, LSP_FRAME_MESSAGE, LSP_FRAME_BROKEN } lsp_frame;

/* Reads what has come. False: the end, or memory ran out. */
bool lsp_input_fill(lsp_input *input);
/* The next message in the bytes that have come, or what is wrong with them; both are behind it
 * then. MORE: none is complete. */
lsp_frame lsp_input_next(lsp_input *input, char **message, size_t *length, const char **wrong);

/* ---- documents -------------------------------------------------------------------------------- */

typedef struct lsp_document {
    char *uri, *path, *text;
    size_t length;
    int64_t version;
    struct lsp_document *next;
} lsp_document;

void lsp_document_free(lsp_document *document);
/* The path of a file: URI, for the caller to free; of another URI the URI itself. NULL: no memory.
 */
char *lsp_path_of(const char *uri);
/* The other way round. */
char *lsp_uri_of(const char *path);

/* Lines and characters of LSP (UTF-16, or bytes where the editor said so) and offsets in bytes. */
typedef struct lsp_place {
    uint32_t line, character;
} lsp_place;
uint32_t lsp_offset_of(const char *text, size_t length, lsp_place place, bool is_utf8);
lsp_place lsp_place_of(const char *text, size_t length, uint32_t offset, bool is_utf8);

/* ---- findings ---------------------------------------------------------------------------------- */

typedef struct lsp_checker {
    cli_app *app;
    cli_scene_settings *settings;
    pthread_t thread;
    pthread_mutex_t mutex; /* of the members up to the empty line */
    pthread_cond_t changed;
    lsp_document *waiting; /* copies, the oldest first */
    char *running;         /* the URI that is looked at */
    bool quits;
    atomic_bool cancelled; /* what is looked at is of no use any more */

    bool is_utf8, is_started;
} lsp_checker;

bool lsp_checker_start(lsp_checker *checker, cli_app *app, cli_scene_settings *settings);
/* Looks at the document as it is now; what is known or being found out of an older text of it is
 * dropped. */
void lsp_checker_ask(lsp_checker *checker, const lsp_document *document);
/* The document is closed: nothing is told of it any more. */
void lsp_checker_forget(lsp_checker *checker, const char *uri);
void lsp_checker_stop(lsp_checker *checker);

/* ---- the server --------------------------------------------------------------------------------- */

typedef struct lsp_server {
    cli_app *app;
    csgm_context *context; /* of texts and messages: its findings go nowhere but to `problem` */
    csgm_workspace *workspace;
    cli_scene_settings settings;
    lsp_checker checker;
    lsp_document *documents;
    bool is_utf8, is_ready, is_shut_down, is_over;
    bool has_snippets; /* the editor fills in what a completion leaves open */
    char problem[400]; /* the last finding of `context` */
} lsp_server;

/* A request that is being answered. */
typedef struct lsp_call {
    lsp_server *server;
    cli_arena *arena;
    const cli_value *params;
    const char *path; /* of params.textDocument, or NULL */
    const char *text; /* of that file, or NULL */
    size_t length;
    uint32_t offset; /* of params.position in it */
    cli_json *json;  /* where "result" goes: one value with that key */
} lsp_call;

/* What kinds of errors JSON-RPC and LSP know. */
enum {
    LSP_PARSE_ERROR = -32700,
    LSP_INVALID_REQUEST = -32600,
    LSP_NO_METHOD = -32601,
    LSP_INVALID_PARAMS = -32602,
    LSP_INTERNAL_ERROR = -32603,
    LSP_NOT_INITIALIZED = -32002,
    LSP_REQUEST_FAILED = -32803
};

/* 0, or an error with its words in server->problem. */
typedef int lsp_answer(lsp_call *call);
/* The handler of a request; NULL: there is none. */
lsp_answer *lsp_answer_find(const char *method);

/* textDocument/completion. */
int lsp_complete(lsp_call *call);
/* Signature and documentation. */
void lsp_put_markdown(cli_json *json, const char *key, const csgm_name *name);
/* Items for the path that is written behind include < or use <; false: none is. */
bool lsp_complete_path(lsp_call *call);

lsp_document *lsp_document_find(lsp_server *server, const char *uri);
/* textDocument/didOpen, didChange, didClose, didSave. */
void lsp_document_event(lsp_server *server, const char *method, const cli_value *params);

/* Text of a string member, or NULL; a number, or `otherwise`. */
const char *lsp_text(const cli_value *object, const char *key);
int64_t lsp_number(const cli_value *object, const char *key, int64_t otherwise);
lsp_place lsp_read_place(const cli_value *place);
void lsp_put_place(cli_json *json, const char *key, lsp_place place);
void lsp_put_range(lsp_call *call, const char *key, const char *text, size_t length, uint32_t begin,
                   uint32_t end);

/* Opens a message, closes and sends it: whole, whatever other threads send. */
bool lsp_message_open(cli_text *text, cli_json *json);
void lsp_message_send(cli_text *text, cli_json *json);

#endif
