/* SPDX-License-Identifier: MIT
 * One job, as csgmesh mesh would do it: a context, a console and a mesh of its own; what it says is
 * kept for the report.
 */
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

#include "batch/batch_names.h"
#include "batch/batch_run.h"
#include "core/options.h"
#include "core/sources.h"
#include "core/work.h"
#include "mesh/certify.h"
#include "mesh/drawings.h"
#include "mesh/outputs.h"

typedef struct maker {
    batch_run *run;
    const batch_job *job;
    batch_result *result;
    cli_app app;
    cli_options options; /* the app's */
    cli_work work;
    batch_record record;
    int64_t since[2];
    double start_cpu_s;
    bool is_noted; /* the record says how long it took */
} maker;

/* Processor time: of this thread, or of all, where no other job is at work. */
static double cpu_now_s(const maker *m)
{
    struct timespec now = {0, 0};
    clock_gettime(m->options.threads == 1 ? CLOCK_THREAD_CPUTIME_ID : CLOCK_PROCESS_CPUTIME_ID,
                  &now);
    return (double)now.tv_sec + (double)now.tv_nsec * 1e-9;
}

static int fail_memory(maker *m)
{
    cli_console_say(&m->app.console, CSGM_ERROR, NULL, "out of memory");
    return CLI_TROUBLE;
}

/* ---- is it long work? ----------------------------------------------------------------- */

static const double LARGE_S = 1.0; /* more than this of one thread is worth all threads */

/* Surfaces grow with the square of the resolution: a mesh of an eighth of it takes a 64th of the
 * time. What this says is not shown: the real mesh will say it again. */
static bool is_long_work(maker *m)
{
    enum { EIGHTH = 8, LEAST = 64, FEW = 500, SUPPOSED = 128 }; /* where -r does not say */
    const cli_options *options = m->app.options;
    csgm_mesh_options mesh = csgm_mesh_options_default();
    csgm_field *field = NULL;
    csgm_mesh *probe = NULL;
    if (m->app.flat == CSGM_FLAT_DRAWING)
        return false;
    uint64_t resolution = options->resolution ? options->resolution : SUPPOSED;
    if (!options->given[CLI_OPTION_cell_size] && resolution <= LEAST &&
        m->work.info.primitive_count <= FEW)
        return false;
    mesh.resolution = (uint32_t)(resolution / EIGHTH > 4 ? resolution / EIGHTH : 4);
    mesh.cell_size = options->cell_size * EIGHTH;
    if (options->given[CLI_OPTION_bounds])
        mesh.bounds = options->bounds;
    cli_silence silence;
    if (!cli_silence_begin(&silence, &m->app.console))
        return false;
    double begin_s = cli_now_s();
    if (csgm_field_compile(m->app.context, m->work.scene, &field) == CSGM_OK)
        csgm_mesh_build(m->app.context, field, &mesh, &probe, NULL);
    double seconds = (cli_now_s() - begin_s) * EIGHTH * EIGHTH;
    csgm_mesh_destroy(probe);
    csgm_field_destroy(field);
    cli_silence_end(&silence, &m->app.console);
    return seconds > LARGE_S;
}

/* ---- outputs -------------------------------------------------------------------------- */

static int add_output(maker *m, const char *path, const char *format, const char *part)
{
    cli_arena *arena = &m->result->arena;
    batch_output output = {cli_arena_strdup(arena, path),
                           format,
                           part ? cli_arena_strdup(arena, part) : NULL,
                           {{0}},
                           0,
                           0,
                           0};
    batch_output *place = cli_arena_push(arena, (void **)&m->result->outputs,
                                         &m->result->output_count, sizeof output);
    if (!place || arena->failed)
        return fail_memory(m);
    *place = output;
    return CLI_DONE;
}

static int refuse_empty(maker *m)
{
    cli_console_say(&m->app.console, CSGM_ERROR, NULL,
                    "the mesh has no triangles: nothing was written");
    return CLI_INPUT_AT_FAULT;
}

static int write_view(maker *m, const csgm_mesh_view *view, const char *path, const char *format)
{
    csgm_write_options options = cli_outputs_options(&m->app, m->job->scene);
    if (m->app.options->given[CLI_OPTION_lod] && !m->job->by_part) {
        int status = cli_work_mesh_levels(&m->app, &m->work, &options);
        if (status != CLI_DONE)
            return status;
    }
    csgm_drawing_format drawing = csgm_drawing_format_from_name(format);
    if (!batch_make_folders(path, false)) {
        cli_console_say(&m->app.console, CSGM_ERROR, NULL, "cannot write %s: %s", path,
                        strerror(errno));
        return CLI_TROUBLE;
    }
    if (drawing != CSGM_DRAWING_NONE)
        return cli_drawings_write_one(&m->app, m->work.scene, path, drawing);
    return cli_exit_status(
        csgm_mesh_write(m->app.context, view, path, csgm_format_from_name(format), &options));
}

/* The stretch of vertices that the part's triangles use. indices: room for them. */
static csgm_mesh_view view_of_part(const csgm_mesh_view *view, const csgm_mesh_part *part,
                                   uint32_t *indices)
{
    const uint32_t *from = view->indices + 3 * part->first_triangle;
    uint64_t count = 3 * part->triangle_count;
    uint32_t least = UINT32_MAX, most = 0;
    for (uint64_t i = 0; i < count; i++) {
        least = from[i] < least ? from[i] : least;
        most = from[i] > most ? from[i] : most;
    }
    least = count ? least : 0;
    for (uint64_t i = 0; i < count; i++)
        indices[i] = from[i] - least;
    return (csgm_mesh_view){.origin = view->origin,
                            .positions = view->positions + 3 * (uint64_t)least,
                            .normals = view->normals ? view->normals + 3 * (uint64_t)least : NULL,
                            .colors = view->colors ? view->colors + 4 * (uint64_t)least : NULL,
                            .indices = indices,
                            .vertex_count = count ? (uint64_t)most - least + 1 : 0,
                            .triangle_count = part->triangle_count,
                            .materials =
                                view->materials ? view->materials + 2 * (uint64_t)least : NULL};
}

/* Two parts, or a part and something else, must not end in one file. */
static int check_part(maker *m, const char *path)
{
    for (size_t i = 0; i < m->result->output_count; i++)
        if (strcmp(m->result->outputs[i].path, path) == 0) {
            cli_console_say(&m->app.console, CSGM_ERROR, "give the parts other names",
                            "two parts would both be written to %s", path);
            return CLI_INPUT_AT_FAULT;
        }
    size_t prefix =
        strcmp(m->run->plan->directory, ".") == 0 ? 0 : strlen(m->run->plan->directory) + 1;
    if (strlen(path) > prefix && batch_name_stays_below(path + prefix))
        return CLI_DONE;
    cli_console_say(&m->app.console, CSGM_ERROR, "give the part another name",
                    "'%s' is no name for an output", path);
    return CLI_INPUT_AT_FAULT;
}

static int write_part(maker *m, const csgm_mesh_view *view, const csgm_mesh_part *part)
{
    uint32_t *indices = malloc((3 * part->triangle_count + 1) * sizeof *indices);
    if (!indices)
        return fail_memory(m);
    csgm_mesh_view alone = view_of_part(view, part, indices);
    csgm_mesh_part named = {part->name, 0, part->triangle_count};
    alone.parts = part->name ? &named : NULL;
    alone.part_count = part->name ? 1 : 0;
    int status = CLI_DONE;
    for (size_t i = 0; i < m->job->formats.count && status == CLI_DONE; i++) {
        const char *format = m->job->formats.items[i];
        const char *path = batch_output_path(&m->result->arena, m->job, m->run->plan->directory,
                                             format, part->name);
        status = check_part(m, path);
        if (status == CLI_DONE)
            status = add_output(m, path, format, part->name);
        if (status == CLI_DONE)
            status = write_view(m, &alone, path, format);
    }
    free(indices);
    return status;
}

static int write_parts(maker *m, const csgm_mesh_view *view)
{
    csgm_mesh_part whole = {NULL, 0, view->triangle_count};
    int status = CLI_DONE;
    for (uint64_t i = 0; i < view->part_count && status == CLI_DONE; i++)
        status = write_part(m, view, &view->parts[i]);
    return view->part_count ? status : write_part(m, view, &whole);
}

static int write_whole(maker *m, const csgm_mesh_view *view)
{
    int status = CLI_DONE;
    for (size_t i = 0; i < m->job->outputs.count && status == CLI_DONE; i++) {
        status = add_output(m, m->job->outputs.items[i], m->job->formats.items[i], NULL);
        if (status == CLI_DONE)
            status = write_view(m, view, m->job->outputs.items[i], m->job->formats.items[i]);
    }
    return status;
}

/* One file need not be in memory as a mesh. */
static int write_stream(maker *m)
{
    csgm_write_options options = cli_outputs_options(&m->app, m->job->scene);
    const char *path = m->job->outputs.items[0], *format = m->job->formats.items[0];
    if (!batch_make_folders(path, false)) {
        cli_console_say(&m->app.console, CSGM_ERROR, NULL, "cannot write %s: %s", path,
                        strerror(errno));
        return CLI_TROUBLE;
    }
    uint64_t counts[2];
    int status = cli_work_mesh_file(&m->app, &m->work, path, csgm_format_from_name(format),
                                    &options, counts, NULL);
    m->result->triangles = counts[1];
    return status == CLI_DONE ? add_output(m, path, format, NULL) : status;
}

/* The outputs of a job get their names together, or none does. */
static int name_outputs(maker *m, int status)
{
    if (status == CLI_DONE && cli_app_is_refused(&m->app))
        status = CLI_INPUT_AT_FAULT;
    csgm_status named = csgm_files_release(m->app.context, status == CLI_DONE);
    return status == CLI_DONE ? cli_exit_status(named) : status;
}

static int write_all(maker *m)
{
    bool is_plate = m->app.flat == CSGM_FLAT_PLATE;
    if (m->app.flat == CSGM_FLAT_DRAWING) /* drawings alone need no mesh */
        return write_whole(m, NULL);
    if (m->job->outputs.count == 1 && !m->job->by_part && is_plate &&
        m->app.options->warnings == 0 && !m->app.options->given[CLI_OPTION_lod])
        return write_stream(m);
    int status = cli_work_mesh(&m->app, &m->work);
    if (status != CLI_DONE)
        return status;
    csgm_mesh_view view = csgm_mesh_get_view(m->work.mesh);
    m->result->triangles = view.triangle_count;
    if (!view.triangle_count)
        return refuse_empty(m);
    return m->job->by_part ? write_parts(m, &view) : write_whole(m, &view);
}

static int mesh_and_write(maker *m)
{
    csgm_status held = csgm_files_hold(m->app.context);
    return held == CSGM_OK ? name_outputs(m, write_all(m)) : cli_exit_status(held);
}

/* ---- the record ----------------------------------------------------------------------- */

static int take_record(maker *m)
{
    batch_result *result = m->result;
    m->app.options->outputs = (cli_list){0}; /* they are written */
    bool sound = batch_record_take_inputs(&result->arena, &m->run->memo, m->job, m->work.scene,
                                          m->since, &m->record);
    for (size_t i = 0; i < result->output_count; i++) {
        batch_output *output = &result->outputs[i];
        if (cli_sources_guard_written(&m->app, output->path) != CLI_DONE) {
            result->endangers_files = true;
            return CLI_TROUBLE;
        }
        sound = batch_output_look(output) && sound;
        sound = sound && batch_hash_available() && batch_hash_path(output->path, &output->digest);
    }
    m->record.key = batch_record_key(m->job, &m->run->program);
    m->record.cpu_seconds = result->cpu_seconds + cpu_now_s(m) - m->start_cpu_s;
    result->cpu_seconds = m->record.cpu_seconds;
    m->is_noted = true;
    m->record.outputs = result->outputs;
    m->record.output_count = result->output_count;
    if (m->run->app->options->depfiles && !batch_write_depfiles(&m->app, &m->record, m->job))
        return CLI_TROUBLE;
    if (sound)
        batch_note(m->run, m->job, &m->record);
    return CLI_DONE;
}

/* ---- the job -------------------------------------------------------------------------- */

static FILE *open_console(maker *m, char **text, size_t *length)
{
    enum { NEVER = 2 };
    const cli_console *outer = &m->run->app->console;
    cli_console *console = &m->app.console;
    *console = cli_console_make();
    cli_console_configure(console, m->run->app->options);
    console->out = open_memstream(text, length);
    console->color = outer->color;
    console->is_terminal = false;
    console->progress = NEVER;
    return console->out;
}

/* As after -o: what is made of a scene may depend on the formats. */
static void set_outputs(maker *m)
{
    cli_arena *arena = &m->result->arena;
    cli_list names = {0};
    for (size_t i = 0; i < m->job->formats.count; i++)
        cli_list_add(arena, &names, cli_arena_printf(arena, "mesh.%s", m->job->formats.items[i]));
    m->app.options->outputs = names;
}

static int make_job(maker *m, bool may_defer, bool *is_large)
{
    set_outputs(m);
    m->app.flat = cli_drawings_flat(m->app.options);
    int status = cli_work_check(&m->app);
    cli_list names = m->app.options->outputs;
    m->app.options->outputs = m->job->outputs; /* what must be no source */
    if (status == CLI_DONE)
        status = cli_app_open(&m->app);
    if (status == CLI_DONE)
        status = cli_work_load(&m->app, &m->work, m->job->scene);
    m->app.options->outputs = names;
    m->result->endangers_files = m->app.overwriter && strcmp(m->app.overwriter, "-o") != 0;
    *is_large = status == CLI_DONE && may_defer && is_long_work(m);
    if (*is_large)
        return CLI_DONE;
    if (status == CLI_DONE)
        status = mesh_and_write(m);
    if (status == CLI_DONE)
        cli_certify_tell(&m->app, &m->work.stats.certify);
    return status == CLI_DONE ? take_record(m) : status;
}

void batch_make(batch_run *run, const batch_job *job, uint32_t threads, bool may_defer,
                batch_result *result, bool *is_large)
{
    maker m = {.run = run, .job = job, .result = result};
    struct timespec now;
    char *text = NULL;
    size_t length = 0;
    clock_gettime(CLOCK_REALTIME_COARSE, &now); /* the clock of files */
    m.since[0] = now.tv_sec;
    m.since[1] = now.tv_nsec;
    m.options = *job->options;
    m.app.options = &m.options;
    m.options.trace = run->app->options->trace; /* what must be no source either */
    m.options.junit = run->app->options->junit;
    m.options.threads = threads;
    m.options.if_changed = true;
    m.app.start_s = cli_now_s();
    m.start_cpu_s = cpu_now_s(&m);
    m.app.trace = run->app->trace;
    m.app.cancelled = run->app->cancelled;
    m.app.looked = run->app->looked;
    m.app.looked_user = run->app->looked_user;
    m.app.zone_note = job->scene;
    *is_large = false;
    FILE *out = open_console(&m, &text, &length);
    result->status = out ? make_job(&m, may_defer, is_large) : CLI_TROUBLE;
    cli_work_release(&m.work);
    if (out)
        cli_console_flush(&m.app.console);
    csgm_context_destroy(m.app.context);
    if (out && fclose(out) != 0)
        result->status = CLI_TROUBLE;
    if (*is_large) {
        free(text);
        text = NULL;
    }
    result->messages = text;
    result->outcome = result->status == CLI_DONE ? BATCH_MADE : BATCH_FAILED;
    result->seconds += cli_now_s() - m.app.start_s;
    if (!m.is_noted)
        result->cpu_seconds += cpu_now_s(&m) - m.start_cpu_s;
}
