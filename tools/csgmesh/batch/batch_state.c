/* SPDX-License-Identifier: MIT
 * What is up to date. DIR/.csgmesh-cache/ID is the record of a job, by the names of its outputs; it
 * appears or is replaced whole, and may be deleted at any time.
 */
#include <string.h>
#include <sys/stat.h>

#include "batch/batch_cache.h"
#include "batch/batch_http.h"
#include "batch/batch_remote.h"
#include "core/options.h"
#include "core/sources.h"
#include "mesh/depfile.h"

batch_digest batch_job_id(const batch_job *job)
{
    batch_hasher hasher;
    batch_hash_begin(&hasher);
    for (size_t i = 0; i < job->names.count; i++)
        batch_hash_text(&hasher, job->names.items[i]);
    batch_hash_text(&hasher, job->by_part ? job->pattern : "");
    return batch_hash_end(&hasher);
}

static const char *record_path(cli_arena *arena, const batch_run *run, const batch_job *job)
{
    char name[BATCH_DIGEST_TEXT];
    batch_digest id = batch_job_id(job);
    batch_digest_print(&id, name);
    return cli_path_join(arena, run->state, name);
}

/* ---- beside the outputs --------------------------------------------------------------- */

/* Its size and time are those that were noted, or else its bytes are. */
static bool output_holds(const batch_output *noted)
{
    batch_output now = *noted;
    if (!batch_output_look(&now) || now.bytes != noted->bytes)
        return false;
    if (now.changed_s == noted->changed_s && now.changed_ns == noted->changed_ns)
        return true;
    return batch_hash_path(now.path, &now.digest) &&
           batch_digest_equal(&now.digest, &noted->digest);
}

static bool depfile_is_there(cli_arena *arena, const batch_output *output)
{
    struct stat status;
    return stat(cli_arena_printf(arena, "%s.d", output->path), &status) == 0;
}

static bool outputs_hold(const batch_run *run, cli_arena *arena, const batch_record *record)
{
    for (size_t i = 0; i < record->output_count; i++)
        if (!output_holds(&record->outputs[i]) ||
            (run->app->options->depfiles && !depfile_is_there(arena, &record->outputs[i])))
            return false;
    return record->output_count > 0;
}

static void take_outputs(batch_result *result, const batch_record *record)
{
    for (size_t i = 0; i < record->output_count; i++) {
        batch_output *place = cli_arena_push(&result->arena, (void **)&result->outputs,
                                             &result->output_count, sizeof *place);
        if (!place)
            return;
        *place = record->outputs[i];
        place->path = cli_arena_strdup(&result->arena, place->path);
        place->part = place->part ? cli_arena_strdup(&result->arena, place->part) : NULL;
    }
}

/* A job is told of it that is made: so it is not up to date. */
static bool is_endangered(const batch_run *run, const batch_record *record)
{
    const cli_options *options = run->app->options;
    bool found = false;
    for (size_t i = 0; i < record->input_count && !found; i++)
        found = cli_sources_is_output(options, record->inputs[i].path);
    for (size_t i = 0; i < record->output_count && !found; i++)
        found = cli_sources_is_output(options, record->outputs[i].path);
    return found;
}

/* Those of a job that is left alone are followed as well. */
static void tell_inputs(const batch_run *run, const batch_record *record)
{
    for (size_t i = 0; i < record->input_count; i++)
        cli_app_looked(run->app, record->inputs[i].path, CLI_LOOKED_FOUND);
    for (size_t i = 0; i < record->absent.count; i++)
        cli_app_looked(run->app, record->absent.items[i], CLI_LOOKED_MISSING);
}

bool batch_is_current(batch_run *run, const batch_job *job, batch_result *result)
{
    cli_arena arena = {0};
    batch_record record;
    size_t length;
    batch_digest key = batch_record_key(job, &run->program);
    const char *text = batch_hash_available() && !run->app->options->force
                           ? batch_read_small(&arena, record_path(&arena, run, job), &length)
                           : NULL;
    bool current =
        text && batch_record_parse(&arena, job, run->plan->directory, text, &record) &&
        batch_digest_equal(&record.key, &key) && batch_record_inputs_hold(&run->memo, &record) &&
        outputs_hold(run, &arena, &record) && !is_endangered(run, &record) && !arena.failed;
    if (current) {
        take_outputs(result, &record);
        tell_inputs(run, &record);
        result->cpu_seconds = record.cpu_seconds;
        result->outcome = BATCH_UP_TO_DATE;
    }
    cli_arena_reset(&arena);
    return current;
}

/* ---- another checkout's ---------------------------------------------------------------- */

static void write_state(batch_run *run, cli_arena *arena, const batch_job *job,
                        const batch_record *record)
{
    const char *text = batch_record_print(arena, job, record);
    if (text)
        batch_write_small(record_path(arena, run, job), text, strlen(text));
}

bool batch_record_is_taken(batch_run *run, cli_arena *arena, const batch_job *job,
                           const batch_digest *key, const char *text, batch_record *record)
{
    return batch_record_parse(arena, job, run->plan->directory, text, record) &&
           batch_digest_equal(&record->key, key) && batch_record_inputs_hold(&run->memo, record) &&
           record->output_count > 0 && !is_endangered(run, record);
}

static bool has_cache(const batch_run *run)
{
    const char *cache = run->app->options->cache;
    return batch_hash_available() &&
           (batch_http_is_address(cache) ? run->remote != NULL : cache != NULL);
}

bool batch_take_from_cache(batch_run *run, const batch_job *job, batch_result *result)
{
    cli_arena arena = {0};
    batch_record record;
    batch_digest key = batch_record_key(job, &run->program);
    bool found = has_cache(run) && !run->app->options->force &&
                 (run->remote ? batch_remote_take(run, &arena, job, &key, &record)
                              : batch_cache_take(run, &arena, job, &key, &record)) &&
                 (!run->app->options->depfiles || batch_write_depfiles(run->app, &record, job));
    if (found) {
        take_outputs(result, &record);
        tell_inputs(run, &record);
        result->cpu_seconds = record.cpu_seconds;
        result->outcome = BATCH_CACHED;
        write_state(run, &arena, job, &record);
    }
    cli_arena_reset(&arena);
    return found;
}

void batch_note(batch_run *run, const batch_job *job, batch_record *record)
{
    cli_arena arena = {0};
    write_state(run, &arena, job, record);
    if (has_cache(run) && run->remote)
        batch_remote_store(run, &arena, job, record);
    else if (has_cache(run))
        batch_cache_store(run, &arena, job, record);
    cli_arena_reset(&arena);
}

/* ---- rules for Make and Ninja --------------------------------------------------------- */

bool batch_write_depfiles(cli_app *app, const batch_record *record, const batch_job *job)
{
    cli_arena arena = {0};
    cli_list dependencies = {0};
    bool good = true;
    for (size_t i = 0; i < record->input_count; i++)
        cli_list_add(&arena, &dependencies, record->inputs[i].path);
    if (job->parameter_file)
        cli_list_add(&arena, &dependencies, job->parameter_file);
    for (size_t i = 0; i < record->output_count && good; i++) {
        const char *path = record->outputs[i].path;
        cli_list targets = {&path, 1};
        good = cli_depfile_put(app, cli_arena_printf(&arena, "%s.d", path), &targets,
                               &dependencies) == CLI_DONE;
    }
    good = good && !arena.failed;
    cli_arena_reset(&arena);
    return good;
}
