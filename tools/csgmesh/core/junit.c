/* SPDX-License-Identifier: MIT
 * See junit.h.
 */
#include "core/junit.h"

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

void cli_junit_close(FILE *out)
{
    fputs("</testsuite>\n", out);
}
