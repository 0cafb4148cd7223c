/* SPDX-License-Identifier: MIT
 * Reports of shards -> one report; see batch_merge.h. Lines of jobs are taken over as they are; the
 * sums are made again.
 */
#include "batch/batch_merge.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "batch/batch_lines.h"
#include "batch/batch_report.h"
#include "batch/batch_shard.h"
#include "core/options.h"
#include "core/sources.h"
#include "core/textfile.h"

batch_merge_job *batch_merge_add(batch_merge *merge)
{
    batch_merge_job *job =
        cli_arena_push(&merge->arena, (void **)&merge->jobs, &merge->job_count, sizeof *job);
    if (job)
        *job = (batch_merge_job){.report = merge->report_count - 1};
    return job;
}

int batch_merge_refuse(batch_merge *merge, const char *path)
{
    cli_console_say(&merge->app->console, CSGM_ERROR,
                    "as csgmesh batch --json or --junit has written it",
                    "%s: this is no report of a batch, or not the whole of one", path);
    return CLI_INPUT_AT_FAULT;
}

static int fail_memory(cli_app *app)
{
    cli_console_say(&app->console, CSGM_ERROR, NULL, "out of memory");
    return CLI_TROUBLE;
}

/* ---- lines of JSON -------------------------------------------------------------------- */

static bool outcome_of(const char *name, batch_outcome *out)
{
    for (int i = 0; name && i < BATCH_OUTCOMES; i++)
        if (strcmp(name, batch_outcome_name((batch_outcome)i)) == 0) {
            *out = (batch_outcome)i;
            return true;
        }
    return false;
}

/* A whole number that a count can hold, or 0. */
static size_t count_of(const cli_value *object, const char *key)
{
    double number = batch_line_number(object, key);
    return number >= 0 && number < 1e15 ? (size_t)number : 0;
}

static int take_sums(batch_merge *merge, const cli_value *sums)
{
    batch_merge_report *report = &merge->reports[merge->report_count - 1];
    const char *version = batch_line_text(sums, "version");
    const char *name = batch_line_text(sums, "batch");
    if (!version || !name)
        return batch_merge_refuse(merge, report->path);
    report->version = cli_arena_strdup(&merge->arena, version);
    report->name = cli_arena_strdup(&merge->arena, name);
    report->shard = count_of(sums, "shard");
    report->shards = count_of(sums, "shards");
    report->all_jobs = count_of(sums, "all_jobs");
    report->jobs = count_of(sums, "jobs");
    report->seconds = batch_line_number(sums, "seconds");
    report->is_whole = true;
    return CLI_DONE;
}

static int take_line(void *user, const batch_line *line)
{
    batch_merge *merge = user;
    const batch_merge_report *report = &merge->reports[merge->report_count - 1];
    const char *name = batch_line_text(line->object, "job");
    const char *outcome = batch_line_text(line->object, "outcome");
    batch_outcome known;
    if (line->is_last)
        return take_sums(merge, line->object);
    if (!name || !outcome_of(outcome, &known))
        return batch_merge_refuse(merge, report->path);
    batch_merge_job *job = batch_merge_add(merge);
    if (!job)
        return fail_memory(merge->app);
    job->name = cli_arena_strdup(&merge->arena, name);
    job->name_length = strlen(job->name);
    job->text = line->text;
    job->length = line->length;
    job->number = count_of(line->object, "number");
    job->outcome = known;
    job->status = (int)batch_line_number(line->object, "exit");
    return CLI_DONE;
}

static void put_sums(const batch_merge *merge, FILE *out)
{
    static const struct {
        batch_outcome outcome;
        const char *key;
    } rows[] = {{BATCH_MADE, "made"},
                {BATCH_CACHED, "cached"},
                {BATCH_UP_TO_DATE, "up_to_date"},
                {BATCH_FAILED, "failed"},
                {BATCH_NOT_RUN, "not_run"}};
    const batch_merge_report *first = merge->reports;
    size_t counts[BATCH_OUTCOMES] = {0};
    double longest_s = 0;
    for (size_t i = 0; i < merge->job_count; i++)
        counts[merge->jobs[i].outcome]++;
    for (size_t i = 0; i < merge->report_count; i++)
        if (merge->reports[i].seconds > longest_s)
            longest_s = merge->reports[i].seconds;
    cli_json json = cli_json_make(out, false);
    cli_json_begin(&json, '{');
    cli_json_count(&json, "jobs", merge->job_count);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        cli_json_count(&json, rows[i].key, counts[rows[i].outcome]);
    cli_json_number(&json, "seconds", longest_s);
    cli_json_string(&json, "version", first->version);
    cli_json_string(&json, "batch", first->name);
    cli_json_count(&json, "shards", first->shards);
    cli_json_count(&json, "all_jobs", first->all_jobs);
    cli_json_count(&json, "merged", merge->report_count);
    if (merge->report_count < first->shards) {
        cli_json_open(&json, "missing_shards", '[');
        for (size_t i = 1; i <= first->shards; i++)
            if (!merge->is_there[i])
                cli_json_count(&json, NULL, i);
        cli_json_end(&json, ']');
    }
    cli_json_end(&json, '}');
    fputc('\n', out);
}

static void write_json(const batch_merge *merge, FILE *out)
{
    for (size_t i = 0; i < merge->job_count; i++) {
        fwrite(merge->jobs[i].text, 1, merge->jobs[i].length, out);
        fputc('\n', out);
    }
    put_sums(merge, out);
}

/* ---- reading -------------------------------------------------------------------------- */

static bool is_xml(const char *text)
{
    return text[strspn(text, " \t\r\n")] == '<';
}

static int read_report(batch_merge *merge, const char *path)
{
    const size_t largest = (size_t)1 << 30;
    size_t length = 0, jobs_before = merge->job_count;
    int status = cli_sources_guard_file(merge->app, path);
    if (status != CLI_DONE)
        return status;
    char *bytes = cli_read_file(merge->app, path, largest, &length);
    char *text = bytes ? realloc(bytes, length + 1) : NULL;
    if (!text) {
        free(bytes);
        return bytes ? fail_memory(merge->app) : CLI_TROUBLE;
    }
    text[length] = '\0';
    batch_merge_report *report = &merge->reports[merge->report_count++];
    *report = (batch_merge_report){.path = path, .text = text};
    if (strlen(text) != length)
        return batch_merge_refuse(merge, path);
    if (is_xml(text))
        status = batch_merge_read_junit(merge, report);
    else
        status = batch_lines_visit(merge->app, path, text, length, take_line, merge);
    if (status == CLI_DONE && (!report->is_whole || merge->job_count - jobs_before != report->jobs))
        status = batch_merge_refuse(merge, path);
    return status;
}

/* ---- do they belong together? --------------------------------------------------------- */

static int check_report(batch_merge *merge, const batch_merge_report *report)
{
    cli_console *console = &merge->app->console;
    const batch_merge_report *first = merge->reports;
    if (is_xml(report->text) != is_xml(first->text))
        cli_console_say(console, CSGM_ERROR, NULL, "%s is JSON and %s is JUnit XML",
                        is_xml(first->text) ? report->path : first->path,
                        is_xml(first->text) ? first->path : report->path);
    else if (strcmp(report->version, first->version) != 0)
        cli_console_say(console, CSGM_ERROR, NULL,
                        "%s is by csgmesh %.40s and %s by csgmesh %.40s: no shards of one batch",
                        first->path, first->version, report->path, report->version);
    else if (strcmp(report->name, first->name) != 0 || report->shards != first->shards ||
             report->all_jobs != first->all_jobs)
        cli_console_say(console, CSGM_ERROR,
                        "all shards get the same scenes, options, --times and number of shards",
                        "%s and %s are of different batches", first->path, report->path);
    else if (!report->shard && report->shards)
        cli_console_say(console, CSGM_ERROR, NULL, "%s has been merged already", report->path);
    else if (report->shard < 1 || report->shard > report->shards ||
             report->shards > BATCH_SHARDS_MOST)
        return batch_merge_refuse(merge, report->path);
    else
        return CLI_DONE;
    return CLI_INPUT_AT_FAULT;
}

static int check_shards(batch_merge *merge)
{
    size_t shards = 0;
    for (size_t i = 0; i < merge->report_count; i++) {
        int status = check_report(merge, &merge->reports[i]);
        if (status != CLI_DONE)
            return status;
        shards = merge->reports[i].shards;
    }
    size_t *owner = cli_arena_alloc(&merge->arena, (shards + 1) * sizeof *owner);
    merge->is_there = cli_arena_alloc(&merge->arena, shards + 1);
    if (!owner || !merge->is_there)
        return fail_memory(merge->app);
    for (size_t i = 0; i < merge->report_count; i++) {
        size_t shard = merge->reports[i].shard;
        if (merge->is_there[shard]) {
            cli_console_say(&merge->app->console, CSGM_ERROR, "name the one that counts",
                            "%s and %s are both of shard %zu of %zu",
                            merge->reports[owner[shard]].path, merge->reports[i].path, shard,
                            shards);
            return CLI_INPUT_AT_FAULT;
        }
        merge->is_there[shard] = true;
        owner[shard] = i;
    }
    return CLI_DONE;
}

static int by_name(const void *a, const void *b)
{
    const batch_merge_job *left = a, *right = b;
    size_t least = left->name_length < right->name_length ? left->name_length : right->name_length;
    int order = memcmp(left->name, right->name, least);
    if (!order && left->name_length != right->name_length)
        order = left->name_length < right->name_length ? -1 : 1;
    return order ? order : left->text < right->text ? -1 : left->text > right->text;
}

static int by_number(const void *a, const void *b)
{
    const batch_merge_job *left = a, *right = b;
    if (left->number != right->number)
        return left->number < right->number ? -1 : 1;
    return by_name(a, b);
}

static int check_jobs(batch_merge *merge)
{
    batch_merge_job *jobs = merge->jobs;
    if (merge->job_count)
        qsort(jobs, merge->job_count, sizeof *jobs, by_name);
    for (size_t i = 1; i < merge->job_count; i++)
        if (jobs[i].name_length == jobs[i - 1].name_length &&
            memcmp(jobs[i].name, jobs[i - 1].name, jobs[i].name_length) == 0) {
            cli_console_say(
                &merge->app->console, CSGM_ERROR, NULL, "%s and %s have the same job, %.*s",
                merge->reports[jobs[i - 1].report].path, merge->reports[jobs[i].report].path,
                (int)(jobs[i].name_length < 200 ? jobs[i].name_length : 200), jobs[i].name);
            return CLI_INPUT_AT_FAULT;
        }
    if (merge->job_count)
        qsort(jobs, merge->job_count, sizeof *jobs, by_number);
    return CLI_DONE;
}

/* The report of what is there is written in any case: failures in it are worth knowing. */
static int say_missing(const batch_merge *merge)
{
    const batch_merge_report *first = merge->reports;
    char list[160] = "";
    size_t missing = 0;
    for (size_t i = 1; i <= first->shards; i++) {
        size_t used = strlen(list);
        missing += !merge->is_there[i];
        if (!merge->is_there[i] && used < sizeof list - 24)
            snprintf(list + used, sizeof list - used, "%s%zu", used ? ", " : "", i);
        else if (!merge->is_there[i] && list[used - 1] != '.')
            snprintf(list + used, sizeof list - used, ", ...");
    }
    if (missing && merge->job_count <= first->all_jobs)
        cli_console_say(
            &merge->app->console, CSGM_ERROR, NULL, "%s %s of %zu %s missing, with %zu of %zu jobs",
            missing == 1 ? "shard" : "shards", list, first->shards, missing == 1 ? "is" : "are",
            first->all_jobs - merge->job_count, first->all_jobs);
    else if (merge->job_count != first->all_jobs)
        cli_console_say(&merge->app->console, CSGM_ERROR, NULL,
                        "the reports have %zu jobs together, not the %zu of the batch",
                        merge->job_count, first->all_jobs);
    return missing || merge->job_count != first->all_jobs ? CLI_TROUBLE : CLI_DONE;
}

/* ---- the command ---------------------------------------------------------------------- */

static int check_usage(cli_app *app)
{
    const cli_options *o = app->options;
    const struct {
        bool given;
        const char *name;
    } unfit[] = {{o->directory, "-d"},  {o->shard, "--shard"}, {o->times, "--times"},
                 {o->cache, "--cache"}, {o->emit, "--emit"},   {o->junit, "--junit"},
                 {o->json, "--json"},   {o->watch, "--watch"}};
    if (!o->operands.count)
        return cli_usage_error(app, "as csgmesh batch --merge-reports report-*.json -o report.json",
                               "no reports given");
    for (size_t i = 0; i < sizeof unfit / sizeof *unfit; i++)
        if (unfit[i].given)
            return cli_usage_error(app, NULL, "--merge-reports and %s exclude each other",
                                   unfit[i].name);
    return CLI_DONE;
}

static int write_report(const batch_merge *merge)
{
    cli_text text;
    if (cli_text_open(&text) && is_xml(merge->reports->text))
        batch_merge_write_junit(merge, text.out);
    else if (text.out)
        write_json(merge, text.out);
    return cli_text_write(merge->app, &text,
                          merge->app->options->merged ? merge->app->options->merged : "-");
}

static int worst_of(const batch_merge *merge)
{
    int worst = CLI_DONE;
    for (size_t i = 0; i < merge->job_count; i++)
        if (merge->jobs[i].outcome == BATCH_FAILED && merge->jobs[i].status > worst)
            worst = merge->jobs[i].status;
    return worst < CLI_TROUBLE ? worst : CLI_TROUBLE;
}

static int merge_all(batch_merge *merge)
{
    const cli_list *paths = &merge->app->options->operands;
    int status = CLI_DONE;
    merge->reports = cli_arena_alloc(&merge->arena, paths->count * sizeof *merge->reports);
    if (!merge->reports)
        return fail_memory(merge->app);
    for (size_t i = 0; i < paths->count && status == CLI_DONE; i++)
        status = read_report(merge, paths->items[i]);
    if (status == CLI_DONE)
        status = check_shards(merge);
    if (status == CLI_DONE)
        status = check_jobs(merge);
    if (status != CLI_DONE)
        return status;
    int missing = say_missing(merge), written = write_report(merge), worst = worst_of(merge);
    return written != CLI_DONE || missing != CLI_DONE ? CLI_TROUBLE : worst;
}

int batch_merge_reports(cli_app *app)
{
    batch_merge merge = {.app = app};
    int status = check_usage(app);
    if (status == CLI_DONE)
        status = cli_app_open(app);
    if (status == CLI_DONE)
        status = merge_all(&merge);
    for (size_t i = 0; i < merge.report_count; i++)
        free(merge.reports[i].text);
    cli_arena_reset(&merge.arena);
    return cli_finish_stdout(app, status);
}
