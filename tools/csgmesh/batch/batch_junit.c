/* SPDX-License-Identifier: MIT
 * --junit: one test case a job, as CI servers read it. No time stamps.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "batch/batch_report.h"
#include "batch/batch_shard.h"
#include "core/junit.h"
#include "core/markup.h"
#include "core/options.h"
#include "core/textfile.h"

static void put_case(FILE *out, const batch_job *job, const batch_result *result)
{
    const char *messages = result->messages ? result->messages : "";
    fputs("  <testcase classname=\"", out);
    cli_put_markup(out, job->scene, CLI_XML_LINES);
    fputs("\" name=\"", out);
    cli_put_markup(out, job->names.count ? job->names.items[0] : job->title, CLI_XML_LINES);
    fprintf(out, "\" time=\"%.3f\">", result->seconds);
    if (result->outcome == BATCH_FAILED) {
        size_t line = strcspn(messages, "\n");
        char *first = strndup(messages, line);
        fputs("<failure message=\"", out);
        cli_put_markup(out, first ? first : "", CLI_XML_LINES);
        fputs("\">", out);
        cli_put_markup(out, messages, CLI_XML_LINES);
        fputs("</failure>", out);
        free(first);
    } else if (result->outcome == BATCH_NOT_RUN) {
        fputs("<skipped message=\"another job failed first\"/>", out);
    } else if (*messages) {
        fputs("<system-err>", out);
        cli_put_markup(out, messages, CLI_XML_LINES);
        fputs("</system-err>", out);
    }
    fputs("</testcase>\n", out);
}

/* Of which batch it is which part, for --merge-reports. */
static void put_properties(FILE *out, const batch_run *run)
{
    const batch_shard *shard = &run->plan->shard;
    char name[BATCH_JOB_NAME];
    batch_shard_name(shard, name);
    cli_junit_begin_properties(out);
    cli_junit_property(out, "version", csgm_version());
    cli_junit_property(out, "batch", name);
    cli_junit_count(out, "shard", shard->index);
    cli_junit_count(out, "shards", shard->count);
    cli_junit_count(out, "all_jobs", shard->all);
    cli_junit_end_properties(out);
}

static void put_suite(FILE *out, const batch_run *run)
{
    size_t failed = 0, skipped = 0;
    double seconds = 0;
    for (size_t i = 0; i < run->plan->count; i++) {
        failed += run->results[i].outcome == BATCH_FAILED;
        skipped += run->results[i].outcome == BATCH_NOT_RUN;
        seconds += run->results[i].seconds;
    }
    cli_junit_open(out, "batch",
                   &(cli_junit_counts){run->plan->count, failed, 0, skipped, seconds});
    put_properties(out, run);
    for (size_t i = 0; i < run->plan->count; i++)
        put_case(out, &run->plan->jobs[i], &run->results[i]);
    cli_junit_close(out);
}

int batch_junit_write(batch_run *run)
{
    cli_text text;
    if (cli_text_open(&text))
        put_suite(text.out, run);
    return cli_text_write(run->app, &text, run->app->options->junit);
}
