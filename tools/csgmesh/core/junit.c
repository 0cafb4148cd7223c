/* SPDX-License-Identifier: MIT
 * See junit.h.
 */
#include "core/junit.h"

#include "core/markup.h"

void cli_junit_open(FILE *out, const char *command, const cli_junit_counts *counts)
{
    fprintf(out,
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuite name=\"csgmesh %s\" "
            "tests=\"%zu\" failures=\"%zu\" errors=\"%zu\" skipped=\"%zu\"",
            command, counts->tests, counts->failures, counts->errors, counts->skipped);
    if (counts->seconds >= 0)
        fprintf(out, " time=\"%.3f\"", counts->seconds);
    fputs(">\n", out);
}

void cli_junit_begin_properties(FILE *out)
{
    fputs("  <properties>\n", out);
}

void cli_junit_property(FILE *out, const char *name, const char *value)
{
    fprintf(out, "    <property name=\"%s\" value=\"", name);
    cli_put_markup(out, value, CLI_XML);
    fputs("\"/>\n", out);
}

void cli_junit_count(FILE *out, const char *name, size_t value)
{
    fprintf(out, "    <property name=\"%s\" value=\"%zu\"/>\n", name, value);
}

void cli_junit_end_properties(FILE *out)
{
    fputs("  </properties>\n", out);
}

void cli_junit_close(FILE *out)
{
    fputs("</testsuite>\n", out);
}
