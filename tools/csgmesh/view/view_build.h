/* SPDX-License-Identifier: MIT
 * Scene to what the page shows, on a thread of its own: the scene is read, meshed coarsely where
 * the last mesh took long, then as the options say. What is asked for later ends what is under way.
 */
#ifndef CLI_VIEW_BUILD_H
#define CLI_VIEW_BUILD_H

#include "core/cli.h"
#include "core/follow.h"
#include "view/view_store.h"

typedef struct view_defines {
    char **items; /* "radius=50" */
    size_t count;
} view_defines;

typedef struct view_builder {
    const cli_app *app; /* its options; what the page sets comes after its -D */
    view_store *store;
    pthread_t thread;
    pthread_mutex_t lock; /* of all below */
    pthread_cond_t asked;
    uint64_t wanted, begun; /* numbers of requests */
    bool is_ending;
    view_defines defines;
    cli_looked files; /* that the scene was looked for in */
    double read_s;    /* of cli_watch_clock_s(): when reading began */
    bool has_files;   /* since they were taken last */
} view_builder;

/* -D's and the page's: the last one wins. */
typedef struct view_values {
    view_defines all;
    size_t given; /* the first so many are the command line's own; the others are copies */
} view_values;

/* The values as they are now, also as the options' defines. false: out of memory. Release them in
 * either case. */
bool view_values_take(view_builder *builder, cli_options *options, view_values *out);
void view_values_release(view_values *values);

/* false: out of memory, or the system has no more threads. */
bool view_builder_begin(view_builder *builder, const cli_app *app, view_store *store);
/* Ends what is under way. */
void view_builder_end(view_builder *builder);

/* A file has changed: once more, with the same values. */
void view_builder_ask(view_builder *builder);
/* The page sets values: lines NAME=EXPR. false: out of memory. */
bool view_builder_set(view_builder *builder, const char *lines, size_t length);

/* Hands the files to the watch where the list is new. */
void view_builder_watch(view_builder *builder, cli_watch *watch);

#endif
