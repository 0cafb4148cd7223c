/* SPDX-License-Identifier: MIT
 * csgmesh mesh on a thread of its own, whose output is a pipe; see view_file.h.
 */
#include "view/view_file.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "core/options.h"
#include "core/textfile.h"
#include "mesh/drawings.h"

/* That of a connection is too small, and so is that of a new thread with some C libraries. */
static const size_t STACK_BYTES = (size_t)8 << 20;

typedef struct making {
    cli_app app;         /* first: cancelled() gets it */
    cli_options options; /* its own */
    view_store *store;
    cli_text said;
    int out; /* the end of the pipe that is written to; held so that it does not end early */
    int status;
} making;

const char *view_file_format(const char *name)
{
    csgm_format mesh = csgm_format_from_name(name);
    bool is_written = mesh != CSGM_FORMAT_AUTO
                          ? csgm_format_available(mesh, false)
                          : csgm_drawing_format_available(csgm_drawing_format_from_name(name));
    if (!is_written)
        return NULL;
    return cli_drawings_or_mesh_name(name);
}

static bool is_cancelled(void *app)
{
    const making *m = app;
    return view_store_is_ending(m->store);
}

static void *mesh_to_pipe(void *user)
{
    making *m = user;
    m->status = cli_cmd_mesh(&m->app);
    cli_console_flush(&m->app.console);
    csgm_context_destroy(m->app.context);
    close(m->out);
    return NULL;
}

/* Until its end; what there is no memory for is dropped, and *bytes is NULL. */
static void read_all(int in, char **bytes, size_t *length)
{
    enum { LEAST = 1 << 16 };
    char nowhere[4096];
    size_t capacity = 0;
    bool fits = true;
    *bytes = NULL;
    *length = 0;
    for (ssize_t got = 1; got > 0 || (got < 0 && errno == EINTR);) {
        if (fits && *length == capacity) {
            capacity = capacity ? 2 * capacity : LEAST;
            char *more = realloc(*bytes, capacity);
            fits = more != NULL;
            *bytes = fits ? more : *bytes;
        }
        got = fits ? read(in, *bytes + *length, capacity - *length)
                   : read(in, nowhere, sizeof nowhere);
        *length += got > 0 && fits ? (size_t)got : 0;
    }
    if (!fits) {
        free(*bytes);
        *bytes = NULL;
    }
}

/* What was asked for, to the pipe; its options stay those of the command line. */
static void prepare(making *m, const char *format, const char **path)
{
    cli_options *o = m->app.options;
    o->command = CLI_MESH;
    o->outputs = (cli_list){path, 1};
    o->format = format;
    o->no_sync = true;
    m->app.cancelled = is_cancelled;
    m->app.start_s = cli_now_s();
    m->app.console = cli_console_make();
    cli_console_configure(&m->app.console, o);
    m->app.console.out = m->said.out;
    m->app.console.json = m->app.console.quiet = false;
    m->app.console.is_terminal = m->app.console.color = false;
}

static bool start(making *m, pthread_t *thread)
{
    pthread_attr_t attributes;
    if (pthread_attr_init(&attributes) != 0)
        return false;
    bool started = pthread_attr_setstacksize(&attributes, STACK_BYTES) == 0 &&
                   pthread_create(thread, &attributes, mesh_to_pipe, m) == 0;
    pthread_attr_destroy(&attributes);
    return started;
}

static view_file make_through(making *m, int in)
{
    view_file file = {.bytes = NULL};
    pthread_t thread;
    if (!start(m, &thread)) {
        close(m->out);
        return file;
    }
    read_all(in, &file.bytes, &file.length);
    pthread_join(thread, NULL);
    if (m->status != CLI_DONE) {
        free(file.bytes);
        file.bytes = NULL;
    }
    return file;
}

view_file view_file_make(view_builder *builder, const char *format)
{
    view_file file = {.bytes = NULL};
    making m = {.options = *builder->app->options, .store = builder->store};
    view_values values;
    int ends[2];
    m.app.options = &m.options;
    if (view_values_take(builder, &m.options, &values) && cli_text_open(&m.said)) {
        if (pipe(ends) == 0) {
            char name[32];
            const char *path = name;
            snprintf(name, sizeof name, "/dev/fd/%d", ends[1]);
            prepare(&m, format, &path);
            m.out = ends[1];
            file = make_through(&m, ends[0]);
            close(ends[0]);
        }
        char *words = cli_text_close(&m.said);
        if (file.bytes)
            free(words);
        else
            file.problem = words;
    }
    view_values_release(&values);
    return file;
}
