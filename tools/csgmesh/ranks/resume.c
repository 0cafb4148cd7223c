/* SPDX-License-Identifier: MIT
 * The folder of a job that can be gone on with; see resume.h.
 */
#include "ranks/resume.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/options.h"
#include "csgmesh/csgmesh.h"
#include "ranks/hash.h"
#include "ranks/ranks.h"

/* Lines of a head, and what is other where they differ. */
enum { LINES = 5, LINE_MOST = 160 };
static const char *const what_differs[LINES] = {
    "another version of csgmesh", "another number of ranks",
    "another number of threads a rank (-j)", "another scene", "other options"};

cli_resume cli_resume_make(void)
{
    return (cli_resume){.head = -1};
}

void cli_resume_take(cli_resume *resume, int *argc, char **argv)
{
    int kept = 1;
    for (int i = 1; i < *argc; i++) {
        bool is_it = strcmp(argv[i], "--resume") == 0;
        resume->is_asked |= is_it;
        if (!is_it)
            argv[kept++] = argv[i];
    }
    *argc = kept;
}

/* Limits and what is told do not change bytes: a job may go on with others. */
static bool is_free(cli_option_id option)
{
    static const cli_option_id ids[] = {
        CLI_OPTION_threads, CLI_OPTION_max_memory, CLI_OPTION_timeout,
        CLI_OPTION_stats,   CLI_OPTION_quiet,      CLI_OPTION_progress,
        CLI_OPTION_color,   CLI_OPTION_no_sync,    CLI_OPTION_warnings};
    for (size_t i = 0; i < sizeof ids / sizeof *ids; i++)
        if (ids[i] == option)
            return true;
    return false;
}

static uint64_t add_text(uint64_t hash, const char *text)
{
    return cli_hash_add(hash, text, strlen(text) + 1);
}

static uint64_t hash_options(const cli_options *o)
{
    uint64_t hash = CLI_HASH_BEGIN;
    char name[16];
    for (int i = 0; i < CLI_OPTION_COUNT; i++) {
        if (!o->given[i] || is_free((cli_option_id)i))
            continue;
        snprintf(name, sizeof name, "%d", i);
        hash = add_text(hash, name);
        hash = add_text(hash, o->texts[i] ? o->texts[i] : "");
    }
    for (size_t i = 0; i < o->meta.count; i++)
        hash = add_text(hash, o->meta.items[i]);
    return hash;
}

static void describe(const cli_app *app, uint64_t scene, char lines[LINES][LINE_MOST])
{
    snprintf(lines[0], LINE_MOST, "csgmesh-mpi %s", csgm_version());
    snprintf(lines[1], LINE_MOST, "ranks %" PRIu32, cli_ranks_count());
    snprintf(lines[2], LINE_MOST, "threads %" PRIu32, csgm_context_threads(app->context));
    snprintf(lines[3], LINE_MOST, "scene %016" PRIx64, scene);
    snprintf(lines[4], LINE_MOST, "options %016" PRIx64, hash_options(app->options));
}

static int refuse(cli_app *app, const char *hint, const char *folder, const char *why)
{
    cli_console_say(&app->console, CSGM_ERROR, hint, "cannot resume from %s: %s", folder, why);
    return CLI_TROUBLE;
}

static int write_head(int fd, char lines[LINES][LINE_MOST])
{
    char text[LINES * LINE_MOST];
    size_t length = 0;
    for (int i = 0; i < LINES; i++)
        length += (size_t)snprintf(text + length, sizeof text - length, "%s\n", lines[i]);
    ssize_t written = write(fd, text, length);
    return written == (ssize_t)length ? 0 : written < 0 ? errno : ENOSPC;
}

/* The first line that the head has otherwise; LINES: none; -1: it is no whole head. */
static int first_other(int fd, char lines[LINES][LINE_MOST])
{
    char text[LINES * LINE_MOST + 1];
    ssize_t length = pread(fd, text, sizeof text - 1, 0);
    if (length <= 0 || text[length - 1] != '\n')
        return -1;
    text[length] = '\0';
    int other = LINES, i = 0;
    for (char *at = text; *at && i < LINES; i++) {
        char *end = strchr(at, '\n');
        *end = '\0';
        if (other == LINES && strcmp(at, lines[i]) != 0)
            other = i;
        at = end + 1;
    }
    return i == LINES ? other : -1;
}

/* Rank 0: the folder is there, with a head that is this job's, and no other job works with it. */
static int open_folder(cli_resume *r, cli_app *app, uint64_t scene)
{
    char lines[LINES][LINE_MOST], path[sizeof r->folder + 8];
    describe(app, scene, lines);
    bool is_new = mkdir(r->folder, 0777) == 0;
    if (!is_new && errno != EEXIST)
        return refuse(app, NULL, r->folder, strerror(errno));
    snprintf(path, sizeof path, "%s/head", r->folder);
    r->head = open(path, O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (r->head < 0)
        return refuse(app, NULL, r->folder, strerror(errno));
    if (flock(r->head, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
        return refuse(app, NULL, r->folder, "another job works with it");
    struct stat head;
    if (fstat(r->head, &head) == 0 && head.st_size == 0) { /* stopped before it said anything */
        int error = write_head(r->head, lines);
        r->is_own = true;
        return error ? refuse(app, NULL, r->folder, strerror(error)) : CLI_DONE;
    }
    int other = first_other(r->head, lines);
    r->is_own = other == LINES;
    if (r->is_own)
        return CLI_DONE;
    char why[96];
    snprintf(why, sizeof why, "what was finished is of %s",
             other < 0 ? "no job of csgmesh-mpi" : what_differs[other]);
    return refuse(app, "remove the folder to begin anew", r->folder, why);
}

int cli_resume_begin(cli_resume *r, cli_app *app, uint64_t scene)
{
    int status = CLI_DONE;
    if (!r->is_asked)
        return CLI_DONE;
    int length = snprintf(r->folder, sizeof r->folder, "%s.resume", app->options->outputs.items[0]);
    if (cli_ranks_rank() == 0) {
        if (cli_ranks_count() == 1)
            status = cli_usage_error(app, "mpirun -n 2 csgmesh-mpi ...",
                                     "--resume needs two ranks or more");
        else if (length < 0 || (size_t)length >= sizeof r->folder)
            status = refuse(app, NULL, "it", strerror(ENAMETOOLONG));
        else
            status = open_folder(r, app, scene);
    }
    status = cli_ranks_most(status);
    if (status == CLI_DONE)
        status = cli_ranks_most(cli_exit_status(csgm_context_keep(app->context, r->folder)));
    return status;
}

void cli_resume_end(cli_resume *r, bool is_done)
{
    char path[sizeof r->folder + 32];
    if (r->head < 0)
        return;
    snprintf(path, sizeof path, "%s/mesh", r->folder);
    is_done = is_done || (r->is_own && access(path, F_OK) != 0); /* nothing is kept */
    for (uint32_t i = 0; is_done && i < cli_ranks_count(); i++) {
        snprintf(path, sizeof path, "%s/rank-%" PRIu32, r->folder, i);
        unlink(path);
    }
    if (is_done) {
        snprintf(path, sizeof path, "%s/mesh", r->folder); /* there still with --if-changed */
        unlink(path);
        snprintf(path, sizeof path, "%s/head", r->folder);
        unlink(path);
        rmdir(r->folder);
    }
    close(r->head);
    r->head = -1;
}
