/* SPDX-License-Identifier: MIT
 * From options to a context and a scene, and from a status to an exit status.
 */
#include "core/cli.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "core/mesh_files.h"
#include "core/options.h"
#include "core/sources.h"
#include "core/textfile.h"
#include "core/trace.h"

double cli_now_s(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

const char *cli_file_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

size_t cli_name_length(const char *text)
{
    return strspn(text, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_$0123456789");
}

int cli_exit_status(csgm_status status)
{
    switch (status) {
    case CSGM_OK:
        return CLI_DONE;
    case CSGM_ERR_SYNTAX:
    case CSGM_ERR_SCENE:
    case CSGM_ERR_FORMAT:
        return CLI_INPUT_AT_FAULT;
    default:
        return CLI_TROUBLE;
    }
}

int cli_usage_error(cli_app *app, const char *hint, const char *format, ...)
{
    char message[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    cli_console_say(&app->console, CSGM_ERROR, hint ? hint : "csgmesh --help shows how", "%s",
                    message);
    return CLI_TROUBLE;
}

static csgm_limits limits_from(const cli_options *options)
{
    const double MOST_STEPS = 1e18; /* thirty years of them: larger numbers mean no limit */
    csgm_limits limits = csgm_context_options_default().limits;
    if (options->given[CLI_OPTION_max_depth])
        limits.depth = (uint32_t)options->max_depth;
    if (options->given[CLI_OPTION_max_nodes])
        limits.scene_nodes = (uint32_t)options->max_nodes;
    if (options->given[CLI_OPTION_max_memory])
        limits.memory_bytes = options->max_memory;
    if (options->given[CLI_OPTION_max_steps])
        limits.eval_steps = (uint64_t)ceil(fmin(options->max_steps, MOST_STEPS));
    limits.timeout_s = options->timeout;
    return limits;
}

/* What is given back goes to the system. By default glibc takes the large blocks that follow one
 * that was given back from its heap, up to 32 MiB each, where what lies behind them keeps their
 * pages: a mesh that counts 151 MiB had 206 MB then, and has 165 MB so. */
static void give_back_large_blocks(void)
{
#ifdef M_MMAP_THRESHOLD
    enum { LARGE = 1 << 17 /* what glibc begins with */ };
    mallopt(M_MMAP_THRESHOLD, LARGE);
#endif
}

csgm_context_options cli_app_context_options(const cli_app *app)
{
    csgm_context_options options = csgm_context_options_default();
    options.threads = (uint32_t)app->options->threads;
    options.limits = limits_from(app->options);
    options.warnings_as_errors = app->options->warnings == 1;
    options.library_warnings = app->options->warnings == 2;
    return options;
}

enum { CLI_NAME_MOST = 200 };

/* ---- what the library tells ------------------------------------------------------------------- */

/* Does the message speak of the parameter that is to be varied? */
static bool names_varied(const cli_app *app, const char *message)
{
    char quoted[CLI_NAME_MOST + 3];
    if (!app->varied)
        return false;
    snprintf(quoted, sizeof quoted, "'%.*s'", CLI_NAME_MOST, app->varied);
    return strstr(message, quoted) != NULL;
}

static void take_finding(void *user, const csgm_diag *diag)
{
    enum { OUT_OF_MEMORY = 901, NOTHING_TO_REPLACE = 213 };
    cli_app *app = user;
    bool is_memory = diag->code == OUT_OF_MEMORY;
    app->ran_out_of_memory |= is_memory;
    app->varies_nothing |= diag->code == NOTHING_TO_REPLACE && names_varied(app, diag->message);
    if (!(is_memory && app->does_without_memory))
        cli_console_diag(&app->console, diag);
}

static void take_echo(void *user, const char *text, size_t length)
{
    cli_app *app = user;
    cli_console_echo(&app->console, text, length);
}

static void take_file(void *user, const char *path, bool is_there)
{
    cli_app_looked(user, path, is_there ? CLI_LOOKED_FOUND : CLI_LOOKED_MISSING);
}

void cli_app_looked(const cli_app *app, const char *path, cli_looked_kind kind)
{
    if (app->looked)
        app->looked(app->looked_user, path, kind);
}

int cli_app_open(cli_app *app)
{
    if (app->options->strict && app->options->lenient)
        return cli_usage_error(app, NULL, "--strict and --lenient say the opposite: give one");
    int guarded = cli_sources_guard(app);
    if (guarded != CLI_DONE)
        return guarded;
    if (app->options->given[CLI_OPTION_max_memory])
        give_back_large_blocks();
    csgm_context_options options = cli_app_context_options(app);
    options.on_diag = take_finding;
    options.on_echo = take_echo;
    options.on_file = take_file;
    options.user = app;
    options.cancelled = app->cancelled;
    options.trace = app->trace;
    csgm_status status = csgm_context_create(&options, &app->context);
    if (status != CSGM_OK && !app->console.errors)
        cli_console_say(&app->console, CSGM_ERROR, NULL, "cannot start: %s",
                        csgm_status_name(status));
    if (status == CSGM_OK)
        cli_trace_open(app);
    return cli_exit_status(status);
}

/* "radius=50" -> {"radius", "50"}; the name is a copy. */
static bool split_define(cli_app *app, const char *text, csgm_define *define)
{
    size_t length = cli_name_length(text);
    if (length == 0 || text[length] != '=' || (*text >= '0' && *text <= '9')) {
        cli_usage_error(app, "as -D radius=50 or -D 'label=\"top\"'",
                        "-D wants NAME=EXPR, not '%s'", text);
        return false;
    }
    define->name = strndup(text, length);
    define->expression = text + length + 1;
    if (!define->name)
        cli_usage_error(app, NULL, "out of memory");
    return define->name != NULL;
}

bool cli_app_is_refused(const cli_app *app)
{
    return app->options->warnings == 1 && app->console.errors > 0;
}

/* Where the scene is and what is asked of it. */
typedef struct request {
    const char *path;
    csgm_scene **scene; /* one of both */
    csgm_params **params;
} request;

static csgm_status parse(cli_app *app, const request *wanted, const char *text, size_t length,
                         const csgm_scene_options *options)
{
    return wanted->scene
               ? csgm_scene_parse(app->context, text, length, "-", options, wanted->scene)
               : csgm_params_parse(app->context, text, length, "-", options, wanted->params);
}

static csgm_status load(cli_app *app, const request *wanted, const csgm_scene_options *options)
{
    if (cli_path_is_mesh(wanted->path)) {
        cli_refuse_mesh(app, wanted->path);
        return CSGM_ERR_FORMAT;
    }
    if (strcmp(wanted->path, "-") != 0)
        return wanted->scene
                   ? csgm_scene_load(app->context, wanted->path, options, wanted->scene)
                   : csgm_params_load(app->context, wanted->path, options, wanted->params);
    size_t length;
    char *text = cli_read_stdin(app, &length);
    if (!text)
        return CSGM_ERR_IO;
    csgm_status status = CSGM_ERR_FORMAT;
    if (cli_text_is_mesh(text, length))
        cli_refuse_mesh(app, "-");
    else
        status = parse(app, wanted, text, length, options);
    free(text);
    return status;
}

static csgm_status set_parameter_file(cli_app *app, csgm_scene_options *options)
{
    options->parameter_file = app->options->parameter_file;
    options->parameter_set = app->options->parameter_set;
    if (!options->parameter_file == !options->parameter_set)
        return CSGM_OK;
    cli_usage_error(app, "as -p sets.json -P large", "%s is missing",
                    options->parameter_file ? "-P, which names one of the file's sets,"
                                            : "-p, the file of parameter sets,");
    return CSGM_ERR_ARGUMENT;
}

static csgm_leniency leniency_of(const cli_options *options)
{
    return options->strict ? CSGM_STRICT : options->lenient ? CSGM_LENIENT : CSGM_LENIENT_BY_FILE;
}

/* "2021.01" or "2021.01.15" -> 20210100, 20210115. */
static bool read_level(cli_app *app, uint32_t *out)
{
    unsigned year = 0, month = 0, day = 0;
    char after;
    const char *text = app->options->openscad_version;
    if (!text)
        return true;
    /* NOLINTNEXTLINE(cert-err34-c): four and two digits always fit */
    int read = sscanf(text, "%4u.%2u.%2u%c", &year, &month, &day, &after);
    if ((read != 2 && read != 3) || year < 2000 || month < 1 || month > 12 || day > 31) {
        cli_usage_error(app, "as --openscad-version 2021.01",
                        "--openscad-version wants YEAR.MONTH or YEAR.MONTH.DAY, not '%.40s'", text);
        return false;
    }
    *out = year * 10000 + month * 100 + day;
    return true;
}

csgm_status cli_scene_settings_make(cli_app *app, cli_scene_settings *out)
{
    const cli_list *texts = &app->options->defines;
    csgm_scene_options options = csgm_scene_options_default();
    csgm_define *defines = calloc(texts->count + 1, sizeof *defines);
    csgm_status status = defines ? set_parameter_file(app, &options) : CSGM_ERR_MEMORY;
    for (size_t i = 0; i < texts->count && status == CSGM_OK; i++)
        if (!split_define(app, texts->items[i], &defines[i]))
            status = CSGM_ERR_ARGUMENT;
    options.defines = defines;
    options.define_count = texts->count;
    options.include_dirs = app->options->include_dirs.items;
    options.include_dir_count = app->options->include_dirs.count;
    options.facets = app->options->facets == 1 ? CSGM_FACETS_EXACT : CSGM_FACETS_ROUND;
    options.leniency = leniency_of(app->options);
    if (status == CSGM_OK && !read_level(app, &options.openscad_version))
        status = CSGM_ERR_ARGUMENT;
    options.flat = app->flat;
    options.only_check = app->only_checks;
    *out = (cli_scene_settings){options, defines};
    return status;
}

void cli_scene_settings_release(cli_scene_settings *settings)
{
    for (size_t i = 0; settings->defines && i < settings->options.define_count; i++)
        free((char *)settings->defines[i].name);
    free(settings->defines);
}

static csgm_status load_with_options(cli_app *app, const request *wanted)
{
    cli_scene_settings settings;
    csgm_status status = cli_scene_settings_make(app, &settings);
    uint32_t errors = app->console.errors;
    if (status == CSGM_OK)
        status = load(app, wanted, &settings.options);
    if (status != CSGM_OK && status != CSGM_ERR_ARGUMENT && app->console.errors == errors)
        cli_console_say(&app->console, CSGM_ERROR, "please report it, with the scene",
                        "%s failed without saying why: %s", wanted->path, csgm_status_name(status));
    cli_scene_settings_release(&settings);
    return status;
}

csgm_status cli_app_load(cli_app *app, const char *path, csgm_scene **out)
{
    csgm_status status = load_with_options(app, &(request){.path = path, .scene = out});
    if (status != CSGM_OK || !cli_app_is_refused(app))
        return status;
    csgm_scene_destroy(*out);
    *out = NULL;
    return CSGM_ERR_SCENE;
}

csgm_status cli_app_load_params(cli_app *app, const char *path, csgm_params **out)
{
    return load_with_options(app, &(request){.path = path, .params = out});
}

int cli_finish_stdout(cli_app *app, int status)
{
    errno = 0;
    if (fflush(stdout) == 0 && !ferror(stdout))
        return status;
    cli_console_say(&app->console, CSGM_ERROR, NULL, "cannot write standard output: %s",
                    errno ? strerror(errno) : "the write failed");
    return CLI_TROUBLE;
}
