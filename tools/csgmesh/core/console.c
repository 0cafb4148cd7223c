/* SPDX-License-Identifier: MIT
 * Standard error; see console.h.
 */
#include "core/console.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "core/cli.h"
#include "core/interrupt.h"
#include "core/options.h"

static const char RESET[] = "\033[0m", BOLD[] = "\033[1m", GREEN[] = "\033[1;32m";
static const char *const severity_colors[] = {"\033[1;36m", "\033[1;35m", "\033[1;31m"};
static const char *const severity_names[] = {"note", "warning", "error"};

cli_console cli_console_make(void)
{
    const char *no_color = getenv("NO_COLOR");
    bool is_terminal = isatty(STDERR_FILENO);
    bool may_color = !(no_color && *no_color);
    return (cli_console){.out = stderr,
                         .is_terminal = is_terminal,
                         .color = is_terminal && may_color,
                         .color_results = may_color && isatty(STDOUT_FILENO),
                         .stage = -1};
}

void cli_console_configure(cli_console *console, const cli_options *options)
{
    enum { AUTO, ALWAYS };
    if (options->color != AUTO)
        console->color = console->color_results = options->color == ALWAYS;
    console->quiet = options->quiet;
    console->json = options->diagnostics == 1;
    console->progress = options->progress;
}

/* -q drops warnings and the notes that follow them. */
static bool is_muted(cli_console *console, csgm_severity severity)
{
    console->errors += severity == CSGM_ERROR;
    console->warnings += severity == CSGM_WARNING;
    if (severity != CSGM_NOTE)
        console->mute_notes = console->quiet && severity == CSGM_WARNING;
    return console->mute_notes;
}

static void put_place(cli_json *json, const csgm_diag *diag)
{
    if (diag->source_name)
        cli_json_string(json, "file", diag->source_name);
    if (!diag->line)
        return;
    cli_json_count(json, "line", diag->line);
    cli_json_count(json, "column", diag->column);
    cli_json_count(json, "end_line", diag->end_line);
    cli_json_count(json, "end_column", diag->end_column);
}

void cli_console_flush(cli_console *console)
{
    if (!console->held)
        return;
    if (console->held_has_notes)
        cli_json_end(&console->held_json, ']');
    cli_json_end(&console->held_json, '}');
    fputc('\n', console->held);
    if (fclose(console->held) == 0)
        fwrite(console->held_text, 1, console->held_length, console->out);
    free(console->held_text);
    console->held = NULL;
    console->held_text = NULL;
    console->held_has_notes = false;
}

static void put_finding(cli_json *json, csgm_severity severity, const csgm_diag *diag)
{
    cli_json_begin(json, '{');
    cli_json_string(json, "severity", severity_names[severity]);
    if (diag->code && severity != CSGM_NOTE) {
        char code[16];
        snprintf(code, sizeof code, "%c%04u", "NWE"[severity], diag -> code);
        cli_json_string(json, "code", code);
    }
    put_place(json, diag);
    cli_json_string(json, "message", diag->message);
    if (diag->hint)
        cli_json_string(json, "hint", diag->hint);
}

/* A finding is held back until its notes have come: they stand inside it. */
static void print_json(cli_console *console, csgm_severity severity, const csgm_diag *diag)
{
    cli_json *json = &console->held_json;
    if (severity == CSGM_NOTE && diag->line && console->held) {
        if (!console->held_has_notes)
            cli_json_open(json, "notes", '[');
        console->held_has_notes = true;
        cli_json_open(json, NULL, '{');
        put_place(json, diag);
        cli_json_string(json, "message", diag->message);
        cli_json_end(json, '}');
        return;
    }
    cli_console_flush(console);
    console->held = open_memstream(&console->held_text, &console->held_length);
    if (!console->held) { /* no memory: its notes become findings of their own */
        cli_json direct = cli_json_make(console->out, false);
        put_finding(&direct, severity, diag);
        cli_json_end(&direct, '}');
        fputc('\n', console->out);
        return;
    }
    *json = cli_json_make(console->held, false);
    put_finding(json, severity, diag);
}

/* The place bold, "error E0107:" in its colour, the caret line green. */
static void print_colored(FILE *out, csgm_severity severity, const csgm_diag *diag,
                          const char *text)
{
    const char *line_end = strchr(text, '\n');
    const char *word = NULL;
    size_t place = diag->source_name ? strlen(diag->source_name) : 0;
    if (place <= strlen(text))
        word = strstr(text + place, severity_names[severity]);
    const char *colon = word ? strchr(word, ':') : NULL;
    if (!word || !colon || !line_end || word > line_end) {
        fputs(text, out);
        return;
    }
    fprintf(out, "%s%.*s%s%.*s%s%s%.*s%s\n", BOLD, (int)(word - text), text,
            severity_colors[severity], (int)(colon + 1 - word), word, RESET, BOLD,
            (int)(line_end - colon - 1), colon + 1, RESET);
    const char *rest = line_end + 1;
    if (diag->source_line && diag->line) { /* the source line, then the caret */
        const char *source_end = memchr(rest, '\n', strlen(rest));
        const char *caret_end = source_end ? strchr(source_end + 1, '\n') : NULL;
        if (caret_end) {
            fprintf(out, "%.*s%s%.*s%s\n", (int)(source_end + 1 - rest), rest, GREEN,
                    (int)(caret_end - source_end - 1), source_end + 1, RESET);
            rest = caret_end + 1;
        }
    }
    fputs(rest, out);
}

/* Of a finding that is an error in a strict text. */
static void count_lenient(cli_console *console, uint16_t code)
{
    size_t i = 0;
    while (i + 1 < CLI_KINDS_MOST && console->kinds[i].code && console->kinds[i].code != code)
        i++;
    console->kinds[i].code = code;
    console->kinds[i].count++;
    console->lenient++;
}

bool cli_silence_begin(cli_silence *silence, cli_console *console)
{
    cli_console_flush(console); /* what is held back was said before */
    *silence = (cli_silence){.nowhere = fopen("/dev/null", "we"), .kept = *console};
    if (silence->nowhere)
        console->out = silence->nowhere;
    return silence->nowhere != NULL;
}

void cli_silence_end(cli_silence *silence, cli_console *console)
{
    if (!silence->nowhere)
        return;
    cli_console_flush(console);
    *console = silence->kept;
    fclose(silence->nowhere);
}

void cli_console_summary(cli_console *console)
{
    char kinds[16 * CLI_KINDS_MOST] = "";
    for (size_t i = 0, at = 0; i < CLI_KINDS_MOST && console->kinds[i].code; i++)
        at += (size_t)snprintf(kinds + at, sizeof kinds - at, "%s%04u: %u", i ? ", " : "",
                               (unsigned)console->kinds[i].code, console->kinds[i].count);
    cli_console_flush(console);
    if (console->json) {
        cli_json json = cli_json_make(console->out, false);
        cli_json_begin(&json, '{');
        cli_json_open(&json, "summary", '{');
        cli_json_count(&json, "errors", console->errors);
        cli_json_count(&json, "warnings", console->warnings);
        cli_json_count(&json, "lenient", console->lenient);
        cli_json_end(&json, '}');
        cli_json_end(&json, '}');
        fputc('\n', console->out);
        return;
    }
    fprintf(console->out, "summary: %u error%s, %u warning%s", console->errors,
            console->errors == 1 ? "" : "s", console->warnings, console->warnings == 1 ? "" : "s");
    if (console->lenient)
        fprintf(console->out,
                "; %u of what OpenSCAD only warns of (%s): --strict makes them errors",
                console->lenient, kinds);
    fputc('\n', console->out);
}

const char *cli_console_paint(const cli_console *console, const char *text, cli_mood mood,
                              char *buffer, size_t size)
{
    static const char *const colors[] = {"\033[1;32m", "\033[1;33m", "\033[1;31m"};
    snprintf(buffer, size, console->color_results ? "%s%s%s" : "%.0s%s%.0s", colors[mood], text,
             RESET);
    return buffer;
}

void cli_console_diag(cli_console *console, const csgm_diag *diag)
{
    if (diag->lenient)
        count_lenient(console, diag->code);
    if (is_muted(console, diag->severity))
        return;
    cli_console_end_progress(console);
    if (console->json) {
        print_json(console, diag->severity, diag);
        return;
    }
    size_t size = csgm_diag_format(diag, NULL, 0) + 1;
    char *text = malloc(size);
    if (!text) {
        fprintf(console->out, "%s\n", diag->message);
        return;
    }
    csgm_diag_format(diag, text, size);
    if (console->color)
        print_colored(console->out, diag->severity, diag, text);
    else
        fwrite(text, 1, strlen(text) < size - 1 ? size - 1 : strlen(text), console->out);
    free(text);
}

/* {"echo": "..."} of one line. */
static void print_echo_json(FILE *out, const char *text, size_t length)
{
    char *line = strndup(text, length && text[length - 1] == '\n' ? length - 1 : length);
    cli_json json = cli_json_make(out, false);
    cli_json_begin(&json, '{');
    cli_json_string(&json, "echo", line ? line : "");
    cli_json_end(&json, '}');
    fputc('\n', out);
    free(line);
}

void cli_console_echo(cli_console *console, const char *text, size_t length)
{
    if (console->quiet)
        return;
    cli_console_end_progress(console);
    cli_console_flush(console);
    if (console->json)
        print_echo_json(console->out, text, length);
    else
        fwrite(text, 1, length, console->out);
}

void cli_console_say(cli_console *console, csgm_severity severity, const char *hint,
                     const char *format, ...)
{
    char message[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    if (is_muted(console, severity))
        return;
    cli_console_end_progress(console);
    if (console->json) {
        print_json(console, severity, &(csgm_diag){.message = message, .hint = hint});
        return;
    }
    fprintf(console->out, "%scsgmesh: %s%s:%s %s\n", console->color ? BOLD : "",
            console->color ? severity_colors[severity] : "", severity_names[severity],
            console->color ? RESET : "", message);
    if (hint)
        fprintf(console->out, "hint: %s\n", hint);
}

/* ---- progress ------------------------------------------------------------------------ */

enum { BAR_WIDTH = 30 };
static const double PATIENCE_S = 0.5; /* shorter work shows no bar */

static void draw_bar(const cli_console *console, csgm_stage stage, double fraction,
                     double elapsed_s)
{
    static const char *const names[] = {
        [CSGM_STAGE_OCTREE] = "sampling",   [CSGM_STAGE_MESH] = "meshing ",
        [CSGM_STAGE_WRITE] = "writing ",    [CSGM_STAGE_RENDER] = "drawing ",
        [CSGM_STAGE_RESHAPE] = "thinning",  [CSGM_STAGE_CERTIFY] = "proving ",
        [CSGM_STAGE_COMPARE] = "comparing", [CSGM_STAGE_MEASURE] = "measuring"};
    char bar[BAR_WIDTH + 1];
    int filled = (int)(fraction * BAR_WIDTH);
    for (int i = 0; i < BAR_WIDTH; i++)
        bar[i] = i < filled ? '=' : i == filled ? '>' : ' ';
    bar[BAR_WIDTH] = '\0';
    double rate = elapsed_s > 0 ? fraction / elapsed_s : 0;
    fprintf(console->out, "\r%s [%s] %3.0f %%", names[stage], bar, 100 * fraction);
    if (rate > 0)
        fprintf(console->out, "  %.3g %%/s  %.1f s left", 100 * rate, (1 - fraction) / rate);
    fputs(console->is_terminal ? "\033[K" : "   ", console->out);
    fflush(console->out);
    cli_interrupt_progress_shown(true);
}

void cli_console_progress(void *user, csgm_stage stage, double fraction)
{
    enum { AUTO, ALWAYS, NEVER };
    cli_console *console = user;
    double now_s = cli_now_s();
    if (console->work_count >
        1) { /* its stages come again and again: how many are behind is told */
        double within = stage == CSGM_STAGE_COMPARE ? fraction : 0;
        fraction = ((double)console->work_index + within) / (double)console->work_count;
        stage = CSGM_STAGE_COMPARE;
    }
    if ((int)stage != console->stage) {
        console->stage = (int)stage;
        console->stage_start_s = now_s;
    }
    bool wanted =
        console->progress == ALWAYS || (console->progress == AUTO && console->is_terminal &&
                                        now_s - console->stage_start_s > PATIENCE_S);
    if (wanted && !console->quiet && !console->json)
        draw_bar(console, stage, fraction < 1 ? fraction : 1, now_s - console->stage_start_s);
}

void cli_console_set_work(cli_console *console, size_t index, size_t count)
{
    console->work_index = index;
    console->work_count = count;
    if (count > 1)
        cli_console_progress(console, CSGM_STAGE_COMPARE, 0);
}

void cli_console_end_progress(cli_console *console)
{
    if (console->out != stderr || !cli_interrupt_progress_shown(false))
        return;
    fputs(console->is_terminal ? "\r\033[K" : "\n", console->out);
    fflush(console->out);
}
