/* SPDX-License-Identifier: MIT
 * GNU libmicrohttpd, a thread for each connection; see view_server.h.
 */
#include "view/view_server.h"

#include "core/options.h"
#include "view/view_file.h"

#ifndef CLI_HAS_MICROHTTPD

const char *view_server_feature(void)
{
    return "without libmicrohttpd (csgmesh view)";
}

view_server *view_server_start(cli_app *app, uint16_t port, view_store *store,
                               view_builder *builder, char *url, size_t size)
{
    (void)port, (void)store, (void)builder, (void)url, (void)size;
    cli_console_say(&app->console, CSGM_ERROR, "csgmesh render draws pictures",
                    "this build cannot show scenes (made without libmicrohttpd)");
    return NULL;
}

void view_server_stop(view_server *server)
{
    (void)server;
}

#else

#include <arpa/inet.h>
#include <errno.h>
#include <fcntl.h>
#include <microhttpd.h>
#include <netinet/in.h>
#include <stdlib.h>
#include <string.h>
#include <sys/random.h>
#include <sys/socket.h>
#include <unistd.h>

static const unsigned char page[] = {
#include <view_page.inc> /* made by ../page/embed.py of page/ */
};

static const double WAIT_S = 20; /* then the page asks again */
enum { TOKEN_BYTES = 16, LARGEST_BODY = 1 << 16, MOST_CONNECTIONS = 64, IDLE_S = 60 };
static const size_t STACK_BYTES = (size_t)256
                                  << 10; /* of a connection's thread, which copies only */

struct view_server {
    struct MHD_Daemon *daemon;
    view_store *store;
    view_builder *builder;
    pthread_mutex_t making; /* one file at a time */
    char token[2 * TOKEN_BYTES + 1];
    char hosts[2][32]; /* that requests may name */
};

/* What has come of a request. */
typedef struct body {
    char *text;
    size_t length;
    bool is_too_long;
} body;

const char *view_server_feature(void)
{
    return "with libmicrohttpd " CLI_HAS_MICROHTTPD " (csgmesh view)";
}

/* ---- answers ---------------------------------------------------------------------------------- */

/* Takes what bytes point to, from malloc. The page runs its own script and style, and loads nothing
 * from anywhere else. disposition: NULL, or how a file is to be kept. */
static enum MHD_Result answer_file(struct MHD_Connection *connection, unsigned status,
                                   const char *type, char *bytes, size_t length,
                                   const char *disposition)
{
    struct MHD_Response *response =
        MHD_create_response_from_buffer(length, bytes, MHD_RESPMEM_MUST_FREE);
    if (!response) {
        free(bytes);
        return MHD_NO;
    }
    if (disposition)
        MHD_add_response_header(response, "Content-Disposition", disposition);
    MHD_add_response_header(response, "Content-Type", type);
    MHD_add_response_header(response, "Cache-Control", "no-store");
    MHD_add_response_header(response, "X-Content-Type-Options", "nosniff");
    MHD_add_response_header(response, "Referrer-Policy", "no-referrer");
    MHD_add_response_header(response, "Content-Security-Policy",
                            "default-src 'none'; script-src 'unsafe-inline'; style-src "
                            "'unsafe-inline'; img-src data:; connect-src 'self'; "
                            "frame-ancestors 'none'; base-uri 'none'; form-action 'none'");
    enum MHD_Result result = MHD_queue_response(connection, status, response);
    MHD_destroy_response(response);
    return result;
}

static enum MHD_Result answer(struct MHD_Connection *connection, unsigned status, const char *type,
                              char *bytes, size_t length)
{
    return answer_file(connection, status, type, bytes, length, NULL);
}

static enum MHD_Result say(struct MHD_Connection *connection, unsigned status, const char *text)
{
    char *copy = strdup(text);
    return copy ? answer(connection, status, "text/plain; charset=utf-8", copy, strlen(copy))
                : MHD_NO;
}

static enum MHD_Result send_page(struct MHD_Connection *connection)
{
    char *copy = malloc(sizeof page);
    if (!copy)
        return MHD_NO;
    memcpy(copy, page, sizeof page);
    return answer(connection, MHD_HTTP_OK, "text/html; charset=utf-8", copy, sizeof page);
}

static uint64_t number_of(struct MHD_Connection *connection, const char *key)
{
    const char *text = MHD_lookup_connection_value(connection, MHD_GET_ARGUMENT_KIND, key);
    return text ? strtoull(text, NULL, 10) : 0;
}

static enum MHD_Result send_state(const view_server *s, struct MHD_Connection *connection)
{
    char *state = view_store_wait(s->store, number_of(connection, "after"), WAIT_S);
    return state ? answer(connection, MHD_HTTP_OK, "application/json", state, strlen(state))
                 : say(connection, MHD_HTTP_NO_CONTENT, "");
}

static enum MHD_Result send_model(const view_server *s, struct MHD_Connection *connection)
{
    size_t length;
    char *model = view_store_copy_model(s->store, number_of(connection, "number"), &length);
    return model ? answer(connection, MHD_HTTP_OK, "application/octet-stream", model, length)
                 : say(connection, MHD_HTTP_NOT_FOUND, "There is a later model.\n");
}

/* "attachment" with the scene's name and another ending (RFC 6266, RFC 5987). */
static void name_file(const cli_options *options, const char *format, char *out, size_t size)
{
    const char *name = cli_file_name(options->operands.items[0]), *dot = strrchr(name, '.');
    size_t length = dot && dot != name ? (size_t)(dot - name) : strlen(name);
    size_t at = (size_t)snprintf(out, size, "attachment; filename*=UTF-8''");
    for (size_t i = 0; i < length && at + 16 < size; i++)
        at += (size_t)snprintf(out + at, size - at, cli_name_length(name + i) ? "%c" : "%%%02X",
                               (unsigned char)name[i]);
    snprintf(out + at, size - at, ".%s", format);
}

/* A connection that is silent while the file is made is not idle. */
static enum MHD_Result send_file(view_server *s, struct MHD_Connection *connection)
{
    char disposition[1024];
    const char *asked = MHD_lookup_connection_value(connection, MHD_GET_ARGUMENT_KIND, "format");
    const char *format = asked ? view_file_format(asked) : NULL;
    if (!format)
        return say(connection, MHD_HTTP_NOT_FOUND, "There is no such format.\n");
    MHD_set_connection_option(connection, MHD_CONNECTION_OPTION_TIMEOUT, 0U);
    pthread_mutex_lock(&s->making);
    view_file file = view_file_make(s->builder, format);
    pthread_mutex_unlock(&s->making);
    MHD_set_connection_option(connection, MHD_CONNECTION_OPTION_TIMEOUT, (unsigned)IDLE_S);
    if (!file.bytes) {
        enum MHD_Result result =
            say(connection, MHD_HTTP_NOT_FOUND,
                file.problem && *file.problem ? file.problem : "Out of memory.\n");
        free(file.problem);
        return result;
    }
    name_file(s->builder->app->options, format, disposition, sizeof disposition);
    return answer_file(connection, MHD_HTTP_OK, "application/octet-stream", file.bytes, file.length,
                       disposition);
}

/* ---- questions -------------------------------------------------------------------------------- */

/* The rest of the address behind the token; NULL: it has another one. */
static const char *path_of(const view_server *s, const char *url)
{
    size_t length = strlen(s->token);
    return url[0] == '/' && !strncmp(url + 1, s->token, length) && url[1 + length] == '/'
               ? url + 1 + length
               : NULL;
}

static bool names_us(const view_server *s, struct MHD_Connection *connection)
{
    const char *host = MHD_lookup_connection_value(connection, MHD_HEADER_KIND, "Host");
    return host && (!strcmp(host, s->hosts[0]) || !strcmp(host, s->hosts[1]));
}

static enum MHD_Result set_values(const view_server *s, struct MHD_Connection *connection,
                                  const body *b)
{
    if (b->is_too_long)
        return say(connection, MHD_HTTP_CONTENT_TOO_LARGE, "These are too many values.\n");
    return view_builder_set(s->builder, b->text ? b->text : "", b->length)
               ? say(connection, MHD_HTTP_NO_CONTENT, "")
               : say(connection, MHD_HTTP_INTERNAL_SERVER_ERROR, "Out of memory.\n");
}

static enum MHD_Result reply(view_server *s, struct MHD_Connection *connection, const char *url,
                             const char *method, const body *b)
{
    const char *path = path_of(s, url);
    bool is_get = !strcmp(method, "GET");
    if (!names_us(s, connection))
        return say(connection, MHD_HTTP_FORBIDDEN,
                   "This is no address of csgmesh view: use the one that it printed.\n");
    if (!path)
        return say(connection, MHD_HTTP_NOT_FOUND,
                   "Open the address that csgmesh view printed; it changes with each start.\n");
    if (is_get && !strcmp(path, "/"))
        return send_page(connection);
    if (is_get && !strcmp(path, "/state"))
        return send_state(s, connection);
    if (is_get && !strcmp(path, "/model"))
        return send_model(s, connection);
    if (is_get && !strcmp(path, "/file"))
        return send_file(s, connection);
    if (!strcmp(method, "POST") && !strcmp(path, "/set"))
        return set_values(s, connection, b);
    return say(connection, MHD_HTTP_NOT_FOUND, "There is nothing here.\n");
}

/* More than there is room for is read and dropped: so the answer is heard. */
static bool take_body(body *b, const char *bytes, size_t length)
{
    b->is_too_long = b->is_too_long || b->length + length > LARGEST_BODY;
    if (b->is_too_long)
        return true;
    char *text = realloc(b->text, b->length + length + 1);
    if (!text)
        return false;
    memcpy(text + b->length, bytes, length);
    b->text = text;
    b->length += length;
    return true;
}

/* Called when the headers are there, for each piece of a body, and at its end. */
static enum MHD_Result take_request(void *user, struct MHD_Connection *connection, const char *url,
                                    const char *method, const char *version, const char *bytes,
                                    size_t *length, void **request)
{
    (void)version;
    body *b = *request;
    if (!b) {
        *request = b = calloc(1, sizeof *b);
        return b ? MHD_YES : MHD_NO;
    }
    if (*length) {
        bool done = take_body(b, bytes, *length);
        *length = 0;
        return done ? MHD_YES : MHD_NO;
    }
    return reply(user, connection, url, method, b);
}

static void end_request(void *user, struct MHD_Connection *connection, void **request,
                        enum MHD_RequestTerminationCode why)
{
    (void)user, (void)connection, (void)why;
    body *b = *request;
    if (b)
        free(b->text);
    free(b);
    *request = NULL;
}

/* ---- starting --------------------------------------------------------------------------------- */

static bool make_token(char token[2 * TOKEN_BYTES + 1])
{
    unsigned char bytes[TOKEN_BYTES];
    bool done = getentropy(bytes, sizeof bytes) == 0; /* /dev is outside of --root */
    for (size_t i = 0; done && i < sizeof bytes; i++)
        snprintf(token + 2 * i, 3, "%02x", bytes[i]);
    return done;
}

/* A socket of our own, so that the reason is known where there is none. -1 with errno. */
static int listen_on(uint16_t port, uint16_t *got)
{
    struct sockaddr_in address = {.sin_family = AF_INET, .sin_port = htons(port)};
    socklen_t size = sizeof address;
    int again = 1, fd = socket(AF_INET, SOCK_STREAM, 0);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (fd < 0)
        return -1;
    fcntl(fd, F_SETFD, FD_CLOEXEC);
    setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &again, sizeof again);
    if (bind(fd, (struct sockaddr *)&address, sizeof address) == 0 &&
        listen(fd, MOST_CONNECTIONS) == 0 &&
        getsockname(fd, (struct sockaddr *)&address, &size) == 0) {
        *got = ntohs(address.sin_port);
        return fd;
    }
    int reason = errno;
    close(fd);
    errno = reason;
    return -1;
}

static view_server *refuse(cli_app *app, view_server *server, int fd, const char *reason)
{
    if (fd >= 0)
        close(fd);
    free(server);
    cli_console_say(&app->console, CSGM_ERROR, NULL, "cannot show the scene: %s", reason);
    return NULL;
}

view_server *view_server_start(cli_app *app, uint16_t port, view_store *store,
                               view_builder *builder, char *url, size_t size)
{
    uint16_t got = 0;
    int fd = listen_on(port, &got);
    if (fd < 0 && errno == EADDRINUSE) {
        cli_console_say(&app->console, CSGM_ERROR,
                        "another --port, or none: then a free one is taken", "port %u is in use",
                        (unsigned)port);
        return NULL;
    }
    if (fd < 0)
        return refuse(app, NULL, fd, strerror(errno));
    view_server *s = calloc(1, sizeof *s);
    if (!s)
        return refuse(app, s, fd, "out of memory");
    s->store = store;
    s->builder = builder;
    pthread_mutex_init(&s->making, NULL);
    if (!make_token(s->token))
        return refuse(app, s, fd, "the system has no random numbers");
    snprintf(s->hosts[0], sizeof s->hosts[0], "127.0.0.1:%u", (unsigned)got);
    snprintf(s->hosts[1], sizeof s->hosts[1], "localhost:%u", (unsigned)got);
    snprintf(url, size, "http://%s/%s/", s->hosts[0], s->token);
    s->daemon = MHD_start_daemon(MHD_USE_THREAD_PER_CONNECTION | MHD_USE_INTERNAL_POLLING_THREAD, 0,
                                 NULL, NULL, take_request, s, MHD_OPTION_LISTEN_SOCKET, fd,
                                 MHD_OPTION_NOTIFY_COMPLETED, end_request, NULL,
                                 MHD_OPTION_CONNECTION_LIMIT, (unsigned)MOST_CONNECTIONS,
                                 MHD_OPTION_CONNECTION_TIMEOUT, (unsigned)IDLE_S,
                                 MHD_OPTION_THREAD_STACK_SIZE, STACK_BYTES, MHD_OPTION_END);
    return s->daemon ? s : refuse(app, s, fd, "the server did not start");
}

void view_server_stop(view_server *server)
{
    if (!server)
        return;
    MHD_stop_daemon(server->daemon);
    pthread_mutex_destroy(&server->making);
    free(server);
}

#endif
