/* SPDX-License-Identifier: MIT
 * The builder's thread; see view_build.h.
 */
#include "view/view_build.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "core/options.h"
#include "view/view_job.h"

/* A mesh that takes less is not shown coarsely first. */
static const double SHORT_S = 0.2;

/* There is one builder in the process. Asked by the library on any thread. */
static atomic_bool is_outdated;

static bool is_cancelled(void *app)
{
    (void)app;
    return atomic_load(&is_outdated);
}

typedef struct job {
    view_builder *builder;
    cli_options options;
    view_job shown; /* with these */
    view_values values;
    uint64_t model; /* number of the one to show */
    double read_s;
    cli_looked looked;
} job;

/* ---- what is said ----------------------------------------------------------------------------- */

/* phase: as of view_job_state. */
static void show(job *j, const char *phase)
{
    view_store_set_state(j->builder->store, view_job_state(&j->shown, phase, j->model));
}

/* ---- reading ---------------------------------------------------------------------------------- */

static void free_texts(char **texts, size_t count)
{
    for (size_t i = 0; i < count; i++)
        free(texts[i]);
    free(texts);
}

static void take_file(void *user, const char *path, cli_looked_kind kind)
{
    job *j = user;
    bool is_new;
    cli_looked_add(&j->looked, path, kind, &is_new);
}

/* What the scene was looked for in; where that was given up before, what is known stays. */
static void hand_over_files(job *j)
{
    view_builder *b = j->builder;
    if (!j->looked.count)
        return;
    pthread_mutex_lock(&b->lock);
    cli_looked_release(&b->files);
    b->files = j->looked;
    b->read_s = j->read_s;
    b->has_files = true;
    pthread_mutex_unlock(&b->lock);
    j->looked = (cli_looked){0};
}

/* ---- meshes ----------------------------------------------------------------------------------- */

static void show_model(job *j)
{
    size_t length;
    char *model = view_job_model(&j->shown, &length);
    j->model = view_store_set_model(j->builder->store, model, length);
}

static void make_coarse(job *j)
{
    bool made = view_job_mesh_coarsely(&j->shown);
    if (made && !atomic_load(&is_outdated)) {
        show_model(j);
        show(j, "coarse");
    }
    view_job_drop_mesh(&j->shown);
}

/* Of the last mesh: a job's is likely to take as long. */
static double last_mesh_s = INFINITY;

static int make_meshes(job *j)
{
    view_job_read_parameters(&j->shown);
    if (last_mesh_s > SHORT_S)
        make_coarse(j);
    double begin_s = cli_now_s();
    int status = cli_work_mesh(&j->shown.app, &j->shown.work);
    if (status == CLI_DONE && !atomic_load(&is_outdated)) {
        last_mesh_s = cli_now_s() - begin_s;
        view_job_mesh_marks(&j->shown);
    }
    return status;
}

static int make_all(job *j)
{
    int status = view_job_read(&j->shown);
    hand_over_files(j);
    if (status == CLI_DONE && j->shown.work.scene && !atomic_load(&is_outdated))
        status = make_meshes(j);
    return status;
}

/* ---- one request ------------------------------------------------------------------------------ */

/* With the builder's lock. */
static bool take_values(view_builder *builder, cli_options *options, view_values *out)
{
    const cli_list *given = &builder->app->options->defines;
    const view_defines *set = &builder->defines;
    char **items = calloc(given->count + set->count + 1, sizeof *items);
    if (!items)
        return false;
    bool done = true;
    for (size_t i = 0; i < given->count; i++)
        items[i] = (char *)given->items[i];
    for (size_t i = 0; i < set->count; i++) {
        items[given->count + i] = strdup(set->items[i]);
        done = done && items[given->count + i];
    }
    *out = (view_values){{items, given->count + set->count}, given->count};
    options->defines = (cli_list){(const char **)items, out->all.count};
    return done;
}

bool view_values_take(view_builder *builder, cli_options *options, view_values *out)
{
    *out = (view_values){.given = 0};
    pthread_mutex_lock(&builder->lock);
    bool done = take_values(builder, options, out);
    pthread_mutex_unlock(&builder->lock);
    return done;
}

void view_values_release(view_values *values)
{
    for (size_t i = values->given; i < values->all.count; i++)
        free(values->all.items[i]);
    free(values->all.items);
}

static void release(job *j)
{
    view_job_release(&j->shown);
    cli_looked_release(&j->looked);
    view_values_release(&j->values);
}

static void run_job(job *j)
{
    static uint64_t last_model;
    j->read_s = cli_watch_clock_s();
    j->model = last_model;
    j->shown.app.cancelled = is_cancelled;
    j->shown.app.looked = take_file;
    j->shown.app.looked_user = j;
    if (view_job_begin(&j->shown)) {
        show(j, "reading");
        int status = make_all(j);
        if (status == CLI_DONE && !atomic_load(&is_outdated))
            show_model(j);
        if (!atomic_load(&is_outdated))
            show(j, status == CLI_DONE ? "done" : "failed");
    }
    last_model = j->model;
    release(j);
}

static void *follow_requests(void *user)
{
    view_builder *b = user;
    for (;;) {
        job j = {
            .builder = b, .options = *b->app->options, .shown = {.app = {.start_s = cli_now_s()}}};
        j.shown.app.options = &j.options;
        pthread_mutex_lock(&b->lock);
        while (b->wanted == b->begun && !b->is_ending)
            pthread_cond_wait(&b->asked, &b->lock);
        if (b->is_ending) {
            pthread_mutex_unlock(&b->lock);
            return NULL;
        }
        b->begun = b->wanted;
        atomic_store(&is_outdated, false);
        bool ready = take_values(b, &j.options, &j.values);
        pthread_mutex_unlock(&b->lock);
        if (ready)
            run_job(&j);
        else
            release(&j);
    }
}

/* ---- from other threads ----------------------------------------------------------------------- */

bool view_builder_begin(view_builder *builder, const cli_app *app, view_store *store)
{
    *builder = (view_builder){.app = app, .store = store, .wanted = 1};
    builder->read_s = cli_watch_clock_s();
    return cli_looked_add(&builder->files, app->options->operands.items[0], CLI_LOOKED_FOUND,
                          &builder->has_files) &&
           pthread_mutex_init(&builder->lock, NULL) == 0 &&
           pthread_cond_init(&builder->asked, NULL) == 0 &&
           pthread_create(&builder->thread, NULL, follow_requests, builder) == 0;
}

/* With the lock. */
static void ask(view_builder *b)
{
    b->wanted++;
    atomic_store(&is_outdated, true);
    pthread_cond_signal(&b->asked);
}

void view_builder_end(view_builder *builder)
{
    pthread_mutex_lock(&builder->lock);
    builder->is_ending = true;
    ask(builder);
    pthread_mutex_unlock(&builder->lock);
    pthread_join(builder->thread, NULL);
    cli_looked_release(&builder->files);
    free_texts(builder->defines.items, builder->defines.count);
    pthread_cond_destroy(&builder->asked);
    pthread_mutex_destroy(&builder->lock);
}

void view_builder_ask(view_builder *builder)
{
    pthread_mutex_lock(&builder->lock);
    ask(builder);
    pthread_mutex_unlock(&builder->lock);
}

bool view_builder_set(view_builder *builder, const char *lines, size_t length)
{
    size_t most = 1, count = 0;
    for (size_t i = 0; i < length; i++)
        most += lines[i] == '\n';
    char **items = calloc(most, sizeof *items);
    bool done = items != NULL;
    for (size_t at = 0; done && at < length;) {
        const char *end = memchr(lines + at, '\n', length - at);
        size_t line = end ? (size_t)(end - lines) - at : length - at;
        if (line) {
            items[count] = strndup(lines + at, line);
            done = items[count++] != NULL;
        }
        at += line + 1;
    }
    if (!done) {
        free_texts(items, count);
        return false;
    }
    pthread_mutex_lock(&builder->lock);
    free_texts(builder->defines.items, builder->defines.count);
    builder->defines = (view_defines){items, count};
    ask(builder);
    pthread_mutex_unlock(&builder->lock);
    return true;
}

void view_builder_watch(view_builder *builder, cli_watch *watch)
{
    pthread_mutex_lock(&builder->lock);
    if (builder->has_files)
        cli_watch_set(watch, &builder->files, builder->read_s);
    builder->has_files = false;
    pthread_mutex_unlock(&builder->lock);
}
