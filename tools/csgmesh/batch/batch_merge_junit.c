/* SPDX-License-Identifier: MIT
 * Merging JUnit XML that batch_junit.c has written: only its own form is read, in which a test case
 * is from "  <testcase " to "</testcase>\n" (a text in it has no '<').
 */
#include <stdlib.h>
#include <string.h>

#include "batch/batch_merge.h"
#include "core/junit.h"

static const char HEAD[] = "<testsuite name=\"csgmesh batch\" ";
static const char CASE[] = "  <testcase ", END_OF_CASE[] = "</testcase>\n";

static const char *past(const char *text, const char *end, const char *what)
{
    const char *at = text ? strstr(text, what) : NULL;
    return at && at < end ? at + strlen(what) : NULL;
}

/* What stands in quotes behind `what`; NULL: it is not there. */
static const char *quoted(cli_arena *arena, const char *text, const char *end, const char *what)
{
    const char *at = past(text, end, what);
    return at ? cli_arena_strndup(arena, at, strcspn(at, "\"")) : NULL;
}

static const char *property(batch_merge *merge, const char *text, const char *end, const char *name)
{
    const char *what = cli_arena_printf(&merge->arena, "<property name=\"%s\" value=\"", name);
    return quoted(&merge->arena, text, end, what);
}

static size_t number(const char *text)
{
    return text ? strtoul(text, NULL, 10) : 0;
}

/* The name of a test case is both its class and its name. */
static bool take_case(batch_merge *merge, const char *text, const char *end)
{
    const char *name = past(text, end, "classname=\"");
    const char *time = past(name, end, "\" time=\"");
    const char *inside = past(time, end, "\">");
    batch_merge_job *job = inside ? batch_merge_add(merge) : NULL;
    if (!job)
        return false;
    job->name = name;
    job->name_length = (size_t)(time - name) - strlen("\" time=\"");
    job->text = text;
    job->length = (size_t)(end - text);
    job->outcome = strncmp(inside, "<failure ", 9) == 0   ? BATCH_FAILED
                   : strncmp(inside, "<skipped ", 9) == 0 ? BATCH_NOT_RUN
                                                          : BATCH_MADE;
    job->status = CLI_INPUT_AT_FAULT; /* more it does not say */
    return true;
}

int batch_merge_read_junit(batch_merge *merge, batch_merge_report *report)
{
    cli_arena *arena = &merge->arena;
    const char *all = report->text, *end = all + strlen(all);
    const char *head = past(all, end, HEAD), *facts = past(head, end, "<properties>\n");
    const char *at = past(facts, end, "</properties>\n");
    if (!at)
        return batch_merge_refuse(merge, report->path);
    report->version = property(merge, facts, at, "version");
    report->name = property(merge, facts, at, "batch");
    report->shard = number(property(merge, facts, at, "shard"));
    report->shards = number(property(merge, facts, at, "shards"));
    report->all_jobs = number(property(merge, facts, at, "all_jobs"));
    report->jobs = number(quoted(arena, head, facts, "tests=\""));
    const char *time = quoted(arena, head, facts, " time=\"");
    report->seconds = time ? strtod(time, NULL) : 0;
    while (strncmp(at, CASE, sizeof CASE - 1) == 0) {
        const char *behind = past(at, end, END_OF_CASE);
        if (!behind || !take_case(merge, at, behind))
            return batch_merge_refuse(merge, report->path);
        at = behind;
    }
    report->is_whole = report->version && report->name && strcmp(at, "</testsuite>\n") == 0;
    return report->is_whole ? CLI_DONE : batch_merge_refuse(merge, report->path);
}

void batch_merge_write_junit(const batch_merge *merge, FILE *out)
{
    const batch_merge_report *first = merge->reports;
    cli_junit_counts counts = {.tests = merge->job_count};
    for (size_t i = 0; i < merge->report_count; i++)
        counts.seconds += merge->reports[i].seconds;
    for (size_t i = 0; i < merge->job_count; i++) {
        counts.failures += merge->jobs[i].outcome == BATCH_FAILED;
        counts.skipped += merge->jobs[i].outcome == BATCH_NOT_RUN;
    }
    cli_junit_open(out, "batch", &counts);
    cli_junit_begin_properties(out);
    cli_junit_property(out, "version", first->version);
    cli_junit_property(out, "batch", first->name);
    cli_junit_count(out, "shards", first->shards);
    cli_junit_count(out, "all_jobs", first->all_jobs);
    cli_junit_count(out, "merged", merge->report_count);
    cli_junit_end_properties(out);
    for (size_t i = 0; i < merge->job_count; i++)
        fwrite(merge->jobs[i].text, 1, merge->jobs[i].length, out);
    cli_junit_close(out);
}
