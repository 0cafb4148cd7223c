/* SPDX-License-Identifier: MIT
 * The builder's thread; see view_build.h. Findings are what --diagnostics=json prints.
 */
#include "view/view_build.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "core/textfile.h"
#include "core/work.h"
#include "queries/params_json.h"
#include "view/view_model.h"

/* A mesh that takes less is not shown coarsely first. */
static const double SHORT_S = 0.2;
enum { COARSE_CELLS = 64 /* along the longest side */ };

/* There is one builder in the process. Asked by the library on any thread. */
static atomic_bool is_outdated;

static bool is_cancelled(void *app)
{
    (void)app;
    return atomic_load(&is_outdated);
}

typedef struct job {
    view_builder *builder;
    cli_app app;
    cli_work work;
    view_values values;
    cli_text said;
    char *parameters; /* JSON; NULL: not known */
    csgm_mesh *marks[CSGM_MARK_COUNT];
    uint64_t model; /* number of the one to show */
    double begin_s, read_s;
    cli_looked looked;
} job;

/* ---- what is said ----------------------------------------------------------------------------- */

/* The lines as elements of an array. */
static void put_findings(FILE *out, job *j)
{
    cli_console_flush(&j->app.console);
    fflush(j->said.out);
    fputs("\"findings\":[", out);
    for (size_t i = 0; i < j->said.length; i++)
        if (j->said.text[i] != '\n')
            fputc(j->said.text[i], out);
        else if (i + 1 < j->said.length)
            fputc(',', out);
    fputc(']', out);
}

static void put_mesh(cli_json *json, const job *j)
{
    csgm_mesh_view view = csgm_mesh_get_view(j->work.mesh);
    cli_json_open(json, "mesh", '{');
    cli_json_count(json, "triangles", view.triangle_count);
    cli_json_number(json, "tolerance", j->work.stats.tolerance);
    cli_json_number(json, "cell", j->work.stats.cell_size);
    cli_json_end(json, '}');
}

/* What the page may ask for as files. */
static void put_formats(FILE *out)
{
    cli_json json = cli_json_make(out, false);
    json.first = true;
    cli_json_open(&json, "formats", '[');
    for (csgm_format f = CSGM_FORMAT_AUTO; f < CSGM_FORMAT_COUNT; f++)
        if (csgm_format_available(f, false))
            cli_json_string(&json, NULL, csgm_format_name(f));
    cli_json_end(&json, ']');
    cli_json_open(&json, "drawings", '[');
    for (csgm_drawing_format f = CSGM_DRAWING_NONE + 1; f < CSGM_DRAWING_COUNT; f++)
        cli_json_string(&json, NULL, csgm_drawing_format_name(f));
    cli_json_end(&json, ']');
    fputc(',', out);
}

/* phase: "reading", "coarse", "done", "failed". */
static void show(job *j, const char *phase)
{
    cli_text text;
    if (!cli_text_open(&text))
        return;
    cli_json json = cli_json_make(text.out, false);
    json.first = true;
    fputs("\"scene\":{", text.out);
    cli_json_string(&json, "name", cli_file_name(j->app.options.operands.items[0]));
    cli_json_string(&json, "phase", phase);
    cli_json_count(&json, "model", j->model);
    cli_json_number(&json, "seconds", cli_now_s() - j->begin_s);
    if (j->work.mesh)
        put_mesh(&json, j);
    fputs("},", text.out);
    if (j->parameters)
        fprintf(text.out, "%s,", j->parameters);
    put_formats(text.out);
    put_findings(text.out, j);
    view_store_set_state(j->builder->store, cli_text_close(&text));
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

static void read_parameters(job *j)
{
    csgm_params *params = NULL;
    cli_silence silence;
    cli_silence_begin(&silence, &j->app.console);
    if (cli_app_load_params(&j->app, j->app.options.operands.items[0], &params) == CSGM_OK) {
        cli_text text;
        if (cli_text_open(&text)) {
            cli_json json = cli_json_make(text.out, false);
            json.first = true;
            cli_put_params(&json, params);
        }
        j->parameters = cli_text_close(&text);
    }
    csgm_params_destroy(params);
    cli_silence_end(&silence, &j->app.console);
}

/* ---- meshes ----------------------------------------------------------------------------------- */

static void show_model(job *j)
{
    static const char *const kinds[CSGM_MARK_COUNT] = {
        [CSGM_MARK_HIGHLIGHT] = "highlight", [CSGM_MARK_BACKGROUND] = "background"};
    view_layer layers[1 + CSGM_MARK_COUNT] = {{"solid", csgm_mesh_get_view(j->work.mesh)}};
    size_t count = 1, length;
    for (int i = 0; i < CSGM_MARK_COUNT; i++)
        if (j->marks[i])
            layers[count++] = (view_layer){kinds[i], csgm_mesh_get_view(j->marks[i])};
    char *model = view_model_make(layers, count, &length);
    j->model = view_store_set_model(j->builder->store, model, length);
}

/* Equal cells, without creases: tens of milliseconds for nearly everything. */
static void make_coarse(job *j)
{
    cli_options own = j->app.options, *o = &j->app.options;
    cli_silence silence;
    cli_silence_begin(&silence, &j->app.console);
    o->resolution = COARSE_CELLS;
    o->cell_size = o->tolerance = 0;
    o->simplify = (cli_amount){.value = 0};
    o->triangles = 0;
    o->improve = false;
    o->features = CSGM_FEATURES_SMOOTH;
    bool made = cli_work_mesh(&j->app, &j->work) == CLI_DONE;
    j->app.options = own;
    cli_silence_end(&silence, &j->app.console);
    if (made && !atomic_load(&is_outdated)) {
        show_model(j);
        show(j, "coarse");
    }
    csgm_mesh_destroy(j->work.mesh);
    j->work.mesh = NULL;
}

static bool is_finite(csgm_box box)
{
    return isfinite(box.min.x) && isfinite(box.min.y) && isfinite(box.min.z) &&
           isfinite(box.max.x) && isfinite(box.max.y) && isfinite(box.max.z);
}

/* What # and % mark, with the options of the solid; what is infinite ends where that does. */
static void make_marks(job *j)
{
    for (int i = 0; i < CSGM_MARK_COUNT; i++) {
        const csgm_scene *marked = csgm_scene_get_marked(j->work.scene, (csgm_mark)i);
        cli_options own = j->app.options;
        cli_silence silence;
        cli_work work = {.normals = j->work.normals};
        if (!marked)
            continue;
        cli_silence_begin(&silence, &j->app.console);
        work.info = csgm_scene_get_info(marked);
        if (!is_finite(work.info.bounds) && !own.given[CLI_OPTION_bounds]) {
            j->app.options.bounds = j->work.info.bounds;
            j->app.options.given[CLI_OPTION_bounds] = true;
        }
        if (csgm_field_compile(j->app.context, marked, &work.field) == CSGM_OK)
            cli_work_mesh(&j->app, &work);
        csgm_field_destroy(work.field);
        j->marks[i] = work.mesh;
        j->app.options = own;
        cli_silence_end(&silence, &j->app.console);
    }
}

/* Of the last mesh: a job's is likely to take as long. */
static double last_mesh_s = INFINITY;

static int make_meshes(job *j)
{
    read_parameters(j);
    if (last_mesh_s > SHORT_S)
        make_coarse(j);
    double begin_s = cli_now_s();
    int status = cli_work_mesh(&j->app, &j->work);
    if (status == CLI_DONE && !atomic_load(&is_outdated)) {
        last_mesh_s = cli_now_s() - begin_s;
        make_marks(j);
    }
    return status;
}

/* A mesh is shown as it is. */
static int make_all(job *j)
{
    const char *path = j->app.options.operands.items[0];
    csgm_format format = csgm_format_from_path(path);
    int status = cli_app_open(&j->app);
    if (status == CLI_DONE && format != CSGM_FORMAT_AUTO)
        status = cli_exit_status(csgm_mesh_read(j->app.context, path, format, &j->work.mesh));
    else if (status == CLI_DONE)
        status = cli_work_load(&j->app, &j->work, path);
    hand_over_files(j);
    if (status == CLI_DONE && j->work.scene && !atomic_load(&is_outdated))
        status = make_meshes(j);
    return status;
}

/* ---- one request ------------------------------------------------------------------------------ */

/* With the builder's lock. */
static bool take_values(view_builder *builder, cli_options *options, view_values *out)
{
    const cli_list *given = &builder->app->options.defines;
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
    for (int i = 0; i < CSGM_MARK_COUNT; i++)
        csgm_mesh_destroy(j->marks[i]);
    cli_work_release(&j->work);
    csgm_context_destroy(j->app.context);
    cli_console_flush(&j->app.console);
    free(cli_text_close(&j->said));
    free(j->parameters);
    cli_looked_release(&j->looked);
    view_values_release(&j->values);
}

static void run_job(job *j)
{
    static const csgm_normals normals = CSGM_NORMALS_CREASE;
    static uint64_t last_model;
    j->begin_s = cli_now_s();
    j->read_s = cli_watch_clock_s();
    j->model = last_model;
    j->work.normals = &normals;
    j->app.cancelled = is_cancelled;
    j->app.looked = take_file;
    j->app.looked_user = j;
    j->app.console = cli_console_make();
    cli_console_configure(&j->app.console, &j->app.options);
    j->app.console.json = true;
    j->app.console.quiet = false;
    if (cli_text_open(&j->said)) {
        j->app.console.out = j->said.out;
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
        job j = {.builder = b, .app = {.options = b->app->options, .start_s = cli_now_s()}};
        pthread_mutex_lock(&b->lock);
        while (b->wanted == b->begun && !b->is_ending)
            pthread_cond_wait(&b->asked, &b->lock);
        if (b->is_ending) {
            pthread_mutex_unlock(&b->lock);
            return NULL;
        }
        b->begun = b->wanted;
        atomic_store(&is_outdated, false);
        bool ready = take_values(b, &j.app.options, &j.values);
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
    return cli_looked_add(&builder->files, app->options.operands.items[0], CLI_LOOKED_FOUND,
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
