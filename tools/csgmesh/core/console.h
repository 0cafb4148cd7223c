/* SPDX-License-Identifier: MIT
 * Everything that goes to standard error (or, of a batch's job, into a text that is shown later):
 * findings of the library, the program's own messages, the scene's echo lines and the progress bar,
 * as text (with colour) or as JSON lines.
 */
#ifndef CLI_CONSOLE_H
#define CLI_CONSOLE_H

#include <stdio.h>

#include "core/json.h"
#include "csgmesh/csgmesh.h"

enum { CLI_KINDS_MOST = 32 };

typedef struct cli_options cli_options;

typedef struct cli_console {
    FILE *out; /* standard error, but for one of many jobs */
    bool quiet, color, json, is_terminal;
    bool color_results;         /* on standard output */
    bool mute_notes;            /* they belong to a warning that was not shown */
    uint32_t errors;            /* said so far, warnings made errors by -Werror included */
    uint32_t warnings, lenient; /* the same; lenient: those that are errors in a strict text */
    struct {
        uint16_t code;
        uint32_t count;
    } kinds[CLI_KINDS_MOST]; /* of the lenient ones */
    int progress;            /* index of --progress: auto, always, never */
    double stage_start_s;
    int stage;                     /* csgm_stage, -1 before the first */
    size_t work_index, work_count; /* cli_console_set_work */
    FILE *held; /* --diagnostics=json: a finding that waits for its notes, or NULL */
    cli_json held_json;
    bool held_has_notes;
    char *held_text;
    size_t held_length;
} cli_console;

typedef enum cli_mood { CLI_GOOD, CLI_MIXED, CLI_BAD } cli_mood;

/* A word of results in its colour, where standard output has any. Returns the buffer. */
const char *cli_console_paint(const cli_console *console, const char *text, cli_mood mood,
                              char *buffer, size_t size);

/* Where messages go before the options are known. */
cli_console cli_console_make(void);
void cli_console_configure(cli_console *console, const cli_options *options);

/* Writes what still waits. */
void cli_console_flush(cli_console *console);

/* What the library tells. */
void cli_console_diag(cli_console *console, const csgm_diag *diag);
void cli_console_echo(cli_console *console, const char *text, size_t length);

/* One sentence of the program itself. hint may be NULL. */
__attribute__((format(printf, 4, 5))) void cli_console_say(cli_console *console,
                                                           csgm_severity severity, const char *hint,
                                                           const char *format, ...);

/* Until it ends, what the console is told goes nowhere and is not counted: for work whose findings
 * other work will say, or has said. */
typedef struct cli_silence {
    FILE *nowhere;
    cli_console kept;
} cli_silence;
/* false: there is no place for it (/dev/null), and it does not begin. */
bool cli_silence_begin(cli_silence *silence, cli_console *console);
void cli_silence_end(cli_silence *silence, cli_console *console);

/* --summary: what was found, in one line. */
void cli_console_summary(cli_console *console);

/* csgm_monitor.progress; user is a cli_console. */
void cli_console_progress(void *user, csgm_stage stage, double fraction);
/* From here on `index` of `count` comparisons are behind: of several there is one bar for all. */
void cli_console_set_work(cli_console *console, size_t index, size_t count);
void cli_console_end_progress(cli_console *console);

#endif
