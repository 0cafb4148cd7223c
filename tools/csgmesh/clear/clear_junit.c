/* SPDX-License-Identifier: MIT
 * --junit of clear: one test case a pair of parts.
 */
#include "clear/clear_print.h"
#include "core/junit.h"
#include "core/markup.h"
#include "core/options.h"
#include "core/textfile.h"

static void put_case(FILE *out, const cli_cleared *c, const csgm_clear_pair *p)
{
    char a[96], b[96], text[600];
    cli_verdict verdict = cli_verdict_of(c, p);
    fputs("  <testcase classname=\"", out);
    cli_put_markup(out, c->path, CLI_XML_LINES);
    fputs("\" name=\"", out);
    cli_put_markup(out, cli_clear_name(p->names[0], a), CLI_XML_LINES);
    fputs(" and ", out);
    cli_put_markup(out, cli_clear_name(p->names[1], b), CLI_XML_LINES);
    fputs("\" time=\"0\">", out);
    if (verdict != CLI_PAIR_CLEAR) {
        cli_clear_say(c, p, text, sizeof text);
        fprintf(out, "<%s message=\"", verdict == CLI_PAIR_BAD ? "failure" : "error");
        cli_put_markup(out, text, CLI_XML_LINES);
        fputs("\"/>", out);
    }
    if (p->steps) {
        cli_clear_say_between(c, p, text, sizeof text);
        fputs("<system-out>between poses: ", out);
        cli_put_markup(out, text, CLI_XML_LINES);
        fputs("</system-out>", out);
    }
    fputs("</testcase>\n", out);
}

int cli_clear_junit(cli_app *app, const cli_cleared *c)
{
    cli_text text;
    cli_junit_counts counts = {.tests = 0};
    const csgm_clear_pair *p;
    for (size_t i = 0; (p = csgm_clearances_get(c->pairs, i)) != NULL; i++) {
        counts.tests++;
        counts.failures += cli_verdict_of(c, p) == CLI_PAIR_BAD;
        counts.errors += cli_verdict_of(c, p) == CLI_PAIR_OPEN;
    }
    if (cli_text_open(&text)) {
        cli_junit_open(text.out, "clear", &counts);
        for (size_t i = 0; (p = csgm_clearances_get(c->pairs, i)) != NULL; i++)
            put_case(text.out, c, p);
        cli_junit_close(text.out);
    }
    return cli_text_write(app, &text, app->options->clear_junit);
}
