/* SPDX-License-Identifier: MIT
 * diff --html: one page that needs nothing else, no network and no server. Its frame is
 * report/page.html with style and scripts in it; here the comparisons are put in, as JSON for the
 * script and as plain words for those who allow no scripts.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/markup.h"
#include "core/options.h"
#include "core/textfile.h"
#include "diff/diff_report.h"

static const unsigned char page[] = {
#include <report_page.inc> /* made by ../page/embed.py */
};

static const char *const verdicts[] = {"same", "different", "only in A", "only in B", "failed"};

/* The last two names of an absolute path: the page is read on other machines. */
static const char *name_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    if (path[0] != '/' || slash == path)
        return path;
    for (const char *at = slash - 1; at >= path; at--)
        if (*at == '/')
            return at + 1;
    return path;
}

/* ---- words ----------------------------------------------------------------------------------- */

static void put_title(FILE *out, const diff_results *results)
{
    size_t same = 0;
    for (size_t i = 0; i < results->count; i++)
        same += results->items[i].outcome == DIFF_SAME;
    if (results->of_folders) {
        fprintf(out, "%zu of %zu same", same, results->count);
        return;
    }
    const diff_result *only = &results->items[0];
    fprintf(out, "%s: ", verdicts[only->outcome]);
    cli_put_markup(out, name_of(only->b ? only->b : only->a), CLI_HTML);
}

static void put_plain(FILE *out, const diff_results *results)
{
    for (size_t i = 0; i < results->count; i++) {
        const diff_result *result = &results->items[i];
        char reason[512];
        diff_explain(result, reason, sizeof reason);
        fprintf(out, "<p><b>%s</b>: ", verdicts[result->outcome]);
        cli_put_markup(out, result->a ? name_of(result->a) : "", CLI_HTML);
        fputs(result->a && result->b ? " and " : "", out);
        cli_put_markup(out, result->b ? name_of(result->b) : "", CLI_HTML);
        fputs(": ", out);
        cli_put_markup(out, reason, CLI_HTML);
        fputs("</p>\n", out);
    }
}

/* ---- data ------------------------------------------------------------------------------------ */

static void put_pair(cli_json *json, const diff_result *result)
{
    char reason[512];
    diff_explain(result, reason, sizeof reason);
    cli_json_break(json);
    cli_json_open(json, NULL, '{');
    if (result->a)
        cli_json_string(json, "file_a", name_of(result->a));
    if (result->b)
        cli_json_string(json, "file_b", name_of(result->b));
    cli_json_string(json, "verdict", verdicts[result->outcome]);
    cli_json_string(json, "why", reason);
    cli_json_bool(json, "updated", result->is_updated);
    if (result->outcome <= DIFF_DIFFERENT) {
        cli_json_open(json, "report", '{');
        diff_put_report(json, &result->report);
        cli_json_end(json, '}');
    }
    if (result->models)
        cli_json_verbatim(json, "models", result->models);
    cli_json_end(json, '}');
}

static void put_json(FILE *out, const diff_results *results)
{
    cli_json json = cli_json_make(out, false);
    cli_json_begin(&json, '{');
    cli_json_string(&json, "csgmesh", csgm_version());
    cli_json_bool(&json, "folders", results->of_folders);
    cli_json_open(&json, "pairs", '[');
    for (size_t i = 0; i < results->count; i++)
        put_pair(&json, &results->items[i]);
    cli_json_end(&json, ']');
    cli_json_end(&json, '}');
}

/* No "</script>" or "<!--" ends the data: '<' is only in strings there. */
static bool put_data(FILE *out, const diff_results *results)
{
    cli_text json;
    if (cli_text_open(&json))
        put_json(json.out, results);
    char *text = cli_text_close(&json);
    for (size_t i = 0; text && i < json.length; i++)
        if (text[i] == '<')
            fputs("\\u003c", out);
        else
            fputc(text[i], out);
    free(text);
    return text != NULL;
}

/* ---- the page -------------------------------------------------------------------------------- */

static bool is_marker(size_t at, const char *marker)
{
    size_t length = strlen(marker);
    return at + length <= sizeof page && memcmp(page + at, marker, length) == 0;
}

static bool put_page(FILE *out, const diff_results *results)
{
    static const char title[] = "{{title}}", plain[] = "{{plain}}", data[] = "{{data}}";
    bool good = true;
    for (size_t at = 0; at < sizeof page; at++)
        if (is_marker(at, title)) {
            put_title(out, results);
            at += strlen(title) - 1;
        } else if (is_marker(at, plain)) {
            put_plain(out, results);
            at += strlen(plain) - 1;
        } else if (is_marker(at, data)) {
            good = put_data(out, results) && good;
            at += strlen(data) - 1;
        } else {
            fputc(page[at], out);
        }
    return good;
}

int diff_write_html(cli_app *app, const diff_results *results)
{
    cli_text text;
    if (!cli_text_open(&text) || put_page(text.out, results))
        return cli_text_write(app, &text, app->options->diff_html);
    free(cli_text_close(&text));
    cli_console_say(&app->console, CSGM_ERROR, NULL, "out of memory");
    return CLI_TROUBLE;
}
