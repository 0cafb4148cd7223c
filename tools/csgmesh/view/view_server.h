/* SPDX-License-Identifier: MIT
 * The page and what it asks for, over HTTP on this machine's loopback address alone. Every address
 * begins with a random token, and requests must name this host: a page from elsewhere that the
 * same browser shows can neither guess the one nor pass for the other (DNS rebinding).
 *
 *   GET  /TOKEN/              the page
 *   GET  /TOKEN/state?after=N the state once it is later than N; 204 after a while
 *   GET  /TOKEN/model?number=N    the model of that number; 404 once there is a later one
 *   GET  /TOKEN/file?format=stl   the scene as a file; 404 with words where it cannot be made
 *   POST /TOKEN/set           lines NAME=EXPR: the values that the page sets
 */
#ifndef CLI_VIEW_SERVER_H
#define CLI_VIEW_SERVER_H

#include "core/cli.h"
#include "view/view_build.h"

typedef struct view_server view_server;

/* One line for --version: what serves. */
const char *view_server_feature(void);
/* port 0: any that is free. NULL after a report; the address of the page is written to url. */
view_server *view_server_start(cli_app *app, uint16_t port, view_store *store,
                               view_builder *builder, char *url, size_t size);
/* After view_store_end: nobody waits any more. */
void view_server_stop(view_server *server);

#endif
