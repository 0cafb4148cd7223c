/* SPDX-License-Identifier: MIT
 * Reports for people and programs; see batch_report.h. Failures are told when they happen; what
 * goes to standard output is in the order of the jobs, whatever the number of threads.
 */
#include "batch/batch_report.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "batch/batch_shard.h"
#include "core/interrupt.h"
#include "core/json.h"
#include "core/options.h"

const char *batch_outcome_name(batch_outcome outcome)
{
    static const char *const names[BATCH_OUTCOMES] = {[BATCH_NOT_RUN] = "not run",
                                                      [BATCH_UP_TO_DATE] = "up to date",
                                                      [BATCH_CACHED] = "cached",
                                                      [BATCH_MADE] = "made",
                                                      [BATCH_FAILED] = "failed"};
    return names[outcome];
}

/* ---- while it runs -------------------------------------------------------------------- */

static void put_headline(const cli_console *console, const batch_job *job, bool failed)
{
    bool from_manifest = strstr(job->place, ": jobs[") != NULL;
    fprintf(stderr, "%s%s%s: %s",
            !console->color ? ""
            : failed        ? "\033[1;31m"
                            : "\033[1;36m",
            failed ? "failed" : "note", console->color ? "\033[0m" : "", job->title);
    if (from_manifest)
        fprintf(stderr, ", %s", job->place);
    fputc('\n', stderr);
}

void batch_report_job(batch_run *run, size_t index)
{
    const batch_result *result = &run->results[index];
    cli_console *console = &run->app->console;
    const char *text = result->messages;
    bool failed = result->outcome == BATCH_FAILED;
    if (!failed && (!text || !*text))
        return;
    cli_console_end_progress(console);
    if (!console->json)
        put_headline(console, &run->plan->jobs[index], failed);
    if (text)
        fputs(text, stderr);
}

void batch_report_warn(batch_run *run, const char *format, ...)
{
    char message[600];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    pthread_mutex_lock(&run->mutex);
    cli_console_end_progress(&run->app->console);
    cli_console_say(&run->app->console, CSGM_WARNING, NULL, "%s", message);
    pthread_mutex_unlock(&run->mutex);
}

static const double PATIENCE_S = 0.5; /* shorter work shows no bar */

void batch_report_progress(batch_run *run)
{
    enum { AUTO, ALWAYS, WIDTH = 30 };
    const cli_console *console = &run->app->console;
    double elapsed_s = cli_now_s() - run->app->start_s;
    bool wanted = console->progress == ALWAYS ||
                  (console->progress == AUTO && console->is_terminal && elapsed_s > PATIENCE_S);
    if (!wanted || console->quiet || console->json)
        return;
    char bar[WIDTH + 1];
    size_t total = run->plan->count, failed = run->ended[BATCH_FAILED];
    size_t filled = total ? run->finished * WIDTH / total : 0;
    size_t skipped = run->ended[BATCH_UP_TO_DATE];
    double rate = elapsed_s > 0 ? (double)(run->finished - skipped) / elapsed_s : 0;
    for (size_t i = 0; i < WIDTH; i++)
        bar[i] = i < filled ? '=' : i == filled ? '>' : ' ';
    bar[WIDTH] = '\0';
    fprintf(stderr, "\r[%s] %zu/%zu", bar, run->finished, total);
    if (rate > 0)
        fprintf(stderr, "  %.1f/s  %.0f s left", rate, (double)(total - run->finished) / rate);
    if (failed)
        fprintf(stderr, "  %zu failed", failed);
    fputs(console->is_terminal ? "\033[K" : "   ", stderr);
    fflush(stderr);
    cli_interrupt_progress_shown(true);
}

/* ---- JSON lines ----------------------------------------------------------------------- */

static void put_outputs(cli_json *json, const batch_result *result)
{
    cli_json_open(json, "outputs", '[');
    for (size_t i = 0; i < result->output_count; i++) {
        const batch_output *output = &result->outputs[i];
        cli_json_open(json, NULL, '{');
        cli_json_string(json, "file", output->path);
        cli_json_string(json, "format", output->format);
        if (output->part)
            cli_json_string(json, "part", output->part);
        cli_json_count(json, "bytes", output->bytes);
        cli_json_end(json, '}');
    }
    cli_json_end(json, ']');
}

static void put_job(const batch_job *job, const batch_result *result)
{
    cli_json json = cli_json_make(stdout, false);
    char name[BATCH_JOB_NAME];
    batch_job_name(job, name);
    cli_json_begin(&json, '{');
    cli_json_string(&json, "scene", job->scene);
    if (job->set)
        cli_json_string(&json, "set", job->set);
    cli_json_string(&json, "outcome", batch_outcome_name(result->outcome));
    if (result->outcome == BATCH_FAILED)
        cli_json_integer(&json, "exit", result->status);
    else
        put_outputs(&json, result);
    if (result->outcome == BATCH_MADE)
        cli_json_count(&json, "triangles", result->triangles);
    if (result->outcome != BATCH_NOT_RUN)
        cli_json_number(&json, "seconds", result->seconds);
    if (result->cpu_seconds > 0)
        cli_json_number(&json, "cpu_seconds", result->cpu_seconds);
    cli_json_string(&json, "job", name);
    cli_json_count(&json, "number", job->number);
    if (result->messages && *result->messages)
        cli_json_string(&json, "messages", result->messages);
    cli_json_end(&json, '}');
    putchar('\n');
}

static size_t count_of(const batch_run *run, batch_outcome outcome)
{
    size_t count = 0;
    for (size_t i = 0; i < run->plan->count; i++)
        count += run->results[i].outcome == outcome;
    return count;
}

static void put_summary_json(const batch_run *run, double seconds)
{
    cli_json json = cli_json_make(stdout, false);
    char name[BATCH_JOB_NAME];
    cli_json_begin(&json, '{');
    cli_json_count(&json, "jobs", run->plan->count);
    cli_json_count(&json, "made", count_of(run, BATCH_MADE));
    cli_json_count(&json, "cached", count_of(run, BATCH_CACHED));
    cli_json_count(&json, "up_to_date", count_of(run, BATCH_UP_TO_DATE));
    cli_json_count(&json, "failed", count_of(run, BATCH_FAILED));
    cli_json_count(&json, "not_run", count_of(run, BATCH_NOT_RUN));
    cli_json_number(&json, "seconds", seconds);
    cli_json_string(&json, "version", csgm_version());
    batch_shard_name(&run->plan->shard, name);
    cli_json_string(&json, "batch", name);
    cli_json_count(&json, "shard", run->plan->shard.index);
    cli_json_count(&json, "shards", run->plan->shard.count);
    cli_json_count(&json, "all_jobs", run->plan->shard.all);
    cli_json_end(&json, '}');
    putchar('\n');
}

/* ---- the summary ---------------------------------------------------------------------- */

static cli_mood mood_of(batch_outcome outcome)
{
    return outcome == BATCH_FAILED ? CLI_BAD : outcome == BATCH_NOT_RUN ? CLI_MIXED : CLI_GOOD;
}

static void put_row(const batch_run *run, batch_outcome outcome)
{
    size_t jobs = 0, files = 0;
    uint64_t bytes = 0;
    for (size_t i = 0; i < run->plan->count; i++) {
        const batch_result *result = &run->results[i];
        if (result->outcome != outcome)
            continue;
        jobs++;
        files += outcome == BATCH_FAILED ? 0 : result->output_count;
        for (size_t j = 0; j < result->output_count; j++)
            bytes += result->outputs[j].bytes;
    }
    if (!jobs)
        return;
    char name[16], painted[40];
    snprintf(name, sizeof name, "%-10s", batch_outcome_name(outcome));
    printf("%s %6zu",
           cli_console_paint(&run->app->console, name, mood_of(outcome), painted, sizeof painted),
           jobs);
    if (files)
        printf(" %8zu %10.1f", files, (double)bytes / (1 << 20));
    putchar('\n');
}

static void put_summary(const batch_run *run, double seconds)
{
    const batch_shard *shard = &run->plan->shard;
    static const batch_outcome order[] = {BATCH_MADE, BATCH_CACHED, BATCH_UP_TO_DATE, BATCH_FAILED,
                                          BATCH_NOT_RUN};
    puts("             jobs    files        MiB");
    for (size_t i = 0; i < sizeof order / sizeof *order; i++)
        put_row(run, order[i]);
    printf("%-10s %6zu   in %.2f s\n", "all", run->plan->count, seconds);
    if (run->app->options->shard)
        printf("shard %" PRIu32 " of %" PRIu32 " of a batch of %zu jobs\n", shard->index,
               shard->count, shard->all);
}

int batch_report_end(batch_run *run)
{
    cli_app *app = run->app;
    double seconds = cli_now_s() - app->start_s;
    int worst = CLI_DONE;
    cli_console_end_progress(&app->console);
    for (size_t i = 0; i < run->plan->count; i++)
        if (run->results[i].outcome == BATCH_FAILED && run->results[i].status > worst)
            worst = run->results[i].status;
    for (size_t i = 0; app->options->json && i < run->plan->count; i++)
        put_job(&run->plan->jobs[i], &run->results[i]);
    if (app->options->json)
        put_summary_json(run, seconds);
    else if (!app->console.quiet)
        put_summary(run, seconds);
    for (size_t i = 0; i < run->plan->count && !app->overwriter; i++)
        app->overwriter = run->results[i].endangers_files ? "--junit" : NULL;
    int junit = app->options->junit && !app->overwriter ? batch_junit_write(run) : CLI_DONE;
    return cli_finish_stdout(app, junit > worst ? junit : worst);
}
