/* SPDX-License-Identifier: MIT
 * What the subcommands share: one run of the program.
 */
#ifndef CLI_CLI_H
#define CLI_CLI_H

#include "core/console.h"
#include "core/looked.h"
#include "core/option_kinds.h"

/* As diff(1). */
enum { CLI_DONE = 0, CLI_INPUT_AT_FAULT = 1, CLI_TROUBLE = 2 };

enum { CLI_META_MOST = 64 };

typedef struct cli_app {
    cli_options *options;
    cli_console console;
    csgm_context *context; /* from cli_app_open on */
    double start_s;
    csgm_trace *trace;     /* of --trace, or NULL */
    const char *zone_note; /* in it: what the context is at work on; NULL = the first operand */
    cli_list arguments;    /* of CLI_OPENSCAD: all that stands behind the command's name */
    csgm_flat flat;        /* what a flat scene is to be: of the -o files (mesh/drawings.h) */
    /* --meta, and the scene's file before it (cli_outputs_options) */
    const char *metadata[CLI_META_MOST + 1];
    char source[280];
    /* Whether to stop, asked on any thread; NULL: nobody asks. */
    bool (*cancelled)(void *app);
    /* Is told of each file that is looked for, with looked_user, on any thread; NULL: nobody
     * follows them. */
    void (*looked)(void *user, const char *path, cli_looked_kind kind);
    void *looked_user;
    bool ran_out_of_memory;   /* E0901 came */
    bool does_without_memory; /* whoever works on now has another way then, and says so: it is not
                                 shown */
    const char *varied;       /* a parameter that is to be given many values; NULL: none */
    bool varies_nothing;      /* the scene has none of that name */
    bool only_checks;         /* scenes are looked at for mistakes and not made */
    const char *overwriter;   /* option whose output is a file that is read, or another output:
                                 nothing may be written any more; NULL = none */
} cli_app;

/* Makes the context from the options. CLI_DONE, or the exit status. */
int cli_app_open(cli_app *app);
/* Limits, threads and warnings as the options say; nobody is told of findings. */
csgm_context_options cli_app_context_options(const cli_app *app);
/* How scenes are read, as the options say. */
typedef struct cli_scene_settings {
    csgm_scene_options options;
    csgm_define *defines; /* of the options */
} cli_scene_settings;
/* Failures are reported but for CSGM_ERR_MEMORY. Release the settings in either case. */
csgm_status cli_scene_settings_make(cli_app *app, cli_scene_settings *out);
void cli_scene_settings_release(cli_scene_settings *settings);
/* A file is looked for, for who follows it. */
void cli_app_looked(const cli_app *app, const char *path, cli_looked_kind kind);
/* -Werror, and there was one. */
bool cli_app_is_refused(const cli_app *app);
/* path "-" is standard input. Failures are reported. */
csgm_status cli_app_load(cli_app *app, const char *path, csgm_scene **out);
csgm_status cli_app_load_params(cli_app *app, const char *path, csgm_params **out);
int cli_exit_status(csgm_status status);
/* Flushes standard output; reports a failed write of results. */
int cli_finish_stdout(cli_app *app, int status);
double cli_now_s(void);
/* A path without its folders. */
const char *cli_file_name(const char *path);
/* How many bytes from here on are letters of the scene language's names, or digits in them. */
size_t cli_name_length(const char *text);
/* The name in `names` (NULL at the end) nearest to `text`, NULL when none is near. */
const char *cli_nearest(const char *text, const char *const *names);

/* "csgmesh: error: ..." with a pointer to the help; returns CLI_TROUBLE. hint may be NULL. */
__attribute__((format(printf, 3, 4))) int cli_usage_error(cli_app *app, const char *hint,
                                                          const char *format, ...);

/* On standard output; the exit status. */
int cli_print_version(cli_app *app);
void cli_help(void);

#endif
