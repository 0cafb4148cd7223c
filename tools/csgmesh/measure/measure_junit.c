/* SPDX-License-Identifier: MIT
 * --junit of measure: one test case a condition, as CI servers read it. No time stamps.
 */
#include "core/junit.h"
#include "core/markup.h"
#include "core/options.h"
#include "core/textfile.h"
#include "measure/measure_print.h"

static void put_case(FILE *out, const char *path, const cli_check *check)
{
    fputs("  <testcase classname=\"", out);
    cli_put_markup(out, path, CLI_XML_LINES);
    fputs("\" name=\"", out);
    cli_put_markup(out, check->text, CLI_XML_LINES);
    fputs("\" time=\"0\">", out);
    if (check->truth != CLI_HOLDS)
        fprintf(out, "<failure message=\"%s\"/>", cli_truth_name(check->truth));
    fputs("</testcase>\n", out);
}

int cli_measure_junit(cli_app *app, const cli_measured *measured)
{
    cli_text text;
    size_t failures = 0;
    for (size_t i = 0; i < measured->checks.count; i++)
        failures += measured->checks.items[i].truth != CLI_HOLDS;
    if (cli_text_open(&text)) {
        cli_junit_open(text.out, "measure",
                       &(cli_junit_counts){measured->checks.count, failures, 0, 0, 0});
        for (size_t i = 0; i < measured->checks.count; i++)
            put_case(text.out, measured->path, &measured->checks.items[i]);
        cli_junit_close(text.out);
    }
    return cli_text_write(app, &text, app->options->measure_junit);
}
