/* SPDX-License-Identifier: MIT
 * Work in a child; see repeat.h. The child tells its parent through a pipe of each file that it
 * looks for: a letter for the kind, the path, a NUL. The parent tells it through memory that they
 * share that its work is of no use any more: under --sandbox there are no signals to others.
 */
#include "core/repeat.h"

#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/follow.h"
#include "core/interrupt.h"
#include "core/options.h"

enum { LONGEST_LINE = 1 << 16 };

typedef struct repeater {
    cli_app *app;
    int (*work)(cli_app *app);
    atomic_bool *is_outdated; /* shared with the child */
    pid_t child;              /* 0: none is at work */
    int lines;                /* from the child */
    double begin_s;
    cli_looked looked; /* by the child that is at work, or was last */
    size_t length;     /* of a line whose end has not come */
    int status;        /* of the last child */
    char line[LONGEST_LINE];
} repeater;

/* ---- the child -------------------------------------------------------------------------------- */

/* There is one child's work in the process. */
static struct {
    pthread_mutex_t lock;
    cli_looked told;
    int out;
    atomic_bool *is_outdated;
} child = {.lock = PTHREAD_MUTEX_INITIALIZER};

static const char letters[] = {
    [CLI_LOOKED_MISSING] = 'm', [CLI_LOOKED_FOUND] = 'f', [CLI_LOOKED_PATTERN] = 'p'};

static void write_all(int out, const char *text, size_t length)
{
    while (length) {
        ssize_t done = write(out, text, length);
        if (done < 0 && errno != EINTR)
            return; /* nobody follows any more */
        text += done > 0 ? done : 0;
        length -= done > 0 ? (size_t)done : 0;
    }
}

static void tell(void *user, const char *path, cli_looked_kind kind)
{
    (void)user;
    bool is_new;
    pthread_mutex_lock(&child.lock);
    if (cli_looked_add(&child.told, path, kind, &is_new) && is_new &&
        strlen(path) < LONGEST_LINE - 2) {
        write_all(child.out, &letters[kind], 1);
        write_all(child.out, path, strlen(path) + 1);
    }
    pthread_mutex_unlock(&child.lock);
}

static bool end_if_outdated(void *app)
{
    (void)app;
    if (atomic_load(child.is_outdated))
        cli_interrupt_end();
    return false;
}

/* In a new process. */
static int begin_work(const repeater *r, int out)
{
    cli_app *app = r->app;
    child.out = out;
    child.is_outdated = r->is_outdated;
    cli_interrupt_install();
    app->start_s = cli_now_s();
    app->looked = tell;
    app->cancelled = end_if_outdated;
    int status = r->work(app);
    cli_console_flush(&app->console);
    csgm_context_destroy(app->context);
    fflush(stdout);
    cli_looked_release(&child.told);
    return status;
}

/* ---- the parent ------------------------------------------------------------------------------- */

/* Where the system has no room for it, there is no child: the next change tries again. */
static void begin(repeater *r)
{
    int ends[2];
    atomic_store(r->is_outdated, false);
    r->begin_s = cli_watch_clock_s();
    r->child = 0;
    r->length = 0;
    cli_looked_release(&r->looked);
    fflush(stdout);
    pid_t child_id = -1;
    if (pipe(ends) == 0) {
        child_id = fork();
        if (child_id == 0) {
            close(ends[0]);
            _exit(begin_work(r, ends[1]));
        }
        close(ends[1]);
    }
    if (child_id < 0) {
        cli_console_say(&r->app->console, CSGM_ERROR, NULL, "--watch: cannot start: %s",
                        strerror(errno));
        return;
    }
    r->child = child_id;
    r->lines = ends[0];
    fcntl(r->lines, F_SETFD, FD_CLOEXEC);
    fcntl(r->lines, F_SETFL, O_NONBLOCK);
}

static void take_line(repeater *r)
{
    bool is_new;
    for (size_t i = 0; i < sizeof letters; i++)
        if (r->line[0] == letters[i])
            cli_looked_add(&r->looked, r->line + 1, (cli_looked_kind)i, &is_new);
    r->length = 0;
}

/* false: the child has ended, and all that it told has come. */
static bool take_lines(repeater *r)
{
    char bytes[4096];
    ssize_t count;
    while ((count = read(r->lines, bytes, sizeof bytes)) > 0)
        for (ssize_t i = 0; i < count; i++) {
            r->line[r->length++] = bytes[i];
            if (!bytes[i] || r->length == LONGEST_LINE)
                take_line(r);
        }
    return count < 0 && (errno == EAGAIN || errno == EINTR);
}

static void reap(repeater *r)
{
    int status = 0;
    while (waitpid(r->child, &status, 0) < 0 && errno == EINTR)
        ;
    r->status = WIFEXITED(status) ? WEXITSTATUS(status) : CLI_TROUBLE;
    close(r->lines);
    r->lines = -1;
    r->child = 0;
}

static void end_child(repeater *r)
{
    if (!r->child)
        return;
    atomic_store(r->is_outdated, true);
    close(r->lines); /* it need not tell more */
    r->lines = -1;
    reap(r);
}

/* ---- what cli_follow() calls ------------------------------------------------------------------ */

static bool take_files(void *user, cli_watch *watch)
{
    repeater *r = user;
    if (!r->child)
        return true;
    size_t known = r->looked.count;
    bool goes_on = take_lines(r);
    if (r->looked.count > known || !goes_on)
        cli_watch_set(watch, &r->looked, r->begin_s);
    if (!goes_on)
        reap(r);
    return goes_on || r->looked.count;
}

static void ask(void *user)
{
    end_child(user);
    begin(user);
}

static int check(cli_app *app)
{
    const cli_options *o = app->options;
    if (o->emit)
        return cli_usage_error(app, NULL, "--watch makes files, --emit makes none");
    for (size_t i = 0; i < o->operands.count; i++)
        if (strcmp(o->operands.items[i], "-") == 0)
            return cli_usage_error(app, "save it to a file",
                                   "--watch: standard input cannot be followed");
    for (size_t i = 0; i < o->outputs.count; i++)
        if (strcmp(o->outputs.items[i], "-") == 0)
            return cli_usage_error(app, "name a file",
                                   "--watch writes files again, and standard output is none");
    return CLI_DONE;
}

static int follow(repeater *r)
{
    cli_follower follower = {.user = r, .take_files = take_files, .ask = ask};
    begin(r);
    if (!r->app->options->quiet && !r->app->options->json)
        cli_console_say(&r->app->console, CSGM_NOTE, NULL,
                        "files are written again when one that they are made of changes; Ctrl-C "
                        "ends that");
    cli_follow(&follower);
    bool is_over = !r->child && !r->looked.count; /* it ended by itself */
    end_child(r);
    cli_looked_release(&r->looked);
    return is_over ? r->status : CLI_DONE;
}

int cli_repeat(cli_app *app, int (*work)(cli_app *app))
{
    int status = check(app);
    if (status != CLI_DONE)
        return status;
    repeater *r = calloc(1, sizeof *r);
    void *shared = mmap(NULL, sizeof *r->is_outdated, PROT_READ | PROT_WRITE,
                        MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (r && shared != MAP_FAILED) {
        *r = (repeater){.app = app, .work = work, .is_outdated = shared, .lines = -1};
        status = follow(r);
    } else {
        cli_console_say(&app->console, CSGM_ERROR, NULL, "--watch: out of memory");
        status = CLI_TROUBLE;
    }
    if (shared != MAP_FAILED)
        munmap(shared, sizeof *r->is_outdated);
    free(r);
    return status;
}
