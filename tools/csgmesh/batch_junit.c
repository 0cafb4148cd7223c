/* SPDX-License-Identifier: MIT
 * --junit: one test case a job, as CI servers read it. No time stamps; what XML cannot hold becomes
 * a question mark.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "batch_report.h"
#include "textfile.h"

static void put_escaped(FILE *out, const char *text)
{
    for (; *text; text++) {
        unsigned char c = (unsigned char)*text;
        switch (c) {
        case '&':
            fputs("&amp;", out);
            break;
        case '<':
            fputs("&lt;", out);
            break;
        case '>':
            fputs("&gt;", out);
            break;
        case '"':
            fputs("&quot;", out);
            break;
        default:
            fputc((c < 0x20 && c != '\n' && c != '\t') || c == 0x7F ? '?' : c, out);
        }
    }
}

static void put_case(FILE *out, const batch_job *job, const batch_result *result)
{
    const char *messages = result->messages ? result->messages : "";
    fputs("  <testcase classname=\"", out);
    put_escaped(out, job->scene);
    fputs("\" name=\"", out);
    put_escaped(out, job->names.count ? job->names.items[0] : job->title);
    fprintf(out, "\" time=\"%.3f\">", result->seconds);
    if (result->outcome == BATCH_FAILED) {
        size_t line = strcspn(messages, "\n");
        char *first = strndup(messages, line);
        fputs("<failure message=\"", out);
        put_escaped(out, first ? first : "");
        fputs("\">", out);
        put_escaped(out, messages);
        fputs("</failure>", out);
        free(first);
    } else if (result->outcome == BATCH_NOT_RUN) {
        fputs("<skipped message=\"another job failed first\"/>", out);
    } else if (*messages) {
        fputs("<system-err>", out);
        put_escaped(out, messages);
        fputs("</system-err>", out);
    }
    fputs("</testcase>\n", out);
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
    fprintf(out,
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuite name=\"csgmesh batch\" "
            "tests=\"%zu\" failures=\"%zu\" errors=\"0\" skipped=\"%zu\" time=\"%.3f\">\n",
            run->plan->count, failed, skipped, seconds);
    for (size_t i = 0; i < run->plan->count; i++)
        put_case(out, &run->plan->jobs[i], &run->results[i]);
    fputs("</testsuite>\n", out);
}

int batch_junit_write(batch_run *run)
{
    char *text = NULL;
    size_t length = 0;
    FILE *out = open_memstream(&text, &length);
    if (out)
        put_suite(out, run);
    int status = CLI_TROUBLE;
    if (out && fclose(out) == 0)
        status = cli_write_text(run->app, run->app->options.junit, text, length);
    else
        cli_console_say(&run->app->console, CSGM_ERROR, NULL, "out of memory");
    free(text);
    return status;
}
