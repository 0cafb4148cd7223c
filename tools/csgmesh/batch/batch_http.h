/* SPDX-License-Identifier: MIT
 * Requests to one HTTP server, from many threads: GET and PUT, by libcurl, which is loaded when it
 * is first used; the only file that knows it is batch_http.c. Nothing here reports.
 */
#ifndef CLI_BATCH_HTTP_H
#define CLI_BATCH_HTTP_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct batch_http batch_http;

enum { BATCH_HTTP_REASON = 320 };

/* "with libcurl 7.88.1 (...)" or "without ...", a line of --version. */
const char *batch_http_feature(void);
bool batch_http_available(void);
/* Is it an address rather than a folder? */
bool batch_http_is_address(const char *text);

typedef struct batch_http_options {
    const char *address; /* "http://host:8080/path"; a user and password in it are not shown */
    const char *token;   /* of Authorization: Bearer, or NULL */
    double patience_s;   /* for a connection, and for a server that says next to nothing */
    /* Asked while a request is at work, on its thread: whether to give it up. */
    bool (*is_over)(void *user);
    void *user;
} batch_http_options;

/* NULL with the reason. */
batch_http *batch_http_open(const batch_http_options *options, char reason[BATCH_HTTP_REASON]);
void batch_http_close(batch_http *http);
/* The address without what must not be seen. */
const char *batch_http_shown(const batch_http *http);

/* Takes the bytes of the answer; false: no more of them are wanted, and the request fails. */
typedef bool batch_http_sink(void *user, const char *bytes, size_t count);

/* The status of the answer, such as 200 or 404; 0: none came whole, with the reason ("" where the
 * sink or is_over has ended it). path: "/ac/...". expected: about how many bytes, for the most time
 * that it may take. The sink gets the bytes of an answer of 200 alone. */
long batch_http_get(batch_http *http, const char *path, uint64_t expected, batch_http_sink *sink,
                    void *user, char reason[BATCH_HTTP_REASON]);
/* `count` bytes, from memory, or from the file's descriptor where `bytes` is NULL. */
long batch_http_put(batch_http *http, const char *path, const char *bytes, int fd, uint64_t count,
                    char reason[BATCH_HTTP_REASON]);

#endif
